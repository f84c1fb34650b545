"""Readings: the interpretations of a text that a person typed. An ambiguous text such as ``1/2m`` has several.

Each ambiguous piece of a text has a key (kind, position); ``flips`` are the keys of the pieces with their less usual
meaning.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from symrot.checker.claim.tree import Node
from symrot.checker.typed.cursor import Doubt
from symrot.errors import InputError

__all__ = ["Chain", "Declared", "Reading", "Relation", "distinct_readings", "each_reading"]

MOST_READINGS = 6
"""The largest number of readings of one text on which a verdict is given."""

MOST_DOUBTS = 40
"""The largest number of ambiguous pieces of one text whose less usual meaning is tried."""

Relation = tuple[str, Node, Node]


@dataclass(frozen=True)
class Declared:
    """The names of symbols and functions of time that a claim declares: a declared ``mgl`` is not split into m g l."""

    symbols: Collection[str] = ()
    functions: Collection[str] = ()


@dataclass(frozen=True)
class Chain:
    """One line of a text: formulas (sides) with relation signs between them.

    There is usually one sign, or several equals signs (``a = b = c``).

    Attributes
    ----------
    signs : tuple of str
    sides : tuple of Node
    both_signs : bool
        Whether this is one of the two lines that a typed line with ± stands for.
    """

    signs: tuple[str, ...]
    sides: tuple[Node, ...]
    both_signs: bool = False

    @property
    def links(self) -> tuple[Relation, ...]:
        """The relations between neighbouring sides; but in ``I_x = I_y = F`` each name is related to the formula F."""
        formulas = [side for side in self.sides if side.kind != "name"]
        rights = list(self.sides[1:])
        if formulas and set(self.signs) == {"=="}:
            for n in range(len(rights) - 2, -1, -1):
                if self.sides[n].kind == rights[n].kind == "name":
                    rights[n] = rights[n + 1]
        return tuple(zip(self.signs, self.sides, rights, strict=False))


@dataclass(frozen=True)
class Reading:
    """One interpretation of a text that a user typed; ``1/2m`` has two of them.

    Attributes
    ----------
    lines : tuple of Chain
        The lines of the text, each as formulas with relation signs between them: ``a = b = c`` is one Chain.
    plain : bool
        Whether the text is read as people type, not as SymPy syntax.
    doubts : tuple of Doubt
        The ambiguous pieces of the text.
    notes : tuple of str
        Sentences about how the text is read.
    spelling : dict
        Name in the trees -> name as it was typed, where they differ.
    timed : frozenset of str
        Names that are functions of time.
    vectors : mapping of str to bool
        Names that the text uses as vectors; True for a name with a hat.
    flipped : tuple of str
        The ambiguous pieces of the text that have their less usual meaning in this reading.
    """

    lines: tuple[Chain, ...]
    plain: bool = False
    doubts: tuple[Doubt, ...] = ()
    notes: tuple[str, ...] = ()
    spelling: Mapping[str, str] = field(default_factory=dict, compare=False)
    timed: frozenset[str] = frozenset()
    vectors: Mapping[str, bool] = field(default_factory=dict, compare=False)
    flipped: tuple[str, ...] = ()

    @property
    def relation(self) -> Relation:
        """The first relation of the text, as (sign, left, right); most texts have only one."""
        return self.lines[0].links[0]


def each_reading(read: Callable[[Collection[tuple[str, int]]], Reading]) -> Iterator[Reading]:
    """Yield the usual reading of a text, ``read(())``, and then readings ``read(flips)`` with less usual meanings.

    ``flips`` are the keys (kind of ambiguity, position) of the ambiguous pieces that get their less usual meaning: all
    pieces of one kind or, for kinds other than "word" and "name", a single piece. Readings for which ``read(flips)``
    raises InputError are left out; for the usual reading, the error passes through.
    """
    usual = read(())
    yield usual
    keys = list(dict.fromkeys(doubt.key for doubt in usual.doubts))[:MOST_DOUBTS]
    kinds = dict.fromkeys(kind for kind, _ in keys)
    choices = [{key for key in keys if key[0] == kind} for kind in kinds]  # a writer is consistent
    choices += [{key} for key in keys if key[0] not in ("word", "name")]
    for flips in choices:
        try:
            yield read(flips)
        except InputError:
            continue


def distinct_readings(readings: Iterable[Reading]) -> list[Reading]:
    """Return at most MOST_READINGS readings (interpretations) with different trees, the usual one first."""
    by_trees: dict[Any, Reading] = {}
    for reading in readings:
        by_trees.setdefault(reading.lines, reading)
    usual, *others = by_trees.values()
    if len(others) >= MOST_READINGS:
        note = f"the text can be read in more than the {MOST_READINGS} ways that are checked; brackets leave fewer ways"
        usual = replace(usual, notes=(*usual.notes, note))
    return [usual, *others[: MOST_READINGS - 1]]
