"""The first coefficients of the truncation error of a step, as exact polynomials in the state at its start."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from symrot.certificates.truncation.packed_polynomials import PackedPolynomial, variables
from symrot.certificates.truncation.series import PowerSeries
from symrot.codegen.steps import SIZE, RungeKutta, TaylorSeries, WithDerivatives, stepped
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.formula.program import Program
from symrot.formula.tree import Node

__all__ = ["Terms", "is_polynomial", "leading_terms"]

EXACT_ORDERS = 2  # coefficients of the error that are exact polynomials, if the rates are polynomials
HIGHEST = 10  # such a coefficient has a lower order
MOST_TERMS = 4000  # of such a coefficient of a state; with more, intervals alone bound the error

Terms = list[tuple[Fraction, tuple[tuple[str, int], ...]]]
"""The terms of a polynomial: the coefficient of each, and the powers of its variables."""


def is_polynomial(rates: Program) -> bool:
    """Return whether rates have no functions, no negative powers, and no divisions except by numbers."""
    return all(_is_polynomial(node) for _, node in (*rates.temporaries, *rates.outputs))


def _is_polynomial(node: Node) -> bool:
    if node[0] in ("number", "symbol"):
        return True
    if node[0] == "call" or (node[0] == "/" and node[2][0] != "number"):
        return False
    return _is_polynomial(node[1]) and node[2] >= 0 if node[0] == "**" else all(map(_is_polynomial, node[1:]))


def leading_terms(
    rates: Program, method: RungeKutta | TaylorSeries | WithDerivatives, states: Sequence[str],
    box: Mapping[str, tuple[Fraction, Fraction]],
) -> tuple[Program, tuple[list[Terms], ...]]:  # fmt: skip
    """Return the rates as expanded polynomials, and the first coefficients of the truncation error of a step.

    The truncation error, motion minus step, is a power series in the size h of the step. With n for the order of the
    method, it begins with h^(n+1). The result has the coefficients of h^(n+1) and h^(n+2), but none above h^9; each
    coefficient is a list with a polynomial for each state. The rates are expanded because interval arithmetic then
    bounds them more tightly.

    If the rates are no polynomials, or if n is 9 or more, the rates are returned as they are, without coefficients. If
    a Taylor coefficient of the motion has more than ``MOST_TERMS`` terms, only the expanded rates are returned.

    Parameters
    ----------
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    method : RungeKutta, TaylorSeries or WithDerivatives
        The method of the step; ``WithDerivatives`` is one of the other two, whose step also computes derivatives of the
        new state.
    states : sequence of str
        The names of the states.
    box : mapping
        Ranges of t, dt, the states and the parameters, by name. An input whose range is a single number
        is a constant in the polynomials.
    """
    orders = range(method.order + 1, min(method.order + 1 + EXACT_ORDERS, HIGHEST))
    if not orders or not is_polynomial(rates):
        return rates, ()
    names = [*states, *(name for name, (low, high) in box.items() if name not in (*states, SIZE) and low < high), "t"]
    names = list(dict.fromkeys(names))

    def number(value: Fraction) -> PackedPolynomial:
        return PackedPolynomial.constant(names, value)

    zero = number(Fraction(0))
    values = {name: number(low) for name, (low, _) in box.items()}
    values |= dict(zip(names, variables(names), strict=True))
    expanded = {name: each.terms() for name, each in rates.evaluate(values, {}, number).items()}
    bare = Program(rates.signature, (), tuple((name, _sum_of(terms)) for name, terms in expanded.items()))
    system, count = recurrences(bare), orders[-1] + 1
    for order in range(1, count):  # the polynomials grow with the order, so that too long ones are noticed early
        exact = coefficients(system, order, values, {}, number)
        if max(len(zero + state[order]) for state in exact) > MOST_TERMS:
            return bare, ()
    size = PowerSeries((0, number(Fraction(1)), *(0,) * (count - 2)))
    start = {name: PowerSeries.of(value, count) for name, value in values.items() if name != SIZE}
    after = stepped(bare, method, start, size, {}, lambda value: PowerSeries.of(number(value), count))
    own = [PowerSeries.of(each, count).terms for each in after]
    return bare, tuple(
        [(zero + mine[order] - step[order]).terms() for mine, step in zip(exact, own, strict=True)] for order in orders
    )


def _sum_of(terms: Terms) -> Node:
    """Return a polynomial, given by its terms, as the syntax tree of a formula."""
    total: Node = ("number", Fraction(0))
    for value, powers in terms:
        term: Node = ("number", value)
        for name in (name for name, power in powers for _ in range(power)):
            term = ("*", term, ("symbol", name))
        total = term if total == ("number", Fraction(0)) else ("+", total, term)
    return total
