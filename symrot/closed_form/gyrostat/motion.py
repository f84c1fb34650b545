"""Closed form of the motion of a free symmetric body with a rotor along its axis: the product of two steady rotations.

The closed form gives the motion at any time. The angular momentum of the rotor relative to the body is constant.

The formulas are in :file:`gyrostat.c`. Source: Landau & Lifshitz, Mechanics, 3rd ed., section 33, for a body without a
rotor.

Proof: ``derivations/symmetric_gyrostat.md``.
"""

from collections.abc import Callable, Sequence

from symrot.closed_form.arithmetic.pairs import SMALLEST, Number, attitude, flatten_pairs, numbers, same
from symrot.closed_form.motion import ExactMotion, prepared
from symrot.errors import InputError
from symrot.scene.tables import Initial

__all__ = ["Gyrostat", "motion", "starts"]


def motion(
    inertia: Sequence[Number],
    rotor: Sequence[Number],
    omega0: Sequence[Number],
    quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0),
) -> ExactMotion:
    """Return the motion of a symmetric body whose rotor lies along the symmetry axis.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments of inertia of body and rotor together, kg m^2; those about the two axes normal to the
        rotor's axis are equal.
    rotor : 3 numbers
        Constant angular momentum of the rotor relative to the body, kg m^2/s, along one principal axis, or zero.
    omega0, quaternion0 : 3 and 4 numbers
        Angular velocity along the principal axes, rad/s; attitude, body to space, scalar first.

    Raises
    ------
    InputError
        If the body is not symmetric about the axis of the rotor, or if a number is outside its domain.
    """
    return Gyrostat(inertia, rotor).motion(omega0, quaternion0)


def starts(inertia: Sequence[Number], rotor: Sequence[Number]) -> Callable[[Initial], ExactMotion]:
    """Return a function from an initial state to the motion of one gyrostat (a body with a rotor).

    ``inertia`` are the principal moments of body and rotor together, kg m^2; ``rotor`` is the constant angular momentum
    of the rotor relative to the body, kg m^2/s, along one principal axis, or zero.
    """
    body = Gyrostat(inertia, rotor)
    return lambda start: body.motion(start.omega_b, start.quaternion)


class Gyrostat:
    """A symmetric body with a rotor along its axis, with the constants that all its motions share."""

    def __init__(self, inertia: Sequence[Number], rotor: Sequence[Number]) -> None:
        self._inertia = moments = numbers("inertia", inertia, 3, SMALLEST)
        momentum = numbers("rotor", rotor, 3)
        symmetric = [k for k in range(3) if same(moments[k - 2], moments[k - 1])]
        fitting = [k for k in symmetric if not momentum[k - 2] and not momentum[k - 1]]
        if not fitting:
            raise InputError(
                "rotor: expected a rotor along the axis of a symmetric body, got "
                f"moments {[float(x) for x in moments]} kg m^2 and rotor {[float(x) for x in momentum]} kg m^2/s"
            )
        axis = fitting[0]
        self.named = [(axis + 1) % 3, (axis + 2) % 3, axis]
        self.moments, self.rotor = flatten_pairs([moments[axis - 2], moments[axis]]), flatten_pairs([momentum[axis]])

    def motion(self, omega0: Sequence[Number], quaternion0: Sequence[Number]) -> ExactMotion:
        """Return the motion from an initial state: ``omega0``, rad/s, and ``quaternion0``, body to space."""
        rates, start = numbers("omega", omega0, 3), attitude(numbers("quaternion", quaternion0, 4))
        named = flatten_pairs([rates[k] for k in self.named])
        return prepared(
            "gyrostat",
            (self.moments, self.rotor, named, start, [*map(float, self.named), 0.0]),
            lambda: (
                "gyrostat: expected positive moments in kg m^2, a finite angular velocity in rad/s and a quaternion "
                f"that is not zero, got moments {[float(x) for x in self._inertia]}, omega {[float(x) for x in rates]}"
            ),
        )
