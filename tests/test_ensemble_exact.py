"""Ensembles in closed form: each trajectory has the bits of its motion alone, and all of them take one call."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot import number
from symrot.closed_form import batches, many, motion
from symrot.closed_form.pairs import attitude
from symrot.ensemble.exact import forms_of
from symrot.ensemble.variation import read_variation
from symrot.errors import InputError
from symrot.inertia import principal
from symrot.propagation.propagator import propagator
from symrot.scene import Initial
from tests.test_changed_start import BESIDE, GRAVITY, SCENES, scene

RANDOM = np.random.default_rng(12)
EXACT = ("free", "tilted", "top", "turned top", "gyrostat", "driven", "braked")


def starts(n):
    """Return angular velocities with all patterns of zeros, and attitudes of all sizes."""
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
    """Return angular velocity and attitude of the scene with such a start, propagated by itself."""
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


@pytest.mark.parametrize("name", EXACT)
def test_each_trajectory_has_the_bits_of_its_motion_alone(name):
    """General starts, zeros, tiny numbers, any norm; times on both sides of the start and at it."""
    given, times = SCENES[name], np.array([0.0, 0.7, 1e3, -2.5])
    omega, quaternion = starts(41)
    found = symrot.propagate_ensemble(given, omega=omega, quaternion=quaternion, t=times, method="exact")
    assert_bits(found, [given] * 41, omega, quaternion, times)


def test_times_and_starts_of_each():
    """A scene that starts at 100 s, times of each trajectory, on one thread and on three."""
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
}  # fmt: skip


@pytest.mark.parametrize("case", VARIED)
def test_varied_constants_give_the_bits_of_their_own_scenes(case):
    given, parameters = VARIED[case]
    given = SCENES.get(given) if isinstance(given, str) else given
    omega, quaternion = starts(40)
    times = np.array([0.0, 0.3, 50.0])
    variation = read_variation(given, omega, quaternion, parameters)
    ensemble = symrot.propagate_ensemble(given, omega=omega, quaternion=quaternion, parameters=parameters, t=times)
    solved = [i for i, method in enumerate(ensemble.methods) if method == "exact"]
    assert solved
    for i in solved:
        own = propagator(variation.scene_of(i), "exact")(times)
        assert ensemble.omega[i].tobytes() == own.y[:3].T.tobytes(), i
        assert ensemble.quaternion[i].tobytes() == own.y[3:].T.tobytes(), i


@pytest.mark.parametrize("name", [*SCENES, *VARIED])
def test_one_scene_of_a_pattern_speaks_for_all(name):
    """The form of each trajectory is that of its own scene."""
    from symrot.closed_form.choose import exact_form

    given, parameters = VARIED.get(name, (name, None))
    given = SCENES[given] if isinstance(given, str) else given
    variation = read_variation(given, *starts(40), parameters)
    seen = {}
    for kind, rows in forms_of(variation):
        seen |= dict.fromkeys(rows.tolist(), kind)
    for i in range(40):
        own = variation.scene_of(i)
        form = exact_form(own)
        assert seen[i] == (form, form and form.axis(own))


@pytest.mark.parametrize(
    ("name", "parameters"),
    [("free", None), ("tilted", None), ("top", None), ("gyrostat", None), ("free", "principal"), ("top", "weight")],
)
def test_no_motion_is_made_alone_and_no_axes_are_found_again(name, parameters, monkeypatch):
    """Calls are counted: principal axes at most once, C for all trajectories once, no motion in Python."""
    n, counts = 2000, {"axes": 0, "calls": 0}
    values = {"principal": 1 + RANDOM.random((n, 3)) / 2, "weight": 1 + RANDOM.random(n)}
    symrot.propagate_ensemble(SCENES[name], omega=RANDOM.standard_normal((2, 3)))

    def counting(key, function):
        def counted(*given, **more):
            counts[key] += 1
            return function(*given, **more)

        return counted

    monkeypatch.setattr(principal, "_jacobi", counting("axes", principal._jacobi))
    monkeypatch.setattr(many, "evaluate", counting("calls", many.evaluate))
    monkeypatch.setattr(motion, "_Compiled", None)
    symrot.propagate_ensemble(
        SCENES[name], omega=RANDOM.standard_normal((n, 3)), quaternion=RANDOM.standard_normal((n, 4)), t=[0.0, 1.0],
        parameters=parameters and {parameters: values[parameters]},
    )  # fmt: skip
    assert counts["axes"] <= 1 and counts["calls"] == 1


def test_numbers_that_leave_the_doubles_are_refused_as_for_one():
    """One sentence, wherever the trajectory stands."""
    omega = RANDOM.standard_normal((5, 3))
    omega[3] = [0, 1e300, 0]
    with pytest.raises(InputError, match="magnitude up to 1e\\+205"):
        symrot.propagate_ensemble(SCENES["free"], omega=omega)
    omega[3] = [0, 1e150, 1e-3]
    with pytest.raises(InputError, match="that doubles can hold"):
        symrot.propagate_ensemble(SCENES["free"], omega=omega, t=[0.0, 1e300])


def test_attitudes_of_many_are_those_of_one():
    """Pairs of doubles for many, exact numbers for one: the same bits, ties and all."""
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
    """What has no closed form is found out once for all starts with the same zeros."""
    found = symrot.propagate_ensemble(scene([BESIDE], inertia=(1, 2, 3)), omega=RANDOM.standard_normal((9, 3)))
    assert set(found.methods) == {"taylor"}


@pytest.mark.parametrize(
    ("name", "seconds", "methods"),
    [
        ("free", 1e-3, {"exact"}), ("free", 1e6, {"exact"}), ("top", 1e-3, {"exact"}), ("gyrostat", 1e-3, {"exact"}),
        ("driven", 1.0, {"taylor"}), ("driven", 1e6, {"exact"}), ("braked", 1.0, {"taylor"}),
        ("turned top", 1.0, {"taylor"}), ("turned top", 1e3, {"exact"}), ("turned top", 40.0, {"exact", "taylor"}),
    ],
)  # fmt: skip
def test_auto_takes_what_was_measured_to_be_faster(name, seconds, methods):
    """Arrays of closed forms always; those made one by one where the body turns far; each for itself."""
    omega = np.random.default_rng(3).uniform(0.5, 3.0, (20, 3))
    found = symrot.propagate_ensemble(SCENES[name], omega=omega, t=[0.0, seconds])
    assert set(found.methods) == methods
    for i in (0, 7):
        alone = symrot.propagate_ensemble(SCENES[name], omega=omega[i : i + 1], t=[0.0, seconds])
        assert alone.methods[0] == found.methods[i] and alone.omega.tobytes() == found.omega[i].tobytes()
