"""A struck body: impulse and momentum (Routh, Dynamics of a System of Rigid Bodies, Elementary Part, chapter IV)."""

from sympy import Expr, Matrix, Rational, diag, eye, solve

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, squared
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation
from symrot.proof.notation.printer import formula

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
            "A blow is so short that the body does not move during the blow, and so strong that all other forces can "
            "be neglected. It changes the velocity and the angular velocity at once. All components are along the "
            "principal axes through the centre of mass."
        ),
    )
    dv, domega = J / M, INERTIA.inv() * PLACE.cross(J)
    d.passage(
        "An impulse $J$ acts at a point of the body with the offset $d$ from the centre of mass. It changes the "
        "momentum and the angular momentum:",
        (r"m\,\Delta v", "J"),
        (r"I\,\Delta\omega", r"d \times J"),
    )
    struck = V + OMEGA.cross(PLACE)
    change = dv + domega.cross(PLACE)
    d.notation({"m": M, "v": V, "I": INERTIA, "d": PLACE, "J": J, "K": MOBILITY, "n": N, r"\omega": OMEGA})
    d.notation({r"\Delta v": dv, r"\Delta\omega": domega, "v_d": struck, r"\Delta v_d": change})
    _place(d, change)
    _energy(d, dv, domega, struck, change)
    _wall(d, struck)
    _percussion(d)
    return d


def _place(d: Derivation, change: Matrix) -> None:
    d.section("The struck point")
    d.step(
        "The change of the struck point's velocity is a matrix times the impulse.",
        change,
        MOBILITY * J,
        because=r"$(I^{-1} (d \times J)) \times d = -[d]_\times I^{-1} [d]_\times J$",
        named=r"\Delta v_d = \Delta v + \Delta\omega \times d",
        board=(
            (
                r"$\Delta v = \tfrac1m J$ and $\Delta\omega = I^{-1} (d \times J)$:",
                r"\tfrac1m\,J + I^{-1} (d \times J) \times d",
            ),
            (
                "The factors of the second cross product are exchanged, which changes its sign:",
                r"\tfrac1m\,J - d \times I^{-1} (d \times J)",
            ),
            (
                "A cross product is a multiplication by a skew matrix:",
                r"\left( \tfrac1m\,\mathbf{1} - [d]_\times I^{-1} [d]_\times \right) J",
            ),
        ),
        display=r"K J, \quad K = \tfrac1m\,\mathbf{1} - [d]_\times I^{-1} [d]_\times",
    )
    d.step(
        "The matrix $K$ is symmetric: a unit impulse along axis 1 changes the velocity along axis 2 as much as a unit "
        "impulse along axis 2 changes the velocity along axis 1.",
        MOBILITY - MOBILITY.T,
        0,
        because=r"$[d]_\times$ is skew and $I$ is symmetric",
        named=r"K - K^{\mathsf T}",
    )
    d.step(
        "The matrix $K$ is positive definite: the velocity change of the struck point always has a positive component "
        "along the impulse.",
        J.dot(MOBILITY * J),
        squared(J) / M + PLACE.cross(J).dot(INERTIA.inv() * PLACE.cross(J)),
        because="the first term of the sum is positive, and the second is not negative",
        named=r"J \cdot K J",
        board=(
            ("The definition of $K$:", r"\tfrac1m\,|J|^2 - J \cdot \left( d \times I^{-1} (d \times J) \right)"),
            (
                r"$J \cdot (d \times u) = -(d \times J) \cdot u$:",
                r"\tfrac1m\,|J|^2 + (d \times J) \cdot I^{-1} (d \times J)",
            ),
        ),
        display=r"\tfrac1m\,|J|^2 + (d \times J) \cdot I^{-1} (d \times J)",
    )


def _energy(d: Derivation, dv: Matrix, domega: Matrix, struck: Matrix, change: Matrix) -> None:
    d.section("Energy")

    def energy(v: Matrix, omega: Matrix) -> Expr:
        return HALF * M * squared(v) + HALF * omega.dot(INERTIA * omega)

    d.step(
        "The work of a blow is the impulse times the mean of the struck point's velocities before and after the blow.",
        energy(V + dv, OMEGA + domega) - energy(V, OMEGA),
        J.dot(struck + change / 2),
        because="kinetic energy is quadratic in the velocities",
        named=r"T' - T",
        board=(
            (
                r"The squares are multiplied out, with $\Delta v = \tfrac1m J$ and $I\,\Delta\omega = d \times J$:",
                r"v \cdot J + \tfrac{1}{2 m}\,|J|^2 + \omega \cdot (d \times J) + "
                r"\tfrac12\,(d \times J) \cdot I^{-1} (d \times J)",
            ),
            (
                r"$\omega \cdot (d \times J) = J \cdot (\omega \times d)$ and $v_d = v + \omega \times d$; the other "
                r"two "
                r"terms are $\tfrac12 J \cdot K J$:",
                r"J \cdot v_d + \tfrac12\,J \cdot K J",
            ),
        ),
        display=r"J \cdot \left( v_d + \tfrac12\,\Delta v_d \right)",
    )
    d.step(
        "The kinetic energy that a body at rest gains is half the product of the impulse and the velocity of the "
        "struck point (Kelvin).",
        energy(dv, domega),
        HALF * J.dot(MOBILITY * J),
        because="the velocity before the blow is zero",
        named="T'",
        board=(
            (
                r"The work of a blow, with $v_d = 0$ and $\Delta v_d = K J$:",
                r"\tfrac12\,J \cdot K J",
            ),
        ),
        display=r"\tfrac12\,J \cdot K J",
    )


def _wall(d: Derivation, struck: Matrix) -> None:
    d.section("Impact on a smooth wall")
    restitution = symbols.epsilon
    speed = N.dot(struck)
    give = N.dot(MOBILITY * N)
    blow = -(1 + restitution) * speed / give * N
    d.passage("The body hits a wall with the unit normal $n$, without friction. The coefficient of restitution "
        r"$\epsilon$ gives the impulse:",
            ("J", r"-(1 + \epsilon)\,\frac{n \cdot v_d}{n \cdot K n}\,n"))  # fmt: skip
    d.nonzero("$K$ is positive definite (step 3), so", give, r"n \cdot K n")
    d.step(
        r"The struck point leaves the wall with the fraction $\epsilon$ of its normal velocity before the impact.",
        speed + N.dot(MOBILITY * blow),
        -restitution * speed,
        because=r"$n \cdot K J = -(1 + \epsilon)\,n \cdot v_d$",
        named=r"n \cdot v_d'",
        display=r"-\epsilon\,n \cdot v_d",
    )
    after = HALF * (speed + N.dot(MOBILITY * blow) + speed) * blow.dot(N)
    d.step(
        r"The impact loses the following energy, which is zero at $\epsilon = 1$.",
        -after,
        HALF * (1 - restitution**2) * speed**2 / give,
        because="the work of a blow is its impulse times the mean of the velocities before and after the blow",
        relations=[squared(N) - 1],
        named=r"T - T'",
        display=r"\frac{1 - \epsilon^2}{2} \, \frac{(n \cdot v_d)^2}{n \cdot K n}",
    )


def _percussion(d: Derivation) -> None:
    d.section("The centre of percussion")
    x, h = symbols.x, symbols.h
    velocity = symbols.J_y / M + symbols.J_y * h / symbols.C * x
    rest = solve(velocity, x)[0]
    d.passage("A body at rest is struck perpendicular to a line through its centre of mass, at the distance $h$ from "
        "the centre. Just after the blow, a point at the coordinate $x$ of this line moves with the velocity",
            ("v_y", velocity))  # fmt: skip
    d.step(
        "One point, on the other side of the centre of mass, stays at rest: a hand that holds the body there feels no "
        "blow.",
        velocity.subs(x, rest),
        0,
        because=f"$x = {formula(rest)}$",
        named=rf"v_y \left( {formula(rest)} \right)",
    )
    d.step(
        "The distances of the struck point and of the point at rest from the centre of mass have a constant product. "
        "So the two points can be exchanged: each is the centre of percussion of the other.",
        -rest * h,
        symbols.C / M,
        because="the product of the two distances is the square of the radius of gyration",
        named=r"-x\,h",
    )
    rod = {symbols.C: M * symbols.L**2 / 12}
    d.step(
        "If a rod of length $L$ is held at its end, the centre of percussion is at two thirds of its length.",
        symbols.L / 2 + solve((rest + symbols.L / 2).subs(rod), h)[0],
        2 * symbols.L / 3,
        because=r"$C = m L^2 / 12$ and $x = -L/2$",
        named=r"\tfrac{L}{2} + h",
    )
