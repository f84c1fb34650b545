"""The plot of the report on numerical stability (:mod:`~symrot.bench.error_growth.stability`) on one page."""

from pathlib import Path
from typing import Any

import numpy as np

from symrot.report.layout import one_line
from symrot.report.picture import COLOURS, GREY, STYLE, save_page

__all__ = ["figure", "save"]

FLOOR = 4e-17  # smaller errors are not drawn
LOOKS: dict[str, dict[str, Any]] = {
    "exact": {"color": COLOURS[6], "linewidth": 1.8}, "taylor": {"color": COLOURS[0], "linewidth": 1.8},
    "taylor, plain": {"color": COLOURS[5], "linewidth": 1.2, "linestyle": (0, (5, 2))},
    "dop853": {"color": COLOURS[2], "linewidth": 1.6}, "SciPy DOP853": {"color": COLOURS[4], "linewidth": 1.6},
    "RK4, normalised": {"color": COLOURS[3], "linewidth": 3.0, "alpha": 0.45},
    "RK4": {"color": COLOURS[1], "linewidth": 1.2},
}  # fmt: skip


def figure(results: Any) -> Any:
    """Return the report on numerical stability as a Matplotlib figure; ``results`` come from ``stability``."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    data = results["growth"]
    flips = "omega" in data
    with rc_context(STYLE):
        page = Figure(figsize=(9.6, 8.4 if flips else 7.4), layout="constrained")
        rows = page.add_gridspec(3 if flips else 2, 6, height_ratios=[0.55, 1.6, 1.0] if flips else [1.6, 1.0])
        if flips:
            _rates(page.add_subplot(rows[0, :]), data)
        upper = int(flips)
        _curves(page.add_subplot(rows[upper, :3]), data, "attitude")
        _curves(page.add_subplot(rows[upper, 3:]), data, "invariants")
        _passes(page.add_subplot(rows[upper + 1, :3]), results["passes"])
        _points(page.add_subplot(rows[upper + 1, 3:]), results["points"])
        page.suptitle(
            f"Numerical stability: {one_line(data['title'])}", fontsize=12, fontweight="bold", x=0.01, ha="left"
        )
    return page


def _plottable(values: Any) -> Any:
    return np.array([np.nan if value is None else max(value, FLOOR) for value in values])


def _rates(axes: Any, data: Any) -> None:
    omega = np.array(data["omega"])
    for number in range(3):
        axes.plot(data["at"], omega[:, number], color=COLOURS[number], label=rf"$\omega_{number + 1}$")
    axes.set_xlim(data["at"][0], data["at"][-1])
    axes.grid(True)
    axes.set_title(f"Angular velocity in the body, {data['revolutions']:.0f} turns")
    axes.set_ylabel("rad/s")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=3, handlelength=1.4)


def _smoothed(values: Any, linear: bool) -> Any:
    """Return the errors ``values`` as they are plotted: unchanged, or for a linear time axis the running maximum."""
    if not linear:
        return values
    # This is smoother, because an error that changes its sign is small near its zeros.
    largest = np.fmax.accumulate(values)
    largest[np.isnan(values)] = np.nan
    return largest


def _curves(axes: Any, data: Any, what: str) -> None:
    linear, at = data["variable"] == "t", np.array(data["at"])
    for curve in data["curves"]:
        if what == "attitude":
            values = _plottable(curve["attitude"])
        else:
            drifts = [_plottable(v) for name, v in curve["invariants"].items() if name != "quaternion norm"]
            if not drifts:
                continue
            values = np.max(drifts, axis=0)
        axes.plot(at, _smoothed(values, linear), label=curve["method"], **LOOKS.get(curve["method"], {}))
    axes.set_yscale("log")
    if not linear:
        axes.set_xscale("log")
        _slopes(axes, at, (0.5, 1.0) if what == "invariants" else (1.5, 2.0))
    axes.set_xlim(at[0], at[-1])
    drawn = [line.get_ydata() for line in axes.get_lines() if line.get_label()[0] != "_"]
    most = max(float(np.nanmax(values)) for values in drawn) if drawn else 1.0
    axes.set_yticks(10.0 ** np.arange(-16, np.log10(most) + 1, 2))
    axes.tick_params(axis="y", which="minor", length=0)
    axes.set_ylim(FLOOR, most * (1e4 if what == "attitude" else 10.0))  # the legend stands above the curves
    axes.grid(True)
    axes.set_xlabel("t (s)" if linear else "revolutions")
    if what == "attitude":
        axes.set_title("Error of the attitude" + (", the largest so far" if linear else ""))
        axes.set_ylabel("error, rad")
        axes.legend(loc="upper left", fontsize=8, ncols=3)
    else:
        names = [name for name in data["curves"][0]["invariants"] if name != "quaternion norm"]
        short = ["angular momentum" if name.startswith("angular momentum") else name for name in names]
        axes.set_title(f"Drift of {', '.join(dict.fromkeys(short)) or 'nothing'}, relative")


def _slopes(axes: Any, at: Any, powers: tuple[float, ...]) -> None:
    """Draw lines that grow as the ``powers`` of the time, such as t and t^2, for comparison with the errors."""
    names = {0.5: "$t^{1/2}$", 1.0: "$t$", 1.5: "$t^{3/2}$", 2.0: "$t^2$"}
    for power in powers:
        # the size of rounding errors
        start = 2e-15 if power < 1.2 else 3e-14
        line = start * (at / at[0]) ** power
        axes.plot(at, line, color=GREY, linewidth=0.7, linestyle=(0, (1, 2)), zorder=1)
        axes.annotate(names[power], (at[-1], line[-1]), xytext=(-2, 3), textcoords="offset points", ha="right",
                      color=GREY, fontsize=8)  # fmt: skip


def _passes(axes: Any, rows: Any) -> None:
    names = {"quaternion": ("quaternion", COLOURS[0]), "switching": ("Euler angles, switched", COLOURS[2]),
             "angles": ("Euler angles, not switched", COLOURS[1])}  # fmt: skip
    near = [row for row in rows if row["distance"] > 0]
    for key, (label, colour) in names.items():
        points = [(row["distance"], row[key]["steps"]) for row in near if "steps" in row[key]]
        axes.plot(*zip(*points, strict=True), "o-", color=colour, label=label, markersize=3.5)
    axes.set_xscale("log")
    axes.tick_params(axis="x", which="minor", length=0)
    axes.invert_xaxis()
    axes.set_ylim(0, None)
    axes.grid(True)
    axes.set_title("Steps past gimbal lock, by state")
    axes.set_xlabel("least distance to gimbal lock (rad); at 0 only unswitched Euler angles fail")
    axes.set_ylabel("steps")
    axes.legend(loc="upper left")


def _points(axes: Any, rows: Any) -> None:
    motion = rows[-1]["motion"]
    chosen = [row for row in rows if row["motion"] == motion]
    names = {"tangent": COLOURS[1], "secant (midpoint)": COLOURS[0], "rotation": COLOURS[2]}
    steps = sorted({row["h"] for row in chosen}, reverse=True)
    width = 0.8 / len(names)
    for number, (name, colour) in enumerate(names.items()):
        values = [next(row["growth"] for row in chosen if row["scheme"] == name and row["h"] == h) for h in steps]
        places = np.arange(len(steps)) + (number - 1) * width
        axes.bar(places, np.array(values) - 1.0, width * 0.92, bottom=1.0, color=colour, label=name)
        for x, value in zip(places, values, strict=True):
            axes.annotate(f"{value:.3f}", (x, max(value, 1.0)), xytext=(0, 3), textcoords="offset points", ha="center",
                          fontsize=7, color=GREY)  # fmt: skip
    tangents = [next(row["derived"] for row in chosen if row["scheme"] == "tangent" and row["h"] == h) for h in steps]
    axes.plot(np.arange(len(steps)) - width, tangents, "_", color="black", markersize=16, markeredgewidth=1.4,
              label=r"law: $\prod\sqrt{1+h^2|\omega\times r|^2/|r|^2}$")  # fmt: skip
    axes.axhline(1.0, color=GREY, linewidth=0.8)
    axes.set_xticks(range(len(steps)), [f"h = {h:g} s" for h in steps])
    axes.set_ylim(0.95, 1.08 * max(row["growth"] for row in chosen))
    axes.set_axisbelow(True)
    axes.grid(True, axis="y")
    axes.set_title("Size of a body whose points move along their velocities for 10 s")
    axes.set_ylabel("size divided by the initial size")
    axes.legend(loc="upper right")


def save(results: Any, path: Path) -> None:
    """Draw the report ``results`` on numerical stability, and write the figure to the file ``path``."""
    save_page(figure(results), path, 140)
