"""The Hamilton product and the conjugate of quaternions over any kind of number, without SymPy and without NumPy.

For symbols use :func:`symrot.quaternion_product`, for arrays of many quaternions
:func:`symrot.kinematics.conversions.multiply`.
"""

from collections.abc import Sequence
from typing import Any

__all__ = ["conjugate", "hamilton"]


def hamilton(left: Sequence[Any], right: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
    """Return the Hamilton product of two quaternions, scalar first, with components of any number type (or arrays).

    Examples
    --------
    >>> hamilton((0, 1, 0, 0), (0, 0, 1, 0))  # i j = k
    (0, 0, 0, 1)
    """
    a0, a1, a2, a3 = left
    b0, b1, b2, b3 = right
    # a fixed order of operations, because the last bits of sums of floats depend on it
    return (
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1,
        a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0,
    )


def conjugate(quaternion: Sequence[Any]) -> tuple[Any, Any, Any, Any]:
    """Return the conjugate of a quaternion; for a unit quaternion, that is the inverse rotation.

    Examples
    --------
    >>> conjugate((1, 2, 3, 4))
    (1, -2, -3, -4)
    """
    q0, q1, q2, q3 = quaternion
    return q0, -q1, -q2, -q3
