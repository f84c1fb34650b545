"""Verdicts on claims such as ``I_zz == m/12*(a**2 + b**2)``, which only give a formula for a named quantity.

Nothing in such a claim defines the left side; so the right side is compared with known formulas: those that symrot
derives. The verdict is "recognised" if the right side equals one, "doubtful" if it does after a single edit, and
"definition" otherwise. ``readings`` are the known formulas that a claim can mean.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, islice
from typing import Any

from sympy import Function, Matrix, Mul, Pow, Rational, S, Symbol, acos, asin, atan, atan2, fraction, pi

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import Interpreter, atoms_of, time
from symrot.checker.claim.named_formula import NamedFormula, related_formula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.solving import solution
from symrot.checker.claim.tree import Node, is_derivative, negated, number, product, sum_of, text, walk, with_names
from symrot.checker.context.context import letters_of
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.recognition.evidence import (
    LEAST_SYMBOLS_EDITED,
    MOST_COMPONENTS,
    RARE,
    fits_context,
    fits_quantity,
    has_other_length,
    has_terms,
    has_word,
    is_evident,
    is_in_usual_sequence,
    is_inverted,
    is_of_body,
    is_steady,
    is_unusual,
    keeps_places,
    misfit_of,
    names_in,
    quantities_in,
    quantity_name,
    rarity_of,
    says_too_little,
    strangeness_of,
    words_of,
)
from symrot.checker.recognition.identification import identified, known_value
from symrot.checker.recognition.known_formulas import ending_of
from symrot.checker.recognition.letters import is_atom
from symrot.checker.recognition.nearby import Near, near_formulas
from symrot.checker.recognition.quantity_variants import (
    by_lengths,
    is_evident_by_quantity,
    quantity_variants,
    without_inverse,
)  # fmt: skip
from symrot.checker.recognition.relations import terms_expanded, without_common_powers
from symrot.checker.recognition.solved_relations import put_back, solved_claims
from symrot.checker.repair.edits import COST, FAULT_DESCRIPTIONS, PRODUCT_OF_INERTIA, Edit, single_edits
from symrot.checker.repair.filter import NumericFilter, matrix_entries
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = [
    "AS_IT_STANDS", "SQUARED", "recognised_edits", "verdict_near_relation", "verdict_on_name", "verdict_on_relation",
]  # fmt: skip


MOST_EDITS = 400
MOST_NODES = 400
"""The most edits of a formula that are looked up, and the most symbols and operations of a formula that is edited."""

LEAST_SYMBOLS = 2
"""The fewest symbols of a scalar formula that is looked up as it is written."""

LEAST_SYMBOLS_RELATED = 5
"""The fewest symbols of a relation that is edited, or is for a quantity whose name says what it is.

With fewer symbols, it may be another formula.
"""

LEAST_SYMBOLS_OF_MOTION = 3
"""The fewest symbols of a relation with an angle's second time derivative and its sine: an equation of motion."""


MOST_SOLVED = 4
"""The most letters for which an equation is solved, to compare it with known relations."""

PER_NAME, PER_PLACE = 0.1, 0.3
"""The costs of a symbol with a new name, and of a component or an axis that the name of the quantity does not say."""

AS_IT_STANDS = "as it stands, it is the"
"""The beginning of a note on the unusual convention in which a doubtful claim is right."""

EXCHANGES = ("wrong_symbol", "sin_cos_swap")
"""The faults that turn a formula in one convention into a formula in another."""

AS_NEAR = 0.15
"""The most by which the cost of a moment of inertia, about a parallel axis, may exceed the cost of the nearest one."""

MOST_REPAIRS, MOST_PROOFS = 3, 12
"""The most repairs that are offered, and the most formulas near a claim for which a proof is tried."""

MOST_TERMS = 5000
"""The most terms of an equation, when multiplied out, that is compared with known relations: these are shorter."""

MOST_READINGS = 4
"""The most formulas that one verdict names."""


MINUS_PRODUCTS = "products of inertia are those with the minus sign, I_xy = -integral of x*y dm"
PLUS_PRODUCTS = "for products of inertia without the minus sign, I_xy = integral of x*y dm"

DECELERATION = r"alpha(_\w+)?|a"
"""The letters of angular accelerations."""

UPRIGHT = "for an angle from the upright position, the equation is right as it stands"

ENDS = {acos: (S.Zero, pi), asin: (-pi / 2, pi / 2), atan2: (-pi, pi)}
"""Inverse function -> the least and the largest of its values."""

SQUARED = ", squared"
"""The end of the names of those known formulas whose root has the name."""


def verdict_on_name(claim: Claim, named: NamedFormula, repair: bool) -> Verdict:
    """Return the verdict on a claim that only gives a formula for a named quantity.

    Without ``repair``, the verdict is never "doubtful".

    Raises
    ------
    InputError
        For a side that cannot be read.
    """
    _ = claim.equation  # refuses a side that cannot be read
    if (mapped := _by_matrix(claim, named, repair) or _by_inverse(claim, named, repair)) is not None:
        return mapped
    readings = _readings(claim, named, named.formula, LEAST_SYMBOLS)
    readings = readings or _with_other_products(claim, named, named.formula) or _slowing_down(claim, named)
    if readings and not claim.context and (axes := _axes_of_symmetry(readings)):
        return Verdict("definition", reason=f"it is right for a body that is symmetric about axis {axes}; for three "
                                            "different moments of inertia, one of them has a wrong index")  # fmt: skip
    if readings:
        usual = _near_usual(claim, named, readings) if repair else None
        notes = (*_on_signs_of_products(claim, named, readings), *_on_principal_values(claim, named))
        recognised = Verdict("recognised", recognised_as=readings, notes=notes)
        return recognised if usual is None else usual
    nearest = _nearest(claim, named) if repair else None
    if nearest is None:
        nearest = by_lengths(named, lambda changed: verdict_on_name(claim, changed, repair))
    if nearest is not None:
        return nearest
    own, others = names_in(named.side), names_in(named.formula)
    shared = sorted(own & others if own and others else own | others)
    if named.solve is None and shared:
        names = " and ".join(filter(None, [", ".join(shared[:-1]), shared[-1]]))
        what = "that is" if len(shared) == 1 else "these are"
        reason = f"it says something about {names}, and nothing here says what {what}"
    elif named.solve is None:
        reason = "its sides have no letter in common, and nothing here says what these quantities are"
    else:
        reason = (
            f"nothing here says what {named.name} is, and symrot derives no formula like the other side: "
            "it may be a definition"
        )
    return Verdict("definition", reason=reason)


def _axes_of_symmetry(readings: Sequence[Identification]) -> str:
    """Return "1" or "2" if all ``readings`` are for a body that is symmetric about this axis; otherwise ""."""
    # I_2 twice in (I_1 w_1, I_2 w_2, I_2 w_3) may be a misprint; books choose axis 3 for the axis of symmetry
    axes = {axis[1] if (axis := re.search("symmetric about axis ([12])$", known.name)) else "" for known in readings}
    return axes.pop() if len(axes) == 1 else ""


def _near_usual(claim: Claim, named: NamedFormula, readings: Sequence[Identification]) -> Verdict | None:
    """Return the verdict "doubtful" if a formula is right in the space frame and, after one change, in the body frame.

    Otherwise return None.
    """
    if claim.context or claim.hypotheses or not all(is_unusual(known) for known in readings):
        return None
    # such as psi' = (omega_2 sin phi + omega_1 cos phi)/cos theta: true for components in the space frame;
    # for the usual ones in the body frame, omega_1 should be omega_3
    exchanged = (near for near in _nearby(claim, named)
                 if near.code in EXCHANGES and is_in_usual_sequence(near.known.name))  # fmt: skip
    for near in islice(exchanged, MOST_PROOFS):
        usual = tuple(known for known in _readings(claim, named, near.tree, 1) if not is_unusual(known))
        if usual:
            repair = Repair(f"{text(named.side)} == {text(near.tree)}", near.code, near.cost)
            return _doubtful((repair,), usual, (f"{AS_IT_STANDS} {readings[0]}",))
    return None


def _by_matrix(claim: Claim, named: NamedFormula, repair: bool) -> Verdict | None:
    """Return the verdict on the matrix of a claim ``omega = [matrix] q_dot``, or None for claims of another form."""
    factors = named.formula.args if named.formula.kind == "product" else ()
    is_map = len(factors) == 2 and factors[0].value == "Matrix" and (is_atom(factors[1]) or is_derivative(factors[1]))
    if not is_map or len(matrix_entries(factors[0])) <= MOST_COMPONENTS:
        return None
    verdict = verdict_on_name(claim, named._replace(formula=factors[0]), repair)
    if not any(re.search("rate Jacobian|rate matrix", known.name) for known in verdict.recognised_as):
        return None
    repairs = []
    # a repair of the matrix becomes one of the whole equation
    for edited in verdict.repairs:
        side = product([read_relation(edited.text)[2], factors[1]])
        repairs.append(replace(edited, text=f"{text(named.side)} == {text(side)}"))
    return replace(verdict, repairs=tuple(repairs))


def _by_inverse(claim: Claim, named: NamedFormula, repair: bool) -> Verdict | None:
    """Return the verdict on ``w' = J^-1*(M - ..)``, for a matrix J, by that on ``J*w' = M - ..``.

    None for claims of another form, and if that verdict is "definition".
    """
    if named.formula.kind != "product" or len(named.formula.args) != 2:
        return None
    first, rest = named.formula.args
    base = _inverted(first)
    if base is None or base.value not in dict(claim.define):
        return None
    left = product([base, named.side])
    moved = claim.with_relation(("==", left, rest))
    other = related_formula(moved)
    verdict = None if other is None else verdict_on_name(moved, other, repair)
    if other is None or verdict is None or verdict.verdict == "definition":
        return None
    repairs = []
    for edited in verdict.repairs:
        sides = put_back(left, rest, other, read_relation(edited.text)[2])
        if sides is not None and sides[0] == left:
            edited = replace(edited, text=f"{text(named.side)} == {text(product([first, sides[1]]))}")
        repairs.append(edited)
    return replace(verdict, repairs=tuple(repairs))


def _inverted(node: Node) -> Node | None:
    """Return the name J for the trees of 1/J and ``J^-1``; None for other trees."""
    if node.kind == "inv" and node.args[0].kind == "name":
        return node.args[0]
    is_power = node.kind == "power" and node.args[0].kind == "name"
    return node.args[0] if is_power and node.args[1] in (number(-1), negated(number(1))) else None


def verdict_on_relation(claim: Claim) -> Verdict | None:
    """Return the verdict "recognised" on a claim that is a known equation between quantities; otherwise None."""
    assert claim.relation is not None
    _, left, right = claim.relation
    whole = NamedFormula(text(left), left, right, solve=None)
    readings = _readings_of_relation(claim, whole, right, _least_symbols_related(left, right))
    return Verdict("recognised", recognised_as=readings) if readings else None


def _least_symbols_related(left: Node, right: Node) -> int:
    """Return how many symbols the equation ``left == right`` must have to be compared with known relations."""
    nodes = [node for side in (left, right) for _, node in walk(side)]
    accelerated = {node.args[0] for node in nodes if is_derivative(node) and len(node.args) > 2}
    # an equation of motion, such as L theta'' = -g sin theta, needs fewer than another equation
    of_motion = any(
        node.kind == "call" and node.value in ("sin", "cos") and accelerated & {*node.args} for node in nodes
    )
    return LEAST_SYMBOLS_OF_MOTION if of_motion else LEAST_SYMBOLS_RELATED


def _with_other_products(claim: Claim, named: NamedFormula, formula: Node) -> tuple[Identification, ...]:
    """Return the known formulas that equal ``formula`` if products of inertia are defined without the minus sign."""
    if claim.context.sign_of_products == "minus":
        return ()
    if not any(PRODUCT_OF_INERTIA.fullmatch(name) for name in names_in(formula)):
        return ()
    for edit in _edits(claim, formula):
        if edit.code == "inertia_product_sign":
            readings = _readings(claim, named, edit.tree, LEAST_SYMBOLS_EDITED)
            return tuple(replace(known, how=PLUS_PRODUCTS) for known in readings)
    return ()


def _slowing_down(claim: Claim, named: NamedFormula) -> tuple[Identification, ...]:
    """Return the known formulas for constant angular acceleration that a claim gives with alpha as a deceleration."""
    letters = sorted(name for name in names_in(named.formula) if re.fullmatch(DECELERATION, name))
    for letter in letters:
        other = named._replace(formula=_with_sign_of(named.formula, letter))
        readings = _readings(claim, other, other.formula, LEAST_SYMBOLS)
        slowing = [replace(known, how=f"{letter} is the deceleration") for known in readings if is_steady(known.name)]
        if slowing:
            return tuple(slowing)
    return ()


def _with_sign_of(tree: Node, name: str) -> Node:
    """Return a tree with ``-name`` in place of ``name``."""
    if tree == Node("name", name):
        return negated(tree)
    return replace(tree, args=tuple(_with_sign_of(child, name) for child in tree.args))


def _on_signs_of_products(claim: Claim, named: NamedFormula, readings: Collection[Identification]) -> tuple[str, ...]:
    """Return a note, in a tuple, on the sign of products of inertia, or () if the sign does not matter or is stated."""
    names = [name for name in names_in(named.formula) if PRODUCT_OF_INERTIA.fullmatch(name)]
    if not names or claim.context.sign_of_products or any("minus sign" in f"{k.name} {k.how}" for k in readings):
        return ()
    interpreter = claim.interpreter()
    value, symbols = interpreter.read(named.formula), [interpreter.read(Node("name", name)) for name in names]
    is_even = value == value.xreplace({symbol: -symbol for symbol in symbols})
    return () if is_even else (MINUS_PRODUCTS,)


def _on_principal_values(claim: Claim, named: NamedFormula) -> tuple[str, ...]:
    """Return a note, in a tuple, on the range of an angle that a claim gives by an inverse function; otherwise ()."""
    value = claim.interpreter().read(named.formula)
    factor, function = (1, None) if is_matrix(value) else value.as_coeff_Mul()
    if not isinstance(function, acos | asin | atan2) or named.side.kind != "name":
        return ()
    least, most = sorted(factor * end for end in ENDS[type(function)])
    below = "<" if isinstance(function, atan2) else "<="
    return (f"for {least} {below} {named.name} <= {most}: {function.func} gives only these angles",)


def _nearest(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if one edit makes the claim's formula or equation a known one, "recognised" if it
    is one for certain signs of letters; otherwise None.
    """
    if claim.hypotheses:
        return _near(claim, named) if _are_usable(claim) else None
    if named.solve is not None and _is_known_for_exchanged_masses(claim, named):
        return None
    near = _near(claim, named) if named.solve is not None else _near_relation(claim, named.side, named.formula)
    near = _near_inside(claim, named) if near is None else near
    is_open = words_of(named) is not None or named.solve is None
    edited = _edited(claim, named) if near is None and is_open else near
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
    """Return the verdict "doubtful" if a change on the quantity's side, such as k to k^2, gives a known formula.

    Otherwise return None.
    """
    for changed in quantity_variants(named):
        if not is_evident_by_quantity(claim, named, changed):
            continue
        side, formula = changed.side, changed.formula
        quantity = solution(side)
        if quantity is None:
            continue
        other = named._replace(side=side, formula=formula, solve=quantity[1])
        if readings := _readings_of_formula(claim, other, quantity[1](formula), LEAST_SYMBOLS):
            repair = Repair(f"{text(side)} == {text(formula)}", changed.code, changed.cost)
            return _doubtful((repair,), readings)
    return None


def verdict_near_relation(claim: Claim) -> Verdict | None:
    """Return the verdict, usually "doubtful", on a false equation that one change makes a known relation; None for
    other equations.
    """
    assert claim.relation is not None
    return None if claim.hypotheses else _near_relation(claim, *claim.relation[1:])


def _near_relation(claim: Claim, left: Node, right: Node) -> Verdict | None:
    """Return the verdict "doubtful" if one change makes ``left == right`` a known relation, "recognised" if it is one
    for certain signs; otherwise None.
    """
    if len(names_in(left) | names_in(right)) < _least_symbols_related(left, right):
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
    """Return the repair of ``left == right`` that says the same as ``repair`` of this equation, solved as ``named``."""
    sides = put_back(left, right, named, read_relation(repair.text)[2])
    return repair if sides is None else replace(repair, text=f"{text(sides[0])} == {text(sides[1])}")


def _are_usable(claim: Claim) -> bool:
    """Return whether all hypotheses define names, as c1 = cos(alpha), or state unit lengths, as a^2 + b^2 = 1."""
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


def _nearby(claim: Claim, named: NamedFormula) -> list[Near]:
    """Return the known formulas for the claim's quantity that differ from its formula in one part, likeliest first."""
    words, plain = words_of(named), quantity_name(named)
    nearby = [
        near
        for near in near_formulas(claim, named, lambda known: has_word(known.name, words))
        if not has_other_length(near.known.name, near.renaming)
    ]
    nearby.sort(key=lambda near: near.cost + PER_NAME * near.renamed + PER_PLACE * misfit_of(plain, near.known.name))
    return nearby


def _doubtful(
    repairs: tuple[Repair, ...], readings: tuple[Identification, ...], notes: tuple[str, ...] = ()
) -> Verdict:
    """Return the verdict "doubtful" with repairs; ``readings`` are the known formulas that the first repair gives."""
    code = repairs[0].code
    diagnosis = Diagnosis(code, FAULT_DESCRIPTIONS[code])
    return Verdict("doubtful", diagnosis=diagnosis, repairs=repairs, recognised_as=readings, notes=notes)


def _near(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if a change of one part makes the formula a known one; otherwise None.

    The verdict is "recognised" if the formula equals a known one for certain signs of its letters.
    """
    nearby = _nearby(claim, named)
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
        readings = _readings(claim, named, near.tree, 1) or _with_other_products(claim, named, near.tree)
        readings = readings or _with_root(claim, named, near)
        if readings and not _has_equal(claim, near.tree, repairs):
            repairs[near.tree] = Repair(f"{text(named.side)} == {text(near.tree)}", near.code, near.cost), readings
    if not repairs:
        return None
    (_, readings), *_ = repairs.values()
    notes = (UPRIGHT,) if any(is_inverted(named, near) for near in nearby if near.tree in repairs) else ()
    return _doubtful(tuple(repair for repair, _ in repairs.values()), readings, notes)


def _is_of_usual_frame(near: Near, others: Sequence[Sequence[Identification]]) -> bool:
    """Return whether ``near`` is for the body frame, and the known formulas ``others`` are for the space frame."""
    in_space = [all("space frame" in known.name for known in readings) for readings in others]
    return bool(in_space) and all(in_space) and "body frame" in near.known.name


def _with_root(claim: Claim, named: NamedFormula, near: Near) -> tuple[Identification, ...]:
    """Return (known formula,) if ``near.tree`` equals the known formula for certain signs of letters; otherwise ()."""
    # a*sqrt(1 - x/a^2) equals sqrt(a^2 - x) for a > 0
    ending = ending_of(near.known.name)
    if named.solve is None or ending not in ("", SQUARED):
        return ()
    try:
        value = claim.with_definitions(claim.interpreter().read(named.solve(near.tree)))
    except InputError:
        return ()
    if is_matrix(value) or not _has_root_of_sum(value):
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
    """Return whether a letter of the formula ``tree`` cancels, as b does in ``1 + b/b``."""
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
    return tree != named.formula and bool(_readings(claim, named, tree, 1))


def _has_equal(claim: Claim, tree: Node, others: Collection[Node]) -> bool:
    """Return whether the formula ``tree`` is equal to one of the formulas ``others``."""
    interpreter = claim.interpreter()
    value = interpreter.read(tree)
    return any(decide(value, interpreter.read(other)).verdict == "true" for other in others)


def _edited(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if undoing a usual fault makes the formula a known one; otherwise None."""
    nearest: tuple[tuple[int, int, int], Verdict] | None = None
    if named.solve is None and named.formula.kind == "number" and named.formula.value:
        # a number alone on the right: the left side is edited
        exchanged = _edited(claim, named._replace(side=named.formula, formula=named.side))
        if exchanged is None:
            return None
        repairs = tuple(replace(r, text=" == ".join(reversed(r.text.split(" == ")))) for r in exchanged.repairs)
        return replace(exchanged, repairs=repairs)
    letters = names_in(named.formula)
    is_of_trace = named.side.kind == "call" and named.side.value == "trace" and has_terms(named.formula)
    if len(quantities_in(named.formula)) < LEAST_SYMBOLS_EDITED + (not has_terms(named.formula)) and not is_of_trace:
        return None
    least = LEAST_SYMBOLS if named.solve is None and _is_stated(claim, named) else LEAST_SYMBOLS_EDITED
    own = claim.interpreter()
    interpreter = _Remembering(own.values, own.functions, own.implied)
    for edit in (*_edits(claim, named.formula), *_with_all_terms_added(named)):
        if names_in(edit.tree) < letters or edit.code == "extra_term":  # the formula may be a more general one
            continue
        if edit.code == "two_faults":
            continue  # two changes alone are no evidence of a fault
        all_readings = _readings(claim, named, edit.tree, least, interpreter)
        readings = tuple(known for known in all_readings if not any(body in known.name for body in RARE))
        is_growth = re.fullmatch("lambda|sigma|s", named.name) is not None
        is_open = edit.code in ("sign_of_term", "overall_sign") and (is_growth or not has_terms(named.formula))
        is_exchange = edit.code == "wrong_symbol" and names_in(edit.tree) == letters  # the letters mean something else
        if not readings or is_open or is_exchange or is_of_body(edit.code, readings[0].name):
            continue
        strangeness = strangeness_of(named, readings[0])
        if nearest is None or strangeness < nearest[0]:
            repair = Repair(f"{text(named.side)} == {text(edit.tree)}", edit.code, edit.cost)
            nearest = strangeness, _doubtful((repair,), readings)
        if not any(strangeness):
            break
    return nearest and nearest[1]


@dataclass
class _Remembering(Interpreter):
    """An interpreter that reads each part of a formula once, also where edits of the formula share it."""

    known: dict[int, tuple[Node, Any]] = field(default_factory=dict)  # by id; the node is kept, so the id stays its own

    def evaluate(self, node: Node) -> Any:
        if id(node) not in self.known:
            self.known[id(node)] = node, super().evaluate(node)
        return self.known[id(node)][1]


def recognised_edits(
    claim: Claim, named: NamedFormula, letters: Collection[str], most: int
) -> Iterator[tuple[Repair, Verdict]]:
    """Yield (repair, verdict) for each single edit that makes a claim's formula a known one.

    ``letters`` are symbols that an edit may put in; the ``most`` cheapest edits are tried.
    """
    numeric = NumericFilter(claim)
    names = sorted({*numeric.names, *letters} - {*numeric.functions})
    edits = [*single_edits(named.formula, names, numeric.functions, numeric.is_matrix, numeric.moving)]
    # an exchange of two letters counts as one edit
    own = sorted(names_in(named.formula))
    for first, second in combinations(own, 2):
        exchanged = _exchanged(named.formula, {first: second, second: first})
        if exchanged != named.formula:
            edits.append(Edit("wrong_symbol", COST["wrong_symbol"], (), exchanged))
    for edit in sorted(edits, key=lambda edit: edit.cost)[:most]:
        if readings := _readings(claim, named, edit.tree, LEAST_SYMBOLS_EDITED):
            repair = Repair(f"{text(named.side)} == {text(edit.tree)}", edit.code, edit.cost)
            yield repair, Verdict("recognised", recognised_as=readings)


def _exchanged(tree: Node, names: Mapping[str, str]) -> Node:
    """Return a tree with symbols and functions of time renamed: ``names`` maps old names to new ones."""
    is_named = tree.kind == "name" or (tree.kind == "call" and is_atom(tree))
    value = names.get(str(tree.value), tree.value) if is_named else tree.value
    return replace(tree, value=value, args=tuple(_exchanged(child, names) for child in tree.args))


def _with_all_terms_added(named: NamedFormula) -> Iterator[Edit]:
    """Yield the edit to ``a + b + c`` of the formula ``a - b - c`` if the other side is a number."""
    negative = [term for term in named.formula.args if term.kind == "neg"]
    if named.solve is None and named.side.kind == "number" and named.formula.kind == "sum" and len(negative) > 1:
        added = sum_of([term.args[0] if term.kind == "neg" else term for term in named.formula.args])
        yield Edit("sign_of_term", COST["sign_of_term"] * len(negative), (), added)


def _edits(claim: Claim, formula: Node) -> Iterator[Edit]:
    """Yield the cheapest single edits of a formula, in the order of their costs; none of a very long formula."""
    if sum(1 for _ in walk(formula)) > MOST_NODES:
        return
    numeric = NumericFilter(claim)
    edits = single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    yield from islice(sorted(edits, key=lambda edit: edit.cost), MOST_EDITS)


def _readings(
    claim: Claim, named: NamedFormula, tree: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the known formulas and relations that a claim with the right side ``tree`` can mean, the likeliest first.

    Empty for too few symbols; ``least_symbols`` is the usual minimum. ``interpreter`` is by default that of the claim.
    """
    interpreter = claim.interpreter() if interpreter is None else interpreter
    solved: tuple[Identification, ...] = ()
    if named.solve is not None:
        solved = _readings_of_formula(claim, named, named.solve(tree), least_symbols, interpreter)
    is_open = _is_stated(claim, named) or (words_of(named) is None and least_symbols == LEAST_SYMBOLS)
    least = LEAST_SYMBOLS if is_open else _least_symbols_related(named.side, tree)
    return solved or _readings_of_relation(claim, named, tree, least, interpreter)


def _is_stated(claim: Claim, named: NamedFormula) -> bool:
    """Return whether the context says what each letter of a claim means."""
    letters = names_in(named.side) | names_in(named.formula)
    return bool(letters) and all(claim.context.meaning_of(letter) is not None for letter in letters)


def _readings_of_relation(
    claim: Claim, named: NamedFormula, tree: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the known relations that are equivalent to the equation ``named.side == tree``.

    Empty if the equation has fewer than ``least_symbols`` symbols.
    """
    difference = sum_of([named.side, negated(tree)])
    try:
        value = claim.with_definitions((interpreter or claim.interpreter()).read(difference))
    except InputError:
        return ()
    if is_matrix(value) or len(value.atoms(Function, Symbol) - {time}) < least_symbols:
        return ()
    if terms_expanded(value) > MOST_TERMS or _has_root_of_sum(value):
        return ()
    value = without_common_powers(value)
    letters = {*letters_of(tree), *letters_of(named.side)}

    def fits(known: Identification) -> bool:
        return keeps_places(named, known) and fits_context(claim.context, named, known, letters)

    fitting = identified(value, steps=False, named=True, quantity="", is_relation=True, fits=fits)
    return tuple(islice(fitting, MOST_READINGS))


def _has_root_of_sum(value: Any) -> bool:
    """Return whether a formula contains the root of a sum, which no known relation does."""
    return any(power.base.is_Add and not power.exp.is_Integer for power in value.atoms(Pow))


def _readings_of_formula(
    claim: Claim, named: NamedFormula, formula: Node, least_symbols: int, interpreter: Interpreter | None = None
) -> tuple[Identification, ...]:
    """Return the known formulas for the claim's quantity that are equal to ``formula``, the likeliest first.

    Usually empty if a scalar ``formula`` has fewer than ``least_symbols`` symbols.
    """
    try:
        value = claim.with_definitions((interpreter or claim.interpreter()).read(formula))
    except InputError:
        return ()
    if is_matrix(value) and value.shape == (1, 1):
        value = value[0]
    # one symbol suffices in the claim's own formula if books use the name for one thing, as I_zz;
    # a short edited formula may equal a known one by chance
    fewest = 1 if words_of(named) is not None and least_symbols == LEAST_SYMBOLS else least_symbols
    if not is_matrix(value) and len(value.atoms(Function, Symbol) - {time}) < fewest:
        return ()
    letters = {*letters_of(formula)}
    is_tangent = named.side.kind == "call" and named.side.value == "tan"
    searched, ending = _without_function(value, is_tangent)

    def fits(known: Identification) -> bool:
        return (
            ending_of(known.name) == ending
            and fits_quantity(named, known, is_matrix(value))
            and fits_context(claim.context, named, replace(known, name=known.name.removesuffix(ending)), letters)
            and not has_other_length(known.name, known.mapping.items())
        )

    is_named = words_of(named) is not None
    looked_up = identified(searched, steps=False, named=is_named, quantity=quantity_name(named), fits=fits)
    fitting = [replace(known, name=known.name.removesuffix(ending)) for known in looked_up]
    fitting.sort(key=lambda known: (*strangeness_of(named, known), rarity_of(known)))
    likeliest = [
        known for known in fitting if strangeness_of(named, known)[:2] == strangeness_of(named, fitting[0])[:2]
    ]
    return tuple(likeliest[:MOST_READINGS])


def _without_function(value: Any, of_tangent: bool = False) -> tuple[Any, str]:
    """Return a value without its outer root or inverse function, and words for that function.

    ``acos(u)`` gives (u, ", acos"), ``sqrt(u)`` gives (u, ", squared"); another u gives (u, "").
    ``of_tangent``: ``atan(a/b)``, the solution of ``tan(x) = a/b``, gives (a and b, ", atan2").
    """
    if is_matrix(value):
        return value, ""
    # known formulas with roots and inverse functions are stored without them; the words end their names
    if any(power.exp == Rational(1, 2) for power in Mul.make_args(value) if power.is_Pow):
        return value**2, SQUARED
    factor, function = value.as_coeff_Mul()
    if of_tangent and isinstance(function, atan) and factor == 1:
        return Matrix(fraction(function.args[0])), ", atan2"
    if not isinstance(function, acos | asin | atan2):
        return value, ""
    if factor < 0 and isinstance(function, asin):
        factor, function = -factor, asin(-function.args[0], evaluate=False)  # asin is odd: -asin(u) is asin(-u)
    inside = Matrix(function.args) if isinstance(function, atan2) else function.args[0]
    return inside, f", {f'{factor} ' * (factor != 1)}{function.func}"
