"""Motions that end before they should: the error, the reasons, and the samples that were computed before."""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError

__all__ = ["IntegrationStopped", "Samples", "add_samples", "why_hopeless", "why_stuck"]

HOPELESS = 3.0  # times the limit: a motion is given up that needs so many more steps at its pace
MANY_TICKS = 2**20  # of the clock between two ends: with fewer, it is the clock that ends short steps

Floats = NDArray[np.float64]


class IntegrationStopped(PropagationError):
    """A motion that ends at t, s, on the way to ``stop``."""

    def __init__(self, t: float, reason: str, stop: float | None = None) -> None:
        way = "" if stop is None else f" on the way to {stop!r} s"
        super().__init__(f"the motion cannot be followed beyond t = {t!r} s{way}: {reason}")
        self.t, self.reason, self.stop = t, reason, stop
        self.samples: Samples | None = None  # those before t
        self.recording: Any = None  # the motion before t, where one was being recorded

    def later(self, epoch: float) -> "IntegrationStopped":
        """Return the error for a clock that shows ``epoch`` where this one shows 0."""
        later = IntegrationStopped(self.t + epoch, self.reason, None if self.stop is None else self.stop + epoch)
        later.samples = self.samples
        return later


class Samples(NamedTuple):
    """The samples that were computed before a motion was cut off.

    Attributes
    ----------
    numbers : array, shape (k,)
        Places of the samples among all that were asked for.
    states : array, shape (k, N)
    cost : (int, int, int)
        Steps accepted and rejected, and evaluations, that were spent until then.
    """

    numbers: NDArray[np.intp]
    states: Floats
    cost: tuple[int, int, int] = (0, 0, 0)


def add_samples(
    error: BaseException, numbers: NDArray[np.intp], states: Floats, cost: Iterable[int] | None = None
) -> None:
    """Have an error, or an interrupt, carry the samples computed before it in ``samples``, and what they cost."""
    before: Samples | None = getattr(error, "samples", None)
    if before is not None:  # of one side: the other side was finished first
        numbers, states = np.concatenate([numbers, before.numbers]), np.concatenate([states, before.states])
        cost = before.cost if cost is None else cost
    accepted, rejected, evaluations = map(int, (0, 0, 0) if cost is None else cost)
    error.samples = Samples(numbers, states, (accepted, rejected, evaluations))  # type: ignore[attr-defined]


def why_stuck(reason: str, t: float, t0: float, stop: float) -> str:
    """Return why steps shrank to nothing at t: for ``reason``, or since the clock has few numbers on the whole way."""
    apart = math.ulp(t)
    if abs(stop - t0) > MANY_TICKS * apart:
        return reason
    return (
        f"the clock is too coarse for its steps: numbers lie {apart:.3g} s apart there; count the time from nearer by"
    )


def why_hopeless(steps: int, way: float, left: float, limit: int) -> str:
    """Return why a motion is given up, or nothing; it took the steps for the last ``way``, s, with ``left`` to go."""
    if steps * left <= HOPELESS * limit * way:
        return ""
    more = f"{steps * left / way:.0e} of them, far" if way > 0.0 else "endlessly many,"
    return f"steps of {way / steps:.1e} s would take {more} more than the limit of {limit}"
