"""The shapes (rows, columns) of a claim's formulas, and the unit matrices that a text writes as I or 1.

In ``R R^T = I``, I is the unit matrix; in ``L = I omega`` it is a moment of inertia. The shapes tell which: a scalar
can neither be added to a matrix nor be equal to one.
"""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, factors_of, nodes_of, number

__all__ = ["Shape", "added_names", "multiplied_names", "operand_names", "shape_of", "with_unit_matrices"]

Shape = tuple[int, int] | None
"""Rows and columns of a matrix; None for a scalar."""

UNIT_MATRICES = ("I", "I_3", "I_33", "I_3x3", "E_3", "1_3")
"""Names that mean the unit matrix where a scalar makes no sense."""

FIXED: Mapping[str, Shape] = {
    "cross": (3, 1),
    "vee": (3, 1),
    "skew": (3, 3),
    "dcm_of": (3, 3),
    "qmul": (4, 1),
    "conjugate": (4, 1),
    "vector_part": (3, 1),
    **dict.fromkeys(ROTATIONS, (3, 3)),
}
"""Function -> the shape of its value."""


def shape_of(node: Node, shapes: Mapping[str, Shape]) -> Shape:
    """Return the shape (rows, columns) of a formula whose names have the ``shapes``; None for a scalar."""
    if node.kind == "name":
        return shapes.get(str(node.value))
    inner = [shape_of(child, shapes) for child in node.args]
    matrices = [shape for shape in inner if shape is not None]
    if node.kind == "product":
        return (matrices[0][0], matrices[-1][1]) if matrices else None
    if node.kind in ("sum", "neg", "power"):
        return matrices[0] if matrices else None
    if node.kind == "transpose":
        return (matrices[0][1], matrices[0][0]) if matrices else None
    return _shape_of_call(node, inner, shapes) if node.kind == "call" else None


def _shape_of_blocks(rows: Node, shapes: Mapping[str, Shape]) -> Shape:
    """Return the shape of a matrix whose rows hold scalars or smaller matrices."""
    lines = [row.args if row.kind == "list" else (row,) for row in rows.args]
    cells = [[shape_of(cell, shapes) or (1, 1) for cell in line] for line in lines]
    return sum(max(height for height, _ in line) for line in cells), sum(width for _, width in cells[0])


def _shape_of_call(node: Node, inner: list[Shape], shapes: Mapping[str, Shape]) -> Shape:
    name = str(node.value)
    if name == "Matrix" and node.args[0].kind == "list" and node.args[0].args:
        return _shape_of_blocks(node.args[0], shapes)
    if name in ("eye", "diag"):
        count = len(node.args) if name == "diag" else node.args[0].value
        return (int(count), int(count)) if name == "diag" or node.args[0].kind == "number" else None
    if name in ("diff", "inverse", "adjugate", "integrate", "integral_over_body"):
        return inner[0]
    if name == "hstack" and (parts := [shape for shape in inner if shape is not None]):
        return parts[0][0], sum(columns for _, columns in parts)
    if name == "transpose":
        return inner[0] and (inner[0][1], inner[0][0])
    return FIXED.get(name)


def with_unit_matrices(relation: tuple[str, Node, Node], shapes: Mapping[str, Shape]) -> tuple[str, Node, Node]:
    """Return an equation with ``eye(3)`` for I or 1 if it is added or equal to a 3 x 3 matrix, such as R in ``R - I``.

    Next to a square matrix of another size, I or 1 becomes the unit matrix of that size.
    """
    sign, *sides = relation
    if any(_is_name_of(*pair) for pair in (sides, sides[::-1])):
        # I = [[a, b], [c, d]] defines a matrix named I
        return relation
    left, right = (_with_unit_matrices(side, shapes) for side in sides)
    for side, other in ((left, right), (right, left)):
        shape = shape_of(side, shapes)
        if _is_square(shape) and shape_of(other, shapes) is None and (made := _as_matrix(other, shape)) is not None:
            return (sign, side, made) if side is left else (sign, made, side)
    return sign, left, right


def _is_name_of(name: Node, matrix: Node) -> bool:
    """Return whether an equation defines a matrix under a usual name of the unit matrix: ``I = [[a, b], [c, d]]``.

    ``name`` and ``matrix`` are the sides of the equation. A matrix without letters is no definition: then the equation
    states a value of the unit matrix.
    """
    is_literal = matrix.kind == "list" or (matrix.kind == "call" and matrix.value == "Matrix")
    letters = [node for node in nodes_of(matrix) if node.kind == "name"]
    return name.kind == "name" and name.value in UNIT_MATRICES and is_literal and bool(letters)


def added_names(relation: tuple[str, Node, Node], shapes: Mapping[str, Shape]) -> dict[str, Shape]:
    """Return the names without a shape that are added to a vector or matrix, each with the shape that it must have:
    (3, 1) for a in ``a + cross(w, r)``.
    """
    added: dict[str, Shape] = {}
    for side in relation[1:]:
        for node in nodes_of(side):
            own = shape_of(node, shapes) if node.kind == "sum" else None
            for term in node.args if own is not None else ():
                factors = [factor for factor in factors_of(term) if factor.kind != "number"]
                if len(factors) == 1 and factors[0].kind == "name" and shape_of(factors[0], shapes) is None:
                    added[str(factors[0].value)] = own
    return added


def operand_names(relation: tuple[str, Node, Node], shapes: Mapping[str, Shape]) -> dict[str, Shape]:
    """Return the names without a shape that are arguments of cross, dot or skew, each with the shape (3, 1)."""
    calls = [node for node in nodes_of(*relation[1:]) if node.value in ("cross", "dot", "skew")]
    arguments = [argument for call in calls if call.kind == "call" and len(call.args) < 3 for argument in call.args]
    # in cross(r, m*v), these are r and v: a mass before a name is skipped
    names = [name for name in map(_without_mass, arguments) if name.kind == "name"]
    return {str(name.value): (3, 1) for name in names if shapes.get(str(name.value)) is None}


def _without_mass(tree: Node) -> Node:
    """Return v for ``m*v`` with a mass m, and any other tree unchanged."""
    is_momentum = tree.kind == "product" and len(tree.args) == 2 and tree.args[0].value in ("m", "M")
    return tree.args[1] if is_momentum else tree


def multiplied_names(relation: tuple[str, Node, Node], shapes: Mapping[str, Shape]) -> dict[str, Shape]:
    """Return {name: (3, 1)} for the names of unknown shape that must be vectors, such as v in ``R*v == w``.

    Here R has the shape (3, 3) and w the shape (3, 1) in ``shapes``.
    """
    columns: dict[str, Shape] = {}
    for side, other in (relation[1:], relation[:0:-1]):
        name = str(side.value).removesuffix("_dot") if side.kind == "name" else ""
        if (shapes.get(name) if name else shape_of(side, shapes)) != (3, 1) or other.kind != "product":
            continue
        # w in q' = (1 + [q] + q q^T) w, where [q] is the skew matrix of the vector q
        for first, second in pairwise(other.args):
            if shape_of(first, shapes) == (3, 3) and second.kind == "name" and shapes.get(str(second.value)) is None:
                columns[str(second.value)] = (3, 1)
    return columns


def _is_square(shape: Shape) -> bool:
    return shape is not None and shape[0] == shape[1] > 1


def _with_unit_matrices(node: Node, shapes: Mapping[str, Shape]) -> Node:
    args = [_with_unit_matrices(child, shapes) for child in node.args]
    own = shape_of(node, shapes)
    if node.kind == "sum" and _is_square(own):
        args = [term if shape_of(term, shapes) is not None else _as_matrix(term, own) or term for term in args]
    return replace(node, args=tuple(args))


def _as_matrix(node: Node, shape: Shape) -> Node | None:
    """Return ``eye(n)`` for a term I or 1, and ``cos(a)*eye(n)`` for ``cos(a)*I``; None for other terms.

    n is the number of rows in ``shape``.
    """
    assert shape is not None
    unit = Node("call", "eye", (number(shape[0]),), node.span)
    if node == number(1) or (node.kind == "name" and node.value in UNIT_MATRICES):
        return unit
    if node.kind == "neg":
        inner = _as_matrix(node.args[0], shape)
        return inner and replace(node, args=(inner,))
    if node.kind == "product":
        for place, factor in enumerate(node.args):
            if factor.kind == "name" and factor.value in UNIT_MATRICES:
                return replace(node, args=(*node.args[:place], unit, *node.args[place + 1 :]))
    return None
