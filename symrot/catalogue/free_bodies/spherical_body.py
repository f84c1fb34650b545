"""The spherical body, whose three principal moments are equal: its angular velocity is constant."""

from sympy import Matrix, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation


def derive() -> Derivation:
    d = Derivation(
        "spherical_body",
        title="A spherical body",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 32",
        about=(
            "A body with three equal moments is called spherical. A cube is one example: its inertia tensor has "
            "the form of a ball's tensor. Angular momentum and angular velocity are parallel for every axis of "
            "rotation, and without a torque the body rotates steadily about a fixed axis."
        ),
    )
    inertia = diag(symbols.A, symbols.A, symbols.A)
    dcm_sb = Matrix(quaternion_to_dcm())
    free = angular_acceleration(inertia, OMEGA, 0 * OMEGA)
    d.step(
        "The inertia tensor is the same in all axes.",
        dcm_sb * inertia * dcm_sb.T,
        inertia,
        because="the inertia tensor is a multiple of the unit matrix",
        relations=[unit_relation()],
        named=r"R\,I\,R^{\mathsf T}",
    )
    d.step(
        "Without a torque the angular velocity in the body is constant.",
        free,
        0,
        because="angular velocity and angular momentum are parallel",
        named=r"\dot\omega_b",
    )
    motion = attitude_rates() | pairs(symbols.omega_b, free)
    d.step(
        "The angular velocity in space is constant too.",
        rate(dcm_sb * OMEGA, motion),
        0,
        because=r"$\omega \times \omega = 0$",
        relations=[unit_relation()],
        named=r"\dot\omega_s",
    )
    d.step(
        "Under a torque the angular acceleration is the torque divided by the moment, like the acceleration of a "
        "point mass under a force.",
        angular_acceleration(inertia, OMEGA, Matrix(symbols.torque_b)),
        Matrix(symbols.torque_b) / symbols.A,
        because="the gyroscopic term is zero",
        named=r"\dot\omega_b",
    )
    return d
