"""Claims that hold only for real numbers, or for vectors in special directions."""

import pytest
from sympy import Symbol

from symrot import check


@pytest.mark.parametrize(("text", "condition"), [
    ("|z|² = z²", "z is real"),
    (r"|z|^2 = z^2\,", "z is real"),
    ("F·d = F d", "F and d have the same direction"),
    (r"\mathbf{F}\cdot\mathbf{d} = F d", "F and d have the same direction"),
    (r"\vec F\cdot\vec d = F d", "F and d have the same direction"),
    ("|a × b| = a b", "a and b are perpendicular"),
])  # fmt: skip
def test_the_special_case_is_the_condition(text, condition):
    verdict = check(text)
    assert (verdict.verdict, verdict.requires) == ("conditional", (condition,))


@pytest.mark.parametrize(("text", "outcome"), [
    ("max(a,b) = (a + b + |a-b|)/2", "true"), (r"\max(a, b) = \frac{a+b-|a-b|}{2}", "false"), ("min(a,b) + max(a,b) = a + b", "true"),
    ("300 days = 2.592e7 s", "true"), ("2 hours = 7000 s", "false"), ("ω_max = a_min", "definition"),
])  # fmt: skip
def test_extremes_and_times_in_words_are_read(text, outcome):
    assert check(text, repair=False).verdict == outcome


@pytest.mark.parametrize(("text", "outcome"), [
    ("abs(z)**2 == z**2", "true"), ("|z w| = |z| |w|", "true"), ("m·g = m g", "true"), ("|a|² = a²", "true"),
    (r"\vec F\cdot\vec d = 2 F d", "false"), ("W = F·d = F d cos θ", "definition"), ("A·B = AB cos θ", "definition"),
])  # fmt: skip
def test_other_claims_have_no_special_case(text, outcome):
    assert check(text, repair=False).verdict == outcome


@pytest.mark.parametrize(("sign", "solution"), [("nonpositive", -1), ("nonnegative", 1), ("negative", -1)])
def test_a_counterexample_keeps_the_assumptions_on_a_symbol(sign, solution):
    x = Symbol("x", **{sign: True})
    point = check(x * (x - solution) * (x + 2 * solution), 0 * x, repair=False).counterexample
    assert point is not None and (int(point.values["x"]) * solution) >= 0


@pytest.mark.parametrize(("text", "outcome"), [
    ("sin(x)**128 == (1 - cos(x)**2)**64", "true"), ("sin(x)**130 == (cos(x)**2 - 1)**65", "false"),
    ("(a**2 - 2*a*b + b**2)**100 == (a - b)**200", "true"),
    ("(AB)^-1 = A^-1 B^-1", "false"), ("(AB)^-1 = B^-1 A^-1", "true"),
    (r"[\mathbf{a}]_\times^2 = \mathbf{a}\mathbf{a}^T - |\mathbf{a}|^2 \mathbf{I}", "true"), (r"\mathbf{L} = \mathbf{I}\boldsymbol\omega", "recognised"),
])  # fmt: skip
def test_large_powers_inverses_and_unit_matrices(text, outcome):
    assert check(text, repair=False).verdict == outcome


def test_conditions_that_contradict_each_other_are_no_range():
    assert check("(-x)**(2*n) == x**(2*n)").conditions == ("x < 0 and x > 0",)
