"""Small matrices as tuples of rows, whose entries are any kind of number: sums, products, rotations, quaternions."""

from collections.abc import Callable, Sequence
from typing import Any

from symrot.checker.repair.dual import UndefinedValue, cosine, inverse, plain, sine
from symrot.kinematics.hamilton import hamilton

__all__ = [
    "Rows", "agree", "column", "determinant", "dot", "entries_of", "inverted", "is_matrix", "mapped", "needed", "plus",
    "rotation", "rotation_of_quaternion", "shape_of", "skew", "times", "transposed",
]  # fmt: skip

CLOSE = 1e-8
"""The largest relative difference between two values in double precision that agree."""

Rows = tuple[tuple[Any, ...], ...]


def is_matrix(value: Any) -> bool:
    """Return whether a value is a matrix."""
    return isinstance(value, tuple)


def entries_of(value: Any) -> list[float]:
    """Return the entries of a scalar or matrix, row by row."""
    return [plain(entry) for row in value for entry in row] if is_matrix(value) else [plain(value)]


def shape_of(value: Any) -> tuple[int, int] | None:
    """Return (rows, columns), or None for a scalar."""
    return (len(value), len(value[0])) if is_matrix(value) else None


def mapped(function: Callable[[Any], Any], value: Any) -> Any:
    """Return a scalar or matrix after applying a function to every entry."""
    return tuple(tuple(function(entry) for entry in row) for row in value) if is_matrix(value) else function(value)


def plus(left: Any, right: Any) -> Any:
    """Return the sum of two scalars or matrices; raise UndefinedValue if their shapes differ."""
    if shape_of(left) != shape_of(right):
        raise UndefinedValue("expected terms of the same shape in a sum, got different shapes")
    if is_matrix(left):
        return tuple(tuple(a + b for a, b in zip(x, y, strict=True)) for x, y in zip(left, right, strict=True))
    return left + right


def times(left: Any, right: Any) -> Any:
    """Return the product of two scalars or matrices; raise UndefinedValue if their shapes do not fit."""
    if not is_matrix(left):
        return mapped(lambda entry: left * entry, right)
    if not is_matrix(right):
        return mapped(lambda entry: entry * right, left)
    if len(left[0]) != len(right):
        raise UndefinedValue("expected as many columns in the left factor as rows in the right one")
    columns = tuple(zip(*right, strict=True))
    return tuple(tuple(dot(row, column) for column in columns) for row in left)


def dot(left: Sequence[Any], right: Sequence[Any]) -> Any:
    """Return the dot product of two sequences."""
    total: Any = 0.0
    for a, b in zip(left, right, strict=True):
        total = total + a * b
    return total


def transposed(value: Any) -> Rows:
    """Return the transpose of a matrix."""
    return tuple(zip(*needed(value), strict=True))


def needed(value: Any, shape: tuple[int | None, int | None] = (None, None)) -> Rows:
    """Return ``value`` if it is a matrix of the given shape; otherwise raise UndefinedValue.

    In ``shape``, None stands for any number of rows or columns.
    """
    actual = shape_of(value)
    if actual is None or any(size not in (None, got) for size, got in zip(shape, actual, strict=True)):
        rows_wanted, columns_wanted = ("any number" if size is None else size for size in shape)
        got = "a number" if actual is None else f"{actual[0]} x {actual[1]} entries"
        raise UndefinedValue(f"expected a matrix (rows: {rows_wanted}, columns: {columns_wanted}), got {got}")
    rows: Rows = value
    return rows


def determinant(rows: Rows) -> Any:
    """Return the determinant of a square matrix of at most 6 rows; raise UndefinedValue for other matrices."""
    if len(rows) != len(rows[0]) or len(rows) > 6:
        raise UndefinedValue(
            f"expected a square matrix of at most 6 rows in a determinant, got {len(rows)} x {len(rows[0])} entries"
        )
    if len(rows) == 1:
        return rows[0][0]
    total: Any = 0.0
    for column, entry in enumerate(rows[0]):
        minor = tuple((*row[:column], *row[column + 1 :]) for row in rows[1:])
        total = total + (entry * determinant(minor)) * (-1.0) ** column
    return total


def inverted(rows: Rows) -> Rows:
    """Return the inverse of a square matrix of at most 6 rows, from the determinants of its submatrices."""
    below = inverse(determinant(rows))
    size = range(len(rows))
    if len(rows) == 1:
        return ((below,),)
    return tuple(
        tuple(
            determinant(tuple((*rows[r][:i], *rows[r][i + 1 :]) for r in size if r != j)) * below * (-1.0) ** (i + j)
            for j in size
        )
        for i in size
    )


def column(values: Sequence[Any]) -> Rows:
    """Return a column vector with the given entries."""
    return tuple((value,) for value in values)


def skew(a: Any, b: Any, c: Any) -> Rows:
    """Return the matrix of the cross product with (a, b, c)."""
    return ((0.0, -c, b), (c, 0.0, -a), (-b, a, 0.0))


def rotation(axis: int) -> Callable[[Any], Rows]:
    """Return the rotation matrix about axis 0, 1 or 2 (it rotates vectors), as a function of the angle in rad."""

    def matrix(angle: Any) -> Rows:
        c, s = cosine(angle), sine(angle)
        rows = [[0.0] * 3 for _ in range(3)]
        i, j = (axis + 1) % 3, (axis + 2) % 3
        rows[axis][axis], rows[i][i], rows[j][j], rows[i][j], rows[j][i] = 1.0, c, c, -s, s
        return tuple(map(tuple, rows))

    return matrix


def rotation_of_quaternion(*q: Any) -> Rows:
    """Return the matrix that maps a vector v to q v q*: a rotation matrix times the squared length of q."""
    a, b, c, d = q
    conjugate = [a, -b, -c, -d]
    columns = [hamilton(hamilton(q, [0.0, *(float(i == j) for j in range(3))]), conjugate)[1:] for i in range(3)]
    return tuple(zip(*columns, strict=True))


def agree(left: Any, right: Any) -> list[bool] | None:
    """Return, for each entry, whether two values (numbers or matrices) agree to about eight digits or within 1e-11.

    The number 0 is compared with a matrix as a zero matrix of the same shape. None if the shapes differ otherwise.
    """
    lefts, rights = entries_of(left), entries_of(right)
    if shape_of(left) != shape_of(right):
        if not is_matrix(left) and lefts == [0.0]:
            lefts = [0.0] * len(rights)
        elif not is_matrix(right) and rights == [0.0]:
            rights = [0.0] * len(lefts)
        else:
            return None
    return [abs(a - b) <= CLOSE * (abs(a) + abs(b)) + 1e-11 for a, b in zip(lefts, rights, strict=True)]
