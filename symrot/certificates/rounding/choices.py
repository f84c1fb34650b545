"""Conditionals on boxes of inputs: which branches are possible, and the ranges of the compared numbers in each branch.

A conditional compares computed numbers, so only ranges of computed numbers may be narrowed. If a >= b in a branch, the
range of a starts no lower than the range of b.
"""

from collections.abc import Callable, Sequence
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.readback.operations import Node
from symrot.certificates.rounding.intervals import Array, negative
from symrot.certificates.rounding.output_graph import OutputGraph

__all__ = ["decide_branches", "narrow_to_branch"]

_POSSIBLE: dict[str, Callable[[Array, Array], Any]] = {  # relation -> whether it may hold, whether it may fail
    "<": lambda a, b: (a[0] < b[1], a[1] >= b[0]),
    "<=": lambda a, b: (a[0] <= b[1], a[1] > b[0]),
    ">": lambda a, b: (a[1] > b[0], a[0] <= b[1]),
    ">=": lambda a, b: (a[1] >= b[0], a[0] < b[1]),
    "==": lambda a, b: ((a[0] <= b[1]) & (a[1] >= b[0]), (a[0] != a[1]) | (b[0] != b[1]) | (a[0] != b[0])),
    "!=": lambda a, b: ((a[0] != a[1]) | (b[0] != b[1]) | (a[0] != b[0]), (a[0] <= b[1]) & (a[1] >= b[0])),
}
_NOT_LESS = {  # relation -> the branch in which left >= right, the branch in which left <= right
    "<": (0, 1), "<=": (0, 1), ">": (1, 0), ">=": (1, 0), "==": (1, 1), "!=": (0, 0),
}  # fmt: skip


def decide_branches(
    relation: str, a: Array, b: Array, decision: NDArray[np.int8]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Set ``decision`` to 1 on boxes where ``a relation b`` holds everywhere, and to 0 where it holds nowhere.

    An earlier decision, 0 or 1, is not changed. Return two Boolean arrays: the boxes on which the earlier decision is
    impossible, and the undecided boxes on which both branches remain possible.
    """
    # ``decision``: 1 if the condition is assumed to hold on a box, 0 if not to hold, -1 if nothing is assumed
    holds, fails = _POSSIBLE[relation](a, b)
    outside = ((decision == 1) & ~holds) | ((decision == 0) & ~fails)
    open_ = decision < 0
    decision[open_ & holds & ~fails] = 1
    decision[open_ & fails & ~holds] = 0
    return outside, open_ & holds & fails


def narrow_to_branch(graph: OutputGraph, number: int, decision: NDArray[np.int8], computed: list[Array]) -> None:
    """Shrink the ranges of the two values that condition ``number`` compares, on boxes where its branch is decided.

    The ranges shrink to the values that lead to this branch. ``decision`` has an entry for each box: 1 if the condition
    holds on the box, 0 if it does not hold, -1 if neither is decided. ``computed`` has an interval for each node and
    box, which contains the computed values of the node; its entries are replaced.
    """
    relation, i, j = graph.conditions[number]
    larger, smaller = _NOT_LESS[relation]
    # if x < y holds, the range of x is cut at the largest y, and that of y at the smallest x
    _narrow_ordered(graph.nodes, i, j, decision == larger, computed)
    _narrow_ordered(graph.nodes, j, i, decision == smaller, computed)


def _narrow_ordered(nodes: Sequence[Node], i: int, j: int, here: NDArray[np.bool_], computed: list[Array]) -> None:
    """Shrink the ranges of nodes ``i`` and ``j`` on the boxes ``here``, on which node i is at least node j."""
    least, most = computed[j][0], computed[i][1]
    middle = _middle(nodes[i], nodes[j])
    if middle is not None:
        least, most = np.maximum(least, computed[middle][0]), np.minimum(most, computed[middle][1])
    _narrow_end(nodes, i, 0, np.where(here, least, -inf), computed)
    _narrow_end(nodes, j, 1, np.where(here, most, inf), computed)


def _narrow_end(nodes: Sequence[Node], k: int, row: int, end: Array, computed: list[Array]) -> None:
    """Raise the lower end (``row`` 0) or reduce the upper end (``row`` 1) of the range of node ``k`` to ``end``.

    A range that would become empty, or the range of a product, is not changed.
    """
    kind = nodes[k][0]
    if kind in ("mul", "square"):  # a fused sum uses the unrounded product, for which the comparison says nothing
        return
    if kind == "neg":
        _narrow_end(nodes, nodes[k][1], 1 - row, -end, computed)
        computed[k] = negative(computed[nodes[k][1]])
        return
    ends = computed[k].copy()
    ends[row] = np.minimum(ends[row], end) if row else np.maximum(ends[row], end)
    computed[k] = np.where(ends[0] <= ends[1], ends, computed[k])


# The larger of RN(p + q) and RN(p - q), where RN rounds to nearest, is at least p, and the smaller at most p, because q
# or -q is not negative and rounding keeps order.
def _middle(one: Node, other: Node) -> int | None:
    """Return the index of the node p if one node is p + q and the other p - q; otherwise None."""
    if (one[0], other[0]) == ("sub", "add"):
        one, other = other, one
    if (one[0], other[0]) != ("add", "sub") or set(one[1:]) != set(other[1:]):
        return None
    return int(other[1])
