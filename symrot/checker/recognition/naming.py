"""Verdicts on claims such as ``I_zz == m/12*(a**2 + b**2)``, which only name a quantity and give a formula for it.

Nothing in such a claim defines the left side, so that nothing can be proven about it; but most formulas of books and
papers look like this. The right side is compared with the formulas that symrot derives, each with its symbols renamed
to the names in the claim. The verdict is "recognised" if it is equal to one of them, "doubtful" if a single edit makes
it equal to one, and "definition" otherwise.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from itertools import islice, pairwise
from typing import Any

from sympy import Function, Matrix, Mul, Rational, Symbol, acos, asin, atan2

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, negated, number, sum_of, text, walk
from symrot.checker.context.admission import COMPONENTS, admits_letters, admits_name
from symrot.checker.context.context import Context, letters_of
from symrot.checker.recognition.identification import identified, plain_name, unit_of
from symrot.checker.recognition.known_formulas import ending_of
from symrot.checker.recognition.letters import is_atom
from symrot.checker.recognition.nearby import Near, near_formulas
from symrot.checker.recognition.relations import primitive, terms_expanded
from symrot.checker.recognition.solved_relations import put_back, solved_claims
from symrot.checker.repair.edits import FAULT_DESCRIPTIONS, PRODUCT_OF_INERTIA, Edit, neighbours, single_edits
from symrot.checker.repair.filter import NumericFilter, matrix_entries
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.exact.decide import decide

__all__ = ["SQUARED", "verdict_near_relation", "verdict_on_name", "verdict_on_relation", "words_of"]

TIME = Node("name", "t")

MOST_EDITS = 400
MOST_NODES = 400
"""The most edits of a formula that are looked up, and the most symbols and operations of a formula that is edited."""

LEAST_SYMBOLS = 2
LEAST_SYMBOLS_EDITED = 3
"""The fewest symbols of a scalar formula that is looked up as it is written, and of one that is edited."""

LEAST_SYMBOLS_RELATED = 5
"""The fewest symbols of a relation that is edited, or is for a quantity whose name says what it is.

With fewer symbols, it may be another formula.
"""

MANY_LETTERS = 5
"""The fewest letters of a formula, for a quantity of an unknown name, that has a fault rather than another meaning."""

MANY_ENTRIES = 4
"""The fewest letters, each counted as often as it occurs, of a matrix that has a fault rather than another meaning."""

SAFE_BY_UNIT = ("exponent", "factor", "wrong_symbol", "extra_term", "missing_term")
"""The faults that a wrong unit proves."""

MOST_SOLVED = 4
"""The most letters for which an equation is solved, to compare it with known relations."""

PER_NAME, PER_PLACE = 0.1, 0.3
"""The costs of a symbol with a new name, and of a component or an axis that the name of the quantity does not say."""

AS_NEAR = 0.15
"""The most by which the cost of a moment of inertia, about a parallel axis, may exceed the cost of the nearest one."""

MOST_REPAIRS, MOST_PROOFS = 3, 12
"""The most repairs that are offered, and the most formulas near a claim for which a proof is tried."""

MOST_TERMS = 5000
"""The most terms of an equation, when multiplied out, that is compared with known relations: these are shorter."""

MOST_READINGS = 4
"""The most formulas that one verdict names."""

QUANTITIES: tuple[tuple[str, tuple[str, ...]], ...] = (
    (r"I(_bar)?_?(xy|yx|yz|zy|xz|zx|12|21|23|32|13|31)", ("product of inertia",)),
    (r"[IJ](_bar)?_?(p|t|s|a|c|g|cm|0|n|[xyzOPQGC1-3A-D]|([xyz1-3]_?[1-3]?)\3)?",
     ("moment of inertia", "inertia tensor", "parallel-axis")),
    (r"(omega|w|Omega)_?(p|pr|prec)", ("precession",)),
    (r"w", ("angular velocity", "precession", "spin", "rate at", "frequency", "quaternion")),
    (r"(omega|w|Omega)(_?[a-zA-Z0-3]+)?|n|lambda", ("angular velocity", "precession", "spin", "rate at", "frequency")),
    (r"[pqr]", ("angular velocity", "angle rates", "distance of", "vector", "Rodrigues", "quaternion")),
    (r"(d(phi|theta|psi|alpha|gamma)|(phi|theta|psi)_?dot)(_?[1-3])?", ("angle rates", "precession", "spin")),
    (r"dbeta(_?[0-4])?", ("angle rates", "quaternion rates")),
    (r"(q|beta|e|eps|epsilon|eta)_?[0-4iswxyz]", ("quaternion", "Rodrigues parameters of")),
    (r"d(omega|w|Omega)(_?[xyz1-3])?|d[pr]", ("Euler's equations", "angular acceleration")),
    (r"dq", ("Euler's equations", "angular acceleration", "Rodrigues", "quaternion")),
    (r"theta|phi|psi|Phi|vartheta|varphi", ("angle of", "angle at")),
    (r"alpha(_?[xyz1-3])?|d(dphi|dtheta|dpsi)", ("angular acceleration",)),
    (r"a(_?[a-zA-Z0-9]+)?", ("acceleration", "frequency")),
    (r"v(_?[a-zA-Z0-9]+)?", ("speed", "velocity of", "product", "vector")),
    (r"T(_?rot)?|K|K_?E|E(_?(k|kin|rot))?|KE",
     ("kinetic energy", "torque", "rotation matrix", "period", "energy of", "Jacobian")),
    (r"d(T|E|K|KE|W)", ("power",)), (r"sigma(_?[1-3i])?", ("modified Rodrigues",)),
    (r"(V|U)_?eff", ("effective potential",)),
    (r"V|U|E_?p|PE", ("potential", "work")),
    (r"[Hh](_?([xyzOGCPAB0-3]|cm))?", ("angular momentum",)),
    (r"L(_?([xyzOGCPAB0-3]|cm))?", ("angular momentum", "Lagrangian", "torque")),
    (r"p_?(phi|theta|psi|varphi)|P_?(phi|theta|psi)", ("momentum of",)),
    (r"M", ("torque", "angular momentum of")), (r"(M|N|tau|Gamma|Q)(_?[a-zA-Z1-3]+)?", ("torque",)),
    (r"P(_?rot)?", ("power",)), (r"e", ("angle", "energy")),
    (r"[kK](_?[a-zA-Z0-3]+)?", ("radius of gyration", "kinetic energy")),
    (r"dq_?[0-4swxyz]?|d(e|eta|epsilon)_?[0-3]?", ("quaternion",)),
)  # fmt: skip
"""Pattern of a name, with ``d`` in front for a rate -> words, one of which is in the name of each formula for it.

Names without a pattern may name any formula.
"""

PLUS_PRODUCTS = "for products of inertia without the minus sign, I_xy = integral of x*y dm"

SQUARED = ", squared"
"""The end of the names of those known formulas whose root has the name."""

CENTRE, POINT = re.compile(r"[IJk]_?(bar|G|C|cm|c|S)"), re.compile(r"[IJk]_?[OAPQB0]")
"""Names of moments and radii of gyration about the centre of mass, and about another point."""

MOMENTA = {"phi": "precession", "theta": "nutation", "psi": "spin"}
"""Angle of ZXZ -> the word for its momentum in the names of known formulas."""

MOMENT, KNOWN_MOMENT = re.compile(r"[IJ](_?\w+)?"), re.compile(r"[ABCIJ](_?\w+)?")
"""Names that are moments of inertia in any claim, and names of moments of inertia in known formulas."""

OF_MATRICES = ("inertia tensor", "rotation matrix", "Jacobian", "quaternion")
"""Words for quantities that are matrices."""

MOST_COMPONENTS = 4
"""The most components of a vector; a matrix with more entries is no torque or momentum, whatever its letter."""

RATES = {"precession": "dphi", "nutation": "dtheta", "spin": "dpsi"}
"""Word for the momentum of an angle -> the rate of this angle in known formulas."""

RATES_OF_TOPS = ("precession", "nutation", "frequency")
"""Words for rates of a top; a component of an angular velocity, such as omega_2 next to omega_1, is no such rate."""

OF_ANGLES = re.compile(r"angle rates of|angular velocity of [xyzXYZ]{3}\b")
"""Names of known formulas in Euler angles, two of which are not equal in a special case that books print."""

RARE = ("annulus", "thin tube", "conical shell")
"""Bodies whose moments a faulty formula is unlikely to mean."""

AXES = ("x1Ap", "y2Bq", "z3Cr")
"""The last letters of symbols that belong to one axis; p, q and r are the rates of an aircraft."""

USUAL_SEQUENCES = ("ZXZ", "ZYX", "xyz", "ZYZ", "XYZ", "zxz")
"""The sequences of Euler angles that books use most, in this order."""


def verdict_on_name(claim: Claim, named: NamedFormula, repair: bool) -> Verdict:
    """Return the verdict "recognised", "doubtful" or "definition" on a claim that names a formula.

    Raises
    ------
    InputError
        For a side that cannot be read.
    """
    _ = claim.equation  # refuses a side that cannot be read
    readings = _readings(claim, named, named.formula, LEAST_SYMBOLS)
    readings = readings or _with_other_products(claim, named, named.formula)
    if readings:
        return Verdict("recognised", recognised_as=readings)
    nearest = _nearest(claim, named) if repair else None
    if nearest is not None:
        return nearest
    own, others = _letters(named.side), _letters(named.formula)
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


def verdict_on_relation(claim: Claim) -> Verdict | None:
    """Return the verdict "recognised" on a claim that is a known relation between quantities, otherwise None."""
    assert claim.relation is not None
    _, left, right = claim.relation
    whole = NamedFormula(text(left), left, right, solve=None)
    readings = _readings_of_relation(claim, whole, right, LEAST_SYMBOLS_RELATED)
    return Verdict("recognised", recognised_as=readings) if readings else None


def _with_other_products(claim: Claim, named: NamedFormula, formula: Node) -> tuple[Identification, ...]:
    """Return the known formulas that match after a change of sign of the products of inertia.

    Some authors define products of inertia as integrals without the minus sign.
    """
    if claim.context.sign_of_products == "minus":
        return ()
    if not any(PRODUCT_OF_INERTIA.fullmatch(name) for name in _letters(formula)):
        return ()
    for edit in _edits(claim, formula):
        if edit.code == "inertia_product_sign":
            readings = _readings(claim, named, edit.tree, LEAST_SYMBOLS_EDITED)
            return tuple(replace(known, how=PLUS_PRODUCTS) for known in readings)
    return ()


def _nearest(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if one edit of the formula makes it a known formula; otherwise None."""
    if claim.hypotheses:
        return _near(claim, named) if _are_usable(claim) else None
    near = _near(claim, named) if named.solve is not None else _near_relation(claim, named.side, named.formula)
    is_open = words_of(named) is not None or named.solve is None
    return _edited(claim, named) if near is None and is_open else near


def verdict_near_relation(claim: Claim) -> Verdict | None:
    """Return the verdict "doubtful" on a false equation if one change makes it a known relation; otherwise None."""
    assert claim.relation is not None
    return None if claim.hypotheses else _near_relation(claim, *claim.relation[1:])


def _near_relation(claim: Claim, left: Node, right: Node) -> Verdict | None:
    """Return the verdict "doubtful" if one change makes an equation a known relation, solved for one of its letters."""
    if len(_letters(left) | _letters(right)) < LEAST_SYMBOLS_RELATED:
        return None
    atoms = dict.fromkeys(node for side in (left, right) for _, node in walk(side) if is_atom(node))
    order = sorted(atoms, key=lambda atom: atom.value != "diff")  # rates first
    for named in islice(solved_claims(left, right, order), MOST_SOLVED):
        verdict = _near(claim, named)
        if verdict is not None:
            repairs = tuple(_in_claim(repair, left, right, named) for repair in verdict.repairs)
            return replace(verdict, repairs=repairs)
    return None


def _in_claim(repair: Repair, left: Node, right: Node, named: NamedFormula) -> Repair:
    """Return a corrected equation, found solved for one letter, with each term on the side where the claim has it."""
    sides = put_back(left, right, named, read_relation(repair.text)[2])
    return repair if sides is None else replace(repair, text=f"{text(sides[0])} == {text(sides[1])}")


def _are_usable(claim: Claim) -> bool:
    """Return whether each hypothesis gives a name to a formula, or says that a vector or quaternion has length one.

    Points that obey other hypotheses, such as the equality of two moments, belong to special cases of known formulas.
    """
    short = claim.defining
    return all(
        sign == "==" and (short.get(str(left.value)) == right or _is_norm(left, right) or _is_norm(right, left))
        for sign, left, right in claim.hypotheses
    )


def _is_norm(side: Node, other: Node) -> bool:
    """Return whether an equation says that a sum of squares, or a length, is one."""
    squares = side.args if side.kind == "sum" else (side,)
    return other == number(1) and all(
        (term.kind == "power" and term.args[1] == number(2)) or (term.kind == "call" and term.value in ("dot", "abs"))
        for term in squares
    )


def _near(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if a change of one part makes the formula a known one; otherwise None."""
    words = words_of(named)
    nearby = near_formulas(claim, named, lambda known: _has_word(known.name, words))
    plain = _plain(named)
    nearby.sort(key=lambda near: near.cost + PER_NAME * near.renamed + PER_PLACE * _misfit(plain, near.known.name))
    of_bodies = [near for near in nearby if _is_of_body(near.code, near.known.name)]
    shifted = any(near.is_shifted for near in of_bodies if near.cost <= of_bodies[0].cost + AS_NEAR)
    repairs: dict[Node, tuple[Repair, tuple[Identification, ...]]] = {}
    tried: set[Node] = set()
    for near in nearby:
        if near.tree in tried or len(repairs) == MOST_REPAIRS or len(tried) == MOST_PROOFS:
            continue
        tried.add(near.tree)
        if not _is_evident(claim, named, near) or (shifted and _is_of_body(near.code, near.known.name)):
            continue
        if _says_too_little(claim, named, near):
            continue
        readings = _readings(claim, named, near.tree, 1) or _with_other_products(claim, named, near.tree)
        if readings and not _has_equal(claim, near.tree, repairs):
            repairs[near.tree] = Repair(f"{text(named.side)} == {text(near.tree)}", near.code, near.cost), readings
    if not repairs:
        return None
    (first, readings), *_ = repairs.values()
    diagnosis = Diagnosis(first.code, FAULT_DESCRIPTIONS[first.code])
    return Verdict(
        "doubtful",
        diagnosis=diagnosis,
        repairs=tuple(repair for repair, _ in repairs.values()),
        recognised_as=readings,
    )


def _says_too_little(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a moment of inertia without an axis may be that of another body, which symrot does not have."""
    is_bare = re.fullmatch("[IJ]", named.name) is not None
    return is_bare and claim.context.body is None and _is_of_body(near.code, near.known.name)


def _has_diameter(known: Identification) -> bool:
    """Return whether the letter of a diameter, d or D, stands for the radius in the reading of a formula."""
    return any(old in ("R", "R_1", "R_2") and new[:1] in ("d", "D") for old, new in known.mapping.items())


def _is_of_body(code: str, known: str) -> bool:
    """Return whether a fault is a number or term in the moment of inertia of a body.

    Such a formula may be right for another body or, if its moment is larger, for a parallel axis.
    """
    return code in ("factor", "missing_term", "extra_term") and known.startswith("moment of inertia of")


def _misfit(name: str, known: str) -> float:
    """Return a number that grows with contradictions between a known formula and a name, and with its rarity."""
    sequence = _rank_of_sequence(known) / (2 * len(USUAL_SEQUENCES))
    return _misplaced(name, known) + any(body in known for body in RARE) + sequence


def _has_word(known: str, words: Sequence[str] | None) -> bool:
    """Return whether one of several words is in the name of a known formula; an angular velocity is no velocity."""
    return words is None or any(re.search(f"(?<!angular ){re.escape(word)}", known) for word in words)


def _has_equal(claim: Claim, tree: Node, others: Collection[Node]) -> bool:
    """Return whether one of the formulas ``others`` is equal to the formula ``tree``."""
    interpreter = claim.interpreter()
    value = interpreter.read(tree)
    return any(decide(value, interpreter.read(other)).verdict == "true" for other in others)


def _is_evident(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a formula near a known one is likelier to have a fault than to be another formula."""
    letters, words = _letters(named.formula), words_of(named)
    count = len(letters | _letters(named.side)) if named.side.kind == "product" else len(letters)  # an equation
    is_new = not _letters(near.tree) <= letters
    is_special = near.is_symmetric and not OF_ANGLES.search(near.known.name)
    if is_new and (len(letters) < LEAST_SYMBOLS_EDITED or near.code == "missing_term" or is_special):
        return False  # a special case: the missing letter is zero, or equal to another one
    if near.code in ("overall_sign", "sign_of_term") and re.fullmatch("lambda|sigma|s", named.name):
        return False  # the root of a growth rate, whose square has the other sign
    if near.has_other_unit and near.code in SAFE_BY_UNIT:
        return words is not None
    is_general = not letters <= _letters(near.tree)  # the formula may have a letter of its own
    is_alike = bool(neighbours(near.letter, letters))  # such as I_1 in I_1 + I_3
    if near.code == "extra_term" and (is_general or not is_alike or len(letters) < LEAST_SYMBOLS_EDITED):
        return False  # the formula may be a more general one
    if is_general and not (near.code == "wrong_symbol" and count >= MANY_LETTERS):
        return False
    entries = [node for _, node in walk(named.formula) if node.kind in ("call", "name") and node.value in letters]
    is_matrix_given = any(node.value == "Matrix" for _, node in walk(named.formula))
    if is_matrix_given and len(entries) >= MANY_ENTRIES:
        return True
    if near.array_letters >= LEAST_SYMBOLS_EDITED and len(entries) + near.array_letters > 2 * MANY_ENTRIES - 2:
        return True
    if _is_stated(claim, named, near) or _is_component_of_quaternion(named, near):
        return True
    if words is None:
        return max(count, near.array_letters) >= MANY_LETTERS
    is_sum = _has_terms(named.formula)
    if near.code == "sign_of_term" and not is_sum:
        return False  # the direction of an axis or angle may be the other one
    is_exact = is_sum and not near.renamed and near.code == "sign_of_term"
    least = LEAST_SYMBOLS_EDITED + (not is_sum and near.code != "exponent") - is_exact
    return max(count, near.array_letters) >= least


def _is_stated(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether the context of a claim says that its quantity is the one of a known formula."""
    meaning = claim.context.meaning_of(_plain(named))
    return meaning is not None and any(phrase in near.known.name for phrase in meaning.quantity.formulas)


def _is_component_of_quaternion(named: NamedFormula, near: Near) -> bool:
    """Return whether the angle or function of a component of a quaternion is wrong: beta_1 = e_1 sin(phi)."""
    place = re.fullmatch(r"(beta|eta|epsilon|q)_?([0-4])", named.name)
    word, _, rest = near.known.name.partition(" component of the quaternion of axis")
    return (
        place is not None
        and near.code in ("half_angle", "double_half_angle", "sin_cos_swap")
        and bool(rest)
        and place[2] in COMPONENTS.get(word, "")
    )


def _has_terms(formula: Node) -> bool:
    return any(node.kind in ("sum", "list") for _, node in walk(formula))


def _edited(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if undoing a usual fault makes the formula a known one; otherwise None."""
    nearest: tuple[tuple[int, int, int], Verdict] | None = None
    letters = _letters(named.formula)
    if len(letters) < LEAST_SYMBOLS_EDITED + (not _has_terms(named.formula)):
        return None
    for edit in _edits(claim, named.formula):
        if _letters(edit.tree) < letters or edit.code == "extra_term":  # the formula may be a more general one
            continue
        all_readings = _readings(claim, named, edit.tree, LEAST_SYMBOLS_EDITED)
        readings = tuple(known for known in all_readings if not any(body in known.name for body in RARE))
        is_growth = re.fullmatch("lambda|sigma|s", named.name) is not None
        is_open = edit.code in ("sign_of_term", "overall_sign") and (is_growth or not _has_terms(named.formula))
        is_exchange = edit.code == "wrong_symbol" and _letters(edit.tree) == letters  # the letters mean something else
        if not readings or is_open or is_exchange or _is_of_body(edit.code, readings[0].name):
            continue
        strangeness = _strangeness(named, readings[0])
        if nearest is None or strangeness < nearest[0]:
            repair = Repair(f"{text(named.side)} == {text(edit.tree)}", edit.code, edit.cost)
            diagnosis = Diagnosis(edit.code, FAULT_DESCRIPTIONS[edit.code])
            nearest = strangeness, Verdict("doubtful", diagnosis=diagnosis, repairs=(repair,), recognised_as=readings)
        if not any(strangeness):
            break
    return nearest and nearest[1]


def _letters(formula: Node) -> set[str]:
    """Return the names of the symbols and of the functions of time in a formula."""
    return {
        str(node.value)
        for _, node in walk(formula)
        if (node.kind == "name" and node.value != "t") or (node.kind == "call" and node.args == (TIME,))
    }


def _edits(claim: Claim, formula: Node) -> Iterator[Edit]:
    """Yield the single edits of a formula, the cheapest first."""
    if sum(1 for _ in walk(formula)) > MOST_NODES:
        return
    numeric = NumericFilter(claim)
    edits = single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    yield from islice(sorted(edits, key=lambda edit: edit.cost), MOST_EDITS)


def _readings(claim: Claim, named: NamedFormula, tree: Node, least_symbols: int) -> tuple[Identification, ...]:
    """Return the known formulas to which a formula is equal and whose symbols fit the names in the claim.

    The likeliest formula comes first.
    """
    solved = () if named.solve is None else _readings_of_formula(claim, named, named.solve(tree), least_symbols)
    is_open = words_of(named) is None and least_symbols == LEAST_SYMBOLS
    return solved or _readings_of_relation(claim, named, tree, LEAST_SYMBOLS if is_open else LEAST_SYMBOLS_RELATED)


def _readings_of_relation(
    claim: Claim, named: NamedFormula, tree: Node, least_symbols: int
) -> tuple[Identification, ...]:
    """Return the known relations that are equal to the equation of ``tree`` and the claim's side with the quantity."""
    difference = sum_of([named.side, negated(tree)])
    try:
        value = claim.with_definitions(claim.interpreter().read(difference))
    except InputError:
        return ()
    if is_matrix(value) or len(value.atoms(Function, Symbol) - {time}) < least_symbols:
        return ()
    if terms_expanded(value) > MOST_TERMS:
        return ()
    value = primitive(value)
    letters = {*letters_of(tree), *letters_of(named.side)}
    looked_up = identified(value, steps=False, named=True, quantity="", is_relation=True)
    fitting = (
        known
        for known in looked_up
        if _keeps_places(named, known) and _fits_context(claim.context, named, known, letters)
    )
    return tuple(islice(fitting, MOST_READINGS))


def _readings_of_formula(
    claim: Claim, named: NamedFormula, formula: Node, least_symbols: int
) -> tuple[Identification, ...]:
    """Return the known formulas for the quantity to which a formula for it is equal, the likeliest first."""
    try:
        value = claim.with_definitions(claim.interpreter().read(formula))
    except InputError:
        return ()
    least = 1 if words_of(named) is not None and least_symbols == LEAST_SYMBOLS else least_symbols
    if not is_matrix(value) and len(value.atoms(Function, Symbol) - {time}) < least:
        return ()
    letters = {*letters_of(formula)}
    searched, ending = _without_function(value)
    looked_up = identified(searched, steps=False, named=words_of(named) is not None, quantity=_plain(named))
    fitting = [
        replace(known, name=known.name.removesuffix(ending))
        for known in looked_up
        if ending_of(known.name) == ending
        and _fits(named, known, is_matrix(value))
        and _fits_context(claim.context, named, known, letters)
        and not _has_diameter(known)
    ]
    fitting.sort(key=lambda known: (*_strangeness(named, known), _rarity(known)))
    likeliest = [known for known in fitting if _strangeness(named, known)[:2] == _strangeness(named, fitting[0])[:2]]
    return tuple(likeliest[:MOST_READINGS])


def _without_function(value: Any) -> tuple[Any, str]:
    """Return the argument of a root, acos, asin or atan2, and the ending of the names of formulas for it."""
    if is_matrix(value):
        return value, ""
    if any(power.exp == Rational(1, 2) for power in Mul.make_args(value) if power.is_Pow):
        return value**2, SQUARED
    factor, function = value.as_coeff_Mul()
    if not isinstance(function, acos | asin | atan2):
        return value, ""
    inside = Matrix(function.args) if isinstance(function, atan2) else function.args[0]
    return inside, f", {f'{factor} ' * (factor != 1)}{function.func}"


# -- how well a known formula fits the names --------------------------------------------------------------------------


def _fits(named: NamedFormula, known: Identification, matrix: bool) -> bool:
    """Return whether a claim may mean a known formula, by the name of the quantity and the units of its symbols."""
    words = words_of(named)
    if words is None and "inertia" in known.name and named.name[:1].islower():
        return False  # books call moments of inertia by capital letters
    if _is_component_of_rate(named) and any(word in known.name for word in RATES_OF_TOPS):
        return False
    is_multiple = "times" in known.how and words is not None
    if known.how and (not matrix or "sign" in known.how or is_multiple):
        return False
    if not _has_word(known.name, words) or not _keeps_places(named, known):
        return False
    units = [(unit_of(own), unit_of(other)) for own, other in known.mapping.items()]
    return all(own is None or other is None or own == other for own, other in units)


def _keeps_places(named: NamedFormula, known: Identification) -> bool:
    """Return whether the entries, axes and kinds that names state agree with a known formula.

    An entry of a rotation matrix keeps its row and column, or exchanges them. Of two parallel axes, the one through the
    centre of mass stays so. A moment of inertia is no momentum, and p_phi is the momentum along z.
    """
    momentum = re.match(r"momentum of (\w+)", known.name)
    angle = re.fullmatch(r"[pP]_?(?:var)?(phi|theta|psi)", named.name)
    if momentum and angle and MOMENTA[angle[1]] != momentum[1]:
        return False
    entry, own = re.match(r"entry ([1-3]{2}) of", known.name), re.fullmatch(r"[RrACQ]_?([1-3]{2})", named.name)
    if entry and own and own[1] not in (entry[1], entry[1][::-1]):
        return False
    letters = [*known.mapping.values()] or [*_letters(named.formula)]
    is_parallel = re.search("parallel.ax", known.name) is not None
    if is_parallel and CENTRE.fullmatch(named.name) and any(map(POINT.fullmatch, letters)):
        return False
    if re.fullmatch(r"(omega|w)_?[1-3xyz]|[nr]", known.mapping.get("dpsi", "")):
        return False  # the whole spin is no rate of an angle
    if (own_angle := re.fullmatch(r"p_?(phi|theta|psi|varphi)", named.name)) and "momentum of" in known.name:
        rate = next((new for word, old in RATES.items() if f"momentum of {word}" in known.name
                     for new in [known.mapping.get(old, old)]), "")  # fmt: skip
        return plain_name(rate) == f"d{own_angle[1]}" and not (
            "nutation" in known.name and own_angle[1] in ("phi", "psi")
        )
    momenta = [known.mapping.get(momentum, "") for momentum in ("p_phi", "p_psi")]
    if momenta[0].endswith(("3", "psi")) or momenta[1].endswith(("z", "phi")):
        return False
    return not any(MOMENT.fullmatch(new) and not KNOWN_MOMENT.fullmatch(old) for old, new in known.mapping.items())


def _is_component_of_rate(named: NamedFormula) -> bool:
    """Return whether the quantity is an angular velocity with an index next to others: omega_2 next to omega_1."""
    stem = re.fullmatch(r"(omega|w|Omega)_?[1-3xyzif]", named.name)
    return stem is not None and any(
        re.fullmatch(rf"{stem[1]}_?[0-3xyzif]", other) and other != named.name for other in _letters(named.formula)
    )


def _fits_context(context: Context, named: NamedFormula, known: Identification, letters: set[str]) -> bool:
    """Return whether a known formula fits what the context of a claim says about its quantity and its letters."""
    if not context:
        return True
    return admits_name(context, known.name, _plain(named)) and admits_letters(
        context, known.name, known.mapping, letters
    )


def words_of(named: NamedFormula) -> tuple[str, ...] | None:
    """Return words, one of which must be in the name of a known formula for a quantity; None if any name will do."""
    words = next((words for pattern, words in QUANTITIES if re.fullmatch(pattern, _plain(named))), None)
    is_matrix_of_rows = named.formula.value == "Matrix" and len(matrix_entries(named.formula)) > MOST_COMPONENTS
    return None if words and is_matrix_of_rows and not {*words} & {*OF_MATRICES} else words


def _plain(named: NamedFormula) -> str:
    """Return the name of a quantity; the name of its time derivative has a ``d`` in front."""
    name, dots = re.subn("_?dot$", "", re.sub("(_prime)+$", "", named.name))
    return f"d{name}" if named.is_rate or dots else name


def _misplaced(name: str, known: str) -> int:
    """Count the mismatches between a known formula and the name of a quantity: the component, the frame (0, 1 or 2)."""
    words = known.replace(",", "").split()
    places = [COMPONENTS[word] for word, after in pairwise([*words, ""]) if word in COMPONENTS and
              (after in ("component", "axis"))]  # fmt: skip
    misnamed = any(name[-1] in "".join(COMPONENTS.values()) and name[-1] not in letters for letters in places)
    turned = re.fullmatch(r"[pqr]|(omega|w)_?[1-3]", name) is not None and "space frame" in known
    return int(misnamed) + int(turned)


def _strangeness(named: NamedFormula, known: Identification) -> tuple[int, int, int]:
    """Return a sort key of a known formula, larger if it is less plausible as the meaning of a claim.

    The key counts a wrong component or frame, symbols with another axis, and symbols with new names.
    """
    axes = [[next((n for n, axis in enumerate(AXES) if name[-1] in axis), None) for name in pair]
            for pair in known.mapping.items()]  # fmt: skip
    moved = sum(None not in pair and pair[0] != pair[1] for pair in axes)
    return _misplaced(_plain(named), known.name), moved, len(known.mapping)


def _rarity(known: Identification) -> tuple[bool, int]:
    """Return a sort key of a known formula: formulas that match without a change, such as a transpose, come first.

    Among these, formulas with an Euler sequence that books use often come first.
    """
    return bool(known.how), _rank_of_sequence(known.name)


def _rank_of_sequence(known: str) -> int:
    """Return the rank, from 0 for the most usual, of the Euler sequence in the name of a known formula."""
    sequences = [word for word in known.split() if word in SEQUENCES]
    usual = [USUAL_SEQUENCES.index(name) if name in USUAL_SEQUENCES else len(USUAL_SEQUENCES) for name in sequences]
    return max(usual, default=0)
