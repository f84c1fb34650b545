"""Euler angles as state variables, for teaching: their singularity, and a change of Euler sequence that avoids it.

The states are omega_b and the angles q of a sequence such as ``"ZXZ"``, with ``dq/dt = B(q)^-1 omega_b``. Near gimbal
lock, where B is singular, steps shrink; with switching, the states change to the angles of another sequence
(:func:`partner`).
"""

import json
import math
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.build import cache as library
from symrot.conventions import parse_sequence
from symrot.dynamics.structure import Structure
from symrot.errors import InputError, PropagationError
from symrot.kinematics import conversions
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import KernelRecord, SceneKernel, bind
from symrot.propagation import time_shift
from symrot.propagation.compiled_models import (
    ATTITUDE_SCALE,
    RATE_SCALE,
    has_formulas,
    kernel_key,
    needs_bounds,
    scene_kernel,
)
from symrot.propagation.method import Choice
from symrot.propagation.motions.motion import Motion
from symrot.propagation.motions.setup import Setup
from symrot.propagation.propagator import Propagator
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.rounding import RoundingSum
from symrot.propagation.steppers.segments import split_at
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.propagation.steppers.stats import Stats
from symrot.propagation.steppers.stepping import Integration
from symrot.propagation.trajectory import Trajectory
from symrot.scene.scene import Scene

__all__ = ["SWITCH", "EulerMotion", "EulerPropagator", "angles_of", "partner", "regularity"]

Floats = NDArray[np.float64]

SWITCH = 0.3  # |det B| below which the sequence is changed; the partner then has sqrt(1 - 0.3^2) = 0.95 or more
METHODS = ("auto", "taylor", "dop853")
ROWS = 8  # steps between two checks of the regularity
NAMES = ("phi", "theta", "psi")


def partner(sequence: str) -> str:
    """Return the Euler sequence to use near gimbal lock of ``sequence``: ``"ZXY"`` for ``"ZXZ"``, and the reverse."""
    axes, intrinsic = parse_sequence(sequence)
    # Each sequence is singular where an entry of the attitude matrix is 1 or -1. The entries of the two sequences lie
    # in one row (extrinsic: column), so that |det B| >= sqrt(1/2) for one of them, and 1 where the other is singular.
    other = ({0, 1, 2} - {axes[1], axes[2]}).pop()
    return sequence[:2] + ("XYZ" if intrinsic else "xyz")[other]


def regularity(sequence: str, angles: ArrayLike) -> Floats:
    """Return ``|det B|``, shape (...), of the rate matrix B for angles, rad, shape (..., 3); it is 0 at gimbal lock.

    For ``"ZXZ"`` it is ``|sin(theta)|``.
    """
    axes, _ = parse_sequence(sequence)
    middle = np.asarray(angles, dtype=np.float64)[..., 1]
    determinant: Floats = np.abs(np.sin(middle) if axes[0] == axes[2] else np.cos(middle))
    return determinant


def angles_of(quaternion: Floats, sequence: str) -> Floats:
    """Return Euler angles, rad, shape (3,), whose quaternion equals the given quaternion including its sign."""
    angles: Floats = conversions.quaternion_to_euler(quaternion, sequence)[0]
    # A torque formula may contain odd powers of the quaternion. A full rotation about the first axis changes its sign
    # but not the attitude.
    if conversions.euler_to_quaternion(angles, sequence) @ quaternion < 0.0:
        angles[0] -= math.copysign(2.0 * math.pi, angles[0])
    return angles


class _Kernel(NamedTuple):
    """The compiled equations of motion in the angles of one Euler sequence, with their parameters."""

    library: Path
    parameters: list[float]
    # returns the same equations with the time counted from any epoch; None if they do not contain the time
    clock: dop853.Clock | None


class _Block(NamedTuple):
    """Interval of a motion with one Euler sequence: first and last time, s, and a function from times to states."""

    first: float
    last: float
    # takes n times, s, and returns omega and quaternion, shape (n, 7); constant components of omega may be left out
    states: Callable[[Floats], Floats]


@final
class EulerMotion(Motion):
    """Motion of a scene whose attitude is stepped as Euler angles of ``sequence``.

    With ``switching``, the angles of another sequence are used near gimbal lock.
    """

    def __init__(self, plan: Plan, method: str, tolerance: float, sequence: str, switching: bool) -> None:
        structure = plan.structure if plan.structure.planar is None else plan.structure.unreduced()
        plan = replace(plan, structure=replace(structure, attitude=True))
        for name in NAMES:
            if name in plan.constants:
                raise InputError(f"state: expected a scene without a constant {name!r}, which is the name of an angle")
        if method == "auto":
            method = "dop853" if non_smooth_torque(plan) else "taylor"
        other = f", {partner(sequence)} near its gimbal lock" if switching else ", without switching"
        choice = Choice(method, f"the state is the Euler angles {sequence}{other}")
        # all times are scene times: they stay the same when the Euler sequence changes
        start = float(plan.scene.span.start)
        super().__init__(Setup(plan, choice, tolerance, start, lambda: scene_kernel(plan)), plan)
        self.sequence, self.switching = sequence, switching
        self._kernels: dict[str, _Kernel] = {}
        self._count = [0, 0, 0, 0]  # steps accepted and rejected, evaluations, changes of sequence
        self._sums: list[RoundingSum] = []  # one for each side of the start
        for each in (sequence, partner(sequence)) if switching else (sequence,):
            self._kernel_of(each)

    @cached_property
    def _moving(self) -> int:
        return sum(name.startswith("omega") for name in self.plan.states)

    def _kernel_of(self, sequence: str) -> _Kernel:
        if sequence not in self._kernels:
            structure = replace(self.plan.structure, sequence=sequence)
            key = f"angles {kernel_key(replace(self.plan, structure=structure))}"
            saved = library.fetch(key)
            if saved is None:
                saved = json.dumps(_derived(structure))
                library.store(key, saved)
            kernel = SceneKernel(json.loads(saved))
            parameters = bind(kernel.rate_parameters, self.plan.constants)
            self._kernels[sequence] = _Kernel(self._library_of(self.plan, kernel), parameters, self._clock_of(kernel))
        return self._kernels[sequence]

    def _library_of(self, plan: Plan, kernel: SceneKernel) -> Path:
        count = self._moving
        edges, scales = [0, *([count] if count else []), count + 3], [RATE_SCALE] * (count > 0) + [ATTITUDE_SCALE]
        if self.choice.method == "taylor":
            order = taylor.order_for(self.tolerance, kernel.rates)
            text = taylor.translation_unit(kernel.rates, edges, scales, order, enclosed=needs_bounds(plan))
        else:
            sizes = count + 3, len(kernel.rate_parameters)
            bounds = dop853.NO_ENCLOSURE
            if has_formulas(plan):
                from symrot.codegen.enclosure.source import enclosure_source, rounding_source

                bounds = enclosure_source(kernel.rates, dop853.DENSE_ORDER, edges) + rounding_source(kernel.rates)
            text = dop853.translation_unit(kernel.source, "symrot_rates", *sizes, edges, scales, bounds)
        return library.build(text, "angles")

    def _clock_of(self, kernel: SceneKernel) -> dop853.Clock | None:
        if not kernel.rates.uses("t"):
            return None

        def moving() -> tuple[Plan, SceneKernel]:
            from symrot.codegen.taylor.time_shift import from_epoch

            return self.plan, from_epoch(kernel)

        return time_shift.clock(moving, self.plan.constants, make=self._library_of)

    def _integration(self, sequence: str, t: float, state: Floats) -> Integration:
        kernel = self._kernel_of(sequence)
        start = kernel.library, kernel.parameters, state, t, self.tolerance
        return (
            taylor.integration(*start)
            if self.choice.method == "taylor"
            else dop853.integration(*start, clock=kernel.clock)
        )

    def _blocks(self, end: float) -> Iterator[_Block]:
        """Compute the motion from its start to ``end``, s, and yield intervals that each use one Euler sequence."""
        count, t, sequence = self._moving, self.start, self.sequence
        whole = np.array(self.plan.initial_state)
        rounding = RoundingSum(self.tolerance)
        self._sums.append(rounding)
        while t != end:
            angles = angles_of(whole[count:], sequence)
            if self.switching and regularity(sequence, angles) < SWITCH:
                sequence = partner(sequence)
                # the fourth count: changes of the sequence
                self._count[3] += 1
                angles = angles_of(whole[count:], sequence)
            integration = self._integration(sequence, t, np.concatenate([whole[:count], angles]))
            integration.rounding = rounding
            for first, last, rows in self._steps(integration, sequence, end):
                block = _Block(first, last, self._states_of(integration, sequence, rows))
                yield block
                t = last
            if t != end:
                whole = block.states(np.array([t]))[0]

    def _steps(self, integration: Integration, sequence: str, end: float) -> Iterator[tuple[float, float, Floats]]:
        """Yield the motion up to ``end``, s, in groups of steps: (first time, last time, recorded steps).

        If the motion may change its Euler sequence, the last group ends with the first step that ends near gimbal lock.
        """
        count, broken = self._moving, None
        try:
            with closing(integration.runs(end)) as runs:
                run = next(runs)
                run.pace = abs(end - self.start) * integration.pace  # the whole motion shares one limit of steps
                while run.t != run.stop:
                    first, rows = run.t, np.empty((ROWS, integration.stepper.row))
                    try:
                        integration.advance(run, None, 0, None, rows.ctypes.data, ROWS)
                    except PropagationError as error:
                        broken = error
                    rows = rows[: run.recorded]
                    ends = np.append(rows[1:, 0], run.t) if len(rows) else np.empty(0)
                    if self.switching and len(rows):
                        near = regularity(sequence, integration.stepper.dense(rows, ends)[:, count:]) < SWITCH
                        if near.any():
                            place = int(np.argmax(near))
                            yield first, float(ends[place]), rows[: place + 1]
                            # the caller continues with another Euler sequence
                            return
                    if broken is not None:
                        raise self._with_hint(broken, sequence)
                    yield first, float(run.t), rows
        finally:
            self._count[:3] = (a + b for a, b in zip(self._count, integration.stats()[:3], strict=False))

    def _with_hint(self, error: PropagationError, sequence: str) -> PropagationError:
        hint = f"the state consists of the Euler angles {sequence}, which are singular at gimbal lock"
        return PropagationError(f"{error} ({hint}{'' if self.switching else '; switching=True avoids it'})")

    def _states_of(self, integration: Integration, sequence: str, rows: Floats) -> Callable[[Floats], Floats]:
        count = self._moving

        def states(times: Floats) -> Floats:
            stepped = integration.stepper.dense(rows, times)
            quaternion = conversions.euler_to_quaternion(stepped[:, count:], sequence)
            return np.hstack([stepped[:, :count], quaternion])

        return states

    def follow(self, times: Floats, in_order: bool = False) -> tuple[Floats, Stats]:
        """Return the N states at n ``times``, s, shape (n, N), and the cost (steps, evaluations, seconds)."""
        began = perf_counter()
        self._count, self._sums = [0, 0, 0, 0], []
        states = np.empty((len(times), len(self.plan.states)))
        states[times == self.start] = self.plan.initial_state
        # sorts the times, so that in_order is not used
        for part in split_at(times, self.start):
            distances = np.abs(times[part] - self.start)
            for block in self._blocks(float(times[part[-1]])):
                low, high = abs(block.first - self.start), abs(block.last - self.start)
                inside = part[np.searchsorted(distances, low, "right") : np.searchsorted(distances, high, "right")]
                if len(inside):
                    states[inside] = block.states(times[inside])
        accepted, rejected, evaluations, switches = self._count
        rounded = tuple([each.beyond for each in self._sums if each.beyond is not None])
        seconds = perf_counter() - began
        return states, Stats(accepted, rejected, evaluations, seconds, switches, rounded_beyond=rounded)

    def dense(self, span: tuple[float, float]) -> Callable[[Floats], Floats]:
        """Return a function from n times within ``span`` (in s) to the N states at each of them, shape (n, N)."""
        sides = [list(self._blocks(end)) if end != self.start else [] for end in span]

        def at(times: Floats) -> Floats:
            states = np.empty((len(times), len(self.plan.states)))
            states[times == self.start] = self.plan.initial_state
            for blocks in sides:
                for block in blocks:
                    low, high = min(block.first, block.last), max(block.first, block.last)
                    chosen = (times >= low) & (times <= high) & (times != self.start)
                    if chosen.any():
                        states[chosen] = block.states(times[chosen])
            return states

        return at


def _derived(structure: Structure) -> KernelRecord:
    """Return the equations of motion in the Euler angles of ``structure.sequence`` as a record for the cache."""
    from symrot.codegen.scene_kernels import RATES, rates_program, rates_source
    from symrot.dynamics.equations import equations_of_motion

    rates = rates_program(equations_of_motion(structure), RATES)
    return SceneKernel.of(rates.program, rates.parameters, rates.program, (), (), rates_source(rates)).record


class EulerPropagator(Propagator):
    """Propagator of a scene whose states are Euler angles; :func:`symrot.propagator` with ``state`` returns it."""

    def __init__(self, scene: Scene, method: str, tolerance: float, sequence: str, switching: bool) -> None:
        try:
            parse_sequence(sequence)
        except InputError as error:
            raise InputError(f"state: expected 'quaternion' or an Euler sequence; {error}") from None
        if method not in METHODS:
            raise InputError(f"method: expected one of {', '.join(METHODS)} for Euler angles as state, got {method!r}")
        self._sequence, self._switching = sequence, switching
        super().__init__(scene, method, tolerance)

    def _prepare(self, plan: Plan) -> Motion:
        return EulerMotion(plan, self._method, self.tolerance, self._sequence, self._switching)

    def __call__(self, t: ArrayLike | None = None, *, events: Any = None, **state: Any) -> Trajectory:
        """Return the motion at the times t, s; ``state`` holds other arguments of :class:`Propagator`, such as omega.

        Raise InputError for events, which are not supported with Euler angles as state.
        """
        if events is not None:
            raise InputError("events: expected state='quaternion'; events are not located with Euler angles as state")
        return super().__call__(t, **state)
