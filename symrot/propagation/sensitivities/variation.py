"""Variational equations: the derivatives of a motion with respect to initial values and constants of the scene.

Motion and derivatives are one system of differential equations, integrated by Taylor series in common steps. The
derivatives of all states with respect to one variable are a *column* of the matrix of derivatives.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import frexp, ldexp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.dynamics.structure import FieldTorque, FormulaTorque, InertiaTensor, Pattern, PrincipalInertia, Structure
from symrot.errors import PropagationError
from symrot.formula import exact_numbers as number
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.switches import STATES
from symrot.planning.general_structure import PRODUCTS, constants_of, general_structure, switched
from symrot.planning.plan import Plan
from symrot.planning.rules import UNIT_FIELDS, pattern
from symrot.planning.scene_kernel import EPOCH, Parameters
from symrot.propagation.binding import value_of
from symrot.propagation.events.event_result import EventResult
from symrot.propagation.sensitivities.event_times import event_time_slopes
from symrot.propagation.sensitivities.libraries import RATES, MotionLibrary, rates_of
from symrot.propagation.sensitivities.variables import Variable, difference, read_variables
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.time_shift import starts_far
from symrot.results.sensitivity import SwitchSlopes
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = [
    "AT_ONCE",
    "SMALL",
    "STATES",
    "TRIES",
    "Column",
    "SmoothEquations",
    "columns_of",
    "fitting_unit",
    "follow_columns",
    "follow_interval",
    "groups_of_columns",
    "rotation_slopes",
    "small_rotation",
    "structure_of",
    "unit_of",
]

Floats = NDArray[np.float64]
AT_ONCE = 6  # columns in one library: many more would take a compiler too long
SMALL = 2.0**-6  # a column that stays below this size is multiplied by a larger unit and integrated again
TRIES = 4


# ------------------------------------------------------------------------------------------------ columns


# The equations assume nothing about numbers that a variable can change: the derivative with respect to a moment of
# inertia needs the equations of a body without symmetry.
class Column:
    """The dependence of a scene on one variable, an initial value or a constant.

    ``start`` has the derivatives of the initial state with respect to the variable, ``constants`` the derivatives of
    the constants in the equations.
    """

    def __init__(self, scene: Scene, variable: Variable, general: Structure) -> None:
        self.variable = variable
        # by name, without those that are zero
        self.constants: Mapping[str, Fraction] = {}
        # self.start: the derivatives of omega and quaternion, 7 numbers
        if variable.moved is None:
            self.start = self.start_from(scene.initial)
            return
        every = difference(scene, variable, lambda other: {**_start(other), **constants_of(other, general)})
        self.start = [float(every.pop(name, 0)) for name in map(_initial, STATES)]
        self.constants = every

    def start_from(self, initial: Initial) -> list[float]:
        """Return the 7 derivatives of an initial state, omega and quaternion, with respect to :attr:`variable`."""
        # only the derivatives with respect to a small rotation of the attitude depend on the initial state
        if self.variable.moved is not None:
            return self.start
        slopes = rotation_slopes(initial.quaternion, self.variable.axis)
        return [0.0] * RATES + [float(slope) for slope in slopes]

    @property
    def restartable(self) -> bool:
        """Whether :attr:`constants` stay valid if the scene gets another initial state.

        From another initial state, the motion and its derivatives then have the same equations, and only their initial
        values differ.
        """
        # not for a variable that sets the initial state in another form, such as initial.attitude.angle
        variable = self.variable
        return variable.moved is None or variable.key.startswith("omega") or not any(self.start)


def rotation_slopes(q: Any, axis: int) -> Any:
    """Return the derivative of a quaternion with respect to a small rotation about the body axis 0, 1 or 2."""
    # half the product of the quaternion and the unit vector of the axis, of fractions or arrays
    q0, *v = q
    slopes = [-v[axis], *(v[i - 2] * ((i - 1) % 3 == axis) - v[i - 1] * ((i - 2) % 3 == axis) for i in range(3))]
    slopes[1 + axis] += q0
    return np.array(slopes) / 2


def _initial(state: str) -> str:
    return f"initial {state}"


def _start(scene: Scene) -> dict[str, Fraction]:
    """Return the initial values of the seven states, by names such as ``"initial omega_1"`` and ``"initial q0"``."""
    # "initial" keeps them apart from the constants of the scene, of which one may be called omega_1
    return dict(zip(map(_initial, STATES), (*scene.initial.omega_b, *scene.initial.quaternion), strict=True))


def columns_of(scene: Scene, variables: Sequence[Variable]) -> list[Column]:
    """Return, for each variable, how the initial state and the constants of the scene depend on it."""
    general = general_structure(scene, switched(scene))
    return [Column(scene, variable, general) for variable in variables]


def structure_of(scene: Scene, columns: Sequence[Column], varying: Collection[str] = ()) -> Structure:
    """Return the structure of the equations of motion and derivatives: which constants are zero, equal or free.

    The constants that depend on a variable, and the constants ``varying``, are free whatever their present values: they
    are parameters of the equations. ``columns`` has one :class:`Column` for each variable.
    """
    # The variational equations contain the derivatives of the rates with respect to the constants that depend on a
    # variable. The constants ``varying`` differ between the motions of an ensemble. Other zeros and ones simplify the
    # equations.
    moving = {name for column in columns for name in column.constants} | set(varying)
    general, inertia = general_structure(scene, switched(scene)), scene.body.inertia
    nonzero = {name for name, (i, j) in PRODUCTS.items() if inertia[i][j] != 0 or name in moving}
    entries = tuple(name for name in general.inertia.entries if name not in PRODUCTS or name in nonzero)  # type: ignore[union-attr]
    torques: list[FieldTorque | FormulaTorque] = []
    for torque, own in zip(general.torques, scene.torques, strict=True):
        if isinstance(torque, FormulaTorque):
            torques.append(torque)
            continue
        fields = []
        for name, field in torque.fields:
            if isinstance(field, tuple):
                first = 0 if len(field) == 4 else 1
                names = [f"{torque.prefix}{name}_{place}" for place, _ in enumerate(field, start=first)]
                field = tuple(
                    Pattern.FREE if each in moving else pattern(value, unit=name in UNIT_FIELDS)
                    for each, value in zip(names, own.vector(name), strict=True)
                )
            fields.append((name, field))
        torques.append(torque._replace(fields=tuple(fields)))
    tensor = InertiaTensor(entries) if nonzero else PrincipalInertia()
    return replace(general, inertia=tensor, torques=tuple(torques))


# ------------------------------------------------------------------------------------------------ motions


class SmoothEquations:
    """The compiled equations of a scene's motion, from any initial state, and of its derivatives.

    The argument ``keys`` names initial values and constants of the scene, such as ``"omega"`` or ``"body.mass"``. Their
    m components are the variables, with respect to which the motion is differentiated.
    """

    def __init__(self, scene: Scene, keys: Sequence[str]) -> None:
        self.scene, self.keys, self.variables = scene, keys, read_variables(scene, keys)
        columns = columns_of(scene, self.variables)
        self.restartable = all(column.restartable for column in columns)
        self._columns, self._groups = columns, _groups(scene, columns)
        self._uses_time = any(group.uses_time for group in self._groups)
        self._moved: tuple[float, list[_Group]] = (0.0, self._groups)

    def fit(self, scene: Scene, keys: Sequence[str]) -> bool:
        """Return whether these equations are those of the motion of ``scene`` and of its derivatives.

        The derivatives are those with respect to the variables ``keys``.
        """
        own = self.scene
        same = (
            own.body is scene.body and own.torques is scene.torques and own.table is scene.table and keys == self.keys
        )
        return same and (self.restartable or own.initial == scene.initial)

    def follow(self, scene: Scene, times: Floats, begin: float | None = None) -> tuple[Floats, Floats]:
        """Return the states at n times, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables, the components of :attr:`keys`. ``begin``, s, is the
        initial time.
        """
        begin = float(scene.span.start) if begin is None else begin
        groups, epoch = self._chosen(begin, times)
        results = [group.follow(scene, times, begin, epoch) for group in groups]
        return results[0][0], np.concatenate([slopes for _, slopes in results], axis=2)

    def event_slopes(self, scene: Scene, result: EventResult, tolerance: float) -> tuple[Floats, ...]:
        """Return, for each event, the derivatives of its k times with respect to the m variables, shape (k, m).

        ``result`` has the events of the motion. ``tolerance``, the tolerance with which the motion in ``result`` was
        computed, is not used: it matters only for torques that switch.
        """
        slopes = []
        for event, kinds, times in zip(result.events, result.kinds, result.t_events, strict=True):
            states, by = self.follow(scene, times)
            slopes.append(event_time_slopes(event, kinds, times, states, self._rates(scene, times, states), by))
        return tuple(slopes)

    def switchings(self, scene: Scene, times: Floats) -> tuple[SwitchSlopes, ...]:
        """Return no switches: the torques are smooth."""
        return ()

    def _rates(self, scene: Scene, times: Floats, states: Floats) -> Floats:
        """Return the time derivatives of the states of the motion of ``scene`` at n times, shape (n, 7)."""
        groups, epoch = self._chosen(float(scene.span.start), times)
        rows = [groups[0].rates(t, state) for t, state in zip(times - epoch, states, strict=True)]
        return np.array(rows).reshape(len(times), len(STATES))

    def _chosen(self, begin: float, times: Floats) -> "tuple[list[_Group], float]":
        """Return the equations for a motion from ``begin``, s, and the scene time, s, from which they count time.

        They count time from ``begin`` if the motion is far from t = 0 and depends on time, else from 0.
        """
        if self._uses_time and len(times) and starts_far(begin, float(times.min()), float(times.max())):
            return self._groups_from(begin), begin
        return self._groups, 0.0

    def _groups_from(self, epoch: float) -> "list[_Group]":
        """Return the equations with time counted from an epoch, s; the equations for the last epoch are used again."""
        if epoch != self._moved[0]:
            self._moved = (epoch, _groups(self.scene, self._columns, epoch))
        return self._moved[1]


def _groups(scene: Scene, columns: Sequence[Column], epoch: float = 0.0) -> "list[_Group]":
    """Return the equations of a motion and its derivatives, with time counted from ``epoch``, s.

    The variables, one for each of ``columns``, are divided into groups; each group has its own equations and library.
    """
    return [_Group(scene, columns[own.start : own.stop], epoch) for own in groups_of_columns(len(columns))]


class _Group:
    """A compiled library that integrates a motion and its derivatives with respect to one group of variables.

    A group has at most :data:`AT_ONCE` variables.
    """

    def __init__(self, scene: Scene, columns: Sequence[Column], epoch: float) -> None:
        # epoch: the scene time, s, from which the equations count time
        structure = structure_of(scene, columns)
        plan = Plan(scene, replace(structure, clock=EPOCH) if epoch else structure, ())
        rates, parameters = rates_of(plan)
        self.uses_time, self._rates = rates.uses("t"), rates
        self._names = [name for name, _ in parameters]

        def numbers(other: Scene) -> dict[str, Fraction]:
            constants = {"pi": number.PI, EPOCH: Fraction(epoch), **constants_of(other, structure)}
            return {name: value_of(node, constants) for name, node in parameters}

        slopes = [difference(scene, column.variable, numbers) if column.constants else {} for column in columns]
        depends = [[name for name, _ in parameters if name in each] for each in slopes]
        self.columns, self._library = columns, MotionLibrary(plan, rates, depends)
        constants = {"pi": number.PI, EPOCH: Fraction(epoch), **constants_of(scene, structure)}
        self._values = [float(value_of(node, constants)) for _, node in parameters]
        self._slopes = [[float(each[name]) for name in names] for each, names in zip(slopes, depends, strict=True)]

    def rates(self, time: float, state: Floats) -> list[float]:
        """Return the time derivatives of the seven states at a time, s after the epoch of the equations."""
        values = dict(zip(self._names, self._values, strict=True)) | dict(zip(STATES, state.tolist(), strict=True))
        return list(self._rates.evaluate({**values, "t": float(time)}, FLOAT_FUNCTIONS, float).values())

    def follow(self, scene: Scene, times: Floats, begin: float, epoch: float) -> tuple[Floats, Floats]:
        """Return the states at n times, shape (n, 7), and their derivatives, shape (n, 7, m).

        The derivatives are those with respect to the m variables of this group. ``times`` and the initial time
        ``begin`` are times of the scene, s. ``epoch`` is the time of the scene, s, from which the equations of this
        group count time.
        """
        start = [float(value) for value in (*scene.initial.omega_b, *scene.initial.quaternion)]
        starts = [column.start_from(scene.initial) for column in self.columns]
        units = [unit_of(scene, column) for column in self.columns]

        def labelled(error: PropagationError) -> PropagationError:
            later = error.later(epoch) if isinstance(error, IntegrationStopped) else error
            return PropagationError(f"{scene.name}: sensitivities: {later}")

        states, derivatives, _ = follow_columns(
            self._library, self._values, self._slopes, start, starts, units, begin - epoch, times - epoch, labelled
        )
        return states, derivatives


def follow_columns(
    library: MotionLibrary,
    values: Sequence[float],
    slopes: Sequence[Sequence[float]],
    start: Sequence[float],
    starts: Sequence[Sequence[float]],
    units: Sequence[float],
    begin: float,
    times: Floats,
    labelled: Callable[[PropagationError], PropagationError],
) -> tuple[Floats, Floats, list[float]]:
    """Return states at n times, shape (n, 7), their derivatives, (n, 7, m), and the units of the last integration.

    The derivatives are those with respect to m variables. During integration they are multiplied by units. If the
    derivatives with respect to a variable stay so small that the error control hardly notices them, the motion is
    integrated again with a larger unit; derivatives are returned without units.

    Parameters
    ----------
    library : MotionLibrary
        The code that integrates motion and derivatives.
    values, slopes : sequences
        The parameters of the rates; and for each variable, the derivatives with respect to it of those parameters that
        depend on it.
    start, starts : sequences
        The states at the time ``begin``; and for each variable, the derivatives of these states with respect to it.
    units : m numbers
        For each variable, a power of two near its size: the unit by which its derivatives are multiplied at first.
    begin : float
        Initial time, s, on the clock of the library.
    times : array, shape (n,)
        Sample times, s, on the same clock.
    labelled : function
        Takes the error of a motion that stops early, and returns the error to raise.
    """
    # Each column is multiplied by its unit. If it then stays below SMALL, the control of errors hardly sees it: the
    # motion is integrated again with a larger unit.
    units, size = list(units), len(STATES)
    for attempt in range(TRIES):
        state, p = list(start), list(values)
        for unit, own, by in zip(units, starts, slopes, strict=True):
            state += [unit * slope for slope in own]
            p += [unit * slope for slope in by]
        try:
            samples = library.sample(p, state, begin, times)
        except PropagationError as error:
            raise labelled(error) from None
        derivatives = samples[:, size:].reshape(len(times), len(starts), size)
        largest = np.max(np.abs(derivatives[:, :, RATES:]), axis=(0, 2), initial=0.0)
        small = [k for k, reached in enumerate(largest.tolist()) if 0.0 < reached < SMALL]
        if not small or attempt == TRIES - 1:
            break
        for k in small:
            units[k] = ldexp(units[k], 1 - frexp(largest[k])[1])
    scaled = derivatives / np.array(units)[None, :, None]
    return samples[:, :size], np.ascontiguousarray(scaled.transpose(0, 2, 1)), units


def follow_interval(
    libraries: Iterable[tuple[range, Sequence[Sequence[str]], MotionLibrary]],
    parameters: Parameters,
    values: Mapping[str, float],
    rows: Mapping[str, Sequence[float]],
    y: Floats,
    by: Floats,
    units: list[float],
    begin: float,
    times: Floats,
    labelled: Callable[[PropagationError], PropagationError],
) -> tuple[Floats, Floats]:
    """Return states at n times of an interval, shape (n, 7), and their derivatives, shape (n, 7, m).

    The derivatives are those with respect to the m variables.

    Parameters
    ----------
    libraries : iterable of (range, sequences of str, MotionLibrary)
        For each group of variables: their indices from 0 to m - 1, the names of the parameters that depend on each
        variable, and the code that integrates the motion and its derivatives with respect to these variables.
    parameters : pairs of name and formula
        The parameters of the rates, in order.
    values, rows : mappings
        Name of a parameter -> its value; name of a parameter -> its m derivatives, if it depends on a variable.
    y, by : arrays, shapes (7,) and (7, m)
        States at the time ``begin``, and their derivatives with respect to the variables.
    units : list of m floats
        For each variable, a power of two near its size: the unit by which its derivatives are multiplied at first. If a
        unit makes the derivatives too large or too small, another one replaces it. The list is changed in place to the
        units of the last integration, with which the next interval begins.
    begin, times, labelled
        As for :func:`follow_columns`: initial time, sample times, and the function that returns the error to raise.
    """
    numbers, results = [values[name] for name, _ in parameters], []
    for places, depends, library in libraries:
        slopes = [
            [rows[name][k] if name in rows else 0.0 for name in own] for k, own in zip(places, depends, strict=True)
        ]
        starts, own = [by[:, k].tolist() for k in places], [fitting_unit(units[k], by[:, k]) for k in places]
        states, derivatives, used = follow_columns(
            library, numbers, slopes, y.tolist(), starts, own, begin, times, labelled
        )
        units[places.start : places.stop] = used
        results.append((states, derivatives))
    return results[0][0], np.concatenate([derivatives for _, derivatives in results], axis=2)


def groups_of_columns(count: int) -> Iterator[range]:
    """Yield the indices 0 to ``count - 1`` of variables in ranges of at most :data:`AT_ONCE` indices.

    One compiled library integrates the derivatives with respect to the variables of one range.
    """
    for first in range(0, count, AT_ONCE):
        yield range(first, min(first + AT_ONCE, count))


def unit_of(scene: Scene, column: Column) -> float:
    """Return a power of two near the value of a variable, by which the derivatives with respect to it are multiplied.

    The multiplied derivatives are about as large as the states. For a component of omega, the power is near the largest
    component. It is 1 if the variable is zero, or if the variable is a small rotation of the initial attitude.
    """
    # a column times this number is about as large as the states, so that one error control fits both
    value = abs(float(column.variable.value))
    if column.variable.key.startswith("omega"):
        # the largest component of omega, for each component
        value = max(abs(float(rate)) for rate in scene.initial.omega_b)
    return ldexp(1.0, frexp(value)[1]) if value and column.variable.moved is not None else 1.0


def fitting_unit(unit: float, by: Floats) -> float:
    """Return a factor for the derivatives ``by``: ``unit``, or a power of two if ``unit`` is too large.

    ``unit`` is too large if its product with a derivative exceeds 2. With the power of two, the largest product is at
    least 1 and less than 2.
    """
    largest = float(np.abs(by).max())
    return ldexp(1.0, 1 - frexp(largest)[1]) if largest * unit > 2.0 else unit


def small_rotation(q: Floats, slopes: Floats) -> Floats:
    """Return derivatives of the attitude as small rotations about the body axes: ``2 * conjugate(q) * slopes``.

    ``slopes`` are the derivatives of the quaternions ``q`` with respect to m variables. The shapes are (n, 4) for
    ``q``, (n, 4, m) for ``slopes`` and (n, 3, m) for the result.
    """
    scalar, vector = q[:, :1, None], q[:, 1:, None]
    along, across = slopes[:, :1], slopes[:, 1:]
    return 2.0 * (scalar * across - vector * along - np.cross(vector, across, axis=1))
