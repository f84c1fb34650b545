"""Closed-form real numbers in intervals of 50 digits, by mpmath's interval arithmetic."""

from typing import Any

import sympy
from mpmath import iv
from sympy import Expr, S, pi

__all__ = ["DIGITS", "enclosure", "surely_nonnegative_number"]

DIGITS = 50


def _asin(x: Any) -> Any:
    return iv.atan2(x, _root(1 - x * x))


def _acos(x: Any) -> Any:
    return iv.atan2(_root(1 - x * x), x)


def _root(x: Any) -> Any:
    if not x.a >= 0:
        raise ValueError("a square root is taken of numbers that are not negative")
    return iv.sqrt(x)


def _atan2(y: Any, x: Any) -> Any:
    if 0 in y and 0 in x:
        raise ValueError("atan2 has no value at the origin")
    return iv.atan2(y, x)


INTERVAL = {
    sympy.sin: iv.sin,
    sympy.cos: iv.cos,
    sympy.tan: lambda x: iv.sin(x) / iv.cos(x),
    sympy.cot: lambda x: iv.cos(x) / iv.sin(x),
    sympy.sec: lambda x: 1 / iv.cos(x),
    sympy.csc: lambda x: 1 / iv.sin(x),
    sympy.asin: _asin,
    sympy.acos: _acos,
    sympy.atan: lambda x: iv.atan2(x, iv.mpf(1)),
    sympy.atan2: _atan2,
    sympy.exp: iv.exp,
    sympy.log: iv.log,
    sympy.sinh: lambda x: (iv.exp(x) - iv.exp(-x)) / 2,
    sympy.cosh: lambda x: (iv.exp(x) + iv.exp(-x)) / 2,
    sympy.tanh: lambda x: 1 - 2 / (iv.exp(2 * x) + 1),
    sympy.asinh: lambda x: iv.log(x + iv.sqrt(x * x + 1)),
    sympy.acosh: lambda x: iv.log(x + _root(x - 1) * iv.sqrt(x + 1)),
    sympy.atanh: lambda x: (iv.log(1 + x) - iv.log(1 - x)) / 2,
    sympy.Abs: abs,
}
_NUMBERS = {pi: lambda: +iv.pi, S.Exp1: lambda: +iv.e}


def surely_nonnegative_number(number: Expr) -> bool:
    """Return whether a closed-form number is proven not to be negative."""
    if number.is_Rational:
        return bool(number >= 0)
    held = enclosure(number)
    return held is not None and bool(held.a >= 0)


def enclosure(number: Expr) -> Any:
    """Return a 50-digit interval that holds a closed-form real number, or None where it cannot tell."""
    iv.dps = DIGITS
    try:
        return _enclose(number)
    except (KeyError, ZeroDivisionError, ValueError, TypeError):  # an unknown function, a pole, a complex number
        return None


def _enclose(node: Expr) -> Any:
    if node.is_Rational:
        return iv.mpf(int(node.p)) / int(node.q)
    if node in _NUMBERS:
        return _NUMBERS[node]()
    if node.is_Add:
        return sum((_enclose(term) for term in node.args), iv.mpf(0))
    if node.is_Mul:
        total = iv.mpf(1)
        for factor in node.args:
            total = total * _enclose(factor)
        return total
    if node.is_Pow:
        return _enclose_power(_enclose(node.base), node.exp)
    value = INTERVAL[type(node)](*(_enclose(argument) for argument in node.args))
    if not (value.a > -iv.inf and value.b < iv.inf):
        raise ValueError(f"{node} has a pole in its interval")
    return value


def _enclose_power(base: Any, exponent: Expr) -> Any:
    if exponent.is_Rational and exponent.q <= 2:
        power = int(exponent.p)
        base = base if exponent.q == 1 else _root(base)
        if power < 0 and 0 in base:
            raise ZeroDivisionError
        return base**power
    if not base.a > 0:
        raise ValueError("a fractional power is taken of positive numbers here")
    return iv.exp(_enclose(exponent) * iv.log(base))
