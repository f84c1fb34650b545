"""A machine that runs functions of C on numbers of any kind, such as decimals of 60 digits instead of doubles.

It knows the C of symrot's closed forms: structures, arrays, pointers, loops, cases; no strings, allocation or recursion
without end. A variable is a place ``(container, index)``, where the container is a list: an array, the fields of a
structure, or the variables of a function. A pointer is such a place. Every ``double`` operation is one operation on the
numbers, and every constant the exact value of the double.
"""

import operator
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.certificates.c_machine.preprocessor import Token, tokens_of
from symrot.errors import CertificateError, InputError

__all__ = ["Machine"]

MOST_STEPS = 10_000_000
"""Statements that one call may run; more mean a loop without end."""

Frame = list[Any]
Run = Callable[[Frame], Any]
Place = tuple[list[Any], int]


class _Type(NamedTuple):
    kind: str  # "int", "real", "void", "struct", "array" or "pointer"
    of: Any = None  # the structure's name, or the type of the elements
    size: int = 0  # of an array


INT, REAL, VOID = _Type("int"), _Type("real"), _Type("void")
_BASIC = {
    "int": INT, "size_t": INT, "ptrdiff_t": INT, "uint64_t": INT, "unsigned": INT, "double": REAL, "float": REAL,
    "void": VOID,
}  # fmt: skip
_QUALIFIERS = {"const", "static", "inline", "volatile", "restrict", "extern"}
_BINDING = {
    "||": 1, "&&": 2, "|": 3, "&": 5, "==": 6, "!=": 6, "<": 7, "<=": 7, ">": 7, ">=": 7, "<<": 8, "+": 9, "-": 9,
    "*": 10, "/": 10, "%": 10,
}  # fmt: skip
_ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "<<="}
_OPERATIONS: Mapping[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "<": operator.lt, ">": operator.gt,
    "<=": operator.le, ">=": operator.ge, "==": operator.eq, "!=": operator.ne, "&": operator.and_, "|": operator.or_,
    "<<": operator.lshift,
}  # fmt: skip


class _Return(Exception):
    pass


class _Break(Exception):
    pass


class _Continue(Exception):
    pass


class _Function(NamedTuple):
    result: _Type
    parameters: list[_Type]
    body: list[Run]  # one element once the body is compiled
    slots: list[int]  # number of variables


class _Struct(NamedTuple):
    names: list[str]
    types: list[_Type]


class _Value(NamedTuple):
    """A compiled expression: its type, its value, and its place if it has one."""

    type: _Type
    run: Run
    place: Run | None = None


def _copied(value: Any) -> Any:
    return [_copied(each) for each in value] if isinstance(value, list) else value


class Machine:
    """The functions of a C text, which :meth:`call` runs.

    Parameters
    ----------
    text : str
        The C text.
    number : callable
        Converts a Fraction, the exact value of a constant, to the kind of number.
    own : mapping of str to callable
        Functions that replace those of the text or of ``<math.h>``. A pointer is a pair (list, index).

    Raises
    ------
    CertificateError
        For C that symrot does not emit.
    """

    def __init__(
        self, text: str, number: Callable[[Fraction], Any], own: Mapping[str, tuple[str, Callable[..., Any]]]
    ) -> None:
        self.number, self.own = number, own
        self.tokens, self.index = tokens_of(text), 0
        self.structs: dict[str, _Struct] = {}
        self.constants: dict[str, int] = {}
        self.functions: dict[str, _Function] = {}
        self.globals: Frame = []
        self.scopes: list[dict[str, tuple[_Type, bool, int]]] = [{}]  # name -> type, whether it is global, slot
        self.slots = 0
        self.steps = 0
        try:
            while self.index < len(self.tokens):
                self._declared_outside()
        except (ArithmeticError, AttributeError, IndexError, RecursionError, TypeError, ValueError) as reason:
            raise CertificateError(f"expected C that symrot emits, got a text with a fault ({reason})") from None

    def blank(self, struct: str) -> list[Any]:
        """Return a structure of the C text with zeros in its fields."""
        fields: list[Any] = self._blank(_Type("struct", struct))
        return fields

    def call(self, name: str, *arguments: Any) -> Any:
        """Call a function with numbers, integers and pointers; return its result."""
        if name not in self.functions:
            raise CertificateError(f"expected a function {name} in the C text, got none")
        self.steps = 0
        try:
            return self._called(self.functions[name], arguments)
        except InputError:  # from a function in ``own``
            raise
        except (ArithmeticError, AttributeError, IndexError, RecursionError, TypeError, ValueError) as reason:
            raise CertificateError(f"{name}: expected a C text that runs, got a fault ({reason})") from None

    def _called(self, function: _Function, arguments: Sequence[Any]) -> Any:
        frame: Frame = [None] * function.slots[0]
        frame[: len(arguments)] = arguments
        try:
            function.body[0](frame)
        except _Return as result:
            return result.args[0]
        return None

    # --- tokens -------------------------------------------------------------------------------------------------------

    @property
    def _text(self) -> str:
        return self.tokens[self.index].text if self.index < len(self.tokens) else ""

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

    # --- declarations -------------------------------------------------------------------------------------------------

    def _starts_type(self) -> bool:
        return self._text in _BASIC or self._text in _QUALIFIERS or self._text in self.structs

    def _base(self) -> _Type:
        base: _Type | None = None
        while True:
            if self._text in _QUALIFIERS:
                self.index += 1
            elif base is None and self._text in _BASIC:
                base = _BASIC[self._name()]
            elif base is None and self._text in self.structs:
                base = _Type("struct", self._name())
            elif base is None:
                raise self._fail("a type")
            else:
                return base

    def _declarator(self, base: _Type) -> tuple[str, _Type]:
        while self._take("*"):
            base = _Type("pointer", base)
            while self._text in _QUALIFIERS:
                self.index += 1
        name, sizes = self._name(), []
        while self._take("["):
            sizes.append(None if self._text == "]" else self._constant())
            self._expect("]")
        for size in reversed(sizes):
            base = _Type("array", base, -1 if size is None else size)
        return name, base

    def _constant(self) -> int:
        value = self._choice()
        if value.type != INT:
            raise self._fail("a whole number")
        return int(value.run([]))

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

    def _fields(self) -> _Struct:
        struct = _Struct([], [])
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
            of = _Type("pointer", of.of) if of.kind == "array" else of
            parameters.append(of)
            self.scopes[-1][parameter] = (of, False, self._slot())
            self._take(",")
        function = self.functions.setdefault(name, _Function(kind, parameters, [], [0]))
        if not self._take(";"):
            if name in self.own:
                self._skip_block()
            else:
                function.body.append(self._block())
                function.slots[0] = self.slots
        self.scopes.pop()

    def _skip_block(self) -> None:
        self._expect("{")
        depth = 1
        while depth:
            text = self._next().text
            depth += (text == "{") - (text == "}")

    def _slot(self) -> int:
        self.slots += 1
        return self.slots - 1

    def _variables(self, kind: _Type, name: str, base: _Type, is_global: bool) -> list[Run]:
        """Return statements that initialise the variables of a declaration whose first declarator was read."""
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

    def _set(self, slot: int, kind: _Type, initial: Run | None) -> Run:
        if initial is None:
            if kind.kind in ("int", "real", "pointer"):
                return lambda f: f.__setitem__(slot, None)
            return lambda f: f.__setitem__(slot, self._blank(kind))
        first = initial
        return lambda f: f.__setitem__(slot, first(f))

    def _blank(self, kind: _Type) -> Any:
        if kind.kind == "array":
            return [self._blank(kind.of) for _ in range(kind.size)]
        if kind.kind == "struct":
            return [self._blank(each) for each in self.structs[kind.of].types]
        return 0 if kind == INT else self.number(Fraction(0)) if kind == REAL else None

    def _initialiser(self, kind: _Type) -> Run:
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

    def _converted(self, value: _Value, kind: _Type) -> Run:
        """Return the value of an expression as a variable of type ``kind`` receives it."""
        run, number = value.run, self.number
        if kind == REAL and value.type == INT:
            return lambda f: number(Fraction(run(f)))
        if kind == INT and value.type == REAL:
            return lambda f: int(run(f))
        if kind.kind == "pointer" and value.type == INT:
            return lambda f: None  # NULL, written as 0
        if kind.kind == "struct":
            return lambda f: _copied(run(f))
        return run

    # --- statements ---------------------------------------------------------------------------------------------------

    def _block(self) -> Run:
        self._expect("{")
        self.scopes.append({})
        runs: list[Run] = []
        while not self._take("}"):
            runs += self._statements()
        self.scopes.pop()
        return self._sequence(runs)

    def _sequence(self, runs: list[Run]) -> Run:
        def run(f: Frame) -> None:
            for each in runs:
                each(f)

        return run if len(runs) != 1 else runs[0]

    def _statement(self) -> Run:
        return self._sequence(self._statements())

    def _statements(self) -> list[Run]:
        if self._starts_type():
            base = self._base()
            name, kind = self._declarator(base)
            return self._variables(kind, name, base, is_global=False)
        if self._text == "{":
            return [self._block()]
        word = self._text if self.tokens[self.index].kind == "name" else ""
        if word in ("if", "for", "switch", "return", "break", "continue"):
            self.index += 1
            return [getattr(self, f"_{word}")()]
        if self._take(";"):
            return []
        value = self._expression()
        self._expect(";")
        return [value.run]

    def _condition(self) -> Run:
        self._expect("(")
        value = self._expression()
        self._expect(")")
        return value.run

    def _if(self) -> Run:
        condition, then = self._condition(), self._statement()
        other = self._statement() if self._take("else") else None

        def run(f: Frame) -> None:
            if condition(f):
                then(f)
            elif other is not None:
                other(f)

        return run

    def _for(self) -> Run:
        self._expect("(")
        self.scopes.append({})
        if self._starts_type():
            first = self._statement()
        elif self._take(";"):
            first = self._sequence([])
        else:
            value = self._expression()
            self._expect(";")
            first = value.run
        condition = None if self._text == ";" else self._expression().run
        self._expect(";")
        step = None if self._text == ")" else self._expression().run
        self._expect(")")
        body = self._statement()
        self.scopes.pop()

        def run(f: Frame) -> None:
            first(f)
            while condition is None or condition(f):
                self.steps += 1
                if self.steps > MOST_STEPS:
                    raise CertificateError("expected loops that end, got one that runs on")
                try:
                    body(f)
                except _Break:
                    break
                except _Continue:
                    pass
                if step is not None:
                    step(f)

        return run

    def _switch(self) -> Run:
        value = self._condition()
        self._expect("{")
        self.scopes.append({})
        runs: list[Run] = []
        starts: dict[int | None, int] = {}
        while not self._take("}"):
            if self._take("case"):
                starts[self._constant()] = len(runs)
                self._expect(":")
            elif self._take("default"):
                starts[None] = len(runs)
                self._expect(":")
            else:
                runs += self._statements()
        self.scopes.pop()

        def run(f: Frame) -> None:
            start = starts.get(value(f), starts.get(None, len(runs)))
            try:
                for each in runs[start:]:
                    each(f)
            except _Break:
                pass

        return run

    def _return(self) -> Run:
        if self._take(";"):
            value: Run = lambda f: None  # noqa: E731
        else:
            expression = self._expression()
            value = expression.run
            self._expect(";")

        def run(f: Frame) -> None:
            raise _Return(value(f))

        return run

    def _break(self) -> Run:
        self._expect(";")

        def run(f: Frame) -> None:
            raise _Break

        return run

    def _continue(self) -> Run:
        self._expect(";")

        def run(f: Frame) -> None:
            raise _Continue

        return run

    # --- expressions --------------------------------------------------------------------------------------------------

    def _expression(self) -> _Value:
        value = self._assignment()
        while self._take(","):
            first, second = value.run, self._assignment()
            value = _Value(second.type, _after(first, second.run))
        return value

    def _assignment(self) -> _Value:
        target = self._choice()
        if self._text not in _ASSIGNMENTS:
            return target
        mark = self._next().text
        if target.place is None:
            raise self._fail("a variable before the assignment")
        value, place, kind = self._assignment(), target.place, target.type
        if mark != "=":
            value = self._binary(mark[:-1], target, value)
        run = self._converted(value, kind)

        def assign(f: Frame) -> Any:
            result = run(f)
            container, index = place(f)
            container[index] = result
            return result

        return _Value(kind, assign)

    def _choice(self) -> _Value:
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
        kind = _Type("pointer", kind.of) if kind.kind == "array" else kind
        first, second = self._converted(then, kind), self._converted(other, kind)
        return _Value(kind, lambda f: first(f) if test(f) else second(f))

    def _operation(self, least: int) -> _Value:
        left = self._unary()
        while _BINDING.get(self._text, 0) > least:
            mark = self._next().text
            left = self._binary(mark, left, self._operation(_BINDING[mark]))
        return left

    def _binary(self, mark: str, left: _Value, right: _Value) -> _Value:
        a, b = left.run, right.run
        if mark == "&&":
            return _Value(INT, lambda f: int(bool(a(f)) and bool(b(f))))
        if mark == "||":
            return _Value(INT, lambda f: int(bool(a(f)) or bool(b(f))))
        if left.type.kind in ("pointer", "array") or right.type.kind in ("pointer", "array"):
            return self._with_pointer(mark, left, right)
        if left.type == right.type == INT:
            if mark == "/":
                return _Value(INT, lambda f: int(Fraction(a(f), b(f))))
            if mark == "%":
                return _Value(INT, lambda f: (lambda x, y: x - y * int(Fraction(x, y)))(a(f), b(f)))
        elif mark in ("%", "&", "|", "<<") or left.type not in (INT, REAL) or right.type not in (INT, REAL):
            raise self._fail(f"numbers on both sides of {mark}")
        else:
            a, b = self._converted(left, REAL), self._converted(right, REAL)
        operation = _OPERATIONS[mark]
        if mark in ("<", ">", "<=", ">=", "==", "!="):
            return _Value(INT, lambda f: int(operation(a(f), b(f))))
        return _Value(INT if left.type == right.type == INT else REAL, lambda f: operation(a(f), b(f)))

    def _with_pointer(self, mark: str, left: _Value, right: _Value) -> _Value:
        a, b = left.run, right.run
        if mark in ("+", "-") and right.type == INT and left.type.kind in ("pointer", "array"):
            sign = 1 if mark == "+" else -1

            def moved(f: Frame) -> Place:
                container, index = a(f)
                return container, index + sign * b(f)

            return _Value(_Type("pointer", left.type.of), moved)
        if mark in ("==", "!="):
            equal = mark == "=="

            def compared(f: Frame) -> int:
                x, y = a(f) or None, b(f) or None
                same = x is y if x is None or y is None else x[0] is y[0] and x[1] == y[1]
                return int(same == equal)

            return _Value(INT, compared)
        raise self._fail("a pointer and a whole number")

    def _unary(self) -> _Value:
        if self._take("-"):
            value = self._unary()
            run = value.run
            return _Value(value.type, lambda f: -run(f))
        if self._take("!"):
            inner = self._unary().run
            return _Value(INT, lambda f: int(not inner(f)))
        if self._take("~"):
            bits = self._unary().run
            return _Value(INT, lambda f: ~bits(f))
        if self._take("&"):
            value = self._unary()
            if value.place is None:
                raise self._fail("a variable after &")
            return _Value(_Type("pointer", value.type), value.place)
        if self._take("*"):
            value = self._unary()
            return self._at(value.type.of, value.run)
        if self._text in ("++", "--"):
            sign = 1 if self._next().text == "++" else -1
            return self._counted(self._unary(), sign, after=False)
        if self._take("sizeof"):
            return self._size()
        if self._text == "(" and self._is_cast():
            self._expect("(")
            kind = self._base()
            while self._take("*"):
                kind = _Type("pointer", kind)
            self._expect(")")
            value = self._unary()
            return _Value(kind, value.run if kind == VOID else self._converted(value, kind))
        return self._postfix()

    def _is_cast(self) -> bool:
        following = self.tokens[self.index + 1].text
        return following in _BASIC or following in _QUALIFIERS or following in self.structs

    def _size(self) -> _Value:
        if self._text == "(":
            self._expect("(")
            kind = self._base() if self._starts_type() else self._expression().type
            self._expect(")")
        else:
            kind = self._unary().type
        size = 8 * self._length(kind)
        return _Value(INT, lambda f: size)

    def _length(self, kind: _Type) -> int:
        """Return the number of doubles in a variable."""
        if kind.kind == "struct":
            return sum(map(self._length, self.structs[kind.of].types))
        return kind.size * self._length(kind.of) if kind.kind == "array" else 1

    def _at(self, kind: _Type, place: Run) -> _Value:
        """Return the variable of type ``kind`` at a place."""
        if kind.kind == "array":
            # the address of the first element

            def first(f: Frame) -> Place:
                container, index = place(f)
                return container[index], 0

            return _Value(kind, first, place)

        def value(f: Frame) -> Any:
            container, index = place(f)
            return container[index]

        return _Value(kind, value, place)

    def _counted(self, value: _Value, sign: int, after: bool) -> _Value:
        place = value.place
        if place is None:
            raise self._fail("a variable to count")

        def run(f: Frame) -> Any:
            container, index = place(f)
            before = container[index]
            container[index] = before + sign
            return before if after else before + sign

        return _Value(value.type, run)

    def _postfix(self) -> _Value:
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
            elif self._text in ("++", "--"):
                value = self._counted(value, 1 if self._next().text == "++" else -1, after=True)
            else:
                return value

    def _element(self, array: _Value, index: _Value) -> _Value:
        if array.type.kind not in ("array", "pointer") or index.type != INT:
            raise self._fail("an array and a whole number")
        start, number = array.run, index.run

        def place(f: Frame) -> Place:
            container, first = start(f)
            position = first + number(f)
            if position < 0:
                raise CertificateError("expected an index within an array, got a negative one")
            return container, position

        return self._at(array.type.of, place)

    def _member(self, kind: _Type, place: Run | None) -> _Value:
        name = self._name()
        struct = self.structs[kind.of] if kind.kind == "struct" else _Struct([], [])
        if name not in struct.names or place is None:
            raise self._fail(f"a member of a structure, not {name}")
        index = struct.names.index(name)

        def field(f: Frame) -> Place:
            container, position = place(f)
            return container[position], index

        return self._at(struct.types[index], field)

    def _primary(self) -> _Value:
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
            return _Value(INT, lambda f: constant)
        if token.text == "NULL":
            return _Value(_Type("pointer", VOID), lambda f: None)
        if token.text == "NAN":
            return _Value(REAL, lambda f: self.number(Fraction(0)) / 0)
        for scope in reversed(self.scopes):
            if token.text in scope:
                return self._variable(*scope[token.text])
        self.index -= 1
        raise self._fail("a variable that is known here")

    def _variable(self, kind: _Type, is_global: bool, slot: int) -> _Value:
        frame = self.globals
        if is_global:
            return self._at(kind, lambda f: (frame, slot))
        if kind.kind != "array":
            return _Value(kind, lambda f: f[slot], lambda f: (f, slot))
        return self._at(kind, lambda f: (f, slot))

    def _literal(self, text: str) -> _Value:
        if text.isdigit():
            whole = int(text)
            return _Value(INT, lambda f: whole)
        exact = Fraction(float.fromhex(text) if text[:2] in ("0x", "0X") else float(text))
        constant = self.number(exact)
        return _Value(REAL, lambda f: constant)

    def _call(self, name: str) -> _Value:
        self._expect("(")
        arguments: list[_Value] = []
        while not self._take(")"):
            arguments.append(self._assignment())
            self._take(",")
        if name in self.own:
            return self._own_call(name, arguments)
        if name not in self.functions:
            raise self._fail(f"a function that is known here, not {name}")
        function = self.functions[name]
        if len(arguments) != len(function.parameters):
            raise self._fail(f"{len(function.parameters)} arguments of {name}")
        runs = [self._converted(value, kind) for value, kind in zip(arguments, function.parameters, strict=True)]
        return _Value(function.result, lambda f: self._called(function, [run(f) for run in runs]))

    def _own_call(self, name: str, arguments: list[_Value]) -> _Value:
        signature, function = self.own[name]
        if name in self.functions:  # the text declares its types
            declared = self.functions[name]
            values = [self._converted(value, kind) for value, kind in zip(arguments, declared.parameters, strict=True)]
            return _Value(declared.result, lambda f: function(*(run(f) for run in values)))
        kinds = {"r": REAL, "i": INT}
        if len(signature) != len(arguments) + 1:
            raise self._fail(f"{len(signature) - 1} arguments of {name}")
        runs = [
            self._converted(value, kinds[letter]) if letter in kinds else value.run
            for value, letter in zip(arguments, signature[1:], strict=True)
        ]
        return _Value(kinds.get(signature[0], VOID), lambda f: function(*(run(f) for run in runs)))


def _boxed(run: Run) -> Run:
    """Return a place that holds the value of an expression."""
    return lambda f: ([run(f)], 0)


def _after(first: Run, second: Run) -> Run:
    def run(f: Frame) -> Any:
        first(f)
        return second(f)

    return run
