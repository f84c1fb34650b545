"""Sums of formulas with few negations: a minus sign is moved into a number or a difference, where it costs nothing.

The number or difference may be a factor of a product: ``-((a - b)*c)`` becomes ``(b - a)*c``.
"""

from collections.abc import Sequence

from symrot.formula.tree import Node

__all__ = ["negative", "summed"]


def negative(node: Node) -> Node:
    """Return ``-node``, if possible without an operation for the sign: ``(a - b)*c`` gives ``(b - a)*c``."""
    if node[0] == "number":
        return ("number", -node[1])
    if node[0] == "neg":
        return tuple(node[1])
    if node[0] in "+-":
        terms = _terms(node)
        first = next((i for i, (sign, _) in enumerate(terms) if sign < 0), None)
        if first is not None:
            rest = [*terms[:first], *terms[first + 1 :]]
            return summed(terms[first][1], [(-sign, term) for sign, term in rest])
    if node[0] in "*/":
        for place in (1, 2) if node[0] == "*" else (1,):
            turned = negative(node[place]) if node[place][0] in ("number", "*", "/", "+", "-") else ("neg",)
            if turned[0] != "neg":
                return (node[0], turned, node[2]) if place == 1 else (node[0], node[1], turned)
    return ("neg", node)


def _turned(sign: int, node: Node) -> tuple[int, Node]:
    """Return a term (sign, node) with sign 1 where this costs no operation, otherwise unchanged.

    ``(-1, (a - b)*c)`` gives ``(1, (b - a)*c)``.
    """
    # without a difference among the factors, a change of sign would cost an operation
    turned = _with_difference_turned(node) if sign < 0 else None
    return (sign, node) if turned is None else (1, turned)


def _with_difference_turned(node: Node) -> Node | None:
    """Return ``-node`` with one difference reversed: ``(a - b)*c`` gives ``(b - a)*c``.

    None if ``node`` is no difference and has no difference as a factor.
    """
    if node[0] == "-":
        return negative(node)
    if node[0] != "*":
        return None
    for place, other in ((1, 2), (2, 1)):
        if node[place][0] in "*-" and (turned := _with_difference_turned(node[place])) is not None:
            return ("*", turned, node[other]) if place == 1 else ("*", node[other], turned)
    return None


def _terms(node: Node) -> list[tuple[int, Node]]:
    """Return the terms of a sum as pairs (sign, term): [(1, a), (-1, b), (1, c)] for (a - b) + c."""
    if node[0] not in "+-":
        return [(1, node)]
    return [*_terms(node[1]), (1 if node[0] == "+" else -1, node[2])]


def summed(first: Node, terms: Sequence[tuple[int, Node]]) -> Node:
    """Return the tree of ``first`` plus the ``terms``, which are pairs (sign, term); positive terms are added first."""
    for sign, term in sorted((_turned(*each) for each in terms), key=lambda item: item[0] < 0):
        first = ("+" if sign > 0 else "-", first, term)
    return first
