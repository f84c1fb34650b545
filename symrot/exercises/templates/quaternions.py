"""Exercises on quaternions: product, rotation of a vector, rates."""

from itertools import permutations
from itertools import product as products
from operator import mul
from random import Random

from sympy import Matrix, Symbol, cos, sin, sqrt

from symrot.exercises.problem import Asked, Line, Problem, Quantity, quantity
from symrot.kinematics.quaternion import conjugate, quaternion_product, quaternion_rates, quaternion_to_dcm
from symrot.kinematics.rotation_vector import quaternion_of_axis_angle
from symrot.symbols import alpha, omega_1, omega_2, omega_3, quaternion, second_quaternion

NUMBERS = "-3 -2 -1 1 2 3 4"
UNITS = sorted(
    {tuple(map(mul, sizes, signs)) for sizes in {(5, 5, 5, 5), *permutations((1, 5, 5, 7))}
     for signs in products((-1, 1), repeat=4)}
)  # fmt: skip
"""Ten times the components of unit quaternions with short decimals, as tuples of 4 whole numbers.

The quaternions are (0.5, 0.5, 0.5, 0.5) and (0.1, 0.5, 0.5, 0.7) with components in any order and of any signs."""

PARTS = ("scalar part", "component 1", "component 2", "component 3")
PRODUCT = (
    "Use Hamilton's rules, $ij = k$, $jk = i$, $ki = j$, and $i^2 = j^2 = k^2 = -1$; the order of factors matters."
)


def _numbers(symbols: tuple[Symbol, ...], numbers: str = NUMBERS) -> tuple[Quantity, ...]:
    return tuple(quantity(symbol, numbers, "", "component") for symbol in symbols)


def product(random: Random) -> Problem:
    """Return a problem that asks for a component of a product of quaternions."""
    place = random.randrange(4)
    component = quaternion_product(second_quaternion, quaternion)[place]
    name = f"r_{place}"
    left = _by_vectors(second_quaternion, quaternion)[place]
    return Problem(
        "A product of quaternions",
        "Multiply the quaternions $p = (p_0, p_1, p_2, p_3)$ and $q = (q_0, q_1, q_2, q_3)$ (scalar part first): "
        "$r = p q$.",
        PRODUCT,
        _numbers(second_quaternion) + _numbers(quaternion),
        (
            Line(
                "The scalar part $p_0 q_0 - p \\cdot q$, and the vector $p_0 q + q_0 p + p \\times q$.",
                left,
                component,
                name,
            ),
        ),
        (Asked(name, f"the {PARTS[place]} of the product", component, ""),),
    )


def _by_vectors(p: tuple[Symbol, ...], q: tuple[Symbol, ...]) -> Matrix:
    """Return the product of two quaternions, computed from their scalar and vector parts."""
    u, v = Matrix(p[1:]), Matrix(q[1:])
    return Matrix([p[0] * q[0] - u.dot(v), *(p[0] * v + q[0] * u + u.cross(v))])


def norm_of_product(random: Random) -> Problem:
    """Return a problem that asks for the norm of a product of two quaternions."""
    square = sum(component**2 for component in quaternion_product(second_quaternion, quaternion))
    formula = sqrt(sum(p**2 for p in second_quaternion)) * sqrt(sum(q**2 for q in quaternion))
    return Problem(
        "The norm of a product",
        "The quaternions $p = (p_0, p_1, p_2, p_3)$ and $q = (q_0, q_1, q_2, q_3)$ are multiplied. Their norms need "
        "not be 1.",
        "The norm of a product of quaternions is the product of their norms.",
        _numbers(second_quaternion, "0 1 2 3 4") + _numbers(quaternion, "0 1 2 3 4"),
        (
            Line("The square of the norm of the product.", square, formula**2, "|pq|^2"),
            Line("The square root is taken.", sqrt(formula**2), formula, "|pq|"),
        ),
        (Asked("|pq|", "the norm of the product", formula, ""),),
        lambda values: all(any(values[each] != 0 for each in group) for group in (second_quaternion, quaternion)),
    )


def component_of_rotation(random: Random) -> Problem:
    """Return a problem that asks for a component of the quaternion of a rotation with given axis and angle."""
    place = random.choice((0, 3))
    q = quaternion_of_axis_angle((0, 0, 1), alpha)
    formula = cos(alpha / 2) if place == 0 else sin(alpha / 2)
    return Problem(
        "The quaternion of a rotation",
        r"A body is rotated by $\alpha$ about the $z$ axis.",
        "A quaternion has half the angle of the rotation.",
        (quantity(alpha, "30 45 60 90 120 180", "deg", "angle"),),
        (Line("The component of the quaternion of axis and angle.", q[place], formula, f"q_{place}"),),
        (Asked(f"q_{place}", f"the {PARTS[place]} of its quaternion", formula, ""),),
        sketch=("z",),
    )


def rotated_vector(random: Random) -> Problem:
    """Return a problem that asks for a component of a unit vector that is rotated by a quaternion."""
    row, column = random.choice([(i, j) for i in range(3) for j in range(3)])
    unit = [0, *(int(n == column) for n in range(3))]
    rotated = quaternion_product(quaternion, unit, conjugate(quaternion))[row + 1].expand()
    entry = quaternion_to_dcm(quaternion, form="homogeneous")[row, column]
    name = f"v_{row + 1}"
    return Problem(
        "A vector that is rotated by a quaternion",
        f"The unit vector along body axis {column + 1} is rotated by the quaternion $(q_0, q_1, q_2, q_3)$ as $v = "
        "q e \\bar q$. The norm of the quaternion need not be 1.",
        r"Multiply $q$, the vector as a quaternion without scalar part, and the conjugate of $q$.",
        _numbers(tuple(symbol for symbol in quaternion if entry.has(symbol))),
        (Line("The component of the triple product.", rotated, entry, name),),
        (Asked(name, f"component {row + 1} of the rotated vector", entry, ""),),
        sketch=(str(column + 1),),
    )


def rate_of_component(random: Random) -> Problem:
    """Return a problem that asks for the time derivative of a quaternion component, given omega."""
    place = random.randrange(4)
    rate = (quaternion_rates("body") * Matrix((omega_1, omega_2, omega_3)))[place]
    product_of = quaternion_product(quaternion, (0, omega_1, omega_2, omega_3))[place] / 2
    formula = product_of.expand()
    used = formula.free_symbols
    return Problem(
        "The rate of a quaternion",
        "The attitude of a body is the unit quaternion $(q_0, q_1, q_2, q_3)$, body to space. Its angular "
        r"velocity in the body is $(\omega_1, \omega_2, \omega_3)$.",
        r"The rate is $\dot q = \tfrac12 q \, \omega$, with the angular velocity as a quaternion without scalar part.",
        (
            *(quantity(q, "-0.5 0.5", "", "component") for q in quaternion if q in used),
            *(
                quantity(w, "1 2 3 4 5", "rad/s", "component in the body")
                for w in (omega_1, omega_2, omega_3)
                if w in used
            ),
        ),
        (
            Line(r"A component of half the product $q \, \omega$.", rate, product_of, rf"\dot q_{place}"),
            Line("The product is multiplied out.", rate, formula, rf"\dot q_{place}"),
        ),
        (Asked(rf"\dot q_{place}", f"the rate of the {PARTS[place]}", formula, "1/s"),),
    )


def angle_between(random: Random) -> Problem:
    """Return a problem that asks for the cosine of half the angle between two attitudes, given as quaternions."""
    relative = quaternion_product(conjugate(second_quaternion), quaternion)[0]
    p = random.choice(UNITS)
    q = random.choice([each for each in UNITS if 0 < sum(map(mul, p, each)) < 100])
    pairs = zip((*second_quaternion, *quaternion), (*p, *q), strict=True)
    return Problem(
        "The angle between two quaternions",
        "Two attitudes are the unit quaternions $p$ and $q$. The rotation from one to the other is $\\bar p q$. Its "
        "scalar part is positive, so that its angle $\\alpha$ is less than $180^\\circ$.",
        "The scalar part of a unit quaternion is the cosine of half the angle.",
        tuple(quantity(symbol, str(tenths / 10), "", "component") for symbol, tenths in pairs),
        (Line("The scalar part of the relative quaternion.", relative, relative, r"\cos(\alpha/2)"),),
        (Asked(r"\cos(\alpha/2)", "the cosine of half the angle between the attitudes", relative, ""),),
    )


def twice_the_angle(random: Random) -> Problem:
    """Return a problem that asks for the scalar part of a squared quaternion; the square rotates by twice the angle."""
    half = quaternion_of_axis_angle((0, 0, 1), alpha)
    square = quaternion_product(half, half)[0]
    return Problem(
        "A rotation that is repeated",
        r"A rotation by $\alpha$ about the $z$ axis is done twice. Its quaternion is multiplied by itself.",
        "The scalar part of the square is the cosine of the whole angle, because each factor has half of it.",
        (quantity(alpha, "30 45 60 90 120", "deg", "angle"),),
        (
            Line("The scalar part of the product.", square, cos(alpha / 2) ** 2 - sin(alpha / 2) ** 2, "r_0"),
            Line("The double-angle formula.", square, cos(alpha), "r_0"),
        ),
        (Asked("r_0", "the scalar part of the quaternion of both rotations together", cos(alpha), ""),),
        sketch=("z", "α", "α"),
    )
