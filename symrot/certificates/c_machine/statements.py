"""Statements of C, translated to Python functions that change the C variables."""

from symrot.certificates.c_machine.declarations import Declarations
from symrot.certificates.c_machine.values import Frame, Return, Run
from symrot.errors import CertificateError

__all__ = ["Statements"]

MOST_STEPS = 10_000_000
"""The largest number of loop iterations in one call of the machine; more mean a loop without end."""


class _Break(Exception):
    pass


class _Continue(Exception):
    pass


_JUMPS: dict[str, type[Exception]] = {"break": _Break, "continue": _Continue}


def _sequence(runs: list[Run]) -> Run:
    def run(f: Frame) -> None:
        for each in runs:
            each(f)

    return run if len(runs) != 1 else runs[0]


def _jump(jump: type[Exception], value: Run = lambda f: None) -> Run:
    def run(f: Frame) -> None:
        raise jump(value(f))

    return run


class Statements(Declarations):
    """Reader of C statements: it returns each statement as a Python function that executes it."""

    def _block(self) -> Run:
        self._expect("{")
        self.scopes.append({})
        runs: list[Run] = []
        while not self._take("}"):
            runs += self._statements()
        self.scopes.pop()
        return _sequence(runs)

    def _statement(self) -> Run:
        return _sequence(self._statements())

    def _statements(self) -> list[Run]:
        if self._is_type(self._text):
            start = self.index
            base = self._base()
            words = [token.text for token in self.tokens[start : self.index]]
            if "static" in words and "const" not in words:
                raise self._fail("no variable that keeps its value from call to call")
            name, kind = self._declarator(base)
            return self._variables(kind, name, base, is_global=False)
        if self._text == "{":
            return [self._block()]
        word = self._text if self.tokens[self.index].kind == "name" else ""
        if word in ("if", "for", "switch", "return"):
            self.index += 1
            return [getattr(self, f"_{word}")()]
        if word in _JUMPS:
            self.index += 1
            self._expect(";")
            return [_jump(_JUMPS[word])]
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
        if self._is_type(self._text):
            first = self._statement()
        elif self._take(";"):
            first = _sequence([])
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
                    raise CertificateError(f"expected at most {MOST_STEPS} iterations of loops in a call, got more")
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
            return _jump(Return)
        value = self._expression()
        self._expect(";")
        return _jump(Return, self._converted(value, self.result))
