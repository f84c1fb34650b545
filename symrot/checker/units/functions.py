"""Units through the functions of claims: what their arguments must have, and what their values have."""

from collections.abc import Callable
from fractions import Fraction
from functools import reduce
from typing import Any

from symrot.checker.claim.tree import Node
from symrot.checker.units.inference import ZERO, Rows, UnitInference, Unreadable, Value, number_of, piece_text, shape_of
from symrot.checker.units.units import NOTHING, Dimension, raised, times

__all__ = ["CALLS"]


def _of_number(walker: UnitInference, node: Node) -> Value:
    """A function whose argument and value have no dimension."""
    for argument in node.args:
        walker.plain(
            walker.value(argument), f"the argument of {node.value}, {piece_text(argument)}, is {{0}}, not a number"
        )
    return NOTHING


def _alike(walker: UnitInference, node: Node) -> Value:
    """A function of two arguments of one unit, with a value that has none."""
    first, second = (walker.value(argument) for argument in node.args)
    walker.same(first, second, f"the arguments of {node.value} are {{0}} and {{1}}")
    return NOTHING


def _rotation(axis: int) -> Callable[[UnitInference, Node], Value]:
    def call(walker: UnitInference, node: Node) -> Value:
        _of_number(walker, node)
        return tuple(tuple(NOTHING if (i == axis) == (j == axis) else ZERO for j in range(3)) for i in range(3))

    return call


def _components(walker: UnitInference, node: Node) -> list[Any]:
    if len(node.args) == 1:
        return [row[0] for row in walker.matrix(node.args[0])]
    return [walker.scalar(argument) for argument in node.args]


def _skew_of(a: Value, b: Value, c: Value) -> Rows:
    return ((ZERO, c, b), (c, ZERO, a), (b, a, ZERO))


def _cross(walker: UnitInference, node: Node) -> Value:
    left, right = (walker.matrix(argument) for argument in node.args)
    if shape_of(left) != (3, 1):
        raise Unreadable
    return walker.times(_skew_of(*(row[0] for row in left)), right)


def _dot(walker: UnitInference, node: Node) -> Value:
    left, right = (walker.matrix(argument) for argument in node.args)
    return walker.dot([row[0] for row in left], [row[0] for row in right])


def _vee(walker: UnitInference, node: Node) -> Value:
    rows = walker.matrix(node.args[0])
    if shape_of(rows) != (3, 3):
        raise Unreadable
    pairs = ((2, 1), (0, 2), (1, 0))
    words = f"the two sides of the diagonal of {piece_text(node.args[0])} are {{0}} and {{1}}"
    return tuple((walker.same(rows[i][j], rows[j][i], words),) for i, j in pairs)


def _matrix(walker: UnitInference, node: Node) -> Value:
    rows = walker.value(node.args[0])
    if isinstance(rows, tuple):
        return rows
    if not isinstance(rows, list):
        raise Unreadable
    found = tuple(tuple(row) if isinstance(row, list) else (row,) for row in rows)
    if len({len(row) for row in found}) != 1:
        raise Unreadable
    return found


def _diagonal(walker: UnitInference, node: Node) -> Value:
    entries = [walker.scalar(argument) for argument in node.args]
    return tuple(tuple(e if i == j else ZERO for j in range(len(entries))) for i, e in enumerate(entries))


def _eye(walker: UnitInference, node: Node) -> Value:
    size = int(number_of(node.args[0]) or 0)
    return tuple(tuple(NOTHING if i == j else ZERO for j in range(size)) for i in range(size))


def _hstack(walker: UnitInference, node: Node) -> Value:
    parts = [walker.matrix(argument) for argument in node.args]
    return tuple(tuple(entry for part in row for entry in part) for row in zip(*parts, strict=True))


def _product_of_quaternions(walker: UnitInference, node: Node) -> Value:
    factors = [[row[0] for row in walker.matrix(argument)] for argument in node.args]
    if any(len(factor) != 4 for factor in factors):
        raise Unreadable
    found = reduce(lambda p, q: _qmul(walker, p, q), factors)
    return tuple((entry,) for entry in found)


def _qmul(walker: UnitInference, p: list[Any], q: list[Any]) -> list[Any]:
    """Component n of a product sums p[i] q[j] with i xor j = n."""
    return [
        walker.total([walker.times(p[i], q[i ^ n]) for i in range(4)], "a product of quaternions") for n in range(4)
    ]


def _dcm_of(walker: UnitInference, node: Node) -> Value:
    q = _components(walker, node)
    if len(q) != 4:
        raise Unreadable
    unit = walker.total(q, "the quaternion")
    square = walker.times(unit, unit)
    return tuple((square,) * 3 for _ in range(3))


def _trace(walker: UnitInference, node: Node) -> Value:
    rows = walker.matrix(node.args[0])
    return walker.total([row[n] for n, row in enumerate(rows)], "a trace")


def _derivative(walker: UnitInference, node: Node) -> Value:
    value = walker.value(node.args[0])
    divisor: Dimension = NOTHING
    last: Dimension = NOTHING
    for argument in node.args[1:]:
        count = number_of(argument)
        if count is not None:  # diff(x, t, 2)
            divisor = times(divisor, raised(last, count - 1))
            continue
        last = walker.scalar(argument) or NOTHING
        divisor = times(divisor, last)
    return walker.times(raised(divisor, Fraction(-1)), value)


def _integral(walker: UnitInference, node: Node) -> Value:
    value = walker.value(node.args[0])
    for limits in node.args[1:]:
        if limits.kind != "list" or len(limits.args) not in (1, 3):
            raise Unreadable
        variable, *ends = (walker.scalar(member) for member in limits.args)
        for end in ends:
            words = f"the variable {piece_text(limits.args[0])} of an integral is {{0}}, its limit {{1}}"
            walker.same(variable, end, words)
        value = walker.times(variable, value)
    return value


def _inverse_of(walker: UnitInference, node: Node) -> Value:
    return walker.inverse(walker.matrix(node.args[0]))


CALLS: dict[str, Callable[[UnitInference, Node], Any]] = {
    **dict.fromkeys(("sin", "cos", "tan", "cot", "sec", "csc", "asin", "acos", "atan", "acot", "exp", "log", "sinh",
                     "cosh", "tanh", "asinh", "acosh", "atanh", "sinc", "factorial"), _of_number),
    "atan2": _alike, "Rx": _rotation(0), "Ry": _rotation(1), "Rz": _rotation(2),
    "sqrt": lambda walker, node: walker.power(walker.scalar(node.args[0]), Fraction(1, 2)),
    "abs": lambda walker, node: walker.scalar(node.args[0]),
    "sign": lambda walker, node: NOTHING,
    "skew": lambda walker, node: _skew_of(*_components(walker, node)),
    "transpose": lambda walker, node: tuple(zip(*walker.matrix(node.args[0]), strict=True)),
    "det": lambda walker, node: walker.determinant(walker.matrix(node.args[0])), "inverse": _inverse_of,
    "cross": _cross, "dot": _dot, "vee": _vee, "Matrix": _matrix, "diag": _diagonal, "eye": _eye, "hstack": _hstack,
    "qmul": _product_of_quaternions, "dcm_of": _dcm_of, "trace": _trace, "diff": _derivative,
    **dict.fromkeys(("integrate", "Integral"), _integral),
}  # fmt: skip
