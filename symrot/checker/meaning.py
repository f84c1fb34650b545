"""From the tree of a claim to SymPy, one table of names. Every divisor is noted before SymPy can cancel it.

Scalars are SymPy expressions, matrices are immutable; a vector is a column. A piece that has no meaning (shapes that do
not fit, an undefined name, a division by zero) is refused with its place in the text.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

import sympy
from sympy import Expr, Function, ImmutableMatrix, Integer, Mul, Rational, Symbol
from sympy.core.function import AppliedUndef

from symrot.checker.integration import definite_integral
from symrot.checker.reader import complaint
from symrot.checker.size import (
    LARGE_MATRIX,
    LARGEST_INVERSE,
    MOST_ANGLE_TERMS,
    MOST_DIFFERENTIATED,
    MOST_PIECES,
    MOST_PRODUCTS,
    products_of_determinant,
    terms_of_angle,
)
from symrot.checker.tree import Node
from symrot.errors import InputError
from symrot.exact.extent import pieces
from symrot.kinematics.quaternion import dcm_of, qmul
from symrot.kinematics.rotations import elementary_rotation, skew, vee

__all__ = ["BUILT_IN", "CONSTANTS", "Divisor", "Meaning", "is_matrix", "time"]

LARGEST_EXPONENT = 64
LARGEST_ROOT = 12
MOST_BITS = 20_000
MOST_BITS_FACTORED = 64
LARGEST_MATRIX = 12

time = Symbol("t", real=True)

CONSTANTS: dict[str, Expr] = {"pi": sympy.pi}
UNKNOWN_HERE = (
    "ln", "arcsin", "arccos", "arctan", "acot", "E", "I", "Rational", "nan", "NaN", "NAN", "inf", "Inf", "INF", "oo",
    "zoo", "infinity", "Infinity",
)  # fmt: skip
"""Names that become no symbol or function of the user's own by mere use: a reader takes them for something else."""


@dataclass(frozen=True)
class Divisor:
    """What somebody divided by, as SymPy sees it."""

    value: Expr
    node: Node


def is_matrix(value: Any) -> bool:
    """Return whether a value is a matrix (a column is one)."""
    return isinstance(value, sympy.MatrixBase)


def _described(value: Any) -> str:
    return f"a {value.rows} x {value.cols} matrix" if is_matrix(value) else "a scalar"


@dataclass
class Meaning:
    """The names of one claim, and the evaluation of its trees.

    Attributes
    ----------
    source, where : str
        The text being read and its place, for complaints.
    values : dict
        Symbols and definitions by name.
    functions : set of str
        Functions of time.
    implied : bool
        Whether names that nobody declared become real symbols and functions of time.
    divisors : list of Divisor
        What the text divides by; filled while evaluating.
    radicands : list of Expr
        What it takes even roots of; likewise.
    """

    values: dict[str, Any] = field(default_factory=dict)
    functions: set[str] = field(default_factory=set)
    implied: bool = False
    source: str = ""
    where: str = ""
    divisors: list[Divisor] = field(default_factory=list)
    radicands: list[Expr] = field(default_factory=list)

    def fail(self, node: Node, expected: str) -> InputError:
        return complaint(self.source, self.where, node.span[0], expected)

    def read(self, node: Node, source: str = "", where: str = "") -> Any:
        """Return the value of a tree: Expr or ImmutableMatrix.

        Raises
        ------
        InputError
            For a piece without meaning, with its position in ``source``.
        """
        self.source, self.where = source or self.source, where or self.where
        value = self.evaluate(node)
        if isinstance(value, tuple):
            raise self.fail(node, "a formula instead of a list")
        return value

    def evaluate(self, node: Node) -> Any:
        return _EVALUATE[node.kind](self, node)

    def scalar(self, node: Node, of: str) -> Expr:
        value = self.evaluate(node)
        if is_matrix(value) or isinstance(value, tuple):
            shown = "a list" if isinstance(value, tuple) else _described(value)
            raise self.fail(node, f"a scalar {of} instead of {shown}")
        return value

    def matrix(self, node: Node, of: str, shape: tuple[int | None, int | None] = (None, None)) -> ImmutableMatrix:
        value = self.evaluate(node)
        rows, columns = shape
        if isinstance(value, tuple) and all(not isinstance(part, tuple) and not is_matrix(part) for part in value):
            value = ImmutableMatrix(value)  # a bare list of components is a column
        fits = is_matrix(value) and rows in (None, value.rows) and columns in (None, value.cols)
        if not fits:
            wanted = "matrix" if shape == (None, None) else f"{rows or 'n'} x {columns or 'n'} matrix"
            shown = "a list" if isinstance(value, tuple) else _described(value)
            raise self.fail(node, f"a {wanted} {of} instead of {shown}")
        return value

    def bounded(self, value: Any, node: Node, most: int = MOST_PIECES) -> Any:
        """Return a value that is not too large to be worked with; refuse it otherwise."""
        if pieces(value if is_matrix(value) else [value]) > most:
            raise self.fail(node, f"a formula of at most {most} symbols, numbers and operations, written out,")
        return value

    def divide_by(self, value: Expr, node: Node) -> None:
        """Note a divisor; one that SymPy sees to be zero is refused here, others by the exact engine."""
        if value.is_zero:
            raise self.fail(node, "a divisor that is not zero")
        for factor in Mul.make_args(value):
            base = factor.as_base_exp()[0]
            if not base.is_number:
                self.divisors.append(Divisor(base, node))

    def factorable(self, value: Expr, node: Node) -> None:
        """Refuse the root of a number that is too long to be factored."""
        if value.is_Rational and max(int(value.p).bit_length(), int(value.q).bit_length()) > MOST_BITS_FACTORED:
            raise self.fail(node, f"a number of at most {MOST_BITS_FACTORED} bits under a root, since it is factored,")

    def take_root(self, value: Expr, node: Node) -> None:
        """Note a radicand; one that is negative is refused."""
        if value.is_negative:
            raise self.fail(node, "a number that is not negative under an even root")
        self.factorable(value, node)
        if not value.is_number:
            self.radicands.append(value)


# -- the kinds of node ------------------------------------------------------------------------------------------------


def _number(meaning: Meaning, node: Node) -> Expr:
    return Rational(node.value.numerator, node.value.denominator)


def _name(meaning: Meaning, node: Node) -> Any:
    name = node.value
    if name in meaning.values:
        return meaning.values[name]
    if name in CONSTANTS:
        return CONSTANTS[name]
    if name in meaning.functions:
        raise meaning.fail(node, f"{name}(t), since {name} is a function of t,")
    if name in BUILT_IN:
        raise meaning.fail(node, f"brackets after the function {name}")
    if not meaning.implied:
        raise meaning.fail(node, f"a name that is declared ({_nearest(name, meaning)}) instead of {name!r}")
    if name in UNKNOWN_HERE:
        raise meaning.fail(node, f"a symbol of another name, since {name!r} means something else to most readers,")
    made = meaning.values[name] = time if name == "t" else Symbol(name, real=True)
    return made


def _nearest(name: str, meaning: Meaning) -> str:
    known = [*meaning.values, *meaning.functions, *CONSTANTS, *BUILT_IN]
    close = get_close_matches(name, known, 1, 0.6)
    declared = ", ".join([*meaning.values, *meaning.functions]) or "none is"
    return f"did you mean {close[0]!r}?" if close else f"declared: {declared[:80]}"


def _sum(meaning: Meaning, node: Node) -> Any:
    values = [meaning.evaluate(term) for term in node.args]
    shapes = {_shape(meaning, value, term) for value, term in zip(values, node.args, strict=True)}
    if len(shapes) == 1:
        if None in shapes:
            return sympy.Add(*values)
        total = values[0]
        for value in values[1:]:
            total = total + value
        return total
    first = _described(values[0])
    other, found = next((n, _described(value)) for n, value in enumerate(values) if _described(value) != first)
    raise meaning.fail(node.args[other], f"{first}, as the first term of the sum is, instead of {found}")


def _shape(meaning: Meaning, value: Any, node: Node) -> tuple[int, int] | None:
    if isinstance(value, tuple):
        raise meaning.fail(node, "a formula instead of a list (write Matrix([..]))")
    return (value.rows, value.cols) if is_matrix(value) else None


def _product(meaning: Meaning, node: Node) -> Any:
    total: Any = None
    for factor in node.args:
        value = meaning.evaluate(factor)
        _shape(meaning, value, factor)
        if total is None:
            total = value
        elif is_matrix(total) and is_matrix(value) and total.cols != value.rows:
            raise meaning.fail(factor, f"a matrix with {total.cols} rows instead of {_described(value)}")
        else:
            large = is_matrix(total) and is_matrix(value)
            total = meaning.bounded(total * value, factor) if large else total * value
    return total


def _negative(meaning: Meaning, node: Node) -> Any:
    value = meaning.evaluate(node.args[0])
    _shape(meaning, value, node.args[0])
    return -value


def _inverse(meaning: Meaning, node: Node) -> Any:
    value = meaning.scalar(node.args[0], "to divide by")
    meaning.divide_by(value, node.args[0])
    return 1 / value


def _power(meaning: Meaning, node: Node) -> Any:
    base, exponent = meaning.evaluate(node.args[0]), meaning.scalar(node.args[1], "as an exponent")
    if not exponent.is_Rational:
        raise meaning.fail(node.args[1], "a number as an exponent")
    if abs(exponent.p) > LARGEST_EXPONENT or exponent.q > LARGEST_ROOT:
        raise meaning.fail(node.args[1], f"an exponent up to {LARGEST_EXPONENT} (roots up to the {LARGEST_ROOT}th)")
    if is_matrix(base):
        if base.rows != base.cols or exponent.q != 1:
            raise meaning.fail(node, "a square matrix to a whole power")
        if exponent < 0:
            base = _inverted(meaning, base, node.args[0])
        total = ImmutableMatrix(sympy.eye(base.rows))
        for _ in range(abs(int(exponent))):
            total = meaning.bounded(total * base, node)
        return total
    _shape(meaning, base, node.args[0])
    if exponent < 0:
        meaning.divide_by(base, node.args[0])
    if base.is_Rational and abs(exponent.p) * max(int(base.p).bit_length(), int(base.q).bit_length()) > MOST_BITS:
        raise meaning.fail(node, f"a number of at most {MOST_BITS} bits")
    if exponent.q % 2 == 0:
        meaning.take_root(base, node.args[0])
    elif exponent.q > 1:
        meaning.factorable(base, node.args[0])
    return base**exponent


def _transpose(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return meaning.matrix(node.args[0], "before .T").T


def _index(meaning: Meaning, node: Node) -> Expr:
    matrix = meaning.matrix(node.args[0], "before an index")
    places = [meaning.scalar(index, "as an index") for index in node.args[1:]]
    if len(places) == 1 and 1 in matrix.shape:
        places = [places[0], Integer(0)] if matrix.cols == 1 else [Integer(0), places[0]]
    if len(places) != 2 or not all(
        place.is_Integer and 0 <= place < size for place, size in zip(places, matrix.shape, strict=True)
    ):
        raise meaning.fail(node, f"indices from 0 into {_described(matrix)}")
    return matrix[int(places[0]), int(places[1])]


def _list(meaning: Meaning, node: Node) -> tuple[Any, ...]:
    return tuple(meaning.evaluate(member) for member in node.args)


def _call(meaning: Meaning, node: Node) -> Any:
    name, arguments = node.value, node.args
    if name in meaning.functions:
        return _function_of_time(meaning, node)
    if name in BUILT_IN:
        least, most, function = BUILT_IN[name]
        if not least <= len(arguments) <= most:
            wanted = str(least) if least == most else f"{least} to {most}" if most < 99 else f"at least {least}"
            raise meaning.fail(node, f"{wanted} argument(s) of {name} instead of {len(arguments)}")
        return function(meaning, node)
    if name in meaning.values:
        raise meaning.fail(node, f"an operator between {name} and '(', since {name} is no function,")
    close = get_close_matches(name, list(BUILT_IN), 1, 0.74)
    if not meaning.implied or close or name in UNKNOWN_HERE or [a.value for a in arguments] != ["t"]:
        known = f"did you mean {close[0]}?" if close else f"built in: {', '.join(BUILT_IN)}"
        raise meaning.fail(node, f"a function that is built in or declared as one of t instead of {name!r} ({known})")
    meaning.functions.add(name)
    return _function_of_time(meaning, node)


def _function_of_time(meaning: Meaning, node: Node) -> Expr:
    if [(argument.kind, argument.value) for argument in node.args] != [("name", "t")]:
        raise meaning.fail(node, f"{node.value}(t)")
    if meaning.evaluate(node.args[0]) != time:
        raise meaning.fail(node.args[0], "the symbol t")
    return Function(node.value, real=True)(time)


_EVALUATE: dict[str, Callable[[Meaning, Node], Any]] = {
    "number": _number, "name": _name, "sum": _sum, "product": _product, "neg": _negative, "inv": _inverse,
    "power": _power, "transpose": _transpose, "index": _index, "list": _list, "call": _call,
}  # fmt: skip


# -- the functions ----------------------------------------------------------------------------------------------------


def _of_scalar(function: Callable[[Expr], Expr], below: Callable[[Expr], Expr] | None = None) -> Any:
    """Return a function of one scalar, which divides by ``below`` of its argument."""

    def call(meaning: Meaning, node: Node) -> Expr:
        value = meaning.scalar(node.args[0], f"as the argument of {node.value}")
        if terms_of_angle(value) > MOST_ANGLE_TERMS:
            raise meaning.fail(node.args[0], f"an angle whose sine has at most {MOST_ANGLE_TERMS} terms")
        if below is not None:
            meaning.divide_by(below(value), node)
        return function(value)

    return call


def _sqrt(meaning: Meaning, node: Node) -> Expr:
    value = meaning.scalar(node.args[0], "under the root")
    meaning.take_root(value, node.args[0])
    return sympy.sqrt(value)


def _atan2(meaning: Meaning, node: Node) -> Expr:
    y, x = (meaning.scalar(argument, "as an argument of atan2") for argument in node.args)
    meaning.divide_by(x**2 + y**2, node)
    return sympy.atan2(y, x)


def _arc(function: Callable[[Expr], Expr]) -> Any:
    """Return asin or acos, of what lies between -1 and 1."""

    def call(meaning: Meaning, node: Node) -> Expr:
        value = meaning.scalar(node.args[0], f"as the argument of {node.value}")
        if (1 - value**2).is_negative:
            raise meaning.fail(node.args[0], f"a number from -1 to 1 in {node.value}")
        meaning.take_root(1 - value**2, node.args[0])
        return function(value)

    return call


def _log(meaning: Meaning, node: Node) -> Expr:
    value = meaning.scalar(node.args[0], "as the argument of log")
    if value.is_nonpositive:
        raise meaning.fail(node.args[0], "a positive number in log")
    meaning.divide_by(value, node.args[0])
    meaning.take_root(value, node.args[0])
    return sympy.log(value)


def _rotation(axis: str) -> Any:
    return lambda meaning, node: elementary_rotation(axis, meaning.scalar(node.args[0], "as an angle"))


def _components(meaning: Meaning, node: Node, size: int) -> list[Expr]:
    if len(node.args) == size:
        return [meaning.scalar(argument, f"as a component in {node.value}") for argument in node.args]
    if len(node.args) != 1:
        raise meaning.fail(node, f"{size} components, or one column of them, as arguments of {node.value}")
    return list(meaning.matrix(node.args[0], f"as the argument of {node.value}", (size, 1)))


def _skew(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return skew(_components(meaning, node, 3))


def _vee(meaning: Meaning, node: Node) -> ImmutableMatrix:
    matrix = meaning.matrix(node.args[0], "as the argument of vee", (3, 3))
    if not (matrix + matrix.T).applyfunc(sympy.expand).is_zero_matrix:
        from symrot.exact import is_zero

        if not is_zero(matrix + matrix.T):
            raise meaning.fail(node.args[0], "a skew-symmetric matrix as the argument of vee")
    return vee(matrix)


def _cross(meaning: Meaning, node: Node) -> ImmutableMatrix:
    left, right = (meaning.matrix(argument, "as an argument of cross", (3, 1)) for argument in node.args)
    return ImmutableMatrix(left.cross(right))


def _dot(meaning: Meaning, node: Node) -> Expr:
    left = meaning.matrix(node.args[0], "as an argument of dot", (None, 1))
    right = meaning.matrix(node.args[1], "as an argument of dot", (left.rows, 1))
    return left.dot(right)


def _square(meaning: Meaning, node: Node) -> ImmutableMatrix:
    matrix = meaning.matrix(node.args[0], f"as the argument of {node.value}")
    if matrix.rows != matrix.cols or matrix.rows > LARGEST_MATRIX:
        raise meaning.fail(node.args[0], f"a square matrix, at most {LARGEST_MATRIX} x {LARGEST_MATRIX},")
    return matrix


def _det(meaning: Meaning, node: Node) -> Expr:
    return _determinant(meaning, _square(meaning, node), node.args[0], MOST_PRODUCTS)


def _determinant(meaning: Meaning, matrix: ImmutableMatrix, node: Node, most_products: int) -> Expr:
    products = products_of_determinant(matrix)
    if products > most_products:
        raise meaning.fail(
            node, f"a matrix whose determinant has at most {most_products} products instead of {products}"
        )
    return _by_cofactors(matrix) if pieces(matrix) > LARGE_MATRIX else matrix.det(method="berkowitz")


def _by_cofactors(matrix: ImmutableMatrix) -> Expr:
    """Return a determinant as products of entries, nothing multiplied out."""
    if matrix.rows == 1:
        return matrix[0, 0]
    rest = matrix[1:, :]
    minors = [ImmutableMatrix.hstack(rest[:, :column], rest[:, column + 1 :]) for column in range(matrix.cols)]
    places = [column for column in range(matrix.cols) if matrix[0, column] != 0]
    return sympy.Add(*((-1) ** place * matrix[0, place] * _by_cofactors(minors[place]) for place in places))


def _inverse_of(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return _inverted(meaning, _square(meaning, node), node.args[0])


def _inverted(meaning: Meaning, matrix: ImmutableMatrix, node: Node) -> ImmutableMatrix:
    determinant = _determinant(meaning, matrix, node, LARGEST_INVERSE)
    from symrot.exact import normal_form

    shortest = normal_form(determinant)
    if shortest == 0:
        raise meaning.fail(node, "a matrix whose determinant is not zero")
    meaning.divide_by(shortest, node)
    return matrix.adjugate(method="berkowitz") / shortest


def _trace(meaning: Meaning, node: Node) -> Expr:
    return _square(meaning, node).trace()


def _transpose_of(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return meaning.matrix(node.args[0], "as the argument of transpose").T


def _eye(meaning: Meaning, node: Node) -> ImmutableMatrix:
    size = meaning.scalar(node.args[0], "as a size")
    if not (size.is_Integer and 1 <= size <= LARGEST_MATRIX):
        raise meaning.fail(node.args[0], f"a size from 1 to {LARGEST_MATRIX}")
    return ImmutableMatrix(sympy.eye(int(size)))


def _diag(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return ImmutableMatrix(sympy.diag(*(meaning.scalar(a, "on the diagonal") for a in node.args)))


def _matrix(meaning: Meaning, node: Node) -> ImmutableMatrix:
    rows = meaning.evaluate(node.args[0])
    if is_matrix(rows):
        return rows
    rows = rows if isinstance(rows, tuple) else ()
    rows = tuple(row if isinstance(row, tuple) else (row,) for row in rows)
    lengths = {len(row) for row in rows}
    cells = [cell for row in rows for cell in row]
    if len(lengths) != 1 or any(is_matrix(cell) or isinstance(cell, tuple) for cell in cells):
        raise meaning.fail(node, "rows of scalars of equal length, Matrix([[a, b], [c, d]]),")
    if max(len(rows), *lengths) > LARGEST_MATRIX:
        raise meaning.fail(node, f"a matrix of at most {LARGEST_MATRIX} x {LARGEST_MATRIX}")
    return ImmutableMatrix(rows)


def _hstack(meaning: Meaning, node: Node) -> ImmutableMatrix:
    first = meaning.matrix(node.args[0], "in hstack")
    rest = [meaning.matrix(argument, "in hstack", (first.rows, None)) for argument in node.args[1:]]
    return ImmutableMatrix.hstack(first, *rest)


def _qmul(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return qmul(*(meaning.matrix(argument, "as a quaternion in qmul", (4, 1)) for argument in node.args))


def _dcm_of(meaning: Meaning, node: Node) -> ImmutableMatrix:
    return dcm_of(_components(meaning, node, 4), form="homogeneous")


def _diff(meaning: Meaning, node: Node) -> Any:
    formula = meaning.evaluate(node.args[0])
    _shape(meaning, formula, node.args[0])
    last = None
    for argument in node.args[1:]:
        variable = meaning.scalar(argument, "to differentiate by")
        times = 1
        if variable.is_Integer and last is not None and 1 <= variable <= 9:
            variable, times = last, int(variable) - 1
        elif not (variable.is_Symbol or isinstance(variable, AppliedUndef) or _is_rate(variable)):
            raise meaning.fail(argument, "a symbol, a function of t or its derivative to differentiate by")
        for _ in range(times):
            formula = meaning.bounded(formula, node, MOST_DIFFERENTIATED).diff(variable)
        last = variable
    return formula


def _is_rate(value: Expr) -> bool:
    return bool(value.is_Derivative) and isinstance(value.expr, AppliedUndef)


def _integrate(meaning: Meaning, node: Node) -> Expr:
    integrand, *ranges = node.args
    limits = []
    for place in ranges:
        if place.kind != "list" or len(place.args) != 3:
            raise meaning.fail(place, "a range (x, from, to) after the integrand")
        variable = meaning.scalar(place.args[0], "to integrate over")
        lower, upper = (meaning.scalar(limit, "as a limit of an integral") for limit in place.args[1:])
        if not variable.is_Symbol or lower.has(variable) or upper.has(variable):
            raise meaning.fail(place, "a symbol to integrate over, with limits free of it,")
        limits.append((variable, lower, upper))
    total = meaning.scalar(integrand, "to integrate")
    for (variable, lower, upper), place in zip(limits, ranges, strict=True):
        try:
            total, divisors = definite_integral(total, variable, lower, upper)
        except InputError as reason:
            raise meaning.fail(place, f"an integral that can be found here ({reason})") from None
        meaning.divisors.extend(Divisor(value, place) for value in divisors)
    return total


BUILT_IN: Mapping[str, tuple[int, int, Callable[[Meaning, Node], Any]]] = {
    "sqrt": (1, 1, _sqrt),
    "sin": (1, 1, _of_scalar(sympy.sin)),
    "cos": (1, 1, _of_scalar(sympy.cos)),
    "tan": (1, 1, _of_scalar(sympy.tan, sympy.cos)),
    "cot": (1, 1, _of_scalar(sympy.cot, sympy.sin)),
    "sec": (1, 1, _of_scalar(sympy.sec, sympy.cos)),
    "csc": (1, 1, _of_scalar(sympy.csc, sympy.sin)),
    "asin": (1, 1, _arc(sympy.asin)),
    "acos": (1, 1, _arc(sympy.acos)),
    "atan": (1, 1, _of_scalar(sympy.atan)),
    "atan2": (2, 2, _atan2),
    "exp": (1, 1, _of_scalar(sympy.exp)),
    "log": (1, 1, _log),
    "sinh": (1, 1, _of_scalar(sympy.sinh)),
    "cosh": (1, 1, _of_scalar(sympy.cosh)),
    "tanh": (1, 1, _of_scalar(sympy.tanh)),
    "abs": (1, 1, _of_scalar(sympy.Abs)),
    "diff": (2, 9, _diff),
    "integrate": (2, 9, _integrate),
    "Matrix": (1, 1, _matrix),
    "eye": (1, 1, _eye),
    "diag": (1, LARGEST_MATRIX, _diag),
    "hstack": (1, LARGEST_MATRIX, _hstack),
    "transpose": (1, 1, _transpose_of),
    "inverse": (1, 1, _inverse_of),
    "det": (1, 1, _det),
    "trace": (1, 1, _trace),
    "Rx": (1, 1, _rotation("X")),
    "Ry": (1, 1, _rotation("Y")),
    "Rz": (1, 1, _rotation("Z")),
    "skew": (1, 3, _skew),
    "vee": (1, 1, _vee),
    "cross": (2, 2, _cross),
    "dot": (2, 2, _dot),
    "qmul": (2, 9, _qmul),
    "dcm_of": (1, 4, _dcm_of),
}
"""Name -> (fewest arguments, most arguments, meaning)."""
