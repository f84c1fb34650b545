"""Expressions of C, translated to Python functions that compute their values from the C variables."""

import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from symrot.certificates.c_machine.reader import Reader
from symrot.certificates.c_machine.values import (
    INT,
    REAL,
    VOID,
    Frame,
    Place,
    Run,
    Struct,
    Type,
    Value,
    called,
    copied,
    pointer,
)
from symrot.errors import CertificateError

__all__ = ["Expressions"]

_BINDING = {
    "||": 1, "&&": 2, "|": 3, "&": 5, "==": 6, "!=": 6, "<": 7, "<=": 7, ">": 7, ">=": 7, "<<": 8, "+": 9, "-": 9,
    "*": 10, "/": 10, "%": 10,
}  # fmt: skip
_PREFIXES: Mapping[str, Callable[[Any], Any]] = {"-": operator.neg, "!": lambda x: int(not x), "~": operator.invert}
_STEPS = {"++": 1, "--": -1}
_LETTERS = {"r": REAL, "i": INT}
"""Letter -> C type, in the signature of a Python function that replaces a C function; other letters mean any type.

The signature ``"rri"`` means: a real result, a real and an integer argument. :class:`Machine` takes the replacements.
"""
_ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "<<="}
_OPERATIONS: Mapping[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "<": operator.lt, ">": operator.gt,
    "<=": operator.le, ">=": operator.ge, "==": operator.eq, "!=": operator.ne, "&": operator.and_, "|": operator.or_,
    "<<": operator.lshift,
}  # fmt: skip


class Expressions(Reader):
    """Reader of C expressions: it reads an expression from the tokens and returns it as a :class:`Value`.

    A Value holds Python functions. Their argument is the frame: the list of the values of a C function's variables. One
    function returns the value of the expression. For a variable, a second function returns its address, a pair
    (container, index).
    """

    def _expression(self) -> Value:
        value = self._assignment()
        while self._take(","):
            first, second = value.run, self._assignment()
            value = Value(second.type, _after(first, second.run))
        return value

    def _assignment(self) -> Value:
        target = self._choice()
        if self._text not in _ASSIGNMENTS:
            return target
        mark = self._next().text
        if target.place is None:
            raise self._fail(f"a variable on the left of {mark!r}")
        value, place, kind = self._assignment(), target.place, target.type
        if mark != "=":
            return self._changed(mark[:-1], kind, place, value)
        run = self._converted(value, kind)

        def assign(f: Frame) -> Any:
            result = run(f)
            container, index = place(f)
            container[index] = result
            return result

        return Value(kind, assign)

    def _changed(self, mark: str, kind: Type, place: Run, value: Value) -> Value:
        """Return an assignment such as ``a[i++] += b`` as a Value that computes the address of the variable once.

        ``mark`` is the operation, such as ``+``; ``kind`` is the variable's type. ``place`` is the Python function that
        takes the frame (the values of the C function's variables) and returns the address of the variable. ``value`` is
        the right side.
        """
        slot = self._slot()  # for the address
        before = self._at(kind, lambda f: f[slot])
        run = self._converted(self._binary(mark, before, value), kind)

        def assign(f: Frame) -> Any:
            f[slot] = container, index = place(f)
            container[index] = result = run(f)
            return result

        return Value(kind, assign)

    def _choice(self) -> Value:
        condition = self._operation(0)
        if not self._take("?"):
            return condition
        then = self._expression()
        self._expect(":")
        other = self._choice()
        test, kind = condition.run, then.type
        if REAL in (then.type, other.type):
            kind = REAL
        elif other.type.kind in ("pointer", "array"):
            kind = other.type
        kind = pointer(kind)
        first, second = self._converted(then, kind), self._converted(other, kind)
        return Value(kind, lambda f: first(f) if test(f) else second(f))

    def _operation(self, least: int) -> Value:
        left = self._unary()
        while _BINDING.get(self._text, 0) > least:
            mark = self._next().text
            left = self._binary(mark, left, self._operation(_BINDING[mark]))
        return left

    def _binary(self, mark: str, left: Value, right: Value) -> Value:
        a, b = left.run, right.run
        if mark == "&&":
            return Value(INT, lambda f: int(bool(a(f)) and bool(b(f))))
        if mark == "||":
            return Value(INT, lambda f: int(bool(a(f)) or bool(b(f))))
        if left.type.kind in ("pointer", "array") or right.type.kind in ("pointer", "array"):
            return self._with_pointer(mark, left, right)
        if left.type == right.type == INT:
            if mark == "/":
                return Value(INT, lambda f: int(Fraction(a(f), b(f))))
            if mark == "%":
                return Value(INT, lambda f: (lambda x, y: x - y * int(Fraction(x, y)))(a(f), b(f)))
        elif mark in ("%", "&", "|", "<<") or left.type not in (INT, REAL) or right.type not in (INT, REAL):
            raise self._fail(f"numbers on both sides of {mark}")
        else:
            a, b = self._converted(left, REAL), self._converted(right, REAL)
        operation = _OPERATIONS[mark]
        if mark in ("<", ">", "<=", ">=", "==", "!="):
            return Value(INT, lambda f: int(operation(a(f), b(f))))
        return Value(INT if left.type == right.type == INT else REAL, lambda f: operation(a(f), b(f)))

    def _with_pointer(self, mark: str, left: Value, right: Value) -> Value:
        a, b = left.run, right.run
        if mark in ("+", "-") and right.type == INT and left.type.kind in ("pointer", "array"):
            sign = 1 if mark == "+" else -1

            def moved(f: Frame) -> Place:
                container, index = a(f)
                return container, _within(index + sign * b(f))

            return Value(Type("pointer", left.type.of), moved)
        if mark in ("==", "!="):
            equal = mark == "=="

            def compared(f: Frame) -> int:
                x, y = a(f) or None, b(f) or None
                same = x is y if x is None or y is None else x[0] is y[0] and x[1] == y[1]
                return int(same == equal)

            return Value(INT, compared)
        raise self._fail("a pointer and a whole number")

    def _unary(self) -> Value:
        if self._text in _PREFIXES:
            mark, value = self._next().text, self._unary()
            prefix, run = _PREFIXES[mark], value.run
            return Value(INT if mark == "!" else value.type, lambda f: prefix(run(f)))
        if self._take("&"):
            value = self._unary()
            if value.place is None:
                raise self._fail("a variable after &")
            return Value(Type("pointer", value.type), value.place)
        if self._take("*"):
            value = self._unary()
            return self._at(value.type.of, value.run)
        if self._text in _STEPS:
            step = _STEPS[self._next().text]
            return self._counted(self._unary(), step, after=False)
        if self._take("sizeof"):
            return self._size()
        if self._text == "(" and self._is_type(self.tokens[self.index + 1].text):
            self._expect("(")
            kind = self._base()
            while self._take("*"):
                kind = Type("pointer", kind)
            self._expect(")")
            value = self._unary()
            return Value(kind, value.run if kind == VOID else self._converted(value, kind))
        return self._postfix()

    def _size(self) -> Value:
        if self._text == "(":
            self._expect("(")
            kind = self._base() if self._is_type(self._text) else self._expression().type
            self._expect(")")
        else:
            kind = self._unary().type
        size = 8 * self._length(kind)
        return Value(INT, lambda f: size)

    def _length(self, kind: Type) -> int:
        """Return the number of doubles in a variable of type ``kind``; an integer or pointer counts as one double."""
        if kind.kind == "struct":
            return sum(map(self._length, self.structs[kind.of].types))
        return kind.size * self._length(kind.of) if kind.kind == "array" else 1

    def _at(self, kind: Type, place: Run) -> Value:
        """Return a C variable as a Value; ``kind`` is its type.

        ``place`` is the Python function that takes the frame (the values of the C function's variables) and returns the
        address of the variable, a pair (container, index).
        """
        if kind.kind == "array":
            # the address of the first element

            def first(f: Frame) -> Place:
                container, index = place(f)
                return container[index], 0

            return Value(kind, first, place)

        def value(f: Frame) -> Any:
            container, index = place(f)
            return container[index]

        return Value(kind, value, place)

    def _counted(self, value: Value, step: int, after: bool) -> Value:
        place = value.place
        if place is None:
            raise self._fail("a variable beside ++ or --")

        def run(f: Frame) -> Any:
            container, index = place(f)
            before = container[index]
            container[index] = before + step
            return before if after else before + step

        return Value(value.type, run)

    def _postfix(self) -> Value:
        value = self._primary()
        while True:
            if self._take("["):
                value = self._element(value, self._expression())
                self._expect("]")
            elif self._take("."):
                if value.place is None:  # a member of a result
                    value = value._replace(place=_boxed(value.run))
                value = self._member(value.type, value.place)
            elif self._take("->"):
                value = self._member(value.type.of, value.run)
            elif self._text in _STEPS:
                value = self._counted(value, _STEPS[self._next().text], after=True)
            else:
                return value

    def _element(self, array: Value, index: Value) -> Value:
        if array.type.kind not in ("array", "pointer") or index.type != INT:
            raise self._fail("an index that is an integer, after an array or a pointer")
        start, number = array.run, index.run

        def place(f: Frame) -> Place:
            container, first = start(f)
            return container, _within(first + number(f))

        return self._at(array.type.of, place)

    def _member(self, kind: Type, place: Run | None) -> Value:
        name = self._name()
        struct = self.structs[kind.of] if kind.kind == "struct" else Struct([], [])
        if name not in struct.names or place is None:
            raise self._fail(f"a member of a structure, not {name}")
        index = struct.names.index(name)

        def field(f: Frame) -> Place:
            container, position = place(f)
            return container[position], index

        return self._at(struct.types[index], field)

    def _primary(self) -> Value:
        if self._take("("):
            value = self._expression()
            self._expect(")")
            return value
        token = self._next()
        if token.kind == "number":
            return self._literal(token.text)
        if token.kind != "name":
            self.index -= 1
            raise self._fail("an expression")
        if self._text == "(":
            return self._call(token.text)
        if token.text in self.constants:
            constant = self.constants[token.text]
            return Value(INT, lambda f: constant)
        if token.text == "NULL":
            return Value(Type("pointer", VOID), lambda f: None)
        if token.text == "NAN":
            return Value(REAL, lambda f: self.number(Fraction(0)) / 0)
        for scope in reversed(self.scopes):
            if token.text in scope:
                return self._variable(*scope[token.text])
        self.index -= 1
        raise self._fail("a variable that is declared before its use")

    def _variable(self, kind: Type, is_global: bool, slot: int) -> Value:
        frame = self.globals
        if is_global:
            return self._at(kind, lambda f: (frame, slot))
        if kind.kind != "array":
            return Value(kind, lambda f: f[slot], lambda f: (f, slot))
        return self._at(kind, lambda f: (f, slot))

    def _literal(self, text: str) -> Value:
        if text.isdigit():
            if text[0] == "0" and text != "0":
                raise self._fail(
                    f"a decimal number before the next token, instead of {text}, which C reads as an octal number"
                )
            whole = int(text)
            return Value(INT, lambda f: whole)
        exact = Fraction(float.fromhex(text) if text[:2] in ("0x", "0X") else float(text))
        constant = self.number(exact)
        return Value(REAL, lambda f: constant)

    def _call(self, name: str) -> Value:
        place = self.index - 1
        self._expect("(")
        arguments: list[Value] = []
        while not self._take(")"):
            arguments.append(self._assignment())
            self._take(",")
        if name in self.functions:
            result, *kinds = self.functions[name].result, *self.functions[name].parameters
        elif name in self.own:
            result, *kinds = (_LETTERS.get(letter, VOID) for letter in self.own[name][0])
        else:
            self.index = place
            raise self._fail("a function that the C text defines, or a C library function that symrot can evaluate")
        if len(arguments) != len(kinds):
            raise self._fail(f"{len(kinds)} arguments of {name}")
        runs = [self._converted(value, kind) for value, kind in zip(arguments, kinds, strict=True)]
        if name in self.own:
            replacement = self.own[name][1]
            return Value(result, lambda f: replacement(*(run(f) for run in runs)))
        function = self.functions[name]
        return Value(result, lambda f: called(function, [run(f) for run in runs]))

    def _converted(self, value: Value, kind: Type) -> Run:
        """Return a function that computes the value of an expression, converted to the type ``kind`` of a variable."""
        run, number = value.run, self.number
        if kind == REAL and value.type == INT:
            return lambda f: number(Fraction(run(f)))
        if kind == INT and value.type == REAL:
            return lambda f: int(run(f))
        if kind.kind == "pointer" and value.type == INT:
            return lambda f: None  # NULL, written as 0
        if kind.kind == "struct":
            return lambda f: copied(run(f))
        return run


def _within(position: int) -> int:
    """Return an index of an array; raise CertificateError if it is negative, since Python would count from the end."""
    if position < 0:
        raise CertificateError("expected an index within an array, got a negative one")
    return position


def _boxed(run: Run) -> Run:
    """Return a function that stores the result of ``run`` in a new variable and returns the address of this variable.

    Both functions take the frame, the list of the values of the C function's variables. The address is the pair
    ([result], 0): a list, and the index of the result in the list.
    """
    return lambda f: ([run(f)], 0)


def _after(first: Run, second: Run) -> Run:
    def run(f: Frame) -> Any:
        first(f)
        return second(f)

    return run
