"""Faults of single parts of a formula: the value that a part should have, and short changes to this value.

If the right values of a sum and of all its terms but one are known, the right values of this term follow; likewise for
factors and arguments. So the search goes inward from the whole formula. Its results are not yet proven.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, reduce
from typing import Any, NamedTuple

from symrot.checker.claim.tree import TIME, Node, Path, is_derivative, negated, number, product
from symrot.checker.repair.dual import minus
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.trees import scaled
from symrot.checker.repair.filter import at, matrix_entries
from symrot.checker.repair.points import Point, UndefinedValue
from symrot.checker.repair.rows import entries_of, is_matrix, mapped, plus, shape_of, times

__all__ = [
    "CLOSE", "NEUTRAL", "Correction", "Letters", "Part", "PointOfLetters", "Valued", "Values", "is_multiple",
    "is_superfluous", "multiples", "near", "parts", "rates_of_entries", "rational", "values_of",
]  # fmt: skip

CLOSE = 1e-9
"""The largest relative difference between values that count as equal."""
NEUTRAL = {"sum": 0.0, "product": 1.0}
"""Kind of an operation -> the value of an argument that does not change the result: 0 for a term, 1 for a factor."""
LARGEST = 400
"""The largest numerator and denominator of a rational number that is recognised by its value."""

HALVES = {Fraction(2): "half_angle", Fraction(1, 2): "double_half_angle"}
"""Factor that is missing before an inverse function -> the code of the fault.

For the claim ``theta = acos(u)``, right is ``2*acos(u)``: the factor 2 is missing, and the code is "half_angle".
"""

Values = tuple[Any, ...]
"""The values of a formula, one for each test point: each is a number, or a matrix as a tuple of rows."""


class Part(NamedTuple):
    """A part of a claim's formula, with its values and the values that it should have at the test points."""

    path: Path
    node: Node
    values: Values
    needed: Values  # the whole formula has its right values with these, if only this part is wrong
    parent: str  # the kind of the node above, such as "sum"


class Correction(NamedTuple):
    """A correction of one part of a claim's formula: the tree ``made`` replaces the part.

    ``code`` and ``cost`` are those of the corrected fault.
    """

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


@dataclass(eq=False)
class Valued:
    """A part of a formula with its values at the test points; each value is computed only once."""

    node: Node
    points: Sequence[Point]
    path: Path = ()  # from the whole formula to the part
    parent: str = ""  # the kind of the node above, such as "sum"

    @cached_property
    def values(self) -> Values | None:
        """The values of the formula ``node``, one for each of ``points``; None if it has no value at one of them."""
        return values_of(self.node, self.points)

    def child(self, path: Path) -> "Valued | None":
        """Return the part at a path inside this part, or None if there is no such path."""
        node = at(self.node, path)
        parent = self.node.kind if len(path) == 1 else "list"
        return None if node is None else Valued(node, self.points, (*self.path, *path), parent)

    @cached_property
    def entries(self) -> Mapping[int, "Valued"]:
        """{number: entry} if ``node`` is a written-out matrix or list, numbered row by row; otherwise empty.

        An entry without a node of its own, such as the zeros of ``diag(a, b, c)``, is left out.
        """
        paths = matrix_entries(self.node) or (
            {n: (n,) for n in range(len(self.node.args))} if self.node.kind == "list" else {}
        )
        return {n: entry for n, path in paths.items() if (entry := self.child(path)) is not None}

    @cached_property
    def arguments(self) -> Sequence[tuple["Valued", "Inward"]]:
        """Pairs (argument of the operation ``node``, function that solves the operation for this argument).

        The function takes the values that the operation should have for the whole formula to be right, and returns
        those that the argument should have if all other arguments are right: for a in a + b, the values minus b.

        Empty if no such function exists for the operation, or if an argument has no value at a test point.
        """
        inward = _INWARD.get((self.node.kind, self.node.value if self.node.kind == "call" else None))
        children = [Valued(child, self.points, (*self.path, place), self.node.kind)
                    for place, child in enumerate(self.node.args)]  # fmt: skip
        values = [child.values for child in children]
        if inward is None or any(value is None for value in values):
            return ()
        by_point = list(zip(*(value or () for value in values), strict=True))
        return [(child, _inward(inward, by_point, place)) for place, child in enumerate(children)]


Inward = Callable[[Values], Values | None]
"""A function from the values that an operation should have at the test points to the values of one of its arguments.

For the argument a of a + b, the function subtracts the values of b. It returns None if no values of the argument fit.
"""


def _inward(function: "OfArgument", by_point: Sequence[Sequence[Any]], place: int) -> Inward:
    """Return a function that solves an operation for its argument number ``place``, for all test points at once.

    The function takes the values that the operation should have and returns those that the argument should have, or
    None. ``by_point`` has, for each test point, the values that the arguments have in the claim. ``function``, from the
    table ``_INWARD``, solves the operation at one point.
    """
    others = [[value for n, value in enumerate(own) if n != place] for own in by_point]
    if not any(is_matrix(value) for own in by_point for value in own):
        if function is _of_sum:
            sums = [math.fsum(own) for own in others]
            return lambda needed: tuple([value - rest for value, rest in zip(needed, sums, strict=True)])
        if function is _of_product:
            divisors = [math.prod(own) for own in others]
            if not all(divisors):
                return lambda needed: None
            return lambda needed: tuple([value / by for value, by in zip(needed, divisors, strict=True)])

    def general(needed: Values) -> Values | None:
        try:
            inner = tuple(function(own, place, value) for own, value in zip(by_point, needed, strict=True))
        except (ArithmeticError, ValueError, TypeError, UndefinedValue, IndexError):
            return None
        return None if any(value is None for value in inner) else inner

    return general


def parts(whole: Valued, needed: Values) -> Iterator[Part]:
    """Yield the parts of the formula ``whole``, each with the values that this part should have.

    If this part alone changes to these values, the formula gets the values ``needed``: in a + b, a should have the
    needed value minus b. Parts for which no values can be computed, such as x in sin(x), are left out.
    """
    values = whole.values
    if values is None or [*map(shape_of, values)] != [*map(shape_of, needed)]:
        return
    yield Part(whole.path, whole.node, values, needed, whole.parent)
    if whole.entries:
        lists = [[*map(entries_of, side)] for side in (values, needed)]
        wrong = [n for n in whole.entries if not all(near(a[n], b[n]) for a, b in zip(*lists, strict=True))]
        if len(wrong) == 1:  # the only wrong entry of a matrix
            yield from parts(whole.entries[wrong[0]], tuple(entries[wrong[0]] for entries in lists[1]))
        return
    if whole.node.kind == "product" and is_matrix(needed[0]) and (row := _wrong_row(values, needed)) is not None:
        for entry, inner in _row_of_matrix(whole, needed, row):
            yield from parts(entry, inner)
    for argument, inward in whole.arguments:
        if (inner_values := inward(needed)) is not None:
            yield from parts(argument, inner_values)


def _wrong_row(values: Values, needed: Values) -> int | None:
    """Return the index of the only row in which columns ``values`` and ``needed`` differ. None in other cases."""
    pairs = [(entries_of(value), entries_of(other)) for value, other in zip(values, needed, strict=True)]
    wrong = [n for n in range(len(pairs[0][0])) if not all(near(a[n], b[n]) for a, b in pairs)]
    return wrong[0] if len(wrong) == 1 and (shape_of(values[0]) or (0, 0))[1] == 1 else None


def _row_of_matrix(whole: Valued, needed: Values, row: int) -> Iterator[tuple[Valued, Values]]:
    """Yield the entries in row ``row`` of a matrix, each with the values that would make ``whole`` right by itself.

    ``whole`` is the product of this matrix and a column. Only component ``row`` of the product differs from ``needed``,
    the values that the product should have. In a yielded pair (entry, values) there is one value for each test point.
    If just this entry changed to these values, the product would have the values ``needed``. Entries that are
    multiplied by a zero of the column are left out.
    """
    factors = whole.node.args
    place, matrix = next(((n, factor) for n, factor in enumerate(factors) if matrix_entries(factor)), (0, whole.node))
    others = [factor for n, factor in enumerate(factors) if n != place]
    columns = values_of(product(others), whole.points) if place < len(factors) - 1 else None
    rows = values_of(matrix, whole.points) if matrix is not whole.node else None
    if columns is None or rows is None or any(shape_of(column) != (len(row_of[0]), 1)
                                              for column, row_of in zip(columns, rows, strict=True)):  # fmt: skip
        return
    cells = matrix_entries(matrix)
    for n in range(len(rows[0][0])):
        by = [column[n][0] for column in columns]
        cell = cells.get(row * len(rows[0][0]) + n)  # None for a zero beside the diagonal of diag(a, b, c)
        entry = None if cell is None else whole.child((place, *cell))
        if entry is not None and all(by):
            # the values that make the product right, if only this entry changes
            lacking = [other[row][0] - value[row][0] for value, other in zip(whole.values or (), needed, strict=True)]
            yield entry, tuple(own[row][n] + less / factor for own, less, factor in zip(rows, lacking, by, strict=True))


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


OfArgument = Callable[[Sequence[Any], int, Any], Any]
"""A function ``f(arguments, place, needed)`` that solves an operation for one of its arguments at one test point.

``arguments`` are the present values of all arguments, ``needed`` is the value that the operation should have. The
result is the value that argument number ``place`` should have, or None if there is none.
"""

_INWARD: dict[tuple[str, str | None], OfArgument] = {
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
"""(kind of an operation, name of its function or None) -> the function that solves the operation for an argument."""


def is_superfluous(part: Part) -> bool:
    """Return whether a part should be left out: a term that should be 0, or a factor that should be 1."""
    neutral = NEUTRAL.get(part.parent)
    if neutral is None or any(map(is_matrix, part.needed)) or part.node.kind == "number":
        return False
    size = max(map(abs, part.values))
    return all(abs(value - neutral) <= CLOSE * (size + neutral) for value in part.needed)


def is_multiple(part: Part) -> bool:
    """Return whether the values that a part should have are its present values times one number other than 1."""
    first = _ratio(part.needed[0], part.values[0])
    if first is None or abs(first - 1) <= CLOSE:
        return False
    for value, needed in zip(part.values[1:], part.needed[1:], strict=True):
        ratio = _ratio(needed, value)
        if ratio is None or not near(ratio, first):
            return False
    return True


def multiples(part: Part) -> Iterator[Correction]:
    """Yield at most one change of a part's sign or numeric factor that gives the part the values ``part.needed``."""
    ratio = rational(tuple(_ratio(b, a) or 0.0 for a, b in zip(part.values, part.needed, strict=True)))
    if ratio is None or ratio == 1 or (ratio < 0 and ratio != -1) or part.node.kind == "neg":
        return
    if part.node.kind == "number":
        value = ratio * part.node.value
        if value > 0:
            size = 0.0 if ratio in (2, Fraction(1, 2)) else COST["per_factor_e"] * abs(math.log(ratio))
            cost = COST["factor"] + size
            yield Correction(number(value), "factor", cost + COST["no_integer"] * (value.denominator > 1))
    elif part.parent not in ("product", "power", "inv") or part.node.kind == "sum":  # else the whole term is changed
        if ratio == -1:
            yield Correction(negated(part.node), "sign_of_term", COST["sign_of_term"])
        else:
            cost = COST["solved_factor_2" if ratio in (2, Fraction(1, 2)) else "solved_rational_factor"]
            is_angle = part.node.value in ("acos", "asin", "atan", "atan2")
            yield Correction(scaled(part.node, ratio), HALVES.get(ratio, "factor") if is_angle else "factor", cost)


def rational(values: Sequence[float]) -> Fraction | None:
    """Return the simple rational number that all values equal, 1/3 for 0.3333333333; None if there is no such one."""
    first = values[0]
    if not math.isfinite(first) or not 1e-4 < abs(first) < 1e4:
        return None
    ratio = Fraction(first).limit_denominator(LARGEST)
    fits = all(near(value, float(ratio)) for value in values)
    return ratio if fits and ratio and abs(ratio.numerator) <= LARGEST else None


def near(left: float, right: float) -> bool:
    """Return whether two values agree to about nine digits."""
    return abs(left - right) <= CLOSE * (abs(left) + abs(right))
