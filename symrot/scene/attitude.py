"""Attitudes in scenes, read exactly: quaternion, Euler angles, axis and angle, or direction cosine matrix.

All numbers are Fractions, so that a right angle rotates a part of a body by exactly a right angle. The norm of the
quaternion of an initial attitude differs from 1 by at most 2^-200. Conventions: :mod:`symrot.conventions`.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.conventions import parse_sequence
from symrot.errors import InputError
from symrot.formula.exact_numbers import Angle, equal, read_angle, show, sqrt
from symrot.inertia.tensor import apply, determinant, multiply, rotation_of, transpose
from symrot.kinematics.hamilton import hamilton
from symrot.scene.reader import Entry, Reader, fail, flag, items, number, read_table, table, vector

__all__ = ["ORTHOGONAL", "Attitude", "read_attitude", "read_sequence", "refuse_two", "to_body"]

ORTHOGONAL = Fraction(1, 10**9)
"""Largest allowed deviation of R R^T from the unit matrix, for a matrix R in a scene; an exact rotation replaces R."""

FORMS = '{quaternion = [..]}, {sequence = "ZXZ", angles = [..]}, {axis = [..], angle = ..} or {dcm = [[..], ..]}'

Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]
Vector = tuple[Fraction, Fraction, Fraction]
Matrix = tuple[Vector, Vector, Vector]


class Attitude(NamedTuple):
    """An attitude in a scene, as a unit quaternion (scalar first, body to space) and as the matrix ``dcm_sb``.

    The matrix is exact if the sines and cosines of the angles in the scene, and the length of an axis, are rational.
    A matrix given in a scene is replaced by the exact matrix of its quaternion.
    """

    quaternion: Quaternion
    dcm: Matrix


def to_body(dcm: Matrix, vector_s: Vector) -> Vector:
    """Return the body components of ``vector_s``, given in space components; ``dcm`` is the attitude ``dcm_sb``."""
    return apply(transpose(dcm), vector_s)


def _unit(q: Quaternion) -> Quaternion:
    length_squared = sum(map(Fraction.__mul__, q, q), Fraction(0))
    if equal(length_squared, Fraction(1)):
        return q
    length = sqrt(length_squared)
    w, x, y, z = (item / length for item in q)
    return w, x, y, z


def _about(axis: Vector, angle: Angle) -> Attitude:
    """Return the attitude after a rotation by ``angle`` about ``axis``, of any length (Rodrigues' formula)."""
    x, y, z = axis
    square = x * x + y * y + z * z
    length = sqrt(square)
    half, cosine = angle.scaled(Fraction(1, 2)), angle.cos
    along, sine, versine = half.sin / length, angle.sin / length, (1 - cosine) / square
    dcm = (
        (cosine + versine * x * x, versine * x * y - sine * z, versine * x * z + sine * y),
        (versine * x * y + sine * z, cosine + versine * y * y, versine * y * z - sine * x),
        (versine * x * z - sine * y, versine * y * z + sine * x, cosine + versine * z * z),
    )
    return Attitude(_unit((half.cos, along * x, along * y, along * z)), dcm)


def _axis(index: int) -> Vector:
    x, y, z = (Fraction(index == i) for i in range(3))
    return x, y, z


def _of_sequence(name: str, angles: tuple[Angle, ...]) -> Attitude:
    axes, intrinsic = parse_sequence(name)
    rotations = [_about(_axis(index), angle) for index, angle in zip(axes, angles, strict=True)]
    first, second, third = rotations if intrinsic else reversed(rotations)
    return Attitude(
        _unit(hamilton(hamilton(first.quaternion, second.quaternion), third.quaternion)),
        multiply(multiply(first.dcm, second.dcm), third.dcm),
    )


def _of_dcm(rows: Matrix, value: object, where: str) -> Attitude:
    """Return the attitude of a matrix ``dcm_sb`` in a scene; raise InputError if it is no rotation."""
    product = multiply(rows, transpose(rows))
    worst = max(abs(product[i][j] - (i == j)) for i in range(3) for j in range(3))
    if worst > ORTHOGONAL:
        fail(
            where,
            "a rotation: orthonormal rows, to 1e-9",
            value,
            f"its rows deviate from orthonormality by {float(worst):.2g}",
        )
    if determinant(rows) < 0:
        fail(where, "a rotation, of determinant +1", value, "this is a reflection, of determinant -1")
    # Shepperd's method, without loss of digits; the result has the exact matrix of this quaternion.
    (a, b, c), (d, e, f), (g, h, i) = rows
    candidates = {
        1 + a + e + i: (1 + a + e + i, h - f, c - g, d - b),
        1 + a - e - i: (h - f, 1 + a - e - i, b + d, c + g),
        1 - a + e - i: (c - g, b + d, 1 - a + e - i, f + h),
        1 - a - e + i: (d - b, c + g, f + h, 1 - a - e + i),
    }
    q = candidates[max(candidates)]
    return Attitude(_unit(q), rotation_of(q))


def _angle(degrees: bool) -> Reader:
    unit = "degrees" if degrees else "rad"

    def reader(value: Any, where: str) -> Angle:
        number(f"an angle in {unit}")(value, where)
        return read_angle(value, degrees, where)

    return reader


_four = items(4, number(), "four numbers (q0, q1, q2, q3), scalar first")
_rows = items(3, vector("1"), "three rows of three numbers")


def _read_quaternion(value: Any, where: str) -> Attitude:
    """Return the attitude of a quaternion ``value`` = [q0, q1, q2, q3] in a scene, of any norm except zero.

    Raise InputError for any other value; the message names the place ``where``.
    """
    q = _four(value, where)
    if not any(q):
        fail(where, "a quaternion that is not zero", value)
    return Attitude(_unit(q), rotation_of(q))


def refuse_two(attitude: Any, quaternion: Any) -> None:
    """Raise InputError if neither argument is None: a call may give an attitude or a quaternion, not both."""
    if attitude is not None and quaternion is not None:
        raise InputError(f"attitude: expected either attitude or quaternion, got both (attitude is {show(attitude)})")


def read_sequence(value: Any, where: str) -> str:
    """Return the value if it is the name of an Euler sequence, such as ``"ZXZ"``; raise InputError otherwise."""
    try:
        parse_sequence(value)
    except InputError:
        fail(where, "an Euler sequence: three axis letters, neighbours different, all upper case (intrinsic) or "
                 "all lower case (extrinsic), such as \"ZXZ\" or \"zyx\"", value)  # fmt: skip
    return str(value)


def _read_quaternion_form(value: Mapping[str, Any], where: str) -> Attitude:
    values = read_table(value, where, {"quaternion": Entry(_read_quaternion, required=True)}, "an attitude")
    attitude: Attitude = values["quaternion"]
    return attitude


def _degrees(value: Mapping[str, Any], where: str) -> bool:
    return flag(value.get("degrees", False), f"{where}.degrees")


def _read_sequence_form(value: Mapping[str, Any], where: str) -> Attitude:
    degrees = _degrees(value, where)
    expectation = f"three angles in {'degrees' if degrees else 'rad'}, in the order of the sequence"
    values = read_table(value, where, {
        "sequence": Entry(read_sequence, required=True),
        "angles": Entry(items(3, _angle(degrees), expectation), required=True),
        "degrees": Entry(flag),
    }, "an attitude by a sequence")  # fmt: skip
    return _of_sequence(values["sequence"], values["angles"])


def _read_axis_form(value: Mapping[str, Any], where: str) -> Attitude:
    values = read_table(value, where, {
        "axis": Entry(vector("1", "nonzero"), required=True),
        "angle": Entry(_angle(_degrees(value, where)), required=True),
        "degrees": Entry(flag),
    }, "an attitude by axis and angle")  # fmt: skip
    return _about(values["axis"], values["angle"])


def _read_dcm_form(value: Mapping[str, Any], where: str) -> Attitude:
    values = read_table(value, where, {"dcm": Entry(_rows, required=True)}, "an attitude")
    return _of_dcm(values["dcm"], value["dcm"], f"{where}.dcm")


_FORMS: dict[str, Callable[[Mapping[str, Any], str], Attitude]] = {
    "quaternion": _read_quaternion_form,
    "sequence": _read_sequence_form,
    "angles": _read_sequence_form,
    "axis": _read_axis_form,
    "angle": _read_axis_form,
    "dcm": _read_dcm_form,
}


def _by_shape(value: Any) -> Any:
    """Return an attitude that is a list as a table: ``[1, 0, 0, 0]`` gives ``{"quaternion": [1, 0, 0, 0]}``.

    The list is a quaternion, the three rows of a matrix, or a sequence with its angles. Other values stay unchanged.
    """
    match value:
        case [str(sequence), list() as angles]:
            return {"sequence": sequence, "angles": angles}
        case [list(), list(), list()]:
            return {"dcm": value}
        case [_, _, _, _]:
            return {"quaternion": value}
    return value


def read_attitude(value: Any, where: str) -> Attitude:
    """Return the attitude that a value in a scene describes: quaternion, Euler angles, axis and angle, or matrix.

    The value is a table, such as ``{axis = [0, 0, 1], angle = 0.5}``, or a list: ``[q0, q1, q2, q3]``, the rows of
    ``dcm_sb``, or ``["ZXZ", [.., .., ..]]`` with angles in rad. Raise InputError for anything else.
    """
    entries = table(_by_shape(value), where, f"an attitude: {FORMS}")
    form = next((reader for key, reader in _FORMS.items() if key in entries), None)
    if form is None:
        fail(where, f"an attitude: {FORMS}", value)
    return form(entries, where)
