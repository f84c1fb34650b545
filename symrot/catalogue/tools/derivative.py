"""Derivatives with respect to one symbol, in the form that SymPy gives them, in less time."""

from functools import lru_cache

from sympy import Add, Expr, Mul, Pow, S, Symbol, log

__all__ = ["derivative"]


# SymPy asks of the derivative of each term and factor whether the signs of its symbols make it zero
@lru_cache(maxsize=50_000)
def derivative(expression: Expr, variable: Symbol) -> Expr:
    """Return the same derivative as ``expression.diff(variable)``, but faster and cached."""
    parts = expression.args
    if expression == variable:
        return S.One
    if not parts:
        return S.Zero
    if type(expression) is Add:
        return Add(*(derivative(term, variable) for term in parts))
    if type(expression) is Mul:
        inner = [derivative(factor, variable) for factor in parts]
        return Add(*(Mul(*parts[:n], part, *parts[n + 1 :]) for n, part in enumerate(inner) if part != 0))
    if type(expression) is Pow:
        of_base, of_exponent = (derivative(part, variable) for part in parts)
        if of_base == of_exponent == 0:
            return S.Zero
        base, exponent = parts
        from_exponent = of_exponent * log(base) if of_exponent != 0 else S.Zero
        return expression * (from_exponent + of_base * exponent / base)
    return expression.diff(variable)
