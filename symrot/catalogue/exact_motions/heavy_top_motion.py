"""The motion of the heavy symmetric top (Whittaker, Analytical Dynamics, 4th ed., sections 71 and 72)."""

from sympy import Expr, Matrix, Rational, cos, sin, sqrt

from symrot import symbols
from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, W_VALUES, I, derivatives, imaginary, shifted, squares
from symrot.catalogue.tools.motion import rate
from symrot.kinematics.euler import dcm
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.kinematics.rotations import elementary_rotation
from symrot.proof.derivation import Derivation
from symrot.proof.notation.printer import formula

A, C, W, ARM = symbols.A, symbols.C, symbols.W, symbols.c_3
U1, U2, U3 = symbols.heights
PHI, THETA, PSI = symbols.angles
P_PHI, P_PSI = symbols.p_phi, symbols.p_psi
HALF = Rational(1, 2)
SPEED = sqrt(W * ARM * (U3 - U1) / (2 * A))
PARAMETER = (U2 - U1) / (U3 - U1)
HEIGHT = U1 + (U2 - U1) * SN**2
SUM = sqrt(2 * A * W * ARM * (1 + U1) * (1 + U2) * (1 + U3))
DIFFERENCE = sqrt(2 * A * W * ARM * (1 - U1) * (1 - U2) * (U3 - 1))


def derive() -> Derivation:
    d = Derivation(
        "heavy_top_motion",
        title="The motion of the heavy symmetric top",
        source="Whittaker, *Analytical Dynamics*, 4th ed., sections 71 and 72; Klein & Sommerfeld, *The Theory of the "
        "Top*, vol. 2, chapter 6",
        about=(
            "The height of the top's axis is a quadratic function of an elliptic function of time, and the angles of "
            "precession and spin follow from arguments of theta functions. The formulas for the attitude are regular "
            "even if the axis passes through the vertical."
        ),
    )
    _nutation(d)
    _rates(d)
    _attitude(d)
    _theta(d)
    return d


def cubic(height: Expr) -> Expr:
    """Return the square of d(cos theta)/dt of a heavy top, a cubic polynomial of ``height`` = cos(theta).

    Its three zeros U1, U2, U3 are taken as known.
    """
    return 2 * W * ARM / A * (height - U1) * (height - U2) * (height - U3)


def _nutation(d: Derivation) -> None:
    d.section("Nutation")
    u = symbols.gamma_3
    momentum, spin = (SUM + DIFFERENCE) / 2, (SUM - DIFFERENCE) / 2
    energy = 2 * W * ARM * (U1 + U2 + U3) - spin**2 / A
    d.passage(
        r"[Energy and momenta](heavy_top.md) give the square of the rate of $u = \cos\theta$ as a cubic polynomial in "
        r"$u$. It is positive above its largest zero and not positive at $\pm 1$. Its zeros are $-1 \le u_1 \le u_2 "
        r"\le 1 \le u_3$, and $u$ oscillates between $u_1$ and $u_2$. Conversely, the zeros give the constants of the "
        "motion:",
        (r"(p_\phi + p_\psi)^2", SUM**2),
        (r"(p_\phi - p_\psi)^2", DIFFERENCE**2),
        (r"2 E - \frac{p_\psi^2}{C}", r"2 W c_3 (u_1 + u_2 + u_3) - \frac{p_\psi^2}{A}"),
    )
    d.notation({"u": u, r"p_\phi": momentum, r"p_\psi": spin, r"2 E - \frac{p_\psi^2}{C}": energy})
    d.notation({"E": (energy + spin**2 / C) / 2})
    d.step(
        "The cubic polynomial in $u$ that the energy and the momenta determine has the zeros $u_1, u_2, u_3$.",
        (energy - 2 * W * ARM * u) * (1 - u**2) / A - (momentum - spin * u) ** 2 / A**2,
        cubic(u),
        because="both sides are cubics with equal values at $u = 1$ and $u = -1$ and two equal coefficients",
        named=r"\frac{1 - u^2}{A} \left( 2 E - \frac{p_\psi^2}{C} - 2 W c_3 u \right) - "
        r"\frac{(p_\phi - p_\psi u)^2}{A^2}",
        display=r"\frac{2 W c_3}{A} (u - u_1)(u - u_2)(u - u_3)",
    )
    d.passage(
        r"Let sn, cn, dn have the argument $p\,t$ and the parameter $\mu$, and let $t = 0$ be a time at which the "
        "axis is lowest:",
        ("p", SPEED),
        (r"\mu", PARAMETER),
        ("u", HEIGHT),
    )
    along = derivatives(SPEED, PARAMETER)
    speed = rate(HEIGHT, along)
    d.notation({"u": HEIGHT}, along)
    d.step(
        "The square of the rate of the height $u$ equals the cubic polynomial.",
        speed**2,
        cubic(HEIGHT),
        because=r"$u - u_1$, $u_2 - u$ and $u_3 - u$ are the squares of sn, cn and dn, times constants",
        relations=squares(PARAMETER),
        named=r"\dot u^2",
        display=r"\frac{2 W c_3}{A} (u - u_1)(u - u_2)(u - u_3)",
    )
    d.step(
        "The acceleration of the height $u$ is half the derivative of the cubic polynomial, as it must be. This "
        "excludes a solution whose height stays at a zero of the polynomial.",
        rate(speed, along),
        cubic(u).diff(u).subs(u, HEIGHT) / 2,
        because="the previous step is differentiated and divided by $\\dot u$; the result is proven separately",
        relations=squares(PARAMETER),
        named=r"\ddot u",
        display=r"\frac{W c_3}{A} \frac{\partial}{\partial u} (u - u_1)(u - u_2)(u - u_3)",
    )


def _rates(d: Derivation) -> None:
    d.section("Precession and spin")
    u = cos(THETA)
    dphi = (P_PHI - P_PSI * u) / (A * sin(THETA) ** 2)
    dpsi = P_PSI / C - u * dphi
    rates = {r"\dot\phi": dphi, r"\dot\psi": dpsi}
    d.notation({r"p_\phi": P_PHI, r"p_\psi": P_PSI} | rates)
    d.step(
        "The sum and the difference of the rates of precession and spin have simpler forms: the sum is singular only "
        "if the axis points straight down, the difference only if it points straight up.",
        Matrix([dphi + dpsi, dphi - dpsi]),
        Matrix(
            [
                (P_PHI + P_PSI) / (A * (1 + u)) + P_PSI * (1 / C - 1 / A),
                (P_PHI - P_PSI) / (A * (1 - u)) - P_PSI * (1 / C - 1 / A),
            ]
        ),
        because=r"the rate is split into partial fractions in $\cos\theta$",
        named=r"\begin{bmatrix} \dot\phi + \dot\psi \\ \dot\phi - \dot\psi \end{bmatrix}",
    )
    d.step(
        "The rate of precession alone is singular if the axis points straight up or straight down.",
        dphi,
        (P_PHI + P_PSI) / (2 * A * (1 + u)) + (P_PHI - P_PSI) / (2 * A * (1 - u)),
        because=r"$\dot\phi$ is half the sum of the two rates",
        named=r"\dot\phi",
    )


def _attitude(d: Derivation) -> None:
    d.section("The attitude")
    plus, minus = (PHI + PSI) / 2, (PHI - PSI) / 2
    quaternion = (
        cos(THETA / 2) * cos(plus),
        sin(THETA / 2) * cos(minus),
        sin(THETA / 2) * sin(minus),
        cos(THETA / 2) * sin(plus),
    )
    d.passage(
        r"Two complex numbers (Cayley, Klein) describe the attitude: $\alpha = \cos\tfrac\theta2\,e^{i (\phi + "
        r"\psi)/2}$ and $\beta = \sin\tfrac\theta2\,e^{i (\phi - \psi)/2}$. The quaternion is $(\mathrm{Re}\,\alpha, "
        r"\mathrm{Re}\,\beta, \mathrm{Im}\,\beta, \mathrm{Im}\,\alpha)$."
    )
    turns = {f"R_{n}": lambda angle, axis=axis: elementary_rotation(axis, angle) for n, axis in ((1, "X"), (3, "Z"))}
    d.notation({"R": quaternion_to_dcm, "q": Matrix(quaternion)} | turns)
    d.step(
        r"The quaternion of $\alpha$ and $\beta$ gives the rotation of the Euler angles ZXZ.",
        quaternion_to_dcm(quaternion),
        dcm("ZXZ"),
        because="cosine and sine of each angle follow from those of its half",
        named=r"R(q)",
        display=r"R_3(\phi)\,R_1(\theta)\,R_3(\psi)",
    )
    du = symbols.dtheta * -sin(THETA)
    u = cos(THETA)
    logarithm = Matrix([rate(cos(THETA / 2), {THETA: symbols.dtheta}) / cos(THETA / 2),
                        rate(sin(THETA / 2), {THETA: symbols.dtheta}) / sin(THETA / 2)])  # fmt: skip
    d.notation({"u": u, r"\dot u": du})
    d.step(
        r"The rates of the logarithms of $|\alpha|$ and $|\beta|$ follow from the height $u = \cos\theta$.",
        logarithm,
        Matrix([du / (2 * (1 + u)), -du / (2 * (1 - u))]),
        because=r"$\cos^2 \tfrac\theta2 = \tfrac12 (1 + u)$, $\sin^2 \tfrac\theta2 = \tfrac12 (1 - u)$",
        named=r"\frac{d}{dt} \begin{bmatrix} \ln |\alpha| \\ \ln |\beta| \end{bmatrix}",
        display=r"\begin{bmatrix} \frac{\dot u}{2 (1 + u)} \\ -\frac{\dot u}{2 (1 - u)} \end{bmatrix}",
    )


def _theta(d: Derivation) -> None:
    d.section("The attitude without an integral")
    s, c, dn = W_VALUES
    at_sum, c_sum, d_sum = shifted()
    names = {r"\mathrm{sn}": SN, r"\mathrm{cn}": CN, r"\mathrm{dn}": DN, r"\mathrm{sn}_w": s}
    d.notation(
        names | {r"\mathrm{sn}(u + w)": at_sum, r"\mathrm{cn}(u + w)": c_sum, r"\mathrm{dn}(u + w)": d_sum, r"\mu": MU}
    )
    d.passage(
        r"By the [theta functions](elliptic_functions_appendix.md), the quotient $\mathrm{H}(u + w) / \Theta(u)$ has "
        r"the logarithmic derivative $Z(u + w) + \frac{\mathrm{cn}\,\mathrm{dn}}{\mathrm{sn}}(u + w) - Z(u)$. In this "
        r"section $u$ is the argument $p\,t$. The addition theorem of $Z$ turns the derivative into $Z(w)$ plus the "
        "following expression."
    )
    d.step(
        "This expression is a fraction with one denominator.",
        c_sum * d_sum / at_sum - MU * s * SN * at_sum,
        (SN * CN * DN - s * c * dn) / (SN**2 - s**2),
        because="the addition theorems are substituted",
        relations=[*squares(), *squares(fixed=True)],
        named=r"\frac{\mathrm{cn}(u + w)\,\mathrm{dn}(u + w)}{\mathrm{sn}(u + w)} - \mu\,\mathrm{sn}_w\,\mathrm{sn}\,"
        r"\mathrm{sn}(u + w)",
    )
    along = derivatives(SPEED, PARAMETER)
    cases = (
        (r"\alpha", 1, -(1 + U1) / (U2 - U1), (1 + U2) / (U2 - U1), (1 + U3) / (U3 - U1), SUM, "+"),
        (r"\beta", -1, (1 - U1) / (U2 - U1), -(1 - U2) / (U2 - U1), (U3 - 1) / (U3 - U1), DIFFERENCE, "-"),
    )
    d.notation({"p": SPEED, "u": HEIGHT, r"\dot u": rate(HEIGHT, along), r"\mu": PARAMETER, "i": I, "A": A})
    d.notation({r"p_\phi": (SUM + DIFFERENCE) / 2, r"p_\psi": (SUM - DIFFERENCE) / 2})
    for name, side, s2, c2, d2, momentum, sign in cases:
        d.notation({r"\mathrm{sn}_w": sqrt(s2), r"\mathrm{cn}_w": sqrt(c2), r"\mathrm{dn}_w": sqrt(d2)})
        d.step(
            rf"For ${name}$, choose $w$ so that $\mathrm{{sn}}_w^2 = {formula(s2)}$. Where $\mathrm{{sn}} = "
            rf"\mathrm{{sn}}_w$, $1 {sign} u$ is zero. Then $\mathrm{{cn}}_w^2$ and $\mathrm{{dn}}_w^2$ have the "
            "following values.",
            Matrix([1 - s2, 1 - PARAMETER * s2]),
            Matrix([c2, d2]),
            because="the two quadratic relations between sn, cn and dn are substituted",
            named=r"\begin{bmatrix} 1 - \mathrm{sn}_w^2 \\ 1 - \mu\,\mathrm{sn}_w^2 \end{bmatrix}",
        )
        d.step(
            rf"For ${name}$, the denominator $\mathrm{{sn}}^2 - \mathrm{{sn}}_w^2$ is proportional to $1 {sign} u$.",
            (U2 - U1) * (SN**2 - s2),
            side * (1 + side * HEIGHT),
            because="$u = u_1 + (u_2 - u_1)\\,\\mathrm{sn}^2$",
            named=r"(u_2 - u_1) \left( \mathrm{sn}^2 - \mathrm{sn}_w^2 \right)",
            display="1 + u" if side == 1 else "-(1 - u)",
        )
        d.step(
            rf"The real part of the logarithmic derivative of $\mathrm{{H}}(u + w) / \Theta(u)$ is the rate of $\ln "
            rf"|{name}|$.",
            SPEED * SN * CN * DN / (SN**2 - s2),
            side * rate(HEIGHT, along) / (2 * (1 + side * HEIGHT)),
            because=r"$\dot u = 2 (u_2 - u_1)\,p\,\mathrm{sn}\,\mathrm{cn}\,\mathrm{dn}$",
            named=r"p\,\frac{\mathrm{sn}\,\mathrm{cn}\,\mathrm{dn}}{\mathrm{sn}^2 - \mathrm{sn}_w^2}",
            display=r"\frac{\dot u}{2 (1 + u)}" if side == 1 else r"-\frac{\dot u}{2 (1 - u)}",
        )
        d.step(
            r"The imaginary part of the logarithmic derivative of $\mathrm{H}(u + w) / \Theta(u)$ is, up to a "
            rf"constant, the rate of $\tfrac12 (\phi {sign} \psi)$, if the sign of $w$ is chosen so that "
            r"$\mathrm{sn}_w \mathrm{cn}_w \mathrm{dn}_w = "
            rf"\mp i\,\frac{{p_\phi {sign} p_\psi}}{{2 A\,p\,(u_2 - u_1)}}$.",
            s2 * c2 * d2,
            (I * momentum / (2 * A * SPEED * (U2 - U1))) ** 2,
            because=r"$p$ and the momenta are substituted in terms of the zeros",
            relations=[imaginary()],
            named=r"\mathrm{sn}_w^2\,\mathrm{cn}_w^2\,\mathrm{dn}_w^2",
            display=rf"\left( \frac{{i\,(p_\phi {sign} p_\psi)}}{{2 A\,p\,(u_2 - u_1)}} \right)^2",
        )
    d.passage(
        r"So $\alpha$ and $\beta$ are constants times $e^{i \kappa t}\,\mathrm{H}(p\,t + w) / \Theta(p\,t)$, each "
        r"with its own $w$ and $\kappa$: their logarithmic derivatives differ from those of the quotients only by "
        r"constants $i \kappa$, which contain $p\,Z(w)$ and $\pm \tfrac12 p_\psi (1/C - 1/A)$. The formulas are "
        "regular for every direction of the axis, including the vertical."
    )
