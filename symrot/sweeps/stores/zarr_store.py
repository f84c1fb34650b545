"""Results of a sweep as a Zarr group, which xarray opens: one array for each input and output, with its units.

Each array has the same chunks as the sweep. The status of a chunk is written last: a chunk that has a status is
complete, even if a process was killed while it wrote.
"""

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
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
    continued,
    messages_of,
)
from symrot.sweeps.optional import optional
from symrot.sweeps.stores.folder import create, require_own

__all__ = ["ZarrStore"]

IDENTITY, ROWS, FINISHED, REMOVED = "symrot_sweep", "symrot_rows", "symrot_finished", "symrot_statistics_alone"


class ZarrStore:
    """The store of a sweep in the folder ``path``; if the folder has results of the same sweep, the sweep resumes.

    Raises
    ------
    InputError
        If zarr is not installed, or if the path contains anything other than results of the same sweep.
    """

    def __init__(self, path: Path, header: Header) -> None:
        zarr = optional("zarr", "-o")
        self.path = path
        if path.exists() or not create(path, lambda folder: _fill(zarr, folder, header)):
            header = continued(header, path, lambda: _description(zarr, path))
        self.header = header
        self._group = zarr.open_group(str(path), mode="r+")
        self._open: dict[str, Any] = {}

    def _array(self, name: str) -> Any:
        if name not in self._open:
            self._open[name] = self._group[name]
        return self._open[name]

    def _require_own(self) -> None:
        require_own(self.header, self.path, lambda: _description(optional("zarr", "-o"), self.path))

    def pending(self) -> list[tuple[int, int]]:
        """Return the pairs (start, stop) of trajectories, one per chunk, whose results are not stored yet."""
        status = self._array(STATUS)
        return [each for each in self.header.ranges() if status[each[0]] == NOT_COMPUTED]

    def write(self, chunk: Chunk) -> None:
        """Store a chunk; if it is stored already, it is overwritten, which changes no values.

        Raise InputError if the folder no longer has the results of this sweep, because another sweep was begun in it.
        """
        self._require_own()
        rows = slice(chunk.start, chunk.stop)
        for name, values in arrays_of(chunk, self.header.inputs).items():
            self._array(name)[rows] = values
        if chunk.messages:
            self._array(MESSAGE)[rows] = messages_of(chunk)
        # last: Zarr writes a chunk to a temporary file and renames it, so that a chunk with a status is complete
        self._array(STATUS)[rows] = chunk.status

    def read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        """Return the values of the array ``name`` for the trajectories ``start`` to ``stop - 1``."""
        values: NDArray[Any] = self._array(name)[start:stop]
        return values

    def table(self, name: str) -> NDArray[Any] | None:
        """Return the array of statistics called ``name``, or None if there is none."""
        names = [STATUS, MESSAGE, *(variable.name for variable in self.header.variables)]
        return None if name in names or name not in self._group else np.asarray(self._group[name][...])

    def has(self, name: str) -> bool:
        """Return whether the values of the array ``name`` are stored."""
        return name in self._group

    @property
    def finished(self) -> bool:
        """Whether the statistics of the sweep are stored, which happens once, after its last chunk."""
        return bool(self._group.attrs.get(FINISHED, False))

    @property
    def only_statistics(self) -> str:
        """A description of the statistics if the store has only these, not the values of the outputs; else empty."""
        return str(self._group.attrs.get(REMOVED, ""))

    def finish(self, tables: list[Table], only_statistics: str) -> None:
        """Store the statistics ``tables`` at the end of a sweep.

        ``only_statistics`` is a text that describes the statistics if these alone are to be kept: the values of inputs
        and outputs are then removed. It is empty if the values are kept too.

        Raises
        ------
        InputError
            If another process has finished this sweep and kept nothing but statistics, and these are not the ones that
            ``only_statistics`` describes. Also if another process has begun another sweep in the folder.
        """
        self._require_own()
        zarr = optional("zarr", "-o")
        removed = str(zarr.open_group(str(self.path), mode="r").attrs.get(REMOVED, ""))
        if removed and removed != only_statistics:
            raise InputError(f"{self.path}: another process has finished this sweep and kept only its statistics")
        # once values are removed, statistics may have been computed from what is left: those in the file stay
        for table in () if removed else tables:
            _add(self._group, table)
        self._group.attrs[FINISHED] = True
        if only_statistics:
            self._group.attrs[REMOVED] = only_statistics  # before the first array is removed
            self._open.clear()
            for variable in self.header.variables:
                if variable.name in self._group:
                    del self._group[variable.name]
        with warnings.catch_warnings():  # zarr calls the consolidated form of version 3 experimental; xarray reads it
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(str(self.path))

    def dataset(self) -> Any:
        """Return the results as an xarray Dataset, which reads its values when they are used."""
        xarray = optional("xarray", "to_xarray")
        return xarray.open_zarr(str(self.path), consolidated=None if self.finished else False)


def _fill(zarr: Any, folder: Path, header: Header) -> None:
    """Create the arrays that ``header`` describes, without values, in an empty folder; ``zarr`` is the package."""
    group = zarr.open_group(str(folder), mode="w", zarr_format=3)
    sizes = {TIME: len(header.times), COMPONENT[0]: len(COMPONENT[1])}
    for variable in header.variables:
        shape = tuple(sizes[name] for name in variable.dimensions)
        group.create_array(
            variable.name, shape=(header.count, *shape), chunks=(header.rows, *shape), dtype="f8",
            fill_value=np.nan, dimension_names=(TRAJECTORY, *variable.dimensions),
            attributes=variable.attributes, compressors=_fast(zarr),
        )  # fmt: skip
    own = {"shape": (header.count,), "chunks": (header.rows,), "dimension_names": (TRAJECTORY,)}
    group.create_array(STATUS, dtype="i1", fill_value=NOT_COMPUTED, attributes=LABELS[STATUS], **own)
    group.create_array(MESSAGE, dtype=str, fill_value="", attributes=LABELS[MESSAGE], **own)
    _add(group, Table(TIME, (TIME,), header.times, {"units": "s", "long_name": "time"}))
    if any(COMPONENT[0] in variable.dimensions for variable in header.variables):
        _add(group, Table(COMPONENT[0], (COMPONENT[0],), np.array(COMPONENT[1], dtype=object), {}))
    group.attrs.update({"scene": header.scene, ROWS: header.rows, IDENTITY: json.dumps(dict(header.identity))})


def _description(zarr: Any, path: Path) -> dict[str, Any]:
    """Return the settings of the sweep whose results are in a folder, and the number of trajectories in a chunk."""
    attributes = dict(zarr.open_group(str(path), mode="r").attrs)
    return {"identity": json.loads(attributes[IDENTITY]), "rows": attributes[ROWS]}


def _fast(zarr: Any) -> Any:
    """Return a fast compressor of the package ``zarr``; slower ones save little more, as digits look random."""
    # equal bits of numbers are stored together, so that signs and exponents take little room
    return zarr.codecs.BloscCodec(cname="lz4", clevel=1, shuffle="bitshuffle")


def _add(group: Any, table: Table) -> None:
    is_text = table.values.dtype == object
    array = group.create_array(
        table.name, shape=table.values.shape, dtype=str if is_text else table.values.dtype,
        dimension_names=table.dimensions, attributes=dict(table.attributes), overwrite=True,
    )  # fmt: skip
    array[...] = table.values
