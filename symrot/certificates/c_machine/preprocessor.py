"""The tokens of a C text after preprocessing: without comments, with macros replaced and conditional parts chosen.

No macro is defined in advance, not even those of compilers. ``#include`` and ``#pragma`` are ignored.
"""

import re
from typing import NamedTuple

from symrot.errors import CertificateError

__all__ = ["Token", "tokens_of"]

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_TOKEN = re.compile(
    r"\s*(?:(?P<number>0[xX][0-9a-fA-F]*\.?[0-9a-fA-F]*[pP][+-]?\d+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<text>\"[^\"]*\")"
    r"|(?P<mark>##|->|\+\+|--|<<=|<<|&&|\|\||[-+*/<>=!]=|[-+*/%<>=!&|~?:;,.()\[\]{}#]))",
    re.ASCII,
)
_DEEPEST = 40  # macros inside each other


class Token(NamedTuple):
    """A token: its kind ("number", "name", "text" for a string, or "mark"), its text and its line."""

    kind: str
    text: str
    line: int


class _Macro(NamedTuple):
    parameters: list[str] | None  # None for a macro without arguments
    body: list[Token]


def _split(text: str, line: int) -> list[Token]:
    tokens, position = [], 0
    text = text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise CertificateError(
                f"line {line}: expected C as symrot emits it, got {text[position : position + 20]!r}"
            )
        tokens.append(Token(str(match.lastgroup), match[str(match.lastgroup)], line))
        position = match.end()
    return tokens


class _Preprocessor:
    def __init__(self) -> None:
        self.macros: dict[str, _Macro] = {}
        self.active = [True]  # whether the text of each open #if is used
        self.chosen = [True]  # whether a branch of each open #if has been used

    def directive(self, text: str, line: int) -> None:
        word, _, rest = text[1:].strip().partition(" ")
        if word in ("if", "ifdef", "ifndef"):
            self.active.append(self.active[-1] and self._holds(word, rest, line))
            self.chosen.append(self.active[-1])
        elif word in ("elif", "else"):
            left = self.active[-2] and not self.chosen[-1]
            self.active[-1] = left and (word == "else" or self._holds("if", rest, line))
            self.chosen[-1] |= self.active[-1]
        elif word == "endif":
            self.active.pop()
            self.chosen.pop()
        elif self.active[-1] and word == "define":
            self._define(rest, line)
        elif self.active[-1] and word not in ("include", "pragma"):
            raise CertificateError(f"line {line}: expected a preprocessor line that symrot emits, got {text!r}")

    def _holds(self, word: str, rest: str, line: int) -> bool:
        if word == "if":
            parts = [re.fullmatch(r"(!?)defined\((\w+)\)", part.strip()) for part in rest.split("&&")]
            if not all(parts):
                raise CertificateError(f"line {line}: expected a condition of defined(..), got {rest!r}")
            return all((match[2] in self.macros) != bool(match[1]) for match in parts if match)
        return (rest.strip() in self.macros) == (word == "ifdef")

    def _define(self, rest: str, line: int) -> None:
        match = re.match(r"(\w+)(\(([^)]*)\))?\s*", rest)
        if match is None:
            raise CertificateError(f"line {line}: expected the name of a macro, got {rest!r}")
        parameters = [each.strip() for each in match[3].split(",")] if match[2] else None
        self.macros[match[1]] = _Macro(parameters, _split(rest[match.end() :], line))

    def expanded(self, tokens: list[Token], depth: int = 0) -> list[Token]:
        if depth > _DEEPEST:
            raise CertificateError(
                f"line {tokens[0].line}: expected macros without recursion, got one that uses itself"
            )
        result: list[Token] = []
        i = 0
        while i < len(tokens):
            token = tokens[i]
            macro = self.macros.get(token.text) if token.kind == "name" else None
            i += 1
            if macro is None:
                result.append(token)
            elif macro.parameters is None:
                result += self.expanded(macro.body, depth + 1)
            elif i < len(tokens) and tokens[i].text == "(":
                arguments, i = _arguments(tokens, i)
                result += self.expanded(_substituted(macro, arguments), depth + 1)
            else:
                result.append(token)
        return result


def _arguments(tokens: list[Token], start: int) -> tuple[list[list[Token]], int]:
    """Return the arguments of a macro call, and the index of the first token after its closing bracket.

    The opening bracket is the token with the index ``start``.
    """
    arguments: list[list[Token]] = [[]]
    depth = 0
    for i in range(start, len(tokens)):
        text = tokens[i].text
        depth += text in "([{" if len(text) == 1 else 0
        depth -= text in ")]}" if len(text) == 1 else 0
        if depth == 0:
            return arguments, i + 1
        if text == "," and depth == 1:
            arguments.append([])
        elif i != start:
            arguments[-1].append(tokens[i])
    raise CertificateError(f"line {tokens[start].line}: expected a closing bracket of a macro, got none")


def _substituted(macro: _Macro, arguments: list[list[Token]]) -> list[Token]:
    replacements = dict(zip(macro.parameters or [], arguments, strict=True))
    result: list[Token] = []
    paste = False
    for token in macro.body:
        if token.text == "##":
            paste = True
            continue
        parts = replacements.get(token.text, [token])
        if paste and result:
            last = result.pop()
            parts = [Token("name", last.text + parts[0].text, last.line), *parts[1:]]
            paste = False
        result += parts
    return result


def tokens_of(text: str) -> list[Token]:
    """Return the tokens of a C text after preprocessing.

    Raises
    ------
    CertificateError
        For a token or a preprocessor line that symrot does not emit. Misplaced lines, such as ``#endif`` alone, raise
        IndexError, and a wrong number of a macro's arguments raises ValueError.
    """
    text = _COMMENT.sub(lambda match: "\n" * match[0].count("\n") or " ", text).replace("\\\n", " \x00")
    preprocessor, line = _Preprocessor(), 0
    plain: list[Token] = []
    result: list[Token] = []
    for row in text.split("\n"):
        line += 1
        bare = row.replace("\x00", "")
        if bare.lstrip().startswith("#"):
            # macros defined later do not change what stands before
            result += preprocessor.expanded(plain)
            plain = []
            preprocessor.directive(bare.strip(), line)
        elif preprocessor.active[-1]:
            plain += _split(bare, line)
        line += row.count("\x00")
    return result + preprocessor.expanded(plain)
