"""The free body on the separatrix, with its attitude (Landau & Lifshitz, Mechanics, 3rd ed., section 37)."""

from sympy import Expr, Integer, Matrix, Rational, Symbol, atan, cos, diag, sin, tanh

from symrot import symbols
from symrot.catalogue.exact_motions.free_body_attitude import T, rotation_rate, smallest_rotation
from symrot.catalogue.tools.motion import pairs, rate, squared
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

A, _, C = symbols.principal
H, SIGN = symbols.H, symbols.sigma
ONE, _, THREE = symbols.momentum_amplitudes
P, TIME, PSI = symbols.p, symbols.t, symbols.psi
MIDDLE = A * C * (ONE**2 + THREE**2) / (C * ONE**2 + A * THREE**2)
"""Formula of the intermediate moment B on the separatrix, from H^2 = 2 T B and the momentum at t = 0."""
SPEED = SIGN * THREE * (C - MIDDLE) / (MIDDLE * C) * H / ONE
RELATIONS = [H**2 - ONE**2 - THREE**2, SIGN**2 - 1]
HALF_TANH = Symbol("h")
"""Symbol for the function h = tanh(p t/2) of time, with p in 1/s; the angular momentum is a rational function of h."""


def derive() -> Derivation:
    d = Derivation(
        "free_body_separatrix",
        title="The free body on the separatrix",
        source="Landau & Lifshitz, *Mechanics*, 3rd ed., section 37; van Zon & Schofield, *J. Comput. Phys.* 225 "
        "(2007) 145",
        about=(
            "If $H^2 = 2 T B$, the body leaves a steady rotation about its intermediate axis and approaches the "
            "opposite steady rotation. Angular velocity and attitude are elementary functions of time."
        ),
    )
    h = HALF_TANH
    d.passage(
        "The page on [the attitude](free_body_attitude.md) explains the notation: at $t = 0$, halfway through the "
        r"motion, the angular momentum has the components $\ell_1, 0, \ell_3$ with $H^2 = \ell_1^2 + \ell_3^2$. On "
        "the separatrix these components determine the intermediate moment:",
        ("B", MIDDLE),
        ("p", r"\sigma\,\frac{C - B}{B C}\,\frac{H\,\ell_3}{\ell_1}"),
    )
    d.section("Angular momentum in the body")
    d.passage(
        "All quantities are rational functions of one hyperbolic tangent:",
        ("h", tanh(P * TIME / 2)),
        (r"\tanh p\,t", r"\frac{2 h}{1 + h^2}"),
        (r"\mathrm{sech}\,p\,t", r"\frac{1 - h^2}{1 + h^2}"),
        ("L", r"\begin{bmatrix} \ell_1\,\mathrm{sech}\,p\,t \\ \sigma H \tanh p\,t \\ \ell_3\,\mathrm{sech}\,p\,t "
              r"\end{bmatrix}"),
    )  # fmt: skip
    momentum = _momentum()
    tensor = diag(A, MIDDLE, C)
    omega = tensor.inv() * momentum
    d.notation({"p": P, "h": tanh(P * TIME / 2)}, {TIME: Integer(1)})
    d.step(
        "The derivative of $h$ is:",
        tanh(P * TIME / 2).diff(TIME),
        P / 2 * (1 - tanh(P * TIME / 2) ** 2),
        because=r"$\tanh' = 1 - \tanh^2$",
        named=r"\dot h",
        display=r"\tfrac{p}{2} \left( 1 - h^2 \right)",
    )
    rising, falling = 2 * h / (1 + h**2), (1 - h**2) / (1 + h**2)
    d.notation({"h": h, r"\tanh p\,t": rising, r"\mathrm{sech}\,p\,t": falling}, _share(P))
    d.step(
        r"The fractions equal $\tanh p\,t$ and $\mathrm{sech}\,p\,t$: they have the same derivatives as these "
        "functions, and the same values at $t = 0$.",
        rate(Matrix([rising, falling]), _share(P)),
        P * Matrix([falling**2, -rising * falling]),
        because=r"$\dot h = \tfrac{p}{2} (1 - h^2)$",
        named=r"\frac{d}{dt} \begin{bmatrix} \tanh p\,t \\ \mathrm{sech}\,p\,t \end{bmatrix}",
        display=r"p \begin{bmatrix} \mathrm{sech}^2\,p\,t \\ -\tanh p\,t\;\mathrm{sech}\,p\,t \end{bmatrix}",
    )
    d.notation({"p": SPEED, "L": momentum, r"\omega": omega, "B": MIDDLE, "H": H}, _share(SPEED))
    d.step(
        "This $L$ satisfies Euler's equations.",
        rate(momentum, _share(SPEED)),
        momentum.cross(omega),
        because="$B$ and $p$ are substituted",
        relations=RELATIONS,
        named=r"\dot L",
        display=r"L \times \omega",
    )
    d.step(
        "The length of the angular momentum and the energy are constant, and $H^2 = 2 T B$.",
        Matrix([squared(momentum), momentum.dot(omega) * MIDDLE]),
        Matrix([H**2, H**2]),
        because=r"$\tanh^2 + \mathrm{sech}^2 = 1$",
        relations=RELATIONS,
        named=r"\begin{bmatrix} L \cdot L \\ B\,L \cdot \omega \end{bmatrix}",
    )
    d.step(
        r"For $t \to \pm\infty$ the angular momentum in the body is along the intermediate axis, in opposite "
        "directions.",
        Matrix([momentum.subs(h, 1), momentum.subs(h, -1)]),
        SIGN * H * Matrix([0, 1, 0, 0, -1, 0]),
        because=r"$h \to \pm 1$",
        named=r"\begin{bmatrix} L(\infty) \\ L(-\infty) \end{bmatrix}",
    )
    _attitude(d, momentum, omega)
    return d


def _momentum() -> Matrix:
    h = HALF_TANH
    return Matrix([ONE * (1 - h**2), SIGN * H * 2 * h, THREE * (1 - h**2)]) / (1 + h**2)


def _attitude(d: Derivation, momentum: Matrix, omega: Matrix) -> None:
    d.section("The attitude")
    h = HALF_TANH
    values = pairs(symbols.momentum_b, momentum)
    speed = rotation_rate().subs(T, momentum.dot(omega) / 2).subs(values)
    about = Matrix([[cos(PSI), -sin(PSI), 0], [sin(PSI), cos(PSI), 0], [0, 0, 1]])
    d.notation(
        {"T": momentum.dot(omega) / 2, "L_1": momentum[0], "L_3": momentum[2], r"\omega_3": omega[2], r"\sigma": SIGN}
    )
    d.step(
        "The rotation about the angular momentum has the rate:",
        speed,
        H / MIDDLE - SIGN * SPEED * momentum[0] / (H + momentum[2]),
        because=r"$2 T = H^2 / B$",
        relations=RELATIONS,
        named=r"\dot\psi = \frac{2 T + H\,\omega_3}{H + L_3}",
        display=r"\frac{H}{B} - \sigma\,p\,\frac{L_1}{H + L_3}",
    )
    d.notation({"p": P}, {TIME: Integer(1)} | _share(P))
    turned = H / MIDDLE * TIME - 2 * SIGN * atan(ONE * h / (H + THREE))
    d.step(
        r"The angle $\psi$ of the rotation about the angular momentum is the sum of a part that grows at a constant "
        "rate and an arctangent, which changes by a finite amount during the whole motion.",
        rate(turned, {TIME: Integer(1)} | _share(P)),
        H / MIDDLE - SIGN * P * momentum[0] / (H + momentum[2]),
        because=r"$H^2 - \ell_3^2 = \ell_1^2$",
        relations=RELATIONS,
        named=r"\frac{d}{dt} \left( \frac{H}{B}\,t - 2 \sigma \arctan \frac{\ell_1\,h}{H + \ell_3} \right)",
        display=r"\frac{H}{B} - \sigma\,p\,\frac{L_1}{H + L_3}",
    )
    rotation = about * smallest_rotation().subs(values)
    d.notation(
        {"R": rotation, "p": SPEED}, _share(SPEED) | {PSI: H / MIDDLE - SIGN * SPEED * momentum[0] / (H + momentum[2])}
    )
    d.step(
        r"The attitude $R = R_3(\psi)\,P$ with this angle $\psi$ satisfies the equation of the attitude, in all nine "
        "entries.",
        rate(rotation, _share(SPEED) | {PSI: H / MIDDLE - SIGN * SPEED * momentum[0] / (H + momentum[2])}),
        rotation * skew(omega),
        because="the rates of the previous steps are substituted",
        relations=RELATIONS,
        named=r"\dot R",
        display=r"R\,[\omega]_\times",
    )


def _share(speed: Expr) -> dict[Symbol, Expr]:
    """Return a map from the symbol h = tanh(p t/2) to its time derivative, for the frequency p = ``speed``."""
    return {HALF_TANH: speed * (1 - HALF_TANH**2) * Rational(1, 2)}
