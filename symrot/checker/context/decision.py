"""Verdicts in a context: once the meanings of names are stated, a claim that gives a formula for a quantity is decided.

The name of a known formula, such as "moment of inertia of a rod about an end", is a list of words. The claim means this
formula if each of these words follows from the context or from the name of the claim's quantity, as "moment of inertia"
follows from I.

The claim is true if it is equal to a formula that it means. It is false if it differs from all of them, however its
letters are assigned to the letters of those formulas. If some words follow from nothing, the verdict stays what it is
without a context, and a note names these words.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, zip_longest
from typing import Any

from sympy import Dummy, Expr, Function, Rational, Symbol, sqrt

from symrot import symbols
from symrot.checker.claim.atoms import atoms_of
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, text
from symrot.checker.context.admission import (
    COMPONENTS,
    EXCHANGED,
    admits_letters,
    admits_name,
    guesses,
    is_at_open_place,
    is_component,
    is_place,
    misfits,
    plain,
    same_rotation,
)
from symrot.checker.context.angle_orders import has_order
from symrot.checker.context.bodies import bodies_of_formula
from symrot.checker.context.context import Context, letters_of
from symrot.checker.context.lacking_letters import with_lacking_letters
from symrot.checker.context.quantities import plain_words
from symrot.checker.decide.decision import Equation, decide_equation
from symrot.checker.recognition.evidence import has_word, words_of
from symrot.checker.recognition.identification import known_value
from symrot.checker.recognition.known_formulas import Known, by_fingerprint
from symrot.checker.recognition.naming import SQUARED, verdict_on_name
from symrot.checker.recognition.renaming import axes_of, component, is_consistent
from symrot.checker.repair.diagnose import MOST_REPAIRS, diagnose
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = ["in_context"]

MOST_ASSIGNMENTS = 24
"""The most ways of assigning the letters of a claim to the symbols of a derived formula that are decided."""

MOST_CHOICES = 10_000
"""The most ways of choosing a symbol for each letter that are tried, whether or not they keep the axes together."""

MOST_DIAGNOSED = 4
"""The most ways of assigning letters for which the fault of a claim is sought."""

MOST_COSTLY = 2.0
"""The cost of a repair that is a derived formula as a whole."""

ANGLES = tuple(Symbol(symbol.name, real=True) for symbol in (*symbols.angles, *symbols.angle_rates))
SIDES = "a|b|c"
"""The sides of a box, or the semi-axes of an ellipsoid, along x, y and z if nothing else is stated."""

ANGLE = "phi|theta|psi|alpha|beta|gamma|varphi|vartheta|theta_?[1-3]|q_?[1-3]"
USUAL: tuple[tuple[str, str], ...] = (
    ("m", r"m|M|mu|m_\w"), ("R", r"[rRa]|[rR]_?0"), ("L", r"[lLh]|ell"), ("h", r"[hHl]"), ("r", r"[rdlhR]|r_?[A-Z]"),
    ("R_1", r"R_?1|r_?1|R_?i|r_?i|a"), ("R_2", r"R_?2|r_?2|R_?o|r_?o|b"), (SIDES, SIDES),
    ("A", r"[IAJ]|[IJ]_?[01xt]|I_?xx|[IJ]_prime|lambda_?1"), ("B", r"B|[IJ]_?[2y]|I_?yy|lambda_?2"),
    ("C", r"[ICJ]|[IJ]_?[3zsG]|I_?zz|lambda_?3|[IJ]_?(O|cm)"),
    ("phi|theta|psi", ANGLE), ("dphi|dtheta|dpsi", f"d({ANGLE})"),
    *((f"omega_{axis}", rf"(omega|w|Omega)_?{pattern}|{letter}") for axis, pattern, letter in (
        ("1", "[1x]", "p"), ("2", "[2y]", "q"), ("3", "[3z]", "omega|w|r"), ("x", "[1x]", "p"), ("y", "[2y]", "q"),
        ("z", "[3z]", "omega|w|r"))),
    ("domega_1", "d(omega|w|Omega)_?[1x]|dp"), ("domega_2", "d(omega|w|Omega)_?[2y]|dq"),
    ("domega_3", "d(omega|w|Omega)_?[3z]|dr"),
    ("g", "g"), ("c_3", r"[lRhda]|[lrh]_?(G|cm)"), ("Omega|n", r"Omega|omega_?p|n|Omega_\w+"),
    ("H", r"[HLMh]|[HL]_?[GO]"), ("M|tau_[123]", r"[MNT]|tau|Gamma"), ("W", "W|mg"),
    ("L_1", "[LHM]_?[1x]"), ("L_2", "[LHM]_?[2y]"), ("L_3", "[LHM]_?[3z]"),
    ("p_phi", "p_?phi"), ("p_theta", "p_?theta"), ("p_psi", "p_?psi"),
    ("k_O", r"k|k_?[0O]|i"), ("v", "v|v_?[GO]|v_?cm"),
    ("omega_i", "omega_?[10i]"), ("omega_f", "omega_?[2f]|omega"), ("theta_i", "theta_?[10i]"),
    ("theta_f", "theta_?[2f]|theta"), ("alpha_a", "alpha"), ("t", "t|Delta_t"), ("beta", "theta|beta|alpha"),
    ("k_t", "k|kappa|c|k_t"), ("gamma", "gamma"), ("I_xx", "I_?(xx|x|11|1)"), ("I_yy", "I_?(yy|y|22|2)"),
    ("I_zz", "I_?(zz|z|33|3)"), ("I_xy", "I_?(xy|12)"), ("I_xz", "I_?(xz|13|zx)"), ("I_yz", "I_?(yz|23)"),
    ("q([0-3])", r"q_?[0-3]"), ("rho", "rho"), ("e", "e"),
)  # fmt: skip
"""Symbol of derived formulas -> the letters that are certainly meant as that symbol, where a claim has it."""


@dataclass(frozen=True)
class Meant:
    """A known formula that a claim may mean: ``value`` is the formula in the letters of the claim.

    ``mapping`` gives the claim's letter for each renamed symbol. ``open_place`` is True if the formula is for an axis
    through the centre of mass, or for one through an end of the body, and the claim does not say through which of the
    two. ``how`` says in which form the formula is meant, such as "transposed"; it is empty for the formula as it is.
    """

    known: Known
    value: Any
    mapping: dict[str, str]
    open_place: bool = False
    how: str = ""

    @property
    def identification(self) -> Identification:
        """The known formula as an entry of ``recognised_as`` in a verdict."""
        return Identification(self.known.name.removesuffix(SQUARED), self.how, self.mapping, self.known.source)


def in_context(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim that gives a formula for a quantity, with the words of its context used.

    ``verdict`` is the verdict so far, "recognised", "doubtful" or "definition", by the known formulas that fit the
    context. Where all words are used, it may become "true" or "false"; otherwise it stays open, and a note lists the
    words that symrot does not use.
    """
    verdict = _with_all_words(claim, named, verdict)
    sequence = claim.context.sequence
    if verdict.verdict not in ("false", "doubtful", "definition") or not sequence.islower():
        return verdict
    note = f"{sequence} in lower case is about fixed axes; for moving axes write {sequence.upper()}"
    return replace(verdict, notes=(*verdict.notes, note))


def _with_all_words(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim in its context: "true" or "false" only if all words of the context are used.

    A word is used if symrot understands it, or if it occurs in the names of the known formulas of the verdict or in the
    claim. With unused words, "true" becomes "recognised", and in place of "false" the verdict without the context is
    returned; a note lists the words. If symrot does not understand words about the body or the axis, the verdict is
    "definition": the claim is then taken as a definition, neither true nor false. ``verdict`` is the verdict without
    the context.
    """
    if obscure := claim.context.obscure:
        reason = f"of the context, these words are not understood: {obscure}; write it without them, or in other words"
        return Verdict("definition", reason=reason)
    without, verdict = verdict, _by_context(claim, named, verdict)
    if any(is_at_open_place(claim.context, known.name) for known in verdict.recognised_as):
        reason = "nothing says at which place of the body the pivot is; write for example 'about an end'"
        return Verdict("definition", reason=reason)
    if verdict.verdict == "true":
        verdict = _with_order(claim.context, verdict, [*letters_of(named.formula)])
        verdict = _with_tangent(claim.context, _with_axes(claim.context, _with_sides(verdict)))
    names = " ".join(known.name for known in verdict.recognised_as)
    own = {*plain_words(names).split(), *plain_words(text(named.formula)).split(), *ENGLISH}
    letters = {letter.lower() for letter in letters_of(named.formula)}
    unused = [word for rest in claim.context.rest for word in rest.split() if word not in own | letters]
    if not unused:
        return verdict
    note = f"of the context, these words are not used: {' '.join(unused)}"
    if verdict.verdict == "true":
        return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))
    return replace(without if verdict.verdict == "false" else verdict, notes=(*verdict.notes, note))


def _with_order(context: Context, verdict: Verdict, letters: Sequence[str]) -> Verdict:
    """Replace "true" by "recognised" if the claim uses phi and psi in an unusual order that nothing states.

    ``letters`` are those of the claim's formula. In ZYX psi is usually the first angle, and phi the third (yaw, pitch,
    roll); in every other sequence phi is the first.
    """
    angles = [letter for letter in letters if letter in ("phi", "psi", "dphi", "dpsi")]
    if not context.sequence or not angles or any(context.meaning_of(letter.removeprefix("d")) for letter in angles):
        return verdict
    usual = context.sequence == "ZYX"
    reverse = same_rotation(context.sequence)
    readings = [
        known
        for known in verdict.recognised_as
        if _is_exchanged(known) == (usual != bool(reverse and reverse in known.name))
    ]
    if readings:
        return replace(verdict, recognised_as=tuple(readings))
    first, third = ("phi", "psi") if usual else ("psi", "phi")
    note = f"guessed, not stated: {first} is the first angle of {context.sequence}, and {third} the third"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _with_sides(verdict: Verdict) -> Verdict:
    """Return "recognised" for "true" if it was guessed along which axis the claim's letters a, b and c lie.

    The known formulas call the sides of a box, or the semi-axes of an ellipsoid, along x, y and z by the letters a, b
    and c. If one formula in ``recognised_as`` fits without renaming these, nothing was guessed: the verdict stays
    "true" with such formulas only.
    """
    readings = [known for known in verdict.recognised_as if not any(re.fullmatch(SIDES, old) for old in known.mapping)]
    if readings:
        return replace(verdict, recognised_as=tuple(readings))
    note = "guessed, not stated: which letter is the side along which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _with_tangent(context: Context, verdict: Verdict) -> Verdict:
    """Replace "true" by "recognised" if the claim is true for the less usual of the two tangents of a disk or ring.

    A tangent may lie in the plane of the body, or be normal to it at the rim. The words "about a tangent" leave this
    open. If the formula is the one for the normal axis, the verdict is no longer "true", and a note says what was
    guessed.
    """
    places = {context.place, *(meaning.place for meaning in context.meanings)}
    normal = all(known.name.endswith("rim, z axis") for known in verdict.recognised_as)
    if TANGENT not in places or not normal or (context.body and context.body.axes):
        return verdict
    note = "guessed, not stated: the tangent is normal to the plane of the body, not in it"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _with_axes(context: Context, verdict: Verdict) -> Verdict:
    """Return "recognised" for "true" if it was guessed to which axis a letter with a number or axis belongs.

    Nothing is guessed if I_1 stands for the moment about the first axis, and so for each other index, or if words about
    the letter or about the moments of the body state the axis: the verdict then stays "true". If I_1 has to be the
    moment about the second axis for the claim to be right, that is a guess.
    """
    stated = set(context.body.letters.values()) if context.body else set()
    readings = [
        known
        for known in verdict.recognised_as
        if is_consistent([(old, new) for old, new in known.mapping.items()
                          if new not in stated and context.meaning_of(plain(new)) is None], fixed=True)
    ]  # fmt: skip
    if readings:
        return replace(verdict, recognised_as=tuple(sorted(readings, key=lambda k: context.sequence not in k.name)))
    note = "guessed, not stated: which letter belongs to which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _is_exchanged(known: Identification) -> bool:
    """Return whether the claim writes phi for the psi of the ``known`` formula, or psi for its phi."""
    return any({old, plain(new)} in EXCHANGED for old, new in known.mapping.items())


TANGENT = "about a tangent"
ENGLISH = ("from", "to", "that", "at", "between", "on", "of")


def _by_context(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim by comparison with the known formulas that its context means.

    ``verdict`` is the verdict so far; it is returned where the context adds nothing. Whether all words of the context
    are used is checked afterwards, by the caller.
    """
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
        return decided if decided is not None and is_true else _with_guesses(context, verdict, stated)
    decided = _by_meant_formulas(claim, named, verdict, quantity, stated)
    verdict = verdict if decided is None or (verdict.repairs and not decided.counterexample) else decided
    if verdict.verdict in ("true", "recognised"):
        return verdict
    if verdict.verdict == "definition" and (lacking := _without_letters(claim, named, quantity, stated)) is not None:
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
        return replace(verdict, verdict=word, diagnosis=Diagnosis("context", sentence), reason="")
    return verdict


def _without_context(claim: Claim, named: NamedFormula) -> tuple[Identification, ...]:
    """Return the known formulas that a claim fits if its context is changed, so that the message can name them.

    A claim about an end, for example, may be the formula for the centre. Three changes are tried in turn: the place of
    the axis left out, the other frame ("body" for "space"), and no context at all. The formulas of the first change
    that gives any are returned; empty if none does.
    """
    context = claim.context
    if context.body and (context.place or context.body.axes):
        elsewhere = replace(context, body=replace(context.body, place="", axes=""))
        of_body = verdict_on_name(replace(claim, context=elsewhere), named, repair=False).recognised_as
        if of_body:
            return of_body
    if context.frame:
        flipped = replace(context, frame="space" if context.frame == "body" else "body")
        in_other_frame = verdict_on_name(replace(claim, context=flipped), named, repair=False).recognised_as
        if in_other_frame:
            return in_other_frame
    return verdict_on_name(claim.without_context, named, repair=False).recognised_as


def _with_guesses(context: Context, verdict: Verdict, stated: str) -> Verdict:
    """Return ``verdict`` with the formulas that need fewest guesses first, and with a note on the guesses of the first.

    A guess is a word in a known formula's name that follows neither from the context nor from ``stated``. ``stated``
    are the words that the name of the claim's quantity implies, such as "moment of inertia z axis" for I_zz. If "solid"
    is not stated, the note says "guessed, not stated: solid". Without guesses, no note is added.
    """
    readings = sorted(verdict.recognised_as, key=lambda known: len(guesses(context, known.name, stated)))
    verdict, likeliest = replace(verdict, recognised_as=tuple(readings)), readings[0]
    what = " ".join([*guesses(context, likeliest.name, stated), likeliest.how]).strip()
    return replace(verdict, notes=(*verdict.notes, f"guessed, not stated: {what}")) if what else verdict


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
    """Return the verdict "false" on a claim, with the counterexample of ``decision``.

    ``decision`` compares the claim with the known formula that the context means; at the counterexample they differ.
    """
    return replace(verdict, verdict="false", counterexample=decision.counterexample, reason="")


def _decided(claim: Claim, left: Node, right: Node) -> Decision:
    """Return the decision whether two trees, which use the names of a claim, are equal."""
    return decide_equation(claim.with_relation(("==", left, right), alternatives=()).equation)


def _against_repair(claim: Claim, named: NamedFormula, verdict: Verdict) -> Decision | None:
    """Return the decision "false" if a claim's formula provably differs from the repair in ``verdict``; or None."""
    try:
        _, _, repaired = read_relation(verdict.repairs[0].text)
        decision = _decided(claim, named.formula, repaired)
    except (InputError, TooLarge):
        return None
    return decision if decision.verdict == "false" else None


def _by_meant_formulas(
    claim: Claim, named: NamedFormula, verdict: Verdict, quantity: str, stated: str
) -> Verdict | None:
    """Return the verdict by comparing a claim with all known formulas that its context can mean.

    Return None if this decides nothing, for example because there is no such formula or one comparison is undecided.
    ``quantity`` is the name for which the claim gives a formula, and ``stated`` are the words that this name implies,
    such as "moment of inertia z axis" for I_zz.
    """
    try:
        formula = named.formula if named.solve is None else named.solve(named.formula)
        value = claim.with_definitions(claim.interpreter().read(formula))
    except InputError:
        return None
    words = None if claim.context.meaning_of(quantity) else words_of(named)
    meant = [other for other in _meant(claim.context, value, quantity, stated) if has_word(other.known.name, words)]
    decisions = [(candidate, _equal(candidate.value, value)) for candidate in meant]
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
        return _with_guesses(claim.context, Verdict("recognised", recognised_as=readings), stated)
    known_decisions = [(candidate, decision) for candidate, decision in decisions if decision is not None]
    if is_open:
        return _near(claim, named, known_decisions)
    return _different(claim, named, verdict, [*known_decisions, *_transposed(known_decisions)])


def _transposed(decisions: Sequence[tuple[Meant, Decision]]) -> Iterator[tuple[Meant, Decision]]:
    """Yield the transpose of each rotation matrix among the known formulas, with the decision on the matrix.

    A known matrix maps body components to space components; the author of a claim may mean the inverse map, which is
    its transpose.
    """
    for candidate, decision in decisions:
        if candidate.known.name.startswith("rotation matrix"):
            yield replace(candidate, value=candidate.value.T, how="transposed"), decision


def _without_letters(claim: Claim, named: NamedFormula, quantity: str, stated: str) -> Verdict | None:
    """Return the verdict "doubtful" if the claim forgets a term or factor of the known formula; otherwise None.

    The formula is the one that the context fixes: each word of its name follows from the context or from ``stated``,
    the words that the name of the quantity implies ("moment of inertia z axis" for I_zz). The forgotten term or factor
    must have letters that the claim does not use, as h in ``m*r^2/4`` for a cylinder. ``quantity`` is the name for
    which the claim gives a formula.
    """
    context = claim.context
    own_meaning = context.meaning_of(quantity)
    if context.body is None and (own_meaning is None or own_meaning.body is None):
        return None
    try:
        formula = named.formula if named.solve is None else named.solve(named.formula)
        value = claim.with_definitions(claim.interpreter().read(formula))
    except InputError:
        return None
    stated_formulas = (
        (known, _with_letters(context, known_value(known.text)))
        for known in _all_known()
        if not known.is_step and not known.is_relation and not known.name.endswith(SQUARED)
        and admits_name(context, known.name, quantity)
        and (own_meaning is not None or any(word in known.name for word in stated.split()))
        and is_component(known.name, quantity)
        and not guesses(context, known.name, stated)
    )  # fmt: skip

    def assignments(known: Known, target: Any, own: set[Expr]) -> Iterator[Mapping[Expr, Expr]]:
        return _assignments(context, target, own, quantity, known, is_specific=True)

    return with_lacking_letters(named, value, stated_formulas, assignments)


def _is_transposed(target: Any, value: Any) -> bool:
    """Return whether the square matrix ``value`` is provably the transpose of ``target``."""
    if not is_matrix(value) or value.rows != value.cols:
        return False
    decision = _equal(target.T, value)
    return decision is not None and decision.verdict == "true"


def _is_open(decision: Decision) -> bool:
    """Return whether a ``decision`` on two formulas leaves open that they are equal.

    It does if it is undecided, or if they are equal for some signs of the symbols. Formulas that are equal for special
    values only, such as equal moments of inertia, are different formulas.
    """
    if decision.verdict == "conditional":
        return any(requirement.signs or not requirement.zeros for requirement in decision.requires)
    return decision.verdict not in ("true", "false")


def _different(
    claim: Claim, named: NamedFormula, verdict: Verdict, decisions: Sequence[tuple[Meant, Decision]]
) -> Verdict:
    """Return the verdict "false" on a claim that differs from all known formulas that its context can mean.

    ``decisions`` has each of these formulas with the decision that the claim differs from it.
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
                repairs = (Repair(f"{text(named.side)} == {as_text(candidate.value)}", "derived", MOST_COSTLY),)
    return Verdict(
        "false", counterexample=decision.counterexample, diagnosis=diagnosis, repairs=repairs,
        recognised_as=(candidate.identification,),
    )  # fmt: skip


def _different_repairs(repairs: Sequence[tuple[Repair, ...]]) -> tuple[Repair, ...]:
    """Return at most three repairs with different texts, from ``repairs`` towards several known formulas.

    ``repairs`` has one tuple for each formula, with its best repair first. The result has the best repair of each
    formula, then the second-best ones; repairs with the same text count as one.
    """
    in_turn = [repair for rank in zip_longest(*repairs) for repair in rank if repair is not None]
    return tuple({repair.text: repair for repair in in_turn}.values())[:MOST_REPAIRS]


def _near(claim: Claim, named: NamedFormula, decisions: Sequence[tuple[Meant, Decision]]) -> Verdict | None:
    """Return the verdict "doubtful" if a claim becomes equal to a known formula once one fault is corrected, or None.

    ``decisions`` has each known formula that the claim may mean, with the decision that the claim differs from it. This
    function is for claims that do not say through which place of the body the axis goes: then it is not certain which
    of the formulas is meant, and the claim cannot be called false.
    """
    for candidate, decision in decisions[:MOST_DIAGNOSED]:
        diagnosis, repairs = _diagnosed(claim, named, candidate, decision)
        if repairs and repairs[0].cost < MOST_COSTLY and diagnosis.code != "two_faults":
            readings = (candidate.identification,)
            return Verdict("doubtful", diagnosis=diagnosis, repairs=repairs, recognised_as=readings)
    return None


def _diagnosed(
    claim: Claim, named: NamedFormula, candidate: Meant, decision: Decision
) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return the fault by which a claim's formula differs from the known formula ``candidate``, and repairs.

    ``decision`` says that they differ. The repairs turn the claim's formula into the known one; there may be none.
    """
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
    """Return a sort key of a repair, by which repairs of one fault come before those of two, and short before long."""
    return repair.code == "two_faults", len(repair.text)


def _equal(target: Any, value: Any) -> Decision | None:
    """Return the decision on the equation ``value == target``; None if it cannot be decided."""
    try:
        return decide_equation(Equation(value, target))
    except (InputError, TooLarge):
        return None


def _meant(context: Context, value: Any, quantity: str, stated: str) -> Iterator[Meant]:
    """Yield each known formula that ``quantity`` can mean in a context, in the letters of a claim.

    ``value`` is the formula of the claim. If its letters can be assigned to the symbols in several ways, the known
    formula is yielded once for each way. ``stated`` are the words that the name of the quantity implies.
    """
    shape = value.shape if is_matrix(value) else None
    own = atoms_of(list(value) if shape else [value]) - {time}
    for known in _all_known():
        if known.is_step or known.is_relation or not admits_name(context, known.name, quantity):
            continue
        open_words = guesses(context, known.name, stated)
        is_stated = context.meaning_of(quantity) is not None or any(word in known.name for word in stated.split())
        if not is_stated or not all(map(is_place, open_words)):
            continue
        target = known_value(known.text)
        target = _root(target) if known.name.endswith(SQUARED) else target
        if getattr(target, "shape", None) != shape or not is_component(known.name, quantity):
            continue
        target = _with_letters(context, target)
        is_specific = bool(bodies_of_formula(known.name)) or bool(context.sequence and context.sequence in known.name)
        for mapping in islice(_assignments(context, target, own, quantity, known, is_specific), MOST_ASSIGNMENTS):
            renamed = target.xreplace({**_unused_rates(mapping, own), **mapping})
            used = target.free_symbols
            names = {old.name: as_text(new) for old, new in mapping.items() if old in used}
            names = {old: new for old, new in names.items() if plain(new) != old}
            yield Meant(known, renamed, names, bool(open_words))


def _root(square: Expr) -> Expr:
    """Return the square root of ``square``, simplified as for positive symbols such as masses: a for a^2."""
    positive = {symbol: Dummy(positive=True) for symbol in square.free_symbols}
    return sqrt(square.xreplace(positive)).xreplace({new: old for old, new in positive.items()})


def _unused_rates(mapping: Mapping[Expr, Expr], own: set[Expr]) -> dict[Expr, Expr]:
    """Return ``{dphi: diff(phi(t), t)}`` for the symbols of angle rates that ``mapping`` does not replace.

    ``mapping`` maps the symbols of a known formula to the letters of a claim. A claim that writes derivatives has no
    letters for dphi, so ``mapping`` leaves this symbol unused. The caller substitutes both maps into the known formula,
    to compare it with the claim. The result is empty if ``own``, the atoms of the claim, contains no derivative.
    """
    if not any(atom.is_Derivative for atom in own):
        return {}
    functions = {symbol: Function(symbol.name[1:], real=True)(time) for symbol in ANGLES if symbol.name.startswith("d")}
    return {symbol: value.diff(time) for symbol, value in functions.items() if symbol not in mapping}


def _all_known() -> Iterator[Known]:
    for formulas in by_fingerprint().values():
        yield from formulas


def _with_letters(context: Context, target: Any) -> Any:
    """Return the known formula ``target`` with the body's letters: r for R if the context says "disk of radius r"."""
    if context.body is None:
        return target
    letters = dict(context.body.letters)
    if context.body.kind.title == "cube" and not letters:
        letters = {"b": "a", "c": "a"}
    own = {symbol.name: symbol for symbol in target.free_symbols}
    factors = {name: Rational(factor.numerator, factor.denominator) for name, factor in context.body.factors.items()}
    return target.xreplace({
        own[name]: factors.get(name, 1) * Symbol(letter, real=True) for name, letter in letters.items() if name in own
    })  # fmt: skip


def _assignments(
    context: Context, target: Any, own: set[Expr], quantity: str, known: Known, is_specific: bool
) -> Iterator[dict[Expr, Expr]]:
    """Yield ways to assign a claim's letters to the symbols of the known formula ``target``, as books use letters.

    Each maps symbols of ``target`` to members of ``own``, the symbols and rates of the claim. All symbols need a
    letter, unless the formula ``is_specific`` (for one body or one sequence).
    """
    own_symbols = sorted(target.free_symbols - {time}, key=str)
    if context.sequence and context.sequence in known.name:  # a formula may lack an angle that the claim has
        own_symbols = sorted({*own_symbols, *ANGLES}, key=str)
    pinned = set(context.body.letters.values()) if context.body else set()
    names = {symbol.name for symbol in own_symbols}
    atoms = [atom for atom in sorted(own, key=str) if plain(as_text(atom)) not in pinned - names]
    if len(atoms) > len(own_symbols) or (len(atoms) < len(own_symbols) and not is_specific):
        return
    choices = []
    for atom in atoms:
        name = plain(as_text(atom))
        fitting = [symbol for symbol in own_symbols if _may_be(context, name, symbol.name, pinned)]
        exact = [symbol for symbol in fitting if symbol.name == name]
        is_open = name in ("phi", "psi", "dphi", "dpsi") and not has_order(context.sequence)
        is_open = is_open or (re.fullmatch(SIDES, name) is not None and not pinned)
        choices.append(
            [*exact, *(symbol for symbol in fitting if symbol not in exact)] if is_open else exact or fitting
        )
    for chosen in islice(_distinct(choices), MOST_CHOICES):
        pairs = [(symbol.name, as_text(atom)) for symbol, atom in zip(chosen, atoms, strict=True)]
        free = [pair for pair in pairs if pair[0] not in pinned]
        if not is_consistent([*free, *component(known.name, quantity)], known.is_placed):
            continue
        letters = [as_text(atom) for atom in atoms]
        unpinned = {old: new for old, new in free if old != new}
        if admits_letters(replace(context, body=None), known.name, unpinned, letters):
            yield dict(zip(chosen, atoms, strict=True))


def _may_be(context: Context, name: str, symbol: str, pinned: set[str]) -> bool:
    """Return whether the letter ``name`` of a claim can stand for a ``symbol`` of a known formula: r for R.

    A letter in ``pinned``, which the context gives to a dimension of the body, stands only for the symbol of the same
    name.
    """
    if symbol in pinned or name in pinned:
        return name == symbol
    meaning = context.meaning_of(name)
    if len(axes_of(symbol)) > 1 and axes_of(symbol) != axes_of(name):
        return False  # an entry of a matrix keeps its row and column, or exchanges them
    if meaning is not None and meaning.quantity.symbols:
        return re.fullmatch(meaning.quantity.symbols, symbol) is not None
    return name == symbol or any(
        re.fullmatch(pattern, symbol) and re.fullmatch(letters, name) for pattern, letters in USUAL
    )


def _distinct(choices: Sequence[Sequence[Expr]]) -> Iterator[tuple[Expr, ...]]:
    """Yield the tuples that take one member from each list in ``choices``, and no member twice."""
    if not choices:
        yield ()
        return
    for first in choices[0]:
        rest = [[symbol for symbol in choice if symbol != first] for choice in choices[1:]]
        for others in _distinct(rest):
            yield (first, *others)
