"""Splitting a formula into factors, so that a condition on its sign can be simplified.

A factor such as ``2*x - pi`` is written as ``slope * (quantity - root)`` up to a positive number; a factor that is
always positive does not matter.
"""

from dataclasses import dataclass

import sympy
from sympy import Abs, Add, Expr, Integer, Mul, Rational
from sympy.polys.polyerrors import PolynomialError

from symrot.checker.decide.definite import surely_nonnegative
from symrot.exact.domain.everywhere import range_everywhere
from symrot.exact.factors import is_dear
from symrot.exact.ring.roots import is_positive_where_defined

__all__ = ["Bound", "bound_of", "is_always_positive", "nonnegative_at_zero", "sign_and_factors"]


@dataclass(frozen=True)
class Bound:
    """A factor of a formula, up to a positive constant: ``slope * (quantity - root)`` with the slope 1 or -1.

    Its sign bounds the quantity by the root: ``4 - 2*x``, with slope -1, is positive for x < 2.
    """

    quantity: Expr
    root: Expr
    slope: int

    @property
    def formula(self) -> Expr:
        return self.quantity - self.root


def bound_of(factor: Expr) -> Bound:
    """Return a factor as a quantity minus a number, up to a positive constant: x minus pi/2 for ``2*x - pi``."""
    constant, rest = factor.as_independent(*_leaves(factor), as_Add=True)
    content, quantity = rest.as_coeff_Mul()
    if quantity.is_Add:
        own, quantity = quantity.primitive()
        content *= own
    if quantity.could_extract_minus_sign():
        content, quantity = -content, -quantity
    return Bound(quantity, -constant / content, 1 if content > 0 else -1)


def nonnegative_at_zero(product: Expr, factor: Expr) -> bool:
    """Return whether ``product`` is proven to be nonnegative where ``factor`` is zero."""
    bound = bound_of(factor)
    return bool(bound.quantity.is_Symbol and surely_nonnegative(product.xreplace({bound.quantity: bound.root})))


def _leaves(formula: Expr) -> list[Expr]:
    return [node for node in formula.atoms(sympy.Symbol, sympy.Function, sympy.Derivative) if not node.is_number]


def sign_and_factors(formula: Expr) -> tuple[int, dict[Expr, int]] | None:
    """Return (sign, powers) for a formula: (-1, {x: 2, y: -1}) for ``-4*x**2/y``. Return None if they are unknown.

    The powers map each factor with symbols to its exponent; of the constant factors, only the sign is returned. x takes
    the place of a factor such as ``x + sqrt(x^2 - 1)``, which has the same sign.
    """
    above, below = sympy.fraction(sympy.together(formula))
    sign, powers = 1, dict[Expr, int]()
    for part, direction in ((above, 1), (below, -1)):
        try:
            constant, pairs = (Integer(1), [(part, 1)]) if is_dear(part) else sympy.factor_list(part)
        except PolynomialError:
            # SymPy cannot factor it
            return None
        if constant.is_zero or not constant.is_real:
            return None
        # positive numbers are dropped
        sign *= 1 if constant > 0 else -1
        for factor, power in pairs:
            if factor.is_number:
                if factor.is_positive is None:
                    return None
                sign *= 1 if factor.is_positive or power % 2 == 0 else -1
                continue
            stronger = _stronger_term(factor)
            if stronger != factor and (not power % 2 or all(each.is_positive for each in stronger.atoms(sympy.Number))):
                for term in Mul.make_args(stronger):
                    powers[term] = powers.get(term, 0) + direction * int(power)
                continue
            for linear in _linear_factors(factor):
                powers[linear] = powers.get(linear, 0) + direction * int(power)
    return sign, powers


def _stronger_term(factor: Expr) -> Expr:
    """Return x for ``x + sqrt(x^2 - 1)``: the term whose absolute value is always larger; ``factor`` if there is
    none.
    """
    if not factor.is_Add or len(factor.args) != 2 or not factor.has(Abs, sympy.Pow):
        return factor
    for first, second in (factor.args, factor.args[::-1]):
        excess = (first**2 - second**2).expand().replace(Abs, lambda inner: sympy.sqrt(inner**2))
        vanishing = excess.args[0] if excess.is_Pow and excess.is_nonnegative else None
        # its square exceeds that of the other term, unless both are zero
        if excess.is_positive or (vanishing and vanishing.is_Symbol and first.subs(vanishing, 0) == 0):
            return first
    return factor


def _linear_factors(factor: Expr) -> tuple[Expr, ...]:
    """Return the factors ``x - sqrt(2)`` and ``x + sqrt(2)`` of ``x^2 - 2``; other formulas are not split."""
    symbols = factor.free_symbols
    if len(symbols) == 1 and factor.is_polynomial(*symbols):
        poly = sympy.Poly(factor, *symbols)
        if poly.degree() == 2 and poly.LC() == 1 and poly.discriminant() > 0:
            return tuple(poly.gen - root for root in sympy.roots(poly))
    return (factor,)


def is_always_positive(factor: Expr) -> bool:
    """Return whether a factor is positive wherever it has a value."""
    if factor.is_positive or is_positive_where_defined(factor) or range_everywhere(factor)[0] > 0:
        return True
    return _exceeds_absolute(factor) or _is_definite(factor)


def _exceeds_absolute(factor: Expr) -> bool:
    """Return whether a factor is ``sqrt(P) + a`` with ``P > a^2``, and so positive, as ``sqrt(x^2 + 1) - x`` is."""
    roots = [term for term in Add.make_args(factor) if term.is_Pow and term.exp == Rational(1, 2)]
    if len(roots) != 1 or not factor.is_Add:
        return False
    rest = (roots[0].base - (factor - roots[0]) ** 2).expand()
    return bool(rest.is_positive)


def _is_definite(factor: Expr) -> bool:
    """Return whether a factor is a quadratic polynomial in one symbol that is always positive, as ``x^2 + x + 1``."""
    symbols = factor.free_symbols
    if len(symbols) != 1 or not factor.is_polynomial(*symbols):
        return False
    poly = sympy.Poly(factor, *symbols)
    return bool(poly.degree() == 2 and poly.discriminant() < 0 and poly.LC() > 0)
