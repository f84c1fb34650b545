"""Claims with a rounded decimal number, such as ``1500*2*pi/60 == 157.08``: true if the value rounds to the number."""

import re
from dataclasses import replace

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.tree import Node, walk
from symrot.checker.claim.values import decide_value
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.exact.intervals import enclosure

__all__ = ["rounded_value", "with_rounding"]


def with_rounding(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict "true" for a claim that equates a value and a decimal number to which the value rounds.

    If the value does not round to the number, the diagnosis gives the correct digits. Every other verdict is
    returned unchanged.
    """
    if verdict.verdict not in ("false", "undecided") or claim.relation is None or claim.hypotheses or claim.define:
        return verdict
    source = claim.sources.get("claim", "")
    for number, value in (claim.relation[1:], claim.relation[:0:-1]):
        digits = _decimal(number, source) or _long_whole(number, source, value)
        if digits and not _decimal(value, source) and _is_constant(value):
            return _rounded(claim, verdict, value, digits, number.span)
    return verdict


def rounded_value(claim: Claim) -> str:
    """Return the value of a worked number as text, rounded to as many digits as the document prints.

    The text is empty if the value is not known well enough, or if the printed number has a power of ten.
    """
    assert claim.value is not None
    interval = enclosure(claim.interpreter().read(claim.value))
    if interval is None or "e" in claim.printed.lower():
        return ""
    places = len(claim.printed.strip().partition(".")[2])
    right = f"{float(interval.mid):.{places}f}"
    return right if decide_value(replace(claim, printed=right)).verdict == "true" else ""


def _decimal(node: Node, source: str) -> str:
    """Return the digits of a tree that is a decimal number, as they were typed; an empty text for any other tree."""
    sign, inner = ("-", node.args[0]) if node.kind == "neg" else ("", node)
    digits = source[inner.span[0] : inner.span[1]]
    return sign + digits if inner.kind == "number" and "." in digits else ""


def _long_whole(node: Node, source: str, value: Node) -> str:
    """Return the digits of a whole number that must be rounded, such as 157 for ``1500*2*pi/60``; otherwise "".

    It has at least three digits, the last one not 0, and the value has pi, a root or a decimal number.
    """
    sign, inner = ("-", node.args[0]) if node.kind == "neg" else ("", node)
    digits = source[inner.span[0] : inner.span[1]]
    is_rough = any(
        part.value == "pi" or (part.kind == "call" and part.args) or
        (part.kind == "number" and "." in source[part.span[0] : part.span[1]])
        for _, part in walk(value)
    )  # fmt: skip
    return sign + digits if inner.kind == "number" and is_rough and re.fullmatch(r"[1-9]\d+[1-9]", digits) else ""


def _is_constant(node: Node) -> bool:
    return all(part.value == "pi" for _, part in walk(node) if part.kind == "name")


def _rounded(claim: Claim, verdict: Verdict, value: Node, digits: str, place: tuple[int, int]) -> Verdict:
    worked = replace(claim, relation=None, value=value, printed=digits)
    decision = decide_value(worked)
    if decision.verdict == "true":
        note = f"to the digits given: the value rounds to {digits}"
        return Verdict("true", dimension=verdict.dimension, notes=(*verdict.notes, note), seconds=verdict.seconds)
    right = rounded_value(worked)
    if not right:
        return verdict
    source = claim.sources["claim"]
    repair = Repair(source[: place[0]] + right + source[place[1] :], "digits", 1.0)
    diagnosis = Diagnosis("digits", f"a decimal number has a wrong digit: the value rounds to {right}, not to {digits}")
    return replace(verdict, diagnosis=diagnosis, repairs=(repair,))
