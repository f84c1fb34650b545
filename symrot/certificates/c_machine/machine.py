"""A machine that runs functions of C on numbers of any kind, such as decimals of 60 digits instead of doubles.

It knows the C of symrot's closed forms: structures, arrays, pointers, ``for``, ``if`` and ``switch``, but neither
strings nor allocation. Every ``double`` operation is one operation on the numbers, and every constant has the exact
value of the double. Integers have any size: unsigned ones do not wrap around. Each module of this folder reads larger
units of the text than the one before: types (reader.py), expressions, declarations, statements, functions (machine.py).
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from symrot.certificates.c_machine.statements import Statements
from symrot.certificates.c_machine.values import Function, Type, called, pointer
from symrot.errors import CertificateError, InputError

__all__ = ["Machine"]

_FAULTS = (ArithmeticError, AttributeError, IndexError, RecursionError, TypeError, ValueError)
"""The exceptions that reading or running a faulty text may raise."""


class Machine(Statements):
    """The functions of a C text, which :meth:`call` runs on numbers of any one kind, such as decimals of 60 digits.

    Parameters
    ----------
    text : str
        The C text.
    number : callable
        Converts a Fraction, the exact value of a ``double`` constant, to a number of that kind.
    own : mapping of str to (str, callable)
        Python functions that replace functions of the text or of ``<math.h>``: name -> (types, function). The types
        are a letter for the result, then one for each argument: "r" a number, "i" an integer, others any type. If the
        text declares the function, the declaration counts instead of the letters. A pointer is passed as a pair
        (list, index).

    Raises
    ------
    CertificateError
        For C that symrot does not emit.
    """

    def __init__(
        self, text: str, number: Callable[[Fraction], Any], own: Mapping[str, tuple[str, Callable[..., Any]]]
    ) -> None:
        try:
            super().__init__(text, number, own)
            while self.index < len(self.tokens):
                self._declared_outside()
        except _FAULTS as reason:
            raise CertificateError(f"expected C that symrot emits, got a text with a fault ({reason})") from None

    def blank(self, struct: str) -> list[Any]:
        """Return a structure of the C text with zeros in its fields (None in pointers)."""
        fields: list[Any] = self._blank(Type("struct", struct))
        return fields

    def call(self, name: str, *arguments: Any) -> Any:
        """Call a function with numbers, integers and pointers; return its result, or None if it has none.

        CertificateError is raised if the text has no such function, or for a fault while the function runs.
        """
        if name not in self.functions:
            raise CertificateError(f"expected a function {name} in the C text, got none")
        self.steps = 0
        try:
            return called(self.functions[name], arguments)
        except InputError:  # from a function in ``own``
            raise
        except _FAULTS as reason:
            raise CertificateError(f"{name}: expected a C text that runs, got a fault ({reason})") from None

    def _declared_outside(self) -> None:
        if self._take("enum"):
            self._enumeration()
        elif self._take("typedef"):
            self._expect("struct")
            struct = self._fields()
            self.structs[self._name()] = struct
            self._expect(";")
        elif not self._take(";"):
            self._function_or_table()

    def _function_or_table(self) -> None:
        base = self._base()
        name, kind = self._declarator(base)
        if self._text != "(":
            self._variables(kind, name, base, is_global=True)
            return
        self._expect("(")
        self.scopes.append({})
        self.slots, parameters = 0, []
        while not self._take(")"):
            if self._text == "void" and self.tokens[self.index + 1].text == ")":
                self.index += 1
                continue
            parameter, of = self._declarator(self._base())
            of = pointer(of)
            parameters.append(of)
            self.scopes[-1][parameter] = (of, False, self._slot())
            self._take(",")
        function = self.functions.setdefault(name, Function(kind, parameters, [], [0]))
        if not self._take(";"):
            if name in self.own:
                self._skip_block()
            else:
                self.result = kind
                function.body.append(self._block())
                function.slots[0] = self.slots
        self.scopes.pop()

    def _skip_block(self) -> None:
        self._expect("{")
        depth = 1
        while depth:
            text = self._next().text
            depth += (text == "{") - (text == "}")
