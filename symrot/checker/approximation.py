"""Approximations for small values of a letter, ``sin θ ≈ θ``: the right side should be a Taylor polynomial."""

import re
from dataclasses import replace
from math import factorial
from time import perf_counter
from typing import Any

from sympy import Expr, Poly, Symbol

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.source.text import claim_of_text, is_latex
from symrot.checker.claim_verdict import within_limits
from symrot.checker.latex.writing import LatexNotation
from symrot.checker.repair.edits.faults import COST
from symrot.checker.typed.copied_signs import with_plain_signs
from symrot.checker.typed.tokens import LETTERS
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.errors import InputError
from symrot.exact.decide import decide
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = ["verdict_on_approximation"]

SIGN = re.compile(r"≈|≃|\\(?:approx|simeq)(?![A-Za-z])")
MOST_POWER, MOST_LEFT_OUT = 8, 4
"""The highest power of the small letter, and the most powers above that of the right side that are looked at."""


def verdict_on_approximation(source: str) -> Verdict | None:
    """Return the verdict on ``f ≈ p``: "true" if p is the Taylor polynomial of f for small values of the only letter in
    which p is a polynomial and f is not. None for other texts.
    """
    if len(SIGN.findall(source)) != 1 or re.search("[=<>]", source):
        return None
    start = perf_counter()
    try:
        with within_limits():
            equation = claim_of_text(SIGN.sub("=", source)).equation
            left, right = equation.left, equation.right
            if is_matrix(left) or is_matrix(right):
                return None
            letters = [s for s in left.free_symbols if right.is_polynomial(s) and not left.is_polynomial(s)]
            if len(letters) != 1 or (degree := max(Poly(right, *letters).degree(), 0)) > MOST_POWER:
                return None
            if letters[0] not in right.free_symbols and not SIGN.search(with_plain_signs(source)):
                return None  # a rounded value, as in cos(x) ≈ 0.7
            return _compared(source, left, right, letters[0], degree, start)
    except (InputError, TooLarge):
        return None


def _compared(source: str, left: Expr, right: Expr, letter: Symbol, degree: int, start: float) -> Verdict | None:
    powers = [_term(left, letter, power) for power in range(degree + 1)]
    agreed = [decide(own, Poly(right, letter).coeff_monomial(letter**n)).verdict for n, own in enumerate(powers)]
    if not {*agreed} <= {"true", "false"}:
        return None
    higher = (_term(left, letter, degree + 1 + n) * letter ** (degree + 1 + n) for n in range(MOST_LEFT_OUT))
    left_out = next((term for term in higher if term != 0), None)
    notes = [f"≈ is read for small {letter}, up to the power {degree} of {letter}"]
    notes += [f"the first term that is left out is {as_text(left_out)}"] if left_out is not None else []
    verdict = Verdict("true", text=source.strip(), notes=tuple(notes), seconds=perf_counter() - start)
    if "false" not in agreed:
        return verdict
    polynomial = _written(sum(own * letter**n for n, own in enumerate(powers)), source)
    # a rounded coefficient, or another polynomial, is no fault
    is_near = (
        agreed.count("false") == 1
        and re.search(r"\d\.\d", source) is None
        and any(own != 0 and word == "true" for own, word in zip(powers, agreed, strict=True))
    )
    if not is_near:
        reason = f"it is not the Taylor polynomial {polynomial} for small {letter}, but may be another approximation"
        return replace(verdict, verdict="undecided", reason=reason, notes=())
    text = f"the coefficient of the power {agreed.index('false')} of {letter} is wrong"
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


def _term(formula: Expr, letter: Symbol, power: int) -> Expr:
    """Return the coefficient of ``letter**power`` in the Taylor series of a formula about 0.

    Raises
    ------
    InputError
        If the formula has no such series.
    """
    value = formula.diff(letter, power).subs(letter, 0) / factorial(power)
    if not value.is_finite and value.is_finite is not None:
        raise InputError(f"expected a formula with a Taylor series for small {letter}")
    return value
