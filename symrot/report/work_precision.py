"""Work-precision studies as text, and the comparison of two studies.

A work-precision study measures the time and the error of several methods on one scene.
"""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from statistics import geometric_mean
from typing import Any

from symrot.errors import InputError
from symrot.files.reading import read_input
from symrot.report.layout import apart, columns, duration, fields, one_line, room

__all__ = ["compared", "lines", "lines_of_comparison", "read_study"]

FORMAT = "symrot work-precision 1"
ROUNDING = 1e-16  # relative rounding error of the compared results
LARGEST_FILE = 50_000_000


def _decades(study: Mapping[str, Any]) -> list[str]:
    """Return the times of all methods of a work-precision study as lines of text, one column for each power of ten.

    A column is for the runs whose error is at most this power of ten.
    """
    table = study["decades"]
    names = list(dict.fromkeys(name for row in table for name in row["methods"]))
    rows = [["error <=", *(f"{row['error']:.0e}" for row in table)]]
    rows.append(["fastest, us", *(_short(row["seconds"] * 1e6) for row in table)])
    for name in names:
        cells = [_short(row["methods"][name]["ratio"]) if name in row["methods"] else "-" for row in table]
        # the ratio of the method's time to the shortest time that reaches the error
        rows.append([name, *("1" if name == row["fastest"] else cell for cell, row in zip(cells, table, strict=True))])
    return columns(rows, width=room(200), wrap=0, right=range(1, len(rows[0])))


def _short(value: float) -> str:
    """Return a positive number as short text, about five characters: 1.234 -> "1.23"; "-" if infinite or NaN."""
    if not math.isfinite(value):
        return "-"
    if value >= 1e5:
        return f"{value:.0e}"
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def _floors(runs: Sequence[Mapping[str, Any]]) -> list[str]:
    rows = [["method", "least error", "at tolerance", "takes", "steps"]]
    for name in dict.fromkeys(run["method"] for run in runs):
        run = min((run for run in runs if run["method"] == name), key=lambda run: float(run["error"]))
        tolerance = f"{run['tolerance']:.0e}" if run["tolerance"] else ""
        rows.append(
            [name, f"{run['error']:.1e}", tolerance, duration(run["seconds"]), str(run["steps"] or "none")]
        )  # fmt: skip
    return columns(rows, right=(1, 2, 3, 4))


def _against(study: Mapping[str, Any]) -> list[str]:
    rows = [["time divided by that of", "symrot's steppers", "least", "symrot", "least"]]
    for row in study["against"]:
        cells = [
            _short(row[key][what]) if key in row else "-" for key in ("stepped", "all") for what in ("median", "least")
        ]
        rows.append([row["peer"], *cells])
    return columns(rows, right=(1, 2, 3, 4)) if len(rows) > 1 else []


def lines(study: Mapping[str, Any]) -> list[str]:
    """Return the lines of text that `symrot bench SCENE` prints about a study; the first line is a title.

    ``study`` is the result of :func:`symrot.bench.comparison.work_precision.study`.
    """
    scene, reference, machine = study["scene"], study["reference"], study["machine"]
    others = [f"{other['name']} within {max(other['difference'], ROUNDING):.0e}" for other in reference["others"]]
    versions = [f"{name} {machine[name]}" for name in ("python", "numpy", "scipy", "heyoka") if machine[name]]
    title = f"{one_line(scene['title'])} [{one_line(scene['name'])}]: time against error"
    head = fields(
        [
            ("span", f"{' to '.join(apart(*scene['span']))} s; the error is the maximum over four times in it, "
                     "attitude in rad, angular velocity relative to its size"),
            ("reference", "; ".join([reference["name"], *(others or ["not compared with a second reference"])])),
            ("machine", f"{machine['processor']}; {', '.join(versions)}"),
            ("times", "processor time of a call from Python, median of all repetitions; of the runs of a method that "
                      "are accurate enough, the fastest counts"),
        ]
    )  # fmt: skip
    skipped = fields([(f"{item['method']}:", one_line(item["why"])) for item in study["skipped"]])
    parts: list[Iterable[str]] = [[title], [f"  {line}" for line in head]]
    title = (
        "for each power of ten of the error: time of the fastest method, and how many times as long each method takes"
    )
    parts += [[line.strip() for line in fields([("", title)])]]
    parts[-1] = [*parts[-1], *(f"  {line}".rstrip() for line in _decades(study))]
    for name, table in (("ratios of times, median over the powers of ten of the error", _against(study)),
                        ("where each method ends", _floors(study["runs"])), ("left out", skipped)):  # fmt: skip
        if table:
            parts.append([name, *(f"  {line}".rstrip() for line in table)])
    return [line for number, part in enumerate(parts) for line in ([] if number == 0 else [""]) + list(part)]


# --- two studies ------------------------------------------------------------------------------------------------------


def read_study(path: Path) -> dict[str, Any]:
    """Return a work-precision study from a file that ``symrot bench SCENE --out`` wrote.

    Raises
    ------
    InputError
        If the file cannot be read, or is not a study.
    """
    label = repr(str(path))
    try:
        study = json.loads(read_input(path, LARGEST_FILE))
    except OSError as reason:
        expectation = f"a study of `symrot bench`, of at most {LARGEST_FILE // 1_000_000} MB"
        raise InputError(f"{label}: expected {expectation}, got {reason.strerror or reason}") from None
    except (ValueError, RecursionError):
        raise InputError(f"{label}: expected a study of `symrot bench` as JSON, got text that is not JSON") from None
    if not isinstance(study, dict) or study.get("format") != FORMAT:
        raise InputError(f"{label}: expected a study of `symrot bench` of the format {FORMAT!r}, got another format")
    try:
        whole = _positive(study) and bool(lines(study))
    except (KeyError, TypeError, AttributeError, ValueError, IndexError, OverflowError):
        whole = False
    if not whole:
        raise InputError(
            f"{label}: expected a whole study of `symrot bench`, got a study with missing parts or impossible numbers"
        )
    return study


def _positive(study: Mapping[str, Any]) -> bool:
    """Return whether the numbers of a study make sense: all times positive and finite, and no error negative."""
    times = [cell["seconds"] for row in study["decades"] for cell in (row, *row["methods"].values())]
    errors = [run["error"] for run in study["runs"]] + [row["error"] for row in study["decades"]]
    times += [run["seconds"] for run in study["runs"]]
    return all(0.0 < value < math.inf for value in times) and all(value >= 0.0 for value in errors)


def compared(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, Any]:
    """Return a comparison of two studies of one scene, such as before and after a change, as data.

    Raises
    ------
    InputError
        If the studies are of different scenes. Also if they have no ratio in common: no method whose error reaches the
        same power of ten, such as 1e-9, in both studies.
    """
    names = [study["scene"]["name"] for study in (first, second)]
    if names[0] != names[1]:
        raise InputError(f"--compare: expected two studies of the same scene, got {names[0]!r} and {names[1]!r}")
    if len({study["scene"].get("digest") for study in (first, second)}) > 1:
        raise InputError(
            "--compare: expected two studies of the same scene, got two different motions with the "
            f"same name {names[0]!r}"
        )
    before = {row["error"]: row["methods"] for row in first["decades"]}
    methods: dict[str, Any] = {}
    for row in second["decades"]:
        for name, now in row["methods"].items():
            then = before.get(row["error"], {}).get(name)
            if then:
                methods.setdefault(name, {})[f"{row['error']:.0e}"] = now["seconds"] / then["seconds"]
    floors = [_least_errors(study) for study in (first, second)]
    if not methods:
        raise InputError(
            "--compare: expected a method that both studies measured at the same error, such as 1e-9, got none; "
            "measure both studies with the same methods"
        )
    return {
        "format": "symrot comparison 1",
        "scene": second["scene"],
        "machines": [study["machine"] for study in (first, second)],
        "ratios": {
            name: {
                # the ratio of the times at each power of ten of the error
                "decades": ratios, "mean": geometric_mean(ratios.values()),
                "least errors": [floor[name] for floor in floors],
            } for name, ratios in methods.items()
        },
    }  # fmt: skip


def _least_errors(study: Mapping[str, Any]) -> dict[str, float]:
    errors: dict[str, float] = {}
    for run in study["runs"]:
        errors[run["method"]] = min(run["error"], errors.get(run["method"], math.inf))
    return errors


def lines_of_comparison(comparison: Mapping[str, Any]) -> list[str]:
    """Return lines of text about two studies; ``comparison`` is the data of :func:`compared`."""
    errors = sorted(
        {error for item in comparison["ratios"].values() for error in item["decades"]}, key=float, reverse=True
    )
    rows = [["method", *errors, "mean", "least error", "before"]]
    for name, item in comparison["ratios"].items():
        cells = [_short(item["decades"][error]) if error in item["decades"] else "-" for error in errors]
        before, now = item["least errors"]
        rows.append([name, *cells, _short(item["mean"]), f"{now:.1e}", f"{before:.1e}"])
    scene = comparison["scene"]
    title = f"{one_line(scene['title'])} [{one_line(scene['name'])}]: time of the second study divided by"
    same = comparison["machines"][0]["processor"] == comparison["machines"][1]["processor"]
    note = [] if same else ["", "The two studies were run on different machines."]
    table = columns(rows, width=room(200), wrap=0, right=range(1, len(rows[0])))
    return [f"{title} the time of the first", "", *table, *note]
