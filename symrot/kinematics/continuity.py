"""Quaternions and Euler angles without jumps along a trajectory. NumPy alone.

The samples follow each other along the first dimension. An attitude has several equivalent values: q and -q, angles
plus multiples of 2 pi, two sets of Euler angles, at gimbal lock many. The functions choose the value closest to the
sample before.
"""

from typing import Any

import numpy as np

from symrot.kinematics.arrays import Array, array_of
from symrot.kinematics.conversions import sequence_axes

__all__ = ["continuous_quaternion", "unwrap_euler"]


def continuous_quaternion(q: Any) -> Array:
    """Return the quaternions ``q``, shape (n, ..., 4), with signs chosen so that no dot product of
    neighbours is negative.
    """
    q = array_of(q, 4, what="a quaternion")
    turns_over = np.einsum("...i,...i->...", q[1:], q[:-1]) < 0
    # q and -q are the same attitude; the first sample is unchanged
    sign = np.ones(q.shape[:-1])
    sign[1:] = np.where(np.cumsum(turns_over, axis=0) % 2, -1.0, 1.0)
    continuous: Array = q * sign[..., None]
    return continuous


def unwrap_euler(angles: Any, sequence: str, locked: Any = None) -> Array:
    """Return Euler angles of the same attitudes without jumps, shape (n, ..., 3), rad; the first sample is unchanged.

    Parameters
    ----------
    angles : array, shape (n, ..., 3)
        Angles in rad, in order of application, sampled so closely that no angle changes by pi/2 between samples.
    sequence : str
        The Euler sequence of the angles, such as ``"ZXZ"``.
    locked : bool array, shape (n, ...), optional
        Whether each sample is in gimbal lock, as returned together with the angles. Such a sample gets the third angle
        of the last sample before it that is not locked (or else of the first sample), and the first angle that gives
        the same attitude.

    Notes
    -----
    Each attitude has two sets of angles, apart from multiples of 2 pi: a proper sequence also has ``(q1 + pi, -q2, q3 +
    pi)``, a Tait-Bryan sequence ``(q1 + pi, pi - q2, q3 + pi)``. Call the set in ``angles`` the given
    set, and the other one the second set. At each sample, the function chooses the set that is closer to the set chosen
    at the sample before. One comparison for each pair of neighbouring samples suffices: the given set of the earlier
    sample is compared with both sets of the later sample. If the given set of the later sample is closer, the function
    chooses the same kind of set, given or second, at both samples. Otherwise it chooses different kinds.
    """
    (first, _, last), _, _, _ = sequence_axes(sequence)
    angles = np.array(array_of(angles, 3, what=f"a set of {sequence} angles"))
    if len(angles) == 0:
        return np.empty(angles.shape)
    other = angles + np.pi
    other[..., 1] = (0.0 if first == last else np.pi) - angles[..., 1]
    if locked is not None:
        _take_over(angles, np.asarray(locked, dtype=np.bool_), sequence)
        other[..., ::2] = angles[..., ::2] + np.pi
    changes = _step(angles[:-1], other[1:]) < _step(angles[:-1], angles[1:])
    chosen = np.zeros(angles.shape[:-1], dtype=np.bool_)
    chosen[1:] = np.cumsum(changes, axis=0) % 2 == 1
    unwrapped: Array = np.unwrap(np.where(chosen[..., None], other, angles), axis=0)
    return unwrapped


def _step(before: Array, after: Array) -> Array:
    """Return the squared distance between two sets of Euler angles, in revolutions, each difference modulo one
    revolution.
    """
    turns = (after - before) / (2 * np.pi)
    step: Array = np.sum((turns - np.rint(turns)) ** 2, axis=-1)
    return step


def _take_over(angles: Array, locked: Any, sequence: str) -> None:
    """Give each locked sample, in place, the third angle of the last unlocked sample, and adjust its first angle.

    Locked samples before any unlocked one get the third angle of the first sample.
    """
    if not locked.any():
        return
    (first, _, last), _, _, sign = sequence_axes(sequence)
    # At lock, first and last rotation are about the same line: the attitude depends on q1 + q3 if the middle rotation
    # maps the last axis to the first, on q1 - q3 if to minus it. The adjustment preserves this.
    here = np.arange(len(angles)).reshape(-1, *[1] * (locked.ndim - 1))
    source = np.maximum.accumulate(np.where(locked, 0, here), axis=0)
    third = np.take_along_axis(angles[..., 2], source, axis=0)
    middle = angles[..., 1]
    # component along e_first of the last axis after the middle rotation: cos q2 (proper), sign sin q2 (Tait-Bryan)
    sense = np.where(np.cos(middle) > 0, 1.0, -1.0) if first == last else np.where(middle > 0, sign, -sign)
    move = np.where(locked, third - angles[..., 2], 0.0)
    angles[..., 2] += move
    angles[..., 0] -= sense * move
