"""Kernels of dynamics: Euler's equations for each symmetry of a body, rates of the state, energy, angular momentum."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Expr, Matrix, Symbol, diag

from symrot import symbols
from symrot.dynamics.equations import angular_acceleration
from symrot.formula.program import Argument
from symrot.kernels.definition import Box, Definition, Law, argument, boxed, interval, result, scalar
from symrot.kernels.quaternion import QUATERNION, QUATERNION_BOX, Named, halved, quaternion_rate, turned
from symrot.kinematics.quaternion import quaternion_product, quaternion_to_dcm, unit_relation

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
    """Yield (name, function) for every kernel of dynamics: the function derives the kernel's arguments and formulas."""
    for body in _BODIES:
        yield f"euler_equations_{body}", partial(_euler_equations, f"euler_equations_{body}", body)
    for body in ("tensor", "principal"):
        yield f"rigid_body_{body}", partial(_rigid_body, f"rigid_body_{body}", body)
    yield "heavy_top", partial(_heavy_top, "heavy_top", "principal")
    yield "heavy_top_symmetric", partial(_heavy_top, "heavy_top_symmetric", "symmetric")
    for name, make in _QUANTITIES.items():
        yield name, partial(make, name)


def tensor_argument(body: str = "tensor") -> Argument:
    """Return the input argument for the inertia of a body: six entries for ``"tensor"``, else the principal moments."""
    return argument("inertia", "in", _BODIES[body][0], _MEANING[body])


def _body_box(body: str) -> Box:
    return TENSOR_BOX if body == "tensor" else boxed(_BODIES[body][0], 1, 4)


def _symbols(name: str, count: int = 3) -> tuple[Symbol, ...]:
    return tuple(Symbol(f"{name}_{i}", real=True) for i in range(1, count + 1))


def _solved(inertia: Matrix, omega: Matrix, torque: Matrix) -> tuple[Named, Matrix]:
    """Return intermediate quantities as pairs (symbol, formula), and the angular acceleration in these symbols."""
    if inertia.is_diagonal():
        return (), angular_acceleration(inertia, omega, torque)
    momentum, moment = Matrix(_symbols("L")), Matrix(_symbols("M"))
    entries, adjugate = _symbols("cofactor", 6), inertia.adjugate()
    places = [(i, j) for i in range(3) for j in range(i, 3)]
    held = dict(zip(places, entries, strict=True))
    cofactors = Matrix(3, 3, lambda i, j: held[min(i, j), max(i, j)])
    determinant = Symbol("determinant", real=True)
    named = (
        *zip(momentum, inertia * omega, strict=True),
        *zip(entries, (adjugate[place] for place in places), strict=True),
        (determinant, inertia.row(0).dot(cofactors.row(0))),
        *zip(moment, (torque - omega.cross(momentum)) / determinant, strict=True),
    )
    return named, cofactors * moment


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
    halves, half = halved(symbols.omega_b)

    return Definition(
        name, "right-hand side of a rigid body: angular acceleration and rate of the quaternion, "
        + ("full inertia tensor" if body == "tensor" else "principal axes"),
        (tensor_argument(body), OMEGA, QUATERNION, _TORQUE),
        (result("domega", acceleration, symbols.omega_rates, "angular acceleration, body components"),
         _attitude_rate(half)),
        "positive definite inertia", f"{_EULER}, derivations/quaternion_rates.md",
        _body_box(body) | OMEGA_BOX | QUATERNION_BOX | boxed(symbols.torque_b, -10, 10),
        lambda: (_law_of_euler(inertia, torque), _law_of_attitude()), (*named, *halves),
    )  # fmt: skip


def _attitude_rate(half: tuple[Symbol, ...]) -> tuple[Argument, tuple[Expr, ...]]:
    formulas = quaternion_rate(symbols.quaternion, half)
    return result("dq", formulas, symbols.quaternion_rates, "rate of the quaternion")


def _law_of_attitude() -> Law:
    q, dq = symbols.quaternion, symbols.quaternion_rates
    return Law("dq/dt is q (0, omega) / 2", tuple(Matrix(dq) - quaternion_product(q, [0, *symbols.omega_b]) / 2))


_WEIGHT = symbols.W
_CENTER = argument("center_of_mass", "in", symbols.center_of_mass, "from the fixed point, body axes")
_DISTANCE = symbols.h


def _heavy_top(name: str, body: str) -> Definition:
    """Return the kernel ``name``, the equations of motion of a heavy top about its fixed point."""
    _, inertia = _BODIES[body]
    symmetric = body == "symmetric"
    # in a symmetric top the centre of mass lies on body axis 3
    center = Matrix([0, 0, _DISTANCE]) if symmetric else Matrix(symbols.center_of_mass)
    omega, upward = Matrix(symbols.omega_b), quaternion_to_dcm().T.col(2)
    vertical = Matrix(_symbols("half_vertical"))
    weighed, lever = _weighed(center)
    acceleration = angular_acceleration(inertia, omega, vertical.cross(weighed))
    halves, half = halved(symbols.omega_b)
    named = tuple((symbol, value) for symbol, value in zip(vertical, upward / 2, strict=True)
                  if any(entry.has(symbol) for entry in acceleration))  # fmt: skip

    def laws() -> tuple[Law, ...]:
        return (_law_of_euler(inertia, -_WEIGHT * center.cross(upward)), _law_of_attitude())

    distance = scalar(_DISTANCE, "of the centre of mass from the fixed point, along body axis 3")
    return Definition(
        name, "right-hand side of a heavy top about its fixed point, the weight along -z of space, "
        + ("symmetric about body axis 3" if symmetric else "principal axes"),
        (tensor_argument(body), scalar(_WEIGHT, "weight"), distance if symmetric else _CENTER, OMEGA, QUATERNION),
        (result("domega", acceleration, symbols.omega_rates, "angular acceleration, body components"),
         _attitude_rate(half)),
        "unit quaternions; positive moments", "derivations/heavy_top.md, derivations/quaternion_rates.md",
        _body_box(body) | {str(_WEIGHT): interval("1/10", 100)}
        | (boxed((_DISTANCE,), "1/100", 1) if symmetric else boxed(symbols.center_of_mass, -1, 1))
        | OMEGA_BOX | QUATERNION_BOX, laws, (*lever, *named, *halves),
    )  # fmt: skip


def _weighed(center: Matrix) -> tuple[Matrix, Named]:
    """Return (vector, definitions): the vector 2 W r, for the weight W and the centre of mass r = ``center``.

    r is measured from the fixed point. With the upward unit vector e, the torque of the weight is the cross product of
    e/2 and this vector; the kernel computes e/2, which takes fewer operations than e. Each component of the vector is
    a new symbol, or 0 if r has a zero there; the definitions are pairs (symbol, formula).
    """
    components = [symbol if c else c for symbol, c in zip(_symbols("moment_of_weight"), center, strict=True)]
    return Matrix(components), tuple(
        (symbol, 2 * _WEIGHT * c) for symbol, c in zip(components, center, strict=True) if c
    )


_MOMENTUM_S = tuple(Symbol(f"L_{i}", real=True) for i in "xyz")
_MOMENTUM_B = tuple(Symbol(f"L_{i}", real=True) for i in "123")


def _kinetic_energy(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)

    def laws() -> tuple[Law, ...]:
        gradient = [(omega.dot(TENSOR * omega) / 2).diff(w) for w in omega]
        return (Law("twice the energy is omega . L, where L is the gradient of the energy",
                    (2 * symbols.E - omega.dot(Matrix(gradient)),)),)  # fmt: skip

    return Definition(
        name, "kinetic energy of rotation", (tensor_argument(), OMEGA),
        (result("energy", [omega.dot(TENSOR * omega) / 2], [symbols.E], "kinetic energy"),),
        "all finite values", "derivations/kinetic_energy.md", TENSOR_BOX | OMEGA_BOX, laws,
    )  # fmt: skip


def _momentum_body(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)

    def laws() -> tuple[Law, ...]:
        momentum = Matrix(_MOMENTUM_B)
        return (Law("the momentum is the inertia tensor times omega", tuple(momentum - TENSOR * omega)),)

    return Definition(
        name, "angular momentum in body axes", (tensor_argument(), OMEGA),
        (result("momentum", TENSOR * omega, _MOMENTUM_B, "angular momentum, body components", "kg m^2/s"),),
        "all finite values", "derivations/angular_momentum.md", TENSOR_BOX | OMEGA_BOX, laws,
    )  # fmt: skip


def _momentum_space(name: str) -> Definition:
    omega = Matrix(symbols.omega_b)
    named, formulas = turned(symbols.quaternion, Matrix(_MOMENTUM_B))
    named = (*zip(_MOMENTUM_B, TENSOR * omega, strict=True), *named)

    def laws() -> tuple[Law, ...]:
        momentum = Matrix(_MOMENTUM_S)
        rotated = quaternion_to_dcm() * TENSOR * omega
        return (
            Law(
                "the momentum is the dcm times the momentum in body axes", tuple(momentum - rotated), (unit_relation(),)
            ),
        )

    return Definition(
        name, "angular momentum in space axes", (tensor_argument(), OMEGA, QUATERNION),
        (result("momentum", formulas, _MOMENTUM_S, "angular momentum, space components",
                "kg m^2/s"),),
        "unit quaternions", "derivations/angular_momentum.md", TENSOR_BOX | OMEGA_BOX | QUATERNION_BOX, laws, named,
    )  # fmt: skip


_QUANTITIES: dict[str, Callable[[str], Definition]] = {
    "kinetic_energy": _kinetic_energy,
    "angular_momentum_body": _momentum_body,
    "angular_momentum_space": _momentum_space,
}
