"""The benchmark suite: a work-precision study of one motion of each kind, with figures and a table.

``symrot bench --suite`` writes into a folder (default ``generated/bench``) ``suite.png`` with ratios of times,
``motions.png`` with curves, ``suite.json`` with every study and ``suite.md`` with the table. After an interruption the
same command continues from ``unfinished.json``.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

from symrot import __version__
from symrot.bench.comparison.problem import Problem
from symrot.bench.comparison.work_precision import digest, machine, study
from symrot.errors import InputError
from symrot.files.reading import read_input
from symrot.files.writing import check_target, write
from symrot.report.layout import columns, one_line, room
from symrot.report.work_precision import LARGEST_FILE, ROUNDING
from symrot.scene.file import read_toml
from symrot.scene.scene import Scene, load_scene

__all__ = ["SUITE", "lines", "motions", "page", "run", "summary"]

SUITE = Path(__file__).with_name("suite.toml")
PEERS = ("heyoka", "heyoka, best setting", "SciPy DOP853", "SciPy RK45", "SciPy LSODA", "SciPy Radau")

Progress = Callable[[str], object]


def motions() -> dict[str, tuple[str, Scene]]:
    """Return a map from the name of each motion in the suite to (kind of motion in words, scene)."""
    scenes = {}
    for name, entry in read_toml(SUITE, SUITE.name).items():
        entry_scene = entry["scene"]
        scene = load_scene(entry_scene) if isinstance(entry_scene, str) else Scene.from_dict(entry_scene, name)
        scenes[name] = (str(entry["about"]), scene)
    return scenes


class _Checkpoint:
    """The finished studies of an interrupted run, stored in a file; a run with other settings ignores them."""

    def __init__(self, directory: Path, **settings: Any) -> None:
        self.path = directory / "unfinished.json"
        host = {name: value for name, value in machine().items() if name != "load"}
        self.settings = {"format": "symrot unfinished suite 1", "symrot": __version__, "machine": host, **settings}
        self.studies: dict[str, Any] = {}
        try:
            unfinished = json.loads(read_input(self.path, LARGEST_FILE))
            if isinstance(unfinished, dict) and isinstance(studies := unfinished.pop("studies", None), dict):
                self.studies = studies if unfinished == json.loads(json.dumps(self.settings)) else {}
        except (OSError, ValueError, RecursionError):
            self.studies = {}

    def add(self, name: str, one: dict[str, Any]) -> None:
        self.studies[name] = one
        text = json.dumps({**self.settings, "studies": self.studies})
        write(self.path, lambda stream: stream.write(text.encode("utf-8")))

    def done(self) -> None:
        self.path.unlink(missing_ok=True)


def run(
    directory: Path,
    methods: str | None,
    quick: bool,
    say: Progress,
    tolerances: Sequence[float] = (),
    rounds: int | None = None,
) -> tuple[dict[str, Any], list[str]]:
    """Study all motions of the suite, write the files, and return the results as data and as lines of text.

    Raises
    ------
    InputError
        If the folder cannot be created or written, or a method is unknown.
    SymrotError
        If no reference of a motion is available, or no other reference agrees with the first.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as reason:
        raise InputError(f"-o: the folder {str(directory)!r} cannot be created: {reason.strerror or reason}") from None
    check_target(directory / "suite.json", (".json",), "-o")
    drawing = find_spec("matplotlib") is not None
    finished = _Checkpoint(directory, methods=methods, quick=quick, tolerances=list(tolerances), rounds=rounds)
    earlier = len(finished.studies)
    studies, chosen = {}, motions()
    for number, (name, (about, scene)) in enumerate(chosen.items(), start=1):

        def tell(text: str, number: int = number) -> None:
            say(f"{number} of {len(chosen)}: {text}")

        one = finished.studies.get(name)
        if one is None or one["scene"]["digest"] != digest(Problem(scene)):
            began = perf_counter()
            one = {"about": about, **study(scene, methods, quick, tell, tolerances, rounds)}
            one["took"] = perf_counter() - began
            finished.add(name, one)
        studies[name] = one
    results = {"format": "symrot suite 1", "studies": studies, "summary": summary(studies)}
    texts = {"suite.json": _compact(results), "suite.md": page(results)}
    for file, text in texts.items():
        write(directory / file, lambda stream, text=text: stream.write(text.encode("utf-8")))  # type: ignore[misc]
    if drawing:
        from symrot.report.suite_plot import save

        save(results, directory)
    finished.done()
    note = [] if drawing else ["", "No figures: matplotlib is not installed (pip install 'symrot[plot]')."]
    if earlier:
        note += ["", f"{earlier} of {len(studies)} motions come from an earlier run, which was interrupted."]
    return results, [*lines(results), *note, "", f"written to {directory}"]


def _compact(results: Mapping[str, Any]) -> str:
    """Return the results of the suite as JSON text, one line per motion; numbers other than states have four digits."""
    studies = results["studies"].items()
    rows = ",\n".join(f"{json.dumps(name)}: {json.dumps(_short(one), ensure_ascii=False)}" for name, one in studies)
    rest = ",\n".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in results.items() if key != "studies")
    return f'{{{rest},\n"studies": {{\n{rows}\n}}}}\n'


def _short(value: Any, name: str = "") -> Any:
    if isinstance(value, dict):
        return {key: _short(each, key) for key, each in value.items()}
    if isinstance(value, list):
        return [_short(each, name) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float) and name != "states" else value


def summary(studies: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return, for each other program, the median and the smallest of its times divided by those of symrot's steppers.

    There is one ratio for each motion and each power of ten of the error, such as 1e-6, that both symrot and the other
    program reach. A program without ratios is left out.
    """
    rows = []
    for peer in PEERS:
        ratios = [
            ratio
            for one in studies.values()
            for item in one["against"]
            if item["peer"] == peer
            for ratio in item.get("stepped", {}).get("ratios", {}).values()
        ]
        if ratios:
            rows.append({"peer": peer, "median": median(ratios), "least": min(ratios), "decades": len(ratios)})
    return rows


def _cell(one: Mapping[str, Any], peer: str) -> str:
    comparison = next((item for item in one["against"] if item["peer"] == peer and "stepped" in item), None)
    return _ratio(comparison["stepped"]["median"], comparison["stepped"]["least"]) if comparison else "-"


def _ratio(middle: float, least: float) -> str:
    """Return the text for a median and a smallest ratio: ``(12.3, 3.4)`` gives ``"12 (3.4)"``."""
    return " ".join(
        form.format(f"{value:.{0 if value >= 10 else 1}f}") for form, value in (("{}", middle), ("({})", least))
    )


def _least(one: Mapping[str, Any], method: str) -> str:
    errors = [run["error"] for run in one["runs"] if run["method"] == method]
    return f"{max(min(errors), ROUNDING):.0e}" if errors else "-"


def _rows(results: Mapping[str, Any]) -> list[list[str]]:
    studies = results["studies"].values()
    peers = [peer for peer in PEERS if any(item["peer"] == peer for one in studies for item in one["against"])]
    head = ["motion", *(peer.removeprefix("SciPy ") for peer in peers), "error: exact", "Taylor", "heyoka", "doubt"]
    rows = [head]
    for one in studies:
        doubt = min((other["difference"] for other in one["reference"]["others"]), default=None)
        rows.append(
            [
                one["about"], *(_cell(one, peer) for peer in peers),
                *(_least(one, method) for method in ("exact", "taylor", "heyoka")),
                "-" if doubt is None else f"{max(doubt, ROUNDING):.0e}",
            ]
        )  # fmt: skip
    overall = {item["peer"]: _ratio(item["median"], item["least"]) for item in results["summary"]}
    rows.append(["all motions and decades", *(overall.get(peer, "-") for peer in peers), "", "", "", ""])
    return rows


LEGEND = (
    "Time of each method divided by the time of symrot's steppers (without closed forms) at equal error: the median "
    "over the powers of ten of the error from 1e-2 down, and in brackets the least ratio. Then the least error of "
    "each method, and the difference between the references. Processor time of calls from Python, medians over "
    "rounds, on one core."
)


def lines(results: Mapping[str, Any]) -> list[str]:
    """Return, as lines of text with a title, a table of times of other methods divided by symrot's times.

    The table has a row for each motion of the benchmark suite; ``results`` come from :func:`run`.
    """
    rows = _rows(results)
    table = columns(rows, width=room(220), wrap=0, right=range(1, len(rows[0])))
    return [
        "The suite: times of other methods divided by symrot's, at equal error",
        "",
        *table,
        "",
        *columns([[LEGEND]]),
    ]


def page(results: Mapping[str, Any]) -> str:
    """Return the table of the suite as a Markdown page that names the machine; ``results`` come from :func:`run`."""
    head, *rows = _rows(results)
    one = next(iter(results["studies"].values()))
    machine = one["machine"]
    versions = ", ".join(f"{name} {machine[name]}" for name in ("python", "numpy", "scipy", "heyoka") if machine[name])
    text = ["# Time against error", "", "", ""]
    quick, took = " --quick" if one["quick"] else "", sum(each["took"] for each in results["studies"].values())
    text[2] = f"Printed by `symrot bench --suite{quick}` in {took / 60.0:.0f} minutes, on one machine."
    loads = [each["machine"]["load"][0] for each in results["studies"].values() if each["machine"]["load"]]
    busy = f"; {machine['cores']} cores under a load of {min(loads):.1f} to {max(loads):.1f}" if loads else ""
    text += [LEGEND, "", f"{one_line(machine['processor'])}{busy}; {versions}.", ""]
    text += [f"| {' | '.join(head)} |", f"| --- |{' ---: |' * (len(head) - 1)}"]
    text += [f"| {' | '.join(row)} |" for row in rows]
    text += ["", "![ratios of all motions](suite.png)", ""]
    text += ["![time against error of each motion](motions.png)"]
    return "\n".join(text) + "\n"
