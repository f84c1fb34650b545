"""The verdict on a text with units, such as ``1500 rpm = 157.08 rad/s``, and possibly letters: ``F = m a = 6 N``."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from symrot.checker.claim.notation import notation_of
from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.source.lines import claims_of_reading
from symrot.checker.claim_verdict import check_claim
from symrot.checker.marks import changed_spans
from symrot.checker.measured import with_units
from symrot.checker.rounding import with_rounding
from symrot.checker.text.lines import OUTCOMES, verdict_on_parts
from symrot.checker.units.conversion import (
    ONE_PER_SECOND,
    STANDARD_GRAVITY,
    Measured,
    numeric_end,
    unit_beside_letters,
)
from symrot.checker.verdict import Repair, Verdict
from symrot.errors import InputError

__all__ = ["beside_units", "verdict_on_measured"]


def verdict_on_measured(
    measured: Measured, source: str, assume: Sequence[str], units: Mapping[str, str] | None, repair: bool
) -> Verdict:
    """Return the verdict on a text whose numbers have units, as ``measured`` interprets them.

    Raises
    ------
    InputError
        If the usual reading of the text has no meaning, and no other reading makes the text true.
    """
    verdicts, refusal = [], None
    for words, reading in (("", measured), *measured.others):
        try:
            verdicts.append((words, _on_units(reading, source, assume, units, repair)))
        except InputError as reason:
            refusal = refusal or reason
    usual = next((verdict for words, verdict in verdicts if not words), None)
    fitting = [pair for pair in verdicts if pair[1].diagnosis.code != "dimension"] or verdicts
    # g may be a gram or an acceleration: a true interpretation, or the first one with consistent units
    true = (pair for pair in fitting if pair[1].verdict == "true" and pair[0] != ONE_PER_SECOND)
    words, verdict = next(true, fitting[0] if fitting else ("", None))
    if verdict is None or (refusal is not None and usual is None and verdict.verdict != "true"):
        raise refusal or InputError(f"expected numbers with units, got {source[:60]!r}")
    if words == STANDARD_GRAVITY and verdict.verdict == "false":
        sentence = f"g is an acceleration here, and its value is not stated; {words}, the text is false"
        return Verdict("definition", text=source.strip(), reason=sentence)
    if words:
        verdict = replace(verdict, notes=(*verdict.notes, f"read {words}"))
    elif usual is verdict:
        notes = [
            f"{others}, it is {OUTCOMES[other.verdict]}"
            for others, other in verdicts
            if other.verdict != verdict.verdict and other.diagnosis.code != "dimension"
        ]
        verdict = replace(verdict, notes=(*verdict.notes, *notes))
    return verdict


def _on_units(
    measured: Measured, source: str, assume: Sequence[str], units: Mapping[str, str] | None, repair: bool
) -> Verdict:
    """Return the verdict on one interpretation, ``measured``, of a text whose numbers have units."""
    reading = readings_of(measured.text)[0]
    lines = claims_of_reading(reading, measured.text, assume, units)
    notation = notation_of(reading)
    parts = [
        with_units(claim, measured, lambda other: with_rounding(other, check_claim(other, repair)))
        for line in lines
        for claim in line
    ]
    verdict = parts[0] if len(parts) == 1 else verdict_on_parts(lines, parts, notation, has_units=True)
    diagnosis = replace(verdict.diagnosis, text=measured.restored(verdict.diagnosis.text))
    notes = tuple(map(measured.restored, verdict.notes))
    digits = (repair for repair in verdict.repairs if repair.code == "digits")  # others lack the units
    repairs = tuple(_with_own_units(repair, measured, source.strip()) for repair in digits)
    return replace(verdict, text=source.strip(), diagnosis=diagnosis, notes=notes, repairs=repairs)


def _with_own_units(repair: Repair, measured: Measured, source: str) -> Repair:
    """Return a repair with units in place of their names: ``5 % = 0.05`` for ``(5*unit_1) = 0.05``."""
    written = measured.restored(re.sub(r"\((\d+(\.\d+)?\*unit_\d+)\)", r"\1", repair.text))
    return repair if written == repair.text else replace(repair, text=written, changed=changed_spans(source, written))


def beside_units(verdict: Verdict, source: str, decide: Callable[[str], Verdict]) -> Verdict:
    """Return the verdict "definition" on an equation with letters and a unit, such as ``F = m a = 6 N``.

    If the text ends with an equation between numbers with units, this equation is decided by itself. If it is false, as
    2 N = 3 N in ``F = m a = 2 N = 3 N``, the verdict is "false". For other texts, the argument ``verdict`` on
    ``source`` is returned. ``decide`` returns the verdict on a text.
    """
    unit = "" if verdict.recognised_as else unit_beside_letters(source)
    # an end such as 2 kg * 3 m/s^2 = 6 N is decided by itself; if it is false, the text is false
    beginning, end = numeric_end(source) if unit or verdict.verdict == "false" else ("", "")
    numbers = decide(end) if end else None
    while not unit and numbers is not None and numbers.verdict != "true" and end.count("=") > 1:
        first, _, end = map(str.strip, end.partition("="))  # the letters of a formula such as 2 g h were read as units
        beginning, numbers = f"{beginning} = {first}", decide(end)
    if not unit and numbers is not None and numbers.verdict == "true":
        unit = end.rpartition("=")[2].strip()
    if not unit:
        return verdict
    notes = tuple(note for note in verdict.notes if not note.endswith("is read as a name, not as a unit"))
    if numbers is not None:
        notes = (
            *numbers.notes,
            f"{end} is {OUTCOMES[numbers.verdict]}; {beginning} contains letters and is not checked",
        )
        if numbers.verdict == "false":
            return replace(numbers, text=verdict.text, notes=notes)
    elif verdict.verdict not in ("false", "conditional", "undecided"):
        return verdict
    reason = f"it contains letters and a number with a unit, {unit}: it is an equation for the letters, not an identity"
    return Verdict("definition", text=verdict.text, context=verdict.context, reason=reason, notes=notes,
                   seconds=verdict.seconds)  # fmt: skip
