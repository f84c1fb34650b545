"""Claims for the rate of a rotation matrix, ``R' = [ω]× R``, tested on a rotation.

The claim was recognised by its right side alone. It may still be wrong: R may map body components to space components
on the left side, and space components to body components on the right side. A test with a rotation in place of R shows
whether both sides mean the same matrix.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from sympy import Function, Symbol

from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.tree import Node, is_derivative
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.repair.edits.faults import FAULT_DESCRIPTIONS
from symrot.checker.typed.readings import Relation
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.kinematics.rotations import elementary_rotation, vee

__all__ = ["tested_on_rotations"]

PLACES = [(row, column) for row in range(3) for column in range(3)]
REASON = "the equation is not proven for a rotation matrix {} with the angular velocity {} in the body or in space"


def tested_on_rotations(claim: Claim, verdict: Verdict) -> Verdict:
    """Test an equation for the rate of a matrix R, such as ``R' = [ω]× R``, with a general rotation in place of R.

    Only an equation whose ``verdict`` is "recognised" (equal to a derived formula) is tested. Return ``verdict`` for
    all other claims, and if the equation is proven. Return "doubtful" if the equation is proven only with R in place of
    each R^T, otherwise "definition" (it may define R).
    """
    if verdict.verdict != "recognised" or claim.relation is None:
        return verdict
    names = _matrix_and_vector(claim)
    if names is None or _holds(claim, *names):
        return verdict
    relation = _without_transpose(claim.relation, names[0])
    other = claim.with_relation(relation)
    if relation == claim.relation or not _holds(other, *names):
        reason = REASON.format(*names)
        return replace(verdict, verdict="definition", recognised_as=(), reason=reason)
    repair = Repair(relation_text(relation), "active_passive_transpose", 1.0)
    diagnosis = Diagnosis("active_passive_transpose", FAULT_DESCRIPTIONS["active_passive_transpose"])
    return replace(verdict, verdict="doubtful", repairs=(repair,), diagnosis=diagnosis)


def _matrix_and_vector(claim: Claim) -> tuple[str, str] | None:
    """Return (matrix name, vector name) for a claim on the rate of a matrix, ("R", "omega") for ``R' = [omega]x R``.

    Return None unless the rate alone is one side, and the only vectors and matrices are this 3 x 3 matrix and one
    vector.
    """
    assert claim.relation is not None
    names = [name for side in claim.relation[1:] if (name := _name_of_rate(side))]
    define = dict(claim.define)
    if len(names) != 1 or len(define) != 2 or (matrix := names[0]) not in define:
        return None
    (vector,) = (name for name in define if name != matrix)
    shapes = [getattr(claim.definitions.values[name], "shape", None) for name in (matrix, vector)]
    return (matrix, vector) if shapes == [(3, 3), (3, 1)] else None


def _name_of_rate(side: Node) -> str:
    """Return "R" for ``diff(R, t)`` and for the names R_dot and R_prime; "" for other trees."""
    if is_derivative(side) and side.args[0].kind == "name":
        return str(side.args[0].value)
    marked = re.fullmatch(r"(\w+)_(?:dot|prime)", str(side.value)) if side.kind == "name" else None
    return marked[1] if marked else ""


def _holds(claim: Claim, matrix: str, vector: str) -> bool:
    """Return whether a claim is proven with a general rotation as ``matrix``, and its angular velocity as ``vector``.

    The angular velocity may be that in the body or in space, with either sign. Return True without a test if the matrix
    or vector has a formula as an entry: no rotation can then be put in its place.
    """
    values = claim.definitions.values
    angles = [Function(f"angle_{number}", real=True)(time) for number in range(3)]
    first, second, third = (elementary_rotation(axis, angle) for axis, angle in zip("zxz", angles, strict=True))
    turned = first * second * third
    entries = {values[matrix][place]: turned[place] for place in PLACES}
    sides = [
        turned.diff(time) if isinstance(side, Symbol) else side for side in (claim.equation.left, claim.equation.right)
    ]
    for angular in _angular_velocities(turned):
        components = {values[vector][place]: angular[place] for place in range(3)}
        point = {**entries, **components}
        if not all(key.is_Symbol or key.is_Function for key in point):
            return True  # the entries are formulas already
        left, right = (side.subs(point).doit() for side in sides)
        if decide_equation(Equation(left, right)).verdict == "true":
            return True
    return False


def _angular_velocities(turned: Any) -> Iterator[Any]:
    rate = turned.diff(time)
    for inside in (vee(turned.T * rate), vee(rate * turned.T)):
        yield from (inside, -inside)


def _without_transpose(relation: Relation, matrix: str) -> Relation:
    """Return an equation with each transpose of ``matrix`` replaced by the matrix itself: R for ``R^T``."""

    def plain(tree: Node) -> Node:
        if tree.kind == "transpose" and tree.args[0] == Node("name", matrix):
            return tree.args[0]
        return replace(tree, args=tuple(map(plain, tree.args)))

    sign, left, right = relation
    return sign, plain(left), plain(right)
