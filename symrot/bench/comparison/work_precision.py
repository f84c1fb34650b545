"""The work-precision study of a scene: seconds against the error reached, for every method there is.

Each contestant runs over a range of tolerances. The error is the largest at four times of the span, each reached by a
run of its own, against a reference of higher precision (:mod:`symrot.bench.comparison.reference`); runs to the end are
timed in turns (:mod:`symrot.bench.comparison.race`). At each decade of the error the fastest run counts that is at
least as good: no curve is smoothed or extended. Decades that the references cannot tell apart are left out.
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
from symrot.build import cache as library
from symrot.errors import InputError, SymrotError
from symrot.scene.scene import Scene

__all__ = ["DECADES", "FORMAT", "Effort", "decades", "digest", "machine", "study"]

FORMAT = "symrot work-precision 1"
DECADES = tuple(float(f"1e-{k}") for k in range(2, 16))
STEPPED = ("taylor", "dop853")  # symrot's own, the closed form left out
OURS = ("exact", "exact with set-up", *STEPPED)


class Effort(NamedTuple):
    """How much a study may spend."""

    rounds: int
    longest: float  # s of a run; a contestant's tighter tolerances are left out once it takes longer
    every: int  # of the tolerances of a contestant that has two to a decade, one in so many is run
    reference: float  # s


FULL, QUICK = Effort(9, 1.0, 1, 150.0), Effort(5, 0.25, 2, 60.0)

Say = Callable[[str], object]
Entry = tuple[Measured, Callable[[], object]]


def study(
    scene: Scene,
    methods: str | None = None,
    quick: bool = False,
    say: Say = lambda text: None,
    tolerances: Sequence[float] = (),
    rounds: int | None = None,
) -> dict[str, Any]:
    """Return the study as data for JSON.

    Parameters
    ----------
    scene : Scene
        The motion, from the start of its span to the end.
    methods : str, optional
        Names of :data:`symrot.bench.comparison.contestants.CONTESTANTS`' groups, commas between; default: all.
    quick : bool
        Half the tolerances, fewer turns, heyoka in its default settings only.
    say : callable
        Hears what is being done.
    tolerances : sequence of float, optional
        Falling; each method takes those that it can hold. Default: two to a decade, or one.
    rounds : int, optional
        Turns of each run. Default: 9, quick 5.

    Raises
    ------
    InputError
        For a method that is none, or a scene with nothing to integrate, or when no method can take part.
    SymrotError
        If the references contradict one another.
    """
    taking_part, effort = chosen(methods, quick), QUICK if quick else FULL
    if rounds is not None:
        effort = effort._replace(rounds=rounds)
    if tolerances:
        taking_part = [one.at(tolerances) for one in taking_part]
        effort = effort._replace(every=1)
    problem = Problem(scene)
    found = reference(problem, say, effort.reference)
    entries, skipped = _entries(problem, taking_part, effort, found.states, say)
    if not entries:
        why = "; ".join(f"{item['method']}: {item['why']}" for item in skipped) or "no tolerance that one can hold"
        raise InputError(f"{scene.name}: expected a method that can follow this motion; {why}")
    ahead = work_ahead((measured for measured, _ in entries), effort.rounds)

    def turn(number: int) -> None:
        say(f"{scene.name}: {len(entries)} runs in turns, about {ahead:.0f} s: round {number + 1} of {effort.rounds}")

    race(entries, effort.rounds, turn)
    runs = [measured.to_json() for measured, _ in entries]
    floor = 0.0 if math.isnan(found.doubt) else found.doubt
    rows = decades(runs, floor)
    return {
        "format": FORMAT, "symrot": __version__,
        "scene": {"name": scene.name, "title": scene.title, "span": [problem.start, problem.stop],
                  "digest": digest(problem)},
        "machine": machine(), "quick": quick, "reference": found.to_json(), "runs": runs, "decades": rows,
        "against": against(rows), "skipped": skipped,
    }  # fmt: skip


def digest(problem: Problem) -> str:
    """Return what tells motions apart: the same for the same body, start, torques and span, whatever the title."""
    scene = problem.scene
    moving = (scene.body.inertia, scene.initial, scene.torques, scene.span.start, scene.span.stop, problem.names)
    return hashlib.sha256(repr(moving).encode()).hexdigest()[:16]


def _entries(
    problem: Problem, contestants: Sequence[Contestant], effort: Effort, exact: Sequence[State], say: Say
) -> tuple[list[Entry], list[dict[str, str]]]:
    """Return every run with its error, and what was left out and why."""
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
                why = f"below {tolerance:.0e}: a run takes {entry[0].first:.1f} s and more"
                skipped.append({"method": contestant.name, "why": why})
                break
    return entries, skipped


def _entry(problem: Problem, contestant: Contestant, tolerance: float, exact: Sequence[State]) -> Entry:
    follow = contestant.prepare(problem, tolerance)
    found, steps = [], 0
    for end in problem.ends:
        last, steps = follow(end)
        found.append(last if isinstance(last, State) else problem.state(last, end))
    run = partial(follow, problem.stop)
    # what a first call costs once is over: the clock is asked about another one
    return Measured(contestant.name, tolerance, steps, problem.worst(found, exact), seconds_of(run)), run


# ------------------------------------------------------------------------------------------------ reading


def best(runs: Iterable[dict[str, Any]], error: float) -> dict[str, Any] | None:
    """Return the fastest of some runs with at most that error, or None."""
    good = [run for run in runs if run["error"] <= error]
    return min(good, key=lambda run: float(run["seconds"]), default=None)


def decades(runs: Sequence[dict[str, Any]], floor: float = 0.0) -> list[dict[str, Any]]:
    """Return, for each decade of the error, the fastest run and the ratios of all methods to it.

    Decades below ``floor``, which the reference cannot tell apart, are left out.
    """
    names = list(dict.fromkeys(run["method"] for run in runs))
    rows = []
    for error in DECADES:
        found = {name: run for name in names if (run := best((r for r in runs if r["method"] == name), error))}
        if not found or error < floor:
            continue
        fastest = min(found, key=lambda name: float(found[name]["seconds"]))
        least = float(found[fastest]["seconds"])
        rows.append(
            {
                "error": error, "fastest": fastest, "seconds": least,
                "methods": {
                    name: {"seconds": run["seconds"], "ratio": run["seconds"] / least, "tolerance": run["tolerance"]}
                    for name, run in found.items()
                },
            }
        )  # fmt: skip
    return rows


def against(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return how many times longer each peer takes than symrot's steppers, and than all of symrot: median and least.

    Where heyoka ran in several settings, the fastest at each decade is a peer of its own.
    """
    peers = list(dict.fromkeys(name for row in rows for name in row["methods"] if name not in (*OURS, "symrot scipy")))
    settings = [name for name in peers if name.startswith("heyoka")]
    asked = [(name, (name,)) for name in peers]
    if len(settings) > 1:
        asked.append(("heyoka, best setting", tuple(settings)))
    found = []
    for title, names in asked:
        ratios = {key: _ratios(rows, ours, names) for key, ours in (("stepped", STEPPED), ("all", OURS))}
        told = {
            key: {"median": median(values.values()), "least": min(values.values()), "ratios": values}
            for key, values in ratios.items()
            if values
        }
        if told:
            found.append({"peer": title, **told})
    return found


def _ratios(rows: Sequence[dict[str, Any]], ours: Sequence[str], theirs: Sequence[str]) -> dict[str, float]:
    """Return how many times the time of ours theirs take, by decade of the error."""
    found = {}
    for row in rows:
        sides = [[row["methods"][name]["seconds"] for name in names if name in row["methods"]]
                 for names in (theirs, ours)]  # fmt: skip
        if all(sides):
            found[f"{row['error']:.0e}"] = min(sides[0]) / min(sides[1])
    return found


def machine() -> dict[str, Any]:
    """Return what the seconds were measured on."""
    return {
        "processor": _processor(), "cores": os.cpu_count(), "load": list(os.getloadavg()) if _has_load() else None,
        "python": platform.python_version(), "numpy": np.__version__,
        **{name: _version(name) for name in ("scipy", "heyoka")},
        "compiler": None if library.missing() else " ".join(library.compiler().command),
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
