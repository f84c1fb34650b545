"""Motions that stop early: the exception, its reason as a sentence, and the samples computed before it was raised."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError
from symrot.propagation.steppers.stats import Stats

__all__ = ["HOPELESS", "IntegrationStopped", "Samples", "add_samples", "why_exhausted", "why_hopeless", "why_stuck"]

HOPELESS = 3.0  # times the limit of steps: a motion that would need more steps at its present pace is stopped
MANY_TICKS = 2**20  # doubles between both ends of a motion: with fewer, times are too coarse for its steps

Floats = NDArray[np.float64]


class IntegrationStopped(PropagationError):
    """Raised if a motion to the time ``stop`` cannot be followed beyond the time t, s; ``reason`` says why."""

    def __init__(self, t: float, reason: str, stop: float | None = None) -> None:
        way = "" if stop is None else f" on the way to {stop!r} s"
        super().__init__(f"the motion cannot be followed beyond t = {t!r} s{way}: {reason}")
        self.t, self.reason, self.stop = t, reason, stop
        self.samples: Samples | None = None  # the samples before t
        self.recording: Any = None  # the motion before t, if it was being recorded

    def __reduce__(self) -> tuple[Any, ...]:
        """Return (class, arguments), from which pickle creates a copy of the error in another process.

        The copy has no ``samples`` and no ``recording``.
        """
        return IntegrationStopped, (self.t, self.reason, self.stop)

    def later(self, epoch: float) -> "IntegrationStopped":
        """Return a copy of the error with its times converted to scene times, by adding ``epoch``, s.

        The copy has no ``recording``: a recorded motion takes times since the epoch, not scene times.
        """
        later = IntegrationStopped(self.t + epoch, self.reason, None if self.stop is None else self.stop + epoch)
        if self.samples is not None:
            later.samples = self.samples._replace(stats=self.samples.stats.later(epoch))
        return later


class Samples(NamedTuple):
    """Samples computed before a motion stopped early.

    Attributes
    ----------
    numbers : array, shape (k,)
        Indices of the samples among all requested samples.
    states : array, shape (k, N)
        States of the samples.
    stats : Stats
        The cost of the motion before it stopped.
    """

    numbers: NDArray[np.intp]
    states: Floats
    stats: Stats


def add_samples(error: BaseException, numbers: NDArray[np.intp], states: Floats, stats: Stats) -> None:
    """Store the samples computed before an error, with their indices and cost, as ``samples`` of the exception.

    If the exception already has samples, the new samples are put before them, and ``stats`` replaces their cost.
    """
    before: Samples | None = getattr(error, "samples", None)
    if before is not None:  # samples on the other side of the start were finished before
        numbers, states = np.concatenate([numbers, before.numbers]), np.concatenate([states, before.states])
    error.samples = Samples(numbers, states, stats)  # type: ignore[attr-defined]


def why_stuck(reason: str, t: float, t0: float, stop: float) -> str:
    """Return why a stepper is stuck at the time t of a motion from ``t0`` to ``stop``, s.

    If the whole motion is shorter than about a million times the distance from t to the next double, the reason is that
    the steps are too short for doubles at this time. Otherwise the result is ``reason``.
    """
    apart = math.ulp(t)
    if abs(stop - t0) > MANY_TICKS * apart:
        return reason
    advice = "choose the origin of time, t = 0, nearer to the motion"
    return f"the next steps are too short for doubles, which lie {apart:.3g} s apart at this time; {advice}"


def why_exhausted(limit: int) -> str:
    """Return the reason of a motion that stops because its equations were evaluated more than ``limit`` times."""
    return (
        f"{limit} evaluations of the equations of motion, or of bounds of their rates, were not enough; shorten the "
        "span, or choose a larger tolerance or another method"
    )


def why_hopeless(steps: int, way: float, left: float, limit: int) -> str:
    """Return a sentence if a motion would need far more than ``limit`` steps at its present pace, else an empty text.

    The sentence says how many steps the motion would need. The last ``steps`` steps covered ``way`` s; ``left`` s
    remain. Evaluations may be counted in place of steps.
    """
    # by far: more than three times
    if steps * left <= HOPELESS * limit * way:
        return ""
    count = f"{steps * left / way:.0e}" if way > 0.0 else "endlessly many"
    return (
        f"each step or evaluation covers {way / steps:.1e} s: the motion would need {count} steps, far more than the "
        f"largest allowed number of {limit}"
    )
