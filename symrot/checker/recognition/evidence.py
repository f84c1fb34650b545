"""How well a known formula fits a claim, judged by names, units, axes and letters, and by the context.

A claim gives a formula for a quantity (``named``). ``known`` is a formula that symrot derives, or its name; ``near`` is
a derived formula that differs from the claim's by one fault. The context is what a user states besides the claim.
"""

import re
from collections.abc import Iterable, Sequence
from itertools import pairwise

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import TIME, Node, walk
from symrot.checker.context.admission import ANGLES, COMPONENTS, admits_letters, admits_name
from symrot.checker.context.angle_orders import USUAL_SEQUENCES, are_roll_pitch_yaw
from symrot.checker.context.context import Context
from symrot.checker.recognition.formulas.kinematics import OF_ONE_ENTRY
from symrot.checker.recognition.identification import plain_name, unit_of
from symrot.checker.recognition.known_formulas import CROSS_PRODUCT, SYMMETRIC_EULER
from symrot.checker.recognition.letters import is_atom
from symrot.checker.recognition.nearby import Near
from symrot.checker.repair.edits import neighbours
from symrot.checker.repair.filter import matrix_entries
from symrot.checker.verdict import Identification
from symrot.conventions import SEQUENCES

__all__ = [
    "LEAST_SYMBOLS_EDITED",
    "MOMENT",
    "MOST_COMPONENTS",
    "RARE",
    "fits_context",
    "fits_quantity",
    "has_other_length",
    "has_terms",
    "has_word",
    "is_evident",
    "is_in_usual_sequence",
    "is_inverted",
    "is_of_body",
    "is_steady",
    "is_unusual",
    "keeps_places",
    "misfit_of",
    "names_in",
    "quantities_in",
    "quantity_name",
    "rarity_of",
    "says_too_little",
    "strangeness_of",
    "words_of",
]  # fmt: skip


LEAST_SYMBOLS_EDITED = 3
"""The fewest symbols of a scalar formula that is edited."""

MANY_LETTERS = 5
"""The fewest letters of a formula, for a quantity of an unknown name, that has a fault rather than another meaning."""

MANY_ENTRIES = 4
"""The fewest letters, each counted as often as it occurs, of a matrix that has a fault rather than another meaning."""

SAFE_BY_UNIT = ("exponent", "factor", "wrong_symbol", "extra_term", "missing_term")
"""The faults that a wrong unit proves."""

SURE_IF_STATED = ("sin_cos_swap", "half_angle", "double_half_angle", "exponent")
"""The faults of a formula whose letters are all stated, so that it can be no other formula."""

AXIS_OF_MATRIX = "axis of a rotation matrix"

QUANTITIES: tuple[tuple[str, tuple[str, ...]], ...] = (
    (r"I(_bar)?_?(xy|yx|yz|zy|xz|zx|12|21|23|32|13|31)", ("product of inertia",)),
    (r"[IJ](_bar)?_?(p|t|s|a|c|g|cm|0|n|[xyzOPQGC1-3A-D]|([xyz1-3]_?[1-3]?)\3)?",
     ("moment of inertia", "inertia tensor", "parallel-axis")),
    (r"(omega|w|Omega)_?(p|pr|prec)",
     ("precession", "rate at which the angular velocity", "rate of spin of a free symmetric body")),
    (r"w", ("angular velocity", "precession", "spin", "rate at", "frequency", "quaternion", AXIS_OF_MATRIX)),
    (r"(omega|w)_?[xyz1-3]",
     ("angular velocity", "precession", "spin", "rate at", "frequency", AXIS_OF_MATRIX)),
    (r"(omega|w|Omega)(_?[a-zA-Z0-3]+)?|n|lambda", ("angular velocity", "precession", "spin", "rate at", "frequency")),
    (r"[pqr]", ("angular velocity", "angle rates", "distance of", "vector", "Rodrigues", "quaternion")),
    (r"(d(phi|theta|psi|alpha|gamma)|(phi|theta|psi)_?dot)(_?[1-3])?", ("angle rates", "precession", "spin")),
    (r"dbeta(_?[0-4])?", ("angle rates", "quaternion rates")),
    (r"(q|beta|e|eps|epsilon|eta)_?[0-4iswxyz]",
     ("quaternion", "Rodrigues parameters of", AXIS_OF_MATRIX)),
    (r"d(omega|w|Omega)(_?[xyz1-3])?|d[pr]", ("Euler's equations", "angular acceleration")),
    (r"dq", ("Euler's equations", "angular acceleration", "Rodrigues", "quaternion")),
    (r"theta|phi|psi|Phi|vartheta|varphi", ("angle of", "angle at")),
    (r"alpha(_?[xyz1-3])?|d(dphi|dtheta|dpsi)", ("angular acceleration",)),
    (r"a_?[xyz1-3]", ("acceleration", "frequency", AXIS_OF_MATRIX)),
    (r"a(_?[a-zA-Z0-9]+)?", ("acceleration", "frequency")),
    (r"v(_?[a-zA-Z0-9]+)?", ("speed", "velocity of", "product", "vector")),
    (r"T(_?rot)?|K|K_?E|E(_?(k|kin|rot))?|KE",
     ("kinetic energy", "torque", "rotation matrix", "period", "energy of", "Jacobian", "tension of")),
    (r"d(T|E|K|KE|W)", ("power",)), (r"sigma(_?[1-3i])?", ("modified Rodrigues",)),
    (r"(V|U)_?eff", ("effective potential",)),
    (r"W", ("work", "potential", "energy")),
    (r"V|U|E_?p|PE", ("potential", "work")),
    (r"d[LHhM](_?([xyzOGCPAB0-3]|cm))?", ("rate of the angular momentum",)),
    (r"H", ("angular momentum", "energy of")), (r"[Hh](_?([xyzOGCPAB0-3]|cm))?", ("angular momentum",)),
    (r"L(_?([xyzOGCPAB0-3]|cm))?", ("angular momentum", "Lagrangian", "torque")),
    (r"p_?(phi|theta|psi|varphi)|P_?(phi|theta|psi)", ("momentum of",)),
    (r"M", ("torque", "angular momentum of", "gyroscopic couple")),
    (r"(M|N|tau|Gamma|Q)(_?[a-zA-Z1-3]+)?", ("torque", "gyroscopic couple")),
    (r"P(_?rot)?", ("power",)), (r"e", ("angle", "energy")),
    (r"k_?[xyz1-3]", ("radius of gyration", AXIS_OF_MATRIX)),
    (r"[kK](_?[a-zA-Z0-3]+)?", ("radius of gyration", "kinetic energy")),
    (r"dq_?[0-4swxyz]?|d(e|eta|epsilon)_?[0-3]?", ("quaternion",)),
)  # fmt: skip
"""Pattern of a name, with ``d`` in front for a rate -> words, one of which is in the name of each formula for it.

Names without a pattern may name any formula.
"""

CENTRE, POINT = re.compile(r"[IJk]_?(bar|G|C|cm|c|S)"), re.compile(r"[IJk]_?[OAPQB0]")
"""Names of moments and radii of gyration about the centre of mass, and about another point."""

MOMENTA = {"phi": "precession", "theta": "nutation", "psi": "spin"}
"""Angle of ZXZ -> the word for its momentum in the names of known formulas."""

MOMENT, KNOWN_MOMENT = re.compile(r"[IJ](_?\w+)?"), re.compile(r"[ABCIJ](_?\w+)?")
"""Names that are moments of inertia in any claim, and names of moments of inertia in known formulas."""

RATE_OF_ANGLE = re.compile(rf"diff\(({'|'.join(ANGLES)}|varphi|vartheta)\(t\), t\)")
KNOWN_RATE = re.compile(r"d[a-z]+(_?\w+)?|(omega|Omega|w|n)(_?\w+)?")
"""Rates of angles in claims, and symbols of known formulas that they may stand for."""

OF_MATRICES = ("inertia tensor", "rotation matrix", "Jacobian", "quaternion")
"""Words for quantities that are matrices."""

OF_VECTORS = ("rotated vector", "vector part")
"""Words for quantities that are vectors, which any letter may name."""

MOST_COMPONENTS = 4
"""The most components of a vector; a matrix with more entries is no torque or momentum, whatever its letter."""

RATES = {"precession": "dphi", "nutation": "dtheta", "spin": "dpsi"}
"""Word for the momentum of an angle -> the rate of this angle in known formulas."""

RATES_OF_TOPS = ("precession", "nutation", "frequency")
"""Words for rates of a top; a component of an angular velocity, such as omega_2 next to omega_1, is no such rate."""

OF_ANGLES = re.compile(r"angle rates of|angular velocity of [xyzXYZ]{3}\b")
"""Names of known formulas in Euler angles, two of which are not equal in a special case that books print."""

RARE = ("annulus", "thin tube", "conical shell", "elliptical")
"""Bodies whose moments a faulty formula is unlikely to mean."""

OTHER_LENGTHS = (("R(_[12])?", r"[dD].*|[lLhH]|ell"), ("[abcLh]", r"[rR]"))
"""Symbols of known formulas for radii, and for lengths and sides -> letters that books use for other lengths only."""

PARALLEL = re.compile("parallel.ax")
"""A part of the names of the formulas for a parallel axis."""

AXES = ("x1Ap", "y2Bq", "z3Cr")
"""The last letters of symbols that belong to one axis; p, q and r are the rates of an aircraft."""

OF_ROLL = re.compile(r"d?([pqr]|[Hh](_?\w+)?)")
"""Rates of an aircraft and letters of angular momentum: next to them, the name L may mean a torque, as for a roll."""

RATES_OF_AIRCRAFT = {"p": "x1", "q": "y2", "r": "z3"}
"""Rate of an aircraft -> the axis of this component of its angular velocity in the body frame."""

COMPONENTS_OF_OMEGA = tuple(f"omega_{axis}" for axis in "xyz123")

ENTRY = r"[RrACQ]_?([1-3]{2})"
"""Pattern of the names of the entries of a rotation matrix."""

FIRST_ANGLE, LAST_ANGLE = r"(var)?phi|alpha|\w+_1", r"psi|gamma|\w+_3"
"""Patterns of the names of the first and of the third of three Euler angles."""


def says_too_little(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a claim ``I = ..`` names no body, so that it may be right for a body that symrot does not know."""
    # a letter without an axis, and no body in the context: the claim may be for any body
    is_bare = re.fullmatch("[IJ]", named.name) is not None
    return is_bare and claim.context.body is None and is_of_body(near.code, near.known.name)


def has_other_length(known: str, renaming: Iterable[tuple[str, str]]) -> bool:
    """Return whether a claim has the letter of another length than a body's formula, as L for the radius R.

    ``known`` is the name of the formula; ``renaming`` has pairs (symbol, letter of the claim).
    """
    if re.match("moment of inertia of a|radius of gyration of a", known) is None or "ellip" in known:
        return False
    return any(
        re.fullmatch(symbol, old) and re.fullmatch(letters, new)
        for old, new in renaming
        for symbol, letters in OTHER_LENGTHS
    )


def is_of_body(code: str, known: str) -> bool:
    """Return whether the fault ``code`` is a wrong factor or term, and ``known`` names a moment of inertia."""
    # such a formula may be right for another body
    return code in ("factor", "missing_term", "extra_term") and known.startswith("moment of inertia of")


def misfit_of(name: str, known: str) -> float:
    """Return how badly a known formula's name ``known`` fits the quantity ``name``: a larger number is worse."""
    sequence = _rank_of_sequence(known) / (2 * len(USUAL_SEQUENCES))
    # "first component .." does not fit to omega_3, nor "entry 22 .." to R_11
    own, entry = re.fullmatch(ENTRY, name), re.match("entry ([1-3]{2}) of", known)
    is_other_entry = own is not None and entry is not None and entry[1] != own[1]
    return _misplaced(name, known) + is_other_entry + any(body in known for body in RARE) + sequence


def has_word(known: str, words: Sequence[str] | None) -> bool:
    """Return whether ``known``, the name of a known formula, contains one of ``words``. True if ``words`` is None."""
    # "velocity" does not stand for "angular velocity"
    return words is None or any(re.search(f"(?<!angular ){re.escape(word)}", known) for word in words)


def is_evident(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a formula is more likely a known one with a fault than a right formula that symrot does not know.

    Only evident faults give the verdict "doubtful".
    """
    letters, words = names_in(named.formula), words_of(named)
    quantities = len(quantities_in(named.formula))
    count = len(letters | names_in(named.side)) if named.side.kind == "product" else quantities  # an equation
    count += is_steady(near.known.name) and TIME in [node for _, node in walk(named.formula)]  # t is a letter of it
    is_new = not quantities_in(near.tree) <= quantities_in(named.formula)
    is_special = near.is_symmetric and not OF_ANGLES.search(near.known.name)
    is_component = _is_component_of_parameters(named, near) or _is_angle_of_entries(named, near)
    if is_new and near.code == "wrong_symbol" and is_component:
        return True
    if is_new and (
        max(quantities, near.array_letters) < LEAST_SYMBOLS_EDITED or near.code == "missing_term" or is_special
    ):
        return False  # a special case: the missing letter is zero, or equal to another one
    if near.code in ("overall_sign", "sign_of_term") and re.fullmatch("lambda|sigma|s", named.name):
        return False  # the root of a growth rate, whose square has the other sign
    if near.code == "sign_of_term" and is_steady(near.known.name):
        return False  # alpha may be a deceleration
    if near.code == "factor" and PARALLEL.search(near.known.name):
        return False  # the distance of the axes may be a multiple of a length, as in I_cm + m L^2/4
    if is_inverted(named, near) or _is_multiple_of_period(named, near):
        return True
    if near.has_other_unit and near.code in SAFE_BY_UNIT:
        is_energy = near.known.name.startswith("kinetic energy") and near.known.name.endswith("rolls")
        has_tension = "T" in letters | names_in(named.side) and claim.context.body is None
        return words is not None and not (is_energy and has_tension)
    is_general = not letters <= names_in(near.tree)  # the formula may have a letter of its own
    if near.code == "factor" and _is_of_stated_body(claim, near):
        return True
    is_alike = bool(neighbours(near.letter, letters))  # such as I_1 in I_1 + I_3
    if near.code == "extra_term" and (is_general or not is_alike or len(letters) < LEAST_SYMBOLS_EDITED):
        return False  # the formula may be a more general one
    angles = _only_in_sines(named.formula) - names_in(near.tree)  # as theta in the factor sin(theta)
    has_own_angle = near.code == "factor" and words is not None and letters <= names_in(near.tree) | angles
    is_of_axis = near.code == "wrong_symbol" and _is_of_axis(named, near) and count > LEAST_SYMBOLS_EDITED
    is_long = (near.code == "wrong_symbol" or has_own_angle) and count >= MANY_LETTERS
    if is_general and not is_long and not is_of_axis:
        return False
    entries = [node for _, node in walk(named.formula) if node.kind in ("call", "name") and node.value in letters]
    is_matrix_given = any(node.value == "Matrix" for _, node in walk(named.formula))
    if is_matrix_given and len(entries) >= MANY_ENTRIES:
        return True
    if near.array_letters >= LEAST_SYMBOLS_EDITED and len(entries) + near.array_letters > 2 * MANY_ENTRIES - 2:
        return True
    is_rotation = near.array_letters > 0 and near.known.name.startswith("rotation matrix")
    if is_rotation and re.fullmatch(r"[RCAQ](_\w+)?", named.name):
        return True
    if _is_stated(claim, named, near) or _is_component_of_quaternion(named, near) or _is_entry_of_matrix(named, near):
        return True
    if is_component:
        return True
    if near.code == "sign_of_term" and _is_of_stated_flat_body(claim, near):
        return True
    if near.code in SURE_IF_STATED and _are_letters_stated(claim, letters):
        return True
    if words is None:
        return max(count, near.array_letters) >= MANY_LETTERS
    is_sum = has_terms(named.formula)
    if near.code == "sign_of_term" and not is_sum:
        return False  # the direction of an axis or angle may be the other one
    is_exact = is_sum and not near.renamed and near.code == "sign_of_term"
    least = LEAST_SYMBOLS_EDITED + (not is_sum and near.code != "exponent") - is_exact
    return max(count, near.array_letters) >= least


def is_steady(known: str) -> bool:
    """Return whether ``known`` names a formula for constant angular acceleration."""
    return "constant angular acceleration" in known


def is_inverted(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim is the equation of motion of a pendulum with the wrong sign, ``theta'' = g/l*sin(theta)``.

    For an angle from the upright position this sign is right.
    """
    is_motion = named.is_rate and len(named.side.args) > 2 and "pendulum" in near.known.name
    return is_motion and near.code in ("sign_of_term", "overall_sign") and not has_terms(named.formula)


def _is_multiple_of_period(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim gives a multiple of a known period: ``pi*sqrt(L/g)`` for ``2*pi*sqrt(L/g)``."""
    # the factor before the root is 2 pi for all bodies, the one in it depends on the body
    roots = [
        {node for _, node in walk(tree) if node.kind == "call" and node.value == "sqrt"}
        for tree in (named.formula, near.tree)
    ]
    has_pi = all(any(node.value == "pi" for _, node in walk(tree)) for tree in (named.formula, near.tree))
    is_period = near.known.name.startswith("period of") and re.fullmatch("T(_[a-z]+)?", named.name) is not None
    return is_period and near.code == "factor" and has_pi and bool(roots[0]) and roots[0] == roots[1]


def _is_stated(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether the context of a claim states what its quantity is, and ``near`` is a formula for this meaning."""
    meaning = claim.context.meaning_of(quantity_name(named))
    return meaning is not None and any(phrase in near.known.name for phrase in meaning.quantity.formulas)


def _are_letters_stated(claim: Claim, letters: set[str]) -> bool:
    """Return whether the context states the meanings of two or more letters, and the others are moments of inertia."""
    stated = {letter for letter in letters if claim.context.meaning_of(letter) is not None}
    return len(stated) > 1 and all(map(MOMENT.fullmatch, letters - stated))


def _is_of_stated_body(claim: Claim, near: Near) -> bool:
    """Return whether the context of a claim states a body, and the known formula ``near`` is for this body."""
    body = claim.context.body
    return body is not None and body.kind.title in near.known.name


def _is_of_axis(named: NamedFormula, near: Near) -> bool:
    """Return whether a quantity's name ends with an axis, as I_x does, and ``near`` is a formula for the same axis."""
    axis, own = re.search(r", ([xyz]) axis$", near.known.name), re.search("[xyz]+$", quantity_name(named))
    return axis is not None and own is not None and {*own[0]} == {axis[1]}


def _is_of_stated_flat_body(claim: Claim, near: Near) -> bool:
    """Return whether the context states a flat body, and ``near`` is the theorem I_z = I_x + I_y for flat bodies."""
    body = claim.context.body
    return body is not None and "a flat body" in body.formulas and "of a flat body about the axis" in near.known.name


def _is_component_of_quaternion(named: NamedFormula, near: Near) -> bool:
    """Return whether a quaternion component has a wrong angle or function: beta_1 = e_1 sin(phi) for e_1 sin(phi/2)."""
    place = re.fullmatch(r"(beta|eta|epsilon|q)_?([0-4])", named.name)
    word, _, rest = near.known.name.partition(" component of the quaternion of axis")
    return (
        place is not None
        and near.code in ("half_angle", "double_half_angle", "sin_cos_swap")
        and bool(rest)
        and place[2] in COMPONENTS.get(word, "")
    )


def _is_entry_of_matrix(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim's quantity is named as a matrix entry, such as R_12, and ``near`` is a formula for it."""
    # a single product may be an entry of another matrix
    own, entry = re.fullmatch(ENTRY, named.name), re.match(r"entry ([1-3]{2}) of the rotation matrix", near.known.name)
    is_same = own is not None and entry is not None and own[1] in (entry[1], entry[1][::-1])
    return is_same and has_terms(named.formula)


def _is_angle_of_entries(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim gives an angle by three or more entries of a matrix, and ``near`` is such an angle."""
    letters = names_in(named.formula)
    is_of_entries = len(letters) >= LEAST_SYMBOLS_EDITED and all(re.fullmatch(ENTRY, letter) for letter in letters)
    return is_of_entries and re.search(r"angle .*of a rotation matrix", near.known.name) is not None


def _is_component_of_parameters(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim is for a component of Rodrigues parameters, as ``sigma_1`` is, from those of a quaternion,
    as beta_1 and beta_0 are, and ``near`` is a formula for this component.
    """
    place = re.fullmatch(r"[a-z]+_?([1-3])", named.name)
    word, _, rest = near.known.name.partition(" component of the ")
    series = {re.sub("_?[0-4]$", "", name) for name in names_in(named.formula)}
    is_series = len(series) == 1 and not names_in(named.formula) & series
    return (
        place is not None
        and is_series
        and place[1] in COMPONENTS.get(word, "")
        and "Rodrigues parameters of a quaternion" in rest
    )


def _only_in_sines(formula: Node) -> set[str]:
    """Return the letters that occur in a formula only inside sines and cosines."""
    inside = {name for _, node in walk(formula) if node.kind == "call" and node.value in ("sin", "cos")
              for name in names_in(node)}  # fmt: skip
    return inside - _outside_of_sines(formula)


def _outside_of_sines(node: Node) -> set[str]:
    if node.kind == "call" and node.value in ("sin", "cos"):
        return set()
    return names_in(node) if not node.args else {name for child in node.args for name in _outside_of_sines(child)}


def has_terms(formula: Node) -> bool:
    return any(node.kind in ("sum", "list") for _, node in walk(formula))


def quantities_in(formula: Node) -> set[Node]:
    """Return the symbols, functions of time and rates in a formula; phi and its rate count as two."""
    if is_atom(formula):
        return set() if formula.value in ("pi", "t") else {formula}
    return {quantity for part in formula.args for quantity in quantities_in(part)}


def names_in(formula: Node) -> set[str]:
    """Return the names of the symbols and functions of time in a formula: m and phi for ``m*phi(t)``."""
    return {
        str(node.value)
        for _, node in walk(formula)
        if (node.kind == "name" and node.value != "t") or (node.kind == "call" and node.args == (TIME,))
    }


def fits_quantity(named: NamedFormula, known: Identification, matrix: bool) -> bool:
    """Return whether a claim may mean a known formula, judged by the quantity's name and the units of the symbols."""
    words = words_of(named)
    if words is None and "inertia" in known.name and named.name[:1].islower():
        return False  # books call moments of inertia by capital letters
    if _is_component_of_rate(named) and any(word in known.name for word in RATES_OF_TOPS):
        return False
    is_torque = not matrix and "torque" in known.name and re.fullmatch(r"L(_\w+)?", named.name) is not None
    if is_torque and not any(map(OF_ROLL.fullmatch, names_in(named.formula))):
        return False
    # a matrix may be the transpose of the known one; the other sign or, for a known quantity, a multiple is a fault
    is_multiple = "times" in known.how and words is not None
    if known.how and (not matrix or "sign" in known.how or is_multiple):
        return False
    if not has_word(known.name, words) or not keeps_places(named, known) or _is_of_other_angles(named, known):
        return False
    units = [(unit_of(own), unit_of(other)) for own, other in known.mapping.items()]
    return all(own is None or other is None or own == other for own, other in units)


def _is_of_other_angles(named: NamedFormula, known: Identification) -> bool:
    """Return whether a formula for an aircraft's rate p, q or r has other Euler angles than roll, pitch and yaw, or is
    for the space frame.
    """
    sequence = re.search(r"angular velocity of (\w{3}) ", known.name)
    if named.name not in RATES_OF_AIRCRAFT or sequence is None:
        return False
    if "space frame" in known.name:
        return True
    old_names = {plain_name(new).removeprefix("d"): old.removeprefix("d") for old, new in known.mapping.items()}
    letters = {name.removeprefix("d") for name in names_in(named.formula)} & {*ANGLES}
    places = {letter: ANGLES.index(old_names.get(letter, letter)) for letter in letters
              if old_names.get(letter, letter) in ANGLES}  # fmt: skip
    return not are_roll_pitch_yaw(sequence[1], places)


def is_unusual(known: Identification) -> bool:
    """Return whether a known formula is for the space frame, though the claim's omega_1 or p usually is a body rate."""
    # books use omega_1, and p, q, r, for components in the body frame
    components = [new for old, new in known.mapping.items() if old in COMPONENTS_OF_OMEGA]
    return "space frame" in known.name and any(
        re.fullmatch(r"(omega|w)_?[1-3]|[pqr]", plain_name(new)) for new in components
    )


def keeps_places(named: NamedFormula, known: Identification) -> bool:
    """Return whether a claim agrees with a known formula in axis, entry, angle and point: R_12 contradicts entry 13."""
    momentum = re.match(r"momentum of (\w+)", known.name)
    angle = re.fullmatch(r"[pP]_?(?:var)?(phi|theta|psi)", named.name)
    if momentum and angle and MOMENTA[angle[1]] != momentum[1]:
        return False
    # R_12 contradicts entry 13
    entry, own = re.match(r"entry ([1-3]{2}) of", known.name), re.fullmatch(ENTRY, named.name)
    if entry and own and own[1] not in (entry[1], entry[1][::-1]):
        return False
    # with numbered moments, as I_1 in I_3 - I_1, an index may be wrong
    transverse = known.mapping.get("A", "A")
    if SYMMETRIC_EULER in known.name and re.fullmatch(r"\w*[1-3xyz]", transverse):
        return False
    if known.name in OF_ONE_ENTRY and not all(re.fullmatch(ENTRY, new) for new in known.mapping.values()):
        return False  # asin of a letter is any angle
    angle_of = re.match(r"(first|third) angle of (ZXZ|ZYZ) of a rotation matrix", known.name)
    if angle_of and re.fullmatch(LAST_ANGLE if angle_of[1] == "first" else FIRST_ANGLE, named.name):
        return False
    letters = [*known.mapping.values()] or [*names_in(named.formula)]
    is_parallel = PARALLEL.search(known.name) is not None
    about_other = [letter for letter in letters if MOMENT.fullmatch(letter) and not CENTRE.fullmatch(letter)]
    # the theorem of parallel axes gives the moment about a point from the one about the centre of mass
    if is_parallel and CENTRE.fullmatch(named.name) and (about_other or any(map(POINT.fullmatch, letters))):
        return False
    of_aircraft = [
        (old, new) for old, new in known.mapping.items() if new in RATES_OF_AIRCRAFT and old in COMPONENTS_OF_OMEGA
    ]
    if any(old[-1] not in RATES_OF_AIRCRAFT[new] for old, new in of_aircraft):
        return False
    if len(of_aircraft) > 1 and "space frame" in known.name:
        return False
    if known.name.endswith(CROSS_PRODUCT) and _is_reversed(named.name, known):
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
    # a letter of a moment of inertia, and a rate of an angle, stand for nothing else
    return not any(
        (MOMENT.fullmatch(new) and not KNOWN_MOMENT.fullmatch(old))
        or (RATE_OF_ANGLE.fullmatch(new) and not KNOWN_RATE.fullmatch(old))
        for old, new in known.mapping.items()
    )


def _is_reversed(name: str, known: Identification) -> bool:
    """Return whether a claim gives the velocity ``name`` as r x omega in place of omega x r."""
    second = {new.rpartition("_")[0] for old, new in known.mapping.items() if old.startswith("n")}
    return re.fullmatch(r"v(_?[a-zA-Z0-9]+)?", name) is not None and bool(second & {"omega", "w", "Omega"})


def _is_component_of_rate(named: NamedFormula) -> bool:
    """Return whether a claim's quantity is one component of an angular velocity, as omega_2 in a claim with omega_1."""
    stem = re.fullmatch(r"(omega|w|Omega)_?[1-3xyzif]", named.name)
    return stem is not None and any(
        re.fullmatch(rf"{stem[1]}_?[0-3xyzif]", other) and other != named.name for other in names_in(named.formula)
    )


def fits_context(context: Context, named: NamedFormula, known: Identification, letters: set[str]) -> bool:
    """Return whether a known formula agrees with what the context states of a claim's quantity and ``letters``.

    True without a context.
    """
    if not context:
        return True
    return admits_name(context, known.name, quantity_name(named)) and admits_letters(
        context, known.name, known.mapping, letters
    )


def words_of(named: NamedFormula) -> tuple[str, ...] | None:
    """Return words, one of which is in the name of each known formula for a claim's quantity: ("product of inertia",)
    for I_xy. None if the quantity's name has no usual meaning.
    """
    words = next((words for pattern, words in QUANTITIES if re.fullmatch(pattern, quantity_name(named))), None)
    if words and any(node.kind == "call" and node.value == "cross" for _, node in walk(named.formula)):
        words = (*words, *OF_VECTORS)  # w = u cos(a) + ...: any letter may be the name of a vector
    is_matrix_of_rows = named.formula.value == "Matrix" and len(matrix_entries(named.formula)) > MOST_COMPONENTS
    return None if words and is_matrix_of_rows and not {*words} & {*OF_MATRICES} else words


def quantity_name(named: NamedFormula) -> str:
    """Return the name of a claim's quantity: L for ``L = ..``, dL for ``L' = ..``."""
    name, dots = re.subn("_?dot$", "", re.sub("_(plus|minus)$|(_prime)+$", "", named.name))
    return f"d{name}" if named.is_rate or dots else name


def _misplaced(name: str, known: str) -> int:
    """Return how often a formula's name ``known`` contradicts the quantity ``name``: in the component, or in the frame.

    "first component in the space frame" contradicts omega_3 in both.
    """
    words = known.replace(",", "").split()
    places = [COMPONENTS[word] for word, after in pairwise([*words, ""]) if word in COMPONENTS and
              (after in ("component", "axis"))]  # fmt: skip
    # another component or axis
    misnamed = any(name[-1] in "".join(COMPONENTS.values()) and name[-1] not in letters for letters in places)
    # the space frame, for letters that books use in the body frame
    turned = re.fullmatch(r"[pqr]|(omega|w)_?[1-3]", name) is not None and "space frame" in known
    return int(misnamed) + int(turned)


def strangeness_of(named: NamedFormula, known: Identification) -> tuple[int, int, int]:
    """Return a sort key for known formulas, smallest for the one that fits the names in a claim best."""
    axes = [[next((n for n, axis in enumerate(AXES) if name[-1] in axis), None) for name in pair]
            for pair in known.mapping.items()]  # fmt: skip
    moved = sum(None not in pair and pair[0] != pair[1] for pair in axes)
    # wrong components and frames, symbols of another axis, renamed symbols
    return _misplaced(quantity_name(named), known.name), moved, len(known.mapping)


def rarity_of(known: Identification) -> tuple[bool, int]:
    """Return a sort key for known formulas, smallest for those that books print most often."""
    # equal formulas before transposed ones or multiples; usual Euler sequences before others
    return bool(known.how), _rank_of_sequence(known.name)


def is_in_usual_sequence(known: str) -> bool:
    """Return whether a known formula's name has no sequence of Euler angles, or one that books often use."""
    return _rank_of_sequence(known) < len(USUAL_SEQUENCES)


def _rank_of_sequence(known: str) -> int:
    """Return how rare the Euler sequence in a known formula's name is: 0 for the most usual one, or for none."""
    sequences = [word for word in known.split() if word in SEQUENCES]
    usual = [USUAL_SEQUENCES.index(name) if name in USUAL_SEQUENCES else len(USUAL_SEQUENCES) for name in sequences]
    return max(usual, default=0)
