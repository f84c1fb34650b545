"""Times of symrot's ensembles in SIMD vectors and of heyoka's batch and ensemble modes, at equal error on one core.

    python -m symrot.bench.ensemble [--rounds 9] [--orders] [--motion NAME] [--many 4096]

The error is the largest deviation of the first 16 trajectories from a reference, heyoka in long double. One trajectory
of the reference is checked against a solution with 40 digits.
``--orders`` compares orders of symrot's series instead.
"""

import argparse
from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from symrot.bench.comparison.peers import heyoka_system
from symrot.bench.comparison.race import EndState, Measured, Task, raced
from symrot.bench.taylor import DECADES, MOTIONS, Floats, SteppedProblem, best_of, reference
from symrot.build import cache
from symrot.ensemble import lanes

__all__ = ["main", "measure"]

SPREAD = 0.1  # relative spread of the initial states about the initial state of the motion
SHORTER = 20  # factor by which the span of the large ensemble is shorter
COMPARED = 16  # number of trajectories that are compared with the reference
TIGHTEST = 1e-19  # tolerance of the reference in long double
ORDERS = (8, 10, 12, 14, 16, 18, 20)
WIDTHS = (4, 8)
ENSEMBLE_TOLERANCES = (1e-6, 1e-12)  # only two, because heyoka's ensemble copies the integrator for each trajectory


class Start(NamedTuple):
    """An ensemble to be timed: motion, initial states (n, N), end time, s, and reference end states of the first 16."""

    problem: Any
    y: Floats
    stop: float
    exact: Floats

    def error(self, states: Floats) -> float:
        """Return the largest deviation of computed end states from the reference end states ``exact``.

        Row k of ``states`` is the state of trajectory k at the end time. Only the first 16 trajectories have a
        reference end state; the others do not count.
        """
        pairs = zip(states[: len(self.exact)], self.exact, strict=True)
        return float(max(self.problem.largest_error(computed, exact) for computed, exact in pairs))


def prepare(n: int, stop: float, problem: Any) -> Start:
    """Return an ensemble of ``n`` initial states: first that of the motion ``problem``, then random states near it."""
    random = np.random.default_rng(1)
    y = np.tile(np.array(problem.y0), (n, 1))
    rates = problem.blocks[1]
    y[1:, :rates] *= 1 + SPREAD * random.standard_normal((n - 1, rates))
    y[1:, rates:] += SPREAD * random.standard_normal((n - 1, y.shape[1] - rates))
    y[1:, rates:] /= np.sqrt((y[1:, rates:] ** 2).sum(axis=1, keepdims=True))
    return Start(problem, y, stop, _references(problem, y[:COMPARED], stop))


def _references(problem: Any, y: Floats, stop: float) -> Floats:
    """Return the end states at time ``stop`` from the initial states ``y``, computed by heyoka in long double."""
    import heyoka

    real = np.longdouble
    system = heyoka_system(problem.kernel.rates, {name: real(x) for name, x in problem.parameters.items()}, real)
    integrator = heyoka.taylor_adaptive(system, y[0].astype(real), tol=real(TIGHTEST), fp_type=real)
    states = np.empty_like(y)
    for row, start in zip(states, y, strict=True):
        integrator.time = real(0)
        integrator.state[:] = start.astype(real)
        integrator.propagate_until(real(stop))
        row[:] = integrator.state.astype(float)
    return states


# ------------------------------------------------------------------------------------------------ contestants


def _library(problem: Any, order: int) -> Any:
    source = lanes.translation_unit(problem.kernel.rates, problem.blocks, problem.scales, order)
    return cache.build(source, "lanes", lanes.FLAGS)


def _lanes(task: lanes.LaneIntegration) -> EndState:
    result = task.run()
    return result.states[:, 0], int(result.steps.sum())


def _ours(start: Start, tolerances: Sequence[float], orders: Iterable[int] = ()) -> list[Task]:
    p = np.tile(np.array(start.problem.p), (len(start.y), 1))
    tasks: list[Task] = []
    for order in sorted(set(orders)) or [0]:
        for tolerance in tolerances:
            path = _library(start.problem, order or lanes.order_for(tolerance))
            task = lanes.LaneIntegration(path, p, start.y, 0.0, np.array([start.stop]), tolerance)
            tasks.append((f"{order}" if order else "lanes", tolerance, partial(_lanes, task)))
    return tasks


def _batches(integrator: Any, width: int, start: Start) -> EndState:
    """Integrate an ensemble by heyoka's integrator for batches of ``width`` trajectories.

    Return the states at the end, (n, N), and the number of steps of all trajectories together.
    """
    states, steps = np.empty_like(start.y), 0
    for first in range(0, len(start.y), width):
        integrator.set_time(0.0)
        integrator.state[:] = start.y[first : first + width].T
        integrator.propagate_until(start.stop)
        states[first : first + width] = integrator.state.T
        steps += sum(result[3] for result in integrator.propagate_res)
    return states, steps


def _ensemble(propagate: Any, integrator: Any, width: int, start: Start) -> EndState:
    """Integrate an ensemble by heyoka's function ``propagate`` for ensembles, in one thread.

    Return the states at the end, (n, N), and the number of steps of all trajectories together. The ``integrator``
    computes ``width`` trajectories at once.
    """

    def begin(integrator: Any, i: int) -> Any:
        if width == 1:
            integrator.time = 0.0
            integrator.state[:] = start.y[i]
        else:
            integrator.set_time(0.0)
            integrator.state[:] = start.y[i * width : (i + 1) * width].T
        return integrator

    results = propagate(integrator, start.stop, len(start.y) // width, begin, max_workers=1)
    states = np.vstack([one[0].state.T if width > 1 else one[0].state[None] for one in results])
    if width == 1:
        return states, sum(int(one[4]) for one in results)
    return states, sum(int(result[3]) for one in results for result in one[0].propagate_res)


def _heyoka(start: Start, tolerances: Sequence[float], many: bool) -> list[Task]:
    import heyoka

    system = heyoka_system(start.problem.kernel.rates, start.problem.parameters)
    tasks: list[Task] = []
    for tolerance in tolerances:
        for width in WIDTHS:
            first = np.ascontiguousarray(start.y[:width].T)
            integrator = heyoka.taylor_adaptive_batch(system, first, tol=tolerance)
            tasks.append((f"heyoka batch {width}", tolerance, partial(_batches, integrator, width, start)))
    for tolerance in ENSEMBLE_TOLERANCES if many else ():
        width = WIDTHS[0]
        batch = heyoka.taylor_adaptive_batch(system, np.ascontiguousarray(start.y[:width].T), tol=tolerance)
        run = partial(_ensemble, heyoka.ensemble_propagate_until_batch, batch, width, start)
        tasks.append((f"heyoka ensemble batch {width}", tolerance, run))
        single = heyoka.taylor_adaptive(system, start.y[0], tol=tolerance)
        run = partial(_ensemble, heyoka.ensemble_propagate_until, single, 1, start)
        tasks.append(("heyoka ensemble", tolerance, run))
    return tasks


def measure(start: Start, rounds: int, many: bool = False) -> list[Measured]:
    """Compute the trajectories of the ensemble ``start`` by symrot and by heyoka, and return times and errors.

    The result has one entry for each method and tolerance. With ``many``, heyoka's ensemble functions run too.
    """
    ours, theirs = [10.0 ** (-k / 4) for k in range(4, 57)], [10.0 ** (-k / 2) for k in range(6, 33)]
    # heyoka's ensemble functions are made for thousands of trajectories
    return raced([*_ours(start, ours), *_heyoka(start, theirs, many)], start.error, rounds)


# ------------------------------------------------------------------------------------------------ tables


def _print_table(runs: list[Measured], n: int) -> None:
    peers = sorted({run.name for run in runs} - {"lanes"})
    for contestant in ("lanes", *peers):
        own = [run for run in runs if run.name == contestant]
        longest = min(own, key=lambda run: run.tolerance)
        pace = longest.least / longest.steps * 1e9
        print(f"  {contestant:24}{pace:6.0f} ns per trajectory and step, least error {min(r.error for r in own):.1e}")
    print(f"{'  error <=':10}{'lanes us':>10}{'heyoka us':>11}{'ratio':>8}   per trajectory; fastest mode of heyoka")
    ratios = []
    for decade in DECADES:
        ours, other = best_of(runs, decade, ["lanes"]), best_of(runs, decade, peers)
        if ours is None or other is None:
            continue
        times = [run.least / n * 1e6 for run in (ours, other)]
        ratios.append(times[1] / times[0])
        print(f"{decade:10.0e}{times[0]:10.1f}{times[1]:11.1f}{ratios[-1]:8.2f}   {other.name}")
    if ratios:
        print(f"  median ratio {np.median(ratios):.2f}, least {min(ratios):.2f}")


def _print_orders(start: Start, rounds: int) -> None:
    runs = raced(_ours(start, [10.0 ** (-k / 2) for k in range(2, 29)], ORDERS), start.error, rounds)
    print(f"{'  error <=':10}" + "".join(f"{order:>14}" for order in ORDERS) + "   us per trajectory (tolerance)")
    for decade in DECADES:
        fastest = [best_of(runs, decade, [f"{order}"]) for order in ORDERS]
        cells = [f"{r.least / len(start.y) * 1e6:7.1f} {r.tolerance:.0e}" if r else "-" for r in fastest]
        print(f"{decade:10.0e}" + "".join(f"{cell:>14}" for cell in cells))


def main(arguments: list[str] | None = None) -> None:
    """Print the times of ensembles, symrot against heyoka, at equal error."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.ensemble", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument(
        "--orders",
        action="store_true",
        help="compare different orders of symrot's Taylor series with each other, not with heyoka",
    )
    parser.add_argument(
        "--many", type=int, default=4096, help="number of trajectories in the large ensemble, a multiple of 8"
    )
    parser.add_argument("--motion", choices=list(MOTIONS), help="one motion only")
    options = parser.parse_args(arguments)
    if options.many < 8 or options.many % 8:
        parser.error(f"--many: expected a multiple of 8, got {options.many}")
    for name in [options.motion] if options.motion else MOTIONS:
        problem = SteppedProblem(name, 1.0)
        few = prepare(8, problem.stop, problem)
        off = problem.largest_error(few.exact[0], reference(name))
        print(f"\n{name}, 8 trajectories, t = {problem.stop:g} s (long double against 40 digits: {off:.0e})")
        if options.orders:
            _print_orders(few, options.rounds)
            continue
        _print_table(measure(few, options.rounds), 8)
        many = prepare(options.many, problem.stop / SHORTER, problem)
        print(f"{name}, {options.many} trajectories, t = {many.stop:g} s")
        _print_table(measure(many, max(1, options.rounds // 4), many=True), options.many)


if __name__ == "__main__":
    main()
