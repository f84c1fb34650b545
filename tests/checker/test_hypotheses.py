"""Claims under polynomial hypotheses: refused if no point obeys these, false with an exact point that obeys these.

Every counterexample is inserted into hypotheses and claim again by mpmath, from their texts.
"""

from random import Random

import pytest
from sympy import symbols
from sympy.polys.domains import QQ
from sympy.polys.groebnertools import groebner
from sympy.polys.orderings import grevlex, lex
from sympy.polys.rings import ring

import symrot
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.exact.ring.groebner import groebner_basis
from symrot.exact.ring.ratio import TooLarge
from tests.checker.test_check import values_at

UNIT = "q0**2 + q1**2 + q2**2 + q3**2 == 1"
ORTHONORMAL = ["p1**2 + p2**2 + p3**2 == 1", "q1**2 + q2**2 + q3**2 == 1", "p1*q1 + p2*q2 + p3*q3 == 0"]

NOWHERE = (
    ("x == x", ["x**2 == -1"], "x[*]{2}2 [+] 1"),
    ("q1 == q1", [UNIT, "q0 == 2"], "q0 - 2"),
    ("x == x", ["x + y == 1", "x + y == 2"], "contradict"),
    ("x == x", ["x > 0", "x == -1"], "x [+] 1"),
    ("x == x", ["x > 0", "y > 0", "x + y == 0"], "x [+] y"),
    ("x == x", ["x**2 + y**2 == -1"], "cannot be"),
    ("x == x", ["x**2 - 2*x*y + 2*y**2 == -1"], "cannot be"),
    ("x == x", ["x**4 + x + 1 == 0"], "cannot be"),
    ("x == x", ["sin(a) == 2"], "sin[(]a[)] - 2"),
    ("x == x", ["sin(a) == 3*cos(b) + 5"], "cannot be"),
    ("x == x", ["sqrt(y) == -1"], "cannot be"),
    ("x/x == 1", ["x**2 == 0"], "where both sides are defined"),
    ("I1 == I1", ["I1 > 0", "I2 > 0", "I1*I2 == -I3**2"], "cannot be"),
    ("x == y", ["x == y", "x*y == -1"], "contradict|cannot be"),
)


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("claim", "given", "words"), NOWHERE, ids=[", ".join(given) for _, given, _ in NOWHERE])
def test_hypotheses_that_hold_nowhere_prove_nothing(claim, given, words):
    with pytest.raises(InputError, match=words) as refusal:
        symrot.check(claim, assume=given)
    assert "\n" not in str(refusal.value)


FALSE = (
    ("q0 == q1", [UNIT, "q0*q1 == q2*q3"]),
    ("I1 == I2", ["I1*I2 == I3**2"]),
    ("I1 == I2", ["I1*I2 == I3**2", "I1 > 0", "I2 > 0"]),
    ("r == x + y", ["r**2 == x**2 + y**2"]),
    ("r == x", ["r**2 == x**2 + y**2", "r > 0", "y > 0"]),
    ("omega2*I2 == L", ["omega1*I1 == L"]),
    ("p1 == q2", ORTHONORMAL),
    ("x == y", ["x**2/a**2 + y**2/b**2 == 1"]),
    ("x == y", ["x**3 + y**3 == 9"]),
    ("x == y", ["x**2 - 2*y**2 == 1"]),
    ("x == y", ["x**2 + y**2 == 3"]),
    ("x == 1", ["x**2 == 2"]),
    ("x == 1", ["x**3 == 2"]),
    ("sin(x) == x", ["x**2 == 2"]),
    ("T == I1*w1**2/2", ["2*T == I1*w1**2 + I2*w2**2", "L**2 == I1**2*w1**2 + I2**2*w2**2", "I1 > 0", "I2 > 0"]),
    ("a == b", ["a**2 + b**2 == c**2", "a > 0", "b > 0", "c > 0"]),
    ("x == y", ["a*x == a*y"]),
)


@pytest.mark.parametrize(("claim", "given"), FALSE, ids=[f"{claim} given {given}" for claim, given in FALSE])
def test_a_counterexample_obeys_the_hypotheses(claim, given):
    verdict = symrot.check(claim, assume=given, repair=False)
    assert verdict.verdict == "false"
    values = verdict.counterexample.values
    for hypothesis in given:
        if "==" in hypothesis:
            left, right = values_at(hypothesis, values)
            assert abs(left - right) < 1e-30
        else:
            assert values_at(hypothesis.replace(">", "=="), values)[0] > 0
    left, right = values_at(claim, values)
    assert abs(left - right) > 1e-10


def test_a_hypothesis_beyond_double_precision_is_obeyed():
    verdict = symrot.check("x*y == 1", assume=["x*10**308*10**308 == 1"])
    assert verdict.verdict == "false"
    assert verdict.counterexample.values["x"] == f"1/1{'0' * 616}"


def test_points_that_need_a_root_of_higher_degree_name_it():
    shown = symrot.check("x == y", assume=["x**2 + y**2 == 1", "x*y == 1/3"], repair=False).counterexample
    assert shown.values["root"].startswith("CRootOf(")
    assert shown.rhs == "root"


TRUE = (
    ("x == 0", ["x**2 == 0"]),
    ("x == 0", ["x**2 + y**2 == 0"]),
    ("x == y", ["a*x == a*y", "a != 0"]),
    ("x == y", ["a*x == a*y", "a > 0"]),
    ("x == y", ["x**2 == y**2", "x > 0", "y > 0"]),
    ("x == y", ["x**3 == y**3"]),
    ("x == 1", ["x**3 == 1"]),
    ("sin(x) == 0", ["cos(x) == 1"]),
    ("I1/I3 == I3/I2", ["I1*I2 == I3**2"]),
    ("L/I1 == omega1", ["omega1*I1 == L"]),
    ("r == sqrt(x**2 + y**2)", ["r**2 == x**2 + y**2", "r > 0"]),
    ("(p2*q3 - p3*q2)**2 + (p3*q1 - p1*q3)**2 + (p1*q2 - p2*q1)**2 == 1", ORTHONORMAL),
    ("x**2/a**2 == 1 - y**2/b**2", ["x**2/a**2 + y**2/b**2 == 1"]),
)


@pytest.mark.parametrize(("claim", "given"), TRUE, ids=[f"{claim} given {given}" for claim, given in TRUE])
def test_what_follows_for_real_numbers_is_true_without_a_note(claim, given):
    """A power of left - right is in the ideal, perhaps after division by a nonzero formula, or signs decide."""
    verdict = symrot.check(claim, assume=given)
    assert (verdict.verdict, verdict.notes) == ("true", ())


def test_a_condition_that_the_hypotheses_exclude_is_not_offered():
    assert symrot.check("A*w == B*w", assume=["A == B + 1"], repair=False).verdict == "false"
    assert symrot.check("A*w == B*w", repair=False).verdict == "conditional"


def test_a_verdict_without_a_known_point_says_so():
    """The origin is the only rational point of x^2 + y^2 = 3 z^2; an irrational point is found."""
    assert symrot.check("z == 1", assume=["x**2 + y**2 == 3*z**2", "z != 0"], repair=False).verdict == "false"
    hard = "x**6 + y**6 + z**6 - 3*x**2*y**2*z**2 + x**2*y + 7 == 0"
    verdict = symrot.check("x + y == y + x", assume=[hard])
    assert verdict.verdict == "true"
    assert verdict.notes == () or "no real point is known" in verdict.notes[0]


def test_a_note_is_shown_and_exported():
    verdict = Verdict("true", notes=("no real point is known",))
    assert "note: no real point is known" in str(verdict)
    assert verdict.to_json()["notes"] == ["no real point is known"]


def test_signs_of_sympy_symbols_count():
    x, y = symbols("x y", positive=True)
    assert symrot.check(x, y, assume=[x**2 - y**2]).verdict == "true"
    u, v = symbols("u v", negative=True)
    assert symrot.check(u, v, assume=[u**2 - v**2]).verdict == "true"
    assert symrot.check(u, x, assume=[u**2 - x**2], repair=False).verdict == "false"


@pytest.mark.parametrize("order", [lex, grevlex], ids=str)
def test_groebner_bases_are_those_of_sympy(order):
    source = Random(3)
    base, *unknowns = ring("x y z", QQ, order)
    for _ in range(25):
        polynomials = [
            base.from_dict({
                tuple(source.choice((0, 0, 1, 2)) for _ in unknowns): QQ(source.randint(1, 5)) for _ in range(3)
            })
            for _ in range(2)
        ]  # fmt: skip
        assert groebner_basis(polynomials, base) == tuple(groebner(polynomials, base))


def test_a_groebner_basis_stops_at_its_budget():
    base, x, y, z = ring("x y z", QQ, lex)
    with pytest.raises(TooLarge, match="at most 100 products"):
        groebner_basis([x**3 + y**2 * z + 1, y**3 + z**2 * x + 1, z**3 + x**2 * y + 2], base, 100)


def test_random_hypotheses_never_give_a_wrong_verdict():
    """A planted point obeys the hypotheses: a claim that fails there is not called true, and none is refused."""
    source = Random(11)
    names = ("x", "y", "z")
    for _ in range(25):
        point = {name: source.randint(-3, 3) for name in names}
        given = []
        for _ in range(source.randint(1, 2)):
            terms = [source.choice(names) + "*" + source.choice(names) for _ in range(2)] + [source.choice(names)]
            formula = " + ".join(f"{source.randint(1, 3)}*{term}" for term in terms)
            given.append(f"{formula} == {eval(formula, {}, point)}")
        claim = f"{source.choice(names)}*{source.choice(names)} == {source.choice(names)} + {source.randint(-2, 2)}"
        left, right = (eval(side, {}, point) for side in claim.split("=="))
        verdict = symrot.check(claim, assume=given, repair=False).verdict
        assert verdict != "true" or left == right, (claim, given, point)


def test_a_square_over_a_root_is_known_not_to_be_negative():
    """The root has the sign of a square, so that its sign is no condition."""
    claim = "cos(a)**2/abs(cos(a))*x == sqrt((1 - 2*sin(a/2)**2)**2)*x"
    assert symrot.check(claim).verdict == "true"
    wrong = symrot.check("cos(a)*x == sqrt((1 - 2*sin(a/2)**2)**2)*x", repair=False)
    assert wrong.verdict == "conditional" and wrong.counterexample


@pytest.mark.parametrize(("claim", "given", "verdict"), [
    ("R₃₁ = −sin θ", "R = R_z(φ) R_y(θ) R_x(ψ)", "true"), ("R₃₁ = sin θ", "R = R_z(φ) R_y(θ) R_x(ψ)", "false"),
    ("r_21/r_11 = tan(φ)", "R = R_z(φ) R_y(θ) R_x(ψ)", "true"), ("r_12/r_11 = tan(φ)", "R = R_z(φ) R_y(θ) R_x(ψ)", "false"),
    ("θ = −asin(R₃₁)", "R = R_z(ψ) R_y(θ) R_x(φ)", "conditional"),
    ("theta = atan2(sqrt(r13^2 + r23^2), r33)", "R = Rz(phi) Ry(theta) Rz(psi)", "conditional"),
    (r"\psi = \operatorname{atan2}(R_{21}, R_{11})", r"R = R_z(\psi)R_y(\theta)R_x(\phi)", "conditional"),
    (r"\psi = \operatorname{atan2}(R_{12}, R_{11})", r"R = R_z(\psi)R_y(\theta)R_x(\phi)", "false"),
    (r"R\mathbf{a}\times R\mathbf{b} = R(\mathbf{a}\times\mathbf{b})", r"R = R_z(\phi)R_x(\theta)R_z(\psi)", "true"),
    (r"R\mathbf{a}\times R\mathbf{b} = R(\mathbf{b}\times\mathbf{a})", r"R = R_z(\phi)R_x(\theta)R_z(\psi)", "false"),
])  # fmt: skip
def test_a_hypothesis_may_define_a_matrix_and_so_its_entries(claim, given, verdict):
    assert symrot.check(claim, assume=[given]).verdict == verdict


@pytest.mark.parametrize(("claim", "hypothesis", "context"), [
    ("I = m L^2/3", "L == 1", {"body": "rod about its centre"}),
    ("I_zz = m a^2/6", "a == b", {"body": "box of sides a, b, c"}),
    ("ω_3 = φ' + ψ'", "theta == 0", {"sequence": "ZXZ", "frame": "body"}),
])  # fmt: skip
def test_a_formula_that_hypotheses_may_make_right_is_not_accused(claim, hypothesis, context):
    verdict = symrot.check(claim, assume=[hypothesis], **context)
    assert verdict.verdict in ("definition", "recognised", "true")


@pytest.mark.parametrize("hypothesis", ["exp(x) == 1", "sinh(x) == 0"])
def test_a_condition_that_fails_at_no_known_point_decides_nothing(hypothesis):
    """The hypothesis makes x zero, so the claim is true; it was conditional on A == B."""
    verdict = symrot.check("x*A == x*B", assume=[hypothesis])
    assert verdict.verdict == "undecided" and "no point is known" in verdict.reason


def test_a_point_in_closed_form_is_tried_before_algebraic_numbers(monkeypatch):
    """Without a hypothesis this claim takes a hundredth of a second; random points with roots took ten seconds."""

    def adjoined(*arguments):
        raise AssertionError("a root was added to a number field")

    monkeypatch.setattr("symrot.checker.decide.real_points._Drawing.adjoined", adjoined)
    verdict = symrot.check("sqrt(2*g*h) == 3*sqrt(1090)*abs(m/s)/10", assume=["a == b"], repair=False)
    assert verdict.verdict == "false"
    point = dict(verdict.counterexample.point)
    a, b = symbols("a b", real=True)
    assert point[a] == point[b]
