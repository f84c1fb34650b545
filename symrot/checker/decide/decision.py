"""Two sides and hypotheses in, a verdict with its evidence out. The mathematics is that of :mod:`symrot.exact`."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Any

from mpmath import iv
from sympy import Expr, I, Mul, Pow, Rational, Symbol, atan2, pi, preorder_traversal, zeros
from sympy.polys.rings import PolyElement

from symrot.checker.claim.printed import shown
from symrot.checker.decide.conditions import Requirement, branch_requirements, requirements, surely_nonnegative
from symrot.checker.decide.hypotheses import Grounds
from symrot.checker.decide.real_points import ATTEMPTS
from symrot.checker.decide.unordered import is_unordered
from symrot.checker.verdict import Counterexample
from symrot.errors import InputError
from symrot.exact.angles import cyclotomic
from symrot.exact.budget import one_decision
from symrot.exact.congruence_closure import proof_by_congruence
from symrot.exact.counterexample import Counterexample as Witness
from symrot.exact.counterexample import closed_form_witness, rational_witness
from symrot.exact.decide import flatten
from symrot.exact.domain import domain
from symrot.exact.domain.known_points import holds
from symrot.exact.domain.needs import Need, needs_of
from symrot.exact.intervals import enclosure, is_nonnegative_at
from symrot.exact.inverse_sums import lifts, principal, proof
from symrot.exact.ring.ratio import MOST_PRODUCTS, TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero
from symrot.exact.ring.roots import written

__all__ = ["Decision", "Problem", "decide_problem", "shown"]

Search = Callable[[FormulaRing, Expr, Expr, tuple[int, int] | None], Witness | None]

MUCH_LARGER = 5
"""Times the pieces of another formula, from which on the text is longer without a doubt."""

MOST_ON_THE_CUT = 4
"""Symbols of a formula with atan2 that is looked at where some of them are zero."""

LARGEST_DEGREE = 240
"""Of a side in its symbols, sines and cosines; a larger one is refused before anything is expanded."""


@dataclass(frozen=True)
class Problem:
    """An equation with its hypotheses, what its text divides by, what hypotheses make nonzero, and its radicands."""

    left: Any
    right: Any
    hypotheses: tuple[Any, ...] = ()
    divisors: tuple[Expr, ...] = ()
    nonzero: tuple[Expr, ...] = ()
    radicands: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Decision:
    """The outcome: ``verdict``, and what goes with it; ``products`` of terms were needed to expand the formulas."""

    verdict: str
    conditions: tuple[str, ...] = ()
    requires: tuple[Requirement, ...] = ()
    counterexample: Counterexample | None = None
    reason: str = ""
    notes: tuple[str, ...] = ()
    products: int = 0


def decide_problem(problem: Problem) -> Decision:
    """Return what is known about an equation.

    Raises
    ------
    InputError
        If the shapes differ, a side is no finite exact formula, it divides by what is zero everywhere, the hypotheses
        contradict each other, or the degree is beyond the budget.
    """
    try:
        with one_decision():
            return _decide(problem)
    except RecursionError:
        return Decision("undecided", reason="the formulas are nested too deeply to be read")
    except (TypeError, AttributeError) as reason:
        if is_unordered(reason):
            return Decision("undecided", reason="it cannot be told which of two numbers in it is larger")
        raise


def _decide(problem: Problem) -> Decision:
    lefts, rights, shape = _sides(problem)
    relations = [as_zero(relation) for relation in problem.hypotheses]
    for formula in [*lefts, *rights, *relations, *problem.divisors, *problem.radicands]:
        _affordable(formula)
        if formula.has(I):
            raise InputError(f"expected real numbers, got the square root of a negative number in {shown(formula)}")
    try:
        ring = FormulaRing([*lefts, *rights, *problem.divisors, *problem.nonzero], relations, problem.radicands)
    except TooLarge as reason:
        return Decision("undecided", reason=str(reason), products=MOST_PRODUCTS)
    try:
        decision = _decided(ring, problem, lefts, rights, shape)
        if decision.verdict == "true" and not relations and any(side.has(atan2) for side in (*lefts, *rights)):
            decision = _off_the_cut(decision, _needs(problem, lefts, rights), lefts, rights, shape)
        return replace(decision, products=ring.ratios.products)
    except TooLarge as reason:
        searches = [_within(ring, rational_witness), closed_form_witness]
        try:
            witness = _witness(searches, ring, lefts, rights, range(len(lefts)), shape)
        except TooLarge:
            witness = None
        if witness:
            return Decision("false", counterexample=_as_text(witness), products=MOST_PRODUCTS)
        return Decision("undecided", reason=str(reason), products=MOST_PRODUCTS)


def _decided(
    ring: FormulaRing, problem: Problem, lefts: list[Expr], rights: list[Expr], shape: tuple[int, int] | None
) -> Decision:
    granted = _granted(ring, problem.nonzero)
    residuals = [ring.difference(a, b) for a, b in zip(lefts, rights, strict=True)]
    proofs = [proof(ring, residual.numerator) for residual in residuals]
    wrong = [place for place, found in enumerate(proofs) if found is None]
    for divisor in problem.divisors:
        ring.ratios.invert(ring.ratio(divisor), divisor)
    further = [lift for found in proofs if found for lift in found]
    grounds = Grounds(ring, shown, _needs(problem, lefts, rights))
    grounds.refuse_if_nowhere()
    if not wrong:
        return _true(grounds, _conditions([ring, *further], granted, problem.radicands), further)
    numerators = [ring.reduce(residuals[place].numerator) for place in wrong]
    closed_form = grounds.checked(closed_form_witness)
    nearest = _within(ring, grounds.near_witness) if ring.hypotheses else closed_form
    witness = _witness([rational_witness, nearest], ring, lefts, rights, wrong[:4], shape)
    branches, lift = _branches(ring, numerators)
    conditions = _conditions([ring, *further, *lift], granted, problem.radicands)
    if branches is not None and _taken_for_granted(branches, ring, problem.radicands):
        return _true(grounds, conditions, (*further, *lift))
    if not witness and (ring.hypotheses or branches is None):
        if grounds.imply(numerators):
            return _true(grounds, conditions, (*further, *lift))
        grounds.refuse_if_empty()
        rest = [_within(ring, grounds.witness), *([closed_form] if ring.hypotheses else [])]
        witness = _witness(rest, ring, lefts, rights, wrong[:4], shape)
    needed = requirements(ring, numerators, [(lefts[n], rights[n]) for n in wrong], len(lefts))
    needed = [requirement for requirement in needed if _can_hold(requirement, grounds)]
    if branches and not needed and _can_hold(branches[0], grounds):
        if not witness:  # it may hold everywhere
            signs = " and ".join(requirement.text for requirement in branches)
            reason = f"it is true where {signs}, and no point is known where that fails"
            return Decision("undecided", conditions, (), None, reason)
        needed = branches
    counterexample = _as_text(witness) if witness else None
    if needed:
        texts = tuple(requirement.text for requirement in needed)
        return Decision("conditional", (*texts, *conditions), tuple(needed), counterexample)
    if witness:
        return Decision("false", conditions, (), counterexample)
    congruent = [proof_by_congruence(lefts[n], rights[n], ring.hypotheses, ring.domain) for n in wrong]
    if None not in congruent:
        lift = tuple(other for found in congruent if found for other in found)
        conditions = _conditions([ring, *further, *lift], granted, problem.radicands)
        return _true(grounds, conditions, (*further, *lift))
    return Decision("undecided", conditions, (), None, _stopped_by(ring))


def _points_on_cuts(symbols: Sequence[Expr], cuts: Sequence[Expr]) -> Iterator[dict[Expr, Rational]]:
    """Yield simple points, and such at which the first argument of an atan2 is zero, where it is linear in a symbol."""
    for values in product((0, -1, 1, Rational(-3, 2)), repeat=len(symbols)):
        point = dict(zip(symbols, map(Rational, values), strict=True))
        yield point
        for cut, symbol in product(cuts, symbols):
            slope = cut.diff(symbol)
            at_zero, steep = (value.subs({**point, symbol: 0}) for value in (cut, slope))
            if not slope.has(symbol) and steep.is_Rational and steep and at_zero.is_Rational:
                yield {**point, symbol: -at_zero / steep}


def _off_the_cut(
    decision: Decision, needs: Sequence[Need], lefts: list[Expr], rights: list[Expr], shape: tuple[int, int] | None
) -> Decision:
    """Return a decision that is conditional where the sides differ at a point that its conditions exclude.

    All functions but atan2 are continuous where they are defined, so that sides which are equal where no divisor of the
    proof vanishes are equal in between too; atan2 jumps where its first argument is zero and the second negative.
    """
    symbols = sorted({symbol for side in (*lefts, *rights) for symbol in side.free_symbols}, key=str)
    cuts = sorted({node.args[0] for side in (*lefts, *rights) for node in side.atoms(atan2)}, key=str)
    for point in _points_on_cuts(symbols, cuts) if 0 < len(symbols) <= MOST_ON_THE_CUT else ():
        values = {symbol: Fraction(int(value.p), int(value.q)) for symbol, value in point.items()}
        for place, sides in enumerate(zip(lefts, rights, strict=True)):
            left, right = (enclosure(side, values) for side in sides)
            if left is None or right is None or 0 in iv.mpf(0) + left - right:
                continue
            if all(holds(need, values) for need in needs):
                entry = None if shape is None else (place // shape[1] + 1, place % shape[1] + 1)
                lhs, rhs = (side.subs(point) for side in sides)
                required = " and ".join(decision.conditions)
                return replace(
                    decision, verdict="conditional", requires=(Requirement("principal_value", required),),
                    counterexample=_as_text(Witness(tuple(point.items()), entry, lhs, rhs)),
                )  # fmt: skip
    return decision


def _needs(problem: Problem, lefts: Sequence[Expr], rights: Sequence[Expr]) -> list[Need]:
    """Return what sides and hypotheses need to be real numbers, with what the text says and SymPy has cancelled."""
    hypotheses = [as_zero(relation) for relation in problem.hypotheses]
    stated = [Need(divisor, "!= 0") for divisor in (*problem.divisors, *problem.nonzero)]
    divided = {*problem.divisors, *problem.nonzero}  # the argument of a logarithm is noted as both
    stated += [Need(radicand, "> 0" if radicand in divided else ">= 0") for radicand in problem.radicands]
    return [*needs_of([*lefts, *rights, *hypotheses, *(need.formula for need in stated)]), *stated]


def _true(grounds: Grounds, conditions: tuple[str, ...], rings: Sequence[FormulaRing]) -> Decision:
    """Return the verdict "true" where a point is known to which it applies, else "undecided"."""
    divided = [Need(source, "!= 0") for ring in (grounds.ring, *rings) for source, _ in domain.divisors(ring)]
    divided += [Need(formula, ">= 0") for ring in (grounds.ring, *rings) for formula in domain.split_radicands(ring)]
    if grounds.known([need for need in divided if need not in grounds.needs]):
        return Decision("true", conditions)
    hypotheses = " and the hypotheses hold" if grounds.ring.hypotheses else ""
    reason = f"it follows, but no point is known at which both sides are real numbers{hypotheses}"
    return Decision("undecided", conditions, reason=reason)


def _can_hold(requirement: Requirement, grounds: Grounds) -> bool:
    """Return whether a point is known at which a condition holds, and the sides are real numbers."""
    signs = [Need(value, ">= 0") for value in (*requirement.signs, *domain.split_radicands(grounds.ring))]
    return grounds.allow(requirement.zeros) and grounds.known([*needs_of(requirement.signs), *signs], requirement.zeros)


def _sides(problem: Problem) -> tuple[list[Expr], list[Expr], tuple[int, int] | None]:
    (lefts, shape), (rights, other) = flatten(problem.left), flatten(problem.right)
    if shape is not None and other is None and rights == [0]:
        rights, other = list(zeros(*shape)), shape
    if other is not None and shape is None and lefts == [0]:
        lefts, shape = list(zeros(*other)), other
    if shape != other:
        names = ["a scalar" if s is None else f"a {s[0]} x {s[1]} matrix" for s in (shape, other)]
        loose = isinstance(problem.left, Symbol) or isinstance(problem.right, Symbol)
        hint = " (a name that nothing defines is a scalar; `symrot identify` says what a matrix is)" if loose else ""
        raise InputError(f"expected two sides of one shape, got {names[0]} == {names[1]}{hint}")
    return lefts, rights, shape


def _affordable(formula: Expr) -> None:
    size = _degree(formula, {})
    if size > LARGEST_DEGREE:
        raise InputError(f"expected a formula of degree up to {LARGEST_DEGREE} in symbols and sines, got about {size}")


def _degree(node: Expr, known: dict[Expr, int]) -> int:
    """Return a bound on the degree of numerator and denominator together."""
    if node not in known:
        below = [_degree(part, known) for part in node.args]
        if isinstance(node, Mul):
            known[node] = sum(below)
        elif isinstance(node, Pow) and node.exp.is_Rational:
            known[node] = below[0] * max(1, abs(int(node.exp.p)))
        elif node.is_Function and len(node.args) == 1 and not node.args[0].is_Symbol:
            known[node] = max(_multiple(node.args[0]), 1)
        elif node.is_number:
            known[node] = 0
        else:
            known[node] = max([*below, 1]) if not node.is_Add else max(below)
    return known[node]


def _multiple(argument: Expr) -> int:
    """Return how many base angles an argument of a sine is made of, at least roughly."""
    total = 0
    for term in argument.as_ordered_terms() if argument.is_Add else [argument]:
        number, atom = term.as_coeff_Mul()
        constant = atom is pi and cyclotomic.is_fine(int(number.q))
        total += abs(int(number.p)) * int(number.q) if number.is_Rational and not constant else 1
    return total


def _granted(ring: FormulaRing, nonzero: Sequence[Expr]) -> set[int]:
    """Return the numbers of the factors that hypotheses grant to be nonzero."""
    for formula in nonzero:
        ring.ratios.invert(ring.ratio(formula), formula)
    return set(range(len(ring.ratios.factors)))


def _conditions(rings: Sequence[FormulaRing], granted: set[int], radicands: Sequence[Expr]) -> tuple[str, ...]:
    """Return where both sides are defined, and a proof in further rings holds, less what assumptions grant."""
    ring, *further = rings
    forms = [*domain.divisors(ring, granted), *(pair for other in further for pair in domain.divisors(other))]
    free = set(domain.divisors(ring)) - set(domain.divisors(ring, granted))
    found = {f"{shown(_shorter(*pair))} != 0" for pair in forms if pair not in free}
    found |= {f"{shown(base)} >= 0" for base in (*radicands, *domain.radicands(ring)) if not surely_nonnegative(base)}
    for condition in sorted(found):
        formula, positive = condition.removesuffix(" >= 0"), condition.endswith(" >= 0")
        if positive and f"{formula} != 0" in found:
            found = found - {condition, f"{formula} != 0"} | {f"{formula} > 0"}
    return tuple(sorted(found))


def _taken_for_granted(branches: Sequence[Requirement], ring: FormulaRing, radicands: Sequence[Expr]) -> bool:
    """Return whether sign conditions hold wherever both sides are defined."""
    known = {f"{shown(formula)} >= 0" for formula in (*radicands, *domain.signs(ring))}
    return all(sign in known for requirement in branches for sign in requirement.text.split(" and "))


def _shorter(first: Expr, second: Expr) -> Expr:
    """Return the formula whose text is shorter; a large one is not written out for that."""
    few, many = sorted((first, second), key=_pieces)
    if _pieces(many) > MUCH_LARGER * _pieces(few):
        return few
    return min(first, second, key=lambda formula: len(written(formula)))


def _pieces(formula: Expr) -> int:
    return sum(1 for _ in preorder_traversal(formula))


def _branches(
    ring: FormulaRing, numerators: Sequence[PolyElement]
) -> tuple[list[Requirement] | None, tuple[FormulaRing, ...]]:
    """Return sign conditions under which residuals vanish, and the further ring that shows it.

    An empty list where no condition is needed; None where none is known.
    """
    try:
        found = branch_requirements(ring, numerators) if ring.roots else None
    except TooLarge:
        return None, ()
    if found is None and len(numerators) == 1:
        for lift in lifts(ring, numerators[0]):
            found = branch_requirements(lift.ring, [poly for poly in lift.numerators if poly])
            if found is not None:
                return found, (lift.ring,)
        within = principal(ring, numerators[0]) if found is None else None
        if within is not None:
            ends = [end for end in (within.least, within.most) if not surely_nonnegative(end)]
            text = " and ".join(f"{shown(end)} >= 0" for end in ends)
            return [Requirement("principal_value", text, signs=tuple(ends))] if ends else [], within.rings
    return found, ()


def _within(ring: FormulaRing, search: Search) -> Search:
    """Return a search for witnesses less those outside the domain that the text shows and the formulas no longer do."""

    def searched(ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None) -> Witness | None:
        found = search(ring, left, right, entry)
        values = dict(found.values) if found else {}
        return found if all(is_nonnegative_at(formula, values) for formula in ring.domain) else None

    return searched if ring.domain else search


def _witness(
    searches: Sequence[Search], ring: FormulaRing, lefts: list[Expr], rights: list[Expr],
    places: Sequence[int], shape: tuple[int, int] | None,
) -> Witness | None:  # fmt: skip
    for search in searches:
        for place in places:
            entry = None if shape is None else (place // shape[1] + 1, place % shape[1] + 1)
            found = search(ring, lefts[place], rights[place], entry)
            if found is not None and not _breaks(found, ring):
                return found
    return None


def _breaks(witness: Witness, ring: FormulaRing) -> bool:
    """Return whether intervals show that a point breaks a hypothesis, whatever led to it."""
    values = dict(witness.values)
    enclosures = [enclosure(hypothesis, values) for hypothesis in ring.hypotheses]
    return any(held is not None and 0 not in held for held in enclosures)


def _as_text(witness: Witness) -> Counterexample:
    values = {shown(name): shown(value) for name, value in witness.values}
    return Counterexample(values, shown(witness.lhs), shown(witness.rhs), witness.entry)


def _stopped_by(ring: FormulaRing) -> str:
    if ring.outside_scope:
        terms = ", ".join(shown(term) for term in ring.outside_scope[:3])
        return f"too little is known here about {terms}, and no point was found where the sides provably differ"
    if ring.roots:
        roots = ", ".join(shown(root.expression) for root in list(ring.roots)[:3])
        return f"the sides agree or differ with the sign of {roots}, and no point was found where they provably differ"
    if ring.hypotheses:
        return f"none of {ATTEMPTS} points drawn obeys the hypotheses and shows a difference; no proof was found either"
    return "no rational point was found at which the sides differ, since an angle is tied to other symbols"
