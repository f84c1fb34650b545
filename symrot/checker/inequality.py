"""Verdicts on inequalities such as ``x^2 + 1 > 0``, and on the inequalities between moments of inertia.

An inequality is true if the difference of its sides is proven to have the right sign everywhere, and false if it has
the other sign at an exact point. An inequality such as ``omega > 2`` is a condition on its letters: its verdict is
"definition".
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice, product
from time import perf_counter
from typing import Any

from sympy import Expr, Rational, Symbol, pi

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import TIME, Node, walk
from symrot.checker.claim_verdict import check_claim, verdict_of_decision, within_budget
from symrot.checker.decide.decision import decide_equation, for_positive_bases
from symrot.checker.decide.signs import is_proven_nonnegative, is_proven_positive
from symrot.checker.verdict import Diagnosis, Identification, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.evidence import Counterexample
from symrot.exact.intervals import enclosure

__all__ = ["OPPOSITE", "is_inequality", "verdict_on_inequality"]

OPPOSITE = {">": "<", ">=": "<=", "<": ">", "<=": ">="}
"""Sign of an inequality -> the reversed sign."""

MOST_POINTS = 4000
"""The largest number of points at which a counterexample is sought."""

VALUES = (*map(Rational, ("0", "1", "-1", "1/2", "2", "-2", "3", "-1/3", "10", "-10", "1/10")), pi / 2, -pi / 2, pi)
MOMENTS = (("A", "B", "C"), *((f"{letter}{index.format(1)}", f"{letter}{index.format(2)}", f"{letter}{index.format(3)}")
           for letter in "IJ" for index in ("_{0}", "{0}", "_{0}{0}", "{0}{0}")),
           *((f"{letter}{mark}{'x' * n}", f"{letter}{mark}{'y' * n}", f"{letter}{mark}{'z' * n}")
           for letter in "IJ" for mark in ("_", "") for n in (1, 2)))  # fmt: skip
"""Triples of names for the moments of inertia about three perpendicular axes, such as ("A", "B", "C")."""

CONDITION = "it is a condition that may hold for some values of its letters only: it is neither proven nor refuted"

SPIN = "omega_3"
"""Name that symrot's known formulas have for the spin of a top about its axis of symmetry."""

PLATE = "the body is not a plane plate"


def verdict_on_inequality(claim: Claim, sign: str, flipped: str) -> Verdict:
    """Return the verdict on an inequality whose two sides were read as an equation.

    Parameters
    ----------
    claim : Claim
        The claim with an equals sign in place of the inequality sign.
    sign : str
        The sign of the inequality.
    flipped : str
        The text of the inequality with the opposite sign, for a repair.

    Raises
    ------
    InputError
        For sides that are not real numbers.
    """
    start = perf_counter()
    verdict = within_budget(lambda: _verdict(claim, sign, flipped, start), claim.text)
    return replace(verdict, seconds=perf_counter() - start)


def _verdict(claim: Claim, sign: str, flipped: str, start: float) -> Verdict:
    assert claim.relation is not None
    equation = claim.equation
    for side in (equation.left, equation.right):
        if is_matrix(side) or not isinstance(side, Expr) or claim.has_parts:
            raise InputError(f"expected real numbers on both sides of {sign}, not vectors, matrices or complex numbers")
    left, right = (equation.left, equation.right) if sign.startswith(">") else (equation.right, equation.left)
    difference, strict = left - right, sign in (">", "<")
    if (verdict := _on_moments(difference, strict, flipped)) is not None:
        return verdict
    domain = decide_equation(replace(equation, right=equation.left))
    if domain.verdict not in ("true", "conditional"):
        return Verdict(
            "undecided", reason="it is not known for which values of the letters both sides are real numbers"
        )
    if is_proven_positive(difference) if strict else is_proven_nonnegative(difference):
        decision = for_positive_bases(replace(domain, verdict="true"), equation)
        return verdict_of_decision(decision, claim.text, start)
    if _is_condition(claim):
        on_spin = _on_least_spin(claim, sign)
        return Verdict("definition", reason=CONDITION) if on_spin is None else on_spin
    if (point := _counterexample(claim, difference, strict)) is not None:
        return Verdict("false", counterexample=point)
    return Verdict(
        "undecided",
        reason="no proof of the inequality was found, and no point at which it is false",
    )


def _on_least_spin(claim: Claim, sign: str) -> Verdict | None:
    """Return the verdict on an inequality for the least spin of an upright top: ``I_3^2 w_3^2 >= 4 m g l I_1``.

    Return None for any other inequality.
    """
    assert claim.relation is not None
    verdict = check_claim(claim)
    if verdict.verdict not in ("recognised", "doubtful") or not verdict.recognised_as:
        return None
    known = verdict.recognised_as[0]
    if " least spin " not in known.name:
        return None
    left, right = claim.relation[1:]
    greater, smaller = (left, right) if sign.startswith(">") else (right, left)
    spin = known.mapping.get(SPIN, SPIN)
    is_right = spin in _letters(greater) and spin not in _letters(smaller)
    return verdict if is_right else None  # a top below the least spin is possible too: it falls


def _is_condition(claim: Claim) -> bool:
    """Return whether an inequality is meant as a condition on its letters, such as ``omega > 2``, not as a theorem.

    If both sides have letters, it is a condition if they have none in common: ``x > y``, but not ``x^2 > x``. If only
    one side has letters, it is a condition if this side is a single letter or has several letters: ``omega > 2``, but
    not ``x^2 > 1``. A claim with hypotheses is never a condition.
    """
    assert claim.relation is not None
    if claim.hypotheses:
        return False
    left, right = map(_letters, claim.relation[1:])
    if left and right:
        return not left & right
    sides = [side for side in claim.relation[1:] if _letters(side)]
    return bool(sides) and (sides[0].kind == "name" or len(left | right) > 1)


def _letters(tree: Node) -> set[str]:
    nodes = [node for _, node in walk(tree)]
    functions = {str(node.value) for node in nodes if node.kind == "call" and node.args == (TIME,)}
    return functions | {str(node.value) for node in nodes if node.kind == "name"} - {"pi", "t"}


def _on_moments(difference: Expr, strict: bool, flipped: str) -> Verdict | None:
    """Return the verdict on an inequality between the moments of inertia of a body, such as I_1 + I_2 >= I_3.

    Return None for any other inequality.
    """
    names = {symbol.name for symbol in difference.free_symbols}
    own = next((moments for moments in MOMENTS if names == {*moments}), None)
    if own is None:
        return None
    # moments Y + Z, X + Z, X + Y, with integrals X, Y, Z of x^2, y^2, z^2: one of these is zero for a plane plate only
    integrals = [Symbol(name, nonnegative=True) for name in "XYZ"]
    x, y, z = integrals
    moments = dict(zip(own, (y + z, x + z, x + y), strict=True))
    values = {symbol: moments[symbol.name] for symbol in difference.free_symbols}
    inside = difference.xreplace(values).expand()
    known = Identification("inequality of the moments of inertia of a body", "", {}, "integrals of x^2, y^2, z^2")
    if is_proven_nonnegative(inside):
        if strict and not is_proven_positive(inside):
            return Verdict("conditional", conditions=(PLATE,), requires=(PLATE,), recognised_as=(known,))
        return Verdict("recognised", recognised_as=(known,))
    if is_proven_nonnegative((-inside).expand()):
        diagnosis = Diagnosis("sign", "the sign of the inequality is reversed")
        flipped = flipped.replace(" > ", " >= ").replace(" < ", " <= ")  # with equality, for a plane plate
        return Verdict("doubtful", diagnosis=diagnosis, recognised_as=(known,), repairs=(Repair(flipped, "sign", 1.0),))
    return None


def _counterexample(claim: Claim, difference: Expr, strict: bool) -> Counterexample | None:
    """Return an exact point where both sides are defined and the inequality fails; None if the search finds none.

    Claims with hypotheses, or with powers whose exponents are not numbers, are not searched.
    """
    equation = claim.equation
    if equation.hypotheses or equation.nonzero or equation.bases:
        return None
    symbols = sorted(difference.free_symbols | equation.left.free_symbols | equation.right.free_symbols, key=str)
    if any(not symbol.is_real for symbol in symbols):
        return None
    for values in islice(_points(symbols), MOST_POINTS):
        value = enclosure(difference, values)
        if value is None or not _is_defined(equation, values):
            continue
        exact = difference.xreplace(values)  # the larger side minus the smaller one
        if value.b < 0 or (strict and exact.is_zero):
            sides = (side.xreplace(values) for side in (equation.left, equation.right))
            return Counterexample(tuple(values.items()), None, *sides)
    return None


def _points(symbols: list[Any]) -> Iterator[Mapping[Any, Expr]]:
    """Yield points, {symbol: value}, with simple values that agree with the assumed signs of ``symbols``."""
    allowed = [
        [v for v in VALUES if not (s.is_positive and v <= 0) and not (s.is_nonnegative and v < 0)] for s in symbols
    ]
    for values in product(*allowed):
        yield dict(zip(symbols, values, strict=True))


def _is_defined(equation: Any, values: Mapping[Any, Expr]) -> bool:
    """Return whether both sides of an equation are proven to have real values at a point."""
    # divisors must be nonzero, and formulas under even roots not negative
    parts = [enclosure(side, values) for side in (equation.left, equation.right, *equation.divisors)]
    if any(part is None for part in parts) or any(part.a <= 0 <= part.b for part in parts[2:]):
        return False
    roots = [enclosure(radicand, values) for radicand in equation.radicands]
    return all(root is not None and root.a >= 0 for root in roots)


def is_inequality(signs: tuple[str, ...]) -> bool:
    """Return whether ``signs``, the relation signs in a line of text, are a single one of <, <=, > and >=."""
    return len(signs) == 1 and signs[0] in OPPOSITE
