"""Jacobi's solution of the free asymmetric body (Landau & Lifshitz, Mechanics, 3rd ed., section 37)."""

from sympy import Matrix, cos, diag, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.proof.derivation import Derivation

A, B, C = symbols.principal
SN, CN, DN = symbols.elliptic
P, MU = symbols.p, symbols.mu
FIRST, THIRD = symbols.amplitudes
INERTIA = diag(A, B, C)


def derive() -> Derivation:
    d = Derivation(
        "free_asymmetric_body",
        title="Jacobi's solution of the free asymmetric body",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 37; Whittaker, *Analytical Dynamics*, 4th ed., "
        "section 69",
        about=(
            r"The components of the angular velocity of a free body, $A > B > C$, are Jacobi's elliptic functions of "
            r"time. "
            "The proof needs their derivatives and two quadratic relations, and nothing else about them."
        ),
    )
    for one, other in ((A, B), (A, C)):
        d.nonzero("The moments differ,", one - other, f"{one} - {other}")
    _functions(d)
    _solution(d)
    _constants(d)
    _attitude(d)
    return d


def _elliptic(p: object, parameter: object) -> dict:  # type: ignore[type-arg]
    return {SN: p * CN * DN, CN: -p * SN * DN, DN: -p * parameter * SN * CN}  # type: ignore[operator]


def _functions(d: Derivation) -> None:
    d.section("What is used of the elliptic functions")
    rates = _elliptic(P, MU)
    d.notation({r"\mathrm{sn}": SN, r"\mathrm{cn}": CN, r"\mathrm{dn}": DN, r"\mu": MU, "A": A, "B": B, "C": C}, rates)
    d.notation({"a_1": FIRST, "a_3": THIRD, "I": INERTIA})
    d.passage(
        r"Let $\mathrm{sn}, \mathrm{cn}, \mathrm{dn}$ be those of the argument $p\,t$ and the parameter $\mu = k^2$. "
        r"They start "
        "at $0, 1, 1$ and obey",
        *((rf"\frac{{d}}{{dt}}\,{_latex(name)}", value) for name, value in rates.items()),
    )
    squares = [CN**2 - 1 + SN**2, DN**2 - 1 + MU * SN**2]
    d.step(
        "Two sums of squares are constant, and 1 at the start:",
        Matrix([rate(CN**2 + SN**2, rates), rate(DN**2 + MU * SN**2, rates)]),
        0,
        because="the derivative of each function is a multiple of the other two, and the two terms cancel",
        named=r"\frac{d}{dt} \begin{bmatrix} \mathrm{cn}^2 + \mathrm{sn}^2 \\ \mathrm{dn}^2 + \mu\,\mathrm{sn}^2 "
        r"\end{bmatrix}",
    )
    d.step(
        r"So $\mathrm{dn}$ and $\mathrm{cn}$ are one function at $\mu = 1$, where they do not oscillate.",
        DN**2 - CN**2,
        (1 - MU) * SN**2,
        because="the two sums of squares are subtracted from each other",
        relations=squares,
        named=r"\mathrm{dn}^2 - \mathrm{cn}^2",
    )


def _amplitudes() -> tuple[Matrix, object, object]:
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
    rates = _elliptic(p, parameter)
    d.notation({}, rates)
    d.passage(
        r"Let the body start with $\omega = (a_1, 0, a_3)$, on the side of the separatrix where $L^2 > 2 T B$: the "
        r"polhode "
        "goes round axis 1. The other side is the same with $A$ and $C$, axes 1 and 3, exchanged. With",
        ("a_2", amplitudes[1]),
        ("p", r"\frac{(A - C)\,a_1 a_3}{B\,a_2}"),
        (r"\mu", r"\frac{(B - C)\,a_2 a_3}{A\,p\,a_1}"),
        (r"\omega", r"\begin{bmatrix} a_1\,\mathrm{dn} \\ -a_2\,\mathrm{sn} \\ a_3\,\mathrm{cn} \end{bmatrix}"),
    )
    d.step(
        "All three of Euler's equations hold.",
        INERTIA * rate(omega, rates),
        INERTIA * angular_acceleration(INERTIA, omega, 0 * omega),
        because="the derivative of each elliptic function is a multiple of the product of the two others, as "
        "Euler's equations require",
        named=r"I\,\dot\omega",
        display=r"-\omega \times I\,\omega",
    )
    squares = [CN**2 - 1 + SN**2, DN**2 - 1 + parameter * SN**2]
    d.step(
        "Energy is that of the start.",
        omega.dot(INERTIA * omega),
        A * FIRST**2 + C * THIRD**2,
        because=r"$\mathrm{dn}^2 = 1 - \mu\,\mathrm{sn}^2$ and $\mathrm{cn}^2 = 1 - \mathrm{sn}^2$",
        relations=squares,
        named="2 T",
    )
    d.step(
        "So is the length of angular momentum.",
        squared(INERTIA * omega),
        A**2 * FIRST**2 + C**2 * THIRD**2,
        because="the same two quadratic relations are substituted",
        relations=squares,
        named="L^2",
    )


def _constants(d: Derivation) -> None:
    d.section("Its constants, from energy and angular momentum")
    amplitudes, p, parameter = _amplitudes()
    twice = A * FIRST**2 + C * THIRD**2
    square = A**2 * FIRST**2 + C**2 * THIRD**2
    d.notation({"T": twice / 2, "L": sqrt(square)})
    d.step(
        "The amplitudes.",
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
        "The frequency.",
        p**2,  # type: ignore[operator]
        (A - B) * (square - twice * C) / (A * B * C),
        because=r"$a_2$ is substituted",
        named="p^2",
        display=r"\frac{(A - B) (L^2 - 2 T C)}{A B C}",
    )
    d.step(
        "The parameter.",
        parameter,
        (B - C) * (twice * A - square) / ((A - B) * (square - twice * C)),
        because=r"$a_2$ and $p$ are substituted",
        named=r"\mu",
        display=r"\frac{(B - C) (2 T A - L^2)}{(A - B) (L^2 - 2 T C)}",
    )
    d.step(
        r"It is 1 on the separatrix, $L^2 = 2 T B$, and below 1 on this side of it.",
        (1 - parameter) * (A - B) * (square - twice * C),  # type: ignore[operator]
        (A - C) * (square - twice * B),
        because="both sides of the equation are expanded",
        named=r"(1 - \mu)\,(A - B) (L^2 - 2 T C)",
        display=r"(A - C) (L^2 - 2 T B)",
    )
    d.step(
        "With two equal moments, $B = C$, it is 0, the functions are a sine, a cosine and 1, and the frequency is "
        "that of "
        "[regular precession](symmetric_top.md).",
        Matrix([parameter, p**2]).subs(B, C),  # type: ignore[operator]
        Matrix([0, ((A - C) / C * FIRST) ** 2]),
        because=r"$B - C$ is a factor of $\mu$",
        named=r"\left. \begin{bmatrix} \mu \\ p^2 \end{bmatrix} \right|_{B = C}",
    )


def _attitude(d: Derivation) -> None:
    d.section("The attitude: two angles without an integral")
    h, (_, theta, psi) = symbols.H, symbols.angles
    momentum = Matrix(dcm("ZXZ")).T * Matrix([0, 0, h])
    d.passage("Let axis 3 of space be along the angular momentum, of length $H$, and the angles be those of ZXZ.")
    d.step(
        r"Nutation and spin are read off the angular velocity: $\cos\theta = C \omega_3 / H$, $\tan\psi = A \omega_1 / "
        r"(B \omega_2)$.",
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
        "Precession alone is an integral over time (one of the third kind).",
        rates[0],
        h * expected.subs(dict(zip(OMEGA, omega, strict=True)), simultaneous=True),
        because=r"$\dot q = B^{-1} \omega_b$",
        named=r"\dot\phi",
        display=r"H\,\frac{A\,\omega_1^2 + B\,\omega_2^2}{A^2 \omega_1^2 + B^2 \omega_2^2}",
    )
    d.step(
        "The nutation swings unless two moments are equal.",
        rates[1],
        h * (1 / A - 1 / B) * sin(theta) * sin(psi) * cos(psi),
        because=r"$\dot\theta$ is the component along the line of nodes, $\omega_1 \cos\psi - \omega_2 \sin\psi$",
        named=r"\dot\theta",
    )


def _latex(value: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(value)
