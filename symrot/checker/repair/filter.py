"""The numeric filter: it evaluates edited claims at two points in double precision, to discard false ones quickly.

The work is bounded by a count of evaluated parts, so that every run gives the same repairs.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import TIME, Node, Path, factors_of, is_derivative, text, walk
from symrot.checker.latex.cursor import MATRIX_CALLS
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.single import Edit
from symrot.checker.repair.points import Point, UndefinedValue, agree, entries_of, points

__all__ = ["SIDES", "Candidate", "Change", "NumericFilter", "at", "is_nontrivial", "matrix_entries"]

MOST_PIECES = 500_000
"""The largest number of nodes of formulas that the search for repairs of a claim may evaluate: some seconds of work.

A node counts more than once if it has many arguments, or is evaluated for its derivatives too.
"""

SIDES = ("right", "left")


@dataclass(frozen=True)
class Change:
    """An edit of one tree of a claim; ``place`` is ``"left"``, ``"right"`` or the name of the edited definition."""

    place: str
    edit: Edit

    @property
    def cost(self) -> float:
        return self.edit.cost + (0.0 if self.place in SIDES else COST["in_definition"])


class Candidate(NamedTuple):
    """A possible repair of a claim: its cost, the code of the fault that it corrects, and its changes."""

    cost: float
    code: str
    changes: tuple[Change, ...]


class NumericFilter:
    """A fast test of repairs: it evaluates the edited claim at points that obey the equations among the hypotheses.

    When about ``most_pieces`` nodes of formulas have been evaluated, every further test fails.
    """

    def __init__(self, claim: Claim, most_pieces: int = MOST_PIECES) -> None:
        assert claim.relation is not None
        self.claim, self.most_pieces = claim, most_pieces
        _, self.left, self.right = claim.relation
        self.definitions = dict(claim.define)
        trees = [self.left, self.right, *self.definitions.values()]
        own_pieces = frozenset(id(node) for tree in trees for _, node in walk(tree))
        names = _named(trees)
        self.functions = sorted({*claim.functions, *(name for name, called in names if called)})
        loose = {name for name, called in names if not called and claim.implied and name != "pi"}
        loose -= {*self.definitions}  # a vector has the value of its components
        self.symbols = sorted({*claim.symbols, *loose, "t"} - {*self.functions, *self.definitions})
        hypotheses = [relation[1:] for relation in claim.hypotheses if relation[0] == "=="]
        narrow = any(node.value in ("asin", "acos") for tree in trees for _, node in walk(tree))
        most = 0.9 if narrow else 1.7
        self.points = points(self.symbols, self.functions, self.definitions, hypotheses, own_pieces, most=most)
        values = claim.definitions.values
        self.matrix_names = {name for name, value in values.items() if getattr(value, "is_Matrix", False)}
        self.moving = any(is_derivative(node) for tree in trees for _, node in walk(tree))
        self.used = self._used_definitions()
        self.dependent: dict[str, set[int | str]] = {}
        self.wrong = self._wrong_entries()

    # -- the claim --------------------------------------------------------------------------------------------------

    @property
    def places(self) -> tuple[str, ...]:
        """The parts of the claim that repairs may edit: ``"left"``, ``"right"`` and the names of used definitions."""
        return tuple(place for place in (*SIDES, *self.used) if place in self.claim.editable)

    @property
    def sides_to_edit(self) -> tuple[str, ...]:
        """The sides that repairs may edit: usually both, "right" and "left"."""
        return tuple(place for place in SIDES if place in self.claim.editable)

    @property
    def names(self) -> list[str]:
        """The names in the claim: symbols and definitions."""
        return [name for name in (*self.symbols, *self.definitions) if name != "t"]

    def tree_at(self, place: str) -> Node:
        tree: Node = getattr(self, place) if place in SIDES else self.definitions[place]
        return tree

    def _used_definitions(self) -> list[str]:
        used: list[str] = []
        stack = [self.left, self.right]
        while stack:
            for _, node in walk(stack.pop()):
                if node.kind == "name" and node.value in self.definitions and node.value not in used:
                    used.append(node.value)
                    stack.append(self.definitions[node.value])
        return used

    def is_matrix(self, node: Node) -> bool:
        """Return whether a part of a formula is a matrix, judged by its form and by the definitions of the claim."""
        if node.kind == "name":
            return node.value in self.matrix_names
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        return node.kind not in ("index", "list", "number") and any(map(self.is_matrix, node.args))

    def sensible(self, place: str, tree: Node) -> bool:
        """Return whether ``tree`` may replace a side or definition of the claim.

        ``place`` is "left", "right" or the name of the definition. No mere number may replace a formula, no edit
        may divide a factor by itself, and a definition may use neither its own name nor that of a later definition.
        """
        if _divides_by_itself(tree) and not _divides_by_itself(self.tree_at(place)):
            return False
        if place in SIDES:
            return is_nontrivial(tree) or not is_nontrivial(self.tree_at(place))
        order = list(self.definitions)
        later = set(order[order.index(place) :])
        return is_nontrivial(tree) and not any(node.kind == "name" and node.value in later for _, node in walk(tree))

    def edited(self, changes: Sequence[Change]) -> Claim:
        """Return the claim after ``changes``: each replaces one side or definition by its edited tree."""
        return self.claim.with_parts({change.place: change.edit.tree for change in changes})

    def text(self, changes: Sequence[Change]) -> str:
        """Return the claim after ``changes`` as text for a repair: the equation, and the edited definitions."""
        edited = self.edited(changes)
        assert edited.relation is not None
        claim = f"{text(edited.relation[1])} == {text(edited.relation[2])}"
        within = [change for change in changes if change.place in self.definitions]
        changed = [f"{change.place} = {text(change.edit.tree)}" for change in within]
        return f"{claim} with {', '.join(changed)}" if changed else claim

    # -- wrong entries ----------------------------------------------------------------------------------------------

    def _wrong_entries(self) -> set[int]:
        """Return the numbers of the matrix entries in which the sides differ, counted row by row."""
        wrong: set[int] = set()
        for point in self.points:
            try:
                agreement = agree(*self.sides(point, ()))
            except UndefinedValue:
                continue
            wrong |= {place for place, equal in enumerate(agreement or ()) if not equal}
        return wrong

    def tried_paths(self, place: str, tree: Node) -> "TriedPaths":
        """Return a function of a path: whether an edit of the part of ``tree`` at this path could make the claim true.

        ``tree`` is the side or definition ``place`` of the claim. If it is a matrix with several wrong entries, an edit
        of one entry cannot correct them all; so the function returns False for each path into an entry.
        """
        cells = matrix_entries(tree) if place in SIDES else {}
        only_wrong = [cells[number] for number in self.wrong if number in cells] if len(self.wrong) == 1 else []
        return TriedPaths(tuple(cells.values()), tuple(only_wrong))

    # -- values -----------------------------------------------------------------------------------------------------

    def affordable(self) -> bool:
        return sum(point.spent[0] for point in self.points) < self.most_pieces

    def sides(self, point: Point, changes: Sequence[Change]) -> tuple[Any, Any]:
        left, right = self.left, self.right
        for change in changes:
            if change.place == "left":
                left = change.edit.tree
            elif change.place == "right":
                right = change.edit.tree
            else:
                point = self.redefined(point, change.place, change.edit.tree)
        return point.value(left), point.value(right)

    def redefined(self, point: Point, name: str, tree: Node) -> Point:
        """Return a copy of a test point that evaluates the name ``name`` by the formula ``tree``.

        The copy keeps the stored values that do not depend on the definition of ``name``.
        """
        if name not in self.dependent:
            self.dependent[name] = self._dependent_on(name)
        stale = self.dependent[name]
        known = {key: value for key, value in point.known.items() if key not in stale}
        return replace(point, definitions={**point.definitions, name: tree}, known=known, lifted={})

    def _dependent_on(self, name: str) -> set[int | str]:
        """Return the names of definitions, and the ids of trees, that depend on the definition of ``name``."""
        names = {name}
        for other, tree in self.definitions.items():
            if any(node.kind == "name" and node.value in names for _, node in walk(tree)):
                names.add(other)
        dependents: set[int | str] = {*names}

        def depends(node: Node) -> bool:
            inside = [depends(child) for child in node.args]
            if any(inside) or (node.kind == "name" and node.value in names):
                dependents.add(id(node))
                return True
            return False

        for place in (*SIDES, *self.definitions):
            depends(self.tree_at(place))
        return dependents

    def holds(self, changes: Sequence[Change]) -> bool:
        """Return whether the claim after ``changes`` is true at the test points.

        Return False if there are no test points, if the budget of evaluations is spent, or if a side has no value. Two
        sides that are zero count as equal only if a side of the claim had no letters and functions before the changes,
        as in ``x == 0``.
        """
        if not self.points or not self.affordable():
            return False
        for point in self.points:
            try:
                left, right = self.sides(point, changes)
                same = agree(left, right)
            except UndefinedValue:
                return False
            if same is None or not all(same):
                return False
        return any(entries_of(left)) or not (is_nontrivial(self.left) and is_nontrivial(self.right))

    def differences(self, point: Point, changes: Sequence[Change]) -> list[float]:
        """Return left minus right of an edited claim at a point, for each entry; a side 0 may stand for a zero matrix.

        Raises
        ------
        UndefinedValue
            If a side has no value, or the sides have different numbers of entries.
        """
        left, right = (entries_of(value) for value in self.sides(point, changes))
        size = max(len(left), len(right))
        left, right = (side * size if side == [0.0] else side for side in (left, right))
        if len(left) != len(right):
            raise UndefinedValue("expected two sides of the same shape, got different shapes")
        return [a - b for a, b in zip(left, right, strict=True)]

    def fingerprint(self, changes: Sequence[Change]) -> tuple[float, ...]:
        """Return the values of both sides after ``changes`` at the first test point, rounded to 9 digits.

        Raise UndefinedValue if a side has no value there.
        """
        # repairs with equal values are most likely the same formula, written in two ways
        left, right = self.sides(self.points[0], changes)
        return tuple(float(f"{value:.9g}") for value in (*entries_of(left), *entries_of(right)))


@dataclass(frozen=True)
class TriedPaths:
    """A function of a path in a tree: whether an edit of the part at this path could make the claim true.

    If a matrix has several wrong entries, an edit inside one entry cannot make the claim true.
    """

    cells: tuple[Path, ...]  # paths of the entries, if the tree is a written-out matrix
    only_wrong: tuple[Path, ...]  # path of the only wrong entry; empty if several entries are wrong

    def __call__(self, path: Path) -> bool:
        """Return False for a part inside a matrix entry that is not the only wrong entry; True for other parts."""
        inside = next((cell for cell in self.cells if path[: len(cell)] == cell), None)
        return inside is None or inside in self.only_wrong


def _named(trees: Sequence[Node]) -> set[tuple[str, bool]]:
    """Return the names in the trees that are not built in, as pairs (name, whether it is written with ``(t)``)."""
    names = set()
    for tree in trees:
        for _, node in walk(tree):
            if node.kind == "name":
                names.add((node.value, False))
            elif node.kind == "call" and node.args == (TIME,):
                names.add((node.value, True))
    return {(name, called) for name, called in names if name not in BUILT_IN}


def is_nontrivial(tree: Node) -> bool:
    """Return whether a tree contains a name other than pi, or the call of a function such as ``sqrt`` or ``Matrix``."""
    return any(node.kind in ("name", "call") and node.value != "pi" for _, node in walk(tree))


def _divides_by_itself(tree: Node) -> bool:
    """Return whether a product in a tree multiplies and divides by the same factor, such as y in ``x/y*y``.

    Factors that are numbers do not count.
    """
    for _, node in walk(tree):
        if node.kind == "product":
            below = {part for factor in node.args if factor.kind == "inv" for part in factors_of(factor.args[0])}
            if any(factor in below and factor.kind != "number" for factor in node.args):
                return True
    return False


def at(tree: Node, path: Sequence[int]) -> Node | None:
    """Return the part of a tree to which a path leads, or None if the tree has no such path."""
    for place in path:
        if place >= len(tree.args):
            return None
        tree = tree.args[place]
    return tree


def matrix_entries(tree: Node) -> dict[int, Path]:
    """Return {number: path} for the entries of a written-out matrix, numbered row by row; empty for other trees."""
    if tree.kind == "call" and tree.value == "diag":
        return {place * (len(tree.args) + 1): (place,) for place in range(len(tree.args))}
    if tree.kind != "call" or tree.value != "Matrix" or tree.args[0].kind != "list":
        return {}
    rows = tree.args[0].args
    if not all(row.kind == "list" for row in rows):
        return {r: (0, r) for r in range(len(rows))}
    return {r * len(row.args) + c: (0, r, c) for r, row in enumerate(rows) for c in range(len(row.args))}


def pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield (path, node) for the parts of a tree that an edit may multiply or add to, such as terms and factors."""
    if tree.kind not in ("list", "inv"):
        yield path, tree
    for place, child in enumerate(tree.args):
        # exponents, and the variables of derivatives and integrals
        fixed = tree.kind == "power" or (tree.kind == "call" and tree.value in ("diff", "integrate"))
        if not (fixed and place):
            yield from pieces(child, (*path, place))
