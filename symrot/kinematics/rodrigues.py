"""Rodrigues parameters: classical, axis times tan(angle/2), and modified, axis times tan(angle/4).

Both are projections of the unit quaternions, from the centre of the unit sphere or from (-1, 0, 0, 0). A projection is
described by a quaternion h(p) of any norm, polynomial in the parameters. Convention: :mod:`symrot.conventions`. Proof:
``derivations/rodrigues.md``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

from sympy import Expr, ImmutableMatrix, Integer, Interval, Matrix, Symbol, cancel, expand, factor, oo, sqrt

from symrot import symbols
from symrot.conventions import check_frame
from symrot.errors import InputError
from symrot.kinematics.chart import Chart, RateFacts, RateMatrix, condition_of
from symrot.kinematics.quaternion import conjugate, left_matrix, norm_squared, quaternion_to_dcm, right_matrix
from symrot.kinematics.rotations import expressions

__all__ = ["CLASSICAL", "MODIFIED", "Projection", "chart", "projection", "shadow"]


@dataclass(frozen=True)
class Projection:
    """The projection ``p = (q1, q2, q3) / (centre + q0)`` of unit quaternions onto Rodrigues parameters.

    The quaternions are projected from the point (-centre, 0, 0, 0).
    """

    name: str
    parameters: tuple[Symbol, ...]
    centre: int  # 0: classical parameters; 1: modified parameters
    about: str

    def of_quaternion(self, q: Sequence[Any] | Matrix = symbols.quaternion) -> ImmutableMatrix:
        """Return the parameters, shape (3, 1), of a unit quaternion: its vector part divided by ``centre + q0``.

        ``centre`` is 0 for classical and 1 for modified Rodrigues parameters.
        """
        q0, *vector = expressions(q, 4, "a quaternion")
        # infinite at rotations by pi (classical) or 2 pi (modified)
        return ImmutableMatrix([component / (self.centre + q0) for component in vector])

    def homogeneous(self, values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
        """Return a quaternion of any norm, shape (4, 1): ``(1, p)`` for classical, ``(1 - p^2, 2 p)`` for modified
        parameters.
        """
        # A free norm avoids the square root of the unit quaternion.
        p = expressions(self.parameters if values is None else values, 3, self.name)
        if self.centre == 0:
            return ImmutableMatrix([1, *p])
        square = sum(component**2 for component in p)
        return ImmutableMatrix([1 - square, *(2 * component for component in p)])

    def norm(self, values: Sequence[Any] | Matrix | None = None) -> Expr:
        """Return the norm of the quaternion of :meth:`homogeneous`: ``sqrt(1 + p^2)`` (classical) or ``1 + p^2``
        (modified).
        """
        base, exponent = factor(norm_squared(self.homogeneous(values))).as_base_exp()
        return base ** (exponent / 2)

    def quaternion(self, values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
        """Return the unit quaternion, shape (4, 1), of the parameters ``values`` (default: their symbols)."""
        return ImmutableMatrix(self.homogeneous(values) / self.norm(values))

    def dcm(self, values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
        """Return ``dcm_sb``, shape (3, 3), as rational functions of the parameters ``values`` (default: symbols)."""
        return _dcm(self, expressions(self.parameters if values is None else values, 3, self.name))

    def rate_matrix(self, frame: str = "body") -> RateMatrix:
        """Return the rate matrix B(p), shape (3, 3), with ``omega = B(p) * dp/dt``; it is never singular."""
        # B follows from the vector part of omega = 2 h* dh / |h|^2, which holds for a quaternion h of any norm.
        return _rate_matrix(self, check_frame(frame))

    def chart(self) -> Chart:
        q0 = symbols.quaternion[0]
        return Chart(
            name=self.name,
            parameters=self.parameters,
            relations=(),
            dcm=self.dcm(),
            quaternion=self.quaternion(),
            of_quaternion=self.of_quaternion,
            rate_matrix=self.rate_matrix,
            unreached=self.centre + q0,
            about=self.about,
        )


@cache
def _dcm(which: Projection, p: tuple[Any, ...]) -> ImmutableMatrix:
    return ImmutableMatrix(quaternion_to_dcm(which.homogeneous(p), "normalised").applyfunc(factor))


@cache
def _rate_matrix(which: Projection, frame: str) -> RateMatrix:
    p, h = which.parameters, which.homogeneous()
    square = norm_squared(h)
    side = left_matrix if frame == "body" else right_matrix
    numerators = (2 * side(conjugate(h))[1:, :] * h.jacobian(p)).applyfunc(expand)
    matrix = (numerators / square).applyfunc(factor)
    determinant = factor(expand(numerators.det(method="berkowitz")) / square**3)
    # dp = (dq_vector - p dq0) / (centre + q0), with dq = q (0, omega) / 2 and q = h / |h|; |h| drops out
    dh = side(h)[:, 1:] / 2
    divisor = expand(which.centre * which.norm() + h[0])
    inverse = ((dh[1:, :] - Matrix(p) * dh[0, :]) / divisor).applyfunc(expand)
    size = Symbol("size", positive=True)
    straight = {p[0]: size, p[1]: Integer(0), p[2]: Integer(0)}
    length = sqrt(sum(component**2 for component in p))
    # B(R p) = R B(p) R^T for any rotation R, so the singular values of B depend on the length of p alone
    condition = condition_of((matrix.T * matrix).xreplace(straight).applyfunc(factor))
    return RateMatrix.build(
        matrix,
        RateFacts(
            name=which.name,
            frame=frame,
            parameters=p,
            relations=(),
            inverse=ImmutableMatrix(inverse),
            determinant=determinant,
            condition_number=condition.xreplace({size: length}),
            variable=length,
            along=partial(_along, p, determinant, ImmutableMatrix(inverse)),
            domain=Interval(0, oo),
        ),
    )


def _along(
    parameters: tuple[Symbol, ...], determinant: Expr, inverse: ImmutableMatrix, size: Expr
) -> tuple[Expr, ImmutableMatrix]:
    """Return the determinant and the inverse of a rate matrix at the parameters ``size * n``, for a unit axis n."""
    # The determinant depends only on the length of the parameters, so any axis will do.
    straight = dict(zip(parameters, (size, Integer(0), Integer(0)), strict=True))
    turned = dict(zip(parameters, (size * n for n in symbols.axis), strict=True))
    return determinant.xreplace(straight), inverse.xreplace(turned)


CLASSICAL = Projection("rodrigues", symbols.rodrigues, 0, "classical Rodrigues parameters, axis times tan(angle/2)")
MODIFIED = Projection("mrp", symbols.mrp, 1, "modified Rodrigues parameters, axis times tan(angle/4)")


def projection(name: str) -> Projection:
    """Return the :class:`Projection` to Rodrigues (``"rodrigues"``) or modified Rodrigues parameters (``"mrp"``)."""
    for which in (CLASSICAL, MODIFIED):
        if which.name == name:
            return which
    raise InputError(f"expected 'rodrigues' (classical) or 'mrp' (modified Rodrigues parameters), got {name!r}")


def chart(name: str) -> Chart:
    """Return the chart (attitude description) ``"rodrigues"`` (classical) or ``"mrp"`` (modified parameters).

    The first cannot describe rotations by pi, the second rotations by 2 pi.
    """
    return projection(name).chart()


def shadow(values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
    """Return the shadow ``-s / |s|^2`` of modified Rodrigues parameters s: the other parameters of the same attitude.

    The shadow of s = 0 is undefined (SymPy's nan).
    """
    # the parameters of -q. One set has length at most 1; switching to it keeps every motion bounded.
    return ImmutableMatrix(MODIFIED.of_quaternion(-MODIFIED.quaternion(values)).applyfunc(cancel))
