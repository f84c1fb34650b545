"""Intervals of 50 digits that contain closed-form real numbers, or the value of a formula at a real point.

A value is returned only if the formula is proven to be a real number. Rational numbers stay exact fractions, so that
zero is distinguished from a small number. A function of a number beyond 2^1000 gets no interval.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import sympy
from mpmath import iv
from mpmath.libmp import to_rational
from sympy import Expr, S, pi

from symrot.exact.limits.operations import spend

__all__ = [
    "DIGITS",
    "INTERVAL",
    "Undefined",
    "arc_tangent",
    "as_interval",
    "enclosure",
    "fraction_of_end",
    "is_nonnegative_at",
]

DIGITS = 50

MOST_BITS = 1000
"""Arguments of functions, and exponents, must be at most 2^MOST_BITS in absolute value; else there is no interval."""

MOST_BITS_EXACT = 4000
"""Largest number of bits of the numerator or denominator of an exact fraction; a longer one becomes an interval."""

Value = Any  # Fraction or an interval of mpmath


class Undefined(ValueError):
    """The exception for a formula that is proven to have no real value at a point."""


def arc_tangent(y: Any, x: Any) -> Any:
    """Return an interval that contains atan2(y, x) for all numbers in the intervals ``y`` and ``x``, not both zero."""
    if x.b < 0 and y.a < 0 <= y.b:  # atan2 jumps at y = 0; for y.b = 0, mpmath returns an interval from pi to -pi
        return iv.mpf([-1, 1]) * iv.pi
    # mpmath rounds an end to four more bits and then to the precision, which may move it inward
    return iv.atan2(y, x) * (1 + iv.mpf(2) ** (1 - iv.prec) * iv.mpf([-1, 1]))


def _exp(x: Any) -> Any:
    # mpmath may leave out the last term of 1 + x + x^2/2 where the rest is a number of its precision
    return iv.exp(x) if x.a == x.b == 0 else iv.exp(x) * (1 + iv.mpf(2) ** (1 - iv.prec) * iv.mpf([-1, 1]))


def _asin(x: Any) -> Any:
    _refuse(x.a > 1 or x.b < -1)
    return arc_tangent(x, _root(1 - x * x))


def _acos(x: Any) -> Any:
    _refuse(x.a > 1 or x.b < -1)
    return arc_tangent(_root(1 - x * x), x)


def _refuse(outside: bool) -> None:
    if outside:
        raise Undefined


def _root(x: Any) -> Any:
    _refuse(x.b < 0)
    if not x.a >= 0:
        raise ValueError(f"expected a root of a number that is surely nonnegative, got one between {x.a} and {x.b}")
    return iv.sqrt(x)


def _log(x: Any) -> Any:
    _refuse(x.b <= 0)
    if not x.a > 0:
        raise ValueError("expected a positive number in a logarithm")
    # as in _exp: mpmath may leave out the last term
    return iv.log(x) if x.a == x.b == 1 else iv.log(x) * (1 + iv.mpf(2) ** (1 - iv.prec) * iv.mpf([-1, 1]))


def _atan2(y: Any, x: Any) -> Any:
    if 0 in y and 0 in x:
        raise ValueError("expected atan2(y, x) away from the origin, where it is undefined")
    return arc_tangent(y, x)


def _bounded(x: Any) -> Any:
    limit = iv.mpf(2) ** MOST_BITS
    if not (x.a >= -limit.a and x.b <= limit.a):
        raise ValueError(f"expected values below 2^{MOST_BITS} within a formula, got a larger one")
    return x


def _sign(x: Any) -> Any:
    if 0 in x:
        raise ValueError("expected a number of known sign, got one that may be zero")
    return iv.mpf(1 if x.a > 0 else -1)


def _over(above: Any, below: Any) -> Any:
    if 0 in below:
        raise ZeroDivisionError
    return above / below


INTERVAL = {
    sympy.sin: iv.sin,
    sympy.cos: iv.cos,
    sympy.tan: lambda x: _over(iv.sin(x), iv.cos(x)),
    sympy.cot: lambda x: _over(iv.cos(x), iv.sin(x)),
    sympy.sec: lambda x: _over(1, iv.cos(x)),
    sympy.csc: lambda x: _over(1, iv.sin(x)),
    sympy.asin: _asin,
    sympy.acos: _acos,
    sympy.atan: lambda x: arc_tangent(x, iv.mpf(1)),
    sympy.atan2: _atan2,
    sympy.exp: _exp,
    sympy.log: _log,
    sympy.sinh: lambda x: (_exp(x) - _exp(-x)) / 2,
    sympy.cosh: lambda x: (_exp(x) + _exp(-x)) / 2,
    sympy.tanh: lambda x: 1 - 2 / (_exp(2 * x) + 1),
    sympy.coth: lambda x: 1 + _over(2, _exp(2 * x) - 1),
    sympy.asinh: lambda x: _log(x + iv.sqrt(x * x + 1)),
    sympy.acosh: lambda x: _log(x + _root(x - 1) * iv.sqrt(x + 1)),
    sympy.atanh: lambda x: (_log(1 + x) - _log(1 - x)) / 2,
    sympy.Abs: abs,
    sympy.sign: _sign,
}
_NUMBERS = {pi: lambda: +iv.pi, S.Exp1: lambda: +iv.e}


def is_nonnegative_at(formula: Expr, values: Mapping[Expr, Any]) -> bool:
    """Return whether a formula is proven to be real and not negative at the point ``values`` (symbol -> value)."""
    held = enclosure(formula, values)
    return held is not None and bool(held.a >= 0)


def enclosure(formula: Expr, values: Mapping[Expr, Any] | None = None, digits: int = 0) -> Any:
    """Return a 50-digit interval that contains a closed-form real number, or a formula's value at a point, or None.

    Parameters
    ----------
    formula : Expr
        The formula to evaluate.
    values : mapping, optional
        From symbols and functions of time to their values: numbers of SymPy, fractions, or intervals of mpmath.
    digits : int
        The number of digits, if more than 50 are needed.

    Returns
    -------
    interval or None
        None if the formula is not proven to be real, if a function is unknown, or if too many digits would be needed.
        SymPy cancels terms such as ``log(x) - log(x)`` when it builds a formula; whether they are real is not checked.
    """
    iv.dps = max(DIGITS, digits)
    try:
        return as_interval(_value(formula, values or {}, {}))
    except (KeyError, ZeroDivisionError, ValueError, TypeError, OverflowError):  # unknown function, pole, not real
        return None


def fraction_of_end(end: Any) -> Fraction:
    """Return an end of an mpmath interval, ``interval.a`` or ``interval.b``, as an exact fraction."""
    return Fraction(*map(int, to_rational(end._mpi_[0])))


def as_interval(value: Value) -> Any:
    """Return a fraction as an interval that contains it; an interval is returned unchanged."""
    return iv.mpf(value.numerator) / value.denominator if isinstance(value, Fraction) else value


def _value(node: Expr, values: Mapping[Expr, Any], known: dict[Expr, Value]) -> Value:
    if node not in known:
        spend(20)
        value = _computed(node, values, known)
        if isinstance(value, Fraction):
            if max(value.numerator.bit_length(), value.denominator.bit_length()) > MOST_BITS_EXACT:
                value = as_interval(value)
        elif not (value.a > -iv.inf and value.b < iv.inf):
            raise ValueError(f"expected {node} to be finite on an interval, but it has a pole there")
        known[node] = value
    return known[node]


def _computed(node: Expr, values: Mapping[Expr, Any], known: dict[Expr, Value]) -> Value:
    if node.is_Rational:
        return Fraction(int(node.p), int(node.q))
    if node in values:
        value = values[node]
        return _value(value, {}, {}) if isinstance(value, Expr) else value
    if node in _NUMBERS:
        return _NUMBERS[node]()
    if node.is_Add or node.is_Mul:
        parts = [_value(part, values, known) for part in node.args]
        exact = all(isinstance(part, Fraction) for part in parts)
        parts = parts if exact else [as_interval(part) for part in parts]
        total = parts[0]
        for part in parts[1:]:
            total = total + part if node.is_Add else total * part
        return total
    if node.is_Pow:
        return _power(_value(node.base, values, known), node.exp, values, known)
    arguments = [as_interval(_value(argument, values, known)) for argument in node.args]
    return INTERVAL[type(node)](*map(_bounded, arguments))


def _power(base: Value, exponent: Expr, values: Mapping[Expr, Any], known: dict[Expr, Value]) -> Value:
    if exponent.is_Integer:
        return _whole_power(base, int(exponent))
    if isinstance(base, Fraction) and base == 0 and exponent.is_Rational and exponent.p > 0:
        return base
    held = as_interval(base)
    _refuse(held.b < 0)
    if exponent.is_Rational and exponent.q == 2:
        return _whole_power(_root(held), int(exponent.p))
    if not held.a > 0:
        raise ValueError("expected a positive number under a fractional power")
    return _exp(_bounded(as_interval(_value(exponent, values, known)) * _log(held)))


def _whole_power(base: Value, power: int) -> Value:
    if power < 0 and (0 in base if not isinstance(base, Fraction) else base == 0):
        raise ZeroDivisionError
    if isinstance(base, Fraction):
        size = max(base.numerator.bit_length(), base.denominator.bit_length())
        if size * abs(power) <= MOST_BITS_EXACT:
            return base**power
        base = as_interval(base)
    return base**power
