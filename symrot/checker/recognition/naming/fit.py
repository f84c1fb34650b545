"""Whether a claim may mean a known formula, judged by names, units, axes and letters, and by the context.

Two parameters occur in most functions here. ``named`` is the quantity of a claim with the formula that the claim gives
for it. ``known`` is a known formula equal to that formula; ``known.mapping`` maps its symbols to the claim's letters
where their names differ. The context is what a user states besides the claim.
"""

import re
from collections.abc import Iterable

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.context.admission import ANGLES, admits_letters, admits_name
from symrot.checker.context.angle_orders import are_roll_pitch_yaw
from symrot.checker.context.context import Context
from symrot.checker.recognition.formulas.attitudes import CROSS_PRODUCT
from symrot.checker.recognition.formulas.dynamics import SYMMETRIC_EULER
from symrot.checker.recognition.formulas.kinematics import OF_ONE_ENTRY
from symrot.checker.recognition.naming.quantities import has_word, names_in, quantity_name, words_of
from symrot.checker.recognition.usual_letters import plain_name, unit_of
from symrot.checker.verdict import Identification

__all__ = [
    "ENTRY", "MOMENT", "PARALLEL", "fits_context", "fits_quantity", "has_other_length", "is_unusual", "keeps_places",
]  # fmt: skip

CENTRE, POINT = re.compile(r"[IJk]_?(bar|G|C|cm|c|S)"), re.compile(r"[IJk]_?[OAPQB0]")
"""Patterns of names of moments of inertia and radii of gyration: about the centre of mass, and about another point."""

MOMENTA = {"phi": "precession", "theta": "nutation", "psi": "spin"}
"""Angle of ZXZ -> the word for its momentum in the names of known formulas."""

MOMENT = re.compile(r"[IJ](_?\w+)?")
"""Pattern of the names that mean a moment of inertia in every claim, such as I_1."""

KNOWN_MOMENT = re.compile(r"[ABCIJ](_?\w+)?")
"""Pattern of the symbols of moments of inertia in symrot's known formulas, such as A and I_1."""

RATE_OF_ANGLE = re.compile(rf"diff\(({'|'.join(ANGLES)}|varphi|vartheta)\(t\), t\)")
"""Pattern of the rate of an angle in a claim, ``diff(phi(t), t)``."""

KNOWN_RATE = re.compile(r"d[a-z]+(_?\w+)?|(omega|Omega|w|n)(_?\w+)?")
"""Pattern of the symbols of known formulas, such as dphi and omega_3, in whose place a claim may have the rate of an
angle."""

RATES = {"precession": "dphi", "nutation": "dtheta", "spin": "dpsi"}
"""Name of a top's rotation by an Euler angle -> the symbol for the rate of this angle in known formulas.

The name occurs in names of formulas, such as "momentum of precession".
"""

RATES_OF_TOPS = ("precession", "nutation", "frequency")
"""Words in the names of known formulas for rates of a top.

A claim about a component of an angular velocity, such as omega_2 given by omega_1, does not mean these formulas.
"""

OTHER_LENGTHS = (("R(_[12])?", r"[dD].*|[lLhH]|ell"), ("[abcLh]", r"[rR]"))
"""Pairs of patterns: symbols of known formulas, and letters that books never use for these symbols.

A radius R is never called D, h or L; a side a or a length L is never called r.
"""

PARALLEL = re.compile("parallel.ax")
"""Pattern that occurs in the names of the formulas of the parallel-axis theorem."""

OF_ROLL = re.compile(r"d?([pqr]|[Hh](_?\w+)?)")
"""Pattern of the rates p, q, r of an aircraft and of letters of its angular momentum, such as H_x.

L may be the name of the rolling moment of an aircraft. So a scalar claim ``L = ..`` whose formula equals that of a
known torque is recognised as this torque only if the formula has such a letter.
"""

RATES_OF_AIRCRAFT = {"p": "x1", "q": "y2", "r": "z3"}
"""Rate of an aircraft -> the two names of its axis in the body frame: p is about axis x, or 1."""

COMPONENTS_OF_OMEGA = tuple(f"omega_{axis}" for axis in "xyz123")

ENTRY = r"[RrACQ]_?([1-3]{2})"
"""Pattern of the names of the entries of a rotation matrix."""

FIRST_ANGLE, LAST_ANGLE = r"(var)?phi|alpha|\w+_1", r"psi|gamma|\w+_3"
"""Patterns of the names of the first and of the third of three Euler angles."""


def has_other_length(known: str, renaming: Iterable[tuple[str, str]]) -> bool:
    """Return whether a claim gives a length of a body a letter that books never use for this length: L for a radius R.

    ``known`` is the name of the known formula, ``renaming`` has pairs (symbol of this formula, letter of the claim).
    Return False for formulas other than moments of inertia and radii of gyration, and for elliptical bodies.
    """
    if re.match("moment of inertia of a|radius of gyration of a", known) is None or "ellip" in known:
        return False
    return any(
        re.fullmatch(symbol, old) and re.fullmatch(letters, new)
        for old, new in renaming
        for symbol, letters in OTHER_LENGTHS
    )


def fits_quantity(named: NamedFormula, known: Identification, matrix: bool) -> bool:
    """Return whether a claim may mean a known formula, judged by the quantity's name and the units of the symbols.

    ``matrix`` tells whether the claim's formula is a matrix, which may also be the transpose of the known one.
    """
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
    """Return whether a claim is about an aircraft's rate p, q or r, and the known formula contradicts this meaning.

    The known formula contradicts it by giving the angular velocity in the space frame, or by Euler angles other than
    roll, pitch and yaw.
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
    """Return whether a known formula is for the space frame, but its letters in the claim are usual for the body frame.

    Such letters are omega_1 to omega_3, and p, q, r, for components of the angular velocity.
    """
    components = [new for old, new in known.mapping.items() if old in COMPONENTS_OF_OMEGA]
    return "space frame" in known.name and any(
        re.fullmatch(r"(omega|w)_?[1-3]|[pqr]", plain_name(new)) for new in components
    )


def keeps_places(named: NamedFormula, known: Identification) -> bool:
    """Return whether a claim's letters agree with a known formula in axis, matrix entry, angle and point of the body.

    For instance, a claim about R_12 contradicts a formula for "entry 13 of" a matrix (row 1, column 3).
    """
    momentum = re.match(r"momentum of (\w+)", known.name)
    angle = re.fullmatch(r"[pP]_?(?:var)?(phi|theta|psi)", named.name)
    if momentum and angle and MOMENTA[angle[1]] != momentum[1]:
        return False
    entry, own = re.match(r"entry ([1-3]{2}) of", known.name), re.fullmatch(ENTRY, named.name)
    if entry and own and own[1] not in (entry[1], entry[1][::-1]):
        return False
    # with numbered moments, as I_1 in I_3 - I_1, an index may be wrong
    transverse = known.mapping.get("A", "A")
    if SYMMETRIC_EULER in known.name and re.fullmatch(r"\w*[1-3xyz]", transverse):
        return False
    if known.name in OF_ONE_ENTRY and not all(re.fullmatch(ENTRY, new) for new in known.mapping.values()):
        return False  # asin of a letter is any angle
    angle_of = re.match(r"(first|third) (ZXZ|ZYZ) angle of a rotation matrix", known.name)
    if angle_of and re.fullmatch(LAST_ANGLE if angle_of[1] == "first" else FIRST_ANGLE, named.name):
        return False
    letters = [*known.mapping.values()] or [*names_in(named.formula)]
    is_parallel = PARALLEL.search(known.name) is not None
    about_other = [letter for letter in letters if MOMENT.fullmatch(letter) and not CENTRE.fullmatch(letter)]
    # the parallel-axis theorem gives the moment about a point from the one about the centre of mass
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
    """Return whether a claim gives one component of an angular velocity by others, such as omega_2 by omega_1.

    Without another component in the formula, omega_2 may mean something else, and the result is False.
    """
    stem = re.fullmatch(r"(omega|w|Omega)_?[1-3xyzif]", named.name)
    return stem is not None and any(
        re.fullmatch(rf"{stem[1]}_?[0-3xyzif]", other) and other != named.name for other in names_in(named.formula)
    )


def fits_context(context: Context, named: NamedFormula, known: Identification, letters: set[str]) -> bool:
    """Return whether the known formula ``known`` agrees with what the user states besides the claim (``context``).

    The context may say what the claimed quantity and the ``letters`` of the formula mean. True without a context.
    """
    if not context:
        return True
    return admits_name(context, known.name, quantity_name(named)) and admits_letters(
        context, known.name, known.mapping, letters
    )
