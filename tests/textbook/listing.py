"""The statements of a MATLAB listing, run on SymPy values: assignments of formulas, matrices, parts and integrals."""

import re
from collections.abc import Callable, Mapping
from typing import Any

from sympy import Matrix, Rational, Symbol, cos, integrate, pi, simplify, sin

__all__ = ["assignments", "run"]

TOKEN = re.compile(r"\s*(?:(\d+\.?\d*)|([A-Za-z]\w*)|(.))")


def assignments(text: str) -> list[tuple[str, str]]:
    """Return the names and formulas of a listing, in order; a matrix may go over several lines."""
    statements = re.split(r";\s*\n", text.strip() + "\n")
    parts = [part for line in statements for part in re.split(r";\s+(?=\w+ = )", line)]
    return [(name.strip(), formula.strip()) for name, _, formula in (p.partition("=") for p in parts if p.strip())]


def run(text: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of all names after the statements; a name without a value is a symbol."""
    known = dict(values)
    for name, formula in assignments(text):
        known[name] = _Reader(formula.replace("...", " "), known).whole()
    return known


def reshape(value: Matrix, size: Matrix) -> Matrix:
    """Return a matrix of another size, filled column by column as MATLAB does."""
    return Matrix(*reversed([int(n) for n in size]), list(value.T)).T


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "sin": sin,
    "cos": cos,
    "simplify": simplify,
    "transpose": lambda value: value.T,
    "reshape": reshape,
    "cross": lambda a, b: a.cross(b),
    "int": lambda value, symbol, ends: _each(value, lambda entry: integrate(entry, (symbol, *ends))),
}


def _part(vector: Matrix, first: int, last: int) -> Matrix:
    """Return the entries of a row or column from the first to the last, both included, counted from 1."""
    return vector[:, first - 1 : last] if vector.rows == 1 else vector[first - 1 : last, :]


def _each(value: Any, change: Callable[[Any], Any]) -> Any:
    return value.applyfunc(change) if isinstance(value, Matrix) else change(value)


class _Reader:
    """A formula of MATLAB that is read from left to right and evaluated at once."""

    def __init__(self, formula: str, known: Mapping[str, Any]) -> None:
        self.tokens = [next(filter(None, match.groups())) for match in TOKEN.finditer(formula.strip())]
        self.known = known

    def whole(self) -> Any:
        value = self.sum()
        assert not self.tokens, self.tokens
        return value

    def take(self, *tokens: str) -> str:
        return self.tokens.pop(0) if self.tokens and self.tokens[0] in tokens else ""

    def sum(self) -> Any:
        sign = self.take("-")
        value = -self.product() if sign else self.product()
        while sign := self.take("+", "-"):
            value = value + self.product() if sign == "+" else value - self.product()
        return value

    def product(self) -> Any:
        value = self.power()
        while sign := self.take("*", "/", "\\"):
            other = self.power()
            value = value * other if sign == "*" else value / other if sign == "/" else value.LUsolve(other)
        return value

    def power(self) -> Any:
        value = self.piece()
        return value ** self.piece() if self.take("^") else value

    def piece(self) -> Any:
        if self.take("("):
            return self.closed(self.sum(), ")")
        if self.take("["):
            return self.matrix()
        token = self.tokens.pop(0)
        if token[0].isdigit():
            return Rational(token.rstrip("."))
        if not self.take("("):
            return pi if token == "pi" else self.known.get(token, Symbol(token))
        arguments = [self.sum()]
        while mark := self.take(",", ":"):
            arguments.append(self.sum())
            if mark == ":":
                return self.closed(_part(self.known[token], *map(int, arguments)), ")")
        self.closed(None, ")")
        return FUNCTIONS[token](*arguments) if token in FUNCTIONS else list(self.known[token])[int(arguments[0]) - 1]

    def matrix(self) -> Matrix:
        rows = [[self.sum()]]
        while mark := self.take(",", ";"):
            if mark == ";":
                rows.append([])
            rows[-1].append(self.sum())
        self.closed(None, "]")
        return Matrix.vstack(*(Matrix.hstack(*(Matrix([entry]) for entry in row)) for row in rows))

    def closed(self, value: Any, bracket: str) -> Any:
        assert self.take(bracket), f"expected {bracket}, got {self.tokens[:1]}"
        return value
