"""Torques without a formula: a function in Python or C, or a table of samples, with declared switching times.

Such a torque is added to the torques of the scene. Dormand and Prince's method restarts at each switching time, so
that a jump costs no accuracy. A long step may pass over a short pulse of the torque.
"""

import copy
import ctypes
import math
import pickle
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from threading import local
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build import cache as library
from symrot.build.sources import c_text
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.planning.plan import Plan, make_plan
from symrot.propagation.compiled_models import enclosure_text, error_blocks, has_formulas, scene_kernel
from symrot.propagation.method import EXTERNAL_TORQUE
from symrot.propagation.motions.motion import Motion, RestartableMotion, SteppedInC
from symrot.propagation.motions.setup import Setup
from symrot.propagation.propagator import Propagator
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers import dop853
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.stats import Stats
from symrot.propagation.steppers.stepping import MAX_STEPS, Integration
from symrot.propagation.table_splines import table_splines
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["ExternallyDrivenPropagator"]

Floats = NDArray[np.float64]
CALLBACK = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_double),
    ctypes.POINTER(ctypes.c_double), ctypes.c_void_p,
)  # fmt: skip
SAMPLES_PER_STEP = 8.0  # samples of a table in one step: a longer step could pass over features of the samples
DEFECT = 1e4  # times the error allowed in a step: a larger deviation shows that the step missed a feature inside
BEND = 2.0**-50  # relative to the torque: rounded samples alone make the third derivative of a spline jump by this
OVERSHOOT = 100.0  # times the largest sample: a spline with larger values does not represent the torque
MOST_STEPS = 30_000_000  # limit of steps under a table, some 20 s; for functions it is stepping.MAX_STEPS
UNKNOWN = (
    "the torque has no formula: a pulse that is shorter than a step may be missed; give max_step, in s, shorter than "
    "every pulse"
)
FORMS = "a function of (t, omega, quaternion), a C function of ctypes, or a table (times, samples)"


class TorqueSource(ABC):
    """Interface of a torque without a formula: a function in Python, a function in C, or a table.

    Attributes
    ----------
    samples : bool
        Whether the torque is known from samples, whose spacing limits the length of a step.
    longest_step, most_steps : float, int
        Longest step, s, and largest number of steps.
    knots : sequence of float
        Times, s, at which a derivative of the torque jumps, so that a step has to end there.
    user : array or None
        The array that the C function receives as its argument ``user``.
    """

    samples: ClassVar[bool] = False
    most_steps: ClassVar[int] = MAX_STEPS
    longest_step: float = math.inf
    knots: Sequence[float] = ()
    user: Floats | None = None

    @abstractmethod
    def pointer_in(self, library: Path) -> Any:
        """Return a pointer to the torque as a C function; for a table, this function is in the compiled ``library``."""

    @abstractmethod
    def check(self, low: float, high: float) -> None:
        """Prepare for a motion from ``low`` to ``high``, s; raise InputError if the torque is not defined there."""

    @abstractmethod
    def failure(self) -> BaseException | None:
        """Return the error of the torque function during the last motion, or None."""

    def watched(self) -> AbstractContextManager[None]:
        """Return the context in which a motion is followed and :meth:`failure` returns the errors of this motion."""
        return nullcontext()

    @contextmanager
    def following(self, start: float, times: Floats) -> Iterator[None]:
        """Follow a motion from the time ``start``, s, to ``times``, s, in the ``with`` block.

        Raise InputError if the torque is not defined there. If the motion stops because the torque function raised an
        error, raise this error.
        """
        low, high = (float(times.min()), float(times.max())) if len(times) else (start, start)
        self.check(min(low, start), max(high, start))
        with self.watched():
            try:
                yield
            except PropagationError:
                self.raise_error()
                raise

    def raise_error(self) -> None:
        """Raise the error that the torque function raised in :meth:`following`; do nothing if there is none."""
        failure = self.failure()
        if failure is not None:
            raise failure from failure.__cause__


@final
class _Function(TorqueSource):
    """A torque that is a Python function of (t, omega, quaternion), called from C."""

    def __init__(self, function: Callable[[float, Floats, Floats], ArrayLike]) -> None:
        self.function = function
        self.user = np.zeros(1)  # not null: if ctypes drops an exception, C finds a torque that is not a number
        self._errors = local()  # of this thread: another one may follow a motion with the same function
        self.pointer = CALLBACK(self._call)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what pickle needs to copy the torque; without cloudpickle, a local function raises PicklingError."""
        if "cloudpickle" not in sys.modules:  # joblib and Dask load it; it saves functions that pickle refuses
            try:
                pickle.dumps(self.function)
            except Exception as error:
                raise pickle.PicklingError(
                    f"torque: expected a function that can be pickled, such as one defined at the top of a module, got "
                    f"{number.show(self.function)} ({error})"
                ) from None
        return _Function, (self.function,)

    def __deepcopy__(self, memo: dict[int, Any]) -> "_Function":
        return _Function(copy.deepcopy(self.function, memo))

    def _call(self, t: float, omega: Any, quaternion: Any, torque: Any, user: Any) -> int:
        # outside of the try block, ctypes would drop an interrupt
        try:
            if self.failure() is not None:
                return 1
            result = self.function(t, np.array(omega[:3]), np.array(quaternion[:4]))
            try:
                torque[0], torque[1], torque[2] = _three_numbers(result)
            except InputError as error:  # ends the motion, as does an exception of the function
                self._errors.last = InputError(f"{error} at t = {t!r} s")
                return 1
            return 0
        except BaseException as error:
            self._errors.last = _explained(error, t)
            return 1

    def pointer_in(self, library: Path) -> Any:
        """Return the callback through which C calls the Python function."""
        return self.pointer

    def check(self, low: float, high: float) -> None:
        """Do nothing: the domain of the function is not known, so that no time can be refused."""

    def failure(self) -> BaseException | None:
        """Return the error of the function in this thread's last motion, or None if there was none.

        A result that is not three finite numbers is an error, too.
        """
        error: BaseException | None = getattr(self._errors, "last", None)
        return error

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Follow a motion in the ``with`` block; afterwards :meth:`failure` returns what it returned before."""
        # the function itself may follow a motion, even its own
        before, self._errors.last = self.failure(), None
        try:
            yield
        finally:
            self._errors.last = before


def _three_numbers(result: Any) -> list[float]:
    """Return the three finite numbers that a torque function returned; raise InputError if they are not."""
    values = np.asarray(result)
    if values.dtype != np.float64:
        values = real_array(result, "torque", "three finite numbers in N m")
    if values.shape != (3,) or not np.isfinite(values).all():
        raise InputError(f"torque: expected three finite numbers in N m, got {number.show(values.tolist())}")
    numbers: list[float] = values.tolist()
    return numbers


def _explained(error: BaseException, t: float) -> BaseException:
    """Return the error to raise if a torque function raised ``error`` at the time ``t``, s.

    It is an InputError, except that an interrupt or another exception that is no error is returned unchanged.
    """
    if not isinstance(error, Exception):
        return error
    try:
        sentence = str(error)
    except Exception:
        sentence = "an error without a text"
    explained = InputError(f"torque: the function raised {type(error).__name__}: {sentence}, at t = {t!r} s")
    explained.__cause__ = error
    return explained


@final
class _CFunction(TorqueSource):
    """A torque ``int f(double t, const double omega[3], const double q[4], double torque[3], void *)`` in C."""

    def __init__(self, function: Any) -> None:
        self.pointer = function

    def __reduce__(self) -> tuple[Any, ...]:
        """Raise PicklingError: the address of a C function means nothing in another process."""
        raise pickle.PicklingError(
            "torque: expected a Python function, a table or a formula in a motion that is pickled, got a C function, "
            "whose address means nothing in another process"
        )

    def __deepcopy__(self, memo: dict[int, Any]) -> "_CFunction":
        return self

    def pointer_in(self, library: Path) -> Any:
        """Return the user's C function, which the stepper calls; ``library`` is not needed for it."""
        return self.pointer

    def check(self, low: float, high: float) -> None:
        """Do nothing: the domain of a C function is not known, so that no time can be refused."""

    def failure(self) -> BaseException | None:
        """Return None: a C function raises no exceptions, but reports an error by its return value."""
        return None


@final
class _Table(TorqueSource):
    """A torque given by a table of samples, interpolated by cubic splines between switching times."""

    samples = True
    most_steps = MOST_STEPS

    def __init__(self, times: Any, samples: Any, switching: Sequence[float]) -> None:
        t = real_array(times, "torque", f"{FORMS}, with times in s")
        values = real_array(samples, "torque", f"{FORMS}, with samples in N m")
        if t.ndim != 1 or len(t) < 2 or values.shape != (len(t), 3):
            raise InputError(
                "torque: expected a table of n times in s and samples in N m of shape (n, 3), n from 2 on, got shapes "
                f"{t.shape} and {values.shape}"
            )
        if not (np.isfinite(t).all() and np.isfinite(values).all()):
            raise InputError(
                "torque: expected a table of finite numbers, got a table with infinite or undefined numbers"
            )
        repeated = t[1:][np.diff(t) == 0]
        if (np.diff(t) < 0).any() or not set(repeated.tolist()) <= set(switching) or (np.diff(repeated) == 0).any():
            raise InputError(
                "torque: expected a table of increasing times; only a switching time may occur twice, for the samples "
                "before and after the jump"
            )
        self.span = float(t[0]), float(t[-1])
        self.longest_step = SAMPLES_PER_STEP * float(np.diff(t).max())
        # the torque may jump at a switching time
        self.user, self.knots = _pieces(t, values, switching)

    def pointer_in(self, library: Path) -> Any:
        """Return the C function that interpolates the table, loaded with ctypes from the compiled file ``library``."""
        return ctypes.CDLL(str(library)).symrot_table_torque

    def check(self, low: float, high: float) -> None:
        """Raise InputError if a time from ``low`` to ``high``, s, lies beyond the table."""
        if low < self.span[0] or high > self.span[1]:
            beyond = low if low < self.span[0] else high
            raise InputError(
                f"torque: expected times from {self.span[0]} to {self.span[1]} s, the span of the table, got {beyond} s"
            )

    def failure(self) -> BaseException | None:
        """Return None: the interpolation of a table raises no exceptions."""
        return None


def _pieces(t: Floats, values: Floats, switching: Sequence[float]) -> tuple[Floats, list[float]]:
    """Return the splines of a table as one array for C, and the times, s, at which a spline's derivative jumps."""
    edges, coefficients, knots = [], [], [float(t[-1])]
    for spline in table_splines(t, values, switching):
        _check_overshoot(spline, float(np.abs(values).max()))
        edges.append(spline.x[:-1])
        knots += [float(spline.x[0]), *_bends(spline)]
        coefficients.append(np.ascontiguousarray(np.moveaxis(spline.c, 0, 2)).reshape(-1, 12))
    count = sum(map(len, edges))
    # the layout that the C function symrot_table_torque reads
    return np.concatenate([[float(count)], *edges, t[-1:], *(part.ravel() for part in coefficients)]), knots


def _check_overshoot(spline: Any, largest: float) -> None:
    """Raise InputError if a spline exceeds 100 times the largest sample, as for very unevenly spaced samples."""
    starts, gaps = spline.x[:-1], np.diff(spline.x)
    reach = np.max([np.abs(spline(starts + part * gaps)).max(axis=1) for part in (0.25, 0.5, 0.75)], axis=0)
    worst = int(np.argmax(reach))
    before, after = map(float, spline.x[worst : worst + 2])
    if not reach[worst] <= OVERSHOOT * largest:
        raise InputError(
            f"torque: expected samples that a cubic spline can follow, got a spline of {reach[worst]:.3g} N m between "
            f"{before!r} and {after!r} s for samples up to {largest:.3g} N m; if the torque jumps, give two samples "
            "at the time of the jump, and this time as a switching time"
        )


def _bends(spline: Any) -> list[float]:
    """Return the sample times, s, at which the third derivative of a spline jumps by more than a rounding error."""
    gaps, cubic = np.diff(spline.x)[:, None], spline.c[0]
    jumps = np.abs(np.diff(cubic, axis=0)) * np.minimum(gaps[1:], gaps[:-1]) ** 3
    # none for samples of one cubic polynomial
    bends: list[float] = spline.x[1:-1][(jumps > BEND * np.abs(spline.c[3]).max(axis=0)).any(axis=1)].tolist()
    return bends


def _check_declaration(function: Any) -> None:
    """Raise InputError if a C function is a null pointer or is declared to ctypes with a signature that C cannot call.

    A function of a loaded library without ``argtypes`` is accepted: ctypes does not know its arguments.
    """
    declared = function.argtypes
    if not _address(function):
        raise InputError("torque: expected a C function, got a null pointer")
    if (declared is not None and len(declared) != 5) or function.restype is not ctypes.c_int:
        takes = "any arguments" if declared is None else f"{len(declared)} argument{'s' * (len(declared) != 1)}"
        returns = "nothing" if function.restype is None else getattr(function.restype, "__name__", "another type")
        raise InputError(
            "torque: expected a C function int (double t, const double omega[3], const double quaternion[4], double "
            f"torque[3], void *user), got one that ctypes declares to take {takes} and to return {returns}"
        )


def _torque_source(torque: Any, switching: Sequence[float]) -> TorqueSource:
    """Return a torque, in any form that :func:`symrot.propagator` accepts, as a :class:`TorqueSource`.

    ``switching`` has the times, s, at which the torque may jump. A table is interpolated separately between these
    times.
    """
    if isinstance(torque, ctypes._CFuncPtr):  # type: ignore[attr-defined]
        _check_declaration(torque)
        return _CFunction(torque)
    if callable(torque):
        return _Function(torque)
    if isinstance(torque, tuple | list) and len(torque) == 2:
        return _Table(torque[0], torque[1], switching)
    raise InputError(f"torque: expected {FORMS}, got {number.show(torque)}")


def _bits(address: int) -> float:
    """Return the double with the same 64 bits as an address, so that an array of doubles can hold the address."""
    # kernel parameters are doubles, and one of them has to hold the address
    return ctypes.c_double.from_buffer_copy(ctypes.c_uint64(address)).value


def _address(pointer: Any) -> int:
    return int(ctypes.cast(pointer, ctypes.c_void_p).value or 0)


@final
@dataclass(frozen=True, eq=False)
class ExternalSetup:
    """The data that all motions under one torque without a formula share, whatever their initial states.

    Attributes
    ----------
    setup : Setup
        Plan, method and kernel of the scene.
    library : Path
        Compiled library of kernel and stepper; the kernel calls the torque.
    source : TorqueSource
        The source of the torque.
    torque_parameters : tuple of float
        Parameters of the kernel after the parameters of the scene: the address of the torque function, the address of
        the data with which it is called (its argument ``user``, such as a table), the frame (1 for space), and the nine
        entries of the inverse inertia tensor.
    breaks : tuple of float
        Times, s, at which a step ends: the switching times, and the knots of a table.
    longest_step : float
        Longest step, s.
    """

    setup: Setup
    library: Path
    source: TorqueSource
    torque_parameters: tuple[float, ...]
    breaks: tuple[float, ...]
    longest_step: float


def external_setup(
    plan: Plan, tolerance: float, source: TorqueSource, in_space: bool, switching: Sequence[float], max_step: float
) -> ExternalSetup:
    """Compile kernel, torque and stepper into one library; return the setup that all motions with this torque share.

    ``in_space``: the torque has space components; ``switching``: times, s, at which the torque jumps; ``max_step``: the
    longest step, s.
    """
    plan = replace(plan, structure=replace(plan.structure.unreduced(), attitude=True))
    scene_alone = scene_kernel(plan)
    own = len(scene_alone.rate_parameters)
    parts = (
        f"#define SYMROT_DEFECT {DEFECT!r}",
        scene_alone.source,
        f"#define SYMROT_OWN {own}",
        c_text("propagation/external_torque.c"),
    )
    edges, scales = error_blocks(plan)
    bounds = (enclosure_text(plan, lambda: scene_alone.rates, edges),) if has_formulas(plan) else ()
    size = len(plan.states), own + 12
    text = dop853.translation_unit("\n".join(parts), "symrot_driven", *size, edges, scales, *bounds)
    path = library.build(text, "driven")
    pointer = source.pointer_in(path)
    user = 0 if source.user is None else source.user.ctypes.data
    inverse = np.linalg.inv(np.array([[float(x) for x in row] for row in plan.scene.body.inertia]))
    addresses = _bits(_address(pointer)), _bits(user)
    kernel = scene_alone.without_invariants("changed by the torque without a formula")
    warnings = () if source.samples or math.isfinite(max_step) else (UNKNOWN,)
    setup = Setup(plan, EXTERNAL_TORQUE, tolerance, float(plan.scene.span.start), lambda: kernel, warnings=warnings)
    return ExternalSetup(
        setup,
        path,
        source,
        (*addresses, float(in_space), *inverse.ravel().tolist()),
        tuple(sorted({*switching, *source.knots})),
        min(source.longest_step, max_step),
    )


@final
class ExternallyDrivenMotion(RestartableMotion, SteppedInC):
    """Motion of a scene under a torque that the user gives as a function, in Python or C, or as a table.

    A function depends on time, angular velocity and attitude; a table depends on time alone.
    """

    def __init__(self, shared: ExternalSetup, plan: Plan) -> None:
        super().__init__(shared.setup, plan)
        self._shared, self.external_torque = shared, shared.source

    def from_start(self, initial: Initial) -> "ExternallyDrivenMotion":
        """Return the motion from any other initial state; nothing is derived or compiled again."""
        # every start is accepted, since all states are integrated in any case
        return ExternallyDrivenMotion(self._shared, self.setup.plan.from_start(initial))

    @cached_property
    def stepping(self) -> Integration:
        """The integration of the motion by DOP853, restarted at each switching time."""
        shared = self._shared
        return dop853.integration(
            shared.library, [*self.rate_parameters, *shared.torque_parameters], self.plan.initial_state, self.start,
            self.tolerance, max_step=shared.longest_step, max_steps=shared.source.most_steps, breaks=shared.breaks,
        )  # fmt: skip

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the N states at n ``times``, s, shape (n, N), and the cost in steps and evaluations.

        ``in_order`` has no effect: the times are sorted in any case.
        """
        # sample() sorts the times, so that in_order is not used
        with self.following(times):
            return self.stepping.restarted().sample(times)

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function that takes n times within ``span``, s, and returns the N states, shape (n, N).

        It evaluates recorded steps.
        """
        with self.following(np.array(span)):
            return self.stepping.restarted().record(span)


class ExternallyDrivenPropagator(Propagator):
    """Propagator of a scene under a torque without a formula; :func:`symrot.propagator` with ``torque`` returns it."""

    def __init__(
        self, scene: Scene, tolerance: float, torque: Any, switching_times: ArrayLike = (), frame: str = "body",
        max_step: float = math.inf, sensitivities: Sequence[str] | None = None,
    ) -> None:  # fmt: skip
        switching = real_array(switching_times, "switching_times", "finite times in s", ndmin=1).ravel()
        if not np.isfinite(switching).all():
            raise InputError(f"switching_times: expected finite times in s, got {number.show(switching_times)}")
        if frame not in ("body", "space"):
            raise InputError(f"torque_frame: expected 'body' or 'space', got {frame!r}")
        self._switching = tuple(sorted(set(switching.tolist())))
        self._max_step = max_step
        self._source, self._in_space = _torque_source(torque, self._switching), frame == "space"
        super().__init__(scene, "dop853", tolerance, sensitivities)

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial, external_torque=True)

    def _prepare(self, plan: Plan) -> Motion:
        shared = external_setup(plan, self.tolerance, self._source, self._in_space, self._switching, self._max_step)
        return ExternallyDrivenMotion(shared, shared.setup.plan)
