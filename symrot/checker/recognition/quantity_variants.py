"""Faults on the side of a claim that names its quantity: ``k = I/m`` for ``k^2 = I/m``, cos(gamma) for cos(gamma/2)."""

from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula, is_name_or_rate
from symrot.checker.claim.tree import Node, negated, number, product, sum_of
from symrot.checker.recognition.evidence import LEAST_SYMBOLS_EDITED, names_in, quantity_name
from symrot.checker.repair.edits import COST, OPPOSITE, scaled

__all__ = ["QuantityVariant", "is_evident_by_quantity", "quantity_variants", "without_inverse"]

TWO = number(2)
FUNCTION_OF = {"acos": "cos", "asin": "sin"}
"""Inverse function -> the function."""


class QuantityVariant(NamedTuple):
    """Both sides of a claim after a fault on the quantity's side is undone, with the fault's code and cost."""

    side: Node
    formula: Node
    code: str
    cost: float


def quantity_variants(named: NamedFormula) -> Iterator[QuantityVariant]:
    """Yield the claim ``named`` with a usual fault undone on the quantity's side: ``k^2 = I/m`` for ``k = I/m``."""
    side, formula = named.side, named.formula
    if side.kind == "call" and side.value in OPPOSITE and is_name_or_rate(side.args[0]):
        (angle,) = side.args
        for multiple, code in ((Fraction(1, 2), "half_angle"), (Fraction(2), "double_half_angle")):
            yield QuantityVariant(Node("call", side.value, (scaled(angle, multiple),)), formula, code, COST[code])
        other = Node("call", OPPOSITE[side.value], (angle,))
        yield QuantityVariant(other, formula, "sin_cos_swap", COST["sin_cos_swap"])
    if side.kind == "power" and side.args[1] == TWO and is_name_or_rate(side.args[0]):
        yield QuantityVariant(side.args[0], formula, "exponent", COST["exponent"])
    if is_name_or_rate(side):
        square = _square_of(side)
        yield QuantityVariant(square, formula, "exponent", COST["exponent"])
        terms = [term.args[0] if term.kind == "neg" else term for term in formula.args]
        if formula.kind == "sum" and all(map(is_name_or_rate, terms)):
            squares = [negated(_square_of(t.args[0])) if t.kind == "neg" else _square_of(t) for t in formula.args]
            yield QuantityVariant(square, sum_of(squares), "exponent", COST["exponent"])


def without_inverse(named: NamedFormula) -> NamedFormula | None:
    """Return the claim ``cos(theta/2) = u`` for ``theta = 2*acos(u)``; None for a formula of another form.

    Its ``solve`` puts a formula in place of u in ``2*acos(u)``.
    """
    # acos(u) has no value at most random values of u
    factors = named.formula.args if named.formula.kind == "product" else (named.formula,)
    calls = [factor for factor in factors if factor.kind == "call" and factor.value in FUNCTION_OF]
    others = [factor for factor in factors if factor not in calls]
    if len(calls) != 1 or not is_name_or_rate(named.side) or any(factor.kind != "number" for factor in others):
        return None
    (call,) = calls
    angle = product([named.side, Node("inv", None, (product(others),))]) if others else named.side

    def solve(inside: Node) -> Node:
        return product([*others, Node("call", call.value, (inside,))])

    side = Node("call", FUNCTION_OF[str(call.value)], (angle,))
    return named._replace(side=side, formula=call.args[0], solve=solve)


def _square_of(tree: Node) -> Node:
    return Node("power", None, (tree, TWO))


def is_evident_by_quantity(claim: Claim, named: NamedFormula, changed: QuantityVariant) -> bool:
    """Return whether the author of a claim probably means the corrected claim ``changed``."""
    letters = names_in(named.formula)
    stem = named.name.partition("_")[0]
    # such as k = k_bar + d
    if any(letter.partition("_")[0] == stem for letter in letters) and changed.formula != named.formula:
        return True
    is_stated = claim.context.meaning_of(quantity_name(named)) is not None
    return len(letters) >= LEAST_SYMBOLS_EDITED + (0 if is_stated else 1)
