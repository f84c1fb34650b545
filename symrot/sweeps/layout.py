"""The layout of the results of a sweep: its arrays with their dimensions and units, and what identifies the sweep.

A sweep computes many motions (trajectories) of a scene with varied values, in chunks of consecutive trajectories.
"""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.sweeps.chunk import Chunk, Job

__all__ = [
    "COMPONENT", "LABELS", "MESSAGE", "NOT_COMPUTED", "STATUS", "TIME", "TRAJECTORY", "Header", "Store", "Table",
    "Variable", "arrays_of", "continued", "data_frame", "frame_labels", "header_of", "messages_of",
]  # fmt: skip

TRAJECTORY, TIME = "trajectory", "time"
COMPONENT = ("component", ("q0", "q1", "q2", "q3"))
STATUS, MESSAGE, ATTITUDE = "status", "message", "input_quaternion"
NOT_COMPUTED = -128
"""Status of a trajectory whose chunk has not been computed yet."""
LABELS = {
    STATUS: {"long_name": "0 complete, -1 stopped early, -2 no motion has these values, -128 not computed yet"},
    MESSAGE: {"long_name": "why a trajectory is not complete, or a warning about its accuracy"},
}
"""Name of an array -> its attributes, for the arrays of status and message, which have one entry per trajectory."""

# by default, a sweep has about CHUNKS chunks, so that several processes share the work, if this gives chunks of ROWS
# trajectories (least, largest number); many samples for each trajectory make chunks smaller
ROWS = (1024, 16384)
CHUNKS = 16
LARGEST_CHUNK = 4_000_000  # samples in a chunk, about 300 MB with all quantities that are computed on the way


@dataclass(frozen=True)
class Variable:
    """One array of the results: its name, its dimensions after the first (``trajectory``), unit, frame and meaning."""

    name: str
    dimensions: tuple[str, ...]
    unit: str
    frame: str
    meaning: str

    @property
    def attributes(self) -> dict[str, str]:
        """Unit, name, meaning and frame as attributes of the array in a file, without those that are empty."""
        # xarray writes long_name at the axes of its plots
        labels = {"units": self.unit, "long_name": self.name, "description": self.meaning, "frame": self.frame}
        return {key: value for key, value in labels.items() if value}

    @property
    def columns(self) -> list[str]:
        """The names of the columns in a data frame that hold this array: four for an attitude, otherwise one."""
        if COMPONENT[0] not in self.dimensions:
            return [self.name]
        return [f"{self.name.rpartition('_')[0]}_{part}" for part in COMPONENT[1]]


@dataclass(frozen=True)
class Table:
    """One array of statistics: its dimensions, values, unit and meaning."""

    name: str
    dimensions: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, str]


@dataclass(frozen=True)
class Header:
    """The data with which a store for the results of a sweep (many motions of a scene with varied values) is created.

    These are the settings that identify the sweep, its arrays, and the number of trajectories in a chunk.
    """

    identity: Mapping[str, str]  # what determines the results, by name
    scene: str
    inputs: tuple[str, ...]  # names of the values that vary
    variables: tuple[Variable, ...]
    count: int
    times: NDArray[np.float64]
    rows: int

    def ranges(self) -> list[tuple[int, int]]:
        """Return for each chunk the pair (start, stop): index of its first trajectory, and index after its last."""
        return [(start, min(start + self.rows, self.count)) for start in range(0, self.count, self.rows)]


class Store(Protocol):
    """The interface of stores for the results of a sweep, which are written in chunks of trajectories."""

    # a chunk is stored as a whole: if the process is killed while it writes, the chunk counts as missing
    header: Header

    @property
    def only_statistics(self) -> str:
        """A description of the statistics if the store has only these; empty if it has the values of the outputs."""

    def pending(self) -> list[tuple[int, int]]:
        """Return the pairs (start, stop) of trajectories, one per chunk, whose results are not stored yet."""

    def write(self, chunk: Chunk) -> None:
        """Store a chunk; if it is stored already, it is overwritten, which changes no values."""

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Return the values of the array ``name`` for the trajectories ``start`` to ``stop - 1``."""

    def has(self, name: str) -> bool:
        """Return whether the values of the array ``name`` are stored."""

    def table(self, name: str) -> NDArray[Any] | None:
        """Return the array of statistics called ``name``, such as ``energy_mean``, or None if there is none."""

    def finish(self, tables: list[Table], only_statistics: str) -> None:
        """Store the statistics ``tables`` at the end of a sweep.

        ``only_statistics`` is a text that describes the statistics if these alone are to be kept: the values of inputs
        and outputs are then removed. It is empty if the values are kept too.
        """


def header_of(job: Job, rows: int | None = None) -> Header:
    """Return the header of the results of a sweep, with ``rows`` trajectories in a chunk.

    If ``rows`` is None, a number is chosen that suits the size of the results.
    """
    design = job.design
    inputs = [
        Variable(f"input_{axis.target.name}", (), axis.target.unit, "", f"value of {axis.target.name} that varies")
        for axis in design.axes
    ]
    if design.attitudes == "uniform":
        inputs.append(Variable(ATTITUDE, (COMPONENT[0],), "1", "body to space", "initial attitude, scalar first"))
    outputs = [
        Variable(output.name, (TIME,) if output.is_series else (), output.unit, output.frame, output.meaning)
        for output in job.outputs
    ]
    # by default the number follows from the size of the results
    samples = max(1, len(job.times)) * (1 + len(job.sensitivities))
    chosen = rows or max(1, min(max(ROWS[0], design.count // CHUNKS), ROWS[1], LARGEST_CHUNK // samples))
    return Header(_identity(job), job.scene.name, design.names, (*inputs, *outputs), design.count, job.times, chosen)


def _identity(job: Job) -> dict[str, str]:
    """Return the settings that determine the results of a sweep, as short texts by name, such as the seed."""
    import symrot

    # stored results are continued only by a sweep with the same settings
    scene, design = job.scene, job.design
    content = (scene.body._replace(description=""), scene.initial, scene.torques, scene.span.start, scene.table)
    return {
        "scene": _digest(repr((content, job.content if any(axis.target.path for axis in design.axes) else None))),
        "vary": _digest(repr(design.axes)),
        "attitudes": design.attitudes,
        "sampling": design.sampling,
        "count": str(design.count),
        "seed": str(design.seed),
        "times": _digest(repr(job.times.tolist())),
        "output": _digest(repr(job.outputs)),
        "method": job.method,
        "tolerance": repr(job.tolerance),
        "version of symrot": symrot.__version__,
    }


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def continued(header: Header, path: Path, description: Callable[[], Mapping[str, Any]]) -> Header:
    """Return ``header`` with as many trajectories per chunk as the results at ``path``, from which the sweep resumes.

    Parameters
    ----------
    header : Header
        The header of the sweep that is to go on.
    path : Path
        The existing file or folder.
    description : callable
        Reads the file or folder, and returns the settings of its sweep (``identity``) and its number of trajectories
        in a chunk (``rows``).

    Raises
    ------
    InputError
        If the path contains anything other than results of the same sweep.
    """
    expectation = f"{path}: expected a new name or the results of this sweep"
    try:
        present = description()
        settings, rows = dict(present["identity"]), int(present["rows"])
    except (OSError, LookupError, ValueError, TypeError):
        raise InputError(f"{expectation}, got a file or folder with other content; choose another name") from None
    if different := ", ".join(name for name, value in header.identity.items() if value != settings.get(name)):
        raise InputError(f"{expectation}, got the results of a sweep with a different {different}; choose another name")
    return replace(header, rows=rows)


def arrays_of(chunk: Chunk, names: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    """Return the varied values and the outputs of a chunk as arrays by name, such as ``"input_weight"``.

    ``names`` are the names of the varied values, in the order of the draws.
    """
    arrays: dict[str, NDArray[Any]] = {f"input_{name}": chunk.draws.values[:, k] for k, name in enumerate(names)}
    if chunk.draws.attitudes is not None:
        arrays[ATTITUDE] = chunk.draws.attitudes
    return arrays | chunk.outputs


def messages_of(chunk: Chunk) -> NDArray[Any]:
    """Return the messages of a chunk, one text for each trajectory; empty for a complete one without a warning."""
    texts = np.full(chunk.stop - chunk.start, "", dtype=object)
    for row, message in chunk.messages.items():
        texts[row] = message
    return texts


def frame_labels(header: Header) -> dict[str, Any]:
    """Return unit, frame and meaning of each column of a data frame, as its ``attrs``."""
    by_column = {column: variable for variable in header.variables for column in variable.columns}
    return {
        "units": {"t": "s"} | {name: variable.unit for name, variable in by_column.items()},
        "frames": {name: variable.frame for name, variable in by_column.items()},
        "meanings": {name: variable.meaning for name, variable in by_column.items()},
        "scene": header.scene,
    }


def data_frame(dataset: Any, header: Header) -> Any:
    """Return the values in an xarray Dataset as a pandas DataFrame, without statistics.

    The index is ``(trajectory, t)``, or ``trajectory`` if no output is stored at all times.
    """
    columns: dict[str, Any] = {}
    for variable in header.variables:
        if variable.name in dataset:  # the values of outputs are removed if only statistics are kept
            array = dataset[variable.name]
            parts = [array] if len(variable.columns) == 1 else [array[:, k].drop_vars(COMPONENT[0]) for k in range(4)]
            columns |= dict(zip(variable.columns, parts, strict=True))
    values = dataset.assign(columns)[[*columns, STATUS, MESSAGE]]
    if TIME in values.dims:
        values = values.rename({TIME: "t"})
    frame = values.to_dataframe(dim_order=[TRAJECTORY, *(["t"] if "t" in values.dims else [])])
    frame.attrs |= frame_labels(header)
    return frame
