"""Drawing of a direction's path on a sphere seen from far away, or on a tangent plane if the path is small."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["FAINT", "draw_directions", "prefixed"]

Floats = NDArray[np.float64]

GRID, FAINT, DARK = "#d0d0d0", "#b4b4b4", "#303030"
ELEVATION, ASIDE = np.radians(24.0), np.radians(28.0)  # viewpoint: above the equator, to the side of the path's middle
SMALL, STILL = 0.2, 1e-12  # rad: smaller paths are drawn on a plane; paths smaller than STILL as a point
PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "\N{GREEK SMALL LETTER MU}"), (1e-9, "n"), (1e-12, "p"))
ROOM = 1.26  # half the width of a drawing, in radii
BACK = 0.22  # opacity of curves behind the sphere
CURVES = 12
FINEST = 241  # grid points across the disc for level curves
MOST_VECTORS = 6000  # largest number of segments drawn as vectors in a PDF or SVG; longer paths become an image


def prefixed(size: float, unit: str) -> tuple[float, str]:
    """Return a divisor that makes numbers of about ``size`` easy to read, and their unit after it, such as mm for m."""
    factor, prefix = next((pair for pair in PREFIXES if size >= 0.1 * pair[0]), PREFIXES[-1])
    return (factor, f"{prefix}{unit}") if size > 0 else (1.0, unit)


def _unit(vectors: Floats) -> Floats:
    """Return the directions of vectors, shape (n, 3); vectors close to zero are left out."""
    length = np.sqrt(np.sum(vectors * vectors, axis=1))
    has_direction = length > 1e-9 * np.max(length, initial=0.0)
    directions: Floats = vectors[has_direction] / length[has_direction, None]
    return directions


def _eye(directions: Floats) -> Floats:
    """Return the axes of a view with the path in front, shape (3, 3): the rows are right, up and toward the eye."""
    middle = directions.mean(axis=0)
    level = np.hypot(middle[0], middle[1])
    azimuth = ASIDE + (np.arctan2(middle[1], middle[0]) if level > 0.05 else 0.0)
    elevation = ELEVATION if middle[2] > -0.2 else -ELEVATION
    elevation *= 1.6 if abs(middle[2]) > 0.5 else 1.0
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return np.array([right, np.cross(toward, right), toward])


def _curve(axes: Any, points: Floats, view: Floats, **style: Any) -> None:
    """Draw a thin curve on the sphere, faint on the far side."""
    x, y, z = view @ points.T
    for visible, opacity in ((z >= 0, 1.0), (z < 0, BACK)):
        mask = np.where(visible, 1.0, np.nan)
        axes.plot(x * mask, y * mask, alpha=opacity, **style)


def _globe(axes: Any, view: Floats, labels: tuple[str, ...]) -> None:
    """Draw the sphere: its outline, parallels, meridians and the three axes."""
    turn = np.linspace(0.0, 2 * np.pi, 361)
    axes.fill(np.cos(turn), np.sin(turn), facecolor="#fafafa", edgecolor=FAINT, linewidth=0.8, zorder=0)
    for latitude in np.radians([-60.0, -30.0, 0.0, 30.0, 60.0]):
        ring = np.cos(latitude) * np.array([np.cos(turn), np.sin(turn), 0 * turn])
        _curve(axes, (ring + np.array([[0.0], [0.0], [np.sin(latitude)]])).T, view, color=GRID, linewidth=0.5, zorder=1)
    for longitude in np.radians(np.arange(0.0, 180.0, 30.0)):
        direction = np.array([np.cos(longitude), np.sin(longitude), 0.0])
        ring = np.outer(np.cos(turn), direction) + np.outer(np.sin(turn), [0.0, 0.0, 1.0])
        _curve(axes, ring, view, color=GRID, linewidth=0.5, zorder=1)
    for number, label in enumerate(labels):
        x, y, z = view[:, number]
        opacity = 1.0 if z >= 0 else 0.45
        axes.plot([x, 1.1 * x], [y, 1.1 * y], color=DARK, linewidth=1.1, alpha=opacity, zorder=4)
        axes.text(1.19 * x, 1.19 * y, label, color=DARK, alpha=opacity, ha="center", va="center", zorder=5)


def _levels(axes: Any, view: Floats, value: Callable[[Floats], Floats]) -> None:
    """Draw the level curves of a function of direction on the near side of the sphere."""
    line = np.linspace(-1.0, 1.0, FINEST)
    x, y = np.meshgrid(line, line)
    depth = 1.0 - x * x - y * y
    z = np.sqrt(np.where(depth > 0, depth, np.nan))
    near = np.stack([x, y, z], axis=-1) @ view
    near_values, beyond = value(near), value(-near)
    levels = np.nanquantile(
        [near_values, beyond], np.linspace(0.0, 1.0, CURVES + 2)[1:-1]
    )  # equal areas between curves
    if levels[-1] - levels[0] > 1e-9 * abs(levels[-1]):
        axes.contour(x, y, near_values, levels=levels, colors=FAINT, linewidths=0.7, zorder=2)


def _path(axes: Any, points: Floats, front: NDArray[np.bool_] | None = None) -> None:
    """Draw a path in the plane, points of shape (n, 2), coloured from dark at its start to light at its end."""
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection

    colours = colormaps["viridis"](np.linspace(0.0, 0.82, max(len(points) - 1, 1)))
    segments = np.stack([points[:-1], points[1:]], axis=1)
    if front is not None:
        colours[~front[:-1], 3] = BACK
    lines = LineCollection(list(segments), colors=colours, linewidths=1.3, capstyle="round", zorder=6)
    lines.set_rasterized(len(segments) > MOST_VECTORS)
    axes.add_collection(lines)
    for place, marker, name in ((0, "o", "start"), (-1, "s", "end")):
        axes.plot(*points[place], marker, markersize=5, markerfacecolor=colours[place][:3], markeredgecolor="white",
                  markeredgewidth=0.8, zorder=8, label=name)  # fmt: skip


def _plane(axes: Any, directions: Floats, middle: Floats, extent: float, labels: tuple[str, ...]) -> None:
    """Draw a small path on the plane that touches the sphere at the middle of the path."""
    first, second = sorted(np.argsort(np.abs(middle))[:2])
    across = np.eye(3)[first] - middle[first] * middle
    across /= np.linalg.norm(across)
    along = np.cross(middle, across)
    along *= np.sign(along[second]) or 1.0
    size, unit = prefixed(extent, "rad")
    _path(axes, np.stack([directions @ across, directions @ along], axis=1) / size)
    axes.set_xlabel(f"toward {labels[first]} ({unit})")
    axes.set_ylabel(f"toward {labels[second]} ({unit})")
    half = 1.1 * extent / size
    axes.set(xlim=(-half, half), ylim=(-half, half), aspect="equal")
    axes.locator_params(nbins=5)
    axes.grid(True)


def draw_directions(
    axes: Any, vectors: Floats, labels: tuple[str, ...], value: Callable[[Floats], Floats] | None = None
) -> bool:
    """Draw the path of the direction of vectors, shape (n, 3); return whether it is drawn on a sphere.

    Parameters
    ----------
    axes : matplotlib Axes
        The matplotlib axes to draw into; their frame is removed when a sphere is drawn.
    vectors : array, shape (n, 3)
        Vectors of any length; zero vectors are left out.
    labels : tuple of 3 str
        Names of the three axes.
    value : callable, optional
        A function of direction, shape (..., 3) to (...), whose level curves are drawn behind the path.
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
            return False
    view = _eye(directions)
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.set_xlim(-ROOM, ROOM)
    axes.set_ylim(-ROOM, ROOM)
    _globe(axes, view, labels)
    if value is not None:
        _levels(axes, view, value)
    x, y, z = view @ directions.T
    _path(axes, np.stack([x, y], axis=1), z >= 0)
    return True
