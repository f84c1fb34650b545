"""The order conditions of Runge-Kutta methods, checked exactly.

A method has order n if the Taylor series of its step agrees with that of every motion up to h^n. This holds if one
equation of its coefficients, an order condition, holds for each rooted tree with up to n nodes. A defect is the amount
by which the coefficients of a method, rounded to decimals, violate a condition.
"""

from fractions import Fraction
from functools import cache
from itertools import combinations_with_replacement
from math import prod
from typing import Any

from symrot.codegen.steps import Method, RungeKutta, SteadyRotations, TaylorSeries, WithDerivatives
from symrot.errors import CertificateError

__all__ = ["DEFECT", "require_order", "trees"]

DEFECT = Fraction(1, 10**25)
"""The largest accepted defect of an order condition, for a method whose coefficients are rounded decimals."""

Tree = tuple[Any, ...]  # a rooted tree: the subtrees of its root, in order


@cache
def trees(size: int) -> tuple[Tree, ...]:
    """Return all rooted trees with ``size`` nodes; each gives one order condition of a Runge-Kutta method."""
    if size == 1:
        return ((),)
    rooted: set[Tree] = set()
    for count in range(1, size):
        for sizes in combinations_with_replacement(range(1, size), count):
            if sum(sizes) == size - 1:
                groups: list[tuple[Tree, ...]] = [()]
                for each in sizes:
                    groups = [(*group, tree) for group in groups for tree in trees(each)]
                rooted |= {tuple(sorted(group)) for group in groups}
    return tuple(sorted(rooted))


def _size(tree: Tree) -> int:
    return 1 + sum(map(_size, tree))


def _density(tree: Tree) -> int:
    return _size(tree) * prod(map(_density, tree))


def _weight(tree: Tree, method: RungeKutta) -> list[Fraction]:
    """Return the elementary weight of a tree (the left side of its order condition) at each stage of a method."""
    inner = [_weight(subtree, method) for subtree in tree]
    return [
        prod((sum((a * weights[j] for j, a in stage.items()), Fraction(0)) for weights in inner), start=Fraction(1))
        for stage in method.stages
    ]


def require_order(method: Method) -> tuple[Fraction, ...]:
    """Raise CertificateError if a method does not have the order ``method.order``; return defects of order conditions.

    Each rooted tree gives an order condition. Its defect is the amount by which the method's coefficients violate it.
    Entry k is the largest defect for the trees with k + 1 nodes; it is 0 unless the coefficients are rounded decimals.
    For a Taylor method, whose order needs no proof, all entries are 0; for an exact step there are no entries.
    Source: Hairer, Norsett, Wanner, Solving ODEs I, 2nd ed., theorem II.2.13.
    """
    method = method.plain if isinstance(method, WithDerivatives) else method
    if isinstance(method, SteadyRotations):
        return ()
    if isinstance(method, TaylorSeries):
        return (Fraction(0),) * method.order
    most = DEFECT if method.rounded else Fraction(0)
    for node, stage in zip(method.nodes, method.stages, strict=True):
        if abs(sum(stage.values(), Fraction(0)) - node) > most:
            raise CertificateError(
                f"{method.name}: expected each node c_i to be the sum of the coefficients a_ij of its stage, "
                f"{sum(stage.values(), Fraction(0))}, got {node}"
            )
    return tuple(max(_defect(tree, method, most) for tree in trees(size)) for size in range(1, method.order + 1))


def _defect(tree: Tree, method: RungeKutta, most: Fraction) -> Fraction:
    """Return the defect of the order condition of one rooted tree: the amount by which the coefficients violate it.

    CertificateError is raised if the defect is larger than ``most``.
    """
    weights = _weight(tree, method)
    total = sum((b * weights[stage] for stage, b in method.weights.items()), Fraction(0))
    defect = abs(total - Fraction(1, _density(tree)))
    if defect > most:
        got = total if not method.rounded else f"{float(total)!r} (the difference is {float(defect):.1e})"
        raise CertificateError(
            f"{method.name}: expected a method of order {method.order}, got one that violates the order condition "
            f"of a rooted tree with {_size(tree)} node{'s' * (_size(tree) > 1)}: the sum of products of its "
            f"coefficients must be 1/{_density(tree)}, but is {got}"
        )
    return defect
