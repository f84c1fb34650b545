"""The real points at which a claim is to hold, as polynomial constraints on the generators (unknowns) of its ring.

Hypotheses, ``sin^2 + cos^2 - 1`` of angles, and ``root^n - base`` of roots are zero; divisors are not. A generator is
called free if it may have every value that these constraints allow: a symbol, the sine or cosine of an angle whose
symbols occur nowhere else, or a root of a formula in such generators. The generator tanh(x) is not free, since it
depends on x in a way that polynomials cannot express. A constraint that contains it is left out: a proof that no point
obeys the other constraints stays valid, but a point that obeys the others may violate this one.
"""

from dataclasses import dataclass
from functools import cached_property

from sympy import I
from sympy.polys.domains import QQ
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, PolyRing

from symrot.exact.domain.domain import free_angles
from symrot.exact.factors import factor_list
from symrot.exact.ring.polynomials import occurring
from symrot.exact.ring.ring import FormulaRing

__all__ = ["Constraints", "constraints_of", "distinct_factors"]

MOST_TERMS, MOST_UNKNOWNS, LARGEST_DEGREE = 40, 4, 12
"""The largest number of terms, number of unknowns and degree of a polynomial that is factored."""


@dataclass(frozen=True)
class Constraints:
    """A set of real points: the polynomials ``zeros`` vanish, ``nonzero`` do not, and unknowns have the assumed signs.

    Attributes
    ----------
    ring : PolyRing
        A ring over the rationals with the generators of the claim's ring.
    zeros, nonzero : tuple of PolyElement
    positive, nonnegative, negative, whole : frozenset of int
        Indices of the generators that are assumed to be > 0, >= 0, < 0, or integers.
    products : tuple of PolyElement
        Further polynomials that are >= 0: formulas under even roots of the text, and, for a root sqrt(a/b) in it, the
        product of b and the generator ``b*sqrt(a/b)``.
    free : frozenset of int
        Indices of generators that may have every value which these polynomials and signs allow. The other generators
        depend on symbols in a way that polynomials cannot express, as tanh(x) depends on x.
    unconstrained : tuple of PolyElement
        Divisors with a generator that is not free. The random search for points ignores them.
    complete : bool
        False if a hypothesis contains a generator that is not free: then ``zeros`` lacks this hypothesis.
    real : bool
        False if the imaginary unit is a generator of the ring.
    """

    ring: PolyRing
    zeros: tuple[PolyElement, ...]
    nonzero: tuple[PolyElement, ...]
    positive: frozenset[int] = frozenset()
    nonnegative: frozenset[int] = frozenset()
    negative: frozenset[int] = frozenset()
    whole: frozenset[int] = frozenset()
    products: tuple[PolyElement, ...] = ()
    free: frozenset[int] = frozenset()
    unconstrained: tuple[PolyElement, ...] = ()
    complete: bool = True
    real: bool = True

    @cached_property
    def involved(self) -> tuple[int, ...]:
        """Indices of the free generators that occur in a constraint, in ascending order."""
        return tuple(sorted(self.free & occurring([*self.zeros, *self.nonzero, *self.products])))


def distinct_factors(poly: PolyElement) -> list[PolyElement]:
    """Return the different factors of a polynomial that is not constant, each with leading coefficient 1.

    A large polynomial is not factored: only unknowns that divide all its terms are split off, as x from ``x*y + x*z``.
    """
    if len(poly) <= MOST_TERMS and len(occurring([poly])) <= MOST_UNKNOWNS and max(map(sum, poly)) <= LARGEST_DEGREE:
        return [factor.monic() for factor, _ in factor_list(poly)[1]]
    shared = [min(column) for column in zip(*poly, strict=True)]
    unknowns = [poly.ring.gens[place] for place, power in enumerate(shared) if power]
    if unknowns:
        poly = poly.new({tuple(m - s for m, s in zip(mono, shared, strict=True)): c for mono, c in poly.items()})
    return unknowns if poly.is_ground else [*unknowns, poly.monic()]


def constraints_of(ring: FormulaRing) -> Constraints:
    """Return the constraints on the real points at which the formulas in a ring are to hold."""
    target = PolyRing(ring.ring.symbols, QQ, grevlex)
    symbols = {leaf: n for leaf, n in ring.symbols.items() if ring.leaves[leaf]}
    # tanh(x) is not free, nor are the sine and cosine of an angle whose symbols occur elsewhere too
    free = {*symbols.values(), *(place[angle] for angle in free_angles(ring) for place in (ring.sines, ring.cosines))}
    zeros, products = [], []
    for atom, sine in ring.sines.items():
        if sine in free:
            zeros.append(target.gens[sine] ** 2 + target.gens[ring.cosines[atom]] ** 2 - 1)
    signs = {root: radical.below for radical in ring.radicals.values() for root in radical.roots}
    even = set()
    loose = {root for radical in ring.radicals.values() if radical.loose for root in radical.roots}
    for root, place in sorted(ring.roots.items(), key=lambda item: -item[1]):  # inner roots first
        square = ring.ratio(root.power_expression)  # not reduced by the hypotheses, since the result would say less
        relation = ring.ring.gens[place] ** root.index * ring.ratios.denominator(square) - square.numerator
        relation = relation.set_ring(target)
        if occurring([relation]) <= free | {place} and root.expression is not I and root not in loose:
            free.add(place)
            zeros.append(relation)
            below = signs.get(root)
            if below is None or below.is_number:
                even.add(place)
            else:
                products.append(target.gens[place] * ring.ratio(below).numerator.set_ring(target))
    hypotheses = [poly.set_ring(target) for poly in ring.hypothesis_numerators if poly]
    stated = [poly for poly in hypotheses if occurring([poly]) <= free]
    for formula in ring.domain:
        value = ring.ratio(formula)
        signed = (value.numerator * ring.ratios.denominator(value)).set_ring(target)
        if signed and not signed.is_ground and occurring([signed]) <= set(symbols.values()):
            products.append(signed)
    # the divisors that have been read into the ring so far
    factors = [poly.set_ring(target) for poly in ring.ratios.factors]

    def having(assumption: str) -> frozenset[int]:
        return frozenset(n for leaf, n in symbols.items() if getattr(leaf, assumption))

    return Constraints(
        target, (*zeros, *stated), tuple(poly for poly in factors if occurring([poly]) <= free),
        positive=having("is_positive"), nonnegative=having("is_nonnegative") | frozenset(even),
        negative=having("is_negative"), whole=having("is_integer"), products=tuple(products),
        free=frozenset(free), unconstrained=tuple(poly for poly in factors if not occurring([poly]) <= free),
        complete=len(stated) == len(hypotheses),
        real=not any(root.expression is I for root in ring.roots),
    )  # fmt: skip
