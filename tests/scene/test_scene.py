"""Scenes are read exactly, and each shipped scene has the motion that its title names.

Oracles: SciPy's rotations (1e-15, as doubles), closed forms of textbooks, and bodies cut up and put together again.
"""

import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from math import pi, sqrt

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import symrot
from symrot.conventions import SEQUENCES
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.errors import InputError
from symrot.formula.exact_numbers import equal
from symrot.inertia.tensor import apply
from symrot.scene.attitude import read_attitude, to_body
from symrot.scene.scene import Scene, load_scene, shipped_scenes
from symrot.scene.tables import QUANTITIES

ROUNDING = 4e-16  # two roundings of a component of a unit quaternion or a dcm
SHIPPED = {
    "tumbling_prism", "tumbling_prism_largest", "tumbling_prism_smallest", "chen_cylinder", "t_handle",
    "heavy_top_loops", "heavy_top_cusps", "heavy_top_waves", "precessing_wheel", "axisymmetric_satellite",
    "axisymmetric_satellite_oblate", "gravity_gradient_satellite", "earth_wobble", "gyrostat", "damped_disk",
    "spin_up", "thruster_pulse", "thruster_train", "friction_wheel", "quadcopter_motor_failure",
}  # fmt: skip


def scene(body=None, torque=(), **tables):
    """Return a small scene, with the given tables in place of its own."""
    return Scene.from_dict({
        "schema": 1,
        "body": body or {"principal": [1, 2, 3]},
        "initial": {"omega": [0, 0, 1]},
        "torque": list(torque),
        "span": {"t": [0, 1]},
        **tables,
    })  # fmt: skip


def floats(values):
    return np.array(values, dtype=object).astype(float)


def scipy_quaternion(rotation):
    return np.roll(rotation.as_quat(), 1)


def assert_same_attitude(attitude, rotation):
    quaternion, reference = floats(attitude.quaternion), scipy_quaternion(rotation)
    assert abs(abs(quaternion @ reference) - 1) < ROUNDING
    assert np.abs(floats(attitude.dcm) - rotation.as_matrix()).max() < 2 * ROUNDING
    assert abs(sum(x * x for x in attitude.quaternion) - 1) < Fraction(1, 2**200)


# --- attitude ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_a_sequence_is_that_of_scipy(sequence):
    angles = ["7/10", "-6/5", "5/2"]
    attitude = read_attitude({"sequence": sequence, "angles": angles}, "")
    assert_same_attitude(attitude, Rotation.from_euler(sequence, [0.7, -1.2, 2.5]))


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_right_angles_turn_exactly(sequence):
    attitude = read_attitude({"sequence": sequence, "angles": [90, -90, 180], "degrees": True}, "")
    assert {entry for row in attitude.dcm for entry in row} <= {-1, 0, 1}
    assert_same_attitude(attitude, Rotation.from_euler(sequence, [90, -90, 180], degrees=True))


def test_axis_and_angle_are_those_of_scipy():
    axis = np.array([1, -2, 3])
    attitude = read_attitude({"axis": [1, -2, 3], "angle": "pi/5"}, "")
    assert_same_attitude(attitude, Rotation.from_rotvec(axis / np.linalg.norm(axis) * pi / 5))


@pytest.mark.parametrize("seed", range(8))
def test_a_dcm_of_doubles_becomes_a_rotation(seed):
    rotation = Rotation.random(random_state=seed) if seed else Rotation.from_rotvec([0, 0, pi])
    attitude = read_attitude({"dcm": rotation.as_matrix().tolist()}, "")
    assert_same_attitude(attitude, rotation)
    product = [[sum(a * b for a, b in zip(r, s, strict=True)) for s in attitude.dcm] for r in attitude.dcm]
    assert all(abs(product[i][j] - (i == j)) < Fraction(1, 2**200) for i in range(3) for j in range(3))


def test_a_quaternion_of_any_length_is_made_unit_and_keeps_its_sign():
    attitude = read_attitude({"quaternion": [-3, 0, 4, 0]}, "")
    assert attitude.quaternion == (Fraction(-3, 5), 0, Fraction(4, 5), 0)
    assert read_attitude({"quaternion": [1, 1, 0, 0]}, "").dcm == ((1, 0, 0), (0, 0, -1), (0, 1, 0))


def test_omega_space_is_the_same_vector_in_the_body():
    initial = {"omega_space": [1, 2, 3], "attitude": {"quaternion": [1, 2, -1, 3]}}
    found = scene(initial=initial).initial
    dcm = read_attitude(initial["attitude"], "").dcm
    assert apply(dcm, found.omega_b) == (1, 2, 3) and to_body(dcm, (1, 2, 3)) == found.omega_b


# --- numbers ----------------------------------------------------------------------------------------------------------


def test_numbers_of_a_file_are_decimals_and_those_of_a_dict_are_what_they_are(tmp_path):
    path = tmp_path / "decimals.toml"
    path.write_text('schema = 1\n[body]\nprincipal = [0.1, "0.1", "1/10"]\n[initial]\nomega = [1e-3, 0, 0]\n'
                    "[span]\nt = [0, 0.1]\n")  # fmt: skip
    found = load_scene(path)
    assert found.body.principal.moments == (Fraction(1, 10),) * 3
    assert found.initial.omega_b[0] == Fraction(1, 1000) and found.span.stop == Fraction(1, 10)
    moments = scene({"principal": [0.1, np.float64(0.1), Decimal("0.1")]}).body.inertia
    assert moments[0][0] == moments[1][1] == Fraction(0.1) != moments[2][2] == Fraction(1, 10)


def test_the_defaults():
    found = scene()
    assert found.initial.quaternion == (1, 0, 0, 0)
    assert found.output.quantities == ("omega", "quaternion") and found.output.sequence is None
    assert (found.span.samples, found.tolerance, found.torques) == (1001, Fraction(1, 10**12), ())
    assert (found.name, found.path, found.title) == ("scene", None, "scene")


# --- bodies -----------------------------------------------------------------------------------------------------------

BOX = {"shape": "box", "a": 4, "b": 1, "c": 2}


def test_a_box_cut_in_two_is_the_box():
    halves = [{**BOX, "a": 2, "density": 3, "at": [side, 0, 0]} for side in (-1, 1)]
    whole, cut = scene({**BOX, "density": 3}).body, scene({"part": halves}).body
    assert (whole.mass, whole.inertia, whole.center_of_mass) == (cut.mass, cut.inertia, cut.center_of_mass)


def test_a_bored_cylinder_is_a_hollow_one():
    bar = {"shape": "cylinder", "radius": 2, "length": 3, "density": 1}
    bored = scene({"part": [bar, {**bar, "radius": 1, "subtract": True}]}).body
    hollow = scene({"shape": "hollow_cylinder", "inner": 1, "outer": 2, "length": 3, "density": 1}).body
    assert equal(bored.mass, hollow.mass)
    assert all(equal(bored.inertia[i][i], hollow.inertia[i][i]) for i in range(3))
    assert bored.principal.kind == "symmetric"


def test_a_part_turned_by_a_right_angle_swaps_moments_exactly():
    turned = scene({"part": [{**BOX, "mass": 12, "rotate": {"axis": [0, 0, 1], "angle": "pi/2"}}]}).body
    assert turned.inertia == ((20, 0, 0), (0, 5, 0), (0, 0, 17))


def test_three_blades_make_a_symmetric_body():
    """With angles of 120 degrees, products vanish and moments agree only up to rounding, which is removed."""
    blades = [
        {**BOX, "mass": 1, "at": [f"3*cos({k}*2*pi/3)", f"3*sin({k}*2*pi/3)", 0],
         "rotate": {"axis": [0, 0, 1], "angle": 120 * k, "degrees": True}}
        for k in range(3)
    ]  # fmt: skip
    body = scene({"part": blades}).body
    assert all(body.inertia[i][j] == 0 for i in range(3) for j in range(3) if i != j)
    assert body.principal.kind == "symmetric" and body.principal.symmetry_axis == 2


def test_a_fixed_point_adds_the_parallel_axes():
    """A cylinder about its end has m (R^2/4 + L^2/3) across its axis and m R^2/2 along it."""
    end = {"about": "fixed_point", "fixed_point": [0, 0, "-3/2"]}
    body = scene({"shape": "cylinder", "radius": 1, "length": 3, "mass": 4, **end}).body
    assert body.center_of_mass == (0, 0, Fraction(3, 2)) and body.about == "fixed_point"
    assert body.inertia == ((13, 0, 0), (0, 13, 0), (0, 0, 2))


def test_a_tensor_keeps_its_axes_and_knows_its_principal_ones():
    body = scene({"inertia": {"xx": 2, "yy": 2, "zz": 3, "xy": -1}}).body
    assert body.inertia[0] == (2, -1, 0)
    assert sorted(body.principal.moments) == [1, 3, 3] and body.principal.kind == "symmetric"


# --- torques ----------------------------------------------------------------------------------------------------------

TOP = {"shape": "disk", "radius": 1, "mass": 2, "about": "fixed_point", "fixed_point": [0, 0, -3]}


def torque(entry, body=None):
    (found,) = scene(body, [entry]).torques
    assert found.kind == entry["kind"]
    return found.values


def test_gravity_takes_from_the_body_what_it_is_not_told():
    values = torque({"kind": "gravity", "gravity": 10, "direction": [0, 3, -4]}, TOP)
    assert values == {"weight": 20, "center_of_mass": (0, 0, 3), "direction": (0, Fraction(3, 5), Fraction(-4, 5))}
    typed = {"principal": [1, 1, 1], "about": "fixed_point"}
    values = torque({"kind": "gravity", "weight": 5, "center_of_mass": [0, 0, 1]}, typed)
    assert values == {"weight": 5, "center_of_mass": (0, 0, 1), "direction": (0, 0, -1)}


def test_damping_is_three_numbers_and_one():
    assert torque({"kind": "damping", "linear": 2}) == {"linear": (2, 2, 2), "quadratic": 0}
    assert torque({"kind": "damping", "quadratic": 3}) == {"linear": (0, 0, 0), "quadratic": 3}
    assert torque({"kind": "damping", "linear": [0, 1, 2]})["linear"] == (0, 1, 2)


def test_a_spring_rests_at_a_unit_quaternion():
    values = torque({"kind": "spring", "stiffness": 2, "attitude": {"quaternion": [0, 3, 4, 0]}})
    assert values == {"stiffness": 2, "attitude": (0, Fraction(3, 5), Fraction(4, 5), 0)}


def test_an_expression_keeps_its_text_and_takes_pi_as_a_parameter():
    formulas = ["-k*omega_1", "sin(2*pi*t)", 0.5]
    (made,) = scene(None, [{"kind": "expression", "torque": formulas, "parameters": {"k": "1/3"}}]).torques
    assert made.formulas == ("-k*omega_1", "sin(2*pi*t)", "1/2") and made.frame == "body"
    assert made.number("k") == Fraction(1, 3) and float(made.number("pi")) == pi


def test_a_number_of_a_torque_can_be_replaced():
    (made,) = scene(None, [{"kind": "damping", "linear": [1, 2, 3], "quadratic": 4}]).torques
    changed = made.with_constant("linear", 1, Fraction(7)).with_constant("quadratic", None, Fraction(9))
    assert changed.vector("linear") == (1, 7, 3) and changed.number("quadratic") == 9 == changed.constant(
        "quadratic", None
    )
    assert made.constant("linear", 1) == 2  # the first one is as it was


def test_torques_may_be_several():
    rotor, thruster = {"kind": "rotor", "angular_momentum": [0, 0, 4]}, {"kind": "constant_body", "torque": [1, 0, 0]}
    found = scene(None, [rotor, thruster])
    assert [torque.kind for torque in found.torques] == ["rotor", "constant_body"]


@pytest.mark.parametrize("kind", TORQUE_KINDS.values(), ids=lambda kind: kind.kind)
def test_the_table_of_torques_is_consistent(kind):
    assert kind.about in ("any", "fixed_point", "center_of_mass") and kind.meaning
    for field in kind.fields:
        assert field.meaning and field.unit
        assert not (field.required and field.default is not None)
        assert field.sign in ("any", "positive", "nonnegative", "nonzero")


# --- shipped scenes ---------------------------------------------------------------------------------------------------


def test_the_shipped_scenes_are_listed_with_title_and_source():
    listed = shipped_scenes()
    assert {name for name, _, _ in listed} == SHIPPED
    assert all(title and source for _, title, source in listed)
    assert len({title for _, title, _ in listed}) == len(listed)


@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_a_shipped_scene_is_one(name):
    found = load_scene(name)
    assert found.name == name and found.path.endswith(f"{name}.toml")
    assert set(found.output.quantities) <= set(QUANTITIES)
    assert abs(sum(x * x for x in found.initial.quaternion) - 1) < Fraction(1, 2**200)


def moments(name):
    return load_scene(name).body.principal.moments


def test_the_prisms_are_brown_s():
    """The script's p. 58 has I0 = (b^2 + c^2, a^2 + c^2, a^2 + b^2) for (a, b, c) = (4, 1, 2); p. 57 names the cases."""
    assert moments("tumbling_prism") == (5, 20, 17)
    assert max(moments("tumbling_prism_largest")) == moments("tumbling_prism_largest")[2]
    assert min(moments("tumbling_prism_smallest")) == moments("tumbling_prism_smallest")[2]
    for name in SHIPPED:
        if name.startswith("tumbling"):
            assert load_scene(name).initial.omega_b == (0, Fraction(1, 100), 1)
            assert sorted(moments(name)) == [5, 17, 20]


def test_the_cylinder_is_chen_s():
    found = load_scene("chen_cylinder")
    assert found.body.principal.moments == (Fraction("0.6375"), Fraction("0.6375"), Fraction("0.075"))
    assert found.initial[:2] == ((1, 0, 1), (1, 0, 0, 0))


def test_the_t_handle_spins_about_its_intermediate_axis():
    found = load_scene("t_handle")
    assert found.body.principal.kind == "asymmetric"
    first, second, spun = found.body.principal.moments
    assert first < spun < second
    first, second, spin = map(abs, found.initial.omega_b)
    assert 0 < max(first, second) < spin / 100


def precession_rates(name):
    """Return a symmetric top's precession rates at its two nutation bounds, first the upper one (small theta).

    Source: Goldstein, Poole & Safko, Classical Mechanics, 3rd ed., eq. (5.62): u'^2 = (1 - u^2)(alpha - beta u) - (b -
    a u)^2, u = cos(theta), phi' = (b - a u)/(1 - u^2).
    """
    found = load_scene(name)
    body, omega = found.body, floats(found.initial.omega_b)
    moment, spin_moment = float(body.inertia[0][0]), float(body.inertia[2][2])
    (gravity,) = found.torques
    lever = float(gravity.values["weight"]) * float(gravity.values["center_of_mass"][2])
    vertical = Rotation.from_quat(np.roll(floats(found.initial.quaternion), -1)).as_matrix()[2]
    momentum = floats(body.inertia) @ omega
    a, b, u = momentum[2] / moment, vertical @ momentum / moment, vertical[2]
    energy = moment * (omega[0] ** 2 + omega[1] ** 2) / 2 + lever * u
    alpha, beta = 2 * energy / moment, 2 * lever / moment
    cubic = np.polysub(np.polymul([-1, 0, 1], [-beta, alpha]), np.polymul([-a, b], [-a, b]))
    roots = sorted(root.real for root in np.roots(cubic) if abs(root.real) <= 1)
    assert len(roots) == 2 and spin_moment * omega[2] > 2 * sqrt(moment * lever)  # a fast top
    lower, upper = roots
    return (b - a * upper) / (1 - upper**2), (b - a * lower) / (1 - lower**2)


@pytest.mark.parametrize(("name", "sign"), [("loops", -1), ("cusps", 0), ("waves", 1)])
def test_the_axis_of_a_heavy_top_draws_what_its_title_says(name, sign):
    """At the upper bound of nutation the precession reverses, stops, or neither."""
    upper, lower = precession_rates(f"heavy_top_{name}")
    assert lower > 0
    assert abs(upper) < 1e-6 if sign == 0 else sign * upper > 0.5  # rad/s; a root of the cubic is good to 1e-9


def test_the_three_heavy_tops_are_one_top():
    bodies = [load_scene(f"heavy_top_{name}").body for name in ("loops", "cusps", "waves")]
    assert bodies[0] == bodies[1] == bodies[2]
    assert len({load_scene(f"heavy_top_{name}").torques[0].values["weight"] for name in ("loops", "cusps")}) == 1


def test_the_wheel_precesses_steadily():
    """Omega = M g d / (I_xx nu), p. 56 of brown; and the torque is Omega x L exactly."""
    found = load_scene("precessing_wheel")
    spin, rate = Fraction(20), Fraction("2.18")
    weight, arm = found.torques[0].values["weight"], found.torques[0].values["center_of_mass"][2]
    assert weight * arm == found.body.inertia[2][2] * spin * rate
    assert found.initial.omega_b == (-rate, 0, spin)


@pytest.mark.parametrize(("name", "direct"), [("", True), ("_oblate", False)])
def test_precession_is_direct_for_a_slender_satellite_and_retrograde_for_a_flat_one(name, direct):
    """Precession L/A and spin omega_3 (1 - C/A) have the same sense when C < A; L points along z of space."""
    found = load_scene(f"axisymmetric_satellite{name}")
    (a, _, c), omega = found.body.principal.moments, found.initial.omega_b
    assert found.body.principal.kind == "symmetric"
    assert (omega[2] * (1 - c / a) > 0) is direct
    momentum_b = tuple(m * w for m, w in zip((a, a, c), omega, strict=True))
    rotation = Rotation.from_quat(np.roll(floats(found.initial.quaternion), -1))
    assert np.abs(rotation.apply(floats(momentum_b)) - [0, 0, 60]).max() < 1e-13


def test_gravity_gradient_holds_the_satellite():
    """The long axis points along the radius, the largest moment across the orbit: A < B < C (Hughes, chapter 9)."""
    first, second, third = moments("gravity_gradient_satellite")
    assert first < second < third
    found = load_scene("gravity_gradient_satellite")
    orbit = 2 * pi / float(found.torques[0].values["mean_motion"])
    assert orbit == pytest.approx(5677, abs=1) and float(found.span.stop) == pytest.approx(5 * orbit, rel=1e-2)


def test_the_earth_wobbles_in_about_300_days():
    found = load_scene("earth_wobble")
    a, _, c = found.body.principal.moments
    days = 2 * pi / float((c - a) / a * found.initial.omega_b[2]) / 86400
    assert 300 < days < 306
    assert float(found.span.stop) / 86400 > 2 * days


def test_the_rotor_steadies_the_prism():
    """The rotation about the intermediate axis, C < B, is stable when h > (B - C) omega_3."""
    found = load_scene("gyrostat")
    first, second, third = found.body.principal.moments
    assert found.body.principal.moments == moments("tumbling_prism") and first < third < second
    assert found.torques[0].values["angular_momentum"][2] > (second - third) * found.initial.omega_b[2]


def test_the_disk_is_flat_and_damped():
    found = load_scene("damped_disk")
    assert found.body.principal.flat and found.torques[0].kind == "damping"


def test_a_parameter_that_no_formula_contains_is_a_warning():
    torque = {"kind": "expression", "torque": ["-k*omega_1", 0, 0], "parameters": {"k": 1, "j": 2}}
    made = scene(None, [torque])
    assert made.warnings == (
        "scene: torque[0].parameters.j: no formula of this torque contains this parameter, so it has no effect",
    )
    assert symrot.propagate(made, t=[0]).warnings == made.warnings


# --- the walls --------------------------------------------------------------------------------------------------------


def test_loading_a_scene_imports_neither_sympy_nor_numpy():
    program = "import sys\nfrom symrot.scene.scene import load_scene, shipped_scenes\nload_scene('t_handle')\n"
    program += "shipped_scenes()\nprint(sorted({'sympy', 'numpy', 'scipy', 'difflib'} & set(sys.modules)))"
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_a_name_is_a_shipped_scene_before_it_is_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gyrostat").write_text("not a scene")
    assert load_scene("gyrostat").name == "gyrostat"
    (tmp_path / "mine").write_text("not a scene")
    with pytest.raises(InputError, match=r"^mine: expected a TOML document"):
        load_scene("mine")
