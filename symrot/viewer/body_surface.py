"""The surface of a scene's body as patches: grids of points computed from the maps that define its shapes.

A shape is the image of a box of coordinates, and its surface the image of the box's faces. A body with unknown shape is
drawn as the uniform box with the same moments of inertia.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import cos, pi, sin, sqrt
from typing import NamedTuple

from symrot.errors import InputError
from symrot.formula.tree import Node, evaluate, names, parse
from symrot.inertia.composite import Part
from symrot.inertia.principal import Principal, principal_axes, require_admissible
from symrot.inertia.shapes import SHAPES, Coordinate, Shape, scalars
from symrot.inertia.tensor import about_center_of_mass
from symrot.scene.body import Body

__all__ = ["Patch", "Point", "how_drawn", "patches"]

Point = tuple[float, float, float]

PER_HALF_TURN = 24  # divisions of an angle of pi
FUNCTIONS = {"cos": cos, "sin": sin}
INSIDE = 0.37  # a place between the ends of a coordinate, as a part of its range
ROUNDING = 1e-9  # distance of points that count as equal, relative to the largest dimension
FLATTEST = 0.02  # least thickness of the box for a body without parts, relative to its longest side


class Patch(NamedTuple):
    """Points of a surface (``rows`` times ``columns``), of a curve (one row), or separate points (no columns).

    Attributes
    ----------
    points : list of (x, y, z)
        In m, in body axes, from the point of rotation; row by row.
    rows, columns : int
        Size of the grid.
    is_hole : bool
        Whether the patch bounds a hole: a shape that is subtracted from the body.
    is_mesh : bool
        Whether the patch is a mesh instead of a grid: each row holds the three corners of a triangle.
    """

    points: list[Point]
    rows: int
    columns: int
    is_hole: bool = False
    is_mesh: bool = False


def patches(body: Body) -> list[Patch]:
    """Return the surface of a body as patches of points, m, in body axes, relative to the point of rotation.

    Parameters
    ----------
    body : Body
        A body of parts, one given by a mesh, or one of which only the inertia is known, which becomes a box.

    Returns
    -------
    list of Patch

    Examples
    --------
    >>> import symrot
    >>> len(patches(symrot.load_scene("tumbling_prism").body))
    6
    """
    if body.facets:
        return [_of_facets(body)]
    if not body.parts:
        return _equivalent_box(body)
    return [patch for part in body.parts for patch in _of_part(part, body)]


def how_drawn(body: Body) -> str:
    """Return the sentence which tells the reader that a body is drawn as a box; empty if the body's shape is known."""
    if body.parts or body.facets:
        return ""
    if body.about == "fixed_point" and _about_its_center(body) is None:
        return "The body is drawn as a box whose proportions follow from its moments of inertia about the fixed point."
    return "The body is drawn as the uniform box with the same moments of inertia."


def _of_facets(body: Body) -> Patch:
    """Return the triangles of a body's mesh as one patch of its surface."""
    start = [float(value) for value in body.origin]
    points = [(x - start[0], y - start[1], z - start[2]) for facet in body.facets for x, y, z in facet]
    return Patch(points, len(body.facets), 3, is_mesh=True)


def _of_part(part: Part, body: Body) -> Iterator[Patch]:
    offsets = [float(at - start) for at, start in zip(part.at, body.origin, strict=True)]
    shape = SHAPES[part.shape]
    if shape.kind == "points":
        yield Patch(
            [_moved(part.rotation, [float(c) for c in point], offsets) for point in part.dimensions["points"]],
            1, 0, part.subtract,
        )  # fmt: skip
        return
    values = {name: float(value) for name, value in scalars(shape, part.dimensions).items()}
    position = [parse(text) for text in shape.position]
    for fixed, free in _faces(shape):
        grids = [_places(coordinate, values) for coordinate in free]
        rows, columns = (grids[0], grids[1]) if len(grids) == 2 else ([None], grids[0])
        ends = {name: _value(text, values) for name, text in fixed.items()}
        if len(free) == 2 and _is_line(position, values | ends, dict(zip((c.name for c in free), grids, strict=True))):
            continue
        points = []
        for row in rows:
            for column in columns:
                here = ends | {free[-1].name: column} | ({free[0].name: row} if row is not None else {})
                local = [evaluate(node, values | here, FUNCTIONS, float) for node in position]
                points.append(_moved(part.rotation, local, offsets))
        yield Patch(points, len(rows), len(columns), part.subtract)


def _moved(rotation: Sequence[Sequence[Fraction]], point: Sequence[float], offsets: Sequence[float]) -> Point:
    """Return ``rotation @ point + offsets``."""
    rows = [[float(entry) for entry in row] for row in rotation]
    x, y, z = (
        sum(entry * component for entry, component in zip(row, point, strict=True)) + offset
        for row, offset in zip(rows, offsets, strict=True)
    )
    return x, y, z


def _faces(shape: Shape) -> Iterator[tuple[dict[str, str], tuple[Coordinate, ...]]]:
    """Yield a pair for each face of a shape: the coordinate that is constant on the face, and the other coordinates.

    The constant coordinate is a map from its name to its value, such as ``{"radius": "R"}``. The ends of an angle from
    0 to 2 pi are no faces. A shape with fewer than three coordinates is a face itself, without constant coordinate.
    """
    coordinates = shape.coordinates
    if len(coordinates) < 3:
        yield {}, coordinates
        return
    for coordinate in coordinates:
        if (coordinate.lower, coordinate.upper) == ("0", "2*pi"):
            # both ends of an angle from 0 to 2 pi are the same points inside the body
            continue
        others = tuple(c for c in coordinates if c is not coordinate)
        for end in (coordinate.lower, coordinate.upper):
            # ({"radius": "R"}, (angle, height)) is the curved side of a cylinder
            yield {coordinate.name: end}, others


def _is_line(position: Sequence[Node], values: Mapping[str, float], grids: Mapping[str, list[float]]) -> bool:
    """Return whether a face is only a line or a point, as the inner face of a solid cylinder is, at radius 0."""
    # position: formulas of x, y, z; values: dimensions and constant coordinate; grids: the other coordinates
    inside = {name: grid[0] + INSIDE * (grid[-1] - grid[0]) for name, grid in grids.items()}

    def point(**moved: float) -> list[float]:
        return [evaluate(node, {**values, **inside, **moved}, FUNCTIONS, float) for node in position]

    here, size = point(), max(map(abs, values.values()))
    middles = [point(**{name: grid[0] + (grid[-1] - grid[0]) / 2}) for name, grid in grids.items()]
    return any(max(abs(a - b) for a, b in zip(middle, here, strict=True)) <= ROUNDING * size for middle in middles)


def _places(coordinate: Coordinate, values: Mapping[str, float]) -> list[float]:
    """Return the values of a coordinate at which a surface is computed: both ends; for an angle also values between."""
    low, high = _value(coordinate.lower, values), _value(coordinate.upper, values)
    count = max(1, round(PER_HALF_TURN * (high - low) / pi)) if coordinate.angle else 1
    return [low + (high - low) * k / count for k in range(count + 1)]


def _value(text: str, values: Mapping[str, float]) -> float:
    node = parse(text)
    known = {"pi": pi, **values}
    return float(evaluate(node, {name: known[name] for name in names(node)}, FUNCTIONS, float))


def _about_its_center(body: Body) -> tuple[Principal, float, Point] | None:
    """Return the principal moments about the centre of mass, the mass and the centre.

    Return None if the scene does not give mass and centre, or if no body can have these moments.
    """
    if body.mass is None or body.center_of_mass is None:
        return None
    try:
        inertia = about_center_of_mass(body.inertia, body.mass, body.center_of_mass)
        principal = principal_axes(inertia)
        require_admissible(principal, "body")
    except InputError:
        return None
    x, y, z = map(float, body.center_of_mass)
    return principal, float(body.mass), (x, y, z)


def _equivalent_box(body: Body) -> list[Patch]:
    """Return the faces of the uniform box that has the same moments of inertia as a body.

    A body without a mass gives only the proportions; very thin sides are made visible.
    """
    central = _about_its_center(body)
    principal, mass, center = central or (body.principal, None, (0.0, 0.0, 0.0))
    moments = [float(moment) for moment in principal.moments]
    squares = [max(sum(moments) - 2 * moment, 0.0) for moment in moments]  # (B + C - A), proportional to a^2
    # without a mass only the proportions are right, and the longest edge is 1
    scale = sqrt(6 / mass) if mass else 1 / sqrt(max(squares))  # a^2 = 6 (B + C - A)/m
    longest = scale * sqrt(max(squares))
    sides = [max(scale * sqrt(square), FLATTEST * longest) for square in squares]

    def corner(signs: Sequence[float]) -> Point:
        local = [sign * side / 2 for sign, side in zip(signs, sides, strict=True)]
        return _moved(principal.axes, local, center)

    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (-1.0, 1.0):
            points = []
            for a in (-1.0, 1.0):
                for b in (-1.0, 1.0):
                    signs = [0.0, 0.0, 0.0]
                    signs[axis], signs[u], signs[v] = end, a, b
                    points.append(corner(signs))
            faces.append(Patch(points, 2, 2))
    return faces
