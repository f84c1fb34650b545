"""Assigning the letters of a claim to the angles of an Euler sequence.

Words decide first: "yaw" is the angle about z, "precession angle" the first one. Otherwise, the orders are tried in
which books use the letters.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

from symrot.checker.context.context import Context

__all__ = [
    "AXIS_OF_ANGLE", "USUAL_SEQUENCES", "Order", "are_roll_pitch_yaw", "has_order", "letter_of_angle", "orders",
    "place_by_words",
]  # fmt: skip

FAMILIES: tuple[tuple[str, str, str], ...] = (
    ("phi", "theta", "psi"), ("alpha", "beta", "gamma"), ("yaw", "pitch", "roll"),
    ("theta_1", "theta_2", "theta_3"), ("q_1", "q_2", "q_3"),
)  # fmt: skip
"""Triples of letters that books use together for the three angles, usually in this order."""

SPELLINGS = {"varphi": "phi", "vartheta": "theta", "Phi": "phi", "Theta": "theta", "Psi": "psi", "heading": "yaw",
             "bank": "roll"}  # fmt: skip
"""Maps another name of an angle to its usual letter."""

AXIS_OF_ANGLE = {"yaw": "Z", "pitch": "Y", "roll": "X"}
USUAL_SEQUENCES = ("ZXZ", "ZYX", "xyz", "ZYZ", "XYZ", "zxz")
"""The Euler sequences that books use most, most usual first: capital letters for body axes, small for space axes."""

PLACE_OF_ANGLE = {
    "precession angle": 0, "precession rate": 0, "angle of the axis": 1, "nutation rate": 1, "spin angle": 2,
}  # fmt: skip
"""Maps the title of a quantity to the position of its angle in a sequence, from 0."""


@dataclass(frozen=True)
class Order:
    """One assignment of letters to the three angles of an Euler sequence.

    Attributes
    ----------
    places : dict
        Maps each letter to the position of its angle, 0, 1 or 2.
    guess : str
        Tells the user what was guessed, since neither the claim nor its context states it; empty if nothing was.
    """

    places: dict[str, int]
    guess: str = ""


def has_order(sequence: str) -> bool:
    """Return whether all books use phi for the first angle of a sequence and psi for the third, as in ZXZ."""
    # the first and last axis are equal; in ZYX the usage differs, and an empty text is no sequence
    return bool(sequence) and sequence[0] == sequence[-1]


def are_roll_pitch_yaw(sequence: str, places: Mapping[str, int]) -> bool:
    """Return whether the letters phi, theta and psi can be roll, pitch and yaw, the angles about x, y and z.

    ``places`` maps each letter to the position of its angle in ``sequence``, from 0. True also for a sequence such as
    ZXZ, which has no roll, pitch and yaw: the usage of aeronautics then restricts nothing.
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

    Yaw, pitch and roll are the angles about z, y and x; in a sequence with equal first and last axes, such as ZXZ, they
    are the first, second and third angle.

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
    """Yield the usual or stated assignments of ``letters`` to the angles of a sequence, the likeliest first."""
    spelled = {letter: letter_of_angle(letter) for letter in letters}
    family = next((own for own in FAMILIES if {*spelled.values()} <= {*own}), None)
    if family is None or len({*spelled.values()}) < len(spelled):
        # no book uses these letters together
        return
    stated = {}
    for letter, plain in spelled.items():
        meaning = context.meaning_of(letter) or context.meaning_of(f"d{letter}")
        title = meaning.quantity.title if meaning is not None else plain
        if (place := place_by_words(title, sequence)) is not None:
            stated[plain] = place
    usual = list(_usual_orders(family, sequence))
    # only orders that agree with the words of the context
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
    """Return the letters of a sequence's three angles in most books, such as (phi, theta, psi) for ZXZ."""
    # in ZYX psi is the yaw and comes first
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
