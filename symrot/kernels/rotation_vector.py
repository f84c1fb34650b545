"""Kernels of rotation vectors: exponential map and logarithm, rotation matrix, rates; accurate at zero and pi."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Expr, ImmutableMatrix, Matrix, Rational, Symbol, cos, eye, sqrt

from symrot import symbols
from symrot.kernels.definition import Definition, Law, argument, boxed, result
from symrot.kernels.quaternion import OMEGA, QUATERNION, QUATERNION_BOX
from symrot.kernels.removable import arc_ratio, copysign, sinc, sine_gap, tangent_gap
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.kinematics.rotation_vector import dcm, jacobian, quaternion_of_rotation_vector
from symrot.kinematics.rotations import skew

__all__ = ["definitions"]

_DERIVATION = "derivations/rotation_vector.md"
_ANGLE = Symbol("angle", real=True)
_VECTOR = symbols.rotation_vector
_NAMED = ((_ANGLE, sqrt(sum(v**2 for v in _VECTOR))),)
_ARGUMENT = argument("v", "in", _VECTOR, "rotation vector, axis times angle")
_BOX = boxed(_VECTOR, -3, 3)


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of rotation vectors: the function derives its arguments and formulas."""
    for name, make in _KINDS.items():
        yield name, partial(make, name)


def _of_skew(c1: Expr, c2: Expr) -> ImmutableMatrix:
    """Return the matrix ``1 + c1 K + c2 K^2``, K the cross-product matrix of the rotation vector."""
    matrix = skew(_VECTOR)
    return ImmutableMatrix(eye(3) + c1 * matrix + c2 * matrix**2)


def _quaternion(name: str) -> Definition:
    half = _ANGLE / 2

    def laws() -> tuple[Law, ...]:
        derived = quaternion_of_rotation_vector(_VECTOR)
        quaternion = Matrix(symbols.quaternion)
        return (Law("the quaternion is the one derived from axis and angle", tuple(quaternion - derived)),
                Law("the dcm of the quaternion is the exponential of skew(v)",
                    tuple(quaternion_to_dcm(quaternion) - dcm(_VECTOR))))  # fmt: skip

    formulas = [cos(half), *(sinc(half) / 2 * v for v in _VECTOR)]
    return Definition(
        name, "quaternion of a rotation vector (the exponential map)", (_ARGUMENT,),
        (result("q", formulas, symbols.quaternion, "attitude, body to space"),),
        "all rotation vectors, zero included", _DERIVATION, _BOX, laws, _NAMED,
    )  # fmt: skip


def _of_quaternion(name: str) -> Definition:
    q0, *vector = symbols.quaternion
    length, cosine = Symbol("length", real=True), Symbol("cosine", real=True)
    named = ((length, sqrt(sum(q**2 for q in vector))), (cosine, sqrt(q0**2)))
    ratio = 2 * arc_ratio(length, cosine)
    formulas = [ratio * copysign(1, q0) * q for q in vector]

    def laws() -> tuple[Law, ...]:
        norm = sum(q**2 for q in symbols.quaternion)
        return (
            Law(
                "the dcm of the rotation vector is that of the quaternion",
                tuple(dcm(_VECTOR) - quaternion_to_dcm()),
                (norm - 1,),
            ),
        )

    return Definition(
        name, "rotation vector of a quaternion (the logarithm), of length at most pi", (QUATERNION,),
        (result("v", formulas, _VECTOR, "rotation vector, axis times angle"),),
        "quaternions of any norm but 0; at a half turn v and -v are one attitude", _DERIVATION, QUATERNION_BOX, laws,
        named,
    )  # fmt: skip


def _dcm(name: str) -> Definition:
    def laws() -> tuple[Law, ...]:
        return (
            Law(
                "the matrix is the exponential of skew(v)", tuple(Matrix(3, 3, symbols.rotation_entries) - dcm(_VECTOR))
            ),
        )

    return Definition(
        name, "direction cosine matrix dcm_sb of a rotation vector (Rodrigues' formula), row by row", (_ARGUMENT,),
        (result("dcm", _of_skew(sinc(_ANGLE), sinc(_ANGLE / 2) ** 2 / 2), symbols.rotation_entries,
                "entry of dcm_sb"),),
        "all rotation vectors, zero included", _DERIVATION, _BOX, laws, _NAMED,
    )  # fmt: skip


def _jacobian(frame: str, name: str) -> Definition:
    sign = {"body": -1, "space": 1}[frame]
    formulas = _of_skew(sign * sinc(_ANGLE / 2) ** 2 / 2, sine_gap(_ANGLE))

    def laws() -> tuple[Law, ...]:
        derived = jacobian(frame, _VECTOR)
        return (
            Law("B is the Jacobian of the exponential map", tuple(Matrix(3, 3, symbols.jacobian_entries) - derived)),
        )

    return Definition(
        name, f"rate Jacobian B of a rotation vector: omega_{frame[0]} = B dv/dt, row by row", (_ARGUMENT,),
        (result("jacobian", formulas, symbols.jacobian_entries, "entry of B"),),
        "all rotation vectors, zero included", _DERIVATION, _BOX, laws, _NAMED,
    )  # fmt: skip


def _rates(frame: str, name: str) -> Definition:
    sign, omega = {"body": 1, "space": -1}[frame], Matrix(OMEGA[frame])
    half = _ANGLE / 2
    crossed = [Symbol(f"cross_{i}", real=True) for i in "123"]
    named = (*_NAMED, *zip(crossed, Matrix(_VECTOR).cross(omega), strict=True))
    c1, c2 = Rational(sign, 2), tangent_gap(half) / (4 * sinc(half))
    formulas = omega + c1 * Matrix(crossed) + c2 * Matrix(_VECTOR).cross(Matrix(crossed))

    def laws() -> tuple[Law, ...]:
        vanishing = Matrix(jacobian(frame, _VECTOR)) * Matrix(symbols.rotation_vector_rates) - omega
        return (Law("B dv/dt is the given angular velocity", tuple(vanishing)),)

    return Definition(
        name, f"rate of a rotation vector from the angular velocity in {frame} axes",
        (_ARGUMENT, argument("omega", "in", OMEGA[frame], f"angular velocity, {frame} components")),
        (result("dv", formulas, symbols.rotation_vector_rates, "rate of the rotation vector"),),
        "rotation vectors shorter than 2 pi, zero included", _DERIVATION, _BOX | boxed(OMEGA[frame], -10, 10), laws,
        named,
    )  # fmt: skip


_KINDS: dict[str, Callable[[str], Definition]] = {
    "rotation_vector_quaternion": _quaternion,
    "rotation_vector_of_quaternion": _of_quaternion,
    "rotation_vector_dcm": _dcm,
    "rotation_vector_body_jacobian": partial(_jacobian, "body"),
    "rotation_vector_space_jacobian": partial(_jacobian, "space"),
    "rotation_vector_body_rates": partial(_rates, "body"),
    "rotation_vector_space_rates": partial(_rates, "space"),
}
