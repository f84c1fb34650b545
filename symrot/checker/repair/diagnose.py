"""What is wrong with a claim that is not true, and the nearest formulas that are: search, sieve, proof.

Edits of the text, and what pieces would have to be, are sieved by values at two points in double precision; what passes
is decided by the exact engine, and only what it proves is offered. The work is bounded by counts, so all runs find the
same.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import combinations, islice

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import Node
from symrot.checker.decide.decision import decide_equation
from symrot.checker.repair.canonical_form import settled
from symrot.checker.repair.edits import TEXTS, Edit, neat, single_edits
from symrot.checker.repair.entries import by_entries, merged
from symrot.checker.repair.filter import Change, Found, NumericFilter
from symrot.checker.repair.insertions import lacking_matrix, lacking_term, renamed
from symrot.checker.repair.points import UndefinedValue
from symrot.checker.repair.solve_for_piece import solved
from symrot.checker.verdict import Diagnosis, Repair
from symrot.errors import InputError
from symrot.exact.decision import Decision

__all__ = ["diagnose"]

MOST_EDITS = 40_000
"""Edits of one tree."""

MOST_PAIRS_OF = 90
MOST_PROOFS = 10
MOST_REPAIRS = 3

MOST_EXPANDED = 1_000_000
"""Products of terms in the expansions of the claim and of all repairs that are tried; at a fourth, none is tried."""

AS_NEAR = 0.35
"""Cost by which another way of writing may exceed the nearest repair."""


def diagnose(claim: Claim, decision: Decision) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return what is probably wrong, and at most three proven repairs, the nearest first.

    Parameters
    ----------
    claim : Claim
        With a relation.
    decision : Decision
        Its outcome, ``"false"`` or ``"conditional"``.
    """
    if 4 * decision.products > MOST_EXPANDED:
        text = f"the formula is too large to look for repairs: it took {decision.products} products of terms to expand"
        return Diagnosis("none", text), ()
    repairs = _Search(claim, decision).repairs()
    if decision.requires:
        needed = decision.requires[0]
        return Diagnosis(needed.code, f"{TEXTS[needed.code]}: {needed.text}"), repairs
    if not repairs:
        return Diagnosis("none", ""), ()
    return Diagnosis(repairs[0].code, TEXTS[repairs[0].code]), repairs


class _Search:
    def __init__(self, claim: Claim, decision: Decision) -> None:
        self.sieve = NumericFilter(claim)
        self.conditional = bool(decision.requires)  # what it lacks is the condition, then, not a term
        self.products = decision.products
        self.seen: set[tuple[float, ...]] = set()
        self.alike: list[Found] = []  # what has the values of something that was tried before
        self.offered: list[Found] = []

    def repairs(self) -> tuple[Repair, ...]:
        """Return the proven repairs."""
        sieve = self.sieve
        if len(sieve.points) < 2:
            return ()
        changes = sorted(self.changes(), key=lambda change: (change.cost, change.place))
        passed: list[Found] = [(c.cost, c.edit.code, (c,)) for c in changes if sieve.holds([c])]
        stages: Sequence[Callable[[], Iterable[Found]]] = (
            lambda: sorted([*passed, *by_entries(sieve), *renamed(sieve), *solved(sieve)], key=lambda found: found[0]),
            lambda: lacking_term(sieve),
            lambda: lacking_matrix(sieve),
        )
        repairs: list[Repair] = []
        for stage in stages:
            if len(repairs) < MOST_REPAIRS:
                repairs += self.proven(stage(), MOST_REPAIRS - len(repairs))
        if not repairs:
            repairs = self.proven(self.pairs(changes), MOST_REPAIRS)
        repairs.sort(key=lambda repair: repair.cost)
        if 0 < len(repairs) < MOST_REPAIRS:
            repairs += self.others(repairs)
        return tuple(sorted(repairs, key=lambda repair: repair.cost))

    def others(self, repairs: Sequence[Repair]) -> list[Repair]:
        """Return other ways of writing what is offered, as near as the others are; room is left for them."""
        written = {self.written(changes) for _, _, changes in self.offered}
        found: list[Repair] = []
        for cost, code, changes in self.alike:
            now = self.written(changes)
            if now in written or cost > repairs[0].cost + AS_NEAR:
                continue
            written.add(now)
            self.seen.discard(self.sieve.fingerprint(changes))
            found += self.proven([(cost, code, changes)], 1)
            if len(repairs) + len(found) == MOST_REPAIRS:
                break
        return found

    def written(self, changes: Sequence[Change]) -> tuple[Node, ...]:
        """Return the trees of a repair, up to the order of terms and of scalar factors."""
        claim = self.sieve.edited(changes)
        assert claim.relation is not None
        trees = (*claim.relation[1:], *(tree for _, tree in claim.define))
        return tuple(settled(tree, self.sieve.is_matrix) for tree in trees)

    def changes(self) -> Iterator[Change]:
        sieve = self.sieve
        for place in sieve.places:
            tree = sieve.tree_at(place)
            edits = single_edits(
                tree, sieve.names, sieve.functions, sieve.is_matrix, sieve.moving, sieve.open_paths(place, tree)
            )
            for edit in islice(edits, MOST_EDITS):
                if sieve.sensible(place, edit.tree):
                    yield Change(place, edit)

    def pairs(self, changes: Sequence[Change]) -> Iterator[Found]:
        """Yield pairs of edits in different places that make the claim hold, by the budget."""
        cheap = list(changes)[:MOST_PAIRS_OF]
        ordered = sorted(combinations(cheap, 2), key=lambda pair: pair[0].cost + pair[1].cost)
        for first, second in ordered:
            if first.place == second.place:
                tree = merged(self.sieve.tree_at(first.place), first.edit, second.edit)
                if tree is None:
                    continue
                edit = Edit("two_faults", first.edit.cost + second.edit.cost, (), tree)
                both: tuple[Change, ...] = (Change(first.place, edit),)
            else:
                both = (first, second)
            if self.sieve.holds(both):
                yield first.cost + second.cost, "two_faults", both
            if not self.sieve.affordable():
                return

    def idle(self, code: str, changes: Sequence[Change]) -> bool:
        """Return whether an edit made the sides the same text by taking away what was said."""
        relation = self.sieve.edited(changes).relation
        assert relation is not None
        bare = {"name", "number"} & {self.sieve.left.kind, self.sieve.right.kind}
        return relation[1] == relation[2] and (bool(bare) or code in ("two_faults", "extra_term", "wrong_symbol"))

    def proven(self, passed: Iterable[Found], most: int) -> list[Repair]:
        """Return the first repairs that the exact engine proves, none that was offered before."""
        repairs: list[Repair] = []
        attempts = 0
        for cost, code, changes in passed:
            if attempts >= MOST_PROOFS or len(repairs) == most or self.products > MOST_EXPANDED:
                break
            if self.conditional and code == "missing_term":
                continue
            try:
                values = self.sieve.fingerprint(changes)
            except UndefinedValue:
                continue
            shown = tuple(_neat(change) if code == "factor" else change for change in changes)
            if self.idle(code, shown):
                continue
            if values in self.seen:
                self.alike.append((cost, code, shown))
                continue
            self.seen.add(values)
            attempts += 1
            offered = self.sieve.text(shown)
            try:
                read_relation(offered.partition(" with ")[0])  # it may have outgrown the reader
                decision = decide_equation(self.sieve.edited(shown).equation)
            except InputError:
                continue
            self.products += decision.products
            if decision.verdict == "true":
                repairs.append(Repair(offered, code, round(cost, 3)))
                self.offered.append((cost, code, shown))
        return repairs


def _neat(change: Change) -> Change:
    return Change(change.place, Edit(change.edit.code, change.edit.cost, change.edit.path, neat(change.edit.tree)))
