"""Cutting the convex hull of points by a plane. Standard library only."""

from collections.abc import Iterable

from symrot.inertia.hulls import Vec
from symrot.inertia.tensor import dot

__all__ = ["cut"]


def cut(points: list[Vec], normal: Vec, height: float, rounding: float) -> tuple[list[Vec], list[Vec]]:
    """Cut the convex hull of ``points`` by a plane; return two lists of points whose hulls are the two parts.

    The plane has the unit normal ``normal`` and the distance ``height`` from the origin; the first part is below it.
    Points that are nearer to it than ``rounding`` belong to both parts.
    """
    heights = [dot(point, normal) - height for point in points]
    below = [point for point, h in zip(points, heights, strict=True) if h <= rounding]
    above = [point for point, h in zip(points, heights, strict=True) if h >= -rounding]
    between = []
    for low, p in zip(heights, points, strict=True):
        if low >= -rounding:
            continue
        for high, q in zip(heights, points, strict=True):
            if high > rounding:
                share = low / (low - high)
                between.append((
                    p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2])
                ))  # fmt: skip
    corners = _corners(between, normal)
    return below + corners, above + corners


def _corners(points: list[Vec], normal: Vec) -> list[Vec]:
    """Return the corners of the convex hull of points in a plane."""
    # Andrew's monotone chain, in the two coordinates that the normal does not dominate
    i, j = sorted(range(3), key=lambda axis: abs(normal[axis]))[:2]

    def chain(ordered: Iterable[Vec]) -> list[Vec]:
        hull: list[Vec] = []
        for p in ordered:
            while len(hull) > 1 and _is_right(hull[-2], hull[-1], p, i, j):
                hull.pop()
            hull.append(p)
        return hull[:-1]

    distinct = sorted(set(points), key=lambda p: (p[i], p[j]))
    if len(distinct) < 3:
        return distinct
    return chain(distinct) + chain(reversed(distinct))


def _is_right(a: Vec, b: Vec, c: Vec, i: int, j: int) -> bool:
    """Return whether c is to the right of the line from a to b, or on it, in a drawing of coordinates ``i``, ``j``."""
    return (b[i] - a[i]) * (c[j] - a[j]) <= (b[j] - a[j]) * (c[i] - a[i])
