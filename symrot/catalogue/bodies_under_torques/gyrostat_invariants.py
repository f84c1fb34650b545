"""Conserved quantities of a gyrostat, a body with a rotor inside (Hughes, Spacecraft Attitude Dynamics, chapter 6)."""

from sympy import Matrix

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

ROTOR, TORQUE = Matrix(symbols.rotor), Matrix(symbols.torque_b)


def derive() -> Derivation:
    d = Derivation(
        "gyrostat_invariants",
        title="A body with a rotor: the gyrostat",
        source="Hughes, *Spacecraft Attitude Dynamics*, chapter 6",
        about=(
            "A rotor inside the body has an additional angular momentum $h$, which is constant in the body. $I$ is "
            "the inertia tensor of the body including the rotor at rest. A motor keeps the speed of the rotor relative "
            r"to the body constant. Its work changes only the part $h \cdot \omega_b$ of the kinetic energy."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    momentum_b = TENSOR * OMEGA + ROTOR
    dcm_sb = Matrix(quaternion_to_dcm())
    domega = Matrix(symbols.omega_rates)
    d.notation({"I": TENSOR, "h": ROTOR, r"\omega_b": OMEGA, r"\dot\omega_b": domega, "R": dcm_sb, r"\tau_b": TORQUE})
    d.passage("The total angular momentum is", (r"L_b", r"I\,\omega_b + h"))
    d.step(
        "The rate of the total angular momentum in space, expressed in body components, contains $h$ in the "
        "gyroscopic term.",
        dcm_sb.T * rate(dcm_sb * momentum_b, attitude_rates() | pairs(symbols.omega_b, domega)),
        TENSOR * domega + OMEGA.cross(momentum_b),
        because="$h$ rotates with the body",
        relations=[unit_relation()],
        named=r"R^{\mathsf T} \dot L_s",
        display=r"I\,\dot\omega_b + \omega_b \times (I\,\omega_b + h)",
        board=(
            (
                r"The product rule, with $\dot R = R\,[\omega_b]_\times$ and constant $I$ and $h$:",
                r"R^{\mathsf T} \left( R \left( \omega_b \times (I\,\omega_b + h) \right) + R\,I\,\dot\omega_b \right)",
            ),
            (r"$R^{\mathsf T} R = 1$:", r"\omega_b \times (I\,\omega_b + h) + I\,\dot\omega_b"),
        ),
    )
    acceleration = angular_acceleration(TENSOR, OMEGA, TORQUE, ROTOR)
    d.step(
        "The rate of the total angular momentum equals the torque if the angular acceleration has the following form.",
        TENSOR * acceleration + OMEGA.cross(momentum_b),
        TORQUE,
        because="the inertia tensor has an inverse",
        board=(
            (
                "The angular acceleration is inserted; the inertia tensor and its inverse cancel:",
                r"\left( \tau_b - \omega_b \times (I\,\omega_b + h) \right) + \omega_b \times (I\,\omega_b + h)",
            ),
            ("The gyroscopic terms cancel:", r"\tau_b"),
        ),
        named=r"\dot\omega_b = I^{-1} \left( \tau_b - \omega_b \times (I\,\omega_b + h) \right)"
        r"\quad\Rightarrow\quad I\,\dot\omega_b + \omega_b \times (I\,\omega_b + h)",
        display=r"\tau_b",
    )
    d.section("Without torque")
    free = attitude_rates() | pairs(symbols.omega_b, angular_acceleration(TENSOR, OMEGA, 0 * OMEGA, ROTOR))
    d.notation({r"\dot\omega_b": angular_acceleration(TENSOR, OMEGA, 0 * OMEGA, ROTOR)})
    d.step(
        "The total angular momentum in space is constant.",
        rate(dcm_sb * momentum_b, free),
        0,
        because="there is no torque",
        relations=[unit_relation()],
        named=r"\frac{d}{dt}\,R\,(I\,\omega_b + h)",
        board=(
            (
                r"The product rule, with $\dot R = R\,[\omega_b]_\times$ and constant $I$ and $h$:",
                r"R \left( \omega_b \times (I\,\omega_b + h) \right) + R\,I\,\dot\omega_b",
            ),
            (r"Without torque $I\,\dot\omega_b = -\omega_b \times (I\,\omega_b + h)$, so the two terms cancel:", "0"),
        ),
    )
    d.step(
        "The length of the total angular momentum is constant.",
        rate(squared(momentum_b), free),
        0,
        because="a rotation preserves lengths",
        named=r"\frac{d}{dt}\,|I\,\omega_b + h|^2",
    )
    d.step(
        "The kinetic energy without the relative motion of the rotor is constant.",
        rate(OMEGA.dot(TENSOR * OMEGA) / 2, free),
        0,
        because=r"$\omega \times h$ does no work on the body",
        named=r"\frac{d}{dt}\,\tfrac12\,\omega_b \cdot I\,\omega_b",
    )
    return d
