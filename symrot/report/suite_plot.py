"""Two figures of a benchmark: times of other programs relative to symrot's, and curves of time against error."""

from collections.abc import Mapping
from pathlib import Path
from statistics import median
from typing import Any

from symrot import __version__
from symrot.report.picture import GREY, draw
from symrot.report.work_precision_plot import LOOKS, METHOD_LABELS, OTHER, OUTERMOST, frontier

__all__ = ["curves", "figure", "save"]

COLUMNS = 2
PEERS = ("heyoka", "heyoka, best setting", "SciPy LSODA", "SciPy DOP853", "SciPy RK45", "SciPy Radau")


def figure(suite: Mapping[str, Any]) -> Any:
    """Return a matplotlib Figure of other programs' times relative to symrot's at equal error, one row per motion."""
    from matplotlib.figure import Figure

    studies = list(suite["studies"].values())
    peers = [peer for peer in PEERS if any(item["peer"] == peer for one in studies for item in one["against"])]
    if "heyoka, best setting" in peers:
        peers.remove("heyoka")
    page = Figure(figsize=(8.0, 1.5 + 0.44 * len(studies)))
    axes = page.add_axes((0.205, 0.125, 0.775, 0.725))
    axes.set_xscale("log")
    step = 0.7 / max(len(peers), 1)
    for row, one in enumerate(studies):
        if row % 2:
            axes.axhspan(row - 0.5, row + 0.5, color="#f6f6f6", zorder=0)
        for number, peer in enumerate(peers):
            item = next((item for item in one["against"] if item["peer"] == peer and "stepped" in item), None)
            if item is None:
                continue
            look = LOOKS.get(peer.partition(",")[0], OTHER)
            # one dot per power of ten of the error
            ratios, height = list(item["stepped"]["ratios"].values()), row + (number - (len(peers) - 1) / 2) * step
            axes.plot(ratios, [height] * len(ratios), look.marker, color=look.colour, markersize=3.6, alpha=0.5,
                      label=peer if row == 0 else None, markeredgewidth=0)  # fmt: skip
            axes.plot([median(ratios)] * 2, (height - 0.45 * step, height + 0.45 * step), color=look.colour,
                      linewidth=2.4)  # fmt: skip
    axes.axvline(1.0, color="#000000", linewidth=1.2)
    axes.annotate("symrot", (1.0, 0.0), xycoords=("data", "axes fraction"), xytext=(-4, 5), rotation=90,
                  textcoords="offset points", va="bottom", ha="right", fontsize=8.5)  # fmt: skip
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_ylim(len(studies) - 0.5, -0.5)
    axes.set_yticks(range(len(studies)), [one["about"] for one in studies])
    axes.tick_params(axis="y", length=0)
    axes.grid(True, axis="x")
    axes.set_xlabel(
        "time divided by that of symrot's steppers at equal error; dots: powers of ten of the error, bars: medians"
    )
    if peers:
        legend = axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=len(peers), handlelength=0.8,
                             columnspacing=1.4, markerscale=1.6)  # fmt: skip
        handles: Any = legend.legend_handles
        for handle in handles:
            handle.set_alpha(1.0)
    page.text(0.02, 0.975, "Time relative to symrot, at equal error", fontsize=13, fontweight="bold", va="top")
    machine = studies[0]["machine"]
    versions = ", ".join(f"{name} {machine[name]}" for name in ("scipy", "heyoka") if machine[name])
    page.text(0.985, 0.97, f"{machine['processor']}; {versions}; symrot {__version__}", fontsize=7.5, color=GREY,
              va="top", ha="right")  # fmt: skip
    return page


def curves(suite: Mapping[str, Any]) -> Any:
    """Return a matplotlib Figure of time against error of all programs, one panel for each motion of the benchmark."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    studies = list(suite["studies"].values())
    rows = -(-len(studies) // COLUMNS)
    names = [name for name in LOOKS if any(run["method"] == name for one in studies for run in one["runs"])]
    height = 1.1 + 1.75 * rows  # inches
    page = Figure(figsize=(8.0, height))
    grid = page.subplots(rows, COLUMNS, sharex=True, sharey=True, squeeze=False,
                         gridspec_kw={"left": 0.085, "right": 0.985, "hspace": 0.2, "wspace": 0.04,
                                      "bottom": 0.5 / height, "top": 1 - 0.9 / height})  # fmt: skip
    for axes in grid.flat[len(studies) :]:
        axes.set_visible(False)
    for axes, one in zip(grid.flat, studies, strict=False):
        for name in names:
            best, _ = frontier([run for run in one["runs"] if run["method"] == name])
            look = LOOKS[name]
            if best:
                axes.plot(*zip(*best, strict=True), color=look.colour, marker=look.marker, markersize=2.6,
                          linewidth=0.7 * look.width, linestyle=look.dashes)  # fmt: skip
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.grid(True, which="major")
        axes.tick_params(which="minor", length=0)
        axes.set_title(one["about"], fontsize=9, pad=3)
    grid[0, 0].set_xlim(OUTERMOST, 1e-16)
    grid[0, 0].set_xticks([10.0**-k for k in range(0, 16, 4)])
    page.supxlabel("error, maximum over four times: attitude in rad, angular velocity relative", fontsize=9, y=0.008)
    page.supylabel("processor time of one call, s", fontsize=9, x=0.004)
    handles = [
        Line2D([], [], color=LOOKS[name].colour, marker=LOOKS[name].marker, markersize=4, linewidth=LOOKS[name].width,
               linestyle=LOOKS[name].dashes, label=METHOD_LABELS.get(name, name)) for name in names
    ]  # fmt: skip
    page.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.53, 0.998), ncols=4, fontsize=8)
    return page


def save(suite: Mapping[str, Any], directory: Path) -> None:
    """Draw the two figures of a suite into a folder: ``suite.png`` and ``motions.png``."""
    draw(lambda: figure(suite), directory / "suite.png", 130)
    draw(lambda: curves(suite), directory / "motions.png", 130)
