"""Verdicts on claims about rates of Euler angles, tops and integrals over a body, by the relations of each subject."""

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.scope import is_matrix
from symrot.checker.context.angle_rates import substitutions_of_rates
from symrot.checker.context.body_integrals import substitutions_of_integrals
from symrot.checker.context.substitution import by_substitution
from symrot.checker.context.tops import substitutions_of_tops
from symrot.checker.verdict import Verdict

__all__ = ["by_motion"]


def by_motion(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim by the relations between rates, components, momenta and energies.

    It is ``verdict`` if these relations do not decide the claim.
    """
    equation, context = claim.equation, claim.context
    sides = equation.left, equation.right
    if any(map(is_matrix, sides)):
        return verdict
    by_integrals = by_substitution(claim, verdict, substitutions_of_integrals(context, sides), bool(context.meanings))
    if by_integrals is not verdict:
        return by_integrals
    is_stated = bool(context.sequence and (context.frame or any(meaning.frame for meaning in context.meanings)))
    verdict = by_substitution(claim, verdict, substitutions_of_rates(context, sides), is_stated)
    if context.sequence not in ("", "ZXZ") or verdict.verdict in ("true", "recognised"):
        return verdict
    return by_substitution(claim, verdict, substitutions_of_tops(context, sides), is_complete=False)
