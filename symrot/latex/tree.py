"""The tree of a LaTeX formula: the formula as it is written, before anything is known about its meaning.

Operators, relations and brackets such as ``(`` and ``|`` are tokens of a row, as they are in LaTeX: which bracket
closes which, and what is a product, depends on the meaning. Every node has ``start``, its position in the source,
``text``, the command or mark it begins with, and ``kind``, of which only tokens have several.
"""

from dataclasses import dataclass

from symrot.latex.tokens import Token

__all__ = ["Accent", "Delimited", "Font", "Fraction", "Node", "Root", "Row", "Script", "Scripts", "Table", "alone",
           "divided"]  # fmt: skip


@dataclass(frozen=True)
class Row:
    """A row of items: a whole formula, a group in braces, a cell of a table; ``end`` is the place of what closes it."""

    items: tuple["Node", ...]
    start: int
    end: int
    kind, text = "row", "{"


@dataclass(frozen=True)
class Command:
    """A command with one argument, or the mark of a script with its inside; ``text`` is the command or the mark."""

    text: str
    inside: "Node"
    start: int
    kind = ""


class Accent(Command):
    """A mark over or under its argument: ``\\dot``, ``\\vec``, ``\\hat``."""


class Font(Command):
    """An argument in a font, or words: ``\\mathbf``, ``\\mathrm``, ``\\text``, ``\\operatorname``."""


class Script(Command):
    """An index, a power or primes after a piece: ``text`` is ``_``, ``^`` or ``'``; inside primes is their token."""


@dataclass(frozen=True)
class Scripts:
    """A piece with its scripts: an index and primes as they are written, then the power."""

    base: "Node"
    scripts: tuple[Script, ...]
    start: int
    kind = text = ""


@dataclass(frozen=True)
class Fraction:
    """A fraction with any of the commands ``\\frac``, ``\\tfrac``, ``\\dfrac`` and ``\\cfrac``."""

    command: str
    above: "Node"
    below: "Node"
    start: int
    kind, text = "", "\\frac"


@dataclass(frozen=True)
class Root:
    """A root; ``index`` is None for a square root."""

    index: Row | None
    inside: "Node"
    start: int
    kind, text = "", "\\sqrt"


@dataclass(frozen=True)
class Delimited:
    """A row between ``\\left`` and ``\\right``, with the tokens of its delimiters."""

    opening: Token
    inside: Row
    closing: Token
    start: int
    kind, text = "", "\\left"


@dataclass(frozen=True)
class Table:
    """An environment with cells in lines: a matrix, cases, or several lines of formulas."""

    name: str
    lines: tuple[tuple[Row, ...], ...]
    start: int
    kind, text = "", "table"


Node = Token | Row | Accent | Font | Script | Scripts | Fraction | Root | Delimited | Table


def alone(node: Node) -> Node:
    """Return the only item of a group in braces, of any depth; the node itself if it is no such group."""
    while isinstance(node, Row) and len(node.items) == 1:
        node = node.items[0]
    return node


def divided(row: Row, mark: str) -> list[Row]:
    """Return the parts of a row between the tokens ``mark``."""
    rows, first = [], 0
    for place, item in enumerate(row.items):
        if item.text == mark:
            rows.append(Row(row.items[first:place], row.items[first].start, item.start))
            first = place + 1
    rest = row.items[first:]
    return [*rows, Row(rest, rest[0].start if rest else row.end, row.end)]
