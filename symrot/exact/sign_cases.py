"""Proofs by cases of signs: ``|k| |m| = k m`` where the root ``sqrt(k m)`` is real.

Each absolute value ``|f|`` is ``f`` or ``-f``. A radicand that is a product of such f excludes half of the choices of
signs. A numerator that is zero for all choices that remain is zero everywhere.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import product
from math import prod

from sympy import Abs
from sympy.polys.rings import PolyElement

from symrot.exact.factors import factor_list
from symrot.exact.ring.polynomials import occurring
from symrot.exact.ring.ring import FormulaRing

__all__ = ["vanishes_for_all_signs"]

MOST_SIGNS = 4
"""Largest number of absolute values in a numerator, so that at most 16 choices of signs are tried."""

MOST_TERMS = 60
"""Largest number of terms of a radicand that is factored."""

Constraint = tuple[int, frozenset[int]]
"""A pair (sign, indices of variables): each variable stands for an ``|f|``; the product of the signs of f is ``sign``.

If sqrt(k m) is real, the pair (1, {variable of ``|k|``, variable of ``|m|``}) says that k and m have equal signs."""


def vanishes_for_all_signs(ring: FormulaRing, numerator: PolyElement) -> bool:
    """Return whether a numerator is proven zero for all signs that expressions inside absolute values can have."""
    # Sound, because at every point some signs s with |f| = s f satisfy the constraints: the sign of f where f is not
    # zero, and where f is zero the sign that makes the constraint true.
    insides = _insides(ring, numerator)
    if not 1 <= len(insides) <= MOST_SIGNS:
        return False
    constraints = _consistent(ring, insides, list(_constraints(ring, insides)))
    for choice in product((1, -1), repeat=len(insides)):
        signs = dict(zip(insides, choice, strict=True))
        if any(prod(signs[place] for place in places) != sign for sign, places in constraints):
            continue
        pairs = [(ring.ring.gens[place], signs[place] * inside) for place, inside in insides.items()]
        if ring.reduce(numerator.compose(pairs)):
            return False
    return bool(constraints)


def _insides(ring: FormulaRing, numerator: PolyElement) -> dict[int, PolyElement]:
    """Return the absolute values ``|f|`` in a numerator: a map from the index of their variable to the polynomial f."""
    used = occurring([numerator])
    absolute = {place: root for root, place in ring.roots.items() if isinstance(root.expression, Abs)}
    insides = {}
    for place in sorted(used & absolute.keys()):
        with suppress(KeyError):  # f may contain a function that its square, which the ring has read, does not
            ratio = ring.ratio(absolute[place].expression.args[0])
            if not ratio.factors and ratio.constant == 1:
                insides[place] = ratio.numerator
    return insides


def _constraints(ring: FormulaRing, insides: dict[int, PolyElement]) -> Iterator[Constraint]:
    """Yield constraints on the signs of f in ``|f|``, which hold because no radicand is negative.

    ``insides`` maps the variable of each ``|f|`` to f.
    """
    radicands = [
        ring._polynomial(root) for root in ring.roots if root.index == 2 and not isinstance(root.expression, Abs)
    ]
    for formula in ring.domain:
        ratio = ring.ratio(formula)
        divisors = [ring.ratios.factors[number] for number, power in ratio.factors if power % 2]
        radicands.append(prod(divisors, start=ring.reduce(ratio.numerator)))
    # no radicand is negative: sqrt(k m) gives (1, {variable of |k|, variable of |m|})
    for poly in radicands:
        if poly.is_ground or len(poly) > MOST_TERMS:
            continue
        constant, factors = factor_list(poly)
        sign, places = (1 if constant > 0 else -1), set()
        for factor, power in factors:
            place = next((n for n, inside in insides.items() if inside in (factor, -factor)), None)
            if place is None or power % 2 == 0:
                break
            sign *= 1 if insides[place] == factor else -1
            places.add(place)
        else:
            yield sign, frozenset(places)


def _consistent(
    ring: FormulaRing, insides: dict[int, PolyElement], constraints: Sequence[Constraint]
) -> list[Constraint]:
    """Return a subset of ``constraints`` on the signs of f in ``|f|`` that can be satisfied together at every point.

    ``insides`` maps the variable of each ``|f|`` to f. At a point where f is zero, ``|f| = s f`` holds for both signs
    s. The sign can then be chosen so that one constraint on it is satisfied, but perhaps not two. So a constraint is
    left out if it shares an f that may be zero with a constraint that was chosen before.
    """
    # formulas are defined only where a divisor is not zero
    divisors = {factor for poly in ring.ratios.factors for factor, _ in factor_list(poly)[1]}
    nonzero = {place for place, inside in insides.items() if inside in divisors or -inside in divisors}
    accepted: dict[frozenset[int], Constraint] = {}
    for sign, places in constraints:
        if all(places & others <= nonzero for others in accepted):
            accepted.setdefault(places, (sign, places))
    return list(accepted.values())
