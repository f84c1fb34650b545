"""Bounds on the size of a formula, computed before SymPy builds it: a formula too large to expand is refused."""

from typing import Any

from sympy import Expr

__all__ = [
    "LARGEST_INVERSE",
    "LARGE_MATRIX",
    "MOST_ANGLE_TERMS",
    "MOST_DIFFERENTIATED",
    "MOST_NESTED",
    "MOST_PIECES",
    "MOST_PRODUCTS",
    "nesting",
    "products_of_determinant",
    "terms_of_angle",
]

MOST_PIECES = 200_000
"""The largest number of symbols, numbers and operations in the SymPy expression that is built from a formula; parts
that occur twice are counted twice."""

MOST_DIFFERENTIATED = 3_000
"""The largest number of symbols, numbers and operations in a formula that is differentiated."""

MOST_PRODUCTS = 2_000
"""The largest number of products of entries in a determinant; a full 6 x 6 matrix has 720, a full 7 x 7 matrix 5040."""

LARGEST_INVERSE = 200
"""The largest number of products in the determinant of a matrix that is inverted; a full 5 x 5 matrix has 120."""

LARGE_MATRIX = 1_000
"""Number of symbols, numbers and operations in a matrix: above it, the determinant is expanded by cofactors."""

MOST_ANGLE_TERMS = 2_000
"""The largest number of terms into which a sine of a sum may be expanded; the sine of a sum of eleven angles expands
into 1024 products of sines and cosines of single angles."""

MOST_NESTED = 16
"""The largest number of functions and fractional powers inside one another; SymPy needs seconds for 16, and minutes for
25."""


def nesting(formula: Expr) -> int:
    """Return how deeply functions and roots are nested in a formula: 2 for ``sin(sqrt(x))``."""
    depths: dict[Any, int] = {}

    def depth(node: Any) -> int:
        if node not in depths:
            own = node.is_Function or (node.is_Pow and node.exp.is_Rational and node.exp.q > 1)
            depths[node] = own + max(map(depth, node.args), default=0)
        return depths[node]

    return depth(formula)


def products_of_determinant(matrix: Any) -> int:
    """Return the number of nonzero products in the expansion of a determinant: 2 for a full 2 x 2 matrix."""
    ways = {0: 1}
    for row in range(matrix.rows):
        after: dict[int, int] = {}
        for used, number in ways.items():
            for column in range(matrix.cols):
                if not used >> column & 1 and matrix[row, column] != 0:
                    key = used | 1 << column
                    after[key] = after.get(key, 0) + number
        ways = after
    return sum(ways.values())


def terms_of_angle(angle: Expr) -> int:
    """Return about how many terms the expanded sine of an angle has: 2 for a + b, since sin(a + b) has two."""
    terms, number = 1, 0
    for term in angle.as_ordered_terms() if angle.is_Add else [angle]:
        multiple, atom = term.as_coeff_Mul()
        if atom.free_symbols:
            number += 1
            terms *= 1 + abs(int(multiple.p)) // 2 if multiple.is_Rational else 1
    return int(terms * 2 ** max(number - 1, 0))
