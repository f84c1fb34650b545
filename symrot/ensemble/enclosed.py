"""Arithmetic on arrays of numbers with bounds of their errors, for formulas whose exact values are rounded once.

Each number is stored as an unevaluated sum ``high + low`` of two doubles, with a bound of its distance from the exact
number. If all numbers within the bound round to the same double, that double is the exact number, rounded.
"""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import pair
from symrot.propagation.steppers.stepping import Floats

__all__ = ["Enclosed", "exact"]

ERROR = 2.0**-98
"""Bound of the relative error of one operation on sums of two doubles.

The operation itself is in error by at most 2^-104. The larger number also covers the rounding of the error bounds,
which are computed in double precision.
"""

LEAST, MOST = 2.0**-900, 2.0**900  # products and quotients of this size have an exact error term


class Enclosed:
    """An array of numbers, each within ``error`` of ``high + low``; the error is infinite where nothing is known."""

    def __init__(self, high: Floats, low: Floats, error: Floats) -> None:
        self.high, self.low, self.error = high, low, error

    def rounded(self) -> tuple[Floats, NDArray[np.bool_]]:
        """Return the numbers rounded to doubles, and for each number whether the rounding is certainly correct."""
        # a bound of 0 belongs to an exact number; twice the bound covers the rounding of low + error
        below, above = (self.high + (self.low + 2 * sign * self.error) for sign in (-1.0, 1.0))
        return self.high + 0.0, np.isfinite(self.high) & (below == self.high) & (above == self.high)

    def _rounding(self, other: "Enclosed") -> Floats:
        """Return a bound of the relative error that the addition or multiplication of two arrays itself adds.

        The bound is 0 where both operands are doubles (their ``low`` is 0): the exact sum or product of two doubles is
        a number ``high + low``.
        """
        return np.where((self.low == 0) & (other.low == 0), 0.0, ERROR)

    def __neg__(self) -> "Enclosed":
        return Enclosed(-self.high, -self.low, self.error)

    def __add__(self, other: "Enclosed") -> "Enclosed":
        high, low = dd.add((self.high, self.low), (other.high, other.low))
        size = np.abs(self.high) + np.abs(other.high)
        return _made(high, low, self.error + other.error + self._rounding(other) * size, size)

    def __sub__(self, other: "Enclosed") -> "Enclosed":
        return self + -other

    def __mul__(self, other: "Enclosed") -> "Enclosed":
        high, low = dd.multiply((self.high, self.low), (other.high, other.low))
        a, b, size = np.abs(self.high), np.abs(other.high), np.abs(high)
        error = a * other.error + b * self.error + self.error * other.error + self._rounding(other) * size
        zero = (a == 0) & (self.error == 0) | (b == 0) & (other.error == 0)
        return _made_of_factors(high, low, error, zero)

    def __truediv__(self, other: "Enclosed") -> "Enclosed":
        high, low = dd.divide((self.high, self.low), (other.high, other.low))
        size, least = np.abs(high), np.abs(other.high) * (1 - ERROR) - other.error
        zero = (self.high == 0) & (self.error == 0) & (least > 0)
        error = np.where(least > 0, (self.error + size * other.error) / least + ERROR * size, np.inf)
        return _made_of_factors(high, low, error, zero)

    def __pow__(self, exponent: int) -> "Enclosed":
        one = exact(Fraction(1), len(self.high))
        power = one
        for _ in range(abs(exponent)):
            power = power * self
        return power if exponent >= 0 else one / power


def _made(high: Floats, low: Floats, error: Floats, size: Floats) -> Enclosed:
    """Return the numbers ``high + low`` with ``error``, a bound of their errors.

    ``size`` is the sum of the sizes of both operands for a sum, and the size of the result for a product or quotient.
    Where it is neither 0 nor between LEAST and MOST, an operation may lose digits to underflow or overflow: ``error``
    is not a bound there, and the bound becomes infinite.
    """
    safe = (size == 0) | (size > LEAST) & (size < MOST)
    return Enclosed(high, low, np.where(safe, error, np.inf))


def _made_of_factors(high: Floats, low: Floats, error: Floats, zero: NDArray[np.bool_]) -> Enclosed:
    """Return a product or quotient ``high + low`` with a bound of its error: 0 where ``zero`` is true, else ``error``.

    A result is exactly 0 where ``zero`` is true; any other 0 is an underflow and gets an infinite bound.
    """
    size = np.abs(high)
    return _made(high, low, np.where(zero, 0.0, error), np.where(zero, 0.0, np.where(size == 0, np.inf, size)))


def exact(value: Fraction | Floats, count: int = 1) -> Enclosed:
    """Return an array of doubles as exact numbers, or ``count`` copies of a fraction with the error of rounding.

    The error is infinite for a number other than 0 whose size is not between LEAST and MOST.
    """
    if isinstance(value, Fraction):
        if value and not LEAST < abs(value) < MOST:  # as doubles it would be 0, infinite, or lose digits
            return Enclosed(*(np.full(count, each) for each in (0.0, 0.0, np.inf)))
        high, low = pair(value)
        error = 0.0 if Fraction(high) + Fraction(low) == value else ERROR * abs(high)
        return Enclosed(*(np.full(count, each) for each in (high, low, error)))
    return _made(value, np.zeros(len(value)), np.zeros(len(value)), np.abs(value))
