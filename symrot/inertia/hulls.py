"""Convex hulls of shapes, described by simple pieces, and their extents along directions. Standard library only.

The hull of a shape is the convex hull of its pieces. A piece is a :class:`Disk` (all points within a distance of a flat
disk: a point, a circle, a ball or a torus), a :class:`Dome` (half a ball) or an ellipsoid. Lengths are doubles, in m.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, NamedTuple

from symrot.inertia.tensor import cross, dot

__all__ = [
    "AXES", "PARALLEL", "Dimensions", "Disk", "Ellipsoid", "Piece", "Pose", "Solid3", "Vec", "Z", "center", "corners",
    "directions", "enclosing_disk", "extent", "farthest", "height", "largest_distance", "opposite", "plus",
    "point_disks", "polygon_around", "size", "triangle", "unit_vector",
]  # fmt: skip

Vec = tuple[float, float, float]
Dimensions = Mapping[str, Any]  # lengths; vertices of a tetrahedron

MERIDIANS = 16  # of a polyhedron around a ball, a multiple of 4
CORNERS = 64  # of a polygon around a circle, where no exact bound is at hand
PARALLEL = 1e-12


def plus(a: Vec, b: Vec, factor: float = 1.0) -> Vec:
    """Return the vector ``a + factor * b``."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


def opposite(a: Vec) -> Vec:
    """Return the vector ``-a``."""
    return -a[0], -a[1], -a[2]


def unit_vector(a: Vec) -> Vec:
    """Return the unit vector along ``a``; along z if ``a`` is zero."""
    length = math.hypot(*a)
    return (a[0] / length, a[1] / length, a[2] / length) if length else (0.0, 0.0, 1.0)


class Pose(NamedTuple):
    """Position (m) and rotation matrix of a shape: ``x_body = at + rotation x_shape``."""

    at: Vec
    rotation: tuple[Vec, Vec, Vec]

    def rotate(self, v: Vec) -> Vec:
        """Return a vector in the axes of the body, from its components in the axes of the shape."""
        x, y, z = (dot(row, v) for row in self.rotation)
        return x, y, z

    def rotate_back(self, v: Vec) -> Vec:
        """Return a vector in the axes of the shape, from its components in the axes of the body."""
        x, y, z = (sum(self.rotation[i][k] * v[i] for i in range(3)) for k in range(3))
        return x, y, z

    def to_body(self, p: Vec) -> Vec:
        """Return a point in the axes of the body, from its coordinates in the axes of the shape."""
        return plus(self.at, self.rotate(p))

    def from_body(self, p: Vec) -> Vec:
        """Return a point in the axes of the shape, from its coordinates in the axes of the body."""
        return self.rotate_back(plus(p, self.at, -1.0))


@dataclass(frozen=True)
class Solid3:
    """A shape, by its name in :data:`symrot.inertia.shapes.SHAPES`, with its dimensions as doubles and its pose.

    The pose is the position and the rotation of the shape in the body.
    """

    shape: str
    dimensions: Dimensions
    pose: Pose

    @cached_property
    def hull(self) -> "list[Piece]":
        """The disks, domes and ellipsoids (pieces) whose convex hull is that of the shape, in the axes of the body."""
        return [_moved(piece, self.pose) for piece in _HULLS[self.shape](self.dimensions)]


class Disk(NamedTuple):
    """A flat disk with a margin: all points whose distance from the flat disk is at most ``margin``.

    The other fields are the centre, the unit normal and the radius of the flat disk. Radius and margin may be zero: a
    disk of radius 0 is a ball, whose radius is the margin.
    """

    center: Vec
    normal: Vec
    radius: float
    margin: float


class Dome(NamedTuple):
    """Half a ball: centre of the flat face, unit vector toward the dome, radius."""

    center: Vec
    axis: Vec
    radius: float


class Ellipsoid(NamedTuple):
    """An ellipsoid: centre and the three semi-axes as vectors."""

    center: Vec
    axes: tuple[Vec, Vec, Vec]


Piece = Disk | Dome | Ellipsoid
Z: Vec = (0.0, 0.0, 1.0)


def point_disks(*points: Vec) -> list[Piece]:
    """Return points as pieces of a hull: disks of radius zero."""
    return [Disk(point, Z, 0.0, 0.0) for point in points]


def _rim(z: float, radius: float, margin: float = 0.0) -> Piece:
    return Disk((0.0, 0.0, z), Z, radius, margin)


def _signs(a: float, b: float, c: float) -> list[Piece]:
    return point_disks(*((x, y, z) for x in {-a, a} for y in {-b, b} for z in {-c, c}))


def triangle(d: Dimensions) -> list[tuple[float, float]]:
    """Return the corners (x, y), counterclockwise, of a shape with the dimensions base, height and apex."""
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
    "hemisphere": lambda d: [Dome((0.0, 0.0, 0.0), Z, d["radius"])],
    "ellipsoid": lambda d: [Ellipsoid((0.0, 0.0, 0.0), ((d["a"], 0.0, 0.0), (0.0, d["b"], 0.0), (0.0, 0.0, d["c"])))],
    "torus": lambda d: [_rim(0.0, d["ring"], d["tube"])],
    "rod": lambda d: point_disks((0.0, 0.0, -d["length"] / 2), (0.0, 0.0, d["length"] / 2)),
    "disk": lambda d: [_rim(0.0, d["radius"])],
    "ring": lambda d: [_rim(0.0, d["radius"])],
    "plate": lambda d: _signs(d["a"] / 2, d["b"] / 2, 0.0),
    "triangular_plate": lambda d: point_disks(*((x, y, 0.0) for x, y in triangle(d))),
    "triangular_prism": lambda d: point_disks(
        *((x, y, z) for x, y in triangle(d) for z in (-d["length"] / 2, d["length"] / 2))
    ),
    "tetrahedron": lambda d: point_disks(*d["vertices"]),
}


def _moved(piece: Piece, pose: Pose) -> Piece:
    center = pose.to_body(piece.center)
    if isinstance(piece, Disk):
        return Disk(center, pose.rotate(piece.normal), piece.radius, piece.margin)
    if isinstance(piece, Dome):
        return Dome(center, pose.rotate(piece.axis), piece.radius)
    first, second, third = map(pose.rotate, piece.axes)
    return Ellipsoid(center, (first, second, third))


def extent(piece: Piece, direction: Vec) -> float:
    """Return the largest scalar product n x for points x of a piece, with the unit vector n = ``direction``."""
    base: float = dot(piece.center, direction)
    if isinstance(piece, Ellipsoid):
        return base + math.hypot(*(dot(axis, direction) for axis in piece.axes))
    axis = piece.normal if isinstance(piece, Disk) else piece.axis
    along: float = dot(axis, direction)
    if isinstance(piece, Disk):
        return base + piece.radius * math.sqrt(max(0.0, 1 - along * along)) + piece.margin
    return base + piece.radius * (1.0 if along >= 0 else math.sqrt(max(0.0, 1 - along * along)))


def enclosing_disk(piece: Piece) -> Disk:
    """Return a :class:`Disk` that contains a piece of a hull: the piece itself, or a ball around it."""
    if isinstance(piece, Disk):
        return piece
    radius = piece.radius if isinstance(piece, Dome) else max(math.hypot(*axis) for axis in piece.axes)
    return Disk(piece.center, Z, 0.0, radius)


def _farthest_along(piece: Piece, direction: Vec) -> Vec:
    """Return a point x of a piece with the largest scalar product n x, with the unit vector n = ``direction``."""
    if isinstance(piece, Ellipsoid):
        shares = [dot(axis, direction) for axis in piece.axes]
        length = math.hypot(*shares) or 1.0
        point = piece.center
        for axis, share in zip(piece.axes, shares, strict=True):
            point = plus(point, axis, share / length)
        return point
    axis = piece.normal if isinstance(piece, Disk) else piece.axis
    along = dot(axis, direction)
    across = plus(direction, axis, -along)
    rim = plus(piece.center, unit_vector(across), piece.radius if math.hypot(*across) > PARALLEL else 0.0)
    if isinstance(piece, Disk):
        return plus(rim, direction, piece.margin)
    return plus(piece.center, direction, piece.radius) if along >= 0 else rim


def farthest(solid: Solid3, direction: Vec) -> Vec:
    """Return a point of a shape's convex hull that is farthest along the unit vector ``direction``, in body axes."""
    points = [_farthest_along(piece, direction) for piece in solid.hull]
    return max(points, key=lambda point: dot(point, direction))


def height(solid: Solid3, direction: Vec) -> float:
    """Return the largest coordinate of points of a shape along a unit vector ``direction`` in the axes of the body."""
    return max(extent(piece, direction) for piece in solid.hull)


def center(solid: Solid3) -> Vec:
    """Return the middle of the box around a shape, in the axes of the body."""
    x, y, z = ((height(solid, axis) - height(solid, opposite(axis))) / 2 for axis in AXES)
    return x, y, z


def size(solid: Solid3) -> float:
    """Return the radius of a ball about :func:`center` that contains a shape."""
    middle = center(solid)
    return max(largest_distance(enclosing_disk(piece), middle) for piece in solid.hull)


AXES: tuple[Vec, Vec, Vec] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def largest_distance(disk: Disk, point: Vec) -> float:
    """Return the largest distance from ``point`` to points of a :class:`Disk`, a flat disk with a margin."""
    offset = plus(disk.center, point, -1.0)
    along = dot(offset, disk.normal)
    across = math.sqrt(max(0.0, dot(offset, offset) - along * along))
    return math.hypot(along, across + disk.radius) + disk.margin


def _across(axis: Vec) -> Vec:
    """Return a unit vector that is perpendicular to a unit vector."""
    return unit_vector(cross(axis, AXES[min(range(3), key=lambda k: abs(axis[k]))]))


def polygon_around(disk: Disk) -> list[Vec]:
    """Return the corners of a polygon around the flat disk of a :class:`Disk`, in the plane of this flat disk.

    The margin of the Disk is not included. For a flat disk of radius 0, the only corner is its centre.
    """
    if not disk.radius:
        return [disk.center]
    first = _across(disk.normal)
    second = cross(disk.normal, first)
    radius = disk.radius / math.cos(math.pi / CORNERS)
    turns = [2 * math.pi * k / CORNERS for k in range(CORNERS)]
    return [plus(plus(disk.center, first, radius * math.cos(t)), second, radius * math.sin(t)) for t in turns]


def corners(solid: Solid3) -> list[Vec]:
    """Return points whose convex hull contains a shape; an empty list for a torus."""
    points: list[Vec] = []
    for piece in solid.hull:
        if isinstance(piece, Disk) and not piece.margin:
            points += polygon_around(piece)
        elif isinstance(piece, Disk) and piece.radius:
            return []
        elif isinstance(piece, Dome):
            first = _across(piece.axis)
            axes = (first, cross(piece.axis, first), piece.axis)
            half = [point for point in _ball() if point[2] >= 0]
            points += [_combined(piece.center, axes, point, piece.radius) for point in half]
        elif isinstance(piece, Disk):
            points += [plus(piece.center, point, piece.margin) for point in _ball()]
        else:
            points += [_combined(piece.center, piece.axes, point, 1.0) for point in _ball()]
    return points


def _combined(center: Vec, axes: tuple[Vec, Vec, Vec], shares: Vec, factor: float) -> Vec:
    """Return the point ``center + factor * (shares[0] * axes[0] + shares[1] * axes[1] + shares[2] * axes[2])``."""
    for axis, share in zip(axes, shares, strict=True):
        center = plus(center, axis, factor * share)
    return center


@cache
def _ball() -> list[Vec]:
    """Return the corners of a polyhedron that contains the ball of radius 1.

    Some corners have z = 0, so that the corners with z >= 0 are those of a polyhedron around half the ball.
    """
    # the planes of its faces are nearer to the centre than the corners by the cosines of half their two angles
    step = math.pi / MERIDIANS
    radius = 1 / math.cos(step) ** 2
    rings = [(radius * math.cos(k * 2 * step), radius * math.sin(k * 2 * step) if k else 0.0)
             for k in range(-MERIDIANS // 4 + 1, MERIDIANS // 4)]  # fmt: skip
    around = [(math.cos(2 * step * n), math.sin(2 * step * n)) for n in range(MERIDIANS)]
    return [(0.0, 0.0, -radius), *((r * x, r * y, z) for r, z in rings for x, y in around), (0.0, 0.0, radius)]


def directions(solid: Solid3) -> list[Vec]:
    """Return the unit vectors along the axes of a shape and, for shapes with plane faces, normal to its faces."""
    normals = list(AXES)
    if solid.shape in ("triangular_plate", "triangular_prism"):
        corners = triangle(solid.dimensions)
        pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
        normals += [unit_vector((y2 - y1, x1 - x2, 0.0)) for (x1, y1), (x2, y2) in pairs]
    if solid.shape == "tetrahedron":
        v = solid.dimensions["vertices"]
        faces = ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
        normals += [unit_vector(cross(plus(v[j], v[i], -1.0), plus(v[k], v[i], -1.0))) for i, j, k in faces]
    return [solid.pose.rotate(normal) for normal in normals]
