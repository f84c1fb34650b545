"""One chunk of a sweep: computation of the outputs of the trajectories with consecutive indices.

The outputs of a trajectory depend only on the sweep and on the trajectory's index. A trajectory that cannot be
computed has NaN as outputs, a status and a reason.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.ensemble.ensemble import propagate_ensemble
from symrot.ensemble.reading import own_rates, read_variation, to_body
from symrot.errors import InputError, PropagationError
from symrot.results.tables import BY
from symrot.scene.scene import Scene
from symrot.sweeps.design import Design, Draws
from symrot.sweeps.outputs import SweepOutput, evaluate, sample_times
from symrot.sweeps.targets import OMEGA, Content, Path, constants_of

__all__ = ["COMPLETE", "IMPOSSIBLE", "STOPPED", "WARNED", "Chunk", "Job", "compute", "prepared"]

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

COMPLETE, STOPPED, IMPOSSIBLE = 0, -1, -2
"""Status of a trajectory: it reached its last time; it stopped early; no body or motion has its values."""

WARNED = "warning: "
"""Beginning of the message of a trajectory that is complete, but whose accuracy is in doubt."""

MOST_READINGS = 4096  # scenes of distinct values that a process remembers


# The equations of a trajectory are chosen by its own constants (Variation.patterns), so that the other trajectories of
# its chunk do not change its outputs.
@dataclass(frozen=True, eq=False)
class Job:
    """The description of a sweep: the scene, the design (which values vary), and outputs with times and accuracy."""

    design: Design
    scene: Scene
    content: Content | None
    times: Floats  # (m,), s
    outputs: tuple[SweepOutput, ...]
    method: str
    tolerance: float
    sensitivities: tuple[str, ...] = ()  # variables of the derivatives among the outputs


@dataclass(frozen=True)
class Chunk:
    """The results of the trajectories ``start`` to ``stop - 1``: varied values, outputs, status, messages."""

    start: int
    stop: int
    draws: Draws
    outputs: dict[str, Floats]  # (n, m) or (n,) by name
    status: NDArray[np.int8]  # (n,)
    messages: dict[int, str]  # by row: the reason why a trajectory is not complete, or a warning about its accuracy


@dataclass
class _Inputs:
    """The arguments of an ensemble: initial states and columns of constants, one row for each trajectory."""

    omega: Floats
    attitudes: Floats | None
    parameters: dict[str, Floats]

    def of(self, rows: Rows) -> dict[str, Any]:
        attitudes = None if self.attitudes is None else self.attitudes[rows]
        parameters = {name: column[rows] for name, column in self.parameters.items()}
        return {"omega": self.omega[rows], "quaternion": attitudes, "parameters": parameters}


def compute(job: Job, start: int, stop: int, draws: Draws | None = None) -> Chunk:
    """Return the outputs, status and messages of the trajectories ``start`` to ``stop - 1`` of a sweep.

    ``draws`` are their varied values, if these are known already.
    """
    draws, n = job.design.draws(start, stop) if draws is None else draws, stop - start
    samples = sample_times(job.outputs, job.times)
    shapes = {output.name: (n, len(job.times)) if output.is_series else (n,) for output in job.outputs}
    outputs = {name: np.full(shape, np.nan) for name, shape in shapes.items()}
    status, messages = np.full(n, IMPOSSIBLE, dtype=np.int8), dict[int, str]()
    inputs, rows = _inputs(job, draws, messages)
    rows = _possible(job.scene, inputs, rows, messages)
    if len(rows):
        variation = read_variation(job.scene, **inputs.of(rows))
        for group in variation.patterns():
            _propagate(job, inputs, rows[group], samples, outputs, status, messages)
    return Chunk(start, stop, draws, outputs, status, messages)


def _inputs(job: Job, draws: Draws, messages: dict[int, str]) -> tuple[_Inputs, Rows]:
    """Return the arguments of the ensemble, and the indices of the rows of ``draws`` that give a valid scene."""
    n, scene = len(draws.values), job.scene
    inputs = _Inputs(own_rates(scene.initial, draws.attitudes, n), draws.attitudes, {})
    rows = np.arange(n)
    paths = {axis.target.path: k for k, axis in enumerate(job.design.axes) if axis.target.path}
    if paths:
        # messages gets the reason for each other row
        rows = _read_scenes(job, draws, paths, inputs, messages)
    for k, axis in enumerate(job.design.axes):
        name = axis.target.name
        if name in OMEGA:
            inputs.omega[:, OMEGA.index(name)] = draws.values[:, k]
        elif not axis.target.path:
            inputs.parameters[name] = draws.values[:, k]
    return inputs, rows


def _read_scenes(job: Job, draws: Draws, paths: dict[Path, int], inputs: _Inputs, messages: dict[int, str]) -> Rows:
    """Read the scene with the varied values of each row, and return the rows that give a valid scene.

    For such a row, the constants and the initial state that follow from the values are written into ``inputs``; for
    every other row, the reason is written into ``messages``.
    """
    assert job.content is not None
    # paths: the place of each varied number in the scene file, with its column in the draws
    constants = sorted({name for path in paths for name in constants_of(path, job.scene, job.content)})
    n, moved = len(draws.values), any(path[0] == "initial" for path in paths)
    inputs.parameters |= {name: np.ones(n) for name in constants}
    if moved and draws.attitudes is None:
        inputs.attitudes = np.tile([1.0, 0.0, 0.0, 0.0], (n, 1))
    reader = _reader(job, tuple(paths), tuple(constants))
    rows = []
    for row, values in enumerate(draws.values[:, list(paths.values())].tolist()):
        varied = reader(tuple(values))
        if isinstance(varied, str):
            messages[row] = varied
            continue
        rows.append(row)
        for name, value in zip(constants, varied.constants, strict=True):
            inputs.parameters[name][row] = value
        if moved:
            inputs.omega[row] = varied.omega_b
        if moved and draws.attitudes is not None and varied.omega_s is not None:
            inputs.omega[row] = to_body(draws.attitudes[row : row + 1], np.array(varied.omega_s))[0]
        if moved and draws.attitudes is None and inputs.attitudes is not None:
            inputs.attitudes[row] = varied.quaternion
    return np.array(rows, dtype=np.intp)


class _Varied(NamedTuple):
    """The numbers that follow from a scene with varied values: constants of the equations, and the initial state."""

    constants: list[float]
    omega_b: list[float]
    quaternion: list[float]
    omega_s: list[float] | None  # None unless the scene gives omega in space components


@lru_cache(maxsize=2)
def _reader(job: Job, paths: tuple[Path, ...], constants: tuple[str, ...]) -> Any:
    """Return a function that reads the scene with new values at ``paths`` of the scene file.

    The function takes these values. It returns what follows from them (:class:`_Varied`): the values of the
    ``constants`` of the equations, and the initial state. If the scene with these values is not valid, the function
    returns the reason as a text.
    """
    names = {axis.target.path: axis.target.name for axis in job.design.axes}

    @lru_cache(maxsize=MOST_READINGS)
    def read(values: tuple[float, ...]) -> _Varied | str:
        changes = {names[path]: value for path, value in zip(paths, values, strict=True)}
        try:
            scene = job.scene.with_(changes)
            variation = read_variation(scene, None, None, None)
            numbers = [float(variation.constant(name)) for name in constants]
        except InputError as error:
            return str(error)
        start = scene.initial
        omega_s = None if start.omega_s is None else [float(x) for x in start.omega_s]
        return _Varied(numbers, [float(x) for x in start.omega_b], [float(x) for x in start.quaternion], omega_s)

    return read


def _possible(scene: Scene, inputs: _Inputs, rows: Rows, messages: dict[int, str]) -> Rows:
    """Return those of ``rows`` whose values an ensemble accepts; the reasons for the others go into ``messages``."""
    if not len(rows):
        return rows
    try:
        read_variation(scene, **inputs.of(rows))
    except InputError as error:
        if len(rows) == 1:
            messages[int(rows[0])] = _alone(error)
            return rows[:0]
        # a rejected group is halved until it has one row
        half = len(rows) // 2
        return np.concatenate([_possible(scene, inputs, part, messages) for part in (rows[:half], rows[half:])])
    return rows


def _alone(error: Exception) -> str:
    """Return the message of an error in an ensemble of one trajectory, without the index of the trajectory."""
    return str(error).replace(", trajectory 0", "").replace(" in trajectory 0", "").replace("parameters: ", "")


def _propagate(
    job: Job, inputs: _Inputs, rows: Rows, samples: Floats, outputs: dict[str, Floats], status: NDArray[np.int8],
    messages: dict[int, str],
) -> None:  # fmt: skip
    """Propagate ``rows``, which share their equations, and write ``outputs``, ``status`` and ``messages``.

    If the propagation raises an error, the rows are halved, down to single rows. For a row that fails alone, only the
    message is written.
    """
    try:
        ensemble = propagate_ensemble(
            job.scene, **inputs.of(rows), t=samples, method=job.method, tolerance=job.tolerance,
            sensitivities=job.sensitivities or None,
        )  # fmt: skip
        with np.errstate(over="ignore", invalid="ignore"):
            values = evaluate(job.outputs, ensemble, job.times, samples)
    except (InputError, PropagationError, ArithmeticError) as error:
        if len(rows) == 1:
            messages[int(rows[0])] = _alone(error)
            return
        for part in np.array_split(rows, 2):
            _propagate(job, inputs, part, samples, outputs, status, messages)
        return
    for name, value in values.items():
        outputs[name][rows] = value
    status[rows] = np.where(ensemble.status == 0, COMPLETE, STOPPED)
    of_scene = len(ensemble.scene.warnings)
    for row, message, warnings in zip(rows.tolist(), ensemble.messages, ensemble.warnings, strict=True):
        if message or len(warnings) > of_scene:
            messages[row] = message or WARNED + "; ".join(warnings[of_scene:])
    for name, value in values.items():
        for row in rows[np.isinf(value).reshape(len(rows), -1).any(axis=1)].tolist():
            # an infinity is not a value: all outputs of this trajectory are missing
            for column in outputs.values():
                column[row] = np.nan
            status[row] = IMPOSSIBLE
            messages[row] = f"{name}: expected a value within the range of doubles, got infinity"


def prepared(job: Job) -> Job:
    """Return the job, with a scene that computes just the quantities that the outputs need, such as the attitude."""
    quantities = tuple(dict.fromkeys(output.quantity for output in job.outputs if BY not in output.quantity))
    output = job.scene.output._replace(quantities=quantities or ("omega",))
    return replace(job, scene=replace(job.scene, output=output))
