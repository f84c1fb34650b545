"""Repairs of claims with two faults, one of which changes a whole side or definition, such as a transposed rotation.

Such a fault makes all values of a claim wrong and hides the other fault. So the search first undoes it, and then
looks for the other fault as in a claim with one fault only.
"""

from collections.abc import Iterator, Sequence
from itertools import islice

from symrot.checker.repair.edits.single import single_edits
from symrot.checker.repair.filter import Candidate, Change, NumericFilter
from symrot.checker.repair.insertions import missing_terms
from symrot.checker.repair.solve_for_piece import solutions
from symrot.errors import InputError

__all__ = ["after_whole_edits"]

FAULTS_OF_WHOLE_SIDES = (
    "overall_sign", "frame_body_space", "active_passive_transpose", "commutator_order", "quaternion_product_order",
    "wrong_sequence_type", "inertia_product_sign",
)  # fmt: skip
"""Codes of the faults that usually change all values of a side or definition, such as a transposed rotation."""

MOST_WHOLE = 14
"""The largest number of edits that undo a fault of a whole side and are tried as the first of two edits of a claim."""

MOST_EDITS = 3000
"""For each first edit: the largest number of second edits that are tried in one side or definition of the claim."""

MOST_PIECES_AFTER = 240_000
"""For each first edit: the largest number of nodes of formulas that the search for a second edit may evaluate."""


def after_whole_edits(numeric: NumericFilter, changes: Sequence[Change]) -> Iterator[Candidate]:
    """Yield repairs that each undo two faults of the claim.

    The first change is one of ``changes`` and undoes a fault of a whole side or definition, such as a wrong sign before
    a side. ``FAULTS_OF_WHOLE_SIDES`` has the codes of these faults. The second change undoes any other fault; both may
    change the same side.
    """
    for first in islice((change for change in changes if change.edit.code in FAULTS_OF_WHOLE_SIDES), MOST_WHOLE):
        claim = numeric.edited([first])
        try:
            _ = claim.equation
        except InputError:
            continue  # the shapes of its matrices do not fit
        edited = NumericFilter(claim, MOST_PIECES_AFTER)
        if len(edited.points) < 2 or edited.left.kind == edited.right.kind == "neg":
            continue
        second = [*_single(edited), *solutions(edited), *missing_terms(edited)]
        for candidate in sorted(second, key=lambda candidate: candidate.cost):
            both = {first.place: first} | {change.place: change for change in candidate.changes}
            yield Candidate(first.cost + candidate.cost, "two_faults", tuple(both.values()))


def _single(numeric: NumericFilter) -> Iterator[Candidate]:
    """Yield the single edits that make a claim true at the test points."""
    for place in numeric.places:
        tree = numeric.tree_at(place)
        is_tried = numeric.tried_paths(place, tree)
        edits = single_edits(tree, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving, is_tried)
        for edit in islice(edits, MOST_EDITS):
            change = Change(place, edit)
            if numeric.sensible(place, edit.tree) and numeric.holds([change]):
                yield Candidate(change.cost, edit.code, (change,))
