"""Derivatives of motions under a torque that is given by a table of samples.

Between two samples the torque is a cubic polynomial of time. So the equations are those of a torque with a formula
whose coefficients change from one interval to the next. All samples have fixed times, so nothing jumps there. The
coefficients are linear in the samples: their derivatives with respect to a sample are the splines of a table that is 1
at this sample and 0 elsewhere.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.dynamics.torque_kinds import TABLE_KIND
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.switches import STATES
from symrot.formula.tree import names, parse
from symrot.planning.general_structure import constants_of
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH
from symrot.propagation.binding import value_of
from symrot.propagation.events.event_result import EventResult
from symrot.propagation.sensitivities.event_times import event_time_slopes
from symrot.propagation.sensitivities.libraries import MotionLibrary, rates_of
from symrot.propagation.sensitivities.parameter_slopes import ParameterSlopes, Rows
from symrot.propagation.sensitivities.variables import Variable, read_variables
from symrot.propagation.sensitivities.variation import (
    columns_of,
    follow_interval,
    groups_of_columns,
    structure_of,
    unit_of,
)
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.table_splines import table_splines
from symrot.results.sensitivity import SwitchSlopes
from symrot.scene.changes import path_of
from symrot.scene.samples import Table
from symrot.scene.scene import Scene
from symrot.scene.torque import Torque

__all__ = ["TableEquations"]

Floats = NDArray[np.float64]
KNOT = "table_knot"
COEFFICIENTS = tuple(f"table_{axis}_{power}" for axis in (1, 2, 3) for power in (3, 2, 1, 0))
"""The names of the coefficients of the cubic polynomials that replace the torque table in one of its intervals.

``table_2_3`` is the coefficient of the third power of time for component 2 of the torque.
"""
MOST_BOUND = 5000  # intervals whose parameters are stored


def _others_use_time(scene: Scene) -> bool:
    """Return whether a torque of the scene depends on time, apart from the torque given by a table of samples."""
    formulas = [parse(formula, switching=True) for torque in scene.torques for formula in torque.formulas]
    return "gravity_gradient" in scene.torque_kinds or any("t" in names(formula) for formula in formulas)


def _formula(axis: int, tau: str) -> str:
    third, second, first, constant = COEFFICIENTS[4 * axis : 4 * axis + 4]
    return f"{constant} + {tau}*({first} + {tau}*({second} + {tau}*{third}))"


def _with_formulas(scene: Scene) -> Scene:
    """Return a scene in which a torque with formulas replaces the torque given by a table of samples.

    The formulas are cubic polynomials of time. Their coefficients, the constants :data:`COEFFICIENTS`, are 0 in this
    scene; the values for an interval of the table are inserted when the motion is computed.
    """
    assert scene.table is not None
    values = dict.fromkeys(COEFFICIENTS, Fraction(0))
    # the clock of an interval shows 0 at its start; if other torques depend on time, its epoch is a constant
    timed = _others_use_time(scene)
    values |= {KNOT: Fraction(0)} if timed else {}
    formulas = tuple(_formula(axis, f"(t - {KNOT})" if timed else "t") for axis in range(3))
    torque = Torque("expression", values, formulas, scene.table.frame)
    return replace(scene, table=None, torques=(*scene.torques, torque))


class TableEquations:
    """The equations of a motion under a torque given by a table of samples, and of its derivatives.

    The argument ``keys`` names initial values and constants of the scene, such as ``"omega"`` or ``"body.mass"``. Their
    m components are the variables; the derivatives are those with respect to the variables.
    """

    def __init__(self, scene: Scene, keys: Sequence[str]) -> None:
        self.scene, self.keys, self.variables = scene, keys, read_variables(scene, keys)
        assert scene.table is not None
        own = _with_formulas(scene)
        samples = [_sample_of(scene, variable) for variable in self.variables]
        moving = [_replaced(variable, sample) for variable, sample in zip(self.variables, samples, strict=True)]
        self._columns = columns_of(own, moving)
        self.restartable = all(column.restartable for column in self._columns)
        structure = structure_of(own, self._columns)
        timed = _others_use_time(scene)
        self._plan = Plan(own, replace(structure, clock=EPOCH) if timed else structure, ())
        self._rates, self._parameters = rates_of(self._plan)
        self._constants = {"pi": number.PI, **constants_of(own, structure)}
        self._table, self._pieces = scene.table, _Pieces(scene.table)
        # for a variable that is a sample: the splines of the table in which it alone is 1
        unit_tables = [None if sample is None else _Pieces(_unit_table(scene.table, *sample)) for sample in samples]
        slopes = ParameterSlopes(own, self._columns, structure)

        def at(k: int) -> ParameterSlopes:
            return slopes.with_changes([{} if unit is None else unit.coefficients(k) for unit in unit_tables])

        self._slopes_at = at
        self._libraries = []
        for places in groups_of_columns(len(self._columns)):
            depends = [at(0).depends(self._parameters, k) for k in places]
            self._libraries.append((places, depends, MotionLibrary(self._plan, self._rates, depends)))
        self._bound: dict[int, tuple[dict[str, float], Rows]] = {}

    def fit(self, scene: Scene, keys: Sequence[str]) -> bool:
        """Return whether these equations are those of the motion of ``scene`` and of its derivatives.

        The derivatives are those with respect to the variables ``keys``.
        """
        own = self.scene
        same = own.body is scene.body and own.torques is scene.torques and own.table is scene.table
        return same and keys == self.keys and (self.restartable or own.initial == scene.initial)

    def follow(self, scene: Scene, times: Floats, begin: float | None = None) -> tuple[Floats, Floats]:
        """Return the states at n times, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables. ``begin``, s, is the initial time.
        """
        begin = float(scene.span.start) if begin is None else begin
        self._require_inside(np.append(times, begin))
        start = np.array([float(x) for x in (*scene.initial.omega_b, *scene.initial.quaternion)])
        columns = np.array([column.start_from(scene.initial) for column in self._columns]).T
        states, by = np.tile(start, (len(times), 1)), np.tile(columns, (len(times), 1, 1))
        for side in (1.0, -1.0):
            order = np.flatnonzero(side * times > side * begin)
            order = order[np.argsort(side * times[order], kind="stable")]
            if len(order):
                states[order], by[order] = self._one_way(scene, start, columns, begin, times[order], side)
        return states, by

    def _one_way(
        self, scene: Scene, y: Floats, by: Floats, begin: float, times: Floats, side: float
    ) -> tuple[Floats, Floats]:
        """Return the states at n ``times``, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables. ``y`` and ``by`` are states and derivatives at the
        time ``begin``, s. All times lie on one side of ``begin``: later and increasing if ``side`` is 1, earlier and
        decreasing if ``side`` is -1.
        """
        edges, units = self._pieces.edges, [unit_of(scene, column) for column in self._columns]
        all_states, all_by, done, now = [], [], 0, begin
        while done < len(times):
            k = self._pieces.at(now, side)
            end = float(edges[k + 1] if side > 0.0 else edges[k])
            last = int(np.searchsorted(side * times, side * end, "right"))
            inside = times[done:last]
            # the last time is that at which the next interval begins
            states, slopes = self._in_piece(k, y, by, now, np.append(inside, end), units)
            all_states.append(states[:-1])
            all_by.append(slopes[:-1])
            y, by, now, done = states[-1], slopes[-1], end, last
        return np.concatenate(all_states), np.concatenate(all_by)

    def _in_piece(
        self, k: int, y: Floats, by: Floats, begin: float, times: Floats, units: list[float]
    ) -> tuple[Floats, Floats]:
        """Return the states at n times in interval k of the torque's table, (n, 7), and their derivatives, (n, 7, m).

        The derivatives are those with respect to the m variables. ``y`` and ``by`` are states and derivatives at the
        time ``begin``, s. ``units`` has, for each variable, the power of two by which its derivatives are multiplied
        during integration. If derivatives turn out to be too large or too small for a power, the integration replaces
        it by another, also in the list ``units``, so that the next interval begins with it.
        """
        values, rows = self._numbers(k)
        knot = float(self._pieces.edges[k])

        def labelled(error: PropagationError) -> PropagationError:
            later = error.later(knot) if isinstance(error, IntegrationStopped) else error
            return PropagationError(f"{self.scene.name}: sensitivities: {later}")

        return follow_interval(
            self._libraries, self._parameters, values, rows, y, by, units, begin - knot, times - knot, labelled
        )

    def _numbers(self, k: int) -> tuple[dict[str, float], Rows]:
        """Return two dicts for interval k of the table: parameter -> value, and parameter -> its m derivatives.

        The derivatives are those with respect to the variables; parameters that depend on no variable are missing in
        the second dict.
        """
        if k not in self._bound:
            if len(self._bound) >= MOST_BOUND:
                self._bound.clear()
            knot = Fraction(float(self._pieces.edges[k]))
            constants = {**self._constants, **self._pieces.coefficients(k), KNOT: knot, EPOCH: knot}
            values = {name: float(value_of(formula, constants)) for name, formula in self._parameters}
            self._bound[k] = values, self._slopes_at(k).slopes_of(self._parameters, constants)
        return self._bound[k]

    def event_slopes(self, scene: Scene, result: EventResult, tolerance: float) -> tuple[Floats, ...]:
        """Return, for each event, the derivatives of its k times with respect to the m variables, shape (k, m).

        ``result`` has the events of the motion. ``tolerance``, the tolerance with which the motion in ``result`` was
        computed, is not used: it matters only for torques that switch.
        """
        slopes = []
        for event, kinds, times in zip(result.events, result.kinds, result.t_events, strict=True):
            states, by = self.follow(scene, times)
            rates = [self._rates_at(t, state) for t, state in zip(times.tolist(), states, strict=True)]
            slopes.append(
                event_time_slopes(event, kinds, times, states, np.array(rates).reshape(len(times), len(STATES)), by)
            )
        return tuple(slopes)

    def _rates_at(self, t: float, state: Floats) -> list[float]:
        """Return the time derivatives of the seven states at a time, s."""
        k = self._pieces.at(t, 1.0)
        values: dict[str, Any] = {**self._numbers(k)[0], **dict(zip(STATES, state.tolist(), strict=True))}
        values["t"] = t - float(self._pieces.edges[k])
        return list(self._rates.evaluate(values, FLOAT_FUNCTIONS, float).values())

    def switchings(self, scene: Scene, times: Floats) -> tuple[SwitchSlopes, ...]:
        """Return no switches: no variable changes the times at which a table jumps."""
        return ()

    def _require_inside(self, times: Floats) -> None:
        """Raise InputError if a time, s, lies beyond the table."""
        low, high = self._table.times[0], self._table.times[-1]
        beyond = times[(times < low) | (times > high)]
        if len(beyond):
            raise InputError(
                f"torque: expected times from {low} to {high} s, the span of the table, got {float(beyond[0])} s"
            )


class _Pieces:
    """The time intervals of a table of samples, each with three cubic polynomials, one per component of the torque.

    Interval k is from ``edges[k]`` to ``edges[k + 1]``, s.
    """

    def __init__(self, table: Table) -> None:
        splines = table_splines(np.array(table.times), np.array(table.moments), table.switching_times)
        self.edges: Floats = np.append(np.concatenate([spline.x[:-1] for spline in splines]), splines[-1].x[-1])
        # polynomials for each interval: component, then power
        self._polynomials = np.concatenate([np.moveaxis(spline.c, 0, 2) for spline in splines]).reshape(-1, 12)

    def at(self, t: float, side: float) -> int:
        """Return the index of the interval that a motion enters at the time t, s; ``side`` is -1 backward in time."""
        k = int(np.searchsorted(self.edges, t, "right" if side > 0.0 else "left")) - 1
        return min(max(k, 0), len(self.edges) - 2)

    def coefficients(self, k: int) -> Mapping[str, Fraction]:
        """Return the coefficients of the polynomials in the interval number k, by the names :data:`COEFFICIENTS`."""
        return dict(zip(COEFFICIENTS, map(Fraction, self._polynomials[k].tolist()), strict=True))


def _unit_table(table: Table, place: int, axis: int) -> Table:
    """Return a table with the same times whose samples are 0, except component ``axis`` of sample ``place``: 1."""
    zero, unit = (0.0, 0.0, 0.0), tuple(float(axis == i) for i in range(3))
    moments = tuple(unit if k == place else zero for k in range(len(table.times)))
    return table._replace(moments=moments)  # type: ignore[arg-type]


def _sample_of(scene: Scene, variable: Variable) -> tuple[int, int] | None:
    """Return the place of a variable in a torque's table of samples: (index of sample, index of component), from 0.

    Return None if the variable does not belong to the table.

    Raises
    ------
    InputError
        If the variable belongs to the table but is not a sample, for instance a time.
    """
    path = path_of(variable.key)
    if len(path) < 2 or path[0] != "torque" or scene.value(f"torque[{path[1]}].kind") != TABLE_KIND.kind:
        return None
    if path[2:3] != ("moment",) or not 4 <= len(path) <= 5:
        raise InputError(
            f"sensitivities: expected a sample of the table, such as torque[{path[1]}].moment[2], got {variable.key!r}"
        )
    component = path[4] if len(path) == 5 else int(variable.name.rpartition("_")[2]) - 1
    return int(path[3]), int(component)


def _replaced(variable: Variable, sample: tuple[int, int] | None) -> Variable:
    """Return ``variable`` adapted to the scene in which formulas replace the table of samples.

    The function ``moved`` of a variable returns the scene after a change of the variable. The function ``moved`` of the
    result returns this scene with formulas in place of the table. ``sample`` is None, or the place of the variable in
    the table: (index of sample, index of component). If the variable is such a sample, ``moved`` ignores the change,
    because :class:`TableEquations` computes how a sample changes the coefficients of the formulas.
    """
    moved = variable.moved
    if moved is None:
        return variable
    return replace(variable, moved=lambda size: _with_formulas(moved(size if sample is None else Fraction(0))))
