"""Heavy tops that pass through the vertical, and a top whose axis approaches the vertical (it falls asleep).

Klein & Sommerfeld, Theory of the Top, vol. 2, chapters 4 and 6.
"""

from sympy import Integer, Matrix, Symbol, atan, sqrt, tanh

from symrot import symbols
from symrot.catalogue.exact_motions.heavy_top_motion import DIFFERENCE, HEIGHT, PARAMETER, SPEED, SUM, U1, U2, U3, cubic
from symrot.catalogue.tools.elliptic import CN, DN, SN, derivatives, squares
from symrot.catalogue.tools.motion import rate
from symrot.proof.derivation import Derivation

A, C, W, ARM, T, P = symbols.A, symbols.C, symbols.W, symbols.c_3, symbols.t, symbols.p
TURN = Symbol("h")
"""Symbol for the function of time h = tanh(p t), with the rate p in 1/s at which the axis approaches the vertical."""


def derive() -> Derivation:
    d = Derivation(
        "sleeping_top",
        title="The top at the vertical",
        source="Klein & Sommerfeld, *The Theory of the Top*, vol. 2, chapters 4 and 6; Goldstein, Poole & Safko, "
        "*Classical Mechanics*, 3rd ed., section 5.7",
        about=(
            "If the axis of a [heavy top](heavy_top_motion.md) passes through the upward vertical, or approaches it in "
            "an infinite time, then its two momenta are equal. The attitude is regular in both cases."
        ),
    )
    _through(d)
    _separatrix(d)
    _precession(d)
    return d


def _through(d: Derivation) -> None:
    d.section("Through the vertical")
    d.step(
        r"The axis can point up, $u_2 = 1$ or $u_3 = 1$, only if $p_\phi = p_\psi$. It can point down, $u_1 = -1$, "
        r"only if $p_\phi = -p_\psi$.",
        Matrix([DIFFERENCE.subs(U2, 1), DIFFERENCE.subs(U3, 1), SUM.subs(U1, -1)]),
        0,
        because="the momenta are written in terms of the three zeros",
        named=r"\begin{bmatrix} p_\phi - p_\psi |_{u_2 = 1} \\ p_\phi - p_\psi |_{u_3 = 1} \\ "
        r"p_\phi + p_\psi |_{u_1 = -1} \end{bmatrix}",
    )
    d.step(
        r"If the axis passes through the upward vertical, then $u_2 = 1$, and $\sin\tfrac\theta2$ is proportional to "
        "cn. It changes its sign when the axis passes through the vertical.",
        (1 - HEIGHT.subs(U2, 1)) / 2,
        (sqrt((1 - U1) / 2) * CN) ** 2,
        because=r"$1 - \mathrm{sn}^2 = \mathrm{cn}^2$",
        relations=squares(),
        named=r"\sin^2 \tfrac\theta2 = \tfrac12 (1 - u)",
        display=r"\left( \sqrt{\tfrac12 (1 - u_1)}\,\mathrm{cn} \right)^2",
    )
    d.step(
        r"If the axis points down at times, then $u_1 = -1$, and $\cos\tfrac\theta2$ is proportional to sn.",
        (1 + HEIGHT.subs(U1, -1)) / 2,
        (sqrt((1 + U2) / 2) * SN) ** 2,
        because=r"$u = -1 + (1 + u_2)\,\mathrm{sn}^2$",
        named=r"\cos^2 \tfrac\theta2 = \tfrac12 (1 + u)",
        display=r"\left( \sqrt{\tfrac12 (1 + u_2)}\,\mathrm{sn} \right)^2",
    )
    upright = {U2: Integer(1)}
    along = derivatives(SPEED.subs(upright), PARAMETER.subs(upright))
    sine = sqrt((1 - U1) / 2) * CN
    d.step(
        "The axis passes through the upward vertical at a finite speed. The square of the rate of "
        r"$\sin\tfrac\theta2$ there is:",
        rate(sine, along).subs({SN: 1, CN: 0}) ** 2,
        W * ARM * (1 - U1) * (U3 - 1) / (4 * A),
        because=r"$\mathrm{sn} = 1$, $\mathrm{cn} = 0$",
        relations=[DN**2 - 1 + PARAMETER.subs(upright)],
        named=r"\left. \left( \frac{d}{dt} \sin\tfrac\theta2 \right)^2 \right|_{u = 1}",
    )
    d.passage(
        r"In this motion $\phi - \psi$ changes at a constant rate, as the [partial "
        r"fractions](heavy_top_motion.md) show for $p_\phi = p_\psi$. If $\sin\tfrac\theta2$ changes its sign "
        "whenever the axis passes through the vertical, as cn does, the attitude is a smooth function of time."
    )


def _separatrix(d: Derivation) -> None:
    d.section("The separatrix of the sleeping top")
    lowest = U1
    h = TURN
    height = 1 - (1 - lowest) * (1 - h**2)
    both = {U2: Integer(1), U3: Integer(1)}
    speed = SPEED.subs(both)
    d.passage(
        r"For $u_2 = u_3 = 1$ the parameter $\mu$ is 1, and the motion is elementary. All its functions depend on one "
        "hyperbolic tangent:",
        ("h", tanh(P * T)),
    )
    d.step(
        r"The derivative of the hyperbolic tangent $h$ is $p\,(1 - h^2)$.",
        tanh(P * T).diff(T),
        P * (1 - tanh(P * T) ** 2),
        because=r"$\tanh' = 1 - \tanh^2$",
        named=r"\dot h",
        display=r"p \left( 1 - h^2 \right)",
    )
    d.passage(
        "The axis rises from the height $u_1$ with",
        ("p", speed),
        ("u", r"1 - (1 - u_1)(1 - h^2) = 1 - (1 - u_1)\,\mathrm{sech}^2\,p\,t"),
    )
    along = {h: speed * (1 - h**2)}
    d.notation({"u": height, "h": h}, along)
    d.step(
        "The square of the rate of the height $u$ equals the cubic polynomial of the heavy top.",
        rate(height, along) ** 2,
        cubic(height).subs(both),
        because="$u - 1$ is a double factor of the cubic",
        named=r"\dot u^2",
        display=r"\frac{2 W c_3}{A} (u - u_1)(u - 1)^2",
    )
    momentum = SUM.subs(both) / 2
    d.notation({r"p_\psi": momentum}, {T: Integer(1)})
    d.step(
        r"Both momenta are equal. They are below the [bound](heavy_top.md) $p_\psi^2 = 4 A W c_3$ for a sleeping top, "
        r"and reach it in the limit $u_1 \to 1$.",
        momentum**2,
        2 * A * W * ARM * (1 + lowest),
        because="the double zero is substituted",
        named=r"p_\psi^2",
    )
    d.step(
        "The sine of half the nutation is proportional to a hyperbolic secant: the axis falls from near the vertical "
        "to the height $u_1$ at $t = 0$, then rises towards the vertical again, without reaching it in a finite time.",
        (1 - height) / 2,
        (1 - lowest) / 2 * (1 - h**2),
        because="$1 - u$ is substituted",
        named=r"\sin^2 \tfrac\theta2",
        display=r"\tfrac12 (1 - u_1)\,\mathrm{sech}^2\,p\,t",
    )


def _precession(d: Derivation) -> None:
    d.section("The acceleration of the height, and the angle of precession")
    lowest, h = U1, TURN
    height = 1 - (1 - lowest) * (1 - h**2)
    both = {U2: Integer(1), U3: Integer(1)}
    speed = SPEED.subs(both)
    along = {h: speed * (1 - h**2)}
    momentum = SUM.subs(both) / 2
    d.notation({"u": height, "h": h}, along)
    d.step(
        "The acceleration of the height $u$ is half the derivative of the cubic polynomial, as it must be.",
        rate(rate(height, along), along),
        cubic(symbols.gamma_3).diff(symbols.gamma_3).subs(both).subs(symbols.gamma_3, height) / 2,
        because=r"$\dot h = p\,(1 - h^2)$ is inserted twice",
        named=r"\ddot u",
        display=r"\frac{W c_3}{A} \frac{\partial}{\partial u} (u - u_1)(u - 1)^2",
    )
    d.notation({r"p_\psi": momentum}, {T: Integer(1)})
    turned = momentum / (2 * A) * T + atan(2 * A * speed / momentum * h)
    d.step(
        "The angle of precession is the sum of a part that grows at a constant rate and an arctangent.",
        rate(turned, along | {T: Integer(1)}),
        momentum / (A * (1 + height)),
        because=r"$1 + u = 1 + u_1 + (1 - u_1)\,h^2$",
        named=r"\frac{d}{dt} \left( \frac{p_\psi}{2 A}\,t + \arctan \frac{2 A\,p\,h}{p_\psi} "
        r"\right)",
        display=r"\frac{p_\psi}{A (1 + u)}",
    )
