"""Claims about complex numbers and vectors that hold only in a special case, which the verdict then states in words.

``|z|^2 = z^2`` holds for a real z, ``F·d = F d`` for a displacement d along F, ``v = |v| n`` for the direction n of v.
"""

from collections.abc import Iterator
from dataclasses import replace

from symrot.checker.arrays.complex_parts import NUMBER, with_numbers, with_parts
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import Node, number, product, sum_of, walk
from symrot.checker.claim.vectors import Vector, is_components
from symrot.checker.claim_verdict import check_claim
from symrot.checker.verdict import Diagnosis, Verdict

__all__ = ["for_complex_numbers", "for_special_directions"]

UNIT = "i"
NO_FAULT = Diagnosis("none", "")
FACTOR, OTHER = "factor_", "other_"
"""Names of the positive number k in b = k a, and of the vector c in b = a x c; no claim uses these names.

The equation b = k a makes the vectors a and b of a claim parallel, and b = a x c makes them perpendicular. The claim is
then tested for these special directions.
"""


def for_complex_numbers(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict "conditional" on a claim such as ``|z|^2 = z^2``, true for real z only; otherwise
    ``verdict``.
    """
    if verdict.verdict != "true" or claim.relation is None or claim.define or claim.hypotheses or claim.has_parts:
        return verdict
    nodes = [node for side in claim.relation[1:] for _, node in walk(side)]
    names = sorted({str(node.value) for node in nodes if node.kind == "name"} - {"pi"})
    has_length = any(node.value == "abs" and node.args[0].kind == "name" for node in nodes if node.kind == "call")
    if not has_length or not all(map(NUMBER.fullmatch, names)):
        return verdict  # letters other than z, w and zeta usually mean real numbers
    numbers = {
        name: sum_of([Node("name", f"Re_{name}"), product([Node("name", UNIT), Node("name", f"Im_{name}")])])
        for name in names
    }
    sign, left, right = claim.relation
    relation = with_parts((sign, with_numbers(left, numbers), with_numbers(right, numbers)), UNIT, claim.text)
    other = check_claim(replace(claim, relation=relation, alternatives=(), has_parts=True), repair=False)
    if other.verdict != "false":
        return verdict
    condition = f"{' and '.join(names)} {'is' if len(names) == 1 else 'are'} real"
    point = other.counterexample and replace(other.counterexample, entry=None)
    return replace(
        verdict,
        verdict="conditional",
        requires=(condition,),
        conditions=(condition, *verdict.conditions),
        counterexample=point,
    )


def for_special_directions(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict "conditional" on a claim such as ``F·d = F d``, true for special directions only; else
    ``verdict``.
    """
    if verdict.verdict != "false" or claim.relation is None:
        return verdict
    vectors = [name for name, tree in claim.define if is_components(name, tree) and tree in _columns(name)]
    units = [name for name in vectors if Vector(name, unit=True).length_is_one in claim.hypotheses]
    if len(vectors) != 2 or len(claim.define) != 2 or len(units) != len(claim.hypotheses):
        return verdict
    if not any(_has_only_lengths(side) for side in claim.relation[1:]):
        return verdict
    first, second = sorted(vectors, key=lambda name: name not in units)
    own, other = Node("name", first), Node("name", OTHER)
    components = dict(claim.define)
    along = product([Node("name", FACTOR), own])
    across = Node("call", "cross", (own, other))
    positive = (">", Node("name", FACTOR), number(0))
    columns = (first, components[first]), (OTHER, Vector(OTHER).components)
    cases = [
        (f"{first} and {second} have the same direction", (columns[0], (second, along)), (positive,)),
        (f"{first} and {second} are perpendicular", (*columns, (second, across)), ()),
    ]
    if units:  # v = |v| n, with a hat over n
        cases = [(f"{second} has the direction of {first}", cases[0][1], (positive, *claim.hypotheses))]
    for condition, define, hypotheses in cases:
        special = replace(claim, define=define, hypotheses=hypotheses, alternatives=())
        if check_claim(special, repair=False).verdict == "true":
            conditional = replace(verdict, verdict="conditional", requires=(condition,), conditions=(condition,))
            is_far = verdict.diagnosis.code == "two_faults"
            return replace(conditional, diagnosis=NO_FAULT, repairs=()) if is_far else conditional
    return verdict


def _columns(name: str) -> Iterator[Node]:
    """Yield the columns of components that a vector ``name`` may have, v_x or v_1, as constants and as functions of
    time.
    """
    for axes in ("xyz", "123"):
        yield Vector(name, axes=axes).components
        yield Vector(name, timed=True, axes=axes).components


def _has_only_lengths(side: Node) -> bool:
    """Return whether a side has vectors, but only inside their lengths, as in ``|a| |b|``."""
    calls = [node for _, node in walk(side) if node.kind == "call" and node.value in ("dot", "cross")]
    return bool(calls) and all(node.value == "dot" and node.args[0] == node.args[1] for node in calls) and all(
        node.args[0].kind == "name" for node in calls
    )  # fmt: skip
