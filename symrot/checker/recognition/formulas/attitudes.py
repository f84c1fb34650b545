"""Matrices, quaternions and rates of attitudes: Euler angles, quaternions, rotation vectors, Rodrigues parameters."""

from collections.abc import Iterator

from sympy import Matrix

from symrot import symbols
from symrot.checker.recognition.formulas.named import Named
from symrot.conventions import SEQUENCES
from symrot.kinematics import attitude, euler, quaternion, rotation_vector
from symrot.kinematics.rotations import elementary_rotation, skew

__all__ = ["CROSS_PRODUCT", "axes", "charts", "quaternions", "sequences"]

CROSS_PRODUCT = "cross product v x n"
"""Name of the formula that symrot knows for a cross product; names of its components, such as "first component of the
cross product v x n", end with it."""

FRAMES = ("body", "space")


def sequences() -> Iterator[Named]:
    rates = Matrix(symbols.angle_rates)
    for name in SEQUENCES:
        kind = "intrinsic" if name.isupper() else "extrinsic"
        yield f"rotation matrix of {kind} {name}, body to space", f'symrot.dcm("{name}")', euler.dcm(name)
        yield f"quaternion of {kind} {name}", "derivations/euler_parameters.md", euler.quaternion_of_euler(name)
        for frame in FRAMES:
            matrix = euler.rate_jacobian(name, frame)
            omega = Matrix(symbols.omega_b if frame == "body" else symbols.omega_s)
            source = f'symrot.rate_jacobian("{name}", "{frame}")'
            plain = matrix.as_immutable()
            yield f"{name} {frame}-frame rate Jacobian, omega = B dq/dt", source, plain
            yield f"inverse of the {name} {frame}-frame rate Jacobian, dq/dt = B^-1 omega", source, matrix.inverse
            yield f"angular velocity of {name} in the {frame} frame", source, plain * rates
            yield f"angle rates of {name} from omega in the {frame} frame", source, matrix.inverse * omega


def axes() -> Iterator[Named]:
    for axis in "xyz":
        rotation = elementary_rotation(axis.upper(), symbols.phi)
        yield f"rotation about the {axis} axis, body to space", f"R{axis}(phi)", rotation
    flat = elementary_rotation("Z", symbols.phi)[:2, :2]
    yield "rotation matrix in a plane, body to space", "Rz(phi)", flat


def quaternions() -> Iterator[Named]:
    q, p = symbols.quaternion, symbols.second_quaternion
    page_of = "derivations/quaternion_rates.md"
    yield (
        "rotation matrix of a unit quaternion, body to space",
        "symrot.quaternion_to_dcm()",
        quaternion.quaternion_to_dcm(q),
    )
    for form in ("homogeneous", "normalised"):
        matrix = quaternion.quaternion_to_dcm(q, form)
        yield (
            f"rotation matrix of a quaternion, {form}, body to space",
            f'symrot.quaternion_to_dcm(q, "{form}")',
            matrix,
        )
    yield "quaternion product q p", "symrot.quaternion_product(q, p)", quaternion.quaternion_product(q, p)
    yield "matrix of the product with a quaternion on the left", "symrot.quaternion_product", quaternion.left_matrix(q)
    yield (
        "matrix of the product with a quaternion on the right",
        "symrot.quaternion_product",
        quaternion.right_matrix(q),
    )
    for frame in FRAMES:
        rates, jacobian = quaternion.quaternion_rates(frame), quaternion.quaternion_rate_jacobian(frame)
        omega = Matrix(symbols.omega_b if frame == "body" else symbols.omega_s)
        yield f"quaternion rate matrix, {frame} frame, dq/dt = E omega", f'symrot.quaternion_rates("{frame}")', rates
        yield f"quaternion rates from omega in the {frame} frame", page_of, rates * omega
        yield f"quaternion rate Jacobian, {frame} frame, omega = B dq/dt", page_of, jacobian.as_immutable()
        omega_of_rates = jacobian.as_immutable() * Matrix(symbols.quaternion_rates)
        yield f"angular velocity of a quaternion in the {frame} frame", page_of, omega_of_rates


def charts() -> Iterator[Named]:
    yield "skew matrix of a vector, [v] w = v x w", "skew(v1, v2, v3)", skew(symbols.rotation_vector)
    pair = Matrix(symbols.rotation_vector), Matrix(symbols.axis)
    yield CROSS_PRODUCT, "cross(v, n)", pair[0].cross(pair[1])
    for name, title in (("rotation_vector", "rotation vector"), ("rodrigues", "Rodrigues parameters"),
                        ("mrp", "modified Rodrigues parameters")):  # fmt: skip
        chart = attitude.chart(name)
        page_of = f"derivations/{'rotation_vector' if name == 'rotation_vector' else 'rodrigues'}.md"
        yield f"rotation matrix of the {title}, body to space", page_of, chart.dcm
        yield f"quaternion of the {title}", page_of, chart.quaternion
        for frame in FRAMES:
            matrix = chart.rate_matrix(frame)
            yield f"{frame}-frame rate Jacobian of the {title}", page_of, matrix.as_immutable()
            yield f"inverse {frame}-frame rate Jacobian of the {title}", page_of, matrix.inverse
    page_of = "derivations/axis_and_angle.md"
    yield "rotation matrix of axis and angle (Rodrigues' formula)", page_of, rotation_vector.dcm_of_axis_angle()
    yield "quaternion of axis and angle", page_of, rotation_vector.quaternion_of_axis_angle()
