"""The tokens of LaTeX, with their positions: commands, numbers, letters, marks, and commands for space."""

import re
from typing import NamedTuple

__all__ = ["GREEK", "Token", "tokens"]

_LETTERS = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho varrho sigma tau
upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell"""
GREEK = frozenset(_LETTERS.split())

_TOKEN = re.compile(
    r"(?P<blank>\s+|%[^\n]*\n?)"
    r"|(?P<space>~|\\[,:;! ]|\\(?:q?quad|displaystyle|textstyle|limits|nolimits|nonumber|notag)(?![A-Za-z]))"
    r"|(?P<command>\\(?:[A-Za-z]+|[\\{}|]))|(?P<number>\d+(?:\.\d+)?|\.\d+)|(?P<letter>[A-Za-z])|(?P<mark>\\?.)",
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
    """Return the tokens of a text without blanks and comments; the last one is of kind ``end``.

    Every character that belongs to no other token is a mark, so that each interpreter refuses it with its place.
    """
    stop = len(source) if stop is None else stop
    pieces = [
        Token(match.lastgroup, match[0], match.start())  # type: ignore[arg-type]
        for match in _TOKEN.finditer(source, start, stop)
        if match.lastgroup != "blank"
    ]
    return [*pieces, Token("end", "", stop)]
