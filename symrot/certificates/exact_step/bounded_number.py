"""Numbers with bounds of their errors, on which a C program is run once for a whole set of inputs, such as a box.

A number is an interval that contains the exact result of all operations so far, for every input of the set, with two
bounds of the difference between the computed and the exact result: an absolute and a relative one.
"""

from fractions import Fraction
from math import frexp, inf, isnan, nextafter, sqrt, ulp
from typing import Any

__all__ = ["DOUBLE", "PAIR", "Bounded", "UndecidedError", "point"]

DOUBLE = 2.0**-53
"""Bound of the relative error of one operation on doubles."""
PAIR = 2.0**-102
"""Bound of the relative error of one operation on sums of two doubles.

The sources that double_double.h names prove the smaller bound 13*2^-106 for every operation.
"""
_UNDER = 2.0**-1060  # above the error of a result too small for all its digits
_SMALL = 2.0**-900  # above numbers whose sums of two doubles lack digits
_LEAST = ulp(0.0)  # the smallest positive double: a smaller product is computed as 0
_GROW = 1 + 2.0**-40  # more than the rounding errors of a computed bound


class UndecidedError(Exception):
    """Raised if a comparison in a C program that is run on :class:`Bounded` numbers can be true as well as false.

    The set of inputs is then too large, and the caller divides it. The exception is also raised where no error bound is
    known, such as near 0 for an arithmetic-geometric mean.
    """


def _down(x: float) -> float:
    return nextafter(x, -inf)


def _up(x: float) -> float:
    return nextafter(x, inf)


def _scaled_up(a: float, b: float) -> float:
    """Return an upper bound of the product of two numbers that are not negative; it is 0 only if a factor is 0."""
    return _known(a * b) * _GROW + _LEAST if a and b else 0.0


def _known(x: float) -> float:
    """Return the computed bound ``x``, or infinity if it is NaN, the result of inf - inf or 0*inf."""
    return inf if isnan(x) else x


class Bounded:
    """The result of one operation for all inputs of a set: an interval of exact values, and bounds of the errors.

    For instance, the product of 3 and the doubles from 1 to 2 has the interval from 3 to 6, the error 6*2^-53 and the
    relative error 2^-53, all slightly widened.
    """

    __slots__ = ("error", "high", "low", "pair", "relative")

    def __init__(self, low: float, high: float, error: float, relative: float, pair: "Bounded | None" = None) -> None:
        low, high = (-inf if isnan(low) else low), (inf if isnan(high) else high)
        self.low, self.high = low, high
        error, relative = _known(error), _known(relative)
        most, least = self.most, self.least
        self.error = min(error, _scaled_up(relative, most)) if relative < inf else error
        self.relative = min(relative, error / least * _GROW + _LEAST * (error > 0)) if least > 0 else relative
        # for the high part of a sum of two doubles: the whole sum
        self.pair = pair

    @property
    def most(self) -> float:
        return max(abs(self.low), abs(self.high))

    @property
    def least(self) -> float:
        return 0.0 if self.low <= 0 <= self.high else min(abs(self.low), abs(self.high))

    @property
    def is_exact(self) -> bool:
        return self.low == self.high and self.error == 0

    def clipped(self, low: float, high: float) -> "Bounded":
        """Return the number with its interval cut to ``low .. high``, between which its exact value is known to be."""
        return Bounded(min(max(self.low, low), high), max(min(self.high, high), low), self.error, self.relative)

    def rounded(self, unit: float) -> "Bounded":
        """Return the number after one more rounding, of relative size ``unit``; an exact number is unchanged."""
        if self.is_exact:
            return self
        error = (self.error + unit * (self.most + self.error)) * _GROW + _UNDER
        small = _UNDER / self.least if self.least > 0 else inf
        return Bounded(self.low, self.high, error, (self.relative + unit * (1 + self.relative) + small) * _GROW)

    # --- operations, each followed by one rounding --------------------------------------------------------------------

    def plus(self, other: "Bounded", unit: float) -> "Bounded":
        if other.is_exact and other.low == 0:
            return self
        if self.is_exact and self.low == 0:
            return other
        if self.is_exact and other.is_exact:
            total = self.low + other.low
            if Fraction(total) == Fraction(self.low) + Fraction(other.low):
                return point(total)
        same = (self.low >= 0 and other.low >= 0) or (self.high <= 0 and other.high <= 0)
        exact = Bounded(
            _down(self.low + other.low), _up(self.high + other.high), (self.error + other.error) * _GROW,
            max(self.relative, other.relative) if same else inf,
        )  # fmt: skip
        return _inexact(exact, unit)

    def times(self, other: "Bounded", unit: float) -> "Bounded":
        for a, b in ((self, other), (other, self)):
            if a.is_exact and a.low == 0:
                return point(0.0)
            has_digits = all(end == 0 or abs(end * a.low) > _SMALL for end in (b.low, b.high))
            if a.is_exact and _is_power(a.low) and has_digits:
                low, high = sorted((b.low * a.low, b.high * a.low))
                return Bounded(low, high, b.error * abs(a.low) + (_UNDER if b.error else 0.0), b.relative)
        ends = [_product(x, y) for x in (self.low, self.high) for y in (other.low, other.high)]
        error = _product(self.most, other.error) + _product(other.most, self.error) + _product(self.error, other.error)
        relative = self.relative + other.relative + _product(self.relative, other.relative)
        return _inexact(Bounded(_down(min(ends)), _up(max(ends)), error * _GROW, relative * _GROW), unit)

    def over(self, other: "Bounded", unit: float) -> "Bounded":
        if self.is_exact and self.low == 0:
            return point(0.0)
        if other.is_exact and _is_power(other.low):
            return self.times(point(1 / other.low), unit)
        relative = inf
        if other.relative < 1:
            relative = (self.relative + other.relative) / (1 - other.relative)
        if other.least == 0:
            low = 0.0 if self.low >= 0 and other.low >= 0 else -inf
            return _inexact(Bounded(low, inf, inf, relative * _GROW), unit)
        ends = [x / y for x in (self.low, self.high) for y in (other.low, other.high)]
        error = inf
        if other.error < other.least:
            # x'/y' - x/y = (x' - x - (y' - y) x/y)/y'
            above = self.error + _product(max(map(abs, ends)), other.error) + _UNDER
            error = above / (other.least - other.error)
        # the rest of a quotient of two sums, which is a product too small for all its digits
        relative += _UNDER / self.least if self.least > 0 else inf
        return _inexact(Bounded(_down(min(ends)), _up(max(ends)), error * _GROW, relative * _GROW), unit)

    def root(self, unit: float) -> "Bounded":
        """Return the square root of a number that is not negative, rounded with the relative error ``unit``."""
        if self.is_exact and self.low == 0:
            return self
        low, high = max(self.low, 0.0), max(self.high, 0.0)
        # sqrt(1 + r) differs from 1 by at most |r| for |r| <= 1
        relative = self.relative + (_UNDER / low if low > 0 else inf) if self.relative <= 1 else inf
        error = (self.error + _UNDER) / sqrt(low) if low > 0 else sqrt(self.error + _UNDER)
        return _inexact(Bounded(_down(sqrt(low)) if low else 0.0, _up(sqrt(high)), error * _GROW, relative), unit)

    # --- as a double of the C text ------------------------------------------------------------------------------------

    def __add__(self, other: Any) -> "Bounded":
        return self.plus(other, DOUBLE)

    def __sub__(self, other: Any) -> "Bounded":
        return self.plus(-other, DOUBLE)

    def __mul__(self, other: Any) -> "Bounded":
        return self.times(other, DOUBLE)

    def __truediv__(self, other: Any) -> "Bounded":
        return self.over(other, DOUBLE)

    def __neg__(self) -> "Bounded":
        return Bounded(-self.high, -self.low, self.error, self.relative, -self.pair if self.pair else None)

    def __abs__(self) -> "Bounded":
        if self.low >= 0:
            return self
        return -self if self.high <= 0 else Bounded(0.0, self.most, self.error, self.relative)

    @property
    def computed(self) -> tuple[float, float]:
        """A lower and an upper bound of the doubles that the C program computes for this number, over all inputs."""
        below, above = (min(self.error, self.relative * abs(end) if end else 0.0) for end in (self.low, self.high))
        if self.relative >= 1:
            below = above = self.error
        return (_down(self.low - below) if below else self.low), (_up(self.high + above) if above else self.high)

    def __lt__(self, other: "Bounded") -> bool:
        (low, high), (from_, to) = self.computed, other.computed
        if high < from_:
            return True
        if low >= to:
            return False
        raise UndecidedError

    def __gt__(self, other: "Bounded") -> bool:
        return other < self

    def __le__(self, other: "Bounded") -> bool:
        return not other < self

    def __ge__(self, other: "Bounded") -> bool:
        return not self < other

    def __eq__(self, other: object) -> bool:
        assert isinstance(other, Bounded)
        if self.is_exact and other.is_exact:
            return self.low == other.low
        (low, high), (from_, to) = self.computed, other.computed
        if high < from_ or to < low:
            return False
        raise UndecidedError

    __hash__ = None  # type: ignore[assignment]

    def __int__(self) -> int:
        if not self.is_exact:
            raise UndecidedError
        return int(self.low)


def point(value: float) -> Bounded:
    """Return the double ``value`` as a :class:`Bounded` that is exact and is the same for all inputs."""
    return Bounded(value, value, 0.0, 0.0)


def _product(a: float, b: float) -> float:
    """Return a*b, and 0 if one factor is 0, also if the other is infinite."""
    return a * b if a and b else 0.0


def _is_power(value: float) -> bool:
    """Return whether a number is a power of two, or its negative."""
    return abs(frexp(value)[0]) == 0.5


def _inexact(exact: Bounded, unit: float) -> Bounded:
    """Return the result of one operation after rounding, with a relative rounding error of at most ``unit``.

    ``exact`` is the result before rounding: an interval for its exact value, and the errors that its operands caused.
    """
    error = (exact.error + unit * (exact.most + exact.error)) * _GROW + _UNDER
    small = _UNDER / exact.least if exact.least > 0 else inf
    relative = (exact.relative + unit * (1 + exact.relative) + small) * _GROW
    return Bounded(exact.low, exact.high, error, relative)
