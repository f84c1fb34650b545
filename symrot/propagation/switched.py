"""Motions under torques that jump or bend: from one switch to the next, each located to the last bits.

Between switches the modes of :mod:`symrot.switches` are constants and the motion is smooth: any stepper follows it,
while the guards are searched as events are. Where a guard would leave the side of its mode, the motion is stepped
exactly to that time and goes on with the mode of the other side. If both sides send it back (dry friction at rest,
relay control) the guard stays at zero: the motion slides, and the mode takes the value that holds it there, until that
value leaves the range of the switch.

Source: A. F. Filippov, Differential Equations with Discontinuous Righthand Sides, Kluwer 1988, sections 4 and 8.
"""

import math
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from symrot.errors import PropagationError
from symrot.expression import evaluate, names, parse, rename
from symrot.number import PI
from symrot.planner import Plan, make_plan
from symrot.propagation.cut_off import CutOff, add_samples
from symrot.propagation.method import Choice, choose_method
from symrot.propagation.motion import Motion, on_own_clock
from symrot.propagation.polynomials import Piece
from symrot.propagation.propagator import Propagator
from symrot.propagation.regimes import Modes, Regime
from symrot.propagation.stepping import Floats, Recording, Stats, Switching, both_sides, stats_of
from symrot.propagation.switched_run import MATH, Chunk, SwitchedRun
from symrot.scene import Initial

__all__ = ["SwitchedMotion", "SwitchedPropagator"]

STATES = frozenset({*(f"omega_{i}" for i in (1, 2, 3)), *(f"q{i}" for i in range(4))})


class SwitchedPropagator(Propagator):
    """Propagates a scene under torques with switches; made by :func:`symrot.propagator`."""

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial, switched=True)

    def _prepare(self, plan: Plan) -> Motion:
        return SwitchedMotion(plan, choose_method(plan, self._method), self.tolerance)


class SwitchedMotion(Motion):
    """A motion under torques with switches."""

    movable = False  # each regime has a clock of its own
    switched = True

    def __init__(self, plan: Plan, choice: Choice, tolerance: float) -> None:
        self.plan, self.choice, self.tolerance, self.library = plan, choice, tolerance, None
        self.start = float(plan.scene.span.start)
        self.regime(frozenset())

    @cached_property
    def switches(self) -> list[dict[str, Any]]:
        """The switches of all torques, their modes named as the constants of the plan."""
        listed = []
        for torque in self.plan.structure["torques"]:
            prefix = torque["prefix"]
            own = {name: f"{prefix}{name}" for name in torque.get("parameters", ())}
            for switch in torque.get("switches", ()):
                where = switch["where"] and (own[switch["where"][0]], switch["where"][1])
                guard = rename(parse(switch["guard"]), own)
                listed.append({**switch, "mode": own[switch["mode"]], "guard": guard, "where": where})
        return listed

    @cached_property
    def constants(self) -> dict[str, Fraction]:
        return {"pi": PI, **self.plan.constants}

    def initial_modes(self) -> Modes:
        """Return the modes at the start; a guard that is zero there counts as positive, until the motion tells."""
        return dict(self._initial_modes[0])

    @property
    def undecided(self) -> set[str]:
        """The modes whose guards are zero at the start, and not only because of the time."""
        return self._initial_modes[1]

    @cached_property
    def _initial_modes(self) -> tuple[Modes, set[str]]:
        start, modes, undecided = self.plan.scene.initial, Modes(), set[str]()
        values: dict[str, float] = {name: float(value) for name, value in self.constants.items()}
        values |= {"t": self.start, **{f"omega_{i + 1}": float(value) for i, value in enumerate(start.omega_b)}}
        values |= {f"q{i}": float(value) for i, value in enumerate(start.quaternion)}
        for switch in self.switches:
            try:
                guard = float(evaluate(switch["guard"], values, MATH, float))
            except (ArithmeticError, ValueError):
                raise CutOff(self.start, f"{switch['label']} has no value there") from None
            modes[switch["mode"]] = math.floor(guard) if switch["kind"] == "floor" else -1 if guard < 0.0 else 1
            values[switch["mode"]] = float(modes[switch["mode"]])
            if guard == 0.0 and switch["kind"] == "sign" and names(switch["guard"]) & STATES:
                undecided.add(switch["mode"])
        return modes, undecided

    def regime(self, held: frozenset[str]) -> Regime:
        """Return the smooth motion while the guards of some modes stay at zero; derived when first asked for."""
        if held not in self._regimes:
            plan = self.plan
            if held:
                torques = [
                    {**torque, "held": sorted(m for m in torque.get("parameters", ()) if torque["prefix"] + m in held)}
                    for torque in plan.structure["torques"]
                ]
                plan = replace(plan, structure=plan.structure | {"torques": torques})
            self._regimes[held] = Regime(self, on_own_clock(plan, self.choice, self.tolerance), held)
        return self._regimes[held]

    @cached_property
    def _regimes(self) -> dict[frozenset[str], Regime]:
        return {}

    def integrate(self, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
        """Return the states at the times, shape (n, N), and what it cost."""
        began, states = perf_counter(), np.empty((len(times), len(self.plan.states)))
        cost, done = np.zeros(3, dtype=np.int64), np.empty(0, dtype=np.intp)
        changes: dict[tuple[float, str], str] = {}
        for part in both_sides(times, self.start):
            sorted_times = times[part]
            count = int((sorted_times == self.start).sum())
            states[part[:count]] = self.plan.initial_state
            run = SwitchedRun(self, float(sorted_times[-1]))

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
            except (CutOff, KeyboardInterrupt) as error:
                numbers = np.concatenate([done, part[:count]])
                add_samples(error, numbers, states[numbers])
                raise
            done = np.concatenate([done, part])
            cost += run.cost
            changes |= run.changes
        return states, stats_of(cost, perf_counter() - began, _switchings(changes))

    def parts(self, end: float, broken: list[PropagationError]) -> tuple[list[Piece], Recording]:
        """Return the motion from its start to an end as polynomials and at any time; what cut it off in ``broken``."""
        chunks: list[Chunk] = []
        run = SwitchedRun(self, end)
        try:
            run.follow(chunks.append)
        except CutOff as error:
            broken.append(error)
        stats = stats_of(run.cost, 0.0, _switchings(run.changes))
        states = SwitchedRecording(self.start, self.plan.initial_state, (self.start, end), stats, chunks)
        return [chunk.piece() for chunk in chunks], states

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return the states as a function of time."""
        chunks: list[Chunk] = []
        cost, began, changes = np.zeros(3, dtype=np.int64), perf_counter(), dict[tuple[float, str], str]()
        for end in {min(*span, self.start), max(*span, self.start)} - {self.start}:
            run = SwitchedRun(self, end)
            run.follow(chunks.append)
            cost += run.cost
            changes |= run.changes
        stats = stats_of(cost, perf_counter() - began, _switchings(changes))
        return SwitchedRecording(self.start, self.plan.initial_state, span, stats, chunks)


def _switchings(changes: dict[tuple[float, str], str]) -> list[Switching]:
    return [Switching(t, function, how) for (t, function), how in changes.items()]


class SwitchedRecording(Recording):
    """A motion under torques with switches at any time, from the parts between them."""

    def __init__(
        self, t0: float, y0: tuple[float, ...], span: tuple[float, float], stats: Stats, chunks: list[Chunk]
    ) -> None:
        super().__init__(t0, np.array(y0), (min(*span, t0), max(*span, t0)), stats)
        self._chunks = sorted(chunks, key=lambda chunk: min(chunk.start, chunk.stop))
        ends = [max(chunk.start, chunk.stop) for chunk in self._chunks]
        self._ends, self._rests = np.array([end.high for end in ends]), np.array([end.low for end in ends])

    def _fill(self, times: Floats, states: Floats) -> None:
        places = np.searchsorted(self._ends, times)
        while True:  # a time that is rounded up to the end of a chunk lies in the next one
            inside = np.minimum(places, len(self._ends) - 1)
            beyond = (places < len(self._ends)) & (self._ends[inside] == times) & (self._rests[inside] < 0.0)
            if not beyond.any():
                break
            places[beyond] += 1
        for place in np.unique(places):
            if place == len(self._chunks):
                states[places == place] = np.nan  # beyond where the motion was cut off
            else:
                chosen = places == place
                states[chosen] = self._chunks[place].states(times[chosen])
