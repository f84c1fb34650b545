"""Edits of a claim's formula, such as another sign, that turn the formula into one that symrot knows."""

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import combinations, islice
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import Interpreter
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node, sum_of, text, walk
from symrot.checker.recognition.naming.evidence import LEAST_SYMBOLS_EDITED, is_of_body
from symrot.checker.recognition.naming.quantities import has_terms, names_in, quantities_in
from symrot.checker.recognition.naming.ranks import RARE, strangeness_of
from symrot.checker.recognition.naming.readings import LEAST_SYMBOLS, all_letters_stated, readings_of_claim
from symrot.checker.recognition.single_faults.letters import is_atom
from symrot.checker.repair.edits.faults import COST, FAULT_DESCRIPTIONS
from symrot.checker.repair.edits.single import Edit, single_edits
from symrot.checker.repair.edits.trees import with_other_products
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict

__all__ = ["doubtful", "readings_by_other_products", "recognised_edits", "verdict_by_edit"]

MOST_EDITS = 400
"""The largest number of edits of a formula that are looked up among the known formulas."""

MOST_NODES = 400
"""The largest number of symbols, numbers and operations in a formula that is edited."""

PLUS_PRODUCTS = "for products of inertia without the minus sign, I_xy = integral of x*y dm"


def readings_by_other_products(claim: Claim, named: NamedFormula, formula: Node) -> tuple[Identification, ...]:
    """Return the known formulas that equal ``formula`` if products of inertia are defined without the minus sign."""
    if claim.context.sign_of_products == "minus":
        return ()
    other = with_other_products(formula)
    readings = () if other is None else readings_of_claim(claim, named, other, LEAST_SYMBOLS_EDITED)
    return tuple(replace(known, how=PLUS_PRODUCTS) for known in readings)


def doubtful(repairs: tuple[Repair, ...], readings: tuple[Identification, ...], notes: tuple[str, ...] = ()) -> Verdict:
    """Return the verdict "doubtful" with repairs; ``readings`` are the known formulas that the first repair gives."""
    code = repairs[0].code
    diagnosis = Diagnosis(code, FAULT_DESCRIPTIONS[code])
    return Verdict("doubtful", diagnosis=diagnosis, repairs=repairs, recognised_as=readings, notes=notes)


def verdict_by_edit(claim: Claim, named: NamedFormula) -> Verdict | None:
    """Return the verdict "doubtful" if undoing a usual fault makes the formula a known one; otherwise None."""
    nearest: tuple[tuple[int, int, int], Verdict] | None = None
    if named.solve is None and named.formula.kind == "number" and named.formula.value:
        # a number alone on the right: the left side is edited
        exchanged = verdict_by_edit(claim, named._replace(side=named.formula, formula=named.side))
        if exchanged is None:
            return None
        repairs = tuple(replace(r, text=" == ".join(reversed(r.text.split(" == ")))) for r in exchanged.repairs)
        return replace(exchanged, repairs=repairs)
    letters = names_in(named.formula)
    is_of_trace = named.side.kind == "call" and named.side.value == "trace" and has_terms(named.formula)
    if len(quantities_in(named.formula)) < LEAST_SYMBOLS_EDITED + (not has_terms(named.formula)) and not is_of_trace:
        return None
    least = LEAST_SYMBOLS if named.solve is None and all_letters_stated(claim, named) else LEAST_SYMBOLS_EDITED
    own = claim.interpreter()
    interpreter = _Remembering(own.values, own.functions, own.implied)
    for edit in (*_edits(claim, named.formula), *_with_all_terms_added(named)):
        if names_in(edit.tree) < letters or edit.code == "extra_term":  # the formula may be a more general one
            continue
        if edit.code == "two_faults":
            continue  # two changes alone are no evidence of a fault
        all_readings = readings_of_claim(claim, named, edit.tree, least, interpreter)
        readings = tuple(known for known in all_readings if not any(body in known.name for body in RARE))
        is_growth = re.fullmatch("lambda|sigma|s", named.name) is not None
        is_open = edit.code in ("sign_of_term", "overall_sign") and (is_growth or not has_terms(named.formula))
        is_exchange = edit.code == "wrong_symbol" and names_in(edit.tree) == letters  # the letters mean something else
        if not readings or is_open or is_exchange or is_of_body(edit.code, readings[0].name):
            continue
        strangeness = strangeness_of(named, readings[0])
        if nearest is None or strangeness < nearest[0]:
            repair = Repair(f"{text(named.side)} == {text(edit.tree)}", edit.code, edit.cost)
            nearest = strangeness, doubtful((repair,), readings)
        if not any(strangeness):
            break
    return nearest and nearest[1]


@dataclass
class _Remembering(Interpreter):
    """An interpreter that stores the value of each tree node, since edits of a formula share most of its nodes."""

    known: dict[int, tuple[Node, Any]] = field(default_factory=dict)  # by id; the node is kept, so the id stays its own

    def evaluate(self, node: Node) -> Any:
        if id(node) not in self.known:
            self.known[id(node)] = node, super().evaluate(node)
        return self.known[id(node)][1]


def recognised_edits(
    claim: Claim, named: NamedFormula, letters: Collection[str], most: int
) -> Iterator[tuple[Repair, Verdict]]:
    """Yield (repair, verdict) for each single edit that makes a claim's formula a known one.

    ``letters`` are symbols that an edit may put in; the ``most`` cheapest edits are tried.
    """
    numeric = NumericFilter(claim)
    names = sorted({*numeric.names, *letters} - {*numeric.functions})
    edits = [*single_edits(named.formula, names, numeric.functions, numeric.is_matrix, numeric.moving)]
    # an exchange of two letters counts as one edit
    own = sorted(names_in(named.formula))
    for first, second in combinations(own, 2):
        exchanged = _exchanged(named.formula, {first: second, second: first})
        if exchanged != named.formula:
            edits.append(Edit("wrong_symbol", COST["wrong_symbol"], (), exchanged))
    for edit in sorted(edits, key=lambda edit: edit.cost)[:most]:
        if readings := readings_of_claim(claim, named, edit.tree, LEAST_SYMBOLS_EDITED):
            repair = Repair(f"{text(named.side)} == {text(edit.tree)}", edit.code, edit.cost)
            yield repair, Verdict("recognised", recognised_as=readings)


def _exchanged(tree: Node, names: Mapping[str, str]) -> Node:
    """Return a tree with symbols and functions of time renamed: ``names`` maps old names to new ones."""
    is_named = tree.kind == "name" or (tree.kind == "call" and is_atom(tree))
    value = names.get(str(tree.value), tree.value) if is_named else tree.value
    return replace(tree, value=value, args=tuple(_exchanged(child, names) for child in tree.args))


def _with_all_terms_added(named: NamedFormula) -> Iterator[Edit]:
    """Yield an edit that makes all minus signs of a claim plus signs: ``a + b + c = 0`` for ``a - b - c = 0``.

    The claim must have a number on one side, and on the other a sum with at least two minus signs; yield nothing for
    other claims.
    """
    negative = [term for term in named.formula.args if term.kind == "neg"]
    if named.solve is None and named.side.kind == "number" and named.formula.kind == "sum" and len(negative) > 1:
        added = sum_of([term.args[0] if term.kind == "neg" else term for term in named.formula.args])
        yield Edit("sign_of_term", COST["sign_of_term"] * len(negative), (), added)


def _edits(claim: Claim, formula: Node) -> Iterator[Edit]:
    """Yield the cheapest single edits of a formula, in the order of their costs; none of a very long formula."""
    if sum(1 for _ in walk(formula)) > MOST_NODES:
        return
    numeric = NumericFilter(claim)
    edits = single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    yield from islice(sorted(edits, key=lambda edit: edit.cost), MOST_EDITS)
