"""Fast reading of OBJ files of the common form: lines of vertices and of triangles, each line like the others.

All other files are left to trimesh, which reads each line by itself: for example, files with polygons of more than
three corners, or with a backslash at the end of a line, which joins it to the next line.
"""

import re
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["read_plain_obj", "refers_backwards"]

_SPACE, _NEWLINE, _SLASH = 32, 10, 47
_IGNORED = np.zeros(256, bool)  # first letters of lines without geometry: blank, comment, o, g, usemtl, mtllib
_IGNORED[list(b"\n\r#ogum")] = True
_BACKWARDS = re.compile(rb"^[ \t]*f[ \t](?:[^\n#]*[ \t])?(?:-\d|0+(?![\d.]))", re.MULTILINE)


def refers_backwards(content: bytes) -> bool:
    """Return whether a polygon of an OBJ file has a corner with a number that is not positive, such as ``f -3 -2 -1``.

    Negative numbers count vertices backwards from the line of the polygon.
    """
    return _BACKWARDS.search(content.replace(b"\r\n", b"\n").replace(b"\\\n", b"")) is not None


def read_plain_obj(content: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64]] | None:
    """Return the vertices and the triangles, as indices from 0, of an OBJ file; None if its form is not the common one.

    The numbers of a vertex line are x, y, z; those of a triangle may carry texture and normal: ``f 1/4/2 3/1/2 2/2/2``.
    """
    if any(blank in content for blank in (b"\t", b"\v", b"\f")):
        return None
    if b"\\" in content and (b"\\\n" in content or b"\\\r" in content):  # lines continued on the next line
        return None
    if b"\r" in content and content.count(b"\r") != content.count(b"\r\n"):
        return None
    data = np.frombuffer(content if content.endswith(b"\n") else content + b"\n", np.uint8)
    ends = np.flatnonzero(data == _NEWLINE)
    starts = np.append(0, ends[:-1] + 1)
    first, second = data[starts], data[np.minimum(starts + 1, len(data) - 1)]
    is_vertex = (first == ord("v")) & (second == _SPACE)
    is_triangle = (first == ord("f")) & (second == _SPACE)
    is_other = (first == ord("v")) & ((second == ord("n")) | (second == ord("t")))  # a normal or a texture
    is_other |= (first == ord("s")) & (second == _SPACE)  # smoothing
    if not np.all(is_vertex | is_triangle | is_other | _IGNORED[first]):
        return None
    lengths = np.diff(ends, prepend=-1)
    vertices = _numbers(data[np.repeat(is_vertex, lengths)], b"v", np.float64)
    corners = _numbers(data[np.repeat(is_triangle, lengths)], b"f", np.int64)
    if vertices is None or corners is None or vertices.shape[1] != 1:
        return None
    triangles = corners[:, 0].reshape(-1, 3)
    if (triangles <= 0).any():  # a negative number counts backwards from the last vertex above the line
        above = np.cumsum(is_vertex)[is_triangle][:, None]
        triangles = np.where(triangles < 0, above + triangles + 1, triangles)
    return vertices.reshape(-1, 3), triangles - 1


def _numbers(lines: NDArray[np.uint8], letter: bytes, kind: Any) -> NDArray[Any] | None:
    """Return the numbers in lines that start with ``letter``, one row for each of the three words after the letter.

    ``f 1/4 3/1 2/2`` gives the rows (1, 4), (3, 1), (2, 2). The result is None if the lines differ in form, or if a
    word contains anything but numbers.
    """
    separators = lines[(lines == _SPACE) | (lines == _NEWLINE) | (lines == _SLASH)]
    size = int((separators == _NEWLINE).argmax()) + 1 if len(separators) else 1
    form = separators[:size]
    count = len(separators) // size
    if len(separators) != count * size or not np.all(separators.reshape(-1, size) == form):
        return None
    slashes = (size - 4) // 3
    item = [_SPACE, *[_SLASH] * slashes]
    if not 0 <= slashes <= 2 or form.tolist() != [*item, *item, *item, _NEWLINE]:
        return None
    text = lines.tobytes()
    columns = slashes + 1
    if slashes == 2 and b"//" in text:  # a normal without a texture
        columns = 2
        if text.count(b"//") != 3 * count:
            return None
    if text.count(letter) != count:
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # of text that is no number
            numbers = np.fromstring(text.translate(bytes.maketrans(letter + b"/", b"  ")), dtype=kind, sep=" ")
    except (ValueError, DeprecationWarning):
        return None
    # As no line has more than three items, none has fewer if there are as many as three on each.
    return numbers.reshape(-1, columns) if len(numbers) == 3 * count * columns else None
