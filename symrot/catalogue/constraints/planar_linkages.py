"""Planar linkages as constraints: slider-crank and four bars (Beer & Johnston, Dynamics, chapter 15)."""

from sympy import Expr, Matrix, Symbol, cos, sin, solve

from symrot import symbols
from symrot.catalogue.tools.motion import rate, squared
from symrot.proof.derivation import Derivation

PHI, THETA, PSI = symbols.angles
DPHI, DTHETA, DPSI = symbols.angle_rates
CRANK, ROD = symbols.r, symbols.L
MOTION = {PHI: DPHI, THETA: DTHETA, PSI: DPSI}


def _bar(length: Symbol, angle: Symbol) -> Matrix:
    return length * Matrix([cos(angle), sin(angle)])


def derive() -> Derivation:
    d = Derivation(
        "planar_linkages",
        title="Slider-crank and four bars",
        source="Beer, Johnston & Cornwell, *Vector Mechanics for Engineers: Dynamics*, chapter 15; Freudenstein, *ASME "
        "Transactions* 76 (1954)",
        about=(
            "The bars of a planar linkage form a closed polygon. The first time derivative of this condition gives "
            "linear equations for the angular rates, the second derivative for the angular accelerations."
        ),
    )
    _slider(d)
    _four_bars(d)
    return d


def _slider(d: Derivation) -> None:
    d.section("Slider-crank")
    closure = CRANK * sin(PHI) - ROD * sin(PSI)
    place = CRANK * cos(PHI) + ROD * cos(PSI)
    d.passage(
        r"A crank of length $r$ has the angle $\phi$. From its end a rod of length $L$ goes down, at the angle "
        r"$\psi$, to a slider at $x$ on a line through the crank's axis:",
        (r"r \sin\phi", r"L \sin\psi"),
        ("x", place),
    )
    rod_rate = solve(rate(closure, MOTION), DPSI)[0]
    d.step(
        "The condition gives the rate of the rod.",
        rod_rate,
        CRANK * cos(PHI) / (ROD * cos(PSI)) * DPHI,
        because="the differentiated condition is linear in the rates",
        named=r"\dot\psi",
    )
    velocity = rate(place, MOTION).subs(DPSI, rod_rate)
    d.step(
        "The slider has the velocity:",
        velocity,
        -CRANK * sin(PHI + PSI) / cos(PSI) * DPHI,
        because="the position of the slider is differentiated, and step 1 gives the rate of the rod",
        named=r"\dot x",
    )
    ends = {PHI: 0, PSI: 0}
    d.step(
        "The slider is at rest at the dead centres, where crank and rod are in line.",
        velocity.subs(ends),
        0,
        because=r"$\sin(\phi + \psi) = 0$ at this position",
        named=r"\dot x|_{\phi = \psi = 0}",
    )
    steady = {PHI: DPHI, PSI: rod_rate}
    d.step(
        "If the crank rotates steadily, the slider has the following acceleration at the dead centre far from the "
        "crank.",
        rate(velocity, steady).subs(ends),
        -CRANK * DPHI**2 * (1 + CRANK / ROD),
        because=r"the velocity is differentiated; at the dead centre the terms with $\sin\phi$ and $\sin\psi$ are zero",
        named=r"\ddot x|_{\phi = \psi = 0}",
    )
    pin, slider = _bar(CRANK, PHI), Matrix([place, 0])
    center = Matrix([place, place * sin(PHI) / cos(PHI)])
    d.define("The instantaneous centre of the rod is on the line of the crank, straight above the slider:", "c", center)
    d.step(
        "Both ends of the rod, $A$ at the crank and $B$ at the slider, move perpendicular to the lines that join "
        "them to the instantaneous centre.",
        Matrix([(pin - center).dot(rate(pin, MOTION)), (slider - center).dot(Matrix([velocity, 0]))]),
        0,
        because="$A$ moves perpendicular to the crank, and $B$ along the line of the slider",
        named=r"\begin{bmatrix} (r_A - c) \cdot \dot r_A \\ (r_B - c) \cdot \dot r_B \end{bmatrix}",
    )
    force = symbols.F_x
    torque = solve(symbols.tau_3 * DPHI + force * velocity, symbols.tau_3)[0]
    d.step(
        r"A torque $\tau_3$ on the crank balances a force $F_x$ on the slider.",
        torque,
        force * CRANK * sin(PHI + PSI) / cos(PSI),
        because="without friction the sum of the powers of torque and force is zero",
        named=r"\tau_3",
    )


def _four_bars(d: Derivation) -> None:
    d.section("Four bars")
    a, b, c, ground = symbols.a, symbols.b, symbols.c, symbols.h
    closure = _bar(a, PHI) + _bar(b, THETA) - _bar(c, PSI) - Matrix([ground, 0])
    d.passage(
        r"The crank has the length $a$ and the angle $\phi$, the coupler $b$ and $\theta$, the rocker $c$ and $\psi$. "
        "The fixed bar (ground) has the length $h$:",
        (_bar(a, PHI) + _bar(b, THETA), _bar(c, PSI) + Matrix([ground, 0])),
    )
    rates = solve(list(rate(closure, MOTION)), (DTHETA, DPSI), dict=True)[0]
    d.step(
        "The condition that the bars form a closed polygon gives the rates of coupler and rocker.",
        Matrix([rates[DTHETA], rates[DPSI]]),
        DPHI * Matrix([a * sin(PHI - PSI) / (b * sin(PSI - THETA)), a * sin(PHI - THETA) / (c * sin(PSI - THETA))]),
        because="the condition that the polygon closes gives, if differentiated, two linear equations for the rates",
        named=r"\begin{bmatrix} \dot\theta \\ \dot\psi \end{bmatrix}",
    )
    d.step(
        "The equations for the rates are singular where coupler and rocker are in line.",
        closure.jacobian([THETA, PSI]).det(),
        b * c * sin(THETA - PSI),
        because="the determinant of the equations is zero at this position; the linkage can continue in two ways",
        named=r"\det \frac{\partial\,\text{closure}}{\partial (\theta, \psi)}",
    )
    coupler = _bar(c, PSI) + Matrix([ground, 0]) - _bar(a, PHI)
    freudenstein = _freudenstein(a, b, c, ground)
    d.step(
        "If the angle of the coupler is eliminated, Freudenstein's equation remains.",
        squared(coupler) - b**2,
        freudenstein,
        because="the length of the coupler is constant",
        named=r"|c\,e_\psi + h\,e_x - a\,e_\phi|^2 - b^2",
    )
    d.step(
        "The time derivative of Freudenstein's equation gives the same rate of the rocker as the closed polygon.",
        rate(freudenstein, {PHI: DPHI, PSI: DPSI}),
        2 * a * DPHI * (ground * sin(PHI) + c * sin(PHI - PSI))
        - 2 * c * DPSI * (ground * sin(PSI) + a * sin(PHI - PSI)),
        because="the lengths are constant; only the angles of crank and rocker change",
        named=r"\frac{d}{dt} \left( |c\,e_\psi + h\,e_x - a\,e_\phi|^2 - b^2 \right)",
    )
    square = {b: ground, c: a, THETA: 0, PSI: PHI}
    d.step(
        "In a parallelogram the coupler does not rotate, and the rocker rotates like the crank.",
        Matrix([rates[DTHETA], rates[DPSI]]).subs(square, simultaneous=True),
        Matrix([0, DPHI]),
        because=r"$b = h$, $c = a$, $\theta = 0$, $\psi = \phi$",
        named=r"\begin{bmatrix} \dot\theta \\ \dot\psi \end{bmatrix}",
    )


def _freudenstein(a: Expr, b: Expr, c: Expr, ground: Expr) -> Expr:
    constant = a**2 - b**2 + c**2 + ground**2
    return constant - 2 * a * ground * cos(PHI) + 2 * c * ground * cos(PSI) - 2 * a * c * cos(PHI - PSI)
