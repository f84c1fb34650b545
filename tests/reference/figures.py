"""Common parts of the stress tests: measured figures with their bars, scenes written as data, and distances.

A bar is the limit that a figure has to meet.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from symrot.propagation.propagate import propagator
from symrot.scene.scene import Scene

Q0 = {"quaternion": ["1/10", "7/10", "-1/2", "1/2"]}
TILT = {"quaternion": ["63/65", "16/65", 0, 0]}  # half a radian about e1, nearly
GRAVITY = {"kind": "gravity", "weight": 1}


class Figure(NamedTuple):
    """One measured number: the method, what was measured, the bar, the value, and whether the value has to be above the
    bar.
    """

    method: str
    what: str
    bar: float
    reached: float
    at_least: bool = False
    judged: bool = True  # False: shown for the reader, no bar of the list

    @property
    def good(self) -> bool:
        """Return whether the bar is met; NaN meets no bar."""
        return bool(self.reached >= self.bar if self.at_least else self.reached <= self.bar)


class Stress(NamedTuple):
    """One stress test: its number, name and parameters, the function that runs it, and whether it takes about a second."""

    id: str
    name: str
    parameters: str
    run: Callable[[bool], list[Figure]]
    quick: bool = True


def body(moments: Any, omega: Any, torque: Any = (), attitude: Any = None) -> Scene:
    """Return a scene of a body in its principal axes; if a torque acts, it turns about a fixed point."""
    form = {
        "schema": 1, "title": "stress", "initial": {"omega": list(omega), "attitude": attitude or Q0},
        "body": {"principal": list(moments), **({"about": "fixed_point"} if torque else {})},
        "span": {"t": [0, 1], "samples": 2}, "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(form | ({"torque": list(torque)} if torque else {}), "stress")


def propagated(scene: Scene, method: str, tolerance: float, t: Any, **more: Any) -> Any:
    return propagator(scene, method, tolerance, **more)(t)


def largest(found: Any, expected: Any, sign: bool = False) -> float:
    """Return the largest difference; with ``sign``, of quaternions up to the sign of each."""
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    apart = np.abs(found - expected)
    if sign:
        apart = np.where(
            apart.max(axis=-1, keepdims=True) < np.abs(found + expected).max(axis=-1, keepdims=True),
            apart,
            np.abs(found + expected),
        )
    return float(apart.max()) if np.isfinite(apart).all() else float("nan")


def apart(found: Any, expected: Any) -> float:
    """Return the larger error of two trajectories: of attitude up to sign, or of omega relative to its size at the
    start.
    """
    size = float(np.linalg.norm(np.array([float(w) for w in found.scene.initial.omega_b])))
    return max(
        largest(found.quaternion, expected.quaternion, sign=True), largest(found.omega, expected.omega) / (size or 1.0)
    )
