"""The tokens of LaTeX, with their positions. A delimiter with its size is one token, an environment's begin another."""

import re
from collections.abc import Callable
from typing import NamedTuple

__all__ = ["GREEK", "Token", "tokens"]

_LETTERS = """
alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lambda mu nu xi rho varrho sigma tau
upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega ell"""
GREEK = frozenset(_LETTERS.split())

_KINDS = {  # the commonest tokens first; blanks match nothing
    "letter": r"[A-Za-z]",
    "mark": r"[-+=(){}\[\]&]",
    "number": r"\d+(?:\.\d+)?|\.\d+",
    "prime": r"(?:\^\s*)?(?:\\prime#|['′])+|\^\s*\{\s*(?:(?:\\prime#|['′])\s*)+\}",
    "script": r"[_^]",
    "space": r"~|%[^\n]*|\\[,:;! ]|\\(?:q?quad|displaystyle|textstyle|limits|nolimits|nonumber|notag)#",
    "fraction": r"\\[tdc]?frac#",
    "root": r"\\sqrt#",
    "accent": r"\\(?:d?d?dot|hat|bar|overline|vec|overrightarrow|(?:wide)?tilde|underline)#",
    "font": r"\\(?:math(?:bf|rm|it|sf|cal)|bm|boldsymbol|text|textrm|operatorname)#",
    "left": r"\\left\s*@", "right": r"\\right\s*@", "sized": r"\\(?:[bB]igg?[lrm]?|middle)\s*@",
    "begin": r"\\begin\s*\{(?:array\}\s*\{[clr|\s]*|(?!array\})[A-Za-z]+\*?)\}",
    "close": r"\\end\s*\{[A-Za-z]+\*?\}",
    "line": r"\\\\|\\cr#",
    "command": r"\\(?:[A-Za-z]+|[{}|])",
    "other": r"\\.|\S",
}  # fmt: skip
_DELIMITER = r"(?:[()\[\]|/.<>]|\\[{}|]|\\(?:[lr](?:brace|brack|vert|Vert|angle|floor|ceil)|[vV]ert)#)"
_TOKEN = re.compile(
    "|".join(f"(?P<{kind}>{text})" for kind, text in _KINDS.items())
    .replace("@", _DELIMITER).replace("#", "(?![A-Za-z])"),
    re.ASCII | re.DOTALL,
)  # fmt: skip
_PARTS: dict[str, Callable[[str], str]] = {
    "prime": lambda text: "'" * len(re.findall(r"\\prime|['′]", text)),
    **dict.fromkeys(("begin", "close"), lambda text: re.split("[{}]", text)[1]),
    **dict.fromkeys(("left", "right", "sized"), lambda text: re.sub(r"\\[A-Za-z]+\s*", "", text, count=1)),
}
"""Kind of token -> the part of the source that is its text: the primes, the environment, the delimiter."""


class Token(NamedTuple):
    """A token of a kind, such as ``letter`` or ``command``; ``start`` is its position in the source."""

    kind: str
    text: str
    start: int


def tokens(source: str, start: int = 0, stop: int | None = None) -> list[Token]:
    """Return the tokens of a text without blanks; the last one is of kind ``end``.

    Every character that belongs to no other token is a mark, so that each interpreter refuses it with its place.
    """
    stop = len(source) if stop is None else stop
    pieces = []
    for match in _TOKEN.finditer(source, start, stop):
        kind, text = str(match.lastgroup), match[0]
        if kind in _PARTS:
            text = _PARTS[kind](text)
        # the constructor of a NamedTuple takes twice as long
        pieces.append(tuple.__new__(Token, ("mark" if kind == "other" else kind, text, match.start())))
    return [*pieces, Token("end", "", stop)]
