"""Claims about the determinant of a rate Jacobian, such as ``det T = -sin(theta)``.

The rate Jacobian of an Euler sequence is the matrix that maps the rates of its angles to the angular velocity. It is
singular at the zeros of its determinant (gimbal lock). The determinant depends on the second angle alone. Its sign
depends on the order of the angles, which the claim does not state: both signs are recognised.
"""

import re
from collections.abc import Iterator
from functools import cache
from itertools import islice
from typing import Any

from sympy import Expr, Symbol, expand

from symrot import symbols
from symrot.checker.arrays.matrices import matrices_of_entries
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, names_in, text
from symrot.checker.context.angle_orders import USUAL_SEQUENCES
from symrot.checker.repair.edits.faults import FAULT_DESCRIPTIONS
from symrot.checker.repair.edits.single import single_edits
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge
from symrot.kinematics.euler import rate_jacobian

__all__ = ["determinants", "verdict_on_determinant"]

PHI, THETA, PSI = symbols.angles

OTHER_MATRICES = re.compile(r"[RACQIUOP]\w*")
"""Pattern of usual names of rotations, unit matrices and inertia tensors: a claim about the determinant of such a
matrix is not about a rate Jacobian."""

SECOND_ANGLE = re.compile(r"(var)?theta(_?[2yn])?|Theta|beta|pitch|(q|alpha|phi|e)_?2")
"""Pattern of the names of the second of three Euler angles."""

MOST_REPAIRS, MOST_SEQUENCES = 3, 4
"""Largest numbers of repairs that a verdict offers, and of Euler sequences that it names. The rate Jacobians of these
sequences have the claimed determinant."""


@cache
def determinants() -> dict[str, Expr]:
    """Return {sequence: determinant of its rate Jacobian} for all Euler sequences, the usual sequences first.

    The rate Jacobian is the matrix that maps the rates of the angles to the angular velocity.

    Examples
    --------
    >>> determinants()["ZYZ"], determinants()["XYZ"]
    (-sin(theta), cos(theta))
    """
    order = dict.fromkeys((*USUAL_SEQUENCES, *SEQUENCES))
    # the determinant does not depend on the first and last angle, so that these are set to zero
    return {name: expand(rate_jacobian(name).as_immutable().subs({PHI: 0, PSI: 0}).det()) for name in order}


def verdict_on_determinant(claim: Claim, repair: bool) -> Verdict | None:
    """Return the verdict on a claim ``det T = f(theta)`` about a matrix T without a definition; None for other claims.

    The verdict is "recognised" if f is the determinant of a rate Jacobian, or its negative. It is "doubtful" if
    ``repair`` is true and f becomes this determinant, or its negative, by one edit.
    """
    assert claim.relation is not None
    generic = {*matrices_of_entries(claim.define)}
    for own, formula in (claim.relation[1:], claim.relation[:0:-1]):
        names = names_in(formula) - {"pi"}
        letter = next(iter(names)) if len(names) == 1 else ""
        if not _is_determinant(own, generic) or not SECOND_ANGLE.fullmatch(letter):
            continue
        # the sequence is the stated one, or any if none is stated
        if readings := _readings(claim, formula, letter):
            return Verdict("recognised", recognised_as=readings)
        return _edited(claim, own, formula, letter) if repair else None
    return None


def _is_determinant(tree: Node, generic: set[str]) -> bool:
    """Return whether a tree is ``det(T)`` for a matrix T that may map angle rates to the angular velocity.

    T must be in ``generic``, the matrices that the claim does not define, and must not have a name such as R, which
    usually means a rotation matrix.
    """
    return tree.kind == "call" and tree.value == "det" and tree.args[0].kind == "name" and (
        str(tree.args[0].value) in generic and not OTHER_MATRICES.fullmatch(str(tree.args[0].value))
    )  # fmt: skip


def _readings(claim: Claim, formula: Node, letter: str) -> tuple[Identification, ...]:
    """Identify ``formula`` with determinants of rate Jacobians, or their negatives; usual sequences come first.

    ``letter`` is the claim's letter for the second angle. The result has at most MOST_SEQUENCES entries; it is empty if
    ``formula`` has no value or is a matrix.
    """
    try:
        value = claim.interpreter().read(formula)
    except InputError:
        return ()
    return () if is_matrix(value) else tuple(islice(_equal(claim, value, letter), MOST_SEQUENCES))


def _equal(claim: Claim, value: Any, letter: str) -> Iterator[Identification]:
    stated = claim.context.sequence
    for name, determinant in determinants().items():
        if stated and name != stated:
            continue
        own = determinant.subs(THETA, Symbol(letter, real=True))
        sign = next((sign for sign in (1, -1) if _is_equal(sign * own, value)), 0)
        if sign:
            how = "" if sign == 1 else "with the angles in the reverse order"
            mapping = {} if letter == as_text(THETA) else {as_text(THETA): letter}
            title = f"determinant of the {name} rate Jacobian, body or space frame"
            yield Identification(title, how, mapping, f'symrot.rate_jacobian("{name}").det()')


def _is_equal(first: Expr, second: Expr) -> bool:
    try:
        return decide(first, second).verdict == "true"
    except (InputError, TooLarge):
        return False


def _edited(claim: Claim, own: Node, formula: Node, letter: str) -> Verdict | None:
    """Return the verdict "doubtful" if one edit makes ``formula`` the determinant of a rate Jacobian, or None.

    ``own`` is the other side of the claim, such as det(T); ``letter`` is the claim's letter for the second angle.
    """
    numeric = NumericFilter(claim)
    edits = single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    repairs: dict[str, Repair] = {}
    named: tuple[Identification, ...] = ()
    for edit in sorted(edits, key=lambda edit: edit.cost):
        repaired = f"{text(own)} == {text(edit.tree)}"
        if repaired in repairs or not (readings := _readings(claim, edit.tree, letter)):
            continue
        repairs[repaired] = Repair(repaired, edit.code, edit.cost)
        named = named or readings
        if len(repairs) == MOST_REPAIRS:
            break
    if not repairs:
        return None
    first = next(iter(repairs.values()))
    diagnosis = Diagnosis(first.code, FAULT_DESCRIPTIONS[first.code])
    return Verdict("doubtful", diagnosis=diagnosis, repairs=tuple(repairs.values()), recognised_as=named)
