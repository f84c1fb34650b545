"""Claims solved by an inverse matrix, ``ω' = J^-1 (M - ω × J ω)``, decided as ``J ω' = M - ω × J ω``."""

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import Node, number, product
from symrot.checker.equivalents.equivalent_claim import EquivalentClaim
from symrot.checker.typed.readings import Relation

__all__ = ["multiplied"]


def multiplied(claim: Claim) -> EquivalentClaim | None:
    """Return the claim multiplied by the matrix J whose inverse is the first factor of its right side; else None."""
    if claim.relation is None or not claim.define:
        return None
    sign, left, right = claim.relation
    matrix = _inverted(right.args[0]) if right.kind == "product" else None
    if matrix is None or matrix.value not in dict(claim.define):
        return None
    relation = sign, product([matrix, left]), product(list(right.args[1:]))

    def divided(relation: Relation) -> Relation:
        sign, left, right = relation
        if left.kind != "product" or left.args[0] != matrix:
            return relation
        inverse = Node("power", None, (matrix, number(-1)))
        return sign, product(list(left.args[1:])), product([inverse, right])

    note = f"both sides of the equation are multiplied by {matrix.value} before they are compared"
    return EquivalentClaim(claim.with_relation(relation, alternatives=()), divided, note)


def _inverted(factor: Node) -> Node | None:
    """Return the name J for a factor ``J^-1`` or ``inverse(J)``; None for other factors."""
    is_power = factor.kind == "power" and factor.args[1] == number(-1)
    is_call = factor.kind == "call" and factor.value == "inverse"
    return factor.args[0] if (is_power or is_call) and factor.args[0].kind == "name" else None
