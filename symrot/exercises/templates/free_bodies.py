"""Exercises on free bodies, symmetric and asymmetric: precession, cones, polhodes, separatrix."""

from random import Random

from sympy import Expr, Matrix, Symbol, atan, diag, pi, sqrt

from symrot.dynamics.equations import euler_equations
from symrot.exercises.problem import Asked, Line, Problem, Quantity, quantity
from symrot.inertia.solids import solid
from symrot.symbols import A, B, C, H, L, R, omega_1, omega_2, omega_3

T = Symbol("T", positive=True)  # kinetic energy; the checker takes E for another number
OMEGA = Matrix((omega_1, omega_2, omega_3))
TRANSVERSE = quantity(A, "2 3 4 5 6 8 10", "kg m^2", "transverse moment")
AXIAL = quantity(C, "1 2 3 4 5 6 9 12", "kg m^2", "moment about the axis")
ACROSS = quantity(omega_1, "0.5 1 2 3 4", "rad/s", "component perpendicular to the axis")
SPIN = quantity(omega_3, "1 2 3 4 5 6 8 10", "rad/s", "component along the axis")
SYMMETRIC = (
    r"A free symmetric body has the moments $A$, $A$, $C$. Its angular velocity has the component $\omega_3$ along "
    r"the symmetry axis and the component $\omega_1$ perpendicular to it."
)


def body_precession(random: Random) -> Problem:
    """Return a problem that asks for the rate at which omega goes around the symmetry axis, seen from the body."""
    rates = euler_equations((A, A, C), None)
    formula = omega_3 * (C - A) / A
    return Problem(
        "The wobble of a symmetric body, seen in the body",
        SYMMETRIC.split(" Its")[0] + r" It spins with $\omega_3$ about its axis.",
        r"With two equal moments Euler's equations become $\dot\omega_1 = -\lambda\omega_2$, $\dot\omega_2 = "
        r"\lambda\omega_1$.",
        (TRANSVERSE, AXIAL, SPIN),
        (
            Line("Euler's equation of axis 2.", rates[1], omega_1 * formula, r"\dot\omega_2"),
            Line(r"Divide by $\omega_1$ to get the rate $\lambda$.", rates[1] / omega_1, formula, r"\lambda"),
        ),
        (
            Asked(
                r"\lambda", "the rate at which the angular velocity goes around the axis, in the body", formula, "rad/s"
            ),
        ),
        lambda values: values[A] != values[C] and values[C] < 2 * values[A],
    )


def space_precession(random: Random) -> Problem:
    """Return a problem that asks for the rate at which the symmetry axis precesses about the angular momentum."""
    momentum = diag(A, A, C) * Matrix((omega_1, 0, omega_3))
    formula = sqrt(A**2 * omega_1**2 + C**2 * omega_3**2) / A
    square = (momentum.T * momentum)[0] / A**2
    return Problem(
        "The precession of a free symmetric body",
        SYMMETRIC,
        "The axis goes around the angular momentum at the rate $H/A$.",
        (TRANSVERSE, AXIAL, ACROSS, SPIN),
        (
            Line(
                "The square of the angular momentum divided by the square of the moment $A$.",
                square,
                formula**2,
                r"\dot\phi^2",
            ),
            Line("The square root is taken.", sqrt(square), formula, r"\dot\phi"),
        ),
        (Asked(r"\dot\phi", "the rate of precession about the angular momentum", formula, "rad/s"),),
        lambda values: values[A] != values[C] and values[C] < 2 * values[A],
    )


def _cone(name: str, words: str, tangent: Expr, left: Expr, law: str) -> Problem:
    used = tangent.free_symbols
    return Problem(
        f"The angle of {words}",
        SYMMETRIC,
        law,
        tuple(each for each in (TRANSVERSE, AXIAL, ACROSS, SPIN) if each.symbol in used),
        (
            Line(
                "The tangent is the component perpendicular to the axis divided by the component along it.",
                left,
                tangent,
                rf"\tan {name}",
            ),
            Line("The angle itself.", atan(left), atan(tangent), name),
        ),
        (Asked(name, f"the half angle of {words}", atan(tangent), "deg"),),
        lambda values: A not in values or (values[A] != values[C] and values[C] < 2 * values[A]),
    )


def body_cone(random: Random) -> Problem:
    """Return a problem that asks for the half angle of the body cone of a free symmetric body."""
    law = "The angular velocity moves on the body cone about the symmetry axis."
    return _cone(r"\beta", "the body cone", omega_1 / omega_3, OMEGA[0] / OMEGA[2], law)


def angle_of_momentum(random: Random) -> Problem:
    """Return a problem that asks for the nutation, the angle between angular momentum and symmetry axis."""
    momentum = diag(A, A, C) * Matrix((omega_1, 0, omega_3))
    law = (
        r"The angular momentum has the component $A\omega_1$ perpendicular to the axis and the component "
        r"$C\omega_3$ along it."
    )
    words = "the cone on which the axis moves about the angular momentum"
    return _cone(r"\theta", words, A * omega_1 / (C * omega_3), momentum[0] / momentum[2], law)


def disk_wobble(random: Random) -> Problem:
    """Return a problem that asks for the wobble rate, in space, of a thin spinning disk."""
    disk = solid("disk").inertia
    ratio = disk[2, 2] / disk[0, 0]
    formula = 2 * omega_3
    return Problem(
        "Feynman's plate",
        r"A thin uniform disk is thrown up. It spins with $\omega_3$ about its axis and wobbles slightly.",
        r"The axis precesses at $H/A$. For a small wobble $H$ is nearly $C\omega_3$.",
        (SPIN,),
        (
            Line("The moment about the axis divided by the transverse moment.", ratio, 2, r"\frac{C}{A}"),
            Line("The rate of the wobble in space.", ratio * omega_3, formula, r"\dot\phi"),
        ),
        (Asked(r"\dot\phi", "the rate of the wobble in space, if it is small", formula, "rad/s"),),
    )


def rod_like_precession(random: Random) -> Problem:
    """Return a problem that asks for the precession of a spinning cylinder that wobbles a little."""
    body = solid("cylinder").inertia
    ratio = body[2, 2] / body[0, 0]
    formula = 6 * R**2 * omega_3 / (L**2 + 3 * R**2)
    return Problem(
        "A wobbling pencil",
        r"A uniform cylinder of radius $R$ and length $L$ spins freely with $\omega_3$ about its axis and wobbles "
        "slightly.",
        r"The axis precesses at $H/A$. For a small wobble $H$ is nearly $C\omega_3$.",
        (quantity(R, "10 20 40 50 100", "mm", "radius"), quantity(L, "100 200 300 400", "mm", "length"), SPIN),
        (
            Line(
                "The moment about the axis divided by the transverse moment.",
                ratio,
                6 * R**2 / (L**2 + 3 * R**2),
                r"\frac{C}{A}",
            ),
            Line("The rate of the wobble in space.", ratio * omega_3, formula, r"\dot\phi"),
        ),
        (Asked(r"\dot\phi", "the rate of the wobble in space, if it is small", formula, "rad/s"),),
    )


def _moments() -> tuple[Quantity, ...]:
    return (
        quantity(A, "6 8 9 10", "kg m^2", "largest moment"),
        quantity(B, "4 5 6 7", "kg m^2", "intermediate moment"),
        quantity(C, "1 2 3 4", "kg m^2", "smallest moment"),
    )


def separatrix_momentum(random: Random) -> Problem:
    """Return a problem that asks for the angular momentum of the separatrix motion at a given energy."""
    energy = B * omega_2**2 / 2
    formula = sqrt(2 * B * T)
    return Problem(
        "The separatrix of a free body",
        "A free body with the moments $A > B > C$ has the kinetic energy $T$. Its angular momentum $H$ is that of a "
        "steady rotation about the intermediate axis with the same energy: this is the separatrix.",
        "Compare the energy and the angular momentum of a rotation about the intermediate axis alone.",
        (_moments()[1], quantity(T, "2 8 10 18 40 50 90", "J", "kinetic energy")),
        (
            Line("For a rotation about the intermediate axis.", (B * omega_2) ** 2, 2 * B * energy, "H^2"),
            Line("With the energy $T$.", formula, formula, "H"),
        ),
        (Asked("H", "the angular momentum on the separatrix", formula, "kg m^2/s"),),
    )


def polhode_constants(random: Random) -> Problem:
    """Return a problem that asks for the square of a component of omega where the polhode crosses a plane."""
    square = (2 * A * T - H**2) / (C * (A - C))
    first = (H**2 - 2 * C * T) / (A * (A - C))
    energy = (A * first + C * square) / 2
    return Problem(
        "Where a polhode crosses a plane",
        "A free body has the moments $A > B > C$, the kinetic energy $T$ and the angular momentum $H$. At a "
        r"given time $\omega_2 = 0$.",
        r"Two equations remain: $A\omega_1^2 + C\omega_3^2 = 2T$ and $A^2\omega_1^2 + C^2\omega_3^2 = H^2$.",
        (
            _moments()[0],
            _moments()[2],
            quantity(T, "20 30 40 50 60", "J", "kinetic energy"),
            quantity(H, "12 15 16 18 20 24", "kg m^2/s", "angular momentum"),
        ),
        (
            Line("The energy of the solution.", energy, T, r"\tfrac12(A\omega_1^2 + C\omega_3^2)"),
            Line(
                "The angular momentum of the solution.",
                A**2 * first + C**2 * square,
                H**2,
                r"A^2\omega_1^2 + C^2\omega_3^2",
            ),
            Line("The square of the component along axis 3.", square, square, r"\omega_3^2"),
        ),
        (Asked(r"\omega_3^2", "the square of the component along the axis of the smallest moment", square, "1/s^2"),),
        lambda v: 2 * v[C] * v[T] < v[H] ** 2 < 2 * v[A] * v[T],
    )


def wobble_period(random: Random) -> Problem:
    """Return a problem that asks for the period of a wobble seen from the body, such as that of the Earth's pole."""
    rates = euler_equations((A, A, C), None)
    period = 2 * pi * A / ((C - A) * omega_3)
    return Problem(
        "The period of a wobble",
        r"A free symmetric body has the moments $A$, $A$, $C$ with $C > A$ and spins with $\omega_3$. Its angular "
        "velocity goes around the axis in the body, as the pole of the Earth does.",
        r"The rate of this motion is $\lambda = \omega_3 (C - A)/A$; the period is $2\pi$ divided by the rate.",
        (
            quantity(A, "8 9 10 12", "kg m^2", "transverse moment"),
            quantity(C, "10 11 12 14 15", "kg m^2", "moment about the axis"),
            SPIN,
        ),
        (
            Line("The rate follows from Euler's equations.", rates[1] / omega_1, omega_3 * (C - A) / A, r"\lambda"),
            Line(r"The angle $2\pi$ divided by the rate.", 2 * pi * omega_1 / rates[1], period, "P"),
        ),
        (Asked("P", "the period in the body", period, "s"),),
        lambda values: values[A] < values[C],
    )
