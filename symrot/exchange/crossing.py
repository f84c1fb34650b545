"""Tests that a closed surface is the boundary of a body: winding numbers along lines, and pairs of crossing triangles.

A surface bounds a body if each point of space has the winding number 0 (outside) or 1 (inside). Crossings of straight
lines with the surface give these numbers. A line that meets an edge of a triangle tests nothing. All pairs of triangles
are searched only in small meshes.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.exchange.surface import Surface, shells

__all__ = ["interior_points", "require_boundary"]

Floats = NDArray[np.float64]

MOST_TESTS = 50_000_000
"""Largest number of tests of a triangle against a line; it limits the number of lines."""

MOST_PAIRS = 5_000_000
"""Largest number of pairs of triangles that are searched for crossings; if there are more, none is searched.

The triangles of a pair overlap along one coordinate axis.
"""

MOST_SEARCHED = 200_000
"""Largest number of triangles of a mesh whose pairs of triangles are searched for crossings; larger meshes are not."""

MOST_ANGLES = 5_000_000
"""Largest number of solid angles that are computed, one for each triangle and test point.

It limits the number of test points: inside the surface, and around the contacts at which triangles touch."""

DIRECTIONS = 64  # number of points that are tested around a contact
DISTANCE = 1e-3  # distance of these points from the contact, relative to the size of the mesh
MOST_SHELLS = 1000
NEAR = 1e-12  # distance, relative to the size of the mesh, below which two crossings of a line count as one place
THIN = 1e-14  # area, relative to the size squared, below which a line may pass through an edge
PLACES = ((0.36, 0.33), (0.21, 0.43), (0.55, 0.17))  # where a line may pass through its triangle, tried in turn
AXES = ((1, 2, 0), (2, 0, 1), (0, 1, 2))  # depth last


class _Boxes(NamedTuple):
    """The smallest and the largest coordinates of each triangle, shape (3 axes, number of triangles)."""

    low: Floats
    high: Floats

    def around(self, axis: int, value: Any) -> NDArray[np.bool_]:
        """Return, for each triangle, whether its range along ``axis`` (0, 1 or 2) contains ``value``."""
        within: NDArray[np.bool_] = self.low[axis] <= value
        within &= self.high[axis] >= value
        return within


def require_boundary(surface: Surface, where: str) -> str:
    """Test that a closed surface is the boundary of a body; return a sentence about the tests that it passed.

    Several shells are allowed: separate parts, and cavities, whose normals point into the cavity. Raise InputError if a
    test shows that the surface crosses itself or is inside out, or if it has more than 1000 shells.
    """
    numbers = shells(surface)
    count = int(numbers.max()) + 1
    if count > MOST_SHELLS:
        raise InputError(f"{where}: expected at most {MOST_SHELLS} shells (parts without common vertices), got {count}")
    size = float(np.ptp(surface.vertices, axis=0).max())
    columns = np.ascontiguousarray(((surface.vertices - surface.vertices.min(axis=0)) / size).T)
    corners = np.empty((3, 3, len(surface.triangles)))  # corner, axis, triangle
    for corner in range(3):
        index = np.ascontiguousarray(surface.triangles[:, corner])
        for axis in range(3):
            np.take(columns[axis], index, out=corners[corner, axis])
    boxes = _Boxes(corners.min(axis=0), corners.max(axis=0))
    chosen = _chosen(corners, numbers, count)
    lines = sum(_passes(corners, boxes, int(triangle), where, surface) for triangle in chosen)
    contacts = _search_pairs(surface, boxes, where) if len(surface.triangles) <= MOST_SEARCHED else None
    parts = f"{count} shells" if count > 1 else "one shell"
    pairs = "pairs of triangles were not searched for crossings"
    if contacts is not None:
        tested = _require_contacts(surface, contacts, where)
        pairs = "no two triangles cross"
        pairs += f"; triangles touch at {len(contacts)} points, {tested} of them tested" if len(contacts) else ""
    return (
        f"the surface is closed ({parts}); {lines} of {len(chosen)} test lines cross it alternately inwards and "
        f"outwards, as they must, and the others meet an edge, which tests nothing; {pairs}"
    )


def _chosen(corners: Floats, numbers: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return the indices of the triangles through which straight lines are drawn, to test winding numbers along them.

    ``numbers`` are the numbers of the triangles' shells (connected parts), 0 to ``count`` - 1.
    """
    edges = corners[1] - corners[0], corners[2] - corners[0]
    areas = sum((edges[0][i] * edges[1][j] - edges[0][j] * edges[1][i]) ** 2 for i, j, _ in AXES)
    order = np.lexsort((areas, numbers)) if count > 1 else np.array([int(areas.argmax())])
    last = np.flatnonzero(np.diff(numbers[order], append=count)) if count > 1 else np.array([0])
    # the largest triangle of each shell, and every j-th triangle, so that the test takes a few seconds at most
    largest = order[last]
    total = len(areas)
    others = np.linspace(0, total - 1, max(1, min(total, MOST_TESTS // total))).astype(np.int64)
    others = others[areas[others] > 0]
    return np.unique(np.concatenate([largest, others]))


def _passes(corners: Floats, boxes: _Boxes, triangle: int, where: str, surface: Surface) -> int:
    """Test the winding numbers along a line through a triangle; return 1, or 0 if every tried line meets an edge.

    Raise InputError if a winding number is neither 0 (outside the surface) nor 1 (inside).
    """
    own = corners[:, :, triangle]
    normal = np.cross(own[1] - own[0], own[2] - own[0])
    axes = AXES[int(np.abs(normal).argmax())]
    # a line that meets an edge cannot be tested
    for share, other in PLACES:
        target = own[0] + share * (own[1] - own[0]) + other * (own[2] - own[0])
        profile = _profile(corners, boxes, target, axes)
        if profile is not None:
            depths, windings = profile
            # all points of the line need the winding number 0 or 1
            wrong = np.flatnonzero((windings != 0) & (windings != 1))
            if len(wrong):
                _refuse(int(windings[wrong[0]]), target, axes[2], depths, int(wrong[0]), where, surface)
            return 1
    return 0


def _profile(
    corners: Floats, boxes: _Boxes, target: Floats, axes: tuple[int, int, int]
) -> tuple[Floats, NDArray[np.int64]] | None:
    """Return where a line crosses the surface, as coordinates along the line, and the winding number after each place.

    The line passes through ``target`` and is parallel to the last of the three ``axes``. None if it passes near an edge
    of a triangle.
    """
    u, v, depth = axes
    near = np.flatnonzero(boxes.around(u, target[u]))
    near = near[_Boxes(boxes.low[:, near], boxes.high[:, near]).around(v, target[v])]
    candidates = corners[:, :, near]
    x, y = candidates[:, u] - target[u], candidates[:, v] - target[v]
    areas = np.stack([x[i] * y[j] - x[j] * y[i] for i, j in ((1, 2), (2, 0), (0, 1))])
    inside = (areas > THIN).all(axis=0) | (areas < -THIN).all(axis=0)
    outside = (areas > THIN).any(axis=0) & (areas < -THIN).any(axis=0)
    if not np.all(inside | outside):
        return None
    hits, areas = candidates[:, :, inside], areas[:, inside]
    depths = (areas * hits[:, depth]).sum(axis=0) / areas.sum(axis=0)
    order = np.argsort(depths, kind="stable")
    windings = -np.cumsum(np.sign(areas[0, order]).astype(np.int64))
    ends = np.flatnonzero(np.append(np.diff(depths[order]) > NEAR, True))  # the last crossing at each place
    return depths[order][ends], windings[ends]


def _refuse(winding: int, target: Floats, axis: int, depths: Floats, index: int, where: str, surface: Surface) -> None:
    point = target.copy()
    point[axis] = (depths[index] + depths[min(index + 1, len(depths) - 1)]) / 2
    size = float(np.ptp(surface.vertices, axis=0).max())
    place = ", ".join(f"{x:.6g}" for x in surface.vertices.min(axis=0) + size * point)
    reason = "part of it is turned inside out" if winding < 0 else "parts overlap, or a cavity has its normals outwards"
    raise InputError(
        f"{where}: expected a surface that does not cross itself, where every winding number is 0 (outside) or 1 "
        f"(inside), got a winding number of {winding} at ({place}): {reason}"
    )


# --- pairs of triangles -----------------------------------------------------------------------------------------------


def _search_pairs(surface: Surface, boxes: _Boxes, where: str) -> Floats | None:
    """Return the points where an edge of a triangle touches an edge or a corner of another triangle.

    Return None if there are too many pairs of triangles. Raise InputError if a triangle passes through the inside of
    another one.
    """
    low, high = boxes
    axis = int(np.argmin((high - low).mean(axis=1)))
    order = np.argsort(low[axis], kind="stable")
    last = np.searchsorted(low[axis, order], high[axis, order], side="right")
    counts = last - np.arange(len(order)) - 1
    if int(counts.sum()) > MOST_PAIRS:
        return None
    first = np.repeat(np.arange(len(order)), counts)
    starts = np.repeat(np.cumsum(counts) - counts, counts)
    second = first + 1 + np.arange(len(first)) - starts
    i, j = order[first], order[second]
    overlap = np.ones(len(i), bool)
    for other in range(3):
        if other != axis:
            overlap &= (low[other, i] <= high[other, j]) & (low[other, j] <= high[other, i])
    i, j = i[overlap], j[overlap]
    # Triangles with a common edge cannot cross; those with one common vertex can.
    shared = (surface.triangles[i][:, :, None] == surface.triangles[j][:, None, :]).sum(axis=(1, 2))
    i, j = i[shared < 2], j[shared < 2]
    crossing = _cross_along_a_line(surface, i, j)
    if crossing is not None:
        _refuse_crossing(surface, crossing, where)
    # An edge that passes through the interior of a triangle crosses it. An edge that passes through the boundary of a
    # triangle, up to rounding errors, may belong to bodies that only touch.
    contacts = []
    for one, other in ((i, j), (j, i)):
        for k in range(3):
            crossing, points = _pierces(surface, one, other, k)
            if crossing is not None:
                _refuse_crossing(surface, crossing, where)
            contacts.append(points)
    return np.unique(np.concatenate(contacts), axis=0)


def _refuse_crossing(surface: Surface, triangle: int, where: str) -> None:
    point = ", ".join(f"{x:.6g}" for x in surface.vertices[surface.triangles[triangle]].mean(axis=0))
    raise InputError(
        f"{where}: expected a surface that does not cross itself, got triangles that cross near ({point}); "
        "join the parts by a Boolean union in your mesh program"
    )


def _cross_along_a_line(surface: Surface, i: NDArray[np.int64], j: NDArray[np.int64]) -> int | None:
    """Return the first triangle of ``i`` that crosses its partner in ``j``, or None.

    Triangles cross if the line in which their planes meet passes through the interiors of both, and if the intervals
    inside the two triangles overlap by more than a point, as far as rounding errors allow to decide.
    """
    # Source: Guigue & Devillers, J. Graphics Tools 8 (2003) 25: each end of an interval is on an edge that leaves the
    # corner alone on its side of the other plane, and four corners tell which of two ends comes first on the line.
    pairs = surface.triangles[i], surface.triangles[j]
    sides = [
        np.stack([_sides(surface, o[:, 0], o[:, 1], o[:, 2], x) for x in own.T], axis=1)
        for own, o in (pairs, pairs[::-1])
    ]
    split = np.flatnonzero(np.logical_and(*((each.min(axis=1) < 0) & (each.max(axis=1) > 0) for each in sides)))
    corners, above = [], []
    for own, each in zip(pairs, sides, strict=True):
        own, each = own[split], each[split]
        is_above = (each > 0).sum(axis=1) == 1
        alone = np.where(is_above, each.argmax(axis=1), each.argmin(axis=1))
        corners.append([own[np.arange(len(own)), (alone + k) % 3] for k in range(3)])
        above.append(is_above)
    (p1, q1, r1), (p2, q2, r2) = corners
    # the orientation in which the lonely corner of the other triangle is above
    q1, r1 = np.where(above[1], q1, r1), np.where(above[1], r1, q1)
    q2, r2 = np.where(above[0], q2, r2), np.where(above[0], r2, q2)
    overlap = (_sides(surface, p1, q1, p2, q2) < 0) & (_sides(surface, p1, r1, r2, p2) < 0)
    return int(i[split[int(overlap.argmax())]]) if overlap.any() else None


def _pierces(
    surface: Surface, edges_of: NDArray[np.int64], through: NDArray[np.int64], k: int
) -> tuple[int | None, Floats]:
    """Test whether edge ``k`` of each triangle in ``edges_of`` passes through the triangle in ``through``.

    Return the first triangle of ``edges_of`` whose edge passes through the interior of the other triangle, or None; and
    the points where edges pass through the boundary of the other triangle.
    """
    corners = surface.triangles
    a, b, c = (corners[through, n] for n in range(3))
    p, q = corners[edges_of, k], corners[edges_of, (k + 1) % 3]
    above, below = _sides(surface, a, b, c, p), _sides(surface, a, b, c, q)
    split = np.flatnonzero(above * below < 0)
    a, b, c, p, q = a[split], b[split], c[split], p[split], q[split]
    signs = np.stack([_sides(surface, p, q, x, y) for x, y in ((a, b), (b, c), (c, a))])
    within = ~((signs > 0).any(axis=0) & (signs < 0).any(axis=0))
    inside = within & (signs != 0).all(axis=0)
    if inside.any():
        return int(edges_of[split[int(inside.argmax())]]), np.empty((0, 3))
    a, b, c, p, q = (surface.vertices[index[within]] for index in (a, b, c, p, q))
    normal = np.cross(b - a, c - a)
    first, second = ((normal * (end - a)).sum(axis=1) for end in (p, q))
    share = np.divide(first, first - second, out=np.full(len(first), 0.5), where=first != second)[:, None]
    return None, p + share * (q - p)


def _require_contacts(surface: Surface, contacts: Floats, where: str) -> int:
    """Check the winding numbers of a surface around points where its parts touch; return how many points were checked.

    Raise InputError if a winding number is neither 0 nor 1. At most ``len(contacts)`` points are checked, fewer for
    large surfaces.
    """
    size = float(np.ptp(surface.vertices, axis=0).max())
    corners = (surface.vertices - surface.vertices.min(axis=0))[surface.triangles] / size
    most = max(1, MOST_ANGLES // (DIRECTIONS * len(corners)))
    chosen = contacts[np.unique(np.linspace(0, len(contacts) - 1, min(len(contacts), most)).astype(np.int64))]
    height = 1 - (2 * np.arange(DIRECTIONS) + 1) / DIRECTIONS  # directions spread evenly along a spiral
    angle, radius = 1 + 2.39996323 * np.arange(DIRECTIONS), np.sqrt(1 - height**2)
    around = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    for contact in chosen:
        points = (contact - surface.vertices.min(axis=0)) / size + DISTANCE * around
        numbers = _windings(corners, points)
        wrong = np.flatnonzero((numbers != 0) & (numbers != 1))
        if len(wrong):
            depths = points[wrong[0], 2:]
            _refuse(int(numbers[wrong[0]]), points[wrong[0]], 2, depths, 0, where, surface)
    return len(chosen)


def _windings(corners: Floats, points: Floats) -> Floats:
    """Return the winding number of a surface about each point, the sum of the solid angles of its triangles / 4 pi.

    It is 0 for a point on the surface.
    """
    windings = np.zeros(len(points))
    # Source: van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
    for number, point in enumerate(points):
        a, b, c = (corners[:, k] - point for k in range(3))
        lengths = [np.sqrt((end * end).sum(axis=1)) for end in (a, b, c)]
        products = [(x * y).sum(axis=1) for x, y in ((b, c), (c, a), (a, b))]
        below = lengths[0] * lengths[1] * lengths[2] + sum(d * n for d, n in zip(products, lengths, strict=True))
        angles = 2 * np.arctan2((a * np.cross(b, c)).sum(axis=1), below)
        if np.abs(angles).max() <= 2 * np.pi - 1e-6:
            windings[number] = np.round(angles.sum() / (4 * np.pi))
    return windings


def interior_points(surface: Surface) -> Floats:
    """Return points of a lattice that are inside a surface, shape (n, 3).

    If the surface has many triangles, only some points of the lattice are tested.
    """
    lowest, size = surface.vertices.min(axis=0), np.ptp(surface.vertices, axis=0)
    lattice = np.stack(np.meshgrid(*[np.linspace(0, 1, 9)[1:-1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    count = min(len(lattice), MOST_ANGLES // len(surface.triangles))
    chosen = lattice[np.linspace(0, len(lattice) - 1, count).astype(np.int64)]
    corners = ((surface.vertices - lowest) / size)[surface.triangles]
    points: Floats = lowest + size * chosen[_windings(corners, chosen) == 1]
    return points


def _sides(surface: Surface, a: Any, b: Any, c: Any, d: Any) -> NDArray[np.int64]:
    """Return the side of the plane (a, b, c) on which each vertex d lies, 1 or -1; 0 if rounding could change it."""
    p, q, r, s = (surface.vertices[index] for index in (a, b, c, d))
    u, v, w = p - s, q - s, r - s
    products = np.stack([u[:, i] * (v[:, j] * w[:, k]) for i, j, k in _PERMUTATIONS])
    value = products[:3].sum(axis=0) - products[3:].sum(axis=0)
    bound = np.abs(products).sum(axis=0) * 2.0**-48
    signs: NDArray[np.int64] = np.where(np.abs(value) <= bound, 0, np.sign(value)).astype(np.int64)
    return signs


_PERMUTATIONS = ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2), (2, 1, 0))
