"""The angle of rotation about one axis under a constant torque and linear damping, in revolutions modulo 1.

After time t the angle is ``rate t (exp(x) - 1)/x + push t^2 (exp(x) - 1 - x)/x^2`` with ``x = -decay t``. Here rate is
the initial angular velocity, push the angular acceleration by the torque, and decay the decay rate by the damping.

Proof: ``derivations/driven_rotation.md``.
"""

from fractions import Fraction

import numpy as np

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import pair
from symrot.closed_form.build import Floats
from symrot.errors import InputError
from symrot.formula import exact_numbers as number

__all__ = ["FEW", "LARGE", "SMALL", "Turning", "exp_and_expm1"]

FEW = 64
"""Largest number of samples with large angles that are computed in integers, which is then faster than NumPy.

More samples are computed in sums of two doubles, if their angles are below :data:`LARGE`.
"""

SMALL = 1 / 16
"""Largest angle, in revolutions, for which doubles suffice; their error is then at most 2e-16 rad."""

LARGE = 1e10
"""Angle, in revolutions, above which double-double numbers do not suffice and integers are used."""

_BLOCK = 4096  # times in one block, whose arrays stay in the caches of the processor
_BITS = 192  # bits of an angle in revolutions after the binary point, 64 of them for the size of the time
_HALVINGS = 8  # how often the argument of the exponential is halved before its series is summed in integers
_GROWN = 1500.0  # exp of a larger number exceeds the largest double even after multiplication by the smallest one
_GUARD = 16  # guard bits against the rounding errors of integer arithmetic
_TERMS = 20  # terms of the series of (exp(x) - 1 - x)/x^2 for |x| <= 1; the next term is below 2^-70


def exp_and_expm1(high: Floats, low: Floats) -> tuple[Floats, Floats]:
    """Return exp(x) and exp(x) - 1, rounded to doubles, where x is the sum ``high + low`` of two doubles."""
    grown = np.exp(high)
    return grown * (1.0 + low), np.expm1(high) + grown * low


def _second(x: Floats) -> Floats:
    r"""Return (exp(x) - 1 - x)/x^2 for doubles with \|x\| <= 1, by its power series."""
    series = np.full_like(x, 1.0 / (_TERMS + 2))
    for n in range(_TERMS + 1, 1, -1):
        series = (1.0 + series * x) / n
    return series


def _less_whole_turns(turns: dd.Pair) -> Floats:
    high, low = turns
    rest: Floats = (high - np.rint(high)) + (low - np.rint(low))
    return rest


class Turning:
    """A function from time to ``factor`` times the angle by which a driven body has rotated, modulo 1 revolution.

    For the attitude quaternion, which depends on half the angle, ``factor`` is 1/2.

    Parameters
    ----------
    factor : Fraction
        The factor by which the angle of rotation is multiplied.
    rate : Fraction
        Angular velocity at the start, rad/s.
    push : Fraction
        Angular acceleration that the constant torque causes, rad/s^2.
    decay : Fraction
        Decay rate that the damping causes, 1/s.

    Raises
    ------
    InputError
        If constants of the motion exceed the range of doubles.
    """

    def __init__(self, factor: Fraction, rate: Fraction, push: Fraction, decay: Fraction) -> None:
        turn = factor / (2 * number.PI)
        self._factor, self._rate, self._push, self._decay = factor, pair(rate * turn), pair(push * turn), pair(-decay)
        final = push / decay if decay else rate
        rest = (rate - final) / decay if decay else push / 2
        self._exact = final, rest, decay
        try:
            self._final, self._rest = pair(final * turn), pair(rest * turn)
        except OverflowError:
            raise InputError(
                "expected constants of the motion within the range of doubles, got larger ones for an angular velocity "
                f"of {float(rate)!r} rad/s, an acceleration of {float(push)!r} rad/s^2 and a decay rate of "
                f"{float(decay)!r} 1/s: the damping is too weak; write stronger damping, or none"
            ) from None
        self._bits = _BITS + max(int(abs(x)) for x in self._exact).bit_length()
        self._scaled: dict[int, tuple[int, int, int, int]] = {}

    @np.errstate(over="ignore")  # only upper bounds overflow; such angles are computed in integers
    def __call__(self, t: Floats) -> Floats:
        """Return ``factor`` times the angle of rotation at each time in ``t``, s, in revolutions from -1/2 to 1/2.

        Raise InputError if the angular velocity at a time exceeds the range of doubles.
        """
        if len(t) > _BLOCK:
            return np.concatenate([self(t[k : k + _BLOCK]) for k in range(0, len(t), _BLOCK)])
        # doubles have a relative error of 1e-16, double-double numbers an error of 1e-20 revolutions; integers serve
        # larger angles, and few times, for which they are faster than one call of NumPy; both round to the same double
        x = self._decay[0] * t
        size, near = np.abs(t) * (abs(self._rate[0]) + abs(self._push[0] * t)), np.abs(x) <= dd.NEAR
        small = (size <= SMALL) & (np.abs(x) <= 1.0)
        if small.all():
            return self._in_doubles(t)
        large = ~small
        if np.count_nonzero(large) > FEW:
            far = np.abs(self._final[0] * t) + abs(self._rest[0]) * np.exp(np.maximum(x, 0.0))
            pairs = large & (np.where(near, size, far) <= LARGE)
            ways = [(small, self._in_doubles), (pairs & near, self._near), (pairs & ~near, self._far)]
            ways.append((large & ~pairs, self._by_integers))
        else:
            ways = [(small, self._in_doubles), (large, self._by_integers)]
        turns = np.empty_like(t)
        for chosen, way in ways:
            if chosen.any():
                turns[chosen] = way(t[chosen])
        return turns - np.rint(turns)

    def _in_doubles(self, t: Floats) -> Floats:
        x = self._decay[0] * t
        series = _second(x)
        return self._rate[0] * t * (1.0 + x * series) + self._push[0] * t * t * series

    def _near(self, t: Floats) -> Floats:
        """Return the angle of rotation times the constructor's ``factor``, in revolutions modulo 1, near the start.

        At times with ``|decay t| <= dd.NEAR``, the power series of (exp(x) - 1 - x)/x^2 is accurate; it is evaluated in
        double-double numbers.
        """
        time = t, np.zeros_like(t)
        x = dd.multiply(time, self._decay)
        series = dd.second(x) if self._decay[0] else (0.5, 0.0)  # accurate for such times only
        first = dd.add((1.0, 0.0), dd.multiply(x, series)) if self._decay[0] else (1.0, 0.0)
        pushed = dd.multiply(dd.multiply(dd.multiply(time, self._push), time), series)
        return _less_whole_turns(dd.add(dd.multiply(dd.multiply(time, self._rate), first), pushed))

    def _far(self, t: Floats) -> Floats:
        """Return the angle of rotation times the constructor's ``factor``, in revolutions modulo 1, at late times.

        These are times with ``|decay t| > dd.NEAR``. The steady part of the angle, linear in t, and the transient part
        are computed in double-double numbers and added.
        """
        # (push/decay) t + (rate - push/decay) (1 - exp(x))/decay, whose parts would cancel at smaller x
        time = t, np.zeros_like(t)
        high, low = dd.exponential(dd.multiply(time, self._decay))
        left = dd.multiply(dd.add((1.0, 0.0), (-high, -low)), self._rest)
        return _less_whole_turns(dd.add(dd.multiply(time, self._final), left))

    def _by_integers(self, t: Floats) -> Floats:
        return np.array([self._exactly(time) for time in t.tolist()])

    def _integers(self, bits: int) -> tuple[int, int, int, int]:
        """Return the constants (final, rest, decay, ln 2) as integers with ``bits`` bits after the binary point.

        The angle of rotation, times the constructor's ``factor``, is final*t + rest*(1 - exp(-decay*t)) revolutions
        with damping, and final*t + rest*t^2 without. The exponential needs ln 2, which has 16 bits more (``_GUARD``).
        """
        if bits not in self._scaled:
            from symrot.formula.precision import bits as precision
            from symrot.formula.precision import mp

            places, (final, rest, decay) = bits + _BITS, self._exact
            with precision(places + 8):
                circle = 2 * int(mp.pi * mp.mpf(2) ** places)
            turns = [
                (x.numerator * self._factor.numerator << (bits + places))
                // (x.denominator * self._factor.denominator * circle)
                for x in (final, rest)
            ]
            ln2 = int(dd.ln2(bits + _GUARD) * (1 << bits + _GUARD))
            self._scaled[bits] = turns[0], turns[1], (decay.numerator << bits) // decay.denominator, ln2
        return self._scaled[bits]

    def _exactly(self, t: float) -> float:
        """Return the angle of rotation at the time t, s, times the constructor's ``factor``, in revolutions modulo 1.

        The result, from -1/2 to 1/2, is computed in integers and rounded once. InputError is raised if -decay*t exceeds
        1500: the angular velocity is then out of the range of doubles.
        """
        top, bottom = t.as_integer_ratio()
        growth = max(0.0, self._decay[0] * t)  # each factor 2 of the exponential costs one bit of the other terms
        if growth > _GROWN:
            raise InputError(f"expected times at which the angular velocity is a finite number, got {t!r} s")
        bits = self._bits + 64 * int(growth / 32)
        final, rest, decay, ln2 = self._integers(bits)
        shift, one = bottom.bit_length() - 1, 1 << bits
        if decay:
            grown = _exponential(-(decay * top >> shift), bits, ln2)
            turns = (final * top >> shift) + (rest * (one - grown) >> bits)
        else:
            turns = (final * top >> shift) + (rest * top * top >> 2 * shift)
        turns &= one - 1
        return (turns - one if 2 * turns > one else turns) / one


def _exponential(x: int, bits: int, ln2: int) -> int:
    """Return exp(x) for a fixed-point number x: x and the result are integers with ``bits`` bits after the point."""
    if x < -bits << bits:
        return 0
    # ln2: the logarithm of 2, with _GUARD more bits than x
    octaves, rest = divmod(x << _GUARD, ln2)
    bits += _GUARD
    rest >>= _HALVINGS
    total = term = 1 << bits
    n = 1
    while term:
        term = (term * rest >> bits) // n
        total += term
        n += 1
    for _ in range(_HALVINGS):
        total = total * total >> bits
    return (total << octaves if octaves > 0 else total >> -octaves) >> _GUARD
