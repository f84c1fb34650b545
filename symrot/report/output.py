"""Writing of trajectories to NPZ or CSV files, with labels, units, conventions and the name of the scene.

Equal motions give files with equal bytes.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from symrot import __version__, conventions
from symrot.errors import InputError
from symrot.files.paths import path_of
from symrot.files.writing import check_target, write
from symrot.formula.exact_numbers import show
from symrot.report.layout import columns, exact, one_line
from symrot.results.labels import LOCK, Labelled, event_array, labelled

if TYPE_CHECKING:
    from symrot.propagation.trajectory import Trajectory
    from symrot.report.records import FileRecord

__all__ = ["FORMATS", "metadata", "save"]

ROWS_AT_ONCE = 4096


def metadata(trajectory: "Trajectory", arrays: list[Labelled]) -> "FileRecord":
    """Return the description at the head of a trajectory's file: scene, method, conventions, meaning of each array.

    ``arrays`` are the arrays that the file will have, with their labels.
    """
    requested = zip(trajectory.events or (), trajectory.event_kinds or (), trajectory.t_events or (), strict=True)
    scene, stats = trajectory.scene, trajectory.stats
    about: FileRecord = {
        "symrot": __version__,
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "method": trajectory.method,
        "tolerance": trajectory.tolerance,
        "status": trajectory.status,
        "message": trajectory.message,
        "warnings": list(trajectory.warnings),
        "steps": stats.accepted,
        "evaluations": stats.evaluations,
        "moments_of_inertia": [exact(moment) for moment in scene.body.principal.moments],
        "arrays": {
            item.name: {
                "components": list(item.components), "unit": item.unit, "frame": item.frame, "meaning": item.meaning,
            }
            for item in arrays
        },
        "invariants": [
            {"name": item.name, "unit": item.unit, "drift": item.drift, "reason": item.reason}
            for item in trajectory.invariants
        ],
        "events": [
            {"formula": event.formula, "kinds": kinds, "times": times.tolist()} for event, kinds, times in requested
        ],
        "conventions": _conventions(),
    }  # fmt: skip
    if trajectory.sensitivities is not None:
        about["sensitivities"] = trajectory.sensitivities.record
    return about


def _conventions() -> str:
    return (conventions.__doc__ or "").split("\n", 2)[-1].strip()


def _npz(stream: BinaryIO, arrays: list[Labelled], events: list[Labelled], about: "FileRecord") -> None:
    content: dict[str, Any] = {item.name: item.values for item in (*arrays, *events)}
    np.savez_compressed(stream, metadata=np.array(json.dumps(about, indent=1)), **content)


def _head(arrays: list[Labelled], about: "FileRecord") -> Iterator[str]:
    yield f"symrot {about['symrot']}: {one_line(about['title'])}"
    head = {"scene": about["scene"], "source": about["source"], "method": about["method"]}
    for key, value in {**head, "tolerance": str(about["tolerance"])}.items():
        yield f"{key}: {one_line(value)}"
    yield "columns:"
    rows = [(f"  {component}", item.unit, item.frame, item.meaning) for item in arrays for component in item.components]
    yield from columns(rows, width=1000)
    yield "invariants (largest change since the start, relative):"
    yield from columns([(f"  {i['name']}", f"{i['drift']:.3g}", i["reason"]) for i in about["invariants"]], width=1000)
    if about["events"]:
        yield "events:"
        listed = [
            (f"  {one_line(event['formula'])}", f"t = {t!r} s", kind)
            for event in about["events"]
            for t, kind in zip(event["times"], event["kinds"], strict=True)
        ]
        yield from columns(listed, width=1000)
    yield "conventions:"
    yield from (f"  {line}" for line in about["conventions"].splitlines())


def _csv(stream: BinaryIO, arrays: list[Labelled], events: list[Labelled], about: "FileRecord") -> None:
    lines = [f"# {line}".rstrip() for line in _head(arrays, about)]
    lines.append(",".join(component for item in arrays for component in item.components))
    stream.write(("\n".join(lines) + "\n").encode())
    count = len(arrays[0].values)
    for first in range(0, count, ROWS_AT_ONCE):
        part = slice(first, first + ROWS_AT_ONCE)
        table = [column for item in arrays for column in _printed(item, part)]
        stream.write("".join(f"{','.join(row)}\n" for row in zip(*table, strict=True)).encode())


def _printed(item: Labelled, part: slice) -> list[list[str]]:
    """Return the numbers of an array in a part of the samples as text, one list per component.

    The digits suffice to read back the same doubles.
    """
    values = item.values[part].reshape(-1, len(item.components)).T
    return [[str(int(x)) if item.name == LOCK else repr(x) for x in column] for column in values.tolist()]


Writer = Callable[[BinaryIO, list[Labelled], list[Labelled], "FileRecord"], None]
FORMATS: dict[str, Writer] = {
    ".npz": _npz,
    ".csv": _csv,
}
"""The suffix of a file -> the function that writes this format."""


def save(trajectory: "Trajectory", path: str | Path, quantities: Sequence[str] | None = None) -> list[str]:
    """Write a trajectory to an NPZ or CSV file and return the names of the quantities in it.

    Parameters
    ----------
    trajectory : Trajectory
        The motion to write.
    path : str or Path
        The file to write; its suffix, one of :data:`FORMATS`, decides the format.
    quantities : sequence of str, optional
        Names of the quantities to write; default: the output quantities of the scene.

    Returns
    -------
    list of str
        The names, beginning with ``t``.

    Raises
    ------
    InputError
        If the file cannot be written, if there is no quantity with one of the names, or it was not computed, or for a
        motion of an ensemble or from a file.

    Notes
    -----
    :func:`symrot.load` reads an NPZ file. It contains arrays by name, needs no pickle, and has a JSON text,
    ``metadata``. It also has the times of the requested events and the quantities at these times.

    ``pandas.read_csv(file, comment="#")`` reads a CSV file: comment lines, among them the times of the requested
    events, a line of column names, and numbers with all digits.

    Examples
    --------
    >>> import symrot, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     symrot.save(symrot.propagate("t_handle"), f"{folder}/motion.npz", ["omega", "energy"])
    ['t', 'omega', 'energy']
    """
    if not hasattr(trajectory, "at_events") or not hasattr(trajectory, "scene"):
        raise InputError(f"save: expected a trajectory, as symrot.propagate returns it, got {show(trajectory)}")
    path = path_of(path, "save")
    check_target(path, tuple(FORMATS), "save")
    arrays = labelled(trajectory, quantities)
    about = metadata(trajectory, arrays)
    events = [
        item._replace(name=event_array(number, item.name))
        for number, states in enumerate(trajectory.at_events, start=1)
        for item in labelled(states, quantities)
    ]
    writer = FORMATS[path.suffix.lower()]
    write(path, lambda stream: writer(stream, arrays, events, about))
    return [item.name for item in arrays]
