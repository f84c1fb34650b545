"""Claims about the angles from the axis of a free symmetric body to its angular momentum and its angular velocity.

The tangents of the two angles have the ratio of the moments of inertia. Claims may be solved for either angle, and
books use the same letters for both.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import permutations

from sympy import Expr, atan, cancel, cos, diag, sin, tan

from symrot import symbols
from symrot.checker.claim.interpreter import atoms_of
from symrot.checker.context.admission import plain
from symrot.checker.context.context import Context
from symrot.checker.context.relations.substitution import Substitution
from symrot.checker.context.relations.tops import MOMENT_LETTERS
from symrot.exact.printing import as_text

__all__ = ["is_stated", "substitutions_of_axis_angles"]

ANGLES = re.compile("theta|vartheta|gamma|alpha|beta|lambda|delta|chi|theta_?[1-3]|theta_?[bsHL]")
A, C, THETA = symbols.A, symbols.C, symbols.theta
OF_MOMENTUM, OF_VELOCITY = "angle of the axis", "angle between the axis and the angular velocity"
NAME = "relation for the angles of momentum and angular velocity to the axis of a free symmetric body"


def is_stated(context: Context) -> bool:
    """Return whether the context names the angle from a body's symmetry axis to its angular momentum or angular
    velocity.
    """
    # books use the same letters for both angles, so that only words can tell them apart
    return any(meaning.quantity.title in (OF_MOMENTUM, OF_VELOCITY) for meaning in context.meanings)


def substitutions_of_axis_angles(context: Context, sides: Sequence[Expr]) -> Iterator[Substitution]:
    """Yield interpretations of the letters of a claim that means ``tan(theta) = A/C tan(gamma)`` for a free
    symmetric top.

    Angle theta is from the axis to the angular momentum, gamma to the angular velocity. Each Substitution replaces
    gamma by ``atan(C/A tan(theta))``. The claim, given by its ``sides``, must have two angles, two moments and a
    tangent as one side; the ``context`` may say which angle is which.
    """
    if context.body is not None and "free symmetric" not in context.body.kind.title:
        return
    names = {atom: plain(as_text(atom)) for atom in sorted(atoms_of(sides), key=str)}
    angles = [atom for atom, name in names.items() if ANGLES.fullmatch(name)]
    moments = [atom for atom in names if atom not in angles]
    if len(angles) != 2 or len(moments) != 2 or not {side.func for side in sides} & {tan}:
        return
    velocity = (symbols.omega_1, symbols.omega_3)
    momentum = diag(A, C) * diag(*velocity)
    # the angle of a vector to the axis has its components across and along the axis as sine and cosine
    ratio = cancel((velocity[0] / velocity[1]) / (momentum[0, 0] / momentum[1, 1]))
    value = atan(ratio * sin(THETA) / cos(THETA))
    for (first, second), (across, along) in ((a, m) for a in permutations(angles) for m in permutations(moments)):
        own = ((first, OF_MOMENTUM), (second, OF_VELOCITY))
        meanings = [(context.meaning_of(names[atom]), title) for atom, title in own]
        if any(meaning is not None and meaning.quantity.title != title for meaning, title in meanings):
            continue
        if not (re.fullmatch(MOMENT_LETTERS[A], names[across]) and re.fullmatch(MOMENT_LETTERS[C], names[along])):
            continue
        values = {first: THETA, second: value, across: A, along: C}
        usual = names[first].startswith(("theta", "vartheta"))
        guess = f"{names[first]} is the angle of the angular momentum, {names[second]} that of the angular velocity"
        is_open = not is_stated(context) and not usual
        mapping = {"theta": names[first], "gamma": names[second], "A": names[across], "C": names[along]}
        mapping = {old: new for old, new in mapping.items() if old != new}
        yield Substitution(NAME, "derivations/symmetric_top.md", values, guess * is_open, mapping=mapping)
