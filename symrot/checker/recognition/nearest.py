"""The formula nearest to a claim that only names one, ``omega_x == ...``, among those that symrot derives.

Such a claim cannot be proven, because nothing else says what the name stands for; most formulas of papers look like
this. The formula, then each single edit of it, is looked up by fingerprint and proven equal. It is reported if its
symbols have their usual names.
"""

from collections.abc import Iterator
from itertools import chain, islice

from sympy import Function, Symbol

from symrot.checker.claim.claims import Claim, named_formula
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, text, walk
from symrot.checker.recognition.identification import Identification, identified
from symrot.checker.repair.edits import FAULT_DESCRIPTIONS, single_edits
from symrot.checker.repair.filter import NumericFilter
from symrot.errors import InputError

__all__ = ["nearest_known"]

MOST_EDITS = 400
MOST_NODES = 400
"""The most edits that are looked up, and the most pieces of a formula that is edited at all."""
LEAST_SYMBOLS = 3
"""The fewest symbols of a scalar that is looked up."""
MOST_NAMES = 2
"""The most names that one note gives."""

PLACES = {"first": "x1", "second": "y2", "third": "z3", "scalar": "0"}
"""Name of a component -> the last letters of symbols for it."""
AXES = ("x1A", "y2B", "z3C")
"""Last letters of symbols that belong to one axis."""

Candidate = tuple[str, Node, list[Identification]]
"""The code of an edit, the formula after it, and the identifications of that formula."""


def nearest_known(claim: Claim) -> tuple[str, ...]:
    """Return a note on a claim that only names a formula: which formula it is, or which one is nearest to it."""
    named = named_formula(claim)
    if named is None:
        return ()
    name, formula = named
    note = f"nothing here says what {name} is, so the claim can only name a formula"
    edits = chain([("", formula)], _edits(claim, formula))
    candidates: list[Candidate] = []
    for code, tree in edits:
        if known := _known(claim, name, tree):
            candidates.append((code, tree, known))
            if not known[0].mapping:
                break
    if not candidates:
        return (note,)
    code, tree, known = min(candidates, key=lambda candidate: _strangeness(candidate[2][0]))
    alike = [one for one in known if _strangeness(one) == _strangeness(known[0])]
    names = ", or ".join(f"the {k.name}{k.renaming and f' ({k.renaming})'}" for k in alike[:MOST_NAMES])
    if not code:
        return (f"{note}: {names}",)
    return (f"{note}; the nearest that symrot derives is {text(tree)}, {names}: {FAULT_DESCRIPTIONS[code]}",)


def _strangeness(known: Identification) -> tuple[int, int]:
    """Return how many symbols are named for another axis, and how many have another name at all."""
    axes = [[next((n for n, axis in enumerate(AXES) if name[-1] in axis), None) for name in pair]
            for pair in known.mapping.items()]  # fmt: skip
    return sum(None not in pair and pair[0] != pair[1] for pair in axes), len(known.mapping)


def _edits(claim: Claim, formula: Node) -> Iterator[tuple[str, Node]]:
    """Yield (code, tree) of the single edits of a formula, the nearest first."""
    if sum(1 for _ in walk(formula)) > MOST_NODES:
        return
    numeric = NumericFilter(claim)
    edits = single_edits(formula, numeric.names, numeric.functions, numeric.is_matrix, numeric.moving)
    for edit in islice(sorted(edits, key=lambda edit: edit.cost), MOST_EDITS):
        yield edit.code, edit.tree


def _known(claim: Claim, name: str, tree: Node) -> list[Identification]:
    """Return the identifications of a formula: fewest renamed symbols first, then the component that the name says."""
    try:
        value = claim.interpreter().read(tree)
    except InputError:
        return []
    if not is_matrix(value) and len(value.atoms(Function, Symbol) - {time}) < LEAST_SYMBOLS:
        return []

    def order(known: Identification) -> tuple[int, int, bool]:
        return *_strangeness(known), name[-1] not in PLACES.get(known.name.split()[0], name[-1])

    return sorted((known for known in identified(value, steps=False) if not known.how), key=order)
