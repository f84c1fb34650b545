"""Claims with a context in words: what names mean, the body, the frame, the sequence of angles."""

import re

import pytest

import symrot
from symrot.checker.context.bodies import BODIES, body_of_words
from symrot.checker.context.context import read_context
from symrot.checker.context.quantities import QUANTITIES
from symrot.checker.recognition.known_formulas import by_fingerprint
from symrot.errors import InputError
from symrot.inertia.shapes import SHAPES

CYLINDER = "solid cylinder of radius r and height h"
TOP = "symmetric top with moments I_1, I_1, I_3"
FREE = "free symmetric body with moments I_1, I_1, I_3"
FIXED = ["T = kinetic energy of rotation", "I = moment of inertia about the fixed axis"]


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
    ("Omega = M g l/(I_1 omega_3)", "recognised", {"where": ["Omega = rate of slow precession"], "body": "fast top"}),
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
    assert "of the context, these words are not used: rainy day" in verdict.notes


def test_a_context_that_decides_nothing_is_said_to_be_unused():
    verdict = symrot.check("sin(x)^2 + cos(x)^2 = 1", body="disk")
    assert (verdict.verdict, verdict.context) == ("true", "body disk")
    assert "the context is not used, since the formulas of the claim decide it" in verdict.notes


def test_the_letters_of_a_body_are_its_dimensions():
    """With a for b, I_zz of a box would be true for the wrong axes."""
    assert symrot.check("I_zz = m (a^2 + b^2)/12", body="box of sides a, b, c about its centre").verdict == "true"
    assert symrot.check("I_zz = m (a^2 + c^2)/12", body="box of sides a, b, c about its centre").verdict == "false"


def test_words_about_another_place_are_not_taken_for_the_centre_of_mass():
    verdict = symrot.check(
        "I_xx = m (3 R^2 + 4 L^2)/12", body="solid cylinder about the centre of a hole", repair=False
    )
    assert verdict.verdict == "recognised"
    assert "of the context, these words are not used: hole" in verdict.notes


def test_a_letter_that_is_no_usual_one_is_never_called_false():
    """With the diameter D, m D^2/8 is the moment of a cylinder; nothing says that D is the radius."""
    assert symrot.check("I_zz = m D^2/8", body="solid cylinder").verdict == "definition"


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
    ({"where": ["T = torque, I = spin"]}, "write one text for each"),
    ({"where": ["Q = torque"]}, "expected words about names that the claim has, got 'Q'"),
    ({"where": ["I = spin", "I = torque"]}, "expected one meaning of I, got 'spin' and 'torque'"),
    ({"where": ["omega = torque"]}, "expected a quantity in rad/s, as the name omega says, got 'torque'"),
    ({"where": ["T = torque"], "units": {"T": "J/s"}}, "expected a quantity in J/s, the unit stated for T"),
    ({"where": ["T = kinetic energy of a sphere"], "body": "disk"}, "expected a solid sphere, as the words about T say"),
    ({"where": ["omega = angular velocity in space"], "frame": "body"}, "expected the space frame"),
    ({"where": "T = torque"}, "expected a list of texts"),
    ({"body": "banana"}, "body: expected a body, got 'banana'"),
    ({"frame": "bodi"}, "frame: expected 'body' or 'space', got 'bodi'"),
    ({"sequence": "ZZX"}, "sequence: expected three axes, no two neighbours equal"),
    ({"sequence": "ABC"}, "sequence: expected three axes"),
    ({"sequence": "space 1-2-3 intrinsic"}, "sequence: expected three axes"),
    ({"body": 3}, "body: expected a text, got 3"),
])  # fmt: skip
def test_a_context_that_means_nothing_or_contradicts_is_refused(context, message):
    with pytest.raises(InputError, match=message):
        symrot.check("T = 1/2 I omega^2", **context)


def test_a_context_of_sympy_values_is_refused():
    with pytest.raises(InputError, match="expected a claim as text with a context"):
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
    with pytest.raises(InputError, match="a: where: expected words about names that the claim has, got 'y'"):
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
