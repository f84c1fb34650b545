"""Decides whether two formulas are equal: the normal form of their difference, and a verdict with its evidence.

Formulas in scope are rational functions of symbols, exponentials, unit vectors, and sines and cosines of angles. Their
normal form is zero if and only if they are zero at all real points (``docs/exact_decisions.md``, sections 1 to 3).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Expr, Ge, I, Integer, Matrix, Ne

from symrot.errors import InputError
from symrot.exact.counterexample import closed_form_witness, rational_witness
from symrot.exact.decision import (
    Case,
    Decision,
    Shape,
    arguments,
    congruence,
    first_decision,
    flatten,
    matched_sides,
    prove,
    refute,
    subtract,
)
from symrot.exact.domain.domain import divisors, is_dense, radicands, split_radicands
from symrot.exact.domain.everywhere import fails_everywhere
from symrot.exact.domain.known_points import known_point
from symrot.exact.domain.needs import Need, needs_of
from symrot.exact.inverse_sums import vanishes
from symrot.exact.limits.budget import one_decision
from symrot.exact.ring.ring import FormulaRing, as_zero
from symrot.exact.ring.roots import written

__all__ = ["decide", "is_zero", "normal_form"]


def normal_form(expression: Any, relations: Sequence[Any] = ()) -> Any:
    """Return the normal form of a formula; it is 0 only if the formula is zero wherever it is defined.

    A formula that is zero has the normal form 0 if it is in the scope of this module: a rational function of symbols,
    exponentials, unit vectors, and sines and cosines of angles. Otherwise its normal form may differ from 0.

    Parameters
    ----------
    expression : Expr or Matrix
        The formula, without floating point numbers.
    relations : sequence of Expr or Eq
        Hypotheses; an expression means that it is zero, e.g. ``q0**2 + q1**2 + q2**2 + q3**2 - 1``.

    Returns
    -------
    Expr or Matrix
        The normal form, of the same shape as ``expression``. A nonzero result is a fraction in lowest terms of the
        generators of the problem (sines and cosines of base angles); to compare two formulas, take the normal form of
        their difference.

    Raises
    ------
    InputError
        If the formula contains a float or an infinity, if it divides by an expression that is zero everywhere, or if
        the hypotheses contradict each other.

    Notes
    -----
    Source: ``docs/exact_decisions.md`` explains how the decision works and why it is sound.

    Examples
    --------
    >>> from symrot.symbols import theta
    >>> from sympy import cos, sin
    >>> normal_form(cos(2*theta) - 1 + 2*sin(theta)**2)
    0
    """
    entries, shape = flatten(expression)
    ring = FormulaRing(entries, [as_zero(relation) for relation in relations])
    values = [ring.ratio(entry) for entry in entries]
    return _shaped([Integer(0) if vanishes(ring, v.numerator) else ring.expression(v) for v in values], shape)


def is_zero(expression: Any, relations: Sequence[Any] = ()) -> bool:
    """Return whether a formula, or each entry of a matrix, is proven to be zero wherever it is defined.

    ``relations`` are hypotheses, as for :func:`normal_form`. For formulas outside the scope of this module (see
    :func:`normal_form`), the result False proves nothing.
    """
    entries, _ = flatten(expression)
    ring = FormulaRing(entries, [as_zero(relation) for relation in relations])
    return all(vanishes(ring, ring.ratio(entry).numerator) for entry in entries)


def decide(left: Any, right: Any, relations: Sequence[Any] = ()) -> Decision:
    """Decide whether ``left = right`` holds under hypotheses; return the verdict with its evidence.

    Parameters
    ----------
    left, right : Expr or Matrix
        The two sides, of equal shape; ``0`` means the zero matrix of any shape.
    relations : sequence of Expr or Eq
        Hypotheses, as for :func:`normal_form`.

    Returns
    -------
    Decision
        ``.verdict`` is ``"true"``, ``"false"`` or ``"undecided"``.

    Raises
    ------
    InputError
        If the shapes differ, if :func:`normal_form` raises it, or if a side is proven to be nowhere a real number.
    """
    lefts, rights, shape = matched_sides(left, right)
    with one_decision():
        ring = FormulaRing([*lefts, *rights], [as_zero(relation) for relation in relations])
        case = _FormulaCase(lefts, rights, shape, ring)
        decision = first_decision(case, STAGES)
    return replace(decision, residual=case.residual())


@dataclass
class _FormulaCase(Case):
    """An equation between formulas under decision, with the evidence that the functions :data:`STAGES` collect."""

    normal_forms: dict[int, Expr] = field(default_factory=dict)  # index of an entry -> normal form of left - right

    def residual(self) -> Any:
        """The normal form of left - right, for the report; entries of a matrix that are proven equal are zero."""
        forms = {place: self.normal_forms[place] for place in self.unproven}
        return _shaped([forms.get(place, Integer(0)) for place in range(len(self.lefts))], self.shape)

    def conditions_of(self, rings: Sequence[FormulaRing]) -> tuple[Any, ...]:
        nonzero = [Ne(source, 0) for ring in (self.ring, *rings) for source, _ in divisors(ring)]
        unique = dict.fromkeys([*nonzero, *(Ge(base, 0) for base in radicands(self.ring))])
        return tuple(sorted(unique, key=written))

    def confirmed(self) -> Decision:
        """Return the decision "true", or "undecided" if no point is known where both sides are defined.

        Raise InputError if a side is proven to be nowhere a real number.
        """
        # formulas with ``i`` are complex, and defined wherever no divisor is zero
        needs = [need for need in needs_of(self.sides) if not need.formula.has(I)]
        if not any(side.has(I) for side in self.sides):
            needs += [Need(formula, ">= 0") for formula in split_radicands(self.ring)]
        # the caller knows that the hypotheses can be satisfied; without roots the domain is dense
        if not needs or (is_dense(self.ring) and all(need.sign == "!= 0" for need in needs)):
            return Decision("true", self.conditions)
        nowhere = next((need for need in needs_of(self.sides) if fails_everywhere(need)), None)
        if nowhere is not None:
            raise InputError(
                "expected sides that are real for some real values of their symbols, but the sides are real only under "
                f"the condition '{nowhere}', which no real values satisfy"
            )
        nonzero = [Need(condition.lhs, "!= 0") for condition in self.conditions if isinstance(condition, Ne)]
        if known_point([*(need for need in needs if need.sign != "real"), *nonzero]) is None:
            return Decision("undecided", self.conditions, stopped_by=tuple(need.formula for need in needs))
        return Decision("true", self.conditions)


# -- the stages for formulas ------------------------------------------------------------------------------------------


def normalise(case: _FormulaCase) -> None:
    """Convert the unproven entries of left - right to normal form; entries with the form 0 are then proven."""
    case.normal_forms = {place: case.ring.expression(case.residuals[place]) for place in case.unproven}
    case.unproven = [place for place, form in case.normal_forms.items() if form != 0]


def witness(case: _FormulaCase) -> None:
    """Search for a counterexample, first at rational points, then at closed-form points, and store it in ``case``."""
    case.rely_on(case.proof_rings)
    case.counterexample = case.search(rational_witness, closed_form_witness)


def leave_open(case: _FormulaCase) -> Decision:
    """Return the verdict "undecided", with the terms that prevent a decision, such as nested roots."""
    ring = case.ring
    stopped_by = (*ring.outside_scope, *(root.expression for root in ring.roots), *ring.hypotheses)
    return Decision("undecided", case.conditions, stopped_by=stopped_by)


# With roots, inverse functions or other hypotheses, a zero normal form still proves the identity wherever all formulas
# are real, but a nonzero normal form proves nothing.
STAGES = (subtract, normalise, prove, witness, refute, arguments, congruence, leave_open)
"""Functions that try in this order to decide an equation; the last one always returns a decision."""


def _shaped(entries: list[Expr], shape: Shape) -> Any:
    return entries[0] if shape is None else Matrix(*shape, entries)
