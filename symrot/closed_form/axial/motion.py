"""Rotation driven and damped about one axis, at any time, in closed form: C dw/dt = N - c w.

C is the moment of inertia about the axis, w the angular velocity, N the torque and c the damping coefficient. The
angular velocity of a symmetric body may also have a part normal to the axis, the transverse angular velocity. Compiled
C functions compute the samples if there is a compiler, otherwise NumPy and Python's integers.

Proof: ``derivations/driven_rotation.md``.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from symrot.closed_form.arithmetic.double_double import two_product
from symrot.closed_form.arithmetic.pairs import LARGEST, SMALLEST, Number, numbers, pair
from symrot.closed_form.axial import compiled as axial_compiled
from symrot.closed_form.axial.angle import Turning, exp_and_expm1
from symrot.closed_form.build import Floats, available, times_of
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.scene.tables import Initial

__all__ = ["AxialMotion", "Driven", "motion", "starts", "turned_about"]


class AxialMotion:
    """The motion of one body driven and damped about one axis, from one initial state.

    Times, s, are counted from this state.
    """

    regime = "steady"  # elementary functions only, see symrot.closed_form.motion.REGIMES

    def __init__(self, body: "Driven", rates: list[Fraction], attitude: tuple[list[float], list[float]]) -> None:
        self._axis, self._rate, (self._push, self._decay) = body.axis, rates[body.axis], body.driven
        self._across = rates[(self._axis + 1) % 3], rates[(self._axis + 2) % 3]
        self._lag, self._decay_across = body.turning
        self._attitude, self._turned = attitude
        self._known: dict[Fraction, Turning] = {}
        self._first = body.constants.first
        self._loops = body.constants(rates, attitude) if available("axial") else None

    @property
    def has_attitude(self) -> bool:
        """Whether the attitude can be computed: only if the angular velocity stays parallel to the driven axis."""
        # otherwise the attitude needs parabolic cylinder functions (symrot.closed_form.spin_up.motion); with damping it
        # has no closed form
        return not any(self._across)

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity (n, 3) and attitude (n, 4) at any times; see :meth:`.ExactMotion.evaluate`.

        Raises
        ------
        InputError
            If a time is not finite, if the damped angular velocity at a time exceeds the range of a double, or if the
            attitude is requested although :attr:`has_attitude` is false.
        """
        if quaternion and not self.has_attitude:
            raise InputError(
                "quaternion: expected False, got True: this closed form has no attitude, because the angular velocity "
                "is not parallel to the driven axis; use symrot.closed_form.spin_up.motion, or numerical integration "
                "if there is damping"
            )
        times = times_of(t)
        if self._loops is None:
            if (times < self._first).any():
                self._refuse(times)
            return (self._rates(times) if omega else None), (self._quaternions(times) if quaternion else None)
        rates = np.empty((len(times), 3)) if omega else None
        attitudes = np.empty((len(times), 4)) if quaternion else None
        status = self._loops(times, rates, attitudes)
        if status == axial_compiled.OUT_OF_RANGE:
            self._refuse(times)
        # more than 1e10 revolutions during the transient or 1e30 revolutions in all
        if status == axial_compiled.TOO_MANY_TURNS:
            for values, way in ((rates, self._rates), (attitudes, self._quaternions)):
                if values is not None and (lost := np.isnan(values).any(axis=1)).any():
                    values[lost] = way(times[lost])
        return rates, attitudes

    def _refuse(self, times: Floats) -> NoReturn:
        raise InputError(
            f"t: expected times after {self._first!r} s, before which the damped angular velocity exceeded the range "
            f"of doubles, got {float(times.min())!r} s"
        )

    def _angle(self, t: Floats, share: Fraction) -> tuple[Floats, Floats]:
        """Return sine and cosine of ``share`` times the angle of rotation about the driven axis, at the times ``t``."""
        # half the angle gives the attitude, (C - A)/A times it the rotation of the transverse angular velocity
        turning = self._known.get(share)
        if turning is None:
            turning = self._known[share] = Turning(share, self._rate, self._push, self._decay)
        part = 2.0 * np.pi * turning(t)
        return np.sin(part), np.cos(part)

    def _rates(self, t: Floats) -> Floats:
        rates = np.zeros((len(t), 3))
        rates[:, self._axis] = self._axial(t)
        if not any(self._across):
            return rates
        # the transverse angular velocity rotates in the body and decays by its own damping
        left = np.exp(-float(self._decay_across) * t)
        first, second = (float(w) * left for w in self._across)
        sine, cosine = self._angle(t, self._lag)
        rates[:, (self._axis + 1) % 3] = first * cosine - second * sine
        rates[:, (self._axis + 2) % 3] = first * sine + second * cosine
        return rates

    def _axial(self, t: Floats) -> Floats:
        """Return the angular velocity about the driven axis, rad/s, at the times ``t``, s."""
        rate, push, (high, low) = float(self._rate), float(self._push), pair(-self._decay)
        spin: Floats = rate + push * t
        if not high:
            return spin
        x, error = two_product(t, high)
        left, lost = exp_and_expm1(x, error + t * low)
        spin = rate * left + push * (lost / high)
        early = x > 1.0
        if early.any():  # here the difference of rate and push would lose most digits
            final = self._push / self._decay
            spin[early] = float(final) + float(self._rate - final) * left[early]
        return spin

    def _quaternions(self, t: Floats) -> Floats:
        sine, cosine = self._angle(t, Fraction(1, 2))
        attitudes: Floats = cosine[:, None] * np.array(self._attitude) + sine[:, None] * np.array(self._turned)
        return attitudes


def motion(
    inertia: Sequence[Number],
    axis: int,
    torque: Number,
    omega0: Sequence[Number],
    quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0),
    damping: Number = 0.0,
    damping_across: Number = 0.0,
) -> AxialMotion:
    """Return the motion of a body under a constant torque and linear damping about one principal axis.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments, kg m^2, positive.
    axis : 0, 1 or 2
        Index of the principal axis about which the torque acts.
    torque : number
        Torque about the axis, N m, fixed in the body.
    omega0 : 3 numbers
        Angular velocity, rad/s, parallel to the driven axis unless the body is symmetric about this axis.
    quaternion0 : 4 numbers
        Attitude, body to space, scalar first.
    damping : number
        Coefficient of the torque ``-damping*omega`` about the axis, N m s.
    damping_across : number
        Coefficient of damping about the two axes normal to the driven axis, N m s.

    Raises
    ------
    InputError
        If the angular velocity is not parallel to the axis and the body is not symmetric about the axis, or if a
        number is outside its domain.
    """
    return Driven(inertia, axis, torque, damping, damping_across).motion(omega0, quaternion0)


def starts(
    inertia: Sequence[Number], axis: int, torque: Number, damping: Number = 0.0, damping_across: Number = 0.0
) -> Callable[[Initial], AxialMotion]:
    """Return a function from an initial state to the motion of one driven body.

    The arguments are those of :func:`motion`.
    """
    body = Driven(inertia, axis, torque, damping, damping_across)  # constants of all initial states
    return lambda start: body.moving(start.omega_b, [float(x) for x in start.quaternion])


class Driven:
    """A body driven about one axis, with the exact constants that its motions from all initial states share."""

    def __init__(
        self, inertia: Sequence[Number], axis: int, torque: Number, damping: Number, damping_across: Number
    ) -> None:
        self._moments = moments = [Fraction(x) for x in numbers("inertia", inertia, 3, SMALLEST)]
        coefficients = numbers("torque and damping", [torque, damping, damping_across], 3)
        push, drag, slowing = (Fraction(x) for x in coefficients)
        if not isinstance(axis, int) or axis not in (0, 1, 2):
            raise InputError(f"expected an axis 0, 1 or 2, got {number.show(axis)}")
        self.axis = axis
        across, other, own = moments[axis - 2], moments[axis - 1], moments[axis]
        self._symmetric = number.equal(across, other)
        self.turning = (own - across) / across, slowing / across
        self.driven = push / own, drag / own
        if max(map(abs, (*self.driven, *self.turning))) > LARGEST:
            raise InputError(
                f"expected torque and damping of at most {LARGEST:g} times the moments of inertia, got moments "
                f"{[float(x) for x in moments]} kg m^2, torque {float(push)!r} N m, damping {float(drag)!r} N m s "
                f"about the driven axis and {float(slowing)!r} N m s about the other axes"
            )
        driving = [x.as_integer_ratio() for x in (push, drag, slowing)]
        self.constants = axial_compiled.Constants(axis, (across.as_integer_ratio(), own.as_integer_ratio()), *driving)

    def motion(self, omega0: Sequence[Number], quaternion0: Sequence[Number]) -> AxialMotion:
        """Return the motion from an initial state: ``omega0``, rad/s, and ``quaternion0``, body to space."""
        axis, rates = self.axis, [Fraction(x) for x in numbers("omega", omega0, 3)]
        components = numbers("quaternion", quaternion0, 4)
        if not any(components):
            raise InputError(f"expected a quaternion that is not zero, got {list(quaternion0)}")
        if (rates[axis - 2] or rates[axis - 1]) and not self._symmetric:
            raise InputError(
                "expected a body that rotates only about the driven axis or is symmetric about this axis, got moments "
                f"{[float(x) for x in self._moments]} kg m^2 and omega {[float(x) for x in rates]} rad/s"
            )
        return self._moving(rates, [float(x) for x in number.unit(components)])

    def moving(self, rates: Sequence[Number], attitude: list[float]) -> AxialMotion:
        """Return the motion from an initial angular velocity, rad/s, and a unit quaternion.

        Unlike :meth:`motion`, it does not check or normalise the quaternion.
        """
        return self._moving([Fraction(x) for x in numbers("omega", rates, 3)], attitude)

    def _moving(self, rates: list[Fraction], attitude: list[float]) -> AxialMotion:
        return AxialMotion(self, rates, (attitude, turned_about(self.axis, attitude)))


def turned_about(axis: int, q: Sequence[Any]) -> list[Any]:
    """Return the attitude ``q`` after half a turn about the body axis ``axis`` (0, 1 or 2), as a quaternion."""
    product: list[Any] = [None] * 4
    product[0], product[axis + 1] = -q[axis + 1], q[0]
    product[(axis + 1) % 3 + 1], product[(axis + 2) % 3 + 1] = q[(axis + 2) % 3 + 1], -q[(axis + 1) % 3 + 1]
    return product
