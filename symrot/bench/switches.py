"""Error, steps and time of motions with switched torques, compared with closed forms at tolerances 1e-6 to 1e-12.

    python -m symrot.bench.switches

Dry friction stops and releases a wheel; a relay makes a body oscillate; a thruster fires for 10 ms in each of 1000
seconds.
"""

import math
from collections.abc import Callable
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.propagate import propagator
from symrot.report.layout import columns, duration
from symrot.scene.scene import Scene

__all__ = ["main"]

Floats = NDArray[np.float64]
METHODS = ("taylor", "dop853")
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
MOMENT = 3.0  # kg m^2, about axis 3
ROUNDS = 3


class Problem(NamedTuple):
    """A test problem: torque about axis 3, N m, its parameters, end time, s, initial omega_3, rad/s, and solution."""

    torque: str
    parameters: dict[str, float]
    stop: float
    omega: float
    # returns omega_3, rad/s, at given times
    solution: Callable[[Floats], Floats]


def _friction(times: Floats) -> Floats:
    """Return omega_3, at ``times``, of a wheel that starts at rest under the torque 2 sin t - sign(omega_3)."""
    # Friction holds the wheel until t = pi/6; from then on it rotates until it stops.
    loose = math.asin(0.5)
    slip = np.maximum(times, loose)
    rise: Floats = (2.0 * (math.cos(loose) - np.cos(slip)) - (slip - loose)) / MOMENT
    return rise


def _relay(times: Floats) -> Floats:
    """Return omega_3, at ``times``, under the torque -sign(angle); its period is 12 s."""
    phase = np.mod(times, 4.0 * MOMENT)
    swing: Floats = np.where(phase < 2 * MOMENT, 1.0 - phase / MOMENT, -1.0 + (phase - 2 * MOMENT) / MOMENT)
    return swing


def _thruster(times: Floats) -> Floats:
    """Return omega_3, at ``times``, under a pulse of 10 ms at each full second."""
    whole = np.floor(times)
    burned: Floats = (0.01 * whole + np.minimum(times - whole, 0.01)) / MOMENT
    return burned


PROBLEMS = {
    "dry friction": Problem("2*sin(t) - sign(omega_3)", {}, 2.5, 0.0, _friction),
    "relay": Problem("-sign(2*atan2(q3, q0))", {}, 120.0, 1.0, _relay),
    "thruster": Problem("where(mod(t, 1) < d, 1, 0)", {"d": 0.01}, 1000.0, 0.0, _thruster),
}


def scene(problem: Problem) -> Scene:
    """Return the scene in which a problem's torque acts about axis 3."""
    torque = {"kind": "expression", "torque": ["0", "0", problem.torque], "parameters": problem.parameters}
    return Scene.from_dict({
        "schema": 1, "body": {"principal": [1, 2, MOMENT]}, "initial": {"omega": [0, 0, problem.omega]},
        "torque": [torque], "span": {"t": [0, problem.stop]}, "output": {"quantities": ["omega", "quaternion"]},
    })  # fmt: skip


def _measured(problem: Problem, method: str, tolerance: float) -> tuple[float, Any, float]:
    """Return error, in units of the tolerance, step statistics and least time, s, of a method on a test problem."""
    made = propagator(scene(problem), method, tolerance)
    times = np.linspace(0.0, problem.stop, 1001)
    least, motion = math.inf, made(times)
    for _ in range(ROUNDS):
        began = perf_counter()
        motion = made(times)
        least = min(least, perf_counter() - began)
    between = 0.5 * (times[1:] + times[:-1])
    # The largest difference, at the samples and midway, is divided by the largest value of the solution.
    size = max(float(np.abs(problem.solution(times)).max()), 1e-300)
    errors = [
        float(np.abs(motion.omega[:, 2] - problem.solution(times)).max()),
        float(np.abs(motion.sol(between)[2] - problem.solution(between)).max()),
    ]
    return max(errors) / size / tolerance, motion.stats, least


def main() -> None:
    """Print error, steps and time for each motion with a torque that jumps at times, such as dry friction."""
    rows = [("torque", "method", "tolerance", "error, tolerances", "steps", "switches", "time")]
    for name, problem in PROBLEMS.items():
        for method in METHODS:
            for tolerance in TOLERANCES:
                error, stats, seconds = _measured(problem, method, tolerance)
                counts = str(stats.accepted), str(stats.switches)
                rows.append((name, method, f"{tolerance:g}", f"{error:.2g}", *counts, duration(seconds)))
    print("\n".join(columns(rows, right=(2, 3, 4, 5, 6))))


if __name__ == "__main__":
    main()
