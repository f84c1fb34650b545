"""Whether formulas for components of one vector or tensor, on several lines, are of one body, frame and sequence."""

import re
from collections.abc import Collection, Iterator, Sequence
from itertools import product

from symrot.checker.recognition.renaming import quantity_of
from symrot.checker.verdict import Identification, Verdict

__all__ = ["fit_together", "misplaced"]

PLACE = re.compile(r"(first|second|third|scalar) component of the |, ([xyz]) axis$")
"""The words in the name of a known formula that say which component or axis it is."""


def fit_together(lines: Sequence[tuple[str, Collection[str], Verdict]]) -> bool:
    """Return whether several recognised lines can be the components of one quantity.

    A line consists of the name of its left side, the names in its formula, and its verdict. Lines for omega_x, omega_y,
    .. fit together under three conditions. Their verdicts name formulas such as "first component of .." and "second
    component of ..", with the same words otherwise. No two lines name the same component. Each letter stands for the
    same quantity on all lines.
    """
    groups: dict[str, list[list[tuple[Identification, dict[str, str]]]]] = {}
    for name, letters, verdict in lines:
        base = re.sub(r"_?([0-3]|[xyz]|[xyz]{2})$", "", name)
        if verdict.recognised_as and base != name:
            readings = [(known, _meanings(known, letters)) for known in verdict.recognised_as]
            groups.setdefault(base, []).append(readings)
    return all(any(_fit(choice) for choice in product(*group)) for group in groups.values())


def _meanings(known: Identification, letters: Collection[str]) -> dict[str, str]:
    """Return, for each of ``letters`` of a formula, the letter of the known formula that it stands for.

    A rate stands for the same angle as the angle itself: if psi' is renamed to phi', then psi is phi.
    """
    renamed = {quantity_of(new): quantity_of(mine) for mine, new in known.mapping.items()}
    return {letter: letter for letter in letters} | renamed


def _fit(choice: Sequence[tuple[Identification, dict[str, str]]]) -> bool:
    """Return whether known formulas, one for each line, can be different components of one quantity.

    Each formula comes with the meanings of the claim's letters (letter -> known symbol), which must agree on all lines.
    If some formula is not for a component, nothing is compared and the result is True.
    """
    places = [tuple(_places(known.name)) for known, _ in choice]
    if not all(places):
        return True
    wholes = {PLACE.sub("", known.name) for known, _ in choice}
    meanings: dict[str, str] = {}
    same = all(meanings.setdefault(new, mine) == mine for _, own in choice for new, mine in own.items())
    return same and len(wholes) == 1 and len({*places}) == len(places)


def misplaced(lines: Sequence[tuple[str, Collection[str], Verdict]]) -> int:
    """Return the number of lines whose known formulas are all for other components than the name of the line says.

    A line ``I_2 = ..`` is one of them if its formula is known for the x axis only.
    """
    return sum(
        name[-1:] in AXIS_OF and bool(verdict.recognised_as)
        and not any(AXIS_OF[name[-1]] == AXIS_OF[place] for k in verdict.recognised_as for place in _places(k.name))
        for name, _, verdict in lines
    )  # fmt: skip


AXIS_OF = {
    **dict(zip("xyz", (1, 2, 3), strict=True)), **dict(zip("0123", range(4), strict=True)),
    **dict(zip(("scalar", "first", "second", "third"), range(4), strict=True)),
}  # fmt: skip
"""Word for a component or an axis -> its number."""


def _places(name: str) -> Iterator[str]:
    for match in PLACE.finditer(name):
        yield match[1] or match[2]
