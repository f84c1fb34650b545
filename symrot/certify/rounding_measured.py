"""Measured rounding errors, to hold the bounds against: the kernel's operations replayed, next to exact values.

Every operation is done twice: rounded, as the kernel does it, and as exactly as can be, along the same branches. The
scan of many points is exact to 64 bits (float kernels: 53); the points with the largest errors are done again with
mpmath at 600 bits, of which cancellations leave far more than 200, and only those count.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import atan2, cos, pi, sin
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symrot.certify.operations import RELATIONS, Operations, operands
from symrot.certify.rounded import meaning
from symrot.certify.rounding import Box, OutputBound
from symrot.certify.rounding_adjoint import EVERYWHERE, UNIT_NORM, Region
from symrot.errors import CertificateError

__all__ = ["Measured", "measure", "points_in", "points_near"]

BITS = 600
CONFIRMED = 12  # points per output that are done again
CHAINS = 64  # climbs per output
LEAST_ROUNDS = 20

_FLOAT = {"binary64": np.float64, "binary32": np.float32}
_WIDE = {"binary64": np.longdouble, "binary32": np.float64}
_CALLS: dict[str, Callable[..., Any]] = {
    "sin": np.frompyfunc(sin, 1, 1), "cos": np.frompyfunc(cos, 1, 1), "atan2": np.frompyfunc(atan2, 2, 1),
}  # fmt: skip
_ROUNDED: dict[str, Callable[..., Any]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "neg": np.negative, "abs": np.abs,
    "sqrt": np.sqrt, "copysign": np.copysign,
}  # fmt: skip
_WIDE_CALLS: dict[str, Callable[..., Any]] = {"sin": np.sin, "cos": np.cos, "atan2": np.arctan2}
_EXACT: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b,
    "neg": lambda a: -a, "abs": abs, "sqrt": mpmath.sqrt, "sin": mpmath.sin, "cos": mpmath.cos, "atan2": mpmath.atan2,
    "copysign": lambda a, b: abs(a) if b >= 0 else -abs(a),
}  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """The largest error seen of an output, and the inputs at which it was seen."""

    output: str
    error: float
    at: tuple[tuple[str, float], ...]
    points: int


def _meant(value: Fraction, precision: str) -> tuple[Fraction, bool]:
    """Return what a constant stands for, and whether times pi; itself where that is not told by the constant."""
    try:
        found = meaning(value, precision)
    except CertificateError:
        return value, False
    return found.fraction, found.times_pi


Points = NDArray[Any]  # (inputs, n)


def _replay(operations: Operations, points: Points) -> tuple[list[Any], list[Any]]:
    """Return the rounded and the nearly exact values of all nodes."""
    kind: Any = _FLOAT[operations.precision]
    wide: Any = _WIDE[operations.precision]
    count = points.shape[1]
    computed: list[Any] = []
    exact: list[Any] = []
    for node in operations.nodes:
        if node[0] == "in":
            value = points[operations.inputs.index(node[1])]
            computed.append(value)
            exact.append(value.astype(wide))
        elif node[0] == "const":
            fraction, times_pi = _meant(node[1], operations.precision)
            meant: Any = wide(fraction.numerator) / wide(fraction.denominator)
            computed.append(np.full(count, kind(float(node[1]))))
            exact.append(np.full(count, meant * np.arctan2(wide(0), wide(-1)) if times_pi else meant))
        elif node[0] == "select":
            holds = RELATIONS[node[1]](computed[node[2]], computed[node[3]])
            computed.append(np.where(holds, computed[node[4]], computed[node[5]]))
            exact.append(np.where(holds, exact[node[4]], exact[node[5]]))
        elif node[0] == "call":
            taken = [computed[i].astype(np.float64) for i in node[2]]
            computed.append(_CALLS[node[1]](*taken).astype(np.float64).astype(kind))
            exact.append(_WIDE_CALLS[node[1]](*(exact[i] for i in node[2])))
        else:
            computed.append(_ROUNDED[node[0]](*(computed[i] for i in operands(node))))
            exact.append(_ROUNDED[node[0]](*(exact[i] for i in operands(node))))
    return computed, exact


def _confirmed(operations: Operations, computed: Sequence[Any], column: int, root: int, point: Any) -> Any:
    """Return the exact value of a node at one point; the series and the formula of a function are the same there."""
    values: dict[int, Any] = {}

    def value(index: int) -> Any:
        if index not in values:
            values[index] = found(operations.nodes[index])
        return values[index]

    def found(node: tuple[Any, ...]) -> Any:
        if node[0] == "in":
            return mpmath.mpf(float(point[operations.inputs.index(node[1])]))
        if node[0] == "const":
            fraction, times_pi = _meant(node[1], operations.precision)
            return mpmath.mpf(fraction.numerator) / fraction.denominator * (mpmath.pi if times_pi else 1)
        if node[0] == "select":
            if node[1] == "<" and value(node[2]) != 0:  # a series: its function is the other branch
                return value(node[5])
            holds = RELATIONS[node[1]](computed[node[2]][column], computed[node[3]][column])
            return value(node[4] if holds else node[5])
        name = node[1] if node[0] == "call" else node[0]
        return _EXACT[name](*(value(i) for i in operands(node)))

    return value(root)


def points_in(
    box: Box, places: Sequence[str], region: Region, count: int, rng: np.random.Generator, kind: Any = np.float64
) -> Points:
    """Return random points of a region: anywhere, near its sides, near its corners."""
    low, high = _ends(box, places)
    part = rng.random((len(places), count))
    ends = rng.random(part.shape) < rng.choice([0.0, 0.5, 0.9], size=count)
    part = np.where(ends, np.round(part) + (0.5 - np.round(part)) * 2.0 ** -rng.integers(4, 50, part.shape), part)
    found, inside = _inside(low + (high - low) * part, box, places, region, kind)
    return np.asarray(found[:, inside])


def points_near(
    points: Points, box: Box, places: Sequence[str], region: Region, rng: np.random.Generator
) -> tuple[Points, NDArray[np.intp]]:
    """Return points of a region, each near one of ``points``, and near which."""
    low, high = _ends(box, places)
    moved = rng.random(points.shape) < 1.5 / len(places)
    step = (high - low) * 10.0 ** rng.uniform(-16.5, -0.5, points.shape) * rng.standard_normal(points.shape) * moved
    found, inside = _inside(np.clip(points.astype(np.float64) + step, low, high), box, places, region, points.dtype)
    return found[:, inside], np.flatnonzero(inside)


def _ends(box: Box, places: Sequence[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return np.array([[float(box[p][0])] for p in places]), np.array([[float(box[p][1])] for p in places])


def _inside(
    found: NDArray[np.float64], box: Box, places: Sequence[str], region: Region, kind: Any
) -> tuple[Points, NDArray[np.bool_]]:
    """Return points rounded to a precision, on the unit spheres of a region, and which are in it."""
    low, high = _ends(box, places)
    for group in region.unit:
        rows = [places.index(place) for place in group]
        length = np.sqrt((found[rows] ** 2).sum(axis=0))
        found[rows] /= np.where(length > 0, length, 1.0)
    rounded = found.astype(kind).astype(np.float64)
    inside: NDArray[np.bool_] = np.asarray(((rounded >= low) & (rounded <= high)).all(axis=0))
    for group in region.unit:
        rows = [places.index(place) for place in group]
        inside = inside & (np.abs((rounded[rows] ** 2).sum(axis=0) - 1) < 0.9 * UNIT_NORM)
    return rounded.astype(kind), inside


def measure(
    operations: Operations, box: Box, bounds: Sequence[OutputBound], region: Region = EVERYWHERE, points: int = 100_000,
    seed: int = 1,
) -> tuple[Measured, ...]:  # fmt: skip
    """Return the largest error found of each output: at random points, near corners, and around the worst of them.

    Parameters
    ----------
    operations, box, region
        As for :func:`symrot.certify.rounding.bound_outputs`.
    bounds : sequence of OutputBound
        What that returned: the search also starts where a bound is largest.
    points : int
        Points per kernel, all outputs together.
    seed : int
        Of the random points.
    """
    rng = np.random.default_rng(seed)
    kind = _FLOAT[operations.precision]
    places = operations.inputs
    if not places:
        return tuple(Measured(each.output, 0.0, (), 0) for each in bounds)
    worst = {each.output: np.full((len(places), 1), np.nan) for each in bounds}
    for each in bounds:
        known = dict(each.at)
        middle = {place: float((box[place][0] + box[place][1]) / 2) for place in places}
        worst[each.output][:, 0] = [known.get(place, middle[place]) for place in places]
    scanned = points_in(box, places, region, points // 2, rng, kind=kind)
    errors, used = _scan(operations, box, region, scanned)
    found = []
    for each in bounds:
        top = _top(errors[each.output])
        start = np.concatenate([scanned[:, top], worst[each.output].astype(kind)], axis=1)
        rounds = max(points // (2 * len(bounds) * CHAINS), LEAST_ROUNDS)
        climbed, number = _climbed(operations, box, region, each.output, start, rounds, rng)
        used += number
        found.append((each, np.concatenate([climbed, scanned[:, top[:CONFIRMED]]], axis=1)))
    return tuple(_confirm(operations, each, best, used) for each, best in found)


def _climbed(
    operations: Operations, box: Box, region: Region, output: str, start: Points, rounds: int, rng: np.random.Generator
) -> tuple[Points, int]:
    """Return points that a climb from each start led to, the largest errors first, and the points looked at.

    A step changes one or two inputs, by anything from their last bit to a third of their range.
    """
    points = start[:, rng.integers(0, start.shape[1], CHAINS)]
    points[:, : start.shape[1]] = start[:, :CHAINS]
    errors = _scan(operations, box, region, points)[0][output]
    used = points.shape[1]
    for _ in range(rounds):
        near, chain = points_near(points, box, operations.inputs, region, rng)
        found = _scan(operations, box, region, near)[0][output]
        used += near.shape[1]
        better = found > errors[chain]
        points[:, chain[better]], errors[chain[better]] = near[:, better], found[better]
    return points[:, _top(errors)[:CONFIRMED]], used


def _top(errors: NDArray[np.float64]) -> NDArray[np.intp]:
    return np.argsort(-errors, kind="stable")[:CHAINS]


def _scan(operations: Operations, box: Box, region: Region, points: Points) -> tuple[dict[str, Any], int]:
    """Return the errors of all outputs at points, -1 where a point is too near to where an angle is not defined."""
    with np.errstate(all="ignore"):
        computed, exact = _replay(operations, points)
        outside = np.zeros(points.shape[1], bool)
        for node in operations.nodes if region.clearance else ():
            if node[0] == "call" and node[1] == "atan2":
                outside |= np.hypot(*(exact[i] for i in node[2])) < region.clearance
        found = {}
        for place, index in operations.outputs:
            error = np.abs(computed[index].astype(exact[index].dtype) - exact[index]).astype(np.float64)
            if region.unit:
                error = np.abs(error - 2 * pi * np.rint(error / (2 * pi)))
            found[place] = np.where(outside | ~np.isfinite(error), -1.0, error)
    return found, points.shape[1]


def _confirm(operations: Operations, each: OutputBound, points: Points, used: int) -> Measured:
    computed, _ = _replay(operations, points)
    root = dict(operations.outputs)[each.output]
    best, at = 0.0, points[:, 0]
    with mpmath.workprec(BITS):
        for column in range(points.shape[1]):
            exact = _confirmed(operations, computed, column, root, points[:, column])
            error = abs(mpmath.mpf(float(computed[root][column])) - exact)
            if each.turns:
                error = abs(error - 2 * mpmath.pi * mpmath.nint(error / (2 * mpmath.pi)))
            if error > best:
                best, at = error, points[:, column]
    shown = tuple((place, float(x)) for place, x in zip(operations.inputs, at, strict=True))
    return Measured(each.output, float(best), shown, used)
