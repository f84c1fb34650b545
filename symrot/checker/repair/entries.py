"""Repairs of a written-out matrix with several wrong entries: one edit for each wrong entry."""

from collections.abc import Sequence
from itertools import combinations

from symrot.checker.claim.tree import Node, Path, replaced
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.single import Edit, single_edits
from symrot.checker.repair.filter import Candidate, Change, NumericFilter, at, matrix_entries
from symrot.checker.repair.points import UndefinedValue, agree, entries_of

__all__ = ["by_entries", "merged"]

MOST_PAIRS_OF = 60
"""Number of the cheapest edits of a wrong matrix entry that are combined in pairs, if no single edit corrects it."""


def by_entries(numeric: NumericFilter) -> list[Candidate]:
    """Return repairs of a written-out matrix on one side of the claim: at most one repair for each side.

    A repair corrects all wrong entries of the matrix, each by one edit or two. A matrix gets none if an entry cannot be
    corrected so, or if a single edit of one entry is enough.
    """
    candidates: list[Candidate] = []
    # the other side has the values that the entries should have
    references = {"right": numeric.left, "left": numeric.right}
    for place in numeric.sides_to_edit:
        tree, other = numeric.tree_at(place), references[place]
        cells = matrix_entries(tree)
        try:
            values = [entries_of(point.value(other)) for point in numeric.points]
        except UndefinedValue:
            continue
        if not cells or any(len(value) <= max(cells) for value in values):
            continue
        edits = []
        for place_of, path in cells.items():
            targets = [value[place_of] for value in values]
            cell = at(tree, path)
            edit = None if cell is None else _entry_edit(numeric, cell, targets)
            if edit is None:
                break  # no edit corrects this entry
            if edit.code != "none":
                edits.append((path, edit))
        else:
            if len(edits) > 1 or any(edit.code == "two_faults" for _, edit in edits):
                made = tree
                for path, edit in edits:
                    made = replaced(made, path, edit.tree)
                codes = {edit.code for _, edit in edits}
                code = codes.pop() if len(codes) == 1 else "two_faults"
                cost = COST["share_of_entries"] * sum(edit.cost for _, edit in edits)
                candidates.append(Candidate(cost, code, (Change(place, Edit(code, cost, (), made)),)))
    return candidates


def _entry_edit(numeric: NumericFilter, cell: Node, targets: Sequence[float]) -> Edit | None:
    """Return the cheapest edit that gives ``cell`` the values ``targets`` at the test points, or None.

    A ``cell`` that has these values already gives an edit with the code ``none``.
    """

    def fits(tree: Node) -> bool:
        try:
            values = [point.value(tree) for point in numeric.points]
            return all(agree(value, target) == [True] for value, target in zip(values, targets, strict=True))
        except UndefinedValue:
            return False

    if fits(cell):
        return Edit("none", 0.0, (), cell)
    single = single_edits(cell, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    edits = sorted(single, key=lambda edit: edit.cost)
    for edit in edits:
        if numeric.affordable() and fits(edit.tree):
            return edit
    both = combinations(edits[:MOST_PAIRS_OF], 2)
    for first, second in sorted(both, key=lambda pair: pair[0].cost + pair[1].cost):
        tree = merged(cell, first, second)
        if tree is not None and numeric.affordable() and fits(tree):
            return Edit("two_faults", first.cost + second.cost, (), tree)
    return None


def merged(tree: Node, first: Edit, second: Edit) -> Node | None:
    """Return ``tree`` with both edits, made in different parts of it; None if one part contains the other.

    Return None also if the first edit moves or changes the part that the second edit applies to.
    """
    a, b = first.path, second.path
    if not a or not b or a[: len(b)] == b or b[: len(a)] == a:
        return None
    piece = at(second.tree, b) if _same_shape(tree, first.tree, b) else None
    return None if piece is None else replaced(first.tree, b, piece)


def _same_shape(tree: Node, edited: Node, path: Path) -> bool:
    """Return whether the part at ``path`` of a tree is still the same, at the same path, in the ``edited`` tree."""
    for place in path:
        if place >= len(edited.args) or edited.kind != tree.kind or len(edited.args) != len(tree.args):
            return False
        tree, edited = tree.args[place], edited.args[place]
    return tree == edited
