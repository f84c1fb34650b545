"""Names for a symbol of a known formula that a claim lacks: omega_3 in a claim with omega_1 and omega_2."""

import re
from collections.abc import Collection

from symrot.checker.recognition.renaming import axes_of
from symrot.checker.recognition.single_faults.renamings import NUMBERED, is_fitting
from symrot.checker.recognition.usual_letters import UNIT_OF_NAME, plain_name

__all__ = ["absent_name"]

INDEX = re.compile("([1-3]|[xyz]|([1-3xyz])\\2|[1-3xyz]{2})$")
"""Pattern of the index of one or two axes at the end of a name: 3, z, zz, 12."""

ORDER = {"phi": "1", "theta": "2", "psi": "3"}
"""Euler angle -> its number in books that call the three angles theta_1, theta_2 and theta_3."""

RATES = {"omega_1": "p", "omega_2": "q", "omega_3": "r"}
"""Component of an angular velocity -> the letter of an aircraft's rate."""

MATRIX_ENTRY = re.compile("R_[1-3]{2}")
"""Pattern of the name of a rotation matrix's entry in known formulas, such as R_12."""

USUAL = {"c_3": "l", "mu": "m", "omega_3": "omega", "domega_3": "alpha"}
"""Symbol in known formulas -> the letter that books use if there is one such quantity only: omega, not omega_3."""


def _absent_of_product(known: str, renaming: dict[str, str | None]) -> str | None:
    """Return the name that a claim would have for a missing component of q or p in a quaternion product q*p.

    ``known`` is the missing component, such as "p2". ``renaming`` maps the other components q0, .., q3 and p0, .., p3
    to the claim's names. Suppose that the claim writes a1, b1, c1, d1 for q0, .., q3 and a2, b2, d2 for p0, p1, p3.
    Then the name of p2 is c2: it has the letter of q2 and the number of p. Return None for other symbols ``known``, and
    if the claim's names do not consist of a letter and a number.
    """
    if re.fullmatch("[qp][0-3]", known) is None:
        return None
    beside = renaming.get(("p" if known[0] == "q" else "q") + known[1])
    sibling = next((renaming[name] for name in renaming if name[0] == known[0] and renaming[name] is not None), None)
    if beside is None or sibling is None or not NUMBERED.fullmatch(beside) or not NUMBERED.fullmatch(sibling):
        return None
    return beside[:-1] + sibling[-1]


def _without_mark(name: str) -> tuple[str, str]:
    """Return a name and the mark over it: ("z", "_bar") for ``z_bar``."""
    mark = re.search("(_bar|_prime)*$", name)
    assert mark is not None
    return name[: mark.start()], mark[0]


def _numbered_angle(known: str, beside: str, name: str) -> str:
    """Return the name in a claim with numbered angles for ``known``, an Euler angle or the rate of one.

    Most books number phi, theta and psi by 1, 2 and 3; some, on aircraft, by 3, 2 and 1. One name in the claim shows
    the order: ``name``, which the claim has for the angle or rate ``beside``. If phi is called theta_1, then psi is
    theta_3; if psi is called theta_1, then phi is theta_3. Return "" if ``name`` does not end with one of the two
    numbers of ``beside``, or if ``known`` or ``beside`` is not phi, theta, psi or the rate of one of these angles.

    Examples
    --------
    >>> _numbered_angle("psi", "phi", "theta_1"), _numbered_angle("theta", "psi", "theta_1")
    ('theta_3', 'theta_2')
    >>> _numbered_angle("dpsi", "theta", "theta_2"), _numbered_angle("psi", "phi", "omega_2")
    ('dtheta_3', '')
    """
    place, own = ORDER.get(known.removeprefix("d")), ORDER.get(beside.removeprefix("d"))
    stem, number = name.removeprefix("d" if beside.startswith("d") else "")[:-1], name[-1:]
    # numbered from the first rotation to the last or, as for aircraft, the other way round
    if place is None or own is None or number not in (own, str(4 - int(own))):
        return ""
    return ("d" if known.startswith("d") else "") + stem + (place if number == own else str(4 - int(place)))


def absent_name(known: str, renaming: dict[str, str | None], unused: Collection[str] = ()) -> tuple[str, bool]:
    """Return (name, is_implied): the name that a claim would have for a symbol ``known`` which the claim lacks.

    The symbol belongs to a known formula with which the claim is compared; ``renaming`` maps symbols of that formula to
    the claim's names, or to None. The name is implied if other names of the claim show how the claim writes such
    symbols: w_1 and w_2 imply w_3. ``unused`` are the claim's names that stand for no symbol of the known formula. They
    can imply a name too: I_1 implies I_3 for the moment of inertia C. If no name of the claim implies one, the name is
    that in ``USUAL``, or ``known`` itself.
    """
    for mine, other in renaming.items():
        if other is not None and (numbered := _numbered_angle(known, mine, plain_name(other))):
            return numbered, True
        if known in ORDER and mine.removeprefix("d") in ORDER and plain_name(other or "") == mine:
            return known, True
    if (of_product := _absent_of_product(known, renaming)) is not None:
        return of_product, True
    if known in RATES and any(renaming.get(mine) == letter for mine, letter in RATES.items()):
        return RATES[known], True
    if (entry := _absent_entry(known, renaming)) is not None:
        return entry, True
    axis = axes_of(known)
    unit = UNIT_OF_NAME.get(known)
    for mine, other in renaming.items():
        name, mark = _without_mark(plain_name(other or ""))
        index = INDEX.search(name)
        if other is None or index is None or UNIT_OF_NAME.get(mine) != unit or len(axes_of(mine)) != len(axis):
            continue
        own, new = axes_of(mine), axes_of(name)
        if axis and own == new:
            return name[: index.start()] + _index_like(index[0], axis) + mark, True
    for other in unused:
        name, mark = _without_mark(plain_name(other))
        index = INDEX.search(name)
        if index is not None and len(axis) == 1 and len(axes_of(name)) == 1 and is_fitting(known, other, False):
            return name[: index.start()] + _index_like(index[0], axis) + mark, True
    return USUAL.get(known, known), False


def _absent_entry(known: str, renaming: dict[str, str | None]) -> str | None:
    """Return the name that a claim would have for the entry ``known`` of a rotation matrix: r_21 for R_21.

    The claim must call another entry, R_11, by a name with the same indices, r_11. Return None if ``known`` is not an
    entry, if the claim has no entries of the matrix, or if the indices differ: r_12 in place of R_21.
    """
    pairs = [(mine, other) for mine, other in renaming.items() if other is not None and MATRIX_ENTRY.fullmatch(mine)]
    if MATRIX_ENTRY.fullmatch(known) is None or not pairs or any(mine[-2:] != other[-2:] for mine, other in pairs):
        return None
    return pairs[0][1][:-2] + known[-2:]


def _index_like(index: str, axes: Collection[int]) -> str:
    """Return the index for the axes, written as ``index`` is: "z" or "zz" for axis 3 beside "x" or "xx"."""
    letters = "0xyz" if index[0].isalpha() else "0123"
    made = "".join(letters[place] for place in sorted(axes))
    return made * (len(index) if len(axes) == 1 else 1)
