"""Exercises on gimbal lock: where it occurs, and what happens near it."""

from random import Random

from sympy import Integer, Matrix, cos, sin, solve

from symrot.exact.decide import normal_form
from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.symbols import omega_1, omega_2, omega_3, phi, psi, theta

SEQUENCES = ("ZXZ", "ZYX", "XYZ", "YXY", "YZX", "XZX")


def determinant(random: Random) -> Problem:
    """Return a problem that asks for the determinant of the matrix from Euler angle rates to omega."""
    sequence = random.choice(SEQUENCES)
    matrix = rate_jacobian(sequence)
    value = normal_form(matrix.determinant)
    return Problem(
        f"The determinant of the rate matrix of {sequence}",
        rf"Intrinsic Euler angles $\phi$, $\theta$, $\psi$ of the sequence {sequence} give the angular velocity in "
        r"the body $\omega = B(\phi, \theta, \psi) \, \dot q$.",
        "Write the rate matrix, whose columns are the three axes of rotation in the body, and take its determinant.",
        (quantity(theta, "30 45 60 120 135 150", "deg", "second angle"),),
        (Line("The determinant depends on the second angle alone.", Matrix(matrix).det(), value, r"\det B"),),
        (Asked(r"\det B", "the determinant", value, ""),),
        sketch=(sequence,),
    )


def growth_near_lock(random: Random) -> Problem:
    """Return a problem near gimbal lock that asks for the rate of the first Euler angle, given the angular velocity."""
    sequence, at = random.choice((("ZXZ", 0), ("ZYX", 90)))
    omega = Matrix((omega_1, omega_2, omega_3))
    rate = normal_form((rate_jacobian(sequence).inv() * omega)[0].subs({psi: 0}))
    used = next(symbol for symbol in omega if rate.has(symbol))
    near = "2 3 4 5" if at == 0 else "85 86 87 88"
    return Problem(
        f"Near the gimbal lock of {sequence}",
        rf"The attitude of a body, given by Euler angles {sequence}, is near gimbal lock, with $\psi = 0$. One body "
        rf"component of its angular velocity is $\{used!s}$.",
        r"Solve $\omega = B \, \dot q$ for the rate of the first angle. A small divisor makes it large.",
        (quantity(theta, near, "deg", "second angle"), quantity(used, "1 2 3 5", "rad/s", "component in the body")),
        (
            Line(
                r"The first row of the inverse, at $\psi = 0$.",
                (rate_jacobian(sequence).inv() * omega)[0].subs({psi: 0}),
                rate,
                r"\dot\phi",
            ),
        ),
        (Asked(r"\dot\phi", "the rate of the first angle", rate, "rad/s"),),
        sketch=(sequence,),
    )


def only_sum_of_angles(random: Random) -> Problem:
    """Return a problem that asks for a matrix entry at gimbal lock, where it depends only on the sum of two angles."""
    matrix = dcm("ZXZ", (phi, Integer(0), psi))
    entry = cos(phi + psi)
    return Problem(
        "The attitude in gimbal lock",
        r"The Euler angles ZXZ of a body are $\phi$, $\theta = 0$, $\psi$, so that the first and third axes coincide.",
        "Two rotations about the same axis add.",
        (quantity(phi, "10 20 30 40 50", "deg", "first angle"), quantity(psi, "10 20 30 40 70", "deg", "third angle")),
        (
            Line(
                r"The product of the two rotations about $z$.",
                matrix[0, 0],
                cos(phi) * cos(psi) - sin(phi) * sin(psi),
                "R_{11}",
            ),
            Line("By the addition theorem, only the sum of the angles remains.", matrix[0, 0], entry, "R_{11}"),
        ),
        (Asked("R_{11}", "the first entry of the rotation matrix", entry, ""),),
        sketch=("ZXZ",),
    )


def angle_of_lock(random: Random) -> Problem:
    """Return a problem that asks for the smallest second angle, zero or more, at which a sequence is in gimbal lock."""
    sequence = random.choice(SEQUENCES)
    determinant_of = normal_form(rate_jacobian(sequence).determinant)
    lock = min(root for root in solve(determinant_of, theta) if root >= 0)
    return Problem(
        f"Where {sequence} locks",
        rf"Intrinsic Euler angles of the sequence {sequence} are used, with the second angle $\theta$ from "
        r"$0^\circ$ to $180^\circ$.",
        "Gimbal lock is where the determinant of the rate matrix is zero.",
        (),
        (
            Line("The determinant of the rate matrix is zero there.", determinant_of.subs(theta, lock), 0, r"\det B"),
            Line("The smallest such angle.", lock, lock, r"\theta"),
        ),
        (
            Asked(
                r"\theta",
                "the smallest second angle, zero or more, at which the sequence locks",
                lock,
                "deg",
                as_formula=False,
            ),
        ),
        sketch=(sequence,),
    )
