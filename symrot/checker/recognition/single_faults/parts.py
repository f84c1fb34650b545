"""Faults of single parts of a formula: the value that a part should have, and the short change that gives it.

If the right values of a sum and of all its terms but one are known, the right values of this term follow; likewise for
factors and arguments. So the search goes inward from the whole formula. Its results are not yet proven.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from typing import Any, NamedTuple

from symrot.checker.claim.tree import TIME, Node, Path, is_derivative, negated, number, product
from symrot.checker.repair.dual import minus
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.trees import scaled
from symrot.checker.repair.filter import at, matrix_entries
from symrot.checker.repair.points import Point, UndefinedValue
from symrot.checker.repair.rows import entries_of, is_matrix, mapped, plus, shape_of, times

__all__ = [
    "Change",
    "Letters",
    "Part",
    "PointOfLetters",
    "Values",
    "is_multiple",
    "is_superfluous",
    "multiples",
    "near",
    "parts",
    "rates_of_entries",
    "rational",
    "values_of",
]

CLOSE = 1e-9
"""The largest relative difference between values that count as equal."""
LARGEST = 400
"""The largest numerator and denominator of a rational number that is recognised by its value."""

HALVES = {Fraction(2): "half_angle", Fraction(1, 2): "double_half_angle"}
"""Factor that an angle by an inverse function should have -> the fault of a formula without this factor."""

Values = tuple[Any, ...]
"""One value for each point: numbers, or rows of matrices."""


class Part(NamedTuple):
    """A part of a claim's formula, with its values and the values that it should have at the test points."""

    path: Path
    node: Node
    values: Values
    needed: Values  # the whole formula has its right values with these, if only this part is wrong
    parent: str  # the kind of the node above, such as "sum"


class Change(NamedTuple):
    """A correction of a part: the tree ``made`` that takes the part's place, and the code and the cost of the fault."""

    made: Node
    code: str
    cost: float  # larger for less usual faults


@dataclass(frozen=True)
class Letters:
    """The symbols and rates of a formula, and the angles in its sines and cosines, with values at test points."""

    atoms: Mapping[Node, Values]
    angles: Mapping[Node, Values]
    points: Sequence[Point]
    aliases: Mapping[Node, Values] = field(default_factory=dict)  # names of formulas, such as c1 for cos(alpha)

    @property
    def names(self) -> list[str]:
        return [str(node.value) for node in self.atoms if node.kind == "name"]


@dataclass
class PointOfLetters(Point):
    """A test point at which a rate such as ``diff(phi(t), t)`` has a random value of its own."""

    rates: Mapping[Node, float] = field(default_factory=dict)

    def _value(self, node: Node) -> Any:
        if node.kind == "call" and node in self.rates:
            return self.rates[node]
        if is_derivative(node) and str(node.args[0].value) in self.definitions:
            return super()._value(rates_of_entries(self.definitions[str(node.args[0].value)], node.args[1:]))
        return super()._value(node)


def rates_of_entries(tree: Node, variables: tuple[Node, ...]) -> Node:
    """Return the time derivative of a matrix of functions of time, written out entry by entry."""
    if tree.kind == "call" and tree.args == (TIME,):
        return Node("call", "diff", (tree, *variables))
    return replace(tree, args=tuple(rates_of_entries(child, variables) for child in tree.args))


def values_of(node: Node, points: Sequence[Point]) -> Values | None:
    """Return the values of a tree at the points, or None if the tree has no value at one of them."""
    try:
        return tuple(point.value(node) for point in points)
    except UndefinedValue:
        return None


def parts(tree: Node, points: Sequence[Point], needed: Values, path: Path = (), parent: str = "") -> Iterator[Part]:
    """Yield the parts of a formula whose right values follow from ``needed``, those of the whole formula, each with
    these values.
    """
    values = values_of(tree, points)
    if values is None or [*map(shape_of, values)] != [*map(shape_of, needed)]:
        return
    yield Part(path, tree, values, needed, parent)  # in the sum a + b, the right value of a is the whole minus b
    for own, child, inner in _children(tree, points, values, needed):
        if inner is not None:
            yield from parts(child, points, inner, (*path, *own), tree.kind if len(own) == 1 else "list")


def _children(
    tree: Node, points: Sequence[Point], values: Values, needed: Values
) -> Iterator[tuple[Path, Node, Values | None]]:
    """Yield (path, child, values that the child should have) for each child of a part, or for the only wrong entry of a
    matrix. The values are None if nothing determines them.
    """
    cells = matrix_entries(tree) or ({n: (n,) for n in range(len(tree.args))} if tree.kind == "list" else {})
    if cells:
        lists = [[*map(entries_of, side)] for side in (values, needed)]
        wrong = [n for n in cells if not all(near(a[n], b[n]) for a, b in zip(*lists, strict=True))]
        cell = at(tree, cells[wrong[0]]) if len(wrong) == 1 else None
        if cell is not None:
            yield cells[wrong[0]], cell, tuple(entries[wrong[0]] for entries in lists[1])
        return
    if tree.kind == "product" and is_matrix(needed[0]) and (row := _wrong_row(values, needed)) is not None:
        yield from _row_of_matrix(tree, points, values, needed, row)
    inward = _INWARD.get((tree.kind, tree.value if tree.kind == "call" else None))
    if inward is None:
        return
    arguments = [values_of(child, points) for child in tree.args]
    if any(values is None for values in arguments):
        return
    by_point = list(zip(*(values or () for values in arguments), strict=True))
    for place, child in enumerate(tree.args):
        try:
            inner = tuple(inward(own, place, value) for own, value in zip(by_point, needed, strict=True))
        except (ArithmeticError, ValueError, TypeError, UndefinedValue, IndexError):
            inner = (None,)
        yield (place,), child, None if any(value is None for value in inner) else inner


def _wrong_row(values: Values, needed: Values) -> int | None:
    """Return the index of the only row in which columns ``values`` and ``needed`` differ. None in other cases."""
    pairs = [(entries_of(value), entries_of(other)) for value, other in zip(values, needed, strict=True)]
    wrong = [n for n in range(len(pairs[0][0])) if not all(near(a[n], b[n]) for a, b in pairs)]
    return wrong[0] if len(wrong) == 1 and (shape_of(values[0]) or (0, 0))[1] == 1 else None


def _row_of_matrix(
    tree: Node, points: Sequence[Point], values: Values, needed: Values, row: int
) -> Iterator[tuple[Path, Node, Values | None]]:
    """Yield (path, entry, needed values) for the matrix entries in a row, where ``tree`` is a matrix times a column."""
    # tree is the product of the matrix and the column
    place, matrix = next(((n, part) for n, part in enumerate(tree.args) if matrix_entries(part)), (0, tree))
    others = [part for n, part in enumerate(tree.args) if n != place]
    columns = values_of(product(others), points) if place < len(tree.args) - 1 else None
    rows = values_of(matrix, points) if matrix is not tree else None
    if columns is None or rows is None or any(shape_of(column) != (len(row_of[0]), 1)
                                              for column, row_of in zip(columns, rows, strict=True)):  # fmt: skip
        return
    cells = matrix_entries(matrix)
    for n in range(len(rows[0][0])):
        factors = [column[n][0] for column in columns]
        cell = at(matrix, cells[row * len(rows[0][0]) + n])
        if cell is not None and all(factors):
            # the values that make the product right, if only this entry changes
            lacking = [other[row][0] - value[row][0] for value, other in zip(values, needed, strict=True)]
            entries = [own[row][n] + less / factor for own, less, factor in zip(rows, lacking, factors, strict=True)]
            yield (place, *cells[row * len(rows[0][0]) + n]), cell, tuple(entries)


def _of_sum(arguments: Sequence[Any], place: int, needed: Any) -> Any:
    others = [mapped(minus, value) for n, value in enumerate(arguments) if n != place]
    return reduce(plus, others, needed)


def _of_product(arguments: Sequence[Any], place: int, needed: Any) -> Any:
    others = [value for n, value in enumerate(arguments) if n != place]
    matrices = [value for value in others if is_matrix(value)]
    own = arguments[place]
    if not matrices:
        divisor = math.prod(others)
        return mapped(lambda entry: entry / divisor, needed)
    if is_matrix(own):
        return None
    return _ratio(needed, reduce(times, others))


def _ratio(left: Any, right: Any) -> float | None:
    """Return the number ``left / right`` for scalars or proportional matrices; None if there is no such number."""
    if not is_matrix(left):
        return left / right if right else None
    pairs = list(zip(entries_of(left), entries_of(right), strict=True))
    ratio = next((a / b for a, b in pairs if b), None)
    return ratio if ratio is not None and all(near(a, ratio * b) for a, b in pairs) else None


def _of_power(arguments: Sequence[Any], place: int, needed: Any) -> Any:
    base, exponent = arguments
    if place or is_matrix(base) or not exponent:
        return None
    size = abs(needed) ** (1 / exponent)
    even = float(exponent).is_integer() and exponent % 2 == 0
    return None if needed < 0 and even else math.copysign(size, base if even else needed)


_INWARD: dict[tuple[str, str | None], Callable[[Sequence[Any], int, Any], Any]] = {
    ("sum", None): _of_sum, ("product", None): _of_product, ("power", None): _of_power,
    ("neg", None): lambda arguments, place, needed: mapped(minus, needed),
    ("inv", None): lambda arguments, place, needed: 1 / needed,
    ("call", "sqrt"): lambda arguments, place, needed: needed**2,
    ("call", "acos"): lambda arguments, place, needed: math.cos(needed),
    ("call", "asin"): lambda arguments, place, needed: math.sin(needed),
    ("call", "atan"): lambda arguments, place, needed: math.tan(needed),
    ("call", "atan2"): lambda arguments, place, needed: (
        arguments[0] / math.tan(needed) if place else arguments[1] * math.tan(needed)
    ),
    ("call", "abs"): lambda arguments, place, needed: math.copysign(needed, arguments[0]),
}  # fmt: skip
"""Kind of a part, and its function -> the value that an argument should have, from that of the part."""


def is_superfluous(part: Part) -> bool:
    """Return whether a part should be left out: a term that should be 0, or a factor that should be 1."""
    neutral = {"sum": 0.0, "product": 1.0}.get(part.parent)
    if neutral is None or any(map(is_matrix, part.needed)) or part.node.kind == "number":
        return False
    size = max(map(abs, part.values))
    return all(abs(value - neutral) <= CLOSE * (size + neutral) for value in part.needed)


def is_multiple(part: Part) -> bool:
    """Return whether a part's needed values are its values times one number other than 1."""
    ratios = [_ratio(needed, value) for value, needed in zip(part.values, part.needed, strict=True)]
    first = ratios[0]
    return first is not None and abs(first - 1) > CLOSE and all(r is not None and near(r, first) for r in ratios)


def multiples(part: Part) -> Iterator[Change]:
    """Yield the change of a part's sign or numeric factor that gives the part its needed values, if there is one."""
    ratio = rational(tuple(_ratio(b, a) or 0.0 for a, b in zip(part.values, part.needed, strict=True)))
    if ratio is None or ratio == 1 or (ratio < 0 and ratio != -1) or part.node.kind == "neg":
        return
    if part.node.kind == "number":
        value = ratio * part.node.value
        if value > 0:
            size = 0.0 if ratio in (2, Fraction(1, 2)) else COST["per_factor_e"] * abs(math.log(ratio))
            cost = COST["factor"] + size
            yield Change(number(value), "factor", cost + COST["no_integer"] * (value.denominator > 1))
    elif part.parent not in ("product", "power", "inv") or part.node.kind == "sum":  # else the whole term is changed
        if ratio == -1:
            yield Change(negated(part.node), "sign_of_term", COST["sign_of_term"])
        else:
            cost = COST["solved_factor_2" if ratio in (2, Fraction(1, 2)) else "solved_rational_factor"]
            is_angle = part.node.value in ("acos", "asin", "atan", "atan2")
            yield Change(scaled(part.node, ratio), HALVES.get(ratio, "factor") if is_angle else "factor", cost)


def rational(values: Sequence[float]) -> Fraction | None:
    """Return the rational number that all values equal: 1/3 for 0.3333333333. None if there is no simple one."""
    first = values[0]
    if not math.isfinite(first) or not 1e-4 < abs(first) < 1e4:
        return None
    ratio = Fraction(first).limit_denominator(LARGEST)
    fits = all(near(value, float(ratio)) for value in values)
    return ratio if fits and ratio and abs(ratio.numerator) <= LARGEST else None


def near(left: float, right: float) -> bool:
    """Return whether two values agree to about nine digits."""
    return abs(left - right) <= CLOSE * (abs(left) + abs(right))
