r"""Reader of the LaTeX on a page, so that a displayed formula can be proven equal to the derived one.

A page may write a side of an equation as a person would, ``R\,[\omega_b]_\times``, where the derivation has nine
entries. With the declared meanings of the names on the page, the text is read by the usual rules of notation and proven
equal to the derived expression. Text that contains a name without a declared meaning raises :class:`Unread`: it is only
a label.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import sympy
from sympy import Expr, Integer, Matrix, MatrixBase, diff, eye, sqrt

from symrot.proof.notation.mathml import ACCENTS, FENCES, FONTS, SPACES, TOKEN

__all__ = ["Unread", "key", "parts", "read"]

FUNCTIONS = {name: getattr(sympy, name) for name in ("sin", "cos", "tan", "cot", "sec", "csc", "tanh", "exp")} | {
    "arctan": sympy.atan, "ln": sympy.log,
}  # fmt: skip
OPENING, CLOSING = {"(": ")", "[": "]", "|": "|"}, {")", "]", "|"}
GLUE = {"\\" + space for space in SPACES} | {"~"}
ENDS = {"", "+", "-", "\\times", "\\cdot", ",", "=", "&", "\\\\", "\\end", "\\right", "}", ")", "]"}
TIME = "time"
"""Key of the letter that a time derivative is taken by, where it is not t."""
SKEW = ("_", "\\times")


class Unread(Exception):
    """Signal that LaTeX text contains a name without a meaning, or an unsupported notation."""


def key(latex: str) -> str:
    """Return the key under which a LaTeX name is looked up: the name without braces and spaces."""
    return "".join(token for token in TOKEN.findall(latex) if token not in "{}" and not token.isspace())


def parts(latex: str) -> list[list[str]]:
    r"""Return the equations in a LaTeX text, which are separated by ``, \quad``; each is the list of its sides."""
    equations: list[list[str]] = [[""]]
    depth = 0
    tokens = TOKEN.findall(latex)
    for place, token in enumerate(tokens):
        depth += (token in ("{", "(", "\\left", "\\begin")) - (token in ("}", ")", "\\right", "\\end"))
        if depth == 0 and token == "," and "".join(tokens[place + 1 :]).lstrip().startswith("\\quad"):
            equations.append([""])
        elif depth == 0 and token == "=":
            equations[-1].append("")
        elif token != "\\quad":
            equations[-1][-1] += token
    return equations


def read(latex: str, names: Mapping[str, Any], rates: Mapping[Expr, Expr] | None = None) -> Any:
    """Return the formula or matrix that a LaTeX text represents.

    Parameters
    ----------
    latex : str
    names : mapping
        Key of a name (see :func:`key`) -> Expr, Matrix, or a function of the arguments in parentheses after it.
    rates : mapping, optional
        Variable -> its rate, for ``\\dot x`` and ``\\frac{d}{dt}``.

    Raises
    ------
    Unread
        If a name has no meaning, shapes do not match, or the notation is not supported.
    """
    return _Reader(latex, names, rates or {}).whole()


class _Reader:
    def __init__(self, latex: str, names: Mapping[str, Any], rates: Mapping[Expr, Expr]) -> None:
        self.names, self.rates, self.place = names, rates, 0
        self.time = names.get(TIME, "t")
        self.tokens = [token for token in TOKEN.findall(latex) if not token.isspace() and token not in GLUE]

    def peek(self, ahead: int = 0) -> str:
        place = self.place + ahead
        return self.tokens[place] if place < len(self.tokens) else ""

    def next(self) -> str:
        token = self.peek()
        if not token:
            raise Unread("the text ends early")
        self.place += 1
        return token

    def expect(self, token: str) -> None:
        if self.next() != token:
            raise Unread(f"expected {token}")

    def whole(self) -> Any:
        value = self.sum()
        if self.peek():
            raise Unread(self.peek())
        return value

    # -- sums and products ------------------------------------------------------------------------------------------

    def sum(self) -> Any:
        value = None
        while True:
            sign = self.next() if self.peek() in ("+", "-") else ""
            if value is not None and not sign:
                return value
            term = self.term()
            term = -term if sign == "-" else term
            value = term if value is None else _added(value, term)

    def term(self) -> Any:
        value = self.product()
        while self.peek() in ("\\times", "\\cdot"):
            value = (_crossed if self.next() == "\\times" else _dotted)(value, self.product())
        return value

    def product(self) -> Any:
        value = self.power()
        while True:
            if self.peek() == "/":
                self.next()
                value = _multiplied(value, _inverted(self.power()))
            elif self.peek() in ENDS or (self.peek() == "|" and self.bars):
                return value
            else:
                value = _multiplied(value, self.power())

    bars = 0

    def power(self) -> Any:
        if self.peek() == "|":
            return self.norm()
        if self.peek() == "e" and self.peek(1) == "^" and "e" not in self.names:
            self.place += 2
            power = self.inside(self.argument_tokens())
            if isinstance(power, MatrixBase):
                raise Unread("the exponential of a matrix")
            return sympy.exp(power)
        value = self.atom()
        while self.peek() == "^":
            self.next()
            value = self.raised(value)
        return value

    def raised(self, value: Any) -> Any:
        tokens = self.argument_tokens()
        if tokens in (["\\mathsf", "T"], ["\\mathsf", "{", "T", "}"]):
            return value.T if isinstance(value, MatrixBase) else value
        exponent = self.inside(tokens)
        if isinstance(value, MatrixBase) and value.cols == 1 and exponent == 2:
            return value.dot(value)
        if isinstance(value, MatrixBase):
            if not (value.is_square and exponent.is_Integer):
                raise Unread("a power of a matrix")
            return value.inv() ** -exponent if exponent < 0 else value**exponent
        return value**exponent

    def norm(self) -> Any:
        self.next()
        self.bars += 1
        inner = self.sum()
        self.bars -= 1
        self.expect("|")
        return self.length(inner)

    def length(self, inner: Any) -> Any:
        square = inner.dot(inner) if isinstance(inner, MatrixBase) and 1 in inner.shape else None
        if square is None:
            raise Unread("an absolute value")
        if self.peek() == "^" and self.peek(1) == "2":
            self.place += 2
            return square
        return sqrt(square)

    # -- atoms ------------------------------------------------------------------------------------------------------

    def atom(self) -> Any:
        token = self.peek()
        if token.replace(".", "").isdigit():
            self.next()
            return sympy.Rational(token)
        if token == "\\left":
            return self.fenced()
        if token in ("(", "["):
            self.next()
            return self.closed(token, self.values(OPENING[token]), OPENING[token])
        command = token.removeprefix("\\") if len(token) > 1 and token.startswith("\\") else ""
        if command in FUNCTIONS:
            return self.function(FUNCTIONS[command])
        if command in READERS:
            self.next()
            return READERS[command](self)
        return self.name()

    def values(self, closing: str) -> list[Any]:
        bars, self.bars = self.bars, 0
        sums = [self.sum()]
        while self.peek() == ",":
            self.next()
            sums.append(self.sum())
        self.bars = bars
        if self.peek() != closing:
            raise Unread(f"expected {closing}")
        self.next()
        return sums

    def closed(self, opening: str, values: list[Any], closing: str) -> Any:
        if opening == "[":
            skew = self.peek() == SKEW[0] and (self.peek(1) == SKEW[1] or self.tokens[self.place + 1 : self.place + 4]
                                               == ["{", SKEW[1], "}"])  # fmt: skip
            if skew:
                self.place += 2 if self.peek(1) == SKEW[1] else 4
                return _skew(values[0])
        return values[0] if len(values) == 1 else _stacked(values)

    def fenced(self) -> Any:
        self.next()
        opening = self.next()
        if opening == ".":
            return self.evaluated()
        bars, self.bars = self.bars, 0
        values = [self.sum()]
        while self.peek() == ",":
            self.next()
            values.append(self.sum())
        self.bars = bars
        self.expect("\\right")
        closing = self.next()
        if opening == "|":
            return self.length(values[0])
        if FENCES.get(opening) not in OPENING:
            raise Unread(opening)
        return self.closed(opening, values, closing)

    def evaluated(self) -> Any:
        r"""Return the value of ``\left. X \right|_{a = b, ...}``, which is X with a replaced by b."""
        value = self.sum()
        for mark in ("\\right", "|", "_"):
            self.expect(mark)
        text = "".join(self.argument_tokens())
        put: dict[Any, Any] = {}
        for equation in text.split(","):
            first, *others = (read(side, self.names, self.rates) for side in equation.split("="))
            put |= {first: others[0]} if len(others) == 1 else dict.fromkeys(others, first)
        return value.subs(put, simultaneous=True)

    def function(self, function: Callable[[Any], Any]) -> Any:
        self.next()
        power = None
        if self.peek() == "^":
            self.next()
            power = self.inside(self.argument_tokens())
        value = function(self.atom())
        return value if power is None else value**power

    def argument_tokens(self) -> list[str]:
        """Return the tokens of a braced group, or a single token (one digit of a number) with its own arguments."""
        token = self.next()
        if token != "{":
            if token.isdigit() and len(token) > 1:
                self.place -= 1
                self.tokens[self.place : self.place + 1] = [token[0], token[1:]]
                return [self.next()]
            return [token, self.next()] if token.removeprefix("\\") in FONTS and self.peek() != "{" else [token]
        depth, start = 1, self.place
        while depth:
            token = self.next()
            depth += (token == "{") - (token == "}")
        return self.tokens[start : self.place - 1]

    def inside(self, tokens: list[str]) -> Any:
        inner = _Reader("", self.names, self.rates)
        inner.tokens = list(tokens)
        return inner.whole()

    def fraction(self) -> Any:
        above, below = self.argument_tokens(), self.argument_tokens()
        if below[:1] == ["\\partial"]:
            variable = self.inside(below[1:])
            inner = self.inside(above[1:]) if above[1:] else self.term()
            return _gradient(inner, variable)
        if above[:1] == ["d"] and below[:1] == ["d"] and "".join(below[1:]) == self.time and self.rates:
            return self.rate(self.inside(above[1:]) if above[1:] else self.term())
        return _multiplied(self.inside(above), _inverted(self.inside(below)))

    def root(self) -> Any:
        return sqrt(self.inside(self.argument_tokens()))

    def font(self) -> Any:
        r"""Return the value of a name in a font: a function of a matrix, ``\mathbf{1}``, or a name with a declared
        meaning.
        """
        self.place -= 1
        start = self.place
        self.next()
        word = "".join(self.argument_tokens())
        if word == "1":
            return Integer(1)
        if word in MATRIX_FUNCTIONS and isinstance(argument := self.power(), MatrixBase):
            return MATRIX_FUNCTIONS[word](argument)
        self.place = start
        return self.name()

    def determinant(self) -> Any:
        value = self.power()
        if not isinstance(value, MatrixBase) or not value.is_square:
            raise Unread("a determinant")
        return value.det(method="berkowitz")

    def table(self) -> Any:
        name = "".join(self.argument_tokens())
        rows: list[list[Any]] = [[self.sum()]]
        while (mark := self.next()) != "\\end":
            if mark == "&":
                rows[-1].append(self.sum())
            elif self.peek() == "\\end":
                continue
            else:
                rows.append([self.sum()])
        self.argument_tokens()
        try:
            value = Matrix.vstack(*(Matrix.hstack(*map(_as_matrix, row)) for row in rows))
        except sympy.matrices.exceptions.ShapeError as error:
            raise Unread("a matrix whose rows have different lengths") from error
        if name not in ("bmatrix", "pmatrix", "matrix"):
            raise Unread(name)
        if self.peek() == "_" and self.peek(1) != "\\times":
            raise Unread("an index of a matrix")
        return value

    # -- names ------------------------------------------------------------------------------------------------------

    def name(self) -> Any:
        text = "".join(self.name_tokens())
        if self.peek() == "(":  # a value such as x(t) may have its own declared meaning
            stop = self.place
            while stop < len(self.tokens) and self.tokens[stop] != ")":
                stop += 1
            whole = text + "".join(token for token in self.tokens[self.place : stop + 1] if token not in "{}")
            if whole in self.names:
                self.place = stop + 1
                return self.names[whole]
            if stop == self.place + 2 and not callable(self.names.get(text)):
                raise Unread(whole)  # not a product: the value of a function
        if text in self.names:
            return self.meaning(self.names[text])
        if text.startswith(("\\dot", "\\ddot")) and self.rates:
            times = 2 if text.startswith("\\ddot") else 1
            bare = text.removeprefix("\\ddot" if times == 2 else "\\dot")
            if bare in self.names and not callable(self.names[bare]):
                value = self.names[bare]
                if not value.free_symbols & {part for variable in self.rates for part in variable.free_symbols}:
                    raise Unread(text)
                for _ in range(times):
                    value = self.rate(value)
                return value
        raise Unread(text)

    def meaning(self, value: Any) -> Any:
        if callable(value) and not isinstance(value, (Expr, MatrixBase)):
            opening = self.peek()
            if opening == "\\left":
                self.next()
            if self.next() != "(":
                raise Unread("a function without its argument")
            bars, self.bars = self.bars, 0
            arguments = [self.sum()]
            while self.peek() == ",":
                self.next()
                arguments.append(self.sum())
            self.bars = bars
            if opening == "\\left":
                self.expect("\\right")
            self.expect(")")
            return value(*arguments)
        return value

    def name_tokens(self) -> Iterator[str]:
        token = self.next()
        if token in ENDS or token in ("{", "^", "_", "&"):
            raise Unread(token)
        yield token
        if token.removeprefix("\\") in ACCENTS or token.removeprefix("\\") in FONTS:
            yield from (part for part in self.argument_tokens() if part not in "{}")
        while self.peek() in ("_", "'") and not (self.peek() == "_" and self.peek(1) == "\\times"):
            mark = self.next()
            yield mark
            if mark == "_":
                yield from (part for part in self.argument_tokens() if part not in "{}")

    def rate(self, value: Any) -> Any:
        terms = [value.diff(variable) * speed for variable, speed in self.rates.items()]
        return sum(terms[1:], terms[0])


READERS: dict[str, Callable[[_Reader], Any]] = {
    "frac": _Reader.fraction, "tfrac": _Reader.fraction, "dfrac": _Reader.fraction, "sqrt": _Reader.root,
    "mathbf": _Reader.font, "mathrm": _Reader.font, "det": _Reader.determinant, "begin": _Reader.table,
}  # fmt: skip


def _vee(matrix: MatrixBase) -> Matrix:
    return Matrix([matrix[2, 1], matrix[0, 2], matrix[1, 0]])


MATRIX_FUNCTIONS: dict[str, Callable[[MatrixBase], Any]] = {
    "tr": lambda matrix: matrix.trace(),
    "vee": _vee,
    "adj": lambda matrix: matrix.adjugate(method="berkowitz"),
}


def _as_matrix(value: Any) -> Matrix:
    return Matrix(value) if isinstance(value, MatrixBase) else Matrix([[value]])


def _stacked(values: list[Any]) -> Matrix:
    return Matrix.vstack(*(_as_matrix(value) for value in values))


def _added(left: Any, right: Any) -> Any:
    """Return the sum of two values; a number added to a matrix means that multiple of the unit matrix."""
    if isinstance(left, MatrixBase) != isinstance(right, MatrixBase):
        matrix, scalar = (left, right) if isinstance(left, MatrixBase) else (right, left)
        if scalar == 0:
            return matrix
        if not matrix.is_square:
            raise Unread("a number added to a vector")
        return Matrix(matrix) + scalar * eye(matrix.rows)
    if isinstance(left, MatrixBase) and left.shape != right.shape:
        raise Unread("a sum of two shapes")
    return left + right


def _multiplied(left: Any, right: Any) -> Any:
    """Return the product of two values: the matrix product, or the quaternion product for two columns of four."""
    if isinstance(left, MatrixBase) and isinstance(right, MatrixBase):
        if left.shape == right.shape == (4, 1):
            a, u, b, v = left[0], Matrix(left[1:]), right[0], Matrix(right[1:])
            return Matrix([a * b - u.dot(v), *(a * v + b * u + u.cross(v))])
        if left.cols != right.rows:
            raise Unread("a product of two shapes")
    return left * right


def _dotted(left: Any, right: Any) -> Any:
    if isinstance(left, MatrixBase) and isinstance(right, MatrixBase) and left.shape == right.shape:
        return left.dot(right) if left.cols == 1 else _multiplied(left, right)
    return _multiplied(left, right)


def _crossed(left: Any, right: Any) -> Any:
    if not all(isinstance(side, MatrixBase) and side.shape == (3, 1) for side in (left, right)):
        raise Unread("a cross product of values that are not vectors of three")
    return Matrix(left).cross(Matrix(right))


def _skew(vector: Any) -> Matrix:
    if not isinstance(vector, MatrixBase) or vector.shape != (3, 1):
        raise Unread("the cross product matrix of a value that is not a vector")
    a, b, c = vector
    return Matrix([[0, -c, b], [c, 0, -a], [-b, a, 0]])


def _inverted(value: Any) -> Any:
    if isinstance(value, MatrixBase):
        raise Unread("division by a matrix")
    if value == 0:
        raise Unread("division by zero")
    return 1 / value


def _gradient(value: Any, variable: Any) -> Any:
    if isinstance(variable, MatrixBase):
        if isinstance(value, MatrixBase) or not all(entry.is_Symbol for entry in variable):
            raise Unread("a derivative with respect to a vector")
        return Matrix([diff(value, entry) for entry in variable])
    if not getattr(variable, "is_Symbol", False):
        raise Unread("a derivative with respect to a formula instead of a symbol")
    return diff(value, variable)
