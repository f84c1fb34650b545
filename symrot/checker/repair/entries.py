"""Several wrong entries of a matrix that is written out, each with its own edit."""

from collections.abc import Callable, Sequence
from itertools import combinations

from symrot.checker.claim.tree import Node, Path, replaced
from symrot.checker.repair.edits import Edit, single_edits
from symrot.checker.repair.filter import Change, Found, NumericFilter, at, matrix_entries
from symrot.checker.repair.points import UndefinedValue, agree, entries_of

__all__ = ["always", "by_entries", "merged"]

MOST_PAIRS_OF = 60
"""Cheapest edits of an entry that are tried in pairs."""


def by_entries(sieve: NumericFilter) -> list[Found]:
    """Return the repair of a matrix written out: each wrong entry by its own edit."""
    found: list[Found] = []
    for place, other in (("right", sieve.left), ("left", sieve.right)):
        tree = sieve.tree_at(place)
        cells = matrix_entries(tree)
        try:
            values = [entries_of(point.value(other)) for point in sieve.points]
        except UndefinedValue:
            continue
        if not cells or any(len(value) <= max(cells) for value in values):
            continue
        edits = []
        for place_of, path in cells.items():
            targets = [value[place_of] for value in values]
            cell = at(tree, path)
            edit = None if cell is None else _entry_edit(sieve, cell, targets)
            if edit is None:
                break
            if edit.code != "none":
                edits.append((path, edit))
        else:
            if len(edits) > 1 or any(edit.code == "two_faults" for _, edit in edits):
                made = tree
                for path, edit in edits:
                    made = replaced(made, path, always(edit.tree))
                codes = {edit.code for _, edit in edits}
                code = codes.pop() if len(codes) == 1 else "two_faults"
                cost = 0.6 * sum(edit.cost for _, edit in edits)
                found.append((cost, code, (Change(place, Edit(code, cost, (), made)),)))
    return found


def _entry_edit(sieve: NumericFilter, cell: Node, targets: Sequence[float]) -> Edit | None:
    """Return the cheapest edit that gives an entry its values; code ``none`` if it has them."""

    def fits(tree: Node) -> bool:
        try:
            values = [point.value(tree) for point in sieve.points]
            return all(agree(value, target) == [True] for value, target in zip(values, targets, strict=True))
        except UndefinedValue:
            return False

    if fits(cell):
        return Edit("none", 0.0, (), cell)
    found = single_edits(cell, sieve.names, sieve.functions, sieve.is_matrix, sieve.moving)
    edits = sorted(found, key=lambda edit: edit.cost)
    for edit in edits:
        if sieve.affordable() and fits(edit.tree):
            return edit
    both = combinations(edits[:MOST_PAIRS_OF], 2)
    for first, second in sorted(both, key=lambda pair: pair[0].cost + pair[1].cost):
        tree = merged(cell, first, second)
        if tree is not None and sieve.affordable() and fits(tree):
            return Edit("two_faults", first.cost + second.cost, (), tree)
    return None


def always(made: Node) -> Callable[[Node], Node]:
    """Return the edit that puts a piece in the place of any other."""
    return lambda _: made


def merged(tree: Node, first: Edit, second: Edit) -> Node | None:
    """Return a tree with two edits of pieces that are not inside each other; None if they are."""
    a, b = first.path, second.path
    if not a or not b or a[: len(b)] == b or b[: len(a)] == a:
        return None
    piece = at(second.tree, b) if _same_shape(tree, first.tree, b) else None
    return None if piece is None else replaced(first.tree, b, always(piece))


def _same_shape(tree: Node, edited: Node, path: Path) -> bool:
    """Return whether a path leads to the same piece after an edit elsewhere."""
    for place in path:
        if place >= len(edited.args) or edited.kind != tree.kind or len(edited.args) != len(tree.args):
            return False
        tree, edited = tree.args[place], edited.args[place]
    return tree == edited
