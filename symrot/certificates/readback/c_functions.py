"""The functions in a C text, each as a list of tokens; C that symrot does not emit raises an error.

This module shares no code with the emitter, so that a mistake there cannot hide here. ``where`` is the name of a file,
for error messages.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

from symrot.errors import CertificateError

__all__ = ["CFunction", "Cursor", "Parameter", "Token", "functions_of"]

_TOKEN = re.compile(
    r"(?P<space>\s+)|(?P<number>(?:0[xX][0-9a-fA-F]+\.?[0-9a-fA-F]*[pP][+-]?\d+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)f?)"
    r"|(?P<name>[A-Za-z_]\w*)|(?P<mark>\+\+|--|<=|>=|==|!=|[-+*/()\[\]{},;=<>?:])",
    re.ASCII,
)
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_DIRECTIVE = re.compile(r'\s*#\s*(?:include\s*(?:<(?:math|stddef)\.h>|"\w+\.h")|pragma\s+STDC\s+FP_CONTRACT\s+OFF)\s*')


@dataclass(frozen=True)
class Token:
    """A token of C: its kind (``name``, ``number`` or ``mark``), its text and the number of its line."""

    kind: str
    text: str
    line: int


@dataclass(frozen=True)
class Parameter:
    """A parameter of a C function; ``size`` is the length of an array, 0 for a scalar, -1 for a bare pointer."""

    name: str
    type: str
    size: int
    is_const: bool


@dataclass(frozen=True)
class CFunction:
    """A C function: its signature, and its body as tokens that are parsed only when the function is needed."""

    name: str
    returns: str
    parameters: tuple[Parameter, ...]
    body: tuple[Token, ...]
    line: int


def _tokens(text: str, where: str) -> list[Token]:
    """Return the tokens (names, numbers, marks) of a C file without comments and directives.

    ``where`` is the file's name, for messages.
    """
    if "??" in text or "\\" in text:  # trigraphs and spliced lines are never emitted, and could hide code from a reader
        raise CertificateError(
            f"{where}: expected C without backslashes and trigraphs, as symrot emits it, got a text with one of these"
        )
    bare = _COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    lines = bare.split("\n")
    for number, line in enumerate(lines, 1):
        if "#" in line:
            if not _DIRECTIVE.fullmatch(line):
                raise CertificateError(
                    f"{where}, line {number}: expected an #include that symrot emits, got {line.strip()!r}"
                )
            lines[number - 1] = ""
    tokens: list[Token] = []
    for number, line in enumerate(lines, 1):
        position = 0
        while position < len(line):
            match = _TOKEN.match(line, position)
            if match is None:
                raise CertificateError(
                    f"{where}, line {number}: expected a character of C as symrot emits it, got {line[position]!r}"
                )
            position = match.end()
            if match.lastgroup != "space":
                tokens.append(Token(str(match.lastgroup), match[0], number))
    return tokens


class Cursor:
    """The tokens of a C file or of one function body, with the ``index`` of the next token to read."""

    def __init__(self, tokens: list[Token] | tuple[Token, ...], where: str) -> None:
        self.tokens, self.where, self.index = tokens, where, 0

    def peek(self, ahead: int = 0) -> str:
        """Return the text of the next token, or of the token ``ahead`` positions later; empty beyond the end."""
        index = self.index + ahead
        return self.tokens[index].text if index < len(self.tokens) else ""

    def next(self) -> Token:
        """Return the next token and move past it."""
        if self.index >= len(self.tokens):
            raise self.fail("more C text")
        self.index += 1
        return self.tokens[self.index - 1]

    def fail(self, expected: str, got: str = "") -> CertificateError:
        """Return a CertificateError that names the line, ``expected`` and ``got`` (default: the next token)."""
        at = min(self.index, len(self.tokens) - 1)
        if not got:
            got = repr(self.tokens[at].text) if 0 <= self.index < len(self.tokens) else "the end"
        line = self.tokens[at].line if self.tokens else 1
        return CertificateError(f"{self.where}, line {line}: expected {expected}, got {got}")

    def expect(self, *marks: str) -> None:
        """Move past tokens that must have exactly these texts; raise CertificateError at the first that differs."""
        for mark in marks:
            if self.peek() != mark:
                raise self.fail(f"'{mark}'")
            self.index += 1

    def name(self) -> str:
        """Return the text of the next token, which must be a name, and move past the token."""
        if self.index >= len(self.tokens) or self.tokens[self.index].kind != "name":
            raise self.fail("a name")
        return self.next().text

    def integer(self) -> int:
        """Return the value of the next token, which must be an integer, and move past the token."""
        if not re.fullmatch(r"0|[1-9]\d*", self.peek(), re.ASCII):  # 010 would be 8 in C
            raise self.fail("an index")
        return int(self.next().text)

    def block(self) -> tuple[Token, ...]:
        """Return the tokens between the next opening brace and its closing brace, and move past both braces."""
        self.expect("{")
        start, depth = self.index, 1
        while depth:
            depth += {"{": 1, "}": -1}.get(self.next().text, 0)
        return tuple(self.tokens[start : self.index - 1])


@lru_cache(maxsize=32)
def functions_of(text: str, where: str = "kernel") -> Mapping[str, CFunction]:
    """Return the functions that a C file defines, by name; prototypes are skipped.

    Raises
    ------
    CertificateError
        If the text contains C that symrot does not emit; the message names the line.
    """
    # the result is cached, because each text holds several functions: double and float, one sample and batch
    cursor = Cursor(_tokens(text, where), where)
    functions: dict[str, CFunction] = {}
    while cursor.index < len(cursor.tokens):
        function = _function(cursor)
        if function is None:
            continue
        if function.name in functions:
            raise CertificateError(
                f"{where}, line {function.line}: expected one function named {function.name}, got two"
            )
        functions[function.name] = function
    return MappingProxyType(functions)


def _function(cursor: Cursor) -> CFunction | None:
    """Read the next function of a C file; return its signature and body, or None for a prototype, which has no body."""
    while cursor.peek() in ("static", "inline"):
        cursor.next()
    line = cursor.tokens[cursor.index].line if cursor.index < len(cursor.tokens) else 0
    returns = cursor.name()
    if returns not in ("void", "double", "float"):
        raise cursor.fail("a function whose arguments are of type double or float")
    name = cursor.name()
    cursor.expect("(")
    parameters = [_parameter(cursor)]
    while cursor.peek() == ",":
        cursor.next()
        parameters.append(_parameter(cursor))
    cursor.expect(")")
    if len({parameter.name for parameter in parameters}) != len(parameters):
        raise cursor.fail(f"parameters of {name} with names that differ from each other", "one name twice")
    if cursor.peek() == ";":
        cursor.next()
        return None
    return CFunction(name, returns, tuple(parameters), cursor.block(), line)


def _parameter(cursor: Cursor) -> Parameter:
    """Read the next parameter of a C function, such as ``const double q[4]``, and return it."""
    is_const = cursor.peek() == "const"
    if is_const:
        cursor.next()
    kind = cursor.name()
    if kind not in ("double", "float", "size_t"):
        raise cursor.fail("a parameter of type double or float")
    if cursor.peek() == "*":
        cursor.next()
        if cursor.peek() in ("SYMROT_RESTRICT", "restrict"):
            cursor.next()
        return Parameter(cursor.name(), kind, -1, is_const)
    name, size = cursor.name(), 0
    if cursor.peek() == "[":
        cursor.next()
        size = cursor.integer()
        cursor.expect("]")
    return Parameter(name, kind, size, is_const)
