"""Tests of mesh files before trimesh reads them: parts that trimesh would silently drop are refused."""

import json
import re
from array import array
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from symrot.errors import InputError
from symrot.exchange.polygons import bent_polygons
from symrot.formula.exact_numbers import show

__all__ = ["EARLY_END", "FACTS_OF", "Facts"]

_HARMLESS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_mesh_quantization")
"""Starts of the names of extensions of GLB files that change no shape."""
_STRIP, _FAN = 5, 6  # modes of primitives in GLB files; 4 are triangles, less are points and lines
_OTHER_SHAPES = {"surf": "a free-form surface", "call": "a reference to another file", "fo": "a polygon in an old form"}
EARLY_END = "expected a mesh in the format {}, got a file of another format or one that ends early"


class Facts(NamedTuple):
    """Facts about a mesh that are read from its file before trimesh reads the mesh."""

    triangles: int | None = None  # after the division of polygons; None: trimesh itself refuses a file that ends early
    bent: int = 0  # polygons that are not flat


def _stl(content: bytes) -> Facts:
    """Return the facts about an STL file, given its ``content``: its number of triangles.

    InputError is raised if the file is neither binary with the length that this number requires, nor a text whose last
    line begins with ``endsolid``.
    """
    count = int.from_bytes(content[80:84], "little")
    if len(content) == 84 + 50 * count:
        return Facts(count)
    text = content.lower()
    last = text[-1000:].splitlines() or [b""]
    if not next((line.strip() for line in reversed(last) if line.strip()), b"").startswith(b"endsolid"):
        raise InputError(EARLY_END.format("STL"))
    return Facts(text.count(b"endfacet"))


def _obj(content: bytes) -> Facts:
    """Return the facts about an OBJ file: into how many triangles its polygons are divided, and how many are not flat.

    InputError is raised for lines that trimesh would ignore or misread, such as free-form surfaces.
    """
    count, form, coordinates, polygons = 0, 0, array("d"), list[list[str]]()
    for number, line in enumerate(content.decode("latin-1").replace("\\\n", " ").splitlines(), 1):
        key, *words = line.partition("#")[0].split() or [""]
        if key in _OTHER_SHAPES:
            raise InputError(f"expected a mesh of polygons, got {_OTHER_SHAPES[key]} in line {number}, {show(key)}")
        if key in ("V", "F"):  # trimesh leaves out such lines
            raise InputError(f"expected a small letter at the beginning of line {number}, got {show(key)}")
        if key == "v":
            # trimesh divides the numbers of all lines evenly
            if len(words) < 3 or len(words) != (form or len(words)):
                raise InputError(
                    "expected the same number of values, 3 or more, in every line that begins with v, got "
                    f"{len(words)} in line {number}" + (f" after {form} in the lines before" if form else "")
                )
            form = len(words)
            coordinates.extend(map(float, words[:3]))
        if key == "f":
            count += max(0, len(words) - 2)
            polygons += [words] * (len(words) > 3)
    corners = [[int(word.partition("/")[0]) - 1 for word in words] for words in polygons]
    return Facts(count, bent_polygons(np.array(coordinates).reshape(-1, 3), corners) if corners else 0)


def _ply(content: bytes) -> Facts:
    """Test a PLY file if it is in text form; always return an empty :class:`Facts`.

    InputError is raised for corners that are no whole numbers, which trimesh would round, and for surplus lines, which
    trimesh would ignore.
    """
    header, _, numbers = content.partition(b"end_header")
    if b"format ascii" not in header:
        return Facts()
    lines = sum(map(int, re.findall(rb"^element \w+ (\d+)", header, re.MULTILINE)))
    if len(numbers.strip().splitlines()) > lines:
        raise InputError(f"expected a PLY file with {lines} lines after its header, got more")
    faces = re.search(rb"element face (\d+)\s+property list \w+ \w+ \w+\s*$", header)
    if faces:
        rows = numbers.rstrip().splitlines()[-int(faces[1]) :]
        if not re.fullmatch(rb"[\d\s]*", b"\n".join(rows)):
            raise InputError("expected whole numbers as corners of polygons in a PLY file")
    return Facts()


def _glb(content: bytes) -> Facts:
    """Test a GLB file; return an empty :class:`Facts`.

    InputError is raised if trimesh would lose a part of the shape, such as morph targets, skins or required extensions.
    """
    document = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    nodes, meshes, scenes = (document.get(key, []) for key in ("nodes", "meshes", "scenes"))
    primitives = [primitive for mesh in meshes for primitive in mesh["primitives"]]
    used = [index for each in primitives for index in (each["attributes"]["POSITION"], each.get("indices", -1))]
    accessors = [document["accessors"][index] for index in used if index >= 0]
    parents = Counter(child for node in (*nodes, *scenes) for child in node.get("children", node.get("nodes", [])))
    required = [name for name in document.get("extensionsRequired", []) if not str(name).startswith(_HARMLESS)]
    faults = [f"the required extension {show(name)}" for name in required]
    faults += ["no default scene"] * ("scene" not in document and len(scenes) != 1)
    faults += ["a node in two places"] * (len(scenes) == 1 and any(count > 1 for count in parents.values()))
    faults += [fault for node in nodes for fault in _faults_of_node(node)]
    faults += ["morph targets"] * any(any(owner.get("weights") or ()) for owner in (*nodes, *meshes))
    faults += ["strips or fans of triangles"] * any(each.get("mode", 4) in (_STRIP, _FAN) for each in primitives)
    faults += ["sparse or normalized numbers"] * any("sparse" in a or a.get("normalized") for a in accessors)
    if faults:
        raise InputError(f"expected a GLB file of plain triangles, got {faults[0]}; save the shape as triangles alone")
    return Facts()


def _faults_of_node(node: Mapping[str, Any]) -> list[str]:
    faults = ["instances by an extension"] * ("EXT_mesh_gpu_instancing" in node.get("extensions", {}))
    faults += ["a camera at the node of a mesh"] * ("camera" in node and ("mesh" in node or "children" in node))
    return faults + ["a skin"] * ("skin" in node) + ["a rotation of zero"] * (not any(node.get("rotation", (1,))))


FACTS_OF: Mapping[str, Callable[[bytes], Facts]] = {".stl": _stl, ".obj": _obj, ".ply": _ply, ".glb": _glb}
"""Suffix of a file -> function that takes the content of such a file and returns its :class:`Facts`.

The function raises InputError for parts of the file that trimesh would lose.
"""
