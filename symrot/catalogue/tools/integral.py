"""Iterated integrals, computed from antiderivatives that are proven by differentiation."""

from dataclasses import dataclass
from functools import cache
from typing import Any

from sympy import Expr, I, Integer, Poly, PolynomialError, Rational, Symbol, cos, expand, im, re, sin

from symrot.exact import is_zero
from symrot.proof.derivation import ProofError

__all__ = ["Stage", "antiderivative", "iterated"]


@dataclass(frozen=True)
class Stage:
    """One integration of an iterated integral: variable, antiderivative, limits, and the value of the integral."""

    variable: Symbol
    antiderivative: Expr
    lower: Expr
    upper: Expr
    value: Expr


@cache
def _waves(cosines: int, sines: int) -> tuple[tuple[int, Expr, Expr], ...]:
    """Return the terms ``a cos(k x) + b sin(k x)`` whose sum is ``cos(x)^cosines sin(x)^sines``, each as (k, a, b)."""
    spectrum: dict[int, Expr] = {0: Integer(1)}
    for up, down, times in ((Rational(1, 2), Rational(1, 2), cosines), (-I / 2, I / 2, sines)):
        for _ in range(times):
            shifted: dict[int, Expr] = {}
            for k, c in spectrum.items():
                for place, factor in ((k + 1, up), (k - 1, down)):
                    shifted[place] = shifted.get(place, Integer(0)) + expand(c * factor)
            spectrum = shifted
    waves = [(0, spectrum.get(0, Integer(0)), Integer(0))]
    waves += [(k, 2 * re(c), -2 * im(c)) for k, c in sorted(spectrum.items()) if k > 0]
    return tuple(waves)


@cache
def antiderivative(integrand: Expr, variable: Symbol) -> Expr:
    """Return an antiderivative of a polynomial in the variable, or in the cosine and sine of the variable.

    Its derivative is proven to be the integrand.

    Raises
    ------
    ProofError
        If the integrand is not such a polynomial.
    """
    total: Expr = Integer(0)
    try:
        if integrand.has(cos(variable), sin(variable)):
            for (cosines, sines), coefficient in Poly(integrand, cos(variable), sin(variable)).terms():
                for k, a, b in _waves(cosines, sines):
                    wave = a * variable if k == 0 else a * sin(k * variable) / k - b * cos(k * variable) / k
                    total += coefficient * wave
        else:
            for (power,), coefficient in Poly(integrand, variable).terms():
                total += coefficient * variable ** (power + 1) / (power + 1)
        proven = is_zero(total.diff(variable) - integrand)
    except PolynomialError:
        proven = False
    if not proven:
        raise ProofError(
            f"expected an integrand that is a polynomial in {variable}, or in its sine and cosine, got {integrand}"
        )
    return total


@cache
def iterated(integrand: Any, limits: tuple[tuple[Symbol, Expr, Expr], ...]) -> tuple[Stage, ...]:
    """Return the integrations, one by one, of an iterated integral of ``integrand``.

    ``limits`` are (variable, lower, upper), innermost first.
    """
    stages = []
    for variable, lower, upper in limits:
        primitive = antiderivative(expand(integrand), variable)
        integrand = primitive.subs(variable, upper) - primitive.subs(variable, lower)
        stages.append(Stage(variable, primitive, lower, upper, integrand))
    return tuple(stages)
