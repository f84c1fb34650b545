"""What a rounded constant stands for: the simplest fraction, or fraction of pi, that rounds to it. Standard library."""

from dataclasses import dataclass
from fractions import Fraction
from math import frexp
from struct import pack, unpack

from symrot.errors import CertificateError
from symrot.formula.exact_numbers import PI

__all__ = ["Meant", "meaning", "rounds_to"]

SHORT = 12  # significant bits of a number that stands for itself
SIMPLE = 2**32  # largest numerator times denominator of what a constant may stand for


@dataclass(frozen=True)
class Meant:
    """A constant as written, and the number it stands for: ``fraction``, or that times pi."""

    written: Fraction
    fraction: Fraction
    times_pi: bool

    def rounds(self, precision: str) -> bool:
        """Tell whether the number rounds to what is written."""
        return rounds_to(self.fraction * PI if self.times_pi else self.fraction, precision) == self.written


def rounds_to(value: Fraction, precision: str) -> Fraction:
    """Return the number of a precision nearest to a value, ties to even."""
    if precision == "binary64":
        return Fraction(value.numerator / value.denominator)  # Python rounds a quotient of integers correctly
    near = float(unpack("f", pack("f", float(value)))[0])
    bits = unpack("i", pack("f", near))[0]
    candidates = [
        Fraction(unpack("f", pack("i", bits + step))[0]) for step in (-1, 0, 1) if bits + step >= 0 or near < 0
    ]
    closest = min(abs(candidate - value) for candidate in candidates)
    found = [candidate for candidate in candidates if abs(candidate - value) == closest]
    return min(found, key=lambda candidate: unpack("i", pack("f", float(candidate)))[0] & 1)


def meaning(value: Fraction, precision: str) -> Meant:
    """Return what a constant stands for.

    Raises
    ------
    CertificateError
        If neither it nor a simple fraction, or a simple fraction of pi, rounds to it.
    """
    mantissa = frexp(float(value))[0]
    if (mantissa * 2**SHORT).is_integer() and Fraction(float(value)) == value:
        return Meant(value, value, False)
    digits = {"binary64": 53, "binary32": 24}[precision]
    half = Fraction(2) ** (frexp(float(value))[1] - digits - 1)
    candidates = []
    for unit, times_pi in ((Fraction(1), False), (PI, True)):
        simple = _simplest((abs(value) - half) / unit, (abs(value) + half) / unit)
        candidates.append(Meant(value, simple if value > 0 else -simple, times_pi))
    for meant in sorted(candidates, key=lambda meant: _size(meant.fraction)):
        if _size(meant.fraction) <= SIMPLE and meant.rounds(precision):
            return meant
    raise CertificateError(
        f"expected a constant that a simple fraction or a multiple of pi rounds to, got {float(value)!r}"
    )


def _size(fraction: Fraction) -> int:
    return abs(fraction.numerator) * fraction.denominator


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """Return the fraction of least denominator in a closed interval of positive numbers."""
    whole = low.numerator // low.denominator
    if low == whole:
        return Fraction(whole)
    if whole + 1 <= high:
        return Fraction(whole + 1)
    return whole + 1 / _simplest(1 / (high - whole), 1 / (low - whole))
