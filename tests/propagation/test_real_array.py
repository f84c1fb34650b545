"""Arrays that NumPy converts to numbers although they hold none: dates, complex numbers, true and false, objects, text."""

from datetime import datetime
from fractions import Fraction

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.propagation.real_array import real_array

WRONG = {
    "dates": np.array(["2026-01-01T00:00:00", "2026-01-01T00:00:01"], dtype="datetime64[s]"),
    "differences": np.array([0, 1], dtype="timedelta64[s]"),
    "complex": np.array([0, 1 + 1j]),
    "bool": [False, True],
    "objects": [datetime(2026, 1, 1), datetime(2026, 1, 2)],
    "text": ["0.5", "1"],
}


@pytest.mark.parametrize("kind", WRONG)
def test_times_that_are_no_real_numbers_are_refused(kind):
    """A propagator, an ensemble and the function ``sol`` refuse them with one sentence that says what to write instead."""
    with pytest.raises(InputError, match=r"^t: expected an array of times in s, got an array of type \S+; write "):
        symrot.propagator("tumbling_prism")(WRONG[kind])
    with pytest.raises(InputError, match=r"^t: expected times in s, got an array of type \S+; write "):
        symrot.propagate_ensemble("tumbling_prism", omega=[[0, 0.01, 1.0]], t=WRONG[kind])
    with pytest.raises(InputError, match=r"^t: expected times in s, got an array of type \S+; write "):
        symrot.propagate("tumbling_prism", t=[0, 1]).sol(WRONG[kind])


@pytest.mark.parametrize("kind", WRONG)
def test_other_arrays_that_are_no_real_numbers_are_refused(kind):
    three = np.resize(np.asarray(WRONG[kind]), 3)
    with pytest.raises(InputError, match=r"^omega: expected 3 numbers in rad/s, got an array of type"):
        symrot.propagator("tumbling_prism")([0.0, 1.0], omega=three)
    with pytest.raises(InputError, match=r"^omega: expected an array of shape"):
        symrot.propagate_ensemble("tumbling_prism", omega=[three])
    with pytest.raises(InputError, match=r"^torque: expected a function"):
        symrot.propagator("tumbling_prism", torque=(WRONG[kind], np.zeros((2, 3))))
    with pytest.raises(InputError, match=r"^switching_times: expected finite times in s, got an array of type"):
        symrot.propagator("tumbling_prism", torque=lambda t, w, q: (0, 0, 0), switching_times=WRONG[kind])


def test_real_numbers_are_read():
    for given in ([0, 1], [0.0, 1.0], np.array([0, 1], dtype=np.uint8), (0, 1), np.array([0, 1], dtype=np.float32)):
        read = real_array(given, "t", "times in s")
        assert read.dtype == np.float64 and read.tolist() == [0.0, 1.0] and read is not given
    assert real_array(2, "t", "times in s", ndmin=1).tolist() == [2.0]
    assert real_array([Fraction(1, 2)], "omega", "numbers").tolist() == [0.5]
    assert symrot.propagator("tumbling_prism")([]).t.shape == (0,)


@pytest.mark.parametrize("given", [[[1], [1, 2]], [1, None], [10**400, 1]])
def test_what_is_no_array_is_refused(given):
    with pytest.raises(InputError, match=r"^t: expected times in s, got"):
        real_array(given, "t", "times in s")
