"""Splitting formulas such as ``exp(i*x)`` into their real and imaginary parts, as trees.

Two complex formulas are equal exactly if their real parts are equal and their imaginary parts are equal.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from itertools import permutations, repeat
from typing import ClassVar

from symrot.checker.claim.tree import (
    Node,
    column_vector,
    factors_of,
    negated,
    nodes_of,
    number,
    product,
    substituted,
    sum_of,
    without_sign,
)
from symrot.errors import InputError, complaint

__all__ = ["BAR", "imaginary_unit", "is_complex", "open_numbers", "with_numbers", "with_parts"]

Parts = tuple[Node, Node]
ZERO, ONE = number(0), number(1)
LETTERS = ("i", "j", "I")
NUMBERS = ("z", "w", "zeta")
"""Names that are usually complex numbers."""

PAIRS = ("xy", "ab", "cd", "uv", "pq")
"""Pairs of letters, such as "xy", that are usually the real and the imaginary part of a number; they count only if
``x + i*y`` is in a product or power."""

NUMBER = re.compile(rf"({'|'.join(NUMBERS)})(_?[0-9])?")
BAR = "_bar"
"""Ending of the name of a complex conjugate: ``z_bar`` is the conjugate of z."""

OF_COMPLEX = ("real_part", "imaginary_part", "conjugate", "abs")
"""Functions that a formula applies to complex numbers: real part, imaginary part, conjugate and absolute value."""

CIRCULAR, HYPERBOLIC = ("sin", "cos", "tan"), ("sinh", "cosh", "tanh")
OF_MATRICES = ("skew", "transpose", "inverse", "trace", "det", "eye", "cross", "qmul")
"""Names of functions of vectors and matrices: in a formula with one of them, I is the unit matrix, not the imaginary
unit."""
MOST_FACTORS = 16
"""The largest exponent with which a power of a complex number is multiplied out."""


def imaginary_unit(trees: Sequence[Node]) -> Node | None:
    """Return the node of a letter i, j or I that is the imaginary unit, as in ``e^(i x)``; None if there is none."""
    nodes = nodes_of(*trees)
    has_matrices = any(node.kind == "transpose" or node.value in OF_MATRICES for node in nodes)
    below = [part for node in nodes if node.kind == "inv" for part in node.args]
    for letter in LETTERS[: 2 if has_matrices else None]:  # cos(x)*I + (1 - cos(x))*n*n.T has the unit matrix
        for node in nodes:
            # e^(i x) or exp(i x)
            inside = _exponent(node)
            if inside is not None and (own := _letter_in(inside, letter)):
                return own
            is_divisor = letter == "I" and node in below  # 2*I*cos(theta) has a moment of inertia
            # a product with numbers, sines and cosines alone, as in cos(x) + i*sin(x)
            if node.kind == "product" and not is_divisor and (own := _factor_of_sines(node, letter)):
                return own
    return next((own for letter in LETTERS[:2] if (own := _evident(trees, nodes, letter))), None)


def _evident(trees: Sequence[Node], nodes: Sequence[Node], letter: str) -> Node | None:
    """Return the node of the name ``letter``, i or j, if it must be the imaginary unit, as in ``|x + i*y|``; else None.

    ``trees`` are the formulas in which the letter may occur, and ``nodes`` are all nodes of these trees.
    """
    own = next((node for node in nodes if node == Node("name", letter)), None)
    if own is None:
        return None
    has_e = any(_exponent(node) is not None for node in nodes)
    names = {node.value for node in nodes if node.kind == "name"} - ({"pi", "e"} if has_e else {"pi"})
    functions = {str(node.value) for node in nodes if node.kind == "call"}
    # the only letter, as in i^2 = -1
    is_alone = names == {letter} and not any(
        first == own and second.kind == "number" for first, second in permutations(trees, 2)
    )
    # circular and hyperbolic functions, and the letter in the argument of one of them
    has_both = bool(functions & {*CIRCULAR}) and bool(functions & {*HYPERBOLIC}) and any(
        node.kind == "call" and node.value in (*CIRCULAR, *HYPERBOLIC) and _letter_in(node.args[0], letter)
        for node in nodes
    )  # fmt: skip
    sums = [node for node in nodes if node.kind == "sum" and _letter_in(node, letter)]
    # a sum and its conjugate
    has_conjugates = any(_conjugate(node, letter) in sums for node in sums)
    # a sum x + i*y, and Re, Im, a conjugate, bars or a name such as z
    has_parts = any(map(_has_factor, sums, repeat(letter))) and (
        bool(names & {*NUMBERS}) or any(map(_is_of_complex, nodes, repeat(letter)))
    )
    pairs = {*map(frozenset, PAIRS)}
    # x + i*y in a product or power
    has_pairs = any(
        _pair(part, letter) in pairs
        for node in nodes
        if node.kind in ("power", "product", "inv")
        for part in node.args
        if part.kind == "sum"
    )
    is_evident = is_alone or has_both or has_conjugates or has_parts or has_pairs
    return own if is_evident and not functions & {"diff", "Matrix"} else None


def _pair(node: Node, letter: str) -> frozenset[str]:
    """Return the names {x, y} if a sum is ``x + i*y`` or ``x - i*y``, i being the ``letter``; else an empty set."""
    first, *rest = map(without_sign, node.args)
    if len(rest) != 1 or first.kind != "name" or rest[0].kind != "product" or len(rest[0].args) != 2:
        return frozenset()
    names = [str(factor.value) for factor in rest[0].args if factor.kind == "name"]
    return frozenset({str(first.value), *names} - {letter}) if len(names) == 2 and letter in names else frozenset()


def _has_factor(node: Node, letter: str) -> bool:
    """Return whether a sum has a term with the factor ``letter`` and a term without it, as ``x + i*y`` has for i."""
    return len({Node("name", letter) in factors_of(term) for term in node.args}) == 2


def _is_of_complex(node: Node, letter: str) -> bool:
    """Return whether a formula is Re, Im, the conjugate or the absolute value of a number that may be complex.

    ``letter`` is the imaginary unit.
    """
    if node.kind == "name" and str(node.value).endswith(BAR):
        return True
    argument = node.args[0] if node.kind == "call" and node.value in OF_COMPLEX else None
    # a name, as in |z|, or a formula with the imaginary unit, as in Re(x + i*y)
    return argument is not None and (argument.kind == "name" or _letter_in(argument, letter) is not None)


def with_numbers(tree: Node, numbers: Mapping[str, Node]) -> Node:
    """Return a tree in which each name of a complex number is replaced by a formula, its value in ``numbers``.

    With {"z": x + i*y}, ``x + i*y`` replaces z, and ``conjugate(x + i*y)`` replaces z_bar unless ``numbers`` has it
    too.
    """
    conjugates = {f"{name}{BAR}": Node("call", "conjugate", (formula,)) for name, formula in numbers.items()}
    return substituted(tree, {**conjugates, **numbers})


def open_numbers(formulas: Sequence[Node], letter: str = "i") -> dict[str, Node]:
    """Return {"z": ``Re_z + i*Im_z``} for the complex numbers that nothing defines, as z in ``|z|^2 = z z_bar``.

    Return {} if the undefined names may be real numbers. ``letter`` is the imaginary unit i.
    """
    nodes = nodes_of(*formulas)
    names = [str(node.value) for node in nodes if node.kind == "name"]
    calls = [node for node in nodes if node.kind == "call"]
    # only z, w and zeta, with or without a number as in w_1, can be complex numbers
    own = {name for name in names if NUMBER.fullmatch(name)}
    barred = {name.removesuffix(BAR) for name in names if name.endswith(BAR)}
    # with another barred name, z_bar is a coordinate of a centre of mass
    if not barred <= own or any(node.value in ("integrate", "integral_over_body", "qmul", "Matrix") for node in calls):
        return {}
    inside = {node.value: {str(n.value) for n in nodes_of(node.args[0])} for node in calls if node.value in OF_COMPLEX}
    parts = set().union(*(names for call, names in inside.items() if call != "abs"))
    # conjugate, Re or Im is applied to one of them, or one is barred and such a function or an absolute value occurs
    is_evident = bool(own & parts) or (bool(barred) and bool(inside))
    used = [name for name in names if name.removesuffix(BAR) in own]
    if not is_evident or len(used) < 2:
        return {}
    return {
        name: sum_of([Node("name", f"Re_{name}"), product([Node("name", letter), Node("name", f"Im_{name}")])])
        for name in sorted(own)
    }


def _conjugate(node: Node, letter: str) -> Node:
    """Return the conjugate of a sum, in which each term with the imaginary unit ``letter`` changes its sign."""
    return sum_of([negated(term) if _letter_in(term, letter) else term for term in node.args], node.span)


def _exponent(node: Node) -> Node | None:
    """Return x if a formula is exp(x) or e^x; None for any other formula."""
    if node.kind == "call" and node.value == "exp" and node.args:
        return node.args[0]
    is_power = node.kind == "power" and (node.args[0].kind, node.args[0].value) == ("name", "e")
    return node.args[1] if is_power else None


def _letter_in(tree: Node, letter: str) -> Node | None:
    return next((node for node in nodes_of(tree) if node == Node("name", letter)), None)


def _factor_of_sines(node: Node, letter: str) -> Node | None:
    own = [factor for factor in node.args if factor == Node("name", letter)]
    others = [factor for factor in node.args if factor not in own and factor.kind != "number"]
    sines = all(factor.kind == "call" and factor.value in ("sin", "cos") for factor in others)
    return own[0] if own and others and sines else None


def is_complex(sides: Sequence[Node], letter: str) -> bool:
    """Return whether the sides of an equation contain complex numbers: the imaginary unit ``letter``, or Re(z)."""
    return any(
        _letter_in(side, letter) or any(_is_of_complex(node, letter) for node in nodes_of(side)) for side in sides
    )


def with_parts(relation: tuple[str, Node, Node], letter: str, source: str) -> tuple[str, Node, Node]:
    """Return a complex equation with each side as a column (real part, imaginary part).

    A side that is a name alone, such as z in ``z = exp(i*x)``, stays a name; the other side is then its real part alone
    if it has no imaginary part. ``letter`` is the imaginary unit, ``source`` the typed text, for messages.

    Raises
    ------
    InputError
        For a function whose parts are not known, and for a power that is no whole number up to ``MOST_FACTORS``.
    """
    sign, *sides = relation
    split = _Splitter(letter, source)
    if any(side.kind == "name" and side.value != letter for side in sides):
        left, right = (side if side.kind == "name" else _real_or_column(split.parts(side)) for side in sides)
        return sign, left, right
    left_parts, right_parts = (split.parts(side) for side in sides)
    return sign, column_vector(left_parts), column_vector(right_parts)


def _real_or_column(parts: Parts) -> Node:
    return parts[0] if parts[1] == ZERO else column_vector(parts)


def _times(left: Parts, right: Parts) -> Parts:
    (a, b), (c, d) = left, right
    return _plus(_of(a, c), negated(_of(b, d))), _plus(_of(a, d), _of(b, c))


def _of(a: Node, b: Node) -> Node:
    if a == ZERO or b == ZERO:
        return ZERO
    return product([factor for factor in (a, b) if factor != ONE] or [ONE])


def _plus(*terms: Node) -> Node:
    rest = [term for term in terms if without_sign(term) != ZERO]
    return sum_of(rest) if rest else ZERO


def _square(a: Node) -> Node:
    return ZERO if a == ZERO else Node("power", None, (a, number(2)))


class _Splitter:
    """The rules that split formulas into real and imaginary parts; every letter but the imaginary unit is real."""

    def __init__(self, letter: str, source: str) -> None:
        self.letter, self.source = letter, source

    def fail(self, node: Node, expected: str) -> InputError:
        return complaint(self.source, "", node.span[0], expected)

    def parts(self, node: Node) -> Parts:
        if node.kind == "name" and node.value == self.letter:
            return ZERO, ONE
        if (exponent := _exponent(node)) is not None:
            a, b = self.parts(exponent)
            size = Node("call", "exp", (a,))
            return (size, ZERO) if b == ZERO else (_of(ONE if a == ZERO else size, _call("cos", b)),
                                                     _of(ONE if a == ZERO else size, _call("sin", b)))  # fmt: skip
        if _letter_in(node, self.letter) is None:
            return node, ZERO
        inner = [self.parts(child) for child in node.args]
        rule = self.rules.get(node.kind if node.kind != "call" else str(node.value))
        if rule is None:
            raise self.fail(node, "a formula whose real and imaginary parts are known (sum, product, power, exp, sin)")
        return rule(self, node, inner)

    def sum(self, node: Node, inner: Sequence[Parts]) -> Parts:
        return _plus(*(a for a, _ in inner)), _plus(*(b for _, b in inner))

    def negative(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return negated(a), negated(b)

    def product(self, node: Node, inner: Sequence[Parts]) -> Parts:
        return reduce(_times, inner)

    def inverse(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        if a == ZERO:
            return ZERO, negated(Node("inv", None, (b,)))
        below = Node("inv", None, (_plus(_square(a), _square(b)),))
        return _of(a, below), negated(_of(b, below))

    def power(self, node: Node, inner: Sequence[Parts]) -> Parts:
        base, (exponent, imaginary) = inner
        negative = exponent.kind == "neg"
        value = exponent.args[0] if negative else exponent
        whole = value.kind == "number" and value.value.denominator == 1 and 0 < value.value <= MOST_FACTORS
        if not whole or imaginary != ZERO:
            raise self.fail(node, f"a whole number up to {MOST_FACTORS} as the power of a complex number")
        raised = reduce(_times, [base] * int(value.value))
        return self.inverse(node, [raised]) if negative else raised

    def absolute(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return Node("call", "sqrt", (_plus(_square(a), _square(b)),)), ZERO

    def real_part(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, _),) = inner
        return a, ZERO

    def imaginary_part(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((_, b),) = inner
        return b, ZERO

    def conjugate(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return a, negated(b)

    def angle(self, node: Node, inner: Sequence[Parts]) -> Parts:
        if any(b != ZERO for _, b in inner):
            raise self.fail(node, "real numbers in atan2")
        return Node("call", "atan2", tuple(a for a, _ in inner)), ZERO

    def sine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("sin", a), _call("cosh", b)), _of(_call("cos", a), _call("sinh", b))

    def cosine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("cos", a), _call("cosh", b)), negated(_of(_call("sin", a), _call("sinh", b)))

    def hyperbolic_sine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("sinh", a), _call("cos", b)), _of(_call("cosh", a), _call("sin", b))

    def hyperbolic_cosine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("cosh", a), _call("cos", b)), _of(_call("sinh", a), _call("sin", b))

    def tangent(self, node: Node, inner: Sequence[Parts]) -> Parts:
        return _times(self.sine(node, inner), self.inverse(node, [self.cosine(node, inner)]))

    def hyperbolic_tangent(self, node: Node, inner: Sequence[Parts]) -> Parts:
        return _times(self.hyperbolic_sine(node, inner), self.inverse(node, [self.hyperbolic_cosine(node, inner)]))

    rules: ClassVar[Mapping[str, Callable[["_Splitter", Node, Sequence[Parts]], Parts]]] = {
        "sum": sum, "neg": negative, "product": product, "inv": inverse, "power": power, "abs": absolute,
        "real_part": real_part, "imaginary_part": imaginary_part, "conjugate": conjugate, "sin": sine,
        "atan2": angle,
        "cos": cosine, "sinh": hyperbolic_sine, "cosh": hyperbolic_cosine, "tan": tangent, "tanh": hyperbolic_tangent,
    }  # fmt: skip
    """Maps the kind of a formula, or the name of the function that it calls, to the rule for its real and imaginary
    part."""


def _call(name: str, argument: Node) -> Node:
    return Node("call", name, (argument,))
