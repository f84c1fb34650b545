"""A motion through the switches of its torques, with its derivatives with respect to variables at any time."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError
from symrot.formula.switches import STATES
from symrot.planning.plan import Plan
from symrot.propagation.method import choose_method
from symrot.propagation.sensitivities.crossings import AT_SWITCH, Crossings, jumps_at_end
from symrot.propagation.sensitivities.guards import Guards, alike
from symrot.propagation.sensitivities.intervals import Interval, smooth_intervals
from symrot.propagation.sensitivities.libraries import TOLERANCE, MotionLibrary
from symrot.propagation.sensitivities.parameter_slopes import ParameterSlopes
from symrot.propagation.sensitivities.sliding import hold_at_rest, refuse_resting
from symrot.propagation.sensitivities.starts import from_start
from symrot.propagation.sensitivities.touching import refuse_touching
from symrot.propagation.sensitivities.variation import follow_interval, groups_of_columns, unit_of
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.propagation.switched.motion import SwitchedMotion
from symrot.results.sensitivity import SwitchSlopes
from symrot.scene.scene import Scene

__all__ = ["Walk"]

Floats = NDArray[np.float64]
MARGIN = 10.0  # times the tolerance: an error of an event time, as part of the length of the motion


class Walk:
    """A motion in one direction of time, in smooth intervals, with its derivatives at their ends.

    Parameters
    ----------
    parameter_slopes : ParameterSlopes
        The variables, and the derivatives of the parameters with respect to them.
    scene : Scene
        The scene with the initial state.
    begin, end : float
        Initial and last time, s.
    """

    def __init__(self, parameter_slopes: ParameterSlopes, scene: Scene, begin: float, end: float) -> None:
        self.parameter_slopes, self.scene, self.begin, self.end = parameter_slopes, scene, begin, end
        self.side = 1.0 if end > begin else -1.0
        own = replace(scene, span=scene.span._replace(start=Fraction(begin)))
        plan = Plan(own, parameter_slopes.structure, ())
        method = "dop853" if non_smooth_torque(plan) else "taylor"
        motion = SwitchedMotion(plan, choose_method(plan, method), TOLERANCE)
        self.length = abs(end - begin)
        self._units = [unit_of(scene, column) for column in parameter_slopes.columns]
        self.guards = Guards(scene, motion.system, parameter_slopes, self.side)
        try:
            self.intervals, changes = smooth_intervals(motion, self.end)
        except IntegrationStopped as error:
            raise PropagationError(f"{scene.name}: sensitivities: {error}") from None
        self._crossings = Crossings(self.guards, changes, self.length)
        self._differentiate()

    @property
    def switchings(self) -> list[SwitchSlopes]:
        """The switches of the motion, with the derivatives of their times with respect to the variables."""
        return self._crossings.switchings

    def covers(self, scene: Scene, begin: float, end: float) -> bool:
        """Return whether this motion starts as ``scene`` does, at ``begin``, and reaches the time ``end``, s."""
        own = self.scene
        same = own.body is scene.body and own.torques is scene.torques and own.initial == scene.initial
        same &= self.begin == begin
        return same and self.side * (end - begin) > 0.0 and self.side * (self.end - end) >= 0.0

    def _differentiate(self) -> None:
        """Compute and store the derivatives of the states at the start and at the end of each interval.

        They are derivatives with respect to the variables.
        """
        by = np.array([column.start_from(self.scene.initial) for column in self.parameter_slopes.columns]).T
        guards, previous = self.guards, None
        for interval in self.intervals:
            hold_at_rest(guards, interval)
            refuse_touching(guards, interval)
            if previous is None:
                by = from_start(guards, interval, by)
            else:
                by = self._crossings.across(previous, interval, by)
            interval.before = by
            refuse_resting(guards, interval, self._integrate)
            _, values = self._integrate(interval, np.array([interval.stop]))
            by = interval.after = values[0]
            previous = interval

    def _integrate(self, interval: Interval, times: Floats) -> tuple[Floats, Floats]:
        """Return the states at n times of an interval, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables. The times are s after ``interval.zero``.
        """
        program, parameters = self.guards.program(interval)
        values, rows = self.guards.bound(parameters, interval, "rates")
        libraries = []
        for places in groups_of_columns(len(self.parameter_slopes.columns)):
            depends = [self.parameter_slopes.depends(parameters, k) for k in places]
            libraries.append((places, depends, MotionLibrary(interval.regime.plan, program, depends)))
        return follow_interval(
            libraries, parameters, values, rows, interval.first, interval.before, self._units, interval.start, times,
            self._label(interval),
        )  # fmt: skip

    def _label(self, interval: Interval) -> Callable[[PropagationError], PropagationError]:
        def named(error: PropagationError) -> PropagationError:
            if isinstance(error, IntegrationStopped) and abs(error.t - interval.start) <= AT_SWITCH * self.length:
                return self.guards.refusal(interval.begin, "the slope of the torque is not finite there")
            later = error.later(interval.zero.high) if isinstance(error, IntegrationStopped) else error
            return PropagationError(f"{self.scene.name}: sensitivities: {later}")

        return named

    def sample(self, times: Floats) -> tuple[Floats, Floats]:
        """Return the states at n times of the scene, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables; they are NaN exactly at a switch at which they jump.
        The times, s, lie between start and end of the motion; the start itself is excluded.
        """
        order = np.argsort(self.side * times, kind="stable")
        ordered, count = times[order], 0
        states = np.empty((len(times), len(STATES)))
        by = np.empty((len(times), len(STATES), len(self.parameter_slopes.columns)))
        for place, interval in enumerate(self.intervals):
            final = place == len(self.intervals) - 1
            last = len(ordered) if final else max(count, interval.end.reached(ordered, self.side))
            if last == count:
                continue
            own = np.asarray(interval.zero.since(ordered[count:last]))
            chosen = order[count:last]
            states[chosen], by[chosen] = self._integrate(interval, own)
            at_switch = chosen[ordered[count:last] == interval.end.high]
            if len(at_switch):
                following = None if final else self.intervals[place + 1].before
                jump = (
                    jumps_at_end(self.guards, interval)
                    if following is None
                    else ~alike(interval.after, following).all(axis=0)
                )
                by[at_switch[:, None], :, np.flatnonzero(jump)] = np.nan
            count = last
        return states, by

    def sides(self, t: float, tolerance: float) -> list[tuple[Floats, Floats, Floats]]:
        """Return (state, rates, derivatives) at the time t, s: one triple, or two at a switch, before and after it.

        The derivatives are those of the state with respect to the variables. ``tolerance`` is the tolerance of the
        motion in which the time t was located. t counts as the time of a switch if both differ by no more than the
        error that a located time may have at this tolerance.
        """
        for place, interval in enumerate(self.intervals[:-1]):
            following = self.intervals[place + 1]
            near = max(AT_SWITCH * max(abs(t), self.length), MARGIN * tolerance * self.length)
            if abs(t - interval.end.high) <= near:
                return [
                    (interval.last, self.guards.rates(interval, interval.stop, interval.last), interval.after),
                    (following.first, self.guards.rates(following, following.start, following.first), following.before),
                ]
        interval = next(
            (each for each in self.intervals if each.end.reached(np.array([t]), self.side)), self.intervals[-1]
        )
        own = float(interval.zero.since(t))
        states, by = self._integrate(interval, np.array([own]))
        return [(states[0], self.guards.rates(interval, own, states[0]), by[0])]
