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
            r"With equal moments about axes 1 and 2 the angular velocity $\omega_3$ about the symmetry axis changes "
            "only by a torque about that axis. Many torques have none, whatever the attitude: each is looked at."
        ),
    )
    inertia = diag(symbols.A, symbols.A, symbols.C)
    d.define("Two moments are equal, axis 3 is the axis of symmetry:", "I", inertia)

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
                "Euler's equation on axis 3 for three moments $A, B, C$; here $B = A$:",
                angular_acceleration(diag(*symbols.principal), OMEGA, Matrix(symbols.torque_b))[2],
                ((symbols.A - symbols.B) * symbols.omega_1 * symbols.omega_2 + symbols.tau_3) / symbols.C,
            )
        ],
    )
    d.section("Torques without a moment about the axis")
    down, radius = Matrix(symbols.vertical), Matrix(symbols.radius)
    laws = {
        "Without torque.": (0 * OMEGA, None, "there is none"),
        "Gravity on a centre of mass that lies on the axis.": (
            symbols.W * Matrix([0, 0, symbols.c_3]).cross(down),
            None,
            "the moment of the weight is at right angles to the arm, for every vertical $\\gamma$",
        ),
        "The gravity gradient.": (
            3 * symbols.n**2 * radius.cross(inertia * radius),
            None,
            "equal moments cancel in it as in the gyroscopic term, for every radius $r$",
        ),
        "A rotor along the axis.": (
            0 * OMEGA,
            Matrix([0, 0, symbols.h_3]),
            r"$\omega \times h$ is at right angles to $h$",
        ),
        "A torque constant in the body, across the axis.": (
            Matrix([symbols.tau_1, symbols.tau_2, 0]),
            None,
            "it has no component along it",
        ),
    }
    for claim, (torque, momentum, reason) in laws.items():
        d.step(claim, spin(torque, momentum), 0, because=reason, named=r"\dot\omega_3")
    return d
