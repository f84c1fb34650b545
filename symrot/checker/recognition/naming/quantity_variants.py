"""Variants of a claim ``quantity = formula``: the quantity with a usual fault corrected, or squares of vectors written
out.

For the radius of gyration k, ``k = I/m`` becomes ``k^2 = I/m``: the square was missing. In a formula with sigma_1,
sigma_2 and sigma_3, components of a vector, ``sigma^2`` becomes the sum of their squares.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.solving import is_name_or_rate
from symrot.checker.claim.tree import TIME, Node, exchanged, negated, number, product, sum_of, text, walk
from symrot.checker.recognition.naming.evidence import LEAST_SYMBOLS_EDITED
from symrot.checker.recognition.naming.quantities import names_in, quantity_name
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import OPPOSITE
from symrot.checker.repair.edits.trees import scaled, square_of
from symrot.checker.verdict import Verdict

__all__ = ["by_lengths", "is_evident_by_quantity", "quantity_variants", "without_inverse"]

TWO = number(2)
FUNCTION_OF = {"acos": "cos", "asin": "sin"}
"""Inverse function -> the function."""

AXES = ("123", "xyz")
"""The indices of the three components of a vector, as numbers or as letters."""


class QuantityVariant(NamedTuple):
    """A corrected claim, whose left side (the quantity) was faulty: ``k^2 = I/m`` in place of ``k = I/m``.

    ``side`` is the corrected k^2, ``formula`` the other side. ``code`` names the fault; rarer faults have a larger
    ``cost``.
    """

    side: Node
    formula: Node
    code: str
    cost: float


def quantity_variants(named: NamedFormula) -> Iterator[QuantityVariant]:
    """Yield corrected claims in which a usual fault of the quantity is undone: ``k^2 = I/m`` for ``k = I/m``.

    If the formula for the quantity is a sum of names, ``k = a + b``, also yield ``k^2 = a^2 + b^2``.
    """
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
        square = square_of(side)
        yield QuantityVariant(square, formula, "exponent", COST["exponent"])
        terms = [term.args[0] if term.kind == "neg" else term for term in formula.args]
        if formula.kind == "sum" and all(map(is_name_or_rate, terms)):
            squares = [negated(square_of(t.args[0])) if t.kind == "neg" else square_of(t) for t in formula.args]
            yield QuantityVariant(square, sum_of(squares), "exponent", COST["exponent"])


def without_inverse(named: NamedFormula) -> NamedFormula | None:
    """Return the claim ``cos(theta/2) = u`` for ``theta = 2*acos(u)``; None for a formula of another form.

    The function ``solve`` of the returned claim turns a formula u into ``2*acos(u)``, the formula for theta.
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


def is_evident_by_quantity(claim: Claim, named: NamedFormula, changed: QuantityVariant) -> bool:
    """Return whether the author of a claim probably means the corrected claim ``changed``."""
    letters = names_in(named.formula)
    stem = named.name.partition("_")[0]
    # such as k = k_bar + d
    if any(letter.partition("_")[0] == stem for letter in letters) and changed.formula != named.formula:
        return True
    is_stated = claim.context.meaning_of(quantity_name(named)) is not None
    return len(letters) >= LEAST_SYMBOLS_EDITED + (0 if is_stated else 1)


# -- lengths of vectors ------------------------------------------------------------------------------------------------


def by_lengths(named: NamedFormula, judge: Callable[[NamedFormula], Verdict]) -> Verdict | None:
    """Return the verdict of ``judge`` on a claim's formula in which each square of a vector is written out.

    ``sigma^2`` becomes ``sigma_1^2 + sigma_2^2 + sigma_3^2``, and is written as ``sigma^2`` again in repairs. Return
    None if the formula has no square of a vector, or if the verdict is "definition".
    """
    squares = dict(_squares(named.formula))
    if not squares:
        return None
    verdict = judge(named._replace(formula=exchanged(named.formula, squares)))
    if verdict.verdict == "definition":
        return None
    back = {whole: square for square, whole in squares.items()}
    repairs = []
    for repair in verdict.repairs:
        _, left, right = read_relation(repair.text)
        repairs.append(replace(repair, text=f"{text(left)} == {text(exchanged(right, back))}"))
    notes = tuple(_note(square, whole) for square, whole in squares.items())
    return replace(verdict, repairs=tuple(repairs), notes=(*verdict.notes, *notes))


def _note(square: Node, whole: Node) -> str:
    """Return the note for the user that ``square``, sigma^2, is read as ``whole``, sigma_1^2 + sigma_2^2 + ..."""
    names = [str(term.args[0].value) for term in whole.args]
    return f"{square.args[0].value}^2 is read as the sum of the squares of {', '.join(names[:-1])} and {names[-1]}"


def _squares(formula: Node) -> Iterator[tuple[Node, Node]]:
    """Yield (``sigma**2``, sum of the squares of its components) for each letter that occurs only in its square.

    At least two components, such as sigma_1 and sigma_2, must occur in the formula too.
    """
    letters = [
        node for _, node in walk(formula) if node.kind == "name" or (node.kind == "call" and node.args == (TIME,))
    ]
    for letter in dict.fromkeys(letters):
        square = square_of(letter)
        if letters.count(letter) != sum(node == square for _, node in walk(formula)):
            continue
        for axes in AXES:
            pattern = rf"{re.escape(str(letter.value))}_?[{axes}]"
            parts = [other for other in dict.fromkeys(letters) if re.fullmatch(pattern, str(other.value))]
            if len(parts) > 1:
                stem = str(parts[0].value)[:-1]
                written = {part.value: part for part in parts}
                components = [written.get(stem + axis, Node("name", stem + axis)) for axis in axes]
                yield square, sum_of([square_of(part) for part in components])
