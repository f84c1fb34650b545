"""Trajectories agree with closed forms and 50-digit references and obey the laws of motion; and what a propagator
refuses.
"""

import math
import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symrot.closed_form import registry
from symrot.closed_form.registry import exact_form
from symrot.errors import InputError
from symrot.kinematics import conversions
from symrot.planning.plan import Plan, make_plan
from symrot.propagation import method as choosing
from symrot.propagation.method import Choice
from symrot.propagation.motions.make import stepped_motion
from symrot.propagation.propagate import propagate, propagator
from symrot.scene.file import names_with_kernels
from symrot.scene.scene import Scene, load_scene
from tests.reference import taylor

pytestmark = pytest.mark.usefixtures("quick_compiler")

REFERENCE = tomllib.loads((Path(__file__).parents[1] / "reference" / "trajectories.toml").read_text())
TOLERANCES = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12]
PROMISE = 20  # the error stays below this many tolerances
SCENES = names_with_kernels()


def attitude_error(found, expected):
    """Return the largest error of an entry of dcm."""
    return np.abs(found - expected).max()


def rate_error(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


def symmetric_motion(scene, t):
    """Return omega and dcm of a free symmetric body (symmetry axis 3), from its two steady rotations.

    ``dcm_sb(t) = exp(t L/A) dcm_sb(0) exp(t k (1 - C/A) omega_3)``: a precession about L in space after a turn about
    the symmetry axis in the body (Landau & Lifshitz, Mechanics, 3rd ed., section 33).
    """
    a, c = float(scene.body.inertia[0][0]), float(scene.body.inertia[2][2])
    omega = np.array([float(x) for x in scene.initial.omega_b])
    q = np.array([float(x) for x in scene.initial.quaternion])
    momentum_s = conversions.quaternion_to_dcm(q) @ (np.array([a, a, c]) * omega)
    back = (1 - c / a) * omega[2] * t
    turn = conversions.rotation_vector_to_quaternion(np.outer(back, [0, 0, 1]))
    precession = conversions.rotation_vector_to_quaternion(np.outer(t, momentum_s / a))
    w1 = np.cos(back) * omega[0] + np.sin(back) * omega[1]
    w2 = -np.sin(back) * omega[0] + np.cos(back) * omega[1]
    rates = np.stack([w1, w2, np.full_like(t, omega[2])], axis=1)
    return rates, conversions.quaternion_to_dcm(conversions.multiply(conversions.multiply(precession, q), turn))


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("name", ["chen_cylinder", "axisymmetric_satellite", "axisymmetric_satellite_oblate"])
def test_free_symmetric_bodies_return_their_closed_form(name, tolerance):
    trajectory = propagate(name, method="dop853", tolerance=tolerance)
    omega, dcm = symmetric_motion(trajectory.scene, trajectory.t)
    assert rate_error(trajectory.omega, omega) <= PROMISE * tolerance
    assert attitude_error(trajectory.dcm, dcm) <= PROMISE * tolerance


def reference(name):
    rows = REFERENCE[name]
    t = np.array([float(Fraction(row["t"])) for row in rows])
    omega = np.array([[float(x) for x in row["omega"]] for row in rows])
    return t, omega, np.array([[float(x) for x in row["dcm"]] for row in rows]).reshape(-1, 3, 3)


@pytest.mark.parametrize("tolerance", TOLERANCES)
@pytest.mark.parametrize("name", ["tumbling_prism", "heavy_top_loops", "heavy_top_cusps", "heavy_top_waves"])
def test_error_stays_within_the_promise_of_the_tolerance(name, tolerance):
    """The trajectory agrees with 50 digits, and its invariants drift no more than the promise either."""
    t, omega, dcm = reference(name)
    trajectory = propagator(name, method="dop853", tolerance=tolerance)(t)
    assert rate_error(trajectory.omega, omega) <= PROMISE * tolerance
    assert attitude_error(trajectory.dcm, dcm) <= PROMISE * tolerance
    assert max(item.drift for item in trajectory.invariants) <= PROMISE * tolerance


def test_an_unstable_motion_is_as_good_as_its_conditioning():
    """The T-handle passes its intermediate axis five times; each pass multiplies rounding errors of 1e-16 by up to 1e3."""
    t, omega, dcm = reference("t_handle")
    trajectory = propagator("t_handle", method="dop853", tolerance=1e-8)(t)
    assert rate_error(trajectory.omega, omega) <= PROMISE * 1e-8
    assert attitude_error(trajectory.dcm, dcm) <= PROMISE * 1e-8


def test_the_reference_file_is_what_its_program_prints():
    scene = load_scene("tumbling_prism")
    moments = [scene.body.inertia[i][i] for i in range(3)]
    row = REFERENCE["tumbling_prism"][0]
    ((omega, dcm),) = taylor.trajectory(moments, scene.initial.omega_b, scene.initial.quaternion, [Fraction(row["t"])])
    assert [taylor.decimal(x) for x in omega] == row["omega"]
    assert [taylor.decimal(x) for line in dcm for x in line] == row["dcm"]


@pytest.mark.thinned(6)
@pytest.mark.parametrize("name", SCENES)
def test_every_simplification_leaves_the_motion_alone(name):
    """The structure after each rule of the plan, from general to special, gives the same motion."""
    plan = make_plan(load_scene(name))
    structures = [row.structure for row in plan.rows if row.structure.attitude]
    t = np.linspace(float(plan.scene.span.start), float(plan.scene.span.stop), 7)
    if name == "t_handle":
        t = t[:3]  # later, rounding alone separates the kernels
    distinct = [s for i, s in enumerate(structures) if s not in structures[:i]]
    motions = [propagator_of(plan, structure, 1e-12)(t) for structure in distinct]
    for motion in motions[:-1]:
        assert rate_error(motion.omega, motions[-1].omega) < 1e-9
        assert attitude_error(motion.dcm, motions[-1].dcm) < 1e-9


def propagator_of(plan, structure, tolerance):
    """Return a propagator for a plan that uses another of its structures."""
    made = propagator(plan.scene, method="dop853", tolerance=tolerance)
    made._motion = stepped_motion(Plan(plan.scene, structure, plan.rows), Choice("dop853", "for the test"), tolerance)
    return made


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", SCENES)
def test_invariants_of_every_shipped_scene_are_kept(name):
    trajectory = propagate(name)
    assert all(item.drift < 1e-9 for item in trajectory.invariants)
    assert trajectory.success and trajectory.status == 0


@pytest.mark.parametrize("method", ["scipy", "scipy:LSODA", "scipy:Radau"])
def test_the_fallback_finds_the_same_motion(method):
    ours = propagate("chen_cylinder", tolerance=1e-6)
    theirs = propagate("chen_cylinder", method=method, tolerance=1e-6)
    assert theirs.method == method
    assert attitude_error(ours.dcm, theirs.dcm) < 1e-4
    assert np.allclose(theirs.sol(theirs.t[::100])[:3].T, theirs.omega[::100], atol=1e-4)


def test_angles_cost_nothing_at_their_singularity():
    """The body passes gimbal lock of ZYX: asking for angles changes no step, and they give the dcm back."""
    content = {
        "schema": 1, "title": "through the pole", "body": {"principal": [1, 1.2, 2]},
        "initial": {"omega": [0, 0.4, 1], "attitude": {"sequence": "ZYX", "angles": [10, 90, 0], "degrees": True}},
        "span": {"t": [0, 20]},
    }  # fmt: skip
    outputs = ({"quantities": ["omega", "quaternion"]},
               {"quantities": ["omega", "quaternion", "euler"], "sequence": "ZYX"})  # fmt: skip
    plain, asked = (propagate(Scene.from_dict({**content, "output": output}), method="dop853") for output in outputs)
    assert asked.stats[:3] == plain.stats[:3]
    assert asked.gimbal_lock("ZYX")[0]
    for sequence in ("ZYX", "ZXZ", "xyx"):
        rebuilt = conversions.euler_to_dcm(asked.euler(sequence), sequence)
        assert attitude_error(rebuilt, asked.dcm) < 2e-15


def test_times_in_any_order_and_before_the_start():
    made = propagator("tumbling_prism", method="dop853")
    t = np.array([3.0, -2.0, 0.0, 20.0, 3.0, 1e-9])
    shuffled, ordered = made(t), made(np.sort(t))
    assert np.abs(shuffled.quaternion[np.argsort(t, kind="stable")] - ordered.quaternion).max() < 1e-12
    assert np.array_equal(shuffled.omega[2], [0.0, 0.01, 1.0])
    assert np.array_equal(shuffled.omega[0], shuffled.omega[4])
    assert len(made([])) == 0
    assert made(5.0).omega.shape == (1, 3)


def test_dense_output_agrees_with_samples():
    trajectory = propagate("heavy_top_loops", method="dop853")
    values = trajectory.sol(trajectory.t)
    assert np.abs(values[:3].T - trajectory.omega).max() < 1e-9 * 200
    assert np.abs(values[3:].T - trajectory.quaternion).max() < 1e-9
    with pytest.raises(InputError, match=r"expected times from .* where the motion is known, got"):
        trajectory.sol(1e6)


def test_another_initial_state_uses_a_kernel_that_fits_it():
    """A start about one axis has a plan with one angle; another start of the same propagator uses all states."""
    scene = Scene.from_dict({
        "schema": 1, "title": "spin", "body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 9]},
    })  # fmt: skip
    made = propagator(scene, method="dop853")
    assert made.plan.states == ("theta",)
    steady = made()
    assert np.array_equal(steady.omega, np.tile([0.0, 0.0, 1.0], (1001, 1)))
    assert attitude_error(steady.euler("ZXZ")[:, 1], 0) < 1e-12
    free = made(omega=[0.1, 1, 0.2], quaternion=[2, 0, 0, 0])
    assert free.states[:3] == ("omega_1", "omega_2", "omega_3")
    assert max(item.drift for item in free.invariants) < 1e-9


def test_a_motion_without_states_is_not_stepped():
    scene = Scene.from_dict({
        "schema": 1, "title": "ball", "body": {"principal": [1, 1, 1]}, "initial": {"omega": [1, 2, 3]}, "span": {"t": [0, 9]},
        "output": {"quantities": ["omega"]},
    })  # fmt: skip
    trajectory = propagate(scene)
    assert trajectory.method == "constant" and trajectory.stats.evaluations == 0
    assert np.array_equal(trajectory.omega, np.tile([1.0, 2.0, 3.0], (1001, 1)))
    with pytest.raises(InputError, match=r"attitude was not computed.*output\.quantities"):
        _ = trajectory.dcm


def test_a_body_at_rest_stays_where_it_is():
    scene = Scene.from_dict({
        "schema": 1, "title": "rest", "body": {"principal": [1, 2, 3]}, "span": {"t": [0, 9]},
        "initial": {"omega": [0, 0, 0], "attitude": {"axis": [1, 2, 2], "angle": "pi/3"}},
    })  # fmt: skip
    trajectory = propagate(scene)
    assert trajectory.method == "constant" and not trajectory.omega.any()
    third = 1 / 3 * np.array([1, 2, 2]) * math.sin(math.pi / 6)
    assert np.abs(trajectory.quaternion - [math.cos(math.pi / 6), *third]).max() < 2e-16


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"t": [0, math.nan]}, "finite times"),
        ({"t": [[0, 1]]}, "one-dimensional"),
        ({"t": "soon"}, "array of times"),
        ({"omega": [1, 2]}, "3 finite numbers"),
        ({"omega": [1, 2, math.inf]}, "3 finite numbers"),
        ({"quaternion": [0, 0, 0, 0]}, "not zero"),
        ({"quaternion": "north"}, "4 numbers"),
    ],
)
def test_a_call_that_cannot_be_answered_is_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        propagator("chen_cylinder")(**arguments)


@pytest.mark.parametrize("method", ["rk4", "scipy:Nope", "dop853:x", "", "constant", "scipy:"])
def test_unknown_methods_are_refused(method):
    with pytest.raises(InputError, match=r"expected one of|methods are"):
        propagate("chen_cylinder", method=method)


@pytest.mark.parametrize("tolerance", [0, -1, 1, math.nan, 1e-20, "small"])
def test_tolerances_out_of_range_are_refused(tolerance):
    with pytest.raises(InputError, match="tolerance"):
        propagator("chen_cylinder", tolerance=tolerance)


def test_a_cached_scene_propagates_without_sympy_or_scipy():
    assert propagate("tumbling_prism").invariants  # derived, and kept for the next process
    code = (
        "import sys; from symrot import load_scene; from symrot.propagation.propagate import propagate;"
        "t = propagate('tumbling_prism'); t.euler('ZYX'); t.invariants;"
        "print([m for m in ('sympy', 'scipy', 'matplotlib') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_second_scene_of_the_same_structure_compiles_nothing(monkeypatch):
    from symrot.build import cache as library

    for method in ("dop853", "taylor"):
        propagate("tumbling_prism", method=method)
    monkeypatch.setattr(library, "_compile", lambda *a, **k: pytest.fail("compiled again"))
    scene = load_scene("tumbling_prism_largest")
    assert propagate(scene, method="dop853").success and propagate(scene, method="taylor").success


@pytest.mark.parametrize(
    ("torque", "potential"),
    [
        ([], False),
        ([{"kind": "damping", "linear": 0.1}], True),
        ([{"kind": "constant_body", "torque": [0, 0.1, 0]}], True),
    ],
    ids=["alone", "damped", "pushed"],
)
def test_energy_holds_every_potential_there_is(torque, potential):
    """Energy is kinetic energy plus weight times height under any torque; it counts as conserved unless a torque
    changes it.
    """
    scene = Scene.from_dict({
        "schema": 1, "title": "top", "body": {"principal": [2, 3, 1], "about": "fixed_point"}, "span": {"t": [0, 5]},
        "initial": {"omega": [1, 0.2, 3]}, "output": {"quantities": ["omega", "quaternion", "energy"]},
        "torque": [{"kind": "gravity", "weight": 2, "center_of_mass": [0.1, 0.2, 0.5]}, *torque],
    })  # fmt: skip
    trajectory = propagate(scene)
    height = np.einsum("nij,j->ni", trajectory.dcm, [0.1, 0.2, 0.5])[:, 2]
    kinetic = trajectory.omega**2 @ [2, 3, 1] / 2
    assert np.abs(trajectory.energy - kinetic - 2 * height).max() < 1e-12
    kept = {item.name for item in trajectory.invariants}
    assert ("energy" in kept) != potential


@pytest.mark.parametrize("name", REFERENCE)
def test_exact_motions_are_right_to_the_last_digits(name):
    """This includes the T-handle, which no stepper follows to 1e-9."""
    t, omega, dcm = reference(name)
    trajectory = propagator(name, method="exact")(t)
    assert trajectory.method == "exact" and trajectory.stats.evaluations == 0
    assert rate_error(trajectory.omega, omega) < 1e-15
    assert attitude_error(trajectory.dcm, dcm) < 2e-15
    assert np.array_equal(trajectory.sol(t)[:3].T, trajectory.omega)


def torque(kind, **fields):
    """Return a scene of an asymmetric body under one torque."""
    return Scene.from_dict({
        "schema": 1, "title": kind, "body": {"principal": [1, 2, 2.5]}, "span": {"t": [0, 5]},
        "initial": {"omega": [0.2, 1, 0.3]}, "torque": [{"kind": kind, **fields}],
    })  # fmt: skip


def spun_up(quantities, damped=True):
    """Return a scene of a symmetric body, damped or not, that is driven about one axis and turns about others too."""
    drag = [{"kind": "damping", "linear": [0.1, 0.1, 0.2]}] if damped else []
    return Scene.from_dict({
        "schema": 1, "title": "spin-up", "body": {"principal": [1, 1, 2]}, "span": {"t": [0, 5]},
        "initial": {"omega": [0.2, 1, 0.3]}, "output": {"quantities": quantities},
        "torque": [{"kind": "constant_body", "torque": [0, 0, 0.5]}, *drag],
    })  # fmt: skip


def test_angular_velocity_alone_is_exact_where_the_attitude_is_not():
    """The damped body's attitude has no closed form here, but its angular velocity has one."""
    exact, stepped = propagate(spun_up(["omega", "energy"])), propagate(spun_up(["omega", "quaternion"]))
    assert np.abs(exact.omega - stepped.omega).max() < 1e-11
    assert np.abs(exact.energy - stepped.energy).max() < 1e-11
    with pytest.raises(InputError, match="attitude was not computed"):
        _ = exact.quaternion


CHOICES = {
    "a form": ("exact", lambda: load_scene("t_handle")),
    "a top": ("exact", lambda: load_scene("heavy_top_loops")),
    "a tide": ("taylor", lambda: load_scene("gravity_gradient_satellite")),
    "linear drag": ("taylor", lambda: torque("damping", linear=0.1)),
    "formulas": ("taylor", lambda: torque("expression", torque=["sin(t)/(2 + omega_1)", "sqrt(k)*q1", "exp(-t)"],
                                          parameters={"k": 2})),
    "spun up": ("exact", lambda: spun_up(["omega", "energy"])),
    "spun up, attitude asked for": ("taylor", lambda: spun_up(["omega", "quaternion"])),
    "spun up without damping, attitude asked for": ("exact", lambda: spun_up(["omega", "quaternion"], damped=False)),
    "drag at rest": ("dop853", lambda: torque("damping", quadratic=0.1)),
    "a size": ("taylor", lambda: torque("expression", torque=["0", "0", "-abs(omega_3)"])),
    "a root": ("dop853", lambda: torque("expression", torque=["0", "0", "sqrt(omega_1**2 + omega_2**2)"])),
}  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", CHOICES)
def test_auto_steps_no_motion_that_it_can_solve(name):
    """Closed form if there is one, otherwise Taylor series for smooth torques, otherwise Dormand and Prince's method."""
    method, scene = CHOICES[name]
    made = propagator(scene())
    assert made.method == method
    assert made([0.0, 0.5]).success


def test_an_exact_motion_derives_nothing_for_omega_and_attitude():
    """SymPy is imported only when a quantity must be derived."""
    code = (
        "import sys, os, tempfile; os.environ['SYMROT_CACHE'] = tempfile.mkdtemp();"
        "from symrot.propagation.propagate import propagate;"
        "t = propagate('tumbling_prism'); t.omega; t.euler('ZYX'); t.omega_space; t.sol(1.0);"
        "print('sympy' in sys.modules); t.energy; print('sympy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]


def test_the_plan_of_an_exact_motion_skips_the_stepping():
    plan = propagator("axisymmetric_satellite").plan
    assert [row.item for row in plan.rows if row.skipped] == [
        "products of inertia", "unequal moments", "torque terms", "stepping",
    ]  # fmt: skip
    row = plan.rows[-1]
    assert row.item == "stepping" and "closed form" in row.why and row.derivation


def test_every_motion_starts_at_its_initial_state_to_the_last_bit():
    for name in WITH_CLOSED_FORM:
        made = propagator(name)
        found = made([made.scene.span.start])
        assert np.array_equal(found.y[:, 0], made.plan.initial_state), name


WITH_CLOSED_FORM = [name for name in SCENES if exact_form(load_scene(name))]


def test_free_bodies_tops_and_axial_motions_have_closed_forms():
    assert set(SCENES) - set(WITH_CLOSED_FORM) == {"damped_disk", "gravity_gradient_satellite", "gyrostat"}


@pytest.mark.parametrize("name", sorted(set(WITH_CLOSED_FORM) - {"t_handle"}))
def test_exact_and_stepped_motions_agree(name):
    exact, stepped = propagate(name, method="exact"), propagate(name, method="dop853")
    assert rate_error(stepped.omega, exact.omega) < 1e-10
    assert attitude_error(stepped.dcm, exact.dcm) < 1e-10


AXIAL = {
    "driven": ([0, 0, 2], [{"kind": "constant_body", "torque": [0, 0, 1]}]),
    "driven from rest": ([0, 0, 0], [{"kind": "constant_body", "torque": [0, 1, 0]}]),
    "damped": ([0, 3, 0], [{"kind": "damping", "linear": 0.3}]),
    "driven and damped": (
        [0, 0, 2],
        [{"kind": "constant_body", "torque": [0, 0, 1]}, {"kind": "damping", "linear": 0.3}],
    ),
}


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", AXIAL)
def test_rotation_about_one_axis_has_a_closed_form(name):
    omega, torques = AXIAL[name]
    scene = Scene.from_dict({
        "schema": 1, "title": name, "body": {"principal": [1, 2, 3]}, "span": {"t": [0, 5]}, "torque": torques,
        "initial": {"omega": omega, "attitude": {"axis": [1, 2, 2], "angle": 1}},
    })  # fmt: skip
    exact, stepped = propagate(scene, method="exact"), propagate(scene, method="dop853")
    assert np.abs(stepped.omega - exact.omega).max() < 1e-11
    assert attitude_error(stepped.dcm, exact.dcm) < 1e-11


@pytest.mark.parametrize("name", ["damped_disk", "gravity_gradient_satellite", "gyrostat"])
def test_a_motion_without_closed_form_is_not_called_exact(name):
    with pytest.raises(InputError, match="expected a motion with a closed form"):
        propagate(name, method="exact")


@pytest.mark.thinned(6)
@pytest.mark.parametrize("name", SCENES)
def test_taylor_and_dormand_prince_agree(name):
    series, stepped = propagate(name, method="taylor", tolerance=1e-11), propagate(name, method="dop853")
    bound = 1e-7 if name == "t_handle" else 1e-9
    assert series.method == "taylor"
    assert rate_error(stepped.omega, series.omega) < bound
    assert attitude_error(stepped.dcm, series.dcm) < bound
    assert np.abs(series.sol(series.t[::50])[:3].T - series.omega[::50]).max() < bound * np.abs(series.omega).max()


def test_what_has_no_taylor_series_is_refused():
    scene = Scene.from_dict({
        "schema": 1, "title": "drag", "body": {"principal": [1, 2, 3]}, "span": {"t": [0, 5]},
        "initial": {"omega": [0, 0, 1]}, "torque": [{"kind": "damping", "quadratic": 1}],
    })  # fmt: skip
    with pytest.raises(InputError, match="abs"):
        propagate(scene, method="taylor")


def test_the_closed_form_of_a_motion_is_looked_up_once(monkeypatch):
    asked = []
    first = registry.FORMS[0]
    counted = first._replace(applies=lambda scene: asked.append(scene.name) or first.applies(scene))
    monkeypatch.setattr(registry, "FORMS", (counted, *registry.FORMS[1:]))
    exact = propagator("tumbling_prism")
    exact()
    assert (exact.method, asked) == ("exact", ["tumbling_prism"])


def test_the_smoothness_of_a_torque_is_looked_up_once(monkeypatch):
    asked, non_smooth_torque = [], choosing.non_smooth_torque
    monkeypatch.setattr(
        choosing, "non_smooth_torque", lambda plan: asked.append(plan.scene.name) or non_smooth_torque(plan)
    )
    body, torque = {"principal": [1, 2, 3]}, {"kind": "damping", "quadratic": "1/10"}
    content = {"schema": 1, "title": "drag", "body": body, "torque": [torque], "initial": {"omega": [1, 1, 1]}}
    rough = propagator(Scene.from_dict({**content, "span": {"t": [0, 1]}}, "drag"))
    assert (rough.method, asked) == ("dop853", ["drag"])
