"""Conditions as books write them: ranges of angles and symbols, nothing that holds everywhere or follows from another."""

import pytest
from sympy import Abs, cos, pi, sin, sqrt, symbols

import symrot
from symrot.checker.decide.ranges.text import follow, range_text

x, y, a, k, m, theta = symbols("x y a k m theta", real=True)

SIGNS = {
    "0 <= x <= pi": [(x, ">= 0"), (pi - x, ">= 0")],
    "-pi < x <= pi": [(x + pi, "> 0"), (pi - x, ">= 0")],
    "-pi/4 < x < pi/4": [(2 * x + pi / 2, "> 0"), (pi / 2 - 2 * x, "> 0")],
    "0 <= x - y <= pi": [(x - y, ">= 0"), (pi - x + y, ">= 0")],
    "x >= y": [(2 * x - 2 * y, ">= 0")],
    "k*m > 0": [(k / m, ">= 0"), (m / k, ">= 0"), (k, "!= 0"), (m, "!= 0")],
    "-1 < x < 1": [((1 + x) / (1 - x), "> 0"), (1 - x, "!= 0")],
    "x >= 1": [(x + 1, ">= 0"), (x - 1, ">= 0"), (x**2 - 1, ">= 0")],
    "abs(x) >= 1": [(x**2 - 1, ">= 0"), (x, "!= 0")],
    "x >= 3": [(x**2 - 9, ">= 0"), (x + sqrt(x**2 - 9), "> 0")],
    "a != 0": [(a * (a * sqrt(a**2 + 1) + Abs(a)), "> 0")],
    "-sqrt(2) <= x <= sqrt(2)": [(2 - x**2, ">= 0")],
    "sin(x) >= 0": [(sin(x / 2) * cos(x / 2), ">= 0")],
    "cos(theta) > 0 and a != 0": [(a**2 * cos(theta), "> 0")],
    "x > 0 and y > 0": [(x, "> 0"), (y, "> 0"), (x * y, "> 0"), (x + y, "> 0"), (x + 1, "!= 0")],
    "x > 2": [((x - 2) ** 3, "> 0"), (x, "!= 0")],
    "-pi/2 < x < pi/2": [(x + pi / 2, "> 0"), (pi / 2 - x, "> 0"), (cos(x), "!= 0")],
    "x < 0 and y != 0": [(-x * Abs(y), "> 0"), (-x, ">= 0")],
    "": [
        (x**2 + 1, "> 0"),
        (1 - sin(x), ">= 0"),
        (1 - cos(x) ** 2, ">= 0"),
        (sqrt(x**2 + 1) - x, "> 0"),
        (x**2 + x + 1, "!= 0"),
    ],
}


@pytest.mark.parametrize(("text", "signs"), SIGNS.items(), ids=SIGNS)
def test_conditions_are_written_as_a_book_writes_them(text, signs):
    assert range_text(signs) == text


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "condition"), [
    ("(1 - x**2)/sqrt((x - 1)**2) == -1 - x", "x > 1"), ("tan(x/2) == sqrt((1 - cos(x))/(1 + cos(x)))", "sin(x) > 0"),
    ("abs(x)*abs(y) == x*y", "x*y >= 0"), ("acos(1 - 2*x**2) == 2*asin(x)", "0 <= x <= 1"),
    ("acos((trace(Rz(a)) - 1)/2) == a", "0 <= a <= pi"), ("sqrt((1 - cos(x))/2) == sin(x/2)", "sin(x/2) >= 0"),
    ("sqrt(a**2 + 2*a*b + b**2) == a + b", "a + b >= 0"), ("asin(2*x*sqrt(1 - x**2)) == 2*asin(x)", None),
    (r"\arccos(\cos\theta) = \theta", r"0 \leq \theta \leq \pi"), (r"\sqrt{x^2} = x", r"x \geq 0"),
    ("sqrt(φ^2) = φ", "φ >= 0"), ("atan2(sin(b), sqrt(cos(b)**2)) == b", "-pi/2 <= b <= pi/2"),
    ("atan2(abs(sin(b)), cos(b)) == b", "0 <= b <= pi"), ("√(x²) = x; √(y²) = y", "x >= 0 and y >= 0"),
    ("sin(x/2) = ±√((1 - cos x)/2)", "sin(x/2) <= 0 for the lower sign"),
    ("3*asin(x) == asin(3*x - 4*x**3)", "-1/2 <= x <= 1/2"), ("3*acos(x) == acos(4*x**3 - 3*x)", "1/2 <= x <= 1"),
    ("asin x + asin y = asin(x sqrt(1 - y^2) + y sqrt(1 - x^2))", "-pi/2 <= asin(x) + asin(y) <= pi/2"),
    ("asin(y) == acos(y) - 3*pi/2", "y == -1"), ("asin x = arccos x - 3π/2", "x = -1"),
])  # fmt: skip
def test_a_conditional_claim_states_its_range_in_its_own_notation(claim, condition):
    verdict = symrot.check(claim, repair=False)
    assert verdict.verdict == "conditional"
    assert condition in (None, *verdict.requires)


@pytest.mark.parametrize(("claim", "conditions"), [
    ("sqrt((1 - x)/(1 + x))*sqrt(1 - x**2) == 1 - x", ("-1 < x <= 1",)), ("sqrt(k/m)*sqrt(m/k) == 1", ("k*m > 0",)),
    ("log((x + 1)/(1 - x)) == -log((1 - x)/(x + 1))", ("-1 < x < 1",)), ("asinh(-x) == -asinh(x)", ()),
])  # fmt: skip
def test_a_condition_that_the_domain_grants_is_no_condition(claim, conditions):
    verdict = symrot.check(claim, repair=False)
    assert (verdict.verdict, verdict.conditions) == ("true", conditions)


def test_a_condition_follows_only_from_what_grants_it():
    assert follow([(x + 1, ">= 0")], [(x, ">= 0")])
    assert not follow([(x - 1, ">= 0")], [(x, ">= 0")])
    assert not follow([(x * y, ">= 0")], [(x, ">= 0")])
    assert not follow([(x, "> 0")], [(x, ">= 0")])
    assert not follow([(x, ">= 0")], [(x**2 * y, ">= 0"), (y, "> 0")])


@pytest.mark.parametrize(("claim", "condition"), [
    ("sqrt(x**2*y**2) == x*y", "x*y >= 0"), ("2*atan(x) == asin(2*x/(1+x**2))", "-1 <= x <= 1"),
    ("sqrt((x**2-1)**2) == -(x**2-1)", "-1 <= x <= 1"), ("abs(x**2-1) == x**2-1", "abs(x) >= 1"),
])  # fmt: skip
def test_a_condition_excludes_no_point_where_both_sides_are_equal(claim, condition):
    verdict = symrot.check(claim, repair=False)
    assert (verdict.verdict, verdict.requires, verdict.conditions) == ("conditional", (condition,), (condition,))


def test_a_condition_excludes_the_points_where_a_side_has_no_value():
    assert symrot.check("sqrt(x**2*y**2)/y == x", repair=False).conditions == ("x*y >= 0", "y != 0")


def test_a_bound_of_an_exponential_is_a_bound_of_its_exponent():
    verdict = symrot.check("acosh(cosh(x)) == x")
    assert verdict.verdict == "conditional"
    assert verdict.requires == ("x >= 0",)
    assert verdict.conditions == ("x >= 0",)


@pytest.mark.parametrize("text", [
    "asin x + asin y = asin(x sqrt(1 - y^2) + y sqrt(1 - x^2))", "acos x - acos y = acos(x y + sqrt(1-x^2) sqrt(1-y^2))",
])  # fmt: skip
def test_a_sum_of_angles_needs_no_condition_on_the_argument_of_its_inverse_function(text):
    """``1 - (x*sqrt(1 - y^2) + y*sqrt(1 - x^2))^2`` is a square, so asin of it has a value wherever the roots have."""
    verdict = symrot.check(text, repair=False)
    assert verdict.conditions[1:] == ("-1 <= x <= 1", "-1 <= y <= 1")


def test_a_radicand_with_roots_that_may_be_negative_stays_a_condition():
    verdict = symrot.check("sqrt(x*sqrt(1 - y**2) + 1)**2 == x*sqrt(1 - y**2) + 1", repair=False)
    assert any("x*sqrt(1 - y**2)" in condition for condition in verdict.conditions)
    assert symrot.check("sqrt(1 + 1/x + sqrt(y)) == sqrt(sqrt(y) + (x + 1)/x)", repair=False).verdict == "true"
