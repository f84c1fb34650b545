"""Trajectories read from the NPZ files that ``trajectory.save`` and ``symrot run --out`` write.

A file contains arrays of numbers and one JSON text. Reading needs no kernel and no compiler.
"""

import json
import math
import zipfile
import zlib
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.files.reading import refuse_special
from symrot.results.labels import LOCK, About, Labelled, chosen_names, event_array
from symrot.results.samples import Samples
from symrot.results.sensitivity import Sensitivities, event_time_items, restored, time_slopes

__all__ = ["SavedTrajectory", "load"]

VECTORS = ("omega_space", "polhode", "herpolhode")
Floats = NDArray[np.float64]
_ARCHIVE_FAULTS = (OSError, EOFError, NotImplementedError, RuntimeError, zipfile.BadZipFile, zlib.error)
_CONTENT_FAULTS = (ValueError, LookupError, TypeError, AttributeError)  # as of metadata without a name or a list


class SavedTrajectory(Samples):
    """The samples of a trajectory from a file; :func:`symrot.load` returns it. Conventions: :mod:`symrot.conventions`.

    The quantities in the file are attributes, such as ``energy``. Euler angles are the exception: ``quantity("euler")``
    returns the angles in the file, because :meth:`euler` is a method, which computes the angles of any sequence.

    Attributes
    ----------
    t : array, shape (n,)
        The sample times, s.
    metadata : dict
        The description in the file: scene, method, steps, meaning of each array, conserved quantities, conventions.
    at_events : list of SavedTrajectory
        For each event, the samples at its times.
    event_kinds : list of lists of str
        For each event and each of its times: ``"rising"``, ``"falling"`` or ``"touching"``.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = symrot.propagate("t_handle", events=["omega_3 == 0"]).save(f"{folder}/motion.npz")
    ...     saved = symrot.load(f"{folder}/motion.npz")
    >>> saved.energy.shape, saved.at_events[0].t[:2].round(8).tolist()
    ((2401,), [1.18541555, 3.55624666])
    """

    def __init__(self, metadata: dict[str, Any], items: Sequence[Labelled]) -> None:
        self.metadata, self._items = metadata, {item.name: item for item in items}
        # in place of the properties that compute them from omega and the quaternion
        self.__dict__ |= {name: self._items[name].values for name in ("dcm", *VECTORS) if name in self._items}
        self.t = self._items["t"].values
        self.at_events: list[SavedTrajectory] = []
        self.event_kinds: list[list[str]] = []

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<SavedTrajectory of {self._about.scene}: {len(self)} samples, {', '.join(self._items)}>"

    def __getattr__(self, name: str) -> Any:
        items = self.__dict__.get("_items", {})
        if name in items:
            return items[name].values
        raise AttributeError(f"the file of the trajectory has no quantity {name!r}; it has {', '.join(items)}")

    def quantity(self, name: str) -> Floats:
        """Return a quantity in the file by its name in ``output.quantities`` of a scene, such as ``"euler"``."""
        if not isinstance(name, str) or name not in self._items:
            raise InputError(f"{name}: expected a file with this quantity, got a file with {', '.join(self._items)}")
        values: Floats = self._items[name].values
        return values

    @cached_property
    def omega(self) -> Floats:
        """Angular velocity, body components, rad/s, shape (n, 3)."""
        return self.quantity("omega")

    @cached_property
    def quaternion(self) -> Floats:
        """Attitude as unit quaternions, scalar first, body to space, shape (n, 4)."""
        return self.quantity("quaternion")

    @cached_property
    def sensitivities(self) -> Sensitivities | None:
        """The derivatives of the motion with respect to initial values and constants; None if the file has none."""
        record = self.metadata.get("sensitivities")
        return None if record is None else restored(record, self._items)

    @property
    def method(self) -> str:
        """The name of the method that computed the motion, such as ``"taylor"``."""
        return self._about.method

    @property
    def success(self) -> bool:
        """Whether the motion was computed up to its last sample time or to a terminal event."""
        return bool(self.metadata["status"] >= 0)

    @property
    def t_events(self) -> list[Floats]:
        """The times of each event, s: one array for each event."""
        return [samples.t for samples in self.at_events]

    @property
    def _about(self) -> About:
        """Where the samples come from: scene, method and tolerance, as the file says; tables carry it as attributes."""
        return About(*(self.metadata[name] for name in About._fields))

    def _labelled(self, quantities: Sequence[str] | None = None) -> list[Labelled]:
        """Return the time and the quantities ``quantities`` with their labels, for tables.

        The default (None) is all quantities in the file.
        """
        if quantities is None:
            return list(self._items.values())
        names = chosen_names(quantities)
        for name in names:
            self.quantity(name)
        # with the angles of an Euler sequence comes where it is at gimbal lock
        groups = ((name, LOCK) if name == "euler" and LOCK in self._items else (name,) for name in names if name != "t")
        return [self._items["t"], *(self._items[name] for group in groups for name in group)]


def load(path: str | Path) -> SavedTrajectory:
    """Return the trajectory in an NPZ file that ``trajectory.save`` or ``symrot run --out`` wrote.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    SavedTrajectory
        The samples and the events, with labels.

    Raises
    ------
    InputError
        If the file cannot be read, or if it is another kind of file.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = symrot.propagate("t_handle").save(f"{folder}/motion.npz")
    ...     symrot.load(f"{folder}/motion.npz").omega.shape
    (2401, 3)
    """
    try:
        refuse_special(Path(path))
        if not zipfile.is_zipfile(path):
            raise ValueError("the file is not an NPZ archive")
        with np.load(path, allow_pickle=False) as content:
            return _saved(content)
    except (*_ARCHIVE_FAULTS, *_CONTENT_FAULTS) as reason:
        why = getattr(reason, "strerror", None) or str(reason) or type(reason).__name__
        _refuse(path, why.partition("\n")[0])


def _refuse(path: str | Path, why: str) -> NoReturn:
    raise InputError(
        f"load: expected an NPZ file written by trajectory.save or symrot run --out, got {str(path)!r} ({why})"
    )


def _saved(content: Any) -> SavedTrajectory:
    if not hasattr(content, "files") or "metadata" not in content.files:
        raise ValueError("the file has no metadata of symrot")
    metadata = json.loads(str(content["metadata"]))
    saved = SavedTrajectory(metadata, _items(content, metadata, str))
    if not isinstance(saved.metadata["status"], int) or None in saved._about:
        raise ValueError("its metadata are damaged")
    saved.sensitivities  # noqa: B018 - a damaged record of derivatives is refused here
    for number, event in enumerate(metadata["events"], start=1):
        items = _items(content, metadata, lambda name, k=number: event_array(k, name))
        states = SavedTrajectory(metadata, [*items, *_time_items(metadata.get("sensitivities"), number)])
        saved.at_events.append(states)
        saved.event_kinds.append(list(event["kinds"]))
    return saved


def _time_items(record: dict[str, Any] | None, number: int) -> list[Labelled]:
    """Return the derivatives of the times of event ``number``, from 1, with labels; empty if the file has none."""
    if record is None or len(record.get("t_events", ())) < number:
        return []
    slopes = time_slopes(record["t_events"][number - 1], len(record["variables"]))
    return event_time_items(record["variables"], record["units"], slopes)


def _items(content: Any, metadata: dict[str, Any], array: Any) -> list[Labelled]:
    """Return the quantities in an NPZ file with their labels, as the file's ``metadata`` describes them.

    ``array`` is a function from a quantity's name to the name of its array in the file.
    """
    # the samples of a quantity, or those at an event
    items = []
    for name, entry in metadata["arrays"].items():
        values, components = content[array(name)], tuple(map(str, entry["components"]))
        if values.dtype.kind not in "fb" or values.ndim < 1 or math.prod(values.shape[1:]) != len(components):
            raise ValueError(f"its array {array(name)!r} does not have {len(components)} numbers in each row")
        items.append(Labelled(name, values, components, entry["unit"], entry["frame"], entry["meaning"]))
    if {len(item.values) for item in items} != {len(items[0].values)} or "t" not in metadata["arrays"]:
        raise ValueError("its arrays have different numbers of rows")
    return items
