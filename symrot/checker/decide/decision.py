"""The decision on a claim: the stages of :mod:`symrot.exact.decision`, and further stages that only claims need.

A claim may have hypotheses, and its text may have divisors and roots that SymPy has cancelled. The further stages use
these, and look for a condition under which a false claim is true.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

from sympy import Abs, Expr, Ge, Gt, I, Ne, Poly, Symbol, fraction, nan, oo, preorder_traversal, zoo
from sympy.polys.rings import PolyElement

from symrot.checker.decide.branch_cuts import BranchCut, branch_cuts
from symrot.checker.decide.conditions import branch_requirements, requirements
from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.hypotheses import Hypotheses
from symrot.checker.decide.large_powers import LARGEST_DEGREE, degree_of, point_of_difference, shorter_powers
from symrot.checker.decide.ranges import follow, positive_symbols, range_text, with_domain
from symrot.checker.decide.real_points import ATTEMPTS
from symrot.checker.decide.squares_of_roots import is_square_of_roots
from symrot.checker.decide.unordered import is_unordered
from symrot.errors import InputError
from symrot.exact.counterexample import closed_form_witness, rational_witness
from symrot.exact.decide import normal_form
from symrot.exact.decision import (
    Case,
    Decision,
    Search,
    Shape,
    ShapeMismatch,
    arguments,
    congruence,
    first_decision,
    flatten,
    matched_sides,
    prove,
    refute,
    shape_text,
    subtract,
)
from symrot.exact.domain import domain
from symrot.exact.domain.known_points import known_point
from symrot.exact.domain.needs import Need, leaves_of, needs_of
from symrot.exact.evidence import Counterexample, Requirement
from symrot.exact.intervals import is_nonnegative_at
from symrot.exact.inverse_sums import lifts, principal
from symrot.exact.limits.budget import one_decision
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import MOST_PRODUCTS, TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero
from symrot.exact.ring.roots import is_positive_where_defined, written

__all__ = ["Equation", "decide_equation", "for_positive_bases", "is_large"]

MUCH_LARGER = 5
"""The ratio of sizes from which on the larger formula certainly has the longer text."""

LONG_SUM = 5
"""The fewest terms of a sum inside a function for which a letter is tried."""


@dataclass(frozen=True)
class Equation:
    """An equation to be decided, with its hypotheses and with the divisors and roots that its text has.

    Attributes
    ----------
    left, right : Expr or Matrix
    hypotheses : tuple
        Equations, or expressions that are zero.
    divisors : tuple of Expr
        Formulas that the text divides by, or takes logarithms of; SymPy may have cancelled them.
    nonzero : tuple of Expr
        Formulas that hypotheses state to be nonzero.
    radicands : tuple of Expr
        Formulas that must not be negative, such as those under roots of the text.
    bases : tuple of Expr
        Bases of powers whose exponents are not numbers; these bases are assumed to be positive.
    """

    left: Any
    right: Any
    hypotheses: tuple[Any, ...] = ()
    divisors: tuple[Expr, ...] = ()
    nonzero: tuple[Expr, ...] = ()
    radicands: tuple[Expr, ...] = ()
    bases: tuple[Expr, ...] = ()

    def at(self, values: Mapping[Expr, Expr]) -> "Equation":
        """Return the equation with values in place of some of its parts."""
        parts = {field.name: getattr(self, field.name) for field in fields(self)}
        return Equation(**{
            name: tuple(each.xreplace(values) for each in part) if isinstance(part, tuple) else part.xreplace(values)
            for name, part in parts.items()
        })  # fmt: skip


def is_large(equation: Equation) -> bool:
    """Return whether a side of an equation is too large to be expanded; then no repairs are sought either."""
    return degree_of([*flatten(equation.left)[0], *flatten(equation.right)[0]]) > LARGEST_DEGREE


def decide_equation(equation: Equation) -> Decision:
    """Return the decision on an equation with hypotheses: true, false, conditional or undecided.

    Raises
    ------
    InputError
        If the shapes differ, a side is not a finite exact formula or divides by a formula that is zero everywhere, the
        hypotheses contradict each other, or a degree above ``LARGEST_DEGREE`` rules out the expansion that is needed.
    """
    try:
        with one_decision():
            decision = _decide(equation)
            if decision.verdict == "undecided":
                decision = _with_positive_symbols(equation, decision)
            if decision.verdict == "undecided":
                decision = _with_letters_for_sums(equation, decision)
        return _without_needless(decision, equation) if decision.verdict == "conditional" else decision
    except RecursionError:
        return Decision("undecided", reason="the formulas are nested too deeply to be read")
    except (TypeError, AttributeError) as reason:
        if is_unordered(reason):
            return Decision("undecided", reason="two numbers in the claim are too close to tell which is larger")
        raise


def _with_letters_for_sums(equation: Equation, decision: Decision) -> Decision:
    """Return "true" if an equation is proven, without conditions, for letters in place of long sums in its functions;
    otherwise ``decision``.
    """
    # sin(a + b + .. + m)**2 + cos(a + b + .. + m)**2 == 1 is too long to be expanded
    if equation.hypotheses or equation.divisors or equation.radicands or equation.bases:
        return decision
    entries = [*flatten(equation.left)[0], *flatten(equation.right)[0]]
    functions = {node for entry in entries for node in preorder_traversal(entry) if node.is_Function}
    sums = {argument for node in functions for argument in node.args if len(argument.args) >= LONG_SUM}
    letters = {
        argument: Symbol(f"sum_{place}", real=True)
        for place, argument in enumerate(sorted(sums, key=str))
        if argument.is_Add and argument.is_real
    }
    if not letters:
        return decision
    try:
        shorter = _decide(Equation(*(side.xreplace(letters) for side in (equation.left, equation.right))))
    except InputError:
        return decision
    return shorter if shorter.verdict == "true" and not shorter.conditions else decision


def _with_positive_symbols(equation: Equation, decision: Decision) -> Decision:
    """Return "true" if an equation is proven for symbols with the signs that its conditions require; otherwise
    ``decision``.
    """
    known = positive_symbols(decision.conditions)
    if not known or equation.hypotheses:
        return decision
    # in asech(x) == acosh(1/x) the left side needs x > 0, so that abs(x) is x
    left, right = (side.xreplace(known) for side in (equation.left, equation.right))
    divisors, nonzero, radicands = (
        tuple(formula.xreplace(known) for formula in formulas)
        for formulas in (equation.divisors, equation.nonzero, equation.radicands)
    )
    try:
        signed = _decide(Equation(left, right, (), divisors, nonzero, radicands))
    except InputError:  # the signs exclude all points
        return decision
    if signed.verdict != "true":
        return decision
    symbols = {other: symbol for symbol, other in known.items()}
    conditions = [condition.xreplace(symbols) for condition in signed.conditions]
    return replace(signed, conditions=tuple(dict.fromkeys([*decision.conditions, *conditions])))


def _without_needless(decision: Decision, equation: Equation) -> Decision:
    """Return ``decision`` with conditions that do not divide by y, if the equation is true for ``y = 0`` too."""
    # the proof of sqrt(x**2*y**2) == x*y gives the condition x/abs(y) >= 0, which becomes x >= 0
    return replace(decision, conditions=tuple(_without_divisor(each, equation) for each in decision.conditions))


def _without_divisor(condition: Any, equation: Equation) -> Any:
    """Return x for a ``condition`` on ``x/abs(y)`` if the equation is true for y = 0; otherwise ``condition``."""
    if not isinstance(condition, Requirement) or condition.strict or equation.hypotheses:
        return condition
    signs = []
    for value in condition.signs:
        above, below = fraction(value)
        is_free = isinstance(below, Abs) and _is_true_at_zeros(below.args[0], equation)
        signs.append(above if is_free else value)
    return replace(condition, signs=tuple(signs))


def _is_true_at_zeros(formula: Expr, equation: Equation) -> bool:
    """Return whether an equation is proven to be true at every zero of ``formula``, a polynomial in one symbol.

    False if ``formula`` is no such polynomial.
    """
    symbol = next(iter(formula.free_symbols))
    if formula.free_symbols != {symbol} or not formula.is_polynomial(symbol):
        return False
    # at an irrational zero nothing is proven
    zeros = Poly(formula, symbol).real_roots()
    return all(zero.is_Rational and _is_true_at({symbol: zero}, equation) for zero in zeros)


def _is_true_at(point: dict[Expr, Expr], equation: Equation) -> bool:
    """Return whether both sides of an equation are defined and equal at a point, given by the values of symbols."""
    divisors, radicands = (
        tuple(formula.subs(point) for formula in formulas) for formulas in (equation.divisors, equation.radicands)
    )
    left, right = (side.subs(point) for side in (equation.left, equation.right))
    undefined = any(entry.has(zoo, nan, oo) for side in (left, right) for entry in flatten(side)[0])
    if undefined or 0 in divisors or equation.nonzero:
        return False
    try:
        decision = decide_equation(Equation(left, right, (), divisors, (), radicands))
    except InputError:
        return False
    return decision.verdict == "true" and not decision.conditions


def _decide(equation: Equation) -> Decision:
    lefts, rights, shape = _sides(equation)
    relations = [as_zero(relation) for relation in equation.hypotheses]
    formulas = [*lefts, *rights, *relations, *equation.divisors, *equation.radicands]
    for formula in formulas:
        if formula.has(I):
            raise InputError(f"expected real numbers, got the square root of a negative number in {as_text(formula)}")
    size = degree_of(formulas)
    if size > LARGEST_DEGREE:
        return _decide_large(equation, lefts, rights, size)
    try:
        ring = FormulaRing([*lefts, *rights, *equation.divisors, *equation.nonzero], relations, equation.radicands)
    except TooLarge as reason:
        return Decision("undecided", reason=str(reason), products=MOST_PRODUCTS)
    case = _ClaimCase(lefts, rights, shape, ring, equation=equation)
    try:
        decision = first_decision(case, STAGES)
        if decision.verdict in ("true", "conditional"):
            decision = _off_branch_cuts(decision, equation)
        return replace(decision, products=ring.ratios.products)
    except TooLarge as reason:
        try:
            places = range(len(lefts))
            witness = case.search(case.within_domain(rational_witness), closed_form_witness, places=places)
        except TooLarge:
            witness = None
        if witness:
            return Decision("false", counterexample=witness, products=MOST_PRODUCTS)
        undecided = Decision("undecided", reason=str(reason), products=MOST_PRODUCTS)
        return _with_shorter_powers(equation, lefts, rights) or undecided


@dataclass
class _ClaimCase(Case):
    """The state of a running decision on a claim: the equation and the evidence so far.

    Attributes
    ----------
    equation : Equation
    nonzero_factors : set of int
        Indices of the ring's divisors that a hypothesis states to be nonzero.
    numerators : list of PolyElement
        The numerators of left - right for the unproven entries, reduced by the hypotheses.
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
        """Whether no counterexample is known, and the search for one must go on."""
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
        """Return whether a point is known at which a condition holds and both sides are real numbers."""
        # a condition that holds nowhere is not offered
        signs = [Need(value, ">= 0") for value in (*requirement.signs, *domain.split_radicands(self.ring))]
        if not self.hypotheses.consistent_with(requirement.zeros):
            return False
        return self.hypotheses.point_is_known([*needs_of(requirement.signs), *signs], requirement.zeros)


# -- the stages -------------------------------------------------------------------------------------------------------


def nonzero_by_hypothesis(case: _ClaimCase) -> None:
    """Add the formulas that hypotheses state to be nonzero to the ring, so that proofs may divide by them."""
    for formula in case.equation.nonzero:
        case.ring.ratios.invert(case.ring.ratio(formula), formula)
    # this is the first stage: the ring has no other divisors yet
    case.nonzero_factors = set(range(len(case.ring.ratios.factors)))


def domain_of_text(case: _ClaimCase) -> None:
    """Add the divisors of a claim's text to the ring; InputError if the sides are provably real nowhere."""
    # the proof must not lose the condition that they are nonzero
    for divisor in case.equation.divisors:
        case.ring.ratios.invert(case.ring.ratio(divisor), divisor)
    case.hypotheses.refuse_if_nowhere()


def nearby_witness(case: _ClaimCase) -> None:
    """Search rational points, or a few points that obey the hypotheses, for a counterexample; store it in ``case``."""
    ring, hypotheses = case.ring, case.hypotheses
    case.numerators = [ring.reduce(case.residuals[place].numerator) for place in case.unproven]
    closed_form = hypotheses.checked(closed_form_witness)
    nearest = case.within_domain(hypotheses.near_witness) if ring.hypotheses else closed_form
    case.counterexample = case.search(rational_witness, nearest)


def branch(case: _ClaimCase) -> Decision | None:
    """Return "true" if a claim's text implies the signs that it needs, as sqrt(x) does for ``sqrt(x**2) == x``; or
    None.
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


def entail(case: _ClaimCase) -> Decision | None:
    """Return "true" for a claim that follows from its hypotheses, else None.

    Raise InputError if the hypotheses hold at no real point.
    """
    if not case.lacks_evidence:
        return None
    if case.hypotheses.entails(case.numerators):
        return case.confirmed()
    case.hypotheses.refuse_if_empty()
    return None


def distant_witness(case: _ClaimCase) -> None:
    """Search for a counterexample among many random points that obey the hypotheses, and store it in ``case``."""
    if case.lacks_evidence:
        searches = [case.within_domain(case.hypotheses.witness)]
        searches += [case.hypotheses.checked(closed_form_witness)] if case.ring.hypotheses else []
        case.counterexample = case.search(*searches)


def condition(case: _ClaimCase) -> Decision | None:
    """Return "conditional" for a claim that is true under a condition that authors often omit, "undecided" if no point
    is known where the condition fails; otherwise None.
    """
    sides = [(case.lefts[place], case.rights[place]) for place in case.unproven]
    needed = requirements(case.ring, case.numerators, sides, len(case.lefts))
    needed = [requirement for requirement in needed if case.can_hold(requirement)]
    if case.branches and not needed and case.can_hold(case.branches[0]):
        if not case.counterexample:  # it may hold everywhere
            signs = " and ".join(requirement.text for requirement in case.branches)
            reason = f"it is true where {signs}, and no point is known where that fails"
            return Decision("undecided", case.conditions, reason=reason)
        needed = case.branches
    if not needed:
        return None
    if len(needed) == 1:
        needed = [with_domain(needed[0], case.conditions)]
    return Decision("conditional", (*needed, *case.conditions), tuple(needed), case.counterexample)


def leave_open(case: _ClaimCase) -> Decision:
    """Return the decision "undecided" with the reason why no stage decided the claim."""
    return Decision("undecided", case.conditions, reason=_obstacle(case.ring))


STAGES = (
    nonzero_by_hypothesis, subtract, domain_of_text, prove, arguments, nearby_witness, branch, entail, distant_witness,
    condition, refute, congruence, leave_open,
)  # fmt: skip


def for_positive_bases(decision: Decision, equation: Equation) -> Decision:
    """Return ``decision``, with "conditional" for "true" if it assumes a > 0 for a power ``a**b``."""
    # of powers with letters in their exponents
    bases = [base for base in equation.bases if leaves_of([base]) and not is_positive_where_defined(base)]
    if not bases or decision.verdict != "true":
        return decision
    text = range_text([(base, "> 0") for base in bases])
    if not text:  # each base is proven to be positive
        return decision
    # for a whole number b the power has a value for a negative a too, about which nothing is proven
    required = Requirement("positive_base", text, signs=tuple(bases), strict=tuple(bases))
    return replace(decision, verdict="conditional", requires=(required,), conditions=(required, *decision.conditions))


# -- the branch cuts of atan2 -----------------------------------------------------------------------------------------


def _off_branch_cuts(decision: Decision, equation: Equation) -> Decision:
    """Return ``decision``, "true" or "conditional", with the condition that no atan2 is on a branch cut on which the
    sides are known to differ.
    """
    usual = decision.requires or (Requirement("principal_value", ""),)
    requirements, witness = usual, decision.counterexample
    for cut in branch_cuts([*flatten(equation.left)[0], *flatten(equation.right)[0]]):
        on_cut = equation.at(cut.values)
        on_cut = replace(
            on_cut, divisors=(*on_cut.divisors, cut.negative), radicands=(*on_cut.radicands, -cut.negative)
        )
        others = []
        for requirement in requirements:
            difference = _difference(cut, on_cut, requirement)
            if difference is not None:
                witness = witness or difference
                text = f"({cut.elsewhere})" if requirement.text else cut.elsewhere
                requirement = replace(requirement, text=" and ".join(filter(None, (requirement.text, text))))
            others.append(requirement)
        requirements = tuple(others)
    if requirements == usual:
        return decision
    conditions = [each for each in decision.conditions if each not in decision.requires]
    return replace(
        decision, verdict="conditional", requires=requirements, conditions=(*requirements, *conditions),
        counterexample=witness,
    )  # fmt: skip


def _difference(cut: BranchCut, equation: Equation, requirement: Requirement) -> Counterexample | None:
    """Return a point on a branch cut at which a requirement holds and the sides of an equation are known to differ, or
    None.
    """
    required = replace(
        equation, hypotheses=(*equation.hypotheses, *requirement.zeros),
        divisors=(*equation.divisors, *requirement.strict), radicands=(*equation.radicands, *requirement.signs),
    )  # fmt: skip
    for solution in cut.solutions or [{}]:
        positive = [value for symbol, value in solution.items() if symbol.is_positive]
        at_zero = required.at(solution)
        at_zero = replace(
            at_zero, hypotheses=at_zero.hypotheses if solution else (*at_zero.hypotheses, cut.zero),
            divisors=(*at_zero.divisors, *positive), radicands=(*at_zero.radicands, *positive),
        )  # fmt: skip
        try:
            lefts, rights, shape = _sides(at_zero)
            relations = [as_zero(relation) for relation in at_zero.hypotheses]
            ring = FormulaRing([*lefts, *rights, *at_zero.divisors, *at_zero.nonzero], relations, at_zero.radicands)
            case = _ClaimCase(lefts, rights, shape, ring, equation=at_zero)
            first_decision(case, (*STAGES[:2], domain_of_text, nearby_witness, leave_open))
        except (InputError, TooLarge):  # the hypotheses exclude all points of the cut
            continue
        if case.counterexample is not None:
            point = dict(case.counterexample.point)
            point |= {symbol: value.subs(point) for symbol, value in solution.items()}
            return replace(case.counterexample, point=tuple(sorted(point.items(), key=str)))
    return None


# -- reading the equation ---------------------------------------------------------------------------------------------


def _sides(equation: Equation) -> tuple[list[Expr], list[Expr], Shape]:
    try:
        return matched_sides(equation.left, equation.right)
    except ShapeMismatch as mismatch:
        left, right = map(shape_text, mismatch.shapes)
        loose = isinstance(equation.left, Symbol) or isinstance(equation.right, Symbol)
        hint = " (a name that nothing defines is a scalar; `symrot identify` says what a matrix is)" if loose else ""
        raise InputError(f"expected two sides of the same shape, got {left} == {right}{hint}") from None


def _needs(case: _ClaimCase) -> list[Need]:
    """Return the conditions under which a claim's sides and hypotheses, as typed, are real numbers: x != 0 for
    ``x/x``.
    """
    equation = case.equation
    hypotheses = [as_zero(relation) for relation in equation.hypotheses]
    # the text may have divisors and roots that SymPy has cancelled: x/x needs x != 0
    stated = _stated_needs(equation)
    return [*needs_of([*case.sides, *hypotheses, *(need.formula for need in stated)]), *stated]


def _stated_needs(equation: Equation) -> list[Need]:
    """Return the conditions that divisors in a claim's text are nonzero, and formulas under its roots nonnegative."""
    stated = [Need(divisor, "!= 0") for divisor in (*equation.divisors, *equation.nonzero)]
    divided = {*equation.divisors, *equation.nonzero}  # the argument of a logarithm is recorded as both
    return [
        *stated,
        *(Need(radicand, "> 0" if radicand in divided else ">= 0") for radicand in equation.radicands),
    ]


def _decide_large(equation: Equation, lefts: Sequence[Expr], rights: Sequence[Expr], size: int) -> Decision:
    """Return the decision on an equation whose powers are too large to be expanded, such as ``(a - x)**6000``.

    Raises
    ------
    InputError
        If it can neither be proven with letters in place of the powers, nor refuted at a point.
    """
    refusal = InputError(f"expected a formula of degree up to {LARGEST_DEGREE} in symbols and sines, got about {size}")
    if equation.hypotheses or len(lefts) > 1:
        raise refusal
    proof = _with_shorter_powers(equation, lefts, rights)
    if proof is not None:
        return proof
    witness = point_of_difference(lefts[0], rights[0], _stated_needs(equation))
    if witness is None:
        raise refusal
    return Decision("false", counterexample=witness)


def _with_shorter_powers(equation: Equation, lefts: Sequence[Expr], rights: Sequence[Expr]) -> Decision | None:
    """Return the decision "true" if an equation holds with letters in place of its large powers, or None."""
    if equation.hypotheses or len(lefts) > 1:
        return None
    formulas = [lefts[0], rights[0], *equation.divisors, *equation.radicands]
    shorter = shorter_powers(formulas)
    if shorter is not None and degree_of(shorter.formulas) <= LARGEST_DEGREE:
        left, right, *others = shorter.formulas
        divided = len(equation.divisors)
        other = replace(
            equation, left=left, right=right, divisors=tuple(others[:divided]), radicands=tuple(others[divided:])
        )
        decision = _decide(other)
        needs = [*_stated_needs(equation), *needs_of(formulas)]
        if decision.verdict == "true" and known_point(needs) is not None:
            conditions = tuple(
                each.func(each.lhs.xreplace(shorter.bases), 0, evaluate=False) for each in decision.conditions
            )
            return replace(decision, conditions=conditions)
    return None


# -- conditions and reasons -------------------------------------------------------------------------------------------


def _independent(nonzero: Mapping[str, Expr]) -> dict[str, Expr]:
    """Return ``nonzero``, a map of texts to formulas that must not be zero, without those implied by others: x**2
    beside x.
    """
    remaining = {}
    for text, form in nonzero.items():
        value = normal_form(form) if form.is_Add and _pieces(form) < MOST_PIECES else form
        base, _ = value.as_base_exp()
        # sin(a)**2 + cos(a)**2 never vanishes, and cos(b)**2*(sin(a)**2 + cos(a)**2) follows from cos(b)
        if not (value.is_number and value != 0) and (base == form or as_text(base) not in nonzero):
            remaining[text] = form
    return remaining


MOST_PIECES = 60
"""The most symbols and operations of a condition that is compared with the others."""


def _shorter(first: Expr, second: Expr) -> Expr:
    """Return the more readable one of two formulas for the same divisor."""
    few, many = sorted((first, second), key=_pieces)
    if _pieces(many) > MUCH_LARGER * _pieces(few):
        # a much larger formula is not even written as text
        return few
    return min(first, second, key=lambda formula: len(written(formula)))


def _pieces(formula: Expr) -> int:
    return sum(1 for _ in preorder_traversal(formula))


def _branches(
    ring: FormulaRing, numerators: Sequence[PolyElement]
) -> tuple[list[Requirement] | None, tuple[FormulaRing, ...]]:
    """Return signs that make a claim true, such as ``x >= 0``, or None, and the larger rings in which that was
    proven.
    """
    try:
        branches = branch_requirements(ring, numerators) if ring.roots else None
    except TooLarge:
        return None, ()
    if branches is None and len(numerators) == 1:
        # a proof may need a larger ring, for example with the angle of an arcsine; its divisors become conditions too
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


MOST_LETTERS_OF_CONDITION = 80
"""The most characters of a condition on signs, if the range of an inverse function says the same."""


def _is_long(requirement: Requirement) -> bool:
    return len(requirement.text) > MOST_LETTERS_OF_CONDITION


def _within_range(
    ring: FormulaRing, numerator: PolyElement
) -> tuple[list[Requirement], tuple[FormulaRing, ...]] | None:
    """Return the range of an inverse function in which a claim is true, with the rings of its proof; or None."""
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
