"""Exact definite integrals of polynomials times sines and cosines whose angles are linear in the variable."""

from functools import lru_cache
from math import comb, prod

from sympy import Add, Expr, I, Integer, Mul, Pow, Symbol, cos, exp, factorial, sin

from symrot.errors import InputError

__all__ = ["definite_integral"]

LARGEST_DEGREE = 40
MOST_TERMS = 2000
MOST_PRODUCTS = 20_000  # that are formed while an integrand is multiplied out


@lru_cache(maxsize=64)
def definite_integral(integrand: Expr, variable: Symbol, lower: Expr, upper: Expr) -> tuple[Expr, tuple[Expr, ...]]:
    """Return (integral, divisors) for an integral over an interval: the divisors that may be zero, as k for cos(k x).

    Parameters
    ----------
    integrand : Expr
        A polynomial in the variable, and in sines, cosines and exponentials of formulas linear in it.
    variable : Symbol
        A real symbol.
    lower, upper : Expr
        The limits, which must not contain the variable.

    Raises
    ------
    InputError
        If the integrand is of another kind, or too large.
    """
    real = _rewritten(integrand, variable)
    divisors: list[Expr] = []
    total = [_antiderivative(term, variable, divisors) for term in Add.make_args(real)]
    primitive = Add(*total)
    difference = _value(primitive, variable, upper) - _value(primitive, variable, lower)
    return difference.expand(), tuple(divisors)


def _rewritten(integrand: Expr, variable: Symbol) -> Expr:
    """Return an integrand as a sum of powers and complex exponentials: ``(e^(ix) + e^(-ix))/2`` for cos(x).

    Raise InputError for an integrand that would take too long to expand.
    """
    angles = [node for node in integrand.atoms(sin, cos) if node.has(variable)]
    # each term of such a sum has an elementary integral
    exponentials = {}
    for node in angles:
        argument = node.args[0].expand()
        forward, backward = exp(I * argument), exp(-I * argument)
        exponentials[node] = (forward + backward) / 2 if node.func is cos else (forward - backward) / (2 * I)
    plain = integrand.xreplace(exponentials)
    if any(node.exp.is_Integer and node.exp > LARGEST_DEGREE and node.base.has(variable) for node in plain.atoms(Pow)):
        raise InputError(f"expected an integrand of degree at most {LARGEST_DEGREE}, got {integrand}")
    if _products(plain) > MOST_PRODUCTS:
        raise InputError(f"expected an integrand of at most {MOST_TERMS} terms when it is multiplied out, got more")
    expanded = plain.expand()
    if len(Add.make_args(expanded)) > MOST_TERMS:
        raise InputError(f"expected an integrand of at most {MOST_TERMS} terms when it is multiplied out, got more")
    return expanded


def _products(formula: Expr) -> int:
    """Return how many products of terms :meth:`expand` forms of a formula, before equal ones are collected."""
    if formula.is_Add:
        return sum(map(_products, formula.args))
    if formula.is_Mul:
        return prod(map(_products, formula.args))
    if formula.is_Pow and formula.exp.is_Integer and formula.exp > 0:
        terms, power = _products(formula.base), int(formula.exp)
        return comb(power + terms - 1, terms - 1)
    return 1


def _antiderivative(term: Expr, variable: Symbol, divisors: list[Expr]) -> Expr:
    """Return an antiderivative of ``c*x^n*exp(i(k x + a))``, and append k to ``divisors`` if it may be zero."""
    constants, power, exponent = [], 0, Integer(0)
    for factor in Mul.make_args(term):
        base, degree = factor.as_base_exp()
        if not factor.has(variable):
            constants.append(factor)
        elif base == variable and degree.is_Integer and 0 < degree <= LARGEST_DEGREE:
            power += int(degree)
        elif isinstance(factor, exp) and factor.args[0].expand().diff(variable, 2) == 0:
            exponent += factor.args[0].expand()
        else:
            raise InputError(
                f"integrate takes polynomials in {variable}, and sines, cosines and exponentials of formulas linear in "
                f"it, got the factor {factor}"
            )
    rate = exponent.expand().diff(variable)
    if rate == 0:
        return Mul(*constants) * exp(exponent) * variable ** (power + 1) / (power + 1)
    # as a factor, not inside a sum: _value drops the imaginary terms, which are those with the factor i
    frequency = (rate / I).expand()
    divisor = rate if frequency.has(I) else frequency
    rate = I * frequency
    if not divisor.is_nonzero:
        divisors.append(divisor)
    parts = [
        (-1) ** k * factorial(power) / factorial(power - k) * variable ** (power - k) / rate ** (k + 1)
        for k in range(power + 1)
    ]
    return Mul(*constants) * exp(exponent) * Add(*parts)


def _value(primitive: Expr, variable: Symbol, limit: Expr) -> Expr:
    """Return the real value of an antiderivative at one limit of the integral."""
    value = primitive.subs(variable, limit)
    waves = {node: _wave(node.args[0]) for node in value.atoms(exp)}
    terms = Add.make_args(value.xreplace(waves).expand())
    imaginary = [term for term in terms if term.has(I)]
    if any((term / I).has(I) for term in imaginary):
        raise InputError(
            f"integrate takes no product of an exponential and a sine or cosine that both depend on {variable}"
        )
    return Add(*terms) - Add(*imaginary)


def _wave(exponent: Expr) -> Expr:
    angle = (exponent / I).expand()
    return cos(angle) + I * sin(angle)
