"""Results of a sweep in memory, for sweeps whose outputs fit there."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.sweeps.chunk import Chunk
from symrot.sweeps.layout import (
    COMPONENT,
    LABELS,
    MESSAGE,
    NOT_COMPUTED,
    STATUS,
    TIME,
    TRAJECTORY,
    Header,
    Table,
    arrays_of,
    messages_of,
)
from symrot.sweeps.optional import optional

__all__ = ["MemoryStore"]


class MemoryStore:
    """A store that holds all arrays in memory."""

    only_statistics = ""  # a sweep in memory is never continued

    def __init__(self, header: Header) -> None:
        self.header, self.tables = header, list[Table]()
        sizes = {TIME: len(header.times), COMPONENT[0]: len(COMPONENT[1])}
        self._arrays: dict[str, NDArray[Any]] = {
            variable.name: np.full((header.count, *(sizes[name] for name in variable.dimensions)), np.nan)
            for variable in header.variables
        }
        self._arrays[STATUS] = np.full(header.count, NOT_COMPUTED, dtype=np.int8)
        self._arrays[MESSAGE] = np.full(header.count, "", dtype=object)

    def pending(self) -> list[tuple[int, int]]:
        """Return the pairs (start, stop) of trajectories, one per chunk, whose results are not stored yet."""
        return [each for each in self.header.ranges() if self._arrays[STATUS][each[0]] == NOT_COMPUTED]

    def write(self, chunk: Chunk) -> None:
        """Copy the results of a chunk into the arrays."""
        own = arrays_of(chunk, self.header.inputs) | {MESSAGE: messages_of(chunk), STATUS: chunk.status}
        for name, values in own.items():
            self._arrays[name][chunk.start : chunk.stop] = values

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Return the values of the array ``name`` for the trajectories ``start`` to ``stop - 1``."""
        return self._arrays[name][start:stop]

    def table(self, name: str) -> NDArray[Any] | None:
        """Return the array of statistics called ``name``, or None if there is none."""
        return next((table.values for table in self.tables if table.name == name), None)

    def has(self, name: str) -> bool:
        """Return whether the values of the array ``name`` are stored."""
        return name in self._arrays

    def finish(self, tables: list[Table], only_statistics: str) -> None:
        """Store the statistics ``tables`` at the end of a sweep.

        Remove the values of inputs and outputs if ``only_statistics``, a description of the statistics, is not empty.
        """
        self.tables = tables
        if only_statistics:
            for variable in self.header.variables:
                self._arrays.pop(variable.name, None)

    def dataset(self) -> Any:
        """Return the results as an xarray Dataset."""
        xarray = optional("xarray", "to_xarray", "frames")
        labels = {variable.name: variable for variable in self.header.variables}
        variables = {
            name: ((TRAJECTORY, *labels[name].dimensions), values, labels[name].attributes)
            if name in labels
            else ((TRAJECTORY,), values, LABELS[name])
            for name, values in self._arrays.items()
        }
        variables |= {table.name: (table.dimensions, table.values, dict(table.attributes)) for table in self.tables}
        time = (TIME, self.header.times, {"units": "s", "long_name": "time"})
        coordinates: dict[str, Any] = {TIME: time}
        if any(COMPONENT[0] in variable.dimensions for variable in labels.values()):
            coordinates[COMPONENT[0]] = list(COMPONENT[1])
        return xarray.Dataset(variables, coordinates, {"scene": self.header.scene})
