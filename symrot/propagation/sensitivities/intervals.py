"""The smooth intervals of a motion under torques that jump or bend, from one switch to the next."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.motion import SwitchedMotion
from symrot.propagation.switched.regimes import Modes, Regime
from symrot.propagation.switched.run import Chunk, SwitchedRun

__all__ = ["Interval", "smooth_intervals"]

Floats = NDArray[np.float64]
SHORT = 1e-14  # part of the time: length of an interval that is due to rounding errors


@dataclass(eq=False)
class Interval:
    """A smooth interval of a motion; ``start`` and ``stop`` are s after the instant ``zero``."""

    regime: Regime
    modes: Modes
    held: frozenset[str]
    zero: Instant
    start: float
    stop: float
    first: Floats  # the states at the start and at the end
    last: Floats
    chunks: list[Chunk] = field(default_factory=list)
    before: Floats = field(default_factory=lambda: np.empty(0))  # derivatives at the start and at the end, (7, m)
    after: Floats = field(default_factory=lambda: np.empty(0))
    resting: list[str] = field(default_factory=list)  # modes whose guards stay at zero though they are not held

    @property
    def begin(self) -> Instant:
        return self.zero.after(self.start)

    @property
    def end(self) -> Instant:
        return self.zero.after(self.stop)

    def places(self) -> Iterator[tuple[float, Floats]]:
        """Yield a time, s after ``zero``, and the states at the start, near the middle and at the end."""
        middle = self.chunks[len(self.chunks) // 2]
        t = 0.5 * ((middle.start - self.zero) + (middle.stop - self.zero))
        yield self.start, self.first
        yield t, middle.own_states(np.array([t]))[0]
        yield self.stop, self.last


def smooth_intervals(motion: SwitchedMotion, end: float) -> tuple[list[Interval], dict[tuple[float, str], str]]:
    """Return the smooth intervals of a motion to the time ``end``, s, and a dict of its switches.

    A key of the dict is a pair: time, s, and function as the user wrote it, such as ``"sign(omega_3)"``. The value is
    ``"passed"``, ``"held"`` or ``"released"``: the argument of the function passes zero, stays there from then on, or
    leaves zero, where it was held.

    Raises
    ------
    IntegrationStopped
        If the motion cannot be followed to the end.
    """
    intervals: list[Interval] = []
    run = SwitchedRun(motion, motion.system, end)

    def add(chunk: Chunk) -> None:
        start, stop = chunk.start - chunk.zero, chunk.stop - chunk.zero
        if stop == start:
            return
        last = chunk.own_states(np.array([stop]))[0]
        current = intervals[-1] if intervals else None
        if current and current.zero == chunk.zero and current.modes == run.modes and current.held == run.held:
            current.stop, current.last = stop, last
            current.chunks.append(chunk)
            return
        first = chunk.own_states(np.array([start]))[0]
        regime = motion.system.regime(run.held, run.modes)
        intervals.append(Interval(regime, dict(run.modes), run.held, chunk.zero, start, stop, first, last, [chunk]))

    run.follow(add)
    return _without_rounding_intervals(motion, intervals, abs(end - motion.start)), run.changes


def _without_rounding_intervals(motion: SwitchedMotion, intervals: list[Interval], length: float) -> list[Interval]:
    """Return the smooth intervals without the very short intervals that rounding errors cause before a sliding motion.

    At the start of such a short interval, the argument of a switching function (sign, abs, ..) passes zero by a
    rounding error; at its end the argument returns to zero, where it is held from then on. ``length`` is the length of
    the whole motion, s, with which the length of an interval is compared.
    """
    result = intervals[:1]
    for current, following in pairwise([*intervals[1:], None]):
        assert current is not None
        before = result[-1]
        short = abs(current.stop - current.start) <= SHORT * max(length, abs(current.end.high))
        changed = {mode for mode, value in current.modes.items() if value != before.modes[mode]}
        tied = following.held | motion.system.tied(following.held).keys() if following else frozenset[str]()
        if not (short and changed and changed <= tied and current.held == before.held):
            result.append(current)
    return result
