"""Exact numbers with units: the factor of a unit to SI units, and the text and LaTeX of a measured number."""

import re
from functools import lru_cache
from typing import Any

from sympy import Expr, Integer, Rational, pi

from symrot.checker.units.conversion import UnitProduct, measured_text
from symrot.errors import InputError

__all__ = ["decimal", "factor_of", "unit_latex", "unit_of"]

_RECIPROCAL = re.compile(r"^1?\s*/\s*([^\W\d_]+)(?:\^?(\d+))?$")

_BRACKETS = str.maketrans("", "", "()")

_SIGNS = (
    ("⁻", "^-"),
    ("¹", "1"),
    ("²", "^2"),
    ("³", "^3"),
    ("^-^", "^-"),
    ("**", "^"),
    ("⋅", " "),
    ("·", " "),
    ("*", " "),
    ("kgm", "kg m"),
    ("Nms", "N m s"),
)


@lru_cache(maxsize=1024)
def unit_of(text: str) -> UnitProduct | None:
    """Return a unit such as ``kg m^2/s``, parsed from text, or None if the text is not a unit.

    Examples
    --------
    >>> unit_of("rpm").note
    '1 rpm = pi/30 rad/s'
    """
    plain = text.strip()
    for sign, instead in _SIGNS:
        plain = plain.replace(sign, instead)
    bracket = re.fullmatch(r"([^()]*)/\(([^()]*)\)", plain)
    if bracket:
        plain = f"{bracket[1]}/{'/'.join(bracket[2].split())}"
    reciprocal = _RECIPROCAL.match(plain)
    if reciprocal:
        plain = f"{reciprocal[1]}^-{reciprocal[2] or 1}"
    measured = measured_text(f"1 {plain} = 1 {plain}")  # one letter alone, without an equation, may be a quantity
    if measured is None or measured.text.translate(_BRACKETS) != "1*unit_1 = 1*unit_1":
        return None
    return measured.units["unit_1"]


def factor_of(unit: str) -> Expr:
    """Return the exact factor by which a number in ``unit`` is multiplied to get SI units; 1 for a pure number.

    Raise InputError if the text is not a unit.

    Examples
    --------
    >>> factor_of("mm"), factor_of("deg")
    (1/1000, pi/180)
    """
    if not unit:
        return Integer(1)
    product = unit_of(unit)
    if product is None:
        raise InputError(f"unit: expected a product of units such as 'kg m^2', got {unit!r}")
    return Rational(product.fraction.numerator, product.fraction.denominator) * pi**product.power_of_pi


def unit_latex(unit: str) -> str:
    """Return a unit as LaTeX, upright with superscripts for powers; an empty text for a pure number."""
    if unit == "deg":
        return r"^\circ"
    reciprocal = _RECIPROCAL.match(unit)
    if reciprocal:
        unit = f"{reciprocal[1]}^-{reciprocal[2] or 1}"
    upright = re.sub(r"[^\W\d_]+(/[^\W\d_]+)?", lambda match: rf"\mathrm{{{match[0]}}}", unit)
    raised = re.sub(r"\^(-?\d+)", r"^{\1}", upright)
    return r"\," + raised.replace(" ", r"\,") if unit else ""


def decimal(value: Any, digits: int = 4) -> str:
    """Return a number as text, rounded to ``digits`` significant digits.

    A whole number of a magnitude below 10^6 is not rounded. Any other number of a magnitude from 10^digits to 10^7 is
    rounded to a whole number, which has more digits. Magnitudes below 0.0001 and from 10^7 have an exponent, as in
    ``1.2e7``.

    Examples
    --------
    >>> decimal(Rational(1, 3)), decimal(Integer(120000)), decimal(Rational(1, 2))
    ('0.3333', '120000', '0.5')
    """
    if value.is_Integer and abs(value) < 10**6:
        return str(value)
    number = float(value.evalf(digits + 10))
    text = f"{number:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    return f"{mantissa}e{int(exponent)}" if not -4 <= int(exponent) < 7 else f"{number:.0f}"
