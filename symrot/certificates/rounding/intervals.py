"""Interval arithmetic for rounding bounds: float64 arrays of shape (2, n), the lower and upper ends of n intervals.

Results are not rounded outward if the operation is known to be exact: the upper end of 1*1 stays 1. An upper end just
above 1 would double the bound of the next rounding error, because doubles above 1 are twice as far apart as those below
1. With ``+ - * / sqrt`` alone, results are the same on every machine.
"""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["ETA", "Array", "add", "binade", "contains_zero", "divide", "half_ulp", "hull", "magnitude", "multiply",
           "multiply_loosely", "negative", "point", "rounded_to", "square", "square_root", "widened"]  # fmt: skip

Array: TypeAlias = NDArray[np.float64]

ETA = 5e-324  # smallest positive number
PHI = 2.0**-53 * (1 + 2.0**-51)
SPLIT = 134217729.0  # 2^27 + 1
TINY = 1e-280  # a smaller product may be inexact even if its factors have few digits
_EXPONENT = np.int64(0x7FF0000000000000)
DIGITS = {"binary64": 53, "binary32": 24}
_LEAST = {"binary64": ETA, "binary32": 2.0**-150}  # bound of the error of a subnormal result


# TwoSum decides whether a sum is exact, Veltkamp's split whether a product is exact (Ogita, Rump, Oishi, SIAM J. Sci.
# Comput. 26 (2005) 1955). Rump's method moves an end c outward to c + (phi |c| + eta), with phi a little above 2^-53
# and eta the smallest positive double; this is never less than the next double (Rump, Zimmermann, Boldo, Melquiond, BIT
# 49 (2009) 419). Overflow and division by zero give ends that are not finite.
def point(value: float, count: int) -> Array:
    """Return ``count`` intervals that each contain only the number ``value``."""
    return np.full((2, count), value)


def widened(values: Array, by: Array | float) -> Array:
    """Return intervals enlarged by at least ``by`` >= 0 on both sides."""
    step = by + (np.abs(values) * PHI + ETA)
    return np.stack([values[0] - step[0], values[1] + step[1]])


def hull(a: Array, b: Array) -> Array:
    """Return the smallest intervals that contain the intervals ``a`` and ``b``."""
    return np.stack([np.minimum(a[0], b[0]), np.maximum(a[1], b[1])])


def magnitude(a: Array) -> Array:
    """Return the largest absolute value in each interval."""
    return np.asarray(np.maximum(-a[0], a[1]))


def contains_zero(a: Array) -> NDArray[np.bool_]:
    """Return a Boolean array: whether each interval contains zero."""
    return np.asarray((a[0] <= 0) & (a[1] >= 0))


def negative(a: Array) -> Array:
    """Return intervals that contain ``-x`` for every x in the intervals ``a``."""
    return -a[::-1]


def add(a: Array, b: Array) -> Array:
    """Return intervals that contain all sums of numbers in ``a`` and ``b``.

    An end that is computed exactly is not rounded outward.
    """
    total = a + b
    back = total - a
    error = (a - (total - back)) + (b - back)
    step = np.abs(total) * PHI + ETA
    return np.stack([total[0] - step[0] * (error[0] < 0), total[1] + step[1] * (error[1] > 0)])


def _short(a: Array) -> NDArray[np.bool_]:
    """Return a Boolean array: whether each number has at most 26 significant bits, so that products are exact."""
    large = a * SPLIT
    return np.asarray(large - (large - a) == a)


def multiply(a: Array, b: Array) -> Array:
    """Return intervals that contain all products of numbers in ``a`` and ``b``.

    An end is not rounded outward if its factors have at most 26 significant bits, so that the product is exact.
    """
    products = a[:, None] * b[None]
    exact = (_short(a)[:, None] & _short(b)[None]) & (np.abs(products) > TINY)
    exact |= (a == 0)[:, None] | (b == 0)[None]
    step = (np.abs(products) * PHI + ETA) * ~exact
    return np.stack([(products - step).min(axis=(0, 1)), (products + step).max(axis=(0, 1))])


def multiply_loosely(a: Array, b: Array) -> Array:
    """Return intervals that contain all products of numbers in ``a`` and ``b``, always rounded outward."""
    # faster than ``multiply``, for derivatives, where the last bit does not matter
    products = (a[:, None] * b[None]).reshape(4, -1)
    return widened(np.stack([products.min(axis=0), products.max(axis=0)]), 0.0)


def square(a: Array) -> Array:
    """Return intervals that contain the squares of all numbers in ``a``; the lower end is never negative."""
    size = np.abs(a)
    low = np.where(contains_zero(a), 0.0, size.min(axis=0))
    ends = np.stack([low, size.max(axis=0)])
    squares = ends * ends
    exact = (_short(ends) & (squares > TINY)) | (ends == 0)
    step = (squares * PHI + ETA) * ~exact
    return np.stack([np.maximum(squares[0] - step[0], 0.0), squares[1] + step[1]])


def divide(a: Array, b: Array) -> Array:
    """Return intervals that contain all quotients of numbers in ``a`` and ``b``.

    Where ``b`` contains zero, both ends are ``inf``, which means that there is no bound.
    """
    quotients = a[:, None] / b[None]
    exact = _short(quotients) & _short(b)[None] & (quotients * b[None] == a[:, None]) & (np.abs(quotients) > TINY)
    exact |= (a == 0)[:, None] & (b != 0)[None]
    step = (np.abs(quotients) * PHI + ETA) * ~exact
    result = np.stack([(quotients - step).min(axis=(0, 1)), (quotients + step).max(axis=(0, 1))])
    result[:, contains_zero(b)] = np.inf
    return result


def square_root(a: Array) -> Array:
    """Return intervals that contain the roots of all numbers in ``a``.

    Where ``a`` has negative numbers, both ends are ``inf``, which means that there is no bound.
    """
    roots = np.sqrt(np.maximum(a, 0.0))
    step = (roots * PHI + ETA) * ~(_short(roots) & (roots * roots == a))
    result = np.stack([np.maximum(roots[0] - step[0], 0.0), roots[1] + step[1]])
    result[:, a[0] < 0] = np.inf
    return result


def binade(size: Array) -> Array:
    """Return, for each number, the largest power of two that is at most this number; 0 below 2^-1022."""
    return (size.view(np.int64) & _EXPONENT).view(np.float64)


def half_ulp(size: Array, precision: str) -> Array:
    """Return a bound of the rounding error of any number up to ``size``: 2^-54 for size 1.0, 2^-53 for 1.5."""
    # at a power of two, the wider spacing above it does not count: no number above ``size`` occurs
    below = ((size.view(np.int64) - 1) & _EXPONENT).view(np.float64)
    unit = np.maximum(below * 2.0 ** -DIGITS[precision], _LEAST[precision])
    return np.where(size > 0, unit, 0.0)


def rounded_to(a: Array, precision: str) -> Array:
    """Return intervals that contain all numbers in the intervals ``a``, and these numbers rounded to ``precision``."""
    if precision == "binary64":
        return a
    with np.errstate(over="ignore"):
        return hull(a, a.astype(np.float32).astype(np.float64))
