"""A recorded motion: a function from times to states."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.errors import InputError
from symrot.propagation.steppers.stats import Stats

__all__ = ["Recording"]

Floats = NDArray[np.float64]


class Recording(ABC):
    """A motion as a function from times in ``span``, one or n, to states, shape (N,) or (n, N).

    Times are counted from ``epoch``, a time of the scene, s; a time outside the span raises InputError.
    """

    epoch = 0.0

    def __init__(self, t0: float, y0: Sequence[float] | Floats, span: tuple[float, float], stats: Stats) -> None:
        self._t0, self._y0, self.span, self.stats = t0, y0, span, stats

    @abstractmethod
    def _fill(self, times: Floats, states: Floats) -> None:
        """Write the states at ``times``, shape (n,), inside the span into the array ``states``, shape (n, N).

        At t0 it may write anything: the caller inserts the initial state there.
        """

    def __call__(self, t: ArrayLike) -> Floats:
        times = np.asarray(t, dtype=np.float64)
        flat = np.ascontiguousarray(times).reshape(-1)
        outside = ~((flat >= self.span[0]) & (flat <= self.span[1]))
        if outside.any():
            low, high, asked = (time + self.epoch for time in (*self.span, float(flat[outside][0])))
            raise InputError(f"t: expected times from {low} to {high} s, where the motion is known, got {asked} s")
        states = np.empty((len(flat), len(self._y0)))
        self._fill(flat, states)
        states[flat == self._t0] = self._y0
        return states.reshape(*times.shape, len(self._y0))
