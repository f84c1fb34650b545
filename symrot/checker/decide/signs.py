"""Proofs that a real formula is never negative: by ranges, as a sum of squares, or by factors."""

from collections.abc import Sequence

import sympy
from sympy import Abs, Add, Expr, Mul, Poly, Pow, Rational, S

from symrot.checker.decide.definite import surely_nonnegative
from symrot.exact.domain.everywhere import range_everywhere
from symrot.exact.factors import factored
from symrot.exact.intervals import enclosure

__all__ = ["is_proven_nonnegative", "is_proven_positive"]

LARGEST = 400
"""The largest number of operations in a formula for which a proof is tried."""

LARGEST_DEGREE = 20
"""The highest degree of a polynomial whose real roots are counted."""

MOST_UNKNOWNS = 12
"""The largest number of unknowns of a polynomial that is written as a sum of squares."""


def is_proven_nonnegative(formula: Expr) -> bool:
    """Return whether a real formula is proven to be at least zero wherever it is defined.

    Examples
    --------
    >>> from sympy import symbols
    >>> x, y = symbols("x y", real=True)
    >>> is_proven_nonnegative(x**2 - 2*x*y + y**2), is_proven_nonnegative(x)
    (True, False)
    """
    return _proven(formula, strict=False)


def is_proven_positive(formula: Expr) -> bool:
    """Return whether a real formula is proven to be above zero wherever it is defined.

    Examples
    --------
    >>> from sympy import symbols
    >>> x = symbols("x", real=True)
    >>> is_proven_positive(x**2 + 1), is_proven_positive(x**2)
    (True, False)
    """
    return _proven(formula, strict=True)


def _proven(formula: Expr, strict: bool) -> bool:
    if formula.count_ops() > LARGEST:
        return False
    if not formula.free_symbols and not formula.atoms(sympy.core.function.AppliedUndef):
        interval = enclosure(formula)
        is_zero = formula.is_zero or sympy.expand(formula) == 0
        return bool(interval is not None and interval.a > 0) or (not strict and bool(is_zero))
    if _by_form(formula, strict):
        return True
    expanded = sympy.expand(formula)
    return any(_by_form(other, strict) for other in (expanded, factored(formula)) if other != formula)


def _by_form(formula: Expr, strict: bool) -> bool:
    if isinstance(formula, Mul):
        return _by_factors(formula, strict)
    if _by_range(formula, strict) or _by_roots(formula, strict):
        return True
    if not strict and (surely_nonnegative(formula) or _by_absolute_values(formula)):
        return True
    return isinstance(formula, Add) and _by_squares(formula, strict)


def _by_factors(formula: Expr, strict: bool) -> bool:
    """Return whether the signs of a formula's factors prove it nonnegative, or positive if ``strict``."""
    negative = False
    for factor in formula.args:
        if _one(factor, strict):
            continue
        if not _one(-factor, strict):
            return False
        negative = not negative
    return not negative


def _one(factor: Expr, strict: bool) -> bool:
    if factor.is_positive or (not strict and factor.is_nonnegative):
        return True
    if isinstance(factor, Pow) and factor.exp.is_Integer:
        if factor.exp % 2 == 0:
            return not strict or factor.exp < 0 or _proven(factor.base, True) or _proven(-factor.base, True)
        return _proven(factor.base, strict)
    return not isinstance(factor, Mul) and _proven(factor, strict)


def _by_range(formula: Expr, strict: bool) -> bool:
    """Return whether bounds of a formula's terms prove it nonnegative, or positive if ``strict``: 2 + sin(x) >= 2 -
    1.
    """
    low, _ = range_everywhere(formula)
    if low > 0 or (low == 0 and not strict):
        return True
    # a positive term that is not bounded away from zero keeps the sum above its lower bound
    terms = Add.make_args(formula)
    return bool(low == 0 and any(term.is_positive and range_everywhere(term)[0] <= 0 for term in terms))


def _by_absolute_values(formula: Expr) -> bool:
    """Return whether the triangle inequality proves a formula nonnegative, such as |x| + |y| - |x + y|."""
    terms = Add.make_args(formula)
    negative = [term for term in terms if term.could_extract_minus_sign()]
    if len(negative) == 1:
        coefficient, inner = negative[0].as_coeff_Mul()
        rest = formula - negative[0]
        # v - c|u| with v >= 0 is nonnegative where v^2 - c^2 u^2 is
        if isinstance(inner, Abs) and surely_nonnegative(rest):
            return _without_absolute(sympy.expand(rest**2 - coefficient**2 * inner.args[0] ** 2))
    # terms c|e| are replaced by c*e or -c*e, which are not larger: it suffices that one result is nonnegative
    return _without_absolute(formula)


def _without_absolute(formula: Expr) -> bool:
    rest = S.Zero
    sizes: dict[Expr, Expr] = {}
    for term in Add.make_args(formula):
        coefficient, inner = term.as_coeff_Mul()
        absolute = [factor for factor in Mul.make_args(inner) if isinstance(factor, Abs)]
        if absolute and len(absolute) == len(Mul.make_args(inner)) and coefficient > 0:
            key = Mul(*(factor.args[0] for factor in absolute))
            sizes[key] = sizes.get(key, S.Zero) + coefficient
        else:
            rest += term
    for key, size in sizes.items():
        others = [sympy.expand(rest - sign * size * key) for sign in (1, -1)]
        rest = min(rest, *others, key=lambda other: len(Add.make_args(other)) if other else 0)
    return bool(sizes) and (rest.is_zero or surely_nonnegative(rest))


def _by_roots(formula: Expr, strict: bool) -> bool:
    """Return whether counting real roots proves a polynomial in one unknown nonnegative, or positive if
    ``strict``.
    """
    symbols = formula.free_symbols
    if len(symbols) != 1 or not formula.is_polynomial(*symbols):
        return False
    poly = Poly(formula, *symbols)
    if poly.degree() > LARGEST_DEGREE or not (poly.domain.is_QQ or poly.domain.is_ZZ) or poly.LC() < 0:
        return False
    return all(factor.count_roots() == 0 or (not strict and power % 2 == 0) for factor, power in poly.factor_list()[1])


def _by_squares(formula: Expr, strict: bool) -> bool:
    """Return whether a quadratic polynomial is a sum of squares and nonnegative terms; with ``strict``, whether it
    is positive.
    """
    try:
        poly = Poly(formula)
    except sympy.PolynomialError:
        return False
    if len(poly.gens) > MOST_UNKNOWNS or poly.total_degree() > 2 or not poly.domain.is_QQ | poly.domain.is_ZZ:
        return False
    if not all(gen.is_extended_real is not False for gen in poly.gens):
        return False
    return _is_definite(_gram(poly), strict, list(map(surely_nonnegative, poly.gens)))


def _gram(poly: Poly) -> list[list[Rational]]:
    """Return the symmetric matrix of a quadratic polynomial in (1, x, y, ..): [[0, 2], [2, 1]] for x^2 + 4 x."""
    size = len(poly.gens) + 1
    gram = [[S.Zero] * size for _ in range(size)]
    for powers, coefficient in poly.terms():
        places = [n + 1 for n, power in enumerate(powers) for _ in range(power)]
        first, second = ([0, 0, *places])[-2:]
        gram[first][second] += coefficient / 2
        gram[second][first] += coefficient / 2
    return gram


def _is_definite(gram: Sequence[Sequence[Rational]], strict: bool, nonnegative: Sequence[bool]) -> bool:
    """Return whether a quadratic form with the matrix ``gram`` is never negative, and never zero if ``strict``.

    ``nonnegative`` says for each unknown whether it is never negative.
    """
    rows = [list(row) for row in gram]
    for place in range(1, len(rows)):
        # a linear term with a coefficient >= 0 in a nonnegative unknown only increases the value
        if rows[0][place] > 0 and nonnegative[place - 1]:
            rows[0][place] = rows[place][0] = S.Zero
    for place in reversed(range(1, len(rows))):
        pivot = rows[place][place]
        if pivot < 0 or (pivot == 0 and any(rows[place][:place])):
            return False
        if pivot:
            for i in range(place):
                for j in range(place):
                    rows[i][j] -= rows[i][place] * rows[place][j] / pivot
    return bool(rows[0][0] > 0 or (not strict and rows[0][0] == 0))
