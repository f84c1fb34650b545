"""Pauli's matrices, as sigma_x, sigma_y, sigma_z or sigma_1, sigma_2, sigma_3, with commutators and anticommutators.

A complex number a + i b is the real 2 x 2 matrix [[a, -b], [b, a]]. So i and Pauli's matrices become real 4 x 4
matrices, with which the engine computes exactly.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import replace

from symrot.checker.claim.shapes import shape_of
from symrot.checker.claim.tree import Node, matrix_of_rows, names_in, negated, nodes_of, number, product, sum_of
from symrot.errors import InputError

__all__ = ["commutator", "eye", "with_pauli_matrices"]

Relation = tuple[str, Node, Node]
Complex = tuple[tuple[complex, complex], tuple[complex, complex]]

UNIT: Complex = ((1, 0), (0, 1))
PAULI: dict[str, Complex] = {"x": ((0, 1), (1, 0)), "y": ((0, -1j), (1j, 0)), "z": ((1, 0), (0, -1))}
NAMES = {f"sigma_{ending}": PAULI[axis] for axis, number_of in zip("xyz", "123", strict=True)
         for ending in (axis, number_of)}  # fmt: skip
UNITS = IMAGINARY, UNIT_MATRIX = "i", "I"
STEM = re.compile("sigma_[a-z123]$")
SIZE = 4
NODE_KINDS = ("name", "number", "sum", "product", "neg", "power", "inv", "list")
"""Kinds of tree nodes that an equation of Pauli's matrices may have, besides calls of the functions in ``CALLS``. In an
equation with any other node, such as a transpose, sigma_x is not read as Pauli's matrix."""

OF_MATRICES = ("trace", "det")
"""Names of functions that take only matrices: in ``det(sigma_x)``, sigma_x is Pauli's matrix, for if it were a stress,
a number, it would have no determinant."""

CALLS = ("sin", "cos", "sqrt", "Matrix", *OF_MATRICES)
"""Names of the functions that an equation of Pauli's matrices may call."""


def with_pauli_matrices(relation: Relation, known: Collection[str]) -> tuple[Relation, tuple[tuple[str, Node], ...]]:
    """Return an equation of Pauli's matrices, written with real 4 x 4 matrices, and the definitions of these matrices.

    A scalar 2 becomes ``2*eye(4)``.

    Any other equation is returned unchanged, without definitions.

    Raises
    ------
    InputError
        For a matrix that is both inside and outside of an exponent, in an equation with i.
    """
    sign, left, right = relation[0], *map(_with_commutators, relation[1:])
    nodes = nodes_of(left, right)
    used = {str(node.value) for node in nodes if node.kind == "name"}
    matrices = sorted(used & {*NAMES})
    if (name := _in_exponent(nodes, matrices)) and IMAGINARY in used:
        raise InputError(f"expected {name} outside of exponents (write e^(i a {name}) as cos(a) + i {name} sin(a))")
    names_another = any(side.kind == "name" and side.value not in (*matrices, *UNITS) for side in (left, right))
    is_plain = all(node.kind in NODE_KINDS or (node.kind == "call" and node.value in CALLS) for node in nodes)
    sigmas = [node for node in nodes if node.kind == "name" and node.value in NAMES]
    # a product or power without other names: sigma_x^2 = 1
    multiplied = any(_is_product_of_matrices(node) for node in nodes) and used <= {*NAMES, UNIT_MATRIX}
    # trace or determinant: det(sigma_x) = -1
    of_matrix = any(node.value in OF_MATRICES and names_in(node) & {*NAMES} for node in nodes if node.kind == "call")
    # in other equations sigma_x is a number, such as a stress
    is_evident = (IMAGINARY in used and len(sigmas) > 1) or multiplied or of_matrix or _is_square(left, right)
    # the claim itself defines one of the names
    is_known = bool({*known} & {*matrices, IMAGINARY})
    # sigma_1^2 - sigma_1 sigma_2 + sigma_2^2 = sigma_y^2 is about stresses
    is_mixed = len({name[-1].isdigit() for name in matrices}) > 1 and IMAGINARY not in used
    if not matrices or is_mixed or names_another or not is_plain or not is_evident or is_known:
        return relation, ()
    define = tuple((name, _real(NAMES[name])) for name in matrices)
    define = (*define, (IMAGINARY, _real(((1j, 0), (0, 1j)))), (UNIT_MATRIX, eye()))
    shapes = dict.fromkeys([name for name, _ in define], (SIZE, SIZE))
    left, right = map(_with_traces, (left, right))
    return (sign, _as_matrix(left, shapes), _as_matrix(right, shapes)), define


def _is_product_of_matrices(node: Node) -> bool:
    """Return whether a formula is a product of two Pauli matrices, or a power of a Pauli matrix."""
    factors = [part for part in node.args if part.kind == "name" and part.value in NAMES]
    return (node.kind == "product" and len(factors) > 1) or (node.kind == "power" and bool(factors))


def _is_square(left: Node, right: Node) -> bool:
    """Return whether an equation gives the square of a formula with Pauli matrices by its other letters, or by another
    such square: ``(a sigma_x + sigma_y)^2 = a^2 + 1``, ``(b sigma_x)^2 = (b sigma_y)^2``.
    """
    # for numbers sigma_x and sigma_y, both sides would contain the same ones
    for side, other in ((left, right), (right, left)):
        if _squared_in(side) and not names_in(other) & {*NAMES} and names_in(other) <= {*names_in(side), UNIT_MATRIX}:
            return True
    matrices = [names_in(side) & {*NAMES} for side in (left, right)]
    letters = [names_in(side) - {*NAMES, UNIT_MATRIX} for side in (left, right)]
    are_squared = all(own and own == _squared_in(side) for own, side in zip(matrices, (left, right), strict=True))
    return are_squared and letters[0] == letters[1] and not matrices[0] & matrices[1]


def _squared_in(side: Node) -> set[str]:
    """Return the Pauli matrices in the squares of a formula."""
    bases = [node.args[0] for node in nodes_of(side) if node.kind == "power" and node.args[1] == number(2)]
    return names_in(*bases) & {*NAMES}


def commutator(first: Node, second: Node, sign: str = "-") -> Node | None:
    """Return the tree of A B - B A, or A B + B A for ``sign`` "+"; None unless A and B contain Pauli matrices."""
    # otherwise [A, B] is a list of two components
    if not all(any(STEM.match(str(node.value)) for node in nodes_of(part)) for part in (first, second)):
        return None
    backwards = product([second, first])
    return sum_of([product([first, second]), backwards if sign == "+" else negated(backwards)])


def _with_commutators(tree: Node) -> Node:
    """Return a tree in which lists of two formulas with Pauli's matrices, ``[sigma_x, sigma_y]``, are commutators."""
    args = tuple(map(_with_commutators, tree.args))
    pair = args[0].args if tree.value == "Matrix" and args[0].kind == "list" else ()
    bracket = commutator(*pair) if len(pair) == 2 and not any(part.kind == "list" for part in pair) else None
    return bracket or replace(tree, args=args)


def _with_traces(tree: Node) -> Node:
    """Return a tree with traces and determinants of complex 2 x 2 matrices as formulas of real 4 x 4 matrices."""
    args = tuple(map(_with_traces, tree.args))
    if tree.kind == "call" and tree.value == "det":
        (matrix,) = args
        trace, trace_of_square = (Node("call", "trace", (part,)) for part in (matrix, product([matrix, matrix])))
        # det M = ((tr M)^2 - tr(M M))/2
        difference = sum_of([product([trace, trace]), negated(trace_of_square)])
        return _with_traces(product([Node("inv", None, (number(2),)), difference]))
    if tree.kind != "call" or tree.value != "trace":
        return replace(tree, args=args)
    # R has the block [[a, -b], [b, a]] for each entry a + i b of M, so tr M = tr(R)/2 + i tr(-i R)/2, where -i in the
    # second trace is the 4 x 4 matrix of -i
    half, unit = Node("inv", None, (number(2),)), Node("name", IMAGINARY)
    turned = Node("call", "trace", (negated(product([unit, *args])),))
    return sum_of([product([half, Node("call", "trace", args), eye()]), product([half, turned, unit])])


def eye() -> Node:
    """Return the tree ``eye(4)`` of the unit matrix, which is the number 1 in equations with Pauli's matrices."""
    return Node("call", "eye", (number(SIZE),))


def _real(matrix: Complex) -> Node:
    """Return the tree of the real matrix that represents a complex matrix."""
    rows = []
    for row in matrix:
        parts = [(complex(entry).real, complex(entry).imag) for entry in row]
        rows.append([int(part) for real, imaginary in parts for part in (real, -imaginary)])
        rows.append([int(part) for real, imaginary in parts for part in (imaginary, real)])
    return matrix_of_rows([list(map(number, row)) for row in rows])


def _in_exponent(nodes: Sequence[Node], matrices: Collection[str]) -> str:
    """Return the first name of ``matrices`` that occurs both inside and outside of exponents; "" if there is none."""
    exponents = [
        node.args[-1] for node in nodes if node.kind == "power" or (node.kind == "call" and node.value == "exp")
    ]
    names = [str(node.value) for node in nodes if node.kind == "name"]
    inside = [str(part.value) for part in nodes_of(*exponents) if part.kind == "name"]
    return next((name for name in matrices if name in inside and names.count(name) > inside.count(name)), "")


def _as_matrix(side: Node, shapes: dict[str, tuple[int, int]]) -> Node:
    """Return a side as a matrix: a scalar s becomes s times the unit matrix.

    ``shapes`` tells which names are matrices.
    """
    if side.kind == "call" and side.value == "Matrix":
        (rows,) = side.args
        # each scalar entry of a written-out matrix becomes such a matrix
        lines = [row.args if row.kind == "list" else (row,) for row in rows.args]
        return replace(
            matrix_of_rows([[_as_matrix(entry, shapes) for entry in line] for line in lines]), span=side.span
        )
    side = _with_units(side, shapes)
    return side if shape_of(side, shapes) is not None else _times_unit(side)


def _with_units(tree: Node, shapes: dict[str, tuple[int, int]]) -> Node:
    """Return a tree in which a scalar term s that is added to a matrix becomes s times the unit matrix."""
    args = [_with_units(part, shapes) for part in tree.args]
    if tree.kind == "sum" and any(shape_of(term, shapes) is not None for term in args):
        args = [term if shape_of(term, shapes) is not None else _times_unit(term) for term in args]
    return replace(tree, args=tuple(args))


def _times_unit(tree: Node) -> Node:
    return Node("product", None, (tree, eye()), tree.span)
