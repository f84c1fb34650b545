"""Quaternions of rotations to 50 digits, written out independently of symrot; to be used at 50 digits of mpmath."""

import numpy as np
from mpmath import mp, mpf

from tests.reference.free_body import multiply

DIGITS = 50
LOCKED = {True: (0.0, np.pi), False: (-np.pi / 2, np.pi / 2)}  # middle angles at lock, of proper sequences or not


def is_proper(sequence):
    """Whether the first axis comes back as the third."""
    return sequence[0] == sequence[2]


def exact_euler(angles, sequence):
    """Unit quaternion of Euler angles to 50 digits."""
    turns = []
    for axis, angle in zip(sequence.upper(), angles, strict=True):
        turn = [mp.cos(mpf(angle) / 2), mpf(0), mpf(0), mpf(0)]
        turn["XYZ".index(axis) + 1] = mp.sin(mpf(angle) / 2)
        turns.append(turn)
    first, second, third = turns if sequence.isupper() else turns[::-1]
    return multiply(multiply(first, second), third)


def exact_exponential(v):
    """Unit quaternion of a rotation vector that is not zero, to 50 digits."""
    size = mp.sqrt(sum(mpf(x) ** 2 for x in v))
    return [mp.cos(size / 2), *(mp.sin(size / 2) / size * mpf(x) for x in v)]


def difference(p, q):
    """Largest component of p - q or p + q, whichever is smaller: the sign-free distance of quaternions."""
    return min(
        max(abs(mpf(float(a) if isinstance(a, np.floating) else a) - s * mpf(b)) for a, b in zip(p, q, strict=True))
        for s in (1, -1)
    )


def exact_unit(q):
    """A quaternion divided by its norm to 50 digits: one in double precision is unit to 2e-16 only."""
    norm = mp.sqrt(sum(mpf(float(x)) ** 2 for x in q))
    return [mpf(float(x)) / norm for x in q]


def doubles(values):
    """Numbers of 50 digits as an array of doubles."""
    return np.array([float(value) for value in values])


def apart(p, q):
    """Largest component of p - q or p + q, whichever is smaller, along the last axis, in doubles."""
    return np.minimum(np.abs(p - q).max(axis=-1), np.abs(p + q).max(axis=-1))
