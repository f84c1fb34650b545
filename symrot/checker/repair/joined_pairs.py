"""Pairs of edits that make a claim true together, found by their numeric effects instead of trying all pairs.

If left - right is 5 at a test point, and one edit of a term reduces it by 2, an edit that reduces it by 3 completes the
pair. Edits of factors likewise change left/right by factors.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice

from symrot.checker.repair.edits.single import Edit
from symrot.checker.repair.entries import merged
from symrot.checker.repair.filter import SIDES, Candidate, Change, NumericFilter
from symrot.checker.repair.points import UndefinedValue, entries_of

__all__ = ["joined_pairs", "pair_of"]

MOST_JOINED = 400
"""The largest number of pairs of edits that are tried, the cheapest first."""

DIGITS = 8
"""Number of decimals to which the effects of edits (changes of left - right, or of left/right) are compared.

Before the comparison, each effect is divided by the largest entry of the effect that a pair of edits must have.
"""

Values = tuple[float, ...]


def joined_pairs(numeric: NumericFilter, changes: Sequence[Change]) -> Iterator[Candidate]:
    """Yield pairs of the edits ``changes`` that make a claim true at the test points, the cheapest first."""
    try:
        sums, products = _differences(numeric, changes), _quotients(numeric, changes)
    except UndefinedValue:  # the claim itself has no value at the point
        return
    pairs = chain(
        _completing(sums, lambda value, own: value - own), _completing(products, lambda value, own: value / own)
    )
    costs = {pair: changes[pair[0]].cost + changes[pair[1]].cost for pair in pairs}
    for first, second in islice(sorted(costs, key=lambda pair: (costs[pair], pair)), MOST_JOINED):
        both = pair_of(numeric, changes[first], changes[second])
        if both is not None and numeric.holds(both):
            yield Candidate(costs[first, second], "two_faults", both)


def pair_of(numeric: NumericFilter, first: Change, second: Change) -> tuple[Change, ...] | None:
    """Return two edits of a claim as changes to apply together, or None if the parts that they change overlap."""
    if first.place != second.place:
        return first, second
    # edits of one tree become one change
    tree = merged(numeric.tree_at(first.place), first.edit, second.edit)
    if tree is None:
        return None
    return (Change(first.place, Edit("two_faults", first.edit.cost + second.edit.cost, (), tree)),)


Effects = tuple[Values, dict[int, Values]]
"""A pair (effect that two edits must have together to make the sides equal, {index of an edit: its effect alone}).

The effect of an edit is the amount by which it reduces left - right, one number for each matrix entry; or it is the
factor by which the edit divides left/right.
"""


def _differences(numeric: NumericFilter, changes: Sequence[Change]) -> Effects:
    """Return left - right of the claim at the first test point, and {index in ``changes``: effect of the edit}.

    The effect is how much the edit reduces left - right, for each matrix entry. Edits that leave a side without a value
    or change its number of entries are left out, and all further ones when the budget of evaluations is spent.
    """
    point = numeric.points[0]
    whole = tuple(numeric.differences(point, ()))
    effects: dict[int, Values] = {}
    for number, change in enumerate(changes):
        if not numeric.affordable():
            break
        try:
            values = numeric.differences(point, (change,))
        except UndefinedValue:
            continue
        if len(values) == len(whole):
            effects[number] = tuple(before - after for before, after in zip(whole, values, strict=True))
    return whole, effects


def _quotients(numeric: NumericFilter, changes: Sequence[Change]) -> Effects:
    """Return left/right of the claim at the first test point, and {index in ``changes``: factor of the edit}.

    The edit divides left/right by this factor. Both results are empty for matrices, and if a side of the claim is zero.
    Edits of a definition that the claim uses are left out, and edits after which a side is zero or has no value.
    """
    point = numeric.points[0]
    left, right = (entries_of(side) for side in numeric.sides(point, ()))
    if len(left) != 1 or len(right) != 1 or not left[0] or not right[0]:
        return (), {}  # a matrix, or zero
    whole = left[0] / right[0]
    effects: dict[int, Values] = {}
    for number, change in enumerate(changes):
        if change.place not in SIDES or not numeric.affordable():
            continue
        try:
            (above,), (below,) = (entries_of(side) for side in numeric.sides(point, (change,)))
        except (UndefinedValue, ValueError):
            continue
        if above and below:
            effects[number] = (whole * below / above,)
    return (whole,), effects


def _completing(effects: Effects, rest: Callable[[float, float], float]) -> Iterator[tuple[int, int]]:
    """Yield pairs of indices of two edits that together make both sides equal at the first test point.

    ``effects`` is the result of `_differences` or `_quotients`. It has the effect w that two edits must have together,
    and the effect e of each edit alone: the amount by which the edit reduces left - right, or the factor by which it
    divides left/right. If one edit of a pair has the effect e, the other one must have the effect ``rest(w, e)``: w - e
    for differences, w/e for quotients.
    """
    whole, single = effects
    scale = max(map(abs, whole), default=0.0)
    if not scale:
        return
    table: dict[Values, list[int]] = {}
    for number, own in single.items():
        table.setdefault(_key(own, scale), []).append(number)
    for number, own in single.items():
        missing = tuple(rest(value, part) for value, part in zip(whole, own, strict=True))
        for other in table.get(_key(missing, scale), ()):
            if other > number:
                yield number, other


def _key(values: Values, scale: float) -> Values:
    return tuple(round(value / scale, DIGITS) + 0.0 for value in values)
