"""The derivatives of the motions of an ensemble with respect to initial values and constants, in SIMD lanes.

Motions under torques with jumps or kinks are followed one by one.

The variables are the initial values and constants with respect to which the motions are differentiated. A
:class:`Column` says how a scene depends on one of these variables. The equations are those of
:mod:`symrot.propagation.sensitivities.variation`. Every constant that varies in the ensemble is a parameter of the
equations, so the derivatives of a motion do not depend on the other motions.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from symrot.build import cache as library
from symrot.ensemble import lanes
from symrot.ensemble.motions import Problem
from symrot.ensemble.numbers import Numbers
from symrot.errors import InputError, PropagationError
from symrot.formula.program import Program
from symrot.planning.general_structure import constants_of, switched
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH
from symrot.propagation.compiled_models import needs_bounds
from symrot.propagation.sensitivities.libraries import (
    ORDER,
    RATES,
    TOLERANCE,
    MotionLibrary,
    rates_of,
    variation_source,
)
from symrot.propagation.sensitivities.variables import (
    ATTITUDE,
    Variable,
    difference,
    groups_of,
    read_variables,
    require_formulas,
)
from symrot.propagation.sensitivities.variation import (
    AT_ONCE,
    SMALL,
    STATES,
    TRIES,
    Column,
    columns_of,
    rotation_slopes,
    small_rotation,
    structure_of,
)
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import Floats
from symrot.propagation.time_shift import starts_far
from symrot.results.sensitivity import Sensitivities
from symrot.scene.scene import Scene

__all__ = ["follow_sensitivities", "read_columns"]

SIZE = len(STATES)
BLOCK = 1 << 22  # numbers of one block of motions that are in memory beside the result: 32 MB


def follow_sensitivities(problem: Problem, keys: Sequence[str]) -> tuple[Sensitivities, tuple[str, ...]]:
    """Return the derivatives of all motions of a problem, and for each motion why their computation stopped early.

    Parameters
    ----------
    problem : Problem
        The motions and the sample times.
    keys : sequence of str
        The variables, see :func:`symrot.propagation.sensitivities.variables.read_variables`.

    Returns
    -------
    Sensitivities, messages
        Arrays of the shapes (n, m, 3, k), (n, m, 4, k) and (n, m, 3, k) for n motions, m times and k variables; NaN at
        times that the computation did not reach for a motion. The message of a motion that reached all times is empty.

    Raises
    ------
    InputError
        If the torques have no derivatives, if a key names no variable, or if a variable, such as gravity, determines a
        constant, such as the weight, that differs between the motions.
    """
    variation, scene = problem.variation, problem.variation.scene
    own = [float(rate) for rate in scene.initial.omega_b]
    varying = [*variation.columns, *(["omega"] if (variation.omega != own).any() else [])]
    variables, columns = read_columns(
        scene, keys, [*varying, *([] if variation.quaternion is None else ["quaternion"])]
    )
    if switched(scene):
        return _follow_switched(problem, keys)
    count, samples = len(variation), problem.times.shape[-1]
    omega, quaternion, rotation = (np.full((count, samples, size, len(columns)), np.nan) for size in (3, 4, 3))
    messages = [""] * count
    for first in range(0, len(columns), AT_ONCE):
        some = slice(first, first + AT_ONCE)
        equations = _Equations(problem, columns[some])
        each = max(1, BLOCK // (max(1, samples) * SIZE * (1 + len(columns[some]))))
        for start in range(0, count, each):
            rows = np.arange(start, min(start + each, count))
            states, slopes, reasons = equations.follow(rows)
            block = slice(start, start + len(rows))
            omega[block, ..., some], quaternion[block, ..., some] = slopes[:, :, :RATES], slopes[:, :, RATES:]
            turned = small_rotation(
                states[..., RATES:].reshape(-1, 4), slopes[:, :, RATES:].reshape(-1, 4, len(columns[some]))
            )
            rotation[block, ..., some] = turned.reshape(*slopes.shape[:2], 3, slopes.shape[3])
            for row, reason in zip(rows.tolist(), reasons, strict=True):
                messages[row] = messages[row] or (reason and f"sensitivities: {reason}")
    return _labelled(variables, omega, quaternion, rotation), tuple(messages)


def _follow_switched(problem: Problem, keys: Sequence[str]) -> tuple[Sensitivities, tuple[str, ...]]:
    """Return the derivatives of motions under torques with jumps or kinks, which are followed one by one.

    Arguments and result are those of :func:`follow_sensitivities`. If a motion has no derivatives at one of the times,
    all derivatives of this motion are NaN, and its message says why.
    """
    from symrot.propagation.sensitivities.switched import SwitchedEquations

    variation = problem.variation
    equations = SwitchedEquations(variation.scene, keys, variation.columns)
    variables, prefix = equations.variables, f"{variation.scene.name}: sensitivities: "
    shape = len(variation), problem.times.shape[-1]
    omega, quaternion, rotation = (np.full((*shape, size, len(variables)), np.nan) for size in (3, 4, 3))
    messages = [""] * len(variation)
    for i in range(len(variation)):
        try:
            states, slopes = equations.follow(variation.scene_of(i), problem.times_of(i), problem.t0)
        except PropagationError as error:
            messages[i] = f"sensitivities: {str(error).removeprefix(prefix)}"
            continue
        omega[i], quaternion[i] = slopes[:, :RATES], slopes[:, RATES:]
        rotation[i] = small_rotation(states[:, RATES:], slopes[:, RATES:])
    return _labelled(variables, omega, quaternion, rotation), tuple(messages)


def _labelled(variables: Sequence[Variable], omega: Floats, quaternion: Floats, rotation: Floats) -> Sensitivities:
    """Return arrays of derivatives together with the names and the units of their ``variables``."""
    names, units = tuple(variable.name for variable in variables), tuple(variable.unit for variable in variables)
    return Sensitivities(names, units, groups_of(variables), omega, quaternion, rotation)


def read_columns(scene: Scene, keys: Sequence[str], varying: Collection[str]) -> tuple[list[Variable], list[Column]]:
    """Return the variables that ``keys`` name, such as ``"omega_2"``, and for each how the scene depends on it.

    InputError is raised if a variable determines a number of ``varying``: the names of the constants that differ
    between the motions, and omega or quaternion if the initial states differ.
    """
    require_formulas(scene)
    variables = read_variables(scene, keys)
    columns = columns_of(scene, variables)
    for column in columns:
        _require_shared(column, varying)
    return variables, columns


def _require_shared(column: Column, varying: Collection[str]) -> None:
    """Raise InputError if a variable determines another number of the scene that differs between the motions.

    An example is the variable gravity, which determines the weight, if the motions have different weights. ``column``
    has the variable and the derivatives of all numbers that it determines. ``varying`` has the names of the constants
    that differ between the motions, and omega or quaternion if the initial states differ.
    """
    variable = column.variable
    if variable.key == ATTITUDE or variable.key.startswith("omega"):
        return
    moved = set(column.constants)
    if len(column.constants) == 1 and column.constants.get(_constant(variable)) == 1:
        moved.clear()
    moved |= {"omega"} if any(column.start[:RATES]) else set()
    moved |= {"quaternion"} if any(column.start[RATES:]) else set()
    own = sorted(moved.intersection(varying))
    if own:
        keys = [ATTITUDE if name == "quaternion" else name for name in own]
        raise InputError(
            f"sensitivities: expected a variable that changes only numbers that all motions share, but {variable.name} "
            f"changes {', '.join(own)}, whose values differ between the motions; name {' or '.join(keys)} as the "
            "variable instead"
        )


def _constant(variable: Variable) -> str:
    """Return the name of the constant that ``variable`` changes: ``weight``, or ``I_yy`` for ``principal_2``."""
    # for a variable that changes several constants, such as a mass, no constant has this name
    stem, _, number = variable.name.rpartition("_")
    return f"I_{2 * 'xyz'[int(number) - 1]}" if stem == "principal" else variable.name


class _Equations:
    """The compiled equations of n motions and of their derivatives, with the constants of each motion.

    Parameters
    ----------
    problem : Problem
        The motions.
    columns : sequence of Column
        For each of the k variables, how the scene depends on it; at most :data:`AT_ONCE`.
    """

    def __init__(self, problem: Problem, columns: Sequence[Column]) -> None:
        self.problem, self.columns = problem, columns
        variation, scene = problem.variation, problem.variation.scene
        structure = structure_of(scene, columns, variation.columns)
        self.plan, self.epoch = Plan(scene, structure, ()), 0.0
        rates, self.parameters = rates_of(self.plan)
        times = problem.times
        if rates.uses("t") and times.size and starts_far(problem.t0, float(times.min()), float(times.max())):
            self.plan, self.epoch = Plan(scene, replace(structure, clock=EPOCH), ()), problem.t0
            rates, self.parameters = rates_of(self.plan)
        numbers = Numbers(variation, self.plan, range(len(variation)))
        self.values = numbers.values_of(self.parameters, self.epoch)
        self.slopes = [
            numbers.slopes(
                self.parameters,
                difference(scene, column.variable, lambda other: constants_of(other, structure)),
                column.variable.name,
                self.epoch,
            )
            if column.constants
            else {}
            for column in columns
        ]
        depends = [list(slopes) for slopes in self.slopes]
        # the stepper in lanes does not support the bounds that limit steps, for example under torques given by formulas
        self.compiled = (
            MotionLibrary(self.plan, rates, depends) if needs_bounds(self.plan) else self._lanes(rates, depends)
        )

    def _lanes(self, rates: Program, depends: Sequence[Sequence[str]]) -> Path:
        from symrot.codegen.taylor.ensemble_source import lane_definitions

        def source(program: Program, edges: Sequence[int], scales: Sequence[float]) -> str:
            return lane_definitions(program, edges, scales, ORDER)

        text = variation_source(self.plan, rates, depends, "lanes", source)
        return library.build(lanes.wrap_translation_unit(text), "lanes", lanes.FLAGS)

    def follow(self, rows: lanes.Integers) -> tuple[Floats, Floats, list[str]]:
        """Return the states of n motions at m times, shape (n, m, 7), their derivatives, (n, m, 7, k), and n messages.

        The last axis of the derivatives counts the k variables. A message says why a motion stopped early; it is empty
        for a motion that reached all times. ``rows`` are the indices of the motions.
        """
        problem, count, columns = self.problem, len(rows), len(self.columns)
        times = problem.times if problem.times.ndim == 1 else problem.times[rows]
        start, units = self._start(rows), self._units(rows)
        grid = np.empty((count, times.shape[-1], SIZE * (1 + columns)))
        reasons, again = [""] * count, np.arange(count)
        for attempt in range(TRIES):
            states = np.concatenate([start[again, :, :1], start[again, :, 1:] * units[again, None, :]], axis=2)
            p = [self.values[rows[again]]]
            for k, slopes in enumerate(self.slopes):
                p += [units[again, k : k + 1] * slope[rows[again], None] for slope in slopes.values()]
            own = times if times.ndim == 1 else times[again]
            y = states.transpose(0, 2, 1).reshape(len(again), -1)
            samples, messages = self._integrate(np.concatenate(p, axis=1), y, own)
            grid[again] = samples
            for place, message in zip(again.tolist(), messages, strict=True):
                reasons[place] = message
            derivatives = samples[..., SIZE:].reshape(len(again), -1, columns, SIZE)
            largest = np.nan_to_num(np.abs(derivatives[..., RATES:])).max(axis=(1, 3), initial=0.0)
            # errors are compared with 1: columns below SMALL are integrated again, in a unit in which they are near 1
            small = (largest > 0) & (largest < SMALL)
            if not small.any() or attempt == TRIES - 1:
                break
            _, exponents = np.frexp(largest)
            units[again] = np.where(small, np.ldexp(units[again], 1 - exponents), units[again])
            again = again[small.any(axis=1)]
        slopes_of = grid[..., SIZE:].reshape(count, -1, columns, SIZE) / units[:, None, :, None]
        return grid[..., :SIZE], slopes_of.transpose(0, 1, 3, 2), reasons

    def _start(self, rows: lanes.Integers) -> Floats:
        """Return the initial states of n motions and their derivatives with respect to k variables, (n, 7, 1 + k).

        ``[:, :, 0]`` are the states, angular velocity and quaternion; ``[:, :, j]`` are their derivatives with respect
        to variable j. ``rows`` are the indices of the motions.
        """
        states = self.problem.variation.initial_states[rows]
        start = np.empty((len(rows), SIZE, 1 + len(self.columns)))
        start[..., 0] = states
        for k, column in enumerate(self.columns, start=1):
            start[..., k] = column.start
            if column.variable.moved is None:
                start[:, RATES:, k] = rotation_slopes(states[:, RATES:].T, column.variable.axis).T
        return start

    def _units(self, rows: lanes.Integers) -> Floats:
        """Return, for n motions and k variables, the unit in which a variable is measured in the integration, (n, k).

        The integrated derivative is the derivative times this unit, so that it is about as large as the states. The
        units are powers of two near the values of the variables. ``rows`` are the indices of the motions.
        """
        variation, units = self.problem.variation, np.ones((len(rows), len(self.columns)))
        for k, column in enumerate(self.columns):
            variable = column.variable
            # a rotation of the initial attitude has the unit 1
            if variable.moved is None:
                continue
            if variable.key.startswith("omega"):
                sizes = np.abs(variation.omega[rows]).max(axis=1)
            else:
                varied = variation.columns.get(_constant(variable))
                sizes = np.full(len(rows), abs(float(variable.value))) if varied is None else np.abs(varied[rows])
            units[:, k] = np.where(sizes > 0, np.ldexp(1.0, np.frexp(sizes)[1]), 1.0)
        return units

    def _integrate(self, p: Floats, y: Floats, times: Floats) -> tuple[Floats, Sequence[str]]:
        """Return samples of n motions at m times, and for each motion why it stopped early, or an empty text.

        A sample has the 7 states and then, for each of the k variables, 7 derivatives: the shape is (n, m, 7 (1 + k)).
        """
        problem = self.problem
        if isinstance(self.compiled, Path):
            clock = problem.t0 - self.epoch, times - self.epoch
            outcome = lanes.follow(self.compiled, p, y, *clock, TOLERANCE, workers=problem.workers, epoch=self.epoch)
            return outcome.states, outcome.messages
        samples, messages = np.full((len(y), times.shape[-1], y.shape[1]), np.nan), []
        for k in range(len(y)):
            own = (times if times.ndim == 1 else times[k]) - self.epoch
            try:
                samples[k] = self.compiled.sample(p[k].tolist(), y[k].tolist(), problem.t0 - self.epoch, own)
                messages.append("")
            except IntegrationStopped as error:
                messages.append(str(error.later(self.epoch)))
            except PropagationError as error:
                messages.append(str(error))
        return samples, messages
