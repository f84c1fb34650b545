"""Claims with a rounded decimal number, such as ``1500*2*pi/60 == 157.08``: true if the value rounds to the number."""

import math
import re
from dataclasses import replace
from fractions import Fraction

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import Node, negated, number, sum_of, walk
from symrot.checker.claim.values import decide_value
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.exact.intervals import enclosure

__all__ = ["rounded_value", "with_rounding"]

LONG_WHOLE = re.compile(r"[1-9]\d+[1-9]")
"""Pattern of an integer that may be a rounded number, such as 157: three digits or more, the first and last not 0."""


def with_rounding(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict "true" for a claim such as ``2/3 == 0.667``, whose decimal number is correctly rounded.

    A number with two dots after it, ``0.66..``, may also be truncated.

    For a wrong digit, return ``verdict`` with the diagnosis "digits" and the corrected claim as its repair, or the
    verdict "false" if the right digits cannot be written. Return ``verdict`` for any other claim.
    """
    if verdict.verdict not in ("false", "undecided") or claim.relation is None or claim.hypotheses or claim.define:
        return verdict
    source = claim.sources.get("claim", "")
    for side, value in (claim.relation[1:], claim.relation[:0:-1]):
        digits = _decimal(side, source) or _long_whole(side, source, value)
        if digits and not _decimal(value, source) and _is_constant(value):
            return _rounded(claim, verdict, value, digits, side)
    return verdict


def rounded_value(claim: Claim) -> str:
    """Return the value of ``claim.value`` rounded to as many decimal places as ``claim.printed`` has; "" if uncertain.

    ``claim.printed`` is the number that the document prints. A value that would round to zero is rounded to as many
    significant digits as the printed number has: for the value 4 % and a printed 0.5, return "0.04", not "0.0".
    Return "" if such a value is printed with a power of ten, as 5e-3, and if the power or the value exceeds the range
    of doubles.
    """
    assert claim.value is not None
    interval = enclosure(claim.interpreter().read(claim.value))
    if interval is None:
        return ""
    mantissa, _, power = claim.printed.strip().lower().partition("e")
    places = len(mantissa.partition(".")[2])
    try:
        middle = float(interval.mid) / 10.0 ** int(power or 0)
    except ArithmeticError:  # beyond the range of double precision
        return ""
    if middle and not re.search("[1-9]", f"{middle:.{places}f}"):
        if power:
            return ""
        places = len(re.sub(r"^-?[0.]+|\.", "", mantissa)) - 1 - math.floor(math.log10(abs(middle)))
    right = f"{middle:.{places}f}" + (f"e{power}" if power else "")
    return right if decide_value(replace(claim, printed=right)).verdict == "true" else ""


def _decimal(node: Node, source: str) -> str:
    """Return the digits of a decimal number as typed in ``source``, such as ``7.27e-5``; "" for other trees."""
    sign, inner = ("-", node.args[0]) if node.kind == "neg" else ("", node)
    mantissa, power = _scientific(inner)  # 7.27*10^-5 is one number
    digits = source[mantissa.span[0] : mantissa.span[1]]
    if mantissa.kind != "number" or "." not in digits or (power and "e" in digits.lower()):
        return ""
    return f"{sign}{digits}e{power}" if power else sign + digits


def _scientific(tree: Node) -> tuple[Node, int]:
    """Return (7.27, -5) for a product such as ``7.27*10^-5``; for any other tree, the tree itself and the power 0."""
    if tree.kind != "product" or len(tree.args) != 2 or tree.args[1].kind != "power":
        return tree, 0
    mantissa, (base, exponent) = tree.args[0], tree.args[1].args
    negative, whole = (True, exponent.args[0]) if exponent.kind == "neg" else (False, exponent)
    if base != number(10) or whole.kind != "number" or whole.value.denominator != 1:
        return tree, 0
    return mantissa, -int(whole.value) if negative else int(whole.value)


def _long_whole(node: Node, source: str, value: Node) -> str:
    """Return the digits of the integer ``node``, as typed in ``source``, if the integer may be ``value`` rounded.

    For instance, 157 may be ``1500*2*pi/60`` rounded. The value must contain pi, a function call such as a root, or a
    decimal number. Otherwise, and for nodes other than long integers, return "".
    """
    sign, inner = ("-", node.args[0]) if node.kind == "neg" else ("", node)
    digits = source[inner.span[0] : inner.span[1]]
    is_rough = any(  # pi, a root or a decimal number
        part.value == "pi" or (part.kind == "call" and part.args) or
        (part.kind == "number" and "." in source[part.span[0] : part.span[1]])
        for _, part in walk(value)
    )  # fmt: skip
    return sign + digits if inner.kind == "number" and is_rough and LONG_WHOLE.fullmatch(digits) else ""


def _is_constant(node: Node) -> bool:
    return all(part.value == "pi" for _, part in walk(node) if part.kind == "name")


def _begins_with(value_claim: Claim) -> bool:
    """Return whether the value in a claim begins with the digits printed for it, as 2/3 does with ``0.66..``."""
    assert value_claim.value is not None
    places = len(value_claim.printed.partition(".")[2])
    half = number(Fraction(5, 10 ** (places + 1)))
    middle = sum_of([value_claim.value, half if value_claim.printed.startswith("-") else negated(half)])
    return "e" not in value_claim.printed and decide_value(replace(value_claim, value=middle)).verdict == "true"


def _rounded(claim: Claim, verdict: Verdict, value: Node, digits: str, side: Node) -> Verdict:
    value_claim = replace(claim, relation=None, value=value, printed=digits)
    decision = decide_value(value_claim)
    source = claim.sources["claim"]
    if source.startswith("..", side.span[1]) and _begins_with(value_claim):
        note = f"to the digits given: the value begins with {digits}"
        return Verdict("true", dimension=verdict.dimension, notes=(*verdict.notes, note), seconds=verdict.seconds)
    if decision.verdict == "true":
        note = f"to the digits given: the value rounds to {digits}"
        return Verdict("true", dimension=verdict.dimension, notes=(*verdict.notes, note), seconds=verdict.seconds)
    right = rounded_value(value_claim)
    if "." not in right and not LONG_WHOLE.fullmatch(right.removeprefix("-")):
        right = ""  # a short integer is an exact number
    if not right and decision.verdict == "false":  # the right digits cannot be written in its place
        return replace(verdict, verdict="false", counterexample=decision.counterexample, reason="")
    if not right:
        return verdict
    diagnosis = Diagnosis("digits", f"a decimal number has a wrong digit: the value rounds to {right}, not to {digits}")
    start, end = _scientific(side.args[0] if side.kind == "neg" else side)[0].span
    mantissa, _, power = right.partition("e")
    is_whole = power and Fraction(right).denominator == 1  # 0.16e3 would be printed as the exact number 160
    written = mantissa if end != side.span[1] else f"{mantissa}*10**{power}" if is_whole else right
    if side.kind == "neg":  # the sign is written again, since it may be wrong
        is_bracketed = source[side.span[0] : start].strip() not in ("-", "−")
        start, end, written = (*side.span, right) if is_bracketed else (side.span[0], end, written)
    repair = Repair(source[:start] + written + source[end:], "digits", 1.0)
    witness = decision.counterexample
    if witness is not None and side is claim.relation[1]:  # type: ignore[index]
        witness = replace(witness, left=witness.right, right=witness.left)
    return replace(verdict, counterexample=witness or verdict.counterexample, diagnosis=diagnosis, repairs=(repair,))
