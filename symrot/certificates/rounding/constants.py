"""Ranges of a scene kernel's parameters from ranges of the physical constants in them, by interval arithmetic.

A kernel takes parameters such as ``(B - C)/A``, not the moments of inertia themselves. Where these are ranges, each
parameter is enclosed in one: exact at its ends for rational formulas, never too small. Standard library only.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.formula.tree import Node, evaluate, names, text

__all__ = ["Range", "enclosed"]

PIECES = 256  # parts of the box of the constants: of each the formula is enclosed
SPARE = Fraction(1, 2**240)  # above the error of numbers that are not rational


@dataclass(frozen=True)
class Range:
    """All numbers from ``low`` to ``high``; operations return a range of all results."""

    low: Fraction
    high: Fraction

    @classmethod
    def about(cls, value: Fraction) -> "Range":
        """Return the range of a number that was rounded to 2^-250."""
        spare = SPARE * max(abs(value), Fraction(1))
        return cls(value - spare, value + spare)

    def __neg__(self) -> "Range":
        return Range(-self.high, -self.low)

    def __add__(self, other: "Range") -> "Range":
        return Range(self.low + other.low, self.high + other.high)

    def __sub__(self, other: "Range") -> "Range":
        return self + -other

    def __mul__(self, other: "Range") -> "Range":
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Range(min(ends), max(ends))

    def __truediv__(self, other: "Range") -> "Range":
        if other.low <= 0 <= other.high:
            raise ZeroDivisionError
        return self * Range(1 / other.high, 1 / other.low)

    def __abs__(self) -> "Range":
        least = 0 if self.low <= 0 <= self.high else min(abs(self.low), abs(self.high))
        return Range(Fraction(least), max(abs(self.low), abs(self.high)))

    def __pow__(self, exponent: int) -> "Range":
        if exponent < 0:
            return Range(Fraction(1), Fraction(1)) / self**-exponent
        base = self if exponent % 2 else abs(self)
        return Range(base.low**exponent, base.high**exponent)

    def parts(self, count: int) -> Iterator["Range"]:
        """Return ranges that make up this one."""
        step = (self.high - self.low) / count
        return (Range(self.low + k * step, self.low + (k + 1) * step) for k in range(count))


def _sqrt(value: Range) -> Range:
    return Range(Range.about(number.sqrt(value.low)).low, Range.about(number.sqrt(value.high)).high)


def _circular(value: Range) -> Range:
    """Return a range of sines or cosines: those of a range that is no point are anywhere."""
    return Range(Fraction(-1), Fraction(1))


_FUNCTIONS: dict[str, Callable[[Range], Range]] = {"sqrt": _sqrt, "sin": _circular, "cos": _circular, "abs": abs}


def enclosed(
    name: str, formula: Node, constants: Mapping[str, Fraction], ranges: Mapping[str, tuple[Fraction, Fraction]]
) -> tuple[Fraction, Fraction]:
    """Return least and largest value of a parameter, enclosed.

    Parameters
    ----------
    name : str
        The parameter, for errors.
    formula : Node
        What it is, over the physical constants.
    constants : mapping of str to Fraction
        The values of a scene.
    ranges : mapping of str to (Fraction, Fraction)
        Constants that may be anything between two ends instead.

    Raises
    ------
    InputError
        For ranges on which the parameter is not finite, or no number.
    """
    box = {constant: Range(*ends) for constant, ends in ranges.items() if constant in names(formula)}
    points = {constant: Range(value, value) for constant, value in constants.items()}
    values = {"pi": Range.about(number.PI), **points}
    wide = [constant for constant, ends in box.items() if ends.low < ends.high]
    count = round(PIECES ** (1 / len(wide))) if wide else 1
    cut = [[(constant, part) for part in box[constant].parts(count if constant in wide else 1)] for constant in box]
    try:
        found = [
            evaluate(formula, values | dict(part), _FUNCTIONS, lambda value: Range(value, value))
            for part in product(*cut)
        ]
    except (ZeroDivisionError, ValueError):
        said = ", ".join(
            f"{constant} {number.show(ends.low)} .. {number.show(ends.high)}" for constant, ends in box.items()
        )
        raise InputError(
            f"--box: expected ranges on which {name} = {text(formula)} is a finite number, got {said}"
        ) from None
    return min(each.low for each in found), max(each.high for each in found)
