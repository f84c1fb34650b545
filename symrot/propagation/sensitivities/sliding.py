"""Guards that stay at zero, because a sliding motion holds them there or because they rest there by chance.

A *guard* is the argument of a switching function (sign, abs, ..); its *mode* is the number that replaces the function
in formulas. A guard is *held* if the equations determine the mode by the condition that the guard stays at zero.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.propagation.sensitivities.guards import ALIKE, Guards
from symrot.propagation.sensitivities.intervals import Interval

__all__ = ["beside", "hold_at_rest", "refuse_resting", "require_one_surface", "rests"]

Floats = NDArray[np.float64]


def beside(guards: Guards, interval: Interval, signs: Mapping[str, int]) -> Interval:
    """Return a copy of an interval of the motion in which some functions sign(x) have fixed values.

    In the interval itself x stays at zero: the motion slides along the jump at x = 0. In the copy, the rates are those
    on one side of this jump. ``signs`` is a map from the mode of each such function (name of the number that replaces
    the function in formulas) to its value, 1 or -1.
    """
    twins = guards.system.twins
    modes = {**interval.modes, **{twin: own * sign for mode, sign in signs.items() for twin, own in twins[mode]}}
    held = interval.held - frozenset(signs)
    return replace(interval, regime=guards.system.regime(held, modes), modes=modes, held=held)


def hold_at_rest(guards: Guards, interval: Interval) -> None:
    """Change the equations of an interval so that arguments that stay at zero in the interval are kept at zero.

    The arguments (guards) are those of functions such as sign and abs. In the changed equations, the value of the
    function is the value that keeps its argument at zero. Where the equations do not determine such a value, the name
    of the function's mode, the number that replaces the function in formulas, is appended to ``interval.resting``
    instead; :func:`refuse_resting` later raises an error if a change of one of the variables makes the argument leave
    zero. Nothing changes for an argument if the rates and their derivatives are the same on both sides of its zero.
    """
    resting = [mode for mode in interval.regime.formulas if mode not in interval.held and rests(guards, interval, mode)]
    for mode in resting:
        # the square of the argument times its sign, for example, has a derivative at zero
        if _is_smooth_at(guards, interval, mode):
            continue
        held = interval.held | {guards.system.twins[mode][0][0]} if guards.is_sign(mode) else interval.held
        if interval.modes[mode] == 0 and held != interval.held:
            own = interval.regime, interval.held
            try:
                interval.regime, interval.held = guards.system.regime(held, interval.modes), held
                determined = bool(np.isfinite(guards.rates(interval, interval.start, interval.first)).all())
            except (InputError, ArithmeticError):
                determined = False
            if determined:
                continue
            interval.regime, interval.held = own
        interval.resting.append(mode)


def refuse_resting(
    guards: Guards, interval: Interval, integrate: Callable[[Interval, Floats], tuple[Floats, Floats]]
) -> None:
    """Raise PropagationError if a guard in ``interval.resting`` leaves zero when one of the variables changes.

    These guards, arguments of functions such as sign, stay at zero in the interval, though the equations do not keep
    them there. If a guard leaves zero, its function jumps or bends, and the motion has no derivatives. ``integrate``
    takes an interval and times, and returns the states and their derivatives at these times.
    """
    for mode in interval.resting:
        places = list(interval.places())
        _, every = integrate(interval, np.array([t for t, _ in places]))
        if any(guards.guard(interval, mode, *place).change(by).any() for place, by in zip(places, every, strict=True)):
            raise guards.refusal(interval.begin, f"the argument of {guards.name(mode)} stays at zero")


def rests(guards: Guards, interval: Interval, mode: str) -> bool:
    """Return whether the argument of a function (sign, abs, ..) is zero at start, middle and end of an interval.

    ``mode`` is the name of the number that replaces the function in formulas.
    """
    return all(guards.guard(interval, mode, *place).value == 0.0 for place in interval.places())


def _is_smooth_at(guards: Guards, interval: Interval, mode: str) -> bool:
    """Return whether the rates and their derivatives are the same for both signs of a guard that stays at zero.

    The guard is the argument of the function (sign, abs, ..) for which ``mode`` stands.
    """
    for t, y in interval.places():
        sides = []
        for sign in (1, -1):
            changed = {**interval.modes, **{twin: s * sign for twin, s in guards.twins(mode)}}
            if guards.is_floor(mode):
                changed = {**interval.modes, mode: interval.modes[mode] - (sign < 0)}
            sides.append(guards.rate_slopes(replace(interval, modes=changed), t, y))
        if not np.array_equal(sides[0], sides[1]):
            return False
    return True


def require_one_surface(guards: Guards, interval: Interval, mode: str, t: float, y: Floats) -> None:
    """Raise PropagationError if two functions switch at one time, but a small change of a variable separates them.

    The time is ``t``, the states are ``y``. Example: sign(omega_3 - c) and sign(omega_3 - d) with c = d. If c changes
    alone, the arguments become zero at different times. A motion slides along a jump while the argument stays at zero;
    it cannot keep both arguments at zero.

    ``mode`` is the name of the number that replaces one of the functions, a sign or abs, in formulas; its argument is
    zero at ``t``. It is compared with each function whose argument is a multiple of this argument as long as the
    variables keep their present values.
    """
    guard = guards.guard(interval, mode, t, y)
    own = np.array([guard.time, *guard.states, *guard.variables])
    for twin, _ in guards.twins(mode):
        if twin not in interval.regime.formulas:
            continue
        other = guards.guard(interval, twin, t, y)
        row = np.array([other.time, *other.states, *other.variables])
        if np.abs(own * (row @ own) - row * (own @ own)).max() > ALIKE * (own @ own) * np.abs(row).max():
            functions = f"{guards.name(mode)} and {guards.name(twin)}"
            reason = "a small change of a variable separates the switches, and the motion cannot slide along both jumps"
            raise guards.refusal(interval.zero.after(t), f"{functions} switch at the same time: {reason}")
