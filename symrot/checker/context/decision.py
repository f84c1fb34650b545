"""Verdicts on claims about a quantity in a context, which states the meanings of names.

A known formula, such as the "moment of inertia of a rod about an end", is meant if the context or the claim's quantity
states each word of the formula's name. The claim is true if it equals a formula that is meant, false if it differs from
all of them.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, permutations, zip_longest
from typing import Any

from sympy import Expr, cancel, sqrt

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, text
from symrot.checker.context.admission import COMPONENTS, admits_name, guesses, is_at_open_place, is_component, misfits
from symrot.checker.context.context import letters_of
from symrot.checker.context.lacking_letters import with_lacking_letters
from symrot.checker.context.meant_formulas import ANGLE, Meant, all_known, assignments_of, meant_by, with_letters
from symrot.checker.context.open_choices import with_axes, with_guesses, with_order, with_sides, with_tangent
from symrot.checker.context.quantities import plain_words
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.recognition.identification import known_value
from symrot.checker.recognition.known_formulas import Known
from symrot.checker.recognition.naming.edited import recognised_edits
from symrot.checker.recognition.naming.quantities import has_word, words_of
from symrot.checker.recognition.naming.readings import SQUARED
from symrot.checker.recognition.naming.verdicts import verdict_on_name
from symrot.checker.repair.diagnose import MOST_REPAIRS, diagnose
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = ["in_context"]

MOST_DIAGNOSED = 4
"""The largest number of known formulas with which a false claim is compared to find its fault; a formula counts once
for each assignment of letters."""

COST_OF_WHOLE = 2.0
"""The cost of a repair that replaces the whole formula of a claim by a derived one. If the context leaves open through
which point the axis goes, a claim is called "doubtful" only for a repair that costs less."""


def in_context(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim about a quantity, with the words of its context used.

    ``verdict`` is the verdict without these words.
    """
    verdict = _with_all_words(claim, named, verdict)
    sequence = claim.context.sequence
    if verdict.verdict not in ("false", "doubtful", "definition") or not sequence.islower():
        return verdict
    # perhaps the user did not know that lower case means fixed axes
    note = f"{sequence} in lower case is about fixed axes; for moving axes write {sequence.upper()}"
    return replace(verdict, notes=(*verdict.notes, note))


def _with_all_words(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim in its context, a weaker one if the check cannot use a word of the context.

    The claim is compared with the known formulas whose names fit the context, which gives a verdict such as "true" or
    "false". If the comparison does not use a word of the context, "recognised" (equal to a known formula) replaces
    "true", and ``verdict``, the verdict without the context, replaces "false". If symrot does not understand a word
    about the body, or the context does not say where the pivot is, return "definition" (the claim is not judged).
    """
    # words about the body or its axis that symrot does not understand leave open what the claim means
    if obscure := claim.context.obscure:
        reason = f"these words of the context are not understood: {obscure}; leave them out, or use other words"
        return Verdict("definition", reason=reason)
    without, verdict = verdict, _by_context(claim, named, verdict)
    if any(is_at_open_place(claim.context, known.name) for known in verdict.recognised_as):
        reason = "nothing says at which place of the body the pivot is; write for example 'about an end'"
        return Verdict("definition", reason=reason)
    if verdict.verdict == "true":
        verdict = with_order(claim.context, verdict, [*letters_of(named.formula)])
        verdict = with_tangent(claim.context, with_axes(claim.context, with_sides(verdict)))
    names = " ".join(known.name for known in verdict.recognised_as)
    own = {*plain_words(names).split(), *plain_words(text(named.formula)).split(), *ENGLISH}
    letters = {letter.lower() for letter in letters_of(named.formula)}
    # a word is also used if the claim or the names of its formulas have it
    unused = [word for rest in claim.context.rest for word in rest.split() if word not in own | letters]
    if not unused:
        return verdict
    note = f"these words of the context are not used: {' '.join(unused)}"
    if verdict.verdict == "true":
        return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))
    return replace(without if verdict.verdict == "false" else verdict, notes=(*verdict.notes, note))


MOST_EDITS = 40
"""The largest number of edits of a claim's formula that are tried as repairs of a formula that symrot derives for
another quantity, body or point than the context states."""


ENGLISH = ("from", "to", "that", "at", "between", "on", "of")


def _by_context(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict that follows from comparing a claim with the known formulas whose names fit its context.

    Return ``verdict``, the verdict without the context, if the comparison decides nothing.
    """
    # the caller checks that all words of the context are used
    context, quantity = claim.context, _name(named)
    stated = _stated_by_name(named)
    if verdict.verdict in ("recognised", "doubtful"):
        complete = tuple(k for k in verdict.recognised_as if not k.how and not guesses(context, k.name, stated))
        if complete and verdict.verdict == "recognised":
            return _true(claim, named, replace(verdict, recognised_as=complete))
        if complete and (decision := _against_repair(claim, named, verdict)) is not None:
            return _false(replace(verdict, recognised_as=complete), decision)
    if verdict.verdict == "recognised":
        decided = _by_meant_formulas(claim, named, verdict, quantity, stated)
        is_true = decided is not None and decided.verdict == "true"
        return decided if decided is not None and is_true else with_guesses(context, verdict, stated)
    decided = _by_meant_formulas(claim, named, verdict, quantity, stated)
    verdict = verdict if decided is None or (verdict.repairs and not decided.counterexample) else decided
    if verdict.verdict in ("true", "recognised"):
        return verdict
    if verdict.verdict == "definition" and (lacking := _on_lacking_letters(claim, named, quantity, stated)) is not None:
        return lacking
    if other := _without_context(claim, named):
        known = min(other, key=lambda reading: len([*misfits(context, reading.name, quantity)]))
        reasons = list(misfits(context, known.name, quantity))
        if not reasons and verdict.verdict == "definition":  # an author may use other words for a letter
            reason = f"the context gives the letters other meanings than in the formula of the {known.name}"
            return replace(verdict, reason=reason)
        reasons = reasons or ["with other letters"]
        is_partly_known = context.body is not None and not context.body.kind.shape
        if is_partly_known and verdict.verdict == "definition" and "of another body" in reasons:
            return verdict  # symrot derives a few formulas only for such a body
        sentence = f"this is the formula {' and '.join(reasons)}: the {known.name}"
        word = "doubtful" if verdict.verdict == "definition" else verdict.verdict
        if verdict.repairs and verdict.diagnosis.code not in ("none", "derived"):
            whole = replace(verdict.diagnosis, text=f"{verdict.diagnosis.text}; {sentence}")
            return replace(verdict, verdict=word, diagnosis=whole, reason="")
        # only repairs that the context admits
        repairs = tuple(islice((repair for repair, _ in recognised_edits(claim, named, (), MOST_EDITS)), MOST_REPAIRS))
        return replace(verdict, verdict=word, diagnosis=Diagnosis("context", sentence), reason="", repairs=repairs)
    return verdict


def _without_context(claim: Claim, named: NamedFormula) -> tuple[Identification, ...]:
    """Return the known formulas that would equal the claim with less or other context.

    Three contexts are tried until one gives a formula: the body without a stated point or axis; the frame body instead
    of space, or space instead of body; no context at all.
    """
    context = claim.context
    if context.body and (context.place or context.body.axes):
        elsewhere = replace(context, body=replace(context.body, place="", axes=""))
        # a claim about an end may be the formula for the centre: the message names it
        of_body = verdict_on_name(replace(claim, context=elsewhere), named, repair=False).recognised_as
        if of_body:
            return of_body
    if context.frame:
        flipped = replace(context, frame="space" if context.frame == "body" else "body")
        in_other_frame = verdict_on_name(replace(claim, context=flipped), named, repair=False).recognised_as
        if in_other_frame:
            return in_other_frame
    return verdict_on_name(claim.without_context, named, repair=False).recognised_as


def _name(named: NamedFormula) -> str:
    """Return the name of the quantity for which a claim gives a formula; for the rate of phi, return ``dphi``."""
    return f"d{named.name}" if named.is_rate else named.name


def _stated_by_name(named: NamedFormula) -> str:
    """Return the words that the name of a claim's quantity implies: "first component" for the index 1."""
    words = list(words_of(named) or ())
    if re.fullmatch(r"[RACQ](_?\w+)?", named.name):
        words.append("rotation matrix")
    index = _name(named)[-1]
    is_angle_rate = re.fullmatch(f"d({ANGLE})", _name(named)) is not None
    words += [word for word, letters in COMPONENTS.items() if index in letters or is_angle_rate]
    return " ".join(words)


def _true(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict "true" with the conditions under which the claim's formula has a value."""
    conditions = _decided(claim, named.formula, named.formula).conditions
    return replace(verdict, verdict="true", conditions=tuple(map(as_text, conditions)))


def _false(verdict: Verdict, decision: Decision) -> Verdict:
    """Return the verdict "false" on a claim, with a point at which its formula differs from the known one."""
    return replace(verdict, verdict="false", counterexample=decision.counterexample, reason="")


def _decided(claim: Claim, left: Node, right: Node) -> Decision:
    """Return the decision on ``left == right``, two trees with the names of a claim."""
    return decide_equation(claim.with_relation(("==", left, right), alternatives=()).equation)


def _against_repair(claim: Claim, named: NamedFormula, verdict: Verdict) -> Decision | None:
    """Return the decision "false" if a claim's formula provably differs from ``verdict.repairs[0]``; otherwise None."""
    try:
        _, _, repaired = read_relation(verdict.repairs[0].text)
        decision = _decided(claim, named.formula, repaired)
    except (InputError, TooLarge):
        return None
    return decision if decision.verdict == "false" else None


def _value(claim: Claim, named: NamedFormula) -> Any:
    """Return the value that a claim gives to its quantity, as an Expr or a matrix; None if its formula has no value."""
    try:
        formula = named.formula if named.solve is None else named.solve(named.formula)
        return claim.with_definitions(claim.interpreter().read(formula))
    except InputError:
        return None


def _by_meant_formulas(
    claim: Claim, named: NamedFormula, verdict: Verdict, quantity: str, stated: str
) -> Verdict | None:
    """Return the verdict by comparing a claim with all known formulas whose names fit its context; None if undecided.

    The name "moment of inertia of a thin rod about an end" fits a context with the words "rod" and "about an end".
    """
    if (value := _value(claim, named)) is None:
        return None
    words = None if claim.context.meaning_of(quantity) else words_of(named)
    meant = [other for other in meant_by(claim.context, value, quantity, stated) if has_word(other.known.name, words)]
    decisions = [(candidate, _equal(candidate.value, value)) for candidate in meant]
    # one undecided comparison leaves the claim open
    if not meant or any(decision is None or _is_open(decision) for _, decision in decisions):
        return None
    equal = [candidate for candidate, decision in decisions if decision and decision.verdict == "true"]
    if not equal and any(_is_transposed(candidate.value, value) for candidate in meant):
        return None  # a matrix from space to body
    names = {candidate.known.name for candidate in meant}
    same = {candidate.known.name for candidate in equal}
    is_open = any(candidate.open_place for candidate in meant)
    if equal:
        readings = tuple(candidate.identification for candidate in equal)
        if same == names or not equal[0].open_place:
            return _true(claim, named, Verdict("recognised", recognised_as=readings))
        return with_guesses(claim.context, Verdict("recognised", recognised_as=readings), stated)
    known_decisions = [(candidate, decision) for candidate, decision in decisions if decision is not None]
    if is_open and any(_is_shifted(value, candidate) for candidate in meant):
        return None
    if is_open:
        return _near(claim, named, known_decisions)
    return _different(claim, named, verdict, [*known_decisions, *_transposed(known_decisions)])


def _transposed(decisions: Sequence[tuple[Meant, Decision]]) -> Iterator[tuple[Meant, Decision]]:
    """Yield the transpose of each known rotation matrix in ``decisions``, with the decision on the matrix itself."""
    for candidate, decision in decisions:
        # known matrices map body components to space components; the author may mean the inverse map
        if candidate.known.name.startswith("rotation matrix"):
            yield replace(candidate, value=candidate.value.T, how="transposed"), decision


def _on_lacking_letters(claim: Claim, named: NamedFormula, quantity: str, stated: str) -> Verdict | None:
    """Return "doubtful" if a claim lacks one term or factor of a known formula that fits its context; else None.

    For instance, ``m*g*l`` lacks the factor ``sin(theta)`` of ``m*g*l*sin(theta)``. ``quantity`` is the name for which
    the claim gives a formula, such as omega_1, and ``stated`` are words that this name implies, "first component". The
    context must state the body.
    """
    context = claim.context
    own_meaning = context.meaning_of(quantity)
    if context.body is None and (own_meaning is None or own_meaning.body is None):
        return None
    if (value := _value(claim, named)) is None:
        return None
    stated_formulas = (
        (known, with_letters(context, known_value(known.text)))
        for known in all_known()
        if not known.is_step and not known.is_relation and not known.name.endswith(SQUARED)
        and admits_name(context, known.name, quantity)
        and (own_meaning is not None or any(word in known.name for word in stated.split()))
        and is_component(known.name, quantity)
        and not guesses(context, known.name, stated)
    )  # fmt: skip

    def assignments(known: Known, target: Any, own: set[Expr]) -> Iterator[Mapping[Expr, Expr]]:
        return assignments_of(context, target, own, quantity, known, is_specific=True)

    # the term must have letters of its own, as h in the moment of a cylinder, of which m*r^2/4 is a part
    return with_lacking_letters(named, value, stated_formulas, assignments)


def _is_transposed(target: Any, value: Any) -> bool:
    """Return whether the square matrix ``value`` is provably the transpose of ``target``."""
    if not is_matrix(value) or value.rows != value.cols:
        return False
    decision = _equal(target.T, value)
    return decision is not None and decision.verdict == "true"


def _is_open(decision: Decision) -> bool:
    """Return whether a decision leaves open whether two formulas are equal: it is undecided, or depends on signs."""
    if decision.verdict == "conditional":
        # equal for special values only, such as equal moments of inertia: the formulas differ
        return any(requirement.signs or not requirement.zeros for requirement in decision.requires)
    return decision.verdict not in ("true", "false")


def _different(
    claim: Claim, named: NamedFormula, verdict: Verdict, decisions: Sequence[tuple[Meant, Decision]]
) -> Verdict:
    """Return the verdict "false" on a claim that differs from all known formulas whose names fit its context.

    ``decisions`` are pairs: such a formula, and the decision that the claim differs from it.
    """
    (candidate, decision), *_ = decisions
    diagnosis, repairs = verdict.diagnosis, verdict.repairs
    is_solved = named.solve is None or named.solve(named.formula) == named.formula
    if not repairs and is_solved:
        diagnoses = [(*_diagnosed(claim, named, *pair), *pair) for pair in decisions[:MOST_DIAGNOSED]]
        repaired = sorted((known for known in diagnoses if known[1]), key=lambda known: known[1][0].cost)
        if repaired:
            diagnosis, repairs, candidate, decision = repaired[0]
            repairs = _different_repairs([known[1] for known in repaired])
        else:
            diagnosis = Diagnosis("derived", f"it is not the {candidate.identification.name}")
            if len({as_text(other.value) for other, _ in decisions}) == 1:
                repairs = (Repair(f"{text(named.side)} == {as_text(candidate.value)}", "derived", COST_OF_WHOLE),)
    return Verdict(
        "false", counterexample=decision.counterexample, diagnosis=diagnosis, repairs=repairs,
        recognised_as=(candidate.identification,),
    )  # fmt: skip


def _different_repairs(repairs: Sequence[tuple[Repair, ...]]) -> tuple[Repair, ...]:
    """Return at most three repairs with different texts: the first repair in each tuple, then the second ones, and so
    on.

    Each tuple of ``repairs`` has the repairs that make a claim equal to one known formula, the best repair first.
    """
    in_turn = [repair for rank in zip_longest(*repairs) for repair in rank if repair is not None]
    return tuple({repair.text: repair for repair in in_turn}.values())[:MOST_REPAIRS]


def _is_shifted(value: Any, candidate: Meant) -> bool:
    """Return whether a claim's moment of inertia is the formula ``candidate`` plus m d^2, for a parallel axis at a
    distance d that is a rational multiple of one of the claim's lengths.
    """
    if is_matrix(value) or not candidate.known.name.startswith("moment of inertia of a"):
        return False
    added = cancel(value - candidate.value)
    shares = (cancel(added / (mass * length**2)) for mass, length in permutations(added.free_symbols, 2))
    return any(share.is_Rational and share > 0 and sqrt(share).is_Rational for share in shares)


def _near(claim: Claim, named: NamedFormula, decisions: Sequence[tuple[Meant, Decision]]) -> Verdict | None:
    """Return the verdict "doubtful" if a claim's formula has one fault compared with a known formula; otherwise
    None.
    """
    # the claim leaves open which place its axis goes through, so that it cannot be called false
    for candidate, decision in decisions[:MOST_DIAGNOSED]:
        diagnosis, repairs = _diagnosed(claim, named, candidate, decision)
        if repairs and repairs[0].cost < COST_OF_WHOLE and diagnosis.code != "two_faults":
            readings = (candidate.identification,)
            return Verdict("doubtful", diagnosis=diagnosis, repairs=repairs, recognised_as=readings)
    return None


def _diagnosed(
    claim: Claim, named: NamedFormula, candidate: Meant, decision: Decision
) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return the fault by which a claim's formula differs from the known formula ``candidate``, and repairs, if any."""
    none = Diagnosis("none", "")
    try:
        target = read_expression(as_text(candidate.value))
        against = replace(claim, editable=("left",)).with_relation(("==", named.formula, target), alternatives=())
        diagnosis, repairs = diagnose(against, replace(decision, requires=(), verdict="false"))
    except (InputError, TooLarge):
        return none, ()
    end = f" == {text(target)}"
    own = tuple(
        replace(repair, text=f"{text(named.side)} == {repair.text.removesuffix(end)}")
        for repair in repairs
        if repair.text.endswith(end)
    )
    return (diagnosis if own else none), tuple(sorted(own, key=_neatness))


def _neatness(repair: Repair) -> tuple[bool, int]:
    """Return a sort key: repairs of one fault come before repairs of two faults, and short ones before long ones."""
    return repair.code == "two_faults", len(repair.text)


def _equal(target: Any, value: Any) -> Decision | None:
    """Return the decision on the equation ``value == target``; None if the equation is refused, as for its size."""
    try:
        return decide_equation(Equation(value, target))
    except (InputError, TooLarge):
        return None
