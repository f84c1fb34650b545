"""Exact motions of arguments that are no numbers, or exceed the doubles: one sentence, never a NaN."""

import math
from contextlib import contextmanager

import numpy as np
import pytest

from symrot.closed_form.axial import motion as axial
from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.gyrostat import motion as gyrostat
from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.closed_form.spin_up import motion as spin_up
from symrot.errors import InputError

LEVEL = [0.9, 0.1, 0.2, 0.3]
MOTIONS = {
    free_body: {"inertia": [1, 2, 2.5], "omega0": [0.1, 0.2, 0.5], "quaternion0": LEVEL},
    heavy_top: {
        "inertia": [2, 2, 1], "weight": 9.8, "center_of_mass": [0, 0, 0.1], "omega0": [0.1, 0.2, 5],
        "quaternion0": LEVEL, "direction": [0, 0, -1],
    },
    gyrostat: {"inertia": [2, 2, 1], "rotor": [0, 0, 0.7], "omega0": [0.1, 0.2, 0.5], "quaternion0": LEVEL},
    spin_up: {"inertia": [2, 2, 1], "axis": 2, "torque": 0.3, "omega0": [0.1, 0.2, 0.5], "quaternion0": LEVEL},
    axial: {
        "inertia": [2, 2, 1], "axis": 2, "torque": 0.3, "omega0": [0, 0, 0.5], "quaternion0": LEVEL, "damping": 0.1,
        "damping_across": 0.2,
    },
}  # fmt: skip
NUMBERS = [
    math.inf, -math.inf, math.nan, 1e300, -1e300, 1.7e308, 1e160, 1e-160, 1e-320, 5e-324, 0.0, -1.0, 10**400, 1j, "x",
    None, True, [1, 2], np.ones(2),
]  # fmt: skip
TIMES = [0.0, 1.0, -3.0], [1e300, -1e300], [1e-320, 1e15]


def spoilt(given):
    """Yield the arguments of a motion, each time with one argument made unusable."""
    for name, value in given.items():
        if isinstance(value, list):
            shapes = [value[:-1], [*value, 1.0], [value, value], [], None, 3.0, "abc", np.array([value]), {}]
            places = [[*value[:i], bad, *value[i + 1 :]] for i in range(len(value)) for bad in NUMBERS]
            yield from ({**given, name: one} for one in [*places, *([bad] * len(value) for bad in NUMBERS), *shapes])
        else:
            yield from ({**given, name: bad} for bad in [*NUMBERS, [], [1]])


@pytest.mark.parametrize("without_compiler", [False, True])
@pytest.mark.parametrize("form", [free_body, heavy_top, gyrostat], ids=lambda form: form.__name__.rpartition(".")[2])
def test_a_sample_beyond_the_doubles_is_refused_wherever_it_is(form, without_compiler, monkeypatch):
    """Times may be in any order; a NaN between two samples was once returned."""
    if without_compiler:
        monkeypatch.setattr("symrot.closed_form.build._loaded", {})
        monkeypatch.setattr("symrot.build.cache.missing", lambda: "none")
    motion = form.motion(**MOTIONS[form] | {"omega0": [1e3, 2e3, 1e4]})
    with (
        np.errstate(all="ignore"),
        pytest.raises(InputError, match=r"got larger numbers at times -1\.0 to 1\.7e"),
    ):
        motion.evaluate([0.0, 1.7e308, -1.0])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("without_compiler", [False, True])
@pytest.mark.parametrize("form", [free_body, heavy_top, gyrostat], ids=lambda form: form.__name__.rpartition(".")[2])
def test_a_motion_of_too_many_revolutions_is_refused(form, without_compiler, monkeypatch):
    """Rates of 31 digits do not give a phase of 1e25 revolutions; a wrong attitude was once returned."""
    if without_compiler:
        monkeypatch.setattr("symrot.closed_form.build._loaded", {})
        monkeypatch.setattr("symrot.build.cache.missing", lambda: "none")
    motion = form.motion(**MOTIONS[form])
    assert np.isfinite(motion.evaluate([1e15])[1]).all()
    for time in (1e25, -1e40, 1e90):
        with pytest.raises(InputError, match="within 7e16 revolutions"):
            motion.evaluate([0.0, time])


@contextmanager
def refused_in_a_sentence():
    """Accept an InputError in the block if its message is one sentence of moderate length."""
    try:
        yield
    except InputError as error:
        assert len(str(error)) < 400 and "\n" not in str(error)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("form", MOTIONS, ids=lambda form: form.__name__.rpartition(".")[2])
def test_a_motion_is_one_or_is_refused_in_a_sentence(form):
    for given in spoilt(MOTIONS[form]):
        with refused_in_a_sentence():
            motion = form.motion(**given)
            for times in TIMES:
                with refused_in_a_sentence():
                    rates, attitudes = motion.evaluate(times, quaternion=getattr(motion, "has_attitude", True))
                    assert np.isfinite(rates).all(), (given, times)
                    assert attitudes is None or abs(np.linalg.norm(attitudes, axis=1) - 1).max() < 1e-14, (given, times)


@pytest.mark.parametrize("form", MOTIONS, ids=lambda form: form.__name__.rpartition(".")[2])
def test_times_that_are_none_are_refused(form):
    motion = form.motion(**MOTIONS[form])
    for times in ([math.nan], [math.inf], "x", None, [1j], [10**400], [[1, 2]], np.ones((2, 2))):
        with pytest.raises(InputError, match="times"):
            motion.evaluate(times)
    rates, attitudes = motion.evaluate([])
    assert rates.shape == (0, 3) and attitudes.shape == (0, 4)


def test_the_sentences_say_what_arrived():
    with pytest.raises(InputError, match=r"omega: expected finite numbers of a magnitude up to 1e\+205, got 1e\+?300"):
        free_body.motion([1, 2, 3], [0, 1e300, 0])
    with pytest.raises(InputError, match=r"inertia: expected positive numbers, each 1e-205 or more, got 1e-320"):
        spin_up.motion([1e-320, 1, 2], 2, 1.0, [0, 1, 0])
    with pytest.raises(InputError, match=r"got larger numbers at times 1e\+300 to 1e\+300 s"):
        free_body.motion([1, 2, 3], [0, 1e150, 1e10]).evaluate([1e300])
