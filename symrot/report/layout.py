"""Text for people: any text on one line, numbers, durations, aligned columns, bold where a terminal shows it."""

import math
import os
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TextIO

__all__ = ["WIDTH", "apart", "columns", "duration", "emphasis", "exact", "fields", "one_line", "shown"]

WIDTH = 110
LONGEST_DENOMINATOR = 10**12
DIGITS = 17  # which tell any two doubles apart
SEEN = 0.001  # of a distance: to so much of it its ends are shown


def one_line(text: str) -> str:
    """Return text as one printable line: no control characters, whatever a scene file holds."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def shown(value: float | Fraction, digits: int = 6) -> str:
    """Return a number for people."""
    return f"{float(value):.{digits}g}"


def apart(*values: float) -> list[str]:
    """Return numbers as :func:`shown` does, with the digits it takes to see how far apart the nearest are."""
    ordered = sorted({float(value) for value in values})
    nearest = min((after - before for before, after in pairwise(ordered)), default=math.inf)
    digits = 6
    while digits < DIGITS and any(abs(float(shown(value, digits)) - value) > SEEN * nearest for value in ordered):
        digits += 1
    return [shown(value, digits) for value in values]


def exact(value: Fraction) -> str:
    """Return a number for machines: exact text, ``"51/80"``, where that is short; else the nearest double."""
    return str(value) if value.denominator <= LONGEST_DENOMINATOR else repr(float(value))


def duration(seconds: float) -> str:
    """Return a time with a unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-6:.3g} us"


def emphasis(text: str, stream: TextIO) -> str:
    """Return text bold, if the stream is a terminal that wants it (https://no-color.org)."""
    wanted = stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return f"\x1b[1m{text}\x1b[0m" if wanted else text


def _wrapped(text: str, width: int) -> list[str]:
    from textwrap import wrap

    return wrap(text, width, break_long_words=False, break_on_hyphens=False) or [""]


def fields(rows: Iterable[tuple[str, str]], width: int = WIDTH) -> list[str]:
    """Return lines of (name, text), the texts aligned and wrapped; an empty name continues the one above."""
    rows = list(rows)
    first = max((len(name) for name, _ in rows), default=0) + 2
    return [
        f"{name if number == 0 else '':<{first}}{line}".rstrip()
        for name, text in rows
        for number, line in enumerate(_wrapped(text, width - first))
    ]


def columns(rows: Sequence[Sequence[str]], width: int = WIDTH, wrap: int = -1, right: Sequence[int] = ()) -> list[str]:
    """Return a table as lines, columns aligned and two blanks apart.

    Parameters
    ----------
    rows : sequence of rows of text
        The first may be the head.
    width : int
        Of a line, kept by wrapping one column.
    wrap : int
        The column that is wrapped; the others are as wide as their widest text.
    right : sequence of int
        Columns that are set flush right.
    """
    if not rows:
        return []
    count = len(rows[0])
    wrap %= count
    widths = [max(len(row[i]) for row in rows) for i in range(count)]
    room = width - 2 * (count - 1) - sum(size for i, size in enumerate(widths) if i != wrap)
    widths[wrap] = max(1, min(widths[wrap], max(room, 20)))
    lines = []
    for row in rows:
        pieces = _wrapped(row[wrap], widths[wrap])
        for number, piece in enumerate(pieces):
            cells = [piece if i == wrap else cell if number == 0 else "" for i, cell in enumerate(row)]
            aligned = [cell.rjust(widths[i]) if i in right else cell.ljust(widths[i]) for i, cell in enumerate(cells)]
            lines.append("  ".join(aligned).rstrip())
    return lines
