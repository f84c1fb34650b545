"""Derivatives of the times of events with respect to initial values and constants.

At an event g(t, x) = 0. If a variable v changes, the state x changes by S dv, and the zero moves by dt with ``(dg/dt)
dt + (grad g) S dv = 0``; dg/dt is the derivative along the motion.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from symrot.codegen.duals import Dual, dual_functions
from symrot.errors import InputError
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.switches import STATES
from symrot.formula.tree import evaluate, operations
from symrot.propagation.events.event import Event

__all__ = ["TOUCHING", "along_motion", "event_time_slopes", "require_smooth_events"]

Floats = NDArray[np.float64]
TOUCHING = "touching"


def require_smooth_events(events: Sequence[Event]) -> None:
    """Raise InputError if the formula of an event contains abs, which has no derivative at zero."""
    for event in events:
        if operations(event.node)["abs"]:
            raise InputError(f"events: expected formulas without abs, for sensitivities, got {event.formula!r}")


def event_time_slopes(
    event: Event, kinds: Sequence[str], times: Floats, states: Floats, rates: Floats, slopes: Floats
) -> Floats:
    """Return the derivatives of the k times of an event with respect to m variables, shape (k, m).

    Their units are s per unit of the variable.

    Parameters
    ----------
    event : Event
        The event.
    kinds : k texts
        The kind of each zero. A zero at which the formula touches zero, or has a rate of zero, has no derivative: its
        row is NaN.
    times : array, shape (k,)
        The times of the event, s.
    states, rates : arrays, shape (k, 7)
        The states omega and quaternion at these times, and their time derivatives.
    slopes : array, shape (k, 7, m)
        The derivatives of the states with respect to the variables, at fixed time.

    Examples
    --------
    For ``omega_3 - 1`` and a body whose omega_3 grows by 2 rad/s^2, a start that is faster by 1 rad/s reaches the event
    half a second earlier:

    >>> rows = np.zeros((1, 7)), np.array([[0.0, 0, 2, 0, 0, 0, 0]]), np.zeros((1, 7, 1))
    >>> rows[2][0, 2, 0] = 1.0
    >>> event_time_slopes(Event("omega_3 - 1"), ["rising"], np.array([0.5]), *rows)
    array([[-0.5]])
    """
    result = np.full((len(times), slopes.shape[2]), np.nan)
    for k, kind in enumerate(kinds):
        if kind == TOUCHING:
            continue
        by_time, gradient = _gradient(event, float(times[k]), states[k])
        along = by_time + gradient @ rates[k]
        if along:
            result[k] = -(gradient @ slopes[k]) / along
    return result


def along_motion(event: Event, time: float, state: Floats, rates: Floats) -> float:
    """Return the time derivative of the formula of an event along a motion with a given state and its rates."""
    by_time, gradient = _gradient(event, time, state)
    return by_time + float(gradient @ rates)


def _gradient(event: Event, time: float, state: Floats) -> tuple[float, Floats]:
    """Return the derivatives of the formula of an event with respect to time and the seven states."""
    values = {name: Dual(float(x), {name: 1.0}) for name, x in zip(STATES, state, strict=True)}
    values["t"] = Dual(time, {"t": 1.0})
    formula = evaluate(event.node, values, dual_functions(FLOAT_FUNCTIONS), float)
    return float(formula.slopes.get("t", 0.0)), np.array([formula.slopes.get(name, 0.0) for name in STATES])
