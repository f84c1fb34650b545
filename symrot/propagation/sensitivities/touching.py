"""Guards that touch zero without passing it: if the torque jumps there, the motion has no derivatives afterwards.

A *guard* is the argument of a switching function (sign, floor, ..).
"""

import numpy as np
from numpy.typing import NDArray

from symrot.formula.switches import STATES
from symrot.formula.tree import evaluate
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.sensitivities.guards import Guards
from symrot.propagation.sensitivities.intervals import Interval
from symrot.propagation.sensitivities.sliding import rests

__all__ = ["refuse_touching"]

Floats = NDArray[np.float64]
GRAZE = (
    1e-9  # a guard touches zero if its smallest distance from zero in an interval is at most this part of the largest
)
NEARBY = 0.1  # a smallest distance is examined if it is at most this part of the largest
FINE, ZOOMS = 8, 12  # points in a step of a motion, and the number of times that the points are refined


def refuse_touching(guards: Guards, interval: Interval) -> None:
    """Raise PropagationError if the argument of a function with a jump (sign, ..) touches zero inside an interval.

    An argument of time alone that no variable changes is allowed: it touches zero in all nearby motions too.
    """
    regime = interval.regime
    modes = {guard.mode for guard, on in zip(regime.guards, regime.active(interval.modes), strict=True) if on}
    for mode in sorted(modes & regime.formulas.keys() - interval.held):
        if guards.is_continuous(mode) or rests(guards, interval, mode):
            continue
        t = _touching(guards, interval, mode)
        if t is None:
            continue
        guard = guards.guard(interval, mode, t, interval.last)
        if guard.states.any() or guard.variables.any():
            raise guards.refusal(interval.zero.after(t), f"the argument of {guards.name(mode)} touches zero")


def _touching(guards: Guards, interval: Interval, mode: str) -> float | None:
    """Return the first time, s after ``interval.zero``, at which the argument of a function touches zero.

    ``mode`` is the name of the number that replaces the function (sign, floor, ..) in formulas. For floor, the time is
    that at which the argument touches a whole number. Return None if there is no such time.
    """
    values, _ = guards.bound(interval.regime.parameters, interval, "guards")
    constants = {**{name: float(value) for name, value in interval.modes.items()}, **values}
    ends = guards.side * np.array([chunk.stop - interval.zero for chunk in interval.chunks[:-1]])

    def distances(times: Floats) -> Floats:
        states, places = np.empty((len(times), len(STATES))), np.searchsorted(ends, guards.side * times)
        for place in np.unique(places).tolist():
            states[places == place] = interval.chunks[place].own_states(times[places == place])
        inputs = {**constants, "t": times, **dict(zip(STATES, states.T, strict=True))}
        guard = np.asarray(evaluate(interval.regime.formulas[mode], inputs, ARRAY_FUNCTIONS, float)) + 0.0 * times
        near = np.abs(guard)
        return np.minimum(near, np.abs(1.0 - guard)) if guards.is_floor(mode) else near

    grid = np.append(np.concatenate([_points(chunk.own_piece.edges) for chunk in interval.chunks]), interval.stop)
    row = distances(grid)
    largest = float(row.max())
    least = (row[1:-1] <= row[:-2]) & (row[1:-1] <= row[2:]) & (row[1:-1] <= NEARBY * largest)
    for place in (np.flatnonzero(least) + 1).tolist():
        low, high = float(grid[place - 1]), float(grid[place + 1])
        for _ in range(ZOOMS):
            times = np.linspace(low, high, 2 * FINE + 1)
            near = distances(times)
            k = min(max(int(near.argmin()), 1), 2 * FINE - 1)
            low, high = float(times[k - 1]), float(times[k + 1])
        if near.min() <= GRAZE * largest:
            return 0.5 * (low + high)
    return None


def _points(edges: Floats) -> Floats:
    """Return times in the steps of a motion, :data:`FINE` in each step, without the end of the last one."""
    inside = np.linspace(0.0, 1.0, FINE, endpoint=False)
    return np.asarray(edges[:-1, None] + np.diff(edges)[:, None] * inside).ravel()
