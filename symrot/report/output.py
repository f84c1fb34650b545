"""Writing of trajectories to NPZ or CSV files, with labels, units, conventions and the name of the scene.

Equal motions give files with equal bytes.
"""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from symrot import __version__, conventions
from symrot.files.writing import write
from symrot.report.layout import columns, exact, one_line
from symrot.results.labels import LOCK, Labelled, labelled

if TYPE_CHECKING:
    from symrot.propagation.trajectory import Trajectory
    from symrot.report.records import FileRecord

__all__ = ["FORMATS", "metadata", "save"]

ROWS_AT_ONCE = 4096


def metadata(trajectory: "Trajectory", arrays: list[Labelled], tolerance: float) -> "FileRecord":
    """Return the description for the head of a trajectory file: scene, method, meaning of each array, conventions."""
    scene, stats = trajectory.scene, trajectory.stats
    return {
        "symrot": __version__,
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "method": trajectory.method,
        "tolerance": tolerance,
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
        "conventions": _conventions(),
    }  # fmt: skip


def _conventions() -> str:
    return (conventions.__doc__ or "").split("\n", 2)[-1].strip()


def _npz(stream: BinaryIO, arrays: list[Labelled], about: "FileRecord") -> None:
    content: dict[str, Any] = {item.name: item.values for item in arrays}
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
    yield "conventions:"
    yield from (f"  {line}" for line in about["conventions"].splitlines())


def _csv(stream: BinaryIO, arrays: list[Labelled], about: "FileRecord") -> None:
    lines = [f"# {line}".rstrip() for line in _head(arrays, about)]
    lines.append(",".join(component for item in arrays for component in item.components))
    stream.write(("\n".join(lines) + "\n").encode())
    count = len(arrays[0].values)
    for first in range(0, count, ROWS_AT_ONCE):
        part = slice(first, first + ROWS_AT_ONCE)
        table = [column for item in arrays for column in _printed(item, part)]
        stream.write("".join(f"{','.join(row)}\n" for row in zip(*table, strict=True)).encode())


def _printed(item: Labelled, part: slice) -> list[list[str]]:
    """Return the numbers of a quantity as text, one list per component, with enough digits to restore the doubles."""
    values = item.values[part].reshape(-1, len(item.components)).T
    return [[str(int(x)) if item.name == LOCK else repr(x) for x in column] for column in values.tolist()]


FORMATS: dict[str, Callable[[BinaryIO, list[Labelled], "FileRecord"], None]] = {".npz": _npz, ".csv": _csv}
"""The suffix of a file -> the function that writes this format."""


def save(trajectory: "Trajectory", path: Path, tolerance: float) -> list[str]:
    """Write the output quantities of a trajectory to a file and return their names.

    An NPZ file contains arrays by name and ``metadata``, a JSON text; it can be loaded with ``allow_pickle=False``. A
    CSV file contains comment lines, a line of column names, and numbers with all digits (``pandas.read_csv(file,
    comment="#")``).

    Parameters
    ----------
    trajectory : Trajectory
        The motion to write.
    path : Path
        The file to write; its suffix, one of :data:`FORMATS`, decides the format.
    tolerance : float
        The tolerance of the propagation, which is noted in the file.
    """
    arrays = labelled(trajectory)
    about = metadata(trajectory, arrays, tolerance)
    writer = FORMATS[path.suffix.lower()]
    write(path, lambda stream: writer(stream, arrays, about))
    return [item.name for item in arrays]
