"""Exact numbers as pairs of doubles, ``hi + lo``, to 31 digits. Standard library only."""

from collections.abc import Sequence
from fractions import Fraction
from math import isfinite, lcm

from symrot.errors import InputError
from symrot.number import equal

__all__ = ["Number", "common", "numbers", "pair", "quotient", "same", "spread"]

Number = float | int | Fraction


def quotient(numerator: int, denominator: int) -> tuple[float, float]:
    """Return numerator/denominator as hi, lo. An integer division of Python's rounds correctly."""
    hi = numerator / denominator
    top, bottom = hi.as_integer_ratio()
    return hi, (numerator * bottom - top * denominator) / (denominator * bottom)


def pair(value: Number) -> tuple[float, float]:
    """Return a number as hi, lo."""
    return (value, 0.0) if isinstance(value, float) else quotient(value.numerator, value.denominator)


def spread(values: Sequence[Number]) -> list[float]:
    """Return hi, lo of each number in one list."""
    result: list[float] = []
    for value in values:
        result += (value, 0.0) if isinstance(value, float) else quotient(value.numerator, value.denominator)
    return result


def same(a: Number, b: Number) -> bool:
    """Return whether two numbers are equal, to 2^-200."""
    return a == b or (not (isinstance(a, float) and isinstance(b, float)) and equal(Fraction(a), Fraction(b)))


def common(values: Sequence[Number]) -> tuple[list[int], int]:
    """Return integers and the denominator that they share."""
    ratios = [value.as_integer_ratio() for value in values]
    shared = lcm(*(bottom for _, bottom in ratios))
    return [top * (shared // bottom) for top, bottom in ratios], shared


def numbers(what: str, values: Sequence[Number], length: int) -> list[Number]:
    """Return finite numbers, each a float (NumPy's too), an int or a Fraction, as they are.

    Raises
    ------
    InputError
        If there is another count of them, or one is not a finite real number.
    """
    found = list(values)
    if len(found) == length and {*map(type, found)} == {float} and all(map(isfinite, found)):
        return found
    if len(found) != length:
        raise InputError(f"{what}: expected {length} numbers, got {len(found)}")
    for index, value in enumerate(found):
        if isinstance(value, float):
            if not isfinite(value):
                raise InputError(f"{what}: expected finite numbers, got {value}")
        elif isinstance(value, bool) or not isinstance(value, int | Fraction):
            if not hasattr(value, "__float__") or isinstance(value, bool):
                raise InputError(f"{what}: expected real numbers, got {value!r}")
            found[index] = float(value)
    return found
