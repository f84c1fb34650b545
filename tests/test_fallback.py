"""SciPy around a kernel keeps the promises of the stepper: tolerance, sampling, switching, errors in a sentence."""

import math

import numpy as np
import pytest

from symrot.errors import InputError, PropagationError
from symrot.propagation import fallback
from tests.reference.tops import MOTIONS, TIMES, error, parameters, rigid_body, taylor, wave


@pytest.mark.parametrize("text, name", [("scipy", "DOP853"), ("scipy:LSODA", "LSODA"), ("BDF", "BDF")])
def test_scipy_methods_are_known_by_name(text, name):
    assert fallback.method_name(text) == name


@pytest.mark.parametrize("text", ["scipy:RK4", "scipy:lsoda", "euler"])
def test_unknown_scipy_methods_are_refused_with_the_list(text):
    with pytest.raises(InputError, match=r"scipy:RK45.*scipy:LSODA; got '"):
        fallback.method_name(text)


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
        rigid_body, parameters(name), MOTIONS[name][2], 0.0, TIMES, tolerance, method=method
    )
    assert error(states, taylor(name)) < 20 * tolerance
    assert stats.evaluations > stats.accepted > 0


def test_the_fallback_samples_and_records_as_the_stepper_does():
    times = np.array([3.0, -2.0, 0.0, 3.0, 1.5])
    arguments = (lambda t, y, p: [y[1], -y[0]], [], [1.0, 0.0], 0.0)
    blocks = {"blocks": (0, 2), "scales": (1.0,)}
    states, _ = fallback.integrate(*arguments, times, 1e-9, **blocks)
    assert abs(states - wave(times)).max() < 1e-8
    assert np.array_equal(states[2], [1.0, 0.0])
    solution = fallback.record(*arguments, (-2.0, 3.0), 1e-9, **blocks)
    assert abs(solution(times) - wave(times)).max() < 1e-8
    assert solution(1.0).shape == (2,)
    assert fallback.integrate(*arguments, [], 1e-9, **blocks)[0].shape == (0, 2)
    with pytest.raises(InputError, match=r"asked for 3\.5 s"):
        solution(3.5)


def test_the_fallback_restarts_at_a_switching_time():
    def rate(t, y, p):
        return [2 * y[0] if t >= 1.0 else -y[0]]

    found, _ = fallback.integrate(rate, [], [1.0], 0.0, [1.0, 3.0], 1e-11, blocks=(0, 1), scales=(0.0,), breaks=[1.0])
    assert found[:, 0] == pytest.approx([math.exp(-1.0), math.exp(3.0)], rel=1e-9)


@pytest.mark.parametrize(
    "rate, options, kind, sentence",
    [
        (lambda t, y, p: [math.nan], {}, PropagationError, "not finite"),
        (lambda t, y, p: [math.nan if t > 0.5 else 1.0], {}, PropagationError, r"beyond t = 0.\d+ s"),
        (lambda t, y, p: [y[0]], {"max_steps": 10}, PropagationError, "10 evaluations were not enough"),
        (lambda t, y, p: [1.0, 2.0], {}, InputError, "returns 1 numbers"),
        (lambda t, y, p: [1.0], {"method": "Euler"}, InputError, "SciPy's methods are"),
        (lambda t, y, p: [1.0], {"max_step": 0.0}, InputError, "longest step"),
    ],
    ids=["nan", "nan later", "long", "shape", "name", "step"],
)
def test_the_fallback_says_what_is_wrong(rate, options, kind, sentence):
    with pytest.raises(kind, match=sentence):
        fallback.integrate(rate, [], [1.0], 0.0, [1.0], 1e-6, blocks=(0, 1), scales=(1.0,), **options)


def pole(t, y, p):
    return [0.1 * math.tan(t)]


@pytest.mark.parametrize("method", list(fallback.METHODS))
def test_a_pole_ends_in_a_sentence_and_keeps_the_samples_before_it(method):
    times = np.linspace(0.0, 4.0, 41)
    with pytest.raises(
        PropagationError, match=r"beyond t = 1\.570\d* s on the way to 4\.0 s: the step shrank"
    ) as caught:
        fallback.integrate(pole, [], [0.3], 0.0, times, 1e-7, method=method, blocks=(0, 1), scales=(0.0,))
    numbers, states = caught.value.samples
    assert numbers.tolist() == list(range(16))
    assert abs(states[:, 0] - 0.3 + 0.1 * np.log(np.cos(times[:16]))).max() < 20 * 1e-7


def test_a_state_that_grows_without_bound_does_not_loosen_the_samples_before():
    times = np.linspace(0.0, 4.0, 41)  # 1/(1 - t/2): the largest size on the way is that of the pole
    with pytest.raises(PropagationError, match=r"on the way to 4\.0 s") as caught:
        fallback.integrate(lambda t, y, p: 0.5 * y * y, [], [1.0], 0.0, times, 1e-7, blocks=(0, 1), scales=(0.0,))
    numbers, states = caught.value.samples
    assert numbers.tolist()[:20] == list(range(20))
    exact = 1.0 / (1.0 - 0.5 * times[:15])
    assert abs(states[:15, 0] / exact - 1.0).max() < 20 * 1e-7
