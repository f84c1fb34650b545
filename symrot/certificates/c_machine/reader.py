"""Reading a C text for the class ``Machine``, which runs C in Python: tokens, types, and names declared so far."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from symrot.certificates.c_machine.preprocessor import Token, tokens_of
from symrot.certificates.c_machine.values import INT, REAL, VOID, Frame, Function, Struct, Type
from symrot.errors import CertificateError

__all__ = ["Reader"]

_BASIC = {
    "int": INT, "size_t": INT, "ptrdiff_t": INT, "uint64_t": INT, "unsigned": INT, "double": REAL, "float": REAL,
    "void": VOID,
}  # fmt: skip
_QUALIFIERS = {"const", "static", "inline", "volatile", "restrict", "extern"}


class Reader:
    """The state of reading a C text; for parameters see :class:`symrot.certificates.c_machine.machine.Machine`."""

    def __init__(
        self, text: str, number: Callable[[Fraction], Any], own: Mapping[str, tuple[str, Callable[..., Any]]]
    ) -> None:
        self.number, self.own = number, own
        self.tokens, self.index = tokens_of(text), 0
        self.structs: dict[str, Struct] = {}
        self.constants: dict[str, int] = {}
        self.functions: dict[str, Function] = {}
        self.globals: Frame = []
        self.scopes: list[dict[str, tuple[Type, bool, int]]] = [{}]  # name -> type, whether it is global, slot
        self.slots = 0
        self.result = VOID  # of the function that is being read
        self.steps = 0

    @property
    def _text(self) -> str:
        return self.tokens[self.index].text if self.index < len(self.tokens) else ""

    def _slot(self) -> int:
        self.slots += 1
        return self.slots - 1

    def _fail(self, expected: str) -> CertificateError:
        line = self.tokens[min(self.index, len(self.tokens) - 1)].line
        return CertificateError(f"line {line}: expected {expected}, got {self._text!r}")

    def _next(self) -> Token:
        if self.index >= len(self.tokens):
            raise self._fail("more text")
        self.index += 1
        return self.tokens[self.index - 1]

    def _take(self, text: str) -> bool:
        if self._text != text:
            return False
        self.index += 1
        return True

    def _expect(self, text: str) -> None:
        if not self._take(text):
            raise self._fail(repr(text))

    def _name(self) -> str:
        token = self._next()
        if token.kind != "name":
            self.index -= 1
            raise self._fail("a name")
        return token.text

    def _is_type(self, word: str) -> bool:
        return word in _BASIC or word in _QUALIFIERS or word in self.structs

    def _skip_qualifiers(self) -> None:
        while self._text in _QUALIFIERS:
            self.index += 1

    def _base(self) -> Type:
        self._skip_qualifiers()
        word = self._text
        if word not in _BASIC and word not in self.structs:
            raise self._fail("a type")
        self.index += 1
        self._skip_qualifiers()
        return _BASIC.get(word) or Type("struct", word)
