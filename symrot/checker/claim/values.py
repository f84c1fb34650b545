"""Worked numbers: an exact value against the decimal that was printed for it."""

import re
from fractions import Fraction

from mpmath import iv

from symrot.checker.claim.claims import Claim
from symrot.checker.decide.decision import Decision, Problem, decide_problem, shown
from symrot.checker.verdict import Counterexample
from symrot.errors import InputError
from symrot.exact.intervals import enclosure

__all__ = ["decide_value"]

_DECIMAL = re.compile(r"\s*([+-]?)(\d*)(?:\.(\d*))?(?:[eE]([+-]?\d{1,3}))?\s*", re.ASCII)


def decide_value(claim: Claim) -> Decision:
    """Return whether a value rounds to the printed decimal: it lies within half a unit of the last printed digit.

    Raises
    ------
    InputError
        If the value holds symbols, or the printed text is no decimal number.
    """
    assert claim.value is not None
    where = claim.label("value")
    meaning = claim.meaning()
    value = meaning.read(claim.value, claim.sources.get("value", ""), where)
    if getattr(value, "free_symbols", {1}):
        raise InputError(f"{where}: expected a number, got {shown(value)}")
    printed, unit = _printed(claim.printed, claim.label("printed_value"))
    divisors = tuple(divisor.value for divisor in meaning.divisors)
    if divisors or meaning.radicands:  # constants about which nothing is known so far
        decision = decide_problem(Problem(value, value, (), divisors, (), tuple(meaning.radicands)))
        if decision.verdict != "true":
            return Decision("undecided", reason=f"it is not known that {shown(value)} is a real number")
    held = enclosure(value)
    if held is None:
        return Decision("undecided", reason=f"no enclosure of {shown(value)} is known here")
    low, high = (iv.mpf(int(n.numerator)) / int(n.denominator) for n in (printed - unit / 2, printed + unit / 2))
    if low.b <= held.a and held.b <= high.a:
        return Decision("true")
    if held.b < low.a or high.b < held.a:
        exact = f"{shown(value)} = {float(held.mid):.12g}.."
        return Decision("false", counterexample=Counterexample({}, exact, claim.printed.strip()))
    return Decision("undecided", reason="the value lies on the edge of what rounds to the printed digits")


def _printed(text: str, where: str) -> tuple[Fraction, Fraction]:
    """Return the printed number and one unit of its last digit."""
    match = _DECIMAL.fullmatch(text)
    if match is None or not (match[2] or match[3]):
        raise InputError(f"{where}: expected a decimal number, got {text[:40]!r}")
    scale = Fraction(10) ** (int(match[4] or 0) - len(match[3] or ""))
    digits = int((match[2] or "") + (match[3] or ""))
    return (-digits if match[1] == "-" else digits) * scale, scale
