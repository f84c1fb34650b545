"""Whether a claim's formula is a known formula with a fault, or may be right: only evident faults are reported.

A claim gives a formula for a quantity: ``named`` is this quantity with its formula. ``near`` is a possible correction
of the formula: one change turns the formula into ``near.tree``, which has the values of the known formula
``near.known``. The evidence is the number of letters, the unit, the names, and the context, which a user states besides
the claim.
"""

import re

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import TIME, Node, walk
from symrot.checker.context.admission import COMPONENTS
from symrot.checker.recognition.naming.fit import ENTRY, MOMENT, PARALLEL
from symrot.checker.recognition.naming.quantities import has_terms, names_in, quantities_in, quantity_name, words_of
from symrot.checker.recognition.single_faults.comparison import Near
from symrot.checker.repair.edits.names import neighbours

__all__ = ["LEAST_SYMBOLS_EDITED", "is_evident", "is_inverted", "is_of_body", "is_steady", "says_too_little"]

LEAST_SYMBOLS_EDITED = 3
"""The smallest number of quantities in a scalar formula that is compared with known formulas after an edit.

With fewer quantities, an edited formula, such as one with another sign, may equal a known one by chance.
"""

MANY_LETTERS = 5
"""A formula one change away from a known one needs this many letters if the name of its quantity has no usual meaning.

With fewer letters, the formula is usually not reported as faulty, since it may be correct for something else.
"""

MANY_OCCURRENCES = 4
"""A written-out matrix one change away from a known matrix counts as faulty if it has at least this many letters.

A letter counts as often as it occurs. A matrix with fewer letters may be correct for something else, so that further
tests decide whether it is reported.
"""

SAFE_BY_UNIT = ("exponent", "factor", "wrong_symbol", "extra_term", "missing_term")
"""Codes of faults that are usually reported if the claim's formula and the known formula have different units.

The name of the claimed quantity must have a usual meaning, such as I_zz.
"""

SURE_IF_STATED = ("sin_cos_swap", "half_angle", "double_half_angle", "exponent")
"""Codes of faults that are reported, however short the formula is, if the context states what its letters mean.

An earlier test of `is_evident` can rule the fault out, for example if the claim has a letter that the known formula
lacks.
"""


def says_too_little(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a claim ``I = ..`` names no body, so that it may be right for a body that symrot does not know."""
    # a letter without an axis, and no body in the context: the claim may be for any body
    is_bare = re.fullmatch("[IJ]", named.name) is not None
    return is_bare and claim.context.body is None and is_of_body(near.code, near.known.name)


POSITIVE = re.compile(
    r"T(_[a-z]+)?: (period of|kinetic energy)|(K|KE|E_k\w*): kinetic energy|[IJ](_\w+)?: moment of inertia"
)
"""Pattern of the name and the meaning of a quantity that is never negative."""


def is_of_body(code: str, known: str) -> bool:
    """Return whether the fault ``code`` is a wrong factor or term, and ``known`` names a moment of inertia."""
    # such a formula may be right for another body
    return code in ("factor", "missing_term", "extra_term") and known.startswith("moment of inertia of")


def is_evident(claim: Claim, named: NamedFormula, near: Near) -> bool:
    """Return whether a claim's formula is probably a known formula with an error, not a correct one unknown to symrot.

    ``named`` has the claim's formula, ``near`` the possible correction of it and the known formula that results. Only
    evident faults give the verdict "doubtful".
    """
    letters, words = names_in(named.formula), words_of(named)
    quantities = len(quantities_in(named.formula))
    count = len(letters | names_in(named.side)) if named.side.kind == "product" else quantities  # an equation
    count += is_steady(near.known.name) and TIME in [node for _, node in walk(named.formula)]  # t is a letter of it
    is_new = not quantities_in(near.tree) <= quantities_in(named.formula)
    is_component = _is_component_of_parameters(named, near) or _is_angle_of_entries(named, near)
    if is_new and near.code == "wrong_symbol" and is_component:
        return True
    if is_new and (
        max(quantities, near.array_letters) < LEAST_SYMBOLS_EDITED or near.code == "missing_term" or near.is_symmetric
    ):
        return False  # a special case: the missing letter is zero, or equal to another one
    if near.code in ("overall_sign", "sign_of_term") and re.fullmatch("lambda|sigma|s", named.name):
        return False  # the root of a growth rate, whose square has the other sign
    if near.code == "sign_of_term" and is_steady(near.known.name):
        return False  # alpha may be a deceleration
    if near.code == "factor" and PARALLEL.search(near.known.name):
        return False  # the distance of the axes may be a multiple of a length, as in I_cm + m L^2/4
    if is_inverted(named, near) or _is_multiple_of_period(named, near) or _is_negative(named, near):
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
    if is_matrix_given and len(entries) >= MANY_OCCURRENCES:
        return True
    if near.array_letters >= LEAST_SYMBOLS_EDITED and len(entries) + near.array_letters > 2 * MANY_OCCURRENCES - 2:
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


def _is_negative(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim is a known formula for a positive quantity with a minus sign: ``T = -2*pi*sqrt(L/g)``."""
    is_sign = near.code in ("sign_of_term", "overall_sign") and not has_terms(named.formula)
    return is_sign and not named.is_rate and POSITIVE.match(f"{named.name}: {near.known.name}") is not None


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
    """Return whether the user's context says what the claimed quantity is, and ``near`` is a formula for just this.

    For a claim ``K = ..`` with K stated to be a kinetic energy, ``near`` must be a known formula for a kinetic energy.
    """
    meaning = claim.context.meaning_of(quantity_name(named))
    return meaning is not None and any(phrase in near.known.name for phrase in meaning.quantity.formulas)


def _are_letters_stated(claim: Claim, letters: set[str]) -> bool:
    """Return whether the context states the meanings of two or more ``letters``, and no other meaning is in doubt.

    A letter without a stated meaning is in no doubt if it is a name of a moment of inertia, such as I_x.
    """
    stated = {letter for letter in letters if claim.context.meaning_of(letter) is not None}
    return len(stated) > 1 and all(map(MOMENT.fullmatch, letters - stated))


def _is_of_stated_body(claim: Claim, near: Near) -> bool:
    """Return whether the context of a claim states a body, and the known formula ``near`` is for this body."""
    body = claim.context.body
    return body is not None and body.kind.title in near.known.name


def _is_of_axis(named: NamedFormula, near: Near) -> bool:
    """Return whether the claimed quantity's name ends with an axis, like I_x, and the known formula has this axis.

    The known formula is that of ``near``, with a name such as "moment of inertia of .., x axis".
    """
    axis, own = re.search(r", ([xyz]) axis$", near.known.name), re.search("[xyz]+$", quantity_name(named))
    return axis is not None and own is not None and {*own[0]} == {axis[1]}


def _is_of_stated_flat_body(claim: Claim, near: Near) -> bool:
    """Return whether the context states a flat body, and ``near`` is the theorem I_z = I_x + I_y for flat bodies."""
    body = claim.context.body
    return body is not None and "a flat body" in body.formulas and "of a flat body about the axis" in near.known.name


def _is_component_of_quaternion(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim gives a quaternion component with a wrong angle or function, like beta_1 = e_1 sin(phi).

    ``near`` must be the known formula of this component, here e_1 sin(phi/2), and the fault a wrong angle or function.
    """
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
    """Return whether a claim gives an angle of a rotation matrix by three or more entries and no other letters.

    ``near`` is the known formula nearest to the claim's formula; its name must say that it gives such an angle.
    """
    letters = names_in(named.formula)
    is_of_entries = len(letters) >= LEAST_SYMBOLS_EDITED and all(re.fullmatch(ENTRY, letter) for letter in letters)
    return is_of_entries and re.search(r"angle .*of a rotation matrix", near.known.name) is not None


def _is_component_of_parameters(named: NamedFormula, near: Near) -> bool:
    """Return whether a claim gives a component of Rodrigues parameters by a quaternion: sigma_1 by beta_0 and beta_1.

    ``near`` must be a formula for the same component. The quaternion must be one letter with indices, such as beta_0.
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
