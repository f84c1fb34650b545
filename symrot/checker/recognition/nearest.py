"""A claim that only names a formula, ``omega_x == ...``: what symrot derives that is this formula, or nearest to it.

Nothing but that claim says what the name stands for, so it is no identity; a paper's formula mostly comes like that.
The formula, then each single edit of it, is looked up by fingerprint, proven equal, and named if its symbols have
their usual names.
"""

from collections.abc import Iterator
from itertools import chain, islice

from sympy import Function, Symbol

from symrot.checker.claim.claims import Claim, named_formula
from symrot.checker.claim.interpreter import time
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, text, walk
from symrot.checker.recognition.identification import Identification, identified
from symrot.checker.repair.edits import TEXTS, single_edits
from symrot.checker.repair.filter import NumericFilter
from symrot.errors import InputError

__all__ = ["nearby"]

MOST_EDITS = 400
MOST_NODES = 400
"""Pieces of a formula whose edits are looked up."""
LEAST_SYMBOLS = 3
MOST_NAMES = 2

PLACES = {"first": "x1", "second": "y2", "third": "z3", "scalar": "0"}
"""How a component is called -> the last letters of a name that says the same."""
AXES = ("x1A", "y2B", "z3C")
"""Last letters of names that belong to one axis."""

Found = tuple[str, Node, list[Identification]]
"""Code of an edit, the formula after it, what that is."""


def nearby(claim: Claim) -> tuple[str, ...]:
    """Return sentences on a claim that only names a formula: what it is, or what the nearest formula is."""
    named = named_formula(claim)
    if named is None:
        return ()
    name, formula = named
    said = f"nothing here says what {name} is, so the claim can only name a formula"
    edits = chain([("", formula)], _edits(claim, formula))
    found: list[Found] = []
    for code, tree in edits:
        if known := _known(claim, name, tree):
            found.append((code, tree, known))
            if not known[0].mapping:
                break
    if not found:
        return (said,)
    code, tree, known = min(found, key=lambda one: _strangeness(one[2][0]))
    alike = [one for one in known if _strangeness(one) == _strangeness(known[0])]
    names = ", or ".join(f"the {k.name}{k.renamed and f' ({k.renamed})'}" for k in alike[:MOST_NAMES])
    if not code:
        return (f"{said}: {names}",)
    return (f"{said}; the nearest that symrot derives is {text(tree)}, {names}: {TEXTS[code]}",)


def _strangeness(known: Identification) -> tuple[int, int]:
    """Return how many names stand for those of another axis, and how many differ at all."""
    axes = [[next((n for n, axis in enumerate(AXES) if name[-1] in axis), None) for name in pair]
            for pair in known.mapping.items()]  # fmt: skip
    return sum(None not in pair and pair[0] != pair[1] for pair in axes), len(known.mapping)


def _edits(claim: Claim, formula: Node) -> Iterator[tuple[str, Node]]:
    """Yield (code, tree) of the single edits of a formula, the nearest first."""
    if sum(1 for _ in walk(formula)) > MOST_NODES:
        return
    sieve = NumericFilter(claim)
    edits = single_edits(formula, sieve.names, sieve.functions, sieve.is_matrix, sieve.moving)
    for edit in islice(sorted(edits, key=lambda edit: edit.cost), MOST_EDITS):
        yield edit.code, edit.tree


def _known(claim: Claim, name: str, tree: Node) -> list[Identification]:
    """Return what symrot derives that is a formula, fewest renamed first, then by place: first for ``omega_x``."""
    try:
        value = claim.interpreter().read(tree)
    except InputError:
        return []
    if not is_matrix(value) and len(value.atoms(Function, Symbol) - {time}) < LEAST_SYMBOLS:
        return []

    def order(known: Identification) -> tuple[int, int, bool]:
        return *_strangeness(known), name[-1] not in PLACES.get(known.name.split()[0], name[-1])

    return sorted((known for known in identified(value, steps=False) if not known.how), key=order)
