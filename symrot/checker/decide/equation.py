"""An equation to be decided, with its hypotheses and with the divisors and roots that its text has."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from sympy import Expr, Symbol

from symrot.errors import InputError
from symrot.exact.decision import Shape, ShapeMismatch, matched_sides, shape_text
from symrot.exact.domain.needs import Need

__all__ = ["Equation", "sides_of", "stated_needs"]


@dataclass(frozen=True)
class Equation:
    """An equation to be decided, with its hypotheses and with the divisors and roots that its text has.

    Attributes
    ----------
    left, right : Expr or Matrix
    hypotheses : tuple
        Equations, or expressions that are zero.
    divisors : tuple of Expr
        Formulas that the text divides by, or takes logarithms of; SymPy may have cancelled them.
    nonzero : tuple of Expr
        Formulas that hypotheses state to be nonzero.
    radicands : tuple of Expr
        Formulas that must not be negative, such as those under roots of the text.
    bases : tuple of Expr
        Bases of powers whose exponents are not numbers; these bases are assumed to be positive.
    """

    left: Any
    right: Any
    hypotheses: tuple[Any, ...] = ()
    divisors: tuple[Expr, ...] = ()
    nonzero: tuple[Expr, ...] = ()
    radicands: tuple[Expr, ...] = ()
    bases: tuple[Expr, ...] = ()

    def at(self, values: Mapping[Expr, Expr]) -> "Equation":
        """Return the equation with ``values`` in place of formulas in its sides, hypotheses and conditions."""
        parts = {field.name: getattr(self, field.name) for field in fields(self)}
        return Equation(**{
            name: tuple(each.xreplace(values) for each in part) if isinstance(part, tuple) else part.xreplace(values)
            for name, part in parts.items()
        })  # fmt: skip


def sides_of(equation: Equation) -> tuple[list[Expr], list[Expr], Shape]:
    """Return the entries of the left and of the right side, and their shape; raise InputError if the shapes differ."""
    try:
        return matched_sides(equation.left, equation.right)
    except ShapeMismatch as mismatch:
        left, right = map(shape_text, mismatch.shapes)
        loose = isinstance(equation.left, Symbol) or isinstance(equation.right, Symbol)
        hint = " (a name that nothing defines is a scalar; `symrot identify` says what a matrix is)" if loose else ""
        raise InputError(f"expected two sides of the same shape, got {left} == {right}{hint}") from None


def stated_needs(equation: Equation) -> list[Need]:
    """Return the conditions that divisors in a claim's text are nonzero, and formulas under its roots nonnegative.

    Formulas that hypotheses state to be nonzero count as divisors; a formula that is both must be positive.
    """
    stated = [Need(divisor, "!= 0") for divisor in (*equation.divisors, *equation.nonzero)]
    divided = {*equation.divisors, *equation.nonzero}  # the argument of a logarithm is recorded as both
    return [
        *stated,
        *(Need(radicand, "> 0" if radicand in divided else ">= 0") for radicand in equation.radicands),
    ]
