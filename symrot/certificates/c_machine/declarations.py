"""Declarations of C: structures, enumerations and variables with their initial values."""

from fractions import Fraction
from typing import Any

from symrot.certificates.c_machine.expressions import Expressions
from symrot.certificates.c_machine.values import INT, REAL, Run, Struct, Type

__all__ = ["Declarations"]


class Declarations(Expressions):
    """Reader of C declarations: it records names and types, and translates initial values to Python functions.

    Such a Python function takes the frame, the list of the values of a C function's variables, and returns or stores
    the initial value of a variable.
    """

    def _declarator(self, base: Type) -> tuple[str, Type]:
        while self._take("*"):
            base = Type("pointer", base)
            self._skip_qualifiers()
        name, sizes = self._name(), []
        while self._take("["):
            sizes.append(None if self._text == "]" else self._constant())
            self._expect("]")
        for size in reversed(sizes):
            base = Type("array", base, -1 if size is None else size)
        return name, base

    def _constant(self) -> int:
        value = self._choice()
        if value.type != INT:
            raise self._fail("a whole number")
        return int(value.run([]))

    def _enumeration(self) -> None:
        self._expect("{")
        value = 0
        while not self._take("}"):
            name = self._name()
            value = self._constant() if self._take("=") else value
            self.constants[name] = value
            value += 1
            self._take(",")
        self._expect(";")

    def _fields(self) -> Struct:
        struct = Struct([], [])
        self._expect("{")
        while not self._take("}"):
            base = self._base()
            while True:
                name, kind = self._declarator(base)
                struct.names.append(name)
                struct.types.append(kind)
                if not self._take(","):
                    break
            self._expect(";")
        return struct

    def _variables(self, kind: Type, name: str, base: Type, is_global: bool) -> list[Run]:
        """Read the rest of a declaration; return Python functions that give local variables their initial values.

        The name and the type (``kind``) of the first variable were read before. Global variables get their initial
        values at once.
        """
        runs: list[Run] = []
        while True:
            initial = None
            if self._take("="):
                initial = self._initialiser(kind)
                if kind.kind == "array" and kind.size < 0:
                    kind = kind._replace(size=len(initial([])))
            if is_global:
                self.globals.append(initial([]) if initial else self._blank(kind))
                self.scopes[0][name] = (kind, True, len(self.globals) - 1)
            else:
                slot = self._slot()
                self.scopes[-1][name] = (kind, False, slot)
                runs.append(self._set(slot, kind, initial))
            if not self._take(","):
                break
            name, kind = self._declarator(base)
        self._expect(";")
        return runs

    def _set(self, slot: int, kind: Type, initial: Run | None) -> Run:
        if initial is None:
            if kind.kind in ("int", "real", "pointer"):
                return lambda f: f.__setitem__(slot, None)
            return lambda f: f.__setitem__(slot, self._blank(kind))
        first = initial
        return lambda f: f.__setitem__(slot, first(f))

    def _blank(self, kind: Type) -> Any:
        if kind.kind == "array":
            return [self._blank(kind.of) for _ in range(kind.size)]
        if kind.kind == "struct":
            return [self._blank(each) for each in self.structs[kind.of].types]
        return 0 if kind == INT else self.number(Fraction(0)) if kind == REAL else None

    def _initialiser(self, kind: Type) -> Run:
        if not self._take("{"):
            return self._converted(self._assignment(), kind)
        if kind.kind == "struct":
            types = self.structs[kind.of].types
        elif kind.kind == "array":
            types = [kind.of] * (kind.size if kind.size >= 0 else len(self.tokens))
        else:
            raise self._fail("a value")
        parts: list[Run] = []
        while not self._take("}"):
            parts.append(self._initialiser(types[len(parts)]))
            self._take(",")
        rest = types[len(parts) :] if kind.kind == "struct" or kind.size >= 0 else []
        return lambda f: [part(f) for part in parts] + [self._blank(each) for each in rest]
