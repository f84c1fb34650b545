"""Numbers that enclosures call certain are the exact numbers, rounded once."""

from fractions import Fraction

import numpy as np
import pytest

from symrot.ensemble.enclosed import exact
from symrot.formula.exact_functions import exact_value
from symrot.formula.tree import evaluate, parse

SIZES = {"ordinary": 1.0, "tiny": 1e-150, "huge": 1e150, "beyond": 1e300}
FORMULAS = ["a*b", "(a - b)/c", "a/3 + b/7", "(a + b)*(a - b) - a**2 + b**2", "a**3/b**2", "-(a - b)*c/(a + b)",
            "a*b*c/(a*b + b*c + c*a)", "(a/b)*b - a", "2/3*a", "a**2*1e-300*c**2"]  # fmt: skip


def samples(size):
    """Return 200 values for each of a, b, c: random, equal, neighbouring and zero."""
    random = np.random.default_rng(3)
    columns = {name: size * random.uniform(-2, 2, 200) for name in "abc"}
    columns["b"][:40] = columns["a"][:40]
    columns["b"][40:80] = np.nextafter(columns["a"][40:80], 9 * size)
    columns["c"][80:90] = 0.0
    columns["a"][90:100] = np.rint(columns["a"][90:100])
    return columns


@pytest.mark.parametrize("size", SIZES.values(), ids=SIZES)
@pytest.mark.parametrize("formula", FORMULAS)
def test_certain_numbers_are_rounded_once(formula, size):
    node, columns = parse(formula), samples(size)
    with np.errstate(all="ignore"):
        values, certain = evaluate(
            node, {name: exact(column) for name, column in columns.items()}, None, exact
        ).rounded()
    for k in np.flatnonzero(certain):
        value = exact_value(node, {name: Fraction(column[k]) for name, column in columns.items()})
        assert value == value and values[k] == float(value), {name: column[k] for name, column in columns.items()}
    if size == 1.0 and formula in FORMULAS[:3]:
        assert certain.mean() > 0.9  # few are computed again


@pytest.mark.parametrize(
    ("value", "divisor"), [(1.0, 0.0), (1.0, np.nan), (np.inf, 1.0), (1e308, 1e-308), (5e-324, 3.0)]
)
def test_what_is_not_known_is_not_certain(value, divisor):
    with np.errstate(all="ignore"):
        _, certain = (exact(np.array([value])) / exact(np.array([divisor]))).rounded()
    assert not certain.any()


def test_a_tie_is_certain_only_if_it_is_exact():
    """1 + 2^-53 lies halfway between two doubles; a bound of the error of 1, computed as 3 (1/3), decides nothing."""
    one, half = exact(np.array([1.0])), exact(np.array([2.0**-53]))
    values, certain = (one + half).rounded()
    assert certain.all() and values[0] == 1.0
    assert not (exact(Fraction(1, 3)) * exact(Fraction(3)) + half).rounded()[1].any()


@pytest.mark.parametrize("constant", [Fraction(1, 10**400), Fraction(10**400), Fraction(1, 3 * 10**320)])
def test_a_constant_beyond_the_doubles_is_not_certain(constant):
    """Rounded to 0, it would make every product a certain 0."""
    with np.errstate(all="ignore"):
        assert not (exact(constant) * exact(np.array([1.0, 1e300]))).rounded()[1].any()
