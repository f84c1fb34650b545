"""Whether formulas on several lines, such as ``L_1 = ..`` and ``L_2 = ..``, can be the components of one quantity."""

import re
from collections.abc import Collection, Iterator, Sequence
from itertools import product

from symrot.checker.recognition.renaming import quantity_of
from symrot.checker.verdict import Identification, Verdict

__all__ = ["fit_together", "misplaced"]

PLACE = re.compile(r"(first|second|third|scalar) component of the |, ([xyz]) axis$")
"""The words in the name of a known formula that say which component or axis it is."""


def fit_together(lines: Sequence[tuple[str, Collection[str], Verdict]]) -> bool:
    """Return whether recognised equations can be components of one quantity: of one body, frame and sequence.

    Each of ``lines`` is (name of the left side, names in the formula, verdict). Only equations whose names differ in
    the index alone, such as L_1 and L_2, are compared.
    """
    groups: dict[str, list[list[tuple[Identification, dict[str, str]]]]] = {}
    for name, letters, verdict in lines:
        base = re.sub(r"_?([0-3]|[xyz]|[xyz]{2})$", "", name)
        if verdict.recognised_as and base != name:
            readings = [(known, _meanings(known, letters)) for known in verdict.recognised_as]
            groups.setdefault(base, []).append(readings)
    return all(any(_fit(choice) for choice in product(*group)) for group in groups.values())


def _meanings(known: Identification, letters: Collection[str]) -> dict[str, str]:
    """Return {letter of a claim: symbol of the known formula that it stands for} for all ``letters``."""
    # if psi' stands for phi', then psi stands for phi
    renamed = {quantity_of(new): quantity_of(mine) for mine, new in known.mapping.items()}
    return {letter: letter for letter in letters} | renamed


def _fit(choice: Sequence[tuple[Identification, dict[str, str]]]) -> bool:
    """Return whether known formulas, one for each equation, can be different components of one quantity.

    True also if one of them is not for a component.
    """
    places = [tuple(_places(known.name)) for known, _ in choice]
    if not all(places):
        return True
    wholes = {PLACE.sub("", known.name) for known, _ in choice}
    meanings: dict[str, str] = {}
    # each letter of the claim must stand for the same symbol everywhere
    same = all(meanings.setdefault(new, mine) == mine for _, own in choice for new, mine in own.items())
    return same and len(wholes) == 1 and len({*places}) == len(places)


def misplaced(lines: Sequence[tuple[str, Collection[str], Verdict]]) -> int:
    """Return how many equations name one component but give the formula of another: I_2 with the formula of I_1."""
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
