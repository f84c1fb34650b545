"""Exercises on rolling without slipping: inclines, contact, friction."""

from random import Random

from sympy import Expr, cos, sin, solve, sqrt

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.inertia.solids import solid
from symrot.symbols import F_x, R, a_x, alpha, g, h, m, omega_3, v_x

BODIES = ("sphere", "cylinder", "spherical_shell", "ring")
SLOPE = quantity(alpha, "10 15 20 30", "deg", "angle of the incline")
GRAVITY = quantity(g, "9.81", "m/s^2", "gravity")
HEIGHT = quantity(h, "0.2 0.5 1 1.5 2 3", "m", "height")


def _body(random: Random) -> tuple[str, Expr]:
    name = random.choice(BODIES)
    return name.replace("_", " "), solid(name).inertia[2, 2]


def _motion(moment: Expr) -> tuple[Expr, Expr]:
    """Return the acceleration and the friction force of a body that rolls down an incline without slipping.

    ``moment`` is its moment of inertia about its own axis.
    """
    equations = (m * a_x - m * g * sin(alpha) + F_x, moment * a_x / R - F_x * R)
    motion = solve(equations, (a_x, F_x), dict=True)[0]
    return motion[a_x], motion[F_x]


LAW = (
    r"Newton's law along the incline, $m a = m g\sin\alpha - F$, and for the rotation, $I a/R = F R$, because "
    r"$a = R\dot\omega$."
)


def acceleration_on_incline(random: Random) -> Problem:
    """Return a problem that asks for the acceleration of a body that rolls down an incline."""
    name, moment = _body(random)
    acceleration, friction = _motion(moment)
    ratio = (acceleration / (g * sin(alpha))).cancel()
    formula = ratio * g * sin(alpha)
    return Problem(
        f"A {name} on an incline",
        rf"A uniform {name} of mass $m$ and radius $R$ rolls without slipping down an incline at the angle $\alpha$.",
        LAW,
        (GRAVITY, SLOPE),
        (
            Line(
                "Newton's law along the incline, with the friction that the rotation needs.",
                m * formula + friction,
                m * g * sin(alpha),
                "m a + F",
            ),
            Line("Both equations are solved.", acceleration, formula, "a"),
        ),
        (Asked("a", "the acceleration of the centre", formula, "m/s^2"),),
    )


def least_friction(random: Random) -> Problem:
    """Return a problem that asks for the smallest friction coefficient at which a body rolls without slipping."""
    name, moment = _body(random)
    _, friction = _motion(moment)
    ratio = (friction / (m * g * sin(alpha))).cancel()
    formula = ratio * sin(alpha) / cos(alpha)
    return Problem(
        f"The friction that a {name} needs",
        rf"A uniform {name} of mass $m$ and radius $R$ rolls without slipping down an incline at the angle $\alpha$.",
        LAW + r" The normal force is $m g\cos\alpha$.",
        (SLOPE,),
        (
            Line("The friction that the rotation needs.", friction, ratio * m * g * sin(alpha), "F"),
            Line("The friction divided by the normal force.", friction / (m * g * cos(alpha)), formula, r"\mu"),
        ),
        (Asked(r"\mu", "the least coefficient of friction", formula, ""),),
    )


def speed_at_bottom(random: Random) -> Problem:
    """Return a problem that asks for the speed of a body that has rolled down an incline of given height."""
    name, moment = _body(random)
    energy = m * v_x**2 / 2 + moment * (v_x / R) ** 2 / 2
    ratio = ((m * g * h) / (energy / v_x**2) / (g * h)).cancel()
    formula = sqrt(ratio * g * h)
    return Problem(
        f"How fast a {name} arrives",
        f"A uniform {name} of mass $m$ and radius $R$ starts at rest and rolls without slipping down through the "
        "height $h$.",
        "Energy is conserved: the potential energy becomes kinetic energy of the centre and of the rotation.",
        (GRAVITY, HEIGHT),
        (
            Line(
                "The kinetic energy at this speed.",
                energy.subs(v_x, formula),
                m * g * h,
                r"\tfrac12 m v^2 + \tfrac12 I v^2/R^2",
            ),
            Line("The equation is solved for the speed.", formula, formula, "v"),
        ),
        (Asked("v", "the speed of the centre at the bottom", formula, "m/s"),),
    )


def share_of_rotation(random: Random) -> Problem:
    """Return a problem that asks for the share of rotation in the kinetic energy of a rolling body."""
    name, moment = _body(random)
    rotation = moment * (v_x / R) ** 2 / 2
    share = (rotation / (rotation + m * v_x**2 / 2)).cancel()
    return Problem(
        f"The energy of a rolling {name}",
        f"A uniform {name} of mass $m$ and radius $R$ rolls without slipping with the speed $v$.",
        r"The kinetic energy of the centre is $\tfrac12 m v^2$, that of the rotation $\tfrac12 I v^2/R^2$.",
        (),
        (
            Line(
                "The energy of the rotation divided by the total kinetic energy.",
                rotation / (rotation + m * v_x**2 / 2),
                share,
                "s",
            ),
        ),
        (Asked("s", "the share of the kinetic energy that is in the rotation", share, "", as_formula=False),),
    )


def cue_height(random: Random) -> Problem:
    """Return a problem that asks for the height at which a cue hits a ball so that it rolls at once."""
    moment = solid("sphere").inertia[2, 2]
    height = R + moment / (m * R)
    formula = 7 * R / 5
    return Problem(
        "The height at which to hit a billiard ball",
        "A cue gives a billiard ball, a uniform sphere of radius $R$, a horizontal blow at the height $h$ above the "
        "table. The ball rolls without slipping at once, without friction.",
        r"The blow gives $m v = J$ and $I\omega = J (h - R)$; rolling needs $v = R\omega$.",
        (quantity(R, "26 28 30", "mm", "radius"),),
        (Line("The radius plus the moment of inertia divided by mass and radius.", height, formula, "h"),),
        (Asked("h", "the height of the blow above the table", formula, "mm"),),
    )


def top_of_wheel(random: Random) -> Problem:
    """Return a problem that asks for the speed of the top of a wheel that rolls."""
    formula = 2 * R * omega_3
    return Problem(
        "The top of a wheel",
        r"A wheel of radius $R$ rolls without slipping. It rotates at the rate $\omega_3$.",
        "The point of contact is at rest, so the wheel momentarily rotates about it.",
        (quantity(R, "200 250 300 350 400", "mm", "radius"), quantity(omega_3, "60 120 150 300 600", "rpm", "rate")),
        (
            Line(
                "The speed of the centre plus the speed of the top in the rotation about the centre.",
                R * omega_3 + R * omega_3,
                formula,
                "v",
            ),
        ),
        (Asked("v", "the speed of the top of the wheel", formula, "m/s"),),
    )
