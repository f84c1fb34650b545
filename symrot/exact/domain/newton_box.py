"""Boxes that provably contain a solution of equations, by the interval Newton operator of Krawczyk.

A box X around x is mapped to ``K = x - Y f(x) + (1 - Y J(X)) (X - x)``. If K lies inside X, X contains a solution of f
= 0 (Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken, Computing 4, 1969).
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mpmath import iv
from sympy import Dummy, Expr

from symrot.exact.floats import NoValue, float_at
from symrot.exact.intervals import as_interval, enclosure
from symrot.exact.limits.size import pieces

__all__ = ["EquationSystem"]

MOST_STEPS = 40
MOST_EQUATIONS = 24
MOST_PIECES = 4000
"""Largest total number of subexpressions of the equations; larger systems are not solved."""

SMALLEST_PIVOT = 1e-7
RADII = (1e-11, 1e-8, 1e-6)
"""Half widths, relative to ``1 + |x|`` for each unknown x, of boxes that are tried in turn to prove a solution."""

Row = list[float]


class EquationSystem:
    """Equations ``formula = 0`` in several unknowns, with Newton's method and with a proof that a solution exists.

    Parameters
    ----------
    formulas : sequence of Expr
        The formulas that must be zero.
    leaves : sequence of Expr
        The unknowns: all symbols, functions of time and derivatives in the formulas.
    """

    def __init__(self, formulas: Sequence[Expr], leaves: Sequence[Expr]) -> None:
        self.leaves = list(leaves)
        self.names = {leaf: Dummy(f"x{n}", real=True) for n, leaf in enumerate(leaves)}
        self.small = len(formulas) <= MOST_EQUATIONS and pieces(formulas) <= MOST_PIECES
        self.formulas = [formula.xreplace(self.names) for formula in formulas] if self.small else []
        self.slopes = [[formula.diff(name) for name in self.names.values()] for formula in self.formulas]

    def solved(self, start: Mapping[Expr, float]) -> dict[Expr, float] | None:
        """Return the point to which Newton's method converges from ``start``, in doubles; None without convergence."""
        values = {self.names[leaf]: float(start[leaf]) for leaf in self.leaves}
        for _ in range(MOST_STEPS if self.small else 0):
            try:
                known: dict[Expr, float] = {}
                residuals = [float_at(formula, values, known) for formula in self.formulas]
                rows = [[float_at(slope, values, known) for slope in row] for row in self.slopes]
            except NoValue:
                return None
            if max(map(abs, residuals)) < 1e-13 * (1 + max(map(abs, values.values()))):
                return {leaf: values[name] for leaf, name in self.names.items()}
            step = _shortest(rows, residuals)
            if step is None or max(map(abs, step)) > 1e6:
                return None
            values = {name: value - move for (name, value), move in zip(values.items(), step, strict=True)}
        return None

    def box(self, near: Mapping[Expr, float]) -> dict[Expr, Any] | None:
        """Return values of the unknowns (fractions or intervals) that provably contain a solution near ``near``.

        Return None if the proof fails.
        """
        values = {self.names[leaf]: near[leaf] for leaf in self.leaves}
        try:
            rows = [[float_at(slope, values, {}) for slope in row] for row in self.slopes]
        except NoValue:
            return None
        # the unknowns of these columns are solved for, the others are fixed
        chosen = _pivots(rows)
        if chosen is None:
            return None
        names = list(self.names.values())
        inverse = _inverted([[row[place] for place in chosen] for row in rows])
        if inverse is None:
            return None
        # with n equations for m unknowns, m - n unknowns keep the values where the search ended, as exact fractions
        fixed = {name: Fraction(values[name]) for n, name in enumerate(names) if n not in chosen}
        for radius in RADII:
            box = self._proven([names[n] for n in chosen], inverse, fixed, values, radius)
            if box is not None:
                return {leaf: box[name] for leaf, name in self.names.items()}
        return None

    def _proven(
        self, unknowns: list[Expr], inverse: list[Row], fixed: dict[Expr, Any], near: dict[Expr, float], radius: float
    ) -> dict[Expr, Any] | None:
        middle = {name: Fraction(near[name]) for name in unknowns}
        spread = {name: iv.mpf([-1, 1]) * (radius * (1 + abs(near[name]))) for name in unknowns}
        box = {name: as_interval(middle[name]) + spread[name] for name in unknowns}
        values = [enclosure(formula, fixed | middle) for formula in self.formulas]
        places = [list(self.names.values()).index(name) for name in unknowns]
        slopes = [[enclosure(row[place], fixed | box) for place in places] for row in self.slopes]
        if None in values or any(None in row for row in slopes):
            return None
        for n, name in enumerate(unknowns):
            image = as_interval(middle[name])
            for k, value in enumerate(values):
                image = image - inverse[n][k] * value
            for j, other in enumerate(unknowns):
                rest = iv.mpf(int(n == j))
                for k, row in enumerate(slopes):
                    rest = rest - inverse[n][k] * row[j]
                image = image + rest * spread[other]
            if not (image.a > box[name].a and image.b < box[name].b):
                return None
        return fixed | box


def _shortest(rows: list[Row], residuals: Row) -> Row | None:
    """Return the shortest ``step`` with approximately ``rows * step = residuals``, or None if all rows are zero."""
    gram = [[sum(a * b for a, b in zip(p, q, strict=True)) for q in rows] for p in rows]
    size = max(gram[n][n] for n in range(len(gram)))
    if not size:
        return None
    for n, row in enumerate(gram):
        # damping: with dependent rows the equations hold approximately
        row[n] += 1e-13 * size
    inverse = _inverted(gram)
    if inverse is None:
        return None
    weights = [sum(a * b for a, b in zip(row, residuals, strict=True)) for row in inverse]
    return [sum(w * row[n] for w, row in zip(weights, rows, strict=True)) for n in range(len(rows[0]))]


def _inverted(rows: list[Row]) -> list[Row] | None:
    """Return the inverse of a square matrix by elimination with pivoting, or None if it is singular."""
    size = len(rows)
    work = [[*row, *(float(i == j) for j in range(size))] for i, row in enumerate(rows)]
    for column in range(size):
        pivot = max(range(column, size), key=lambda r: abs(work[r][column]))
        if not work[pivot][column]:
            return None
        work[column], work[pivot] = work[pivot], work[column]
        head = work[column][column]
        work[column] = [value / head for value in work[column]]
        for r in range(size):
            times = work[r][column]
            if r != column and times:
                work[r] = [a - times * b for a, b in zip(work[r], work[column], strict=True)]
    return [row[size:] for row in work]


def _pivots(rows: list[Row]) -> list[int] | None:
    """Return the indices of independent columns of a matrix, sorted, one per row; None if there are too few."""
    work = [list(row) for row in rows]
    chosen: list[int] = []
    for step in range(len(work)):
        size, r, c = max(((abs(work[r][c]), r, c) for r in range(step, len(work)) for c in range(len(work[0]))),
                         default=(0.0, 0, 0))  # fmt: skip
        if size < SMALLEST_PIVOT:
            return None
        work[step], work[r] = work[r], work[step]
        for other in work[step + 1 :]:
            times = other[c] / work[step][c]
            other[:] = [a - times * b for a, b in zip(other, work[step], strict=True)]
            other[c] = 0.0
        chosen.append(c)
    return sorted(chosen)
