"""Time runs against one another: in turns, so that all meet the same machine, by the time of the processor.

A run of microseconds is repeated until the clock can see it; a run of seconds gets fewer turns. The median of the turns
is what counts, the least is kept beside it.
"""

import gc
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from statistics import median
from time import process_time
from typing import Any

__all__ = ["Measured", "race", "rounds_for", "seconds_of", "work_ahead"]

SHORTEST = 2e-3  # s, what one turn lasts at least: long enough to find its code and numbers in the caches
MOST_REPEATS = 200
SLOW, SLOW_ROUNDS = 0.2, 2  # a run of that many seconds gets so many turns


@dataclass
class Measured:
    """One contestant at one tolerance: what it reached, and the seconds of each turn."""

    name: str
    tolerance: float
    steps: int
    error: float
    first: float  # seconds of the run that the error was taken from
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
    """Return the seconds of the processor that one run takes."""
    began = process_time()
    for _ in range(repeats):
        run()
    return (process_time() - began) / repeats


def rounds_for(seconds: float, rounds: int) -> int:
    """Return how many turns a run of that length gets."""
    return rounds if seconds < SLOW else min(rounds, SLOW_ROUNDS)


def _repeats(seconds: float) -> int:
    return max(1, min(MOST_REPEATS, int(SHORTEST / max(seconds, 1e-9))))


def work_ahead(measured: Iterable[Measured], rounds: int) -> float:
    """Return about how many seconds the race takes."""
    return sum(one.first * _repeats(one.first) * rounds_for(one.first, rounds) for one in measured)


def race(
    entries: Sequence[tuple[Measured, Callable[[], object]]],
    rounds: int,
    turn: Callable[[int], object] = lambda number: None,
) -> None:
    """Let all runs take their turns; their seconds are appended. ``turn`` hears of each round before it begins."""
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
