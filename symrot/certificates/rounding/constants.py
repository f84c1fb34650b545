"""Ranges of a scene kernel's parameters, computed from ranges of the physical constants by interval arithmetic.

Parameters such as ``(B - C)/A`` are the arguments of a kernel. If the moments of inertia A, B, C may vary, each
parameter gets a range that contains all its values.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.formula.tree import Node, evaluate, names, text

__all__ = ["ExactRange", "parameter_range"]

PIECES = 256  # parts into which the box of the constants is cut for a tighter enclosure
SPARE = Fraction(1, 2**240)  # larger than the error of irrational numbers, which are correct to 2^-250


@dataclass(frozen=True)
class ExactRange:
    """The range of numbers from ``low`` to ``high``; an operation returns a range that contains all results."""

    low: Fraction
    high: Fraction

    @classmethod
    def about(cls, value: Fraction) -> "ExactRange":
        """Return a range that contains an exact number, such as pi; ``value`` approximates the number to 2^-250."""
        spare = SPARE * max(abs(value), Fraction(1))
        return cls(value - spare, value + spare)

    def __neg__(self) -> "ExactRange":
        return ExactRange(-self.high, -self.low)

    def __add__(self, other: "ExactRange") -> "ExactRange":
        return ExactRange(self.low + other.low, self.high + other.high)

    def __sub__(self, other: "ExactRange") -> "ExactRange":
        return self + -other

    def __mul__(self, other: "ExactRange") -> "ExactRange":
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return ExactRange(min(ends), max(ends))

    def __truediv__(self, other: "ExactRange") -> "ExactRange":
        if other.low <= 0 <= other.high:
            raise ZeroDivisionError
        return self * ExactRange(1 / other.high, 1 / other.low)

    def __abs__(self) -> "ExactRange":
        least = 0 if self.low <= 0 <= self.high else min(abs(self.low), abs(self.high))
        return ExactRange(Fraction(least), max(abs(self.low), abs(self.high)))

    def __pow__(self, exponent: int) -> "ExactRange":
        if exponent < 0:
            return ExactRange(Fraction(1), Fraction(1)) / self**-exponent
        base = self if exponent % 2 else abs(self)
        return ExactRange(base.low**exponent, base.high**exponent)

    def parts(self, count: int) -> Iterator["ExactRange"]:
        """Yield ``count`` ranges of equal width that together make up this range."""
        step = (self.high - self.low) / count
        return (ExactRange(self.low + k * step, self.low + (k + 1) * step) for k in range(count))


def _sqrt(value: ExactRange) -> ExactRange:
    return ExactRange(ExactRange.about(number.sqrt(value.low)).low, ExactRange.about(number.sqrt(value.high)).high)


def _bounded_by_one(value: ExactRange) -> ExactRange:
    """Return [-1, 1], a range that contains every sine and cosine, whatever the range ``value`` of the angle is."""
    return ExactRange(Fraction(-1), Fraction(1))


_FUNCTIONS: dict[str, Callable[[ExactRange], ExactRange]] = {
    "sqrt": _sqrt,
    "sin": _bounded_by_one,
    "cos": _bounded_by_one,
    "abs": abs,
}


def parameter_range(
    name: str, formula: Node, constants: Mapping[str, Fraction], ranges: Mapping[str, tuple[Fraction, Fraction]]
) -> tuple[Fraction, Fraction]:
    """Return a lower and an upper bound of a parameter whose formula contains constants that vary.

    Parameters
    ----------
    name : str
        The name of the parameter, for error messages.
    formula : Node
        The parameter's formula in the physical constants.
    constants : mapping of str to Fraction
        The values of the constants in the scene.
    ranges : mapping of str to (Fraction, Fraction)
        The two ends between which a constant varies, by the name of the constant.

    Raises
    ------
    InputError
        If the parameter is not a finite number everywhere on the ranges, or its formula contains a function such as
        tan, of which no range is computed.
    """
    box = {constant: ExactRange(*ends) for constant, ends in ranges.items() if constant in names(formula)}
    points = {constant: ExactRange(value, value) for constant, value in constants.items()}
    values = {"pi": ExactRange.about(number.PI), **points}
    wide = [constant for constant, ends in box.items() if ends.low < ends.high]
    count = round(PIECES ** (1 / len(wide))) if wide else 1
    cut = [[(constant, part) for part in box[constant].parts(count if constant in wide else 1)] for constant in box]
    try:
        enclosures = [
            evaluate(formula, values | dict(part), _FUNCTIONS, lambda value: ExactRange(value, value))
            for part in product(*cut)
        ]
    except (ZeroDivisionError, ValueError):
        ranges_text = ", ".join(
            f"{constant} {number.show(ends.low)} .. {number.show(ends.high)}" for constant, ends in box.items()
        )
        raise InputError(
            f"--box: expected ranges on which {name} = {text(formula)} is a finite number, got {ranges_text}"
        ) from None
    except KeyError as function:
        raise InputError(
            f"--box: expected {name} to be a formula of + - * / and {', '.join(_FUNCTIONS)} if its constants vary, got "
            f"{text(formula)}, which contains {function.args[0]}"
        ) from None
    return min(each.low for each in enclosures), max(each.high for each in enclosures)
