"""Fractions of polynomials whose denominators are stored as products of factors, each factor with an exponent.

Formulas of rotation divide often by the same few factors, such as ``sin(theta)``; then sums of fractions are sums of
polynomials. For messages, each factor is stored with the divisor in which it first occurred, written as in the user's
formula.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import comb, lcm, prod
from typing import Any

from sympy import Expr
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import InputError
from symrot.exact.limits.operations import spend

__all__ = ["MOST_PRODUCTS", "Ratio", "Ratios", "TooLarge"]

MOST_PRODUCTS = 1_000_000
"""Largest total number of products of two terms that is computed in one polynomial ring; so many take seconds.

In a ring with 8 or more variables, a product counts more than once.
A count, unlike a time limit, stops a computation at the same term on every machine. The formulas of the four textbooks
and courses that symrot checks need at most 27 000."""


class TooLarge(InputError):
    """The exception for a formula whose expansion exceeds a limit, such as the largest number of products of terms."""


@dataclass(frozen=True)
class Ratio:
    """A fraction ``numerator / (constant * product of factors)`` in a polynomial ring."""

    numerator: PolyElement
    constant: int = 1
    factors: tuple[tuple[int, int], ...] = ()  # pairs (index of the factor in Ratios, exponent), sorted


class Ratios:
    """The arithmetic of fractions (:class:`Ratio`) in one polynomial ring.

    Parameters
    ----------
    ring : PolyRing
        Ring over the integers or the rationals.
    generators : sequence of Expr
        The expressions that the generators of the ring represent.
    reduce : function
        Function that returns the normal form of a polynomial modulo the relations.
    """

    def __init__(
        self, ring: PolyRing, generators: Sequence[Expr], reduce: Callable[[PolyElement], PolyElement]
    ) -> None:
        self.ring = ring
        self.generators = generators
        self.reduce = reduce
        self.factors: list[PolyElement] = []  # primitive, not constant, with positive leading coefficients
        self.sources: list[Expr] = []  # for each factor, the denominator in which it first occurred
        self.point = [37 + 6 * place + place % 5 for place in range(len(generators))]
        self.values: list[int] = []  # values of the factors at the fixed point
        self.products = 0  # products of terms used so far

    def number(self, numerator: int, denominator: int = 1) -> Ratio:
        """Return the rational number numerator/denominator as a fraction of the ring."""
        return Ratio(self.ring.ground_new(self.ring.domain(numerator)), denominator)

    def add(self, terms: Sequence[Ratio]) -> Ratio:
        """Return the sum of the fractions ``terms``; fractions with equal denominators are added first."""
        groups: dict[tuple[int, tuple[tuple[int, int], ...]], PolyElement] = {}
        for term in terms:
            key = (term.constant, term.factors)
            groups[key] = groups[key] + term.numerator if key in groups else term.numerator
        if len(groups) == 1:
            (((constant, factors), numerator),) = groups.items()
            return Ratio(numerator, constant, factors)
        common_constant = lcm(*(constant for constant, _ in groups))
        common: dict[int, int] = {}
        for _, factors in groups:
            for number, power in factors:
                common[number] = max(power, common.get(number, 0))
        total = self.ring.zero
        for (constant, factors), numerator in groups.items():
            own = dict(factors)
            for number, power in sorted(common.items()):
                missing = power - own.get(number, 0)
                if missing:
                    self._spend(len(numerator) * _most_terms(self.factors[number], missing))
                    numerator = numerator * self.factors[number] ** missing
            total = total + numerator.mul_ground(self.ring.domain(common_constant // constant))
        return Ratio(total, common_constant, tuple(sorted(common.items())))

    def multiply(self, factors: Sequence[Ratio]) -> Ratio:
        """Return the product of the fractions ``factors``; small numerators are multiplied first."""
        numerator, constant = self.ring.one, 1
        below: dict[int, int] = {}
        for factor in sorted(factors, key=lambda f: len(f.numerator)):
            self._spend(len(numerator) * len(factor.numerator))
            numerator = numerator * factor.numerator
            constant *= factor.constant
            for number, power in factor.factors:
                below[number] = below.get(number, 0) + power
        return Ratio(numerator, constant, tuple(sorted(below.items())))

    def power(self, base: Ratio, exponent: int) -> Ratio:
        """Return the fraction ``base`` to an integer power >= 0."""
        if exponent == 0:
            return Ratio(self.ring.one)
        self._spend(_most_terms(base.numerator, exponent) * len(base.numerator))
        below = tuple((number, power * exponent) for number, power in base.factors)
        return Ratio(base.numerator**exponent, base.constant**exponent, below)

    def invert(self, value: Ratio, source: Expr) -> Ratio:
        """Return 1/value; the new divisor is stored with ``source``, the divisor as the user's formula writes it.

        Raises
        ------
        InputError
            If the value is zero everywhere.
        """
        numerator = self.reduce(value.numerator)
        if not numerator:
            raise InputError(f"the formula divides by {source}, which is zero everywhere")
        constant, below = self._split(numerator, source)
        above = self.denominator(value).mul_ground(self.ring.domain(constant.denominator))
        return Ratio(above if constant > 0 else -above, abs(constant.numerator), below)

    def denominator(self, value: Ratio) -> PolyElement:
        """Return the denominator of a fraction as a polynomial, multiplied out."""
        below = self.ring.ground_new(self.ring.domain(value.constant))
        for number, power in value.factors:
            below = below * self.factors[number] ** power
        return below

    def _spend(self, products: int) -> None:
        products *= 1 + len(self.generators) // 8  # a long monomial costs more
        self.products += products
        if self.products > MOST_PRODUCTS:
            raise TooLarge(
                f"expected a formula whose expansion takes at most {MOST_PRODUCTS} products of terms, got more"
            )
        spend(products)

    def _split(self, poly: PolyElement, source: Expr) -> tuple[Fraction, tuple[tuple[int, int], ...]]:
        """Return (constant, factors): a polynomial as a rational constant times powers of the stored factors.

        New factors are stored with ``source``, the divisor as written.
        """
        constant, poly = _primitive(poly)
        powers: dict[int, int] = {}
        shared = [min(column) for column in zip(*poly, strict=True)]
        for place, power in enumerate(shared):
            if power:
                powers[self._learn(self.ring.gens[place], self.generators[place])] = power
        if any(shared):
            poly = poly.new({tuple(m - s for m, s in zip(mono, shared, strict=True)): c for mono, c in poly.items()})
        value = self._value(poly)
        for number, known in enumerate(self.factors):
            while len(known) > 1 and not poly.is_ground and self._may_divide(number, value):
                quotient, rest = divmod(poly, known)
                if rest:
                    break
                poly, powers[number] = quotient, powers.get(number, 0) + 1
                value = self._value(poly)
        if poly.is_ground:
            constant *= Fraction(int(poly.LC.numerator), int(poly.LC.denominator))
        else:
            powers[self._learn(poly, source)] = 1
        return constant, tuple(sorted(powers.items()))

    def _value(self, poly: PolyElement) -> int:
        """Return the value of a polynomial with integer coefficients at ``self.point``, a point of integers."""
        return sum(
            int(coefficient) * prod(base**power for base, power in zip(self.point, mono, strict=True) if power)
            for mono, coefficient in poly.items()
        )

    def _may_divide(self, number: int, value: int) -> bool:
        """Return False if a polynomial cannot be divisible by ``self.factors[number]``, judged by values at one point.

        ``value`` is the value of the polynomial at ``self.point``, a point of integers.
        """
        # Gauss's lemma: with coprime integer coefficients a quotient has integer coefficients, so the value of the
        # factor divides the other value; this test is faster than a division that fails
        own = self.values[number]
        return own == 0 or value % own == 0

    def _learn(self, poly: PolyElement, source: Expr) -> int:
        for number, known in enumerate(self.factors):
            if known == poly:
                return number
        self.factors.append(poly)
        self.sources.append(source)
        self.values.append(self._value(poly))
        return len(self.factors) - 1


def _most_terms(poly: PolyElement, exponent: int) -> int:
    """Return an upper bound on the number of terms of ``poly**exponent``, to stop before a product is too long."""
    if len(poly) < 2 or exponent == 1:
        return len(poly)
    by_degrees = prod(int(degree) * exponent + 1 for degree in poly.degrees())
    return min(comb(len(poly) + exponent - 1, exponent), by_degrees)


def _primitive(poly: PolyElement) -> tuple[Fraction, PolyElement]:
    """Return (c, P) with ``poly = c*P``; P has coprime integer coefficients, the leading one positive."""
    scale: Any = 1
    if poly.ring.domain is QQ:
        scale, poly = poly.clear_denoms()
    content, poly = poly.primitive()
    constant = Fraction(int(content), int(scale))
    return (-constant, -poly) if poly.LC < 0 else (constant, poly)
