"""Approximations for small values of a letter, ``sin θ ≈ θ``: both sides should have the same Taylor polynomial."""

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import count, islice
from math import factorial
from time import perf_counter
from typing import Any

from sympy import Expr, Integer, Poly, Symbol

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.source.text import claim_of_text, is_latex
from symrot.checker.claim_verdict import unfinished, verdict_of_decision, within_limits
from symrot.checker.latex.writing import LatexNotation
from symrot.checker.repair.edits.faults import COST
from symrot.checker.time_limit import TimeUp
from symrot.checker.typed.copied_signs import with_plain_signs
from symrot.checker.typed.tokens import LETTERS
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.limits.operations import OutOfOperations
from symrot.exact.printing import as_text

__all__ = ["verdict_on_approximation"]

SIGN = re.compile(r"≈|≃|\\(?:approx|simeq)(?![A-Za-z])")
MOST_POWER, MOST_LEFT_OUT = 8, 4
"""MOST_POWER is the highest power of x whose Taylor coefficients are compared for ``sin(x) ≈ x``, read for small x.

The first term that the right side omits, here ``-x^3/6``, is sought among its next MOST_LEFT_OUT powers, x^2 to x^5."""


def verdict_on_approximation(source: str) -> Verdict | None:
    """Return the verdict on ``f ≈ g`` for small values of a letter; None for other texts.

    The small letter, x in ``sin(x) ≈ x``, is a symbol in which f is no polynomial. If g is a polynomial in exactly one
    such symbol, g should be the Taylor polynomial of f in it. If f has a single such symbol, and g is no polynomial in
    it either, as in ``tan θ ≈ sin θ``, both Taylor series should agree in their first terms, one of which must be
    nonzero and contain the symbol.
    """
    if len(SIGN.findall(source)) != 1 or re.search("[=<>]", source):
        return None
    start = perf_counter()
    try:
        with within_limits():
            verdict = _verdict(source)
    except (InputError, _Unknown):
        return None
    except (OutOfOperations, TimeUp) as limit:
        return verdict_of_decision(unfinished(limit), source.strip(), start)
    return verdict and replace(verdict, text=source.strip(), seconds=perf_counter() - start)


def _verdict(source: str) -> Verdict | None:
    equation = claim_of_text(SIGN.sub("=", source)).equation
    left, right = equation.left, equation.right
    if is_matrix(left) or is_matrix(right):
        return None
    curved = [letter for letter in left.free_symbols if not left.is_polynomial(letter)]
    letters = [letter for letter in curved if right.is_polynomial(letter)]
    if not letters and len(curved) == 1:
        return _on_series(left, right, curved[0])
    if len(letters) != 1 or (degree := max(Poly(right, *letters).degree(), 0)) > MOST_POWER:
        return None
    if letters[0] not in right.free_symbols and not SIGN.search(with_plain_signs(source)):
        return None  # a rounded value, as in cos(x) ≈ 0.7
    return _on_polynomial(source, left, right, letters[0], degree)


class _Unknown(Exception):
    """Exception raised if comparing Taylor coefficients decides nothing.

    Two coefficients cannot be compared, or all up to the power MOST_POWER are equal, but the formulas are not proven
    equal.
    """


def _agree(own: Expr, other: Expr) -> bool:
    """Return whether two coefficients are equal; raise _Unknown if that is not decided."""
    verdict = decide(own, other).verdict
    if verdict not in ("true", "false"):
        raise _Unknown
    return verdict == "true"


def _on_series(left: Expr, right: Expr, letter: Symbol) -> Verdict:
    """Return the verdict on ``tan θ ≈ sin θ``, two formulas that are no polynomials in the small letter; raise _Unknown
    if comparing their Taylor coefficients decides nothing.
    """
    if decide(left, right).verdict == "true":
        return Verdict("true", notes=("both sides are equal",))
    series = zip(_coefficients(left, letter), _coefficients(right, letter), strict=True)
    agreed = False
    for power, (own, other) in enumerate(islice(series, MOST_POWER + 1)):
        if not _agree(own, other):
            break
        agreed = agreed or (power > 0 and not _agree(own, Integer(0)))
    else:
        raise _Unknown
    if not agreed:
        reason = f"for small {letter} the sides differ in the power {power}, but they may be close elsewhere"
        return Verdict("undecided", reason=reason)
    note = f"≈ is read for small {letter}: the sides agree up to the power {power - 1} of {letter}"
    difference = as_text((own - other) * letter**power)
    return Verdict("true", notes=(note, f"the first term of their difference is {difference}"))


def _on_polynomial(source: str, left: Expr, right: Expr, letter: Symbol, degree: int) -> Verdict:
    """Return the verdict on ``f ≈ p``: whether the polynomial p is the Taylor polynomial of f in the small
    ``letter``.
    """
    coefficients = _coefficients(left, letter)
    powers = list(islice(coefficients, degree + 1))
    agreed = [_agree(own, Poly(right, letter).coeff_monomial(letter**n)) for n, own in enumerate(powers)]
    higher = (own * letter**n for n, own in enumerate(islice(coefficients, MOST_LEFT_OUT), degree + 1))
    left_out = next((term for term in higher if term != 0), None)
    notes = [f"≈ is read for small {letter}, up to the power {degree} of {letter}"]
    notes += [f"the first term that is left out is {as_text(left_out)}"] if left_out is not None else []
    verdict = Verdict("true", notes=tuple(notes))
    if all(agreed):
        return verdict
    polynomial = _written(sum(own * letter**n for n, own in enumerate(powers)), source)
    # a rounded coefficient, or another polynomial, is no fault
    is_near = (
        agreed.count(False) == 1
        and re.search(r"\d\.\d", source) is None
        and any(own != 0 and is_right for own, is_right in zip(powers, agreed, strict=True))
    )
    if not is_near:
        reason = f"it is not the Taylor polynomial {polynomial} for small {letter}, but may be another approximation"
        return replace(verdict, verdict="undecided", reason=reason, notes=())
    text = f"the coefficient of the power {agreed.index(False)} of {letter} is wrong"
    sign = next(SIGN.finditer(source))
    repair = Repair(f"{source[: sign.start()].strip()} {sign[0]} {polynomial}", "derived", COST["factor"])
    return replace(verdict, verdict="false", diagnosis=Diagnosis("derived", text), repairs=(repair,))


def _written(formula: Any, source: str) -> str:
    """Return a formula in the notation of the text ``source``."""
    if is_latex(source):
        return LatexNotation().formula(read_expression(as_text(formula)))
    typed = as_text(formula).replace("**", "^")
    for sign in {*source} & {*LETTERS}:
        typed = re.sub(rf"\b{LETTERS[sign]}\b", sign, typed)
    return typed


def _coefficients(formula: Expr, letter: Symbol) -> Iterator[Expr]:
    """Yield the coefficients of the Taylor series of a formula about 0, from the power 0 of ``letter`` on.

    Raises
    ------
    InputError
        If the formula has no such series.
    """
    for power in count():
        value = formula.subs(letter, 0) / factorial(power)
        if not value.is_finite and value.is_finite is not None:
            raise InputError(f"expected a formula with a Taylor series for small {letter}")
        yield value
        formula = formula.diff(letter)
