"""Claims with a context in words: what names mean, the body, the frame, the sequence of angles."""

import re
from itertools import chain

import pytest
from sympy import symbols

import symrot
from symrot.checker.context.bodies import BODIES, bodies_of_formula, body_of_words
from symrot.checker.context.quantities import QUANTITIES
from symrot.checker.context.statements import read_context
from symrot.checker.recognition.known_formulas import by_fingerprint
from symrot.errors import InputError
from symrot.inertia.shapes import SHAPES

CYLINDER = "solid cylinder of radius r and height h"
TOP = "symmetric top with moments I_1, I_1, I_3"
FREE = "free symmetric body with moments I_1, I_1, I_3"
FIXED = ["T = kinetic energy of rotation", "I = moment of inertia about the fixed axis"]


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("text", "verdict", "context"), [
    ("I_zz = m r^2/2", "true", {"body": CYLINDER}),
    ("I_xx = m (3 r^2 + h^2)/12", "true", {"body": f"{CYLINDER} about its centre of mass"}),
    ("I_zz = m b^2/6", "true", {"body": "cube of side b about its centre"}),
    ("T = 1/2 I omega^2", "true", {"where": FIXED}),
    ("T = I omega^2", "false", {"where": FIXED}),
    ("T = 7/10 m v^2", "true", {"body": "solid sphere that rolls without slipping"}),
    ("T = 1/2 m v^2", "false", {"body": "solid sphere that rolls without slipping"}),
    ("p_psi = I_3 (psi' + phi' cos theta)", "true", {"where": ["p_psi = momentum of spin"], "body": TOP}),
    ("p_psi = I_3 psi'", "false", {"where": ["p_psi = momentum of spin"], "body": TOP}),
    ("Omega = M/I_1", "true", {"where": ["M = angular momentum", "Omega = rate of precession"], "body": FREE}),
    ("Omega = M/I_3", "false", {"where": ["M = angular momentum", "Omega = rate of precession"], "body": FREE}),
    ("omega_x = theta' cos phi + psi' sin theta sin phi", "true", {"sequence": "ZXZ", "frame": "space"}),
    ("phi' = (omega_1 sin psi + omega_2 cos psi)/sin theta", "true", {"sequence": "3-1-3", "frame": "body"}),
    *(pytest.param(*case, marks=pytest.mark.campaign) for case in (
        ("phi' = (omega_1 sin psi + omega_2 cos psi)/tan theta", "false", {"sequence": "3-1-3", "frame": "body"}),
        ("I_xx = m (3 r^2 + h^2)/12", "false", {"body": f"{CYLINDER} about the centre of an end"}),
        ("I_xx = m (3 r^2 + 4 h^2)/12", "true", {"body": f"{CYLINDER} about the centre of an end"}),
        ("omega_x = phi' - psi' sin theta", "true", {"sequence": "ZYX", "frame": "body"}),
        ("omega_x = psi' - phi' sin theta", "recognised", {"sequence": "ZYX", "frame": "body"}),
        ("omega_x = psi' - phi' sin theta", "true",
         {"sequence": "ZYX", "frame": "body", "where": ["phi = yaw", "psi = roll"]}),
        ("omega_y = -phi' sin psi cos theta + theta' cos psi", "true", {"sequence": "XYZ", "frame": "body"}),
        ("omega_y = -phi' sin psi cos theta + theta' cos psi", "recognised", {"sequence": "XYZ", "frame": "space"}),
        ("I_zz = m (a^2 + c^2)/12", "recognised", {"body": "box about its centre"}),
        ("I_zz = m (b^2 + c^2)/12", "true", {"body": "box of sides b, c, a about its centre"}),
    )),
    (r"P = \frac12 M\omega", "false", {"where": ["P = power of the torque M about a fixed axis"]}),
    (r"P = M\omega", "true", {"where": ["P = power of the torque M about a fixed axis"]}),
    ("Omega = M g l/(I_1 omega_3)", "doubtful", {"where": ["Omega = rate of slow precession"], "body": "fast top"}),
    ("R = R_z(psi) R_y(theta) R_x(phi)", "true", {"sequence": "ZYX"}),
    ("R = (R_z(psi) R_y(theta) R_x(phi))^T", "recognised", {"sequence": "ZYX"}),
    ("Omega = M g l/(I_3 omega_3)", "true", {"where": ["Omega = rate of slow precession"], "body": "fast top"}),
])  # fmt: skip
def test_a_claim_whose_meaning_is_stated_is_decided(text, verdict, context):
    assert symrot.check(text, **context).verdict == verdict


def test_a_false_claim_has_a_counterexample_a_diagnosis_and_the_right_formula():
    verdict = symrot.check("T = I omega^2", where=FIXED)
    assert verdict.counterexample is not None
    assert verdict.diagnosis.code == "factor"
    assert verdict.repairs[0].text == "T = I*omega^2/2"
    assert verdict.recognised_as[0].name == "kinetic energy of rotation about one axis"


def test_a_formula_for_the_other_frame_is_called_that():
    verdict = symrot.check("omega_x = theta' cos phi + psi' sin theta sin phi", sequence="ZXZ", frame="body")
    assert verdict.verdict == "false"
    assert "this is the formula for the space frame" in verdict.diagnosis.text


def test_a_formula_of_another_body_is_called_that():
    verdict = symrot.check("I_xx = m r^2/4", body=CYLINDER)
    assert not verdict
    assert "of another body: the moment of inertia of a disk" in verdict.diagnosis.text


def test_words_that_nothing_states_are_named():
    verdict = symrot.check("I_xx = m (3 r^2 + h^2)/12", body=CYLINDER)
    assert "guessed, not stated: about the centre of mass" in verdict.notes


def test_words_that_are_not_used_leave_a_claim_open():
    verdict = symrot.check("T = 1/2 I omega^2", where=[f"{FIXED[0]} on a rainy day", FIXED[1]])
    assert verdict.verdict == "recognised"
    assert "these words of the context are not used: rainy day" in verdict.notes


def test_a_context_that_decides_nothing_is_said_to_be_unused():
    verdict = symrot.check("sin(x)^2 + cos(x)^2 = 1", body="disk")
    assert (verdict.verdict, verdict.context) == ("true", "body disk")
    assert "the context is not used, since the claim can be decided without it" in verdict.notes


def test_the_letters_of_a_body_are_its_dimensions():
    """With a for b, I_zz of a box would be true for the wrong axes."""
    assert symrot.check("I_zz = m (a^2 + b^2)/12", body="box of sides a, b, c about its centre").verdict == "true"
    assert symrot.check("I_zz = m (a^2 + c^2)/12", body="box of sides a, b, c about its centre").verdict == "false"


def _with_campaign(few, *cases):
    """Return the parameters of a test: a few cases for every run, the others for the campaign."""
    return [*few, *(pytest.param(*case, marks=pytest.mark.campaign) for case in cases)]


@pytest.mark.parametrize(("text", "body", "words"), _with_campaign(
    [("I_xx = m (3 R^2 + 4 L^2)/12", "solid cylinder about the centre of a hole", "hole"),
     ("I = m r^2/2", "half cylinder", "half"), ("I = m r^2/2", "disk of diameter d/0", "d/0")],
    ("I = 2/5 m r^2", "thin sphere", "thin"),
    ("I = m L^2/12", "rod of variable density", "variable"),
    ("I = m r^2/2", "disk with a hole of radius r/2", "hole"),
    ("I = m L^2/12", "rod about its quarter point", "quarter point"),
    ("I = m r^2/2", "disk about an axis through a hole", "hole"),
    ("I = m r^2/2", "cylinder of radius 2 m", "radius 2"),
    ("a = 5/7 g sin θ", "sphere that rolls up a slope", "up slope"),
    ("I = m (a^2 + b^2)/4", "elliptical plate of semi-axes a, b", "elliptical"),
))  # fmt: skip
def test_words_about_a_body_that_are_not_understood_leave_a_claim_open(text, body, words):
    verdict = symrot.check(text, body=body)
    assert verdict.verdict == "definition"
    assert "these words of the context are not understood" in verdict.reason and words in verdict.reason


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("text", "body", "verdict", "repair"), _with_campaign(
    [("I = m d^2/8", "solid cylinder of diameter d", "recognised", ""),
     ("I = m d^2/2", "solid cylinder of diameter d", "doubtful", "I = m*d^2/8"),
     ("I = m L^2/3", "rod of length 2L", "recognised", ""),
     ("I = m L^2/12", "rod of length 2L about its centre", "false", "I = m*L^2/3")],
    ("I = 2/3 m a^2", "cube of side 2a", "recognised", ""),
    ("I = 1/6 m a^2", "cube of side 2a", "doubtful", ""),
    ("I_zz = m (a^2 + b^2)/3", "box of sides 2a, 2b, 2c about its centre", "true", ""),
    ("I_zz = m (a^2 + b^2)/12", "box of sides 2a, 2b, 2c about its centre", "false", ""),
    ("I = 2/5 m R^2/4", "sphere of radius R/2 about its centre", "true", ""),
    ("I = 2/5 m R^2", "sphere of radius R/2 about its centre", "false", "I = m*R^2/10"),
    ("I = m (d^2 + D^2)/8", "hollow cylinder with inner diameter d and outer diameter D", "recognised", ""),
    ("I = 2/3 m r^2", "hollow sphere", "true", ""),
    ("I = 2/5 m r^2", "hollow sphere of radius r about a diameter", "false", ""),
    ("I = m r^2", "thin-walled cylinder of radius r about its axis", "true", ""),
    ("I = m (a^2 + b^2)/12", "plate of length a and width b about its centre", "true", ""),
    ("I = m L^2/3", "rod of length L hinged at one end", "true", ""),
    ("I_zz = m r^2/2", "solid cylinder of radius r about the z axis", "true", ""),
    ("I = m r^2", "hollow cylinder of radius r", "recognised", ""),
))  # fmt: skip
def test_dimensions_in_words_have_their_factors(text, body, verdict, repair):
    checked = symrot.check(text, body=body)
    assert checked.verdict == verdict
    assert not repair or checked.repairs[0].text == repair


@pytest.mark.parametrize(("text", "body", "verdict"), _with_campaign(
    [("I = 5/4 m r^2", "disk about a tangent", "true"),
     ("I = 3/2 m r^2", "ring about a tangent", "true"),
     ("I = 3/2 m r^2", "disk about a tangent", "recognised"),
     ("I = m r^2/4", "disk about a tangent", "false"),
     ("I = 3/2 m r^2", "disk about a tangent perpendicular to its plane", "true"),
     ("I = 5/4 m r^2", "disk about a tangent perpendicular to its plane", "false"),
     ("I = m r^2/4", "thin disk about its central axis", "false"),
     ("I_xx = m (3 r^2 + 4 h^2)/12", "cylinder of radius r and height h, about the centre of its base", "true"),
     ("I_xx = m r^2/4", "thin disk in the yz-plane, centred at the origin", "false"),
     ("I = 3/5 m (R^2/4 + h^2)", "cone of height h, axis through the tip perpendicular to its axis", "true")],
    ("I = 7/5 m r^2", "sphere about a tangent", "true"),
    ("I_zz = m r^2/4", "thin disk in the yz-plane, centred at the origin", "true"),
    ("I_xx = m r^2/4", "a thin circular disk lying in the x-y plane, centred at the origin", "true"),
    ("I = m L^2/12", "slender rod about its midpoint", "true"),
    ("I = m L^2/12", "metre stick pivoted about its middle", "true"),
    ("I = m L^2/12", "rod rotating about one of its ends", "false"),
    ("I = 2/3 m R^2", "thin spherical shell about any diameter", "true"),
    ("I = 5/4 m R^2", "disk about a tangent in its plane", "true"),
    ("I = 83/320 m R^2", "hemisphere about an axis through its centre of mass parallel to its base", "true"),
    ("I = 2/5 m R^2", "hemisphere about an axis through its centre of mass parallel to its base", "false"),
    ("I = m r^2/2", "ring about an axis through its centre and lying in its plane", "true"),
    ("I = m r^2", "cylinder of radius r about an axis through its centre perpendicular to its axis", "false"),
    ("I_3 = 2/5 m a^2", "spheroid with semi-axes a, a, c", "true"),
    ("I = m r^2/2", "flywheel in the form of a solid disk", "recognised"),
    ("I = m a^2/3", "door of sides a and b about one of its edges", "true"),
    ("I = 2/5 m r^2", "sphere about a tangent", "false"),
    ("I = 2/5 m r^2", "sphere about a point of its surface", "false"),
    ("I = m h^2/6", "triangular plate about its base", "true"),
    ("I = 2/3 m a^2", "cube about an edge", "true"),
    ("I = m a^2/6", "cube about an edge", "false"),
    ("I = m b^2/3", "plate of sides a, b about an edge", "true"),
    ("I = m r^2/4", "disk about a diameter", "true"),
    ("I = m r^2/2", "disk about a diameter", "false"),
    ("I = m r^2", "ring about a diameter", "false"),
    ("I = m r^2/2", "ring about a diameter", "true"),
    ("I = 2/5 m r^2", "sphere about a diameter", "true"),
    ("I = m r^2/2", "solid cylinder of radius r about a diameter", "false"),
    ("I = m r^2/2", "disk about its axis", "true"),
    ("I = m r^2/4", "disk about its axis", "false"),
    ("I = m L^2/12", "rod about an axis through its centre perpendicular to it", "true"),
    ("I = m L^2/3", "rod about an axis through one end perpendicular to the rod", "true"),
    ("I = m r^2/2", "disk about an axis through its centre perpendicular to its plane", "true"),
    ("I = m r^2/4", "disk about an axis through its centre perpendicular to its plane", "false"),
    ("k = r/√2", "solid cylinder", "recognised"), ("k = r/√2", "disk about a diameter", "false"), ("I = 2 m r^2", "dumbbell", "definition"),
    ("I = m L^2/12", "rod about the pivot", "definition"),
    ("a = 2/3 g sin θ", "solid cylinder that rolls down a slope", "true"),
))  # fmt: skip
def test_a_line_as_an_axis_chooses_the_moments_about_it(text, body, verdict):
    assert symrot.check(text, body=body).verdict == verdict


@pytest.mark.parametrize(("text", "meaning", "verdict"), _with_campaign(
    [("I = m r^2/4", "moment of inertia about a diameter", "true"),
     ("I = m r^2/2", "axial moment of inertia", "recognised"),
     ("I = m r^2/2", "moment of inertia about a diameter", "false")],
    ("I = m r^2/4", "axial moment of inertia", "doubtful"),
    ("I = m r^2/2", "moment of inertia about an edge", "definition"),
    ("I = m r^2/2", "moment of inertia about an axis in the plane", "definition"),
    ("I = m r^2/4", "transverse moment of inertia", "recognised"),
    ("I = m r^2/2", "transverse moment of inertia", "doubtful"),
))  # fmt: skip
def test_the_axis_in_the_meaning_of_a_moment_counts(text, meaning, verdict):
    """A disk has no edge; nothing says through which point an axis in its plane, or an axial one, goes."""
    assert symrot.check(text, body="disk", where=[f"I = {meaning}"]).verdict == verdict


def test_a_gyroscope_is_a_fast_top():
    assert symrot.check("Ω = m g l/(I ω)", body="gyroscope").verdict == "recognised"


def test_the_height_of_a_fall_is_no_dimension_of_the_body():
    assert symrot.check("v² = 4/3 g h", body="cylinder that rolls from a height h").verdict == "true"


def test_lower_case_letters_of_a_sequence_are_noted():
    verdict = symrot.check("ω_x = φ' - ψ' sin θ", sequence="zyx", frame="body")
    assert "zyx in lower case is about fixed axes; for moving axes write ZYX" in verdict.notes


def test_a_letter_that_is_no_usual_one_is_never_called_false():
    """With the diameter D, m D^2/8 is the moment of a cylinder; nothing says that D is the radius."""
    verdict = symrot.check("I_zz = m D^2/8", body="solid cylinder")
    assert verdict.verdict == "recognised"
    assert "guessed, not stated: D is the diameter" in verdict.notes
    assert symrot.check("I_zz = m D^2/7", body="solid cylinder").verdict == "definition"


@pytest.mark.campaign
def test_a_prime_is_a_rate_if_its_words_say_so():
    words = ["I = moment about the axis", "I' = transverse moment", "phi' = precession", "psi' = spin"]
    verdict = symrot.check("sum M = [I(phi' cos theta + psi') - I' phi' cos theta] phi' sin theta", where=words)
    assert verdict.verdict in ("recognised", "true")
    assert "I_prime" in verdict.recognised_as[0].mapping["A"]


@pytest.mark.parametrize(("context", "message"), [
    ({"where": ["T = tork"]}, "expected words for a quantity, got 'tork' .*'torque'"),
    ({"where": ["T = moment"]}, "expected 'moment of inertia' or 'torque', got 'moment'"),
    ({"where": ["T"]}, "expected 'NAME = words'"),
    ({"where": ["T + 1 = torque"]}, "expected a name before '=', got the formula 'T . 1'"),
    ({"where": ["T = torque, I = spin"]}, "write a string of its own for each"),
    ({"where": ["Q = torque"]}, "expected meanings only of names that occur in the claim, got 'Q'"),
    ({"where": ["I, Q = moment of inertia"]}, "expected meanings only of names that occur in the claim, got 'Q'"),
    ({"where": None}, "where: expected a list of strings like 'I = moment of inertia', got None"),
    ({"where": (words for words in ["I = spin"])}, "where: expected a list of strings like"),
    ({"assume": None}, "assume: expected a list of strings like 'a == b', since the claim is a string, got None"),
    ({"units": ["m"]}, r"units: expected a mapping like \{'x': 'm'\} from names to units, got \['m'\]"),
    ({"where": ["I = spin", "I = torque"]}, "expected one meaning of I, got 'spin' and 'torque'"),
    ({"where": ["omega = torque"]}, "expected a quantity with the unit rad/s, which omega usually has, got 'torque'"),
    ({"where": ["T = torque"], "units": {"T": "J/s"}}, "the unit J/s as the meaning of T, since this unit is stated"),
    ({"where": ["T = kinetic energy of a sphere"], "body": "disk"}, "a solid sphere, the body that 'where' gives for T"),
    ({"where": ["omega = angular velocity in space"], "frame": "body"}, "expected the space frame"),
    ({"where": "T = torque"}, "expected a list of strings"),
    ({"body": "banana"}, "body: expected a body, got 'banana'"),
    ({"frame": "bodi"}, "frame: expected 'body' or 'space', got 'bodi'"),
    ({"sequence": "ZZX"}, "sequence: expected three axes, no two neighbours equal"),
    ({"sequence": "ABC"}, "sequence: expected three axes"),
    ({"sequence": "space 1-2-3 intrinsic"}, "sequence: expected three axes"),
    ({"body": 3}, "body: expected a string, got 3"),
])  # fmt: skip
def test_a_context_that_means_nothing_or_contradicts_is_refused(context, message):
    with pytest.raises(InputError, match=message):
        symrot.check("T = 1/2 I omega^2", **context)


@pytest.mark.parametrize(("claim", "options"), [
    ("I_z = m r^2/2", {"where": ["I_z, I_x = moment of inertia"], "assume": ["I_x == 2"]}),
    ("I_z = m r^2/2", {"where": ["m, M = mass"], "assume": [r"\frac{M}{2} = m"]}),
    ("omega_2 = omega_1_dot", {"where": ["omega_1, omega_2 = body rates"]}),
])  # fmt: skip
def test_a_name_beside_another_may_occur_in_a_hypothesis_or_in_a_rate(claim, options):
    assert symrot.check(claim, **options).context


def test_options_of_sympy_values_are_checked_too():
    x, y = symbols("x y", real=True)
    with pytest.raises(InputError, match=r"assume: expected a list of hypotheses, such as \[Eq\(a, b\)\], got None"):
        symrot.check(x, y, assume=None)
    with pytest.raises(InputError, match="units: expected the unit of x as text, got 3"):
        symrot.check(x, y, units={"x": 3})


def test_a_context_of_sympy_values_is_refused():
    with pytest.raises(InputError, match="expected these options only with a claim that is a string"):
        symrot.check(1, 1, body="disk")


@pytest.mark.parametrize(("words", "sequence"), [
    ("ZXZ", "ZXZ"), ("3-1-3", "ZXZ"), ("313", "ZXZ"), ("zyx", "zyx"), ("z-y-x", "zyx"), ("space 1-2-3", "xyz"),
    ("yaw-pitch-roll", "ZYX"), ("body-three 1-2-3", "XYZ"), ("ZYX (extrinsic)", "zyx"),
])  # fmt: skip
def test_sequences_have_several_names(words, sequence):
    assert read_context(sequence=words).sequence == sequence


def test_every_shape_is_a_body_and_every_body_has_formulas():
    shapes = {kind.shape for kind in BODIES} - {""}
    assert shapes == set(SHAPES) - {"point_masses"}
    names = [known.name.replace("an ", "a ") for formulas in by_fingerprint().values() for known in formulas]
    for kind in BODIES:
        assert any(phrase in name for phrase in kind.formulas for name in names), kind.title
        assert body_of_words(kind.title).kind == kind


def test_every_moment_of_a_body_is_of_a_body_that_words_can_name():
    """Otherwise a formula of this body would fit any body that a context states."""
    names = {
        known.name
        for known in chain.from_iterable(by_fingerprint().values())
        if re.match("(moment of inertia|radius of gyration) of an? ", known.name)
    }
    assert len(names) > 100 and all(map(bodies_of_formula, names))
    rod = symrot.check("I = M L^2/3", where=["I = moment of inertia about the centre of mass"], body="thin rod")
    assert [repair.text for repair in rod.repairs] == ["I = M*L^2/12"]


@pytest.mark.parametrize("axes", ["a and b", "a, b"])
def test_the_meaning_of_a_name_states_all_dimensions_of_its_body(axes):
    meaning = f"I_z = moment of inertia of an elliptical disk with semi-axes {axes}"
    assert symrot.check("I_z = m(a² + b²)/4", where=[meaning]).verdict == "true"


def test_every_quantity_is_read_from_its_phrases():
    for quantity in QUANTITIES:
        for phrase in quantity.phrases:
            assert read_context([f"X = {phrase}"]).meanings[0].quantity == quantity, phrase


def test_formulas_of_quantities_exist():
    names = [known.name for formulas in by_fingerprint().values() for known in formulas]
    for quantity in QUANTITIES:
        assert all(any(phrase in name for name in names) for phrase in quantity.formulas), quantity.title


def test_a_file_of_claims_states_contexts(tmp_path):
    path = tmp_path / "claims.toml"
    path.write_text(
        "schema = 1\n"
        "[[claim]]\nid = 'a'\nsymbols = ['I_zz', 'm', 'R']\nclaim = 'I_zz == m*R**2/2'\nbody = 'solid cylinder'\n"
        "[[claim]]\nid = 'b'\nsymbols = ['T', 'I', 'omega']\nclaim = 'T == I*omega**2'\n"
        f"where = {FIXED}\n"
        "[[claim]]\nid = 'c'\nsymbols = ['x']\nclaim = 'x == x'\nwhere = 'eq. (3)'\n"
    )
    verdicts = symrot.check_file(path)
    assert [verdict.verdict for verdict in verdicts] == ["true", "false", "true"]
    assert verdicts[0].context == "body solid cylinder"
    assert verdicts[2].where == "eq. (3)"


def test_a_file_with_words_about_other_names_is_refused(tmp_path):
    path = tmp_path / "claims.toml"
    path.write_text("schema = 1\n[[claim]]\nid = 'a'\nsymbols = ['x']\nclaim = 'x == x'\nwhere = ['y = torque']\n")
    with pytest.raises(InputError, match="a: where: expected meanings only of names that occur in the claim, got 'y'"):
        symrot.check_file(path)


def test_identify_leaves_out_other_bodies():
    names = [known.name for known in symrot.identify("m*R**2/2", body="disk")]
    assert names == ["moment of inertia of a disk about its centre of mass, z axis"]


def test_definitions_among_the_hypotheses_are_put_in():
    claim = "R = [[c, -s, 0], [s, c, 0], [0, 0, 1]]"
    assert symrot.check(claim, assume=["c == cos(a)", "s == sin(a)"]).verdict == "recognised"
    assert symrot.check(claim, assume=["c == cos(a)", "s == cos(a)"]).verdict != "recognised"


@pytest.mark.campaign
@pytest.mark.parametrize("kind", [kind for kind in BODIES if kind.shape], ids=lambda kind: kind.title)
def test_the_moments_of_a_body_are_true_for_this_body_alone(kind):
    """Each moment that symrot derives for a solid is true with its body and its place, and not with another solid."""
    for known in (known for formulas in by_fingerprint().values() for known in formulas):
        match = re.fullmatch(rf"moment of inertia of {kind.formulas[0]} about (.+), ([xyz]) axis", known.name)
        if match is None or "(0, 0)" in match[1] or "given" in match[1] or kind.title == "cube":
            continue
        claim = f"I_{match[2] * 2} == {known.text}"
        assert symrot.check(claim, body=f"{kind.title} about {match[1]}").verdict == "true", known
        other = "torus" if kind.title != "torus" else "disk"
        assert symrot.check(claim, body=f"{other} about its centre of mass", repair=False).verdict != "true", known


def test_letters_with_other_meanings_accuse_nobody():
    """The vector form of a gyroscope's moment is correct, whatever words are used for its rates."""
    claim = r"\mathbf M = I\,\boldsymbol\Omega\times\mathbf p"
    assert symrot.check(claim, where=["p = spin", "Omega = precession rate"]).verdict in ("recognised", "definition")


@pytest.mark.parametrize(("claim", "body", "verdict"), [
    ("I_x = 3/10 m a²", "solid cone with base radius a, axis x", "true"), ("I_z = 3/10 m a²", "solid cone with base radius a, axis x", "doubtful"),
    ("I_y = ½ m r²", "cylinder with axis along y", "true"), ("I_z = m L²/12", "rod along the x axis", "recognised"),
    ("I_zz = m(a²+b²)/12", "box with sides a, b and c along x, y and z", "recognised"),
])  # fmt: skip
def test_a_body_may_have_another_axis_of_symmetry(claim, body, verdict):
    assert symrot.check(claim, body=body, repair=False).verdict == verdict
