"""Times and errors of the derivatives of a motion with respect to initial values and constants: symrot and heyoka.

    python -m symrot.bench.comparison.sensitivities [--rounds 7] [--settings default fast compact] [--motion NAME ..]

Both programs integrate the motion together with its derivatives (variational equations). The derivatives are compared
with difference quotients of two motions in 40 digits. The error is the largest difference, relative to the largest
derivative with respect to the same variable.
"""

import argparse
import json
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import mpmath
import numpy as np
from numpy.typing import NDArray

from symrot.bench.comparison.exact_path import DIGITS, ORDER, TAIL, ExactPath
from symrot.bench.comparison.peers import FUNCTIONS, heyoka_system
from symrot.bench.comparison.problem import Problem
from symrot.bench.comparison.race import Measured, raced
from symrot.bench.taylor import scene as motion_scene
from symrot.build import cache
from symrot.formula.tree import evaluate
from symrot.planning.general_structure import general_structure
from symrot.planning.plan import Plan
from symrot.propagation.propagate import propagator
from symrot.report.layout import columns
from symrot.scene.scene import Scene

__all__ = ["CASES", "Case", "main", "measure", "reference"]

Floats = NDArray[np.float64]


class Case(NamedTuple):
    """A motion of :data:`symrot.bench.taylor.MOTIONS`, its duration, s, and the variables of its derivatives.

    The last state of the motion is differentiated with respect to these variables.
    """

    motion: str
    duration: int
    variables: tuple[str, ...]


CASES = (
    Case("free asymmetric", 100, ("omega_1", "omega_2", "omega_3")),
    Case("heavy symmetric", 20, ("omega_1", "omega_2", "omega_3", "weight")),
    Case("heavy asymmetric", 20, ("omega_1", "omega_2", "omega_3", "weight")),
    Case("gravity gradient", 20, ("omega_1", "omega_2", "omega_3")),
)
SETTINGS: dict[str, dict[str, bool]] = {"default": {}, "fast": {"fast_math": True}, "compact": {"compact_mode": True}}
STEP = Fraction(1, 1 << 30)
STATES = 7


def reference(case: Case, variable: str) -> Floats:
    """Return the derivatives of the seven states with respect to ``variable`` at the last time.

    They are central difference quotients of two motions, with a smaller and a larger value of the variable, in 40
    digits.
    """
    scene = motion_scene(case.motion)
    value = Fraction(scene.value(variable))
    key = f"derivatives {DIGITS} {ORDER} {TAIL} {STEP} {variable} {case.duration}\n{scene.to_toml()}"
    # The motions take about half a minute, so the cache of kernels stores the derivatives.
    stored = cache.fetch(key)
    if stored is not None:
        return np.array(json.loads(stored))
    ends = []
    with mpmath.workdps(DIGITS):
        for sign in (-1, 1):
            other = scene.with_({variable: value + sign * STEP})
            problem = Problem(other, Plan(other, general_structure(other), ()))
            ends.append(ExactPath(problem.plan, problem.kernel).state(mpmath.mpf(case.duration)))
        step = mpmath.mpf(STEP.numerator) / STEP.denominator
        slopes = [float((high - low) / (2 * step)) for low, high in zip(*ends, strict=True)]
    cache.store(key, json.dumps(slopes))
    return np.array(slopes)


def _heyoka(case: Case, scene: Scene, settings: dict[str, bool]) -> Callable[[], Floats]:
    """Return a function that runs heyoka and returns the derivatives of the seven states at the last time.

    Their shape is (7, number of variables).
    """
    import heyoka

    problem = Problem(scene, Plan(scene, general_structure(scene), ()))
    constants: dict[str, Any] = {name: float(value) for name, value in problem.plan.constants.items()}
    names = [name for name in case.variables if not name.startswith("omega")]
    constants |= {name: heyoka.par[k] for k, name in enumerate(names)}
    functions = {name: getattr(heyoka, name) for name in FUNCTIONS}
    parameters = {name: evaluate(node, constants, functions, float) for name, node in problem.kernel.rate_parameters}
    system = heyoka_system(problem.kernel.rates, parameters)
    variables = {str(variable): variable for variable, _ in system}
    by = [variables[name] if name in variables else constants[name] for name in case.variables]
    equations = heyoka.var_ode_sys(system, args=by, order=1)
    integrator = heyoka.taylor_adaptive(
        equations, problem.y0, pars=[float(scene.value(name)) for name in names], **settings
    )
    start = integrator.state.copy()

    def run() -> Floats:
        integrator.time, integrator.state[:] = 0.0, start
        integrator.propagate_until(float(case.duration))
        return np.array(integrator.state[STATES:]).reshape(STATES, len(case.variables))

    return run


def _symrot(case: Case, scene: Scene) -> Callable[[], Floats]:
    """Return a function that runs symrot and returns the derivatives of the seven states at the last time.

    Their shape is (7, number of variables).
    """
    own = propagator(scene, sensitivities=case.variables)
    times, omega = np.array([float(case.duration)]), [float(rate) for rate in scene.initial.omega_b]

    def run() -> Floats:
        derivatives = own(times, omega=omega).sensitivities
        assert derivatives is not None
        return np.concatenate([derivatives.omega[-1], derivatives.quaternion[-1]])

    return run


def _error(computed: Floats, exact: Floats) -> float:
    """Return the largest difference of ``computed`` from ``exact``, each relative to the largest number in its column.

    Both arrays have a row for each state and a column for each variable of the derivatives.
    """
    return float((np.abs(computed - exact).max(axis=0) / np.abs(exact).max(axis=0)).max())


def measure(case: Case, rounds: int, settings: Sequence[str]) -> list[Measured]:
    """Return the measured runs of one case: the run of symrot, then one run of heyoka for each of the ``settings``."""
    scene = motion_scene(case.motion)
    exact = np.stack([reference(case, variable) for variable in case.variables], axis=1)
    runs = {"symrot": _symrot(case, scene)}
    runs |= {f"heyoka {name}": _heyoka(case, scene, SETTINGS[name]) for name in settings}
    tasks = [(name, 0.0, lambda run=run: (run(), 0)) for name, run in runs.items()]
    return raced(tasks, lambda slopes: _error(slopes, exact), rounds)


def main() -> None:
    """Print time and error of symrot and of heyoka in each setting, and the ratios of their times to symrot's."""
    parser = argparse.ArgumentParser(description="derivatives of motions: symrot and heyoka")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--settings", nargs="*", default=list(SETTINGS), choices=list(SETTINGS))
    motions = [case.motion for case in CASES]
    parser.add_argument("--motion", nargs="*", default=motions, choices=motions)
    options = parser.parse_args()
    rows = [("motion", "program", "us", "error", "time over symrot's")]
    for case in CASES:
        if case.motion not in options.motion:
            continue
        own, *others = measure(case, options.rounds, options.settings)
        for entry in (own, *others):
            ratio = entry.median / own.median
            rows.append((case.motion, entry.name, f"{entry.median * 1e6:.0f}", f"{entry.error:.1e}", f"{ratio:.2f}"))
    print("\n".join(columns(rows)))


if __name__ == "__main__":
    main()
