"""Functions with a removable singularity, such as sin(x)/x at zero, computed accurately for all numbers.

Near zero, ``(x - sin x)/x^3`` and other differences of nearly equal terms are Taylor series, with a truncation error
proven to be below half the last bit. ``python -m symrot.bench.ulps`` measures all errors in ulp (units in the last
place).
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

from sympy import Add, Expr, Function, Poly, Symbol, atan2, cos, factorial, sin

__all__ = ["DERIVATIVES", "FUNCTIONS", "REMOVABLE", "Removable", "arc_ratio", "copysign", "explicit", "select_ge",
           "sinc", "sine_bend", "sine_gap", "tangent_bend", "tangent_gap"]  # fmt: skip

sinc = Function("sinc", real=True)
sine_gap = Function("sine_gap", real=True)
tangent_gap = Function("tangent_gap", real=True)
sine_bend = Function("sine_bend", real=True)
tangent_bend = Function("tangent_bend", real=True)
arc_ratio = Function("arc_ratio", real=True)
copysign = Function("copysign", real=True)
select_ge = Function("select_ge", real=True)

FUNCTIONS: dict[str, int] = {  # functions of kernels that scenes do not have, with their numbers of arguments
    "sinc": 1, "sine_gap": 1, "tangent_gap": 1, "sine_bend": 1, "tangent_bend": 1, "arc_ratio": 2, "copysign": 2,
    "select_ge": 4,
}  # fmt: skip
DIGITS = {"binary64": 53, "binary32": 24}

_x = Symbol("x", real=True)


@dataclass(frozen=True)
class Removable:
    """An even analytic function of x, such as sinc, written as ``numerator / x^power``, which is undefined at zero."""

    name: str
    numerator: Expr  # a formula in x
    power: int
    # the square of the abs(x) below which the Taylor series is used; there its terms alternate and decrease
    split: Fraction
    # computed as scaled/x/x beyond the split: a high power of x could overflow
    scaled: str  # a formula of numerator / x^(power - 2) whose terms neither overflow nor cancel beyond the split
    about: str

    def formula(self, x: Expr) -> Expr:
        """Return the function at ``x`` as a quotient, undefined at zero."""
        return self.numerator.xreplace({_x: x}) / x**self.power

    def coefficients(self, precision: str = "binary64") -> tuple[Fraction, ...]:
        """Return as many Taylor coefficients of the function, in powers of x^2, as ``precision`` needs,
        lowest first.
        """
        # The first omitted term at x^2 = split is below a quarter of the last place of the function's smallest value
        # there. The series alternates, so this bounds the truncation error.
        return _summed(self, precision)

    def taylor(self, count: int) -> tuple[Fraction, ...]:
        """Return the first ``count`` Taylor coefficients of the function, in powers of x^2."""
        return _taylor(self, count)


@cache
def _summed(which: Removable, precision: str) -> tuple[Fraction, ...]:
    count = 3
    while True:
        coefficients = which.taylor(count)
        terms = [abs(a) * which.split**k for k, a in enumerate(coefficients)]
        if any(a * b >= 0 for a, b in pairwise(coefficients)) or sorted(terms, reverse=True) != terms:
            raise AssertionError(f"{which.name}: expected an alternating, decreasing series for x^2 < {which.split}")
        if terms[-1] < (terms[0] - terms[1]) * Fraction(1, 2 ** (DIGITS[precision] + 2)):
            return coefficients[:-1]
        count += 1


@cache
def _taylor(which: Removable, count: int) -> tuple[Fraction, ...]:
    order = which.power + 2 * count
    # sine and cosine as polynomials with all terms below x^order
    sine, cosine = (
        Add(*((-1) ** k * _x ** (2 * k + first) / factorial(2 * k + first) for k in range(order // 2 + 1)))
        for first in (1, 0)
    )
    numerator = Poly(which.numerator.xreplace({sin(_x): sine, cos(_x): cosine}), _x)
    values = [numerator.coeff_monomial(_x ** (which.power + 2 * k)) for k in range(count)]
    return tuple(Fraction(int(value.p), int(value.q)) for value in values)


# Errors are within 4 ulp: sinc (measured 1.4), sine_gap (2.1) and sine_bend (3.1) at every finite number, tangent_gap
# (2.3) and tangent_bend (3.2) for |x| <= pi, arc_ratio (1.6; batches 1.2) for c >= 0. For larger |x|, tangent_gap
# decreases as cos(x)/x^2. Its zeros, the solutions of x = tan x, are no floating-point numbers, so its relative error
# has no bound. Its absolute error, and that of tangent_bend, is at most 4 * 2^-53/x^2 (float: 4 * 2^-24/x^2) or
# half the least subnormal number (factors measured: 2.5 and 1.1 instead of 4).
REMOVABLE: dict[str, Removable] = {
    each.name: each
    for each in (
        Removable("sine_gap", _x - sin(_x), 3, Fraction(4), "1 - sin(x)/x", "(x - sin(x))/x^3"),
        Removable("tangent_gap", sin(_x) - _x * cos(_x), 3, Fraction(9, 4), "sin(x)/x - cos(x)",
                  "(sin(x) - x cos(x))/x^3; 4 ulp for |x| <= pi, before its first zero"),
        Removable("sine_bend", 2 * _x + _x * cos(_x) - 3 * sin(_x), 5, Fraction(9),
                  "(2 + cos(x) - 3*(sin(x)/x))/x/x", "(2 x + x cos(x) - 3 sin(x))/x^5"),
        Removable("tangent_bend", (3 - _x**2) * sin(_x) - 3 * _x * cos(_x), 5, Fraction(25, 4),
                  "(3*(sin(x)/x - cos(x))/x - sin(x))/x",
                  "((3 - x^2) sin(x) - 3 x cos(x))/x^5; 4 ulp for |x| <= pi, before its first zero"),
    )
}  # fmt: skip

DERIVATIVES: dict[str, Callable[[Expr], Expr]] = {
    "sinc": lambda x: -x * tangent_gap(x),
    "sine_gap": lambda x: -x * sine_bend(x),
    "tangent_gap": lambda x: -x * tangent_bend(x),
}
"""Functions of one argument whose derivatives kernels can compute: name -> function from x to the derivative at x."""

_EXPLICIT: dict[str, Callable[..., Any]] = {
    "sinc": lambda x: sin(x) / x,
    "arc_ratio": lambda s, c: atan2(s, c) / s,
    **{name: each.formula for name, each in REMOVABLE.items()},
}


def explicit(expr: Expr) -> Expr:
    """Return an expression with functions such as sinc(x) written as quotients, here sin(x)/x, for proofs."""
    for name, formula in _EXPLICIT.items():
        expr = expr.replace(
            lambda e, name=name: getattr(e.func, "__name__", "") == name, lambda e, formula=formula: formula(*e.args)
        )
    return expr
