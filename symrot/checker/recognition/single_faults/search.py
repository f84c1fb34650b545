"""Known formulas that differ from a claim by one fault: a numeric search, whose results are not yet proven.

For each formula that symrot derives for the claim's quantity, the search computes the values that the claim's formula
should have. It then looks for a single part whose change gives these values.
"""

from collections.abc import Callable, Iterator
from itertools import chain, islice
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node, walk
from symrot.checker.recognition.known_formulas import Known
from symrot.checker.recognition.renaming import is_consistent
from symrot.checker.recognition.single_faults.comparison import Near, Search, compare, search_of
from symrot.checker.recognition.single_faults.known_values import (
    formulas_of_quantities,
    has_angles,
    is_column,
    names_of,
    quantity_node,
)
from symrot.checker.recognition.single_faults.letters import letters_of_formula, nodes_of, text_of
from symrot.checker.recognition.single_faults.parts import values_of
from symrot.checker.recognition.single_faults.renamings import is_fitting, renaming_of_product, renamings, strangeness
from symrot.checker.recognition.single_faults.solved_relations import solved_relations
from symrot.checker.repair.rows import is_matrix
from symrot.exact.limits.operations import operations_left, spend

__all__ = ["near_formulas"]

MOST_PAIRS = 1500
"""The largest number of pairs (known formula, renaming) that are compared."""
MOST_SEARCHES = 4
"""The number of latest results of `_search` that are stored."""
MOST_NODES = 500
"""The largest number of symbols and operations in a formula that is searched for faults."""
FEW = 3
"""A known formula that has angles and more symbols than this is not compared with a claim without angles.

Nor is a known formula without angles and with more symbols than this compared with a claim that has angles. There are
two exceptions: the context states the body that the known formula is for, or the claim has just one angle and one
symbol more than the known formula.
"""


Renaming = dict[str, str | None]
"""Symbol of a known formula -> the claim's name for it, or None if the claim lacks the symbol."""


def near_formulas(claim: Claim, named: NamedFormula, fits: Callable[[Known], bool]) -> list[Near]:
    """Return changes of a claim's formula that may each turn it into a known formula, the cheapest first.

    ``fits(known)`` decides which known formulas are compared. After each change, the claim's formula has the values of
    a known one at random points.

    A formula with the square root of a sum, such as a*sqrt(1 - x/a^2), may equal a known formula although the look-up
    of known formulas, by a hash, does not find it. If such a formula has the values of a known one without a change,
    the list has one entry: the unchanged formula with the code "none".

    The list is empty in three cases: no change is found; the claim's formula is longer than MOST_NODES or cannot be
    evaluated at enough random points; the claim has hypotheses and its formula has the values of a known one already.
    """
    search = _search(claim, named)
    if search is None:
        return []
    nearest: dict[tuple[Node, str], Near] = {}
    for known, renaming in islice(_pairs(claim, named, search, fits), MOST_PAIRS):
        near_ones = compare(search, known, renaming)
        if near_ones is None and claim.hypotheses:
            return []
        if near_ones is None and has_root_of_sum(named.formula):
            texts = tuple((old, new) for old, new in renaming.items() if new is not None)
            return [Near(0.0, "none", named.formula, known, strangeness(renaming), False, False, False, "", 0, texts)]
        for candidate in near_ones or ():
            key = (candidate.tree, known.name)
            if key not in nearest or candidate.cost < nearest[key].cost:
                nearest[key] = candidate
    return sorted(nearest.values(), key=lambda candidate: candidate.cost)


def _pairs(
    claim: Claim, named: NamedFormula, search: Search, fits: Callable[[Known], bool]
) -> Iterator[tuple[Known, Renaming]]:
    """Yield the pairs (known formula, renaming of its symbols to the claim's letters) to be compared with a claim.

    The formulas are those for which ``fits`` is true, and relations solved for the claim's quantity. Some known
    formulas are skipped: scalars if the claim's formula is a matrix, matrices if it is a scalar, and formulas with at
    least two symbols more or fewer than the claim's. Also skipped are most formulas with angles if the claim has none,
    and most formulas without angles if the claim has some.
    """
    letters = search.letters
    names, quantity = [text_of(atom) for atom in letters.atoms], text_of(quantity_node(named))
    inside = {node for angle in letters.angles for node in nodes_of(angle)}
    angles = {text_of(atom) for atom in letters.atoms if atom in inside}
    renamings_of: dict[tuple[str, ...], list[Renaming]] = {}  # names of a known formula -> their renamings
    for mine, known in chain((("", known) for known in formulas_of_quantities() if fits(known)), _relations(quantity)):
        own = names_of(known)
        is_wrong_kind = is_column(known) != is_matrix(search.values[0])
        has_one_angle = len(letters.angles) == 1 and len(own) == len(names) - 1  # in a factor too many
        is_other = has_angles(known) != bool(letters.angles) and len(own) > FEW and not has_one_angle
        is_of_body = claim.context.body is not None and claim.context.body.kind.title in known.name
        if is_wrong_kind or (is_other and not is_of_body) or abs(len(own) - len(names)) > 1:
            continue
        if own not in renamings_of:
            renamings_of[own] = renamings(own, names, angles)
        of_product = renaming_of_product(names) if "quaternion product" in known.name else None
        for renaming in [of_product] if of_product else renamings_of[own]:
            pairs = [(old, new) for old, new in renaming.items() if new is not None]
            if not mine or is_consistent([*pairs, (mine, quantity)]):
                yield known, renaming


def _search(claim: Claim, named: NamedFormula) -> Search | None:
    """Return the search for faults of a claim's formula; None for a formula without values, or one that is too long.

    The latest searches are stored, since one claim may be compared several times, for instance in other contexts.
    """
    equations = claim.define, claim.hypotheses, claim.relation
    key = equations, claim.symbols, claim.functions, claim.implied, named[:4], named.solve is None
    if key in _latest:
        search, operations = _latest[key]
        spend(operations)  # as at the first time: the budget of a claim does not depend on those before it
        return search
    before = operations_left() or 0
    is_short = sum(1 for _ in walk(named.formula)) <= MOST_NODES
    letters = letters_of_formula(claim, named) if is_short else None
    values = None if letters is None else values_of(named.formula, letters.points)
    search = search_of(claim, named, letters, values) if letters is not None and values is not None else None
    if len(_latest) == MOST_SEARCHES:
        del _latest[next(iter(_latest))]
    _latest[key] = search, before - (operations_left() or 0)
    return search


_latest: dict[Any, tuple[Search | None, int]] = {}
"""The parts of a claim that its search depends on -> (result of `_search`, number of operations that it took)."""


def has_root_of_sum(formula: Node) -> bool:
    """Return whether a formula contains a sum under a square root."""
    # fingerprints (hashes of values) of equal formulas with such roots may differ by a sign
    roots = (node.args[0] for _, node in walk(formula) if node.kind == "call" and node.value == "sqrt")
    return any(node.kind == "sum" for root in roots for _, node in walk(root))


def _relations(quantity: str) -> Iterator[tuple[str, Known]]:
    """Yield (symbol, formula for it) from the known equations, for symbols that may mean the claim's ``quantity``.

    For the quantity T, the equation ``M = I*alpha`` gives ("M", I*alpha) if a claim may write T for M.
    """
    for name, known in solved_relations():
        if is_fitting(name, quantity, is_angle=False):
            yield name, known
