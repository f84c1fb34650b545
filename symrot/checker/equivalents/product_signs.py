"""Claims whose context defines products of inertia without a minus sign, as ``I_xy = integral of x*y dm``.

symrot's formulas have ``I_xy = -integral of x*y dm``. Such a claim is therefore decided with the opposite sign of every
product of inertia.
"""

import re
from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import TIME, Node, is_derivative, negated
from symrot.checker.context.context import Context, Meaning
from symrot.checker.context.quantities import QUANTITIES
from symrot.checker.equivalents.equivalent_claim import EquivalentClaim
from symrot.checker.repair.edits.names import PRODUCT_OF_INERTIA
from symrot.checker.typed.readings import Relation

__all__ = ["sign_by_integral", "with_minus_sign", "with_sign"]

NOTE = "products of inertia are those without the minus sign, I_xy = integral of x*y dm"
WITH_MINUS, WITHOUT_MINUS = (
    next(quantity for quantity in QUANTITIES if quantity.sign == sign) for sign in ("minus", "plus")
)
COORDINATES = ("x", "y", "z")
_MARK = "(?:_?(?:prime|bar|star|cm|CM|com|COM|[A-Z]|[cg0-9]))*"
ABOUT_A_POINT = re.compile(
    rf"[IJP](?:_?bar)?_?(?:[A-Z]?_?([xyz]){_MARK}(?!\1)[xyz]{_MARK}|([XYZ])(?!\2)[XYZ])", re.ASCII
)
"""Pattern of the name of a product of inertia about another point or along other axes: I_xyG, I_xy_cm, I_bar_xy,
I_x_primey_prime."""


def sign_by_integral(name: Node, formula: Node) -> str:
    """Return "plus" for a definition such as ``I_xy = integral of x*y dm``, "minus" for its negative; else ""."""
    integral = formula.args[0] if formula.kind == "neg" else formula
    if not _is_product(name) or integral.kind != "call" or integral.value != "integral_over_body":
        return ""
    inside, negative = integral.args[0], formula.kind == "neg"
    if inside.kind == "neg":
        inside, negative = inside.args[0], not negative
    factors = [str(factor.value) for factor in inside.args] if inside.kind == "product" else []
    is_pair = len({*factors}) == len(factors) == 2 and {*factors} <= {*COORDINATES}
    return ("minus" if negative else "plus") if is_pair and sorted(factors) == sorted(str(name.value)[-2:]) else ""


def with_sign(context: Context, name: Node, sign: str) -> Context:
    """Return the context with the statement that ``name`` is a product of inertia with the sign "minus" or "plus"."""
    quantity = WITH_MINUS if sign == "minus" else WITHOUT_MINUS
    meaning = Meaning(((str(name.value),),), quantity, written=(str(name.value),))
    return replace(context, meanings=(*context.meanings, meaning))


def with_minus_sign(claim: Claim) -> EquivalentClaim | None:
    """Return a claim with -I_xy for each product of inertia I_xy, if its context defines them without the minus sign.

    ``L = I_xy*w`` becomes ``L = -I_xy*w``; ``I_xy = a`` becomes ``I_xy = -a``, which says the same as ``-I_xy = a``.
    """
    if claim.relation is None or claim.context.sign_of_products != "plus":
        return None
    meanings = tuple(
        replace(meaning, quantity=WITH_MINUS) if meaning.quantity.sign else meaning
        for meaning in claim.context.meanings
    )
    context = replace(claim.context, meanings=meanings)
    other = replace(claim.with_relation(_changed(claim.relation), alternatives=()), context=context)
    return EquivalentClaim(other, _changed, NOTE)


def _changed(relation: Relation) -> Relation:
    """Return an equation with the opposite sign of each product of inertia: ``L = -I_xy*w`` for ``L = I_xy*w``."""
    sign, *sides = relation
    left, right = (_with_other_sign(side) for side in sides)
    if any(map(_is_product, sides)):  # I_xy = -a, not -I_xy = a
        left, right = negated(left), negated(right)
    return sign, left, right


def _is_product(tree: Node) -> bool:
    """Return whether a tree has the name of a product of inertia: I_xy, I_xyG, I_xy(t), or its time derivative."""
    if is_derivative(tree):
        return _is_product(tree.args[0])
    is_function = tree.kind == "call" and tree.args == (TIME,)
    name = str(tree.value)
    stem = name.removesuffix("_prime").removesuffix("_bar")
    patterns = ((PRODUCT_OF_INERTIA, stem), (ABOUT_A_POINT, name))
    return (tree.kind == "name" or is_function) and any(pattern.fullmatch(text) for pattern, text in patterns)


def _with_other_sign(tree: Node) -> Node:
    if _is_product(tree):
        return negated(tree)
    if tree.kind == "neg" and _is_product(tree.args[0]):
        return tree.args[0]
    return replace(tree, args=tuple(map(_with_other_sign, tree.args)))
