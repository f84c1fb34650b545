"""Whether one shape lies within another, from exact bounds of convex functions on its hull. Standard library only.

The boundary of the outer shape is described by walls: convex functions that are at most zero inside. On the inner shape
such a function is largest on the pieces of its hull (:mod:`symrot.inertia.hulls`). Lengths are doubles, in m; callers
allow for rounding by a tolerance.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from symrot.inertia import hulls
from symrot.inertia.hulls import AXES, PARALLEL, Dimensions, Piece, Solid3, Vec, Z, opposite, plus, unit_vector
from symrot.inertia.tensor import cross, dot

__all__ = ["are_apart", "excess", "is_convex", "outside"]

# --- walls ------------------------------------------------------------------------------------------------------------

Wall = Callable[[list[Piece]], float]
"""A function that returns a length, m: if it is at most 0, a convex hull does not reach beyond a wall.

A wall is, for example, the plane of a face. The argument is the list of the disks, domes and ellipsoids (pieces) that
span the hull. A positive length does not prove that the hull reaches beyond the wall.
"""


def _plane(normal: Vec, limit: float) -> Wall:
    return lambda pieces: max(hulls.extent(piece, normal) for piece in pieces) - limit


def _tube_wall(radius: float, slope: float) -> Wall:
    """Return the wall ``rho + slope z <= radius`` of a cylinder or a cone about the z axis."""
    steep = math.hypot(1.0, slope)

    def reach(piece: Piece) -> float:
        disk = hulls.enclosing_disk(piece)
        if abs(disk.normal[0]) + abs(disk.normal[1]) < PARALLEL or not disk.radius:
            x, y, z = disk.center
            return math.hypot(x, y) + disk.radius + slope * z + disk.margin * steep
        return max(math.hypot(x, y) + slope * z for x, y, z in hulls.polygon_around(disk)) + disk.margin * steep

    return lambda pieces: (max(map(reach, pieces)) - radius) / steep


def _ball_wall(radius: float) -> Wall:
    return lambda pieces: (
        max(hulls.largest_distance(hulls.enclosing_disk(piece), (0.0, 0.0, 0.0)) for piece in pieces) - radius
    )


def _ellipsoid_wall(a: float, b: float, c: float) -> Wall:
    least = min(a, b, c)

    def scaled(v: Vec) -> Vec:
        return v[0] / a, v[1] / b, v[2] / c

    def reach(piece: Piece) -> float:
        if isinstance(piece, hulls.Ellipsoid):
            axes = [scaled(axis) for axis in piece.axes]
            crossed = max(abs(dot(axes[i], axes[j])) for i, j in ((0, 1), (0, 2), (1, 2)))
            lengths = [math.hypot(*axis) for axis in axes]
            spread = max(lengths) if crossed < PARALLEL else math.hypot(*lengths)
            return math.hypot(*scaled(piece.center)) + spread
        disk = hulls.enclosing_disk(piece)
        return max(math.hypot(*scaled(point)) for point in hulls.polygon_around(disk)) + disk.margin / least

    return lambda pieces: (max(map(reach, pieces)) - 1) * least


def _flat(*walls: Wall) -> list[Wall]:
    return [_plane((0.0, 0.0, 1.0), 0.0), _plane((0.0, 0.0, -1.0), 0.0), *walls]


def _slabs(*limits: tuple[int, float]) -> list[Wall]:
    """Return pairs of parallel planes; each pair is given by (axis 0, 1 or 2 normal to it, its distance from 0)."""
    return [_plane(normal, limit) for axis, limit in limits for normal in (AXES[axis], opposite(AXES[axis]))]


def _sides(d: Dimensions) -> list[Wall]:
    corners = hulls.triangle(d)
    walls = []
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        normal = unit_vector((y2 - y1, x1 - x2, 0.0))  # outwards, as the corners are counterclockwise
        walls.append(_plane(normal, normal[0] * x1 + normal[1] * y1))
    return walls


def _faces(d: Dimensions) -> list[Wall]:
    walls = []
    for k in range(4):
        a, b, c = (d["vertices"][i] for i in range(4) if i != k)
        normal = unit_vector(cross(plus(b, a, -1.0), plus(c, a, -1.0)))
        if dot(normal, plus(d["vertices"][k], a, -1.0)) > 0:
            normal = opposite(normal)
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


def _relative(inner: Solid3, outer: Solid3) -> hulls.Pose:
    """Return the position and rotation of the shape ``inner`` in the axes of the shape ``outer``."""
    columns = [outer.pose.rotate_back(inner.pose.rotate(axis)) for axis in AXES]
    first, second, third = ((columns[0][i], columns[1][i], columns[2][i]) for i in range(3))
    return hulls.Pose(outer.pose.from_body(inner.pose.at), (first, second, third))


def outside(inner: Solid3, outer: Solid3) -> float:
    """Return a length, m: if it is at most 0, the shape ``inner`` is proven to lie inside ``outer``.

    A positive length does not prove that ``inner`` reaches out. The length is infinite if ``outer`` is a spherical
    shell or a ring, unless ``inner`` is the same shape at the same position.
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
    """Return an upper bound of the length by which a shape reaches into the bore of a hollow cylinder or sphere.

    The bore has the given radius; the shape is in the axes of the hollow cylinder (``is_cylinder``) or sphere.
    """
    x, y, z = own.pose.at
    if own.shape == ("hollow_cylinder" if is_cylinder else "hollow_sphere"):
        tilt = abs(own.pose.rotate(Z)[0]) + abs(own.pose.rotate(Z)[1]) if is_cylinder else 0.0
        if tilt < PARALLEL:
            offset = math.hypot(x, y) if is_cylinder else math.hypot(x, y, z)
            if offset < own.dimensions["inner"]:
                return float(radius - own.dimensions["inner"] + offset)
    middle = hulls.center(own)
    toward = unit_vector((middle[0], middle[1], 0.0) if is_cylinder else middle)
    return radius + hulls.height(own, opposite(toward))


def _out_of_torus(own: Solid3, pieces: list[Piece], d: Dimensions) -> float:
    x, y, z = own.pose.at
    normal = own.pose.rotate(Z)
    if own.shape == "torus" and abs(normal[0]) + abs(normal[1]) < PARALLEL and math.hypot(x, y) == 0:
        return float(math.hypot(own.dimensions["ring"] - d["ring"], z) + own.dimensions["tube"] - d["tube"])
    x, y, z = hulls.center(own)
    return float(math.hypot(math.hypot(x, y) - d["ring"], z) + hulls.size(own) - d["tube"])


def are_apart(first: Solid3, second: Solid3, rounding: float) -> bool:
    """Return whether one of several tested planes separates the hulls of two shapes.

    The hulls may overlap by the length ``rounding``, m. False does not prove that they overlap by more.
    """
    offset = plus(hulls.center(second), hulls.center(first), -1.0)
    axes = [solid.pose.rotate(Z) for solid in (first, second)]
    across = [unit_vector(plus(offset, axis, -dot(offset, axis))) for axis in axes]
    # tried in turn: the line of the centres, lines across the axes, normals of faces
    for normal in (unit_vector(offset), *across, *hulls.directions(first), *hulls.directions(second)):
        back = opposite(normal)
        if hulls.height(first, normal) + hulls.height(second, back) <= rounding:
            return True
        if hulls.height(second, normal) + hulls.height(first, back) <= rounding:
            return True
    return False


# --- points -----------------------------------------------------------------------------------------------------------


def _shell(p: Vec, inner: float, outer: float, length: float = 0.0) -> float:
    distance = math.hypot(p[0], p[1]) if length else math.hypot(*p)
    beyond = max(distance - outer, inner - distance if inner else -math.inf)
    return max(beyond, abs(p[2]) - length / 2) if length else beyond


_EXCESS: dict[str, Callable[[Dimensions, Vec], float]] = {
    "hollow_cylinder": lambda d, p: _shell(p, d["inner"], d["outer"], d["length"]),
    "hollow_sphere": lambda d, p: _shell(p, d["inner"], d["outer"]),
    "torus": lambda d, p: math.hypot(math.hypot(p[0], p[1]) - d["ring"], p[2]) - d["tube"],
    "spherical_shell": lambda d, p: abs(math.hypot(*p) - d["radius"]),
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
    return max(wall(hulls.point_disks(p)) for wall in _WALLS[solid.shape](d))
