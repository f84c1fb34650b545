"""The figure of one motion: angular velocity, attitude, conserved quantities, and paths on the sphere.

The module uses matplotlib's objects and the Agg canvas, without a window or global state. Equal motions give files with
equal bytes.
"""

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from symrot import __version__
from symrot.errors import InputError
from symrot.report.picture import COLOURS, GREY, draw, literal
from symrot.report.sphere import FAINT, draw_directions, prefixed

if TYPE_CHECKING:
    from symrot.propagation.trajectory import Trajectory

__all__ = ["PANELS", "SUFFIXES", "figure", "plot", "require_matplotlib", "save"]

Floats = NDArray[np.float64]

SUFFIXES = (".png", ".pdf", ".svg")
FEWEST, MOST, PER_STEP = 1500, 20_000, 6  # limits of the number of samples in a plot, and samples per step
WIDTHS = (2.0, 1.6, 1.2, 0.9)  # later curves are thinner and drawn on top, so that equal curves all stay visible
TIMES = ((4 * 86400.0, 86400.0, "days"), (4 * 3600.0, 3600.0, "h"), (0.0, 1.0, "s"))  # least span, factor, unit
QUIET = 0.01  # a component that changes by less than this fraction of its size may be written as text, not drawn


def require_matplotlib(option: str = "--plot") -> None:
    """Raise InputError if matplotlib is missing."""
    if find_spec("matplotlib") is None:
        raise InputError(
            f"{option}: expected matplotlib, but it is not installed; install it with pip install 'symrot[plot]'"
        )


def _times(trajectory: Any) -> tuple[Floats, str]:
    span = float(np.ptp(trajectory.t))
    _, size, unit = next(row for row in TIMES if span >= row[0])
    return trajectory.t / size, unit


def _lines(axes: Any, t: Floats, columns: Floats, names: list[str], unit: str) -> None:
    """Draw components over time; a nearly constant component that would flatten the others is written as text."""
    low, high = columns.min(axis=0), columns.max(axis=0)
    largest = np.maximum(np.abs(low), np.abs(high))
    steady = high - low <= QUIET * largest
    others = np.max(largest[~steady], initial=0.0)
    for number, name in enumerate(names):
        label, colour = name, COLOURS[number]
        if steady[number] and largest[number] > 3 * others > 0:
            ends = dict.fromkeys(f"{end:.6g}" for end in (low[number], high[number]))
            axes.plot([], [], " ", label=f"{name} = {' to '.join(ends)} {unit}")
        else:
            axes.plot(t, columns[:, number], color=colour, label=label, linewidth=WIDTHS[number])
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=len(names), handlelength=1.4, columnspacing=1.2)
    axes.grid(True)


def _unwrapped(angles: Floats, turn: float) -> Floats:
    """Return angles with NaN at each jump by more than half a rotation (``turn``), where the curve is interrupted."""
    gaps = np.zeros_like(angles, dtype=bool)
    gaps[1:] = np.abs(np.diff(angles)) > 0.5 * turn
    return np.where(gaps, np.nan, angles)


def _rates(axes: Any, t: Floats, trajectory: Any) -> None:
    changing = np.ptp(trajectory.omega, axis=0)
    size, unit = prefixed(float(np.max(changing) or np.max(np.abs(trajectory.omega))), "rad/s")
    _lines(axes, t, trajectory.omega / size, [rf"$\omega_{i}$" for i in (1, 2, 3)], unit)
    axes.set_title("Angular velocity in the body")
    axes.set_ylabel(unit)


def _attitude(axes: Any, t: Floats, trajectory: Any) -> None:
    sequence = trajectory.scene.output.sequence
    if sequence is None:
        _lines(axes, t, trajectory.quaternion, [f"$q_{i}$" for i in range(4)], "")
        axes.set_title("Attitude, quaternion body to space")
        axes.set_ylabel("quaternion (1)")
        return
    angles = trajectory.euler(sequence, degrees=True)
    kind = "intrinsic" if sequence.isupper() else "extrinsic"
    names = [rf"{axis} ({place})" for axis, place in zip(sequence, ("first", "second", "third"), strict=True)]
    for number, name in enumerate(names):
        angle = _unwrapped(angles[:, number], 360.0)
        axes.plot(t, angle, color=COLOURS[number], label=name, linewidth=WIDTHS[number])
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=3, handlelength=1.4, columnspacing=1.2)
    axes.grid(True)
    axes.set_title(f"Euler angles {sequence}, {kind}")
    axes.set_ylabel("deg")


def _drift(axes: Any, t: Floats, trajectory: Any, tolerance: float) -> None:
    axes.set_title("Drift of conserved quantities")
    axes.set_ylabel("relative to its size")
    axes.set_yscale("log")
    axes.set_autoscaley_on(False)  # the limits are set below, because a single flat line would give none
    changes = []
    for number, item in enumerate(trajectory.invariants):
        change = np.abs(item.values - item.values[0]) / (item.scale or 1.0)
        changes.append(change)
        visible_change = np.where(change > 0, change, np.nan)
        norm = item.name == "quaternion norm"  # the least informative curve is drawn behind the others
        colour = FAINT if norm else COLOURS[number % len(COLOURS)]
        axes.plot(t, visible_change, color=colour, linewidth=0.8, label=item.name, zorder=1.5 if norm else 2)
    axes.axhline(tolerance, color=GREY, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.annotate(f"tolerance {tolerance:g}", (0.0, tolerance), xycoords=("axes fraction", "data"), xytext=(4, 3),
                  textcoords="offset points", color=GREY, fontsize=8)  # fmt: skip
    positive = np.concatenate([change[change > 0] for change in changes] or [np.array([tolerance])])
    low, high = np.quantile(positive, [0.02, 1.0]) if len(positive) else (tolerance, tolerance)
    axes.set_ylim(0.3 * min(low, tolerance), 20 * max(high, tolerance))
    if not changes:
        axes.text(0.5, 0.65, "no conserved quantity is made of the integrated states", transform=axes.transAxes,
                  ha="center", color=GREY)  # fmt: skip
        return
    axes.legend(loc="upper left", bbox_to_anchor=(-0.04, -0.22), ncols=5, handlelength=1.0, columnspacing=1.0)
    axes.grid(True)


def _body_sphere(axes: Any, trajectory: Any) -> None:
    """Draw the path of a free body's angular momentum among other possible paths, or any other body's rotation axis."""
    torques = trajectory.scene.torques
    if any(kind != "rotor" for kind in trajectory.scene.torque_kinds):
        draw_directions(axes, trajectory.omega, ("1", "2", "3"))
        axes.set_title("Axis of rotation in the body")
        return
    inertia = np.array(trajectory.scene.body.inertia, dtype=float)
    rotor = np.zeros(3)
    for torque in torques:
        rotor += np.array(torque.vector("angular_momentum"), dtype=float)
    momentum = trajectory.angular_momentum_body
    size = float(np.linalg.norm(momentum[0]))

    def energy(directions: Floats) -> Floats:
        spin = size * directions - rotor
        energies: Floats = np.einsum("...i,...i->...", spin, spin @ np.linalg.inv(inertia)) / 2
        return energies

    axes.set_title("Angular momentum in the body")
    if draw_directions(axes, momentum, ("1", "2", "3"), energy):
        note = "thin: other paths, each of one energy"
        axes.text(0.5, -0.02, note, transform=axes.transAxes, ha="center", color=GREY)


def _space_sphere(axes: Any, trajectory: Any) -> None:
    symmetric = trajectory.scene.body.principal.symmetry_axis is not None
    name = "Symmetry axis" if symmetric else f"Body axis {trajectory.axis_number + 1}"
    draw_directions(axes, trajectory.axis, ("x", "y", "z"))
    axes.set_title(f"{name} in space")


OVER_TIME: dict[str, Callable[[Any, Floats, Any], None]] = {
    "rates": _rates,
    "attitude": _attitude,
    "drift": lambda axes, t, trajectory: _drift(axes, t, trajectory, trajectory.tolerance),
}
ON_SPHERES: dict[str, Callable[[Any, Any], None]] = {"body": _body_sphere, "space": _space_sphere}
PANELS = (*OVER_TIME, *ON_SPHERES)
"""The panels of a figure: angular velocity, attitude, drift of conserved quantities; paths in the body and in space."""


def plot(trajectory: "Trajectory", ax: Any = None, panel: str = "rates") -> Any:
    """Draw one panel of the figure of a motion into axes of matplotlib.

    Parameters
    ----------
    trajectory : Trajectory
        The motion; the panel joins its samples.
    ax : matplotlib Axes, optional
        The axes to draw into; default: axes of a new figure of ``matplotlib.pyplot``.
    panel : str
        ``"rates"``, the angular velocity in the body; ``"attitude"``, Euler angles if the scene has a sequence, else
        the quaternion; ``"drift"`` of the conserved quantities; ``"body"``, the path of the angular momentum or the
        axis of rotation in the body; ``"space"``, the path of the symmetry axis in space.

    Returns
    -------
    matplotlib Axes
        The axes.

    Raises
    ------
    InputError
        If there is no such panel, matplotlib is not installed, or the trajectory has no samples or no attitude to draw.

    Examples
    --------
    >>> import symrot
    >>> from matplotlib.figure import Figure
    >>> symrot.plot(symrot.propagate("t_handle"), Figure().add_subplot(), "space").get_title()
    'Body axis 3 in space'
    """
    if panel not in PANELS:
        raise InputError(f"panel: expected one of {', '.join(PANELS)}, got {panel!r}")
    require_matplotlib("plot")
    if not len(trajectory):
        raise InputError("plot: expected a trajectory with samples, got one without")
    if panel in ("attitude", "space"):
        trajectory.quaternion  # noqa: B018 - an error comes before a new figure
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots()[1]
    if getattr(ax, "name", "") == "3d":
        raise InputError("ax: expected axes in the plane, got axes in space; leave out projection='3d'")
    if panel in ON_SPHERES:
        ON_SPHERES[panel](ax, trajectory)
        return ax
    t, unit = _times(trajectory)
    OVER_TIME[panel](ax, t, trajectory)
    if t.min() < t.max():
        ax.set_xlim(t.min(), t.max())
    ax.set_xlabel(f"t ({unit})")
    return ax


def figure(trajectory: Any, tolerance: float) -> Any:
    """Return a matplotlib Figure of a motion: four panels on one page."""
    from matplotlib.figure import Figure

    page = Figure(figsize=(12.0, 8.0))
    attitude = trajectory.has_attitude
    left = page.add_gridspec(3 if attitude else 2, 1, left=0.065, right=0.6, top=0.865, bottom=0.125, hspace=0.48)
    right = page.add_gridspec(2 if attitude else 1, 1, left=0.7, right=0.985, top=0.865, bottom=0.095, hspace=0.3)
    t, unit = _times(trajectory)
    panels = [page.add_subplot(left[row]) for row in range(3 if attitude else 2)]
    _rates(panels[0], t, trajectory)
    if attitude:
        _attitude(panels[1], t, trajectory)
        _space_sphere(page.add_subplot(right[0]), trajectory)
    _body_sphere(page.add_subplot(right[-1]), trajectory)
    _drift(panels[-1], t, trajectory, tolerance)
    for panel in panels:
        panel.set_xlim(t[0], t[-1])
        panel.set_xlabel(f"t ({unit})", labelpad=1)
    _words(page, trajectory, tolerance)
    return page


def _words(page: Any, trajectory: Any, tolerance: float) -> None:
    scene, stats = trajectory.scene, trajectory.stats
    page.text(0.02, 0.972, literal(scene.title)[:100], fontsize=15, fontweight="bold", va="top")
    page.text(0.02, 0.928, literal(scene.source)[:170], fontsize=8.5, color=GREY, va="top")
    caption = (
        f"{literal(scene.name)}   |   {trajectory.method}, tolerance {tolerance:g}, {stats.accepted} steps   |   "
        f"paths run from the dot (dark) to the square (light)   |   symrot {__version__}"
    )
    page.text(0.98, 0.018, caption, fontsize=8, color=GREY, ha="right")


def save(propagator: Any, trajectory: Any, path: Path) -> None:
    """Draw a motion into a file; if the scene has too few or too many samples for a plot, propagate the motion again.

    Parameters
    ----------
    propagator, trajectory : Propagator, Trajectory
        The propagator, and the trajectory that it returned for the times of the scene.
    path : Path
        The file to write; its suffix, one of :data:`SUFFIXES`, decides the format.
    """
    count = min(max(FEWEST, len(trajectory), PER_STEP * trajectory.stats.accepted), MOST)
    if count != len(trajectory):
        span = trajectory.scene.span
        trajectory = propagator(np.linspace(float(span.start), float(span.stop), count))
    draw(lambda: figure(trajectory, propagator.tolerance), path, few_colours=False)
