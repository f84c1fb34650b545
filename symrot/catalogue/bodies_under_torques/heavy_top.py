"""The heavy symmetric top (Landau & Lifshitz, section 35, problems 1 and 2; Goldstein, 3rd ed., section 5.7)."""

from sympy import Matrix, Rational, Symbol, cos, diag, sin, solve, sqrt, tan

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate
from symrot.kinematics.euler import rate_jacobian
from symrot.proof.derivation import Derivation

PHI, THETA, PSI = symbols.angles
DPHI, DTHETA, DPSI = symbols.angle_rates
A, C, W, ARM = symbols.A, symbols.C, symbols.W, symbols.c_3
P_PHI, P_THETA, P_PSI = symbols.momenta
HALF = Rational(1, 2)
RATE = symbols.n  # rate of steady precession

OMEGA = rate_jacobian("ZXZ") * Matrix(symbols.angle_rates)
KINETIC = HALF * OMEGA.dot(diag(A, A, C) * OMEGA)
LAGRANGIAN = KINETIC - W * ARM * cos(THETA)
PRECESSION = (P_PHI - P_PSI * cos(THETA)) / (A * sin(THETA) ** 2)
RATES = {DPHI: PRECESSION, DPSI: P_PSI / C - cos(THETA) * PRECESSION}  # from the momenta
POTENTIAL = (P_PHI - P_PSI * cos(THETA)) ** 2 / (2 * A * sin(THETA) ** 2) + P_PSI**2 / (2 * C) + W * ARM * cos(THETA)
ROOT = sqrt(P_PSI**2 - 4 * A * W * ARM * cos(THETA))
FAST, SLOW = ((P_PSI + sign * ROOT) / (2 * A * cos(THETA)) for sign in (1, -1))  # rates of steady precession


def derive() -> Derivation:
    d = Derivation(
        "heavy_top",
        title="The heavy symmetric top",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 35, problems 1 and 2; Goldstein, Poole & Safko, "
        "*Classical Mechanics*, 3rd ed., section 5.7",
        about=(
            "A symmetric body rotates about a fixed point of its axis under its weight $W$. The centre of mass is on "
            "the axis, at $c_3$ from the fixed point. The angles of precession and spin do not occur in the "
            "Lagrangian (they are cyclic), so the nutation is the motion of one coordinate in an effective potential."
        ),
    )
    _lagrangian(d)
    _potential(d)
    _steady(d)
    _sleeping(d)
    return d


def _lagrangian(d: Derivation) -> None:
    d.section("Lagrangian and cyclic momenta")
    d.passage("The Euler angles have the sequence ZXZ, axis 3 of space points upward, and the moments about the fixed "
        "point are $A, A, C$. The Lagrangian is",
            (r"\mathcal L", r"T - W c_3 \cos\theta"))  # fmt: skip
    d.step(
        "The kinetic energy of the top is:",
        KINETIC,
        HALF * A * (DTHETA**2 + DPHI**2 * sin(THETA) ** 2) + HALF * C * (DPSI + DPHI * cos(THETA)) ** 2,
        because=r"$\omega_b = B \dot q$, and two moments are equal",
        named=r"T = \tfrac12\,\omega \cdot I\,\omega",
    )
    d.step(
        "The angles of precession and spin do not occur in the Lagrangian, so their momenta are constant.",
        Matrix([LAGRANGIAN.diff(PHI), LAGRANGIAN.diff(PSI)]),
        0,
        because="the top is symmetric about its axis, and gravity about the vertical",
        named=r"\begin{bmatrix} \partial \mathcal L / \partial \phi \\ \partial \mathcal L / \partial \psi "
        r"\end{bmatrix}",
    )
    momenta, spin = Matrix([LAGRANGIAN.diff(DPHI), LAGRANGIAN.diff(DPSI)]), DPSI + DPHI * cos(THETA)
    d.step(
        r"The momenta $p_\phi$ and $p_\psi$ are the angular momenta about the vertical and about the symmetry axis.",
        momenta,
        Matrix([A * DPHI * sin(THETA) ** 2 + C * spin * cos(THETA), C * spin]),
        because="the Lagrangian is differentiated",
        named=r"\begin{bmatrix} p_\phi \\ p_\psi \end{bmatrix}",
    )
    d.step(
        r"Conversely, the momenta give the rates: $\dot\phi = \frac{p_\phi - p_\psi \cos\theta}{A \sin^2\theta}$, "
        r"$\dot\psi = \frac{p_\psi}{C} - \dot\phi \cos\theta$.",
        momenta.subs(RATES),
        Matrix([P_PHI, P_PSI]),
        because="the two linear equations for the rates are solved",
        named=r"\left. \begin{bmatrix} \partial \mathcal L / \partial \dot\phi \\ \partial \mathcal L / \partial "
        r"\dot\psi \end{bmatrix} \right|_{\dot\phi, \dot\psi}",
    )


def _potential(d: Derivation) -> None:
    d.section("The effective potential")
    d.notation({"U": POTENTIAL, "T": KINETIC.subs(RATES)})
    d.step(
        r"The energy is the energy of the single coordinate $\theta$, moving in an effective potential $U$.",
        (KINETIC + W * ARM * cos(THETA)).subs(RATES),
        HALF * A * DTHETA**2 + POTENTIAL,
        because="the rates of the cyclic angles are substituted",
        named="T + V",
        display=r"\tfrac12\,A\,\dot\theta^2 + U(\theta), \quad U = \frac{(p_\phi - p_\psi \cos\theta)^2}{2 A "
        r"\sin^2\theta} + \frac{p_\psi^2}{2 C} + W c_3 \cos\theta",
    )
    motion = pairs(symbols.angles, symbols.angle_rates) | pairs(symbols.angle_rates, symbols.angle_accelerations)
    nutation = rate(LAGRANGIAN.diff(DTHETA), motion) - LAGRANGIAN.diff(THETA)
    d.step(
        "Lagrange's equation for the nutation is the equation of motion of one coordinate in the effective potential.",
        nutation.subs(RATES),
        A * symbols.ddtheta + POTENTIAL.diff(THETA),
        because="the rates are substituted after differentiating",
        named=r"\frac{d}{dt} \frac{\partial \mathcal L}{\partial \dot\theta} - \frac{\partial \mathcal L}{\partial "
        r"\theta}",
        display=r"A\,\ddot\theta + \frac{\partial U}{\partial \theta}",
    )
    energy, height = symbols.E, Symbol("u", real=True)
    speed = 2 / A * (energy - POTENTIAL) * sin(THETA) ** 2
    cubic = (2 * energy - P_PSI**2 / C - 2 * W * ARM * height) * (1 - height**2) / A - (
        P_PHI - P_PSI * height
    ) ** 2 / A**2
    d.notation({"u": cos(THETA), "E": energy})
    d.step(
        r"The square of the rate of $u = \cos\theta$ is a cubic polynomial in $u$. So the nutation is an elliptic "
        "function of time, and $u$ moves between two zeros of the polynomial.",
        speed,
        cubic.subs(height, cos(THETA)),
        because=r"$\dot u = -\dot\theta \sin\theta$ and $\tfrac12 A \dot\theta^2 = E - U$",
        named=r"\dot u^2 = \frac{2}{A} (E - U) \sin^2\theta",
        display=r"\frac{1 - u^2}{A} \left( 2 E - \frac{p_\psi^2}{C} - 2 W c_3 u \right) - \frac{(p_\phi - p_\psi "
        r"u)^2}{A^2}",
    )
    d.step(
        r"At $u = \pm 1$ the cubic is not positive. So the axis can be vertical only if $p_\phi = p_\psi$ (upright) "
        r"or $p_\phi = -p_\psi$ (hanging).",
        Matrix([cubic.subs(height, 1), cubic.subs(height, -1)]),
        -Matrix([(P_PHI - P_PSI) ** 2, (P_PHI + P_PSI) ** 2]) / A**2,
        because="$1 - u^2$ is zero at the vertical",
        named=r"\begin{bmatrix} \dot u^2 |_{u = 1} \\ \dot u^2 |_{u = -1} \end{bmatrix}",
    )


def _steady(d: Derivation) -> None:
    d.section("Steady precession")
    slope = A * RATE**2 * cos(THETA) - P_PSI * RATE + W * ARM
    steady = {P_PHI: P_PSI * cos(THETA) + A * RATE * sin(THETA) ** 2}
    d.names.pop("U")
    d.passage(
        "Let the nutation be constant, and let the axis precess at the rate $n$. Then",
        (r"p_\phi", r"p_\psi \cos\theta + A\,n \sin^2\theta"),
    )
    d.step(
        "The condition of steady precession is quadratic in the rate $n$.",
        POTENTIAL.diff(THETA).subs(steady),
        -sin(THETA) * slope,
        because="in steady precession the effective potential is stationary",
        named=r"\frac{\partial U}{\partial \theta}",
        display=r"-\sin\theta \left( A\,n^2 \cos\theta - p_\psi\,n + W c_3 \right)",
    )
    d.passage(
        r"The condition of steady precession has two roots, a fast and a slow rate. They are real for $p_\psi^2 \ge 4 "
        r"A W c_3 \cos\theta$:",
        (r"n_\pm", r"\frac{p_\psi \pm \sqrt{p_\psi^2 - 4 A W c_3 \cos\theta}}{2 A \cos\theta}"),
    )
    d.step(
        "Both rates satisfy the condition.",
        Matrix([slope.subs(RATE, FAST), slope.subs(RATE, SLOW)]),
        0,
        because="the roots of the quadratic equation are substituted",
        named=r"A\,n_\pm^2 \cos\theta - p_\psi\,n_\pm + W c_3",
    )
    d.step(
        "The sum and the product of the two rates of steady precession have simple forms. For a fast top the rates are "
        r"therefore close to $p_\psi / (A \cos\theta)$, the rate without weight, and to $W c_3 / p_\psi$.",
        Matrix([FAST + SLOW, FAST * SLOW]),
        Matrix([P_PSI, W * ARM]) / (A * cos(THETA)),
        because="the coefficients of the quadratic equation give sum and product of its roots (Vieta)",
        named=r"\begin{bmatrix} n_+ + n_- \\ n_+\,n_- \end{bmatrix}",
    )
    d.step(
        "With a horizontal axis there is only one rate.",
        Matrix(solve(slope.subs(cos(THETA), 0), RATE)),
        Matrix([W * ARM / P_PSI]),
        because=r"$\cos\theta = 0$ leaves a linear equation",
        named="n",
    )
    d.step(
        r"A small nutation about steady precession oscillates; the square of its frequency, times $A$, is $\partial^2 "
        r"U / \partial \theta^2$.",
        (POTENTIAL.diff(THETA, 2).subs(steady) * RATE**2).subs(P_PSI, (A * RATE**2 * cos(THETA) + W * ARM) / RATE),
        (A**2 * RATE**4 - 2 * A * W * ARM * RATE**2 * cos(THETA) + (W * ARM) ** 2) / A,
        because=r"the condition for steady precession gives $p_\psi$; the right side is positive: it is "
        r"$(A n^2 - W c_3 \cos\theta)^2 + (W c_3 \sin\theta)^2$ divided by $A$",
        named=r"n^2\,\frac{\partial^2 U}{\partial \theta^2}",
    )
    d.step(
        r"In steady precession $\partial^2 U / \partial \theta^2$ is positive, so every steady precession is stable.",
        A**2 * RATE**4 - 2 * A * W * ARM * RATE**2 * cos(THETA) + (W * ARM) ** 2,
        (A * RATE**2 - W * ARM * cos(THETA)) ** 2 + (W * ARM * sin(THETA)) ** 2,
        because=r"$\sin^2\theta + \cos^2\theta = 1$",
        named=r"A\,n^2\,\frac{\partial^2 U}{\partial \theta^2}",
    )


def _sleeping(d: Derivation) -> None:
    d.section("The sleeping top")
    regular = P_PSI**2 / (2 * A) * tan(THETA / 2) ** 2 + P_PSI**2 / (2 * C) + W * ARM * cos(THETA)
    d.step(
        r"For an upright top $p_\phi = p_\psi$, and the potential is regular at the vertical.",
        POTENTIAL.subs(P_PHI, P_PSI),
        regular,
        because=r"$\frac{1 - \cos\theta}{\sin\theta} = \tan\frac\theta2$",
        named=r"U|_{p_\phi = p_\psi}",
    )
    d.step(
        r"The potential has a minimum at the vertical for $p_\psi^2 > 4 A W c_3$. Then the top stands upright (it "
        "sleeps) until friction has reduced the spin below this bound.",
        Matrix([regular.diff(THETA), regular.diff(THETA, 2)]).subs(THETA, 0),
        Matrix([0, (P_PSI**2 - 4 * A * W * ARM) / (4 * A)]),
        because=r"$\tan^2\frac\theta2 = \frac{\theta^2}{4}$ and $\cos\theta = 1 - \frac{\theta^2}{2}$ to second order",
        named=r"\begin{bmatrix} \partial U / \partial \theta \\ \partial^2 U / \partial \theta^2 "
        r"\end{bmatrix}_{\theta = 0}",
    )
    d.step(
        r"At the bound $p_\psi^2 = 4 A W c_3$, the two rates of steady precession are equal at the vertical.",
        (A * (FAST - SLOW)).subs(THETA, 0) ** 2,
        P_PSI**2 - 4 * A * W * ARM,
        because=r"$\cos 0 = 1$",
        named=r"A^2 \left. (n_+ - n_-)^2 \right|_{\theta = 0}",
    )
