"""Claims that are judged in another form: the repairs of the other form, brought back to the original claim."""

from collections.abc import Callable
from dataclasses import replace

from symrot.checker.claim.claims import relation_text
from symrot.checker.claim.reader import Relation, read_relation
from symrot.checker.verdict import Repair, Verdict
from symrot.errors import InputError

__all__ = ["brought_back"]


def brought_back(verdict: Verdict, original: Callable[[Relation], Relation], note: str) -> Verdict:
    """Return the verdict on an original claim from that on an equivalent claim.

    ``original`` changes a relation of the equivalent claim into one of the original claim; the repairs are changed by
    it, and those that cannot be read are left out. ``note`` tells the user about the equivalent claim.
    """
    repairs = [changed for repair in verdict.repairs if (changed := _brought_back(repair, original)) is not None]
    return replace(verdict, repairs=tuple(repairs), notes=(*verdict.notes, note))


def _brought_back(repair: Repair, original: Callable[[Relation], Relation]) -> Repair | None:
    try:
        return replace(repair, text=relation_text(original(read_relation(repair.text))))
    except InputError:
        return None
