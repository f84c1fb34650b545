"""A motion under torques with switches on its way from the start to one end: when it switches, slides, stops."""

import math
from collections import deque
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from symrot.errors import InputError
from symrot.expression import evaluate
from symrot.propagation.cut_off import CutOff
from symrot.propagation.events import search, signs_at_ends
from symrot.propagation.polynomials import Piece
from symrot.propagation.regimes import Guard, Regime
from symrot.propagation.smooth_pieces import SOURCES
from symrot.propagation.stepping import Floats

if TYPE_CHECKING:
    from symrot.propagation.switched import SwitchedMotion

__all__ = ["MATH", "Chunk", "SwitchedRun"]

MOST_SWITCHES = 1_000_000
CHATTER, CHATTERING = 50, 1e-9  # so many switches within that part of the span are endlessly many
Consumer = Callable[["Chunk"], None]

MATH: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp, "log": math.log, "abs": abs,
    "sinh": math.sinh, "cosh": math.cosh, "tanh": math.tanh, "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "atan2": math.atan2,
}  # fmt: skip


class Chunk(NamedTuple):
    """A part of a motion from ``start`` to ``stop``, s: its states there at any time, and as polynomials."""

    start: float
    stop: float
    states: Callable[[Floats], Floats]
    piece: Piece


class SwitchedRun:
    """A motion on its way from the start to one end."""

    def __init__(self, motion: "SwitchedMotion", end: float) -> None:
        self.motion, self.end, self.span = motion, end, abs(end - motion.start)
        self.t, self.y = motion.start, np.array(motion.plan.initial_state, dtype=np.float64)
        self.modes, self.held = motion.initial_modes(), frozenset[str]()
        self.cost = np.zeros(3, dtype=np.int64)  # steps accepted and rejected, evaluations
        self.switching: list[float] = []
        self.flipped: dict[str, int] = {}  # modes changed at this very time, and how often
        self.released: set[str] = set()  # modes whose guards were held until this very time: they leave zero slowly
        self.left: set[tuple[str, int]] = set()  # modes and their values left at this very time
        self.settled = 0
        self.spent, self.mark = 0, (0, self.t)  # SciPy's evaluations; those and the time when the pace was judged last
        self.interrupt: KeyboardInterrupt | None = None  # that came while SciPy followed the motion, beyond a switch
        self.recent: deque[float] = deque(maxlen=CHATTER)

    def follow(self, consume: Consumer) -> None:
        """Follow the motion to its end, handing on each part as it is known."""
        self._check_start()
        if self.interrupt is not None:
            raise self.interrupt
        while self.t != self.end:
            regime = self.motion.regime(self.held)
            guard = self._segment(regime, consume)
            if self.interrupt is not None:
                raise self.interrupt
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

    def _source(self, regime: Regime, rates: list[float]) -> Any:
        return SOURCES[self.motion.choice.method.partition(":")[0]](self, regime, rates)

    def _segment(self, regime: Regime, consume: Consumer) -> Guard | None:
        """Follow one smooth part; return the guard that ended it, or None at the end of the motion."""
        rates, values = regime.bound(self.modes)
        active = regime.active(self.modes)
        events = [
            event if on else event._replace(terminal=False) for event, on in zip(regime.events, active, strict=True)
        ]
        source = self._source(regime, rates)
        start, passed = self.t, [self.t]
        violated: list[Guard] = []

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
        self, regime: Regime, active: list[bool], values: list[float], piece: Piece
    ) -> tuple[list[Guard], list[Guard]]:
        """Return the guards that are on the wrong side from the start of a piece on, and those that are at its end."""
        formulas = [guard.formula for guard in regime.guards]
        first, last = (
            [guard for guard, on, sign in zip(regime.guards, active, signs, strict=True) if on and sign < 0]
            for signs in signs_at_ends(regime.path, formulas, values, piece)
        )
        return first, last

    def _settle(self, regime: Regime, active: list[bool], piece: Piece, states: Callable[[Floats], Floats]) -> bool:
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

    def _switch(self, regime: Regime, guard: Guard) -> None:
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

    def _hold(self, regime: Regime, mode: str) -> None:
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
