"""The data that all motions of one plan, the equations of a scene, share, whatever their initial states.

The *rates* are the time derivatives of the states. The *epoch* is the time of the scene from which a stepper counts
time: the zero of its *clock*. Initial states with equations of equal form have the same *structure*.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.registry import ClosedForm, Starts
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH, SceneKernel
from symrot.propagation import time_shift
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import formula_deviations, motion_library, taylor_library
from symrot.propagation.method import Choice
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.stepping import Integration

if TYPE_CHECKING:
    from symrot.propagation.enclosures.step_limit import Deviations

__all__ = ["ClosedFormSetup", "Setup", "SteppedSetup", "python_rates", "stepped_on_own_clock"]

Floats = NDArray[np.float64]


def python_rates(plan: Plan, kernel: SceneKernel) -> Callable[..., Any]:
    """Return the rates (time derivatives of the states y) of a plan's equations as a NumPy function ``f(t, y, p)``.

    The arguments are time, states and parameters.
    """
    from symrot.codegen.numpy_kernel import load_numpy_kernel

    function = load_numpy_kernel(kernel.rates)
    return function if kernel.rate_parameters else lambda t, y, p: function(t, y)


@final
@dataclass(frozen=True, eq=False)
class Setup:
    """The data that all motions of one plan, the equations of a scene, share: method, kernel, numbers of the scene.

    The kernel is the generated code that computes the rates and the output quantities.

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
        """The kernel of the plan: generated code that computes rates and output quantities; loaded on first use."""
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
        """Function that takes a plan with an initial state and returns the parameters of the output quantities.

        Each parameter is two consecutive doubles, whose sum is right to 31 digits.
        """
        return Binding(self.kernel.quantity_parameters, self.plan, two_doubles)

    @cached_property
    def python_rates(self) -> Callable[..., Any]:
        """The rates (time derivatives of the states y) as a NumPy function ``f(t, y, p)``; p are their parameters."""
        return python_rates(self.plan, self.kernel)

    @cached_property
    def deviations(self) -> "Callable[[Mapping[str, float]], Deviations] | None":
        """Function that makes bounds (``Deviations``) from a map of the rates' parameters, name to value.

        The bounds say how far the rates can change near a time and state; SciPy's steps need them so as not to miss a
        short pulse of a torque. None if no torque can have a short pulse, or if the rates have no Taylor series.
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
    """The data that all motions of one plan in C share: a :class:`Setup` and the compiled library of its equations."""

    def __init__(self, setup: Setup, library: Path) -> None:
        self.setup, self.library = setup, library

    @cached_property
    def integration(self) -> Integration:
        """The integration from the initial state of the setup's plan; motions from other initial states copy it."""
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
        return stepped_on_own_clock(setup)


def stepped_on_own_clock(setup: Setup) -> SteppedSetup:
    """Return ``setup`` together with the compiled C library that integrates its equations of motion.

    The clock of ``setup`` shows 0 at the start of the motion (:attr:`Setup.on_own_clock`).
    """
    if setup.choice.method == "taylor":
        return SteppedSetup(setup, taylor_library(setup.plan, setup.kernel, setup.tolerance))
    return SteppedSetup(setup, motion_library(setup.plan, setup.kernel))


@final
class ClosedFormSetup:
    """The data that all motions of one scene in closed form share: plan, kernel and kind of closed form."""

    def __init__(self, setup: Setup, form: ClosedForm) -> None:
        self.setup, self.form = setup, form

    @cached_property
    def starts(self) -> Starts:
        """Function from an initial state to the motion in closed form, which can be evaluated at any time."""
        return self.form.starts(self.setup.plan.scene)
