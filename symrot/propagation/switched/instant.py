"""Times as sums of two doubles with 32 digits, and clocks that show 0 at such a time.

At t = 1e6 s adjacent doubles lie 1e-10 s apart. A torque that switches at a rounded time acts up to 1e-10 s too long,
and the angular momentum is wrong by the jump of the torque times this time.
"""

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic.double_double import normalized, two_sum

__all__ = ["Instant"]

Floats = NDArray[np.float64]


class Instant(NamedTuple):
    """A time, s, as the sum of two doubles: ``high`` is the double nearest to the time, ``low`` the remainder."""

    high: float
    low: float = 0.0

    @property
    def exact(self) -> Fraction:
        return Fraction(self.high) + Fraction(self.low)

    def after(self, *seconds: float) -> "Instant":
        """Return the instant that is later than this instant by the sum of ``seconds``, which may be negative."""
        high, low = self
        for second in seconds:
            high, error = two_sum(high, second)
            low += error
        return Instant(*normalized(high, low))

    def __sub__(self, other: "Instant") -> float:
        """Return the number of seconds from the instant ``other`` to this instant, as one double."""
        return (self.high - other.high) + (self.low - other.low)

    def since(self, times: Any) -> Any:
        """Return times of the scene, s, converted to seconds since this instant; ``times`` is a number or an array."""
        return (times - self.high) - self.low

    def reached(self, times: Floats, side: float) -> int:
        """Return how many of the sorted ``times`` a motion has reached at this instant; an equal time counts.

        ``side`` is 1 if the times increase, -1 if they decrease.
        """
        count = int(np.searchsorted(side * times, side * self.high, "right"))
        while side * self.low < 0.0 and count and times[count - 1] == self.high:
            count -= 1
        return count
