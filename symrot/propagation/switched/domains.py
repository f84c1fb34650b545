"""Where arguments of switching functions have no value: the argument of ``sign(asin(u))`` has no value for u > 1."""

from collections.abc import Mapping

import numpy as np

from symrot.formula.switches import CHANGING
from symrot.formula.tree import Node, children, evaluate, names
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.steppers.stepping import Floats

__all__ = ["excess", "may_lose_value"]

ANGLES = ("asin", "acos")
PARTIAL = (*ANGLES, "sqrt", "log")


def may_lose_value(node: Node) -> bool:
    """Return whether a formula calls sqrt, log, asin or acos of something that changes along a motion."""
    own = node[0] == "call" and node[1] in PARTIAL and bool(names(node) & CHANGING)
    return own or any(map(may_lose_value, children(node)))


def excess(node: Node, values: Mapping[str, Floats], sizes: Mapping[str, Floats]) -> Floats:
    """Return how far arguments of sqrt, log, asin and acos in a formula lie outside their domains, 0 or less if inside.

    ``values`` has the values of the symbols at n times. ``sizes`` has the sizes with which errors of these values are
    compared, such as 1 for q0. The distance is relative to the size of the argument, the sum of the sizes of its terms.
    Rounding and the tolerance of a motion may cause a small excess: q0 may be 1 + 1e-12.
    """
    inner = [excess(child, values, sizes) for child in children(node) if may_lose_value(child)]
    if node[0] == "call" and node[1] in PARTIAL and names(node) & CHANGING:
        value = np.asarray(evaluate(node[2][0], values, ARRAY_FUNCTIONS, float))
        size = _size(node[2][0], values, sizes)
        own = (np.abs(value) - 1.0) / np.fmax(size, 1.0) if node[1] in ANGLES else -value / np.fmax(size, 1e-300)
        inner.append(own)
    worst: Floats = np.fmax.reduce(inner)  # fmax ignores NaN, the value of a function whose own argument is outside
    return worst


def _size(node: Node, values: Mapping[str, Floats], sizes: Mapping[str, Floats]) -> Floats:
    """Return the size of a formula without cancellation: |a| + |b| for a - b.

    ``values`` and ``sizes`` are those of the symbols, as for :func:`excess`. A symbol in ``sizes`` has this size, other
    terms have their absolute values as sizes.
    """
    if node[0] == "symbol" and node[1] in sizes:
        return sizes[node[1]]
    if node[0] in ("+", "-", "neg"):
        return np.asarray(sum(_size(child, values, sizes) for child in children(node)))
    size: Floats = np.abs(np.asarray(evaluate(node, values, ARRAY_FUNCTIONS, float)))
    return size
