"""Kernels of the torques that a scene can have, in body components."""

from collections.abc import Callable, Iterator
from functools import partial

from sympy import Matrix, eye, sqrt

from symrot import symbols
from symrot.dynamics.structure import Pattern
from symrot.dynamics.torque_kinds import TORQUE_KINDS, Field
from symrot.dynamics.torques import LAWS, Motion, TorqueLaw, field_value, torque_of_potential
from symrot.formula.program import Argument
from symrot.kernels.definition import Box, Definition, Law, boxed, interval, result, scalar
from symrot.kernels.dynamics import OMEGA, OMEGA_BOX, TENSOR, TENSOR_BOX, tensor_argument
from symrot.kernels.quaternion import QUATERNION, QUATERNION_BOX, turned
from symrot.kinematics.quaternion import conjugate, quaternion_to_dcm, unit_relation

__all__ = ["definitions"]

# name of a kernel: kind of torque, and the fields that are inputs; other fields are zero
_KERNELS: dict[str, tuple[str, tuple[str, ...]]] = {
    "torque_constant_body": ("constant_body", ("torque",)),
    "torque_constant_space": ("constant_space", ("torque",)),
    "torque_gravity": ("gravity", ("weight", "center_of_mass", "direction")),
    "torque_gravity_gradient": ("gravity_gradient", ("mean_motion",)),
    "torque_damping_linear": ("damping", ("linear",)),
    "torque_damping_quadratic": ("damping", ("quadratic",)),
    "torque_spring": ("spring", ("stiffness", "attitude")),
    "torque_rotor": ("rotor", ("angular_momentum",)),
}
FREE, ZERO = Pattern.FREE, Pattern.ZERO
_SIZE = {"scalar": 1, "vector": 3, "scalar or vector": 3, "attitude": 4}


class _Turned(Motion):
    """A motion that rotates vectors of space into the body by the quaternion itself, without a rotation matrix."""

    # fewer operations than :class:`Motion`, which computes the whole matrix
    def to_body(self, vector_s: Matrix) -> Matrix:
        named, components = turned(conjugate(self.quaternion), vector_s)
        return components.xreplace(dict(named))


_MOTION = _Turned(Matrix(symbols.omega_b), symbols.quaternion, TENSOR)
_RANGE: dict[str, str | int] = {"mean_motion": "1/100", "weight": 100}  # largest value of a field in the box, else 1


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of torques: the function derives the kernel's arguments and formulas."""
    for name in _KERNELS:
        yield name, partial(_torque, name)


def _field_argument(field: Field) -> Argument:
    size = _SIZE[field.shape]
    first = 0 if size == 4 else 1
    names = [field.name] if size == 1 else [f"{field.name}_{i}" for i in range(first, first + size)]
    components = tuple((name, field.unit, field.meaning) for name in names)
    return Argument(field.name, "in", components, is_scalar=size == 1)


def _field_box(field: Argument) -> Box:
    largest = interval(0, _RANGE.get(field.name, 1))
    return {name: largest if field.is_scalar else (-largest[1], largest[1]) for name, *_ in field.components}


def _law_of(kind: str, fields: tuple[str, ...]) -> TorqueLaw:
    arguments = {}
    for field in TORQUE_KINDS[kind].fields:
        if field.name in fields:
            size = _SIZE[field.shape]
            arguments[field.name] = field_value(field.name, FREE if size == 1 else (FREE,) * size)
        elif kind == "damping":
            arguments[field.name] = field_value(field.name, ZERO if field.name == "quadratic" else (ZERO,) * 3)
    return LAWS[kind](_MOTION, **arguments)


def _torque(name: str) -> Definition:
    kind, fields = _KERNELS[name]
    law = _law_of(kind, fields)
    torque = law.torque - _MOTION.omega_b.cross(law.momentum)  # a rotor's momentum causes a torque on the body
    parameters = tuple(_field_argument(field) for field in TORQUE_KINDS[kind].fields if field.name in fields)
    used = torque.free_symbols | {s for _, value in law.definitions for s in value.free_symbols}
    states = (
        ((symbols.t,), scalar(symbols.t, "time"), boxed((symbols.t,), 0, 1000)),
        (tuple(TENSOR.free_symbols), tensor_argument(), TENSOR_BOX),
        (symbols.omega_b, OMEGA, OMEGA_BOX),
        (symbols.quaternion, QUATERNION, QUATERNION_BOX),
    )
    inputs = [(state, box) for needed, state, box in states if used & set(needed)]
    box = {
        key: value
        for each in (*(box for _, box in inputs), *map(_field_box, parameters))
        for key, value in each.items()
    }
    about = f"torque of the kind {kind!r} ({', '.join(fields)}), body components: {TORQUE_KINDS[kind].meaning}"
    return Definition(
        name, about, (*(state for state, _ in inputs), *parameters),
        (result("torque_b", torque, symbols.torque_b, "torque, body components"),),
        "unit quaternions" if any(state is QUATERNION for state, _ in inputs) else "all finite values",
        "derivations/euler_equations.md", box, partial(_laws, kind, fields, law), law.definitions,
    )  # fmt: skip


def _laws(kind: str, fields: tuple[str, ...], law: TorqueLaw) -> tuple[Law, ...]:
    torque_b, omega = Matrix(symbols.torque_b), _MOTION.omega_b
    unit = (unit_relation(),)
    if kind == "rotor":
        return (Law("the torque is minus omega x h", tuple(torque_b + omega.cross(law.momentum))),
                Law("the torque does no work", (torque_b.dot(omega),)))  # fmt: skip
    if law.potential is not None:
        return (Law("the work of the torque is what the potential loses, for every angular velocity",
                    tuple(torque_b - torque_of_potential(law)), unit),)  # fmt: skip
    if kind == "damping":
        return _damping_laws(torque_b, fields)
    matrix = quaternion_to_dcm() if kind == "constant_space" else eye(3)
    space_torque = field_value("torque", (FREE,) * 3)
    return (
        Law(
            "rotated into the axes of the given torque, the result is the given torque",
            tuple(matrix * torque_b - space_torque),
            unit,
        ),
    )


def _damping_laws(torque_b: Matrix, fields: tuple[str, ...]) -> tuple[Law, ...]:
    omega = _MOTION.omega_b
    if fields == ("linear",):
        drag = field_value("linear", (FREE,) * 3).multiply_elementwise(omega)
        return (Law("each component is minus its coefficient times omega", tuple(torque_b + drag)),)
    power = field_value("quadratic", FREE) * sqrt(omega.dot(omega)) ** 3
    return (
        Law("the torque is along omega", tuple(torque_b.cross(omega))),
        Law(
            "the power of the torque is minus the coefficient times the cube of |omega|", (torque_b.dot(omega) + power,)
        ),
    )
