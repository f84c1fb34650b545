"""The largest rounding error on a box: halve the worst parts until the bound is near what single points reach.

Best first, in batches: of the parts with the largest bounds, each is halved in the input whose range, shrunk about
its middle, lowers the bound most, and at once in the next best one if that is worth it, or split into the two branches
of a choice that is not decided on it. Parts whose bound is not above what a single point reaches (but for ``GAP``) are
settled. The work is counted in evaluations of boxes, not in time: the same bytes come out everywhere.
"""

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.rounding.adjoint import LIBM_ULP, Evaluation, evaluate
from symrot.certificates.rounding.intervals import Array
from symrot.certificates.rounding.output_graph import Cone
from symrot.certificates.rounding.region import EVERYWHERE, Region, narrowed

__all__ = ["Search", "search"]

GAP = 1.02  # a bound within 2 % of what a point reaches is converged
BATCH = 256  # parts that are halved at once
CHUNK = 2048  # boxes evaluated at once
MOST_CENTRED = 8  # inputs of a polynomial that is searched with mean value forms, if one without is not converged
SECOND = 0.25  # a second input is halved at once if that lowers the bound by this part of what the first does
SHRUNK = 8.0  # a range is shrunk to an eighth to see what halving it again and again would do
NARROWEST = 2.0**-24  # of the width of the box: a part this narrow that has no bound is at a singular point


@dataclass(frozen=True)
class Search:
    """What was found: no error in the box is larger than ``bound``; the method finds ``pointwise`` at ``worst``.

    ``turns``: the error is that modulo whole turns. ``bound`` is infinite where none was found: then ``obstacle`` is
    the node in the way, near ``worst``.
    """

    bound: float
    pointwise: float
    worst: tuple[float, ...]
    largest_value: float
    evaluations: int
    converged: bool
    turns: bool = False
    obstacle: int = -1


@dataclass
class _Parts:
    boxes: Array  # (2, inputs, n)
    decided: NDArray[np.int8]  # (conditions, n)
    bound: Array
    obstacle: NDArray[np.int64]
    undecided: NDArray[np.int64]

    def take(self, chosen: NDArray[np.intp] | NDArray[np.bool_]) -> "_Parts":
        return _Parts(
            self.boxes[:, :, chosen], self.decided[:, chosen], self.bound[chosen], self.obstacle[chosen],
            self.undecided[chosen],
        )  # fmt: skip

    def join(self, other: "_Parts") -> "_Parts":
        return _Parts(
            np.concatenate([self.boxes, other.boxes], axis=2), np.concatenate([self.decided, other.decided], axis=1),
            np.concatenate([self.bound, other.bound]), np.concatenate([self.obstacle, other.obstacle]),
            np.concatenate([self.undecided, other.undecided]),
        )  # fmt: skip


class _Search:
    def __init__(self, cone: Cone, box: Array, region: Region, libm_ulp: float, centred: bool) -> None:
        self.centred = centred
        self.cone, self.box, self.region, self.libm_ulp = cone, box, region, libm_ulp
        self.width = box[1] - box[0]
        places = cone.places
        self.groups = [[places.index(place) for place in group if place in places] for group in region.unit]
        self.groups = [group for group, all_ in zip(self.groups, region.unit, strict=True) if len(group) == len(all_)]
        self.depends = np.array(  # node, input: what has to be narrow for the node to be finite
            [[k in cone.inputs_of[cone.culprit(i)] for k in range(box.shape[1])] for i in range(len(cone.nodes))]
        )
        self.evaluations = 0
        self.pointwise, self.worst = -1.0, tuple(float(x) for x in box.mean(axis=0))
        self.largest_value, self.turns = 0.0, False

    def evaluate(self, boxes: Array, decided: NDArray[np.int8]) -> Evaluation:
        """Evaluate boxes, a chunk at a time."""
        count = boxes.shape[2]
        self.evaluations += count
        found = [
            evaluate(
                self.cone,
                boxes[:, :, k : k + CHUNK],
                decided[:, k : k + CHUNK],
                self.region,
                self.libm_ulp,
                self.centred,
            )
            for k in range(0, count, CHUNK)
        ]
        return Evaluation(*(np.concatenate([getattr(part, name) for part in found]) for name in _FIELDS))

    def parts(self, boxes: Array, decided: NDArray[np.int8]) -> _Parts:
        """Return the parts of the region among boxes, with their bounds."""
        boxes = narrowed(boxes, self.region, self.cone.places)
        found = self.evaluate(boxes, decided)
        inside = found.bound >= 0
        self.turns |= bool((found.turns & np.isfinite(found.bound)).any())
        return _Parts(boxes, decided, found.bound, found.obstacle, found.undecided).take(inside)

    def look_at_points(self, parts: _Parts) -> None:
        """Raise what single points reach by the middles and the outermost corners of parts."""
        low, high = parts.boxes
        outermost = np.where(np.abs(high) >= np.abs(low), high, low)
        points = np.concatenate([(low + high) / 2, outermost], axis=1)
        decided = np.concatenate([parts.decided] * 2, axis=1)
        for group in self.groups:
            length = np.sqrt((points[group] ** 2).sum(axis=0))
            points[group] /= np.where(length > 0, length, 1.0)
            decided = np.full_like(decided, -1)
        found = self.evaluate(np.stack([points, points]), decided)
        reached = np.where(np.isfinite(found.bound), found.bound, -1.0)
        best = int(np.argmax(reached))
        self.largest_value = max(self.largest_value, float(found.value[reached >= 0].max(initial=0.0)))
        if reached[best] > self.pointwise:
            self.pointwise, self.worst = float(reached[best]), tuple(float(x) for x in points[:, best])

    def halves(self, parts: _Parts) -> tuple[Array, NDArray[np.int8]]:
        """Return the halves of parts."""
        choosing = parts.undecided >= 0
        boxes, decided = [], []
        if choosing.any():
            chosen = parts.take(choosing)
            for branch in (0, 1):
                taken = chosen.decided.copy()
                taken[chosen.undecided, np.arange(taken.shape[1])] = branch
                boxes.append(self.cut(chosen, branch))
                decided.append(taken)
        if not choosing.all():
            rest = parts.take(~choosing)
            first, second = self.directions(rest)
            twice = second >= 0
            halved = _halved(rest.boxes, first)
            boxes.append(halved[:, :, np.tile(~twice, 2)])
            decided.append(np.tile(rest.decided[:, ~twice], 2))
            if twice.any():
                boxes.append(_halved(halved[:, :, np.tile(twice, 2)], np.tile(second[twice], 2)))
                decided.append(np.tile(rest.decided[:, twice], 4))
        return np.concatenate(boxes, axis=2), np.concatenate(decided, axis=1)

    def cut(self, parts: _Parts, branch: int) -> Array:
        """Return parts where a branch is taken: halved there, if the condition compares an input with a constant."""
        boxes = parts.boxes.copy()
        for number, (relation, i, j) in enumerate(self.cone.conditions):
            left, right = self.cone.nodes[i], self.cone.nodes[j]
            here = parts.undecided == number
            if left[0] == "in" and right[0] == "const" and relation in _UPPER:
                side = 1 if _UPPER[relation] == (branch == 1) else 0
                clip = np.minimum if side else np.maximum
                boxes[side, left[1], here] = clip(boxes[side, left[1], here], float(right[1]))
        return boxes

    def directions(self, parts: _Parts) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the input in which to halve each part, and that in which to halve the halves, -1 for none."""
        relative = np.where(self.width[:, None] > 0, (parts.boxes[1] - parts.boxes[0]) / self.width[:, None], 0.0)
        widest = np.argmax(relative * np.where(parts.obstacle < 0, True, self.depends[parts.obstacle].T), axis=0)
        second = np.full_like(widest, -1)
        bounded = np.isfinite(parts.bound)  # without a bound there is nothing to lower: halve the widest
        if bounded.any():
            found = self.best(parts.take(bounded), relative[:, bounded], widest[bounded])
            widest[bounded], second[bounded] = found
        return np.asarray(widest), second

    def best(
        self, parts: _Parts, relative: Array, otherwise: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the inputs whose ranges, shrunk about their middle, lower the bound of each part most.

        The second one, or -1, lowers it by more than the part ``SECOND`` of what the first does.
        """
        inputs, count = parts.boxes.shape[1:]
        middle = parts.boxes.mean(axis=0) + (parts.boxes - parts.boxes.mean(axis=0)) / SHRUNK
        shrunk = np.repeat(parts.boxes, inputs, axis=2).reshape(2, inputs, count, inputs)
        for k in range(inputs):
            shrunk[:, k, :, k] = middle[:, k]
        trial = narrowed(shrunk.reshape(2, inputs, -1), self.region, self.cone.places)
        found = self.evaluate(trial, np.repeat(parts.decided, inputs, axis=1))
        bounds = np.where(relative.T > 0, found.bound.reshape(count, inputs), inf)
        bounds = np.maximum(bounds, 0.0)  # -1: the middle is outside of the region
        least = bounds.min(axis=1)
        equal = bounds <= least[:, None] * (1 + 2.0**-30)
        best = np.argmax(np.where(equal, relative.T, -1.0), axis=1)
        gain = parts.bound[:, None] - bounds
        gain[np.arange(count), best] = -1.0
        second = np.argmax(gain, axis=1)
        worth = (gain[np.arange(count), second] > SECOND * (parts.bound - least)) & (least < parts.bound)
        return np.asarray(np.where(least < parts.bound, best, otherwise)), np.where(worth, second, -1)


def _halved(boxes: Array, which: NDArray[np.int64]) -> Array:
    """Return the lower halves of boxes in an input each, then the upper ones."""
    column = np.arange(which.size)
    low, high = boxes.copy(), boxes.copy()
    low[1, which, column] = high[0, which, column] = (boxes[0, which, column] + boxes[1, which, column]) / 2
    return np.concatenate([low, high], axis=2)


_UPPER = {"<": True, "<=": True, ">": False, ">=": False}  # whether the left side is the lesser where it holds
_FIELDS = ("bound", "obstacle", "undecided", "value", "turns")


def search(
    cone: Cone, box: Array, region: Region = EVERYWHERE, budget: int = 100_000, libm_ulp: float = LIBM_ULP,
    target: float | None = None,
) -> Search:  # fmt: skip
    """Return the largest rounding error of an output on a box.

    Parameters
    ----------
    cone : Cone
        The computation of the output.
    box : ndarray, shape (2, inputs)
        Least and largest value of each input.
    region : Region
        What holds in the box beyond its sides.
    budget : int
        Boxes to evaluate, at most, but for the last batch.
    libm_ulp : float
        Largest error of sin, cos and atan2, in units in the last place.
    target : float, optional
        Stop as soon as it is known whether the bound is at most this.
    """
    found = _searched(_Search(cone, box, region, libm_ulp, False), budget, target)
    decided = target is not None and (found.bound <= target or found.pointwise > target)
    if found.converged or decided or not cone.is_polynomial or len(cone.places) > MOST_CENTRED:
        return found
    again = _searched(_Search(cone, box, region, libm_ulp, True), budget, target)
    best = min(found, again, key=lambda each: each.bound)
    reached = max(found, again, key=lambda each: each.pointwise)
    return replace(
        best, pointwise=reached.pointwise, worst=reached.worst if best.bound < inf else best.worst,
        largest_value=max(found.largest_value, again.largest_value),
        evaluations=found.evaluations + again.evaluations, converged=best.bound <= GAP * reached.pointwise,
    )  # fmt: skip


def _searched(run: _Search, budget: int, target: float | None) -> Search:
    """Return what one search finds."""
    cone, box = run.cone, run.box
    conditions = len(cone.conditions)
    parts = run.parts(box[:, :, None].copy(), np.full((conditions, 1), -1, np.int8))
    settled = -1.0
    while parts.bound.size:
        order = np.argsort(-parts.bound, kind="stable")
        batch = parts.take(order[:BATCH])
        if np.isfinite(batch.bound).any():
            run.look_at_points(batch.take(np.isfinite(batch.bound)))
        enough = max(run.pointwise * GAP, settled)
        if target is not None and run.pointwise <= target:
            enough = max(enough, target)
        if parts.bound.max() <= enough or run.evaluations >= budget:
            break
        if target is not None and run.pointwise > target:
            break
        narrow = _narrow(run, batch)
        if narrow.any():
            parts = batch.take(narrow)
            break
        done = parts.bound <= enough
        settled = max(settled, float(parts.bound[done].max(initial=-1.0)))
        working = np.zeros(done.size, bool)
        working[order[:BATCH]] = True
        halves = run.parts(*run.halves(parts.take(working & ~done)))
        parts = parts.take(~done & ~working).join(halves)
    return _result(run, parts, settled)


def _narrow(run: _Search, parts: _Parts) -> NDArray[np.bool_]:
    """Tell which parts have no bound though what is in the way of one is all but a point there."""
    stuck = np.isinf(parts.bound) & (parts.obstacle >= 0) & (parts.undecided < 0)
    return stuck & (_spread(run, parts) < NARROWEST)


def _spread(run: _Search, parts: _Parts) -> Array:
    """Return the relative width of parts in the inputs of what is in the way of a bound."""
    width = np.where(run.width > 0, run.width, 1.0)
    relative = (parts.boxes[1] - parts.boxes[0]) / width[:, None]
    return np.asarray((relative * run.depends[np.maximum(parts.obstacle, 0)].T).max(axis=0, initial=0.0))


def _narrowest(run: _Search, parts: _Parts) -> tuple[tuple[float, ...], int]:
    """Return the middle of the narrowest part without a bound, and what is in the way of one there."""
    first = int(np.argmin(np.where(np.isinf(parts.bound) & (parts.obstacle >= 0), _spread(run, parts), inf)))
    obstacle = int(parts.obstacle[first])
    return tuple(float(x) for x in parts.boxes[:, :, first].mean(axis=0)), run.cone.culprit(obstacle)


def _result(run: _Search, parts: _Parts, settled: float) -> Search:
    bound = max(settled, float(parts.bound.max(initial=-1.0)), 0.0)
    pointwise, worst, obstacle = max(run.pointwise, 0.0), run.worst, -1
    if np.isinf(bound):
        worst, obstacle = _narrowest(run, parts)
    return Search(
        bound, pointwise, worst, run.largest_value, run.evaluations, bound <= GAP * pointwise, run.turns, obstacle
    )
