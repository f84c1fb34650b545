"""Dormand-Prince 8(5,3) around an emitted kernel: the C of :file:`dop853.c` driven from Python, one call per span.

A library holds one kernel and the stepper compiled together (:func:`translation_unit`); :func:`integrate` follows a
motion through sample times, :func:`record` keeps every step so that the motion can be asked for at any time later.

Tolerance: the promise is about the trajectory, not about one step, see :func:`step_tolerance`.
"""

import ctypes
import math
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.errors import CompilerError, InputError, PropagationError

__all__ = ["MAX_STEPS", "Recording", "Stats", "integrate", "record", "step_tolerance", "translation_unit"]

MAX_STEPS = 1_000_000_000
STEPS_PER_CALL = 100_000  # some 20 ms in C, after which Python can see an interrupt
STEP_SHARE, NATURAL_TIMES = 0.14, 0.16  # of the tolerance; of the span, see step_tolerance
ROWS_PER_CALL = 256  # steps recorded per call

Floats = NDArray[np.float64]

_DONE, _PAUSED, _FULL, _NOT_FINITE, _UNDERFLOW = range(5)
# The fields of symrot_run in dop853.c: numbers, integers, and vectors of one number per state.
_REALS = ("t", "h", "growth", "stop", "first", "last", "tolerance", "pace", "max_step")
_INTEGERS = ("next", "accepted", "rejected", "evaluations", "recorded")
_VECTORS = ("y", "carry", "dy")


class Stats(NamedTuple):
    """What a propagation cost: steps kept and tried again, evaluations of the kernel, seconds in all."""

    accepted: int
    rejected: int
    evaluations: int
    seconds: float


def step_tolerance(tolerance: float) -> tuple[float, float]:
    """Return the error allowed in one step, and the fraction of the span that earns a step all of it.

    A shorter step is allowed its share. Steps are about ``tolerance^(1/8)`` times as long as the motion's natural time,
    so the second number makes the allowance a matter of natural times in the span, not of steps: the error at the end
    then hardly depends on tolerance or span, except where the motion itself amplifies errors.

    Both constants are calibrated on free asymmetric bodies, through flips about the intermediate axis too, and on heavy
    tops, against 40-digit references (``tests/test_dop853.py``): errors stay below 5 times the tolerance.
    """
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"the tolerance lies between 0 and 1, got {tolerance}")
    return tolerance * STEP_SHARE, tolerance**0.125 * NATURAL_TIMES


def translation_unit(
    kernel: str,
    name: str,
    states: int,
    parameters: int,
    blocks: Sequence[int] = (0, 3, 7),
    scales: Sequence[float] = (0.0, 1.0),
) -> str:
    """Return the C source of a library: the kernel and the stepper around it.

    Parameters
    ----------
    kernel : str
        C source that defines ``static inline void name(double t, const double y[], const double p[], double dy[])``.
    name : str
        The kernel's name in C.
    states, parameters : int
        Lengths of y and p.
    blocks : sequence of int
        Edges of the blocks of states whose errors are judged apart, from 0 to ``states``: omega, then quaternion.
    scales : sequence of float
        One per block: 0 judges its error against the block's own size (a rate), a positive number against that number
        (1 for a unit quaternion, or for an angle in rad).
    """
    edges = list(blocks)
    if edges[:1] != [0] or edges[-1] != states or edges != sorted(set(edges)) or len(scales) != len(edges) - 1:
        raise InputError(
            f"blocks of {states} states rise from 0 to {states} and have one scale each; got blocks {edges} and "
            f"scales {list(scales)}"
        )
    here = Path(__file__).parent
    return "\n".join(
        (
            kernel,
            f"#define SYMROT_STATES {states}",
            f"#define SYMROT_PARAMETERS {parameters}",
            f"#define SYMROT_RHS {name}",
            f"#define SYMROT_BLOCKS {{{', '.join(map(str, edges))}}}",
            f"#define SYMROT_SCALES {{{', '.join(map(repr, map(float, scales)))}}}",
            (here / "dop853_tableau.h").read_text(encoding="utf-8"),
            (here / "dop853.c").read_text(encoding="utf-8"),
        )
    )


def integrate(
    library: str | os.PathLike[str],
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    times: ArrayLike,
    tolerance: float,
    *,
    breaks: Sequence[float] = (),
    max_step: float = math.inf,
    max_steps: int = MAX_STEPS,
) -> tuple[Floats, Stats]:
    """Return the states at the sample times, and what it cost.

    Parameters
    ----------
    library : path
        Built from :func:`translation_unit`.
    p, y0 : arrays, shapes (parameters,) and (N,)
        Parameters of the kernel; state at ``t0``.
    t0 : float
        Initial time, s.
    times : array, shape (n,)
        Sample times, s, in any order, before or after ``t0``, repeated or not. The steps depend on the first and last
        of them only.
    tolerance : float
        Aim for the error of the whole trajectory, see :func:`step_tolerance`.
    breaks : sequence of float
        Times at which the kernel jumps; the motion is stepped exactly to each and started anew behind it.
    max_step : float
        Longest step, s, where the kernel has features that a longer one could pass over.
    max_steps : int
        Most steps to try before giving up.

    Returns
    -------
    states : array, shape (n, N), C layout
    stats : Stats

    Raises
    ------
    InputError
        If a shape, a time or the tolerance cannot be used.
    PropagationError
        If the motion cannot be followed to the end; the sentence says how far it came.
    """
    began = perf_counter()
    task = _Task(library, p, y0, t0, tolerance, breaks, max_step, max_steps)
    times = np.asarray(times, dtype=np.float64, order="C")
    if times.ndim != 1:
        raise InputError(f"sample times are a sequence of numbers, got an array of shape {times.shape}")
    count = len(times)
    states = np.empty((count, task.stepper.states))
    if count == 0:
        return states, task.stats(began)
    low, high = float(times[0]), float(times[-1])
    if low >= task.t0 and (count == 1 or bool((times[1:] >= times[:-1]).all())):
        if not math.isfinite(high):
            raise InputError(f"sample times must be finite, got {high}")
        task.follow(times, states)
        return states, task.stats(began)
    if not bool(np.isfinite(times).all()):
        raise InputError(f"sample times must be finite, got {times[~np.isfinite(times)][0]}")
    order = np.argsort(times, kind="stable")
    first_after = int(np.searchsorted(times[order], task.t0))
    for part in (order[first_after:], order[:first_after][::-1]):
        if len(part):
            found = np.empty((len(part), task.stepper.states))
            task.follow(times[part], found)
            states[part] = found
    return states, task.stats(began)


def record(
    library: str | os.PathLike[str],
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    span: tuple[float, float],
    tolerance: float,
    *,
    breaks: Sequence[float] = (),
    max_step: float = math.inf,
    max_steps: int = MAX_STEPS,
) -> "Recording":
    """Return the motion over ``span`` as a function of time; arguments as :func:`integrate`.

    The same steps are taken as by :func:`integrate` to the ends of the span, so the two agree where they overlap. One
    step takes 8 N + 2 numbers of memory.
    """
    began = perf_counter()
    task = _Task(library, p, y0, t0, tolerance, breaks, max_step, max_steps)
    low, high = min(span), max(span)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise InputError(f"a span runs between two finite times, got {span}")
    rows = [np.concatenate(task.keep(end)) for end in (min(low, task.t0), max(high, task.t0))]
    return Recording(task.stepper, task.t0, task.y0, rows[0], rows[1], task.stats(began))


class Recording:
    """A motion that can be evaluated at any time of its span: ``recording(t)``.

    ``recording(t)`` returns the states at a time or an array of times, shape (N,) or (n, N); a time outside ``span`` is
    an InputError. ``stats`` says what the recording cost.
    """

    def __init__(
        self, stepper: "_Stepper", t0: float, y0: list[float], backward: Floats, forward: Floats, stats: Stats
    ) -> None:
        self._stepper, self._t0, self._y0, self._backward, self._forward = stepper, t0, y0, backward, forward
        self.stats = stats
        ends = [float(rows[-1, 0] + rows[-1, 1]) if len(rows) else t0 for rows in (backward, forward)]
        self.span = (ends[0], ends[1])

    def __call__(self, t: ArrayLike) -> Floats:
        times = np.asarray(t, dtype=np.float64)
        flat = np.ascontiguousarray(times).reshape(-1)
        outside = ~((flat >= self.span[0]) & (flat <= self.span[1]))
        if outside.any():
            asked = float(flat[outside][0])
            raise InputError(f"the motion is known from {self.span[0]} to {self.span[1]} s, asked for {asked} s")
        states = np.empty((len(flat), self._stepper.states))
        for rows, chosen in ((self._backward, flat < self._t0), (self._forward, flat > self._t0)):
            if chosen.any():
                states[chosen] = self._stepper.dense(rows, flat[chosen])
        states[flat == self._t0] = self._y0
        return states.reshape(*times.shape, self._stepper.states)


class _Stepper:
    """The functions of one loaded library."""

    def __init__(self, path: str) -> None:
        try:
            library = ctypes.CDLL(path)
            self.run, self._dense = library.symrot_dop853, library.symrot_dop853_dense
            sizes = library.symrot_dop853_sizes
        except (OSError, AttributeError) as error:
            raise CompilerError(f"the compiled kernel {path} cannot be loaded: {error}") from error
        pointer, integer = ctypes.c_void_p, ctypes.c_int64
        self.run.argtypes = (pointer, pointer, pointer, integer, pointer, pointer, integer, integer)
        self.run.restype = ctypes.c_int
        self._dense.argtypes = (pointer, integer, pointer, integer, pointer)
        self._dense.restype = None
        sizes.restype = None
        found = (ctypes.c_int64 * 2)()
        sizes(found)
        self.states, self.parameters = found[0], found[1]
        self.row = 2 + 8 * self.states
        vector = ctypes.c_double * self.states
        kinds = ((_REALS, ctypes.c_double), (_INTEGERS, integer), (_VECTORS, vector))
        fields = [(name, kind) for names, kind in kinds for name in names]
        self.new_run: Any = type("Run", (ctypes.Structure,), {"_fields_": fields})
        self.new_parameters: Any = ctypes.c_double * self.parameters

    def dense(self, rows: Floats, times: Floats) -> Floats:
        states = np.empty((len(times), self.states))
        self._dense(rows.ctypes.data, len(rows), times.ctypes.data, len(times), states.ctypes.data)
        return states


_loaded: dict[str, _Stepper] = {}


def _stepper(library: str | os.PathLike[str]) -> _Stepper:
    path = os.fspath(library)
    if path not in _loaded:
        _loaded[path] = _Stepper(path)
    return _loaded[path]


class _Task:
    """One motion to follow: checked input, and the counts of all calls made for it."""

    def __init__(
        self,
        library: str | os.PathLike[str],
        p: ArrayLike,
        y0: ArrayLike,
        t0: float,
        tolerance: float,
        breaks: Sequence[float],
        max_step: float,
        max_steps: int,
    ) -> None:
        self.stepper = _stepper(library)
        self.p = self.stepper.new_parameters(*_numbers("parameters", p, self.stepper.parameters))
        self.y0 = _numbers("states", y0, self.stepper.states)
        self.t0, self.max_step, self.max_steps = float(t0), float(max_step), max_steps
        self.breaks = sorted(map(float, breaks))
        if not math.isfinite(self.t0):
            raise InputError(f"the initial time must be finite, got {t0}")
        if not self.max_step > 0.0:
            raise InputError(f"the longest step is a positive number of seconds, got {max_step}")
        self.tolerance, self.pace = step_tolerance(tolerance)
        self.accepted = self.rejected = self.evaluations = 0

    def stats(self, began: float) -> Stats:
        return Stats(self.accepted, self.rejected, self.evaluations, perf_counter() - began)

    def follow(self, times: Floats, states: Floats) -> None:
        """Write the states at times sorted away from t0, all on one side of it."""
        count, done, first, out = len(times), 0, times.ctypes.data, states.ctypes.data
        row = 8 * self.stepper.states
        for run in self._stretches(float(times[-1])):
            status = _PAUSED
            while status != _DONE:
                status = self._advance(run, first + 8 * done, count - done, out + row * done, None, 0)
            done += run.next

    def keep(self, end: float) -> list[Floats]:
        """Return the recorded steps from t0 to an end, in pieces."""
        pieces = [np.empty((0, self.stepper.row))]
        for run in self._stretches(end):
            status = _PAUSED
            while status != _DONE and run.t != run.stop:
                rows = np.empty((ROWS_PER_CALL, self.stepper.row))
                status = self._advance(run, None, 0, None, rows.ctypes.data, ROWS_PER_CALL)
                pieces.append(rows[: run.recorded])
        return pieces

    def _stretches(self, end: float) -> Iterator[Any]:
        """Yield the C side's run, set up for each stretch between switching times, and count what it cost."""
        run = self.stepper.new_run(
            t=self.t0, tolerance=self.tolerance, pace=abs(end - self.t0) * self.pace, max_step=self.max_step
        )
        run.y[:] = self.y0
        low, high = min(self.t0, end), max(self.t0, end)
        inside = [time for time in self.breaks if low < time < high]
        for stop in (*(inside if end >= self.t0 else reversed(inside)), end):
            start = run.t
            run.h, run.stop, run.next = 0.0, stop, 0
            run.first = math.nextafter(start, stop) if start in self.breaks else start
            run.last = math.nextafter(stop, start) if stop in self.breaks else stop
            yield run
        self.accepted += run.accepted
        self.rejected += run.rejected
        self.evaluations += run.evaluations

    def _advance(self, run: Any, times: int | None, count: int, states: int | None, rows: int | None, room: int) -> int:
        """Call the stepper once; raise where it cannot go on."""
        attempts = min(STEPS_PER_CALL, self.max_steps - run.accepted - run.rejected)
        status: int = self.stepper.run(
            ctypes.addressof(run), ctypes.addressof(self.p), times, count, states, rows, room, attempts
        )
        if status == _DONE:
            return status
        reached = f"the motion cannot be followed beyond t = {run.t!r} s on the way to {run.stop!r} s"
        if status == _NOT_FINITE:
            raise PropagationError(f"{reached}: its rate of change is not finite there")
        if status == _UNDERFLOW:
            raise PropagationError(f"{reached}: the step shrank to nothing, as it does before a singularity or a jump")
        if run.accepted + run.rejected >= self.max_steps:
            raise PropagationError(f"{reached}: {self.max_steps} steps were not enough; the next would be {run.h!r} s")
        return status


def _numbers(what: str, values: ArrayLike, length: int) -> list[float]:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (length,):
        raise InputError(f"this kernel takes {length} {what}, got an array of shape {array.shape}")
    numbers: list[float] = array.tolist()
    if not math.isfinite(sum(numbers)) and not all(map(math.isfinite, numbers)):
        raise InputError(f"the {what} must be finite numbers, got {numbers}")
    return numbers
