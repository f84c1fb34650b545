"""Phases that grow linearly with time, in revolutions, and functions of them at arrays of times, without a C compiler.

The formulas are the same as in :file:`circular.h` and :file:`stages.h`.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from symrot.closed_form.arithmetic.double_double import two_product, two_sum
from symrot.closed_form.arithmetic.pairs import Number
from symrot.closed_form.build import Floats
from symrot.formula.precision import mp

__all__ = [
    "DIGITS", "SWITCH", "TERMS", "Phase", "hyperbolic", "multiples", "number", "power_of_two", "quarter_periods",
    "turned_by", "vector",
]  # fmt: skip

mpf = mp.mpf

DIGITS = 120  # digits of the constants, enough to remain accurate after any cancellation
TERMS = 8  # terms of a series
SWITCH = 0.7  # above this parameter m, theta functions are summed by their imaginary transforms
LARGEST = 80.0  # argument of a hyperbolic function above which the results are constant to rounding
MOST_REVOLUTIONS = 2.0**56  # as in circular.h: pairs of doubles give a phase to 1e-13 revolutions within this number


def number(high: Number, low: float) -> Any:
    """Return ``high + low`` as one mpmath number, at mpmath's current precision."""
    top, bottom = high.as_integer_ratio()
    return mpf(top) / bottom + mpf(low)


def vector(pairs: Sequence[Any]) -> list[Any]:
    """Convert a list hi, lo, hi, lo, .. of numbers to mpmath numbers, one for each sum hi + lo."""
    return [number(high, low) for high, low in zip(pairs[::2], pairs[1::2], strict=True)]


def power_of_two(value: Any) -> Any:
    """Return the smallest power of two greater than a positive number, or 1 for zero: 5 gives 8, and 8 gives 16."""
    return mpf(2) ** int(mp.frexp(value)[1]) if value else mpf(1)


def quarter_periods(m: Any, complement: Any) -> tuple[Any, Any]:
    """Return the complete elliptic integrals K(m) and K(1 - m); ``complement`` is 1 - m, with all its digits."""
    real, imaginary = (mp.pi / (2 * mp.agm(1, mp.sqrt(x))) if x else mp.inf for x in (complement, m))
    return real, imaginary


class Phase(NamedTuple):
    """A phase that grows linearly with time, in revolutions: its rate and its start, each a sum of two doubles."""

    rate: tuple[float, float]
    start: tuple[float, float]

    @classmethod
    def of(cls, rate: Any, start: Any = 0, periodic: bool = True) -> "Phase":
        """Return the phase that starts at ``start`` revolutions and grows by ``rate`` revolutions per unit of time."""
        # the start of a periodic phase is reduced to the range from -1/2 to 1/2
        start = mpf(start) - mp.nint(start) if periodic else start
        high = [float(rate), float(start)]
        return cls((high[0], float(rate - high[0])), (high[1], float(start - high[1])))

    def rest(self, t: Floats, parts: int, more: Floats | float = 0.0) -> tuple[Floats, Floats]:
        """Return the phase plus ``more``, in revolutions modulo 1/``parts``, and the number of parts removed.

        That number is correct modulo ``parts``. If ``parts`` is 4, a phase of 0.3 gives 0.05 and 1; a phase beyond
        MOST_REVOLUTIONS gives NaN and 0.
        """
        product, error = two_product(t, self.rate[0])
        small = error + t * self.rate[1]
        small = (small - np.rint(small)) + self.start[1] + more
        high, low = two_sum(product - np.rint(product), self.start[0])
        steps = np.rint(parts * (high + small))
        rest = (high - steps / parts) + (low + small)
        known = np.abs(product) <= MOST_REVOLUTIONS
        return np.where(known, rest, np.nan), np.where(known, steps, 0.0)

    def whole(self, t: Floats) -> Floats:
        """Return the phase at the times ``t``, in revolutions, not reduced modulo 1."""
        # for functions that are not periodic
        product, error = two_product(t, self.rate[0])
        high, low = two_sum(product, self.start[0])
        phase: Floats = high + (low + (error + t * self.rate[1] + self.start[1]))
        return phase

    def circle(self, t: Floats, more: Floats | float = 0.0) -> tuple[Floats, Floats]:
        """Return sine and cosine, at the times ``t``, of the phase plus ``more`` (both in revolutions)."""
        rest, quarters = self.rest(t, 4, more)
        sine, cosine = np.sin(2.0 * np.pi * rest), np.cos(2.0 * np.pi * rest)
        quarter = quarters.astype(np.int64) & 3
        sign = np.where(quarter < 2, 1.0, -1.0)
        odd = (quarter & 1) == 1
        return sign * np.where(odd, cosine, sine), sign * np.where(odd, -sine, cosine)

    def argument(self, t: Floats, stretch: float) -> tuple[Floats, Floats, Floats]:
        """Return (rest, sign, argument) at the times ``t``, for functions that change sign in half a revolution.

        rest is the phase in half revolutions minus the nearest whole number n, and sign is ``(-1)**n``: a phase of 1.3
        half revolutions gives rest = 0.3 and sign = -1. The argument of the hyperbolic functions is ``stretch*rest``,
        clipped to -LARGEST .. LARGEST; ``stretch`` is the change of this argument in half a revolution.
        """
        rest, halves = self.rest(t, 2)
        whole = 2.0 * rest
        flip: Floats = np.where(halves.astype(np.int64) & 1, -1.0, 1.0)
        return whole, flip, np.clip(stretch * whole, -LARGEST, LARGEST)

    def argument_once(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Return (rest, sign, argument) at the times ``t`` for a motion on the separatrix, which is not periodic.

        This method replaces :meth:`argument` there. rest is 0 and sign is 1 at all times, since the motion has no half
        revolutions. The argument of the hyperbolic functions is the phase itself, clipped to -LARGEST .. LARGEST.
        """
        return np.zeros_like(t), np.ones_like(t), np.clip(self.whole(t), -LARGEST, LARGEST)


def turned_by(real: Floats, imaginary: Floats, sine: Floats, cosine: Floats) -> tuple[Floats, Floats]:
    """Return the real and the imaginary part of ``(real + i imaginary) * (cosine + i sine)``."""
    return real * cosine - imaginary * sine, real * sine + imaginary * cosine


def hyperbolic(log_nome: float, weight: float, order: float, v: Floats) -> tuple[Floats, Floats]:
    """Return ``nome**weight*cosh(order*v)`` and ``nome**weight*sinh(order*v)``, where log_nome = log(nome)."""
    # both are finite even if cosh alone would overflow
    log = log_nome * weight if weight else 0.0
    up, down = np.exp(log + order * v), np.exp(log - order * v)
    return 0.5 * (up + down), (np.sinh(order * v) if log == 0.0 else 0.5 * (up - down))


def multiples(sine: Floats, cosine: Floats) -> list[tuple[Floats, Floats]]:
    """Return the pairs (sine, cosine) of 0, 1, 2, .. times an angle, as many as a theta series needs."""
    pairs = [(np.zeros_like(sine), np.ones_like(sine))]
    for _ in range(2 * TERMS - 1):
        s, c = pairs[-1]
        pairs.append((s * cosine + c * sine, c * cosine - s * sine))
    return pairs
