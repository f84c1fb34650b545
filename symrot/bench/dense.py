"""Dense output: 20 000 samples of one motion, against heyoka's, at the tolerance of each that gives the same error.

    python -m symrot.bench.dense [--samples 20000] [--rounds 15] [--motion NAME]

The motions are those of :mod:`symrot.bench.taylor`. symrot is called as a user calls it, ``propagator(t)``, which
returns angular velocity and attitude at every time; heyoka by ``propagate_grid``, and by ``propagate_until`` with
``c_output``, whose continuous output is then evaluated at all times at once; the faster one counts. Neither makes
arrays before the clock runs. Runs take turns; the median of the processor's time counts. The error is that of the
last sample, and the two samplings are held against each other at every time.

heyoka is no requirement: ``pip install heyoka``.
"""

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np

from symrot.bench.peers import heyoka_system
from symrot.bench.problem import Floats, Problem
from symrot.bench.race import Measured, race, seconds_of
from symrot.bench.taylor import MOTIONS, scene
from symrot.closed_form.choose import exact_form
from symrot.propagation.propagator import propagator

__all__ = ["main", "measure"]

TOLERANCE = 1e-12
PEERS = (1e-13, 2.0**-52)  # tolerances of heyoka, one of which comes nearest to the error of ours


def _heyoka(problem: Problem, tolerance: float, times: Floats) -> dict[str, Callable[[], Floats]]:
    """Return heyoka's ways to sample a motion; none where it is not installed."""
    try:
        import heyoka
    except ImportError:
        return {}
    system = heyoka_system(problem.kernel.rates, problem.parameters)
    integrator = heyoka.taylor_adaptive(system, list(problem.y0), tol=tolerance)

    def begin() -> Any:
        integrator.time = problem.start
        integrator.state[:] = problem.y0
        return integrator

    def grid() -> Floats:
        found: Floats = begin().propagate_grid(times)[5]
        return found

    def output() -> Floats:
        found: Floats = begin().propagate_until(float(times[-1]), c_output=True)[4](times)
        return found

    return {f"heyoka grid, {tolerance:.0e}": grid, f"heyoka c_output, {tolerance:.0e}": output}


def _symrot(problem: Problem, method: str, times: Floats) -> Callable[[], Floats]:
    found = propagator(problem.scene, method, TOLERANCE)

    def run() -> Floats:
        states: Floats = found(times).y.T
        return states

    return run


def measure(name: str, samples: int, rounds: int) -> list[tuple[Measured, float]]:
    """Return each contestant, with the largest difference of its samples from those of the closed form or the series.

    The first is held against itself: its difference is zero.
    """
    problem = Problem(scene(name))
    times = np.linspace(problem.start, problem.stop, samples)
    ours = ["exact"] * (exact_form(problem.scene) is not None) + ["taylor"]
    runs = {method: _symrot(problem, method, times) for method in ours}
    for tolerance in PEERS:
        runs |= _heyoka(problem, tolerance, times)
    states = {method: run() for method, run in runs.items()}
    width = len(problem.y0)
    judge = states["taylor"]
    entries, apart = [], []
    for method, run in runs.items():
        found = states[method]
        apart.append(float(abs(found[:, -width:] - judge[:, -width:]).max()) if found.shape[1] == width else np.nan)
        entries.append((Measured(method, TOLERANCE, 0, 0.0, seconds_of(run)), run))
    race(entries, rounds)
    return list(zip((measured for measured, _ in entries), apart, strict=True))


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.dense", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--samples", type=int, default=20_000)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--motion", choices=list(MOTIONS), help="one motion only")
    options = parser.parse_args(arguments)
    ratios = []
    for name in [options.motion] if options.motion else MOTIONS:
        rows = measure(name, options.samples, options.rounds)
        print(f"\n{name}, {options.samples} samples")
        for measured, apart in rows:
            each = measured.median / options.samples * 1e9
            print(f"  {measured.name:24}{measured.median * 1e3:9.3f} ms{each:8.1f} ns a sample   apart {apart:.1e}")
        ours = next(measured.median for measured, _ in rows if measured.name == "taylor")
        theirs = [measured.median for measured, _ in rows if measured.name.startswith("heyoka")]
        if theirs:
            ratios.append(min(theirs) / ours)
            print(f"  heyoka's fastest takes {ratios[-1]:.1f} times as long as symrot's series")
    if ratios:
        print(f"\nheyoka over symrot: median {np.median(ratios):.1f}, least {min(ratios):.1f}")


if __name__ == "__main__":
    main()
