"""Proven upper limits of the step length, so that no step misses a short pulse of a torque formula.

An enclosure bounds the change of each rate (time derivative of a state) while the time and the states vary in complex
discs. The same bound limits the Taylor coefficients that a step omits. The disc of the time has the radius *reach*
times the length of the step. The error of a state in the step is at most the product of three numbers: the bound of its
rate, the length of the step, and the *missed share*, a small number that follows from the reach and the order of the
method.
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
    """Disc of complex numbers within ``radius`` of a real ``centre``; it encloses the values of a formula.

    ``log_size``, if present, bounds the logarithm of every absolute value in the disc.
    """

    centre: float
    radius: float
    # useful where the numbers themselves overflow or underflow
    log_size: float | None = None


Parts = tuple[float, float, float | None]
"""A disc as a plain tuple (centre, radius, log_size), which takes a tenth of the time of a :class:`Disc` to make."""


def _product(a: Parts, b: Parts) -> Parts:
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


def _inverse(a: Parts) -> Parts:
    centre, radius, _ = a
    size = abs(centre)
    if not size > radius:
        return 0.0, math.inf, None
    inner, outer = 1.0 / (size - radius), 1.0 / (size + radius)  # their product may underflow
    return centre * inner * outer, radius * inner * outer, None


def _sqrt(a: Disc, whole: float) -> Disc:
    """Return a disc that contains the square roots of all numbers in the disc ``a``.

    A root near zero has no Taylor series, so that the polynomial of a step may miss its whole change. The caller
    multiplies all bounds by the missed share, the part of a change that the polynomial misses at most. ``whole`` is 1
    divided by the missed share. Unless all numbers in ``a`` have a positive real part, the radius is multiplied by
    ``whole``: the two factors cancel, and the bound of the root's change counts in full.
    """
    root = math.sqrt(max(a.centre, 0.0))
    if a.centre > a.radius:
        return Disc(root, a.radius / (root + math.sqrt(a.centre - a.radius)))
    return Disc(root, whole * (root + math.sqrt(abs(a.centre) + a.radius)))


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
        self, t: float, radius: float, whole: float, y: Sequence[float], radii: Sequence[float]
    ) -> list[float]:
        """Return, for each rate, a bound of its change while time and states vary around ``t`` and ``y``.

        Time varies in a complex disc with the radius ``radius``, s, and state k in a disc with the radius ``radii[k]``.
        The caller multiplies all bounds by the missed share, the part of a change that the polynomial of a step misses
        at most. ``whole`` is 1 divided by the missed share: the bound of a square root near zero is multiplied by it,
        so that the two factors cancel. The polynomial may miss the whole change of such a root, because the root has no
        Taylor series at zero. A bound is infinite if a pole may lie in the discs.
        """
        self.spent += 1
        try:
            discs = self._discs(t, radius, whole, y, radii)
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
        self, t: float, radius: float, whole: float, y: Sequence[float], radii: Sequence[float]
    ) -> dict[int, Parts]:
        """Return discs that contain the values of the intermediate results of the rates while time and states vary.

        The arguments are those of :meth:`__call__`. The key of a disc is the index of its intermediate result in
        ``enclosure.system.series``, where ``enclosure`` is the argument of the constructor.
        """
        discs: dict[int, Parts] = {}
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
                further = (whole,) if series.function == "sqrt" else ()
                discs[i] = FUNCTIONS[series.function](*own, *further)
            if i in self._linear:
                discs[i] = self._rounded(series, self._linear[i], discs[i], [discs[k][0] for k in operands], weights)
        return discs

    @staticmethod
    def _rounded(series: Series, linear: bool, disc: Parts, operands: list[float], weights: list[float]) -> Parts:
        """Return a disc around the computed value of a function of the time, large enough for its rounding errors."""
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
    """Return the length of a step, at most h, for which the error from a missed change of the torque is proven small.

    The error is small if it is at most ``allowed``. The result has the sign of h. It is h if the proof succeeds for h,
    otherwise usually close to the longest length for which it succeeds. A result of at most 1e-300 s in absolute value
    means that nothing was proven.

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
        Largest error from missed changes of the torque, for each block of states (omega, attitude).
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
