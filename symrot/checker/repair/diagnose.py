"""The diagnosis of a claim that is not true: a search for true formulas near it, by a numeric test and a proof.

A candidate with one or two edits must be true at two points in double precision; then the exact engine decides it. The
work is bounded by counts, not by time: every run gives the same repairs.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import combinations, islice
from typing import Any

from symrot.checker.arrays.as_written import inverse_of
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import Node
from symrot.checker.claim.tree import text as written
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.repair.canonical_form import canonical, terms_of_equation, with_ordered_products
from symrot.checker.repair.edits.faults import FAULT_DESCRIPTIONS
from symrot.checker.repair.edits.single import Edit, single_edits
from symrot.checker.repair.edits.trees import normalise_factors
from symrot.checker.repair.entries import by_entries
from symrot.checker.repair.filter import SIDES, Candidate, Change, NumericFilter
from symrot.checker.repair.insertions import exchanged_definitions, missing_matrices, missing_terms
from symrot.checker.repair.joined_pairs import joined_pairs, pair_of
from symrot.checker.repair.points import UndefinedValue
from symrot.checker.repair.solve_for_piece import solutions
from symrot.checker.repair.vector_edits import vector_edits
from symrot.checker.repair.whole_edits import after_whole_edits
from symrot.checker.verdict import Diagnosis, Repair
from symrot.errors import InputError
from symrot.exact.decision import Decision, flatten

__all__ = ["MOST_REPAIRS", "diagnose"]

MOST_EDITS = 40_000
"""The largest number of edits of one side or definition that are tried."""

MOST_PAIRS_OF = 90
"""Number of the cheapest edits of a claim that are tried in pairs."""

MOST_PROOFS = 10
"""The largest number of edited claims that one stage of the search for repairs tries to prove exactly."""

MOST_REPAIRS = 3

MOST_EXPANDED = 1_000_000
"""When the exact proofs for a claim and its possible repairs have multiplied more pairs of terms than this, no further
proof is tried.

A claim whose own proof takes more than a quarter of this number gets no repairs.
"""

TELLING = frozenset(FAULT_DESCRIPTIONS) - {"two_faults", "extra_term", "wrong_symbol", "missing_term"}
"""Codes of faults that are reported as a claim's probable fault if their correction makes both sides the same formula.

The corrected claim, such as ``a == a``, says nothing, and so is not offered as a repair.
"""

AS_NEAR = 0.35
"""Largest difference in cost between two edits of a claim that count as about equally probable.

An edit that turns the claim into ``a == a`` may undo the author's fault, but is not offered as a repair, since the
result says nothing. A repair that costs over AS_NEAR more than the cheapest edit of this kind is not offered either,
since the fault that this edit undoes is more probable. A formula that equals a repair but is written in another way is
offered too, if it costs at most AS_NEAR more than the cheapest repair.
"""

MOST_COSTLY = 9.0
"""A number above the cost of every repair."""


def diagnose(claim: Claim, decision: Decision) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return the probable fault of a claim, and at most three proven repairs, the nearest first.

    The code of the fault is "none" if none is found.

    Parameters
    ----------
    claim : Claim
        An equation.
    decision : Decision
        The decision on the claim, ``"false"`` or ``"conditional"``.
    """
    if 4 * decision.products > MOST_EXPANDED:
        text = f"the formula is too large to look for repairs: it took {decision.products} products of terms to expand"
        return Diagnosis("none", text), ()
    search = _Search(claim, decision)
    repairs = search.repairs()
    if decision.requires:
        needed = decision.requires[0]
        return Diagnosis(needed.code, f"{FAULT_DESCRIPTIONS[needed.code]}: {needed.text}"), repairs
    faults = sorted([*search.tautologies, *((repair.cost, repair.code) for repair in repairs)])
    code = faults[0][1] if faults else "none"
    return Diagnosis(code, FAULT_DESCRIPTIONS[code]), repairs


class _Search:
    """The search for repairs of one claim: its candidates, the proven ones among them, and what was tried before."""

    def __init__(self, claim: Claim, decision: Decision) -> None:
        self.numeric = NumericFilter(claim)
        self.conditional = bool(decision.requires)  # then the claim lacks its condition, not a term
        self.products = decision.products
        self.seen: set[tuple[float, ...]] = set()  # values of the candidates that were decided
        self.forms: set[Any] = set()  # equations of the candidates that were decided, with their terms collected
        self.alike: list[Candidate] = []  # candidates with the values of an earlier one
        self.accepted: list[Candidate] = []  # proven candidates
        self.tautologies: list[tuple[float, str]] = []  # cost and code of edits that make both sides the same formula

    def repairs(self) -> tuple[Repair, ...]:
        """Return at most three proven repairs of the claim, the nearest first."""
        numeric = self.numeric
        if len(numeric.points) < 2:
            return ()
        self.forms.add(self.equation_form(()))
        order = sorted(numeric.places, key=lambda place: (*(place != side for side in SIDES), place))
        changes = sorted(self.changes(), key=lambda change: (change.cost, order.index(change.place)))
        edited = [Candidate(c.cost, c.edit.code, (c,)) for c in changes if numeric.holds([c])]
        stages: Sequence[Callable[[], Iterable[Candidate]]] = (
            lambda: sorted(
                [*edited, *by_entries(numeric), *exchanged_definitions(numeric), *solutions(numeric)],
                key=lambda candidate: candidate.cost,
            ),
            lambda: () if self.conditional else missing_terms(numeric),
            lambda: missing_matrices(numeric),
            lambda: () if self.conditional else vector_edits(numeric),
        )
        repairs: list[Repair] = []
        for stage in stages:
            if len(repairs) < MOST_REPAIRS:
                repairs += self.proven(stage(), MOST_REPAIRS - len(repairs))
        if not repairs and not self.conditional:
            repairs = self.proven(joined_pairs(numeric, changes), MOST_REPAIRS)
        if not repairs and not self.conditional:
            repairs = self.proven(self.pairs(changes), MOST_REPAIRS)
        if not repairs and not self.conditional:
            repairs = self.proven(after_whole_edits(numeric, changes), MOST_REPAIRS)
        nearest = min((cost for cost, _ in self.tautologies), default=MOST_COSTLY)
        repairs = sorted((r for r in repairs if r.cost <= nearest + AS_NEAR), key=lambda repair: repair.cost)
        if 0 < len(repairs) < MOST_REPAIRS:
            repairs += self.others(repairs)
        return tuple(sorted(repairs, key=lambda repair: repair.cost))

    def others(self, repairs: Sequence[Repair]) -> list[Repair]:
        """Return further proven repairs: formulas equal to one in ``repairs``, but written in another way."""
        forms = {self.canonical_form(candidate.changes) for candidate in self.accepted}
        others: list[Repair] = []
        for candidate in self.alike:
            form = self.canonical_form(candidate.changes)
            # a repair that costs much more than the first corrects an unlikely fault
            if form in forms or candidate.cost > repairs[0].cost + AS_NEAR:
                continue
            forms.add(form)
            self.seen.discard(self.numeric.fingerprint(candidate.changes))
            others += self.proven([candidate], 1)
            if len(repairs) + len(others) == MOST_REPAIRS:
                break
        return others

    def canonical_form(self, changes: Sequence[Change]) -> tuple[Node, ...]:
        """Return the sides and definitions of the claim after ``changes``, with sorted terms and factors."""
        return tuple(canonical(tree, self.numeric.is_matrix) for tree in self.trees(changes))

    def equation_form(self, changes: Sequence[Change]) -> Any:
        """Return a key of the claim after ``changes``, equal for ``a == b`` and ``a - b == 0``."""
        left, right, *definitions = self.trees(changes)
        canonical_definitions = tuple(canonical(tree, self.numeric.is_matrix) for tree in definitions)
        left, right = (with_ordered_products(side, self.numeric.is_matrix) for side in (left, right))
        # repairs whose key has occurred before are left out
        return terms_of_equation(left, right, self.numeric.is_matrix), canonical_definitions

    def trees(self, changes: Sequence[Change]) -> tuple[Node, ...]:
        """Return the trees of the claim after ``changes``: the left side, the right side, then each definition."""
        claim = self.numeric.edited(changes)
        assert claim.relation is not None
        return (*claim.relation[1:], *(tree for _, tree in claim.define))

    def changes(self) -> Iterator[Change]:
        """Yield the single edits of the sides and definitions of the claim."""
        numeric = self.numeric
        for place in numeric.places:
            tree = numeric.tree_at(place)
            is_tried = numeric.tried_paths(place, tree)
            edits = single_edits(tree, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving, is_tried)
            for edit in islice(edits, MOST_EDITS):
                if numeric.sensible(place, edit.tree):
                    yield Change(place, edit)

    def pairs(self, changes: Sequence[Change]) -> Iterator[Candidate]:
        """Yield pairs of the edits ``changes`` that make the claim true at the test points, the cheapest first."""
        cheap = list(changes)[:MOST_PAIRS_OF]
        ordered = sorted(combinations(cheap, 2), key=lambda pair: pair[0].cost + pair[1].cost)
        for first, second in ordered:
            both = pair_of(self.numeric, first, second)
            if both is not None and self.numeric.holds(both):
                yield Candidate(first.cost + second.cost, "two_faults", both)
            if not self.numeric.affordable():
                return

    def is_tautology(self, changes: Sequence[Change]) -> bool:
        """Return whether ``changes`` make both sides the same formula, so that the edited claim says nothing."""
        # if only one side may be edited, the other one is the author's aim, and an equal formula a proper repair
        if len(self.numeric.sides_to_edit) < len(SIDES) or self.leaves_inverse(changes):
            return False
        left, right, *_ = self.trees(changes)
        return not terms_of_equation(left, right, self.numeric.is_matrix)

    def leaves_inverse(self, changes: Sequence[Change]) -> bool:
        """Return whether ``changes`` leave exactly one side unchanged, and it is an inverse such as ``q^(-1)``."""
        # the other side then is a formula for the inverse, which is no tautology
        unchanged = {*SIDES} - {change.place for change in changes}
        sides = [self.numeric.tree_at(place) for place in unchanged]
        return len(sides) == 1 and inverse_of(sides[0], self.numeric.claim.text) is not None

    def cancels(self, equation: Equation) -> bool:
        """Return whether the repaired claim ``equation`` says nothing because letters cancel, as in ``x/x == 1``."""
        claimed = self.numeric.claim.equation
        sides = ((claimed.left, equation.left), (claimed.right, equation.right))
        bare = [(before, after) for before, after in sides if any(flatten(after)[0]) and not _symbols(after)]
        # a side with letters became a number, or both sides are numbers
        return any(map(_symbols, dict(bare))) or (len(bare) == len(sides) and bool(equation.divisors))

    def proven(self, candidates: Iterable[Candidate], most: int) -> list[Repair]:
        """Return at most ``most`` repairs: the first candidates that are proven to be true.

        A candidate that is true only in a range such as 0 <= x <= pi is also a repair, with this range as a condition.
        But if the verdict on the claim itself is "conditional", only candidates that are true without a condition are
        repairs. At most MOST_PROOFS proofs are tried.
        """
        repairs: list[Repair] = []
        attempts = 0
        bare = bool({"name", "number"} & {self.numeric.left.kind, self.numeric.right.kind})
        for cost, code, changes in candidates:
            if attempts >= MOST_PROOFS or len(repairs) == most or self.products > MOST_EXPANDED:
                break
            if self.conditional and code == "missing_term":
                continue
            try:
                values = self.numeric.fingerprint(changes)
            except UndefinedValue:
                continue
            candidate = Candidate(cost, code, tuple(map(_tidied, changes)) if code == "factor" else changes)
            if self.is_tautology(candidate.changes):
                if not bare and code in TELLING:
                    self.tautologies.append((cost, code))
                continue
            form = self.equation_form(candidate.changes)
            # of candidates with equal terms or equal values, only the first is tried
            if form in self.forms:
                continue
            if values in self.seen:
                self.alike.append(candidate)
                continue
            self.seen.add(values)
            self.forms.add(form)
            attempts += 1
            text = self.numeric.text(candidate.changes)
            try:
                read_relation(text.partition(" with ")[0])  # it may be too long for the reader
                equation = self.numeric.edited(candidate.changes).equation
                decision = decide_equation(equation)
            except InputError:
                continue
            self.products += decision.products
            ranges = "" if self.conditional else _ranges(decision)
            if (decision.verdict == "true" or ranges) and not self.cancels(equation):
                parts = {change.place: written(change.edit.tree) for change in candidate.changes}
                repairs.append(Repair(text, code, round(cost, 3), edited=parts, requires=ranges))
                self.accepted.append(candidate)
        return repairs


def _ranges(decision: Decision) -> str:
    """Return the signs or angles for which a formula holds, such as ``"0 <= x <= pi"``; "" for other conditions."""
    needed = decision.requires[:1]
    # a condition such as A == B, even beside a sign, is no range
    is_range = decision.verdict == "conditional" and all(need.signs and not need.zeros for need in needed)
    return needed[0].text if needed and is_range else ""


def _symbols(formula: Any) -> set[Any]:
    return set(getattr(formula, "free_symbols", ()))


def _tidied(change: Change) -> Change:
    edit = change.edit
    return Change(change.place, Edit(edit.code, edit.cost, edit.path, normalise_factors(edit.tree)))
