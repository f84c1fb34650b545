"""A motion under torques with switching functions (sign, abs, ..), followed through all switches to one end.

The *guard* of a function is its argument; its *mode* is the number that replaces it in formulas. For given modes the
motion is smooth: a *regime*. In *sliding* motion a guard is *held* at zero. *Twins* are modes of guards that are zero
together.
"""

import math
from collections.abc import Callable, Generator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic.double_double import two_sum
from symrot.errors import InputError
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.switches import CHANGING, hold
from symrot.formula.tree import evaluate, names, parse
from symrot.propagation import progress
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.events.events import ZerosNotSeparated, search, signs_at_ends
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.motion import Motion
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Floats
from symrot.propagation.switched.domains import excess
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.regimes import Guard, Modes, Regime
from symrot.propagation.switched.run_state import CHATTER, RunState
from symrot.propagation.switched.smooth_pieces import smooth_pieces
from symrot.propagation.switched.system import SwitchedSystem, is_continuous

__all__ = ["Chunk", "SwitchedRun"]

MOST_SWITCHES, MOST_AT_ONCE = 1_000_000, 1000
HOP_BITS = 10  # a hop over a switch is at most 2 to this power units in the last place of the clock long
LEAST_TURN = 1e-3  # rad over the whole span: errors of slower rotations are relative to this rate
AWAY = range(50, 400, 10)  # a hop away from a switch is the span divided by 2 to this power
NEARBY, MOST_ULPS = 1e-6, 64.0  # part of the time since the last switch; units in the last place of a located time
RISE_BITS = 40  # a guard is followed from 2 to this negative power of a piece on, to see whether it rises
PERTURBATION, PARALLEL = 1e-6, 1e-6  # of time and states, for slopes; relative difference of parallel slopes
ERRORS = 100.0  # largest error of a motion, in tolerances
PROBES = 8  # times in each step at which arguments of switching functions must have a value
SHORT = 1e-9  # part of the span: distance beyond an instant without rates at which formulas are evaluated
CHATTERING = 1e-9  # part of the span: CHATTER switches within it count as infinitely many
Consumer = Callable[["Chunk"], None]
SwitchState = tuple[frozenset[tuple[str, int]], frozenset[str]]
"""A state of all switching functions: the modes that are not held, with their values, and the names of held modes."""


class Chunk(NamedTuple):
    """Interval of a motion from ``start`` to ``stop``, as a function from times to states and as polynomials."""

    start: Instant
    stop: Instant
    zero: Instant
    # these take the time since the instant zero; the methods take scene time
    own_states: Callable[[Floats], Floats]
    own_piece: Piece

    def states(self, times: Floats) -> Floats:
        """Return the states, shape (n, N), at times of the scene, s."""
        return self.own_states(self.zero.since(times))

    def piece(self) -> Piece:
        """Return the polynomials of this part of the motion, with times converted to times of the scene."""
        rows, edges = self.own_piece.rows.copy(), self.own_piece.edges + self.zero.low + self.zero.high
        edges[0], edges[-1] = self.start.high, self.stop.high  # the same numbers as in the parts before and after
        time, low = two_sum(self.zero.high, rows[:, 0])
        rows[:, 0], rows[:, 2] = two_sum(time, low + (rows[:, 2] + self.zero.low))
        return Piece(edges, rows)


class SwitchedRun(RunState):
    """The computation of a motion under torques with switching functions, from its start to scene time ``end``, s."""

    def __init__(self, motion: Motion, system: SwitchedSystem, end: float) -> None:
        super().__init__(motion, end, system.initial_modes())
        # t and end are times on a clock that shows 0 at the last switch, an instant of twice the digits
        self.system, self._end = system, Instant(end)
        self.by_name = {switch.mode: switch for switch in system.switches}
        self.held = frozenset[str]()
        self.cost = np.zeros(3, dtype=np.int64)  # steps accepted and rejected, evaluations
        self.switches = 0
        self.changes: dict[tuple[float, str], str] = {}  # how each function switched, with time and function as key
        self.flipped: dict[str, int] = {}  # the modes that changed at the present time, and how often
        self.released: set[str] = set()  # modes held until this time: their guards leave zero slowly
        self.order: list[str] = []  # the modes that changed at the present time, in the order of the changes
        self.rested: set[str] = set()  # modes that were held at the present time though no torque was needed for it
        self.left: set[tuple[str, int]] = set()  # the values of all modes before the changes at the present time
        self.visited: dict[SwitchState, int] = {}  # states at the present time, with the number of changes before each
        # Held modes, and the attraction when they were first held.
        self.attraction: tuple[frozenset[str], list[float]] = frozenset(), []
        self.settled, self.hopped = 0, False

    def follow(self, consume: Consumer) -> None:
        """Compute the motion to its end, and pass each :class:`Chunk` of it to ``consume`` as soon as it is known."""
        with progress.within(self.motion.start, self._end.high, lambda: self.zero.high):
            try:
                self._check_start()
                if self.interrupt is not None:
                    raise self.interrupt
                while self.t != self.end:
                    progress.report(self.t, 0.0, self.end)
                    regime = self._regime(self.modes)
                    if self._comes_to_rest(regime):
                        continue
                    guard = self._segment(regime, consume)
                    if self.interrupt is not None:
                        raise self.interrupt
                    if guard is not None:
                        self._switch(regime, guard)
            except IntegrationStopped as error:
                # the parts before that time have been passed on
                raise error.later(self.zero.high) from None

    @property
    def now(self) -> float:
        """The present time of the motion on the clock of the scene, s, rounded to one double."""
        return self.zero.after(self.t).high

    def _at(self, t: float) -> Instant:
        return self._end if t == self.end else self.zero.after(t)

    def _move_clock(self, zero: Instant) -> None:
        """Set the clock to 0 at the instant ``zero``, the present time of the motion."""
        self.zero, self.t, self.end = zero, 0.0, float(zero.since(self._end.high))
        if self.side * self.end < 0.0:  # within rounding of the end
            self.end = 0.0

    def _check_start(self) -> None:
        """Raise IntegrationStopped if the start allows two motions."""
        for switch in self.system.switches:
            mode = switch.mode
            if mode not in self.system.undecided or not hold(switch.where, self.modes) or self.t == self.end:
                continue
            leaving = 0
            # two motions: x in sign(x) is zero, and becomes positive with sign = 1 and negative with sign = -1
            for sign in (1, -1):
                modes = self.system.beside_start(mode, sign)
                regime = self._regime(modes)
                rates, values = regime.bound(modes, self.zero)
                piece, _ = next(smooth_pieces(self, regime, rates).pieces())
                signs, _ = signs_at_ends(regime.path, [guard.formula for guard in regime.guards], values, piece)
                leaving += all(s > 0 for s, guard in zip(signs, regime.guards, strict=True) if guard.mode == mode)
            if leaving == 2:
                way = "past" if self.side < 0.0 else "future"
                raise IntegrationStopped(
                    self.t,
                    f"the motion starts where {self._name(mode)} switches, and can go on with either of its values: it "
                    f"has more than one {way}; change the initial state slightly",
                    self.end,
                )

    def _segment(self, regime: Regime, consume: Consumer) -> Guard | None:
        """Compute the motion up to its next switch, and return the guard that is zero there; None without a switch."""
        # a guard is the argument of a function such as sign or abs
        if self.t != 0.0:
            self._move_clock(self._at(self.t))
        rates, values = regime.bound(self.modes, self.zero)
        active = regime.active(self.modes)
        if self.held:
            self._check_held_alone()
            if self.attraction[0] != self.held:
                self.attraction = self.held, regime.attraction(self.modes, self.zero, self.t, self.y)
        if not all(map(math.isfinite, rates)):
            if (guard := self._coincident(regime, active, values, 0)) is None:
                raise IntegrationStopped(self.t, NOT_FINITE_SENTENCE, self.end)
            return guard
        events = [
            event if on else event._replace(terminal=False) for event, on in zip(regime.events, active, strict=True)
        ]
        source = smooth_pieces(self, regime, rates)
        start, passed = self.t, [self.t]
        violated: list[Guard] = []
        lost: list[IntegrationStopped] = []  # not empty if an argument has no value from there on
        left: list[bool] = []  # not empty if a guard left zero: the motion is followed again from there

        def watched() -> Generator[Piece, None, None]:
            for piece, states in source.pieces():
                first, last = self._negative(regime, active, values, piece)
                first = [guard for guard in first if guard.mode not in self.released or guard in last]
                first = [guard for guard in first if not self._is_rounding(regime, guard, piece, states)]
                if passed[-1] == start and (first or self._settle(regime, active, piece, states)):
                    violated.extend(first)
                    return
                if self._leaves_zero(regime, active, piece):
                    left.append(True)
                    if passed[-1] != start:
                        self.t, self.y = passed[-1], states(np.array(passed[-1:]))[0]
                        self._forget_changes()
                    return
                current[:] = [(piece, states)]
                yield piece
                if last:  # no crossing: up to rounding the guard was negative from the start of the piece
                    violated.extend(last)
                    if passed[-1] != start:
                        self.t, self.y = passed[-1], states(np.array(passed[-1:]))[0]
                        self._forget_changes()
                    return
                chunk = self._chunk(passed[-1], float(piece.edges[-1]), states, piece)
                if (no_value := self._pass_on(consume, regime, active, chunk)) is not None:
                    lost.append(no_value)
                    return
                passed.append(float(piece.edges[-1]))

        current: list[tuple[Piece, Callable[[Floats], Floats]]] = []
        watching = watched()
        try:
            zeros, stop, *_ = search(regime.path, events, values, watching, start)
        except ZerosNotSeparated as error:
            functions = ", ".join(dict.fromkeys(self._name(guard.mode) for guard in regime.guards))
            reason = f"the zeros inside {functions} cannot be told apart after {error.effort}"
            raise IntegrationStopped(passed[-1], reason, self.end) from None
        except IntegrationStopped as error:
            if (
                passed[-1] == start
                and not current
                and (guard := self._coincident(regime, active, values, -1)) is not None
            ):
                return guard
            at = passed[-1]
            y = current[0][1](np.array([at]))[0] if current else self.y
            hop = self._hop(regime, active, rates, at, y, error)
            if hop is None:
                raise
            piece, states, hopped = hop
            stop = float(piece.edges[-1])
            self.y = states(piece.edges[-1:])[0]
            instant = self._at(stop) if hopped is None else self._located(regime, hopped, stop)
            consume(Chunk(self._at(at), instant, self.zero, states, piece))
            self.t = stop
            if hopped is not None:
                self._arrive(instant)
            return hopped
        finally:
            watching.close()
            self.cost += source.cost()
        if lost:
            raise lost[0]
        if violated:  # an argument that jumped with another function is corrected before others cross zero
            return min(violated, key=lambda guard: not self._inside(guard.mode) & set(self.order))
        if left:
            # a sign left zero: the motion is computed again from there
            return None
        if stop is None:
            self.t = self.end if current else self.t  # a mode was settled: repeat from here
            return None
        piece, states = current[0]
        ended = next(each.event for each in reversed(zeros) if each.t == stop and active[each.event])
        guard = regime.guards[ended]
        instant = self._at(stop) if stop == self.end else self._located(regime, guard, stop)
        if abs(stop) > abs(passed[-1]):
            rows = int((np.abs(piece.edges[:-1]) < abs(stop)).sum())
            part = Piece(np.append(piece.edges[:rows], stop), piece.rows[:rows])
            chunk = Chunk(self._at(passed[-1]), instant, self.zero, states, part)
            if (no_value := self._pass_on(consume, regime, active, chunk)) is not None:
                raise no_value
        self.y = states(np.array([stop]))[0]
        self.t = stop
        self._arrive(instant)
        return guard

    def _coincident(self, regime: Regime, active: list[bool], values: list[float], most: int) -> Guard | None:
        """Return the guard of another function (sign, floor, ..) that has to switch at the present time, or None."""
        # Functions that switch at one time do so one after the other; the rates may have no value until the last one
        # has, such as a root of a negative argument.
        h = self.side * SHORT * self.span
        row = np.concatenate([[self.t, h, 0.0, h], self.y, np.zeros_like(self.y)])
        formulas = [guard.formula for guard in regime.guards]
        signs, _ = signs_at_ends(regime.path, formulas, values, Piece(np.array([self.t, self.t + h]), row[None]))
        guards = [
            (sign, guard)
            for guard, on, sign in zip(regime.guards, active, signs, strict=True)
            # most: -1 for guards that become negative, 0 if those that stay zero count too
            if on and sign <= most and guard.mode not in self.held and not self.flipped.get(guard.mode)
        ]
        return min(guards, key=lambda pair: pair[0])[1] if guards else None

    def _arrive(self, instant: Instant) -> None:
        """Set the clock to 0 at the instant of a switch, unless the motion ends there, and forget earlier switches."""
        if self.t != self.end:
            self._move_clock(instant)
        self._forget_changes()
        self.hopped = False

    def _forget_changes(self) -> None:
        """Clear all lists of functions that switched at the present time, because the motion goes on from it."""
        self.flipped, self.order = {}, []
        self.left, self.visited, self.released, self.rested = set(), {}, set(), set()

    def _hop(
        self, regime: Regime, active: list[bool], rates: list[float], t: float, y: Floats, error: IntegrationStopped
    ) -> tuple[Piece, Callable[[Floats], Floats], Guard | None] | None:
        """Return a short linear motion (a hop) past a time where a stepper is stuck; None if none is accurate."""
        # Steps shrink to zero where a torque has no derivative, though its impulse is finite: sqrt(1 - t) before a
        # switch at 1 s, sqrt(t - 1) after it. If the impulse is less than the tolerance, the states may change
        # linearly.
        kernel, motion = regime.motion.kernel, regime.motion
        p = np.array(rates[: len(kernel.rate_parameters)])
        edges, scales = error_blocks(regime.plan)

        def rate(t: float) -> Floats:
            with np.errstate(all="ignore"):
                return np.asarray(motion.rates(t, y, p), dtype=np.float64)

        def slight(change: Floats) -> bool:
            return all(
                float(np.linalg.norm(change[low:high]))
                <= motion.tolerance * max(float(np.linalg.norm(y[low:high])), scale, LEAST_TURN / self.span)
                for (low, high), scale in zip(pairwise(edges), scales, strict=True)
            )

        def straight(h: float, change: Floats) -> tuple[Piece, Callable[[Floats], Floats]]:
            row = np.concatenate([[t, h, 0.0, h], y, change])
            return Piece(np.array([t, t + h]), row[None]), lambda times: y + np.outer((times - t) / h, change)

        # away from the last switch; below: up to a nearby switch
        if t == 0.0:
            for halvings in () if self.hopped or abs(error.t) > 0.0 else AWAY:
                h = self.side * math.ldexp(self.span, -halvings)
                early, late = rate(0.25 * h), rate(0.75 * h)
                if slight(h * early) and slight(h * late):
                    self.hopped = True
                    # this hop does not end at a switch
                    return *straight(h, 0.5 * h * (early + late)), None
            return None
        for bits in range(HOP_BITS + 1):
            h = self.side * math.ldexp(math.ulp(t), bits)
            h = t + h - t
            change = h * rate(t)
            if not slight(change):
                return None
            for guard, on in zip(regime.guards, active, strict=True):
                if on and guard.mode not in self.held and self._crosses(regime, guard, (t, y), (t + h, y + change)):
                    return *straight(h, change), guard
        return None

    def _crosses(self, regime: Regime, guard: Guard, *places: tuple[float, Floats]) -> bool:
        """Return whether a function (sign, floor, ..) switches between two points (time, states) of the motion."""
        before, after = (self._oriented(regime, guard, place) for place in places)
        # the guard falls from >= 0 to <= 0
        return before >= 0.0 >= after and before > after

    def _oriented(self, regime: Regime, guard: Guard, place: tuple[float, Floats]) -> float:
        """Return the value of a guard's formula, which falls through zero at a switch; NaN if it has no value."""
        try:
            return float(evaluate(parse(guard.formula), self._values(regime, place), FLOAT_FUNCTIONS, float))
        except (ArithmeticError, ValueError, IntegrationStopped):
            return math.nan

    def _has_no_value(self, regime: Regime, mode: str, times: Floats, states: Floats) -> NDArray[np.bool_]:
        """Return at which times a guard has no value, even if the states changed by the error of the motion."""
        columns = self._columns(times, states)
        rate = np.sqrt(sum(columns[f"omega_{i}"] ** 2 for i in (1, 2, 3)))
        sizes = {name: rate if name.startswith("omega") else np.ones_like(times) for name in columns}
        numbers = {name: np.array(value) for name, value in regime.values(self.modes, self.zero).items()}
        with np.errstate(all="ignore"):
            outside = excess(regime.formulas[mode], {**columns, **numbers, "t": times}, sizes)
        return np.broadcast_to(outside > ERRORS * self.motion.tolerance, times.shape)

    def _chunk(self, start: float, stop: float, states: Callable[[Floats], Floats], piece: Piece) -> Chunk:
        return Chunk(self._at(start), self._at(stop), self.zero, states, piece)

    def _located(self, regime: Regime, guard: Guard, t: float) -> Instant:
        """Return the time near t at which a guard (argument of sign, abs, ..) is zero, as an :class:`Instant`."""
        instant = self.zero.after(t)
        if guard.mode in self.held or guard.mode not in regime.of_time:
            # only if the guard depends on time alone, a Newton step gives its zero to twice the digits
            return instant
        switch, aside = self.by_name[guard.mode], NEARBY * abs(t)
        goal = 0.0 if switch.kind == "sign" else max(guard.change, 0)
        values = regime.values(self.modes, instant)

        def value(t: float) -> float:
            return float(evaluate(regime.formulas[guard.mode], {**values, "t": t}, FLOAT_FUNCTIONS, float)) - goal

        try:
            slope = (value(aside) - value(-aside)) / (2.0 * aside)
            correction = -value(0.0) / slope
        except (ArithmeticError, ValueError, IntegrationStopped):
            return instant
        if abs(correction) > MOST_ULPS * math.ulp(t):
            return instant
        return self._past(regime, guard, instant.after(correction))

    def _past(self, regime: Regime, guard: Guard, instant: Instant) -> Instant:
        """Return ``instant``, moved on by some rounding errors if ``guard`` as computed there is still positive."""
        # The function (sign, abs, ..) would switch back at once. Later times are tried, at growing distances of a few
        # units in the last place.
        formula, later = parse(guard.formula), instant
        step = self.side * math.ulp(math.ulp(instant.high))
        while abs(step) <= MOST_ULPS * math.ulp(instant.high):
            values = {**regime.values(self.modes, later), "t": 0.0}
            if float(evaluate(formula, values, FLOAT_FUNCTIONS, float)) <= 0.0:
                return later
            later, step = instant.after(step), 8.0 * step
        return instant

    def _is_rounding(
        self, regime: Regime, guard: Guard, piece: Piece, states: Callable[[Floats], Floats]
    ) -> bool:  # fmt: skip
        """Return whether a guard is negative at the start of ``piece`` only because of rounding."""
        # the guard is zero there, because its function has just switched
        if guard.mode in self.held or not self.flipped.get(guard.mode):
            return False
        # the function then must not switch again
        if guard.mode in regime.of_time:
            # a guard that depends on time alone can be computed a little later
            later = self.t + self.side * MOST_ULPS * math.ulp(self.zero.high)
            values = {**regime.values(self.modes, self.zero), "t": later}
            return float(evaluate(parse(guard.formula), values, FLOAT_FUNCTIONS, float)) > 0.0
        return not self._jumped(guard.mode) and self._rises(regime, guard, piece, states)

    def _rises(self, regime: Regime, guard: Guard, piece: Piece, states: Callable[[Floats], Floats]) -> bool:
        """Return whether the guard is at most zero at the start of ``piece`` and rises until it is positive."""
        # The state was located where the guard is zero, to the rounding errors of a longer piece: it may be slightly
        # negative still. Values at doubled distances tell rising from falling, which is a switch back or sliding.
        start, end = float(piece.edges[0]), float(piece.edges[-1])
        times = np.concatenate([[start], start + (end - start) * np.ldexp(1.0, range(-RISE_BITS, 1))])
        before = -math.inf
        for t, y in zip(times.tolist(), states(times), strict=True):
            value = self._oriented(regime, guard, (t, y))
            if not before <= value <= 0.0:
                return value > 0.0 and before > -math.inf
            before = value
        return False

    def _negative(
        self, regime: Regime, active: list[bool], values: list[float], piece: Piece
    ) -> tuple[list[Guard], list[Guard]]:
        """Return the guards that are negative just after the start of ``piece``, and the guards negative at its end."""
        formulas = [guard.formula for guard in regime.guards]
        # such a function should have switched before the piece or within it; active: guards that can end the regime
        first, last = (
            [guard for guard, on, sign in zip(regime.guards, active, signs, strict=True) if on and sign < 0]
            for signs in signs_at_ends(regime.path, formulas, values, piece)
        )
        return first, last

    def _settle(self, regime: Regime, active: list[bool], piece: Piece, states: Callable[[Floats], Floats]) -> bool:
        """Set each function such as sign(x) to its value at zero if x stays zero; return whether a value changed."""
        formulas, settled = [guard.formula for guard in regime.guards], dict(self.modes)

        def signs_under(modes: Modes) -> list[int]:
            return signs_at_ends(regime.path, formulas, regime.bound(modes, self.zero)[1], piece)[0]

        signs_now = signs_under(self.modes)
        end = float(piece.edges[-1])
        later = end, states(np.array([end]))[0]  # a guard may leave zero so slowly that rounding hides it
        for switch in self.system.switches:
            mode = switch.mode
            numbers = [n for n, guard in enumerate(regime.guards) if guard.mode == mode and active[n]]
            if mode in self.held or not numbers:
                continue
            resting = switch.kind == "sign" and self.modes[mode] == 0  # then its mode times its guard is zero
            signs = signs_under({**self.modes, mode: 1}) if resting else signs_now
            sign = signs[numbers[0]]
            if switch.kind == "floor":  # at n + 1 the floor is n + 1
                upper = signs[numbers[1]]
                if not upper and self._guard_value(mode) == 1.0:
                    settled[mode] = self.modes[mode] + 1
                continue
            if sign and self.modes[mode] == 0:
                # a sign that was set to 0 gets the sign of x as soon as x is not zero
                settled[mode] = sign
            # zero at the start and at the end of piece, the next interval of the motion
            elif not sign and self._guard_value(mode) == 0.0 == self._guard_value(mode, later):
                settled[mode] = switch.at_zero
        changed = [mode for mode, value in settled.items() if value != self.modes[mode]]
        if changed:
            self.order += changed
            self.settled += 1
            if self.settled > MOST_SWITCHES:
                raise IntegrationStopped(self.t, "the torque switches again and again at this time", self.end)
        self.modes = settled
        return bool(changed)

    def _guard_value(self, mode: str, place: tuple[float, Floats] | None = None) -> float:
        """Return the argument of a switching function, now or at ``place``, (time, states).

        For floor(x) it is x minus the present floor.
        """
        # the floor is its value n in the present equations: it changes where x - n is 0 or 1
        regime = self._regime(self.modes)
        return float(
            evaluate(regime.formulas[mode], self._values(regime, place or (self.t, self.y)), FLOAT_FUNCTIONS, float)
        )

    def _values(self, regime: Regime, place: tuple[float, Floats]) -> dict[str, float]:
        """Return the values, by name, of all names in switching functions' arguments, at ``place`` = (time, states)."""
        t, y = place
        values = {name: float(column[0]) for name, column in self._columns(np.array([t]), y[None]).items()}
        return {**values, **regime.values(self.modes, self.zero), "t": t}

    def _columns(self, times: Floats, states: Floats) -> dict[str, Floats]:
        """Return the values of omega_1..3 and, if the scene has an attitude, of q0..3 at the rows of ``states``."""
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if self.motion.plan.structure.attitude else []
        quantities = self.motion.evaluate(times, states, names)
        return {name.removesuffix(" of t"): column for name, column in zip(names, quantities.T, strict=True)}

    def _pass_on(
        self, consume: Consumer, regime: Regime, active: list[bool], chunk: Chunk
    ) -> IntegrationStopped | None:
        """Pass ``chunk`` to ``consume``, up to where an argument of sign, floor, .. has no value; return that error."""
        modes = {guard.mode for guard, on in zip(regime.guards, active, strict=True) if on} - self.held
        partial = [mode for mode in sorted(modes) if mode in regime.may_lose_value]
        if not partial:
            consume(chunk)
            return None
        edges = chunk.own_piece.edges
        steps = np.append(edges[:1], edges[:-1, None] + np.diff(edges)[:, None] * np.arange(1, PROBES + 1) / PROBES)
        for mode in partial:
            times = steps
            for _ in range(8):  # the first time without a value is enclosed more and more closely
                outside = self._has_no_value(regime, mode, times, chunk.own_states(times))
                if not outside.any():
                    break
                first = max(int(outside.argmax()), 1)
                times = np.linspace(times[first - 1], times[first], 65)
            if len(times) == 65:
                last = float(times[0])
                if last != edges[0]:
                    rows = int((np.abs(edges[:-1] - edges[0]) < abs(last - edges[0])).sum())
                    part = Piece(np.append(edges[:rows], last), chunk.own_piece.rows[:rows])
                    consume(chunk._replace(stop=self._at(last), own_piece=part))
                return IntegrationStopped(last, f"{self._name(mode)} has no value there", self.end)
        consume(chunk)
        return None

    def _switch(self, regime: Regime, guard: Guard) -> None:
        """Change the value of the function (sign, floor, ..) whose guard has become zero, or hold its guard at zero."""
        mode, kind = guard.mode, self.by_name[guard.mode].kind
        if mode in self.held and (guard.change == 0 or not self._still_attracts(regime)):
            raise IntegrationStopped(
                self.t,
                f"the motion slides along the jump of {self._names_of_held()}, but from this time on nearby motions "
                "lead away from it: its continuation is not unique; end the motion here",
                self.end,
            )
        self.left.add((mode, self.modes[mode]))
        self.visited.setdefault(self._state(), len(self.order))
        again = self.flipped.get(mode, 0)
        if again and self._jumped(mode):  # a mode in its guard changed too: the motion does not return
            again = 0
        # the rates before and after the change both drive the argument of a sign back to zero
        slides = kind == "sign" and again > 0 and mode not in self.held and self._returns(mode)
        self.order.append(mode)
        if len(self.order) > MOST_AT_ONCE or (slides and self._state(hold=mode) in self.visited):
            raise IntegrationStopped(
                self.t,
                f"the torque contradicts itself: with every value that {self._name(mode)} can have here, it switches "
                "at once to another value; change the torque, or end the motion here",
                self.end,
            )
        if again == 0:
            self._count()
        self.flipped[mode] = again + 1
        self.changes[self.now, self._name(mode)] = "released" if mode in self.held else "passed"
        asleep = self._asleep()
        if mode in self.held:
            self.held -= {mode}
            self.modes |= {twin: guard.change * sign for twin, sign in self.system.twins[mode]}
            self.released.update(twin for twin, _ in self.system.twins[mode])
        elif slides:
            self._hold(regime, mode)
        elif kind == "sign":
            self.modes[mode] = -self.modes[mode]
        else:
            above = math.floor(self._guard_value(mode))
            far = abs(above) > 1  # the guard jumped over whole numbers
            self.modes[mode] += above if far else guard.change
            if (mode, self.modes[mode]) in self.left:
                raise IntegrationStopped(
                    self.t,
                    f"the motion would slide along a jump of {self._name(mode)}; symrot computes sliding only for "
                    "functions of a sign, such as sign and step, not for floor and mod",
                    self.end,
                )
        for other in asleep - self._asleep():
            self._wake(other)

    def _returns(self, mode: str) -> bool:
        """Return whether ``mode`` must be held at its jump, because its switch would only restore earlier modes."""
        # all modes would be as they were before at this time: the same switches would repeat without end
        first = self.visited.get(self._state(flip=mode))
        if first is None:
            return False
        # a function with only a kink, such as abs, is not held if one with a jump has switched since
        jumps = any(not is_continuous(self.by_name[other]) for other in self.order[first:])
        return not (jumps and is_continuous(self.by_name[mode]))

    def _state(self, flip: str = "", hold: str = "") -> SwitchState:
        """Return all modes, and which are held, after the mode ``flip`` changes its sign or ``hold`` becomes held."""
        # after flip has changed its sign
        modes = {**self.modes, flip: -self.modes[flip]} if flip else self.modes
        # after hold becomes held: its argument stays at zero
        held = self.held | {self.system.twins[hold][0][0]} if hold else self.held
        return frozenset((mode, value) for mode, value in modes.items() if mode not in held), held

    def _jumped(self, mode: str) -> bool:
        """Return whether a function in the argument of ``mode`` switched later: sign, in abs(x + sign(y))."""
        # in abs(x + sign(y)), if sign switched after abs, the argument of abs has jumped: abs may switch again
        last = len(self.order) - self.order[::-1].index(mode)
        return bool(self._inside(mode) & set(self.order[last:]))

    def _inside(self, mode: str) -> set[str]:
        """Return the names in the argument of ``mode``: x and the mode of sign(y), for abs(x + sign(y))."""
        return set(names(self.by_name[mode].guard))

    def _asleep(self) -> set[str]:
        """Return the names of the switching functions without effect now: those in unused branches of ``where``."""
        # such as the sign in where(omega_1 > 0, sign(omega_2), 0) while omega_1 < 0
        return {s.mode for s in self.system.switches if s.where and not hold(s.where, self.modes, self.held)}

    def _wake(self, mode: str) -> None:
        """Set the ``mode`` of a function such as sign(x) to the present value of the function."""
        # the motion begins to use the branch of where(..) with this function, whose changes were not followed before
        try:
            guard = self._guard_value(mode)
        except (ArithmeticError, ValueError, IntegrationStopped):
            # x has no value now: the mode stays
            return
        if self.by_name[mode].kind == "floor":
            self.modes[mode] += math.floor(guard)
        elif guard:
            self.modes[mode] = 1 if guard > 0.0 else -1

    def _hold(self, regime: Regime, mode: str) -> None:
        if self.side < 0.0:
            raise IntegrationStopped(
                self.t,
                "a motion that slides along a switch cannot be followed backward: it has more than one past",
                self.end,
            )
        mode, _ = self.system.twins[mode][0]
        self.held |= {mode}
        self.changes[self.now, self._name(mode)] = "held"
        guard = self.by_name[mode].guard
        if guard[0] == "symbol" and guard[1] in regime.plan.states:
            self.y[regime.plan.states.index(guard[1])] = 0.0  # exactly zero, where the guard is a state
        self._regime(self.modes)

    def _comes_to_rest(self, regime: Regime) -> bool:
        """Set sign(x) to sign(0) where x was held at zero but stays zero by itself; return whether any was set."""
        # Held: the equations contain the value of sign(x) between -1 and 1 for which x remains zero. If x remains zero
        # with sign(0) too, as for a body at rest that no torque drives, sign(0) replaces it.
        resting = [mode for mode in sorted(self.held - self.rested) if self.system.matters_at_zero(mode)]
        if resting:
            zeros = regime.zeros(self.modes, self.zero, self.y)
            vanishing = regime.motion.kernel.quantities.vanishing(zeros)
            resting = [mode for mode in resting if f"{mode} of t" in vanishing]
        self.rested.update(resting)
        self.held -= set(resting)
        for mode in resting:
            self.modes |= {twin: self.by_name[twin].at_zero for twin, _ in self.system.twins[mode]}
        return bool(resting)

    def _still_attracts(self, regime: Regime) -> bool:
        """Return whether nearby motions return to the sliding motion faster than numerical errors drive them away."""
        # if not, errors would decide to which side the motion leaves the switching surface
        now, least = regime.attraction(self.modes, self.zero, self.t, self.y), ERRORS * regime.motion.tolerance
        return all(value > least * first for value, first in zip(now, self.attraction[1], strict=True))

    def _leaves_zero(self, regime: Regime, active: list[bool], piece: Piece) -> bool:
        """Set each sign(x) that is 0 to the sign of x at the end of ``piece``; return whether one was changed."""
        # only functions whose guard can end the regime (active)
        numbers = [
            n
            for n, (guard, on) in enumerate(zip(regime.guards, active, strict=True))
            if on and self.modes[guard.mode] == 0 and guard.mode not in self.held
            and self.by_name[guard.mode].kind == "sign"
        ]  # fmt: skip
        if not numbers:
            return False
        ones = {**self.modes, **{regime.guards[n].mode: 1 for n in numbers}}
        formulas = [guard.formula for guard in regime.guards]
        _, signs = signs_at_ends(regime.path, formulas, regime.bound(ones, self.zero)[1], piece)
        self.modes |= {regime.guards[n].mode: signs[n] for n in numbers if signs[n]}
        return any(signs[n] for n in numbers)

    def _regime(self, modes: Modes) -> Regime:
        """Return the smooth motion for given values of sign, abs, .., with the arguments of :attr:`held` at zero."""
        try:
            return self.system.regime(self.held, modes)
        except InputError:  # the equations have no such motion or several
            raise IntegrationStopped(
                self.t,
                f"the motion would slide along the jump of {self._names_of_held()}, but not in exactly one way: the "
                "equations have no solution or several; change the torque, or end the motion at this time",
                self.end,
            ) from None

    def _names_of_held(self) -> str:
        return " and ".join(self._name(mode) for mode in sorted(self.held))

    def _check_held_alone(self) -> None:
        """Raise IntegrationStopped if x, held at zero for sign(x), also keeps the argument of another jump at zero."""
        # The equations determine one value between -1 and 1 for a held sign, not the two values in sign(omega_1) +
        # sign(omega_1 + omega_1^3), whose arguments are zero together.
        y = self.y.tolist()
        steps = [PERTURBATION * max(abs(self.t), self.span), *(PERTURBATION * max(1.0, abs(x)) for x in y)]

        def gradient(mode: str) -> Floats:
            slopes = []
            for k, h in enumerate(steps):
                sides = []
                for sign in (1.0, -1.0):
                    place = [self.t, *y]
                    place[k] += sign * h
                    sides.append(self._guard_value(mode, (place[0], np.array(place[1:]))))
                slopes.append((sides[0] - sides[1]) / 2.0)
            return np.array(slopes)

        arguments = CHANGING & set().union(*(names(self.by_name[mode].guard) for mode in self.held))
        tied, slopes = self.system.tied(self.held), [gradient(mode) for mode in sorted(self.held)]
        for switch in self.system.switches:
            mode = switch.mode
            if mode in self.held or mode in tied or mode in self.system.settled or is_continuous(switch):
                continue
            if not hold(switch.where, self.modes, self.held) or not names(switch.guard) & arguments:
                continue
            value = self._guard_value(mode)
            distance = min(abs(value), abs(1.0 - value)) if switch.kind == "floor" else abs(value)
            own = gradient(mode)
            size = float(np.abs(own).max())
            if distance > size:
                continue
            basis = np.array(slopes).T
            rest = own - basis @ np.linalg.lstsq(basis, own, rcond=None)[0]
            if float(np.abs(rest).max()) <= PARALLEL * size:
                functions = f"{self._names_of_held()} and {self._name(mode)} at once"
                raise IntegrationStopped(
                    self.t,
                    f"the motion would slide along the jumps of {functions}, but not in exactly one way: the value of "
                    f"{self._name(mode)} is not determined; change the torque, or end the motion here",
                    self.end,
                )

    def _count(self) -> None:
        self.switches += 1
        self.recent.append(self.zero.after(self.t))
        way = abs(self.recent[-1] - self.recent[0])
        near = len(self.recent) == CHATTER and way <= CHATTERING * self.span
        if near or self.switches > MOST_SWITCHES:
            within = f"{CHATTER} within {way:.1e} s" if near else f"more than {MOST_SWITCHES}"
            raise IntegrationStopped(self.t, f"the torque switches again and again without end ({within})", self.end)

    def _name(self, mode: str) -> str:
        return str(self.by_name[mode].label)
