"""Times of closed forms: nanoseconds per sample, microseconds of set-up, and a complete call from Python.

    python -m symrot.bench.closed_form [--rounds 300]

All runs are timed once in every round, and the least time of each counts, because other work on the machine only adds
time. Errors are tested by ``pytest tests/closed_form``.
"""

import argparse
from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from symrot.closed_form.axial import motion as axial
from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.gyrostat import motion as gyrostat
from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.closed_form.spin_up import motion as spin_up

__all__ = ["main", "measure"]

SAMPLES = 1000
SPAN = 50.0  # s
ATTITUDE = (0.1, 0.7, -0.5, 0.5)
Case = tuple[str, Callable[[], Any]]


def _free(moments: tuple[float, ...], omega: tuple[float, ...]) -> Callable[[], Any]:
    return partial(free_body.motion, moments, omega, ATTITUDE)


def _top(omega: tuple[float, ...], attitude: tuple[float, ...]) -> Callable[[], Any]:
    return partial(heavy_top.motion, (1.0, 1.0, 0.5), 1.0, (0.0, 0.0, 1.0), omega, attitude)


CASES: tuple[Case, ...] = (
    ("free body, m < 0.7", _free((1.0, 2.0, 3.0), (0.3, 1.0, 1.5))),
    ("free body, m >= 0.7", _free((1.0, 2.0, 3.0), (0.01, 1.0, 0.01))),
    ("free body, separatrix", _free((3.0, 4.0, 6.0), (2.0, 1.5, 1.0))),
    ("free body, steady", _free((2.0, 2.0, 2.0), (0.3, 1.0, 0.5))),
    ("heavy top, m < 0.7", _top((0.3, -1.8, 4.0), (0.9, 0.3, 0.0, 0.1))),
    ("heavy top, m >= 0.7", _top((0.0, 0.0, 3.0), (1.0, 0.001, 0.0, 0.0))),
    ("gyrostat", partial(gyrostat.motion, (1.0, 1.0, 2.0), (0.0, 0.0, 3.0), (0.3, 1.0, 0.5), ATTITUDE)),
    ("one axis, pushed", partial(axial.motion, (1.0, 3.0, 2.0), 1, 0.25, (0.0, 0.75, 0.0), ATTITUDE)),
    ("one axis, damped", partial(axial.motion, (1.0, 3.0, 2.0), 1, 0.25, (0.0, 0.75, 0.0), ATTITUDE, 0.125)),
    ("spin-up near resonance", partial(spin_up.motion, (1.1, 1.1, 0.8), 2, 0.05, (0.2, 0.1, -0.5), ATTITUDE)),
    ("spin-up, far from it", partial(spin_up.motion, (1.1, 1.1, 0.8), 2, 0.05, (0.2, 0.1, 5.0), ATTITUDE)),
)


def _seconds(run: Callable[[], Any]) -> float:
    began = perf_counter()
    run()
    return perf_counter() - began


def measure(rounds: int) -> list[tuple[str, str, list[float]]]:
    """Time several motions in closed form; return for each its name, its regime (which formula applies), and six times.

    The times, s, are those of: set-up; all samples; their angular velocity alone; their attitude alone; one sample;
    set-up and all samples together.
    """
    t = np.linspace(0.0, SPAN, SAMPLES)
    one = t[:1]
    runs: list[tuple[str, str, list[Callable[[], Any]]]] = []
    for name, prepare in CASES:
        motion = prepare()
        runs.append(
            (
                name,
                motion.regime,
                [
                    prepare,
                    partial(motion.evaluate, t),
                    partial(motion.evaluate, t, quaternion=False),
                    partial(motion.evaluate, t, omega=False),
                    partial(motion.evaluate, one),
                    lambda prepare=prepare: prepare().evaluate(t),  # type: ignore[misc]
                ],
            )
        )
    # The least times of all rounds, in the order of the functions above.
    best = [[float("inf")] * 6 for _ in runs]
    for _ in range(rounds):
        for (_, _, functions), row in zip(runs, best, strict=True):
            row[:] = [min(old, _seconds(run)) for old, run in zip(row, functions, strict=True)]
    return [(name, regime, row) for (name, regime, _), row in zip(runs, best, strict=True)]


def main(arguments: list[str] | None = None) -> None:
    """Print the times of the closed forms: set-up, samples, and complete calls from Python."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument(
        "--rounds", type=int, default=300, help="repetitions of each run (default: 300); the least time is the result"
    )
    rounds = parser.parse_args(arguments).rounds
    print(f"{'':26}{'series':>12}{'set-up':>9}{'both':>8}{'omega':>8}{'q':>8}{'1 sample':>10}{f'{SAMPLES} in all':>13}")
    print(f"{'':38}{'us':>9}{'ns':>8}{'ns':>8}{'ns':>8}{'us':>10}{'us':>13}")
    for name, regime, (setup, both, omega, attitude, one, whole) in measure(rounds):
        each = [(seconds - one) / (SAMPLES - 1) * 1e9 for seconds in (both, omega, attitude)]
        print(
            f"{name:26}{regime:>12}{setup * 1e6:9.1f}"
            + "".join(f"{x:8.1f}" for x in each)
            + f"{one * 1e6:10.1f}{whole * 1e6:13.1f}"
        )


if __name__ == "__main__":
    main()
