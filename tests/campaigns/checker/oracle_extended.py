"""The oracle with roots, absolute values, exponentials and inverse functions, and points that obey hypotheses; all
exact.

A letter under an inverse sine or tangent is given by the angle whose sine or tangent it is, an exponent by its
exponential. So all values are rational; a formula that would have another value is undefined.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import isqrt
from random import Random
from typing import Any

from symrot.checker.claim.tree import Node
from tests.campaigns.checker.oracle import RationalPoint, Undefined, multiple, random_point

__all__ = ["EXPONENTS", "HYPOTHESES", "INVERSES", "WiderPoint", "truth_under", "wider_point"]

EXPONENTS = ("u", "v")
INVERSES = {"asin": "k", "acos": "k", "atan": "l"}
"""Inverse function -> the letter that it is taken of: ``k`` a sine, ``l`` a tangent of an angle in reach."""


@dataclass
class WiderPoint(RationalPoint):
    """A rational point with (cos, sin) of half the angles behind ``k`` and ``l``, and roots of ``exp(u)`` and
    ``exp(v)``.
    """

    hidden: dict[str, tuple[Fraction, Fraction]] = field(default_factory=dict)
    bases: dict[str, Fraction] = field(default_factory=dict)

    def _turned(self, node: Node, times: Fraction) -> tuple[Any, Any]:
        if node.kind != "call" or node.value not in INVERSES:
            return super()._turned(node, times)
        if node.args != (Node("name", INVERSES[node.value]),):
            raise Undefined
        within = WiderPoint({"a": self.hidden[INVERSES[node.value]]}, {}, {})
        angle = Node("name", "a")
        if node.value == "acos":  # the angle whose sine it is, away from a right one
            right = Node("product", None, (Node("name", "pi"), Node("inv", None, (Node("number", Fraction(2)),))))
            angle = Node("sum", None, (right, Node("neg", None, (angle,))))
        return within._turned(angle, times)

    def _call(self, node: Node) -> Any:
        if node.value == "exp":
            return self._exponential(node.args[0], Fraction(1))
        if node.value in ("sqrt", "abs"):
            value = self._value(node.args[0])
            if isinstance(value, list):
                raise Undefined
            return abs(value) if node.value == "abs" else _root(value)
        return super()._call(node)

    def _exponential(self, node: Node, times: Fraction) -> Fraction:
        """Return the exponential of a sum of halves of ``u`` and ``v``."""
        if node.kind == "sum":
            total = Fraction(1)
            for term in node.args:
                total *= self._exponential(term, times)
            return total
        if node.kind == "neg":
            return self._exponential(node.args[0], -times)
        if node.kind == "product":
            rest, times = multiple(node, times)
            return self._exponential(rest, times)
        halves = 2 * times
        if node.kind == "number" and node.value == 0:
            return Fraction(1)
        if node.kind != "name" or node.value not in self.bases or halves.denominator != 1 or abs(halves) > 40:
            raise Undefined
        return self.bases[node.value] ** int(halves)


def _root(value: Fraction) -> Fraction:
    if value < 0:
        raise Undefined
    above, below = isqrt(value.numerator), isqrt(value.denominator)
    if above * above != value.numerator or below * below != value.denominator:
        raise Undefined
    return Fraction(above, below)


def _on_sphere(names: Sequence[str]) -> Callable[[dict[str, Any]], None]:
    """Return a function that moves a point onto a unit sphere, by stereographic projection of all names but the first."""

    def move(values: dict[str, Any]) -> None:
        rest = [values[name] for name in names[1:]]
        size = sum((value * value for value in rest), Fraction(0))
        values[names[0]] = (1 - size) / (1 + size)
        values.update({name: 2 * value / (1 + size) for name, value in zip(names[1:], rest, strict=True)})

    return move


def _product(values: dict[str, Any]) -> None:
    values["z"] = values["x"] * values["y"]


HYPOTHESES: dict[str, Callable[[dict[str, Any]], None]] = {
    "p0**2 + p1**2 + p2**2 + p3**2 == 1": _on_sphere(("p0", "p1", "p2", "p3")),
    "q0**2 + q1**2 + q2**2 + q3**2 == 1": _on_sphere(("q0", "q1", "q2", "q3")),
    "x**2 + y**2 + z**2 == 1": _on_sphere(("x", "y", "z")),
    "x**2 + y**2 == 1": _on_sphere(("x", "y")),
    "z == x*y": _product,
}
"""Hypothesis -> what moves a point onto it."""


def wider_point(source: Random, given: Sequence[str] = ()) -> WiderPoint:
    """Return a point of random rationals that obeys the hypotheses."""
    plain = random_point(source)
    for hypothesis in given:
        HYPOTHESES[hypothesis](plain.values)
    hidden = {}
    for letter in ("k", "l"):  # half of an angle between -pi/2 and pi/2
        t = Fraction(source.randint(-12, 12), source.randint(30, 40))
        hidden[letter] = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    (c, s), (e, f) = hidden["k"], hidden["l"]
    values = {**plain.values, "k": 2 * c * s, "l": 2 * e * f / (e * e - f * f)}
    bases = {name: Fraction(source.randint(2, 9), source.randint(2, 9)) for name in EXPONENTS}
    return WiderPoint(plain.halves, values, plain.rates, hidden, bases)


def truth_under(left: Node, right: Node, given: Sequence[str], source: Random, wanted: int = 3) -> bool | None:
    """Return whether two sides agree exactly at rational points under hypotheses; None if too few are defined."""
    defined = 0
    for _ in range(4 * wanted):
        point = wider_point(source, given)
        try:
            a, b = point.value(left), point.value(right)
        except Undefined:
            continue
        if isinstance(a, list) != isinstance(b, list) or a != b:
            return False
        defined += 1
        if defined == wanted:
            return True
    return None
