"""The decision on a claim: the stages of :mod:`symrot.exact.decision`, and further stages that only claims need.

A claim may have hypotheses, and its text may have divisors and roots that SymPy has cancelled. The further stages use
these, and look for a condition under which a false claim is true.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from sympy import Abs, Expr, I, Poly, Symbol, fraction, nan, oo, preorder_traversal, zoo
from sympy.polys.polyerrors import BasePolynomialError

from symrot.checker.decide.branch_cuts import BranchCut, branch_cuts
from symrot.checker.decide.equation import Equation, sides_of, stated_needs
from symrot.checker.decide.large_powers import LARGEST_DEGREE, degree_of, point_of_difference, shorter_powers
from symrot.checker.decide.ranges.text import positive_symbols, range_text
from symrot.checker.decide.stages import STAGES, ClaimCase, domain_of_text, leave_open, nearby_witness
from symrot.checker.decide.unordered import is_unordered
from symrot.errors import InputError
from symrot.exact.counterexample import closed_form_witness, rational_witness
from symrot.exact.decision import Decision, Shape, first_decision, flatten
from symrot.exact.domain.known_points import known_point
from symrot.exact.domain.needs import leaves_of, needs_of
from symrot.exact.evidence import Counterexample, Requirement
from symrot.exact.limits.budget import one_decision
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import MOST_PRODUCTS, TooLarge
from symrot.exact.ring.ring import FormulaRing, as_zero
from symrot.exact.ring.roots import is_positive_where_defined

__all__ = ["decide_equation", "for_positive_bases", "is_large"]

LONG_SUM = 5
"""A sum inside a function is replaced by a letter, to try a proof, only if it has at least this many terms."""


def is_large(equation: Equation) -> bool:
    """Return whether a side of an equation is too large to be expanded; then no repairs are sought either."""
    return degree_of([*flatten(equation.left)[0], *flatten(equation.right)[0]]) > LARGEST_DEGREE


def decide_equation(equation: Equation) -> Decision:
    """Return the decision on an equation with hypotheses: true, false, conditional or undecided.

    Raises
    ------
    InputError
        If the shapes differ, a side is not a finite exact formula or divides by a formula that is zero everywhere, a
        formula contains the imaginary unit, the hypotheses contradict each other, or a degree above ``LARGEST_DEGREE``
        rules out the expansion that is needed.
    """
    try:
        with one_decision():
            decision = _decide(equation)
            if decision.verdict == "undecided":
                decision = _with_positive_symbols(equation, decision)
            if decision.verdict == "undecided":
                decision = _with_letters_for_sums(equation, decision)
        if decision.verdict != "conditional":
            return decision
        return replace(decision, conditions=tuple(_without_divisor(each, equation) for each in decision.conditions))
    except RecursionError:
        return Decision("undecided", reason="the formulas are nested too deeply to be read")
    except (TypeError, AttributeError) as reason:
        if is_unordered(reason):
            return Decision("undecided", reason="two numbers in the claim are too close to tell which is larger")
        raise


def _with_letters_for_sums(equation: Equation, decision: Decision) -> Decision:
    """Return the decision "true" if an equation is proven with letters in place of long sums inside functions.

    For instance, ``sin(a + b + c + d + e)`` becomes ``sin(s)``. Return ``decision`` if there is no such proof, if the
    proof needs conditions, and for an equation with further conditions, such as hypotheses or divisors in its text.
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
    """Return a decision with the verdict "true" if the signs that ``decision.conditions`` require allow a proof.

    For instance, the condition x > 0 lets abs(x) be x. Otherwise return ``decision`` unchanged.
    """
    known = positive_symbols(decision.conditions)
    if not known or equation.hypotheses:
        return decision
    # in asech(x) == acosh(1/x) the left side needs x > 0, so that abs(x) is x
    try:
        signed = _decide(equation.at(known))
    except InputError:  # the signs exclude all points
        return decision
    if signed.verdict != "true":
        return decision
    symbols = {other: symbol for symbol, other in known.items()}
    conditions = [condition.xreplace(symbols) for condition in signed.conditions]
    return replace(signed, conditions=tuple(dict.fromkeys([*decision.conditions, *conditions])))


def _without_divisor(condition: Any, equation: Equation) -> Any:
    """Return a condition without the divisors that it need not have: ``x >= 0`` for ``x/abs(y) >= 0``.

    A divisor abs(y) is dropped if the equation is proven to be true for y = 0.
    """
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

    False if ``formula`` is no such polynomial with rational coefficients.
    """
    symbol = next(iter(formula.free_symbols))
    try:
        polynomial = Poly(formula, symbol, domain="QQ")
    except BasePolynomialError:  # also CoercionFailed, for irrational coefficients
        return False
    # at an irrational zero nothing is proven
    zeros = polynomial.real_roots()
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
    lefts, rights, shape = sides_of(equation)
    relations = [as_zero(relation) for relation in equation.hypotheses]
    formulas = [*lefts, *rights, *relations, *equation.divisors, *equation.radicands]
    for formula in formulas:
        if formula.has(I):
            raise InputError(f"expected real numbers, got the square root of a negative number in {as_text(formula)}")
    size = degree_of(formulas)
    if size > LARGEST_DEGREE:
        return _decide_large(equation, lefts, rights, size)
    try:
        case = _case(equation, lefts, rights, shape)
    except TooLarge as reason:
        return Decision("undecided", reason=str(reason), products=MOST_PRODUCTS)
    try:
        decision = first_decision(case, STAGES)
        if decision.verdict in ("true", "conditional"):
            decision = _off_branch_cuts(decision, equation)
        return replace(decision, products=case.ring.ratios.products)
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


def _case(equation: Equation, lefts: list[Expr], rights: list[Expr], shape: Shape) -> ClaimCase:
    relations = [as_zero(relation) for relation in equation.hypotheses]
    ring = FormulaRing([*lefts, *rights, *equation.divisors, *equation.nonzero], relations, equation.radicands)
    return ClaimCase(lefts, rights, shape, ring, equation=equation)


def for_positive_bases(decision: Decision, equation: Equation) -> Decision:
    """Return ``decision``, with "conditional" instead of "true" if its proof assumes a > 0 for a power ``a**b``."""
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


def _off_branch_cuts(decision: Decision, equation: Equation) -> Decision:
    """Return ``decision``, or "conditional" if the sides are known to differ on a branch cut of an atan2.

    The condition excludes such branch cuts. The verdict of ``decision`` is "true" or "conditional".
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
            case = _case(at_zero, *sides_of(at_zero))
            first_decision(case, (*STAGES[:2], domain_of_text, nearby_witness, leave_open))
        except (InputError, TooLarge):  # the hypotheses exclude all points of the cut
            continue
        if case.counterexample is not None:
            point = dict(case.counterexample.point)
            point |= {symbol: value.subs(point) for symbol, value in solution.items()}
            return replace(case.counterexample, point=tuple(sorted(point.items(), key=str)))
    return None


def _decide_large(equation: Equation, lefts: Sequence[Expr], rights: Sequence[Expr], size: int) -> Decision:
    """Return the decision on an equation whose powers are too large to be expanded, such as ``(a - x)**6000``.

    Raises
    ------
    InputError
        If it can neither be proven with letters in place of the powers, nor refuted at a point.
    """
    refusal = InputError(
        f"expected a formula of degree up to {LARGEST_DEGREE} in symbols and sines, got a degree of about {size}"
    )
    if equation.hypotheses or len(lefts) > 1:
        raise refusal
    proof = _with_shorter_powers(equation, lefts, rights)
    if proof is not None:
        return proof
    witness = point_of_difference(lefts[0], rights[0], stated_needs(equation))
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
        needs = [*stated_needs(equation), *needs_of(formulas)]
        if decision.verdict == "true" and known_point(needs) is not None:
            conditions = tuple(
                each.func(each.lhs.xreplace(shorter.bases), 0, evaluate=False) for each in decision.conditions
            )
            return replace(decision, conditions=conditions)
    return None
