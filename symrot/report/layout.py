"""Layout of text for terminals: single lines, numbers, durations, aligned columns, bold text."""

import math
import os
import sys
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TextIO

__all__ = [
    "WIDTH",
    "apart",
    "columns",
    "duration",
    "emphasis",
    "exact",
    "fields",
    "hanging",
    "number_text",
    "one_line",
    "room",
]

WIDTH = 110
NARROWEST = 40  # smallest width, in characters, to which text is wrapped
MARGIN = 2  # columns of a terminal that stay free, because lines may be indented later
LEAST = 20  # smallest width of the column that is wrapped first; after that, other columns are wrapped
LONGEST_DENOMINATOR = 10**12
DIGITS = 17  # digits that distinguish any two doubles
SEEN = 0.001  # largest rounding error of printed numbers, relative to the distance of the closest two


def one_line(text: str) -> str:
    """Return text as one printable line, without the control characters that a scene file may contain."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def number_text(value: float | Fraction, digits: int = 6) -> str:
    """Return a number as text with ``digits`` significant digits."""
    return f"{float(value):.{digits}g}"


def apart(*values: float) -> list[str]:
    """Return numbers as texts with six digits, or with more, up to 17, so that the two closest numbers look different.

    All numbers are rounded to the same number of significant digits.
    """
    ordered = sorted({float(value) for value in values})
    nearest = min((after - before for before, after in pairwise(ordered)), default=math.inf)
    digits = 6
    while digits < DIGITS and any(abs(float(number_text(value, digits)) - value) > SEEN * nearest for value in ordered):
        digits += 1
    return [number_text(value, digits) for value in values]


def exact(value: Fraction) -> str:
    """Return a fraction as text: exact, such as ``"51/80"``, if its denominator is at most 10^12, else as a double."""
    return str(value) if value.denominator <= LONGEST_DENOMINATOR else repr(float(value))


def duration(seconds: float) -> str:
    """Return a duration as text with a suitable unit, such as ``"3.2 ms"``."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-6:.3g} us"


def emphasis(text: str, stream: TextIO) -> str:
    """Return text, in bold if the stream is a terminal that shows it and NO_COLOR (https://no-color.org) is not set."""
    bold = stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return f"\x1b[1m{text}\x1b[0m" if bold else text


def room(most: int = WIDTH) -> int:
    """Return the width of printed lines in characters: ``most``, or less in a narrow terminal.

    In a terminal, lines end :data:`MARGIN` characters before its edge, but they have at least :data:`NARROWEST`. If the
    output goes to a pipe or file, the width is ``most``.
    """
    if not sys.stdout.isatty():
        return most
    from shutil import get_terminal_size  # imported here: slow, and not needed for a pipe

    return max(NARROWEST, min(most, get_terminal_size((most, 24)).columns - MARGIN))


def _wrapped(text: str, width: int) -> list[str]:
    from textwrap import wrap

    return wrap(text, width, break_long_words=False, break_on_hyphens=False) or [""]


def hanging(text: str, indent: int = 4) -> list[str]:
    """Return text as lines that fit; lines after the first are indented by ``indent`` blanks."""
    first, *rest = _wrapped(text, room())
    return [first, *(" " * indent + line for line in _wrapped(" ".join(rest), room() - indent) if line)]


def fields(rows: Iterable[tuple[str, str]], width: int | None = None) -> list[str]:
    """Return pairs (name, text) as lines in which the texts are aligned and wrapped.

    A pair with an empty name continues the pair before it.
    """
    rows, width = list(rows), room() if width is None else width
    first = max((len(name) for name, _ in rows), default=0) + 2
    return [
        f"{name if number == 0 else '':<{first}}{line}".rstrip()
        for name, text in rows
        for number, line in enumerate(_wrapped(text, width - first))
    ]


def columns(
    rows: Sequence[Sequence[str]], width: int | None = None, wrap: int = -1, right: Sequence[int] = ()
) -> list[str]:
    """Return a table as lines of text; columns are aligned and separated by two blanks.

    Parameters
    ----------
    rows : sequence of rows of text
        The first row may contain the titles of the columns.
    width : int, optional
        Width of a line. Columns of text are wrapped to fit; a table of numbers that is too wide continues in further
        parts below the first. Default: the width that :func:`room` returns.
    wrap : int
        Index of the column that is wrapped first; other columns are wrapped only if this is not enough.
    right : sequence of int
        Indices of right-aligned columns: numbers, which are never wrapped.
    """
    if not rows:
        return []
    count, width = len(rows[0]), room() if width is None else width
    wrap %= count
    widths = _widths(rows, width, wrap, right)
    lines = []
    for number, part in enumerate(_parts(widths, width, right)):
        lines += [""] * (number > 0)
        for row in rows:
            cells = [_wrapped(row[i], widths[i]) if len(row[i]) > widths[i] else [row[i]] for i in part]
            for line in range(max(map(len, cells))):
                texts = [cell[line] if line < len(cell) else "" for cell in cells]
                aligned = [
                    text.rjust(widths[i]) if i in right else text.ljust(widths[i])
                    for i, text in zip(part, texts, strict=True)
                ]
                lines.append("  ".join(aligned).rstrip())
    return lines


def _widths(rows: Sequence[Sequence[str]], width: int, wrap: int, right: Sequence[int]) -> list[int]:
    """Return the width of each column of a table: the length of its longest text, or less if it must be wrapped.

    The arguments are those of :func:`columns`.
    """
    count = len(rows[0])
    widths = [max(len(row[i]) for row in rows) for i in range(count)]
    left = width - 2 * (count - 1) - sum(size for i, size in enumerate(widths) if i != wrap)
    widths[wrap] = max(1, min(widths[wrap], max(left, LEAST)))
    words = [max((len(word) for row in rows for word in row[i].split()), default=1) for i in range(count)]
    narrowest = [widths[i] if i in right else min(widths[i], words[i]) for i in range(count)]
    if sum(narrowest) + 2 * (count - 1) > width and len(right) > 1:
        return widths  # too many numbers for one line: the table continues in further parts
    while sum(widths) + 2 * (count - 1) > width:
        wide = [i for i in range(count) if i not in right and widths[i] > words[i]]
        if not wide:
            break
        widths[max(wide, key=lambda i: widths[i])] -= 1
    return widths


def _parts(widths: Sequence[int], width: int, right: Sequence[int]) -> list[list[int]]:
    """Return how a table that is too wide for a line is split: the indices of the columns in each part.

    Every part begins with column 0; ``right`` has the indices of right-aligned columns (numbers).
    """
    parts = [[0]]
    for i in range(1, len(widths)):
        full = sum(widths[j] + 2 for j in parts[-1]) + widths[i] > width
        # only columns of numbers begin a part
        if full and i in right and len(parts[-1]) > 1:
            parts.append([0])
        parts[-1].append(i)
    return parts
