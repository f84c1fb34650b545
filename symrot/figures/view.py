"""Views: orthographic projections from space, or from a plane, to the points of a picture."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Floats", "Plane", "Points", "View"]

Floats = NDArray[np.float64]
Points = ArrayLike | Sequence[Any]
"""Rows of coordinates."""


@dataclass(frozen=True)
class View:
    """Orthographic view of space: axis 3 of space is drawn upward.

    Attributes
    ----------
    azimuth, elevation : float, degrees
        Direction from the origin toward the eye: its angle in the level plane from axis 1, and its angle above it.
    scale : float
        Points of the picture for each unit of length.
    origin : (float, float)
        Place of the origin in the picture; y is counted downward.
    """

    azimuth: float = 30.0
    elevation: float = 20.0
    scale: float = 100.0
    origin: tuple[float, float] = (0.0, 0.0)

    @cached_property
    def axes(self) -> Floats:
        """The directions right, up, and toward the eye, as rows of an orthogonal matrix."""
        a, e = np.radians(self.azimuth), np.radians(self.elevation)
        toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.array([right, np.cross(toward, right), toward])

    @property
    def toward(self) -> Floats:
        """The unit vector toward the eye."""
        eye: Floats = self.axes[2]
        return eye

    def project(self, points: Points) -> Floats:
        """Return the places of points of shape (n, 3) in the picture, shape (n, 2)."""
        right, up, _ = self.axes @ np.atleast_2d(np.asarray(points, dtype=float)).T
        return np.stack([self.origin[0] + self.scale * right, self.origin[1] - self.scale * up], axis=1)

    def at(self, x: float, y: float) -> "View":
        """Return the same view with its origin at another place of the picture."""
        return replace(self, origin=(x, y))


@dataclass(frozen=True)
class Plane:
    """View of a plane: x to the right, y upward, each with a scale of its own."""

    scale: float = 100.0
    origin: tuple[float, float] = (0.0, 0.0)
    scale_y: float | None = None

    def project(self, points: Points) -> Floats:
        """Return the places of points of shape (n, 2) in the picture, shape (n, 2)."""
        x, y = np.atleast_2d(np.asarray(points, dtype=float)).T
        scale_y = self.scale if self.scale_y is None else self.scale_y
        return np.stack([self.origin[0] + self.scale * x, self.origin[1] - scale_y * y], axis=1)
