"""Verdicts on claims that are true if a guess is right, such as which letter belongs to which axis.

The verdict on such a claim is not "true" but "recognised" (equal to a derived formula), with a note on the guess.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from symrot.checker.context.admission import EXCHANGED, guesses, plain, same_rotation
from symrot.checker.context.context import Context
from symrot.checker.context.meant_formulas import SIDES
from symrot.checker.recognition.renaming import is_consistent
from symrot.checker.verdict import Identification, Verdict

__all__ = ["with_axes", "with_guesses", "with_order", "with_sides", "with_tangent"]

TANGENT = "about a tangent"


def with_order(context: Context, verdict: Verdict, letters: Sequence[str]) -> Verdict:
    """Return the verdict, but "recognised" in place of "true" if the claim uses phi and psi in an unusual order."""
    angles = [letter for letter in letters if letter in ("phi", "psi", "dphi", "dpsi")]
    # an order that words state is not unusual
    if not context.sequence or not angles or any(context.meaning_of(letter.removeprefix("d")) for letter in angles):
        return verdict
    # psi is usually the first angle of ZYX (yaw, pitch, roll), phi that of other sequences
    usual = context.sequence == "ZYX"
    reverse = same_rotation(context.sequence)
    readings = [
        known
        for known in verdict.recognised_as
        if _is_exchanged(known) == (usual != bool(reverse and reverse in known.name))
    ]
    if readings:
        return replace(verdict, recognised_as=tuple(readings))
    first, third = ("phi", "psi") if usual else ("psi", "phi")
    note = f"guessed, not stated: {first} is the first angle of {context.sequence}, and {third} the third"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def with_sides(verdict: Verdict) -> Verdict:
    """Return the verdict, but "recognised" in place of "true" if the axes of the sides a, b, c of a body were guessed.

    For instance, the letter a in a claim about a box may mean the side along y; in symrot's formulas it is the side
    along x.
    """
    readings = [known for known in verdict.recognised_as if not any(re.fullmatch(SIDES, old) for old in known.mapping)]
    # known formulas call the sides, or semi-axes, along x, y and z a, b and c: without renaming, nothing is guessed
    if readings:
        return replace(verdict, recognised_as=tuple(readings))
    note = "guessed, not stated: which letter is the side along which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def with_tangent(context: Context, verdict: Verdict) -> Verdict:
    """Return the verdict, but "recognised" in place of "true" if the tangent of a disk was read as normal to the disk.

    With the words "about a tangent" in the context, the claim then equals the formula for the axis through a point of
    the rim that is perpendicular to the plane of the disk or ring. Most authors mean a tangent in this plane.
    """
    places = {context.place, *(meaning.place for meaning in context.meanings)}
    normal = all(known.name.endswith("rim, z axis") for known in verdict.recognised_as)
    if TANGENT not in places or not normal or (context.body and context.body.axes):
        return verdict
    note = "guessed, not stated: the axis at the rim is normal to the plane of the body, not a tangent in that plane"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def with_axes(context: Context, verdict: Verdict) -> Verdict:
    """Return the verdict, but "recognised" in place of "true" if the axis of a letter such as I_1 was guessed."""
    stated = set(context.body.letters.values()) if context.body else set()
    readings = [
        known
        for known in verdict.recognised_as
        if is_consistent([(old, new) for old, new in known.mapping.items()
                          if new not in stated and context.meaning_of(plain(new)) is None], fixed=True)
    ]  # fmt: skip
    # nothing is guessed if I_1 is the moment about the first axis, or if words state the axis
    if readings:
        return replace(verdict, recognised_as=tuple(sorted(readings, key=lambda k: context.sequence not in k.name)))
    note = "guessed, not stated: which letter belongs to which axis"
    return replace(verdict, verdict="recognised", notes=(*verdict.notes, note))


def _is_exchanged(known: Identification) -> bool:
    """Return whether the claim writes phi where the ``known`` formula has psi, or psi where the formula has phi."""
    return any({old, plain(new)} in EXCHANGED for old, new in known.mapping.items())


def with_guesses(context: Context, verdict: Verdict, stated: str) -> Verdict:
    """Return a verdict with the recognised formula that needs the fewest guesses first, and with a note on its guesses.

    The note is for instance "guessed, not stated: solid". A guess is a word in the formula's name that is neither in
    the context nor in ``stated``. ``stated`` are the words that the name of the claim's quantity implies.
    """
    readings = sorted(verdict.recognised_as, key=lambda known: len(guesses(context, known.name, stated)))
    verdict, likeliest = replace(verdict, recognised_as=tuple(readings)), readings[0]
    words = guesses(context, likeliest.name, stated)
    phrases = words[:1]
    for first, second in pairwise(words):
        # words that follow each other are one phrase: "yaw, rotation matrix" of "yaw angle of a rotation matrix"
        if f"{first} {second}" in likeliest.name:
            phrases[-1] += f" {second}"
        else:
            phrases.append(second)
    what = ", ".join(filter(None, [*phrases, likeliest.how]))
    return replace(verdict, notes=(*verdict.notes, f"guessed, not stated: {what}")) if what else verdict
