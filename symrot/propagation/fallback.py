"""The SciPy fallback: any method of ``scipy.integrate.solve_ivp``, called as :mod:`symrot.propagation.dop853` is.

For where there is no C compiler, and for those who want LSODA. The tolerance means the same as far as SciPy allows: the
error of every block of states against the largest size the block has on the way, found by a first coarse pass, and
shared out over the length of the motion. SciPy is imported when a motion is first followed.
"""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot.errors import InputError
from symrot.propagation.stepping import (
    NOT_FINITE_SENTENCE,
    CutOff,
    Floats,
    Recording,
    Stats,
    both_sides,
    check_longest_step,
    check_tolerance,
    stretches,
)

__all__ = ["METHODS", "FallbackRecording", "integrate", "method_name", "record"]

Rhs = Callable[[float, Floats, Floats], ArrayLike]
Piece = tuple[float, float, Any]  # from, to, SciPy's solution between

METHODS = {"DOP853": 0.1, "RK45": 0.1, "RK23": 0.1, "Radau": 1.0, "BDF": 0.01, "LSODA": 0.05}
"""SciPy's methods, and the share of the tolerance that one step of each is given; calibrated as in dop853.py."""

DEFAULT = "DOP853"
PILOT_TOLERANCE = 1e-3  # of the coarse pass
PILOT_STEPS = 10  # a motion of so many coarse steps may spend the whole share in every step
MAX_EVALUATIONS = 1_000_000_000
MAX_BROKEN = 1000  # derivatives that are not finite, before the motion is given up
SMALLEST_RTOL = 100 * float(np.finfo(float).eps)  # SciPy takes no smaller one


def method_name(text: str) -> str:
    """Return SciPy's name of a method given as ``"scipy"``, ``"scipy:LSODA"`` or ``"LSODA"``.

    Raises
    ------
    InputError
        If SciPy has no such method; the sentence lists those it has.
    """
    name = text.removeprefix("scipy").removeprefix(":") or DEFAULT
    if name not in METHODS:
        raise InputError(f"SciPy's methods are {', '.join('scipy:' + known for known in METHODS)}; got {text!r}")
    return name


def integrate(
    rhs: Rhs,
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    times: ArrayLike,
    tolerance: float,
    *,
    method: str = DEFAULT,
    blocks: Sequence[int] = (0, 3, 7),
    scales: Sequence[float] = (0.0, 1.0),
    breaks: Sequence[float] = (),
    max_step: float = math.inf,
    max_steps: int = MAX_EVALUATIONS,
) -> tuple[Floats, Stats]:
    """Return the states at the sample times, shape (n, N), and what it cost.

    As :func:`symrot.propagation.dop853.integrate`, but for these:

    Parameters
    ----------
    rhs : callable
        ``rhs(t, y, p)`` returns dy, shape (N,).
    method : str
        As :func:`method_name` takes it.
    blocks, scales
        As :func:`symrot.propagation.dop853.translation_unit` takes them; the last edge may lie beyond N.
    max_steps : int
        Most evaluations of ``rhs`` (SciPy tells nothing about steps while it takes them).
    """
    times = np.asarray(times, dtype=np.float64)
    if times.ndim != 1 or not np.isfinite(times).all():
        raise InputError(f"sample times are a sequence of finite numbers, got {times!r}")
    task = _Task(rhs, p, y0, t0, tolerance, method, blocks, scales, breaks, max_step, max_steps)
    states = np.empty((len(times), len(task.y0)))
    for part in both_sides(times, task.t0):
        states[part] = task.follow(times[part])
    return states, task.stats()


def record(
    rhs: Rhs,
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    span: tuple[float, float],
    tolerance: float,
    *,
    method: str = DEFAULT,
    blocks: Sequence[int] = (0, 3, 7),
    scales: Sequence[float] = (0.0, 1.0),
    breaks: Sequence[float] = (),
    max_step: float = math.inf,
    max_steps: int = MAX_EVALUATIONS,
) -> "FallbackRecording":
    """Return the motion over ``span`` as a function of time; see :func:`symrot.propagation.dop853.record`."""
    task = _Task(rhs, p, y0, t0, tolerance, method, blocks, scales, breaks, max_step, max_steps)
    return FallbackRecording(task, min(*span, task.t0), max(*span, task.t0))


class FallbackRecording(Recording):
    """A motion that SciPy has followed; see :class:`symrot.propagation.stepping.Recording`."""

    def __init__(self, task: "_Task", low: float, high: float) -> None:
        self._pieces = [*task.solutions(low), *task.solutions(high)]
        super().__init__(task.t0, task.y0, (low, high), task.stats())

    def edges(self, start: float, end: float) -> list[Floats]:
        """Return the ends of SciPy's steps from a start to an end, one array for each stretch, in that order."""
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
    """Write the states at the times that lie in the pieces."""
    for low, high, solution in pieces:
        chosen = (times >= low) & (times <= high)
        if chosen.any():
            states[chosen] = solution(times[chosen]).T


class _Task:
    """One motion to follow with SciPy."""

    def __init__(
        self,
        rhs: Rhs,
        p: ArrayLike,
        y0: ArrayLike,
        t0: float,
        tolerance: float,
        method: str,
        blocks: Sequence[int],
        scales: Sequence[float],
        breaks: Sequence[float],
        max_step: float,
        max_steps: int,
    ) -> None:
        self.began = perf_counter()
        self.method = method_name(method)
        self.rhs, self.p = rhs, np.array(p, dtype=np.float64)
        self.y0, self.t0 = np.array(y0, dtype=np.float64), float(t0)
        if self.y0.ndim != 1 or not all(np.isfinite(given).all() for given in (self.t0, self.y0, self.p)):
            raise InputError(f"initial time, state and parameters are finite numbers, got {t0!r}, {y0!r}, {p!r}")
        check_tolerance(tolerance)
        check_longest_step(max_step)
        self.tolerance, self.breaks = tolerance, sorted(map(float, breaks))
        self.max_step, self.max_evaluations = max_step, max_steps
        self.blocks = [
            (slice(low, min(high, len(self.y0))), scale)
            for (low, high), scale in zip(pairwise(blocks), scales, strict=True)
            if low < len(self.y0)
        ]
        self.steps = self.evaluations = self.broken = 0
        if not np.isfinite(self._derivative(self.t0, self.y0)).all():
            raise CutOff(self.t0, NOT_FINITE_SENTENCE)

    def stats(self) -> Stats:
        return Stats(self.steps, 0, self.evaluations, perf_counter() - self.began)

    def follow(self, times: Floats) -> Floats:
        """Return the states at times sorted away from t0, all on one side of it."""
        found = np.empty((len(times), len(self.y0)))
        _evaluate(self.solutions(float(times[-1])), times, found)
        found[times == self.t0] = self.y0
        return found

    def solutions(self, end: float) -> list[Piece]:
        """Return (low, high, solution) for each stretch between switching times, from t0 to the end."""
        if end == self.t0:
            return []
        pilot = self._stretches(end, PILOT_TOLERANCE, np.full(len(self.y0), PILOT_TOLERANCE))
        coarse = sum(len(solution.ts) - 1 for _, _, solution in pilot)
        path = np.concatenate([np.abs(solution(solution.ts)) for _, _, solution in pilot], axis=1)
        share = self.tolerance * METHODS[self.method] * min(1.0, PILOT_STEPS / coarse)
        allowed = np.empty(len(self.y0))
        for block, scale in self.blocks:
            size = scale if scale > 0.0 else float(np.sqrt((path[block] ** 2).sum(axis=0).max()))
            # SciPy takes the mean over all states, we the sum over a block
            allowed[block] = share * (size if size > 0.0 else 1.0) / math.sqrt(len(self.y0))
        return self._stretches(end, SMALLEST_RTOL, allowed)

    def _stretches(self, end: float, rtol: float, atol: Floats) -> list[Piece]:
        import scipy.integrate

        solve: Any = scipy.integrate.solve_ivp
        y, pieces = self.y0, []
        for start, stop, first, last in stretches(self.t0, end, self.breaks):
            earliest, latest = min(first, last), max(first, last)
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                found = solve(
                    lambda t, y, earliest=earliest, latest=latest: self._derivative(min(max(t, earliest), latest), y),
                    (start, stop),
                    y,
                    method=self.method,
                    rtol=rtol,
                    atol=atol,
                    max_step=self.max_step,
                    dense_output=True,
                )
            if found.status != 0 or not np.isfinite(found.y[:, -1]).all():
                raise CutOff(float(found.t[-1]), found.message, stop)
            self.steps += len(found.t) - 1
            pieces.append((min(start, stop), max(start, stop), found.sol))
            y = found.y[:, -1]
        return pieces

    def _derivative(self, t: float, y: Floats) -> Floats:
        self.evaluations += 1
        if self.evaluations > self.max_evaluations:
            raise CutOff(t, f"{self.max_evaluations} evaluations were not enough")
        dy = np.asarray(self.rhs(t, y, self.p), dtype=np.float64)
        if dy.shape != self.y0.shape:
            raise InputError(f"the right-hand side returns {len(self.y0)} numbers, got an array of shape {dy.shape}")
        if not math.isfinite(dy.sum()):
            self.broken += 1
            if self.broken > MAX_BROKEN:
                raise CutOff(t, NOT_FINITE_SENTENCE)
        return dy
