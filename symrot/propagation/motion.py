"""Motions: a plan with numbers and one initial state, from which the states at any time can be computed.

The *rates* are the time derivatives of the states. The *epoch* is the time of the scene from which a stepper counts
time: the zero of its *clock*. Initial states with equations of equal form have the same *structure*.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.closed_form.registry import ClosedForm, Exact, Starts
from symrot.errors import PropagationError
from symrot.planning.plan import Plan
from symrot.planning.rules import RuleOutcome
from symrot.planning.scene_kernel import EPOCH, SceneKernel
from symrot.propagation import time_shift
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import compiled, error_blocks, formula_deviations, scene_kernel, taylor_library
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.method import Choice
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Integration, Recording, Stats
from symrot.scene.tables import Initial

if TYPE_CHECKING:
    from symrot.propagation.enclosures.step_limit import Deviations
    from symrot.propagation.steppers.fallback import Options

__all__ = [
    "ClosedFormMotion", "ConstantMotion", "Motion", "MotionInParts", "RestartableMotion", "SciPyMotion", "Setup",
    "SteppedInC", "SteppedMotion", "make_motion", "on_clock", "on_own_clock", "python_rates", "stepped_motion",
    "with_full_state",
]  # fmt: skip

Floats = NDArray[np.float64]


def python_rates(plan: Plan, kernel: SceneKernel) -> Callable[..., Any]:
    """Return the rates of a plan as a NumPy function ``f(t, y, p)`` of time, states and parameters."""
    from symrot.codegen.numpy_kernel import load_numpy_kernel

    function = load_numpy_kernel(kernel.rates)
    return function if kernel.rate_parameters else lambda t, y, p: function(t, y)


def with_full_state(plan: Plan, form: ClosedForm) -> Plan:
    """Return the plan without simplifications that eliminate states, for a motion in the closed form ``form``."""
    # a closed form gives all states at no cost, since nothing has to be integrated
    structure = plan.structure.unreduced()
    rows, before = [], structure.reductions
    for row in plan.rows:
        if row.structure.reductions == before:
            rows.append(row)
        before = row.structure.reductions
    why = f"the motion has a closed form: {form.name}"
    # the last row of the plan names the closed form as the reason
    rows.append(RuleOutcome(structure, True, why, form.derivation, "stepping"))
    return replace(plan, structure=structure, rows=tuple(rows))


# ------------------------------------------------------------------------------------------------ shared setups


@final
@dataclass(frozen=True, eq=False)
class Setup:
    """The data that all motions of one plan share, whatever their initial states: method, kernel, numbers of the scene.

    Attributes
    ----------
    plan : Plan
        The plan from which the setup was made. Other scenes whose equations have the same form share the setup; their
        motions have plans of their own.
    choice : Choice
        The method, and the reason for it.
    tolerance : float
        Error of the trajectory to aim for.
    start : float
        Initial time, s, on the clock of the motions.
    load_kernel : function
        Returns the kernel. It is called when the kernel is first needed; a motion in closed form may never need it.
    epoch : float
        Time of the scene, s, at which the clock of the motions shows 0.
    allows_time_shift : bool
        Whether the stepper may count time from another instant than t = 0 of the scene.
    warnings : tuple of str
        Sentences that say which accuracy cannot be guaranteed.
    """

    plan: Plan
    choice: Choice
    tolerance: float
    start: float
    load_kernel: Callable[[], SceneKernel]
    epoch: float = 0.0
    allows_time_shift: bool = True
    warnings: tuple[str, ...] = ()

    @cached_property
    def message(self) -> str:
        """The method and the reason for it, as one text, such as ``"exact: free body, theta functions"``."""
        return f"{self.choice.method}: {self.choice.reason}"

    @cached_property
    def kernel(self) -> SceneKernel:
        """The kernel of the plan, the code that computes rates and output quantities; loaded on first use."""
        return self.load_kernel()

    @cached_property
    def moves_clock(self) -> bool:
        """Whether the stepper moves the epoch from which it counts time, so that phases such as ``a*t`` keep digits."""
        return self.allows_time_shift and self.kernel.rates.uses("t")

    @cached_property
    def rate_binding(self) -> Binding:
        """Function that takes a plan with an initial state and returns the parameters of the rates, in doubles."""
        return Binding(self.kernel.rate_parameters, self.plan, known={EPOCH: Fraction(self.epoch)})

    @cached_property
    def quantity_binding(self) -> Binding:
        """Function from a plan to the parameters of the output quantities, each as a pair of doubles.

        The sum of a pair is right to 31 digits.
        """
        return Binding(self.kernel.quantity_parameters, self.plan, two_doubles)

    @cached_property
    def python_rates(self) -> Callable[..., Any]:
        """The rates (time derivatives of the states y) as a NumPy function ``f(t, y, p)``; p are their parameters."""
        return python_rates(self.plan, self.kernel)

    @cached_property
    def deviations(self) -> "Callable[[Mapping[str, float]], Deviations] | None":
        """Function from the parameters of the rates to bounds on torque changes (``Deviations``), for SciPy's steps.

        None if no torque can have a pulse that a step misses, or if the rates have no Taylor series.
        """
        return formula_deviations(self.plan, self.kernel)

    def shifted(self) -> tuple[Plan, SceneKernel]:
        """Return plan and kernel with time counted from an epoch, a parameter that a stepper can change."""
        # time_shifted returns both unchanged if the rates do not depend on time
        is_shifted = self.plan.structure.clock is not None
        return (self.plan, self.kernel) if is_shifted else time_shift.time_shifted(self.plan, self.kernel)

    @cached_property
    def on_own_clock(self) -> "Setup":
        """A copy of the setup with time counted from the start of the motion, so that late times keep more digits."""
        plan, kernel = time_shift.time_shifted(self.plan, self.kernel)
        return replace(self, plan=plan, start=0.0, epoch=self.start, load_kernel=lambda: kernel)


@final
class SteppedSetup:
    """Setup shared by all motions of one plan that are integrated in C, with the compiled library."""

    def __init__(self, setup: Setup, library: Path) -> None:
        self.setup, self.library = setup, library

    @cached_property
    def integration(self) -> Integration:
        """The integration from the initial state of the shared plan; motions from other initial states copy it."""
        # thus tolerance and library are checked only once
        setup, plan = self.setup, self.setup.plan
        parameters, state = setup.rate_binding(plan), plan.initial_state
        if setup.choice.method == "dop853":
            return dop853.integration(self.library, parameters, state, setup.start, setup.tolerance)
        parameters = [*parameters, *setup.quantity_binding(plan)]
        return taylor.integration(self.library, parameters, state, setup.start, setup.tolerance)

    @cached_property
    def on_own_clock(self) -> "SteppedSetup":
        """A copy with time counted from the start of the motion, so that times near a late start keep all digits."""
        setup = self.setup.on_own_clock
        if setup.plan is self.setup.plan:  # the rates do not depend on the time
            return SteppedSetup(setup, self.library)
        # another library, whose rates take the epoch as a parameter
        return _stepped_on_own_clock(setup)


def _stepped_on_own_clock(setup: Setup) -> SteppedSetup:
    if setup.choice.method == "taylor":
        return SteppedSetup(setup, taylor_library(setup.plan, setup.kernel, setup.tolerance))
    return SteppedSetup(setup, time_shift.compiled(setup.plan, setup.kernel))


@final
class ClosedFormSetup:
    """The data that all motions of one scene in closed form share: plan, kernel and kind of closed form."""

    def __init__(self, setup: Setup, form: ClosedForm) -> None:
        self.setup, self.form = setup, form

    @cached_property
    def starts(self) -> Starts:
        """Function from an initial state to the motion in closed form, which can be evaluated at any time."""
        return self.form.starts(self.setup.plan.scene)


# ------------------------------------------------------------------------------------------------ motions


# Each method has its own subclass. A Setup holds what a motion shares with those from other initial states.
class Motion(ABC):
    """The motion of a scene from one initial state; its stepper counts time from ``epoch``, a time of the scene, s."""

    # whether a torque without a formula acts on the body
    has_external_torque = False

    def __init__(self, setup: Setup, plan: Plan) -> None:
        # setup is shared with motions from other initial states; plan contains this initial state
        self.setup, self.plan = setup, plan

    @property
    def choice(self) -> Choice:
        """The method that follows the motion, such as ``"taylor"``, and the reason for it, as a :class:`Choice`."""
        return self.setup.choice

    @property
    def tolerance(self) -> float:
        """Error of the trajectory to aim for: in rad for the attitude, relative for the angular velocity."""
        return self.setup.tolerance

    @property
    def start(self) -> float:
        """Initial time, s after the epoch: 0 if the stepper counts time from the start of the motion."""
        return self.setup.start

    @property
    def epoch(self) -> float:
        """Time of the scene, s, from which the stepper counts time; often 0."""
        return self.setup.epoch

    @property
    def kernel(self) -> SceneKernel:
        """The kernel, which computes rates and output quantities. A motion in closed form needs only the quantities."""
        return self.setup.kernel

    @property
    def rates(self) -> Callable[..., Any]:
        """The rates (time derivatives of the states y) as a NumPy function ``f(t, y, p)``; p are their parameters."""
        return self.setup.python_rates

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about accuracy that cannot be guaranteed for this motion; empty if there are none."""
        return self.setup.warnings

    @cached_property
    def rate_parameters(self) -> list[float]:
        """The values of the parameters of the rates, for this initial state, in the order of the kernel's array p."""
        try:
            return self.setup.rate_binding(self.plan)
        except OverflowError:
            # a value exceeds the range of doubles
            raise IntegrationStopped(self.start, NOT_FINITE_SENTENCE) from None

    @cached_property
    def _quantity_values(self) -> dict[str, float]:
        names = [name for name, _ in self.kernel.quantity_parameters]
        return dict(zip(names, self.setup.quantity_binding(self.plan)[::2], strict=True))

    def evaluate(self, t: Floats, states: Floats, names: Sequence[str]) -> Floats:
        """Return output quantities of the kernel at times ``t``, s after the epoch, shape (n, len(names)).

        The kernel calls omega_1 ``"omega_1 of t"``.
        """
        columns = [name.removesuffix(" of t") for name in names]
        if set(columns) <= set(self.plan.states):  # every quantity is a state
            return states[:, [self.plan.states.index(name) for name in columns]]
        values: dict[str, Any] = {"t": t, **dict(zip(self.plan.states, states.T, strict=True)), **self._quantity_values}
        quantities = self.kernel.quantities.evaluate(values, ARRAY_FUNCTIONS, float, names)
        result = np.empty((len(t), len(names)))
        for index, name in enumerate(names):
            result[:, index] = quantities[name]
        return result

    @cached_property
    def _initial(self) -> tuple[Floats, Floats]:
        return np.array([self.start]), np.array([self.plan.initial_state]).reshape(1, -1)

    def initial_quantity(self, name: str) -> float:
        """Return the value of a conserved quantity at the initial time; ``name`` is its name, such as ``"energy"``."""
        if name == "quaternion norm":
            return 1.0
        output = next(item.output for item in self.kernel.conserved if item.name == name)
        return float(self.evaluate(*self._initial, [output])[0, 0])

    @abstractmethod
    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats | tuple[Floats, ...], Stats]:
        """Return the states at ``times`` of the scene, s, shape (n, N), and the cost.

        A closed form returns omega and quaternion apart. ``in_order``: the times are finite and never decrease.
        """

    @abstractmethod
    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return a function from n times, s, within ``span`` to the states, shape (n, N).

        Times and span are counted from the epoch.
        """

    def integrate(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the states at times of the scene, s, in one array, shape (n, N), and the cost of the motion."""
        # a closed form has separate arrays for angular velocity and attitude
        states, stats = self.follow(times, in_order)
        return np.concatenate(states, axis=1) if isinstance(states, tuple) else states, stats

    def path(self, times: Floats) -> Callable[[Floats], Floats]:
        """Return the motion from the start to all ``times`` as a function from times of the scene, s, to states."""
        span = (
            (min(self.start, float(times.min())), max(self.start, float(times.max())))
            if len(times)
            else (self.start,) * 2
        )
        motion = on_clock(self, np.array(span))
        zero = motion.epoch
        try:
            states = motion.dense((span[0] - zero, span[1] - zero))
        except IntegrationStopped as error:
            raise (error.later(zero) if zero else error) from None
        return lambda t: states(t - zero if zero else t)

    def solution(self, path: Callable[[Floats], Floats], with_attitude: bool) -> Callable[[ArrayLike], Floats]:
        """Return a function from n times to omega, shape (3, n), or to omega and quaternion, shape (7, n)."""
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if with_attitude else []

        def at(t: ArrayLike) -> Floats:
            instants = np.asarray(t, dtype=float)
            flat = np.atleast_1d(instants).ravel()
            values = self.evaluate(flat, path(flat), names).T
            # shape (3,) or (7,) for a single time
            return values.reshape(len(names), *instants.shape)

        return at


class RestartableMotion(Motion):
    """A motion that can restart, without a derivation, from another initial state with equations of the same form."""

    @abstractmethod
    def from_start(self, initial: Initial) -> "RestartableMotion":
        """Return the motion from another initial state; whether the equations keep their form is not checked."""


class SteppedInC(ABC):
    """Interface of motions that a stepper in C integrates; the property ``stepping`` is the integration."""

    @property
    @abstractmethod
    def stepping(self) -> Integration:
        """The integration of the motion, with checked arguments; it can be sampled any number of times."""


class ShiftableMotion(RestartableMotion):
    """An integrated motion whose time can be counted from its start, so that late times keep more digits."""

    @property
    @abstractmethod
    def on_own_clock(self) -> "ShiftableMotion":
        """The same motion with time counted from its start, so that times near a late start keep all digits."""

    @abstractmethod
    def steps(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the states at times, s after the epoch, shape (n, N), and the cost.

        ``in_order``: the times are finite and never decrease.
        """

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the states at times of the scene, s, shape (n, N), and the cost.

        ``in_order``: the times are finite and never decrease.
        """
        if not self._shifts(times):
            return self.steps(times, in_order)
        # all times lie near a late start, and keep more digits if counted from the start
        motion = self.on_own_clock
        try:
            return motion.steps(times - motion.epoch, in_order)
        except IntegrationStopped as error:
            raise error.later(motion.epoch) from None

    def _shifts(self, times: Floats) -> bool:
        """Return whether the start is not 0 and all ``times`` of the scene, s, lie between half and twice the start."""
        if not (self.start and self.setup.allows_time_shift and len(times)):
            return False
        # they keep more digits on a clock that shows 0 at the start
        return time_shift.starts_far(self.start, float(times.min()), float(times.max()))


def on_clock(motion: Motion, times: Floats) -> Motion:
    """Return the motion with time counted from 0 or from its start, whichever lets ``times``, s, keep more digits."""
    # its own clock, or one that shows 0 at the start
    return motion.on_own_clock if isinstance(motion, ShiftableMotion) and motion._shifts(times) else motion


@final
class ConstantMotion(RestartableMotion):
    """A motion in which every state is constant, so that the plan leaves no state to integrate."""

    def from_start(self, initial: Initial) -> "ConstantMotion":
        """Return the motion from another initial state, for which the equations must have the same form."""
        return ConstantMotion(self.setup, self.setup.plan.from_start(initial))

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return an empty array, shape (n, 0), for n times, and a cost of zero: no state is integrated."""
        return np.empty((len(times), 0)), Stats(0, 0, 0, 0.0)

    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return a function from n times to an empty array, shape (n, 0): no state is integrated."""
        return lambda t: np.empty((len(t), 0))


@final
class ClosedFormMotion(RestartableMotion):
    """A motion in closed form, whose states at each time are computed without the states at other times."""

    def __init__(self, shared: ClosedFormSetup, plan: Plan) -> None:
        super().__init__(shared.setup, plan)
        self._shared = shared

    def from_start(self, initial: Initial) -> "ClosedFormMotion":
        """Return the motion from another initial state, for which the equations must have the same form."""
        return ClosedFormMotion(self._shared, self.setup.plan.from_start(initial))

    @property
    def form(self) -> ClosedForm:
        """The kind of closed form from the table of closed forms, such as the free body or the heavy top."""
        return self._shared.form

    @cached_property
    def exact(self) -> Exact:
        """The closed form of the motion from this initial state, which can be evaluated at any time."""
        return self._shared.starts(self.plan.scene.initial)

    def follow(self, times: Floats, in_order: bool = False) -> tuple[tuple[Floats, ...], Stats]:
        """Return angular velocity, shape (n, 3), and attitude, (n, 4), if it is computed, and the cost: zero steps."""
        attitude, exact = self.plan.structure.attitude, self.exact
        began, start = perf_counter(), self.setup.start
        omega, quaternion = exact.evaluate(times - start if start else times, quaternion=attitude)
        assert omega is not None
        # in_order promises that the times are finite and never decrease
        if not (in_order and len(times) and times.item(0) > start):  # exactly, as with every other method
            at_start: Any
            if not in_order:
                at_start = times == start
            elif len(times) > 1 and times.item(0) == start < times.item(1):
                at_start = 0
            else:
                at_start = slice(times.searchsorted(start, "left"), times.searchsorted(start, "right"))
            omega[at_start] = self.plan.initial_state[:3]
            if quaternion is not None:
                quaternion[at_start] = self.plan.initial_state[3:]
        return (omega,) if quaternion is None else (omega, quaternion), Stats(0, 0, 0, perf_counter() - began)

    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return a function that takes n times, s, and returns the states, shape (n, N); ``span`` is not used."""
        return lambda t: self.integrate(t)[0]


@final
class SteppedMotion(ShiftableMotion, SteppedInC):
    """A motion integrated by a stepper in C, with Taylor series or with Dormand and Prince's method."""

    def __init__(self, shared: SteppedSetup, plan: Plan) -> None:
        super().__init__(shared.setup, plan)
        self._shared = shared

    def from_start(self, initial: Initial) -> "SteppedMotion":
        """Return the motion from another initial state, for which the equations must have the same form."""
        return SteppedMotion(self._shared, self.setup.plan.from_start(initial))

    @property
    def library(self) -> Path:
        """The path of the compiled library of kernel and stepper."""
        return self._shared.library

    @cached_property
    def on_own_clock(self) -> "SteppedMotion":
        """The same motion with time counted from its start, so that times near a late start keep all digits."""
        shared = self._shared.on_own_clock
        return SteppedMotion(shared, shared.setup.plan.from_start(self.plan.scene.initial))

    @cached_property
    def taylor_parameters(self) -> list[float]:
        """Values for the Taylor library: one double for a parameter of the rates, two for one of the quantities."""
        return [*self.rate_parameters, *self.setup.quantity_binding(self.plan)]

    @cached_property
    def stepping(self) -> Integration:
        """The object that integrates this motion in C, at sample times or with all steps recorded."""
        state = self.plan.initial_state
        if self.choice.method == "taylor":  # the Taylor stepper holds the time in two doubles and moves no clock
            parameters = self.taylor_parameters
            return self._shared.integration.from_start(parameters, state)
        parameters = self.rate_parameters
        if not self.setup.moves_clock:
            return self._shared.integration.from_start(parameters, state)
        start = (self.library, parameters, state, self.start, self.tolerance)
        return dop853.integration(*start, clock=lambda since: self._clock(since))

    @cached_property
    def _clock(self) -> dop853.Clock:
        """Function from an epoch, s, to a library, whose rates take the time since the epoch, and their parameters."""
        # the epoch is a time on the clock of the motion
        return time_shift.clock(self.setup.shifted, self.plan.constants, self.epoch)

    def steps(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the states at times, s after the epoch, shape (n, N), and the cost.

        ``in_order``: the times are finite and never decrease.
        """
        return self.stepping.sample_sorted(times, in_order)

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function from n times, s, within ``span`` to the states, shape (n, N), by recorded steps.

        Times and span are counted from the epoch.
        """
        recording = self.stepping.restarted().record(span)
        recording.epoch = self.epoch
        return recording


@final
class SciPyMotion(ShiftableMotion):
    """A motion integrated by one of SciPy's methods, with rates that NumPy computes."""

    def from_start(self, initial: Initial) -> "SciPyMotion":
        """Return the motion from another initial state, for which the equations must have the same form."""
        return SciPyMotion(self.setup, self.setup.plan.from_start(initial))

    @cached_property
    def on_own_clock(self) -> "SciPyMotion":
        """The same motion with time counted from its start, so that times near a late start keep all digits."""
        setup = self.setup.on_own_clock
        return SciPyMotion(setup, setup.plan.from_start(self.plan.scene.initial))

    @cached_property
    def _clock(self) -> Callable[[float], Any]:
        """Function from an epoch, s, to rates in Python, which take the time since the epoch, and their parameters."""
        # the epoch is a time on the clock of the motion
        return time_shift.clock(self.setup.shifted, self.plan.constants, self.epoch, python_rates)

    def deviations(self, parameters: Sequence[float]) -> "Deviations | None":
        """Return bounds on torque changes (``Deviations``) for SciPy's steps.

        None if no torque can have a pulse that a step misses, or if the rates have no Taylor series.
        """
        if self.setup.deviations is None:
            return None
        names = [name for name, _ in self.kernel.rate_parameters]
        return self.setup.deviations(dict(zip(names, parameters, strict=True)))

    def options(self, parameters: Sequence[float]) -> "Options":
        """Return SciPy's method, its error control and step limits, for the given parameters of the rates."""
        from symrot.propagation.steppers.fallback import Options

        blocks, scales = error_blocks(self.plan)
        clock = self._clock if self.setup.moves_clock else None
        deviations = self.deviations(parameters)
        return Options(self.choice.method, blocks, scales, deviations=deviations, clock=clock)

    def steps(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the states at times, s after the epoch, shape (n, N), and the cost."""
        from symrot.propagation.steppers import fallback

        start = (self.rate_parameters, self.plan.initial_state, self.start)
        # it sorts the times, so that in_order is not used
        return fallback.integrate(self.rates, *start, times, self.tolerance, self.options(self.rate_parameters))

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function from n times, s, within ``span`` to the states, shape (n, N), by SciPy's interpolants.

        Times and span are counted from the epoch.
        """
        from symrot.propagation.steppers import fallback

        start = (self.rate_parameters, self.plan.initial_state, self.start)
        recording = fallback.record(self.rates, *start, span, self.tolerance, self.options(self.rate_parameters))
        recording.epoch = self.epoch
        return recording


class MotionInParts(Motion):
    """Interface of a motion under torques that jump or bend at certain times; it is smooth in between."""

    @abstractmethod
    def parts(self, end: float, broken: list[PropagationError]) -> tuple[list[Piece], Recording]:
        """Return the motion from its start to ``end``, s, as polynomials, and also as a function from times to states.

        If the motion stops early, the error is appended to ``broken``.
        """


# ------------------------------------------------------------------------------------------------ from plans to motions


def make_motion(plan: Plan, choice: Choice, tolerance: float) -> RestartableMotion:
    """Return the motion of a plan by the chosen method, from the initial state of the plan's scene."""
    if choice.form is not None:
        choice.form.begin()
        plan = with_full_state(plan, choice.form)
        return ClosedFormMotion(ClosedFormSetup(_setup(plan, choice, tolerance), choice.form), plan)
    if choice.method in ("taylor", "dop853"):
        return stepped_motion(plan, choice, tolerance)
    setup = _setup(plan, choice, tolerance)
    return ConstantMotion(setup, plan) if choice.method == "constant" else SciPyMotion(setup, plan)


def _setup(plan: Plan, choice: Choice, tolerance: float) -> Setup:
    return Setup(plan, choice, tolerance, float(plan.scene.span.start), lambda: scene_kernel(plan))


def stepped_motion(plan: Plan, choice: Choice, tolerance: float) -> SteppedMotion:
    """Return the motion of a plan, integrated in C by the method of ``choice``, ``taylor`` or ``dop853``."""
    if choice.method == "taylor":
        kernel = scene_kernel(plan)
        library = taylor_library(plan, kernel, tolerance)
    else:
        kernel, library = compiled(plan)
    setup = Setup(plan, choice, tolerance, float(plan.scene.span.start), lambda: kernel)
    return SteppedMotion(SteppedSetup(setup, library), plan)


def on_own_clock(plan: Plan, choice: Choice, tolerance: float) -> SteppedMotion | SciPyMotion:
    """Return the integrated motion of a plan, with time counted from its start if its rates depend on time."""
    setup = _setup(plan, choice, tolerance)
    timed, steps_in_c = setup.kernel.rates.uses("t"), choice.method in ("taylor", "dop853")
    if not timed:
        # the clock remains scene time
        return stepped_motion(plan, choice, tolerance) if steps_in_c else SciPyMotion(setup, plan)
    # the epoch, the scene time at which the clock shows 0, becomes a parameter of the rates
    setup = setup.on_own_clock
    if steps_in_c:
        return SteppedMotion(_stepped_on_own_clock(setup), setup.plan)
    return SciPyMotion(setup, setup.plan)
