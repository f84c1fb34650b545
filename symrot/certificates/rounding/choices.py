"""Choices between branches on boxes: which are possible, and what a branch tells of the numbers compared.

A choice compares computed numbers, so what it tells is of these alone: of two of them the larger is at least what
the smaller is at least. And the larger of RN(p + q) and RN(p - q) is at least p, because one of q and -q is not
negative and rounding keeps order.
"""

from collections.abc import Callable, Sequence
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.readback.operations import Node
from symrot.certificates.rounding.intervals import Array, negative
from symrot.certificates.rounding.output_graph import Cone

__all__ = ["decide", "narrow"]

_POSSIBLE: dict[str, Callable[[Array, Array], Any]] = {  # whether a relation may hold, and whether it may fail
    "<": lambda a, b: (a[0] < b[1], a[1] >= b[0]),
    "<=": lambda a, b: (a[0] <= b[1], a[1] > b[0]),
    ">": lambda a, b: (a[1] > b[0], a[0] <= b[1]),
    ">=": lambda a, b: (a[1] >= b[0], a[0] < b[1]),
    "==": lambda a, b: ((a[0] <= b[1]) & (a[1] >= b[0]), (a[0] != a[1]) | (b[0] != b[1]) | (a[0] != b[0])),
    "!=": lambda a, b: ((a[0] != a[1]) | (b[0] != b[1]) | (a[0] != b[0]), (a[0] <= b[1]) & (a[1] >= b[0])),
}
_NOT_LESS = {  # the decision with which the left side is at least the right one, and that with which it is at most
    "<": (0, 1), "<=": (0, 1), ">": (1, 0), ">=": (1, 0), "==": (1, 1), "!=": (0, 0),
}  # fmt: skip


def decide(
    relation: str, a: Array, b: Array, decision: NDArray[np.int8]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Take the branch that is the only possible one, in place.

    Returns which boxes lie outside of the branch that they were given, and of which both branches are open.
    """
    holds, fails = _POSSIBLE[relation](a, b)
    outside = ((decision == 1) & ~holds) | ((decision == 0) & ~fails)
    open_ = decision < 0
    decision[open_ & holds & ~fails] = 1
    decision[open_ & fails & ~holds] = 0
    return outside, open_ & holds & fails


def narrow(cone: Cone, number: int, decision: NDArray[np.int8], computed: list[Array]) -> None:
    """Narrow enclosures of computed numbers to the branch of a condition that is taken, in place."""
    relation, i, j = cone.conditions[number]
    larger, smaller = _NOT_LESS[relation]
    _order(cone.nodes, i, j, decision == larger, computed)
    _order(cone.nodes, j, i, decision == smaller, computed)


def _order(nodes: Sequence[Node], i: int, j: int, here: NDArray[np.bool_], computed: list[Array]) -> None:
    """Narrow what is known of two numbers where the first is at least the second."""
    least, most = computed[j][0], computed[i][1]
    middle = _middle(nodes[i], nodes[j])
    if middle is not None:
        least, most = np.maximum(least, computed[middle][0]), np.minimum(most, computed[middle][1])
    _limit(nodes, i, 0, np.where(here, least, -inf), computed)
    _limit(nodes, j, 1, np.where(here, most, inf), computed)


def _limit(nodes: Sequence[Node], k: int, row: int, end: Array, computed: list[Array]) -> None:
    """Narrow what is known of a number from below (row 0) or above (row 1)."""
    kind = nodes[k][0]
    if kind in ("mul", "square"):  # where it is fused, a sum takes the product as it is
        return
    if kind == "neg":
        _limit(nodes, nodes[k][1], 1 - row, -end, computed)
        computed[k] = negative(computed[nodes[k][1]])
        return
    found = computed[k].copy()
    found[row] = np.minimum(found[row], end) if row else np.maximum(found[row], end)
    computed[k] = np.where(found[0] <= found[1], found, computed[k])


def _middle(one: Node, other: Node) -> int | None:
    """Return p where the nodes are p + q and p - q."""
    if (one[0], other[0]) == ("sub", "add"):
        one, other = other, one
    if (one[0], other[0]) != ("add", "sub") or set(one[1:]) != set(other[1:]):
        return None
    return int(other[1])
