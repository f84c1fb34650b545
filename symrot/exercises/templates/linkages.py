"""Exercises on linkages: crank and slider, Scotch yoke, ladder."""

from random import Random

from sympy import Expr, Symbol, asin, cos, sin, sqrt

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.symbols import F_x, L, Omega, phi, r, theta

CRANK = quantity(r, "30 40 50 60 80 100", "mm", "crank")
ROD = quantity(L, "100 120 150 200 250", "mm", "connecting rod")
SPEED = quantity(Omega, "300 600 900 1200 1500", "rpm", "speed of the crank")
ANGLE = quantity(phi, "30 45 60 90 120", "deg", "angle of the crank")
ENGINE = (
    r"A crank of length $r$ rotates at $\Omega$. A connecting rod of length $L$ joins it to a piston on a line "
    r"through the crank's axis; $\phi$ is the angle of the crank to this line."
)


def _piston() -> Expr:
    """Return the distance of the piston from the axis of the crank, as a function of the crank angle."""
    return r * cos(phi) + sqrt(L**2 - r**2 * sin(phi) ** 2)


def piston_speed(random: Random) -> Problem:
    """Return a problem that asks for the velocity of the piston that a crank drives."""
    velocity = _piston().diff(phi) * Omega
    formula = -Omega * r * sin(phi) * (1 + r * cos(phi) / sqrt(L**2 - r**2 * sin(phi) ** 2))
    return Problem(
        "The speed of a piston",
        ENGINE,
        r"The distance of the piston is $x = r\cos\phi + \sqrt{L^2 - r^2\sin^2\phi}$; differentiate it with respect to "
        "time.",
        (CRANK, ROD, SPEED, ANGLE),
        (Line("The chain rule, with $\\dot\\phi = \\Omega$.", velocity, formula, r"\dot x"),),
        (Asked(r"\dot x", "the velocity of the piston, positive away from the crank's axis", formula, "m/s"),),
        lambda values: values[r] < values[L],
    )


def acceleration_at_dead_centre(random: Random) -> Problem:
    """Return a problem that asks for the acceleration of a piston at the dead centre far from the crank."""
    acceleration = (_piston().diff(phi, 2) * Omega**2).subs(phi, 0)
    formula = -(Omega**2) * r * (1 + r / L)
    return Problem(
        "The acceleration at the dead centre",
        ENGINE + r" The piston is at the far dead centre, $\phi = 0$.",
        "Differentiate the distance of the piston twice in time, at a constant rate of the crank.",
        (CRANK, ROD, SPEED),
        (Line(r"The second derivative at $\phi = 0$.", acceleration, formula, r"\ddot x"),),
        (Asked(r"\ddot x", "the acceleration of the piston, positive away from the crank's axis", formula, "m/s^2"),),
        lambda values: values[r] < values[L],
    )


def rod_rate(random: Random) -> Problem:
    """Return a problem that asks for the angular velocity of the connecting rod of a crank and piston."""
    angle = asin(r * sin(phi) / L)
    rate = angle.diff(phi) * Omega
    formula = Omega * r * cos(phi) / sqrt(L**2 - r**2 * sin(phi) ** 2)
    return Problem(
        "The rate of a connecting rod",
        ENGINE,
        r"The angle $\psi$ of the rod to the line satisfies $L\sin\psi = r\sin\phi$; differentiate this in time.",
        (CRANK, ROD, SPEED, quantity(phi, "30 45 60 120", "deg", "angle of the crank")),
        (Line("The derivative of the rod's angle, times the rate of the crank.", rate, formula, r"\dot\psi"),),
        (Asked(r"\dot\psi", "the rate of the rod's angle", formula, "rad/s"),),
        lambda values: values[r] < values[L],
    )


def crank_torque(random: Random) -> Problem:
    """Return a problem that asks for the torque on a crank that balances a force on the piston."""
    torque = -F_x * _piston().diff(phi)
    formula = F_x * r * sin(phi) * (1 + r * cos(phi) / sqrt(L**2 - r**2 * sin(phi) ** 2))
    return Problem(
        "The torque of a piston",
        ENGINE.replace(r" of length $r$ rotates at $\Omega$", " has the length $r$")
        + r" Gas pushes the piston towards the crank with the force $F_x$; masses are neglected.",
        r"The power of the force equals the power of the torque on the crank, $F_x \, (-\dot x) = \tau\dot\phi$.",
        (CRANK, ROD, ANGLE, quantity(F_x, "500 1000 2000 4000", "N", "force")),
        (Line("The force times the derivative of the distance with respect to the angle.", torque, formula, r"\tau"),),
        (Asked(r"\tau", "the torque on the crank", formula, "N m"),),
        lambda values: values[r] < values[L],
    )


def scotch_yoke(random: Random) -> Problem:
    """Return a problem that asks for the acceleration of a Scotch yoke."""
    acceleration = (r * cos(phi)).diff(phi, 2) * Omega**2
    return Problem(
        "A Scotch yoke",
        r"The pin of a crank of length $r$, which rotates at $\Omega$, slides in a slot of a yoke that is "
        r"perpendicular to the yoke's direction of motion. The crank is at the angle $\phi$ to this direction.",
        r"The yoke follows one coordinate of the pin, $x = r\cos\phi$.",
        (CRANK, SPEED, ANGLE),
        (
            Line(
                "The second derivative in time, at a constant rate.",
                acceleration,
                -(Omega**2) * r * cos(phi),
                r"\ddot x",
            ),
        ),
        (Asked(r"\ddot x", "the acceleration of the yoke", -(Omega**2) * r * cos(phi), "m/s^2"),),
    )


def ladder(random: Random) -> Problem:
    """Return a problem that asks for the angular velocity of a ladder that slides down a wall."""
    place = L * cos(theta)
    speed = Symbol("v", positive=True)
    rate = speed / place.diff(theta)
    formula = -speed / (L * sin(theta))
    return Problem(
        "A ladder that slides",
        r"A ladder of length $L$ leans on a wall at the angle $\theta$ to the ground. Its foot slides away from "
        "the wall with the speed $v$.",
        r"The foot is at $x = L\cos\theta$; differentiate this in time.",
        (
            quantity(L, "2 2.5 3 4 5", "m", "length"),
            quantity(theta, "30 45 60", "deg", "angle to the ground"),
            quantity(speed, "0.2 0.4 0.5 1", "m/s", "speed"),
        ),
        (
            Line(
                "The speed of the foot at this rate.", place.diff(theta) * formula, speed, r"-L\sin\theta\,\dot\theta"
            ),
            Line("The equation is solved for the rate.", rate, formula, r"\dot\theta"),
        ),
        (Asked(r"\dot\theta", "the rate of the ladder's angle", formula, "rad/s"),),
    )
