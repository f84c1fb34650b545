"""Congruence closure: among inverse functions or logarithms that are proven equal, one replaces the others.

``asin(x)`` and ``atan2(x, sqrt(1 - x^2))`` are equal, but the polynomial ring has an independent variable for each. The
functions return the polynomial rings in which they have computed a proof: what is proven holds wherever no divisor in
these rings is zero. Of their arguments, ``hypotheses`` are expressions that are zero, and ``domain`` are formulas that
are nonnegative wherever both sides of the equation are defined.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations

from sympy import Expr, log, pi

from symrot.exact.angles.inverse import INVERSE
from symrot.exact.floats import seems_zero
from symrot.exact.inverse_sums import proof
from symrot.exact.ring.ring import FormulaRing

__all__ = ["proof_by_congruence"]

_NAMES = (*INVERSE, log)

MOST_SYMBOLS = 6
"""Largest number of inverse functions and logarithms that are compared with each other."""


def proof_by_congruence(
    left: Expr, right: Expr, hypotheses: Sequence[Expr], domain: Sequence[Expr]
) -> tuple[FormulaRing, ...] | None:
    """Prove ``left = right`` by replacing inverse functions and logarithms with equal ones.

    Return the polynomial rings that the proof uses, or None if no proof is found. ``hypotheses`` are expressions that
    are zero, and ``domain`` are formulas that are nonnegative wherever both sides are defined.
    """
    rings: list[FormulaRing] = []
    while True:
        ring = FormulaRing([left, right], hypotheses, domain)
        further_rings = proof(ring, ring.difference(left, right).numerator)
        if further_rings is not None:
            return (*rings, ring, *further_rings)
        names: list[Expr] = [leaf for leaf in ring.symbols if type(leaf) in _NAMES and leaf.free_symbols]
        for old, new, further in _equal_pairs(names, hypotheses, domain) if len(names) <= MOST_SYMBOLS else ():
            replaced = left.xreplace({old: new}), right.xreplace({old: new})
            if replaced != (left, right):  # the ring may contain functions that the sides do not
                left, right = replaced
                domain = [formula.xreplace({old: new}) for formula in domain]
                rings += further
                break
        else:
            return None


def _equal_pairs(
    names: Sequence[Expr], hypotheses: Sequence[Expr], domain: Sequence[Expr]
) -> Iterator[tuple[Expr, Expr, tuple[FormulaRing, ...]]]:
    """Yield (f, h, rings) for expressions f and h that are proven equal and may replace each other.

    ``names`` are inverse functions and logarithms. f is one of them; h is another one, g, or the expression
    ``pi/2 - g``. ``rings`` are all polynomial rings that the proof of ``f = h`` uses. ``hypotheses`` are expressions
    that are zero, and ``domain`` are formulas that are nonnegative, wherever f and h are compared.
    """
    for first, second in combinations(names, 2):
        for other in (first, pi / 2 - first):
            if not hypotheses and not seems_zero(second - other, domain):
                continue
            ring = FormulaRing([second, other], hypotheses, domain)
            further_rings = proof(ring, ring.difference(second, other).numerator)
            if further_rings is not None:
                yield second, other, (ring, *further_rings)
