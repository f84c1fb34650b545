"""Mesh files: each format gives the same body, and each kind of broken or hostile file is refused in one sentence."""

import json
import struct
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.exchange.obj_file import read_plain_obj
from tests.exchange.polyhedra import box, rotated, sphere

trimesh = pytest.importorskip("trimesh")

SCENE = {"initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]}}


def write(path, surface):
    trimesh.Trimesh(surface.vertices, surface.triangles, process=False).export(path)
    return path


@pytest.fixture
def stl(tmp_path):
    return write(tmp_path / "box.stl", box((2, 3, 4)))


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb"])
def test_each_format_gives_the_same_body(tmp_path, suffix):
    part = symrot.mesh(write(tmp_path / f"box.{suffix}", box((2, 3, 4))), mass=12)
    assert part.inertia == ((25, 0, 0), (0, 20, 0), (0, 0, 13))
    assert part.center_of_mass == (1, Fraction(3, 2), 2)
    assert part.name == "box"


def test_placed_and_mirrored_bodies_of_a_glb_are_one_body(tmp_path):
    item = trimesh.Trimesh(box().vertices, box().triangles, process=False)
    scene = trimesh.Scene()
    scene.add_geometry(item, geom_name="cube", node_name="one")
    mirror = np.diag([-1.0, 1, 1, 1])
    mirror[0, 3] = 9
    scene.graph.update(frame_to="two", geometry="cube", matrix=mirror)
    scene.export(tmp_path / "two.glb")
    part = symrot.mesh(tmp_path / "two.glb", density=1)
    assert part.mass == 2 and part.center_of_mass == (Fraction(9, 2), Fraction(1, 2), Fraction(1, 2))


def test_trimesh_computes_the_same_numbers(tmp_path):
    surface = rotated(sphere(3))[0]
    path = write(tmp_path / "ball.ply", surface)
    part, other = symrot.mesh(path, density=3), trimesh.load(path)
    other.density = 3
    assert float(part.mass) == pytest.approx(other.mass, rel=1e-9)
    assert np.array(part.inertia, dtype=float) == pytest.approx(other.moment_inertia, rel=1e-9, abs=1e-9)


def binary_stl(count, triangles=b""):
    return bytes(80) + struct.pack("<I", count) + triangles


OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.mark.parametrize("name,content,sentence", [
    ("x.stl", b"", "expected a mesh"),
    ("x.stl", b"\x00\xff" * 300, "expected a mesh"),
    ("x.stl", binary_stl(0), "expected a mesh"),
    ("x.stl", binary_stl(4_000_000_000, bytes(50)), "expected a mesh"),
    ("x.stl", b"solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0", "expected a mesh"),
    ("x.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999\nproperty float x\nend_header\n", "expected a mesh"),
    ("x.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n", "no triangle"),
    ("x.glb", b"glTF" + bytes(100), "expected a mesh"),
    ("x.obj", b"\xff\xfe garbage", "expected a mesh"),
    ("x.obj", OBJ.replace("f 2 3 4", "f 2 3 9").encode(), "expected"),
    ("x.obj", OBJ.replace("v 1 0 0", "v nan 0 0").encode(), "expected finite coordinates"),
    ("x.obj", OBJ.replace("v 1 0 0", "v 1e40 0 0").encode(), "expected coordinates up to 1e+30, got 1e+40"),
    ("x.obj", OBJ.replace("f 2 3 4\n", "").encode(), "3 open edges"),
    ("x.txt", OBJ.encode(), "expected a mesh file (.stl, .obj, .ply, .glb), got 'x.txt'"),
])  # fmt: skip
def test_a_broken_file_is_refused(tmp_path, name, content, sentence):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError) as refusal:
        symrot.mesh(path, mass=1)
    assert sentence in str(refusal.value)
    assert str(refusal.value).startswith(f"{path}: ")
    assert "\n" not in str(refusal.value)


def test_files_that_an_obj_refers_to_are_not_opened(tmp_path):
    path = tmp_path / "x.obj"
    path.write_text("mtllib /dev/zero\nusemtl a\n" + OBJ)
    assert symrot.mesh(path, mass=1).volume == Fraction(1, 6)


@pytest.mark.parametrize("lines", [
    ("f 1 3 2", "f 1 2 4", "f 1 4 3", "f 2 3 4"),
    ("f 1/1 3/2 2/3", "f 1/9 2/1 4/1", "f 1/1 4/1 3/1", "f 2/1 3/1 4/1"),
    ("f 1//1 3//2 2//3", "f 1//9 2//1 4//1", "f 1//1 4//1 3//1", "f 2//1 3//1 4//1"),
    ("f 1/1/1 3/2/2 2/3/7", "f 1/9/1 2/1/1 4/1/1", "f 1/1/1 4/1/1 3/1/1", "f 2/1/1 3/1/1 4/1/1"),
    ("f -4 -2 -3", "f -4 -3 -1", "s 1", "f -4 -1 -2", "f -3 -2 -1"),
])  # fmt: skip
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_the_common_forms_of_obj_lines_are_read(lines, newline):
    text = newline.join(["# a comment", "mtllib x.mtl", "", "vn 0 0 1", *OBJ.splitlines()[:4], "vt 0 0", "g a", *lines])
    vertices, triangles = read_plain_obj(text.encode())
    assert vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert triangles.tolist() == [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


@pytest.mark.parametrize("old,new", [
    ("v 1 0 0", "v  1 0 0"), ("v 1 0 0", "v 1 0 0 1 1 1"), ("v 1 0 0", "v 1\t0 0"), ("v 1 0 0", "v 1 0"), ("v 1 0", "v 1,5"),
    ("f 1 3 2", "f 1 3 \\\n2"), ("f 1 3 2", "f 1/2 3/1 2/1"), ("f 1 3 2", "f 1 3 2 # face"), ("f 1 3 2", "f 1 3 2 4"),
    ("f 1 3 2", "f 1 3 2.5"), ("f 1 3 2", "f 1 3 f2"), ("f 1 3 2", "curv 1 2\nf 1 3 2"), ("f 1 3 2", "l 1 3\nf 1 3 2"),
    ("f 1 3 2\nf 1 2 4", "f 1 3 \nf 1 2 4"), (OBJ, ""), (OBJ[OBJ.index("f"):], ""), ("\n", "\r"),
])  # fmt: skip
def test_other_forms_of_obj_lines_are_left_to_trimesh(old, new):
    assert read_plain_obj(OBJ.encode()) is not None
    assert old in OBJ and read_plain_obj(OBJ.replace(old, new).encode()) is None


def test_negative_numbers_of_an_obj_file_count_from_their_own_line(tmp_path):
    """trimesh counts them from the end of the file: the first body would be the second once more."""
    second = OBJ.replace("v 0 0 1", "v 0 0 3").replace("v ", "v 5").splitlines()[:4]
    backwards = ["f -4 -2 -3", "f -4 -3 -1", "f -4 -1 -2", "f -3 -2 -1"]
    path = tmp_path / "two.obj"
    path.write_text("\n".join([*OBJ.splitlines()[:4], *backwards, *second, *backwards]))
    assert symrot.mesh(path, density=6).mass == 1 + 3
    path.write_text("\n".join([*OBJ.splitlines()[:4], *backwards, "f -4 -4 -4 -4", *second, *backwards]))
    with pytest.raises(InputError, match=r"expected positive vertex indices in an OBJ file whose lines do not"):
        symrot.mesh(path, density=6)


@pytest.mark.parametrize("options,sentence", [
    ({}, "expected exactly one of mass (kg) and density (kg/m^3) of a mesh, got neither"),
    ({"mass": 1, "density": 2}, "got both"),
    ({"mass": -1}, "mass: expected a positive mass in kg, got -1"),
    ({"mass": float("nan")}, "mass: expected a positive mass in kg"),
    ({"density": 0}, "density: expected a positive density in kg/m^3, got 0"),
    ({"density": "q"}, "density: expected"),
    ({"mass": 1, "scale": 0}, "scale: expected a positive length in m, that of one unit of the mesh, got 0"),
    ({"mass": 1, "scale": "1e-50"}, "scale: expected a length from 1e-30 to 1e30 m"),
    ({"mass": 1, "flip": True}, "turned inside out"),
])  # fmt: skip
def test_a_wrong_option_is_refused(stl, options, sentence):
    with pytest.raises(InputError) as refusal:
        symrot.mesh(stl, **options)
    assert sentence in str(refusal.value)


def test_a_mesh_that_is_inside_out_is_flipped_on_request(tmp_path):
    path = write(tmp_path / "x.stl", box((2, 3, 4)).flipped())
    assert symrot.mesh(path, mass=12, flip=True).inertia[0][0] == 25


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    for path, sentence in ((tmp_path / "none.stl", "No such file"), (tmp_path, "expected a mesh file")):
        with pytest.raises(InputError, match=sentence):
            symrot.mesh(path, mass=1)


# --- scenes -----------------------------------------------------------------------------------------------------------


def scene_file(folder, body):
    path = folder / "scene.toml"
    path.write_text(f"schema = 1\n[body]\n{body}\n[initial]\nomega = [0, 0, 1]\n[span]\nt = [0, 1]\n")
    return path


def test_a_scene_takes_a_mesh_from_its_folder(stl, tmp_path, monkeypatch):
    scene = symrot.load_scene(scene_file(tmp_path, 'mesh = "box.stl"\ndensity = 1\nscale = 0.1'))
    assert scene.body.mass == Fraction(24, 1000)
    assert scene.body.principal.moments[0] == Fraction(24 * 25, 12 * 10**5)
    assert len(scene.body.facets) == 12
    assert scene.with_({"body.density": 2}).body.mass == 2 * scene.body.mass
    assert scene.with_(mass=3).body.mass == 3
    monkeypatch.chdir(tmp_path)
    again = symrot.Scene.from_dict(scene.to_dict())
    assert again.body == scene.body


def test_a_fixed_point_shifts_the_tensor_and_the_picture(stl, tmp_path):
    from symrot.viewer.body_surface import patches

    text = 'mesh = "box.stl"\nmass = 12\nabout = "fixed_point"\nfixed_point = [1, "3/2", 0]'
    body = symrot.load_scene(scene_file(tmp_path, text)).body
    assert body.inertia == ((25 + 48, 0, 0), (0, 20 + 48, 0), (0, 0, 13))
    assert body.center_of_mass == (0, 0, 2)
    points = np.array([point for patch in patches(body) for point in patch.points])
    assert points.min(axis=0).tolist() == [-1, -1.5, 0] and points.max(axis=0).tolist() == [1, 1.5, 4]


def test_a_mesh_in_another_folder_needs_permission(stl, tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    path = scene_file(inner, 'mesh = "../box.stl"\nmass = 12')
    with pytest.raises(InputError, match=r"body\.mesh: expected a file in the folder of the scene or below it"):
        symrot.load_scene(path)
    assert symrot.load_scene(path, table_folders=tmp_path).body.mass == 12
    (inner / "link.stl").symlink_to(stl)
    with pytest.raises(InputError, match=r"body\.mesh: expected a file in the folder"):
        symrot.load_scene(scene_file(inner, 'mesh = "link.stl"\nmass = 12'))


@pytest.mark.parametrize("body,sentence", [
    ('mesh = "box.stl"', "body.mass: expected exactly one of mass (kg) and density (kg/m^3) of a mesh, got 'neither'"),
    ('mesh = "box.stl"\nmass = 1\nshape = "box"', "shape and mesh are given"),
    ('mesh = "box.stl"\nmass = 1\nscael = 2', "scael: expected one of the keys mesh, mass, density, scale"),
    ('mesh = "none.stl"\nmass = 1', "body.mesh: none.stl: expected a readable mesh file"),
    ('mesh = 3\nmass = 1', "body.mesh: expected a line of text"),
    ('mesh = "box.stl"\nmass = 1\nflip = true', "turned inside out"),
])  # fmt: skip
def test_a_wrong_body_is_refused(stl, tmp_path, body, sentence):
    with pytest.raises(InputError) as refusal:
        symrot.load_scene(scene_file(tmp_path, body))
    assert sentence in str(refusal.value)


def test_the_table_of_a_mesh_is_the_body_of_a_scene(tmp_path):
    part = symrot.mesh(write(tmp_path / "ball.ply", rotated(sphere(2))[0]), density=1)
    scene = symrot.Scene.build(body=part.table(), **SCENE)
    assert scene.body.inertia[0][1] == pytest.approx(part.inertia[0][1], rel=1e-60)
    hung = symrot.Scene.build(body=part.table(fixed_point=[0, 0, 2]), **SCENE).body
    assert float(hung.inertia[0][0]) == pytest.approx(float(part.properties.inertia_about((0, 0, 2))[0][0]), rel=1e-15)
    assert symrot.Scene.from_dict(scene.to_dict()).body == scene.body


def test_the_command_prints_text_json_and_a_table(stl, capsys):
    assert main(["inertia", str(stl), "--mass", "12"]) == 0
    assert "principal moments  25  20  13 kg m^2, asymmetric" in capsys.readouterr().out
    assert main(["inertia", str(stl), "--density", "1/2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["mass"] == 12
    assert main(["inertia", str(stl), "--mass", "12", "--toml"]) == 0
    assert "inertia = [[25, 0, 0]" in capsys.readouterr().out
    assert main(["inertia", str(stl)]) == 2
    assert "expected exactly one of mass" in capsys.readouterr().err


def test_pictures_show_a_small_mesh_and_the_box_of_a_large_one(tmp_path, monkeypatch):
    from symrot.scene import mesh_body
    from symrot.viewer.body_surface import how_drawn, patches
    from symrot.viewer.film import _polygons

    write(tmp_path / "ball.ply", sphere(2))
    path = scene_file(tmp_path, 'mesh = "ball.ply"\nmass = 12')
    body = symrot.load_scene(path).body
    (patch,) = patches(body)
    assert patch.is_mesh and patch.rows == len(_polygons(patch)) == 128
    assert how_drawn(body) == ""
    monkeypatch.setattr(mesh_body, "MOST_FACETS", 127)
    large = symrot.load_scene(path).body
    assert len(patches(large)) == 6 and large.inertia == body.inertia
    assert "box" in how_drawn(large)
