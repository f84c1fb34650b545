"""Quaternions: their product, direction cosine matrix and rates in both frames, all derived from the Hamilton product.

Convention: :mod:`symrot.conventions`: ``(q0, q1, q2, q3)``, scalar first, Hamilton (``i j = k``), body to space.
A quaternion is an immutable column, shape (4, 1). Proof: ``derivations/quaternion_rates.md``.
"""

from collections.abc import Sequence
from functools import cache, lru_cache, partial
from itertools import pairwise
from typing import Any

from sympy import Expr, ImmutableMatrix, Integer, Matrix, Rational, cos, expand, factor, sin, sympify

from symrot import symbols
from symrot.conventions import check_frame
from symrot.errors import InputError
from symrot.kinematics.chart import Chart, RateFacts, RateMatrix, condition_of
from symrot.kinematics.rotations import cross_sign, expressions, unit_vector

__all__ = [
    "chart",
    "conjugate",
    "elementary_quaternion",
    "left_matrix",
    "norm_squared",
    "quaternion_of_dcm",
    "quaternion_product",
    "quaternion_rate_jacobian",
    "quaternion_rates",
    "quaternion_to_dcm",
    "right_matrix",
    "rotation_relations",
    "unit_relation",
]

FORMS = ("unit", "homogeneous", "normalised")


@cache
def _unit_product(left: int, right: int) -> tuple[int, int]:
    """Return ``(k, sign)`` with ``e_left e_right = sign e_k`` for the units 1, i, j, k: i j = k gives ``(3, 1)``."""
    if left == 0 or right == 0:
        return left + right, 1
    if left == right:
        return 0, -1
    m, sign = cross_sign(left - 1, right - 1)
    return m + 1, sign


def left_matrix(q: Sequence[Any] | Matrix) -> ImmutableMatrix:
    """Return L(q), shape (4, 4), the matrix of multiplication from the left: ``q p = L(q) * p`` for all p."""
    q = expressions(q, 4, "a quaternion")
    matrix = [[Integer(0)] * 4 for _ in range(4)]
    for left in range(4):
        for right in range(4):
            k, sign = _unit_product(left, right)
            matrix[k][right] += sign * q[left]
    return ImmutableMatrix(matrix)


def right_matrix(q: Sequence[Any] | Matrix) -> ImmutableMatrix:
    """Return R(q), shape (4, 4), the matrix of multiplication from the right: ``p q = R(q) * p`` for all p."""
    q = expressions(q, 4, "a quaternion")
    matrix = [[Integer(0)] * 4 for _ in range(4)]
    for left in range(4):
        for right in range(4):
            k, sign = _unit_product(left, right)
            matrix[k][left] += sign * q[right]
    return ImmutableMatrix(matrix)


def quaternion_product(*factors: Sequence[Any] | Matrix) -> ImmutableMatrix:
    """Return the Hamilton product of quaternions, multiplied from left to right.

    The product of rotations is the product of their quaternions in the same order.

    Parameters
    ----------
    *factors : sequences of 4 Expr
        Quaternions of any norm, scalar first, dimensionless.

    Returns
    -------
    ImmutableMatrix, shape (4, 1), dimensionless
        The product; ``(1, 0, 0, 0)`` if there are no factors.

    Raises
    ------
    InputError
        If a factor does not have exactly four components.

    Notes
    -----
    Convention: ``i j = k``. Proof: ``derivations/composition.md``.
    Source: W. R. Hamilton, Elements of Quaternions, 1866, book II.

    Examples
    --------
    >>> import symrot
    >>> symrot.quaternion_product((0, 1, 0, 0), (0, 0, 1, 0)).T
    Matrix([[0, 0, 0, 1]])
    """
    product = ImmutableMatrix([1, 0, 0, 0])
    for q in factors:
        product = left_matrix(product) * ImmutableMatrix(expressions(q, 4, "a quaternion"))
    return product


def conjugate(q: Sequence[Any] | Matrix) -> ImmutableMatrix:
    """Return ``(q0, -q1, -q2, -q3)``, the inverse of a unit quaternion, shape (4, 1)."""
    q0, q1, q2, q3 = expressions(q, 4, "a quaternion")
    return ImmutableMatrix([q0, -q1, -q2, -q3])


def norm_squared(q: Sequence[Any] | Matrix) -> Expr:
    """Return ``q0^2 + q1^2 + q2^2 + q3^2``, which is 1 for a unit quaternion."""
    return sum(component**2 for component in expressions(q, 4, "a quaternion"))


def unit_relation(q: Sequence[Any] | Matrix = symbols.quaternion) -> Expr:
    """Return ``|q|^2 - 1``, which is zero for a unit quaternion; proofs use it as a hypothesis."""
    return norm_squared(q) - 1


def rotation_relations(matrix: Matrix) -> tuple[Expr, ...]:
    """Return expressions in the entries of a 3 x 3 matrix that are all zero if and only if it is a rotation."""
    columns = [matrix[:, i] for i in range(3)]
    cyclic = [*columns, columns[0]]
    crossed = [a.cross(b) - columns[(k + 2) % 3] for k, (a, b) in enumerate(pairwise(cyclic))]
    products = [matrix.T * matrix - Matrix.eye(3), matrix * matrix.T - Matrix.eye(3)]
    normal = [product[i, j] for product in products for i in range(3) for j in range(i, 3)]
    return (*normal, *(entry for vector in crossed for entry in vector))


def elementary_quaternion(axis: int | str, angle: Any) -> ImmutableMatrix:
    """Return the unit quaternion, shape (4, 1), of a rotation by ``angle``, rad, about an axis 0, 1, 2 or X, Y, Z."""
    half = sympify(angle) / 2
    return ImmutableMatrix([cos(half), *(sin(half) * unit_vector(axis))])


def quaternion_to_dcm(q: Sequence[Any] | Matrix = symbols.quaternion, form: str = "unit") -> ImmutableMatrix:
    """Return ``dcm_sb`` of a quaternion; column i is the body axis ``q e_i q*`` in space components.

    Parameters
    ----------
    q : sequence of 4 Expr, optional
        Scalar first, body to space, dimensionless; the symbols q0 to q3 by default.
    form : str
        ``"unit"``: with ``1 - 2 (q2^2 + q3^2)`` and so on as diagonal; a rotation only for unit q. ``"homogeneous"``:
        with the columns ``q e_i q*``, quadratic in q; this is ``|q|^2`` times a rotation. ``"normalised"``: the
        homogeneous form divided by ``|q|^2``; a rotation for every q except 0.

    Returns
    -------
    ImmutableMatrix, shape (3, 3), dimensionless
        ``v_s = dcm_sb * v_b``.

    Raises
    ------
    InputError
        If the form is unknown, or q does not have four components.

    Notes
    -----
    Proof: ``derivations/euler_parameters.md``.
    Source: Goldstein, Classical Mechanics, 3rd ed., eq. (4.47), transposed.

    Examples
    --------
    >>> import symrot
    >>> symrot.quaternion_to_dcm()[2, 2]
    -2*q1**2 - 2*q2**2 + 1
    """
    if form not in FORMS:
        raise InputError(f"form: expected one of {', '.join(map(repr, FORMS))}, got {form!r}")
    return _dcm(tuple(expressions(q, 4, "a quaternion")), form)


@lru_cache(maxsize=256)
def _dcm(q: tuple[Expr, ...], form: str) -> ImmutableMatrix:
    columns = [quaternion_product(q, [0, *unit_vector(i)], conjugate(q))[1:, 0].applyfunc(expand) for i in range(3)]
    homogeneous = Matrix.hstack(*columns)
    if form == "unit":
        homogeneous += (1 - norm_squared(q)) * Matrix.eye(3)
        homogeneous = homogeneous.applyfunc(expand)
    elif form == "normalised":
        homogeneous /= norm_squared(q)
    return ImmutableMatrix(homogeneous)


def quaternion_of_dcm(dcm_sb: Matrix, pivot: int = 0) -> ImmutableMatrix:
    """Return a unit quaternion of a dcm, shape (4, 1), by a formula that divides by its component ``q_pivot``."""
    if dcm_sb.shape != (3, 3):
        raise InputError(f"expected a dcm of shape (3, 3), got shape {dcm_sb.shape}")
    if pivot not in range(4):
        raise InputError(f"pivot: expected 0, 1, 2 or 3, the index of the component to divide by; got {pivot!r}")
    # All pivots give the same quaternion up to sign, if q_pivot is not zero. The largest component (at least 1/2) as
    # pivot loses no digits.
    squares = _four_q_q(dcm_sb)
    return ImmutableMatrix(squares[pivot, :].T / (2 * squares[pivot, pivot] ** Rational(1, 2)))


def _four_q_q(dcm_sb: Matrix) -> Matrix:
    """Return the matrix ``4 q q^T``, shape (4, 4), of a unit quaternion, from its dcm; each row is a multiple of q."""
    trace = dcm_sb.trace()
    matrix = Matrix.zeros(4)
    matrix[0, 0] = 1 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        matrix[0, i + 1] = matrix[i + 1, 0] = dcm_sb[k, j] - dcm_sb[j, k]
        matrix[i + 1, i + 1] = 1 + 2 * dcm_sb[i, i] - trace
        matrix[j + 1, k + 1] = matrix[k + 1, j + 1] = dcm_sb[j, k] + dcm_sb[k, j]
    return matrix


def quaternion_rates(frame: str = "body", q: Sequence[Any] | Matrix = symbols.quaternion) -> ImmutableMatrix:
    """Return the matrix M(q) of ``dq/dt = M(q) * omega``; these rates preserve the norm of q, whatever it is.

    Parameters
    ----------
    frame : str
        ``"body"`` or ``"space"``: the components of omega, rad/s.
    q : sequence of 4 Expr, optional
        Scalar first, body to space, dimensionless; the symbols q0 to q3 by default.

    Returns
    -------
    ImmutableMatrix, shape (4, 3), dimensionless

    Raises
    ------
    InputError
        If ``frame`` is neither ``"body"`` nor ``"space"``, or q does not have four components.

    Notes
    -----
    Convention: body ``dq/dt = 1/2 q (0, omega_b)``; space ``dq/dt = 1/2 (0, omega_s) q``.
    Proof: ``derivations/quaternion_rates.md``.

    Examples
    --------
    >>> import symrot
    >>> symrot.quaternion_rates("body").row(0)
    Matrix([[-q1/2, -q2/2, -q3/2]])
    """
    # with q p = L(q) p and p q = R(q) p
    product = left_matrix(q) if check_frame(frame) == "body" else right_matrix(q)
    return ImmutableMatrix(product[:, 1:] / 2)


def quaternion_rate_jacobian(frame: str = "body", q: Sequence[Any] | Matrix = symbols.quaternion) -> RateMatrix:
    """Return the rate matrix B(q), shape (3, 4), of ``omega = B(q) * dq/dt`` for unit q.

    Omega is the vector part of ``2 q* dq/dt`` in body components, and of ``2 dq/dt q*`` in space components.
    """
    q = expressions(q, 4, "a quaternion")
    product = (left_matrix if check_frame(frame) == "body" else right_matrix)(conjugate(q))
    matrix = 2 * product[1:, :]
    # The gradient of |q|^2 as a fourth row gives a constant determinant other than zero: B has rank 3, and each omega
    # has a dq.
    bordered = Matrix.vstack(2 * Matrix([q]), matrix)
    norm = norm_squared(q)
    determinant = factor(bordered.det(method="berkowitz")).subs(norm, 1)
    inverse = quaternion_rates(frame, q)
    return RateMatrix.build(
        matrix,
        RateFacts(
            name="quaternion",
            frame=frame,
            parameters=q,
            relations=(norm - 1,),
            inverse=inverse,
            determinant=determinant,
            condition_number=condition_of((matrix * matrix.T).applyfunc(factor)),
            variable=norm,
            along=partial(_constant, determinant, inverse),
        ),
    )


def _constant(determinant: Expr, inverse: ImmutableMatrix, _: Expr) -> tuple[Expr, ImmutableMatrix]:
    return determinant, inverse


@cache
def chart() -> Chart:
    """Return the chart (attitude description) of unit quaternions; it is singular nowhere.

    It describes every attitude twice, by q and -q.
    """
    return Chart(
        name="quaternion",
        parameters=symbols.quaternion,
        relations=(unit_relation(),),
        dcm=quaternion_to_dcm(),
        quaternion=ImmutableMatrix(symbols.quaternion),
        of_quaternion=ImmutableMatrix,
        rate_matrix=quaternion_rate_jacobian,
        unreached=None,
        about="unit quaternion, scalar first, body to space",
    )
