"""Jacobi's solution of the free asymmetric body (Landau & Lifshitz, Mechanics, 3rd ed., section 37)."""

from sympy import Expr, Matrix, cos, diag, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, derivatives, squares
from symrot.catalogue.tools.motion import OMEGA, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.proof.derivation import Derivation
from symrot.proof.notation.printer import formula

A, B, C = symbols.principal
P = symbols.p
FIRST, THIRD = symbols.amplitudes
INERTIA = diag(A, B, C)


def derive() -> Derivation:
    d = Derivation(
        "free_asymmetric_body",
        title="Jacobi's solution of the free asymmetric body",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 37; Whittaker, *Analytical Dynamics*, 4th ed., "
        "section 69",
        about=(
            "The components of the angular velocity of a free body with the moments $A > B > C$ are Jacobi's elliptic "
            "functions of time. The proof uses only the derivatives of these functions and two quadratic relations."
        ),
    )
    for axis, moment in ((2, B), (3, C)):
        d.nonzero(f"The moments of axes 1 and {axis} are different,", A - moment, f"A - {moment}")
    _functions(d)
    _solution(d)
    _constants(d)
    _attitude(d)
    return d


def _functions(d: Derivation) -> None:
    d.section("The elliptic functions")
    rates = derivatives(P)
    d.notation({r"\mathrm{sn}": SN, r"\mathrm{cn}": CN, r"\mathrm{dn}": DN, r"\mu": MU, "A": A, "B": B, "C": C}, rates)
    d.notation({"a_1": FIRST, "a_3": THIRD, "I": INERTIA})
    d.passage(
        r"Let $\mathrm{sn}, \mathrm{cn}, \mathrm{dn}$ be Jacobi's functions of the argument $p\,t$ with the parameter "
        r"$\mu = k^2$. They have the values $0, 1, 1$ at $t = 0$ and the derivatives",
        *((rf"\frac{{d}}{{dt}}\,{formula(name)}", value) for name, value in rates.items()),
    )
    d.step(
        "Two sums of squares are constant; at $t = 0$ both are 1.",
        Matrix([rate(CN**2 + SN**2, rates), rate(DN**2 + MU * SN**2, rates)]),
        0,
        because="the derivative of each function is a multiple of the product of the other two, and the two terms of "
        "each sum cancel",
        named=r"\frac{d}{dt} \begin{bmatrix} \mathrm{cn}^2 + \mathrm{sn}^2 \\ \mathrm{dn}^2 + \mu\,\mathrm{sn}^2 "
        r"\end{bmatrix}",
    )
    d.step(
        r"At $\mu = 1$ the functions $\mathrm{dn}$ and $\mathrm{cn}$ are therefore equal; there they do not oscillate.",
        DN**2 - CN**2,
        (1 - MU) * SN**2,
        because="the two sums of squares are subtracted from each other",
        relations=squares(),
        named=r"\mathrm{dn}^2 - \mathrm{cn}^2",
    )


def _amplitudes() -> tuple[Matrix, Expr, Expr]:
    """Return amplitudes, frequency and parameter of Jacobi's elliptic functions in the motion of a free body.

    They are computed from the initial values of the first and the third component of the angular velocity.
    """
    second = THIRD * sqrt(C * (A - C) / (B * (A - B)))
    p = (A - C) / B * FIRST * THIRD / second
    parameter = (B - C) / A * second * THIRD / (p * FIRST)
    return Matrix([FIRST, second, THIRD]), p, parameter


def _solution(d: Derivation) -> None:
    d.section("The solution")
    amplitudes, p, parameter = _amplitudes()
    omega = Matrix([amplitudes[0] * DN, -amplitudes[1] * SN, amplitudes[2] * CN])
    rates = derivatives(p, parameter)
    d.notation({}, rates)
    d.passage(
        r"Let the body start with $\omega = (a_1, 0, a_3)$, and let $L^2 > 2 T B$, so that the polhode goes around "
        "axis 1. For $L^2 < 2 T B$ the solution is the same with axes 1 and 3, and their moments $A$ and $C$, "
        "exchanged. Define",
        ("a_2", amplitudes[1]),
        ("p", r"\frac{(A - C)\,a_1 a_3}{B\,a_2}"),
        (r"\mu", r"\frac{(B - C)\,a_2 a_3}{A\,p\,a_1}"),
        (r"\omega", r"\begin{bmatrix} a_1\,\mathrm{dn} \\ -a_2\,\mathrm{sn} \\ a_3\,\mathrm{cn} \end{bmatrix}"),
    )
    d.step(
        r"This $\omega$ satisfies Euler's equations.",
        INERTIA * rate(omega, rates),
        INERTIA * angular_acceleration(INERTIA, omega, 0 * omega),
        because="the derivative of each elliptic function is a multiple of the product of the two others, as "
        "Euler's equations require",
        named=r"I\,\dot\omega",
        display=r"-\omega \times I\,\omega",
    )
    d.step(
        "The kinetic energy has its initial value.",
        omega.dot(INERTIA * omega),
        A * FIRST**2 + C * THIRD**2,
        because=r"$\mathrm{dn}^2 = 1 - \mu\,\mathrm{sn}^2$ and $\mathrm{cn}^2 = 1 - \mathrm{sn}^2$",
        relations=squares(parameter),
        named="2 T",
    )
    d.step(
        "The length of the angular momentum has its initial value.",
        squared(INERTIA * omega),
        A**2 * FIRST**2 + C**2 * THIRD**2,
        because="the same two quadratic relations are substituted",
        relations=squares(parameter),
        named="L^2",
    )


def _constants(d: Derivation) -> None:
    d.section("The constants of the solution from energy and angular momentum")
    amplitudes, p, parameter = _amplitudes()
    twice = A * FIRST**2 + C * THIRD**2
    square = A**2 * FIRST**2 + C**2 * THIRD**2
    d.notation({"T": twice / 2, "L": sqrt(square)})
    d.step(
        "The energy and the angular momentum give the amplitudes of the elliptic functions.",
        amplitudes.multiply_elementwise(amplitudes),
        Matrix(
            [
                (square - twice * C) / (A * (A - C)),
                (twice * A - square) / (B * (A - B)),
                (twice * A - square) / (C * (A - C)),
            ]
        ),
        because="energy and angular momentum give two linear equations for the squares of the amplitudes",
        named=r"\begin{bmatrix} a_1^2 \\ a_2^2 \\ a_3^2 \end{bmatrix}",
        display=r"\begin{bmatrix} \frac{L^2 - 2 T C}{A (A - C)} \\ \frac{2 T A - L^2}{B (A - B)} \\ "
        r"\frac{2 T A - L^2}{C (A - C)} \end{bmatrix}",
    )
    d.step(
        "They give the frequency.",
        p**2,
        (A - B) * (square - twice * C) / (A * B * C),
        because=r"$a_2$ is substituted",
        named="p^2",
        display=r"\frac{(A - B) (L^2 - 2 T C)}{A B C}",
    )
    d.step(
        "They give the parameter.",
        parameter,
        (B - C) * (twice * A - square) / ((A - B) * (square - twice * C)),
        because=r"$a_2$ and $p$ are substituted",
        named=r"\mu",
        display=r"\frac{(B - C) (2 T A - L^2)}{(A - B) (L^2 - 2 T C)}",
    )
    d.step(
        r"The parameter $\mu$ is 1 on the separatrix, where $L^2 = 2 T B$, and less than 1 for $L^2 > 2 T B$.",
        (1 - parameter) * (A - B) * (square - twice * C),
        (A - C) * (square - twice * B),
        because="both sides of the equation are expanded",
        named=r"(1 - \mu)\,(A - B) (L^2 - 2 T C)",
        display=r"(A - C) (L^2 - 2 T B)",
    )
    d.step(
        "With two equal moments, $B = C$, the parameter is 0. Then sn and cn are a sine and a cosine, dn is 1, and "
        "the frequency is the frequency of [regular precession](symmetric_top.md).",
        Matrix([parameter, p**2]).subs(B, C),
        Matrix([0, ((A - C) / C * FIRST) ** 2]),
        because=r"$B - C$ is a factor of $\mu$",
        named=r"\left. \begin{bmatrix} \mu \\ p^2 \end{bmatrix} \right|_{B = C}",
    )


def _attitude(d: Derivation) -> None:
    d.section("The attitude: nutation and spin without an integral")
    h, (_, theta, psi) = symbols.H, symbols.angles
    momentum = Matrix(dcm("ZXZ")).T * Matrix([0, 0, h])
    d.passage(
        "Let axis 3 of space be along the angular momentum, which has the length $H$, and let the Euler angles "
        "have the sequence ZXZ."
    )
    d.step(
        r"Nutation and spin follow from the angular velocity: $\cos\theta = C \omega_3 / H$ and $\tan\psi = A "
        r"\omega_1 / (B \omega_2)$.",
        momentum,
        h * Matrix([sin(theta) * sin(psi), sin(theta) * cos(psi), cos(theta)]),
        because=r"$L_b = R^{\mathsf T} L_s$",
        named=r"\begin{bmatrix} A \omega_1 \\ B \omega_2 \\ C \omega_3 \end{bmatrix}",
    )
    omega = INERTIA.inv() * momentum
    d.notation({"H": h} | {rf"\omega_{n + 1}": omega[n] for n in range(3)})
    rates = rate_jacobian("ZXZ").inverse * omega
    expected = (A * OMEGA[0] ** 2 + B * OMEGA[1] ** 2) / (A**2 * OMEGA[0] ** 2 + B**2 * OMEGA[1] ** 2)
    d.step(
        "Only the precession needs an integral over time (an elliptic integral of the third kind).",
        rates[0],
        h * expected.subs(dict(zip(OMEGA, omega, strict=True)), simultaneous=True),
        because=r"$\dot q = B^{-1} \omega_b$",
        named=r"\dot\phi",
        display=r"H\,\frac{A\,\omega_1^2 + B\,\omega_2^2}{A^2 \omega_1^2 + B^2 \omega_2^2}",
    )
    d.step(
        "The nutation oscillates unless $A = B$.",
        rates[1],
        h * (1 / A - 1 / B) * sin(theta) * sin(psi) * cos(psi),
        because=r"$\dot\theta$ is the component along the line of nodes, $\omega_1 \cos\psi - \omega_2 \sin\psi$",
        named=r"\dot\theta",
    )
