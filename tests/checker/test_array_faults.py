"""Formulas of vectors, matrices and quaternions as wholes: correct ones are recognised, faulty ones are repaired."""

import pytest

import symrot

CORRECT = (
    "B = cos(beta) I + (1 - cos(beta)) m m^T + sin(beta) [m x]",
    r"\dot{C} = C[\boldsymbol\Omega]_\times",
    r"\dot{C} = S(\omega) C",
    "v' = p v p*",
    "Omega = 2 p* p'",
    "s_dot = 1/4 ((1 - s^T s) I + 2 [s x] + 2 s s^T) w",
)


@pytest.mark.parametrize("text", CORRECT)
def test_correct_formulas_of_arrays_are_recognised(text):
    assert symrot.check(text, repair=False).verdict == "recognised"


FAULTY = (
    # a factor 1 - cos beta, a square, a sign and a half are missing, and s is written for c
    ("B = cos(beta) I + m m^T + sin(beta) [m x]", [], "factor", "B = cos(beta)*eye(3) + (1 - cos(beta))*m*m.T + sin(beta)*skew(m)"),
    ("R = I + sin(x) W + (1 - cos(x)) W", ["W = [[0, -c, b], [c, 0, -a], [-b, a, 0]]", "a^2 + b^2 + c^2 = 1"], "exponent",
     "R = eye(3) + sin(x)*W + (1 - cos(x))*W^2"),
    ("g_dot = 1/2 (I + [g x] - g g^T) w", [], "sign_of_term", "g_dot = 1/2*(eye(3) + skew(g) + g*g.T)*w"),
    ("g_dot = (I + [g x] + g g^T) w", [], "factor", "g_dot = 1/2*(eye(3) + skew(g) + g*g.T)*w"),
    ("R = [[c, -s, 0], [s, s, 0], [0, 0, 1]]", ["c = cos(psi)", "s = sin(psi)"], "wrong_symbol",
     "R = [[c, -s, 0], [s, c, 0], [0, 0, 1]]"),
)  # fmt: skip


@pytest.mark.parametrize(("text", "given", "code", "repair"), FAULTY)
def test_one_fault_of_a_formula_of_arrays_is_named_and_repaired(text, given, code, repair):
    verdict = symrot.check(text, assume=given)
    assert (verdict.verdict, verdict.diagnosis.code) == ("doubtful", code)
    assert repair in [offer.text for offer in verdict.repairs]


def test_a_formula_that_its_unit_axis_makes_right_is_not_accused():
    """(cos) 1 + (1 - cos) u u^T + (sin) K is Rodrigues' formula with K^2 = u u^T - 1, which holds for a unit vector."""
    given = ["a^2 + b^2 + c^2 = 1"]
    rows = "[[1 - (1 - C) (b^2 + c^2), a b (1 - C) - c S, a c (1 - C) + b S]," + (
        " [a b (1 - C) + c S, 1 - (1 - C) (1 - b^2), b c (1 - C) - a S],"
        " [a c (1 - C) - b S, b c (1 - C) + a S, 1 - (1 - C) (a^2 + b^2)]]"
    )
    text = "R = " + rows.replace("C", "cos(x)").replace("S", "sin(x)")
    assert symrot.check(text, assume=given).verdict in ("recognised", "definition")


def test_the_letter_that_a_star_repeats_is_not_multiplied_by_itself():
    assert symrot.check("x*x = x^2").verdict == "true"
    assert symrot.check("x * x = x^2").verdict == "true"
