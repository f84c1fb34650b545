"""The sum of the rounding errors of a motion: from formulas with the time, such as ``t**2 - 25``, and in SciPy's steps.

Each direction of time, after and before the start, has its own sum.
"""

import math
from typing import Any

__all__ = ["RoundingSum"]

WARNED = 1.0  # tolerances: from here on the error may exceed the tolerance


class RoundingSum:
    """Sum of the bounds of the rounding errors of the steps of a motion, to be compared with its tolerance.

    Attributes
    ----------
    tolerance : float
        Error of the whole motion to aim for.
    squares : float
        Sum of the squares of the bounds: errors of different steps are independent.
    drift : float
        Sum of the bounds of errors that all have the same sign.
    size : float
        Largest size of the block of states so far, to which the tolerance is relative.
    beyond : float or None
        Time, s, from which the error may exceed the tolerance; None if it cannot in the steps so far.
    """

    def __init__(self, tolerance: float) -> None:
        self.tolerance, self.squares, self.drift, self.size = tolerance, 0.0, 0.0, 0.0
        self.beyond: float | None = None

    def add(self, t: float, error: float, size: float, drift: float = 0.0) -> None:
        """Add to the sum the rounding error of a step at the time t, s, which is at most ``error``.

        ``size`` is the size of the states in the step, and ``drift`` a further error that has the same sign in every
        step. The sum is compared with the tolerance times the largest size.
        """
        self.squares += error * error
        self.drift += drift
        self.size = max(self.size, size)
        if self.beyond is None and math.sqrt(self.squares) + self.drift > WARNED * self.tolerance * self.size:
            self.beyond = t

    def fields(self) -> dict[str, float]:
        """Return the sum so far as a dict of fields for the C struct with the state of an integration.

        The C code adds the errors of further steps to these fields, and :meth:`read` returns the sum to this object.

        The keys are ``"rounded"`` for :attr:`squares` and ``"largest"`` for :attr:`size`.
        """
        return {"rounded": self.squares, "largest": self.size}

    def read(self, run: Any) -> None:
        """Replace the sum by the sum in the C struct ``run``.

        The C code has added to it the errors of further steps.
        """
        self.squares, self.size = run.rounded, run.largest
        if self.beyond is None and not math.isnan(run.rounded_from):
            self.beyond = run.rounded_from
