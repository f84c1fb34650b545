"""Claims about a body with the axis of symmetry x or y, decided as claims about the axis z of the derived formulas."""

import re
from collections.abc import Mapping
from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import Node
from symrot.checker.equivalents.equivalent_claim import EquivalentClaim
from symrot.checker.typed.readings import Relation

__all__ = ["with_axis_z"]

TURNED: Mapping[str, Mapping[str, str]] = {"x": {"x": "z", "y": "x", "z": "y"}, "y": {"x": "y", "y": "z", "z": "x"}}
"""Stated axis of symmetry -> {axis: its new name if the axis of symmetry is called z}."""

MOMENT = re.compile(r"([IJk](?:_bar)?_?)([xyz])(\2)?")
"""Pattern of names of moments of inertia and radii of gyration about an axis, such as I_z; group 2 is the axis."""


def with_axis_z(claim: Claim) -> EquivalentClaim | None:
    """Return the claim ``I_z = ..`` for ``I_x = ..``, if the body's stated axis of symmetry is x; likewise for y.

    None for other claims.
    """
    body = claim.context.body
    if body is None or not body.symmetry_axis or claim.relation is None:
        return None
    axes = TURNED[body.symmetry_axis]
    other = replace(
        claim.with_relation(_renamed(claim.relation, axes), alternatives=()),
        context=replace(claim.context, body=replace(body, symmetry_axis="")),
    )
    back = {new: old for old, new in axes.items()}
    note = f"{body.symmetry_axis} is the axis of symmetry of the body; in the names of derived formulas it is z"
    return EquivalentClaim(other, lambda relation: _renamed(relation, back), note)


def _renamed(relation: Relation, axes: Mapping[str, str]) -> Relation:
    """Return an equation with moments of inertia about other axes: I_z for I_x, if ``axes`` maps x to z."""

    def renamed(tree: Node) -> Node:
        if tree.kind == "name" and (match := MOMENT.fullmatch(str(tree.value))):
            return replace(tree, value=match[1] + axes[match[2]] * (1 + bool(match[3])))
        return replace(tree, args=tuple(map(renamed, tree.args)))

    sign, left, right = relation
    return sign, renamed(left), renamed(right)
