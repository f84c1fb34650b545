"""Letters that books use for the matrix of a vector: K for the skew matrix of k, ``Ω(ω)`` for the matrix of rates.

In ``R = I + sin θ K + (1 - cos θ) K^2``, Rodrigues' formula, K is the skew matrix of a unit vector k, and the matrix
exponential of θ K is R. In ``q' = 1/2 Ω(ω) q``, the product ``Ω(ω) q`` is the quaternion product of q and (0, ω).
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import NamedTuple

from symrot import symbols
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import (
    Node,
    factors_of,
    is_derivative,
    names_in,
    negated,
    nodes_of,
    number,
    product,
    quotient,
    substituted,
    text,
    untimed,
)
from symrot.checker.claim.vectors import Vector, length
from symrot.exact.printing import as_text
from symrot.kinematics.rotation_vector import dcm_of_axis_angle

__all__ = ["WithMatrices", "with_matrices_of_vectors"]

SKEW_LETTER = re.compile(r"[A-DF-HJ-Z]|Omega")
"""Pattern of the letters that may be skew matrices: Ω and all capitals but E and I, which are unit matrices."""

UNITS = ("I", "E", "I_3", "E_3")
"""Names of unit matrices."""

ANGLES = re.compile(r"(var)?(theta|phi)|alpha|beta|gamma|psi|delta")
"""Pattern of the names of angles in exponents, such as θ in ``R = e^(θ K)``."""

ROTATION = re.compile(r"[RCQA](_\w+)?")
"""Pattern of the names of rotation matrices, such as R in ``R = e^(θ K)``."""

OMEGA = ("omega", "w")
"""Names of the angular velocity ω in ``Ω(ω)``, the matrix in ``q' = 1/2 Ω(ω) q``."""


class WithMatrices(NamedTuple):
    """An equation, ``relation``, in which formulas of vectors replace letters of matrices, such as ``skew(k)`` for K.

    ``vectors`` are the unit vectors that the replacement adds, such as k; ``notes`` tell the user how letters are read.
    """

    relation: tuple[str, Node, Node]
    vectors: tuple[Vector, ...] = ()
    letters: tuple[str, ...] = ()  # letters that mean matrices or quaternions: no vectors, though they may be bold
    notes: tuple[str, ...] = ()
    written: tuple[tuple[Node, Node], ...] = ()  # rotation matrices, each with the exponential that it stands for


def with_matrices_of_vectors(
    relation: tuple[str, Node, Node], vectors: Sequence[Vector], known: Collection[str]
) -> WithMatrices:
    """Return an equation in which a letter for the skew matrix or rate matrix of a vector is replaced by a formula.

    In ``R = I + sin θ K + (1 - cos θ) K^2``, ``skew(k)`` replaces K. In ``q' = 1/2 Ω(ω) q``, the quaternion product of
    q and (0, ω) replaces ``Ω(ω) q``. Other equations stay as they are.

    Parameters
    ----------
    relation : Relation
    vectors : sequence of Vector
        The vectors of the equation; those with a hat have the length 1.
    known : collection of str
        The names that the claim defines; they stay.
    """
    if (rates := _with_rate_matrix(relation, known)) is not None:
        letters_of_rates = ("q", "p", "beta", "epsilon", "Omega")
        note = "Ω(ω) q is read as the product of the quaternions q and (0, ω)"
        return WithMatrices(rates, (), letters_of_rates, (note,))
    sign, *sides = relation
    hats = {vector.name for vector in vectors if vector.unit and not vector.is_axis}
    is_rotation = any(
        (side.kind == "name" and ROTATION.fullmatch(str(side.value))) or _exponent(side) is not None for side in sides
    )
    sums = [node for node in nodes_of(*sides) if is_rotation and node.kind == "sum"]
    letters = dict.fromkeys(name for node in sums for name in _skew_letters(node, hats, known))
    letters |= dict.fromkeys(_in_exponents(sides, hats, known))
    used = names_in(*sides)
    of_axes = {name for name in used for node in sums for term in node.args if _is_outer(factors_of(term), name)}
    axes = {name: name if name in hats else _axis_name(name, used - of_axes) for name in letters}
    made = [_rewritten(side, axes) for side in sides]
    if made == sides:
        return WithMatrices(relation)
    notes = [f"{name} is read as the skew matrix of the unit vector {axis}" for name, axis in axes.items()]
    new = tuple(Vector(axis, unit=True) for axis in dict.fromkeys(axes.values()) if axis not in hats)
    letters_of_matrices = tuple(name for name in axes if name not in hats)
    written = tuple(pair for side in sides for pair in _exponentials(side, axes))
    return WithMatrices((sign, made[0], made[1]), new, letters_of_matrices, tuple(notes), written)


def _axis_name(letter: str, used: Collection[str]) -> str:
    """Return a name for the vector whose skew matrix is ``letter``: k for K, or n if k is in ``used``."""
    return letter.lower() if letter.lower() not in used else "n"


def _skew_letters(node: Node, hats: Collection[str], known: Collection[str]) -> Iterator[str]:
    """Yield the letter of a skew matrix in a sum of Rodrigues' form, K in ``I + sin(theta)*K + (1 - cos(theta))*K^2``.

    Nothing is yielded for other sums. A letter may be a skew matrix if it is one of ``hats``, the names with a hat, or
    if it is Ω or a capital other than E and I. The names in ``known``, which the claim defines, are never yielded.
    """
    terms = [factors_of(term) for term in node.args]
    has_unit = any(factor.value in UNITS or factor == number(1) for term in terms for factor in term)
    by_name: dict[str, list[set[str]]] = {}
    for term in terms:
        functions = {f"{part.value}({part.args[0]})" for part in nodes_of(*term)
                     if part.kind == "call" and part.value in ("sin", "cos")}  # fmt: skip
        for factor in term:
            name = _name_of(factor)
            if name not in known and (name in hats or SKEW_LETTER.fullmatch(name)):
                by_name.setdefault(name, []).append(functions)
    for name, functions_of_terms in by_name.items():
        # a term with the sine, and one with the cosine
        kinds = {text[:3] for functions in functions_of_terms for text in functions}
        outer = any(_is_outer(term, name.lower()) for term in terms)
        if has_unit and ((len(functions_of_terms) > 1 and kinds == {"sin", "cos"}) or (outer and kinds == {"sin"})):
            yield name


def _name_of(factor: Node) -> str:
    """Return the name K for a factor ``K``, ``K^3`` or ``dot(K, K)``; return "" for a factor without such a name.

    ``K^2`` has become ``dot(K, K)`` if the text marks K as a vector.
    """
    if factor.kind == "call" and factor.value == "dot" and factor.args[0] == factor.args[1]:
        factor = factor.args[0]
    base = factor.args[0] if factor.kind == "power" else factor
    return str(base.value) if base.kind == "name" else ""


def _is_outer(term: Sequence[Node], name: str) -> bool:
    """Return whether the factors of a term end with ``k k^T`` for the name k."""
    own = Node("name", name)
    return tuple(term[-2:]) == (own, Node("transpose", None, (own,)))


def _exponent(node: Node) -> Node | None:
    """Return the exponent of a power of e, or of a call of exp; None for any other formula."""
    if node.kind == "power" and node.args[0] == Node("name", "e"):
        return node.args[1]
    return node.args[0] if node.kind == "call" and node.value == "exp" and len(node.args) == 1 else None


def _in_exponents(sides: Sequence[Node], hats: Collection[str], known: Collection[str]) -> Iterator[str]:
    """Yield the letter K of a skew matrix for each exponent that is a product of K and an angle, such as ``theta*K``.

    ``hats`` are the names with a hat: such a K is yielded from any exponent. A letter K without a hat is yielded only
    if the equation is ``R = e^(theta K)``. ``known`` are the names that the claim defines; they are never yielded.
    """
    for side, other in (sides, sides[::-1]):
        names_rotation = other.kind == "name" and ROTATION.fullmatch(str(other.value)) is not None
        for node in nodes_of(side):
            exponent = _exponent(node)
            factors = factors_of(exponent) if exponent is not None else ()
            if len(factors) == 2 and any(ANGLES.fullmatch(str(factor.value)) for factor in factors):
                for name in map(_name_of, factors):
                    is_letter = names_rotation and node is side and SKEW_LETTER.fullmatch(name) is not None
                    if name not in known and (name in hats or is_letter):
                        yield name


def _rewritten(tree: Node, axes: Mapping[str, str]) -> Node:
    """Return a tree with ``skew(k)`` in place of K and a rotation matrix in place of an exponential such as
    ``e^(theta*K)``.

    ``axes`` maps the name K of a skew matrix to the name k of its vector. If K^2 was read as the scalar product
    ``dot(K, K)``, it becomes ``skew(k)^2``. In a sum with a skew matrix, a term E becomes the unit matrix I.
    """
    if (rotation := _rotation_of_exponential(tree, axes)) is not None:
        return rotation
    if tree.kind == "call" and tree.value == "dot" and _name_of(tree) in axes:
        return Node("power", None, (_rewritten(tree.args[0], axes), number(2)), tree.span)
    if tree.kind == "name" and tree.value in axes:
        return Node("call", "skew", (Node("name", axes[str(tree.value)], (), tree.span),), tree.span)
    if tree.kind == "call" and tree.value == "skew" and tree.args[0].kind == "name":
        return tree
    made = replace(tree, args=tuple(_rewritten(child, axes) for child in tree.args))
    is_sum = made.kind == "sum" and any(node.value == "skew" for node in nodes_of(made))
    return _with_unit(made) if is_sum else made


def _rotation_of_exponential(tree: Node, axes: Mapping[str, str]) -> Node | None:
    """Return the tree of the rotation matrix for ``exp(theta*K)`` and ``exp(skew(v))``; None for other formulas.

    ``axes`` maps the name K of a skew matrix to the name k of its vector.
    """
    exponent = _exponent(tree)
    if exponent is None:
        return None
    factors = factors_of(exponent)
    signed = negated if exponent.kind == "neg" else (lambda angle: angle)
    if len(factors) == 1 and factors[0].value == "skew" and factors[0].args[0].kind == "name":
        (vector,) = factors[0].args
        return _rotation(vector, signed(length(vector)), length(vector))
    for matrix, angle in (factors, factors[::-1]) if len(factors) == 2 else ():
        axis = axes.get(_name_of(matrix))
        vector = Node("name", axis) if axis else matrix.args[0] if matrix.value == "skew" else number(0)
        if vector.kind == "name":
            return _rotation(vector, signed(angle))
    return None


def _exponentials(tree: Node, axes: Mapping[str, str]) -> Iterator[tuple[Node, Node]]:
    """Yield (rotation matrix, exponential) for each exponential of a skew matrix in a tree, such as ``e^(theta*K)``.

    ``axes`` maps the name K of a skew matrix to the name k of its vector.
    """
    for node in nodes_of(tree):
        if (rotation := _rotation_of_exponential(node, axes)) is not None:
            yield read_expression(text(rotation)), node


def _with_unit(tree: Node) -> Node:
    """Return a sum of matrices with the unit matrix I in place of each term that is the name E."""
    unit = Node("name", "I")
    terms = [unit if term.value == "E" and term.kind == "name" else term for term in tree.args]
    return replace(tree, args=tuple(terms))


@cache
def _derived_rotation() -> Node:
    return read_expression(as_text(dcm_of_axis_angle()))


def _rotation(axis: Node, angle: Node, size: Node | None = None) -> Node:
    """Return the tree of the rotation matrix about ``axis``, the exponential of angle times skew matrix.

    ``size`` is the length of ``axis``, by default 1.
    """
    components = [Node("index", None, (axis, number(n))) for n in range(3)]
    if size is not None:
        components = [quotient(component, size) for component in components]
    places = {symbol.name: component for symbol, component in zip(symbols.axis, components, strict=True)}
    return substituted(_derived_rotation(), {**places, symbols.alpha.name: angle})


def _with_rate_matrix(relation: tuple[str, Node, Node], known: Collection[str]) -> tuple[str, Node, Node] | None:
    """Return ``q' = 1/2 q (0, ω)``, a product of quaternions, for ``q' = 1/2 Ω(ω) q``; None for other equations."""
    sign, left, right = relation
    rated = left.args[0] if is_derivative(left) and len(left.args) == 2 else left
    name = str(rated.value).removesuffix("_dot")
    if re.fullmatch("[qp]|beta|epsilon", name) is None or rated.value == name == left.value or "Omega" in known:
        return None
    factors = right.args if right.kind == "product" else (right,)
    for place in range(len(factors)):
        omega, rest = _argument(factors, place)
        if omega is None or len(rest) != 1 or untimed(rest[0]) != Node("name", name):
            continue
        pair = Node("list", ("(", ")"), (number(0), omega))
        return sign, left, product([*factors[:place], Node("call", "qmul", (rest[0], pair))])
    return None


def _argument(factors: Sequence[Node], place: int) -> tuple[Node | None, Sequence[Node]]:
    """Return ω and the factors after ``Ω(ω)`` if the factor at ``place`` is ``Ω(ω)``; else (None, ()).

    ``Ω(ω)`` may be a call, or two factors.
    """
    factor, after = factors[place], factors[place + 1 :]
    if factor.kind == "call" and factor.value == "Omega" and len(factor.args) == 1 and factor.args[0].value in OMEGA:
        return factor.args[0], after
    if factor == Node("name", "Omega") and after and after[0].kind == "name" and after[0].value in OMEGA:
        return after[0], after[1:]
    return None, ()
