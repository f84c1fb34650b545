r"""Reader of the LaTeX on a page, so that a displayed formula can be proven equal to the derived formula.

A page may write ``R\,[\omega_b]_\times`` where the derivation has nine entries. The text is parsed with the declared
meanings of the names on the page. A text with a name that has no declared meaning raises :class:`Unread`; such a text
can only label what was proven.
"""

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import Any

import sympy
from sympy import Add, Expr, Integer, Matrix, MatrixBase, diff, eye, sqrt
from sympy.matrices.exceptions import MatrixError

from symrot.errors import InputError
from symrot.latex import reader
from symrot.latex.cursor import Cursor
from symrot.latex.tokens import Token, tokens
from symrot.latex.tree import Accent, Command, Font, Fraction, Node, Root, Row, Script, Scripts, Table, alone, divided

__all__ = ["Unread", "key", "parts", "read"]

FUNCTIONS = {
    **{f"\\{name}": getattr(sympy, name) for name in ("sin", "cos", "tan", "cot", "sec", "csc", "tanh", "exp")},
    "\\arctan": sympy.atan, "\\ln": sympy.log,
}  # fmt: skip
CLOSING = {"(": ")", "[": "]"}
ENDS = {"", "+", "-", "\\times", "\\cdot", ",", "=", "&", "\\\\", ")", "]"}
TIME = "time"
"""Key of the table of names under which a page declares its letter for time, a str, if that letter is not t."""
UNMARKED = str.maketrans("", "", "{} \t\n\r\f\v")


class Unread(InputError):
    """Raised if LaTeX on a page has a name without a declared meaning, or a notation that is not supported."""


def key(latex: str) -> str:
    r"""Return a LaTeX name without braces and spaces, such as ``\omega_b`` for ``\omega_{b}``, as a key of a map."""
    return latex.translate(UNMARKED)


def parts(latex: str) -> list[list[str]]:
    r"""Return the equations in a LaTeX text as lists of sides: ``a = b, \quad c`` gives ``[a, b]`` and ``[c]``."""
    equations: list[list[str]] = [[""]]
    depth = 0
    for token, following in pairwise(tokens(latex)):
        depth += token.text in ("{", "(") or token.kind in ("left", "begin")
        depth -= token.text in ("}", ")") or token.kind in ("right", "close")
        # a comma before \quad outside brackets separates equations
        if depth == 0 and token.text == "," and following.text == "\\quad":
            equations.append([""])
        elif depth == 0 and token.text == "=":
            equations[-1].append("")
        else:
            equations[-1][-1] += " " if token.text == "\\quad" else latex[token.start : following.start]
    return equations


def read(latex: str, names: Mapping[str, Any], rates: Mapping[Expr, Expr] | None = None) -> Any:
    """Return the formula or matrix that a LaTeX text represents.

    Parameters
    ----------
    latex : str
    names : mapping
        A map from the key of a name (see :func:`key`) to its meaning: Expr, Matrix, or a function that takes the
        arguments in parentheses after the name.
    rates : mapping, optional
        A map from a variable to its rate, for ``\\dot x`` and ``\\frac{d}{dt}``.

    Raises
    ------
    Unread
        If a name has no meaning, shapes do not match, or the notation is not supported.
    """
    try:
        interpreter = _Interpreter(latex, names, rates or {})
        value = interpreter.sum()
        if not interpreter.at(""):
            raise interpreter.fail("an operator or the end")
    except (InputError, MatrixError, RecursionError) as error:
        raise Unread(str(error)) from error
    return value


class _Interpreter(Cursor):
    def __init__(self, latex: str, names: Mapping[str, Any], rates: Mapping[Expr, Expr]) -> None:
        super().__init__(latex, "", reader.read(latex))
        self.names, self.rates = names, rates
        self.time = names.get(TIME, "t")

    def value(self, node: Node) -> Any:
        """Return the value, Expr or Matrix, of parsed LaTeX: a whole formula, or the argument of a command."""
        return self.inside(node, self.sum)

    # -- sums and products ------------------------------------------------------------------------------------------

    def sum(self) -> Any:
        value = None
        while True:
            sign = self.next().text if self.at("+", "-") else ""
            if value is not None and not sign:
                return value
            term = self.term()
            term = -term if sign == "-" else term
            value = term if value is None else _added(value, term)

    def term(self) -> Any:
        value = self.product()
        while self.at("\\times", "\\cdot"):
            value = (_crossed if self.next().text == "\\times" else _dotted)(value, self.product())
        return value

    def product(self) -> Any:
        value = self.power()
        while True:
            if self.take("/"):
                value = _multiplied(value, _inverted(self.power()))
            elif self.peek().text in ENDS or (self.at("|") and self.open_bars):
                return value
            else:
                value = _multiplied(value, self.power())

    def power(self) -> Any:
        if self.take("|"):
            return self.norm()
        number_e = self.at("e") and self.peek(1).text == "^" and "e" not in self.names
        value = self.next() if number_e else self.atom()
        script = self.script("^")
        if script is None:
            return value
        if not number_e:
            return self.raised(value, script.inside)
        power = self.value(script.inside)
        if isinstance(power, MatrixBase):
            raise Unread("expected the exponential of a number, got the exponential of a matrix")
        return sympy.exp(power)

    def raised(self, value: Any, inside: Node) -> Any:
        mark = alone(inside)
        if isinstance(mark, Font) and mark.text == "\\mathsf" and _text(mark.inside) == "T":
            return value.T if isinstance(value, MatrixBase) else value
        exponent = self.value(inside)
        matrix = isinstance(value, MatrixBase)
        if matrix and value.cols == 1 and exponent == 2:
            return value.dot(value)
        if isinstance(exponent, MatrixBase) or (matrix and not exponent.is_Integer):
            raise Unread("expected a matrix to a whole power, or a power of a number, got another power of a matrix")
        return value.inv() ** -exponent if matrix and exponent < 0 else value**exponent

    def norm(self) -> Any:
        """Read the rest of a length ``|v|`` after its first bar, with an exponent if there is one; return the value."""
        inner = self.barred(self.sum, "|")
        square = inner.dot(inner) if isinstance(inner, MatrixBase) and 1 in inner.shape else None
        if square is None:
            raise Unread(
                "expected a vector v in |v|, where the bars mean its length, got an absolute value or a determinant"
            )
        script = self.script("^")
        if script is None:
            return sqrt(square)
        return square if alone(script.inside).text == "2" else self.raised(sqrt(square), script.inside)

    # -- atoms ------------------------------------------------------------------------------------------------------

    def atom(self) -> Any:
        item = self.peek()
        if item.kind == "number":
            return sympy.Rational(self.next().text)
        if item.text in CLOSING:
            return self.bracket(self.next().text)
        if item.text in FUNCTIONS:
            return self.function(FUNCTIONS[self.next().text])
        if item.text in READERS:
            return READERS[item.text](self, self.next())
        return self.name()

    def bracket(self, opening: str) -> Any:
        values = self.listed(self.sum, CLOSING[opening])
        if opening == "[" and self.at_skew():
            if not isinstance(values[0], MatrixBase) or values[0].shape != (3, 1):
                raise self.fail(
                    "a vector in the brackets before the subscript \\times, which stands for a cross-product matrix"
                )
            self.next()
            return Matrix(values[0].hat())
        return values[0] if len(values) == 1 else Matrix.vstack(*map(_as_matrix, values))

    def at_skew(self) -> bool:
        r"""Return whether the next item is ``\times``, the index of a cross-product matrix ``[\omega]_\times``."""
        item = self.peek()
        return isinstance(item, Script) and item.text == "_" and alone(item.inside).text == "\\times"

    def evaluated(self, dot: Node) -> Any:
        r"""Return the value of ``\left. X \right|_{a = b, ...}``: the formula X with ``a`` replaced by ``b``."""
        # ``dot``, the item \left., has been read
        value = self.barred(self.sum, "|")
        script = self.script("_")
        if script is None:
            raise self.fail("an index such as _{x = 0} after the bar, which says where the formula is evaluated")
        places: list[tuple[Any, Any]] = []
        inside = script.inside if isinstance(script.inside, Row) else Row((script.inside,), dot.start, dot.start)
        for equation in divided(inside, ","):
            first, *others = [self.value(side) for side in divided(equation, "=")]
            places += [(first, others[0])] if len(others) == 1 else [(other, first) for other in others]
            if not others or not all(getattr(variable, "is_Symbol", False) for variable, _ in places):
                raise Unread("expected equations such as x = 0 in the index of |_{x = 0}, got another formula")
        return value.subs(dict(places), simultaneous=True)

    def function(self, function: Callable[[Any], Any]) -> Any:
        script = self.script("^")
        power = script and self.value(script.inside)
        argument = self.atom()
        if isinstance(argument, MatrixBase) or isinstance(power, MatrixBase):
            raise Unread("expected numbers as the argument and the power of a function, got a matrix")
        value = function(argument)
        return value if power is None else value**power

    def fraction(self, fraction: Fraction) -> Any:
        above, below = fraction.above, fraction.below
        if variable := _after(below, "\\partial"):
            return _gradient(self.differentiated(_after(above, "\\partial")), self.value(variable))
        if (operand := _after(above, "d")) and _text(below) == "d" + self.time and self.rates:
            return self.rate(self.differentiated(operand))
        return _multiplied(self.value(above), _inverted(self.value(below)))

    def differentiated(self, operand: Row | None) -> Any:
        r"""Return the formula to differentiate: ``x`` in ``\frac{d x}{dt}`` as in ``\frac{d}{dt} x``."""
        if operand is None:
            raise self.fail("\\partial in the numerator of a partial derivative")
        # the numerator after its d or, if it is empty, the term after the fraction
        return self.value(operand) if operand.items else self.term()

    def root(self, root: Root) -> Any:
        if root.index is not None:
            raise self.fail("a square root", root)
        return sqrt(self.value(root.inside))

    def font(self, font: Font) -> Any:
        r"""Return the value of a name that LaTeX prints in a special font; ``\mathbf{1}`` gives the number 1."""
        word, place = _text(font.inside), self.index
        if word == "1":
            return Integer(1)
        # a function of the matrix after it, such as the trace \operatorname{tr}
        if word in MATRIX_FUNCTIONS and isinstance(argument := self.power(), MatrixBase):
            return MATRIX_FUNCTIONS[word](argument)
        self.index = place - 1
        return self.name()

    def determinant(self, command: Node) -> Any:
        value = self.power()
        if not isinstance(value, MatrixBase) or not value.is_square:
            raise self.fail("a square matrix", command)
        return value.det(method="berkowitz")

    def table(self, table: Table) -> Any:
        rows = [[self.value(cell) for cell in line] for line in table.lines]
        value = Matrix.vstack(*(Matrix.hstack(*map(_as_matrix, row)) for row in rows))
        if table.name not in ("bmatrix", "pmatrix", "matrix"):
            raise self.fail("a matrix", table)
        if self.at("_") and not self.at_skew():
            raise self.fail("no index after a matrix")
        return value

    # -- names ------------------------------------------------------------------------------------------------------

    def name(self) -> Any:
        text = "".join(self.name_parts())
        if self.at("("):  # a value, such as x(t), may have a meaning of its own
            texts = [item.text for item in self.items[self.index :]]
            stop = self.index + (texts.index(")") if ")" in texts else len(texts) - 1)
            whole = text + "".join(_text(item) for item in self.items[self.index : stop + 1])
            if whole in self.names:
                self.index = stop + 1
                return self.names[whole]
            if stop == self.index + 2 and not callable(self.names.get(text)):
                raise Unread(whole)  # not a product: the value of a function
        value = self.names.get(text)
        if callable(value) and not isinstance(value, (Expr, MatrixBase)):
            self.expect("(")
            arguments = self.listed(self.sum, ")")
            try:
                return value(*arguments)
            except (TypeError, AttributeError) as error:  # too many arguments, or a number in place of a matrix
                raise Unread(
                    f"expected the arguments of the function that this page declares as {text}, got others: {error}"
                ) from error
        if text in self.names:
            return value
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

    def name_parts(self) -> Iterator[str]:
        r"""Yield the parts of a name as text: a letter, command or accented letter, then its indices and primes.

        ``\omega_b'`` gives ``\omega``, ``_b`` and ``'``.
        """
        item = self.next()
        if not isinstance(item, Token | Accent | Font) or item.text in ENDS:
            raise self.fail("a name", item)
        yield _text(item)
        while not self.at_skew() and (script := self.script("_") or self.script("'")):
            yield _text(script)

    def rate(self, value: Any) -> Any:
        if isinstance(value, MatrixBase):
            return value.applyfunc(self.rate)
        return Add(*(value.diff(variable) * speed for variable, speed in self.rates.items() if value.has(variable)))


READERS: dict[str, Callable[[_Interpreter, Any], Any]] = {
    "\\frac": _Interpreter.fraction, "\\sqrt": _Interpreter.root, "\\mathbf": _Interpreter.font,
    "\\mathrm": _Interpreter.font, "\\det": _Interpreter.determinant, "table": _Interpreter.table,
    ".": _Interpreter.evaluated,
}  # fmt: skip


def _text(node: Node) -> str:
    r"""Return a part of a name, given as parsed LaTeX, as text without braces: ``\dot{x}`` gives ``\dotx``."""
    # names are looked up by such texts, see ``key``
    if isinstance(node, Row):
        return "".join(map(_text, node.items))
    if isinstance(node, Scripts):
        return _text(node.base) + "".join(map(_text, node.scripts))
    if isinstance(node, Script) and node.text == "'":
        return node.inside.text
    return node.text + (_text(node.inside) if isinstance(node, Command) else "")


def _after(node: Node, mark: str) -> Row | None:
    """Return the items of a group that begins with ``mark``, without the mark: ``x`` for ``{d x}`` and the mark ``d``.

    Return None for any other group.
    """
    row = node if isinstance(node, Row) else Row((node,), node.start, node.start)
    return Row(row.items[1:], row.start, row.end) if row.items and row.items[0].text == mark else None


def _vee(matrix: MatrixBase) -> Matrix:
    if matrix.shape != (3, 3):
        raise Unread("expected a matrix of shape (3, 3) after vee, got another shape")
    return Matrix([matrix[2, 1], matrix[0, 2], matrix[1, 0]])


MATRIX_FUNCTIONS: dict[str, Callable[[MatrixBase], Any]] = {
    "tr": lambda matrix: matrix.trace(),
    "vee": _vee,
    "adj": lambda matrix: matrix.adjugate(method="berkowitz"),
}


def _as_matrix(value: Any) -> Matrix:
    return Matrix(value) if isinstance(value, MatrixBase) else Matrix([[value]])


def _added(left: Any, right: Any) -> Any:
    """Return ``left + right``; a number added to a square matrix means that multiple of the identity matrix."""
    if isinstance(left, MatrixBase) != isinstance(right, MatrixBase):
        matrix, scalar = (left, right) if isinstance(left, MatrixBase) else (right, left)
        if scalar == 0:
            return matrix
        return Matrix(matrix) + scalar * eye(matrix.rows)
    return left + right


def _multiplied(left: Any, right: Any) -> Any:
    """Return ``left * right``: the matrix product, or for two columns of shape (4, 1) the quaternion product."""
    if isinstance(left, MatrixBase) and isinstance(right, MatrixBase) and left.shape == right.shape == (4, 1):
        a, u, b, v = left[0], Matrix(left[1:]), right[0], Matrix(right[1:])
        return Matrix([a * b - u.dot(v), *(a * v + b * u + u.cross(v))])
    return left * right


def _dotted(left: Any, right: Any) -> Any:
    if isinstance(left, MatrixBase) and isinstance(right, MatrixBase) and left.shape == right.shape:
        return left.dot(right) if left.cols == 1 else _multiplied(left, right)
    return _multiplied(left, right)


def _crossed(left: Any, right: Any) -> Any:
    if not all(isinstance(side, MatrixBase) and side.shape == (3, 1) for side in (left, right)):
        raise Unread("expected a cross product of two vectors with three components, got other values")
    return Matrix(left).cross(Matrix(right))


def _inverted(value: Any) -> Any:
    if isinstance(value, MatrixBase):
        raise Unread("expected a number as divisor, got a matrix")
    if value == 0:
        raise Unread("expected a divisor that is not zero, got 0")
    return 1 / value


def _gradient(value: Any, variable: Any) -> Any:
    if isinstance(variable, MatrixBase):
        if isinstance(value, MatrixBase) or not all(entry.is_Symbol for entry in variable):
            raise Unread("expected a derivative with respect to a symbol, got a derivative with respect to a vector")
        return Matrix([diff(value, entry) for entry in variable])
    if not getattr(variable, "is_Symbol", False):
        raise Unread("expected a derivative with respect to a symbol, got a derivative with respect to a formula")
    return diff(value, variable)
