"""A scene as what contestants follow: its plan and kernel, the state at the start, where it is judged, the error."""

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
from symrot.propagation.motion import Motion
from symrot.scene.scene import Scene

__all__ = ["PARTS", "Problem", "State"]

Floats = NDArray[np.float64]

PARTS = (0.382, 0.618, 0.854, 1.0)
"""Of the span, where a motion is judged: an unstable one passes through places where errors all but vanish."""
REST = 1e-3
"""Of the largest angular velocity where a motion is judged: slower bodies are measured as if they were so fast."""


class State(NamedTuple):
    """Where a body is: angular velocity (3,) in the body, rad/s; attitude (4,), or None if nobody asks."""

    omega: Floats
    quaternion: Floats | None


class Problem:
    """A scene with its kernel bound to numbers.

    ``plan`` may be another one than the scene's own, such as the most general.
    """

    def __init__(self, scene: Scene, plan: Plan | None = None) -> None:
        self.scene = scene
        self.plan = make_plan(scene) if plan is None else plan
        if not self.plan.states:
            raise InputError(f"{scene.name}: expected a scene with states to integrate; every state of it is constant")
        self.start, self.stop = float(scene.span.start), float(scene.span.stop)
        self.ends = (*(self.start + part * (self.stop - self.start) for part in PARTS[:-1]), self.stop)
        self.y0: list[float] = [float(value) for value in self.plan.initial_state]

    @cached_property
    def kernel(self) -> SceneKernel:
        """The derived kernels."""
        return scene_kernel(self.plan)

    @cached_property
    def p(self) -> list[float]:
        """The parameters of the rates, each rounded once."""
        return bind(self.kernel.rate_parameters, self.plan.constants)

    @cached_property
    def parameters(self) -> dict[str, float]:
        """The same by name."""
        return dict(zip((name for name, _ in self.kernel.rate_parameters), self.p, strict=True))

    @property
    def names(self) -> list[str]:
        """The quantities that a :class:`State` is made of."""
        attitude = [f"q{i} of t" for i in range(4)] if self.plan.structure.attitude else []
        return [*(f"omega_{i} of t" for i in (1, 2, 3)), *attitude]

    @cached_property
    def _motion(self) -> Motion:
        return Motion(self.plan, Choice("scipy", ""), 1e-12)

    def state(self, y: Sequence[Any] | Floats, t: float) -> State:
        """Return the state of the body for the states that were integrated, at a time."""
        values = np.array([[float(value) for value in y]])
        if not np.isfinite(values).all():
            return State(np.full(3, np.nan), None)
        found = self._motion.evaluate(np.array([t]), values, self.names)[0]
        return State(found[:3], found[3:] if len(found) > 3 else None)

    @staticmethod
    def error(found: State, exact: State, least: float = 0.0) -> float:
        """Return the larger of two errors: of the angular velocity, relative to its size; of the attitude, in rad.

        ``least``, rad/s, is what the error of a slower body is relative to: a body that a pulse has yet to set going
        moves at 1e-40 rad/s, of which no digit matters.
        """
        if not np.isfinite(found.omega).all():
            return math.inf
        size = max(float(np.linalg.norm(exact.omega)), least) or 1.0
        worst = float(np.linalg.norm(found.omega - exact.omega)) / size
        if found.quaternion is None or exact.quaternion is None:
            return worst
        q, r = found.quaternion / np.linalg.norm(found.quaternion), exact.quaternion
        chord = min(float(np.linalg.norm(q - r)), float(np.linalg.norm(q + r)))  # q and -q are one attitude
        return max(worst, 4.0 * math.asin(min(chord, math.sqrt(2.0)) / 2.0))

    @staticmethod
    def worst(found: Sequence[State], exact: Sequence[State]) -> float:
        """Return the largest of the errors at several times."""
        largest = max(float(np.linalg.norm(state.omega)) for state in exact)
        return max(Problem.error(one, other, REST * largest) for one, other in zip(found, exact, strict=True))
