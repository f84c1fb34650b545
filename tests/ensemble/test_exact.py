"""Ensembles in closed form: each trajectory has the bits of its motion alone, and one call computes all."""

import gc
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.build import cache as codegen
from symrot.closed_form import batches, many, motion
from symrot.closed_form.arithmetic.pairs import attitude
from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.closed_form.spin_up import compiled as spin_up_compiled
from symrot.ensemble import exact, reading, variation
from symrot.ensemble.exact import forms_of
from symrot.ensemble.reading import read_variation
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.inertia import principal
from symrot.propagation.propagate import propagator
from symrot.scene.tables import Initial
from tests.propagation.test_changed_start import BESIDE, GRAVITY, SCENES, scene

pytestmark = pytest.mark.usefixtures("quick_compiler")

RANDOM = np.random.default_rng(12)
PUSH = {"kind": "constant_body", "torque": [0, 0, "1/9"]}
BRAKE = {"kind": "damping", "linear": ["1/10", "1/10", "1/5"]}
TURNED = {"kind": "gravity", "weight": "13/10", "direction": [2, -1, 2]}
FAMILIES = {name: SCENES[name] for name in ("free", "tilted", "top", "turned top", "gyrostat", "driven", "braked")} | {
    "top upside down": scene([{**GRAVITY, "center_of_mass": [0, 0, "-1/3"]}]),
    "top about 2, tilted": scene([{**TURNED, "center_of_mass": [0, "1/7", 0]}], inertia=(2, 1, 2)),
    "top, turned exactly": scene([{**TURNED, "direction": [3, 0, -4], "center_of_mass": ["1/2", 0, 0]}], inertia=(1, 2, 2)),
    "gyrostat about 1": scene([{"kind": "rotor", "angular_momentum": ["-3/7", 0, 0]}], inertia=(1, 2, 2)),
    "gyrostat, a ball": scene([{"kind": "rotor", "angular_momentum": [0, "1/7", 0]}], inertia=(2, 2, 2)),
    "driven about 1": scene([{**PUSH, "torque": ["-1/9", 0, 0]}], inertia=(1, 2, 2)),
    "driven, a ball": scene([PUSH], inertia=(2, 2, 2)),
    "driven twice": scene([PUSH, {**PUSH, "torque": [0, 0, "1/11"]}]),
    "driven by nothing": scene([{**PUSH, "torque": [0, 0, 0]}]),
    "driven and braked": scene([PUSH, BRAKE], output={"quantities": ["omega"]}),
    "braked to the last rate": scene([{**PUSH, "torque": [0, 0, "1/5"]}, BRAKE], inertia=(2, 3, 4), omega=(0, 0, 1)),
    "hardly driven": scene([{**PUSH, "torque": [0, 0, "1e-90"]}]),
    "driven hard": scene([{**PUSH, "torque": [0, 0, "1e12"]}]),
}  # fmt: skip
"""Motions in closed form, of every form, about every axis; some with the numbers that their formulas divide by."""


def starts(n):
    """Return angular velocities with all patterns of zeros, and attitudes of all norms."""
    omega = RANDOM.standard_normal((n, 3))
    for k in range(3):
        omega[:, k][np.arange(n) % 8 >> k & 1 == 1] = 0.0
    omega[3] *= 1e-170
    omega[5, 1] = 1e-70 * omega[5, 0]
    quaternion = RANDOM.standard_normal((n, 4)) * 10.0 ** RANDOM.integers(-30, 30, (n, 1))
    quaternion[::5] = np.eye(4)[RANDOM.integers(0, 4, len(quaternion[::5]))]
    quaternion[1::7] = np.round(3 * RANDOM.standard_normal((len(quaternion[1::7]), 4)))
    quaternion[1::7, 0] += 9.0
    return omega, quaternion


def alone(given, omega, quaternion, times):
    """Return angular velocity and attitude of the scene with this start, propagated as a single motion."""
    q = given.initial.quaternion if quaternion is None else number.unit(list(map(Fraction, quaternion.tolist())))
    start = Initial(tuple(map(Fraction, omega.tolist())), tuple(q))
    found = propagator(replace(given, initial=start), "exact")(times)
    return found.y[:3].T, found.y[3:].T


def assert_bits(ensemble, scenes, omega, quaternion, times):
    for i, given in enumerate(scenes):
        own = times if times.ndim == 1 else times[i]
        rates, attitudes = alone(given, omega[i], None if quaternion is None else quaternion[i], own)
        assert ensemble.omega[i].tobytes() == np.ascontiguousarray(rates).tobytes(), i
        if attitudes.size:
            assert ensemble.quaternion[i].tobytes() == np.ascontiguousarray(attitudes).tobytes(), i


HOSTILE = np.array(
    [
        [0, 0, 0], [0, 0, 1], [0, 0, -2.0], [1, 0, 0], [0, 1e-300, 0], [1e-170, 1e-170, 1e-170], [1e-12, 0, 5],
        [0, 3, 1e-200], [1e150, 1, 0], [-0.0, 0.25, -0.0], [-0.0, -0.0, -0.0], [1, 1, 1], [0.1, 0.2, -1e-9],
        [1e-9, 0, -1e-3], [0, 0, 0.5555555555555556], [3, 4, -0.4], [1e9, 1e-9, 1], [5e-324, 0, 1],
    ]
)  # fmt: skip
ATTITUDES = np.array(
    [
        [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -2, 0], [1, 1, 0, 0], [1, 1, 1, 1], [-0.0, 0.5, -0.5, 0.1], [3, 4, 0, 0],
        [1, 1e-30, 0, 0], [1e-290, 2e-290, 0, 1e-290], [1e200, 1e180, 3, 0], [3, 1, -1, 0.5], [1, 0, 2, -1e-17],
    ]
)  # fmt: skip


def outcome(run):
    """Return the result of ``run``, or the message of its error."""
    try:
        return run()
    except InputError as error:
        return str(error)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", FAMILIES)
def test_each_trajectory_has_the_bits_of_its_motion_alone(name):
    """Starts are general, zero or tiny, of any norm; times are before, at and after the start."""
    given, times = FAMILIES[name], np.array([0.0, 0.7, 1e3, -2.5])
    omega, quaternion = starts(41)
    if name == "braked to the last rate":
        omega[:, :2] = 0.0
    found = symrot.propagate_ensemble(given, omega=omega, quaternion=quaternion, t=times, method="exact")
    assert set(found.methods) == {"exact"}
    assert_bits(found, [given] * 41, omega, quaternion, times)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", FAMILIES)
def test_hostile_starts_have_the_bits_of_their_motions_alone(name):
    """Starts are rest, resonance, extreme rates, very small and large numbers and signed zeros, also at times far from
    the start.

    What a single motion refuses, an ensemble refuses in the same words.
    """
    given, times = FAMILIES[name], np.array([1e-9, 0.5, 20.0, 1e7, 1e14, -3.0])
    omega, quaternion = HOSTILE, ATTITUDES[np.arange(len(HOSTILE)) % len(ATTITUDES)]
    if name == "braked to the last rate":
        omega = omega * [0, 0, 1]
        omega[11] = [0, 0, 1]
    good = []
    for i in range(len(omega)):
        own = outcome(lambda i=i: alone(given, omega[i], quaternion[i], times))
        row = slice(i, i + 1)
        found = outcome(
            lambda row=row: symrot.propagate_ensemble(
                given, omega=omega[row], quaternion=quaternion[row], t=times, method="exact"
            )
        )
        if isinstance(own, str) or isinstance(found, str):
            assert own == found, i
        else:
            assert_bits(found, [given], omega[row], quaternion[row], times)
            good.append(i)
    assert len(good) > len(omega) // 2
    together = symrot.propagate_ensemble(given, omega=omega[good], quaternion=quaternion[good], t=times, method="exact")
    assert_bits(together, [given] * len(good), omega[good], quaternion[good], times)


def test_spin_ups_through_resonance_have_the_bits_of_their_motions_alone():
    """Motions start before, in and after resonance, also backward in time; any number of them need polynomials."""
    given = scene([PUSH], inertia=(2, 2, 1))
    random = np.random.default_rng(7)
    omega = random.standard_normal((45, 3)) * [1, 1, 6]
    omega[::9, :2] *= 1e-8
    times = random.uniform(-200, 200, (45, 5))
    times[::4] = 0.01 * times[::4]
    for n in (45, 44, 3, 1):
        found = symrot.propagate_ensemble(given, omega=omega[:n], t=times[:n], method="exact")
        assert_bits(found, [given] * n, omega[:n], None, times[:n])


def test_turned_attitudes_are_those_of_one():
    """Norms are arbitrary, and components cancel in the product."""
    random, frame = np.random.default_rng(5), heavy_top.Frame(1, [Fraction(1), Fraction(-2), Fraction(3)])
    back = np.array([float(x) for x in frame.before]) * [1, -1, -1, -1]
    cases = np.vstack([random.standard_normal((3000, 4)), ATTITUDES, back, back + 1e-9, np.round(back, 3)])
    for row, found in zip(cases, batches.turned(frame, cases), strict=True):
        assert frame.start(number.unit(list(map(Fraction, row.tolist())))) == found.tolist()


def test_times_and_starts_of_each():
    """The scene starts at 100 s, each trajectory has its own times; one and three threads give equal results."""
    given = scene(inertia=(5, 20, 17), span=(100, 101), attitude=(1, 2, 3, 4))
    omega, times = RANDOM.standard_normal((3000, 3)), 100 + RANDOM.integers(-2, 3, (3000, 3)) / 4
    found = [symrot.propagate_ensemble(given, omega=omega, t=times, workers=workers) for workers in (1, 3)]
    assert found[0].omega.tobytes() == found[1].omega.tobytes()
    assert found[0].quaternion.tobytes() == found[1].quaternion.tobytes()
    assert_bits(found[0], [given] * 60, omega, None, times)


VARIED = {
    "moments": ("free", {"principal": 1 + RANDOM.integers(0, 4, (40, 3)) / 4}),
    "one moment": ("free", {"I_zz": 16 + RANDOM.random(40) * 8}),
    "of a decimal": (scene(inertia=("1/10", "1/10", "1/7")), {"I_xx": np.resize([0.1, 0.11], 40)}),
    "a product": ("free", {"I_xy": np.resize([0.0, 0.5, 1e-90], 40)}),
    "weight": ("top", {"weight": RANDOM.random(40) + 0.1}),
    "centre": ("top", {"center_of_mass": RANDOM.standard_normal((40, 3)) * np.resize([[0, 0, 1], [0, 0, -1], [1, 0, 0]], (40, 3))}),
    "moments of a top": (scene([{**GRAVITY, "weight": 2}]), {"principal": np.resize([[2, 2, 1], [1, 1, 1.5], [2, 2, 2]], (40, 3))}),
    "rotor": ("gyrostat", {"angular_momentum": RANDOM.standard_normal((40, 3)) * [0, 0, 1]}),
    "push": ("driven", {"torque_3": RANDOM.standard_normal(40)}),
    "torque that ends": ("driven", {"torque_3": np.resize([0.0, 1e-9, -2.0, 1e10], 40)}),
    "spin-up": ("driven", {"torque_3": RANDOM.standard_normal(40), "principal": np.outer(RANDOM.random(40) + 1, [2, 2, 1])}),
    "spin-up, of a decimal": (scene([PUSH], inertia=("1/10", "1/10", "1/7")), {"torque_3": RANDOM.random(40)}),
    "centre on either side": ("top", {"center_of_mass_3": RANDOM.standard_normal(40)}),
    "weight of a turned top": ("turned top", {"weight": RANDOM.random(40) + 0.1}),
    "centre of a turned top": (FAMILIES["top about 2, tilted"], {"center_of_mass_2": RANDOM.standard_normal(40)}),
    "moments of a turned top": ("turned top", {"principal": np.outer(RANDOM.random(40) + 1, [1, 2, 2])}),
    "rotor of a ball": (FAMILIES["gyrostat, a ball"], {"angular_momentum_2": np.resize([0.0, 1.5, -0.1], 40)}),
    "gyrostat": ("gyrostat", {"principal": np.outer(RANDOM.random(40) + 1, [2, 2, 1]), "angular_momentum_3": RANDOM.random(40)}),
    "rate about an axis": (FAMILIES["braked to the last rate"], {"torque_3": np.resize([0.2, 0.4, 0.0, -1e-30], 40), "linear": np.resize([[1, 2, 0.2], [1, 1, 0.0], [0, 0, 3e8]], (40, 3))}),
    "brake": (FAMILIES["driven and braked"], {"linear": np.resize([[0.5, 0.5, 0.2], [0.1, 0.1, 0.0]], (40, 3)), "principal": np.outer(RANDOM.random(40) + 1, [2, 2, 1])}),
    "brake of two": (FAMILIES["driven twice"], {"torque_3": RANDOM.random(40)}),
}  # fmt: skip


@pytest.mark.thinned(4)
@pytest.mark.parametrize("case", VARIED)
def test_varied_constants_give_the_bits_of_their_own_scenes(case):
    given, parameters = VARIED[case]
    given = SCENES.get(given) if isinstance(given, str) else given
    omega, quaternion = starts(40)
    if case == "rate about an axis":
        omega[:, :2] = 0.0
    times = np.array([0.0, 0.3, 50.0])
    own_scenes = read_variation(given, omega, quaternion, parameters).scene_of
    ensemble = symrot.propagate_ensemble(
        given, omega=omega, quaternion=quaternion, parameters=parameters, t=times,
        method="exact" if case == "a product" else "auto",
    )  # fmt: skip
    solved = [i for i, method in enumerate(ensemble.methods) if method == "exact"]
    assert solved
    for i in solved:
        own = propagator(own_scenes(i), "exact")(times)
        assert ensemble.omega[i].tobytes() == own.y[:3].T.tobytes(), i
        if own.has_attitude:
            assert ensemble.quaternion[i].tobytes() == own.y[3:].T.tobytes(), i


@pytest.mark.parametrize("name", [*SCENES, *FAMILIES, *VARIED])
def test_one_scene_of_a_pattern_speaks_for_all(name):
    """The closed form of each trajectory is the form of its own scene."""
    from symrot.closed_form.registry import exact_form

    given, parameters = VARIED.get(name, (name, None))
    given = (FAMILIES | SCENES)[given] if isinstance(given, str) else given
    varied = read_variation(given, *starts(40), parameters)
    seen = {}
    for kind, rows in forms_of(varied):
        seen |= dict.fromkeys(rows.tolist(), kind)
    for i in range(40):
        own = varied.scene_of(i)
        form = exact_form(own)
        assert seen[i] == (form, form and form.axis(own))


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("free", None), ("tilted", None), ("top", None), ("gyrostat", None), ("turned top", None), ("driven", None),
        ("free", "principal"), ("top", "weight"), ("turned top", "weight"), ("gyrostat", "angular_momentum_3"),
        ("driven", "torque_3"), ("tilted", "I_xy"),
    ],
)  # fmt: skip
def test_no_motion_is_made_alone_and_no_axes_are_found_again(name, parameters, monkeypatch):
    """Counted calls: principal axes at most once, C once for all trajectories, no motion in Python."""
    n, counts = 2000, {"axes": 0, "calls": 0}
    values = {"principal": 1 + RANDOM.random((n, 3)) / 2}
    values["I_xy"] = RANDOM.random(n) / 5
    values |= dict.fromkeys(("weight", "angular_momentum_3", "torque_3"), 1 + RANDOM.random(n))
    symrot.propagate_ensemble(SCENES[name], omega=RANDOM.standard_normal((2, 3)))

    def counting(key, function):
        def counted(*given, **more):
            counts[key] += 1
            return function(*given, **more)

        return counted

    monkeypatch.setattr(principal, "_jacobi", counting("axes", principal._jacobi))
    monkeypatch.setattr(many, "evaluate", counting("calls", many.evaluate))
    monkeypatch.setattr(motion, "_Compiled", None)
    monkeypatch.setattr(spin_up_compiled, "Compiled", None)
    symrot.propagate_ensemble(
        SCENES[name], omega=RANDOM.standard_normal((n, 3)), quaternion=RANDOM.standard_normal((n, 4)), t=[0.0, 1.0],
        parameters=parameters and {parameters: values[parameters]}, method="exact",
    )  # fmt: skip
    # where the tensor varies: once to choose the form, once for a plan that covers all
    assert counts["axes"] <= (2 if parameters == "I_xy" else 1) and counts["calls"] == 1


def test_numbers_that_leave_the_doubles_are_refused_as_for_one():
    """The same single sentence is raised, whichever trajectory it is."""
    omega = RANDOM.standard_normal((5, 3))
    omega[3] = [0, 1e300, 0]
    with pytest.raises(InputError, match="magnitude up to 1e\\+205"):
        symrot.propagate_ensemble(SCENES["free"], omega=omega)
    omega[3] = [0, 1e150, 1e-3]
    with pytest.raises(InputError, match="within the range of doubles"):
        symrot.propagate_ensemble(SCENES["free"], omega=omega, t=[0.0, 1e300])
    with pytest.raises(InputError, match="within the range of doubles"):  # times may be in any order
        symrot.propagate_ensemble(SCENES["free"], omega=omega, t=[0.0, 1e300, 1.0])


def test_attitudes_of_many_are_those_of_one():
    """Pairs of doubles for many and exact numbers for one give the same bits, also for ties."""
    cases = np.vstack(
        [
            RANDOM.standard_normal((4000, 4)), RANDOM.integers(-3, 4, (500, 4)) + np.array([0.5, 0, 0, 0]),
            RANDOM.standard_normal((500, 4)) * 10.0 ** RANDOM.integers(-60, 60, (500, 4)),
            [[1, 1e-120, 0, -0.0], [-1, 0, 0, 2.0**-299], [1e300, 1e-300, 1, 1], [5e-324, 0, 0, 5e-324]],
        ]
    )  # fmt: skip
    for row, found in zip(cases, batches.attitudes(cases), strict=True):
        assert attitude(number.unit(list(map(Fraction, row.tolist())))) == found.tolist()


def test_a_pendulum_beside_its_axis_is_stepped():
    """The lack of a closed form is determined once for all starts with the same zeros."""
    found = symrot.propagate_ensemble(scene([BESIDE], inertia=(1, 2, 3)), omega=RANDOM.standard_normal((9, 3)))
    assert set(found.methods) == {"taylor"}


@pytest.mark.parametrize(
    ("name", "seconds", "methods"),
    [
        ("free", 1e-3, {"exact"}), ("free", 1e6, {"exact"}), ("top", 1e-3, {"exact"}), ("gyrostat", 1e-3, {"exact"}),
        ("driven", 1e-3, {"exact"}), ("driven", 1e6, {"exact"}), ("turned top", 1e-3, {"exact"}),
        ("tilted", 1e-3, {"exact"}), ("tilted", 1e6, {"exact"}), ("braked", 1.0, {"taylor"}), ("braked", 1e6, {"exact"}), ("braked", 3e3, {"exact", "taylor"}),
    ],
)  # fmt: skip
def test_auto_takes_what_was_measured_to_be_faster(name, seconds, methods):
    """Closed forms are computed in arrays, except for damped bodies, which are computed one by one."""
    omega = np.random.default_rng(3).uniform(0.5, 3.0, (20, 3))
    found = symrot.propagate_ensemble(SCENES[name], omega=omega, t=[0.0, seconds])
    assert set(found.methods) == methods
    for i in (0, 7):
        alone = symrot.propagate_ensemble(SCENES[name], omega=omega[i : i + 1], t=[0.0, seconds])
        assert alone.methods[0] == found.methods[i] and alone.omega.tobytes() == found.omega[i].tobytes()


def test_auto_takes_closed_forms_made_one_by_one_where_the_body_turns_far():
    """Principal axes in fractions take a millisecond; a damped body with varied constants is computed in arrays."""
    omega = np.random.default_rng(3).uniform(0.5, 3.0, (20, 3))
    tensors = {"I_xy": np.linspace(0.1, 0.2, 20)}
    found = symrot.propagate_ensemble(SCENES["tilted"], omega=omega, t=[0.0, 1.0], parameters=tensors)
    assert set(found.methods) == {"exact"}
    tensors = {"I_xy": np.linspace(1e-70, 2e-70, 20), "I_xz": np.zeros(20), "I_yz": np.full(20, 1e-70)}
    for seconds, methods in ((1.0, {"taylor"}), (3e3, {"exact", "taylor"}), (1e6, {"exact"})):
        found = symrot.propagate_ensemble(SCENES["tilted"], omega=omega, t=[0.0, seconds], parameters=tensors)
        assert set(found.methods) == methods
    linear = {"linear": np.outer(np.linspace(0.1, 0.2, 20), [1, 1, 2])}
    found = symrot.propagate_ensemble(SCENES["braked"], omega=omega, t=[0.0, 1.0], parameters=linear)
    assert set(found.methods) == {"exact"}


def test_bodies_whose_tensors_vary_are_checked(monkeypatch):
    """Doubles decide clear cases without principal axes; an impossible body is refused, whichever trajectory it is."""
    tensors = np.linspace(0.1, 0.2, 50)
    calls = []
    monkeypatch.setattr(reading, "require_admissible", lambda *given: calls.append(given))
    read_variation(SCENES["tilted"], None, None, {"I_xy": tensors})
    assert calls == []
    monkeypatch.undo()
    tensors[31] = 2.9
    with pytest.raises(InputError, match="trajectory 31"):
        read_variation(SCENES["tilted"], None, None, {"I_xy": tensors})


def test_what_a_scene_gives_is_found_once(monkeypatch):
    """A second ensemble of a scene searches no form, makes no plan, asks for no compiler, and keeps no scene."""
    given, omega = scene([GRAVITY]), np.random.default_rng(3).standard_normal((5, 3))
    quaternion = np.random.default_rng(4).standard_normal((5, 4))
    parameters = {"weight": np.linspace(1, 2, 5)}
    first = [symrot.propagate_ensemble(given, omega=omega, parameters=each) for each in (None, parameters)]
    for room, name in ((exact, "exact_form"), (variation, "make_plan"), (codegen, "missing"), (codegen, "compiler")):
        monkeypatch.setattr(room, name, None)
    again = [symrot.propagate_ensemble(given, omega=omega, parameters=each) for each in (None, parameters)]
    assert [each.omega.tobytes() for each in first] == [each.omega.tobytes() for each in again]
    symrot.propagate_ensemble(
        given, omega=2 * omega, quaternion=quaternion, parameters={"weight": np.linspace(3, 9, 5)}
    )
    place = id(given)
    assert place in variation._caches
    del given, first, again
    gc.collect()
    assert place not in variation._caches
