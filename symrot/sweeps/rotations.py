"""Uniformly distributed rotations from three uniform numbers, so that every sampling of a sweep can draw attitudes."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["ROTATION_STREAMS", "uniform_rotations"]

Floats = NDArray[np.float64]

ROTATION_STREAMS = ("attitude 1", "attitude 2", "attitude 3")
"""Names of the three coordinates of the unit cube from which a rotation is computed."""


def uniform_rotations(u: Floats) -> Floats:
    """Return unit quaternions, scalar first, shape (n, 4), for points of the unit cube, shape (n, 3).

    Uniform points give uniform rotations (Haar measure).

    Notes
    -----
    Source: K. Shoemake, Uniform random rotations, Graphics Gems III, 1992, p. 124.

    Examples
    --------
    >>> uniform_rotations(np.array([[0.5, 0.25, 0.0]])).round(3).tolist()
    [[0.0, 0.707, 0.707, 0.0]]
    """
    # the squares of (q0, q1) and (q2, q3) sum up to u_1 and 1 - u_1; both pairs have uniform directions
    first, second = np.sqrt(u[:, 0]), np.sqrt(1 - u[:, 0])
    angles = 2 * np.pi * u[:, 1:]
    pairs = first * np.cos(angles[:, 0]), first * np.sin(angles[:, 0]), second * np.cos(angles[:, 1])
    return np.stack([*pairs, second * np.sin(angles[:, 1])], axis=1)
