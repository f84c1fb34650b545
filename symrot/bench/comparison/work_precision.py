"""Work-precision studies: time and error of every available method on one scene.

Each method runs to four instants of the span; its error is the largest difference there from a more precise reference.
For each power of ten of the error (decade), the table has the fastest run of at most that error; no curve is smoothed
or extended.
"""

import hashlib
import math
import os
import platform
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from importlib import metadata
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from symrot import __version__
from symrot.bench.comparison.contestants import Contestant, chosen
from symrot.bench.comparison.problem import Problem, State
from symrot.bench.comparison.race import Measured, race, seconds_of, work_ahead
from symrot.bench.comparison.reference import reference
from symrot.build import cache
from symrot.errors import InputError, SymrotError
from symrot.scene.scene import Scene

__all__ = ["DECADES", "FORMAT", "Effort", "decades", "digest", "machine", "study"]

FORMAT = "symrot work-precision 1"
DECADES = tuple(float(f"1e-{k}") for k in range(2, 16))
STEPPED = ("taylor", "dop853")  # symrot's steppers, without its closed forms
OURS = ("exact", "exact with set-up", *STEPPED)


class Effort(NamedTuple):
    """The settings that determine how long a work-precision study takes, such as its tolerances and repetitions."""

    rounds: int
    longest: float  # s: after a longer run, the tighter tolerances of its contestant are skipped
    every: int  # 1 runs all tolerances of a contestant, 2 runs every second one of more than 16
    reference: float  # s, for the computation of the reference


FULL, QUICK = Effort(9, 1.0, 1, 150.0), Effort(5, 0.25, 2, 60.0)

Progress = Callable[[str], object]
Entry = tuple[Measured, Callable[[], object]]


def study(
    scene: Scene,
    methods: str | None = None,
    quick: bool = False,
    say: Progress = lambda text: None,
    tolerances: Sequence[float] = (),
    rounds: int | None = None,
) -> dict[str, Any]:
    """Run a work-precision study of one scene and return it as data for JSON.

    Parameters
    ----------
    scene : Scene
        The motion, followed over its whole span.
    methods : str, optional
        Groups of :data:`symrot.bench.comparison.contestants.CONTESTANTS`, comma-separated; default: all.
    quick : bool
        Whether to save time: fewer repetitions, heyoka only in its default setting, and for a method with more than 16
        tolerances every second tolerance.
    say : callable
        Called with messages about the progress.
    tolerances : sequence of float, optional
        Decreasing numbers; each method runs at those that it supports. Default: one or two per decade.
    rounds : int, optional
        Number of repetitions of each run, at most 2 for a run of 0.2 s or more. Default: 9, or 5 if ``quick``.

    Raises
    ------
    InputError
        If a method is unknown, the scene has no state to integrate, or no method can take part.
    SymrotError
        If no reference is available, or no other reference agrees with the first.
    """
    taking_part, effort = chosen(methods, quick), QUICK if quick else FULL
    if rounds is not None:
        effort = effort._replace(rounds=rounds)
    if tolerances:
        taking_part = [one.at(tolerances) for one in taking_part]
        effort = effort._replace(every=1)
    problem = Problem(scene)
    truth = reference(problem, say, effort.reference)
    entries, skipped = _entries(problem, taking_part, effort, truth.states, say)
    if not entries:
        why = "; ".join(f"{item['method']}: {item['why']}" for item in skipped) or "no method supports these tolerances"
        raise InputError(f"{scene.name}: expected a method that can follow this motion; {why}")
    ahead = work_ahead((measured for measured, _ in entries), effort.rounds)

    def turn(number: int) -> None:
        say(f"{scene.name}: {len(entries)} runs, about {ahead:.0f} s: round {number + 1} of {effort.rounds}")

    race(entries, effort.rounds, turn)
    runs = [measured.to_json() for measured, _ in entries]
    floor = 0.0 if math.isnan(truth.doubt) else truth.doubt
    rows = decades(runs, floor)
    return {
        "format": FORMAT, "symrot": __version__,
        "scene": {"name": scene.name, "title": scene.title, "span": [problem.start, problem.stop],
                  "digest": digest(problem)},
        "machine": machine(), "quick": quick, "reference": truth.to_json(), "runs": runs, "decades": rows,
        "against": against(rows), "skipped": skipped,
    }  # fmt: skip


def digest(problem: Problem) -> str:
    """Return a hash of a motion (inertia, initial state, torques, span), by which stored results are assigned to it."""
    scene = problem.scene
    moving = (scene.body.inertia, scene.initial, scene.torques, scene.span.start, scene.span.stop, problem.names)
    return hashlib.sha256(repr(moving).encode()).hexdigest()[:16]


def _entries(
    problem: Problem, contestants: Sequence[Contestant], effort: Effort, exact: Sequence[State], say: Progress
) -> tuple[list[Entry], list[dict[str, str]]]:
    """Return (entries, skipped): an entry with error and steps for each method and tolerance, and the methods left out.

    A dict in ``skipped`` has a method's name (``method``) and the reason (``why``) for all or some of its tolerances.
    """
    entries: list[Entry] = []
    skipped = []
    for contestant in contestants:
        why = contestant.missing(problem)
        if why:
            skipped.append({"method": contestant.name, "why": why})
            continue
        for tolerance in contestant.tolerances[:: effort.every if len(contestant.tolerances) > 16 else 1]:
            label = f"{contestant.name} at {tolerance:.0e}" if tolerance else contestant.name
            say(f"{problem.scene.name}: {label} ..")
            try:
                entry = _entry(problem, contestant, tolerance, exact)
            except (SymrotError, ArithmeticError, RuntimeError, ValueError) as reason:
                if all(item["method"] != contestant.name for item in skipped):
                    skipped.append({"method": contestant.name, "why": f"at {tolerance:.0e}: {reason}"})
                continue
            entries.append(entry)
            if entry[0].first > effort.longest:
                why = f"tolerances below {tolerance:.0e}, at which a run takes {entry[0].first:.1f} s"
                skipped.append({"method": contestant.name, "why": why})
                break
    return entries, skipped


def _entry(problem: Problem, contestant: Contestant, tolerance: float, exact: Sequence[State]) -> Entry:
    follow = contestant.prepare(problem, tolerance)
    states, steps = [], 0
    for end in problem.ends:
        last, steps = follow(end)
        states.append(last if isinstance(last, State) else problem.state(last, end))
    error = problem.worst(states, exact)
    if not math.isfinite(error):
        raise SymrotError("expected finite states, got infinite or undefined ones")
    run = partial(follow, problem.stop)
    # the first call is done, so its additional cost does not count: the time of a second call is measured
    return Measured(contestant.name, tolerance, steps, error, seconds_of(run)), run


# ------------------------------------------------------------------------------------------------ reading


def best(runs: Iterable[dict[str, Any]], error: float) -> dict[str, Any] | None:
    """Return the fastest of the runs whose error is at most ``error``, or None if there is no such run."""
    good = [run for run in runs if run["error"] <= error]
    return min(good, key=lambda run: float(run["seconds"]), default=None)


def decades(runs: Sequence[dict[str, Any]], floor: float = 0.0) -> list[dict[str, Any]]:
    """Return the rows of the printed table, one for each bound of the error (a power of ten) down to ``floor``.

    A row has each method's time and its ratio to the time of the fastest method. Errors that no run reaches have no
    row.
    """
    names = list(dict.fromkeys(run["method"] for run in runs))
    rows = []
    for error in DECADES:
        fastest_runs = {name: run for name in names if (run := best((r for r in runs if r["method"] == name), error))}
        if not fastest_runs or error < floor:
            # The reference cannot judge errors below ``floor``, the difference between reference solutions.
            continue
        fastest = min(fastest_runs, key=lambda name: float(fastest_runs[name]["seconds"]))
        least = float(fastest_runs[fastest]["seconds"])
        rows.append(
            {
                "error": error, "fastest": fastest, "seconds": least,
                "methods": {
                    name: {"seconds": run["seconds"], "ratio": run["seconds"] / least, "tolerance": run["tolerance"]}
                    for name, run in fastest_runs.items()
                },
            }
        )  # fmt: skip
    return rows


def against(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Compare each program other than symrot with symrot: its times divided by symrot's times at equal error.

    ``rows`` come from :func:`decades`. The result has one dict for each program, such as ``{"peer": "heyoka",
    "stepped": {"median": 3.0, "least": 2.0, "ratios": {"1e-06": 2.0, "1e-07": 4.0}}, "all": ..}``. The ratios are to
    symrot's fastest stepper (``stepped``), and to its fastest method, closed forms included (``all``).
    """
    peers = list(dict.fromkeys(name for row in rows for name in row["methods"] if name not in (*OURS, "symrot scipy")))
    settings = [name for name in peers if name.startswith("heyoka")]
    asked = [(name, (name,)) for name in peers]
    if len(settings) > 1:
        # heyoka's fastest setting at each error counts as one more program
        asked.append(("heyoka, best setting", tuple(settings)))
    comparisons = []
    for title, names in asked:
        ratios = {key: _ratios(rows, ours, names) for key, ours in (("stepped", STEPPED), ("all", OURS))}
        statistics = {
            key: {"median": median(values.values()), "least": min(values.values()), "ratios": values}
            for key, values in ratios.items()
            if values
        }
        if statistics:
            comparisons.append({"peer": title, **statistics})
    return comparisons


def _ratios(rows: Sequence[dict[str, Any]], ours: Sequence[str], theirs: Sequence[str]) -> dict[str, float]:
    """Return a map from bounds of the error, such as "1e-06", to the ratio of two times at this error.

    The ratio is the least time of the methods ``theirs`` divided by the least time of the methods ``ours``. Errors that
    one side does not reach are omitted.
    """
    ratios = {}
    for row in rows:
        sides = [[row["methods"][name]["seconds"] for name in names if name in row["methods"]]
                 for names in (theirs, ours)]  # fmt: skip
        if all(sides):
            ratios[f"{row['error']:.0e}"] = min(sides[0]) / min(sides[1])
    return ratios


def machine() -> dict[str, Any]:
    """Return a description of the machine on which times are measured, and the versions of the programs."""
    return {
        "processor": _processor(), "cores": os.cpu_count(), "load": list(os.getloadavg()) if _has_load() else None,
        "python": platform.python_version(), "numpy": np.__version__,
        **{name: _version(name) for name in ("scipy", "heyoka")},
        "compiler": None if cache.missing() else " ".join(cache.compiler().command),
    }  # fmt: skip


def _has_load() -> bool:
    return hasattr(os, "getloadavg")


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    if sys.platform == "linux":
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return " ".join(line.partition(":")[2].split())
    return platform.processor() or platform.machine()
