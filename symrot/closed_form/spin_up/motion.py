"""A symmetric body under a constant torque about its axis, at any time, in closed form.

The transverse angular velocity, normal to the axis, has the constant length W. The rotating axes are axes that rotate
with it: the first one points along the transverse angular velocity, the third one along the torque. The components of
their angular velocity along these axes are ``(W, 0, Omega)``. The axial rate is ``Omega = (C/A) w3``: w3 is the body's
rate about its axis, and C and A are the moments of inertia about this axis and about an axis normal to it. Omega grows
at the constant rate s (the sweep rate). The time at which w3 and Omega are zero is called resonance. The components of
the attitude of the rotating axes are parabolic cylinder functions of the scaled time ``x = Omega/sqrt(s)`` with the
parameter ``kappa = W/sqrt(s)``. They are computed by asymptotic series far from resonance and by Taylor series near it.

The formulas are in :file:`spin_up.h`. Source: Zener, Proc. R. Soc. A 137 (1932) 696, who solves the same equation for a
quantum system with two states. Proof: ``derivations/driven_rotation.md``.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from symrot.closed_form.arithmetic.pairs import SMALLEST, Number, flatten_pairs, numbers, same
from symrot.closed_form.arithmetic.pairs import attitude as pairs_of
from symrot.closed_form.build import Floats, available, times_of
from symrot.closed_form.spin_up.compiled import Compiled
from symrot.errors import InputError
from symrot.formula.exact_numbers import show
from symrot.scene.tables import Initial

if TYPE_CHECKING:
    from symrot.closed_form.spin_up.integers import Integers

__all__ = ["SpinUp", "SpunBody", "motion", "starts"]


class SpinUp:
    """The motion of a symmetric body driven about its axis. Times, s, are counted from the initial state.

    Parameters
    ----------
    body : SpunBody
        The body and its torque.
    rates : 3 numbers
        Angular velocity at the start, rad/s, not parallel to the axis.
    attitude : 4 numbers
        Quaternion of the attitude at the start, of any norm except zero.
    """

    regime = "circular"

    def __init__(self, body: "SpunBody", rates: Sequence[Number], attitude: Sequence[Number]) -> None:
        self._initial_state, axis = (body, rates, attitude), body.axis
        turned = rates[axis - 2], rates[axis - 1], rates[axis]
        self._source = (
            Compiled(axis, [*body.shared, *flatten_pairs(turned), *pairs_of(attitude)])
            if available("spin_up")
            else self.integers
        )

    @cached_property
    def integers(self) -> "Integers":
        """The same motion in integer arithmetic, for angles above 1e13 rad, or if there is no C compiler."""
        from symrot.closed_form.spin_up.integers import Integers

        body, rates, attitude = self._initial_state
        across, own = body.moments
        exact = [Fraction(x) for x in rates], [Fraction(x) for x in attitude]
        return Integers((Fraction(across), Fraction(own)), body.axis, Fraction(body.torque), *exact)

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity (n, 3) and attitude (n, 4) at any times; see :meth:`.ExactMotion.evaluate`.

        Raises
        ------
        InputError
            If a time is not finite, or if the angular velocity at a time exceeds the range of doubles.
        """
        times = times_of(t)
        rates = np.empty((len(times), 3)) if omega else None
        attitudes = np.empty((len(times), 4)) if quaternion else None
        if len(times) and self._source.fill(times, rates, attitudes):
            self._by_integers(times, rates, attitudes)
        return rates, attitudes

    def _by_integers(self, times: Floats, rates: Floats | None, attitudes: Floats | None) -> None:
        """Overwrite the rows of ``rates`` and ``attitudes`` at times with too many revolutions for sums of two doubles.

        Their samples are computed in integers; an array that is None is skipped. InputError is raised if the angular
        velocity at the first or the last of all times exceeds the range of doubles.
        """
        for time in (float(times.min()), float(times.max())):
            if not self.integers.finite(time):
                raise InputError(f"expected times at which the angular velocity is a finite number, got {time!r} s")
        for i, time in enumerate(times.tolist()):
            if abs(time) > self._source.longest:
                self.integers.put(i, time, rates, attitudes)


def motion(
    inertia: Sequence[Number],
    axis: int,
    torque: Number,
    omega0: Sequence[Number],
    quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0),
) -> SpinUp:
    """Return the motion of a symmetric body under a constant torque about its axis.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments of inertia, kg m^2, positive; those about the two axes normal to the driven axis are equal.
    axis : 0, 1 or 2
        Index of the principal axis about which the torque acts.
    torque : number
        Torque about the axis, N m, fixed in the body.
    omega0, quaternion0 : 3 and 4 numbers
        Angular velocity along the principal axes, rad/s, not parallel to the axis; attitude, body to space, scalar
        first.

    Raises
    ------
    InputError
        If the body is not symmetric about the axis or rotates only about it, or if a number is outside its domain.
    """
    return SpunBody(inertia, axis, torque).motion(omega0, quaternion0)


def starts(inertia: Sequence[Number], axis: int, torque: Number) -> Callable[[Initial], SpinUp]:
    """Return a function from an initial state to the motion of one driven body.

    ``inertia`` are the principal moments, kg m^2; ``torque``, N m, acts about the principal axis with the index
    ``axis``.
    """
    body = SpunBody(inertia, axis, torque)
    return lambda start: body.motion(start.omega_b, start.quaternion)


class SpunBody:
    """A symmetric body and the torque about its axis, with the constants that all its motions share."""

    def __init__(self, inertia: Sequence[Number], axis: int, torque: Number) -> None:
        self._inertia, (self.torque,) = numbers("inertia", inertia, 3, SMALLEST), numbers("torque", [torque], 1)
        if not isinstance(axis, int) or axis not in (0, 1, 2):
            raise InputError(f"expected an axis 0, 1 or 2, got {show(axis)}")
        self.axis, self.moments = axis, (self._inertia[axis - 2], self._inertia[axis])
        self._symmetric = same(self._inertia[axis - 2], self._inertia[axis - 1])
        self.shared = flatten_pairs([*self.moments, self.torque])

    def motion(self, omega0: Sequence[Number], quaternion0: Sequence[Number]) -> SpinUp:
        """Return the motion from an initial state: ``omega0``, rad/s, and ``quaternion0``, body to space."""
        axis, rates, attitude = self.axis, numbers("omega", omega0, 3), numbers("quaternion", quaternion0, 4)
        if not any(attitude):
            raise InputError(f"expected a quaternion that is not zero, got {[float(x) for x in attitude]}")
        if not self._symmetric or not (rates[axis - 2] or rates[axis - 1]):
            raise InputError(
                "expected a body that is symmetric about the driven axis and also rotates about an axis perpendicular "
                f"to it, got moments {[float(x) for x in self._inertia]} kg m^2 and omega {[float(x) for x in rates]} "
                "rad/s"
            )
        return SpinUp(self, rates, attitude)
