"""Radicands such as ``1 - (x*sqrt(1 - y^2) + y*sqrt(1 - x^2))^2``, which are squares and so never negative."""

from collections.abc import Collection
from math import prod

from sympy import Expr, Poly, Pow, Rational, expand, factor_list
from sympy.polys.polyerrors import BasePolynomialError

from symrot.exact.factors import is_dear

__all__ = ["is_square_of_roots"]

MOST_TERMS, LARGEST_DEGREE = 12, 8


def is_square_of_roots(formula: Expr, nonnegative: Collection[Expr]) -> bool:
    """Return whether a formula ``A + B*sqrt(C)`` is a square of a sum of roots, for nonnegative radicands.

    ``nonnegative`` are formulas that are not negative where the claim is defined, such as ``1 - x**2``.
    """
    # sqrt(A + B*sqrt(C)) = sqrt((A + D)/2) + sqrt((A - D)/2) with D^2 = A^2 - B^2 C
    expanded = expand(formula)
    roots = _roots(expanded)
    if not roots or len(expanded.args) > MOST_TERMS or len(roots) > 2 or is_dear(expanded):
        return False
    whole = prod(roots)
    slope = expanded.coeff(whole) if len(roots) == 1 else expand(expanded.coeff(roots[0]).coeff(roots[1]))
    rest = expand(expanded - slope * whole)
    inside = prod(root.base for root in roots)
    if rest.has(*roots) or slope.has(*roots) or not rest.free_symbols:
        return False
    # formulas with roots prove nothing here: they might rely on this one
    known = [base for base in (*nonnegative, *(root.base for root in roots)) if not _roots(base)]
    try:
        if Poly(rest).total_degree() > LARGEST_DEGREE:
            return False
        squared = _root_of_square(expand(rest**2 - slope**2 * inside))
        halves = () if squared is None else (expand(rest + squared), expand(rest - squared))
        return bool(halves) and all(_is_nonnegative(half, known) for half in halves)
    except BasePolynomialError:  # a quotient, such as 1 + 1/x
        return False


def _roots(formula: Expr) -> list[Expr]:
    return sorted((power for power in formula.atoms(Pow) if power.exp == Rational(1, 2)), key=str)


def _root_of_square(formula: Expr) -> Expr | None:
    """Return D if a polynomial is a square D^2 with rational coefficients of D; otherwise None."""
    if formula == 0:
        return formula
    constant, pairs = factor_list(formula)
    if any(power % 2 for _, power in pairs) or not (constant > 0):
        return None
    root = Pow(constant, Rational(1, 2))
    return root * prod(factor ** (power // 2) for factor, power in pairs) if root.is_Rational else None


def _is_nonnegative(formula: Expr, nonnegative: Collection[Expr]) -> bool:
    """Return whether a polynomial is zero, or a positive number times squares and some of ``nonnegative``."""
    if formula == 0:
        return True
    constant, pairs = factor_list(formula)
    odd = {factor for factor, power in pairs if power % 2}
    for known in nonnegative:
        if not odd:
            break
        own, others = factor_list(known)
        factors = {factor for factor, power in others if power % 2}
        if factors and factors <= odd:
            odd -= factors
            constant *= own
    return not odd and bool(constant > 0)
