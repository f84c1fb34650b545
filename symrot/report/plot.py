"""The figure of one motion: angular velocity, attitude, conserved quantities, and paths on the sphere.

The module uses matplotlib's objects and the Agg canvas, without a window or global state. Equal motions give files with
equal bytes.
"""

import re
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from symrot import __version__
from symrot.errors import InputError
from symrot.formula.exact_numbers import show
from symrot.report.curves import draw_curves, size_in_pixels
from symrot.report.picture import COLOURS, GREY, draw, literal
from symrot.report.sphere import FAINT, draw_directions, prefixed
from symrot.report.vertical import has_vertical, vertical_angles
from symrot.results.samples import MotionSamples, Samples

if TYPE_CHECKING:
    from symrot.propagation.trajectory import Trajectory

__all__ = ["PANELS", "SUFFIXES", "dense", "figure", "plot", "require_matplotlib", "save"]

Floats = NDArray[np.float64]

SUFFIXES = (".png", ".pdf", ".svg")
FEWEST, MOST = 4000, 120_000  # limits of the number of samples in a plot
PER_STEP, PER_RADIAN = 20, 16  # samples per step of the method, and per radian of the fastest rotation
TIMES = ((4 * 86400.0, 86400.0, "days"), (4 * 3600.0, 3600.0, "h"), (0.0, 1.0, "s"))  # least span, factor, unit
WIDE = 900.0  # pixels
GOLDEN = (5.0**0.5 - 1.0) / 2.0
DRIFT_WIDTHS = (1.6, 1.3)  # points
QUIET = 0.01  # a component that changes by less than this fraction of its size may be written as text, not drawn


def require_matplotlib(option: str = "--plot") -> None:
    """Raise InputError if matplotlib is missing; ``option`` is the option of the command line that needs it."""
    if find_spec("matplotlib") is None:
        raise InputError(
            f"{option}: expected matplotlib, but it is not installed; install it with pip install 'symrot[plot]'"
        )


def dense(trajectory: Any) -> Any:
    """Return the motion at as many times as a smooth picture needs.

    A motion without dense solution, or with samples at a single time, is returned unchanged.
    """
    from symrot.propagation.trajectory import Trajectory

    low, high = float(np.min(trajectory.t)), float(np.max(trajectory.t))
    if low == high or not isinstance(trajectory, Trajectory):  # motions of ensembles and of files have samples alone
        return trajectory
    radians = _fastest(trajectory) * (high - low)
    sufficient = max(float(FEWEST), PER_RADIAN * radians, float(PER_STEP * trajectory.stats.accepted))
    count = int(min(sufficient, MOST))
    times = np.linspace(low, high, count)
    if PER_RADIAN * radians > MOST:
        # Too few times to follow every rotation: they could all fall on the same few angles and show a slow motion. A
        # shift by multiples of the golden ratio modulo 1 makes them irregular.
        places = np.arange(1, count - 1)
        times[1:-1] += (np.mod(places * GOLDEN, 1.0) - 0.5) * (high - low) / (count - 1)
    return trajectory.at(times)


def _fastest(trajectory: Any) -> float:
    """Return an upper estimate of the fastest rate of rotation in a motion, rad/s.

    It is the largest angular velocity, plus the rate of the nutation that rotors cause.
    """
    moments = [float(moment) for moment in trajectory.scene.body.principal.moments]
    rotor = float(np.linalg.norm(_rotor(trajectory.scene)))
    return float(np.max(np.linalg.norm(trajectory.omega, axis=1))) + rotor / (min(moments) or max(moments))


def _rotor(scene: Any) -> Floats:
    """Return the angular momentum of all rotors of a scene, body components, shape (3,)."""
    total = np.zeros(3)
    for torque in scene.torques:
        if torque.kind == "rotor":
            total += np.array(torque.vector("angular_momentum"), dtype=float)
    return total


def _times(trajectory: Any) -> tuple[Floats, str]:
    span = float(np.ptp(trajectory.t))
    _, size, unit = next(row for row in TIMES if span >= row[0])
    return trajectory.t / size, unit


def _is_wide(axes: Any) -> bool:
    """Return whether axes are so wide that a title on the left and a legend on the right fit in one line above."""
    from matplotlib import rcParams

    return bool(rcParams["axes.titlelocation"] == "left" and size_in_pixels(axes)[0] >= WIDE)


def _legend(axes: Any) -> None:
    """Add the legend of the curves above the axes, or in a corner of axes that are too narrow for that."""
    count = len(axes.get_legend_handles_labels()[1])
    if _is_wide(axes):
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=count, handlelength=2.0, columnspacing=1.2)
    else:
        axes.legend(loc="upper right", ncols=count, handlelength=1.6, columnspacing=0.8, fontsize="small",
                    frameon=True, framealpha=0.85)  # fmt: skip


def _lines(axes: Any, t: Floats, columns: Floats, names: list[str], unit: str, size: float = 1.0) -> None:
    """Draw the components of a vector, one column for each of ``names``, over time, divided by ``size``."""
    low, high = columns.min(axis=0), columns.max(axis=0)
    largest = np.maximum(np.abs(low), np.abs(high))
    steady = high - low <= QUIET * largest
    others = np.max(largest[~steady], initial=0.0)
    # A nearly constant component that is much larger would make the others look flat: the legend states its value
    # instead.
    written = steady & (largest > 3 * others) & (others > 0)
    drawn = np.flatnonzero(~written)
    draw_curves(axes, t, [columns[:, i] / size for i in drawn], [names[i] for i in drawn], [COLOURS[i] for i in drawn])
    for number in np.flatnonzero(written):
        own, own_unit = prefixed(float(largest[number]), unit) if unit else (1.0, unit)
        ends = dict.fromkeys(f"{end / own:.6g}" for end in (low[number], high[number]))
        axes.plot([], [], " ", label=f"{names[number]} = {' to '.join(ends)} {own_unit}")
    _legend(axes)


def _unwrapped(angles: Floats, turn: float) -> Floats:
    """Return angles with NaN after each jump by more than half a rotation, so that their curve has a gap there.

    ``turn`` is a whole rotation in the unit of the angles.
    """
    gaps = np.zeros_like(angles, dtype=bool)
    gaps[1:] = np.abs(np.diff(angles)) > 0.5 * turn
    return np.where(gaps, np.nan, angles)


def _rates(axes: Any, t: Floats, trajectory: Any) -> None:
    changing = np.ptp(trajectory.omega, axis=0)
    size, unit = prefixed(float(np.max(changing) or np.max(np.abs(trajectory.omega))), "rad/s")
    _lines(axes, t, trajectory.omega, [rf"$\omega_{i}$" for i in (1, 2, 3)], "rad/s", size)
    axes.set_title("Angular velocity in the body")
    axes.set_ylabel(unit)


def _attitude(axes: Any, t: Floats, trajectory: Any) -> None:
    sequence = trajectory.scene.output.sequence
    if sequence is None:
        _lines(axes, t, trajectory.quaternion, [f"$q_{i}$" for i in range(4)], "")
        axes.set_title("Attitude, quaternion")
        axes.set_ylabel("body to space (1)")
        return
    angles = trajectory.euler(sequence, degrees=True)
    kind = "intrinsic" if sequence.isupper() else "extrinsic"
    names = [rf"$\{letter}$ about {axis}" for letter, axis in zip(("phi", "theta", "psi"), sequence, strict=True)]
    draw_curves(axes, t, [_unwrapped(column, 360.0) for column in angles.T], names)
    if np.ptp(angles) > 270.0:
        axes.set_yticks((-180, -90, 0, 90, 180))
    _legend(axes)
    axes.set_title(f"Euler angles {sequence}, {kind}")
    axes.set_ylabel("deg")


def _vertical(axes: Any, t: Floats, trajectory: Any) -> None:
    angles = vertical_angles(trajectory)
    columns = np.degrees(angles.columns)
    draw_curves(axes, t, [_unwrapped(column, 360.0) for column in columns.T], angles.names)
    _legend(axes)
    axes.set_title(angles.title)
    axes.set_ylabel("deg")


def _drift(axes: Any, t: Floats, trajectory: Any) -> None:
    """Draw, for each conserved quantity, its largest relative change so far over time, on a logarithmic scale.

    For comparison, a line shows the tolerance of the integration.
    """
    tolerance = trajectory.tolerance
    axes.set_title("Drift of conserved quantities, the largest so far")
    axes.set_ylabel("relative to its size")
    axes.set_yscale("log")
    axes.set_autoscaley_on(False)  # the limits are set below, because a single flat line would give none
    items = sorted(trajectory.invariants, key=lambda item: item.name != "quaternion norm")  # least informative: behind
    curves: list[Floats] = []
    names: list[str] = []
    colours: list[str] = []
    for item in items:
        change = np.maximum.accumulate(np.abs(item.values - item.values[0])) / (item.scale or 1.0)
        curves.append(np.where(change > 0, change, np.nan))
        name = re.sub(r"\bomega_(\d)", r"$\\omega_\1$", item.name)
        names.append(name if change[-1] > 0 else f"{name} (no change)")
        colours.append(FAINT if item.name == "quaternion norm" else COLOURS[len(colours) % len(COLOURS)])
    positive = np.concatenate([curve[np.isfinite(curve)] for curve in curves] or [np.array([tolerance])])
    low, high = (positive.min(), positive.max()) if len(positive) else (tolerance, tolerance)
    axes.set_ylim(0.3 * min(low, tolerance), 20 * max(high, tolerance))
    draw_curves(axes, t, curves, names, colours, DRIFT_WIDTHS)
    axes.axhline(tolerance, color=GREY, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.annotate(f"tolerance {tolerance:g}", (0.0, tolerance), xycoords=("axes fraction", "data"), xytext=(4, 3),
                  textcoords="offset points", color=GREY, fontsize=8)  # fmt: skip
    if not curves:
        axes.text(0.5, 0.65, "no conserved quantity can be formed from the integrated states", transform=axes.transAxes,
                  ha="center", color=GREY)  # fmt: skip
        return
    handles = sorted(axes.get_legend_handles_labels()[0], key=lambda handle: handle.get_label() == "quaternion norm")
    if _is_wide(axes):
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(-0.04, -0.22), ncols=4, handlelength=2.0,
                    columnspacing=1.0)  # fmt: skip
    else:
        axes.legend(handles=handles, loc="center right", ncols=2, handlelength=1.6, columnspacing=0.8, fontsize="small",
                    frameon=True, framealpha=0.85)  # fmt: skip


def _body_sphere(axes: Any, trajectory: Any) -> None:
    """Draw on a sphere, in body axes, the path of the angular momentum or, under torques, of the rotation axis."""
    if any(kind != "rotor" for kind in trajectory.scene.torque_kinds):
        draw_directions(axes, trajectory.omega, ("1", "2", "3"))
        axes.set_title("Axis of rotation in the body")
        return
    inertia = np.array(trajectory.scene.body.inertia, dtype=float)
    rotor = _rotor(trajectory.scene)
    momentum = trajectory.angular_momentum_body
    size = float(np.linalg.norm(momentum[0]))

    # thin curves: the paths at other energies
    def energy(directions: Floats) -> Floats:
        spin = size * directions - rotor
        energies: Floats = np.einsum("...i,...i->...", spin, spin @ np.linalg.inv(inertia)) / 2
        return energies

    axes.set_title("Angular momentum in the body")
    draw_directions(axes, momentum, ("1", "2", "3"), energy, "thin: other paths, each of one energy")


def _space_sphere(axes: Any, trajectory: Any) -> None:
    symmetric = trajectory.scene.body.principal.symmetry_axis is not None
    name = "Symmetry axis" if symmetric else f"Body axis {trajectory.axis_number + 1}"
    draw_directions(axes, trajectory.axis, ("x", "y", "z"))
    axes.set_title(f"{name} in space")


OVER_TIME: dict[str, Callable[[Any, Floats, Any], None]] = {
    "rates": _rates,
    "attitude": _attitude,
    "vertical": _vertical,
    "drift": _drift,
}
ON_SPHERES: dict[str, Callable[[Any, Any], None]] = {"space": _space_sphere, "body": _body_sphere}
PANELS = (*OVER_TIME, *ON_SPHERES)
"""The panels of a figure: angular velocity, attitude, angles to the vertical if the scene has one, drift of conserved
quantities; paths in the body and in space."""


def plot(trajectory: "Trajectory", ax: Any = None, panel: str = "rates") -> Any:
    """Draw one panel of the figure of a motion into axes of matplotlib.

    Parameters
    ----------
    trajectory : Trajectory
        The motion. The panel draws its dense solution between its first and its last sample. A motion that belongs to
        an ensemble, or was read from a file, has no dense solution: the panel then joins its samples by lines; samples
        on a sphere that are far apart stay points. A motion of an ensemble has no panel ``"drift"``, and a motion that
        was read from a file has only the panel ``"rates"``.
    ax : matplotlib Axes, optional
        The axes to draw into; default: axes of a new figure of ``matplotlib.pyplot``.
    panel : str
        ``"rates"``, the angular velocity in the body; ``"attitude"``, Euler angles if the scene has a sequence, else
        the quaternion; ``"vertical"``, the angles to the vertical of a body under gravity or of a satellite under a
        gravity gradient; ``"drift"`` of the conserved quantities; ``"body"``, the path of the angular momentum or the
        axis of rotation in the body; ``"space"``, the path of the symmetry axis, or else of a body axis, in space.

    Returns
    -------
    matplotlib Axes
        The axes.

    Raises
    ------
    InputError
        If there is no such panel, or none for this kind of motion; if matplotlib is not installed, or ``ax`` has three
        dimensions; if ``trajectory`` is not one motion, or has no samples or no attitude to draw; or if the panel needs
        a vertical and the scene has none.

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
    if not isinstance(trajectory, Samples):
        raise InputError(f"plot: expected a trajectory, such as symrot.propagate(scene), got {show(trajectory)}")
    if not len(trajectory):
        raise InputError("plot: expected a trajectory with samples, got a trajectory without samples")
    if np.ndim(trajectory.omega) != 2:
        raise InputError("plot: expected one motion, got an ensemble; plot one of its motions, such as ensemble[0]")
    if panel != "rates" and not isinstance(trajectory, MotionSamples):
        raise InputError(f"panel: expected 'rates' for a motion from a file, which has no scene, got {panel!r}")
    if panel == "drift" and not hasattr(trajectory, "invariants"):
        raise InputError("panel: expected a trajectory for 'drift', got one motion of an ensemble; propagate it alone")
    if panel == "vertical" and not has_vertical(trajectory.scene):
        raise InputError(
            "panel: expected for 'vertical' a scene with exactly one torque of the kind gravity or gravity_gradient"
        )
    if panel in ("attitude", "vertical", "space"):
        trajectory.quaternion  # noqa: B018 - an error comes before a new figure
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.subplots()[1]
    if getattr(ax, "name", "") == "3d":
        raise InputError("ax: expected axes in the plane, got axes in space; leave out projection='3d'")
    trajectory = dense(trajectory)
    if panel in ON_SPHERES:
        ON_SPHERES[panel](ax, trajectory)
        return ax
    t, unit = _times(trajectory)
    OVER_TIME[panel](ax, t, trajectory)
    if t.min() < t.max():
        ax.set_xlim(t.min(), t.max())
    ax.set_xlabel(f"t ({unit})")
    return ax


def figure(trajectory: Any) -> Any:
    """Return a matplotlib Figure with the panels that suit a motion, drawn from the samples of ``trajectory``."""
    from matplotlib.figure import Figure

    names = [name for name in OVER_TIME if name not in _left_out(trajectory)]
    height = 8.0 if len(names) < 4 else 10.0  # inches
    page = Figure(figsize=(12.0, height))
    top, bottom = 1.0 - 1.08 / height, 1.05 / height
    left = page.add_gridspec(len(names), 1, left=0.065, right=0.6, top=top, bottom=bottom, hspace=0.48)
    paths = [name for name in ON_SPHERES if name not in _left_out(trajectory)]
    right = page.add_gridspec(len(paths), 1, left=0.7, right=0.985, top=top, bottom=0.76 / height, hspace=0.3)
    t, unit = _times(trajectory)
    for row, name in enumerate(names):
        panel = page.add_subplot(left[row])
        OVER_TIME[name](panel, t, trajectory)
        if t[0] != t[-1]:
            panel.set_xlim(t[0], t[-1])
        panel.set_xlabel(f"t ({unit})", labelpad=1)
    for row, name in enumerate(paths):
        ON_SPHERES[name](page.add_subplot(right[row]), trajectory)
    _words(page, trajectory)
    return page


def _left_out(trajectory: Any) -> set[str]:
    """Return the names of the panels that the figure of a motion omits.

    They are the panels about attitude if the motion has none, and about the vertical if the scene has no vertical.
    """
    if not trajectory.has_attitude:
        return {"attitude", "vertical", "space"}
    return set() if has_vertical(trajectory.scene) else {"vertical"}


def _words(page: Any, trajectory: Any) -> None:
    scene, stats = trajectory.scene, trajectory.stats
    inch = 1.0 / page.get_figheight()
    page.text(0.02, 1.0 - 0.224 * inch, literal(scene.title)[:100], fontsize=15, fontweight="bold", va="top")
    page.text(0.02, 1.0 - 0.576 * inch, literal(scene.source)[:170], fontsize=8.5, color=GREY, va="top")
    steps = f"{stats.accepted} step{'' if stats.accepted == 1 else 's'}"
    caption = (
        f"{literal(scene.name)}   |   {trajectory.method}, tolerance {trajectory.tolerance:g}, {steps}   |   "
        f"paths run from the dot (dark) to the square (light)   |   symrot {__version__}"
    )
    page.text(0.98, 0.144 * inch, caption, fontsize=8, color=GREY, ha="right")


def save(trajectory: Any, path: Path) -> None:
    """Draw a motion into a file, from its dense solution; the suffix, one of :data:`SUFFIXES`, decides the format."""
    motion = dense(trajectory)
    draw(lambda: figure(motion), path, few_colours=False)
