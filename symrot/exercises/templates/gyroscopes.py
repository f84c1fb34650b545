"""Exercises on gyroscopes: wheels on cords, bearings, reaction wheels."""

from random import Random

from sympy import Expr, Matrix, solve

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.inertia.solids import solid
from symrot.symbols import A, C, L, Omega, R, a, g, m, omega_3

SPIN = quantity(omega_3, "300 600 900 1200 1500 3000", "rpm", "speed of the wheel")
TURN = quantity(Omega, "0.2 0.4 0.5 1 2", "rad/s", "rate of the frame")
MASS = quantity(m, "1 2 4 5 10", "kg", "mass")
RADIUS = quantity(R, "100 150 200 250 300", "mm", "radius")
GRAVITY = quantity(g, "9.81", "m/s^2", "gravity")


def _gyroscopic_torque(moment: Expr) -> Matrix:
    """Return the torque vector on a wheel that spins at omega_3 about x while its axis rotates at Omega about z.

    ``moment`` is the wheel's moment of inertia about its own axis.
    """
    return Matrix((0, 0, Omega)).cross(Matrix((moment * omega_3, 0, 0)))


def wheel_on_cord(random: Random) -> Problem:
    """Return a problem that asks for the precession of a wheel that hangs from a cord at one end of its level axle."""
    moment = solid("ring").inertia[2, 2]
    torque = _gyroscopic_torque(moment)[1]
    (rate,) = solve(torque - m * g * a, Omega)
    return Problem(
        "A bicycle wheel on a cord",
        r"A wheel, a thin ring of mass $m$ and radius $R$, spins with $\omega_3$ on a horizontal axle. The axle hangs "
        "from a cord at the distance $a$ from the wheel.",
        r"The torque of gravity, $m g a$, equals the rate of the angular momentum, $I \omega_3 \Omega$.",
        (RADIUS, SPIN, quantity(a, "50 100 150 200", "mm", "distance"), GRAVITY),
        (
            Line(
                "The rate of the angular momentum of the spin.", torque, m * R**2 * Omega * omega_3, r"I\omega_3\Omega"
            ),
            Line("It equals the torque of gravity; the mass cancels.", rate, g * a / (R**2 * omega_3), r"\Omega"),
        ),
        (Asked(r"\Omega", "the rate of precession", g * a / (R**2 * omega_3), "rad/s"),),
    )


def bearing_torque(random: Random) -> Problem:
    """Return a problem that asks for the torque on the bearings of a disk that spins in a rotating frame."""
    moment = solid("disk").inertia[2, 2]
    torque = _gyroscopic_torque(moment)[1]
    formula = m * R**2 * omega_3 * Omega / 2
    return Problem(
        "A rotor in a turning vehicle",
        r"The rotor of a motor is a uniform disk of mass $m$ and radius $R$ that spins with $\omega_3$ about a "
        r"horizontal axis. The vehicle rotates at $\Omega$ about the vertical.",
        r"The bearings supply the rate of the angular momentum, $\Omega \times I\omega$.",
        (MASS, RADIUS, SPIN, TURN),
        (Line("The moment of a disk times the rates of spin and vehicle.", torque, formula, "M"),),
        (Asked("M", "the torque on the bearings", formula, "N m"),),
    )


def bearing_forces(random: Random) -> Problem:
    """Return a problem that asks for the gyroscopic force on each bearing of a spinning rotor."""
    moment = solid("disk").inertia[2, 2]
    torque = _gyroscopic_torque(moment)[1]
    formula = m * R**2 * omega_3 * Omega / (2 * L)
    return Problem(
        "The bearings of a ship's turbine",
        r"The rotor of a turbine is a uniform disk of mass $m$ and radius $R$. It spins with $\omega_3$ in two "
        r"bearings at the distance $L$ from each other. The ship rotates at $\Omega$ about an axis perpendicular to "
        "the axis of the rotor.",
        "The gyroscopic torque is a couple of two forces, one at each bearing.",
        (
            quantity(m, "50 100 200 400", "kg", "mass"),
            quantity(R, "200 250 400 500", "mm", "radius"),
            SPIN,
            TURN,
            quantity(L, "0.5 1 1.5 2", "m", "distance between the bearings"),
        ),
        (
            Line("The gyroscopic torque.", torque, m * R**2 * omega_3 * Omega / 2, "M"),
            Line("The torque divided by the distance between the bearings.", torque / L, formula, "F"),
        ),
        (Asked("F", "the gyroscopic force on each bearing", formula, "N"),),
    )


def reaction_wheel(random: Random) -> Problem:
    """Return a problem that asks for the rate of a satellite whose reaction wheel is spun up."""
    rate = solve(A * Omega + C * (Omega + omega_3), Omega)[0]
    formula = -C * omega_3 / (A + C)
    return Problem(
        "A reaction wheel",
        "A satellite at rest has the moment $A$ about an axis, without its wheel. The wheel has the moment $C$ "
        r"about the same axis. A motor brings the wheel to the rate $\omega_3$ relative to the satellite.",
        "No external torque acts, so the total angular momentum stays zero.",
        (
            quantity(A, "9.5 19.5 49.5 99 199", "kg m^2", "moment of the satellite"),
            quantity(C, "0.5 1", "kg m^2", "moment of the wheel"),
            SPIN,
        ),
        (
            Line(
                "The sum of both angular momenta.",
                A * formula + C * (formula + omega_3),
                0,
                r"A\Omega + C(\Omega + \omega_3)",
            ),
            Line("The equation is solved for the rate.", rate, formula, r"\Omega"),
        ),
        (Asked(r"\Omega", "the rate of the satellite", formula, "rad/s"),),
    )


def tilted_wheel(random: Random) -> Problem:
    """Return a problem that asks for the rate of a turntable on which a person turns a spinning wheel over."""
    before, after = C * omega_3, -C * omega_3
    (rate,) = solve(A * Omega + after - before, Omega)
    formula = 2 * C * omega_3 / A
    return Problem(
        "A person on a turntable",
        "A person stands at rest on a turntable and holds a wheel with a vertical axis and the moment $C$ that spins "
        r"with $\omega_3$ in space. Then the person turns the wheel over, so that it spins with $\omega_3$ in the "
        "opposite direction. Person and table have the moment $A$.",
        "The vertical component of the angular momentum does not change.",
        (
            quantity(A, "2 4 5 8", "kg m^2", "moment of person and table"),
            quantity(C, "0.05 0.1 0.2", "kg m^2", "moment of the wheel"),
            SPIN,
        ),
        (
            Line("The angular momentum before and after.", A * formula + after, before, r"A\Omega - C\omega_3"),
            Line("The equation is solved for the rate.", rate, formula, r"\Omega"),
        ),
        (Asked(r"\Omega", "the rate of the table afterwards", formula, "rad/s"),),
    )
