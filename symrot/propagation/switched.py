"""Motions under torques that jump or bend: from one switch to the next, each located to the last bits.

Between switches the modes of :mod:`symrot.switches` are constants and the motion is smooth: any stepper follows it,
while the guards are searched as events are. Where a guard would leave the side of its mode, the motion is stepped
exactly to that time and goes on with the mode of the other side. If both sides send it back (dry friction at rest,
relay control) the guard stays at zero: the motion slides, and the mode takes the value that holds it there, until that
value leaves the range of the switch.

Source: A. F. Filippov, Differential Equations with Discontinuous Righthand Sides, Kluwer 1988, sections 4 and 8.
"""

import math
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from symrot.codegen import library
from symrot.errors import InputError, PropagationError
from symrot.expression import evaluate, names, parse, rename, text
from symrot.kernel import Argument, Program
from symrot.number import PI
from symrot.planner import Plan, make_plan
from symrot.propagation import dop853, taylor
from symrot.propagation.cut_off import CutOff, add_samples
from symrot.propagation.events import Event, guard_library_source, search, signs_at_ends
from symrot.propagation.kernels import error_blocks, formula_deviations
from symrot.propagation.method import choose_method
from symrot.propagation.motion import Motion
from symrot.propagation.polynomials import Piece, fitted, rows_of
from symrot.propagation.propagator import Propagator
from symrot.propagation.stepping import Floats, Recording, Stats, both_sides
from symrot.scene import Initial
from symrot.scene_kernel import SceneKernel, bind

__all__ = ["SwitchedMotion", "SwitchedPropagator"]

MOST_SWITCHES = 1_000_000
CHATTER, CHATTERING = 50, 1e-9  # so many switches within that part of the span are endlessly many
ROOM = 4  # steps in the first piece after a switch; twice as many in each piece after it
WINDOWS = 64  # pieces of the span that SciPy follows at a time, at first
STATES = frozenset({*(f"omega_{i}" for i in (1, 2, 3)), *(f"q{i}" for i in range(4))})
Modes = dict[str, int]
Consumer = Callable[["Chunk"], None]


class Chunk(NamedTuple):
    """A part of a motion from ``start`` to ``stop``, s: its states there at any time, and as polynomials."""

    start: float
    stop: float
    states: Callable[[Floats], Floats]
    piece: Piece


class _Guard(NamedTuple):
    """A formula that is positive as long as its switch keeps its mode, and the change of the mode where it is not."""

    mode: str
    formula: str
    change: int  # 0: to the opposite sign; 1, -1: to that side, or by that much
    where: tuple[str, int] | None


class SwitchedPropagator(Propagator):
    """Propagates a scene under torques with switches; made by :func:`symrot.propagator`."""

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial, switched=True)

    def _prepare(self, plan: Plan) -> Motion:
        return SwitchedMotion(plan, choose_method(plan, self._method), self.tolerance)


class SwitchedMotion(Motion):
    """A motion under torques with switches."""

    movable = False  # guards name the time of the scene
    switched = True

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
            guard = float(evaluate(switch["guard"], values, MATH, float))
            modes[switch["mode"]] = math.floor(guard) if switch["kind"] == "floor" else -1 if guard < 0.0 else 1
            values[switch["mode"]] = float(modes[switch["mode"]])
            if guard == 0.0 and switch["kind"] == "sign" and names(switch["guard"]) & STATES:
                undecided.add(switch["mode"])
        return modes, undecided

    def regime(self, held: frozenset[str]) -> "_Regime":
        """Return the smooth motion while the guards of some modes stay at zero; derived when first asked for."""
        if held not in self._regimes:
            motion: Motion = self
            if held:
                torques = [
                    {**torque, "held": sorted(m for m in torque.get("parameters", ()) if torque["prefix"] + m in held)}
                    for torque in self.plan.structure["torques"]
                ]
                plan = replace(self.plan, structure=self.plan.structure | {"torques": torques})
                motion = Motion(plan, self.choice, self.tolerance)
            self._regimes[held] = _Regime(self, motion, held)
        return self._regimes[held]

    @cached_property
    def _regimes(self) -> dict[frozenset[str], "_Regime"]:
        return {}

    def integrate(self, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
        """Return the states at the times, shape (n, N), and what it cost."""
        began, states = perf_counter(), np.empty((len(times), len(self.plan.states)))
        cost, done = np.zeros(3, dtype=np.int64), np.empty(0, dtype=np.intp)
        switching: list[float] = []
        for part in both_sides(times, self.start):
            sorted_times = times[part]
            count = int((sorted_times == self.start).sum())
            states[part[:count]] = self.plan.initial_state
            run = _Run(self, float(sorted_times[-1]))

            def sample(chunk: Chunk, part: Any = part, sorted_times: Floats = sorted_times) -> None:
                nonlocal count
                last = count + int((np.abs(sorted_times[count:] - self.start) <= abs(chunk.stop - self.start)).sum())
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
            switching += run.switching
        accepted, rejected, evaluations = map(int, cost)
        seconds, times_of = perf_counter() - began, tuple(sorted(switching))
        return states, Stats(accepted, rejected, evaluations, seconds, len(switching), times_of)

    def parts(self, end: float, broken: list[PropagationError]) -> "tuple[list[Piece], Recording]":
        """Return the motion from its start to an end as polynomials and at any time; what cut it off in ``broken``."""
        chunks: list[Chunk] = []
        run = _Run(self, end)
        try:
            run.follow(chunks.append)
        except CutOff as error:
            broken.append(error)
        accepted, rejected, evaluations = map(int, run.cost)
        stats = Stats(accepted, rejected, evaluations, 0.0, len(run.switching), tuple(sorted(run.switching)))
        states = _SwitchedRecording(self.start, self.plan.initial_state, (self.start, end), stats, chunks)
        return [chunk.piece for chunk in chunks], states

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return the states as a function of time."""
        chunks: list[Chunk] = []
        cost, began, switching = np.zeros(3, dtype=np.int64), perf_counter(), list[float]()
        for end in {min(*span, self.start), max(*span, self.start)} - {self.start}:
            run = _Run(self, end)
            run.follow(chunks.append)
            cost += run.cost
            switching += run.switching
        accepted, rejected, evaluations = map(int, cost)
        seconds, times_of = perf_counter() - began, tuple(sorted(switching))
        stats = Stats(accepted, rejected, evaluations, seconds, len(switching), times_of)
        return _SwitchedRecording(self.start, self.plan.initial_state, span, stats, chunks)


MATH: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp, "log": math.log, "abs": abs,
    "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh, "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "atan2": math.atan2,
}  # fmt: skip


class _SwitchedRecording(Recording):
    def __init__(
        self, t0: float, y0: tuple[float, ...], span: tuple[float, float], stats: Stats, chunks: list[Chunk]
    ) -> None:
        super().__init__(t0, np.array(y0), (min(*span, t0), max(*span, t0)), stats)
        self._chunks = sorted(chunks, key=lambda chunk: min(chunk.start, chunk.stop))
        self._ends = np.array([max(chunk.start, chunk.stop) for chunk in self._chunks])

    def _fill(self, times: Floats, states: Floats) -> None:
        places = np.searchsorted(self._ends, times)
        for place in np.unique(places):
            if place == len(self._chunks):
                states[places == place] = np.nan  # beyond where the motion was cut off
            else:
                chosen = places == place
                states[chosen] = self._chunks[place].states(times[chosen])


class _Regime:
    """The smooth motion while some guards stay at zero, and the guards that end it."""

    def __init__(self, switched: SwitchedMotion, motion: Motion, held: frozenset[str]) -> None:
        self.motion, self.plan, self.held, self.constants = motion, motion.plan, held, switched.constants
        self.guards = [guard for switch in switched.switches for guard in self._guards(switch)]
        known = {*self.constants, *(switch["mode"] for switch in switched.switches)}
        nodes = [parse(guard.formula) for guard in self.guards]
        self.more = sorted(known & set().union(*map(names, nodes)))
        self.events = [Event(guard.formula, terminal=True, direction=-1) for guard in self.guards]
        columns = {name: f"{name} of the scene" for name in self.more}  # a kernel has names of its own for constants
        columns |= {f"{mode}_of_t": f"{mode} of t" for mode in held}
        program = _with_parameters(motion.kernel.quantities, [columns[name] for name in self.more])
        formulas = [rename(node, columns) for node in nodes]
        source = guard_library_source(program, formulas, self.plan.states, *error_blocks(self.plan))
        self.path = library.build(source, "events")
        self._bound: dict[tuple[int, ...], tuple[list[float], list[float]]] = {}

    def _guards(self, switch: Mapping[str, Any]) -> Iterator[_Guard]:
        mode, where = switch["mode"], switch["where"]
        if mode in self.held:
            yield _Guard(mode, f"1 - {mode}_of_t", 1, where)
            yield _Guard(mode, f"1 + {mode}_of_t", -1, where)
        elif switch["kind"] == "sign":
            yield _Guard(mode, f"{mode}*({text(switch['guard'])})", 0, where)
        else:
            yield _Guard(mode, f"({text(switch['guard'])}) - {mode}", -1, where)
            yield _Guard(mode, f"{mode} + 1 - ({text(switch['guard'])})", 1, where)

    def bound(self, modes: Modes) -> tuple[list[float], list[float]]:
        """Return the parameters of the stepper's library and of the guards' for some modes."""
        key = tuple(modes.values())
        if key not in self._bound:
            constants = {**self.constants, **{name: Fraction(value) for name, value in modes.items()}}
            kernel: SceneKernel = self.motion.kernel
            rates = bind(kernel.rate_parameters, constants)
            if self.motion.choice.method == "taylor":
                rates += self.motion.taylor_parameters[len(rates) :]
            guards = [*bind(kernel.quantity_parameters, constants), *(float(constants[name]) for name in self.more)]
            self._bound[key] = rates, guards
        return self._bound[key]

    def active(self, modes: Modes) -> list[bool]:
        """Return which guards matter."""
        return [guard.where is None or modes[guard.where[0]] == guard.where[1] for guard in self.guards]


def _with_parameters(program: Program, more: list[str]) -> Program:
    """Return a program with further parameters, which its outputs do not use."""
    arguments = list(program.signature.arguments)
    place = next((k for k, argument in enumerate(arguments) if argument.name == "p"), None)
    extra = tuple((name, "", "") for name in more)
    if place is None:
        arguments.insert(2, Argument("p", "in", extra))
    else:
        arguments[place] = replace(arguments[place], components=(*arguments[place].components, *extra))
    return replace(program, signature=replace(program.signature, arguments=tuple(arguments)))


class _Run:
    """A motion on its way from the start to one end."""

    def __init__(self, motion: SwitchedMotion, end: float) -> None:
        self.motion, self.end, self.span = motion, end, abs(end - motion.start)
        self.t, self.y = motion.start, np.array(motion.plan.initial_state, dtype=np.float64)
        self.modes, self.held = motion.initial_modes(), frozenset[str]()
        self.cost = np.zeros(3, dtype=np.int64)  # steps accepted and rejected, evaluations
        self.switching: list[float] = []
        self.flipped: dict[str, int] = {}  # modes changed at this very time, and how often
        self.released: set[str] = set()  # modes whose guards were held until this very time: they leave zero slowly
        self.left: set[tuple[str, int]] = set()  # modes and their values left at this very time
        self.settled = 0
        self.recent: deque[float] = deque(maxlen=CHATTER)

    def follow(self, consume: Consumer) -> None:
        """Follow the motion to its end, handing on each part as it is known."""
        self._check_start()
        while self.t != self.end:
            regime = self.motion.regime(self.held)
            guard = self._segment(regime, consume)
            if guard is not None:
                self._switch(regime, guard)

    def _check_start(self) -> None:
        """Refuse a start on a switch from which both sides lead away: the motion has more than one way on."""
        for switch in self.motion.switches:
            mode = switch["mode"]
            inactive = switch["where"] and self.modes[switch["where"][0]] != switch["where"][1]
            if mode not in self.motion.undecided or inactive or self.t == self.end:
                continue
            regime, leaving = self.motion.regime(self.held), 0
            for sign in (1, -1):
                rates, values = regime.bound({**self.modes, mode: sign})
                piece, _ = next(self._source(regime, rates).pieces())
                signs, _ = signs_at_ends(regime.path, [guard.formula for guard in regime.guards], values, piece)
                leaving += all(s > 0 for s, guard in zip(signs, regime.guards, strict=True) if guard.mode == mode)
            if leaving == 2:
                way = "past" if self.end < self.motion.start else "future"
                raise CutOff(self.t, f"the motion starts on {self._name(mode)} and has more than one {way}", self.end)

    def _source(self, regime: _Regime, rates: list[float]) -> Any:
        return _SOURCES[self.motion.choice.method.partition(":")[0]](self, regime, rates)

    def _segment(self, regime: _Regime, consume: Consumer) -> _Guard | None:
        """Follow one smooth part; return the guard that ended it, or None at the end of the motion."""
        rates, values = regime.bound(self.modes)
        active = regime.active(self.modes)
        events = [
            event if on else event._replace(terminal=False) for event, on in zip(regime.events, active, strict=True)
        ]
        source = self._source(regime, rates)
        start, passed = self.t, [self.t]
        violated: list[_Guard] = []

        def watched() -> Generator[Piece, None, None]:
            for piece, states in source.pieces():
                first, last = self._negative(regime, active, values, piece)
                first = [guard for guard in first if guard.mode not in self.released or guard in last]
                if passed[-1] == start and (first or self._settle(regime, active, piece, states)):
                    violated.extend(first)
                    return
                current[:] = [(piece, states)]
                yield piece
                if last:  # though no crossing was seen: within rounding it was there from the start of the piece
                    violated.extend(last)
                    if passed[-1] != start:
                        self.t, self.y = passed[-1], states(np.array(passed[-1:]))[0]
                        self.flipped, self.left, self.released = {}, set(), set()
                    return
                consume(Chunk(passed[-1], float(piece.edges[-1]), states, piece))
                passed.append(float(piece.edges[-1]))

        current: list[tuple[Piece, Callable[[Floats], Floats]]] = []
        watching = watched()
        try:
            found, stop = search(regime.path, events, values, watching, start)
        finally:
            watching.close()
            self.cost += source.cost()
        if violated:
            return violated[0]
        if stop is None:
            self.t = self.end if current else self.t  # a mode was settled: once more from here
            return None
        piece, states = current[0]
        if abs(stop - self.motion.start) > abs(passed[-1] - self.motion.start):
            rows = int((np.abs(piece.edges[:-1] - start) < abs(stop - start)).sum())
            consume(Chunk(passed[-1], stop, states, Piece(np.append(piece.edges[:rows], stop), piece.rows[:rows])))
        self.y = states(np.array([stop]))[0]
        self.t = stop
        self.flipped, self.left, self.released = {}, set(), set()
        ended = next(each.event for each in reversed(found) if each.t == stop and active[each.event])
        return regime.guards[ended]

    def _negative(
        self, regime: _Regime, active: list[bool], values: list[float], piece: Piece
    ) -> tuple[list[_Guard], list[_Guard]]:
        """Return the guards that are on the wrong side from the start of a piece on, and those that are at its end."""
        formulas = [guard.formula for guard in regime.guards]
        first, last = (
            [guard for guard, on, sign in zip(regime.guards, active, signs, strict=True) if on and sign < 0]
            for signs in signs_at_ends(regime.path, formulas, values, piece)
        )
        return first, last

    def _settle(self, regime: _Regime, active: list[bool], piece: Piece, states: Callable[[Floats], Floats]) -> bool:
        """Give each mode whose guard is zero, and stays it, its value at zero; return whether a mode changed.

        A mode that is 0 takes the sign of its guard as soon as that is other than zero.
        """
        formulas, settled = [guard.formula for guard in regime.guards], dict(self.modes)
        resting = {s["mode"]: 1 for s in self.motion.switches if s["kind"] == "sign" and self.modes[s["mode"]] == 0}
        alive = {**self.modes, **resting}
        signs, _ = signs_at_ends(regime.path, formulas, regime.bound(alive)[1], piece)
        end = float(piece.edges[-1])
        later = end, states(np.array([end]))[0]  # a guard may leave zero more slowly than rounding shows
        for switch in self.motion.switches:
            mode = switch["mode"]
            numbers = [n for n, guard in enumerate(regime.guards) if guard.mode == mode and active[n]]
            if mode in self.held or not numbers:
                continue
            sign = signs[numbers[0]]
            if switch["kind"] == "floor":  # closed on the left: at n + 1 it is n + 1
                upper = signs[numbers[1]]
                if not upper and self._guard_value(switch["guard"]) == self.modes[mode] + 1:
                    settled[mode] = self.modes[mode] + 1
                continue
            if sign and self.modes[mode] == 0:
                settled[mode] = sign
            elif not sign and self._guard_value(switch["guard"]) == 0.0 == self._guard_value(switch["guard"], later):
                settled[mode] = switch["at_zero"]
        changed = settled != self.modes
        if changed:
            self.settled += 1
            if self.settled > MOST_SWITCHES:
                raise CutOff(self.t, "its switches settle endlessly", self.end)
        self.modes = settled
        return changed

    def _guard_value(self, guard: Any, place: tuple[float, Floats] | None = None) -> float:
        """Return a guard at a time and a state, or at the present ones, under the present modes."""
        t, y = place or (self.t, self.y)
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if self.motion.plan.structure["attitude"] else []
        quantities = self.motion.evaluate(np.array([t]), y[None], names)[0].tolist()
        values = {name.removesuffix(" of t"): value for name, value in zip(names, quantities, strict=True)}
        values |= {name: float(value) for name, value in self.motion.constants.items()}
        values |= {"t": t, **{name: float(mode) for name, mode in self.modes.items()}}
        return float(evaluate(guard, values, MATH, float))

    def _switch(self, regime: _Regime, guard: _Guard) -> None:
        """Change the mode of a guard; hold the guard at zero where both sides send the motion back."""
        mode, switch = guard.mode, next(s for s in self.motion.switches if s["mode"] == guard.mode)
        kind = switch["kind"]
        self.left.add((mode, self.modes[mode]))
        again = self.flipped.get(mode, 0)
        if again == 0:
            self._count()
        self.flipped[mode] = again + 1
        if again > 2 and kind == "sign":
            raise CutOff(self.t, f"the switch {self._name(mode)} leaves no way to go on", self.end)
        if mode in self.held:
            self.held -= {mode}
            self.modes[mode] = guard.change
            self.released.add(mode)
        elif again and kind == "sign":
            self._hold(regime, mode)
        elif kind == "sign":
            self.modes[mode] = -self.modes[mode]
        else:
            whole = math.floor(self._guard_value(switch["guard"]))
            far = abs(whole - self.modes[mode]) > 1  # it jumped over some whole numbers
            self.modes[mode] = whole if far else self.modes[mode] + guard.change
            if (mode, self.modes[mode]) in self.left:
                raise CutOff(self.t, f"the motion would slide along the jump of {self._name(mode)}", self.end)

    def _hold(self, regime: _Regime, mode: str) -> None:
        if self.end < self.motion.start:
            raise CutOff(self.t, "a motion that slides along a switch has more than one past", self.end)
        self.held |= {mode}
        guard = next(switch["guard"] for switch in self.motion.switches if switch["mode"] == mode)
        if guard[0] == "symbol" and guard[1] in regime.plan.states:
            self.y[regime.plan.states.index(guard[1])] = 0.0  # exactly, where the guard is a state
        try:
            self.motion.regime(self.held)
        except InputError:
            raise CutOff(
                self.t, f"the motion would slide along {self._name(mode)}, in no single way", self.end
            ) from None

    def _count(self) -> None:
        self.switching.append(self.t)
        self.recent.append(self.t)
        near = len(self.recent) == CHATTER and abs(self.t - self.recent[0]) <= CHATTERING * self.span
        if near or len(self.switching) > MOST_SWITCHES:
            within = f"{CHATTER} within {abs(self.t - self.recent[0]):.1e} s" if near else f"more than {MOST_SWITCHES}"
            raise CutOff(self.t, f"its switches follow one another endlessly ({within})", self.end)

    def _name(self, mode: str) -> str:
        return next(str(switch["label"]) for switch in self.motion.switches if switch["mode"] == mode)


class _Stepped:
    """Pieces of a motion by a stepper in C."""

    def __init__(self, run: _Run, regime: _Regime, rates: list[float]) -> None:
        motion = regime.motion
        assert motion.library is not None
        if not np.isfinite(run.y).all():
            raise CutOff(run.t, "its states are not finite there", run.end)
        stepping = taylor if motion.choice.method == "taylor" else dop853
        self.task = stepping.task(motion.library, rates, run.y, run.t, motion.tolerance)
        self.task.way, self.end = run.span, run.end

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        task, room = self.task, ROOM
        for run in task.runs(self.end):
            while run.t != run.stop:
                rows = np.empty((room, task.stepper.row))
                try:
                    task.advance(run, None, 0, None, rows.ctypes.data, room)
                except CutOff as error:
                    stuck: CutOff | None = error
                else:
                    stuck = None
                rows = rows[: run.recorded]
                if len(rows):

                    def states(times: Floats, rows: Floats = rows) -> Floats:
                        inside: Floats = task.stepper.dense(rows, times)
                        return inside

                    yield Piece(np.append(rows[:, 0], run.t), rows_of(task.stepper, rows)), states
                if stuck is not None:
                    raise stuck
                room = min(2 * room, task.stepper.rows_per_call)

    def cost(self) -> Any:
        return np.array([self.task.accepted, self.task.rejected, self.task.evaluations])


class _Windows:
    """Pieces of a motion by SciPy: a window of time after the other."""

    def __init__(self, run: _Run, regime: _Regime, rates: list[float]) -> None:
        self.run, self.motion, self.rates, self.counts = run, regime.motion, rates, np.zeros(3, dtype=np.int64)

    def pieces(self) -> Iterator[tuple[Piece, Callable[[Floats], Floats]]]:
        from symrot.propagation import fallback

        run, t, y = self.run, self.run.t, self.run.y
        side = 1.0 if run.end >= t else -1.0
        length = run.span / WINDOWS
        while t != run.end:
            stop = run.end if abs(run.end - t) <= 1.01 * length else t + side * length
            share = max(abs(stop - t) / run.span, 1e-3)
            options = self.motion.scipy_options
            options["deviations"] = formula_deviations(self.motion.plan, self.motion.kernel, self.rates)
            recording = fallback.record(
                self.motion.rates, self.rates, y, t, (t, stop), run.motion.tolerance * share, **options
            )
            self.counts += recording.stats[:3]
            for edges in recording.edges(t, stop):
                yield fitted(recording, edges, *error_blocks(self.motion.plan)), recording
            y, t, length = recording(stop), stop, 2.0 * length

    def cost(self) -> Any:
        return self.counts


_SOURCES: dict[str, Any] = {"taylor": _Stepped, "dop853": _Stepped, "scipy": _Windows}
