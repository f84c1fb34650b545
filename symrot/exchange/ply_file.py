"""Reading of PLY files: vertices and polygons, as text or in binary form of either byte order."""

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.exchange.surface import fans
from symrot.exchange.text_numbers import numbers_of
from symrot.formula.exact_numbers import show

__all__ = ["read_ply"]

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_END = re.compile(rb"^end_header[ \t]*(?:\r\n|\n|\r)", re.MULTILINE)
_CORNERS = ("vertex_indices", "vertex_index")


Column = NDArray[Any]


class _Property(NamedTuple):
    """A number of each record of an element, or a list of numbers: its name, and its types as NumPy names them."""

    name: str
    kind: str
    length_kind: str = ""  # type of the length of a list


class _Element(NamedTuple):
    name: str
    number: int
    properties: list[_Property]


def read_ply(content: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the vertices of a PLY file, and its polygons as triangles: each polygon is a fan about its first corner.

    Raises
    ------
    InputError
        If the header or the number of values is wrong, or if vertices or polygons are missing.
    """
    end = _END.search(content)
    if not content.startswith(b"ply") or not end:
        raise InputError("expected a header of a PLY file, from ply to end_header, got none")
    is_text, elements = _header(content[: end.start()].decode("latin-1"))
    data = content[end.end() :]
    if is_text:  # its numbers become doubles, which are read like those of a binary file
        numbers = numbers_of(data)
        if numbers is None:
            raise InputError("expected numbers after the header of a PLY file, got other text")
        data = numbers.tobytes() if data.strip() else b""
    columns, offset = {}, 0
    for element in elements:
        columns[element.name], offset = _columns(data, offset, element)
    if offset != len(data):
        raise InputError("expected a PLY file that ends where its header says, got a longer one")
    if any(element.name == "tristrips" and element.number for element in elements):
        raise InputError("expected polygons (element face) in a PLY file, got strips of triangles (tristrips)")
    return _surface(columns)


def _header(text: str) -> tuple[bool, list[_Element]]:
    """Return whether the values of a file are text, and its elements."""
    order: str | None = None
    elements: list[_Element] = []

    def kind(word: str) -> str:
        if order is None:
            raise ValueError
        name = _TYPES[word]
        return order + name if order else "<f8"

    for line in text.splitlines()[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        try:
            if words[0] == "format":
                order = _ORDERS[words[1]]
            elif words[0] == "element":
                elements.append(_Element(words[1], int(words[2]), []))
            elif words[:2] == ["property", "list"]:
                elements[-1].properties.append(_Property(words[4], kind(words[3]), kind(words[2])))
            elif words[0] == "property":
                elements[-1].properties.append(_Property(words[2], kind(words[1])))
            else:
                raise ValueError
        except (KeyError, ValueError, IndexError):
            raise InputError(f"expected lines of a PLY header, got {show(line.strip())}") from None
    return not order, elements


def _columns(data: bytes, offset: int, element: _Element) -> tuple[dict[str, tuple[Column, Column]], int]:
    """Return, for each property of an element, the lengths of its lists and all their numbers, one after the other.

    A number is a list of the length 1. The second result is the offset behind the element.
    """
    if not element.number:
        nothing = np.empty(0, np.int64)
        return {each.name: (nothing, nothing) for each in element.properties}, offset
    lengths, size = _lengths(data, offset, element)
    fields: list[tuple[Any, ...]] = []
    for each, length in zip(element.properties, lengths, strict=True):
        fields += [(f"length of {each.name}", each.length_kind)] if each.length_kind else []
        fields.append((each.name, each.kind, (length,)))
    # nearly always, all records have lists of the same lengths
    if offset + element.number * size <= len(data):
        rows = np.frombuffer(data, np.dtype(fields), element.number, offset)
        pairs = list(zip(element.properties, lengths, strict=True))
        if all(np.all(rows[f"length of {each.name}"] == length) for each, length in pairs if each.length_kind):
            columns = {each.name: (np.full(element.number, length), rows[each.name].ravel()) for each, length in pairs}
            return columns, offset + element.number * size
    return _records(data, offset, element)


def _lengths(data: bytes, offset: int, element: _Element) -> tuple[list[int], int]:
    """Return the lengths of the lists of the record at ``offset``, and the size of the record in bytes."""
    lengths, place = [], offset
    for each in element.properties:
        length = 1
        if each.length_kind:
            length = int(np.frombuffer(data, each.length_kind, 1, place)[0])
            place += np.dtype(each.length_kind).itemsize
        lengths.append(length)
        place += length * np.dtype(each.kind).itemsize
    return lengths, place - offset


def _records(data: bytes, offset: int, element: _Element) -> tuple[dict[str, tuple[Column, Column]], int]:
    """Return the same as :func:`_columns`, for lists of different lengths."""
    lengths: dict[str, list[int]] = {each.name: [] for each in element.properties}
    values: dict[str, list[Column]] = {each.name: [] for each in element.properties}
    sizes = [(each, np.dtype(each.kind).itemsize, each.length_kind and np.dtype(each.length_kind).itemsize)
             for each in element.properties]  # fmt: skip
    for _ in range(element.number):
        for each, size, count_size in sizes:
            length = 1
            if count_size:
                length = int(np.frombuffer(data, each.length_kind, 1, offset)[0])
                offset += count_size
            values[each.name].append(np.frombuffer(data, each.kind, length, offset))
            lengths[each.name].append(length)
            offset += length * size
    return {name: (np.array(lengths[name], np.int64), np.concatenate(values[name])) for name in values}, offset


def _surface(
    columns: Mapping[str, Mapping[str, tuple[Column, Column]]],
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    vertex, face = columns.get("vertex", {}), columns.get("face", {})
    if not {"x", "y", "z"} <= vertex.keys():
        raise InputError("expected the properties x, y, z of the element vertex in a PLY file, got none")
    vertices = np.column_stack([vertex[axis][1].astype(np.float64) for axis in "xyz"])
    name = next((name for name in _CORNERS if name in face), None)
    if name is None:
        if face:
            raise InputError(f"expected the property {_CORNERS[0]} of the element face in a PLY file, got none")
        return vertices, np.empty((0, 3), np.int64)
    counts, corners = face[name]
    indices = corners.astype(np.int64)
    if not np.array_equal(indices, corners):
        raise InputError("expected whole numbers as corners of polygons in a PLY file, got others")
    return vertices, fans(counts, indices)
