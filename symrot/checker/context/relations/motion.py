"""Verdicts on claims about rates of Euler angles, about tops, and about integrals over a body.

For each subject symrot derives formulas, such as those for the angular velocity in the angle rates. A claim holds if it
becomes an identity when these formulas replace its letters.
"""

from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.scope import is_matrix
from symrot.checker.context.relations.angle_rates import substitutions_of_entries, substitutions_of_rates
from symrot.checker.context.relations.axis_angles import is_stated, substitutions_of_axis_angles
from symrot.checker.context.relations.body_integrals import (
    TENSOR_OF_INTEGRALS,
    is_tensor_of_integrals,
    substitutions_of_gyration,
    substitutions_of_integrals,
)
from symrot.checker.context.relations.substitution import by_substitution
from symrot.checker.context.relations.tops import substitutions_of_tops
from symrot.checker.verdict import Verdict

__all__ = ["by_motion"]


def by_motion(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim by relations between its rates, momenta and energies; ``verdict`` if none
    decides it.
    """
    equation, context = claim.equation, claim.context
    sides = equation.left, equation.right
    if any(map(is_matrix, sides)):
        if verdict.verdict == "definition" and is_tensor_of_integrals(sides):
            return replace(verdict, verdict="recognised", recognised_as=(TENSOR_OF_INTEGRALS,), reason="")
        return verdict
    is_used = not context.rest  # with words that nothing uses, a claim is called neither true nor false
    of_gyration = is_used and any(meaning.quantity.title == "radius of gyration" for meaning in context.meanings)
    of_momentum = is_used and is_stated(context) and context.body is not None
    for ways, is_complete in (
        (substitutions_of_integrals(context, sides), is_used and bool(context.meanings)),
        (substitutions_of_gyration(context, sides), of_gyration and context.body is None),
        (substitutions_of_axis_angles(context, sides), of_momentum),
    ):
        decided = by_substitution(claim, verdict, ways, is_complete)
        if decided is not verdict:
            return decided
    has_frame = is_used and bool(context.frame or any(meaning.frame for meaning in context.meanings))
    verdict = by_substitution(
        claim, verdict, substitutions_of_rates(context, sides), bool(context.sequence) and has_frame
    )
    verdict = by_substitution(claim, verdict, substitutions_of_entries(context, sides), is_complete=False)
    if context.sequence not in ("", "ZXZ") or verdict.verdict in ("true", "recognised"):
        return verdict
    return by_substitution(claim, verdict, substitutions_of_tops(context, sides), is_complete=False)
