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
            "A free body with two equal moments precesses regularly: its symmetry axis moves around the fixed angular "
            "momentum at a constant rate and a constant angle, and in body axes the angular velocity moves around the "
            "symmetry axis. The angular velocity describes a cone in the body (the body cone) and a cone in space (the "
            "space cone). The body cone rolls on the outside of the space cone (direct precession), or it encloses "
            "the space cone (retrograde precession)."
        ),
    )
    a, c = symbols.A, symbols.C
    inertia = diag(a, a, c)
    alpha_b = angular_acceleration(inertia, OMEGA, 0 * OMEGA)  # rad/s^2
    along = pairs(symbols.omega_b, alpha_b)
    turning = (c - a) / a * symbols.omega_3  # rad/s
    d.define("Two moments are equal, and axis 3 is the symmetry axis:", "I", inertia)

    d.section("In the body")
    d.step(
        "The spin about the symmetry axis is constant.",
        alpha_b[2],
        0,
        because="equal moments about axes 1 and 2 cancel the gyroscopic torque on axis 3",
        named=r"\dot\omega_3",
        via=[
            (
                "Euler's equation for axis 3 with three moments $A, B, C$, of which $A = B$ here:",
                angular_acceleration(diag(*symbols.principal), OMEGA, 0 * OMEGA)[2],
                (symbols.A - symbols.B) / symbols.C * symbols.omega_1 * symbols.omega_2,
            )
        ],
    )
    d.step(
        r"In body axes, the transverse part of the angular velocity rotates at a constant rate $\lambda$.",
        Matrix(alpha_b[:2]),
        turning * Matrix([-symbols.omega_2, symbols.omega_1]),
        because="Euler's equations about axes 1 and 2 are inserted",
        named=r"\begin{bmatrix} \dot\omega_1 \\ \dot\omega_2 \end{bmatrix}",
        display=r"\lambda \begin{bmatrix} -\omega_2 \\ \omega_1 \end{bmatrix}, "
        r"\quad \lambda = \frac{C - A}{A}\,\omega_3",
    )
    d.step(
        "The length of the transverse part is constant, so the polhode is a circle.",
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
        "The angular velocity is the sum of a part along the angular momentum and a part along the symmetry axis.",
        OMEGA,
        momentum / a + spin * AXIS,
        because="the inertia tensor is $A$ times the unit matrix, except along axis 3",
        named=r"\omega",
        display=r"\frac{L}{A} + \frac{A - C}{A}\,\omega_3\,e_3",
    )
    d.step(
        "So the symmetry axis rotates about the fixed angular momentum at the constant rate $|L|/A$.",
        OMEGA.cross(AXIS),
        (momentum / a).cross(AXIS),
        because=r"the other part of $\omega$ is along the symmetry axis and does not move this axis",
        named=r"\omega \times e_3",
        display=r"\frac{L}{A} \times e_3",
    )
    d.step(
        r"The angle $\theta$ between angular momentum and symmetry axis is constant, $\cos\theta = C \omega_3 / |L|$.",
        rate(momentum.dot(AXIS), along),
        0,
        because=r"$L \cdot e_3 = C\,\omega_3$, and $|L|$ is conserved",
        named=r"\frac{d}{dt} \left( L \cdot e_3 \right)",
    )
    d.step(
        "Angular velocity, angular momentum and symmetry axis lie in one plane, so the two cones touch along the "
        "angular velocity.",
        OMEGA.dot(momentum.cross(AXIS)),
        0,
        because="the angular velocity is a linear combination of the other two vectors",
        named=r"\omega \cdot (L \times e_3)",
    )
    d.step(
        "The two cones follow from two angles: from the symmetry axis to the angular momentum, and to the angular "
        "velocity. The tangents of these angles have a constant ratio.",
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
        r"The precession has the component $\frac{L \cdot e_3}{A}$ along the symmetry axis, and the rate of the spin "
        r"angle is $\dot\psi = \frac{A - C}{A}\,\omega_3$. The precession is called direct if these two rates have "
        "the same sign, and retrograde otherwise."
    )
    ratio = spin / (momentum.dot(AXIS) / a)
    d.step(
        "The ratio of these two rates does not depend on the motion.",
        ratio,
        (a - c) / c,
        because=r"$\omega_3$ cancels",
        named=r"\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    d.positive(
        r"The precession of an elongated body, $A = C + \delta_1$, is direct.",
        ratio.subs(a, c + symbols.delta_1),
        because="$A - C$ is positive",
        named=r"\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    d.positive(
        r"The precession of a flattened body, $C = A + \delta_1$, is retrograde: the space cone is inside the body "
        "cone.",
        -ratio.subs(c, a + symbols.delta_1),
        because="$C - A$ is positive",
        named=r"-\frac{\dot\psi}{\dot\phi \cos\theta}",
    )
    return d


def _angles(d: Derivation) -> None:
    d.section("Precession, nutation and spin")
    a, c, h = symbols.A, symbols.C, symbols.H
    theta = symbols.theta
    d.passage(
        "Let axis 3 of space be along the angular momentum, which has the length $H$, and let the Euler angles "
        "have the sequence ZXZ."
    )
    momentum = Matrix(dcm("ZXZ")).T * Matrix([0, 0, h])
    omega = diag(a, a, c).inv() * momentum
    rates = rate_jacobian("ZXZ").inverse * omega
    d.notation(
        {r"\omega_3": omega[2], r"\dot\phi": rates[0], r"\dot\psi": rates[2], "R": Matrix(dcm("ZXZ")), "e_3": AXIS}
    )
    d.notation({r"\omega": omega, r"\omega_b": omega})
    d.step(
        "The rates of precession and spin angle are constant, and there is no nutation.",
        rates,
        Matrix([h / a, 0, h * cos(theta) * (1 / c - 1 / a)]),
        because=r"$\omega_b = I^{-1} R^{\mathsf T} L_s$, and $\dot q = B^{-1} \omega_b$",
        named=r"\begin{bmatrix} \dot\phi \\ \dot\theta \\ \dot\psi \end{bmatrix}",
    )
    d.step(
        r"The transverse part of $\omega$ rotates in the body at the rate $\lambda$, and the spin angle changes at the "
        r"opposite rate: $\dot\psi = -\lambda$.",
        rates[2],
        -((c - a) / a * omega[2]),
        because=r"$C\,\omega_3 = H \cos\theta$",
        named=r"\dot\psi",
        display=r"-\frac{C - A}{A}\,\omega_3",
    )
    axis_b, axis_s = AXIS, Matrix(dcm("ZXZ")).T * AXIS
    d.step(
        "The angular velocity is the sum of a rotation about the axis of the space cone and a rotation about the axis "
        "of the body cone. So the body cone does not slip along the line of contact.",
        omega,
        rates[0] * axis_s + rates[2] * axis_b,
        because="precession is about the angular momentum, spin about the symmetry axis",
        named=r"\omega_b",
        display=r"\dot\phi\,R^{\mathsf T} e_3 + \dot\psi\,e_3",
    )
    d.step(
        "The sines of the half angles of space cone and body cone are in the ratio of the rates of spin angle and "
        "precession. So equal arcs on the rims of both cones roll on each other.",
        squared(omega.cross(axis_s)) * rates[0] ** 2,
        squared(omega.cross(axis_b)) * rates[2] ** 2,
        because=r"$\omega \times \omega = 0$, with the sum substituted for one factor",
        named=r"\dot\phi^2\,|\omega|^2 \sin^2 \angle(\omega, L)",
        display=r"\dot\psi^2\,|\omega|^2 \sin^2 \angle(\omega, e_3)",
    )
