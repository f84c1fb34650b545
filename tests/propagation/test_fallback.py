"""SciPy's solvers around a kernel keep the stepper's promises: tolerance, sampling, switching, errors in one sentence."""

import math

import numpy as np
import pytest

import symrot
from symrot.errors import InputError, PropagationError
from symrot.propagation import progress
from symrot.propagation.propagate import propagator
from symrot.propagation.steppers import fallback
from symrot.scene.scene import Scene
from tests.reference.tops import MOTIONS, TIMES, error, parameters, rigid_body, taylor, wave

pytestmark = pytest.mark.usefixtures("quick_compiler")


@pytest.mark.parametrize("text, name", [("scipy", "DOP853"), ("scipy:LSODA", "LSODA"), ("BDF", "BDF")])
def test_scipy_methods_are_known_by_name(text, name):
    assert fallback.method_name(text) == name


@pytest.mark.parametrize("text", ["scipy:RK4", "scipy:lsoda", "euler"])
def test_unknown_scipy_methods_are_refused_with_the_list(text):
    with pytest.raises(InputError, match=r"scipy:RK45.*scipy:LSODA, got '"):
        fallback.method_name(text)


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "method, tolerance",
    [
        ("DOP853", 1e-4),
        ("DOP853", 1e-9),
        ("RK45", 1e-5),
        ("RK23", 1e-3),
        ("Radau", 1e-4),
        ("BDF", 1e-4),
        ("LSODA", 1e-7),
    ],
)
@pytest.mark.parametrize("name", ["flips about the middle axis", "asymmetric top"])
def test_the_fallback_means_the_same_by_a_tolerance(name, method, tolerance):
    states, stats = fallback.integrate(
        rigid_body, parameters(name), MOTIONS[name][2], 0.0, TIMES, tolerance, fallback.Options(method)
    )
    assert error(states, taylor(name)) < 20 * tolerance
    assert stats.evaluations > stats.accepted > 0


@pytest.mark.parametrize("method", ["scipy:LSODA", "scipy:DOP853"])
def test_a_tolerance_below_the_rounding_errors_of_the_steps_gives_a_warning(method):
    """The motion of a free body is off by less than 5 tolerances, or a warning says that it may be off by more."""
    body = {"body": {"principal": [1, 2, "5/2"]}, "initial": {"omega": ["1/10", "3/10", 1]}, "span": {"t": [0, 10]}}
    content = {"schema": 1, **body, "output": {"quantities": ["omega", "quaternion"]}}
    exact = symrot.propagate(content, method="exact", t=[-5, 5, 10])
    warned = []
    for tolerance in (1e-15, 1e-14, 1e-13, 1e-12, 1e-10):
        found = symrot.propagate(content, method=method, t=[-5, 5, 10], tolerance=tolerance)
        apart = max(abs(found.omega - exact.omega).max(), abs(found.quaternion - exact.quaternion).max())
        assert apart < 5 * tolerance or found.warnings
        if found.warnings:
            warned.append(tolerance)
            assert "rounding errors, in the steps of SciPy" in found.warnings[0]
    assert 1e-15 in warned and 1e-10 not in warned
    many = symrot.propagate_ensemble(content, omega=[[0.1, 0.3, 1]], t=[5, 10], method=method, tolerance=1e-15)
    assert "rounding errors, in the steps of SciPy" in many.warnings[0][0]


def test_the_fallback_samples_and_records_as_the_stepper_does():
    times = np.array([3.0, -2.0, 0.0, 3.0, 1.5])
    arguments = (lambda t, y, p: [y[1], -y[0]], [], [1.0, 0.0], 0.0)
    blocks = fallback.Options(blocks=(0, 2), scales=(1.0,))
    states, _ = fallback.integrate(*arguments, times, 1e-9, blocks)
    assert abs(states - wave(times)).max() < 1e-8
    assert np.array_equal(states[2], [1.0, 0.0])
    solution = fallback.record(*arguments, (-2.0, 3.0), 1e-9, blocks)
    assert abs(solution(times) - wave(times)).max() < 1e-8
    assert solution(1.0).shape == (2,)
    assert fallback.integrate(*arguments, [], 1e-9, blocks)[0].shape == (0, 2)
    with pytest.raises(InputError, match=r"motion is known, got 3\.5 s"):
        solution(3.5)


def test_the_fallback_restarts_at_a_switching_time():
    def rate(t, y, p):
        return [2 * y[0] if t >= 1.0 else -y[0]]

    found, _ = fallback.integrate(
        rate, [], [1.0], 0.0, [1.0, 3.0], 1e-11, fallback.Options(blocks=(0, 1), scales=(0.0,), breaks=[1.0])
    )
    assert found[:, 0] == pytest.approx([math.exp(-1.0), math.exp(3.0)], rel=1e-9)


@pytest.mark.parametrize(
    "rate, options, kind, sentence",
    [
        (lambda t, y, p: [math.nan], {}, PropagationError, "not finite"),
        (lambda t, y, p: [math.nan if t > 0.5 else 1.0], {}, PropagationError, r"beyond t = 0.\d+ s"),
        (lambda t, y, p: [y[0]], {"max_steps": 10}, PropagationError, "10 evaluations of the equations"),
        (lambda t, y, p: [1.0, 2.0], {}, InputError, "returns 1 numbers"),
        (lambda t, y, p: [1.0], {"method": "Euler"}, InputError, "method: expected one of scipy:DOP853"),
        (lambda t, y, p: [1.0], {"max_step": 0.0}, InputError, "max_step: expected"),
    ],
    ids=["nan", "nan later", "long", "shape", "name", "step"],
)
def test_the_fallback_says_what_is_wrong(rate, options, kind, sentence):
    with pytest.raises(kind, match=sentence):
        fallback.integrate(rate, [], [1.0], 0.0, [1.0], 1e-6, fallback.Options(blocks=(0, 1), scales=(1.0,), **options))


def pole(t, y, p):
    return [0.1 * math.tan(t)]


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", list(fallback.METHODS))
def test_a_pole_ends_in_a_sentence_and_keeps_the_samples_before_it(method):
    times = np.linspace(0.0, 4.0, 41)
    with pytest.raises(
        PropagationError, match=r"beyond t = 1\.570\d* s on the way to 4\.0 s: the step shrank"
    ) as caught:
        fallback.integrate(pole, [], [0.3], 0.0, times, 1e-7, fallback.Options(method, (0, 1), (0.0,)))
    numbers, states, _ = caught.value.samples
    assert numbers.tolist() == list(range(16))
    assert abs(states[:, 0] - 0.3 + 0.1 * np.log(np.cos(times[:16]))).max() < 20 * 1e-7


def test_a_state_that_grows_without_bound_does_not_loosen_the_samples_before():
    times = np.linspace(0.0, 4.0, 41)  # 1/(1 - t/2): the largest size on the way is that of the pole
    with pytest.raises(PropagationError, match=r"on the way to 4\.0 s") as caught:
        fallback.integrate(
            lambda t, y, p: 0.5 * y * y, [], [1.0], 0.0, times, 1e-7, fallback.Options(blocks=(0, 1), scales=(0.0,))
        )
    numbers, states, _ = caught.value.samples
    assert numbers.tolist()[:20] == list(range(20))
    exact = 1.0 / (1.0 - 0.5 * times[:15])
    assert abs(states[:15, 0] / exact - 1.0).max() < 20 * 1e-7


def switching_scene(stop, *torque):
    content = {
        "schema": 1, "body": {"principal": [1, 2, 3]}, "initial": {"omega": [0.1, 0.2, 0.3]}, "span": {"t": [0, stop]},
        "torque": [{"kind": "expression", "torque": list(torque)}], "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    return Scene.from_dict(content)


SWITCHING = ("0.02*sign(sin(0.5*t))", "-0.01*sign(omega_2 - 0.3)", "0.05*sin(t)**3")


@pytest.mark.parametrize("method", ["scipy:RK45", "scipy:LSODA"])
def test_an_interrupt_under_switches_keeps_every_sample_up_to_it(method):
    """A progress report interrupts, at several times, before and after switches of one window."""
    propagate = propagator(switching_scene(100, *SWITCHING), method, 1e-6)
    times = np.linspace(0.0, 100.0, 2001)
    whole = propagate(times).omega
    for place in (43.0, 91.0):

        def interrupt(t, start, end, place=place):
            assert (start, end) == (0.0, 100.0)
            if t >= place:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt) as caught, progress.reporting(interrupt):
            propagate(times)
        kept = caught.value.trajectory
        # what SciPy followed beyond a switch is of no use
        last_switch = max(2 * math.pi * k for k in range(16) if 2 * math.pi * k < place)
        assert kept.t[-1] > last_switch - 0.1 and np.array_equal(kept.t, times[: len(kept)])
        assert abs(kept.omega - whole[: len(kept)]).max() < 1e-5


@pytest.mark.parametrize("method", [pytest.param("scipy:LSODA", marks=pytest.mark.campaign), "scipy:DOP853"])
def test_endlessly_many_switches_are_given_up_soon_with_the_samples_before(method):
    propagate = propagator(switching_scene(10_000_000, "0", "0", "1e-6*step(0.1 - mod(t, 1))"), method, 1e-6)
    with pytest.raises(PropagationError, match="far more than the largest allowed number") as caught:
        propagate([0.5, 1.5, 10_000_000])
    assert caught.value.trajectory.t.tolist() == [0.5, 1.5]


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", list(fallback.METHODS))
def test_a_torque_that_leaves_zero_slowly_is_followed(method):
    """Nothing acts until 1 s; then torques that grow with the fifth power of time act about two axes."""
    scene = switching_scene(3, "where(t > 1, (t-1)**5, 0)", "where(t > 1, (t-1)**5, 0)", "0")
    exact, found = propagator(scene, "dop853", 1e-11)(), propagator(scene, f"scipy:{method}", 1e-6)()
    assert abs(found.omega - exact.omega).max() < 20 * 1e-6 * abs(exact.omega).max()
    assert abs(found.quaternion - exact.quaternion).max() < 20 * 1e-6


HYSTERESIS = "-0.5577*where(omega_{0} > 0.3021, 1, where(omega_{0} < -0.2165, -1, 0)) + 0.447*sin(2.01*t)"
HYSTERETIC = {  # one that is stepped from rest by LSODA, and one that slides where the other mode is no divisor
    "from rest": ([1, 1, 2], [0, 0, -0.3647], ["0", HYSTERESIS.format(2), "0"]),
    "slides": (
        [1, 1.5, 2], [0.266, 0.383, -0.1882],
        ["0", "0", "-0.4927*where(omega_3 > 0.3939, 1, where(omega_3 < -0.1193, -1, 0)) + 0.1286*sin(1.7792*t)"],
    ),
}  # fmt: skip


@pytest.mark.thinned(2)
@pytest.mark.parametrize("method", ["taylor", "scipy:LSODA", "scipy:RK45"])
@pytest.mark.parametrize("name", HYSTERETIC)
def test_a_torque_that_falls_behind_two_thresholds_is_followed(name, method):
    body, omega, torque = HYSTERETIC[name]
    content = {
        "schema": 1, "body": {"principal": body}, "initial": {"omega": omega}, "span": {"t": [0, 3]},
        "torque": [{"kind": "expression", "torque": torque}], "output": {"quantities": ["omega", "quaternion"]},
    }  # fmt: skip
    scene = Scene.from_dict(content)
    times = np.linspace(0.0, 3.0, 7)
    exact, found = propagator(scene, "dop853", 1e-11)(times), propagator(scene, method, 1e-6)(times)
    assert abs(found.omega - exact.omega).max() < 20 * 1e-6 * abs(exact.omega).max()
    assert abs(found.quaternion - exact.quaternion).max() < 20 * 1e-6
