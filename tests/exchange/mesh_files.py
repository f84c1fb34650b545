"""Texts and bytes of mesh files: polygons in each format, written without a library."""

import json
import struct

import numpy as np

CORNERS = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
SQUARES = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
TRIANGLES = [half for a, b, c, d in SQUARES for half in ((a, b, c), (a, c, d))]


def obj(vertices, faces, form="{}"):
    lines = ["v {!r} {!r} {!r}".format(*map(float, point)) for point in vertices]
    lines += ["f " + " ".join(form.format(corner + 1) for corner in face) for face in faces]
    return "\n".join(lines) + "\n"


def stl_text(vertices, triangles, name="part", normal="0 0 0"):
    lines = [f"solid {name}"]
    for triangle in triangles:
        corners = ["vertex {!r} {!r} {!r}".format(*map(float, vertices[corner])) for corner in triangle]
        lines += [f"facet normal {normal}", "outer loop", *corners, "endloop", "endfacet"]
    return "\n".join([*lines, f"endsolid {name}"]) + "\n"


def stl(vertices, triangles, header=b""):
    parts = [header.ljust(80, b"\0"), struct.pack("<I", len(triangles))]
    for triangle in triangles:
        parts.append(struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in vertices[corner]), 0))
    return b"".join(parts)


def ply(vertices, faces, form="ascii", kind="double", corners="vertex_indices"):
    header = (
        f"ply\nformat {form} 1.0\ncomment unit box\nelement vertex {len(vertices)}\nproperty {kind} x\n"
        f"property {kind} y\nproperty {kind} z\nelement face {len(faces)}\n"
        f"property list uchar int {corners}\nend_header\n"
    )
    if form == "ascii":
        rows = [" ".join(repr(float(x)) for x in point) for point in vertices]
        rows += [" ".join(map(str, (len(face), *face))) for face in faces]
        return (header + "\n".join(rows) + "\n").encode()
    order = ">" if "big" in form else "<"
    parts = [header.encode()]
    parts += [struct.pack(order + "3" + kind[0], *map(float, point)) for point in vertices]
    parts += [struct.pack(f"{order}B{len(face)}i", len(face), *face) for face in faces]
    return b"".join(parts)


class Glb:
    """A GLB file with one mesh at one node; ``document`` may be changed before ``content`` is asked for."""

    def __init__(self, points=CORNERS, corners=TRIANGLES, mode=4, kind="<f4"):
        self.blob = b""
        self.document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [], "accessors": [], "bufferViews": [],
        }  # fmt: skip
        self.add_mesh(self.add(points, kind, "VEC3"), corners, mode)

    def view(self, values, kind):
        """Add values to the buffer, and return the number of their view."""
        data = np.array(values, kind).tobytes()
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)})
        self.blob += data + bytes(-len(data) % 4)
        return len(self.document["bufferViews"]) - 1

    def add(self, values, kind, form):
        """Add an accessor, and return its number."""
        component = {"<f4": 5126, "<u2": 5123, "<u4": 5125, "<i2": 5122}[kind]
        entry = {"bufferView": self.view(values, kind), "componentType": component, "count": len(values), "type": form}
        self.document["accessors"].append(entry)
        return len(self.document["accessors"]) - 1

    def add_mesh(self, position, corners, mode=4):
        indices = self.add(np.ravel(corners), "<u2", "SCALAR")
        primitive = {"attributes": {"POSITION": position}, "indices": indices, "mode": mode}
        self.document["meshes"].append({"primitives": [primitive]})
        return primitive

    def content(self):
        self.document["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(self.document).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.blob), b"BIN\0")
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks) + len(self.blob)) + chunks + self.blob
