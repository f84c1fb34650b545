"""Definitions of kernels: arguments, formulas, domain, and laws (identities that the outputs satisfy).

A box gives, for each input, the range of values for which rounding errors are bounded.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from sympy import Expr, Matrix, Symbol

from symrot import symbols
from symrot.formula.program import Argument

__all__ = ["Box", "Definition", "Law", "argument", "boxed", "interval", "result", "scalar"]

Box = dict[str, tuple[Fraction, Fraction]]  # name of an input component -> smallest and largest value


@dataclass(frozen=True)
class Law:
    """An identity that the outputs of a kernel satisfy for all inputs, such as "the norm is 1".

    The formulas ``vanishing`` are zero wherever the formulas ``relations`` (hypotheses) are zero. Both contain the
    symbols of inputs and outputs. A law describes the outputs independently of the way in which their formulas were
    derived; a certificate proves the law from the formulas.
    """

    text: str
    vanishing: tuple[Expr, ...]
    relations: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Definition:
    """A kernel: its arguments in order, the formulas of its outputs, its domain, and the laws of its outputs."""

    name: str
    title: str
    inputs: tuple[Argument, ...]
    results: tuple[tuple[Argument, tuple[Expr, ...]], ...]  # output argument, formula of each component
    domain: str
    derivation: str
    box: Box  # ranges of the inputs for which rounding errors are bounded by default
    laws: Callable[[], tuple[Law, ...]]
    named: tuple[tuple[Symbol, Expr], ...] = field(default=())  # physical quantities that the formulas use by a symbol

    @property
    def formulas(self) -> tuple[tuple[str, Expr], ...]:
        """All formulas of the kernel as pairs (output component, formula), in the order of the outputs."""
        return tuple(
            (component[0], formula)
            for target, expressions in self.results
            for component, formula in zip(target.components, expressions, strict=True)
        )


def argument(name: str, role: str, components: Sequence[Symbol | str], meaning: str, unit: str = "") -> Argument:
    """Return an input or output array whose components are symbols of :mod:`symrot.symbols`, with their units.

    If the components are given as text instead, ``unit`` is their unit.
    """
    described = []
    for component in components:
        known = unit or symbols.UNIT[component]
        described.append((str(component), known, meaning))
    return Argument(name, role, tuple(described))


def scalar(component: Symbol, meaning: str) -> Argument:
    """Return a scalar input argument."""
    return Argument(str(component), "in", ((str(component), symbols.UNIT[component], meaning),), is_scalar=True)


def result(
    name: str, formulas: Matrix | Sequence[Expr], components: Sequence[Symbol], meaning: str, unit: str = ""
) -> tuple[Argument, tuple[Expr, ...]]:
    """Return an output argument and the formulas of its components; a matrix is stored row by row."""
    return argument(name, "out", components, meaning, unit), tuple(formulas)


def interval(low: Fraction | int | str, high: Fraction | int | str) -> tuple[Fraction, Fraction]:
    """Return the range of an input, from ``low`` to ``high``, in exact numbers."""
    return Fraction(low), Fraction(high)


def boxed(components: Sequence[Symbol], low: Fraction | int | str, high: Fraction | int | str) -> Box:
    """Return a box in which the range of each of the inputs is from ``low`` to ``high``."""
    return {str(component): interval(low, high) for component in components}
