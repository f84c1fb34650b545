"""Views: orthographic projections of points in space, or in a plane, to positions in a picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Floats", "Plane", "Points", "View"]

Floats = NDArray[np.float64]
Points = ArrayLike | Sequence[Any]
"""Coordinates of points, a row for each point."""


@dataclass(frozen=True)
class View:
    """An orthographic view of space in which axis 3 points upward.

    Attributes
    ----------
    azimuth, elevation : float, degrees
        Direction from the origin toward the eye. ``azimuth`` is measured from axis 1 toward axis 2 in the horizontal
        plane, ``elevation`` from this plane upward.
    scale : float
        SVG units for each unit of length.
    origin : (float, float)
        Place of the origin in the picture; y is counted downward.
    """

    azimuth: float = 30.0
    elevation: float = 20.0
    scale: float = 100.0
    origin: tuple[float, float] = (0.0, 0.0)

    @cached_property
    def axes(self) -> Floats:
        """The directions right, up, and toward the viewer, as rows of an orthogonal matrix."""
        a, e = np.radians(self.azimuth), np.radians(self.elevation)
        toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.array([right, np.cross(toward, right), toward])

    @property
    def toward(self) -> Floats:
        """The unit vector from the origin toward the viewer."""
        eye: Floats = self.axes[2]
        return eye

    def project(self, points: Points) -> Floats:
        """Return the positions in the picture, shape (n, 2), of points in space, shape (n, 3)."""
        right, up, _ = self.axes @ np.atleast_2d(np.asarray(points, dtype=float)).T
        return np.stack([self.origin[0] + self.scale * right, self.origin[1] - self.scale * up], axis=1)


@dataclass(frozen=True)
class Plane:
    """A view of a plane in a picture: x to the right and y upward; ``scale_y``, if given, is another scale for y."""

    scale: float = 100.0
    origin: tuple[float, float] = (0.0, 0.0)
    scale_y: float | None = None

    def project(self, points: Points) -> Floats:
        """Return the positions in the picture, shape (n, 2), of points of the plane, shape (n, 2)."""
        x, y = np.atleast_2d(np.asarray(points, dtype=float)).T
        scale_y = self.scale if self.scale_y is None else self.scale_y
        return np.stack([self.origin[0] + self.scale * x, self.origin[1] - scale_y * y], axis=1)
