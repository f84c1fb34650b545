"""Taylor series of order 20 around an emitted jet: the C of :file:`taylor.c` driven from Python, one call per span.

The counterpart of :mod:`symrot.propagation.dop853` for right-hand sides that are known as formulas and smooth: a few
long steps, each good to round-off if asked, at any time inside a step from the same coefficients. A library holds one
system and the stepper compiled together (:func:`translation_unit`).

Tolerance: the promise is about the trajectory, not about one step, see :func:`step_tail`.
"""

import ctypes
import math
import os
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.errors import CompilerError, InputError, PropagationError
from symrot.kernel import Program
from symrot.propagation.dop853 import MAX_STEPS, Recording, Stats

__all__ = ["integrate", "order_for", "record", "refusal", "step_tail", "translation_unit"]

STEPS_PER_CALL = 50_000  # some 20 ms in C, after which Python can see an interrupt
STEPS_OF_ALL = 4.0  # a span of so many steps allows each of them the whole tolerance, see step_tail
ROWS_PER_CALL = 64       # steps recorded per call
ORDERS = ((1e-3, 12), (1e-6, 16), (0.0, 20))  # from which tolerance on which order is fastest, see order_for

Floats = NDArray[np.float64]

_DONE, _PAUSED, _FULL, _NOT_FINITE, _UNDERFLOW = range(5)
# The fields of symrot_run in taylor.c: numbers, integers, and vectors of one number per state.
_REALS = ("t", "t_low", "unit", "stop", "tail", "pace", "max_step")
_INTEGERS = ("next", "accepted", "jets", "recorded")
_VECTORS = ("y", "carry")


def step_tail(tolerance: float) -> tuple[float, float]:
    """Return the size allowed to the last terms of a step's series, and the fraction of the span that earns all of it.

    A step shorter than that is allowed its share of the span to the power 7/4, as errors grow with the number of steps
    when nothing but a turning body amplifies them: the error at the end then hardly depends on the span.

    The constant is calibrated on free asymmetric bodies, through flips about the intermediate axis too, and on heavy
    tops, against references of 50 digits (``tests/test_taylor.py``): errors stay below 5 times the tolerance.
    """
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"the tolerance lies between 0 and 1, got {tolerance}")
    return tolerance, 1.0 / STEPS_OF_ALL


def order_for(tolerance: float) -> int:
    """Return the order that is fastest for a tolerance; any order keeps its promise.

    Measured by ``python -m symrot.bench.taylor --orders``: below 1e-6 orders 16 to 24 lie within a tenth of each other.
    """
    return next(order for least, order in ORDERS if tolerance >= least)


def refusal(program: Program) -> str:
    """Return an empty text, or the sentence that says why a right-hand side has no Taylor series."""
    from symrot.codegen.recurrences import recurrences

    try:
        recurrences(program)
    except InputError as error:
        return str(error)
    return ""


def translation_unit(
    program: Program, blocks: Sequence[int] = (0, 3, 7), scales: Sequence[float] = (0.0, 1.0), order: int | None = None
) -> str:
    """Return the C source of a library: the jet of a right-hand side and the stepper around it.

    Parameters
    ----------
    program : Program
        The right-hand side ``dy = f(t, y, p)``.
    blocks, scales
        As :func:`symrot.propagation.dop853.translation_unit` takes them.
    order : int, optional
        Of the series, even; default: 20. See :func:`order_for`.

    Raises
    ------
    InputError
        For a right-hand side that is not smooth (abs).
    """
    from symrot.codegen.taylor_source import ORDER, taylor_definitions

    here = Path(__file__).parent
    return "\n".join((
        (here / "taylor.h").read_text(encoding="utf-8"),
        taylor_definitions(program, blocks, scales, ORDER if order is None else order),
        (here / "taylor.c").read_text(encoding="utf-8"),
    ))


def integrate(
    library: str | os.PathLike[str],
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    times: ArrayLike,
    tolerance: float,
    *,
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
        Aim for the error of the whole trajectory, see :func:`step_tail`.
    max_step : float
        Longest step, s.
    max_steps : int
        Most steps to take before giving up.

    Returns
    -------
    states : array, shape (n, N), C layout
    stats : Stats
        ``evaluations`` counts jets: all coefficients of one step.

    Raises
    ------
    InputError
        If a shape, a time or the tolerance cannot be used.
    PropagationError
        If the motion cannot be followed to the end; the sentence says how far it came.
    """
    began = perf_counter()
    task = _Task(library, p, y0, t0, tolerance, max_step, max_steps)
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
    max_step: float = math.inf,
    max_steps: int = MAX_STEPS,
) -> Recording:
    """Return the motion over ``span`` as a function of time; arguments as :func:`integrate`.

    The same steps are taken as by :func:`integrate` to the ends of the span, so the two agree where they overlap. One
    step takes 21 N + 4 numbers of memory.
    """
    began = perf_counter()
    task = _Task(library, p, y0, t0, tolerance, max_step, max_steps)
    low, high = min(span), max(span)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise InputError(f"a span runs between two finite times, got {span}")
    rows = [np.concatenate(task.keep(end)) for end in (min(low, task.t0), max(high, task.t0))]
    return Recording(task.stepper, task.t0, task.y0, rows[0], rows[1], task.stats(began))  # type: ignore[arg-type]


class _Stepper:
    """The functions of one loaded library."""

    def __init__(self, path: str) -> None:
        try:
            library = ctypes.CDLL(path)
            self.run, self._dense = library.symrot_taylor, library.symrot_taylor_dense
            self._jet = library.symrot_taylor_jet
            sizes, carry = library.symrot_taylor_sizes, library.symrot_taylor_carry
        except (OSError, AttributeError) as error:
            raise CompilerError(f"the compiled kernel {path} cannot be loaded: {error}") from error
        pointer, integer, real = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
        self.run.argtypes = (pointer, pointer, pointer, integer, pointer, pointer, integer, integer)
        self.run.restype = ctypes.c_int
        self._dense.argtypes = (pointer, integer, pointer, integer, pointer)
        self._jet.argtypes = (real, pointer, pointer, real, integer, pointer)
        self._dense.restype = self._jet.restype = sizes.restype = None
        carry.argtypes, carry.restype = (real, real), real
        if carry(1.0, 2.0**-60) != 2.0**-60:
            raise CompilerError(f"the compiled kernel {path} loses the carry of its sums: compile without -ffast-math")
        found = (ctypes.c_int64 * 3)()
        sizes(found)
        self.states, self.parameters, self.order = found[0], found[1], found[2]
        self.row = 4 + (self.order + 1) * self.states
        vector = real * self.states
        kinds = ((_REALS, real), (_INTEGERS, integer), (_VECTORS, vector))
        fields = [(name, kind) for names, kind in kinds for name in names]
        self.new_run: Any = type("Run", (ctypes.Structure,), {"_fields_": fields})
        self.new_parameters: Any = real * self.parameters

    def dense(self, rows: Floats, times: Floats) -> Floats:
        states = np.empty((len(times), self.states))
        self._dense(rows.ctypes.data, len(rows), times.ctypes.data, len(times), states.ctypes.data)
        return states

    def jet(self, t: float, y: ArrayLike, p: ArrayLike, unit: float = 1.0) -> Floats:
        """Return the Taylor coefficients of the states at t, shape (order + 1, N), in powers of ``unit``."""
        state, values = np.array(y, dtype=np.float64), np.array(p, dtype=np.float64)
        found = np.empty((self.order + 1, self.states))
        self._jet(t, state.ctypes.data, values.ctypes.data, unit, self.order, found.ctypes.data)
        return found


_loaded: dict[str, _Stepper] = {}


def _stepper(library: str | os.PathLike[str]) -> _Stepper:
    path = os.fspath(library)
    if path not in _loaded:
        _loaded[path] = _Stepper(path)
    return _loaded[path]


class _Task:
    """One motion to follow: checked input, and the counts of all calls made for it."""

    def __init__(
        self, library: str | os.PathLike[str], p: ArrayLike, y0: ArrayLike, t0: float, tolerance: float,
        max_step: float, max_steps: int,
    ) -> None:  # fmt: skip
        self.stepper = _stepper(library)
        self.p = self.stepper.new_parameters(*_numbers("parameters", p, self.stepper.parameters))
        self.y0 = _numbers("states", y0, self.stepper.states)
        self.t0, self.max_step, self.max_steps = float(t0), float(max_step), max_steps
        if not math.isfinite(self.t0):
            raise InputError(f"the initial time must be finite, got {t0}")
        if not self.max_step > 0.0:
            raise InputError(f"the longest step is a positive number of seconds, got {max_step}")
        self.tail, self.pace = step_tail(tolerance)
        self.accepted = self.jets = 0

    def stats(self, began: float) -> Stats:
        return Stats(self.accepted, self.jets - self.accepted, self.jets, perf_counter() - began)

    def follow(self, times: Floats, states: Floats) -> None:
        """Write the states at times sorted away from t0, all on one side of it."""
        run = self._start(float(times[-1]))
        while self._advance(run, times.ctypes.data, len(times), states.ctypes.data, None, 0) != _DONE:
            pass
        self._count(run)

    def keep(self, end: float) -> list[Floats]:
        """Return the recorded steps from t0 to an end, in pieces."""
        pieces = [np.empty((0, self.stepper.row))]
        run = self._start(end)
        while run.t != run.stop:
            rows = np.empty((ROWS_PER_CALL, self.stepper.row))
            self._advance(run, None, 0, None, rows.ctypes.data, ROWS_PER_CALL)
            pieces.append(rows[: run.recorded])
        self._count(run)
        return pieces

    def _start(self, end: float) -> Any:
        run = self.stepper.new_run(
            t=self.t0, stop=end, tail=self.tail, pace=abs(end - self.t0) * self.pace, max_step=self.max_step
        )
        run.y[:] = self.y0
        return run

    def _count(self, run: Any) -> None:
        self.accepted += run.accepted
        self.jets += run.jets

    def _advance(self, run: Any, times: int | None, count: int, states: int | None, rows: int | None, room: int) -> int:
        """Call the stepper once; raise where it cannot go on."""
        attempts = min(STEPS_PER_CALL, self.max_steps - run.accepted)
        status: int = self.stepper.run(
            ctypes.addressof(run), ctypes.addressof(self.p), times, count, states, rows, room, attempts
        )
        if status == _DONE:
            return status
        reached = f"the motion cannot be followed beyond t = {run.t!r} s on the way to {run.stop!r} s"
        if status == _NOT_FINITE:
            raise PropagationError(f"{reached}: its derivatives are not finite there")
        if status == _UNDERFLOW:
            raise PropagationError(f"{reached}: the step shrank to nothing, as it does before a singularity")
        if run.accepted >= self.max_steps:
            raise PropagationError(f"{reached}: {self.max_steps} steps were not enough")
        return status


def _numbers(what: str, values: ArrayLike, length: int) -> list[float]:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (length,):
        raise InputError(f"this kernel takes {length} {what}, got an array of shape {array.shape}")
    numbers: list[float] = array.tolist()
    if not math.isfinite(sum(numbers)) and not all(map(math.isfinite, numbers)):
        raise InputError(f"the {what} must be finite numbers, got {numbers}")
    return numbers
