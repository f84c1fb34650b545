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
from numpy.typing import ArrayLike, NDArray

from symrot.errors import InputError, PropagationError
from symrot.propagation.dop853 import Stats

__all__ = ["METHODS", "FallbackRecording", "integrate", "method_name", "record"]

Floats = NDArray[np.float64]
Rhs = Callable[[float, Floats, Floats], ArrayLike]

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
    order = np.argsort(times, kind="stable")
    first_after = int(np.searchsorted(times[order], task.t0))
    states = np.empty((len(times), len(task.y0)))
    for part in (order[first_after:], order[:first_after][::-1]):
        if len(part):
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


class FallbackRecording:
    """A motion that can be evaluated at any time of its ``span``; see :class:`symrot.propagation.dop853.Recording`."""

    def __init__(self, task: "_Task", low: float, high: float) -> None:
        self._t0, self._y0, self.span = task.t0, task.y0, (low, high)
        self._pieces = [*task.solutions(low), *task.solutions(high)]
        self.stats = task.stats()

    def __call__(self, t: ArrayLike) -> Floats:
        times = np.asarray(t, dtype=np.float64)
        flat = times.reshape(-1)
        outside = ~((flat >= self.span[0]) & (flat <= self.span[1]))
        if outside.any():
            asked = float(flat[outside][0])
            raise InputError(f"the motion is known from {self.span[0]} to {self.span[1]} s, asked for {asked} s")
        states = np.empty((len(flat), len(self._y0)))
        for low, high, solution in self._pieces:
            chosen = (flat >= low) & (flat <= high)
            if chosen.any():
                states[chosen] = solution(flat[chosen]).T
        states[flat == self._t0] = self._y0
        return states.reshape(*times.shape, len(self._y0))


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
        if not 0.0 < tolerance < 1.0:
            raise InputError(f"the tolerance lies between 0 and 1, got {tolerance}")
        if not max_step > 0.0:
            raise InputError(f"the longest step is a positive number of seconds, got {max_step}")
        self.tolerance, self.breaks = tolerance, sorted(map(float, breaks))
        self.max_step, self.max_evaluations = max_step, max_steps
        self.blocks = [
            (slice(low, min(high, len(self.y0))), scale)
            for (low, high), scale in zip(pairwise(blocks), scales, strict=True)
            if low < len(self.y0)
        ]
        self.steps = self.evaluations = self.broken = 0
        if not np.isfinite(self._derivative(self.t0, self.y0)).all():
            raise PropagationError(
                f"the motion cannot be followed beyond t = {self.t0!r} s: its rate of change is not finite there"
            )

    def stats(self) -> Stats:
        return Stats(self.steps, 0, self.evaluations, perf_counter() - self.began)

    def follow(self, times: Floats) -> Floats:
        """Return the states at times sorted away from t0, all on one side of it."""
        found = np.empty((len(times), len(self.y0)))
        for low, high, solution in self.solutions(float(times[-1])):
            chosen = (times >= low) & (times <= high)
            if chosen.any():
                found[chosen] = solution(times[chosen]).T
        found[times == self.t0] = self.y0
        return found

    def solutions(self, end: float) -> list[tuple[float, float, Any]]:
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

    def _stretches(self, end: float, rtol: float, atol: Floats) -> list[tuple[float, float, Any]]:
        import scipy.integrate

        solve: Any = scipy.integrate.solve_ivp
        low, high = min(self.t0, end), max(self.t0, end)
        inside = [time for time in self.breaks if low < time < high]
        edges = [self.t0, *(inside if end >= self.t0 else reversed(inside)), end]
        y, pieces = self.y0, []
        for start, stop in pairwise(edges):
            first = math.nextafter(start, stop) if start in self.breaks else start
            last = math.nextafter(stop, start) if stop in self.breaks else stop
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
                raise PropagationError(
                    f"the motion cannot be followed beyond t = {float(found.t[-1])!r} s on the way to {stop!r} s: "
                    f"{found.message}"
                )
            self.steps += len(found.t) - 1
            pieces.append((min(start, stop), max(start, stop), found.sol))
            y = found.y[:, -1]
        return pieces

    def _derivative(self, t: float, y: Floats) -> Floats:
        self.evaluations += 1
        if self.evaluations > self.max_evaluations:
            raise PropagationError(
                f"the motion cannot be followed beyond t = {t!r} s: {self.max_evaluations} evaluations were not enough"
            )
        dy = np.asarray(self.rhs(t, y, self.p), dtype=np.float64)
        if dy.shape != self.y0.shape:
            raise InputError(f"the right-hand side returns {len(self.y0)} numbers, got an array of shape {dy.shape}")
        if not math.isfinite(dy.sum()):
            self.broken += 1
            if self.broken > MAX_BROKEN:
                raise PropagationError(
                    f"the motion cannot be followed beyond t = {t!r} s: its rate of change is not finite there"
                )
        return dy
