"""Factors of polynomials and formulas, unless SymPy would need very long to find them.

SymPy factors ``x**24 - y`` in a millisecond and ``x**30 - y`` not within minutes. Such a polynomial is split as far as
that is cheap, and the rest stays whole: what is proven from the factors stays true, and some proofs are missed.
"""

from typing import Any

import sympy
from sympy import Expr, Integer, Mul, Pow, Rational, exp, preorder_traversal, sympify
from sympy.polys.rings import PolyElement, sring

from symrot.exact.limits.operations import spend
from symrot.exact.limits.size import pieces

__all__ = ["factor_list", "factored", "is_dear"]

HIGHEST_DEGREE = 20
"""The largest degree in any unknown of a polynomial in several unknowns that SymPy is asked to factor."""

HIGHEST_ALONE = 240
"""The largest degree of a polynomial in one unknown that SymPy is asked to factor."""

MOST_UNKNOWNS = 10
"""The largest number of unknowns of a polynomial that SymPy is asked to factor."""

MOST_BITS = 1000
"""The largest number of bits of a coefficient of a polynomial that SymPy is asked to factor.

For polynomials in one unknown, :func:`factor_list` allows 100 times as many."""


def factor_list(poly: PolyElement) -> tuple[Any, list[tuple[PolyElement, int]]]:
    """Return (number, [(factor, power), ..]) for a polynomial; a factor that would take too long stays whole."""
    spend(len(poly) * (20 + 30 * sum(poly.degrees())))
    if poly.is_ground or not _is_dear(poly):
        constant, pairs = poly.factor_list()
        return constant, [(factor, int(power)) for factor, power in pairs]
    content, rest = poly.primitive()
    if rest.LC < 0:
        content, rest = -content, -rest
    ring = poly.ring
    shared = [min(column) for column in zip(*rest, strict=True)]
    pairs = [(ring.gens[place], power) for place, power in enumerate(shared) if power]
    if pairs:
        rest = rest.new({tuple(m - s for m, s in zip(mono, shared, strict=True)): c for mono, c in rest.items()})
    return content, pairs if rest.is_ground else [*pairs, *_split(rest)]


def _split(poly: PolyElement) -> list[tuple[PolyElement, int]]:
    """Return the factors of a primitive polynomial that has degree 1 in some unknown, as pairs (factor, power).

    A polynomial without such an unknown is returned whole, as its own single factor.
    """
    linear = [place for place, degree in enumerate(poly.degrees()) if degree == 1]
    if not linear:
        return [(poly, 1)]
    # a*x + b has the factors of the common divisor of a and b, and one that contains x
    (place,) = linear[:1]
    slope = poly.diff(poly.ring.gens[place])
    common = slope.gcd(poly - slope * poly.ring.gens[place])
    if common.is_ground:
        return [(poly, 1)]
    return [*factor_list(common)[1], (poly.exquo(common), 1)]


def _is_dear(poly: PolyElement) -> bool:
    """Return whether SymPy might need very long to factor a polynomial."""
    degrees = [degree for degree in poly.degrees() if degree]
    domain = poly.ring.domain
    numbers = poly.coeffs() if domain.is_QQ or domain.is_ZZ else []
    bits = max((abs(int(number.numerator)).bit_length() for number in numbers), default=0)
    if len(degrees) == 1:
        return bool(degrees[0] > HIGHEST_ALONE or bits > 100 * MOST_BITS)
    return bool(max(degrees) > HIGHEST_DEGREE or len(degrees) > MOST_UNKNOWNS or bits > MOST_BITS)


def factored(formula: Expr) -> Expr:
    """Return a formula as a product of factors; unchanged if it has none, or if SymPy might need very long.

    Examples
    --------
    >>> from sympy.abc import x, y
    >>> factored(x**2 - y**2), factored(x**30 - x**29*y)
    ((x - y)*(x + y), x**30 - x**29*y)
    """
    spend(100 + 20 * pieces([formula]))
    if is_dear(formula):
        return formula
    if len(formula.free_symbols) > MOST_UNKNOWNS and formula.is_polynomial():
        poly = sring(formula)[1]
        constant, pairs = factor_list(poly)
        return Mul(sympify(constant), *(factor.as_expr() ** power for factor, power in pairs))
    return sympy.factor(formula)


def is_dear(formula: Expr) -> bool:
    """Return whether SymPy might need very long to factor a formula: for a high power, a long number, or ``exp(3000)``
    beside other terms.
    """
    unknowns = len(formula.free_symbols)
    highest = HIGHEST_ALONE if unknowns < 2 and not formula.has(exp) else HIGHEST_DEGREE
    for node in preorder_traversal(formula):
        if isinstance(node, Rational) and max(abs(node.p), node.q).bit_length() > MOST_BITS:
            return True
        if isinstance(node, Pow) and isinstance(node.exp, Rational) and abs(node.exp.p) > highest:
            return True
        # SymPy reads exp(3000) as the power 3000 of the unknown e
        if isinstance(node, exp) and max(abs(int(n.p)) for n in _multiples(node.args[0])) > highest:
            return True
    return False


def _multiples(exponent: Expr) -> list[Rational]:
    """Return the rational factors of the terms of an exponent: 3 and 1/2 for ``3*x + y/2``."""
    numbers = [term.as_coeff_Mul()[0] for term in sympy.Add.make_args(exponent)]
    return [number if isinstance(number, Rational) else Integer(1) for number in numbers]
