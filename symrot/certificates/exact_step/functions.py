"""Functions such as exp and elliptic integrals for numbers with error bounds, as in the C code for exact steps.

The C code computes with sums of two doubles, of about 31 digits. Each operation on such sums is taken to have a
relative error somewhat larger than the one that is proven for it. Intervals of exact values come from functions of
doubles, whose results are widened by more than their error.
"""

from collections.abc import Callable
from math import ceil, cos, exp, floor, hypot, inf, pi, sin, sqrt
from typing import Any

from symrot.certificates.exact_step.bounded_number import DOUBLE, PAIR, Bounded, UndecidedError, point

__all__ = ["ELLIPTIC", "SLACK", "SMALL", "agm", "carlson_rf", "exponential", "mean_of", "pair",
           "pair_total", "sine_and_cosine", "unit_quaternion", "widened", "with_pairs"]  # fmt: skip

ELLIPTIC = 2.0**-90
"""Bound of the relative error of R_F, the arithmetic-geometric mean and exp on sums of two doubles.

It also bounds the absolute error of sine and cosine. Errors of the arguments are not included. The C functions sum
series to 1e-31, with at most 800 roundings of 2^-104; their measured relative errors are below 1e-30.
"""
SMALL = 1e-250  # smaller numbers lose digits in sums of two doubles
MOST_FALL, MOST_RISE = -700.0, 700.0  # between these arguments, exp neither underflows nor overflows
SLACK = 1e-12  # relative error of intervals computed with doubles from <math.h>


def pair(value: Bounded) -> list[Any]:
    """Return a number as the C text represents it: as a sum of two doubles, a list [high part, low part].

    The high part is ``value`` rounded to a double. Its attribute ``pair`` holds ``value`` itself, so that
    :func:`pair_total` needs no low part. So the low part is not computed: it is 0 if ``value`` is an exact double, else
    None.
    """
    high = value.rounded(DOUBLE)
    return [Bounded(high.low, high.high, high.error, high.relative, value), point(0.0) if value.is_exact else None]


def pair_total(doubles: list[Any]) -> Bounded:
    """Return the value of a sum of two doubles [high, low] with bounds of its error; the inverse of :func:`pair`.

    For a constant of the C text, such as pi, the value is high + low with a relative error of 2^-104.
    """
    high: Bounded = doubles[0]
    low = doubles[1]
    if high.pair is not None:
        return high.pair
    if low.is_exact and low.low == 0:
        return high
    total = high.low + low.low
    return Bounded(total * (1 - 2.0**-52), total * (1 + 2.0**-52), abs(total) * 2.0**-104, 2.0**-104)


def with_pairs(operation: Callable[..., Bounded]) -> Callable[..., list[Any]]:
    """Return a function that applies ``operation`` to numbers in the form of :func:`pair`, lists [high, low].

    ``operation`` takes and returns a Bounded; the returned function takes and returns such lists.
    """
    return lambda *pairs: pair(operation(*map(pair_total, pairs)))


def mean_of(a: float) -> float:
    """Return the arithmetic-geometric mean of 1 and a."""
    b = 1.0
    for _ in range(60):
        a, b = sqrt(a * b), (a + b) / 2
    return b


def widened(low: float, high: float) -> tuple[float, float]:
    """Return the ends of an interval, moved outward by more than the error of ends that <math.h> computes."""
    return low - abs(low) * SLACK, high + abs(high) * SLACK


def agm(a: Bounded) -> Bounded:
    """Return the arithmetic-geometric mean of 1 and ``a``, where ``a`` is at most 1.

    UndecidedError is raised if ``a`` may be near 0.
    """
    if a.low < 1e-160:
        raise UndecidedError
    low, high = widened(mean_of(a.low), mean_of(min(a.high, 1.0)))
    return Bounded(low, high, inf, a.relative + ELLIPTIC)


def _carlson(x: float, y: float, z: float) -> float:
    """Return Carlson's elliptic integral R_F(x, y, z) of doubles, to about 14 digits."""
    for _ in range(400):
        near = (x + y + z) / 3
        if max(abs(x - near), abs(y - near), abs(z - near)) <= near * 1e-7:
            break
        shift = sqrt(x * y) + sqrt(y * z) + sqrt(z * x)
        x, y, z = (x + shift) / 4, (y + shift) / 4, (z + shift) / 4
    return 1 / sqrt(near)


def carlson_rf(x: Bounded, y: Bounded, z: Bounded) -> Bounded:
    """Return Carlson's elliptic integral R_F; raise UndecidedError if an inexact argument may be below ``SMALL``."""
    if any(each.high > 0 and each.low < SMALL and not each.is_exact for each in (x, y, z)):
        raise UndecidedError
    if z.is_exact and z.low == 1:  # of squares of cn and dn
        x, y = x.clipped(0.0, 1.0), y.clipped(0.0, 1.0)
    # decreasing in each argument; homogeneous of degree -1/2, so that relative errors are at most halved
    low = _carlson(*(min(each.high, 1e300) for each in (x, y, z)))
    high = _carlson(*(max(each.low, 1e-310) for each in (x, y, z)))
    relative = max(each.relative for each in (x, y, z))
    return Bounded(*widened(low, high), inf, relative + ELLIPTIC if relative < 0.5 else inf)


def exponential(x: Bounded) -> Bounded:
    """Return the exponential of a number; its interval holds also where a double would underflow or overflow."""
    # exp(-746) is 0 as a double; below MOST_FALL the result is between 0 and exp(MOST_FALL)
    low = exp(min(x.low, MOST_RISE)) if x.low > MOST_FALL else 0.0
    high = exp(max(x.high, MOST_FALL)) if x.high < MOST_RISE else inf
    # |x| e^x is at most 1/e for x <= 0
    from_relative = 1.01 * x.relative if x.high <= 0 and x.relative < 1e-3 else inf
    error = min(from_relative, high * 1.01 * x.error if x.error < 1e-3 else inf) + high * ELLIPTIC + 1e-300
    relative = 1.01 * x.error + ELLIPTIC if x.error < 1e-3 and low > SMALL else inf
    return Bounded(*widened(low, high), error, relative)


def _range_of(function: Callable[[float], float], low: float, high: float, peak: float) -> tuple[float, float]:
    """Return the range of sine or cosine of angles in revolutions; ``peak`` is where the function is 1."""
    ends = sorted((function(2 * pi * low), function(2 * pi * high)))
    top = 1.0 if floor(high - peak + 1e-9) >= ceil(low - peak - 1e-9) else min(ends[1] + 1e-14, 1.0)
    bottom = -1.0 if floor(high - peak - 0.5 + 1e-9) >= ceil(low - peak - 0.5 - 1e-9) else max(ends[0] - 1e-14, -1.0)
    return bottom, top


def sine_and_cosine(turns: Bounded, error: float) -> tuple[Bounded, Bounded]:
    """Return sine and cosine of an angle in revolutions, as numbers with the absolute error ``error``."""
    sine = _range_of(sin, turns.low, turns.high, 0.25)
    cosine = _range_of(cos, turns.low, turns.high, 0.0)
    return Bounded(*sine, error, inf), Bounded(*cosine, error, inf)


def unit_quaternion(q: list[Bounded]) -> list[Bounded]:
    """Return a quaternion divided by its norm; the quaternion 0 is returned unchanged."""
    least, most = hypot(*(x.least for x in q)), hypot(*(x.most for x in q))  # without underflow of squares
    if most == 0:
        return q
    error = max(x.error for x in q)
    relative = max(x.relative for x in q)
    result = []
    for x in q:
        if x.is_exact and x.low == 0:
            result.append(x)
            continue
        low = x.low / (most if x.low > 0 else least) if least else -1.0
        high = x.high / (least if x.high > 0 else most) if least else 1.0
        # |q/|q| - p/|p|| <= (e + 2 e)/(|q| - 2 e) for errors of at most e of each component
        of_norm = 6 * error / least if least > 4 * error else inf
        own = 2.1 * relative + 64 * PAIR if relative < 0.01 else inf
        result.append(Bounded(*widened(low, high), of_norm + 64 * PAIR, own).clipped(-1.0, 1.0))
    return result
