"""Problems in symbols, created by templates: statement, law, equations of the solution, and possible numbers."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

from sympy import Add, Expr, Symbol

__all__ = ["Asked", "Line", "Problem", "Quantity", "Template", "chain", "quantity", "written_sum"]


@dataclass(frozen=True)
class Quantity:
    """A symbol, its unit, and the numbers that it may have, as texts such as ``"0.4"`` or ``"2/3"``.

    Attributes
    ----------
    symbol : Symbol
        The symbol in the formulas of the problem.
    numbers : tuple of str
        The numbers from which one is chosen at random.
    unit : str
        A unit that :mod:`symrot.checker.units.conversion` knows; empty for a pure number.
    words : str
        The meaning of the symbol.
    """

    symbol: Symbol
    numbers: tuple[str, ...]
    unit: str
    words: str


def quantity(symbol: Symbol, numbers: str, unit: str, words: str) -> Quantity:
    """Return a :class:`Quantity`; ``numbers`` lists its possible numbers, as in ``"0.2 0.3 1/2"``."""
    return Quantity(symbol, tuple(numbers.split()), unit, words)


def written_sum(*terms: Any) -> Expr:
    """Return a SymPy sum that is not simplified, so that it is printed term by term: ``m*R**2/2 + m*R**2``."""
    return Add(*terms, evaluate=False)


@dataclass(frozen=True)
class Line:
    """One line of a solution: an equation that must hold exactly.

    Attributes
    ----------
    claim : str
        The reason, a sentence.
    left, right : Expr or Matrix
        The two sides of the equation.
    named : str
        Name of the left side in LaTeX, which is displayed instead of the expression.
    relations : tuple of Expr
        Expressions that are zero in this problem; the proof of the equation uses them.
    """

    claim: str
    left: Any
    right: Any
    named: str = ""
    relations: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Asked:
    """A quantity that a question of the exercise asks for.

    Attributes
    ----------
    name : str
        Its letter as LaTeX, ``"I_O"``.
    words : str
        Its meaning.
    formula : Expr
        The quantity in the symbols of the problem, as symrot derived it. It is the right side of a line of the
        solution whose left side has this name.
    unit : str
        The unit of the number; empty for a pure number.
    as_formula, as_number : bool
        Whether the exercise asks for the formula, and for the number.
    """

    name: str
    words: str
    formula: Expr
    unit: str
    as_formula: bool = True
    as_number: bool = True


def chain(
    name: str, law: str, left: Any, written: Any, result: Any, then: str = "The expression is simplified."
) -> tuple[Line, ...]:
    """Return the lines of a solution that gives a quantity first as ``written`` and then as ``result``.

    Parameters
    ----------
    name : str
        The quantity as LaTeX, the displayed left side of both lines.
    law, then : str
        The reasons of the first and of the second line.
    left : Expr
        The quantity as symrot derived it; both lines are proven against this expression.
    written, result : Expr
        The right sides. If they are the same expression, there is only the first line.
    """
    first = Line(law, left, written, name)
    return (first,) if written == result else (first, Line(then, left, result, name))


@dataclass(frozen=True)
class Problem:
    """An exercise whose quantities have no numbers yet.

    Attributes
    ----------
    title : str
        A short title of the exercise.
    statement : str
        The text of the exercise, Markdown with formulas in ``$``.
    law : str
        The first hint: which law answers the question.
    quantities : tuple of Quantity
        The given quantities.
    lines : tuple of Line
        The equations of the solution. The second hint shows the first of them.
    asked : tuple of Asked
        The quantities that the questions ask for.
    fits : callable
        A function that takes a mapping from symbol to value in SI units, and returns whether these values are possible
        together, such as an inner radius below an outer radius.
    sketch : tuple of str
        The arguments of the function that draws the template's sketch, such as the sequence of the Euler angles.
    """

    title: str
    statement: str
    law: str
    quantities: tuple[Quantity, ...]
    lines: tuple[Line, ...]
    asked: tuple[Asked, ...]
    fits: Callable[[Mapping[Symbol, Expr]], bool] = lambda values: True
    sketch: tuple[str, ...] = ()


Template = Callable[[Random], Problem]
"""A function that makes a problem; it chooses variants, such as the sequence of the Euler angles, at random."""
