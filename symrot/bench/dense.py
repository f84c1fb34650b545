"""Times of dense output: 20 000 samples of one motion, by symrot and by heyoka, at equal error.

    python -m symrot.bench.dense [--samples 20000] [--rounds 15] [--motion NAME]

heyoka runs by ``propagate_grid`` and by ``propagate_until`` with ``c_output``. At each tolerance, the faster of the two
is compared with symrot's fastest Taylor series whose error is not larger. Errors are those of the last sample.
"""

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np

from symrot.bench.comparison.peers import heyoka_system
from symrot.bench.comparison.problem import Floats, Problem
from symrot.bench.comparison.race import Measured, raced
from symrot.bench.taylor import MOTIONS, SteppedProblem, reference
from symrot.closed_form.registry import exact_form
from symrot.propagation.propagate import propagator

__all__ = ["main", "measure"]

OURS = tuple(10.0**-k for k in range(4, 15))  # symrot's tolerances; the first gives errors as large as heyoka's largest
WHOLE = 7  # number of states of a motion with attitude: angular velocity and quaternion
PEERS = (1e-9, 1e-12, 2.0**-52)


def _heyoka(problem: Problem, tolerance: float, times: Floats) -> dict[str, Callable[[], Floats]]:
    """Return the functions with which heyoka can sample a motion at ``times``, each under its name.

    Empty if heyoka is not installed.
    """
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
        samples: Floats = begin().propagate_grid(times)[5]
        return samples

    def output() -> Floats:
        samples: Floats = begin().propagate_until(float(times[-1]), c_output=True)[4](times)
        return samples

    return {"heyoka grid": grid, "heyoka c_output": output}


def _symrot(problem: Problem, method: str, tolerance: float, times: Floats) -> Callable[[], Floats]:
    propagate = propagator(problem.scene, method, tolerance)

    def run() -> Floats:
        states: Floats = propagate(times).y.T
        return states

    return run


def measure(name: str, samples: int, rounds: int) -> list[Measured]:
    """Compute ``samples`` samples of the motion ``name`` by symrot and by heyoka, and return times and errors.

    The result has one entry for each method and tolerance, timed up to ``rounds`` times. The number of steps in an
    entry is 0, since steps are not counted.
    """
    problem, exact = SteppedProblem(name, 1.0), reference(name)
    times = np.linspace(problem.start, problem.stop, samples)
    runs = {("taylor", tolerance): _symrot(problem, "taylor", tolerance, times) for tolerance in OURS}
    for tolerance in PEERS:
        runs |= {(way, tolerance): run for way, run in _heyoka(problem, tolerance, times).items()}
    if exact_form(problem.scene) is not None and len(problem.y0) == WHOLE:
        runs["exact", 0.0] = _symrot(problem, "exact", OURS[-1], times)
    tasks = [(method, tolerance, lambda run=run: (run(), 0)) for (method, tolerance), run in runs.items()]
    return raced(tasks, lambda states: problem.largest_error(states[-1], exact), rounds)


def main(arguments: list[str] | None = None) -> None:
    """Print the times and errors of symrot and heyoka for many samples of a motion."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.dense", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--samples", type=int, default=20_000)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--motion", choices=list(MOTIONS), help="one motion only")
    options = parser.parse_args(arguments)
    ratios = []
    for name in [options.motion] if options.motion else MOTIONS:
        rows = measure(name, options.samples, options.rounds)
        print(f"\n{name}, {options.samples} samples")
        for measured in rows:
            each = measured.median / options.samples * 1e9
            label = f"{measured.name} at {measured.tolerance:.0e}" if measured.tolerance else measured.name
            print(f"  {label:24}{measured.median * 1e3:9.3f} ms{each:8.1f} ns a sample   error {measured.error:.1e}")
        ours = [measured for measured in rows if measured.name == "taylor"]
        for tolerance in PEERS:
            peers = [one for one in rows if one.name.startswith("heyoka") and one.tolerance == tolerance]
            peer = min(peers, key=lambda one: one.median, default=None)
            good = [one.median for one in ours if peer and one.error <= peer.error]
            if peer and good:
                ratios.append(peer.median / min(good))
                print(f"  {peer.name} at {tolerance:.0e} takes {ratios[-1]:.1f} times as long as the fastest "
                      f"series of symrot whose error is no larger, at most {peer.error:.0e}")  # fmt: skip
    if ratios:
        print(f"\nheyoka over symrot: median {np.median(ratios):.1f}, least {min(ratios):.1f}")


if __name__ == "__main__":
    main()
