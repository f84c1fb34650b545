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
    """An identity that a kernel's outputs satisfy, such as "the matrix is orthogonal", with its hypotheses.

    ``vanishing`` are formulas in inputs and outputs that are zero for all inputs for which the formulas ``relations``
    are zero, such as q0^2 + q1^2 + q2^2 + q3^2 - 1 for unit quaternions.
    """

    # A certificate proves the law from the formulas; it says nothing about how they were derived.
    text: str
    vanishing: tuple[Expr, ...]
    relations: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class Definition:
    """A kernel of the library as symrot derives it: arguments, formulas, domain, laws that its outputs satisfy."""

    name: str
    title: str
    inputs: tuple[Argument, ...]
    results: tuple[tuple[Argument, tuple[Expr, ...]], ...]  # output argument, formula of each component
    # for which inputs the formulas hold, in words
    domain: str
    # the page that derives the formulas
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
    """Return an input or output array (``role`` is ``"in"`` or ``"out"``) with one entry per component."""
    described = []
    for component in components:
        # symrot.symbols knows the units of its symbols; texts need ``unit``
        known = unit or symbols.UNIT[component]
        described.append((str(component), known, meaning))
    return Argument(name, role, tuple(described))


def scalar(component: Symbol, meaning: str) -> Argument:
    """Return the input argument that is the single number ``component``, with ``meaning`` as its description."""
    return Argument(str(component), "in", ((str(component), symbols.UNIT[component], meaning),), is_scalar=True)


def result(
    name: str, formulas: Matrix | Sequence[Expr], components: Sequence[Symbol], meaning: str, unit: str = ""
) -> tuple[Argument, tuple[Expr, ...]]:
    """Return (output argument, formulas of its components) as :class:`Definition` stores them; a matrix row by row.

    The other arguments are explained at :func:`argument`.
    """
    return argument(name, "out", components, meaning, unit), tuple(formulas)


def interval(low: Fraction | int | str, high: Fraction | int | str) -> tuple[Fraction, Fraction]:
    """Return the range from ``low`` to ``high`` of an input, as a pair of exact fractions; ``"1/10"`` is 1/10."""
    return Fraction(low), Fraction(high)


def boxed(components: Sequence[Symbol], low: Fraction | int | str, high: Fraction | int | str) -> Box:
    """Return a box (input name -> range) in which each of the ``components`` lies between ``low`` and ``high``."""
    return {str(component): interval(low, high) for component in components}
