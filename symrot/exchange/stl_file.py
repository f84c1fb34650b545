"""Reading of STL files, in binary form and as text: three vertices for each triangle."""

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.exchange.text_numbers import numbers_of

__all__ = ["read_stl"]

_HEADER = 84  # bytes: a text, and the number of triangles
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_LINE = re.compile(rb"^[ \t]*(solid|endsolid|#)[^\n]*$", re.MULTILINE)  # the rest of the line is any text
_FACET = re.compile(rb"facet\s+normal\s+\S+\s+\S+\s+\S+\s+outer\s+loop")  # a normal may be nan
_WORDS = ((b"vertex", 3), (b"endloop", 1), (b"endfacet", 1))


def read_stl(content: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the vertices and the triangles of an STL file; normals are not used, as the order of vertices gives them.

    Raises
    ------
    InputError
        If the file is neither a complete binary file nor a complete text of triangles.
    """
    if len(content) >= _HEADER:
        count = int.from_bytes(content[_HEADER - 4 : _HEADER], "little")
        if len(content) == _HEADER + count * _TRIANGLE.itemsize:
            corners = np.frombuffer(content, _TRIANGLE, count, _HEADER)["corners"].reshape(-1, 3)
            return _surface(corners.astype(np.float64))
    return _surface(_of_text(content))


def _surface(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return corners, np.arange(len(corners)).reshape(-1, 3)


def _of_text(content: bytes) -> Any:
    text = content.lower().replace(b"\r", b"\n")
    lines = _LINE.findall(text)
    text, count = _FACET.subn(b" ", _LINE.sub(b" ", text))
    # the counts show a file that ends early, or in which a triangle has two or four vertices
    is_complete = 0 < lines.count(b"solid") == lines.count(b"endsolid")
    if not is_complete or any(text.count(word) != number * count for word, number in _WORDS):
        raise InputError("expected a mesh in the format STL, got a file of another format or one that ends early")
    for word, _ in _WORDS:
        text = text.replace(word, b" ")
    values = numbers_of(text)
    if values is None or len(values) != 9 * count:
        raise InputError("expected three numbers for each vertex of an STL file, got other text")
    return values.reshape(-1, 3)
