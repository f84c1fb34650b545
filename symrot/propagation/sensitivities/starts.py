"""The derivatives of the states just after the start of a motion, whose guards may be zero there.

A *guard* is the argument of a switching function (sign, abs, ..). The equations may hold a guard at zero from the start
on, as friction holds a body at rest. The derivatives are those with respect to the variables, which are initial values
and constants of the scene.
"""

from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from symrot.propagation.sensitivities.guards import ALIKE, Guards
from symrot.propagation.sensitivities.intervals import Interval
from symrot.propagation.sensitivities.sliding import beside, require_one_surface, rests

__all__ = ["from_start"]

Floats = NDArray[np.float64]


def from_start(guards: Guards, interval: Interval, by: Floats) -> Floats:
    """Return the derivatives of the seven states just after the start of a motion, shape (7, m).

    The derivatives are those with respect to the m variables; ``by`` has their values at the start. The result differs
    from ``by`` if friction, for example, holds a component of omega at zero from the start on: a component that starts
    near zero comes to zero at once, and its derivatives become zero. Raise PropagationError if the derivatives do not
    exist.
    """
    f = guards.rates(interval, interval.start, interval.first)
    for mode in interval.regime.formulas:
        if mode in interval.held:
            continue
        guard = guards.guard(interval, mode, interval.start, interval.first)
        # floor(x) also switches where x minus the present floor is 1
        ends = (0.0, 1.0) if guards.is_floor(mode) else (0.0,)
        if guard.value not in ends or rests(guards, interval, mode):
            continue
        other = interval.modes[mode] + (1 if guard.value else -1)
        _require_constant(guards, interval, mode, other, guard.change(by), f)
    held = sorted(interval.held)
    gradients = [guards.guard(interval, mode, interval.start, interval.first) for mode in held]
    changes = np.array([gradient.change(by) for gradient in gradients])
    if not changes.any():
        return by
    for mode in held:
        require_one_surface(guards, beside(guards, interval, {mode: 1}), mode, interval.start, interval.first)
    # A nearby start leads to the jumps at once. On the way, the rates are f + B s with modes s between -1 and 1;
    # the states change by B c, so that all guards return to zero.
    corners = {
        signs: guards.rates(
            beside(guards, interval, dict(zip(held, signs, strict=True))), interval.start, interval.first
        )
        for signs in product((1, -1), repeat=len(held))
    }
    first = corners[(1,) * len(held)]
    jumps = np.array([(first - corners[tuple(1 - 2 * (mode == other) for other in held)]) / 2.0 for mode in held]).T
    size = ALIKE * max(float(np.abs(rates).max()) for rates in corners.values())
    for signs, rates in corners.items():
        if np.abs(first + jumps @ (np.array(signs) - 1.0) - rates).max() > size:
            functions = " and ".join(map(guards.name, held))
            reason = "the change of the torque at one switch depends on the others"
            raise guards.refusal(interval.begin, f"{functions} switch at the same time: {reason}")
    return np.asarray(
        by - jumps @ np.linalg.solve(np.array([gradient.states for gradient in gradients]) @ jumps, changes)
    )


def _require_constant(guards: Guards, interval: Interval, mode: str, other: int, change: Floats, f: Floats) -> None:
    """Raise PropagationError if a motion starts at a jump of its rates and a variable shifts the start off the jump.

    The jump is that of a function (sign, floor, ..); ``mode`` is the name of the number that replaces it in formulas.
    ``change``: the m derivatives of the function's argument with respect to the variables; ``f``: the rates at the
    start; ``other``: for floor(x), the value on the other side of the jump, otherwise not used.
    """
    if not change.any() or guards.is_continuous(mode):
        return
    variable = guards.parameter_slopes.columns[int(np.flatnonzero(change)[0])].variable.name
    twins = guards.twins(mode)
    flipped = {twin: -interval.modes[twin] for twin, _ in twins}
    if guards.is_floor(mode):
        flipped = {mode: other}
    beyond = guards.rates(replace(interval, modes={**interval.modes, **flipped}), interval.start, interval.first)
    if not np.array_equal(beyond, f):
        raise guards.refusal(
            interval.begin,
            f"the motion starts where {guards.name(mode)} switches, so that a larger and a smaller {variable} have "
            f"different effects; make {variable} slightly larger or smaller",
        )
