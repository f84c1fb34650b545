"""The verdict on a text by its likeliest interpretation (here: reading), usually the first.

A note reports each other reading whose verdict differs.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from symrot.checker.claim.notation import Notation, TypedNotation, notation_of
from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.source.lines import claims_of_reading
from symrot.checker.claim.source.text import functions_of_time, names_in_hypotheses
from symrot.checker.claim_verdict import is_unfinished
from symrot.checker.context.context import NO_CONTEXT, Context, quantities_of
from symrot.checker.inequality import OPPOSITE, is_inequality, verdict_on_inequality
from symrot.checker.text.equation import for_numbers, verdict_on_equation
from symrot.checker.text.lines import OUTCOMES, verdict_on_parts, with_all_conditions
from symrot.checker.text.repairs import as_inequality
from symrot.checker.text.units import beside_units, verdict_on_measured
from symrot.checker.typed.readings import Declared, Reading
from symrot.checker.units.conversion import (
    measured_text,
)
from symrot.checker.verdict import Verdict
from symrot.errors import InputError

__all__ = ["verdict_on_readings", "verdict_on_text"]

DECIDED = ("true", "false", "conditional", "undecided")

UNUSED_CONTEXT = "the context is not used, since the claim can be decided without it"


def verdict_on_text(
    source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None, repair: bool = True,
    stated: Context = NO_CONTEXT,
) -> Verdict:  # fmt: skip
    """Return the verdict on a text as people type it, with a note on every other reading whose verdict differs.

    Parameters
    ----------
    source : str
        The text.
    assume : sequence of str
        Hypotheses, such as ``"x > 0"``.
    units : mapping of str to str, optional
        Units by the name of a symbol.
    repair : bool
        Whether to look for true formulas near a claim that is not true.
    stated : Context
        What the user states in words about names, body, frame and sequence.

    Raises
    ------
    InputError
        For text that cannot be read, with the place, and for a text without a meaningful reading.
    """
    elsewhere = names_in_hypotheses(assume) if stated.meanings else set()
    if (measured := measured_text(source)) is not None:
        verdict = verdict_on_measured(measured, source, assume, units, repair)
        if not stated:
            return verdict
        stated.check_names(names_of(readings_of(measured.text)[0]), elsewhere)
        return replace(verdict, context=stated.echo, notes=(*verdict.notes, UNUSED_CONTEXT))
    readings = readings_of(source, declared=Declared(functions=functions_of_time(assume)))
    fitting = [reading for reading in readings if stated.fits(names_of(reading), elsewhere)] or readings[:1]
    return verdict_on_readings(fitting, notation_of, source, assume, units, repair, stated)


def verdict_on_readings(
    readings: Sequence[Reading], notation: Callable[[Reading], Notation], source: str, assume: Sequence[str] = (),
    units: Mapping[str, str] | None = None, repair: bool = True, stated: Context = NO_CONTEXT,
) -> Verdict:  # fmt: skip
    """Return the verdict on the likeliest interpretation of a text, with a note on any other whose verdict differs.

    ``notation(reading)`` tells how the formulas of an interpretation are written; the other arguments are as in
    :func:`verdict_on_text`.

    Raises
    ------
    InputError
        For text that cannot be read, with the place, and for a text without a meaningful reading.
    """
    verdicts: list[tuple[Reading, Verdict]] = []
    refusal: InputError | None = None
    late = False
    for reading in readings:
        late = any(is_unfinished(verdict) for _, verdict in verdicts)
        if late:
            break
        try:
            verdict = verdict_on_reading(
                reading, notation(reading), source, assume, units, repair and all(map(_is_unknown, verdicts)), stated
            )
        except InputError as reason:
            refusal = refusal or reason
            continue
        verdicts.append((reading, verdict))
        if stated and verdict.verdict in ("true", "false") and verdict.recognised_as:
            break  # the stated meaning leaves no other reading
    of_usual = readings[0] in [reading for reading, _ in verdicts]
    if refusal is not None and not of_usual and all(other.verdict == "false" for _, other in verdicts):
        raise refusal  # an unusual reading alone must not make a claim false
    known = ("recognised", "true") if stated else ("recognised",)
    likely = [other.verdict in known and not _renames_a_rate(other) for _, other in verdicts]
    first = likely.index(True) if any(likely) else 0
    if _is_unknown(verdicts[0]) and not first:
        wrong = [other.verdict == "doubtful" or _is_false_by_context(other, stated) for _, other in verdicts]
        first = wrong.index(True) if any(wrong) else 0
    if _is_unknown(verdicts[0]) or (first and verdicts[0][1].verdict == "doubtful" and not stated):
        verdicts.insert(0, verdicts.pop(first))  # a known formula is likelier than one near it or an unknown one
    (usual, verdict), *others = verdicts
    notes = list(verdict.notes)
    if refusal is not None and not of_usual:
        notes.append(f"read in the usual way, the text has no meaning: {refusal}")
    for reading, other in others:
        if other.verdict != verdict.verdict:
            notes.append(_on_reading(usual, reading, other, notation(reading)))
    if late:
        notes.append("other readings of the text were not decided, since one of them used up the budget for a claim")
    seconds = sum(other.seconds for _, other in verdicts)
    verdict = replace(verdict, notes=tuple(dict.fromkeys(notes)), seconds=seconds)
    return beside_units(verdict, source, verdict_on_text)


def _is_false_by_context(verdict: Verdict, stated: Context) -> bool:
    """Return whether a claim is false only because its context ``stated`` gives its quantity another formula."""
    return bool(stated) and verdict.verdict == "false" and bool(verdict.recognised_as)


def _renames_a_rate(verdict: Verdict) -> bool:
    """Return whether each known formula that the claim matches has the rate of an angle where the claim has x_prime.

    For instance, ψ' is read as a name, psi_prime, and the known formula has the rate dpsi in its place. Then the author
    probably means ψ' as the derivative of ψ, so that a reading with this derivative is more likely than this one.
    """
    return all(
        any(own.startswith("d") and other.endswith("_prime") for own, other in known.mapping.items())
        for known in verdict.recognised_as
    ) and bool(verdict.recognised_as)


def _is_unknown(reading: tuple[Reading, Verdict]) -> bool:
    """Return whether the verdict on a reading is "definition": symrot does not derive the formula."""
    return reading[1].verdict == "definition"


def names_of(reading: Reading) -> set[str]:
    """Return the names of quantities in a reading of a text; the rate of phi has the name dphi."""
    return {name for chain in reading.lines for side in chain.sides for name in quantities_of(side)}


def _on_reading(usual: Reading, reading: Reading, verdict: Verdict, notation: Notation) -> str:
    """Return a sentence with the verdict on a second way to read the claim's text: ``reading`` instead of ``usual``."""
    places = reading.flipped or usual.flipped
    if isinstance(notation, TypedNotation):
        notation = replace(notation, plain=usual.plain or reading.plain)
    changed = _text_of(reading, notation)
    excerpts = " and ".join(f"'{' '.join(place.split())}'" for place in dict.fromkeys(places[:3]))
    return f"{excerpts} can be read in two ways: read as {changed}, it is {OUTCOMES[verdict.verdict]}"


def _text_of(reading: Reading, notation: Notation) -> str:
    return "; ".join(
        " = ".join(notation.formula(side) for side in chain.sides) if set(chain.signs) == {"=="}
        else notation.relation(chain.links[0])
        for chain in reading.lines
    )  # fmt: skip


def verdict_on_reading(
    reading: Reading, notation: Notation, source: str, assume: Sequence[str] = (),
    units: Mapping[str, str] | None = None, repair: bool = True, stated: Context = NO_CONTEXT,
) -> Verdict:  # fmt: skip
    """Return the verdict on one interpretation of a text: on its only equation, or on all its equations."""
    if len(reading.lines) == 1 and is_inequality(reading.lines[0].signs):
        return _on_inequality(reading, notation, source, assume, units, stated)
    lines = claims_of_reading(reading, source, assume, units, stated)
    parts = [(claim, verdict_on_equation(claim, notation, repair, reading.plain)) for line in lines for claim in line]
    several = len(parts) > 1
    if not several and (numbers := for_numbers(reading, parts[0], source)) is not None:
        parts = [(parts[0][0], numbers)]
    verdict = verdict_on_parts(lines, [part for _, part in parts], notation) if several else parts[0][1]
    if several and verdict.verdict == "conditional":
        conditions = [part.requires for _, part in parts if part.requires]
        both_signs = len(conditions) == 2 and all(chain.both_signs for chain in reading.lines)
        verdict = with_all_conditions(verdict, conditions, both_signs)
    echo = _text_of(reading, notation)
    echo = echo if _differs(echo, source) else ""
    notes = verdict.notes
    if (
        stated
        and verdict.verdict in DECIDED
        and not any(part.recognised_as for part in [verdict, *(p for _, p in parts)])
    ):
        notes = (*notes, UNUSED_CONTEXT)
    return replace(verdict, text=source.strip(), reading=echo, context=stated.echo, notes=notes)


def _on_inequality(
    reading: Reading, notation: Notation, source: str, assume: Sequence[str], units: Mapping[str, str] | None,
    stated: Context,
) -> Verdict:  # fmt: skip
    """Return the verdict on an interpretation of a text as one inequality."""
    (chain,) = reading.lines
    (sign,) = chain.signs
    equation = replace(reading, lines=(replace(chain, signs=("==",)),))
    ((claim,),) = claims_of_reading(equation, source, assume, units, stated)
    left, right = chain.sides
    verdict = verdict_on_inequality(claim, sign, notation.relation((OPPOSITE[sign], left, right)))
    conditions = tuple(notation.condition(text) for text in verdict.conditions)
    repairs = tuple(as_inequality(repair, claim, sign, notation) for repair in verdict.repairs)
    verdict = replace(verdict, repairs=repairs)
    echo = _text_of(reading, notation)
    return replace(
        verdict, text=source.strip(), reading=echo if _differs(echo, source) else "", context=stated.echo,
        conditions=conditions, notes=(*claim.notes, *verdict.notes),
    )  # fmt: skip


def _differs(echo: str, source: str) -> bool:
    """Return whether ``echo``, the claim as symrot read it, differs from the typed text in more than blanks."""
    return "".join(echo.split()) != "".join(source.split()).replace("==", "=" if "==" not in echo else "==")
