"""Names of formulas, up to renaming, transposition, sign and storage order; every name that is given is proven."""

import json
import tomllib
from itertools import islice

import pytest
from sympy import Matrix, Rational, Symbol, cos, pi, sin, symbols

import symrot
from symrot.checker.claim.reader import read_expression
from symrot.checker.recognition import known_formulas
from symrot.checker.recognition.fingerprint import PRIME, NotInField, fingerprint, values_at
from symrot.checker.recognition.identification import identify
from symrot.checker.recognition.printed_text import read_printed
from symrot.cli.main import main
from symrot.conventions import SEQUENCES
from symrot.errors import InputError

a, b, c = symbols("a b c", real=True)


def names(formula):
    return [identification.name for identification in identify(formula)]


# -- fingerprints -----------------------------------------------------------------------------------------------------


def test_equal_functions_have_equal_values():
    point = {a: 12345, b: 67890}
    pairs = [
        (sin(2 * a), 2 * sin(a) * cos(a)), (cos(a - b), cos(a) * cos(b) + sin(a) * sin(b)), ((a**2 - b**2) / (a - b), a + b),
        (sin(a / 2) ** 2, (1 - cos(a)) / 2), (1 / (1 / a + 1 / b), a * b / (a + b)), (cos(a + pi), -cos(a)), (abs(a * b) ** 2, (a * b) ** 2),
    ]  # fmt: skip
    for left, right in pairs:
        assert values_at([left], point) == values_at([right], point)
    assert values_at([sin(a)], point) != values_at([cos(a)], point)
    assert 0 <= values_at([a / b], point)[0] < PRIME


def test_fingerprints_do_not_depend_on_names():
    first, second = ([x * sin(y), x + y] for x, y in ((a, b), (c, a)))
    keys = [fingerprint(entries).key((2, 1), (0, 1)) for entries in (first, second, [b * sin(b), a + b])]
    assert keys[0] == keys[1] != keys[2]


def test_what_has_no_value_is_outside():
    for entry in (sin(a**a), a ** Symbol("n"), sin(a / 5), a ** Rational(1, 3), Rational(3)):
        with pytest.raises(NotInField):
            fingerprint([entry])


# -- the file ---------------------------------------------------------------------------------------------------------


def test_the_file_is_as_printed(monkeypatch):
    """The formulas of the file are those that symrot derives, in this order: here without those that take longer, and
    with two of the 24 sequences of Euler angles.
    """
    for group in ("solids", "tops", "_solved", "bodies"):
        monkeypatch.setattr(known_formulas, group, lambda: iter(()))
    sequences = known_formulas.sequences
    monkeypatch.setattr(known_formulas, "sequences", lambda: islice(sequences(), 20))
    printed = known_formulas.page(known_formulas.stated()).rstrip().split("\n\n")
    in_the_file = iter(known_formulas.FILE.read_text(encoding="utf-8").split("\n\n"))
    assert len(printed) > 250 and all(formula in in_the_file for formula in printed)


@pytest.mark.campaign
def test_the_whole_file_is_as_printed():
    assert known_formulas.FILE.read_text(encoding="utf-8") == known_formulas.page()


def test_the_file_has_the_same_formulas_as_toml():
    entries = tomllib.loads(known_formulas.FILE.read_text(encoding="utf-8"))["formula"]
    keys = [entry.pop("key") for entry in entries]
    formulas = known_formulas.by_fingerprint()
    for key, entry in zip(keys, entries, strict=True):
        assert known_formulas.Known(**entry) in formulas[key]
    assert sum(map(len, formulas.values())) == len(entries)


def trees_of_known_formulas(one_in):
    """Return (tree by Python's parser, tree by the reader of typed formulas) for one in ``one_in`` known formulas."""
    texts = [known.text for group in known_formulas.by_fingerprint().values() for known in group]
    readable = [text for text in texts[::one_in] if "{" not in text and "'" not in text]
    return [(read_printed(text), read_expression(text)) for text in readable]


def test_pythons_parser_reads_a_printed_formula_as_the_reader_of_typed_formulas_does():
    assert all(tree == other for tree, other in trees_of_known_formulas(60))


@pytest.mark.campaign
def test_all_printed_formulas_are_read_alike():
    assert all(tree == other for tree, other in trees_of_known_formulas(1))


def test_a_step_with_the_terms_of_a_series_is_recognised():
    """The names a_{k} and c_{k} of the step are none that a user can type."""
    (first, *_) = identify("2*x*n + x + y")
    assert first.mapping == {"a_{k}": "x", "c_{k}": "y", "k": "n"}


# -- names ------------------------------------------------------------------------------------------------------------


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_every_sequence_is_recognised_under_other_names(sequence):
    """The matrix, the passive matrix and both rate Jacobians are recognised in angles with other names."""
    angles = (a, b, c)
    dcm = symrot.dcm(sequence, angles)
    kind = "intrinsic" if sequence.isupper() else "extrinsic"
    expected = f"rotation matrix of {kind} {sequence}, body to space"
    assert expected in names(dcm)
    passive = {found.name: found for found in identify(dcm.T)}
    assert passive[expected].how == "transposed" or sequence[0] == sequence[2]
    for frame in ("body", "space"):
        jacobian = Matrix(symrot.rate_jacobian(sequence, frame, angles))
        assert f"{sequence} {frame}-frame rate Jacobian, omega = B dq/dt" in names(jacobian)
        found = {found.name: found for found in identify(-jacobian)}
        assert found[f"{sequence} {frame}-frame rate Jacobian, omega = B dq/dt"].how == "with the other sign"


@pytest.mark.parametrize(("formula", "name", "how"), [
    ("3*M*h**2/5 + 3*M*R**2/20", "moment of inertia of a cone about its tip, x axis", ""), ("M*L**2/3", "moment of inertia of a rod about an end, x axis", ""),
    ("diag(M*R**2/2, M*(3*R**2 + L**2)/12, M*(3*R**2 + L**2)/12)", "inertia tensor of a cylinder about its centre of mass", "with the axes in the order y, z, x"),
    ("Matrix([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]])/2", "quaternion rate matrix, body frame, dq/dt = E omega", "with the scalar part of the quaternion stored last"),
    ("Matrix([(I2 - I3)*w2*w3/I1, (I3 - I1)*w3*w1/I2, (I1 - I2)*w1*w2/I3])", "Euler's equations of a free body, solved for the rates", ""),
    ("Matrix([[0, c, -b], [-c, 0, a], [b, -a, 0]])", "skew matrix of a vector, [v] w = v x w", "with the other sign"),
    ("(I1*w1**2 + I2*w2**2 + I3*w3**2)/2", "kinetic energy of rotation, principal axes", ""), ("dcm_of(e0, e1, e2, e3)", "rotation matrix of a quaternion, homogeneous, body to space", ""),
    ("Matrix([3*n**2*(C - B)*r2*r3, 3*n**2*(A - C)*r1*r3, 3*n**2*(B - A)*r1*r2])", "torque of gravity gradient on a circular orbit, body components", ""),
    ("eye(3) + sin(sqrt(x**2 + y**2 + z**2))/sqrt(x**2 + y**2 + z**2)*skew(x, y, z) + (1 - cos(sqrt(x**2 + y**2 + z**2)))/(x**2 + y**2 + z**2)*skew(x, y, z)**2",
     "rotation matrix of the rotation vector, body to space", ""),
    (r"\begin{pmatrix}\cos\beta&-\sin\beta&0\\\sin\beta&\cos\beta&0\\0&0&1\end{pmatrix}", "rotation about the z axis, body to space", ""),
    ("inverse(Matrix([[0, cos(p), sin(p)*sin(n)], [0, sin(p), -cos(p)*sin(n)], [1, 0, cos(n)]]))", "inverse of the ZXZ space-frame rate Jacobian, dq/dt = B^-1 omega", ""),
])  # fmt: skip
def test_formulas_are_named(formula, name, how):
    found = {identification.name: identification for identification in identify(formula)}
    assert name in found
    assert (found[name].how, found[name].proven) == (how, True)


def test_rates_written_with_functions_of_time():
    (first, *_) = identify(
        "Matrix([diff(theta(t), t)*cos(psi(t)) + diff(phi(t), t)*sin(theta(t))*sin(psi(t)),"
        " diff(phi(t), t)*sin(theta(t))*cos(psi(t)) - diff(theta(t), t)*sin(psi(t)), diff(phi(t), t)*cos(theta(t)) + diff(psi(t), t)])"
    )
    assert first.name == "angular velocity of ZXZ in the body frame"
    assert (first.mapping, str(first)) == ({}, first.name)
    renamed = {found.name: found for found in identify("Rz(a(t))*Ry(diff(b(t), t))*Rx(c)")}
    mapping = renamed["rotation matrix of intrinsic ZYX, body to space"].mapping
    assert mapping == {"phi": "a(t)", "psi": "c", "theta": "diff(b(t), t)"}


@pytest.mark.parametrize("formula", [
    "x*y + z**7", "eye(3)", "sin(x)", "Matrix([[sin(b)*sin(c), cos(c), 0], [sin(b)*cos(c), -sin(c), 0], [cos(b), 0, 2]])",
    "Matrix([[sin(b)*sin(c), cos(b), 0], [sin(b)*cos(c), -sin(c), 0], [cos(b), 0, 1]])", "2*M*R**2/7", "Matrix([[0, c, -b], [-c, 0, a], [b, a, 0]])",
    "abs(x)**3*sqrt(y)", "Matrix([x, y, z])", "diag(A, B, C)",
])  # fmt: skip
def test_what_is_not_known_is_not_named(formula):
    """Some of the formulas differ from known formulas by a factor, a sign or a symbol."""
    assert identify(formula) == []


@pytest.mark.parametrize(
    ("formula", "words"),
    [("a == b", "one formula without '='"), ("a +", "position 4"), (3, "a formula as text"), (r"\foo", "position 1")],
)
def test_bad_formulas_are_refused(formula, words):
    with pytest.raises(InputError, match=words):
        identify(formula)


# -- at work ----------------------------------------------------------------------------------------------------------


def test_a_false_claim_is_told_which_formula_it_holds(tmp_path):
    """The claim has the space-frame Jacobian for the body-frame rates: it is false, and a note names that Jacobian."""
    path = tmp_path / "claims.toml"
    path.write_text(
        "schema = 1\n[[claim]]\nid = 'rates'\nsymbols = ['t']\nfunctions = ['phi', 'theta', 'psi']\n"
        "define = [['R', 'Rz(phi(t))*Rx(theta(t))*Rz(psi(t))'],\n"
        " ['B', 'Matrix([[0, cos(phi(t)), sin(phi(t))*sin(theta(t))], [0, sin(phi(t)), -cos(phi(t))*sin(theta(t))], [1, 0, cos(theta(t))]])']]\n"
        "claim = 'vee(R.T*diff(R, t)) == B*Matrix([diff(phi(t), t), diff(theta(t), t), diff(psi(t), t)])'\n"
    )
    (verdict,) = symrot.check_file(path)
    assert verdict.verdict == "false"
    notes = "\n".join(verdict.notes)
    assert "the left side is the angular velocity of ZXZ in the body frame" in notes
    assert "the right side is the angular velocity of ZXZ in the space frame" in notes
    assert "B is the ZXZ space-frame rate Jacobian, omega = B dq/dt" in notes


def test_at_the_command_line(capsys):
    assert main(["identify", "2*M*R**2/5"]) == 0
    assert "moment of inertia of a sphere about its centre of mass, x axis; with M for m\n" in capsys.readouterr().out
    assert main(["identify", "2*M*R**2/5", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["mapping"] == {"m": "M"}
    assert main(["identify", "2*M*R**2/7"]) == 1
    assert main(["identify", "2*M*"]) == 2


# -- formulas that only get a name ------------------------------------------------------------------------------------


def test_the_name_in_front_of_a_formula_does_not_count():
    assert names(r"I_x = \frac{1}{12} m (b^2 + c^2)") == names("m*(b**2 + c**2)/12") != []
    with pytest.raises(InputError, match="one formula without '='"):
        identify("a*b == c*d")
