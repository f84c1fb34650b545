"""The tokens of LaTeX, with their positions: commands, numbers, letters, marks, and space with comments."""

import re
from typing import NamedTuple

__all__ = ["GREEK", "Token", "tokens"]

_LETTERS = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho varrho sigma tau
upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell"""
GREEK = frozenset(_LETTERS.split())

_TOKEN = re.compile(  # the commonest tokens first; blanks match nothing
    r"(?P<letter>[A-Za-z])|(?P<mark>[-+=(){}\[\]^_&])|(?P<number>\d+(?:\.\d+)?|\.\d+)"
    r"|(?P<space>~|%[^\n]*|\\[,:;! ]|\\(?:q?quad|displaystyle|textstyle|limits|nolimits|nonumber|notag)(?![A-Za-z]))"
    r"|(?P<command>\\(?:[A-Za-z]+|[\\{}|]))|(?P<other>\\.|\S)",
    re.ASCII | re.DOTALL,
)


class Token(NamedTuple):
    """A token of ``kind`` command, number, letter, space, mark or end; ``start`` is its position in the source."""

    kind: str
    text: str
    start: int

    @property
    def end(self) -> int:
        """The position after the token."""
        return self.start + len(self.text)


def tokens(source: str, start: int = 0, stop: int | None = None) -> list[Token]:
    """Return the tokens of a text without blanks; the last one is of kind ``end``.

    Every character that belongs to no other token is a mark, so that each interpreter refuses it with its place.
    """
    stop = len(source) if stop is None else stop
    pieces = []
    for match in _TOKEN.finditer(source, start, stop):
        kind = match.lastgroup
        # the constructor of a NamedTuple takes twice as long
        pieces.append(tuple.__new__(Token, ("mark" if kind == "other" else kind, match[0], match.start())))
    return [*pieces, Token("end", "", stop)]
