"""Euler's equations, torques and conserved quantities, each tested against the law that it must obey."""

import pytest
from sympy import Matrix, Rational, diag, eye, zeros
from sympy import symbols as make

from symrot import symbols
from symrot.dynamics.equations import angular_acceleration, equations_of_motion, euler_equations, inverse
from symrot.dynamics.invariants import find_invariants, rate_along
from symrot.dynamics.structure import (
    FieldTorque,
    FormulaTorque,
    InertiaTensor,
    Pattern,
    PrincipalInertia,
    Structure,
)
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.dynamics.torques import LAWS, Motion, field_value, formula, torque_law, torque_of_potential
from symrot.errors import InputError
from symrot.exact import is_zero, normal_form
from symrot.formula.tree import parse
from symrot.kinematics.quaternion import quaternion_rates, quaternion_to_dcm, unit_relation

OMEGA = Matrix(symbols.omega_b)
Q = symbols.quaternion
UNIT = [unit_relation(Q)]
FREE, ZERO = Pattern.FREE, Pattern.ZERO
VECTOR = (FREE,) * 3
TENSOR = Matrix(3, 3, lambda i, j: symbols.moments[i] if i == j else symbols.products[i + j - 1])


def along(expression):
    """Return the time derivative of a function of the attitude."""
    rates = quaternion_rates("body") * OMEGA
    return sum((expression.diff(q) * rate for q, rate in zip(Q, rates, strict=True)), start=0 * expression)


@pytest.mark.parametrize("inertia", [TENSOR, diag(*symbols.principal)], ids=["tensor", "principal"])
def test_euler_equations_are_the_rate_of_angular_momentum_in_space(inertia):
    """d(R I omega)/dt = R tau, with omega' from the equations."""
    tau = Matrix(symbols.torque_b)
    acceleration = angular_acceleration(inertia, OMEGA, tau)
    dcm_sb = Matrix(quaternion_to_dcm(Q))
    momentum_rate = along(dcm_sb) * inertia * OMEGA + dcm_sb * inertia * acceleration
    assert is_zero(momentum_rate - dcm_sb * tau, UNIT)


def test_a_rotor_carries_its_angular_momentum_along():
    h = Matrix(make("h1:4", real=True))
    inertia = diag(*symbols.principal)
    acceleration = angular_acceleration(inertia, OMEGA, zeros(3, 1), h)
    dcm_sb = Matrix(quaternion_to_dcm(Q))
    assert is_zero(along(dcm_sb) * (inertia * OMEGA + h) + dcm_sb * inertia * acceleration, UNIT)


def test_the_inverse_of_a_tensor():
    assert normal_form(inverse(TENSOR) * TENSOR - eye(3)) == zeros(3, 3)


def general(kind):
    """Return a torque of a kind in which every constant is a symbol."""
    shapes = {"scalar": FREE, "vector": VECTOR, "scalar or vector": VECTOR, "attitude": (FREE,) * 4}
    fields = [(f.name, shapes[f.shape]) for f in TORQUE_KINDS[kind].fields if f.shape in shapes and f.name != "gravity"]
    return FieldTorque(kind, "", tuple(fields))


def torque(kind, **fields):
    return FieldTorque(kind, "", tuple(fields.items()))


MOTION = Motion(OMEGA, Q, TENSOR)
DAMPING = torque("damping", linear=VECTOR, quadratic=ZERO)
WITH_POTENTIAL = ["gravity", "gravity_gradient", "spring"]


@pytest.mark.parametrize("kind", WITH_POTENTIAL)
def test_torques_are_minus_the_gradient_of_their_potential(kind):
    law = torque_law(general(kind), MOTION)
    torque = law.torque.subs(dict(law.definitions))
    assert is_zero(torque_of_potential(law) - torque, UNIT)


def test_a_wrong_torque_is_not_the_gradient():
    law = torque_law(general("spring"), MOTION)
    assert not is_zero(torque_of_potential(law) - law.torque / 2, UNIT)


def test_damping_only_takes_energy():
    """tau . omega is minus the sum of squares with the damping coefficients."""
    law = torque_law(DAMPING, MOTION)
    linear = field_value("linear", VECTOR)
    assert is_zero(law.torque.dot(OMEGA) + sum(c * w**2 for c, w in zip(linear, OMEGA, strict=True)))


def test_gravity_gradient_vanishes_for_a_sphere_and_about_a_symmetry_axis():
    structure = general("gravity_gradient")
    a, _, c = symbols.principal
    assert torque_law(structure, Motion(OMEGA, Q, a * eye(3))).torque == zeros(3, 1)
    assert torque_law(structure, Motion(OMEGA, Q, diag(a, a, c))).torque[2] == 0


def test_an_expression_in_space_is_turned_into_the_body():
    structure = FormulaTorque("", ("k*t", "0", "0"), ("k",), "space")
    k = symbols.constant("k")
    expected = Matrix(quaternion_to_dcm(Q)).T * Matrix([k * symbols.t, 0, 0])
    assert torque_law(structure, MOTION).torque == expected
    assert formula(parse("2*cos(pi*t)**2 - 1/3"), {"t": symbols.t}).subs(symbols.t, 0) == Rational(5, 3)


def test_every_kind_has_a_law():
    assert set(LAWS) == set(TORQUE_KINDS)


# --- invariants -------------------------------------------------------------------------------------------------------

PRINCIPAL = PrincipalInertia()
SYMMETRIC = PrincipalInertia("AAC")
GRAVITY = torque("gravity", weight=FREE, center_of_mass=(ZERO, ZERO, FREE), direction=(ZERO, ZERO, Pattern.MINUS_ONE))
TILTED = torque("gravity", weight=FREE, center_of_mass=VECTOR, direction=VECTOR)
ORBIT = torque("gravity_gradient", mean_motion=FREE)
AXIAL_DAMPING = torque("damping", linear=(FREE, FREE, ZERO), quadratic=ZERO)
PUSH = torque("constant_space", torque=(ZERO, ZERO, FREE))
ROTOR = torque("rotor", angular_momentum=VECTOR)
ALL_L = {f"angular momentum {axis}" for axis in "xyz"}


def structure_of(inertia, *torques, **others):
    return Structure(inertia, torques, **others)


@pytest.mark.parametrize(
    ("structure", "kept"),
    [
        (structure_of(PRINCIPAL), {"energy", *ALL_L}),
        (structure_of(PRINCIPAL, attitude=False), {"energy", "angular momentum"}),
        (structure_of(SYMMETRIC), {"energy", *ALL_L, "spin omega_3"}),
        (structure_of(InertiaTensor(("I_xx", "I_xy", "I_yy", "I_zz"))), {"energy", *ALL_L}),
        (structure_of(SYMMETRIC, GRAVITY), {"energy", "angular momentum z", "spin omega_3"}),
        (structure_of(PRINCIPAL, GRAVITY), {"energy", "angular momentum z"}),
        (structure_of(PRINCIPAL, TILTED), {"energy", "vertical angular momentum"}),
        (structure_of(PRINCIPAL, ORBIT), {"Jacobi integral"}),
        (structure_of(PRINCIPAL, ROTOR), {"energy", *ALL_L}),
        (structure_of(PRINCIPAL, PUSH), {"angular momentum x", "angular momentum y"}),
        (structure_of(SYMMETRIC, AXIAL_DAMPING), {"spin omega_3"}),
        (structure_of(PRINCIPAL, DAMPING), set()),
        (structure_of(PRINCIPAL, GRAVITY, DAMPING), set()),
    ],
    ids=lambda value: ", ".join(sorted(value)) if isinstance(value, set) else "",
)  # fmt: skip
def test_what_is_kept_is_found_and_what_is_not_is_not(structure, kept):
    found = find_invariants(equations_of_motion(structure), structure)
    assert {item.name for item in found if item.holds} == kept
    assert all(item.reason for item in found)


def test_the_rate_of_a_quantity_that_is_not_kept_is_not_zero():
    equations = equations_of_motion(structure_of(PRINCIPAL, GRAVITY))
    assert not is_zero(rate_along(equations.kinetic_energy, equations), equations.relations)


def test_planar_motion_is_the_full_motion():
    """A solution of the reduced equations of a physical pendulum satisfies the full equations."""
    level = structure_of(SYMMETRIC, GRAVITY, planar=0, initial_quaternion=(FREE, FREE, ZERO, ZERO))
    reduced, full = equations_of_motion(level), equations_of_motion(structure_of(SYMMETRIC, GRAVITY))
    put_in = dict(zip(Q, reduced.motion.quaternion, strict=True)) | dict(
        zip(OMEGA, reduced.motion.omega_b, strict=True)
    )
    moving = [*OMEGA, *Q]
    for state, rate in zip(full.states, full.explicit_rates, strict=True):
        value = put_in[state]
        change = sum(value.diff(s) * r for s, r in zip(reduced.states, reduced.explicit_rates, strict=True))
        assert is_zero(change - rate.subs(put_in), reduced.relations)
    assert set(full.states) == set(moving)


@pytest.mark.parametrize(
    ("inertia", "torque"),
    [
        ([1, 2], None), (Matrix([[1, 2, 0], [0, 1, 0], [0, 0, 1]]), None), ([1, 2, 3], [0, 1]),
        ([1, 1, 0], None), (Matrix([[1, 1, 0], [1, 1, 0], [0, 0, 1]]), None),
    ],
)  # fmt: skip
def test_inertias_of_wrong_shape_or_without_inverse_and_torques_of_wrong_shape_are_refused(inertia, torque):
    with pytest.raises(InputError):
        euler_equations(inertia, torque)


def test_euler_equations_for_principal_axes():
    a, b, c = symbols.principal
    w1, w2, w3 = OMEGA
    assert is_zero(
        euler_equations(torque=None) - Matrix([(b - c) * w2 * w3 / a, (c - a) * w3 * w1 / b, (a - b) * w1 * w2 / c])
    )
    assert euler_equations([a, a, a], None) == zeros(3, 1)
