"""Double-double arithmetic on arrays: each number is an unevaluated sum ``high + low`` of two doubles.

Relative errors are about 2^-104. The algorithms require that every operation is rounded separately, as NumPy does.
Source: Dekker, Numer. Math. 18 (1971) 224; Knuth, The Art of Computer Programming, vol. 2, section 4.2.2.
"""

from fractions import Fraction
from functools import cache
from math import factorial
from typing import Any

import numpy as np

from symrot.closed_form.arithmetic.pairs import pair
from symrot.closed_form.build import Floats
from symrot.formula import exact_numbers as number

__all__ = [
    "NEAR", "Pair", "add", "divide", "exponential", "ln2", "multiply", "normalized", "second", "square_root",
    "subtract", "two_product", "two_sum",
]  # fmt: skip

Pair = tuple[Any, Any]
"""A number high + low; each part is an array or a float."""

NEAR = 1 / 16
"""Largest absolute value of the argument for which the series of :func:`second` is accurate."""

_SPLITTER = 134217729.0  # 2^27 + 1: multiplication by it splits a double into two halves
_PARTS = 8  # parts of an octave (a factor of 2) in the table of the exponential
_SHORT = 39  # bits of ln 2/8 that can be multiplied by any j (14 bits) without rounding
_LEAST = -745.2  # the exponential of a smaller argument is 0
_HEAD, _TAIL = 8, 16  # doubles suffice from term 8 on: NEAR^8/10! < 2^-53; the series ends at 16: NEAR^16/18! < 2^-116


def two_sum(a: Any, b: Any) -> Pair:
    """Return ``a + b`` rounded to a double, and its rounding error; their sum is exactly a + b (Knuth)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: Any, b: Any) -> Pair:
    """Return ``a * b`` rounded to a double, and its rounding error; their sum is exactly a b (Dekker).

    The error is not exact for results below about 1e-292; for factors above about 1e300, it is NaN.
    """
    product = a * b
    wide_a, wide_b = _SPLITTER * np.asarray(a), _SPLITTER * np.asarray(b)
    high_a, high_b = wide_a - (wide_a - a), wide_b - (wide_b - b)
    low_a, low_b = a - high_a, b - high_b
    return product, ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b


def normalized(high: Any, low: Any) -> Pair:
    """Return two doubles with the sum ``high + low``, of which the first is that sum rounded to a double.

    ``low`` must not be larger than ``high`` in absolute value.
    """
    total = high + low
    return total, low - (total - high)


def add(a: Pair, b: Pair) -> Pair:
    """Return the sum a + b of double-double numbers, with an error of about 2^-104 times the larger of |a|, |b|."""
    total, error = two_sum(a[0], b[0])
    return normalized(total, error + (a[1] + b[1]))


def subtract(a: Pair, b: Pair) -> Pair:
    """Return the difference a - b of double-double numbers; the error is about 2^-104 times the larger of |a|, |b|."""
    return add(a, (-b[0], -b[1]))


def multiply(a: Pair, b: Pair) -> Pair:
    """Return the product of the double-double numbers a and b, with a relative error of about 2^-104."""
    product, error = two_product(a[0], b[0])
    return normalized(product, error + (a[0] * b[1] + a[1] * b[0]))


def divide(a: Pair, b: Pair) -> Pair:
    """Return a/b for double-double numbers, by long division in three steps."""
    # each step divides the high part of the remainder by the high part of b
    first = a[0] / b[0]
    rest = subtract(a, multiply((first, 0.0), b))
    second = rest[0] / b[0]
    rest = subtract(rest, multiply((second, 0.0), b))
    return add(two_sum(first, second), (rest[0] / b[0], 0.0))


def square_root(a: Pair) -> Pair:
    """Return the square root of positive double-double numbers, by two Newton steps from the root of the high part."""
    root: Pair = (np.sqrt(a[0]), 0.0)
    for _ in range(2):
        root = add(root, (subtract(a, multiply(root, root))[0] / (2.0 * root[0]), 0.0))
    return root


@cache
def ln2(bits: int) -> Fraction:
    """Return ln 2 as a fraction with an absolute error below 2^-bits: the sum over k of 2/((2 k + 1) 3^(2 k + 1))."""
    total, power, k = 0, (2 << (bits + 16)) // 3, 0
    while power:
        total += power // (2 * k + 1)
        power, k = power // 9, k + 1
    return Fraction(total, 1 << (bits + 16))


@cache
def _coefficients() -> list[tuple[float, float]]:
    return [pair(Fraction(1, factorial(k + 2))) for k in range(_TAIL)]


@cache
def _octave() -> tuple[tuple[Floats, Floats], tuple[float, float, float]]:
    """Return constants for :func:`exponential`: 2^(j/8), j = 0 to 7, as pairs of doubles, ln 2/8 as three doubles."""
    root, step = Fraction(2), _PARTS
    while step > 1:
        root, step = number.sqrt(root), step // 2
    powers = np.array([pair(root**j) for j in range(_PARTS)])
    rest, parts = ln2(number.BITS) / _PARTS, []
    # so few bits that the products with any j are exact
    for place in (_SHORT, 2 * _SHORT):
        parts.append(Fraction(int(rest * 2 ** (place + 3)), 2 ** (place + 3)))
        rest -= parts[-1]
    return (powers[:, 0], powers[:, 1]), (float(parts[0]), float(parts[1]), float(rest))


def second(x: Pair) -> Pair:
    r"""Return (exp(x) - 1 - x)/x^2 of double-double numbers with \|x\| <= NEAR, by its power series."""
    coefficients, (high, low) = _coefficients(), x
    total: Any = 0.0
    for coefficient, _ in reversed(coefficients[_HEAD:]):
        total = total * high + coefficient
    rest: Any = 0.0
    for known, error in reversed(coefficients[:_HEAD]):
        product, lost = two_product(total, high)
        rest = lost + (total * low + rest * high) + error
        total = known + product  # the constant term is the larger of the two summands
        rest = rest + (product - (total - known))
    return normalized(total, rest)


def exponential(x: Pair) -> Pair:
    """Return exp(x) of double-double numbers x <= 709. For results near the smallest doubles the low part is zero."""
    # 2^(j/8) from a table times a power series
    (high, low), (first, middle, last) = _octave()
    above = np.maximum(x[0], _LEAST)
    j = np.rint(above * (_PARTS / float(ln2(number.BITS))))
    rest = two_sum(above - j * first, -j * middle)  # both products and the difference are exact
    r = add(rest, (x[1] - j * last, 0.0))
    grown = add(r, multiply(multiply(r, r), second(r)))
    octave, index = np.divmod(j.astype(np.int64), _PARTS)
    power = high[index], low[index]
    scaled = add(power, multiply(power, grown))
    return np.ldexp(scaled[0], octave), np.ldexp(scaled[1], octave)
