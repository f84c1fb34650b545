"""Definite integrals of claims against quadrature, with letters in the frequencies."""

import mpmath
import pytest
from sympy import Integer, Rational, cos, sin, symbols

import symrot
from symrot.checker.claim.integration import definite_integral
from symrot.errors import InputError

x, a, b, c = symbols("x a b c", real=True)
VALUES = {a: Rational(3, 2), b: Rational(7, 3), c: Rational(2, 5)}


@pytest.mark.parametrize("integrand", [
    cos(a*x)*cos(b*x), sin(a*x)*cos(b*x), sin(a*x)*sin(b*x), cos(a*x)**2, cos(a*x)*cos(b*x)*cos(c*x), cos(a*x + b)*cos(c*x),
    x*cos(a*x)*cos(b*x), x**2*sin(a*x + c)*sin(x), cos(2*x)*cos(3*x), cos(x)*cos(b*x),
], ids=str)  # fmt: skip
def test_an_integral_has_the_value_of_quadrature(integrand):
    """Products of waves with letters for both frequencies had the integral zero."""
    value, _ = definite_integral(integrand, x, Integer(-1), Integer(2))
    own = integrand.xreplace(VALUES)
    expected = mpmath.quad(lambda point: mpmath.mpf(own.subs(x, point).evalf(20)), [-1, 2])
    assert abs(mpmath.mpf(value.xreplace(VALUES).evalf(20)) - expected) < 1e-12


@pytest.mark.parametrize(("claim", "verdict"), [
    ("∫_0^(2π) cos(m x) cos(n x) dx = 0", "false"), ("∫_0^(2π) cos(2x) cos(3x) dx = 0", "true"),
    ("∫_0^1 exp(k x) dx = (exp(k) - 1)/k", "true"), ("∫_0^1 exp(k x) dx = (exp(k) + 1)/k", "false"),
    ("∫_0^L cos(a x) cos(b x) dx = sin((a + b) L)/(2 (a + b)) + sin((a - b) L)/(2 (a - b))", "true"),
])  # fmt: skip
def test_waves_and_exponentials_are_integrated(claim, verdict):
    assert symrot.check(claim, repair=False).verdict == verdict


@pytest.mark.parametrize("integrand", [(1 + x) ** 100_000, (1 + x) ** 41, (a + b + c + x) ** 40 * (a + x) ** 40, x**50])
def test_an_integrand_that_takes_too_long_to_multiply_out_is_refused(integrand):
    with pytest.raises(InputError, match="expected an integrand of"):
        definite_integral(integrand, x, Integer(0), Integer(1))
