"""The motion of a scene from one initial state: what motions by every method have in common."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.errors import PropagationError
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import SceneKernel
from symrot.propagation import time_shift
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.method import Choice
from symrot.propagation.motions.setup import Setup
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.stats import Stats, rounding_warning
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Integration
from symrot.scene.tables import Initial

__all__ = ["Motion", "MotionInParts", "RestartableMotion", "ShiftableMotion", "SteppedInC", "on_clock"]

Floats = NDArray[np.float64]


class ExternalTorque(Protocol):
    """A torque without a formula, as a motion under it uses it."""

    def following(self, start: float, times: Floats) -> AbstractContextManager[None]:
        """Return the context in which a motion is followed from the time ``start``, s, to ``times``, s.

        Raise InputError if the torque is not defined there. If the motion stops because the torque function raised an
        error, raise this error.
        """

    def raise_error(self) -> None:
        """Raise the error that the torque function raised in :meth:`following`; do nothing if there is none."""


# Each method has its own subclass. A Setup holds what a motion shares with those from other initial states.
class Motion(ABC):
    """The motion of a scene from one initial state; its stepper counts time from ``epoch``, a time of the scene, s."""

    # the torque without a formula that acts on the body, if there is one
    external_torque: ExternalTorque | None = None

    def __init__(self, setup: Setup, plan: Plan) -> None:
        # setup is shared with motions from other initial states; plan contains this initial state
        self.setup, self.plan = setup, plan

    @property
    def has_external_torque(self) -> bool:
        """Whether a torque without a formula acts on the body."""
        return self.external_torque is not None

    @property
    def choice(self) -> Choice:
        """The method that computes the motion, such as ``"taylor"``, and the reason for it, as a :class:`Choice`."""
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

    def rounding_warning(self, t: float) -> str:
        """Return a warning that from the time t, s, on rounding errors may exceed the tolerance.

        t is one of the times in ``Stats.rounded_beyond``: from it on, in the direction in which the motion is computed,
        rounding errors may change the motion by more than the tolerance.
        """
        if self.has_external_torque:
            return (
                f"beyond t = {t!r} s the rounding of the times at which the torque is evaluated, to doubles that lie "
                f"{math.ulp(t):.1e} s apart, may change the motion by more than the tolerance; choose the origin of "
                "time, t = 0, nearer to the motion, or a larger tolerance"
            )
        return rounding_warning(t, self.choice.method)

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
        """Return output quantities of the kernel at n times ``t``, s after :attr:`epoch`, shape (n, len(names)).

        ``states`` are the N states at these times, shape (n, N). ``names`` are the kernel's names of the quantities,
        such as ``"omega_1 of t"`` for the component omega_1.
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
        """Return the N states at n ``times`` of the scene, s, shape (n, N), and the cost in steps and evaluations.

        A closed form returns omega and, if the attitude is computed, the quaternion as separate arrays in a tuple.
        ``in_order``: the times are finite and never decrease.
        """

    @abstractmethod
    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return a function that takes n times within ``span``, s, and returns the N states, shape (n, N).

        Times and span are counted from :attr:`epoch`.
        """

    def following(self, times: Floats) -> AbstractContextManager[None]:
        """Return the context in which another module follows the motion, by its steps, from the start to ``times``, s.

        A torque without a formula is checked there: its domain, and the errors that it raises.
        """
        return nullcontext() if self.external_torque is None else self.external_torque.following(self.start, times)

    def raise_torque_error(self) -> None:
        """Raise the error that a torque function raised since :meth:`following`; do nothing if there is none."""
        if self.external_torque is not None:
            self.external_torque.raise_error()

    def integrate(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the N states at n times of the scene, s, as one array, shape (n, N), and the steps and evaluations."""
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
        """Return a function from n times, s, to omega, shape (3, n), or to omega and quaternion, shape (7, n).

        The function evaluates these quantities from the states that ``path`` returns for the times.
        """
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if with_attitude else []

        def at(t: ArrayLike) -> Floats:
            instants = real_array(t, "t", "times in s")
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
        """Return the N states at n times, s after :attr:`epoch`, shape (n, N), and the cost in steps and evaluations.

        ``in_order``: the times are finite and never decrease.
        """

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the N states at n times of the scene, s, shape (n, N), and the cost in steps and evaluations.

        ``in_order``: the times are finite and never decrease.
        """
        if not self._shifts(times):
            return self.steps(times, in_order)
        # all times lie near a late start, and keep more digits if counted from the start
        motion = self.on_own_clock
        try:
            states, stats = motion.steps(times - motion.epoch, in_order)
            return states, stats.later(motion.epoch)
        except IntegrationStopped as error:
            raise error.later(motion.epoch) from None

    def _shifts(self, times: Floats) -> bool:
        """Return whether time is counted from the start of the motion to compute the states at ``times``, s.

        This is so if ``allows_time_shift`` is true in the :class:`Setup` of the motion, the start is not 0, and all
        times lie between half and twice the start.
        """
        if not (self.start and self.setup.allows_time_shift and len(times)):
            return False
        # they keep more digits on a clock that shows 0 at the start
        return time_shift.starts_far(self.start, float(times.min()), float(times.max()))


def on_clock(motion: Motion, times: Floats) -> Motion:
    """Return the motion with time counted from 0 or from its start, whichever lets ``times``, s, keep more digits."""
    return motion.on_own_clock if isinstance(motion, ShiftableMotion) and motion._shifts(times) else motion


class MotionInParts(Motion):
    """Interface of a motion under torques that jump or bend at certain times; it is smooth in between."""

    @abstractmethod
    def parts(self, end: float, broken: list[PropagationError]) -> tuple[list[Piece], Recording]:
        """Return the motion from its start to ``end``, s, as polynomials, and also as a function from times to states.

        If the motion stops early, the error is appended to ``broken``.
        """
