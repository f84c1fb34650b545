"""The verdict on one claim: the claim is decided, or recognised as a known formula, and diagnosed if it is not true.

The functions ``_on_name``, ``_on_rule``, ``_on_relation``, ``_on_determinant`` and ``_on_expanded`` recognise a claim.
They return a pair (None, verdict), whose None stands in place of a decision, since a recognised claim has none. They
return None for claims that they do not recognise.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from time import perf_counter

from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.differentiation import as_functions, is_rule
from symrot.checker.claim.named_formula import (
    NamedFormula,
    claims_identity,
    named_formula,
    open_formula,
    related_formula,
)
from symrot.checker.claim.values import decide_value
from symrot.checker.decide.decision import decide_equation, for_positive_bases, is_large
from symrot.checker.decide.ranges.text import condition_texts
from symrot.checker.equivalents.aircraft_names import with_usual_letters
from symrot.checker.equivalents.inertia_in_frames import on_inertia_in_frames
from symrot.checker.equivalents.inverse_factor import multiplied
from symrot.checker.equivalents.product_signs import with_minus_sign
from symrot.checker.equivalents.rotation_rates import tested_on_rotations
from symrot.checker.equivalents.symmetry_axis import with_axis_z
from symrot.checker.time_limit import TimeUp, processor_seconds
from symrot.checker.units.check import check_dimensions
from symrot.checker.verdict import Diagnosis, Verdict
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.limits.operations import MOST_OPERATIONS, OutOfOperations, one_claim

__all__ = [
    "check_claim",
    "check_readings",
    "ended_note",
    "is_unfinished",
    "verdict_of_decision",
    "within_budget",
    "within_limits",
]

Limit = OutOfOperations | TimeUp

MOST_SECONDS = 60
"""The limit on the processor time for one claim, in seconds. Normally a check ends earlier, after MOST_OPERATIONS
operations, which take about ten seconds. This limit ends a check that spends its time inside SymPy, whose operations
are not counted."""
FOR_ALL_VALUES = (
    "== claims that both sides are equal for all values; to state a relation between the letters, write one ="
)
WITH_HYPOTHESES = "symrot derives no such formula; but the hypotheses are not used, and the claim may be true with them"


def check_claim(claim: Claim, repair: bool = True) -> Verdict:
    """Return the verdict on a claim in its usual interpretation, or in another one if the claim is true only there.

    Raises
    ------
    InputError
        For formulas that are nested too deeply, and for those that :func:`decide_equation` refuses.
    """
    try:
        verdict, other = check_readings(claim, repair)
    except RecursionError:
        raise InputError(f"{claim.id or 'claim'}: expected formulas that are nested less deeply") from None
    if other is None:
        return verdict
    if claim.implied:
        note = f"R_x(a), R_y(a), R_z(a) rotate the axes here; if they rotate vectors, it is {verdict.verdict}"
    else:
        note = f"this is another reading of the claim; the first, {verdict.text}, is {verdict.verdict}"
    return replace(other, notes=(*other.notes, note), seconds=verdict.seconds + other.seconds)


def check_readings(claim: Claim, repair: bool = True) -> tuple[Verdict, Verdict | None]:
    """Return (verdict, other): the verdict on a claim in its usual interpretation, and the verdict in another
    interpretation.

    ``other`` is None unless the claim is true (or recognised) in another interpretation and not in the usual one.
    """
    start = perf_counter()
    verdict: Verdict | None = None
    try:
        with within_limits():
            named = _on_name(claim, repair, named_formula) or _on_rule(claim)
            named = named or (None if claims_identity(claim) else _on_name(claim, repair, open_formula))
            decision, verdict = named or _decide(claim)
            is_settled = decision is None or verdict.holds
            other_verdict = None if is_settled else _of_another_reading(claim)
            is_false = decision is not None and decision.verdict == "false"
            if other_verdict is None and is_false and verdict.dimension.status != "inconsistent":
                named = _on_determinant(claim, repair) or _on_name(claim, repair, related_formula)
                named = named or _on_relation(claim) or _on_expanded(claim, repair)
                if named and named[1].verdict == "definition" and claims_identity(claim):
                    named, verdict = None, replace(verdict, notes=(*verdict.notes, FOR_ALL_VALUES))
                decision, verdict = named or (decision, verdict)
            # a diagnosis of faults only if no other interpretation makes the claim true
            if other_verdict is None and repair and decision is not None:
                verdict = _diagnosed(claim, decision, verdict)
            is_open = is_false and claim.implied and not (named and _was_near_relation(claim))
            if other_verdict is None and repair and is_open and verdict.verdict == "false" and not verdict.repairs:
                verdict = _near_relation(claim, verdict)
    except (OutOfOperations, TimeUp) as limit:
        other_verdict = None
        if verdict is None:
            late = verdict_of_decision(unfinished(limit), claim.text, start)
            verdict = replace(late, id=claim.id, where=claim.where)
        else:
            verdict = replace(verdict, notes=(*verdict.notes, ended_note(limit)))
    if other_verdict is not None:
        return verdict, other_verdict
    return replace(verdict, seconds=perf_counter() - start), None


@contextmanager
def within_limits() -> Iterator[None]:
    """Run a ``with`` block within the budget for one claim; beyond it, OutOfOperations or TimeUp is raised."""
    with one_claim(MOST_OPERATIONS), processor_seconds(MOST_SECONDS):
        yield


def within_budget(decide: Callable[[], Verdict], text: str) -> Verdict:
    """Return ``decide()``, the verdict on the claim ``text``, or "undecided" if the budget for a claim ends before."""
    start = perf_counter()
    try:
        with within_limits():
            return decide()
    except (OutOfOperations, TimeUp) as limit:
        return verdict_of_decision(unfinished(limit), text, start)


def is_unfinished(verdict: Verdict) -> bool:
    """Return whether the budget for a claim was used up before a decision, or before all repairs were tried."""
    limits: tuple[Limit, ...] = OutOfOperations(), TimeUp()
    return any(verdict.reason == unfinished(limit).reason or ended_note(limit) in verdict.notes for limit in limits)


def ended_note(limit: Limit) -> str:
    """Return the note that the budget for a claim was used up before all other readings and repairs were tried.

    The budget is a number of operations and a processor time; ``limit`` says which of them was reached.
    """
    if isinstance(limit, OutOfOperations):
        return f"the search for other readings and for repairs was stopped after {_operations()}"
    return (
        f"the search for other readings and for repairs was stopped after {MOST_SECONDS} s of processor time; "
        "a faster machine may get further"
    )


def unfinished(limit: Limit) -> Decision:
    """Return the decision "undecided" for a claim that needs more operations or processor time than its budget has."""
    advice = "replacing an inner function by a letter may help"
    if isinstance(limit, OutOfOperations):
        return Decision("undecided", reason=f"it needs more than {_operations()}; {advice}")
    reason = f"SymPy needs more than {MOST_SECONDS} s of processor time; {advice}, or a faster machine"
    return Decision("undecided", reason=reason)


def _operations() -> str:
    return f"{MOST_OPERATIONS:,} operations".replace(",", " ")


def _of_another_reading(claim: Claim) -> Verdict | None:
    """Return the verdict on the first interpretation, besides the usual one, in which a claim is true; None if there is
    none.
    """
    for relation in claim.alternatives:
        source = relation_text(relation)
        other = claim.with_relation(relation, alternatives=(), sources={**claim.sources, "claim": source})
        _, verdict = _decide(other)
        if verdict.holds:
            return verdict
    return None


def _on_name(
    claim: Claim, repair: bool, formula_of: Callable[[Claim], NamedFormula | None]
) -> tuple[None, Verdict] | None:
    """Return (None, verdict) for a claim such as ``I_zz == m*r**2/2``, a formula for a quantity without a definition.

    ``formula_of`` finds the quantity and its formula; ``repair`` is whether to search repairs. None in the pair stands
    in place of a decision, which such a claim does not have. Return None for other claims.
    """
    if (other := with_minus_sign(claim) or with_axis_z(claim)) is not None:
        result = _on_name(other.claim, repair, formula_of)
        return result and (None, replace(other.in_typed_form(result[1]), text=claim.text))
    for other, formula in ((with_usual_letters(claim), formula_of), (multiplied(claim), related_formula)):
        result = None if other is None else _on_name(other.claim, repair, formula)
        if other and result and result[1].verdict in ("recognised", "doubtful"):
            return None, replace(other.in_typed_form(result[1]), text=claim.text)
    if (on_frames := on_inertia_in_frames(claim)) is not None:
        return None, on_frames
    named = formula_of(claim) if claim.relation is not None else None
    if named is None:
        return None
    from symrot.checker.context.exchanged_letters import by_exchanged_letters
    from symrot.checker.context.named_bodies import of_named_body
    from symrot.checker.context.sizes import by_other_sizes
    from symrot.checker.recognition.naming.verdicts import verdict_on_name

    start = perf_counter()

    def judge(one: Claim, own: NamedFormula, with_repair: bool = False) -> Verdict:
        verdict = verdict_on_name(one, own, with_repair)
        if one.context:
            from symrot.checker.context.decision import in_context

            verdict = in_context(one, own, verdict)
        return verdict

    def judge_in_full(one: Claim, own: NamedFormula) -> Verdict:
        return by_other_sizes(one, own, judge(one, own, repair), judge)

    def judge_with_motion(one: Claim, own: NamedFormula) -> Verdict:
        return _on_motion(one, judge(one, own))

    with _place_of(claim):
        verdict = tested_on_rotations(claim, _on_motion(claim, judge_in_full(claim, named)))
        verdict = of_named_body(claim, named, verdict, judge_in_full)
        if repair:
            verdict = by_exchanged_letters(claim, named, verdict, judge_with_motion)
        if claim.hypotheses and verdict.verdict in ("false", "doubtful"):  # the context does not use the hypotheses
            by_name = verdict_on_name(claim, named, repair) if claim.context else verdict
            by_hypotheses = Verdict("definition", reason=WITH_HYPOTHESES, notes=verdict.notes)
            verdict = by_name if by_name.verdict == "doubtful" else by_hypotheses
    return None, _completed(claim, replace(verdict, text=claim.text), start)


def _on_rule(claim: Claim) -> tuple[None, Verdict] | None:
    """Return (None, verdict) for a rule of differentiation, such as ``(u v)' = u' v + u v'``; None for other claims.

    None in the pair stands in place of a decision.
    """
    if claim.relation is None or open_formula(claim) is None or (general := as_functions(claim)) is None:
        return None
    decision, verdict = _decide(general)  # for all functions u(t) and v(t)
    if decision.verdict not in ("true", "conditional") and not (decision.verdict == "false" and is_rule(general)):
        return None
    return None, replace(verdict, text=claim.text, notes=general.notes)


def _was_near_relation(claim: Claim) -> bool:
    """Return whether :func:`_on_name` has already compared the claim with all known relations."""
    if claim.relation is None or claim.context:
        return False
    named = related_formula(claim)
    return named is not None and named.solve is None and (named.side, named.formula) == claim.relation[1:]


def _near_relation(claim: Claim, verdict: Verdict) -> Verdict:
    """Return ``verdict`` with repairs that turn a false claim into a known relation, and with their diagnosis.

    If there is no such repair, return ``verdict`` unchanged.
    """
    from symrot.checker.recognition.naming.near_verdicts import verdict_near_relation

    nearest = verdict_near_relation(claim)
    if nearest is None and verdict.dimension.status == "inconsistent":  # then even a short formula has a fault
        named = _on_name(claim, True, related_formula)
        nearest = named[1] if named and named[1].repairs else None
    return verdict if nearest is None else replace(verdict, diagnosis=nearest.diagnosis, repairs=nearest.repairs)


def _on_motion(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict that follows from relations between the claim's rates, momenta and energies.

    If none follows, return ``verdict``.
    """
    if claim.hypotheses or claim.define or claim.context.obscure:
        return verdict
    from symrot.checker.context.relations.motion import by_motion
    from symrot.checker.recognition.naming.verdicts import AS_IT_STANDS

    if any(note.startswith(AS_IT_STANDS) for note in verdict.notes):
        return verdict

    return by_motion(claim, verdict)


def _on_relation(claim: Claim) -> tuple[None, Verdict] | None:
    """Return (None, verdict) for a relation that symrot knows, such as an impulse equation; None for other claims.

    None in the pair stands in place of a decision.
    """
    if claim.relation is None or claim.hypotheses:
        return None
    from symrot.checker.recognition.naming.verdicts import verdict_on_relation

    start = perf_counter()
    verdict = verdict_on_relation(claim)
    return None if verdict is None else (None, _completed(claim, replace(verdict, text=claim.text), start))


def _on_determinant(claim: Claim, repair: bool) -> tuple[None, Verdict] | None:
    """Return (None, verdict) for a claim about the determinant of a rate Jacobian; None for other claims.

    None in the pair stands in place of a decision.
    """
    if claim.relation is None or claim.hypotheses:
        return None
    from symrot.checker.context.determinants import verdict_on_determinant

    start = perf_counter()
    verdict = verdict_on_determinant(claim, repair)  # not a decision of the claim's own equation
    return None if verdict is None else (None, _completed(claim, replace(verdict, text=claim.text), start))


def _on_expanded(claim: Claim, repair: bool) -> tuple[None, Verdict] | None:
    """Return (None, verdict) for a claim that is recognised once its abbreviations are replaced; None for other claims.

    Abbreviations are hypotheses such as ``c1 == cos(alpha)``. None in the pair stands in place of a decision.
    """
    expanded = claim.expanded
    if expanded is claim or expanded.hypotheses:
        return None
    named = _on_name(expanded, repair, related_formula) or _on_relation(expanded)
    return None if named is None else (None, replace(named[1], text=claim.text))


def _decide(claim: Claim) -> tuple[Decision, Verdict]:
    start = perf_counter()
    with _place_of(claim):
        if claim.relation is None:
            decision = decide_value(claim)
        else:
            decision = for_positive_bases(decide_equation(claim.equation), claim.equation)
            if decision.verdict == "undecided" and (expanded := claim.expanded) is not claim:
                equation = expanded.equation  # the abbreviations, such as c1 = cos(alpha), are replaced by formulas
                decision = for_positive_bases(decide_equation(equation), equation)
    return decision, _completed(claim, verdict_of_decision(decision, claim.text, start), start)


@contextmanager
def _place_of(claim: Claim) -> Iterator[None]:
    """Run a block of code; if it raises InputError, put the claim's name in front of the message."""
    try:
        yield
    except InputError as reason:
        if not claim.id or claim.id in str(reason):
            raise
        raise InputError(f"{claim.id}: {reason}") from None


def _completed(claim: Claim, verdict: Verdict, start: float) -> Verdict:
    """Return ``verdict`` with the check of units, the claim's name and source, and the seconds since ``start``."""
    if claim.relation is not None:
        hypotheses = [relation[1:] for relation in claim.hypotheses]
        dimensions = check_dimensions(claim.relation[1:], claim.define, hypotheses, claim.units)
        verdict = replace(verdict, dimension=dimensions)
    return replace(verdict, id=claim.id, where=claim.where, seconds=perf_counter() - start)


def _diagnosed(claim: Claim, decision: Decision, verdict: Verdict) -> Verdict:
    """Return ``verdict`` with the probable fault and repairs of a claim that is false or conditional, or with a remark
    on where a true claim is defined.
    """
    if claim.relation is None or is_large(claim.equation):
        return verdict
    if any(requirement.code == "positive_base" for requirement in decision.requires):
        text = f"a power with letters in its exponent is read for a positive base: {verdict.requires[0]}"
        return replace(verdict, diagnosis=Diagnosis("positive_base", text))
    if decision.verdict not in ("false", "conditional"):
        # a true claim: a remark if only one side is defined everywhere
        return replace(verdict, diagnosis=_domain(claim)) if verdict.holds and verdict.conditions else verdict
    from symrot.checker.recognition.identification import named_parts
    from symrot.checker.repair.diagnose import diagnose

    diagnosis, repairs = diagnose(claim, decision)
    if diagnosis.code == "none" and verdict.dimension.status == "inconsistent":
        diagnosis = Diagnosis("dimension", f"the units do not fit: {verdict.dimension.text}")
    notes = (*verdict.notes, *named_parts(claim))
    return replace(verdict, diagnosis=diagnosis, repairs=repairs, notes=notes)


def _domain(claim: Claim) -> Diagnosis:
    """Return the diagnosis "domain" for a true claim with only one side defined everywhere, such as ``x == x**2/x``.

    Return the diagnosis "none" for all other true claims.
    """
    assert claim.relation is not None
    sides = [claim.with_relation(("==", side, side)) for side in claim.relation[1:]]
    left, right = (decide_equation(side.equation).conditions for side in sides)
    if bool(left) == bool(right):
        return Diagnosis("none", "")
    narrow, wide = ("left", "right") if left else ("right", "left")
    where = ", ".join(condition_texts(left or right))
    text = f"it holds only where it is defined: the {narrow} side needs {where}, the {wide} side needs nothing"
    return Diagnosis("domain", text)


def verdict_of_decision(decision: Decision, text: str, start: float) -> Verdict:
    """Return a decision as the verdict on the claim ``text``, whose check began at the time ``start``."""
    return Verdict(
        verdict=decision.verdict,
        conditions=condition_texts(decision.conditions),
        requires=tuple(requirement.text for requirement in decision.requires),
        counterexample=decision.counterexample,
        reason=decision.reason,
        text=text,
        seconds=perf_counter() - start,
    )
