"""Conditions under which the angular velocity can be computed without the attitude."""

from sympy import Matrix, diag, sqrt

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.proof.derivation import Derivation

Q = symbols.quaternion


def derive() -> Derivation:
    d = Derivation(
        "attitude_not_needed",
        title="When the attitude is not needed",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 36",
        about=(
            r"If the torque does not depend on the attitude, Euler's equations contain only $\omega_b$. Then the "
            "angular velocity can be computed without the four equations of the quaternion; these are integrated "
            "only if the attitude is an output."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    rotor, linear = Matrix(symbols.rotor), diag(*symbols.damping)
    laws = {
        "without torque": (0 * OMEGA, None, "the torque is zero"),
        "with a torque that is constant in the body": (
            Matrix(symbols.torque_b),
            None,
            "its components in body axes are constants",
        ),
        "with linear damping": (-linear * OMEGA, None, r"it is a function of $\omega_b$"),
        "with quadratic damping": (-sqrt(squared(OMEGA)) * OMEGA, None, r"it is a function of $\omega_b$"),
        "with an internal rotor": (0 * OMEGA, rotor, "its angular momentum is constant in the body"),
    }
    for what, (torque, momentum, reason) in laws.items():
        acceleration = angular_acceleration(TENSOR, OMEGA, torque, momentum)
        d.step(
            f"The angular acceleration {what} does not depend on the attitude.",
            acceleration.jacobian(Q),
            0,
            because=reason,
            named=r"\frac{\partial \dot\omega_b}{\partial q}",
        )
    d.section("When the attitude is needed")
    force = Matrix(symbols.torque_b)
    torque = quaternion_to_dcm().T * force
    d.passage(
        "The body components of a torque depend on the attitude if the torque is constant in space or depends on a "
        "direction that is fixed in space:",
        (r"\tau_b", r"R(q)^{\mathsf T} \tau_s"),
    )
    d.step(
        "If a torque is constant in space, its body components depend on the attitude: at $q = 1$ their derivative "
        "with respect to $q_1$ has twice the length of the part of the torque that is perpendicular to axis 1.",
        squared(torque.jacobian([Q[1]]).subs(dict(zip(Q, (1, 0, 0, 0), strict=True)))),
        4 * (force[1] ** 2 + force[2] ** 2),
        because="a small rotation about axis 1 changes every vector that is not along axis 1",
        named=r"\left| \frac{\partial \tau_b}{\partial q_1} \right|^2_{q = 1}",
        display=r"4 \left( \tau_{s,2}^2 + \tau_{s,3}^2 \right)",
    )
    return d
