"""Repairs in the notation in which the claim was typed: ``q p`` for ``qmul(q, p)``, abbreviations, LaTeX."""

from collections.abc import Sequence
from dataclasses import replace

from symrot.checker.arrays.as_written import as_written, has_arrays, is_odd, with_inverses
from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.notation import Notation
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import Node, exchanged, walk
from symrot.checker.marks import changed_entry, changed_spans
from symrot.checker.typed.readings import Relation
from symrot.checker.verdict import Repair
from symrot.errors import InputError

__all__ = ["as_inequality", "as_typed", "as_typed_repairs", "in_notation", "relation_of"]

AS_TYPED = ("degrees",)
"""Fault codes (`Repair.code`) of the repairs whose text is already in the notation of the claim's text."""

CALLS_FOR_ARRAYS = ("qmul(", "eye(", "⊗", "\\otimes")
"""Notations of quaternion products and identity matrices: claims without any get repairs without ``qmul`` etc."""


def as_typed_repairs(repairs: Sequence[Repair], claim: Claim, notation: Notation) -> tuple[Repair, ...]:
    """Return ``repairs`` in the notation of the claim's text, each text once.

    Left out are repairs that people would not write. If the claim's text writes a formula in a short form, such as
    ``e^(theta K)`` for a rotation matrix, repairs that change this formula are left out too: the short form cannot
    express the change.
    """
    typed = [
        repair if repair.code in AS_TYPED else in_notation(repair, claim, notation)
        for repair in repairs
        if not _is_odd(repair) and _keeps(repair, claim.written)
    ]
    first: dict[str, Repair] = {}
    for repair in typed:
        first.setdefault(repair.text, repair)
    return tuple(first.values())


def in_notation(repair: Repair, claim: Claim, notation: Notation) -> Repair:
    """Return a repair in the notation of the claim, with the positions at which its text differs from the claim's."""
    if claim.relation is None:
        return replace(repair, text=notation.rewritten(repair.text))
    relation = claim.relation if claim.unsplit is None else claim.unsplit[1]
    texts: Sequence[str] = [as_typed(source, claim.written) for source in (relation_text(relation), repair.text)]
    unchanged = [place for place in ("left", "right") if place not in repair.edited] if repair.edited else []
    if len(unchanged) == 1:
        texts = [_with_inverse(source, unchanged[0], claim.text) for source in texts]
    if not any(call in claim.text for call in CALLS_FOR_ARRAYS):
        texts = list(map(_with_plain_arrays, texts))
    before, after = map(notation.rewritten, texts)
    changed, text = changed_spans(before, after), after
    return replace(repair, text=text, changed=changed, entry=changed_entry(relation, repair.text))


def as_inequality(repair: Repair, claim: Claim, sign: str, notation: Notation) -> Repair:
    """Return the repair of an inequality, in the notation of its text, from the repair of an equation.

    ``claim`` is the inequality with == in place of its ``sign``, such as "<". A repair whose text is not an
    equation is returned unchanged.
    """
    relation = relation_of(repair.text)
    if relation is None or relation[0] != "==" or claim.relation is None:
        return repair
    before, after = (notation.relation((sign, *sides)) for sides in (claim.relation[1:], relation[1:]))
    return replace(repair, text=after, changed=changed_spans(before, after))


def as_typed(source: str, written: Sequence[tuple[Node, Node]]) -> str:
    """Return the equation or inequality ``source`` with formulas replaced by short forms that the claim's text uses.

    ``written`` has pairs (formula, short form).
    """
    relation = relation_of(source) if written else None
    if relation is None:
        return source
    sign, left, right = relation
    return relation_text((sign, exchanged(left, dict(written)), exchanged(right, dict(written))))


def _keeps(repair: Repair, written: Sequence[tuple[Node, Node]]) -> bool:
    """Return whether a repair still contains each formula that the claim's text writes in a short form.

    ``written`` has pairs (formula, short form). The answer is True if there are no pairs, or if the repair is not an
    equation.
    """
    relation = relation_of(repair.text) if written else None
    nodes = [node for side in relation[1:] for _, node in walk(side)] if relation else []
    return not nodes or all(formula in nodes for formula, _ in written)


def _with_inverse(source: str, place: str, typed: str) -> str:
    """Return the equation ``source`` with the side ``place`` replaced by ``q**(-1)`` if this side is q*/|q|^2.

    ``place`` is "left" or "right". Return ``source`` unchanged if the side is not such an inverse, or if ``typed``, the
    claim's text, does not write inverses as powers.
    """
    relation = relation_of(source)
    if relation is None or relation[0] != "==":
        return source
    left, right = relation[1:]
    inverse = with_inverses([left if place == "left" else right], typed)[0]
    left, right = (inverse, right) if place == "left" else (left, inverse)
    return source if relation[1:] == (left, right) else relation_text(("==", left, right))


def _with_plain_arrays(source: str) -> str:
    """Return the text of an equation as people write it, with ``q*p`` for the quaternion ``qmul(q, p)``.

    Other texts are returned unchanged.
    """
    relation = relation_of(source)
    if relation is None or not has_arrays(relation[1:]):
        return source
    sign, left, right = relation
    return relation_text((sign, as_written(left), as_written(right)))


def relation_of(source: str) -> Relation | None:
    """Parse the text of a repair; return None if it is not an equation or inequality, as for a repair in words."""
    try:
        return read_relation(source)
    except InputError:
        return None


def _is_odd(repair: Repair) -> bool:
    relation = relation_of(repair.text)
    return relation is not None and is_odd(relation[1:])
