"""Derivatives of motions under a torque that is given by samples, against integrals of its splines."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import symrot
from symrot.errors import InputError
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")

TIMES = [0.0, 0.5, 1.0, 1.5, 1.5, 2.0, 3.0, 4.0]
MOMENTS = [[0, 0, x] for x in (1, -2, 3, 1, 2, -1, 0, 1)]


def scene(frame="body", **more):
    torque = {"kind": "table", "t": TIMES, "moment": MOMENTS, "switching_times": [1.5], "frame": frame}
    body = {"principal": [2, 3, 4]}
    initial = {"omega": [0, 0, 1]}
    return {"schema": 1, "body": body, "initial": initial, "span": {"t": [0.25, 4]}, "torque": [torque], **more}


def impulse(values, start, stop):
    """The integral of the splines through samples, one before the jump at 1.5 s and one after it."""
    before, after = CubicSpline(TIMES[:4], values[:4]), CubicSpline(TIMES[4:], values[4:])
    parts = before.integrate(min(start, 1.5), min(stop, 1.5)), after.integrate(max(start, 1.5), max(stop, 1.5))
    return float(sum(parts))


@needs_compiler
@pytest.mark.thinned(2)
@pytest.mark.parametrize("frame", ["body", "space"])
def test_derivatives_of_a_wheel_under_a_table_of_samples(frame):
    """About a fixed axis ``C (omega_3 - 1)`` is the integral of the torque, linear in the samples."""
    times = np.array([3.5, 0.1, 1.0, 0.25])
    names = ["torque[0].moment[2]", "torque[0].moment[5][2]", "I_zz", "omega_3"]
    motion = symrot.propagate(scene(frame), t=times, sensitivities=names, events=["omega_3 == 1.1"])
    slopes = motion.sensitivities
    assert slopes.variables[:4] == (*(f"torque[0].moment[2]_{i}" for i in (1, 2, 3)), "torque[0].moment[5][2]")
    assert slopes.units[:4] == ("N m",) * 4
    for name, place in ((names[0], 2), (names[1], 5)):
        unit = [float(k == place) for k in range(8)]
        exact = [impulse(unit, 0.25, t) / 4 for t in times]
        column = slopes[name].omega[:, 2]
        assert np.allclose(column if column.ndim == 1 else column[:, 2], exact, rtol=0, atol=1e-15)
    third = [row[2] for row in MOMENTS]
    assert np.allclose(slopes["I_zz"].omega[:, 2], [-impulse(third, 0.25, t) / 16 for t in times], rtol=0, atol=1e-15)
    assert np.array_equal(slopes["omega_3"].omega[:, 2], np.ones(4))
    # at an event 4 (omega_3 - 1) is the integral up to its time
    t, by = motion.t_events[0][0], slopes.t_events[0][0]
    torque = CubicSpline(TIMES[4:], third[4:])(t) if t > 1.5 else CubicSpline(TIMES[:4], third[:4])(t)
    assert abs(by[5] * torque / 4 + 1) < 1e-9
    there, back = motion.transition(0.1, 3.5), motion.transition(3.5, 0.1)
    assert np.allclose(there @ back, np.eye(6), rtol=0, atol=1e-13)


@needs_compiler
@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", ["torque[0].t[1]", "torque[0].switching_times[0]"])
def test_the_times_of_samples_are_no_variables(name):
    """They are doubles, which hide the small changes by which exact numbers are differentiated."""
    with pytest.raises(InputError, match=r"expected a sample of the table, such as torque\[0\]\.moment\[2\]"):
        symrot.propagate(scene(), t=[1], sensitivities=[name])
    with pytest.raises(InputError, match="got a function passed as torque="):
        symrot.propagate("t_handle", t=[1], torque=lambda t, omega, q: [0, 0, 0], sensitivities=["omega"])
