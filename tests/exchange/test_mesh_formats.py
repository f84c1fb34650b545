"""Formats of mesh files: a file is read whole, or it is refused; nothing is lost in silence."""

import math
import struct

import pytest

import symrot
from symrot.errors import InputError
from tests.exchange.mesh_files import CORNERS, SQUARES, TRIANGLES, Glb, obj, ply, stl, stl_text

pytest.importorskip("trimesh")

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


def volume_or_refusal(tmp_path, suffix, content):
    try:
        return volume(tmp_path, suffix, content)
    except InputError as error:
        assert str(error).startswith(str(tmp_path)) and "\n" not in str(error)
        return None


@pytest.mark.parametrize("old, new", [("\nf 4 3 2 1", "\nF 4 3 2 1"), ("\nv ", "\nV ")])
def test_lines_with_capital_letters_are_not_lost(tmp_path, old, new):
    """Trimesh leaves out lines that begin with F; such a face was missing, or its twin in a second body."""
    text = obj(*prism([(0, 0), (1, 0), (1, 1), (0, 1)]))
    assert old in text
    assert "expected a small letter at the beginning of line" in refusal(tmp_path, "obj", text.replace(old, new, 1))


@pytest.mark.parametrize("write", [
    lambda v, f: ("obj", obj(v, f)), lambda v, f: ("ply", ply(v, f)), lambda v, f: ("ply", ply(v, f, BINARY[0])),
])  # fmt: skip
def test_polygons_that_are_not_flat_are_counted(tmp_path, write):
    """The volume of a box with one corner moved depends on how its squares are divided into triangles."""
    corners, faces = prism([(0, 0), (1, 0), (1, 1), (0, 1)])
    for top, note in (
        (1.0, ""),
        (1 + 1e-7, ""),
        (1.2, "; 3 polygons of the file are not flat, so the shape depends on"),
    ):
        suffix, content = write([*corners[:-1], (1 - top, top, top)], faces)
        (tmp_path / f"part.{suffix}").write_bytes(content if isinstance(content, bytes) else content.encode())
        checks = symrot.mesh(tmp_path / f"part.{suffix}", density=1).checks
        assert note in checks and ("not flat" in checks) == bool(note)
    body = {"mesh": str(tmp_path / f"part.{suffix}"), "density": 1}
    (warning,) = symrot.Scene.from_dict(
        {"schema": 1, "body": body, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]}}, table_folders=tmp_path
    ).warnings
    assert "3 polygons of the file are not flat" in warning


REGULAR = [[(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n)) for k in range(n)] for n in (3, 5, 6, 8)]
ELBOW = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]


@pytest.mark.parametrize("write", [
    lambda v, f: ("obj", obj(v, f)),
    lambda v, f: ("obj", obj(v, f, "{}/1")),
    lambda v, f: ("obj", obj(v, f, "{}//1")),
    lambda v, f: ("ply", ply(v, f)),
])  # fmt: skip
@pytest.mark.parametrize("corners", [*REGULAR, ELBOW, ELBOW[3:] + ELBOW[:3]])
def test_polygons_enclose_the_area_of_their_corners(tmp_path, write, corners):
    area = sum(a * d - b * c for (a, b), (c, d) in zip(corners, corners[1:] + corners[:1], strict=True)) / 2
    assert volume(tmp_path, *write(*prism(corners))) == pytest.approx(area, rel=1e-15)


# --- STL --------------------------------------------------------------------------------------------------------------

TWO = stl_text(CORNERS, TRIANGLES) + stl_text(FAR, TRIANGLES, "part two")


@pytest.mark.parametrize("text", [
    TWO, TWO.upper(), TWO.replace("\n", "\r\n"), TWO.replace("\n", "\r"), "# a comment\n" + TWO, TWO.replace("vertex ", "vertex\t"),
    TWO.replace("normal 0 0 0", "normal -nan(ind) 1.#QNAN 0"), TWO.replace("1.0", "1.0000E+000"), TWO.replace("part two", "vertex of solid"),
    TWO.replace("part two", "endfacet"),
])  # fmt: skip
def test_all_solids_of_an_stl_file_as_text_are_read_or_it_is_refused(tmp_path, text):
    assert volume_or_refusal(tmp_path, "stl", text) in (2, None)


@pytest.mark.parametrize("text", [TWO, TWO.upper(), TWO.replace("\n", "\r\n"), TWO.replace("1.0", "1.0000E+000")])
def test_stl_files_as_programs_write_them_are_read(tmp_path, text):
    assert volume(tmp_path, "stl", text) == 2
    assert volume(tmp_path, "stl", stl(CORNERS, TRIANGLES, b"solid part")) == 1


@pytest.mark.parametrize("length", [5, 40, 700, -20])
def test_an_stl_file_that_ends_early_is_refused(tmp_path, length):
    """The first solid alone would be closed."""
    start = len(stl_text(CORNERS, TRIANGLES)) if length > 0 else len(TWO)
    assert "or one that ends early" in refusal(tmp_path, "stl", TWO[: start + length])
    assert "or one that ends early" in refusal(tmp_path, "stl", stl(CORNERS, TRIANGLES)[:-1])
    without = TWO.replace("endfacet\nfacet", "facet", 1)
    assert "expected the 23 triangles of the file, but trimesh reads" in refusal(tmp_path, "stl", without)


# --- OBJ --------------------------------------------------------------------------------------------------------------

BOX = obj(CORNERS, SQUARES)


@pytest.mark.parametrize("old,new", [
    ("v ", "v\t"), ("v ", "  v  "), ("v 1.0 0.0 0.0", "v 1.0 0.0 0.0 # a corner"), ("f 1 2 6 5", "f 1 2 6 5 # a side"),
    ("f 1 2 6 5", "f 1 2 \\\n6 5"), ("\n", "\r"), ("\n", "\r\n"), ("v 1.0 0.0 0.0", "v 1E+0 0.0 .0 1.0"), ("f 1 2 6 5", "f 1 -7 6 -4"),
    ("f 4 3 2 1", "f 4 3 2 1\nusemtl red\ng side\ns off"), ("v 0.0 0.0 0.0", "\ufeffv 0.0 0.0 0.0"), ("f 1 2 6 5", "f 1/3 2//4 6/1/1 5"),
    ("0.0\nf", "0.0\n\n# sides\nvn 0 0 1\nf"),
])  # fmt: skip
def test_an_obj_file_with_other_spaces_comments_and_materials_is_read_or_refused(tmp_path, old, new):
    assert BOX.replace(old, new) != BOX or old == "0.0\nf"
    assert volume_or_refusal(tmp_path, "obj", BOX.replace(old, new)) in (1, None)


@pytest.mark.parametrize("old,new,sentence", [
    ("v 1.0 0.0 0.0\nv 1.0 1.0 0.0", "v 1.0 0.0\nv 1.0 1.0 0.0 0.0", "in every line that begins with v, got 2 in line 2 after 3 in the lines before"),
    ("v 1.0 0.0 0.0\nv 1.0 1.0 0.0", "v 1.0 0.0 0.0 1.0\nv 1.0 1.0", "in every line that begins with v, got 4 in line 2 after 3 in the lines before"),
    ("v 1.0 0.0 0.0", "v 1,0 0,0 0,0", "expected a mesh in the format OBJ"),
    ("f 1 2 6 5", "f 1 2 6.0 5", "expected a mesh in the format OBJ"),
    ("f 1 2 6 5", "f 1 2 0 5", "expected positive vertex indices"),
    ("f 1 2 6 5", "surf 0 1 0 1 1 2 6 5", "expected a mesh of polygons, got a free-form surface in line 11"),
    ("f 1 2 6 5", "f 1 2 6 5\ncall other.obj", "expected a mesh of polygons, got a reference to another file in line 12"),
])  # fmt: skip
def test_a_line_of_an_obj_file_that_cannot_be_read_is_refused(tmp_path, old, new, sentence):
    assert old in BOX
    assert sentence in refusal(tmp_path, "obj", BOX.replace(old, new))


# --- PLY --------------------------------------------------------------------------------------------------------------

PLY = ply(CORNERS, SQUARES).decode()


@pytest.mark.parametrize("content,expected", [
    (ply(CORNERS, TRIANGLES, form), 1) for form in ("ascii", *BINARY)
] + [
    (ply(CORNERS, TRIANGLES[:2] + SQUARES[1:], form, "float"), 1) for form in ("ascii", *BINARY)
] + [
    (PLY.replace("\n", "\r\n").encode(), 1), (PLY.replace("end_header\n", "end_header\n\n").encode(), 1),
    (PLY.replace("\n0.0 0.0 0.0\n", "\n0.0\n0.0 0.0\n").encode(), 1),
    (PLY.replace("element vertex", "element camera 1\nproperty float scale\nelement vertex").replace("end_header\n", "end_header\n7\n")
        .encode(), 1),
])  # fmt: skip
def test_a_ply_file_is_read_whole_or_refused(tmp_path, content, expected):
    assert volume_or_refusal(tmp_path, "ply", content) in (expected, None)
    assert volume(tmp_path, "ply", PLY) == volume(tmp_path, "ply", ply(CORNERS, TRIANGLES, BINARY[0])) == 1


@pytest.mark.parametrize("content", [
    ply(CORNERS + FAR, TRIANGLES + [[k + 8 for k in t] for t in TRIANGLES])[:-170], ply(CORNERS, TRIANGLES, BINARY[0])[:-13],
    ply(CORNERS + FAR, SQUARES + [[k + 8 for k in face] for face in SQUARES]).replace(b"element face 12", b"element face 6"),
    ply(CORNERS, TRIANGLES, BINARY[0]) + b"\0", *(PLY.replace(old, new).encode() for old, new in [
        ("vertex_indices", "corners"), ("property double z", "property double w"), ("double z", "quad z"), ("format ascii 1.0\n", ""),
        ("4 3 2 1 0", "4 3 2 1 0.5"), ("4 3 2 1 0", "4 3 2 1 a"), ("4 3 2 1 0", "-4 3 2 1 0"), ("element face", "element tristrips"),
        ("ply", "plx"),
    ]),
])  # fmt: skip
def test_a_ply_file_that_cannot_be_read_is_refused(tmp_path, content):
    assert "expected" in refusal(tmp_path, "ply", content)


# --- GLB --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("node,expected", [
    ({"scale": [2, 3, -1]}, 6),
    ({"scale": [2, 2, 2], "rotation": [0, 0, 2**-0.5, 2**-0.5], "translation": [1, 2, 3]}, 8),
    ({"matrix": [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}, 2),
])  # fmt: skip
def test_a_node_of_a_glb_file_places_its_mesh(tmp_path, node, expected):
    file = Glb()
    file.document["nodes"][0] |= node
    assert volume(tmp_path, "glb", file.content()) == pytest.approx(expected, rel=1e-15)


def test_a_glb_file_with_points_lines_gaps_and_several_scenes_is_read_whole(tmp_path):
    file = Glb(points=[(*point, 7) for point in CORNERS])
    file.document["bufferViews"][0]["byteStride"] = 16
    file.document["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 1})
    file.document["scenes"].append({"nodes": [0]})
    assert volume(tmp_path, "glb", file.content()) == 1


def _sparse(document):
    document["accessors"][0]["sparse"] = {
        "count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}
    }  # fmt: skip


@pytest.mark.parametrize("change,sentence", [
    (lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]), "got the required extension 'KHR_draco_mesh_compression'"),
    (lambda d: d["nodes"][0].update(extensions={"EXT_mesh_gpu_instancing": {}}), "got instances by an extension"),
    (lambda d: d["nodes"][0].update(skin=0), "got a skin"),
    (lambda d: (d["nodes"].append({"mesh": 0, "camera": 0}), d["scenes"][0]["nodes"].append(1)), "got a camera at the node of a mesh"),
    (lambda d: d["meshes"][0].update(weights=[0, 1]), "got morph targets"),
    (lambda d: d["nodes"].append({"children": [0]}) or d["scenes"][0]["nodes"].append(1), "got a node in two places"),
    (lambda d: d["nodes"][0].update(rotation=[0, 0, 0, 0]), "got a rotation of zero"),
    (lambda d: (d.pop("scene"), d["scenes"].append({"nodes": [0]})), "got no default scene"),
    (lambda d: d["accessors"][0].update(normalized=True), "got sparse or normalized numbers"),
    (_sparse, "got sparse or normalized numbers"),
    (lambda d: d["meshes"][0]["primitives"][0].update(mode=5), "got strips or fans"),
    (lambda d: d["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 6}), "got strips or fans"),
    (lambda d: d["accessors"][0].pop("bufferView"), ""),
    (lambda d: d["accessors"][0].update(type="VEC2"), ""),
    (lambda d: d["accessors"][0].update(count=900), ""),
    (lambda d: d["bufferViews"][0].update(buffer=1), ""),
    (lambda d: d["nodes"][0].update(mesh=3), ""),
])  # fmt: skip
def test_a_glb_file_with_a_shape_that_is_not_read_is_refused(tmp_path, change, sentence):
    file = Glb()
    change(file.document)
    assert sentence in refusal(tmp_path, "glb", file.content())


def test_a_glb_file_that_ends_early_is_refused(tmp_path):
    content = Glb().content()
    assert "expected a mesh" in refusal(tmp_path, "glb", content[:-4])
    assert "expected a mesh" in refusal(tmp_path, "glb", content[:4] + struct.pack("<I", 1) + content[8:])
