"""Figures of the standard solids, drawn from the maps that also give their inertia by integration."""

from dataclasses import dataclass
from functools import partial
from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sympy import lambdify

from symrot.catalogue.inertia.standard_solids import DRAWN, EXAMPLE
from symrot.figures.picture import Picture
from symrot.figures.view import Floats, View
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import Solid, solid
from symrot.proof.page import Figure

__all__ = ["Surface", "draw_solid", "hull", "sized", "solid_figures", "surface_of"]

SIZES = {  # m
    "radius": 0.8, "length": 1.7, "height": 1.4, "inner": 0.5, "outer": 0.85, "bottom": 0.85, "top": 0.45, "base": 1.5,
    "apex": 0.5, "ring": 0.75, "tube": 0.3, "a": 1.5, "b": 1.1, "c": 0.7,
}  # fmt: skip
SPECIAL: dict[str, dict[str, Any]] = {
    "tetrahedron": {"vertices": [(0, 0, 0), (1.3, 0, 0), (0, 1.3, 0), (0, 0, 1.3)]},
    "ellipsoid": {"a": 1.1, "b": 0.85, "c": 0.6},
}
VIEW = View(azimuth=32, elevation=28, scale=72)
FINE = {True: 49, False: 2}  # samples of a coordinate: 49 of an angle, 2 of a length or fraction (the map is linear)
AHEAD = 0.012  # m: a triangle hides a point only if it lies farther than this in front of it
ONCE_AROUND = 6.0  # a coordinate with a larger range is an angle that goes once around, without ends


@dataclass(frozen=True)
class Surface:
    """The surface of a solid: lines to be drawn, and triangles that hide the lines behind them.

    Attributes
    ----------
    edges, grid : tuples of arrays, shape (n, 3)
        Lines where two faces meet, and lines of constant angles on curved faces.
    triangles : array, shape (n, 3, 3)
        The faces.
    curved : tuple of arrays, shape (n, 3)
        For each face on which both coordinates are angles (such as a sphere), its points.
    """

    edges: tuple[Floats, ...]
    grid: tuple[Floats, ...]
    triangles: Floats
    curved: tuple[Floats, ...]

    def hides(self, points: Floats, view: View) -> NDArray[np.bool_]:
        """Return, for each point, shape (n, 3), whether a triangle of the surface hides it from the viewer."""
        corners, places = self.triangles @ view.axes.T, points @ view.axes.T
        hidden = np.zeros(len(points), dtype=bool)
        if not len(corners):
            return hidden
        first, second, third = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = second[:, 0] * third[:, 1] - second[:, 1] * third[:, 0]
        seen = np.abs(area) > 1e-9
        corners, first, second, third, area = corners[seen], first[seen], second[seen], third[seen], area[seen]
        low, high = corners[:, :, :2].min(axis=1).T - 1e-9, corners[:, :, :2].max(axis=1).T + 1e-9
        px, py, depth = places.T
        # a triangle hides only points inside the rectangle around its picture
        points_near, near = np.nonzero(
            (low[0] < px[:, None]) & (px[:, None] < high[0]) & (low[1] < py[:, None]) & (py[:, None] < high[1])
        )
        a, u, v, size = first[near], second[near], third[near], area[near]
        x, y = px[points_near] - a[:, 0], py[points_near] - a[:, 1]
        b = (x * v[:, 1] - y * v[:, 0]) / size
        c = (u[:, 0] * y - u[:, 1] * x) / size
        before = a[:, 2] + b * u[:, 2] + c * v[:, 2] > depth[points_near] + AHEAD
        hidden[points_near[(b > 1e-6) & (c > 1e-6) & (b + c < 1 - 1e-6) & before]] = True
        return hidden


def sized(name: str) -> Solid:
    """Return the standard solid with this name, such as ``cylinder``, with the dimensions used in its figure."""
    names = [dimension.name for dimension in SHAPES[name].dimensions]
    return solid(name, **SPECIAL.get(name) or {each: SIZES[each] for each in names})


def surface_of(body: Solid) -> Surface:
    """Return the surface of a solid as lines to draw and triangles that hide the lines behind them."""
    symbols = [symbol for symbol, _, _ in body.limits]
    function = lambdify(symbols, list(body.position), "numpy")
    limits = [(float(low), float(high)) for _, low, high in body.limits]
    angles = [coordinate.angle for coordinate in body.shape.coordinates]

    def mapped(*arguments: Any) -> Floats:
        arrays = np.broadcast_arrays(*np.meshgrid(*arguments, indexing="ij"))
        values = [np.broadcast_to(x, arrays[0].shape) for x in function(*arrays)]
        return np.squeeze(np.stack(values, axis=-1).astype(float))

    def samples(number: int) -> Floats:
        return np.linspace(*limits[number], FINE[angles[number]])

    count = len(limits)
    ends = [(i, end) for i in range(count) for end in limits[i] if limits[i][1] - limits[i][0] < ONCE_AROUND]
    # along an edge all coordinates but one are at one of their limits
    fixed = [dict(pair) for pair in combinations(ends, max(count - 1, 0)) if len(dict(pair)) == max(count - 1, 0)]
    edges = [mapped(*([at[i]] if i in at else np.linspace(*limits[i], 73) for i in range(count))) for at in fixed]
    # on a face one coordinate is at one of its limits
    faces = [{i: end} for i, end in ends] if count == 3 else [{}] if count == 2 else []
    triangles, grid, curved = [], [], []
    for face in faces:
        free = [i for i in range(count) if i not in face]
        corners = mapped(*([face[i]] if i in face else samples(i) for i in range(count)))
        a, b, c, d = corners[:-1, :-1], corners[1:, :-1], corners[:-1, 1:], corners[1:, 1:]
        both = np.concatenate([np.stack(t, axis=-2).reshape(-1, 3, 3) for t in ((a, b, c), (b, d, c))])
        if not np.linalg.norm(np.cross(both[:, 1] - both[:, 0], both[:, 2] - both[:, 0]), axis=1).sum() > 1e-6:
            continue  # the face shrinks to a curve or a point
        triangles.append(both)
        if all(angles[i] for i in free):
            grid += _grid(mapped, limits, face, free)
            curved.append(both.reshape(-1, 3))
    lines = tuple(edge for edge in edges if np.ptp(edge, axis=0).max() > 1e-9)
    return Surface(lines, tuple(grid), np.concatenate(triangles) if triangles else np.empty((0, 3, 3)),
                   tuple(curved))  # fmt: skip


def _grid(mapped: Any, limits: list[tuple[float, float]], face: dict[int, float], free: list[int]) -> list[Floats]:
    """Return lines on a curved face; along each line only one coordinate of the solid varies."""
    lines = []
    # face: index and value of the coordinate that is constant on the face; free: indices of the others
    for constant, along in product(free, free):
        if constant == along:
            continue
        low, high = limits[constant]
        stops = np.linspace(low, high, 9)[:-1] if high - low > ONCE_AROUND else np.linspace(low, high, 5)[1:-1]
        for stop in stops:
            at = {**face, constant: stop}
            lines.append(mapped(*([at[i]] if i in at else np.linspace(*limits[i], 73) for i in range(len(limits)))))
    return lines


def hull(places: Floats) -> Floats:
    """Return the corners of the convex hull of points in a plane, shape (n, 2), counter-clockwise."""
    ordered = sorted({(round(float(x), 9), round(float(y), 9)) for x, y in places})

    def chain(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
        corners: list[tuple[float, float]] = []
        for x, y in points:
            while len(corners) > 1:
                (x0, y0), (x1, y1) = corners[-2:]
                if (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) > 1e-12:
                    break
                corners.pop()
            corners.append((x, y))
        return corners[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def draw_solid(name: str) -> Picture:
    """Draw the standard solid ``name``, such as ``cone``, with the axes of its coordinates and its centre of mass."""
    body, picture, view = sized(name), Picture(), VIEW
    surface = surface_of(body)
    points = np.concatenate([*surface.edges, surface.triangles.reshape(-1, 3)])
    corners = hull(points @ view.axes[:2].T)
    if len(corners) > 2 and body.shape.kind != "curve":
        flat = np.column_stack([corners, np.zeros(len(corners))]) @ view.axes
        picture.area(view, flat)
        picture.curve(view, flat, "blue", closed=True)
    for face in surface.curved:
        inner = hull(face @ view.axes[:2].T)
        if not np.array_equal(inner, corners):
            inside = np.column_stack([inner, np.zeros(len(inner))]) @ view.axes
            if surface.hides(face, view).all():
                picture.curve(view, inside, "blue dashed", closed=True)
    for line in surface.grid:
        _seen(picture, view, surface, line, "blue thin")
    for line in surface.edges:
        _seen(picture, view, surface, line, "blue", "dashed")
    for i, letter in enumerate("xyz"):
        direction = np.eye(3)[i]
        reach = max(0.35, float(np.max(points[:, i])) + 0.6)
        line = np.linspace(0.0, reach - 0.12, 61)[:, None] * direction
        picture.curve(view, line, "ink", ~surface.hides(line, view))
        picture.arrow(view, line[-1], reach * direction, letter)
    centre = np.array(body.center_of_mass, dtype=float).ravel()
    picture.dot(view, centre, "red", 3.2)
    picture.label(view, centre, "c", (9, 9))
    return picture


def _seen(picture: Picture, view: View, surface: Surface, line: Floats, style: str, hidden: str = "") -> None:
    """Draw the parts of ``line`` that the surface does not hide, in ``style``; draw the others in the style ``hidden``.

    If ``hidden`` is empty, the hidden parts are not drawn.
    """
    visible = ~surface.hides(line, view)
    if hidden:
        picture.curve(view, line, style, visible, hidden=hidden)
        return
    changes = np.flatnonzero(np.diff(np.concatenate([[False], visible, [False]]).astype(int)))
    for first, last in zip(changes[::2], changes[1::2], strict=True):
        if last - first > 1:
            picture.curve(view, line[first:last], style)


def solid_figures() -> tuple[Figure, ...]:
    """Return the figures of all standard solids whose points are given by a formula in coordinates (cylinder, ..).

    Point masses have no such formula, and no figure.
    """
    return tuple(_figure(name) for name, shape in SHAPES.items() if shape.position)


def _figure(name: str) -> Figure:
    words = name.replace("_", " ")
    axes = SHAPES[name].axes.rstrip(".")
    lengths = "; ".join(f"${each.symbol}$, {each.meaning}" for each in SHAPES[name].dimensions)
    return Figure(
        f"solid_{name}",
        f"{words.capitalize()} with the axes of its map",
        f"{words.capitalize()}. {axes[0].upper()}{axes[1:]}; the red point $c$ is the centre of mass. "
        f"Dimensions: {lengths}.",
        partial(draw_solid, name),
        f"The argument, for the {words}" if name == EXAMPLE else DRAWN,
    )
