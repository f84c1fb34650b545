"""Holes of a body of parts: whether each lies within parts whose density is at least its own. Standard library.

A hole (a part with ``subtract = true``) is mass that is taken away. Where no part is, or where two holes overlap, the
body would have a negative density. A body is refused if its density is negative at a test point. A hole is accepted if
it is proven to lie within the parts, and otherwise reported as doubtful.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise, product
from typing import Any, NamedTuple

from symrot.errors import InputError
from symrot.formula.tree import Node, evaluate, names
from symrot.inertia import hulls
from symrot.inertia.containment import are_apart, excess, is_convex, outside
from symrot.inertia.cutting import cut
from symrot.inertia.hulls import Vec
from symrot.inertia.integration import shape_points
from symrot.inertia.shapes import SHAPES, scalars
from symrot.inertia.tensor import dot

__all__ = ["DensePart", "PointMass", "dense_part", "doubtful_holes", "pose", "require_points"]

ROUNDING = 1e-9
"""Length by which a hole (a part that is subtracted) may reach out of the other parts, relative to the hole's radius.

The radius is that of a ball around the hole. Because of rounded dimensions, a hole that fits exactly may reach out by
this much."""

DENSITY = 0.01
"""Largest accepted excess of the density of a hole over that of the parts around it, as a fraction of the density.

Users state rounded masses, so that densities that should be equal may differ by this much."""

SHARES = (0.001, 0.25, 0.5, 0.75, 0.999)  # test points are at these fractions of the ranges of a hole's coordinates
INWARDS = 1e-6  # fraction of the way from the end of a hole to its middle, at which a test point lies
MOST_PIECES = 200  # largest number of pieces into which a hole is cut
MOST_CUTS = 50  # largest number of cuts of a hole that lies within several parts
MOST_POINTS = 200_000  # largest number of tests of a point against a part, for one hole
PointMass = tuple[Any, Sequence[Any]]  # mass, kg; position in the axes of the body, m


class DensePart(NamedTuple):
    """A part of a body, as the tests of holes need it: shape, position, density, and whether the part is a hole."""

    solid: hulls.Solid3
    exact_dimensions: Mapping[str, Any]
    # kg/m^3, kg/m^2 or kg/m: a number, or a polynomial in x, y, z
    density: Fraction | Node
    subtract: bool  # whether the part is a hole

    @property
    def kind(self) -> str:
        """The kind of the shape: ``"solid"``, ``"surface"`` or ``"curve"``."""
        return SHAPES[self.solid.shape].kind

    def density_at(self, point: Vec) -> float:
        """Return the density at a point of the body."""
        if isinstance(self.density, Fraction):
            return float(self.density)
        x, y, z = self.solid.pose.from_body(point)
        numbers = {name: float(value) for name, value in self._scalars.items()}
        return float(evaluate(self.density, {"pi": math.pi, **numbers, "x": x, "y": y, "z": z}, None, float))

    def has_density_of(self, other: "DensePart") -> bool:
        """Return whether both parts have the same formula of density, with the same numbers, in the same axes."""
        if isinstance(self.density, Fraction) or (self.density, self.solid.pose) != (other.density, other.solid.pose):
            return False
        mine, others = self._scalars, other._scalars
        return all(mine.get(name) == others.get(name) for name in names(self.density))

    @property
    def _scalars(self) -> dict[str, Any]:
        return scalars(SHAPES[self.solid.shape], self.exact_dimensions)


def pose(at: Sequence[Any], rotation: Sequence[Sequence[Any]]) -> hulls.Pose:
    """Return position and rotation matrix of a part in doubles."""
    x, y, z = map(float, at)
    first, second, third = ((float(a), float(b), float(c)) for a, b, c in rotation)
    return hulls.Pose((x, y, z), (first, second, third))


def dense_part(
    shape: str, dimensions: Mapping[str, Any], place: hulls.Pose, density: Fraction | Node, subtract: bool
) -> DensePart:
    """Return a part of a body: its exact ``dimensions``, and its shape in doubles, with which holes are tested.

    The tests show whether each hole lies within the other parts (:func:`doubtful_holes`). ``dimensions`` maps names to
    lengths or, for the corners of a tetrahedron, to a tuple of points.
    """
    rounded = {
        name: tuple(tuple(map(float, point)) for point in value) if isinstance(value, tuple) else float(value)
        for name, value in dimensions.items()
    }
    return DensePart(hulls.Solid3(shape, rounded, place), dimensions, density, subtract)


def doubtful_holes(parts: Sequence[DensePart | None], names: Sequence[str]) -> tuple[str, ...]:
    """Return a sentence for each hole in which the density of the body was not proven to be at least zero.

    Parameters
    ----------
    parts : sequence of DensePart or None
        The parts; None for point masses.
    names : sequence of str
        Place of each part in the scene, for messages.

    Raises
    ------
    InputError
        If the density of the body is negative at a point, because a hole reaches out of the parts, overlaps another
        hole, or has a larger density than the parts around it.
    """
    known = [part for part in parts if part is not None]
    sizes = {id(part): (hulls.center(part.solid), hulls.size(part.solid)) for part in known}
    doubts = []
    for hole, name in zip(parts, names, strict=True):
        if hole is None or not hole.subtract:
            continue
        middle, radius = sizes[id(hole)]
        near = [
            part
            for part in known
            if part.kind == hole.kind and part is not hole
            and math.dist(middle, sizes[id(part)][0]) <= (radius + sizes[id(part)][1]) * (1 + ROUNDING)
        ]  # fmt: skip
        if _is_within(hole, near, radius):
            continue
        _refuse_negative(hole, near, radius, name)
        if _is_covered(hole, near, radius):
            continue
        doubts.append(
            f"{name}: whether this hole lies within parts at least as dense as the material it removes could not be "
            "decided; where it does not, the body has a negative density"
        )
    return tuple(doubts)


def _is_within(hole: DensePart, near: Sequence[DensePart], radius: float) -> bool:
    """Return whether the density of the body is proven to be at least zero in a hole (a part that is subtracted).

    ``near`` are the other parts that may touch the hole; ``radius`` is that of a ball around the hole, m. The hole is
    tested as a whole, then in pieces (:func:`_pieces`).
    """
    rounding = ROUNDING * radius
    added = [part for part in near if not part.subtract]
    others = [part for part in near if part.subtract and not are_apart(hole.solid, part.solid, rounding)]

    def is_carried(piece: hulls.Solid3) -> bool:
        return _carry([part for part in added if outside(piece, part.solid) <= rounding], [hole, *others])

    if is_carried(hole.solid):
        return True
    pieces = _pieces(hole.solid, [part.solid for part in added])
    return bool(pieces) and all(map(is_carried, pieces))


def _is_covered(hole: DensePart, near: Sequence[DensePart], radius: float) -> bool:
    """Return whether a hole, such as a bore across the joint of two boxes, is proven to lie within several parts.

    The planes of the parts' faces cut the hole into pieces; each must lie within parts of sufficient density. The
    arguments are those of :func:`_is_within`.
    """
    rounding = ROUNDING * radius
    hosts = [part for part in near if not part.subtract and is_convex(part.solid)]
    others = [part for part in near if part.subtract and not are_apart(hole.solid, part.solid, rounding)]
    planes = [
        (normal, hulls.height(part.solid, normal))
        for part in hosts
        for direction in hulls.directions(part.solid)
        for normal in (direction, hulls.opposite(direction))
    ]
    waiting, cuts = [hulls.corners(hole.solid)], 0
    while waiting:
        piece = waiting.pop()
        around = [part for part in hosts if all(excess(part.solid, point) <= rounding for point in piece)]
        if piece and _carry(around, [hole, *others]):
            continue
        plane = next((plane for plane in planes if _crosses(plane, piece, rounding)), None)
        if plane is None or cuts == MOST_CUTS:
            return False
        waiting += cut(piece, *plane, rounding)
        cuts += 1
    return True


def _crosses(plane: tuple[Vec, float], points: Sequence[Vec], rounding: float) -> bool:
    """Return whether there are points on both sides of a plane.

    ``plane`` is the unit normal of the plane and its distance from the origin. A point closer to the plane than
    ``rounding``, m, counts as a point on the plane.
    """
    normal, height = plane
    heights = [dot(point, normal) - height for point in points]
    return bool(heights) and min(heights) < -rounding and max(heights) > rounding


def _carry(parts: Sequence[DensePart], holes: Sequence[DensePart]) -> bool:
    """Return whether the densities of ``parts`` certainly add up to at least the sum of the densities of ``holes``.

    All of them overlap; one per cent less is allowed (:data:`DENSITY`). A part whose density is a polynomial counts
    only for a single hole with the same density (:meth:`DensePart.has_density_of`).
    """
    filled = sum(part.density for part in parts if isinstance(part.density, Fraction))
    emptied = Fraction(0)
    for hole in holes:
        if not isinstance(hole.density, Fraction):  # a polynomial is compared with the same polynomial alone
            return len(holes) == 1 and any(part.has_density_of(hole) for part in parts)
        emptied += hole.density
    return float(emptied) <= float(filled) * (1 + DENSITY)


_CUT = {
    "box": (("a", 0), ("b", 1), ("c", 2)),
    "cylinder": (("length", 2),),
    "hollow_cylinder": (("length", 2),),
    "triangular_prism": (("length", 2),),
}
"""Shape of a hole -> pairs (name of a dimension, its axis 0, 1 or 2).

Planes normal to these axes cut the hole into pieces of the same shape: a box into boxes, a cylinder into cylinders.
"""


def _pieces(hole: hulls.Solid3, hosts: Sequence[hulls.Solid3]) -> list[hulls.Solid3]:
    """Cut a hole by planes normal to its own axes where one of the parts ``hosts`` begins or ends; return the pieces.

    A bore through two plates that touch gives two pieces. The list is empty for shapes other than boxes, cylinders and
    prisms, and if there would be more than MOST_PIECES pieces.
    """
    cuts = []
    for name, axis in _CUT.get(hole.shape, ()):
        half = hole.dimensions[name] / 2
        up = hole.pose.rotate(tuple(float(k == axis) for k in range(3)))  # type: ignore[arg-type]
        down = hulls.opposite(up)
        origin = dot(hole.pose.at, up)
        ends = {hulls.height(host, up) - origin for host in hosts}
        ends |= {-hulls.height(host, down) - origin for host in hosts}
        inside = sorted(end for end in ends if abs(end) < half * (1 - ROUNDING))
        cuts.append([(name, axis, low, high) for low, high in pairwise([-half, *inside, half])])
    if not cuts or math.prod(map(len, cuts)) > MOST_PIECES:
        return []
    pieces = []
    for ranges in product(*cuts):
        shift = [0.0, 0.0, 0.0]
        dimensions = dict(hole.dimensions)
        for name, axis, low, high in ranges:
            shift[axis], dimensions[name] = (low + high) / 2, high - low
        at = hole.pose.to_body((shift[0], shift[1], shift[2]))
        pieces.append(hulls.Solid3(hole.shape, dimensions, hulls.Pose(at, hole.pose.rotation)))
    return pieces


def _refuse_negative(hole: DensePart, near: Sequence[DensePart], radius: float, name: str) -> None:
    """Raise InputError if the density of the body is negative at a test point of a hole.

    The density of the body is the sum of the densities of the parts at the point, less those of the holes. ``name`` is
    the place of the hole in the scene, for the message; the other arguments are those of :func:`_is_within`.
    """
    rounding = ROUNDING * radius
    strict = -rounding if hole.kind == "solid" else rounding
    points = 0
    for point in _test_points(hole, near):
        points += len(near) + 1
        if points > MOST_POINTS:
            return
        if excess(hole.solid, point) > strict:
            continue
        own = hole.density_at(point)
        around = [part for part in near if not part.subtract and excess(part.solid, point) <= rounding]
        holes = [part for part in near if part.subtract and excess(part.solid, point) <= strict]
        filled = sum(part.density_at(point) for part in around)
        emptied = own + sum(part.density_at(point) for part in holes)
        if filled - emptied < -DENSITY * abs(own):
            unit = SHAPES[hole.solid.shape].density_unit
            place = ", ".join(f"{x:.5g}" for x in point)
            if not around:
                fault = f"one that reaches out of them, to ({place}) m in the axes of the body"
            elif holes and filled >= own * (1 - DENSITY):
                fault = f"one that overlaps another hole, at ({place}) m in the axes of the body"
            else:
                fault = f"a density of {own:.6g} {unit} where the other parts have {filled:.6g} {unit}, at ({place}) m"
            raise InputError(f"{name}: expected a hole within the other parts, got {fault}")


def _test_points(hole: DensePart, near: Sequence[DensePart]) -> Iterator[Vec]:
    """Yield points of a hole, in the axes of the body, at which the density of the body is tested.

    ``near`` are the other parts that may touch the hole. The first points are close to the ends of the hole along the
    axes and the face normals of the hole and of these parts, and toward and away from the centres of these parts. The
    others are a lattice in the hole.
    """
    middle = hulls.center(hole.solid)
    normals = [n for part in (hole, *near) for n in hulls.directions(part.solid)]
    for part in near:
        away = tuple(a - b for a, b in zip(middle, hulls.center(part.solid), strict=True))
        if length := math.hypot(*away):
            normals.append((away[0] / length, away[1] / length, away[2] / length))
    for normal in dict.fromkeys(normals):
        for end in (hulls.farthest(hole.solid, n) for n in (normal, hulls.opposite(normal))):
            first, second, third = (a + INWARDS * (b - a) for a, b in zip(end, middle, strict=True))
            yield first, second, third
    shape = SHAPES[hole.solid.shape]
    for point in shape_points(shape, scalars(shape, hole.exact_dimensions), SHARES):
        yield hole.solid.pose.to_body((point["x"], point["y"], point["z"]))


def require_points(added: Sequence[PointMass], subtracted: Sequence[tuple[str, PointMass]]) -> None:
    """Raise InputError unless each point mass that is subtracted is at the point of an added mass of at least its size.

    ``subtracted`` are pairs of the place in the scene, for messages, and the point mass.
    """
    size = max((math.hypot(*map(float, point)) for _, (_, point) in subtracted), default=0.0)
    for name, (_, point) in subtracted:
        there = sum(float(own) for own, other in added if math.dist(point, other) <= ROUNDING * size)
        gone = sum(float(own) for _, (own, other) in subtracted if math.dist(point, other) <= ROUNDING * size)
        if gone > there * (1 + DENSITY):
            place = ", ".join(f"{float(x):.6g}" for x in point)
            raise InputError(
                f"{name}: expected at most {there:.6g} kg to subtract at ({place}) m in the axes of the body, the "
                f"total of the other point masses there, got {gone:.6g} kg"
            )
