"""An adversary: points where a kernel has large rounding errors, by random draws, by the method's own bound, and by
climbs.

An error is large where roundings are coarse and add up with one sign. The bound at single points shows where roundings
are coarse: it jumps where a result exceeds a power of two. So points first climb to where this bound is large, then to
where the roundings agree in sign. A step changes the last bits of one or two inputs, which keeps the roundings of
everything that does not depend on them, or changes these inputs by up to a third of their range.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.rounding.adjoint import evaluate
from symrot.certificates.rounding.intervals import DIGITS
from symrot.certificates.rounding.output_graph import OutputGraph
from symrot.certificates.rounding.region import UNIT_NORM, Region
from tests.campaigns.certificates.rounding_replay import FLOAT, Points

__all__ = ["CANDIDATES_PER_STEP", "RESTARTS", "Field", "climb", "distinct", "pointwise", "top"]

RESTARTS = 64  # climbs at once
CANDIDATES_PER_STEP = 8  # points that are tried near each at once
SHARES = 4  # times that the better half of the climbs takes the place of the worse
LAST_BITS = 0.5  # part of the steps that change last bits only: up to half of all bits
MOVED = 1.5  # inputs that a step changes, on average

Errors = Callable[[Points], NDArray[np.float64]]  # of points, shape (inputs, n); -1 for those that do not count


@dataclass(frozen=True)
class Field:
    """The admissible points of a kernel: numbers of its precision in a box and a region."""

    places: tuple[str, ...]
    precision: str
    box: Mapping[str, tuple[Fraction, Fraction]]
    region: Region

    @cached_property
    def ends(self) -> NDArray[np.float64]:
        """Return the smallest and largest value of each input, shape (2, inputs, 1)."""
        return np.array([[[float(self.box[place][k])] for place in self.places] for k in (0, 1)])

    @property
    def kind(self) -> Any:
        """Return the type of the numbers."""
        return FLOAT[self.precision]

    def points(self, count: int, rng: np.random.Generator) -> Points:
        """Return random points: anywhere, near the boundary of the region, and near its corners."""
        low, high = self.ends
        part = rng.random((len(self.places), count))
        ends = rng.random(part.shape) < rng.choice([0.0, 0.5, 0.9], size=count)
        part = np.where(ends, np.round(part) + (0.5 - np.round(part)) * 2.0 ** -rng.integers(4, 50, part.shape), part)
        points, inside = self.inside(low + (high - low) * part)
        return np.asarray(points[:, inside])

    def near(self, points: Points, rng: np.random.Generator) -> tuple[Points, NDArray[np.bool_]]:
        """Return a point near each given point, and which of these are in the region."""
        low, high = self.ends
        shape = points.shape
        at = points.astype(np.float64)
        sign = rng.choice([-1.0, 1.0], shape)
        bits = np.spacing(np.abs(points)).astype(np.float64)
        bits *= sign * np.floor(2.0 ** rng.uniform(0, DIGITS[self.precision] / 2, shape))
        far = (high - low) * sign * 10.0 ** rng.uniform(-16.5, -0.5, shape)
        step = np.where(rng.random(shape[1]) < LAST_BITS, bits, far)
        return self.inside(np.clip(at + step * (rng.random(shape) < MOVED / len(self.places)), low, high))

    def inside(self, points: NDArray[np.float64]) -> tuple[Points, NDArray[np.bool_]]:
        """Return the points rounded to the precision and moved onto the unit spheres of the region, and which are in
        the region.
        """
        low, high = self.ends
        groups = [[self.places.index(place) for place in group] for group in self.region.unit]
        for rows in groups:
            square = (points[rows] ** 2).sum(axis=0)
            apart = (np.abs(square - 1) > UNIT_NORM / 2) & (square > 0)  # nearer ones keep their last bits
            points[rows] /= np.where(apart, np.sqrt(square), 1.0)
        rounded = points.astype(self.kind).astype(np.float64)
        inside: NDArray[np.bool_] = np.asarray(((rounded >= low) & (rounded <= high)).all(axis=0))
        for rows in groups:
            inside = inside & (np.abs((rounded[rows] ** 2).sum(axis=0) - 1) < 0.9 * UNIT_NORM)
        return rounded.astype(self.kind), inside


def pointwise(graph: OutputGraph, field: Field, libm_ulp: float) -> Errors:
    """Return the bounds that the method computes at single points: where they are large, roundings are coarse."""
    rows = [field.places.index(place) for place in graph.places]

    def bounds(points: Points) -> NDArray[np.float64]:
        at = points[rows].astype(np.float64)
        decided = np.full((len(graph.conditions), at.shape[1]), -1, np.int8)
        with np.errstate(all="ignore"):
            errors = evaluate(graph, np.stack([at, at]), decided, field.region, libm_ulp).bound
        return np.where(np.isfinite(errors), errors, -1.0)

    return bounds


def top(errors: NDArray[np.float64], count: int = RESTARTS) -> NDArray[np.intp]:
    """Return the indices of the largest errors, the largest first."""
    return np.argsort(-errors, kind="stable")[:count]


def climb(errors_of: Errors, field: Field, start: Points, rounds: int, rng: np.random.Generator) -> Points:
    """Return the points to which climbs from each start lead, the largest errors first.

    Parameters
    ----------
    errors_of : callable
        The function that climbs increase.
    field : Field
        The admissible points.
    start : ndarray, shape (inputs, n)
        The first ``RESTARTS`` of them are climbed from; if there are fewer, from some several times.
    rounds : int
        Steps of each climb, the best of ``CANDIDATES_PER_STEP`` tried ones each, if it is better than none.
    rng : numpy.random.Generator
        The generator of the steps.
    """
    points = start[:, np.arange(RESTARTS) % start.shape[1]]
    errors = errors_of(points)
    share = max(rounds // (SHARES + 1), 1)
    for number in range(rounds):
        if number % share == share - 1 and number < SHARES * share:
            order = top(errors)
            points[:, order[RESTARTS // 2 :]] = points[:, order[: RESTARTS // 2]]
            errors[order[RESTARTS // 2 :]] = errors[order[: RESTARTS // 2]]
        near, inside = field.near(np.repeat(points, CANDIDATES_PER_STEP, axis=1), rng)
        trial_errors = np.where(inside, errors_of(near), -1.0).reshape(RESTARTS, CANDIDATES_PER_STEP)
        best = trial_errors.argmax(axis=1)
        better = trial_errors.max(axis=1) > errors
        points[:, better] = near[:, (np.arange(RESTARTS) * CANDIDATES_PER_STEP + best)[better]]
        errors[better] = trial_errors.max(axis=1)[better]
    return np.asarray(points[:, top(errors)])


def distinct(points: Sequence[Points]) -> Points:
    """Return the points of several lists, each once, in order."""
    every = np.concatenate(points, axis=1)
    _, first = np.unique(every, axis=1, return_index=True)
    return np.asarray(every[:, np.sort(first)])
