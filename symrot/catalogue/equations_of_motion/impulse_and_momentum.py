"""A struck body: impulse and momentum (Routh, Dynamics of a System of Rigid Bodies, Elementary Part, chapter IV)."""

from sympy import Expr, Matrix, Rational, diag, eye, solve

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, squared
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

HALF = Rational(1, 2)
J, PLACE, V, N = (Matrix(s) for s in (symbols.impulse, symbols.offset, symbols.velocity, symbols.axis))
INERTIA = diag(*symbols.principal)
M = symbols.m
ARM = skew(PLACE)
MOBILITY = eye(3) / M - ARM * INERTIA.inv() * ARM


def derive() -> Derivation:
    d = Derivation(
        "impulse_and_momentum",
        title="A struck body",
        source="Routh, *Dynamics of a System of Rigid Bodies*, Elementary Part, chapter IV; Beer, Johnston & Cornwell, "
        "*Vector Mechanics for Engineers: Dynamics*, chapter 17",
        about=(
            "A blow is so short that the body does not move while it lasts, and so strong that nothing else counts: "
            "it changes velocity and angular velocity at once. Principal axes through the centre of mass."
        ),
    )
    dv, domega = J / M, INERTIA.inv() * PLACE.cross(J)
    d.passage(
        "The impulse $J$ at the place $d$ from the centre of mass changes momentum and angular momentum:",
        (r"m\,\Delta v", "J"),
        (r"I\,\Delta\omega", r"d \times J"),
    )
    struck = V + OMEGA.cross(PLACE)
    change = dv + domega.cross(PLACE)
    d.notation({"m": M, "I": INERTIA, "d": PLACE, "J": J, "K": MOBILITY, "n": N, r"\omega": OMEGA})
    d.notation({r"\Delta v": dv, r"\Delta\omega": domega, "v_d": struck, r"\Delta v_d": change})
    _place(d, change)
    _energy(d, dv, domega, struck, change)
    _wall(d, struck)
    _percussion(d)
    return d


def _place(d: Derivation, change: Matrix) -> None:
    d.section("The place that is struck")
    d.step(
        "How its velocity changes: a matrix times the impulse.",
        change,
        MOBILITY * J,
        because=r"$(I^{-1} (d \times J)) \times d = -[d]_\times I^{-1} [d]_\times J$",
        named=r"\Delta v_d = \Delta v + \Delta\omega \times d",
        display=r"K J, \quad K = \tfrac1m\,\mathbf{1} - [d]_\times I^{-1} [d]_\times",
    )
    d.step(
        "The matrix is symmetric: a blow along one axis moves the place along another as much as conversely.",
        MOBILITY - MOBILITY.T,
        0,
        because=r"$[d]_\times$ is skew, $I$ is symmetric",
        named=r"K - K^{\mathsf T}",
    )
    d.step(
        "And positive: the place gives way to every blow.",
        J.dot(MOBILITY * J),
        squared(J) / M + PLACE.cross(J).dot(INERTIA.inv() * PLACE.cross(J)),
        because="both terms of the sum are positive",
        named=r"J \cdot K J",
        display=r"\tfrac1m\,|J|^2 + (d \times J) \cdot I^{-1} (d \times J)",
    )


def _energy(d: Derivation, dv: Matrix, domega: Matrix, struck: Matrix, change: Matrix) -> None:
    d.section("Energy")

    def energy(v: Matrix, omega: Matrix) -> Expr:
        return HALF * M * squared(v) + HALF * omega.dot(INERTIA * omega)

    d.step(
        "The blow does the work of the impulse on the mean of the velocities before and after, at the place struck.",
        energy(V + dv, OMEGA + domega) - energy(V, OMEGA),
        J.dot(struck + change / 2),
        because="kinetic energy is quadratic in the velocities",
        named=r"T' - T",
        display=r"J \cdot \left( v_d + \tfrac12\,\Delta v_d \right)",
    )
    d.step(
        "A body at rest takes up half the product of impulse and velocity gained (Kelvin).",
        energy(dv, domega),
        HALF * J.dot(MOBILITY * J),
        because="the velocity before the blow is zero",
        named="T'",
        display=r"\tfrac12\,J \cdot K J",
    )


def _wall(d: Derivation, struck: Matrix) -> None:
    d.section("Against a smooth wall")
    restitution = symbols.epsilon
    speed = N.dot(struck)
    give = N.dot(MOBILITY * N)
    blow = -(1 + restitution) * speed / give * N
    d.passage(r"The wall has the unit normal $n$ and no friction, and the blow leaves $\epsilon$ of the speed:",
            ("J", r"-(1 + \epsilon)\,\frac{n \cdot v_d}{n \cdot K n}\,n"))  # fmt: skip
    d.step(
        "The place leaves the wall with that fraction of the speed it came with.",
        speed + N.dot(MOBILITY * blow),
        -restitution * speed,
        because=r"$n \cdot K J = -(1 + \epsilon)\,n \cdot v_d$",
        named=r"n \cdot v_d'",
        display=r"-\epsilon\,n \cdot v_d",
    )
    after = HALF * (speed + N.dot(MOBILITY * blow) + speed) * blow.dot(N)
    d.step(
        r"The energy lost: none at $\epsilon = 1$.",
        -after,
        HALF * (1 - restitution**2) * speed**2 / give,
        because="the work of a blow is its impulse times the mean of the velocities before and after",
        relations=[squared(N) - 1],
        named=r"T - T'",
        display=r"\frac{1 - \epsilon^2}{2} \, \frac{(n \cdot v_d)^2}{n \cdot K n}",
    )


def _percussion(d: Derivation) -> None:
    d.section("The centre of percussion")
    x, h = symbols.x, symbols.h
    velocity = symbols.J_y / M + symbols.J_y * h / symbols.C * x
    rest = solve(velocity, x)[0]
    d.passage("A body at rest is struck across, at the distance $h$ from its centre of mass. On the line through both, "
            "at $x$, it moves with",
            ("v_y", velocity))  # fmt: skip
    d.step(
        "One point stays at rest, beyond the centre of mass: a hand that holds the body there feels nothing.",
        velocity.subs(x, rest),
        0,
        because=f"$x = {_latex(rest)}$",
        named=rf"v_y \left( {_latex(rest)} \right)",
    )
    d.step(
        "The two distances have a constant product: either point is the centre of percussion of the other.",
        -rest * h,
        symbols.C / M,
        because="the product of the two distances is the square of the radius of gyration",
        named=r"-x\,h",
    )
    rod = {symbols.C: M * symbols.L**2 / 12}
    d.step(
        "A rod of length $L$ that is held at its end: struck at two thirds of its length.",
        symbols.L / 2 + solve((rest + symbols.L / 2).subs(rod), h)[0],
        2 * symbols.L / 3,
        because=r"$C = m L^2 / 12$ and $x = -L/2$",
        named=r"\tfrac{L}{2} + h",
    )


def _latex(value: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(value)
