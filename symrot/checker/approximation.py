"""Approximations for small values of a letter: ``sin θ ≈ θ`` and ``sin θ = θ + O(θ³)``.

Both sides should have the same Taylor polynomial.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import count, islice
from math import factorial
from time import perf_counter
from typing import Any

from sympy import Abs, DiracDelta, Expr, Heaviside, Integer, Max, Min, Piecewise, Poly, Symbol, nan, oo, sign, zoo
from sympy.core.function import AppliedUndef

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
from symrot.exact.decision import flatten
from symrot.exact.limits.operations import OutOfOperations
from symrot.exact.printing import as_text

__all__ = ["verdict_on_approximation"]

SIGN = re.compile(r"≈|≃|\\(?:approx|simeq)(?![A-Za-z])")
ORDER = re.compile(
    r"[+\-−±]\s*(?P<sign>\\mathcal\s*\{?\s*O\s*\}?|\\mathcal O|[Oo])\s*(?:\\left)?\s*\("
    r"\s*(?P<letter>\\?[A-Za-z]+|[α-ω])\s*(?:(?:\^|\*\*)\s*(?:(?P<power>\d+)|\{\s*(?P<braced>\d+)\s*\})|(?P<raised>[²³⁴-⁹]))?"
    r"\s*(?:\\right)?\s*\)\s*[.,]?\s*$"
)
"""Pattern of the order of the terms that are left out, at the end of a text: ``+ O(θ^3)``."""
RAISED = str.maketrans("²³⁴⁵⁶⁷⁸⁹", "23456789")
NOT_SMOOTH = (Abs, sign, DiracDelta, Heaviside, Max, Min, Piecewise)
MOST_POWER, MOST_LEFT_OUT = 8, 4
"""MOST_POWER is the highest power of x whose Taylor coefficients are compared for ``sin(x) ≈ x``, read for small x.

The first term that the right side omits, here ``-x^3/6``, is sought among its next MOST_LEFT_OUT powers, x^2 to x^5."""


def verdict_on_approximation(source: str) -> Verdict | None:
    """Return the verdict on ``f ≈ g`` for small values of a letter; None for other texts.

    The small letter, x in ``sin(x) ≈ x``, is a symbol in which f is no polynomial. If g is a polynomial in exactly one
    such symbol, g should be the Taylor polynomial of f in it. If f has a single such symbol, and g is no polynomial in
    it either, as in ``tan θ ≈ sin θ``, both Taylor series should agree in their first terms, one of which must be
    nonzero and contain the symbol.

    Return the verdict on ``f = g + O(x^n)``, too: f - g should have no powers of x below n, and none below n + 1 for a
    small o.
    """
    if (order := ORDER.search(source)) and re.search("[=<>]", source[: order.start()]):
        return _of_order(source, order)
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


def _of_order(source: str, order: re.Match[str]) -> Verdict | None:
    """Return the verdict on ``f = g + O(x^n)``; None for an equation without x.

    Raise InputError for sides that cannot be read.
    """
    start, text = perf_counter(), source.strip()
    try:
        with within_limits():
            verdict = _verdict_on_order(source[: order.start()], order)
    except (OutOfOperations, TimeUp) as limit:
        return verdict_of_decision(unfinished(limit), text, start)
    except _Unknown:
        verdict = Verdict("undecided", reason=f"the Taylor series for small {order['letter']} is not known")
    return verdict and replace(verdict, text=text, seconds=perf_counter() - start)


def _verdict_on_order(source: str, order: re.Match[str]) -> Verdict | None:
    equation = claim_of_text(source).equation
    small = claim_of_text(f"{order['letter']} = 0").equation.left
    (lefts, shape), (rights, other) = flatten(equation.left), flatten(equation.right)
    name = str(small)
    letters = {symbol for entry in (*lefts, *rights) for symbol in entry.free_symbols}
    letter = next((symbol for symbol in letters if str(symbol) == name), None)
    if letter is None or shape != other:
        return None
    power = int((order["power"] or order["braced"] or order["raised"] or "1").translate(RAISED))
    written = f"{name}^{power}" if power > 1 else name
    least = power + (order["sign"] == "o")
    own = {symbol for entry in lefts for symbol in entry.free_symbols}
    if letters - own or letter not in own:
        reason = f"{order['sign']}({written}) stands for terms that are left out, and the equation may define a name"
        return Verdict("definition", reason=reason)
    if any(entry.has(AppliedUndef) for entry in (*lefts, *rights)):
        return Verdict("undecided", reason="Taylor series of functions of time are not compared")
    if least > MOST_POWER + 1:
        return Verdict("undecided", reason=f"orders above {MOST_POWER} are not compared")
    note = (
        f"{order['sign']}({written}) is read as terms with {name}^{least} and higher powers of {name}, for small {name}"
    )
    try:
        for left, right in zip(lefts, rights, strict=True):
            for n, coefficient in enumerate(islice(_coefficients(left - right, letter), least)):
                if not _agree(coefficient, Integer(0)):
                    term = as_text(coefficient * letter**n)
                    text = f"the sides differ by {term}, a term of the order {n}, for small {name}"
                    return Verdict("false", notes=(note,), diagnosis=Diagnosis("derived", text))
    except InputError:
        raise _Unknown from None
    return Verdict("true", notes=(note,))


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
    mark = next(SIGN.finditer(source))
    repair = Repair(f"{source[: mark.start()].strip()} {mark[0]} {polynomial}", "derived", COST["factor"])
    return replace(verdict, verdict="false", diagnosis=Diagnosis("derived", text), repairs=(repair,))


def _written(formula: Any, source: str) -> str:
    """Return a formula in the notation of the text ``source``."""
    if is_latex(source):
        return LatexNotation().formula(read_expression(as_text(formula)))
    typed = as_text(formula).replace("**", "^")
    for mark in {*source} & {*LETTERS}:
        typed = re.sub(rf"\b{LETTERS[mark]}\b", mark, typed)
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
        is_infinite = value.has(nan, zoo, oo) or value.is_finite is False
        if is_infinite or any(letter in part.free_symbols for part in formula.atoms(*NOT_SMOOTH)):
            raise InputError(f"expected a formula with a Taylor series for small {letter}")
        yield value
        formula = formula.diff(letter)
