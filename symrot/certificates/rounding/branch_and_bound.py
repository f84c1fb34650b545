"""Branch and bound for the largest rounding error on a box: split the worst parts until the bound is tight.

A part is a sub-box. It is split into the two branches of a condition, or halved in the input that lowers the bound
most. It is finished when its bound is close to the largest error that was found at a sampled point. Its obstacle is the
operation that prevents a bound, such as a division by a range that contains zero.
"""

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.rounding.adjoint import LIBM_ULP, Evaluation, evaluate
from symrot.certificates.rounding.intervals import Array
from symrot.certificates.rounding.output_graph import OutputGraph
from symrot.certificates.rounding.region import EVERYWHERE, Region, narrowed

__all__ = ["SearchResult", "search"]

GAP = 1.02  # a bound has converged if it is at most 2 % above the error at a point
BATCH = 256  # parts that are split at once
CHUNK = 2048  # boxes that are evaluated at once
MOST_CENTRED = 8  # largest number of inputs of a polynomial that is searched again with mean value forms
SECOND = 0.25  # a second input is halved too if its gain (reduction of the bound) exceeds this part of the first gain
SHRUNK = 8.0  # a range is shrunk to an eighth of its width to estimate the effect of halving it repeatedly
NARROWEST = 2.0**-24  # relative to the box: a part this narrow without a bound is at a singular point


# The budget counts evaluations of boxes, not time, so that the result is the same on every machine.
@dataclass(frozen=True)
class SearchResult:
    """The result of a search for the largest error on a box."""

    # no error on the box exceeds it; infinite if there is no bound
    bound: float
    # the bound at the point ``worst``
    pointwise: float
    worst: tuple[float, ...]
    # largest absolute value of the output at the evaluated points
    largest_value: float
    # number of evaluated boxes
    evaluations: int
    # ``bound`` is at most 2 % above ``pointwise``
    converged: bool
    # errors are measured modulo 2 pi
    turns: bool = False
    # the operation (node) that prevents a bound near the point ``worst``
    obstacle: int = -1


@dataclass
class _Parts:
    """The parts (sub-boxes) of a search, with the branch of each condition on each part, and error bounds."""

    boxes: Array  # (2, inputs, n)
    # branch of each condition: 1 if the relation holds, 0 if not, -1 if both are possible; shape (conditions, n)
    decided: NDArray[np.int8]  # (conditions, n)
    bound: Array
    # the node that prevents a finite bound
    obstacle: NDArray[np.int64]
    # a condition that holds at some points of the part and not at others
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


class _BoundSearch:
    """A search for the largest rounding error on a box: the problem, and the largest error at points sampled so far."""

    def __init__(self, graph: OutputGraph, box: Array, region: Region, libm_ulp: float, centred: bool) -> None:
        self.centred = centred
        self.graph, self.box, self.region, self.libm_ulp = graph, box, region, libm_ulp
        self.width = box[1] - box[0]
        places = graph.places
        self.groups = [[places.index(place) for place in group if place in places] for group in region.unit]
        self.groups = [group for group, all_ in zip(self.groups, region.unit, strict=True) if len(group) == len(all_)]
        self.depends = np.array(  # (node, input): whether the input must be narrow for the node to be finite
            [
                [k in graph.inputs_of[graph.singular_operand(i)] for k in range(box.shape[1])]
                for i in range(len(graph.nodes))
            ]
        )
        self.evaluations = 0
        self.pointwise, self.worst = -1.0, tuple(float(x) for x in box.mean(axis=0))
        self.largest_value, self.turns = 0.0, False

    def evaluate(self, boxes: Array, decided: NDArray[np.int8]) -> Evaluation:
        """Return the error bounds of boxes; ``decided`` is the branch of each condition on each box."""
        count = boxes.shape[2]
        self.evaluations += count
        # CHUNK boxes at a time, to limit memory
        chunks = [
            evaluate(
                self.graph,
                boxes[:, :, k : k + CHUNK],
                decided[:, k : k + CHUNK],
                self.region,
                self.libm_ulp,
                self.centred,
            )
            for k in range(0, count, CHUNK)
        ]
        return Evaluation(*(np.concatenate([getattr(part, name) for part in chunks]) for name in _FIELDS))

    def parts(self, boxes: Array, decided: NDArray[np.int8]) -> _Parts:
        """Return the boxes that may contain allowed inputs, such as unit quaternions, each with its error bound.

        ``decided`` is the branch of each condition on each box.
        """
        # each box is shrunk to the allowed inputs in it
        boxes = narrowed(boxes, self.region, self.graph.places)
        evaluation = self.evaluate(boxes, decided)
        inside = evaluation.bound >= 0
        self.turns |= bool((evaluation.turns & np.isfinite(evaluation.bound)).any())
        return _Parts(boxes, decided, evaluation.bound, evaluation.obstacle, evaluation.undecided).take(inside)

    def look_at_points(self, parts: _Parts) -> None:
        """Evaluate the error at the middle and a corner of each part, and remember the worst point so far."""
        low, high = parts.boxes
        outermost = np.where(np.abs(high) >= np.abs(low), high, low)
        points = np.concatenate([(low + high) / 2, outermost], axis=1)
        decided = np.concatenate([parts.decided] * 2, axis=1)
        for group in self.groups:
            length = np.sqrt((points[group] ** 2).sum(axis=0))
            points[group] /= np.where(length > 0, length, 1.0)
            decided = np.full_like(decided, -1)
        evaluation = self.evaluate(np.stack([points, points]), decided)
        reached = np.where(np.isfinite(evaluation.bound), evaluation.bound, -1.0)
        best = int(np.argmax(reached))
        self.largest_value = max(self.largest_value, float(evaluation.value[reached >= 0].max(initial=0.0)))
        if reached[best] > self.pointwise:
            self.pointwise, self.worst = float(reached[best]), tuple(float(x) for x in points[:, best])

    def halves(self, parts: _Parts) -> tuple[Array, NDArray[np.int8]]:
        """Split each part into two or four boxes; return the boxes, and for each box the branch of each condition.

        Branches are coded as in ``_Parts.decided``. A part with an undecided condition gives one box for each branch.
        """
        choosing = parts.undecided >= 0
        boxes, decided = [], []
        if choosing.any():
            chosen = parts.take(choosing)
            for branch in (0, 1):
                branch_decided = chosen.decided.copy()
                branch_decided[chosen.undecided, np.arange(branch_decided.shape[1])] = branch
                boxes.append(self.cut(chosen, branch))
                decided.append(branch_decided)
        if not choosing.all():
            rest = parts.take(~choosing)
            first, second = self.directions(rest)
            twice = second >= 0
            halved = _halved(rest.boxes, first)
            boxes.append(halved[:, :, np.tile(~twice, 2)])
            decided.append(np.tile(rest.decided[:, ~twice], 2))
            # halved in a second input too: four boxes
            if twice.any():
                boxes.append(_halved(halved[:, :, np.tile(twice, 2)], np.tile(second[twice], 2)))
                decided.append(np.tile(rest.decided[:, twice], 4))
        return np.concatenate(boxes, axis=2), np.concatenate(decided, axis=1)

    def cut(self, parts: _Parts, branch: int) -> Array:
        """Return the boxes of ``parts``, each shrunk to the points at which its undecided condition has one outcome.

        ``branch`` is the outcome: 1 where the condition holds, 0 where it does not. A box is shrunk only if the
        condition compares an input with a constant; otherwise it stays as it is.
        """
        boxes = parts.boxes.copy()
        for number, (relation, i, j) in enumerate(self.graph.conditions):
            left, right = self.graph.nodes[i], self.graph.nodes[j]
            here = parts.undecided == number
            # x < 2 ends the range of x at 2
            if left[0] == "in" and right[0] == "const" and relation in _LEFT_IS_LESSER:
                side = 1 if _LEFT_IS_LESSER[relation] == (branch == 1) else 0
                clip = np.minimum if side else np.maximum
                boxes[side, left[1], here] = clip(boxes[side, left[1], here], float(right[1]))
        return boxes

    def directions(self, parts: _Parts) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return, for each part, the input in which to halve it, and a second input (or -1) in which to halve again."""
        relative = np.where(self.width[:, None] > 0, (parts.boxes[1] - parts.boxes[0]) / self.width[:, None], 0.0)
        widest = np.argmax(relative * np.where(parts.obstacle < 0, True, self.depends[parts.obstacle].T), axis=0)
        second = np.full_like(widest, -1)
        bounded = np.isfinite(parts.bound)  # a part without a bound is halved in its widest input
        if bounded.any():
            widest[bounded], second[bounded] = self.best(parts.take(bounded), relative[:, bounded], widest[bounded])
        return np.asarray(widest), second

    def best(
        self, parts: _Parts, relative: Array, otherwise: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return, for each part of the box, the input whose range to halve best, and the second best input (or -1).

        Halving the range of the best input lowers the bound of the part most; where no input lowers it, the entry of
        ``otherwise`` is the best. ``relative`` has the widths of the ranges, divided by those of the whole box.
        """
        # the best: shrinking its range lowers the bound most
        inputs, count = parts.boxes.shape[1:]
        middle = parts.boxes.mean(axis=0) + (parts.boxes - parts.boxes.mean(axis=0)) / SHRUNK
        shrunk = np.repeat(parts.boxes, inputs, axis=2).reshape(2, inputs, count, inputs)
        for k in range(inputs):
            shrunk[:, k, :, k] = middle[:, k]
        trial = narrowed(shrunk.reshape(2, inputs, -1), self.region, self.graph.places)
        evaluation = self.evaluate(trial, np.repeat(parts.decided, inputs, axis=1))
        bounds = np.where(relative.T > 0, evaluation.bound.reshape(count, inputs), inf)
        bounds = np.maximum(bounds, 0.0)  # -1 means that the shrunk box is outside the region
        least = bounds.min(axis=1)
        equal = bounds <= least[:, None] * (1 + 2.0**-30)
        best = np.argmax(np.where(equal, relative.T, -1.0), axis=1)
        gain = parts.bound[:, None] - bounds
        gain[np.arange(count), best] = -1.0
        # -1 if the gain of the second input is at most SECOND times the first gain
        second = np.argmax(gain, axis=1)
        worth = (gain[np.arange(count), second] > SECOND * (parts.bound - least)) & (least < parts.bound)
        return np.asarray(np.where(least < parts.bound, best, otherwise)), np.where(worth, second, -1)


def _halved(boxes: Array, which: NDArray[np.int64]) -> Array:
    """Return the lower halves of boxes, then their upper halves; box k is halved in the input ``which[k]``."""
    column = np.arange(which.size)
    low, high = boxes.copy(), boxes.copy()
    low[1, which, column] = high[0, which, column] = (boxes[0, which, column] + boxes[1, which, column]) / 2
    return np.concatenate([low, high], axis=2)


_LEFT_IS_LESSER = {"<": True, "<=": True, ">": False, ">=": False}  # relation -> whether left is less than right
_FIELDS = ("bound", "obstacle", "undecided", "value", "turns")


def search(
    graph: OutputGraph, box: Array, region: Region = EVERYWHERE, budget: int = 100_000, libm_ulp: float = LIBM_ULP,
    target: float | None = None,
) -> SearchResult:  # fmt: skip
    """Return a bound of the largest rounding error of an output on a box, computed by repeated splitting of the box.

    Parameters
    ----------
    graph : OutputGraph
        The computation of the output.
    box : ndarray, shape (2, inputs)
        Least and largest value of each input.
    region : Region
        Restrictions of the inputs in the box.
    budget : int
        The number of evaluated boxes after which the search ends. The boxes are evaluated in batches, and the last
        batch may exceed the budget. An output that is a polynomial may be searched a second time, with mean value forms
        (narrower intervals, see centred.py), and the budget then holds for each search.
    libm_ulp : float
        Largest error of sin, cos and atan2, in units in the last place.
    target : float, optional
        Stop as soon as it is known whether the bound is at most this number.
    """
    plain = _run_search(_BoundSearch(graph, box, region, libm_ulp, False), budget, target)
    decided = target is not None and (plain.bound <= target or plain.pointwise > target)
    if plain.converged or decided or not graph.is_polynomial or len(graph.places) > MOST_CENTRED:
        return plain
    centred = _run_search(_BoundSearch(graph, box, region, libm_ulp, True), budget, target)
    best = min(plain, centred, key=lambda each: each.bound)
    reached = max(plain, centred, key=lambda each: each.pointwise)
    return replace(
        best, pointwise=reached.pointwise, worst=reached.worst if best.bound < inf else best.worst,
        largest_value=max(plain.largest_value, centred.largest_value),
        evaluations=plain.evaluations + centred.evaluations, converged=best.bound <= GAP * reached.pointwise,
    )  # fmt: skip


def _run_search(run: _BoundSearch, budget: int, target: float | None) -> SearchResult:
    """Return the result of a search that ends when the bound is tight, or after ``budget`` evaluations.

    Two more events end the search: a part is almost as small as a point and still has no bound; or it is known whether
    the largest error exceeds ``target``, if that is not None.
    """
    graph, box = run.graph, run.box
    conditions = len(graph.conditions)
    parts = run.parts(box[:, :, None].copy(), np.full((conditions, 1), -1, np.int8))
    settled = -1.0
    while parts.bound.size:
        order = np.argsort(-parts.bound, kind="stable")
        batch = parts.take(order[:BATCH])
        if np.isfinite(batch.bound).any():
            run.look_at_points(batch.take(np.isfinite(batch.bound)))
        # at most 2 % above the error at the worst point
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


def _narrow(run: _BoundSearch, parts: _Parts) -> NDArray[np.bool_]:
    """Return a Boolean array: whether each part has no error bound although it is almost as small as a point."""
    stuck = np.isinf(parts.bound) & (parts.obstacle >= 0) & (parts.undecided < 0)
    return stuck & (_spread(run, parts) < NARROWEST)


def _spread(run: _BoundSearch, parts: _Parts) -> Array:
    """Return, for each part, its largest width in a few inputs, relative to the width of the whole box.

    Only those inputs count on which the divisor or radicand of the part's obstacle depends. The obstacle is the
    operation that prevents an error bound on the part; a bound exists only where these inputs have narrow ranges.
    """
    width = np.where(run.width > 0, run.width, 1.0)
    relative = (parts.boxes[1] - parts.boxes[0]) / width[:, None]
    return np.asarray((relative * run.depends[np.maximum(parts.obstacle, 0)].T).max(axis=0, initial=0.0))


def _narrowest(run: _BoundSearch, parts: _Parts) -> tuple[tuple[float, ...], int]:
    """Return the middle of the narrowest part without an error bound, and the node that prevents the bound there."""
    first = int(np.argmin(np.where(np.isinf(parts.bound) & (parts.obstacle >= 0), _spread(run, parts), inf)))
    obstacle = int(parts.obstacle[first])
    # the node is the divisor or radicand, or else the function value
    return tuple(float(x) for x in parts.boxes[:, :, first].mean(axis=0)), run.graph.singular_operand(obstacle)


def _result(run: _BoundSearch, parts: _Parts, settled: float) -> SearchResult:
    """Return the result of a search that ends with ``parts``, the sub-boxes whose bounds splitting may still lower.

    ``settled`` is the largest bound of the finished sub-boxes, which are not in ``parts``. They were not split again,
    because their bounds were close to the error at a sampled point, or at most the target of the search.
    """
    bound = max(settled, float(parts.bound.max(initial=-1.0)), 0.0)
    pointwise, worst, obstacle = max(run.pointwise, 0.0), run.worst, -1
    if np.isinf(bound):
        worst, obstacle = _narrowest(run, parts)
    return SearchResult(
        bound, pointwise, worst, run.largest_value, run.evaluations, bound <= GAP * pointwise, run.turns, obstacle
    )
