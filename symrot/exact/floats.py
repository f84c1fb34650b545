"""Formulas in double precision: a fast test at many points that guides searches but proves nothing."""

import math
from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

import sympy
from sympy import Expr, S, pi

from symrot.exact.limits.operations import spend

__all__ = ["NoValue", "float_at", "seems_zero"]

LOOKS = 40
DIFFERENCES = 3
"""Number of points with a clearly nonzero value that suffice to skip the proof that the formula is zero."""
CLEARLY = 1e-4
"""A value above this fraction of the size of its terms is clearly nonzero: far above rounding and cancellation."""


class NoValue(ArithmeticError):
    """The exception for a formula that has no real value at a point, or whose value cannot be computed.

    An unknown function is one reason.
    """


def _reciprocal(function: Any) -> Any:
    """Return the function ``1/f`` for a function f: the secant if f is the cosine."""
    return lambda x: 1 / function(x)


_FUNCTIONS = {
    sympy.sin: math.sin, sympy.cos: math.cos, sympy.tan: math.tan, sympy.asin: math.asin, sympy.acos: math.acos,
    sympy.atan: math.atan, sympy.atan2: math.atan2, sympy.exp: math.exp, sympy.log: math.log, sympy.sinh: math.sinh,
    sympy.cosh: math.cosh, sympy.tanh: math.tanh, sympy.asinh: math.asinh, sympy.acosh: math.acosh,
    sympy.atanh: math.atanh, sympy.Abs: abs, sympy.cot: _reciprocal(math.tan), sympy.sec: _reciprocal(math.cos),
    sympy.csc: _reciprocal(math.sin), sympy.coth: _reciprocal(math.tanh), sympy.sign: lambda x: math.copysign(1.0, x),
}  # fmt: skip
_NUMBERS = {pi: math.pi, S.Exp1: math.e}


def float_at(formula: Expr, values: Mapping[Expr, float], known: dict[Expr, float]) -> float:
    """Return the value of a formula in double precision.

    Parameters
    ----------
    formula : Expr
        The formula to evaluate.
    values : mapping
        Values of symbols, functions of time and derivatives.
    known : dict
        Values of subexpressions at the same point; the function adds to it.

    Raises
    ------
    NoValue
        If the value is no finite real number, or a symbol has no value in ``values``.
    """
    if formula not in known:
        spend(2)
        try:
            value = _computed(formula, values, known)
        except (KeyError, ValueError, OverflowError, ZeroDivisionError, TypeError):
            raise NoValue from None
        if isinstance(value, complex) or not math.isfinite(value):
            raise NoValue
        known[formula] = value
    return known[formula]


def _computed(node: Expr, values: Mapping[Expr, float], known: dict[Expr, float]) -> Any:
    if node in values:
        return values[node]
    if node.is_Rational:
        return int(node.p) / int(node.q)
    if node in _NUMBERS:
        return _NUMBERS[node]
    parts = [float_at(part, values, known) for part in node.args]
    if node.is_Add:
        return math.fsum(parts)
    if node.is_Mul:
        return math.prod(parts)
    if node.is_Pow:
        return parts[0] ** parts[1]
    return _FUNCTIONS[type(node)](*parts)


def seems_zero(formula: Expr, domain: Sequence[Expr] = ()) -> bool:
    """Return False if a formula is clearly not zero at three random points, in double precision; otherwise True.

    Only points count at which the formulas of ``domain`` are nonnegative and all values are real.
    """
    # this skips proofs that cannot succeed: a wrong False loses a proof, a wrong True only costs time
    source, differences = Random(11), 0
    leaves = sorted(formula.free_symbols.union(*(each.free_symbols for each in domain)), key=str)
    for look in range(LOOKS):
        reach = (1.0, 0.3, 5.0)[look % 3]
        values = {leaf: source.uniform(-reach, reach) for leaf in leaves}
        known: dict[Expr, float] = {}
        try:
            if any(float_at(each, values, known) < 0 for each in domain):
                continue
            terms = [float_at(term, values, known) for term in (formula.args if formula.is_Add else (formula,))]
        except NoValue:
            continue
        differences += abs(math.fsum(terms)) > CLEARLY * (1 + sum(map(abs, terms)))
        if differences == DIFFERENCES:
            return False
    return True
