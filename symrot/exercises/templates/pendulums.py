"""Exercises on pendulums: small oscillations, and falls from the level position."""

from random import Random

from sympy import Expr, Rational, cos, pi, sqrt

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.inertia.solids import solid
from symrot.symbols import L, R, g, m, theta

GRAVITY = quantity(g, "9.81", "m/s^2", "gravity")
LENGTH = quantity(L, "0.3 0.4 0.5 0.6 0.8 1 1.2 1.5", "m", "length")
RADIUS = quantity(R, "100 150 200 250 300", "mm", "radius")
ROD = solid("rod").inertia_about((0, 0, L / 2))[0, 0]
HANGS = "A thin uniform rod of mass $m$ and length $L$ swings about its upper end."


def _stiffness(distance: Expr) -> Expr:
    """Return the second derivative, with respect to the angle, of a pendulum's potential energy at the lowest position.

    ``distance`` is the distance of the centre of mass from the axis.
    """
    return (-m * g * distance * cos(theta)).diff(theta, 2).subs(theta, 0)


def period_of_rod(random: Random) -> Problem:
    """Return a problem that asks for the period of small swings of a rod about its end."""
    square = ROD / _stiffness(L / 2)
    formula = 2 * pi * sqrt(2 * L / (3 * g))
    return Problem(
        "The period of a rod",
        HANGS,
        r"For small swings $I_O\ddot\theta = -m g d\,\theta$, so that the period is $2\pi\sqrt{I_O/(m g d)}$; "
        "$d$ is the distance of the centre of mass from the axis.",
        (LENGTH, GRAVITY),
        (
            Line(
                "The moment of inertia about the end divided by the restoring torque per unit angle.",
                square,
                2 * L / (3 * g),
                r"\frac{I_O}{m g d}",
            ),
            Line("The period of small swings.", 2 * pi * sqrt(square), formula, "T"),
        ),
        (Asked("T", "the period of small swings", formula, "s"),),
    )


def period_of_disk(random: Random) -> Problem:
    """Return a problem that asks for the period of small swings of a disk or a ring about its rim."""
    name = random.choice(("disk", "ring"))
    square = solid(name).inertia_about((R, 0, 0))[2, 2] / _stiffness(R)
    formula = 2 * pi * sqrt(square)
    return Problem(
        f"The period of a {name}",
        f"A thin uniform {name} of mass $m$ and radius $R$ hangs from a nail at its rim and swings in its own plane.",
        r"For small swings $I_O\ddot\theta = -m g d\,\theta$, so that the period is $2\pi\sqrt{I_O/(m g d)}$; "
        "$d$ is the distance of the centre of mass from the axis.",
        (RADIUS, GRAVITY),
        (
            Line(
                "The moment of inertia about the rim divided by the restoring torque per unit angle.",
                square,
                square,
                r"\frac{I_O}{m g d}",
            ),
            Line("The period of small swings.", 2 * pi * sqrt(square), formula, "T"),
        ),
        (Asked("T", "the period of small swings", formula, "s"),),
    )


def falling_rod(random: Random) -> Problem:
    """Return a problem that asks for the angular velocity of a rod that falls from the level position."""
    rate = sqrt(m * g * L / ROD)
    formula = sqrt(3 * g / L)
    return Problem(
        "A rod that falls",
        HANGS + " It is released from rest when it is horizontal.",
        "Energy is conserved: the centre of mass falls by $L/2$.",
        (LENGTH, GRAVITY),
        (
            Line(
                "The kinetic energy at the lowest position.",
                ROD * formula**2 / 2,
                m * g * L / 2,
                r"\tfrac12 I_O\omega^2",
            ),
            Line("The equation is solved for the rate.", rate, formula, r"\omega"),
        ),
        (Asked(r"\omega", "the rate of rotation at the lowest position", formula, "rad/s"),),
    )


def start_of_fall(random: Random) -> Problem:
    """Return a problem that asks for the angular acceleration of a level rod at the moment of its release."""
    acceleration = m * g * (L / 2) / ROD
    formula = Rational(3, 2) * g / L
    return Problem(
        "The start of a fall",
        HANGS + " It is released from rest when it is horizontal.",
        r"The torque of gravity about the upper end is $m g L/2 = I_O\ddot\theta$.",
        (LENGTH, GRAVITY),
        (
            Line("The torque that this acceleration needs.", ROD * formula, m * g * L / 2, r"I_O\ddot\theta"),
            Line("The equation is solved for the angular acceleration.", acceleration, formula, r"\ddot\theta"),
        ),
        (Asked(r"\ddot\theta", "the angular acceleration at the release", formula, "rad/s^2"),),
    )
