"""Torque-free symmetric top (Landau & Lifshitz, Mechanics, 3rd ed., sections 33 and 36)."""

from sympy import Matrix, cos, diag

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.proof.derivation import Derivation

AXIS = Matrix([0, 0, 1])


def derive() -> Derivation:
    d = Derivation(
        "symmetric_top",
        title="Regular precession of a free symmetric body",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., sections 33 and 36",
        about=(
            "A free body with two equal moments precesses regularly: its symmetry axis goes round the fixed angular "
            "momentum at a constant rate and a constant angle, while the angular velocity goes round the axis in the "
            "body. The body cone rolls on the space cone, outside it (direct) or inside it (retrograde)."
        ),
    )
    a, c = symbols.A, symbols.C
    inertia = diag(a, a, c)
    alpha_b = angular_acceleration(inertia, OMEGA, 0 * OMEGA)  # rad/s^2
    along = pairs(symbols.omega_b, alpha_b)
    turning = (c - a) / a * symbols.omega_3  # rad/s
    d.define("Two moments are equal, axis 3 is the axis of symmetry:", "I", inertia)

    d.section("In the body")
    d.step(
        "The spin about the symmetry axis is constant.",
        alpha_b[2],
        0,
        because="equal moments about axes 1 and 2 cancel the gyroscopic torque on axis 3",
        named=r"\dot\omega_3",
        via=[
            (
                "Euler's equation on axis 3 for three moments $A, B, C$; here $B = A$:",
                angular_acceleration(diag(*symbols.principal), OMEGA, 0 * OMEGA)[2],
                (symbols.A - symbols.B) / symbols.C * symbols.omega_1 * symbols.omega_2,
            )
        ],
    )
    d.step(
        "The transverse part of the angular velocity turns at a constant rate, $\\lambda$.",
        Matrix(alpha_b[:2]),
        turning * Matrix([-symbols.omega_2, symbols.omega_1]),
        because="Euler's equations about axes 1 and 2 are inserted",
        named=r"\begin{bmatrix} \dot\omega_1 \\ \dot\omega_2 \end{bmatrix}",
        display=r"\lambda \begin{bmatrix} -\omega_2 \\ \omega_1 \end{bmatrix}, "
        r"\quad \lambda = \frac{C - A}{A}\,\omega_3",
    )
    d.step(
        "Its length is constant, so the polhode is a circle.",
        rate(symbols.omega_1**2 + symbols.omega_2**2, along),
        0,
        because="the transverse part and its rate are orthogonal",
        named=r"\frac{d}{dt} \left( \omega_1^2 + \omega_2^2 \right)",
    )

    d.section("In space")
    momentum = inertia * OMEGA
    spin = (a - c) / a * symbols.omega_3
    d.notation({r"\omega": OMEGA, "L": momentum, "e_3": AXIS, r"\lambda": turning}, along)
    d.step(
        "The angular velocity is one part along the angular momentum and one along the axis.",
        OMEGA,
        momentum / a + spin * AXIS,
        because="the inertia tensor is $A$ times the unit matrix, except along axis 3",
        named=r"\omega",
        display=r"\frac{L}{A} + \frac{A - C}{A}\,\omega_3\,e_3",
    )
    d.step(
        "So the symmetry axis turns about the fixed angular momentum, at the constant rate $|L|/A$.",
        OMEGA.cross(AXIS),
        (momentum / a).cross(AXIS),
        because=r"the other part of $\omega$ is along the symmetry axis and does not move this axis",
        named=r"\omega \times e_3",
        display=r"\frac{L}{A} \times e_3",
    )
    d.step(
        "The angle between them is constant, $\\cos\\theta = C \\omega_3 / |L|$.",
        rate(momentum.dot(AXIS), along),
        0,
        because=r"$L \cdot e_3 = C\,\omega_3$, and $|L|$ is conserved",
        named=r"\frac{d}{dt} \left( L \cdot e_3 \right)",
    )
    d.step(
        "Angular velocity, angular momentum and axis lie in one plane: the cones touch.",
        OMEGA.dot(momentum.cross(AXIS)),
        0,
        because="the angular velocity is a linear combination of the other two",
        named=r"\omega \cdot (L \times e_3)",
    )
    d.step(
        "How wide the cones are: tangents of the angles of the angular velocity and of the angular "
        "momentum to the axis.",
        squared(Matrix(momentum[:2])) / momentum[2] ** 2,
        (a / c) ** 2 * squared(Matrix(OMEGA[:2])) / symbols.omega_3**2,
        because=r"the transverse part of $L$ is $A$ times the transverse part of $\omega$, the axial part is $C$ times "
        "the axial part",
        named=r"\tan^2 \angle(L, e_3)",
        display=r"\left( \frac{A}{C} \right)^2 \tan^2 \angle(\omega, e_3)",
    )

    _angles(d)
    d.section("Direct or retrograde")
    d.passage(
        r"Precession has the component $\frac{L \cdot e_3}{A}$ along the axis. The spin relative to it is "
        r"$\dot\psi = \frac{A - C}{A}\,\omega_3$. The motion is direct when both have one sign, retrograde otherwise."
    )
    ratio = spin / (momentum.dot(AXIS) / a)
    d.step(
        "Their ratio does not depend on the motion.",
        ratio,
        (a - c) / c,
        because=r"$\omega_3$ cancels",
        named=r"\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    d.positive(
        r"An elongated body, $A = C + \delta_1$, precesses directly.",
        ratio.subs(a, c + symbols.delta_1),
        because="$A - C$ is positive",
        named=r"\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    d.positive(
        r"A flattened body, $C = A + \delta_1$, precesses in retrograde: the space cone is inside the body cone.",
        -ratio.subs(c, a + symbols.delta_1),
        because="$C - A$ is positive",
        named=r"-\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    return d


def _angles(d: Derivation) -> None:
    d.section("Precession, nutation and spin")
    a, c, h = symbols.A, symbols.C, symbols.H
    theta = symbols.theta
    d.passage("Let axis 3 of space be along the angular momentum, of length $H$, and the angles be those of ZXZ.")
    momentum = Matrix(dcm("ZXZ")).T * Matrix([0, 0, h])
    omega = diag(a, a, c).inv() * momentum
    rates = rate_jacobian("ZXZ").inverse * omega
    d.notation(
        {r"\omega_3": omega[2], r"\dot\phi": rates[0], r"\dot\psi": rates[2], "R": Matrix(dcm("ZXZ")), "e_3": AXIS}
    )
    d.notation({r"\omega": omega, r"\omega_b": omega})
    d.step(
        "Precession and spin are constant, and there is no nutation.",
        rates,
        Matrix([h / a, 0, h * cos(theta) * (1 / c - 1 / a)]),
        because=r"$\omega_b = I^{-1} R^{\mathsf T} L_s$, and $\dot q = B^{-1} \omega_b$",
        named=r"\begin{bmatrix} \dot\phi \\ \dot\theta \\ \dot\psi \end{bmatrix}",
    )
    d.step(
        r"The spin is that of the transverse part in the body, backwards: $\dot\psi = -\lambda$.",
        rates[2],
        -((c - a) / a * omega[2]),
        because=r"$C\,\omega_3 = H \cos\theta$",
        named=r"\dot\psi",
        display=r"-\frac{C - A}{A}\,\omega_3",
    )
    axis_b, axis_s = AXIS, Matrix(dcm("ZXZ")).T * AXIS
    d.step(
        "The angular velocity is the sum of a turn about the axis of the space cone and one about that of the body "
        "cone: "
        "along it, where the cones touch, neither slips.",
        omega,
        rates[0] * axis_s + rates[2] * axis_b,
        because="precession is about the angular momentum, spin about the symmetry axis",
        named=r"\omega_b",
        display=r"\dot\phi\,R^{\mathsf T} e_3 + \dot\psi\,e_3",
    )
    d.step(
        "The sines of the half angles of space cone and body cone are in the ratio of spin and precession: one turn "
        "of each "
        "rolls off as much as the other.",
        squared(omega.cross(axis_s)) * rates[0] ** 2,
        squared(omega.cross(axis_b)) * rates[2] ** 2,
        because=r"$\omega \times \omega = 0$, with the sum substituted for one factor",
        named=r"\dot\phi^2\,|\omega|^2 \sin^2 \angle(\omega, L)",
        display=r"\dot\psi^2\,|\omega|^2 \sin^2 \angle(\omega, e_3)",
    )
