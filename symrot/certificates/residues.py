"""Numbers modulo a prime, at which two formulas are compared: formulas that are equal at random points are equal.

Two rational functions of degree d that differ agree at a random point with a probability of at most 2 d/PRIME. Points
follow from the hash of the compared texts, so that a proof is the same on every machine.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from hashlib import sha256
from struct import pack, unpack
from typing import Any

from symrot.certificates.readback.intended_constants import intended_value
from symrot.errors import CertificateError
from symrot.formula.tree import FUNCTIONS

__all__ = ["POINTS", "PRIME", "RANDOM", "Residue", "digest_number", "exact", "probability"]

PRIME = 2**127 - 1
POINTS = 4
"""Number of random points at which formulas are compared."""


@dataclass(frozen=True)
class Residue:
    """The value, modulo PRIME, of a rational function at a random point, with a bound of the function's degree."""

    value: int
    # the larger, the more probable it is that two different functions agree at the point
    degree: int = 0

    @staticmethod
    def of(number: Any) -> "Residue":
        if isinstance(number, Residue):
            return number
        exact = Fraction(number)
        return Residue(exact.numerator * pow(exact.denominator, -1, PRIME) % PRIME)

    def __add__(self, other: Any) -> "Residue":
        right = Residue.of(other)
        return Residue((self.value + right.value) % PRIME, self.degree + right.degree)

    __radd__ = __add__

    def __neg__(self) -> "Residue":
        return Residue(-self.value % PRIME, self.degree)

    def __sub__(self, other: Any) -> "Residue":
        return self + -Residue.of(other)

    def __rsub__(self, other: Any) -> "Residue":
        return Residue.of(other) + -self

    def __mul__(self, other: Any) -> "Residue":
        right = Residue.of(other)
        return Residue(self.value * right.value % PRIME, self.degree + right.degree)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Residue":
        right = Residue.of(other)
        if not right.value:
            raise CertificateError("expected a point at which no divisor is zero, got a point with a zero divisor")
        return self * Residue(pow(right.value, -1, PRIME), right.degree)

    def __rtruediv__(self, other: Any) -> "Residue":
        return Residue.of(other) / self

    def __pow__(self, exponent: int) -> "Residue":
        result = Residue(1)
        for _ in range(abs(exponent)):
            result = result * self
        return result if exponent >= 0 else 1 / result


def digest_number(*parts: object) -> int:
    return int.from_bytes(sha256(repr(parts).encode()).digest(), "big") % PRIME


def _function(name: str) -> Callable[..., Residue]:
    """Return a random function of residues (numbers modulo PRIME) that stands for a function such as sine."""
    # the value depends on name and arguments alone, so that equal calls have equal values
    return lambda *arguments: Residue(digest_number(name, *(Residue.of(each).value for each in arguments)), 1)


RANDOM = {name: _function(name) for name in (*FUNCTIONS, "copysign")}
RANDOM["sinc"] = lambda x: RANDOM["sin"](x) / x
"""A map from the name of a function, such as ``"sin"``, to its substitute in arithmetic modulo PRIME.

The substitute returns a random residue, the same for equal arguments. The substitute of ``sinc`` of x is that of the
sine of x, divided by x.
"""


def exact(precision: str) -> Callable[[Fraction], Residue]:
    """Return a function that takes a constant of the C text and returns, modulo ``PRIME``, the exact number it means.

    The function first rounds the constant to ``precision``, as the C text does. The exact number is the simple fraction
    with the same rounded value, such as 1/3 for 0.333.. If there is none, it is the rounded value itself.
    """
    return lambda value: _intended(
        float(value) if precision == "binary64" else float(unpack("f", pack("f", float(value)))[0]), precision
    )


@lru_cache(maxsize=4096)
def _intended(rounded: float, precision: str) -> Residue:
    """Return the residue of the simple fraction that rounds to a number, such as 1/3, or else of the number itself."""
    try:
        constant = intended_value(Fraction(rounded), precision)
    except CertificateError:
        return Residue.of(Fraction(rounded))
    return Residue.of(Fraction(rounded) if constant.times_pi else constant.fraction)


def probability(degree: int, factor: int = 2) -> str:
    """Return a bound of the probability that two different functions agree by chance, such as ``"2^-450"``.

    ``degree`` is the functions' degree. The functions are assumed to agree at one random point with a probability of
    at most ``factor*degree/PRIME``, and have to agree at all ``POINTS`` points.
    """
    wrong = Fraction(factor * degree, PRIME) ** POINTS
    return f"2^-{wrong.denominator.bit_length() - wrong.numerator.bit_length() - 1}"
