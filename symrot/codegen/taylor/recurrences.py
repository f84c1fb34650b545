"""Recurrences for the Taylor coefficients of a motion, built from its rates dy/dt with one rule for each operation.

A series is the list of Taylor coefficients ``u[0], u[1], ...`` of one quantity u along the motion, in powers of the
time t from the centre of the expansion. A rule computes coefficient n of the result w from coefficients up to n of the
operands; for the states, ``x[n+1] = rate[n]/(n+1)``. The quantity ``t u'`` has the coefficients ``n u[n]``. The rules
for products, quotients and square roots contain sums over n terms (convolutions):

=====================  ====================================================================================
product ``w = u v``    ``w[n] = sum(u[k] v[n-k], k = 0..n)``; a square adds each pair once and doubles it
quotient ``w v = u``   ``w[n] = (u[n] - sum(v[k] w[n-k], k = 1..n))/v[0]``
root ``w w = u``       ``w[n] = (u[n] - sum(w[k] w[n-k], k = 1..n-1))/(2 w[0])``
=====================  ====================================================================================

Three more rules are for functions w = f(u) of one quantity u:

- driven, for exp, sin, cos, sinh, cosh, tan, tanh and sech: f' is written as ``s v``, where s is 1 or -1 and v is
  another series or w itself; for cos, v is sin(u) and s is -1. With ``e = t u'``, ``t w' = s e v`` gives
  ``n w[n] = s sum(e[k] v[n-k], k = 1..n)``.
- primitive, for log, asin, acos, atan and atan2: ``t w'`` is a quotient ``g/v`` of two series; for log, g is ``t u'``
  and v is u. With ``e = t w'``, ``v e = g`` gives ``n w[n] = (g[n] - sum(e[k] v[n-k], k = 1..n-1))/v[0]``.
- clock, for exp, sin, cos, sinh and cosh of a linear function of time with the slope a: with s and v as in driven,
  ``n w[n] = s a v[n-1]``, without a sum.

Source: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., sections 10.2 and 13.2.

Standard library only: the recurrences of a cached kernel are built without SymPy.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.codegen.taylor.linear_forms import (
    ONE,
    ZERO,
    Linear,
    alone,
    folded,
    number_and_rest,
    scaled,
    total,
    value_of,
)
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.tree import Node, children

__all__ = ["Recurrences", "Series", "recurrences"]

SINE_COSINE_PAIRS: dict[str, tuple[str, str, int, int]] = {  # function -> pair, signs of their derivatives
    "sin": ("sin", "cos", 1, -1), "cos": ("sin", "cos", 1, -1),
    "sinh": ("sinh", "cosh", 1, 1), "cosh": ("sinh", "cosh", 1, 1),
}  # fmt: skip
TANGENTS = {"tan": 1, "tanh": -1}  # function -> sign in t w' = (1 + sign w^2) t u'


class Series(NamedTuple):
    """One series of Taylor coefficients: the rule that computes it, its operands, and the constants of the rule."""

    rule: str  # state time sum product quotient root driven primitive clock, or theta (t u')
    # indices of series; for a function f(u), the last is the argument u
    operands: tuple[int, ...] = ()
    # of a sum: one constant per operand, then the constant that is added to coefficient 0, or None; of a function of a
    # t + b: a and b
    weights: tuple[Node | None, ...] = ()
    function: str = ""  # name of f, whose rule gives coefficients 1, 2, ..; coefficient 0 is f(u[0])
    sign: int = 1  # s in the rules driven and clock: -1 for cos, whose derivative is -sin
    number: int = 0  # index of a state


class Recurrences(NamedTuple):
    """The recurrences of a program: all series, in an order in which each coefficient can be computed."""

    states: tuple[str, ...]
    parameters: tuple[str, ...]
    series: tuple[Series, ...]
    rates: tuple[Series, ...]  # the rate of each state, then of each auxiliary state
    seeds: tuple[Node, ...] = ()  # formulas of states and t: coefficient 0 of each auxiliary state


POLYNOMIAL = {"state", "time", "sum", "product"}  # rules of polynomials; other functions, as tanh, may tend to -1


def recurrences(program: Program) -> Recurrences:
    """Return the recurrences for the Taylor coefficients of y, for the rates ``dy = f(t, y, p)``.

    Parameters
    ----------
    program : Program
        Arguments t (optional), y, p (optional) and dy, which has one component for each component of y.

    Raises
    ------
    InputError
        If an operation, such as abs, does not have a Taylor series everywhere.
    """
    return _Builder(program).result()


class _Builder:
    def __init__(self, program: Program) -> None:
        self.program = program
        inputs = {a.name: tuple(name for name, *_ in a.components) for a in program.signature.arguments}
        self.states, self.parameters = inputs["y"], inputs.get("p", ())
        self.series: list[Series] = []
        self.known: dict[tuple[Any, ...], int] = {}
        self.cosh_arguments: dict[int, Linear] = {}
        self.values: dict[str, Linear] = {name: Linear(("symbol", name), {}) for name in self.parameters}
        for i, name in enumerate(self.states):
            self.values[name] = alone(self.add(Series("state", number=i)))
        self.clock_names = inputs.get("t", ())

    def result(self) -> Recurrences:
        for name in self.clock_names:
            self.values[name] = Linear(None, {})  # made when it is first used
        for name, node in self.program.temporaries:
            self.values[name] = self.read(node)
        rates = tuple(self.sum_of(self.read(node)) for _, node in self.program.outputs)
        return _without_unused(Recurrences(self.states, self.parameters, tuple(self.series), rates))

    def add(self, series: Series) -> int:
        if series not in self.known:
            self.known[series] = len(self.series)
            self.series.append(series)
        return self.known[series]

    def read(self, node: Node) -> Linear:
        """Return a formula as a linear form: for ``2*x*y + 1``, the constant 1 plus 2 times the series of x*y."""
        kind = node[0]
        if kind == "number":
            return Linear(node, {})
        if kind == "symbol":
            return alone(self.add(Series("time"))) if node[1] in self.clock_names else self.values[node[1]]
        parts = [self.read(child) for child in children(node)]
        if kind in "+-*/neg" and not any(part.terms for part in parts):
            return Linear(folded((kind, *map(value_of, parts))), {})
        # adds a series for each new operation
        return _READERS[kind](self, node, parts)

    def series_of(self, form: Linear) -> int:
        """Return the index of the series that equals ``form``; a sum is added as a new series."""
        if form.constant is None and list(form.terms.values()) == [ONE]:
            return next(iter(form.terms))
        return self.add(self.sum_of(form))

    @staticmethod
    def sum_of(form: Linear) -> Series:
        terms = sorted(form.terms.items())
        return Series("sum", tuple(i for i, _ in terms), (*(weight for _, weight in terms), form.constant))

    def factored(self, form: Linear) -> tuple[Node, int]:
        """Return (constant, index of a series), whose product equals ``form``: ``2*u + 4*v`` gives 2 and u + 2*v."""
        if form.constant is None and len(form.terms) == 1:
            ((series, weight),) = form.terms.items()
            return weight, series
        parts = [number_and_rest(weight) for _, weight in sorted(form.terms.items())]
        rests = {rest for _, rest in parts}
        if form.constant is not None:
            rests.add(number_and_rest(form.constant)[1])
        lead, rest = parts[0][0], ONE
        if len(rests) == 1:
            (rest,) = rests
        elif abs(lead) != 1:
            lead = Fraction(1 if lead > 0 else -1)

        def reduced(weight: Node) -> Node:
            number, own = number_and_rest(weight)
            return folded(("*", ("number", number / lead), ONE if len(rests) == 1 else own))

        constant = None if form.constant is None else reduced(form.constant)
        # proportional forms, such as 2*u + 4*v and u + 2*v, share one series
        whole = self.series_of(Linear(constant, {series: reduced(w) for series, w in form.terms.items()}))
        return folded(("*", ("number", lead), rest)), whole

    def sum(self, left: Linear, right: Linear, sign: int) -> Linear:
        """Return ``left + sign*right``, where ``sign`` is 1 or -1."""
        # a sum in brackets that may become zero during the motion is not expanded
        if left.terms and right.terms:
            left, right = self.bracket(left), self.bracket(right)
        return total(left, right, sign)

    def bracket(self, form: Linear) -> Linear:
        """Return ``m + m*tanh(u)`` as ``m*s`` with the series ``s = 1 + tanh(u)``; other sums are unchanged."""
        parts = [*form.terms.values(), *([] if form.constant is None else [form.constant])]
        factors = [number_and_rest(part) for part in parts]
        if (
            len(parts) < 2
            or len({rest for _, rest in factors}) > 1
            or all(rest == ONE and abs(number) == 1 for number, rest in factors)
            or all(self.series[series].rule in POLYNOMIAL for series in form.terms)
        ):
            # one term, different factors, no factor, or polynomials alone
            return form
        # expanded, the form would have a rounding error proportional to m where the sum tends to zero
        weight, series = self.factored(form)
        return Linear(None, {series: weight})

    def product(self, left: Linear, right: Linear) -> Linear:
        if not left.terms or not right.terms:
            constant, form = (left, right) if not left.terms else (right, left)
            return scaled(form, value_of(constant))
        (a, u), (b, v) = self.factored(left), self.factored(right)
        return Linear(None, {self.add(Series("product", (min(u, v), max(u, v)))): folded(("*", a, b))})

    def quotient(self, left: Linear, right: Linear) -> Linear:
        if not right.terms:
            return scaled(left, folded(("/", ONE, value_of(right))))
        b, v = self.factored(right)
        over = self.reciprocal(v)
        if over is not None:
            return scaled(self.product(left, over), folded(("/", ONE, b)))
        if left.terms:
            a, u = self.factored(left)
            return Linear(None, {self.add(Series("quotient", (u, v))): folded(("/", a, b))})
        return Linear(None, {self.add(Series("quotient", (v,))): folded(("/", value_of(left), b))})

    def reciprocal(self, number: int) -> Linear | None:
        """Return the linear form of 1/v, where v is the series with the index ``number``, without a division.

        ``cosh(a)*cosh(b)`` gives ``sech(a)*sech(b)``. None if v is no product of hyperbolic cosines.
        """
        series = self.series[number]
        if series.rule == "product":
            left, right = map(self.reciprocal, series.operands)
            return None if left is None or right is None else self.product(left, right)
        if number not in self.cosh_arguments:
            return None
        # hyperbolic cosines could overflow
        return self.secant(self.cosh_arguments[number])

    def secant(self, argument: Linear) -> Linear:
        """Return sech(u), the hyperbolic secant of u = ``argument``."""
        # its series w is computed from the equation t w' = -tanh(u) w t u'
        u = self.series_of(argument)
        if ("sech", u) not in self.known:
            ((tangent, _),) = self.tangent("tanh", argument).terms.items()
            drive, own = self.theta(u), len(self.series)
            self.known[("sech", u)] = own
            self.series.append(Series("driven", (drive, own + 1, u), (), "sech", -1))
            self.add(Series("product", (tangent, own)))
        return alone(self.known[("sech", u)])

    def power(self, base: Linear, exponent: int) -> Linear:
        if exponent < 0:
            return self.quotient(Linear(ONE, {}), self.power(base, -exponent))
        result = Linear(ONE, {})
        for bit in format(exponent, "b"):
            result = self.product(result, result)
            result = self.product(result, base) if bit == "1" else result
        return result

    def call(self, name: str, arguments: list[Linear]) -> Linear:
        if not any(argument.terms for argument in arguments):
            return Linear(("call", name, tuple(map(value_of, arguments))), {})
        if name in SINE_COSINE_PAIRS:
            return self.sine_or_cosine(name, arguments[0])
        if name not in _FUNCTIONS:
            raise InputError(
                f"method taylor: expected functions with a Taylor series everywhere, got {name} of a quantity that "
                "changes; use method dop853"
            )
        return _FUNCTIONS[name](self, name, *arguments)

    def theta(self, series: int) -> int:
        return self.add(Series("theta", (series,)))

    def clock(self, form: Linear) -> tuple[Node, Node | None] | None:
        """Return (a, b) if ``form`` is a t + b with constants a and b, otherwise None; b = 0 is returned as None."""
        ((series, weight),) = form.terms.items() if len(form.terms) == 1 else ((-1, ONE),)
        return (weight, form.constant) if series >= 0 and self.series[series].rule == "time" else None

    def driven(self, functions: Sequence[tuple[str, int]], partners: Sequence[int], argument: Linear) -> int:
        """Add the Taylor series of functions of ``argument`` that are each other's derivatives, such as sin and cos.

        ``functions`` are pairs (name, sign): the derivative of function i is sign times function ``partners[i]``; for
        sin and cos, partners are (1, 0). Return the index of the first series; the others follow it. Series that exist
        already are not added again.
        """
        clock = self.clock(argument)
        seed = () if clock else (self.series_of(argument),)
        drive = () if clock else (self.theta(*seed),)
        key = ("driven", functions[0], clock or seed)
        if key not in self.known:
            first = self.known[key] = len(self.series)
            for (function, sign), partner in zip(functions, partners, strict=True):
                # the rule clock needs no convolution
                rule = "clock" if clock else "driven"
                self.series.append(Series(rule, (*drive, first + partner, *seed), clock or (), function, sign))
        return self.known[key]

    def sine_or_cosine(self, name: str, argument: Linear) -> Linear:
        """Return sin, cos, sinh or cosh (``name``) of ``argument``."""
        sine, cosine, *signs = SINE_COSINE_PAIRS[name]
        # the derivative of each function of a pair contains the other, so both series are added
        first = self.driven(((sine, signs[0]), (cosine, signs[1])), (1, 0), argument)
        if cosine == "cosh":
            self.cosh_arguments[first + 1] = argument
        return alone(first + (name == cosine))

    def exponential(self, name: str, argument: Linear) -> Linear:
        return alone(self.driven(((name, 1),), (0,), argument))

    def tangent(self, name: str, argument: Linear) -> Linear:
        u = self.series_of(argument)
        drive, own = self.theta(u), len(self.series)
        if ("tangent", name, u) in self.known:
            return alone(self.known[("tangent", name, u)])
        self.known[("tangent", name, u)] = own
        self.series.append(Series("driven", (drive, own + 2, u), (), name))
        square = self.add(Series("product", (own, own)))
        self.add(self.sum_of(Linear(ONE, {square: ("number", Fraction(TANGENTS[name]))})))
        return alone(own)

    def primitive(self, name: str, drive: int, divisor: int, seeds: tuple[int, ...]) -> Linear:
        key = ("primitive", name, drive, divisor, seeds)
        own = self.known.get(key, len(self.series))
        if own == len(self.series):
            self.known[key] = own
            self.series.append(Series("primitive", (drive, own + 1, divisor, *seeds), (), name))
            self.theta(own)
        return alone(own)

    def one_and_square(self, series: int, sign: int) -> Linear:
        """Return ``1 + sign*u^2``, where u is the series with index ``series``."""
        return total(Linear(ONE, {}), scaled(self.product(alone(series), alone(series)), sign), 1)

    def root(self, name: str, argument: Linear) -> Linear:
        return alone(self.add(Series("root", (self.series_of(argument),), (), name)))

    def logarithm(self, name: str, argument: Linear) -> Linear:
        u = self.series_of(argument)
        return self.primitive(name, self.theta(u), u, (u,))

    def arc_sine(self, name: str, argument: Linear) -> Linear:
        u = self.series_of(argument)
        ((divisor, _),) = self.root("sqrt", self.one_and_square(u, -1)).terms.items()
        drive = self.theta(u)
        if name == "acos":
            drive = self.series_of(scaled(alone(drive), -1))
        return self.primitive(name, drive, divisor, (u,))

    def arc_tangent(self, name: str, argument: Linear) -> Linear:
        u = self.series_of(argument)
        return self.primitive(name, self.theta(u), self.series_of(self.one_and_square(u, 1)), (u,))

    def angle(self, name: str, y: Linear, x: Linear) -> Linear:
        """Return atan2(y, x)."""
        # its series w is computed from the equation (x^2 + y^2) t w' = x t y' - y t x'
        turning = total(self.product(x, self.theta_form(y)), self.product(y, self.theta_form(x)), -1)
        square = total(self.product(x, x), self.product(y, y), 1)
        return self.primitive(
            name, self.series_of(turning), self.series_of(square), (self.series_of(y), self.series_of(x))
        )

    def theta_form(self, form: Linear) -> Linear:
        return alone(self.theta(self.series_of(form))) if form.terms else Linear(ZERO, {})


def _without_unused(system: Recurrences) -> Recurrences:
    """Return the system without the series that no rate needs; the series of states always remain."""
    needed = {i for i, series in enumerate(system.series) if series.rule == "state"}
    waiting = [operand for rate in system.rates for operand in rate.operands]
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += system.series[number].operands
    if len(needed) == len(system.series):
        return system
    place = {old: new for new, old in enumerate(sorted(needed))}

    def moved(series: Series) -> Series:
        return series._replace(operands=tuple(place[operand] for operand in series.operands))

    return system._replace(
        series=tuple(moved(system.series[old]) for old in place), rates=tuple(map(moved, system.rates))
    )


_READERS: dict[str, Callable[[_Builder, Node, list[Linear]], Linear]] = {
    "+": lambda builder, node, parts: builder.sum(parts[0], parts[1], 1),
    "-": lambda builder, node, parts: builder.sum(parts[0], parts[1], -1),
    "neg": lambda builder, node, parts: scaled(parts[0], -1),
    "*": lambda builder, node, parts: builder.product(*parts),
    "/": lambda builder, node, parts: builder.quotient(*parts),
    "**": lambda builder, node, parts: builder.power(parts[0], node[2]),
    "call": lambda builder, node, parts: builder.call(node[1], parts),
}
_FUNCTIONS: dict[str, Callable[..., Linear]] = {
    "sqrt": _Builder.root, "exp": _Builder.exponential, "tan": _Builder.tangent, "tanh": _Builder.tangent,
    "log": _Builder.logarithm, "asin": _Builder.arc_sine, "acos": _Builder.arc_sine, "atan": _Builder.arc_tangent,
    "atan2": _Builder.angle,
}  # fmt: skip
