"""The real and imaginary parts of formulas such as ``exp(i*x)``, as trees: equal formulas have equal parts."""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import ClassVar

from symrot.checker.claim.tree import Node, negated, number, product, sum_of, walk
from symrot.errors import InputError, complaint

__all__ = ["imaginary_unit", "with_parts"]

Parts = tuple[Node, Node]
ZERO, ONE = number(0), number(1)
LETTERS = ("i", "j", "I")
MOST_FACTORS = 16
"""The highest power of a complex number that is multiplied out."""


def imaginary_unit(trees: Sequence[Node]) -> Node | None:
    """Return a letter i, j or I that is the imaginary unit, where it occurs; None if no formula has one.

    It is in an exponent of e or in exp(..), or it is a factor of nothing but numbers and sines.
    """
    for letter in LETTERS:
        for tree in trees:
            for _, node in walk(tree):
                inside = _exponent(node)
                if inside is not None and (own := _letter_in(inside, letter)):
                    return own
                if node.kind == "product" and (own := _factor_of_sines(node, letter)):
                    return own
    return None


def _exponent(node: Node) -> Node | None:
    """Return x of exp(x) and of e^x; None for any other formula."""
    if node.kind == "call" and node.value == "exp" and node.args:
        return node.args[0]
    is_power = node.kind == "power" and (node.args[0].kind, node.args[0].value) == ("name", "e")
    return node.args[1] if is_power else None


def _letter_in(tree: Node, letter: str) -> Node | None:
    return next((node for _, node in walk(tree) if (node.kind, node.value) == ("name", letter)), None)


def _factor_of_sines(node: Node, letter: str) -> Node | None:
    own = [factor for factor in node.args if (factor.kind, factor.value) == ("name", letter)]
    others = [factor for factor in node.args if factor not in own and factor.kind != "number"]
    sines = all(factor.kind == "call" and factor.value in ("sin", "cos") for factor in others)
    return own[0] if own and others and sines else None


def with_parts(relation: tuple[str, Node, Node], letter: str, source: str) -> tuple[str, Node, Node]:
    """Return the equation of the real and imaginary parts of both sides, as columns of two entries.

    A side that is a single name stays as it is: the equation only names the other side.

    Raises
    ------
    InputError
        For a function whose parts are not known.
    """
    sign, *sides = relation
    split = _Splitter(letter, source)
    if any(side.kind == "name" and side.value != letter for side in sides):
        left, right = (side if side.kind == "name" else _column(split.parts(side)) for side in sides)
        return sign, left, right
    left_parts, right_parts = (split.parts(side) for side in sides)
    return sign, _column(left_parts), _column(right_parts)


def _column(parts: Parts) -> Node:
    return Node("call", "Matrix", (Node("list", ("[", "]"), parts),))


def _is_zero(tree: Node) -> bool:
    return tree == ZERO


def _times(left: Parts, right: Parts) -> Parts:
    (a, b), (c, d) = left, right
    return _plus(_of(a, c), negated(_of(b, d))), _plus(_of(a, d), _of(b, c))


def _of(a: Node, b: Node) -> Node:
    if _is_zero(a) or _is_zero(b):
        return ZERO
    return product([factor for factor in (a, b) if factor != ONE] or [ONE])


def _plus(*terms: Node) -> Node:
    rest = [term for term in terms if not _is_zero(term.args[0] if term.kind == "neg" else term)]
    return sum_of(rest) if rest else ZERO


def _square(a: Node) -> Node:
    return ZERO if _is_zero(a) else Node("power", None, (a, number(2)))


class _Splitter:
    """The rules by which formulas are split into parts; every letter other than the imaginary unit is real."""

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
            return (size, ZERO) if _is_zero(b) else (_of(ONE if _is_zero(a) else size, _call("cos", b)),
                                                     _of(ONE if _is_zero(a) else size, _call("sin", b)))  # fmt: skip
        inner = [self.parts(child) for child in node.args]
        if all(_is_zero(imaginary) for _, imaginary in inner):
            return node, ZERO
        rule = self.rules.get(node.kind if node.kind != "call" else str(node.value))
        if rule is None:
            raise self.fail(node, "a formula whose real and imaginary parts are known, such as exp, sin and powers,")
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
        below = Node("inv", None, (_plus(_square(a), _square(b)),))
        return _of(a, below), negated(_of(b, below))

    def power(self, node: Node, inner: Sequence[Parts]) -> Parts:
        base, (exponent, imaginary) = inner
        negative = exponent.kind == "neg"
        value = exponent.args[0] if negative else exponent
        whole = value.kind == "number" and value.value.denominator == 1 and 0 < value.value <= MOST_FACTORS
        if not whole or not _is_zero(imaginary):
            raise self.fail(node, f"a whole number up to {MOST_FACTORS} as the power of a complex number")
        raised = reduce(_times, [base] * int(value.value))
        return self.inverse(node, [raised]) if negative else raised

    def absolute(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return Node("call", "sqrt", (_plus(_square(a), _square(b)),)), ZERO

    def sine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("sin", a), _call("cosh", b)), _of(_call("cos", a), _call("sinh", b))

    def cosine(self, node: Node, inner: Sequence[Parts]) -> Parts:
        ((a, b),) = inner
        return _of(_call("cos", a), _call("cosh", b)), negated(_of(_call("sin", a), _call("sinh", b)))

    rules: ClassVar[Mapping[str, Callable[["_Splitter", Node, Sequence[Parts]], Parts]]] = {
        "sum": sum, "neg": negative, "product": product, "inv": inverse, "power": power, "abs": absolute, "sin": sine,
        "cos": cosine,
    }  # fmt: skip
    """Kind of a formula, or the function that it calls -> the rule for its parts."""


def _call(name: str, argument: Node) -> Node:
    return Node("call", name, (argument,))
