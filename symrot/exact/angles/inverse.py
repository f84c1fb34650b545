"""Inverse trigonometric functions as angles: the sine and cosine of their values, and the ranges of their values.

The functions return principal values, so ``cos(asin(u)) = +sqrt(1 - u^2)``. ``atan2(y, x)`` is undefined at (0, 0).
"""

from collections.abc import Callable
from fractions import Fraction

from sympy import Expr, Integer, Rational, acos, asin, atan, atan2, sqrt

__all__ = ["INVERSE", "Range", "cosine_sine", "range_of"]

HALF = Rational(1, 2)

Pair = tuple[Expr, Expr]


INVERSE: dict[type, Callable[..., Pair]] = {
    asin: lambda u: (sqrt(1 - u**2), u),
    acos: lambda u: (u, sqrt(1 - u**2)),
    atan: lambda u: (1 / sqrt(1 + u**2), u / sqrt(1 + u**2)),
    atan2: lambda y, x: (x / sqrt(x**2 + y**2), y / sqrt(x**2 + y**2)),
}
"""Inverse function -> function from its arguments to the cosine and sine of its value.

For ``asin(u)`` they are ``sqrt(1 - u^2)`` and u.
"""


def cosine_sine(angle: Expr, halvings: int) -> Pair:
    """Return the cosine and sine of ``angle / 2**halvings`` without trigonometric functions.

    For ``asin(u)`` and 0 halvings they are sqrt(1 - u^2) and u.
    """
    cosine, sine = INVERSE[type(angle)](*angle.args)
    if halvings and isinstance(angle, acos):  # the range of acos ends at pi, half of which is included too
        (u,) = angle.args
        cosine, sine = sqrt(HALF + u / 2), sqrt(HALF - u / 2)
        halvings -= 1
    for _ in range(halvings):  # the angle is between -pi and pi, so the cosine of its half is not negative
        half = sqrt(HALF + cosine / 2)
        cosine, sine = half, sine / (2 * half)
    return cosine, sine


Range = tuple[Fraction, Fraction, bool, bool]
"""Bounds of an inverse function's values, in units of pi, as (low, high, whether low is attained, whether high is)."""

_QUARTER = Fraction(1, 2)


def range_of(angle: Expr) -> Range:
    """Return (low, high, low attained, high attained): bounds of an inverse function's values, in units of pi.

    ``atan(u)`` has (-1/2, 1/2, False, False).
    """
    first, second = (*angle.args, Integer(1))[:2]
    closed = not isinstance(angle, atan)
    # known signs of the arguments narrow the range
    if isinstance(angle, acos):
        return Fraction(0), _QUARTER if first.is_nonnegative else Fraction(1), True, True
    low, high, attains_low = -_QUARTER, _QUARTER, closed
    if isinstance(angle, atan2) and not second.is_nonnegative:
        low, high, attains_low = Fraction(-1), Fraction(1), False
    if first.is_nonnegative:
        return Fraction(0), high, True, closed
    if first.is_nonpositive and isinstance(angle, asin | atan):
        return low, Fraction(0), attains_low, True
    return low, high, attains_low, closed
