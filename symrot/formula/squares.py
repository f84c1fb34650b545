"""Squares under a root: sqrt(u^2) is abs(u), which has a kink where u changes sign. Standard library only."""

from fractions import Fraction

from symrot.formula.polynomial import Polynomial, constant, generator, square_root
from symrot.formula.tree import Node, children, text

__all__ = ["as_polynomial", "square_under_root"]

ONE: Node = ("number", Fraction(1))
MOST_TERMS = 60  # largest number of terms of a polynomial that is tested for being a square


def square_under_root(radicand: Node) -> tuple[Node, Node] | None:
    """Return (u, v) with ``radicand = u^2 v``, whose root is ``abs(u)*sqrt(v)``; None if no square is found."""
    root, rest = _split(radicand)
    # a sum such as t**2 - 2*c*t + c**2 may be the square of a polynomial
    if rest != ONE and (more := _root_of_sum(rest)) is not None:
        root, rest = _joined("*", root, more), ONE
    return None if root == ONE else (root, rest)


def _split(node: Node) -> tuple[Node, Node]:
    """Return (u, v) with ``node = u^2 v``: (a, b) for ``a**2*b``; u is 1 if no factor is written as a square."""
    kind = node[0]
    if kind in ("*", "/"):
        (a, v), (b, w) = map(_split, children(node))
        return _joined(kind, a, b), _joined(kind, v, w)
    if kind == "**" and node[2] >= 2:
        half = node[2] // 2
        root: Node = node[1] if half == 1 else ("**", node[1], half)
        return root, node[1] if node[2] % 2 else ONE
    return ONE, node


def _joined(kind: str, left: Node, right: Node) -> Node:
    if right == ONE:
        return left
    return right if left == ONE and kind == "*" else (kind, left, right)


def _root_of_sum(node: Node) -> Node | None:
    """Return the polynomial whose square is the formula ``node``; None for a number, or if it is not found."""
    generators: dict[str, Node] = {}
    polynomial = as_polynomial(node, generators)
    if polynomial is None or len(polynomial.terms) > MOST_TERMS or set(polynomial.terms) <= {()}:
        return None
    try:
        root = square_root(polynomial)
    except ValueError:
        return None
    return _node(root, generators)


def as_polynomial(node: Node, generators: dict[str, Node]) -> Polynomial | None:
    """Return a formula as a polynomial in its symbols and function calls; None for ``1/x`` or a very long polynomial.

    ``generators`` gets an entry for each symbol and call: ``"cos(x)"`` and its formula tree.
    """
    kind = node[0]
    if kind == "number":
        return constant(node[1])
    if kind in ("symbol", "call"):
        name = text(node)
        generators[name] = node
        return generator(name)
    parts = [as_polynomial(child, generators) for child in children(node)]
    if any(part is None or len(part.terms) > MOST_TERMS for part in parts):
        return None
    first, *others = (part for part in parts if part is not None)
    if kind == "neg":
        return -first
    if kind == "**":
        return _power(first, node[2]) if 0 <= node[2] <= 8 else None
    (second,) = others
    if kind == "/":
        return first / second if set(second.terms) == {()} else None
    return first * second if kind == "*" else first + second if kind == "+" else first - second


def _power(base: Polynomial, exponent: int) -> Polynomial | None:
    """Return a power of a polynomial; None if a lower power has more than MOST_TERMS terms."""
    power = constant(1)
    for _ in range(exponent):
        if len(power.terms) > MOST_TERMS:
            return None
        power = power * base
    return power


def _node(polynomial: Polynomial, generators: dict[str, Node]) -> Node:
    total: Node | None = None
    for monomial, coefficient in sorted(polynomial.terms.items()):
        factors: list[Node] = [("number", coefficient)] if coefficient != 1 or not monomial else []
        factors += [generators[name] if power == 1 else ("**", generators[name], power) for name, power in monomial]
        product = factors[0]
        for factor in factors[1:]:
            product = ("*", product, factor)
        total = product if total is None else ("+", total, product)
    assert total is not None
    return total
