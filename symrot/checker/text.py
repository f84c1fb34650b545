"""The verdict on a text as people type it, by its likeliest interpretation (here: reading), usually the first.

A note reports each other reading whose verdict differs. A chain ``a = b = c`` is decided equation by equation, and
several lines one by one; a line that gives a name to a formula defines the name for the next lines.
"""

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from symrot.checker.arrays.as_written import as_written, has_arrays, is_odd, with_inverses
from symrot.checker.arrays.index_notation import has_index_symbols
from symrot.checker.arrays.matrices import as_rotations, matrices_of_entries
from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.named_formula import named_formula
from symrot.checker.claim.notation import Notation, TypedNotation, notation_of
from symrot.checker.claim.reader import read_relation, readings_of
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.source.lines import claims_of_reading
from symrot.checker.claim.source.text import ON_PAULI, claim_of_relation, functions_of_time
from symrot.checker.claim.tree import TIME, Node, exchanged, number, walk, with_names
from symrot.checker.claim_verdict import check_claim, is_unfinished, within_limits
from symrot.checker.context.context import NO_CONTEXT, Context, quantities_of
from symrot.checker.inequality import OPPOSITE, is_inequality, verdict_on_inequality
from symrot.checker.marks import changed_entry, changed_spans
from symrot.checker.measured import in_degrees, with_units
from symrot.checker.open_equation import as_equation
from symrot.checker.recognition.together import fit_together, misplaced
from symrot.checker.rounding import with_rounding
from symrot.checker.special_cases import for_complex_numbers, for_special_directions
from symrot.checker.typed.readings import Declared, Reading, Relation
from symrot.checker.units.conversion import (
    ONE_PER_SECOND,
    STANDARD_GRAVITY,
    Measured,
    measured_text,
    numeric_end,
    unit_beside_letters,
)
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.errors import InputError
from symrot.exact import normal_form

__all__ = ["verdict_on_readings", "verdict_on_text"]

WORST_FIRST = ("false", "doubtful", "undecided", "conditional", "definition", "recognised", "true")
"""The order in which the verdicts on the parts of a text decide the verdict on the whole."""

APART = "each line is a formula that symrot derives, but no body, frame or sequence has all of them for its components"

INDICES = "it is in index notation, which is not decided; write one component, such as I_xy"

INDEX_CONDITION = "it restricts the quantities with indices that it names: it is a condition, and no identity"

MOST_LINES, MOST_EDITS_OF_LINE = 4, 120
"""The most lines, and the most edits of each, that are tried so that lines fit together."""

NAMING = ("definition", "recognised")
CALLS_FOR_ARRAYS = ("qmul(", "eye(", "⊗", "\\otimes")
"""Calls that answers have only if the claim has one of them, and signs for the product of quaternions."""


ROTATION = re.compile(r"[RCQ](_\w+)?")
"""The names of matrices that are rotations in most books."""

MASS_OR_INERTIA = re.compile(r"[mM](_?\w)?|[IJ]_\w+|rho")
"""Names in a formula for a tensor of inertia."""

AS_TYPED = ("degrees",)
"""The codes of repairs that are written in the notation of the input already."""

DECIDED = ("true", "false", "conditional", "undecided")
ARRAY = re.compile(r"[A-Zpq](_?[0-9])?")
"""Names that are often matrices or quaternions."""

UNUSED_CONTEXT = "the context is not used, since the formulas of the claim decide it"

OUTCOMES = {
    "true": "true", "false": "false", "conditional": "true under a condition only", "undecided": "undecided",
    "recognised": "a formula that symrot derives", "doubtful": "nearly a formula that symrot derives",
    "definition": "a definition, about which nothing is known",
}  # fmt: skip
"""Verdict -> the words for it in a sentence."""


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
        For text that cannot be read, with the place, and for a text of which no reading has a meaning.
    """
    if (measured := measured_text(source)) is not None:
        verdict = _on_measured(measured, source, assume, units, repair)
        if not stated:
            return verdict
        stated.check_names(names_of(readings_of(measured.text)[0]))
        return replace(verdict, context=stated.echo, notes=(*verdict.notes, UNUSED_CONTEXT))
    readings = readings_of(source, declared=Declared(functions=functions_of_time(assume)))
    fitting = [reading for reading in readings if stated.fits(names_of(reading))] or readings[:1]
    return verdict_on_readings(fitting, notation_of, source, assume, units, repair, stated)


def verdict_on_readings(
    readings: Sequence[Reading], notation: Callable[[Reading], Notation], source: str, assume: Sequence[str] = (),
    units: Mapping[str, str] | None = None, repair: bool = True, stated: Context = NO_CONTEXT,
) -> Verdict:  # fmt: skip
    """Return the verdict on the likeliest interpretation of a text, with notes on those whose verdict differs.

    Raises
    ------
    InputError
        For text that cannot be read, with the place, and for a text of which no reading has a meaning.
    """
    # notation: interpretation -> how its formulas are written; other arguments as in verdict_on_text
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
        notes.append(f"the usual reading has no meaning: {refusal}")
    for reading, other in others:
        if other.verdict != verdict.verdict:
            notes.append(_on_reading(usual, reading, other, notation(reading)))
    if late:
        notes.append("other readings of the text were not decided, since one needs more than the budget for a claim")
    seconds = sum(other.seconds for _, other in verdicts)
    return _beside_units(replace(verdict, notes=tuple(dict.fromkeys(notes)), seconds=seconds), source)


def _is_false_by_context(verdict: Verdict, stated: Context) -> bool:
    """Return whether a claim is false only because its context ``stated`` gives its quantity another formula."""
    return bool(stated) and verdict.verdict == "false" and bool(verdict.recognised_as)


def _renames_a_rate(verdict: Verdict) -> bool:
    """Return whether a claim is recognised only with a name such as psi_prime for the rate of another angle, dphi."""
    return all(
        any(own.startswith("d") and other.endswith("_prime") for own, other in known.mapping.items())
        for known in verdict.recognised_as
    ) and bool(verdict.recognised_as)


def _is_unknown(reading: tuple[Reading, Verdict]) -> bool:
    """Return whether the verdict on a reading is "definition": the reading is no formula that symrot derives."""
    return reading[1].verdict == "definition"


def _beside_units(verdict: Verdict, source: str) -> Verdict:
    """Return "definition" for a text with letters and a unit, ``F = m a = 6 N``, or "false" if its end,
    ``2 kg = 3 kg``, is false; otherwise ``verdict``.
    """
    unit = "" if verdict.recognised_as else unit_beside_letters(source)
    # an end such as 2 kg * 3 m/s^2 = 6 N is decided by itself; if it is false, the text is false
    beginning, end = numeric_end(source) if unit or verdict.verdict == "false" else ("", "")
    numbers = verdict_on_text(end) if end else None
    while not unit and numbers is not None and numbers.verdict != "true" and end.count("=") > 1:
        first, _, end = map(str.strip, end.partition("="))  # the letters of a formula such as 2 g h were read as units
        beginning, numbers = f"{beginning} = {first}", verdict_on_text(end)
    if not unit and numbers is not None and numbers.verdict == "true":
        unit = end.rpartition("=")[2].strip()
    if not unit:
        return verdict
    notes = tuple(note for note in verdict.notes if not note.endswith("is read as a name, not as a unit"))
    if numbers is not None:
        notes = (*numbers.notes, f"{end} is {OUTCOMES[numbers.verdict]}; {beginning} has letters and is not decided")
        if numbers.verdict == "false":
            return replace(numbers, text=verdict.text, notes=notes)
    elif verdict.verdict not in ("false", "conditional", "undecided"):
        return verdict
    reason = f"it has letters and the number with a unit {unit}: it is an equation for the letters, and no identity"
    return Verdict("definition", text=verdict.text, context=verdict.context, reason=reason, notes=notes,
                   seconds=verdict.seconds)  # fmt: skip


def _on_measured(
    measured: Measured, source: str, assume: Sequence[str], units: Mapping[str, str] | None, repair: bool
) -> Verdict:
    """Return the verdict on a text whose numbers have units, as ``measured`` interprets them.

    Raises
    ------
    InputError
        For a text whose usual reading has no meaning, and which is not true in another reading.
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
    verdict = parts[0] if len(parts) == 1 else _on_parts(lines, parts, notation, measured.units)
    diagnosis = replace(verdict.diagnosis, text=measured.restored(verdict.diagnosis.text))
    notes = tuple(map(measured.restored, verdict.notes))
    digits = (repair for repair in verdict.repairs if repair.code == "digits")  # others lack the units
    repairs = tuple(_with_own_units(repair, measured, source.strip()) for repair in digits)
    return replace(verdict, text=source.strip(), diagnosis=diagnosis, notes=notes, repairs=repairs)


def _with_own_units(repair: Repair, measured: Measured, source: str) -> Repair:
    """Return a repair with units in place of their names: ``5 % = 0.05`` for ``(5*unit_1) = 0.05``."""
    written = measured.restored(re.sub(r"\((\d+(\.\d+)?\*unit_\d+)\)", r"\1", repair.text))
    return repair if written == repair.text else replace(repair, text=written, changed=changed_spans(source, written))


def names_of(reading: Reading) -> set[str]:
    """Return the names of quantities in a reading of a text; the rate of phi has the name dphi."""
    return {name for chain in reading.lines for side in chain.sides for name in quantities_of(side)}


def _on_reading(usual: Reading, reading: Reading, verdict: Verdict, notation: Notation) -> str:
    """Return the sentence for a note that reports the verdict on ``reading``, a reading besides the ``usual`` one."""
    places = reading.flipped or usual.flipped
    if isinstance(notation, TypedNotation):
        notation = replace(notation, plain=usual.plain or reading.plain)
    changed = _text_of(reading, notation)
    excerpts = " and ".join(repr(place) for place in dict.fromkeys(places[:3]))
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
    parts = [(claim, _on_claim(claim, notation, repair, reading.plain)) for line in lines for claim in line]
    several = len(parts) > 1
    if not several and (numbers := _for_numbers(reading, parts[0], source)) is not None:
        parts = [(parts[0][0], numbers)]
    verdict = _on_parts(lines, [part for _, part in parts], notation) if several else parts[0][1]
    if several and verdict.verdict == "conditional":
        conditions = [part.requires for _, part in parts if part.requires]
        both_signs = len(conditions) == 2 and all(chain.both_signs for chain in reading.lines)
        verdict = _with_all_conditions(verdict, conditions, both_signs)
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


def _for_numbers(reading: Reading, part: tuple[Claim, Verdict], source: str) -> Verdict | None:
    """Return "conditional" for an equation that is false for Pauli's matrices and true for numbers sigma_x, sigma_y.

    Return None for other equations, and for those without the product or power of a sum: ``σ_x σ_y = σ_y σ_x`` would
    say nothing about numbers.
    """
    claim, verdict = part
    link = reading.lines[0].links[0]
    nodes = [node for side in link[1:] for _, node in walk(side)]
    has_sum = any(node.kind in ("product", "power") and any(a.kind == "sum" for a in node.args) for node in nodes)
    if verdict.verdict != "false" or ON_PAULI not in claim.notes or not has_sum:
        return None
    other = check_claim(claim_of_relation(link, source, pauli_as_numbers=True), repair=False)
    if other.verdict != "true":
        return None
    names = sorted({str(node.value) for node in nodes if str(node.value).startswith("sigma_")})
    condition = f"{' and '.join(names)} are numbers, such as stresses, and not Pauli's matrices"
    notes = tuple(note for note in verdict.notes if note != ON_PAULI)
    return replace(
        verdict, verdict="conditional", requires=(condition,), conditions=(condition,), notes=notes, repairs=(),
        diagnosis=Diagnosis("none", ""),
    )  # fmt: skip


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
    repairs = tuple(_as_inequality(repair, claim, sign, notation) for repair in verdict.repairs)
    verdict = replace(verdict, repairs=repairs)
    echo = _text_of(reading, notation)
    return replace(
        verdict, text=source.strip(), reading=echo if _differs(echo, source) else "", context=stated.echo,
        conditions=conditions, notes=(*claim.notes, *verdict.notes),
    )  # fmt: skip


def _as_inequality(repair: Repair, claim: Claim, sign: str, notation: Notation) -> Repair:
    """Return a repair of the equation ``claim`` as one of the inequality with ``sign``, in the notation of the text."""
    relation = _relation_of(repair.text)
    if relation is None or relation[0] != "==" or claim.relation is None:
        return repair
    before, after = (notation.relation((sign, *sides)) for sides in (claim.relation[1:], relation[1:]))
    return replace(repair, text=after, changed=changed_spans(before, after))


def _differs(echo: str, source: str) -> bool:
    """Return whether ``echo``, the claim as symrot read it, differs from the typed text in more than blanks."""
    return "".join(echo.split()) != "".join(source.split()).replace("==", "=" if "==" not in echo else "==")


def _on_claim(claim: Claim, notation: Notation, repair: bool, plain: bool) -> Verdict:
    """Return the verdict on one equation, written in the notation of the text."""
    verdict = with_rounding(claim, check_claim(claim, repair and not claim.has_parts))
    if verdict.verdict == "false" and repair and claim.unsplit is not None:
        verdict = _with_complex_repairs(claim, verdict)
    verdict = in_degrees(claim, verdict, lambda other: with_rounding(other, check_claim(other, repair=False)))
    verdict = _on_rotations(claim, verdict) if verdict.verdict == "false" else verdict
    verdict = _on_rotation_by_letter(claim, verdict) if verdict.verdict == "definition" and plain else verdict
    verdict = for_special_directions(claim, for_complex_numbers(claim, verdict)) if plain else verdict
    verdict = _with_two_meanings(claim, verdict) if verdict.verdict == "false" and plain else verdict
    # a false equation outside SymPy syntax may be meant as a condition, such as x^2 = 4
    verdict = as_equation(claim, verdict, notation) if verdict.verdict == "false" and plain else verdict
    verdict = _on_inertia_matrix(claim, verdict) if verdict.verdict == "false" else verdict
    if verdict.verdict in ("recognised", "doubtful") and _has_indices(claim):
        verdict = replace(verdict, verdict="definition", recognised_as=(), repairs=(), reason=INDICES)
    if verdict.verdict == "false" and claim.relation is not None and has_index_symbols(claim.relation):
        verdict = Verdict("definition", reason=INDEX_CONDITION, notes=verdict.notes, dimension=verdict.dimension)
    repairs = tuple(
        repair if repair.code in AS_TYPED else _marked(repair, claim, notation)
        for repair in verdict.repairs
        if not _is_odd(repair) and _keeps(repair, claim.written)
    )
    texts = [repair.text for repair in repairs]
    repairs = tuple(repair for place, repair in enumerate(repairs) if repair.text not in texts[:place])
    requires, conditions = (
        tuple(notation.condition(text) for text in texts) for texts in (verdict.requires, verdict.conditions)
    )
    notes = (*claim.notes, *verdict.notes, *_on_numbers(claim, verdict), *_on_zero_powers(claim, verdict))
    return replace(verdict, repairs=repairs, notes=notes, requires=requires, conditions=conditions)


def _with_complex_repairs(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on a false claim about complex numbers, with its probable fault and repairs."""
    from symrot.checker.repair.of_complex import complex_repairs

    with within_limits():
        diagnosis, repairs = complex_repairs(claim)
    return replace(verdict, diagnosis=diagnosis, repairs=repairs) if repairs else verdict


def _on_inertia_matrix(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict with I as a tensor of inertia for ``I = -m [r]^2``, which is false for the unit matrix I.

    Return ``verdict`` for other equations.
    """
    sides = claim.relation[1:] if claim.relation else ()
    units = [side for side in sides if side.value == "eye"]
    if len(units) != 1 or not re.search(r"\bI\b", claim.text):
        return verdict
    assert claim.relation is not None
    sign, left, right = claim.relation
    tensor = Node("name", "I")
    renamed = (sign, tensor, right) if left is units[0] else (sign, left, tensor)
    other = check_claim(replace(claim.with_relation(renamed), symbols=tuple({*claim.symbols, "I"})))
    if other.verdict not in ("definition", "false"):
        note = "I by itself is a tensor of inertia; if it is the unit matrix, the equation is false"
        return replace(other, notes=(*other.notes, note))
    (formula,) = (side for side in sides if side is not units[0])
    names = {str(node.value) for _, node in walk(formula) if node.kind == "name"}
    is_matrix = formula.kind == "list" or formula.value in ("Matrix", "diag")
    if not is_matrix and not any(MASS_OR_INERTIA.fullmatch(name) for name in names):
        return verdict
    reason = "I is the unit matrix or a tensor of inertia: the first is another matrix, the second is not known here"
    return Verdict("definition", reason=reason, notes=verdict.notes, dimension=verdict.dimension)


def _with_two_meanings(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on ``L = T - V`` after ``I = m L^2`` with L renamed to L_1 in the earlier line.

    Return ``verdict`` if no letter has two meanings, or if the claim is false with two meanings too.
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    name, others = str(left.value), {own for own, tree in claim.define if left in [node for _, node in walk(tree)]}
    if left.kind != "name" or not others or name in dict(claim.define) or left in [node for _, node in walk(right)]:
        return verdict
    inside = {own for own, tree in claim.define for _, node in walk(tree) if node.kind == "call" and left in node.args}
    if inside:
        return verdict  # the angle of a rotation in R is the angle on the left side of psi = atan2(R11, R21)
    define = tuple((own, with_names(tree, {name: f"{name}_1"})) for own, tree in claim.define)
    other = check_claim(replace(claim, define=define), repair=False)
    if other.verdict == "false":
        return verdict  # two meanings do not help
    note = f"{name} is read as another quantity than in {' and '.join(sorted(others))}; as the same, the line is false"
    return replace(other, notes=(*other.notes, note))


def _on_zero_powers(claim: Claim, verdict: Verdict) -> tuple[str, ...]:
    """Return (note,), on the convention ``0^0 = 1``, for a true claim with a power ``x^0``; () for other claims."""
    sides = claim.relation[1:] if claim.relation else ()
    nodes = [node for side in sides for _, node in walk(side)]
    powers = [node.args[0] for node in nodes if node.kind == "power" and node.args[1] == number(0)]
    is_open = any(base.kind != "number" or not base.value for base in powers)
    return ("0^0 is read as 1, by the convention of algebra",) if is_open and verdict.verdict == "true" else ()


def _on_numbers(claim: Claim, verdict: Verdict) -> tuple[str, ...]:
    """Return (note,) for a true claim such as ``A B = B A`` whose letters are read as numbers; () for other claims."""
    if verdict.verdict != "true" or claim.relation is None:
        return ()
    known = {*dict(claim.define), *claim.symbols}
    orders = [
        [str(factor.value) for factor in node.args if factor.kind == "name" and ARRAY.fullmatch(str(factor.value))]
        for side in claim.relation[1:]
        for _, node in walk(side)
        if node.kind == "product"
    ]
    letters = [name for order in orders if len(order) > 1 for name in order if name not in known]
    exchanged = any(first != second and sorted(first) == sorted(second) for first in orders for second in orders)
    if not exchanged or not letters:
        return ()
    return (f"{' and '.join(sorted({*letters}))} are read as numbers, for which the order of factors is free",)


def _marked(repair: Repair, claim: Claim, notation: Notation) -> Repair:
    """Return a repair in the notation of the claim, with the positions at which its text differs from the claim's."""
    if claim.relation is None:
        return replace(repair, text=notation.rewritten(repair.text))
    relation = claim.relation if claim.unsplit is None else claim.unsplit[1]
    texts: Sequence[str] = [_as_typed(source, claim.written) for source in (relation_text(relation), repair.text)]
    unchanged = [place for place in ("left", "right") if place not in repair.edited] if repair.edited else []
    if len(unchanged) == 1:
        texts = [_with_inverse(source, unchanged[0], claim.text) for source in texts]
    if not any(call in claim.text for call in CALLS_FOR_ARRAYS):
        texts = list(map(_with_plain_arrays, texts))
    before, after = map(notation.rewritten, texts)
    changed, text = changed_spans(before, after), after
    return replace(repair, text=text, changed=changed, entry=changed_entry(relation, repair.text))


def _as_typed(source: str, written: Sequence[tuple[Node, Node]]) -> str:
    """Return the text of an equation with the short forms that the claim has for its formulas."""
    relation = _relation_of(source) if written else None
    if relation is None:
        return source
    sign, left, right = relation
    return relation_text((sign, exchanged(left, dict(written)), exchanged(right, dict(written))))


def _keeps(repair: Repair, written: Sequence[tuple[Node, Node]]) -> bool:
    """Return whether a repair leaves the formulas unchanged for which the claim has short forms."""
    relation = _relation_of(repair.text) if written else None
    nodes = [node for side in relation[1:] for _, node in walk(side)] if relation else []
    return not nodes or all(formula in nodes for formula, _ in written)


def _with_inverse(source: str, place: str, typed: str) -> str:
    """Return the equation ``source`` with ``q**(-1)`` for q*/|q|^2 on its side ``place``, if ``typed`` writes a
    power.
    """
    relation = _relation_of(source)
    if relation is None or relation[0] != "==":
        return source
    left, right = relation[1:]
    inverse = with_inverses([left if place == "left" else right], typed)[0]
    left, right = (inverse, right) if place == "left" else (left, inverse)
    return source if relation[1:] == (left, right) else relation_text(("==", left, right))


def _with_plain_arrays(source: str) -> str:
    """Return the text of an equation as people write it, with ``q*p`` for the quaternion ``qmul(q, p)``.

    Other texts are returned unchanged.
    """
    relation = _relation_of(source)
    if relation is None or not has_arrays(relation[1:]):
        return source
    sign, left, right = relation
    return relation_text((sign, as_written(left), as_written(right)))


def _relation_of(source: str) -> Relation | None:
    """Parse the text of a repair as an equation; return None if it is none, such as a repair in words."""
    try:
        return read_relation(source)
    except InputError:
        return None


def _is_odd(repair: Repair) -> bool:
    relation = _relation_of(repair.text)
    return relation is not None and is_odd(relation[1:])


def _on_rotations(claim: Claim, verdict: Verdict) -> Verdict:
    """Return "conditional" for a claim that is false for general matrices but true for rotation matrices.

    Others keep their ``verdict``.
    """
    names = matrices_of_entries(claim.define)
    # each matrix alone, any of which suffices; then all together
    groups = [(name,) for name in names] + ([tuple(names)] if len(names) > 1 else [])
    conditions: list[str] = []
    for group in groups:
        if len(group) > 1 and conditions:
            break
        other = check_claim(replace(claim, define=tuple(as_rotations(claim.define, group))), repair=False)
        if other.verdict == "true":
            conditions.append(" and ".join(f"{name} is a rotation" for name in group))
            verdict = replace(
                other, verdict="conditional", conditions=tuple(conditions), requires=tuple(conditions),
                counterexample=verdict.counterexample,
            )  # fmt: skip
    return verdict


def _on_rotation_by_letter(claim: Claim, verdict: Verdict) -> Verdict:
    """Return "conditional" for a condition such as ``R R^T = I`` that all rotations R satisfy; otherwise ``verdict``.

    Only for one matrix, whose letter books use for rotations; a note says if some rotations do not satisfy it.
    """
    names = matrices_of_entries(claim.define)
    if len(names) != 1 or not ROTATION.fullmatch(names[0]):
        return verdict
    on_rotation = _on_rotations(claim, verdict)
    if on_rotation.verdict == "conditional":
        return replace(on_rotation, reason="", repairs=(), diagnosis=Diagnosis("none", ""))
    return replace(verdict, notes=(*verdict.notes, f"it does not hold for all rotations {names[0]}"))


def _has_indices(claim: Claim) -> bool:
    """Return whether a claim is in index notation, as ``I_ik = m*a_i*a_k`` with the indices i and k."""
    assert claim.relation is not None
    names = {name for side in claim.relation[1:] for name in _names(side)}
    pairs = {name.rpartition("_")[2] for name in names if re.fullmatch(r"\w+_[ijkl]{2}", name)}
    return any(f"_{index}" in name[-2:] for pair in pairs for index in pair for name in names)


def _on_parts(
    lines: Sequence[Sequence[Claim]], verdicts: Sequence[Verdict], notation: Notation, units: Collection[str] = ()
) -> Verdict:
    """Return the worst verdict on the equations of a chain or of several lines, with a note on each.

    It is "doubtful" for formulas of different bodies, frames or sequences.
    """
    remaining = iter(verdicts)
    counted, notes = [], []
    total = sum(map(len, lines))
    for place, line in enumerate(lines):
        own = [next(remaining) for _ in line]
        own = own if units else _as_named_chain(line, own, notation)
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
                else "a definition for the other lines"
            )
            formulas = f": the {verdict.recognised_as[0]}" if verdict.recognised_as else ""
            relation = _relation_of(_as_typed(relation_text(claim.relation), claim.written))
            notes.append(f"{notation.relation(relation or claim.relation)} is {words}{formulas}")
            notes += [note for note in verdict.notes if note not in claim.notes]
            if not (defines and verdict.verdict in NAMING and total > 1):
                counted.append(verdict)
    counted = counted or list(verdicts)
    worst = min(counted, key=lambda verdict: WORST_FIRST.index(verdict.verdict))
    claims = [claim for line in lines for claim in line]
    by_name = [
        (str(claim.relation[1].value), _names(claim.relation[2]), verdict)
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
    """Return the verdict on lines that contradict each other, with the edit of one line that makes all of them fit, if
    there is one.
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
            changed = [*lines[:place], (lines[place][0], _names(relation[2]), other), *lines[place + 1 :]]
            rank = misplaced(changed), repair.cost
            if (nearest is None or rank < nearest[0]) and fit_together(changed):
                marked = _marked(repair, claim, notation)
                diagnosis = Diagnosis(repair.code, FAULT_DESCRIPTIONS[repair.code])
                nearest = rank, replace(verdict, diagnosis=diagnosis, repairs=(marked,))
    return verdict if nearest is None else nearest[1]


def _with_all_conditions(verdict: Verdict, conditions: Sequence[Sequence[str]], both_signs: bool) -> Verdict:
    """Return the verdict on several conditional equations with all their conditions: "a > 0 or b > 0 and c > 0"."""
    texts = list(dict.fromkeys(" or ".join(alternatives) for alternatives in conditions))
    others = tuple(condition for condition in verdict.conditions if condition not in verdict.requires)
    if both_signs:  # the two equations are those with the upper and the lower sign of ±
        required = tuple(f"{text} for the {word} sign" for text, word in zip(texts, ("upper", "lower"), strict=False))
    else:
        required = tuple(conditions[0]) if len(texts) == 1 else (" and ".join(texts),)
    return replace(verdict, requires=required, conditions=(*required, *others), diagnosis=Diagnosis("none", ""))


def _as_named_chain(line: Sequence[Claim], verdicts: Sequence[Verdict], notation: Notation) -> list[Verdict]:
    """Return the verdicts on a chain ``name = a = b``.

    If ``a = b`` is no identity, its verdict may be replaced by that on ``name = b``, or by "definition".
    """
    named = named_formula(line[0]) if len(line) > 1 else None
    if named is None or line[0].relation is None or line[0].relation[1] != named.side:
        return list(verdicts)
    decided = [verdicts[0]]
    for claim, verdict in zip(line[1:], verdicts[1:], strict=True):
        assert claim.relation is not None
        _, left, right = claim.relation
        others = _names(right) - _names(left)  # both formulas in E = I*omega^2/2 = L^2/(2*I) give E
        if verdict.verdict in ("false", "conditional", "definition") and others and _names(left) - _names(right):
            renamed = claim.with_relation(("==", named.side, right))
            under_name = check_claim(renamed)
            repairs = tuple(_marked(repair, renamed, notation) for repair in under_name.repairs)
            under_name = replace(under_name, repairs=repairs)
            link = notation.relation(claim.relation)
            note = f"{link} is no identity, since only one side has {', '.join(sorted(others))}"
            verdict = replace(under_name, notes=(*under_name.notes, note))
        elif verdict.verdict == "false" and _names(left) and not _names(right) - {"pi"} and _depends_on_letters(claim):
            letters = " and ".join(sorted(_names(left) - {"pi"}))
            verdict = Verdict(
                "definition",
                reason=f"the equation holds only for certain values of {letters}, and the text does not state any",
            )
        decided.append(verdict)
    return decided


def _depends_on_letters(claim: Claim) -> bool:
    """Return whether the value of a claim's left side depends on a letter, as that of sin²x + cos²x does not."""
    # if so, sin x = 1/2 in y = sin x = 1/2 is no error, but holds for certain x
    left = claim.equation.left
    return not is_matrix(left) and bool(normal_form(left).free_symbols)


def _names(tree: Node) -> set[str]:
    return {
        str(node.value)
        for _, node in walk(tree)
        if node.kind == "name" or (node.kind == "call" and node.args == (TIME,))
    }
