"""The fixed suite: the work-precision study of one motion of each kind, its figures and its table.

``symrot bench --suite`` writes into a folder, ``generated/bench`` unless told otherwise: ``NAME.png`` for each motion,
``suite.png`` with the ratios of all, ``suite.json`` with every study, and ``suite.md``, which quotes them. Seconds are
those of one machine: these files are not held against anything by ``--check``.
"""

import json
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from typing import Any

from symrot.bench.work_precision import study
from symrot.errors import InputError
from symrot.report.files import write
from symrot.report.layout import columns, one_line
from symrot.report.work_precision import ROUNDING
from symrot.scene import Scene, load_scene
from symrot.scene_file import read_toml

__all__ = ["SUITE", "lines", "motions", "page", "run", "summary"]

SUITE = Path(__file__).with_name("suite.toml")
PEERS = ("heyoka", "heyoka, best setting", "SciPy DOP853", "SciPy RK45", "SciPy LSODA", "SciPy Radau")

Say = Callable[[str], object]


def motions() -> dict[str, tuple[str, Scene]]:
    """Return the motions of the suite: name -> what it is an example of, scene."""
    found = {}
    for name, entry in read_toml(SUITE, SUITE.name).items():
        given = entry["scene"]
        scene = load_scene(given) if isinstance(given, str) else Scene.from_dict(given, name)
        found[name] = (str(entry["about"]), scene)
    return found


def run(directory: Path, methods: str | None, quick: bool, say: Say) -> tuple[dict[str, Any], list[str]]:
    """Study every motion, write the files, and return data for JSON and lines for people.

    Raises
    ------
    InputError
        If the folder cannot be made.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as reason:
        raise InputError(f"-o: {str(directory)!r} cannot be made: {reason.strerror or reason}") from None
    drawing = find_spec("matplotlib") is not None
    studies = {}
    chosen = motions()
    for number, (name, (about, scene)) in enumerate(chosen.items(), start=1):

        def tell(text: str, number: int = number) -> None:
            say(f"{number} of {len(chosen)}: {text}")

        studies[name] = {"about": about, **study(scene, methods, quick, tell)}
        if drawing:
            from symrot.report.work_precision_plot import save

            save(studies[name], directory / f"{name}.png")
    found = {"format": "symrot suite 1", "studies": studies, "summary": summary(studies)}
    texts = {"suite.json": json.dumps(found, indent=1, ensure_ascii=False) + "\n", "suite.md": page(found)}
    for file, text in texts.items():
        write(directory / file, lambda stream, text=text: stream.write(text.encode("utf-8")))  # type: ignore[misc]
    if drawing:
        from symrot.report.suite_plot import save as save_suite

        save_suite(found, directory / "suite.png")
    note = [] if drawing else ["", "No figures: matplotlib is not installed (pip install 'symrot[plot]')."]
    return found, [*lines(found), *note, "", f"written to {directory}"]


def summary(studies: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return, for each peer, over all motions and decades: median and least of how many times longer it takes."""
    found = []
    for peer in PEERS:
        ratios = [
            ratio
            for one in studies.values()
            for item in one["against"]
            if item["peer"] == peer
            for ratio in item.get("stepped", {}).get("ratios", {}).values()
        ]
        if ratios:
            found.append({"peer": peer, "median": median(ratios), "least": min(ratios), "decades": len(ratios)})
    return found


def _cell(one: Mapping[str, Any], peer: str, side: str = "stepped") -> str:
    found = next((item for item in one["against"] if item["peer"] == peer and side in item), None)
    return f"{found[side]['median']:.3g} ({found[side]['least']:.2g})" if found else "-"


def _least(one: Mapping[str, Any], method: str) -> str:
    errors = [run["error"] for run in one["runs"] if run["method"] == method]
    return f"{max(min(errors), ROUNDING):.0e}" if errors else "-"


def _rows(found: Mapping[str, Any]) -> list[list[str]]:
    studies = found["studies"].values()
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
    overall = {item["peer"]: f"{item['median']:.3g} ({item['least']:.2g})" for item in found["summary"]}
    rows.append(["all motions and decades", *(overall.get(peer, "-") for peer in peers), "", "", "", ""])
    return rows


LEGEND = (
    "How many times the time of symrot's steppers (closed forms left out) each takes at equal error: median over the "
    "decades of the error from 1e-2 down, and the least in brackets. Then the least error that each reaches, and what "
    "the references differ by. Processor time of calls from Python, medians of turns, on one core."
)


def lines(found: Mapping[str, Any]) -> list[str]:
    """Return the lines for people; the first is the title."""
    rows = _rows(found)
    table = columns(rows, width=220, wrap=0, right=range(1, len(rows[0])))
    return ["The suite: times of others over symrot's, at equal error", "", *table, "", *columns([[LEGEND]])]


def page(found: Mapping[str, Any]) -> str:
    """Return the table as a Markdown page."""
    head, *rows = _rows(found)
    one = next(iter(found["studies"].values()))
    machine = one["machine"]
    versions = ", ".join(f"{name} {machine[name]}" for name in ("python", "numpy", "scipy", "heyoka") if machine[name])
    text = ["# Time against error", "", "Printed by `symrot bench --suite`; seconds are of one machine.", ""]
    text += [LEGEND, "", f"{one_line(machine['processor'])}; {versions}.", ""]
    text += [f"| {' | '.join(head)} |", f"| --- |{' ---: |' * (len(head) - 1)}"]
    text += [f"| {' | '.join(row)} |" for row in rows]
    text += ["", "![ratios of all motions](suite.png)", ""]
    text += [f"![{one['about']}]({name}.png)" for name, one in found["studies"].items()]
    return "\n".join(text) + "\n"
