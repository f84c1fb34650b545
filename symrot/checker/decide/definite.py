"""Formulas that are never negative, as their form shows: sums of squares, absolute values, even powers."""

import sympy
from sympy import Abs, Add, Expr, Mul, Pow

from symrot.exact.factors import factored

__all__ = ["surely_nonnegative"]

MOST_TERMS_OF_SQUARE = 40
"""A sum with more terms is not factored to find out whether it is a square."""


def surely_nonnegative(value: Expr) -> bool:
    """Return whether a real formula is never negative by its form, as ``x**2 + abs(y)`` is."""
    # False means only that the form does not show it
    if value.is_nonnegative or isinstance(value, Abs | sympy.exp):
        return True
    # square roots are real here
    if isinstance(value, Pow) and value.exp.is_Rational:
        even = value.exp.q == 1 and value.exp.p % 2 == 0
        return bool(even or value.exp.q % 2 == 0 or surely_nonnegative(value.base))
    if isinstance(value, Add | Mul) and all(map(surely_nonnegative, value.args)):
        return True
    if not isinstance(value, Add) or len(value.args) > MOST_TERMS_OF_SQUARE:
        return False
    if any(value == 1 - node**2 for node in value.atoms(sympy.sin, sympy.cos)):
        return True
    product = factored(value)
    return not isinstance(product, Add) and surely_nonnegative(product)
