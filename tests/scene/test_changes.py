"""Scenes with other values: every key finds its place, nothing else changes, and every entrance gives the same motion."""

import copy
import pickle
import tomllib
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

import hypothesis
import numpy as np
import pytest
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import symrot
from symrot.scene.content import toml_text
from symrot.scene.file import SHIPPED
from symrot.scene.settings import settings

pytestmark = pytest.mark.usefixtures("quick_compiler")

NAMES = [name for name, _, _ in symrot.shipped_scenes()]
TOP = symrot.load_scene("heavy_top_loops")
PRISM = symrot.load_scene("tumbling_prism")


@pytest.mark.parametrize("name", NAMES)
def test_the_toml_text_of_a_scene_reads_as_an_equal_scene(name):
    scene = symrot.load_scene(name)
    content = tomllib.loads(scene.to_toml(), parse_float=Decimal)
    again = symrot.Scene.from_dict(content, name, table_folders=SHIPPED)
    assert replace(again, name=name, path=scene.path) == scene


@hypothesis.settings(deadline=None)
@hypothesis.given(st.floats(1e-90, 1e90) | st.floats(-1e90, -1e-90) | st.just(0.0))
def test_toml_text_keeps_the_exact_value_of_a_float(x):
    assert Fraction(tomllib.loads(toml_text({"x": x}), parse_float=Decimal)["x"]) == Fraction(x)


def test_toml_text_quotes_what_toml_would_misread():
    content = {"title": 'a "b" \\ c\td', "torque": [{"parameters": {"é": 1, "k": Fraction(1, 3)}}], "on": True}
    assert tomllib.loads(toml_text(content))["torque"] == [{"parameters": {"é": 1, "k": "1/3"}}]
    assert tomllib.loads(toml_text(content))["title"] == content["title"]
    with pytest.raises(symrot.InputError, match="a value that TOML can hold, got nan"):
        toml_text({"x": float("nan")})


CHANGES = [
    # scene, key, value -> what is read from the changed scene, and its value
    (PRISM, "body.mass", 24, lambda s: s.body.inertia[0][0], 10),
    (PRISM, "mass", 24, lambda s: s.body.mass, 24),
    (PRISM, "density", 3, lambda s: s.body.mass, 24),
    (PRISM, "a", 8, lambda s: s.body.inertia[0][0], 5),
    (PRISM, "omega", [1, 2, 3], lambda s: s.initial.omega_b, (1, 2, 3)),
    (PRISM, "omega_2", "1/3", lambda s: s.initial.omega_b, (0, Fraction(1, 3), 1)),
    (PRISM, "t", (0, 3), lambda s: s.span.stop, 3),
    (PRISM, "samples", 3, lambda s: s.span.samples, 3),
    (PRISM, "tolerance", "1e-6", lambda s: s.tolerance, Fraction(1, 10**6)),
    (PRISM, "principal", [1, 2, 2], lambda s: s.body.inertia[2][2], 2),
    (PRISM, "I_yz", 1, lambda s: (s.body.inertia[1][2], s.body.inertia[0][0], s.body.mass), (1, 5, 12)),
    (TOP, "weight", 2, lambda s: s.torques[0].values["weight"], 2),
    (TOP, "torque[0].gravity", 2, lambda s: s.torques[0].values["weight"], 1),
    (TOP, "mass", 1, lambda s: s.torques[0].values["weight"], Fraction(981, 100)),
    (
        TOP,
        "center_of_mass_3",
        1,
        lambda s: (*s.torques[0].values["center_of_mass"], s.body.center_of_mass[2]),
        (0, 0, 1, 1),
    ),
    (symrot.load_scene("quadcopter_motor_failure"), "torque[0].frame", "body", lambda s: s.torques[0].frame, "body"),
]


@pytest.mark.parametrize("scene, key, value, read, expected", CHANGES, ids=[f"{c[0].name}-{c[1]}" for c in CHANGES])
def test_a_key_changes_its_value_and_the_scene_that_was_changed_stays_as_it_is(scene, key, value, read, expected):
    before = scene.to_dict()
    assert read(scene.with_({key: value})) == expected
    assert scene.to_dict() == before


def test_every_shipped_parameter_of_a_formula_can_be_changed_by_its_name():
    scene = symrot.load_scene("quadcopter_motor_failure")
    for name in set(scene.torques[0].values) - {"pi"}:
        assert scene.with_({name: "7/5"}).torques[0].values[name] == Fraction(7, 5)


def test_the_second_torque_has_a_prefix_as_in_plans():
    two = {"torque": [{"kind": "damping", "linear": 1}, {"kind": "damping", "linear": 2}]}
    scene = PRISM.with_(two)
    assert scene.with_(linear=3).torques[0].values["linear"] == (3, 3, 3)
    assert scene.with_(torque2_linear=3).torques[1].values["linear"] == (3, 3, 3)
    assert scene.with_(torque2_linear_2=3).torques[1].values["linear"] == (2, 3, 2)


def test_the_order_of_changes_does_not_matter():
    changes = {"mass": 1, "I_xx": "3/1000", "I_yy": "3/1000", "center_of_mass_1": "1/10", "center_of_mass_2": "1/20"}
    scene = TOP.with_(changes)
    assert scene == TOP.with_(dict(reversed(changes.items())))
    assert scene.body.center_of_mass == (Fraction(1, 10), Fraction(1, 20), Fraction(3, 50))
    assert scene.torques[0].values["weight"] == Fraction(981, 100)


SPACE = symrot.Scene.build(
    body={"inertia": {"xx": 1, "yy": 2, "zz": "5/2", "xy": "1/10"}},
    initial={"omega_space": ["3/10", "7/10", 1], "attitude": ["ZXZ", ["1/10", "1/5", "3/10"]]},
    span={"t": [0, 1]},
)


@pytest.mark.parametrize("scene, changes, read, expected", [
    (TOP, {"omega_2": 5, "omega": [1, 2, 3]}, lambda s: s.initial.omega_b, (1, 5, 3)),
    (TOP, {"initial.omega[1]": 5, "omega": [1, 2, 3]}, lambda s: s.initial.omega_b, (1, 5, 3)),
    (TOP, {"span.t[1]": 5, "t": [1, 9]}, lambda s: s.span[:2], (1, 5)),
    (TOP, {"I_xx": "11/5000", "center_of_mass": [0, 0, 1]}, lambda s: (s.body.inertia[0][0], s.body.center_of_mass[2]), (Fraction(11, 5000), 1)),
    (SPACE, {"omega_2": 5, "attitude": [0, 1, 0, 0]}, lambda s: s.initial.omega_b, (Fraction(3, 10), 5, -1)),
], ids=["omega", "path", "span", "inertia", "attitude"])  # fmt: skip
def test_no_change_replaces_the_value_of_another(scene, changes, read, expected):
    for each in (changes, dict(reversed(changes.items()))):
        assert read(scene.with_(each)) == expected


@pytest.mark.parametrize("changes", [
    {"weight": 50, "gravity": 5}, {"gravity": 5, "torque[0].gravity": 7}, {"mass": 3, "body.density": 100},
    {"mass": 3, "body.mass": 4}, {"omega_2": 5, "omega_space": [1, 0, 0]}, {"attitude": [1, 0, 0, 0], "initial.attitude": [0, 1, 0, 0]},
])  # fmt: skip
def test_changes_of_which_one_would_be_lost_are_refused(changes):
    for each in (changes, dict(reversed(changes.items()))):
        with pytest.raises(symrot.InputError, match=r"expected each value once|since each replaces the other"):
            TOP.with_(each)


def test_mass_and_density_of_one_shape_exclude_each_other():
    """The second change removed the first in silence."""
    scene = symrot.load_scene("t_handle")
    changes = {"body.part[0].mass": 1, "body.part[0].density": 2}
    for each in (changes, dict(reversed(changes.items()))):
        with pytest.raises(symrot.InputError, match="since each replaces the other"):
            scene.with_(each)
    scene.with_({"body.part[0].mass": 1, "body.part[1].density": 2})


def test_parameters_of_a_torque_may_be_called_weight_and_gravity():
    """A change of the parameter weight removed the parameter gravity."""
    torque = {"kind": "expression", "torque": ["weight - gravity", "0", "0"], "parameters": {"weight": 1, "gravity": 2}}
    scene = symrot.Scene.from_dict({**PRISM.to_dict(), "torque": [torque]})
    both = scene.with_({"torque[0].parameters.weight": 5, "torque[0].parameters.gravity": 3})
    assert both.to_dict()["torque"][0]["parameters"] == {"weight": 5, "gravity": 3}


ANGLES = [0.1, 0.2, 0.3]
ROTATION = Rotation.from_euler("ZXZ", ANGLES)


@pytest.mark.parametrize(
    "attitude", [ROTATION, ROTATION.as_matrix(), np.roll(ROTATION.as_quat(), 1), ("ZXZ", ANGLES)],
    ids=["rotation", "matrix", "quaternion", "sequence"],
)  # fmt: skip
def test_every_form_of_an_attitude_is_the_same_rotation(attitude):
    quaternion = np.array([float(x) for x in PRISM.with_(attitude=attitude).initial.quaternion])
    assert abs(quaternion @ np.roll(ROTATION.as_quat(), 1)) == pytest.approx(1, abs=4e-16)


def test_a_tensor_may_be_an_array_of_numpy():
    tensor = np.array([[2.0, 0.25, 0], [0.25, 3, 0], [0, 0, 4]])
    assert (
        PRISM.with_(body={"inertia": tensor}).body.inertia
        == PRISM.with_(body={"inertia": {"xx": 2, "yy": 3, "zz": 4, "xy": "1/4"}}).body.inertia
    )


def test_every_entrance_gives_the_same_motion_to_the_last_bit():
    t, omega, turn = [0.0, 0.25, 1.0], [0.0, 1.5, 150.0], Rotation.from_euler("ZXZ", [0.5, 1.0, 0.25])
    constants = {"weight": 3}
    motions = [
        symrot.propagate(TOP, t=t, omega=omega, attitude=turn, parameters=constants),
        symrot.propagate(TOP.to_dict(), t=t, omega=omega, attitude=turn, parameters=constants),
        symrot.propagator(TOP, omega=omega, attitude=turn, parameters=constants)(t),
        symrot.propagator(TOP)(t, omega=omega, attitude=turn, parameters=constants),
        symrot.propagator(TOP.with_(constants, omega=omega, attitude=turn))(t),
    ]
    ensemble = symrot.propagate_ensemble(TOP, t=t, omega=[omega], attitude=turn, parameters={"weight": [3.0]})
    for motion in motions:
        assert np.array_equal(motion.omega, ensemble.omega[0])
        assert np.array_equal(motion.quaternion, ensemble.quaternion[0])


def test_a_call_with_other_constants_leaves_the_propagator_as_it_is():
    propagator = symrot.propagator("damped_disk")
    before = propagator([0.5]).omega
    assert not np.array_equal(propagator([0.5], parameters={"linear": 0.3}).omega, before)
    assert np.array_equal(propagator([0.5]).omega, before)


@pytest.mark.parametrize(
    "options", [{"state": "ZXZ"}, {"torque": lambda t, omega, q: (0, 0, 0.1)}], ids=["zxz", "torque"]
)
def test_other_constants_reach_every_class_of_propagator(options):
    changed = symrot.propagator("t_handle", **options)([0.5], parameters={"omega_1": 2})
    assert np.array_equal(
        changed.omega, symrot.propagator("t_handle", parameters={"omega_1": 2}, **options)([0.5]).omega
    )


def test_an_ensemble_takes_one_number_where_the_scene_does():
    one = symrot.propagate_ensemble("damped_disk", parameters={"linear": [0.1, 0.2]}, t=[0.5])
    three = symrot.propagate_ensemble("damped_disk", parameters={"linear": [[0.1] * 3, [0.2] * 3]}, t=[0.5])
    assert np.array_equal(one.omega, three.omega)


def test_settings_are_read_as_in_a_scene_file():
    read = settings(["a=0.1", "b = 1/3", "c=[0, 'x']", "d={k = 2}", "e=true", "f=[1", "g=1\nh=2"])
    assert read == {"a": Decimal("0.1"), "b": "1/3", "c": [0, "x"], "d": {"k": 2}, "e": True, "f": "[1", "g": "1\nh=2"}


def test_copies_of_a_scene_can_be_changed():
    for scene in (copy.deepcopy(TOP), pickle.loads(pickle.dumps(TOP))):
        assert scene == TOP
        assert scene.with_(weight=2) == TOP.with_(weight=2)


REFUSALS = [
    ({"wieght": 2}, "did you mean 'weight'"),
    ({"torque[0].wight": 2}, "did you mean 'weight'"),
    ({"torque[3].weight": 2}, "an index below 1, the length of torque, got 3"),
    ({"body.mass.x": 2}, "a table at body.mass"),
    ({"body..mass": 2}, "a name such as body.mass"),
    ({"[0]": 2}, "a name such as body.mass"),
    ({3: 2}, "the name of a value of the scene"),
    ({"mass": -1}, "a positive mass in kg, got -1"),
    ({"mass": float("nan")}, "a positive mass in kg, got nan"),
    ({"omega": [1, 2]}, "three numbers"),
    ({"omega_2": [1, 2]}, "a number in rad/s"),
    ({"attitude": Rotation.identity(3)}, "a single rotation, got 3 rotations"),
    ({"attitude": np.ones((3, 3))}, "a rotation: orthonormal rows"),
    ({"attitude": "ZXZ"}, "an attitude"),
    ({"body": {"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}}, "a symmetric tensor"),
    ({"body": {"inertia": [[1, 0], [0, 1]]}}, "three rows of three numbers"),
    ({"I_xx": 100}, "none of which exceeds the sum of the other two"),
]


@pytest.mark.parametrize("changes, sentence", REFUSALS, ids=[str(next(iter(c))) for c, _ in REFUSALS])
def test_a_change_that_makes_no_scene_is_refused_in_one_sentence(changes, sentence):
    with pytest.raises(symrot.InputError, match=sentence.replace("[", r"\[")):
        TOP.with_(changes)


def test_a_name_of_two_values_is_refused_with_both_paths():
    formula = {"kind": "expression", "torque": ["0", "0", "a"], "parameters": {"a": 1}}
    with pytest.raises(symrot.InputError, match=r"write torque\[0\]\.parameters\.a or body\.a"):
        PRISM.with_(torque=[formula]).with_(a=2)


def test_endless_tables_are_refused():
    table = {}
    table["body"] = table
    with pytest.raises(symrot.InputError, match="at most 40 levels"):
        symrot.Scene.from_dict(table)


def test_a_scene_whose_body_was_replaced_has_no_content():
    other = replace(PRISM, body=TOP.body)
    for use in (other.to_dict, other.to_toml, lambda: other.with_(omega_1=1)):
        with pytest.raises(symrot.InputError, match=r"write scene\.with_"):
            use()


def test_the_content_follows_values_that_were_replaced():
    start = symrot.propagator(TOP)([0.0], omega=[0, 1, 2], attitude=ROTATION).scene
    other = replace(start, span=start.span._replace(stop=Fraction(1)), tolerance=Fraction(1, 10**6))
    assert symrot.Scene.from_dict(other.to_dict(), TOP.name) == replace(other, path=None)
    assert other.with_(weight=3).initial == start.initial


def test_attitude_and_quaternion_together_are_refused():
    for use in (symrot.propagate, symrot.propagator, lambda scene, **start: symrot.propagator(scene)([0.0], **start)):
        with pytest.raises(symrot.InputError, match="attitude or quaternion, got both"):
            use("t_handle", quaternion=[1, 0, 0, 0], attitude=[1, 0, 0, 0])


def test_constants_that_follow_from_the_body_have_names(tmp_path):
    """The weight of a body whose mass and gravity are given; a table of samples before it changes no numbers."""
    scene = symrot.load_scene("heavy_top_loops")
    assert scene.value("weight") == Fraction(981, 200)
    rows = "".join(f"{t},0,0,0\n" for t in range(6))
    (tmp_path / "samples.csv").write_text(f"t,M1,M2,M3\n{rows}")
    content = scene.to_dict() | {
        "torque": [{"kind": "table", "file": str(tmp_path / "samples.csv")}, {"kind": "gravity", "weight": 3}]
    }
    both = symrot.load_scene(content, table_folders=[tmp_path])
    assert both.with_({"center_of_mass_3": "0.07"}).torques[0].vector("center_of_mass")[2] == Fraction(7, 100)
