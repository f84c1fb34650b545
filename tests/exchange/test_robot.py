"""Links of robot files: the same body in three formats, there and back, and a sentence for each fault."""

import json
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import symrot
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.exchange.inertial import Inertial
from symrot.exchange.robot_text import inertial_text

URDF = """<?xml version="1.0"?>
<!-- a robot -->
<robot name="r">
  <link name="base"/>
  <link name="arm">
    <inertial>
      <origin xyz="0.1 0 0.2" rpy="{rpy}"/>
      <mass value="2.5"/>
      <inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="-0.002" izz="0.04"/>
    </inertial>
  </link>
</robot>
"""
SDF = """<sdf version="1.9"><model name="m"><link name="arm"><inertial>
<pose {attributes}>0.1 0 0.2 {rotation}</pose><mass>2.5</mass>
<inertia><ixx>0.02</ixx><ixy>0.001</ixy><ixz>0</ixz><iyy>0.03</iyy><iyz>-0.002</iyz><izz>0.04</izz></inertia>
</inertial></link></model></sdf>"""
MJCF = """<mujoco><compiler {compiler}/><worldbody><body name="trunk"><body name="arm">
<inertial pos="0.1 0 0.2" mass="2.5" {inertia}/></body></body></worldbody></mujoco>"""
TENSOR = np.array([[0.02, 0.001, 0], [0.001, 0.03, -0.002], [0, -0.002, 0.04]])


def robot(tmp_path, text, suffix="xml"):
    path = tmp_path / f"robot.{suffix}"
    path.write_text(text)
    return path


def tensor(inertial):
    return np.array(inertial.inertia, dtype=float)


def expected(rotation):
    matrix = rotation.as_matrix()
    return matrix @ TENSOR @ matrix.T


@pytest.mark.parametrize("rpy", ["0 0 0", "0.3 -0.2 1.1", "0 1.5707963267948966 0.4", "3.0 -1.2 -2.9"])
def test_roll_pitch_yaw_are_rotations_about_fixed_axes(tmp_path, rpy):
    angles = [float(x) for x in rpy.split()]
    arm = symrot.link(robot(tmp_path, URDF.format(rpy=rpy)), "arm")
    assert tensor(arm) == pytest.approx(expected(Rotation.from_euler("xyz", angles)), abs=1e-16)
    assert arm.mass == Fraction(5, 2) and arm.center_of_mass == (Fraction(1, 10), 0, Fraction(1, 5))
    degrees = " ".join(repr(float(np.degrees(x))) for x in angles)
    for attributes, rotation in (("", rpy), ('degrees="true"', degrees)):
        same = symrot.link(robot(tmp_path, SDF.format(attributes=attributes, rotation=rotation)))
        assert tensor(same) == pytest.approx(tensor(arm), abs=1e-16)


def test_a_quaternion_of_sdf_has_its_scalar_last(tmp_path):
    rotation = Rotation.from_rotvec([0.3, 1.1, -0.7])
    text = SDF.format(
        attributes='rotation_format="quat_xyzw"', rotation=" ".join(map(repr, rotation.as_quat().tolist()))
    )
    assert tensor(symrot.link(robot(tmp_path, text))) == pytest.approx(expected(rotation), abs=1e-16)


ROTATION = Rotation.from_rotvec([0.3, 1.1, -0.7])


def words(values):
    return " ".join(repr(float(value)) for value in values)


@pytest.mark.parametrize("compiler,attribute,rotation", [
    ("", f'quat="{words(3 * ROTATION.as_quat()[[3, 0, 1, 2]])}"', ROTATION),
    ('angle="radian"', f'axisangle="0.6 2.2 -1.4 {float(ROTATION.magnitude())!r}"', ROTATION),
    ("", f'axisangle="0.6 2.2 -1.4 {float(np.degrees(ROTATION.magnitude()))!r}"', ROTATION),
    ("", 'euler="30 40 50"', Rotation.from_euler("XYZ", [30, 40, 50], degrees=True)),
    ('eulerseq="XYZ"', 'euler="30 40 50"', Rotation.from_euler("xyz", [30, 40, 50], degrees=True)),
    ('eulerseq="zyx" angle="radian"', 'euler="0.3 0.4 0.5"', Rotation.from_euler("ZYX", [0.3, 0.4, 0.5])),
    ("", f'xyaxes="{words(2 * ROTATION.as_matrix()[:, 0])} {words(ROTATION.as_matrix() @ [0.4, 3, 0])}"', ROTATION),
    ("", 'zaxis="0 3 0"', Rotation.from_rotvec([-np.pi / 2, 0, 0])),
    ("", 'zaxis="0 0 -2"', Rotation.from_rotvec([np.pi, 0, 0])),
])  # fmt: skip
def test_orientations_of_mjcf(tmp_path, compiler, attribute, rotation):
    text = MJCF.format(compiler=compiler, inertia=f'{attribute} diaginertia="0.02 0.03 0.04"')
    matrix = rotation.as_matrix()
    arm = symrot.link(robot(tmp_path, text), "arm")
    assert tensor(arm) == pytest.approx(matrix @ np.diag([0.02, 0.03, 0.04]) @ matrix.T, abs=1e-16)


def test_numbers_without_an_effect_in_mujoco_are_accepted(tmp_path):
    text = MJCF.format(compiler='boundmass="0.0" boundinertia="0e0" settotalmass="-2"', inertia='diaginertia="1 1 1"')
    assert symrot.link(robot(tmp_path, text), "arm").mass == Fraction(5, 2)


def test_fullinertia_lists_the_diagonal_first(tmp_path):
    text = MJCF.format(compiler="", inertia='fullinertia="0.02 0.03 0.04 0.001 0 -0.002"')
    assert symrot.link(robot(tmp_path, text), "arm").inertia == tuple(
        tuple(Fraction(repr(x)) for x in row) for row in TENSOR.tolist()
    )


TEXTS = {
    "URDF": URDF.format(rpy="0 0 0"),
    "SDF": SDF.format(attributes="", rotation="0 0 0"),
    "MJCF": MJCF.format(compiler="", inertia='diaginertia="1 1 1"'),
}


@pytest.mark.parametrize("form", TEXTS)
@pytest.mark.parametrize("vector", [(0, 0, 0), (0.3, 1.1, -0.7), (0, np.pi / 2, 0), (2, -2, 1)])
def test_a_link_that_is_written_reads_back(tmp_path, form, vector):
    path = robot(tmp_path, TEXTS[form])
    matrix = Rotation.from_rotvec(vector).as_matrix()
    rows = matrix @ np.diag([3, 4, 5]) @ matrix.T
    rows = (rows + rows.T) / 2
    body = Inertial(
        "x",
        Fraction(1, 3),
        (Fraction(1), Fraction(-2), Fraction(0)),
        tuple(tuple(map(Fraction, row)) for row in rows.tolist()),
    )
    new = symrot.write_link(path, "arm", body, tmp_path / "new.xml")
    again = symrot.link(new, "arm")
    assert tensor(again) == pytest.approx(rows, abs=1e-14)
    assert float(again.mass) == 1 / 3 and again.center_of_mass == (1, -2, 0)
    assert path.read_text() == TEXTS[form]
    start = path.read_text().index("<inertial")
    assert new.read_text()[:start] == path.read_text()[:start]


@pytest.mark.parametrize("angles", ["0 45 30", "30 30 0", "30 30 180", "30 45 0"])
def test_zeros_of_rotated_axes_are_written_as_zeros(tmp_path, angles):
    """Their rounding errors, such as 1e-120, are numbers that robot files must not have."""
    text = SDF.format(attributes='degrees="true"', rotation=angles).replace("0.001<", "0<").replace("-0.002<", "0<")
    path = robot(tmp_path, text)
    arm = symrot.link(path, "arm")
    for form in TEXTS:
        new = symrot.write_link(robot(tmp_path, TEXTS[form]), "arm", arm, tmp_path / "new.xml")
        assert tensor(symrot.link(new, "arm")) == pytest.approx(tensor(arm), abs=1e-17)


@pytest.mark.parametrize(
    "start",
    [
        '<link name="base"/>',
        '<link name="base"  />',
        '<link name="base"></link>',
        '<link name="base">\n  <visual/></link>',
    ],
)
def test_a_link_without_an_inertial_gets_one(tmp_path, start):
    path = robot(tmp_path, URDF.format(rpy="0 0 0").replace('<link name="base"/>', start))
    arm = symrot.link(path, "arm")
    symrot.write_link(path, "base", arm)
    assert tensor(symrot.link(path, "base")) == pytest.approx(tensor(arm), abs=1e-17)
    assert symrot.link(path, "arm") == arm


def test_a_flat_body_stays_a_body_when_its_moments_are_rounded(tmp_path):
    third = Fraction(1, 3)
    for a, b in ((third, third), (Fraction(1, 7), Fraction(2, 7)), (Fraction(1, 10), Fraction(1, 5))):
        disk = Inertial("disk", Fraction(1), (0, 0, 0), ((a, 0, 0), (0, b, 0), (0, 0, a + b)))
        path = robot(tmp_path, TEXTS["URDF"])
        symrot.write_link(path, "arm", disk)
        assert float(symrot.link(path, "arm").inertia[2][2]) == pytest.approx(float(a + b), rel=1e-15)


def test_an_unknown_format_is_refused():
    with pytest.raises(InputError, match="expected a format, one of URDF, MJCF, SDF, got 'FBX'"):
        inertial_text(Inertial("x", Fraction(1), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1))), "FBX")


# --- refusals ---------------------------------------------------------------------------------------------------------


def changed(*pairs):
    text = URDF.format(rpy="0 0 0")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


BOMB = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><robot name="&b;"/>'


@pytest.mark.parametrize("text,sentence", [
    ("", "expected an XML file"),
    ("\0\1\2", "expected an XML file"),
    (URDF.format(rpy="0 0 0")[:150], "expected an XML file"),
    (BOMB, "expected a file without a document type"),
    ('<!DOCTYPE r SYSTEM "file:///etc/passwd"><robot/>', "expected a file without a document type"),
    ("<a>" * 300, "expected elements nested at most 200 deep"),
    ("<html/>", "expected a robot file, <robot> (URDF), <sdf> (SDF), <mujoco> (MJCF), got an XML file with the root <html>"),
    ("<robot/>", "expected a robot with links (<link>), got none"),
    ('<mujoco><include file="x.xml"/></mujoco>', "files that it includes are not read"),
    (changed(('name="arm"', 'name="arms"')), "expected one of its links, base, arms, got 'arm' (did you mean 'arms'?)"),
    (changed(('name="base"', 'name="arm"')), "expected one link of the name 'arm', got 2"),
    (changed(('mass value="2.5"', 'mass value="0"')), "link 'arm': expected a positive mass in kg, got 0"),
    (changed(('mass value="2.5"', 'mass value="-1"')), "link 'arm': expected a positive mass in kg, got -1"),
    (changed(('mass value="2.5"', 'mass value="${m}"')), "mass.value: expected numbers, got '${m}'; expand the file with xacro first"),
    (changed(('mass value="2.5"', 'mass value="1_0"')), "mass.value: expected a number, got '1_0'"),
    (changed(('mass value="2.5"', 'mass value="nan"')), "mass.value: expected a number, got 'nan'"),
    (changed(('mass value="2.5"', 'mass value="1e999"')), "mass.value: expected a number of a magnitude between"),
    (changed(('<mass value="2.5"/>', "")), "inertial: expected one element <mass>, got none"),
    (changed(('ixx="0.02"', "")), "inertia.ixx: expected 1 number, got ''"),
    (changed(('xyz="0.1 0 0.2"', 'xyz="0.1 0"')), "origin.xyz: expected 3 numbers, got '0.1 0'"),
    (changed(('izz="0.04"', 'izz="0.06"')), "none of which exceeds the sum of the other two"),
    (changed(('ixx="0.02"', 'ixx="-0.02"')), "principal moments of inertia that are not negative"),
    (changed(('iyz="-0.002"', 'iyz="0.05"')), "link 'arm': expected principal moments"),
    (SDF.format(attributes='relative_to="x"', rotation="0 0 0"), "pose: expected a pose in the frame of the link"),
    (SDF.format(attributes='rotation_format="euler"', rotation="0 0 0"), "expected the rotation_format euler_rpy or quat_xyzw"),
    (SDF.format(attributes="", rotation="0 0 0").replace("<inertial>", '<inertial auto="true">'), "got auto"),
    (MJCF.format(compiler='inertiafromgeom="true"', inertia='diaginertia="1 1 1"'), "compiler: expected inertiafromgeom = 'false', got 'true'"),
    (MJCF.format(compiler='balanceinertia="true"', inertia='diaginertia="1 1 1"'), "which makes MuJoCo use other mass properties than those in <inertial>; write balanceinertia=\"false\""),
    (MJCF.format(compiler='fusestatic="true"', inertia='diaginertia="1 1 1"'), "compiler: expected fusestatic = 'false', got 'true'"),
    (MJCF.format(compiler='settotalmass="1e1"', inertia='diaginertia="1 1 1"'), "compiler: expected settotalmass = '-1', got '1e1'"),
    (MJCF.format(compiler='eulerseq="xyw"', inertia='diaginertia="1 1 1"'), "compiler.eulerseq: expected three axes"),
    (MJCF.format(compiler='coordinate="global"', inertia='diaginertia="1 1 1"'), "expected coordinate = 'local', got 'global'"),
    (MJCF.format(compiler="", inertia='diaginertia="1 1 1"').replace("<worldbody>", '<include file="x"/><worldbody>'), "whose settings may change inertials"),
    (MJCF.format(compiler="", inertia=""), "expected one of diaginertia and fullinertia, got neither"),
    (MJCF.format(compiler="", inertia='fullinertia="1 1 1 0 0 0" quat="1 0 0 0"'), "no orientation with fullinertia, got quat"),
    (MJCF.format(compiler="", inertia='diaginertia="1 1 1" quat="0 0 0 0"'), "expected a quaternion that is not zero"),
    (MJCF.format(compiler="", inertia='diaginertia="1 1 1" xyaxes="1 0 0 2 0 0"'), "expected a y axis that is not parallel to the x axis"),
    (MJCF.format(compiler="", inertia='diaginertia="1 1 0"'), "expected three positive principal moments"),
    (changed(('rpy="0 0 0"', 'quat_xyzw="0.7 0 0 0.7"')), "origin: expected attributes among xyz, rpy, got 'quat_xyzw'"),
    (changed(('<mass value="2.5"/>', '<mass value="2.5"/><pose>1 0 0 0 0 0</pose>')), "expected elements among origin, mass, inertia, got 'pose'"),
    (changed(('<mass value="2.5"/>', '<mass value="2.5"/><origin xyz="1 0 0"/>')), "inertial: expected one element <origin>, got 2"),
    (SDF.format(attributes="", rotation="0 0 0").replace("<inertial>", '<inertial mass="2">'), "inertial: expected attributes among auto, got 'mass'"),
    (changed(('mass value="2.5"', 'mass value="2.5" unit="g"')), "mass: expected attributes among value, got 'unit'"),
    (changed(('izz="0.04"', 'izz="0.04" frame="world"')), "inertia: expected attributes among ixx, ixy, ixz, iyy, iyz, izz, got 'frame'"),
    (SDF.format(attributes='order="zyx"', rotation="0 0 0"), "pose: expected attributes among relative_to, frame, rotation_format, degrees, got 'order'"),
    (SDF.format(attributes='degrees="yes"', rotation="0 0 0"), "pose.degrees: expected true or false, got 'yes'"),
    (MJCF.format(compiler='angle="Degree"', inertia='diaginertia="1 1 1"'), "compiler.angle: expected 'degree' or 'radian', got 'Degree'"),
    (MJCF.format(compiler="", inertia='diaginertia="1 1 1" rpy="1 0 0"'), "inertial: expected attributes among pos, mass"),
])  # fmt: skip
def test_a_fault_of_a_file_is_one_sentence(tmp_path, text, sentence):
    path = robot(tmp_path, text)
    with pytest.raises(InputError) as refusal:
        symrot.link(path, "arm")
    assert sentence in str(refusal.value)
    assert str(refusal.value).startswith(f"{path}: ") and "\n" not in str(refusal.value)


@pytest.mark.parametrize("word", ["true", "True", "1"])
def test_truth_values_of_sdf_have_any_case(tmp_path, word):
    texts = [
        SDF.format(attributes=f'degrees="{word}"', rotation="90 0 0"),
        SDF.format(attributes="", rotation="1.5707963267948966 0 0"),
    ]
    tensors = [symrot.link(robot(tmp_path, text), "arm").inertia for text in texts]
    assert np.abs(np.array(tensors[0], float) - np.array(tensors[1], float)).max() < 1e-15


def test_without_a_name_a_file_has_one_link(tmp_path):
    with pytest.raises(InputError, match="expected the name of one of its links, base, arm, got none"):
        symrot.link(robot(tmp_path, URDF.format(rpy="0 0 0")))
    with pytest.raises(InputError, match="link 'base': expected an element <inertial>, got none"):
        symrot.link(robot(tmp_path, URDF.format(rpy="0 0 0")), "base")


def test_links_of_plugins_are_no_links(tmp_path):
    text = URDF.format(rpy="0 0 0").replace(
        '<link name="base"/>', '<gazebo><plugin><link name="arm"/></plugin></gazebo>'
    )
    path = robot(tmp_path, text)
    assert symrot.link(path).name == "arm"
    ball = Inertial("x", Fraction(1), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    symrot.write_link(path, "arm", ball)
    assert symrot.link(path, "arm").inertia == ball.inertia
    empty = robot(tmp_path, '<robot><gazebo><link name="arm"/></gazebo><link name="arm"/></robot>')
    symrot.write_link(empty, "arm", ball)
    assert symrot.link(empty, "arm").inertia == ball.inertia and '<gazebo><link name="arm"/>' in empty.read_text()


def test_links_of_equal_names_in_several_models_have_the_names_of_the_models(tmp_path, capsys):
    """Nested models of SDF have names of their own for their links; such links could not be told apart."""
    model = SDF.format(attributes="", rotation="0 0 0").partition(">")[2].removesuffix("</sdf>")
    inner = "".join(model.replace('name="m"', f'name="{side}"') for side in ("left", "right"))
    path = robot(tmp_path, f'<sdf version="1.9"><model name="robot"><link name="base"/>{inner}</model></sdf>')
    names = ["base", "robot::left::arm", "robot::right::arm"]
    assert sorted(each.name for each in symrot.links(path)) == names
    assert symrot.link(path, names[2]).mass == Fraction(5, 2)
    with pytest.raises(
        InputError, match="expected one of its links, base, robot::left::arm, robot::right::arm, got 'arm'"
    ):
        symrot.link(path, "arm")
    ball = Inertial("x", Fraction(1), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    symrot.write_link(path, names[2], ball)
    assert main(["inertia", f"{path}:{names[2]}"]) == 0 and "mass               1 kg" in capsys.readouterr().out
    assert symrot.link(path, names[2]).mass == 1 and symrot.link(path, names[1]).mass == Fraction(5, 2)


def test_a_mesh_in_a_format_that_is_not_read_is_no_broken_robot(tmp_path, capsys):
    path = tmp_path / "part.off"
    path.write_text("OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", encoding="utf-8")
    assert main(["inertia", str(path)]) == 2
    assert "meshes are read in the formats STL, OBJ, PLY and GLB" in capsys.readouterr().err


@pytest.mark.parametrize("moments", [("0.02", "0.02", "0.03"), ("0.01", "0.02", "0.03"), ("0.02", "0.025", "0.03")])
def test_the_scene_of_a_rotated_link_has_short_numbers_and_the_same_symmetry(tmp_path, moments):
    """The numbers of the tensor were fractions with 95 digits above and below the line."""
    wheel = symrot.link(robot(tmp_path, ROTATED.format(**dict(zip(("xx", "yy", "zz"), moments, strict=True)))), "wheel")
    scene = symrot.Scene.build(body=wheel.table(), initial={"omega": [0, 1, 0]}, span={"t": [0, 1]})
    text = scene.to_toml()
    assert "/" not in text and max(map(len, text.replace(",", " ").split())) <= 80
    body = scene.body.principal
    assert (body.kind, body.flat) == (wheel.principal.kind, wheel.principal.flat)


def test_places_of_links_in_the_state_of_a_world_are_no_links(tmp_path):
    model = SDF.format(attributes="", rotation="0 0 0").partition("<model")[2].partition("</model>")[0]
    state = '<state><model name="m"><link name="arm"><pose>1 2 3 0 0 0</pose></link></model></state>'
    for parts in ((state, model), (model, state)):
        inner = "".join(part if part == state else f"<model{part}</model>" for part in parts)
        path = robot(tmp_path, f'<sdf version="1.9"><world name="w">{inner}</world></sdf>')
        assert [each.name for each in symrot.links(path)] == ["arm"]
        assert symrot.link(path).mass == Fraction(5, 2)
        ball = Inertial("x", Fraction(1), (0, 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
        symrot.write_link(path, "arm", ball)
        assert symrot.link(path, "arm").inertia == ball.inertia


def test_a_folder_and_a_missing_file_are_refused(tmp_path):
    for path, reason in ((tmp_path, "a folder"), (tmp_path / "none.urdf", "No such file")):
        with pytest.raises(InputError, match=reason):
            symrot.link(path, "arm")


def test_a_link_is_the_body_of_a_scene(tmp_path):
    arm = symrot.link(robot(tmp_path, URDF.format(rpy="0.3 -0.2 1.1")), "arm")
    scene = symrot.Scene.build(body=arm.table(), initial={"omega": [0, 1, 0]}, span={"t": [0, 1]})
    assert scene.body.mass == Fraction(5, 2)
    assert np.array(scene.body.inertia, dtype=float) == pytest.approx(tensor(arm), rel=1e-15)
    with pytest.raises(InputError, match=r"fixed_point: expected three numbers \[x, y, z\] in m, got 3"):
        arm.table(fixed_point=3)


ROTATED = """<robot name="r"><link name="wheel"><inertial><origin xyz="0.1 0 0.2" rpy="0.1 0.2 0.3"/><mass value="2"/>
<inertia ixx="{xx}" ixy="0" ixz="0" iyy="{yy}" iyz="0" izz="{zz}"/></inertial></link></robot>"""


@pytest.mark.parametrize(("xx", "yy", "zz"), [("0.02", "0.02", "0.03"), ("0.01", "0.02", "0.03")])
def test_a_printed_table_keeps_equal_moments_and_flat_bodies(tmp_path, capsys, xx, yy, zz):
    """The digits that are printed suffice to see that two moments are equal, and that the body is flat."""
    path = robot(tmp_path, ROTATED.format(xx=xx, yy=yy, zz=zz))
    assert main(["inertia", f"{path}:wheel", "--toml"]) == 0
    scene = scene_of(tmp_path, capsys.readouterr().out)
    expected = symrot.link(path, "wheel").principal
    assert (scene.body.principal.kind, scene.body.principal.flat) == (expected.kind, expected.flat)


def test_a_printed_table_about_a_fixed_point_is_that_of_python(tmp_path, capsys):
    path = robot(tmp_path, ROTATED.format(xx="0.02", yy="0.021", zz="0.03"))
    assert main(["inertia", f"{path}:wheel", "--toml", "--fixed-point=0,0,-1/10"]) == 0
    scene = scene_of(tmp_path, capsys.readouterr().out)
    table = symrot.link(path, "wheel").table(fixed_point=[0, 0, "-1/10"])
    assert scene.body.about == "fixed_point" and scene.body.center_of_mass == (Fraction(1, 10), 0, Fraction(3, 10))
    assert np.array(scene.body.inertia, dtype=float) == pytest.approx(
        np.array(table["inertia"], dtype=float), rel=1e-15
    )
    assert main(["inertia", f"{path}:wheel", "--fixed-point=0,0,0"]) == 2
    assert "--fixed-point: expected --toml as well" in capsys.readouterr().err
    assert main(["inertia", f"{path}:wheel", "--toml", "--fixed-point=0,0"]) == 2
    assert "fixed_point: expected three numbers" in capsys.readouterr().err


def scene_of(folder, body):
    """Return the scene whose table ``body`` is a text of TOML."""
    file = folder / "scene.toml"
    file.write_text(f"schema = 1\n{body}\n[initial]\nomega = [0, 0, 1]\n[span]\nt = [0, 1]\n", encoding="utf-8")
    return symrot.load_scene(file)


def test_the_command_lists_links_and_their_problems(tmp_path, capsys):
    path = robot(tmp_path, URDF.format(rpy="0 0 0"))
    assert main(["inertia", str(path)]) == 0
    assert "base  no inertial\narm   2.5 kg, principal moments" in capsys.readouterr().out
    assert main(["inertia", f"{path}:arm", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["center_of_mass"] == [0.1, 0, 0.2]
    path = robot(tmp_path, changed(('izz="0.04"', 'izz="0.06"')))
    assert main(["inertia", str(path)]) == 1
    assert "exceeds" in capsys.readouterr().out
    assert main(["inertia", f"{path}:arm"]) == 2
    assert "link 'arm'" in capsys.readouterr().err
    assert main(["inertia", f"{path}:arm", "--mass", "2"]) == 2
