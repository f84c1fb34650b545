"""Whether one shape lies within another, from exact bounds of convex functions on simple pieces. Standard library.

The hull of a shape is described by pieces: disks inflated by a ball (points, circles, balls and tori are such), domes
and ellipsoids. A shape that contains others is described by walls, functions that are at most zero inside; a convex
function is largest on the hull. Lengths are doubles, in m; callers allow for rounding by a tolerance.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any, NamedTuple

from symrot.inertia.tensor import cross, dot

__all__ = [
    "Pose", "Solid3", "are_apart", "center", "corners", "directions", "excess", "farthest", "height", "is_convex",
    "outside", "size",
]  # fmt: skip

Vec = tuple[float, float, float]
Dimensions = Mapping[str, Any]  # lengths; vertices of a tetrahedron

MERIDIANS = 16  # of a polyhedron around a ball, a multiple of 4
CORNERS = 64  # of a polygon around a circle, where no exact bound is at hand
PARALLEL = 1e-12


def _plus(a: Vec, b: Vec, factor: float = 1.0) -> Vec:
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


def _length(a: Vec) -> float:
    return math.hypot(*a)


def _unit(a: Vec) -> Vec:
    length = _length(a)
    return (a[0] / length, a[1] / length, a[2] / length) if length else (0.0, 0.0, 1.0)


class Pose(NamedTuple):
    """Position (m) and rotation matrix of a shape: ``x_body = at + rotation x_shape``."""

    at: Vec
    rotation: tuple[Vec, Vec, Vec]

    def turn(self, v: Vec) -> Vec:
        """Return a vector in the axes of the body, from its components in the axes of the shape."""
        x, y, z = (dot(row, v) for row in self.rotation)
        return x, y, z

    def turn_back(self, v: Vec) -> Vec:
        """Return a vector in the axes of the shape, from its components in the axes of the body."""
        x, y, z = (sum(self.rotation[i][k] * v[i] for i in range(3)) for k in range(3))
        return x, y, z

    def to_body(self, p: Vec) -> Vec:
        """Return a point in the axes of the body, from its coordinates in the axes of the shape."""
        return _plus(self.at, self.turn(p))

    def from_body(self, p: Vec) -> Vec:
        """Return a point in the axes of the shape, from its coordinates in the axes of the body."""
        return self.turn_back(_plus(p, self.at, -1.0))


@dataclass(frozen=True)
class Solid3:
    """A shape of the table of shapes, with its dimensions as doubles and its place in the body."""

    shape: str
    dimensions: Dimensions
    pose: Pose

    @cached_property
    def hull(self) -> "list[Piece]":
        """The pieces whose convex hull is that of the shape, in the axes of the body."""
        return [_moved(piece, self.pose) for piece in _HULLS[self.shape](self.dimensions)]


class _Disk(NamedTuple):
    """A disk inflated by a ball: centre, unit normal and radius of the disk, radius of the ball."""

    center: Vec
    normal: Vec
    radius: float
    ball: float


class _Dome(NamedTuple):
    """Half a ball: centre of the flat face, unit vector toward the dome, radius."""

    center: Vec
    axis: Vec
    radius: float


class _Ellipsoid(NamedTuple):
    """An ellipsoid: centre and the three semi-axes as vectors."""

    center: Vec
    axes: tuple[Vec, Vec, Vec]


Piece = _Disk | _Dome | _Ellipsoid
_Z: Vec = (0.0, 0.0, 1.0)


def _points(*points: Vec) -> list[Piece]:
    return [_Disk(point, _Z, 0.0, 0.0) for point in points]


def _rim(z: float, radius: float, ball: float = 0.0) -> Piece:
    return _Disk((0.0, 0.0, z), _Z, radius, ball)


def _signs(a: float, b: float, c: float) -> list[Piece]:
    return _points(*((x, y, z) for x in {-a, a} for y in {-b, b} for z in {-c, c}))


def _triangle(d: Dimensions) -> list[tuple[float, float]]:
    return [(0.0, 0.0), (d["base"], 0.0), (d["apex"], d["height"])]


_HULLS: dict[str, Callable[[Dimensions], list[Piece]]] = {
    "box": lambda d: _signs(d["a"] / 2, d["b"] / 2, d["c"] / 2),
    "cylinder": lambda d: [_rim(z, d["radius"]) for z in (-d["length"] / 2, d["length"] / 2)],
    "hollow_cylinder": lambda d: [_rim(z, d["outer"]) for z in (-d["length"] / 2, d["length"] / 2)],
    "cone": lambda d: [_rim(0.0, d["radius"]), _rim(d["height"], 0.0)],
    "frustum": lambda d: [_rim(0.0, d["bottom"]), _rim(d["height"], d["top"])],
    "sphere": lambda d: [_rim(0.0, 0.0, d["radius"])],
    "spherical_shell": lambda d: [_rim(0.0, 0.0, d["radius"])],
    "hollow_sphere": lambda d: [_rim(0.0, 0.0, d["outer"])],
    "hemisphere": lambda d: [_Dome((0.0, 0.0, 0.0), _Z, d["radius"])],
    "ellipsoid": lambda d: [_Ellipsoid((0.0, 0.0, 0.0), ((d["a"], 0.0, 0.0), (0.0, d["b"], 0.0), (0.0, 0.0, d["c"])))],
    "torus": lambda d: [_rim(0.0, d["ring"], d["tube"])],
    "rod": lambda d: _points((0.0, 0.0, -d["length"] / 2), (0.0, 0.0, d["length"] / 2)),
    "disk": lambda d: [_rim(0.0, d["radius"])],
    "ring": lambda d: [_rim(0.0, d["radius"])],
    "plate": lambda d: _signs(d["a"] / 2, d["b"] / 2, 0.0),
    "triangular_plate": lambda d: _points(*((x, y, 0.0) for x, y in _triangle(d))),
    "triangular_prism": lambda d: _points(
        *((x, y, z) for x, y in _triangle(d) for z in (-d["length"] / 2, d["length"] / 2))
    ),
    "tetrahedron": lambda d: _points(*d["vertices"]),
}


def _moved(piece: Piece, pose: Pose) -> Piece:
    center = pose.to_body(piece.center)
    if isinstance(piece, _Disk):
        return _Disk(center, pose.turn(piece.normal), piece.radius, piece.ball)
    if isinstance(piece, _Dome):
        return _Dome(center, pose.turn(piece.axis), piece.radius)
    first, second, third = map(pose.turn, piece.axes)
    return _Ellipsoid(center, (first, second, third))


def _reach(piece: Piece, direction: Vec) -> float:
    """Return the largest n x for points x of a piece, with the unit vector n = ``direction``."""
    base: float = dot(piece.center, direction)
    if isinstance(piece, _Ellipsoid):
        return base + math.hypot(*(dot(axis, direction) for axis in piece.axes))
    axis = piece.normal if isinstance(piece, _Disk) else piece.axis
    along: float = dot(axis, direction)
    if isinstance(piece, _Disk):
        return base + piece.radius * math.sqrt(max(0.0, 1 - along * along)) + piece.ball
    return base + piece.radius * (1.0 if along >= 0 else math.sqrt(max(0.0, 1 - along * along)))


def _round(piece: Piece) -> _Disk:
    """Return a disk with a ball around it that contains a piece."""
    if isinstance(piece, _Disk):
        return piece
    radius = piece.radius if isinstance(piece, _Dome) else max(map(_length, piece.axes))
    return _Disk(piece.center, _Z, 0.0, radius)


def _farthest_along(piece: Piece, direction: Vec) -> Vec:
    """Return a point of a piece with the largest n x, with the unit vector n = ``direction``."""
    if isinstance(piece, _Ellipsoid):
        shares = [dot(axis, direction) for axis in piece.axes]
        length = math.hypot(*shares) or 1.0
        point = piece.center
        for axis, share in zip(piece.axes, shares, strict=True):
            point = _plus(point, axis, share / length)
        return point
    axis = piece.normal if isinstance(piece, _Disk) else piece.axis
    along = dot(axis, direction)
    across = _plus(direction, axis, -along)
    rim = _plus(piece.center, _unit(across), piece.radius if _length(across) > PARALLEL else 0.0)
    if isinstance(piece, _Disk):
        return _plus(rim, direction, piece.ball)
    return _plus(piece.center, direction, piece.radius) if along >= 0 else rim


def farthest(solid: Solid3, direction: Vec) -> Vec:
    """Return a point of a shape with the largest n x, with a unit vector n = ``direction`` in the axes of the body."""
    points = [_farthest_along(piece, direction) for piece in solid.hull]
    return max(points, key=lambda point: dot(point, direction))


def height(solid: Solid3, direction: Vec) -> float:
    """Return the largest n x for points x of a shape, with a unit vector n = ``direction`` in the axes of the body."""
    return max(_reach(piece, direction) for piece in solid.hull)


def center(solid: Solid3) -> Vec:
    """Return the middle of the box around a shape, in the axes of the body."""
    x, y, z = ((height(solid, axis) - height(solid, _plus((0.0, 0.0, 0.0), axis, -1.0))) / 2 for axis in _AXES)
    return x, y, z


def size(solid: Solid3) -> float:
    """Return the radius of a ball about :func:`center` that contains a shape."""
    middle = center(solid)
    return max(_farthest(_round(piece), middle) for piece in solid.hull)


_AXES: tuple[Vec, Vec, Vec] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def _farthest(disk: _Disk, point: Vec) -> float:
    """Return the largest distance of a point of an inflated disk from ``point``."""
    offset = _plus(disk.center, point, -1.0)
    along = dot(offset, disk.normal)
    across = math.sqrt(max(0.0, dot(offset, offset) - along * along))
    return math.hypot(along, across + disk.radius) + disk.ball


def _across(axis: Vec) -> Vec:
    """Return a unit vector that is perpendicular to a unit vector."""
    return _unit(cross(axis, _AXES[min(range(3), key=lambda k: abs(axis[k]))]))


def _around(disk: _Disk) -> list[Vec]:
    """Return the corners of a polygon that contains a disk."""
    if not disk.radius:
        return [disk.center]
    first = _across(disk.normal)
    second = cross(disk.normal, first)
    radius = disk.radius / math.cos(math.pi / CORNERS)
    turns = [2 * math.pi * k / CORNERS for k in range(CORNERS)]
    return [_plus(_plus(disk.center, first, radius * math.cos(t)), second, radius * math.sin(t)) for t in turns]


def corners(solid: Solid3) -> list[Vec]:
    """Return points whose convex hull contains a shape; none for a torus."""
    points: list[Vec] = []
    for piece in solid.hull:
        if isinstance(piece, _Disk) and not piece.ball:
            points += _around(piece)
        elif isinstance(piece, _Disk) and piece.radius:
            return []
        elif isinstance(piece, _Dome):
            first = _across(piece.axis)
            axes = (first, cross(piece.axis, first), piece.axis)
            half = [point for point in _ball() if point[2] >= 0]
            points += [_combined(piece.center, axes, point, piece.radius) for point in half]
        elif isinstance(piece, _Disk):
            points += [_plus(piece.center, point, piece.ball) for point in _ball()]
        else:
            points += [_combined(piece.center, piece.axes, point, 1.0) for point in _ball()]
    return points


def _combined(center: Vec, axes: tuple[Vec, Vec, Vec], shares: Vec, factor: float) -> Vec:
    for axis, share in zip(axes, shares, strict=True):
        center = _plus(center, axis, factor * share)
    return center


@cache
def _ball() -> list[Vec]:
    """Return the corners of a polyhedron that contains the ball of radius 1; the equator z = 0 has corners."""
    # the planes of its faces are nearer to the centre than the corners by the cosines of half their two angles
    step = math.pi / MERIDIANS
    radius = 1 / math.cos(step) ** 2
    rings = [(radius * math.cos(k * 2 * step), radius * math.sin(k * 2 * step) if k else 0.0)
             for k in range(-MERIDIANS // 4 + 1, MERIDIANS // 4)]  # fmt: skip
    around = [(math.cos(2 * step * n), math.sin(2 * step * n)) for n in range(MERIDIANS)]
    return [(0.0, 0.0, -radius), *((r * x, r * y, z) for r, z in rings for x, y in around), (0.0, 0.0, radius)]


# --- walls: each returns by how much a hull reaches beyond it, in m; at most 0 if the hull is inside ------------------

Wall = Callable[[list[Piece]], float]


def _plane(normal: Vec, limit: float) -> Wall:
    return lambda pieces: max(_reach(piece, normal) for piece in pieces) - limit


def _tube_wall(radius: float, slope: float) -> Wall:
    """Return the wall ``rho + slope z <= radius`` of a cylinder or a cone about the z axis."""
    steep = math.hypot(1.0, slope)

    def reach(piece: Piece) -> float:
        disk = _round(piece)
        if abs(disk.normal[0]) + abs(disk.normal[1]) < PARALLEL or not disk.radius:
            x, y, z = disk.center
            return math.hypot(x, y) + disk.radius + slope * z + disk.ball * steep
        return max(math.hypot(x, y) + slope * z for x, y, z in _around(disk)) + disk.ball * steep

    return lambda pieces: (max(map(reach, pieces)) - radius) / steep


def _ball_wall(radius: float) -> Wall:
    return lambda pieces: max(_farthest(_round(piece), (0.0, 0.0, 0.0)) for piece in pieces) - radius


def _ellipsoid_wall(a: float, b: float, c: float) -> Wall:
    least = min(a, b, c)

    def scaled(v: Vec) -> Vec:
        return v[0] / a, v[1] / b, v[2] / c

    def reach(piece: Piece) -> float:
        if isinstance(piece, _Ellipsoid):
            axes = [scaled(axis) for axis in piece.axes]
            crossed = max(abs(dot(axes[i], axes[j])) for i, j in ((0, 1), (0, 2), (1, 2)))
            lengths = [_length(axis) for axis in axes]
            spread = max(lengths) if crossed < PARALLEL else math.hypot(*lengths)
            return _length(scaled(piece.center)) + spread
        disk = _round(piece)
        return max(_length(scaled(point)) for point in _around(disk)) + disk.ball / least

    return lambda pieces: (max(map(reach, pieces)) - 1) * least


def _flat(*walls: Wall) -> list[Wall]:
    return [_plane((0.0, 0.0, 1.0), 0.0), _plane((0.0, 0.0, -1.0), 0.0), *walls]


def _slabs(*limits: tuple[int, float]) -> list[Wall]:
    walls = []
    for axis, limit in limits:
        for sign in (1.0, -1.0):
            walls.append(_plane(_plus((0.0, 0.0, 0.0), _AXES[axis], sign), limit))
    return walls


def _sides(d: Dimensions) -> list[Wall]:
    corners = _triangle(d)
    walls = []
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        normal = _unit((y2 - y1, x1 - x2, 0.0))  # outwards, as the corners are counterclockwise
        walls.append(_plane(normal, normal[0] * x1 + normal[1] * y1))
    return walls


def _faces(d: Dimensions) -> list[Wall]:
    walls = []
    for k in range(4):
        a, b, c = (d["vertices"][i] for i in range(4) if i != k)
        normal = _unit(cross(_plus(b, a, -1.0), _plus(c, a, -1.0)))
        if dot(normal, _plus(d["vertices"][k], a, -1.0)) > 0:
            normal = _plus((0.0, 0.0, 0.0), normal, -1.0)
        walls.append(_plane(normal, dot(normal, a)))
    return walls


def _frustum_walls(bottom: float, top: float, length: float) -> list[Wall]:
    return [
        _tube_wall(bottom, (bottom - top) / length),
        _plane((0.0, 0.0, -1.0), 0.0),
        _plane((0.0, 0.0, 1.0), length),
    ]


_WALLS: dict[str, Callable[[Dimensions], list[Wall]]] = {
    "box": lambda d: _slabs((0, d["a"] / 2), (1, d["b"] / 2), (2, d["c"] / 2)),
    "cylinder": lambda d: [_tube_wall(d["radius"], 0.0), *_slabs((2, d["length"] / 2))],
    "hollow_cylinder": lambda d: [_tube_wall(d["outer"], 0.0), *_slabs((2, d["length"] / 2))],
    "cone": lambda d: _frustum_walls(d["radius"], 0.0, d["height"]),
    "frustum": lambda d: _frustum_walls(d["bottom"], d["top"], d["height"]),
    "sphere": lambda d: [_ball_wall(d["radius"])],
    "hollow_sphere": lambda d: [_ball_wall(d["outer"])],
    "hemisphere": lambda d: [_ball_wall(d["radius"]), _plane((0.0, 0.0, -1.0), 0.0)],
    "ellipsoid": lambda d: [_ellipsoid_wall(d["a"], d["b"], d["c"])],
    "rod": lambda d: _slabs((0, 0.0), (1, 0.0), (2, d["length"] / 2)),
    "disk": lambda d: _flat(_tube_wall(d["radius"], 0.0)),
    "plate": lambda d: _slabs((0, d["a"] / 2), (1, d["b"] / 2), (2, 0.0)),
    "triangular_plate": lambda d: _flat(*_sides(d)),
    "triangular_prism": lambda d: [*_sides(d), *_slabs((2, d["length"] / 2))],
    "tetrahedron": _faces,
}


def _relative(inner: Solid3, outer: Solid3) -> Pose:
    """Return the place of the shape ``inner`` in the axes of the shape ``outer``."""
    columns = [outer.pose.turn_back(inner.pose.turn(axis)) for axis in _AXES]
    first, second, third = ((columns[0][i], columns[1][i], columns[2][i]) for i in range(3))
    return Pose(outer.pose.from_body(inner.pose.at), (first, second, third))


def outside(inner: Solid3, outer: Solid3) -> float:
    """Return a length by which ``inner`` at most reaches out of ``outer``, m; at most 0 if it lies inside.

    Infinite if this cannot be bounded.
    """
    if inner == outer:
        return 0.0
    pose = _relative(inner, outer)
    own = replace(inner, pose=pose)
    pieces = own.hull
    d = outer.dimensions
    if outer.shape == "torus":
        return _out_of_torus(own, pieces, d)
    if outer.shape not in _WALLS:
        return math.inf
    reach = max(wall(pieces) for wall in _WALLS[outer.shape](d))
    if outer.shape in ("hollow_cylinder", "hollow_sphere") and d["inner"]:
        reach = max(reach, _into_bore(own, d["inner"], outer.shape == "hollow_cylinder"))
    return reach


def _into_bore(own: Solid3, radius: float, is_cylinder: bool) -> float:
    """Return by how much a shape at most reaches into the bore, of the given radius, of a hollow cylinder or sphere."""
    x, y, z = own.pose.at
    if own.shape == ("hollow_cylinder" if is_cylinder else "hollow_sphere"):
        tilt = abs(own.pose.turn(_Z)[0]) + abs(own.pose.turn(_Z)[1]) if is_cylinder else 0.0
        if tilt < PARALLEL:
            offset = math.hypot(x, y) if is_cylinder else math.hypot(x, y, z)
            if offset < own.dimensions["inner"]:
                return float(radius - own.dimensions["inner"] + offset)
    middle = center(own)
    toward = _unit((middle[0], middle[1], 0.0) if is_cylinder else middle)
    return radius + height(own, _plus((0.0, 0.0, 0.0), toward, -1.0))


def _out_of_torus(own: Solid3, pieces: list[Piece], d: Dimensions) -> float:
    x, y, z = own.pose.at
    normal = own.pose.turn(_Z)
    if own.shape == "torus" and abs(normal[0]) + abs(normal[1]) < PARALLEL and math.hypot(x, y) == 0:
        return float(math.hypot(own.dimensions["ring"] - d["ring"], z) + own.dimensions["tube"] - d["tube"])
    x, y, z = center(own)
    return float(math.hypot(math.hypot(x, y) - d["ring"], z) + size(own) - d["tube"])


def directions(solid: Solid3) -> list[Vec]:
    """Return the unit vectors along the axes of a shape and, for shapes with plane faces, normal to its faces."""
    normals = list(_AXES)
    if solid.shape in ("triangular_plate", "triangular_prism"):
        corners = _triangle(solid.dimensions)
        pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
        normals += [_unit((y2 - y1, x1 - x2, 0.0)) for (x1, y1), (x2, y2) in pairs]
    if solid.shape == "tetrahedron":
        v = solid.dimensions["vertices"]
        faces = ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
        normals += [_unit(cross(_plus(v[j], v[i], -1.0), _plus(v[k], v[i], -1.0))) for i, j, k in faces]
    return [solid.pose.turn(normal) for normal in normals]


def are_apart(first: Solid3, second: Solid3, rounding: float) -> bool:
    """Return whether a plane separates the hulls of two shapes, which may overlap by the length ``rounding``, m."""
    offset = _plus(center(second), center(first), -1.0)
    axes = [solid.pose.turn(_Z) for solid in (first, second)]
    across = [_unit(_plus(offset, axis, -dot(offset, axis))) for axis in axes]
    # tried in turn: the line of the centres, lines across the axes, normals of faces
    for normal in (_unit(offset), *across, *directions(first), *directions(second)):
        back = _plus((0.0, 0.0, 0.0), normal, -1.0)
        if height(first, normal) + height(second, back) <= rounding:
            return True
        if height(second, normal) + height(first, back) <= rounding:
            return True
    return False


# --- points -----------------------------------------------------------------------------------------------------------


def _shell(p: Vec, inner: float, outer: float, length: float = 0.0) -> float:
    distance = math.hypot(p[0], p[1]) if length else _length(p)
    beyond = max(distance - outer, inner - distance if inner else -math.inf)
    return max(beyond, abs(p[2]) - length / 2) if length else beyond


def _beside(walls: list[Wall], p: Vec) -> float:
    return max(wall(_points(p)) for wall in walls)


_EXCESS: dict[str, Callable[[Dimensions, Vec], float]] = {
    "hollow_cylinder": lambda d, p: _shell(p, d["inner"], d["outer"], d["length"]),
    "hollow_sphere": lambda d, p: _shell(p, d["inner"], d["outer"]),
    "torus": lambda d, p: math.hypot(math.hypot(p[0], p[1]) - d["ring"], p[2]) - d["tube"],
    "spherical_shell": lambda d, p: abs(_length(p) - d["radius"]),
    "ring": lambda d, p: math.hypot(math.hypot(p[0], p[1]) - d["radius"], p[2]),
}


def is_convex(solid: Solid3) -> bool:
    """Return whether a shape contains all points between its points."""
    return solid.shape not in _EXCESS


def excess(solid: Solid3, point: Vec) -> float:
    """Return a length, m, that is negative for a point inside a shape, zero on its surface and positive outside.

    The point is in the axes of the body. Surfaces and curves have no inside.
    """
    p, d = solid.pose.from_body(point), solid.dimensions
    if solid.shape in _EXCESS:
        return _EXCESS[solid.shape](d, p)
    return _beside(_WALLS[solid.shape](d), p)
