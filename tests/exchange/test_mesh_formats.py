"""Formats of mesh files: what a file may have beside triangles, and files that would lose a part in silence."""

import math
import struct

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from tests.exchange.mesh_files import CORNERS, SQUARES, TRIANGLES, Glb, obj, ply, stl, stl_text

FAR = [(x + 3, y, z) for x, y, z in CORNERS]  # a second unit box
BINARY = ("binary_little_endian", "binary_big_endian")


def volume(tmp_path, suffix, content):
    path = tmp_path / f"part.{suffix}"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return float(symrot.mesh(path, density=1).mass)


def refusal(tmp_path, suffix, content):
    with pytest.raises(InputError) as caught:
        volume(tmp_path, suffix, content)
    assert "\n" not in str(caught.value)
    return str(caught.value).partition("part.")[2]


def prism(corners, height=1.0):
    """Return a prism over a polygon: two polygons and a rectangle on each side."""
    n = len(corners)
    sides = [(k, (k + 1) % n, n + (k + 1) % n, n + k) for k in range(n)]
    return [(x, y, z) for z in (0.0, height) for x, y in corners], [range(n)[::-1], range(n, 2 * n), *sides]


REGULAR = [[(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)) for k in range(n)] for n in (3, 5, 6, 8)]
ELBOW = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]


@pytest.mark.parametrize("write", [
    lambda v, f: ("obj", obj(v, f)),
    lambda v, f: ("obj", obj(v, f, "{}/1")),
    lambda v, f: ("obj", obj(v, f, "{}//1")),
    lambda v, f: ("ply", ply(v, f)),
    *(lambda v, f, form=form: ("ply", ply(v, f, form)) for form in BINARY),
    lambda v, f: ("ply", ply(v, f[::-1], "binary_little_endian", corners="vertex_index")),
])  # fmt: skip
@pytest.mark.parametrize("corners", [*REGULAR, ELBOW, ELBOW[3:] + ELBOW[:3]])
def test_polygons_enclose_the_area_of_their_corners(tmp_path, write, corners):
    area = sum(a * d - b * c for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True)) / 2
    assert volume(tmp_path, *write(*prism(corners))) == pytest.approx(area, rel=1e-15)


# --- STL --------------------------------------------------------------------------------------------------------------

TWO = stl_text(CORNERS, TRIANGLES) + stl_text(FAR, TRIANGLES, "vertex of solid")


@pytest.mark.parametrize("text", [
    TWO, TWO.upper(), TWO.replace("\n", "\r\n"), TWO.replace("\n", "\r"), "# a comment\n" + TWO, TWO.replace("vertex ", "vertex\t"),
    TWO.replace("normal 0 0 0", "normal -nan(ind) 1.#QNAN 0"), TWO.replace("1.0", "1.0000E+000"),
])  # fmt: skip
def test_an_stl_file_as_text_has_all_its_solids(tmp_path, text):
    assert volume(tmp_path, "stl", text) == 2


def test_a_binary_stl_file_may_start_like_a_text(tmp_path):
    assert volume(tmp_path, "stl", stl(CORNERS, TRIANGLES, b"solid part")) == 1


@pytest.mark.parametrize("length", [5, 40, 700, -20])
def test_an_stl_file_that_ends_early_is_refused(tmp_path, length):
    """The first solid alone would be closed."""
    start = len(stl_text(CORNERS, TRIANGLES)) if length > 0 else len(TWO)
    assert "or one that ends early" in refusal(tmp_path, "stl", TWO[: start + length])
    assert "or one that ends early" in refusal(tmp_path, "stl", stl(CORNERS, TRIANGLES)[:-1])


# --- OBJ --------------------------------------------------------------------------------------------------------------

BOX = obj(CORNERS, SQUARES)


@pytest.mark.parametrize("old,new", [
    ("v ", "v\t"), ("v ", "  v  "), ("v 1.0 0.0 0.0", "v 1.0 0.0 0.0 # a corner"), ("f 1 2 6 5", "f 1 2 6 5 # a side"),
    ("f 1 2 6 5", "f 1 2 \\\n6 5"), ("\n", "\r"), ("\n", "\r\n"), ("v 1.0 0.0 0.0", "v 1E+0 0.0 .0 1.0"), ("f 1 2 6 5", "f 1 -7 6 -4"),
    ("f 4 3 2 1", "f 4 3 2 1\nusemtl red\ng side\ns off"), ("v 0.0 0.0 0.0", "\ufeffv 0.0 0.0 0.0"), ("f 1 2 6 5", "f 1/3 2//4 6/1/1 5"),
])  # fmt: skip
def test_lines_of_an_obj_file_may_have_any_spaces_comments_and_materials(tmp_path, old, new):
    assert old in BOX
    assert volume(tmp_path, "obj", BOX.replace(old, new)) == 1


@pytest.mark.parametrize("old,new,sentence", [
    ("v 1.0 0.0 0.0\nv 1.0 1.0 0.0", "v 1.0 0.0\nv 1.0 1.0 0.0 0.0", "expected three numbers of a vertex in line 2, got 'v 1.0 0.0'"),
    ("v 1.0 0.0 0.0", "v 1,0 0,0 0,0", "expected three numbers of a vertex in line 2, got 'v 1,0 0,0 0,0'"),
    ("f 1 2 6 5", "f 1 2 6.0 5", "expected the numbers of vertices of a polygon in line 11, got '6.0'"),
    ("f 1 2 6 5", "f 1 2 0 5", "line 11, got '0'"),
    ("f 1 2 6 5", "f 1 2 -9 5", "line 11, got '-9'"),
    ("f 1 2 6 5", "f 1 2 9 5", "expected corners from 0 to 7, got a triangle with corner 8"),
    ("f 1 2 6 5", "surf 0 1 0 1 1 2 6 5", "expected a mesh of polygons, got a free-form surface in line 11"),
    ("f 1 2 6 5", "f 1 2 6 5\ncall other.obj", "expected a mesh of polygons, got a reference to another file in line 12"),
])  # fmt: skip
def test_a_line_of_an_obj_file_that_cannot_be_read_is_refused(tmp_path, old, new, sentence):
    assert old in BOX
    assert sentence in refusal(tmp_path, "obj", BOX.replace(old, new))


# --- PLY --------------------------------------------------------------------------------------------------------------

PLY = ply(CORNERS, SQUARES).decode()


@pytest.mark.parametrize("old,new", [
    ("end_header\n", "end_header\n\n"), ("\n", "\r\n"), ("\n0.0 0.0 0.0\n", "\n0.0\n0.0 0.0\n"), ("property double", "property float"),
    ("element vertex", "element camera 1\nproperty list uchar float view\nproperty float scale\nelement vertex"),
])  # fmt: skip
def test_a_ply_file_as_text_is_a_sequence_of_numbers(tmp_path, old, new):
    text = PLY.replace(old, new)
    if "camera" in new:
        text = text.replace("end_header\n", "end_header\n2 1 2 7\n")
    assert volume(tmp_path, "ply", text) == 1


@pytest.mark.parametrize("form", BINARY)
def test_a_ply_file_with_faces_of_different_lengths(tmp_path, form):
    assert volume(tmp_path, "ply", ply(CORNERS, TRIANGLES[:2] + SQUARES[1:], form, "float")) == 1


@pytest.mark.parametrize("content,sentence", [
    (ply(CORNERS + FAR, TRIANGLES + [[k + 8 for k in t] for t in TRIANGLES])[:-170], "or one that ends early"),
    (ply(CORNERS, TRIANGLES, BINARY[0])[:-13], "or one that ends early"),
    (ply(CORNERS, TRIANGLES, BINARY[0]) + b"\0", "expected a PLY file that ends where its header says, got a longer one"),
    (PLY.replace("vertex_indices", "corners").encode(), "expected the property vertex_indices of the element face"),
    (PLY.replace("property double z", "property double w").encode(), "expected the properties x, y, z of the element vertex"),
    (PLY.replace("double z", "quad z").encode(), "expected lines of a PLY header, got 'property quad z'"),
    (PLY.replace("format ascii 1.0\n", "").encode(), "expected lines of a PLY header, got 'property double x'"),
    (PLY.replace("4 3 2 1 0", "4 3 2 1 0.5").encode(), "expected whole numbers as corners of polygons"),
    (PLY.replace("4 3 2 1 0", "4 3 2 1 a").encode(), "expected numbers after the header of a PLY file, got other text"),
    (PLY.replace("4 3 2 1 0", "-4 3 2 1 0").encode(), "or one that ends early"),
    (PLY.replace("element face", "element tristrips").encode(), "got strips of triangles (tristrips)"),
    (b"plx" + PLY[3:].encode(), "expected a header of a PLY file"),
])  # fmt: skip
def test_a_ply_file_that_cannot_be_read_is_refused(tmp_path, content, sentence):
    assert sentence in refusal(tmp_path, "ply", content)


# --- GLB --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("node,expected", [
    ({"scale": [2, 3, -1]}, 6),
    ({"scale": [2, 2, 2], "rotation": [0, 0, 2**-0.5, 2**-0.5], "translation": [1, 2, 3]}, 8),
    ({"matrix": [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}, 2),
    ({"camera": 0, "scale": [2, 2, 2]}, 8),
])  # fmt: skip
def test_a_node_of_a_glb_file_places_its_mesh(tmp_path, node, expected):
    file = Glb()
    file.document["nodes"][0] |= node
    assert volume(tmp_path, "glb", file.content()) == pytest.approx(expected, rel=1e-15)


def test_a_rotation_has_its_scalar_last(tmp_path):
    file = Glb()
    file.document["nodes"][0] |= {"rotation": [0, 0, 3, 3], "translation": [10, 0, 0], "scale": [2, 1, 1]}
    path = tmp_path / "part.glb"
    path.write_bytes(file.content())
    center = np.array(symrot.mesh(path, mass=1).center_of_mass, float)
    assert center == pytest.approx([10 - 0.5, 1, 0.5], rel=1e-15)  # x goes to y, and y to -x


def test_places_of_nodes_are_multiplied(tmp_path):
    file = Glb()
    file.document["nodes"] = [
        {"children": [1], "scale": [2, 2, 2]}, {"mesh": 0, "children": [2]}, {"mesh": 0, "translation": [3, 0, 0]}
    ]  # fmt: skip
    assert volume(tmp_path, "glb", file.content()) == 16
    file.document["nodes"] = [{"mesh": 0}, {"camera": 0, "translation": [3, 0, 0], "children": [2]}, {"mesh": 0}]
    file.document["scenes"] = [{"nodes": [0]}, {"nodes": [0, 1]}]
    assert volume(tmp_path, "glb", file.content()) == 1
    file.document["scene"] = 1
    assert volume(tmp_path, "glb", file.content()) == 2


def test_strips_and_fans_are_triangles(tmp_path):
    assert volume(tmp_path, "glb", Glb(corners=[3, 2, 0, 1, 5, 2, 6, 3, 7, 0, 4, 5, 7, 6], mode=5).content()) == 1
    file = Glb()
    fan = file.add_mesh(0, [0, 3, 2, 1, 5, 4, 7, 3], mode=6)
    other = file.add_mesh(0, [6, 5, 1, 2, 3, 7, 4, 5], mode=6)
    file.document["meshes"] = [file.document["meshes"][0], {"primitives": [fan, other, fan | {"mode": 1}]}]
    file.document["nodes"].append({"mesh": 1, "translation": [3, 0, 0]})
    file.document["scenes"] = [{"nodes": [0, 1]}]
    assert volume(tmp_path, "glb", file.content()) == 2


def test_sparse_values_replace_those_of_an_accessor(tmp_path):
    file = Glb()
    indices, values = file.view([4, 5, 6, 7], "<u2"), file.view([(x, y, 2) for x, y, _ in CORNERS[4:]], "<f4")
    file.document["accessors"][0]["sparse"] = {
        "count": 4, "indices": {"bufferView": indices, "componentType": 5123}, "values": {"bufferView": values}
    }  # fmt: skip
    assert volume(tmp_path, "glb", file.content()) == 2


def test_normalized_whole_numbers_are_fractions(tmp_path):
    file = Glb(points=[[32767 * x for x in point] for point in CORNERS], kind="<i2")
    file.document["accessors"][0]["normalized"] = True
    file.document["extensionsRequired"] = ["KHR_mesh_quantization"]
    assert volume(tmp_path, "glb", file.content()) == 1
    del file.document["accessors"][0]["normalized"]
    assert volume(tmp_path, "glb", file.content()) == 32767**3


def test_rows_of_a_buffer_may_have_gaps(tmp_path):
    file = Glb(points=[(*point, 7) for point in CORNERS])
    file.document["bufferViews"][0]["byteStride"] = 16
    assert volume(tmp_path, "glb", file.content()) == 1


@pytest.mark.parametrize("change,sentence", [
    (lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]), "without the extension 'KHR_draco_mesh_compression'"),
    (lambda d: d["nodes"][0].update(extensions={"EXT_mesh_gpu_instancing": {}}), "got instances by an extension"),
    (lambda d: d["nodes"][0].update(skin=0), "got a skin"),
    (lambda d: d["meshes"][0].update(weights=[0, 1]), "got morph targets"),
    (lambda d: d["nodes"][0].update(children=[0]), "expected each node of a GLB file once, got node 0 twice"),
    (lambda d: d["nodes"][0].update(rotation=[0, 0, 0, 0]), "expected a quaternion that is not zero"),
    (lambda d: (d.pop("scene"), d["scenes"].append({"nodes": [0]})), "got 2 scenes and no default"),
    (lambda d: d["accessors"][0].pop("bufferView"), "expected the values of an accessor in the GLB file, got none"),
    (lambda d: d["accessors"][0].update(type="VEC2"), "expected an accessor of the type VEC3, got 'VEC2'"),
    (lambda d: d["accessors"][0].update(count=10**12), "expected at most 60000000 values of an accessor"),
    (lambda d: d["accessors"][0].update(count=900), "or one that ends early"),
    (lambda d: d["bufferViews"][0].update(buffer=1), "got a reference to another file"),
    (lambda d: d["meshes"][0]["primitives"][0].update(mode=7), "expected a mode of a primitive from 0 to 6, got 7"),
    (lambda d: d["nodes"][0].update(mesh=3), "or one that ends early"),
])  # fmt: skip
def test_a_glb_file_with_a_shape_that_is_not_read_is_refused(tmp_path, change, sentence):
    file = Glb()
    change(file.document)
    assert sentence in refusal(tmp_path, "glb", file.content())


def test_a_glb_file_that_ends_early_is_refused(tmp_path):
    content = Glb().content()
    assert "expected a complete GLB file" in refusal(tmp_path, "glb", content[:-4])
    assert "expected a GLB file of version 2" in refusal(
        tmp_path, "glb", content[:4] + struct.pack("<I", 1) + content[8:]
    )
