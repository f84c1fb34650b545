"""Intervals that contain sine, cosine, arc tangent and related functions, computed from ``+ - * / sqrt`` alone.

The C library's sine differs between machines, but bounds must be the same everywhere. Arguments are reduced by
multiples of pi/2, and Taylor series are summed. Their absolute error is below 1e-15; each result is widened by more.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import factorial, inf, nextafter, pi

import numpy as np

from symrot.certificates.rounding.intervals import (
    Array,
    add,
    contains_zero,
    divide,
    multiply_loosely,
    negative,
    square,
    widened,
)

__all__ = ["arc_ratio_terms", "arc_slope", "arc_tangent", "cosine", "sinc", "sinc_slope", "sine",
           "sine_gap", "sine_gap_slope", "tangent_gap", "tangent_gap_slope"]  # fmt: skip

SLACK = 2e-15  # absolute widening, larger than the errors of series and reduction
FARTHEST = 2.0**20  # largest |x| that is reduced; beyond it a sine is anything in [-1, 1]
NEAR_CRITICAL = 1e-9  # in rotations of 2 pi: an extremum this near to an interval counts as inside

_HALF_PI = (float.fromhex("0x1.921fb544p+0"), float.fromhex("0x1.0b4611a626331p-34"))  # the first 33 bits, and the rest


def _series(terms: list[Fraction]) -> tuple[float, ...]:
    return tuple(float(term) for term in reversed(terms))


TERMS = 13  # terms in x^2, enough for |x| <= 2
_SINC = _series([Fraction((-1) ** n, factorial(2 * n + 1)) for n in range(TERMS)])
_COSINE = _series([Fraction((-1) ** n, factorial(2 * n)) for n in range(TERMS)])
_SINE_GAP = _series([Fraction((-1) ** n, factorial(2 * n + 3)) for n in range(TERMS)])
_SINE_GAP_SLOPE = _series([Fraction((-1) ** n * 2 * (n + 1), factorial(2 * n + 5)) for n in range(TERMS)])
_TANGENT_GAP = _series([Fraction((-1) ** n * 2 * (n + 1), factorial(2 * n + 3)) for n in range(TERMS)])
_TANGENT_GAP_SLOPE = _series([Fraction((-1) ** n * 4 * (n + 1) * (n + 2), factorial(2 * n + 5)) for n in range(TERMS)])
_ARC = _series([Fraction((-1) ** n, 2 * n + 1) for n in range(9)])


def _polynomial(coefficients: tuple[float, ...], t: Array) -> Array:
    value = np.full_like(t, coefficients[0])
    for coefficient in coefficients[1:]:
        value = value * t + coefficient
    return value


def _sine_of(x: Array, quarter_turns: int) -> Array:
    """Return sin(x + quarter_turns*pi/2) for |x| <= FARTHEST, to an absolute error below 1e-15."""
    count = np.rint(x * (2 / pi))
    rest = (x - count * _HALF_PI[0]) - count * _HALF_PI[1]
    t = rest * rest
    quadrant = (count.astype(np.int64) + quarter_turns) % 4
    value = np.where(quadrant % 2 == 0, rest * _polynomial(_SINC, t), _polynomial(_COSINE, t))
    return np.where(quadrant >= 2, -value, value)


def _circular(x: Array, quarter_turns: int) -> Array:
    far = np.maximum(np.abs(x[0]), np.abs(x[1])) > FARTHEST
    ends = np.sort(_sine_of(np.where(far, 0.0, x), quarter_turns), axis=0)
    enclosure = np.clip(widened(ends, SLACK), -1.0, 1.0)
    turns = x / (2 * pi) + 0.25 * quarter_turns
    for row, peak in ((1, 0.25), (0, 0.75)):
        inside = np.floor(turns[1] - peak + NEAR_CRITICAL) != np.floor(turns[0] - peak - NEAR_CRITICAL)
        enclosure[row] = np.where(inside | far, 1.0 if row else -1.0, enclosure[row])
    return enclosure


def sine(x: Array) -> Array:
    """Return, for each interval of angles, an interval that contains the sine of every angle in it."""
    return _circular(x, 0)


def cosine(x: Array) -> Array:
    """Return, for each interval of angles, an interval that contains the cosine of every angle in it."""
    return _circular(x, 1)


def _size(x: Array) -> Array:
    """Return, for each interval, an interval that contains |x| for every x in it."""
    size = np.abs(x)
    return np.stack([np.where(contains_zero(x), 0.0, size.min(axis=0)), size.max(axis=0)])


@dataclass(frozen=True)
class _EvenFunction:
    """An even function of x such as sin(x)/x, evaluated on intervals without division by a small x."""

    # in x^2, for |x| < 2; for |x| >= 2 a formula, for numbers and for intervals
    series: tuple[float, ...]
    formula: Callable[[Array, Array, Array], Array]  # of x, sin(x)/x and cos(x)
    on_intervals: Callable[[Array, Array, Array], Array]
    # the function decreases for 0 <= x <= end
    end: float
    # a bound of its absolute value everywhere
    crude: float

    def __call__(self, x: Array) -> Array:
        """Return, for each interval, an interval that contains all values of the function on it."""
        size = _size(x)
        low = np.minimum(size, self.end)
        far = np.maximum(low, 2.0)
        value = np.where(
            low < 2.0, _polynomial(self.series, low * low), self.formula(far, _sine_of(far, 0) / far, _sine_of(far, 1))
        )
        enclosure = widened(value[::-1], 2 * SLACK)
        beyond = size[1] > self.end
        if not beyond.any():
            return enclosure
        z = np.where(size[0] >= 2.0, size, 2.0)
        general = self.on_intervals(z, divide(sine(z), z), cosine(z))
        crude = np.array([[-self.crude], [self.crude]])
        return np.where(beyond, np.where(size[0] >= 2.0, general, crude), enclosure)


def _over(numerator: Array, z: Array, power: int) -> Array:
    for _ in range(power):
        numerator = divide(numerator, z)
    return numerator


def _above(value: Fraction) -> float:
    """Return a double that is not below a fraction; the double nearest to 1/3 is below it."""
    near = float(value)
    return near if Fraction(near) >= value else nextafter(near, inf)


_times = multiply_loosely
sinc = _EvenFunction(_SINC, lambda z, s, c: s, lambda z, s, c: s, 4.4, 1.0)
sine_gap = _EvenFunction(
    _SINE_GAP,
    lambda z, s, c: (1 - s) / (z * z),
    lambda z, s, c: _over(add(np.ones_like(s), negative(s)), z, 2),
    6.0,
    _above(Fraction(1, 6)),
)
tangent_gap = _EvenFunction(
    _TANGENT_GAP,
    lambda z, s, c: (s - c) / (z * z),
    lambda z, s, c: _over(add(s, negative(c)), z, 2),
    5.7,
    _above(Fraction(1, 3)),
)
_sine_gap_factor = _EvenFunction(
    _SINE_GAP_SLOPE, lambda z, s, c: (2 + c - 3 * s) / (z * z * z * z),
    lambda z, s, c: _over(add(np.full_like(c, 2.0), add(c, _times(np.full_like(s, -3.0), s))), z, 4), 4.4,
    _above(Fraction(1, 60)),
)  # fmt: skip
_tangent_gap_factor = _EvenFunction(
    _TANGENT_GAP_SLOPE, lambda z, s, c: ((3 - z * z) * s - 3 * c) / (z * z * z * z),
    lambda z, s, c: _over(
        add(_times(add(np.full_like(z, 3.0), negative(_times(z, z))), s), _times(np.full_like(c, -3.0), c)), z, 4
    ), 4.4, _above(Fraction(1, 15)),
)  # fmt: skip


def tangent_gap_slope(x: Array) -> Array:
    """Return intervals that contain the derivative of ``tangent_gap``, (sin x - x cos x)/x^3."""
    # -x times j2(x)/x^2, which decreases from 1/15 at x = 0 until x = 5.7
    return negative(multiply_loosely(x, _tangent_gap_factor(x)))


def sine_gap_slope(x: Array) -> Array:
    """Return intervals that contain the derivative of ``sine_gap``, (x - sin x)/x^3."""
    # -x I(x), where I(x), the integral of (1-s)^2 s sin(x s)/(2 x) over s from 0 to 1, decreases from 1/60 until x =
    # 4.4
    return negative(multiply_loosely(x, _sine_gap_factor(x)))


def sinc_slope(x: Array) -> Array:
    """Return intervals that contain the derivative of sin(x)/x, which is ``-x (sin x - x cos x)/x^3``."""
    return negative(multiply_loosely(x, tangent_gap(x)))


def _arc(z: Array) -> Array:
    """Return the arc tangent of finite numbers, with an absolute error below 1e-15."""
    size = np.abs(z)
    inverted = size > 1
    small = np.where(inverted, 1 / np.where(inverted, size, 1.0), size)
    for _ in range(3):
        small = small / (1 + np.sqrt(1 + small * small))
    value = 8 * small * _polynomial(_ARC, small * small)
    return np.copysign(np.where(inverted, pi / 2 - value, value), z)


def arc_tangent(y: Array, x: Array) -> Array:
    """Return intervals that contain atan2(y, x) for all numbers in the intervals ``y`` and ``x``.

    The result is about [-pi, pi] if y contains zero and x contains a number that is not positive.
    """
    with np.errstate(all="ignore"):
        right, up = divide(y, x), divide(x, y)
        # a quotient beyond the range of doubles: between it and infinity the arc tangent ends at pi/2
        beyond = np.array([[-inf], [inf]])
        sloped = [_arc(np.where(np.isfinite(q), q, end)) for q, end in ((right, beyond), (up[::-1], -beyond))]
    quarter = np.where(y[0] > 0, pi / 2, -pi / 2)
    angles = np.where(x[0] > 0, sloped[0], np.where(contains_zero(y), np.array([[-pi], [pi]]), quarter - sloped[1]))
    return np.clip(widened(angles, 2 * SLACK), -pi - SLACK, pi + SLACK)


def arc_slope(a: Array, b: Array) -> Array:
    """Return narrow intervals of a/(a^2 + b^2), a derivative of atan2; infinite where both a and b contain zero."""
    return np.stack([-_steepest(negative(a), b), _steepest(a, b)])


def _steepest(a: Array, b: Array) -> Array:
    """Return an upper bound of a/(a^2 + b^2) on intervals of a and b."""
    size = _size(b)
    near, far = size
    # a may be positive: largest at the least |b|; it increases in a until a = |b| and then decreases
    positive = np.clip(near, np.maximum(a[0], 0.0), np.maximum(a[1], 0.0))
    # a <= 0: largest at the largest |b|
    ends = [_slope_at(at, far) for at in a]
    return np.where(a[1] > 0, _slope_at(positive, near), np.maximum(*ends))


def _slope_at(a: Array, b: Array) -> Array:
    a, b = np.stack([a, a]), np.stack([b, b])
    return np.asarray(divide(a, add(square(a), square(b)))[1])


def arc_ratio_terms(s: Array, c: Array, radius: Array) -> tuple[Array, Array, Array]:
    """Return intervals of atan2(s, c)/s and of its derivatives with respect to s and c, for s, c >= 0, not both 0.

    ``radius`` has intervals of sqrt(s^2 + c^2).
    """
    # With s = r sin(a) and c = r cos(a), these are 1/(r sinc a), -4 a g(2a)/(r sinc a)^2 and -1/r^2, which are finite
    # at a = 0; here g(x) = (x - sin x)/x^3 is ``sine_gap``.
    angle = np.clip(arc_tangent(s, c), 0.0, pi / 2 + SLACK)
    one = np.ones_like(s)
    value = divide(one, multiply_loosely(radius, sinc(angle)))
    slope = multiply_loosely(multiply_loosely(4 * angle, sine_gap(2 * angle)), multiply_loosely(value, value))
    return value, negative(slope), negative(divide(one, multiply_loosely(radius, radius)))
