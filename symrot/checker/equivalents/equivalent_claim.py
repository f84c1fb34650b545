"""A claim in an equivalent form that symrot derives, whose repairs are changed back to the typed form.

With I_xy = integral of x*y dm, ``I_xy = a`` is decided as ``I_xy = -a``; the repair ``I_xy = -b`` becomes ``I_xy = b``.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from symrot.checker.claim.claims import Claim, relation_text
from symrot.checker.claim.reader import read_relation
from symrot.checker.typed.readings import Relation
from symrot.checker.verdict import Repair, Verdict
from symrot.errors import InputError

__all__ = ["EquivalentClaim"]


@dataclass(frozen=True)
class EquivalentClaim:
    """A claim that is equivalent to the claim that a user typed, in another form or with other names.

    Attributes
    ----------
    claim : Claim
        The claim in the other form.
    original : callable
        Rewrites an equation, such as a repair of ``claim``, in the form and with the names that the user typed.
    note : str
        A sentence that tells the user about the form.
    names : mapping
        Name in ``claim`` -> name that the user typed, where they differ.
    """

    claim: Claim
    original: Callable[[Relation], Relation]
    note: str
    names: Mapping[str, str] = field(default_factory=dict)

    def in_typed_form(self, verdict: Verdict) -> Verdict:
        """Return ``verdict``, on the equivalent claim, in the form of the typed claim; nothing is decided again.

        Repairs and names of symbols are changed back to the typed form, and ``note`` is added. Repairs that cannot be
        changed back are left out.
        """
        repairs = [changed for repair in verdict.repairs if (changed := self._rewritten(repair)) is not None]
        known = tuple(
            replace(formula, mapping={own: self.names.get(other, other) for own, other in formula.mapping.items()})
            for formula in verdict.recognised_as
        )
        return replace(verdict, repairs=tuple(repairs), recognised_as=known, notes=(*verdict.notes, self.note))

    def _rewritten(self, repair: Repair) -> Repair | None:
        try:
            return replace(repair, text=relation_text(self.original(read_relation(repair.text))))
        except InputError:
            return None
