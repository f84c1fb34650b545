"""The tokens of LaTeX with their positions; commands for space and size are dropped, unknown ones refused."""

import re
from typing import NamedTuple

from symrot.checker.claim.reader import LONGEST_TEXT, MOST_PIECES, complaint
from symrot.errors import InputError

__all__ = ["GREEK", "Token", "tokens"]

_LETTERS = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho varrho sigma tau
upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell"""
GREEK = frozenset(_LETTERS.split())
SPACES = frozenset(["quad", "qquad", "displaystyle", "textstyle", "limits", "nolimits", "nonumber", "notag"])
SIZES = frozenset(["left", "right", "big", "Big", "bigl", "bigr", "Bigl", "Bigr", "biggl", "biggr", "middle"])
SYNONYMS = {
    "\\dfrac": "\\frac", "\\tfrac": "\\frac", "\\cfrac": "\\frac",
    "\\top": "\\T", "\\intercal": "\\T", "\\lbrace": "\\{", "\\rbrace": "\\}",
    "\\lbrack": "[", "\\rbrack": "]", "\\vert": "|", "\\lvert": "|", "\\rvert": "|", "\\Vert": "\\|", "\\lVert": "\\|",
    "\\rVert": "\\|", "\\equiv": "=", "\\ast": "*", "\\bm": "\\mathbf", "\\boldsymbol": "\\mathbf", "\\prime": "'",
    "\\mathit": "\\mathrm", "\\mathsf": "\\mathrm", "\\textrm": "\\mathrm", "\\cr": "\\\\",
    "−": "-", "·": "\\cdot", "×": "\\times", "′": "'", "⋅": "\\cdot",
}  # fmt: skip

_TOKEN = re.compile(
    r"(?P<space>\s+|\\[,;:! ]|~|%[^\n]*\n?)|(?P<command>\\[A-Za-z]+|\\[\\{}|])|(?P<number>\d+(?:\.\d+)?|\.\d+)"
    r"|(?P<letter>[A-Za-z])|(?P<mark>[-+*/=()\[\]{}^_&|,'−·×′⋅])",
    re.ASCII,
)
_WRAPPERS = (
    ("$$", "$$"), ("$", "$"), (r"\[", r"\]"), (r"\(", r"\)"),
    *((f"\\begin{{{name}}}", f"\\end{{{name}}}") for name in ("equation*", "equation", "displaymath", "math")),
)  # fmt: skip


class Token(NamedTuple):
    """A token of ``kind`` command, number, letter, mark or end; ``spaced`` if a space such as ``\\,`` precedes it."""

    kind: str
    text: str
    position: int
    spaced: bool = False


def tokens(source: str, where: str) -> list[Token]:
    """Return the tokens of a formula, the last one of kind ``end``; raise InputError at text that is no token."""
    place = f"{where}: " if where else ""
    if len(source) > LONGEST_TEXT:
        raise InputError(f"{place}expected a formula of at most {LONGEST_TEXT} characters, got {len(source)}")
    start, end = _inside(source)
    pieces: list[Token] = []
    spaced = False
    while start < end:
        match = _TOKEN.match(source, start, end)
        if match is None:
            raise complaint(source, where, start, "LaTeX of mathematics")
        kind, text = str(match.lastgroup), match[0]
        if kind == "space":
            spaced = spaced or text.startswith("\\")
        elif text[1:] in SPACES:
            spaced = True
        elif text[1:] not in SIZES:
            known = SYNONYMS.get(text, text)
            kind = kind if known == text else "command" if known.startswith("\\") else "mark"
            pieces.append(Token(kind, known, start, spaced))
            spaced = False
        start = match.end()
    if len(pieces) > MOST_PIECES:
        raise InputError(f"{place}expected a formula of at most {MOST_PIECES} pieces, got {len(pieces)}")
    return [*pieces, Token("end", "", end)]


def _inside(source: str) -> tuple[int, int]:
    """Return where the formula starts and ends, without dollar signs around it and a full stop after it."""
    start, end = 0, len(source)

    def strip() -> None:
        nonlocal start, end
        while start < end and source[start].isspace():
            start += 1
        while end > start and (source[end - 1].isspace() or source[end - 1] in ".,;"):
            end -= 1

    strip()
    for opening, closing in _WRAPPERS:
        if source.startswith(opening, start) and source.endswith(closing, start + len(opening), end):
            start, end = start + len(opening), end - len(closing)
            strip()
    return start, end
