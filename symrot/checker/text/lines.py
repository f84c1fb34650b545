"""The verdict on several equations: a chain ``a = b = c``, or lines; one line may define a name for the others."""

from collections.abc import Collection, Sequence
from dataclasses import replace

from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.named_formula import named_formula
from symrot.checker.claim.notation import Notation
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim_verdict import check_claim
from symrot.checker.recognition.together import fit_together, misplaced
from symrot.checker.text.equation import names_in
from symrot.checker.text.repairs import as_typed, in_notation, relation_of
from symrot.checker.verdict import Diagnosis, Verdict
from symrot.exact import normal_form

__all__ = ["OUTCOMES", "verdict_on_parts", "with_all_conditions"]

WORST_FIRST = ("false", "doubtful", "undecided", "conditional", "definition", "recognised", "true")
"""Verdicts, the worst first: the verdict on a text is the worst of the verdicts on its equations."""

APART = "each line is a formula that symrot derives, but no single body, frame or sequence gives all of them"

MOST_LINES, MOST_EDITS_OF_LINE = 4, 120
"""Largest numbers of lines of a claim, and of edits of each line, in the search for an edit of one wrong line.

The edit must make all lines formulas of the same body, frame or sequence.
"""

NAMING = ("definition", "recognised")

OUTCOMES = {
    "true": "true", "false": "false", "conditional": "true under a condition only", "undecided": "undecided",
    "recognised": "a formula that symrot derives", "doubtful": "nearly a formula that symrot derives",
    "definition": "a definition, which symrot does not judge",
}  # fmt: skip
"""Verdict -> the words for it in a sentence."""


def verdict_on_parts(
    lines: Sequence[Sequence[Claim]], verdicts: Sequence[Verdict], notation: Notation, has_units: bool = False
) -> Verdict:
    """Return the worst verdict on the equations of a chain or of several lines, with a note on each.

    Definitions of names that other lines use do not count, unless there is nothing else. The verdict is "doubtful" if
    each equation is recognised, but as formulas of different bodies, frames or sequences. ``verdicts`` are the verdicts
    on the equations of ``lines``, in order. If ``has_units``, the first side of a chain is a number with a unit, not a
    name.
    """
    remaining = iter(verdicts)
    counted, notes = [], []
    total = sum(map(len, lines))
    for place, line in enumerate(lines):
        own = [next(remaining) for _ in line]
        own = own if has_units else _as_named_chain(line, own, notation)
        others = [*lines[:place], *lines[place + 1 :]]
        elsewhere = {name for other in others for claim in other for name, _ in claim.define}
        named = named_formula(line[0])
        relation = line[0].relation
        name = named.name if named is not None else str(relation[1].value) if relation is not None else ""
        defines = name in elsewhere
        for claim, verdict in zip(line, own, strict=True):
            assert claim.relation is not None
            words = (
                OUTCOMES[verdict.verdict]
                if not (defines and verdict.verdict == "definition")
                else "a definition that other lines use"
            )
            formulas = f": the {verdict.recognised_as[0]}" if verdict.recognised_as else ""
            relation = relation_of(as_typed(relation_text(claim.relation), claim.written))
            notes.append(f"{notation.relation(relation or claim.relation)} is {words}{formulas}")
            notes += [note for note in verdict.notes if note not in claim.notes]
            if not (defines and verdict.verdict in NAMING and total > 1):
                counted.append(verdict)
    counted = counted or list(verdicts)
    worst = min(counted, key=lambda verdict: WORST_FIRST.index(verdict.verdict))
    if worst.verdict != "false":  # all equations are defined only where each one is
        conditions = dict.fromkeys(condition for verdict in counted for condition in verdict.conditions)
        worst = replace(worst, conditions=tuple(conditions))
    claims = [claim for line in lines for claim in line]
    by_name = [
        (str(claim.relation[1].value), names_in(claim.relation[2]), verdict)
        for claim, verdict in zip(claims, verdicts, strict=True)
        if claim.relation is not None and claim.relation[1].kind == "name"
    ]
    if worst.verdict == "recognised" and not fit_together(by_name):
        worst = replace(worst, verdict="doubtful", recognised_as=(), reason=APART)
        worst = _with_fitting_line(claims, by_name, notation, worst)
    claim_notes = [note for line in lines for claim in line for note in claim.notes]
    seconds = sum(verdict.seconds for verdict in verdicts)
    return replace(worst, notes=tuple(dict.fromkeys([*claim_notes, *notes])), seconds=seconds)


def _with_fitting_line(
    claims: Sequence[Claim], lines: Sequence[tuple[str, Collection[str], Verdict]], notation: Notation, verdict: Verdict
) -> Verdict:
    """Return the verdict on lines that are known formulas for different bodies, frames or sequences.

    The returned verdict is ``verdict`` with a repair: the edit of one line after which all lines are for the same body,
    frame or sequence. Return ``verdict`` unchanged if no such edit is found.
    """
    if len(lines) != len(claims) or len(lines) > MOST_LINES or any(claim.hypotheses for claim in claims):
        return verdict
    from symrot.checker.recognition.naming.edited import recognised_edits  # it takes longer to import than most checks
    from symrot.checker.repair.edits.faults import FAULT_DESCRIPTIONS

    nearest: tuple[tuple[int, float], Verdict] | None = None  # without such an edit, the verdict is unchanged
    for place, claim in enumerate(claims):
        named = named_formula(claim)
        letters = {letter for _, own, _ in lines for letter in own}
        edits = recognised_edits(claim, named, letters, MOST_EDITS_OF_LINE) if named is not None else ()
        for repair, other in edits:
            relation = read_relation(repair.text)
            changed = [*lines[:place], (lines[place][0], names_in(relation[2]), other), *lines[place + 1 :]]
            rank = misplaced(changed), repair.cost
            if (nearest is None or rank < nearest[0]) and fit_together(changed):
                marked = in_notation(repair, claim, notation)
                diagnosis = Diagnosis(repair.code, FAULT_DESCRIPTIONS[repair.code])
                nearest = rank, replace(verdict, diagnosis=diagnosis, repairs=(marked,))
    return verdict if nearest is None else nearest[1]


def with_all_conditions(verdict: Verdict, conditions: Sequence[Sequence[str]], both_signs: bool) -> Verdict:
    """Return ``verdict``, on several equations, with the conditions of all of them: "a > 0 and c > 0".

    ``conditions`` has, for each conditional equation, its alternative conditions, which are joined by "or" in brackets.
    If ``both_signs``, the two equations are those with the upper and the lower sign of ±, and the conditions
    stay separate: "a > 0 for the upper sign".
    """
    texts = list(dict.fromkeys(" or ".join(alternatives) for alternatives in conditions))
    stated = {condition for alternatives in conditions for condition in alternatives}
    others = tuple(condition for condition in verdict.conditions if condition not in stated)
    if both_signs:
        required = tuple(f"{text} for the {word} sign" for text, word in zip(texts, ("upper", "lower"), strict=False))
    else:
        required = tuple(conditions[0]) if len(texts) == 1 else (" and ".join(map(_bracketed, texts)),)
    return replace(verdict, requires=required, conditions=(*required, *others), diagnosis=Diagnosis("none", ""))


def _bracketed(text: str) -> str:
    """Return a condition in brackets if it has an "or" outside of brackets, so that "and" cannot split it."""
    depth, outside = 0, []
    for letter in text:
        depth += (letter == "(") - (letter == ")")
        outside.append(letter if not depth else "|")
    return f"({text})" if " or " in "".join(outside) else text


def _as_named_chain(line: Sequence[Claim], verdicts: Sequence[Verdict], notation: Notation) -> list[Verdict]:
    """Return the verdicts on the equations of a chain ``name = a = b``; the verdict on ``a = b`` may be replaced.

    A chain such as ``E = I*omega^2/2 = L^2/(2*I)`` states two formulas for E, which are not equal for all values of
    the letters. So if ``a = b`` is not an identity, and a and b each have a letter that is absent from the other, the
    verdict on ``name = b`` replaces the verdict on ``a = b``.

    A chain such as ``y = sin x = 1/2`` states the value of y for certain x. So if b is a number, and a depends on its
    letters, a false ``a = b`` gets the verdict "definition".

    Chains that do not begin with a name keep their ``verdicts``.
    """
    named = named_formula(line[0]) if len(line) > 1 else None
    if named is None or line[0].relation is None or line[0].relation[1] != named.side:
        return list(verdicts)
    decided = [verdicts[0]]
    for claim, verdict in zip(line[1:], verdicts[1:], strict=True):
        assert claim.relation is not None
        _, left, right = claim.relation
        others = names_in(right) - names_in(left)  # both formulas in E = I*omega^2/2 = L^2/(2*I) give E
        if verdict.verdict in ("false", "conditional", "definition") and others and names_in(left) - names_in(right):
            renamed = claim.with_relation(("==", named.side, right))
            under_name = check_claim(renamed)
            repairs = tuple(in_notation(repair, renamed, notation) for repair in under_name.repairs)
            under_name = replace(under_name, repairs=repairs)
            link = notation.relation(claim.relation)
            note = f"{link} is not an identity, since only one side has {', '.join(sorted(others))}"
            verdict = replace(under_name, notes=(*under_name.notes, note))
        elif verdict.verdict == "false" and not names_in(right) - {"pi"} and _depends_on_letters(claim):
            letters = " and ".join(sorted(names_in(left) - {"pi"}))
            reason = f"the equation holds only for certain values of {letters}, and the text does not state any"
            verdict = Verdict("definition", reason=reason)
        decided.append(verdict)
    return decided


def _depends_on_letters(claim: Claim) -> bool:
    """Return whether a claim's left side is a scalar whose value depends on a letter: False for sin²x + cos²x, or 1."""
    # if so, sin x = 1/2 in y = sin x = 1/2 is no error, but holds for certain x
    left = claim.equation.left
    return not is_matrix(left) and bool(normal_form(left).free_symbols)
