"""Elementary rotations and skew matrices of vectors, from which every attitude description is built.

Convention: :mod:`symrot.conventions`. Rotations are active: ``elementary_rotation(axis, angle) * v`` is ``v`` rotated
about the axis by the angle, right-handed.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import permutations
from typing import Any

from sympy import Expr, I, ImmutableMatrix, LeviCivita, Matrix, cos, eye, sin, sympify

from symrot.conventions import AXES, check_frame
from symrot.errors import InputError

__all__ = [
    "angular_velocity",
    "cross_sign",
    "elementary_rotation",
    "expressions",
    "function_of_skew",
    "skew",
    "unit_vector",
    "vee",
]


def expressions(values: Any, size: int, what: str) -> tuple[Expr, ...]:
    """Return ``values`` as a tuple of ``size`` SymPy expressions.

    Another number of values raises ``InputError``, in which ``what`` names them.
    """
    formulas = tuple(sympify(value) for value in values)
    if len(formulas) != size:
        raise InputError(f"expected {size} values for {what}, got {len(formulas)}: {formulas}")
    return formulas


def axis_number(axis: int | str) -> int:
    """Return the number 0, 1 or 2 of a coordinate axis, given as this number or as a letter X, Y, Z (either case)."""
    if isinstance(axis, str) and len(axis) == 1 and axis.upper() in AXES:
        return AXES.index(axis.upper())
    if isinstance(axis, int) and not isinstance(axis, bool) and 0 <= axis < 3:
        return axis
    raise InputError(f"expected an axis: 0, 1, 2 or one of the letters X, Y, Z; got {axis!r}")


def unit_vector(axis: int | str) -> ImmutableMatrix:
    """Return the unit column, shape (3, 1), of a coordinate axis, given as a number 0 to 2 or a letter X, Y, Z."""
    return ImmutableMatrix(eye(3).col(axis_number(axis)))


def cross_sign(first: int, second: int) -> tuple[int, int]:
    """Return ``(m, sign)`` with ``e_first x e_second = sign * e_m``: axes 0 and 2 give ``(1, -1)``."""
    ((m, sign),) = ((k, int(LeviCivita(i, j, k))) for i, j, k in permutations(range(3)) if (i, j) == (first, second))
    return m, sign


def skew(vector: Sequence[Any] | Matrix) -> ImmutableMatrix:
    """Return the matrix K of a vector, shape (3, 3), with ``K * u = vector x u``."""
    v1, v2, v3 = expressions(vector, 3, "skew")
    return ImmutableMatrix([[0, -v3, v2], [v3, 0, -v1], [-v2, v1, 0]])


def vee(matrix: Matrix) -> ImmutableMatrix:
    """Return the vector of a skew matrix, shape (3, 1): the inverse of :func:`skew`."""
    if matrix.shape != (3, 3):
        raise InputError(f"vee: expected a 3 x 3 matrix, got shape {matrix.shape}")
    # The caller ensures that the matrix is skew.
    return ImmutableMatrix([matrix[2, 1], matrix[0, 2], matrix[1, 0]])


def elementary_rotation(axis: int | str, angle: Any) -> ImmutableMatrix:
    """Return the active rotation about a coordinate axis, shape (3, 3).

    Parameters
    ----------
    axis : int or str
        0, 1, 2 or a letter X, Y, Z.
    angle : Expr
        rad, right-handed.

    Notes
    -----
    A vector along the axis e is unchanged, and a vector normal to it rotates:
    ``e e^T + cos(angle) (1 - e e^T) + sin(angle) skew(e)``.
    """
    return _elementary_rotation(axis_number(axis), sympify(angle))


@lru_cache(maxsize=256)
def _elementary_rotation(axis: int, angle: Expr) -> ImmutableMatrix:
    e = unit_vector(axis)
    along = e * e.T
    return ImmutableMatrix(along + cos(angle) * (eye(3) - along) + sin(angle) * skew(e))


def angular_velocity(dcm_sb: Matrix, parameter: Expr, frame: str = "body") -> ImmutableMatrix:
    """Return omega per unit rate of ``parameter``, shape (3, 1), by differentiating the dcm."""
    rate = dcm_sb.diff(parameter)
    # the definition of omega, against which every other rate matrix is proven
    return vee(dcm_sb.T * rate if check_frame(frame) == "body" else rate * dcm_sb.T)


def function_of_skew(function: Callable[[Expr], Expr], at_zero: Expr, size: Expr) -> tuple[Expr, Expr, Expr]:
    """Return ``c0, c1, c2`` with ``function(K) = c0 + c1 K + c2 K^2`` for the skew matrix K of a vector.

    Parameters
    ----------
    function : callable of one Expr
        A function such as ``exp``.
    at_zero : Expr
        The value (limit) of ``function`` at zero.
    size : Expr
        Length of the vector, positive.
    """
    # Because K^3 = -size^2 K, the eigenvalues of K are 0 and +-i size, where the polynomial agrees with function. The
    # function has real Taylor coefficients, so its values at +-i size are conjugate.
    real, imaginary = function(I * size).as_real_imag()
    return sympify(at_zero), imaginary / size, (at_zero - real) / size**2
