"""Sums ``hi + lo`` of two doubles (pairs), which represent exact numbers to 31 digits. Standard library only."""

from collections.abc import Sequence
from fractions import Fraction
from math import isfinite, lcm, ulp
from typing import Any

from symrot.errors import InputError
from symrot.formula.exact_numbers import equal, show

__all__ = [
    "GRID",
    "LARGEST",
    "SMALLEST",
    "Number",
    "attitude",
    "flatten_pairs",
    "numbers",
    "on_grid",
    "over_common_denominator",
    "pair",
    "quotient",
    "same",
]  # fmt: skip

Number = float | int | Fraction

LARGEST = 1e205
"""Largest number that may define a motion, in its unit, so that all constants of the motion are finite doubles."""

SMALLEST = 1e-205
"""Smallest moment of inertia that may define a motion, kg m^2."""

GRID = 2.0**-33
"""Step of the grid to which lo is rounded in a component hi + lo of an attitude, in ulps of hi.

hi is the double nearest to the component; lo becomes a multiple of GRID ulps of hi. Because of this rounding, a batch
of motions gives the same doubles as single motions.
"""

_BITS = 600  # 2^600 and its inverse lie inside these bounds


def quotient(numerator: int, denominator: int) -> tuple[float, float]:
    """Return two doubles (hi, lo) whose sum is numerator/denominator to 31 digits: about 0.333 and 1.85e-17 for 1/3."""
    # Python rounds quotients of integers correctly, so both hi and lo are correctly rounded
    hi = numerator / denominator
    top, bottom = hi.as_integer_ratio()
    rest = numerator * bottom - top * denominator
    return hi, rest / (denominator * bottom) if rest else 0.0


def pair(value: Number) -> tuple[float, float]:
    """Return two doubles (hi, lo) whose sum approximates a number to 31 digits; for a float, lo is zero."""
    return (value, 0.0) if isinstance(value, float) else quotient(value.numerator, value.denominator)


def flatten_pairs(values: Sequence[Number]) -> list[float]:
    """Return several numbers as one list hi, lo, hi, lo, ..; each sum hi + lo approximates a number."""
    result: list[float] = []
    for value in values:
        result += (value, 0.0) if isinstance(value, float) else quotient(value.numerator, value.denominator)
    return result


def attitude(values: Sequence[Number]) -> list[float]:
    """Return a quaternion as a list of 8 doubles: hi and lo of each component, with a relative error of 2^-86."""
    # no more digits are needed; on this grid, arithmetic on arrays (batches) arrives at the same doubles
    result: list[float] = []
    for value in values:
        result += (value + 0.0, 0.0) if isinstance(value, float) else on_grid([value.as_integer_ratio()])
    return result


def on_grid(values: Sequence[tuple[int, int]]) -> list[float]:
    """Return ratios of integers, given as pairs (top, bottom), as a list hi, lo, hi, lo, ..

    Each sum hi + lo approximates top/bottom. hi is the nearest double; lo is rounded to a multiple of :data:`GRID`
    ulps of hi.
    """
    result: list[float] = []
    for top, bottom in values:
        hi = top / bottom
        over, under = hi.as_integer_ratio()
        lo = (top * under - over * bottom) / (bottom * under)
        # coarser than the doubles near lo, so that a less exact method, double-double arithmetic for many ratios at
        # once (batches), can round to the same multiple
        step = ulp(hi) * GRID
        result += (hi, round(lo / step) * step if lo and step else lo)
    return result


def same(a: Number, b: Number) -> bool:
    """Return whether two numbers count as equal: they differ by less than 2^-200 of their size.

    Two floats count as equal only if they are identical.
    """
    return a == b or (not (isinstance(a, float) and isinstance(b, float)) and equal(Fraction(a), Fraction(b)))


def over_common_denominator(values: Sequence[Number]) -> tuple[list[int], int]:
    """Return the integer numerators of some numbers over one common denominator, and this denominator.

    Example: 1/2 and 1/3 give ``[3, 2]`` and 6.
    """
    ratios = [value.as_integer_ratio() for value in values]
    shared = ratios[0][1]
    if {bottom for _, bottom in ratios} == {shared}:
        return [top for top, _ in ratios], shared
    shared = lcm(*[bottom for _, bottom in ratios])
    return [top * (shared // bottom) for top, bottom in ratios], shared


def numbers(what: str, values: Sequence[Number], length: int, least: float = -LARGEST) -> list[Number]:
    """Return ``values`` as a list after checks: they must be ``length`` real numbers of a size that motions allow.

    Raises
    ------
    InputError
        If there are not ``length`` values, or if one is not a real number, exceeds :data:`LARGEST` in absolute value,
        or is below ``least``.
    """
    entries = _listed(what, values, length)
    if (
        {*map(type, entries)} == {float}
        and all(map(isfinite, entries))
        and max(entries) <= LARGEST
        and min(entries) >= least
    ):
        return entries
    for index, value in enumerate(entries):
        if type(value) is Fraction and _moderate(value, least):
            continue
        if isinstance(value, bool) or not isinstance(value, float | int | Fraction):
            entries[index] = value = _double(what, value)  # such as NumPy's numbers
        if not abs(value) <= LARGEST:
            raise InputError(f"{what}: expected finite numbers of a magnitude up to {LARGEST:g}, got {show(value)}")
        if value < least:
            raise InputError(f"{what}: expected positive numbers, each {least:g} or more, got {show(value)}")
    return entries


def _moderate(value: Fraction, least: float) -> bool:
    """Return whether bit lengths alone show that a fraction is at least ``least``, and at most LARGEST in size.

    If not, :func:`numbers` compares exactly. The fraction may then still lie within these bounds.
    """
    top, bottom = value.as_integer_ratio()
    size = top.bit_length() - bottom.bit_length()  # the exponent of the next power of two, or one more
    return size < _BITS and (least < 0 or (top > 0 and size > -_BITS))


def _listed(what: str, values: Sequence[Number], length: int) -> list[Any]:
    try:
        entries = list(values)
    except TypeError:
        raise InputError(f"{what}: expected {length} numbers, got {show(values)}") from None
    if len(entries) != length:
        raise InputError(f"{what}: expected {length} numbers, got {len(entries)}")
    return entries


def _double(what: str, value: Any) -> float:
    try:
        if not isinstance(value, bool | str):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(f"{what}: expected real numbers, got {show(value)}")
