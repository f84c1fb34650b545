"""The figure of the operations and the time that kernels of single scenes save, compared with a general kernel."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from symrot import __version__
from symrot.report.picture import COLOURS, GREY, draw

__all__ = ["figure", "save"]

PANELS = (
    ("operations", 1.0, "operations of one evaluation"),
    ("evaluation", 1e-9, "ns of one evaluation in C"),
    ("motion", 1e-6, "µs of a call from Python for the motion"),
)
GENERAL, OWN, AUTO = COLOURS[1], COLOURS[0], COLOURS[6]
LEAST = 0.6  # smaller values, such as 0 operations, are drawn here on the logarithmic axis


def figure(measurements: Mapping[str, Any]) -> Any:
    """Return a matplotlib Figure that compares kernels made for one scene with the general kernel: operations and time.

    ``measurements`` is the result of :func:`symrot.bench.skip.measure`; the figure has one row for each motion.
    """
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    rows = measurements["rows"]
    page = Figure(figsize=(9.6, 1.6 + 0.38 * len(rows)))
    grid = page.add_gridspec(1, len(PANELS), left=0.245, right=0.985, top=0.83, bottom=0.14, wspace=0.08)
    for number, (key, unit, title) in enumerate(PANELS):
        axes = page.add_subplot(grid[number])
        axes.set_xscale("log")
        for height, row in enumerate(rows):
            ends = [
                None if row[side][key] is None else max(row[side][key] / unit, LEAST) for side in ("general", "own")
            ]
            if None not in ends:
                pair: Any = tuple(ends)
                axes.plot(pair, (height, height), color="#c8c8c8", linewidth=2.0, zorder=1)
            for end, colour, marker in zip(ends, (GENERAL, OWN), "os", strict=True):
                if end is not None:
                    axes.plot(end, height, marker, color=colour, markersize=6, zorder=2)
            if key == "motion":
                axes.plot(row["auto"][key] / unit, height, "D", color=AUTO, markersize=4, zorder=3)
            if key == "operations":
                axes.annotate(f"{row['own'][key]}", (ends[1], height), (-7, 0), textcoords="offset points",
                              va="center", ha="right", fontsize=7.5, color=OWN)  # fmt: skip
        axes.set_ylim(len(rows) - 0.5, -0.6)
        axes.set_yticks(range(len(rows)), [row["motion"] for row in rows] if number == 0 else [""] * len(rows))
        axes.tick_params(axis="y", length=0)
        axes.grid(True, axis="x")
        axes.set_xlabel(title)
        low, high = axes.get_xlim()
        axes.set_xlim(low / 2, high * 1.2)
    page.text(0.02, 0.965, "Operations and time saved by leaving out terms that a motion does not need", fontsize=13,
              fontweight="bold", va="top")  # fmt: skip
    looks = (("general kernel: full tensor, all torques", "o", GENERAL, 6), ("the scene's own", "s", OWN, 6),
             ("what auto takes", "D", AUTO, 4))  # fmt: skip
    handles = [Line2D([], [], color=colour, marker=marker, markersize=size, linestyle="", label=words)
               for words, marker, colour, size in looks]  # fmt: skip
    page.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.237, 0.905), ncols=3, handletextpad=0.2)
    page.text(0.985, 0.02, f"symrot {__version__}", fontsize=7.5, color=GREY, ha="right")
    return page


def save(measurements: Mapping[str, Any], path: Path) -> None:
    """Write to a file the figure that compares kernels made for one scene with the general kernel.

    ``measurements`` is the result of :func:`symrot.bench.skip.measure`. The suffix of ``path`` decides the format.
    """
    draw(lambda: figure(measurements), path)
