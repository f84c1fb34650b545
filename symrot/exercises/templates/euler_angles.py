"""Exercises on Euler angles and their rates, for several sequences."""

from random import Random

from sympy import Expr, Matrix, prod, sqrt

from symrot.exact.decide import normal_form
from symrot.exercises.problem import Asked, Line, Problem, Quantity, chain, quantity
from symrot.kinematics.euler import dcm, rate_jacobian
from symrot.kinematics.rotations import elementary_rotation
from symrot.symbols import angle_rates, angles, dphi, dpsi, dtheta, omega_1, omega_2, omega_3, phi, psi, theta

ANGLES = "30 45 60 120 135 150"
RATES = "1 2 3 4 5 6 8 10"
SEQUENCES = ("ZXZ", "ZYX", "ZYZ", "XYZ")
NAMES = {phi: "first angle", theta: "second angle", psi: "third angle"}
MEANING = (
    "Intrinsic Euler angles of the sequence {} are $\\phi$, $\\theta$, $\\psi$, in the order in which they are applied."
)


def _quantities(formula: Expr) -> tuple[Quantity, ...]:
    """Return the angles and rates that occur in a formula as given quantities of an exercise.

    Each has a list of numbers from which its value is drawn.
    """
    used = formula.free_symbols
    first = tuple(quantity(each, ANGLES, "deg", NAMES[each]) for each in angles if each in used)
    second = tuple(
        quantity(rate, RATES, "rad/s", f"rate of the {NAMES[angle]}")
        for rate, angle in zip(angle_rates, angles, strict=True)
        if rate in used
    )
    return first + second


def _rate(random: Random, frame: str) -> Problem:
    sequence = random.choice(SEQUENCES)
    matrix = rate_jacobian(sequence, frame)
    omega = matrix * Matrix(angle_rates)
    row = random.choice([n for n in range(3) if len(omega[n].free_symbols) > 2])
    letter = rf"\omega_{'123'[row] if frame == 'body' else 'xyz'[row]}"
    columns = [matrix[row, n] * rate for n, rate in enumerate(angle_rates)]
    axes = "the body" if frame == "body" else "space"
    return Problem(
        f"Angular velocity from the rates of the angles {sequence}, in {axes}",
        MEANING.format(sequence) + f" Find a component of the angular velocity along axes fixed in {axes}.",
        f"Add the three rotations, each about its own axis, with components in {axes}: $\\omega = B \\, \\dot q$.",
        _quantities(omega[row]),
        (
            Line(
                "The component along the axis of each of the three rotations, times its rate.",
                omega[row],
                sum(columns),
                letter,
            ),
        ),
        (Asked(letter, f"a component of the angular velocity in {axes}", sum(columns), "rad/s"),),
        sketch=(sequence,),
    )


def body_rates(random: Random) -> Problem:
    """Return a problem that asks for a body component of the angular velocity, given the Euler angle rates."""
    return _rate(random, "body")


def space_rates(random: Random) -> Problem:
    """Return a problem that asks for a space component of the angular velocity, given the Euler angle rates."""
    return _rate(random, "space")


def angle_rates_from_omega(random: Random) -> Problem:
    """Return a problem that asks for an Euler angle rate, given the body components of the angular velocity."""
    sequence, place = random.choice((("ZXZ", 0), ("ZYX", 0), ("ZYZ", 0), ("ZXZ", 1)))
    matrix = rate_jacobian(sequence)
    omega = Matrix((omega_1, omega_2, omega_3))
    rate = (matrix.inv() * omega)[place]
    result = normal_form(rate)
    name = (r"\dot\phi", r"\dot\theta", r"\dot\psi")[place]
    rates = tuple(quantity(each, RATES, "rad/s", "component in the body") for each in omega if result.has(each))
    return Problem(
        f"Rates of the angles {sequence} from gyroscopes",
        MEANING.format(sequence)
        + r" Gyroscopes in the body measure the components $\omega_1$, $\omega_2$, $\omega_3$.",
        r"Solve the three equations $\omega = B \, \dot q$ for the rates.",
        _quantities(result) + rates,
        (Line("Row of the inverse of the rate matrix, times the angular velocity.", rate, result, name),),
        (Asked(name, f"the rate of the {('first', 'second', 'third')[place]} angle", result, "rad/s"),),
        sketch=(sequence,),
    )


def matrix_entry(random: Random) -> Problem:
    """Return a problem that asks for an entry of the direction cosine matrix."""
    sequence = random.choice(SEQUENCES)
    matrix = dcm(sequence)
    row, column = random.choice([(i, j) for i in range(3) for j in range(3) if matrix[i, j].is_Add])
    name = f"R_{{{row + 1}{column + 1}}}"
    entry = matrix[row, column]
    return Problem(
        f"An entry of the rotation matrix of the angles {sequence}",
        MEANING.format(sequence) + " The matrix $R$ maps components in the body to components in space.",
        "Multiply the three elementary rotations in the order of the sequence, from left to right.",
        _quantities(entry),
        (Line("The entry of the product of the three rotations.", _product(sequence)[row, column], entry, name),),
        (Asked(name, f"the entry in row {row + 1} and column {column + 1}", entry, ""),),
        sketch=(sequence,),
    )


def _product(sequence: str) -> Matrix:
    """Return the product of the matrices of a sequence's three rotations, which a solution compares with the DCM."""
    return prod(map(elementary_rotation, sequence, angles))


def space_direction_of_axis(random: Random) -> Problem:
    """Return a problem that asks for a space component of the unit vector along the body's third axis."""
    row = random.choice((0, 1))
    entry = dcm("ZXZ")[row, 2]
    name = f"e_{{3,{'xy'[row]}}}"
    return Problem(
        "The direction of a top's axis",
        r"A top has the precession $\phi$, the nutation $\theta$ and the spin $\psi$ (sequence ZXZ). Its axis is "
        "the body axis 3.",
        "The components of a body axis in space are a column of the rotation matrix.",
        _quantities(entry),
        (Line("The entry of the third column.", _product("ZXZ")[row, 2], entry, name),),
        (Asked(name, f"the {'xy'[row]} component of the unit vector along the axis", entry, ""),),
    )


def speed_of_rotation(random: Random) -> Problem:
    """Return a problem that asks for the magnitude of the angular velocity, given the Euler angle rates."""
    sequence = random.choice(("ZXZ", "ZYZ"))
    omega = rate_jacobian(sequence) * Matrix(angle_rates)
    square = normal_form((omega.T * omega)[0].expand())
    speed = sqrt(square)
    return Problem(
        f"The rate of rotation from the angles {sequence}",
        MEANING.format(sequence),
        "Square and add the three components of the angular velocity; most terms with the spin cancel.",
        _quantities(square),
        (
            Line("The sum of the squares of the components.", (omega.T * omega)[0], square, r"|\omega|^2"),
            Line("The square root is taken.", sqrt(square), speed, r"|\omega|"),
        ),
        (Asked(r"|\omega|", "the magnitude of the angular velocity", speed, "rad/s"),),
        sketch=(sequence,),
    )


def vertical_in_body(random: Random) -> Problem:
    """Return a problem that asks for a body component of the vertical, as an accelerometer at rest measures it."""
    sequence = "ZYX"
    row = random.choice((0, 1, 2))
    entry = dcm(sequence)[2, row]
    name = f"\\gamma_{row + 1}"
    return Problem(
        "The vertical in the axes of an aircraft",
        r"Yaw $\phi$, pitch $\theta$ and roll $\psi$ are intrinsic Euler angles of the sequence ZYX; the space "
        "axis $z$ is vertical.",
        "Components in the body follow from components in space by the transpose of the rotation matrix.",
        _quantities(entry),
        chain(name, "The entry of the third row of the matrix.", _product(sequence)[2, row], entry, entry),
        (Asked(name, f"component {row + 1} of the unit vector along $z$, in the body", entry, ""),),
        sketch=(sequence,),
    )


def rate_about_vertical(random: Random) -> Problem:
    """Return a problem that asks for the vertical component of the angular velocity of a top."""
    omega = rate_jacobian("ZXZ", "space") * Matrix((dphi, dtheta, dpsi))
    vertical = omega[2]
    return Problem(
        "Angular velocity about the vertical",
        r"A top precesses at $\dot\phi$ and spins at $\dot\psi$ about its axis, which is at the angle $\theta$ to "
        "the vertical.",
        "The spin contributes its vertical component to the rate about the vertical.",
        _quantities(vertical),
        chain(r"\omega_z", "The vertical components of precession and spin.", vertical, vertical, vertical),
        (Asked(r"\omega_z", "the vertical component of the angular velocity", vertical, "rad/s"),),
    )
