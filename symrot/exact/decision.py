"""The decision engine: an equation passes through named stages until one of them decides it.

A stage is a function of a case (an equation with the evidence so far). It returns a decision, or None to pass the case
on, and stores its proofs or its counterexample in the case for later stages.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeVar

from sympy import Expr, Integer, MatrixBase, MatrixExpr, SympifyError, sympify

from symrot.errors import InputError
from symrot.exact.congruence_closure import proof_by_congruence
from symrot.exact.evidence import Counterexample, Requirement
from symrot.exact.intervals import enclosure
from symrot.exact.inverse_sums import proof
from symrot.exact.plain_arguments import proof_by_arguments
from symrot.exact.ring.ratio import Ratio, TooLarge
from symrot.exact.ring.ring import FormulaRing

__all__ = [
    "Case", "Decision", "Search", "Shape", "ShapeMismatch", "arguments", "congruence", "first_decision", "flatten",
    "matched_sides", "place_in_matrix", "prove", "refute", "shape_text", "subtract",
]  # fmt: skip

MOST_SEARCHED = 4
"""Largest number of unproven matrix entries in which a counterexample is sought by default."""

Shape = tuple[int, int] | None
"""(rows, columns) of a matrix; None for a scalar."""

Search = Callable[[FormulaRing, Expr, Expr, tuple[int, int] | None], Counterexample | None]
"""A search for a point where two formulas differ: (ring, left, right, entry of the matrix) -> counterexample."""


@dataclass(frozen=True)
class Decision:
    """The decision on an equation, with its evidence.

    Attributes
    ----------
    verdict : str
        ``"true"``: proven wherever both sides are defined, and a point is known where they are. ``"false"``: there is a
        ``counterexample``. ``"conditional"``: true under any one of ``requires``. ``"undecided"``: none of these is
        proven.
    conditions : tuple
        Relations that hold where both sides are defined: divisors are not zero, radicands are not negative. For a
        conditional claim, its requirements come first.
    requires : tuple of Requirement
        Conditions, each of which alone makes a conditional claim true.
    counterexample : Counterexample or None
        A point where the two sides differ, if the verdict is ``"false"``.
    reason : str
        The reason why a claim is undecided; otherwise empty.
    residual : Expr or Matrix or None
        The normal form of left - right; only :func:`symrot.exact.decide.decide` stores it.
    stopped_by : tuple of Expr
        The terms about which too little is known to decide; only :func:`symrot.exact.decide.decide` stores them.
    products : int
        The number of products of terms that expanding the formulas of a claim took.
    """

    verdict: str
    conditions: tuple[Any, ...] = ()
    requires: tuple[Requirement, ...] = ()
    counterexample: Counterexample | None = None
    reason: str = ""
    residual: Any = None
    stopped_by: tuple[Expr, ...] = ()
    products: int = 0


@dataclass
class Case(ABC):
    """An equation under decision: the entries of its sides, their ring, and the evidence that the stages collect.

    Attributes
    ----------
    lefts, rights : list of Expr
        Entries of the two sides, row by row.
    shape : (int, int) or None
        Rows and columns of both sides; None for scalars.
    ring : FormulaRing
        The ring into which the sides and the hypotheses are read.
    residuals : list of Ratio
        left - right of each entry.
    unproven : list of int
        Indices of the entries for which no proof of equality is known.
    proof_rings : tuple of FormulaRing
        The rings, besides ``ring``, that the function :func:`subtract` used to prove single entries equal. A stage that
        proves the other entries passes these rings, and the rings of its own proofs, to :meth:`rely_on`.
    rings : tuple of FormulaRing
        The rings that were last passed to :meth:`rely_on`. When all entries are proven, these are the rings of all the
        proofs, without ``ring``. The divisors in these rings are assumed to be nonzero; this assumption is among the
        ``conditions``.
    conditions : tuple
        Relations under which the verdict holds.
    counterexample : Counterexample or None
        A point where the two sides differ, if a stage has found one.
    """

    lefts: list[Expr]
    rights: list[Expr]
    shape: Shape
    ring: FormulaRing
    residuals: list[Ratio] = field(default_factory=list)
    unproven: list[int] = field(default_factory=list)
    proof_rings: tuple[FormulaRing, ...] = ()
    rings: tuple[FormulaRing, ...] = ()
    conditions: tuple[Any, ...] = ()
    counterexample: Counterexample | None = None

    @abstractmethod
    def conditions_of(self, rings: Sequence[FormulaRing]) -> tuple[Any, ...]:
        """Return the conditions, such as ``x != 0``, under which a proof in the polynomial rings ``rings`` is valid."""

    @abstractmethod
    def confirmed(self) -> Decision:
        """Return the decision "true" if a point is known where both sides are defined, else "undecided".

        The method is called once all entries are proven equal.
        """
        # without such a point the equation may be true of nothing

    def rely_on(self, rings: tuple[FormulaRing, ...]) -> None:
        """Store the polynomial rings of the proofs so far, and the conditions under which these proofs are valid."""
        # no divisor in these rings may be zero, so the divisors become conditions
        self.rings, self.conditions = rings, self.conditions_of(rings)

    @cached_property
    def sides(self) -> tuple[Expr, ...]:
        """The entries of the left side, then those of the right side."""
        return (*self.lefts, *self.rights)

    def search(self, *searches: Search, places: Sequence[int] | None = None) -> Counterexample | None:
        """Return the first counterexample that one of ``searches`` yields for the entries with the indices ``places``.

        Without ``places`` the first MOST_SEARCHED unproven entries are searched. The result is None if there is none.
        """
        for search in searches:
            for place in self.unproven[:MOST_SEARCHED] if places is None else places:
                entry = place_in_matrix(place, self.shape)
                witness = search(self.ring, self.lefts[place], self.rights[place], entry)
                # a point that provably violates a hypothesis refutes nothing
                if witness is not None and not self._breaks_hypothesis(witness):
                    return witness
        return None

    def _breaks_hypothesis(self, witness: Counterexample) -> bool:
        values = dict(witness.point)
        enclosures = [enclosure(hypothesis, values) for hypothesis in self.ring.hypotheses]
        return any(interval is not None and 0 not in interval for interval in enclosures)


C = TypeVar("C", bound=Case)


def first_decision(case: C, stages: Sequence[Callable[[C], Decision | None]]) -> Decision:
    """Pass an equation (``case``) through stages of decision; return the decision of the first stage that decides.

    The last stage always decides.
    """
    for stage in stages:
        decision = stage(case)
        if decision is not None:
            return decision
    raise AssertionError(f"expected a decision from the last stage, {stages[-1].__name__}, got None: a fault of symrot")


# -- stages that all cases share --------------------------------------------------------------------------------------


def subtract(case: Case) -> None:
    """Compute left - right for each entry of an equation, try to prove that it is zero, and store the results."""
    ring = case.ring
    case.residuals = [ring.difference(a, b) for a, b in zip(case.lefts, case.rights, strict=True)]
    proofs = [proof(ring, residual.numerator) for residual in case.residuals]
    case.unproven = [place for place, rings in enumerate(proofs) if rings is None]
    case.proof_rings = tuple(ring for rings in proofs if rings for ring in rings)


def prove(case: Case) -> Decision | None:
    """Return a decision if all entries of the two sides are proven equal, else None."""
    if case.unproven:
        return None
    case.rely_on(case.proof_rings)
    return case.confirmed()


def refute(case: Case) -> Decision | None:
    """Return the decision "false" if an earlier stage has stored a counterexample in ``case``, else None."""
    if case.counterexample is None:
        return None
    return Decision("false", case.conditions, counterexample=case.counterexample)


def arguments(case: Case) -> Decision | None:
    """Return a decision if both sides are proven equal once arguments of functions are in normal form, else None."""
    ring = case.ring
    try:
        # entries that earlier stages have proven equal are not tried again
        proofs = [
            proof_by_arguments(case.lefts[n], case.rights[n], ring.hypotheses, ring.domain) for n in case.unproven
        ]
    except TooLarge:
        return None
    return _by_proofs(case, proofs)


def congruence(case: Case) -> Decision | None:
    """Return a decision if both sides are proven equal once equal inverse functions are replaced by one, else None.

    For example, acos(x) is replaced by pi/2 - asin(x).
    """
    ring = case.ring
    proofs = [proof_by_congruence(case.lefts[n], case.rights[n], ring.hypotheses, ring.domain) for n in case.unproven]
    return _by_proofs(case, proofs)


def _by_proofs(case: Case, proofs: Sequence[tuple[FormulaRing, ...] | None]) -> Decision | None:
    """Return the decision if every unproven entry has a proof, otherwise None.

    ``proofs`` has an item for each unproven entry: the rings that its proof needs, or None if it has no proof.
    """
    if None in proofs:
        return None
    case.unproven = []
    case.rely_on((*case.proof_rings, *(ring for rings in proofs if rings for ring in rings)))
    return case.confirmed()


# -- sides ------------------------------------------------------------------------------------------------------------


class ShapeMismatch(InputError):
    """The exception for two sides of different shapes; ``shapes`` are (rows, columns), or None for a scalar."""

    def __init__(self, left: Shape, right: Shape) -> None:
        self.shapes = (left, right)
        super().__init__(f"expected two sides of one shape, got {shape_text(left)} = {shape_text(right)}")


def matched_sides(left: Any, right: Any) -> tuple[list[Expr], list[Expr], Shape]:
    """Return (entries of the left side, entries of the right side, common shape) of an equation.

    A scalar 0 becomes the zero matrix of the other side's shape; a 1 x 1 matrix may equal a scalar, whose shape is
    None.

    Raises
    ------
    ShapeMismatch
        If the shapes differ.
    InputError
        If a side is neither a scalar formula nor a matrix of them.
    """
    (lefts, shape), (rights, other) = flatten(left), flatten(right)
    # 0 becomes a zero matrix of any shape
    if other is None and rights == [0]:
        rights, other = [Integer(0)] * len(lefts), shape
    if shape is None and lefts == [0]:
        lefts, shape = [Integer(0)] * len(rights), other
    # a 1 x 1 matrix is equal to its entry
    if {shape, other} == {None, (1, 1)}:
        return lefts, rights, None
    if shape != other:
        raise ShapeMismatch(shape, other)
    return lefts, rights, shape


def flatten(expression: Any) -> tuple[list[Expr], Shape]:
    """Return (entries, shape) of a formula: its entries row by row, and (rows, columns), or None for a scalar.

    Raises
    ------
    InputError
        If the formula is neither a scalar nor a matrix of scalars. Text is not read as a formula.
    """
    try:
        expression = sympify(expression, strict=isinstance(expression, str))
    except SympifyError:
        raise InputError(f"expected a formula or a matrix of formulas, got {expression!r}") from None
    if isinstance(expression, MatrixExpr):
        expression = expression.as_explicit()
    if isinstance(expression, MatrixBase):
        return list(expression), (int(expression.rows), int(expression.cols))
    if not isinstance(expression, Expr):
        raise InputError(f"expected a formula or a matrix of formulas, got {expression!r}")
    return [expression], None


def place_in_matrix(number: int, shape: Shape) -> tuple[int, int] | None:
    """Return (row, column) of an entry by its ``number`` in reading order; None for a scalar.

    Entry 3 of a 3 x 3 matrix is at (2, 1).
    """
    # rows and columns are counted from 1, entries from 0
    return None if shape is None else (number // shape[1] + 1, number % shape[1] + 1)


def shape_text(shape: Shape) -> str:
    """Return a shape in words: ``a 3 x 3 matrix``, or ``a scalar`` for None."""
    return "a scalar" if shape is None else f"a {shape[0]} x {shape[1]} matrix"
