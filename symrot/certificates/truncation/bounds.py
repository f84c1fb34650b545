"""Bounds of the truncation error of one time step on a box of states and step sizes, in interval arithmetic.

The exact motion and a step of order n and size h differ by h^(n+1) (a - b), where a and b are coefficients of Taylor
series, of the motion and of the step. Intervals contain both, on a box that no motion leaves during the step.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_DOWN, Context
from fractions import Fraction
from math import inf
from typing import Any

from mpmath import iv

from symrot.certificates.truncation.intervals import FUNCTIONS, Functions, interval, number, precision, range_of, upper
from symrot.certificates.truncation.leading import Terms, is_polynomial, leading_terms
from symrot.certificates.truncation.order import require_order
from symrot.certificates.truncation.series import SERIES_FUNCTIONS, Majorant, PowerSeries, of_number_or_series
from symrot.codegen.steps import SIZE, Method, RungeKutta, SteadyRotations, TaylorSeries, WithDerivatives, stepped
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.tree import names

__all__ = ["PIECES", "truncation_bounds"]

PIECES = 24
"""The largest number of sub-boxes into which a box of states and step sizes is divided."""

GROWTH = Fraction(1, 8)  # by which the box around a motion grows in each attempt, relative to its width
ATTEMPTS = 24
HALVINGS = 12  # of sizes that have no bound, for the advice which sizes have one

Box = Mapping[str, tuple[Fraction, Fraction]]  # name of an input, such as "omega_1" or "dt" -> least and largest value


# By Taylor's theorem for each component: the first n derivatives of x(h) - S(h), the difference of motion and step,
# vanish at h = 0. In the remainder, a is taken at a state between start and end, and b at a size between 0 and h. The
# box of the start is divided where this makes the bound smaller.
#
# If the rates are polynomials, the difference is expanded further: its coefficients of the orders n + 1 to m - 1 are
# exact polynomials in the start, in which equal terms of motion and method cancel; only the remainder of order m is
# bounded by intervals.
#
# A Taylor step has order n by construction, and b = 0. If the coefficients of a Runge-Kutta method are rounded
# decimals, as in dop853, its order conditions hold up to small defects. The coefficient of h^k of x(h) - S(h) is then a
# sum over the trees with k nodes: the defect of each tree's condition times an elementary differential of the rates.
# Without the defects, and with absolute values everywhere, this sum is a coefficient of the series Z with
# Z = h f(start + Z) (the implicit Euler step).
def truncation_bounds(rates: Program, method: Method, box: Box) -> dict[str, float]:
    """Return, for each state, a bound of the difference between the motion and a step computed without rounding.

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
        If the steps are so large, or the box so wide, that no bound is found, if the rates contain a function whose
        intervals symrot cannot compute, or if they are no polynomials and the method has rounded coefficients.
    CertificateError
        If the method does not have the order ``method.order``.
    """
    if isinstance(method, SteadyRotations):  # the certificate proves that the formula is the motion
        return {name: 0.0 for name, *_ in rates.signature.argument("y").components}
    defects = require_order(method)
    if any(defects):
        _require_polynomial(rates)
    states = [name for name, *_ in rates.signature.argument("y").components]
    expanded, leading = leading_terms(rates, method, states, box)
    problem = _Problem(expanded, method, states, leading, defects)
    with precision():
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


def _require_polynomial(rates: Program) -> None:
    """Raise InputError unless the rates are polynomials in the states that do not contain the time."""
    # only then can the effect of a method's rounded coefficients be bounded
    if not is_polynomial(rates) or any("t" in names(node) for _, node in (*rates.temporaries, *rates.outputs)):
        raise InputError(
            f"{rates.signature.name}: expected rates that are polynomials in the states, without the time: for other "
            "rates symrot cannot bound the truncation error of a step whose coefficients are rounded; take the step "
            "rk4 or taylor"
        )


@dataclass(frozen=True)
class _Problem:
    """A step whose truncation error is bounded on boxes: its rates, its method and the names of its states."""

    rates: Program
    method: RungeKutta | TaylorSeries | WithDerivatives
    states: Sequence[str]
    # first coefficients of the difference between motion and method, for each order and state; none without polynomials
    leading: tuple[list[Terms], ...]
    # largest defects of the order conditions, from ``require_order``
    defects: tuple[Fraction, ...]

    def bounds(self, box: Box) -> list[float]:
        """Return a bound of the truncation error for each state, valid for all motions that start in ``box``.

        The bounds are infinite if none are found.
        """
        values: dict[str, Any] = {name: interval(*ends) for name, ends in box.items()}
        low, high = box[SIZE]
        span = interval(min(low, Fraction(0)), max(high, Fraction(0)))  # all times from the start to the end
        size = number(max(abs(low), abs(high)))
        first = self.method.order + 1
        last = first + len(self.leading)
        try:
            during = self._enclosure(values, span)
            # no ranges are known that the motions do not leave during the step
            if during is None:
                return [inf] * len(self.states)
            exact = coefficients(recurrences(self.rates), last, during, Functions(FUNCTIONS), number)
            ends = self._step_coefficients(values, span, last)
            errors = [abs(mine[last] - own) * size**last for mine, own in zip(exact, ends, strict=True)]
            for order, polynomials in enumerate(self.leading, start=first):
                for i, terms in enumerate(polynomials):
                    errors[i] = errors[i] + abs(range_of(terms, values)) * size**order
            if any(self.defects):
                errors = [error + more for error, more in zip(errors, self._defective(values, size), strict=True)]
            return [upper(error) for error in errors]
        except ZeroDivisionError:
            return [inf] * len(self.states)

    def advice(self, box: Box) -> str:
        """Return a phrase that advises a smaller step, such as ``dt up to 0.01 s, or a smaller box``, for a message.

        The advised step is the first of half, a quarter, an eighth .. of dt for which all errors are bounded. If there
        is none, the phrase names no size.
        """
        size = max(map(abs, box[SIZE]))
        for _ in range(HALVINGS):
            size /= 2
            short = Fraction(Context(prec=2, rounding=ROUND_DOWN).create_decimal_from_float(float(size)))
            ends = (max(box[SIZE][0], -short), min(box[SIZE][1], short))
            with precision():
                if ends[0] <= ends[1] and inf not in self.bounds(dict(box) | {SIZE: ends}):
                    return f"dt up to {float(short):g} s, or a smaller box"
        return "smaller dt or a smaller box"

    def _defective(self, values: Mapping[str, Any], size: Any) -> list[Any]:
        """Return, for each state, a bound of the error of a step by a method with rounded coefficients, such as dop853.

        It is the error that the rounding causes: the order conditions hold only up to small amounts, the defects.
        """
        # valid for all states in the box ``values`` and all sizes up to ``size``
        count = len(self.defects) + 1
        largest = {name: Majorant.of(iv.mpf(abs(value).b), count) for name, value in values.items()}
        series = [Majorant.of(0, count) for _ in self.states]
        for _ in self.defects:  # each repetition of Z = h f(start + Z) gives one more coefficient
            moved = {name: largest[name] + each for name, each in zip(self.states, series, strict=True)}
            rates = self.rates.evaluate(
                largest | moved, {}, lambda value: Majorant.of(number(abs(value)), count)
            ).values()
            series = [Majorant((0, *Majorant.of(rate, count).terms[:-1])) for rate in rates]
        return [
            sum((number(defect) * each.terms[k] * size**k for k, defect in enumerate(self.defects, start=1)), iv.mpf(0))
            for each in series
        ]

    def _enclosure(self, values: Mapping[str, Any], span: Any) -> dict[str, Any] | None:
        """Return the ranges ``values`` of all inputs, widened so that they contain all motions during the step.

        ``span`` is the interval of times since the start, 0 included. The result is None if no such ranges are found.
        """
        around = dict(values) | {"t": values["t"] + span}
        for _ in range(ATTEMPTS):
            slopes = self.rates.evaluate(around, Functions(FUNCTIONS), number).values()
            image = {name: values[name] + span * slope for name, slope in zip(self.states, slopes, strict=True)}
            # start + span f(ranges) lies in the ranges, so every motion stays inside them (Picard and Lindelof)
            if all(image[name] in around[name] for name in self.states):
                return dict(around) | image
            # ranges that already contain their image would grow without need, and the images of others with them
            for name in (name for name in self.states if image[name] not in around[name]):
                low, high = min(image[name].a, around[name].a), max(image[name].b, around[name].b)
                spare = (high - low) * number(GROWTH)
                around[name] = iv.mpf([(low - spare).a, (high + spare).b])
        return None

    def _step_coefficients(self, values: Mapping[str, Any], span: Any, order: int) -> list[Any]:
        """Return, for each state, an interval that contains the coefficient of h^``order`` in the series of the step.

        ``values`` and ``span`` are the ranges of the inputs and of h.
        """
        # the coefficients of a Taylor method above its own order are zero
        if isinstance(self.method, TaylorSeries):
            return [0] * len(self.states)
        count = order + 1
        size = PowerSeries((span, iv.mpf(1), *(0,) * (count - 2)))
        start = {name: PowerSeries.of(value, count) for name, value in values.items() if name != SIZE}
        functions = Functions({name: of_number_or_series(name) for name in SERIES_FUNCTIONS})
        after = stepped(
            self.rates, self.method, start, size, functions, lambda value: PowerSeries.of(number(value), count)
        )  # fmt: skip
        return [PowerSeries.of(each, count).terms[count - 1] for each in after]
