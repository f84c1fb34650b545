"""Hashes of texts, and of Python code without its docstrings and comments, for certificates and keys of the cache."""

import re
from collections.abc import Iterable
from hashlib import sha256

__all__ = ["code_digest", "code_without_prose", "text_digest"]

_STRINGS = (
    r'"""(?:(?!""")[^\\]|\\.)*"""', r"'''(?:(?!''')[^\\]|\\.)*'''", r'"(?:[^"\\\n]|\\.)*"', r"'(?:[^'\\\n]|\\.)*'",
)  # fmt: skip
_STRING = "|".join(_STRINGS)
_TOKENS = re.compile(
    r"(?P<comment>[ \t]*#[^\n]*)"
    rf"|(?P<statement>(?<!\\\n)^[ \t]*[rR]?(?:{_STRING})(?=[ \t]*(?:#|$)))"  # the whole statement, such as a docstring
    rf"|(?P<string>{_STRING})|(?P<open>[(\[{{])|(?P<close>[)\]}}])",
    re.MULTILINE | re.DOTALL,
)


def code_without_prose(source: str) -> str:
    r"""Return Python source without its docstrings, its comments and the lines that then are blank.

    ``"def f(x):\n    # why\n    return x  # m\n"`` gives ``"def f(x):\n    return x\n"``.
    """
    # by a pattern: the modules tokenize and ast take 20 times as long
    parts, position, depth, end = [], 0, 0, "\n"
    for token in _TOKENS.finditer(source):
        kind, (first, last) = token.lastgroup, token.span()
        depth += (kind == "open") - (kind == "close")
        if kind == "comment" or (kind == "statement" and not depth):
            parts.append(source[position:first])
            end = parts[-1][-1:] or end  # last character before the token
            position = last + (end == source[last : last + 1] == "\n")
    return "".join([*parts, source[position:]])


def text_digest(*texts: str) -> str:
    """Return the SHA-256 of a text, or of several texts in their order, with the character NUL between them."""
    return sha256("\0".join(texts).encode()).hexdigest()


def code_digest(sources: Iterable[str]) -> str:
    """Return the SHA-256 of Python sources without their docstrings and comments."""
    return text_digest(*map(code_without_prose, sources))
