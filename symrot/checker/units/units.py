"""Units as products of powers: parsing, printing, and equations between units, solved over the rationals.

A dimension maps bases and symbols of unknown unit to exponents: {"[m]": 1, "[s]": -1} for m/s. An angle has none.
Scales are ignored: mm and m have the same dimension.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from symrot.errors import InputError

__all__ = [
    "NOTHING", "Dimension", "UnitSystem", "conventional_unit", "over", "raised", "read_unit", "times", "unit_text",
]  # fmt: skip

Dimension = Mapping[str, Fraction]
"""Base unit such as "[m]", or name of a symbol with an unknown unit -> its nonzero exponent in a product of units."""

NOTHING: Dimension = {}
BASES = ("kg", "m", "s", "A", "K", "mol", "cd")
DERIVED = {
    "": ("rad", "sr", "deg", "rev", "percent", "1"),
    "s^-1": ("Hz", "kHz", "MHz", "rpm"),
    "kg m s^-2": ("N", "kN", "MN", "lbf"),
    "kg m^2 s^-2": ("J", "kJ", "MJ", "GJ", "Wh", "kWh"),
    "kg m^2 s^-3": ("W", "kW", "MW", "GW", "hp"),
    "kg m^-1 s^-2": ("Pa", "kPa", "MPa", "GPa", "bar", "atm"),
    "kg": ("kg", "g", "mg", "slug", "lbm", "lb"),
    "m": ("m", "mm", "cm", "km", "um", "in", "ft", "yd", "mile"),
    "m s^-1": ("mph", "knot"),
    "s": ("s", "ms", "us", "min", "h", "d"),
    "A s": ("C",),
    "kg s^-2 A^-1": ("T",),
    "A": ("A",), "K": ("K",), "mol": ("mol",), "cd": ("cd",),
}  # fmt: skip
"""Dimension -> the units in which it may be written."""

_PIECE = re.compile(
    r"\s*(?P<divide>[/*·])?\s*(?P<name>[A-Za-z]+|1)(?:(?:\^|\*\*)\(?(?P<power>-?\d{1,9}(?:/\d{1,9})?)\)?)?"
)
_BRACKET = re.compile(r"\s*/\s*\((?P<inside>[^()]+)\)")

CONVENTIONAL_UNITS = (
    (r"t", "s"),
    (r"m|m_?[1-9]|m[ab]", "kg"),
    (r"g", "m/s^2"),
    (r"phi|theta|psi", "rad"),
    (r"d(phi|theta|psi)|(phi|theta|psi)(dot|d)|ph[d]|th[d]|ps[d]", "rad/s"),
    (r"dd(phi|theta|psi)|(phi|theta|psi)dd", "rad/s^2"),
    (r"omega(_?[xyz0-9])?|Omega|w_?[1-3]|w[xyz]", "rad/s"),
    (r"d(omega(_?[xyz1-3])?|w_?[1-3]|w[xyz])", "rad/s^2"),
    (r"I(_?[0-3xyz]|_?([1-3]{2}|[xyz]{2}))?", "kg m^2"),
    (r"tau(_?[xyz1-3])?", "N m"),
)
"""Pairs (pattern of names, unit): nearly every book uses these names for one quantity, in this unit.

All other units are inferred. A name of one letter, such as t, gets its unit only in a claim about physical quantities:
one with a stated unit, or with a longer name from the table whose unit is not rad.
"""


def times(first: Dimension, second: Dimension) -> Dimension:
    """Return the dimension of the product of two quantities."""
    powers = dict(first)
    for name, power in second.items():
        powers[name] = powers.get(name, Fraction(0)) + power
    return {name: power for name, power in powers.items() if power}


def raised(base: Dimension, exponent: Fraction) -> Dimension:
    """Return the dimension of a quantity raised to a power."""
    return {name: power * exponent for name, power in base.items() if exponent}


def over(first: Dimension, second: Dimension) -> Dimension:
    """Return the dimension of the quotient of two quantities."""
    return times(first, raised(second, Fraction(-1)))


def conventional_unit(name: str) -> str | None:
    """Return the unit that nearly all books use for a quantity of this name, or None if they differ."""
    return next((unit for pattern, unit in CONVENTIONAL_UNITS if re.fullmatch(pattern, name)), None)


def read_unit(text: str, where: str = "") -> Dimension:
    """Return the dimension of a unit such as ``kg m^2/s``, ``N m s/rad`` or ``m^(1/2)``.

    A slash divides by the next unit or bracket.

    Raises
    ------
    InputError
        For an unknown unit, with its name, and for empty text.
    """
    place = f"{where}: " if where else ""
    dimension: Dimension = NOTHING
    position = 0
    while position < len(text.rstrip()):
        bracket = _BRACKET.match(text, position)
        if bracket:
            dimension = over(dimension, read_unit(bracket["inside"], where))
            position = bracket.end()
            continue
        match = _PIECE.match(text, position)
        name = match["name"] if match else text[position:].strip()[:20]
        if match is None or name not in _KNOWN or (not position and match["divide"]):
            reason = "nothing before the slash" if name in _KNOWN else f"{name!r}, which is not a known unit"
            raise InputError(f"{place}expected a unit like kg m^2/s, N m or 1/s, got {text[:40]!r} with {reason}")
        if re.search("/0+$", match["power"] or ""):
            raise InputError(f"{place}expected a unit like m^(1/2), got {text[:40]!r} with a divisor 0 in a power")
        power = Fraction(match["power"] or 1)
        dimension = times(dimension, raised(_KNOWN[name], -power if match["divide"] == "/" else power))
        position = match.end()
    if not text.strip():
        raise InputError(f"{place}expected a unit like kg m^2/s, or 1, got empty text")
    return dimension


def unit_text(dimension: Dimension) -> str:
    """Return a dimension as text: ``kg m^2/s^2``; ``1`` for a pure number; ``[x]`` for the unknown unit of x."""
    order = [*(f"[{base}]" for base in BASES), *sorted(dimension)]
    names = [name for name in dict.fromkeys(order) if name in dimension]
    above = [_shown_power(name, dimension[name]) for name in names if dimension[name] > 0]
    below = [_shown_power(name, -dimension[name]) for name in names if dimension[name] < 0]
    divisor = "" if not below else f"/{below[0]}" if len(below) == 1 else f"/({' '.join(below)})"
    return (" ".join(above) or "1") + divisor


def _shown_power(name: str, power: Fraction) -> str:
    base = name[1:-1] if name[1:-1] in BASES else f"[{name}]"
    if power == 1:
        return base
    return f"{base}^{power}" if power.denominator == 1 else f"{base}^({power})"


def _plain(text: str) -> Dimension:
    """Return the dimension of a unit such as ``kg m^2 s^-2``, a product of base units with integer powers."""
    pairs = [(piece.partition("^")[0], piece.partition("^")[2] or "1") for piece in text.split()]
    return {f"[{base}]": Fraction(power) for base, power in pairs}


_KNOWN = {name: _plain(text) for text, names in DERIVED.items() for name in names}


@dataclass
class UnitSystem:
    """Equations between dimensions. ``solved`` maps each unknown unit that the equations determine to its value."""

    solved: dict[str, Dimension] = field(default_factory=dict)

    def reduced(self, dimension: Dimension) -> Dimension:
        """Return a dimension in which unknown units are replaced by the values that the equations give them."""
        result: Dimension = NOTHING
        for name, power in dimension.items():
            result = times(result, raised(self.solved.get(name, {name: Fraction(1)}), power))
        return result

    def equate(self, first: Dimension, second: Dimension) -> bool:
        """Add the equation that two dimensions are equal, and return True.

        If the equation contradicts earlier ones, add nothing and return False.
        """
        quotient = self.reduced(over(first, second))
        unknown = [name for name in quotient if not name.startswith("[")]
        if not unknown:
            return not quotient
        name = unknown[-1]
        rest = {other: power for other, power in quotient.items() if other != name}
        value = raised(rest, -1 / quotient[name])
        for other, dimension in self.solved.items():
            if name in dimension:
                power = dimension[name]
                without = {n: p for n, p in dimension.items() if n != name}
                self.solved[other] = times(without, raised(value, power))
        self.solved[name] = value
        return True
