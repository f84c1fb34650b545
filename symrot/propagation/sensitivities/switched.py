"""Derivatives of motions under torques that jump or bend: variational equations from one switch to the next."""

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.events.event_result import EventResult
from symrot.propagation.sensitivities.event_times import TOUCHING, along_motion, event_time_slopes
from symrot.propagation.sensitivities.guards import AT_ZERO, alike
from symrot.propagation.sensitivities.parameter_slopes import ParameterSlopes
from symrot.propagation.sensitivities.variables import read_variables
from symrot.propagation.sensitivities.variation import columns_of, structure_of
from symrot.propagation.sensitivities.walk import Walk
from symrot.results.sensitivity import SwitchSlopes
from symrot.scene.scene import Scene

__all__ = ["SwitchedEquations"]

Floats = NDArray[np.float64]


class SwitchedEquations:
    """The equations of a motion under torques that switch, and of its derivatives with respect to variables.

    The argument ``keys`` names initial values and constants of the scene, such as ``"omega"`` or ``"body.mass"``. Their
    m components are the variables.
    """

    def __init__(self, scene: Scene, keys: Sequence[str], varying: Collection[str] = ()) -> None:
        self.scene, self.keys, self.variables = scene, keys, read_variables(scene, keys)
        self.columns = columns_of(scene, self.variables)
        self.restartable = all(column.restartable for column in self.columns)
        self._slopes = ParameterSlopes(scene, self.columns, structure_of(scene, self.columns, varying))
        self._walks: list[Walk] = []

    def fit(self, scene: Scene, keys: Sequence[str]) -> bool:
        """Return whether these equations are those of the motion of ``scene`` and of its derivatives.

        The derivatives are those with respect to the variables ``keys``.
        """
        own = self.scene
        same = own.body is scene.body and own.torques is scene.torques and keys == self.keys
        return same and (self.restartable or own.initial == scene.initial)

    def follow(self, scene: Scene, times: Floats, begin: float | None = None) -> tuple[Floats, Floats]:
        """Return the states at n times, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables; they are NaN exactly at a switch at which they jump.
        ``begin``, s, is the initial time.
        """
        begin = float(scene.span.start) if begin is None else begin
        start = np.array([float(x) for x in (*scene.initial.omega_b, *scene.initial.quaternion)])
        states = np.tile(start, (len(times), 1))
        columns = np.array([column.start_from(scene.initial) for column in self.columns]).T
        by = np.tile(columns, (len(times), 1, 1))
        for side in (1.0, -1.0):
            chosen = side * times > side * begin
            if chosen.any():
                walk = self._walk(scene, begin, float((side * times[chosen]).max()) * side)
                states[chosen], by[chosen] = walk.sample(times[chosen])
        return states, by

    def event_slopes(self, scene: Scene, result: EventResult, tolerance: float) -> tuple[Floats, ...]:
        """Return, for each event, the derivatives of its k times with respect to the m variables, shape (k, m).

        ``result`` has the events of the motion. ``tolerance`` is the tolerance with which the motion in ``result`` was
        computed: an event counts as an event at a switch if their times differ by no more than the error that this
        tolerance allows.
        """
        begin, every = float(scene.span.start), []
        for event, kinds, times in zip(result.events, result.kinds, result.t_events, strict=True):
            rows = np.full((len(times), len(self.columns)), np.nan)
            for k, (kind, t) in enumerate(zip(kinds, times.tolist(), strict=True)):
                sides = [self._at_start(scene)] if t == begin else self._walk(scene, begin, t).sides(t, tolerance)
                rows_by_side = [
                    event_time_slopes(event, [kind], np.array([t]), y[None], rate[None], by[None])[0]
                    for y, rate, by in sides
                ]
                speeds = [along_motion(event, t, y, rate) if kind != TOUCHING else 0.0 for y, rate, _ in sides]
                rows[k] = rows_by_side[0]
                # the formula stays at zero after the switch, as omega_3 of a wheel that dry friction stops
                if len(rows_by_side) == 2 and abs(speeds[1]) > AT_ZERO * abs(speeds[0]):
                    rows[k] = np.where(alike(*rows_by_side), rows_by_side[0], np.nan)
                    if abs(speeds[0]) <= AT_ZERO * abs(speeds[1]):
                        rows[k] = rows_by_side[1]
            every.append(rows)
        return tuple(every)

    def switchings(self, scene: Scene, times: Floats) -> tuple[SwitchSlopes, ...]:
        """Return the switches of sign, abs, .. on the way to ``times``, s, each with the derivatives of its time.

        The derivatives are those with respect to the m variables that :attr:`keys` names. Switches after the initial
        time come first, then those before it.
        """
        begin, every = float(scene.span.start), []
        for side in (1.0, -1.0):
            chosen = side * times > side * begin
            if chosen.any():
                end = float((side * times[chosen]).max()) * side
                every += [each for each in self._walk(scene, begin, end).switchings if side * each.t <= side * end]
        return tuple(every)

    def _at_start(self, scene: Scene) -> tuple[Floats, Floats, Floats]:
        begin = float(scene.span.start)
        walk = self._walk(scene, begin, float(scene.span.stop))
        first = walk.intervals[0]
        return first.first, walk.guards.rates(first, first.start, first.first), first.before

    def _walk(self, scene: Scene, begin: float, end: float) -> Walk:
        for walk in self._walks:
            if walk.covers(scene, begin, end):
                return walk
        walk = Walk(self._slopes, scene, begin, end)
        self._walks = [walk, *self._walks[:1]]
        return walk
