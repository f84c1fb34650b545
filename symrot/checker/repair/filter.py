"""Values of a claim with changed trees at two points, in double precision: what cannot be true is thrown out here.

Pieces that a change leaves alone are evaluated once. The work is bounded by a count of evaluated pieces, so that all
runs find the same.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.tree import Node, Path, text, walk
from symrot.checker.latex.cursor import TIME
from symrot.checker.latex.matrices import MATRIX_CALLS
from symrot.checker.repair.edits import Edit
from symrot.checker.repair.points import Point, UndefinedValue, agree, entries_of, points

__all__ = ["SIDES", "Change", "Found", "NumericFilter", "at", "is_nontrivial", "matrix_entries"]

MOST_PIECES = 500_000
"""Pieces of trees that the search may evaluate: some seconds."""

SIDES = ("right", "left")


@dataclass(frozen=True)
class Change:
    """An edit of one of the trees of a claim: a side, ``"left"`` or ``"right"``, or a definition by name."""

    place: str
    edit: Edit

    @property
    def cost(self) -> float:
        return self.edit.cost + (0.0 if self.place in SIDES else 0.4)


Found = tuple[float, str, tuple[Change, ...]]
"""Cost, code, and the changes that make a repair."""


class NumericFilter:
    """A claim at points that obey its hypotheses, and what becomes of its sides when trees are changed."""

    def __init__(self, claim: Claim) -> None:
        assert claim.relation is not None
        self.claim = claim
        _, self.left, self.right = claim.relation
        self.definitions = dict(claim.define)
        trees = [self.left, self.right, *self.definitions.values()]
        kept = frozenset(id(node) for tree in trees for _, node in walk(tree))
        found = _named(trees)
        self.functions = sorted({*claim.functions, *(name for name, called in found if called)})
        loose = {name for name, called in found if not called and claim.implied and name != "pi"}
        self.symbols = sorted({*claim.symbols, *loose, "t"} - {*self.functions})
        hypotheses = [relation[1:] for relation in claim.hypotheses if relation[0] == "=="]
        narrow = any(node.value in ("asin", "acos") for tree in trees for _, node in walk(tree))
        most = 0.9 if narrow else 1.7
        self.points = points(self.symbols, self.functions, self.definitions, hypotheses, kept, most=most)
        values = claim.definitions.values
        self.matrix_names = {name for name, value in values.items() if getattr(value, "is_Matrix", False)}
        self.moving = any(node.kind == "call" and node.value == "diff" for tree in trees for _, node in walk(tree))
        self.used = self._used_definitions()
        self.dependent: dict[str, set[int | str]] = {}
        self.wrong = self._wrong_entries()

    # -- the claim --------------------------------------------------------------------------------------------------

    @property
    def places(self) -> tuple[str, ...]:
        """The sides, and the definitions that the claim uses."""
        return (*SIDES, *self.used)

    @property
    def names(self) -> list[str]:
        """Symbols and definitions."""
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
        """Return whether a piece is a matrix, by its form and the definitions."""
        if node.kind == "name":
            return node.value in self.matrix_names
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        return node.kind not in ("index", "list", "number") and any(map(self.is_matrix, node.args))

    def sensible(self, place: str, tree: Node) -> bool:
        """Return whether an edited side still is_nontrivial of something, and a definition does not refer to itself."""
        if place in SIDES:
            return is_nontrivial(tree) or not is_nontrivial(self.tree_at(place))
        order = list(self.definitions)
        later = set(order[order.index(place) :])
        return is_nontrivial(tree) and not any(node.kind == "name" and node.value in later for _, node in walk(tree))

    def edited(self, changes: Sequence[Change]) -> Claim:
        """Return the claim with its trees changed."""
        trees = {change.place: change.edit.tree for change in changes}
        relation = ("==", trees.get("left", self.left), trees.get("right", self.right))
        if not trees.keys() & self.definitions.keys():
            return self.claim.with_relation(relation)
        define = tuple((name, trees.get(name, tree)) for name, tree in self.claim.define)
        return replace(self.claim, relation=relation, define=define)

    def text(self, changes: Sequence[Change]) -> str:
        """Return a repair as text: the claim, and the definitions that change."""
        edited = self.edited(changes)
        assert edited.relation is not None
        claim = f"{text(edited.relation[1])} == {text(edited.relation[2])}"
        within = [change for change in changes if change.place in self.definitions]
        changed = [f"{change.place} = {text(change.edit.tree)}" for change in within]
        return f"{claim} with {', '.join(changed)}" if changed else claim

    # -- where it is wrong ------------------------------------------------------------------------------------------

    def _wrong_entries(self) -> set[int]:
        """Return the numbers of the entries in which the sides differ, row by row."""
        wrong: set[int] = set()
        for point in self.points:
            try:
                same = agree(*self.sides(point, ()))
            except UndefinedValue:
                continue
            wrong |= {place for place, held in enumerate(same or ()) if not held}
        return wrong

    def open_paths(self, place: str, tree: Node) -> "Open":
        """Return which pieces one edit may change: of entries that are written out, only one that alone is wrong."""
        cells = matrix_entries(tree) if place in SIDES else {}
        alone = [cells[number] for number in self.wrong if number in cells] if len(self.wrong) == 1 else []
        return Open(tuple(cells.values()), tuple(alone))

    # -- the sieve --------------------------------------------------------------------------------------------------

    def affordable(self) -> bool:
        return sum(point.spent[0] for point in self.points) < MOST_PIECES

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
        """Return a point with another definition; what does not depend on it keeps its value."""
        if name not in self.dependent:
            self.dependent[name] = self._dependent_on(name)
        forgotten = self.dependent[name]
        known = {key: value for key, value in point.known.items() if key not in forgotten}
        return replace(point, definitions={**point.definitions, name: tree}, known=known, lifted={})

    def _dependent_on(self, name: str) -> set[int | str]:
        """Return the definitions, by name, and the pieces, by identity, whose values change with a definition."""
        names = {name}
        for other, tree in self.definitions.items():
            if any(node.kind == "name" and node.value in names for _, node in walk(tree)):
                names.add(other)
        found: set[int | str] = {*names}

        def depends(node: Node) -> bool:
            inside = [depends(child) for child in node.args]
            if any(inside) or (node.kind == "name" and node.value in names):
                found.add(id(node))
                return True
            return False

        for place in (*SIDES, *self.definitions):
            depends(self.tree_at(place))
        return found

    def holds(self, changes: Sequence[Change]) -> bool:
        """Return whether an edited claim holds at the points, and not because a side has become zero."""
        if not self.affordable():
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
        """Return left minus right entry by entry.

        Raises
        ------
        UndefinedValue
            Where a side has no value, or the shapes differ.
        """
        left, right = (entries_of(value) for value in self.sides(point, changes))
        size = max(len(left), len(right))
        left, right = (side * size if side == [0.0] else side for side in (left, right))
        if len(left) != len(right):
            raise UndefinedValue("sides of two shapes")
        return [a - b for a, b in zip(left, right, strict=True)]

    def fingerprint(self, changes: Sequence[Change]) -> tuple[float, ...]:
        """Return the values of both sides at a point, the same for two ways of writing one repair."""
        left, right = self.sides(self.points[0], changes)
        return tuple(float(f"{value:.9g}") for value in (*entries_of(left), *entries_of(right)))


@dataclass(frozen=True)
class Open:
    """The entries of a matrix that is written out, and those of them in which one edit may be the repair."""

    cells: tuple[Path, ...]
    alone: tuple[Path, ...]

    def __call__(self, path: Path) -> bool:
        """Return whether a piece lies outside all entries, or inside one that alone is wrong."""
        inside = next((cell for cell in self.cells if path[: len(cell)] == cell), None)
        return inside is None or inside in self.alone


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


def is_nontrivial(tree: Node) -> bool:
    """Return whether a tree holds a symbol or is a matrix: a bare number says nothing."""
    return any(node.kind in ("name", "call") and node.value != "pi" for _, node in walk(tree))


def at(tree: Node, path: Sequence[int]) -> Node | None:
    """Return the piece at a path; None where the path leads nowhere."""
    for place in path:
        if place >= len(tree.args):
            return None
        tree = tree.args[place]
    return tree


def matrix_entries(tree: Node) -> dict[int, Path]:
    """Return the paths of the entries of a matrix that is written out, by their number row by row."""
    if tree.kind == "call" and tree.value == "diag":
        return {place * (len(tree.args) + 1): (place,) for place in range(len(tree.args))}
    if tree.kind != "call" or tree.value != "Matrix" or tree.args[0].kind != "list":
        return {}
    rows = tree.args[0].args
    if not all(row.kind == "list" for row in rows):
        return {r: (0, r) for r in range(len(rows))}
    return {r * len(row.args) + c: (0, r, c) for r, row in enumerate(rows) for c in range(len(row.args))}


def pieces(tree: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield the pieces that may lack something: no exponents, no variables of derivatives and integrals."""
    if tree.kind not in ("list", "inv"):
        yield path, tree
    for place, child in enumerate(tree.args):
        fixed = tree.kind == "power" or (tree.kind == "call" and tree.value in ("diff", "integrate"))
        if not (fixed and place):
            yield from pieces(child, (*path, place))
