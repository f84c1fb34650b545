"""Rules for the units of functions: the units that arguments must have, and the unit of the value."""

from collections.abc import Callable
from fractions import Fraction
from functools import reduce
from typing import Any

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node
from symrot.checker.units.inference import ZERO, Rows, UnitInference, Unreadable, Value, number_of, piece_text, shape_of
from symrot.checker.units.units import NOTHING, Dimension, raised, times

__all__ = ["CALLS"]


def _of_number(inference: UnitInference, node: Node) -> Value:
    """Return the dimension of a call such as sin(x), a pure number; require that x is a pure number, too."""
    for argument in node.args:
        inference.plain(
            inference.value(argument), f"the argument of {node.value}, {piece_text(argument)}, is {{0}}, not a number"
        )
    return NOTHING


def _alike(inference: UnitInference, node: Node) -> Value:
    """Return the dimension of a call such as atan2(y, x), a pure number; require that x and y have the same unit."""
    first, second = (inference.value(argument) for argument in node.args)
    inference.same(first, second, f"the arguments of {node.value} are {{0}} and {{1}}")
    return NOTHING


def _rotation(axis: int) -> Callable[[UnitInference, Node], Value]:
    def call(inference: UnitInference, node: Node) -> Value:
        _of_number(inference, node)
        return tuple(tuple(NOTHING if (i == axis) == (j == axis) else ZERO for j in range(3)) for i in range(3))

    return call


def _components(inference: UnitInference, node: Node) -> list[Any]:
    """Return the dimensions of the arguments of a call, or of the entries of a column that is its only argument."""
    if len(node.args) == 1:
        return [row[0] for row in inference.matrix(node.args[0])]
    return [inference.scalar(argument) for argument in node.args]


def _skew_of(a: Value, b: Value, c: Value) -> Rows:
    return ((ZERO, c, b), (c, ZERO, a), (b, a, ZERO))


def _cross(inference: UnitInference, node: Node) -> Value:
    left, right = (inference.matrix(argument) for argument in node.args)
    if shape_of(left) != (3, 1):
        raise Unreadable
    return inference.times(_skew_of(*(row[0] for row in left)), right)


def _dot(inference: UnitInference, node: Node) -> Value:
    left, right = (inference.matrix(argument) for argument in node.args)
    return inference.dot([row[0] for row in left], [row[0] for row in right])


def _vee(inference: UnitInference, node: Node) -> Value:
    """Return the dimensions of the vector of a skew matrix; require equal dimensions of opposite entries."""
    rows = inference.matrix(node.args[0])
    if shape_of(rows) != (3, 3):
        raise Unreadable
    pairs = ((2, 1), (0, 2), (1, 0))
    words = f"the two sides of the diagonal of {piece_text(node.args[0])} are {{0}} and {{1}}"
    return tuple((inference.same(rows[i][j], rows[j][i], words),) for i, j in pairs)


def _matrix(inference: UnitInference, node: Node) -> Value:
    rows = inference.value(node.args[0])
    if isinstance(rows, tuple):
        return rows
    if not isinstance(rows, list):
        raise Unreadable
    matrix = tuple(tuple(row) if isinstance(row, list) else (row,) for row in rows)
    if len({len(row) for row in matrix}) != 1:
        raise Unreadable
    return matrix


def _diagonal(inference: UnitInference, node: Node) -> Value:
    entries = [inference.scalar(argument) for argument in node.args]
    return tuple(tuple(e if i == j else ZERO for j in range(len(entries))) for i, e in enumerate(entries))


def _eye(inference: UnitInference, node: Node) -> Value:
    size = int(number_of(node.args[0]) or 0)
    return tuple(tuple(NOTHING if i == j else ZERO for j in range(size)) for i in range(size))


def _hstack(inference: UnitInference, node: Node) -> Value:
    parts = [inference.matrix(argument) for argument in node.args]
    return tuple(tuple(entry for part in row for entry in part) for row in zip(*parts, strict=True))


def _product_of_quaternions(inference: UnitInference, node: Node) -> Value:
    factors = [[row[0] for row in inference.matrix(argument)] for argument in node.args]
    if any(len(factor) != 4 for factor in factors):
        raise Unreadable
    components = reduce(lambda p, q: _qmul(inference, p, q), factors)
    return tuple((entry,) for entry in components)


def _qmul(inference: UnitInference, p: list[Any], q: list[Any]) -> list[Any]:
    """Return the dimensions of the components of a product of two quaternions with dimensions ``p`` and ``q``."""
    return [
        inference.total([inference.times(p[i], q[i ^ n]) for i in range(4)], "a product of quaternions")
        for n in range(4)
    ]


def _dcm_of(inference: UnitInference, node: Node) -> Value:
    """Return the dimensions of the entries of ``dcm_of(q)``: all are the square of the dimension of q's components."""
    q = _components(inference, node)
    if len(q) != 4:
        raise Unreadable
    unit = inference.total(q, "the quaternion")
    square = inference.times(unit, unit)
    return tuple((square,) * 3 for _ in range(3))


def _trace(inference: UnitInference, node: Node) -> Value:
    rows = inference.matrix(node.args[0])
    return inference.total([row[n] for n, row in enumerate(rows)], "a trace")


def _derivative(inference: UnitInference, node: Node) -> Value:
    value = inference.value(node.args[0])
    divisor: Dimension = NOTHING
    last: Dimension = NOTHING
    for argument in node.args[1:]:
        count = number_of(argument)
        if count is not None:  # diff(x, t, 2)
            divisor = times(divisor, raised(last, count - 1))
            continue
        last = inference.scalar(argument) or NOTHING
        divisor = times(divisor, last)
    return inference.times(raised(divisor, Fraction(-1)), value)


def _integral(inference: UnitInference, node: Node) -> Value:
    value = inference.value(node.args[0])
    for limits in node.args[1:]:
        if limits.kind != "list" or len(limits.args) not in (1, 3):
            raise Unreadable
        variable, *ends = (inference.scalar(member) for member in limits.args)
        for end in ends:
            words = f"the variable {piece_text(limits.args[0])} of an integral is {{0}}, its limit {{1}}"
            inference.same(variable, end, words)
        value = inference.times(variable, value)
    return value


def _inverse_of(inference: UnitInference, node: Node) -> Value:
    return inference.inverse(inference.matrix(node.args[0]))


CALLS: dict[str, Callable[[UnitInference, Node], Any]] = {
    **dict.fromkeys(("sin", "cos", "tan", "cot", "sec", "csc", "asin", "acos", "atan", "acot", "exp", "log", "sinh",
                     "cosh", "tanh", "sinc", "factorial"), _of_number),
    "atan2": _alike, **{name: _rotation("XYZ".index(axis)) for name, axis in ROTATIONS.items()},
    "sqrt": lambda inference, node: inference.power(inference.scalar(node.args[0]), Fraction(1, 2)),
    "abs": lambda inference, node: inference.scalar(node.args[0]),
    "sign": lambda inference, node: NOTHING,
    "skew": lambda inference, node: _skew_of(*_components(inference, node)),
    "transpose": lambda inference, node: tuple(zip(*inference.matrix(node.args[0]), strict=True)),
    "det": lambda inference, node: inference.determinant(inference.matrix(node.args[0])), "inverse": _inverse_of,
    "cross": _cross, "dot": _dot, "vee": _vee, "Matrix": _matrix, "diag": _diagonal, "eye": _eye, "hstack": _hstack,
    "qmul": _product_of_quaternions, "dcm_of": _dcm_of, "trace": _trace, "diff": _derivative,
    "integrate": _integral,
}  # fmt: skip
