"""Euler angles: all 12 intrinsic and 12 extrinsic sequences, each computed from three elementary rotations.

Every sequence is a product of three factors, ``dcm_sb = R_first R_middle R_last``. The extrinsic ``xyz`` with angles
(a, b, c) equals the intrinsic ``ZYX`` with (c, b, a). Proper sequences have equal first and last axes (``ZXZ``), the
others are Tait-Bryan. Convention: :mod:`symrot.conventions`. Proof: ``derivations/euler_body_rates.md``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, partial
from typing import Any

from sympy import (
    Abs,
    Expr,
    ImmutableMatrix,
    Matrix,
    Rational,
    S,
    Set,
    Union,
    atan2,
    expand,
    oo,
    sqrt,
    zeros,
)

from symrot import exact, symbols
from symrot.conventions import SEQUENCES, check_frame, parse_sequence
from symrot.kinematics.chart import Chart, RateFacts, RateMatrix, zeros_of
from symrot.kinematics.quaternion import elementary_quaternion, quaternion_product
from symrot.kinematics.rotations import cross_sign, elementary_rotation, expressions, unit_vector

__all__ = [
    "EulerRateMatrix",
    "Factor",
    "chart",
    "dcm",
    "euler_of_dcm",
    "euler_of_quaternion",
    "factors",
    "lock_indicator",
    "quaternion_of_euler",
    "rate_jacobian",
    "sequences_at_lock",
]


@dataclass(frozen=True)
class Factor:
    """One of the three rotations whose product is ``dcm_sb``, the rotation from body to space.

    The fields are its axis (0 to 2), its angle (rad), and the index of the angle, 0 to 2.
    """

    axis: int
    angle: Expr
    # for an extrinsic sequence, the first factor belongs to the last angle
    place: int

    @cached_property
    def rotation(self) -> ImmutableMatrix:
        return elementary_rotation(self.axis, self.angle)

    @cached_property
    def direction(self) -> ImmutableMatrix:
        return unit_vector(self.axis)


def factors(sequence: str, angles: Sequence[Any] | None = None) -> tuple[Factor, Factor, Factor]:
    """Return the three elementary rotations whose product, from left to right, is the rotation from body to space.

    Parameters
    ----------
    sequence : str
        One of :data:`symrot.conventions.SEQUENCES`.
    angles : sequence of 3 Expr, optional
        Angles in rad, in order of application; default: phi, theta, psi.

    Raises
    ------
    InputError
        If the sequence is unknown, or there are not exactly three angles.
    """
    axes, intrinsic = parse_sequence(sequence)
    angles = expressions(symbols.angles if angles is None else angles, 3, f"the Euler sequence {sequence}")
    applied = [Factor(axis, angle, place) for place, (axis, angle) in enumerate(zip(axes, angles, strict=True))]
    first, middle, last = applied if intrinsic else applied[::-1]
    return first, middle, last


def dcm(sequence: str, angles: Sequence[Any] | None = None) -> ImmutableMatrix:
    """Return ``dcm_sb`` of an Euler sequence, shape (3, 3).

    Parameters
    ----------
    sequence : str
        Intrinsic in upper case (``"ZXZ"``), extrinsic in lower case (``"zxz"``).
    angles : sequence of 3 Expr, optional
        rad, in order of application; phi, theta, psi when left out.

    Returns
    -------
    ImmutableMatrix, shape (3, 3), dimensionless
        ``v_s = dcm_sb * v_b``.

    Raises
    ------
    InputError
        For an unknown sequence, or not exactly three angles.

    Notes
    -----
    Intrinsic: ``R1(q1) R2(q2) R3(q3)``; extrinsic: ``R3(q3) R2(q2) R1(q1)``. Equal to SciPy's
    ``Rotation.from_euler(sequence, angles).as_matrix()``. Source: Goldstein, Classical Mechanics, 3rd ed., (4.46)
    is the transpose for ZXZ.

    Examples
    --------
    >>> import symrot
    >>> symrot.dcm("ZXZ")[2, 2]
    cos(theta)
    """
    first, middle, last = factors(sequence, angles)
    return ImmutableMatrix(first.rotation * middle.rotation * last.rotation)


def lock_indicator(sequence: str, dcm_sb: Matrix) -> Expr:
    """Return the entry ``e_first^T dcm_sb e_last`` of a matrix of attitude.

    It is +1 or -1 if and only if the sequence is in gimbal lock at this attitude.
    """
    first, _, last = factors(sequence)
    # the cosine of the angle between the first axis and the rotated last axis
    return dcm_sb[first.axis, last.axis]


def _core(sequence: str, frame: str, angles: Sequence[Any] | None) -> tuple[Matrix, Matrix, Matrix]:
    """Return three factors of the rate matrix ``B = carry * core * order``.

    ``core`` has the three rotation axes as columns and depends on the middle angle only; ``carry`` rotates them to
    components in ``frame``, and ``order`` sorts them in the order of the angles.
    """
    first, middle, last = factors(sequence, angles)
    if check_frame(frame) == "body":
        carry = last.rotation.T
        core = Matrix.hstack(middle.rotation.T * first.direction, middle.direction, last.direction)
    else:
        carry = first.rotation
        core = Matrix.hstack(first.direction, middle.direction, middle.rotation * last.direction)
    order = zeros(3)
    for row, factor in enumerate((first, middle, last)):
        order[row, factor.place] = 1
    return carry, core, order


def _solved(carry: Matrix, core: Matrix, order: Matrix) -> tuple[Expr, ImmutableMatrix | None]:
    """Return (determinant, inverse) of the rate matrix ``carry * core * order``; no inverse if the determinant is 0."""
    # Only core, which depends on one angle, is inverted: carry is a rotation, order a permutation.
    core_determinant = core.det(method="berkowitz")
    determinant = core_determinant * order.det()
    if core_determinant == 0:
        return determinant, None
    adjugate = core.adjugate(method="berkowitz")
    core_inverse = adjugate.applyfunc(lambda entry: entry / core_determinant)
    return determinant, ImmutableMatrix(order.T * core_inverse * carry.T)


def _along(sequence: str, frame: str, angles: tuple[Expr, ...], middle: Expr) -> tuple[Expr, ImmutableMatrix | None]:
    return _solved(*_core(sequence, frame, (angles[0], middle, angles[2])))


class EulerRateMatrix(RateMatrix):
    """B(q) of ``omega = B(q) dq/dt`` for an Euler sequence; see :class:`symrot.kinematics.chart.RateMatrix`.

    Attributes
    ----------
    sequence : str
        The Euler sequence, such as ``"ZXZ"``.
    regular_sequences : tuple of str
        The other sequences that are regular at every attitude where this sequence locks.

    Examples
    --------
    >>> import symrot
    >>> symrot.rate_jacobian("ZXZ").determinant
    -sin(theta)
    """

    @property
    def sequence(self) -> str:
        return str(self.facts.name)

    @cached_property
    def regular_sequences(self) -> tuple[str, ...]:
        meetings = sequences_at_lock(self.sequence)
        return tuple(other for other, met in meetings.items() if met is S.EmptySet)

    def regular_at(self, angles: Sequence[Any] | None = None) -> tuple[str, ...]:
        """Return the sequences, of all 24, that are not in gimbal lock at the attitude with the given angles, rad.

        ``angles`` belong to this sequence; default: the angles of this matrix. If they contain symbols, a sequence is
        left out only if it is in gimbal lock for all values of the symbols.
        """
        own_angles = expressions(
            self.parameters if angles is None else angles, 3, f"the Euler sequence {self.sequence}"
        )
        # a float is the exact rational number that it represents
        attitude = dcm(self.sequence, [Rational(angle) if angle.is_Float else angle for angle in own_angles])
        return tuple(other for other in SEQUENCES if not _is_one(lock_indicator(other, attitude) ** 2))


def _is_one(value: Expr) -> bool:
    if value.is_number and abs((value - 1).evalf(60)) > Rational(1, 10**40):
        return False
    return bool(exact.normal_form(value - 1) == 0)


def rate_jacobian(sequence: str, frame: str = "body", angles: Sequence[Any] | None = None) -> EulerRateMatrix:
    """Return the rate matrix B(q) of an Euler sequence, ``omega = B(q) * dq/dt``; column i is the axis of rotation i.

    Parameters
    ----------
    sequence : str
        Intrinsic in upper case (``"ZXZ"``), extrinsic in lower case (``"zxz"``).
    frame : str
        ``"body"`` or ``"space"``: the components of omega.
    angles : sequence of 3 Expr, optional
        rad, in order of application; phi, theta, psi when left out.

    Returns
    -------
    EulerRateMatrix, shape (3, 3), dimensionless
        With ``.inverse``, ``.determinant``, ``.singular_set``, ``.condition_number``, ``.limits``,
        ``.regular_sequences``.

    Raises
    ------
    InputError
        For an unknown sequence or frame, or not exactly three angles.

    Notes
    -----
    Let c be the cosine of the angle between the first and the last rotation axis. The middle axis is perpendicular to
    both, so ``B^T B`` has the eigenvalues 1, 1 + c, 1 - c in both frames.
    Proof: ``derivations/euler_body_rates.md``. Source: Landau & Lifshitz, Mechanics, 3rd ed., eq. (35.1), for ZXZ.

    Examples
    --------
    >>> rate_jacobian("ZXZ").row(2)
    Matrix([[cos(theta), 0, 1]])
    """
    in_order = sorted(factors(sequence, angles), key=lambda factor: factor.place)
    return _rate_jacobian(sequence, check_frame(frame), tuple(factor.angle for factor in in_order))


@lru_cache(maxsize=256)
def _rate_jacobian(sequence: str, frame: str, parameters: tuple[Expr, ...]) -> EulerRateMatrix:
    first, middle, last = factors(sequence, parameters)
    carry, core, order = _core(sequence, frame, parameters)
    determinant, inverse = _solved(carry, core, order)
    cosine = Abs((first.direction.T * middle.rotation * last.direction)[0])
    return EulerRateMatrix.build(
        carry * core * order,
        RateFacts(
            name=sequence,
            frame=frame,
            parameters=parameters,
            relations=(),
            inverse=inverse,
            determinant=determinant,
            condition_number=oo if inverse is None else sqrt((1 + cosine) / (1 - cosine)),
            variable=parameters[1],
            along=partial(_along, sequence, frame, parameters),
        ),
    )


@cache
def sequences_at_lock(sequence: str) -> dict[str, Set]:
    """Return a map from each other Euler sequence to the attitudes at which both sequences are in gimbal lock.

    At gimbal lock of ``sequence``, an attitude depends only on the sum or difference of the first and the third angle.
    So one angle, in rad, describes the attitude: for an intrinsic sequence the first angle, with the third set to zero;
    for an extrinsic sequence the third angle, with the first set to zero. For each other sequence, the map has the set
    of the values of this angle at which the other sequence is in gimbal lock too. The set may be empty.
    """
    left, _, _ = factors(sequence)
    # in gimbal lock only the sum or difference of the outer angles matters, so one of them is zero
    chi = left.angle
    attitudes = []
    for point in rate_jacobian(sequence).singular_set.points():
        _, locked, _ = factors(sequence, (0, point, 0))
        attitudes.append(left.rotation * locked.rotation)
    locks = {}
    for other in SEQUENCES:
        if other != sequence:
            indicators = {lock_indicator(other, attitude) for attitude in attitudes}
            locks[other] = Union(*(zeros_of((c - 1) * (c + 1), chi) for c in indicators))
    return locks


def quaternion_of_euler(sequence: str, angles: Sequence[Any] | None = None) -> ImmutableMatrix:
    """Return the unit quaternion, shape (4, 1), of Euler angles in rad, default phi, theta, psi."""
    turns = (elementary_quaternion(factor.axis, factor.angle) for factor in factors(sequence, angles))
    return ImmutableMatrix(quaternion_product(*turns).applyfunc(expand))


def euler_of_quaternion(sequence: str, q: Sequence[Any] | Matrix = symbols.quaternion) -> ImmutableMatrix:
    """Return the Euler angles of a quaternion of any norm, shape (3, 1), rad.

    The first and the last angle are between -2 pi and 2 pi; both are undefined (SymPy's nan) in gimbal lock.

    Notes
    -----
    For a proper sequence, ``q = (c + s e_i)(C + S e_j)(c' + s' e_i)``, where c, C, c' are the cosines and s, S, s' the
    sines of half the angles. The components of q along 1 and e_i are C times the cosine and sine of half the sum of the
    outer angles; the components along e_j and e_i x e_j are S times the cosine and sine of half their difference. A
    Tait-Bryan sequence times a rotation by pi/2 about its middle axis is a proper sequence. Source: Bernardes &
    Viollet, PLoS ONE 17 (2022) e0276302.
    """
    first, middle, last = factors(sequence)
    q = expressions(q, 4, "a quaternion")
    cross, sign = cross_sign(first.axis, middle.axis)
    proper = first.axis == last.axis
    if not proper:
        quarter = [1, *unit_vector(middle.axis)]
        q = quaternion_product(q, quarter)
    a, b, c, d = q[0], q[1 + first.axis], q[1 + middle.axis], sign * q[1 + cross]
    # Sums and differences of half angles by atan2 keep full accuracy up to gimbal lock, where acos does not.
    half_sum, half_difference = atan2(b, a), atan2(d, c)
    low, high = sqrt(a**2 + b**2), sqrt(c**2 + d**2)
    # middle angle in [0, pi] or [-pi/2, pi/2] (Tait-Bryan)
    values = {
        first.place: half_sum + half_difference,
        middle.place: 2 * atan2(high, low) if proper else atan2(expand(c**2 + d**2 - a**2 - b**2), 2 * low * high),
        last.place: (half_sum - half_difference) * (1 if proper else -sign),
    }
    return ImmutableMatrix([values[place] for place in range(3)])


def euler_of_dcm(sequence: str, dcm_sb: Matrix) -> ImmutableMatrix:
    """Return the Euler angles of the matrix ``dcm_sb`` as expressions, shape (3, 1), rad, in order of application.

    The first and the last angle are undefined (SymPy's nan) in gimbal lock.
    """
    first, middle, last = factors(sequence)
    proper = first.axis == last.axis
    # The image of the last axis gives the first and the middle angle, that of the first axis under the transposed dcm
    # the last angle. Ranges: -pi to pi, middle angle half of it.
    image, back = dcm_sb * last.direction, dcm_sb.T * first.direction
    lifted = middle.direction.cross(last.direction)  # direction in which the middle rotation moves the last axis
    across = lifted if proper else last.direction
    across_back = -lifted if proper else first.direction
    cosine, sine = image.dot(across), image.dot(first.direction.cross(across))
    height = image.dot(first.direction)
    width = sqrt(cosine**2 + sine**2)
    values = {
        first.place: atan2(sine, cosine),
        middle.place: atan2(width, height) if proper else atan2(height * lifted.dot(first.direction), width),
        last.place: atan2(-back.dot(last.direction.cross(across_back)), back.dot(across_back)),
    }
    return ImmutableMatrix([values[place] for place in range(3)])


@cache
def chart(sequence: str) -> Chart:
    """Return the chart (attitude description) of an Euler sequence: it describes every attitude.

    It is singular at gimbal lock.
    """
    kind = "intrinsic" if parse_sequence(sequence)[1] else "extrinsic"
    return Chart(
        name=sequence,
        parameters=symbols.angles,
        relations=(),
        dcm=dcm(sequence),
        quaternion=quaternion_of_euler(sequence),
        of_quaternion=partial(euler_of_quaternion, sequence),
        rate_matrix=partial(rate_jacobian, sequence),
        unreached=None,
        about=f"Euler angles, {kind} sequence {sequence}, in order of application",
    )
