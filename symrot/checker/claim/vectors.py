"""The vectors and tensors of a claim: the names of their components, and names that mean lengths.

A name in bold type, or with an arrow or a hat, is a vector: **a** has the components a_x, a_y and a_z. The plain
letter is its length. While LaTeX is read, names of vectors end with ``MARK``.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from symrot.checker.claim.tree import (
    TIME,
    Node,
    column_vector,
    factors_of,
    is_derivative,
    matrix_of_rows,
    nodes_of,
    number,
    product,
    quotient,
)

__all__ = [
    "MARK",
    "Vector",
    "beside_directions",
    "direction",
    "gyroscopic_tensors",
    "is_components",
    "is_tensor",
    "length",
    "may_be_mixed",
    "on_direction",
    "used_vectors",
    "with_scalar_products",
    "without_marks",
]

MARK = "\N{RIGHTWARDS ARROW}"
BASES = (("i", "j", "k"), *(tuple(f"e{mark}{axis}" for axis in axes) for mark in ("_", "") for axes in ("123", "xyz")))
"""Groups of names of basis vectors, such as (i, j, k). The names of a group mean the x, y and z axes if a text marks at
least two of them as vectors (in bold type, with an arrow or a hat) and has no time derivative of any of them. For
groups other than i, j and k, the text must also have no vectors except those of the group."""

AXES = ("xyz", "123", "1234", "0123")
"""Endings of the names of components: "xyz" for a_x, a_y and a_z; "1234" and "0123" are for quaternions."""

TENSOR = re.compile(r"[IJ](_[A-Za-z]\w*)?", re.ASCII)
"""Pattern of the names of inertia tensors."""


@dataclass(frozen=True)
class Vector:
    """A name that means a vector or, as I and J do, a symmetric tensor.

    Attributes
    ----------
    name : str
    timed : bool
        Whether its components depend on time.
    unit : bool
        Whether its length is one, as a hat over the name says.
    axes : str
        The last letters of the names of its components: "xyz" for a_x, a_y and a_z.
    place : int or None
        The number of its axis, 0 to 2, for a unit vector of a basis, such as i or e_x.
    """

    name: str
    timed: bool = False
    unit: bool = False
    axes: str = "xyz"
    place: int | None = None

    @property
    def components(self) -> Node:
        """The components as a tree: ``Matrix([a_x, a_y, a_z])``, numbers 0 and 1 for an axis, rows for a tensor."""
        if self.is_axis:
            place = "xyz".index(self.name) if self.place is None else self.place
            return column_vector([number(int(place == other)) for other in range(3)])
        if is_tensor(self.name):
            return matrix_of_rows([[self._entry("".join(sorted(i + j))) for j in self.axes] for i in self.axes])
        return column_vector([self._entry(axis) for axis in self.axes])

    @property
    def is_axis(self) -> bool:
        """Whether the vector is a coordinate axis: x, y or z with a hat, or a vector of a basis, such as i or e_x."""
        return self.place is not None or (self.unit and self.name in ("x", "y", "z"))

    def _entry(self, axes: str) -> Node:
        name = f"{self.name}_{axes}"
        return Node("call", name, (TIME,)) if self.timed else Node("name", name)

    @property
    def length_is_one(self) -> tuple[str, Node, Node]:
        """The hypothesis that this vector a has length one: ("==", ``dot(a, a)``, 1)."""
        own = Node("name", self.name)
        return "==", Node("call", "dot", (own, own)), number(1)


def is_tensor(name: str) -> bool:
    """Return whether a name in bold, such as I or J, is usually that of an inertia tensor, not of a vector."""
    return TENSOR.fullmatch(name) is not None


def is_components(name: str, tree: Node) -> bool:
    """Return whether ``tree`` defines a vector or matrix ``name`` by names of components alone.

    For the name a, this is true for ``Matrix([a_x, a_y, a_z])``, and for a matrix with entries such as a_11 or a1.
    """
    if any(tree == Vector(name, timed, axes=axes).components for timed in (False, True) for axes in AXES):
        return True
    base = name.partition("_")[0]
    leaves = [node for node in nodes_of(tree) if node.kind != "list" and node != TIME]
    return tree.kind == "call" and tree.value == "Matrix" and all(
        node.kind in ("name", "call") and re.fullmatch(rf"{base}_?[0-9]+", str(node.value)) for node in leaves[1:]
    )  # fmt: skip


def without_marks(sides: Sequence[Node], names: Mapping[str, bool]) -> tuple[list[Node], dict[str, bool]]:
    """Return a claim's sides without the marks of vectors, and the marked vectors (True for one with a hat).

    A marked name that also has another meaning without a mark is changed, to ``I_tensor`` or ``q_vec``.

    Parameters
    ----------
    sides : sequence of Node
    names : mapping of str to bool
        The names with a mark (bold type, an arrow or a hat); True for one with a hat.
    """
    plain = {node.value for node in nodes_of(*sides) if node.kind == "name"}
    spelled = {name: f"{name}_tensor" if is_tensor(name) and name in plain else name for name in names}
    parts = {name for name in names if {name, f"{name}_0"} <= plain}  # of a quaternion, whose name has no mark
    spelled |= {name: f"{name}_vec" for name in parts}
    vectors = [Node("name", name) for name in names if not is_tensor(name) and name not in parts]
    # a name without its mark means the length, sqrt(dot(a, a))
    sides = [_without_marks(side, spelled, vectors) for side in sides]
    sides = [with_scalar_products(side, [spelled[name] for name in parts]) if parts else side for side in sides]
    return sides, {spelled[name]: unit for name, unit in names.items()}


def used_vectors(sides: Sequence[Node], names: Mapping[str, bool]) -> tuple[Vector, ...]:
    """Return the vectors whose components a claim needs: r and p for ``L = r x p``, but not L.

    ``names`` maps the names of vectors to True for those with a hat.
    """
    trees = nodes_of(*sides)
    used = {str(node.value) for node in trees if node.kind == "name"}
    rates = [node for node in trees if is_derivative(node) and node.args[-1] == TIME]
    moving = {node.value for rate in rates for node in nodes_of(rate.args[0])}
    places = {
        name: place
        for basis in BASES
        if len({*names} & {*basis}) > 1 and not moving & {*basis} and (basis[0] == "i" or {*names} <= {*basis})
        for place, name in enumerate(basis)
    }
    axes = {name for name in names if Vector(name, unit=names[name]).is_axis} | {*places}
    names = {**names, **dict.fromkeys(sorted(used & {*places}), True)}
    # a vector that is a whole side, and occurs nowhere else, needs none
    needed = (used & {*names}) - (_lone_names(sides) - axes)
    return tuple(
        Vector(name, name in moving, names[name], _axes(name, used), places.get(name))
        for name in names
        if name in needed
    )


def _axes(name: str, used: Collection[str]) -> str:
    """Return the endings of the names of a vector's components, as the names in ``used`` show.

    The endings are "123" if ``used`` has a name with a number, such as ``a_1``, and "xyz" otherwise. If ``used`` also
    has ``a_0`` or ``a_4``, the vector is a quaternion with the endings "0123" or "1234". A vector R has the endings
    "123" even without such names, because R_x is a rotation matrix.
    """
    numbers = [n for n in "01234" if f"{name}_{n}" in used or (n in "04" and f"{name}{n}" in used)]
    if {"0", "4"} & {*numbers} and {"1", "2", "3"} & {*numbers}:
        return "0123" if "0" in numbers else "1234"
    return "123" if numbers or name == "R" else "xyz"


def _without_marks(node: Node, spelled: Mapping[str, str], vectors: Sequence[Node]) -> Node:
    if node.kind == "name" and str(node.value).endswith(MARK):
        return replace(node, value=spelled[str(node.value).removesuffix(MARK)])
    if node.kind == "power" and node.args[0] in vectors and node.args[1] == number(2):
        return Node("call", "dot", (node.args[0], node.args[0]), node.span)
    if node in vectors:
        return replace(length(node), span=node.span)
    made = replace(node, args=tuple(_without_marks(child, spelled, vectors) for child in node.args))
    return _with_scalar_products(made, vectors) if made.kind == "product" else made


def direction(vector: Node) -> Node:
    """Return ``v/sqrt(dot(v, v))``, the meaning of v with a hat in a text that also has v without a hat."""
    return replace(quotient(vector, length(vector)), span=vector.span)


def beside_directions(factors: Sequence[Node]) -> list[Node]:
    """Return the factors of a product, where a vector v becomes its length if its direction v/|v| is also a factor.

    In a text with both r and r with a hat, their product is a vector: the r without a hat is a length.
    """
    return [length(factor) if direction(factor) in factors else factor for factor in factors]


def may_be_mixed(name: str) -> bool:
    """Return whether ``name`` with a hat may be the direction of the vector that a text calls ``name`` without a hat.

    Return False for names of axes such as x, i and e_1: with a hat, x is an axis, and without a hat, a coordinate.
    """
    return name not in "xyzijk" and not name.startswith("e_")


def on_direction(name: str) -> str:
    """Return the note for the user that ``name`` with a hat is a direction."""
    return f"{name} with a hat is {name}/|{name}|, since the text has {name} too"


def length(vector: Node) -> Node:
    """Return ``sqrt(dot(v, v))`` for the vector v."""
    return Node("call", "sqrt", (Node("call", "dot", (vector, vector)),))


def gyroscopic_tensors(sides: Sequence[Node]) -> Iterator[str]:
    """Yield the names of inertia tensors: J in ``cross(w, J*w + h)``, ``skew(w)*J*w`` and ``w.T*J*w``."""
    for side in sides:
        for node in nodes_of(side):
            factors: Sequence[Node] = ()
            if node.kind == "call" and node.value == "cross":
                first, second = node.args
                vector = first.args[-1] if first.kind == "product" else first
                terms = map(factors_of, second.args if second.kind == "sum" else (second,))
                products = [own for own in terms if len(own) > 1 and vector in own]
                factors = (vector, *products[0]) if products else ()
            elif node.kind == "product":
                wrapped = [f.kind == "transpose" or (f.kind == "call" and f.value == "skew") for f in node.args]
                factors = [f.args[0] if inside else f for f, inside in zip(node.args, wrapped, strict=True)]
            # with a scalar J, the cross products would be zero
            for before, name, after in zip(factors, factors[1:], factors[2:], strict=False):
                if name.kind == "name" and before == after and is_tensor(str(name.value)):
                    yield str(name.value)


def _lone_names(sides: Sequence[Node]) -> set[str]:
    """Return the names that are a whole side of a claim and occur nowhere else in it, such as L in ``L = r x p``."""
    everywhere = [node.value for node in nodes_of(*sides) if node.kind == "name"]
    is_number = any(side.kind == "number" and side.value for side in sides)
    # a side such as 3 asks for the components: then no name is lone
    alone = [side for side in sides if side.kind == "name" and not is_number]
    return {str(side.value) for side in alone if everywhere.count(side.value) == 1}


def with_scalar_products(node: Node, names: Collection[str]) -> Node:
    """Return a tree with ``dot(a, b)`` in place of ``a.T*b``, for vectors a and b in ``names``."""
    made = replace(node, args=tuple(with_scalar_products(child, names) for child in node.args))
    return _with_scalar_products(made, [Node("name", name) for name in names]) if made.kind == "product" else made


def _with_scalar_products(node: Node, vectors: Sequence[Node]) -> Node:
    """Return a product with ``dot(a, b)`` in place of ``a.T*b``, for the given ``vectors``."""
    factors: list[Node] = []
    for factor in node.args:
        last = factors[-1] if factors else None
        if last is not None and factor in vectors and last.kind == "transpose" and last.args[0] in vectors:
            factors[-1] = Node("call", "dot", (last.args[0], factor))
        else:
            factors.append(factor)
    return product(factors, node.span)
