"""Deciding claims by substitution: each quantity is replaced by its formula in independent coordinates of a motion.

A claim follows from these formulas if and only if it becomes an identity.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

from sympy import Expr

from symrot.checker.claim.claims import Claim
from symrot.checker.context.context import Context
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.verdict import Diagnosis, Identification, Verdict
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.floats import seems_zero
from symrot.exact.ring.ratio import TooLarge

__all__ = ["Substitution", "by_substitution", "decided"]

MOST_SUBSTITUTIONS = 200
MOST_READINGS = 4
OPEN = ("definition", "doubtful", "false", "undecided")
"""Verdicts that a true interpretation of a claim overrules."""
GUESSED = "guessed, not stated"


@dataclass(frozen=True)
class Substitution:
    """One interpretation of a claim's letters: the formulas to substitute for them.

    Attributes
    ----------
    name, source : str
        The name of the relation that the formulas state, and where symrot derives it.
    values : dict
        Symbol or rate of the claim -> its formula in the coordinates of the motion.
    guess : str
        What this interpretation assumes without a statement; empty if everything is stated.
    sides : tuple (Expr, Expr) or None
        An equation to decide in place of the claim's equation, if not None.
    mapping : dict
        Symbol of the relation -> letter of the claim, where they differ.
    """

    name: str
    source: str
    values: dict[Expr, Expr]
    guess: str = ""
    sides: tuple[Expr, Expr] | None = None
    mapping: dict[str, str] = field(default_factory=dict)

    @property
    def identification(self) -> Identification:
        """The relation called ``name`` as an Identification, the type of the entries of ``Verdict.recognised_as``."""
        return Identification(self.name, "", self.mapping, self.source)


def decided(equation: Equation, substitution: Substitution) -> Decision | None:
    """Return the decision on an equation after ``substitution``; None if its formulas are too large or have no
    value.
    """
    try:
        return decide_equation(Equation(*_sides(equation, substitution)))
    except (InputError, TooLarge):
        return None


def may_be_true(equation: Equation, substitution: Substitution) -> bool:
    """Return whether an equation holds at sample points after ``substitution``."""
    # a quick test by numbers, before an exact decision
    left, right = _sides(equation, substitution)
    return seems_zero(left - right)


def _sides(equation: Equation, substitution: Substitution) -> tuple[Any, Any]:
    """Return both sides of an equation with the formulas of ``substitution`` in place of its letters."""
    left, right = substitution.sides or (equation.left, equation.right)
    return left.xreplace(substitution.values), right.xreplace(substitution.values)


def by_substitution(
    claim: Claim, verdict: Verdict, substitutions: Iterable[Substitution], is_complete: bool
) -> Verdict:
    """Return the verdict on a claim that follows from ``substitutions``, the possible meanings of its letters.

    The claim is decided after each substitution. It may be "false" only if ``is_complete``, that is, if its letters
    have no other possible meanings. Return ``verdict`` if the substitutions decide nothing.
    """
    if not is_complete and verdict.verdict not in OPEN:
        return verdict
    equation = claim.equation
    decisions = [
        (way, decided(equation, way) if is_complete or may_be_true(equation, way) else None)
        for way in islice(substitutions, MOST_SUBSTITUTIONS)
    ]
    true = [way for way, decision in decisions if decision is not None and decision.verdict == "true"]
    is_stated = is_complete and any(not way.guess for way in true)
    if true and (verdict.verdict in OPEN or (is_stated and verdict.verdict == "recognised")):
        return _recognised(claim.context, verdict, true, is_complete)
    # only a complete list of interpretations can refute a claim
    false = [(way, decision) for way, decision in decisions if decision is not None and decision.verdict == "false"]
    if not is_complete or not decisions or len(false) < len(decisions) or verdict.verdict in ("false", "refused"):
        return verdict
    (way, decision), *_ = false
    reason = f"it contradicts the {way.name}"
    repairs = verdict.repairs if verdict.verdict == "doubtful" else ()
    diagnosis = verdict.diagnosis if repairs else Diagnosis("context", reason)
    return Verdict("false", counterexample=decision.counterexample, diagnosis=diagnosis, repairs=repairs,
                   recognised_as=(way.identification,), notes=verdict.notes)  # fmt: skip


def _recognised(context: Context, verdict: Verdict, true: Sequence[Substitution], is_complete: bool) -> Verdict:
    """Return the verdict "true" or "recognised" on a claim that holds under the interpretations ``true``.

    It is "true" if the claim has a context, one of ``true`` guesses nothing beyond what the claim and its context
    state, and all interpretations of the claim were tried (``is_complete``).
    """
    stated = [way for way in true if not way.guess]
    readings = tuple(way.identification for way in (stated or true)[:MOST_READINGS])
    if stated and context and is_complete:
        notes = tuple(note for note in verdict.notes if not note.startswith(GUESSED))
        return Verdict("true", recognised_as=readings, notes=notes)
    guess = true[0].guess if not stated else ""
    # the user learns what was guessed
    notes = (*verdict.notes, f"{GUESSED}: {guess}") if guess else verdict.notes
    return Verdict("recognised", recognised_as=readings, notes=notes)
