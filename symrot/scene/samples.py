"""Torques given by samples: by a table in the scene itself, or by a CSV file in the folder of the scene."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from symrot.dynamics.torque_kinds import TABLE_KIND
from symrot.errors import InputError
from symrot.files.reading import read_input
from symrot.scene.folders import Folders
from symrot.scene.reader import Entry, choice, fail, number, read_table, text, vector

__all__ = ["COLUMNS", "LARGEST_FILE", "MOST_SAMPLES", "Table", "read_samples"]

COLUMNS = ("t", "M1", "M2", "M3")
"""The first line of a file of samples: time in s, components of the torque in N m."""

LARGEST_FILE = 20_000_000
"""Largest size, in bytes, of a file of samples."""

MOST_SAMPLES = 200_000

_STEEPEST = 1e100


class Table(NamedTuple):
    """A torque given by samples.

    Between switching times a cubic spline interpolates the samples. Before the first and after the last sample the
    torque is not defined.

    Attributes
    ----------
    times : tuple of float
        Times of the samples, s, in increasing order; each switching time occurs twice.
    moments : tuple of tuples of 3 floats
        Components of the torque at these times, N m.
    frame : str
        ``"body"`` or ``"space"``: the frame of the components.
    switching_times : tuple of float
        Times, s, at which the torque jumps.

    Examples
    --------
    >>> import symrot
    >>> symrot.Table((0.0, 1.0), ((0.0, 0.0, 1.0),) * 2, "body", ()).kind
    'table'
    """

    times: tuple[float, ...]
    moments: tuple[tuple[float, float, float], ...]
    frame: str  # "body" or "space"
    switching_times: tuple[float, ...]

    @property
    def kind(self) -> str:
        """The kind of this torque, always ``"table"``; other torques have an attribute of this name too."""
        return TABLE_KIND.kind


_time = number("a time in s")
_moment = vector("N m")


def _plain(value: Any) -> bool:
    """Return whether a value is a finite float of ordinary size (or 0.0), so that it needs no further check.

    A table of many samples is read faster in this way.
    """
    return type(value) is float and (1e-99 < abs(value) < 1e99 or value == 0.0)


def _times(value: Any, where: str) -> tuple[float, ...]:
    if not isinstance(value, list | tuple):
        fail(where, "a list of times in s", value)
    return tuple(item if _plain(item) else float(_time(item, f"{where}[{index}]")) for index, item in enumerate(value))


def _moments(value: Any, where: str) -> tuple[tuple[float, ...], ...]:
    if not isinstance(value, list | tuple):
        fail(where, "a list of torques, each three numbers [x, y, z] in N m", value)
    return tuple(
        tuple(item)
        if isinstance(item, list | tuple) and len(item) == 3 and all(map(_plain, item))
        else tuple(map(float, _moment(item, f"{where}[{index}]")))
        for index, item in enumerate(value)
    )


_ENTRIES = {
    "kind": Entry(choice(TABLE_KIND.kind), required=True),
    "t": Entry(_times),
    "moment": Entry(_moments),
    "file": Entry(text),
    "interpolation": Entry(choice("cubic_spline")),
    "frame": Entry(choice("body", "space"), default="body"),
    "switching_times": Entry(_times, default=()),
}


def read_samples(
    value: Mapping[str, Any],
    folder: Path,
    where: str,
    span: tuple[Fraction, Fraction],
    table_folders: str | Path | Sequence[str | Path] = (),
) -> Table:
    """Return the samples of a ``[[torque]]`` of kind table; they must cover the time span of the scene.

    Parameters
    ----------
    value : mapping
        The table of the scene.
    folder : Path
        Folder of the scene. A file of samples must be in this folder or below it, after links are followed.
    where : str
        File and key of the torque, for error messages.
    span : 2 Fractions
        First and last time of the scene, s.
    table_folders : str, Path or sequence of them
        Further folders that may contain files of samples.

    Raises
    ------
    InputError
        If a key is unknown, the samples are given neither by ``t`` and ``moment`` nor by a file, the file is in another
        folder or cannot be read, or the samples are not numbers, are too few or too many, are not in order, or do not
        cover the span.
    """
    values = read_table(value, where, _ENTRIES, "a torque of kind table")
    written = [key for key in ("t", "moment") if values[key] is not None]
    if (values["file"] is None) == (not written) or len(written) == 1:
        present = [key for key in ("t", "moment", "file") if values[key] is not None]
        fail(where, f"the keys t and moment, or the key file, got {' and '.join(present) or 'none of them'}")
    lines: tuple[int, ...] = ()
    if written:
        times, moments, place = values["t"], values["moment"], f"{where}.t"
        if len(times) != len(moments):
            fail(f"{where}.moment", f"one torque for each of the {len(times)} times, got {len(moments)}")
        if len(times) > MOST_SAMPLES:
            fail(place, f"at most {MOST_SAMPLES} samples", len(times))
    else:
        place = f"{where}.file: {values['file']}"
        path = Folders(folder, table_folders).file(values["file"], f"{where}.file", "a CSV file")
        times, moments, lines = _read_file(path, place)
    _check(times, values["switching_times"], place, lines)
    _check_slopes(times, moments, place)
    twice = {after for before, after in pairwise(times) if after == before}
    for switch in values["switching_times"]:
        if switch not in twice:
            fail(f"{where}.switching_times", "times that occur twice among the times of the samples, first with the "
                     f"torque before the jump and then with the torque after it, got {switch!r} s, which does not "
                     "occur twice")  # fmt: skip
    first, last = map(float, span)
    if times[0] > first or times[-1] < last:
        fail(place, f"samples that cover the span of the scene, {first!r} to {last!r} s, got {times[0]!r} to "
                 f"{times[-1]!r} s")  # fmt: skip
    return Table(times, moments, values["frame"], tuple(sorted(set(values["switching_times"]))))


def _check(times: tuple[float, ...], switching: tuple[float, ...], place: str, lines: Sequence[int]) -> None:
    """Raise InputError unless the times increase; only one of ``switching``, the switching times, may occur twice.

    There must be two samples or more before, between and after the times that occur twice. ``lines`` are the numbers of
    the samples' lines in their file ``place``; empty for samples in the scene.
    """
    if len(times) < 2:
        fail(place, f"two samples or more, got {len(times)}")
    length = 1
    for index, (before, after) in enumerate(pairwise(times), start=1):
        at = f"{place}, line {lines[index]}" if lines else f"{place}[{index}]"
        if after < before:
            fail(at, f"increasing times, got {after!r} s after {before!r} s")
        if after == before and after not in switching:
            fail(at, "increasing times; only a switching time may occur twice, for the samples before and after the "
                     f"jump, got {after!r} s twice")  # fmt: skip
        if after == before and length < 2:
            fail(at, f"two samples or more between switching times, got only one, at {after!r} s")
        length = 1 if after == before else length + 1
    if length < 2:
        fail(place, f"two samples or more between switching times, got only one, at {times[-1]!r} s")


def _check_slopes(times: tuple[float, ...], moments: tuple[tuple[float, ...], ...], place: str) -> None:
    """Raise InputError if a coefficient of the spline through the samples could be too large for a double.

    ``times`` are the times of the samples, s, and ``moments`` the components of the torque at these times, N m.
    ``place`` names the samples in the message.
    """
    for (before, here), (after, there) in pairwise(zip(times, moments, strict=True)):
        gap, change = after - before, max(abs(y - x) for x, y in zip(here, there, strict=True))
        if gap and not (gap >= 1 / _STEEPEST and change <= gap * _STEEPEST):
            fail(place, f"samples at least {1 / _STEEPEST:g} s apart and a torque that changes by at most "
                     f"{_STEEPEST:g} N m/s between them, got {change!r} N m within {gap!r} s after {before!r} "
                     "s")  # fmt: skip


def _read_file(
    path: Path, place: str
) -> tuple[tuple[float, ...], tuple[tuple[float, float, float], ...], tuple[int, ...]]:
    """Return times, s, torques, N m, and line numbers of the samples in a CSV file with the first line ``t,M1,M2,M3``.

    Each other line holds one sample or is blank. ``place`` names the file in errors.
    """
    expectation = f"a CSV file with the columns {', '.join(COLUMNS)}"
    try:
        content = read_input(path, LARGEST_FILE)
    except OSError as reason:
        fail(place, f"{expectation}, at most {LARGEST_FILE // 1_000_000} MB, got {reason.strerror or reason}")
    try:
        lines = content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as reason:
        fail(place, f"UTF-8 text, got a byte of another encoding at position {reason.start}")
    if not any(line.strip() for line in lines):
        fail(place, f"{expectation}, got an empty file")
    if tuple(cell.strip() for cell in lines[0].split(",")) != COLUMNS:
        fail(f"{place}, line 1", f"the columns {', '.join(COLUMNS)}, got other text")
    numbers = tuple(index for index, line in enumerate(lines[1:], start=2) if line.strip())
    rows = [_row(lines[index - 1], f"{place}, line {index}") for index in numbers]
    if len(rows) > MOST_SAMPLES:
        fail(place, f"at most {MOST_SAMPLES} samples, got {len(rows)}")
    return tuple(row[0] for row in rows), tuple((row[1], row[2], row[3]) for row in rows), numbers


def _row(line: str, place: str) -> list[float]:
    def refuse() -> NoReturn:
        raise InputError(f"{place}: expected four finite numbers {', '.join(COLUMNS)}, got {line[:80]!r}")

    if not line.isascii() or "_" in line:  # float() would accept such a number
        refuse()
    try:
        numbers = [float(cell) for cell in line.split(",")]
    except ValueError:
        refuse()
    if len(numbers) != len(COLUMNS) or not all(map(isfinite, numbers)) or max(map(abs, numbers)) > 1e100:
        refuse()
    return numbers
