"""Derivatives of a motion with respect to initial values and constants of its scene.

They are computed at sample times, at events, and as transition matrix.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from symrot.planning.general_structure import switched
from symrot.propagation.events.event_result import EventResult
from symrot.propagation.sensitivities.libraries import RATES
from symrot.propagation.sensitivities.switched import SwitchedEquations
from symrot.propagation.sensitivities.tabulated import TableEquations
from symrot.propagation.sensitivities.variables import groups_of
from symrot.propagation.sensitivities.variation import SmoothEquations, small_rotation
from symrot.results.sensitivity import Sensitivities
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["event_slopes", "transition_matrix", "variation"]

Floats = NDArray[np.float64]
MOST_RECENT = 8
TRANSITION = ("omega", "attitude")
_Equations = SmoothEquations | SwitchedEquations | TableEquations


def variation(scene: Scene, keys: Sequence[str], times: Floats) -> Sensitivities:
    """Return the derivatives of omega, quaternion and attitude (small rotation about the body axes) at sample times.

    Parameters
    ----------
    scene : Scene
        The scene with the initial state of the motion.
    keys : sequence of str
        The variables, see :func:`symrot.propagation.sensitivities.variables.read_variables`.
    times : array, shape (n,)
        Sample times, s.

    Raises
    ------
    InputError
        If a key names no variable.
    PropagationError
        If the motion cannot be followed to the last time.
    """
    equations = _equations(scene, tuple(keys) if isinstance(keys, list) else keys)
    values, slopes = equations.follow(scene, times)
    omega, quaternion = slopes[:, :RATES], slopes[:, RATES:]
    variables = equations.variables
    return Sensitivities(
        tuple(variable.name for variable in variables),
        tuple(variable.unit for variable in variables),
        groups_of(variables),
        omega,
        quaternion,
        small_rotation(values[:, RATES:], quaternion),
        switchings=equations.switchings(scene, times),
    )


def event_slopes(scene: Scene, keys: Sequence[str], result: EventResult, tolerance: float) -> tuple[Floats, ...]:
    """Return, for each event, the derivatives of its k times with respect to the m variables ``keys``, shape (k, m).

    ``tolerance`` is the error of the motion of ``result``.
    """
    return _equations(scene, tuple(keys) if isinstance(keys, list) else keys).event_slopes(scene, result, tolerance)


def transition_matrix(scene: Scene, start: float, stop: float) -> Floats:
    """Return the state transition matrix of a scene's motion from ``start`` to ``stop``, s, shape (6, 6).

    The state is omega, then a small rotation about the body axes.
    """
    # both times in s, in any order; _equations raises InputError if the torques have no derivatives
    if start != float(scene.span.start):
        values, _ = _equations(scene, TRANSITION).follow(scene, np.array([start]))
        omega, q = values[0, :RATES], values[0, RATES:] / np.linalg.norm(values[0, RATES:])
        exact = [Fraction(x) for x in (*omega.tolist(), *q.tolist())]
        initial = Initial((exact[0], exact[1], exact[2]), (exact[3], exact[4], exact[5], exact[6]))
        scene = replace(scene, initial=initial)
    values, slopes = _equations(scene, TRANSITION).follow(scene, np.array([stop]), start)
    return np.concatenate([slopes[0, :RATES], small_rotation(values[:, RATES:], slopes[:, RATES:])[0]])


_recent: list[_Equations] = []
"""The equations that were used last; a propagator with another initial state needs the same ones again."""


def _equations(scene: Scene, keys: Sequence[str]) -> _Equations:
    """Return the equations of a scene's motion and its derivatives with respect to ``keys``; recent ones are reused."""
    equations = next((each for each in _recent if each.fit(scene, keys)), None)
    if equations is None:
        kind: type[_Equations] = SwitchedEquations if switched(scene) else SmoothEquations
        equations = (kind if scene.table is None else TableEquations)(scene, keys)
        _recent[:] = [equations, *_recent[: MOST_RECENT - 1]]
    return equations
