"""Proven upper limits of the step length, so that no step misses a short pulse of a torque formula.

The time and the states vary in discs of the complex plane. There an enclosure bounds by D the change of each rate, the
time derivative of a state. By Cauchy's estimate, D also bounds the Taylor coefficients that the polynomial of a step
omits. The disc of the time has the radius r*h: h is the length of the step, and r is the *reach*. For polynomials of
order N, the error of the state in the step is then at most ``D*h*missed``, with the *missed share*
``missed = r**-N/((N + 1)*(1 - 1/r))``.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from symrot.codegen.enclosure.terms import (
    LOW_ORDER,
    REACHES,
    Enclosure,
    functions_of_time,
    rounded_terms,
    value_operands,
)
from symrot.codegen.taylor.recurrences import Series
from symrot.formula.float_functions import float_value

__all__ = ["Deviations", "Disc", "longest_followed"]

# For SciPy's steppers, and as a reference for tests: the steppers in C use disc.h and enclosure.h instead.
# symrot.codegen.enclosure.terms explains which terms need bounds.

LARGEST_EXPONENT = 700.0  # exponent of e, well within the range of doubles
LEAST_EXPONENT = -745.0  # exponent of e below which exp underflows to zero
UNDERFLOW_UNIT = 1e-323  # above the error of a number that underflows: exp(-746) is 0 as a double, 1e-324 in truth
SHRINK = 0.3  # smallest factor by which a step is multiplied at once
HALF_ULP = 2.0**-53  # relative error of one rounded operation


class Disc(NamedTuple):
    """Disc of all complex numbers within ``radius`` of a real ``centre``; it contains the values of a formula.

    ``log_size`` is an upper bound of the logarithms of the absolute values of the formula; None stands for the
    logarithm of ``abs(centre) + radius``. It is needed where these numbers overflow or underflow.
    """

    centre: float
    radius: float
    log_size: float | None = None


DiscTuple = tuple[float, float, float | None]
"""The fields (centre, radius, log_size) of a :class:`Disc` as a plain tuple, which Python creates ten times as fast."""


def _product(a: DiscTuple, b: DiscTuple) -> DiscTuple:
    (x, u, log_x), (y, v, log_y) = a, b
    centre, radius = x * y, _or_infinite(abs(x) * v + abs(y) * u + u * v)
    if log_x is None and log_y is None:
        return centre, radius, None
    size = _or_infinite(_log_size(*a) + _log_size(*b))
    if radius < math.inf and centre:
        return centre, radius, size
    return 0.0, min(radius, _exp_of(size)) + UNDERFLOW_UNIT, size


def _or_infinite(bound: float) -> float:
    """Return the bound, or infinity if the bound is NaN, which 0 times an infinite bound gives."""
    # infinity is always correct as an upper bound
    return math.inf if math.isnan(bound) else bound


def _log_size(centre: float, radius: float, log_size: float | None) -> float:
    size = _or_infinite(abs(centre) + radius)
    return log_size if log_size is not None else math.log(size) if size > 0.0 else LEAST_EXPONENT


def _exp_of(x: float) -> float:
    return math.exp(x) if x < LARGEST_EXPONENT else math.inf


def _sinh_of(x: float) -> float:
    return math.sinh(x) if abs(x) < LARGEST_EXPONENT else math.copysign(math.inf, x)


def _inverse(a: DiscTuple) -> DiscTuple:
    centre, radius, _ = a
    size = abs(centre)
    if not size > radius:
        return 0.0, math.inf, None
    inner, outer = 1.0 / (size - radius), 1.0 / (size + radius)  # their product may underflow
    return centre * inner * outer, radius * inner * outer, None


def _sqrt(a: Disc, root_factor: float) -> Disc:
    """Return a disc that contains the square roots of all numbers in the disc ``a``.

    If the disc ``a`` contains zero, the root has no Taylor series there, and the polynomial of a step may miss the
    whole change of the root, not only the missed share. The radius is then multiplied by ``root_factor``, which is 1
    divided by the missed share. The caller multiplies every radius by the missed share, so that the change of the root
    counts in full.
    """
    root = math.sqrt(max(a.centre, 0.0))
    if a.centre > a.radius:
        return Disc(root, a.radius / (root + math.sqrt(a.centre - a.radius)))
    return Disc(root, root_factor * (root + math.sqrt(abs(a.centre) + a.radius)))


def _exp(a: Disc) -> Disc:
    value, size = math.exp(a.centre), a.centre + a.radius
    radius = value * math.expm1(a.radius) if a.radius < 1.0 else _exp_of(size) - value
    return Disc(value, radius + UNDERFLOW_UNIT, size)


def _log(a: Disc) -> Disc:
    if a.centre > a.radius:
        return Disc(math.log(a.centre), -math.log1p(-a.radius / a.centre))
    return Disc(0.0, math.inf)


def _wave(
    value: Callable[[float], float], slope: Callable[[float], float], grows: bool = False
) -> Callable[[Disc], Disc]:
    def rule(a: Disc) -> Disc:
        own, half = value(a.centre), _sinh_of(0.5 * a.radius)
        size = a.radius + abs(a.centre) * grows
        return Disc(own, abs(slope(a.centre)) * _sinh_of(a.radius) + 2.0 * abs(own) * half * half, size)

    return rule


def _sech(a: Disc) -> Disc:
    exponent = min(a.radius - abs(a.centre), 1.0)
    far = math.exp(exponent)
    bound, size = math.inf, math.inf
    if far < 1.0:
        bound, size = 2.0 * far / (1.0 - far * far), exponent + math.log(2.0 / (1.0 - far * far))
    if abs(a.centre) + a.radius > 350.0:
        return Disc(0.0, bound, size)
    near = Disc(*_inverse(FUNCTIONS["cosh"](a)))
    return near if near.radius <= bound else Disc(0.0, bound, size)


def _tan(a: Disc) -> Disc:
    value = math.tan(a.centre)
    most = math.tan(a.radius) if a.radius < 1.5 else math.inf
    rest = 1.0 - abs(value) * most
    return Disc(value, (1.0 + value * value) * most / rest if rest > 0.0 else math.inf)


def _tanh(a: Disc) -> Disc:
    value, tail = math.tanh(a.centre), math.exp(-2.0 * abs(a.centre))
    most = math.tan(a.radius) if a.radius < 1.5 else math.inf
    rest = 1.0 - abs(value) * most
    near = 4.0 * tail / (1.0 + tail) ** 2 * most / rest if rest > 0.0 else math.inf
    beyond = math.exp(-2.0 * (abs(a.centre) - a.radius))
    far = 2.0 * beyond / (1.0 - beyond) if beyond < 1.0 else math.inf
    return Disc(value, near) if near <= far else Disc(math.copysign(1.0, a.centre), far)


def _arc(value: Callable[[float], float]) -> Callable[[Disc], Disc]:
    def rule(a: Disc) -> Disc:
        low, high = abs(a.centre), abs(a.centre) + a.radius
        return Disc(value(a.centre), math.asin(high) - math.asin(low) if high < 1.0 else math.inf)

    return rule


def _atan(a: Disc) -> Disc:
    rest = 1.0 + a.centre * a.centre - abs(a.centre) * a.radius
    return Disc(math.atan(a.centre), math.atanh(a.radius / rest) if a.radius < rest else math.inf)


def _atan2(y: Disc, x: Disc) -> Disc:
    size, off = math.hypot(x.centre, y.centre), x.radius + y.radius
    return Disc(math.atan2(y.centre, x.centre), -math.log1p(-off / size) if off < size else math.inf)


FUNCTIONS: dict[str, Callable[..., Disc]] = {
    "sqrt": _sqrt, "exp": _exp, "log": _log, "tan": _tan, "tanh": _tanh, "atan": _atan, "atan2": _atan2,
    "sin": _wave(math.sin, math.cos), "cos": _wave(math.cos, math.sin),
    "sinh": _wave(math.sinh, math.cosh, True), "cosh": _wave(math.cosh, math.sinh, True),
    "asin": _arc(math.asin), "acos": _arc(math.acos), "sech": _sech,
}  # fmt: skip


class Deviations:
    """Function that bounds how far rates may change while time and states vary in complex discs around their values.

    Parameters
    ----------
    enclosure : Enclosure
        The terms of the rates that need bounds, with the rules by which they are evaluated over discs.
    parameters : mapping of str to number
        Values of the parameters of the rates, by name.
    rounded : bool
        Whether the bounds include the rounding errors of formulas that contain the time (:meth:`rounding_errors`).
    """

    # complex, because such a bound also limits the coefficients of a Taylor series
    def __init__(self, enclosure: Enclosure, parameters: Mapping[str, float], rounded: bool = False) -> None:
        self.likely = 0  # index of the reach (radius in time) that proved the last step
        self.spent = 0  # evaluations so far
        self._linear = functions_of_time(enclosure) if rounded else {}
        terms = None if rounded else rounded_terms(enclosure)
        self._rounding = None if terms is None else Deviations(terms, parameters, rounded=True)
        self._rules = [
            (i, each, value_operands(each), [0.0 if w is None else float_value(w, parameters) for w in each.weights])
            for i, each in ((i, enclosure.system.series[i]) for i in enclosure.series)
        ]
        self._terms = [[(abs(float_value(w, parameters)), operand) for w, operand in own] for own in enclosure.terms]

    def __call__(
        self, t: float, radius: float, root_factor: float, y: Sequence[float], radii: Sequence[float]
    ) -> list[float]:
        """Return, for each rate, a bound of its change while time and states vary around ``t`` and ``y``.

        The time varies in a disc of the complex plane around ``t`` with the radius ``radius``, s; state k varies in a
        disc around ``y[k]`` with the radius ``radii[k]``. A bound is infinite if a pole may lie in the discs.

        The caller multiplies the bounds by the missed share, the largest share of a change that the polynomial of a
        step can miss. At zero a square root has no Taylor series, and the polynomial may miss its whole change.
        ``root_factor`` is therefore 1 divided by the missed share: the bound of such a root is multiplied by
        ``root_factor`` here, and the two factors cancel.
        """
        self.spent += 1
        try:
            discs = self._discs(t, radius, root_factor, y, radii)
            bounds = [sum(weight * discs[operand][1] for weight, operand in own) for own in self._terms]
        except (OverflowError, ValueError, ZeroDivisionError):
            return [math.inf if own else 0.0 for own in self._terms]
        return [_or_infinite(bound) for bound in bounds]

    def rounding_errors(self, t: float, y: Sequence[float]) -> list[float]:
        """Return bounds of the errors of the rates from the rounding of formulas that contain the time: ``t**2 - 25``.

        The list is empty if the rates contain no such formula. The same bounds in C:
        :func:`symrot.codegen.enclosure.source.rounding_source`.
        """
        return [] if self._rounding is None else self._rounding(t, 0.0, 1.0, y, [0.0] * len(y))

    def _discs(
        self, t: float, radius: float, root_factor: float, y: Sequence[float], radii: Sequence[float]
    ) -> dict[int, DiscTuple]:
        """Return discs of the complex plane, each of which contains all values of one intermediate result of the rates.

        The time varies in a disc around ``t`` with the radius ``radius``, s, and state k in a disc around ``y[k]`` with
        the radius ``radii[k]``. The radius for a square root of numbers near zero is multiplied by ``root_factor``, see
        :meth:`__call__`. The key of a disc is the index of its intermediate result in ``enclosure.system.series``,
        where ``enclosure`` is the argument of the constructor.
        """
        discs: dict[int, DiscTuple] = {}
        for i, series, operands, weights in self._rules:
            rule = series.rule
            if rule == "state":
                discs[i] = y[series.number], radii[series.number], None
            elif rule == "time":
                discs[i] = t, radius, None
            elif rule == "product":
                discs[i] = _product(discs[operands[0]], discs[operands[1]])
            elif rule == "sum":
                centre = spread = 0.0
                for weight, operand in zip(weights, operands, strict=False):
                    x, u, _ = discs[operand]
                    centre += weight * x
                    spread += abs(weight) * u
                discs[i] = centre + weights[-1], spread, None
            elif rule == "quotient":
                inverse = _inverse(discs[operands[-1]])
                discs[i] = _product(discs[operands[0]], inverse) if len(operands) > 1 else inverse
            else:
                own = [Disc(*discs[operand]) for operand in operands]
                if rule == "clock":  # a function of rate*t + offset
                    rate, offset = weights
                    own = [Disc(rate * t + offset, abs(rate) * radius)]
                further = (root_factor,) if series.function == "sqrt" else ()
                discs[i] = FUNCTIONS[series.function](*own, *further)
            if i in self._linear:
                discs[i] = self._rounded(series, self._linear[i], discs[i], [discs[k][0] for k in operands], weights)
        return discs

    @staticmethod
    def _rounded(
        series: Series, linear: bool, disc: DiscTuple, operands: list[float], weights: list[float]
    ) -> DiscTuple:
        """Return a disc around the computed value of a function of the time; it also contains the exact value.

        The function is ``series``; ``linear`` says whether it is the time or a phase ``a*t + b``. ``disc`` is its disc
        without the rounding error of its last operation. ``operands`` are the computed values of its operands. For a
        sum, ``weights`` has their factors and then the constant term.
        """
        centre, radius, log_size = disc
        if linear:  # the time itself, or a phase: its operands have no other errors that count
            return centre, HALF_ULP * abs(centre), None
        size = 0.0
        if series.rule == "sum":
            size = sum(abs(w * x) for w, x in zip(weights, operands, strict=False)) + abs(weights[-1])
        return centre, radius + HALF_ULP * (abs(centre) + size), log_size


def longest_followed(
    deviations: Deviations,
    t: float,
    y: Sequence[float],
    path: Sequence[Sequence[float]],
    h: float,
    allowed: Sequence[float],
    edges: Sequence[int],
    order: int,
) -> float:
    """Return the length of a step, at most h, in which a missed change of the torque causes at most the allowed error.

    The stepper evaluates the torque at some points of the step only, and a short pulse of the torque may lie between
    them. For the returned length, the error from such a pulse is proven to be at most ``allowed``. The result has the
    sign of h. It is h if the proof succeeds for h, otherwise usually close to the longest length for which it succeeds.
    A result of at most 1e-300 s in absolute value means that nothing was proven.

    Parameters
    ----------
    deviations : Deviations
        Bounds of the rates for the parameters of the motion.
    t, h : float
        Start and length of the step, s.
    y : N numbers
        States at t.
    path : N sequences
        For each state, the absolute values of the coefficients 1, 2, .. of its polynomial in (time - t)/h.
    allowed : one number per block
        Largest error that a change of the torque between the evaluated points may cause, for each block of states
        (omega, attitude).
    edges : sequence of int
        Edges of the blocks: block k consists of the states from edge k up to edge k + 1.
    order : int
        Order of the polynomials.
    """
    # the method of enclosure.h: shorten the step until the bound on what its polynomial misses is small
    length, reaches = h, REACHES[order < LOW_ORDER]
    likely = getattr(deviations, "likely", 0)  # the reach that proved the last step most often proves the next one
    in_turn = [likely, *(k for k in range(len(reaches)) if k != likely)]
    while abs(length) > 1e-300:
        least = math.inf
        for k in in_turn:
            excess = _excess(deviations, t, y, path, abs(length), abs(h), reaches[k], allowed, edges, order)
            least = min(least, excess)
            if excess <= 1.0:
                deviations.likely = k
                return length
        length *= min(max(0.9 * least ** (-1.0 / (order + 1)), SHRINK), 0.9)
    return length


def _excess(
    deviations: Deviations, t: float, y: Sequence[float], path: Sequence[Sequence[float]], size: float, unit: float,
    reach: float, allowed: Sequence[float], edges: Sequence[int], order: int,
) -> float:  # fmt: skip
    missed = reach**-order / ((order + 1) * (1.0 - 1.0 / reach))
    part, share = reach * size / unit, size * missed
    radii = []
    for coefficients in path:
        total = 0.0
        for coefficient in reversed(coefficients):
            total = (total + coefficient) * part
        radii.append(total)
    bounds, worst = deviations(t, reach * size, 1.0 / missed, y, radii), 0.0
    for block, (low, high) in enumerate(pairwise(edges)):
        lack = share * max(bounds[low:high], default=0.0)
        worst = max(worst, lack / allowed[block])
        if block + 1 < len(allowed):
            worst = max(worst, size * lack / allowed[block + 1])
    return worst
