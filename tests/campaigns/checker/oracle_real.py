"""Values of trees at real points in 60 digits, or none: the oracle of the campaign over real functions.

It uses mpmath's floating-point numbers alone and shares nothing with the engine. It proves nothing, but distinguishes
two values, and a value from none. The rules are those of real functions: a power ``u^(p/q)``, q > 1, only for u >= 0;
logarithms of positive numbers; ``asin`` and ``acos`` between -1 and 1; no division by zero. A piece that is multiplied
by zero must have a value too. Near the edge of a domain, and beyond e^100, the oracle does not answer.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from math import prod
from random import Random
from typing import Any

from mpmath import MPContext

from symrot.checker.claim.tree import Node, walk

__all__ = [
    "NAMES",
    "Edge",
    "Large",
    "NoValue",
    "Unclear",
    "compare",
    "drawn_point",
    "generic_point",
    "has_values",
    "lacks_a_value",
    "real_value",
]

NAMES = ("x", "y", "z")

DIGITS, MORE_DIGITS = 60, 200
EDGE = 25
"""Digits: a number below 10^-25 that is not exactly zero may be one that is."""

_MOST = 100
"""Of an exponent of e: larger numbers may cancel beyond the digits."""

Point = Mapping[str, Fraction]


class NoValue(Exception):
    """The formula is no real number at this point."""


class Unclear(Exception):
    """The judge cannot decide."""


class Edge(Unclear):
    """The judge cannot decide since the point is on the edge of the domain or close to it."""


class Large(Unclear):
    """There is a value, but it is too large to be compared."""


def _context(digits: int) -> Any:
    made = MPContext()
    made.dps = digits
    return made


_CONTEXTS = {digits: _context(digits) for digits in (DIGITS, MORE_DIGITS)}


@dataclass(frozen=True)
class Unknown:
    """A real number that is too large to be computed, or depends on one: its sign is 1 or -1 if known, otherwise 0."""

    sign: int = 0


_EVERYWHERE = {"abs": 0, "exp": 1, "sinh": 0, "cosh": 1, "tanh": 0, "sin": 0, "cos": 0, "tan": 0, "atan": 0}
"""Functions that have a value of every real number, or of nearly every one, and the sign of it."""


def _of_unknown(node: Node, parts: Sequence[Any]) -> Unknown:
    """Return the value of a piece that has ``Unknown`` parts, if it has a value."""
    signs = [part.sign if isinstance(part, Unknown) else (part > 0) - (part < 0) for part in parts]
    if node.kind == "sum":
        nonzero = {sign for sign, part in zip(signs, parts, strict=True) if isinstance(part, Unknown) or part}
        return Unknown(nonzero.pop() if len(nonzero) == 1 else 0)
    if node.kind in ("product", "neg"):
        return Unknown(prod(signs) if node.kind == "product" else -signs[0])
    if node.kind == "call" and node.value in _EVERYWHERE:
        return Unknown(_EVERYWHERE[node.value])
    if node.kind == "power":
        exponent = _rational(node.args[1])
        if exponent.denominator > 1 and signs[0] < 0:
            raise NoValue
        if signs[0] > 0 or (exponent.denominator == 1 and exponent >= 0):
            return Unknown(signs[0] if signs[0] > 0 or exponent.numerator % 2 else 0)
    if signs[0] and (node.kind == "inv" or node.value in ("log", "sqrt")):
        if signs[0] < 0 and node.kind == "call":
            raise NoValue
        return Unknown(0 if node.value == "log" else signs[0])
    raise Edge if node.kind == "inv" else Unclear


class _Judge:
    """Values at one point in one precision."""

    def __init__(self, point: Point, digits: int) -> None:
        self.mp, self.point = _CONTEXTS[digits], point
        self.values = {name: self.mp.mpf(value.numerator) / value.denominator for name, value in point.items()}
        self.edge = self.mp.mpf(10) ** -EDGE
        self.failed: Node | None = None  # the piece without a value

    def value(self, node: Node) -> Any:
        """Return the value of a tree; an ``Unknown`` for a real number that is too large or depends on one."""
        try:
            return self.small_value(node)
        except Large as large:
            return large.args[0]
        except (NoValue, Unclear):
            self.failed = self.failed or node
            raise

    def small_value(self, node: Node) -> Any:
        kind, args = node.kind, node.args
        if kind == "number":
            return self.mp.mpf(node.value.numerator) / node.value.denominator
        if kind == "name":
            return +self.mp.pi if node.value == "pi" else self.values[node.value]
        if kind == "power":
            base, exponent = self.value(args[0]), _rational(args[1])
            if isinstance(base, Unknown):
                raise Large(_of_unknown(node, [base]))
            return self.power(base, exponent)
        parts = [self.value(argument) for argument in args]
        if any(isinstance(part, Unknown) for part in parts):
            raise Large(_of_unknown(node, parts))
        if kind == "sum":
            return sum(parts[1:], parts[0])
        if kind == "product":
            total = parts[0]
            for part in parts[1:]:
                total = total * part
            return total
        if kind == "neg":
            return -parts[0]
        if kind == "inv":
            return 1 / self.nonzero(parts[0])
        if kind == "call":
            return getattr(self, f"of_{node.value}")(*parts)
        raise Unclear

    # -- edges --------------------------------------------------------------------------------------------------------

    def nonzero(self, value: Any) -> Any:
        if value == 0:
            raise NoValue
        if abs(value) < self.edge:
            raise Edge
        return value

    def nonnegative(self, value: Any) -> Any:
        if value == 0:
            return value
        if abs(value) < self.edge:
            raise Edge
        if value < 0:
            raise NoValue
        return value

    def power(self, base: Any, exponent: Fraction) -> Any:
        if exponent.denominator > 1:
            base = self.nonnegative(base)
        if exponent < 0:
            base = self.nonzero(base)
        if base == 0:
            return self.mp.mpf(0 if exponent else 1)
        if self.mp.log(abs(base)) * exponent.numerator / exponent.denominator > _MOST:
            raise Large(Unknown(1 if base > 0 or exponent.numerator % 2 == 0 else -1))
        if exponent.denominator == 1:
            return base**exponent.numerator
        return self.mp.exp(self.mp.log(base) * exponent.numerator / exponent.denominator)

    # -- functions ----------------------------------------------------------------------------------------------------

    def of_sqrt(self, u: Any) -> Any:
        return self.mp.sqrt(self.nonnegative(u))

    def of_abs(self, u: Any) -> Any:
        return abs(u)

    def of_log(self, u: Any) -> Any:
        return self.mp.log(self.nonzero(self.nonnegative(u)))

    def of_exp(self, u: Any) -> Any:
        if abs(u) > _MOST:
            raise Large(Unknown(1))
        return self.mp.exp(u)

    def of_sinh(self, u: Any) -> Any:
        if abs(u) > _MOST:
            raise Large(Unknown(1 if u > 0 else -1))
        return (self.of_exp(u) - self.of_exp(-u)) / 2

    def of_cosh(self, u: Any) -> Any:
        return (self.of_exp(u) + self.of_exp(-u)) / 2

    def of_tanh(self, u: Any) -> Any:
        if abs(u) > _MOST:
            raise Large(Unknown(1 if u > 0 else -1))
        return self.of_sinh(u) / self.of_cosh(u)

    def of_sin(self, u: Any) -> Any:
        return self.mp.sin(self.angle(u))

    def of_cos(self, u: Any) -> Any:
        return self.mp.cos(self.angle(u))

    def of_tan(self, u: Any) -> Any:
        return self.of_sin(u) / self.nonzero(self.of_cos(u))

    def angle(self, u: Any) -> Any:
        if abs(u) > self.mp.mpf(10) ** 20:
            raise Large(Unknown())
        return u

    def of_asin(self, u: Any) -> Any:
        self.nonnegative(1 - u)
        self.nonnegative(1 + u)
        return self.mp.atan2(u, self.mp.sqrt((1 - u) * (1 + u)))

    def of_acos(self, u: Any) -> Any:
        return self.mp.pi / 2 - self.of_asin(u)

    def of_atan(self, u: Any) -> Any:
        return self.mp.atan(u)

    def of_atan2(self, y: Any, x: Any) -> Any:
        if x == 0 and y == 0:
            raise NoValue
        if max(abs(x), abs(y)) < self.edge or (x < 0 and 0 < abs(y) < self.edge):
            raise Edge
        return self.mp.pi if x < 0 and y == 0 else self.mp.atan2(y, x)


def _rational(node: Node) -> Fraction:
    """Return an exponent: a number, perhaps with a sign, or a quotient of numbers."""
    if node.kind == "neg":
        return -_rational(node.args[0])
    if node.kind == "inv":
        return 1 / _rational(node.args[0])
    if node.kind == "product":
        total = Fraction(1)
        for factor in node.args:
            total *= _rational(factor)
        return total
    if node.kind != "number":
        raise Unclear
    return Fraction(node.value)


def real_value(node: Node, point: Point, digits: int = DIGITS) -> Any:
    """Return the value of a tree at a point.

    Raises
    ------
    NoValue
        If it is no real number.
    Unclear
        If the judge cannot decide, or does not know a function.
    """
    try:
        return _Judge(point, digits).small_value(node)
    except (AttributeError, KeyError, TypeError, OverflowError, MemoryError):
        raise Unclear from None


@cache
def _generic_judges(count: int) -> tuple[_Judge, ...]:
    source = Random(count)
    return tuple(_Judge(generic_point(source), DIGITS) for _ in range(count))


def has_values(sides: Sequence[Node], count: int) -> bool:
    """Return whether all sides have values at one of ``count`` generic points, as far as the judge can tell.

    The piece that had no value at the last point is evaluated first, since it often has none at the next point either.
    """
    pieces = list(sides)
    for judge in _generic_judges(count):
        judge.failed = None
        try:
            for piece in pieces:
                judge.value(piece)
            finer = _Judge(judge.point, MORE_DIGITS)  # a number that seems zero in 60 digits may be negative
            for piece in sides:
                finer.value(piece)
            return True
        except (NoValue, Unclear, AttributeError, KeyError, TypeError, OverflowError, MemoryError):
            failed = judge.failed
        if failed is not None:
            if not any(node.kind == "name" and node.value != "pi" for _, node in walk(failed)):
                return False
            pieces = [failed, *sides]
    return False


def lacks_a_value(sides: Sequence[Node], point: Point) -> bool:
    """Return whether some piece of the sides is certainly no real number at a point, even if others are unclear."""
    judge = _Judge(point, MORE_DIGITS)
    for side in sides:
        for _, piece in walk(side):
            try:
                judge.value(piece)
            except NoValue:
                return True
            except (Unclear, AttributeError, KeyError, TypeError, OverflowError, MemoryError):
                continue
    return False


def _value_or_unknown(node: Node, point: Point, digits: int) -> Any:
    try:
        return real_value(node, point, digits)
    except Large as large:
        return large.args[0]


def compare(left: Node, right: Node, point: Point) -> bool:
    """Return whether two sides have one value at a point; if they seem to differ, twice as many digits decide.

    Raises
    ------
    NoValue
        If a side is no real number.
    Unclear
    """
    gaps = []
    for digits in (DIGITS, MORE_DIGITS):
        a, b = (_value_or_unknown(side, point, digits) for side in (left, right))
        if isinstance(a, Unknown) or isinstance(b, Unknown):
            raise Large
        gap = abs(a - b) / (1 + abs(a) + abs(b))
        if gap == 0:
            return True
        gaps.append(gap)
    return bool(gaps[1] < 1e-20 and gaps[1] < gaps[0] * 1e-20) or bool(gaps[1] < 1e-100)


def drawn_point(source: Random, names: Sequence[str] = NAMES) -> dict[str, Fraction]:
    """Return a random point: small whole numbers, small fractions, and numbers of any size."""
    return _drawn(source, names, 0)


def generic_point(source: Random, names: Sequence[str] = NAMES) -> dict[str, Fraction]:
    """Return a random point on no edge that is likely to matter: no whole numbers."""
    return _drawn(source, names, 3)  # never zero


def far_point(source: Random, names: Sequence[str] = NAMES) -> dict[str, Fraction]:
    """Return a random point with numbers of all sizes from 1e-12 to 1e12, so that narrow domains are reached too."""
    return {
        name: source.choice((-1, 1)) * Fraction(10) ** source.randint(-12, 12) * Fraction(10 ** source.random())
        for name in names
    }


def _drawn(source: Random, names: Sequence[str], least: int) -> dict[str, Fraction]:
    def value() -> Fraction:
        kind = source.randint(least, 4)
        if kind == 0:
            return Fraction(source.randint(-3, 3))
        if kind == 1:
            return Fraction(source.randint(-20, 20), source.randint(1, 20))
        if kind == 2:
            return Fraction(source.randint(-99, 99), 100)
        if kind == 3:
            size = Fraction(10) ** source.choice((-5, -4, -3, -2, -1, 0, 1, 2, 6, 12, 20))
            return source.choice((-1, 1)) * source.randint(1, 999) * size
        return Fraction(2 * source.randint(-5000, 5000) + 1, 997)

    return {name: value() for name in names}
