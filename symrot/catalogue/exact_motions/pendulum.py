"""Physical and spherical pendulum (Whittaker, Analytical Dynamics, 4th ed., sections 44 and 55)."""

from sympy import Expr, Integer, Matrix, Rational, Symbol, sech, sqrt, tanh

from symrot import symbols
from symrot.catalogue.exact_motions.heavy_top_motion import HEIGHT, PARAMETER, SPEED, U1, U2, U3, cubic
from symrot.catalogue.tools.elliptic import CN, DN, MU, SN, derivatives, squares
from symrot.catalogue.tools.motion import rate
from symrot.proof.derivation import Derivation

A, W, ARM, T, P = symbols.A, symbols.W, symbols.c_3, symbols.t, symbols.p
THETA, P_PHI = symbols.theta, symbols.p_phi


def derive() -> Derivation:
    d = Derivation(
        "pendulum",
        title="Physical and spherical pendulum",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 14; Whittaker, *Analytical Dynamics*, 4th ed., "
        "sections 44 and 55",
        about=(
            r"A [heavy top](heavy_top_motion.md) with $p_\psi = 0$ (no spin) is a spherical pendulum. Without "
            "precession too, it is a pendulum in a plane. A plane pendulum oscillates, goes around, or approaches "
            "the highest position in an infinite time."
        ),
    )
    _plane(d)
    _spherical(d)
    _turning(d)
    return d


def _plane(d: Derivation) -> None:
    d.section("The plane pendulum")
    d.passage(
        r"Let $\theta$ be the angle from the lowest position, $A$ the moment of inertia about the axis, $W c_3$ the "
        r"weight times its arm, and $p^2 = W c_3 / A$. The equation of motion is $\ddot\theta = -p^2 \sin\theta$. Let "
        r"$s = \sin\tfrac\theta2$ and $c = \cos\tfrac\theta2$, so that $\dot s = \tfrac12 \dot\theta\,c$, $\dot c = "
        r"-\tfrac12 \dot\theta\,s$ and $\sin\theta = 2 s c$."
    )
    root = sqrt(MU)
    motions = (
        (
            r"Oscillation with the amplitude $2 \arcsin\sqrt\mu$: $s = \sqrt\mu\,\mathrm{sn}(p\,t)$, $c = "
            r"\mathrm{dn}$, $\dot\theta = 2 p \sqrt\mu\,\mathrm{cn}$.",
            (root * SN, DN, 2 * P * root * CN),
            derivatives(P),
            squares(),
        ),
        (
            r"Full rotation: $s = \mathrm{sn}(p\,t / \sqrt\mu)$, $c = \mathrm{cn}$, $\dot\theta = 2 p\,\mathrm{dn} / "
            r"\sqrt\mu$.",
            (SN, CN, 2 * P / root * DN),
            derivatives(P / root),
            squares(),
        ),
    )
    for claim, motion, along, relations in motions:
        _holds(d, claim, motion, along, relations)
    _holds(
        d,
        r"The limiting case, $\mu = 1$: $s = \tanh p\,t$, $c = \mathrm{sech}\,p\,t$, $\dot\theta = 2 "
        r"p\,\mathrm{sech}\,p\,t$. The pendulum approaches the highest position in an infinite time.",
        (tanh(P * T), sech(P * T), 2 * P * sech(P * T)),
        {T: Integer(1)},
        [tanh(P * T) ** 2 + sech(P * T) ** 2 - 1],
    )
    d.step(
        r"The energy of an oscillation, measured from the lowest position, is the fraction $\mu$ of the energy $2 W "
        "c_3$ that is needed to reach the top.",
        A * (2 * P * root * CN) ** 2 / 2 + 2 * A * P**2 * (root * SN) ** 2,
        2 * A * P**2 * MU,
        because=r"$1 - \cos\theta = 2 s^2$",
        relations=squares(),
        named=r"\tfrac12 A\,\dot\theta^2 + W c_3 (1 - \cos\theta)",
        display=r"2 W c_3\,\mu",
    )


def _holds(
    d: Derivation, claim: str, motion: tuple[Expr, ...], along: dict[Symbol, Expr], hypotheses: list[Expr]
) -> None:
    """Add to the derivation ``d`` the step with the text ``claim``: a motion satisfies the equations of a pendulum.

    ``motion`` gives the sine and cosine of half the angle, and the angular rate, in symbols whose time derivatives are
    ``along``; ``hypotheses`` are expressions in these symbols that are zero.
    """
    s, c, speed = motion
    half = Rational(1, 2)
    d.notation({"s": s, "c": c, r"\dot\theta": speed, r"\ddot\theta": rate(speed, along), "p": P}, along)
    d.step(
        claim,
        rate(Matrix([s, c, speed]), along),
        Matrix([half * speed * c, -half * speed * s, -2 * P**2 * s * c]),
        because="the derivatives of these functions are known, and the chain rule adds the rate of their argument",
        relations=hypotheses,
        named=r"\begin{bmatrix} \dot s \\ \dot c \\ \ddot\theta \end{bmatrix}",
        display=r"\begin{bmatrix} \tfrac12 \dot\theta\,c \\ -\tfrac12 \dot\theta\,s \\ -2 p^2 s\,c \end{bmatrix}",
    )


def _turning(d: Derivation) -> None:
    d.section("The pendulum as a heavy top")
    flat = {U1: -1, U3: 1}
    d.notation({"u": symbols.gamma_3, r"\dot u": sqrt(cubic(symbols.gamma_3).subs(flat))})
    d.step(
        "If both momenta are zero, the cubic polynomial of the [heavy top](heavy_top_motion.md) has the zeros $-1$, "
        "$1$ and the largest height $u_2$.",
        cubic(symbols.gamma_3).subs(flat),
        2 * W * ARM / A * (U2 - symbols.gamma_3) * (1 - symbols.gamma_3**2),
        because="$1 - u^2$ is a common factor",
        named=r"\dot u^2",
        display=r"\frac{2 W c_3}{A} (u_2 - u)(1 - u^2)",
    )
    d.notation({"u": HEIGHT.subs(flat), r"\mu": PARAMETER.subs(flat), "p": SPEED.subs(flat)})
    d.step(
        r"The heavy top then has the solution of the pendulum: with $u = -\cos\theta$, where $\theta$ is the angle "
        r"from the lowest position, $\sin^2\tfrac\theta2$ is $\mu\,\mathrm{sn}^2$.",
        (1 + HEIGHT.subs(flat)) / 2,
        PARAMETER.subs(flat) * SN**2,
        because=r"$1 - \cos\theta = 2 \sin^2 \tfrac\theta2$",
        named=r"\tfrac12 (1 + u)",
        display=r"\mu\,\mathrm{sn}^2",
    )
    d.step(
        "The frequency $p$ is the same.",
        SPEED.subs(flat) ** 2,
        W * ARM / A,
        because="$u_3 - u_1 = 2$",
        named="p^2",
    )


def _spherical(d: Derivation) -> None:
    d.section("The spherical pendulum")
    u = symbols.gamma_3
    highest = -(1 + U1 * U2) / (U1 + U2)
    d.passage(
        r"If $p_\psi = 0$ but $p_\phi \ne 0$, the pendulum moves around the vertical, and its height oscillates "
        "between $u_1$ and $u_2$, measured from the support. These two heights give the third zero of the "
        "cubic polynomial of the [heavy top](heavy_top_motion.md):",
        ("u_3", highest),
    )
    d.nonzero("The two heights are not both zero,", U1 + U2, "u_1 + u_2")
    d.notation({"u": u})
    square = -2 * A * W * ARM * (1 - U1**2) * (1 - U2**2) / (U1 + U2)
    energy = 2 * W * ARM * (U1 + U2 + highest)
    d.notation({"E": energy / 2, r"p_\phi": sqrt(square)})
    d.step(
        r"The cubic polynomial in $u$ that energy and momentum determine has the zeros $u_1$, $u_2$ and $u_3$ if "
        r"$p_\phi^2$ has the value below.",
        energy * (1 - u**2) / A - 2 * W * ARM * u * (1 - u**2) / A - square / A**2,
        cubic(u).subs(U3, highest),
        because=r"$u_1 u_2 + u_2 u_3 + u_3 u_1 = -1$",
        named=r"\frac{2}{A} (E - W c_3 u)(1 - u^2) - \frac{p_\phi^2}{A^2}",
        display=r"\frac{2 W c_3}{A} (u - u_1)(u - u_2)(u - u_3)",
    )
    d.step(
        r"The square of $p_\phi$ cannot be negative, so $u_1 + u_2 \le 0$: the mean of the heights $u_1$ and $u_2$ is "
        "not above the support.",
        square * (U1 + U2),
        -2 * A * W * ARM * (1 - U1**2) * (1 - U2**2),
        because="$1 - u^2$ is not negative",
        named=r"p_\phi^2\,(u_1 + u_2)",
    )
    d.step(
        "If the heights $u_1$ and $u_2$ are equal, the pendulum moves on a cone. The square of its rate about the "
        "vertical is then:",
        square.subs(U2, U1) / (A * (1 - U1**2)) ** 2,
        -W * ARM / (A * U1),
        because=r"$\dot\phi = p_\phi / (A \sin^2\theta)$",
        named=r"\dot\phi^2",
    )
