"""Rotation matrices from the notations of robot files as Fractions, and angles and quaternions of matrices as doubles.

Each matrix maps components in a child frame to components in its parent frame. Entries that are not rational are
rounded far beyond the digits of a double.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import atan2, hypot
from typing import NamedTuple

from symrot.errors import InputError
from symrot.formula.exact_numbers import Angle, rounded, show, unit
from symrot.inertia.tensor import IDENTITY, Tensor, cross, dot, matrix, multiply, rotation_of, transpose

__all__ = ["ORIENTATIONS", "Angles", "of_quaternion", "of_roll_pitch_yaw", "quaternion_of", "roll_pitch_yaw_of"]

Numbers = Sequence[Fraction]

NEGLIGIBLE = 1e-60
"""Magnitude below which an entry of a rotation matrix counts as zero in angles and quaternions.

Such an entry is the rounding error of a zero; a robot file that contains it, as 1e-113, could not be read again."""


class Angles(NamedTuple):
    """The settings of a robot file for angles: degrees or rad, and the sequence of Euler angles.

    In the sequence, a lower-case letter is a moving axis and an upper-case letter a fixed axis, as in MJCF.
    """

    degrees: bool = False
    sequence: str = "xyz"

    def angle(self, value: Fraction) -> Angle:
        """Return the exact angle for a number in a robot file: in degrees if ``degrees`` is true, otherwise in rad.

        90 degrees is exactly pi/2.
        """
        return Angle(Fraction(0), value / 180) if self.degrees else Angle(value, Fraction(0))


def _elementary(axis: int, angle: Angle) -> Tensor:
    rows = [[Fraction(int(i == j)) for j in range(3)] for i in range(3)]
    after, last = (axis + 1) % 3, (axis + 2) % 3
    rows[after][after] = rows[last][last] = angle.cos
    rows[last][after] = angle.sin
    rows[after][last] = -rows[last][after]
    return matrix(rows)


def of_roll_pitch_yaw(values: Numbers, angles: Angles) -> Tensor:
    """Return the rotation matrix of the angles (roll, pitch, yaw): about the fixed axes x, y, z, in this order."""
    roll, pitch, yaw = map(angles.angle, values)
    return multiply(_elementary(2, yaw), multiply(_elementary(1, pitch), _elementary(0, roll)))


def of_quaternion(values: Numbers, angles: Angles) -> Tensor:
    """Return the exact rotation matrix of a quaternion, scalar first, of any norm except zero.

    ``angles`` is not used; it is there because all functions of the table :data:`ORIENTATIONS` are called alike.
    """
    if not any(values):
        raise InputError(f"expected a quaternion that is not zero, got {show(list(values))}")
    return rotation_of(values)


def _of_axis_angle(values: Numbers, angles: Angles) -> Tensor:
    half = angles.angle(values[3]).scaled(Fraction(1, 2))
    axis = _direction(values[:3], "an axis that is not zero")
    return of_quaternion([half.cos, *(rounded(half.sin * x) if half.sin * x else Fraction(0) for x in axis)], angles)


def _of_euler(values: Numbers, angles: Angles) -> Tensor:
    """Return the rotation matrix of three Euler angles; ``angles`` gives their sequence and unit."""
    total = matrix(IDENTITY)
    for letter, value in zip(angles.sequence, values, strict=True):
        step = _elementary("xyz".index(letter.lower()), angles.angle(value))
        # lower case: a moving axis; upper case: a fixed axis
        total = multiply(total, step) if letter.islower() else multiply(step, total)
    return total


def _of_two_axes(values: Numbers, angles: Angles) -> Tensor:
    """Return the rotation matrix of a frame given by two vectors: its x axis, and a vector in its xy plane.

    ``values`` are the six components of both vectors; ``(1, 0, 0, 1, 1, 0)`` gives the identity matrix.
    """
    x = _direction(values[:3], "an x axis that is not zero")
    slope = dot(values[3:], x)
    y = _direction(
        [b - slope * a for a, b in zip(x, values[3:], strict=True)], "a y axis that is not parallel to the x axis"
    )
    return transpose([x, y, cross(x, y)])


def _of_z_axis(values: Numbers, angles: Angles) -> Tensor:
    """Return the matrix of the smallest rotation that carries the z axis into the direction ``values``."""
    x, y, z = _direction(values, "a z axis that is not zero")
    if x == y == 0:
        return of_quaternion(
            [Fraction(1), *[Fraction(0)] * 3] if z > 0 else [Fraction(n) for n in (0, 1, 0, 0)], angles
        )
    return of_quaternion([1 + z, -y, x, Fraction(0)], angles)


def _direction(values: Numbers, what: str) -> tuple[Fraction, ...]:
    if not any(values):
        raise InputError(f"expected {what}, got {show(list(values))}")
    return unit(values)


ORIENTATIONS: dict[str, tuple[int, Callable[[Numbers, Angles], Tensor]]] = {
    "quat": (4, of_quaternion),
    "axisangle": (4, _of_axis_angle),
    "euler": (3, _of_euler),
    "xyaxes": (6, _of_two_axes),
    "zaxis": (3, _of_z_axis),
}
"""Attribute of MJCF -> (how many numbers it has, function from these numbers and the file's settings to a matrix)."""


def _doubles(rotation: Tensor) -> list[list[float]]:
    """Return the entries of a rotation matrix as doubles, with 0 for entries of a magnitude below NEGLIGIBLE."""
    return [[float(entry) if abs(entry) > NEGLIGIBLE else 0.0 for entry in row] for row in rotation]


def roll_pitch_yaw_of(rotation: Tensor) -> tuple[float, float, float]:
    """Return roll, pitch and yaw, rad, of a rotation matrix; at gimbal lock (pitch 90 or -90 degrees) roll is 0."""
    m = _doubles(rotation)
    across = hypot(m[0][0], m[1][0])
    if across < 1e-12:  # gimbal lock: only the sum or difference of roll and yaw matters
        return 0.0, atan2(-m[2][0], across), atan2(-m[0][1], m[1][1])
    return atan2(m[2][1], m[2][2]), atan2(-m[2][0], across), atan2(m[1][0], m[0][0])


def quaternion_of(rotation: Tensor) -> tuple[float, float, float, float]:
    """Return the unit quaternion of a rotation matrix, scalar first, with a scalar that is not negative."""
    m = _doubles(rotation)
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + trace, *(1 + 2 * m[k][k] - trace for k in range(3))]  # 4 q_k^2
    differences = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]]  # 4 q_0 q_k
    largest = max(range(4), key=squares.__getitem__)
    products = [squares[0], *differences]
    if largest:
        i = largest - 1
        products = [differences[i], *(m[i][k] + m[k][i] for k in range(3))]
        products[largest] = squares[largest]
    norm = hypot(*products) * (1 if products[0] >= 0 else -1)
    w, x, y, z = (value / norm for value in products)
    return w, x, y, z
