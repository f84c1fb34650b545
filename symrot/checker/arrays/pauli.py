"""Pauli's matrices: sigma_x, sigma_y, sigma_z or sigma_1, sigma_2, sigma_3 in a formula with the imaginary unit.

A complex number a + i b is the real 2 x 2 matrix [[a, -b], [b, a]]. So i and Pauli's matrices become real 4 x 4
matrices, with which the engine computes exactly.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace

from symrot.checker.claim.shapes import shape_of
from symrot.checker.claim.tree import Node, number, walk
from symrot.errors import InputError

__all__ = ["with_pauli_matrices"]

Relation = tuple[str, Node, Node]
Complex = tuple[tuple[complex, complex], tuple[complex, complex]]

UNIT: Complex = ((1, 0), (0, 1))
PAULI: dict[str, Complex] = {"x": ((0, 1), (1, 0)), "y": ((0, -1j), (1j, 0)), "z": ((1, 0), (0, -1))}
NAMES = {f"sigma_{ending}": PAULI[axis] for axis, number_of in zip("xyz", "123", strict=True)
         for ending in (axis, number_of)}  # fmt: skip
IMAGINARY = "i"
SIZE = 4
PARTS = ("name", "number", "sum", "product", "neg", "power", "inv")
"""The kinds of formulas in which letters may be matrices; sines and cosines are scalars."""


def with_pauli_matrices(relation: Relation, known: Collection[str]) -> tuple[Relation, tuple[tuple[str, Node], ...]]:
    """Return an equation of Pauli's matrices in which each scalar multiplies the unit matrix, and the definitions.

    An equation without two of these matrices, or without i, is returned unchanged with no definitions: sigma_x is
    then a number, such as a stress.

    Raises
    ------
    InputError
        For a matrix that is both inside and outside of an exponent.
    """
    sign, left, right = relation
    nodes = [node for side in (left, right) for _, node in walk(side)]
    used = {str(node.value) for node in nodes if node.kind == "name"}
    matrices = sorted(used & {*NAMES})
    if (name := _in_exponent(nodes, matrices)) and IMAGINARY in used:
        raise InputError(f"expected {name} outside of exponents (write e^(i a {name}) as cos(a) + i {name} sin(a))")
    names_another = any(side.kind == "name" and side.value not in (*matrices, IMAGINARY) for side in (left, right))
    is_plain = all(node.kind in PARTS or (node.kind == "call" and node.value in ("sin", "cos")) for node in nodes)
    if names_another or not is_plain or IMAGINARY not in used or len(matrices) < 2 or {*known} & {*matrices, IMAGINARY}:
        return relation, ()
    define = tuple((name, _real(NAMES[name])) for name in matrices)
    define = (*define, (IMAGINARY, _real(((1j, 0), (0, 1j)))))
    shapes = dict.fromkeys([name for name, _ in define], (SIZE, SIZE))
    return (sign, _as_matrix(left, shapes), _as_matrix(right, shapes)), define


def _real(matrix: Complex) -> Node:
    """Return the tree of the real matrix that represents a complex matrix."""
    rows = []
    for row in matrix:
        parts = [(complex(entry).real, complex(entry).imag) for entry in row]
        rows.append([int(part) for real, imaginary in parts for part in (real, -imaginary)])
        rows.append([int(part) for real, imaginary in parts for part in (imaginary, real)])
    return Node("call", "Matrix", (_list([_list(list(map(number, row))) for row in rows]),))


def _list(members: Sequence[Node]) -> Node:
    return Node("list", ("[", "]"), tuple(members))


def _in_exponent(nodes: Sequence[Node], matrices: Collection[str]) -> str:
    """Return the first matrix name that occurs both inside and outside of exponents; an empty text without one."""
    exponents = [
        node.args[-1] for node in nodes if node.kind == "power" or (node.kind == "call" and node.value == "exp")
    ]
    names = [str(node.value) for node in nodes if node.kind == "name"]
    inside = [str(part.value) for tree in exponents for _, part in walk(tree) if part.kind == "name"]
    return next((name for name in matrices if name in inside and names.count(name) > inside.count(name)), "")


def _as_matrix(side: Node, shapes: dict[str, tuple[int, int]]) -> Node:
    """Return a side as a matrix: a scalar side s becomes s times the unit matrix."""
    side = _with_units(side, shapes)
    return side if shape_of(side, shapes) is not None else _times_unit(side)


def _with_units(tree: Node, shapes: dict[str, tuple[int, int]]) -> Node:
    """Return a tree in which a scalar term s that is added to a matrix becomes s times the unit matrix."""
    args = [_with_units(part, shapes) for part in tree.args]
    if tree.kind == "sum" and any(shape_of(term, shapes) is not None for term in args):
        args = [term if shape_of(term, shapes) is not None else _times_unit(term) for term in args]
    return replace(tree, args=tuple(args))


def _times_unit(tree: Node) -> Node:
    return Node("product", None, (tree, Node("call", "eye", (number(SIZE),))), tree.span)
