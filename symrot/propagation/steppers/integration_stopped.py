"""Motions that stop early: the error, the reasons, and the samples computed before."""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError

__all__ = ["IntegrationStopped", "Samples", "add_samples", "why_hopeless", "why_stuck"]

HOPELESS = 3.0  # times the limit of steps: a motion that needs more at its pace is stopped
MANY_TICKS = 2**20  # doubles between both ends: with fewer, the resolution of the clock ends short steps

Floats = NDArray[np.float64]


class IntegrationStopped(PropagationError):
    """The error of a motion that stops at t, s, on the way to ``stop``."""

    def __init__(self, t: float, reason: str, stop: float | None = None) -> None:
        way = "" if stop is None else f" on the way to {stop!r} s"
        super().__init__(f"the motion cannot be followed beyond t = {t!r} s{way}: {reason}")
        self.t, self.reason, self.stop = t, reason, stop
        self.samples: Samples | None = None  # the samples before t
        self.recording: Any = None  # the motion before t, if it was being recorded

    def later(self, epoch: float) -> "IntegrationStopped":
        """Return the error for a clock that shows ``epoch`` where this one shows 0."""
        later = IntegrationStopped(self.t + epoch, self.reason, None if self.stop is None else self.stop + epoch)
        later.samples = self.samples
        return later


class Samples(NamedTuple):
    """The samples computed before a motion stopped early.

    Attributes
    ----------
    numbers : array, shape (k,)
        Places of the samples among all requested samples.
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
    """Attach the samples computed before an error or an interrupt, and their cost, to its attribute ``samples``."""
    before: Samples | None = getattr(error, "samples", None)
    if before is not None:  # the other side of the start was finished first
        numbers, states = np.concatenate([numbers, before.numbers]), np.concatenate([states, before.states])
        cost = before.cost if cost is None else cost
    accepted, rejected, evaluations = map(int, (0, 0, 0) if cost is None else cost)
    error.samples = Samples(numbers, states, (accepted, rejected, evaluations))  # type: ignore[attr-defined]


def why_stuck(reason: str, t: float, t0: float, stop: float) -> str:
    """Return why steps shrank to zero at t: for ``reason``, or since the clock is too coarse for the whole span."""
    apart = math.ulp(t)
    if abs(stop - t0) > MANY_TICKS * apart:
        return reason
    advice = "choose t = 0 nearer to the motion"
    return f"the clock is too coarse for its steps: doubles lie {apart:.3g} s apart there; {advice}"


def why_hopeless(steps: int, way: float, left: float, limit: int) -> str:
    """Return why a motion is hopeless, or an empty text; ``steps`` covered the last ``way``, s, and ``left`` remain."""
    if steps * left <= HOPELESS * limit * way:
        return ""
    more = f"{steps * left / way:.0e} of them, far" if way > 0.0 else "endlessly many,"
    return f"steps of {way / steps:.1e} s would take {more} more than the limit of {limit}"
