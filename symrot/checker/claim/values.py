"""Worked numbers of a document: the exact value of a formula, compared with the decimal number printed for it."""

import re
from fractions import Fraction
from math import isfinite

from mpmath import iv, mpf, nstr

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.scope import described, is_matrix
from symrot.checker.decide.decision import decide_equation
from symrot.checker.decide.equation import Equation
from symrot.checker.typed.tokens import LONGEST_NUMBER
from symrot.errors import InputError
from symrot.exact.decision import Decision
from symrot.exact.evidence import Counterexample
from symrot.exact.intervals import enclosure
from symrot.exact.printing import as_text

__all__ = ["decide_value"]

MORE_DIGITS = 30
"""A value is computed to ``len(printed) + MORE_DIGITS`` digits, where ``printed`` is the text of the printed number."""

_DECIMAL = re.compile(r"\s*([+-]?)(\d*)(?:\.(\d*))?(?:[eE]([+-]?\d{1,3}))?\s*", re.ASCII)


def decide_value(claim: Claim) -> Decision:
    """Decide whether a value lies within half a unit of the last digit of the number that is printed for it.

    Raises
    ------
    InputError
        If the value contains symbols or is a matrix, or the printed text is not a decimal number.
    """
    assert claim.value is not None
    where = claim.label("value")
    interpreter = claim.interpreter()
    value = interpreter.read(claim.value, claim.sources.get("value", ""), where)
    if is_matrix(value):
        raise InputError(f"{where}: expected a number, got {described(value)}")
    if getattr(value, "free_symbols", {1}):
        raise InputError(f"{where}: expected a number, got {as_text(value)}")
    printed, unit = _printed(claim.printed, claim.label("printed_value"))
    divisors = tuple(divisor.value for divisor in interpreter.divisors)
    if divisors or interpreter.radicands:  # constants whose signs are not known yet
        decision = decide_equation(Equation(value, value, (), divisors, (), tuple(interpreter.radicands)))
        if decision.verdict != "true":
            return Decision("undecided", reason=f"it is not known that {as_text(value)} is a real number")
    if value.is_Rational and abs(Fraction(int(value.p), int(value.q)) - printed) <= unit / 2:
        return Decision("true")  # 4.905 rounds to 4.91 and, by another rule, to 4.90
    interval = enclosure(value, digits=len(claim.printed) + MORE_DIGITS)
    if interval is None:
        return Decision("undecided", reason=f"no interval is known that encloses {as_text(value)}")
    low, high = (iv.mpf(int(n.numerator)) / int(n.denominator) for n in (printed - unit / 2, printed + unit / 2))
    if low.b <= interval.a and interval.b <= high.a:
        return Decision("true")
    if interval.b < low.a or high.b < interval.a:
        exact = f"{as_text(value)} = {_rounded(mpf(interval.mid))}.."
        return Decision("false", counterexample=Counterexample((), None, exact, claim.printed.strip()))
    return Decision(
        "undecided",
        reason="the value is too close to the middle between two roundings to tell its last digit",
    )


def _rounded(value: mpf) -> str:
    """Return a number with at most 12 digits as text, also one beyond the range of a float."""
    number = float(value)
    return f"{number:.12g}" if isfinite(number) and (number or not value) else nstr(value, 12)


def _printed(text: str, where: str) -> tuple[Fraction, Fraction]:
    """Return the decimal number in a text, and one unit of its last digit: 157.08 and 0.01 for ``157.08``."""
    match = _DECIMAL.fullmatch(text)
    if match is None or not (match[2] or match[3]) or len(text) > LONGEST_NUMBER:
        raise InputError(
            f"{where}: expected a decimal number of at most {LONGEST_NUMBER} characters, got {text[:40]!r}"
        )
    scale = Fraction(10) ** (int(match[4] or 0) - len(match[3] or ""))
    digits = int((match[2] or "") + (match[3] or ""))
    return (-digits if match[1] == "-" else digits) * scale, scale
