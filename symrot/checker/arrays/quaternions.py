"""Quaternions that a text does not define: in ``q ⊗ p``, ``q v q*``, a conjugate, an inverse or a norm.

q has the scalar part q_0 and the vector part q_1, q_2, q_3; products are Hamilton's. A vector in a product has the
scalar part zero. Names in ``known`` are those that the claim defines.
"""

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from symrot.checker.arrays.rotated_vectors import as_matrix_of_map
from symrot.checker.claim.shapes import Shape, shape_of
from symrot.checker.claim.tree import (
    TIME,
    Node,
    column_vector,
    is_derivative,
    is_inverse,
    names_in,
    negated,
    nodes_of,
    number,
    product,
    sum_of,
    untimed,
)
from symrot.checker.claim.vectors import length

__all__ = ["CONJUGATE", "Quaternions", "quaternion_product", "used_quaternions"]

CONJUGATE, PRODUCT = "conjugate", "qmul"
LETTERS = ("q", "p", "Q", "P")
"""First letters of names that are usually quaternions."""

UNITS = {"i": 1, "j": 2, "k": 3}
"""Maps the name of a quaternion unit to its index in the components (q_0, q_1, q_2, q_3)."""

ANGULAR = re.compile(r"(omega|Omega|w)(_[A-Za-z]+)?")
"""Pattern of the names of angular velocities."""

USUAL_NAMES = ("q", "Q", "beta", "epsilon")
"""Names that mean a quaternion even in a text without signs of quaternions, such as ⊗ or a star. This holds in an
equation such as ``q' = 1/2 omega q``, and for ``|q|`` in a text that also contains q_bar."""

ENDINGS = ("_vec", "_v", "v")
"""Endings of the name of a vector part: the vector part of the quaternion q is ``q_vec``, ``q_v`` or ``qv``."""


@dataclass(frozen=True)
class Quaternions:
    """The quaternions of an equation: their definitions, notes, and the equation with ``qmul(q, p)`` for products."""

    relation: tuple[str, Node, Node]
    definitions: tuple[tuple[str, Node], ...] = ()
    vectors: tuple[str, ...] = ()  # names of vectors that are multiplied by quaternions
    notes: tuple[str, ...] = ()


def used_quaternions(
    relation: tuple[str, Node, Node], vectors: Collection[str], shapes: Mapping[str, Shape], known: Collection[str]
) -> Quaternions:
    """Return the quaternions of an equation, such as q in ``q v q*``, and the equation with ``qmul(q, v)`` for ``q v``.

    Parameters
    ----------
    relation : Relation
    vectors : collection of str
        The names that are vectors.
    shapes : mapping
        The shapes of the names that are defined.
    known : collection of str
        The names that are defined.
    """
    sign, *sides = relation
    if _has_units(sides, (*vectors, *known)):
        return _of_units(relation)
    by_components = _by_components(relation, known)
    if by_components is not None:
        return by_components
    bold = {
        node.args[0].value
        for node in nodes_of(*sides)
        if node.kind == "call" and node.value == CONJUGATE and node.args[0].kind == "name"
    }
    factors = {part.value for node in nodes_of(*sides) if node.value == "qmul" for part in node.args}
    bold |= {node.args[0].value for node in nodes_of(*sides) if is_derivative(node)} & factors
    vectors = [name for name in vectors if name not in bold]  # a bold letter with a conjugate is a quaternion
    names = _quaternion_names(sides, vectors, shapes, known)
    if not names and not any(node.value == CONJUGATE for node in nodes_of(*sides)):
        return Quaternions(relation)
    reader = _Products(names, {*vectors})
    sides = [reader.read(side) for side in sides]
    if any(shape_of(side, reader.shapes(shapes)) == (4, 1) for side in sides):
        reader.pure |= {str(part.value): None for side in sides for part in _vector_of_pair(side)}
    left, right = _of_one_shape(sides, reader.shapes(shapes))
    (sign, left, right), on_matrix = as_matrix_of_map((sign, left, right), {*vectors, *reader.pure}, known)
    used = names_in(left, right)
    if on_matrix:
        reader.pure = {name: None for name in reader.pure if name in used}
    moving = any(is_derivative(node) for node in nodes_of(*sides))
    definitions = [part for name in names for part in _definitions(name, used, moving)]
    lefts, rights = (_with_time(side, names, moving) for side in (left, right))
    first = names[0] if names else ""
    parts = dict(definitions).get(first)
    notes = [f"{first} is a quaternion with the scalar part {first}_0 and Hamilton's product"] if parts else []
    notes += [on_matrix] if on_matrix else []
    return Quaternions((sign, lefts, rights), tuple(definitions), tuple(reader.pure), tuple(notes))


def _has_units(sides: Sequence[Node], others: Collection[str]) -> bool:
    """Return whether i, j and k are the only names of a claim and mean units of quaternions, as in ``i² = j² = -1``."""
    nodes = nodes_of(*sides)
    names = {str(node.value) for node in nodes if node.kind == "name"}
    squares = any(node.kind == "power" for node in nodes)
    plain = {node.kind for node in nodes} <= {"name", "number", "neg", "product", "power", "sum"}
    return plain and bool(names) and names <= {*UNITS} - {*others} and (len(names) > 1 or (squares and names != {"i"}))


def _of_units(relation: tuple[str, Node, Node]) -> Quaternions:
    """Return the equation ``qmul(i, j) = k`` for ``i j = k``, with the definitions of the units i, j and k in it."""
    sign, left, right = relation
    reader = _Products(tuple(UNITS), set())
    sides = [reader.read(_without_squares(side)) for side in (left, right)]
    first, second = _of_one_shape(sides, reader.shapes({}))
    used = names_in(first, second)
    # i is the column [0, 1, 0, 0]
    definitions = [(name, column_vector([number(int(n == place)) for n in range(4)])) for name, place in UNITS.items()]
    note = "i, j and k are the units of quaternions, with i j = k"
    return Quaternions((sign, first, second), tuple(d for d in definitions if d[0] in used), (), (note,))


def _by_components(relation: tuple[str, Node, Node], known: Collection[str]) -> Quaternions | None:
    """Return the equation ``q = [a, b, c, d]`` of columns for ``q = a + b i + c j + d k``; None for other equations."""
    sign, left, right = relation
    if left.kind != "name" or str(left.value)[0] not in LETTERS or {*UNITS, left.value} & {*known}:
        return None
    parts = _components(right)
    # a scalar part and all three units, which may be bold, are required
    if parts is None or not all(parts):
        return None
    made = column_vector([sum_of(part) for part in parts])
    return Quaternions((sign, left, made), (), (), ("i, j and k are the units of quaternions",))


def _components(node: Node) -> tuple[list[Node], ...] | None:
    """Return four lists: the terms of a formula's scalar part, and those of its coefficients of i, j and k.

    For ``a + s*(x*i + y*j)`` these lists are [a], [s*x], [s*y] and []. Return None if the formula is not linear in i, j
    and k.
    """
    if not names_in(node) & {*UNITS}:
        return [node], [], [], []
    if node.kind == "name":
        return tuple([number(1)] if UNITS[str(node.value)] == place else [] for place in range(4))
    if node.kind not in ("sum", "neg", "product"):
        # not linear
        return None
    parts = [_components(argument) for argument in node.args]
    if any(part is None for part in parts):
        return None
    known = [part for part in parts if part is not None]
    if node.kind == "neg":
        return tuple([negated(term) for term in terms] for terms in known[0])
    if node.kind == "sum":
        return tuple([term for part in known for term in part[place]] for place in range(4))
    scalars = [part for part in known if not any(part[1:])]
    if len(scalars) < len(known) - 1:
        return None  # a product of two quaternions
    (vector,) = (part for part in known if any(part[1:]))
    factors = [sum_of(part[0]) for part in scalars]
    return tuple([product([*factors, term]) for term in terms] for terms in vector)


def _without_squares(node: Node) -> Node:
    args = tuple(map(_without_squares, node.args))
    if node.kind == "power" and args[1] == number(2):
        return product([args[0], args[0]], node.span)
    return replace(node, args=args)


def quaternion_product(left: Node, right: Node) -> Node:
    """Return the tree of the product of two quaternions, with the scalar factors of ``left`` in front.

    The last factor of ``left`` is the quaternion.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> text(quaternion_product(product([Node("inv", None, (number(2),)), Node("name", "q")]), Node("name", "p")))
    '1/2*qmul(q, p)'
    """
    scalars = [factor for factor in left.args[:-1] if left.kind == "product"]
    first = left.args[-1] if left.kind == "product" else left
    return product([*scalars, Node("call", PRODUCT, (first, right))])


def _quaternion_names(
    sides: Sequence[Node], vectors: Collection[str], shapes: Mapping[str, Shape], known: Collection[str]
) -> tuple[str, ...]:
    """Return the names of quaternions in a claim, such as q in ``q v q*``, except names in ``vectors`` and ``known``.

    ``vectors`` are the names of vectors, ``known`` are the names that the claim defines.
    """
    names: dict[str, None] = {}

    def add(node: Node) -> None:
        bare = untimed(node)
        if bare.kind == "name" and bare.value not in (*vectors, *known, "t") and bare.value not in names:
            names[str(bare.value)] = None

    everything = nodes_of(*sides)
    in_text = {str(node.value) for node in everything if node.kind == "name"}
    for node in everything:
        if node.kind == "call" and node.value == PRODUCT:
            for factor in node.args:
                if not (_is_angular(factor) and f"{factor.value}_0" not in in_text):
                    add(factor)
        elif node.kind == "call" and node.value == CONJUGATE:
            add(node.args[0])
    for factor in _unmarked_quaternion(sides):
        add(factor)
    used = {str(node.value) for node in everything if node.kind == "name"}
    for node in everything:
        if node.kind == "call" and node.value == "sqrt" and node.args[0].kind == "call" and node.args[0].value == "dot":
            inner = untimed(node.args[0].args[0])  # the norm of q, of which the text has the conjugate
            if f"{inner.value}_bar" in used:
                add(inner)
        elif node.kind == "call" and node.value == "abs":  # |q|, of which the text has the conjugate
            inner = node.args[0]
            if inner.value in (*USUAL_NAMES, "p") and f"{inner.value}_bar" in used:
                add(inner)
    for side, other in ((sides[0], sides[1]), (sides[1], sides[0])):
        if (rotating := _rotating(side, other)) is not None:
            add(rotating)
        two = side.kind == "product" and len(side.args) == 2 and all(factor.kind == "name" for factor in side.args)
        components = two and all({f"{factor.value}_0", f"{factor.value}0"} & used for factor in side.args)
        if components and _is_list(other):
            for factor in side.args:
                add(factor)
    return tuple(names)


def _unmarked_quaternion(sides: Sequence[Node]) -> Sequence[Node]:
    """Return [q] for equations of a quaternion q without a sign such as ⊗ or a star; () for other equations.

    The equations are ``q' = 1/2 omega q`` and ``v' = q v q``.
    """
    for side, other in ((sides[0], sides[1]), (sides[1], sides[0])):
        factors = [untimed(factor) for factor in other.args if factor.kind != "number" and factor.kind != "inv"]
        if other.kind != "product" or not all(factor.kind == "name" for factor in factors):
            continue
        names = [str(factor.value) for factor in factors]
        rate = untimed(side.args[0]) if is_derivative(side) else side
        moved = {str(rate.value), str(rate.value).removesuffix("_prime")} if rate.kind == "name" else set()
        # for a number q, nobody would write q^2 v as q v q; probably the star of the last q was lost in copying
        is_sandwich = len(names) == 3 and names[0] == names[2] != names[1] and names[1] in moved
        if is_sandwich and names[0].islower():
            return factors[:1]
        own = [factor for factor in factors if not ANGULAR.fullmatch(str(factor.value))]
        is_rate = side.kind == "call" and len(factors) == 2 and len(own) == 1 and own[0] == rate
        if is_rate and str(own[0].value) in USUAL_NAMES:
            return own
    return ()


def _rotating(side: Node, other: Node) -> Node | None:
    """Return q for a side ``q v q^-1`` if the ``other`` side is the rotated vector, written ``R v`` or ``v'``.

    Return None for all other sides.
    """
    if side.kind != "product" or len(side.args) != 3:
        return None
    # numbers commute: nobody would write such a product of numbers
    for first, vector, last in (side.args, side.args[::-1]):
        inverted = last.value == f"{first.value}_bar" or (is_inverse(last) and last.args[0] == first)
        if first.kind != "name" or str(first.value)[0] not in LETTERS or vector.kind != "name" or not inverted:
            continue
        rotated = other.kind == "name" and other != vector and str(other.value)[0] == str(vector.value)[0]
        factors = other.args if other.kind == "product" else ()
        matrix = factors[0].args[0] if len(factors) == 2 and factors[0].kind == "transpose" else (*factors, other)[0]
        mapped = len(factors) == 2 and factors[1] == vector and str(matrix.value)[:1].isupper()
        if rotated or mapped:
            return first
    return None


def _vector_of_pair(node: Node) -> Sequence[Node]:
    """Return [v] for a quaternion written as a pair ``(0, v)`` of a number and a vector; [] for any other node."""
    inside = node.args[0] if node.kind == "call" and node.value == "Matrix" else node
    entries = tuple(row.args[0] if row.kind == "list" and len(row.args) == 1 else row for row in inside.args)
    is_pair = inside.kind == "list" and len(entries) == 2 and entries[1].kind == "name"
    return entries[1:] if is_pair else ()


def _is_list(node: Node) -> bool:
    return node.kind == "list" or (node.kind == "call" and node.value == "Matrix")


class _Products:
    """A rewriter of trees that turns products of quaternions, ``q p``, into ``qmul(q, p)``."""

    def __init__(self, names: Sequence[str], vectors: set[str]) -> None:
        self.names, self.vectors = names, vectors
        self.pure: dict[str, None] = {}

    def shapes(self, others: Mapping[str, Shape]) -> dict[str, Shape]:
        return {**others, **dict.fromkeys((*self.vectors, *self.pure), (3, 1)), **dict.fromkeys(self.names, (4, 1))}

    def is_quaternion(self, node: Node) -> bool:
        bare = untimed(node)
        if bare.kind == "name":
            return bare.value in self.names
        if bare.kind == "power":
            return self.is_quaternion(bare.args[0])
        inner = bare.args[:1] if bare.value == "diff" else ()
        return bare.kind == "call" and (bare.value in (PRODUCT, CONJUGATE) or any(map(self.is_quaternion, inner)))

    def read(self, node: Node) -> Node:
        node = untimed(node)
        if node.kind == "name" and str(node.value).removesuffix("_bar") in self.names:
            name = str(node.value).removesuffix("_bar")
            own = Node("name", name, (), node.span)
            return own if name == node.value else Node("call", CONJUGATE, (own,), node.span)
        if is_inverse(node):
            base = self.read(node.args[0])
            if self.is_quaternion(base):
                norm = Node("call", "dot", (base, base))
                return product([Node("call", CONJUGATE, (base,)), Node("inv", None, (norm,))], node.span)
            return replace(node, args=(base, node.args[1]))
        args = tuple(self.read(child) for child in node.args)
        node = replace(node, args=args)
        if node.kind == "call" and node.value == PRODUCT:
            self.pure |= {str(part.value): None for factor in args for part in _vector_of_pair(factor)}
            self.pure |= {str(factor.value): None for factor in args if self.is_rate(factor)}
        if node.kind == "call" and node.value == "abs" and self.is_quaternion(args[0]):
            return replace(length(args[0]), span=node.span)
        return self.multiplied(node) if node.kind == "product" else node

    def is_rate(self, factor: Node) -> bool:
        """Return whether a factor has the name of an angular velocity, and is not yet known as a quaternion or
        vector.
        """
        return _is_angular(factor) and factor.value not in self.names and factor.value not in self.vectors

    def multiplied(self, node: Node) -> Node:
        """Return a product in which ``qmul`` multiplies the quaternions and the vectors between quaternions.

        Scalar factors stay in front: ``2*q*v*p`` becomes ``2*qmul(qmul(q, v), p)``.
        """
        norms = [part for factor in node.args if factor.kind == "product" for part in factor.args if part.kind == "inv"]
        if norms:  # of an inverse, the conjugate over the square of the norm
            parts = [part for factor in node.args for part in (factor.args if factor.kind == "product" else (factor,))]
            node = replace(node, args=(*norms, *(part for part in parts if part not in norms)))
        places = [n for n, factor in enumerate(node.args) if self.is_quaternion(factor) or _is_angular(factor)]
        if len(places) < 2 or not any(map(self.is_quaternion, node.args)):
            return node
        between = node.args[places[0] : places[-1] + 1]
        for factor in between:
            if factor.kind == "name" and factor.value not in self.names and factor.value not in self.vectors:
                self.pure[str(factor.value)] = None
        value = between[0]
        for factor in between[1:]:
            value = Node("call", PRODUCT, (value, factor), node.span)
        rest = [*node.args[: places[0]], *node.args[places[-1] + 1 :]]
        return product([*rest, value], node.span) if rest else value


def _is_angular(node: Node) -> bool:
    return node.kind == "name" and ANGULAR.fullmatch(str(node.value)) is not None


def _of_one_shape(sides: Sequence[Node], shapes: Mapping[str, Shape]) -> tuple[Node, Node]:
    """Return both sides of an equation, changed so that they have the same number of components.

    If the other side is a quaternion, a scalar s becomes (s, 0, 0, 0). If the other side is a vector, a quaternion is
    replaced by its vector part.
    """
    made = []
    for side, other in ((sides[0], sides[1]), (sides[1], sides[0])):
        own, opposite = shape_of(side, shapes), shape_of(other, shapes)
        if opposite == (4, 1) and own is None and not _is_list(side) and side.kind != "name":
            side = replace(column_vector([side, *[number(0)] * 3]), span=side.span)
        elif own == (4, 1) and opposite in ((3, 1), None) and (opposite or other.kind == "name"):
            # the other side is a vector or a name
            side = Node("call", "vector_part", (side,), side.span)
        made.append(side)
    return made[0], made[1]


def _definitions(name: str, used: Collection[str], moving: bool) -> list[tuple[str, Node]]:
    """Return the definition q = (q_0, q_1, q_2, q_3) of the quaternion ``name``.

    If ``used`` contains a name for its vector part, such as ``q_vec``, the definition of this name is put first. If
    ``moving``, the components are functions of time.
    """
    style = "" if f"{name}0" in used or f"{name}1" in used else "_"
    parts = [
        Node("call", f"{name}{style}{n}", (TIME,)) if moving else Node("name", f"{name}{style}{n}") for n in range(4)
    ]
    own = [(name, column_vector(parts))]

    vector = next((f"{name}{ending}" for ending in ENDINGS if f"{name}{ending}" in used), "")
    return [(vector, column_vector(parts[1:])), *own] if vector else own


def _with_time(node: Node, names: Sequence[str], moving: bool) -> Node:
    """Return a tree with q_1(t) for q_1, and so on for all components of the quaternions ``names``, if ``moving``.

    Otherwise return the tree unchanged.
    """
    components = {f"{name}{style}{n}" for name in names for style in ("", "_") for n in range(4)}
    if moving and node.kind == "name" and node.value in components:
        return Node("call", node.value, (TIME,), node.span)
    return replace(node, args=tuple(_with_time(child, names, moving) for child in node.args))
