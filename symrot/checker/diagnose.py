"""What is wrong with a claim that is not true, and the nearest formulas that are: search, sieve, proof.

Edits of the text are sieved by values at two points in double precision; what passes is decided by the exact engine,
and only what it proves is offered. The work is bounded by a count of evaluated pieces, so all runs find the same.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, islice
from typing import Any

from symrot.checker.claims import Claim
from symrot.checker.decision import Decision, decide_problem, shown
from symrot.checker.edits import TEXTS, Edit, neat, single_edits
from symrot.checker.latex import MATRIX_CALLS, TIME
from symrot.checker.meaning import BUILT_IN
from symrot.checker.points import Meaningless, Point, agree, entries_of, points
from symrot.checker.reader import read_expression
from symrot.checker.tree import Node, negated, number, product, replaced, sum_of, text, walk
from symrot.checker.verdict import Diagnosis, Repair
from symrot.errors import InputError
from symrot.exact.decide import flatten, normal_form
from symrot.exact.ratio import TooLarge

__all__ = ["diagnose"]

MOST_PIECES = 400_000
"""Pieces of trees that the search may evaluate: some seconds."""

MOST_EDITED = 200_000
"""Pieces of edited trees that may be made of one tree."""

MOST_PAIRS_OF = 90
MOST_PROOFS = 10
MOST_BRACKETS = 8
MOST_REPAIRS = 3


MOST_LETTERS = 120
"""Length of a missing term that is still offered."""


@dataclass(frozen=True)
class Change:
    """An edit of one of the trees of a claim: a side, ``"left"`` or ``"right"``, or a definition by name."""

    place: str
    edit: Edit

    @property
    def cost(self) -> float:
        return self.edit.cost + (0.0 if self.place in ("left", "right") else 0.4)


Found = tuple[float, str, tuple[Change, ...]]
"""Cost, code, and the changes that make a repair."""


def diagnose(claim: Claim, decision: Decision) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return what is probably wrong, and at most three proven repairs, the nearest first.

    Parameters
    ----------
    claim : Claim
        With a relation.
    decision : Decision
        Its outcome, ``"false"`` or ``"conditional"``.
    """
    repairs = _Search(claim).repairs()
    if decision.requires:
        needed = decision.requires[0]
        return Diagnosis(needed.code, f"{TEXTS[needed.code]}: {needed.text}"), repairs
    if not repairs:
        return Diagnosis("none", ""), ()
    return Diagnosis(repairs[0].code, TEXTS[repairs[0].code]), repairs


class _Search:
    def __init__(self, claim: Claim) -> None:
        assert claim.relation is not None
        self.claim = claim
        _, self.left, self.right = claim.relation
        self.definitions = dict(claim.define)
        trees = [self.left, self.right, *self.definitions.values()]
        meaning = claim.meaning()
        claim.problem()
        kept = frozenset(id(node) for tree in trees for _, node in walk(tree))
        found = _named(trees)
        implied = claim.implied
        self.functions = sorted({*claim.functions, *(name for name, called in found if called)})
        loose = {name for name, called in found if not called and implied and name != "pi"}
        self.symbols = sorted({*claim.symbols, *loose, "t"} - {*self.functions})
        hypotheses = [relation[1:] for relation in claim.given if relation[0] == "=="]
        self.points = points(self.symbols, self.functions, self.definitions, hypotheses, kept)
        self.matrix_names = {name for name, value in meaning.values.items() if getattr(value, "is_Matrix", False)}
        self.seen: set[tuple[float, ...]] = set()
        self.moving = any(node.kind == "call" and node.value == "diff" for tree in trees for _, node in walk(tree))

    # -- the search -------------------------------------------------------------------------------------------------

    def repairs(self) -> tuple[Repair, ...]:
        """Return the proven repairs."""
        if len(self.points) < 2:
            return ()
        changes = sorted(self.changes(), key=lambda change: (change.cost, change.place))
        passed: list[Found] = [(c.cost, c.edit.code, (c,)) for c in changes if self.holds([c])]
        of_claim = [found for found in passed if not self.within(found)]
        stages: Sequence[tuple[float, Callable[[], Iterable[Found]]]] = (
            (0.0, lambda: sorted([*of_claim, *self.by_entries()], key=lambda found: found[0])),
            (1.1, self.fitted),
            (1.1, lambda: filter(self.within, passed)),
            (1.5, self.missing),
            (1.3, self.renamed),
        )
        repairs: list[Repair] = []
        for dear, stage in stages:
            if len(repairs) < MOST_REPAIRS and all(repair.cost >= dear for repair in repairs):
                repairs += self.proven(stage(), MOST_REPAIRS - len(repairs))
        if not repairs:
            repairs = self.proven(self.pairs(changes), MOST_REPAIRS)
        return tuple(sorted(repairs, key=lambda repair: repair.cost))

    def within(self, found: Found) -> bool:
        """Return whether a repair changes a definition."""
        return any(change.place in self.definitions for change in found[2])

    def affordable(self) -> bool:
        return sum(point.spent[0] for point in self.points) < MOST_PIECES

    def changes(self) -> Iterator[Change]:
        names = [name for name in (*self.symbols, *self.definitions) if name != "t"]
        used = self.used_definitions()
        for place, tree in (("right", self.right), ("left", self.left), *((n, self.definitions[n]) for n in used)):
            seen = {tree}
            edits = single_edits(tree, names, self.functions, self.is_matrix, self.moving)
            for edit in islice(edits, MOST_EDITED // sum(1 for _ in walk(tree))):
                if edit.tree not in seen and self.sensible(place, edit.tree):
                    seen.add(edit.tree)
                    yield Change(place, edit)

    def used_definitions(self) -> list[str]:
        """Return the definitions that the claim uses, directly or not."""
        used: list[str] = []
        stack = [self.left, self.right]
        while stack:
            for _, node in walk(stack.pop()):
                if node.kind == "name" and node.value in self.definitions and node.value not in used:
                    used.append(node.value)
                    stack.append(self.definitions[node.value])
        return used

    def sensible(self, place: str, tree: Node) -> bool:
        """Return whether an edited side still speaks of something, and a definition does not refer to itself."""
        if place in ("left", "right"):
            return _speaks(tree) or not _speaks(getattr(self, place))
        order = list(self.definitions)
        later = set(order[order.index(place) :])
        return _speaks(tree) and not any(node.kind == "name" and node.value in later for _, node in walk(tree))

    def is_matrix(self, node: Node) -> bool:
        """Return whether a piece is a matrix, by its form and the definitions."""
        if node.kind == "name":
            return node.value in self.matrix_names
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        return node.kind not in ("index", "list", "number") and any(map(self.is_matrix, node.args))

    # -- the sieve --------------------------------------------------------------------------------------------------

    def sides(self, point: Point, changes: Sequence[Change]) -> tuple[Any, Any]:
        left, right = self.left, self.right
        for change in changes:
            if change.place == "left":
                left = change.edit.tree
            elif change.place == "right":
                right = change.edit.tree
            else:
                point = point.redefined(change.place, change.edit.tree)
        return point.value(left), point.value(right)

    def holds(self, changes: Sequence[Change]) -> bool:
        """Return whether an edited claim holds at the points, and not because a side has become zero."""
        if not self.affordable():
            return False
        for point in self.points:
            try:
                left, right = self.sides(point, changes)
                same = agree(left, right)
            except Meaningless:
                return False
            if same is None or not all(same):
                return False
        return any(entries_of(left)) or not (_speaks(self.left) and _speaks(self.right))

    def idle(self, code: str, changes: Sequence[Change]) -> bool:
        """Return whether an edit made the sides the same text by taking away what was said."""
        relation = self.edited(changes).relation
        assert relation is not None
        same = relation[1] == relation[2]
        bare = {"name", "number"} & {self.left.kind, self.right.kind}
        return same and (bool(bare) or code in ("two_faults", "extra_term", "wrong_symbol"))

    def renamed(self) -> Iterator[Found]:
        """Yield the claim with one name of a definition in the place of another."""
        used = [name for name in self.definitions if name not in self.symbols]
        for place in ("left", "right"):
            tree = self.tree_at(place)
            for path, node in walk(tree):
                for name in used if node.kind == "name" and node.value in used else ():
                    made = replaced(tree, path, _always(Node("name", name)))
                    change = Change(place, Edit("wrong_symbol", 1.3, path, made))
                    if name != node.value and self.holds([change]):
                        yield 1.3, "wrong_symbol", (change,)

    def missing(self) -> Iterator[Found]:
        """Yield the claim with the one term that it lacks, read off the exact difference of its sides."""
        problem = self.claim.problem()
        (lefts, shape), (rights, other) = flatten(problem.left), flatten(problem.right)
        if shape != other:
            return
        try:
            residuals = [normal_form(a - b, problem.hypotheses) for a, b in zip(lefts, rights, strict=True)]
        except TooLarge:
            return
        lacking = {n: term for n, term in enumerate(residuals) if term != 0}
        if any(not _is_term(term) for term in lacking.values()):
            return
        for place, sign in (("right", 1), ("left", -1)):
            tree = self.tree_at(place)
            cells = {0: ()} if shape is None else _cells(tree)
            if not _speaks(tree) or tree.kind == "name" or not lacking.keys() <= cells.keys():
                continue
            made = tree
            for number_of, term in lacking.items():
                piece = _at(made, cells[number_of])
                assert piece is not None
                added = read_expression(shown(sign * term))
                whole = added if piece == number(0) else sum_of([piece, added])
                made = replaced(made, cells[number_of], _always(whole))
            cost = 1.6 * len(lacking)
            yield cost, "missing_term", (Change(place, Edit("missing_term", cost, (), made)),)
        if shape is None:
            yield from self.missing_inside(residuals[0], problem.hypotheses)

    def missing_inside(self, residual: Any, hypotheses: Sequence[Any]) -> Iterator[Found]:
        """Yield a side with the one term that a bracket in it lacks: ``a (b + m)`` for ``a b``."""
        meaning = self.claim.meaning()
        for place, sign in (("right", 1), ("left", -1)):
            tree = self.tree_at(place)
            for path, piece in [found for found in _linear_pieces(tree) if found[0]][:MOST_BRACKETS]:
                ends = [meaning.read(replaced(tree, path, _always(number(value)))) for value in (0, 1)]
                term = normal_form(sign * residual / (ends[1] - ends[0]), hypotheses)
                if not _is_term(term):
                    continue
                made = replaced(tree, path, _always(sum_of([piece, read_expression(shown(term))])))
                yield 1.8, "missing_term", (Change(place, Edit("missing_term", 1.8, path, made)),)

    def pairs(self, changes: Sequence[Change]) -> Iterator[Found]:
        """Yield pairs of edits in different places that make the claim hold, by the budget."""
        cheap = list(changes)[:MOST_PAIRS_OF]
        ordered = sorted(combinations(cheap, 2), key=lambda pair: pair[0].cost + pair[1].cost)
        for first, second in ordered:
            if first.place == second.place:
                tree = _merged(self.tree_at(first.place), first.edit, second.edit)
                if tree is None:
                    continue
                edit = Edit("two_faults", first.edit.cost + second.edit.cost, (), tree)
                both: tuple[Change, ...] = (Change(first.place, edit),)
            else:
                both = (first, second)
            if self.holds(both):
                yield first.cost + second.cost, "two_faults", both
            if not self.affordable():
                return

    def tree_at(self, place: str) -> Node:
        tree: Node = getattr(self, place) if place in ("left", "right") else self.definitions[place]
        return tree

    # -- entries and terms ------------------------------------------------------------------------------------------

    def by_entries(self) -> list[Found]:
        """Return the repair of a matrix written out: each wrong entry by its own edit."""
        found: list[Found] = []
        for place, other in (("right", self.left), ("left", self.right)):
            tree = self.tree_at(place)
            cells = _cells(tree)
            try:
                values = [entries_of(point.value(other)) for point in self.points]
            except Meaningless:
                continue
            if not cells or any(len(value) <= max(cells) for value in values):
                continue
            edits = []
            for place_of, path in cells.items():
                targets = [value[place_of] for value in values]
                cell = _at(tree, path)
                edit = None if cell is None else self.entry_edit(cell, targets)
                if edit is None:
                    break
                if edit.code != "none":
                    edits.append((path, edit))
            else:
                if len(edits) > 1 or any(edit.code == "two_faults" for _, edit in edits):
                    made = tree
                    for path, edit in edits:
                        made = replaced(made, path, _always(edit.tree))
                    codes = {edit.code for _, edit in edits}
                    code = codes.pop() if len(codes) == 1 else "two_faults"
                    cost = 0.6 * sum(edit.cost for _, edit in edits)
                    found.append((cost, code, (Change(place, Edit(code, cost, (), made)),)))
        return found

    def entry_edit(self, cell: Node, targets: Sequence[float]) -> Edit | None:
        """Return the cheapest edit that gives an entry its values; code ``none`` if it has them."""

        def fits(tree: Node) -> bool:
            try:
                values = [point.value(tree) for point in self.points]
                return all(agree(value, target) == [True] for value, target in zip(values, targets, strict=True))
            except Meaningless:
                return False

        if fits(cell):
            return Edit("none", 0.0, (), cell)
        names = [name for name in (*self.symbols, *self.definitions) if name != "t"]
        edits = sorted(
            single_edits(cell, names, self.functions, self.is_matrix, self.moving), key=lambda edit: edit.cost
        )
        for edit in edits:
            if self.affordable() and fits(edit.tree):
                return edit
        both = combinations(edits[:MOST_PAIRS_OF], 2)
        for first, second in sorted(both, key=lambda pair: pair[0].cost + pair[1].cost):
            tree = _merged(cell, first, second)
            if tree is not None and self.affordable() and fits(tree):
                return Edit("two_faults", first.cost + second.cost, (), tree)
        return None

    def fitted(self) -> list[Found]:
        """Return repairs that give one term of a side another rational factor, or add a product of what occurs."""
        found = []
        for place, sign in (("right", 1), ("left", -1)):
            tree = self.tree_at(place)
            if not _speaks(tree):
                continue
            for path, term in _terms(tree):
                ratio = self.ratio(term, sign)
                if ratio is not None:
                    made = replaced(tree, path, _always(_scaled(term, ratio)))
                    found.append((1.3, "factor", (Change(place, Edit("factor", 1.3, path, made)),)))
            for path, made in self.multiplied(tree):
                change = Change(place, Edit("factor", 1.4 + 0.05 * len(path), path, made))
                if self.holds([change]):
                    found.append((change.cost, "factor", (change,)))
        return sorted(found, key=lambda item: item[0])

    def multiplied(self, tree: Node) -> Iterator[tuple[tuple[int, ...], Node]]:
        """Yield a tree with one piece multiplied or divided by something that occurs in the claim."""
        scalars, matrices = self.factors(), [Node("name", name) for name in sorted(self.matrix_names)]
        for path, piece in _pieces(tree):
            if self.is_matrix(piece):
                turned = [*matrices, *(Node("transpose", None, (factor,)) for factor in matrices)]
                both = [pair for factor in turned for pair in ([factor, piece], [piece, factor])]
            else:
                both = []
            both += [[piece, by] for factor in scalars for by in (factor, Node("inv", None, (factor,)))]
            for factors in both:
                yield path, replaced(tree, path, _always(product(factors)))

    def factors(self) -> list[Node]:
        """Return what may be missing as a factor: symbols, and sines and cosines that occur."""
        pieces = [node for tree in (self.left, self.right) for _, node in walk(tree)]
        kinds = [
            node for node in (*pieces, *(Node("name", name) for name in (*self.symbols, *self.definitions)))
            if (node.kind == "name" and node.value not in ("pi", "t") and not self.is_matrix(node))
            or (node.kind == "call" and (node.value in ("sin", "cos") or node.value in self.functions))
        ]  # fmt: skip
        return sorted(dict.fromkeys(kinds), key=text)

    def ratio(self, term: Node, sign: int) -> Fraction | None:
        """Return the rational by which a term must be multiplied, when all points and entries agree on it."""
        found: set[Fraction] = set()
        for point in self.points:
            try:
                left, right = (entries_of(value) for value in self.sides(point, ()))
                size = max(len(left), len(right))
                held = entries_of(point.value(term))
            except Meaningless:
                return None
            left, right = (side * size if side == [0.0] else side for side in (left, right))
            if not len(left) == len(right) == len(held):
                return None
            for a, b, c in zip(left, right, held, strict=True):
                if abs(c) < 1e-12:
                    if abs(a - b) > 1e-9:
                        return None
                    continue
                value = 1 + sign * (a - b) / c
                near = Fraction(value).limit_denominator(1000)
                if abs(value - near) > 1e-11 * abs(value) or abs(near) > 1000:
                    return None
                found.add(near)
        return found.pop() if len(found) == 1 and not found & {Fraction(0), Fraction(1)} else None

    # -- the proof --------------------------------------------------------------------------------------------------

    def proven(self, passed: Iterable[Found], most: int) -> list[Repair]:
        """Return the first repairs that the exact engine proves, none that was offered before."""
        repairs: list[Repair] = []
        attempts = 0
        for cost, code, changes in passed:
            if attempts >= MOST_PROOFS or len(repairs) == most:
                break
            values = self.fingerprint(changes)
            if values in self.seen or self.idle(code, changes):
                continue
            self.seen.add(values)
            attempts += 1
            try:
                decision = decide_problem(self.edited(changes).problem())
            except InputError:
                continue
            if decision.verdict == "true":
                repairs.append(Repair(self.text(changes), code, round(cost, 3)))
        return repairs

    def edited(self, changes: Sequence[Change]) -> Claim:
        """Return the claim with its trees changed."""
        trees = {change.place: change.edit.tree for change in changes}
        relation = ("==", trees.get("left", self.left), trees.get("right", self.right))
        define = tuple((name, trees.get(name, tree)) for name, tree in self.claim.define)
        return replace(self.claim, relation=relation, define=define)

    def fingerprint(self, changes: Sequence[Change]) -> tuple[float, ...]:
        """Return the values of both sides at a point, the same for two ways of writing one repair."""
        left, right = self.sides(self.points[0], changes)
        return tuple(float(f"{value:.9g}") for value in (*entries_of(left), *entries_of(right)))

    def text(self, changes: Sequence[Change]) -> str:
        """Return a repair as text: the claim, and the definitions that change."""
        edited = self.edited(changes)
        assert edited.relation is not None
        claim = f"{text(edited.relation[1])} == {text(edited.relation[2])}"
        within = [change for change in changes if change.place in self.definitions]
        changed = [f"{change.place} = {text(change.edit.tree)}" for change in within]
        return f"{claim} with {', '.join(changed)}" if changed else claim


def _named(trees: Sequence[Node]) -> set[tuple[str, bool]]:
    """Return (name, whether it is called with t) for every name that is no function of the language."""
    found = set()
    for tree in trees:
        for _, node in walk(tree):
            if node.kind == "name":
                found.add((node.value, False))
            elif node.kind == "call" and node.args == (TIME,):
                found.add((node.value, True))
    return {(name, called) for name, called in found if name not in BUILT_IN}


def _speaks(tree: Node) -> bool:
    """Return whether a tree holds a symbol or is a matrix: a bare number says nothing."""
    return any(node.kind in ("name", "call") and node.value != "pi" for _, node in walk(tree))


def _is_term(term: Any) -> bool:
    """Return whether an expression is one product, short and without a divisor, as a term that was left out is."""
    above, below = term.as_numer_denom()
    return bool(below.is_number and not above.is_Add and term.free_symbols and len(shown(term)) <= MOST_LETTERS)


def _pieces(tree: Node, path: tuple[int, ...] = ()) -> Iterator[tuple[tuple[int, ...], Node]]:
    """Yield the pieces that may lack a factor: no exponents, no variables of derivatives and integrals."""
    if tree.kind not in ("list", "number", "inv"):
        yield path, tree
    for place, child in enumerate(tree.args):
        fixed = tree.kind == "power" or (tree.kind == "call" and tree.value in ("diff", "integrate"))
        if not (fixed and place):
            yield from _pieces(child, (*path, place))


def _linear_pieces(tree: Node, path: tuple[int, ...] = ()) -> Iterator[tuple[tuple[int, ...], Node]]:
    """Yield the pieces in which a tree is linear and that may be brackets: factors, not divisors."""
    yield path, tree
    for place, child in enumerate(tree.args if tree.kind in ("sum", "product", "neg") else ()):
        if child.kind not in ("inv", "number") and (tree.kind != "product" or child.kind in ("sum", "name", "call")):
            yield from _linear_pieces(child, (*path, place))


def _always(made: Node) -> Callable[[Node], Node]:
    return lambda _: made


def _at(tree: Node, path: Sequence[int]) -> Node | None:
    """Return the piece at a path; None where the path leads nowhere."""
    for place in path:
        if place >= len(tree.args):
            return None
        tree = tree.args[place]
    return tree


def _cells(tree: Node) -> dict[int, tuple[int, ...]]:
    """Return the paths of the entries of a matrix that is written out, by their number row by row."""
    if tree.kind == "call" and tree.value == "diag":
        return {place * (len(tree.args) + 1): (place,) for place in range(len(tree.args))}
    if tree.kind != "call" or tree.value != "Matrix" or tree.args[0].kind != "list":
        return {}
    rows = tree.args[0].args
    if not all(row.kind == "list" for row in rows):
        return {r: (0, r) for r in range(len(rows))}
    return {r * len(row.args) + c: (0, r, c) for r, row in enumerate(rows) for c in range(len(row.args))}


def _terms(tree: Node) -> list[tuple[tuple[int, ...], Node]]:
    """Return the terms of a side with their paths: a whole side is one term."""
    if tree.kind == "sum":
        return [((place,), term) for place, term in enumerate(tree.args)]
    return [((), tree)]


def _scaled(term: Node, ratio: Fraction) -> Node:
    """Return a term times a rational, as people write it."""
    inner, negative = (term.args[0], True) if term.kind == "neg" else (term, False)
    size = abs(ratio)
    above = [] if size.numerator == 1 else [number(size.numerator)]
    below = [] if size.denominator == 1 else [Node("inv", None, (number(size.denominator),))]
    made = product([*above, inner, *below])
    return neat(negated(made) if negative != (ratio < 0) else made)


def _merged(tree: Node, first: Edit, second: Edit) -> Node | None:
    """Return a tree with two edits of pieces that are not inside each other; None if they are."""
    a, b = first.path, second.path
    if not a or not b or a[: len(b)] == b or b[: len(a)] == a:
        return None
    piece = _at(second.tree, b) if _same_shape(tree, first.tree, b) else None
    return None if piece is None else replaced(first.tree, b, _always(piece))


def _same_shape(tree: Node, edited: Node, path: Sequence[int]) -> bool:
    """Return whether a path leads to the same piece after an edit elsewhere."""
    for place in path:
        if place >= len(edited.args) or edited.kind != tree.kind or len(edited.args) != len(tree.args):
            return False
        tree, edited = tree.args[place], edited.args[place]
    return tree == edited
