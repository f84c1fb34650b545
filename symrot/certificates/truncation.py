"""Bounds of the truncation error of one time step on a box of states and step sizes, in interval arithmetic.

The exact motion and a step of order n and size h differ by h^(n+1) (a - b), where a and b are coefficients of Taylor
series, of the motion and of the step. Intervals contain both, on a box that no motion leaves during the step. A defect
is the amount by which a method violates an order condition, because its coefficients are rounded.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from decimal import ROUND_DOWN, Context
from fractions import Fraction
from itertools import combinations_with_replacement
from math import inf, nextafter, prod
from operator import truediv
from typing import Any

from mpmath import iv

from symrot.certificates.packed_polynomials import PackedPolynomial, variables
from symrot.codegen.steps import SIZE, Method, RungeKutta, SteadyRotations, TaylorSeries, WithDerivatives, stepped
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import CertificateError, InputError
from symrot.formula.program import Program
from symrot.formula.tree import Node, names

__all__ = ["DEFECT", "PIECES", "require_order", "truncation_bounds"]

PIECES = 24
"""Number of parts into which the box of the start is divided at most."""

BITS = 64  # of the ends of intervals
EXACT_ORDERS = 2  # coefficients of the error that are exact polynomials, if the rates are polynomials
HIGHEST = 10  # such a coefficient has a lower order
MOST_TERMS = 4000  # of such a coefficient of a state; with more, intervals alone bound the error
GROWTH = Fraction(1, 8)  # by which the box around a motion grows in each attempt, relative to its width
ATTEMPTS = 24
HALVINGS = 12  # of sizes that have no bound, for the advice which sizes have one
DEFECT = Fraction(1, 10**25)  # of an order condition, for a method whose coefficients are rounded decimals

Box = Mapping[str, tuple[Fraction, Fraction]]  # name of an input, such as "omega_1" or "dt" -> least and largest value


@contextmanager
def _precision() -> Iterator[None]:
    """Run a ``with`` block in which mpmath computes with intervals of ``BITS`` bits."""
    before, iv.prec = iv.prec, BITS
    try:
        yield
    finally:
        iv.prec = before


def _number(value: Fraction) -> Any:
    return iv.mpf(value.numerator) / value.denominator


def _interval(low: Fraction, high: Fraction) -> Any:
    return iv.mpf([_number(low).a, _number(high).b])


def _undefined(name: str) -> Callable[..., Any]:
    def refuse(*arguments: Any) -> Any:
        raise InputError(
            f"expected rates that contain only + - * / and the functions {', '.join(_SCALAR)}, so that the "
            f"truncation error of a step can be bounded, got {name}"
        )

    return refuse


def _positive(x: Any) -> Any:
    """Return the interval ``x`` if all its numbers are positive; otherwise raise ZeroDivisionError."""
    if not x.a > 0:
        raise ZeroDivisionError
    return x


def _root(x: Any) -> Any:
    return iv.sqrt(_positive(x))


def _log(x: Any) -> Any:
    return iv.log(_positive(x))


_SCALAR: dict[str, Callable[[Any], Any]] = {
    "sqrt": _root, "sin": iv.sin, "cos": iv.cos, "tan": lambda x: _over(iv.sin(x), iv.cos(x)), "exp": iv.exp,
    "log": _log, "sinh": lambda x: (iv.exp(x) - iv.exp(-x)) / 2, "cosh": lambda x: (iv.exp(x) + iv.exp(-x)) / 2,
    "tanh": lambda x: 1 - 2 / (iv.exp(2 * x) + 1), "atan": lambda x: iv.atan2(x, iv.mpf(1)),
}  # fmt: skip


def _over(above: Any, below: Any) -> Any:
    if not isinstance(below, int) and 0 in below:
        raise ZeroDivisionError
    if isinstance(above, int) and isinstance(below, int):
        # as a float, 1/3 would not be in the interval of any value computed from it
        return above // below if above % below == 0 else iv.mpf(above) / below
    return above / below


class _Functions(dict[str, Callable[..., Any]]):
    """A map from names to functions; the value of any other name is a function that raises InputError."""

    def __missing__(self, name: str) -> Callable[..., Any]:
        return _undefined(name)


@dataclass(frozen=True)
# By Taylor's theorem for each component: the first n derivatives of x(h) - S(h) vanish at h = 0, a is taken at a state
# between start and end, b at a size between 0 and h. The box of the start is divided where this makes the bound
# smaller.
#
# If the rates are polynomials, the difference is expanded further: its coefficients of the orders n + 1 to m - 1 are
# exact polynomials in the start, in which equal terms of motion and method cancel; only the remainder of order m is
# bounded by intervals.
#
# A Taylor step has order n by construction, and b = 0. For a Runge-Kutta method, the order conditions of all rooted
# trees with up to n nodes are checked exactly. If the coefficients are rounded decimals, as in dop853, the conditions
# hold up to small defects. The coefficient of h^k of x(h) - S(h) is then a sum over the trees with k nodes: the defect
# of each tree's condition times an elementary differential of the rates. Without the defects, and with absolute values
# everywhere, this sum is a coefficient of the series Z with Z = h f(start + Z) (the implicit Euler step).
class _Power:
    """A power series in the size of the step, with ``len(terms)`` coefficients: intervals or polynomials."""

    terms: tuple[Any, ...]

    @staticmethod
    def of(value: Any, count: int) -> "_Power":
        return value if isinstance(value, _Power) else _Power((value, *(0,) * (count - 1)))

    @property
    def rates(self) -> list[Any]:
        """The coefficients of the derivative of the series by the size of the step."""
        return [(k + 1) * self.terms[k + 1] for k in range(len(self.terms) - 1)]

    def __add__(self, other: Any) -> "_Power":
        right = _Power.of(other, len(self.terms))
        return _Power(tuple(a + b for a, b in zip(self.terms, right.terms, strict=True)))

    __radd__ = __add__

    def __neg__(self) -> "_Power":
        return _Power(tuple(-a for a in self.terms))

    def __sub__(self, other: Any) -> "_Power":
        return self + -_Power.of(other, len(self.terms))

    def __rsub__(self, other: Any) -> "_Power":
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> "_Power":
        a, b = self.terms, _Power.of(other, len(self.terms)).terms
        return _Power(tuple(_dot(a[: n + 1], b[n::-1]) for n in range(len(a))))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "_Power":
        a, b = self.terms, _Power.of(other, len(self.terms)).terms
        quotient: list[Any] = []
        for n in range(len(a)):
            quotient.append(_over(a[n] - _dot(quotient, b[n:0:-1]), b[0]))
        return _Power(tuple(quotient))

    def __rtruediv__(self, other: Any) -> "_Power":
        return _Power.of(other, len(self.terms)).__truediv__(self)

    def __pow__(self, exponent: int) -> Any:
        result: Any = 1
        for _ in range(abs(exponent)):
            result = self * result
        return result if exponent >= 0 else 1 / result

    def integrated(self, start: Any, slope: "_Power") -> "_Power":
        """Return the series f(x(h)), where this series is x(h).

        ``start`` is f(x(0)), and ``slope`` is the series f'(x(h)).
        """
        # for example, ``slope`` is 1/x if f is the logarithm
        rates = self.rates
        return _Power((start, *(_dot(slope.terms[: n + 1], rates[n::-1]) / (n + 1) for n in range(len(rates)))))


class _Majorant(_Power):
    """A power series whose coefficients are bounds of another series' coefficients, in absolute value.

    So ``a - b`` is computed as ``a + b``, and ``-a`` as ``a``.
    """

    @staticmethod
    def of(value: Any, count: int) -> "_Majorant":
        return value if isinstance(value, _Majorant) else _Majorant((value, *(0,) * (count - 1)))

    def __add__(self, other: Any) -> "_Majorant":
        right = _Majorant.of(other, len(self.terms))
        return _Majorant(tuple(a + b for a, b in zip(self.terms, right.terms, strict=True)))

    __radd__ = __sub__ = __rsub__ = __add__

    def __neg__(self) -> "_Majorant":
        return self

    def __mul__(self, other: Any) -> "_Majorant":
        return _Majorant(_Power.__mul__(self, _Majorant.of(other, len(self.terms))).terms)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "_Majorant":
        divisor = _Majorant.of(other, len(self.terms)).terms[0]  # polynomial rates are divided by numbers only
        return _Majorant(tuple(a / divisor for a in self.terms))


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Return the sum of the products ``a[i]*b[i]``, without those that have the integer 0 as a factor."""
    return sum((x * y for x, y in zip(a, b, strict=True) if not (_is_zero(x) or _is_zero(y))), start=0)


def _is_zero(value: Any) -> bool:
    return isinstance(value, int) and value == 0


def _turning(x: _Power, sign: int, functions: tuple[str, str]) -> tuple[_Power, _Power]:
    """Return the power series (sin x, cos x) if ``sign`` is -1, or (sinh x, cosh x) if ``sign`` is 1.

    ``functions`` has the names of the two functions.
    """
    rates = x.rates
    s, c = ([_SCALAR[name](iv.mpf(x.terms[0]))] for name in functions)
    for n in range(len(rates)):
        # coefficient n + 1 of each follows from the coefficients up to n of the other
        s.append(_dot(c[: n + 1], rates[n::-1]) / (n + 1))
        c.append(sign * _dot(s[: n + 1], rates[n::-1]) / (n + 1))
    return _Power(tuple(s)), _Power(tuple(c))


def _exponential(x: _Power) -> _Power:
    terms, rates = [iv.exp(iv.mpf(x.terms[0]))], x.rates
    for n in range(len(rates)):
        terms.append(_dot(terms[: n + 1], rates[n::-1]) / (n + 1))
    return _Power(tuple(terms))


def _power_root(x: _Power) -> _Power:
    terms = [_root(iv.mpf(x.terms[0]))]
    for n in range(1, len(x.terms)):
        terms.append((x.terms[n] - _dot(terms[1:], terms[:0:-1])) / (2 * terms[0]))
    return _Power(tuple(terms))


_OF_SERIES: dict[str, Callable[[_Power], _Power]] = {
    "sqrt": _power_root,
    "sin": lambda x: _turning(x, -1, ("sin", "cos"))[0],
    "cos": lambda x: _turning(x, -1, ("sin", "cos"))[1],
    "tan": lambda x: truediv(*_turning(x, -1, ("sin", "cos"))),
    "exp": _exponential,
    "log": lambda x: x.integrated(_log(iv.mpf(x.terms[0])), 1 / x),
    "sinh": lambda x: _turning(x, 1, ("sinh", "cosh"))[0],
    "cosh": lambda x: _turning(x, 1, ("sinh", "cosh"))[1],
    "tanh": lambda x: truediv(*_turning(x, 1, ("sinh", "cosh"))),
    "atan": lambda x: x.integrated(_SCALAR["atan"](iv.mpf(x.terms[0])), 1 / (1 + x * x)),
}


def _of_any(name: str) -> Callable[[Any], Any]:
    def function(x: Any) -> Any:
        return _OF_SERIES[name](x) if isinstance(x, _Power) else _SCALAR[name](iv.mpf(x))

    return function


# --- the order of a method --------------------------------------------------------------------------------------------

Tree = tuple[Any, ...]  # a rooted tree: the subtrees of its root, in order


def _trees(size: int) -> list[Tree]:
    """Return all rooted trees with ``size`` nodes; each gives one order condition of a Runge-Kutta method."""
    if size == 1:
        return [()]
    trees: set[Tree] = set()
    for count in range(1, size):
        for sizes in combinations_with_replacement(range(1, size), count):
            if sum(sizes) == size - 1:
                groups: list[tuple[Tree, ...]] = [()]
                for each in sizes:
                    groups = [(*group, tree) for group in groups for tree in _trees(each)]
                trees |= {tuple(sorted(group)) for group in groups}
    return sorted(trees)


def _size(tree: Tree) -> int:
    return 1 + sum(map(_size, tree))


def _density(tree: Tree) -> int:
    return _size(tree) * prod(map(_density, tree))


def _weight(tree: Tree, method: RungeKutta) -> list[Fraction]:
    """Return the elementary weight of a tree (the left side of its order condition) at each stage of a method."""
    inner = [_weight(subtree, method) for subtree in tree]
    return [
        prod((sum((a * weights[j] for j, a in stage.items()), Fraction(0)) for weights in inner), start=Fraction(1))
        for stage in method.stages
    ]


def require_order(method: Method) -> tuple[Fraction, ...]:
    """Raise CertificateError unless a method has its order; return the largest defects of its order conditions.

    Entry k is the largest defect of trees with k + 1 nodes, 0 unless the method's coefficients are rounded decimals.
    Source: Hairer, Norsett, Wanner, Solving ODEs I, 2nd ed., theorem II.2.13.
    """
    method = method.plain if isinstance(method, WithDerivatives) else method
    if isinstance(method, SteadyRotations):
        return ()
    if isinstance(method, TaylorSeries):
        return (Fraction(0),) * method.order
    most = DEFECT if method.rounded else Fraction(0)
    for node, stage in zip(method.nodes, method.stages, strict=True):
        if abs(sum(stage.values(), Fraction(0)) - node) > most:
            raise CertificateError(
                f"{method.name}: expected each node to be the sum of the weights of its stage, got {node}"
            )
    return tuple(max(_defect(tree, method, most) for tree in _trees(size)) for size in range(1, method.order + 1))


def _defect(tree: Tree, method: RungeKutta, most: Fraction) -> Fraction:
    """Return the defect of the order condition of one tree; raise CertificateError if it is larger than ``most``."""
    weights = _weight(tree, method)
    total = sum((b * weights[stage] for stage, b in method.weights.items()), Fraction(0))
    defect = abs(total - Fraction(1, _density(tree)))
    if defect > most:
        got = total if not method.rounded else f"{float(total)!r}, by {float(defect):.1e},"
        raise CertificateError(
            f"{method.name}: expected a method of order {method.order}, got one that violates the order condition "
            f"of a tree with {_size(tree)} nodes: {got} instead of 1/{_density(tree)}"
        )
    return defect


# --- the bound --------------------------------------------------------------------------------------------------------


def truncation_bounds(rates: Program, method: Method, box: Box) -> dict[str, float]:
    """Return, for each state, a bound of the difference between the exact motion and the exact formula of a step.

    Parameters
    ----------
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    method : Method
        The method of the step.
    box : mapping
        Ranges of t, dt, the states and the parameters, by name.

    Raises
    ------
    InputError
        If the steps are so large, or the box so wide, that no bound is found, or if the rates contain a function
        whose intervals symrot cannot compute.
    CertificateError
        If the method does not have its order.
    """
    if isinstance(method, SteadyRotations):  # the certificate proves that the formula is the motion
        return {name: 0.0 for name, *_ in rates.signature.argument("y").components}
    defects = require_order(method)
    if any(defects):
        _require_polynomial(rates)
    states = [name for name, *_ in rates.signature.argument("y").components]
    problem = replace(_problem(rates, method, states, box), defects=defects)
    with _precision():
        parts = [(problem.bounds(box), dict(box))]
        divided = not problem.leading or inf in parts[0][0]  # exact polynomials gain little from smaller parts
        gains = _gains(problem, box, parts[0][0]) if divided else {}
        while gains and len(parts) < PIECES:
            worst = max(parts, key=lambda part: max(part[0]))
            width = {name: (worst[1][name][1] - worst[1][name][0]) / (box[name][1] - box[name][0]) for name in gains}
            name = max(gains, key=lambda each: gains[each] * width[each])
            halves = [(problem.bounds(half), half) for half in _halves(worst[1], name)]
            if max(max(bounds) for bounds, _ in halves) >= max(worst[0]) < inf:
                break
            parts.remove(worst)
            parts += halves
        most = [max(bounds[i] for bounds, _ in parts) for i in range(len(states))]
    if inf in most:
        raise InputError(
            f"{rates.signature.name}: expected steps so short that their truncation errors have a bound on the whole "
            f"box, got sizes dt up to {float(max(map(abs, box[SIZE]))):g} s; take {problem.advice(box)}"
        )
    return dict(zip(states, most, strict=True))


def _halves(box: Box, name: str) -> Iterator[dict[str, tuple[Fraction, Fraction]]]:
    low, high = box[name]
    middle = (low + high) / 2
    for ends in ((low, middle), (middle, high)):
        yield dict(box) | {name: ends}


def _gains(problem: "_Problem", box: Box, whole: list[float]) -> dict[str, float]:
    """Return a map: input -> fraction by which the largest bound decreases if the input's range is halved.

    ``whole`` are the bounds on the whole box; inputs without a gain are left out.
    """
    gains = {}
    for name, (low, high) in box.items():
        if low < high:
            halves = max(max(problem.bounds(half)) for half in _halves(box, name))
            if halves < max(whole):
                gains[name] = 1.0 if max(whole) == inf else 1 - halves / max(whole)
    return gains


_Truncated = RungeKutta | TaylorSeries | WithDerivatives
Terms = list[tuple[Fraction, tuple[tuple[str, int], ...]]]  # of a polynomial: coefficient, exponents of its variables


def _problem(rates: Program, method: _Truncated, states: Sequence[str], box: Box) -> "_Problem":
    """Return the data from which bounds of a step's truncation on boxes are computed."""
    # polynomial rates are expanded once, which makes their bounds tighter
    orders = range(method.order + 1, min(method.order + 1 + EXACT_ORDERS, HIGHEST))
    formulas = [node for _, node in (*rates.temporaries, *rates.outputs)]
    if not orders or not all(map(_is_polynomial, formulas)):
        return _Problem(rates, method, states, ())
    names = [*states, *(name for name, (low, high) in box.items() if name not in (*states, SIZE) and low < high), "t"]
    names = list(dict.fromkeys(names))

    def number(value: Fraction) -> PackedPolynomial:
        return PackedPolynomial.constant(names, value)

    zero = number(Fraction(0))
    values = {name: number(low) for name, (low, _) in box.items()}
    values |= dict(zip(names, variables(names), strict=True))
    expanded = {name: each.terms() for name, each in rates.evaluate(values, {}, number).items()}
    bare = Program(rates.signature, (), tuple((name, _sum_of(terms)) for name, terms in expanded.items()))
    count = orders[-1] + 1
    for order in range(1, count):  # the polynomials grow with the order, so that too long ones are noticed early
        exact = coefficients(recurrences(bare), order, values, {}, number)
        if max(len(zero + state[order]) for state in exact) > MOST_TERMS:
            return _Problem(bare, method, states, ())
    size = _Power((0, number(Fraction(1)), *(0,) * (count - 2)))
    start = {name: _Power.of(value, count) for name, value in values.items() if name != SIZE}
    after = stepped(bare, method, start, size, {}, lambda value: _Power.of(number(value), count))
    own = [_Power.of(each, count).terms for each in after]
    leading = tuple(
        [(zero + mine[order] - step[order]).terms() for mine, step in zip(exact, own, strict=True)] for order in orders
    )
    return _Problem(bare, method, states, leading)


def _require_polynomial(rates: Program) -> None:
    """Raise InputError unless the rates are polynomials in the states that do not contain the time."""
    # only then can the effect of a method's rounded coefficients be bounded
    formulas = [node for _, node in (*rates.temporaries, *rates.outputs)]
    if not all(map(_is_polynomial, formulas)) or any("t" in names(node) for node in formulas):
        raise InputError(
            f"{rates.signature.name}: expected rates that are polynomials in the states, without the time, for the "
            "truncation error of a step with rounded coefficients; take the step rk4 or taylor"
        )


def _is_polynomial(node: Node) -> bool:
    """Return whether a formula contains no functions, no negative powers, and no divisions except by numbers."""
    if node[0] in ("number", "symbol"):
        return True
    if node[0] == "call" or (node[0] == "/" and node[2][0] != "number"):
        return False
    return _is_polynomial(node[1]) and node[2] >= 0 if node[0] == "**" else all(map(_is_polynomial, node[1:]))


def _sum_of(terms: Terms) -> Node:
    """Return a polynomial, given by its terms, as the syntax tree of a formula."""
    total: Node = ("number", Fraction(0))
    for value, powers in terms:
        term: Node = ("number", value)
        for name in (name for name, power in powers for _ in range(power)):
            term = ("*", term, ("symbol", name))
        total = term if total == ("number", Fraction(0)) else ("+", total, term)
    return total


def _range_of(terms: Terms, values: Mapping[str, Any]) -> Any:
    """Return an interval that contains all values of a polynomial, given by its ``terms``, on a box."""
    total = iv.mpf(0)
    for value, powers in terms:
        term = _number(value)
        for name, power in powers:
            # the interval of an even power contains no negative numbers
            term = term * values[name] ** power
        total = total + term
    return total


@dataclass(frozen=True)
class _Problem:
    """The rates, the method and the states of a step whose truncation is bounded."""

    rates: Program
    method: _Truncated
    states: Sequence[str]
    # first coefficients of the difference between motion and method, for each order and state; none without polynomials
    leading: tuple[list[Terms], ...]
    # of the order conditions, from ``require_order``
    defects: tuple[Fraction, ...] = ()

    def bounds(self, box: Box) -> list[float]:
        """Return a bound of the truncation error for each state, valid for all motions that start in ``box``."""
        values: dict[str, Any] = {name: _interval(*ends) for name, ends in box.items()}
        low, high = box[SIZE]
        span = _interval(min(low, Fraction(0)), max(high, Fraction(0)))  # all times from the start to the end
        size = _number(max(abs(low), abs(high)))
        first = self.method.order + 1
        last = first + len(self.leading)
        try:
            during = self._enclosure(values, span)
            # no ranges are known that the motions do not leave during the step
            if during is None:
                return [inf] * len(self.states)
            exact = coefficients(recurrences(self.rates), last, during, _Functions(_SCALAR), _number)
            ends = self._step_coefficients(values, span, last)
            errors = [abs(mine[last] - own) * size**last for mine, own in zip(exact, ends, strict=True)]
            for order, polynomials in enumerate(self.leading, start=first):
                for i, terms in enumerate(polynomials):
                    errors[i] = errors[i] + abs(_range_of(terms, values)) * size**order
            if any(self.defects):
                errors = [error + more for error, more in zip(errors, self._defective(values, size), strict=True)]
            return [_upper(error) for error in errors]
        except ZeroDivisionError:
            return [inf] * len(self.states)

    def advice(self, box: Box) -> str:
        """Return which steps to take if those of a box have no bounds: the first half, quarter .. of dt that has."""
        size = max(map(abs, box[SIZE]))
        for _ in range(HALVINGS):
            size /= 2
            short = Fraction(Context(prec=2, rounding=ROUND_DOWN).create_decimal_from_float(float(size)))
            ends = (max(box[SIZE][0], -short), min(box[SIZE][1], short))
            with _precision():
                if ends[0] <= ends[1] and inf not in self.bounds(dict(box) | {SIZE: ends}):
                    return f"dt up to {float(short):g} s, or a smaller box"
        return "smaller dt or a smaller box"

    def _defective(self, values: Mapping[str, Any], size: Any) -> list[Any]:
        """Return, for each state, a bound of the error that the defects of the method cause."""
        # valid for all states in the box ``values`` and all sizes up to ``size``
        count = len(self.defects) + 1
        largest = {name: _Majorant.of(iv.mpf(abs(value).b), count) for name, value in values.items()}
        series = [_Majorant.of(0, count) for _ in self.states]
        for _ in self.defects:  # each repetition of Z = h f(start + Z) gives one more coefficient
            moved = {name: largest[name] + each for name, each in zip(self.states, series, strict=True)}
            rates = self.rates.evaluate(
                largest | moved, {}, lambda value: _Majorant.of(_number(abs(value)), count)
            ).values()
            series = [_Majorant((0, *_Majorant.of(rate, count).terms[:-1])) for rate in rates]
        return [
            sum(
                (_number(defect) * each.terms[k] * size**k for k, defect in enumerate(self.defects, start=1)), iv.mpf(0)
            )
            for each in series
        ]

    def _enclosure(self, values: Mapping[str, Any], span: Any) -> dict[str, Any] | None:
        """Return ranges that contain all motions from ``values`` at the times ``span``; None if none are found."""
        around = dict(values) | {"t": values["t"] + span}
        for _ in range(ATTEMPTS):
            slopes = self.rates.evaluate(around, _Functions(_SCALAR), _number).values()
            image = {name: values[name] + span * slope for name, slope in zip(self.states, slopes, strict=True)}
            # start + span f(ranges) lies in the ranges, so every motion stays inside them (Picard and Lindelof)
            if all(image[name] in around[name] for name in self.states):
                return dict(around) | image
            # ranges that already contain their image would grow without need, and the images of others with them
            for name in (name for name in self.states if image[name] not in around[name]):
                low, high = min(image[name].a, around[name].a), max(image[name].b, around[name].b)
                spare = (high - low) * _number(GROWTH)
                around[name] = iv.mpf([(low - spare).a, (high + spare).b])
        return None

    def _step_coefficients(self, values: Mapping[str, Any], span: Any, order: int) -> list[Any]:
        """Return, for each state, an interval with the coefficient of h^``order`` in the Taylor series of the step.

        ``values`` and ``span`` are the ranges of the inputs and of h.
        """
        # the coefficients of a Taylor method above its own order are zero
        if isinstance(self.method, TaylorSeries):
            return [0] * len(self.states)
        count = order + 1
        size = _Power((span, iv.mpf(1), *(0,) * (count - 2)))
        start = {name: _Power.of(value, count) for name, value in values.items() if name != SIZE}
        functions = _Functions({name: _of_any(name) for name in _OF_SERIES})
        after = stepped(
            self.rates, self.method, start, size, functions, lambda value: _Power.of(_number(value), count)
        )  # fmt: skip
        return [_Power.of(each, count).terms[count - 1] for each in after]


def _upper(value: Any) -> float:
    """Return a float that is not less than any number in an interval of nonnegative numbers."""
    near = float(value.b)
    return near if iv.mpf(near) >= value.b else nextafter(near, inf)
