"""Values of trees at rational points by exact arithmetic that shares nothing with the engine: the oracle of the
campaign.

An angle is given by the rational cosine and sine of its half; a function of time by these and its rate.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

from symrot.checker.claim.tree import Node, walk
from symrot.checker.repair.dual import Dual

__all__ = ["ANGLES", "FUNCTIONS", "SYMBOLS", "RationalPoint", "Undefined", "multiple", "random_point", "truth"]

ANGLES = ("a", "b", "c")
SYMBOLS = ("x", "y", "z")
FUNCTIONS = ("phi", "theta")
QUATERNIONS = (("p0", "p1", "p2", "p3"), ("q0", "q1", "q2", "q3"))


class Undefined(Exception):
    """The formula has no value at this point."""


def multiple(product: Node, times: Fraction) -> tuple[Node, Fraction]:
    """Return the factor of a product that is no number, and ``times`` times all its numbers; raise ``Undefined``
    without such a factor.
    """
    rest = []
    for factor in product.args:
        if factor.kind == "number":
            times *= factor.value
        elif factor.kind == "inv" and factor.args[0].kind == "number":
            times /= factor.args[0].value
        else:
            rest.append(factor)
    if len(rest) != 1:
        raise Undefined
    return rest[0], times


@dataclass
class RationalPoint:
    """Rational values of all names: ``halves`` are (cos, sin) of half the angles, ``rates`` the rates of functions."""

    halves: dict[str, tuple[Any, Any]]
    values: dict[str, Any]
    rates: dict[str, Fraction]

    def angle(self, node: Node) -> tuple[Any, Any]:
        """Return (cos, sin) of an angle; raise ``Undefined`` if it is no combination of whole and half angles."""
        return self._turned(node, Fraction(1))

    def _turned(self, node: Node, times: Fraction) -> tuple[Any, Any]:
        if node.kind == "sum":
            total: tuple[Any, Any] = (Fraction(1), Fraction(0))
            for term in node.args:
                total = _added(total, self._turned(term, times))
            return total
        if node.kind == "neg":
            return self._turned(node.args[0], -times)
        if node.kind == "product":
            rest, times = multiple(node, times)
            return self._turned(rest, times)
        if node == Node("name", "pi"):
            quarters = times * 2
            if quarters.denominator != 1:
                raise Undefined
            return [(1, 0), (0, 1), (-1, 0), (0, -1)][int(quarters) % 4]
        name = node.value if node.kind == "name" or node.args == (Node("name", "t"),) else None
        halves = times * 2
        if name not in self.halves or halves.denominator != 1:
            raise Undefined
        c, s = self.halves[name]
        point: tuple[Any, Any] = (Fraction(1), Fraction(0))
        for _ in range(abs(int(halves))):
            point = _added(point, (c, s if halves > 0 else -s))
        return point

    def value(self, node: Node) -> Any:
        """Return a rational, or a matrix as a list of rows."""
        try:
            return self._value(node)
        except (ZeroDivisionError, KeyError, TypeError, ValueError, IndexError, AttributeError):
            raise Undefined from None

    def _value(self, node: Node) -> Any:
        kind, args = node.kind, node.args
        if kind == "number":
            return node.value
        if kind == "name":
            return self.values[node.value]
        if kind == "sum":
            total = self._value(args[0])
            for term in args[1:]:
                total = _plus(total, self._value(term))
            return total
        if kind == "product":
            total = self._value(args[0])
            for factor in args[1:]:
                total = _times(total, self._value(factor))
            return total
        if kind == "neg":
            return _times(Fraction(-1), self._value(args[0]))
        if kind == "inv":
            return _over(self._value(args[0]))
        if kind == "power":
            exponent = self._value(args[1])
            base = self._value(args[0])
            if exponent.denominator != 1 or isinstance(base, list):
                raise Undefined
            total = Fraction(1)
            for _ in range(abs(int(exponent))):
                total = total * base
            return total if exponent >= 0 else _over(total)
        if kind == "transpose":
            return [list(row) for row in zip(*self._value(args[0]), strict=True)]
        if kind == "list":
            return self._list(node)
        return self._call(node)

    def _list(self, node: Node) -> Any:
        return [self._value(member) for member in node.args]

    def _call(self, node: Node) -> Any:
        name, args = node.value, node.args
        if name in ("sin", "cos", "tan", "cot"):
            c, s = self.angle(args[0])
            above, below = {"sin": (s, 1), "cos": (c, 1), "tan": (s, c), "cot": (c, s)}[name]
            return above * _over(below)
        if name in ("Rx", "Ry", "Rz"):
            c, s = self.angle(args[0])
            axis = "xyz".index(name[1])
            rows: list[list[Any]] = [[Fraction(0)] * 3 for _ in range(3)]
            i, j = (axis + 1) % 3, (axis + 2) % 3
            rows[axis][axis] = Fraction(1)
            rows[i][i] = rows[j][j] = c
            rows[i][j], rows[j][i] = -s, s
            return rows
        if name == "diff":
            return self._derivative(args[0], args[1])
        values = [self._value(argument) for argument in args]
        if name == "Matrix":
            (rows,) = values
            return [row if isinstance(row, list) else [row] for row in rows]
        if name == "skew":
            a, b, c = values
            return [[Fraction(0), -c, b], [c, Fraction(0), -a], [-b, a, Fraction(0)]]
        if name == "cross":
            (a, b, c), (d, e, f) = ([_single(row) for row in value] for value in values)
            return [[b * f + -(c * e)], [c * d + -(a * f)], [a * e + -(b * d)]]
        if name == "dot":
            return sum((_single(p) * _single(q) for p, q in zip(*values, strict=True)), Fraction(0))
        if name == "diag":
            return [[v if i == j else Fraction(0) for j in range(len(values))] for i, v in enumerate(values)]
        if name == "trace":
            return sum((values[0][i][i] for i in range(len(values[0]))), Fraction(0))
        if name == "det":
            return _determinant(values[0])
        if name == "vee":
            (rows,) = values
            return [[rows[2][1]], [rows[0][2]], [rows[1][0]]]
        if name == "inverse":
            (rows,) = values
            if rows != self._value(args[0]) or _times(rows, _transposed(rows)) != _identity(len(rows)):
                raise Undefined
            return _transposed(rows)
        if name == "qmul":
            return [[component] for component in _hamilton(*([_single(p) for p in value] for value in values))]
        if name == "dcm_of":
            q = [_single(p) for p in (values[0] if len(values) == 1 else values)]
            return _turning(q)
        raise Undefined

    def _derivative(self, formula: Node, variable: Node) -> Any:
        if variable != Node("name", "t") or any(node.value == "diff" for _, node in walk(formula)):
            if formula.kind == "call" and formula.args == (Node("name", "t"),) and formula.value in self.rates:
                return self.rates[formula.value]
            raise Undefined
        if formula.kind == "call" and formula.value in self.rates:
            return self.rates[formula.value]
        lifted = {}
        for name, (c, s) in self.halves.items():
            rate = self.rates.get(name, Fraction(0)) / 2
            lifted[name] = (Dual(c, -s * rate), Dual(s, c * rate))
        values = {name: Dual(value, Fraction(0)) for name, value in self.values.items()}
        found = RationalPoint(lifted, values, self.rates)._value(formula)
        return [[_slope(v) for v in row] for row in found] if isinstance(found, list) else _slope(found)


def _slope(value: Any) -> Any:
    return value.slope if isinstance(value, Dual) else Fraction(0)


def _single(value: Any) -> Any:
    if isinstance(value, list):
        (value,) = value
    return value


def _added(p: tuple[Any, Any], q: tuple[Any, Any]) -> tuple[Any, Any]:
    return p[0] * q[0] + -(p[1] * q[1]), p[1] * q[0] + p[0] * q[1]


def _over(value: Any) -> Any:
    if isinstance(value, list):
        raise Undefined
    if isinstance(value, Dual):
        below = _over(value.value)
        return Dual(below, -(below * below) * value.slope)
    return Fraction(1) / value


def _plus(left: Any, right: Any) -> Any:
    if isinstance(left, list) != isinstance(right, list):
        raise Undefined
    if not isinstance(left, list):
        return left + right
    return [[a + b for a, b in zip(x, y, strict=True)] for x, y in zip(left, right, strict=True)]


def _times(left: Any, right: Any) -> Any:
    if not isinstance(left, list):
        left, right = right, left
        if not isinstance(left, list):
            return left * right
    if not isinstance(right, list):
        return [[right * entry for entry in row] for row in left]
    columns = list(zip(*right, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in left]


def _transposed(rows: list[list[Any]]) -> list[list[Any]]:
    return [list(row) for row in zip(*rows, strict=True)]


def _identity(size: int) -> list[list[Any]]:
    return [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]


def _determinant(rows: list[list[Any]]) -> Any:
    if len(rows) == 1:
        return rows[0][0]
    minors = ([row[:c] + row[c + 1 :] for row in rows[1:]] for c in range(len(rows)))
    return sum(
        (entry * _determinant(minor) * (-1) ** c for c, (entry, minor) in enumerate(zip(rows[0], minors, strict=True))),
        Fraction(0),
    )


def _hamilton(p: Sequence[Any], q: Sequence[Any]) -> list[Any]:
    """Return the product of quaternions by scalar and vector parts."""
    (p0, *u), (q0, *v) = p, q
    turned = [u[1] * v[2] + -(u[2] * v[1]), u[2] * v[0] + -(u[0] * v[2]), u[0] * v[1] + -(u[1] * v[0])]
    scalar = p0 * q0
    for a, b in zip(u, v, strict=True):
        scalar = scalar + -(a * b)
    return [scalar, *(p0 * b + q0 * a + c for a, b, c in zip(u, v, turned, strict=True))]


def _turning(q: Sequence[Any]) -> list[list[Any]]:
    """Return ``(q0^2 - |v|^2) 1 + 2 v v^T + 2 q0 skew(v)``."""
    q0, *v = q
    size = q0 * q0 + -(v[0] * v[0]) + -(v[1] * v[1]) + -(v[2] * v[2])
    skew = [[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]]
    places = range(3)
    return [
        [(size if i == j else Fraction(0)) + 2 * (v[i] * v[j]) + 2 * (q0 * skew[i][j]) for j in places] for i in places
    ]


def random_point(source: Random) -> RationalPoint:
    """Return a point of random small rationals."""

    def circle() -> tuple[Fraction, Fraction]:
        t = Fraction(source.randint(-9, 9), source.randint(1, 9))
        return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)

    def value() -> Fraction:
        return Fraction(source.choice([n for n in range(-12, 13) if n]), source.randint(1, 5))

    names = [*SYMBOLS, *(name for q in QUATERNIONS for name in q)]
    return RationalPoint(
        {name: circle() for name in (*ANGLES, *FUNCTIONS)}, {n: value() for n in names}, {f: value() for f in FUNCTIONS}
    )


def truth(left: Node, right: Node, source: Random, wanted: int = 3) -> bool | None:
    """Return whether two sides agree exactly at rational points; None if they are defined at too few of those drawn."""
    defined = 0
    for _ in range(4 * wanted):
        point = random_point(source)
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
