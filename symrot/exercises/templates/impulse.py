"""Exercises on impulses: blows on free bodies and on pendulums."""

from collections.abc import Mapping
from random import Random

from sympy import Expr, Symbol, solve

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.inertia.solids import solid
from symrot.symbols import L, Omega, h, m, m_1, m_2

J = Symbol("J", positive=True)
d = Symbol("d", positive=True)
v = Symbol("v", positive=True)
MASS = quantity(m, "1 2 3 4 5 6", "kg", "mass")
LENGTH = quantity(L, "0.3 0.4 0.5 0.6 0.8 1 1.2", "m", "length")
BLOW = quantity(J, "1 2 3 4 5 6 8", "N s", "impulse")
PLACE = quantity(d, "0.05 0.1 0.15 0.2 0.25", "m", "distance")
ROD = solid("rod").inertia[0, 0]
STRUCK = (
    "A thin uniform rod of mass $m$ and length $L$ lies at rest on smooth ice. A blow with the impulse $J$, "
    "perpendicular to the rod, hits it at the distance $d$ from its centre."
)
LAW = r"The impulse changes the momentum by $J$, and the angular momentum about the centre of mass by $J d$."


def _rate() -> Expr:
    """Return the angular velocity of a free rod after a blow J at the distance d from its centre."""
    return solve(ROD * Omega - J * d, Omega)[0]


def _fits(values: Mapping[Symbol, Expr]) -> bool:
    return bool(2 * values[d] <= values[L])


def struck_rod(random: Random) -> Problem:
    """Return a problem that asks for the angular velocity of a free rod after a blow."""
    rate, formula = _rate(), 12 * J * d / (m * L**2)
    return Problem(
        "A rod that is struck",
        STRUCK,
        LAW,
        (MASS, LENGTH, BLOW, PLACE),
        (
            Line("The angular momentum about the centre afterwards.", ROD * rate, J * d, r"\tfrac{1}{12} m L^2 \omega"),
            Line("The equation is solved for the rate.", rate, formula, r"\omega"),
        ),
        (Asked(r"\omega", "the rate of rotation after the blow", formula, "rad/s"),),
        _fits,
    )


def struck_place(random: Random) -> Problem:
    """Return a problem that asks for the speed, after a blow on a free rod, of the point where the blow acts."""
    speed, formula = J / m + _rate() * d, J * (L**2 + 12 * d**2) / (m * L**2)
    return Problem(
        "The point that is struck",
        STRUCK,
        LAW + " The speed of the struck point is that of the centre plus that of the rotation about the centre.",
        (MASS, LENGTH, BLOW, PLACE),
        (
            Line(
                "The speed of the centre plus the speed of the point in the rotation about the centre.",
                speed,
                formula,
                "u",
            ),
        ),
        (Asked("u", "the speed of the point that was struck", formula, "m/s"),),
        _fits,
    )


def energy_of_blow(random: Random) -> Problem:
    """Return a problem that asks for the kinetic energy of a free rod after a blow."""
    energy = m * (J / m) ** 2 / 2 + ROD * _rate() ** 2 / 2
    formula = J**2 * (L**2 + 12 * d**2) / (2 * m * L**2)
    return Problem(
        "The energy of a blow",
        STRUCK,
        LAW + " The kinetic energy is that of the centre of mass plus that of the rotation.",
        (MASS, LENGTH, BLOW, PLACE),
        (Line("The energy of the motion of the centre plus the energy of the rotation.", energy, formula, "T"),),
        (Asked("T", "the kinetic energy after the blow", formula, "J"),),
        _fits,
    )


def resting_point(random: Random) -> Problem:
    """Return a problem that asks where on a rod the point is that stays at rest just after a blow."""
    (point,) = solve(J / m - _rate() * h, h)
    formula = L**2 / (12 * d)
    return Problem(
        "The point that stays at rest",
        STRUCK,
        LAW + " Behind the centre the rotation moves points backwards: at one distance both speeds cancel.",
        (LENGTH, PLACE),
        (
            Line("At this distance the speeds cancel.", (J / m - _rate() * h).subs(h, formula), 0, "v - \\omega x"),
            Line("The equation is solved for the distance.", point, formula, "x"),
        ),
        (
            Asked(
                "x",
                "the distance from the centre of the point that is at rest just after the blow, on the side away from "
                "the blow",
                formula,
                "m",
            ),
        ),
        lambda values: 2 * values[d] <= values[L] and 6 * values[d] >= values[L],
    )


def bullet_and_rod(random: Random) -> Problem:
    """Return a problem that asks for the rate of a hanging rod just after a bullet has stuck in its end."""
    about = solid("rod", mass=m_1).inertia_about((0, 0, L / 2))[0, 0]
    (rate,) = solve((about + m_2 * L**2) * Omega - m_2 * v * L, Omega)
    formula = 3 * m_2 * v / (L * (m_1 + 3 * m_2))
    return Problem(
        "A bullet and a hanging rod",
        "A thin uniform rod of mass $m_1$ and length $L$ hangs at rest from its upper end. A bullet of mass $m_2$ "
        "with the speed $v$ hits its lower end at right angles and stays in it.",
        "The angular momentum about the upper end does not change during the impact.",
        (
            quantity(m_1, "1 2 3 4 5", "kg", "mass of the rod"),
            quantity(m_2, "10 20 50", "g", "mass of the bullet"),
            LENGTH,
            quantity(v, "200 250 300 400 500", "m/s", "speed"),
        ),
        (
            Line(
                "The angular momentum after the impact.",
                (about + m_2 * L**2) * rate,
                m_2 * v * L,
                r"\left(\tfrac13 m_1 L^2 + m_2 L^2\right) \omega",
            ),
            Line("The equation is solved for the rate.", rate, formula, r"\omega"),
        ),
        (Asked(r"\omega", "the rate of rotation just after the impact", formula, "rad/s"),),
    )


def percussion_of_racket(random: Random) -> Problem:
    """Return a problem that asks for the distance of the centre of percussion from the hand that holds a rod."""
    about = solid("rod").inertia_about((0, 0, L / 2))[0, 0]
    place = about / (m * L / 2)
    formula = 2 * L / 3
    return Problem(
        "The sweet spot of a bat",
        "A bat is a thin uniform rod of length $L$ that is held at one end. A blow at the sweet spot gives the "
        "hand no jolt.",
        "A blow at the centre of percussion gives the centre of mass exactly the speed of a rotation about the hand.",
        (LENGTH,),
        (Line("The moment about the end divided by the mass and the distance of the centre.", place, formula, "x"),),
        (Asked("x", "the distance of the sweet spot from the hand", formula, "m"),),
    )
