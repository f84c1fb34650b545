"""Processor times of several runs that alternate, so that all run under the same conditions.

All runs are timed once per round. A run of microseconds is repeated, and the mean counts; a run of 0.2 s or more is
timed in only two rounds. The median and the least time over the rounds are recorded.
"""

import gc
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from statistics import median
from time import process_time
from typing import Any

__all__ = ["EndState", "Measured", "Task", "race", "raced", "rounds_for", "seconds_of", "work_ahead"]

SHORTEST = 2e-3  # s, approximate duration of one timing: long enough to load code and numbers into the caches
MOST_REPEATS = 200  # calls in one timing, even if they take less than SHORTEST
SLOW, SLOW_ROUNDS = 0.2, 2  # a run that takes at least SLOW seconds is timed in only SLOW_ROUNDS rounds

EndState = tuple[Any, int]  # the states at the end of a run, and the number of its steps
Task = tuple[str, float, Callable[[], EndState]]  # contestant, its tolerance (0 if it has none), function to be timed


@dataclass
class Measured:
    """One method or program at one tolerance: number of steps, error, and processor seconds in each round."""

    name: str
    tolerance: float
    steps: int
    error: float
    first: float  # seconds of a call before the race
    seconds: list[float] = field(default_factory=list)

    @property
    def median(self) -> float:
        return median(self.seconds)

    @property
    def least(self) -> float:
        return min(self.seconds)

    def to_json(self) -> dict[str, Any]:
        return {
            "method": self.name, "tolerance": self.tolerance or None, "steps": self.steps, "error": self.error,
            "seconds": self.median, "least": self.least, "turns": len(self.seconds),
        }  # fmt: skip


def seconds_of(run: Callable[[], object], repeats: int = 1) -> float:
    """Call ``run`` ``repeats`` times, and return the mean processor time of one call, s."""
    began = process_time()
    for _ in range(repeats):
        run()
    return (process_time() - began) / repeats


def rounds_for(seconds: float, rounds: int) -> int:
    """Return in how many rounds to time a function whose call takes ``seconds``: ``rounds``, or fewer if it is slow.

    For calls of :data:`SLOW` s or more, the number is at most :data:`SLOW_ROUNDS`.
    """
    return rounds if seconds < SLOW else min(rounds, SLOW_ROUNDS)


def _repeats(seconds: float) -> int:
    return max(1, min(MOST_REPEATS, int(SHORTEST / max(seconds, 1e-9))))


def work_ahead(measured: Iterable[Measured], rounds: int) -> float:
    """Return the estimated time, s, of a race of all ``measured`` methods in ``rounds`` rounds."""
    return sum(one.first * _repeats(one.first) * rounds_for(one.first, rounds) for one in measured)


def race(
    entries: Sequence[tuple[Measured, Callable[[], object]]],
    rounds: int,
    turn: Callable[[int], object] = lambda number: None,
) -> None:
    """Time several functions in turn, round after round, and store the processor times, s, in a Measured for each.

    ``entries`` are pairs (measured, function): the times of the function are appended to ``measured.seconds``.
    ``turn(number)`` is called at the start of each round, to report the progress.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        for number in range(rounds):
            turn(number)
            for measured, run in entries:
                if number < rounds_for(measured.first, rounds):
                    measured.seconds.append(seconds_of(run, _repeats(measured.first)))
    finally:
        if collecting:
            gc.enable()


def raced(tasks: Sequence[Task], error: Callable[[Any], float], rounds: int) -> list[Measured]:
    """Run each task once for its steps and its error, then time all tasks alternately; return the measured runs.

    ``error`` returns the error of the states that a task returns.
    """
    entries = []
    for name, tolerance, run in tasks:
        states, steps = run()
        entries.append((Measured(name, tolerance, steps, error(states), seconds_of(run)), run))
    race(entries, rounds)
    return [measured for measured, _ in entries]
