"""Proofs that no real point obeys some constraints, and that a formula vanishes wherever they hold.

A vanishing product is split into one case per factor, a sum of squares into its squares; a Groebner basis then
replaces the polynomials. A case is impossible if 1 = 0 follows, or if a polynomial is nowhere zero.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from math import inf, prod
from typing import Any

from sympy import Poly, Symbol
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement, PolyRing

from symrot.checker.decide.constraints import Constraints, distinct_factors
from symrot.exact.domain.everywhere import REALS, Range, power_of_range, product_of_ranges, sum_of_ranges
from symrot.exact.ring.groebner import groebner_basis
from symrot.exact.ring.polynomials import occurring
from symrot.exact.ring.ratio import TooLarge

__all__ = ["Infeasibility", "infeasibility_proof", "vanishes_on"]

MOST_CASES = 40
"""The largest number of cases of a proof.

If a product x*y must be zero, the proof has the cases x = 0 and y = 0, which may have further cases in them. A case
counts again after each Groebner basis that is computed for it."""
MOST_ROUNDS = 6
"""The largest number of Groebner bases for one case, including the bases for the cases that contain it."""

MOST_PRODUCTS = 150_000
"""The largest number of products of terms in all Groebner bases of one proof."""


class _Undecided(Exception):
    """Raised by :class:`_Prover` if it finds no proof that given polynomials have no common real zero."""


@dataclass(frozen=True)
class Infeasibility:
    """The reason why no point obeys a set of constraints.

    If the reason is one polynomial that would have to be zero but never is, it is ``polynomial``, otherwise None.
    """

    reason: str
    polynomial: PolyElement | None = None


def infeasibility_proof(constraints: Constraints) -> Infeasibility | None:
    """Return the proven reason why no real point obeys the constraints; None without a proof."""
    if not constraints.real:
        return None
    zeros = list(constraints.zeros)
    for poly in constraints.nonzero:
        if not poly:
            return Infeasibility("a divisor is zero wherever the other conditions hold")
    ring = constraints.ring
    nonzero = [poly for poly in constraints.nonzero if not poly.is_ground]
    if nonzero:
        ring, constraints = _with_one_more(constraints)
        last = ring.gens[-1]
        zeros = [_lifted(poly, ring) for poly in zeros]
        zeros.append(last * prod((_lifted(p, ring) for p in nonzero), start=ring.one) - 1)
    try:
        return _Prover(ring, constraints).impossible(zeros)
    except (_Undecided, TooLarge):
        return None


def vanishes_on(constraints: Constraints, formula: PolyElement) -> bool:
    """Return whether a polynomial of the same ring provably vanishes at all real points that obey the constraints."""
    # that is, if z*formula = 1 is impossible (Rabinowitsch): x vanishes under x^2 = 0, under x^2 + y^2 = 0, and under
    # x*y = 0 for y > 0, though it is no multiple of any of these polynomials
    return infeasibility_proof(replace(constraints, nonzero=(*constraints.nonzero, formula))) is not None


def _with_one_more(constraints: Constraints) -> tuple[PolyRing, Constraints]:
    old = constraints.ring
    ring = PolyRing([*old.symbols, Symbol("inverse")], QQ, old.order)
    return ring, replace(constraints, ring=ring, nonzero=tuple(_lifted(p, ring) for p in constraints.nonzero))


def _lifted(poly: PolyElement, ring: PolyRing) -> PolyElement:
    return ring.from_dict({(*mono, 0): coefficient for mono, coefficient in poly.items()})


class _Prover:
    """A proof by cases that polynomials cannot all vanish, within a budget of cases and of products of terms."""

    def __init__(self, ring: PolyRing, constraints: Constraints) -> None:
        self.ring, self.constraints, self.cases, self.spent = ring, constraints, 0, [0]
        self.nonnegative = constraints.positive | constraints.nonnegative
        self.signed = constraints.positive | constraints.negative
        self.forbidden = {poly.monic() for poly in constraints.nonzero if poly and not poly.is_ground}

    def impossible(self, zeros: Sequence[PolyElement], rounds: int = MOST_ROUNDS) -> Infeasibility:
        """Return the reason why the polynomials ``zeros`` have no common zero; raise ``_Undecided`` without a proof."""
        self.cases += 1
        # ``rounds`` is the number of Groebner bases that may still be computed
        if self.cases > MOST_CASES or rounds == 0:
            raise _Undecided
        simple: list[PolyElement] = []
        for number, poly in enumerate(zeros):
            factors = self.factors(poly)
            if not factors and poly:
                return _never_zero(poly)
            if len(factors) > 1:
                rest = [*simple, *zeros[number + 1 :]]
                cases = [self.impossible([factor, *rest], rounds) for factor in factors]
                same = len({case.reason for case in cases}) == 1
                return cases[0] if same else Infeasibility("every case is impossible")
            simple.extend(self.parts(factors[0]) if factors else ())
        for poly in simple:
            if self.keeps_its_sign(poly, simple):
                return _never_zero(poly)
        basis = groebner_basis(simple, self.ring, MOST_PRODUCTS, self.spent)
        if any(poly.is_ground for poly in basis):
            return Infeasibility("the conditions contradict each other")
        for poly in basis:
            if self.keeps_its_sign(poly, simple):
                return _never_zero(poly)
        if {poly.monic() for poly in simple} == set(basis) and all(self.parts(p) == [p] for p in basis):
            raise _Undecided
        return self.impossible(basis, rounds - 1)

    def factors(self, poly: PolyElement) -> list[PolyElement]:
        """Return the different factors of a polynomial that may be zero somewhere: x - y for
        ``(x^2 + 1)*(x - y)``.
        """
        if not poly or poly.is_ground:
            # a constant has no factor; the caller treats the polynomial zero itself
            return []
        return [
            f
            for f in distinct_factors(poly)
            if f not in self.forbidden and not self.one_signed(f) and not self.rootless(f)
        ]

    def parts(self, poly: PolyElement) -> list[PolyElement]:
        """Return simpler polynomials that vanish wherever ``poly`` does: x and y for ``x^2 + y^4``."""
        signs = {self.sign_of_term(mono, coefficient) for mono, coefficient in poly.items()}
        # all terms have one sign
        if len(poly) > 1 and (signs <= {1} or signs <= {-1}):
            radicals = [tuple(min(power, 1) for power in mono) for mono in poly]
            return [self.ring.from_dict({mono: self.ring.domain.one}) for mono in radicals]
        squares = self.squares(poly)
        return [form for _, form in squares if not form.is_ground] if squares else [poly]

    # -- signs --------------------------------------------------------------------------------------------------------

    def sign_of_term(self, mono: tuple[int, ...], coefficient: Any) -> int:
        """Return +1 for a term that is never negative, -1 for one that is never positive, otherwise 0."""
        # ``mono`` has the exponents of the unknowns, some of which have a known sign
        sign = 1 if coefficient > 0 else -1
        for place, power in enumerate(mono):
            if power % 2 and place in self.constraints.negative:
                sign = -sign
            elif power % 2 and place not in self.nonnegative:
                return 0
        return sign

    def one_signed(self, poly: PolyElement) -> bool:
        """Return whether the form of a polynomial, such as ``x^2 + 1``, shows that it is nowhere zero."""
        signs = {self.sign_of_term(mono, coefficient) for mono, coefficient in poly.items()}
        strict = any(all(place in self.signed for place, power in enumerate(mono) if power) for mono in poly)
        if strict and (signs == {1} or signs == {-1}):
            return True
        squares = self.squares(poly)
        return bool(squares) and any(form.is_ground for _, form in squares)

    def keeps_its_sign(self, poly: PolyElement, zeros: Sequence[PolyElement]) -> bool:
        # nowhere zero: by its form, because it has no real roots, or by the ranges of its unknowns
        return self.one_signed(poly) or self.rootless(poly) or self.out_of_range(poly, zeros)

    def rootless(self, poly: PolyElement) -> bool:
        """Return whether a polynomial in one unknown has no real root that the unknown may equal, by Sturm's theorem.

        Negative roots do not count if the constraints assume that the unknown is positive, and so on for other signs.
        """
        places = occurring([poly])
        if len(places) != 1:
            return False
        (place,) = places
        degree = poly.degrees()[place]
        x = self.ring.gens[place]
        numbers = [QQ.to_sympy(poly.coeff(x**n if n else 1)) for n in range(degree, -1, -1)]
        low = 0 if place in self.nonnegative else None
        high = 0 if place in self.constraints.negative else None
        roots = int(Poly(numbers, Symbol("x")).count_roots(low, high))
        at_zero = numbers[-1] == 0 and place in self.signed
        return roots == int(at_zero)

    def squares(self, poly: PolyElement) -> list[tuple[Any, PolyElement]]:
        """Return pairs (d, l) such that a polynomial of degree 2, or its negative, is the sum of all ``d*l^2``.

        d is positive, and l is linear or 1. Example: [(1, x), (2, y)] for ``x^2 + 2*y^2``; [] if there is no such sum.
        """
        if max(map(sum, poly)) != 2:
            return []
        for sign in (1, -1):
            squares = self._completed(poly * sign)
            if squares:
                return squares
        return []

    def _completed(self, rest: PolyElement) -> list[tuple[Any, PolyElement]]:
        """Return pairs (d, l) such that the polynomial ``rest`` of degree 2 is the sum of all ``d*l^2``; [] if none.

        d is positive, and l is linear or 1. :meth:`squares` also tries the negative of a polynomial, this method does
        not.
        """
        squares = []
        for place in sorted(occurring([rest])):
            x = self.ring.gens[place]
            leading = rest.coeff(x**2)
            if leading < 0:
                return []
            if leading == 0:
                if place in occurring([rest]):
                    return []
                continue
            # x^2 + 2*x*y + 3*y^2 = 1*(x + y)^2 + 2*y^2
            form = rest.diff(place).quo_ground(2 * leading)
            squares.append((leading, form))
            rest = rest - form**2 * leading
        if rest and not (rest.is_ground and rest.coeff(1) > 0):
            return []
        return [*squares, (rest.coeff(1), self.ring.one)] if rest else squares

    # -- ranges -------------------------------------------------------------------------------------------------------

    def out_of_range(self, poly: PolyElement, zeros: Sequence[PolyElement]) -> bool:
        """Return whether bounds of the unknowns, which follow from ``zeros``, show that a polynomial is never zero.

        Example: if x^2 + y^2 - 1 is zero, then -1 <= x <= 1, and x - 2 is never zero.
        """
        bounds = self.bounds(zeros)
        low, high = reduce(sum_of_ranges, (_term_range(mono, c, bounds) for mono, c in poly.items()))
        return bool(low > 0 or high < 0)

    def bounds(self, zeros: Sequence[PolyElement]) -> dict[int, Range]:
        """Return the bounds (low, high) of unknowns by their indices: (-1, 1) for x if ``x^2 + 2*y^2 = 1``."""
        bounds: dict[int, Range] = {}
        for poly in (*self.constraints.zeros, *zeros):
            constant = poly.coeff(1)
            squares = [mono for mono in poly if any(mono)]
            if constant < 0 and all(poly[m] > 0 and not any(power % 2 for power in m) for m in squares):
                for mono in squares:
                    if max(mono) == sum(mono):
                        place = mono.index(max(mono))
                        size = _root_above(_fraction(-constant) / _fraction(poly[mono]), max(mono))
                        bounds[place] = (-size, size)
        # the known signs
        for place in self.nonnegative:
            bounds[place] = (Fraction(0), bounds.get(place, (0, inf))[1])
        for place in self.constraints.negative:
            bounds[place] = (bounds.get(place, (-inf, 0))[0], Fraction(0))
        return bounds


def _never_zero(poly: PolyElement) -> Infeasibility:
    return Infeasibility("a polynomial that would have to be zero is never zero", poly)


def _fraction(value: Any) -> Fraction:
    return Fraction(int(value.numerator), int(value.denominator))


def _root_above(value: Fraction, power: int) -> Fraction:
    """Return a rational number at least as large as the root of order ``power`` of a positive number."""
    size = Fraction(1)
    while size**power < value:
        size *= 2
    low, high = Fraction(0), size
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (low, middle) if middle**power >= value else (middle, high)
    return high


def _term_range(mono: tuple[int, ...], coefficient: Any, bounds: dict[int, Range]) -> Range:
    """Return the bounds of a term, given the bounds of its unknowns."""
    total: Range = (_fraction(coefficient),) * 2
    for place, power in enumerate(mono):
        if power:
            total = product_of_ranges(total, power_of_range(bounds.get(place, REALS), power))
    return total
