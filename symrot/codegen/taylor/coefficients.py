"""Taylor coefficients of a system, computed from its recurrences with any kind of number.

With Fractions the coefficients are exact, which tests use to prove the rules; computed with numbers of 40 digits, they
serve as a reference. Standard library only.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.codegen.taylor.linear_forms import ONE, ZERO
from symrot.codegen.taylor.recurrences import Recurrences, Series
from symrot.formula.tree import Node, evaluate

__all__ = ["coefficients"]


class _Run(NamedTuple):
    """The data of one computation of Taylor coefficients with one kind of number, such as Fraction."""

    constant: Callable[[Node], Any]
    functions: Mapping[str, Callable[..., Any]]
    coefficients: list[list[Any]]  # of each series, so far
    t: Any


def coefficients(
    system: Recurrences,
    order: int,
    values: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]] | None = None,
    number: Callable[[Fraction], Any] = lambda value: value,
) -> list[list[Any]]:
    """Return one list for each state: its Taylor coefficients 0 to ``order``, computed with any kind of number.

    Parameters
    ----------
    system : Recurrences
        The recurrences of the right-hand side.
    order : int
        Index of the highest coefficient.
    values : mapping
        Values of states, parameters and t, by name, at the centre of the expansion.
    functions, number
        As for :func:`symrot.formula.tree.evaluate`.
    """
    run = _Run(
        lambda node: evaluate(node, values, functions, number), functions or {}, [[] for _ in system.series],
        values.get("t", number(Fraction(0))),
    )  # fmt: skip
    state = {series.number: run.coefficients[i] for i, series in enumerate(system.series) if series.rule == "state"}
    for i, name in enumerate(system.states):
        state.setdefault(i, []).append(values[name])
    for i, seed in enumerate(system.seeds, start=len(system.states)):
        state[i].append(run.constant(seed))
    for n in range(order):
        for series, own in zip(system.series, run.coefficients, strict=True):
            if series.rule != "state":
                own.append(_RULES[series.rule](run, series, n, own))
        for i, rate in enumerate(system.rates):
            state[i].append(_sum_rule(run, rate, n, []) / (n + 1))
    return [state[i] for i in range(len(system.states))]


def _convolution(u: Sequence[Any], v: Sequence[Any], n: int, first: int, last: int) -> Any:
    return sum((u[k] * v[n - k] for k in range(first, last + 1)), start=0)


def _sum_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    *weights, constant = series.weights
    total = run.constant(constant if n == 0 and constant is not None else ZERO)
    for operand, weight in zip(series.operands, weights, strict=True):
        total = total + run.constant(weight) * run.coefficients[operand][n]  # type: ignore[arg-type]
    return total


def _product_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    u, v = (run.coefficients[i] for i in series.operands)
    if u is not v:
        return _convolution(u, v, n, 0, n)
    pairs = 2 * _convolution(u, u, n, 0, (n - 1) // 2)
    return pairs if n % 2 else pairs + u[n // 2] * u[n // 2]


def _quotient_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    *top, v = (run.coefficients[i] for i in series.operands)
    upper = top[0][n] if top else run.constant(ONE) if n == 0 else 0
    return (upper - _convolution(v, own, n, 1, n)) / v[0]


def _root_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    (u,) = (run.coefficients[i] for i in series.operands)
    return run.functions["sqrt"](u[0]) if n == 0 else (u[n] - _convolution(own, own, n, 1, n - 1)) / (2 * own[0])


def _seed(run: _Run, series: Series, first: int) -> Any:
    return run.functions[series.function](*(run.coefficients[i][0] for i in series.operands[first:]))


def _driven_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    e, v = (run.coefficients[i] for i in series.operands[:2])
    return _seed(run, series, 2) if n == 0 else series.sign * _convolution(e, v, n, 1, n) / n


def _primitive_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    g, e, v = (run.coefficients[i] for i in series.operands[:3])
    return _seed(run, series, 3) if n == 0 else (g[n] - _convolution(e, v, n, 1, n - 1)) / (n * v[0])


def _clock_rule(run: _Run, series: Series, n: int, own: list[Any]) -> Any:
    rate, offset = (0 if weight is None else run.constant(weight) for weight in series.weights)
    if n == 0:
        return run.functions[series.function](rate * run.t + offset)
    return series.sign * rate * run.coefficients[series.operands[0]][n - 1] / n


_RULES: dict[str, Callable[[_Run, Series, int, list[Any]], Any]] = {
    "time": lambda run, series, n, own: run.t if n == 0 else run.constant(ONE) if n == 1 else 0,
    "sum": _sum_rule,
    "product": _product_rule,
    "quotient": _quotient_rule,
    "root": _root_rule,
    "theta": lambda run, series, n, own: n * run.coefficients[series.operands[0]][n],
    "driven": _driven_rule,
    "primitive": _primitive_rule,
    "clock": _clock_rule,
}
"""Name of a recurrence rule, such as "product" -> function that computes coefficient n of a series by this rule."""
