"""Claims with the aircraft's names, decided with the letters of most books.

P, Q, R are p, q, r, the rates of roll, pitch and yaw; the words roll, pitch and yaw are the angles phi, theta and psi.
"""

from collections.abc import Mapping
from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import TIME, Node, is_derivative, walk
from symrot.checker.equivalents.equivalent_claim import EquivalentClaim
from symrot.checker.typed.readings import Relation

__all__ = ["with_usual_letters"]

SMALL = {"P": "p", "Q": "q", "R": "r"}
IN_WORDS = {"roll": "phi", "pitch": "theta", "yaw": "psi"}
ANGLES = {*IN_WORDS.values()}
RATES_NOTE = "P, Q and R are read as the rates of roll, pitch and yaw, p, q and r"
WORDS_NOTE = "roll, pitch and yaw are read as the angles phi, theta and psi"


def with_usual_letters(claim: Claim) -> EquivalentClaim | None:
    """Return a claim with other names: p, q, r in place of P, Q, R, or phi, theta, psi in place of roll, pitch, yaw.

    P, Q and R are replaced only in a claim that contains the rate of phi, theta or psi, and that has no letters except
    P, Q, R, phi, theta and psi. The words roll, pitch and yaw are replaced only if none of phi, theta and psi occurs.
    Return None for other claims, and for claims with a context, hypotheses or definitions.
    """
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
    original = {letter: name for name, letter in names.items()}
    other = claim.with_relation(_renamed(claim.relation, names), alternatives=())
    return EquivalentClaim(other, lambda relation: _renamed(relation, original), note, original)


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
