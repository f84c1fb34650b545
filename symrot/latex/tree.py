"""The tree of a LaTeX formula: the formula as it is written, before anything is known about its meaning.

Operators, relations and brackets such as ``(`` and ``|`` are tokens of a row, as they are in LaTeX: which bracket
closes which, and what is a product, depends on the meaning. Every node has ``start`` and ``end``, positions in the
source, ``text``, the command or mark it begins with, and ``kind``.
"""

from dataclasses import dataclass
from typing import ClassVar

from symrot.latex.tokens import Token

__all__ = ["Accent", "Delimited", "Font", "Fraction", "Node", "Root", "Row", "Script", "Scripts", "Sized", "Table",
           "alone", "divided"]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Row:
    """A row of items: a whole formula, a group in braces, a cell of a table; ``end`` is the place of what closes it."""

    items: tuple["Node", ...]
    start: int
    end: int
    kind: ClassVar[str] = "row"
    text: ClassVar[str] = "{"


@dataclass(frozen=True, slots=True)
class Command:
    """A command with one argument, or the mark of a script with its inside; ``text`` is the command or the mark."""

    text: str
    inside: "Node"
    start: int

    @property
    def end(self) -> int:
        """The position after the argument."""
        return self.inside.end


@dataclass(frozen=True, slots=True)
class Script(Command):
    """An index, a power or primes after a piece: ``text`` is ``_``, ``^`` or ``'``; inside primes is their token."""

    kind: ClassVar[str] = "script"


@dataclass(frozen=True, slots=True)
class Scripts:
    """A piece with its scripts: an index and primes as they are written, then the power."""

    base: "Node"
    scripts: tuple[Script, ...]
    kind: ClassVar[str] = "scripts"
    text: ClassVar[str] = ""

    @property
    def start(self) -> int:
        """The position of the piece."""
        return self.base.start

    @property
    def end(self) -> int:
        """The position after the last script."""
        return max(script.end for script in self.scripts)


@dataclass(frozen=True, slots=True)
class Fraction:
    """A fraction with any of the commands ``\\frac``, ``\\tfrac``, ``\\dfrac`` and ``\\cfrac``."""

    command: str
    above: "Node"
    below: "Node"
    start: int
    kind: ClassVar[str] = "fraction"
    text: ClassVar[str] = "\\frac"

    @property
    def end(self) -> int:
        """The position after the denominator."""
        return self.below.end


@dataclass(frozen=True, slots=True)
class Root:
    """A root; ``index`` is None for a square root."""

    index: Row | None
    inside: "Node"
    start: int
    kind: ClassVar[str] = "root"
    text: ClassVar[str] = "\\sqrt"

    @property
    def end(self) -> int:
        """The position after the radicand."""
        return self.inside.end


@dataclass(frozen=True, slots=True)
class Accent(Command):
    """A mark over or under its argument: ``\\dot``, ``\\vec``, ``\\hat``."""

    kind: ClassVar[str] = "accent"


@dataclass(frozen=True, slots=True)
class Font(Command):
    """An argument in a font, or words: ``\\mathbf``, ``\\mathrm``, ``\\text``, ``\\operatorname``."""

    kind: ClassVar[str] = "font"


@dataclass(frozen=True, slots=True)
class Sized(Command):
    """A delimiter with a size: ``\\bigl(``."""

    kind: ClassVar[str] = "sized"


@dataclass(frozen=True, slots=True)
class Delimited:
    """A row between ``\\left`` and ``\\right``, with the tokens of its delimiters."""

    opening: Token
    inside: Row
    closing: Token
    start: int
    kind: ClassVar[str] = "delimited"
    text: ClassVar[str] = "\\left"

    @property
    def end(self) -> int:
        """The position after the closing delimiter."""
        return self.closing.end


@dataclass(frozen=True, slots=True)
class Table:
    """An environment with cells in lines: a matrix, cases, or several lines of formulas."""

    name: str
    lines: tuple[tuple[Row, ...], ...]
    start: int
    end: int
    kind: ClassVar[str] = "table"
    text: ClassVar[str] = "\\begin"


Node = Token | Row | Script | Scripts | Fraction | Root | Accent | Font | Sized | Delimited | Table


def alone(node: Node) -> Node:
    """Return the only item of a group in braces, of any depth; the node itself if it is no such group."""
    while isinstance(node, Row) and len(node.items) == 1:
        node = node.items[0]
    return node


def divided(row: Row, mark: str) -> list[Row]:
    """Return the parts of a row between the tokens ``mark``."""
    places = [place for place, item in enumerate(row.items) if item.text == mark]
    rows, first, start = [], 0, row.start
    for place in places:
        rows.append(Row(row.items[first:place], start, row.items[place].start))
        first, start = place + 1, row.items[place].end
    return [*rows, Row(row.items[first:], start, row.end)]
