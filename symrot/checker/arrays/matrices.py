"""Names that a text uses as matrices, columns or lengths of vectors, although it does not define them.

A capital letter in ``tr A`` or ``(A B)^T`` is a 3 x 3 matrix of independent symbols, a small letter in ``r^T r`` a
column. ``shapes`` maps names to shapes: (3, 1) is a vector.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from symrot.checker.claim.shapes import Shape, shape_of
from symrot.checker.claim.tree import (
    TIME,
    Node,
    factors_of,
    is_derivative,
    is_inverse,
    matrix_of_rows,
    nodes_of,
    number,
    untimed,
    without_sign,
)
from symrot.checker.claim.vectors import is_tensor, length

__all__ = [
    "as_rotations", "bold_matrices", "bold_unit_matrices", "matrices_of_entries", "matrix_of_entries", "rate_matrices",
    "used_columns",
    "used_matrices", "with_lengths", "without_time",
]  # fmt: skip

OF_MATRICES = ("det", "trace", "inverse", "adjugate", "transpose")
UNIT_NAMES = ("I", "E", "I_3", "E_3")
COLUMN = (3, 1)
OF_NUMBERS = ("sin", "cos", "tan")
"""Names of functions whose argument is a number: in ``sin(v)``, a vector v means its length."""


def matrix_of_entries(name: str, timed: bool = False) -> Node:
    """Return the tree of a 3 x 3 matrix of the symbols A_11, A_12 and so on, or functions A_11(t) if ``timed``."""
    kind, args = ("call", (TIME,)) if timed else ("name", ())
    rows = [[Node(kind, f"{name}_{i}{j}", args) for j in "123"] for i in "123"]
    return matrix_of_rows(rows)


def matrices_of_entries(definitions: Sequence[tuple[str, Node]]) -> list[str]:
    """Return the names that are defined as 3 x 3 matrices of independent symbols, as A with A_11, A_12 and so on."""
    return [
        name for name, tree in definitions if any(tree == matrix_of_entries(name, timed) for timed in (False, True))
    ]


def as_rotations(definitions: Sequence[tuple[str, Node]], names: Collection[str]) -> list[tuple[str, Node]]:
    """Return definitions in which each matrix of ``names`` is a rotation by free angles, not a matrix of nine free
    entries.
    """
    return [
        (name, _rotation(name, tree == matrix_of_entries(name, timed=True)) if name in names else tree)
        for name, tree in definitions
    ]


def _rotation(name: str, timed: bool) -> Node:
    """Return the tree ``Rz(a1)*Rx(a2)*Rz(a3)`` with free angles, for the rotation ``name``.

    If ``timed``, the angles are functions of time.
    """
    kind, args = ("call", (TIME,)) if timed else ("name", ())
    # every rotation can be written so; for R the angles are R_angle1, R_angle2 and R_angle3
    turns = [Node("call", f"R{axis}", (Node(kind, f"{name}_angle{n}", args),)) for n, axis in enumerate("zxz", 1)]
    return Node("product", None, tuple(turns))


def used_matrices(sides: Sequence[Node], known: Collection[str]) -> tuple[str, ...]:
    """Return the capitals that a claim uses as names of matrices, as A and B in ``det(A B)``, except ``known`` ones."""
    names = dict.fromkeys(name for name in _inverted_in_order(sides) if name not in (*known, *UNIT_NAMES))
    for side in sides:
        for node in nodes_of(side):
            inside = _of_matrix(node)
            alone = [part for part in inside if part.kind == "name" and node.kind == "call"]
            for part in inside:
                for leaf in _factors(part):
                    # I is the unit matrix, except in det(I) and tr(I), where it may be an inertia tensor
                    is_unit = leaf in UNIT_NAMES and not (len(alone) == len(inside) == 1)
                    if leaf[0].isupper() and leaf not in known and not is_unit:
                        names[leaf] = None
    return tuple(names)


def _inverted_in_order(sides: Sequence[Node]) -> list[str]:
    """Return A and B for ``(A B)^-1 = A^-1 B^-1``, whose order is wrong for matrices; an empty list for other
    equations.
    """
    for side, other in (sides, sides[::-1]):
        base = side.args[0] if is_inverse(side) else side
        if base is side or base.kind != "product" or other.kind != "product" or not all(map(is_inverse, other.args)):
            continue
        names, inverted = ([_name_of_array(factor) for factor in part.args] for part in (base, other))
        # (A B)^-1 = B^-1 A^-1 is true for numbers too; only the wrong order shows that matrices are meant
        if sorted(names) == sorted(inverted) and inverted != names[::-1] and all(n[:1].isupper() for n in names):
            return names
    return []


def bold_unit_matrices(sides: Sequence[Node]) -> set[str]:
    """Return {"I"} if a bold I is the unit matrix and no tensor of inertia; an empty set otherwise."""
    nodes = nodes_of(*sides)
    names = {str(node.value) for node in nodes if node.kind in ("name", "call")}
    has_transpose = any(node.kind == "transpose" for node in nodes)
    # one side is I alone, and the other has a transpose
    is_alone = any(side.kind == "name" and side.value == "I" for side in sides) and has_transpose
    # a skew matrix or a a^T
    has_square = "skew" in names or any(
        second.kind == "transpose" and second.args[0] == first
        for node in nodes if node.kind == "product" for first, second in pairwise(node.args)
    )  # fmt: skip
    in_sum = any(node.kind == "sum" and any("I" in map(_name_of_array, factors_of(term)) for term in node.args)
                 for node in nodes)  # fmt: skip
    # with an angular velocity, I is a tensor of inertia
    is_of_motion = any(name.startswith(("omega", "Omega", "alpha")) for name in names)
    return {"I"} if (is_alone or (has_square and in_sum)) and not is_of_motion else set()


def bold_matrices(sides: Sequence[Node], vectors: Collection[str]) -> dict[str, bool]:
    """Return the bold capital letters that are matrices, not vectors, each with True if it depends on time."""
    matrices: dict[str, bool] = {}
    nodes = nodes_of(*sides)
    for node in nodes:
        # the argument of a determinant or trace
        name = str(node.args[0].value) if node.kind == "call" and node.value in ("det", "trace") else ""
        if name[:1].isupper() and name in vectors and not is_tensor(name):
            matrices[name] = False
    for node in nodes:
        for first, second in pairwise(node.args if node.kind == "product" else ()):
            # on the left of a vector or matrix in a product, as R in R v and R [w]x
            name = _name_of_array(first)
            is_vector = Node("call", "dot", (first, second)) in nodes  # F·d = F d cos θ
            is_capital = name[:1].isupper() and name in vectors and not is_tensor(name)
            if is_capital and _is_array(second, vectors) and not is_vector:
                rates = [n.args[0].value for n in nodes if is_derivative(n)]
                matrices[name] = name in rates
    return matrices


def rate_matrices(relation: tuple[str, Node, Node]) -> dict[str, bool]:
    """Return the matrices whose rate an equation gives by a skew matrix, each with True if it is a function of time.

    These are {"R": True} for ``R' = skew(w) R``, and {"R": False} for ``R_dot = skew(w) R``, where R_dot is a symbol.
    """
    matrices: dict[str, bool] = {}
    for side, other in (relation[1:], relation[:0:-1]):
        # R' is the derivative of R(t); beside R_dot, which is a symbol, R does not depend on t
        is_rate = is_derivative(side) and len(side.args) == 2
        name = str(side.args[0].value) if is_rate else str(side.value).removesuffix("_dot")
        if not name[:1].isupper() or (not is_rate and name == side.value):
            continue
        for node in nodes_of(other):
            for pair in pairwise(node.args if node.kind == "product" else ()):
                kinds = {factor.value for factor in pair if factor.kind == "call"}
                if name in [_bare(factor).value for factor in pair] and "skew" in kinds:
                    matrices[name] = is_rate
    for node in (node for node in nodes_of(*relation[1:]) if node.kind == "product"):
        for pair in pairwise(node.args):  # R' R^T and R^T R'
            rates = [part.args[0] for part in pair if is_derivative(part) and len(part.args) == 2]
            transposes = [part.args[0] for part in pair if part.kind == "transpose"]
            if rates and rates == transposes and (name := str(_bare(rates[0]).value))[:1].isupper():
                matrices[name] = True
    return matrices


def without_time(node: Node, names: Collection[str]) -> Node:
    """Return a tree with R in place of R(t) for each matrix R in ``names``, whose entries depend on time."""
    if node.kind == "call" and node.value in names and node.args == (TIME,):
        return Node("name", node.value, (), node.span)
    return replace(node, args=tuple(without_time(child, names) for child in node.args))


def _bare(node: Node) -> Node:
    """Return the node of the name R for R(t), and for a transpose of R; return any other node unchanged."""
    return untimed(node.args[0] if node.kind == "transpose" else node)


def _name_of_array(node: Node) -> str:
    """Return the name A if a formula is A, A^T, a power such as A^-1 or the rate of A; an empty text for others."""
    inner = node.args[0] if node.kind in ("transpose", "power") or node.value == "diff" else node
    return str(inner.value) if inner.kind == "name" else ""


def _is_array(node: Node, vectors: Collection[str]) -> bool:
    return _name_of_array(node) in vectors or (node.kind == "call" and node.value in ("skew", "cross"))


def used_columns(sides: Sequence[Node], known: Collection[str]) -> tuple[str, ...]:
    """Return the names with small letters that a claim uses as columns, as r and v in ``r^T r`` and ``(R v)^T``."""
    names: dict[str, None] = {}
    for side in sides:
        for node in nodes_of(side):
            # names in known are defined in the claim
            if node.kind == "transpose":
                names |= {leaf: None for leaf in _factors(node.args[0]) if leaf[0].islower() and leaf not in known}
    return tuple(names)


def _of_matrix(node: Node) -> Sequence[Node]:
    """Return the arguments or factors of a node that must be matrices, such as A and B in ``A B A^T``."""
    if node.kind == "transpose" or (node.kind == "call" and node.value in OF_MATRICES):
        return node.args
    if node.kind == "call" and node.value in ("cross", "dot") and all(side.kind == "product" for side in node.args):
        first, second = (side.args[0] for side in node.args)
        is_one = first == second and first.kind == "name" and first.value[0].isupper()
        return (first,) if is_one else ()  # R a x R b, and R a . R b
    factors = [factor for factor in node.args if factor.kind != "number"] if node.kind == "product" else []
    if len(factors) > 2:
        if forms := _of_form(factors):
            return forms
        first, *between, last = factors
        for matrix, inverse in ((first, last), (last, first)):
            is_inverted = inverse.kind in ("transpose", "power") or inverse.value in OF_MATRICES
            if is_inverted and inverse.args[0] == matrix and matrix.kind == "name" and matrix.value[0].isupper():
                return matrix, *(factor for factor in between if factor.kind == "name")
    return ()


def _of_form(factors: Sequence[Node]) -> list[Node]:
    """Return A for the factors of ``a^T A b``: the capital letters between a transposed column and a column."""
    first, *between, last = factors
    columns = [first.args[0] if first.kind == "transpose" else number(0), last]
    if not between or not all(column.kind == "name" and column.value[0].islower() for column in columns):
        return []
    return [name for name in between if name.kind == "name" and name.value[0].isupper() and not is_tensor(name.value)]


def _factors(node: Node) -> Iterator[str]:
    """Yield the names that are factors or terms of a formula: A and B for ``A^2 + 3 B``, none for ``sin(x)``."""
    if node.kind == "name":
        yield str(node.value)
    elif node.kind in ("sum", "product", "neg", "transpose") or (node.kind == "power" and node.args[1].kind != "name"):
        for child in node.args:
            yield from _factors(child)


def with_lengths(
    relation: tuple[str, Node, Node], shapes: Mapping[str, Shape]
) -> tuple[tuple[str, Node, Node], tuple[str, ...]]:
    """Return a relation with ``sqrt(dot(a, a))`` for a vector a where only a scalar fits, and the names of such
    vectors.
    """
    lengths = _Lengths(shapes)
    sign, left, right = relation
    left, right = lengths.read(left), lengths.read(right)
    # a factor of one side is a length too if the other side is a scalar
    shape_left, shape_right = shape_of(left, shapes), shape_of(right, shapes)
    if shape_left is None and shape_right == COLUMN and left.kind != "name":
        right = lengths.scalar(right)
    elif shape_right is None and shape_left == COLUMN and right.kind not in ("name", "number"):
        left = lengths.scalar(left)
    return (sign, left, right), tuple(dict.fromkeys(lengths.names))


class _Lengths:
    """A rewriter that replaces vectors by their lengths; ``names`` collects the vectors that it replaced."""

    def __init__(self, shapes: Mapping[str, Shape]) -> None:
        self.shapes = shapes
        self.names: list[str] = []

    def read(self, node: Node) -> Node:
        node = replace(node, args=tuple(self.read(child) for child in node.args))
        own = [shape_of(child, self.shapes) for child in node.args]
        # two columns cannot be multiplied
        if node.kind == "product" and own.count(COLUMN) > 1 and {*own} <= {COLUMN, None}:
            return self.scalar(node)
        # a column has no sine, and nothing is divided by it
        if node.kind == "inv" or (node.kind == "call" and node.value in OF_NUMBERS):
            return replace(node, args=tuple(map(self.scalar, node.args)))
        # a column cannot be added to a scalar
        if node.kind == "sum" and None in own and COLUMN in own and not _has_added_name(node):
            return replace(node, args=tuple(self.scalar(child) for child in node.args))
        return node

    def scalar(self, node: Node) -> Node:
        """Return a tree in which ``sqrt(dot(v, v))`` replaces each vector v that is a factor."""
        if node.kind == "name" and self.shapes.get(str(node.value)) == COLUMN:
            self.names.append(str(node.value))
            return replace(length(node), span=node.span)
        if node.kind in ("product", "neg", "inv") or (node.kind == "power" and node.args[1].kind == "number"):
            return replace(node, args=tuple(self.scalar(child) for child in node.args))
        return node


def _has_added_name(node: Node) -> bool:
    """Return whether one of the terms of a sum is a single name, as in ``a + 2*b``; an inertia tensor such as I does
    not count.
    """
    # such a name may be a vector too, so the other terms need not be scalars
    return any(term.kind == "name" and not is_tensor(str(term.value)) for term in map(without_sign, node.args))
