"""Names of moments of inertia that say for which body or point they are, as ``I_rod`` and ``I_end`` do."""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node, number, product
from symrot.checker.context.admission import admits_name
from symrot.checker.context.bodies import BODIES
from symrot.checker.context.context import Context
from symrot.checker.context.statements import read_context
from symrot.checker.verdict import Verdict

__all__ = ["of_named_body"]

Judge = Callable[[Claim, NamedFormula], Verdict]

ROD, END = "thin rod", "an end"

BODIES_OF_WORD = {
    **dict.fromkeys(("rod", "stick", "bar"), (ROD, "rod")), "sphere": ("sphere", "spher"), "ball": ("sphere", "spher"),
    **dict.fromkeys(("disk", "disc"), ("disk", "disk")), **dict.fromkeys(("ring", "hoop"), ("ring", "ring")),
    **dict.fromkeys(("box", "cube"), ("box", "box")), "shell": ("spherical shell", "shell"),
    **{name: (name, name) for name in ("cylinder", "cone", "plate", "ellipsoid", "torus")},
}  # fmt: skip
"""Maps a word in the name of a quantity, such as "rod" in ``I_rod``, to a pair: the body that the word means, and a
text that is in the names of derived formulas for this body."""

PLACE_OF_WORD = {
    "end": END, **dict.fromkeys(("centre", "center", "cm", "com", "CM", "G"), "the centre of mass"),
    "tip": "the tip", "apex": "the tip", "rim": "a point of the rim",
}  # fmt: skip
"""Maps a word in the name of a quantity to the point of the body through which the axis goes."""

HALVES = ("a", "l")
"""Letters that some books use for half the length of a rod."""


def of_named_body(claim: Claim, named: NamedFormula, verdict: Verdict, judge: Judge) -> Verdict:
    """Return the verdict on a claim about a quantity whose name states a body or point, such as ``I_rod`` or ``I_end``.

    Only a formula for this body and point is right. ``verdict`` is the verdict without regard to the name. Return it
    unchanged if the name states neither body nor point, and if it is "true", "false" or "doubtful". ``judge`` returns
    the verdict on a claim in its context.
    """
    match = re.fullmatch(r"[IJ]_?(\w+)", named.name)
    words = match[1].split("_") if match else []
    body, part = next((BODIES_OF_WORD[word] for word in words if word in BODIES_OF_WORD), ("", ""))
    place = next((PLACE_OF_WORD[word] for word in words if word in PLACE_OF_WORD), "")
    if not (body or place) or verdict.verdict in ("true", "false", "doubtful"):
        return verdict
    stated = read_context([f"{named.name} = moment of inertia" + f" about {place}" * bool(place)])
    fitting = tuple(
        known for known in verdict.recognised_as if part in known.name and admits_name(stated, known.name, named.name)
    )
    if fitting:
        return replace(verdict, recognised_as=fitting)
    body = body or (ROD if place == END else _body_of(verdict))
    if body and not claim.context:
        return _judged(claim, named, verdict, replace(stated, body=read_context(body=body).body), judge)
    return verdict if not verdict.recognised_as else _not_of_name(named, verdict)


def _body_of(verdict: Verdict) -> str:
    """Return the body of the formula that a claim is recognised as, such as "thin rod"; empty if there is none."""
    name = f"{verdict.recognised_as[0].name} " if verdict.recognised_as else ""
    return next((kind.title for kind in BODIES if kind.shape and f" of {kind.formulas[0]} " in name), "")


def _judged(claim: Claim, named: NamedFormula, verdict: Verdict, stated: Context, judge: Judge) -> Verdict:
    """Return the verdict on a claim about a quantity such as ``I_rod``, whose name states the body or point.

    ``stated`` is the context that this name states, and ``judge`` returns the verdict on a claim in a context. Return
    "recognised" if the claim is right in this context, and "doubtful" if a repaired claim is right. Otherwise use
    ``verdict``, the verdict without this context: if it recognises a known formula, this formula is for another body or
    point than the name states, so return "definition"; else return ``verdict``.
    """
    other = judge(replace(claim, context=stated), named)
    if other.verdict in ("true", "recognised"):
        return replace(other, verdict="recognised")
    for letter in HALVES if stated.body is not None and stated.body.kind.title == ROD else ():
        formula = _halved(named.formula, letter)
        halved = claim.with_relation(("==", named.side, formula), alternatives=())
        half = judge(replace(halved, context=stated), named._replace(formula=formula))
        if formula != named.formula and half.verdict in ("true", "recognised"):
            note = f"guessed, not stated: {letter} is half the length"
            return Verdict("recognised", recognised_as=half.recognised_as, notes=(*half.notes, note))
    if other.verdict in ("false", "doubtful") and other.repairs:
        return replace(other, verdict="doubtful", counterexample=None)
    return verdict if not verdict.recognised_as else _not_of_name(named, verdict)


def _not_of_name(named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return ``verdict`` changed to "definition" (not judged), with the reason that the name contradicts the formula.

    ``named`` is the quantity of the claim with its formula. Its name, such as ``I_rod``, states a body or point. The
    formula is that of another body or point: ``verdict`` recognises it.
    """
    reason = (
        f"the formula is the {verdict.recognised_as[0].name}; but the name {named.name} is for another body or point"
    )
    return replace(verdict, verdict="definition", recognised_as=(), reason=reason)


def _halved(tree: Node, letter: str) -> Node:
    if tree == Node("name", letter):
        return product([number(Fraction(1, 2)), tree])
    return replace(tree, args=tuple(_halved(child, letter) for child in tree.args))
