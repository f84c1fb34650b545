"""Inverse functions and logarithms that are proven equal are one: so what holds of them does, wherever they stand.

``sqrt(asin(x))`` and ``sqrt(atan2(x, sqrt(1 - x^2)))`` hold two symbols, about whose values more is known than that
each is a symbol. A pair with ``f - g = 0``, or ``f + g = pi/2``, is put into the formula, and it is read again.
"""

from collections.abc import Sequence
from itertools import combinations

from sympy import Expr, log, pi

from symrot.exact.angles.inverse import INVERSE
from symrot.exact.inverse_sums import proof
from symrot.exact.ring.ring import FormulaRing

__all__ = ["proof_by_congruence"]

_NAMES = (*INVERSE, log)

MOST_SYMBOLS = 6
"""Inverse functions and logarithms that are still compared with each other."""


def proof_by_congruence(
    left: Expr, right: Expr, hypotheses: Sequence[Expr], domain: Sequence[Expr]
) -> tuple[FormulaRing, ...] | None:
    """Return the rings by which ``left = right`` is proven, inverse functions compared first; None without a proof."""
    rings: list[FormulaRing] = []
    while True:
        ring = FormulaRing([left, right], hypotheses, domain)
        found = proof(ring, ring.difference(left, right).numerator)
        if found is not None:
            return (*rings, ring, *found)
        names: list[Expr] = [leaf for leaf in ring.symbols if type(leaf) in _NAMES and leaf.free_symbols]
        replaced = _replaced(names, hypotheses, domain) if len(names) <= MOST_SYMBOLS else None
        if replaced is None:
            return None
        old, new, further = replaced
        rings += further
        left, right = left.xreplace({old: new}), right.xreplace({old: new})


def _replaced(
    names: Sequence[Expr], hypotheses: Sequence[Expr], domain: Sequence[Expr]
) -> tuple[Expr, Expr, tuple[FormulaRing, ...]] | None:
    """Return a symbol, what it is in terms of another, and the rings that prove it."""
    for first, second in combinations(names, 2):
        for other in (first, pi / 2 - first):
            ring = FormulaRing([second, other], hypotheses, domain)
            found = proof(ring, ring.difference(second, other).numerator)
            if found is not None:
                return second, other, (ring, *found)
    return None
