"""Formulas with quaternions and Pauli's matrices as people write them: ``q p`` for qmul(q, p), 1 for eye(4)."""

from collections.abc import Sequence
from dataclasses import replace

from symrot.checker.arrays.pauli import eye
from symrot.checker.claim.tree import Node, negated, nodes_of, number, product

__all__ = ["as_written", "has_arrays", "inverse_of", "is_odd", "with_inverses"]

# a claim with quaternions is decided with columns of four numbers: ``|q|²`` is the column (|q|², 0, 0, 0)
QUATERNION, UNIT = ("qmul", "conjugate"), eye()
IMAGINARY = Node("name", "i")


def has_arrays(sides: Sequence[Node]) -> bool:
    """Return whether formulas call a function for quaternions, such as ``qmul``, or contain ``eye(4)``."""
    # Pauli's matrices are computed as real 4 x 4 matrices
    nodes = nodes_of(*sides)
    return UNIT in nodes or any(node.kind == "call" and node.value in QUATERNION for node in nodes)


def is_odd(sides: Sequence[Node]) -> bool:
    """Return whether the two sides of a repair contain a term that no author writes, such as ``i^T``."""
    nodes = [node for side in sides for node in nodes_of(as_written(side))]
    # the trace of a complex M is stored as two terms; an edit of one term alone leaves a ``trace(-i M)`` that cannot be
    # written as ``trace(M)`` again
    return Node("transpose", None, (IMAGINARY,)) in nodes or any(map(_is_imaginary_trace, nodes))


def _is_imaginary_trace(node: Node) -> bool:
    """Return whether a formula is ``trace(-i M)``, which stands for the imaginary part of ``trace(M)``."""
    inside = node.args[0].args[0] if node.value == "trace" and node.args[0].kind == "neg" else node
    return inside is not node and inside.kind == "product" and inside.args[0] == IMAGINARY


def _trace(terms: Sequence[Node]) -> Node | None:
    """Return ``trace(M)`` for the terms ``trace(M)/2`` and ``i*trace(-i M)/2``; None for other terms.

    symrot itself writes the trace of a complex 2 x 2 matrix as the sum of these terms, where M is the real 4 x 4 matrix
    that it uses in place of the complex one. This function returns what the author wrote.
    """
    traces = [[factor for factor in term.args if factor.value == "trace"] for term in terms if term.kind == "product"]
    if len(terms) != 2 or [len(own) for own in traces] != [1, 1] or not _is_imaginary_trace(traces[1][0]):
        return None
    (real,), (imaginary,) = traces
    half = Node("inv", None, (number(2),))
    parts = product([half, real]), product([half, imaginary, IMAGINARY])
    inside = product(list(imaginary.args[0].args[0].args[1:]))
    return real if tuple(terms) == parts and inside == real.args[0] else None


def _determinant(factors: Sequence[Node]) -> Node | None:
    """Return ``det(M)`` for the factors 1/2 and ``trace(M) trace(M) - trace(M M)``; None for other factors.

    symrot itself writes the determinant of a complex 2 x 2 matrix as this product. This function returns what the
    author wrote.
    """
    if len(factors) != 2 or factors[0] != Node("inv", None, (number(2),)) or factors[1].kind != "sum":
        return None
    square, *rest = factors[1].args
    matrix = square.args[0].args[0] if square.kind == "product" and square.args[0].value == "trace" else None
    if matrix is None or tuple(square.args) != (square.args[0],) * 2:
        return None
    of_square = Node("neg", None, (Node("call", "trace", (product([matrix, matrix]),)),))
    return Node("call", "det", (matrix,)) if rest == [of_square] else None


def inverse_of(side: Node, source: str) -> Node | None:
    """Return q for a side ``conjugate(q)/dot(q, q)`` if the text ``source`` contains a power such as ``q^-1``.

    Return None for any other side or text.
    """
    if not any(mark in source for mark in INVERSES) or side.kind != "product" or len(side.args) != 2:
        return None
    # ``q^{-1}`` is read as conjugate(q)/dot(q, q)
    above, below = side.args
    is_conjugate = above.kind == "call" and above.value == "conjugate" and below.kind == "inv"
    return above.args[0] if is_conjugate and below.args[0] == Node("call", "dot", above.args * 2) else None


def with_inverses(sides: Sequence[Node], source: str) -> list[Node]:
    """Return the sides, with ``q**(-1)`` for a side that is conjugate(q)/dot(q, q) if ``source`` writes a power."""
    inner = [inverse_of(side, source) for side in sides]
    minus = negated(number(1))
    return [side if q is None else Node("power", None, (q, minus)) for side, q in zip(sides, inner, strict=True)]


INVERSES = ("^{-1}", "⁻¹", "^-1", "^(-1)", "**-1", "**(-1)")
"""The ways to write the power minus one."""


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
        return _determinant(rest) or (product(rest) if rest else number(1))
    if tree.kind == "sum" and (trace := _trace(args)) is not None:
        return trace
    return number(1) if tree == UNIT else tree


def _scalar(tree: Node) -> Node | None:
    """Return s if ``tree`` is a column (s, 0, 0, 0), which is the number s as a quaternion; None otherwise."""
    inside = tree.args[0] if tree.kind == "call" and tree.value == "Matrix" else tree
    if inside.kind != "list" or len(inside.args) != 4 or any(part != number(0) for part in inside.args[1:]):
        return None
    return inside.args[0]
