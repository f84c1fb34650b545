"""Verdicts on numbers with units, such as ``1500 rpm = 157.08 rad/s``, and on angles whose unit was left out."""

import re
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.notation import decimal
from symrot.checker.claim.tree import Node, number, product, walk
from symrot.checker.claim.values import decide_value
from symrot.checker.rounding import rounded_value
from symrot.checker.units.check import check_dimensions
from symrot.checker.units.conversion import Measured
from symrot.checker.units.units import unit_text
from symrot.checker.verdict import Diagnosis, Repair, Verdict
from symrot.errors import InputError

__all__ = ["in_degrees", "with_units"]

TRIGONOMETRIC = ("sin", "cos", "tan", "cot", "sec", "csc")
DECIMAL, ROUNDED_WHOLE = r"\d+\.\d+(?:[eE][+-]?\d+)?", r"[1-9]\d*[1-9]"
"""Patterns of a decimal number, and of a whole number of two or more digits that may have been rounded to ones, such as
37. A number that ends with 0 does not match: 40 may have been rounded to tens or to ones."""

LONG_WHOLE = 3
"""The smallest number of digits of a whole number that may be a rounded rational value, as in 1 hp = 746 W."""

LEAST_DEGREES = 7
"""A number of at least this size, such as 30 in ``sin(30)``, is probably an angle in degrees: 2 pi is 6.28."""

TYPED_ANGLE = re.compile(
    rf"\\?(?<![A-Za-z])(?:{'|'.join(TRIGONOMETRIC)})(?:\^(?:\d+|\{{\d+\}})|[²³])?\s*(?:\\left\s*)?[({{]?\s*"
    r"(?P<number>\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)(?![\w.°^])"
)
"""Pattern of a trigonometric function in a text and the number at the start of its argument, as in ``sin(30)``."""


def with_units(claim: Claim, measured: Measured, decide: Callable[[Claim], Verdict]) -> Verdict:
    """Return the verdict on a claim whose numbers have units, as ``1500 rpm = 157.08 rad/s``.

    Parameters
    ----------
    claim : Claim
        The claim, in which a name stands for each product of units.
    measured : Measured
        The typed text, and the unit for each of these names.
    decide : callable
        The function that decides a claim without units.

    Raises
    ------
    InputError
        For a sum of terms in different units.
    """
    assert claim.relation is not None
    units = {name: unit_text(unit.dimension) for name, unit in measured.units.items()}
    dimensions = check_dimensions(claim.relation[1:], units=units)
    if dimensions.status == "inconsistent" and "the sum" in dimensions.text:
        raise InputError(f"expected terms with one unit, got a sum in which {measured.restored(dimensions.text)}")
    if dimensions.status == "inconsistent" and measured.is_sure:
        diagnosis = Diagnosis("dimension", f"the units do not fit: {dimensions.text}")
        return Verdict("false", dimension=dimensions, diagnosis=diagnosis)
    sign, *sides = claim.relation
    factors = {name: unit.factor for name, unit in measured.units.items()}
    left, right = (_in_si(side, factors) for side in sides)
    plain = claim.with_relation((sign, left, right), units={}, alternatives=())
    rounded = _rounded(plain, sides, factors, measured)
    verdict = decide(plain) if rounded is None else rounded
    if verdict.verdict == "false" and verdict.diagnosis.code != "digits":
        verdict = replace(verdict, **_right_number(plain, sides, factors, measured))
    factors_in_words = [unit.note for unit in measured.units.values() if unit.note]
    return replace(verdict, dimension=dimensions, notes=(*verdict.notes, *factors_in_words))


def _right_number(claim: Claim, sides: list[Node], factors: dict[str, Node], measured: Measured) -> dict[str, Any]:
    """Return {"diagnosis": .., "repairs": ..} that correct the number on the right side: 200 for ``2 m = 300 cm``.

    If the right side is not a whole number with a unit, or if no rational number makes the claim true, the diagnosis
    has the code "none", and there are no repairs.
    """
    # sides: with names in place of units; factors: name of a unit -> its factor to SI units
    left, right = sides
    digits, unit = _decimal(right, measured.text, r"\d+")
    try:
        value = claim.interpreter().read(product([_in_si(left, factors), Node("inv", None, (factors[unit],))]))
    except (InputError, KeyError):
        value = None
    # no number of digits can be right
    if not getattr(value, "is_Rational", False):
        return {"diagnosis": Diagnosis("none", ""), "repairs": ()}
    unit_typed = measured.units[unit].text
    sentence = f"a number is wrong: the value is {value} {unit_typed}, not {digits}"
    repairs = _with_number(measured.source, digits, unit_typed, f"{value}" if value.q == 1 else f"({value})", True)
    return {"diagnosis": Diagnosis("digits", sentence), "repairs": repairs}


def _in_si(tree: Node, factors: dict[str, Node]) -> Node:
    """Return a tree with the factors to SI units in place of the names of units: 1500 times pi/30 for 1500 rpm."""
    if tree.kind == "name" and tree.value in factors:
        return factors[str(tree.value)]
    return replace(tree, args=tuple(_in_si(child, factors) for child in tree.args))


def _rounded(claim: Claim, sides: list[Node], factors: dict[str, Node], measured: Measured) -> Verdict | None:
    """Return the verdict on an equation with a rounded number and unit on one side.

    Return None for other equations, and if it is undecided whether the value rounds to this number.
    """
    verdicts = []
    for side, other in (sides, sides[::-1]):
        digits, unit = _decimal(side, measured.text)
        other_digits, _ = _decimal(other, measured.text)
        is_decimal = bool(digits)
        if not is_decimal:
            digits, unit = _decimal(side, measured.text, ROUNDED_WHOLE)
        if not digits or not all(n.value == "pi" or n.value in factors for _, n in walk(other) if n.kind == "name"):
            continue
        if other_digits and len(other_digits) > len(digits):
            continue
        value = product([_in_si(other, factors), Node("inv", None, (factors[unit],))])
        is_percentage = measured.units[unit].text == "%"
        is_long = len(digits) >= LONG_WHOLE
        if not is_decimal and not is_percentage and not is_long and not _is_irrational(claim, value):
            continue
        value_claim = replace(claim, relation=None, value=value, printed=digits, hypotheses=())
        verdicts.append(_to_digits(value_claim, measured, measured.units[unit].text, is_right=side is sides[1]))
    words = ["undecided" if verdict is None else verdict.verdict for verdict in verdicts]
    return next((verdicts[words.index(word)] for word in ("true", "undecided", "false") if word in words), None)


def _is_irrational(claim: Claim, value: Node) -> bool:
    """Return whether the value of the tree ``value`` is irrational."""
    number_of_unit = claim.interpreter().read(value)
    return bool(getattr(number_of_unit, "is_number", False)) and not number_of_unit.is_Rational


def _to_digits(value_claim: Claim, measured: Measured, unit: str, is_right: bool) -> Verdict | None:
    """Return the verdict on whether a value rounds to the number that a text states for it; None if undecided.

    ``value_claim`` has the value of one side of the equation, in the unit of the number, and the digits of the number.
    ``measured`` is the typed equation. In it, ``unit`` is the unit after the number, and ``is_right`` says whether the
    number is on the right side. The verdict "false" has a repair if the correct digits can be computed.
    """
    digits = value_claim.printed
    decision = decide_value(value_claim)
    if decision.verdict == "true":
        return Verdict("true", notes=(f"to the digits given: the value rounds to {digits} {unit}",))
    if decision.verdict != "false":
        return None
    right = rounded_value(value_claim)
    if not right:
        return Verdict("false", counterexample=decision.counterexample)
    sentence = f"a number is wrong: the value rounds to {right} {unit}, not to {digits}"
    repairs = _with_number(measured.source, digits, unit, right, is_right)
    return Verdict(
        "false", counterexample=decision.counterexample, diagnosis=Diagnosis("digits", sentence), repairs=repairs
    )


def _with_number(source: str, digits: str, unit: str, correct: str, on_right_side: bool) -> tuple[Repair, ...]:
    """Return (repair,): the text ``source`` with the number ``correct`` in place of ``digits`` before ``unit``.

    If the digits occur several times, replace the last ones if the wrong number is on the right side of the equation,
    else the first. Return () if they do not occur.
    """
    places = [*re.finditer(rf"(?<![\w.^]){re.escape(digits)}(?=[ *·⋅]*{re.escape(unit)})", source)]
    if not places:
        return ()
    start, end = places[-1 if on_right_side else 0].span()
    return (Repair((source[:start] + correct + source[end:]).strip(), "digits", 1.0),)


def _decimal(tree: Node, source: str, pattern: str = DECIMAL) -> tuple[str, str]:
    """Return (digits, name of the unit) for a number times a unit; ("", "") for any other tree.

    157.08 rad/s gives ("157.08", "unit_1") if the claim has the name unit_1 in place of rad/s. ``pattern`` must match
    all digits.
    """
    if tree.kind != "product" or len(tree.args) != 2 or [part.kind for part in tree.args] != ["number", "name"]:
        return "", ""
    first, unit = tree.args
    digits = source[first.span[0] : first.span[1]]
    return (digits, str(unit.value)) if re.fullmatch(pattern, digits) else ("", "")


def in_degrees(claim: Claim, verdict: Verdict, decide: Callable[[Claim], Verdict]) -> Verdict:
    """Return ``verdict`` with a note on the verdict in degrees, for a claim with angles such as 30 in ``sin(30)``.

    If the claim is false in radians and true in degrees, return the verdict with a repair instead. Return it unchanged
    for claims without such angles, and if the claim in degrees cannot be decided.
    """
    if claim.relation is None:
        return verdict
    sign, left, right = claim.relation
    angles = [n.args[0] for side in (left, right) for _, n in walk(side) if _is_large_angle(n)]
    if not angles:
        return verdict
    changed = claim.with_relation((sign, _degrees(left), _degrees(right)), alternatives=())
    try:
        other = decide(changed)
    except InputError:
        return verdict
    numbers = " and ".join(sorted({decimal(angle.value) for angle in angles}))
    note = f"the angle {numbers} is in radians; in degrees, written {numbers}°, the claim is {other.verdict}"
    # false in radians and true in degrees: a diagnosis with a repair
    if verdict.verdict == "false" and other.verdict == "true":
        diagnosis = Diagnosis("degrees", f"the angle {numbers} is in degrees, but is read in radians")
        repairs = _with_degree_signs(claim.sources.get("claim", ""), len(angles))
        return replace(verdict, diagnosis=diagnosis, repairs=repairs)
    return replace(verdict, notes=(*verdict.notes, note))


def _with_degree_signs(source: str, count: int) -> tuple[Repair, ...]:
    """Return (repair,): the text ``source`` with a degree sign after each angle that is probably in degrees.

    Such an angle is a number of at least LEAST_DEGREES at the start of the argument of a trigonometric function.
    ``count`` is the number of such angles in the claim that was read from the text. Return () if the text has more or
    fewer.
    """
    degree = "^\\circ" if "\\" in source else "°"
    ends = [match.end() for match in TYPED_ANGLE.finditer(source) if float(match["number"]) >= LEAST_DEGREES]
    if len(ends) != count:
        return ()
    parts = [source[start:end] for start, end in pairwise((0, *ends, len(source)))]
    return (Repair(degree.join(parts), "degrees", 0.5),)


def _is_large_angle(node: Node) -> bool:
    """Return whether a tree is a trigonometric function of a number of at least LEAST_DEGREES, such as ``sin(30)``."""
    is_function = node.kind == "call" and node.value in TRIGONOMETRIC
    return is_function and node.args[0].kind == "number" and node.args[0].value >= LEAST_DEGREES


def _degrees(tree: Node) -> Node:
    """Return a tree with ``sin(30*pi/180)`` for ``sin(30)``.

    A number of at least LEAST_DEGREES as the argument of a trigonometric function is taken as an angle in degrees.
    """
    args = tuple(map(_degrees, tree.args))
    if _is_large_angle(tree):
        args = (product([tree.args[0], Node("name", "pi"), number(Fraction(1, 180))]),)
    return replace(tree, args=args)
