"""The exact number behind a rounded constant: the simplest fraction, or multiple of pi, that rounds to the constant.

Only the standard library is used.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import frexp
from struct import pack, unpack

from symrot.errors import CertificateError
from symrot.formula.exact_numbers import PI

__all__ = ["IntendedConstant", "intended_value", "rounds_to"]

SHORT = 12  # a number with at most this many significant bits stands for itself
SIMPLE = 2**32  # largest product of numerator and denominator of a fraction that a constant may stand for


@dataclass(frozen=True)
class IntendedConstant:
    """A constant as the C text writes it, and its exact number: ``fraction``, times pi if ``times_pi``."""

    written: Fraction
    fraction: Fraction
    times_pi: bool

    def rounds(self, precision: str) -> bool:
        """Return whether the exact number, rounded to ``precision``, equals ``written``, the constant in the C text."""
        return rounds_to(self.fraction * PI if self.times_pi else self.fraction, precision) == self.written


def rounds_to(value: Fraction, precision: str) -> Fraction:
    """Return a value rounded to a precision, such as ``"binary64"``: to the nearest number, ties to even."""
    if precision == "binary64":
        return Fraction(value.numerator / value.denominator)  # Python rounds a quotient of integers correctly
    near = float(unpack("f", pack("f", float(value)))[0])
    bits = unpack("i", pack("f", near))[0]
    candidates = [
        Fraction(unpack("f", pack("i", bits + step))[0]) for step in (-1, 0, 1) if bits + step >= 0 or near < 0
    ]
    closest = min(abs(candidate - value) for candidate in candidates)
    nearest = [candidate for candidate in candidates if abs(candidate - value) == closest]
    return min(nearest, key=lambda candidate: unpack("i", pack("f", float(candidate)))[0] & 1)


@lru_cache(maxsize=4096)
def intended_value(value: Fraction, precision: str) -> IntendedConstant:
    """Return the exact number for which a constant of the C text stands, such as 1/3 for 0.3333333333333333.

    Raises
    ------
    CertificateError
        If the constant is long and no simple fraction or multiple of pi rounds to it.
    """
    mantissa = frexp(float(value))[0]
    # a constant with few binary digits stands for itself, a longer one for a simple fraction or multiple of pi
    if (mantissa * 2**SHORT).is_integer() and Fraction(float(value)) == value:
        return IntendedConstant(value, value, False)
    digits = {"binary64": 53, "binary32": 24}[precision]
    half = Fraction(2) ** (frexp(float(value))[1] - digits - 1)
    candidates = []
    for unit, times_pi in ((Fraction(1), False), (PI, True)):
        simple = _simplest((abs(value) - half) / unit, (abs(value) + half) / unit)
        candidates.append(IntendedConstant(value, simple if value > 0 else -simple, times_pi))
    for candidate in sorted(candidates, key=lambda candidate: _size(candidate.fraction)):
        if _size(candidate.fraction) <= SIMPLE and candidate.rounds(precision):
            return candidate
    raise CertificateError(
        f"expected a constant that is a rounded simple fraction or multiple of pi, got {float(value)!r}"
    )


def _size(fraction: Fraction) -> int:
    return abs(fraction.numerator) * fraction.denominator


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """Return the fraction with the smallest denominator between ``low`` and ``high``, both positive and included."""
    above, below = _simplest_quotient(low.numerator, low.denominator, high.numerator, high.denominator)
    return Fraction(above, below)


def _simplest_quotient(a: int, b: int, c: int, d: int) -> tuple[int, int]:
    """Return numerator and denominator of the simplest fraction between a/b and c/d, by their continued fractions."""
    whole, rest = divmod(a, b)
    if not rest:
        return whole, 1
    if (whole + 1) * d <= c:
        return whole + 1, 1
    below, above = _simplest_quotient(d, c - whole * d, b, rest)
    return whole * below + above, below
