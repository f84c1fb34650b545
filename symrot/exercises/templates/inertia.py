"""Exercises on moments and products of inertia: solids, parallel axes, composite bodies, principal axes."""

from random import Random

from sympy import Expr, Matrix, eye, factor, sqrt

from symrot.exercises.problem import Asked, Line, Problem, chain, quantity, written_sum
from symrot.inertia.solids import Solid, solid
from symrot.symbols import R_1, R_2, I_xx, I_xy, I_yy, L, R, a, b, c, h, m, m_1, m_2

MASSES = "2 3 4 5 6 8 10 12 15 20"
LENGTHS = "0.2 0.3 0.4 0.5 0.6 0.8 1 1.2 1.5 2"
RADII = "50 80 100 120 150 200 250 300 400 500"
PARALLEL = "Use the parallel axis theorem, $I_O = I_C + m d^2$, from the centre of mass."
ADD = "The terms are added."

MASS = quantity(m, MASSES, "kg", "mass")
LENGTH = quantity(L, LENGTHS, "m", "length")
RADIUS = quantity(R, RADII, "mm", "radius")


def _about(body: Solid, point: tuple[Expr, ...], axis: int, distance: Expr) -> tuple[Expr, tuple[Line, ...]]:
    """Return a body's moment of inertia about an axis, and the lines of a solution that prove it.

    The axis has the direction ``axis`` (0, 1 or 2) and passes through ``point``; ``distance`` is its distance from the
    centre of mass.
    """
    moment = body.inertia_about(point)[axis, axis]
    law = "The parallel axis theorem, from the centre of mass to the axis."
    return moment, chain("I_O", law, moment, written_sum(body.inertia[axis, axis], m * distance**2), moment, ADD)


def rod_about_end(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a rod about its end."""
    moment, lines = _about(solid("rod"), (0, 0, L / 2), 0, L / 2)
    return Problem(
        "A rod about its end",
        "A thin uniform rod of mass $m$ and length $L$ swings about an axis through its end, normal to the rod.",
        PARALLEL,
        (MASS, LENGTH),
        lines,
        (Asked("I_O", "the moment of inertia about the axis", moment, "kg m^2"),),
    )


def rod_about_point(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a rod about a point between centre and end."""
    distance = L / random.choice((3, 4, 6))
    moment, lines = _about(solid("rod"), (0, 0, distance), 0, distance)
    return Problem(
        "A rod on an axle away from its centre",
        f"A thin uniform rod of mass $m$ and length $L$ rotates about a perpendicular axle at $L/{L / distance}$ from "
        "its centre.",
        PARALLEL,
        (MASS, LENGTH),
        lines,
        (Asked("I_O", "the moment of inertia about the axle", moment, "kg m^2"),),
    )


SOLIDS = ("cylinder", "sphere", "cone", "spherical_shell", "disk", "ring")
"""Bodies whose moment about their axis depends on mass and radius alone."""


def _second_moments(body: Solid) -> tuple[Expr, Expr]:
    """Return the integrals of x^2 and of y^2 over the mass of a body; their sum is I_zz."""
    steps = {step.quantity: step for step in body.steps}
    return steps["second moment xx"].value, steps["second moment yy"].value


def _by_integration(body: Solid) -> tuple[Expr, tuple[Line, ...]]:
    """Return a body's moment of inertia about z, and the lines of a solution that adds two integrals to obtain it."""
    moment = body.inertia[2, 2]
    law = "The integrals of $x^2$ and of $y^2$ over the mass are added."
    return moment, chain("I_{zz}", law, moment, written_sum(*_second_moments(body)), moment, ADD)


def solid_about_axis(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a body of revolution about its axis."""
    body = solid(random.choice(SOLIDS))
    moment, lines = _by_integration(body)
    name = body.name.replace("_", " ")
    return Problem(
        f"A uniform {name} about its axis",
        f"A uniform {name} has mass $m$ and radius $R$. Consider its axis of symmetry, $z$.",
        "Integrate the square of the distance from the axis, $x^2 + y^2$, over the mass.",
        (MASS, RADIUS),
        lines,
        (Asked("I_{zz}", "the moment of inertia about the axis", moment, "kg m^2"),),
        sketch=(body.name,),
    )


def hollow_cylinder(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a thick-walled tube about its axis."""
    moment, lines = _by_integration(solid("hollow_cylinder"))
    return Problem(
        "A tube about its axis",
        "A uniform tube of mass $m$ has the inner radius $R_1$ and the outer radius $R_2$. Consider its axis, $z$.",
        "Integrate the square of the distance from the axis over the wall of the tube.",
        (MASS, quantity(R_1, RADII, "mm", "inner radius"), quantity(R_2, RADII, "mm", "outer radius")),
        lines,
        (Asked("I_{zz}", "the moment of inertia about the axis", moment, "kg m^2"),),
        lambda values: values[R_1] < values[R_2],
    )


def box_about_axis(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a box about an axis through its centre."""
    moment, lines = _by_integration(solid("box"))
    return Problem(
        "A box about its axis",
        "A uniform box of mass $m$ has the sides $a$, $b$ and $c$ along $x$, $y$ and $z$. Its centre is the origin.",
        "Integrate $x^2 + y^2$ over the mass.",
        (MASS, quantity(a, LENGTHS, "m", "side"), quantity(b, LENGTHS, "m", "side")),
        lines,
        (Asked("I_{zz}", "the moment of inertia about the $z$ axis", moment, "kg m^2"),),
    )


def box_about_edge(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a box about one of its edges."""
    body = solid("box")
    moment = body.inertia_about((a / 2, b / 2, 0))[2, 2]
    written = written_sum(body.inertia[2, 2], m * (a / 2) ** 2, m * (b / 2) ** 2)
    return Problem(
        "A crate that tips about its edge",
        "A uniform crate of mass $m$ tips about one of its edges. Its sides perpendicular to the edge are $a$ and $b$.",
        PARALLEL,
        (MASS, quantity(a, LENGTHS, "m", "side"), quantity(b, LENGTHS, "m", "side")),
        chain("I_O", "The parallel axis theorem, from the centre of mass to the edge.", moment, written, moment, ADD),
        (Asked("I_O", "the moment of inertia about the edge", moment, "kg m^2"),),
    )


def disk_about_rim(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a disk about a normal axis through its rim."""
    moment, lines = _about(solid("disk"), (R, 0, 0), 2, R)
    return Problem(
        "A disk that hangs from its rim",
        "A thin uniform disk of mass $m$ and radius $R$ hangs from a nail at its rim and swings in its own plane.",
        PARALLEL,
        (MASS, RADIUS),
        lines,
        (Asked("I_O", "the moment of inertia about the nail", moment, "kg m^2"),),
    )


def cone_about_apex(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a cone about a transverse axis through its apex."""
    body = solid("cone")
    moment = body.inertia_about((0, 0, h))[0, 0]
    written = written_sum(body.inertia[0, 0], m * (h - body.center_of_mass[2]) ** 2)
    return Problem(
        "A cone about its apex",
        "A uniform cone of mass $m$, base radius $R$ and height $h$ swings about an axis through its apex that is "
        "perpendicular to its own axis.",
        PARALLEL + " The centre of mass is at $3h/4$ from the apex.",
        (MASS, RADIUS, quantity(h, LENGTHS, "m", "height")),
        chain("I_O", "The parallel axis theorem, from the centre of mass to the apex.", moment, written, moment, ADD),
        (Asked("I_O", "the moment of inertia about the axis", moment, "kg m^2"),),
    )


def rod_with_ball(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a rod with a ball at its end."""
    rod, ball = solid("rod", mass=m_1), solid("sphere", mass=m_2)
    parts = rod.inertia_about((0, 0, L / 2))[0, 0], ball.inertia_about((0, 0, L + R))[0, 0]
    moment = factor(sum(parts))
    shifted = rod.inertia[0, 0] + m_1 * (L / 2) ** 2, ball.inertia[0, 0] + m_2 * (L + R) ** 2
    return Problem(
        "A pendulum with a ball",
        "A thin uniform rod of mass $m_1$ and length $L$ hangs from its upper end. A uniform ball of mass $m_2$ "
        "and radius $R$ is fixed to its lower end, so that the ball's centre is at $L + R$ from the upper end.",
        "Add the moments of the parts about the same axis, each by the parallel axis theorem.",
        (
            quantity(m_1, MASSES, "kg", "mass of the rod"),
            quantity(m_2, MASSES, "kg", "mass of the ball"),
            LENGTH,
            quantity(R, RADII, "mm", "radius"),
        ),
        (
            Line("The rod about its end, and the ball about a point outside it.", moment, written_sum(*shifted), "I_O"),
            Line(ADD, sum(parts), moment, "I_O"),
        ),
        (Asked("I_O", "the moment of inertia about the upper end", moment, "kg m^2"),),
        lambda values: values[R] < values[L] / 2,
    )


def drilled_disk(random: Random) -> Problem:
    """Return a problem that asks for the moment of inertia of a disk with a concentric hole."""
    rho = m / (R_2**2 - R_1**2)
    outer, inner = solid("disk", radius=R_2, mass=rho * R_2**2), solid("disk", radius=R_1, mass=rho * R_1**2)
    moment = factor(outer.inertia[2, 2] - inner.inertia[2, 2])
    written = written_sum(outer.inertia[2, 2], -inner.inertia[2, 2])
    return Problem(
        "A washer",
        "A thin uniform washer of mass $m$ has a hole of radius $R_1$ and the outer radius $R_2$. Consider its "
        "axis of symmetry.",
        "Subtract the moment of the disk that was cut out from the moment of the whole disk; the masses are "
        "proportional to the areas.",
        (MASS, quantity(R_1, RADII, "mm", "radius of the hole"), quantity(R_2, RADII, "mm", "outer radius")),
        chain("I_{zz}", "The whole disk minus the disk that was cut out.", moment, written, moment),
        (Asked("I_{zz}", "the moment of inertia about the axis", moment, "kg m^2"),),
        lambda values: values[R_1] < values[R_2],
    )


def product_of_triangle(random: Random) -> Problem:
    """Return a problem that asks for the product of inertia of a right triangle about its right-angled corner."""
    plate = solid("triangular_plate", base=b, height=h, apex=0)
    center = plate.center_of_mass
    product = plate.inertia_about((0, 0, 0))[0, 1]
    written = written_sum(plate.inertia[0, 1], -m * center[0] * center[1])
    return Problem(
        "The product of inertia of a set square",
        "A thin uniform plate of mass $m$ is a right triangle with the legs $b$ along $x$ and $h$ along $y$. The "
        "origin is at the right angle. The product of inertia is $I_{xy} = -\\int x y \\, dm$.",
        "Use the parallel axis theorem for products, $I_{xy} = I_{C,xy} - m x_C y_C$.",
        (MASS, quantity(b, LENGTHS, "m", "leg"), quantity(h, LENGTHS, "m", "leg")),
        chain(
            "I_{xy}",
            "The product about the centre of mass, and the parallel axis theorem.",
            product,
            written,
            product,
            ADD,
        ),
        (Asked("I_{xy}", "the product of inertia about the corner with the right angle", product, "kg m^2"),),
    )


def product_of_two_masses(random: Random) -> Problem:
    """Return a problem that asks for the product of inertia of two small masses."""
    bodies = solid("point_masses", masses=(m_1, m_2), points=((a, b, 0), (-b, c, 0)))
    product = bodies.inertia_about((0, 0, 0))[0, 1]
    return Problem(
        "Two masses on a plate",
        "A small mass $m_1$ is at the point $(a, b)$ and a small mass $m_2$ at $(-b, c)$ of the $x$-$y$ plane. "
        "The product of inertia about the origin is $I_{xy} = -\\sum m x y$.",
        "Add $-m x y$ for both masses, with the signs of the coordinates.",
        (
            quantity(m_1, MASSES, "kg", "first mass"),
            quantity(m_2, MASSES, "kg", "second mass"),
            *(quantity(symbol, LENGTHS, "m", "coordinate") for symbol in (a, b, c)),
        ),
        chain(
            "I_{xy}",
            "The sum over both masses.",
            product,
            written_sum(-m_1 * a * b, m_2 * b * c),
            product,
            "The common factor is put in front.",
        ),
        (Asked("I_{xy}", "the product of inertia about the origin", product, "kg m^2"),),
        lambda values: values[m_1] * values[a] != values[m_2] * values[c],
    )


def principal_moment(random: Random) -> Problem:
    """Return a problem that asks for the larger of the two principal moments in the plane of a plate."""
    tensor = Matrix([[I_xx, I_xy], [I_xy, I_yy]])
    moment = (I_xx + I_yy) / 2 + sqrt((I_xx - I_yy) ** 2 + 4 * I_xy**2) / 2
    values = tensor.eigenvals(multiple=True)
    (largest,) = (value for value in values if (value - moment).equals(0))
    return Problem(
        "A principal moment of inertia",
        "In its own plane a plate has the moments $I_{xx}$, $I_{yy}$ and the product $I_{xy}$.",
        "For a principal moment $I$, the determinant of the tensor minus $I$ times the unit matrix is zero.",
        (
            quantity(I_xx, "4 5 6 7 8 9 10 12", "kg m^2", "moment"),
            quantity(I_yy, "1 2 3 4 5 6", "kg m^2", "moment"),
            quantity(I_xy, "1.5 2 3 4 6", "kg m^2", "product"),
        ),
        (
            Line(
                "The determinant is zero at the principal moment $I_1$.",
                (tensor - largest * eye(2)).det(),
                0,
                r"(I_{xx} - I_1)(I_{yy} - I_1) - I_{xy}^2",
            ),
            Line("The larger root of this quadratic equation.", largest, moment, "I_1"),
        ),
        (Asked("I_1", "the larger principal moment", moment, "kg m^2"),),
        lambda numbers: numbers[I_xx] * numbers[I_yy] > numbers[I_xy] ** 2,
    )


def radius_of_gyration(random: Random) -> Problem:
    """Return a problem that asks for the radius of gyration of a rod about its end."""
    moment = solid("rod").inertia_about((0, 0, L / 2))[0, 0]
    radius = sqrt(moment / m)
    return Problem(
        "A radius of gyration",
        "A thin uniform rod of length $L$ rotates about an axis through its end, normal to the rod.",
        "The radius of gyration $k$ is defined by $I_O = m k^2$.",
        (LENGTH,),
        (
            Line("The moment about the end, divided by the mass.", moment / m, L**2 / 3, "k^2"),
            Line("The square root is taken.", radius, L / sqrt(3), "k"),
        ),
        (Asked("k", "the radius of gyration", L / sqrt(3), "m"),),
    )
