"""Exercises on composed rotations: order, resulting angle, relative attitude."""

from random import Random

from sympy import Matrix, acos, cos

from symrot.exact.decide import normal_form
from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.kinematics.rotations import elementary_rotation
from symrot.symbols import phi, theta, x, y, z

ANGLES = "30 45 60 120 135 150"
AXES = "xyz"
FIRST = quantity(phi, ANGLES, "deg", "first angle")
SECOND = quantity(theta, ANGLES, "deg", "second angle")
POINT = tuple(quantity(each, "1 2 3 4 5", "m", "coordinate") for each in (x, y, z))


def point_turned_twice(random: Random) -> Problem:
    """Return a problem that asks for a coordinate of a point after rotations about two axes fixed in space."""
    one, two = random.sample(AXES, 2)
    matrix = elementary_rotation(two, theta) * elementary_rotation(one, phi)
    turned = matrix * Matrix((x, y, z))
    row = max(range(3), key=lambda n: len(turned[n].expand().free_symbols))
    by_steps = elementary_rotation(two, theta) * (elementary_rotation(one, phi) * Matrix((x, y, z)))
    formula = turned[row].expand()
    name = f"{AXES[row]}'"
    used = formula.free_symbols
    return Problem(
        "A point that is rotated twice",
        rf"The point $(x, y, z)$ is rotated by $\phi$ about the fixed axis ${one}$, and then by $\theta$ about the "
        f"fixed axis ${two}$.",
        "Rotations about fixed axes multiply from the left: the matrix of the later rotation is the left factor.",
        tuple(each for each in (FIRST, SECOND, *POINT) if each.symbol in used),
        (
            Line(
                "The matrix of the second rotation times the vector after the first rotation.",
                by_steps[row],
                formula,
                name,
            ),
        ),
        (Asked(name, f"the coordinate of the point along ${AXES[row]}$ afterwards", formula, "m"),),
        sketch=(one, two),
    )


def angle_of_two_rotations(random: Random) -> Problem:
    """Return a problem that asks for the angle of two successive rotations about perpendicular axes."""
    one, two = random.sample(AXES, 2)
    matrix = elementary_rotation(two, theta) * elementary_rotation(one, phi)
    cosine = normal_form((matrix.trace() - 1) / 2)
    angle = acos((matrix.trace() - 1).expand() / 2)
    return Problem(
        "One rotation in place of two",
        rf"A body is rotated by $\phi$ about the fixed axis ${one}$, and then by $\theta$ about the fixed axis "
        rf"${two}$. One rotation by an angle $\alpha$ has the same effect.",
        r"The trace of a rotation matrix is $1 + 2\cos\alpha$.",
        (FIRST, SECOND),
        (
            Line("The trace of the product of both matrices.", (matrix.trace() - 1) / 2, cosine, r"\cos\alpha"),
            Line("The angle between 0 and 180 degrees.", acos((matrix.trace() - 1) / 2), angle, r"\alpha"),
        ),
        (Asked(r"\alpha", "the angle of that rotation", angle, "deg"),),
        sketch=(one, two),
    )


def order_matters(random: Random) -> Problem:
    """Return a problem that asks how far apart the end positions of a pointer are for two orders of two rotations."""
    one, two = random.sample(AXES, 2)
    pointer = Matrix([int(axis == one) for axis in AXES])
    first = elementary_rotation(two, theta) * elementary_rotation(one, phi) * pointer
    second = elementary_rotation(one, phi) * elementary_rotation(two, theta) * pointer
    difference = first - second
    square = normal_form((difference.T * difference)[0].expand())
    return Problem(
        "The order of two rotations",
        rf"A pointer of length 1 is along the fixed axis ${one}$. It is rotated by $\phi$ about ${one}$ and by "
        rf"$\theta$ about ${two}$, once in this order and once in the other.",
        "Rotate the pointer in both orders, and subtract the two results.",
        (FIRST, SECOND),
        (Line("The square of the length of the difference.", (difference.T * difference)[0], square, "d^2"),),
        (Asked("d^2", "the square of the distance of the two end points", square, ""),),
        sketch=(one, two),
    )


def relative_rotation(random: Random) -> Problem:
    """Return a problem that asks for the cosine of the angle of the rotation from one attitude to another."""
    one, two = random.sample(AXES, 2)
    relative = elementary_rotation(one, phi).T * elementary_rotation(two, theta)
    cosine = (relative.trace() - 1).expand() / 2
    return Problem(
        "The angle between two attitudes",
        rf"One camera is rotated by $\phi$ about the axis ${one}$, another camera by $\theta$ about the axis "
        rf"${two}$, from the same attitude. The rotation from one to the other has the angle $\alpha$.",
        r"The relative rotation is $R_1^{\mathsf T} R_2$, and its trace is $1 + 2\cos\alpha$.",
        (FIRST, SECOND),
        (Line("The trace minus one, divided by two.", (relative.trace() - 1) / 2, cosine, r"\cos\alpha"),),
        (Asked(r"\cos\alpha", "the cosine of the angle between the attitudes", cosine, ""),),
        sketch=(one, two),
    )


def rotation_in_steps(random: Random) -> Problem:
    """Return a problem that asks for an entry of the matrix of two rotations about the same axis."""
    axis = random.choice(AXES)
    matrix = elementary_rotation(axis, phi) * elementary_rotation(axis, theta)
    place = next(n for n in range(3) if AXES[n] != axis)
    entry = cos(phi + theta)
    return Problem(
        "Two rotations about one axis",
        rf"A shaft is rotated by $\phi$ and then by $\theta$ about the same axis ${axis}$.",
        "Rotations about the same axis add their angles.",
        (FIRST, SECOND),
        (
            Line(
                "The entry of the product of both matrices.", matrix[place, place], matrix[place, place].expand(), "R"
            ),
            Line("The addition theorem.", matrix[place, place], entry, "R"),
        ),
        (Asked("R", f"the entry ({place + 1}, {place + 1}) of the matrix of both rotations", entry, ""),),
        sketch=(axis, "ϕ", "θ"),
    )
