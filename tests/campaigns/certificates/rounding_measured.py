"""Measured rounding errors, to compare with the bounds: the kernel's operations, replayed beside exact values.

The measured error is the one that is bounded: at points of the same box and region, with choices as computed, and with
sin, cos and atan2 of this machine, whose errors are smaller than a bound allows. An adversary
(:mod:`tests.campaigns.certificates.rounding_adversary`) searches for points in extended precision. The points with the
largest errors are computed again with mpmath at 600 bits, of which cancellations leave far more than 200; only these
results count.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from symrot.certificates.readback.operations import RELATIONS, Operations, operands
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import Box, OutputBound
from symrot.certificates.rounding.output_graph import output_graph
from symrot.certificates.rounding.region import EVERYWHERE, Region
from tests.campaigns.certificates.rounding_adversary import (
    CANDIDATES_PER_STEP,
    RESTARTS,
    Field,
    climb,
    distinct,
    pointwise,
    top,
)
from tests.campaigns.certificates.rounding_replay import Points, behind, meant, replay, scan

__all__ = ["Measured", "measure"]

BITS = 600
CONFIRMED = 12  # points per output that are done again
LEAST_ROUNDS = 20
JUDGED = 2000  # points whose bounds the method says
AIMED = 12  # steps to larger bounds

_EXACT: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b,
    "neg": lambda a: -a, "abs": abs, "sqrt": mpmath.sqrt, "sin": mpmath.sin, "cos": mpmath.cos, "atan2": mpmath.atan2,
    "copysign": lambda a, b: abs(a) if b >= 0 else -abs(a),
}  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """The largest error seen of an output, and the inputs that gave it."""

    output: str
    error: float
    at: tuple[tuple[str, float], ...]
    points: int


def measure(
    operations: Operations, box: Box, bounds: Sequence[OutputBound], region: Region = EVERYWHERE, points: int = 100_000,
    seed: int = 1,
) -> tuple[Measured, ...]:  # fmt: skip
    """Return the largest error found of each output.

    Half of the points are random; climbs start from those with the largest errors, and from where the method finds the
    largest bounds at single points.

    Parameters
    ----------
    operations, box, region
        As for :func:`symrot.certificates.rounding.bounds.bound_outputs`.
    bounds : sequence of OutputBound
        The result of that function: the search also starts where a bound is largest.
    points : int
        Points per kernel, all outputs together.
    seed : int
        The seed of the random points.
    """
    rng = np.random.default_rng(seed)
    places = operations.inputs
    if not places:
        return tuple(Measured(each.output, 0.0, (), 0) for each in bounds)
    field = Field(places, operations.precision, box, region)
    scanned = field.points(points // 2, rng)
    errors = scan(operations, region, scanned)
    rounds = max(points // (2 * len(bounds) * RESTARTS * CANDIDATES_PER_STEP), LEAST_ROUNDS)
    measurements = []
    for each in bounds:
        best = scanned[:, top(errors[each.output])]
        middle = {place: float(sum(box[place]) / 2) for place in places} | dict(each.at)
        worst = np.array([[middle[place]] for place in places]).astype(field.kind)
        coarse = _coarse(operations, field, each.output, np.concatenate([worst, scanned[:, :JUDGED]], axis=1), rng)
        start = distinct([worst, coarse[:, : RESTARTS // 2], best])
        own = behind(operations, each.output)
        climbed = _climbed(own, field, start, rounds, rng)
        every = distinct([climbed[:, :CONFIRMED], best[:, :CONFIRMED]])
        measurements.append(
            _confirm(own, each, every, scanned.shape[1] + (rounds + 1) * RESTARTS * CANDIDATES_PER_STEP)
        )
    return tuple(measurements)


def _coarse(operations: Operations, field: Field, output: str, points: Points, rng: np.random.Generator) -> Points:
    """Return points where the method's bound of an output is large, found by climbs from given points."""
    bounds = pointwise(output_graph(operations, dict(operations.outputs)[output]), field, LIBM_ULP)
    return climb(bounds, field, points[:, top(bounds(points))], AIMED, rng)


def _climbed(own: Operations, field: Field, start: Points, rounds: int, rng: np.random.Generator) -> Points:
    """Return points of large errors of one output of a kernel."""
    ((output, _),) = own.outputs

    def errors(points: Points) -> NDArray[np.float64]:
        return scan(own, field.region, points)[output]

    return climb(errors, field, start, rounds, rng)


def _confirm(operations: Operations, each: OutputBound, points: Points, used: int) -> Measured:
    computed, _ = replay(operations, points)
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
    point = tuple((place, float(x)) for place, x in zip(operations.inputs, at, strict=True))
    return Measured(each.output, float(best), point, used)


def _confirmed(operations: Operations, computed: Sequence[Any], column: int, root: int, point: Any) -> Any:
    """Return the exact value of a node at one point; a function's series and its formula are equal there."""
    values: dict[int, Any] = {}

    def value(index: int) -> Any:
        if index not in values:
            values[index] = found(operations.nodes[index])
        return values[index]

    def found(node: tuple[Any, ...]) -> Any:
        if node[0] == "in":
            return mpmath.mpf(float(point[operations.inputs.index(node[1])]))
        if node[0] == "const":
            fraction, times_pi = meant(node[1], operations.precision)
            return mpmath.mpf(fraction.numerator) / fraction.denominator * (mpmath.pi if times_pi else 1)
        if node[0] == "select":
            if node[1] == "<" and value(node[2]) != 0:  # a series: its function is the other branch
                return value(node[5])
            holds = RELATIONS[node[1]](computed[node[2]][column], computed[node[3]][column])
            return value(node[4] if holds else node[5])
        name = node[1] if node[0] == "call" else node[0]
        return _EXACT[name](*(value(i) for i in operands(node)))

    return value(root)
