"""Drawing of a direction's path on a sphere seen from far away, or on a tangent plane if the path is small."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.report.picture import GREY

__all__ = ["FAINT", "Window", "draw_directions", "prefixed"]

Floats = NDArray[np.float64]

GRID, FAINT, DARK = "#d0d0d0", "#b4b4b4", "#303030"
ELEVATION, ASIDE = np.radians(24.0), np.radians(28.0)  # viewpoint: above the equator, to the side of the path's middle
SMALL, STILL = 0.2, 1e-12  # rad: smaller paths are drawn on a plane; paths smaller than STILL as a point
PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "\N{GREEK SMALL LETTER MU}"), (1e-9, "n"), (1e-12, "p"))
ROOM = 1.26  # half the width of a drawing, in radii
BACK, BACK_PATH = 0.22, 0.45  # strength of thin curves and of a path behind the sphere
CURVES = 12
FINEST = 241  # grid points across the disc for level curves
MOST_VECTORS = 6000  # largest number of segments drawn as vectors in a PDF or SVG; longer paths become an image
SHADES = 240  # colours along a path
LONGEST = 0.5  # radii: farther samples of a path are not joined, for a chord would show nothing
MOST_GAPS = 0.01  # fraction of the samples: with more gaps, a path is drawn as points without lines
FEW = 1000  # points: those of a path with fewer are drawn larger
CLOSE = 0.75  # radii: a path that extends less from its middle, seen from above, is drawn enlarged
MARGIN = 1.2  # width of an enlarged drawing, relative to the path's
GRIDS = (30.0, 15.0, 10.0, 5.0)  # degrees between grid lines
INSET = 0.24  # width of the whole sphere in a corner of an enlarged drawing, relative to the drawing's


@dataclass(frozen=True)
class Window:
    """The part of the sphere that is drawn: a square in the plane of the drawing, in units of the sphere's radius.

    The square has the middle ``centre``, and its sides are 2*half long.
    """

    centre: tuple[float, float] = (0.0, 0.0)
    half: float = ROOM

    @property
    def is_whole(self) -> bool:
        """Whether the whole sphere is drawn."""
        return self.half >= 1.0

    @property
    def spacing(self) -> float:
        """Degrees between circles of latitude: the widest of GRIDS that fits four times into the window, or 5."""
        across = 2.0 * np.degrees(np.arcsin(min(self.half, 1.0)))
        return next((step for step in GRIDS if step * 4.0 <= across), GRIDS[-1])

    def contains(self, x: float, y: float) -> bool:
        """Return whether a point of the drawing lies in the window, at least 5 % of half its width from the edge."""
        return max(abs(x - self.centre[0]), abs(y - self.centre[1])) < 0.95 * self.half


def prefixed(size: float, unit: str) -> tuple[float, str]:
    """Return a factor and a unit with prefix for printing numbers of about ``size``: (0.002, "m") -> (0.001, "mm").

    A number is printed divided by the factor.
    """
    factor, prefix = next((pair for pair in PREFIXES if size >= 0.1 * pair[0]), PREFIXES[-1])
    return (factor, f"{prefix}{unit}") if size > 0 else (1.0, unit)


def _unit(vectors: Floats) -> Floats:
    """Return the directions of vectors, shape (n, 3); vectors close to zero are left out."""
    length = np.sqrt(np.sum(vectors * vectors, axis=1))
    has_direction = length > 1e-9 * np.max(length, initial=0.0)
    directions: Floats = vectors[has_direction] / length[has_direction, None]
    return directions


def _eye(directions: Floats) -> Floats:
    """Return axes for a view of a sphere from which the middle of a path on the sphere is visible, shape (3, 3).

    The rows are the unit vectors to the right, upward and toward the eye; ``directions`` are the points of the path as
    unit vectors, shape (n, 3).
    """
    middle = directions.mean(axis=0)
    level = np.hypot(middle[0], middle[1])
    azimuth = ASIDE + (np.arctan2(middle[1], middle[0]) if level > 0.05 else 0.0)
    elevation = ELEVATION if middle[2] > -0.2 else -ELEVATION
    elevation *= 1.6 if abs(middle[2]) > 0.5 else 1.0
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return np.array([right, np.cross(toward, right), toward])


def _close_view(directions: Floats) -> tuple[Floats, Window] | None:
    """Return (view, window) for a path on a small part of the sphere; None for a large or a tiny path."""
    middle = directions.mean(axis=0)
    length = float(np.linalg.norm(middle))
    if length < 0.5:
        return None
    toward = middle / length
    level = (
        np.array([-toward[1], toward[0], 0.0]) if np.hypot(toward[0], toward[1]) > 0.05 else np.array([0.0, 1.0, 0.0])
    )
    right = level - toward * (level @ toward)
    right /= np.linalg.norm(right)
    # looks down on the middle of the path; _eye explains the rows
    view = np.array([right, np.cross(toward, right), toward])
    x, y, z = view @ directions.T
    half = MARGIN * 0.5 * max(float(np.ptp(x)), float(np.ptp(y)))
    if float(z.min()) <= 0.0 or not STILL < half <= MARGIN * CLOSE:
        return None
    return view, Window((0.5 * float(x.min() + x.max()), 0.5 * float(y.min() + y.max())), half)


def _curve(axes: Any, points: Floats, view: Floats, **style: Any) -> None:
    """Draw a thin curve through ``points`` on the sphere; the part on the far side is faint.

    ``view`` is explained at :func:`_eye`; ``style`` are arguments of matplotlib.
    """
    x, y, z = view @ points.T
    for visible, opacity in ((z >= 0, 1.0), (z < 0, BACK)):
        mask = np.where(visible, 1.0, np.nan)
        axes.plot(x * mask, y * mask, alpha=opacity, **style)


def _globe(axes: Any, view: Floats, labels: tuple[str, ...], window: Window, fontsize: float | None = None) -> None:
    """Draw the sphere: its outline, circles of latitude, meridians, and the three axes with their ``labels``.

    ``view`` is explained at :func:`_eye`; ``window`` is the part that is drawn.
    """
    turn = np.linspace(0.0, 2 * np.pi, 361)
    axes.fill(np.cos(turn), np.sin(turn), facecolor="#fafafa", edgecolor=FAINT, linewidth=0.8, zorder=0)
    spacing = window.spacing
    for latitude in np.radians(np.arange(spacing - 90.0, 90.0, spacing)):
        ring = np.cos(latitude) * np.array([np.cos(turn), np.sin(turn), 0 * turn])
        _curve(axes, (ring + np.array([[0.0], [0.0], [np.sin(latitude)]])).T, view, color=GRID, linewidth=0.5, zorder=1)
    for longitude in np.radians(np.arange(0.0, 180.0, max(spacing, 10.0))):
        direction = np.array([np.cos(longitude), np.sin(longitude), 0.0])
        ring = np.outer(np.cos(turn), direction) + np.outer(np.sin(turn), [0.0, 0.0, 1.0])
        _curve(axes, ring, view, color=GRID, linewidth=0.5, zorder=1)
    for number, label in enumerate(labels):
        x, y, z = view[:, number]
        opacity = 1.0 if z >= 0 else 0.45
        if window.is_whole:
            axes.plot([x, 1.1 * x], [y, 1.1 * y], color=DARK, linewidth=1.1, alpha=opacity, zorder=4)
            beyond = 1.1 + 0.1 / max(float(np.hypot(x, y)), 0.1)
            axes.text(beyond * x, beyond * y, label, color=DARK, alpha=opacity, ha="center", va="center", zorder=5,
                      fontsize=fontsize)  # fmt: skip
        elif z > 0 and window.contains(x, y):
            axes.plot(x, y, "+", color=DARK, markersize=7, zorder=4)
            axes.annotate(label, (x, y), xytext=(4, 4), textcoords="offset points", color=DARK, zorder=9)


def _levels(axes: Any, view: Floats, value: Callable[[Floats], Floats], window: Window) -> bool:
    """Draw level curves of ``value``, a function of direction, on the near side of the sphere.

    Return whether there are such curves: False if the function is constant up to rounding errors.
    """
    line = min(window.half, 1.0) * np.linspace(-1.0, 1.0, FINEST)
    x, y = np.meshgrid(window.centre[0] + line, window.centre[1] + line)
    depth = 1.0 - x * x - y * y
    z = np.sqrt(np.where(depth > 0, depth, np.nan))
    near = np.stack([x, y, z], axis=-1) @ view
    near_values, beyond = value(near), value(-near)
    both_sides = [near_values, beyond] if window.is_whole else [near_values]
    levels = np.nanquantile(both_sides, np.linspace(0.0, 1.0, CURVES + 2)[1:-1])  # equal areas between curves
    has_levels = bool(levels[-1] - levels[0] > 1e-9 * abs(levels[-1]))
    if has_levels:
        axes.contour(x, y, near_values, levels=levels, colors=FAINT, linewidths=0.7, zorder=2)
    return has_levels


def _path(
    axes: Any, points: Floats, gaps: NDArray[np.bool_], front: NDArray[np.bool_] | None = None, width: float = 1.3
) -> None:
    """Draw a path through points of the drawing, shape (n, 2), coloured from dark at its start to light at its end.

    The path is interrupted after points where ``gaps`` is true, and paler where ``front`` is false. With many gaps,
    only its points are drawn.
    """
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection

    count = len(points)
    near = np.ones(count, dtype=bool) if front is None else front
    shades = np.arange(count) * SHADES // max(count, 1)
    changes = (np.diff(shades) != 0) | (np.diff(near.astype(np.int8)) != 0) | gaps[:-1]
    starts = np.flatnonzero(np.concatenate([[True], changes]))
    colours = colormaps["viridis"](0.82 * shades / (SHADES - 1))
    strong = colours[:, :3].copy()
    colours[~near, :3] = 1.0 - BACK_PATH * (1.0 - colours[~near, :3])  # opaque, since pieces of a line overlap
    many = count > MOST_VECTORS
    if np.mean(gaps) < MOST_GAPS:
        stops = np.append(starts[1:], count)
        ends = np.where(gaps[stops - 1], stops, stops + 1)  # a piece reaches the first point of the next one
        pieces = [points[start:end] for start, end in zip(starts, ends, strict=True)]
        for side, depth in ((False, 5), (True, 6)):
            chosen = [number for number, start in enumerate(starts) if near[start] == side]
            lines = LineCollection([pieces[number] for number in chosen], colors=colours[starts[chosen]], zorder=depth,
                                   linewidths=width, capstyle="round")  # fmt: skip
            lines.set_rasterized(many)
            axes.add_collection(lines)
    else:
        axes.scatter(*points.T, s=0.5 if count > FEW else 9.0, c=colours, linewidths=0.0, zorder=6, rasterized=many)
    for place, marker, name in ((0, "o", "start"), (-1, "s", "end")):
        axes.plot(*points[place], marker, markersize=5, markerfacecolor=strong[place], markeredgecolor="white",
                  markeredgewidth=0.8, zorder=8, label=name)  # fmt: skip


def _gaps(directions: Floats, extent: float = 1.0) -> NDArray[np.bool_]:
    """Return a mask of a path's directions: True if the next direction is too far away to be joined by a line.

    Too far is farther than LONGEST times ``extent``, the size of the path, rad.
    """
    steps = np.linalg.norm(np.diff(directions, axis=0), axis=1)
    # the last direction has no next one
    return np.append(steps > LONGEST * extent, False)


def _plane(axes: Any, directions: Floats, middle: Floats, extent: float, labels: tuple[str, ...]) -> None:
    """Draw a tiny path of directions on a plane that touches the sphere of directions at the middle of the path.

    ``middle`` is the unit vector of the middle, ``extent`` the size of the path, rad. ``labels`` are the names of the
    three axes.
    """
    first, second = sorted(np.argsort(np.abs(middle))[:2])
    across = np.eye(3)[first] - middle[first] * middle
    across /= np.linalg.norm(across)
    along = np.cross(middle, across)
    along *= np.sign(along[second]) or 1.0
    size, unit = prefixed(extent, "rad")
    points = np.stack([directions @ across, directions @ along], axis=1) / size
    _path(axes, points, _gaps(directions, extent))
    axes.set_xlabel(f"toward {labels[first]} ({unit})")
    axes.set_ylabel(f"toward {labels[second]} ({unit})")
    half = 1.1 * extent / size
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal")
    axes.locator_params(nbins=5)
    axes.grid(True)


def draw_directions(
    axes: Any,
    vectors: Floats,
    labels: tuple[str, ...],
    value: Callable[[Floats], Floats] | None = None,
    value_note: str = "",
) -> None:
    """Draw the path of the direction of vectors, shape (n, 3), on a sphere.

    A tiny path is drawn on a plane that touches the sphere, without level curves.

    Parameters
    ----------
    axes : matplotlib Axes
        The matplotlib axes to draw into; their frame is removed when a whole sphere is drawn.
    vectors : array, shape (n, 3)
        Vectors of any length; zero vectors are left out.
    labels : tuple of 3 str
        Names of the three axes.
    value : callable, optional
        A function of direction, shape (..., 3) to (...), whose level curves are drawn behind the path.
    value_note : str
        The sentence below the drawing that explains the level curves.
    """
    directions = _unit(vectors)
    if not len(directions):  # a body at rest
        directions = np.array([[0.0, 0.0, 1.0]])
    middle = directions.mean(axis=0)
    length = np.linalg.norm(middle)
    if length > 0.9:
        middle = middle / length
        extent = float(np.max(np.linalg.norm(directions - middle, axis=1)))
        if STILL < extent < SMALL:
            _plane(axes, directions, middle, extent, labels)
            return
    view, window = _close_view(directions) or (_eye(directions), Window())
    notes = []
    _sphere(axes, directions, view, labels, window)
    if value is not None and _levels(axes, view, value, window):
        notes.append(value_note)
    if window.is_whole:
        axes.set_axis_off()
    else:
        notes.append(f"parallels every {window.spacing:g}\N{DEGREE SIGN}")
        axes.set(xticks=[], yticks=[])
        for spine in axes.spines.values():
            spine.set(visible=True, color=FAINT)
        x, y = view[:2] @ directions.T
        # a path on a small part of the sphere is enlarged, with the whole sphere beside it
        whole = axes.inset_axes((*_empty_corner(x, y, window), INSET, INSET), zorder=10)
        whole.set_axis_off()
        _sphere(whole, directions, _eye(directions), labels, Window(half=1.1 * ROOM), is_inset=True)
    axes.text(0.5, -0.02, "\n".join(notes), transform=axes.transAxes, ha="center", va="top", color=GREY)


def _empty_corner(x: Floats, y: Floats, window: Window) -> tuple[float, float]:
    """Return the lower left corner of an inset, as fractions of the axes, where it covers the fewest points (x, y)."""
    across = 0.5 + (x - window.centre[0]) / (2.0 * window.half)
    up = 0.5 + (y - window.centre[1]) / (2.0 * window.half)

    def crowd(corner: tuple[float, float]) -> int:
        middle = np.array(corner) + 0.5 * INSET
        return int(
            np.count_nonzero((np.abs(across - middle[0]) < 0.6 * INSET) & (np.abs(up - middle[1]) < 0.6 * INSET))
        )

    far = 1.0 - INSET
    return min(((0.0, far), (far, far), (0.0, 0.0), (far, 0.0)), key=crowd)


def _sphere(axes: Any, directions: Floats, view: Floats, labels: tuple[str, ...], window: Window,
            is_inset: bool = False) -> None:  # fmt: skip
    """Draw the part of the sphere inside a window, and a path of directions on it.

    ``view`` is explained at :func:`_eye`; an inset is a small second drawing, with smaller letters.
    """
    axes.set_aspect("equal")
    axes.set_xlim(window.centre[0] - window.half, window.centre[0] + window.half)
    axes.set_ylim(window.centre[1] - window.half, window.centre[1] + window.half)
    _globe(axes, view, labels, window, fontsize=7.0 if is_inset else None)
    x, y, z = view @ directions.T
    _path(axes, np.stack([x, y], axis=1), _gaps(directions), z >= 0, 0.7 if is_inset else 1.3)
