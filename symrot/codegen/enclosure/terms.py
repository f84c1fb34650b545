"""Selection of the terms of the rates dy/dt that must be bounded, because a step may miss a pulse in them.

A pulse is a short change of the rates. A stepper evaluates the rates only at some points and misses a pulse between
them; bounds over complex discs of times and states reveal the pulse, see :file:`propagation/enclosures/disc.h`.
Polynomials of low degree vary slowly and need no bounds. Standard library only.
"""

from collections.abc import Sequence
from typing import NamedTuple

from symrot.codegen.taylor.recurrences import Recurrences, Series
from symrot.formula.tree import Node

__all__ = ["LOW_ORDER", "REACHES", "Enclosure", "enclosure", "functions_of_time", "rounded_terms", "value_operands"]

HIGHEST_DEGREE = 6  # degree of a polynomial without short pulses: cos(t)**6 is as broad as a pulse of 0.5 rad
BEYOND = HIGHEST_DEGREE + 1
REACHES = {  # whether the order is low -> radii of the discs, in steps: low orders need larger discs
    False: (1.3, 1.8, 2.6, 3.6, 5.0, 7.0, 10.0, 16.0),
    True: (1.5, 2.5, 4.0, 7.0, 12.0, 20.0, 40.0, 80.0),
}
LOW_ORDER = 10
BOUNDED = ("sin", "cos")  # functions of a*t + b that are bounded at every time


class Enclosure(NamedTuple):
    """The terms of the rates dy/dt that must be bounded, because a step may miss a pulse (a short change) in them."""

    system: Recurrences
    # Taylor series to evaluate, each after its operands: indices into system.series
    series: tuple[int, ...]
    # for each rate: pairs (weight, series) of its bounded terms
    terms: tuple[tuple[tuple[Node, int], ...], ...]
    # indices of the states on which these terms depend
    states: tuple[int, ...]


def value_operands(series: Series) -> tuple[int, ...]:
    """Return the operands (indices of series) from which the value of a series is computed: u for sin(u).

    Left out are operands that only the higher Taylor coefficients of the series need, such as cos(u).
    """
    # the first operands of a driven series determine only its later Taylor coefficients
    first = {"driven": 2, "primitive": 3}.get(series.rule, 0)
    return () if series.rule == "clock" else series.operands[first:]


def enclosure(system: Recurrences) -> Enclosure | None:
    """Select the terms of the rates dy/dt of ``system`` in which a step may miss a pulse (a short change).

    The result is None if all terms are polynomials of low degree.
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
    needed = _needed(system, terms)
    states = {system.series[i].number for i in needed if system.series[i].rule == "state"}
    return Enclosure(system, needed, terms, tuple(sorted(states)))


def _needed(system: Recurrences, terms: Sequence[Sequence[tuple[Node, int]]]) -> tuple[int, ...]:
    """Return the indices of all series that the evaluation of the terms needs, in the order of evaluation."""
    needed: set[int] = set()
    waiting = [operand for own in terms for _, operand in own]
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += value_operands(system.series[number])
    return tuple(sorted(needed))


def _degree(series: Series, degrees: list[int]) -> int:
    """Return the degree of a series as a polynomial in the states, t, sin(a t + b) and cos(a t + b).

    Return BEYOND or more for a polynomial of high degree and for a quantity that is no such polynomial, as exp(-t^2).
    """
    # degrees[i]: the degree of series i
    if series.rule in ("state", "time"):
        return 1
    if series.rule == "clock":
        return 1 if series.function in BOUNDED else BEYOND
    # any other quantity, such as exp(u), is no polynomial
    own = [degrees[operand] for operand in value_operands(series)] if series.rule in ("sum", "product") else [BEYOND]
    return sum(own) if series.rule == "product" else max(own, default=0)


def functions_of_time(enclosure: Enclosure) -> dict[int, bool]:
    """Return {index of a series: whether it is linear in t} for the series of ``enclosure`` that depend on t alone."""
    linear: dict[int, bool] = {}
    for i in enclosure.series:
        series = enclosure.system.series[i]
        own = value_operands(series)
        if series.rule in ("time", "clock") or (own and all(operand in linear for operand in own)):
            linear[i] = series.rule == "time" or (series.rule == "sum" and all(linear[operand] for operand in own))
    return linear


def rounded_terms(enclosure: Enclosure) -> Enclosure | None:
    """Return the terms of the rates that contain a phase, a nonlinear function of t inside a divisor, root or function.

    Example: the phase t^2 - 25 in 1/((t^2 - 25)^2 + w^2). A rounding error of the phase may change such a term much.
    ``enclosure`` lists the terms of the rates dy/dt that must be bounded; the result, another Enclosure, lists only the
    terms that contain a phase. It is None if there are no such terms.
    """
    # linear phases and the functions of the rule clock are evaluated with a correction of their rounding errors
    linear = functions_of_time(enclosure)
    phases: set[int] = set()
    sensitive: set[int] = set()
    for i in enclosure.series:
        series = enclosure.system.series[i]
        own = value_operands(series)
        if series.rule not in ("sum", "product", "time", "clock", "state"):
            is_wave = series.function in ("sin", "cos", "tan")  # their phases may be large
            if phases.intersection(own) or (is_wave and any(not linear.get(operand, True) for operand in own)):
                sensitive.add(i)
        if sensitive.intersection(own):
            sensitive.add(i)
        cancels = series.rule == "sum" and sum(weight is not None for weight in series.weights) > 1
        if phases.intersection(own) or (not linear.get(i, True) and (cancels or series.rule not in ("sum", "product"))):
            phases.add(i)
    terms = tuple(tuple(pair for pair in own if pair[1] in sensitive) for own in enclosure.terms)
    return enclosure._replace(terms=terms, series=_needed(enclosure.system, terms)) if any(terms) else None
