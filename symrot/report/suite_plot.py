"""The suite as one figure: how many times longer each peer takes, for every motion and every decade of the error."""

from collections.abc import Mapping
from pathlib import Path
from statistics import median
from typing import Any, BinaryIO

from symrot import __version__
from symrot.report.files import write
from symrot.report.plot import GREY, STYLE, UNDATED
from symrot.report.work_precision_plot import LOOKS, OTHER

__all__ = ["figure", "save"]

PEERS = ("heyoka", "heyoka, best setting", "SciPy LSODA", "SciPy DOP853", "SciPy RK45", "SciPy Radau")


def figure(found: Mapping[str, Any]) -> Any:
    """Return a matplotlib Figure of a suite: a row for each motion, a dot for each decade, a bar at the median."""
    from matplotlib.figure import Figure

    studies = list(found["studies"].values())
    peers = [peer for peer in PEERS if any(item["peer"] == peer for one in studies for item in one["against"])]
    if "heyoka, best setting" in peers:
        peers.remove("heyoka")
    page = Figure(figsize=(9.2, 1.6 + 0.42 * len(studies)))
    axes = page.add_axes((0.2, 0.14, 0.775, 0.68))
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
            ratios, height = list(item["stepped"]["ratios"].values()), row + (number - (len(peers) - 1) / 2) * step
            axes.plot(ratios, [height] * len(ratios), look.marker, color=look.colour, markersize=3.2, alpha=0.45,
                      label=peer if row == 0 else None, markeredgewidth=0)  # fmt: skip
            axes.plot([median(ratios)] * 2, (height - 0.45 * step, height + 0.45 * step), color=look.colour,
                      linewidth=2.4)  # fmt: skip
    axes.axvline(1.0, color="#000000", linewidth=1.0)
    axes.set_ylim(len(studies) - 0.5, -0.5)
    axes.set_yticks(range(len(studies)), [one["about"] for one in studies])
    axes.tick_params(axis="y", length=0)
    axes.grid(True, axis="x")
    axes.set_xlabel("times the time of symrot's steppers at equal error: a dot for each decade, a bar at the median")
    legend = axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 1.0), ncols=len(peers), handlelength=0.8,
                         columnspacing=1.4, markerscale=1.6)  # fmt: skip
    handles: Any = legend.legend_handles
    for handle in handles:
        handle.set_alpha(1.0)
    page.text(0.02, 0.97, "Time against error: others over symrot", fontsize=13, fontweight="bold", va="top")
    machine = studies[0]["machine"]
    versions = ", ".join(f"{name} {machine[name]}" for name in ("scipy", "heyoka") if machine[name])
    page.text(0.985, 0.965, f"{machine['processor']}; {versions}; symrot {__version__}", fontsize=7.5, color=GREY,
              va="top", ha="right")  # fmt: skip
    return page


def save(found: Mapping[str, Any], path: Path) -> None:
    """Draw a suite into a file, whose suffix decides the format."""
    import matplotlib

    suffix = path.suffix.lower()
    with matplotlib.rc_context({**matplotlib.rcParamsDefault, **STYLE}):
        page = figure(found)

        def draw(stream: BinaryIO) -> None:
            page.savefig(stream, format=suffix[1:], dpi=150, metadata=UNDATED[suffix])

        write(path, draw)
