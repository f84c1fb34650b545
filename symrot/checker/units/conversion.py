"""The factors from units to SI units, exact, and the numbers with units in a text such as ``1500 rpm = 157.08 rad/s``.

A text has units if it consists of numbers with units, and perhaps of one name for the result. In ``T = 2 m g`` the
letters are quantities: a letter such as m is read as a unit only if the text has a unit with several letters, or no
other names.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from symrot.checker.claim.tree import Node, number, product
from symrot.checker.units.units import NOTHING, Dimension, raised, read_unit, times, unit_text

__all__ = ["FACTORS", "Measured", "UnitProduct", "measured_text"]

DEGREE = "deg"
FACTORS: dict[str, tuple[Fraction, int]] = {
    **dict.fromkeys(("kg", "m", "s", "rad", "sr", "N", "J", "W", "Pa", "Hz", "A", "K"), (Fraction(1), 0)),
    DEGREE: (Fraction(1, 180), 1), "rev": (Fraction(2), 1), "rpm": (Fraction(1, 30), 1),
    "g": (Fraction(1, 1000), 0), "mg": (Fraction(1, 10**6), 0),
    "lbm": (Fraction("0.45359237"), 0), "slug": (Fraction("0.45359237") * Fraction("9.80665") / Fraction("0.3048"), 0),
    "mm": (Fraction(1, 1000), 0), "cm": (Fraction(1, 100), 0), "km": (Fraction(1000), 0), "um": (Fraction(1, 10**6), 0),
    "in": (Fraction("0.0254"), 0), "ft": (Fraction("0.3048"), 0),
    "ms": (Fraction(1, 1000), 0), "us": (Fraction(1, 10**6), 0), "min": (Fraction(60), 0), "h": (Fraction(3600), 0),
    "d": (Fraction(86400), 0),
    "kN": (Fraction(1000), 0), "lbf": (Fraction("0.45359237") * Fraction("9.80665"), 0),
    "kJ": (Fraction(1000), 0), "kW": (Fraction(1000), 0), "kPa": (Fraction(1000), 0), "MPa": (Fraction(10**6), 0),
}  # fmt: skip
"""Unit -> its factor to SI units, as a fraction and a power of pi; a hertz is one per second, not one turn."""

ALIASES = {"lb": "lbm", "sec": "s", "degrees": DEGREE, "degree": DEGREE, "Nm": "N m", "μm": "um"}

_UNIT = "|".join(sorted([*FACTORS, *ALIASES], key=lambda name: (-len(name), name)))
_POWER = r"(?:(?:\^|\*\*)\(?-?\d+\)?|[²³]|⁻[¹²³])?"
_ONE = rf"(?:{_UNIT})(?![\w(']){_POWER}"
_NUMBER = r"(?<![\w.])\d+(?:\.\d*)?(?:[eE][+-]?\d+)?"
_MEASURED = re.compile(rf"({_NUMBER}|\bpi\b|π)([ *·⋅]*)({_ONE}(?:\s*[/*·⋅ ]\s*{_ONE})*)")
_PIECE = re.compile(rf"(?P<sign>[/*·⋅ ]*)(?P<unit>{_UNIT})(?![\w('])(?P<power>{_POWER})")
_LATEX = (
    (r"\\(?:SI|qty)\{([^{}]*)\}\{([^{}]*)\}", r"\1 \2"), (r"\\(?:mathrm|text|operatorname|rm)\s*\{([^{}]*)\}", r" \1 "),
    (r"\^\{?\\circ\}?|\\degree|\\si\{\\degree\}", "°"), (r"\\[,;: !]|~|\\quad", " "), (r"\\(?:cdot|times)\b", "*"),
    (r"\\approx\b", "="), (r"\\(?:left|right)\b", ""), (r"\^\{(-?\d+)\}", r"^\1"), (r"\\pi\b", " pi "),
    (r"\\d?t?frac\{([^{}]*)\}\{([^{}]*)\}", r"(\1)/(\2)"), (r"\$", ""),
)  # fmt: skip
"""LaTeX of numbers with units -> the same in plain text."""

_SUPERSCRIPTS = {"²": 2, "³": 3, "⁻¹": -1, "⁻²": -2, "⁻³": -3}
_OTHER_NAME = re.compile(r"(?<![\w.])[^\W\d_]\w*")
_FUNCTIONS = ("sqrt", "sin", "cos", "tan", "pi", "π")
_PLAUSIBLE = ("m", "s", "N", "J", "W", "A", "K", "h", "d", "m/s", "m/s^2", "N m", "N s", "N m s", "1/s", "J s", "m^2")


LARGEST_IN_NOTE = 10**6


@dataclass(frozen=True)
class UnitProduct:
    """A product of units: its text, dimension, and exact factor to SI units."""

    text: str
    dimension: Dimension
    fraction: Fraction
    power_of_pi: int

    @property
    def note(self) -> str:
        """The factor to SI units as an equation, or an empty text for an SI unit and for a factor that is long."""
        if (self.fraction == 1 and not self.power_of_pi) or max(self.fraction.as_integer_ratio()) > LARGEST_IN_NOTE:
            return ""
        dimension = unit_text(self.dimension)
        unit = {"1": "rad", "1/s": "rad/s", "1/s^2": "rad/s^2"}.get(dimension, dimension)
        above, below = self.fraction.as_integer_ratio()
        pi = {0: "", 1: "pi", 2: "pi^2"}.get(self.power_of_pi, f"pi^({self.power_of_pi})")
        factor = pi if pi and above == 1 else f"{above}*{pi}" if pi else f"{above}"
        return f"1 {self.text} = {factor}{f'/{below}' if below != 1 else ''} {unit}"

    @property
    def factor(self) -> Node:
        """The factor to SI units as a tree."""
        pi = Node("power", None, (Node("name", "pi"), number(self.power_of_pi)))
        return product([number(self.fraction), *([pi] if self.power_of_pi else [])])


@dataclass(frozen=True)
class Measured:
    """A text whose numbers have units: the text with a name for each product of units, and these products.

    ``is_sure`` says that these certainly are units: one of them has several letters, or the text has no other name.
    """

    source: str
    text: str
    units: dict[str, UnitProduct] = field(default_factory=dict)
    is_sure: bool = True

    def restored(self, text: str) -> str:
        """Return a text about the claim with the units in place of their names."""
        return re.sub(r"\*?(unit_\d+)", lambda match: f" {self.units[match[1]].text}", text)


def measured_text(source: str) -> Measured | None:
    """Return a text with names for its units, or None for a text that has no numbers with units.

    Examples
    --------
    >>> measured = measured_text("1500 rpm = 157.08 rad/s")
    >>> measured.text, [unit.text for unit in measured.units.values()]
    ('1500*unit_1 = 157.08*unit_2', ['rpm', 'rad/s'])
    >>> measured_text("T = 2 m g") is None
    True
    """
    plain = source
    for pattern, instead in _LATEX:
        plain = re.sub(pattern, instead, plain)
    if "\\" in plain or "{" in plain:
        return None
    plain = plain.replace("−", "-")
    units: dict[str, UnitProduct] = {}
    stars = [match[2] for match in _MEASURED.finditer(plain) if "*" in match[2]]

    def named(match: re.Match[str]) -> str:
        unit = _unit_product(match[3])
        name = next((name for name, other in units.items() if other == unit), f"unit_{len(units) + 1}")
        units[name] = unit
        return f"{match[1]}*{name}"

    text = _MEASURED.sub(named, plain)
    has_long = any(len(name) > 1 for unit in units.values() for name in re.findall(r"[^\W\d_]+", unit.text))
    names = [name for name in _OTHER_NAME.findall(text) if name not in _FUNCTIONS and name not in units]
    if not units or (stars and not has_long) or not _only_units(text, names, units, has_long):
        return None
    return Measured(plain, text, units, has_long or not names)


def _only_units(text: str, names: Sequence[str], units: Mapping[str, UnitProduct], has_long: bool) -> bool:
    """Return whether a text with units has no other names than one for the result, on the left."""
    left = re.match(r"\s*([^\W\d_]\w*)\s*==?", text)
    if names and (left is None or names != [left[1]]):
        return False
    if names:
        return has_long or all(unit.text in _PLAUSIBLE for unit in units.values())
    sides = re.split(r"==?", text)
    return has_long or (len(sides) > 1 and all("unit_" in side for side in sides))


def _pieces(text: str) -> Iterator[tuple[str, int]]:
    """Yield the units of a product with their powers."""
    for match in _PIECE.finditer(text):
        mark = match["power"]
        power = _SUPERSCRIPTS[mark] if mark in _SUPERSCRIPTS else int(re.sub(r"[\^*()]", "", mark) or 1)
        for name in ALIASES.get(match["unit"], match["unit"]).split():
            yield name, -power if "/" in match["sign"] else power


def _unit_product(text: str) -> UnitProduct:
    dimension: Dimension = NOTHING
    fraction, power_of_pi = Fraction(1), 0
    for name, power in _pieces(text):
        factor, pi = FACTORS[name]
        dimension = times(dimension, raised(read_unit(name), Fraction(power)))
        fraction *= factor**power
        power_of_pi += pi * power
    return UnitProduct(" ".join(text.split()), dimension, fraction, power_of_pi)
