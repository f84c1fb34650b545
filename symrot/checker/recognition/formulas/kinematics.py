"""Formulas of kinematics in books: rotated vectors, points of a body, angles from matrices and quaternions.

The formula for an angle is the argument of an inverse function, with which its name ends: "angle of rotation of a unit
quaternion, 2 acos" has the formula q0, because the angle is 2*acos(q0).
"""

from collections.abc import Iterator, Sequence
from functools import reduce
from operator import add
from typing import Any

from sympy import Expr, Matrix, Symbol, cancel, cos, diag, expand, eye, sin, solve, sqrt, together, trace

from symrot import symbols
from symrot.checker.recognition.formulas.named import Named
from symrot.conventions import SEQUENCES
from symrot.kinematics import attitude, euler, quaternion, rotation_vector
from symrot.kinematics.rotations import skew

__all__ = ["GYROSCOPE", "OF_ONE_ENTRY", "along_axes", "rotations", "vectors"]

AXIS, ANGLE, SECOND_ANGLE = Matrix(symbols.axis), symbols.alpha, Symbol("beta", real=True)
POSITION, OMEGA, ALPHA = Matrix(symbols.position), Matrix(symbols.omega_b), Matrix(symbols.omega_rates)
Q = symbols.quaternion
ENTRIES = Matrix(3, 3, symbols.rotation_entries)
BELOW = ((2, 1), (0, 2), (1, 0))
"""The (row, column) of the entries of a skew matrix that are the components of its vector."""
WORDS = ("first", "second", "third")
UNIT, PARAMETERS, RELATIVE, COMPOSITION, RODRIGUES, MOMENTUM, ENERGY, POWER, WHEEL, RATES = (
    f"derivations/{name}.md"
    for name in ("axis_and_angle", "euler_parameters", "relative_motion", "composition", "rodrigues",
                 "angular_momentum", "kinetic_energy", "work_and_power", "gyroscopic_wheel", "euler_body_rates")
)  # fmt: skip

PITCH = "pitch angle of a rotation matrix, asin"
SECOND_ANGLE_OF_MATRIX = "second angle of ZXZ, and of ZYZ, of a rotation matrix, acos"
OF_ONE_ENTRY = (PITCH, SECOND_ANGLE_OF_MATRIX)
"""Names of the formulas that give an angle by one entry of a rotation matrix, such as acos(R_33).

Symrot stores only the entry, here R_33 for the second angle of ZXZ, so that every claim ``angle = acos(letter)`` would
match. A claim is recognised only if the letter has the name of a matrix entry, such as R_33.
"""

GYROSCOPE = "torque on a gyroscope whose axis precesses"


def vectors() -> Iterator[Named]:
    """Yield rotated vectors, motions of points in a body or rotating frame, and formulas with the angular momentum."""
    for name, matrix in _rotation_matrices():
        yield f"rotated vector, by {name}", UNIT, matrix * POSITION
        yield f"vector in rotated axes, by {name}", UNIT, matrix.T * POSITION
    origin, relative = Matrix(symbols.velocity), Matrix(symbols.relative_velocity)
    turning = OMEGA.cross(POSITION)
    yield "velocity of a point of a body", RELATIVE, origin + turning
    yield "velocity of a point in a rotating frame", RELATIVE, relative + turning
    on_body = ALPHA.cross(POSITION) + OMEGA.cross(turning)
    # d/dt of the velocity: its rate in the rotating frame, plus omega x velocity
    in_frame = Matrix(symbols.relative_acceleration) + ALPHA.cross(POSITION) + OMEGA.cross(relative)
    in_frame += OMEGA.cross(relative + turning)
    for place, added in (("a fixed origin", Matrix([0, 0, 0])), ("a moving origin", Matrix(symbols.acceleration))):
        yield f"acceleration of a point of a body with {place}", RELATIVE, added + on_body
        yield f"acceleration of a point in a rotating frame with {place}", RELATIVE, added + in_frame
    apparent = 2 * Matrix(symbols.acceleration) - in_frame.subs(
        dict(zip(symbols.relative_acceleration, symbols.acceleration, strict=True))
    )  # a = a' + the rest, so a' = a - the rest
    yield "acceleration seen in a rotating frame", RELATIVE, apparent
    steady = dict.fromkeys(symbols.omega_rates, 0)
    yield "acceleration seen in a frame that rotates steadily", RELATIVE, apparent.subs(steady)
    momentum = Matrix(symbols.momentum_b)
    rates = Matrix([Symbol(f"dL_{n}", real=True) for n in (1, 2, 3)])
    yield "torque from the rate of the angular momentum in the body", MOMENTUM, rates + OMEGA.cross(momentum)
    tensor = Matrix(3, 3, [Symbol(f"I_{i}{j}", real=True) for i in "xyz" for j in "xyz"])
    yield "angular momentum I omega, with all entries of the tensor", MOMENTUM, tensor * OMEGA
    spin = Matrix([Symbol(f"p_{axis}", real=True) for axis in "xyz"])
    precession = Matrix([Symbol(f"Omega_{axis}", real=True) for axis in "xyz"])
    yield GYROSCOPE, WHEEL, precession.cross(symbols.C * spin)
    yield from _vector_parts()
    about_point = POSITION.cross(symbols.m * origin) + momentum
    yield "angular momentum about a point away from the centre of mass", MOMENTUM, about_point
    yield from _rates_of_the_matrix()
    yield "kinetic energy of rotation from the angular momentum", ENERGY, OMEGA.dot(momentum) / 2
    yield "power of a torque", POWER, OMEGA.dot(Matrix(symbols.torque_b))


def _vector_parts() -> Iterator[Named]:
    """Yield the vector part of a quaternion product, and of the rate of a quaternion."""
    whole = Matrix(quaternion.quaternion_product(Q, symbols.second_quaternion))
    yield "vector part of the quaternion product q p", PARAMETERS, whole[1:, 0]
    for frame, omega in (("body", OMEGA), ("space", Matrix(symbols.omega_s))):
        rates = Matrix(quaternion.quaternion_rates(frame) * omega)
        yield f"vector part of the quaternion rates from omega in the {frame} frame", PARAMETERS, rates[1:, 0]


def _rates_of_the_matrix() -> Iterator[Named]:
    """Yield the rates of the rotation matrix and of its transpose, from their entries and omega in either frame."""
    # proven for the matrix of a quaternion, whose rates are known
    matrix = Matrix(quaternion.quaternion_to_dcm(Q, "homogeneous"))
    for frame, omega in (("body", Matrix(symbols.omega_b)), ("space", Matrix(symbols.omega_s))):
        rates = quaternion.quaternion_rates(frame) * omega
        change = reduce(add, (matrix.diff(q) * rate for q, rate in zip(Q, rates, strict=True)))
        for title, own, rate in (("rotation matrix", matrix, change),
                                 ("transposed rotation matrix", matrix.T, change.T)):  # fmt: skip
            for sign, turned in ((sign, turned) for sign in (1, -1) for turned in (_turned_before, _turned_after)):
                if (sign * turned(own, omega) - rate).applyfunc(expand).is_zero_matrix:
                    name = f"rate of the {title} from omega in the {frame} frame"
                    yield name, PARAMETERS, sign * turned(ENTRIES, omega)


def _turned_before(matrix: Matrix, omega: Matrix) -> Matrix:
    return skew(omega) * matrix


def _turned_after(matrix: Matrix, omega: Matrix) -> Matrix:
    return matrix * skew(omega)


def _rotation_matrices() -> Iterator[tuple[str, Matrix]]:
    """Yield rotation matrices: of axis and angle, in two forms that are equal for a unit axis, and of a quaternion."""
    powers = Matrix(rotation_vector.dcm_of_axis_angle())
    yield "axis and angle (Rodrigues' formula)", powers
    yield "axis and angle (Rodrigues' formula) with a unit axis", _with_unit_axis(powers)
    yield "a unit quaternion", Matrix(quaternion.quaternion_to_dcm(Q))
    homogeneous = Matrix(quaternion.quaternion_to_dcm(Q, "homogeneous"))
    yield "a unit quaternion, q v q*", homogeneous
    yield "a quaternion of any length, q v q^-1", Matrix(quaternion.quaternion_to_dcm(Q, "normalised"))
    by_scalar = (homogeneous + quaternion.unit_relation(Q) * eye(3)).applyfunc(expand)
    yield "a unit quaternion by its scalar and vector parts", by_scalar


def _with_unit_axis(rotation: Matrix) -> Matrix:
    """Return a rotation matrix with n n^T - 1 in place of skew(n)^2; both are equal for a unit axis n."""
    excess = (1 - cos(ANGLE)) * (AXIS.dot(AXIS) - 1)
    return (rotation + excess * eye(3)).applyfunc(expand)


def along_axes() -> Iterator[Named]:
    """Yield angular velocities and momenta along unit vectors: ``omega = omega_1 b_1 + omega_2 b_2 + omega_3 b_3``."""
    vectors = Matrix(3, 3, [Symbol(f"b_{n}{axis}", real=True) for axis in "xyz" for n in (1, 2, 3)])
    momentum = diag(symbols.A, symbols.B, symbols.C) * OMEGA
    directions = Matrix(1, 3, [Symbol(f"b_{n}", real=True) for n in (1, 2, 3)])  # any component of the vectors
    for title, axes in (("the principal axes", vectors), ("the principal axes b_1, b_2, b_3", directions)):
        yield f"angular momentum I omega along {title}", MOMENTUM, _as_scalar(axes * momentum)
    rates = Matrix(symbols.angle_rates)
    about_z = vectors.copy()
    about_z[:, 0] = Matrix([0, 0, 1])
    for axes, title in (
        (vectors, "the axes of the rotations"),
        (about_z, "the z axis and the other two axes of the rotations"),
    ):
        yield f"angular velocity of Euler angles along {title}", RATES, axes * rates
    for name in ("ZXZ", "ZYZ", "ZYX", "ZXY"):
        before = (euler.rate_jacobian(name).as_immutable() * rates).subs(symbols.psi, 0)
        for axes in (vectors, directions):
            title = f"angular velocity of {name} along the axes before its last rotation"
            yield title, RATES, _as_scalar(axes * before)


def _as_scalar(column: Matrix) -> Any:
    return column[0] if len(column) == 1 else column


def rotations() -> Iterator[Named]:
    """Yield formulas that convert between matrix entries, angles, quaternions and other parameters of rotations."""
    powers = Matrix(rotation_vector.dcm_of_axis_angle())
    yield "rotation matrix of a unit axis and an angle (Rodrigues' formula)", UNIT, _with_unit_axis(powers)
    yield from _entries()
    yield from _angles()
    yield from _euler_angles()
    yield from _rodrigues()


def _entries() -> Iterator[Named]:
    """Yield the matrix entries of a unit quaternion, an axis and angle, or Euler angles, and the quaternion components
    from matrix entries.
    """
    of_axis = _with_unit_axis(Matrix(rotation_vector.dcm_of_axis_angle()))
    for i in range(3):
        for j in range(3):
            yield f"entry {i + 1}{j + 1} of the rotation matrix of a unit axis and an angle", UNIT, of_axis[i, j]
    matrix, homogeneous = quaternion.quaternion_to_dcm(Q), quaternion.quaternion_to_dcm(Q, "homogeneous")
    relation = quaternion.unit_relation(Q)
    for i in range(3):
        for j in range(3):
            name = f"entry {i + 1}{j + 1} of the rotation matrix of a unit quaternion"
            forms = [matrix[i, j], homogeneous[i, j]]
            forms += [homogeneous[i, j] + relation, homogeneous[i, j] - relation] if i == j else []
            for form in dict.fromkeys(map(expand, forms)):
                yield name, PARAMETERS, form
    for sequence in ("ZXZ", "ZYX", "ZYZ", "XYZ"):
        of_angles = euler.dcm(sequence)
        for i in range(3):
            for j in range(3):
                if len(of_angles[i, j].free_symbols) == len(symbols.angles):
                    yield f"entry {i + 1}{j + 1} of the rotation matrix of {sequence}", RATES, of_angles[i, j]
    rest = cancel((trace(homogeneous) + quaternion.norm_squared(Q)) / Q[0] ** 2)  # 4: the trace is 4 q0^2 - |q|^2
    yield "scalar component of the quaternion of a rotation matrix, squared", PARAMETERS, (trace(ENTRIES) + 1) / rest
    for number, (i, j) in enumerate(BELOW, start=1):
        ratio = cancel((matrix[i, j] - matrix[j, i]) / Q[number])  # 4 q0
        for frame, sign in (("rotation matrix", 1), ("transposed rotation matrix", -1)):
            value = sign * (ENTRIES[i, j] - ENTRIES[j, i]) / ratio
            yield f"{WORDS[number - 1]} component of the quaternion of a {frame}", PARAMETERS, value


def _angles() -> Iterator[Named]:
    """Yield formulas for the axis and angle of a rotation, from a matrix, quaternion, Euler angles or two rotations."""
    powers = Matrix(rotation_vector.dcm_of_axis_angle())
    total = expand(trace(powers)).subs(symbols.n3**2, 1 - symbols.n1**2 - symbols.n2**2)
    (cosine,) = solve(expand(total) - trace(ENTRIES), cos(ANGLE))
    yield "angle of a rotation matrix, acos", UNIT, cosine
    skew_part = (powers - powers.T) / 2
    sines = [cancel(skew_part[place] / component) for place, component in zip(BELOW, AXIS, strict=True)]
    axis = Matrix([(ENTRIES[i, j] - ENTRIES[j, i]) / (2 * sine) for (i, j), sine in zip(BELOW, sines, strict=True)])
    yield "axis of a rotation matrix", UNIT, axis
    for word, component in zip(WORDS, axis, strict=True):
        yield f"{word} component of the axis of a rotation matrix", UNIT, component
    scalar, *vector = rotation_vector.quaternion_of_axis_angle(symbols.axis, symbols.phi)
    yield "scalar component of the quaternion of axis and angle", UNIT, scalar
    yield from _with_words("quaternion of axis and angle", UNIT, Matrix(vector))
    half = symbols.phi / 2  # the scalar part is the cosine of half the angle
    assert rotation_vector.quaternion_of_axis_angle(symbols.axis, symbols.phi)[0] == cos(half)
    yield "angle of rotation of a unit quaternion, 2 acos", PARAMETERS, Q[0]
    length = sqrt(Q[1] ** 2 + Q[2] ** 2 + Q[3] ** 2)
    yield "angle of rotation of a unit quaternion, 2 atan2", PARAMETERS, Matrix([length, Q[0]])
    for name in SEQUENCES:
        scalar = euler.quaternion_of_euler(name)[0]
        yield f"angle of the rotation of {name}, 2 acos", PARAMETERS, scalar
    first = rotation_vector.quaternion_of_axis_angle()
    second = rotation_vector.quaternion_of_axis_angle(symbols.normal, SECOND_ANGLE)
    both = quaternion.quaternion_product(first, second)
    yield "angle of two rotations one after the other, 2 acos", COMPOSITION, both[0]


def _euler_angles() -> Iterator[Named]:
    """Yield a named formula for each Euler angle that books compute from a rotation matrix or a quaternion.

    From both: yaw, pitch and roll, the angles of ZYX. From a matrix: the three angles of ZYZ and of ZXZ. From a unit
    quaternion: the second angle of XYZ.
    """
    yaw, pitch, roll = symbols.angles
    matrix = euler.dcm("ZYX")
    for name, angle, over, under in (("yaw", yaw, (1, 0), (0, 0)), ("roll", roll, (2, 1), (2, 2))):
        assert expand(matrix[over] * cos(angle) - matrix[under] * sin(angle)) == 0
        for title, entries in (
            ("unit quaternion", quaternion.quaternion_to_dcm(Q)),
            ("quaternion", quaternion.quaternion_to_dcm(Q, "homogeneous")),
            ("rotation matrix", ENTRIES),
        ):
            yield f"{name} angle of a {title}, atan2", PARAMETERS, Matrix([entries[over], entries[under]])
    first, _, third = symbols.angles
    for name, over_first, under_first, over_third, under_third in (
        ("ZYZ", (1, (1, 2)), (1, (0, 2)), (1, (2, 1)), (-1, (2, 0))),
        ("ZXZ", (1, (0, 2)), (-1, (1, 2)), (1, (2, 0)), (1, (2, 1))),
    ):
        matrix_of = euler.dcm(name)
        for word, angle, (up, over), (down, under) in (
            ("first", first, over_first, under_first), ("third", third, over_third, under_third),
        ):  # fmt: skip
            assert expand(up * matrix_of[over] * cos(angle) - down * matrix_of[under] * sin(angle)) == 0
            pair = Matrix([up * ENTRIES[over], down * ENTRIES[under]])
            yield f"{word} {name} angle of a rotation matrix, atan2", PARAMETERS, pair
    assert matrix[2, 0] == -sin(pitch)
    for places in (((0, 0), (1, 0)), ((2, 1), (2, 2))):  # cos(theta) times the cosine and the sine of another angle
        cosine = _root_of_squares(matrix, places, cos(pitch) ** 2)
        yield "pitch angle of a rotation matrix, atan2", PARAMETERS, Matrix([-ENTRIES[2, 0], cosine])
    for name in ("ZYZ", "ZXZ"):
        for places in (((0, 2), (1, 2)), ((2, 0), (2, 1))):
            sine = _root_of_squares(euler.dcm(name), places, sin(symbols.theta) ** 2)
            title = f"second {name} angle of a rotation matrix, atan2"
            yield title, PARAMETERS, Matrix([sine, ENTRIES[2, 2]])
    yield "pitch angle of a unit quaternion, asin", PARAMETERS, -quaternion.quaternion_to_dcm(Q)[2, 0]
    assert euler.dcm("XYZ")[0, 2] == sin(pitch)
    of_xyz = expand(quaternion.quaternion_to_dcm(Q)[0, 2])
    yield "second XYZ angle of a unit quaternion, asin", PARAMETERS, of_xyz
    yield PITCH, PARAMETERS, -ENTRIES[2, 0]
    assert euler.dcm("ZXZ")[2, 2] == euler.dcm("ZYZ")[2, 2] == cos(symbols.theta)
    yield SECOND_ANGLE_OF_MATRIX, PARAMETERS, ENTRIES[2, 2]


def _root_of_squares(matrix: Matrix, places: Sequence[tuple[int, int]], square: Expr) -> Expr:
    """Return the root of the sum of squares of some rotation matrix entries, such as ``sqrt(R_11^2 + R_21^2)``.

    ``places`` are the indices (row, column) of these entries, from 0. ``matrix`` is the rotation matrix as a function
    of Euler angles. Assert that the sum of the squares of its entries at these places equals ``square``.
    """
    total = sum(matrix[place] ** 2 for place in places)
    (outer,) = {factor for factor in symbols.angles if not square.has(factor) and total.has(factor)}
    assert expand(expand(total - square).subs(sin(outer) ** 2, 1 - cos(outer) ** 2)) == 0
    return sqrt(sum(ENTRIES[place] ** 2 for place in places))


def _composed_parameters() -> Iterator[Named]:
    """Yield the Rodrigues parameters, and the modified ones, of two rotations one after the other."""
    for name, title in (("rodrigues", "Rodrigues parameters"), ("mrp", "modified Rodrigues parameters")):
        chart = attitude.chart(name)
        one, other = (
            chart.quaternion.subs(dict(zip(chart.parameters, vector, strict=True)), simultaneous=True)
            for vector in (Q[1:], symbols.second_quaternion[1:])
        )
        scalar, *vector = Matrix(quaternion.quaternion_product(one, other))
        below = scalar if name == "rodrigues" else 1 + scalar
        composed = Matrix([cancel(together(component) / together(below)) for component in vector])
        yield f"{title} of two rotations one after the other", RODRIGUES, composed


def _with_words(name: str, source: str, column: Matrix) -> Iterator[Named]:
    """Yield each component of the vector ``column`` with a name such as "first component of the .."."""
    for word, component in zip(WORDS, column, strict=True):
        yield f"{word} component of the {name}", source, component


def _rodrigues() -> Iterator[Named]:
    """Yield the Rodrigues parameters from axis and angle and from a quaternion, and their rates from omega."""
    yield from _composed_parameters()
    of_axis = rotation_vector.quaternion_of_axis_angle()
    for name, title in (("rodrigues", "Rodrigues parameters"), ("mrp", "modified Rodrigues parameters")):
        for q, origin in ((of_axis, "axis and angle"), (Q, "a quaternion")):
            scalar, *vector = q
            below = scalar if name == "rodrigues" else 1 + scalar
            parameters = Matrix([component / below for component in vector])
            yield f"{title} of {origin}", RODRIGUES, parameters
            yield from _with_words(f"{title} of {origin}", RODRIGUES, parameters)
        chart = attitude.chart(name)
        length, (first, *others) = Symbol("sigma", real=True), chart.parameters
        scalar = cancel(chart.quaternion[0].subs(dict.fromkeys(others, 0)).subs(first, length))
        yield f"scalar component of the quaternion from the length of the {title}", RODRIGUES, scalar
        for frame in ("body", "space"):
            rates = chart.rate_matrix(frame).inverse * OMEGA
            yield f"rates of the {title} from omega in the {frame} frame", RODRIGUES, rates.applyfunc(cancel)
