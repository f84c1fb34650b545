"""A plan bound to numbers: the states at any times by the chosen method, and quantities of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.closed_form.registry import Exact, Form
from symrot.errors import PropagationError
from symrot.planning.plan import Plan, RuleOutcome
from symrot.planning.scene_kernel import EPOCH, SceneKernel
from symrot.propagation import time_shift as epoch
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import compiled, error_blocks, formula_deviations, scene_kernel, taylor_library
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.method import Choice
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.cut_off import CutOff
from symrot.propagation.steppers.dop853 import Stats
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE, Recording, Task
from symrot.scene.scene import Initial

if TYPE_CHECKING:
    from symrot.propagation.enclosures.step_limit import Deviations

__all__ = ["Motion", "MotionInParts", "on_own_clock", "python_rates", "unreduced"]

Floats = NDArray[np.float64]


def python_rates(plan: Plan, kernel: SceneKernel) -> Callable[..., Any]:
    """Return the emitted NumPy kernel of the rates of a plan as ``f(t, y, p)``."""
    from symrot.codegen.numpy_kernel import load_numpy_kernel

    function = load_numpy_kernel(kernel.rates)
    return function if kernel.rate_parameters else lambda t, y, p: function(t, y)


def unreduced(plan: Plan, form: Form) -> Plan:
    """Return the plan of a motion in closed form, which has all its components and skips the stepping."""
    structure = plan.structure.unreduced()
    rows, before = [], structure.reductions
    for row in plan.rows:
        if row.structure.reductions == before:
            rows.append(row)
        before = row.structure.reductions
    why = f"the motion has a closed form: {form.name}"
    rows.append(RuleOutcome(structure, True, why, form.derivation, "stepping"))
    return replace(plan, structure=structure, rows=tuple(rows))


OF_START = (
    "rate_parameters", "taylor_parameters", "stepping", "exact", "_quantity_values", "_initial", "_on_own_clock",
    "_clock", "_python_clock",
)  # fmt: skip
"""What a motion keeps that depends on its start."""


class Motion:
    """A plan with its kernel, bound to numbers.

    Its clock shows 0 at the time ``epoch`` of the scene.
    """

    epoch = 0.0
    movable = True  # whether another clock may be taken
    switched = False  # whether its torques have switches
    warnings: tuple[str, ...] = ()  # on what cannot be guaranteed
    restarts = True  # whether from_start knows the class; each class says so for itself
    first: "Motion | None" = None  # of the same structure, whose kernels, library and numbers are used

    def __init__(self, plan: Plan, choice: Choice, tolerance: float) -> None:
        self.plan, self.choice, self.tolerance = plan, choice, tolerance
        self.library: Path | None = None
        if choice.method == "exact":
            assert choice.form is not None
            choice.form.begin()
            self.form, self.plan = choice.form, unreduced(plan, choice.form)
        elif choice.method == "dop853":
            self.kernel, self.library = compiled(plan)
        elif choice.method == "taylor":
            self.kernel = scene_kernel(plan)
            self.library = taylor_library(plan, self.kernel, tolerance)
        self.start = float(plan.scene.span.start)

    def from_start(self, initial: Initial) -> "Motion":
        """Return the motion from another initial state of the same structure; nothing is looked up or derived again.

        Of the same structure is a start with the same :func:`symrot.planning.plan.structure_key`.
        """
        other: Motion = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        for name in OF_START:
            other.__dict__.pop(name, None)
        other.plan, other.first = self.plan.from_start(initial), self.first or self
        return other

    @cached_property
    def kernel(self) -> SceneKernel:
        """The derived kernels; of an exact motion, only when something other than omega and attitude is asked for."""
        return self.first.kernel if self.first else scene_kernel(self.plan)

    @cached_property
    def _timed(self) -> bool:
        """Whether the time stands in the rates."""
        return self.first._timed if self.first else self.kernel.rates.uses("t")

    @property
    def _on_clocks(self) -> bool:
        """Whether the clock of the rates is moved along with the steps."""
        return bool(self.movable or self.epoch) and self._timed

    @cached_property
    def _rates_binding(self) -> Binding:
        return self.first._rates_binding if self.first else Binding(self.kernel.rate_parameters, self.plan)

    @cached_property
    def _quantities_binding(self) -> Binding:
        """The parameters of quantities, each as two doubles."""
        if self.first:
            return self.first._quantities_binding
        return Binding(self.kernel.quantity_parameters, self.plan, two_doubles)

    @cached_property
    def rate_parameters(self) -> list[float]:
        return self._rates_binding(self.plan)

    @cached_property
    def stepping(self) -> Task:
        """The motion as its stepper in C follows it: checked once, followed as often as asked."""
        assert self.library is not None
        parameters = self.taylor_parameters if self.choice.method == "taylor" else self.rate_parameters
        if self.first and not self._on_clocks:  # whose clock would be that of another start
            return self.first.stepping.from_start(parameters, self.plan.initial_state)
        start = (parameters, self.plan.initial_state, self.start)
        if self.choice.method == "taylor":
            return taylor.task(self.library, *start, self.tolerance)
        clock = (lambda since: self._clock(since)) if self._on_clocks else None
        return dop853.task(self.library, *start, self.tolerance, clock=clock)

    @cached_property
    def _clock(self) -> dop853.Clock:
        """The clock of the rates, once it is moved."""
        return epoch.clock(self._moved, self.plan.constants, self.epoch)

    def _moved(self) -> tuple[Plan, SceneKernel]:
        """Return plan and kernel on a clock that can be moved."""
        return epoch.moved(self.plan, self.kernel)

    @cached_property
    def taylor_parameters(self) -> list[float]:
        """Those of the rates, then those of the invariants."""
        return [*self.rate_parameters, *self._quantities_binding(self.plan)]

    @cached_property
    def _quantity_values(self) -> dict[str, float]:
        names = [name for name, _ in self.kernel.quantity_parameters]
        return dict(zip(names, self._quantities_binding(self.plan)[::2], strict=True))

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

    def on_clock(self, times: Floats) -> "Motion":
        """Return the motion on the clock that suits such times: this one, or one that shows 0 at the start."""
        if not (self.start and self.movable and len(times) and self.choice.method.partition(":")[0] in STEPPED):
            return self
        return self._on_own_clock if epoch.far(self.start, float(times.min()), float(times.max())) else self

    @cached_property
    def _on_own_clock(self) -> "Motion":
        return self.first._on_own_clock.from_start(self.plan.scene.initial) if self.first else _OnOwnClock(self)

    def integrate(self, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
        """Return the states at the times, shape (n, N), and what it cost; ``rise``: they are known to be in order."""
        motion = self.on_clock(times) if self.start else self
        if motion is not self:
            try:
                return motion.integrate(times - motion.epoch, rise)
            except CutOff as error:
                raise error.later(motion.epoch) from None
        return INTEGRATORS[self.choice.method.partition(":")[0]](self, times, rise)

    def follow(self, times: Floats, rise: bool = False) -> tuple[Floats | tuple[Floats, ...], Stats]:
        """Return as :meth:`integrate`, but of an exact motion angular velocity and attitude in an array each."""
        return _exact_parts(self, times, rise) if self.choice.method == "exact" else self.integrate(times, rise)

    @cached_property
    def rates(self) -> Callable[..., Any]:
        """The emitted NumPy kernel as ``f(t, y, p)``."""
        return self.first.rates if self.first else python_rates(self.plan, self.kernel)

    @cached_property
    def _python_clock(self) -> Callable[[float], Any]:
        """The clock of :attr:`rates`, once it is moved."""
        return epoch.clock(self._moved, self.plan.constants, self.epoch, python_rates)

    @cached_property
    def exact(self) -> Exact:
        """The motion in closed form."""
        return self._starts(self.plan.scene.initial)

    @cached_property
    def _starts(self) -> Callable[[Initial], Exact]:
        """The closed form of the body and its torques, with all that its starts share."""
        return self.first._starts if self.first else self.form.starts(self.plan.scene)

    def solution(self, times: Floats, with_attitude: bool) -> Callable[[ArrayLike], Floats]:
        """Return omega, and the quaternion if asked for, as a function of time from the start over all the times."""
        span = (
            (min(self.start, float(times.min())), max(self.start, float(times.max())))
            if len(times)
            else (self.start,) * 2
        )
        motion = self.on_clock(np.array(span))
        zero = motion.epoch
        states = motion.dense((span[0] - zero, span[1] - zero))
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if with_attitude else []

        def at(t: ArrayLike) -> Floats:
            wanted = np.asarray(t, dtype=float)
            flat = np.atleast_1d(wanted).ravel()
            found = self.evaluate(flat, states(flat - zero if zero else flat), names).T
            return found.reshape(len(names), *wanted.shape)

        return at

    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return the states as a function of time."""
        if self.choice.method == "constant":
            return lambda t: np.empty((len(t), 0))
        if self.choice.method == "exact":
            return lambda t: _exact(self, t)[0]
        start = (self.rate_parameters, self.plan.initial_state, self.start)
        if self.library is not None:
            recording: Recording = self.stepping.again().record(span)
        else:
            from symrot.propagation.steppers import fallback

            recording = fallback.record(self.rates, *start, span, self.tolerance, **self.scipy_options)
        recording.epoch = self.epoch
        return recording

    def deviations(self, parameters: Sequence[float]) -> "Deviations | None":
        """Return what steps in Python are held to, for parameters of the rates; derived when first asked for."""
        if self._deviations is None:
            return None
        names = [name for name, _ in self.kernel.rate_parameters]
        return self._deviations(dict(zip(names, parameters, strict=True)))

    @cached_property
    def _deviations(self) -> "Callable[[Mapping[str, float]], Deviations] | None":
        return self.first._deviations if self.first else formula_deviations(self.plan, self.kernel)

    @property
    def scipy_options(self) -> dict[str, Any]:
        """How the fallback judges errors, and by which of SciPy's methods it steps."""
        return self.scipy_options_for(self.rate_parameters)

    def scipy_options_for(self, parameters: Sequence[float]) -> dict[str, Any]:
        """Return the options of the fallback for parameters of the rates."""
        blocks, scales = error_blocks(self.plan)
        solver = self.choice.method.partition(":")[2]
        named = {"method": solver} if solver else {}
        limits = {"deviations": self.deviations(parameters), "clock": self._python_clock if self._on_clocks else None}
        return {"blocks": blocks, "scales": scales, **limits, **named}


class MotionInParts(Motion):
    """A motion that is smooth from one switch of its torques to the next."""

    switched = True

    def parts(self, end: float, broken: list[PropagationError]) -> tuple[list[Piece], Recording]:
        """Return the motion from its start to an end as polynomials and at any time; what cut it off in ``broken``."""
        raise NotImplementedError


def on_own_clock(plan: Plan, choice: Choice, tolerance: float) -> Motion:
    """Return the motion of a plan on a clock that shows 0 at its start; its rates may take another epoch each time.

    Where no time stands in the rates, there is but one clock.
    """
    motion: Motion = object.__new__(Motion)
    motion.plan, motion.choice, motion.tolerance, motion.library = plan, choice, tolerance, None
    motion.start = float(plan.scene.span.start)
    return _OnOwnClock(motion) if motion.kernel.rates.uses("t") else Motion(plan, choice, tolerance)


class _OnOwnClock(Motion):
    """A motion on a clock that shows 0 at its start, see :mod:`symrot.propagation.time_shift`."""

    movable, restarts = False, True

    def __init__(self, motion: Motion) -> None:
        self.choice, self.tolerance, self.library = motion.choice, motion.tolerance, motion.library
        self.epoch, self.start = motion.start, 0.0
        self.plan, self.kernel = epoch.moved(motion.plan, motion.kernel)
        if self.plan is motion.plan:  # no time stands in the rates
            return
        if self.choice.method == "taylor":
            self.library = taylor_library(self.plan, self.kernel, self.tolerance)
        elif self.choice.method == "dop853":
            self.library = epoch.compiled(self.plan, self.kernel)

    @cached_property
    def _rates_binding(self) -> Binding:
        if self.first:
            return self.first._rates_binding
        return Binding(self.kernel.rate_parameters, self.plan, known={EPOCH: Fraction(self.epoch)})

    @cached_property
    def rate_parameters(self) -> list[float]:
        try:
            return self._rates_binding(self.plan)
        except OverflowError:
            raise CutOff(self.epoch, NOT_FINITE_SENTENCE) from None

    def _moved(self) -> tuple[Plan, SceneKernel]:
        return self.plan, self.kernel


def _keep(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    return np.empty((len(times), 0)), Stats(0, 0, 0, 0.0)


def _stepped(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    return motion.stepping.once(times, rise)


def _exact_parts(motion: Motion, times: Floats, rise: bool) -> tuple[tuple[Floats, ...], Stats]:
    attitude, exact = motion.plan.structure.attitude, motion.exact
    began, start = perf_counter(), motion.start
    omega, quaternion = exact.evaluate(times - start if start else times, quaternion=attitude)
    assert omega is not None
    if not (rise and len(times) and times.item(0) > start):  # to the last bit, as every method has it
        at_start: Any
        if not rise:
            at_start = times == start
        elif len(times) > 1 and times.item(0) == start < times.item(1):
            at_start = 0
        else:
            at_start = slice(times.searchsorted(start, "left"), times.searchsorted(start, "right"))
        omega[at_start] = motion.plan.initial_state[:3]
        if quaternion is not None:
            quaternion[at_start] = motion.plan.initial_state[3:]
    return (omega,) if quaternion is None else (omega, quaternion), Stats(0, 0, 0, perf_counter() - began)


def _exact(motion: Motion, times: Floats, rise: bool = False) -> tuple[Floats, Stats]:
    parts, stats = _exact_parts(motion, times, rise)
    return np.concatenate(parts, axis=1), stats


def _scipy(motion: Motion, times: Floats, rise: bool) -> tuple[Floats, Stats]:
    from symrot.propagation.steppers import fallback

    start = (motion.rate_parameters, motion.plan.initial_state, motion.start)
    return fallback.integrate(motion.rates, *start, times, motion.tolerance, **motion.scipy_options)


STEPPED = ("taylor", "dop853", "scipy")
INTEGRATORS: dict[str, Callable[[Motion, Floats, bool], tuple[Floats, Stats]]] = {
    "constant": _keep,
    "exact": _exact,
    "taylor": _stepped,
    "dop853": _stepped,
    "scipy": _scipy,
}
