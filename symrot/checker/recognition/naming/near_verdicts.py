"""The verdict "doubtful" on a claim near a known formula or relation, with proven repairs."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import islice

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import atoms_of
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.solving import solution
from symrot.checker.claim.tree import Node, number, text, walk, with_names
from symrot.checker.context.context import letters_of
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.recognition.identification import known_value
from symrot.checker.recognition.known_formulas import ending_of
from symrot.checker.recognition.naming.edited import doubtful, readings_by_other_products, verdict_by_edit
from symrot.checker.recognition.naming.evidence import is_evident, is_inverted, is_of_body, says_too_little
from symrot.checker.recognition.naming.fit import fits_context, fits_quantity, has_other_length, is_unusual
from symrot.checker.recognition.naming.quantities import has_word, names_in, quantity_name, words_of
from symrot.checker.recognition.naming.quantity_variants import (
    is_evident_by_quantity,
    quantity_variants,
    without_inverse,
)
from symrot.checker.recognition.naming.ranks import misfit_of
from symrot.checker.recognition.naming.readings import (
    LEAST_SYMBOLS,
    SQUARED,
    has_root_of_sum,
    least_symbols_related,
    readings_of_claim,
    readings_of_formula,
)
from symrot.checker.recognition.single_faults.comparison import Near
from symrot.checker.recognition.single_faults.letters import is_atom
from symrot.checker.recognition.single_faults.search import near_formulas
from symrot.checker.recognition.single_faults.solved_relations import put_back, solved_claims
from symrot.checker.verdict import Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = ["MOST_PROOFS", "formulas_nearby", "nearest_verdict", "verdict_near_relation"]

MOST_SOLVED = 4
"""The largest number of letters for which an equation is solved, each time to compare it with known relations."""

PER_NAME = 0.1
"""Added to the cost of a repair for each symbol of the known formula that has another letter in the claim.

A repair turns the claim into a known formula. It costs more the less usual its fault is and the less the known formula
resembles the claim. The repairs are ranked by their costs: the author probably meant the formula of the cheapest one.
"""

PER_MISFIT = 0.3
"""Added to the cost of a repair for each contradiction between the names of the known formula and of the quantity.

For instance, the name "first component of .." contradicts the quantity omega_3. `misfit_of` counts the contradictions;
`PER_NAME` describes the cost.
"""

AS_NEAR = 0.15
"""Largest extra cost of the repair to I for which a claim equal to I + m d^2 is not taken for I with a fault.

I is a known moment of inertia of a body, so that the claim may be correct for a parallel axis. If the repair to I costs
at most this much more than the likeliest repair to a moment of inertia, none of these repairs is offered.
"""

MOST_REPAIRS = 3
"""The largest number of corrected formulas (repairs) that a verdict offers."""

MOST_PROOFS = 12
"""The largest number of changes of a claim's formula that are tested exactly.

Each change gives a formula that has the values of a known one at a few points; a proof must show that both are equal.
"""

UPRIGHT = "for an angle from the upright position, the equation is right as it stands"


def nearest_verdict(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if one edit makes the claim's formula or equation a known one.

    Return "recognised" if the formula equals a known one when its letters have certain signs, such as a > 0, and None
    in other cases.
    """
    if claim.hypotheses:
        return _near(claim, named) if _are_usable(claim) else None
    if named.solve is not None and _is_known_for_exchanged_masses(claim, named):
        return None
    near = _near(claim, named) if named.solve is not None else _near_relation(claim, named.side, named.formula)
    near = _near_inside(claim, named) if near is None else near
    is_open = words_of(named) is not None or named.solve is None
    edited = verdict_by_edit(claim, named) if near is None and is_open else near
    return _near_by_quantity(claim, named) if edited is None else edited


def _near_inside(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" on a claim ``theta = acos(u)`` if one change in u gives a known angle; or None."""
    inside = without_inverse(named)
    verdict = _near(claim, inside) if inside is not None else None
    if inside is None or inside.solve is None or verdict is None or verdict.verdict != "doubtful":
        return None
    repairs = []
    for edited in verdict.repairs:
        whole = inside.solve(read_relation(edited.text)[2])
        repairs.append(replace(edited, text=f"{text(named.side)} == {text(whole)}"))
    return replace(verdict, repairs=tuple(repairs))


def _near_by_quantity(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if a change of the quantity, not of its formula, makes the claim a known formula.

    For instance, k becomes k^2 in ``k = I/m``. Otherwise return None.
    """
    for changed in quantity_variants(named):
        if not is_evident_by_quantity(claim, named, changed):
            continue
        side, formula = changed.side, changed.formula
        quantity = solution(side)
        if quantity is None:
            continue
        other = named._replace(side=side, formula=formula, solve=quantity[1])
        if readings := readings_of_formula(claim, other, quantity[1](formula), LEAST_SYMBOLS):
            repair = Repair(f"{text(side)} == {text(formula)}", changed.code, changed.cost)
            return doubtful((repair,), readings)
    return None


def verdict_near_relation(claim: Claim) -> Verdict | None:
    """Return the verdict, usually "doubtful", on a false equation that one change makes a known relation; None for
    other equations, and for claims with hypotheses.
    """
    assert claim.relation is not None
    return None if claim.hypotheses else _near_relation(claim, *claim.relation[1:])


def _near_relation(claim: Claim, left: Node, right: Node) -> Verdict | None:
    """Return the verdict "doubtful" if ``left == right``, solved for a letter, becomes a known formula by one change.

    Return "recognised" if the solved equation, unchanged, is a known formula for certain signs of letters, such as
    a > 0, and None in other cases.
    """
    if len(names_in(left) | names_in(right)) < least_symbols_related(left, right):
        return None
    atoms = dict.fromkeys(node for side in (left, right) for _, node in walk(side) if is_atom(node))
    order = sorted(atoms, key=lambda atom: atom.value != "diff")  # rates first
    # the search for faults needs a single quantity on the left, such as T == I*alpha
    for named in islice(solved_claims(left, right, order), MOST_SOLVED):
        verdict = _near(claim, named)
        if verdict is not None:
            repairs = tuple(_in_claim(repair, left, right, named) for repair in verdict.repairs)
            return replace(verdict, repairs=repairs)
    return None


def _in_claim(repair: Repair, left: Node, right: Node, named: NamedFormula) -> Repair:
    """Return ``repair``, which corrects the solved equation ``named``, as a repair of the equation ``left == right``.

    For instance, a repair of ``T == I*alpha - M`` is turned into one of ``T + M == I*alpha``. A repair that changes
    several terms is returned as it is.
    """
    sides = put_back(left, right, named, read_relation(repair.text)[2])
    return repair if sides is None else replace(repair, text=f"{text(sides[0])} == {text(sides[1])}")


def _are_usable(claim: Claim) -> bool:
    """Return whether all hypotheses define names, such as c1 = cos(alpha), or state unit lengths: a^2 + b^2 = 1."""
    # under A = B, a right formula may be shorter than the known one, and a term would seem to be missing
    short = claim.defining
    return all(
        sign == "==" and (short.get(str(left.value)) == right or _is_norm(left, right) or _is_norm(right, left))
        for sign, left, right in claim.hypotheses
    )


def _is_norm(side: Node, other: Node) -> bool:
    """Return whether the equation ``side == other`` states that a sum of squares, or a length, is one."""
    squares = side.args if side.kind == "sum" else (side,)
    return other == number(1) and all(
        (term.kind == "power" and term.args[1] == number(2)) or (term.kind == "call" and term.value in ("dot", "abs"))
        for term in squares
    )


def formulas_nearby(claim: Claim, named: NamedFormula) -> list[Near]:
    """Return repairs of the claim's formula, each with the known formula that it gives, the likeliest first.

    Most repairs change one part of the formula, a few change two signs. The ``code`` of a repair names the fault.

    A formula with the square root of a sum, such as a*sqrt(1 - x/a^2), may equal a known formula although the look-up
    of known formulas does not find it. If such a formula has the values of a known one without a change, the list has
    at most one entry: the unchanged formula with the code "none", for the caller to prove that both are equal.
    """
    words, plain = words_of(named), quantity_name(named)
    nearby = [
        near
        for near in near_formulas(claim, named, lambda known: has_word(known.name, words))
        if not has_other_length(near.known.name, near.renaming)
    ]
    nearby.sort(key=lambda near: near.cost + PER_NAME * near.renamed + PER_MISFIT * misfit_of(plain, near.known.name))
    return nearby


def _near(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if a change of one part makes the claim's formula a known one.

    Return "recognised" if the claim's formula, unchanged, equals a known one when its letters have certain signs, such
    as a > 0, and None in other cases.
    """
    nearby = formulas_nearby(claim, named)
    of_bodies = [near for near in nearby if is_of_body(near.code, near.known.name)]
    shifted = any(near.is_shifted for near in of_bodies if near.cost <= of_bodies[0].cost + AS_NEAR)
    repairs: dict[Node, tuple[Repair, tuple[Identification, ...]]] = {}
    tried: set[Node] = set()
    # equal without a change for letters of certain signs: a*sqrt(1 - x/a^2) and sqrt(a^2 - x) for a > 0
    if nearby and nearby[0].code == "none":
        readings = _with_root(claim, named, nearby[0])
        return Verdict("recognised", recognised_as=readings) if readings else None
    for near in nearby:
        if near.tree in tried or len(repairs) == MOST_REPAIRS or len(tried) == MOST_PROOFS:
            continue
        if near.code == "two_faults" and not _is_of_usual_frame(near, [known for _, known in repairs.values()]):
            continue  # two wrong signs alone are no evidence of a fault
        tried.add(near.tree)
        if not is_evident(claim, named, near) or (shifted and is_of_body(near.code, near.known.name)):
            continue
        if says_too_little(claim, named, near) or _loses_letter(claim, near.tree):
            continue
        readings = readings_of_claim(claim, named, near.tree, 1) or readings_by_other_products(claim, named, near.tree)
        readings = readings or _with_root(claim, named, near)
        if readings and not _has_equal(claim, near.tree, repairs):
            repairs[near.tree] = Repair(f"{text(named.side)} == {text(near.tree)}", near.code, near.cost), readings
    if not repairs:
        return None
    # a formula for the space frame with letters of the body frame is itself called doubtful
    usual = {tree: pair for tree, pair in repairs.items() if claim.context or not all(map(is_unusual, pair[1]))}
    repairs = usual or repairs
    (_, readings), *_ = repairs.values()
    notes = (UPRIGHT,) if any(is_inverted(named, near) for near in nearby if near.tree in repairs) else ()
    return doubtful(tuple(repair for repair, _ in repairs.values()), readings, notes)


def _is_of_usual_frame(near: Near, others: Sequence[Sequence[Identification]]) -> bool:
    """Return whether ``near`` is for the body frame, and the known formulas ``others`` are for the space frame."""
    in_space = [all("space frame" in known.name for known in readings) for readings in others]
    return bool(in_space) and all(in_space) and "body frame" in near.known.name


def _with_root(claim: Claim, named: NamedFormula, near: Near) -> tuple[Identification, ...]:
    """Return (known formula,) if a formula with a root of a sum is proven equal to a known formula; otherwise ().

    The formula ``near.tree`` is the claim's formula after at most one change, ``near.known`` the known formula. The
    proof may need signs of letters: a*sqrt(1 - x/a^2) equals sqrt(a^2 - x) for a > 0.
    """
    ending = ending_of(near.known.name)
    if named.solve is None or ending not in ("", SQUARED):
        return ()
    try:
        value = claim.with_definitions(claim.interpreter().read(named.solve(near.tree)))
    except InputError:
        return ()
    if is_matrix(value) or not has_root_of_sum(value):
        return ()
    symbols = {as_text(atom): atom for atom in atoms_of([value])}
    known = known_value(near.known.text)
    pairs = {symbol: symbols.get(new) for symbol in known.free_symbols for old, new in near.renaming
             if old == symbol.name}  # fmt: skip
    if None in pairs.values() or {*pairs} != known.free_symbols:
        return ()
    try:
        decision = decide_equation(Equation(value**2 if ending else value, known.xreplace(pairs)))
    except (InputError, TooLarge):
        return ()
    by_sign = decision.verdict == "conditional" and all(need.signs and not need.zeros for need in decision.requires)
    if decision.verdict != "true" and not by_sign:
        return ()
    renaming = {old: new for old, new in sorted(near.renaming) if old != new}
    reading = Identification(near.known.name.removesuffix(ending), "", renaming, near.known.source)
    fits = fits_quantity(named, reading, matrix=False) and fits_context(
        claim.context, named, reading, {*letters_of(near.tree)}
    )
    return (reading,) if fits else ()


def _loses_letter(claim: Claim, tree: Node) -> bool:
    """Return whether a letter of the formula ``tree`` cancels, as b does in ``1 + b/b``.

    True also for a formula that cannot be read.
    """
    # such a formula is not offered as a repair
    try:
        value = claim.interpreter().read(tree)
    except InputError:
        return True
    return not is_matrix(value) and not claim.define and len(atoms_of([value])) < len(names_in(tree) - {"pi"})


def _is_known_for_exchanged_masses(claim: Claim, named: NamedFormula) -> bool:
    """Return whether a formula becomes a known one if m_1 and m_2 are exchanged."""
    # no fault: the author takes the other mass for the heavier one
    tree = with_names(named.formula, {"m_1": "m_2", "m_2": "m_1", "m1": "m2", "m2": "m1"})
    return tree != named.formula and bool(readings_of_claim(claim, named, tree, 1))


def _has_equal(claim: Claim, tree: Node, others: Collection[Node]) -> bool:
    """Return whether the formula ``tree`` is equal to one of the formulas ``others``."""
    interpreter = claim.interpreter()
    value = interpreter.read(tree)
    return any(decide(value, interpreter.read(other)).verdict == "true" for other in others)
