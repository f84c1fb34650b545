"""A motion under torques with switching functions (sign, abs, ..), computed from its start through all switches.

The *guard* of a function is its argument; its *mode* is the number that replaces it in formulas. For given modes the
motion is smooth: a *regime*. In *sliding* motion a guard is *held* at zero. *Twins* are modes of guards that are zero
together. :class:`SwitchedRun` builds on the classes of other modules: state of the motion, guards, changes of modes.
"""

import math
from collections.abc import Callable, Generator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from symrot.closed_form.arithmetic.double_double import two_sum
from symrot.formula.switches import hold
from symrot.propagation import progress
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.events.search import ZerosNotSeparated, search
from symrot.propagation.motions.motion import Motion
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Floats
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.mode_changes import ModeChanges
from symrot.propagation.switched.regimes import Guard, Regime
from symrot.propagation.switched.smooth_pieces import smooth_pieces
from symrot.propagation.switched.system import SwitchedSystem

__all__ = ["Chunk", "SwitchedRun"]

HOP_BITS = 10  # a hop over a switch is at most 2 to this power units in the last place of the clock long
LEAST_TURN = 1e-3  # rad over the whole span: errors of slower rotations are relative to this rate
AWAY = range(50, 400, 10)  # a hop away from a switch is the span divided by 2 to this power
PROBES = 8  # times in each step at which arguments of switching functions must have a value
Consumer = Callable[["Chunk"], None]


class Chunk(NamedTuple):
    """Interval of a motion from ``start`` to ``stop``, as a function from times to states and as polynomials."""

    start: Instant
    stop: Instant
    zero: Instant
    # these take the time since the instant zero; the methods take scene time
    own_states: Callable[[Floats], Floats]
    own_piece: Piece

    def states(self, times: Floats) -> Floats:
        """Return the N states at n times of the scene, s, shape (n, N)."""
        return self.own_states(self.zero.since(times))

    def piece(self) -> Piece:
        """Return the polynomials of this interval of the motion, with times converted to times of the scene."""
        rows, edges = self.own_piece.rows.copy(), self.own_piece.edges + self.zero.low + self.zero.high
        edges[0], edges[-1] = self.start.high, self.stop.high  # the same numbers as in the parts before and after
        time, low = two_sum(self.zero.high, rows[:, 0])
        rows[:, 0], rows[:, 2] = two_sum(time, low + (rows[:, 2] + self.zero.low))
        return Piece(edges, rows)


class SwitchedRun(ModeChanges):
    """The computation of a motion under torques with switching functions, from its start to scene time ``end``, s."""

    def __init__(self, motion: Motion, system: SwitchedSystem, end: float) -> None:
        super().__init__(motion, system, end)
        self.cost = np.zeros(3, dtype=np.int64)  # steps accepted and rejected, evaluations
        self.hopped = False  # whether a short linear motion (_hop) has started at the last switch

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

    def _move_clock(self, zero: Instant) -> None:
        """Set the clock to 0 at the instant ``zero``, the present time of the motion."""
        self.zero, self.t, self.end = zero, 0.0, float(zero.since(self._end.high))
        if self.side * self.end < 0.0:  # within rounding of the end
            self.end = 0.0

    def _check_start(self) -> None:
        """Raise IntegrationStopped if the motion starts at a switch of a function and can go on with either value."""
        for switch in self.system.switches:
            mode = switch.mode
            if mode not in self.system.undecided or not hold(switch.where, self.modes) or self.t == self.end:
                continue
            # two motions: x in sign(x) is zero, and becomes positive with sign = 1 and negative with sign = -1
            if all(self._leaves(mode, self.held, self.system.beside_start(mode, sign)) for sign in (1, -1)):
                way = "past" if self.side < 0.0 else "future"
                raise IntegrationStopped(
                    self.t,
                    f"the motion starts where {self._name(mode)} switches, and can go on with either value of this "
                    f"function: the motion has more than one {way}; change the initial state slightly",
                    self.end,
                )

    def _segment(self, regime: Regime, consume: Consumer) -> Guard | None:
        """Compute the motion up to its next switch, and return the guard that is zero there.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches. ``regime`` is the smooth
        motion for the present values of these functions; ``consume`` takes each :class:`Chunk` of the computed motion.
        The time at which this method stops is stored in :attr:`t`. Return None if the motion reaches its end without a
        switch. Return None also if the values of functions changed at the time :attr:`t`, or if the stepper was stuck
        and one short linear motion (:meth:`_hop`) reached :attr:`t`. The caller then calls this method again, with the
        smooth motion that starts at :attr:`t` with the present values.
        """
        if self.t != 0.0:
            self._move_clock(self._at(self.t))
        rates, values = regime.bound(self.modes, self.zero)
        active = regime.active(self.modes)
        if self.held:
            self._check_held_alone()
            attraction = regime.attraction(self.modes, self.zero, self.t, self.y)
            if not all(value > 0.0 for value in attraction):
                if (guard := self._coincident(regime, active, values, -1)) is None:
                    self._no_longer_held()
                return guard
            if self.attraction[0] != self.held:
                self.attraction = self.held, attraction
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
            return min(violated, key=lambda guard: not self._names_inside(guard.mode) & set(self.order))
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

    def _arrive(self, instant: Instant) -> None:
        """Set the clock to 0 at the instant of a switch of sign, abs, .., unless the motion ends there.

        The lists of functions that switched at the instant before are cleared.
        """
        if self.t != self.end:
            self._move_clock(instant)
        self._forget_changes()
        self.hopped = False

    def _hop(
        self, regime: Regime, active: list[bool], rates: list[float], t: float, y: Floats, error: IntegrationStopped
    ) -> tuple[Piece, Callable[[Floats], Floats], Guard | None] | None:
        """Return a short linear motion (hop) past the time t at which a stepper is stuck; None if it is not accurate.

        The result is the polynomial of the hop, a function from times to states, and a guard: the argument of sign,
        abs, .. that is zero at the end of the hop. The guard is None if the hop starts at the last switch (t = 0):
        such a hop ends at no switch.
        """
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

    def _pass_on(
        self, consume: Consumer, regime: Regime, active: list[bool], chunk: Chunk
    ) -> IntegrationStopped | None:
        """Pass an interval of the motion to ``consume``, up to where an argument of sign, floor, .. has no value.

        ``chunk`` is the interval, ``consume`` the function that takes the intervals of the motion one by one. Return
        the error that names the argument without a value, or None if all arguments have values in the whole interval.
        ``active`` says for each guard of the smooth motion ``regime``, a formula that turns negative where a function
        switches, whether its zero ends this motion; functions whose guards do not end it are left out.
        """
        modes = {guard.mode for guard, on in zip(regime.guards, active, strict=True) if on} - self.held
        partial = [mode for mode in sorted(modes) if mode in regime.may_lose_value]
        if not partial:
            consume(chunk)
            return None
        edges = chunk.own_piece.edges
        steps = np.append(edges[:1], edges[:-1, None] + np.diff(edges)[:, None] * np.arange(1, PROBES + 1) / PROBES)
        for mode in partial:
            times, loses_value = steps, False
            for _ in range(8):  # the first time without a value is enclosed more and more closely
                outside = self._has_no_value(regime, mode, times, chunk.own_states(times))
                if not outside.any():
                    break
                loses_value, first = True, max(int(outside.argmax()), 1)
                times = np.linspace(times[first - 1], times[first], 65)
            if loses_value:
                last = float(times[0])
                if last != edges[0]:
                    rows = int((np.abs(edges[:-1] - edges[0]) < abs(last - edges[0])).sum())
                    part = Piece(np.append(edges[:rows], last), chunk.own_piece.rows[:rows])
                    consume(chunk._replace(stop=self._at(last), own_piece=part))
                return IntegrationStopped(last, f"{self._name(mode)} has no value there", self.end)
        consume(chunk)
        return None

    def _chunk(self, start: float, stop: float, states: Callable[[Floats], Floats], piece: Piece) -> Chunk:
        return Chunk(self._at(start), self._at(stop), self.zero, states, piece)
