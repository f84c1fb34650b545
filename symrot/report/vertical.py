"""Angles between a body and the vertical: for a top under gravity, or for a satellite, whose local vertical rotates."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["VerticalAngles", "has_vertical", "local_vertical", "vertical_angles"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class VerticalAngles:
    """Angles of a line of the body, such as its symmetry axis, to the vertical, over time.

    Attributes
    ----------
    title : str
        The line and the vertical, in words.
    names : tuple of str
        Names of the angles.
    columns : array, shape (n, len(names))
        The angles, rad.
    """

    title: str
    names: tuple[str, ...]
    columns: Floats


def has_vertical(scene: Any) -> bool:
    """Return whether a scene has one vertical: the upward direction of gravity, or the radius of a circular orbit."""
    return sum(torque.kind in ("gravity", "gravity_gradient") for torque in scene.torques) == 1


def local_vertical(t: Floats, mean_motion: float) -> Floats:
    """Return the upward vertical of a satellite: the unit vector along the orbit's radius, space components, (n, 3).

    The orbit is the circular orbit of a gravity gradient torque, with the given mean motion, rad/s.
    """
    phase = mean_motion * t
    return np.stack([np.cos(phase), np.sin(phase), np.zeros_like(phase)], axis=-1)


def vertical_angles(trajectory: Any) -> VerticalAngles:
    """Return the angles, rad, between a line of the body and the vertical, at the times of a motion.

    The line is that from the fixed point to the centre of mass, or a satellite's long axis.
    """
    torque = next(item for item in trajectory.scene.torques if item.kind in ("gravity", "gravity_gradient"))
    if torque.kind == "gravity":
        line = trajectory.dcm @ _unit([float(value) for value in torque.vector("center_of_mass")])
        up = -_unit([float(value) for value in torque.vector("direction")])
        angle = _angle(line, np.broadcast_to(up, line.shape))
        return VerticalAngles("Centre of mass from the upward vertical", ("angle",), angle[:, None])
    principal = trajectory.scene.body.principal
    least = int(np.argmin([float(moment) for moment in principal.moments]))
    line = trajectory.dcm @ _unit([float(row[least]) for row in principal.axes])
    radius = local_vertical(trajectory.t, float(torque.number("mean_motion")))
    # the long axis (of least inertia), in its direction closer to the vertical at the start
    line = line * (1.0 if line[0] @ radius[0] >= 0 else -1.0)
    along = np.cross([0.0, 0.0, 1.0], radius)
    ahead, up = np.sum(line * along, axis=1), np.sum(line * radius, axis=1)
    in_plane = np.arctan2(ahead, up)
    out_of_plane = np.arctan2(line[:, 2], np.hypot(ahead, up))
    columns = np.stack([in_plane, out_of_plane, _angle(line, radius)], axis=1)
    names = ("in the orbit plane", "out of it", "in all")
    return VerticalAngles("Long axis from the local vertical", names, columns)


def _unit(vector: list[float]) -> Floats:
    array: Floats = np.array(vector) / np.linalg.norm(vector)
    return array


def _angle(first: Floats, second: Floats) -> Floats:
    """Return the angles between the unit vectors ``first[i]`` and ``second[i]``, rad, accurate for small angles too."""
    angles: Floats = np.arctan2(np.linalg.norm(np.cross(first, second), axis=1), np.sum(first * second, axis=1))
    return angles
