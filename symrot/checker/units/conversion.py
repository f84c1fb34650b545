"""Exact factors from units to SI units, and texts with numbers and units such as ``1500 rpm = 157.08 rad/s``.

In ``T = 2 m g`` the letters are quantities: a letter such as m is read as a unit only if the text has a unit with
several letters, or no other names.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from symrot.checker.claim.tree import Node, number, product
from symrot.checker.units.units import NOTHING, Dimension, raised, read_unit, times, unit_text
from symrot.errors import InputError

__all__ = [
    "FACTORS", "ONE_PER_SECOND", "STANDARD_GRAVITY", "Measured", "UnitProduct", "measured_text", "numbers_of_latex",
    "numeric_end", "unit_beside_letters",
]  # fmt: skip

DEGREE = "deg"
INCH, FOOT, MILE = Fraction("0.0254"), Fraction("0.3048"), Fraction("1609.344")
POUND, GRAVITY = Fraction("0.45359237"), Fraction("9.80665")
FACTORS: dict[str, tuple[Fraction, int]] = {
    **dict.fromkeys(("kg", "m", "s", "rad", "sr", "N", "J", "W", "Pa", "Hz", "A", "K"), (Fraction(1), 0)),
    "percent": (Fraction(1, 100), 0),
    DEGREE: (Fraction(1, 180), 1), "rev": (Fraction(2), 1), "rpm": (Fraction(1, 30), 1),
    "kHz": (Fraction(1000), 0), "MHz": (Fraction(10**6), 0),
    "g": (Fraction(1, 1000), 0), "mg": (Fraction(1, 10**6), 0), "lbm": (POUND, 0), "lb": (POUND, 0),
    "slug": (POUND * GRAVITY / FOOT, 0),
    "mm": (Fraction(1, 1000), 0), "cm": (Fraction(1, 100), 0), "km": (Fraction(1000), 0), "um": (Fraction(1, 10**6), 0),
    "in": (INCH, 0), "ft": (FOOT, 0), "yd": (3 * FOOT, 0), "mile": (MILE, 0),
    "ms": (Fraction(1, 1000), 0), "us": (Fraction(1, 10**6), 0), "min": (Fraction(60), 0), "h": (Fraction(3600), 0),
    "d": (Fraction(86400), 0), "mph": (MILE / 3600, 0), "knot": (Fraction(1852, 3600), 0),
    "kN": (Fraction(1000), 0), "MN": (Fraction(10**6), 0), "lbf": (POUND * GRAVITY, 0),
    "kJ": (Fraction(1000), 0), "MJ": (Fraction(10**6), 0), "GJ": (Fraction(10**9), 0),
    "Wh": (Fraction(3600), 0), "kWh": (Fraction(3600000), 0),
    "kW": (Fraction(1000), 0), "MW": (Fraction(10**6), 0), "GW": (Fraction(10**9), 0),
    "hp": (550 * FOOT * POUND * GRAVITY, 0),
    "kPa": (Fraction(1000), 0), "MPa": (Fraction(10**6), 0), "GPa": (Fraction(10**9), 0),
    "bar": (Fraction(10**5), 0), "atm": (Fraction(101325), 0),
}  # fmt: skip
"""Unit -> its factor to SI units, (fraction, exponent of pi); a hertz is one per second."""

OTHER_MEANINGS: dict[str, tuple[Fraction, int, str]] = {
    "Hz": (Fraction(2), 1, "1/s"), "g": (GRAVITY, 0, "m/s^2"), "lb": (POUND * GRAVITY, 0, "N"),
}  # fmt: skip
"""Unit -> another meaning of its text: (fraction and exponent of pi in the factor to the SI unit, SI unit).

They are a hertz as one rotation per second, g as the standard gravity, and lb as a force.
"""

ONE_PER_SECOND = "with the hertz as one per second, and the radian as 1"
STANDARD_GRAVITY = "with g for the standard gravity, 9.80665 m/s^2"

ANGULAR = frozenset({"rad", "rev", "rpm", DEGREE})
"""Units with an angle in them; in a text with one of them, a hertz is usually one rotation per second."""

ALIASES = {
    "sec": "s", "degrees": DEGREE, "degree": DEGREE, "°": DEGREE, "%": "percent", "Nm": "N m", "μm": "um",
    "miles": "mile", "knots": "knot",
    **dict.fromkeys(("secs", "second", "seconds"), "s"), **dict.fromkeys(("minute", "minutes"), "min"),
    **dict.fromkeys(("hr", "hrs", "hour", "hours"), "h"), **dict.fromkeys(("day", "days"), "d"),
    **dict.fromkeys(("revs", "revolution", "revolutions"), "rev"), **dict.fromkeys(("radian", "radians"), "rad"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
}  # fmt: skip
PRODUCTS = frozenset({"mg", "ms", "hp"})
"""Units that may as well be a product of two quantities: mg is a milligram, or the weight m*g."""

CERTAIN = frozenset({
    "kg", "mm", "cm", "km", "rad", "rpm", "kN", "kJ", "kW", "kPa", "MPa", "Hz", "lbf", "lbm", "slug", "MJ", "kWh",
    "MW", "mph",
})  # fmt: skip
"""Units whose text is never the name of a quantity; after a number they are units even in a formula with letters."""

_UNIT = "|".join(sorted([*FACTORS, *ALIASES], key=lambda name: (-len(name), name)))
_POWER = r"(?:(?:\^|\*\*)(?:\(-?\d{1,2}\)|-?\d{1,2}(?!\d))|[²³]|⁻[¹²³]|(?!\s*(?:\^|\*\*)))"
"""Pattern of the power of a unit, of at most two digits; a name with another power, such as m^x, is not a unit."""

_NO_LETTER = r"(?!(?![²³⁻¹])\w|[('])"
_ONE = rf"(?:{_UNIT}){_NO_LETTER}{_POWER}"
_NUMBER = r"\d+(?:\.\d*)?(?:[eE][+-]?\d+)?"
_FRACTION = rf"{_NUMBER}\s*/\s*{_NUMBER}"
_VALUE = (
    rf"(?:{_NUMBER}\s*[*·⋅×]\s*)?{_NUMBER}\s*(?:(?:\^|\*\*)\s*(?:\([+-]?\d+\)|[+-]?\d+)|⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
    rf"|(?:{_NUMBER}\s*[*·⋅]?\s*)?(?:pi\b|π)(?:\s*/\s*{_NUMBER})?|{_FRACTION}|{_NUMBER}|(?<=\))"
)
"""Pattern of a value before a unit: a power such as 3*10^8, a multiple of pi, a fraction or a decimal number.

After a closing bracket the pattern matches an empty text, since the value is in the brackets, as in ``(1 + 2) kg``.
"""

_MEASURED = re.compile(rf"(?<![\w.^])(?<!\*\*)({_VALUE})(\s*/\s*|[ *·⋅]*)({_ONE}(?:\s*[/*·⋅ ]\s*{_ONE})*)")
_PIECE = re.compile(rf"(?P<sign>[/*·⋅ ]*)(?P<unit>{_UNIT}){_NO_LETTER}(?P<power>{_POWER})")
_LATEX = (
    (r"\\(?:SI|qty)\{([^{}]*)\}\{([^{}]*)\}", r"\1 \2"), (r"\\(?:mathrm|text|operatorname|rm)\s*\{([^{}]*)\}", r" \1 "),
    (r"\^\{?\\circ\}?|\\degree|\\si\{\\degree\}", "°"), (r"\\[,;: !]|~|\\quad", " "),
    (r"\\(?:cdot|times)(?![A-Za-z])", "*"), (r"\\approx(?![A-Za-z])", "="), (r"\\%", "%"),
    (r"\\(theta|phi|psi|alpha|beta|gamma|delta|omega|Omega|Theta|Phi)(?![A-Za-z])", r" \1 "),
    (r"\\(?:left|right)(?![A-Za-z])", ""), (r"\^\{(-?\d+)\}", r"^\1"), (r"\\pi(?![A-Za-z])", " pi "),
    (r"\\(sin|cos|tan)\s*\^\{?-1\}?", r" arc\1 "), (r"\\(a?r?c?(?:sin|cos|tan))(?![A-Za-z])", r" \1 "),
    (r"\\d?t?frac\{([^{}]*)\}\{([^{}]*)\}", r"(\1)/(\2)"), (r"\\sqrt\{([^{}]*)\}", r"sqrt(\1)"), (r"\$", ""),
)  # fmt: skip
"""Pairs (pattern of LaTeX, plain text) for numbers with units."""

_COMMON_FRACTIONS = {
    "½": "0.5", "¼": "0.25", "¾": "0.75", "⅕": "0.2", "⅖": "0.4", "⅛": "0.125", "⅓": "(1/3)", "⅔": "(2/3)",
}  # fmt: skip
_TEMPERATURE = re.compile(r"\d\s*(°\s*[CF])(?!\w)")
_SUPERSCRIPTS = {"²": 2, "³": 3, "⁻¹": -1, "⁻²": -2, "⁻³": -3}
_OTHER_NAME = re.compile(r"(?<![\w.])[^\W\d_]\w*")
_FUNCTIONS = (
    "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "arcsin", "arccos", "arctan", "exp", "abs", "pi", "π",
)  # fmt: skip
_PLAUSIBLE = (
    "m", "s", "N", "J", "W", "A", "K", "h", "d", "m/s", "m/s^2", "N m", "N s", "N m s", "1/s", "J s", "m^2", "m^3",
    "s^2", "m^2/s^2", "1/s^2", "s^-1", "s^-2", "m s^-1", "m s^-2", "N/m", "J/s",
)  # fmt: skip


LARGEST_IN_NOTE = 10**6


@dataclass(frozen=True)
class UnitProduct:
    """A product of units such as ``kg m^2``: its text, its dimension, and its exact factor to SI units."""

    text: str
    dimension: Dimension
    fraction: Fraction
    power_of_pi: int

    @property
    def note(self) -> str:
        """A note on the factor to SI units, such as "1 rpm = pi/30 rad/s"; empty for SI units and for long factors."""
        if (self.fraction == 1 and not self.power_of_pi) or max(self.fraction.as_integer_ratio()) > LARGEST_IN_NOTE:
            return ""
        dimension = unit_text(self.dimension)
        numerator = "rad" if self._is_angle() else "1"
        unit = "" if dimension == numerator == "1" else re.sub(r"^1(?!\w)", numerator, dimension)
        above, below = self.fraction.as_integer_ratio()
        pi = {0: "", 1: "pi", 2: "pi^2"}.get(self.power_of_pi, f"pi^({self.power_of_pi})")
        factor = pi if pi and above == 1 else f"{above}*{pi}" if pi else f"{above}"
        return f"1 {self.text} = {factor}{f'/{below}' if below != 1 else ''} {unit}".rstrip()

    def _is_angle(self) -> bool:
        """Return whether the first unit contains an angle and has the power 1, and no other unit contains an angle.

        This holds for deg, deg/s and rpm.
        """
        first, *others = _PIECE.finditer(self.text)
        angular = [ALIASES.get(piece["unit"], piece["unit"]) in ANGULAR for piece in (first, *others)]
        return angular[0] and not first["power"] and not any(angular[1:])

    @property
    def factor(self) -> Node:
        """The exact factor from this product of units to SI units as a tree: ``1/1000`` for g."""
        pi = Node("power", None, (Node("name", "pi"), number(self.power_of_pi)))
        return product([number(self.fraction), *([pi] if self.power_of_pi else [])])


@dataclass(frozen=True)
class Measured:
    """A text with a name such as ``unit_1`` in place of each unit or product of units: ``2*unit_1`` for ``2 kg``."""

    source: str
    text: str
    units: dict[str, UnitProduct] = field(default_factory=dict)
    is_sure: bool = True  # certainly units: one of them has several letters, or the text has no other name
    others: tuple[tuple[str, "Measured"], ...] = ()  # other interpretations, each with words on the difference

    def restored(self, text: str) -> str:
        """Return ``text`` with units in place of their names: ``2 kg`` for ``2*unit_1``."""
        return re.sub(
            r"(\w)?\*?(unit_\d+)", lambda match: f"{match[1] or ''} {self.units[match[2]].text}".lstrip(), text
        )


@dataclass(frozen=True)
class _Interpretation:
    """One way to read the units in a text where several are possible."""

    meanings: frozenset[str] = frozenset()  # the units that have their less usual meaning
    by_whole: bool = True  # whether ``a/2 m`` divides by ``2 m``


def measured_text(source: str) -> Measured | None:
    """Return a text with a name such as unit_1 in place of each unit or product of units.

    Return None if the text has no units, if it has names besides units (one name as the left side is allowed), or if
    its one-letter units are probably quantities, such as m and g in ``T = 2 m g``. Return None, too, if all units are
    degree signs inside formulas, as in ``sin(30°) = 1/2``, and if the text has LaTeX commands without a replacement in
    plain signs.

    Raises
    ------
    InputError
        For a temperature in degrees Celsius or Fahrenheit.

    Examples
    --------
    >>> measured = measured_text("1500 rpm = 157.08 rad/s")
    >>> measured.text, [unit.text for unit in measured.units.values()]
    ('(1500*unit_1) = (157.08*unit_2)', ['rpm', 'rad/s'])
    >>> measured_text("T = 2 m g") is None
    True
    """
    plain = _plain(source)
    if plain is None:
        return None
    if match := _TEMPERATURE.search(plain):
        raise InputError(f"expected a temperature in K, got one in {match[1]!r}")
    names = {name for match in _MEASURED.finditer(plain) for name, _ in _pieces(match[3])}
    usual = frozenset({"Hz"} & names if names & ANGULAR else ())
    main = _read(plain, _Interpretation(usual))
    if main is None:
        return None
    ways = {
        "with a quotient such as 1/2 s as 1/(2 s), and one such as 6 m/2 s as (6 m/2) s": _Interpretation(
            usual, by_whole=False
        ),
        ONE_PER_SECOND: _Interpretation(usual - {"Hz"}),
        "with lb for the force lbf": _Interpretation(usual | ({"lb"} & names)),
        STANDARD_GRAVITY: _Interpretation(usual | ({"g"} & names)),
    }
    others = ((words, _read(plain, way)) for words, way in ways.items())
    return replace(main, others=tuple((words, other) for words, other in others if other and other != main))


def _plain(source: str) -> str | None:
    """Return LaTeX of numbers with units as plain text; None if it has commands that plain signs cannot replace."""
    plain = source
    for pattern, instead in _LATEX:
        plain = re.sub(pattern, instead, plain)
    for sign, value in _COMMON_FRACTIONS.items():
        plain = plain.replace(sign, value)
    return None if "\\" in plain or "{" in plain else plain.replace("−", "-")


def numbers_of_latex(source: str) -> str:
    r"""Return LaTeX as plain text if it has only numbers, one of them decimal: ``\pi = 3.14``; otherwise "".

    Examples
    --------
    >>> numbers_of_latex(r"\pi = 3.14").split(), numbers_of_latex(r"x = 3.14 \pi")
    (['pi', '=', '3.14'], '')
    """
    plain = _plain(source)
    if plain is None or not re.search(r"\d\.\d", plain):
        return ""
    return plain if {*_OTHER_NAME.findall(plain)} <= {*_FUNCTIONS} else ""


def _read(plain: str, way: _Interpretation) -> Measured | None:
    units: dict[str, UnitProduct] = {}
    matches = list(_MEASURED.finditer(plain))
    are_factors = any("*" in match[2] or "/" in match[2] for match in matches)

    def named(match: re.Match[str]) -> str:
        unit = _unit_product(f"/{match[3]}" if "/" in match[2] else match[3], way.meanings)
        name = next((name for name, other in units.items() if other == unit), f"unit_{len(units) + 1}")
        units[name] = unit
        divides = plain[: match.start()].rstrip().endswith("/")
        fraction = re.fullmatch(rf"[^/]*/\s*{_NUMBER}", match[1])  # 2/60 and 2π/60
        if fraction and not way.by_whole:
            return f"({match[1].replace('/', '/(')}*{name}))"
        return f"{match[1]}*{name}" if (divides and not way.by_whole) or not match[1] else f"({match[1]}*{name})"

    text = _MEASURED.sub(named, plain)
    typed = {match["unit"] for one in matches for match in _PIECE.finditer(one[3])}
    has_long_unit = any((len(name) > 1 or name in "°%") and name not in PRODUCTS for name in typed)
    if typed == {"°"} and not re.search(rf"(^|=)\s*-?{_NUMBER}\s*°\s*($|=)", plain):
        return None  # an angle in degrees inside of a formula
    names = [name for name in _OTHER_NAME.findall(text) if name not in _FUNCTIONS and name not in units]
    names = [name for name in names if name not in _SUPERSCRIPTS]
    if not units or (are_factors and not has_long_unit) or not _only_units(text, names, units, has_long_unit):
        return None
    return Measured(plain, text, units, has_long_unit or not names)


def numeric_end(source: str) -> tuple[str, str]:
    """Split a chain of equations into (formulas, numbers with units).

    Return ("", "") if the last two sides are not both numbers with units.

    Examples
    --------
    >>> numeric_end("F = m a = 2 kg * 3 m/s^2 = 6 N")
    ('F = m a', '2 kg * 3 m/s^2 = 6 N')
    """
    parts = re.split(r"==?", source)
    for place in range(1, len(parts) - 1):
        end = "=".join(parts[place:])
        if (measured := measured_text(end)) and measured.is_sure:
            return "=".join(parts[:place]).strip(), end.strip()
    return "", ""


def unit_beside_letters(source: str) -> str:
    """Return a number that surely has a unit, such as "3 m/s^2", in a text with letters; "" if there is none.

    In ``2 x = 3 m`` the letter m may be a quantity.

    Examples
    --------
    >>> unit_beside_letters("m L^2/12 = 1 kg m^2"), unit_beside_letters("v^2/r = 3 m/s^2")
    ('1 kg m^2', '3 m/s^2')
    >>> unit_beside_letters("2 x = 3 m")
    ''
    """
    plain = _plain(source) or ""
    for match in _MEASURED.finditer(plain):
        typed = {piece["unit"] for piece in _PIECE.finditer(match[3])}
        # m may be a quantity, but kg m^2 has a unit of several letters
        if match[1] and "*" not in match[2] and typed & CERTAIN:
            return match[0].strip()
    sides = re.split(r"==?", plain)
    for place, side in enumerate(sides):
        whole = _MEASURED.fullmatch(side.strip())
        if whole is None or not whole[1] or "*" in whole[2]:
            continue
        typed = {piece["unit"] for piece in _PIECE.finditer(whole[3])}
        others = {name for other in sides[:place] + sides[place + 1 :] for name in re.findall(r"[^\W\d_]", other)}
        # a side is nothing but 3 m/s^2, and no other side has its letters
        if len(typed) > 1 and _is_plausible(_unit_product(whole[3])) and not typed & others:
            return side.strip()
    return ""


def _only_units(text: str, names: Sequence[str], units: Mapping[str, UnitProduct], has_long_unit: bool) -> bool:
    """Return whether a text such as ``1 hp = 745.7 W`` has only numbers with units; its left side may be one name.

    In ``text``, names such as unit_1 stand for the ``units``. ``names`` are all its other names. ``has_long_unit``
    tells whether the author typed °, % or a unit with several letters, such as rpm, so that the text surely has units.
    Without such a unit, return False if the one-letter units are probably quantities: m and g in ``2 m g``.
    """
    left = re.match(r"\s*([^\W\d_]\w*)\s*==?", text)
    if names and (left is None or names != [left[1]]):
        return False
    if names:  # such as T in T = 2 N m; the letters N and m may be quantities, but rpm is surely a unit
        return has_long_unit or all(_is_plausible(unit) for unit in units.values())
    if not has_long_unit and any(re.match(r"m[ *·⋅]?g\b", unit.text) for unit in units.values()):
        return False  # the weight m g
    sides = re.split(r"==?", text)
    return has_long_unit or (len(sides) > 1 and all("unit_" in side for side in sides))


def _is_plausible(unit: UnitProduct) -> bool:
    """Return whether a product of one-letter units, such as m/s², is a usual unit, not a product of quantities."""
    plain = unit.text
    for digits, power in _SUPERSCRIPTS.items():
        plain = plain.replace(digits, f"^{power}")
    return plain.replace("·", " ").replace("⋅", " ") in _PLAUSIBLE


def _pieces(text: str) -> Iterator[tuple[str, int]]:
    """Yield each unit in a product with its power: (kg, 1), (m, 2), (s, -1) for ``kg m^2/s``."""
    for match in _PIECE.finditer(text):
        mark = match["power"]
        power = _SUPERSCRIPTS[mark] if mark in _SUPERSCRIPTS else int(re.sub(r"[\^*()]", "", mark) or 1)
        for name in ALIASES.get(match["unit"], match["unit"]).split():
            yield name, -power if "/" in match["sign"] else power


def _unit_product(text: str, meanings: frozenset[str] = frozenset()) -> UnitProduct:
    """Return the product of units in ``text``, with its exact factor to SI units.

    Units in ``meanings`` have their less usual meaning: g is the standard gravity, not the gram.
    """
    dimension: Dimension = NOTHING
    fraction, power_of_pi = Fraction(1), 0
    for name, power in _pieces(text):
        factor, pi, unit = OTHER_MEANINGS[name] if name in meanings else (*FACTORS[name], name)
        dimension = times(dimension, raised(read_unit(unit), Fraction(power)))
        fraction *= factor**power
        power_of_pi += pi * power
    return UnitProduct(" ".join(text.split()), dimension, fraction, power_of_pi)
