"""Times to twice the digits of a double, and clocks that start at one.

At t = 1e6 s doubles lie 1e-10 s apart: a switch that is located to the last bit of such a number is off by a part of
1e-10 of the effect that the torque has within a second. As a sum of two doubles a time has 32 digits.
"""

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic.double_double import normalized, two_sum

__all__ = ["Instant"]

Floats = NDArray[np.float64]


class Instant(NamedTuple):
    """A time, s: ``high`` is the double next to it, ``low`` the rest."""

    high: float
    low: float = 0.0

    @property
    def exact(self) -> Fraction:
        return Fraction(self.high) + Fraction(self.low)

    def after(self, *seconds: float) -> "Instant":
        """Return a later instant; several numbers of seconds are added."""
        high, low = self
        for second in seconds:
            high, error = two_sum(high, second)
            low += error
        return Instant(*normalized(high, low))

    def __sub__(self, other: "Instant") -> float:
        """Return the seconds from another instant to this one."""
        return (self.high - other.high) + (self.low - other.low)

    def since(self, times: Any) -> Any:
        """Return times, s, on a clock that shows 0 at this instant."""
        return (times - self.high) - self.low

    def reached(self, times: Floats, side: float) -> int:
        """Return how many times, which rise (``side`` 1) or fall (-1), do not lie beyond this instant."""
        count = int(np.searchsorted(side * times, side * self.high, "right"))
        while side * self.low < 0.0 and count and times[count - 1] == self.high:
            count -= 1
        return count
