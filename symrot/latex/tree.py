"""The tree of a LaTeX formula: how the formula is written, without its meaning.

Operators, relations and brackets such as ``(`` are separate tokens of a row, because only the meaning tells which
brackets match. A node is a token or an instance of a class of this module. Every node has three attributes: its
position in the source (``start``) and two texts, ``kind`` and ``text``, which may be empty. So code can compare the
texts of any node without asking for its class.
"""

from dataclasses import dataclass

from symrot.latex.tokens import Token

__all__ = ["Accent", "Delimited", "Font", "Fraction", "Node", "Root", "Row", "Script", "Scripts", "Table", "alone",
           "divided"]  # fmt: skip


@dataclass(frozen=True)
class Row:
    """A row of items (nodes): a whole formula, a group in braces, or a cell of a table."""

    items: tuple["Node", ...]
    start: int
    end: int  # position of the row's end in the source
    kind, text = "row", "{"


@dataclass(frozen=True)
class Command:
    """A LaTeX command with one argument, or an index or power with its content.

    ``text`` is the command, or the mark ``_`` or ``^``.
    """

    text: str
    inside: "Node"
    start: int
    kind = ""


class Accent(Command):
    """An accent over or under its argument: ``\\dot``, ``\\vec``, ``\\hat``."""


class Font(Command):
    """A command that sets its argument in a font or as words: ``\\mathbf``, ``\\mathrm``, ``\\text``."""


class Script(Command):
    """An index, power or primes of a symbol; ``text`` is the mark ``_``, ``^`` or ``'``."""

    # ``inside`` is the index or power; for primes, as in f', the token of the primes


@dataclass(frozen=True)
class Scripts:
    """An item with its scripts: first indices and primes, in the order in which they are written; last the power."""

    base: "Node"
    scripts: tuple[Script, ...]
    start: int
    kind = text = ""


@dataclass(frozen=True)
class Fraction:
    """A fraction, written with ``\\frac``, ``\\tfrac``, ``\\dfrac``, ``\\cfrac`` or ``\\over``."""

    command: str
    above: "Node"
    below: "Node"
    start: int
    kind, text = "", "\\frac"


@dataclass(frozen=True)
class Root:
    """A root, ``\\sqrt[n]{x}``: ``index`` is the row n, or None for a square root, and ``inside`` is x."""

    index: Row | None
    inside: "Node"
    start: int
    kind, text = "", "\\sqrt"


@dataclass(frozen=True)
class Delimited:
    """A row between ``\\left`` and ``\\right``, with the tokens of the two delimiters."""

    opening: Token
    inside: Row
    closing: Token
    start: int
    kind, text = "", "\\left"


@dataclass(frozen=True)
class Table:
    """An environment with lines of cells: a matrix, cases, or several lines of formulas."""

    name: str
    lines: tuple[tuple[Row, ...], ...]
    start: int
    kind, text = "", "table"


Node = Token | Row | Accent | Font | Script | Scripts | Fraction | Root | Delimited | Table


def alone(node: Node) -> Node:
    """Return a node without the groups in braces that have a single item: x for ``{{x}}``, ``{x y}`` for itself."""
    while isinstance(node, Row) and len(node.items) == 1:
        node = node.items[0]
    return node


def divided(row: Row, mark: str) -> list[Row]:
    """Split a row at all tokens with the text ``mark``, such as ``&``; return the rows between these tokens."""
    rows, first = [], 0
    for place, item in enumerate(row.items):
        if item.text == mark:
            rows.append(Row(row.items[first:place], row.items[first].start, item.start))
            first = place + 1
    rest = row.items[first:]
    return [*rows, Row(rest, rest[0].start if rest else row.end, row.end)]
