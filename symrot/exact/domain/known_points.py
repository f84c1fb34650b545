"""Search for points at which formulas are proven to be real numbers, so that no verdict "true" is vacuous.

The search runs in double precision. Interval arithmetic then proves its result: fractions for the unknowns, or an
interval for each unknown, within which the hypotheses have a solution.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from random import Random
from typing import Any

from sympy import Expr

from symrot.exact.domain.needs import Need, assumptions_of, fits_assumptions, leaves_of
from symrot.exact.domain.newton_box import EquationSystem
from symrot.exact.floats import NoValue, float_at
from symrot.exact.intervals import enclosure

__all__ = ["holds", "known_point"]

STARTS = 160
"""Number of random points from each of which a search starts for a point that satisfies all conditions."""

MOST_LOOKS = 60_000
"""Number of evaluations of conditions after which the search for a point that satisfies all conditions gives up."""

SIMPLE = tuple(Fraction(n, d) for n, d in ((1, 1), (2, 1), (1, 2), (-1, 1), (3, 1), (1, 3), (-1, 2), (0, 1), (-2, 1)))
WIDER = (*SIMPLE, *(Fraction(sign * n, d) for n, d in ((1, 10), (5, 1), (10, 1), (3, 7), (1, 100), (50, 1), (3, 2),
         (3, 4), (9, 10), (1, 1000), (1000, 1), (10**6, 1), (1, 10**6)) for sign in (1, -1)))  # fmt: skip

TOLERANCE = 1e-12
SMALLEST_STEP, LARGEST_STEP = Fraction(1, 2**24), Fraction(2**40)

Point = dict[Expr, Any]


def holds(need: Need, point: Point) -> bool:
    """Return whether a condition, such as ``x >= 0``, is proven to hold at a point.

    The point maps symbols to fractions or intervals.
    """
    if need.sign == "real":
        return False
    held = enclosure(need.formula, point)
    if held is None:
        return False
    return bool({">= 0": held.a >= 0, "> 0": held.a > 0, "!= 0": 0 not in held}[need.sign])


def known_point(needs: Sequence[Need], equations: Sequence[Expr] = ()) -> Point | None:
    """Return a point at which conditions and equations are proven to hold, or None if no such point is found.

    Parameters
    ----------
    needs : sequence of Need
        Conditions to satisfy, in addition to the assumed signs of the symbols.
    equations : sequence of Expr
        Formulas that must be zero.

    Returns
    -------
    dict or None
        From symbols, functions of time and derivatives to fractions, or to intervals that contain the value.
    """
    leaves = leaves_of([*(need.formula for need in needs), *equations])
    needs = [*needs, *(need for leaf in leaves for need in assumptions_of(leaf))]
    if any(need.sign == "real" for need in needs):
        return None
    if not leaves:
        return {} if not equations and all(holds(need, {}) for need in needs) else None
    return _Search(needs, equations, leaves).point()


class _Search:
    def __init__(self, needs: Sequence[Need], equations: Sequence[Expr], leaves: Sequence[Expr]) -> None:
        self.needs, self.leaves, self.looks = needs, leaves, 0
        self.equations = EquationSystem(equations, leaves) if equations else None
        self.own = {need: leaves_of([need.formula]) for need in needs}

    def point(self) -> Point | None:
        source = Random(7)
        for start in self.starts(source):
            if self.looks > MOST_LOOKS:
                break
            moved = self.moved(start)
            if self.equations is None:
                if not self.broken(moved) and all(holds(need, moved) for need in self.needs):
                    return moved
                continue
            for begin in (start, moved):
                near = self.equations.solved({leaf: float(value) for leaf, value in begin.items()})
                if near is not None and not self.broken(near):
                    box = self.equations.box(near)
                    if box is not None and self.whole(box) and all(holds(need, box) for need in self.needs):
                        return box
        return None

    def whole(self, point: Point) -> bool:
        """Return whether every symbol that is assumed to be an integer has an integer value at a point."""
        return all(not leaf.is_integer or getattr(value, "denominator", 0) == 1 for leaf, value in point.items())

    def starts(self, source: Random) -> Iterator[Point]:
        for attempt in range(STARTS):
            pool = SIMPLE if attempt < STARTS // 3 else WIDER
            yield {leaf: self.drawn(leaf, pool, source) for leaf in self.leaves}

    def drawn(self, leaf: Expr, pool: Sequence[Fraction], source: Random) -> Fraction:
        fitting = [value for value in pool if fits_assumptions(leaf, value)]
        return source.choice(fitting) if fitting else Fraction(1)

    def broken(self, point: Point) -> list[Need]:
        """Return the conditions that are violated at a point, computed in double precision."""
        values = {leaf: float(value) for leaf, value in point.items()}
        known: dict[Expr, float] = {}
        return [need for need in self.needs if not self.seems(need, values, known)]

    def seems(self, need: Need, values: dict[Expr, float], known: dict[Expr, float]) -> bool:
        self.looks += 1
        try:
            value = float_at(need.formula, values, known)
        except NoValue:
            return False
        return value >= -TOLERANCE if need.sign == ">= 0" else value > 0 if need.sign == "> 0" else value != 0

    def moved(self, point: Point) -> Point:
        """Return a point at which the conditions are violated less, in double precision, or the same point."""
        # only a candidate: the caller proves that it obeys the conditions
        point = self.jumped(point)
        return self.climbed(point) if self.broken(point) else point

    def climbed(self, point: Point) -> Point:
        """Return a point at which the conditions are violated less, or the same point; steps change one value each."""
        size, depth = Fraction(1), self.depth(point)
        while depth < 0 and size > SMALLEST_STEP and self.looks < MOST_LOOKS:
            trials = ({**point, leaf: point[leaf] + sign * size}
                      for leaf in self.leaves for sign in (1, -1) if not leaf.is_integer)  # fmt: skip
            better = next(((deeper, trial) for trial in trials if (deeper := self.depth(trial)) > depth), None)
            if better is None:
                # if no step helps, shorter ones may
                size /= 4
            else:
                (depth, point), size = better, min(2 * size, LARGEST_STEP)
        return point

    def depth(self, point: Point) -> float:
        """Return minus the sum of all violations of the conditions at a point: -2 for ``x >= 0`` at x = -2."""
        values = {leaf: float(value) for leaf, value in point.items()}
        known: dict[Expr, float] = {}
        self.looks += len(self.needs)
        total = 0.0
        for need in self.needs:
            if need.sign != "!= 0":
                try:
                    total += min(0.0, float_at(need.formula, values, known))
                except NoValue:
                    total -= 1e9
        return total

    def jumped(self, point: Point) -> Point:
        """Return a point at which fewer conditions are violated, or the same point.

        Symbols get other simple values, one at a time.
        """
        broken = self.broken(point)
        while broken and self.looks < MOST_LOOKS:
            trials = (
                {**point, leaf: value}
                for need in broken for leaf in self.own[need] for value in WIDER if fits_assumptions(leaf, value)
            )  # fmt: skip
            for trial in trials:
                left = self.broken(trial)
                if len(left) < len(broken):
                    point, broken = trial, left
                    break
                if self.looks > MOST_LOOKS:
                    break
            else:
                break
        return point
