"""The cursor of the LaTeX checker: the place in a formula, and the methods that parts of its grammar call in others."""

from abc import abstractmethod
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import ClassVar

from symrot.checker.claim.reader import LONGEST_TEXT, MOST_PIECES
from symrot.checker.claim.tree import Node
from symrot.errors import InputError, complaint
from symrot.latex import cursor, tree
from symrot.latex.reader import read
from symrot.latex.tokens import GREEK, tokens

__all__ = ["CLOSING", "TIME", "UPRIGHT", "Cursor", "Names", "is_letter"]

CLOSING = {"(": ")", "[": "]", "\\{": "\\}"}
TIME = Node("name", "t")
UPRIGHT = ("\\mathrm", "\\mathit", "\\mathsf", "\\textrm")
MARKS = frozenset("-+*/=()[]{}^_&|,'−·×′⋅")
WRAPPERS = (
    ("$$", "$$"), ("$", "$"), (r"\[", r"\]"), (r"\(", r"\)"),
    *((f"\\begin{{{name}}}", f"\\end{{{name}}}") for name in ("equation*", "equation", "displaymath", "math")),
)  # fmt: skip


@dataclass(frozen=True)
class Names:
    """The declared names: symbols, functions of time, definitions that are matrices or columns, other definitions.

    With ``implied`` undeclared names are allowed.
    """

    symbols: Collection[str] = ()
    functions: Collection[str] = ()
    matrices: Collection[str] = ()
    columns: Collection[str] = ()
    others: Collection[str] = ()
    implied: bool = True

    def __contains__(self, name: str) -> bool:
        return name in {*self.symbols, *self.functions, *self.matrices, *self.others}


def is_letter(item: tree.Node) -> bool:
    """Return whether an item is a Latin or Greek letter."""
    return item.kind == "letter" or item.text[1:] in GREEK


class Cursor(cursor.Cursor):
    """The place in a formula, with the integrals and bars that are open there, and the names that depend on time."""

    synonyms: ClassVar[Mapping[str, str]] = {
        "\\top": "\\T", "\\intercal": "\\T", "\\lbrace": "\\{", "\\rbrace": "\\}", "\\lbrack": "[", "\\rbrack": "]",
        "\\vert": "|", "\\lvert": "|", "\\rvert": "|", "\\Vert": "\\|", "\\lVert": "\\|", "\\rVert": "\\|",
        "\\equiv": "=", "\\ast": "*", "−": "-", "·": "\\cdot", "×": "\\times", "⋅": "\\cdot",
    }  # fmt: skip
    open_bars: tuple[str, ...] = ()
    depth = integrals = 0

    def __init__(self, source: str, where: str, names: Names) -> None:
        place = f"{where}: " if where else ""
        if not isinstance(source, str) or not source.strip():
            raise InputError(f"{place}expected LaTeX of an equation, got empty text")
        if len(source) > LONGEST_TEXT:
            raise InputError(f"{place}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")
        self.source, self.where, self.names = source, where, names
        self.timed = set(names.functions)
        pieces = tokens(source, *_unwrapped(source))
        for piece in pieces:
            if piece.kind == "mark" and piece.text not in MARKS:
                raise self.fail("LaTeX of mathematics", piece)
        if len(pieces) > MOST_PIECES:
            raise InputError(f"{place}expected a formula of at most {MOST_PIECES} pieces, got {len(pieces)}")
        super().__init__(read(source, where, pieces))

    def fail(self, expected: str, item: tree.Node | None = None) -> InputError:
        return complaint(self.source, self.where, (item or self.peek()).start, expected)

    # -- methods that parts of the grammar call in other parts --------------------------------------------------------

    @abstractmethod
    def expression(self) -> Node:
        """Read a sum."""

    @abstractmethod
    def factor(self) -> Node:
        """Read a piece with its powers."""

    @abstractmethod
    def base(self, item: tree.Node, script: bool = True) -> Node:
        """Read a piece without its powers; without ``script``, without its index and primes too."""

    @abstractmethod
    def argument(self, node: tree.Node) -> Node:
        """Read the argument of a command: a group in braces, or one token."""

    @abstractmethod
    def bracket(self, opening: tree.Node) -> Node:
        """Read an expression and its closing bracket, after the opening one."""

    @abstractmethod
    def starts_factor(self) -> bool:
        """Return whether a factor may start at the cursor."""

    @abstractmethod
    def derivative(self, node: Node, times: int, item: tree.Node) -> Node:
        """Return a time derivative."""


def _unwrapped(source: str) -> tuple[int, int]:
    """Return where the formula starts and ends, without dollar signs around it and a full stop after it."""
    start, end = 0, len(source)

    def strip() -> None:
        nonlocal start, end
        while start < end and source[start].isspace():
            start += 1
        while end > start and (source[end - 1].isspace() or source[end - 1] in ".,;"):
            end -= 1

    strip()
    for opening, closing in WRAPPERS:
        if source.startswith(opening, start) and source.endswith(closing, start + len(opening), end):
            start, end = start + len(opening), end - len(closing)
            strip()
    return start, end
