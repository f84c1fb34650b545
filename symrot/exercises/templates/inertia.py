"""Moments and products of inertia: solids, parallel axes, composite bodies, principal axes."""

from random import Random

from sympy import Expr

from symrot.exercises.problem import Asked, Line, Problem, quantity, written_sum
from symrot.inertia.solids import Solid, solid
from symrot.symbols import L, R, m

MASSES = "2 3 4 5 6 8 10 12 15 20"
LENGTHS = "0.2 0.3 0.4 0.5 0.6 0.8 1 1.2 1.5 2"
RADII = "50 80 100 120 150 200 250 300 400 500"


def rod_about_end(random: Random) -> Problem:
    """A uniform rod about an axis through its end."""
    rod = solid("rod")
    about_end = rod.inertia_about((0, 0, L / 2))[0, 0]
    return Problem(
        "A rod about its end",
        "A thin uniform rod of mass $m$ and length $L$ swings about an axis through its end, normal to the rod.",
        "Use the parallel axis theorem: start from the moment about the centre of mass.",
        (quantity(m, MASSES, "kg", "mass"), quantity(L, LENGTHS, "m", "length")),
        (
            Line(
                "The parallel axis theorem, from the centre to the end.",
                about_end,
                written_sum(rod.inertia[0, 0], m * (L / 2) ** 2),
                "I_O",
            ),
            Line("The two terms are added.", rod.inertia[0, 0] + m * (L / 2) ** 2, about_end, "I_O"),
        ),
        (Asked("I_O", "the moment of inertia about the axis", about_end, "kg m^2"),),
    )


SOLIDS = ("cylinder", "sphere", "cone", "spherical_shell", "disk", "ring")
"""Bodies whose moment about their axis depends on mass and radius alone."""


def solid_about_axis(random: Random) -> Problem:
    """A body of revolution about its axis, from the integral of its map."""
    body = solid(random.choice(SOLIDS))
    moment = body.inertia[2, 2]
    name = body.name.replace("_", " ")
    return Problem(
        f"A uniform {name} about its axis",
        f"A uniform {name} has mass $m$ and radius $R$. Consider its axis of symmetry.",
        "Integrate the square of the distance from the axis over the mass.",
        (quantity(m, MASSES, "kg", "mass"), quantity(R, RADII, "mm", "radius")),
        (
            Line(
                "The sum of the second moments of mass in $x$ and $y$.",
                moment,
                written_sum(*_second_moments(body)),
                "I_{zz}",
            ),
            Line("The two integrals are added.", sum(_second_moments(body)), moment, "I_{zz}"),
        ),
        (Asked("I_{zz}", "the moment of inertia about the axis", moment, "kg m^2"),),
    )


def _second_moments(body: Solid) -> tuple[Expr, Expr]:
    """Return the integrals of x^2 and y^2 over the mass of a body."""
    steps = {step.quantity: step for step in body.steps}
    return steps["second moment xx"].value, steps["second moment yy"].value


def disk_about_rim(random: Random) -> Problem:
    """A disk about an axis through its rim, normal to it."""
    disk = solid("disk")
    moment = disk.inertia_about((R, 0, 0))[2, 2]
    shifted = written_sum(disk.inertia[2, 2], m * R**2)
    return Problem(
        "A disk that hangs from its rim",
        "A thin uniform disk of mass $m$ and radius $R$ hangs from a nail at its rim and swings in its own plane.",
        "Use the parallel axis theorem with the distance from the centre to the nail.",
        (quantity(m, MASSES, "kg", "mass"), quantity(R, RADII, "mm", "radius")),
        (
            Line("The parallel axis theorem, from the centre to the rim.", moment, shifted, "I_O"),
            Line("The two terms are added.", shifted, moment, "I_O"),
        ),
        (Asked("I_O", "the moment of inertia about the nail", moment, "kg m^2"),),
    )
