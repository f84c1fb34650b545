"""The figure of a work-precision study: time against error, one curve for each method, labelled at its end.

Both axes are logarithmic; errors become smaller to the right, and times become shorter downward. A curve joins the runs
for which no other run of the same method is both faster and more accurate; the other runs are faint points.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from symrot import __version__
from symrot.report.layout import apart
from symrot.report.picture import GREY, draw, literal

__all__ = ["LOOKS", "METHOD_LABELS", "OTHER", "OUTERMOST", "figure", "frontier", "save"]

LEAST_ERROR = 1e-17  # smaller errors, such as zero, are drawn as this error
APART = 0.042  # least distance between two names, relative to the panel's height
OUTERMOST = 1.5  # runs with this error or a larger one are not shown


class Look(NamedTuple):
    """How a method's curve is drawn in every figure: its colour, marker, line width and dash pattern of matplotlib."""

    colour: str
    marker: str
    width: float
    dashes: Any = "-"


# Okabe & Ito, 2008; methods of one kind share a colour and differ in marker and dash
LOOKS: dict[str, Look] = {
    "exact": Look("#000000", "D", 2.0),
    "exact with set-up": Look("#000000", "d", 1.2, (0, (1, 1))),
    "taylor": Look("#0072B2", "o", 2.4),
    "dop853": Look("#56B4E9", "s", 2.0),
    "symrot scipy": Look("#56B4E9", "v", 1.2, (0, (4, 2))),
    "heyoka": Look("#D55E00", "o", 1.8),
    "heyoka fast math": Look("#D55E00", "^", 1.0, (0, (4, 2))),
    "heyoka high accuracy": Look("#D55E00", "x", 1.0, (0, (1, 1))),
    "heyoka compact": Look("#D55E00", "+", 1.0, (0, (6, 2, 1, 2))),
    "SciPy DOP853": Look("#009E73", "s", 1.6),
    "SciPy RK45": Look("#009E73", "^", 1.0, (0, (4, 2))),
    "SciPy LSODA": Look("#CC79A7", "o", 1.6),
    "SciPy Radau": Look("#E69F00", "v", 1.6),
}
OTHER = Look("#606060", ".", 1.0)
METHOD_LABELS = {
    "exact": "exact",
    "taylor": "symrot Taylor",
    "dop853": "symrot DOP853",
    "symrot scipy": "symrot, no compiler",
}


def frontier(runs: Sequence[Mapping[str, Any]]) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Split the runs of a method into two lists of points (error, time): the points of its curve, and the others.

    A run is on the curve if no more accurate run is as fast. Both lists are in the order of increasing errors. Runs
    with an error of ``OUTERMOST`` or more are left out.
    """
    points = sorted((max(float(run["error"]), LEAST_ERROR), float(run["seconds"])) for run in runs)
    points = [point for point in points if point[0] < OUTERMOST]
    # the curve: no other run is both faster and more accurate
    best: list[tuple[float, float]] = []
    rest: list[tuple[float, float]] = []
    least = float("inf")
    for point in points:  # in order of increasing error: each point must be faster than all before it
        (best if point[1] < least else rest).append(point)
        least = min(least, point[1])
    return best, rest


def _names(axes: Any, ends: list[tuple[float, str, str]]) -> None:
    """Write the names of methods at the right edge of a plot, close to the ends of their curves, without overlap.

    ``ends`` are (time at the end of the curve, name, colour).
    """
    low, high = np.log10(axes.get_ylim())
    ends = sorted(ends)
    heights = [(np.log10(value) - low) / (high - low) for value, *_ in ends]
    placed: list[float] = []
    for height in heights:
        placed.append(max(height, placed[-1] + APART) if placed else height)
    # move names that are above the top down again
    for number in range(len(placed) - 1, -1, -1):
        ceiling = 1.0 if number == len(placed) - 1 else placed[number + 1] - APART
        placed[number] = min(placed[number], ceiling)
    for (_, name, colour), place, wished in zip(ends, placed, heights, strict=True):
        axes.annotate(
            name, (1.0, wished), (1.045, place), xycoords="axes fraction", textcoords="axes fraction", va="center",
            color=colour, fontsize=9, annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.6, "shrinkA": 1, "shrinkB": 0,
                        "relpos": (0.0, 0.5)},
        )  # fmt: skip


def figure(study: Mapping[str, Any]) -> Any:
    """Return a matplotlib Figure of a work-precision study: time against error, one curve for each method."""
    from matplotlib.figure import Figure

    page = Figure(figsize=(8.0, 5.4))
    axes = page.add_axes((0.09, 0.145, 0.665, 0.7))
    axes.set_xscale("log")
    axes.set_yscale("log")
    ends, least, most = [], 1.0, 0.0
    for name in dict.fromkeys(run["method"] for run in study["runs"]):
        best, rest = frontier([run for run in study["runs"] if run["method"] == name])
        if not best:
            continue
        look = LOOKS.get(name, OTHER)
        errors, seconds = zip(*best, strict=True)
        axes.plot(
            errors, seconds, color=look.colour, marker=look.marker, linewidth=look.width, linestyle=look.dashes,
            markersize=4.2, markeredgewidth=1.0, zorder=3,
        )  # fmt: skip
        if rest:
            axes.plot(*zip(*rest, strict=True), color=look.colour, marker=look.marker, linestyle="", markersize=3,
                      alpha=0.25, zorder=2)  # fmt: skip
        ends.append((seconds[0], METHOD_LABELS.get(name, name), look.colour))
        least, most = min(least, errors[0]), max(most, errors[-1])
    axes.set_xlim(min(most * 3, OUTERMOST), max(least / 3, LEAST_ERROR))
    doubt = min((other["difference"] for other in study["reference"]["others"]), default=0.0)
    right = axes.get_xlim()[1]
    if doubt > right:
        axes.axvspan(doubt, right, color="#f0f0f0", zorder=0)
        axes.annotate(" references differ", (doubt, 1.0), xycoords=("data", "axes fraction"), color=GREY, fontsize=8,
                      rotation=90, va="top", ha="left")  # fmt: skip
    axes.grid(True, which="major")
    axes.tick_params(which="minor", length=2, color="#b0b0b0")
    axes.set_xlabel("error, maximum over four times: attitude in rad, angular velocity relative")
    axes.set_ylabel("processor time of one call, s")
    page.canvas.draw()
    _leaders(axes, study)
    _names(axes, ends)
    _words(page, study)
    return page


def _leaders(axes: Any, study: Mapping[str, Any]) -> None:
    """Draw a faint line from the last point of each curve to its name at the right edge."""
    right = axes.get_xlim()[1]
    for name in dict.fromkeys(run["method"] for run in study["runs"]):
        best, _ = frontier([run for run in study["runs"] if run["method"] == name])
        if best:
            error, seconds = best[0]
            colour = LOOKS.get(name, OTHER).colour
            axes.plot((error, right), (seconds, seconds), color=colour, linewidth=0.6, alpha=0.5, zorder=1)


def _words(page: Any, study: Mapping[str, Any]) -> None:
    scene, machine, reference = study["scene"], study["machine"], study["reference"]
    page.text(0.02, 0.965, literal(scene["title"])[:75], fontsize=13, fontweight="bold", va="top")
    versions = ", ".join(f"{name} {machine[name]}" for name in ("scipy", "heyoka") if machine[name])
    line = f"t = {' to '.join(apart(*scene['span']))} s, one core of {machine['processor']}; {versions}"
    page.text(0.02, 0.915, literal(line)[:130], fontsize=8.5, color=GREY, va="top")
    others = "; ".join(f"{other['name']} within {max(other['difference'], 1e-16):.0e}" for other in reference["others"])
    caption = f"reference: {reference['name']}" + (f"; {others}" if others else "")
    page.text(0.02, 0.018, literal(caption), fontsize=7.5, color=GREY)
    page.text(0.985, 0.018, f"symrot {__version__}", fontsize=7.5, color=GREY, ha="right")


def save(study: Mapping[str, Any], path: Path) -> None:
    """Draw a work-precision study into a file.

    Parameters
    ----------
    study : mapping
        The result of :func:`symrot.bench.comparison.work_precision.study`, or the content of its file.
    path : Path
        The file to write; its suffix, ``.png``, ``.pdf`` or ``.svg``, decides the format.
    """
    draw(lambda: figure(study), path)
