"""Solving an equation for one of its quantities, on the tree: ``k^2 = I/m`` for k, ``m x'' + k x = 0`` for x''."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import partial, reduce

from symrot.checker.claim.tree import (
    Node,
    factors_of,
    is_derivative,
    is_name,
    is_rate,
    negated,
    nodes_of,
    number,
    product,
    quotient,
    sum_of,
)

__all__ = [
    "Quantity", "Solve", "is_name_or_rate", "quantities_in", "solution", "terms_of", "with_highest_rate",
    "without_common_factors",
]  # fmt: skip

Solve = Callable[[Node], Node]
"""A function that solves an equation for a quantity: from the right side to a formula. To solve ``2*k^2 = I`` for k, it
takes I and returns ``(I/2)^(1/2)``."""

Quantity = tuple[str, bool]
"""A pair of a name and whether a time derivative is meant: ("x", False) is x, and ("x", True) is dx/dt or x''."""

INVERSES = {"sin": "asin", "cos": "acos", "tan": "atan", "exp": "log", "log": "exp"}
"""Maps a function to the inverse function, by which an equation is solved for the argument."""


def is_name_or_rate(tree: Node) -> bool:
    """Return whether a tree is a name, a function of time such as ``theta(t)``, or a time derivative of one."""
    return is_name(tree) or is_rate(tree)


def quantities_in(tree: Node) -> set[Quantity]:
    """Return the quantities in a tree, each as (name, whether its time derivative is meant).

    For ``x + dx/dt``, return {("x", False), ("x", True)}. The number pi does not count as a quantity.
    """
    if is_rate(tree):
        return {(str(tree.args[0].value), True)}
    if is_name(tree):
        return set() if tree.value == "pi" else {(str(tree.value), False)}
    return {quantity for part in tree.args for quantity in quantities_in(part)}


def solution(side: Node) -> tuple[Quantity, Solve] | None:
    """Return the only quantity (or the only rate) on a side of an equation, and a function that solves for it.

    For the side ``2*k^2`` these are k and a function that turns the other side, I, into ``(I/2)^(1/2)``. Return None if
    the side has no quantity or several, or an operation that symrot does not invert, such as a sum.
    """
    steps: list[Solve] = []
    while not is_name_or_rate(side):
        inner = side.args[0] if side.args else side
        if side.kind == "neg":
            steps.append(negated)
        elif side.kind == "product":
            factors = [factor for factor in side.args if quantities_in(factor)]
            rates = [factor for factor in factors if any(of_rate for _, of_rate in quantities_in(factor))]
            own = rates if len(rates) == 1 else factors
            if len(own) != 1:
                return None
            (inner,) = own
            steps.append(partial(_over, product([factor for factor in side.args if factor is not inner])))
        elif side.kind == "power" and side.args[1].kind == "number" and side.args[1].value:
            steps.append(partial(_to_power, 1 / side.args[1].value))
        elif side.kind == "inv":
            steps.append(partial(_to_power, Fraction(-1)))
        elif side.kind == "call" and side.value == "sqrt":
            steps.append(partial(_to_power, Fraction(2)))
        elif side.kind == "call" and side.value in INVERSES and len(side.args) == 1:
            steps.append(partial(_called, INVERSES[side.value]))
        else:
            return None
        side = inner
    return next(((quantity, partial(_after, steps)) for quantity in quantities_in(side)), None)


def _over(divisor: Node, tree: Node) -> Node:
    return quotient(tree, divisor)


def _to_power(exponent: Fraction, tree: Node) -> Node:
    return Node("power", None, (tree, number(exponent)))


def _called(function: str, tree: Node) -> Node:
    return Node("call", function, (tree,))


def _after(steps: Sequence[Solve], tree: Node) -> Node:
    """Return the result of applying ``steps`` to a tree, one after the other; each step returns a changed tree."""
    return reduce(lambda made, step: step(made), steps, tree)


def without_common_factors(left: Node, right: Node) -> tuple[Node, Node]:
    """Return both sides without the letters that are factors of both sides, such as m in ``m*v**2/2 == m*g*h``."""
    factors = [list(side.args) if side.kind == "product" else [side] for side in (left, right)]
    for factor in [*factors[0]]:
        if factor in factors[1] and is_name(factor) and quantities_in(factor):
            factors[0].remove(factor)
            factors[1].remove(factor)
    return product(factors[0]), product(factors[1])


def with_highest_rate(left: Node, right: Node) -> tuple[Node, Node, Node] | None:
    """Return (x'', m, -k*x) for ``m*x'' + k*x = 0``: the highest derivative, its coefficient, and the right side.

    The right side is the sum of the terms without the highest derivative, moved to the right. Return None unless the
    equation is linear in a single highest derivative, and all derivatives are time derivatives of single names. Return
    None also if the terms without the highest derivative are mere numbers.
    """
    terms = [*terms_of(left), *map(negated, terms_of(right))]
    derivatives = {node for node in nodes_of(*terms) if is_derivative(node)}
    order = max((len(node.args) for node in derivatives), default=0)
    highest = [node for node in derivatives if len(node.args) == order]
    # the derivative of a product, sum or function may belong to a rule of differentiation
    if len(highest) != 1 or not all(map(is_rate, derivatives)):
        return None
    (rate,) = highest
    coefficients: list[Node] = []
    rest: list[Node] = []
    for term in terms:
        factors = [*factors_of(term)]
        if rate not in nodes_of(term):
            rest.append(negated(term))
        elif factors.count(rate) == 1:
            factors.remove(rate)
            if rate in nodes_of(*factors):
                return None
            coefficient = product(factors)
            coefficients.append(negated(coefficient) if term.kind == "neg" else coefficient)
        else:
            return None
    return (rate, sum_of(coefficients), sum_of(rest)) if any(map(quantities_in, rest)) else None


def terms_of(tree: Node) -> list[Node]:
    """Return the terms of a sum, [] for the number 0, and [x] for any other tree x."""
    if tree.kind == "sum":
        return list(tree.args)
    return [] if tree == number(0) else [tree]
