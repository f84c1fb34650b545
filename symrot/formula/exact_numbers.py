"""The exact numbers of a scene, read from text as :class:`fractions.Fraction`. Standard library only.

A rational value is exact: ``"1/3"``, ``"0.6375"`` (51/80), ``1e-3``. An irrational value, as of ``sqrt``, ``pi`` and
``sin``, is rounded, to a relative error below 2^-300 unless digits cancel.
"""

__all__ = [
    "NEGLIGIBLE", "NEGLIGIBLE_BITS", "PI", "Angle", "cos", "equal", "read", "read_angle", "rounded", "show", "sin",
    "sqrt", "tan", "unit",
]  # fmt: skip

from collections.abc import Callable, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import cache
from math import isfinite, isqrt, lcm
from numbers import Rational
from typing import NamedTuple, NoReturn, SupportsFloat

from symrot.errors import InputError
from symrot.formula import tree as expression

BITS = 320
"""Working precision, in bits, of irrational numbers."""

NEGLIGIBLE_BITS = 200
"""A number of bits: a value below 2^-200 times the values with which it is compared counts as zero."""

NEGLIGIBLE = Fraction(1, 1 << NEGLIGIBLE_BITS)

LARGEST_TEXT = 400
"""Longest text of one number, in characters."""

LARGEST_BITS = 1 << 15
"""Largest size, in bits, of an intermediate numerator or denominator; it stops powers of powers early."""

LARGEST = Fraction(2) ** 1024
"""Numbers of this size and above exceed the range of a double and are rejected."""

SMALLEST = 1 / Fraction(2) ** 1022
"""Numbers other than zero below this size, that of the smallest normal double, are rejected."""

EXPECTATION = 'a number, such as 2, 0.5, "1/3", "sqrt(2)" or "pi/6"'


def show(value: object, limit: int = 60) -> str:
    """Return the text of ``value`` for an error message, as the user wrote it.

    A text of more than ``limit`` characters is cut.
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        text = repr(value[: limit + 1])
    elif isinstance(value, Fraction) and abs(value) < LARGEST:
        text = str(value) if value.denominator == 1 else f"{float(value):.15g}"
    elif isinstance(value, Decimal):
        text = str(value).lower().replace("infinity", "inf")
    elif isinstance(value, list | tuple | dict) and limit < 2:  # deeply nested: not worth showing
        text = ".."
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(show(item, limit // 2) for item in value[:12]) + (", ..]" if len(value) > 12 else "]")
    elif isinstance(value, dict):
        text = "{" + ", ".join(f"{key} = {show(item, limit // 2)}" for key, item in list(value.items())[:12]) + "}"
    elif isinstance(value, int) and value.bit_length() > 4 * limit:
        text = f"an integer of {value.bit_length()} bits"
    elif hasattr(value, "isoformat"):
        text = str(value)
    else:
        text = " ".join(repr(value).split())
    return text if len(text) <= limit + 2 else text[:limit] + ".."


def rounded(value: Fraction) -> Fraction:
    """Return a number rounded to an integer times a power of two, with a relative error below 2^-320."""
    # this keeps the fractions of irrational numbers short
    shift = BITS + 2 - value.numerator.bit_length() + value.denominator.bit_length()
    scaled = value.numerator << shift if shift > 0 else value.numerator >> -shift
    quotient = scaled // value.denominator
    return Fraction(quotient, 1 << shift) if shift > 0 else Fraction(quotient << -shift)


@cache
def _pi(bits: int) -> Fraction:
    """Return pi with an absolute error below 2^-bits (Machin: pi = 16 arctan(1/5) - 4 arctan(1/239))."""
    one = 1 << (bits + 16)

    def arctan_of_inverse(n: int) -> int:
        power, total, divisor, sign = one // n, 0, 1, 1
        while power:
            total += sign * (power // divisor)
            power, divisor, sign = power // (n * n), divisor + 2, -sign
        return total

    return Fraction(16 * arctan_of_inverse(5) - 4 * arctan_of_inverse(239), one)


PI: Fraction = _pi(BITS)
"""pi, to 2^-320."""


def sqrt(value: Fraction) -> Fraction:
    """Return the square root of ``value`` >= 0: exact if it is rational, else with a relative error below 2^-320.

    Raise ValueError if ``value`` is negative.
    """
    if value < 0:
        raise ValueError(f"the square root of the negative number {show(value)} is not real")
    numerator, denominator = isqrt(value.numerator), isqrt(value.denominator)
    if numerator * numerator == value.numerator and denominator * denominator == value.denominator:
        return Fraction(numerator, denominator)
    shift = max(0, BITS + 2 - value.numerator.bit_length() // 2 + value.denominator.bit_length() // 2)
    return Fraction(isqrt((value.numerator << 2 * shift) // value.denominator), 1 << shift)


def unit(vector: Sequence[Fraction | float]) -> tuple[Fraction, ...]:
    """Return a nonzero vector divided by its norm: exact if the norm is rational, else with an error of 2^-320."""
    # integers over one common denominator: fractions would need a greatest common divisor for each operation
    ratios = [x.as_integer_ratio() for x in vector]
    shared = lcm(*[bottom for _, bottom in ratios])
    tops = [top * (shared // bottom) for top, bottom in ratios]
    square = sum([x * x for x in tops])
    norm, shift = isqrt(square), 0
    if norm * norm != square:
        shift = max(0, BITS + 2 - square.bit_length() // 2)
        norm = isqrt(square << 2 * shift)
    return tuple([Fraction(x << shift, norm) for x in tops])


def _sin_first_quadrant(value: Fraction, bits: int) -> Fraction:
    """Return the sine of 0 <= value < 2, rad, by its series in fixed point, with an absolute error below 2^-bits."""
    one = 1 << (bits + 16)
    term = value.numerator * one // value.denominator
    square = term * term // one
    total, sign, n = 0, 1, 1
    while term:
        total += sign * term
        term = term * square // one // ((n + 1) * (n + 2))
        sign, n = -sign, n + 2
    return Fraction(total, one)


_NIVEN = {Fraction(0): Fraction(0), Fraction(1, 6): Fraction(1, 2), Fraction(1, 2): Fraction(1)}
"""n -> sin(n pi), for all n from 0 to 1/2 for which both numbers are rational (Niven's theorem)."""


def _sin_half_turns(half_turns: Fraction) -> Fraction:
    """Return sin(half_turns * pi); the result is exact if it is rational."""
    reduced = half_turns % 2
    if reduced >= 1:
        return -_sin_half_turns(reduced - 1)
    reduced = min(reduced, 1 - reduced)
    exact = _NIVEN.get(reduced)
    return _sin_first_quadrant(reduced * PI, _bits_for(reduced)) if exact is None else exact


def _bits_for(value: Fraction) -> int:
    """Return how many bits after the binary point represent a small ``value`` with a relative error of 2^-BITS."""
    return BITS + max(0, value.denominator.bit_length() - value.numerator.bit_length())


def _sin_shifted(value: Fraction, quarter_turns: int) -> Fraction:
    """Return sin(value + quarter_turns * pi/2), with ``value`` in rad, with an absolute error below 2^-300.

    One quarter turn gives the cosine.
    """
    if not value:
        return Fraction((0, 1, 0, -1)[quarter_turns % 4])
    magnitude = max(0, value.numerator.bit_length() - value.denominator.bit_length())
    half_pi = (PI if magnitude < 8 else _pi(BITS + magnitude)) / 2
    quarters = value // half_pi
    rest, quadrant = value - quarters * half_pi, (quarters + quarter_turns) % 4
    sign = -1 if quadrant >= 2 else 1
    angle = half_pi - rest if quadrant % 2 else rest
    return sign * _sin_first_quadrant(angle, _bits_for(angle) if angle > 0 else BITS)


def sin(value: Fraction) -> Fraction:
    """Return the sine of ``value``, rad, with an absolute error below 2^-250."""
    return _sin_shifted(value, 0)


def cos(value: Fraction) -> Fraction:
    """Return the cosine of ``value``, rad, with an absolute error below 2^-250."""
    return _sin_shifted(value, 1)


def tan(value: Fraction) -> Fraction:
    """Return the tangent of ``value``, rad: the quotient of a sine and a cosine with absolute errors below 2^-250.

    Raise ZeroDivisionError if this cosine is 0.
    """
    return sin(value) / cos(value)


def equal(a: Fraction, b: Fraction) -> bool:
    """Return whether two numbers are equal, or so close that their difference is below 2^-200 of the larger size.

    symrot compares the numbers of a scene in this way, such as two moments of inertia, because numbers that contain pi,
    roots or sines are rounded when the scene is read.
    """
    return a == b or abs(a - b) * NEGLIGIBLE.denominator < max(abs(a), abs(b))


class Angle(NamedTuple):
    """An angle ``rational + half_turns * pi`` in rad, where both numbers are fractions; (0, 1/2) is 90 degrees."""

    # in this form 90 degrees has the exact sine 1 and cosine 0
    rational: Fraction
    half_turns: Fraction

    @property
    def radians(self) -> Fraction:
        """The angle in rad, rounded to 2^-300 if it contains a multiple of pi."""
        return self.rational + self.half_turns * PI if self.half_turns else self.rational

    @property
    def sin(self) -> Fraction:
        """The sine: exact if it is a rational number, else with an absolute error below 2^-250."""
        return sin(self.radians) if self.rational else _sin_half_turns(self.half_turns)

    @property
    def cos(self) -> Fraction:
        """The cosine: exact if it is a rational number, else with an absolute error below 2^-250."""
        return cos(self.radians) if self.rational else _sin_half_turns(self.half_turns + Fraction(1, 2))

    def scaled(self, factor: Fraction) -> "Angle":
        """Return the angle times the rational number ``factor``."""
        return Angle(self.rational * factor, self.half_turns * factor)


def _exactly(value: Fraction) -> Angle:
    return Angle(value, Fraction(0))


def _multiply(a: Angle, b: Angle) -> Angle:
    if not b.half_turns:
        return a.scaled(b.rational)
    if not a.half_turns:
        return b.scaled(a.rational)
    return _exactly(rounded(a.radians * b.radians))


def _divide(a: Angle, b: Angle) -> Angle:
    if not b.half_turns:
        return a.scaled(1 / b.rational)
    if not a.rational and not b.rational:
        return _exactly(a.half_turns / b.half_turns)
    return _exactly(rounded(a.radians / b.radians))


def _power(base: Fraction, exponent: int) -> Fraction:
    bits = max(base.numerator.bit_length(), base.denominator.bit_length())
    return (rounded(base) if bits > BITS else base) ** exponent


_OPERATORS: dict[str, Callable[[Angle, Angle], Angle]] = {
    "+": lambda a, b: Angle(a.rational + b.rational, a.half_turns + b.half_turns),
    "-": lambda a, b: Angle(a.rational - b.rational, a.half_turns - b.half_turns),
    "*": _multiply,
    "/": _divide,
}

_FUNCTIONS: dict[str, Callable[[Angle], Fraction]] = {
    "sqrt": lambda a: sqrt(a.radians),
    "sin": lambda a: a.sin,
    "cos": lambda a: a.cos,
    "tan": lambda a: a.sin / a.cos,
    "abs": lambda a: abs(a.radians),
}


def _walk(node: expression.Node) -> Angle:
    kind, *rest = node
    match kind:
        case "number":
            value = _exactly(Fraction(rest[0]))
        case "symbol":
            if rest[0] != "pi":
                raise ValueError(f"{rest[0]!r} is not a number")
            value = Angle(Fraction(0), Fraction(1))
        case "neg":
            value = _walk(rest[0]).scaled(Fraction(-1))
        case "**":
            value = _exactly(_power(_walk(rest[0]).radians, rest[1]))
        case "call":
            name, arguments = rest
            if name not in _FUNCTIONS or len(arguments) != 1:
                raise ValueError(
                    f"the functions allowed in a number are {', '.join(_FUNCTIONS)}, each with one argument, got {name}"
                )
            value = _exactly(_FUNCTIONS[name](_walk(arguments[0])))
        case _:
            value = _OPERATORS[kind](_walk(rest[0]), _walk(rest[1]))
    for part in (value.rational, value.half_turns):
        if max(part.numerator.bit_length(), part.denominator.bit_length()) > LARGEST_BITS:
            raise ValueError("the number is too large")
    return value


def _from_text(text: str) -> Angle:
    if len(text) > LARGEST_TEXT:
        raise ValueError(f"the text has {len(text)} characters, more than the limit of {LARGEST_TEXT}")
    try:
        return _walk(expression.parse(text))
    except ZeroDivisionError:
        raise ValueError("a division by zero") from None


def _from_decimal(value: Decimal) -> Angle:
    if not value.is_finite():
        raise ValueError("not finite")
    if value and abs(value.adjusted()) > 400:
        raise ValueError("outside the range of a double")
    return _exactly(Fraction(value))


def _from_float(value: SupportsFloat) -> Angle:
    value = float(value)
    if not isfinite(value):
        raise ValueError("not finite")
    return _exactly(Fraction(value))


_READERS: dict[type, Callable[..., Angle]] = {
    str: _from_text,
    Decimal: _from_decimal,
    float: _from_float,
    int: lambda value: _exactly(Fraction(value)),
    Fraction: _exactly,
    # of SymPy and NumPy
    Rational: lambda value: _exactly(Fraction(int(value.numerator), int(value.denominator))),
}


def _in_range(value: Fraction) -> None:
    if abs(value) >= LARGEST or 0 < abs(value) < SMALLEST:
        raise ValueError("outside the range of a double")


def _read(value: object, where: str, expect: str) -> Angle:
    """Return a number as an :class:`Angle` in rad, so that multiples of pi stay exact."""
    # where (file and key) and expect are texts for the message of the InputError
    kind = type(value)
    if not isinstance(value, bool):
        reader = _READERS.get(kind) or next((r for k, r in _READERS.items() if isinstance(value, k)), None)
        if reader is None and hasattr(value, "__float__"):
            reader = _from_float  # of a scalar of NumPy, or a number of SymPy
        if reader is not None:
            try:
                angle = reader(value)
                _in_range(angle.radians)
                return angle
            except InputError:
                _refuse(value, where, expect, _unit_hint(value))
            except (ValueError, TypeError, OverflowError) as reason:
                _refuse(value, where, expect, str(reason))
    _refuse(value, where, expect, "")


def _unit_hint(value: object) -> str:
    text = str(value).strip()
    if text[:1].isdigit() and text[-1:].isalpha():
        return "write it without a unit: SI units are understood"
    return ""


def _refuse(value: object, where: str, expect: str, reason: str) -> NoReturn:
    prefix = f"{where}: " if where else ""
    raise InputError(f"{prefix}expected {expect}, got {show(value)}" + (f" ({reason})" if reason else ""))


def read(value: object, where: str = "", expect: str = EXPECTATION) -> Fraction:
    """Return the exact value of a number given in a scene.

    Parameters
    ----------
    value : int, float, Decimal, Fraction or str
        A float stands for its exact binary value, a text or a Decimal for the number as written: ``"0.1"`` is 1/10.
        Text may contain ``+ - * / **``, parentheses, ``pi``, ``sqrt``, ``sin``, ``cos``, ``tan``, ``abs``.
    where : str
        File and key of the number, for error messages.
    expect : str
        The expected value, as an error message names it.

    Returns
    -------
    Fraction
        Exact if the value is rational, otherwise with a relative error below 2^-300 unless digits cancel.

    Raises
    ------
    InputError
        If the value is NaN, infinite, outside the range of doubles, true or false, a number with a unit, or not a
        number at all.

    Examples
    --------
    >>> read("0.6375")
    Fraction(51, 80)
    """
    return _read(value, where, expect).radians


def read_angle(value: object, degrees: bool = False, where: str = "", expect: str = EXPECTATION) -> Angle:
    """Return an angle given in rad, or in degrees if ``degrees`` is true.

    Raise InputError as :func:`read` does.
    """
    # a rational multiple of pi stays exact: cos("pi/2") is exactly 0
    angle = _read(value, where, expect)
    if not degrees:
        return angle
    if not angle.half_turns:
        return Angle(Fraction(0), angle.rational / 180)
    return _exactly(rounded(angle.radians * PI / 180))
