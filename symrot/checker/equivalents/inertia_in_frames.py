"""Claims for one tensor of inertia in two frames, ``I_B = R^T I_A R`` and ``I_A = R I_B R^T``.

Both are right, each for one direction of R: with ``v_A = R v_B`` the kinetic energy, the same number in both frames,
gives ``I_A = R I_B R^T``.
"""

import re

from sympy import Matrix, Symbol

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.source.text import is_latex
from symrot.checker.claim.tree import Node
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.verdict import Verdict
from symrot.kinematics.rotations import elementary_rotation

__all__ = ["on_inertia_in_frames", "without_brackets"]

INERTIA = re.compile(r"(?P<stem>[IJ]|mathbf[IJ])(?:_(?P<frame>\w+))?(?P<mark>_prime|_bar|_tilde)?")
ROTATION = re.compile(r"(?:math(?:bf|cal|rm))?[A-Z]\w*")
"""Pattern of the name of a rotation matrix, which begins with a capital letter, as R in ``R^T I_A R``.

In ``n^T I_A n``, a moment of inertia about an axis, the small letter n names a vector.
"""
CONDITION = "{} takes components in the frame of {} to those in the frame of {}"


BRACKETED = re.compile(
    r"\[\s*(?:\\(?:mathbf|boldsymbol)\s*\{?\s*)?(?P<letter>[IJ])\s*\}?\s*\]\s*_\s*"
    r"(?:\{\s*(?:\\(?:mathcal|mathrm|text)\s*\{?\s*)?(?P<long>\w+)[\s}]*\}|(?P<short>\w))"
)
"""Pattern of a tensor of inertia in brackets with the letter of a frame: ``[I]_B`` or ``[I]_{\\mathcal B}``."""


def without_brackets(source: str) -> str:
    """Return a text with ``I_B`` for ``[I]_B``, the matrix of components of a tensor of inertia in the frame B."""
    latex = is_latex(source)

    def name(match: re.Match[str]) -> str:
        frame = match["long"] or match["short"]
        return f"{match['letter']}_{{{frame}}}" if latex else f"{match['letter']}_{frame}"

    return BRACKETED.sub(name, source)


def on_inertia_in_frames(claim: Claim) -> Verdict | None:
    """Return the verdict "conditional" on ``I_B = R^T I_A R`` or ``I_A = R I_B R^T``, else None.

    The condition says from which frame to which frame R must take components. Claims with hypotheses or with words on
    their meaning get None too.
    """
    if claim.relation is None or claim.hypotheses or claim.context:
        return None
    for side, other in (claim.relation[1:], claim.relation[:0:-1]):
        parts = other.args if other.kind == "product" and len(other.args) == 3 else ()
        if side.kind != "name" or not parts or parts[1].kind != "name":
            continue
        first, tensor, last = parts
        into = last == Node("transpose", None, (first,)) and first.kind == "name"
        back = first == Node("transpose", None, (last,)) and last.kind == "name"
        names = INERTIA.fullmatch(str(side.value)), INERTIA.fullmatch(str(tensor.value))
        matrix = first if into else last
        if not (into or back) or not ROTATION.fullmatch(str(matrix.value)):
            continue
        if None in names or side == tensor or names[0]["stem"] != names[1]["stem"]:  # type: ignore[index]
            continue
        if not _energy_is_the_same():
            return None
        inner, outer = tensor.value, side.value
        condition = CONDITION.format(matrix.value, *((inner, outer) if into else (outer, inner)))
        note = f"{inner} and {outer} are one tensor of inertia in two frames: the kinetic energy is the same in both"
        return Verdict("conditional", conditions=(condition,), requires=(condition,), notes=(note,), text=claim.text)
    return None


def _energy_is_the_same() -> bool:
    """Return whether ``w^T J w`` is ``v^T (R J R^T) v`` for ``v = R w`` and all rotations R."""
    angles = [Symbol(f"angle_{number}", real=True) for number in range(3)]
    first, second, third = (elementary_rotation(axis, angle) for axis, angle in zip("zxz", angles, strict=True))
    turned = first * second * third
    tensor = Matrix(3, 3, lambda row, column: Symbol(f"j_{min(row, column)}{max(row, column)}", real=True))
    rates = Matrix([Symbol(f"w_{place}", real=True) for place in range(3)])
    other = turned * rates
    energies = (rates.T * tensor * rates)[0], (other.T * (turned * tensor * turned.T) * other)[0]
    return decide_equation(Equation(*energies)).verdict == "true"
