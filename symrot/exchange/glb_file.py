"""Reading of GLB files (glTF 2.0 in binary form): the triangles of all nodes of the default scene, at their places."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError
from symrot.exchange.surface import MOST_TRIANGLES, fans
from symrot.formula.exact_numbers import show

__all__ = ["read_glb"]

_JSON, _BIN = 0x4E4F534A, 0x004E4942
_TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # modes of primitives; the others are points and lines
_HARMLESS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_mesh_quantization")
"""Starts of the names of extensions that change no shape."""

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def read_glb(content: bytes) -> Mesh:
    """Return the vertices and the triangles of a GLB file, in m; all meshes of the scene form one.

    Raises
    ------
    InputError
        If the file is no GLB file, or if its shape depends on what is not read: compression, instances by an
        extension, skins, morph targets.
    """
    document, blob = _chunks(content)
    for name in document.get("extensionsRequired", []):
        if not str(name).startswith(_HARMLESS):
            raise InputError(f"expected a GLB file without the extension {show(name)}; save the mesh without it")
    vertices, triangles, count, total = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0, 0
    for node, place in _placed(document):
        mesh = document["meshes"][node["mesh"]]
        _require_rigid(node, mesh)
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) < _TRIANGLES:
                continue
            points = _values(document, blob, primitive["attributes"]["POSITION"], "VEC3")
            corners = _triangles(primitive, document, blob, len(points))
            total += len(corners)
            if total > MOST_TRIANGLES:
                raise InputError(f"expected at most {MOST_TRIANGLES} triangles, got more")
            if np.linalg.det(place[:3, :3]) < 0:  # a reflection reverses the orientation
                corners = corners[:, ::-1]
            vertices.append(points if np.array_equal(place, np.eye(4)) else points @ place[:3, :3].T + place[:3, 3])
            triangles.append(corners + count)
            count += len(points)
    return np.concatenate(vertices), np.concatenate(triangles)


def _chunks(content: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the document and the binary data of a GLB file."""
    if content[:4] != b"glTF" or int.from_bytes(content[4:8], "little") != 2:
        raise InputError("expected a GLB file of version 2, got a file of another format")
    parts: dict[int, bytes] = {}
    offset = 12
    while offset + 8 <= len(content):
        length, kind = (int.from_bytes(content[offset + k : offset + k + 4], "little") for k in (0, 4))
        chunk = content[offset + 8 : offset + 8 + length]
        if len(chunk) < length:
            raise InputError("expected a complete GLB file, got one that ends early")
        parts.setdefault(kind, chunk)
        offset += 8 + length
    document = json.loads(parts[_JSON])
    if not isinstance(document, dict):
        raise InputError("expected an object of JSON in a GLB file, got another value")
    return document, parts.get(_BIN, b"")


def _placed(document: Mapping[str, Any]) -> Iterator[tuple[Mapping[str, Any], NDArray[np.float64]]]:
    """Yield each node of the default scene that has a mesh, with the matrix that maps its points to the scene."""
    scenes, nodes = document.get("scenes", []), document.get("nodes", [])
    if "scene" not in document and len(scenes) != 1:
        raise InputError(f"expected a GLB file with a default scene, got {len(scenes)} scenes and no default")
    visited: set[int] = set()
    waiting = [(index, np.eye(4)) for index in scenes[document.get("scene", 0)].get("nodes", [])]
    while waiting:
        index, above = waiting.pop()
        if index in visited:
            raise InputError(f"expected each node of a GLB file once, got node {index} twice")
        visited.add(index)
        node = nodes[index]
        place = above @ _matrix(node)
        waiting += [(child, place) for child in node.get("children", [])]
        if "mesh" in node:
            yield node, place


def _matrix(node: Mapping[str, Any]) -> NDArray[np.float64]:
    """Return the matrix of a node, given as a matrix, or as translation, rotation (scalar last) and scale."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = np.array(node.get("rotation", (0, 0, 0, 1)), np.float64)
    norm = x * x + y * y + z * z + w * w
    if not norm:
        raise InputError("expected a quaternion that is not zero as the rotation of a node, got zero")
    matrix[:3, :3] += (2 / norm) * np.array([
        [-y * y - z * z, x * y - w * z, x * z + w * y],
        [x * y + w * z, -x * x - z * z, y * z - w * x],
        [x * z - w * y, y * z + w * x, -x * x - y * y],
    ])  # fmt: skip
    matrix[:3, :3] *= np.array(node.get("scale", (1, 1, 1)), np.float64)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def _require_rigid(node: Mapping[str, Any], mesh: Mapping[str, Any]) -> None:
    """Raise InputError if the shape of a mesh at a node depends on what is not read."""
    faults = ["instances by an extension"] if "EXT_mesh_gpu_instancing" in node.get("extensions", {}) else []
    faults += ["a skin"] if "skin" in node else []
    faults += ["morph targets"] if any(node.get("weights") or mesh.get("weights") or ()) else []
    if faults:
        raise InputError(f"expected a mesh of triangles alone, got {faults[0]}; save the shape as it is shown")


def _triangles(primitive: Mapping[str, Any], document: Mapping[str, Any], blob: bytes, count: int) -> NDArray[np.int64]:
    """Return the triangles of a primitive with ``count`` vertices, as indices of its vertices."""
    corners = np.arange(count)
    if "indices" in primitive:
        corners = _values(document, blob, primitive["indices"], "SCALAR").astype(np.int64).reshape(-1)
    mode = primitive.get("mode", _TRIANGLES)
    if mode == _FAN:
        return fans(np.array([len(corners)]), corners)
    if mode == _STRIP:
        triangles = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        triangles[1::2] = triangles[1::2, [1, 0, 2]]  # every second one has the opposite orientation
        return triangles
    if mode != _TRIANGLES:
        raise InputError(f"expected a mode of a primitive from 0 to 6, got {show(mode)}")
    return corners.reshape(-1, 3)


def _values(document: Mapping[str, Any], blob: bytes, index: int, form: str) -> NDArray[Any]:
    """Return the values of an accessor, a row for each, as doubles."""
    accessor = document["accessors"][index]
    if accessor["type"] != form:
        raise InputError(f"expected an accessor of the type {form}, got {show(accessor['type'])}")
    kind, width, count = np.dtype(_TYPES[accessor["componentType"]]), _WIDTHS[form], accessor["count"]
    if not 0 <= count <= 3 * MOST_TRIANGLES:
        raise InputError(f"expected at most {3 * MOST_TRIANGLES} values of an accessor, got {show(count)}")
    values = np.zeros((count, width))
    if "bufferView" in accessor:
        values[:] = _stored(document, blob, accessor["bufferView"], accessor, kind, (count, width))
    elif "sparse" not in accessor:
        raise InputError("expected the values of an accessor in the GLB file, got none")
    if "sparse" in accessor:
        sparse = accessor["sparse"]
        where, what = sparse["indices"], sparse["values"]
        places = _stored(
            document, blob, where["bufferView"], where, np.dtype(_TYPES[where["componentType"]]), (sparse["count"], 1)
        )
        values[places[:, 0]] = _stored(document, blob, what["bufferView"], what, kind, (sparse["count"], width))
    if accessor.get("normalized") and kind.kind in "iu":
        values = np.maximum(values / np.iinfo(kind).max, -1)
    return values


def _stored(
    document: Mapping[str, Any],
    blob: bytes,
    view: int,
    owner: Mapping[str, Any],
    kind: np.dtype[Any],
    shape: tuple[int, int],
) -> NDArray[Any]:
    """Return an array of the given shape in a view of the buffer; ``owner`` has its offset within the view."""
    place = document["bufferViews"][view]
    if place["buffer"] != 0 or "uri" in document["buffers"][0]:
        raise InputError("expected a GLB file that contains its buffer, got a reference to another file")
    start = place.get("byteOffset", 0)
    data = memoryview(blob)[start : start + place["byteLength"]]
    stride = place.get("byteStride", shape[1] * kind.itemsize)
    return np.ndarray(shape, kind, data, owner.get("byteOffset", 0), (stride, kind.itemsize))
