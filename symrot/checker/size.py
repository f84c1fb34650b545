"""How large a formula would become, before it is built: counts that refuse what no machine can multiply out."""

from collections.abc import Iterable
from typing import Any

from sympy import Expr

__all__ = [
    "LARGEST_INVERSE",
    "MOST_DIFFERENTIATED",
    "MOST_PIECES",
    "MOST_PRODUCTS",
    "pieces",
    "products_of_determinant",
]

MOST_PIECES = 200_000
"""Symbols, numbers and operations that a value may be made of, those that occur twice counted twice."""

MOST_DIFFERENTIATED = 3_000
"""The same of a formula that is differentiated once more."""

MOST_PRODUCTS = 2_000
"""Products of entries in a determinant that is still multiplied out; a full 6 x 6 matrix has 720, 7 x 7 has 5040."""

LARGEST_INVERSE = 200
"""The same for a matrix that is inverted, whose minors are all needed; a full 5 x 5 matrix has 120."""


def pieces(entries: Iterable[Expr]) -> int:
    """Return how many pieces expressions are made of, written out; common parts are visited once."""
    known: dict[Expr, int] = {}

    def count(node: Expr) -> int:
        if node not in known:
            known[node] = 1 + sum(map(count, node.args))
        return known[node]

    return sum(map(count, entries))


def products_of_determinant(matrix: Any) -> int:
    """Return the number of products in the expansion of a determinant that have no zero factor, row by row."""
    ways = {0: 1}
    for row in range(matrix.rows):
        after: dict[int, int] = {}
        for taken, number in ways.items():
            for column in range(matrix.cols):
                if not taken >> column & 1 and matrix[row, column] != 0:
                    key = taken | 1 << column
                    after[key] = after.get(key, 0) + number
        ways = after
    return sum(ways.values())
