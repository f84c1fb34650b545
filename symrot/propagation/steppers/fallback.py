"""SciPy as a fallback: motions stepped by any method of ``scipy.integrate.solve_ivp``.

It is used without a C compiler, or on request. The tolerance means the same as for the steppers in C: errors are
relative to the largest norm of each block of states (omega, attitude) along the motion, which a coarse first pass
determines.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.closed_form.arithmetic.double_double import two_sum
from symrot.errors import InputError
from symrot.propagation import progress
from symrot.propagation.enclosures.step_limit import Deviations, longest_followed
from symrot.propagation.steppers.integration_stopped import (
    IntegrationStopped,
    add_samples,
    why_exhausted,
    why_hopeless,
    why_stuck,
)
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.rounding import RoundingSum
from symrot.propagation.steppers.segments import Segment, segments, split_at
from symrot.propagation.steppers.stats import Stats, stats_of
from symrot.propagation.steppers.stepping import (
    NOT_FINITE_SENTENCE,
    Floats,
    check_longest_step,
    check_tolerance,
)

__all__ = ["METHODS", "FallbackRecording", "Options", "WholeMotion", "integrate", "method_name", "record"]

Rhs = Callable[[float, Floats, Floats], ArrayLike]
Clock = Callable[[float], tuple[Rhs, Sequence[float]]]
"""A function of an epoch, s: it returns a right-hand side, whose time begins at the epoch, and the parameters of this
right-hand side.
"""
Piece = tuple[float, float, Any]  # first time, last time, SciPy's solution between them


class WholeMotion(NamedTuple):
    """The whole motion, of which SciPy computes a part: its limits hold for all parts together.

    Attributes
    ----------
    start, end : float
        Its start and end, s.
    spent : int
        Evaluations in earlier parts.
    rounding : RoundingSum
        The rounding errors in earlier parts, to which those of this part are added.
    """

    start: float
    end: float
    spent: int
    rounding: RoundingSum


# Words used here: the right-hand side is the function of the rates, dy/dt. A segment is the time between two switching
# times; a piece is SciPy's solution on one segment. The epoch is the time from which the right-hand side counts.
METHODS = {"DOP853": 0.1, "RK45": 0.1, "RK23": 0.1, "Radau": 1.0, "BDF": 0.01, "LSODA": 0.001}
"""SciPy's methods, each with the share of the tolerance that one step may use, calibrated as in dop853.py."""

DEFAULT = "DOP853"
FIT_ORDER = 7  # degree of the polynomial that the states follow in a step
SLACK = 1e4  # enclosures exceed errors by this factor or less, as in dop853.c
HELD, REGAIN = 0.5, 1.5  # a step above this fraction of the limit was held back; the next may grow by this factor
FAR = 1e4  # steps from the epoch: farther on, the time would be rounded to more than 1e-12 of a step
STUCK = "the step shrank to nothing, as it does before a singularity"
PILOT_TURN = 1e-3  # rad over the whole span: errors of slower rotations are relative to this rate
PILOT_TOLERANCE = 1e-3  # tolerance of the coarse pass
EFFORT_CUT_OFF = 4  # a motion that cannot be followed to its end gets one part in so many of the allowed evaluations
BEFORE_POLE = 0.5  # part of the way of a coarse pass that stops early: beyond it states may grow without bound
PILOT_STEPS = 10  # coarse steps: a shorter motion may use the whole share of the tolerance in every step
MAX_EVALUATIONS = 1_000_000  # default limit: half a minute
PATIENCE = 50_000  # evaluations between two checks of the pace
MAX_IDLE = 100  # consecutive steps too short for the clock of the scene, as after a restart of LSODA
MAX_BROKEN = 1000  # derivatives that are not finite, before the motion stops
_NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, FIT_ORDER + 1) / FIT_ORDER)  # Chebyshev points of a step
# The matrix converts changes of the states at these points to the coefficients of the polynomial.
_FIT = np.linalg.inv(_NODES[:, None] ** np.arange(1, FIT_ORDER + 1))
ROUNDED_STEP = 2.0**-51  # relative rounding error of a step, of either sign
# Relative error that a step of LSODA adds to those before, whatever its tolerance. Measured against closed forms of
# stable motions in 20 to 65 000 steps at tolerances from 1e-15 to 1e-12: at most 3.5 times 2^-52, often far less.
LSODA_DRIFT = 2.0**-50
SMALLEST_RTOL = 100 * float(np.finfo(float).eps)  # the smallest relative tolerance that SciPy accepts


def method_name(text: str) -> str:
    """Return SciPy's name of a method that is given as ``"scipy"``, ``"scipy:LSODA"`` or ``"LSODA"``.

    For ``"scipy"`` alone it is ``"DOP853"``.

    Raises
    ------
    InputError
        If SciPy has no such method; the message lists its methods.
    """
    name = text.removeprefix("scipy").removeprefix(":") or DEFAULT
    if name not in METHODS:
        raise InputError(f"method: expected one of {', '.join('scipy:' + known for known in METHODS)}, got {text!r}")
    return name


@dataclass(frozen=True)
class Options:
    """Method and limits with which SciPy follows a motion.

    Attributes
    ----------
    method : str
        Name of a SciPy method, as for :func:`method_name`.
    blocks, scales
        As for :func:`symrot.propagation.steppers.dop853.translation_unit`; the last edge of ``blocks`` may exceed the
        number of states N.
    breaks, max_step
        As for :func:`symrot.propagation.steppers.dop853.integration`.
    max_steps : int
        Largest number of evaluations of the right-hand side.
    deviations : Deviations, optional
        Bounds on how far the right-hand side may change within a step. They limit the steps, so that no step misses a
        short pulse.
    clock : callable, optional
        A :data:`Clock`: takes an epoch, s, and returns the right-hand side that takes the time since the epoch, and its
        parameters. Thus a step at a late time t keeps its digits, even if it is very short compared with t.
    whole : WholeMotion, optional
        The whole motion, if only a part of it is followed. Then ``max_steps`` is the limit for the whole motion.
    """

    method: str = DEFAULT
    blocks: Sequence[int] = (0, 3, 7)
    scales: Sequence[float] = (0.0, 1.0)
    breaks: Sequence[float] = ()
    max_step: float = math.inf
    max_steps: int = MAX_EVALUATIONS
    deviations: Deviations | None = None
    clock: Clock | None = None
    whole: WholeMotion | None = None


def integrate(
    rhs: Rhs, p: ArrayLike, y0: ArrayLike, t0: float, times: ArrayLike, tolerance: float, options: Options = Options()
) -> tuple[Floats, Stats]:
    """Return the N states at the n sample times, shape (n, N), and the cost in steps and evaluations.

    Parameters
    ----------
    rhs : callable
        ``rhs(t, y, p)`` returns dy, shape (N,).
    p, y0, t0, tolerance
        As for :func:`symrot.propagation.steppers.dop853.integration`.
    times : array, shape (n,)
        Sample times, s, in any order, before or after ``t0``.
    options : Options
        The method and the limits of its steps.
    """
    times = np.asarray(times, dtype=np.float64)
    if times.ndim != 1 or not np.isfinite(times).all():
        raise InputError(f"times: expected a sequence of finite sample times in s, got {times!r}")
    motion = _Integration(rhs, p, y0, t0, tolerance, options)
    states = np.empty((len(times), len(motion.y0)))
    done = np.empty(0, dtype=np.intp)
    for part in split_at(times, motion.t0):
        try:
            states[part] = motion.follow(times[part])
        except (IntegrationStopped, KeyboardInterrupt) as error:
            inside, own = motion.partial(times[part])
            add_samples(error, part[inside], own, motion.stats())
            add_samples(error, done, states[done], motion.stats())
            raise
        done = np.concatenate([done, part])
    return states, motion.stats()


def record(
    rhs: Rhs,
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    span: tuple[float, float],
    tolerance: float,
    options: Options = Options(),
) -> "FallbackRecording":
    """Return the motion over ``span``, s, widened to contain ``t0``, as a function from times to states."""
    motion = _Integration(rhs, p, y0, t0, tolerance, options)
    low, high = min(*span, motion.t0), max(*span, motion.t0)
    finished: list[Piece] = []
    try:
        for end in (low, high):
            finished += motion.solutions(end)
    except (IntegrationStopped, KeyboardInterrupt) as error:
        finished += motion.pieces if motion.final else []
        if finished:
            ends = [time for low, high, _ in finished for time in (low, high)]
            # the motion before the stop or interrupt; absent if it stopped at its start
            error.recording = FallbackRecording(motion, finished, min(ends), max(ends))  # type: ignore[union-attr]
        raise
    return FallbackRecording(motion, finished, low, high)


class FallbackRecording(Recording):
    """A motion integrated by SciPy as a function from times in its span to states, made of SciPy's interpolants."""

    def __init__(self, motion: "_Integration", pieces: list[Piece], low: float, high: float) -> None:
        self._pieces = pieces
        super().__init__(motion.t0, motion.y0, (low, high), motion.stats())

    def edges(self, start: float, end: float) -> list[Floats]:
        """Return the ends of SciPy's steps, s, one array for each smooth part of the motion from ``start`` to ``end``.

        Only the smooth parts that lie entirely between these times are included.
        """
        side = 1.0 if end >= start else -1.0
        chosen = [
            np.sort(np.asarray(solution.ts, dtype=np.float64) * side) * side
            for low, high, solution in self._pieces
            if low >= min(start, end) and high <= max(start, end)
        ]
        return sorted(chosen, key=lambda edges: side * float(edges[0]))

    def _fill(self, times: Floats, states: Floats) -> None:
        _evaluate(self._pieces, times, states)


def _evaluate(pieces: list[Piece], times: Floats, states: Floats) -> None:
    """Write the states at ``times`` into ``states``, shape (n, N), by pieces (first time, last time, solution)."""
    for low, high, solution in pieces:
        chosen = (times >= low) & (times <= high)
        if chosen.any():
            states[chosen] = solution(times[chosen]).T


class _ShiftedSolution:
    """SciPy's interpolant of one step, as a function of the time of the motion, s.

    The interpolant that is wrapped takes the time since ``epoch``, s.
    """

    def __init__(self, solution: Any, epoch: float) -> None:
        self._solution, self._epoch = solution, epoch

    def __call__(self, t: Floats) -> Floats:
        states: Floats = self._solution(t - self._epoch)
        return states


class _Integration:
    """Integration of one motion by SciPy, with the arguments of :func:`integrate`: checked arguments, and cost."""

    def __init__(self, rhs: Rhs, p: ArrayLike, y0: ArrayLike, t0: float, tolerance: float, options: Options) -> None:
        self.began = perf_counter()
        self.method, self.clock, self.deviations = method_name(options.method), options.clock, options.deviations
        self.rhs, self.p, self.epoch = rhs, np.array(p, dtype=np.float64), 0.0
        self.unmoved = self.rhs, self.p
        self.y0, self.t0 = np.array(y0, dtype=np.float64), float(t0)
        if self.y0.ndim != 1 or not all(np.isfinite(values).all() for values in (self.t0, self.y0, self.p)):
            raise InputError(
                f"expected finite numbers as initial time, state and parameters, got {t0!r}, {y0!r}, {p!r}"
            )
        check_tolerance(tolerance)
        check_longest_step(options.max_step)
        self.tolerance, self.breaks = tolerance, sorted(map(float, options.breaks))
        self.max_step, self.max_evaluations = options.max_step, options.max_steps
        self.blocks = [
            (slice(low, min(high, len(self.y0))), scale)
            for (low, high), scale in zip(pairwise(options.blocks), options.scales, strict=True)
            if low < len(self.y0)
        ]
        self.steps = self.evaluations = self.broken = 0
        self.pieces: list[Piece] = []  # pieces of the pass that is running, or that stopped early
        self.final = False  # whether this is the final pass, not the coarse one
        # rounding errors, one sum for each side of t0
        self.sums = [options.whole.rounding] if options.whole else []
        self.mark = (0, self.t0)  # work and time at the last check of the pace
        self.whole, self.before = options.whole, self.deviations.spent if self.deviations else 0
        with np.errstate(all="ignore"):  # the error below reports it
            first = self._derivative(self.t0, self.y0)
        if not np.isfinite(first).all():
            raise IntegrationStopped(self.t0, NOT_FINITE_SENTENCE)

    @property
    def work(self) -> int:
        """Number of evaluations so far: of the rates, and of the bounds of the rates that limit the steps.

        The option ``max_steps`` limits this number.
        """
        return self.evaluations + (self.deviations.spent - self.before if self.deviations else 0)

    def stats(self) -> Stats:
        rounded = [each.beyond for each in self.sums if each.beyond is not None]
        return stats_of((self.steps, 0, self.evaluations), perf_counter() - self.began, (), rounded)

    def follow(self, times: Floats) -> Floats:
        """Return the N states at n times, shape (n, N); the times are on one side of t0, sorted by distance from t0."""
        states = np.empty((len(times), len(self.y0)))
        _evaluate(self.solutions(float(times[-1])), times, states)
        states[times == self.t0] = self.y0
        return states

    def partial(self, times: Floats) -> tuple[NDArray[np.intp], Floats]:
        """Return the indices and the states of those sample times that the motion reached before it stopped early."""
        pieces = self.pieces if self.final else []  # results of the coarse pass are not returned
        way = max((max(abs(low - self.t0), abs(high - self.t0)) for low, high, _ in pieces), default=0.0)
        # all times lie on one side of t0
        inside = np.flatnonzero(np.abs(times - self.t0) <= way)
        states = np.empty((len(inside), len(self.y0)))
        _evaluate(pieces, times[inside], states)
        states[times[inside] == self.t0] = self.y0
        return inside, states

    def solutions(self, end: float) -> list[Piece]:
        """Return the motion from t0 to ``end`` as pieces (first time, last time, solution) between switching times."""
        self.final, self.pieces = False, []
        if end == self.t0:
            return []
        # a coarse pass determines the sizes of the states, for the error control of the final pass
        slowest = PILOT_TURN / abs(end - self.t0)  # rad/s: a slower rotation does not count
        bars = [
            SLACK * PILOT_TOLERANCE * (scale if scale > 0.0 else max(float(np.linalg.norm(self.y0[block])), slowest))
            for block, scale in self.blocks
        ]
        early: IntegrationStopped | None = None
        try:
            self._segments(end, PILOT_TOLERANCE, np.full(len(self.y0), PILOT_TOLERANCE), bars)
        except IntegrationStopped as error:
            if not self.pieces or self._spent >= self.max_evaluations:
                raise
            # the final pass still computes the motion up to here before the error is raised
            early, end = error, float(self.pieces[-1][2].ts[-1])
            self.max_evaluations = min(self.max_evaluations, self.evaluations + self.max_evaluations // EFFORT_CUT_OFF)
        way = abs(end - self.t0) * (1.0 if early is None else BEFORE_POLE)
        pilot = [(solution, solution.ts[np.abs(solution.ts - self.t0) <= way]) for _, _, solution in self.pieces]
        coarse = sum(len(solution.ts) - 1 for solution, _ in pilot)
        path = np.concatenate([np.abs(solution(times)) for solution, times in pilot if len(times)], axis=1)
        share = self.tolerance * METHODS[self.method] * min(1.0, PILOT_STEPS / coarse)
        allowed, bars = np.empty(len(self.y0)), []
        for block, scale in self.blocks:
            size = scale if scale > 0.0 else float(np.sqrt((path[block] ** 2).sum(axis=0).max()))
            bars.append(SLACK * share * max(size, slowest))
            # SciPy averages squared errors over all states; here they are summed over a block
            allowed[block] = share * max(size, slowest) / math.sqrt(len(self.y0))
        if self.whole is None:
            self.sums.append(RoundingSum(self.tolerance))
        self.size = bars[0] / (SLACK * share)  # of the first block, to which its errors are relative
        self.final = True
        try:
            pieces = self._segments(end, SMALLEST_RTOL, allowed, bars)
        except IntegrationStopped as error:
            raise error if early is None else IntegrationStopped(error.t, error.reason, early.stop) from None
        if early is not None:
            raise early
        return pieces

    def _segments(self, end: float, rtol: float, atol: Floats, bars: list[float]) -> list[Piece]:
        y, self.pieces, self.mark, self.goal = self.y0, [], (self.work, self.t0), end
        self.epoch, (self.rhs, self.p) = 0.0, self.unmoved
        for segment in segments(self.t0, end, self.breaks):
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                self._follow_segment(segment, y, rtol, atol, bars)
            y = self.pieces[-1][2](segment.stop)
        return self.pieces

    def _follow_segment(self, segment: Segment, y: Floats, rtol: float, atol: Floats, bars: list[float]) -> None:
        """Integrate over a segment from the state ``y``, and append SciPy's solution to ``pieces``.

        ``bars``: for each block of states (omega, attitude), the largest error that a step may have because it misses a
        change of the rates, such as a short pulse.
        """
        import scipy.integrate

        earliest, latest = min(segment.first, segment.last), max(segment.first, segment.last)
        new_solver: Any = getattr(scipy.integrate, self.method)

        def begin(t: float, y: Floats, longest: float) -> Any:
            low, high = earliest - self.epoch, latest - self.epoch

            def rate(t: float, y: Floats) -> Floats:
                return self._derivative(min(max(t, low), high), y)

            return new_solver(rate, t, y, segment.stop - self.epoch, rtol=rtol, atol=atol, max_step=longest)

        times: list[float] = [segment.start]
        interpolants: list[Any] = []
        try:
            self._steps(begin, y, segment, bars, times, interpolants)
        # also the part of the motion before an error or interrupt
        finally:
            if interpolants:
                lagging = self.method in ("BDF", "LSODA")  # their steps hold the end that they begin at
                times = times[: len(interpolants) + 1]  # an interrupt may come between the two appends
                solution = scipy.integrate.OdeSolution(times, interpolants, alt_segment=lagging)
                self.pieces.append((min(times[0], times[-1]), max(times[0], times[-1]), solution))

    def _steps(
        self, begin: Any, y: Floats, segment: Segment, bars: list[float], times: list[float], interpolants: list[Any]
    ) -> None:
        longest, idle = self.max_step, 0
        solver = begin(segment.start - self.epoch, y, longest)
        while solver.status == "running":
            start, end = (self.whole.start, self.whole.end) if self.whole else (self.t0, segment.stop)
            now, y = float(solver.t), solver.y.copy()  # time on the present clock
            before = self.epoch + now
            progress.report(before if self.final else self.t0, start, end if self.whole else self.goal)
            self._judge_pace(before, end if self.final else segment.stop)  # a coarse pass has its own end
            broken = self.broken
            try:
                message = solver.step()
            except (ValueError, IntegrationStopped):  # ValueError: linear algebra rejects numbers that are not finite
                longest = 0.5 * min(float(solver.h_abs), abs(segment.stop - before), longest)
                if longest <= 4.0 * math.ulp(before):
                    raise IntegrationStopped(before, NOT_FINITE_SENTENCE, end) from None
                solver = begin(now, y, longest)
                continue
            step = float(solver.t) - now
            if self.broken > broken and not np.isfinite(self._derivative(float(solver.t), solver.y)).all():
                if abs(step) <= 4.0 * math.ulp(before):
                    raise IntegrationStopped(before, NOT_FINITE_SENTENCE, end)
                longest = 0.5 * abs(step)  # LSODA continues where the rates have no value
                solver = begin(now, y, longest)
                continue
            after = segment.stop if solver.status == "finished" else self.epoch + float(solver.t)
            moves = (
                solver.status != "failed" and step * solver.direction > 0.0
            )  # LSODA may report success without a step
            if self.clock is not None and abs(now) > FAR * abs(step) and abs(now) > math.ulp(before):
                now = self._move_clock(self.clock, now)
                solver = begin(now, y, longest)
                continue
            idle = idle + 1 if after == before else 0
            if message == solver.TOO_SMALL_STEP or (solver.status != "failed" and not moves) or idle > MAX_IDLE:
                raise IntegrationStopped(before, why_stuck(STUCK, before, start, end), end)
            if solver.status == "failed" or not np.isfinite(solver.y).all():
                raise IntegrationStopped(after, message or NOT_FINITE_SENTENCE, end)
            dense = solver.dense_output()
            proven = step if self.deviations is None else self._proven(before, y, dense, now, step, bars)
            if proven != step:
                if abs(proven) <= 4.0 * math.ulp(before):
                    raise IntegrationStopped(before, why_stuck(STUCK, before, start, end), end)
                longest = abs(proven)
                solver = begin(now, y, longest)
                continue
            if self.final:
                self._add_rounding(before, y, abs(step))
            self.steps += 1
            if after != before:
                times.append(after)
                interpolants.append(_ShiftedSolution(dense, self.epoch) if self.epoch else dense)
            if longest < self.max_step and abs(step) > HELD * longest and solver.status == "running":
                longest = min(REGAIN * longest, self.max_step)
                if self.method == "LSODA":
                    solver = begin(solver.t, solver.y.copy(), longest)
                else:  # the other methods read it before every step
                    solver.max_step = longest

    def _add_rounding(self, t: float, y: Floats, length: float) -> None:
        """Add the rounding errors of one step to the sum of the rounding errors of the motion.

        The step begins with the states ``y`` at the time ``t``, s, and has the length ``length``, s.
        """
        error, drift = ROUNDED_STEP * self.size, LSODA_DRIFT * self.size if self.method == "LSODA" else 0.0
        if self.deviations:
            errors = self.deviations.rounding_errors(t, y.tolist())
            error = math.hypot(error, length * max(errors[self.blocks[0][0]], default=0.0))
        self.sums[-1].add(t, error, self.size, drift)

    def _move_clock(self, clock: Clock, now: float) -> float:
        """Move the epoch to the present time; return the present time minus the rounded new epoch, s.

        The epoch is the time from which the right-hand side counts, ``now`` the present time since the old epoch, s.
        ``clock`` takes the new epoch and returns a right-hand side that counts from it, with its parameters.
        """
        self.epoch, rest = two_sum(self.epoch, now)
        self.rhs, p = clock(self.epoch)
        self.p = np.array(p, dtype=np.float64)
        return float(rest)

    def _judge_pace(self, t: float, stop: float) -> None:
        """Raise IntegrationStopped if the evaluations up to the time t, s, exceed their limit.

        Raise it early if, at the present pace, the motion would need far more evaluations up to ``stop`` than the limit
        allows.
        """
        work = self.work
        spent = work - self.mark[0]
        if spent >= PATIENCE:
            reason = why_hopeless(spent, abs(t - self.mark[1]), abs(stop - t), self.max_evaluations)
            if reason:
                raise IntegrationStopped(t, reason, stop)
            self.mark = (work, t)
        if self._spent > self.max_evaluations:
            raise IntegrationStopped(t, why_exhausted(self.max_evaluations), stop)

    @property
    def _spent(self) -> int:
        return self.work + (self.whole.spent if self.whole else 0)

    def _proven(self, t: float, y: Floats, dense: Any, now: float, step: float, bars: list[float]) -> float:
        """Return a length, s, at most ``step``, over which a pulse that SciPy misses is proven to cause a small error.

        A pulse is missed if it lies between the times at which SciPy evaluates the rates in a step. The step begins
        with the states ``y`` at the scene time ``t``, when SciPy's clock shows ``now``; ``dense`` is SciPy's
        interpolant. ``bars``: for each block of states (omega, attitude), the largest error allowed.
        """
        assert self.deviations is not None
        path = np.abs(_FIT @ (dense(now + _NODES * step).T - y)).T.tolist()
        edges = [0, *(block.stop for block, _ in self.blocks)]
        return longest_followed(self.deviations, t, y.tolist(), path, step, bars, edges, FIT_ORDER)

    def _derivative(self, t: float, y: Floats) -> Floats:
        self.evaluations += 1
        if self.evaluations > self.max_evaluations:
            raise IntegrationStopped(self.epoch + float(t), why_exhausted(self.max_evaluations))
        dy = np.asarray(self.rhs(t, y, self.p), dtype=np.float64)
        if dy.shape != self.y0.shape:
            raise InputError(
                f"expected a right-hand side that returns {len(self.y0)} numbers, got an array of shape {dy.shape}"
            )
        if not math.isfinite(dy.sum()):
            self.broken += 1
            if self.broken > MAX_BROKEN:
                raise IntegrationStopped(self.epoch + float(t), NOT_FINITE_SENTENCE)
        return dy
