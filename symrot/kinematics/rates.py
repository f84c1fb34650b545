"""Rates of quaternions and Euler angles from the angular velocity, and the angular velocity from them; NumPy alone.

Arrays may have any leading shape; rows without a valid attitude are treated as in :mod:`symrot.kinematics.conversions`.
The tests compare the results with the formulas that :mod:`symrot.kinematics.euler` and
:mod:`symrot.kinematics.quaternion` derive.
"""

from typing import Any

import numpy as np

from symrot.conventions import check_frame
from symrot.kinematics.arrays import Array, Mask, array_of
from symrot.kinematics.conversions import multiply, sequence_axes

__all__ = ["angular_velocity", "euler_angular_velocity", "euler_rates", "quaternion_rate"]


def quaternion_rate(q: Any, omega: Any, frame: str = "body") -> Array:
    """Return ``dq/dt``, shape (..., 4), 1/s: ``1/2 q (0, omega_b)`` in the frame ``"body"``, ``1/2 (0, omega_s) q`` in
    ``"space"``.
    """
    q, omega = array_of(q, 4, what="a quaternion"), array_of(omega, 3, what="an angular velocity")
    pure = np.concatenate([np.zeros_like(omega[..., :1]), omega], axis=-1)
    return (multiply(q, pure) if check_frame(frame) == "body" else multiply(pure, q)) / 2


def angular_velocity(q: Any, dq: Any, frame: str = "body") -> Array:
    """Return omega, shape (..., 3), rad/s: ``2 q* dq`` in the frame ``"body"``, ``2 dq q*`` in ``"space"``,
    for unit q.
    """
    q, dq = array_of(q, 4, what="a quaternion"), array_of(dq, 4, what="the rate of a quaternion")
    inverse = q * np.array([1.0, -1.0, -1.0, -1.0])
    return 2 * (multiply(inverse, dq) if check_frame(frame) == "body" else multiply(dq, inverse))[..., 1:]


def _turn(vector: Array, axis: int, angle: Array) -> Array:
    """Return ``vector`` rotated, right-handed, by ``angle`` (rad) about a coordinate axis, of number 0, 1 or 2."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    shape = np.broadcast_shapes(vector.shape[:-1], angle.shape)
    turned: Array = np.broadcast_to(vector, (*shape, 3)).copy()
    cosine, sine = np.cos(angle), np.sin(angle)
    turned[..., j] = cosine * vector[..., j] - sine * vector[..., k]
    turned[..., k] = sine * vector[..., j] + cosine * vector[..., k]
    return turned


@np.errstate(all="ignore")
def euler_rates(angles: Any, omega: Any, sequence: str, frame: str = "body") -> tuple[Array, Mask]:
    """Return the rates of Euler angles, shape (..., 3), rad/s, and a mask of gimbal lock, shape (...).

    Parameters
    ----------
    angles : array, shape (..., 3)
        Angles in rad, in order of application.
    omega : array, shape (..., 3)
        Angular velocity in rad/s, components in ``frame``.
    sequence : str
        The Euler sequence of the angles, such as ``"ZXZ"``.
    frame : str
        ``"body"`` or ``"space"``.

    Notes
    -----
    In the frame between the middle and the last rotation, the middle axis m and the last axis e are fixed, and the
    first axis is ``-sin(q2) w + cos(q2) e`` (proper) or ``s (cos(q2) w + sin(q2) e)`` (Tait-Bryan), with w = m x e and
    s = 1 if the three axes are in cyclic order, such as XYZ, otherwise -1.
    Exactly at gimbal lock the first axis has no component along w; the rates are not finite and the mask is True. The
    doubles nearest to pi/2 and pi are not exactly there: the mask is False, and the rates are about 1e16 times omega.
    """
    (first, middle, last), order, cross, sign = sequence_axes(sequence)
    angles = array_of(angles, 3, what=f"a set of {sequence} angles")
    omega = array_of(omega, 3, what="an angular velocity")
    left, tilt, right = (angles[..., place] for place in order)
    is_body = check_frame(frame) == "body"
    seen = _turn(omega, last, right) if is_body else _turn(_turn(omega, first, -left), middle, -tilt)
    cosine, sine = np.cos(tilt), np.sin(tilt)
    if first == last:  # w = m x e = -(e_first x e_middle)
        across, along, w = -sine, cosine, -sign * seen[..., cross]
    else:  # w = m x e = sign e_first
        across, along, w = sign * cosine, sign * sine, sign * seen[..., first]
    rate = w / across
    rates = np.empty(seen.shape)
    rates[..., order[0]] = rate
    rates[..., order[1]] = seen[..., middle]
    rates[..., order[2]] = seen[..., last] - along * rate
    return rates, np.broadcast_to(across == 0, rates.shape[:-1])


def euler_angular_velocity(angles: Any, rates: Any, sequence: str, frame: str = "body") -> Array:
    """Return omega, shape (..., 3), rad/s, in components of ``frame``, from Euler angles, rad, and their
    rates, rad/s.
    """
    (first, middle, last), order, _, _ = sequence_axes(sequence)
    angles = array_of(angles, 3, what=f"a set of {sequence} angles")
    rates = array_of(rates, 3, what="a set of angle rates")
    left, tilt, right = (angles[..., place] for place in order)
    axes = np.eye(3)[[first, middle, last]]
    columns: list[Array] = [rates[..., place, None] * axis for place, axis in zip(order, axes, strict=True)]
    if check_frame(frame) == "body":
        omega: Array = _turn(_turn(columns[0], middle, -tilt) + columns[1], last, -right) + columns[2]
    else:
        omega = _turn(_turn(columns[2], middle, tilt) + columns[1], first, left) + columns[0]
    return omega
