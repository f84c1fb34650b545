"""Times of steppers at equal error: symrot, heyoka in each of its settings, and loops written by hand in C.

    python -m symrot.bench.taylor [--rounds 7] [--quick] [--orders] [--motion NAME]

The error of a run is the difference of its last state from a solution in 40 digits. For each decade (power of ten) of
the error, the table has the fastest run whose error is at most that power of ten.
"""

import argparse
import ctypes
import math
import tomllib
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symrot.bench.by_hand import text_by_hand
from symrot.bench.comparison.exact_path import DIGITS, ExactPath
from symrot.bench.comparison.peers import heyoka_integrator
from symrot.bench.comparison.problem import Problem
from symrot.bench.comparison.race import EndState, Measured, Task, raced
from symrot.build import cache
from symrot.build.sources import c_text
from symrot.propagation.binding import Binding, two_doubles
from symrot.propagation.compiled_models import error_blocks, invariant_source, library_source
from symrot.propagation.steppers import dop853, taylor
from symrot.scene.scene import Scene

__all__ = ["MOTIONS", "SteppedProblem", "best_of", "main", "measure", "reference", "scene"]

Floats = NDArray[np.float64]

GRAVITY = {"kind": "gravity", "weight": 1}
TILTED = {"axis": [1, 0, 0], "angle": "1/2"}
MOTIONS: dict[str, dict[str, Any]] = {
    "free asymmetric": {
        "body": {"principal": [1, 2, 3]}, "initial": {"omega": ["3/10", 1, "1/2"]}, "span": {"t": [0, 1000]},
    },
    "heavy symmetric": {
        "body": {"principal": [1, 1, "1/2"], "about": "fixed_point"},
        "initial": {"omega": ["3/10", "-9/5", 4], "attitude": TILTED},
        "torque": [{**GRAVITY, "center_of_mass": [0, 0, 1]}], "span": {"t": [0, 200]},
    },
    "heavy asymmetric": {
        "body": {"principal": [1, "3/2", "7/10"], "about": "fixed_point"},
        "initial": {"omega": ["1/2", "3/10", 4], "attitude": TILTED},
        "torque": [{**GRAVITY, "center_of_mass": ["1/10", "1/5", "9/10"]}], "span": {"t": [0, 200]},
    },
    "gravity gradient": {
        "body": {"principal": [4, 5, 3]}, "initial": {"omega": ["1/10", "-1/5", 3], "attitude": TILTED},
        "torque": [{"kind": "gravity_gradient", "mean_motion": 1}], "span": {"t": [0, 100]},
    },
    "damped and driven": {
        "body": {"principal": [1, "3/2", 2]}, "initial": {"omega": ["1/2", 1, "1/4"], "attitude": TILTED},
        "torque": [
            {"kind": "damping", "linear": "1/100"},
            {"kind": "expression", "torque": ["sin(3*t/2)/4", "cos(t)/5", "sin(t/2)/8"]},
        ], "span": {"t": [0, 200]},
    },
}  # fmt: skip
SETTINGS: dict[str, dict[str, bool]] = {
    "heyoka": {}, "heyoka fast": {"fast_math": True}, "heyoka accurate": {"high_accuracy": True},
    "heyoka compact": {"compact_mode": True},
}  # fmt: skip
OURS, BY_HAND = ("taylor", "dop853"), ("rk4", "dop853")
HAND_DECADES = (1e-3, 1e-4, 1e-5)  # errors at which methods of low order are at their best
DECADES = tuple(10.0**-k for k in range(3, 14))
ORDERS = (8, 10, 12, 14, 16, 18, 20, 22, 24, 28)
REFERENCES = Path(__file__).with_name("taylor.toml")


class SteppedProblem(Problem):
    """One motion over ``scale`` times its span, with the compiled steppers of symrot for it."""

    def __init__(self, name: str, scale: float) -> None:
        super().__init__(scene(name))
        self.stop *= scale
        self.blocks, self.scales = error_blocks(self.plan)

    def taylor_library(self, order: int | None = None, project: bool = True) -> Any:
        invariants = invariant_source(self.kernel, self.plan.states) if project else ""
        source = taylor.translation_unit(self.kernel.rates, self.blocks, self.scales, order, invariants)
        return cache.build(source, "taylor", taylor.FLAGS)

    @property
    def taylor_p(self) -> list[float]:
        return [*self.p, *Binding(self.kernel.quantity_parameters, self.plan, two_doubles)(self.plan)]

    def largest_error(self, state: Iterable[Any], exact: Floats) -> float:
        """Return the largest error of ``state`` against ``exact``; infinite if ``state`` is not finite."""
        computed, worst = np.array([float(value) for value in state]), 0.0
        if not np.isfinite(computed).all():
            return math.inf
        for low, high, scale in zip(self.blocks[:-1], self.blocks[1:], self.scales, strict=True):
            # Errors of angular velocities are relative to the exact abs(omega).
            size = scale or float(np.linalg.norm(exact[low:high]))
            worst = max(worst, float(abs(computed[low:high] - exact[low:high]).max()) / size)
        return worst


def scene(name: str) -> Scene:
    """Return the motion ``name`` of :data:`MOTIONS` as a scene."""
    form = {"schema": 1, "title": name, "output": {"quantities": ["omega", "quaternion"]}, **MOTIONS[name]}
    form["span"] = {**form["span"], "samples": 2}
    return Scene.from_dict(form, name)


def reference(name: str, scale: float = 1.0) -> Floats:
    """Return the last state of the motion ``name`` over ``scale`` times its span, computed in 40 digits.

    For ``scale`` 1 it is read from the file :data:`REFERENCES`.
    """
    stored = tomllib.loads(REFERENCES.read_text(encoding="utf-8")).get(name)
    return (
        np.array([float(value) for value in stored])
        if stored and scale == 1.0
        else np.array([float(value) for value in compute_reference(name, scale)])
    )


def compute_reference(name: str, scale: float = 1.0) -> list[Any]:
    """Return the last state of a motion over ``scale`` times its span, by Taylor series in 40 digits."""
    problem = SteppedProblem(name, scale)
    with mpmath.workdps(DIGITS):
        # from the rounded parameters that all contestants use
        return ExactPath(problem.plan, problem.kernel, (problem.p, problem.y0)).state(mpmath.mpf(problem.stop))


def references_text() -> str:
    """Return the TOML text of the file :data:`REFERENCES`, with all references computed again."""
    lines = [
        "# Final states of the motions of symrot.bench.taylor, in 40 digits and rounded to 25.",
        "# Printed by `python -m symrot.bench.taylor --reference`.",
    ]
    for name in MOTIONS:
        values = "".join(f'  "{mpmath.nstr(value, 25)}",\n' for value in compute_reference(name))
        lines.append(f'\n"{name}" = [\n{values}]')
    return "\n".join(lines) + "\n"


# ------------------------------------------------------------------------------------------------ contestants


def _stepper(
    follow: Callable[..., Any], path: Any, p: Sequence[float], problem: SteppedProblem, tolerance: float
) -> Callable[[], EndState]:
    """Return a function that runs a symrot stepper over a motion and returns its last state and number of steps."""
    # set up once, as in a propagator
    motion, times = follow(path, p, problem.y0, 0.0, tolerance), np.array([problem.stop])

    def task() -> EndState:
        states, stats = motion.sample_sorted(times, True)
        return states[0], stats.accepted

    return task


def _heyoka(problem: SteppedProblem, tolerance: float, settings: dict[str, bool]) -> Callable[[], EndState] | None:
    """Return a function that runs heyoka on the rates of ``problem``; None if heyoka is not installed."""
    run = heyoka_integrator(problem.kernel.rates, problem.parameters, problem.y0, tolerance, settings)
    return run and partial(run, problem.stop)


def _by_hand(library_: Any, method: str, problem: SteppedProblem, steps: int) -> Callable[[], EndState]:
    """Return a function that runs a handwritten C loop with a fixed number of steps; ``method`` is rk4 or dop853."""
    function = getattr(library_, f"symrot_{method}")
    real = ctypes.c_double
    function.argtypes, function.restype = (real, real, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p), None
    start, p = np.array(problem.y0), np.array(problem.p or [0.0])

    def task() -> EndState:
        state = start.copy()
        function(0.0, problem.stop, steps, state.ctypes.data, p.ctypes.data)
        return state, steps

    return task


def _loops(problem: SteppedProblem) -> list[Task]:
    """Return (name, number of steps, function) for each handwritten C loop and for several numbers of steps."""
    text = "\n".join(
        (
            problem.kernel.source,
            f"#define N {len(problem.y0)}",
            c_text("propagation/steppers/dop853_tableau.h"),
            text_by_hand("fixed_step.c"),
        )
    )
    loaded = ctypes.CDLL(str(cache.build(text, "by_hand")))
    turns = problem.stop * max(1.0, float(np.linalg.norm(problem.y0[: problem.blocks[1]])))
    return [
        (f"{method} by hand", float(steps), _by_hand(loaded, method, problem, steps))
        for method, per_turn in (("rk4", 2.0), ("dop853", 0.3))
        for steps in (int(turns * per_turn * 1.2**k) for k in range(18))
    ]


def _contestants(problem: SteppedProblem, settings: bool) -> list[Task]:
    tolerances = [10.0 ** (-k / 2) for k in range(2, 29)]  # two for each decade of the table
    orders = {e: taylor.order_for(e, problem.kernel.rates) for e in tolerances}
    ours = {order: problem.taylor_library(order) for order in set(orders.values())}
    hairer = cache.build(library_source(problem.plan, problem.kernel), "motion")
    p, q = problem.taylor_p, problem.p
    tasks: list[Task] = [
        ("taylor", e, _stepper(taylor.integration, ours[orders[e]], p, problem, e)) for e in tolerances
    ]
    tasks += [("dop853", e, _stepper(dop853.integration, hairer, q, problem, e)) for e in tolerances[:-4]]
    tasks += _loops(problem)
    for name, how in SETTINGS.items() if settings else list(SETTINGS.items())[:1]:
        for e in (*tolerances, 1e-15, 1e-16):
            task = _heyoka(problem, e, how)
            if task is None:
                return tasks
            tasks.append((name, e, task))
    return tasks


def measure(name: str, rounds: int = 9, settings: bool = False, scale: float = 1.0) -> list[Measured]:
    """Compute one motion over ``scale`` times its span with all steppers; return the steps, time and error of each run.

    With ``settings``, heyoka runs in all its settings; otherwise only in the default.
    """
    problem, exact = SteppedProblem(name, scale), reference(name, scale)
    return raced(_contestants(problem, settings), partial(problem.largest_error, exact=exact), rounds)


def best_of(runs: Iterable[Measured], error: float, names: Sequence[str]) -> Measured | None:
    """Return the fastest run of the steppers ``names`` whose error is at most ``error``; None if there is none."""
    good = [run for run in runs if run.name in names and run.error <= error]
    return min(good, key=lambda run: run.least, default=None)


# ------------------------------------------------------------------------------------------------ tables


def _print_table(name: str, runs: list[Measured]) -> dict[str, list[float]]:
    """Print the table of one motion; return a map from each other stepper to its times divided by symrot's.

    There is a ratio for each bound of the error in the table (1e-3, 1e-4, ..) that both steppers reach.
    """
    stop = MOTIONS[name]["span"]["t"][1]
    present = list(dict.fromkeys(run.name for run in runs))
    peers = [n for n in present if n.startswith("heyoka")]
    print(f"\n{name}, t = {stop} s")
    for contestant in present:
        own = [run for run in runs if run.name == contestant]
        best, longest = min(own, key=lambda run: run.error), max(own, key=lambda run: run.steps)
        pace = longest.least / longest.steps
        print(f"  {contestant:16}{pace * 1e9:6.0f} ns per step, least error {best.error:.1e} at {best.tolerance:.0e}")
    columns: list[tuple[str, list[str], tuple[str, ...], tuple[float, ...]]] = [
        ("dop853", ["dop853"], ("taylor",), DECADES),
        ("heyoka", ["heyoka"], ("taylor",), DECADES),
        ("best heyoka", peers, ("taylor",), DECADES),
        ("by hand", [f"{method} by hand" for method in BY_HAND], OURS, HAND_DECADES),
    ]
    columns = [column for column in columns if set(column[1]) & set(present)]
    print(f"{'  error <=':10}{'taylor ms':>12}" + "".join(f"{title:>14} ms{'ratio':>8}" for title, *_ in columns))
    ratios: dict[str, list[float]] = {title: [] for title, *_ in columns}
    for decade in DECADES:
        fastest = best_of(runs, decade, ["taylor"])
        line = f"{decade:10.0e}" + (f"{fastest.least * 1e3:12.3f}" if fastest else f"{'-':>12}")
        for title, names, against, decades in columns:
            ours, other = best_of(runs, decade, against), best_of(runs, decade, names)
            if ours is None or other is None or decade not in decades:
                line += f"{'-':>17}{'-':>8}"
                continue
            ratios[title].append(other.least / ours.least)
            line += f"{other.least * 1e3:17.3f}{ratios[title][-1]:8.2f}"
        print(line)
    _print_ratios("  ", ratios)
    return ratios


def _print_ratios(indent: str, ratios: dict[str, list[float]]) -> None:
    for title, values in ratios.items():
        if values:
            print(f"{indent}{title}: median ratio {np.median(values):.2f}, least {min(values):.2f}")


def _print_orders(name: str, rounds: int) -> None:
    """Print a table of times for a motion: a row for each bound of the error, a column for each order of the series.

    A time is that of the fastest run whose error is at most the bound (1e-3, 1e-4, ..).
    """
    problem, exact = SteppedProblem(name, 1.0), reference(name)
    paths = {f"{order}": problem.taylor_library(order) for order in ORDERS}
    tasks: list[Task] = [
        (order, 10.0**-k, _stepper(taylor.integration, path, problem.taylor_p, problem, 10.0**-k))
        for k in range(2, 15) for order, path in paths.items()
    ]  # fmt: skip
    runs = raced(tasks, partial(problem.largest_error, exact=exact), rounds)
    print(f"\n{name}: ms for an error, by order of the series")
    print(f"{'  error <=':10}" + "".join(f"{order:>10}" for order in paths))
    for decade in DECADES:
        fastest = [best_of(runs, decade, [order]) for order in paths]
        print(f"{decade:10.0e}" + "".join(f"{run.least * 1e3:10.3f}" if run else f"{'-':>10}" for run in fastest))


def main(arguments: list[str] | None = None) -> None:
    """Print, for each motion, the fastest steppers at each power of ten of the error."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.taylor", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--quick", action="store_true", help="run heyoka in its default setting only")
    parser.add_argument(
        "--orders",
        action="store_true",
        help="compare different orders of symrot's Taylor series with each other, not with heyoka",
    )
    parser.add_argument(
        "--reference", action="store_true", help="compute the reference states again and print them (takes minutes)"
    )
    parser.add_argument("--motion", choices=list(MOTIONS), help="one motion only")
    options = parser.parse_args(arguments)
    if options.reference:
        print(references_text(), end="")
        return
    every: dict[str, list[float]] = {}
    for name in [options.motion] if options.motion else MOTIONS:
        if options.orders:
            _print_orders(name, options.rounds)
            continue
        for title, values in _print_table(name, measure(name, options.rounds, not options.quick)).items():
            every.setdefault(title, []).extend(values)
    if every:
        print("\nall motions and decades")
        _print_ratios("  ", every)


if __name__ == "__main__":
    main()
