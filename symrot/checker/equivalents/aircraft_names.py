"""Claims with the aircraft's names, decided with the letters of most books.

P, Q, R are p, q, r, the rates of roll, pitch and yaw; the words roll, pitch and yaw are the angles phi, theta and psi.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import TIME, Node, is_derivative, walk
from symrot.checker.equivalents.equivalent_claim import brought_back
from symrot.checker.typed.readings import Relation
from symrot.checker.verdict import Verdict

__all__ = ["Renamed", "with_usual_letters"]

SMALL = {"P": "p", "Q": "q", "R": "r"}
IN_WORDS = {"roll": "phi", "pitch": "theta", "yaw": "psi"}
ANGLES = {*IN_WORDS.values()}
RATES_NOTE = "P, Q and R are read as the rates of roll, pitch and yaw, p, q and r"
WORDS_NOTE = "roll, pitch and yaw are read as the angles phi, theta and psi"


@dataclass(frozen=True)
class Renamed:
    """A claim with other letters, the map from the names of the original claim to them, and a note for the user."""

    claim: Claim
    names: Mapping[str, str]
    note: str

    def in_claim(self, verdict: Verdict) -> Verdict:
        """Return ``verdict``, on the renamed claim, for the original one."""
        original = {letter: name for name, letter in self.names.items()}
        readings = tuple(
            replace(reading, mapping={own: original.get(other, other) for own, other in reading.mapping.items()})
            for reading in verdict.recognised_as
        )
        verdict = replace(verdict, recognised_as=readings)
        return brought_back(verdict, lambda relation: _renamed(relation, original), self.note)


def with_usual_letters(claim: Claim) -> Renamed | None:
    """Return a claim with p, q, r for P, Q, R beside Euler angles, or with phi for roll; None for other claims."""
    if claim.relation is None or claim.define or claim.hypotheses or claim.context:
        return None
    nodes = [node for side in claim.relation[1:] for _, node in walk(side)]
    letters = {str(node.value) for node in nodes if _is_quantity(node)} - {"t", "pi"}
    rates = {str(node.args[0].value) for node in nodes if is_derivative(node)}
    # P, Q and R alone have other meanings in most books
    if letters & {*SMALL} and letters <= {*SMALL, *ANGLES} and rates & ANGLES:
        names, note = SMALL, RATES_NOTE
    elif letters & {*IN_WORDS} and not letters & ANGLES:
        names, note = IN_WORDS, WORDS_NOTE
    else:
        return None
    return Renamed(claim.with_relation(_renamed(claim.relation, names), alternatives=()), names, note)


def _is_quantity(node: Node) -> bool:
    return node.kind == "name" or (node.kind == "call" and node.args == (TIME,))


def _renamed(relation: Relation, names: Mapping[str, str]) -> Relation:
    sign, left, right = relation
    return sign, _with_names(left, names), _with_names(right, names)


def _with_names(tree: Node, names: Mapping[str, str]) -> Node:
    """Return a tree with other names of its symbols and functions of time."""
    if _is_quantity(tree) and tree.value in names:
        return replace(tree, value=names[str(tree.value)])
    return replace(tree, args=tuple(_with_names(child, names) for child in tree.args))
