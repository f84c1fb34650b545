"""A propagator called with another start gives the same bits as a new scene with that start, and prepares nothing
again.
"""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from symrot.build import cache as library
from symrot.closed_form import registry as choose
from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.ensemble.ensemble import propagate_ensemble
from symrot.formula import exact_numbers as number
from symrot.inertia import composite
from symrot.planning import rules
from symrot.planning.plan import make_plan, structure_key
from symrot.propagation import compiled_models as kernels
from symrot.propagation import propagate, propagator
from symrot.propagation.motions import make
from symrot.propagation.steppers import taylor
from symrot.scene.scene import Scene, load_scene
from symrot.scene.tables import Initial

pytestmark = pytest.mark.usefixtures("quick_compiler")
PRISM = load_scene("tumbling_prism")
TILTED = {"inertia": {"xx": 3, "yy": 4, "zz": 5, "xy": "-1/10", "xz": "1/5", "yz": "1/7"}}


def scene(torques=(), inertia=(2, 2, 1), span=(0, 3), attitude=(1, 0, 0, 0), omega=("1/3", "-1/7", 2), **more):
    body = inertia if isinstance(inertia, dict) else {"principal": list(inertia)}
    if any(torque["kind"] == "gravity" for torque in torques):
        body = {**body, "about": "fixed_point"}
    return Scene.from_dict(
        {
            "schema": 1, "body": body, "torque": list(torques),
            "initial": {"omega": list(omega), "attitude": {"quaternion": list(attitude)}},
            "span": {"t": list(span), "samples": 11}, **more,
        }
    )  # fmt: skip


GRAVITY = {"kind": "gravity", "weight": "13/10", "center_of_mass": [0, 0, "1/3"]}
BESIDE = {"kind": "gravity", "weight": "13/10", "center_of_mass": ["1/3", 0, 0], "direction": [1, 2, -2]}
SCENES = {
    "free": scene(inertia=(5, 20, 17)),
    "tilted": scene(inertia=TILTED),
    "top": scene([GRAVITY]),
    "turned top": scene([{**GRAVITY, "direction": [1, 2, 2], "center_of_mass": ["-1/5", 0, 0]}], inertia=(1, 2, 2)),
    "pendulum": scene([BESIDE], inertia=(1, 2, 3)),
    "gyrostat": scene([{"kind": "rotor", "angular_momentum": [0, 0, "3/7"]}]),
    "driven": scene([{"kind": "constant_body", "torque": [0, 0, "1/9"]}]),
    "braked": scene([{"kind": "damping", "linear": ["1/10", "1/10", "1/5"]}], output={"quantities": ["omega"]}),
    "pushed": scene([{"kind": "constant_space", "torque": ["1/3", 0, "1/5"]}], inertia=(1, 2, 3)),
    "timed": scene([{"kind": "expression", "torque": ["sin(3*t)/5", "0", "omega_1/9"]}], span=(100, 102)),
}
STARTS = {
    "general": ((0.3, -0.2, 1.7), (0.9, 0.1, -0.2, 0.3)),
    "across": ((0.3, 0.2, 0.0), None),
    "about 1": ((1.5, 0.0, 0.0), None),
    "about 2, turned": ((0.0, -1.5, 0.0), (1.0, 2.0, -2.0, 0.5)),
    "about 3, quarter": ((0.0, 0.0, 1.5), (1.0, 0.0, 0.0, 1.0)),
    "about 3, half": ((0.0, 0.0, -1.5), (0.0, 0.0, 0.0, -2.0)),
    "at rest": ((0.0, 0.0, 0.0), (0.3, 0.4, 0.5, 0.6)),
    "attitude": (None, (0.2, 0.3, -0.4, 0.1)),
}


def started(given, omega, quaternion):
    """Return the scene with another start."""
    first = given.initial.omega_b if omega is None else tuple(map(Fraction, omega))
    attitude = given.initial.quaternion
    if quaternion is not None:
        q = [Fraction(x) for x in quaternion]
        norm = number.sqrt(sum(x * x for x in q))
        attitude = tuple(x / norm for x in q)
    return replace(given, initial=Initial(first, attitude))


def same_bits(one, other):
    assert one.method == other.method
    assert one.states == other.states
    assert one.y.tobytes() == other.y.tobytes()
    assert one.plan.structure == other.plan.structure
    assert one.plan.rows == other.plan.rows
    assert one.plan.constants == pytest.approx(other.plan.constants, rel=1e-90)
    assert one.energy.tobytes() == other.energy.tobytes()


@pytest.mark.thinned(8)
@pytest.mark.parametrize("method", ["auto", "taylor", "dop853"])
@pytest.mark.parametrize("name", SCENES)
def test_another_start_gives_the_bits_of_another_scene(name, method):
    """Each start twice: its first call prepares its structure, its second call takes over the preparation."""
    given = SCENES[name]
    called = propagate.propagator(given, method)
    times = np.linspace(*map(float, given.span[:2]), 6)
    for omega, quaternion in [*STARTS.values()] * 2:
        alone = propagate.propagator(started(given, omega, quaternion), method)
        same_bits(called(times, omega=omega, quaternion=quaternion), alone(times))
    assert called(times).y.tobytes() == propagate.propagator(given, method)(times).y.tobytes()


@pytest.mark.parametrize("name", SCENES)
def test_starts_of_one_key_have_one_plan(name):
    """All patterns of zeros in omega, with attitudes that lay torques along an axis and attitudes that do not."""
    plans = {}
    for mask in range(8):
        omega = tuple(Fraction(k + 1, 3) * (mask >> k & 1) for k in range(3))
        for quaternion in [(1, 0, 0, 0), (0, 0, 1, 0), (3, 4, 0, 0), (1, 1, 0, 0), (1, 0, 1, 0), (1, 2, 3, 4)]:
            for sign in (1, -1):
                case = started(SCENES[name], [sign * x for x in omega], quaternion)
                plan = make_plan(case)
                first = plans.setdefault(structure_key(SCENES[name], case.initial), plan)
                assert (first.structure, first.rows, first.states) == (plan.structure, plan.rows, plan.states)
    assert len(plans) >= 8


LOOKED_UP = [
    (composite, "principal_axes"), (heavy_top, "quaternion_of"), (library, "build"), (library, "built"),
    (library, "compiler"), (library, "missing"), (library, "fetch"), (taylor, "order_for"),
    (make, "scene_kernel"), (choose, "exact_form"), (propagator, "make_plan"), (propagator, "choose_method"),
    (kernels, "scene_kernel"),
]  # fmt: skip


@pytest.mark.thinned(4)
@pytest.mark.parametrize("method", ["auto", "taylor", "dop853"])
@pytest.mark.parametrize("name", SCENES)
def test_a_second_start_of_a_structure_looks_nothing_up(name, method, monkeypatch):
    """No principal axes, libraries, compilers, orders, closed forms or plans are looked up: calls are counted."""
    given = SCENES[name]
    called = propagate.propagator(given, method)
    times = np.linspace(*map(float, given.span[:2]), 6)
    for omega, quaternion in STARTS.values():
        called(times, omega=omega, quaternion=quaternion)
    calls = []
    for room, function in LOOKED_UP:
        monkeypatch.setattr(room, function, lambda *a, name=function, **k: calls.append(name))
    for omega, quaternion in STARTS.values():
        omega = omega and tuple(1.25 * x for x in omega)
        called(times, omega=omega, quaternion=quaternion)
    assert calls == []


def test_doubles_settle_which_torques_lie_along_an_axis(monkeypatch):
    """Exact numbers, which take a fifth of a millisecond, are used only where a component may be zero."""
    vector, clear, level = (Fraction(1), Fraction(2), Fraction(-2)), (0.21, 0.33, -0.47, 0.13), (1.0, 0.0, 0.0, 0.0)
    chance = np.random.default_rng(5)
    exact = rules._in_body
    for row in [*chance.standard_normal((200, 4)), *chance.integers(-2, 3, (400, 4)), clear, level]:
        if np.any(row):
            start = Initial((0, 0, 1), number.unit([Fraction(float(x)) for x in row]))
            found = rules.zero_components(vector, start)
            turned = exact(vector, start)
            assert found == tuple(abs(x) <= max(map(abs, turned)) / 2**200 for x in turned)
    monkeypatch.setattr(rules, "_in_body", None)
    given = started(SCENES["turned top"], (0.0, 0.0, 1.0), clear)
    structure_key(given, given.initial)
    with pytest.raises(TypeError):
        rules.zero_components((Fraction(0), Fraction(0), Fraction(1)), started(given, None, level).initial)


def test_quantities_of_a_changed_start_use_one_kernel(monkeypatch):
    """The kernel of energy and momentum is fetched once for a structure, not once for each trajectory."""
    called = propagate.propagator(PRISM)
    assert called(omega=(0.1, 0.2, 0.3)).invariants
    monkeypatch.setattr(make, "scene_kernel", None)
    drift = [max(i.drift for i in called(omega=(0.1, 0.2, 0.3 + k)).invariants) for k in range(3)]
    assert max(drift) < 1e-14


def test_a_driven_motion_from_another_start_looks_nothing_up(monkeypatch):
    """With a torque in Python, the library stays the same and the bits are those of a new scene."""

    def torque(t, omega, quaternion):
        return -0.1 * omega

    omega, times = (0.4, 0.0, 1.25), np.linspace(0, 2, 5)
    called = propagate.propagator(SCENES["top"], torque=torque)
    called(times, omega=(1.0, 0.0, 2.0))
    alone = propagate.propagator(started(SCENES["top"], omega, None), torque=torque)(times)
    monkeypatch.setattr(library, "build", None)
    monkeypatch.setattr(library, "fetch", None)
    assert called(times, omega=omega).y.tobytes() == alone.y.tobytes()


def test_the_unit_vector_is_exact_or_good_to_320_bits():
    """A rational norm gives fractions; otherwise the root is computed to 2^-320."""
    assert number.unit([Fraction(3, 7), Fraction(0), Fraction(-4, 7)]) == (Fraction(3, 5), 0, Fraction(-4, 5))
    for vector in ([Fraction(1, 3), Fraction(-2, 5), Fraction(1)], [Fraction(2) ** -900, Fraction(2) ** -880]):
        found = number.unit(vector)
        assert abs(sum(x * x for x in found) - 1) < Fraction(1, 2**318)
        assert all(x * vector[0] == y * found[0] for x, y in zip(found, vector, strict=True))


def test_another_attitude_keeps_an_angular_velocity_given_in_space():
    own = Scene.build(
        body={"principal": [1, 2, "5/2"]},
        initial={"omega_space": ["3/10", "7/10", "11/10"], "attitude": {"axis": [1, 2, 3], "angle": 1}},
        span={"t": [0, 1], "samples": 2},
    )
    q = [0.1, -0.2, 0.3, 0.4]
    single, again = propagate.propagate(own, quaternion=q), propagate.propagator(own)(quaternion=q)
    turned = propagate.propagator(own)(attitude={"quaternion": q})
    many = propagate_ensemble(own, quaternion=[q, [0, 2, 0, 0]])
    assert np.array_equal(again.omega, single.omega) and np.array_equal(turned.omega, single.omega)
    for each in (single, many[0], many[1]):
        assert np.abs(each.omega_space[0] - [0.3, 0.7, 1.1]).max() < 1e-15
    assert np.abs(many.omega[0] - single.omega).max() < 1e-14
