"""A symmetric body under a constant torque about its axis, at any time, in closed form: spin up, down, and through.

The transverse angular velocity keeps its length W and turns in the body by a phase quadratic in time. In axes that turn
with it the body turns at ``(W, 0, Omega)``, with Omega linear in time: the equation of a two-level system swept through
resonance (Zener, Proc. R. Soc. A 137 (1932) 696), solved by parabolic cylinder functions of ``x = Omega/sqrt(s)``, s
the sweep, and of the one parameter ``kappa = W/sqrt(s)``. Far from resonance, or for a large kappa, their asymptotic
series hold to the last bit, in the form of a slowly turning vector and the phase about it; near it Taylor's series at
40 places. Phases are carried in turns, as pairs of doubles: errors of the attitude stay at a few 1e-16 however many
turns have passed. A sample costs the same at any time; those beyond 1e13 rad take integers.

The formulas are in :file:`spin_up.h`. Proof: ``derivations/driven_rotation.md``.
"""

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from symrot import number
from symrot.closed_form import frames, spin_up_compiled
from symrot.closed_form.library import Floats, times_of
from symrot.closed_form.pairs import Number, numbers, pair
from symrot.closed_form.spin_up_compiled import CompiledNear
from symrot.closed_form.spin_up_exact import ONE, Quaternion, Sweep, about_third, conjugate, fixed, product, rounded
from symrot.closed_form.spin_up_near import Near
from symrot.closed_form.spin_up_series import NEAR, series
from symrot.errors import InputError

__all__ = ["SpinUp", "motion"]

_DOUBT = 1e-14  # of a place: nearer to the edge of a side than this, it could be on either

_MOST = Fraction(10) ** 300

_PHASE = 1e13  # rad, from here on pairs of doubles would not do


def _scale(*values: Fraction) -> Fraction:
    """Return a power of two near the largest of some numbers, of which one is not zero."""
    largest = max(map(abs, values))
    size = largest.numerator.bit_length() - largest.denominator.bit_length()
    return Fraction(2) ** max(-900, min(900, size))


def _map(left: Quaternion, right: Quaternion) -> list[float]:
    """Return the matrix of q -> left q right, row by row."""
    units = ((ONE[0] if i == k else 0 for i in range(4)) for k in range(4))
    columns = [product(left, (a, b, c, d), right) for a, b, c, d in units]
    return [column[i] / ONE[0] for i in range(4) for column in columns]


class SpinUp:
    """One motion. Times are counted from that of the initial state.

    Parameters
    ----------
    moments : 2 Fractions
        A across the axis and C about it, kg m^2.
    axis : 0, 1 or 2
    torque : Fraction
        N m, about the axis.
    rates : 3 Fractions
        Angular velocity at the start, rad/s, not all along the axis.
    attitude : 4 Fractions
        At the start, not zero.
    """

    regime = "circular"

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
        kappa2, inverse = (float(min(x / y, _MOST)) if y else math.inf for x, y in ((width**2, s), (s, width**2)))
        self._sweep = Sweep(rounded(width / scale), rounded(s / scale**2), series(kappa2, inverse))
        self._edge = Fraction(0) if self._sweep.series.wide else rounded(Fraction(NEAR) * self._root / scale)
        self._axes = self._body_axes(axis, sign, first / width, second / width)
        self._given = product(fixed(frames.unit(attitude)), self._axes)
        self._rates = [[0.0, 0.0] for _ in range(3)]
        self._rates[axis - 2] = [float(first), -sign * float(second)]
        self._rates[axis - 1] = [float(second), sign * float(first)]
        self._axial = [float(k == axis) for k in range(3)]
        self._spin = rates[axis], rounded(torque / own / scale)
        self._kinds: dict[bool, Callable[..., None]] = {}

    @staticmethod
    def _body_axes(axis: int, sign: int, first: Fraction, second: Fraction) -> Quaternion:
        """Return the turn from e1, e2, e3 to the body's axes: e3 along the torque, e1 along what turns across it."""
        columns = [[Fraction(0)] * 3 for _ in range(3)]
        columns[0][axis - 2], columns[0][axis - 1] = first, second
        columns[1][axis - 2], columns[1][axis - 1] = -sign * second, sign * first
        columns[2][axis] = Fraction(sign)
        return fixed(frames.quaternion_of([list(row) for row in zip(*columns, strict=True)]))

    @cached_property
    def _near(self) -> Near | CompiledNear:
        near = CompiledNear if spin_up_compiled.available() else Near
        return near(rounded(self._sweep.across * self._scale / self._root))

    def _side(self, omega: Fraction) -> int:
        """Return on which side of resonance a place is: -1, 1, or 0 near it."""
        if self._sweep.series.wide:
            return 1
        return 0 if abs(omega) < self._edge else 1 if omega > 0 else -1

    def _x(self, omega: Fraction) -> Fraction:
        return rounded(omega * self._scale / self._root)

    @cached_property
    def _resonance(self) -> Quaternion:
        """Return the rotation of the body from the start to Omega = 0, seen from it."""
        side, sweep = self._side(self._start), self._sweep
        if not side:
            return conjugate(self._near.quaternion(self._x(self._start)))
        edge = side * self._edge
        leaving = sweep.rotation(self._start, rounded((edge - self._start) / sweep.s))
        return product(leaving, conjugate(self._near.quaternion(Fraction(side * int(NEAR)))))

    def _begin(self, side: int) -> tuple[Fraction, Fraction, Quaternion]:
        """Return from where a side is counted: the time, Omega, and the rotation of the body until then."""
        if self._side(self._start) == side:
            return Fraction(0), self._start, ONE
        edge, crossed = side * self._edge, self._near.quaternion(Fraction(side * int(NEAR)))
        return rounded((edge - self._start) / self._sweep.s), edge, product(self._resonance, crossed)

    def _constants(self, near: bool) -> list[float]:
        """Return what C takes; without what only samples near resonance or beyond it need, or with it."""
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
            if not near and self._side(self._start) not in (side, 1 if wide else side):
                values += [0.0] * 21
                continue
            time, omega, rotation = self._begin(1 if wide else side)
            values += [*pair(time), *pair(omega), sweep.delta(omega)]
            values += _map(product(self._given, rotation, sweep.axes(omega)), back)
        return values + (_map(product(self._given, self._resonance), back) if near else [0.0] * 16)

    def _fill(self, near: bool) -> Callable[..., None]:
        """Return the loops over samples."""
        if near not in self._kinds:
            table = self._near.table() if near else None
            if spin_up_compiled.available():
                self._kinds[near] = spin_up_compiled.loops(self._constants(near), table)
            else:
                from symrot.closed_form.portable.spin_up import SpinUp as Portable

                self._kinds[near] = Portable(self._constants(near), table).evaluate
        return self._kinds[near]

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity and attitude at any times; as :meth:`.ExactMotion.evaluate`."""
        times = times_of(t)
        rates = np.empty((len(times), 3)) if omega else None
        attitudes = np.empty((len(times), 4)) if quaternion else None
        if not len(times):
            return rates, attitudes
        first, last = min(0.0, float(times.min())), max(0.0, float(times.max()))
        self._fill(quaternion and not self._far(first, last))(times, rates, attitudes)
        if not self._phase(max(last, -first)) <= _PHASE:  # NaN: more than doubles hold
            self._check(first, last)
            for i, time in enumerate(times.tolist()):
                if not self._phase(abs(time)) <= _PHASE:
                    self._put(i, time, rates, attitudes)
        return rates, attitudes

    def _far(self, first: float, last: float) -> bool:
        """Return whether all times between two are surely on one side of resonance, however doubles round."""
        start, s, scale = float(self._start), float(self._sweep.s), float(self._scale)
        ends, edge = (start + s * first * scale, start + s * last * scale), float(self._edge)
        edge += _DOUBT * (edge + max(map(abs, (start, *ends))))
        return self._sweep.series.wide or ends[1] <= -edge or ends[0] >= edge

    def _phase(self, time: float) -> float:
        """Return more rad than either phase of a motion has at a time."""
        first, second = map(float, self._turn)
        sweep = abs(float(self._start)) + float(self._sweep.across) + abs(first)
        scaled = time * float(self._scale)
        return scaled * (sweep + (float(self._sweep.s) + abs(second)) * scaled)

    def _check(self, first: float, last: float) -> None:
        """Refuse times at which the angular velocity would be no double."""
        for time in (first, last):
            if abs(self._spin[0] + self._spin[1] * Fraction(time) * self._scale) >= number.LARGEST:
                raise InputError(f"expected times at which the angular velocity is a finite number, got {time:.6g} s")

    def _put(self, i: int, time: float, rates: Floats | None, attitudes: Floats | None) -> None:
        """Write one sample by integers."""
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
        found = product(self._given, turned, about_third(-angle), conjugate(self._axes))
        attitudes[i] = [x / ONE[0] for x in found]


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
        Principal moments, kg m^2, positive; the two across the axis are equal.
    axis : 0, 1 or 2
    torque : number
        N m, about the axis, fixed in the body.
    omega0, quaternion0 : 3 and 4 numbers
        Angular velocity along the principal axes, rad/s, not all along the axis; attitude, body to space, scalar first.

    Raises
    ------
    InputError
        If the body is not symmetric about the axis, turns about it alone, or a number is not of this domain.
    """
    moments = [Fraction(x) for x in numbers("inertia", inertia, 3)]
    rates = [Fraction(x) for x in numbers("omega", omega0, 3)]
    attitude = [Fraction(x) for x in numbers("quaternion", quaternion0, 4)]
    push = Fraction(numbers("torque", [torque], 1)[0])
    if axis not in (0, 1, 2) or min(moments) <= 0 or not any(attitude):
        raise InputError(
            f"expected an axis 0, 1 or 2, positive moments and a quaternion that is not zero, got axis {axis}, moments "
            f"{[float(x) for x in moments]} kg m^2 and quaternion {[float(x) for x in attitude]}"
        )
    across, other = moments[axis - 2], moments[axis - 1]
    if not number.equal(across, other) or not (rates[axis - 2] or rates[axis - 1]):
        raise InputError(
            "expected a body that is symmetric about the driven axis and turns across it too, got moments "
            f"{[float(x) for x in moments]} kg m^2 and omega {[float(x) for x in rates]} rad/s"
        )
    return SpinUp((across, moments[axis]), axis, push, rates, attitude)
