"""Euler's equations for the full tensor (Landau & Lifshitz, Mechanics, 3rd ed., section 36)."""

from sympy import Matrix, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

DOMEGA = Matrix(symbols.omega_rates)
TORQUE = Matrix(symbols.torque_b)


def derive() -> Derivation:
    d = Derivation(
        "euler_equations",
        title="Euler's equations",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 36",
        about=(
            r"In space, the torque is the rate of the angular momentum: $\dot L_s = \tau_s$. In axes that rotate with "
            "the body the inertia tensor is constant; instead, the rotation of the axes adds a gyroscopic term."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    unit = [unit_relation()]
    dcm_sb = Matrix(quaternion_to_dcm())
    d.passage(
        "Angular momentum, torque and inertia tensor refer to one point: the centre of mass, or a point of the body "
        "that is fixed in space:",
        ("I", TENSOR),
        (r"L_s", r"R\,I\,\omega_b"),
    )
    momentum_b = TENSOR * OMEGA
    motion = attitude_rates() | pairs(symbols.omega_b, DOMEGA)
    d.notation(
        {"R": dcm_sb, r"\omega_b": OMEGA, r"\dot\omega_b": DOMEGA, "L_s": dcm_sb * momentum_b, r"\tau_b": TORQUE},
        motion,
    )
    moving = TENSOR * DOMEGA + OMEGA.cross(momentum_b)
    d.step(
        "The rate of the angular momentum in space, expressed in body components, has two terms.",
        dcm_sb.T * rate(dcm_sb * momentum_b, motion),
        moving,
        because=r"the axes of the body rotate with $\dot R = R\,[\omega_b]_\times$",
        relations=unit,
        named=r"R^{\mathsf T} \dot L_s",
        board=(
            (
                r"The product rule, with $L_s = R\,I\,\omega_b$ and a constant tensor:",
                r"R^{\mathsf T} \left( R\,\left( \omega_b \times I\,\omega_b \right) + R\,I\,\dot\omega_b \right)",
            ),
            (r"$R^{\mathsf T} R = 1$:", r"\omega_b \times I\,\omega_b + I\,\dot\omega_b"),
        ),
        display=r"I\,\dot\omega_b + \omega_b \times I\,\omega_b",
    )
    acceleration = angular_acceleration(TENSOR, OMEGA, TORQUE)
    d.step(
        "The rate of the angular momentum equals the torque if the angular acceleration follows Euler's equations, "
        "here for the full inertia tensor.",
        moving.subs(pairs(symbols.omega_rates, acceleration)),
        TORQUE,
        because=r"$\tau_b = R^{\mathsf T} \tau_s$, and the inertia tensor has an inverse",
        board=(
            (
                "The angular acceleration is inserted into the left side; the inertia tensor and its inverse cancel:",
                r"\left( \tau_b - \omega_b \times I\,\omega_b \right) + \omega_b \times I\,\omega_b",
            ),
            ("The gyroscopic terms cancel:", r"\tau_b"),
        ),
        named=r"\dot\omega_b = I^{-1} \left( \tau_b - \omega_b \times I\,\omega_b \right)"
        r"\quad\Rightarrow\quad I\,\dot\omega_b + \omega_b \times I\,\omega_b",
        display=r"\tau_b",
    )
    d.section("Special axes and bodies")
    principal = angular_acceleration(diag(*symbols.principal), OMEGA, TORQUE)
    d.notation({r"\dot\omega_b": principal, r"\dot\omega_3": principal[2]})
    a, b, c = symbols.principal
    w1, w2, w3 = OMEGA
    first, second, third = TORQUE
    d.step(
        "Along principal axes, with moments $A, B, C$, the products of inertia vanish.",
        principal,
        Matrix([((b - c) * w2 * w3 + first) / a, ((c - a) * w3 * w1 + second) / b, ((a - b) * w1 * w2 + third) / c]),
        because="the inertia tensor is diagonal",
        named=r"\dot\omega_b",
    )
    d.step(
        "With two equal moments, one gyroscopic term vanishes.",
        principal[2],
        third / c,
        because="the factor $A - B$ is zero",
        relations=[a - b],
        named=r"\dot\omega_3",
    )
    d.step(
        "With three equal moments, all gyroscopic terms vanish.",
        principal,
        TORQUE / a,
        because="the factors $B - C$, $C - A$ and $A - B$ are zero",
        relations=[a - b, b - c],
        named=r"\dot\omega_b",
    )
    d.section("Power")
    d.notation({"I": TENSOR, r"\dot\omega_b": acceleration}, pairs(symbols.omega_b, acceleration))
    d.step(
        "The gyroscopic term does no work: only the torque changes the kinetic energy.",
        rate(OMEGA.dot(momentum_b) / 2, pairs(symbols.omega_b, acceleration)),
        OMEGA.dot(TORQUE),
        because=r"$\omega \cdot (\omega \times I\,\omega) = 0$, and the tensor is symmetric",
        named=r"\frac{d}{dt}\,\tfrac12\,\omega_b \cdot I\,\omega_b",
        board=(
            (
                "The tensor is symmetric, so the two terms of the product rule are equal:",
                r"\omega_b \cdot I\,\dot\omega_b",
            ),
            ("Euler's equations:", r"\omega_b \cdot \left( \tau_b - \omega_b \times I\,\omega_b \right)"),
            ("A cross product is perpendicular to its factors:", r"\omega_b \cdot \tau_b"),
        ),
    )
    return d
