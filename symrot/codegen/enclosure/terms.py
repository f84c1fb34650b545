"""Selection of the terms of a right-hand side that must be bounded (enclosed), because a step may miss a pulse in them.

A stepper evaluates a right-hand side only at some points. It does not notice a pulse, a switch or a pole between two of
these points. Bounds notice it: the formula is evaluated over complex discs (:file:`propagation/enclosures/disc.h`),
sets that contain all times and states near a step. The result is a disc that contains all values of the formula there,
and its radius bounds all Taylor coefficients that a step omits.

Polynomials of low degree in the states, in time and in sine and cosine of ``a*t + b`` need no bounds: from their
coefficients follows how fast they can vary. Therefore each rate is split into its terms, and only the terms that are
not such polynomials are bounded. The term "series" stands for the Taylor series of one quantity, see
:mod:`symrot.codegen.taylor.recurrences`.

Standard library only.
"""

from typing import NamedTuple

from symrot.codegen.taylor.recurrences import Recurrences, Series
from symrot.formula.tree import Node

__all__ = ["LOW_ORDER", "REACHES", "Enclosure", "enclosure", "value_operands"]

HIGHEST_DEGREE = 6  # degree of a polynomial without short pulses: cos(t)**6 is as broad as a pulse of 0.5 rad
BEYOND = HIGHEST_DEGREE + 1
REACHES = {  # whether the order is low -> radii of the discs, in steps: low orders need larger discs
    False: (1.3, 1.8, 2.6, 3.6, 5.0, 7.0, 10.0, 16.0),
    True: (1.5, 2.5, 4.0, 7.0, 12.0, 20.0, 40.0, 80.0),
}
LOW_ORDER = 10
BOUNDED = ("sin", "cos")  # functions of a*t + b that are bounded at every time


class Enclosure(NamedTuple):
    """The terms of the rates dy/dt that must be bounded on complex discs, because a step may miss a pulse in them.

    ``series`` lists the Taylor series to evaluate, each after its operands, as indices into ``system.series``.
    ``terms`` holds for each rate the pairs (weight, series) of its bounded terms, and ``states`` the indices of the
    states on which these terms depend.
    """

    system: Recurrences
    series: tuple[int, ...]
    terms: tuple[tuple[tuple[Node, int], ...], ...]
    states: tuple[int, ...]


def value_operands(series: Series) -> tuple[int, ...]:
    """Return those operands of a series from whose values the value of the series (its Taylor coefficient 0) follows.

    Operands are indices of series. The series of sin(u) also has operands, such as the series of cos(u), that only its
    later coefficients need; they are left out.
    """
    first = {"driven": 2, "primitive": 3}.get(series.rule, 0)
    return () if series.rule == "clock" else series.operands[first:]


def enclosure(system: Recurrences) -> Enclosure | None:
    """Return the terms of the rates dy/dt of ``system`` that must be bounded because a step may miss a pulse in them.

    None means that all terms are polynomials of low degree, which cannot hide a pulse.
    """
    degrees: list[int] = []
    for series in system.series:
        degrees.append(min(_degree(series, degrees), BEYOND))
    terms = tuple(
        tuple(
            (weight, operand)
            for operand, weight in zip(rate.operands, rate.weights, strict=False)
            if weight is not None and degrees[operand] == BEYOND
        )
        for rate in system.rates
    )
    if not any(terms):
        return None
    needed: set[int] = set()
    waiting = [operand for own in terms for _, operand in own]
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += value_operands(system.series[number])
    states = {system.series[i].number for i in needed if system.series[i].rule == "state"}
    return Enclosure(system, tuple(sorted(needed)), terms, tuple(sorted(states)))


def _degree(series: Series, degrees: list[int]) -> int:
    """Return the degree of the quantity of a series as a polynomial in the states, t, sin(a t + b) and cos(a t + b).

    ``degrees`` holds the degrees of the earlier series, which are its operands. For another quantity, such as exp(u),
    the result is at least BEYOND: a pulse may hide in it, so that the stepper must bound it.
    """
    if series.rule in ("state", "time"):
        return 1
    if series.rule == "clock":
        return 1 if series.function in BOUNDED else BEYOND
    own = [degrees[operand] for operand in value_operands(series)] if series.rule in ("sum", "product") else [BEYOND]
    return sum(own) if series.rule == "product" else max(own, default=0)
