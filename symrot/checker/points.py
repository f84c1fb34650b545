"""The value of a tree at a point in double precision, in milliseconds: a sieve for repairs, which are proven elsewhere.

Derivatives are taken by dual numbers: to differentiate is to evaluate again with every value lifted to ``x + x' e``.
A function of time is given by its value and its first derivatives, all independent.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from random import Random
from typing import Any

import numpy as np

from symrot.checker.tree import Node

__all__ = ["Meaningless", "Point", "agree", "entries_of", "points"]

DERIVATIVES = 6
"""Derivatives of each function of time that a point holds, the value included."""

GAUSS = {1: 20, 2: 18, 3: 16}
"""Nodes of Gauss and Legendre's rule in each direction, by the number of nested integrals."""
CLOSE = 1e-8


class Meaningless(ValueError):
    """A tree without a value at a point: shapes that do not fit, a root of a negative number, an unknown name."""


@dataclass(frozen=True, slots=True)
class Dual:
    """``value + slope e`` with ``e^2 = 0``; both parts may be dual again."""

    value: Any
    slope: Any

    def __add__(self, other: Any) -> "Dual":
        other = _dual(other)
        return Dual(self.value + other.value, self.slope + other.slope)

    def __neg__(self) -> "Dual":
        return Dual(-self.value, -self.slope)

    def __mul__(self, other: Any) -> "Dual":
        other = _dual(other)
        return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)

    __radd__, __rmul__ = __add__, __mul__
    __array_ufunc__ = None  # an array leaves sums and products with a dual number to this class


def _dual(value: Any) -> Dual:
    return value if isinstance(value, Dual) else Dual(value, 0)


def _inverse(x: Any) -> Any:
    if isinstance(x, Dual):
        below = _inverse(x.value)
        return Dual(below, -(below * below) * x.slope)
    return 1.0 / x


def _minus(x: Any) -> Any:
    return -x


def _plainly(function: Any, x: Any) -> Any:
    """Return a function of a number, or of the numbers of a grid."""
    return function(x) if isinstance(x, np.ndarray) else getattr(math, function.__name__)(x)


def _sin(x: Any) -> Any:
    return Dual(_sin(x.value), _cos(x.value) * x.slope) if isinstance(x, Dual) else _plainly(np.sin, x)


def _cos(x: Any) -> Any:
    return Dual(_cos(x.value), -_sin(x.value) * x.slope) if isinstance(x, Dual) else _plainly(np.cos, x)


def _sqrt(x: Any) -> Any:
    if isinstance(x, Dual):
        root = _sqrt(x.value)
        return Dual(root, _inverse(2.0 * root) * x.slope)
    return _plainly(np.sqrt, x)


def _abs(x: Any) -> Any:
    if isinstance(x, np.ndarray):
        return np.abs(x)
    return -x if _plain(x) < 0 else x


def _plain(x: Any) -> float:
    while isinstance(x, Dual):
        x = x.value
    return float(x)


def _atan2(y: Any, x: Any) -> Any:
    if isinstance(y, Dual) or isinstance(x, Dual):
        y, x = _dual(y), _dual(x)
        below = _inverse(x.value * x.value + y.value * y.value)
        return Dual(_atan2(y.value, x.value), (x.value * y.slope + -(y.value * x.slope)) * below)
    return math.atan2(y, x)


def _power(x: Any, exponent: float) -> Any:
    if exponent == int(exponent) and abs(exponent) <= 64:
        whole = int(exponent)
        result: Any = 1.0
        for _ in range(abs(whole)):
            result = result * x
        return result if whole >= 0 else _inverse(result)
    if isinstance(x, Dual):
        return Dual(_power(x.value, exponent), exponent * _power(x.value, exponent - 1) * x.slope)
    if np.any(x < 0):
        raise Meaningless("a fractional power of a negative number")
    return x**exponent


# -- matrices, as tuples of rows --------------------------------------------------------------------------------------

Rows = tuple[tuple[Any, ...], ...]


def _is_matrix(value: Any) -> bool:
    return isinstance(value, tuple)


def entries_of(value: Any) -> list[float]:
    """Return the entries of a value row by row, as numbers."""
    return [_plain(entry) for row in value for entry in row] if _is_matrix(value) else [_plain(value)]


def _shape(value: Any) -> tuple[int, int] | None:
    return (len(value), len(value[0])) if _is_matrix(value) else None


def _map(function: Callable[[Any], Any], value: Any) -> Any:
    return tuple(tuple(function(entry) for entry in row) for row in value) if _is_matrix(value) else function(value)


def _plus(left: Any, right: Any) -> Any:
    if _shape(left) != _shape(right):
        raise Meaningless("shapes in a sum")
    if _is_matrix(left):
        return tuple(tuple(a + b for a, b in zip(x, y, strict=True)) for x, y in zip(left, right, strict=True))
    return left + right


def _times(left: Any, right: Any) -> Any:
    if not _is_matrix(left):
        return _map(lambda entry: left * entry, right)
    if not _is_matrix(right):
        return _map(lambda entry: entry * right, left)
    if len(left[0]) != len(right):
        raise Meaningless("shapes in a product")
    columns = tuple(zip(*right, strict=True))
    return tuple(tuple(_dot(row, column) for column in columns) for row in left)


def _dot(left: Sequence[Any], right: Sequence[Any]) -> Any:
    total: Any = 0.0
    for a, b in zip(left, right, strict=True):
        total = total + a * b
    return total


def _transposed(value: Any) -> Rows:
    return tuple(zip(*_need(value), strict=True))


def _need(value: Any, shape: tuple[int | None, int | None] = (None, None)) -> Rows:
    found = _shape(value)
    if found is None or any(want not in (None, got) for want, got in zip(shape, found, strict=True)):
        raise Meaningless("a matrix of another shape")
    rows: Rows = value
    return rows


def _determinant(rows: Rows) -> Any:
    if len(rows) != len(rows[0]) or len(rows) > 6:
        raise Meaningless("a determinant")
    if len(rows) == 1:
        return rows[0][0]
    total: Any = 0.0
    for column, entry in enumerate(rows[0]):
        minor = tuple((*row[:column], *row[column + 1 :]) for row in rows[1:])
        total = total + (entry * _determinant(minor)) * (-1.0) ** column
    return total


def _inverted(rows: Rows) -> Rows:
    below = _inverse(_determinant(rows))
    size = range(len(rows))
    if len(rows) == 1:
        return ((below,),)
    return tuple(
        tuple(
            _determinant(tuple((*rows[r][:i], *rows[r][i + 1 :]) for r in size if r != j)) * below * (-1.0) ** (i + j)
            for j in size
        )
        for i in size
    )


def _column(values: Sequence[Any]) -> Rows:
    return tuple((value,) for value in values)


def _skew(a: Any, b: Any, c: Any) -> Rows:
    return ((0.0, -c, b), (c, 0.0, -a), (-b, a, 0.0))


def _rotation(axis: int) -> Callable[[Any], Rows]:
    def turn(angle: Any) -> Rows:
        c, s = _cos(angle), _sin(angle)
        rows = [[0.0] * 3 for _ in range(3)]
        i, j = (axis + 1) % 3, (axis + 2) % 3
        rows[axis][axis], rows[i][i], rows[j][j], rows[i][j], rows[j][i] = 1.0, c, c, -s, s
        return tuple(map(tuple, rows))

    return turn


def _qmul(p: Sequence[Any], q: Sequence[Any]) -> list[Any]:
    a, b, c, d = p
    e, f, g, h = q
    return [
        a * e + -(b * f) + -(c * g) + -(d * h), a * f + b * e + c * h + -(d * g),
        a * g + -(b * h) + c * e + d * f, a * h + b * g + -(c * f) + d * e,
    ]  # fmt: skip


def _dcm_of(*q: Any) -> Rows:
    a, b, c, d = q
    conjugate = [a, -b, -c, -d]
    columns = [_qmul(_qmul(q, [0.0, *(float(i == j) for j in range(3))]), conjugate)[1:] for i in range(3)]
    return tuple(zip(*columns, strict=True))


# -- trees ------------------------------------------------------------------------------------------------------------


@dataclass
class Point:
    """Values of symbols (``t`` too), of functions of time with their derivatives, and the trees of definitions.

    Values of the trees in ``kept`` (by identity: they live as long as the point) are remembered.
    """

    symbols: dict[str, Any]
    functions: dict[str, tuple[Any, ...]]
    definitions: Mapping[str, Node]
    kept: frozenset[int] = frozenset()
    spent: list[int] = field(default_factory=lambda: [0])  # pieces evaluated, shared by all points made of this one
    known: dict[Any, Any] = field(default_factory=dict)
    lifted: dict[Any, "Point"] = field(default_factory=dict)

    def value(self, node: Node) -> Any:
        """Return a number or the rows of a matrix.

        Raises
        ------
        Meaningless
            Where there is no value.
        """
        try:
            return self._value(node)
        except (ZeroDivisionError, OverflowError, TypeError, ValueError, IndexError, KeyError) as reason:
            raise Meaningless(str(reason)) from None

    def _value(self, node: Node) -> Any:
        key = id(node)
        if key in self.known:
            return self.known[key]
        self.spent[0] += 1
        value = _VALUE[node.kind](self, node)
        if key in self.kept:
            self.known[key] = value
        return value

    def redefined(self, name: str, node: Node) -> "Point":
        """Return the point with one definition replaced."""
        return Point(self.symbols, self.functions, {**self.definitions, name: node}, spent=self.spent)

    def raised(self, variable: Node) -> "Point":
        """Return the point lifted to dual numbers along a variable: a symbol, ``f(t)``, or ``diff(f(t), t)``."""
        order = 0
        inner = variable
        while inner.kind == "call" and inner.value == "diff":
            order += len(inner.args) - 1
            inner = inner.args[0]
        name = inner.value
        key = (name, order)
        if key not in self.lifted:
            in_time = name == "t" and not order
            if not in_time and name not in self.symbols and name not in self.functions:
                raise Meaningless("a variable to differentiate by")
            self.lifted[key] = Point(
                {s: Dual(v, float(s == name)) for s, v in self.symbols.items()},
                {
                    f: tuple(Dual(v, w) for v, w in pairwise(jet)) if in_time
                    else tuple(Dual(v, float(f == name and k == order)) for k, v in enumerate(jet))
                    for f, jet in self.functions.items()
                },
                self.definitions,
                self.kept,
                self.spent,
            )  # fmt: skip
        return self.lifted[key]


def _name(point: Point, node: Node) -> Any:
    name = node.value
    if name in point.symbols:
        return point.symbols[name]
    if name in point.definitions:
        if name not in point.known:
            point.known[name] = point._value(point.definitions[name])
        return point.known[name]
    if name == "pi":
        return math.pi
    raise Meaningless(name)


def _sum(point: Point, node: Node) -> Any:
    total = point._value(node.args[0])
    for term in node.args[1:]:
        total = _plus(total, point._value(term))
    return total


def _product(point: Point, node: Node) -> Any:
    total = point._value(node.args[0])
    for factor in node.args[1:]:
        total = _times(total, point._value(factor))
    return total


def _raised(point: Point, node: Node) -> Any:
    base, exponent = (point._value(part) for part in node.args)
    if not _is_matrix(base):
        return _power(base, _plain(exponent))
    result = base = _inverted(base) if exponent < 0 else base
    for _ in range(int(abs(exponent)) - 1):
        result = _times(result, base)
    return result


def _index(point: Point, node: Node) -> Any:
    rows = _need(point._value(node.args[0]))
    places = [int(_plain(point._value(index))) for index in node.args[1:]]
    if len(places) == 1:
        places = [places[0], 0] if len(rows[0]) == 1 else [0, places[0]]
    return rows[places[0]][places[1]]


def _list(point: Point, node: Node) -> Any:
    rows = [point._value(member) for member in node.args]
    if all(isinstance(row, list) for row in rows):
        if len({len(row) for row in rows}) > 1:
            raise Meaningless("rows of unequal length")
        return tuple(map(tuple, rows))
    if node.value == ("(", ")"):
        return _column(rows)
    return rows


def _call(point: Point, node: Node) -> Any:
    name = node.value
    if name in point.functions:
        return point.functions[name][0]
    if name == "diff":
        formula, *variables = node.args
        return _differentiated(point, formula, variables)
    if name == "integrate":
        return _integrated(point, node.args[0], node.args[1:][::-1])
    arguments = [point._value(argument) for argument in node.args]
    if name in _SPREAD:
        if len(arguments) == 1 and _is_matrix(arguments[0]):
            arguments = [entry for row in arguments[0] for entry in row]
        return _SPREAD[name](*arguments)
    return _FUNCTIONS[name](*arguments)


def _differentiated(point: Point, formula: Node, variables: Sequence[Node]) -> Any:
    if not variables:
        return point._value(formula)
    *rest, last = variables
    if last.kind == "number":
        rest = [*rest, *[rest[-1]] * (int(last.value) - 1)]
        return _differentiated(point, formula, rest)
    lifted = _differentiated(point.raised(last), formula, rest)
    return _map(lambda entry: entry.slope if isinstance(entry, Dual) else 0.0, lifted)


def _integrated(point: Point, integrand: Node, ranges: Sequence[Node]) -> Any:
    """Return an integral over a box by Gauss and Legendre's rule, on the whole grid of points at once, outer first."""
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS[min(len(ranges), 3)])
    inner, total = point, np.ones((1,) * len(ranges))
    for axis, part in enumerate(ranges):
        shape = [len(nodes) if place == axis else 1 for place in range(len(ranges))]
        variable, lower, upper = part.args
        low, high = inner.value(lower), inner.value(upper)
        half, middle = (high + -low) * 0.5, (high + low) * 0.5
        symbols = {**inner.symbols, variable.value: middle + half * nodes.reshape(shape)}
        total = total * weights.reshape(shape) * half
        inner = Point(symbols, point.functions, point.definitions, spent=point.spent)
    return _summed(inner.value(integrand) * total)


def _summed(values: Any) -> Any:
    return Dual(_summed(values.value), _summed(values.slope)) if isinstance(values, Dual) else float(np.sum(values))


def _matrix(rows: Any) -> Rows:
    return _column(rows) if isinstance(rows, list) else _need(rows)


def _cross(left: Any, right: Any) -> Rows:
    (a,), (b,), (c,) = _need(left, (3, 1))
    found: Rows = _times(_skew(a, b, c), _need(right, (3, 1)))
    return found


def _hstack(*parts: Any) -> Rows:
    return tuple(tuple(entry for part in row for entry in part) for row in zip(*map(_need, parts), strict=True))


def _product_of_quaternions(*factors: Any) -> Rows:
    total = [1.0, 0.0, 0.0, 0.0]
    for factor in factors:
        total = _qmul(total, [row[0] for row in _need(factor, (4, 1))])
    return _column(total)


_SPREAD: dict[str, Callable[..., Any]] = {"skew": _skew, "dcm_of": _dcm_of}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": _sin, "cos": _cos, "sqrt": _sqrt, "abs": _abs, "atan2": _atan2, "Matrix": _matrix, "cross": _cross,
    "tan": lambda x: _sin(x) * _inverse(_cos(x)), "cot": lambda x: _cos(x) * _inverse(_sin(x)),
    "sec": lambda x: _inverse(_cos(x)), "csc": lambda x: _inverse(_sin(x)),
    "Rx": _rotation(0), "Ry": _rotation(1), "Rz": _rotation(2), "hstack": _hstack, "qmul": _product_of_quaternions,
    "vee": lambda rows: _column([_need(rows, (3, 3))[2][1], rows[0][2], rows[1][0]]),
    "dot": lambda a, b: _dot([row[0] for row in _need(a, (None, 1))], [row[0] for row in _need(b, (None, 1))]),
    "det": lambda rows: _determinant(_need(rows)), "inverse": lambda rows: _inverted(_need(rows)),
    "transpose": _transposed, "trace": lambda rows: sum((row[i] for i, row in enumerate(_need(rows))), 0.0),
    "eye": lambda n: tuple(tuple(float(i == j) for j in range(int(n))) for i in range(int(n))),
    "diag": lambda *d: tuple(tuple(d[i] if i == j else 0.0 for j in range(len(d))) for i in range(len(d))),
}  # fmt: skip
_VALUE: dict[str, Callable[[Point, Node], Any]] = {
    "number": lambda point, node: float(node.value), "name": _name, "sum": _sum, "product": _product,
    "neg": lambda point, node: _map(_minus, point._value(node.args[0])),
    "inv": lambda point, node: _inverse(point._value(node.args[0])), "power": _raised, "index": _index, "list": _list,
    "transpose": lambda point, node: _transposed(point._value(node.args[0])), "call": _call,
}  # fmt: skip


# -- points -----------------------------------------------------------------------------------------------------------


def agree(left: Any, right: Any) -> list[bool] | None:
    """Return entry by entry whether two values agree to double precision; None if their shapes differ."""
    lefts, rights = entries_of(left), entries_of(right)
    if _shape(left) != _shape(right):
        if not _is_matrix(left) and lefts == [0.0]:
            lefts = [0.0] * len(rights)
        elif not _is_matrix(right) and rights == [0.0]:
            rights = [0.0] * len(lefts)
        else:
            return None
    return [abs(a - b) <= CLOSE * (abs(a) + abs(b)) + 1e-11 for a, b in zip(lefts, rights, strict=True)]


def points(
    symbols: Sequence[str], functions: Sequence[str], definitions: Mapping[str, Node],
    hypotheses: Sequence[tuple[Node, Node]], kept: frozenset[int], count: int = 2,
) -> list[Point]:  # fmt: skip
    """Return seeded points that obey the hypotheses to double precision (fewer where Newton's method fails)."""
    found = []
    for seed in range(3 * count):
        source = Random(seed)
        point = Point(
            {name: source.uniform(0.3, 1.7) for name in symbols},
            {name: tuple(source.uniform(0.3, 1.3) for _ in range(DERIVATIVES)) for name in functions},
            definitions,
            kept,
        )
        settled = _settled(point, hypotheses)
        if settled is not None:
            found.append(settled)
        if len(found) == count:
            break
    return found


def _settled(point: Point, hypotheses: Sequence[tuple[Node, Node]]) -> Point | None:
    """Move a point onto its hypotheses by Newton's method with the shortest steps."""
    variables = [Node("name", name) for name in point.symbols]
    variables += [Node("call", name, (Node("name", "t"),)) for name in point.functions]
    for _ in range(30 if hypotheses else 0):
        residuals, slopes = [], []
        try:
            for left, right in hypotheses:
                difference = _plus(point.value(left), _map(_minus, point.value(right)))
                residuals += entries_of(difference)
                columns = []
                for variable in variables:
                    lifted = point.raised(variable)
                    change = _plus(lifted.value(left), _map(_minus, lifted.value(right)))
                    columns.append(entries_of(_map(lambda x: x.slope if isinstance(x, Dual) else 0.0, change)))
                slopes += list(zip(*columns, strict=True))
        except Meaningless:
            return None
        if max(map(abs, residuals)) < 1e-14:
            return point
        step = np.linalg.lstsq(np.array(slopes), -np.array(residuals), rcond=None)[0]
        moves = dict(zip([variable.value for variable in variables], map(float, step), strict=True))
        point = Point(
            {name: value + moves[name] for name, value in point.symbols.items()},
            {name: (jet[0] + moves[name], *jet[1:]) for name, jet in point.functions.items()},
            point.definitions,
            point.kept,
            point.spent,
        )
    return None if hypotheses and max(map(abs, residuals)) > 1e-12 else point
