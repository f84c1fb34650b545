"""The guards of a motion under torques with switching functions (sign, abs, ..): their values, signs and zeros.

The *guard* of a function is its argument; its *mode* is the number that replaces it in formulas. A function is *held*
while its guard stays at zero and the equations determine its value.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.formula.float_functions import float_value
from symrot.formula.tree import names, parse
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.events.search import signs_at_ends
from symrot.propagation.motions.motion import Motion
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.switched.domains import excess
from symrot.propagation.switched.instant import Instant
from symrot.propagation.switched.regimes import Guard, Modes, Regime
from symrot.propagation.switched.run_state import RunState
from symrot.propagation.switched.system import SwitchedSystem

__all__ = ["ERRORS", "MOST_ULPS", "Guards"]

ERRORS = 100.0  # largest error of a motion, in tolerances
NEARBY, MOST_ULPS = 1e-6, 64.0  # part of the time since the last switch; units in the last place of a located time
RISE_BITS = 40  # a guard is followed from 2 to this negative power of a piece on, to see whether it rises


class Guards(RunState):
    """The guards (arguments of sign, floor, ..) at the present time of a motion and near it."""

    def __init__(self, motion: Motion, system: SwitchedSystem, end: float) -> None:
        super().__init__(motion, end, system.initial_modes())
        # t and end are times on a clock that shows 0 at the last switch, an instant of twice the digits
        self.system, self._end = system, Instant(end)
        self.by_name = {switch.mode: switch for switch in system.switches}
        self.held = frozenset[str]()

    @property
    def now(self) -> float:
        """The present time of the motion on the clock of the scene, s, rounded to one double."""
        return self.zero.after(self.t).high

    def _at(self, t: float) -> Instant:
        return self._end if t == self.end else self.zero.after(t)

    def _name(self, mode: str) -> str:
        return str(self.by_name[mode].label)

    def _names_of_held(self) -> str:
        return " and ".join(self._name(mode) for mode in sorted(self.held))

    def _regime(self, modes: Modes, held: frozenset[str] | None = None) -> Regime:
        """Return the smooth motion (a regime) for given values of the functions sign, abs, ..

        ``modes`` has these values by name. ``held`` names the functions whose arguments stay at zero, by default the
        functions that are held now.
        """
        try:
            return self.system.regime(self.held if held is None else held, modes)
        except InputError as reason:
            raise IntegrationStopped(
                self.t,
                f"the motion would slide along the jump of {self._names_of_held()} (the states would stay at this "
                f"jump), which symrot cannot compute: {str(reason).removeprefix('torque: ')}, or end the motion at "
                "this time",
                self.end,
            ) from None

    def _guard_value(self, mode: str, place: tuple[float, Floats] | None = None) -> float:
        """Return the value of a switching function's argument, now or at ``place``, a pair (time, states).

        ``mode`` is the name of the number that replaces the function in formulas. For floor(x) the result is x - n,
        where n is the present value of the function.
        """
        # the floor is its value n in the present equations: it changes where x - n is 0 or 1
        regime = self._regime(self.modes)
        return float_value(regime.formulas[mode], self._values(regime, place or (self.t, self.y)))

    def _values(self, regime: Regime, place: tuple[float, Floats]) -> dict[str, float]:
        """Return the values, by name, of all names in switching functions' arguments, at ``place`` = (time, states)."""
        t, y = place
        values = {name: float(column[0]) for name, column in self._columns(np.array([t]), y[None]).items()}
        return {**values, **regime.values(self.modes, self.zero), "t": t}

    def _columns(self, times: Floats, states: Floats) -> dict[str, Floats]:
        """Return the values of omega_1..3 and, if the scene has an attitude, of q0..3 at the rows of ``states``."""
        names = [f"omega_{i} of t" for i in (1, 2, 3)]
        names += [f"q{i} of t" for i in range(4)] if self.motion.plan.structure.attitude else []
        quantities = self.motion.evaluate(times, states, names)
        return {name.removesuffix(" of t"): column for name, column in zip(names, quantities.T, strict=True)}

    def _has_no_value(self, regime: Regime, mode: str, times: Floats, states: Floats) -> NDArray[np.bool_]:
        """Return, for each of n ``times``, whether the argument of a function (sign, floor, ..) has no value there.

        ``mode`` is the name of the number that replaces the function in formulas. ``regime`` is the smooth motion
        between two switches on which the times lie, ``states`` are its states there, shape (n, N). The argument has no
        value if it contains, for example, the root of a negative number. A number that lies outside the domain of such
        a root by no more than the error of the motion counts as having a root.
        """
        columns = self._columns(times, states)
        rate = np.sqrt(sum(columns[f"omega_{i}"] ** 2 for i in (1, 2, 3)))
        sizes = {name: rate if name.startswith("omega") else np.ones_like(times) for name in columns}
        numbers = {name: np.array(value) for name, value in regime.values(self.modes, self.zero).items()}
        with np.errstate(all="ignore"):
            outside = excess(regime.formulas[mode], {**columns, **numbers, "t": times}, sizes)
        return np.broadcast_to(outside > ERRORS * self.motion.tolerance, times.shape)

    def _oriented(self, regime: Regime, guard: Guard, place: tuple[float, Floats]) -> float:
        """Return the value of a guard's formula at ``place``, a pair (time, states); NaN if it has no value there.

        The formula is written so that it decreases through zero where a function (sign, floor, ..) switches. The switch
        ends the smooth motion ``regime``.
        """
        try:
            return float_value(parse(guard.formula), self._values(regime, place))
        except (ArithmeticError, ValueError, IntegrationStopped):
            return math.nan

    def _crosses(self, regime: Regime, guard: Guard, *places: tuple[float, Floats]) -> bool:
        """Return whether a function (sign, floor, ..) switches between two points (time, states) of the motion."""
        before, after = (self._oriented(regime, guard, place) for place in places)
        # the guard falls from >= 0 to <= 0
        return before >= 0.0 >= after and before > after

    def _names_inside(self, mode: str) -> set[str]:
        """Return the names of the variables and modes in the argument of the function with the mode ``mode``.

        For abs(x + sign(y)) these are x and the mode of sign(y), the name of the number that replaces sign(y).
        """
        return set(names(self.by_name[mode].guard))

    def _negative(
        self, regime: Regime, active: list[bool], values: list[float], piece: Piece
    ) -> tuple[list[Guard], list[Guard]]:
        """Return two lists of guards: negative just after the start of ``piece``, and negative at its end.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches. ``piece`` is an interval
        of the smooth motion ``regime``. ``active`` says for each guard of this motion whether the motion ends where the
        guard is zero; the other guards are left out. ``values`` are the values of the parameters of the library that
        evaluates the guards.
        """
        formulas = [guard.formula for guard in regime.guards]
        # such a function should have switched before the piece or within it; active: guards that can end the regime
        first, last = (
            [guard for guard, on, sign in zip(regime.guards, active, signs, strict=True) if on and sign < 0]
            for signs in signs_at_ends(regime.path, formulas, values, piece)
        )
        return first, last

    def _rises(self, regime: Regime, guard: Guard, piece: Piece, states: Callable[[Floats], Floats]) -> bool:
        """Return whether the value of a guard is at most zero at the start of ``piece`` and rises until it is positive.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches.
        """
        # The state was located where the guard is zero, to the rounding errors of a longer piece: it may be slightly
        # negative still. Values at doubled distances tell rising from falling, which is a switch back or sliding.
        start, end = float(piece.edges[0]), float(piece.edges[-1])
        times = np.concatenate([[start], start + (end - start) * np.ldexp(1.0, range(-RISE_BITS, 1))])
        before = -math.inf
        for t, y in zip(times.tolist(), states(times), strict=True):
            value = self._oriented(regime, guard, (t, y))
            if not before <= value <= 0.0:
                return value > 0.0 and before > -math.inf
            before = value
        return False

    def _located(self, regime: Regime, guard: Guard, t: float) -> Instant:
        """Return the time near t at which a guard (argument of sign, abs, ..) is zero, as an :class:`Instant`.

        If the guard depends on time alone, a Newton step gives its zero to twice the digits of t. If it depends on
        states too, or if the step fails, the result is the time t itself.
        """
        instant = self.zero.after(t)
        if guard.mode in self.held or guard.mode not in regime.of_time:
            return instant
        switch, aside = self.by_name[guard.mode], NEARBY * abs(t)
        goal = 0.0 if switch.kind == "sign" else max(guard.change, 0)
        values = regime.values(self.modes, instant)

        def value(t: float) -> float:
            return float_value(regime.formulas[guard.mode], {**values, "t": t}) - goal

        try:
            slope = (value(aside) - value(-aside)) / (2.0 * aside)
            correction = -value(0.0) / slope
        except (ArithmeticError, ValueError, IntegrationStopped):
            return instant
        if abs(correction) > MOST_ULPS * math.ulp(t):
            return instant
        return self._past(regime, guard, instant.after(correction))

    def _past(self, regime: Regime, guard: Guard, instant: Instant) -> Instant:
        """Return ``instant``, or a slightly later one if the computed ``guard`` is still positive at ``instant``.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches.
        """
        # The function (sign, abs, ..) would switch back at once. Later times are tried, at growing distances of a few
        # units in the last place.
        formula, later = parse(guard.formula), instant
        step = self.side * math.ulp(math.ulp(instant.high))
        while abs(step) <= MOST_ULPS * math.ulp(instant.high):
            values = {**regime.values(self.modes, later), "t": 0.0}
            if float_value(formula, values) <= 0.0:
                return later
            later, step = instant.after(step), 8.0 * step
        return instant
