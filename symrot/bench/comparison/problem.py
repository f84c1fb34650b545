"""A scene prepared for a comparison of methods: its plan, kernel, initial state, times and measure of errors."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.planning.plan import Plan, make_plan
from symrot.planning.scene_kernel import SceneKernel, bind
from symrot.propagation.compiled_models import scene_kernel
from symrot.propagation.method import Choice
from symrot.propagation.motions.make import make_motion
from symrot.propagation.motions.motion import Motion
from symrot.scene.scene import Scene

__all__ = ["PARTS", "Problem", "State"]

Floats = NDArray[np.float64]

PARTS = (0.382, 0.618, 0.854, 1.0)
"""Fractions of the span at which errors are measured; one time is not enough, since an error may pass through zero."""
REST = 1e-3
"""An error of omega is relative to |omega| at the same time. For a body nearly at rest, the divisor is instead REST
times the largest |omega| at the times for which states are compared."""


class State(NamedTuple):
    """The state of a body: angular velocity (3,), body axes, rad/s, and quaternion (4,), or None if not computed."""

    omega: Floats
    quaternion: Floats | None


class Problem:
    """A scene with its equations of motion as a kernel, and the values of their parameters, to compare methods."""

    def __init__(self, scene: Scene, plan: Plan | None = None) -> None:
        self.scene = scene
        # A reference uses the most general plan instead of the scene's own.
        self.plan = make_plan(scene) if plan is None else plan
        if not self.plan.states:
            raise InputError(f"{scene.name}: expected a scene with states to integrate; every state of it is constant")
        self.start, self.stop = float(scene.span.start), float(scene.span.stop)
        self.ends = (*(self.start + part * (self.stop - self.start) for part in PARTS[:-1]), self.stop)
        self.y0: list[float] = [float(value) for value in self.plan.initial_state]

    @cached_property
    def kernel(self) -> SceneKernel:
        """The derived functions of the scene: the rates dy/dt of the states, and the outputs such as omega."""
        return scene_kernel(self.plan)

    @cached_property
    def p(self) -> list[float]:
        """The parameters of the rates dy/dt, such as (C - B)/A, each rounded to double once."""
        return bind(self.kernel.rate_parameters, self.plan.constants)

    @cached_property
    def parameters(self) -> dict[str, float]:
        """The values of the parameters of the rates dy/dt, such as (C - B)/A, as a map from their names."""
        return dict(zip((name for name, _ in self.kernel.rate_parameters), self.p, strict=True))

    @property
    def names(self) -> list[str]:
        """The names of the quantities in a :class:`State`."""
        attitude = [f"q{i} of t" for i in range(4)] if self.plan.structure.attitude else []
        return [*(f"omega_{i} of t" for i in (1, 2, 3)), *attitude]

    @cached_property
    def _motion(self) -> Motion:
        return make_motion(self.plan, Choice("scipy", ""), 1e-12)

    def state(self, y: Sequence[Any] | Floats, t: float) -> State:
        """Return the state of the body (omega and quaternion) at time ``t`` from the integrated states ``y``.

        If ``y`` is not finite, omega is nan and the quaternion None.
        """
        values = np.array([[float(value) for value in y]])
        if not np.isfinite(values).all():
            return State(np.full(3, np.nan), None)
        quantities = self._motion.evaluate(np.array([t]), values, self.names)[0]
        return State(quantities[:3], quantities[3:] if len(quantities) > 3 else None)

    @staticmethod
    def error(state: State, exact: State, least: float = 0.0) -> float:
        """Return the relative error of omega or the attitude error in rad, whichever is larger; inf for a nan state.

        If the exact omega is shorter than ``least``, rad/s, the error of omega is relative to ``least``; it is absolute
        if both are zero.
        """
        if not np.isfinite(state.omega).all():
            return math.inf
        # A body nearly at rest before a pulse may rotate at 1e-40 rad/s, where relative errors are meaningless.
        size = max(float(np.linalg.norm(exact.omega)), least) or 1.0
        worst = float(np.linalg.norm(state.omega - exact.omega)) / size
        if state.quaternion is None or exact.quaternion is None:
            return worst
        q, r = state.quaternion / np.linalg.norm(state.quaternion), exact.quaternion
        chord = min(float(np.linalg.norm(q - r)), float(np.linalg.norm(q + r)))  # q and -q are one attitude
        return max(worst, 4.0 * math.asin(min(chord, math.sqrt(2.0)) / 2.0))

    @staticmethod
    def worst(states: Sequence[State], exact: Sequence[State]) -> float:
        """Return the largest error (:meth:`error`) of computed ``states`` against the reference states ``exact``."""
        largest = max(float(np.linalg.norm(state.omega)) for state in exact)
        return max(
            Problem.error(computed, expected, REST * largest) for computed, expected in zip(states, exact, strict=True)
        )
