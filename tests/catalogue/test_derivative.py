"""Derivatives have the value and the form of SymPy's; antiderivatives are proven, or refused in one sentence."""

import pytest
from sympy import Function, Rational, cos, exp, log, sin, sqrt, srepr

from symrot.catalogue.tools.derivative import derivative
from symrot.catalogue.tools.integral import antiderivative
from symrot.proof.derivation import ProofError
from symrot.symbols import a, phi, q0, t, theta, x, y

FORMULAS = (
    5 + 0 * x, y, x, x**y, y**x, x * y / (x + y) ** 2, 3 * (x + y) * sin(x * theta) * cos(phi), sqrt(x**2 + q0**2) / x,
    exp(-a * x**2) * log(x) ** Rational(1, 3), (x - y) * (x + sin(x)) ** (x - 1), Function("f")(x) * x, x * (y + sin(x) ** 2 + cos(x) ** 2),
)  # fmt: skip


@pytest.mark.parametrize("formula", FORMULAS, ids=str)
def test_a_derivative_has_the_form_that_sympy_gives_it(formula):
    for variable in (x, y, t):
        assert srepr(derivative(formula, variable)) == srepr(formula.diff(variable))


@pytest.mark.parametrize("integrand", [1 / x, x * cos(x), 1 / cos(x)], ids=str)
def test_an_integrand_that_is_no_polynomial_is_refused(integrand):
    with pytest.raises(ProofError, match="polynomial"):
        antiderivative(integrand, x)
