"""The common interface of all attitude descriptions ("charts").

A chart describes an attitude by parameters p, such as Euler angles or a quaternion. It provides the direction cosine
matrix, conversions to and from the unit quaternion, and in both frames the rate matrix B(p) of ``omega = B(p) dp/dt``.
B has no inverse at singular parameters.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import Any, Self

from sympy import (
    Basic,
    Expr,
    FiniteSet,
    ImageSet,
    ImmutableDenseMatrix,
    ImmutableMatrix,
    Integer,
    Interval,
    Lambda,
    Matrix,
    Max,
    Min,
    S,
    Set,
    Symbol,
    Tuple,
    cancel,
    fraction,
    limit,
    oo,
    periodicity,
    pi,
    solveset,
    sqrt,
    together,
)

from symrot.conventions import check_frame
from symrot.errors import InputError

__all__ = ["Chart", "Limit", "RateMatrix", "SingularSet", "condition_of", "zeros_of"]

_n = Symbol("n", integer=True)
_NUMBERS = {S.Integers: "n any integer", S.Naturals: "n = 1, 2, ...", S.Naturals0: "n = 0, 1, 2, ..."}


@dataclass(frozen=True)
class SingularSet:
    """The set of real values of one variable at which an expression is zero, such as the determinant of a rate matrix.

    Attributes
    ----------
    equation : Expr
        The expression that vanishes.
    variable : Expr
        An angle, rad, or another expression in the parameters of the chart.
    values : Set
        SymPy set of real numbers; empty if the expression has no zero where the chart is defined.

    Examples
    --------
    >>> import symrot
    >>> symrot.rate_jacobian("ZXZ").singular_set.points()
    (0, pi)
    """

    equation: Expr
    variable: Expr
    values: Set

    @property
    def is_empty(self) -> bool:
        return bool(self.values is S.EmptySet)

    def points(self) -> tuple[Expr, ...]:
        """Return the values of the variable in one period at which the chart is singular: all n pi give ``(0, pi)``.

        Empty if there are none.
        """
        # Rotation vectors of length 2 pi, 4 pi, .. have their first singular value in the second interval.
        for turn in (Interval.Ropen(0, 2 * pi), Interval.Ropen(2 * pi, 4 * pi)):
            points = self.values.intersect(turn)
            if points is not S.EmptySet:
                return tuple(sorted(points, key=float))
        return ()

    def __contains__(self, value: Any) -> bool:
        return bool(self.values.contains(value) == S.true)

    def __str__(self) -> str:
        if self.is_empty:
            return "empty"
        values = self.values
        if isinstance(values, ImageSet):
            return f"{self.variable} = {values.lamda.expr}, {_NUMBERS[values.base_set]}"
        return f"{self.variable} in {values}"


def condition_of(gram: Matrix) -> Expr:
    """Return the condition number of a rate matrix B from its Gram matrix ``gram``, ``B^T B`` or ``B B^T``;
    at least 1.
    """
    # the singular values of B are the roots of these eigenvalues
    values = list(gram.eigenvals())
    return sqrt(cancel(Max(*values) / Min(*values)))


@cache
def zeros_of(equation: Expr, variable: Symbol, domain: Set = S.Reals) -> Set:
    """Return the exact set of zeros of an expression in one variable.

    Parameters
    ----------
    equation : Expr
        The expression whose zeros are computed.
    variable : Symbol
        The variable; all other symbols are constants.
    domain : Set
        The reals, or the half line from zero.
    """
    if not equation.free_symbols:
        return domain if equation == 0 else S.EmptySet
    solution = solveset(equation, variable, domain)
    if isinstance(solution, FiniteSet) or solution is S.EmptySet:
        return solution
    period = periodicity(fraction(together(equation))[0], variable)
    if period is None or not (4 * pi / period).is_integer:
        return solution
    # functions of angles and half angles: evenly spaced zeros are one family first + n * spacing
    zeros = sorted(solution.intersect(Interval.Ropen(4 * pi, 8 * pi)), key=float)
    spacing, first = 4 * pi / len(zeros), zeros[0] - 4 * pi
    if any(after - before != spacing for before, after in pairwise(zeros)):
        return solution
    numbers = {S.Reals: S.Integers, Interval(0, oo): S.Naturals0, Interval.open(0, oo): S.Naturals}[domain]
    if first != 0 and numbers is S.Naturals:
        numbers = S.Naturals0
    return ImageSet(Lambda(_n, first + _n * spacing), numbers)


@dataclass(frozen=True)
class Limit:
    """The limit of the inverse rate matrix at a singular point from one side: which rates grow without bound, and how
    fast.

    Attributes
    ----------
    variable : Expr
        The parameter that approaches the point, such as an angle in rad.
    point : Expr
        The singular value of the variable.
    side : str
        ``"+"`` from above, ``"-"`` from below.
    limit : ImmutableMatrix
        Limits of the entries; infinite limits have their sign.
    residue : ImmutableMatrix
        Limits of ``(variable - point)`` times the entries.

    Examples
    --------
    >>> import symrot
    >>> symrot.rate_jacobian("ZXZ").limits[0].point
    0
    """

    variable: Expr
    point: Expr
    side: str
    limit: ImmutableMatrix
    residue: ImmutableMatrix


@dataclass(frozen=True)
class RateFacts:
    """The properties of a :class:`RateMatrix` besides its entries: frame, parameters, determinant, inverse."""

    name: str
    frame: str
    parameters: tuple[Expr, ...]
    relations: tuple[Expr, ...]
    inverse: ImmutableMatrix | None
    determinant: Expr
    condition_number: Expr
    # an angle or a length; the determinant depends on no other combination of the parameters
    variable: Expr
    # (determinant, inverse) at the value x of variable, for x in domain; gives the limits
    along: Callable[[Expr], tuple[Expr, ImmutableMatrix | None]]
    domain: Set = S.Reals


class RateMatrix(ImmutableDenseMatrix):  # type: ignore[misc]
    """The rate matrix B(p) of ``omega = B(p) dp/dt``: an immutable SymPy matrix with its inverse and singular set.

    Attributes
    ----------
    frame : str
        ``"body"`` or ``"space"``: the components of omega.
    parameters : tuple of Expr
        The parameters p, such as Euler angles in rad.
    inverse : ImmutableMatrix
        ``dp/dt = inverse * omega``, 1/s for omega in rad/s; InputError if the parameters are singular.
    determinant : Expr
        The determinant of B or, with a constraint, of the matrix with the gradient of the constraint above B.
    singular_set : SingularSet
        Zeros of the determinant, solved for exactly.
    condition_number : Expr
        Ratio of the largest to the smallest singular value (2-norm); a property, while SymPy's matrices have a method
        of this name.
    limits : tuple of Limit
        Limits of the inverse at each singular point in one period, from both sides.

    Examples
    --------
    >>> import symrot
    >>> isinstance(symrot.rate_jacobian("ZXZ"), symrot.RateMatrix)
    True
    """

    facts: RateFacts

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        """Return a plain immutable matrix with the given entries; only :meth:`build` makes a RateMatrix."""
        # SymPy rebuilds a matrix with func(*args) after each operation; the stored inverse and determinant would be
        # wrong for the new entries.
        return ImmutableDenseMatrix(*args, **kwargs)

    @classmethod
    def _fromrep(cls, rep: Any) -> Any:
        return ImmutableDenseMatrix._fromrep(rep)

    @classmethod
    def build(cls, matrix: Matrix, facts: RateFacts) -> Self:
        plain = ImmutableDenseMatrix(matrix)
        self: Self = Basic.__new__(cls, Integer(plain.rows), Integer(plain.cols), Tuple(*plain.flat()))
        self._rows, self._cols, self._rep = plain.rows, plain.cols, plain._rep
        self.facts = facts
        return self

    def __reduce__(self) -> Any:
        return type(self).build, (self.as_immutable(), self.facts)

    def as_immutable(self) -> ImmutableMatrix:
        """Return the entries as a plain immutable SymPy matrix, without the properties of a rate matrix."""
        return ImmutableDenseMatrix._fromrep(self._rep)

    @property
    def frame(self) -> str:
        return self.facts.frame

    @property
    def parameters(self) -> tuple[Expr, ...]:
        return self.facts.parameters

    @property
    def inverse(self) -> ImmutableMatrix:
        if self.facts.inverse is None:
            raise InputError(
                f"the {self.facts.frame} rate matrix of {self.facts.name} has no inverse at {self.facts.parameters}: "
                f"its determinant is 0 there"
            )
        return self.facts.inverse

    @property
    def determinant(self) -> Expr:
        return self.facts.determinant

    @property
    def condition_number(self) -> Expr:
        return self.facts.condition_number

    @cached_property
    def _coordinate(self) -> Symbol:
        variable = self.facts.variable
        return variable if isinstance(variable, Symbol) else Symbol("x", real=True)

    @cached_property
    def singular_set(self) -> SingularSet:
        determinant, _ = self.facts.along(self._coordinate)
        values = zeros_of(determinant, self._coordinate, self.facts.domain)
        return SingularSet(self.facts.determinant, self.facts.variable, values)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        x = self._coordinate
        _, inverse = self.facts.along(x)
        if inverse is None:
            return ()
        return tuple(
            Limit(
                self.facts.variable,
                point,
                side,
                inverse.applyfunc(lambda entry: limit(entry, x, point, side)),  # noqa: B023 applied at once
                inverse.applyfunc(lambda entry: limit(entry * (x - point), x, point, side)),  # noqa: B023
            )
            for point in self.singular_set.points()
            for side in ("-", "+")
        )


@dataclass(frozen=True)
class Chart:
    """An attitude description: its parameters, its conversions to the dcm and the quaternion, and its rate matrix.

    Attributes
    ----------
    name : str
        The name of the description, such as ``"mrp"``.
    parameters : tuple of Symbol
        The symbols of the parameters, in order.
    relations : tuple of Expr
        Expressions that are zero for every valid set of parameters, such as ``|q|^2 - 1``; proofs assume them.
    dcm : ImmutableMatrix, shape (3, 3)
        ``dcm_sb`` in the parameters.
    quaternion : ImmutableMatrix, shape (4, 1)
        The same attitude as a unit quaternion in the parameters.
    of_quaternion : callable
        ``of_quaternion(q)``: the parameters as expressions in a unit quaternion, shape (n, 1).
    rate_matrix : callable
        ``rate_matrix(frame)``: the :class:`RateMatrix` B of ``omega = B dp/dt``.
    unreached : Expr or None
        An expression in :data:`symrot.symbols.quaternion` that is zero at the attitudes for which this chart has no
        parameters; None if there are no such attitudes.
    about : str
        A phrase that says what the parameters are.
    """

    name: str
    parameters: tuple[Symbol, ...]
    relations: tuple[Expr, ...]
    dcm: ImmutableMatrix
    quaternion: ImmutableMatrix
    of_quaternion: Callable[..., ImmutableMatrix]
    rate_matrix: Callable[[str], RateMatrix]
    unreached: Expr | None
    about: str

    def rates(self, frame: str = "body") -> ImmutableMatrix:
        """Return the matrix M of ``dp/dt = M * omega``, for omega in components of ``frame``, ``"body"`` or
        ``"space"``.
        """
        return self.rate_matrix(check_frame(frame)).inverse

    def determinant(self, frame: str = "body") -> Expr:
        """Return the determinant of ``rate_matrix(frame)``; where it is zero, the description is singular."""
        return self.rate_matrix(check_frame(frame)).determinant

    @property
    def singular_set(self) -> SingularSet:
        """The parameters at which the rate matrix has no inverse, in either frame, such as the middle angles at gimbal
        lock.
        """
        return self.rate_matrix("body").singular_set
