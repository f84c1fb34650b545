"""Kernels of Euler angles for all 24 sequences: rotation matrix, rate Jacobians and their inverses, quaternions."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial

from sympy import Add, Expr, Integer, Matrix, Mul, Symbol, expand, pi

from symrot import symbols
from symrot.conventions import SEQUENCES, parse_sequence
from symrot.kernels.definition import Box, Definition, Law, argument, boxed, interval, result
from symrot.kernels.quaternion import Named
from symrot.kernels.removable import select_ge
from symrot.kinematics.chart import RateMatrix
from symrot.kinematics.euler import dcm, euler_of_quaternion, quaternion_of_euler, rate_jacobian
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.kinematics.rotations import skew

__all__ = ["definitions"]

ANGLES = argument("angles", "in", symbols.angles, "Euler angles, in order of application")
ANGLE_BOX = boxed(symbols.angles, "-22/7", "22/7")
OMEGA = {"body": symbols.omega_b, "space": symbols.omega_s}
DERIVATION = "derivations/euler_body_rates.md"
JACOBIAN = symbols.jacobian_entries
QUATERNION = argument("q", "in", symbols.quaternion, "attitude, body to space")


def prefix(sequence: str) -> str:
    """Return the beginning of a sequence's kernel names: ``"euler_zxz"`` for ``"ZXZ"``, ``"euler_extrinsic_zxz"`` for
    ``"zxz"``.
    """
    # Names of files must differ in more than upper and lower case.
    return f"euler_{sequence.lower()}" if parse_sequence(sequence)[1] else f"euler_extrinsic_{sequence}"


def definitions() -> Iterator[tuple[str, Callable[[], Definition]]]:
    """Yield (name, function) for every kernel of Euler angles: the function derives its arguments and formulas."""
    for sequence in SEQUENCES:
        for suffix, make in _KINDS.items():
            name = f"{prefix(sequence)}_{suffix}"
            yield name, partial(make, name, sequence)


def _called(sequence: str) -> str:
    intrinsic = parse_sequence(sequence)[1]
    return f"sequence {sequence} ({'intrinsic' if intrinsic else 'extrinsic'})"


def _lock(sequence: str) -> str:
    singular = str(rate_jacobian(sequence).determinant).lstrip("-")
    return f"{singular} != 0; rounding errors grow as 1/{singular}"


def _regular_box(sequence: str) -> Box:
    """Return a box (angle -> range of values) of Euler angles away from gimbal lock, where rates are bounded."""
    axes, _ = parse_sequence(sequence)
    # The middle angle is within about 1.5 rad of its best value, pi/2 or 0.
    proper = axes[0] == axes[2]
    return ANGLE_BOX | {"theta": interval("1/10", "304/100") if proper else interval("-7/5", "7/5")}


def _by_outer_products(entries: Iterable[Expr]) -> tuple[Named, list[Expr]]:
    """Return pairs (symbol, product) for products such as ``sin(phi)*cos(psi)``, and matrix entries in these
    symbols.
    """
    named: dict[Expr, Symbol] = {}
    formulas = []
    for entry in entries:
        sums: dict[Expr, Expr] = {}
        for term in Add.make_args(expand(entry)):
            coefficient, factors = term.as_coeff_mul()
            # functions of the first and of the last angle; several entries contain their product
            outer = [f for f in factors if f.free_symbols & {symbols.phi, symbols.psi}]
            product = Mul(*outer)
            if len(outer) == 2:
                product = named.setdefault(product, Symbol(f"outer_{len(named) + 1}", real=True))
            # a common factor, which depends on the middle angle
            middle = Mul(*(f for f in factors if f not in outer))
            sums[middle] = sums.get(middle, Integer(0)) + coefficient * product
        formulas.append(Add(*(middle * value for middle, value in sums.items())))
    return tuple((symbol, product) for product, symbol in named.items()), formulas


def _dcm(name: str, sequence: str) -> Definition:
    matrix = dcm(sequence)
    named, formulas = _by_outer_products(matrix)

    def laws() -> tuple[Law, ...]:
        entries = Matrix(3, 3, symbols.rotation_entries)
        return (
            Law("the matrix is the dcm of the product of the three turns as quaternions",
                tuple(entries - quaternion_to_dcm(quaternion_of_euler(sequence)))),
        )  # fmt: skip

    return Definition(
        name, f"direction cosine matrix dcm_sb of Euler angles, {_called(sequence)}; v_s = dcm_sb v_b, row by row",
        (ANGLES,), (result("dcm", formulas, symbols.rotation_entries, "entry of dcm_sb"),),
        "all finite angles", "derivations/rotation_matrices.md", ANGLE_BOX, laws, named,
    )  # fmt: skip


def _jacobian(frame: str, name: str, sequence: str) -> Definition:
    def laws() -> tuple[Law, ...]:
        jacobian, matrix = Matrix(3, 3, JACOBIAN), dcm(sequence)
        columns = []
        for place, angle in enumerate(symbols.angles):
            rate = matrix.diff(angle)
            turning = matrix.T * rate if frame == "body" else rate * matrix.T
            columns += list(turning - skew(jacobian[:, place]))
        return (Law("skew(B dq/dt) is the spin tensor of the dcm", tuple(columns)),)

    return Definition(
        name, f"rate Jacobian B of Euler angles, {_called(sequence)}: omega_{frame[0]} = B dangles/dt, row by row",
        (ANGLES,), (result("jacobian", rate_jacobian(sequence, frame), JACOBIAN, "entry of B"),),
        "all finite angles", DERIVATION, ANGLE_BOX, laws,
    )  # fmt: skip


def _rates(frame: str, name: str, sequence: str) -> Definition:
    jacobian, omega = rate_jacobian(sequence, frame), Matrix(OMEGA[frame])
    named, formulas = _solved(jacobian, omega)

    def laws() -> tuple[Law, ...]:
        vanishing = Matrix(jacobian) * Matrix(symbols.angle_rates) - omega
        return (Law("B d(angles)/dt is the given angular velocity", tuple(vanishing)),)

    where = {"body": "body", "space": "space"}[frame]
    return Definition(
        name, f"rates of Euler angles from the angular velocity in {where} axes, {_called(sequence)}",
        (ANGLES, argument("omega", "in", OMEGA[frame], f"angular velocity, {where} components")),
        (result("dangles", formulas, symbols.angle_rates, "rate of the angle"),),
        _lock(sequence), DERIVATION, _regular_box(sequence) | boxed(OMEGA[frame], -10, 10), laws, named,
    )  # fmt: skip


def _solved(jacobian: RateMatrix, omega: Matrix) -> tuple[Named, list[Expr]]:
    """Return the rates of the Euler angles in terms of a new symbol, preceded by (symbol, its formula).

    The symbol stands for the only quotient, so that it is computed once.
    """
    matrix, determinant = Matrix(jacobian), jacobian.determinant
    # Of the outer angles, this one rotates about a coordinate axis of the frame of omega: its rate follows from one
    # component of omega and the other rate, without a division by the determinant.
    last = next(place for place in (0, 2) if not matrix[:, place].free_symbols)
    first, along = 2 - last, next(i for i in range(3) if matrix[i, last])
    turning = Symbol("turning", real=True)
    row = jacobian.inverse.row(first) * determinant
    formulas = list(jacobian.inverse * omega)
    formulas[first] = turning
    formulas[last] = (omega[along] - matrix[along, first] * turning) / matrix[along, last]
    return ((turning, sum((a * w for a, w in zip(row, omega, strict=True)), Integer(0)) / determinant),), formulas


def _quaternion(name: str, sequence: str) -> Definition:
    named, formulas = _by_outer_products(quaternion_of_euler(sequence))

    def laws() -> tuple[Law, ...]:
        return (Law("the dcm of the quaternion is that of the angles", tuple(quaternion_to_dcm() - dcm(sequence))),
                Law("the quaternion has unit norm", (unit_relation(),)))  # fmt: skip

    return Definition(
        name, f"quaternion of Euler angles, {_called(sequence)}",
        (ANGLES,),
        (result("q", formulas, symbols.quaternion, "attitude, body to space"),),
        "all finite angles; q and -q are one attitude", "derivations/euler_parameters.md", ANGLE_BOX, laws, named,
    )  # fmt: skip


def _wrapped(angle: Expr) -> Expr:
    """Return the formula that moves an angle between -2 pi and 2 pi into [-pi, pi] by a multiple of 2 pi."""
    return select_ge(pi, angle, select_ge(angle, -pi, angle, angle + 2 * pi), angle - 2 * pi)


def _of_quaternion(name: str, sequence: str) -> Definition:
    first, middle, last = euler_of_quaternion(sequence)

    def laws() -> tuple[Law, ...]:
        return (Law("the dcm of the angles is that of the quaternion", tuple(dcm(sequence) - quaternion_to_dcm()),
                    (unit_relation(),)),)  # fmt: skip

    return Definition(
        name, f"Euler angles of a quaternion of any norm, {_called(sequence)}",
        (QUATERNION,),
        (result("angles", (_wrapped(first), middle, _wrapped(last)), symbols.angles, "Euler angle"),),
        "all quaternions but 0; at lock, where one combination of the first and last angle is left, both are finite",
        "derivations/euler_parameters.md", boxed(symbols.quaternion, -1, 1), laws,
    )  # fmt: skip


_KINDS: dict[str, Callable[[str, str], Definition]] = {
    "dcm": _dcm,
    "body_jacobian": partial(_jacobian, "body"),
    "space_jacobian": partial(_jacobian, "space"),
    "body_rates": partial(_rates, "body"),
    "space_rates": partial(_rates, "space"),
    "quaternion": _quaternion,
    "of_quaternion": _of_quaternion,
}
