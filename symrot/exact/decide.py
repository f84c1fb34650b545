"""Decide whether two formulas are equal: the normal form of their difference, and a verdict with its evidence.

Scope, with its theorem (research: VERIFICATION.md, section 1). For rational functions of sines and cosines of
Q-linear combinations of angles (rational multiples of pi/12 included), of parameters, of rates, and of unit-norm
groups, the normal form is zero if and only if the identity holds at all real points where both sides are defined:
circles and spheres are rational, irreducible over the complex numbers, and their real points are dense. The same
holds when an angle also occurs outside sines (Ax-Schanuel). With square roots, other functions or other hypotheses a
zero normal form still proves the identity; a nonzero one proves nothing, and "false" is said only with a witness.
"""

from collections.abc import Sequence
from typing import Any

from sympy import Expr, Matrix, MatrixBase, MatrixExpr, sympify

from symrot.errors import InputError
from symrot.exact.ring import FormulaRing, as_zero

__all__ = ["is_zero", "normal_form"]


def normal_form(expression: Any, relations: Sequence[Any] = ()) -> Any:
    """Return the normal form of a formula: exactly 0 if and only if it vanishes identically (in scope).

    Parameters
    ----------
    expression : Expr or Matrix
        Exact: no floating point numbers.
    relations : sequence of Expr or Eq
        Hypotheses; an expression stands for "this is zero", e.g. ``q0**2 + q1**2 + q2**2 + q3**2 - 1``.

    Returns
    -------
    Expr or Matrix
        Of the same shape. A nonzero result is a fraction in lowest terms of the generators of the problem (sines and
        cosines of base angles); to compare two formulas, take the normal form of their difference.

    Raises
    ------
    InputError
        If the formula holds a float or an infinity, divides by something that is zero everywhere, or if the
        hypotheses contradict each other.

    Examples
    --------
    >>> from symrot.symbols import theta
    >>> from sympy import cos, sin
    >>> normal_form(cos(2*theta) - 1 + 2*sin(theta)**2)
    0
    """
    entries, shape = flatten(expression)
    ring = FormulaRing(entries, [as_zero(relation) for relation in relations])
    reduced = [ring.expression(ring.ratio(entry)) for entry in entries]
    return reduced[0] if shape is None else Matrix(*shape, reduced)


def is_zero(expression: Any, relations: Sequence[Any] = ()) -> bool:
    """Return whether a formula or matrix is proven to vanish identically (see :func:`normal_form`)."""
    entries, _ = flatten(expression)
    ring = FormulaRing(entries, [as_zero(relation) for relation in relations])
    return not any(ring.reduce(ring.ratio(entry).numerator) for entry in entries)


def flatten(expression: Any) -> tuple[list[Expr], tuple[int, int] | None]:
    """Return the entries of a formula row by row, and its shape (None for a scalar).

    Raises
    ------
    InputError
        If it is neither a scalar formula nor a matrix of them.
    """
    expression = sympify(expression)
    if isinstance(expression, MatrixExpr):
        expression = expression.as_explicit()
    if isinstance(expression, MatrixBase):
        return list(expression), (int(expression.rows), int(expression.cols))
    if not isinstance(expression, Expr):
        raise InputError(f"exact decision takes a formula or a matrix of formulas, got {expression!r}")
    return [expression], None

