"""Values of parsed formulas (trees) at test points in double precision, to rule out most wrong repairs in milliseconds.

At a test point, a function of time and each of its derivatives have values that are independent of each other.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from random import Random
from typing import Any

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, is_derivative, walk
from symrot.checker.repair.dual import (
    Dual,
    UndefinedValue,
    absolute,
    arctangent,
    cosine,
    exponential,
    inverse,
    logarithm,
    minus,
    plain,
    power,
    sine,
    square_root,
)
from symrot.checker.repair.rows import (
    Rows,
    agree,
    column,
    determinant,
    dot,
    entries_of,
    inverted,
    is_matrix,
    mapped,
    needed,
    plus,
    rotation,
    rotation_of_quaternion,
    skew,
    times,
    transposed,
)
from symrot.exact.limits.operations import spend
from symrot.kinematics.hamilton import hamilton

__all__ = ["Point", "UndefinedValue", "agree", "entries_of", "points"]

DERIVATIVES = 6
"""Number of values for a function of time at a test point: its own value and those of its derivatives up to order 5."""

MOST_NESTED = 6
"""The largest number of nested derivatives: ``diff(diff(f, x), y)`` has two.

Each of them is computed at a copy of the test point with dual numbers, which triples the cost of a multiplication.
"""

GAUSS = {1: 20, 2: 18, 3: 16}
"""Number of nested integrals -> number of nodes of Gauss-Legendre quadrature for each of them.

The value for 3 also holds for more than three integrals.
"""


# -- trees ------------------------------------------------------------------------------------------------------------


@dataclass
class Point:
    """A test point at which trees are evaluated.

    Attributes
    ----------
    symbols : dict
        Name of a symbol, ``t`` included -> its value.
    functions : dict
        Name of a function of time -> its value and the values of its derivatives.
    definitions : mapping
        Name of a definition -> its tree.
    remembered : frozenset of int
        Identities (``id``) of the trees whose values are stored; these trees must live as long as the point.
    spent : list of int
        One number, for a budget: how many nodes were evaluated, each counted with ``weight``, and large nodes more than
        once. The list is shared by all points made from this one.
    weight : int
        The cost of multiplying two values, in float multiplications; each copy with dual numbers triples it.
    known : dict
        ``id`` of a tree, or name of a definition -> its stored value.
    lifted : dict
        (name, order of the derivative) of a variable -> the copy of the point with dual numbers for this variable.
    """

    symbols: dict[str, Any]
    functions: dict[str, tuple[Any, ...]]
    definitions: Mapping[str, Node]
    remembered: frozenset[int] = frozenset()
    spent: list[int] = field(default_factory=lambda: [0])
    weight: int = 1
    known: dict[Any, Any] = field(default_factory=dict)
    lifted: dict[Any, "Point"] = field(default_factory=dict)

    def value(self, node: Node) -> Any:
        """Return the value of a tree at the point: a number, or the rows of a matrix.

        Raises
        ------
        UndefinedValue
            If the tree has no value at the point.
        """
        try:
            return self._value(node)
        except (ZeroDivisionError, OverflowError, TypeError, ValueError, IndexError, KeyError) as reason:
            raise UndefinedValue(str(reason)) from None

    def _value(self, node: Node) -> Any:
        key = id(node)
        if key in self.known:
            return self.known[key]
        weight = self.weight * (1 + len(node.args) // 4)  # long sums and products cost more
        self.spent[0] += weight
        spend(weight)
        value = _VALUE[node.kind](self, node)
        if key in self.remembered:
            self.known[key] = value
        return value

    def redefined(self, name: str, node: Node) -> "Point":
        """Return a copy of the point that evaluates ``name`` by the formula ``node`` instead of its definition."""
        return Point(self.symbols, self.functions, {**self.definitions, name: node}, spent=self.spent)

    def with_slopes(self, variable: Node) -> "Point":
        """Return a copy of the point whose values are dual numbers, with derivatives with respect to ``variable``.

        The variable is a symbol, ``f(t)`` or ``diff(f(t), t)``. Raise UndefinedValue if it has no value at the point,
        or if the copy would be for more than MOST_NESTED nested derivatives.
        """
        order = 0
        inner = variable
        while is_derivative(inner):
            order += len(inner.args) - 1
            inner = inner.args[0]
        name = inner.value
        key = (name, order)
        if self.weight >= 3**MOST_NESTED:
            raise UndefinedValue(
                f"expected at most {MOST_NESTED} nested derivatives (diff(diff(f, x), y) has two), got more"
            )
        if key not in self.lifted:
            in_time = name == "t" and not order
            if not in_time and name not in self.symbols and name not in self.functions:
                raise UndefinedValue(
                    f"expected a derivative with respect to a name that has a value, got {name!r}, which has none"
                )
            self.lifted[key] = Point(
                {s: Dual(v, float(s == name)) for s, v in self.symbols.items()},
                {
                    f: tuple(Dual(v, w) for v, w in pairwise(jet)) if in_time
                    else tuple(Dual(v, float(f == name and k == order)) for k, v in enumerate(jet))
                    for f, jet in self.functions.items()
                },
                self.definitions,
                self.remembered,
                self.spent,
                3 * self.weight,
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
    raise UndefinedValue(name)


def _sum(point: Point, node: Node) -> Any:
    total = point._value(node.args[0])
    for term in node.args[1:]:
        total = plus(total, point._value(term))
    return total


def _product(point: Point, node: Node) -> Any:
    total = point._value(node.args[0])
    for factor in node.args[1:]:
        total = times(total, point._value(factor))
    return total


def _raised(point: Point, node: Node) -> Any:
    base, exponent = (point._value(part) for part in node.args)
    if not is_matrix(base) and any(part.kind in ("name", "call") for _, part in walk(node.args[1])):
        return exponential(exponent * logarithm(base))
    if not is_matrix(base):
        return power(base, plain(exponent))
    result = base = inverted(base) if exponent < 0 else base
    for _ in range(int(abs(exponent)) - 1):
        result = times(result, base)
    return result


def _index(point: Point, node: Node) -> Any:
    rows = needed(point._value(node.args[0]))
    places = [int(plain(point._value(index))) for index in node.args[1:]]
    if len(places) == 1:
        places = [places[0], 0] if len(rows[0]) == 1 else [0, places[0]]
    return rows[places[0]][places[1]]


def _list(point: Point, node: Node) -> Any:
    rows = [point._value(member) for member in node.args]
    if all(isinstance(row, list) for row in rows):
        if any(is_matrix(entry) for row in rows for entry in row):
            return _stacked([entry for (entry,) in rows])
        if len({len(row) for row in rows}) > 1:
            raise UndefinedValue("expected rows of equal length in a matrix, got unequal ones")
        return tuple(map(tuple, rows))
    return _stacked(rows) if node.value == ("(", ")") else rows


def _stacked(parts: Sequence[Any]) -> Rows:
    """Return one column matrix with the numbers and columns ``parts`` below each other: a quaternion from (s, v)."""
    entries: list[Any] = []
    for part in parts:
        entries += [entry for (entry,) in needed(part, (None, 1))] if is_matrix(part) else [part]
    return column(entries)


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
        if len(arguments) == 1 and is_matrix(arguments[0]):
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
    lifted = _differentiated(point.with_slopes(last), formula, rest)
    return mapped(lambda entry: entry.slope if isinstance(entry, Dual) else 0.0, lifted)


def _integrated(point: Point, integrand: Node, ranges: Sequence[Node]) -> Any:
    """Return the integral of ``integrand`` over ``ranges`` at a test point, by Gauss-Legendre quadrature.

    Each range is a list (variable, lower limit, upper limit), the outermost first. The test point gives the values of
    all other symbols.
    """
    import numpy as np  # for integrals and hypotheses alone, since its import takes longer than most checks

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
    return Dual(_summed(values.value), _summed(values.slope)) if isinstance(values, Dual) else float(values.sum())


def _matrix(rows: Any) -> Rows:
    return _stacked(rows) if isinstance(rows, list) else needed(rows)


def _cross(left: Any, right: Any) -> Rows:
    (a,), (b,), (c,) = needed(left, (3, 1))
    product: Rows = times(skew(a, b, c), needed(right, (3, 1)))
    return product


def _hstack(*parts: Any) -> Rows:
    return tuple(tuple(entry for part in row for entry in part) for row in zip(*map(needed, parts), strict=True))


def _product_of_quaternions(*factors: Any) -> Rows:
    total: tuple[Any, ...] = (1.0, 0.0, 0.0, 0.0)
    for factor in factors:
        total = hamilton(total, _components(factor))
    return column(total)


def _components(quaternion: Any) -> list[Any]:
    """Return the four components of a quaternion; a vector gets the scalar component zero."""
    entries = [entry for (entry,) in needed(quaternion, (None, 1))]
    return [0.0, *entries] if len(entries) == 3 else [entry for (entry,) in needed(quaternion, (4, 1))]


def _conjugate(quaternion: Any) -> Rows:
    scalar, *vector = _components(quaternion)
    return column([scalar, *map(minus, vector)])


def _length(value: Any) -> Any:
    """Return the absolute value of a scalar, or the length of a column."""
    if not is_matrix(value):
        return absolute(value)
    entries = [entry for (entry,) in needed(value, (None, 1))]
    return square_root(dot(entries, entries))


def _other_leg(x: Any) -> Any:
    return square_root(1.0 + -(x * x))


def _hyperbolic(x: Any) -> tuple[Any, Any]:
    """Return (sinh x, cosh x)."""
    growing, decaying = exponential(x), exponential(-x)
    return (growing + -decaying) * 0.5, (growing + decaying) * 0.5


_SPREAD: dict[str, Callable[..., Any]] = {"skew": skew, "dcm_of": rotation_of_quaternion}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": sine, "cos": cosine, "sqrt": square_root, "abs": _length, "atan2": arctangent, "Matrix": _matrix,
    "cross": _cross,
    "exp": exponential, "log": logarithm, "atan": lambda x: arctangent(x, 1.0),
    "asin": lambda x: arctangent(x, _other_leg(x)), "acos": lambda x: arctangent(_other_leg(x), x),
    "sinh": lambda x: _hyperbolic(x)[0], "cosh": lambda x: _hyperbolic(x)[1],
    "tanh": lambda x: _hyperbolic(x)[0] * inverse(_hyperbolic(x)[1]),
    "tan": lambda x: sine(x) * inverse(cosine(x)), "cot": lambda x: cosine(x) * inverse(sine(x)),
    "sec": lambda x: inverse(cosine(x)), "csc": lambda x: inverse(sine(x)),
    **{name: rotation("XYZ".index(axis)) for name, axis in ROTATIONS.items()},
    "hstack": _hstack, "qmul": _product_of_quaternions, "conjugate": _conjugate,
    "vector_part": lambda q: column(_components(q)[1:]),
    "vee": lambda rows: column([needed(rows, (3, 3))[2][1], rows[0][2], rows[1][0]]),
    "dot": lambda a, b: dot([row[0] for row in needed(a, (None, 1))], [row[0] for row in needed(b, (None, 1))]),
    "det": lambda rows: determinant(needed(rows)), "inverse": lambda rows: inverted(needed(rows)),
    "adjugate": lambda rows: times(determinant(needed(rows)), inverted(needed(rows))),
    "transpose": transposed, "trace": lambda rows: sum((row[i] for i, row in enumerate(needed(rows))), 0.0),
    "eye": lambda n: tuple(tuple(float(i == j) for j in range(int(n))) for i in range(int(n))),
    "diag": lambda *d: tuple(tuple(d[i] if i == j else 0.0 for j in range(len(d))) for i in range(len(d))),
}  # fmt: skip
_VALUE: dict[str, Callable[[Point, Node], Any]] = {
    "number": lambda point, node: float(node.value), "name": _name, "sum": _sum, "product": _product,
    "neg": lambda point, node: mapped(minus, point._value(node.args[0])),
    "inv": lambda point, node: inverse(point._value(node.args[0])), "power": _raised, "index": _index, "list": _list,
    "transpose": lambda point, node: transposed(point._value(node.args[0])), "call": _call,
}  # fmt: skip


# -- points -----------------------------------------------------------------------------------------------------------


def points(
    symbols: Sequence[str], functions: Sequence[str], definitions: Mapping[str, Node],
    hypotheses: Sequence[tuple[Node, Node]], remembered: frozenset[int], count: int = 2, most: float = 1.7,
) -> list[Point]:  # fmt: skip
    """Return random test points, the same in every run, at which the hypotheses hold up to errors of 1e-12.

    There may be fewer than ``count`` points, since Newton's method may fail. Symbols have values from 0.3 to ``most``,
    before the hypotheses move them. ``remembered`` has the ids of the trees whose values each point stores.
    """
    accepted = []
    for seed in range(3 * count):
        source = Random(seed)
        point = Point(
            {name: source.uniform(0.3, most) for name in symbols},
            {name: tuple(source.uniform(0.3, 1.3) for _ in range(DERIVATIVES)) for name in functions},
            definitions,
            remembered,
        )
        moved = _onto_hypotheses(point, hypotheses)
        if moved is not None:
            accepted.append(moved)
        if len(accepted) == count:
            break
    return accepted


def _onto_hypotheses(point: Point, hypotheses: Sequence[tuple[Node, Node]]) -> Point | None:
    """Return a point near ``point`` at which the hypotheses hold, by Newton's method; None if the method fails."""
    if not hypotheses:
        return point
    import numpy as np

    variables = [Node("name", name) for name in point.symbols]
    variables += [Node("call", name, (Node("name", "t"),)) for name in point.functions]
    for _ in range(30):
        residuals, slopes = [], []
        try:
            for left, right in hypotheses:
                difference = plus(point.value(left), mapped(minus, point.value(right)))
                residuals += entries_of(difference)
                columns = []
                for variable in variables:
                    lifted = point.with_slopes(variable)
                    change = plus(lifted.value(left), mapped(minus, lifted.value(right)))
                    columns.append(entries_of(mapped(lambda x: x.slope if isinstance(x, Dual) else 0.0, change)))
                slopes += list(zip(*columns, strict=True))
        except UndefinedValue:
            return None
        if not np.isfinite([*residuals, *(slope for row in slopes for slope in row)]).all():
            return None  # beyond the range of double precision
        if max(map(abs, residuals)) < 1e-14:
            return point
        step = np.linalg.lstsq(np.array(slopes), -np.array(residuals), rcond=None)[0]
        moves = dict(zip([variable.value for variable in variables], map(float, step), strict=True))
        point = Point(
            {name: value + moves[name] for name, value in point.symbols.items()},
            {name: (jet[0] + moves[name], *jet[1:]) for name, jet in point.functions.items()},
            point.definitions,
            point.remembered,
            point.spent,
        )
    return None if max(map(abs, residuals)) > 1e-12 else point
