"""Verdicts on claims about a quantity in a context, which states the meanings of names.

A claim means a known formula, such as the "moment of inertia of a rod about an end", if its context or its quantity
states each word of this name. It is true if it equals such a formula, false if it differs from all.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, pairwise, permutations, zip_longest
from typing import Any

from sympy import Dummy, Expr, Function, Rational, Symbol, cancel, sqrt

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
from symrot.checker.recognition.naming import SQUARED, recognised_edits, verdict_on_name
from symrot.checker.recognition.renaming import axes_of, component, is_consistent
from symrot.checker.repair.diagnose import MOST_REPAIRS, diagnose
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = ["in_context"]

MOST_ASSIGNMENTS = 24
"""The most assignments of a claim's letters to the symbols of a derived formula that are decided."""

MOST_CHOICES = 10_000
"""The most choices of symbols for letters that are tried, before it is known whether they suit the axes."""

MOST_DIAGNOSED = 4
"""The most assignments of letters for which the fault of a claim is sought."""

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
"""Pairs of patterns: symbols of derived formulas, and the letters that books use for them."""


@dataclass(frozen=True)
class Meant:
    """A known formula that a claim may mean, in the letters of the claim.

    Attributes
    ----------
    known : Known
    value : Expr or Matrix
        The formula in the claim's letters.
    mapping : dict
        The claim's letter for each symbol that is renamed.
    open_place : bool
        Whether the claim leaves open through which point of the body the axis goes.
    how : str
        The form in which the formula is meant, such as "transposed"; empty for the formula as it is.
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
    """Return the verdict on a claim in its context; if a word is unused, the context makes the claim neither "true" nor
    "false". ``verdict`` is the verdict without the context.
    """
    # words about the body or its axis that symrot does not understand leave open what the claim means
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
    # a word is also used if the claim or the names of its formulas have it
    unused = [word for rest in claim.context.rest for word in rest.split() if word not in own | letters]
    if not unused:
        return verdict
    note = f"of the context, these words are not used: {' '.join(unused)}"
    if verdict.verdict == "true":
        return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))
    return replace(without if verdict.verdict == "false" else verdict, notes=(*verdict.notes, note))


def _with_order(context: Context, verdict: Verdict, letters: Sequence[str]) -> Verdict:
    """Return the verdict, with "recognised" for "true" if the claim uses phi and psi in an unusual order."""
    angles = [letter for letter in letters if letter in ("phi", "psi", "dphi", "dpsi")]
    # an order that words state is not unusual
    if not context.sequence or not angles or any(context.meaning_of(letter.removeprefix("d")) for letter in angles):
        return verdict
    # psi is usually the first angle of ZYX (yaw, pitch, roll), phi that of other sequences
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
    """Return the verdict, with "recognised" for "true" if it was guessed which side a, b or c is along which axis."""
    readings = [known for known in verdict.recognised_as if not any(re.fullmatch(SIDES, old) for old in known.mapping)]
    # known formulas call the sides, or semi-axes, along x, y and z a, b and c: without renaming, nothing is guessed
    if readings:
        return replace(verdict, recognised_as=tuple(readings))
    note = "guessed, not stated: which letter is the side along which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _with_tangent(context: Context, verdict: Verdict) -> Verdict:
    """Return the verdict, with "recognised" for "true" if the claim holds for a tangent that is normal to the disk's
    plane.
    """
    places = {context.place, *(meaning.place for meaning in context.meanings)}
    normal = all(known.name.endswith("rim, z axis") for known in verdict.recognised_as)
    if TANGENT not in places or not normal or (context.body and context.body.axes):
        return verdict
    # the words "about a tangent" usually mean one in the plane of the body
    note = "guessed, not stated: the tangent is normal to the plane of the body, not in it"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _with_axes(context: Context, verdict: Verdict) -> Verdict:
    """Return the verdict, with "recognised" for "true" if the axis of a letter such as I_1 was guessed."""
    stated = set(context.body.letters.values()) if context.body else set()
    readings = [
        known
        for known in verdict.recognised_as
        if is_consistent([(old, new) for old, new in known.mapping.items()
                          if new not in stated and context.meaning_of(plain(new)) is None], fixed=True)
    ]  # fmt: skip
    # nothing is guessed if I_1 is the moment about the first axis, or if words state the axis
    if readings:
        return replace(verdict, recognised_as=tuple(sorted(readings, key=lambda k: context.sequence not in k.name)))
    note = "guessed, not stated: which letter belongs to which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _is_exchanged(known: Identification) -> bool:
    """Return whether the claim writes phi for the psi of the ``known`` formula, or psi for its phi."""
    return any({old, plain(new)} in EXCHANGED for old, new in known.mapping.items())


MOST_EDITS = 40
"""The most edits that are tried of a formula for another quantity than the context states."""

TANGENT = "about a tangent"
ENGLISH = ("from", "to", "that", "at", "between", "on", "of")


def _by_context(claim: Claim, named: NamedFormula, verdict: Verdict) -> Verdict:
    """Return the verdict by comparison of a claim with the formulas that its context means; ``verdict`` if
    undecided.
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
        return decided if decided is not None and is_true else _with_guesses(context, verdict, stated)
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
        # of the repairs, those are offered that the context admits
        repairs = tuple(islice((repair for repair, _ in recognised_edits(claim, named, (), MOST_EDITS)), MOST_REPAIRS))
        return replace(verdict, verdict=word, diagnosis=Diagnosis("context", sentence), reason="", repairs=repairs)
    return verdict


def _without_context(claim: Claim, named: NamedFormula) -> tuple[Identification, ...]:
    """Return the known formulas that a claim equals with another place or frame in its context, or without the
    context.
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


def _with_guesses(context: Context, verdict: Verdict, stated: str) -> Verdict:
    """Return the verdict with its likeliest formula first, and with a note such as "guessed, not stated: solid"."""
    readings = sorted(verdict.recognised_as, key=lambda known: len(guesses(context, known.name, stated)))
    verdict, likeliest = replace(verdict, recognised_as=tuple(readings)), readings[0]
    # a guess is a word in the formula's name that neither the context nor the claim's quantity states
    words = guesses(context, likeliest.name, stated)
    # words that follow each other are one phrase: "yaw, rotation matrix" of "yaw angle of a rotation matrix"
    follow = [f"{first} {second}" in likeliest.name for first, second in pairwise(words)]
    phrases = "".join(word + (" " if joined else ", ") for word, joined in zip(words, [*follow, False], strict=True))
    what = ", ".join(filter(None, [phrases.removesuffix(", "), likeliest.how]))
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


def _by_meant_formulas(
    claim: Claim, named: NamedFormula, verdict: Verdict, quantity: str, stated: str
) -> Verdict | None:
    """Return the verdict by comparison with all known formulas that a claim's context can mean; None if undecided."""
    try:
        formula = named.formula if named.solve is None else named.solve(named.formula)
        value = claim.with_definitions(claim.interpreter().read(formula))
    except InputError:
        return None
    words = None if claim.context.meaning_of(quantity) else words_of(named)
    meant = [other for other in _meant(claim.context, value, quantity, stated) if has_word(other.known.name, words)]
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
        return _with_guesses(claim.context, Verdict("recognised", recognised_as=readings), stated)
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
    """Return "doubtful" for a formula ``m*g*l`` if the context states a formula with one more term or factor; else
    None.
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

    # the term must have letters of its own, as h in the moment of a cylinder, of which m*r^2/4 is a part
    return with_lacking_letters(named, value, stated_formulas, assignments)


def _is_transposed(target: Any, value: Any) -> bool:
    """Return whether the square matrix ``value`` is provably the transpose of ``target``."""
    if not is_matrix(value) or value.rows != value.cols:
        return False
    decision = _equal(target.T, value)
    return decision is not None and decision.verdict == "true"


def _is_open(decision: Decision) -> bool:
    """Return whether a decision leaves open that two formulas are equal: it is undecided, or depends on signs."""
    if decision.verdict == "conditional":
        # equal for special values only, such as equal moments of inertia: the formulas differ
        return any(requirement.signs or not requirement.zeros for requirement in decision.requires)
    return decision.verdict not in ("true", "false")


def _different(
    claim: Claim, named: NamedFormula, verdict: Verdict, decisions: Sequence[tuple[Meant, Decision]]
) -> Verdict:
    """Return the verdict "false" on a claim that differs from all known formulas that its context can mean."""
    # each formula with the decision that the claim differs from it
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
    """Return at most three repairs: the best one towards each known formula, then the second-best ones."""
    in_turn = [repair for rank in zip_longest(*repairs) for repair in rank if repair is not None]
    return tuple({repair.text: repair for repair in in_turn}.values())[:MOST_REPAIRS]


def _is_shifted(value: Any, candidate: Meant) -> bool:
    """Return whether a claim's moment of inertia is that of ``candidate`` plus m d^2, for a parallel axis at a simple
    fraction of a length.
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
        if repairs and repairs[0].cost < MOST_COSTLY and diagnosis.code != "two_faults":
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
    """Return the decision on the equation ``value == target``; None if it cannot be decided."""
    try:
        return decide_equation(Equation(value, target))
    except (InputError, TooLarge):
        return None


def _meant(context: Context, value: Any, quantity: str, stated: str) -> Iterator[Meant]:
    """Yield each known formula that ``quantity`` can mean, in the letters of the claim's formula ``value``."""
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
        # a formula is yielded once for each assignment of letters
        for mapping in islice(_assignments(context, target, own, quantity, known, is_specific), MOST_ASSIGNMENTS):
            renamed = target.xreplace({**_unused_rates(mapping, own), **mapping})
            used = target.free_symbols
            names = {old.name: as_text(new) for old, new in mapping.items() if old in used}
            names = {old: new for old, new in names.items() if plain(new) != old}
            yield Meant(known, renamed, names, bool(open_words))


def _root(square: Expr) -> Expr:
    """Return the square root of ``square``, whose symbols count as positive, as masses are: a for a^2."""
    positive = {symbol: Dummy(positive=True) for symbol in square.free_symbols}
    return sqrt(square.xreplace(positive)).xreplace({new: old for old, new in positive.items()})


def _unused_rates(mapping: Mapping[Expr, Expr], own: set[Expr]) -> dict[Expr, Expr]:
    """Return ``{dphi: diff(phi(t), t)}`` for the angle rates that ``mapping`` does not replace.

    Empty if the claim has no derivatives.
    """
    if not any(atom.is_Derivative for atom in own):
        return {}
    # a claim that writes derivatives has no letter for dphi
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
    """Yield maps from symbols of the known formula ``target`` to a claim's letters ``own``, {R: r}, that books may
    use.
    """
    own_symbols = sorted(target.free_symbols - {time}, key=str)
    if context.sequence and context.sequence in known.name:  # a formula may lack an angle that the claim has
        own_symbols = sorted({*own_symbols, *ANGLES}, key=str)
    pinned = set(context.body.letters.values()) if context.body else set()
    names = {symbol.name for symbol in own_symbols}
    atoms = [atom for atom in sorted(own, key=str) if plain(as_text(atom)) not in pinned - names]
    # a formula for one body or one sequence may have symbols that the claim lacks
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
    """Return whether a letter of a claim can stand for a symbol of a known formula, as r for R."""
    if symbol in pinned or name in pinned:
        # a letter that the context gives to a dimension of the body stands for that symbol alone
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
