"""Exercises on the axis and angle of a rotation."""

from random import Random

from sympy import Matrix, Rational, cos, sin, tan

from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.kinematics.rotation_vector import dcm_of_axis_angle
from symrot.kinematics.rotations import skew
from symrot.symbols import alpha, x, y, z

ANGLES = "30 45 60 90 120"
AXES = ((1, 2, 2), (2, 1, 2), (2, 2, 1), (2, 3, 6), (6, 2, 3), (3, 6, 2))
ANGLE = quantity(alpha, ANGLES, "deg", "angle")
POINT = tuple(quantity(each, "1 2 3 4 5", "m", "coordinate") for each in (x, y, z))


def _axis(random: Random) -> tuple[Matrix, str]:
    """Return a random unit vector with rational components, and its LaTeX text for the statement of the exercise."""
    components = random.choice(AXES)
    length = sum(component**2 for component in components) ** Rational(1, 2)
    return Matrix(components) / length, rf"\tfrac1{length}({', '.join(map(str, components))})"


def rotated_point(random: Random) -> Problem:
    """Return a problem that asks for a coordinate of a point after a rotation about an inclined axis."""
    axis, text = _axis(random)
    point = Matrix((x, y, z))
    row = random.randrange(3)
    rotated = (dcm_of_axis_angle(axis, alpha) * point)[row]
    parts = point * cos(alpha) + axis.cross(point) * sin(alpha) + axis * axis.dot(point) * (1 - cos(alpha))
    formula = parts[row].expand()
    name = f"{'xyz'[row]}'"
    return Problem(
        "A rotation about an inclined axis",
        rf"The point $(x, y, z)$ is rotated by $\alpha$ about the axis through the origin along $n = {text}$.",
        r"Rodrigues' formula: $r' = r\cos\alpha + (n \times r)\sin\alpha + n (n \cdot r)(1 - \cos\alpha)$.",
        (ANGLE, *POINT),
        (
            Line("A component of Rodrigues' formula.", rotated, parts[row], name),
            Line("The terms are multiplied out.", rotated, formula, name),
        ),
        (Asked(name, f"the coordinate of the point along ${'xyz'[row]}$ afterwards", formula, "m"),),
    )


def trace_of_rotation(random: Random) -> Problem:
    """Return a problem that asks for the trace of the matrix of a rotation by a given angle."""
    axis, text = _axis(random)
    trace = dcm_of_axis_angle(axis, alpha).trace()
    formula = 1 + 2 * cos(alpha)
    return Problem(
        "The trace of a rotation",
        rf"A body is rotated by $\alpha$ about the axis along $n = {text}$.",
        "The trace of a matrix is the same in all axes: choose axes with one of them along $n$.",
        (ANGLE,),
        (Line("The trace of the rotation matrix of axis and angle.", trace, formula, "T"),),
        (Asked("T", "the trace of the rotation matrix", formula, ""),),
    )


def matrix_of_axis_angle(random: Random) -> Problem:
    """Return a problem that asks for an entry of the matrix of a rotation about an inclined axis."""
    axis, text = _axis(random)
    row, column = random.choice(((0, 1), (1, 2), (2, 0), (0, 2), (1, 0), (2, 1)))
    entry = dcm_of_axis_angle(axis, alpha)[row, column]
    written = axis[row] * axis[column] * (1 - cos(alpha)) + skew(axis)[row, column] * sin(alpha)
    name = f"R_{{{row + 1}{column + 1}}}"
    return Problem(
        "An entry of a rotation matrix",
        rf"A body is rotated by $\alpha$ about the axis along $n = {text}$.",
        r"The entries are $R_{ij} = \cos\alpha\,\delta_{ij} + (1 - \cos\alpha) n_i n_j - "
        r"\sin\alpha\,\epsilon_{ijk} n_k$.",
        (ANGLE,),
        (Line("The entry off the diagonal.", entry, written, name),),
        (Asked(name, f"the entry in row {row + 1} and column {column + 1}", written, ""),),
    )


def rodrigues_parameter(random: Random) -> Problem:
    """Return a problem that asks for a component of the Rodrigues vector."""
    axis, text = _axis(random)
    place = random.randrange(3)
    matrix = dcm_of_axis_angle(axis, alpha)
    skew_part = (matrix - matrix.T) / (1 + matrix.trace())
    entry = skew_part[(place + 2) % 3, (place + 1) % 3]
    formula = axis[place] * tan(alpha / 2)
    name = f"g_{place + 1}"
    return Problem(
        "A Rodrigues parameter",
        rf"A body is rotated by $\alpha$ about the axis along $n = {text}$. Its Rodrigues vector is $g = n "
        r"\tan(\alpha/2)$.",
        "Multiply the component of the axis by the tangent of half the angle.",
        (ANGLE,),
        (Line("The skew part of the rotation matrix, divided by one plus the trace.", entry, formula, name),),
        (Asked(name, f"component {place + 1} of the Rodrigues vector", formula, ""),),
    )
