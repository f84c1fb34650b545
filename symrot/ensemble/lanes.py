"""Taylor series with one trajectory in each SIMD lane: Python calls the C functions of :file:`lanes.c`.

A SIMD instruction computes with two, four or eight doubles at once; a lane holds one of them. Each motion has steps of
its own, so its bits do not depend on other motions. A leg is the part of a motion before or after the initial time.
"""

import ctypes
import os
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build import cache as library
from symrot.build.address import address
from symrot.build.sources import c_text
from symrot.errors import CompilerError
from symrot.formula.program import Program
from symrot.propagation.steppers.integration_stopped import HOPELESS, IntegrationStopped, why_hopeless, why_stuck
from symrot.propagation.steppers.stepping import DONE, NOT_FINITE, PATIENCE, UNDERFLOW, Floats, PathLike, is_sorted
from symrot.propagation.steppers.taylor import step_tail

__all__ = [
    "FLAGS",
    "LaneIntegration",
    "Lanes",
    "Outcome",
    "follow",
    "lanes",
    "order_for",
    "translation_unit",
    "wrap_translation_unit",
]

Integers = NDArray[np.int64]

FLAGS = (*library.FLAGS, *library.TUNING)
MAX_STEPS = 1_000_000_000
STEPS_PER_CALL = 20_000  # steps of all lanes, about 20 ms, after which Python can react to an interrupt
TOO_MANY, HOPELESS_PACE = 5, 7
MEASURED = (
    "reached",
    "steps",
    "evaluations",
    "covered",
)  # results for each leg, the part of a motion on one side of the start
REASONS = {
    NOT_FINITE: "its derivatives are not finite there",
    UNDERFLOW: "the step shrank to nothing, as it does before a singularity",
    TOO_MANY: "{steps} steps were not enough",
}
ORDERS = (
    (3e-2, 10),
    (3e-4, 12),
    (3e-6, 14),
    (3e-9, 16),
    (0.0, 20),
)  # (smallest tolerance, fastest order for it and larger ones), see order_for


def order_for(tolerance: float) -> int:
    """Return the order of the Taylor series that takes the least time for a tolerance, from a table of measurements."""
    # `python -m symrot.bench.ensemble --orders` prints the times
    return next(order for least, order in ORDERS if tolerance >= least)


def translation_unit(
    program: Program, blocks: Sequence[int], scales: Sequence[float], order: int, width: int | None = None
) -> str:
    """Return the C source of a library that integrates many motions in SIMD lanes.

    It contains the Taylor series of the rates and the stepper.

    Parameters
    ----------
    program, blocks, scales, order
        As for :func:`symrot.propagation.steppers.taylor.translation_unit`.
    width : int, optional
        Number of lanes: 1 (plain C), 2, 4 or 8; default: as many as the processor's registers hold.

    Raises
    ------
    InputError
        If the right-hand side is not smooth, for example because it contains abs.
    """
    from symrot.codegen.taylor.ensemble_source import lane_definitions

    return wrap_translation_unit(lane_definitions(program, blocks, scales, order), width)


def wrap_translation_unit(definitions: str, width: int | None = None) -> str:
    """Return the C source of a library that integrates motions in SIMD lanes; ``definitions`` are the Taylor series.

    ``width`` is the number of lanes (1, 2, 4 or 8); default: as many as the processor's registers hold.
    """
    head = "" if width is None else "#define SYMROT_PLAIN\n" if width == 1 else f"#define SYMROT_LANES {width}\n"
    paths = ("propagation/steppers/library.h", "ensemble/lanes.h", "propagation/steppers/series.h", "ensemble/lanes.c")
    shared, operations, series, steps = map(c_text, paths)
    return head + "\n".join((shared, operations, definitions, series, steps))


_POINTERS = (
    "motion", "first", "count", "row", "y", "p", "times", "states", "reached", "steps", "evaluations", "covered",
    "status",
)  # fmt: skip


class _Job(ctypes.Structure):
    """The C struct ``symrot_job`` of lanes.c: the motions that one thread integrates, and where their results go."""

    _fields_ = (
        ("legs", ctypes.c_int64),
        *((name, ctypes.c_double) for name in ("t0", "tail", "pace", "max_steps", "patience", "hopeless")),
        *((name, ctypes.c_void_p) for name in _POINTERS),
        ("next", ctypes.c_int64),
    )


class Outcome(NamedTuple):
    """The results of n motions: their N states at m times, shape (n, m, N), and the cost of each motion, shape (n,)."""

    states: Floats  # NaN at times that a motion did not reach
    steps: Integers
    evaluations: Integers
    messages: tuple[str, ...]  # the reason why a motion stopped early, or an empty text
    warnings: tuple[tuple[str, ...], ...]  # sentences about the accuracy of each motion


class Lanes:
    """A loaded library of :func:`translation_unit`: Taylor series and stepper for many motions in SIMD lanes."""

    def __init__(self, path: str) -> None:
        self.path = path
        try:
            self._library = ctypes.CDLL(path)
            sizes = (ctypes.c_int64 * 5)()
            self._library.symrot_lanes_sizes(sizes)
            carry, self._run = self._library.symrot_lanes_carry, self._library.symrot_lanes_run
        except (OSError, AttributeError) as error:
            raise CompilerError(f"the compiled kernel {path} cannot be loaded: {error}") from error
        self.states, self.parameters, self.order, self.width, self._memory = sizes
        self._run.argtypes, self._run.restype = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64), ctypes.c_int
        carry.argtypes, carry.restype = (ctypes.c_double, ctypes.c_double), ctypes.c_double
        if carry(1.0, 2.0**-60) != 2.0**-60:
            raise CompilerError(
                f"the compiled kernel {path} does not compute the rounding errors of sums correctly; compile it "
                "without -ffast-math"
            )

    def jet(self, t: float, y: Sequence[float], p: Sequence[float], unit: float = 1.0) -> Floats:
        """Return the Taylor coefficients of the states at time t, shape (order + 1, N), in powers of time/``unit``."""
        state, values = np.array(y, dtype=np.float64), np.array(p, dtype=np.float64)
        # row k: the k-th derivatives times unit^k/k!
        coefficients = np.empty((self.order + 1, self.states))
        jet = self._library.symrot_lanes_jet
        pointer, real = ctypes.c_void_p, ctypes.c_double
        jet.argtypes, jet.restype = (real, pointer, pointer, real, ctypes.c_int64, pointer), None
        jet(t, state.ctypes.data, values.ctypes.data, unit, self.order, coefficients.ctypes.data)
        return coefficients

    def work(self, job: _Job, interrupted: Callable[[], bool] = bool) -> None:
        """Integrate all motions of a job; stop early if ``interrupted()`` returns true."""
        memory = ctypes.create_string_buffer(self._memory)
        self._library.symrot_lanes_clear(memory)
        while not interrupted() and self._run(memory, ctypes.addressof(job), STEPS_PER_CALL) != DONE:
            pass


@cache
def lanes(path: str) -> Lanes:
    """Return the compiled library at ``path``, which integrates motions in SIMD lanes; each is loaded only once.

    Its source is that of :func:`translation_unit` or :func:`wrap_translation_unit`.
    """
    return Lanes(path)


class _Legs(NamedTuple):
    """The legs of all motions (the parts after t0 and before t0), and the sample times of each leg."""

    table: Floats  # the times of leg after leg, by their distance from t0; see symrot_job in lanes.c
    rows: Integers  # (4, legs): motion, index of its first time, number of times, row of the first sample
    order: Integers | None  # (m,) or (n, m): sample index of each sorted time; None if the times are already sorted


def _legs(t0: float, times: Floats, n: int) -> _Legs:
    samples, motion = times.shape[-1], np.arange(n)
    if times.ndim == 1 and samples and times[0] >= t0 and is_sorted(times):
        rows = np.empty((4, n), dtype=np.int64)
        rows[0], rows[1], rows[2], rows[3] = motion, 0, samples, motion * samples
        return _Legs(times, rows, None)
    forward = times >= t0
    order = np.lexsort((np.where(forward, times, -times), forward), axis=-1)
    table = np.take_along_axis(times, order, axis=-1)
    backward = np.broadcast_to((~forward).sum(axis=-1), (n,))
    base = motion * (samples if times.ndim == 2 else 0)
    sides = [(backward, 0 * backward), (samples - backward, backward)]
    rows = np.hstack([(motion, base + offset, count, motion * samples + offset) for count, offset in sides])
    in_order = np.array_equal(order, np.broadcast_to(np.arange(samples), order.shape))
    return _Legs(table.ravel(), np.ascontiguousarray(rows[:, rows[2] > 0]), None if in_order else order)


class LaneIntegration:
    """The integration of many motions in SIMD lanes; :meth:`run` can be called any number of times.

    Parameters
    ----------
    path : path
        A library built from :func:`translation_unit`.
    p, y : arrays, shapes (n, P) and (n, N)
        Parameters and initial states.
    t0 : float
        Initial time, s.
    times : array, shape (m,) or (n, m)
        Sample times, s, common to all motions or separate for each motion; in any order, before or after t0.
    tolerance : float
        Tolerance for the error of each trajectory, see :func:`symrot.propagation.steppers.taylor.step_tail`.
    max_steps : int
        Largest number of steps of one motion in each direction of time.
    workers : int
        Number of threads; each thread integrates some of the motions.
    epoch : float
        Time of the scene, s, from which ``t0`` and ``times`` are counted. Times in messages are times of the scene.
    """

    def __init__(
        self, path: PathLike, p: Floats, y: Floats, t0: float, times: Floats, tolerance: float, *,
        max_steps: int = MAX_STEPS, workers: int = 1, epoch: float = 0.0,
    ) -> None:  # fmt: skip
        self.library = lanes(os.fspath(path))
        self.p, self.y, times = (np.ascontiguousarray(array, dtype=np.float64) for array in (p, y, times))
        self.t0, self.max_steps, self.epoch = t0, max_steps, epoch
        self.legs = _legs(t0, times, len(y))
        self.samples, self.total = times.shape[-1], self.legs.rows.shape[1]
        self.workers = max(1, min(workers, self.total))
        tail, pace = step_tail(tolerance)
        self._arguments: dict[str, float] = {"t0": t0, "tail": tail, "pace": pace, "max_steps": float(max_steps)}
        self._arguments |= {"patience": float(PATIENCE), "hopeless": HOPELESS}
        self._arguments |= {"y": address(self.y), "p": address(self.p), "times": address(self.legs.table)}
        self._rows = self._addresses(("motion", "first", "count", "row"), self.legs.rows)

    def _addresses(self, names: Sequence[str], table: NDArray[Any]) -> dict[str, int]:
        """Return a map from each of ``names`` to a memory address: from name k to the address of row k of ``table``."""
        # table has one column for each leg: one motion in one direction of time
        place = address(table)
        return {name: place + 8 * self.total * k for k, name in enumerate(names)}

    def run(self) -> Outcome:
        """Integrate the motions and return their states at the sample times, with the cost of each motion."""
        n, total, legs = len(self.y), self.total, self.legs
        states = np.full((n * self.samples, self.library.states), np.nan)
        measured, status = np.zeros((len(MEASURED), total)), np.full((1, total), TOO_MANY)
        rows = {**self._rows, **self._addresses(MEASURED, measured), **self._addresses(("status",), status)}
        jobs = []
        for k in range(self.workers):
            start, stop = k * total // self.workers, (k + 1) * total // self.workers
            own = {name: place + 8 * start for name, place in rows.items()}
            jobs.append(_Job(legs=stop - start, states=address(states), **self._arguments, **own))
        _share(self.library, jobs)
        counted = np.zeros((2, n), dtype=np.int64)
        if total == n:  # each motion has one leg
            counted[:, legs.rows[0]] = measured[1:3]
        else:
            counted[:] = [np.bincount(legs.rows[0], weights, n) for weights in measured[1:3]]
        grid = states.reshape(n, self.samples, self.library.states)
        if legs.order is not None:
            sorted_grid, grid = grid, np.empty_like(grid)
            np.put_along_axis(grid, np.broadcast_to(legs.order, grid.shape[:2])[..., None], sorted_grid, axis=1)
        messages = self._messages(status[0], measured[0], measured[3]) if status.any() else ("",) * n
        return Outcome(grid, counted[0], counted[1], messages, ((),) * n)

    def _messages(self, status: Integers, reached: Floats, covered: Floats) -> tuple[str, ...]:
        """Return, for each motion, the reason why it stopped early, or an empty text."""
        # status, reached, covered: how each leg (a motion in one direction of time) ended, at which time, and how far
        # its last steps came if they were hopelessly short
        motion, first, samples, _ = self.legs.rows
        messages = [""] * len(self.y)
        for leg in np.flatnonzero(status != DONE).tolist():
            stop, last = float(self.legs.table[first[leg] + samples[leg] - 1]), float(reached[leg])
            if status[leg] == HOPELESS_PACE:
                reason = why_hopeless(PATIENCE, float(covered[leg]), abs(stop - last), self.max_steps)
            else:
                reason = REASONS[int(status[leg])].format(steps=self.max_steps)
            if status[leg] == UNDERFLOW:
                reason = why_stuck(reason, last, self.t0, stop)
            messages[motion[leg]] = str(IntegrationStopped(last, reason, stop).later(self.epoch))
        return tuple(messages)


def follow(*arguments: Any, **options: Any) -> Outcome:
    """Integrate n motions in SIMD lanes, and return their states at the sample times.

    The arguments are those of :class:`LaneIntegration`.
    """
    return LaneIntegration(*arguments, **options).run()


def _share(library: Lanes, jobs: list[Any]) -> None:
    """Integrate the jobs, each in its own thread; an interrupt (Ctrl-C) stops all threads."""
    if len(jobs) == 1:
        library.work(jobs[0])
        return
    from concurrent.futures import ThreadPoolExecutor
    from threading import Event

    interrupted = Event()
    with ThreadPoolExecutor(len(jobs)) as pool:
        try:
            for done in [pool.submit(library.work, job, interrupted.is_set) for job in jobs]:
                done.result()
        finally:
            interrupted.set()
