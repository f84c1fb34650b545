"""Rotation vector (axis times angle): the exponential map and its Jacobians, and the axis-angle pair.

Every formula is a function of the skew matrix K of the vector, computed from the eigenvalues of K
(:func:`symrot.kinematics.rotations.function_of_skew`). The coefficients have removable singularities at zero angle, so
that functions of the zero vector return limits. Convention: :mod:`symrot.conventions`. Proof:
``derivations/rotation_vector.md``.
"""

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

from sympy import (
    Abs,
    Expr,
    ImmutableMatrix,
    Integer,
    Interval,
    Matrix,
    Max,
    Min,
    Symbol,
    atan2,
    cos,
    exp,
    eye,
    oo,
    sin,
    sinh,
    sqrt,
    sympify,
)

from symrot import symbols
from symrot.conventions import check_frame
from symrot.kinematics.chart import Chart, RateFacts, RateMatrix
from symrot.kinematics.rotations import expressions, function_of_skew, skew

__all__ = [
    "axis_angle_chart",
    "axis_angle_jacobian",
    "axis_angle_of_quaternion",
    "chart",
    "dcm",
    "dcm_of_axis_angle",
    "jacobian",
    "quaternion_of_axis_angle",
    "quaternion_of_rotation_vector",
    "rotation_vector_of_quaternion",
]

_size = Symbol("a", positive=True)


def _stretch(z: Expr) -> Expr:
    """Return ``sinh(z/2) / (z/2)``; for z = i a, ``sin(a/2) / (a/2)``."""
    # the factor by which the rate matrix scales components normal to a rotation vector of length a
    return 2 * sinh(z / 2) / z


def _half_sine(size: Expr) -> Expr:
    """Return ``sin(a/2) / (a/2)`` for the length a of a rotation vector, and its limit 1 for a = 0."""
    return Integer(1) if size.is_zero else sin(size / 2) / (size / 2)


def _jacobian_function(frame: str) -> Callable[[Expr], Expr]:
    """Return the function f with ``omega = f(K) dv/dt``, where K is the skew matrix of the rotation vector v.

    ``frame``, "body" or "space", is the frame of the components of omega.
    """
    # The mean over s in [0, 1] of exp(-s K) (body) or exp(s K) (space). For the body, f(z) = (1 - exp(-z)) / z: a
    # rotation by half the angle, times a scale factor.
    sign = {"body": -1, "space": 1}[check_frame(frame)]
    return lambda z: exp(sign * z / 2) * _stretch(z)


@cache
def _coefficients(name: str) -> tuple[Expr, Expr, Expr]:
    """Return c0, c1, c2 of ``f(K) = c0 + c1 K + c2 K^2`` for the function f with this name (:func:`_combine`)."""
    functions: dict[str, Callable[[Expr], Expr]] = {
        "dcm": exp,
        "body": _jacobian_function("body"),
        "space": _jacobian_function("space"),
        "body inverse": lambda z: exp(z / 2) / _stretch(z),
        "space inverse": lambda z: exp(-z / 2) / _stretch(z),
    }
    return function_of_skew(functions[name], Integer(1), _size)


def _combine(name: str, vector: Sequence[Expr], size: Expr) -> ImmutableMatrix:
    """Return ``f(K)`` for the function f called ``name`` and the skew matrix K of a rotation vector of length ``size``.

    For "dcm", f(K) is the direction cosine matrix exp(K). For "body" and "space", it is the Jacobian B with
    ``omega = B dv/dt`` in body or space components; for "body inverse" and "space inverse", the inverse of B.
    """
    if size.is_zero:  # each of these functions is 1 at zero
        return ImmutableMatrix(eye(3))
    c0, c1, c2 = (c.xreplace({_size: size}) for c in _coefficients(name))
    matrix = skew(vector)
    return ImmutableMatrix(c0 * eye(3) + c1 * matrix + c2 * matrix**2)


def length(vector: Sequence[Expr]) -> Expr:
    """Return the length of a vector, ``sqrt(v1^2 + v2^2 + v3^2)``."""
    return sqrt(sum(component**2 for component in vector))


def dcm(vector: Sequence[Any] | Matrix = symbols.rotation_vector) -> ImmutableMatrix:
    """Return ``dcm_sb = exp(skew(v))``, shape (3, 3), of a rotation vector in rad (Rodrigues' formula)."""
    vector = expressions(vector, 3, "a rotation vector")
    return _combine("dcm", vector, length(vector))


def jacobian(frame: str = "body", vector: Sequence[Any] | Matrix = symbols.rotation_vector) -> RateMatrix:
    """Return B(v), shape (3, 3), with ``omega = B(v) * dv/dt``; singular for lengths 2 pi n of v, n > 0.

    Raises
    ------
    InputError
        If the frame is unknown, or the vector does not have three components.

    Notes
    -----
    With a = ``|v|`` and K the skew matrix of v, B is the right Jacobian of the exponential map in body components,
    ``1 - (1 - cos a)/a^2 K + (a - sin a)/a^3 K^2``, and its transpose, the left Jacobian, in space components.
    """
    vector = expressions(vector, 3, "a rotation vector")
    size = length(vector)
    # At lengths 2 pi n, vectors of all directions describe the same attitude.
    stretch = _half_sine(size)
    return RateMatrix.build(
        _combine(check_frame(frame), vector, size),
        RateFacts(
            name="rotation_vector",
            frame=frame,
            parameters=vector,
            relations=(),
            inverse=_combine(f"{frame} inverse", vector, size),
            determinant=stretch**2,
            condition_number=1 / Abs(stretch),  # singular values of B: 1 along v, |stretch| <= 1 normal to v
            variable=size,
            along=partial(_along, frame),
            domain=Interval.open(0, oo),
        ),
    )


def _along(frame: str, size: Expr) -> tuple[Expr, ImmutableMatrix]:
    """Return (determinant, inverse) of the rate matrix at the rotation vector ``size * n``, for a unit axis n."""
    vector = tuple(size * n for n in symbols.axis)
    return _half_sine(size) ** 2, _combine(f"{frame} inverse", vector, size)


def quaternion_of_rotation_vector(vector: Sequence[Any] | Matrix = symbols.rotation_vector) -> ImmutableMatrix:
    """Return the unit quaternion, shape (4, 1), of a rotation vector (axis times angle, rad): the exponential map."""
    vector = expressions(vector, 3, "a rotation vector")
    size = length(vector)
    return ImmutableMatrix([cos(size / 2), *(_half_sine(size) / 2 * component for component in vector)])


def rotation_vector_of_quaternion(q: Sequence[Any] | Matrix = symbols.quaternion) -> ImmutableMatrix:
    """Return the rotation vector, shape (3, 1), rad, of a quaternion of any norm: its length is at most 2 pi.

    If the vector part of the quaternion is zero, the result is zero for a positive q0, otherwise undefined.
    """
    q0, *vector = expressions(q, 4, "a quaternion")
    # the limit of the formula; for other q0 without a vector part, the result is undefined
    if q0.is_positive and not any(vector):
        return ImmutableMatrix(vector)
    axis_and_angle = axis_angle_of_quaternion(q)
    return ImmutableMatrix(axis_and_angle[3] * axis_and_angle[:3, 0])


def dcm_of_axis_angle(axis: Sequence[Any] | Matrix = symbols.axis, angle: Any = symbols.alpha) -> ImmutableMatrix:
    """Return the matrix ``dcm_sb``, shape (3, 3), of a body that is rotated by ``angle`` (rad) about a unit axis.

    It maps body components of a vector to space components.
    """
    axis, angle = expressions(axis, 3, "an axis"), sympify(angle)
    c0, c1, c2 = function_of_skew(lambda z: exp(angle * z), Integer(1), Integer(1))
    matrix = skew(axis)
    return ImmutableMatrix(c0 * eye(3) + c1 * matrix + c2 * matrix**2)


def quaternion_of_axis_angle(
    axis: Sequence[Any] | Matrix = symbols.axis, angle: Any = symbols.alpha
) -> ImmutableMatrix:
    """Return the unit quaternion of a rotation by ``angle`` (rad) about a unit axis, shape (4, 1)."""
    axis, half = expressions(axis, 3, "an axis"), sympify(angle) / 2
    return ImmutableMatrix([cos(half), *(sin(half) * component for component in axis)])


def axis_angle_of_quaternion(q: Sequence[Any] | Matrix = symbols.quaternion) -> ImmutableMatrix:
    """Return axis and angle, ``(n1, n2, n3, alpha)``, of a quaternion of any norm, shape (4, 1).

    The angle is from 0 to 2 pi, rad. The axis is undefined (SymPy's nan) if the vector part of the quaternion is zero.
    """
    q0, *vector = expressions(q, 4, "a quaternion")
    size = length(vector)
    # By atan2 the angle is accurate when small; 2 acos(q0) is not.
    return ImmutableMatrix([*(component / size for component in vector), 2 * atan2(size, q0)])


def axis_angle_jacobian(frame: str = "body") -> RateMatrix:
    """Return the rate matrix B, shape (3, 4), with ``omega = B * d(n1, n2, n3, alpha)/dt`` for a unit axis n.

    Notes
    -----
    B is the derivative of the exponential map at ``alpha n``. Let K be the matrix of the cross product with n. For
    vectors normal to n, K^2 = -1, as for the imaginary unit. B rotates and scales such vectors by the complex factor
    ``f(i) = (1 - exp(-i alpha)) / i = 2 sin(alpha/2) exp(-i alpha/2)``.
    """
    n, alpha = symbols.axis, symbols.alpha
    sign = {"body": -1, "space": 1}[check_frame(frame)]
    stretch, matrix = 2 * sin(alpha / 2), skew(n)
    real, imaginary = stretch * cos(alpha / 2), sign * stretch * sin(alpha / 2)
    # omega_b = n dalpha + sin(alpha) dn - (1 - cos(alpha)) n x dn; in space components the last sign is plus. Singular
    # at alpha = 2 pi k, where no axis is defined.
    determinant, inverse = _axis_angle_along(frame, alpha)
    return RateMatrix.build(
        Matrix.hstack(real * eye(3) + imaginary * matrix, Matrix(n)),
        RateFacts(
            name="axis_angle",
            frame=frame,
            parameters=(*n, alpha),
            relations=(sum(component**2 for component in n) - 1,),
            inverse=inverse,
            # of the 4 x 4 matrix with B below the row (n, 0), the gradient of |n|^2 / 2
            determinant=determinant,
            # for rates that preserve |n| = 1
            condition_number=Max(1, Abs(stretch)) / Min(1, Abs(stretch)),
            variable=alpha,
            along=partial(_axis_angle_along, frame),
        ),
    )


def _axis_angle_along(frame: str, alpha: Expr) -> tuple[Expr, ImmutableMatrix]:
    sign = {"body": 1, "space": -1}[frame]
    matrix, stretch = skew(symbols.axis), 2 * sin(alpha / 2)
    across = -cos(alpha / 2) / stretch * matrix**2 + Integer(sign) / 2 * matrix
    return stretch**2, ImmutableMatrix(Matrix.vstack(across, Matrix([symbols.axis])))


@cache
def chart() -> Chart:
    """Return the chart (attitude description) of rotation vectors: it describes every attitude.

    It is singular at the lengths 2 pi, 4 pi, ..
    """
    return Chart(
        name="rotation_vector",
        parameters=symbols.rotation_vector,
        relations=(),
        dcm=dcm(),
        quaternion=quaternion_of_rotation_vector(),
        of_quaternion=rotation_vector_of_quaternion,
        rate_matrix=jacobian,
        unreached=None,
        about="rotation vector, axis times angle, rad",
    )


@cache
def axis_angle_chart() -> Chart:
    """Return the chart (attitude description) of a unit axis and an angle; it is singular at multiples of 2 pi."""
    n, alpha = symbols.axis, symbols.alpha
    return Chart(
        name="axis_angle",
        parameters=(*n, alpha),
        relations=(sum(component**2 for component in n) - 1,),
        dcm=dcm_of_axis_angle(),
        quaternion=quaternion_of_axis_angle(),
        of_quaternion=axis_angle_of_quaternion,
        rate_matrix=axis_angle_jacobian,
        unreached=None,
        about="unit axis and angle, rad",
    )
