"""Motions by each method: constant, in closed form, integrated in C, integrated by SciPy."""

from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.registry import ClosedForm, Exact
from symrot.planning.plan import Plan
from symrot.propagation import time_shift
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.motions.motion import RestartableMotion, ShiftableMotion, SteppedInC
from symrot.propagation.motions.setup import ClosedFormSetup, SteppedSetup, python_rates
from symrot.propagation.steppers import dop853
from symrot.propagation.steppers.recording import Recording
from symrot.propagation.steppers.stats import Stats
from symrot.propagation.steppers.stepping import Integration
from symrot.scene.tables import Initial

if TYPE_CHECKING:
    from symrot.propagation.enclosures.step_limit import Deviations
    from symrot.propagation.steppers.fallback import Options

__all__ = ["ClosedFormMotion", "ConstantMotion", "SciPyMotion", "SteppedMotion"]

Floats = NDArray[np.float64]


@final
class ConstantMotion(RestartableMotion):
    """A motion in which every state is constant, so that its equations have no state to integrate."""

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
        """Return a function that takes n times, s, and returns the N states, shape (n, N); ``span`` is not used."""
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
        """The values of the parameters of the Taylor library: the parameters of the rates, each as one double.

        The parameters of the output quantities follow, each as two doubles whose sum is the value.
        """
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
        """Function that takes an epoch, s, and returns a compiled library and the values of the rates' parameters.

        The rates in the library take the time since the epoch.
        """
        # the epoch is a time on the clock of the motion
        return time_shift.clock(self.setup.shifted, self.plan.constants, self.epoch)

    def steps(self, times: Floats, in_order: bool) -> tuple[Floats, Stats]:
        """Return the N states at n times, s after :attr:`epoch`, shape (n, N), and the cost.

        ``in_order``: the times are finite and never decrease.
        """
        return self.stepping.sample_sorted(times, in_order)

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function that takes n times within ``span``, s, and returns the N states, shape (n, N).

        It evaluates recorded steps. Times and span are counted from :attr:`epoch`.
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
        """Function that takes an epoch, s, and returns rates in Python and the values of their parameters.

        These rates take the time since the epoch.
        """
        # the epoch is a time on the clock of the motion
        return time_shift.clock(self.setup.shifted, self.plan.constants, self.epoch, python_rates)

    def deviations(self, parameters: Sequence[float]) -> "Deviations | None":
        """Return bounds (``Deviations``) on how far the rates, with these parameters, can change near a time and state.

        SciPy's steps need them so as not to miss a short pulse of a torque. Return None if no torque can have a short
        pulse, or if the rates have no Taylor series.
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
        """Return the N states at n times, s after :attr:`epoch`, shape (n, N), and the cost."""
        from symrot.propagation.steppers import fallback

        start = (self.rate_parameters, self.plan.initial_state, self.start)
        # it sorts the times, so that in_order is not used
        return fallback.integrate(self.rates, *start, times, self.tolerance, self.options(self.rate_parameters))

    def dense(self, span: tuple[float, float]) -> Recording:
        """Return a function that takes n times within ``span``, s, and returns the N states, shape (n, N).

        It evaluates SciPy's interpolants. Times and span are counted from :attr:`epoch`.
        """
        from symrot.propagation.steppers import fallback

        start = (self.rate_parameters, self.plan.initial_state, self.start)
        recording = fallback.record(self.rates, *start, span, self.tolerance, self.options(self.rate_parameters))
        recording.epoch = self.epoch
        return recording
