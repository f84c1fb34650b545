"""Code that all steppers share: loaded libraries, integrations of motions, checks and error messages.

A :class:`Run` is the state of one motion in the memory of the C code. The *pace* is the time that a motion covers per
step. To *sample* is to compute the states at given times; to *record* is to store every step for later.
"""

import ctypes
import math
import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Sequence
from functools import cached_property
from operator import le
from time import perf_counter
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build.address import address
from symrot.errors import CompilerError, InputError
from symrot.propagation import progress
from symrot.propagation.steppers.integration_stopped import (
    IntegrationStopped,
    Samples,
    add_samples,
    why_hopeless,
    why_stuck,
)
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.rounding import RoundingSum
from symrot.propagation.steppers.segments import Segment, segments, split_at
from symrot.propagation.steppers.stats import Stats, stats_of

__all__ = [
    "DONE", "MAX_STEPS", "NOT_FINITE", "NOT_FINITE_SENTENCE", "PATIENCE", "PAUSED", "ROUNDED", "UNDERFLOW", "Floats",
    "Integration", "PathLike", "Run", "SteppedRecording", "Stepper", "Window", "check_longest_step", "check_tolerance",
    "is_sorted",
]  # fmt: skip

MAX_STEPS = 100_000_000  # default limit of a motion: a minute or two
MOST_RECORDED = 2 << 30  # bytes of recorded steps
PATIENCE = 200_000  # steps between two checks of the pace
FEW = 40  # sample times that are compared one by one

Floats = NDArray[np.float64]
PathLike = str | os.PathLike[str]

DONE, PAUSED, FULL, NOT_FINITE, UNDERFLOW = range(5)  # return values of a stepper in C
ROUNDED = 6
NOT_FINITE_SENTENCE = "its rate of change is not finite there"


def check_tolerance(tolerance: float) -> None:
    """Raise InputError for a tolerance that is not between 0 and 1."""
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance: expected a number between 0 and 1, got {tolerance}")


def check_longest_step(max_step: float) -> None:
    """Raise InputError if the limit of the step length, s, is not positive; infinity means no limit."""
    if not max_step > 0.0:
        raise InputError(f"max_step: expected a positive number of seconds, got {max_step}")


def _numbers(what: str, values: ArrayLike, length: int) -> list[float]:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (length,):
        raise InputError(f"{what}: expected an array of shape ({length},) for this kernel, got shape {array.shape}")
    numbers: list[float] = array.tolist()
    if not math.isfinite(sum(numbers)) and not all(map(math.isfinite, numbers)):
        raise InputError(f"{what}: expected finite numbers, got {numbers}")
    return numbers


class SteppedRecording(Recording):
    """A motion whose states can be computed at any time, from the recorded steps of a stepper in C."""

    def __init__(self, task: "Integration", span: tuple[float, float], backward: Floats, forward: Floats) -> None:
        # backward and forward: the steps before and after the start, one per row
        super().__init__(task.t0, task.y0, span, task.stats())
        self._dense, self._backward, self._forward = task.stepper.dense, backward, forward

    def _fill(self, times: Floats, states: Floats) -> None:
        for rows, chosen in ((self._backward, times < self._t0), (self._forward, times > self._t0)):
            if chosen.any():
                states[chosen] = self._dense(rows, times[chosen])


class Window(NamedTuple):
    """The C function and the parameters that a stepper uses until it moves its epoch, the zero of its time."""

    # in a long motion the clock is set to 0 now and then, so that times on it have many digits
    step: Callable[..., Any]
    parameters: Any
    since: int  # steps tried when the epoch was moved


class Run(ctypes.Structure):
    """State of a motion in C: the struct ``symrot_run`` in :file:`dop853.c` and :file:`taylor.c`."""

    # each stepper creates a subclass with the fields of its method; these are those that Python reads and writes
    t: float  # time reached so far, s
    h: float  # next step
    stop: float
    first: float
    last: float
    tolerance: float
    tail: float
    pace: float
    max_step: float
    unit: float
    proven: float
    epoch: float
    far: float
    rounded_from: float  # see Stats.rounded_beyond; NaN: nowhere
    next: int
    accepted: int
    rejected: int
    evaluations: int
    jets: int
    recorded: int
    reach: int
    y: Any
    window: Window | None = None  # an attribute in Python only, not a field in C


class Stepper(ABC):
    """The C functions of one loaded library that integrates motions.

    There is a subclass for each method of integration. It defines the fields of the C struct of a motion, the limits
    and the messages of its method.
    """

    name: ClassVar[str]
    # The fields of symrot_run in C: numbers, integers, and vectors of one number per state.
    reals: ClassVar[tuple[str, ...]]
    integers: ClassVar[tuple[str, ...]]
    vectors: ClassVar[tuple[str, ...]]
    tail: ClassVar[tuple[str, ...]] = ()  # a vector at the end, whose length the library returns
    steps_per_call: ClassVar[int]  # steps in some 20 ms of C, after which Python can react to an interrupt
    rows_per_call: ClassVar[int]  # steps recorded per call
    reasons: ClassVar[dict[int, str]]  # why a motion stops, per status; PAUSED: the limit of steps

    def __init__(self, path: str) -> None:
        try:
            self._library = ctypes.CDLL(path)
        except OSError as error:
            raise _no_stepper(path, error) from error
        self.path = path
        pointer, integer = ctypes.c_void_p, ctypes.c_int64
        self.run = self._function(
            "", ctypes.c_int, pointer, pointer, pointer, integer, pointer, pointer, integer, integer
        )
        self._dense = self._function("_dense", None, pointer, integer, pointer, integer, pointer)
        sizes = (integer * 4)()
        self._function("_sizes", None, pointer)(sizes)
        self.states, self.parameters, self.order, rest = sizes
        self.row = self.row_length()
        real = ctypes.c_double
        kinds = (
            (self.reals, real), (self.integers, integer), (self.vectors, real * self.states), (self.tail, real * rest)
        )  # fmt: skip
        fields = [(name, kind) for names, kind in kinds for name in names]
        self.new_run: type[Run] = type("Run", (Run,), {"_fields_": fields})
        self.new_parameters: Any = ctypes.c_double * self.parameters

    def _function(self, ending: str, result: Any, *arguments: Any) -> Callable[..., Any]:
        """Return a C function of the library by the ending of its name, such as ``_dense``, with types for ctypes."""
        try:
            function = getattr(self._library, f"symrot_{self.name}{ending}")
        except AttributeError as error:
            raise _no_stepper(self.path, error) from error
        function.restype, function.argtypes = result, arguments
        typed: Callable[..., Any] = function
        return typed

    @abstractmethod
    def row_length(self) -> int:
        """Return the number of doubles that the record of one step takes, which depends on the number of states."""

    @staticmethod
    @abstractmethod
    def allowance(tolerance: float) -> tuple[float, float]:
        """Return the error allowed in one step, and the fraction of the span below which a step counts as short.

        A short step is allowed less error.
        """

    @abstractmethod
    def enter(self, run: Run, segment: Segment, allowed: float) -> None:
        """Set the fields of ``run``, the C struct of a motion, that only this stepper uses, before a new segment.

        ``segment`` is the interval between two jumps of the rates that is integrated next; ``allowed`` is the error
        allowed in one step, the first number that :meth:`allowance` returns.
        """

    @staticmethod
    @abstractmethod
    def tried(run: Run) -> int:
        """Return the number of steps of a run that count towards the limit of steps.

        Each stepper defines whether rejected steps count.
        """

    @staticmethod
    @abstractmethod
    def cost(run: Run) -> tuple[int, int, int]:
        """Return the numbers of accepted steps, rejected steps and evaluations of a run so far."""

    def dense(self, rows: Floats, times: Floats) -> Floats:
        """Return the states, shape (n, N), at n times inside recorded steps, all on one side of t0."""
        # one row per step, in the order of the motion
        states = np.empty((len(times), self.states))
        self._dense(rows.ctypes.data, len(rows), times.ctypes.data, len(times), states.ctypes.data)
        return states


def _rounded_beyond(run: Run) -> tuple[float, ...]:
    return () if math.isnan(run.rounded_from) else (run.rounded_from,)


def _stats_of(run: Run, stepper: Stepper, began: float) -> Stats:
    return Stats(*stepper.cost(run), perf_counter() - began, rounded_beyond=_rounded_beyond(run))


def _no_stepper(path: str, error: Exception) -> CompilerError:
    return CompilerError(f"the compiled kernel {path} cannot be loaded: {error}")


def is_sorted(times: Floats) -> bool:
    """Return whether the times never decrease; NaN counts as a decrease."""
    if len(times) > FEW:
        return b"\0" not in (times[1:] >= times[:-1]).tobytes()
    # few times are compared one by one, which is faster than NumPy
    listed = times.tolist()
    return all(map(le, listed, listed[1:]))


class Integration:
    """The integration of one motion by a stepper in C: its checked arguments, and the cost of all calls so far.

    Arguments: see :func:`symrot.propagation.steppers.dop853.integration`.
    """

    def __init__(
        self,
        load: Callable[[str], Stepper],
        library: PathLike,
        p: ArrayLike,
        y0: ArrayLike,
        t0: float,
        tolerance: float,
        max_step: float = math.inf,
        max_steps: int = MAX_STEPS,
        breaks: Sequence[float] = (),
    ) -> None:
        self.began = perf_counter()
        # library: path of rates and stepper in compiled C; load takes it and returns the stepper
        self.stepper = stepper = load(os.fspath(library))
        self.p = stepper.new_parameters(*_numbers("parameters", p, stepper.parameters))
        self.y0 = _numbers("states", y0, stepper.states)
        self.t0, self.max_step, self.max_steps = float(t0), float(max_step), max_steps
        self.breaks = sorted(map(float, breaks)) if len(breaks) else ()
        if not math.isfinite(self.t0):
            raise InputError(f"t0: expected a finite initial time in s, got {t0}")
        check_longest_step(self.max_step)
        self.allowed, self.pace = stepper.allowance(tolerance)
        self.accepted = self.rejected = self.evaluations = 0
        self.rounded_beyond: tuple[float, ...] = ()  # times of Stats.rounded_beyond, of all runs so far
        self.mark = (0, self.t0)  # steps and time at the last check of the pace
        self.goal = t0  # end of the motion, beyond all switching times
        self.way = 0.0  # length of the whole motion of which this is a part, s; 0: this is the whole
        self.fields: dict[str, int] = {}  # more fields of the run in C, which a method sets
        self.rounding: RoundingSum | None = None  # of the whole motion of which this is a part

    def restarted(self) -> "Integration":
        """Return a copy with all counts at zero, for a new motion whose cost is counted alone."""
        # its arguments are not checked again
        other: Integration = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.began = perf_counter()
        other.accepted = other.rejected = other.evaluations = 0
        other.rounded_beyond = ()
        other.mark = (0, self.t0)
        return other

    def from_start(self, p: list[float], y0: Sequence[float]) -> "Integration":
        """Return a copy of the integration with the parameters p and the initial state y0; only these are checked."""
        if not math.isfinite(sum(p) + sum(y0)):  # a sum may overflow though each number is finite
            _numbers("parameters", p, len(p))
            _numbers("states", y0, len(y0))
        other = self.restarted()
        run = other._ready = self.stepper.new_run.from_buffer_copy(self._ready)
        run.y[:] = other.y0 = list(y0)
        other.p = self.stepper.new_parameters(*p)
        return other

    def stats(self) -> Stats:
        """Return the total cost of all calls so far, as :class:`Stats` with the time since the integration was made."""
        counts = self.accepted, self.rejected, self.evaluations
        return stats_of(counts, perf_counter() - self.began, (), self.rounded_beyond)

    def sample(self, times: ArrayLike) -> tuple[Floats, Stats]:
        """Return the states at sample times, s, in any order, shape (n, N), and the cost in steps and evaluations.

        Raises
        ------
        InputError
            If the times are not finite or have a wrong shape.
        PropagationError
            If the motion cannot be followed to the end; the message names the time that it reached.
        """
        times = np.asarray(times, dtype=np.float64, order="C")
        if times.ndim != 1:
            raise InputError(f"times: expected a sequence of sample times in s, got an array of shape {times.shape}")
        # the steps depend only on the earliest and the latest time
        count = len(times)
        states = np.empty((count, self.stepper.states))
        if count == 0:
            return states, self.stats()
        low, high = float(times[0]), float(times[-1])
        if low >= self.t0 and is_sorted(times):
            if not math.isfinite(high):
                raise InputError(f"times: expected finite sample times in s, got {high}")
            self.follow(times, states)
            return states, self.stats()
        if not bool(np.isfinite(times).all()):
            raise InputError(f"times: expected finite sample times in s, got {times[~np.isfinite(times)][0]}")
        done = np.empty(0, dtype=np.intp)
        for part in split_at(times, self.t0):
            rows = np.empty((len(part), self.stepper.states))
            try:
                self.follow(times[part], rows)
            except (IntegrationStopped, KeyboardInterrupt) as error:
                own: Samples | None = getattr(error, "samples", None)
                if own is not None:
                    error.samples = own._replace(numbers=part[own.numbers])  # type: ignore[union-attr]
                add_samples(error, done, states[done], self.stats() if own is None else own.stats)
                raise
            states[part] = rows
            done = np.concatenate([done, part])
        return states, self.stats()

    def sample_sorted(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the states at sample times and the cost, as ``restarted().sample(times)`` does.

        ``in_order``: the times are finite and never decrease.
        """
        if self.breaks or not in_order or not len(times) or times.item(0) < self.t0:
            return self.restarted().sample(times)
        # no time before t0, and no decrease: this is faster
        began, stepper, count, end = perf_counter(), self.stepper, len(times), times.item(-1)
        states = np.empty((count, stepper.states))
        run = stepper.new_run.from_buffer_copy(self._ready)
        run.pace, run.stop = (end - self.t0) * self.pace, end
        stepper.enter(run, Segment(self.t0, end, self.t0, end), self.allowed)
        first, out = address(times), address(states)
        self.mark, self.goal = (0, self.t0), end
        try:
            while self.advance(run, first, count, out, None, 0) != DONE:
                pass
        except (IntegrationStopped, KeyboardInterrupt) as error:
            add_samples(error, np.arange(run.next), states[: run.next], _stats_of(run, stepper, began))
            raise
        return states, _stats_of(run, stepper, began)

    @cached_property
    def _ready(self) -> Run:
        """The C struct of the motion at its start; each new run begins with a copy of it, which is fast."""
        run = self.stepper.new_run(t=self.t0, max_step=self.max_step, rounded_from=math.nan, **self.fields)
        run.y[:] = self.y0
        return run

    def record(self, span: tuple[float, float]) -> SteppedRecording:
        """Return the motion as a function of time, over the shortest interval that contains ``span`` and t0."""
        low, high = min(span), max(span)
        if not (math.isfinite(low) and math.isfinite(high)):
            raise InputError(f"span: expected two finite times in s, got {span}")
        span = min(low, self.t0), max(high, self.t0)
        # The same steps as in sample() to both ends, so that both give equal states. For N states a step takes 8 N + 2
        # numbers with DOP853, and 21 N + 4 with Taylor series of order 20.
        backward, forward = (np.concatenate(self.record_steps(end)) for end in span)
        return SteppedRecording(self, span, backward, forward)

    def follow(self, times: Floats, states: Floats) -> None:
        """Write the states at ``times``, on one side of t0 and sorted by distance from it, into ``states``."""
        count, done, first, out = len(times), 0, address(times), address(states)
        row = 8 * self.stepper.states
        for run in self.runs(float(times[-1])):
            try:
                while self.advance(run, first + 8 * done, count - done, out + row * done, None, 0) != DONE:
                    pass
            except (IntegrationStopped, KeyboardInterrupt) as error:
                done += run.next
                add_samples(error, np.arange(done), states[:done], self._stats_with(run, self.began))
                raise
            done += run.next

    def _stats_with(self, run: Run, began: float) -> Stats:
        """Return the cost of all earlier runs and of ``run``, which has not been added to the counts yet."""
        accepted, rejected, evaluations = self.stepper.cost(run)
        counts = self.accepted + accepted, self.rejected + rejected, self.evaluations + evaluations
        return stats_of(counts, perf_counter() - began, (), (*self.rounded_beyond, *_rounded_beyond(run)))

    def record_steps(self, end: float) -> list[Floats]:
        """Return all steps from t0 to ``end``, s, as a list of arrays with one row per step.

        More than 2 GiB raise IntegrationStopped.
        """
        room = self.stepper.rows_per_call
        pieces = [np.empty((0, self.stepper.row))]
        for run in self.runs(end):
            while run.t != run.stop:
                rows = np.empty((room, self.stepper.row))
                self.advance(run, None, 0, None, rows.ctypes.data, room)
                pieces.append(rows[: run.recorded])
                if len(pieces) * rows.nbytes > MOST_RECORDED:
                    reason = f"recording its steps takes more than {MOST_RECORDED >> 30} GiB; use sample times instead"
                    raise IntegrationStopped(run.t, reason, run.stop)
        return pieces

    def runs(self, end: float) -> Generator[Run, None, None]:
        """Yield the same run, the state of the C code, once for each segment between switching times.

        The caller must :meth:`advance` the run to the end of the segment before asking for the next one.
        """
        stepper, self.goal = self.stepper, end
        pace = (self.way or abs(end - self.t0)) * self.pace
        fields = self.fields if self.rounding is None else {**self.fields, **self.rounding.fields()}
        run = stepper.new_run(t=self.t0, pace=pace, max_step=self.max_step, rounded_from=math.nan, **fields)
        run.y[:] = self.y0
        try:
            for segment in segments(self.t0, end, self.breaks):
                run.stop, run.next = segment.stop, 0
                stepper.enter(run, segment, self.allowed)
                yield run
        finally:  # the caller may end the iteration early
            accepted, rejected, evaluations = stepper.cost(run)
            self.accepted += accepted
            self.rejected += rejected
            self.evaluations += evaluations
            self.rounded_beyond += _rounded_beyond(run)
            if self.rounding is not None:
                self.rounding.read(run)

    def step_function(self, run: Run) -> tuple[Callable[..., Any], Any, int]:
        """Return the C function that continues a run, the kernel's parameters, and the limit of steps per call."""
        # a subclass may return others in the course of a run
        return self.stepper.run, self.p, self.stepper.steps_per_call

    def advance(self, run: Run, times: int | None, count: int, states: int | None, rows: int | None, room: int) -> int:
        """Call the stepper in C once and return its status: DONE at the end of the segment; otherwise call again.

        ``times``, ``states`` and ``rows`` are the addresses of ``count`` sample times, of an array for their states,
        and of an array for the polynomials of up to ``room`` steps; None, with 0 for the length, if they are not
        needed. Raise IntegrationStopped if the motion cannot continue.
        """
        stepper, (function, p, most) = self.stepper, self.step_function(run)
        attempts = min(most, self.max_steps - stepper.tried(run))
        status: int = function(ctypes.addressof(run), ctypes.addressof(p), times, count, states, rows, room, attempts)
        # any other status: an array is full, or the limit of steps per call is reached
        if status == DONE:
            return status
        if status in (NOT_FINITE, UNDERFLOW, ROUNDED):
            reason = stepper.reasons[status]
            reason = why_stuck(reason, run.t, self.t0, run.stop) if status == UNDERFLOW else reason
            raise IntegrationStopped(run.t, reason, run.stop)
        tried = stepper.tried(run)
        if tried >= self.max_steps:
            raise IntegrationStopped(run.t, stepper.reasons[PAUSED].format(steps=self.max_steps, run=run), run.stop)
        progress.report(run.t, self.t0, self.goal)
        if tried - self.mark[0] >= PATIENCE:
            self.judge_pace(tried, run)
        return status

    def judge_pace(self, tried: int, run: Run) -> None:
        """Raise IntegrationStopped if the rest of the motion would take far more steps than the limit.

        ``tried`` is the number of steps so far, accepted and rejected.
        """
        # the steps since the last check show the pace
        reason = why_hopeless(tried - self.mark[0], abs(run.t - self.mark[1]), abs(run.stop - run.t), self.max_steps)
        if reason:
            raise IntegrationStopped(run.t, reason, run.stop)
        self.mark = (tried, run.t)
