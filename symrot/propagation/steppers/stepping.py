"""Code that all steppers share: loaded libraries, integrations of motions, recordings, and error messages.

:mod:`symrot.propagation.steppers.dop853` and :mod:`symrot.propagation.steppers.taylor` define their own parts in
subclasses of :class:`Stepper`. :mod:`symrot.propagation.steppers.fallback` uses the functions that sort times and
divide a span at switching times, and the messages.

A :class:`Run` is the state of one motion in the memory of the C code. The pace is the time that a motion covers per
step; from it the remaining number of steps is estimated. To sample is to compute the states at given times; to record
is to store every step, so that the states can be computed later.
"""

import ctypes
import math
import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from operator import le
from time import perf_counter
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build.address import address
from symrot.errors import CompilerError, InputError
from symrot.propagation import progress
from symrot.propagation.steppers.integration_stopped import IntegrationStopped, add_samples, why_hopeless, why_stuck

__all__ = [
    "DONE",
    "MAX_STEPS",
    "NOT_FINITE",
    "NOT_FINITE_SENTENCE",
    "PAUSED",
    "UNDERFLOW",
    "Floats",
    "Integration",
    "PathLike",
    "Recording",
    "Run",
    "Segment",
    "Stats",
    "SteppedRecording",
    "Stepper",
    "Switching",
    "Window",
    "check_longest_step",
    "check_tolerance",
    "is_sorted",
    "segments",
    "split_at",
    "stats_of",
]

MAX_STEPS = 100_000_000  # default limit of a motion: a minute or two
MOST_RECORDED = 2 << 30  # bytes of recorded steps
PATIENCE = 200_000  # steps between two checks of the pace
FEW = 40  # sample times that are compared one by one
SLIVER = 2.0**-100  # part of a segment: so near its end, every formula has the same value as at the end

Floats = NDArray[np.float64]
PathLike = str | os.PathLike[str]

DONE, PAUSED, FULL, NOT_FINITE, UNDERFLOW = range(5)  # return values of a stepper in C
NOT_FINITE_SENTENCE = "its rate of change is not finite there"


class Switching(NamedTuple):
    """The switching of a function in a torque, such as ``sign(omega_3)``, at the time t, s.

    ``how`` is ``"passed"`` if the argument of the function changes its sign, ``"held"`` if the argument stays at zero
    from then on (dry friction holds a wheel at rest), and ``"released"`` if it leaves zero after being held there.
    """

    t: float
    function: str
    how: str


class Stats(NamedTuple):
    """The cost of a propagation.

    Attributes
    ----------
    accepted, rejected : int
        Numbers of accepted and rejected steps.
    evaluations : int
        Evaluations of the kernel.
    seconds : float
        Time of the whole propagation.
    switches : int
        Number of changes of the Euler sequence if Euler angles are the state; otherwise the number of switching times.
    switching_times : tuple of float
        Times, s, without repetition, at which functions such as sign switch in the torques.
    switchings : tuple of Switching
        The functions that switch, with their times.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate("t_handle").stats.rejected >= 0
    True
    """

    accepted: int
    rejected: int
    evaluations: int
    seconds: float
    switches: int = 0
    switching_times: tuple[float, ...] = ()
    switchings: tuple[Switching, ...] = ()


def stats_of(cost: Any, seconds: float, switchings: Iterable[Switching]) -> Stats:
    """Return the statistics of a motion; ``cost`` holds its accepted steps, rejected steps and evaluations.

    ``seconds`` is the time of the computation, and ``switchings`` lists the functions that switched in the torques.
    """
    accepted, rejected, evaluations = map(int, cost)
    listed = tuple(sorted(switchings))
    times = tuple(sorted({change.t for change in listed}))  # coinciding switches count once
    return Stats(accepted, rejected, evaluations, seconds, len(times), times, listed)


# ------------------------------------------------------------------------------------------------ checks and sentences


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


# ------------------------------------------------------------------------------------------------ times


class Segment(NamedTuple):
    """Part of a span, from ``start`` to ``stop``, s, without switching times inside.

    A torque may jump at a switching time. ``first`` and ``last`` are the times passed to the kernel at the two ends. At
    a switching time they lie just inside the segment, so that the torque has its value inside.
    """

    start: float
    stop: float
    first: float
    last: float


def segments(t0: float, end: float, breaks: Sequence[float]) -> list[Segment]:
    """Return the segments into which switching times divide the span from t0 to ``end``, in the order of the motion.

    ``breaks`` are the switching times, in increasing order; those outside the span do not count. For t0 = 0, ``end`` =
    2 and a break at 1 the result is the segment from 0 to 1 and the segment from 1 to 2. ``end`` may lie before t0: for
    t0 = 2 and ``end`` = 0 they are those from 2 to 1 and from 1 to 0. Without breaks inside, the result is one segment.
    """
    if not breaks:
        return [Segment(t0, end, t0, end)]
    low, high = min(t0, end), max(t0, end)
    inside, known = [time for time in breaks if low < time < high], set(breaks)
    edges = [t0, *(inside if end >= t0 else reversed(inside)), end]
    return [
        Segment(
            start,
            stop,
            _inside(start, stop) if start in known else start,
            _inside(stop, start) if stop in known else stop,
        )
        for start, stop in pairwise(edges)
    ]


def _inside(edge: float, other: float) -> float:
    """Return a time just inside a segment, at which the rates are evaluated instead of its end ``edge``.

    A torque that jumps at the edge then has the value that it has inside. ``other`` is the other end of the segment.
    The distance from the edge is too small to affect the choice of the first step.
    """
    time = edge + SLIVER * (other - edge)
    return time if time != edge else math.nextafter(edge, other)


def split_at(times: Floats, t0: float) -> Iterator[NDArray[np.intp]]:
    """Yield the indices of the times from t0 on, then the indices of the times before t0.

    Each group is sorted by distance from t0; an empty group is left out. For the times 3, 0, 2 and t0 = 1 the groups
    are [2, 0] and [1].
    """
    order = np.argsort(times, kind="stable")
    first_after = int(np.searchsorted(times[order], t0))
    for part in (order[first_after:], order[:first_after][::-1]):
        if len(part):
            yield part


# ------------------------------------------------------------------------------------------------ a motion at any time


class Recording(ABC):
    """A motion whose states can be computed at any time of its span.

    ``recording(t)`` returns the states at one time, shape (N,), or at an array of times, shape (n, N), and raises
    InputError for a time outside ``span``. ``stats`` is the cost of the motion; ``epoch`` is the time of the scene, s,
    at which the clock of the motion shows 0.
    """

    epoch = 0.0

    def __init__(self, t0: float, y0: Sequence[float] | Floats, span: tuple[float, float], stats: Stats) -> None:
        self._t0, self._y0, self.span, self.stats = t0, y0, span, stats

    @abstractmethod
    def _fill(self, times: Floats, states: Floats) -> None:
        """Write the states at ``times``, which lie inside the span and differ from t0, into the array ``states``.

        The shapes are (n,) and (n, N).
        """

    def __call__(self, t: ArrayLike) -> Floats:
        times = np.asarray(t, dtype=np.float64)
        flat = np.ascontiguousarray(times).reshape(-1)
        outside = ~((flat >= self.span[0]) & (flat <= self.span[1]))
        if outside.any():
            low, high, asked = (time + self.epoch for time in (*self.span, float(flat[outside][0])))
            raise InputError(f"t: expected times from {low} to {high} s, where the motion is known, got {asked} s")
        states = np.empty((len(flat), len(self._y0)))
        self._fill(flat, states)
        states[flat == self._t0] = self._y0
        return states.reshape(*times.shape, len(self._y0))


class SteppedRecording(Recording):
    """A motion whose states can be computed at any time, from the recorded steps of a stepper in C.

    ``task`` is the integration, and ``span`` the interval of time, s. ``backward`` and ``forward`` are its recorded
    steps before and after the start, one per row.
    """

    def __init__(self, task: "Integration", span: tuple[float, float], backward: Floats, forward: Floats) -> None:
        super().__init__(task.t0, task.y0, span, task.stats())
        self._dense, self._backward, self._forward = task.stepper.dense, backward, forward

    def _fill(self, times: Floats, states: Floats) -> None:
        for rows, chosen in ((self._backward, times < self._t0), (self._forward, times > self._t0)):
            if chosen.any():
                states[chosen] = self._dense(rows, times[chosen])


# ------------------------------------------------------------------------------------------------ the steppers in C


class Window(NamedTuple):
    """The C function of a stepper, and the parameters of the rates that it uses until its clock is set to 0 again.

    In a long motion the stepper now and then sets its clock to 0, so that times on the clock have many digits. The time
    of the scene at such a moment is called epoch. Parameters that depend on time are computed for the present epoch.
    """

    step: Callable[..., Any]
    parameters: Any
    since: int  # steps tried when the epoch was moved


class Run(ctypes.Structure):
    """State of a motion in C: the struct ``symrot_run`` in :file:`dop853.c` and :file:`taylor.c`.

    Each stepper creates a subclass with the fields of its method. The fields that Python reads and writes are listed
    here.
    """

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
    """Functions of one loaded library; each subclass defines the parts that depend on its method.

    The library exports ``symrot_NAME``, ``symrot_NAME_dense`` and ``symrot_NAME_sizes``, where NAME is ``name``.
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
        """Return the library's C function ``symrot_NAME`` plus an ending such as ``_dense``, with declared types.

        ``result`` and ``arguments`` are its types in ctypes. NAME is the name of the stepper, such as ``taylor``.
        """
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
        """Return the error allowed in one step, and the least step length that may use it, as a fraction of the span.

        They follow from ``tolerance``, the error of the whole trajectory. A shorter step may use only a share of this
        error.
        """

    @abstractmethod
    def enter(self, run: Run, segment: Segment, allowed: float) -> None:
        """Prepare a run for the next segment: set the fields of its C struct that only this stepper's method uses.

        ``allowed`` is the error allowed in one step.
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
        """Return the states, shape (n, N), at n times inside recorded steps, all after t0 or all before it.

        ``rows`` are the recorded steps, one per row, in the order of the motion.
        """
        states = np.empty((len(times), self.states))
        self._dense(rows.ctypes.data, len(rows), times.ctypes.data, len(times), states.ctypes.data)
        return states


def _no_stepper(path: str, error: Exception) -> CompilerError:
    return CompilerError(f"the compiled kernel {path} cannot be loaded: {error}")


def is_sorted(times: Floats) -> bool:
    """Return whether the times never decrease; NaN counts as a decrease. An empty array counts as sorted.

    If there are few times, they are compared one by one, which is faster than NumPy.
    """
    if len(times) > FEW:
        return b"\0" not in (times[1:] >= times[:-1]).tobytes()
    listed = times.tolist()
    return all(map(le, listed, listed[1:]))


class Integration:
    """The integration of one motion by a stepper in C: its checked arguments, and the cost of all calls of it so far.

    The cost is counted in steps, evaluations and seconds, over all calls of :meth:`sample` and :meth:`record`.
    ``library`` is the path of a compiled C library with the rates and the stepper; ``load`` takes this path and returns
    the stepper. The other parameters are explained in :func:`symrot.propagation.steppers.dop853.integration`.
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
        self.mark = (0, self.t0)  # steps and time at the last check of the pace
        self.goal = t0  # end of the motion, beyond all switching times
        self.way = 0.0  # length of the whole motion of which this is a part, s; 0: this is the whole
        self.fields: dict[str, int] = {}  # more fields of the run in C, which a method sets

    def restarted(self) -> "Integration":
        """Return a copy of the integration with all counts at zero; its arguments are not checked again.

        A copy is needed for each new motion, so that its cost is counted alone.
        """
        other: Integration = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.began = perf_counter()
        other.accepted = other.rejected = other.evaluations = 0
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
        return Stats(self.accepted, self.rejected, self.evaluations, perf_counter() - self.began)

    def sample(self, times: ArrayLike) -> tuple[Floats, Stats]:
        """Return the states at sample times, shape (n, N), and the cost of the motion.

        The times, s, may be in any order, before or after ``t0``, and may repeat. The steps depend only on the earliest
        and the latest time.

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
                own = getattr(error, "samples", None)
                if own is not None:
                    error.samples = own._replace(numbers=part[own.numbers])  # type: ignore[union-attr]
                add_samples(error, done, states[done])
                raise
            states[part] = rows
            done = np.concatenate([done, part])
        return states, self.stats()

    def sample_sorted(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the states at sample times and the cost, like ``restarted().sample(times)``.

        This method is faster if no time lies before t0 and the times never decrease. ``in_order`` promises that the
        times are finite and never decrease.
        """
        if self.breaks or not in_order or not len(times) or times.item(0) < self.t0:
            return self.restarted().sample(times)
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
            add_samples(error, np.arange(run.next), states[: run.next], stepper.cost(run))
            raise
        return states, Stats(*stepper.cost(run), perf_counter() - began)

    @cached_property
    def _ready(self) -> Run:
        """The C struct of the motion at its start; each new run begins with a copy of it, which is fast."""
        run = self.stepper.new_run(t=self.t0, max_step=self.max_step, **self.fields)
        run.y[:] = self.y0
        return run

    def record(self, span: tuple[float, float]) -> SteppedRecording:
        """Return the motion as a function of time, over the shortest interval that contains ``span`` and t0.

        The steps are the same as in :meth:`sample` to the ends of the span, so that both give equal states. For N
        states, the record of a step takes 8 N + 2 numbers with DOP853, and 21 N + 4 with Taylor series of order 20.
        """
        low, high = min(span), max(span)
        if not (math.isfinite(low) and math.isfinite(high)):
            raise InputError(f"span: expected two finite times in s, got {span}")
        span = min(low, self.t0), max(high, self.t0)
        backward, forward = (np.concatenate(self.record_steps(end)) for end in span)
        return SteppedRecording(self, span, backward, forward)

    def follow(self, times: Floats, states: Floats) -> None:
        """Write the states at ``times`` into the array ``states``.

        The times lie all after t0 or all before it, and are sorted by their distance from t0.
        """
        count, done, first, out = len(times), 0, address(times), address(states)
        row = 8 * self.stepper.states
        for run in self.runs(float(times[-1])):
            try:
                while self.advance(run, first + 8 * done, count - done, out + row * done, None, 0) != DONE:
                    pass
            except (IntegrationStopped, KeyboardInterrupt) as error:
                done += run.next
                add_samples(error, np.arange(done), states[:done], self._cost(run))
                raise
            done += run.next

    def _cost(self, run: Run) -> tuple[int, int, int]:
        """Return the numbers of accepted steps, rejected steps and evaluations, in this and all earlier runs.

        ``run`` is the present run, which has not been added to the counts yet.
        """
        accepted, rejected, evaluations = self.stepper.cost(run)
        return self.accepted + accepted, self.rejected + rejected, self.evaluations + evaluations

    def record_steps(self, end: float) -> list[Floats]:
        """Return all recorded steps from t0 to ``end``, as a list of arrays with one row per step.

        IntegrationStopped is raised if they take more than 2 GiB.
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
        """Yield the run once for each segment between switching times, prepared so that the caller can integrate it.

        A run is the state of the motion in C; the caller calls :meth:`advance` until its time is the end of the
        segment. At the end, the cost of the run is added to the counts of the integration.
        """
        stepper, self.goal = self.stepper, end
        pace = (self.way or abs(end - self.t0)) * self.pace
        run = stepper.new_run(t=self.t0, pace=pace, max_step=self.max_step, **self.fields)
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

    def step_function(self, run: Run) -> tuple[Callable[..., Any], Any, int]:
        """Return the C function that continues a run, the parameters of its kernel, and the most steps per call.

        A subclass may return others in the course of a run.
        """
        return self.stepper.run, self.p, self.stepper.steps_per_call

    def advance(self, run: Run, times: int | None, count: int, states: int | None, rows: int | None, room: int) -> int:
        """Call the stepper in C once and return its status; raise IntegrationStopped if it cannot continue.

        ``times`` and ``states`` are the addresses of ``count`` sample times and of the array for their states; both are
        None if no samples are needed, and ``count`` is then 0. ``rows`` is the address of an array for the polynomials
        of up to ``room`` steps, one row per step, or None if they are not needed. The status is DONE at the end of the
        segment; with any other status (the array is full, or the limit of steps per call is reached) the caller has to
        call again.
        """
        stepper, (function, p, most) = self.stepper, self.step_function(run)
        attempts = min(most, self.max_steps - stepper.tried(run))
        status: int = function(ctypes.addressof(run), ctypes.addressof(p), times, count, states, rows, room, attempts)
        if status == DONE:
            return status
        if status in (NOT_FINITE, UNDERFLOW):
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

        ``tried`` is the number of steps of the run so far; the steps since the last check show the pace.
        """
        reason = why_hopeless(tried - self.mark[0], abs(run.t - self.mark[1]), abs(run.stop - run.t), self.max_steps)
        if reason:
            raise IntegrationStopped(run.t, reason, run.stop)
        self.mark = (tried, run.t)
