"""Kernels of dynamics: Euler's equations for each class of body, full right-hand sides, energy, angular momentum."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Expr, Matrix, Symbol, diag

from symrot import symbols
from symrot.dynamics.equations import angular_acceleration, inverse
from symrot.kernel import Argument
from symrot.kernels.definition import Box, Definition, Law, argument, boxed, result
from symrot.kernels.quaternion import QUATERNION, QUATERNION_BOX
from symrot.kinematics.quaternion import dcm_of, qmul, quaternion_rates, unit_relation

__all__ = ["OMEGA", "OMEGA_BOX", "TENSOR", "TENSOR_BOX", "definitions", "tensor_argument"]

OMEGA = argument("omega", "in", symbols.omega_b, "angular velocity, body components")
OMEGA_BOX = boxed(symbols.omega_b, -10, 10)
ENTRIES = (*symbols.moments, *symbols.products)  # xx, yy, zz, xy, xz, yz
_xx, _yy, _zz, _xy, _xz, _yz = ENTRIES
TENSOR = Matrix([[_xx, _xy, _xz], [_xy, _yy, _yz], [_xz, _yz, _zz]])
TENSOR_BOX = boxed(symbols.moments, 1, 4) | boxed(symbols.products, "-1/4", "1/4")

_EULER = "derivations/euler_equations.md"
_A, _B, _C = symbols.principal
_BODIES: dict[str, tuple[tuple[Symbol, ...], Matrix]] = {
    "tensor": (ENTRIES, TENSOR),
    "principal": ((_A, _B, _C), diag(_A, _B, _C)),
    "symmetric": ((_A, _C), diag(_A, _A, _C)),
    "spherical": ((_A,), diag(_A, _A, _A)),
}
_MEANING = {
    "tensor": "inertia tensor (xx, yy, zz, xy, xz, yz), products with their minus sign, about the point of motion",
    "principal": "principal moment about the point of motion",
    "symmetric": "principal moment: across the axis, about the axis (body axis 3)",
    "spherical": "moment about every axis",
}
_TORQUE = argument("torque", "in", symbols.torque_b, "torque about the same point, body components")


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield name and definition, made on demand, of every kernel of dynamics."""
    for body in _BODIES:
        yield f"euler_equations_{body}", partial(_euler_equations, f"euler_equations_{body}", body)
    for body in ("tensor", "principal"):
        yield f"rigid_body_{body}", partial(_rigid_body, f"rigid_body_{body}", body)
    for name, make in _QUANTITIES.items():
        yield name, partial(make, name)


def tensor_argument(body: str = "tensor") -> Argument:
    """Return the input that holds the inertia of a class of bodies."""
    return argument("inertia", "in", _BODIES[body][0], _MEANING[body])


def _body_box(body: str) -> Box:
    return TENSOR_BOX if body == "tensor" else boxed(_BODIES[body][0], 1, 4)


Named = tuple[tuple[Symbol, Expr], ...]


def _solved(inertia: Matrix, omega: Matrix, torque: Matrix) -> tuple[Named, Matrix]:
    """Return named quantities and the angular acceleration in them."""
    if inertia.is_diagonal():
        return (), angular_acceleration(inertia, omega, torque)
    momentum, moment = (Matrix([Symbol(f"{letter}_{i}", real=True) for i in (1, 2, 3)]) for letter in "LM")
    named = (*zip(momentum, inertia * omega, strict=True), *zip(moment, torque - omega.cross(momentum), strict=True))
    return named, inverse(inertia) * moment


def _law_of_euler(inertia: Matrix, torque: Matrix) -> Law:
    omega, acceleration = Matrix(symbols.omega_b), Matrix(symbols.omega_rates)
    vanishing = inertia * acceleration + omega.cross(inertia * omega) - torque
    return Law("I domega/dt + omega x I omega is the torque", tuple(vanishing))


def _euler_equations(name: str, body: str) -> Definition:
    _, inertia = _BODIES[body]
    omega, torque = Matrix(symbols.omega_b), Matrix(symbols.torque_b)
    named, acceleration = _solved(inertia, omega, torque)
    return Definition(
        name, f"angular acceleration from Euler's equations, {body} body" if body != "tensor"
        else "angular acceleration from Euler's equations, full inertia tensor",
        (tensor_argument(body), OMEGA, _TORQUE),
        (result("domega", acceleration, symbols.omega_rates, "angular acceleration, body components"),),
        "positive definite inertia", _EULER, _body_box(body) | OMEGA_BOX | boxed(symbols.torque_b, -10, 10),
        lambda: (_law_of_euler(inertia, torque),), named,
    )  # fmt: skip


def _rigid_body(name: str, body: str) -> Definition:
    _, inertia = _BODIES[body]
    omega, torque = Matrix(symbols.omega_b), Matrix(symbols.torque_b)
    named, acceleration = _solved(inertia, omega, torque)

    def laws() -> tuple[Law, ...]:
        q, dq = symbols.quaternion, symbols.quaternion_rates
        return (
            _law_of_euler(inertia, torque),
            Law("dq/dt is q (0, omega) / 2", tuple(Matrix(dq) - qmul(q, [0, *omega]) / 2)),
        )

    return Definition(
        name, "right-hand side of a rigid body: angular acceleration and rate of the quaternion, "
        + ("full inertia tensor" if body == "tensor" else "principal axes"),
        (tensor_argument(body), OMEGA, QUATERNION, _TORQUE),
        (result("domega", acceleration, symbols.omega_rates, "angular acceleration, body components"),
         result("dq", quaternion_rates("body") * omega, symbols.quaternion_rates, "rate of the quaternion")),
        "positive definite inertia", f"{_EULER}, derivations/quaternion_rates.md",
        _body_box(body) | OMEGA_BOX | QUATERNION_BOX | boxed(symbols.torque_b, -10, 10), laws, named,
    )  # fmt: skip


_MOMENTUM_S = tuple(Symbol(f"L_{i}", real=True) for i in "xyz")
_MOMENTUM_B = tuple(Symbol(f"L_{i}", real=True) for i in "123")


def _kinetic_energy(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)

    def laws() -> tuple[Law, ...]:
        gradient = [(omega.dot(TENSOR * omega) / 2).diff(w) for w in omega]
        return (Law("twice it is omega . L, with L its gradient",
                    (2 * symbols.E - omega.dot(Matrix(gradient)),)),)  # fmt: skip

    return Definition(
        name, "kinetic energy of rotation", (tensor_argument(), OMEGA),
        (result("energy", [omega.dot(TENSOR * omega) / 2], [symbols.E], "kinetic energy"),),
        "all finite values", "derivations/kinetic_energy.md", TENSOR_BOX | OMEGA_BOX, laws,
    )  # fmt: skip


def _momentum_body(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)

    def laws() -> tuple[Law, ...]:
        found = Matrix(_MOMENTUM_B)
        return (Law("it is the inertia tensor times omega", tuple(found - TENSOR * omega)),)

    return Definition(
        name, "angular momentum in body axes", (tensor_argument(), OMEGA),
        (result("momentum", TENSOR * omega, _MOMENTUM_B, "angular momentum, body components", "kg m^2/s"),),
        "all finite values", "derivations/angular_momentum.md", TENSOR_BOX | OMEGA_BOX, laws,
    )  # fmt: skip


def _momentum_space(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)
    named = tuple(zip(_MOMENTUM_B, TENSOR * omega, strict=True))

    def laws() -> tuple[Law, ...]:
        found = Matrix(_MOMENTUM_S)
        return (Law("it is the dcm times the momentum in body axes", tuple(found - dcm_of() * TENSOR * omega),
                    (unit_relation(),)),)  # fmt: skip

    return Definition(
        name, "angular momentum in space axes", (tensor_argument(), OMEGA, QUATERNION),
        (result("momentum", dcm_of() * Matrix(_MOMENTUM_B), _MOMENTUM_S, "angular momentum, space components",
                "kg m^2/s"),),
        "unit quaternions", "derivations/angular_momentum.md", TENSOR_BOX | OMEGA_BOX | QUATERNION_BOX, laws, named,
    )  # fmt: skip


_QUANTITIES: dict[str, Callable[[str], Definition]] = {
    "kinetic_energy": _kinetic_energy,
    "angular_momentum_body": _momentum_body,
    "angular_momentum_space": _momentum_space,
}
