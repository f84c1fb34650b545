"""What a piece would have to be for the claim to hold, solved for at the points, and read as something people write.

An equation is solved for one piece at a time: a term, a factor, a symbol. The value it needs is compared with all short
products of what occurs in the claim. So a lost term, a lost factor and a strange symbol are found in one look-up each,
however long the formula is.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement

from symrot.checker.claim.tree import Node, Path, negated, number, product, replaced, sum_of, walk
from symrot.checker.latex.cursor import TIME
from symrot.checker.repair.edits import OPPOSITE, Edit, neat, neighbours
from symrot.checker.repair.filter import SIDES, Change, Found, NumericFilter, is_nontrivial
from symrot.checker.repair.points import Point, UndefinedValue, entries_of

__all__ = ["solved"]

ONES = (1, -1)
"""Numbers that people leave out of a sum."""

HOLE = Node("name", "?")
"""The piece that is solved for: no name that a reader can read."""

CLOSE = 1e-8
MOST_ATOMS = 24
MOST_PRODUCTS = 4000
MOST_SUMS = 24
MOST_MATRICES = 40
MOST_COLUMNS = 5
LARGEST_RATIO = 60
LARGEST_OF_SIDE = 1000
"""Largest denominator of a rational factor, of a piece and of a whole term of a side."""

Values = tuple[float, ...]
"""One value for each point."""


# -- what occurs ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Entry:
    """A product of things that occur in the claim: its factors, and its values at the points."""

    factors: tuple[Node, ...]
    values: Values

    @property
    def node(self) -> Node:
        return product(list(self.factors)) if self.factors else number(1)


class Vocabulary:
    """Short products of the symbols, functions, sines and cosines of a claim, and its own terms, by their values."""

    def __init__(self, sieve: NumericFilter) -> None:
        self.sieve = sieve
        trees = [sieve.tree_at(place) for place in sieve.places]
        written = [node for tree in trees for _, node in walk(tree) if node.kind != "number"]
        atoms = self._atoms(written)
        entries = [Entry((), (1.0,) * len(sieve.points)), *self._products(atoms, 1)]
        degree = 1
        while degree < 5 and len(entries) < MOST_PRODUCTS and atoms:
            degree += 1
            entries += self._products(atoms, degree)[: MOST_PRODUCTS - len(entries)]
        whole = [sieve.left, sieve.right]  # taken away, it would leave nothing
        brackets = dict.fromkeys(n for n in written if n.kind == "sum" and n not in whole and not sieve.is_matrix(n))
        sums = self._valued(brackets, MOST_SUMS)
        entries += [Entry((a, s), _times(u, v)) for s, v in sums for a, u in [(number(1), v), *atoms] if a != number(1)]
        entries += [Entry((r, s), _times(u, v)) for (r, u), (s, v) in combinations_with_replacement(sums, 2)]
        entries += [Entry((node,), values) for node, values in sums]
        terms = dict.fromkeys(n for n in written if n.kind in ("product", "power") and not sieve.is_matrix(n))
        entries += [Entry((node,), values) for node, values in self._valued(terms, 10 * MOST_SUMS)]
        keyed = [(self._key(entry.values), place) for place, entry in enumerate(entries) if all(entry.values)]
        keyed.sort()
        self.entries = entries
        self.keys = [key for key, _ in keyed]
        self.order = [place for _, place in keyed]

    def _atoms(self, written: Sequence[Node]) -> list[tuple[Node, Values]]:
        sieve = self.sieve
        found = [node for node in written if node.kind == "name" and node.value not in ("pi", "t")]
        found += [Node("name", name) for name in sieve.names]
        for node in written:
            if node.kind == "call" and (
                node.value in OPPOSITE or node.value in sieve.functions or node.value == "diff"
            ):
                found.append(node)
                if node.value in ("sin", "cos"):
                    found.append(Node("call", OPPOSITE[node.value], node.args))
        columns = [Node("name", name) for name in sorted(sieve.matrix_names)]
        found += [Node("call", "dot", pair) for pair in combinations_with_replacement(columns[:MOST_COLUMNS], 2)]
        scalars = dict.fromkeys(node for node in found if not sieve.is_matrix(node) and node != HOLE)
        return self._valued(scalars, MOST_ATOMS)

    def _valued(self, nodes: Iterator[Node] | dict[Node, None], most: int) -> list[tuple[Node, Values]]:
        made = []
        for node in nodes:
            values = self.values(node)
            if values is not None:
                made.append((node, values))
            if len(made) == most:
                break
        return made

    def values(self, node: Node) -> Values | None:
        """Return the values of a scalar at the points, None where it has none."""
        try:
            found = [point.value(node) for point in self.sieve.points]
        except UndefinedValue:
            return None
        return tuple(found) if all(isinstance(value, float) and value for value in found) else None

    def _products(self, atoms: Sequence[tuple[Node, Values]], degree: int) -> list[Entry]:
        made = []
        for chosen in combinations_with_replacement(atoms, degree):
            values: Values = (1.0,) * len(self.sieve.points)
            for _, other in chosen:
                values = _times(values, other)
            made.append(Entry(tuple(node for node, _ in chosen), values))
            if len(made) == MOST_PRODUCTS:
                break
        return made

    def _key(self, values: Values) -> float:
        return values[0] / values[1]

    def find(self, values: Values) -> Iterator[tuple[Entry, Fraction]]:
        """Yield (entry, rational) with rational times entry equal to the values, shortest entries first."""
        if not all(values):
            return
        key = self._key(values)
        slack = CLOSE * abs(key)
        place = bisect_left(self.keys, key - slack)
        found = []
        while place < len(self.keys) and self.keys[place] <= key + slack:
            entry = self.entries[self.order[place]]
            ratio = _rational([value / other for value, other in zip(values, entry.values, strict=True)])
            if ratio is not None:
                found.append((len(entry.factors), self.order[place], entry, ratio))
            place += 1
        for _, _, entry, ratio in sorted(found, key=lambda item: item[:2]):
            yield entry, ratio


def _times(left: Values, right: Values) -> Values:
    return tuple(a * b for a, b in zip(left, right, strict=True))


def _rational(values: Sequence[float], largest: int = LARGEST_RATIO) -> Fraction | None:
    """Return the small rational that all values are, or None."""
    near = Fraction(values[0]).limit_denominator(largest)
    fits = all(abs(value - near) <= 1e-3 * CLOSE * abs(near) for value in values)
    return near if fits and near and abs(near.numerator) <= LARGEST_RATIO * largest else None


# -- what a piece would have to be ------------------------------------------------------------------------------------


def solved(sieve: NumericFilter) -> list[Found]:
    """Return repairs in which one piece has become something that makes the claim hold, the nearest first."""
    if len(sieve.points) < 2 or not (is_nontrivial(sieve.left) or is_nontrivial(sieve.right)):
        return []  # of a bare number nobody can say what it should have been
    vocabulary = Vocabulary(sieve)
    found: list[Found] = []
    for place in sieve.places:
        tree = sieve.tree_at(place)
        opened = sieve.open_paths(place, tree)
        for path, piece, term in _pieces(tree):
            if not sieve.affordable():
                break
            if not opened(path):
                continue
            if sieve.is_matrix(piece):
                found += _of_matrix(sieve, vocabulary, place, path, piece)
                continue
            values = vocabulary.values(piece)
            needed = values and _needed(sieve, place, path, HOLE, values)
            outer = place in SIDES and len(path) <= 1
            if values and needed:
                for made, edit in _readings(sieve, vocabulary, piece, values, needed, term, outer):
                    found.append(_found(sieve, place, path, made, edit))
    return [item for item in sorted(found, key=lambda item: item[0]) if _means(sieve, item[2][0])]


def _means(sieve: NumericFilter, change: Change) -> bool:
    """Return whether a change says something: it holds, and neither a side nor a definition has become zero."""
    if not sieve.sensible(change.place, change.edit.tree):
        return False
    if change.place not in SIDES:
        point = sieve.points[0]
        try:
            was, now = (any(entries_of(point.value(tree))) for tree in (sieve.tree_at(change.place), change.edit.tree))
        except UndefinedValue:
            return False
        if was and not now:
            return False
    return sieve.holds([change])


def _pieces(tree: Node, path: Path = (), term: bool = False) -> Iterator[tuple[Path, Node, bool]]:
    """Yield (path, piece, whether it is a term of a sum) of what may be solved for, the arguments of functions not."""
    if tree.kind not in ("list", "inv"):
        yield path, tree, term
    for place, child in enumerate(tree.args):
        hidden = tree.kind in ("power", "index") and place
        inside = tree.kind == "call" and tree.value in (*OPPOSITE, "diff", "integrate", "Rx", "Ry", "Rz", "eye")
        if not hidden and not inside and child != TIME:
            yield from _pieces(child, (*path, place), tree.kind == "sum")


def _found(sieve: NumericFilter, place: str, path: Path, made: Node, edit: tuple[str, float]) -> Found:
    code, cost = edit
    tree = _joined(replaced(sieve.tree_at(place), path, lambda _: made))
    change = Change(place, Edit(code, cost + 0.01 * len(path), path, neat(tree) if code == "factor" else tree))
    return change.cost, code, (change,)


def _joined(node: Node) -> Node:
    """Return a tree with sums in sums and products in products made flat."""
    args = tuple(map(_joined, node.args))
    if node.kind in ("sum", "product"):
        return (sum_of if node.kind == "sum" else product)(list(args), node.span)
    if node.kind == "neg":
        return negated(args[0])
    return node if args == node.args else Node(node.kind, node.value, args, node.span)


def _needed(sieve: NumericFilter, place: str, path: Path, made: Node, start: Values) -> Values | None:
    """Return the values that the hole in a piece needs at the points; None where there are none."""
    tree = replaced(sieve.tree_at(place), path, lambda _: made)
    if place not in SIDES and not sieve.sensible(place, tree):
        return None
    change = [Change(place, Edit("none", 0.0, path, tree))]
    found = []
    for point, value in zip(sieve.points, start, strict=True):
        needed = _root(sieve, point, change, value)
        if needed is None:
            return None
        found.append(needed)
    return tuple(found)


def _root(sieve: NumericFilter, point: Point, change: Sequence[Change], start: float) -> float | None:
    """Return the value of the hole that makes both sides equal: exact at once where they are linear in it."""

    def differences(value: float) -> list[float]:
        point.symbols[HOLE.value] = value
        return sieve.differences(point, change)

    try:
        low, high = start, start + 0.37 * (1 + abs(start))
        before, after = differences(low), differences(high)
        slopes = [abs(b - a) for a, b in zip(before, after, strict=True)]
        steepest = max(range(len(slopes)), key=slopes.__getitem__)
        size = max(map(abs, (*before, *after)))
        idle = [n for n, slope in enumerate(slopes) if slope <= 1e-12 * size and abs(before[n]) > 1e-9 * size]
        for _ in range(0 if idle or not slopes[steepest] else 6):
            a, b = before[steepest], after[steepest]
            if a == b:
                return None
            low, high = high, high - b * (high - low) / (b - a)
            before, after = after, differences(high)
            if max(map(abs, after)) <= 1e-11 * (1 + size):
                return high
            if max(abs(value) for n, value in enumerate(after) if n != steepest or len(after) == 1) > 100 * size:
                return None
            if abs(after[steepest]) <= 1e-12 * (1 + size):
                return None  # this entry holds, another one does not
    except (UndefinedValue, ZeroDivisionError, OverflowError):
        return None
    finally:
        point.symbols.pop(HOLE.value, None)
    return None


Reading = tuple[Node, tuple[str, float]]
"""What a piece becomes, and the code and cost of that."""


def _readings(
    sieve: NumericFilter, vocabulary: Vocabulary, piece: Node, values: Values, needed: Values, term: bool, outer: bool
) -> Iterator[Reading]:
    """Yield what a piece may become, given the values it has and the values it needs."""
    if all(abs(b) <= CLOSE * abs(a) for a, b in zip(values, needed, strict=True)):
        return  # it would have to go
    ratios = tuple(b / a for a, b in zip(values, needed, strict=True))
    plain = _rational(ratios, LARGEST_OF_SIDE if outer else LARGEST_RATIO)
    if plain is not None:
        if plain == -1:
            yield negated(piece), ("sign_of_term", 0.85)
        elif piece.kind != "neg":
            easy = plain in (2, Fraction(1, 2), -2, Fraction(-1, 2))
            yield _scaled(piece, plain), ("factor", 1.16 if easy else 1.3)
    constant = _rational(needed)
    if piece.kind in ("name", "call"):
        for entry, ratio in vocabulary.find(needed):
            if len(entry.factors) == 1 and ratio == 1 and entry.factors[0].kind in ("name", "call"):
                yield entry.node, _exchanged(sieve, piece, entry.factors[0])
    elif piece.kind == "number" and constant is not None:
        yield number(constant), ("factor", 1.25)
    if plain is None and constant is None:
        bare = 0.5 if piece.kind == "number" else 0.0
        for factors, upward in ((ratios, True), (tuple(1 / ratio for ratio in ratios if ratio), False)):
            if len(factors) == len(ratios):
                for entry, ratio in vocabulary.find(factors):
                    yield _multiplied(piece, entry, ratio, upward), ("factor", _weight(1.22 + bare, entry, ratio))
                    break
    lacking = tuple(b - a for a, b in zip(values, needed, strict=True))
    if _is_there(vocabulary, piece, lacking):
        return
    if not term and piece.kind != "neg" and not (plain and not is_nontrivial(piece)):
        for entry, ratio in vocabulary.find(lacking):
            if not entry.factors and ratio not in ONES:
                continue
            made = sum_of([piece, _scaled(entry.node, ratio)])
            yield made, ("missing_term", _weight(1.5 if piece.kind == "sum" else 1.65, entry, ratio))
            break


def _is_there(vocabulary: Vocabulary, piece: Node, lacking: Values) -> bool:
    """Return whether what is lacking is a multiple of a term that is there: then that term has another fault."""
    for node in piece.args if piece.kind == "sum" else (piece,):
        values = vocabulary.values(node)
        if values and _rational([a / b for a, b in zip(lacking, values, strict=True)]) is not None:
            return True
    return False


def _exchanged(sieve: NumericFilter, piece: Node, other: Node) -> tuple[str, float]:
    if piece.kind == other.kind == "call" and OPPOSITE.get(piece.value) == other.value and piece.args == other.args:
        return "sin_cos_swap", 1.0
    near = piece.kind == other.kind == "name" and other.value in neighbours(piece.value, sieve.names)
    return "wrong_symbol", 1.0 if near else 1.2


def _weight(least: float, entry: Entry, ratio: Fraction) -> float:
    """Return a cost that grows with what is added: its factors, and a rational in front."""
    size = sum(1 + sum(1 for _ in walk(factor)) // 3 for factor in entry.factors)
    return least + 0.02 * size + (0.0 if abs(ratio) == 1 else 0.04)


def _multiplied(piece: Node, entry: Entry, ratio: Fraction, upward: bool) -> Node:
    inner, negative = (piece.args[0], True) if piece.kind == "neg" else (piece, False)
    if upward:
        made = _scaled(product([inner, *entry.factors]), ratio)
    else:
        below = [Node("inv", None, (factor,)) for factor in entry.factors]
        made = _scaled(product([inner, *below]), 1 / ratio)
    return negated(made) if negative else made


def _scaled(term: Node, ratio: Fraction) -> Node:
    """Return a term times a rational, as people write it."""
    size = abs(ratio)
    above = [] if size.numerator == 1 else [number(size.numerator)]
    below = [] if size.denominator == 1 else [Node("inv", None, (number(size.denominator),))]
    made = neat(product([*above, term, *below])) if above or below else term
    return negated(made) if ratio < 0 else made


# -- matrices ---------------------------------------------------------------------------------------------------------


def _of_matrix(sieve: NumericFilter, vocabulary: Vocabulary, place: str, path: Path, piece: Node) -> Iterator[Found]:
    """Yield a matrix with a scalar factor, or with another matrix added to it."""
    if piece.kind == "call" and piece.value == "Matrix" and path:
        return
    unit = (1.0,) * len(sieve.points)
    needed = _needed(sieve, place, path, product([HOLE, piece]), unit)
    for entry, ratio in vocabulary.find(needed or ()) if needed else ():
        made = _scaled(product([*entry.factors, piece]), ratio)
        yield _found(sieve, place, path, made, ("factor", _weight(1.22, entry, ratio)))
        break
    if piece.kind == "neg" or (path and piece.kind in ("name", "call")):
        return
    for other in _matrices(sieve, piece):
        needed = _needed(sieve, place, path, sum_of([piece, product([HOLE, other])]), (0.0,) * len(sieve.points))
        for entry, ratio in vocabulary.find(needed) if needed else ():
            added = _scaled(product([*entry.factors, other]), ratio)
            yield _found(
                sieve, place, path, sum_of([piece, added]), ("missing_term", _weight(1.5, entry, ratio) + 0.04)
            )
            break


def _matrices(sieve: NumericFilter, piece: Node) -> list[Node]:
    """Return matrices of the shape of a piece made of what occurs: pieces, their transposes, products of two names."""
    shape = _shape(sieve, piece)
    written = [node for place in sieve.places for _, node in walk(sieve.tree_at(place)) if sieve.is_matrix(node)]
    named = [Node("name", name) for name in sorted(sieve.matrix_names)]
    single = [*named, *(Node("transpose", None, (node,)) for node in named)]
    plain = [node.args[0] if node.kind == "neg" else node for node in written if node.kind not in ("list", "sum")]
    pairs = [product([a, b]) for a in single for b in single]
    fitting = (node for node in dict.fromkeys([*plain, *single, *pairs]) if _shape(sieve, node) == shape)
    found: list[Node] = []
    for node in fitting:
        found.append(node)
        if len(found) == MOST_MATRICES:
            break
    return found


def _shape(sieve: NumericFilter, node: Node) -> tuple[int, int] | None:
    try:
        value = sieve.points[0].value(node)
    except UndefinedValue:
        return None
    return (len(value), len(value[0])) if isinstance(value, tuple) and any(entries_of(value)) else None
