"""Renamings of a known formula's symbols to the symbols of a claim that may have a fault.

A known formula is one that symrot derives. A fault can remove one symbol from a formula or add one; so a renaming may
leave out one symbol. Usual letters, units, axes and the use as an angle tell which symbols may be the same quantity.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from functools import lru_cache
from itertools import islice

from symrot.checker.recognition.renaming import axes_of, is_consistent
from symrot.checker.recognition.usual_letters import LETTERS, UNIT_OF_NAME, agree_in_unit, plain_name

__all__ = ["NUMBERED", "is_fitting", "renaming_of_product", "renamings", "strangeness"]

ANGLES = r"(phi|theta|psi|alpha|beta|gamma|delta|eta|varphi|vartheta|Phi|Theta|Psi)(_?\w+)?"
"""Pattern of the letters that books use for angles."""

MORE_LETTERS = {"rad": ANGLES, "1": f"{LETTERS['1']}|[xyzwlmnvf](_[xyz1-3])?"}
"""Unit -> pattern of the letters that a claim with a fault may use for a quantity with this unit.

These patterns replace the narrower ones of ``LETTERS``: the other letters of a long formula show what is meant.
"""

RADIUS = re.compile(r"[rR](_?\w+)?|a")
"""Pattern of the letters of radii; a is also the side of a box."""

COORDINATES = ("x", "y", "z")

UNUSUAL = 2
"""Number that `strangeness` adds for each radius that is renamed to another length, and each other length to a radius.

The function `strangeness` measures how unlikely a renaming is; each changed name counts 1.
"""

MOST_STEPS = 400
"""Largest number of steps of the search for renamings that give each symbol of a known formula a name of the claim.

A second search, for renamings that leave one symbol without a name, may take as many steps; they are shared equally
among the symbols that can be left out.
"""
MOST = 6
"""The largest number of renamings of one known formula that `renamings` returns."""


def renamings(known: Sequence[str], own: Sequence[str], angles: Collection[str] = ()) -> list[dict[str, str | None]]:
    """Return the most plausible renamings of the names ``known`` of a known formula to the names ``own`` of a claim.

    At most MOST are returned. One name may be renamed to None, because the claim lacks it, and one name of the claim
    may be left over. ``angles`` are the claim's names in sines and cosines.
    """
    if abs(len(known) - len(own)) > 1:
        return []
    fitting = {name: [other for other in own if is_fitting(name, other, other in angles)] for name in known}
    order = sorted(known, key=lambda name: (len(fitting[name]), name))
    complete = []
    for absent in (*([""] if len(known) <= len(own) else []), *order):  # the name that the claim lacks, or none
        rest = [name for name in order if name != absent]
        start: dict[str, str | None] = {absent: None} if absent else {}
        search = islice(_extended(start, rest, fitting, len(own)), MOST_STEPS // (len(order) if absent else 1))
        complete += [renaming for renaming in search if renaming is not None]
    return sorted(complete, key=_rank)[:MOST]


def _rank(renaming: dict[str, str | None]) -> tuple[int, int, bool, int]:
    """Return the sort key of a renaming, smallest if the claim's names are most similar to the known ones."""
    # symbols with another axis, changed names, a symbol without a name, names with another letter
    return _moved(renaming), strangeness(renaming), None in renaming.values(), _unlike(renaming)


def renaming_of_product(own: Sequence[str]) -> dict[str, str | None] | None:
    """Return {"q0": "a1", "p0": "a2", ..}, the renaming of a quaternion product, for the names a1, .., d1, a2, .., d2.

    None for other names. One of the eight names may be missing; its symbol is then renamed to None.
    """
    places = {(match[1], match[2]): name for name in own if (match := NUMBERED.fullmatch(name))}
    letters, numbers = sorted({letter for letter, _ in places}), sorted({number for _, number in places})
    if len(places) != len(own) or (len(letters), len(numbers)) != (4, 2) or len(own) < 2 * len(letters) - 1:
        return None
    return {
        f"{factor}{n}": places.get((letter, number))  # None for a name that the claim lacks
        for factor, number in zip("qp", numbers, strict=True)
        for n, letter in enumerate(letters)
    }


NUMBERED = re.compile("([a-z])_?([1-9])")
"""Pattern of a component's name in a quaternion product, such as b2: the component's letter and the factor's number."""


def _moved(renaming: dict[str, str | None]) -> int:
    """Return how many symbols a renaming moves to another axis: I_1 to I_2."""
    pairs = [(axes_of(name), axes_of(plain_name(other))) for name, other in renaming.items() if other is not None]
    return sum(bool(mine and new and mine != new) for mine, new in pairs)


def _unlike(renaming: dict[str, str | None]) -> int:
    """Return how many symbols begin with another letter in the claim than in the known formula."""
    return sum(other is not None and not _has_letter_of(name, other) for name, other in renaming.items())


def _has_letter_of(name: str, other: str) -> bool:
    """Return whether two names begin with the same letter, large or small."""
    return name.lstrip("d")[:1].lower() == plain_name(other).lstrip("d")[:1].lower()


def strangeness(renaming: dict[str, str | None]) -> int:
    """Return how many names a renaming changes or leaves out; a radius renamed to another length counts three times.

    A length that is not a radius, but is renamed to one, counts three times as well.
    """
    changed = [name for name, other in renaming.items() if other is None or plain_name(other) != name]
    lengths = [name for name in changed if UNIT_OF_NAME.get(name) == "m" and name not in COORDINATES]
    unusual = [name for name in lengths if (other := renaming[name]) is not None
               and bool(RADIUS.fullmatch(name)) != bool(RADIUS.fullmatch(other))]  # fmt: skip
    return len(changed) + UNUSUAL * len(unusual)


def _extended(
    renaming: dict[str, str | None], order: Sequence[str], fitting: dict[str, list[str]], count: int
) -> Iterator[dict[str, str | None] | None]:
    """Yield all renamings that extend ``renaming`` to the symbols ``order`` of the known formula.

    A renaming maps symbols of the known formula to names in the claim; None in place of a name means that the claim
    lacks the symbol. Also yield None at each step of the search, so that the caller can count the steps and give up.
    ``fitting`` maps each symbol to the claim's names that may mean the same; ``count`` is the number of names in the
    claim, of which all but at most one must be used. If ``fitting`` has the symbol's own name and no symbol has this
    name yet, the symbol keeps it.
    """
    yield None
    if not order:
        used = sum(other is not None for other in renaming.values())
        if count - used <= 1:
            yield dict(renaming)
        return
    name, *rest = order
    others = [other for other in fitting[name] if other not in renaming.values()]
    same = [other for other in others if plain_name(other) == name]
    for other in same or sorted(others, key=lambda other: not _has_letter_of(name, other)):
        pairs = [(mine, chosen) for mine, chosen in renaming.items() if chosen is not None]
        if not is_consistent([*pairs, (name, other)]):
            continue
        yield from _extended({**renaming, name: other}, rest, fitting, count)


@lru_cache(maxsize=20_000)
def is_fitting(known: str, own: str, is_angle: bool) -> bool:
    """Return whether ``known``, a name in a known formula, may mean the same quantity as ``own`` in a claim.

    ``is_angle`` tells whether ``own`` occurs in sines or cosines of the claim.
    """
    name = plain_name(own)
    if known == name:
        return True
    unit = UNIT_OF_NAME.get(known)
    if re.match("[A-Z]{2}", name):
        return False  # two letters without a sign between them
    is_rate = own.startswith("diff(") or own.endswith("dot")
    is_known_rate = known.startswith("d") and not known.startswith("d_")  # d_x is a distance
    if is_rate != is_known_rate and (is_rate or unit not in ("rad/s", "rad/s^2")):
        return False
    if known in COORDINATES and re.fullmatch(r"[a-zA-Z]_[xyz1-3]", name):
        return True  # a component of any vector, such as a rotated velocity
    if is_angle:
        return unit in ("rad", None)
    pattern = MORE_LETTERS.get(unit or "", LETTERS.get(unit or ""))
    if pattern is not None:
        return re.fullmatch(pattern, name) is not None
    return agree_in_unit(known, own)
