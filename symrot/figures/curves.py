"""Curves in space for figures: circles, arcs, outlines of ellipsoids and cones, and rotated points."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.figures.view import Floats, View
from symrot.kinematics.conversions import axis_angle_to_quaternion, quaternion_to_dcm

__all__ = [
    "CIRCLE", "TURN", "arc_between", "basis", "circle", "clear_of", "cone", "frame", "outline", "rotated",
    "rotation", "turning", "unit",
]  # fmt: skip

TURN = np.linspace(0.0, 2 * np.pi, 121)
"""Array of 121 evenly spaced angles from 0 to 2 pi, rad."""

CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)], axis=1)
"""Points of the unit circle in a plane, shape (121, 2)."""


def unit(vector: ArrayLike) -> Floats:
    """Return a vector divided by its length."""
    array = np.asarray(vector, dtype=float)
    direction: Floats = array / np.linalg.norm(array)
    return direction


def basis(normal: ArrayLike) -> tuple[Floats, Floats]:
    """Return two unit vectors that form a right-handed triad with ``normal``.

    The second points upward, unless the normal is nearly vertical.
    """
    n = unit(normal)
    helper = np.array([0.0, 0.0, 1.0]) if abs(n[2]) < 0.99 else np.array([1.0, 0.0, 0.0])
    first = unit(np.cross(helper, n))
    return first, np.cross(n, first)


def circle(centre: ArrayLike, normal: ArrayLike, radius: float, angles: Floats = TURN) -> Floats:
    """Return points of a circle in space, shape (n, 3), around ``centre``, one for each of ``angles``, rad.

    ``normal`` is perpendicular to the plane of the circle.
    """
    first, second = basis(normal)
    points: Floats = np.asarray(centre) + radius * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))
    return points


def rotation(axis: ArrayLike, angle: float) -> Floats:
    """Return the rotation matrix, shape (3, 3), of a rotation about an axis; the angle is in degrees."""
    return np.asarray(quaternion_to_dcm(axis_angle_to_quaternion(unit(axis), angle, degrees=True)), dtype=float)


def rotated(point: ArrayLike, axis: ArrayLike, angle: float, count: int = 41) -> Floats:
    """Return the positions of a point during a rotation about an axis, shape (count, 3); the angle is in degrees."""
    return np.array([rotation(axis, part) @ np.asarray(point) for part in np.linspace(0.0, angle, count)])


def arc_between(start: ArrayLike, end: ArrayLike, radius: float, centre: ArrayLike = (0, 0, 0)) -> Floats:
    """Return points of the shorter arc from the direction ``start`` to the direction ``end``, shape (n, 3).

    The arc belongs to the circle of the given radius about ``centre``. The directions must not be parallel.
    """
    a, b = unit(start), unit(end)
    across = unit(b - a * (a @ b))
    angles = np.linspace(0.0, float(np.arccos(np.clip(a @ b, -1, 1))), 41)
    points: Floats = np.asarray(centre) + radius * (np.outer(np.cos(angles), a) + np.outer(np.sin(angles), across))
    return points


def outline(shape: Floats, view: View) -> Floats:
    """Return the outline of the ellipsoid ``x · shape x = 1`` as ``view`` shows it: points in space, shape (n, 3)."""
    inverse = np.linalg.inv(shape)
    root = np.linalg.cholesky(inverse)  # maps the unit sphere to the ellipsoid
    # its normals are perpendicular to the line of sight
    return circle((0, 0, 0), root.T @ shape @ view.toward, 1.0) @ root.T


def clear_of(shape: Floats, points: Floats, view: View) -> NDArray[np.bool_]:
    """Return for each point whether the ellipsoid ``x · shape x = 1`` does not hide it from the viewer.

    The points are outside the ellipsoid; figures draw the hidden ones dashed.
    """
    ahead = shape @ view.toward
    square, middle = view.toward @ ahead, points @ ahead
    rest = np.einsum("ni,ij,nj->n", points, shape, points) - 1.0
    clear: NDArray[np.bool_] = (middle >= -1e-9) | (middle**2 < square * rest)
    return clear


def turning(start: ArrayLike, end: ArrayLike) -> Floats:
    """Return the unit quaternion of the shortest rotation that maps the direction ``start`` to ``end``.

    The directions must not be parallel.
    """
    a, b = unit(start), unit(end)
    angle = float(np.arccos(np.clip(a @ b, -1, 1)))
    return np.asarray(axis_angle_to_quaternion(unit(np.cross(a, b)), angle), dtype=float)


def cone(axis: ArrayLike, half_angle: float, length: float, view: View) -> tuple[Floats, list[Floats]]:
    """Return the rim of a cone with its apex at the origin and sides of ``length``, and two lines: its visible outline.

    There are no such lines if the line of sight lies inside the cone.
    """
    n, radius = unit(axis), length * np.sin(half_angle)
    rim = circle(length * np.cos(half_angle) * n, n, radius)
    first, second = basis(n)
    toward = view.toward
    # a line of the cone at angle p belongs to the outline if its normal is across the view
    a, b = toward @ first, toward @ second
    c = toward @ n * np.tan(half_angle)
    size = np.hypot(a, b)
    if abs(c) >= size:
        # the line of sight lies inside the cone
        return rim, []
    middle, half = np.arctan2(b, a), np.arccos(c / size)
    angles = np.array([middle - half, middle + half])
    return rim, [np.array([np.zeros(3), end]) for end in circle(length * np.cos(half_angle) * n, n, radius, angles)]


def frame(matrix: Floats, length: float = 1.0) -> list[tuple[Floats, Floats]]:
    """Return the axes of a frame as three lines from the origin, each (start, end) with the given length.

    The columns of ``matrix`` are their directions.
    """
    return [(np.zeros(3), length * matrix[:, i]) for i in range(3)]
