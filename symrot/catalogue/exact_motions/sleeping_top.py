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
"""tanh(p t)"""


def derive() -> Derivation:
    d = Derivation(
        "sleeping_top",
        title="The top at the vertical",
        source="Klein & Sommerfeld, *The Theory of the Top*, vol. 2, chapters 4 and 6; Goldstein, Poole & Safko, "
        "*Classical Mechanics*, 3rd ed., section 5.7",
        about=(
            "A [heavy top](heavy_top_motion.md) whose momenta agree passes through the vertical, or comes to it after "
            "an infinite time. Neither is a singularity of its attitude."
        ),
    )
    _through(d)
    _separatrix(d)
    return d


def _through(d: Derivation) -> None:
    d.section("Through the vertical")
    d.step(
        r"The top can be upright, $u_2 = 1$ or $u_3 = 1$, only if $p_\phi = p_\psi$, and upside down, $u_1 = -1$, only "
        r"if $p_\phi = -p_\psi$.",
        Matrix([DIFFERENCE.subs(U2, 1), DIFFERENCE.subs(U3, 1), SUM.subs(U1, -1)]),
        0,
        because="the momenta are written in terms of the three zeros",
        named=r"\begin{bmatrix} p_\phi - p_\psi |_{u_2 = 1} \\ p_\phi - p_\psi |_{u_3 = 1} \\ "
        r"p_\phi + p_\psi |_{u_1 = -1} \end{bmatrix}",
    )
    d.step(
        r"Started upright with too little spin, $u_2 = 1$: $\sin\tfrac\theta2$ is an elliptic cosine, which goes "
        r"through zero and changes its sign there.",
        (1 - HEIGHT.subs(U2, 1)) / 2,
        (sqrt((1 - U1) / 2) * CN) ** 2,
        because=r"$1 - \mathrm{sn}^2 = \mathrm{cn}^2$",
        relations=squares(),
        named=r"\sin^2 \tfrac\theta2 = \tfrac12 (1 - u)",
        display=r"\left( \sqrt{\tfrac12 (1 - u_1)}\,\mathrm{cn} \right)^2",
    )
    d.step(
        "Hanging upside down at times, $u_1 = -1$: then $\\cos\\tfrac\\theta2$ is an elliptic sine.",
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
        "It passes the vertical with a finite speed: its square there,",
        rate(sine, along).subs({SN: 1, CN: 0}) ** 2,
        W * ARM * (1 - U1) * (U3 - 1) / (4 * A),
        because=r"$\mathrm{sn} = 1$, $\mathrm{cn} = 0$",
        relations=[DN**2 - 1 + PARAMETER.subs(upright)],
        named=r"\left. \left( \frac{d}{dt} \sin\tfrac\theta2 \right)^2 \right|_{u = 1}",
    )
    d.passage(
        r"and $\phi - \psi$ changes at a constant rate, by the [partial fractions](heavy_top_motion.md), since "
        r"$p_\phi = p_\psi$. With a signed $\sin\tfrac\theta2$ the attitude is smooth."
    )


def _separatrix(d: Derivation) -> None:
    d.section("The sleeping top's separatrix")
    lowest = U1
    h = TURN
    height = 1 - (1 - lowest) * (1 - h**2)
    both = {U2: Integer(1), U3: Integer(1)}
    speed = SPEED.subs(both)
    d.passage(
        r"Where $u_2 = u_3 = 1$ the parameter $\mu$ is 1, and the motion is elementary. All of it is in one hyperbolic "
        "tangent:",
        ("h", tanh(P * T)),
    )
    d.step(
        r"The hyperbolic tangent changes at the rate $p\,(1 - h^2)$.",
        tanh(P * T).diff(T),
        P * (1 - tanh(P * T) ** 2),
        because=r"$\tanh' = 1 - \tanh^2$",
        named=r"\dot h",
        display=r"p \left( 1 - h^2 \right)",
    )
    d.passage(
        "The top rises from $u_1$, with",
        ("p", speed),
        ("u", r"1 - (1 - u_1)(1 - h^2) = 1 - (1 - u_1)\,\mathrm{sech}^2\,p\,t"),
    )
    along = {h: speed * (1 - h**2)}
    d.notation({"u": height, "h": h}, along)
    d.step(
        "The height has the rate that the cubic asks for.",
        rate(height, along) ** 2,
        cubic(height).subs(both),
        because="$u - 1$ is a double factor of the cubic",
        named=r"\dot u^2",
        display=r"\frac{2 W c_3}{A} (u - u_1)(u - 1)^2",
    )
    d.step(
        "It has its acceleration too.",
        rate(rate(height, along), along),
        cubic(symbols.gamma_3).diff(symbols.gamma_3).subs(both).subs(symbols.gamma_3, height) / 2,
        because="the acceleration of the height is half the derivative of the cubic",
        named=r"\ddot u",
        display=r"\frac{W c_3}{A} \frac{\partial}{\partial u} (u - u_1)(u - 1)^2",
    )
    momentum = SUM.subs(both) / 2
    d.notation({r"p_\psi": momentum}, {T: Integer(1)})
    turned = momentum / (2 * A) * T + atan(2 * A * speed / momentum * h)
    d.step(
        r"Both momenta are equal, and less than the [bound](heavy_top.md) $p_\psi^2 = 4 A W c_3$ of sleep, which they "
        r"reach for $u_1 \to 1$.",
        momentum**2,
        2 * A * W * ARM * (1 + lowest),
        because="the double zero is substituted",
        named=r"p_\psi^2",
    )
    d.step(
        "Precession: even growth, and one step of an arctangent on the way up and down.",
        rate(turned, along | {T: Integer(1)}),
        momentum / (A * (1 + height)),
        because=r"$1 + u = 1 + u_1 + (1 - u_1)\,h^2$",
        named=r"\frac{d}{dt} \left( \frac{p_\psi}{2 A}\,t + \arctan \frac{2 A\,p\,h}{p_\psi} "
        r"\right)",
        display=r"\frac{p_\psi}{A (1 + u)}",
    )
    d.step(
        "The half angle is a hyperbolic secant: the axis goes back the way it came, and does not pass the vertical.",
        (1 - height) / 2,
        (1 - lowest) / 2 * (1 - h**2),
        because="$1 - u$ is substituted",
        named=r"\sin^2 \tfrac\theta2",
        display=r"\tfrac12 (1 - u_1)\,\mathrm{sech}^2\,p\,t",
    )
