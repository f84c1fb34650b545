"""Claims that are right after two letters are exchanged, where the context of the claim says what both letters mean."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations, islice

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import names_in, text, with_names
from symrot.checker.repair.edits.faults import COST
from symrot.checker.verdict import Diagnosis, Repair, Verdict

__all__ = ["by_exchanged_letters"]

MOST_PAIRS = 10
"""The largest number of pairs of letters for which an exchange is tried."""


def by_exchanged_letters(
    claim: Claim, named: NamedFormula, verdict: Verdict, judge: Callable[[Claim, NamedFormula], Verdict]
) -> Verdict:
    """Return the verdict "doubtful" if a claim's formula is right with two letters exchanged; otherwise ``verdict``.

    ``judge`` returns the verdict on a claim.
    """
    if verdict.verdict != "definition" or not claim.context.meanings or claim.relation is None:
        return verdict
    # only letters with a meaning in the context and the same unit: others may mean anything
    units = {name: unit for name in names_in(named.formula) if (unit := _unit(claim, name))}
    pairs = (pair for pair in combinations(sorted(units), 2) if units[pair[0]] == units[pair[1]])
    for first, second in islice(pairs, MOST_PAIRS):
        tree = with_names(named.formula, {first: second, second: first})
        if tree == named.formula:
            continue
        _, left, _ = claim.relation
        sides = (named.side, tree) if left == named.side else (tree, named.side)
        other = judge(claim.with_relation(("==", *sides), alternatives=()), named._replace(formula=tree))
        if other.verdict in ("true", "recognised"):
            code = "wrong_symbol"
            repair = Repair(f"{text(named.side)} == {text(tree)}", code, COST[code] + COST["names_exchanged"])
            return replace(
                verdict, verdict="doubtful", reason="", repairs=(repair,), recognised_as=other.recognised_as,
                diagnosis=Diagnosis(code, f"the letters {first} and {second} are exchanged"),
            )  # fmt: skip
    return verdict


def _unit(claim: Claim, name: str) -> str:
    """Return the unit of the quantity that the context assigns to ``name``: "N m" for "M = torque"; "" if none."""
    meaning = claim.context.meaning_of(name)
    return meaning.quantity.unit if meaning is not None else ""
