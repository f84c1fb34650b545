"""From a scene to its motion: choose a method, bind the kernel to numbers once, then propagate as often as asked."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from math import isfinite
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot import number
from symrot.closed_form.choose import FORMS, Exact, Form, exact_form
from symrot.codegen import library
from symrot.errors import InputError, PropagationError
from symrot.planner import Plan, Row, general_structure, make_plan
from symrot.propagation import dop853, taylor
from symrot.propagation.dop853 import Stats
from symrot.propagation.invariants import invariant_parameters
from symrot.propagation.kernels import compiled, error_blocks, scene_kernel, taylor_library
from symrot.propagation.smoothness import roughness
from symrot.propagation.stepping import Task, rising
from symrot.propagation.trajectory import ARRAY_FUNCTIONS, Trajectory
from symrot.scene import Initial, Scene, load_scene
from symrot.scene_kernel import SceneKernel, bind

__all__ = ["METHODS", "Choice", "Motion", "Propagator", "choose_method", "propagate", "propagator"]

Floats = NDArray[np.float64]

UNREDUCED: dict[str, Any] = {
    "planar": None,
    "initial_quaternion": None,
    "constant": {},
}  # what an exact motion returns: all of it

METHODS = {
    "auto": "the first of the table that fits",
    "constant": "every state keeps its value",
    "exact": "closed form, at any time without stepping",
    "taylor": "Taylor series stepped in C from the emitted recurrences",
    "dop853": "Dormand-Prince 8(5,3), stepped in C around the emitted kernel",
    "scipy": "SciPy around the emitted NumPy kernel",
}
"""Every method by name, with what it is; ``scipy`` stands for its DOP853, ``scipy:NAME`` for another of SciPy's."""


class Choice(NamedTuple):
    """A method and why it was taken."""

    method: str
    reason: str


def _closed_form(plan: Plan) -> str:
    form = exact_form(plan.scene)
    return form.name if form else ""


def _series(plan: Plan) -> str:
    return "" if library.missing() or roughness(plan) else "the torque is smooth, and a C compiler is there"


AUTO: tuple[tuple[str, Callable[[Plan], str]], ...] = (
    ("constant", lambda plan: "" if plan.states else "the plan leaves no state to integrate"),
    ("exact", _closed_form),
    ("taylor", _series),
    ("dop853", lambda plan: "" if library.missing() else f"{roughness(plan)}, and a C compiler is there"),
    ("scipy", lambda plan: library.missing()),
)
"""What ``auto`` tries, in order: (method, condition); a condition returns the reason to take it, or nothing."""


DRIVEN = Choice("dop853", "a torque that is no formula has no Taylor series")
"""The method for such a torque, and why."""


def choose_method(plan: Plan, method: str = "auto") -> Choice:
    """Return the method for a plan.

    Raises
    ------
    InputError
        If there is no such method.
    """
    if plan.scene.table is not None:
        if method not in ("auto", "dop853"):
            raise InputError(f"method: expected 'auto' or 'dop853' for a torque that is no formula, got {method!r}")
        return DRIVEN
    if method == "auto":
        return next(Choice(name, reason) for name, condition in AUTO if (reason := condition(plan)))
    if method == "exact":
        form = exact_form(plan.scene)
        if form is None:
            raise InputError(
                f"method: expected a motion with a closed form ({', '.join(form.name for form in FORMS)}) for 'exact', "
                f"got the scene {plan.scene.name!r}"
            )
        return Choice(method, form.name)
    name, colon, solver = method.partition(":")
    if name == "scipy" and solver:
        from symrot.propagation.fallback import method_name

        method_name(solver)
    elif name not in METHODS or colon or name == "constant":
        listed = ", ".join(name for name in METHODS if name != "constant")
        raise InputError(f"method: expected one of {listed} or scipy:NAME, got {method!r}")
    return Choice(method, "asked for") if plan.states else choose_method(plan)


def unreduced(plan: Plan, form: Form) -> Plan:
    """Return the plan of a motion in closed form, which has all its components and skips the stepping."""
    rows, before = [], general_structure(plan.scene)
    for row in plan.rows:
        if all(row.structure[key] == before[key] for key in UNREDUCED):
            rows.append(row)
        before = row.structure
    structure = plan.structure | UNREDUCED
    why = f"the motion has a closed form: {form.name}"
    return replace(plan, structure=structure, rows=(*rows, Row("stepping", True, why, form.derivation, structure)))


class Motion:
    """A plan with its kernel, bound to numbers."""

    def __init__(self, plan: Plan, choice: Choice, tolerance: float) -> None:
        self.plan, self.choice, self.tolerance = plan, choice, tolerance
        self.library: Path | None = None
        if choice.method == "exact":
            form = exact_form(plan.scene)
            assert form is not None
            form.begin()
            self.plan = unreduced(plan, form)
        elif choice.method == "dop853":
            self.kernel, self.library = compiled(plan)
        elif choice.method == "taylor":
            self.kernel = scene_kernel(plan)
            self.library = taylor_library(plan, self.kernel, tolerance)
        self.start = float(plan.scene.span.start)

    @cached_property
    def kernel(self) -> SceneKernel:
        """The derived kernels; of an exact motion, only when something other than omega and attitude is asked for."""
        return scene_kernel(self.plan)

    @cached_property
    def rate_parameters(self) -> list[float]:
        return bind(self.kernel.rate_parameters, self.plan.constants)

    @cached_property
    def stepping(self) -> Task:
        """The motion as its stepper in C follows it: checked once, followed as often as asked."""
        assert self.library is not None
        if self.choice.method == "taylor":
            start = (self.taylor_parameters, self.plan.initial_state, self.start)
            return taylor.task(self.library, *start, self.tolerance)
        return dop853.task(self.library, self.rate_parameters, self.plan.initial_state, self.start, self.tolerance)

    @cached_property
    def taylor_parameters(self) -> list[float]:
        """Those of the rates, then those of the invariants."""
        return [*self.rate_parameters, *invariant_parameters(self.kernel, self.plan)]

    @cached_property
    def _quantity_values(self) -> dict[str, float]:
        names = [name for name, _ in self.kernel.quantity_parameters]
        return dict(zip(names, bind(self.kernel.quantity_parameters, self.plan.constants), strict=True))

    def evaluate(self, t: Floats, states: Floats, names: Sequence[str]) -> Floats:
        """Return quantities of the kernel at states of shape (n, N), as an array of shape (n, len(names))."""
        columns = [name.removesuffix(" of t") for name in names]
        if set(columns) <= set(self.plan.states):  # what is asked for is what was integrated
            return states[:, [self.plan.states.index(name) for name in columns]]
        values: dict[str, Any] = {"t": t, **dict(zip(self.plan.states, states.T, strict=True)), **self._quantity_values}
        found = self.kernel.quantities.evaluate(values, ARRAY_FUNCTIONS, float, names)
        result = np.empty((len(t), len(names)))
        for index, name in enumerate(names):
            result[:, index] = found[name]
        return result

    @cached_property
    def _initial(self) -> tuple[Floats, Floats]:
        return np.array([self.start]), np.array([self.plan.initial_state]).reshape(1, -1)

    def initial_quantity(self, name: str) -> float:
        """Return a conserved quantity at the start."""
        if name == "quaternion norm":
            return 1.0
        output = next(item.output for item in self.kernel.conserved if item.name == name)
        return float(self.evaluate(*self._initial, [output])[0, 0])

    def integrate(self, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
        """Return the states at the times, shape (n, N), and what it cost; ``rise``: they are known to be in order."""
        return INTEGRATORS[self.choice.method.partition(":")[0]](self, times, rise)

    def follow(self, times: Floats, rise: bool = False) -> tuple[Floats | tuple[Floats, ...], Stats]:
        """Return as :meth:`integrate`, but of an exact motion angular velocity and attitude in an array each."""
        return _exact_parts(self, times, rise) if self.choice.method == "exact" else self.integrate(times, rise)

    @cached_property
    def rates(self) -> Callable[..., Any]:
        """The emitted NumPy kernel as ``f(t, y, p)``."""
        from symrot.codegen.numpy_kernel import load_numpy_kernel

        function = load_numpy_kernel(self.kernel.rates)
        return function if self.rate_parameters else lambda t, y, p: function(t, y)

    @cached_property
    def exact(self) -> Exact:
        """The motion in closed form."""
        form = exact_form(self.plan.scene)
        assert form is not None
        return form.motion(self.plan.scene)

    def solution(self, trajectory: Trajectory) -> Callable[[ArrayLike], Floats]:
        """Return omega and quaternion as a function of time over the trajectory's span."""
        times = trajectory.t
        span = (
            (min(self.start, float(times.min())), max(self.start, float(times.max())))
            if len(times)
            else (self.start,) * 2
        )
        states = self._dense(span)
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if trajectory.has_attitude else []

        def at(t: ArrayLike) -> Floats:
            wanted = np.asarray(t, dtype=float)
            flat = np.atleast_1d(wanted).ravel()
            found = self.evaluate(flat, states(flat), names).T
            return found.reshape(len(names), *wanted.shape)

        return at

    def _dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return the states as a function of time."""
        if self.choice.method == "constant":
            return lambda t: np.empty((len(t), 0))
        if self.choice.method == "exact":
            return lambda t: _exact(self, t)[0]
        start = (self.rate_parameters, self.plan.initial_state, self.start)
        if self.library is not None:
            return self.stepping.again().record(span)
        from symrot.propagation import fallback

        return fallback.record(self.rates, *start, span, self.tolerance, **self.scipy_options)

    @property
    def scipy_options(self) -> dict[str, Any]:
        """How the fallback judges errors, and by which of SciPy's methods it steps."""
        blocks, scales = error_blocks(self.plan)
        solver = self.choice.method.partition(":")[2]
        return {"blocks": blocks, "scales": scales, **({"method": solver} if solver else {})}


def _keep(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    return np.empty((len(times), 0)), Stats(0, 0, 0, 0.0)


def _stepped(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    return motion.stepping.once(times, rise)


def _exact_parts(motion: Motion, times: Floats, rise: bool) -> tuple[tuple[Floats, ...], Stats]:
    attitude, exact = motion.plan.structure["attitude"], motion.exact
    began, start = perf_counter(), motion.start
    omega, quaternion = exact.evaluate(times - start if start else times, quaternion=attitude)
    assert omega is not None
    if not (rise and len(times) and times.item(0) > start):  # to the last bit, as every method has it
        at_start = times == start
        omega[at_start] = motion.plan.initial_state[:3]
        if quaternion is not None:
            quaternion[at_start] = motion.plan.initial_state[3:]
    return (omega,) if quaternion is None else (omega, quaternion), Stats(0, 0, 0, perf_counter() - began)


def _exact(motion: Motion, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
    parts, stats = _exact_parts(motion, times, rise)
    return np.concatenate(parts, axis=1), stats


def _scipy(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    from symrot.propagation import fallback

    start = (motion.rate_parameters, motion.plan.initial_state, motion.start)
    return fallback.integrate(motion.rates, *start, times, motion.tolerance, **motion.scipy_options)


INTEGRATORS: dict[str, Callable[[Motion, Floats, bool], tuple[Floats, Stats]]] = {
    "constant": _keep,
    "exact": _exact,
    "taylor": _stepped,
    "dop853": _stepped,
    "scipy": _scipy,
}


class Propagator:
    """Propagates one scene; made by :func:`propagator`.

    Derivation, compilation and binding are done when it is made; a call does the motion and nothing else.
    """

    def __init__(self, scene: Scene, method: str, tolerance: float) -> None:
        self.scene, self.tolerance, self._method = scene, tolerance, method
        self._motion = self._prepare(self._planned())

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial)

    def _prepare(self, plan: Plan) -> Motion:
        return Motion(plan, choose_method(plan, self._method), self.tolerance)

    @property
    def plan(self) -> Plan:
        """What is computed, what is skipped."""
        return self._motion.plan

    @property
    def method(self) -> str:
        """The method that is used."""
        return self._motion.choice.method

    @property
    def reason(self) -> str:
        """Why that method."""
        return self._motion.choice.reason

    @property
    def kernel(self) -> SceneKernel:
        """The derived kernels."""
        return self._motion.kernel

    def prepare(self) -> None:
        """Do now what otherwise waits for the first use: derive what an exact motion keeps while its form compiles."""
        self._motion.kernel  # noqa: B018
        if self.method == "exact":
            self._motion.exact  # noqa: B018

    @cached_property
    def sample_times(self) -> Floats:
        """The scene's own sample times, s."""
        span = self.scene.span
        return np.linspace(float(span.start), float(span.stop), span.samples)

    def __call__(
        self,
        t: ArrayLike | None = None,
        *,
        omega: ArrayLike | None = None,
        quaternion: ArrayLike | None = None,
        events: Any = None,
    ) -> Trajectory:
        """Return the motion at the times ``t``.

        Parameters
        ----------
        t : array, shape (n,), optional
            Sample times in s, increasing or in any order, before or after the initial time; default: the scene's own.
        omega : array, shape (3,), optional
            Another initial angular velocity, body components, rad/s.
        quaternion : array, shape (4,), optional
            Another initial attitude, scalar first; it is normalised.
        events : sequence, optional
            Formulas whose zeros are sought: text, :class:`symrot.propagation.events.Event` or mappings with its fields;
            see ``t_events`` of the trajectory. Samples beyond a terminal event are left out.

        Raises
        ------
        InputError
            For times or states that are not finite or have the wrong shape.
        PropagationError
            If the motion cannot be followed to the last time.
        """
        times = self.sample_times if t is None else _times(t)
        rise = _in_order(times)
        motion = self._motion
        if omega is not None or quaternion is not None:
            motion = self._prepare(self._planned(_initial(self.scene, omega, quaternion)))
        message = f"{motion.choice.method}: {motion.choice.reason}"
        try:
            if events is not None:
                from symrot.propagation.eventful import follow
                from symrot.propagation.events import read_events

                found = follow(motion, times, read_events(events))
                return Trajectory(motion, found.t, found.states, motion.choice.method, found.stats, message, found)
            states, stats = motion.follow(times, rise)
        except PropagationError as error:
            raise PropagationError(f"{self.scene.name}: {error}") from None
        return Trajectory(motion, times, states, motion.choice.method, stats, message)


def _times(t: ArrayLike) -> Floats:
    try:
        times = np.array(t, dtype=np.float64, ndmin=1)
    except (TypeError, ValueError):
        raise InputError(f"t: expected an array of times in s, got {number.show(t)}") from None
    if times.ndim != 1:
        raise InputError(f"t: expected a one-dimensional array of times in s, got shape {times.shape}")
    return times


def _in_order(times: Floats) -> bool:
    """Return whether times never fall; refuse those that are not finite: of times in order, the ends tell."""
    if not len(times):
        return True
    if isfinite(times.item(0)) and isfinite(times.item(-1)) and rising(times):
        return True
    if not np.isfinite(times).all():
        raise InputError(f"t: expected finite times in s, got {times[~np.isfinite(times)][0]}")
    return False


def _vector(values: ArrayLike, size: int, name: str, unit: str) -> list[float]:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected {size} numbers in {unit}, got {number.show(values)}") from None
    if array.shape != (size,) or not np.isfinite(array).all():
        raise InputError(f"{name}: expected {size} finite numbers in {unit}, got {number.show(array.tolist())}")
    found: list[float] = array.tolist()
    return found


def _initial(scene: Scene, omega: ArrayLike | None, quaternion: ArrayLike | None) -> Initial:
    initial = scene.initial
    if omega is not None:
        x, y, z = (number.read(value, "omega") for value in _vector(omega, 3, "omega", "rad/s"))
        initial = initial._replace(omega_b=(x, y, z))
    if quaternion is not None:
        q = [number.read(value, "quaternion") for value in _vector(quaternion, 4, "quaternion", "1")]
        norm = number.sqrt(sum((value * value for value in q), start=q[0] * 0))
        if norm == 0:
            raise InputError(f"quaternion: expected a quaternion that is not zero, got {number.show(q)}")
        initial = initial._replace(quaternion=(q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm))
    return initial


def propagator(
    scene: Scene | str | Path,
    method: str = "auto",
    tolerance: float | None = None,
    *,
    torque: Any = None,
    switching_times: ArrayLike = (),
    torque_frame: str = "body",
    state: str = "quaternion",
    switching: bool = True,
) -> Propagator:
    """Return the propagator of a scene: derived, specialised, emitted and compiled, or taken from the cache.

    Parameters
    ----------
    scene : Scene, str or Path
        A scene, the name of a shipped one, or the path of a scene file.
    method : str
        One of :data:`METHODS`; ``"scipy:LSODA"`` and the like for SciPy's.
    tolerance : float, optional
        Error of the trajectory to aim for: attitude in rad, angular velocity relative to its size; default: the
        scene's own.
    torque : optional
        One more torque, N m, that is no formula: a function of (t, omega, quaternion) that returns three numbers; a C
        function of ctypes, ``int (double t, const double omega[3], const double quaternion[4], double torque[3], void
        *user)``, which returns 0, with ``user`` null; or a table (times, samples of shape (n, 3)), which is
        interpolated by cubic splines between the switching times. The method is then ``dop853``.
    switching_times : array, optional
        Times, s, at which that torque jumps: the motion is stepped exactly to each and started anew. A function is
        asked just inside them; a table has two samples at each, before and after the jump.
    torque_frame : str
        ``"body"`` or ``"space"``: whose components that torque has.
    state : str
        ``"quaternion"``, or an Euler sequence such as ``"ZXZ"`` to step its angles instead, for teaching; see
        :mod:`symrot.propagation.euler_state`.
    switching : bool
        Whether such angles are exchanged for those of a regular sequence before they reach gimbal lock; ``stats``
        counts how often.

    Raises
    ------
    InputError
        For a scene or an option that cannot be used.
    CompilerError
        If ``dop853`` is asked for and there is no compiler, or the compiler refuses the kernel.
    """
    if not isinstance(scene, Scene):
        scene = load_scene(scene)
    aim = float(scene.tolerance) if tolerance is None else _tolerance(tolerance)
    if scene.table is not None:
        if torque is not None:
            raise InputError(
                f"torque: expected none for a scene with a torque of kind table, got {number.show(torque)}"
            )
        samples = scene.table
        torque, switching_times, torque_frame = samples[:2], samples.switching_times, samples.frame
    if state != "quaternion":
        if torque is not None:
            raise InputError(f"state: expected 'quaternion' for a torque that is no formula, got {state!r}")
        from symrot.propagation.euler_state import EulerPropagator

        return EulerPropagator(scene, method, aim, state, switching)
    if torque is None:
        return Propagator(scene, method, aim)
    if method not in ("auto", "dop853"):
        raise InputError(f"method: expected 'auto' or 'dop853' for a torque that is no formula, got {method!r}")
    from symrot.propagation.driven import DrivenPropagator

    return DrivenPropagator(scene, aim, torque, switching_times, torque_frame)


def _tolerance(tolerance: float) -> float:
    from symrot.scene import TOLERANCES

    low, high = TOLERANCES
    found = float(number.read(tolerance, "tolerance"))
    if not float(low) <= found <= float(high):  # as doubles: 0.01 is above 1/100
        raise InputError(f"tolerance: expected a number from {float(low):g} to {float(high):g}, got {tolerance}")
    return found


def propagate(
    scene: Scene | str | Path, method: str = "auto", tolerance: float | None = None, events: Any = None
) -> Trajectory:
    """Return the motion of a scene at its own sample times; see :func:`propagator` and :class:`Propagator`."""
    return propagator(scene, method, tolerance)(events=events)
