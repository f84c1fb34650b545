"""Claims with P, Q and R for the rates of roll, pitch and yaw, decided with the letters p, q and r of most books."""

from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import Relation
from symrot.checker.claim.tree import Node, is_derivative, walk, with_names
from symrot.checker.equivalent_claim import brought_back
from symrot.checker.verdict import Verdict

__all__ = ["in_claim", "with_small_letters"]

SMALL = {"P": "p", "Q": "q", "R": "r"}
ANGLES = ("phi", "theta", "psi")
NOTE = "P, Q and R are read as the rates of roll, pitch and yaw, p, q and r"


def with_small_letters(claim: Claim) -> Claim | None:
    """Return the claim with p, q, r for P, Q, R if its other letters are Euler angles and one has a rate; else None."""
    if claim.relation is None or claim.define or claim.hypotheses or claim.context:
        return None
    nodes = [node for side in claim.relation[1:] for _, node in walk(side)]
    letters = {str(node.value) for node in nodes if _is_quantity(node)} - {"t", "pi"}
    rates = {str(node.args[0].value) for node in nodes if is_derivative(node)}
    if not letters & {*SMALL} or not letters <= {*SMALL, *ANGLES} or not rates & {*ANGLES}:
        return None
    return claim.with_relation(_renamed(claim.relation, SMALL), alternatives=())


def in_claim(verdict: Verdict) -> Verdict:
    """Return ``verdict``, on the claim with small letters, for the original claim with capital ones."""
    capital = {small: letter for letter, small in SMALL.items()}
    readings = tuple(
        replace(reading, mapping={own: capital.get(other, other) for own, other in reading.mapping.items()})
        for reading in verdict.recognised_as
    )
    return brought_back(replace(verdict, recognised_as=readings), lambda relation: _renamed(relation, capital), NOTE)


def _is_quantity(node: Node) -> bool:
    return node.kind == "name" or (node.kind == "call" and [argument.value for argument in node.args] == ["t"])


def _renamed(relation: Relation, names: dict[str, str]) -> Relation:
    sign, left, right = relation
    return sign, with_names(left, names), with_names(right, names)
