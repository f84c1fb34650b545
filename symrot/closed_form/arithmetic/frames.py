"""Rotation matrices and quaternions that change the axes of a body or of space, as fractions with 90 correct digits."""

from collections.abc import Sequence
from fractions import Fraction

from symrot.formula.exact_numbers import unit

__all__ = ["Rows", "quaternion_of", "to_axis"]

Rows = Sequence[Sequence[Fraction]]


def quaternion_of(r: Rows) -> tuple[Fraction, ...]:
    """Return the unit quaternion, scalar first, to 90 digits, of a proper rotation matrix ``r``, given by its rows."""
    # Shepperd's method divides by the largest component of the quaternion, so that no digits are lost
    trace = r[0][0] + r[1][1] + r[2][2]
    candidates = (
        (1 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]),
        (r[2][1] - r[1][2], 1 + 2 * r[0][0] - trace, r[0][1] + r[1][0], r[2][0] + r[0][2]),
        (r[0][2] - r[2][0], r[0][1] + r[1][0], 1 + 2 * r[1][1] - trace, r[1][2] + r[2][1]),
        (r[1][0] - r[0][1], r[2][0] + r[0][2], r[1][2] + r[2][1], 1 + 2 * r[2][2] - trace),
    )
    return unit(max(candidates, key=lambda row: sum(x * x for x in row)))


def to_axis(direction: Sequence[Fraction]) -> tuple[tuple[Fraction, ...], ...]:
    """Return a rotation matrix, to 90 digits, whose third column is the unit vector along ``direction``."""
    third = unit(direction)
    if third[0] == third[1] == 0:  # only 0, 1 and -1
        sign = 1 if third[2] > 0 else -1
        return tuple(tuple(Fraction(x) for x in row) for row in ((1, 0, 0), (0, sign, 0), (0, 0, sign)))
    helper = min(range(3), key=lambda k: abs(third[k]))
    raw = [Fraction(int(k == helper)) - third[helper] * third[k] for k in range(3)]
    first = unit(raw)
    second = tuple(third[(k + 1) % 3] * first[(k + 2) % 3] - third[(k + 2) % 3] * first[(k + 1) % 3] for k in range(3))
    return tuple(tuple(column[row] for column in (first, second, third)) for row in range(3))
