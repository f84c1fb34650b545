"""Comparison over many revolutions of a free asymmetric body: steppers against its exact motion and heyoka.

    python -m symrot.bench.long [--revolutions 1e6] [--states 4]

The Taylor stepper runs with and without projection onto the conserved quantities. The table has the relative error of
the kinetic energy and the attitude error in rad at the end, as medians over initial states.
"""

import argparse
import math
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.bench.comparison.peers import heyoka_integrator
from symrot.build import cache
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import bind
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import error_blocks, invariant_source, scene_kernel
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import taylor
from symrot.scene.scene import Scene

__all__ = ["STATES", "main", "measure"]

Floats = NDArray[np.float64]

MOMENTS = (2, 3, 4)
STATES = (("3/8", 1, "1/2"), (1, "1/4", "1/8"), ("1/4", "3/8", 1), ("5/8", "3/4", "-1/2"))  # rad/s, exact in doubles


def _scene(omega: Sequence[Any]) -> Scene:
    return Scene.from_dict(
        {
            "schema": 1,
            "title": "free asymmetric body",
            "body": {"principal": list(MOMENTS)},
            "initial": {"omega": list(omega)},
            "span": {"t": [0, 1], "samples": 2},
            "output": {"quantities": ["omega", "quaternion"]},
        },
        "long",
    )


def measure(omega: Sequence[Any], revolutions: float) -> dict[str, tuple[float, float, float, int]]:
    """Return, for each contestant, relative error of the energy, attitude error in rad, seconds and steps."""
    scene = _scene(omega)
    plan = make_plan(scene)
    kernel = scene_kernel(plan)
    source = taylor.translation_unit(kernel.rates, *error_blocks(plan), 20, invariant_source(kernel, plan.states))
    path, p = cache.build(source, "taylor", taylor.FLAGS), bind(kernel.rate_parameters, plan.constants)
    start = np.array([float(value) for value in plan.initial_state])
    stop = revolutions * 2.0 * math.pi / float(np.linalg.norm(start[:3]))
    exact = propagator(scene, method="exact")([stop])

    def stepped(project: bool) -> tuple[Floats, int]:
        parameters = [*p, *Binding(kernel.quantity_parameters, plan, two_doubles)(plan)]
        states, stats = taylor.integration(path, parameters, start, 0.0, 1e-15, project=project).sample([stop])
        return states[0], stats.accepted

    contestants: dict[str, Callable[[], tuple[Floats, int]]] = {
        "taylor, projected": lambda: stepped(True),
        "taylor, plain": lambda: stepped(False),
    }
    parameters = dict(zip((name for name, _ in kernel.rate_parameters), p, strict=True))
    peer = heyoka_integrator(kernel.rates, parameters, [float(value) for value in start], 2.0**-52, {})
    if peer is not None:
        contestants["heyoka, tol = eps"] = lambda: peer(stop)
    results = {}
    for name, run in contestants.items():
        began = perf_counter()
        state, steps = run()
        seconds = perf_counter() - began
        energies = [float(np.dot(MOMENTS, np.square(each[:3]))) for each in (state, start)]
        q, r = state[3:] / np.linalg.norm(state[3:]), exact.quaternion[0]
        attitude = 4.0 * math.asin(min(float(np.linalg.norm(q - r)), float(np.linalg.norm(q + r))) / 2.0)
        results[name] = (abs(energies[0] / energies[1] - 1.0), attitude, seconds, steps)
    return results


def main(arguments: list[str] | None = None) -> None:
    """Print the errors of each stepper after many revolutions of a free body."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.long", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--revolutions", type=float, default=1e6)
    parser.add_argument("--states", type=int, default=len(STATES), help="number of initial states")
    options = parser.parse_args(arguments)
    runs = [measure(omega, options.revolutions) for omega in STATES[: options.states]]
    print(f"free body, moments {MOMENTS}, {options.revolutions:.0e} revolutions, {len(runs)} initial states: medians")
    print(f"{'':20}{'energy':>10}{'attitude rad':>14}{'seconds':>10}{'ns/step':>10}")
    for name in runs[0]:
        rows = [(*run[name][:3], run[name][2] / run[name][3] * 1e9) for run in runs]
        energy, attitude, seconds, pace = np.median(rows, axis=0)
        print(f"{name:20}{energy:10.1e}{attitude:14.1e}{seconds:10.2f}{pace:10.0f}")


if __name__ == "__main__":
    main()
