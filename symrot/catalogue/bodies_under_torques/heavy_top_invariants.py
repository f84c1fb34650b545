"""Conserved quantities of a heavy top (Landau & Lifshitz, Mechanics, 3rd ed., section 35, problem 1)."""

from sympy import Matrix, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

DOWN = Matrix(symbols.vertical)
ARM = Matrix(symbols.center_of_mass)


def derive() -> Derivation:
    d = Derivation(
        "heavy_top_invariants",
        title="Conserved quantities of a heavy top",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 35, problem 1",
        about=(
            "A body of any shape rotates about a fixed point under its weight. The energy and the vertical component "
            "of the angular momentum are constant for every body. The spin is also constant if the body is symmetric "
            "and its centre of mass lies on the axis. With these three invariants, the motion of the symmetric top "
            "can be solved."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    d.passage(r"Let $\gamma$ be the direction of gravity in body components, and $c$ the vector from the fixed point "
        "to the centre of mass:",
            (r"\gamma", r"R^{\mathsf T} \gamma_s"), (r"\tau_b", r"W\, c \times \gamma"))  # fmt: skip
    fixed = Matrix(symbols.normal)
    dcm_sb = Matrix(quaternion_to_dcm())
    d.notation(
        {"R": dcm_sb, r"\gamma_s": fixed, r"\gamma": dcm_sb.T * fixed, r"\omega": OMEGA, "I": TENSOR, "c": ARM},
        attitude_rates(),
    )
    d.step(
        "In body axes, the direction of gravity rotates backwards (Poisson's equation).",
        rate(dcm_sb.T * fixed, attitude_rates()),
        (dcm_sb.T * fixed).cross(OMEGA),
        because=r"the direction is fixed in space, and $\dot R = R\,[\omega_b]_\times$",
        relations=[unit_relation()],
        named=r"\dot\gamma",
        board=(
            (r"The direction $\gamma_s$ is constant in space:", r"\dot R^{\mathsf T} \gamma_s"),
            (
                r"$\dot R = R\,[\omega]_\times$, and a skew matrix changes its sign if it is transposed:",
                r"-\omega \times R^{\mathsf T} \gamma_s",
            ),
            ("The factors are exchanged, which changes the sign:", r"\gamma \times \omega"),
        ),
        display=r"\gamma \times \omega",
    )
    weight = symbols.W * ARM.cross(DOWN)
    falling = pairs(symbols.vertical, DOWN.cross(OMEGA))
    motion = pairs(symbols.omega_b, angular_acceleration(TENSOR, OMEGA, weight)) | falling
    d.section("Every body")
    d.notation({r"\gamma": DOWN, "W": symbols.W}, motion)
    energy = OMEGA.dot(TENSOR * OMEGA) / 2 - symbols.W * ARM.dot(DOWN)
    d.step(
        "The energy is constant.",
        rate(energy, motion),
        0,
        because="the power of the weight is minus the rate of potential energy",
        named=r"\frac{d}{dt} \left( \tfrac12\,\omega \cdot I\,\omega - W\, c \cdot \gamma \right)",
        board=(
            (
                "The tensor is symmetric and the vectors are constant in the body:",
                r"\omega \cdot I\,\dot\omega - W\,c \cdot \dot\gamma",
            ),
            (
                r"Euler's equations with the torque $W\,c \times \gamma$, and Poisson's equation $\dot\gamma = "
                r"\gamma \times \omega$:",
                r"\omega \cdot \left( W\,c \times \gamma - \omega \times I\,\omega \right) - W\,c \cdot (\gamma "
                r"\times \omega)",
            ),
            ("The two triple products are equal, and a cross product is perpendicular to its factors:", "0"),
        ),
    )
    d.step(
        "The vertical component of the angular momentum is constant.",
        rate((TENSOR * OMEGA).dot(DOWN), motion),
        0,
        because="the weight has no moment about the vertical",
        named=r"\frac{d}{dt} \left( I\,\omega \cdot \gamma \right)",
        board=(
            ("The product rule:", r"I\,\dot\omega \cdot \gamma + I\,\omega \cdot \dot\gamma"),
            (
                r"Euler's equations and $\dot\gamma = \gamma \times \omega$:",
                r"\left( W\,c \times \gamma - \omega \times I\,\omega \right) \cdot \gamma + I\,\omega \cdot (\gamma "
                r"\times \omega)",
            ),
            (r"$c \times \gamma$ is perpendicular to $\gamma$, and the two other triple products cancel:", "0"),
        ),
    )
    d.step(
        "The direction of gravity remains a unit vector.",
        rate(squared(DOWN), motion),
        0,
        because="the rate of a unit vector is perpendicular to it",
        named=r"\frac{d}{dt}\,|\gamma|^2",
        board=(
            ("The product rule:", r"2\,\gamma \cdot \dot\gamma"),
            (r"$\dot\gamma = \gamma \times \omega$:", r"2\,\gamma \cdot (\gamma \times \omega)"),
            ("A cross product is perpendicular to its factors:", "0"),
        ),
    )
    d.section("The symmetric top")
    inertia, arm = diag(symbols.A, symbols.A, symbols.C), Matrix([0, 0, symbols.c_3])
    acceleration = angular_acceleration(inertia, OMEGA, symbols.W * arm.cross(DOWN))
    d.step(
        "The spin is constant if two moments are equal and the centre of mass is on axis 3.",
        acceleration[2],
        0,
        because="neither the gyroscopic term nor the weight has a moment about the axis",
        named=r"\dot\omega_3",
    )
    top = pairs(symbols.omega_b, acceleration) | falling
    momentum = inertia * OMEGA
    height = DOWN[2]
    left = symbols.A * rate(height, top) ** 2
    kinetic = 2 * symbols.W * symbols.c_3 * height + symbols.A * (symbols.omega_1**2 + symbols.omega_2**2)
    right = (kinetic - 2 * symbols.W * symbols.c_3 * height) * (1 - height**2) - (
        momentum.dot(DOWN) - symbols.C * symbols.omega_3 * height
    ) ** 2 / symbols.A
    d.step(
        r"The square of the rate of $u = \gamma_3$ is a cubic polynomial in $u$. So the nutation is an elliptic "
        "function of time.",
        left,
        right,
        because="energy and the two conserved angular momenta determine the transverse angular velocity",
        relations=[squared(DOWN) - 1],
        named=r"A\,\dot u^2",
        display=r"\left( 2 E - C \omega_3^2 + 2 W c_3\, u \right) \left( 1 - u^2 \right)"
        r" - \frac{\left( L_\gamma - C \omega_3\, u \right)^2}{A}",
    )
    d.passage(
        r"The definition of the energy gives $2 E - C \omega_3^2 + 2 W c_3\, u = A (\omega_1^2 + \omega_2^2)$. "
        r"$L_\gamma$ is the component of the angular momentum along $\gamma$."
    )
    return d
