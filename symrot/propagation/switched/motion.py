"""Motions under torques that jump or bend, followed from one switch to the next.

A switching function (sign, abs, ..) has a *guard*, its argument, and a *mode*, the number that replaces it in formulas.
Between switches the motion is smooth: a *regime*. If the rates on both sides drive the guard back to zero, the motion
*slides*: the guard is *held* at zero.
"""

from time import perf_counter
from typing import Any, final

import numpy as np

from symrot.errors import PropagationError
from symrot.planning.plan import Plan
from symrot.propagation.compiled_models import scene_kernel
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.method import Choice
from symrot.propagation.motions.motion import MotionInParts
from symrot.propagation.motions.setup import Setup
from symrot.propagation.steppers.integration_stopped import IntegrationStopped, add_samples
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.segments import split_at
from symrot.propagation.steppers.stats import Stats, Switching, stats_of
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.switched.run import Chunk, SwitchedRun
from symrot.propagation.switched.system import SwitchedSystem

__all__ = ["SwitchedMotion"]


# While a stepper follows a regime, the guards are searched for zeros like the formulas of events, to the last bits.
# Where a guard changes its sign, the integration ends exactly and continues with the new mode.
# In sliding motion (dry friction at rest, relay control), the mode takes the value that keeps the guard at zero, until
# this value leaves the range of the function. Source: A. F. Filippov, Differential Equations with Discontinuous
# Righthand Sides, Kluwer 1988, sections 4 and 8.
@final
class SwitchedMotion(MotionInParts):
    """Motion under torques with switching functions (sign, abs, ..), computed in smooth intervals between switches."""

    def __init__(self, plan: Plan, choice: Choice, tolerance: float) -> None:
        start = float(plan.scene.span.start)
        # in each smooth interval, time is counted from its start
        super().__init__(Setup(plan, choice, tolerance, start, lambda: scene_kernel(plan)), plan)
        self.system = SwitchedSystem(plan, choice, tolerance)
        self.system.regime(frozenset(), self.system.initial_modes())

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the N states at n times of the scene, s, shape (n, N), with the cost and the switching times."""
        began, states = perf_counter(), np.empty((len(times), len(self.plan.states)))
        cost, done = np.zeros(3, dtype=np.int64), np.empty(0, dtype=np.intp)
        changes, rounded = dict[tuple[float, str], str](), list[float]()
        # sorts the times, so that in_order is not used
        for part in split_at(times, self.start):
            sorted_times = times[part]
            count = int((sorted_times == self.start).sum())
            states[part[:count]] = self.plan.initial_state
            run = SwitchedRun(self, self.system, float(sorted_times[-1]))

            def sample(
                chunk: Chunk, part: Any = part, sorted_times: Floats = sorted_times, side: float = run.side
            ) -> None:
                nonlocal count
                last = count + chunk.stop.reached(sorted_times[count:], side)
                if last > count:
                    states[part[count:last]] = chunk.states(sorted_times[count:last])
                    count = last

            try:
                run.follow(sample)
            except (IntegrationStopped, KeyboardInterrupt) as error:
                numbers = np.concatenate([done, part[:count]])
                stats = stats_of(cost + run.cost, perf_counter() - began, (), [*rounded, *run.rounded_beyond])
                add_samples(error, numbers, states[numbers], stats)
                raise
            done = np.concatenate([done, part])
            cost += run.cost
            changes |= run.changes
            rounded += run.rounded_beyond
        return states, stats_of(cost, perf_counter() - began, _switchings(changes), rounded)

    def parts(self, end: float, broken: list[PropagationError]) -> tuple[list[Piece], Recording]:
        """Return the motion from its start to ``end``, s, as polynomials, and also as a function from times to states.

        If the motion stops early, the error is appended to ``broken``.
        """
        chunks: list[Chunk] = []
        run = SwitchedRun(self, self.system, end)
        try:
            run.follow(chunks.append)
        except IntegrationStopped as error:
            # the motion before the stop is returned
            broken.append(error)
        stats = stats_of(run.cost, 0.0, _switchings(run.changes), run.rounded_beyond)
        states = SwitchedRecording(self.start, self.plan.initial_state, (self.start, end), stats, chunks)
        return [chunk.piece() for chunk in chunks], states

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function that takes n times within ``span``, s, and returns the N states, shape (n, N).

        The span may contain any number of switches.
        """
        chunks: list[Chunk] = []
        cost, began, changes = np.zeros(3, dtype=np.int64), perf_counter(), dict[tuple[float, str], str]()
        for end in {min(*span, self.start), max(*span, self.start)} - {self.start}:
            run = SwitchedRun(self, self.system, end)
            run.follow(chunks.append)
            cost += run.cost
            changes |= run.changes
        stats = stats_of(cost, perf_counter() - began, _switchings(changes))
        return SwitchedRecording(self.start, self.plan.initial_state, span, stats, chunks)


def _switchings(changes: dict[tuple[float, str], str]) -> list[Switching]:
    return [Switching(t, function, how) for (t, function), how in changes.items()]


class SwitchedRecording(Recording):
    """A function from times to states, made of smooth intervals of a motion.

    If the motion stopped early, the states at times that it did not reach are NaN.
    """

    def __init__(
        self, t0: float, y0: tuple[float, ...], span: tuple[float, float], stats: Stats, chunks: list[Chunk]
    ) -> None:
        super().__init__(t0, np.array(y0), (min(*span, t0), max(*span, t0)), stats)
        self._chunks = sorted(chunks, key=lambda chunk: min(chunk.start, chunk.stop))
        ends = [max(chunk.start, chunk.stop) for chunk in self._chunks]
        self._ends, self._rests = np.array([end.high for end in ends]), np.array([end.low for end in ends])

    def _fill(self, times: Floats, states: Floats) -> None:
        if not self._chunks:
            # a motion that stopped at its start
            states[:] = np.nan
            return
        places = np.searchsorted(self._ends, times)
        while True:  # a time that is rounded up to the end of a chunk lies in the next one
            inside = np.minimum(places, len(self._ends) - 1)
            beyond = (places < len(self._ends)) & (self._ends[inside] == times) & (self._rests[inside] < 0.0)
            if not beyond.any():
                break
            places[beyond] += 1
        for place in np.unique(places):
            if place == len(self._chunks):
                states[places == place] = np.nan  # a motion forward in time stopped early
            else:
                chosen = places == place
                states[chosen] = self._chunks[place].states(times[chosen])
        # a motion backward in time stopped early
        states[times < min(self._chunks[0].start, self._chunks[0].stop).high] = np.nan
