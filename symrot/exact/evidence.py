"""The evidence of a decision: the point of a counterexample, and the condition under which a claim holds."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from sympy import Expr

from symrot.exact.printing import as_text

__all__ = ["Counterexample", "Requirement"]


@dataclass(frozen=True)
class Counterexample:
    """A point where two formulas differ, with exact values.

    Attributes
    ----------
    point : tuple of (Expr, Expr)
        Symbols, sines and cosines, each with its exact value.
    entry : (int, int) or None
        Row and column, from 1, of the entry of a matrix that differs.
    left, right : Expr or str
        The exact values of the two sides, as text if that is clearer, such as ``"1/3 = 0.333333333333.."``.
    values : dict of str to str
        ``point`` as text: each name with its value.
    lhs, rhs : str
        ``left`` and ``right`` as text.

    Examples
    --------
    >>> import symrot
    >>> verdict = symrot.check("sin(2*x) == sin(x)*cos(x)")
    >>> verdict.counterexample.lhs != verdict.counterexample.rhs
    True
    """

    point: tuple[tuple[Expr, Expr], ...]
    entry: tuple[int, int] | None
    left: Any
    right: Any

    @cached_property
    def values(self) -> dict[str, str]:
        """The point of the counterexample as text: each name with its value."""
        return {as_text(name): as_text(value) for name, value in self.point}

    @cached_property
    def lhs(self) -> str:
        """The value of the equation's left side as text."""
        return as_text(self.left)

    @cached_property
    def rhs(self) -> str:
        """The value of the equation's right side as text."""
        return as_text(self.right)

    def __str__(self) -> str:
        point = ", ".join(f"{name} = {value}" for name, value in self.values.items())
        place = f"entry {self.entry}: " if self.entry else ""
        return f"{place}{self.lhs} against {self.rhs}" + (f" at {point}" if point else "")


@dataclass(frozen=True)
class Requirement:
    """A condition that makes a claim true: the formulas ``zeros`` are zero, and the formulas ``signs`` nonnegative.

    ``text`` states the condition, ``code`` names its kind.
    """

    code: str
    text: str
    zeros: tuple[Expr, ...] = ()
    signs: tuple[Expr, ...] = ()
    strict: tuple[Expr, ...] = ()  # those of signs that must be positive

    @property
    def conditions(self) -> list[tuple[Expr, str]]:
        """The conditions on signs as pairs (formula, ``"> 0"`` or ``">= 0"``), for the report."""
        return [(formula, "> 0" if formula in self.strict else ">= 0") for formula in self.signs]

    def __str__(self) -> str:
        return self.text
