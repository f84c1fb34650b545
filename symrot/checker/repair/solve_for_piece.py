"""Repairs that replace one part of a formula by the value that makes the claim true, written as a short formula.

The claim is solved numerically for one part (a term, a factor or a symbol) at two points. The result is looked up among
the values of all short products of symbols and functions of the claim.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement, islice

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import TIME, Node, Path, negated, number, product, replaced, sum_of, walk
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.names import OPPOSITE, neighbours
from symrot.checker.repair.edits.single import Edit
from symrot.checker.repair.edits.trees import flattened, normalise_factors, scaled
from symrot.checker.repair.filter import SIDES, Candidate, Change, NumericFilter, is_nontrivial
from symrot.checker.repair.points import Point, UndefinedValue, entries_of

__all__ = ["solutions"]

ONES = (1, -1)
"""The only numbers that a repair may add to a formula as a missing term: a term 1 is easily forgotten."""

HOLE = Node("name", "?")
"""Placeholder for the unknown part of a formula: a name that no text can contain."""

CLOSE = 1e-8
"""The largest relative difference between values that are taken to be equal."""

MOST_ATOMS, MOST_SUMS, MOST_PRODUCTS = 24, 24, 4000
"""Largest numbers in a `Vocabulary`: of symbols and functions together, of bracketed sums, and of products.

The products are those of the symbols and functions alone; products with a bracketed sum are not counted.
"""

MOST_MATRICES, MOST_COLUMNS = 40, 5
"""Largest number of matrices of a claim whose multiples are tried as a missing term of a matrix or vector, and largest
number of named matrices or vectors of a claim whose scalar products in pairs are tried as factors."""

LARGEST_RATIO = 60
"""Largest denominator of a rational number in a repair, such as 2/3 in a factor that was forgotten."""

LARGEST_OF_SIDE = 1000
"""Largest denominator of a rational number that multiplies a whole side of the claim, or a term or factor of a side."""

Values = tuple[float, ...]
"""The values of a formula, one for each test point."""


# -- the vocabulary of a claim ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Entry:
    """A short product from a `Vocabulary`, with its values at the test points: a repair may insert it in the claim.

    Each of the ``factors`` is a symbol, a function call, a bracketed sum, or a whole product or power of the claim.
    """

    factors: tuple[Node, ...]
    values: Values

    @property
    def node(self) -> Node:
        return product(list(self.factors)) if self.factors else number(1)


class Vocabulary:
    """Short products of a claim's symbols, functions and bracketed sums, found by their values at the test points."""

    def __init__(self, numeric: NumericFilter) -> None:
        self.numeric = numeric
        trees = [numeric.tree_at(place) for place in numeric.places]
        written = [node for tree in trees for _, node in walk(tree) if node.kind != "number"]
        atoms = self._atoms(written)
        entries = [Entry((), (1.0,) * len(numeric.points)), *self._products(atoms, 1)]
        degree = 1
        while degree < 5 and len(entries) < MOST_PRODUCTS and atoms:
            degree += 1
            entries += self._products(atoms, degree)[: MOST_PRODUCTS - len(entries)]
        whole = [numeric.left, numeric.right]  # a side is no bracket
        brackets = dict.fromkeys(n for n in written if n.kind == "sum" and n not in whole and not numeric.is_matrix(n))
        sums = self._valued(brackets, MOST_SUMS)
        entries += [Entry((a, s), _times(u, v)) for s, v in sums for a, u in [(number(1), v), *atoms] if a != number(1)]
        entries += [Entry((r, s), _times(u, v)) for (r, u), (s, v) in combinations_with_replacement(sums, 2)]
        entries += [Entry((node,), values) for node, values in sums]
        terms = dict.fromkeys(n for n in written if n.kind in ("product", "power") and not numeric.is_matrix(n))
        entries += [Entry((node,), values) for node, values in self._valued(terms, 10 * MOST_SUMS)]
        keyed = [(self._key(entry.values), place) for place, entry in enumerate(entries) if all(entry.values)]
        keyed.sort()
        self.entries = entries
        self.keys = [key for key, _ in keyed]
        self.order = [place for _, place in keyed]

    def _atoms(self, written: Sequence[Node]) -> list[tuple[Node, Values]]:
        numeric = self.numeric
        atoms = [node for node in written if node.kind == "name" and node.value not in ("pi", "t")]
        atoms += [Node("name", name) for name in numeric.names]
        for node in written:
            if node.kind == "call" and (
                node.value in OPPOSITE or node.value in numeric.functions or node.value == "diff"
            ):
                atoms.append(node)
                if node.value in ("sin", "cos"):
                    atoms.append(Node("call", OPPOSITE[node.value], node.args))
        columns = [Node("name", name) for name in sorted(numeric.matrix_names)]
        atoms += [Node("call", "dot", pair) for pair in combinations_with_replacement(columns[:MOST_COLUMNS], 2)]
        scalars = dict.fromkeys(node for node in atoms if not numeric.is_matrix(node) and node != HOLE)
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
        """Return a scalar formula's values at the test points; None for a matrix, or if one is zero or undefined."""
        try:
            values = [point.value(node) for point in self.numeric.points]
        except UndefinedValue:
            return None
        return tuple(values) if all(isinstance(value, float) and value for value in values) else None

    def _products(self, atoms: Sequence[tuple[Node, Values]], degree: int) -> list[Entry]:
        made = []
        for chosen in combinations_with_replacement(atoms, degree):
            values: Values = (1.0,) * len(self.numeric.points)
            for _, other in chosen:
                values = _times(values, other)
            made.append(Entry(tuple(node for node, _ in chosen), values))
            if len(made) == MOST_PRODUCTS:
                break
        return made

    def _key(self, values: Values) -> float:
        return values[0] / values[1]

    def find(self, values: Values) -> Iterator[tuple[Entry, Fraction]]:
        """Yield (product, ratio) for each product whose values, times a rational ratio, are ``values``.

        Products of few factors come first. Nothing is yielded if one of ``values`` is zero.
        """
        if not all(values):
            return
        key = self._key(values)
        slack = CLOSE * abs(key)
        place = bisect_left(self.keys, key - slack)
        matches = []
        while place < len(self.keys) and self.keys[place] <= key + slack:
            entry = self.entries[self.order[place]]
            ratio = _rational([value / other for value, other in zip(values, entry.values, strict=True)])
            if ratio is not None:
                # short products first
                matches.append((len(entry.factors), self.order[place], entry, ratio))
            place += 1
        for _, _, entry, ratio in sorted(matches, key=lambda item: item[:2]):
            yield entry, ratio


def _times(left: Values, right: Values) -> Values:
    return tuple(a * b for a, b in zip(left, right, strict=True))


def _rational(values: Sequence[float], largest: int = LARGEST_RATIO) -> Fraction | None:
    """Return the rational number that all ``values`` equal, within rounding, with a denominator of ``largest`` at most.

    None if there is none.
    """
    near = Fraction(values[0]).limit_denominator(largest)
    fits = all(abs(value - near) <= 1e-3 * CLOSE * abs(near) for value in values)
    return near if fits and near and abs(near.numerator) <= LARGEST_RATIO * largest else None


# -- solving for a piece ----------------------------------------------------------------------------------------------


def solutions(numeric: NumericFilter) -> list[Candidate]:
    """Return the repairs that replace one part of the claim by a short formula, the nearest first.

    With this formula the claim holds at the test points.
    """
    if len(numeric.points) < 2 or not (is_nontrivial(numeric.left) or is_nontrivial(numeric.right)):
        return []  # a wrong number alone does not tell which formula was meant
    vocabulary = Vocabulary(numeric)
    candidates: list[Candidate] = []
    for place in numeric.places:
        tree = numeric.tree_at(place)
        is_tried = numeric.tried_paths(place, tree)
        for path, piece, term in _pieces(tree):
            if not numeric.affordable():
                break
            if not is_tried(path):
                continue
            if numeric.is_matrix(piece):
                candidates += _of_matrix(numeric, vocabulary, place, path, piece)
                continue
            values = vocabulary.values(piece)
            needed = values and _needed(numeric, place, path, HOLE, values)
            outer = place in SIDES and len(path) <= 1
            if values and needed:
                for made, edit in _corrections(numeric, vocabulary, piece, values, needed, term, outer):
                    candidates.append(_candidate(numeric, place, path, made, edit))
    ordered = sorted(candidates, key=lambda candidate: candidate.cost)
    return [candidate for candidate in ordered if _is_meaningful(numeric, candidate.changes[0])]


def _is_meaningful(numeric: NumericFilter, change: Change) -> bool:
    """Return whether a change makes the claim true at the test points, without making a side or a definition zero."""
    if not numeric.sensible(change.place, change.edit.tree):
        return False
    if change.place not in SIDES:
        point = numeric.points[0]
        try:
            was, now = (
                any(entries_of(point.value(tree))) for tree in (numeric.tree_at(change.place), change.edit.tree)
            )
        except UndefinedValue:
            return False
        if was and not now:
            return False
    return numeric.holds([change])


def _pieces(tree: Node, path: Path = (), term: bool = False) -> Iterator[tuple[Path, Node, bool]]:
    """Yield (path, part, whether the part is a term of a sum) for each part of a tree that may be replaced."""
    if tree.kind not in ("list", "inv"):
        yield path, tree, term
    for place, child in enumerate(tree.args):
        hidden = tree.kind in ("power", "index") and place
        # arguments of sines, rotations and similar functions are left out
        inside = tree.kind == "call" and tree.value in (*OPPOSITE, "diff", "integrate", *ROTATIONS, "eye")
        if not hidden and not inside and child != TIME:
            yield from _pieces(child, (*path, place), tree.kind == "sum")


def _candidate(numeric: NumericFilter, place: str, path: Path, made: Node, edit: tuple[str, float]) -> Candidate:
    code, cost = edit
    tree = flattened(replaced(numeric.tree_at(place), path, made))
    tree = normalise_factors(tree) if code == "factor" else tree
    change = Change(place, Edit(code, cost + COST["per_level"] * len(path), path, tree))
    return Candidate(change.cost, code, (change,))


def _needed(numeric: NumericFilter, place: str, path: Path, made: Node, start: Values) -> Values | None:
    """Return the values that an unknown part of ``made`` must have to make the claim true at the test points.

    In ``made``, the placeholder ``HOLE`` stands for the unknown part. The formula ``made`` replaces the part of the
    claim at ``path`` in the side or definition ``place``. The secant method computes one value for each test point,
    from the first guess in ``start``. Return None if it fails at a point.
    """
    tree = replaced(numeric.tree_at(place), path, made)
    if place not in SIDES and not numeric.sensible(place, tree):
        return None
    change = [Change(place, Edit("none", 0.0, path, tree))]
    values = []
    for point, value in zip(numeric.points, start, strict=True):
        needed = _root(numeric, point, change, value)
        if needed is None:
            return None
        values.append(needed)
    return tuple(values)


def _root(numeric: NumericFilter, point: Point, change: Sequence[Change], start: float) -> float | None:
    """Return the value of the placeholder ``HOLE`` that makes both sides equal at a point; None if the search fails."""

    def differences(value: float) -> list[float]:
        point.symbols[HOLE.value] = value
        return numeric.differences(point, change)

    try:
        # the secant method
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


Correction = tuple[Node, tuple[str, float]]
"""A new formula for a part of the claim, with (code, cost) of the fault that it corrects; rarer faults cost more."""


def _corrections(
    numeric: NumericFilter,
    vocabulary: Vocabulary,
    piece: Node,
    values: Values,
    needed: Values,
    is_term: bool,
    is_outer: bool,
) -> Iterator[Correction]:
    """Yield (formula, (code, cost) of the fault) for formulas with the values ``needed`` that may replace ``piece``.

    ``piece`` is a part of the claim, and ``values`` are its present values. ``is_term`` says whether it is a term of a
    sum, ``is_outer`` whether it is a side of the claim, or a term or factor of a side.
    """
    if all(abs(b) <= CLOSE * abs(a) for a, b in zip(values, needed, strict=True)):
        return  # the piece would have to vanish
    ratios = tuple(b / a for a, b in zip(values, needed, strict=True))
    plain = _rational(ratios, LARGEST_OF_SIDE if is_outer else LARGEST_RATIO)
    if plain is not None:
        if plain == -1:
            yield negated(piece), ("sign_of_term", COST["solved_sign"])
        elif piece.kind != "neg":
            by_two = plain in (2, Fraction(1, 2), -2, Fraction(-1, 2))
            yield scaled(piece, plain), ("factor", COST["solved_factor_2" if by_two else "solved_rational_factor"])
    constant = _rational(needed)
    if piece.kind in ("name", "call"):
        for entry, ratio in vocabulary.find(needed):
            if len(entry.factors) == 1 and ratio == 1 and entry.factors[0].kind in ("name", "call"):
                yield entry.node, _exchanged(numeric, piece, entry.factors[0])
    elif piece.kind == "number" and constant is not None:
        yield number(constant), ("factor", COST["solved_number"])
    if plain is None and constant is None:
        least = COST["solved_factor"] + (COST["solved_factor_of_number"] if piece.kind == "number" else 0.0)
        for factors, upward in ((ratios, True), (tuple(1 / ratio for ratio in ratios if ratio), False)):
            if len(factors) == len(ratios):
                for entry, ratio in vocabulary.find(factors):
                    yield _multiplied(piece, entry, ratio, upward), ("factor", _cost(least, entry, ratio))
                    break
    lacking = tuple(b - a for a, b in zip(values, needed, strict=True))
    if _is_multiple_of_term(vocabulary, piece, lacking):
        return
    if not is_term and piece.kind != "neg" and not (plain and not is_nontrivial(piece)):
        for entry, ratio in vocabulary.find(lacking):
            if not entry.factors and ratio not in ONES:
                continue
            made = sum_of([piece, scaled(entry.node, ratio)])
            least = COST["solved_term_of_sum" if piece.kind == "sum" else "solved_term"]
            yield made, ("missing_term", _cost(least, entry, ratio))
            break


def _is_multiple_of_term(vocabulary: Vocabulary, piece: Node, lacking: Values) -> bool:
    """Return whether ``lacking`` is a multiple of a term of ``piece``: of b, if ``a + 2*b`` should be ``a + 3*b``.

    ``lacking`` are the values that the piece should have minus its present values.
    """
    # such a piece has the right terms
    for node in piece.args if piece.kind == "sum" else (piece,):
        values = vocabulary.values(node)
        if values and _rational([a / b for a, b in zip(lacking, values, strict=True)]) is not None:
            return True
    return False


def _exchanged(numeric: NumericFilter, piece: Node, other: Node) -> tuple[str, float]:
    if piece.kind == other.kind == "call" and OPPOSITE.get(piece.value) == other.value and piece.args == other.args:
        return "sin_cos_swap", COST["solved_swap"]
    near = piece.kind == other.kind == "name" and other.value in neighbours(piece.value, numeric.names)
    return "wrong_symbol", COST["solved_neighbour" if near else "solved_symbol"]


def _cost(base_cost: float, entry: Entry, ratio: Fraction) -> float:
    """Return the cost of inserting ``ratio`` times ``entry``: ``base_cost``, and more for long products and ratios."""
    size = sum(1 + sum(1 for _ in walk(factor)) // 3 for factor in entry.factors)
    return base_cost + COST["per_piece_added"] * size + (0.0 if abs(ratio) == 1 else COST["rational_in_front"])


def _multiplied(piece: Node, entry: Entry, ratio: Fraction, upward: bool) -> Node:
    inner, negative = (piece.args[0], True) if piece.kind == "neg" else (piece, False)
    if upward:
        made = scaled(product([inner, *entry.factors]), ratio)
    else:
        below = [Node("inv", None, (factor,)) for factor in entry.factors]
        made = scaled(product([inner, *below]), 1 / ratio)
    return negated(made) if negative else made


# -- matrices ---------------------------------------------------------------------------------------------------------


def _of_matrix(
    numeric: NumericFilter, vocabulary: Vocabulary, place: str, path: Path, piece: Node
) -> Iterator[Candidate]:
    """Yield repairs that multiply the matrix ``piece`` by a scalar, or add a scalar times another matrix to it."""
    if piece.kind == "call" and piece.value == "Matrix" and path:
        return
    unit = (1.0,) * len(numeric.points)
    needed = _needed(numeric, place, path, product([HOLE, piece]), unit)
    for entry, ratio in vocabulary.find(needed or ()) if needed else ():
        made = scaled(product([*entry.factors, piece]), ratio)
        yield _candidate(numeric, place, path, made, ("factor", _cost(COST["solved_factor"], entry, ratio)))
        break
    if piece.kind == "neg" or (path and piece.kind in ("name", "call")):
        return
    for other in _matrices(numeric, piece):
        needed = _needed(numeric, place, path, sum_of([piece, product([HOLE, other])]), (0.0,) * len(numeric.points))
        for entry, ratio in vocabulary.find(needed) if needed else ():
            added = scaled(product([*entry.factors, other]), ratio)
            cost = _cost(COST["solved_term_of_sum"], entry, ratio) + COST["solved_matrix_term"]
            yield _candidate(numeric, place, path, sum_of([piece, added]), ("missing_term", cost))
            break


def _matrices(numeric: NumericFilter, piece: Node) -> list[Node]:
    """Return at most MOST_MATRICES matrices with the shape of ``piece``: parts of the claim, its named matrices, their
    transposes, and products of two of the named or transposed ones.
    """
    shape = _shape(numeric, piece)
    written = [node for place in numeric.places for _, node in walk(numeric.tree_at(place)) if numeric.is_matrix(node)]
    named = [Node("name", name) for name in sorted(numeric.matrix_names)]
    single = [*named, *(Node("transpose", None, (node,)) for node in named)]
    plain = [node.args[0] if node.kind == "neg" else node for node in written if node.kind not in ("list", "sum")]
    pairs = [product([a, b]) for a in single for b in single]
    fitting = (node for node in dict.fromkeys([*plain, *single, *pairs]) if _shape(numeric, node) == shape)
    return list(islice(fitting, MOST_MATRICES))


def _shape(numeric: NumericFilter, node: Node) -> tuple[int, int] | None:
    try:
        value = numeric.points[0].value(node)
    except UndefinedValue:
        return None
    return (len(value), len(value[0])) if isinstance(value, tuple) and any(entries_of(value)) else None
