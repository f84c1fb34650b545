"""The stages by which a claim with hypotheses is proven, refuted or made conditional, in their order.

The formulas of a claim are read into a polynomial ring, in which differences are reduced to zero. The divisors of the
ring are the formulas by which a proof may divide: a proof holds where they are nonzero, so that conditions such as
``x != 0`` belong to its result.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from sympy import Expr, Ge, Gt, Ne
from sympy.polys.rings import PolyElement

from symrot.checker.decide.conditions import branch_requirements, requirements
from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.equation import Equation, stated_needs
from symrot.checker.decide.hypotheses import Hypotheses
from symrot.checker.decide.ranges.text import follow, range_text, with_domain
from symrot.checker.decide.real_points import ATTEMPTS
from symrot.checker.decide.squares_of_roots import is_square_of_roots
from symrot.exact.counterexample import closed_form_witness, rational_witness
from symrot.exact.decide import normal_form
from symrot.exact.decision import Case, Decision, Search, arguments, congruence, prove, refute, subtract
from symrot.exact.domain import domain
from symrot.exact.domain.needs import Need, needs_of
from symrot.exact.evidence import Counterexample, Requirement
from symrot.exact.intervals import is_nonnegative_at
from symrot.exact.inverse_sums import lifts, principal
from symrot.exact.limits.size import pieces
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero
from symrot.exact.ring.roots import written

__all__ = ["STAGES", "ClaimCase", "domain_of_text", "leave_open", "nearby_witness"]

MUCH_LARGER = 5
"""If one of two formulas has more than this many times the symbols and operations of the other, the other one is taken
as the shorter formula. The lengths of their texts are then not compared."""

MOST_PIECES = 60
"""A sum that must be nonzero is simplified only if it has fewer symbols and operations than this. The simplified sum
may show that the condition always holds, or that another condition implies it."""

MOST_LETTERS_OF_CONDITION = 80
"""A condition on signs whose text has more characters than this is replaced by an equivalent range, such as
``-pi/2 <= asin(x) + asin(y) <= pi/2``, if one is known."""


@dataclass
class ClaimCase(Case):
    """The state of a running decision on a claim: the equation and the evidence so far.

    Attributes
    ----------
    equation : Equation
    nonzero_factors : set of int
        Indices of those divisors of ``ring`` that a hypothesis states to be nonzero.
    numerators : list of PolyElement
        The numerators of left - right, reduced by the hypotheses, one for each entry of a matrix equation for which
        equality is not proven.
    branches : list of Requirement or None
        Conditions on signs under which the claim is true; empty if none is needed, None if none is known.
    """

    equation: Equation = field(kw_only=True)
    nonzero_factors: set[int] = field(default_factory=set)
    numerators: list[PolyElement] = field(default_factory=list)
    branches: list[Requirement] | None = None

    @cached_property
    def hypotheses(self) -> Hypotheses:
        """The claim's hypotheses, together with the conditions under which both sides are real numbers."""
        # computed once: read both sides into the ring first, since later divisors are not in it
        return Hypotheses(self.ring, _needs(self))

    @property
    def lacks_evidence(self) -> bool:
        """Whether the search for a counterexample must go on."""
        # known conditions on the signs of roots end the search; under hypotheses it goes on, since they ignore these
        return self.counterexample is None and (bool(self.ring.hypotheses) or self.branches is None)

    def within_domain(self, search: Search) -> Search:
        """Return a search for counterexamples that drops points at which a side, as it is written, has no value."""

        def searched(
            ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None
        ) -> Counterexample | None:
            witness = search(ring, left, right, entry)
            values = dict(witness.point) if witness else {}
            # a divisor that SymPy has cancelled may be zero there
            return witness if all(is_nonnegative_at(formula, values) for formula in ring.domain) else None

        return searched if self.ring.domain else search

    def conditions_of(self, rings: Sequence[FormulaRing]) -> tuple[Any, ...]:
        """Return the conditions that a proof in ``rings`` needs, such as ``x != 0``."""
        # conditions that are hypotheses of the claim are granted
        ring, granted = self.ring, self.nonzero_factors
        forms = [*domain.divisors(ring, granted), *(pair for other in rings for pair in domain.divisors(other))]
        free = set(domain.divisors(ring)) - set(domain.divisors(ring, granted))
        shorter = [_shorter(*pair) for pair in forms if pair not in free]
        nonzero = _independent({as_text(form): form for form in shorter})
        bases = [base for base in (*self.equation.radicands, *domain.radicands(ring)) if not surely_nonnegative(base)]
        bases = [base for base in bases if not is_square_of_roots(base, [other for other in bases if other != base])]
        nonnegative = {as_text(base): base for base in bases}
        relations = {f"{text} != 0": Ne(form, 0, evaluate=False) for text, form in nonzero.items()
                     if text not in nonnegative}  # fmt: skip
        for text, base in nonnegative.items():
            sign, relation = (">", Gt) if text in nonzero else (">=", Ge)
            relations[f"{text} {sign} 0"] = relation(base, 0, evaluate=False)
        return tuple(relations[text] for text in sorted(relations))

    def confirmed(self) -> Decision:
        rings = (self.ring, *self.rings)
        divided = [Need(source, "!= 0") for ring in rings for source, _ in domain.divisors(ring)]
        divided += [Need(formula, ">= 0") for ring in rings for formula in domain.split_radicands(ring)]
        if self.hypotheses.point_is_known([need for need in divided if need not in self.hypotheses.needs]):
            return Decision("true", self.conditions)
        hypotheses = " and the hypotheses hold" if self.ring.hypotheses else ""
        reason = f"the sides are equal, but no point is known at which both are real numbers{hypotheses}"
        return Decision("undecided", self.conditions, reason=reason)

    def can_hold(self, requirement: Requirement) -> bool:
        """Return whether a point is known at which ``requirement`` holds and both sides of the claim are real."""
        # a condition that holds nowhere is not offered
        signs = [Need(value, ">= 0") for value in (*requirement.signs, *domain.split_radicands(self.ring))]
        if not self.hypotheses.consistent_with(requirement.zeros):
            return False
        return self.hypotheses.point_is_known([*needs_of(requirement.signs), *signs], requirement.zeros)


def nonzero_by_hypothesis(case: ClaimCase) -> None:
    """Add the formulas that hypotheses state to be nonzero to the divisors of the ring: a proof may divide by them."""
    for formula in case.equation.nonzero:
        case.ring.ratios.invert(case.ring.ratio(formula), formula)
    # this is the first stage: the ring has no other divisors yet
    case.nonzero_factors = set(range(len(case.ring.ratios.factors)))


def domain_of_text(case: ClaimCase) -> None:
    """Add all divisors in the claim's text, such as x in ``1/x``, to the divisors of ``case.ring``.

    A proof may then divide by them, and has the condition that they are nonzero. Raise InputError if it is proven that
    no values of the letters make both sides real, or satisfy a hypothesis.
    """
    for divisor in case.equation.divisors:
        case.ring.ratios.invert(case.ring.ratio(divisor), divisor)
    case.hypotheses.refuse_if_nowhere()


def nearby_witness(case: ClaimCase) -> None:
    """Search for a counterexample among simple points, and store it in ``case``.

    The search tries rational points, then a few points that obey the hypotheses. For a claim without hypotheses, it
    tries rational points, then points in closed form, such as pi/6.

    This stage also stores ``case.numerators`` for the stages after it: the numerators of left - right for the entries
    that are not yet proven equal.
    """
    ring, hypotheses = case.ring, case.hypotheses
    case.numerators = [ring.reduce(case.residuals[place].numerator) for place in case.unproven]
    closed_form = hypotheses.checked(closed_form_witness)
    nearest = case.within_domain(hypotheses.near_witness) if ring.hypotheses else closed_form
    case.counterexample = case.search(rational_witness, nearest)


def branch(case: ClaimCase) -> Decision | None:
    """Return the decision "true" if a claim holds for certain signs of formulas, and its text implies these signs.

    ``sqrt(x**2)*sqrt(x) == x*sqrt(x)`` holds for x >= 0, which its sqrt(x) implies. Return "undecided" instead if no
    point is known at which both sides are real numbers, and None if the text does not imply the signs.
    """
    case.branches, rings = _branches(case.ring, case.numerators)
    case.rely_on((*case.proof_rings, *rings))
    if case.branches is None:
        return None
    known = [(formula, ">= 0") for formula in (*case.equation.radicands, *domain.signs(case.ring))]
    known += [(formula, "!= 0") for formula in case.equation.divisors]
    # sqrt(x**2) == x needs x >= 0, which a sqrt(x) elsewhere in the claim implies
    signs = [sign for requirement in case.branches for sign in requirement.conditions]
    return case.confirmed() if follow(signs, known) else None


def entail(case: ClaimCase) -> Decision | None:
    """Return "true" for a claim that follows from its hypotheses, or "undecided" if no point is known where these hold
    and both sides are real numbers; None for other claims.

    Raise InputError if the hypotheses hold at no real point.
    """
    if not case.lacks_evidence:
        return None
    if case.hypotheses.entails(case.numerators):
        return case.confirmed()
    case.hypotheses.refuse_if_empty()
    return None


def distant_witness(case: ClaimCase) -> None:
    """Search for a counterexample among many random points that obey the hypotheses, and store it in ``case``."""
    if case.lacks_evidence:
        # points in closed form first: a random point with roots of several numbers takes a second
        searches = [case.hypotheses.checked(closed_form_witness)] if case.ring.hypotheses else []
        case.counterexample = case.search(*searches, case.within_domain(case.hypotheses.witness))


def condition(case: ClaimCase) -> Decision | None:
    """Return "conditional" for a claim that is true under a condition that authors often omit; otherwise None.

    Return "undecided" instead if no point is known at which the condition fails: the claim may then hold everywhere.
    """
    sides = [(case.lefts[place], case.rights[place]) for place in case.unproven]
    needed = requirements(case.ring, case.numerators, sides, len(case.lefts))
    needed = [requirement for requirement in needed if case.can_hold(requirement)]
    if case.branches and not needed and case.can_hold(case.branches[0]):
        needed = case.branches
    if not needed:
        return None
    if not case.counterexample:  # it may hold everywhere
        conditions = " and ".join(requirement.text for requirement in needed)
        reason = f"the claim is true where {conditions}, and no point is known where this condition fails"
        return Decision("undecided", case.conditions, reason=reason)
    if len(needed) == 1:
        needed = [with_domain(needed[0], case.conditions)]
    return Decision("conditional", (*needed, *case.conditions), tuple(needed), case.counterexample)


def leave_open(case: ClaimCase) -> Decision:
    """Return the decision "undecided" with the reason why no stage decided the claim."""
    return Decision("undecided", case.conditions, reason=_obstacle(case.ring))


STAGES = (
    nonzero_by_hypothesis, subtract, domain_of_text, prove, arguments, nearby_witness, branch, entail, distant_witness,
    condition, refute, congruence, leave_open,
)  # fmt: skip


def _needs(case: ClaimCase) -> list[Need]:
    """Return the conditions under which a claim's sides and hypotheses, as typed, are real numbers: x != 0 for
    ``x/x``.
    """
    equation = case.equation
    hypotheses = [as_zero(relation) for relation in equation.hypotheses]
    # the text may have divisors and roots that SymPy has cancelled: x/x needs x != 0
    stated = stated_needs(equation)
    return [*needs_of([*case.sides, *hypotheses, *(need.formula for need in stated)]), *stated]


def _independent(nonzero: Mapping[str, Expr]) -> dict[str, Expr]:
    """Return ``nonzero`` without the formulas that are never zero and those that another formula implies.

    ``nonzero`` maps texts to formulas that must not be zero. If it has x, the formula x**2 is left out.
    """
    remaining = {}
    for text, form in nonzero.items():
        value = normal_form(form) if form.is_Add and pieces([form]) < MOST_PIECES else form
        base, _ = value.as_base_exp()
        # sin(a)**2 + cos(a)**2 never vanishes, and cos(b)**2*(sin(a)**2 + cos(a)**2) follows from cos(b)
        if not (value.is_number and value != 0) and (base == form or as_text(base) not in nonzero):
            remaining[text] = form
    return remaining


def _shorter(first: Expr, second: Expr) -> Expr:
    """Return the formula with the shorter text, of two formulas for the same divisor.

    If one formula has more than MUCH_LARGER times as many symbols and operations, the other is returned, whatever its
    text.
    """
    few, many = sorted((first, second), key=lambda formula: pieces([formula]))
    if pieces([many]) > MUCH_LARGER * pieces([few]):
        # a much larger formula is not even written as text
        return few
    return min(first, second, key=lambda formula: len(written(formula)))


def _branches(
    ring: FormulaRing, numerators: Sequence[PolyElement]
) -> tuple[list[Requirement] | None, tuple[FormulaRing, ...]]:
    """Return (conditions, rings): the conditions on signs that make a claim true, and further rings for the proof.

    An example of a condition is ``x >= 0``. The conditions are [] if none is needed, and None if none is known. A
    further ring is ``ring`` with more generators, for example the angle of an arcsine. The claim then needs the
    condition that the divisors of the further ring are nonzero too.
    """
    try:
        branches = branch_requirements(ring, numerators) if ring.roots else None
    except TooLarge:
        return None, ()
    if branches is None and len(numerators) == 1:
        for lift in lifts(ring, numerators[0]):
            branches = branch_requirements(lift.ring, [poly for poly in lift.numerators if poly])
            if branches is not None:
                within = _within_range(ring, numerators[0]) if any(map(_is_long, branches)) else None
                # -pi/2 <= asin(x) + asin(y) <= pi/2 in place of the signs of long sums
                return within if within is not None and not any(map(_is_long, within[0])) else (branches, (lift.ring,))
        within = _within_range(ring, numerators[0])
        if within is not None:
            return within
    return branches, ()


def _is_long(requirement: Requirement) -> bool:
    return len(requirement.text) > MOST_LETTERS_OF_CONDITION


def _within_range(
    ring: FormulaRing, numerator: PolyElement
) -> tuple[list[Requirement], tuple[FormulaRing, ...]] | None:
    """Return ([condition], rings) for a claim with inverse functions that is true in a range of values.

    The condition states the range, such as ``-pi/2 <= asin(x) + asin(y) <= pi/2``; the proof uses the rings. The list
    is empty if the claim is true without a condition. Return None if no such range is known.
    """
    within = principal(ring, numerator)
    if within is None:
        return None
    ends = [(end, ">= 0") for end in within.nonnegative if not surely_nonnegative(end)]
    ends += [(end, "> 0") for end in within.positive if not end.is_positive]
    text, signs = range_text(ends), tuple(end for end, _ in ends)
    required = Requirement("principal_value", text, signs=signs, strict=within.positive)
    # no condition is needed if the text is empty
    return [required] if text else [], within.rings


def _obstacle(ring: FormulaRing) -> str:
    """Return a sentence with the reason why a claim could not be decided."""
    if ring.outside_scope:
        named = ring.outside_scope[:3]
        terms = ", ".join(f"functions of {as_text(term)}" if term.is_Rational else as_text(term) for term in named)
        return f"symrot knows too little about {terms}, and no point was found where the sides provably differ"
    if ring.roots:
        roots = ", ".join(as_text(root.expression) for root in list(ring.roots)[:3])
        return (
            f"whether the sides are equal depends on the sign of {roots}, "
            "and no point was found where they provably differ"
        )
    if ring.hypotheses:
        return f"none of {ATTEMPTS} random points obeys the hypotheses and shows a difference, and no proof was found"
    return (
        "no proof was found, and no rational point where the sides differ: an angle contains symbols that occur "
        "elsewhere too, so that its sine and cosine cannot be chosen freely"
    )
