"""Derivatives of motions under torques that jump or bend: variational equations from one switch to the next.

A switching function (sign, abs, ..) has a *guard* g(t, x, p), its argument, and a *mode*, the number that replaces it
in formulas. Where g becomes zero, the rates change from f- to f+, and the derivatives S of the states x by a variable v
jump. The time of the switch changes by ``dt/dv = -(g_x S- + g_p dp/dv)/(g_t + g_x f-)``, and ::

    S+ = S- - (f+ - f-) dt/dv

(saltation matrix). It holds if the motion crosses the zero with a speed other than zero, and also if the guard is
*held* at zero from then on; f+ are then the rates of the sliding motion. At a kink and at the end of sliding, f+ = f-.
Source: M. A. Aizerman, F. R. Gantmakher, On the stability of periodic motions, J. Appl. Math. Mech. 22 (1958) 1065.
"""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.codegen.duals import Dual, dual_functions
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Program
from symrot.formula.switches import STATES
from symrot.formula.tree import evaluate, names
from symrot.planning.general_structure import constants_of
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH, Parameters
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.binding import value_of
from symrot.propagation.events.event_result import EventResult
from symrot.propagation.method import choose_method
from symrot.propagation.sensitivities.event_times import TOUCHING, along_motion, event_time_slopes
from symrot.propagation.sensitivities.variables import STEP, difference, read_variables, slopes
from symrot.propagation.sensitivities.variation import (
    AT_ONCE,
    TOLERANCE,
    Column,
    columns_of,
    follow_columns,
    motion_library,
    rates_of,
    structure_of,
    unit_of,
)
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.motion import SwitchedMotion
from symrot.propagation.switched.regimes import Modes, Regime
from symrot.propagation.switched.run import Chunk, SwitchedRun
from symrot.propagation.switched.system import SwitchedSystem, is_continuous
from symrot.results.sensitivity import SwitchSlopes
from symrot.scene.scene import Scene

__all__ = ["SwitchedEquations"]

Floats = NDArray[np.float64]
AT_ZERO = 1e-9  # a guard nearer to zero, in units of the size of its terms, is zero at a switch
STEEP = 1e-5  # speed of a guard at a crossing, in units of its mean speed: a slower one grazes zero
ALIKE = 1e-9  # relative difference of two derivatives that count as equal
GRAZE = 1e-9  # smallest distance of a guard from zero, relative to the largest in an interval, that does not touch zero
NEARBY = 0.1  # part of the largest distance, below which a smallest distance is examined
FINE, ZOOMS = 8, 12  # points in a step of a motion, and the number of times that the points are refined
MARGIN = 10.0  # times the tolerance: an error of an event time, as part of the length of the motion
AT_SWITCH = 1e-12  # part of the time: an event this near to a switch is at the switch
MOST_AT_ONCE = 6  # functions that may switch at one time
Rows = Mapping[str, list[float]]
"""For parameters, by name: the derivatives by each variable."""


@dataclass(eq=False)
class _Part:
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


class _Gradient(NamedTuple):
    """The value of a formula g, its derivatives by time and states, those by the variables through parameters."""

    value: float
    time: float
    states: Floats
    variables: Floats

    def along(self, rates: Floats) -> float:
        """Return the derivative of the formula along a motion with the given rates of the states."""
        return self.time + float(self.states @ rates)

    def size(self, rates: Floats) -> float:
        """Return the sum of the absolute terms of :meth:`along`."""
        return abs(self.time) + float(np.abs(self.states) @ np.abs(rates))

    def change(self, slopes_of_states: Floats) -> Floats:
        """Return the derivatives of the formula by the variables, at fixed time, for those of the states, (7, m)."""
        return np.asarray(self.states @ slopes_of_states + self.variables)


class _Flip(NamedTuple):
    """The switch of one function: its new mode, the derivatives of its time by variables, of its guard by states."""

    value: int
    time: Floats
    guard: Floats


class SwitchedEquations:
    """The equations of a motion under torques that switch, and of its derivatives by variables."""

    def __init__(self, scene: Scene, keys: Sequence[str], varying: Collection[str] = ()) -> None:
        self.scene, self.keys, self.variables = scene, keys, read_variables(scene, keys)
        self.columns = columns_of(scene, self.variables)
        self.restartable = all(column.restartable for column in self.columns)
        self.structure = structure_of(scene, self.columns, varying)
        self._changes = [self._changes_of(column) for column in self.columns]
        self._walks: list[_Walk] = []

    def fit(self, scene: Scene, keys: Sequence[str]) -> bool:
        """Return whether these are the equations of a scene and its derivatives by the variables ``keys``."""
        own = self.scene
        same = own.body is scene.body and own.torques is scene.torques and keys == self.keys
        return same and (self.restartable or own.initial == scene.initial)

    def follow(self, scene: Scene, times: Floats, begin: float | None = None) -> tuple[Floats, Floats]:
        """Return the states at times, shape (n, 7), and their derivatives by each variable, shape (n, 7, variables).

        Derivatives are NaN exactly at a switch at which they jump. ``begin``, s, is the initial time.
        """
        begin = float(scene.span.start) if begin is None else begin
        start = np.array([float(x) for x in (*scene.initial.omega_b, *scene.initial.quaternion)])
        states = np.tile(start, (len(times), 1))
        columns = np.array([column.start_from(scene.initial) for column in self.columns]).T
        by = np.tile(columns, (len(times), 1, 1))
        for side in (1.0, -1.0):
            chosen = side * times > side * begin
            if chosen.any():
                walk = self._walk(scene, begin, float((side * times[chosen]).max()) * side)
                states[chosen], by[chosen] = walk.sample(times[chosen])
        return states, by

    def event_slopes(self, scene: Scene, result: EventResult, tolerance: float) -> tuple[Floats, ...]:
        """Return one array for each event: derivatives of its k times by the m variables, shape (k, m).

        ``tolerance`` is the error of the motion of ``result``.
        """
        begin, every = float(scene.span.start), []
        for event, kinds, times in zip(result.events, result.kinds, result.t_events, strict=True):
            rows = np.full((len(times), len(self.columns)), np.nan)
            for k, (kind, t) in enumerate(zip(kinds, times.tolist(), strict=True)):
                sides = [self._at_start(scene)] if t == begin else self._walk(scene, begin, t).sides(t, tolerance)
                rows_by_side = [
                    event_time_slopes(event, [kind], np.array([t]), y[None], rate[None], by[None])[0]
                    for y, rate, by in sides
                ]
                speeds = [along_motion(event, t, y, rate) if kind != TOUCHING else 0.0 for y, rate, _ in sides]
                rows[k] = rows_by_side[0]
                # the formula stays at zero after the switch, as omega_3 of a wheel that dry friction stops
                if len(rows_by_side) == 2 and abs(speeds[1]) > AT_ZERO * abs(speeds[0]):
                    rows[k] = np.where(_alike(*rows_by_side), rows_by_side[0], np.nan)
                    if abs(speeds[0]) <= AT_ZERO * abs(speeds[1]):
                        rows[k] = rows_by_side[1]
            every.append(rows)
        return tuple(every)

    def switchings(self, scene: Scene, times: Floats) -> tuple[SwitchSlopes, ...]:
        """Return the switches on the way to ``times``, s, with the derivatives of their times by the variables."""
        begin, every = float(scene.span.start), []
        for side in (1.0, -1.0):
            chosen = side * times > side * begin
            if chosen.any():
                end = float((side * times[chosen]).max()) * side
                every += [each for each in self._walk(scene, begin, end).switchings if side * each.t <= side * end]
        return tuple(every)

    def _at_start(self, scene: Scene) -> tuple[Floats, Floats, Floats]:
        begin = float(scene.span.start)
        walk = self._walk(scene, begin, float(scene.span.stop))
        part = walk.parts[0]
        return part.first, walk.rates(part, part.start, part.first), part.before

    def _walk(self, scene: Scene, begin: float, end: float) -> "_Walk":
        for walk in self._walks:
            if walk.covers(scene, begin, end):
                return walk
        walk = _Walk(self, scene, begin, end)
        self._walks = [walk, *self._walks[:1]]
        return walk

    def _changes_of(self, column: Column) -> Mapping[str, Fraction]:
        """Return the derivatives of the constants of the equations by a variable, without those that are zero."""
        if not column.constants:
            return {}
        return difference(self.scene, column.variable, lambda other: constants_of(other, self.structure))

    def depends(self, parameters: Parameters, column: int) -> list[str]:
        """Return the names of the parameters, pairs (name, formula), that depend on the variable number ``column``."""
        return [name for name, formula in parameters if names(formula) & self._changes[column].keys()]

    def slopes_of(self, parameters: Parameters, constants: Mapping[str, Fraction]) -> Rows:
        """Return the derivatives of parameters by the m variables, by name, if one of them is not zero."""
        rows: dict[str, list[float]] = {}
        for k, column in enumerate(self.columns):
            own, changes = set(self.depends(parameters, k)), self._changes[k]
            moving = [(name, formula) for name, formula in parameters if name in own]
            if not moving:
                continue

            def values(change: Fraction, changes: Any = changes, moving: Any = moving) -> dict[str, Fraction]:
                moved = {**constants, **{name: constants[name] + change * slope for name, slope in changes.items()}}
                return {name: value_of(formula, moved) for name, formula in moving}

            variable = column.variable
            step = abs(variable.value) * STEP if variable.value else STEP
            for name, slope in slopes(values, step, variable.name).items():
                rows.setdefault(name, [0.0] * len(self.columns))[k] = float(slope)
        return rows


class _Walk:
    """A motion in one direction of time, in smooth intervals, with its derivatives at their ends.

    Parameters
    ----------
    equations : SwitchedEquations
        The equations and the variables.
    scene : Scene
        The scene with the initial state.
    begin, end : float
        Initial and last time, s.
    """

    def __init__(self, equations: SwitchedEquations, scene: Scene, begin: float, end: float) -> None:
        self.equations, self.scene, self.begin, self.end = equations, scene, begin, end
        self.side = 1.0 if end > begin else -1.0
        own = replace(scene, span=scene.span._replace(start=Fraction(begin)))
        plan = Plan(own, equations.structure, ())
        self.motion = SwitchedMotion(plan, choose_method(plan, "taylor"), TOLERANCE)
        self.system: SwitchedSystem = self.motion.system
        self.by_name = {switch.mode: switch for switch in self.system.switches}
        self.switchings: list[SwitchSlopes] = []
        self._rates: dict[int, tuple[Program, Parameters]] = {}
        self._slopes: dict[Any, Rows] = {}
        self._constants = {"pi": number.PI, **constants_of(scene, equations.structure)}
        self.length = abs(end - begin)
        self._last: tuple[_Part, Instant, dict[str, _Flip], bool] | None = None  # the last jump of the rates
        self._units = [unit_of(scene, column) for column in equations.columns]
        self.parts, self.changes = self._smooth_parts()
        self._differentiate()

    def covers(self, scene: Scene, begin: float, end: float) -> bool:
        """Return whether this motion starts as ``scene`` does, at ``begin``, and reaches the time ``end``, s."""
        own = self.scene
        same = own.body is scene.body and own.torques is scene.torques and own.initial == scene.initial
        same &= self.begin == begin
        return same and self.side * (end - begin) > 0.0 and self.side * (self.end - end) >= 0.0

    # ---------------------------------------------------------------------------------------------- smooth intervals

    def _smooth_parts(self) -> tuple[list[_Part], dict[tuple[float, str], str]]:
        parts: list[_Part] = []
        run = SwitchedRun(self.motion, self.system, self.end)

        def add(chunk: Chunk) -> None:
            start, stop = chunk.start - chunk.zero, chunk.stop - chunk.zero
            if stop == start:
                return
            last = chunk.own_states(np.array([stop]))[0]
            part = parts[-1] if parts else None
            if part and part.zero == chunk.zero and part.modes == run.modes and part.held == run.held:
                part.stop, part.last = stop, last
                part.chunks.append(chunk)
                return
            first = chunk.own_states(np.array([start]))[0]
            regime = self.system.regime(run.held, run.modes)
            parts.append(_Part(regime, dict(run.modes), run.held, chunk.zero, start, stop, first, last, [chunk]))

        try:
            run.follow(add)
        except IntegrationStopped as error:
            raise PropagationError(f"{self.scene.name}: sensitivities: {error}") from None
        return parts, run.changes

    def _stop(self, instant: Instant, reason: str) -> PropagationError:
        return PropagationError(
            f"{self.scene.name}: sensitivities: expected a motion with derivatives, but they do not exist "
            f"{'after' if self.side > 0.0 else 'before'} t = {instant.high!r} s: {reason}"
        )

    def _name(self, mode: str) -> str:
        return self.by_name[mode].label

    def _held_at_rest(self, part: _Part) -> None:
        """Hold the guards that stay at zero in an interval; list in ``resting`` those that cannot be held."""
        resting = [mode for mode in part.regime.formulas if mode not in part.held and self._rests(part, mode)]
        for mode in resting:
            # the square of the argument times its sign, for example, has a derivative at zero
            if self._is_smooth_at(part, mode):
                continue
            held = part.held | {self.system.twins[mode][0][0]} if self.by_name[mode].kind == "sign" else part.held
            if part.modes[mode] == 0 and held != part.held:
                own = part.regime, part.held
                try:
                    part.regime, part.held = self.system.regime(held, part.modes), held
                    determined = bool(np.isfinite(self.rates(part, part.start, part.first)).all())
                except (InputError, ArithmeticError):
                    determined = False
                if determined:
                    continue
                part.regime, part.held = own
            part.resting.append(mode)

    def _refuse_resting(self, part: _Part) -> None:
        """Raise PropagationError if a variable moves a guard that stays at zero, where a jump or kink is."""
        for mode in part.resting:
            places = list(self._places(part))
            _, every = self._integrate(part, np.array([t for t, _ in places]))
            if any(self._guard(part, mode, *place).change(by).any() for place, by in zip(places, every, strict=True)):
                raise self._stop(part.begin, f"the argument of {self._name(mode)} stays at zero")

    def _places(self, part: _Part) -> Iterator[tuple[float, Floats]]:
        middle = part.chunks[len(part.chunks) // 2]
        t = 0.5 * ((middle.start - part.zero) + (middle.stop - part.zero))
        yield part.start, part.first
        yield t, middle.own_states(np.array([t]))[0]
        yield part.stop, part.last

    def _rests(self, part: _Part, mode: str) -> bool:
        """Return whether the guard of a mode is zero at the start, near the middle and at the end of an interval."""
        return all(self._guard(part, mode, *place).value == 0.0 for place in self._places(part))

    def _is_smooth_at(self, part: _Part, mode: str) -> bool:
        """Return whether the rates and their derivatives are the same on both sides of a guard that stays at zero."""
        twins = [twin for twin, _ in self._twins(mode)]
        for t, y in self._places(part):
            sides = []
            for sign in (1, -1):
                changed = {**part.modes, **{twin: s * sign for twin, s in self._twins(mode)}}
                if self.by_name[mode].kind == "floor":
                    changed = {**part.modes, mode: part.modes[mode] - (sign < 0)}
                sides.append(self._rate_slopes(replace(part, modes=changed), t, y))
            if not np.array_equal(sides[0], sides[1]):
                return False
        return bool(twins)

    # ------------------------------------------------------------------------------------------------- formulas

    def program(self, part: _Part) -> tuple[Program, Parameters]:
        """Return the rates of an interval as a program, with the formulas of their parameters."""
        key = id(part.regime)
        if key not in self._rates:
            self._rates[key] = rates_of(part.regime.plan)
        return self._rates[key]

    def _bound(self, parameters: Parameters, part: _Part, kind: str) -> tuple[dict[str, float], Rows]:
        """Return the values of parameters in an interval, by name, and their derivatives by the variables."""
        timed = any(EPOCH in names(formula) for _, formula in parameters)
        key = kind, id(part.regime), tuple(part.modes.values()), part.zero if timed else None
        if key not in self._slopes:
            modes = {name: Fraction(mode) for name, mode in part.modes.items()}
            constants = {**self._constants, **modes, EPOCH: part.zero.exact}
            values = {name: [float(value_of(formula, constants))] for name, formula in parameters}
            self._slopes[key] = values
            self._slopes[(*key, "by")] = self.equations.slopes_of(parameters, constants)
        return {name: value for name, (value,) in self._slopes[key].items()}, self._slopes[(*key, "by")]

    def _duals(self, parameters: Parameters, part: _Part, t: float, y: Floats, kind: str) -> dict[str, Any]:
        """Return the inputs of formulas as dual numbers, by name; the derivatives are by time, states and variables."""
        values, rows = self._bound(parameters, part, kind)
        inputs: dict[str, Any] = {name: float(mode) for name, mode in part.modes.items()}
        for name, value in values.items():
            by = {f"by {k}": slope for k, slope in enumerate(rows.get(name, ())) if slope}
            inputs[name] = Dual(value, by) if by else value
        inputs |= {name: Dual(float(x), {name: 1.0}) for name, x in zip(STATES, y, strict=True)}
        return {**inputs, "t": Dual(t, {"t": 1.0})}

    def _gradient(self, value: Any) -> _Gradient:
        dual = value if isinstance(value, Dual) else Dual(float(value), {})
        by = [float(dual.slopes.get(f"by {k}", 0.0)) for k in range(len(self.equations.columns))]
        states = np.array([float(dual.slopes.get(name, 0.0)) for name in STATES])
        return _Gradient(float(dual.value), float(dual.slopes.get("t", 0.0)), states, np.array(by))

    def _guard(self, part: _Part, mode: str, t: float, y: Floats) -> _Gradient:
        """Return the guard of a mode in an interval, with its derivatives; for floor(x), x minus the present floor."""
        inputs = self._duals(part.regime.parameters, part, t, y, "guards")
        return self._gradient(evaluate(part.regime.formulas[mode], inputs, DUALS, float))

    def _held_mode(self, part: _Part, mode: str) -> _Gradient:
        """Return the value of a held mode, at the end of an interval, with its derivatives."""
        quantities, parameters = part.regime.quantities, part.regime.quantity_parameters
        inputs = self._duals(parameters, part, part.stop, part.last, "quantities")
        output = f"{mode} of t"
        return self._gradient(quantities.evaluate(inputs, DUALS, float, [output])[output])

    def rates(self, part: _Part, t: float, y: Floats) -> Floats:
        """Return the time derivatives of the seven states in an interval, t s after its instant ``zero``."""
        program, parameters = self.program(part)
        values, _ = self._bound(parameters, part, "rates")
        inputs = {**values, **dict(zip(STATES, y.tolist(), strict=True)), "t": t}
        return np.array(list(program.evaluate(inputs, FLOAT_FUNCTIONS, float).values()), dtype=np.float64)

    def _rate_slopes(self, part: _Part, t: float, y: Floats) -> Floats:
        """Return the rates with all their derivatives by states and variables, one row for each state."""
        program, parameters = self.program(part)
        inputs = self._duals(parameters, part, t, y, "rates")
        rows = [self._gradient(value) for value in program.evaluate(inputs, DUALS, float).values()]
        return np.array([[row.value, *row.states, *row.variables] for row in rows])

    # ------------------------------------------------------------------------------------------------- derivatives

    def _differentiate(self) -> None:
        """Compute the derivatives at the ends of all intervals."""
        by = np.array([column.start_from(self.scene.initial) for column in self.equations.columns]).T
        previous: _Part | None = None
        for part in self.parts:
            self._held_at_rest(part)
            self._refuse_grazing(part)
            by = self._from_start(part, by) if previous is None else self._across(previous, part, by)
            part.before = by
            self._refuse_resting(part)
            _, values = self._integrate(part, np.array([part.stop]))
            by = part.after = values[0]
            previous = part

    def _from_start(self, part: _Part, by: Floats) -> Floats:
        """Return the derivatives just after the start; they differ if friction holds the body from the start on."""
        f = self.rates(part, part.start, part.first)
        for mode in part.regime.formulas:
            if mode in part.held:
                continue
            guard = self._guard(part, mode, part.start, part.first)
            # floor(x) also switches where x minus the present floor is 1
            ends = (0.0, 1.0) if self.by_name[mode].kind == "floor" else (0.0,)
            if guard.value not in ends or self._rests(part, mode):
                continue
            other = part.modes[mode] + (1 if guard.value else -1)
            self._require_constant(part, mode, other, guard.change(by), f)
        held = sorted(part.held)
        guards = [self._guard(part, mode, part.start, part.first) for mode in held]
        changes = np.array([guard.change(by) for guard in guards])
        if not changes.any():
            return by
        for mode in held:
            self._require_one_surface(self._beside(part, {mode: 1}), mode, part.start, part.first)
        # A nearby start leads to the jumps at once. On the way, the rates are f + B s with modes s between -1 and 1;
        # the states change by B c, so that all guards return to zero.
        corners = {
            signs: self.rates(self._beside(part, dict(zip(held, signs, strict=True))), part.start, part.first)
            for signs in product((1, -1), repeat=len(held))
        }
        first = corners[(1,) * len(held)]
        jumps = np.array([(first - corners[tuple(1 - 2 * (mode == other) for other in held)]) / 2.0 for mode in held]).T
        size = ALIKE * max(float(np.abs(rates).max()) for rates in corners.values())
        for signs, rates in corners.items():
            if np.abs(first + jumps @ (np.array(signs) - 1.0) - rates).max() > size:
                raise self._stop(part.begin, f"{' and '.join(map(self._name, held))} switch at once")
        return np.asarray(by - jumps @ np.linalg.solve(np.array([guard.states for guard in guards]) @ jumps, changes))

    def _beside(self, part: _Part, signs: Mapping[str, int]) -> _Part:
        """Return an interval's motion beside guards that are held at zero, on the sides that ``signs`` tells."""
        twins = self.system.twins
        modes = {**part.modes, **{twin: own * sign for mode, sign in signs.items() for twin, own in twins[mode]}}
        held = part.held - frozenset(signs)
        return replace(part, regime=self.system.regime(held, modes), modes=modes, held=held)

    def _require_constant(self, part: _Part, mode: str, other: int, change: Floats, f: Floats) -> None:
        """Raise PropagationError if a variable moves a guard that is zero at the start away from zero.

        ``change``: the derivatives of the guard by the variables; ``other``: the value of floor(x) on the other side.
        """
        if not change.any() or is_continuous(self.by_name[mode]):
            return
        variable = self.equations.variables[int(np.flatnonzero(change)[0])].name
        twins = self._twins(mode)
        flipped = {twin: -part.modes[twin] for twin, _ in twins}
        if self.by_name[mode].kind == "floor":
            flipped = {mode: other}
        beyond = self.rates(replace(part, modes={**part.modes, **flipped}), part.start, part.first)
        if not np.array_equal(beyond, f):
            raise self._stop(
                part.begin,
                f"the motion starts where {self._name(mode)} switches, and a change of {variable} to one side or to "
                "the other has different effects",
            )

    def _across(self, before: _Part, after: _Part, by: Floats) -> Floats:
        """Return the derivatives after a switch between two intervals, and note those of the time of the switch."""
        changed = [
            mode
            for mode, value in after.modes.items()
            if mode not in {*before.held, *after.held, *self.system.tied(before.held), *self.system.tied(after.held)}
            and value != before.modes[mode]
        ]
        held, released = after.held - before.held, sorted(before.held - after.held)
        if not changed and not held and not released:
            return by
        f, later = self.rates(before, before.stop, before.last), self.rates(after, after.start, before.last)
        causes: dict[str, _Gradient] = {}
        for mode in [*changed, *sorted(held)]:
            if mode in before.regime.formulas:
                guard = self._guard(before, mode, before.stop, before.last)
                # a guard with another switching function inside jumps over zero, and follows that function
                if self._is_zero(before, mode, guard, f):
                    causes[mode] = guard
        for mode in sorted(held & before.regime.formulas.keys()):
            self._require_one_surface(before, mode, before.stop, before.last)
        jumps = {mode: guard for mode, guard in causes.items() if not is_continuous(self.by_name[mode])}
        rows: dict[str, Floats] = {}
        for mode, guard in causes.items():
            speed, mean = guard.along(f), self._mean_speed(before, mode)
            grazes = abs(speed) <= STEEP * max(guard.size(f), mean)
            if mode in jumps and mode not in held:
                leaving = guard.along(later)
                grazes |= leaving * speed <= 0.0 or abs(leaving) <= STEEP * max(guard.size(later), mean)
            if grazes and mode in jumps:
                raise self._stop(before.end, f"the argument of {self._name(mode)} reaches zero at a speed near zero")
            rows[mode] = np.full(len(by.T), np.nan) if grazes else 0.0 - guard.change(by) / speed
        if not jumps and float(np.abs(later - f).max()) > STEEP * float(np.abs([f, later]).max()):
            names_of = " and ".join(map(self._name, [*changed, *sorted(held), *released]))
            raise self._stop(before.end, f"the torque jumps where no argument is zero in {names_of}")
        first = next(iter(jumps), None)
        if first is not None:
            flips = {mode: _Flip(after.modes[mode], rows[mode], jumps[mode].states) for mode in jumps}
            alone = not held and set(changed) <= causes.keys()
            change = self._at_once(before, flips, alone)
            self._last = before, after.begin, flips, alone
            if change is not None:
                self._note(after.begin, rows, rows[first])
                return np.asarray(by - change)
        if not causes:
            for mode in released:
                value = self._held_mode(before, mode)
                speed = value.along(f)
                grazes = abs(speed) <= STEEP * value.size(f)
                rows[mode] = np.full(len(by.T), np.nan) if grazes else 0.0 - value.change(by) / speed
        self._note(after.begin, rows, rows[first] if first is not None else None)
        return by if first is None else np.asarray(by - np.outer(later - f, rows[first]))

    def _twins(self, mode: str) -> list[tuple[str, int]]:
        """Return the modes that switch together with a mode, as pairs (mode, 1 or -1)."""
        return self.system.twins.get(mode, [(mode, 1)])

    def _at_once(self, part: _Part, flips: dict[str, _Flip], alone: bool) -> Floats | None:
        """Return the jump of the derivatives where functions switch at once at the end of an interval, shape (7, m).

        None: the functions also switch at once if a variable changes, or only one switches. Otherwise each must change
        the rates by the same amount before and after the others switch, and leave the speeds of their guards unchanged.

        Parameters
        ----------
        part : _Part
            The interval.
        flips : mapping
            The modes that switch.
        alone : bool
            Whether no other function switches, and none is held at zero.
        """
        earlier = self._last
        between = earlier is not None and abs(part.end - earlier[1]) <= AT_SWITCH * max(abs(part.end.high), self.length)
        if earlier is not None and between:
            # a switch within rounding errors of this one; both must be independent of each other
            part, flips, alone = earlier[0], {**earlier[2], **flips}, alone and earlier[3]
        groups: list[list[str]] = []
        for mode, flip in flips.items():
            group = next((each for each in groups if _alike(flips[each[0]].time, flip.time).all()), None)
            groups.append([mode]) if group is None else group.append(mode)
        if len(groups) == 1:
            return None
        refusal = self._stop(part.end, f"{' and '.join(map(self._name, flips))} switch at once")
        if not alone or len(groups) > MOST_AT_ONCE:
            raise refusal
        corners = {}
        for chosen in product((False, True), repeat=len(groups)):
            own = [mode for group, flip in zip(groups, chosen, strict=True) if flip for mode in group]
            modes = {**part.modes, **{mode: flips[mode].value for mode in own}}
            corner = replace(part, modes=modes, regime=self.system.regime(part.held, modes))
            corners[chosen] = self.rates(corner, part.stop, part.last)
        first = corners[(False,) * len(groups)]
        jumps = np.array([corners[tuple(k == n for n in range(len(groups)))] - first for k in range(len(groups))])
        size = ALIKE * max(float(np.abs(rates).max()) for rates in corners.values())
        for chosen, rates in corners.items():
            if np.abs(first + np.array(chosen, dtype=np.float64) @ jumps - rates).max() > size:
                raise refusal
        for k, group in enumerate(groups):
            for mode in group:
                speeds = np.delete(jumps, k, axis=0) @ flips[mode].guard
                if np.abs(speeds).max() > size * float(np.abs(flips[mode].guard).max()):
                    raise refusal
        if between:
            return None
        return np.asarray(jumps.T @ np.array([flips[group[0]].time for group in groups]))

    def _require_one_surface(self, part: _Part, mode: str, t: float, y: Floats) -> None:
        """Raise PropagationError if functions that a motion holds at zero together are separated by a variable."""
        guard = self._guard(part, mode, t, y)
        own = np.array([guard.time, *guard.states, *guard.variables])
        for twin, _ in self._twins(mode):
            if twin not in part.regime.formulas:
                continue
            other = self._guard(part, twin, t, y)
            row = np.array([other.time, *other.states, *other.variables])
            if np.abs(own * (row @ own) - row * (own @ own)).max() > ALIKE * (own @ own) * np.abs(row).max():
                raise self._stop(part.zero.after(t), f"{self._name(mode)} and {self._name(twin)} switch at once")

    def _mean_speed(self, part: _Part, mode: str) -> float:
        """Return how fast a guard changes in an interval, on average, as a scale for its speed at the end."""
        values = [abs(self._guard(part, mode, *place).value) for place in self._places(part)]
        if self.by_name[mode].kind == "floor":
            values = [min(value, abs(1.0 - value)) for value in values]
        return max(values) / abs(part.stop - part.start)

    def _is_zero(self, part: _Part, mode: str, guard: _Gradient, rates: Floats) -> bool:
        """Return whether a guard is zero at the end of an interval; for floor(x): whether x is a whole number."""
        size = guard.size(rates) * abs(part.stop) + float(np.abs(guard.states) @ np.abs(part.last))
        distances = (0.0, 1.0) if self.by_name[mode].kind == "floor" else (0.0,)
        return min(abs(guard.value - zero) for zero in distances) <= AT_ZERO * size

    def _jumps_at_end(self) -> NDArray[np.bool_]:
        """Return for each variable whether the derivatives by it may jump exactly at the end of the motion."""
        part, jumps = self.parts[-1], np.zeros(len(self.equations.columns), dtype=np.bool_)
        f = self.rates(part, part.stop, part.last)
        for guard, on in zip(part.regime.guards, part.regime.active(part.modes), strict=True):
            mode = guard.mode
            if on and mode in part.regime.formulas and mode not in part.held and not is_continuous(self.by_name[mode]):
                gradient = self._guard(part, mode, part.stop, part.last)
                if self._is_zero(part, mode, gradient, f) and not self._rests(part, mode):
                    jumps |= gradient.change(part.after) != 0.0
        return jumps

    def _note(self, instant: Instant, rows: Mapping[str, Floats], others: Floats | None) -> None:
        """Add the functions that switch at an instant, with the derivatives of the time, to :attr:`switchings`."""
        unknown = np.full(len(self.equations.columns), np.nan)
        for (t, label), how in self.changes.items():
            if t == instant.high:
                # clip has two modes
                row = next((own for mode, own in rows.items() if self._name(mode) == label), None)
                own = row if row is not None else others if others is not None else unknown
                self.switchings.append(SwitchSlopes(t, label, how, own))

    def _refuse_grazing(self, part: _Part) -> None:
        """Raise PropagationError if a guard with a jump touches zero inside an interval without a switch."""
        regime = part.regime
        modes = {guard.mode for guard, on in zip(regime.guards, regime.active(part.modes), strict=True) if on}
        for mode in sorted(modes & regime.formulas.keys() - part.held):
            if is_continuous(self.by_name[mode]) or self._rests(part, mode):
                continue
            t = self._touching(part, mode)
            if t is None:
                continue
            # a guard of time alone that no variable changes touches zero in all nearby motions
            guard = self._guard(part, mode, t, part.last)
            if guard.states.any() or guard.variables.any():
                raise self._stop(part.zero.after(t), f"the argument of {self._name(mode)} touches zero")

    def _touching(self, part: _Part, mode: str) -> float | None:
        """Return the time, s on the clock of an interval, at which a guard touches zero in it; None if it does not."""
        values, _ = self._bound(part.regime.parameters, part, "guards")
        constants = {**{name: float(value) for name, value in part.modes.items()}, **values}
        ends = self.side * np.array([chunk.stop - part.zero for chunk in part.chunks[:-1]])

        def distances(times: Floats) -> Floats:
            states, places = np.empty((len(times), len(STATES))), np.searchsorted(ends, self.side * times)
            for place in np.unique(places).tolist():
                states[places == place] = part.chunks[place].own_states(times[places == place])
            inputs = {**constants, "t": times, **dict(zip(STATES, states.T, strict=True))}
            guard = np.asarray(evaluate(part.regime.formulas[mode], inputs, ARRAY_FUNCTIONS, float)) + 0.0 * times
            near = np.abs(guard)
            return np.minimum(near, np.abs(1.0 - guard)) if self.by_name[mode].kind == "floor" else near

        grid = np.append(np.concatenate([_points(chunk.own_piece.edges) for chunk in part.chunks]), part.stop)
        row = distances(grid)
        largest = float(row.max())
        least = (row[1:-1] <= row[:-2]) & (row[1:-1] <= row[2:]) & (row[1:-1] <= NEARBY * largest)
        for place in (np.flatnonzero(least) + 1).tolist():
            low, high = float(grid[place - 1]), float(grid[place + 1])
            for _ in range(ZOOMS):
                times = np.linspace(low, high, 2 * FINE + 1)
                near = distances(times)
                k = min(max(int(near.argmin()), 1), 2 * FINE - 1)
                low, high = float(times[k - 1]), float(times[k + 1])
            if near.min() <= GRAZE * largest:
                return 0.5 * (low + high)
        return None

    def _integrate(self, part: _Part, times: Floats) -> tuple[Floats, Floats]:
        """Return states and derivatives, (n, 7) and (n, 7, m), at times of an interval, s after its ``zero``."""
        program, parameters = self.program(part)
        values, rows = self._bound(parameters, part, "rates")
        equations, results = self.equations, []
        for first in range(0, len(equations.columns), AT_ONCE):
            places = range(first, min(first + AT_ONCE, len(equations.columns)))
            depends = [equations.depends(parameters, k) for k in places]
            path = motion_library(part.regime.plan, program, depends)
            slopes_of = [[rows.get(name, ZEROS)[k if name in rows else 0] for name in own]
                         for k, own in zip(places, depends, strict=True)]  # fmt: skip
            starts = [part.before[:, k].tolist() for k in places]
            units = [self._unit(k, part.before[:, k]) for k in places]
            numbers = [values[name] for name, _ in parameters]
            states, derivatives, units = follow_columns(
                path, numbers, slopes_of, part.first.tolist(), starts, units, part.start, times, self._label(part)
            )
            for k, unit in zip(places, units, strict=True):
                self._units[k] = unit
            results.append((states, derivatives))
        return results[0][0], np.concatenate([derivatives for _, derivatives in results], axis=2)

    def _unit(self, column: int, by: Floats) -> float:
        """Return the power of two by which a column of derivatives is multiplied while it is integrated."""
        largest = float(np.abs(by).max())
        if largest * self._units[column] > 2.0:
            return math.ldexp(1.0, 1 - math.frexp(largest)[1])
        return self._units[column]

    def _label(self, part: _Part) -> Callable[[PropagationError], PropagationError]:
        def named(error: PropagationError) -> PropagationError:
            later = error.later(part.zero.high) if isinstance(error, IntegrationStopped) else error
            return PropagationError(f"{self.scene.name}: sensitivities: {later}")

        return named

    # ------------------------------------------------------------------------------------------------- samples

    def sample(self, times: Floats) -> tuple[Floats, Floats]:
        """Return states, (n, 7), and derivatives, (n, 7, m), at times of the scene, s, after the start."""
        order = np.argsort(self.side * times, kind="stable")
        ordered, count = times[order], 0
        states = np.empty((len(times), len(STATES)))
        by = np.empty((len(times), len(STATES), len(self.equations.columns)))
        for place, part in enumerate(self.parts):
            final = place == len(self.parts) - 1
            last = len(ordered) if final else max(count, part.end.reached(ordered, self.side))
            if last == count:
                continue
            own = np.asarray(part.zero.since(ordered[count:last]))
            chosen = order[count:last]
            states[chosen], by[chosen] = self._integrate(part, own)
            at_switch = chosen[ordered[count:last] == part.end.high]
            if len(at_switch):
                following = None if final else self.parts[place + 1].before
                jump = self._jumps_at_end() if following is None else ~_alike(part.after, following).all(axis=0)
                by[at_switch[:, None], :, np.flatnonzero(jump)] = np.nan
            count = last
        return states, by

    def sides(self, t: float, tolerance: float) -> list[tuple[Floats, Floats, Floats]]:
        """Return state, rates and derivatives at a time, s: one triple, or two at a switch, before and after it.

        A time is at a switch if it is nearer to it than the errors of a motion with the given tolerance.
        """
        for place, part in enumerate(self.parts[:-1]):
            following = self.parts[place + 1]
            near = max(AT_SWITCH * max(abs(t), self.length), MARGIN * tolerance * self.length)
            if abs(t - part.end.high) <= near:
                return [
                    (part.last, self.rates(part, part.stop, part.last), part.after),
                    (following.first, self.rates(following, following.start, following.first), following.before),
                ]
        part = next((each for each in self.parts if each.end.reached(np.array([t]), self.side)), self.parts[-1])
        own = float(part.zero.since(t))
        states, by = self._integrate(part, np.array([own]))
        return [(states[0], self.rates(part, own, states[0]), by[0])]


DUALS = dual_functions(FLOAT_FUNCTIONS)
ZEROS = [0.0]


def _points(edges: Floats) -> Floats:
    """Return times in the steps of a motion, :data:`FINE` in each step, without the end of the last one."""
    inside = np.linspace(0.0, 1.0, FINE, endpoint=False)
    return np.asarray(edges[:-1, None] + np.diff(edges)[:, None] * inside).ravel()


def _alike(left: Floats, right: Floats) -> NDArray[np.bool_]:
    """Return where derivatives differ by at most 1e-9 of their size, that of the column if they form a matrix."""
    sizes = np.maximum(np.abs(left), np.abs(right))
    return np.abs(left - right) <= ALIKE * (sizes if sizes.ndim == 1 else sizes.max(axis=0))
