"""Quaternions of rotations to 50 digits, independent of symrot; set mpmath to 50 digits to use these functions."""

import numpy as np
from mpmath import mp, mpf

from tests.reference.free_body import multiply

DIGITS = 50
LOCKED = {True: (0.0, np.pi), False: (-np.pi / 2, np.pi / 2)}  # middle angles at lock, of proper sequences or not


def is_proper(sequence):
    """Return whether the third axis of a sequence is the first one again."""
    return sequence[0] == sequence[2]


def exact_euler(angles, sequence):
    """Return the unit quaternion of Euler angles to 50 digits."""
    turns = []
    for axis, angle in zip(sequence.upper(), angles, strict=True):
        turn = [mp.cos(mpf(angle) / 2), mpf(0), mpf(0), mpf(0)]
        turn["XYZ".index(axis) + 1] = mp.sin(mpf(angle) / 2)
        turns.append(turn)
    first, second, third = turns if sequence.isupper() else turns[::-1]
    return multiply(multiply(first, second), third)


def exact_exponential(v):
    """Return the unit quaternion of a nonzero rotation vector to 50 digits."""
    size = mp.sqrt(sum(mpf(x) ** 2 for x in v))
    return [mp.cos(size / 2), *(mp.sin(size / 2) / size * mpf(x) for x in v)]


def difference(p, q):
    """Return the largest component of p - q or of p + q, whichever is smaller: a distance that ignores the sign."""
    return min(
        max(abs(mpf(float(a) if isinstance(a, np.floating) else a) - s * mpf(b)) for a, b in zip(p, q, strict=True))
        for s in (1, -1)
    )


def exact_unit(q):
    """Return a quaternion divided by its norm, to 50 digits: in doubles, its norm is 1 only to 2e-16."""
    norm = mp.sqrt(sum(mpf(float(x)) ** 2 for x in q))
    return [mpf(float(x)) / norm for x in q]


def doubles(values):
    """Return numbers of 50 digits as an array of doubles."""
    return np.array([float(value) for value in values])


def apart(p, q):
    """Return the largest component of p - q or of p + q, whichever is smaller, along the last axis, in doubles."""
    return np.minimum(np.abs(p - q).max(axis=-1), np.abs(p + q).max(axis=-1))
