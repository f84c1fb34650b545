"""Formulas with quaternions and Pauli's matrices as people write them: ``q p`` for qmul(q, p), 1 for eye(4).

A claim with quaternions is decided with columns of four numbers, so that ``|q|²`` is the column (|q|², 0, 0, 0).
"""

from collections.abc import Sequence
from dataclasses import replace

from symrot.checker.arrays.pauli import eye
from symrot.checker.claim.tree import Node, number, product, walk

__all__ = ["as_written", "has_arrays", "is_odd"]

QUATERNION, UNIT = ("qmul", "conjugate"), eye()


def has_arrays(sides: Sequence[Node]) -> bool:
    """Return whether formulas call a function for quaternions or contain ``eye(4)``, which :func:`as_written` replaces.

    ``eye(4)`` is the number 1 in equations with Pauli's matrices, which are computed as real 4 x 4 matrices.
    """
    nodes = [node for side in sides for _, node in walk(side)]
    return UNIT in nodes or any(node.kind == "call" and node.value in QUATERNION for node in nodes)


def is_odd(sides: Sequence[Node]) -> bool:
    """Return whether the sides of a repair contain ``i^T``: nobody transposes i, so such a repair is not offered."""
    return Node("transpose", None, (Node("name", "i"),)) in [node for side in sides for _, node in walk(side)]


def as_written(tree: Node) -> Node:
    """Return a formula as people write it: with plain products, lengths and numbers in place of calls such as ``qmul``.

    Examples
    --------
    >>> from symrot.checker.claim.reader import read_expression
    >>> from symrot.checker.claim.tree import text
    >>> text(as_written(read_expression("qmul(q, conjugate(q)) - dot(q, q)*Matrix([1, 0, 0, 0])")))
    'q*conjugate(q) - abs(q)**2'
    """
    if (scalar := _scalar(tree)) is not None:
        return as_written(scalar)
    args = tuple(map(as_written, tree.args))
    tree = replace(tree, args=args)
    if tree.kind == "call" and tree.value == "qmul":
        return product([part for factor in args for part in (factor.args if factor.kind == "product" else (factor,))])
    if tree.kind == "call" and tree.value == "dot" and args[0] == args[1]:
        return Node("power", None, (Node("call", "abs", (args[0],)), number(2)))
    if tree.kind == "call" and tree.value == "sqrt" and args[0].kind == "power" and args[0].args[1] == number(2):
        return args[0].args[0]
    if tree.kind == "product":
        rest = [factor for factor in args if factor not in (UNIT, number(1))]
        return product(rest) if rest else number(1)
    return number(1) if tree == UNIT else tree


def _scalar(tree: Node) -> Node | None:
    """Return s if ``tree`` is a column (s, 0, 0, 0), which is the number s as a quaternion; None otherwise."""
    inside = tree.args[0] if tree.kind == "call" and tree.value == "Matrix" else tree
    if inside.kind != "list" or len(inside.args) != 4 or any(part != number(0) for part in inside.args[1:]):
        return None
    return inside.args[0]
