"""A torque that is no formula: a function in Python or C, or a table of samples, with declared switching times.

It acts besides the torques of the scene. Dormand and Prince's method steps the motion; at every switching time it stops
exactly and starts anew behind it, so that a jump costs no accuracy and no rejected steps.
"""

import ctypes
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build import cache as library
from symrot.build.sources import c_text
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.planning.plan import Plan, make_plan
from symrot.planning.scene_kernel import SceneKernel
from symrot.propagation.compiled_models import enclosure_text, error_blocks, has_formulas, scene_kernel
from symrot.propagation.method import DRIVEN
from symrot.propagation.motion import Motion
from symrot.propagation.propagator import Propagator
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers import dop853
from symrot.propagation.steppers.stepping import MAX_STEPS, Recording, Stats, Task
from symrot.scene.scene import Initial, Scene

__all__ = ["DrivenPropagator"]

Floats = NDArray[np.float64]
CALLBACK = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_double),
    ctypes.POINTER(ctypes.c_double), ctypes.c_void_p,
)  # fmt: skip
SAMPLES_PER_STEP = 8.0  # of a table: a longer step could pass over what they say
DEFECT = 1e4  # times the error allowed in a step: more, and the dense output missed something inside
BEND = 2.0**-50  # of the torque: what the last bits of samples bend their spline by, from one to the next
OVERSHOOT = 100.0  # times the largest sample: a spline that goes so far says nothing of the torque
MOST_STEPS = 30_000_000  # under a table, some 20 s; others end at stepping.MAX_STEPS
UNKNOWN = (
    "the torque is a function without a formula: each step is checked inside, but a feature narrower than a step may "
    "be missed; give max_step, in s, below the width of the narrowest"
)
FORMS = "a function of (t, omega, quaternion), a C function of ctypes, or a table (times, samples)"


class _Function:
    """A function in Python as one in C; keeps the exception that ends a motion."""

    user: Any = None
    samples = False
    longest_step = math.inf
    most_steps = MAX_STEPS
    knots: Sequence[float] = ()

    def __init__(self, function: Callable[[float, Floats, Floats], ArrayLike]) -> None:
        self.function, self.error = function, None  # type: tuple[Callable[..., Any], BaseException | None]
        self.pointer = CALLBACK(self._call)

    def _call(self, t: float, omega: Any, quaternion: Any, torque: Any, user: Any) -> int:
        if self.error is not None:
            return 1
        try:
            found = np.asarray(self.function(t, np.array(omega[:3]), np.array(quaternion[:4])), dtype=np.float64)
            if found.shape != (3,) or not np.isfinite(found).all():
                raise InputError(
                    f"torque: expected three finite numbers in N m, got {number.show(found.tolist())} at t = {t!r} s"
                )
            torque[0], torque[1], torque[2] = found.tolist()
        except InputError as error:
            self.error = error
        except Exception as error:
            self.error = InputError(f"torque: the function raised {type(error).__name__}: {error}, at t = {t!r} s")
            self.error.__cause__ = error
        except BaseException as error:  # an interrupt: handed on as it is
            self.error = error
        return int(self.error is not None)

    def check(self, low: float, high: float) -> None:
        self.error = None

    def failure(self) -> BaseException | None:
        return self.error


class _CFunction:
    """A function of a C library: ``int (double, const double[3], const double[4], double[3], void *)``."""

    user: Any = None
    samples = False
    longest_step = math.inf
    most_steps = MAX_STEPS
    knots: Sequence[float] = ()

    def __init__(self, function: Any) -> None:
        self.pointer = function

    def check(self, low: float, high: float) -> None: ...

    def failure(self) -> BaseException | None:
        return None


class _Table:
    """Samples, interpolated by cubic splines between switching times."""

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
            raise InputError("torque: expected a table of finite numbers, got some that are not")
        repeated = t[1:][np.diff(t) == 0]
        if (np.diff(t) < 0).any() or not set(repeated.tolist()) <= set(switching) or (np.diff(repeated) == 0).any():
            raise InputError(
                "torque: expected a table of rising times, twice the same at switching times alone (the samples before "
                "and after the jump)"
            )
        self.span = float(t[0]), float(t[-1])
        self.longest_step = SAMPLES_PER_STEP * float(np.diff(t).max())
        self.user, self.knots = _pieces(t, values, switching)
        self.pointer: Any = None  # set when the library is loaded

    def check(self, low: float, high: float) -> None:
        if low < self.span[0] or high > self.span[1]:
            asked = low if low < self.span[0] else high
            raise InputError(f"torque: the table covers {self.span[0]} to {self.span[1]} s, asked for {asked} s")

    def failure(self) -> BaseException | None:
        return None


def _pieces(t: Floats, values: Floats, switching: Sequence[float]) -> tuple[Floats, list[float]]:
    """Return the table of ``symrot_table_torque``, one spline between each two switching times; and where steps end."""
    from scipy.interpolate import CubicSpline

    cuts = [0]
    for switch in switching:
        inside = np.flatnonzero(t == switch)
        if len(inside) == 2:
            cuts.append(int(inside[1]))
    cuts.append(len(t))
    edges, coefficients, knots = [], [], [float(t[-1])]
    for low, high in pairwise(cuts):
        if high - low < 2:
            raise InputError(f"torque: expected two samples or more between switching times, got one at {t[low]} s")
        spline = CubicSpline(t[low:high], values[low:high])
        _check_overshoot(spline, float(np.abs(values).max()))
        edges.append(spline.x[:-1])
        knots += [float(spline.x[0]), *_bends(spline)]
        coefficients.append(np.ascontiguousarray(np.moveaxis(spline.c, 0, 2)).reshape(-1, 12))
    count = sum(map(len, edges))
    return np.concatenate([[float(count)], *edges, t[-1:], *(part.ravel() for part in coefficients)]), knots


def _check_overshoot(spline: Any, largest: float) -> None:
    """Refuse samples so unevenly spaced that the spline through them is far from all of them."""
    starts, gaps = spline.x[:-1], np.diff(spline.x)
    found = np.max([np.abs(spline(starts + part * gaps)).max(axis=1) for part in (0.25, 0.5, 0.75)], axis=0)
    worst = int(np.argmax(found))
    before, after = map(float, spline.x[worst : worst + 2])
    if not found[worst] <= OVERSHOOT * largest:
        raise InputError(
            f"torque: expected samples that a cubic spline keeps near, got samples of at most {largest:.3g} N m that "
            f"send it to {found[worst]:.3g} N m between {before!r} and {after!r} s; a jump is a switching time with "
            "two samples, before and after"
        )


def _bends(spline: Any) -> list[float]:
    """Return the samples at which the third derivative jumps: not those between pieces of one line, or constant."""
    gaps, cubic = np.diff(spline.x)[:, None], spline.c[0]
    jumps = np.abs(np.diff(cubic, axis=0)) * np.minimum(gaps[1:], gaps[:-1]) ** 3
    found: list[float] = spline.x[1:-1][(jumps > BEND * np.abs(spline.c[3]).max(axis=0)).any(axis=1)].tolist()
    return found


def _drive(torque: Any, switching: Sequence[float]) -> Any:
    if isinstance(torque, ctypes._CFuncPtr):  # type: ignore[attr-defined]
        return _CFunction(torque)
    if callable(torque):
        return _Function(torque)
    if isinstance(torque, tuple | list) and len(torque) == 2:
        return _Table(torque[0], torque[1], switching)
    raise InputError(f"torque: expected {FORMS}, got {number.show(torque)}")


def _bits(address: int) -> float:
    """Return the double whose bits are an address."""
    return ctypes.c_double.from_buffer_copy(ctypes.c_uint64(address)).value


def _address(pointer: Any) -> int:
    return int(ctypes.cast(pointer, ctypes.c_void_p).value or 0)


class DrivenMotion(Motion):
    """The motion of a scene under one more torque."""

    movable, restarts = False, True  # the torque is asked for at the times of the scene

    def __init__(
        self, plan: Plan, tolerance: float, drive: Any, in_space: bool, switching: Sequence[float], max_step: float
    ) -> None:
        plan = replace(plan, structure=replace(plan.structure.unreduced(), attitude=True))
        self.plan, self.tolerance = plan, tolerance
        self.choice = DRIVEN
        self.start = float(plan.scene.span.start)
        self._drive, self.switching = drive, switching
        self.longest_step = min(drive.longest_step, max_step)
        self.warnings = () if drive.samples or math.isfinite(max_step) else (UNKNOWN,)
        bare = scene_kernel(plan)
        own = len(bare.rate_parameters)
        text = "\n".join(
            (
                bare.source,
                f"#define SYMROT_OWN {own}",
                c_text("propagation/external_torque.c"),
            )
        )
        edges, scales = error_blocks(plan)
        bounds = (enclosure_text(plan, lambda: bare.rates, edges),) if has_formulas(plan) else ()
        text = f"#define SYMROT_DEFECT {DEFECT!r}\n{text}"
        source = dop853.translation_unit(text, "symrot_driven", len(plan.states), own + 12, edges, scales, *bounds)
        self.library = library.build(source, "driven")
        if drive.pointer is None:
            self._loaded = ctypes.CDLL(str(self.library))
            drive.pointer = self._loaded.symrot_table_torque
        user = 0 if drive.user is None else drive.user.ctypes.data
        inverse = np.linalg.inv(np.array([[float(x) for x in row] for row in plan.scene.body.inertia]))
        self._more = [_bits(_address(drive.pointer)), _bits(user), float(in_space), *inverse.ravel().tolist()]
        lost = [[*item[:3], False, "changed by the torque that is no formula"] for item in bare.data["conserved"]]
        self._kernel = SceneKernel({**bare.data, "conserved": lost})

    @property
    def kernel(self) -> SceneKernel:
        """The kernels of the scene, whose invariants are lost."""
        return self._kernel

    @property
    def driven_parameters(self) -> list[float]:
        """Those of the rates, then those of the torque."""
        return [*self.rate_parameters, *self._more]

    @cached_property
    def stepping(self) -> Task:
        """The motion as the stepper in C follows it."""
        assert self.library is not None
        return dop853.task(
            self.library, self.driven_parameters, self.plan.initial_state, self.start, self.tolerance,
            max_step=self.longest_step, max_steps=self._drive.most_steps,
            breaks=sorted({*self.switching, *self._drive.knots}),
        )  # fmt: skip

    def guarded(self, low: float, high: float, run: Callable[[], Any]) -> Any:
        """Return what a run gives, or raise what the torque raised in it."""
        self._drive.check(min(low, self.start), max(high, self.start))
        try:
            return run()
        except PropagationError:
            failure = self._drive.failure()
            if failure is None:
                raise
            raise failure from failure.__cause__

    def integrate(self, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
        """Return the states at the times, shape (n, N), and what it cost."""
        low, high = (float(times.min()), float(times.max())) if len(times) else (self.start, self.start)
        found: tuple[Floats, Stats] = self.guarded(low, high, lambda: self.stepping.again().sample(times))
        return found

    def dense(self, span: tuple[float, float]) -> Recording:
        recording: Recording = self.guarded(*span, lambda: self.stepping.again().record(span))
        return recording


class DrivenPropagator(Propagator):
    """Propagates a scene under one more torque; made by :func:`symrot.propagator` with ``torque``."""

    def __init__(
        self, scene: Scene, tolerance: float, torque: Any, switching_times: ArrayLike = (), frame: str = "body",
        max_step: float = math.inf,
    ) -> None:  # fmt: skip
        switching = real_array(switching_times, "switching_times", "finite times in s", ndmin=1).ravel()
        if not np.isfinite(switching).all():
            raise InputError(f"switching_times: expected finite times in s, got {number.show(switching_times)}")
        if frame not in ("body", "space"):
            raise InputError(f"torque_frame: expected 'body' or 'space', got {frame!r}")
        self._switching = tuple(sorted(set(switching.tolist())))
        self._max_step = max_step
        self._torque, self._in_space = _drive(torque, self._switching), frame == "space"
        super().__init__(scene, "dop853", tolerance)

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial, driven=True)

    def _prepare(self, plan: Plan) -> Motion:
        return DrivenMotion(plan, self.tolerance, self._torque, self._in_space, self._switching, self._max_step)
