"""What follows when the argument of a switching function is zero: it passes zero, stays there, or leaves again.

The *guard* of a function (sign, abs, ..) is its argument; its *mode* is the number that replaces it in formulas. A
function is *held* while its guard stays at zero and the equations determine its value.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from symrot.formula.float_functions import float_value
from symrot.formula.switches import CHANGING, hold
from symrot.formula.tree import names, parse
from symrot.propagation.events.polynomials import Piece
from symrot.propagation.events.search import signs_at_ends
from symrot.propagation.motions.motion import Motion
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.switched.guards import ERRORS, MOST_ULPS, Guards
from symrot.propagation.switched.regimes import Guard, Modes, Regime
from symrot.propagation.switched.run_state import CHATTER
from symrot.propagation.switched.smooth_pieces import smooth_pieces
from symrot.propagation.switched.system import SwitchedSystem, is_continuous

__all__ = ["ModeChanges"]

MOST_SWITCHES, MOST_AT_ONCE = 1_000_000, 1000
PERTURBATION, PARALLEL = 1e-6, 1e-6  # of time and states, for slopes; relative difference of parallel slopes
SHORT = 1e-9  # part of the span: distance beyond an instant without rates at which formulas are evaluated
CHATTERING = 1e-9  # part of the span: CHATTER switches within it count as infinitely many
SwitchState = tuple[frozenset[tuple[str, int]], frozenset[str]]
"""The values of all switching functions (sign, abs, ..): pairs (name, value), and the names of the held functions.

The argument of a held function stays at zero; its value follows from the equations. A name is the name of the mode, the
number that replaces the function in formulas.
"""


class ModeChanges(Guards):
    """Part of the computation of a motion: changes the values of switching functions (sign, abs, ..) at a switch.

    A function's mode is the number that replaces the function in formulas, such as 1 for sign(x) while x > 0.
    """

    def __init__(self, motion: Motion, system: SwitchedSystem, end: float) -> None:
        super().__init__(motion, system, end)
        self.switches = 0
        self.flipped: dict[str, int] = {}  # the modes that changed at the present time, and how often
        self.changes: dict[tuple[float, str], str] = {}  # how each function switched, with time and function as key
        self.released: set[str] = set()  # modes held until this time: their guards leave zero slowly
        self.order: list[str] = []  # the modes that changed at the present time, in the order of the changes
        self.rested: set[str] = set()  # modes that were held at the present time though no torque was needed for it
        self.left: set[tuple[str, int]] = set()  # pairs (mode, value): the values from which modes changed now
        self.visited: dict[SwitchState, int] = {}  # states at the present time, with the number of changes before each
        # the held modes, and Regime.attraction when they were first held
        self.attraction: tuple[frozenset[str], list[float]] = frozenset(), []
        self.settled = 0  # how often functions were set to their value at zero

    def _count(self) -> None:
        self.switches += 1
        self.recent.append(self.zero.after(self.t))
        way = abs(self.recent[-1] - self.recent[0])
        near = len(self.recent) == CHATTER and way <= CHATTERING * self.span
        if near or self.switches > MOST_SWITCHES:
            within = f"{CHATTER} within {way:.1e} s" if near else f"more than {MOST_SWITCHES}"
            raise IntegrationStopped(self.t, f"the torque switches again and again without end ({within})", self.end)

    def _forget_changes(self) -> None:
        """Clear the lists of functions that switched at the present time; call this when the motion continues."""
        self.flipped, self.order = {}, []
        self.left, self.visited, self.released, self.rested = set(), {}, set(), set()

    def _coincident(self, regime: Regime, active: list[bool], values: list[float], largest_sign: int) -> Guard | None:
        """Return the guard of a function that must still switch at the present time; None if there is no such function.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches. The function must still
        switch if the sign of the formula just after the present time is at most ``largest_sign``, which is -1 or 0.
        Functions that have switched at this time, or whose arguments are held at zero, are left out. ``active`` says
        for each guard of the smooth motion ``regime`` whether the motion ends where the guard is zero: the others are
        left out too. ``values`` are the parameters of the guards.
        """
        # Functions that switch at one time do so one after the other; the rates may have no value until the last one
        # has, such as a root of a negative argument.
        h = self.side * SHORT * self.span
        row = np.concatenate([[self.t, h, 0.0, h], self.y, np.zeros_like(self.y)])
        formulas = [guard.formula for guard in regime.guards]
        signs, _ = signs_at_ends(regime.path, formulas, values, Piece(np.array([self.t, self.t + h]), row[None]))
        guards = [
            (sign, guard)
            for guard, on, sign in zip(regime.guards, active, signs, strict=True)
            if on and sign <= largest_sign and guard.mode not in self.held and not self.flipped.get(guard.mode)
        ]
        return min(guards, key=lambda pair: pair[0])[1] if guards else None

    def _switch(self, regime: Regime, guard: Guard) -> None:
        """Change the value of the function (sign, floor, ..) whose guard has become zero, or hold its guard at zero."""
        mode, change = guard.mode, guard.change
        if mode in self.held:
            released = self._released_by_another()
            if released is None and (change == 0 or not self._still_attracts(regime)):
                raise self._not_unique()
            mode, change = released or (mode, change)
        self._change(mode, change)

    def _not_unique(self) -> IntegrationStopped:
        return IntegrationStopped(
            self.t,
            f"the motion slides along the jump of {self._names_of_held()} (the states stay at this jump), but from "
            "this time on nearby motions lead away from the jump: the motion can go on in several ways; end the motion "
            "at this time",
            self.end,
        )

    def _no_longer_held(self) -> None:
        """Stop holding x at zero in a function sign(x) if the switch of another function makes x leave zero.

        Raise IntegrationStopped if no held function can be released in this way: the continuation of the motion is then
        not unique.
        """
        released = self._released_by_another(solvable=False)
        if released is None:
            raise self._not_unique()
        self._change(*released)

    def _change(self, mode: str, change: int) -> None:
        """Change the value of the function (sign, floor, ..) that ``mode`` stands for, at the present time.

        A sign whose argument was held at zero gets the value ``change``, 1 or -1, and its argument is free again.
        Another sign changes to its opposite, or its argument is held at zero if the rates on both sides drive the
        argument back to zero. A floor changes by ``change``, or to its new value if its argument has jumped. Raise
        IntegrationStopped if the switches contradict each other, if the argument of a floor would have to stay at a
        jump, or if an argument would have to stay at zero backward in time.
        """
        kind = self.by_name[mode].kind
        self.left.add((mode, self.modes[mode]))
        self.visited.setdefault(self._state(), len(self.order))
        again = self.flipped.get(mode, 0)
        if again and self._jumped(mode):  # a mode in its guard changed too: the motion does not return
            again = 0
        # the rates before and after the change both drive the argument of a sign back to zero
        slides = kind == "sign" and again > 0 and mode not in self.held and self._returns(mode)
        self.order.append(mode)
        if len(self.order) > MOST_AT_ONCE or (slides and self._state(hold=mode) in self.visited):
            raise IntegrationStopped(
                self.t,
                f"the torque contradicts itself: whatever value {self._name(mode)} takes at this time, the resulting "
                "torque makes it switch to another value at once; change the torque, or end the motion at this time",
                self.end,
            )
        if again == 0:
            self._count()
        self.flipped[mode] = again + 1
        self.changes[self.now, self._name(mode)] = "released" if mode in self.held else "passed"
        asleep = self._asleep()
        if mode not in self.held:
            self.released = set()  # this switch changes the rates: arguments that left zero slowly may now cross it
        if mode in self.held:
            self.held -= {mode}
            self.modes |= _signed(self.system.twins[mode], change)
            self.released.update(twin for twin, _ in self.system.twins[mode])
        elif slides:
            self._hold(mode)
        elif kind == "sign":
            self.modes[mode] = -self.modes[mode]
        else:
            above = math.floor(self._guard_value(mode))
            far = abs(above) > 1  # the guard jumped over whole numbers
            self.modes[mode] += above if far else change
            if (mode, self.modes[mode]) in self.left:
                raise IntegrationStopped(
                    self.t,
                    f"the motion would slide along a jump of {self._name(mode)} (the states would stay at this jump); "
                    "symrot computes sliding only for functions that jump where their argument changes sign, such as "
                    "sign and step, not for floor and mod",
                    self.end,
                )
        for other in asleep - self._asleep():
            self._wake(other)

    def _leaves(self, mode: str, held: frozenset[str], modes: Modes) -> bool:
        """Return whether x, zero now, really gets the sign ``modes[mode]`` if sign(x) has this value from now on.

        ``mode`` is the name of the number that replaces sign(x) in the equations; this number determines the rates, and
        thus whether x becomes positive or negative. The other functions have the values in ``modes``, except that the
        arguments of the functions ``held`` stay at zero.
        """
        regime = self._regime(modes, held)
        rates, values = regime.bound(modes, self.zero)
        piece, _ = next(smooth_pieces(self, regime, rates).pieces())
        signs, _ = signs_at_ends(regime.path, [guard.formula for guard in regime.guards], values, piece)
        return all(sign > 0 for sign, guard in zip(signs, regime.guards, strict=True) if guard.mode == mode)

    def _released_by_another(self, solvable: bool = True) -> tuple[str, int] | None:
        """Return the pair (mode, new value) of a held sign(x) that the switch of another function now releases.

        The argument x was held at zero; the new value is 1 or -1. Return None if no function is released. ``solvable``
        says whether the held functions have values for which all their arguments stay at zero.
        """
        # without the other switch, the value of the mode that keeps the guard at zero says when the sliding ends
        for mode in sorted(self.held):
            twins = self.system.twins[mode]
            if set(self.order) <= {twin for twin, _ in twins}:
                continue
            held = self.held - {mode}
            sides = [sign for sign in (1, -1) if self._leaves(mode, held, self.modes | _signed(twins, sign))]
            if len(sides) == 1:
                return mode, sides[0]
            if not sides and not solvable:
                return mode, 1  # the guard stays at zero by itself
        return None

    def _returns(self, mode: str) -> bool:
        """Return whether a function such as sign(x) must be held at x = 0, because its switch would lead to a cycle.

        Several functions may switch one after the other at the present time. If this switch would return all of them to
        values that they have had before at this time, the switches would repeat without end. A function with only a
        kink, such as abs, is not held if a function with a jump is among the switches that would repeat.
        """
        first = self.visited.get(self._state(flip=mode))
        if first is None:
            return False
        jumps = any(not is_continuous(self.by_name[other]) for other in self.order[first:])
        return not (jumps and is_continuous(self.by_name[mode]))

    def _state(self, flip: str = "", hold: str = "") -> SwitchState:
        """Return the values of all functions (sign, ..) that are not held, and the names of the held functions.

        A held function has its argument fixed at zero. If named, the function ``flip`` first changes its sign, or the
        function ``hold`` is first added to the held functions.
        """
        modes = {**self.modes, flip: -self.modes[flip]} if flip else self.modes
        held = self.held | {self.system.twins[hold][0][0]} if hold else self.held
        return frozenset((mode, value) for mode, value in modes.items() if mode not in held), held

    def _jumped(self, mode: str) -> bool:
        """Return whether the argument of a function has jumped since the function last switched at the present time.

        ``mode`` stands for the function, which must have switched. The argument jumps if a function inside it switches:
        if sign(y) has switched after abs in abs(x + sign(y)), abs may switch again.
        """
        last = len(self.order) - self.order[::-1].index(mode)
        return bool(self._names_inside(mode) & set(self.order[last:]))

    def _is_rounding(
        self, regime: Regime, guard: Guard, piece: Piece, states: Callable[[Floats], Floats]
    ) -> bool:  # fmt: skip
        """Return whether a guard is negative at the start of ``piece``, a part of the motion, only by rounding.

        A guard is a formula that turns negative where a function (sign, floor, ..) switches. Return False if this
        function has not switched at the present time, or if its argument is held at zero.
        """
        # the guard is zero there, because its function has just switched
        if guard.mode in self.held or not self.flipped.get(guard.mode):
            return False
        # the function then must not switch again
        if guard.mode in regime.of_time:
            # a guard that depends on time alone can be computed a little later
            later = self.t + self.side * MOST_ULPS * math.ulp(self.zero.high)
            values = {**regime.values(self.modes, self.zero), "t": later}
            return float_value(parse(guard.formula), values) > 0.0
        return not self._jumped(guard.mode) and self._rises(regime, guard, piece, states)

    def _asleep(self) -> set[str]:
        """Return the names of the switching functions in branches of ``where`` that have no effect now."""
        # such as the sign in where(omega_1 > 0, sign(omega_2), 0) while omega_1 < 0
        return {s.mode for s in self.system.switches if s.where and not hold(s.where, self.modes, self.held)}

    def _wake(self, mode: str) -> None:
        """Compute the present value of a function such as sign(x) from x, and store the value.

        ``mode`` stands for the function. The stored value stays as it is if x has no value, or for a sign if x is zero.
        """
        # the motion begins to use the branch of where(..) with this function, whose changes were not followed before
        try:
            guard = self._guard_value(mode)
        except (ArithmeticError, ValueError, IntegrationStopped):
            # x has no value now: the mode stays
            return
        if self.by_name[mode].kind == "floor":
            self.modes[mode] += math.floor(guard)
        elif guard:
            self.modes[mode] = 1 if guard > 0.0 else -1

    def _hold(self, mode: str) -> None:
        if self.side < 0.0:
            raise IntegrationStopped(
                self.t,
                f"before this time, the motion would slide along the jump of {self._name(mode)} (the states would stay "
                "at this jump); symrot does not compute such a motion, because forward in time it can leave the jump "
                "at any time and on either side",
                self.end,
            )
        mode, _ = self.system.twins[mode][0]
        self.held |= {mode}
        self.changes[self.now, self._name(mode)] = "held"
        guard = self.by_name[mode].guard
        states = self.system.plan.states
        if guard[0] == "symbol" and guard[1] in states:
            self.y[states.index(guard[1])] = 0.0  # exactly zero, where the guard is a state
        self._regime(self.modes)

    def _comes_to_rest(self, regime: Regime) -> bool:
        """Release each held sign(x) for which the value 0 keeps x at zero, and set it to sign(0) = 0.

        The argument x then stays zero without being held, as omega of a body at rest that no torque drives.

        Only functions whose value at zero affects the motion are examined. Return whether a function was released.
        """
        # While x is held, the equations determine the value of sign(x), between -1 and 1, for which x remains zero.
        resting = [mode for mode in sorted(self.held - self.rested) if self.system.matters_at_zero(mode)]
        if resting:
            zeros = regime.zeros(self.modes, self.zero, self.y)
            vanishing = regime.motion.kernel.quantities.vanishing(zeros)
            resting = [mode for mode in resting if f"{mode} of t" in vanishing]
        self.rested.update(resting)
        self.held -= set(resting)
        for mode in resting:
            self.modes |= {twin: self.by_name[twin].at_zero for twin, _ in self.system.twins[mode]}
        return bool(resting)

    def _still_attracts(self, regime: Regime) -> bool:
        """Return whether nearby motions return to the sliding motion faster than numerical errors drive them away."""
        # if not, errors would decide to which side the motion leaves the switching surface
        now, least = regime.attraction(self.modes, self.zero, self.t, self.y), ERRORS * regime.motion.tolerance
        return all(value > least * first for value, first in zip(now, self.attraction[1], strict=True))

    def _leaves_zero(self, regime: Regime, active: list[bool], piece: Piece) -> bool:
        """Give each sign(x) with the value 0 the sign of x at the end of ``piece``; return whether a value changed.

        ``piece`` is an interval of the smooth motion ``regime``. A guard of this motion is a formula that turns
        negative where a function switches. ``active`` says for each guard whether its zero ends the motion; functions
        whose guards do not end it have no effect and are left out.
        """
        numbers = [
            n
            for n, (guard, on) in enumerate(zip(regime.guards, active, strict=True))
            if on and self.modes[guard.mode] == 0 and guard.mode not in self.held
            and self.by_name[guard.mode].kind == "sign"
        ]  # fmt: skip
        if not numbers:
            return False
        ones = {**self.modes, **{regime.guards[n].mode: 1 for n in numbers}}
        formulas = [guard.formula for guard in regime.guards]
        _, signs = signs_at_ends(regime.path, formulas, regime.bound(ones, self.zero)[1], piece)
        self.modes |= {regime.guards[n].mode: signs[n] for n in numbers if signs[n]}
        return any(signs[n] for n in numbers)

    def _settle(self, regime: Regime, active: list[bool], piece: Piece, states: Callable[[Floats], Floats]) -> bool:
        """Store the value at zero, such as 0 for sign(x), of each function whose argument x stays at zero.

        The values of all functions are stored in ``modes``. x stays at zero if it is zero at the start and at the end
        of ``piece``, the next interval of the motion. If x leaves zero, a sign(x) with the value 0 gets the sign of x.
        Return whether a value changed.

        ``states`` takes times in ``piece`` and returns the states. ``active`` says for each guard of the smooth motion
        ``regime``, a formula that turns negative where a function switches, whether its zero ends this motion;
        functions whose guards do not end it are left out.
        """
        formulas, settled = [guard.formula for guard in regime.guards], dict(self.modes)

        def signs_under(modes: Modes) -> list[int]:
            return signs_at_ends(regime.path, formulas, regime.bound(modes, self.zero)[1], piece)[0]

        signs_now = signs_under(self.modes)
        end = float(piece.edges[-1])
        later = end, states(np.array([end]))[0]  # a guard may leave zero so slowly that rounding hides it
        for switch in self.system.switches:
            mode = switch.mode
            numbers = [n for n, guard in enumerate(regime.guards) if guard.mode == mode and active[n]]
            if mode in self.held or not numbers:
                continue
            resting = switch.kind == "sign" and self.modes[mode] == 0  # then its mode times its guard is zero
            signs = signs_under({**self.modes, mode: 1}) if resting else signs_now
            sign = signs[numbers[0]]
            if switch.kind == "floor":  # at n + 1 the floor is n + 1
                upper = signs[numbers[1]]
                if not upper and self._guard_value(mode) == 1.0:
                    settled[mode] = self.modes[mode] + 1
                continue
            if sign and self.modes[mode] == 0:
                settled[mode] = sign
            # zero at the start and at the end of piece, the next interval of the motion
            elif not sign and self._guard_value(mode) == 0.0 == self._guard_value(mode, later):
                settled[mode] = switch.at_zero
        changed = [mode for mode, value in settled.items() if value != self.modes[mode]]
        if changed:
            self.order += changed
            self.settled += 1
            if self.settled > MOST_SWITCHES:
                raise IntegrationStopped(
                    self.t,
                    f"the torque switches again and again without end: more than {MOST_SWITCHES} times, the argument "
                    "of a function such as sign came to rest exactly where the function switches, or left this value; "
                    "change the torque, or end the motion at this time",
                    self.end,
                )
        self.modes = settled
        return bool(changed)

    def _check_held_alone(self) -> None:
        """Raise IntegrationStopped if the motion slides along the jumps of two functions at once.

        Where the argument of a sign is held at zero, the equations determine the value of the sign. If the argument of
        another function with a jump is zero at the same states, its value at the jump is not determined.
        """
        # The equations determine one value between -1 and 1 for a held sign, not the two values in sign(omega_1) +
        # sign(omega_1 + omega_1^3), whose arguments are zero together.
        y = self.y.tolist()
        steps = [PERTURBATION * max(abs(self.t), self.span), *(PERTURBATION * max(1.0, abs(x)) for x in y)]

        def gradient(mode: str) -> Floats:
            slopes = []
            for k, h in enumerate(steps):
                sides = []
                for sign in (1.0, -1.0):
                    place = [self.t, *y]
                    place[k] += sign * h
                    sides.append(self._guard_value(mode, (place[0], np.array(place[1:]))))
                slopes.append((sides[0] - sides[1]) / 2.0)
            return np.array(slopes)

        arguments = CHANGING & set().union(*(names(self.by_name[mode].guard) for mode in self.held))
        tied, slopes = self.system.tied(self.held), [gradient(mode) for mode in sorted(self.held)]
        for switch in self.system.switches:
            mode = switch.mode
            if mode in self.held or mode in tied or mode in self.system.settled or is_continuous(switch):
                continue
            if not hold(switch.where, self.modes, self.held) or not names(switch.guard) & arguments:
                continue
            value = self._guard_value(mode)
            distance = min(abs(value), abs(1.0 - value)) if switch.kind == "floor" else abs(value)
            own = gradient(mode)
            size = float(np.abs(own).max())
            if distance > size:
                continue
            basis = np.array(slopes).T
            rest = own - basis @ np.linalg.lstsq(basis, own, rcond=None)[0]
            if float(np.abs(rest).max()) <= PARALLEL * size:
                functions = f"{self._names_of_held()} and {self._name(mode)} at once"
                raise IntegrationStopped(
                    self.t,
                    f"the motion would slide along the jumps of {functions} (the states would stay at these jumps), "
                    f"which symrot cannot compute: the equations do not determine the value of {self._name(mode)}; "
                    "change the torque, or end the motion at this time",
                    self.end,
                )


def _signed(twins: Sequence[tuple[str, int]], sign: int) -> Modes:
    """Return the values, by name, of functions (sign, abs, ..) whose arguments are zero together.

    ``twins`` has a pair (name, 1 or -1) for each function; its value is ``sign`` times this number.
    """
    return {twin: sign * relative for twin, relative in twins}
