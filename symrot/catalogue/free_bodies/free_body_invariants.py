"""Conserved quantities of a free body (Landau & Lifshitz, Mechanics, 3rd ed., section 37)."""

from sympy import Matrix, Rational, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

NONE = 0 * OMEGA


def derive() -> Derivation:
    d = Derivation(
        "free_body_invariants",
        title="Conserved quantities of a free body",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 37",
        about=(
            "Without a torque, the kinetic energy of a body is constant, and so is its angular momentum in space. In "
            "body axes, the angular velocity therefore moves along the intersection of two ellipsoids, the polhode."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    acceleration = angular_acceleration(TENSOR, OMEGA, NONE)
    motion = attitude_rates() | pairs(symbols.omega_b, acceleration)
    momentum_b = TENSOR * OMEGA
    d.notation(
        {"I": TENSOR, r"\omega_b": OMEGA, r"\dot\omega_b": acceleration, "R": Matrix(quaternion_to_dcm())}, motion
    )
    d.passage(
        "Euler's equations without a torque, for the full inertia tensor, are",
        (r"I\,\dot\omega_b", r"-\,\omega_b \times I\,\omega_b"),
    )
    d.step(
        "The kinetic energy is constant.",
        rate(OMEGA.dot(momentum_b) / 2, motion),
        0,
        because=r"the gyroscopic torque is perpendicular to $\omega$",
        named=r"\frac{d}{dt}\,\tfrac12\,\omega_b \cdot I\,\omega_b",
        board=(
            (
                "The tensor is symmetric, so the two terms of the product rule are equal:",
                r"\omega_b \cdot I\,\dot\omega_b",
            ),
            ("Euler's equations:", r"-\omega_b \cdot \left( \omega_b \times I\,\omega_b \right)"),
            (r"A cross product is perpendicular to its factors:", "0"),
        ),
    )
    d.step(
        "All three components of the angular momentum in space are constant.",
        rate(Matrix(quaternion_to_dcm()) * momentum_b, motion),
        0,
        because="there is no torque, and Euler's equations state this in rotating axes",
        relations=[unit_relation()],
        named=r"\frac{d}{dt}\,R\,I\,\omega_b",
        board=(
            (
                r"The product rule, with $\dot R = R\,[\omega_b]_\times$:",
                r"R \left( \omega_b \times I\,\omega_b \right) + R\,I\,\dot\omega_b",
            ),
            ("Euler's equations say that the two terms cancel:", "0"),
        ),
    )
    d.step(
        "The length of the angular momentum is constant; it does not depend on the attitude.",
        rate(squared(momentum_b), motion),
        0,
        because="a rotation preserves lengths",
        named=r"\frac{d}{dt}\,|I\,\omega_b|^2",
        board=(
            ("The product rule:", r"2\,I\,\omega_b \cdot I\,\dot\omega_b"),
            (
                "Euler's equations:",
                r"-2\,I\,\omega_b \cdot \left( \omega_b \times I\,\omega_b \right)",
            ),
            ("A cross product is perpendicular to its factors:", "0"),
        ),
    )
    d.section("The polhode")
    a, b, c = symbols.principal
    inertia = diag(a, b, c)
    along = pairs(symbols.omega_b, angular_acceleration(inertia, OMEGA, NONE))
    doubled = OMEGA.dot(inertia * OMEGA)
    d.step(
        r"Along principal axes, a combination of the energy and the angular momentum does not contain $\omega_3$. It "
        "describes an ellipse or a hyperbola.",
        squared(inertia * OMEGA) - c * doubled,
        a * (a - c) * symbols.omega_1**2 + b * (b - c) * symbols.omega_2**2,
        because="both invariants are quadratic, and the terms along axis 3 cancel",
        named=r"|L|^2 - 2 C E",
    )
    d.step(
        "This combination is constant too.",
        rate(squared(inertia * OMEGA) - c * doubled, along),
        0,
        because="both terms of the sum are constant",
        named=r"\frac{d}{dt} \left( |L|^2 - 2 C E \right)",
    )
    d.section("The herpolhode")
    d.step(
        "The component of the angular velocity along the angular momentum is constant, so the tip of the angular "
        "velocity moves in a plane that is fixed in space (the invariable plane).",
        OMEGA.dot(momentum_b) - 2 * (Rational(1, 2) * OMEGA.dot(TENSOR * OMEGA)),
        0,
        because=r"$\omega \cdot L$ is twice the kinetic energy, and $|L|$ is conserved",
        named=r"\omega \cdot L - 2 E",
    )
    return d
