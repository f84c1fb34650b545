"""Assigning the letters of a claim to the angles of an Euler sequence, by words about them or by the usage of books.

Words decide first: "yaw" is the angle about z, "precession angle" the first one. If no words say which angle a letter
is, each order is tried that books use for the letters; for alpha, beta and gamma, every order.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

from symrot.checker.context.context import Context

__all__ = ["AXIS_OF_ANGLE", "Order", "are_roll_pitch_yaw", "has_order", "letter_of_angle", "orders", "place_by_words"]

FAMILIES: tuple[tuple[str, str, str], ...] = (
    ("phi", "theta", "psi"), ("alpha", "beta", "gamma"), ("yaw", "pitch", "roll"),
    ("theta_1", "theta_2", "theta_3"), ("q_1", "q_2", "q_3"),
)  # fmt: skip
"""Three letters that books use together for the angles of a sequence, in the usual order."""

SPELLINGS = {"varphi": "phi", "vartheta": "theta", "Phi": "phi", "Theta": "theta", "Psi": "psi", "heading": "yaw",
             "bank": "roll"}  # fmt: skip
"""Another way of writing an angle -> its letter."""

AXIS_OF_ANGLE = {"yaw": "Z", "pitch": "Y", "roll": "X"}
PLACE_OF_ANGLE = {
    "precession angle": 0, "precession rate": 0, "angle of the axis": 1, "nutation rate": 1, "spin angle": 2,
}  # fmt: skip
"""Title of a quantity in words -> the place of the angle in a sequence, from 0."""


@dataclass(frozen=True)
class Order:
    """One assignment of letters to the angles of a sequence: ``places`` maps each letter to its position 0, 1 or 2.

    ``guess`` tells the user which part of the assignment was guessed, because neither the claim nor its context states
    it; it is empty if nothing was guessed.
    """

    places: dict[str, int]
    guess: str = ""


def has_order(sequence: str) -> bool:
    """Return whether all books give the first and third angle of a sequence the same letters, in the same order.

    They do so for sequences such as ZXZ, with the same first and last axis: phi is the first angle, psi the third. In
    ZYX the usage differs. ``sequence`` may be empty; the result is then False.
    """
    return bool(sequence) and sequence[0] == sequence[-1]


def are_roll_pitch_yaw(sequence: str, places: Mapping[str, int]) -> bool:
    """Return whether phi, theta and psi can be read as books on aircraft use them, for roll, pitch and yaw.

    ``places`` maps letters to their places (0, 1, 2) in the sequence. In a sequence with three different axes, phi must
    be the angle about x, theta about y and psi about z. A sequence such as ZXZ has no roll, pitch and yaw: the result
    is then True, because the usage for aircraft restricts nothing.
    """
    axes = {"phi": "X", "theta": "Y", "psi": "Z"}
    return has_order(sequence) or all(
        sequence[place].upper() == axes[letter] for letter, place in places.items() if letter in axes
    )


def letter_of_angle(name: str) -> str:
    """Return the usual spelling of an angle's letter, such as phi for varphi; empty for a name that is no angle."""
    name = re.sub(r"^(theta|q)([1-3])$", r"\1_\2", SPELLINGS.get(name, name))
    return name if any(name in family for family in FAMILIES) else ""


def place_by_words(title: str, sequence: str) -> int | None:
    """Return the place (0, 1 or 2) of an angle in a sequence by its title, "yaw" or "spin angle"; None if unknown.

    Examples
    --------
    >>> place_by_words("yaw", "ZYX"), place_by_words("yaw", "xyz"), place_by_words("spin angle", "ZXZ")
    (0, 2, 2)
    """
    axis = AXIS_OF_ANGLE.get(title)
    if axis is None:
        return PLACE_OF_ANGLE.get(title)
    axes = sequence.upper()
    return "ZYX".index(axis) if has_order(sequence) else axes.index(axis)


def orders(context: Context, letters: Sequence[str], sequence: str) -> Iterator[Order]:
    """Yield the possible assignments of ``letters`` to the angles of a ``sequence``, the likeliest first.

    Only orders that agree with the words of the context are yielded; none for letters that no book uses together.
    """
    spelled = {letter: letter_of_angle(letter) for letter in letters}
    family = next((own for own in FAMILIES if {*spelled.values()} <= {*own}), None)
    if family is None or len({*spelled.values()}) < len(spelled):
        return
    stated = {}
    for letter, plain in spelled.items():
        meaning = context.meaning_of(letter) or context.meaning_of(f"d{letter}")
        title = meaning.quantity.title if meaning is not None else plain
        if (place := place_by_words(title, sequence)) is not None:
            stated[plain] = place
    usual = list(_usual_orders(family, sequence))
    chosen = [order for order in usual if _agrees(order, stated)]
    if not chosen and stated:
        chosen = [order for order in permutations(family) if _agrees(order, stated)]
    seen = set()
    for order in chosen:
        places = {letter: order.index(plain) for letter, plain in spelled.items()}
        if (key := tuple(places.values())) in seen:
            continue
        is_stated = {*spelled.values()} <= {*stated} or (order == usual[0] and family != FAMILIES[0])
        is_usual = is_stated or order == _first_order(family, sequence)
        seen.add(key)
        yield Order(places, "" if is_usual else _guess(places, sequence))


def _agrees(order: Sequence[str], stated: dict[str, int]) -> bool:
    return all(order[place] == letter for letter, place in stated.items())


def _guess(places: dict[str, int], sequence: str) -> str:
    words = [f"{letter} is the {('first', 'second', 'third')[place]} angle" for letter, place in places.items()]
    return f"{', '.join(words)} of {sequence}"


def _first_order(family: tuple[str, str, str], sequence: str) -> tuple[str, ...]:
    """Return the letters of ``family`` in the order in which most books give them to the first, second and third angle.

    ``sequence`` is that of the three angles. The result is ``family`` itself, such as (phi, theta, psi); only in ZYX
    these three letters are reversed to (psi, theta, phi), since psi is the yaw there. The caller uses this order if the
    context states no other one.
    """
    return family[::-1] if family == FAMILIES[0] and sequence == "ZYX" else family


def _usual_orders(family: tuple[str, str, str], sequence: str) -> Iterator[tuple[str, ...]]:
    """Yield the orders in which books use three letters for the angles of a sequence, the likeliest first."""
    if family == ("yaw", "pitch", "roll"):
        letters = dict(zip("ZYX", family, strict=True))
        yield family if has_order(sequence) else tuple(letters[axis] for axis in sequence.upper())
    elif family == ("alpha", "beta", "gamma"):
        yield from permutations(family)
    elif family != FAMILIES[0] or has_order(sequence):
        yield family
    else:
        by_axis = dict(zip("XYZ", family, strict=True))
        first = _first_order(family, sequence)
        yield from dict.fromkeys((first, first[::-1], tuple(by_axis[axis] for axis in sequence.upper())))
