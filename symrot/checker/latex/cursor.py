"""The cursor of the checker's LaTeX reader: the position in a formula, and the names that the claim declares."""

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from string import whitespace
from typing import ClassVar

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.reader import MOST_PIECES, check_length
from symrot.checker.claim.tree import Node
from symrot.checker.latex.macros import expanded, with_spelled_functions
from symrot.checker.latex.shorthand import extent_of, shorthands
from symrot.checker.typed.cursor import Doubt
from symrot.checker.typed.tokens import LONGEST_NUMBER
from symrot.errors import InputError, complaint
from symrot.latex import cursor, tree
from symrot.latex.reader import read
from symrot.latex.tokens import GREEK, Token, tokens

__all__ = ["CLOSING", "JOINTS", "MATRIX_CALLS", "UPRIGHT", "Cursor", "Names", "is_d", "is_letter"]

CLOSING = {"(": ")", "[": "]", "\\{": "\\}"}
UPRIGHT = ("\\mathrm", "\\mathit", "\\mathsf", "\\textrm")
MATRIX_CALLS = ("Matrix", "cross", "skew", "vee", "inverse", "transpose", "eye", "diag", "qmul",
                "dcm_of", "hstack", "adjugate", *ROTATIONS)  # fmt: skip
MARKS = frozenset("-+*/=<>:;()[]{}&|,−·×⋅")
TEXT_FONTS = ("\\text", "\\mbox", "\\textrm")
"""LaTeX commands that hold words in a formula."""

JOINTS = ("and", "or", "where", "with", "so that", "thus", "hence", "i.e", "if", "for", "when", "since", "so")
"""Words that, inside a command such as ``\\text{and}``, join two equations."""

_COMMANDS = {character: f"\\{name}" for name, character in GREEK.items()} | {
    "π": "\\pi",
    "φ": "\\phi",
    "ε": "\\epsilon",
}
"""Greek letter -> its LaTeX command: ``\\alpha`` for α."""

WRAPPERS = (
    ("", ""), ("$$", "$$"), ("$", "$"), (r"\[", r"\]"), (r"\(", r"\)"),
    *((f"\\begin{{{name}}}", f"\\end{{{name}}}") for name in ("equation*", "equation", "displaymath", "math")),
)  # fmt: skip


@dataclass(frozen=True)
class Names:
    """The names that a claim declares, by kind."""

    symbols: Collection[str] = ()
    functions: Collection[str] = ()
    matrices: Collection[str] = ()  # vectors included
    columns: Collection[str] = ()  # those matrices that have one column
    others: Collection[str] = ()  # scalars that the claim defines by a formula
    implied: bool = True  # whether undeclared names are allowed

    def __contains__(self, name: str) -> bool:
        return name in {*self.symbols, *self.functions, *self.matrices, *self.others}

    def is_matrix(self, node: Node) -> bool:
        """Return whether a tree is a vector or a matrix."""
        if node.kind == "name":
            return node.value in self.matrices
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and self.is_matrix(node.args[0]))
        if node.kind == "index":
            return False
        kinds = [self.is_matrix(child) for child in node.args]
        if node.kind == "product" and len(kinds) > 1 and node.args[0].kind == "transpose":
            return True  # a row times a column is a 1 x 1 matrix
        return any(kinds)

    def is_column(self, node: Node) -> bool:
        """Return whether a matrix is a column vector: bars around it then mean its length, not a determinant."""
        if node.kind == "name":
            return node.value in self.columns
        if node.kind == "call" and node.value == "Matrix":
            first = node.args[0].args[0]
            return first.kind != "list" or len(first.args) == 1
        if node.kind == "call":
            return node.value in ("cross", "vee") or (node.value == "diff" and self.is_column(node.args[0]))
        if node.kind == "product":
            return self.is_column(node.args[-1]) and node.args[0].kind != "transpose"
        return node.kind in ("sum", "neg") and self.is_column(node.args[0])


def is_letter(item: tree.Node) -> bool:
    """Return whether a node of the LaTeX tree is a Latin or Greek letter."""
    return item.kind == "letter" or item.text[1:] in GREEK


def is_d(item: tree.Node) -> bool:
    r"""Return whether a node of the LaTeX tree is a d as in ``dx/dt``: d, ``\partial`` or an upright d, perhaps to a
    power.
    """
    if isinstance(item, tree.Scripts):
        return is_d(item.base) and [script.text for script in item.scripts] == ["^"]
    if isinstance(item, tree.Font):
        return item.text in UPRIGHT and tree.alone(item.inside).text == "d"
    return item.text in ("d", "\\partial")


class Cursor(cursor.Cursor):
    """A position in a formula, with the functions of time, vectors and ambiguous pieces in the text before it.

    Parameters
    ----------
    source, where : str
        The text, and its place for error messages.
    names : Names
        The names that the claim declares.
    flips : collection of (str, int), optional
        The ambiguous parts of the text, each as (kind, position), that get their less usual meaning; None refuses an
        ambiguous text.
    upper : bool
        Whether plus-minus signs stand for their upper signs.
    """

    synonyms: ClassVar[Mapping[str, str]] = {
        "\\top": "\\T", "\\intercal": "\\T", "\\lbrace": "\\{", "\\rbrace": "\\}", "\\lbrack": "[", "\\rbrack": "]",
        "\\vert": "|", "\\lvert": "|", "\\rvert": "|", "\\Vert": "\\|", "\\lVert": "\\|", "\\rVert": "\\|",
        "\\equiv": "=", "\\ast": "*", "−": "-", "·": "\\cdot", "×": "\\times", "⋅": "\\cdot",
    }  # fmt: skip
    depth = integrals = 0
    both_signs = False

    def __init__(
        self, source: str, where: str, names: Names, flips: Collection[tuple[str, int]] | None = None,
        upper: bool = True,
    ) -> None:  # fmt: skip
        place = f"{where}: " if where else ""
        if not isinstance(source, str) or not source.strip():
            raise InputError(f"{place}expected LaTeX of an equation, got empty text")
        check_length(source, place)
        self.source, self.where, self.names, self.flips = source, where, names, flips
        self.doubts: list[Doubt] = []
        self.timed = set(names.functions)
        self.vectors: dict[str, bool] = {}  # name of a vector -> whether it has a hat
        self.notes: list[str] = []
        self.crossed: set[str] = set()  # names without a mark that are vectors by their use
        self.hatted: set[str] = set()  # names of vectors that have a hat somewhere
        self.bare = Counter[str]()  # how often vectors have a mark, but no hat
        self.mixed: frozenset[str] = frozenset()  # vectors that the text has with and without a hat
        start, stop = _unwrapped(source)
        outside = (source[:start] + source[stop:]).strip(whitespace + "$.,;\\[]()")
        if outside and "begin{" not in outside:
            self.notes.append("the words around the formula are not read")
        pieces = [
            piece._replace(kind="command", text=_COMMANDS[piece.text]) if piece.text in _COMMANDS else piece
            for piece in expanded(tokens(source, start, stop), source, where)
        ]
        if flips is not None:
            pieces, spelled = with_spelled_functions(pieces)
            self.notes += [f"{name} is read as a function, not as a product of letters" for name in spelled]
        if {"\\pm", "\\mp"} & {piece.text for piece in pieces}:
            if flips is None:
                sign = next(piece for piece in pieces if piece.text in ("\\pm", "\\mp"))
                raise complaint(source, where, sign.start, "two claims, one for each sign,")
            self.both_signs = True
            pieces = list(_with_signs(pieces, upper))
        for piece, after in zip(pieces, [*pieces[1:], pieces[-1]], strict=True):
            if piece.text == "." and after.kind in ("line", "close", "space"):
                continue  # the end of a line
            if piece.text not in MARKS and (piece.kind == "mark" or piece.text == "."):
                instead = "the difference of two values instead of \\left. .. \\right|"
                alone = "one formula, without the words around it" if piece.text == "$" else "LaTeX of mathematics"
                expected = instead if piece.kind == "left" else alone
                raise complaint(source, where, source.index(piece.text, piece.start), expected)
            if piece.kind == "number" and len(piece.text) > LONGEST_NUMBER:
                raise complaint(source, where, piece.start, f"a number of at most {LONGEST_NUMBER} characters")
        if len(pieces) > MOST_PIECES:
            raise InputError(f"{place}expected at most {MOST_PIECES} numbers, names and signs, got {len(pieces)}")
        self.frames = _frames(pieces)
        self.short = shorthands(pieces, {*names.symbols, *names.functions, *names.matrices, *names.others})
        if self.short and flips is not None and self.doubtful("shorthand", *extent_of(pieces, min(self.short)), ""):
            self.short = {}
        super().__init__(source, where, read(source, where, pieces))

    def doubtful(self, kind: str, item: tree.Node, stop: int, expected: str, place: tree.Node | None = None) -> bool:
        """Record that the text from ``item`` to ``stop`` is ambiguous; return whether it gets its less usual meaning.

        Raises
        ------
        InputError
            If the text must be unambiguous; the message asks for ``expected`` at ``place``, by default ``item``.
        """
        if self.flips is None:
            raise self.fail(expected, place or item)
        doubt = Doubt((kind, item.start), self.source[item.start : stop].strip())
        if doubt.key not in [known.key for known in self.doubts]:
            self.doubts.append(doubt)
        return doubt.key in self.flips

    def words(self, item: tree.Node) -> str:
        r"""Return the words in a node such as ``\text{for all}``; an empty text if the node is a formula or a name."""
        if not isinstance(item, tree.Font) or item.text not in TEXT_FONTS:
            return ""
        inside = item.inside
        end = inside.end if isinstance(inside, tree.Row) else inside.start + 1
        words = self.source[inside.start : end].strip("{} ~,;.:").lower()
        return words if " " in words or "(" in words or words in JOINTS else ""


def _with_signs(pieces: Sequence[Token], upper: bool) -> Iterator[Token]:
    r"""Yield tokens with + for ``\pm`` and - for ``\mp`` if ``upper``, otherwise with - and +."""
    signs = {"\\pm": "+-", "\\mp": "-+"}
    for piece in pieces:
        both = signs.get(piece.text)
        yield Token("mark", both[not upper], piece.start) if both else piece


def _frames(pieces: Sequence[Token]) -> set[str]:
    r"""Return the letters of frames that stand before names, such as A and B in ``{}^A x = R\,{}^B x``."""
    texts = [piece.text for piece in pieces]
    frames = set()
    for place in range(len(texts) - 3):
        if texts[place : place + 2] == ["{", "}"] and texts[place + 2] in ("^", "_"):
            rest = [text for text in texts[place + 3 :] if text not in ("{", *UPRIGHT, "\\mathcal", "\\mathbf")]
            frames.add(rest[0])
    return frames


_INLINE = re.compile(r"\$\$.+?\$\$|(?<!\$)\$[^$]+\$(?!\$)|(?<!\\)\\\(.+?\\\)|(?<!\\)\\\[.+?\\\]", re.DOTALL)
"""Pattern of a LaTeX formula in a text, between dollar signs or between ``\\(`` and ``\\)`` or ``\\[`` and ``\\]``."""


def _unwrapped(source: str) -> tuple[int, int]:
    """Return the positions at which the formula starts and ends (exclusive), without the dollar signs around it and the
    full stop after it.
    """
    start, end = 0, len(source)
    formulas = list(_INLINE.finditer(source))
    if len(formulas) == 1 and not {"=", "<", ">"} & {*source[: formulas[0].start()], *source[formulas[0].end() :]}:
        start, end = formulas[0].span()
    for opening, closing in WRAPPERS:
        if source.startswith(opening, start) and source.endswith(closing, start + len(opening), end):
            inside = source[start + len(opening) : end - len(closing)]
            shorter = inside.rstrip(whitespace + ".,;")
            shorter = inside[: len(shorter) + shorter.endswith("\\")]  # \\, is a space
            end = start + len(opening) + len(shorter)
            start = end - len(shorter.lstrip())
    return start, end
