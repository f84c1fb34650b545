"""Reading of OBJ files: vertices and polygons; files whose lines have one common form are read fast."""

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.exchange.surface import fans
from symrot.exchange.text_numbers import numbers_of
from symrot.formula.exact_numbers import show

__all__ = ["read_obj", "read_plain_obj"]

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]

_SPACE, _NEWLINE, _SLASH = 32, 10, 47
_IGNORED = np.zeros(256, bool)  # first letters of lines without geometry: blank, comment, o, g, usemtl, mtllib
_IGNORED[list(b"\n\r#ogum")] = True
_OTHER_SURFACES = {"surf": "a free-form surface", "call": "a reference to another file"}
_FLOAT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf)", re.ASCII)


def read_obj(content: bytes) -> Mesh:
    """Return the vertices of an OBJ file, and its polygons as triangles: each polygon is a fan about its first corner.

    Raises
    ------
    InputError
        If a line of a vertex or polygon has other text, or if the file has free-form surfaces or calls other files.
    """
    content = content.removeprefix(b"\xef\xbb\xbf")  # mark of UTF-8
    plain = read_plain_obj(content)
    if plain is not None:
        return plain
    text = content.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").replace("\\\n", " ")
    vertices: list[list[float]] = []
    counts, corners = [], []
    for number, line in enumerate(text.split("\n"), 1):
        key, *words = line.partition("#")[0].split() or [""]
        if key == "v":
            if len(words) < 3 or not all(map(_FLOAT.fullmatch, words[:3])):
                raise InputError(f"expected three numbers of a vertex in line {number}, got {show(line.strip())}")
            vertices.append([float(word) for word in words[:3]])
        elif key in ("f", "fo"):
            counts.append(len(words))
            corners += [_corner(word, len(vertices), number) for word in words]
        elif key in _OTHER_SURFACES:
            raise InputError(f"expected a mesh of polygons, got {_OTHER_SURFACES[key]} in line {number}, {show(key)}")
    points = np.array(vertices, np.float64).reshape(-1, 3)
    return points, fans(np.array(counts, np.int64), np.array(corners, np.int64))


def _corner(word: str, above: int, line: int) -> int:
    """Return the index, from 0, of a corner such as ``7/2/3``; ``above`` is the number of vertices above its line."""
    text = word.partition("/")[0]
    if not re.fullmatch(r"-?\d{1,18}", text, re.ASCII) or not int(text) or int(text) < -above:
        raise InputError(f"expected the numbers of vertices of a polygon in line {line}, got {show(word)}")
    # a negative number counts backwards from the last vertex above the line
    return int(text) - 1 if int(text) > 0 else above + int(text)


def read_plain_obj(content: bytes) -> Mesh | None:
    """Return the vertices and the triangles, as indices from 0, of an OBJ file; None if its form is not the common one.

    The numbers of a vertex line are x, y, z; those of a triangle may carry texture and normal: ``f 1/4/2 3/1/2 2/2/2``.
    """
    if any(blank in content for blank in (b"\t", b"\v", b"\f")):
        return None
    if b"\\" in content and (b"\\\n" in content or b"\\\r" in content):  # lines that go on
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
    if (triangles <= 0).any():
        above = np.cumsum(is_vertex)[is_triangle][:, None]
        if (triangles == 0).any() or (triangles < -above).any():
            return None
        triangles = np.where(triangles < 0, above + triangles + 1, triangles)
    return vertices.reshape(-1, 3), triangles - 1


def _numbers(lines: NDArray[np.uint8], letter: bytes, kind: Any) -> NDArray[Any] | None:
    """Return the numbers of lines that start with ``letter``, with a row for each of the three items of a line.

    ``f 1/4 3/1 2/2`` gives the rows (1, 4), (3, 1), (2, 2). None unless all lines have the same form.
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
    numbers = numbers_of(text.translate(bytes.maketrans(letter + b"/", b"  ")), kind)
    # As no line has more than three items, none has fewer if there are as many as three on each.
    if numbers is None or len(numbers) != 3 * count * columns:
        return None
    return numbers.reshape(-1, columns)
