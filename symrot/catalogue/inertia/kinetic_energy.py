"""Kinetic energy of a rigid body (Landau & Lifshitz, Mechanics, 3rd ed., sections 32 and 35)."""

from sympy import Matrix, Rational, cos, diag, sin

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, squared
from symrot.catalogue.tools.particles import COUNT, FIRST_MOMENT, INERTIA, MASS, NAMES, over_particles
from symrot.inertia.tensor import about_point, inertia_of_point
from symrot.kinematics.euler import rate_jacobian
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation

V, ARM = Matrix(symbols.velocity), Matrix(symbols.center_of_mass)
HALF = Rational(1, 2)


def derive() -> Derivation:
    d = Derivation(
        "kinetic_energy",
        title="Kinetic energy",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., sections 32 and 35; Goldstein, Poole & Safko, *Classical "
        "Mechanics*, 3rd ed., section 5.3",
        about=(
            "The kinetic energy of a body is the energy of its total mass at the centre of mass, plus the rotational "
            r"energy $\tfrac12\,\omega \cdot I\,\omega$. The rotational energy is half the product of angular "
            "velocity and angular momentum."
        ),
    )
    _sum(d)
    _forms(d)
    _angles(d)
    return d


def _sum(d: Derivation) -> None:
    d.section("From the sum over particles")
    point = Matrix(symbols.position)
    d.notation({"r": point, r"\omega": OMEGA, "c": ARM})
    d.step(
        r"A particle at $r$ that moves with the angular velocity $\omega$ has a kinetic energy that is quadratic in "
        r"$\omega$.",
        HALF * symbols.m * squared(OMEGA.cross(point)),
        HALF * OMEGA.dot(Matrix(inertia_of_point(symbols.m, point)) * OMEGA),
        because=r"$|\omega \times r|^2 = |\omega|^2 |r|^2 - (\omega \cdot r)^2$",
        named=r"\tfrac12\,m\,|\omega \times r|^2",
        board=(
            (
                r"$|\omega \times r|^2 = |\omega|^2 |r|^2 - (\omega \cdot r)^2$ (Lagrange's identity):",
                r"\tfrac12\,m \left( |\omega|^2\,|r|^2 - (\omega \cdot r)^2 \right)",
            ),
            (
                r"$|\omega|^2 = \omega \cdot \omega$ and $(\omega \cdot r)^2 = \omega \cdot r\,r^{\mathsf T} \omega$:",
                r"\tfrac12\,\omega \cdot m \left( |r|^2\,\mathbf{1} - r\,r^{\mathsf T} \right) \omega",
            ),
        ),
        display=r"\tfrac12\,\omega \cdot m \left( |r|^2\,\mathbf{1} - r\,r^{\mathsf T} \right) \omega",
    )
    d.passage(
        "The proof uses three particles and holds for any number. Let the centre of mass move with the velocity $v$, "
        "and let particle $i$ be at $r_i$ from it:",
        (rf"{COUNT} m_i\,r_i", "0"),
        ("M", rf"{COUNT} m_i"),
    )
    d.notation(NAMES | {"I": INERTIA, "v": V, "M": MASS})
    d.step(
        "König's theorem: the kinetic energy is the energy of the total mass, moving with the centre of mass, plus the "
        "energy of the rotation about the centre of mass.",
        HALF * over_particles(lambda m, r: m * squared(V + OMEGA.cross(r))),
        HALF * MASS * squared(V) + HALF * OMEGA.dot(INERTIA * OMEGA),
        because=rf"the mixed term is $v \cdot (\omega \times {COUNT} m_i\,r_i) = 0$",
        relations=list(FIRST_MOMENT),
        named=rf"\tfrac12 {COUNT} m_i\,|v + \omega \times r_i|^2",
        board=(
            (
                "The square is multiplied out:",
                r"\tfrac12 \sum_i (m_i\,|v|^2) + \sum_i (m_i\,v \cdot (\omega \times r_i)) + \tfrac12 \sum_i "
                r"(m_i\,|\omega \times r_i|^2)",
            ),
            (
                r"$v$ and $\omega$ are the same for all particles:",
                r"\tfrac12\,M\,|v|^2 + v \cdot \left( \omega \times \sum_i (m_i\,r_i) \right) + \tfrac12 \sum_i "
                r"(m_i\,|\omega \times r_i|^2)",
            ),
            (
                r"$\sum_i m_i\,r_i = 0$, and the last sum is $\omega \cdot I\,\omega$:",
                r"\tfrac12\,M\,|v|^2 + \tfrac12\,\omega \cdot I\,\omega",
            ),
        ),
        display=r"\tfrac12\,M\,|v|^2 + \tfrac12\,\omega \cdot I\,\omega",
    )
    d.notation({"I": TENSOR, "I_O": Matrix(about_point(TENSOR, symbols.m, ARM))})
    d.step(
        "If a point of the body is fixed in space, the whole kinetic energy is the energy of the rotation about this "
        "point, with the inertia tensor about this point.",
        HALF * symbols.m * squared(OMEGA.cross(ARM)) + HALF * OMEGA.dot(TENSOR * OMEGA),
        HALF * OMEGA.dot(Matrix(about_point(TENSOR, symbols.m, ARM)) * OMEGA),
        because=r"the centre of mass, at $c$ from the fixed point, moves with $\omega \times c$, and the parallel "
        "axis theorem gives the tensor about the fixed point",
        named=r"\tfrac12\,m\,|\omega \times c|^2 + \tfrac12\,\omega \cdot I\,\omega",
        display=r"\tfrac12\,\omega \cdot I_O\,\omega",
    )


def _forms(d: Derivation) -> None:
    d.section("Other forms of the rotational energy")
    energy = HALF * OMEGA.dot(TENSOR * OMEGA)
    d.notation({"T": energy, "I": TENSOR, r"\omega": OMEGA, "n": Matrix(symbols.axis), r"\Omega": symbols.Omega})
    d.step(
        "The gradient of the kinetic energy with respect to the angular velocity is the angular momentum.",
        Matrix([energy.diff(w) for w in OMEGA]),
        TENSOR * OMEGA,
        because="the inertia tensor is symmetric",
        named=r"\frac{\partial T}{\partial \omega}",
        display=r"I\,\omega",
    )
    axis = Matrix(symbols.axis)
    d.step(
        "For rotation about an axis $n$, the energy depends only on the moment of inertia about this axis.",
        energy.subs(dict(zip(OMEGA, symbols.Omega * axis, strict=True)), simultaneous=True),
        HALF * axis.dot(TENSOR * axis) * symbols.Omega**2,
        because=r"$\omega = \Omega\,n$",
        named=r"\left. T \right|_{\omega = \Omega n}",
        display=r"\tfrac12 \left( n \cdot I\,n \right) \Omega^2",
    )
    dcm_sb = Matrix(quaternion_to_dcm())
    turned = dcm_sb * TENSOR * dcm_sb.T
    d.notation({"R": dcm_sb, r"\omega_s": dcm_sb * OMEGA, r"\omega_b": OMEGA, "I_s": turned, "I_b": TENSOR})
    d.step(
        "The kinetic energy is the same in space axes, where the inertia tensor changes with time.",
        HALF * (dcm_sb * OMEGA).dot(turned * dcm_sb * OMEGA),
        energy,
        because=r"$R^{\mathsf T} R = 1$ is applied twice",
        relations=[unit_relation()],
        named=r"\tfrac12\,\omega_s \cdot I_s\,\omega_s",
        board=(
            (
                r"$\omega_s = R\,\omega_b$ and $I_s = R\,I_b R^{\mathsf T}$:",
                r"\tfrac12\,R\,\omega_b \cdot R\,I_b\,R^{\mathsf T} R\,\omega_b",
            ),
            (
                r"$R^{\mathsf T} R = 1$, and a rotation preserves scalar products:",
                r"\tfrac12\,\omega_b \cdot I_b\,\omega_b",
            ),
        ),
        display=r"\tfrac12\,\omega_b \cdot I_b\,\omega_b",
    )
    principal = diag(*symbols.principal)
    momentum = principal * OMEGA
    d.notation({f"L_{n + 1}": momentum[n] for n in range(3)})
    d.step(
        "Along principal axes, the energy is a sum of squares of the angular velocities, or of the angular momenta.",
        HALF * OMEGA.dot(momentum),
        HALF * momentum.dot(principal.inv() * momentum),
        because=r"$\omega = I^{-1} L$",
        named=r"\tfrac12 \left( A\,\omega_1^2 + B\,\omega_2^2 + C\,\omega_3^2 \right)",
        display=r"\tfrac12 \left( \frac{L_1^2}{A} + \frac{L_2^2}{B} + \frac{L_3^2}{C} \right)",
    )


def _angles(d: Derivation) -> None:
    d.section("In Euler angles, ZXZ")
    rates = Matrix(symbols.angle_rates)
    omega = rate_jacobian("ZXZ") * rates
    a, b, c = symbols.principal
    _, theta, psi = symbols.angles
    dphi, dtheta, dpsi = symbols.angle_rates
    d.names.pop("T")
    d.step(
        "The kinetic energy of a body with three different moments is:",
        HALF * omega.dot(diag(a, b, c) * omega),
        HALF * a * (dphi * sin(theta) * sin(psi) + dtheta * cos(psi)) ** 2
        + HALF * b * (dphi * sin(theta) * cos(psi) - dtheta * sin(psi)) ** 2
        + HALF * c * (dphi * cos(theta) + dpsi) ** 2,
        because=r"$\omega_b = B \dot q$",
        named="T",
    )
    d.step(
        "With two equal moments, the spin angle does not occur in the energy.",
        HALF * omega.dot(diag(a, a, c) * omega),
        HALF * a * (dtheta**2 + dphi**2 * sin(theta) ** 2) + HALF * c * (dpsi + dphi * cos(theta)) ** 2,
        because=r"$\sin^2\psi + \cos^2\psi = 1$",
        named="T",
    )
    d.step(
        "With three equal moments, the energy stays the same if the rates of precession and spin are exchanged, since "
        "no body axis is distinguished.",
        HALF * omega.dot(diag(a, a, a) * omega),
        HALF * a * (dphi**2 + dtheta**2 + dpsi**2 + 2 * dphi * dpsi * cos(theta)),
        because=r"$T = \tfrac12 A\,|\omega|^2$",
        named="T",
    )
