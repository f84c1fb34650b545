"""Rotation about one axis by the compiled loops of :file:`axial_at.c`, whose constants are computed in integers.

The angle of a driven body grows with the square of time, so its phase at 1e15 s needs constants of 212 bits. They are
computed in Python's integers; C receives each constant as a sum of several doubles. The transverse angular velocity is
the part of the angular velocity normal to the driven axis; in the body it rotates by an angle called lag.
"""

import ctypes
import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

from symrot.build.address import address
from symrot.closed_form.build import Floats, load
from symrot.errors import CompilerError, InputError
from symrot.formula import exact_numbers as number

__all__ = ["OUT_OF_RANGE", "TOO_MANY_TURNS", "Constants", "Loops", "Ratio", "functions", "parts"]

Ratio = tuple[int, int]
"""A rational number: numerator and positive denominator."""

TOO_MANY_TURNS, OUT_OF_RANGE = 1, 2
"""Return values of the compiled loops: a sample has too many revolutions; a number exceeds the range of doubles."""

_LARGEST = 200  # 2^200 replaces larger numbers: a product with it exceeds the revolutions that the loops can count
_BITS = 260  # more bits than a sum of four doubles represents
_WIDE, _WIDER, _PAIR = 3, 4, 2  # numbers of doubles whose sum is one constant
_TURNING = 14  # doubles in a struct `turning` of axial.h
_TURN_BITS = 340  # bits of the factor that converts radians to a multiple of the angle in revolutions
_EXPONENT = 700.0  # exp of a larger number may exceed the range of a double
_PI_TOP, _PI_BOTTOM = number.PI.as_integer_ratio()


def parts(top: int, bottom: int, count: int) -> list[float]:
    """Return ``count`` doubles, from the largest to the smallest, whose sum approximates the ratio top/bottom.

    If the absolute value of the ratio is 2^200 or more, they are 2^200 (or -2^200) and zeros.
    """
    sign, top = (-1, -top) if top < 0 else (1, top)
    size = top.bit_length() - bottom.bit_length()
    shift, doubles = _BITS - size, []
    left = (top << shift) // bottom if shift > 0 else top // (bottom << -shift)
    if left >> _BITS:  # one bit more, so that the result does not depend on whether the ratio is in lowest terms
        left, shift = left >> 1, shift - 1
    if shift < _BITS - _LARGEST:
        return [sign * 2.0**_LARGEST, *[0.0] * (count - 1)]
    left *= sign
    # each double is the rounded difference of the ratio and the sum of the previous doubles
    for _ in range(count):
        high = float(left)
        left -= int(high)
        doubles.append(math.ldexp(high, -shift))
    return doubles


class Loops(NamedTuple):
    """One motion of a body driven about one axis: its constants, and the compiled C loop that computes its samples."""

    evaluate: Any
    constants: Any
    place: int

    def __call__(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> int:
        """Write the angular velocity and the attitude at ``times`` into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped. Return 0, or :data:`TOO_MANY_TURNS` (some samples are NaN), or
        :data:`OUT_OF_RANGE` (nothing is written).
        """
        status: int = self.evaluate(self.place, len(times), address(times), address(omega), address(quaternion))
        return status


@cache
def functions() -> tuple[Any, Any]:
    """Return the compiled loop of :file:`axial_at.c` over samples, and the ctypes type of the constants that it reads.

    Raises
    ------
    CompilerError
        If there is no C compiler, or if its code does not round after every operation but fuses some, such as a*b + c.
    """
    (compiled,) = load("axial")
    if not compiled.symrot_axial_sound():
        raise CompilerError(
            "expected a C compiler that rounds after every operation, got one that fuses some, such as a*b + c; "
            "set CC to another compiler"
        )
    evaluate, length = compiled.symrot_axial_at, compiled.symrot_axial_length
    pointer, size = ctypes.c_void_p, ctypes.c_ssize_t
    evaluate.argtypes, evaluate.restype = (pointer, size, pointer, pointer, pointer), ctypes.c_int
    length.restype = size
    return evaluate, ctypes.c_double * length()


class Constants:
    """The constants of a body driven about one axis; a call with an initial state returns the motion from this state.

    Parameters
    ----------
    axis : 0, 1 or 2
        Index of the body axis about which the torque acts.
    moments : 2 ratios
        Moments of inertia, kg m^2, about an axis normal to the driven axis and about the driven axis. A ratio is a
        pair of integers: numerator and positive denominator.
    torque, damping, across : ratios
        Torque about the axis, N m; damping coefficients, N m s, about the driven axis and about the axes normal to it.

    Raises
    ------
    InputError
        If a rate or an acceleration exceeds the range of doubles; a call raises the same error.
    """

    def __init__(self, axis: int, moments: tuple[Ratio, Ratio], torque: Ratio, damping: Ratio, across: Ratio) -> None:
        (a, over_a), (c, over_c) = moments
        self.axis, self._moments = axis, moments
        push, over_push = torque[0] * over_c, torque[1] * c
        decay, over_decay = damping[0] * over_c, damping[1] * c
        slowing = across[0] * over_a, across[1] * a
        self._push, self._decay, self._shared = push * over_decay, decay * over_push, over_push * over_decay
        fastest = max(decay / over_decay, slowing[0] / slowing[1])
        self.first = -_EXPONENT / fastest if fastest else -math.inf
        self._sign = -1 if decay < 0 else 1
        self._head = [self.first, *parts(-decay, over_decay, _PAIR), *parts(-slowing[0], slowing[1], _PAIR)]
        self._final = _nearest(self._sign * self._push, abs(self._decay)) if decay else 0.0
        self._pushed = _nearest(push, over_push)
        self._turns: dict[bool, tuple[int, int, list[float]]] = {}

    def head(self, transverse: bool) -> list[float]:
        """Return the first 8 numbers of the C type ``axial`` (in :file:`axial.h`), which all motions of the body share.

        In order: 1 if the rotation about the driven axis is damped, else 0; the time scale, which is always 1; 1 if
        ``transverse`` (the body also rotates about an axis normal to the driven axis), else 0; the time, s, before
        which an exponential may exceed the range of doubles; and -k, 1/s, as hi and lo, where k is the decay rate of
        the angular velocity about the driven axis; the same for the transverse angular velocity.
        """
        return [float(bool(self._decay)), 1.0, float(transverse), *self._head]

    def moving(self, rate: Fraction | float, transverse: bool) -> list[float]:
        """Return the 18 constants for C that depend on the initial angular velocity about the driven axis, rad/s.

        They are stored in a struct of :file:`axial.h`. The first four describe the rotation about the driven axis: the
        initial angular velocity, the initial angular acceleration, the final angular velocity, and the initial minus
        the final angular velocity. The other 14 are the constants of an angle. If the body also rotates about an axis
        normal to the driven axis (``transverse``), it is the angle by which the transverse angular velocity rotates in
        the body, member ``lag`` of the struct. Otherwise it is half the angle of rotation, member ``half``.
        """
        turn, bits, fixed = self._turns.get(transverse) or self._turning(transverse)
        top, bottom = rate.as_integer_ratio()
        if not self._decay:
            evenly = parts(top * turn, bottom << bits, _WIDE)
            return [top / bottom, self._pushed, 0.0, top / bottom, *evenly, 0.0, 0.0, 0.0, *fixed]
        gain, over = self._push * bottom - self._decay * top, self._shared * bottom
        rest, below = gain * self._shared * turn, self._decay * self._decay * bottom << bits
        beyond = -rest % below
        return [
            top / bottom, _nearest(gain, over), self._final,
            _nearest(-self._sign * gain, abs(self._decay) * bottom),
            *parts(top * turn, bottom << bits, _WIDE), *fixed,
            *parts(gain * turn, over << bits, _PAIR), 0.0, 0.0,
            *parts(rest, below, _PAIR), *parts(beyond - below if 2 * beyond > below else beyond, below, _PAIR),
        ]  # fmt: skip

    def _turning(self, transverse: bool) -> tuple[int, int, list[float]]:
        """Return constants (turn, bits, fixed) of half the angle of rotation or, if ``transverse``, of another angle.

        The other angle is that by which the transverse angular velocity rotates in the body. If the body rotates by
        1 rad about the driven axis, the angle changes by ``turn/2**bits`` revolutions. ``fixed`` are the numbers for C
        that do not depend on the initial state: 3, or 8 without damping.
        """
        turn, bits = _HALF
        if transverse:
            (a, over_a), (c, over_c) = self._moments
            lag = Fraction(c * over_a - a * over_c, over_c * a)
            turn, bits = _turns_of(lag.numerator, lag.denominator)
        if self._decay:
            fixed = parts(self._sign * self._push * turn, abs(self._decay) << bits, _WIDE)
        else:
            fixed = [*parts(self._push * turn, 2 * self._shared << bits, _WIDER), *[0.0] * 4]
        self._turns[transverse] = turn, bits, fixed
        return self._turns[transverse]

    def __call__(self, rates: Sequence[Fraction], attitude: tuple[list[float], list[float]]) -> Loops:
        """Return the motion from one initial state: a :class:`Loops`, the compiled C loop with this motion's constants.

        Parameters
        ----------
        rates : 3 Fractions
            Angular velocity at the start, rad/s.
        attitude : 2 lists of 4 floats
            Quaternions P and Q, the attitude at the start and the attitude half a revolution later: after a rotation by
            ``angle`` about the driven axis the attitude is P cos(angle/2) + Q sin(angle/2).
        """
        evaluate, record = functions()
        one, other = rates[self.axis - 2], rates[self.axis - 1]
        transverse, moving = bool(one or other), self.moving(rates[self.axis], bool(one or other))
        half, lag = ([0.0] * _TURNING, moving[4:]) if transverse else (moving[4:], [0.0] * _TURNING)
        constants = record(
            *self.head(transverse), *moving[:4], *half, *lag, *self.omega_rows(float(one), float(other)),
            *(x for pair in zip(*attitude, strict=True) for x in (*pair, 0.0, 0.0)),
        )  # fmt: skip
        return Loops(evaluate, constants, ctypes.addressof(constants))

    def omega_rows(self, one: Any, other: Any) -> list[Any]:
        """Return the 3x3 matrix that gives the angular velocity in the body at any time, as 9 entries row by row.

        The matrix is to be multiplied by the vector (d cos(lag), d sin(lag), rate about the driven axis): lag is the
        angle by which the transverse angular velocity has rotated in the body, and d is the factor by which damping has
        changed its length. ``one`` and ``other`` are the initial rates, rad/s, about the two axes that follow the
        driven axis cyclically.
        """
        rows: list[list[Any]] = [[0.0] * 3 for _ in range(3)]
        rows[self.axis][2] = 1.0
        rows[self.axis - 2][:2] = one, -other
        rows[self.axis - 1][:2] = other, one
        return [x for row in rows for x in row]


def _turns_of(top: int, bottom: int) -> tuple[int, int]:
    """Convert the angle top/bottom rad to revolutions: (turn, bits), which stands for ``turn/2**bits`` revolutions."""
    top, bottom = top * _PI_BOTTOM, 2 * bottom * _PI_TOP
    bits = max(0, _TURN_BITS + bottom.bit_length() - top.bit_length())
    return (top << bits) // bottom, bits


_HALF = _turns_of(1, 2)  # half the angle in revolutions, as an integer and its bits


def _nearest(top: int, bottom: int) -> float:
    """Return the double nearest to the ratio top/bottom; raise InputError if the ratio exceeds the largest double."""
    # the ratio is an angular velocity or an acceleration
    try:
        return top / bottom
    except OverflowError:
        raise InputError(
            "expected a smaller torque, damping or initial angular velocity: these give the body an angular velocity "
            "or acceleration above 1e308 rad/s or rad/s^2, the largest double"
        ) from None
