"""Numeric conversions between attitude descriptions, for arrays of any leading shape. NumPy alone.

Conventions: :mod:`symrot.conventions`; angles in rad unless ``degrees=True``. Errors are a few units of 1e-16 for every
attitude, also at gimbal lock. From a zero, infinite or NaN quaternion, a conversion to another description gives NaN in
its own row, without a warning. Wrong shapes and types raise ``InputError``.
"""

from typing import Any

import numpy as np

from symrot.conventions import parse_sequence
from symrot.kinematics.arrays import Array, Components, Mask, array_of, by_components, in_range, largest, length

__all__ = [
    "LOCK",
    "axis_angle_to_quaternion",
    "canonical",
    "dcm_to_euler",
    "dcm_to_quaternion",
    "euler_to_dcm",
    "euler_to_quaternion",
    "from_scipy_order",
    "mrp_shadow",
    "mrp_switch",
    "mrp_to_quaternion",
    "multiply",
    "normalize",
    "quaternion_to_axis",
    "quaternion_to_axis_angle",
    "quaternion_to_dcm",
    "quaternion_to_euler",
    "quaternion_to_mrp",
    "quaternion_to_rodrigues",
    "quaternion_to_rotation_vector",
    "rodrigues_to_quaternion",
    "rotation_vector_to_quaternion",
    "to_scipy_order",
]

LOCK = 2.0**-51  # rad from lock: below it a quaternion in double precision cannot tell the two angles apart
PI_LOW = 1.2246467991473532e-16  # pi - np.pi


def _canonical(*q: Array) -> Components:
    sign: Array = np.sign(q[0])
    for component in q[1:]:
        undecided = sign == 0
        if not undecided.any():
            break
        sign[undecided] = np.sign(component[undecided])
    np.copyto(sign, 1.0, where=sign == 0)
    return [sign * component for component in q]


def _normalize(*q: Array) -> Components:
    rows, squares = in_range(*q)
    norm = np.sqrt(squares)
    return [row / norm for row in rows]


def normalize(q: Any) -> Array:
    """Return quaternions divided by their norms, shape (..., 4); NaN for norm 0 or components that are not finite."""
    return by_components(_normalize, array_of(q, 4, what="a quaternion"), 4)


def canonical(q: Any) -> Array:
    """Return q or -q, shape (..., 4), whichever has q0 > 0, or, if q0 = 0, a positive first nonzero component."""
    return by_components(_canonical, array_of(q, 4, what="a quaternion"), 4)


def multiply(p: Any, q: Any) -> Array:
    """Return the Hamilton products ``p q`` of two arrays of quaternions, shape (..., 4), broadcast together.

    As a rotation, q acts first.
    """
    p, q = np.broadcast_arrays(array_of(p, 4, what="a quaternion"), array_of(q, 4, what="a quaternion"))

    def product(p0: Array, p1: Array, p2: Array, p3: Array, q0: Array, q1: Array, q2: Array, q3: Array) -> Components:
        return (
            p0 * q0 - p1 * q1 - p2 * q2 - p3 * q3,
            p0 * q1 + p1 * q0 + (p2 * q3 - p3 * q2),
            p0 * q2 + p2 * q0 + (p3 * q1 - p1 * q3),
            p0 * q3 + p3 * q0 + (p1 * q2 - p2 * q1),
        )

    return by_components(product, np.concatenate([p, q], axis=-1), 4)


def to_scipy_order(q: Any) -> Array:
    """Return quaternions reordered as ``(q1, q2, q3, q0)``, the order of SciPy's ``Rotation``, shape (..., 4)."""
    return np.roll(array_of(q, 4, what="a quaternion"), -1, axis=-1)


def from_scipy_order(q: Any) -> Array:
    """Return quaternions ``(q0, q1, q2, q3)`` from SciPy's order ``(x, y, z, w)``, shape (..., 4)."""
    return np.roll(array_of(q, 4, what="a quaternion"), 1, axis=-1)


# Direction cosine matrix


def _dcm(*q: Array) -> Components:
    (q0, q1, q2, q3), squares = in_range(*q)
    scale = 2 / squares
    x, y, z = scale * q1, scale * q2, scale * q3
    xx, yy, zz = x * q1, y * q2, z * q3
    xy, xz, yz = x * q2, x * q3, y * q3
    x, y, z = x * q0, y * q0, z * q0
    return 1 - (yy + zz), xy - z, xz + y, xy + z, 1 - (xx + zz), yz - x, xz - y, yz + x, 1 - (xx + yy)


def quaternion_to_dcm(q: Any) -> Array:
    """Return the direction cosine matrices ``dcm_sb``, shape (..., 3, 3), of quaternions ``q`` of any norm but zero."""
    q = array_of(q, 4, what="a quaternion")
    return by_components(_dcm, q, 9).reshape(*q.shape[:-1], 3, 3)


def quaternion_to_axis(q: Any, axis: int) -> Array:
    """Return column ``axis`` (0, 1 or 2) of ``dcm_sb``, shape (..., 3): the direction of a body axis in space."""
    q = array_of(q, 4, what="a quaternion")
    return by_components(lambda *components: _dcm(*components)[axis::3], q, 3)


def _quaternion_of_dcm(*r: Array) -> Components:
    r11, r12, r13, r21, r22, r23, r31, r32, r33 = r
    x, y, z = r32 - r23, r13 - r31, r21 - r12
    xy, xz, yz = r12 + r21, r13 + r31, r23 + r32
    ww, xx = 1 + (r11 + r22 + r33), 1 + (r11 - r22 - r33)
    yy, zz = 1 + (r22 - r11 - r33), 1 + (r33 - r11 - r22)
    pivot = np.argmax([ww, xx, yy, zz], axis=0)
    squares = ((ww, x, y, z), (x, xx, xy, xz), (y, xy, yy, yz), (z, xz, yz, zz))  # 4 q q^T
    determinant = r11 * (r22 * r33 - r23 * r32) + r12 * (r23 * r31 - r21 * r33) + r13 * (r21 * r32 - r22 * r31)
    row = np.array([np.choose(pivot, column) for column in squares])
    row[:, ~((determinant > 0) & (determinant < np.inf))] = np.nan
    return _canonical(*_normalize(*row))


def dcm_to_quaternion(dcm: Any) -> Array:
    """Return the unit quaternions with ``q0 >= 0``, shape (..., 4), of rotation matrices ``dcm_sb``.

    NaN if an entry is not finite or the determinant <= 0.
    """
    dcm = array_of(dcm, 3, 3, what="a dcm")
    # The formula divides by the largest of the squares 4 q_i^2, so that the divisor is never small. A matrix that is
    # only nearly a rotation is not corrected first.
    return by_components(_quaternion_of_dcm, dcm.reshape(*dcm.shape[:-2], 9), 4)


# Rotation vector, axis and angle


def _exponential(*v: Array) -> Components:
    angle = length(*v)
    half = angle / 2
    ratio = np.sin(half)
    ratio /= angle
    ratio[angle == 0] = 0.5
    return np.cos(half), *(ratio * component for component in v)


def rotation_vector_to_quaternion(vector: Any) -> Array:
    """Return unit quaternions, shape (..., 4), of rotation vectors in rad: the exponential map."""
    return by_components(_exponential, array_of(vector, 3, what="a rotation vector"), 4)


def _logarithm(*q: Array) -> Components:
    (q0, *vector), _ = in_range(*_canonical(*q))
    sine = length(*vector)
    ratio = 2 * np.arctan2(sine, q0) / sine
    np.copyto(ratio, q0, where=sine == 0)  # any finite number will do: the vector is zero; NaN is preserved
    return [ratio * component for component in vector]


def quaternion_to_rotation_vector(q: Any) -> Array:
    """Return rotation vectors in rad, shape (..., 3), of length at most pi.

    For a rotation by pi, the first nonzero component is positive.
    """
    return by_components(_logarithm, array_of(q, 4, what="a quaternion"), 3)


def _quaternion_of_axis_angle(n1: Array, n2: Array, n3: Array, angle: Array) -> Components:
    axis, squares = in_range(n1, n2, n3)
    half = angle / 2
    ratio = np.sin(half) / np.sqrt(squares)
    vector = np.where(angle == 0, 0.0, [ratio * component for component in axis])
    return np.where(np.isnan(vector[0]), np.nan, np.cos(half)), *vector


def axis_angle_to_quaternion(axis: Any, angle: Any, degrees: bool = False) -> Array:
    """Return unit quaternions, shape (..., 4), of rotations about axes of any length by angles, broadcast together.

    The angles are in rad, or in degrees if ``degrees``. A zero axis gives NaN, unless its angle is zero.
    """
    axis, angle = array_of(axis, 3, what="an axis"), array_of(angle, what="an angle")
    angle = np.radians(angle) if degrees else angle
    shape = np.broadcast_shapes(axis.shape[:-1], angle.shape)
    rows = np.concatenate([np.broadcast_to(axis, (*shape, 3)), np.broadcast_to(angle[..., None], (*shape, 1))], axis=-1)
    return by_components(_quaternion_of_axis_angle, rows, 4)


def _axis_angle(*q: Array) -> Components:
    (q0, *vector), squares = in_range(*_canonical(*q))
    angle = 2 * np.arctan2(length(*vector), q0)
    axis = np.array(_normalize(*vector))
    axis[:, (largest(vector) == 0) & ~np.isnan(squares)] = [[1.0], [0.0], [0.0]]
    return *axis, angle


def quaternion_to_axis_angle(q: Any, degrees: bool = False) -> tuple[Array, Array]:
    """Return unit axes, shape (..., 3), and angles from 0 to pi, shape (...), in rad, or in degrees if ``degrees``.

    At zero angle, the axis is (1, 0, 0). A rotation by pi gets the axis whose first nonzero component is positive.
    """
    axis_angle = by_components(_axis_angle, array_of(q, 4, what="a quaternion"), 4)
    return axis_angle[..., :3], np.degrees(axis_angle[..., 3]) if degrees else axis_angle[..., 3]


# Rodrigues parameters


def _quaternion_of_rodrigues(*g: Array) -> Components:
    size = np.maximum(length(*g), 1.0)  # dividing by the size first avoids overflow: g may be as large as 1e308
    return _normalize(1 / size, *(component / size for component in g))


def rodrigues_to_quaternion(g: Any) -> Array:
    """Return unit quaternions, shape (..., 4), of classical Rodrigues parameters, axis times tan(angle/2)."""
    return by_components(_quaternion_of_rodrigues, array_of(g, 3, what="a set of Rodrigues parameters"), 4)


def _rodrigues(*q: Array) -> Components:
    (q0, *vector), squares = in_range(*q)
    g = np.array([component / q0 for component in vector])
    infinite = ~np.isfinite(g).all(axis=0)
    g[:, infinite] = np.nan
    return *g, (infinite & ~np.isnan(squares)).astype(np.float64)


def quaternion_to_rodrigues(q: Any) -> tuple[Array, Mask]:
    """Return classical Rodrigues parameters, shape (..., 3), and a mask.

    The mask is True for rotations by pi, and for rotations so near pi that the parameters overflow. The parameters of
    these rotations are NaN.
    """
    rodrigues = by_components(_rodrigues, array_of(q, 4, what="a quaternion"), 4)
    return rodrigues[..., :3], rodrigues[..., 3] == 1


def _quaternion_of_mrp(*s: Array) -> Components:
    size = length(*s)
    large = np.maximum(size, 1.0)
    small = np.minimum(size, 1 / large)  # length of the shorter of the two sets: |s|, or 1/|s| if |s| > 1
    norm = 1 + small * small
    ratio = 2 * np.where(size > 1, small, 1.0) / norm
    scalar = (1 - small) * (1 + small) / norm
    return np.where(size > 1, -scalar, scalar), *(component / large * ratio for component in s)


def mrp_to_quaternion(s: Any) -> Array:
    """Return unit quaternions, shape (..., 4), of modified Rodrigues parameters, axis times tan(angle/4)."""
    return by_components(_quaternion_of_mrp, array_of(s, 3, what="a set of modified Rodrigues parameters"), 4)


def _mrp_short(*q: Array) -> Components:
    (q0, *vector), squares = in_range(*_canonical(*q))
    ratio = 1 / (np.sqrt(squares) + q0)
    return [ratio * component for component in vector]


def _mrp_of_sign(*q: Array) -> Components:
    (q0, *vector), squares = in_range(*q)
    norm, sine = np.sqrt(squares), length(*vector)
    # 1 / (1 + q0); for negative q0, where this sum cancels, (1 - q0) / sine^2
    return [np.where(q0 >= 0, component / (norm + q0), component / sine * ((norm - q0) / sine)) for component in vector]


def quaternion_to_mrp(q: Any, shadow: bool = True) -> Array:
    """Return modified Rodrigues parameters, shape (..., 3).

    Parameters
    ----------
    q : array, shape (..., 4)
        Quaternions of any norm, scalar first.
    shadow : bool
        Each attitude has two sets, one from q and one from -q. If True, return the shorter set, of length at most 1. If
        False, return the set from q itself, which grows without bound toward q = (-1, 0, 0, 0), where it is NaN.
    """
    return by_components(_mrp_short if shadow else _mrp_of_sign, array_of(q, 4, what="a quaternion"), 3)


def _shadow(*s: Array) -> Components:
    size = length(*s)
    return [-(component / size) / size for component in s]


def mrp_shadow(s: Any) -> Array:
    """Return the shadow ``-s / |s|^2``, the other modified Rodrigues parameters of the same attitude; NaN for s = 0."""
    return by_components(_shadow, array_of(s, 3, what="a set of modified Rodrigues parameters"), 3)


@np.errstate(all="ignore")
def mrp_switch(s: Any) -> tuple[Array, Mask]:
    """Return the shorter of s and its shadow ``-s / |s|^2`` for each row, and a mask of the switched rows."""
    s = array_of(s, 3, what="a set of modified Rodrigues parameters")
    # A propagation that switches whenever |s| > 1 never exceeds 1.
    switched = np.asarray(length(*np.moveaxis(np.atleast_2d(s), -1, 0)) > 1).reshape(s.shape[:-1])
    return np.where(switched[..., None], mrp_shadow(s), s), switched


# Euler angles


def sequence_axes(sequence: str) -> tuple[tuple[int, int, int], tuple[int, int, int], int, int]:
    """Return (axes, order, m, sign) of an Euler sequence, whose attitude ``dcm_sb`` is a product of three rotations.

    ``axes`` are the axes of the three rotations, 0, 1 or 2, in the product from left to right. ``order`` are the
    indices of their angles in the set of Euler angles, (2, 1, 0) for an extrinsic sequence. The axis m is perpendicular
    to the axes i and k of the first two rotations, with the unit vectors ``e_i x e_k = sign e_m``.

    ``"ZYX"`` gives (2, 1, 0), (0, 1, 2), 0, -1.
    """
    axes, intrinsic = parse_sequence(sequence)
    (first, middle, last), order = (axes, (0, 1, 2)) if intrinsic else (axes[::-1], (2, 1, 0))
    return (first, middle, last), order, 3 - first - middle, 1 if (middle - first) % 3 == 1 else -1


def euler_to_quaternion(angles: Any, sequence: str, degrees: bool = False) -> Array:
    """Return unit quaternions, shape (..., 4), of Euler angles in order of application, shape (..., 3).

    Parameters
    ----------
    angles : array, shape (..., 3)
        Angles in rad, or in degrees with ``degrees=True``.
    sequence : str
        Euler sequence: intrinsic in upper case, extrinsic in lower case.
    """
    (first, middle, last), order, cross, sign = sequence_axes(sequence)

    def product(*angle: Array) -> Components:
        half = [angle[place] / 2 for place in order]
        (c1, c2, c3), (s1, s2, s3) = map(np.cos, half), map(np.sin, half)
        a, b, c, d = c1 * c2, s1 * c2, c1 * s2, s1 * s2  # components along 1, e_first, e_middle, e_first x e_middle
        if first == last:
            components = (a * c3 - b * s3, a * s3 + b * c3, c * c3 + d * s3, d * c3 - c * s3)
        else:  # e_last = sign e_first x e_middle
            s3 = sign * s3
            components = (a * c3 - d * s3, b * c3 + c * s3, c * c3 - b * s3, a * s3 + d * c3)
        by_axis = {first: components[1], middle: components[2], cross: sign * components[3]}
        return components[0], by_axis[0], by_axis[1], by_axis[2]

    angles = array_of(angles, 3, what=f"a set of {sequence} angles")
    return by_components(product, np.radians(angles) if degrees else angles, 4)


def quaternion_to_euler(q: Any, sequence: str, degrees: bool = False, lock: float = LOCK) -> tuple[Array, Mask]:
    """Return Euler angles in order of application, shape (..., 3), and a mask of gimbal lock, shape (...).

    Parameters
    ----------
    q : array, shape (..., 4)
        Quaternions of any norm.
    sequence : str
        Euler sequence: intrinsic in upper case, extrinsic in lower case.
    degrees : bool
        Whether the angles are returned in degrees instead of rad.
    lock : float
        Distance of the middle angle from gimbal lock, rad, up to which a sample counts as locked.

    Returns
    -------
    angles : array, shape (..., 3)
        The middle angle is in [0, pi] (proper) or [-pi/2, pi/2] (Tait-Bryan), the other angles are in [-pi, pi].
    locked : bool array, shape (...)
        True where only the sum or the difference of first and third angle is determined. There the third angle (in
        order of application) is set to zero, as SciPy does, and the middle angle is set to its value at lock, which
        changes the attitude by at most ``lock``.

    Notes
    -----
    The angles follow from half-angle sums and differences, as derived in
    :func:`symrot.kinematics.euler.euler_of_quaternion`. The attitude computed back from the angles is accurate to
    rounding at any distance from lock; the angles themselves have an error of about 1e-16 divided by that distance.
    Source: Bernardes & Viollet, PLoS ONE 17 (2022) e0276302.
    """
    (first, middle, last), order, cross, sign = sequence_axes(sequence)
    proper, intrinsic = first == last, order[2] == 2

    def angles_of(*q: Array) -> Components:
        rows, _ = in_range(*q)
        q0, along, across, third = rows[0], rows[1 + first], rows[1 + middle], sign * rows[1 + cross]
        # components along 1, e_first, e_middle, e_first x e_middle; Tait-Bryan times a rotation by pi/2 is proper
        a, b, c, d = (q0, along, across, third) if proper else (q0 - across, along - third, q0 + across, along + third)
        low, high = np.sqrt(a * a + b * b), np.sqrt(c * c + d * d)
        # arctan takes half the time of arctan2; multiples of pi are counted in ``odd`` and added without rounding error
        half_sum, half_difference, odd = np.arctan(b / a), np.arctan(d / c), np.signbit(a) ^ np.signbit(c)
        tilt = 2 * np.arctan(high / low) if proper else np.arctan(2 * (q0 * across + along * third) / (low * high))
        locked: Mask = np.minimum(low, high) <= lock / 2 * np.maximum(low, high)
        if locked.any():
            at_zero = high[locked] < low[locked]
            known = np.where(at_zero, half_sum[locked], half_difference[locked])
            # the third angle is the right factor's (half sum - half difference) if intrinsic, else the left factor's
            half_sum[locked] = known if intrinsic else np.where(at_zero, known, -known)
            half_difference[locked] = known if intrinsic else np.where(at_zero, -known, known)
            odd[locked] = False
            tilt[locked] = np.where(at_zero, 0.0, np.pi) - (0.0 if proper else np.pi / 2)
        left = _sum(half_sum, half_difference, odd)
        right = _sum(half_sum, -half_difference, odd)
        turned = (left, tilt, right if proper or sign < 0 else -right)
        return *(turned if intrinsic else turned[::-1]), locked.astype(np.float64)

    angles_and_lock = by_components(angles_of, array_of(q, 4, what="a quaternion"), 4)
    angles = angles_and_lock[..., :3]
    return np.degrees(angles) if degrees else angles, angles_and_lock[..., 3] == 1


def _sum(x: Array, y: Array, odd: Mask) -> Array:
    """Return the angles ``x + y``, rounded once, for x and y in [-pi/2, pi/2].

    Where ``odd`` is true, the sum is changed by pi towards zero.
    """
    total = x + y
    back = total - x
    error = (x - (total - back)) + (y - back)
    # subtracts pi (or adds pi to a negative sum) where odd is true
    half_turn = np.copysign(odd, total)
    total -= half_turn * np.pi
    error -= half_turn * PI_LOW
    return total + error


def euler_to_dcm(angles: Any, sequence: str, degrees: bool = False) -> Array:
    """Return the matrices ``dcm_sb``, shape (..., 3, 3), of Euler angles in order of application.

    ``sequence`` and ``degrees`` are as for :func:`euler_to_quaternion`.
    """
    return quaternion_to_dcm(euler_to_quaternion(angles, sequence, degrees))


def dcm_to_euler(dcm: Any, sequence: str, degrees: bool = False, lock: float = LOCK) -> tuple[Array, Mask]:
    """Return Euler angles of matrices ``dcm_sb``, and a mask of gimbal lock; details in :func:`quaternion_to_euler`.

    NaN for a determinant <= 0.
    """
    return quaternion_to_euler(dcm_to_quaternion(dcm), sequence, degrees, lock)
