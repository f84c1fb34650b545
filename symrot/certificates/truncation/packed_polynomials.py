"""Polynomials with rational coefficients whose monomials are stored as integers, for bounds of truncation errors.

Their products take a tenth of the time of those in ``symrot.formula.polynomial``. Standard library only.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import gcd, lcm
from typing import Any

__all__ = ["PackedPolynomial", "variables"]

WIDTH = 64
"""Number of bits that each variable's power takes in the integer that stands for a monomial."""


class PackedPolynomial:
    """A polynomial in the variables ``names``: the sum of ``numerators[m]/below`` times the monomial m.

    For example, ``x*y/2 - y**2/3`` has the numerators 3 and -2 and ``below = 6``.
    """

    # A monomial is an integer with WIDTH bits for each power, those of the first variable highest, so that monomials
    # are multiplied by an addition. ``degree`` bounds the sum of the powers, which must not reach the next variable.
    __slots__ = ("below", "degree", "names", "numerators")

    def __init__(self, names: Sequence[str], numerators: dict[int, int], below: int = 1, degree: int = 0) -> None:
        if degree >> WIDTH:
            raise OverflowError(f"expected a polynomial of a degree below 2^{WIDTH}")
        nonzero = {m: c for m, c in numerators.items() if c}
        common = gcd(below, *nonzero.values())
        self.names = names
        self.numerators = {m: c // common for m, c in nonzero.items()} if common != 1 else nonzero
        self.below = below // common
        self.degree = degree

    @staticmethod
    def constant(names: Sequence[str], value: Fraction | float) -> "PackedPolynomial":
        """Return the number ``value`` as a polynomial in the variables ``names``."""
        above, below = value.as_integer_ratio()
        return PackedPolynomial(names, {0: above}, below)

    def _of(self, value: Any) -> "PackedPolynomial":
        if isinstance(value, PackedPolynomial):
            return value
        return PackedPolynomial.constant(self.names, value)

    def __add__(self, other: Any) -> "PackedPolynomial":
        right = self._of(other)
        below = lcm(self.below, right.below)
        factor = below // self.below
        total = {m: c * factor for m, c in self.numerators.items()}
        factor = below // right.below
        for m, c in right.numerators.items():
            total[m] = total.get(m, 0) + c * factor
        return PackedPolynomial(self.names, total, below, max(self.degree, right.degree))

    __radd__ = __add__

    def __neg__(self) -> "PackedPolynomial":
        return PackedPolynomial(self.names, {m: -c for m, c in self.numerators.items()}, self.below, self.degree)

    def __sub__(self, other: Any) -> "PackedPolynomial":
        return self + -self._of(other)

    def __rsub__(self, other: Any) -> "PackedPolynomial":
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> "PackedPolynomial":
        right = self._of(other)
        product: dict[int, int] = {}
        pairs = right.numerators.items()
        for m, c in self.numerators.items():
            for n, d in pairs:
                key = m + n
                product[key] = product.get(key, 0) + c * d
        return PackedPolynomial(self.names, product, self.below * right.below, self.degree + right.degree)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "PackedPolynomial":
        divisor = self._of(other)
        if divisor.numerators.keys() - {0}:
            raise TypeError("expected a number as the divisor of a polynomial")
        above = divisor.numerators.get(0, 0)
        return self * PackedPolynomial.constant(self.names, Fraction(divisor.below, above))

    def __pow__(self, exponent: int) -> "PackedPolynomial":
        power, square = PackedPolynomial.constant(self.names, 1), self
        while exponent:
            power = power * square if exponent & 1 else power
            exponent >>= 1
            square = square * square if exponent else square
        return power

    def __len__(self) -> int:
        """Return the number of terms."""
        return len(self.numerators)

    def terms(self) -> list[tuple[Fraction, tuple[tuple[str, int], ...]]]:
        """Return the terms, each as its coefficient and its powers: ``(2, (("x", 3),))`` for ``2*x**3``.

        Terms with a higher power of the first variable come first, then those with a higher power of the second.
        """
        places = [(name, WIDTH * (len(self.names) - 1 - i)) for i, name in enumerate(self.names)]
        mask = (1 << WIDTH) - 1
        return [
            (Fraction(self.numerators[m], self.below),
             tuple((name, power) for name, place in places if (power := m >> place & mask)))
            for m in sorted(self.numerators, reverse=True)
        ]  # fmt: skip


def variables(names: Sequence[str]) -> list[PackedPolynomial]:
    """Return the variables ``names`` as polynomials in these variables."""
    return [PackedPolynomial(names, {1 << WIDTH * (len(names) - 1 - i): 1}, 1, 1) for i in range(len(names))]
