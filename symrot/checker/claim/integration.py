"""Exact definite integrals of polynomials times sines and cosines whose angles are linear in the variable."""

from functools import lru_cache

from sympy import Add, Expr, I, Integer, Mul, Symbol, cos, exp, factorial, sin

from symrot.errors import InputError

__all__ = ["definite_integral"]

LARGEST_DEGREE = 40
MOST_TERMS = 2000


@lru_cache(maxsize=64)
def definite_integral(integrand: Expr, variable: Symbol, lower: Expr, upper: Expr) -> tuple[Expr, tuple[Expr, ...]]:
    """Return the integral over an interval, and the coefficients of the variable that its value divides by.

    The integral of cos(k x), for example, divides by k, so that k must not be zero.

    Parameters
    ----------
    integrand : Expr
        A polynomial in the variable, and in sines and cosines of angles linear in it.
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
    """Return the integrand as a sum of exponentials and powers, which can be integrated term by term.

    Each sine and cosine whose argument contains ``variable``, also sin(2*x), is first replaced by complex exponentials:
    cos(u) by (e^(iu) + e^(-iu))/2. Then all products are multiplied out. Raises InputError if the degree is above
    LARGEST_DEGREE, or the sum has more than MOST_TERMS terms.
    """
    angles = [node for node in integrand.atoms(sin, cos) if node.has(variable)]
    exponentials = {}
    for node in angles:
        argument = node.args[0].expand()
        forward, backward = exp(I * argument), exp(-I * argument)
        exponentials[node] = (forward + backward) / 2 if node.func is cos else (forward - backward) / (2 * I)
    plain = integrand.xreplace(exponentials)
    if any(node.exp.is_Integer and node.exp > LARGEST_DEGREE for node in plain.atoms() if node.is_Pow):
        raise InputError(f"expected an integrand of degree at most {LARGEST_DEGREE}, got {integrand}")
    expanded = plain.expand()
    if len(Add.make_args(expanded)) > MOST_TERMS:
        raise InputError(f"expected an integrand of at most {MOST_TERMS} terms when it is multiplied out, got more")
    return expanded


def _antiderivative(term: Expr, variable: Symbol, divisors: list[Expr]) -> Expr:
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
                f"integrate takes polynomials in {variable} and sines and cosines of angles linear in it, got the "
                f"factor {factor}"
            )
    rate = exponent.expand().diff(variable)
    if rate == 0:
        return Mul(*constants) * exp(exponent) * variable ** (power + 1) / (power + 1)
    frequency = (rate / I).expand()
    if not frequency.is_nonzero:
        divisors.append(frequency)
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
    return Add(*(term for term in terms if not term.has(I)))


def _wave(exponent: Expr) -> Expr:
    angle = (exponent / I).expand()
    return cos(angle) + I * sin(angle)
