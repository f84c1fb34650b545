"""Decide whether two formulas are equal: the normal form of their difference, and a verdict with its evidence.

Scope, with its theorem (``docs/exact_decisions.md``, sections 1 to 3). For rational functions of sines and
cosines of Q-linear combinations of angles (rational multiples of pi included), of exponentials, of parameters, of
rates, and of unit-norm groups, the normal form is zero if and only if the identity holds at all real points where both
sides are defined: circles and spheres are rational, irreducible over the complex numbers, and their real points are
dense. The same holds when an angle or an exponent also occurs outside (Ax-Schanuel). Numbers made of roots and cosines
of rational angles are zero or not by proof (:mod:`symrot.exact.angles.constants`). With square roots, inverse functions
or other hypotheses a zero normal form still proves the identity where all of them are real; a nonzero one proves
nothing, and "false" is said only with a witness. Nothing is true of sides that are real numbers nowhere.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Ge, I, Integer, Matrix, MatrixBase, MatrixExpr, Ne, sympify, zeros

from symrot.errors import InputError
from symrot.exact.budget import one_decision
from symrot.exact.congruence_closure import proof_by_congruence
from symrot.exact.counterexample import Counterexample, closed_form_witness, rational_witness
from symrot.exact.domain.domain import divisors, is_dense, radicands, split_radicands
from symrot.exact.domain.everywhere import fails_everywhere
from symrot.exact.domain.known_points import known_point
from symrot.exact.domain.needs import Need, needs_of
from symrot.exact.inverse_sums import proof, vanishes
from symrot.exact.ring.ring import FormulaRing, as_zero

__all__ = ["Verdict", "decide", "is_zero", "normal_form"]


@dataclass(frozen=True)
class Verdict:
    """What is known about ``left = right`` and why.

    ``verdict`` is ``"true"`` (proven wherever both sides are defined, and a point is known where they are),
    ``"false"`` (``counterexample`` shows it) or ``"undecided"`` (``stopped_by`` holds the terms about which too little
    is known). ``conditions`` are the denominators that must not vanish and the radicands that must not be negative;
    ``residual`` is the normal form of left - right.
    """

    verdict: str
    residual: Any
    conditions: tuple[Any, ...] = ()
    counterexample: Counterexample | None = None
    stopped_by: tuple[Expr, ...] = ()


def normal_form(expression: Any, relations: Sequence[Any] = ()) -> Any:
    """Return the normal form of a formula: exactly 0 if and only if it vanishes identically (in scope).

    Parameters
    ----------
    expression : Expr or Matrix
        Exact: no floating point numbers.
    relations : sequence of Expr or Eq
        Hypotheses; an expression stands for "this is zero", e.g. ``q0**2 + q1**2 + q2**2 + q3**2 - 1``.

    Returns
    -------
    Expr or Matrix
        Of the same shape. A nonzero result is a fraction in lowest terms of the generators of the problem (sines and
        cosines of base angles); to compare two formulas, take the normal form of their difference.

    Raises
    ------
    InputError
        If the formula holds a float or an infinity, divides by something that is zero everywhere, or if the
        hypotheses contradict each other.

    Notes
    -----
    Source: ``docs/exact_decisions.md`` says how the decision works and why it is sound.

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
    """Return whether a formula or matrix is proven to vanish identically (see :func:`normal_form`)."""
    entries, _ = flatten(expression)
    ring = FormulaRing(entries, [as_zero(relation) for relation in relations])
    return all(vanishes(ring, ring.ratio(entry).numerator) for entry in entries)


def decide(left: Any, right: Any, relations: Sequence[Any] = ()) -> Verdict:
    """Decide ``left = right`` under hypotheses.

    Parameters
    ----------
    left, right : Expr or Matrix
        Of equal shape; ``0`` stands for the zero matrix of any shape.
    relations : sequence of Expr or Eq
        Hypotheses, as for :func:`normal_form`.

    Raises
    ------
    InputError
        If the shapes differ, for what :func:`normal_form` refuses, or if a side is proven to be no real number
        anywhere.
    """
    (lefts, shape), (rights, other) = flatten(left), flatten(right)
    if shape is not None and other is None and rights == [0]:
        rights, other = list(zeros(*shape)), shape
    if shape != other:
        raise InputError(f"two sides of an equation have one shape, got {_shape_text(shape)} = {_shape_text(other)}")
    with one_decision():
        return _decided(lefts, rights, shape, relations)


def _decided(lefts: list[Expr], rights: list[Expr], shape: tuple[int, int] | None, relations: Sequence[Any]) -> Verdict:
    ring = FormulaRing([*lefts, *rights], [as_zero(relation) for relation in relations])
    differences = [ring.difference(a, b) for a, b in zip(lefts, rights, strict=True)]
    proofs = [proof(ring, value.numerator) for value in differences]
    pairs = zip(differences, proofs, strict=True)
    residuals = [ring.expression(value) if found is None else Integer(0) for value, found in pairs]
    conditions = _conditions([ring, *(lift for found in proofs if found for lift in found)])
    residual = _shaped(residuals, shape)
    wrong = [place for place, value in enumerate(residuals) if value != 0]
    if not wrong:
        return _true(residual, [*lefts, *rights], ring, conditions)
    for search in (rational_witness, closed_form_witness):
        for place in wrong[:4]:
            entry = None if shape is None else (place // shape[1] + 1, place % shape[1] + 1)
            found = search(ring, lefts[place], rights[place], entry)
            if found is not None:
                return Verdict("false", residual, conditions, found)
    lifted = [_congruent(ring, lefts[place], rights[place]) for place in wrong]
    if all(found is not None for found in lifted):
        conditions = _conditions([ring, *(lift for found in lifted if found for lift in found)])
        return _true(_shaped([Integer(0)] * len(lefts), shape), [*lefts, *rights], ring, conditions)
    stopped_by = (*ring.outside_scope, *(root.expression for root in ring.roots), *ring.hypotheses)
    return Verdict("undecided", residual, conditions, None, stopped_by)


def _true(residual: Any, sides: Sequence[Expr], ring: FormulaRing, conditions: tuple[Any, ...]) -> Verdict:
    """Return the verdict "true", or "undecided" where no point is known at which the sides are defined.

    In the polynomial core the sides are defined on a dense set; with roots, logarithms and inverse functions a point
    is looked for. Whether the hypotheses can hold is for the caller to know. Formulas with ``i`` are complex numbers,
    of which nothing is asked but that no divisor is zero.
    """
    needs = [need for need in needs_of(sides) if not need.formula.has(I)]
    needs += [Need(formula, ">= 0") for formula in split_radicands(ring) if not any(side.has(I) for side in sides)]
    if not needs or (is_dense(ring) and all(need.sign == "!= 0" for need in needs)):
        return Verdict("true", residual, conditions)
    nowhere = next((need for need in needs_of(sides) if fails_everywhere(need)), None)
    if nowhere is not None:
        raise InputError(f"the sides are real numbers nowhere: {nowhere} does not hold at any real point")
    nonzero = [Need(condition.lhs, "!= 0") for condition in conditions if isinstance(condition, Ne)]
    if known_point([*(need for need in needs if need.sign != "real"), *nonzero]) is None:
        return Verdict("undecided", residual, conditions, None, tuple(need.formula for need in needs))
    return Verdict("true", residual, conditions)


def _congruent(ring: FormulaRing, left: Expr, right: Expr) -> tuple[FormulaRing, ...] | None:
    return proof_by_congruence(left, right, ring.hypotheses, ring.domain)


def flatten(expression: Any) -> tuple[list[Expr], tuple[int, int] | None]:
    """Return the entries of a formula row by row, and its shape (None for a scalar).

    Raises
    ------
    InputError
        If it is neither a scalar formula nor a matrix of them.
    """
    expression = sympify(expression)
    if isinstance(expression, MatrixExpr):
        expression = expression.as_explicit()
    if isinstance(expression, MatrixBase):
        return list(expression), (int(expression.rows), int(expression.cols))
    if not isinstance(expression, Expr):
        raise InputError(f"exact decision takes a formula or a matrix of formulas, got {expression!r}")
    return [expression], None


def _conditions(rings: Sequence[FormulaRing]) -> tuple[Any, ...]:
    """Return what both sides need to be defined, and proofs to hold, less what the assumptions on the symbols grant."""
    nonzero = [Ne(source, 0) for ring in rings for source, _ in divisors(ring)]
    unique = dict.fromkeys([*nonzero, *(Ge(base, 0) for base in radicands(rings[0]))])
    return tuple(sorted(unique, key=str))


def _shaped(entries: list[Expr], shape: tuple[int, int] | None) -> Any:
    return entries[0] if shape is None else Matrix(*shape, entries)


def _shape_text(shape: tuple[int, int] | None) -> str:
    return "a scalar" if shape is None else f"a {shape[0]} x {shape[1]} matrix"
