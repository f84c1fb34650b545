"""A symmetric body under a constant torque about its axis, in integer arithmetic, for any number of revolutions.

The body's attitude follows from that of the rotating axes: axes that rotate with the transverse angular velocity. Their
rate about the body's axis, the axial rate Omega, is zero at resonance (see :mod:`symrot.closed_form.spin_up.motion`).
Their attitude is a product of rotations far before, near and far after resonance. The module computes the samples with
too many revolutions for double-double numbers. Where there is no C compiler, it also computes the constants of each
motion, from which NumPy computes all other samples (:mod:`symrot.closed_form.portable.spin_up`).

The formulas are in :file:`spin_up.h`. Proof: ``derivations/driven_rotation.md``.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property

import numpy as np

from symrot.closed_form.arithmetic import frames
from symrot.closed_form.arithmetic.pairs import pair
from symrot.closed_form.build import Floats
from symrot.closed_form.portable.spin_up import PortableSpinUp as Portable
from symrot.closed_form.spin_up.off_resonance import (
    ONE,
    Quaternion,
    Sweep,
    about_third,
    fixed,
    product,
)
from symrot.closed_form.spin_up.resonance import Near
from symrot.closed_form.spin_up.series import MOST, NEAR, series
from symrot.formula import exact_numbers as number
from symrot.formula.exact_numbers import rounded
from symrot.kinematics.hamilton import conjugate

__all__ = ["Integers"]

_DOUBT = 1e-14  # relative distance from the boundary of resonance at which a time could lie on either side

_LARGEST = Fraction(10) ** 300


def _scale(*values: Fraction) -> Fraction:
    """Return a power of two between half and twice the largest absolute value of ``values``.

    It is at least 2^-900 and at most 2^900.
    """
    # the unit of angular velocities, so that scaled numbers are near 1
    largest = max(map(abs, values))
    size = largest.numerator.bit_length() - largest.denominator.bit_length()
    return Fraction(2) ** max(-900, min(900, size))


def _map(left: Quaternion, right: Quaternion) -> list[float]:
    """Return the entries, row by row, of the 4 x 4 matrix that maps a quaternion q to the product left*q*right."""
    units = ((ONE[0] if i == k else 0 for i in range(4)) for k in range(4))
    columns = [product(left, (a, b, c, d), right) for a, b, c, d in units]
    return [column[i] / ONE[0] for i in range(4) for column in columns]


class Integers:
    """The motion of a body driven about its axis, computed in integers. Times, s, are counted from the initial state.

    Parameters
    ----------
    moments : 2 Fractions
        Moments of inertia, kg m^2, about an axis normal to the symmetry axis and about the symmetry axis.
    axis : 0, 1 or 2
        Index of the body axis about which the torque acts.
    torque : Fraction
        Torque about the axis, N m.
    rates : 3 Fractions
        Angular velocity at the start, rad/s, not parallel to the axis.
    attitude : 4 Fractions
        Quaternion of the attitude at the start, of any norm except zero.
    """

    def __init__(
        self,
        moments: tuple[Fraction, Fraction],
        axis: int,
        torque: Fraction,
        rates: Sequence[Fraction],
        attitude: Sequence[Fraction],
    ) -> None:
        (across, own), sign = moments, -1 if torque < 0 else 1
        first, second = rates[axis - 2], rates[axis - 1]
        width = number.sqrt(first * first + second * second)
        s, start, lag = abs(torque) / across, sign * rates[axis] * own / across, (own - across) / across
        self._root = number.sqrt(s)
        scale = _scale(start, width, self._root)
        self._scale, self._start = scale, rounded(start / scale)
        self._turn = rounded(lag * sign * rates[axis] / scale), rounded(lag * abs(torque) / (2 * own * scale * scale))
        kappa2, inverse = (float(min(x / y, _LARGEST)) if y else math.inf for x, y in ((width**2, s), (s, width**2)))
        self._sweep = Sweep(rounded(width / scale), rounded(s / scale**2), series(kappa2, inverse))
        self._edge = Fraction(0) if self._sweep.series.wide else rounded(Fraction(NEAR) * self._root / scale)
        self._axes = self._body_axes(axis, sign, first / width, second / width)
        self._attitude = product(fixed(number.unit(attitude)), self._axes)
        self._rates = [[0.0, 0.0] for _ in range(3)]
        self._rates[axis - 2] = [float(first), -sign * float(second)]
        self._rates[axis - 1] = [float(second), sign * float(first)]
        self._axial = [float(k == axis) for k in range(3)]
        self._spin = rates[axis], rounded(torque / own / scale)
        self._kinds: dict[bool, Callable[..., None]] = {}

    @staticmethod
    def _body_axes(axis: int, sign: int, first: Fraction, second: Fraction) -> Quaternion:
        """Return the quaternion of the rotation from the axes e1, e2, e3 of the motion's formulas to those of the body.

        e3 points along the torque: along the body axis ``axis``, times ``sign``. e1 points along the transverse angular
        velocity at the start, with the components ``first`` and ``second`` along the next two body axes.
        """
        columns = [[Fraction(0)] * 3 for _ in range(3)]
        columns[0][axis - 2], columns[0][axis - 1] = first, second
        columns[1][axis - 2], columns[1][axis - 1] = -sign * second, sign * first
        columns[2][axis] = Fraction(sign)
        return fixed(frames.quaternion_of([list(row) for row in zip(*columns, strict=True)]))

    @cached_property
    def _near(self) -> Near:
        return Near(rounded(self._sweep.across * self._scale / self._root))

    def _side(self, omega: Fraction) -> int:
        """Return which formula gives the attitude at the axial rate ``omega`` (scaled), which is zero at resonance.

        1 or -1: the asymptotic series after or before resonance; 0: the Taylor series near resonance. The result is
        always 1 if the asymptotic series are accurate at every axial rate.
        """
        if self._sweep.series.wide:
            return 1
        return 0 if abs(omega) < self._edge else 1 if omega > 0 else -1

    def _x(self, omega: Fraction) -> Fraction:
        return rounded(omega * self._scale / self._root)

    @cached_property
    def _resonance(self) -> Quaternion:
        """The quaternion of the rotation of the rotating axes from the start of the motion to resonance (Omega = 0).

        The rotating axes rotate with the transverse angular velocity of the body. The components of the quaternion are
        integers in units of 2^-FIXED.
        """
        side, sweep = self._side(self._start), self._sweep
        if not side:
            return conjugate(self._near.quaternion(self._x(self._start)))
        edge = side * self._edge
        leaving = sweep.rotation(self._start, rounded((edge - self._start) / sweep.s))
        return product(leaving, conjugate(self._near.quaternion(Fraction(side * int(NEAR)))))

    def _begin(self, side: int) -> tuple[Fraction, Fraction, Quaternion]:
        """Return (time, Omega, rotation) where the asymptotic series before or after resonance begin to be used.

        ``side`` is -1 before resonance (axial rate Omega < 0) and 1 after it. Omega is the axial rate at this time. The
        rotation is the quaternion of the rotation of the rotating axes from the start of the motion to this time. For a
        motion that starts on this side of resonance, the result is 0, the initial axial rate, and the identity.
        """
        if self._side(self._start) == side:
            return Fraction(0), self._start, ONE
        # the motion starts elsewhere, so this part of it begins at the boundary of resonance
        edge, crossed = side * self._edge, self._near.quaternion(Fraction(side * int(NEAR)))
        return rounded((edge - self._start) / self._sweep.s), edge, product(self._resonance, crossed)

    def _constants(self, near: bool) -> list[float]:
        """Return the constants with which NumPy computes samples, in the order of the C struct in :file:`spin_up.h`.

        ``near`` says whether some samples lie near resonance (axial rate Omega = 0), or beyond it as seen from the
        start. If not, the constants that only these samples need are zero.
        """
        sweep, back, wide = self._sweep, conjugate(self._axes), self._sweep.series.wide
        turns = [x / (4 * number.PI) for x in self._turn]
        inverse = self._scale / self._root if near else Fraction(0)
        values = [float(self._scale), float(self._edge), float(wide)]
        for value in (*turns, self._start, sweep.s, sweep.across, inverse):
            values += pair(value)
        values.append(float(sweep.unit))
        for coefficients in (sweep.series.g, sweep.series.c, sweep.series.e):
            values += coefficients.tolist()
        values += [*(x for row in self._rates for x in row), *self._axial]
        for value in self._spin:
            values += pair(value)
        for side in (-1, 1):
            # all samples lie on the side of the start, so that the constants of the other parts are not needed
            if not near and self._side(self._start) not in (side, 1 if wide else side):
                values += [0.0] * 21
                continue
            time, omega, rotation = self._begin(1 if wide else side)
            values += [*pair(time), *pair(omega), sweep.delta(omega)]
            values += _map(product(self._attitude, rotation, sweep.axes(omega)), back)
        return values + (_map(product(self._attitude, self._resonance), back) if near else [0.0] * 16)

    @cached_property
    def longest(self) -> float:
        """The time, s, after which double-double numbers may have too few digits for the angle of rotation."""
        values = self._start, self._sweep.across, self._turn[0], self._sweep.s, self._turn[1]
        start, across, turn, s, growth = (abs(float(x)) for x in values)
        even = start + across + turn
        return 2.0 * MOST / (even + math.sqrt(even * even + 4.0 * (s + growth) * MOST)) / float(self._scale)

    def _far(self, first: float, last: float) -> bool:
        """Return whether one asymptotic series certainly gives the attitude at all times from ``first`` to ``last``.

        It does if kappa = W/sqrt(s) is WIDE or more (W the transverse angular velocity, s the rate at which the axial
        rate Omega grows), or if Omega is far from 0 (resonance) at all these times, always with the same sign.
        """
        start, s, scale = float(self._start), float(self._sweep.s), float(self._scale)
        ends, edge = (start + s * first * scale, start + s * last * scale), float(self._edge)
        edge += _DOUBT * (edge + max(map(abs, (start, *ends))))
        return self._sweep.series.wide or ends[1] <= -edge or ends[0] >= edge

    def fill(self, times: Floats, rates: Floats | None, attitudes: Floats | None) -> bool:
        """Write the samples at ``times``, s, computed by NumPy, into ``rates`` and ``attitudes``.

        An array that is None is skipped. Return whether some times exceed :attr:`longest`; the samples at these times
        are not valid.
        """
        first, last = min(0.0, float(times.min())), max(0.0, float(times.max()))
        near = attitudes is not None and not self._far(first, last)
        if near not in self._kinds:
            self._kinds[near] = Portable(self._constants(near), self._near.table() if near else None).evaluate
        self._kinds[near](times, rates, attitudes)
        return not max(last, -first) <= self.longest

    def finite(self, time: float) -> bool:
        """Return whether the angular velocity at ``time``, s, is within the range of doubles."""
        return abs(self._spin[0] + self._spin[1] * Fraction(time) * self._scale) < number.LARGEST

    def put(self, i: int, time: float, rates: Floats | None, attitudes: Floats | None) -> None:
        """Write the sample at ``time``, s, into row i of ``rates`` (n, 3) and ``attitudes`` (n, 4).

        An array that is None is skipped.
        """
        t = Fraction(time) * self._scale
        angle = self._turn[0] * t + self._turn[1] * t * t
        if rates is not None:
            circle = np.array([float(number.cos(angle)), float(number.sin(angle))])
            rates[i] = np.array(self._rates) @ circle + np.array(self._axial) * float(self._spin[0] + self._spin[1] * t)
        if attitudes is None:
            return
        omega = self._start + self._sweep.s * t
        side = self._side(omega)
        if side:
            begun, place, rotation = self._begin(side)
            turned = product(rotation, self._sweep.rotation(place, t - begun))
        else:
            turned = product(self._resonance, self._near.quaternion(self._x(omega)))
        attitude = product(self._attitude, turned, about_third(-angle), conjugate(self._axes))
        attitudes[i] = [x / ONE[0] for x in attitude]
