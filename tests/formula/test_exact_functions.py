"""Functions on exact numbers: identities hold to 90 digits, in their domains, also for sizes beyond all doubles."""

import math
from fractions import Fraction as F

import pytest

from symrot.formula.exact_functions import EXACT_FUNCTIONS, exact_value
from symrot.formula.tree import FUNCTIONS, parse

f = EXACT_FUNCTIONS
CLOSE = F(1, 1 << 290)
ARGUMENTS = [F(1, 3), F(-7, 5), F(40), F(1, 10**40), F(-(10**9) - 1, 10**9)]


def near(a, b):
    return abs(a - b) <= CLOSE * abs(b)


@pytest.mark.parametrize("x", ARGUMENTS)
def test_identities(x):
    assert near(f["log"](f["exp"](x)), x)
    assert near(f["exp"](x) * f["exp"](-x), 1)
    assert near(f["cosh"](x) + f["sinh"](x), f["exp"](x))
    assert near(f["tanh"](x) * f["cosh"](x), f["sinh"](x))
    assert near(f["tan"](x) * f["cos"](x), f["sin"](x))
    assert near(f["tan"](f["atan"](x)), x)
    assert near(f["atan2"](x, F(1)), f["atan"](x))
    assert near(f["atan2"](x, F(-1)) - f["atan"](-x), math.copysign(1, x) * 4 * f["atan"](F(1)))


@pytest.mark.parametrize("x", [F(1, 3), F(-99, 100), F(1), 1 - F(1, 10**30)])
def test_inverse_circular_functions(x):
    assert near(f["sin"](f["asin"](x)), x) and near(f["asin"](x) + f["acos"](x), 2 * f["atan"](F(1)))


def test_a_logarithm_near_one_keeps_its_digits():
    tiny = F(1, 10**200)
    assert near(f["log"](1 + tiny), tiny - tiny**2 / 2)


def test_all_functions_of_formulas_agree_with_those_of_doubles():
    assert set(FUNCTIONS) <= set(f)
    for name, count in FUNCTIONS.items():
        arguments = [F(3, 5), F(4, 7)][:count]
        expected = abs(-0.6) if name == "abs" else getattr(math, name)(*map(float, arguments))
        assert float(f[name](*arguments)) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    ["log(-2)", "log(0)", "acos(2)", "asin(-1.01)", "atan2(0, 0)", "sqrt(0 - 1)", "1/(1 - 1)", "2 + log(0 - 3)*0"],
)
def test_what_has_no_real_value_is_not_a_number(text):
    assert math.isnan(exact_value(parse(text), {}))


def test_values_beyond_all_doubles():
    with pytest.raises(OverflowError):
        exact_value(parse("cosh(1e9)"), {})
    assert 0 < exact_value(parse("exp(0 - 1e9)"), {}) < F(1, 10**4000)
