"""Dual numbers ``x + x' e`` with ``e^2 = 0``: evaluating a formula at them also differentiates it."""

import math
from dataclasses import dataclass
from typing import Any

__all__ = [
    "Dual", "UndefinedValue", "absolute", "arctangent", "as_dual", "cosine", "exponential", "inverse", "logarithm",
    "minus", "plain", "power", "sine", "square_root",
]  # fmt: skip


class UndefinedValue(ValueError):
    """Exception raised if a formula has no value, for example for the root of a negative number, or an unknown name."""


@dataclass(frozen=True, slots=True)
class Dual:
    """The dual number ``value + slope e`` with ``e^2 = 0``; both parts may be dual numbers themselves."""

    value: Any
    slope: Any

    def __add__(self, other: Any) -> "Dual":
        other = as_dual(other)
        return Dual(self.value + other.value, self.slope + other.slope)

    def __neg__(self) -> "Dual":
        return Dual(-self.value, -self.slope)

    def __mul__(self, other: Any) -> "Dual":
        other = as_dual(other)
        return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)

    def __sub__(self, other: Any) -> "Dual":
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> "Dual":
        return (-self).__add__(other)

    __radd__, __rmul__ = __add__, __mul__
    __array_ufunc__ = None  # an array leaves sums and products with a dual number to this class


def as_dual(value: Any) -> Dual:
    """Return a number as a dual number with slope 0."""
    return value if isinstance(value, Dual) else Dual(value, 0)


def inverse(x: Any) -> Any:
    """Return 1/x."""
    if isinstance(x, Dual):
        below = inverse(x.value)
        return Dual(below, -(below * below) * x.slope)
    return 1.0 / x


def minus(x: Any) -> Any:
    """Return -x."""
    return -x


def _is_array(x: Any) -> bool:
    """Return whether x is an array of NumPy, of one or more dimensions."""
    return not isinstance(x, (int, float)) and hasattr(x, "ndim")


def _plainly(function: str, x: Any) -> Any:
    """Return the value of an elementary function, such as ``"sin"``, at a number or at each number of an array."""
    if not _is_array(x):
        return getattr(math, function)(x)
    import numpy as np  # for arrays alone, since its import takes longer than most checks

    return getattr(np, function)(x)


def sine(x: Any) -> Any:
    """Return sin x, x in rad."""
    return Dual(sine(x.value), cosine(x.value) * x.slope) if isinstance(x, Dual) else _plainly("sin", x)


def cosine(x: Any) -> Any:
    """Return cos x, x in rad."""
    return Dual(cosine(x.value), -sine(x.value) * x.slope) if isinstance(x, Dual) else _plainly("cos", x)


def square_root(x: Any) -> Any:
    """Return the square root of a number that is not negative."""
    if isinstance(x, Dual):
        root = square_root(x.value)
        return Dual(root, inverse(2.0 * root) * x.slope)
    return _plainly("sqrt", x)


def absolute(x: Any) -> Any:
    """Return the absolute value of x."""
    if isinstance(x, Dual):
        return -x if plain(x) < 0 else x
    return abs(x)


def plain(x: Any) -> float:
    """Return a dual number without its slope, as a float; nested dual numbers are reduced too."""
    while isinstance(x, Dual):
        x = x.value
    return float(x)


def arctangent(y: Any, x: Any) -> Any:
    """Return atan2(y, x), rad."""
    if isinstance(y, Dual) or isinstance(x, Dual):
        y, x = as_dual(y), as_dual(x)
        below = inverse(x.value * x.value + y.value * y.value)
        return Dual(arctangent(y.value, x.value), (x.value * y.slope + -(y.value * x.slope)) * below)
    return math.atan2(y, x)


def exponential(x: Any) -> Any:
    """Return e^x."""
    if isinstance(x, Dual):
        value = exponential(x.value)
        return Dual(value, value * x.slope)
    return _plainly("exp", x)


def logarithm(x: Any) -> Any:
    """Return the natural logarithm of a positive number."""
    return Dual(logarithm(x.value), inverse(x.value) * x.slope) if isinstance(x, Dual) else _plainly("log", x)


def power(x: Any, exponent: float) -> Any:
    """Return x to a rational power.

    Raise UndefinedValue for a negative x if the exponent is fractional or its absolute value exceeds 64.
    """
    if exponent == int(exponent) and abs(exponent) <= 64:
        whole = int(exponent)
        result: Any = 1.0
        for _ in range(abs(whole)):
            result = result * x
        return result if whole >= 0 else inverse(result)
    if isinstance(x, Dual):
        return Dual(power(x.value, exponent), exponent * power(x.value, exponent - 1) * x.slope)
    if (x < 0).any() if _is_array(x) else x < 0:
        raise UndefinedValue("expected a positive base of a fractional power, got a negative number")
    return x**exponent
