"""Equations for one letter, such as ``x² = 4``: true for some values of the letter only.

Nobody writes such an equation as an identity; so its verdict is "definition", with the values for which it holds.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from sympy import Expr, Poly, Symbol, roots
from sympy.polys.polyerrors import BasePolynomialError

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.notation import Notation
from symrot.checker.claim.solving import is_name_or_rate, solution
from symrot.checker.claim.tree import Node, number, text, walk
from symrot.checker.verdict import Diagnosis, Verdict
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.printing import as_text

__all__ = ["as_equation"]

HIGHEST_DEGREE = 12
"""The highest degree of a polynomial whose real roots are counted."""
MANY_TO_ONE = ("sin", "cos", "tan", "abs")
"""Functions that have the same value at several arguments, so that an equation may have more than one solution."""


def as_equation(claim: Claim, verdict: Verdict, notation: Notation) -> Verdict:
    """Return the verdict "definition" for a false equation that an author may have meant as a condition.

    Such an equation has a single letter and a real solution, as ``x² = 4`` has, or each of its sides is a single
    letter, as in ``a = b``. Return ``verdict``, which must be "false", for all other claims. ``notation`` is the
    notation of the user's text, in which the reason for the verdict is written.
    """
    if claim.relation is None or claim.has_double_equals or not claim.implied:
        return verdict
    if claim.hypotheses or claim.define or claim.has_parts:
        return verdict
    _, left, right = claim.relation
    if all(map(is_name_or_rate, (left, right))) and left != right:
        both = " and ".join(notation.formula(side) for side in (left, right))
        meanings = "the equation may be a condition, or both may be names for one quantity"
        return _open(verdict, f"nothing here says what {both} are: {meanings}")
    names = [node for side in (left, right) for _, node in walk(side) if is_name_or_rate(node) and node.value != "pi"]
    if len({*names}) != 1 or len({str(name.value) for name in names}) != 1:
        return verdict
    letter = names[0]
    values = _values(claim, letter, once=len(names) == 1)  # None for x² = -1, which stays false
    if values is None:
        return verdict
    name = notation.formula(letter)
    example = ", for example" if _may_have_others(claim, letter) else ""
    written = notation.condition(values) if "==" in values else values
    reason = f"it is an equation for {name}, not an identity: it holds for {written}{example}"
    return _open(verdict, reason)


def _open(verdict: Verdict, reason: str) -> Verdict:
    return replace(
        verdict, verdict="definition", reason=reason, counterexample=None, diagnosis=Diagnosis("none", ""), repairs=()
    )


def _values(claim: Claim, letter: Node, once: bool) -> str | None:
    """Return values of ``letter`` that solve the claim's equation, as text such as ``"x == 2"``; None if none is known.

    An equation that is a polynomial in the letter gives all real solutions, or their number. Another equation gives one
    solution, by inverse functions, and only if the letter occurs ``once`` in it.
    """
    left, right = claim.equation.left, claim.equation.right
    symbol = claim.interpreter().read(letter)
    if not all(isinstance(side, Expr) for side in (left, right)):
        return None
    if _is_polynomial(claim, letter):
        return _roots(left - right, symbol, text(letter))
    if not once:
        return None  # only a letter that occurs once can be isolated by inverse functions
    assert claim.relation is not None
    side, other = claim.relation[1:]
    if letter not in [node for _, node in walk(side)]:
        side, other = other, side
    solved = solution(side.args[0] if side.value == "abs" else side)
    if solved is None:
        return None
    try:
        value = claim.interpreter().read(solved[1](other))
    except InputError:
        return None
    sides = [formula.xreplace({symbol: value}) for formula in (left, right)]
    if value.is_real is not True or decide(*sides).verdict != "true":
        return None
    return f"{text(letter)} == {as_text(value)}"


def _may_have_others(claim: Claim, letter: Node) -> bool:
    """Return whether an equation may have other solutions than inverse functions give, as ``sin x = 1/2`` has."""
    if _is_polynomial(claim, letter):
        return False  # all its real roots are known
    assert claim.relation is not None
    above = [
        node for side in claim.relation[1:] for _, node in walk(side) if letter in [part for _, part in walk(node)]
    ]
    return any(node.kind == "call" and node.value in MANY_TO_ONE for node in above) or any(
        node.kind == "power" and node.args[1].kind == "number" and node.args[1].value.numerator % 2 == 0
        for node in above
    )


def _roots(difference: Expr, symbol: Symbol, name: str) -> str | None:
    """Return all real zeros of ``difference`` as text, ``"x == -2 and x == 2"``, or only how many there are.

    ``name`` is the name of ``symbol``. Return None if there are no real zeros, and if ``difference`` is not a
    polynomial in ``symbol``, or one of too high a degree: above HIGHEST_DEGREE for rational coefficients, above 2 for
    others.
    """
    try:
        polynomial = Poly(difference, symbol, domain="QQ")
    except BasePolynomialError:  # also CoercionFailed, for irrational coefficients
        return _irrational_roots(difference, symbol, name)
    if not 0 < polynomial.degree() <= HIGHEST_DEGREE or not polynomial.count_roots():
        return None
    values = list(dict.fromkeys(polynomial.real_roots()))
    if polynomial.degree() > 2 and not all(value.is_Rational for value in values):
        return "one real value only" if len(values) == 1 else f"{len(values)} real values only"
    return _as_conditions(values, name)


def _irrational_roots(difference: Expr, symbol: Symbol, name: str) -> str | None:
    """Return the real zeros of a polynomial such as ``x^2 - pi`` as text, ``"x == -sqrt(pi) and x == sqrt(pi)"``.

    Return None unless ``difference`` is a polynomial of degree 1 or 2 in ``symbol`` alone, it is known which of its
    zeros are real, and at least one is.
    """
    if not difference.is_polynomial(symbol) or difference.free_symbols != {symbol}:
        return None
    polynomial = Poly(difference, symbol)
    values = list(roots(polynomial)) if 0 < polynomial.degree() <= 2 else []
    if any(value.is_real is None for value in values) or not any(value.is_real for value in values):
        return None
    return _as_conditions([value for value in values if value.is_real], name)


def _as_conditions(values: Iterable[Expr], name: str) -> str:
    return " and ".join(f"{name} == {as_text(value)}" for value in values)


def _is_polynomial(claim: Claim, letter: Node) -> bool:
    """Return whether both sides are sums of powers of a letter in which no power occurs twice, as in ``x^2 = 4``."""
    assert claim.relation is not None
    sides = [[] if side == number(0) else _exponents(side, letter) for side in claim.relation[1:]]
    powers = [exponent for exponents in sides if exponents is not None for exponent in exponents]
    # 2x = 3x and (x + 1)^2 = x^2 + 1 may be meant as identities
    return None not in sides and len({*powers}) == len(powers)


def _exponents(side: Node, letter: Node) -> Sequence[Any] | None:
    """Return the power of a letter in each term of a sum: [2, 1, 0] for ``x^2 + 3 x + 5``.

    Return None if the letter x occurs in a term in any other way, as in ``sin(x)``, ``1/x`` or ``x*x``.
    """
    exponents = []
    for term in side.args if side.kind == "sum" else (side,):
        bare = term.args[0] if term.kind == "neg" else term
        factors = bare.args if bare.kind == "product" else (bare,)
        own = [factor for factor in factors if letter in [node for _, node in walk(factor)]]
        if len(own) > 1:
            return None
        if not own:
            exponents.append(0)
        elif own[0] == letter:
            exponents.append(1)
        elif own[0].kind == "power" and own[0].args[0] == letter and own[0].args[1].kind == "number":
            exponents.append(own[0].args[1].value)
        else:
            return None
    return exponents
