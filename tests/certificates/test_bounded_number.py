"""Numbers with bounds of their errors: computed results of random formulas are within the bounds of the exact ones."""

from fractions import Fraction
from math import inf, sqrt
from random import Random

import mpmath
import pytest

from symrot.certificates.exact_step.bounded_number import DOUBLE, PAIR, Bounded, UndecidedError, point
from symrot.certificates.exact_step.bounds import _exact_defect
from symrot.certificates.exact_step.functions import exponential, pair

SCALES = (1.0, 1e-9, 1e150, 1e-150, 1e-300)


def _input(draw):
    """Return an interval, and a double in it."""
    size = draw.choice(SCALES)
    low = draw.choice((0.0, 1.0, draw.uniform(-1, 1))) * size if size < 1 else draw.choice((-0.5, 2.0**-900))
    high = low + draw.choice((0.0, 1e-16, 0.5)) * size
    return Bounded(low, high, 0.0, 0.0), min(max(draw.choice((low, high, draw.uniform(low, high))), low), high)


def _step(draw, left, right):
    """Return the result of one operation on two numbers (bounds, computed, exact), or None if it is not defined."""
    (a, x, u), (b, y, v) = left, right
    mark = draw.choice("+-*/r")
    if mark == "+":
        return a + b, x + y, u + v
    if mark == "-":
        return a - b, x - y, u - v
    if mark == "*":
        return a * b, x * y, u * v
    if mark == "/":
        return (a / b, x / y, u / v) if y and v else None
    # a root whose argument is a square has an exact result
    return ((a * a).root(DOUBLE), sqrt(x * x), abs(u)) if abs(x) < 1e150 else None


@pytest.mark.parametrize("seed", range(4))
def test_errors_of_random_formulas_are_within_their_bounds(seed):
    draw, checked = Random(seed), 0
    for _ in range(1500):
        numbers = []
        for _ in range(3):
            bounds, value = _input(draw)
            numbers.append((bounds, value, Fraction(value)))
        for _ in range(4):
            result = _step(draw, draw.choice(numbers), draw.choice(numbers))
            if result is None or not abs(result[1]) < 1e300:
                break
            bounds, computed, exact = result
            error = abs(Fraction(computed) - exact)
            assert bounds.low == -inf or Fraction(bounds.low) <= exact
            assert bounds.high == inf or exact <= Fraction(bounds.high)
            assert bounds.error == inf or error <= Fraction(bounds.error)
            assert bounds.relative == inf or error <= Fraction(bounds.relative) * abs(exact)
            assert bounds.computed[0] <= computed <= bounds.computed[1]
            checked += bounds.error < inf
            numbers.append(result)
    assert checked > 1000


def test_comparisons_that_differ_in_the_set_are_undecided():
    wide = Bounded(1.0, 2.0, 0.0, 0.0)
    assert wide < point(2.5) and wide > point(0.5) and point(0.1) * point(0.1) < point(0.011)
    for other in (point(1.5), wide, point(2.0)):
        with pytest.raises(UndecidedError):
            _ = wide < other
    with pytest.raises(UndecidedError):  # the rounding error decides
        _ = point(0.1) * point(10.0) < point(1.0)


def test_numbers_too_small_for_sums_of_two_doubles_lose_their_relative_bound():
    """The rest of such a quotient or root is a product below the smallest double."""
    small = point(1e-300)
    assert small.over(point(3e-10), PAIR).relative > 1e-25 and small.root(PAIR).relative > 1e-25
    assert point(1e-200).over(point(3e-10), PAIR).relative < 2.0**-101
    assert small.over(point(3e-300), PAIR).error < inf


def test_the_root_of_zero_is_exact():
    assert point(0.0).root(PAIR).is_exact


@pytest.mark.parametrize("x", [-1e300, -1e6, -746.0, -745.2, -744.0, -709.5, -700.0, -1.0, 0.0, 700.0, 709.9, 1e300])
def test_an_exponential_is_positive_also_where_a_double_underflows_to_zero(x):
    """exp(-746) is 0 as a double, and 1e-324 in truth."""
    result = exponential(point(x))
    with mpmath.workdps(30):
        exact = mpmath.exp(x) if x > -1e299 else mpmath.mpf(10) ** -1000
    assert mpmath.mpf(result.low) <= exact <= mpmath.mpf(result.high)
    assert result.high > 0 and result.error > 0


def test_bounds_of_errors_do_not_underflow_to_zero():
    """The products of bounds below the smallest double are positive, so that no rounded number counts as exact."""
    tiny = 5e-324
    assert Bounded(tiny, tiny, inf, DOUBLE).error > 0 and not Bounded(tiny, tiny, inf, DOUBLE).is_exact
    assert Bounded(1e10, 1e10, tiny, inf).relative > 0
    assert Bounded(0.0, 0.0, inf, DOUBLE).is_exact and Bounded(1.0, 1.0, 0.0, inf).is_exact


def test_products_that_underflow_are_undecided_where_they_count_as_exact():
    """The C text sums |L|^2 - 2 T I_mid exactly; a part 1e-300 of it is not nothing."""
    moments = [pair(point(x)) for x in (1e-160, 1.0, 1.0)], 0
    omega = [pair(Bounded(1e-90, 1e-80, 0.0, 0.0)) for _ in range(3)], 0
    with pytest.raises(UndecidedError):
        _exact_defect(moments, omega)
