"""The spin of a free symmetric body, its rate of rotation about its own axis.

Landau & Lifshitz, Mechanics, 3rd ed., section 36.
"""

from sympy import Matrix, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA
from symrot.dynamics.equations import angular_acceleration
from symrot.proof.derivation import Derivation


def derive() -> Derivation:
    d = Derivation(
        "symmetric_spin",
        title="The spin of a symmetric body is constant",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 36",
        about=(
            r"With equal moments about axes 1 and 2, the angular velocity $\omega_3$ about the symmetry axis (the "
            "spin) changes only under a torque about this axis. This page lists torques that have no component about "
            "the axis at any attitude."
        ),
    )
    inertia = diag(symbols.A, symbols.A, symbols.C)
    d.define("Two moments are equal, and axis 3 is the symmetry axis:", "I", inertia)

    def spin(torque: Matrix, momentum: Matrix | None = None) -> object:
        return angular_acceleration(inertia, OMEGA, torque, momentum)[2]

    d.step(
        "Only the torque about the axis changes the spin.",
        spin(Matrix(symbols.torque_b)),
        symbols.tau_3 / symbols.C,
        because="equal moments about axes 1 and 2 cancel the gyroscopic torque on axis 3",
        named=r"\dot\omega_3",
        via=[
            (
                "Euler's equation for axis 3 with three moments $A, B, C$, of which $A = B$ here:",
                angular_acceleration(diag(*symbols.principal), OMEGA, Matrix(symbols.torque_b))[2],
                ((symbols.A - symbols.B) * symbols.omega_1 * symbols.omega_2 + symbols.tau_3) / symbols.C,
            )
        ],
    )
    d.section("Torques without a component about the axis")
    down, radius = Matrix(symbols.vertical), Matrix(symbols.radius)
    laws = {
        "Without a torque the spin is constant.": (0 * OMEGA, None, "the torque is zero"),
        "The weight does not change the spin if the centre of mass is on the axis.": (
            symbols.W * Matrix([0, 0, symbols.c_3]).cross(down),
            None,
            r"the moment of the weight is perpendicular to its arm, for every vertical direction $\gamma$",
        ),
        "The torque of the gravity gradient does not change the spin.": (
            3 * symbols.n**2 * radius.cross(inertia * radius),
            None,
            "equal moments cancel as in the gyroscopic term, for every orbital radius $r$",
        ),
        "A rotor along the axis does not change the spin.": (
            0 * OMEGA,
            Matrix([0, 0, symbols.h_3]),
            r"$\omega \times h$ is perpendicular to $h$",
        ),
        "A torque that is constant in the body and perpendicular to the axis does not change the spin.": (
            Matrix([symbols.tau_1, symbols.tau_2, 0]),
            None,
            "the torque has no component along the axis",
        ),
    }
    for claim, (torque, momentum, reason) in laws.items():
        d.step(claim, spin(torque, momentum), 0, because=reason, named=r"\dot\omega_3")
    return d
