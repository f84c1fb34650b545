"""Exercises on the stability of rotations about the principal axes."""

from collections.abc import Mapping
from random import Random

from sympy import Expr, Matrix, Symbol, sqrt

from symrot.dynamics.equations import euler_equations
from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.inertia.solids import solid
from symrot.symbols import A, B, C, Omega, a, b, c, omega_1, omega_2, omega_3

OMEGA = (omega_1, omega_2, omega_3)
MOMENTS = (
    quantity(A, "6 7 8 9 10", "kg m^2", "largest moment"),
    quantity(B, "4 5 6 7", "kg m^2", "intermediate moment"),
    quantity(C, "1 2 3 4", "kg m^2", "smallest moment"),
)
RATE = quantity(Omega, "1 2 3 4 5 6", "rad/s", "rate of rotation")
LAW = (
    r"Linearise Euler's equations for the two small components perpendicular to the axis. Both satisfy $\ddot x = \mu "
    r"x$ with the same $\mu$."
)


def _factor(axis: int) -> Expr:
    """Return the factor mu in ``x'' = mu x``, the equation of small disturbances of rotation about a principal axis.

    ``axis`` is 0, 1 or 2. The rotation is unstable if mu is positive.
    """
    rates = euler_equations(torque=None)
    one, two = (n for n in range(3) if n != axis)
    jacobian = Matrix([[rates[i].diff(OMEGA[j]) for j in (one, two)] for i in (one, two)])
    steady = {omega: Omega if n == axis else 0 for n, omega in enumerate(OMEGA)}
    return (jacobian.subs(steady) ** 2)[0, 0]


def _ordered(values: Mapping[Symbol, Expr]) -> bool:
    return bool(values[A] > values[B] > values[C] and values[B] + values[C] > values[A])


def growth_rate(random: Random) -> Problem:
    """Return a problem that asks how fast a disturbance of a rotation about the intermediate axis grows."""
    square = _factor(1)
    written = Omega**2 * (A - B) * (B - C) / (A * C)
    formula = Omega * sqrt((A - B) * (B - C) / (A * C))
    return Problem(
        "The intermediate axis",
        r"A free body with the moments $A > B > C$ rotates at $\Omega$ about its intermediate axis. A small "
        r"disturbance grows as $e^{\lambda t}$.",
        LAW,
        (*MOMENTS, RATE),
        (
            Line("An entry of the square of the matrix of the linear equations.", square, written, r"\lambda^2"),
            Line("The square root is taken.", sqrt(written), formula, r"\lambda"),
        ),
        (Asked(r"\lambda", "the rate of growth", formula, "1/s"),),
        _ordered,
    )


def _swing(axis: int, which: str) -> Problem:
    square = -_factor(axis)
    one, two = (moment for n, moment in enumerate((A, B, C)) if n != axis)
    about = (A, B, C)[axis]
    differences = (about - one) * (about - two) if axis == 0 else (one - about) * (two - about)
    written = Omega**2 * differences / (one * two)
    formula = Omega * sqrt(differences / (one * two))
    return Problem(
        f"Small oscillations about the axis of the {which} moment",
        rf"A free body with the moments $A > B > C$ rotates at $\Omega$ about the axis of its {which} moment. A small "
        r"disturbance oscillates as $\cos\nu t$.",
        LAW,
        (*MOMENTS, RATE),
        (
            Line("An entry of the square of the matrix of the linear equations, negated.", square, written, r"\nu^2"),
            Line("The square root is taken.", sqrt(written), formula, r"\nu"),
        ),
        (Asked(r"\nu", "the rate of the oscillation in the body", formula, "rad/s"),),
        _ordered,
    )


def swing_about_largest(random: Random) -> Problem:
    """Return a problem that asks for the rate of small oscillations about the axis of the largest moment."""
    return _swing(0, "largest")


def swing_about_smallest(random: Random) -> Problem:
    """Return a problem that asks for the rate of small oscillations about the axis of the smallest moment."""
    return _swing(2, "smallest")


def thrown_book(random: Random) -> Problem:
    """Return a problem that asks for the growth rate of a disturbance of a book that spins about its middle axis."""
    inertia = solid("box").inertia
    moments = {A: inertia[0, 0], B: inertia[1, 1], C: inertia[2, 2]}
    square = _factor(1).subs(moments, simultaneous=True)
    written = Omega**2 * (a**2 - b**2) * (b**2 - c**2) / ((b**2 + c**2) * (a**2 + b**2))
    return Problem(
        "A thrown book",
        r"A uniform book has the sides $a > b > c$. It is thrown with the rate $\Omega$ about the axis parallel to "
        r"the side $b$, the intermediate axis. A small disturbance grows as $e^{\lambda t}$.",
        LAW + " The moments are those of a box.",
        (
            quantity(a, "200 240 300", "mm", "longest side"),
            quantity(b, "120 150 180", "mm", "middle side"),
            quantity(c, "20 30 40 50", "mm", "shortest side"),
            RATE,
        ),
        (
            Line("The square of the rate with the moments of a box; the mass cancels.", square, written, r"\lambda^2"),
            Line("The square root is taken.", sqrt(written), sqrt(written), r"\lambda"),
        ),
        (Asked(r"\lambda", "the rate of growth", sqrt(written), "1/s"),),
    )
