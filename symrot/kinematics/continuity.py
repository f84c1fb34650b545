"""Continuous quaternions and Euler angles along a trajectory: one sample after another along the first dimension.

NumPy alone. The conversions of :mod:`symrot.kinematics.conversions` return each attitude in principal ranges; here
the choices that leave the attitude as it is (sign, whole turns, the second set of Euler angles, the split of first
and third angle at lock) are made so that neighbours are close.
"""

from typing import Any

import numpy as np

from symrot.kinematics.conversions import Array, array_of, places

__all__ = ["continuous_quaternion", "unwrap_euler"]


def continuous_quaternion(q: Any) -> Array:
    """Return quaternions, shape (n, ..., 4), with signs such that neighbours have positive dot products."""
    q = array_of(q, 4, what="a quaternion")
    turns_over = np.einsum("...i,...i->...", q[1:], q[:-1]) < 0
    sign = np.ones(q.shape[:-1])
    sign[1:] = np.where(np.cumsum(turns_over, axis=0) % 2, -1.0, 1.0)
    continuous: Array = q * sign[..., None]
    return continuous


def unwrap_euler(angles: Any, sequence: str, locked: Any = None) -> Array:
    """Return Euler angles without jumps of 2 pi, shape (n, ..., 3), rad; attitudes and first sample are unchanged.

    Parameters
    ----------
    angles : array, shape (n, ..., 3)
        rad, in order of application, sampled closely enough that no angle moves by a quarter turn between samples.
    sequence : str
    locked : bool array, shape (n, ...), optional
        As returned with the angles: there the third angle is taken over from the last sample that was not locked
        and the first one changed to match.

    Notes
    -----
    Each attitude has two sets of angles within the whole turns: a proper sequence also ``(q1 + pi, -q2, q3 + pi)``, a
    Tait-Bryan sequence ``(q1 + pi, pi - q2, q3 + pi)``. Whether neighbours are closer in the same or in the other set
    does not depend on which set the earlier one is in, so the choices add up along the trajectory.
    """
    (first, _, last), _, _, _ = places(sequence)
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
    """Return the sum of squares of the differences modulo 2 pi."""
    turns = (after - before) / (2 * np.pi)
    step: Array = np.sum((turns - np.rint(turns)) ** 2, axis=-1)
    return step


def _take_over(angles: Array, locked: Any, sequence: str) -> None:
    """At locked samples take the third angle of the last free sample, in place, and move the first one to match.

    At lock the first and last turn are about one line: in the same sense where the middle turn takes the last axis to
    the first (their sum counts), in the opposite sense where it takes it to minus the first (their difference counts).
    """
    if not locked.any():
        return
    (first, _, last), _, _, sign = places(sequence)
    here = np.arange(len(angles)).reshape(-1, *[1] * (locked.ndim - 1))
    source = np.maximum.accumulate(np.where(locked, 0, here), axis=0)
    third = np.take_along_axis(angles[..., 2], source, axis=0)
    middle = angles[..., 1]
    # e_last carried by the middle turn, along e_first: cos q2 (proper), sign sin q2 (Tait-Bryan)
    sense = np.where(np.cos(middle) > 0, 1.0, -1.0) if first == last else np.where(middle > 0, sign, -sign)
    move = np.where(locked, third - angles[..., 2], 0.0)
    angles[..., 2] += move
    angles[..., 0] -= sense * move
