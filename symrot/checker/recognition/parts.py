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

from symrot.checker.claim.tree import TIME, Node, Path, is_derivative, negated, number, product, sum_of
from symrot.checker.repair.dual import minus
from symrot.checker.repair.edits import COST, OPPOSITE, neighbours, scaled
from symrot.checker.repair.filter import at, matrix_entries
from symrot.checker.repair.points import Point, UndefinedValue
from symrot.checker.repair.rows import entries_of, is_matrix, mapped, plus, shape_of, times

__all__ = [
    "LACKING",
    "Change",
    "Letters",
    "Part",
    "PointOfLetters",
    "Variant",
    "is_multiple",
    "is_superfluous",
    "multiples",
    "near",
    "parts",
    "rates_of_entries",
    "rational",
    "values_of",
    "variants",
]  # fmt: skip

CLOSE = 1e-9
"""The largest relative difference between values that count as equal."""
LARGEST = 400
"""The largest numerator and denominator of a rational number that is recognised by its value."""
POWERS = tuple(range(-2, 7))
"""The exponents that a part may have instead of its own."""
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "cot": lambda x: 1 / math.tan(x),
    "sec": lambda x: 1 / math.cos(x), "csc": lambda x: 1 / math.sin(x),
}  # fmt: skip
LACKING = Node("name", "?")
"""A symbol of a known formula that a claim lacks, under a name that no text can contain."""
HALVES = {Fraction(2): "half_angle", Fraction(1, 2): "double_half_angle"}
"""Factor that an angle by an inverse function should have -> the fault of a formula without this factor."""
MULTIPLES = {Fraction(2): "double_half_angle", Fraction(1, 2): "half_angle"}
"""Factor that an angle should have -> the fault of a formula without this factor."""

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


# -- what a part should be --------------------------------------------------------------------------------------------


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


class Variant(NamedTuple):
    """A change of a part that undoes a usual fault, with the values of the changed part."""

    change: Change
    values: Values


def variants(node: Node, parent: str, letters: Letters) -> list[Variant]:
    """Return the changes of a part that undo usual faults, each with the values of the changed part."""
    values = values_of(node, letters.points)
    if values is None or not all(isinstance(value, float) and value for value in values):
        return []
    made = [variant for kind in _VARIANTS for variant in kind(node, parent, values, letters)]
    return [
        variant for variant in made if all(map(math.isfinite, variant.values)) and not _equal(variant.values, values)
    ]


def _of_letter(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield all other symbols in ``letters`` as replacements of ``node``, if ``node`` is a symbol."""
    # as below, parent is the kind of the node around, values are those of node at the test points
    written = {**letters.atoms, **letters.aliases}
    if node not in written:
        return
    alike = neighbours(node.value, [str(n.value) for n in written if n.kind == "name"]) if node.kind == "name" else ()
    for other, others in written.items():
        if other != node:
            cost = COST["solved_neighbour" if other.value in alike or other == LACKING else "solved_symbol"]
            yield Variant(Change(other, "wrong_symbol", cost), others)


def _of_exponent(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of a part by other powers: x and x^3 for x^2, or x for 1/x."""
    base, exponent = node, Fraction(1)
    if node.kind == "power" and node.args[1].kind == "number":
        base, exponent = node.args[0], node.args[1].value
    elif node.kind == "inv":
        cost = COST["factor"] + COST["quotient_inverted"]
        yield Variant(Change(node.args[0], "factor", cost), tuple(1 / value for value in values))
        return
    elif not (node.kind in ("name", "call", "sum") and parent) and not (node.kind == "product" and parent == "inv"):
        return
    bases = values_of(base, letters.points) or ()
    if exponent == 2 and base in letters.atoms:  # x*y was written as x^2
        yield from _with_other_factor(base, bases, letters)
    for power in POWERS:
        if power != exponent and power and not (power < 0 and parent == "inv"):
            size = base if abs(power) == 1 else Node("power", None, (base, number(abs(power))))
            made = size if power > 0 else Node("inv", None, (size,))
            cost = COST["exponent"] + (0.0 if {power, exponent} == {1, 2} else COST["not_a_square"])
            try:
                powers = tuple(value**power for value in bases)
            except OverflowError:  # a number of hundreds of digits
                continue
            yield Variant(Change(made, "exponent", cost), powers)


def _with_other_factor(base: Node, bases: Values, letters: Letters) -> Iterator[Variant]:
    """Yield the products of a symbol ``base`` and each other symbol, in place of its square: x*y for x^2."""
    alike = neighbours(base.value, letters.names) if base.kind == "name" else ()
    for other, others in letters.atoms.items():
        if other != base:
            cost = COST["solved_neighbour" if other.value in alike or other == LACKING else "solved_symbol"]
            made = Change(product([base, other]), "wrong_symbol", cost)
            yield Variant(made, tuple(a * b for a, b in zip(bases, others, strict=True)))


def _of_square(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield (a/b)^2 for a part a/b, and a^2 - b^2 for a part (a - b)^2."""
    factors = [factor.args[0] if factor.kind == "inv" else factor for factor in node.args]
    if node.kind == "product" and len(factors) > 1 and parent == "sum" and all(f in letters.atoms for f in factors):
        squares = [_square_of(factor) for factor in node.args]
        yield Variant(Change(product(squares), "exponent", COST["exponent"]), tuple(v**2 for v in values))
    if node.kind == "power" and node.args[0].kind == "sum" and node.args[1] == number(2):
        terms = [negated(_square_of(t.args[0])) if t.kind == "neg" else _square_of(t) for t in node.args[0].args]
        made = sum_of(terms)
        changed = values_of(made, letters.points)
        if changed is not None:
            yield Variant(Change(made, "exponent", COST["exponent"]), changed)


def _square_of(tree: Node) -> Node:
    """Return the square of a tree; for 1/a it is 1/a^2."""
    if tree.kind == "inv":
        return Node("inv", None, (_square_of(tree.args[0]),))
    return Node("power", None, (tree, number(2)))


def _of_function(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of sin(u), such as cos(u), sin(2u) and sin(v), and likewise of cos(u), tan(u) and so on."""
    if node.kind != "call" or node.value not in FUNCTIONS:
        return
    (angle,) = node.args
    own = letters.angles[angle]
    for name in FUNCTIONS:
        cost = COST["sin_cos_swap"] + (0.0 if OPPOSITE[node.value] == name else COST["other_function"])
        yield Variant(Change(replace(node, value=name), "sin_cos_swap", cost), tuple(map(FUNCTIONS[name], own)))
    for multiple, code in MULTIPLES.items():
        made = replace(node, args=(scaled(angle, multiple),))
        angles = tuple(float(multiple) * value for value in own)
        yield Variant(Change(made, code, COST[code]), tuple(map(FUNCTIONS[node.value], angles)))
    for other, angles in (*letters.angles.items(), *((n, v) for n, v in letters.atoms.items() if n == LACKING)):
        if other != angle and rational(tuple(b / a for a, b in zip(own, angles, strict=True))) not in MULTIPLES:
            change = Change(replace(node, args=(other,)), "wrong_symbol", COST["wrong_symbol"])
            yield Variant(change, tuple(map(FUNCTIONS[node.value], angles)))


def _of_factor(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield a term or bracket with one more symbol or function as factor or divisor, m*a and a/m for a; also b/a for
    a/b.
    """
    if parent in ("product", "power", "inv") or node.kind in ("neg", "inv", "number"):
        return
    if node.kind == "product":
        cost = COST["wrong_symbol"] + COST["quotient_inverted"]
        yield Variant(Change(_inverted(node), "wrong_symbol", cost), tuple(1 / value for value in values))
    cost = COST["solved_factor"] + COST["per_piece_added"]
    for atom, factors in _factors(letters):
        for power in (1, -1, 2, -2) if all(factors) else (1, 2):
            factor = atom if abs(power) == 1 else Node("power", None, (atom, number(2)))
            factor = factor if power > 0 else Node("inv", None, (factor,))
            made = tuple(value * other**power for value, other in zip(values, factors, strict=True))
            yield Variant(Change(product([node, factor]), "factor", cost), made)


def _inverted(node: Node) -> Node:
    above = [part.args[0] for part in node.args if part.kind == "inv"]
    below = [Node("inv", None, (part,)) for part in node.args if part.kind != "inv"]
    return product([*above, *below])


def _factors(letters: Letters) -> Iterator[tuple[Node, Values]]:
    yield from letters.atoms.items()
    yield from letters.aliases.items()
    for angle, values in letters.angles.items():
        for name in ("sin", "cos", "tan"):
            yield Node("call", name, (angle,)), tuple(map(FUNCTIONS[name], values))


def _of_terms(node: Node, parent: str, values: Values, letters: Letters) -> Iterator[Variant]:
    """Yield replacements of a sum or product: a^2 + b^2 for a + b, or sine and cosine of an angle exchanged."""
    trees: list[tuple[Node, str]] = []
    if node.kind == "sum":
        bases = [_base(term) for term in node.args]
        if all(base is not None for base in bases):
            for power in POWERS[3:]:
                terms = [_powered(term, base, power) for term, base in zip(node.args, bases, strict=True) if base]
                trees.append((sum_of(terms), "exponent"))
    if node.kind in ("sum", "product"):
        trees += [(_exchanged(node, angle), "sin_cos_swap") for angle in letters.angles]
    for made, code in trees:
        changed = values_of(made, letters.points)
        if changed is not None and made != node:
            yield Variant(Change(made, code, COST[code]), changed)


def _base(term: Node) -> Node | None:
    bare = term.args[0] if term.kind == "neg" else term
    bare = bare.args[0] if bare.kind == "power" else bare
    return bare if bare.kind == "name" else None


def _powered(term: Node, base: Node, power: int) -> Node:
    made = base if power == 1 else Node("power", None, (base, number(power)))
    return negated(made) if term.kind == "neg" else made


def _exchanged(tree: Node, angle: Node) -> Node:
    """Return a tree with the sine and the cosine of an angle exchanged."""
    if tree.kind == "call" and tree.value in OPPOSITE and tree.args == (angle,):
        return replace(tree, value=OPPOSITE[tree.value])
    return replace(tree, args=tuple(_exchanged(child, angle) for child in tree.args))


_VARIANTS = (_of_letter, _of_exponent, _of_square, _of_function, _of_factor, _of_terms)


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


def _equal(left: Values, right: Values) -> bool:
    return all(map(near, left, right))
