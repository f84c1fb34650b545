"""A count of the polygons in a mesh file that are not flat, so that their division into triangles is ambiguous."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = ["bent_polygons"]

FLAT = 1e-6
"""A polygon counts as flat if no corner is farther from its plane than this, relative to the size of the mesh.

Smaller distances can be rounding errors of the coordinates."""


def bent_polygons(vertices: NDArray[np.float64], polygons: Sequence[Sequence[int]]) -> int:
    """Return the number of polygons that are not flat.

    Parameters
    ----------
    vertices : array, shape (n, 3)
        The vertices of the mesh.
    polygons : sequence of sequences of int
        For each polygon the indices of its corners.
    """
    size, count = float(np.ptp(vertices, axis=0).max(initial=0)), 0
    for number in {len(corners) for corners in polygons} - {3}:
        points = vertices[np.array([corners for corners in polygons if len(corners) == number])]
        offsets = points - points.mean(axis=1, keepdims=True)
        # the last right singular vector is the normal of the plane that is closest to the corners
        normals = np.linalg.svd(offsets, full_matrices=False)[2][:, 2]
        distances = np.abs(np.einsum("pki,pi->pk", offsets, normals)).max(axis=1)
        count += int((distances > FLAT * size).sum())
    return count
