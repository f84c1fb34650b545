"""The jumps of derivatives at the switches of a torque.

A switching function (sign, abs, ..) has a *guard* g(t, x, p), its argument, and a *mode*, the number that replaces it
in formulas. Where g becomes zero, the rates change from f- to f+, and the derivatives S of the states x with respect to
a variable v jump. The time of the switch changes by ``dt/dv = -(g_x S- + g_p dp/dv)/(g_t + g_x f-)``, and ::

    S+ = S- - (f+ - f-) dt/dv

(saltation matrix). This holds if the guard passes zero at a speed other than zero, and also if the guard is
*held* at zero from then on; f+ are then the rates of the sliding motion. At a kink and at the end of sliding, f+ = f-.
Source: M. A. Aizerman, F. R. Gantmakher, On the stability of periodic motions, J. Appl. Math. Mech. 22 (1958) 1065.
"""

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.sensitivities.guards import ALIKE, AT_ZERO, Gradient, Guards, alike
from symrot.propagation.sensitivities.intervals import Interval
from symrot.propagation.sensitivities.sliding import require_one_surface, rests
from symrot.propagation.switched.instant import Instant
from symrot.results.sensitivity import SwitchSlopes

__all__ = ["AT_SWITCH", "Crossings", "jumps_at_end"]

Floats = NDArray[np.float64]
STEEP = 1e-5  # speed of a guard at a crossing, in units of its mean speed: a slower one grazes zero
AT_SWITCH = 1e-12  # part of the time: an event this near to a switch is at the switch
MOST_AT_ONCE = 6  # functions that may switch at one time


class Flip(NamedTuple):
    """The switch of one function (sign, abs, ..).

    ``value`` is the value of the function after the switch. ``time`` has the derivatives of the time of the switch with
    respect to the m variables. ``guard`` has the derivatives of the function's argument with respect to the seven
    states.
    """

    value: int
    time: Floats
    guard: Floats


class Crossings:
    """The switches of a motion, in their order: the derivatives of the states after each, and of the switching times.

    Parameters
    ----------
    guards : Guards
        Computes the arguments of the switching functions (sign, abs, ..), the rates of the states, and the derivatives
        of both.
    changes : mapping
        For each pair (time in s, function as the user wrote it): how the argument of the function behaves then. It is
        ``"passed"`` if the argument passes zero, ``"held"`` if it stays there from then on, and ``"released"`` if it
        leaves zero, where it was held.
    length : float
        The length of the motion, s.

    Attributes
    ----------
    switchings : list
        The switches so far, with the derivatives of their times.
    """

    def __init__(self, guards: Guards, changes: Mapping[tuple[float, str], str], length: float) -> None:
        self.guards, self._changes, self.length = guards, changes, length
        self.switchings: list[SwitchSlopes] = []
        # the last jumps of the rates, each within rounding errors of the one before: the interval before them, the time
        # of the last one, the functions that switched, and whether nothing else switched and no argument is held
        self._last: tuple[Interval, Instant, dict[str, Flip], bool] | None = None

    def across(self, before: Interval, after: Interval, by: Floats) -> Floats:
        """Return the derivatives of the states after a switch between two intervals, shape (7, m).

        ``by`` has the derivatives before the switch. The derivatives of the time of the switch are appended to
        :attr:`switchings`. Raise PropagationError if the derivatives after the switch do not exist.
        """
        guards = self.guards
        sliding = {*before.held, *after.held, *guards.system.tied(before.held), *guards.system.tied(after.held)}
        changed = [mode for mode, value in after.modes.items() if mode not in sliding and value != before.modes[mode]]
        held, released = after.held - before.held, sorted(before.held - after.held)
        if not changed and not held and not released:
            return by
        f, later = guards.rates(before, before.stop, before.last), guards.rates(after, after.start, before.last)
        causes: dict[str, Gradient] = {}
        for mode in [*changed, *sorted(held)]:
            if mode in before.regime.formulas:
                guard = guards.guard(before, mode, before.stop, before.last)
                # a guard with another switching function inside jumps over zero, and follows that function
                if _is_zero(guards, before, mode, guard, f):
                    causes[mode] = guard
        for mode in sorted(held & before.regime.formulas.keys()):
            require_one_surface(guards, before, mode, before.stop, before.last)
        jumps = {mode: guard for mode, guard in causes.items() if not guards.is_continuous(mode)}
        rows: dict[str, Floats] = {}
        for mode, guard in causes.items():
            speed, mean = guard.along(f), _mean_speed(guards, before, mode)
            grazes = not abs(speed) > STEEP * max(guard.size(f), mean)
            if mode in jumps and mode not in held:
                leaving = guard.along(later)
                grazes |= leaving * speed <= 0.0 or not abs(leaving) > STEEP * max(guard.size(later), mean)
            if grazes and mode in jumps:
                raise guards.refusal(
                    before.end,
                    f"the argument of {guards.name(mode)} changes too slowly where {guards.name(mode)} switches, so "
                    "that the time of this switch has no derivatives",
                )
            rows[mode] = np.full(len(by.T), np.nan) if grazes else 0.0 - guard.change(by) / speed
        if not jumps and float(np.abs(later - f).max()) > STEEP * float(np.abs([f, later]).max()):
            names_of = " or ".join(map(guards.name, [*changed, *sorted(held), *released]))
            raise guards.refusal(
                before.end,
                f"the torque jumps there, but not because the argument of {names_of} becomes zero: the derivatives of "
                "the time of such a jump cannot be computed",
            )
        first = next(iter(jumps), None)
        if first is not None:
            flips = {mode: Flip(after.modes[mode], rows[mode], jumps[mode].states) for mode in jumps}
            alone = not held and set(changed) <= causes.keys()
            change = self._at_once(before, flips, alone)
            if change is not None:
                self._append_switches(after.begin, rows, rows[first], {*changed, *sliding})
                return np.asarray(by - change)
        if not causes:
            for mode in released:
                value = guards.held_mode(before, mode)
                speed = value.along(f)
                grazes = not abs(speed) > STEEP * value.size(f)
                rows[mode] = np.full(len(by.T), np.nan) if grazes else 0.0 - value.change(by) / speed
        self._append_switches(after.begin, rows, rows[first] if first is not None else None, {*changed, *sliding})
        return by if first is None else np.asarray(by - np.outer(later - f, rows[first]))

    def _at_once(self, interval: Interval, flips: dict[str, Flip], alone: bool) -> Floats | None:
        """Return the change of the derivatives of the states where several functions switch at one time, shape (7, m).

        The functions (sign, ..) switch at the end of ``interval``. The derivatives are those with respect to the m
        variables, the initial values and constants for which the user requests sensitivities. Return None if the
        formula for the switch of a single function applies: if only one function switches, or if the times of all
        switches have the same derivatives.

        Raise PropagationError if the states after the switches may depend on the order of the switches. The order of
        these functions and of all functions that switched earlier by no more than rounding errors is examined.

        Parameters
        ----------
        interval : Interval
            The interval at whose end the functions switch.
        flips : mapping
            A function's mode (name of the number that replaces the function in formulas) -> the switch of the function.
        alone : bool
            Whether no function other than those in ``flips`` switches, and no argument of a function is held at zero
            from then on.
        """
        earlier, end = self._last, interval.end
        self._last = interval, end, flips, alone
        if earlier is not None and abs(end - earlier[1]) <= AT_SWITCH * max(abs(end.high), self.length):
            first, _, others, others_alone = earlier
            self._last = first, end, {**others, **flips}, alone and others_alone
            # the derivatives already contain the changes at the earlier switches
            self._change_in_any_order(first, self._last[2], self._last[3])
        return self._change_in_any_order(interval, flips, alone)

    def _change_in_any_order(self, interval: Interval, flips: dict[str, Flip], alone: bool) -> Floats | None:
        """Return the change of the derivatives of the states where several functions switch at one time, shape (7, m).

        The functions switch at the end of ``interval``; ``flips`` is a map from the mode of a function (name of the
        number that replaces the function in formulas) to its switch. Return None if the times of all switches have the
        same derivatives.

        The order of the switches must not matter. Raise PropagationError unless each switch changes the rates by the
        same amount whether or not the other functions have switched, and leaves the time derivatives of the arguments
        of the other functions unchanged. Raise it also if ``alone`` is False: a further function then switches, or the
        argument of a function is held at zero from then on.
        """
        guards = self.guards
        groups: list[list[str]] = []
        for mode, flip in flips.items():
            group = next((each for each in groups if alike(flips[each[0]].time, flip.time).all()), None)
            groups.append([mode]) if group is None else group.append(mode)
        if len(groups) == 1:
            return None
        functions = " and ".join(map(guards.name, flips))
        reason = "a small change of a variable separates the switches, and their order may then matter"
        refusal = guards.refusal(interval.end, f"{functions} switch at the same time: {reason}")
        if not alone or len(groups) > MOST_AT_ONCE:
            raise refusal
        corners = {}
        for chosen in product((False, True), repeat=len(groups)):
            own = [mode for group, flip in zip(groups, chosen, strict=True) if flip for mode in group]
            modes = {**interval.modes, **{mode: flips[mode].value for mode in own}}
            corner = replace(interval, modes=modes, regime=guards.system.regime(interval.held, modes))
            corners[chosen] = guards.rates(corner, interval.stop, interval.last)
        first = corners[(False,) * len(groups)]
        jumps = np.array([corners[tuple(k == n for n in range(len(groups)))] - first for k in range(len(groups))])
        size = ALIKE * max(float(np.abs(rates).max()) for rates in corners.values())
        for chosen, rates in corners.items():
            if np.abs(first + np.array(chosen, dtype=np.float64) @ jumps - rates).max() > size:
                raise refusal
        for k, group in enumerate(groups):
            for mode in group:
                speeds = np.delete(jumps, k, axis=0) @ flips[mode].guard
                if np.abs(speeds).max() > size * float(np.abs(flips[mode].guard).max()):
                    raise refusal
        return np.asarray(jumps.T @ np.array([flips[group[0]].time for group in groups]))

    def _append_switches(
        self, instant: Instant, rows: Mapping[str, Floats], others: Floats | None, changed: set[str]
    ) -> None:
        """Append the switches at an instant to :attr:`switchings`, with the m derivatives of their time.

        ``rows`` is a map from a switching function to the m derivatives of the time at which the function switches. The
        function is named by its mode, the number that replaces the function in formulas. ``others`` are the derivatives
        for every other function in ``changed``, whose value differs before and after the instant or whose argument
        stays at zero; None stands for NaN. A function that switches at the instant and back again has NaN.
        """
        names = set(map(self.guards.name, changed))
        unknown = np.full(len(self.guards.parameter_slopes.columns), np.nan)
        for (t, label), how in self._changes.items():
            if t == instant.high:
                # clip has two modes
                row = next((own for mode, own in rows.items() if self.guards.name(mode) == label), None)
                own = row if row is not None else others if others is not None and label in names else unknown
                self.switchings.append(SwitchSlopes(t, label, how, own))


def jumps_at_end(guards: Guards, interval: Interval) -> NDArray[np.bool_]:
    """Return, for each variable, whether the derivatives with respect to it may jump at the end of a motion.

    The derivatives are those of the states. They may jump if a function such as sign switches exactly at the end.
    ``interval`` is the last smooth interval of the motion; the variables are those of ``guards``.
    """
    jumps = np.zeros(len(guards.parameter_slopes.columns), dtype=np.bool_)
    f = guards.rates(interval, interval.stop, interval.last)
    for guard, on in zip(interval.regime.guards, interval.regime.active(interval.modes), strict=True):
        mode = guard.mode
        if on and mode in interval.regime.formulas and mode not in interval.held and not guards.is_continuous(mode):
            gradient = guards.guard(interval, mode, interval.stop, interval.last)
            if _is_zero(guards, interval, mode, gradient, f) and not rests(guards, interval, mode):
                jumps |= gradient.change(interval.after) != 0.0
    return jumps


def _mean_speed(guards: Guards, interval: Interval, mode: str) -> float:
    """Return the size of a guard (argument of sign, abs, ..) in an interval, divided by the length of the interval.

    The size is the largest absolute value at start, middle and end. The guard is zero at the end of the interval, so
    that the quotient is about its mean speed: a scale for the speed with which it reaches zero.
    """
    values = [abs(guards.guard(interval, mode, *place).value) for place in interval.places()]
    if guards.is_floor(mode):
        values = [min(value, abs(1.0 - value)) for value in values]
    return max(values) / abs(interval.stop - interval.start)


def _is_zero(guards: Guards, interval: Interval, mode: str, guard: Gradient, rates: Floats) -> bool:
    """Return whether a guard (argument of sign, abs, ..) is zero at the end of an interval, to 1e-9 of its terms' size.

    For floor(x): whether x is a whole number.
    """
    size = guard.size(rates) * abs(interval.stop) + float(np.abs(guard.states) @ np.abs(interval.last))
    distances = (0.0, 1.0) if guards.is_floor(mode) else (0.0,)
    return min(abs(guard.value - zero) for zero in distances) <= AT_ZERO * size
