"""Times of three DOP853 steppers on the free asymmetric body: symrot's, a handwritten stepper in C, and SciPy's.

    python -m symrot.bench.stepper [--tolerance 1e-9] [--stop 1000] [--rounds 15]

The handwritten stepper is compiled with ``-O2`` and ``-O3``; in long double at a tolerance of 1e-17 it is the reference
for errors. Compare the times of one run of this program only with each other.
"""

import argparse
import ctypes
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.bench.by_hand import text_by_hand
from symrot.bench.comparison.race import EndState, Measured, Task, raced
from symrot.build import cache
from symrot.propagation.steppers import dop853

__all__ = ["main", "measure"]

MOMENTS = (1.0, 2.0, 3.0)  # kg m^2
INITIAL = (0.3, 1.0, 0.5, 1.0, 0.0, 0.0, 0.0)  # rad/s, 1

Floats = NDArray[np.float64]


def measure(tolerance: float, stop: float, rounds: int) -> list[Measured]:
    """Return one measured run for each contestant: symrot's stepper, handwritten C with -O2 and with -O3, SciPy.

    Evaluations of the rates count as steps. The error is the largest difference of a component, at the end time, from
    the handwritten stepper in long double.
    """
    kernel = text_by_hand("free_body.c")
    by_hand = kernel + text_by_hand("stepper_by_hand.c")
    a, b, c = MOMENTS
    p = ((b - c) / a, (c - a) / b, (a - b) / c)
    fast = tuple("-O3" if flag == "-O2" else flag for flag in cache.FLAGS)
    own = cache.build(dop853.translation_unit(kernel, "symrot_free_body", 7, 3), "free_body_stepper")
    tasks: list[Task] = [
        ("symrot", tolerance, partial(_symrot, own, p, tolerance, stop)),
        ("by hand, -O2", tolerance, _by_hand(cache.build(by_hand, "stepper_by_hand"), p, tolerance, stop)),
        ("by hand, -O3", tolerance, _by_hand(cache.build(by_hand, "stepper_by_hand", fast), p, tolerance, stop)),
        ("solve_ivp", tolerance, partial(_scipy, p, tolerance, stop)),
    ]
    longer = by_hand.replace("double", "long double").replace("fabs(", "fabsl(").replace("free_body", "free_body_long")
    exact, _ = _by_hand(cache.build(longer, "stepper_long_double"), p, 1e-17, stop, ctypes.c_longdouble)()
    return raced(tasks, lambda state: float(abs(state - exact).max()), rounds)


def _symrot(path: Path, p: tuple[float, ...], tolerance: float, stop: float) -> EndState:
    states, stats = dop853.integration(path, p, INITIAL, 0.0, tolerance).sample((stop,))
    return states[0], stats.evaluations


def _by_hand(
    path: Path, p: tuple[float, ...], tolerance: float, stop: float, real: Any = ctypes.c_double
) -> Callable[[], EndState]:
    function = ctypes.CDLL(str(path)).symrot_by_hand
    function.argtypes = (real, real, ctypes.c_void_p, ctypes.c_void_p, real)
    function.restype = ctypes.c_long
    parameters = (real * len(p))(*p)

    def run() -> EndState:
        y = (real * len(INITIAL))(*INITIAL)
        evaluations: int = function(0.0, stop, y, parameters, tolerance)
        return np.array([float(value) for value in y]), evaluations

    return run


def _scipy(p: tuple[float, ...], tolerance: float, stop: float) -> EndState:
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
    return solution.y[:, -1], int(solution.nfev)


def main(arguments: list[str] | None = None) -> None:
    """Print the times and errors of symrot's, the handwritten and SciPy's DOP853."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.stepper", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--tolerance", type=float, default=1e-9)
    parser.add_argument("--stop", type=float, default=1000.0, help="end of the span, s")
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args(arguments)
    results = measure(options.tolerance, options.stop, options.rounds)
    first = results[0]
    best = min(result.least / result.steps for result in results if result.name.startswith("by hand"))
    print(f"free body, moments {MOMENTS}, t = {options.stop:g} s, tolerance {options.tolerance:g}")
    titles = ("evaluations", "median ms", "min ms", "ns/evaluation", "error", "min / ours")
    print(" " * 14 + "".join(title.rjust(width) for title, width in zip(titles, (12, 12, 12, 15, 11, 12), strict=True)))
    for each in results:
        print(
            f"{each.name:14}{each.steps:12d}{each.median * 1e3:12.3f}{each.least * 1e3:12.3f}"
            f"{each.least / each.steps * 1e9:15.1f}{each.error:11.1e}{each.least / first.least:12.2f}"
        )
    print(
        f"per evaluation, symrot takes {first.least / first.steps / best:.2f} times as long as the best "
        "handwritten program"
    )


if __name__ == "__main__":
    main()
