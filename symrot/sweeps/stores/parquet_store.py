"""Results of a sweep as a folder of Parquet files, which pandas opens: one file for each chunk of trajectories.

There is one row for each trajectory, and for each time if an output has values at all sample times.
"""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.files.writing import write
from symrot.sweeps.chunk import Chunk
from symrot.sweeps.layout import (
    MESSAGE,
    STATUS,
    TIME,
    TRAJECTORY,
    Header,
    Table,
    arrays_of,
    continued,
    frame_labels,
    messages_of,
)
from symrot.sweeps.optional import optional
from symrot.sweeps.stores.folder import create, require_own

__all__ = ["ParquetStore"]

DESCRIPTION, STATISTICS = "_sweep.json", "_statistics.parquet"  # readers of Parquet ignore names that begin with _


# A file gets its final name when it is complete, so that every file with such a name has all its rows.
class ParquetStore:
    """The store of a sweep in the folder ``path``; if the folder has results of the same sweep, the sweep resumes.

    Raises
    ------
    InputError
        If pyarrow is not installed, or if the path contains anything other than results of the same sweep.
    """

    only_statistics = ""  # values cannot be removed from these files

    def __init__(self, path: Path, header: Header) -> None:
        self._parquet, self._arrow = optional("pyarrow.parquet", "-o"), optional("pyarrow", "-o")
        self.path = path
        text = json.dumps({"identity": dict(header.identity), "rows": header.rows}, indent=2).encode()

        def fill(folder: Path) -> None:
            (folder / DESCRIPTION).write_bytes(text)

        is_taken = path.exists() and not (path.is_dir() and not any(path.iterdir()))
        if is_taken or not create(path, fill):
            header = continued(header, path, self._description)
        self.header = header
        self._long = any(TIME in variable.dimensions for variable in header.variables)

    def _description(self) -> dict[str, Any]:
        content: dict[str, Any] = json.loads((self.path / DESCRIPTION).read_text(encoding="utf-8"))
        return content

    def _file(self, start: int) -> Path:
        return self.path / f"part-{start:012d}.parquet"

    def pending(self) -> list[tuple[int, int]]:
        """Return the pairs (start, stop) of trajectories, one per chunk, whose file does not exist yet."""
        return [each for each in self.header.ranges() if not self._file(each[0]).exists()]

    def write(self, chunk: Chunk) -> None:
        """Store a chunk; if it is stored already, it is overwritten, which changes no values.

        Raise InputError if the folder no longer has the results of this sweep, because another sweep was begun in it.
        """
        require_own(self.header, self.path, self._description)
        n, times = chunk.stop - chunk.start, self.header.times
        repeats = len(times) if self._long else 1
        columns: dict[str, Any] = {TRAJECTORY: np.repeat(np.arange(chunk.start, chunk.stop), repeats)}
        if self._long:
            columns["t"] = np.tile(times, n)
        arrays = arrays_of(chunk, self.header.inputs)
        for variable in self.header.variables:
            values = arrays[variable.name]
            if variable.dimensions == (TIME,):
                columns[variable.name] = values.ravel()
            elif variable.dimensions:
                parts = zip(variable.columns, values.T, strict=True)
                columns |= {name: np.repeat(part, repeats) for name, part in parts}
            else:
                columns[variable.name] = np.repeat(values, repeats)
        columns[STATUS] = np.repeat(chunk.status, repeats)
        columns[MESSAGE] = self._arrow.array(np.repeat(messages_of(chunk), repeats), type=self._arrow.string())
        table = self._arrow.table(columns).replace_schema_metadata(self._metadata())
        writer = self._parquet.write_table
        write(self._file(chunk.start), lambda stream: writer(table, stream, compression="zstd"))

    def _metadata(self) -> dict[str, str]:
        """Return the metadata of a file: units, meanings and frames of all columns, which pandas shows as ``attrs``."""
        return {"PANDAS_ATTRS": json.dumps(frame_labels(self.header))}

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Return the values of the array ``name`` for the trajectories ``start`` to ``stop - 1``."""
        parts = []
        variable = next((each for each in self.header.variables if each.name == name), None)
        for first in range(start // self.header.rows * self.header.rows, stop, self.header.rows):
            column = self._parquet.read_table(self._file(first), columns=[name], partitioning=None)
            values = column[name].to_numpy().reshape(-1, len(self.header.times) if self._long else 1)
            whole = values if variable is not None and variable.dimensions == (TIME,) else values[:, 0]
            parts.append(whole[max(0, start - first) : stop - first])
        return np.concatenate(parts)

    def table(self, name: str) -> NDArray[Any] | None:
        """Return the array of statistics called ``name``, or None if there is none."""
        path = self.path / STATISTICS
        if not path.exists():
            return None
        rows = self._parquet.read_table(path, filters=[("name", "=", name)])
        if not len(rows):
            return None
        index, times = (rows[key].to_numpy().astype(float) for key in ("index", "t"))
        # sample times may be equal, so that their number is not that of the different values
        shape = ([] if np.isnan(index).all() else [len(np.unique(index))]) + [-1] * (not np.isnan(times).all())
        return np.asarray(rows["value"].to_numpy().reshape(shape))

    def has(self, name: str) -> bool:
        """Return whether ``name`` is stored in one column of the files: an input, output, status or message."""
        # not an attitude: each of its four components has a column of its own
        columns = (variable.name for variable in self.header.variables if variable.dimensions in ((), (TIME,)))
        return name in (STATUS, MESSAGE, *columns)

    def finish(self, tables: list[Table], only_statistics: str) -> None:
        """Store the statistics ``tables`` at the end of a sweep.

        ``only_statistics`` is a text that describes the statistics if these alone are to be kept, otherwise empty.
        Raise InputError if it is not empty: the values of trajectories cannot be removed from Parquet files. Raise
        InputError also if the folder no longer has the results of this sweep.
        """
        require_own(self.header, self.path, self._description)
        if tables:
            rows = self._arrow.Table.from_pylist([row for table in tables for row in _rows(table, self.header.times)])
            write(self.path / STATISTICS, lambda stream: self._parquet.write_table(rows, stream))
        if only_statistics:
            raise InputError(
                "keep: expected 'all' for a Parquet file, got 'statistics'; write FILE.zarr to store statistics only"
            )

    def dataset(self) -> Any:
        """Return the results as a pandas DataFrame, one row for each trajectory, or for each of its sample times.

        The index is ``(trajectory, t)`` if an output has values at all sample times, otherwise ``trajectory``.
        """
        pandas = optional("pandas", "to_dataframe")
        return pandas.read_parquet(os.fspath(self.path)).set_index([TRAJECTORY, "t"] if self._long else [TRAJECTORY])


def _rows(table: Table, times: NDArray[np.float64]) -> list[dict[str, Any]]:
    """Return the array of statistics ``table`` as rows (name, t, index, value) of a file."""
    # t: one of times, or None if the array has no times; index counts percentiles or bins
    rows = []
    for place, value in np.ndenumerate(table.values):
        axes = dict(zip(table.dimensions, place, strict=True))
        time = float(times[axes.pop(TIME)]) if TIME in axes else None
        rows.append({"name": table.name, "t": time, "index": next(iter(axes.values()), None), "value": float(value)})
    return rows
