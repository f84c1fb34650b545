"""The symmetric heavy top at any time in closed form: Lagrange's top, and spherical and physical pendulums.

All initial states are covered: hanging, upright, exactly vertical, passing through the vertical, near and on the
separatrix of the sleeping top. Each sample takes the same time, however far it lies from the start, and its error is a
few 1e-16. The formulas are in :file:`heavy_top.h`.

Source: Klein & Sommerfeld, Theory of the Top, vol. 2, chapter 6; Whittaker, Analytical Dynamics, 4th ed., section 72.

Proof: ``derivations/heavy_top_motion.md``, ``derivations/pendulum.md``, ``derivations/sleeping_top.md``.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction

from symrot.closed_form.arithmetic.frames import quaternion_of, to_axis
from symrot.closed_form.arithmetic.pairs import (
    SMALLEST,
    Number,
    attitude,
    flatten_pairs,
    numbers,
    on_grid,
    over_common_denominator,
    same,
)
from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.motion import ExactMotion, prepared
from symrot.errors import InputError
from symrot.kinematics.hamilton import conjugate, hamilton
from symrot.scene.tables import Initial

__all__ = ["Frame", "Top", "motion", "starts"]

_DOWN = (0, 0, -1)
_UPRIGHT = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def motion(
    inertia: Sequence[Number],
    weight: Number,
    center_of_mass: Sequence[Number],
    omega0: Sequence[Number],
    quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0),
    direction: Sequence[Number] = _DOWN,
) -> ExactMotion:
    """Return the motion of a symmetric body about a fixed point of its symmetry axis, under its weight.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments of inertia with respect to the fixed point, kg m^2; those about the two axes normal to
        the axis of the centre of mass are equal. Fractions, ints and floats are taken at their exact values.
    weight : number
        Weight, N.
    center_of_mass : 3 numbers
        Position from the fixed point, body axes, m; it must lie on one of the axes.
    omega0 : 3 numbers
        Angular velocity in body axes, rad/s.
    quaternion0 : 4 numbers
        Attitude, body to space, scalar first; it is normalised.
    direction : 3 numbers
        Direction of gravity in space; any length except zero.

    Raises
    ------
    InputError
        If the body is not symmetric about the axis of its centre of mass, or if a number is outside its domain.

    Examples
    --------
    >>> motion((1, 1, 0.5), 1, (0, 0, 1), (0, 0, 2)).regime
    'steady'
    """
    return Top(inertia, weight, center_of_mass, direction).motion(omega0, quaternion0)


def starts(
    inertia: Sequence[Number], weight: Number, center_of_mass: Sequence[Number], direction: Sequence[Number] = _DOWN
) -> Callable[[Initial], ExactMotion]:
    """Return a function from an initial state to the motion of one heavy top.

    The arguments are those of :func:`motion`.
    """
    top = Top(inertia, weight, center_of_mass, direction)
    return lambda start: top.motion(start.omega_b, start.quaternion)


class Top:
    """A symmetric heavy top with the constants that its motions from all initial states share."""

    def __init__(
        self, inertia: Sequence[Number], weight: Number, center_of_mass: Sequence[Number], direction: Sequence[Number]
    ) -> None:
        self._inertia = moments = numbers("inertia", inertia, 3, SMALLEST)
        center = numbers("center_of_mass", center_of_mass, 3)
        force = numbers("weight", [weight], 1)[0]
        down = numbers("direction", direction, 3)
        along = [k for k in range(3) if center[k]]
        if not any(down):
            raise InputError("direction: expected a direction of gravity that is not the zero vector, got zero")
        if len(along) > 1 or (along and not same(moments[along[0] - 2], moments[along[0] - 1])):
            raise InputError(
                "expected a centre of mass on one axis of the body and equal moments about the two other axes, "
                f"got the centre {[float(x) for x in center]} m and moments {[float(x) for x in moments]} "
                "kg m^2"
            )
        self.free = not along or not force
        if self.free:
            return
        axis = along[0]
        pull = Fraction(force) * Fraction(center[axis])
        self._moments, self._pull = [moments[axis - 2], moments[axis]], abs(pull)
        self.moments, self.pull = flatten_pairs(self._moments), flatten_pairs([self._pull])
        self.frame = Frame(axis, [-x for x in down] if pull > 0 else down)

    def motion(self, omega0: Sequence[Number], quaternion0: Sequence[Number]) -> ExactMotion:
        """Return the motion from an initial state: ``omega0``, rad/s, and ``quaternion0``, body to space."""
        rates, attitude = numbers("omega", omega0, 3), numbers("quaternion", quaternion0, 4)
        if self.free:
            return free_body.motion(self._inertia, rates, attitude)
        frame = self.frame
        named = [rates[k] for k in frame.named]
        return prepared(
            "heavy_top",
            (self.moments, self.pull, flatten_pairs(named), frame.start(attitude), frame.space, frame.axes),
            lambda: (
                "heavy top: expected positive moments in kg m^2, a finite angular velocity in rad/s, a quaternion that "
                "is not zero, and a start that is not within 1e-29 rad of the unstable upright position, except "
                "exactly there (method='taylor' computes such motions), got moments "
                f"{[float(x) for x in self._inertia]}, omega {[float(x) for x in named]}"
            ),
            lambda: (
                _exactly(self._moments),
                _exactly([self._pull]),
                _exactly(named),
                _exactly(frame.exact_start(attitude)),
                frame.space,
                frame.axes,
            ),
        )


def _exactly(values: Sequence[Number]) -> list[Number]:
    """Return numbers as a list hi, lo, hi, lo, .. with the numbers themselves for hi and zeros for lo."""
    return [part for value in values for part in (value, 0.0)]


class Frame:
    """The axes of space and of the body in which the formulas of a heavy top hold.

    Parameters
    ----------
    axis : 0, 1 or 2
        The symmetry axis of the body.
    up : 3 numbers
        Direction of the third axis of space in the formulas: opposite to gravity if the centre of mass lies on the
        positive symmetry axis, otherwise along gravity.
    """

    def __init__(self, axis: int, up: Sequence[Number]) -> None:
        # the third axis of space points up, the third axis of the body is the symmetry axis
        self.named = [(axis + 1) % 3, (axis + 2) % 3, axis]  # e1, e2, e3 among the body's axes, in cyclic order
        self.space, self.axes = _UPRIGHT, None
        self.before, self.after = None, None  # left and right factor of an attitude
        if up[0] or up[1] or up[2] < 0:  # the third axis does not point up yet
            turn = quaternion_of(to_axis([Fraction(x) for x in up]))
            self.space, self.before = flatten_pairs(turn), conjugate(turn)
        if axis != 2:
            matrix = [[Fraction(int(self.named[k] == i)) for k in range(3)] for i in range(3)]
            self.after = quaternion_of(matrix)
            self.axes = flatten_pairs([*(x for row in matrix for x in row), *self.after])
        self._before, self._after = (
            None if q is None else over_common_denominator(q) for q in (self.before, self.after)
        )

    @property
    def plain(self) -> bool:
        """Whether this frame's axes are those in which states are given, so that attitudes need no conversion."""
        # the symmetry axis is the body's third axis, and up is the direction of z
        return self._before is self._after is None

    def start(self, quaternion: Sequence[Number]) -> list[float]:
        """Convert the attitude ``quaternion`` to the axes of this frame; return the components as a list of 8 doubles.

        These are hi and lo of q0, then of q1, q2 and q3, where each sum hi + lo is a component.
        """
        # rounded as in symrot.closed_form.arithmetic.pairs.attitude
        if self.plain:
            return attitude(quaternion)
        integers, shared = self._converted(quaternion)
        return on_grid([(x, shared) for x in integers])

    def exact_start(self, quaternion: Sequence[Number]) -> list[Fraction]:
        """Convert the attitude ``quaternion`` to the axes of this frame; return its four components."""
        integers, shared = self._converted(quaternion)
        return [Fraction(x, shared) for x in integers]

    def _converted(self, quaternion: Sequence[Number]) -> tuple[list[int], int]:
        integers, shared = over_common_denominator(quaternion)
        if self._before is not None:
            integers, shared = list(hamilton(self._before[0], integers)), shared * self._before[1]
        if self._after is not None:
            integers, shared = list(hamilton(integers, self._after[0])), shared * self._after[1]
        return integers, shared
