"""Groebner bases by Buchberger's algorithm within a counted budget.

The algorithm can need unlimited work; it stops after a given number of products of terms, the same on every machine.
"""

from collections.abc import Callable, Sequence
from heapq import heapify, heappop, heappush
from typing import Any

from sympy.polys.rings import PolyElement, PolyRing

from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_PRODUCTS", "groebner_basis"]

MOST_PRODUCTS = 400_000
"""Largest number of products of two terms to compute one Groebner basis; so many products take about a second."""

Monomial = tuple[int, ...]
Terms = dict[Monomial, Any]


def groebner_basis(
    polynomials: Sequence[PolyElement],
    ring: PolyRing,
    most_products: int = MOST_PRODUCTS,
    spent: list[int] | None = None,
) -> tuple[PolyElement, ...]:
    """Return the reduced Groebner basis of an ideal, monic, largest leading term first.

    Parameters
    ----------
    polynomials : sequence of PolyElement
        The generators of the ideal, in ``ring``.
    ring : PolyRing
        Ring over a field, with any order of monomials.
    most_products : int
        Largest number of products of two terms that may be computed. This count limits the time equally on all
        machines.
    spent : list of one int, optional
        The number of products computed so far, which is increased; several calls may share it.

    Raises
    ------
    TooLarge
        If more than ``most_products`` products are needed.
    """
    return _Basis(ring, most_products, [0] if spent is None else spent).of(polynomials)


class _Basis:
    def __init__(self, ring: PolyRing, most_products: int, spent: list[int]) -> None:
        self.ring, self.most, self.spent = ring, most_products, spent
        self.weight = 1 + ring.ngens // 16  # a long monomial costs more
        self.key: Callable[[Monomial], Any] = ring.order
        self.members: list[Terms] = []
        self.leads: list[Monomial] = []

    def spend(self, products: int) -> None:
        self.spent[0] += products * self.weight
        if self.spent[0] > self.most:
            raise TooLarge(
                f"expected hypotheses that need at most {self.most} products of terms, got more; use "
                "fewer or simpler hypotheses"
            )

    def of(self, polynomials: Sequence[PolyElement]) -> tuple[PolyElement, ...]:
        pairs: list[tuple[Any, ...]] = []
        for poly in sorted((p for p in polynomials if p), key=len):
            self.add(self.normal(dict(poly.items()), self.members), pairs)
        heapify(pairs)
        while pairs:
            _, _, i, j = heappop(pairs)
            if not self.idle(i, j):
                self.add(self.normal(self.s_polynomial(i, j), self.members), pairs)
        return self.reduced()

    def add(self, terms: Terms, pairs: list[tuple[Any, ...]]) -> None:
        """Add the polynomial ``terms`` to the basis, and its pairs with the other members to the queue ``pairs``."""
        if not terms:
            return
        lead = max(terms, key=self.key)
        inverse = self.ring.domain.one / terms[lead]
        new = len(self.members)
        for old, other in enumerate(self.leads):
            if any(map(min, lead, other)):  # coprime leading terms reduce to zero
                both = tuple(map(max, lead, other))
                # the queue begins with the pair whose leading terms have the smallest least common multiple
                heappush(pairs, (sum(both), both, old, new))
        self.members.append({mono: c * inverse for mono, c in terms.items()})
        self.leads.append(lead)
        if not any(lead):
            pairs.clear()  # a constant generates the whole ring

    def idle(self, i: int, j: int) -> bool:
        """Return whether the pair of members i and j can be skipped by Buchberger's chain criterion."""
        both = tuple(map(max, self.leads[i], self.leads[j]))
        # the leading term of a third member divides the least common multiple, and its pairs with i and j are dealt
        # with
        return any(
            k < i and _divides(lead, both) and tuple(map(max, lead, self.leads[i])) != both
            and tuple(map(max, lead, self.leads[j])) != both
            for k, lead in enumerate(self.leads)
        )  # fmt: skip

    def s_polynomial(self, i: int, j: int) -> Terms:
        both = tuple(map(max, self.leads[i], self.leads[j]))
        total: Terms = {}
        for member, sign in ((i, 1), (j, -1)):
            shift = tuple(map(int.__sub__, both, self.leads[member]))
            self.subtract(total, self.members[member], shift, -sign * self.ring.domain.one)
        return total

    def subtract(self, total: Terms, terms: Terms, shift: Monomial, times: Any) -> None:
        """Subtract a multiple of the polynomial ``terms`` from the polynomial ``total``, in place.

        The multiple is the number ``times``, times the monomial ``shift``.
        """
        self.spend(len(terms))
        zero = self.ring.domain.zero
        for mono, coefficient in terms.items():
            place = tuple(map(int.__add__, mono, shift))
            value = total.get(place, zero) - times * coefficient
            if value:
                total[place] = value
            else:
                del total[place]

    def normal(self, terms: Terms, members: Sequence[Terms]) -> Terms:
        """Return the remainder of a polynomial (``terms``) after division by ``members`` of a basis."""
        leads = self.leads if members is self.members else [max(member, key=self.key) for member in members]
        left: Terms = {}
        while terms:
            lead = max(terms, key=self.key)
            self.spend(1 + len(terms) // 8 + len(leads) // 4)
            # no leading term of a member divides a term of the remainder
            for member, divisor in zip(members, leads, strict=True):
                if _divides(divisor, lead):
                    self.subtract(terms, member, tuple(map(int.__sub__, lead, divisor)), terms[lead])
                    break
            else:
                left[lead] = terms.pop(lead)
        return left

    def reduced(self) -> tuple[PolyElement, ...]:
        minimal: list[Terms] = []
        for place, (member, lead) in enumerate(zip(self.members, self.leads, strict=True)):
            others = [o for n, o in enumerate(self.leads) if n != place and (o != lead or n < place)]
            if not any(_divides(other, lead) for other in others):
                minimal.append(member)
        members = [self.normal(dict(member), [o for o in minimal if o is not member]) for member in minimal]
        ordered = sorted(members, key=lambda terms: self.key(max(terms, key=self.key)), reverse=True)
        return tuple(self.ring.from_dict(terms) for terms in ordered)


def _divides(small: Monomial, large: Monomial) -> bool:
    return all(a <= b for a, b in zip(small, large, strict=True))
