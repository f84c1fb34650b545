"""Rotation driven and damped about one axis, at any time, in closed form: C dw/dt = N - c w.

About a principal axis that nothing else disturbs this is the whole motion. In a symmetric body that also turns across
its axis, the transverse angular velocity follows by a turn through ``(C - A)/A`` of the angle about the axis, and
decays by its own damping. Its attitude then takes parabolic cylinder functions of complex order (the equation of a
two-level system swept linearly: Zener, Proc. R. Soc. A 137 (1932) 696). No one series of them holds in double
precision for all orders and times: mpmath takes 0.4 ms to 3 s for a value, while Taylor steps follow 20 s of such a
motion to 6e-16 in 70 us. The attitude is left to them.

With no damping, angles are carried in turns as double-doubles: errors of the attitude stay at a few 1e-16 however many
turns have passed. With damping, so is the steady part ``N t/c`` once the transient is over.

Proof: ``derivations/driven_rotation.md``.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot import number
from symrot.closed_form.library import Floats, times_of
from symrot.closed_form.pairs import Number, numbers, pair
from symrot.errors import InputError

__all__ = ["AxialMotion", "motion"]

_SPLITTER = 134217729.0  # 2^27 + 1
_TERMS = 24  # of the series of (exp(x) - 1 - x)/x^2 for |x| <= 1


def _two_product(a: Floats, b: float | Floats) -> tuple[Floats, Floats]:
    """Return a*b and its rounding error (Dekker 1971)."""
    product = a * b
    wide_a, wide_b = _SPLITTER * a, _SPLITTER * np.asarray(b)
    high_a, high_b = wide_a - (wide_a - a), wide_b - (wide_b - b)
    low_a, low_b = a - high_a, b - high_b
    return product, ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b


def _turns(rate: tuple[float, float], t: Floats, t_error: Floats | None = None) -> Floats:
    """Return rate*(t + t_error) less whole turns, for a rate in turns as a double-double."""
    high, low = rate
    product, error = _two_product(t, high)
    error = error + t * low + (0.0 if t_error is None else t_error * high)
    return (product - np.rint(product)) + (error - np.rint(error))


def _first(x: Floats) -> Floats:
    """Return (exp(x) - 1)/x."""
    return np.divide(np.expm1(x), x, out=np.ones_like(x), where=x != 0.0)


def _second(x: Floats) -> Floats:
    """Return (exp(x) - 1 - x)/x^2."""
    if (np.abs(x) > 1.0).all():
        found: Floats = (np.expm1(x) - x) / (x * x)
        return found
    small = np.clip(x, -1.0, 1.0)
    series = np.zeros_like(x)
    for n in range(_TERMS, 1, -1):
        series = (1.0 + series * small) / n
    large = np.where(np.abs(x) > 1.0, x, 1.0)
    return np.where(np.abs(x) > 1.0, (np.expm1(large) - large) / (large * large), series)


class AxialMotion:
    """One motion. Times are counted from that of the initial state."""

    def __init__(
        self,
        axis: int,
        axial: tuple[Fraction, Fraction, Fraction],
        rates: list[Fraction],
        across: tuple[Fraction, Fraction],
        attitude: Floats,
    ) -> None:
        self._axis, (self._rate, self._push, self._decay) = axis, axial
        self._across = rates[(axis + 1) % 3], rates[(axis + 2) % 3]
        self._lag, self._decay_across = across
        self._attitude = attitude
        vector, unit = attitude[1:], np.eye(3)[axis]
        self._turned = np.concatenate([[-vector @ unit], attitude[0] * unit + np.cross(vector, unit)])
        self._known: dict[Fraction, tuple[Any, ...]] = {}

    @property
    def has_attitude(self) -> bool:
        """Whether the attitude is known in closed form: nothing turns across the axis."""
        return not any(self._across)

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity and attitude at any times; as :meth:`.ExactMotion.evaluate`.

        Raises
        ------
        InputError
            If a time is not finite, or the attitude is asked for and :attr:`has_attitude` is false.
        """
        times = times_of(t)
        if quaternion and not self.has_attitude:
            raise InputError(
                "the attitude of a body driven about its axis has no closed form here while it turns across it too"
            )
        return (self._rates(times) if omega else None), (self._quaternions(times) if quaternion else None)

    def _angle(self, t: Floats, share: Fraction) -> tuple[Floats, Floats]:
        """Return sine and cosine of so many times the angle turned about the axis."""
        known = self._known.get(share)
        if known is None:
            known = self._known[share] = self._constants(share / (2 * number.PI))
        if not self._decay:
            square, error = _two_product(t, t)
            part = _turns(known[0], t) + _turns(known[1], square, error)
        else:
            rate, push, final, rest, decay = known
            x = -decay * t
            first = _first(x)
            near = rate * t * first + push * t * t * _second(x)
            far = _turns(final, t) + rest * t * first
            part = np.where(np.abs(x) <= 1.0, near, far)
        part = 2.0 * np.pi * (part - np.rint(part))
        return np.sin(part), np.cos(part)

    def _constants(self, turn: Fraction) -> tuple[Any, ...]:
        """Return what the angle is made of, for angles of ``1/turn``, rounded once from exact numbers."""
        if not self._decay:
            return pair(self._rate * turn), pair(self._push * turn / 2)
        final = self._push / self._decay
        rest, parts = (self._rate - final) * turn, (self._rate * turn, self._push * turn)
        return *map(float, parts), pair(final * turn), float(rest), float(self._decay)

    def _rates(self, t: Floats) -> Floats:
        rates = np.empty((len(t), 3))
        x = -float(self._decay) * t
        rates[:, self._axis] = float(self._rate) * np.exp(x) + float(self._push) * t * _first(x)
        left = np.exp(-float(self._decay_across) * t)
        first, second = (float(w) * left for w in self._across)
        sine, cosine = self._angle(t, self._lag) if any(self._across) else (0.0, 1.0)
        rates[:, (self._axis + 1) % 3] = first * cosine - second * sine
        rates[:, (self._axis + 2) % 3] = first * sine + second * cosine
        return rates

    def _quaternions(self, t: Floats) -> Floats:
        sine, cosine = self._angle(t, Fraction(1, 2))
        return np.outer(cosine, self._attitude) + np.outer(sine, self._turned)


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
    torque : number
        N m, about the axis, fixed in the body.
    omega0 : 3 numbers
        rad/s; across the axis only where the body is symmetric about it.
    quaternion0 : 4 numbers
        Body to space, scalar first.
    damping : number
        N m s, of the torque ``-damping*omega`` about the axis.
    damping_across : number
        N m s, the same about every axis across it.

    Raises
    ------
    InputError
        If the body turns across the axis and is not symmetric about it, or a number is not of this domain.
    """
    moments = [Fraction(x) for x in numbers("inertia", inertia, 3)]
    rates = [Fraction(x) for x in numbers("omega", omega0, 3)]
    attitude = [Fraction(x) for x in numbers("quaternion", quaternion0, 4)]
    push, drag, slowing = (Fraction(x) for x in numbers("torque and damping", [torque, damping, damping_across], 3))
    square = sum((x * x for x in attitude), Fraction(0))
    if axis not in (0, 1, 2) or min(moments) <= 0 or not square:
        raise InputError(
            f"expected an axis 0, 1 or 2, positive moments and a quaternion that is not zero, got axis {axis}, moments "
            f"{[float(x) for x in moments]} kg m^2 and quaternion {[float(x) for x in attitude]}"
        )
    across, other, own = moments[axis - 2], moments[axis - 1], moments[axis]
    if (rates[axis - 2] or rates[axis - 1]) and not number.equal(across, other):
        raise InputError(
            "a body that turns across the driven axis must be symmetric about it, got moments "
            f"{[float(x) for x in moments]} kg m^2 and omega {[float(x) for x in rates]} rad/s"
        )
    norm = number.sqrt(square)
    unit = np.array([float(x / norm) for x in attitude])
    turning = (own - across) / across, slowing / across
    return AxialMotion(axis, (rates[axis], push / own, drag / own), rates, turning, unit)
