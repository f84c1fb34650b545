"""Repairs of claims about complex numbers: edits of the claim as typed, before its split into real and imaginary
parts.
"""

from collections.abc import Iterator
from itertools import islice

from symrot.checker.arrays.complex_parts import with_parts
from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.tree import Node, negated, product, walk
from symrot.checker.decide.decision import decide_equation
from symrot.checker.repair.edits.faults import COST, FAULT_DESCRIPTIONS
from symrot.checker.repair.edits.single import Edit, single_edits
from symrot.checker.repair.edits.trees import put
from symrot.checker.repair.filter import Change, NumericFilter, is_nontrivial
from symrot.checker.verdict import Diagnosis, Repair
from symrot.errors import InputError
from symrot.exact.ring.ratio import TooLarge

__all__ = ["complex_repairs"]

MOST_EDITS, MOST_REPAIRS = 300, 3
"""The largest number of edits of each side that are tried, and of repairs that are returned."""


def complex_repairs(claim: Claim) -> tuple[Diagnosis, tuple[Repair, ...]]:
    """Return the probable fault of a false claim about complex numbers, and proven repairs, the nearest first.

    The code of the fault is "none" if there is no repair.
    """
    repairs = tuple({repair.text: repair for repair in islice(_proven(claim), MOST_REPAIRS)}.values())
    code = repairs[0].code if repairs else "none"
    return Diagnosis(code, FAULT_DESCRIPTIONS[code]), repairs


def _proven(claim: Claim) -> Iterator[Repair]:
    if claim.unsplit is None or claim.relation is None:
        return
    letter, (sign, *sides) = claim.unsplit
    numeric = NumericFilter(claim)
    names = {str(node.value) for side in sides for _, node in walk(side) if node.kind == "name"} - {letter, "pi", "e"}
    candidates = [
        (edit.cost, place, edit)
        for place in (1, 0)
        for edit in _edits(sides[place], letter, sorted(names), numeric)
        if is_nontrivial(sides[place]) or edit.code == "overall_sign"  # a number has another sign at most
    ]
    for cost, place, edit in sorted(candidates, key=lambda candidate: candidate[0]):
        edited = (edit.tree, sides[1]) if place == 0 else (sides[0], edit.tree)
        try:
            relation = with_parts((sign, *edited), letter, claim.text)
            changes = [
                Change(side, Edit(edit.code, cost, (), tree))
                for side, tree in zip(("left", "right"), relation[1:], strict=True)
            ]
            is_proven = (
                edited[0] != edited[1]
                and numeric.holds(changes)
                and decide_equation(claim.with_relation(relation, alternatives=()).equation).verdict == "true"
            )
        except (InputError, TooLarge):
            continue
        if is_proven:
            yield Repair(relation_text((sign, *edited)), edit.code, cost)


def _edits(side: Node, letter: str, names: list[str], numeric: NumericFilter) -> Iterator[Edit]:
    """Yield edits of one side, also those that put the imaginary unit ``letter`` before a term or leave it out."""
    edits = list(single_edits(side, names, numeric.functions, lambda node: False, moving=False))
    unit = Node("name", letter)
    edits.append(Edit("overall_sign", COST["overall_sign"], (), negated(side)))
    for path, node in walk(side):
        if node.kind == "inv":
            below = Node("inv", None, (product([*_factors(node.args[0]), unit]),))
            edits.append(Edit("factor", COST["factor"], path, put(side, path, below)))
        for place, term in enumerate(node.args if node.kind == "sum" else ()):
            bare = term.args[0] if term.kind == "neg" else term
            own = (*path, place, *((0,) if term.kind == "neg" else ()))
            factors = _factors(bare)
            made = [factor for factor in factors if factor != unit] if unit in factors else [unit, *factors]
            if made:
                edits.append(Edit("factor", COST["factor"], own, put(side, own, product(made))))
    yield from sorted(edits, key=lambda edit: edit.cost)[:MOST_EDITS]


def _factors(node: Node) -> list[Node]:
    return list(node.args) if node.kind == "product" else [node]
