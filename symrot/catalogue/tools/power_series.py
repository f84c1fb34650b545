"""Power series that solve linear differential equations: a formula for their n-th coefficient, with a symbol n."""

from collections.abc import Mapping

from sympy import Expr, Integer, Poly, Symbol, ff

__all__ = ["coefficient", "indexed"]


def indexed(name: str, index: Symbol, shift: int = 0) -> Symbol:
    """Return the symbol of a coefficient of a power series; ``indexed("a", n, -1)`` is ``a_{n-1}``."""
    return Symbol(f"{name}_{{{index.name}{f'{shift:+d}' if shift else ''}}}")


def coefficient(terms: Mapping[str, Mapping[int, Expr]], variable: Symbol, index: Symbol) -> Expr:
    """Return the coefficient of ``variable^index`` in a sum of polynomials times derivatives of power series.

    For ``terms = {"a": {0: 1, 2: x}}``, the sum is ``a(x) + x a''(x)``, and the result ``a[k] + (k + 1) k a[k + 1]``.

    Parameters
    ----------
    terms : mapping
        A map from the name of a series to a map from an order of differentiation (0 for the series itself) to the
        polynomial in ``variable`` that multiplies this derivative.

    Notes
    -----
    The derivative of order d of the term ``a[k] variable^k`` is ``k (k - 1) .. (k - d + 1) a[k] variable^(k - d)``.
    """
    total = Integer(0)
    for name, factors in terms.items():
        for order, factor in factors.items():
            for (power,), value in Poly(factor, variable).terms():
                shift = order - power
                total += value * ff(index + shift, order) * indexed(name, index, shift)
    return total
