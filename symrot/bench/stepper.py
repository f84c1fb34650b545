"""Times of three DOP853 steppers on the free asymmetric body: symrot's, a handwritten stepper in C, and SciPy's.

    python -m symrot.bench.stepper [--tolerance 1e-9] [--stop 1000] [--rounds 15]

Times are ratios within one run. The handwritten stepper is compiled with ``-O2`` and ``-O3``; in long double at a
tolerance of 1e-17 it is the reference.
"""

import argparse
import ctypes
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.bench.by_hand import text_by_hand
from symrot.build import cache
from symrot.propagation.steppers import dop853

__all__ = ["Measurement", "main", "measure"]

MOMENTS = (1.0, 2.0, 3.0)  # kg m^2
INITIAL = (0.3, 1.0, 0.5, 1.0, 0.0, 0.0, 0.0)  # rad/s, 1
SLOW_ROUNDS = 3  # rounds of SciPy, which takes a thousand times as long

Floats = NDArray[np.float64]


class Measurement(NamedTuple):
    """The result of one stepper: evaluations of the rates, its time in each round, s, and the largest error at
    the end.
    """

    name: str
    evaluations: int
    seconds: list[float]
    error: float


def measure(tolerance: float, stop: float, rounds: int) -> list[Measurement]:
    """Return one measurement per contestant: symrot, by hand with -O2, by hand with -O3, SciPy."""
    kernel = text_by_hand("free_body.c")
    by_hand = kernel + text_by_hand("stepper_by_hand.c")
    a, b, c = MOMENTS
    p = ((b - c) / a, (c - a) / b, (a - b) / c)
    fast = tuple("-O3" if flag == "-O2" else flag for flag in cache.FLAGS)
    contestants: list[tuple[str, int, Callable[[], tuple[int, Floats]]]] = [
        (
            "symrot",
            rounds,
            partial(
                _symrot,
                cache.build(dop853.translation_unit(kernel, "symrot_free_body", 7, 3), "free_body_stepper"),
                p,
                tolerance,
                stop,
            ),
        ),
        ("by hand, -O2", rounds, _by_hand(cache.build(by_hand, "stepper_by_hand"), p, tolerance, stop)),
        ("by hand, -O3", rounds, _by_hand(cache.build(by_hand, "stepper_by_hand", fast), p, tolerance, stop)),
        ("solve_ivp", min(rounds, SLOW_ROUNDS), partial(_scipy, p, tolerance, stop)),
    ]
    longer = by_hand.replace("double", "long double").replace("fabs(", "fabsl(").replace("free_body", "free_body_long")
    _, exact = _by_hand(cache.build(longer, "stepper_long_double"), p, 1e-17, stop, ctypes.c_longdouble)()
    results = [Measurement(name, *_cost_and_error(run, exact)) for name, _, run in contestants]
    for turn in range(rounds):
        for (_, turns, run), result in zip(contestants, results, strict=True):
            if turn < turns:
                began = perf_counter()
                run()
                result.seconds.append(perf_counter() - began)
    return results


def _cost_and_error(run: Callable[[], tuple[int, Floats]], exact: Floats) -> tuple[int, list[float], float]:
    evaluations, state = run()
    return evaluations, [], float(abs(state - exact).max())


def _symrot(path: Path, p: tuple[float, ...], tolerance: float, stop: float) -> tuple[int, Floats]:
    states, stats = dop853.integration(path, p, INITIAL, 0.0, tolerance).sample((stop,))
    return stats.evaluations, states[0]


def _by_hand(
    path: Path, p: tuple[float, ...], tolerance: float, stop: float, real: Any = ctypes.c_double
) -> Callable[[], tuple[int, Floats]]:
    function = ctypes.CDLL(str(path)).symrot_by_hand
    function.argtypes = (real, real, ctypes.c_void_p, ctypes.c_void_p, real)
    function.restype = ctypes.c_long
    parameters = (real * len(p))(*p)

    def run() -> tuple[int, Floats]:
        y = (real * len(INITIAL))(*INITIAL)
        evaluations: int = function(0.0, stop, y, parameters, tolerance)
        return evaluations, np.array([float(value) for value in y])

    return run


def _scipy(p: tuple[float, ...], tolerance: float, stop: float) -> tuple[int, Floats]:
    from scipy.integrate import solve_ivp

    def rhs(t: float, y: Floats) -> Floats:
        w1, w2, w3, q0, q1, q2, q3 = y
        return np.array(
            [
                p[0] * w2 * w3,
                p[1] * w3 * w1,
                p[2] * w1 * w2,
                0.5 * (-q1 * w1 - q2 * w2 - q3 * w3),
                0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
                0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
                0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
            ]
        )

    solution = solve_ivp(rhs, (0.0, stop), np.array(INITIAL), method="DOP853", rtol=tolerance, atol=tolerance)
    return int(solution.nfev), solution.y[:, -1]


def main(arguments: list[str] | None = None) -> None:
    """Print the times and errors of symrot's, the handwritten and SciPy's DOP853."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.stepper", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--tolerance", type=float, default=1e-9)
    parser.add_argument("--stop", type=float, default=1000.0, help="end of the span, s")
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args(arguments)
    results = measure(options.tolerance, options.stop, options.rounds)
    first = results[0]
    fastest = min(first.seconds)
    best = min(min(result.seconds) / result.evaluations for result in results if result.name.startswith("by hand"))
    print(f"free body, moments {MOMENTS}, t = {options.stop:g} s, tolerance {options.tolerance:g}")
    titles = ("evaluations", "median ms", "min ms", "ns/evaluation", "error", "min / ours")
    print(" " * 14 + "".join(title.rjust(width) for title, width in zip(titles, (12, 12, 12, 15, 11, 12), strict=True)))
    for name, evaluations, seconds, error in results:
        least = min(seconds)
        print(
            f"{name:14}{evaluations:12d}{median(seconds) * 1e3:12.3f}{least * 1e3:12.3f}"
            f"{least / evaluations * 1e9:15.1f}{error:11.1e}{least / fastest:12.2f}"
        )
    print(f"per evaluation, symrot takes {fastest / first.evaluations / best:.2f} of the best program by hand")


if __name__ == "__main__":
    main()
