"""The verdict on a claim that was decided in an equivalent form, with its repairs changed back to the typed form.

With I_xy = integral of x*y dm, ``I_xy = a`` is decided as ``I_xy = -a``; the repair ``I_xy = -b`` becomes ``I_xy = b``.
"""

from collections.abc import Callable
from dataclasses import replace

from symrot.checker.claim.claims import relation_text
from symrot.checker.claim.reader import read_relation
from symrot.checker.typed.readings import Relation
from symrot.checker.verdict import Repair, Verdict
from symrot.errors import InputError

__all__ = ["brought_back"]


def brought_back(verdict: Verdict, original: Callable[[Relation], Relation], note: str) -> Verdict:
    """Return ``verdict``, on an equivalent claim, for the typed claim: ``original`` rewrites each repair.

    ``note`` tells the user about the equivalent claim.
    """
    repairs = [changed for repair in verdict.repairs if (changed := _brought_back(repair, original)) is not None]
    return replace(verdict, repairs=tuple(repairs), notes=(*verdict.notes, note))


def _brought_back(repair: Repair, original: Callable[[Relation], Relation]) -> Repair | None:
    try:
        return replace(repair, text=relation_text(original(read_relation(repair.text))))
    except InputError:
        return None
