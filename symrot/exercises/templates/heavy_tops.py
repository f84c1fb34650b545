"""Exercises on heavy symmetric tops: steady precession, energy, momenta, sleeping (spinning upright)."""

from collections.abc import Mapping
from functools import cache
from random import Random

from sympy import Expr, Matrix, Poly, Symbol, cancel, cos, diag, oo, pi, sin, solve, sqrt

from symrot.exact import normal_form
from symrot.exercises.problem import Asked, Line, Problem, Quantity, quantity
from symrot.kinematics.euler import rate_jacobian
from symrot.symbols import A, C, angle_rates, dphi, dpsi, dtheta, g, h, m, omega_3, theta

ABOUT = (
    "A symmetric top of mass $m$ rotates about a fixed point of its axis, at the distance $h$ from the centre of "
    "mass. Its moments about this point are $C$ about the axis and $A$ about a transverse axis."
)
MASS = quantity(m, "0.2 0.4 0.5", "kg", "mass")
DISTANCE = quantity(h, "30 40 50 60 80", "mm", "distance of the centre of mass")
GRAVITY = quantity(g, "9.81", "m/s^2", "gravity")
TRANSVERSE = quantity(A, "0.002 0.003 0.004 0.005", "kg m^2", "transverse moment")
AXIAL = quantity(C, "0.0004 0.0005 0.0008 0.001", "kg m^2", "moment about the axis")
SPIN = quantity(omega_3, "50 80 100 120 200", "rad/s", "rate about the axis")
ANGLE = quantity(theta, "30 45 60", "deg", "angle to the vertical")
PRECESSION = quantity(dphi, "0.5 1 2 3 4 5", "rad/s", "rate of precession")


@cache
def _lagrangian() -> tuple[Expr, Expr]:
    """Return the kinetic and the potential energy of a heavy symmetric top in ZXZ angles."""
    omega = rate_jacobian("ZXZ") * Matrix(angle_rates)
    return (omega.T * diag(A, A, C) * omega)[0] / 2, m * g * h * cos(theta)


@cache
def _condition() -> Expr:
    """Return an expression that is zero in steady precession.

    It is Lagrange's equation of the nutation at a constant angle, divided by the sine of this angle.
    """
    kinetic, potential = _lagrangian()
    moment = (kinetic - potential).diff(theta).subs({dtheta: 0, dpsi: omega_3 - dphi * cos(theta)})
    return cancel(normal_form(moment / sin(theta)))


def _is_possible(values: Mapping[Symbol, Expr]) -> bool:
    """Return whether a body can have the moments of inertia A and C about its tip that ``values`` gives, by symbol."""
    # parallel axes: A is m h^2 plus the moment about the centre of mass, which is at least C/2
    across = values.get(A, oo)
    return bool(across > values.get(m, 0) * values.get(h, 0) ** 2 + values.get(C, 0) / 2)


def _quantities(formula: Expr) -> tuple[Quantity, ...]:
    every = (MASS, DISTANCE, GRAVITY, TRANSVERSE, AXIAL, SPIN, ANGLE, PRECESSION)
    return tuple(each for each in every if formula.has(each.symbol))


def spin_for_precession(random: Random) -> Problem:
    """Return a problem that asks for the spin of a top that a steady precession needs."""
    (spin,) = solve(_condition(), omega_3)
    formula = (m * g * h + A * dphi**2 * cos(theta)) / (C * dphi)
    return Problem(
        "The spin of a steady precession",
        ABOUT + r" It precesses steadily at $\dot\phi$, at the angle $\theta$ to the vertical.",
        r"The torque of gravity equals the rate of the angular momentum: $C\omega_3\dot\phi - "
        r"A\dot\phi^2\cos\theta = m g h$.",
        _quantities(formula),
        (
            Line(
                "The condition of steady precession.",
                _condition().subs(omega_3, formula),
                0,
                r"m g h + A\dot\phi^2\cos\theta - C\omega_3\dot\phi",
            ),
            Line("The equation is solved for the rate about the axis.", spin, formula, r"\omega_3"),
        ),
        (Asked(r"\omega_3", "the rate of rotation about the axis", formula, "rad/s"),),
        _is_possible,
    )


def level_precession(random: Random) -> Problem:
    """Return a problem that asks for the precession of a top with a level axis."""
    level = _condition().subs(theta, pi / 2)
    (rate,) = solve(level, dphi)
    formula = m * g * h / (C * omega_3)
    return Problem(
        "A top with a horizontal axis",
        ABOUT + r" It spins with $\omega_3$ and precesses steadily with its axis level.",
        r"With a horizontal axis the condition of steady precession is $C\omega_3\dot\phi = m g h$.",
        _quantities(formula),
        (
            Line("The condition of steady precession.", level.subs(dphi, formula), 0, r"m g h - C\omega_3\dot\phi"),
            Line("The equation is solved for the rate of precession.", rate, formula, r"\dot\phi"),
        ),
        (Asked(r"\dot\phi", "the rate of precession", formula, "rad/s"),),
        _is_possible,
    )


def slowest_spin(random: Random) -> Problem:
    """Return a problem that asks for the least spin at which a top can precess steadily."""
    discriminant = Poly(_condition(), dphi).discriminant()
    formula = 2 * sqrt(A * m * g * h * cos(theta)) / C
    return Problem(
        "The slowest spin of a steady precession",
        ABOUT + r" It precesses steadily at the angle $\theta$ to the vertical.",
        r"The condition of steady precession is quadratic in $\dot\phi$. Its discriminant must not be negative.",
        _quantities(formula),
        (
            Line(
                "At the slowest spin the discriminant is zero.",
                discriminant.subs(omega_3, formula),
                0,
                r"C^2\omega_3^2 - 4 A m g h\cos\theta",
            ),
            Line("The equation is solved for the rate about the axis.", formula, formula, r"\omega_3"),
        ),
        (Asked(r"\omega_3", "the least rate about the axis", formula, "rad/s"),),
        _is_possible,
    )


def sleeping_top(random: Random) -> Problem:
    """Return a problem that asks for the least spin at which a vertical (sleeping) top is stable."""
    discriminant = Poly(_condition().subs(theta, 0), dphi).discriminant()
    formula = 2 * sqrt(A * m * g * h) / C
    return Problem(
        "A sleeping top",
        ABOUT + " It sleeps: it spins with its axis upright.",
        r"The upright position is stable while $C^2\omega_3^2 > 4 A m g h$.",
        _quantities(formula),
        (
            Line(
                "At the limit, the two rates of precession at a small tilt are equal.",
                discriminant.subs(omega_3, formula),
                0,
                r"C^2\omega_3^2 - 4 A m g h",
            ),
            Line("The equation is solved for the rate about the axis.", formula, formula, r"\omega_3"),
        ),
        (Asked(r"\omega_3", "the least rate about the axis at which the top sleeps", formula, "rad/s"),),
        _is_possible,
    )


def momentum_about_vertical(random: Random) -> Problem:
    """Return a problem that asks for the angular momentum of a top about the vertical."""
    kinetic, _ = _lagrangian()
    momentum = kinetic.diff(dphi).subs(dpsi, omega_3 - dphi * cos(theta))
    formula = A * dphi * sin(theta) ** 2 + C * omega_3 * cos(theta)
    return Problem(
        "The angular momentum about the vertical",
        ABOUT + r" It precesses at $\dot\phi$ at the angle $\theta$ to the vertical and rotates with $\omega_3$ about "
        "its axis.",
        "Add the vertical components of the angular momentum along the axis and perpendicular to it.",
        _quantities(formula),
        (
            Line(
                "The derivative of the kinetic energy with respect to the rate of precession.",
                momentum,
                formula,
                r"p_\phi",
            ),
        ),
        (Asked(r"p_\phi", "the angular momentum about the vertical", formula, "kg m^2/s"),),
        _is_possible,
    )


def energy_of_top(random: Random) -> Problem:
    """Return a problem that asks for the energy of a top in steady precession."""
    kinetic, potential = _lagrangian()
    energy = (kinetic + potential).subs({dtheta: 0, dpsi: omega_3 - dphi * cos(theta)})
    formula = A * dphi**2 * sin(theta) ** 2 / 2 + C * omega_3**2 / 2 + m * g * h * cos(theta)
    return Problem(
        "The energy of a top",
        ABOUT
        + r" It precesses steadily at $\dot\phi$ at the angle $\theta$ to the vertical and rotates with $\omega_3$ "
        "about its axis. Heights are measured from the fixed point.",
        "Add the kinetic energy of the three components of the angular velocity and the potential energy.",
        _quantities(formula),
        (Line("Kinetic and potential energy.", energy, formula, "E"),),
        (Asked("E", "the total energy", formula, "J"),),
        _is_possible,
    )


def slow_precession(random: Random) -> Problem:
    """Return a problem that asks for the slower of the two steady precessions of a top."""
    root = (C * omega_3 - sqrt(C**2 * omega_3**2 - 4 * A * m * g * h * cos(theta))) / (2 * A * cos(theta))
    return Problem(
        "The two precessions of a top",
        ABOUT
        + r" It rotates with $\omega_3$ about its axis and precesses steadily at the angle $\theta$ to the vertical.",
        r"The condition of steady precession is quadratic: $A\cos\theta\,\dot\phi^2 - C\omega_3\dot\phi + m g h = 0$.",
        _quantities(root),
        (
            Line(
                "The quadratic equation is satisfied.",
                _condition().subs(dphi, root),
                0,
                r"A\cos\theta\,\dot\phi^2 - C\omega_3\dot\phi + m g h",
            ),
            Line("The smaller root.", root, root, r"\dot\phi"),
        ),
        (Asked(r"\dot\phi", "the slower rate of precession", root, "rad/s"),),
        lambda v: _is_possible(v) and v[C] ** 2 * v[omega_3] ** 2 > 4 * v[A] * v[m] * v[g] * v[h],
    )
