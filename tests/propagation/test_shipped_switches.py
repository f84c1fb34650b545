"""The shipped scenes with switches: two agree with closed forms, the third with a law written by hand."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import symrot
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
METHODS = ["taylor", "dop853"]


def momentum(t):
    """Return the wheel's angular velocity and angle: k = 1/4 N m, C = 1/20 kg m^2, 30 rad/s, a motor of (t - 8)/20 N m."""
    slowing, loose = np.minimum(t, 6.0), np.maximum(t - 13.0, 0.0)
    omega = 30.0 - 5.0 * slowing + loose**2 / 2.0
    return omega, 30.0 * slowing - 5.0 * slowing**2 / 2.0 + loose**3 / 6.0


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_the_wheel_stops_rests_and_breaks_loose_as_the_closed_form_does(method):
    motion = symrot.propagate("friction_wheel", method=method)
    omega, angle = momentum(motion.t)
    assert motion.omega[:, 2] == pytest.approx(omega, abs=20 * 30e-12)
    assert not motion.omega[(motion.t > 6.0) & (motion.t <= 13.0), 2].any()  # held at rest, exactly
    turned = np.stack([np.cos(angle / 2), 0 * angle, 0 * angle, np.sin(angle / 2)], axis=1)
    off = np.minimum(*(np.abs(motion.quaternion - sign * turned).max(axis=1) for sign in (1, -1)))
    assert off.max() < 20e-12
    held = [(round(each.t, 9), each.how) for each in motion.stats.switchings if each.function == "sign(omega_3)"]
    assert held == [(6.0, "held"), (13.0, "released")]


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_each_pulse_of_the_thruster_spins_the_satellite_up(method):
    """Each pulse adds m 0.01/C about axis 3; the other rates turn by (C - A)/A times the angle about axis 3."""
    motion = symrot.propagate("thruster_train", method=method)
    t, pulses, into = motion.t, np.floor(motion.t), motion.t - np.floor(motion.t)
    into, rate = np.where(np.isclose(into, 1.0, atol=1e-9), 1.0, into), 4.0 / 8.0
    spin = 0.05 + rate * (0.01 * pulses + np.minimum(into, 0.01))
    before = 0.05 * t + rate * 0.01 * (pulses * (pulses - 1) / 2 + pulses * (1 - 0.01 / 2) + pulses * into)
    angle = before + rate * np.where(into < 0.01, into**2 / 2, 0.01 * (into - 0.01 / 2))
    assert motion.omega[:, 2] == pytest.approx(spin, abs=20e-12)
    across = 0.02 * np.exp(1j * (8 - 12) / 12 * angle)
    assert np.abs(motion.omega[:, 0] + 1j * motion.omega[:, 1] - across).max() < 20e-12
    assert len(motion.stats.switching_times) == 120


def law(t, y, failed):
    """Return the rates of the state: Euler's equations, quaternion rates and the quadcopter's PD law, written by hand."""
    omega, q = y[:3], y[3:]
    low = np.array([0.6, 0.6, 0.05])
    torque = np.clip(-3.0 * q[1:] * np.sign(q[0]) - 0.1 * omega, -low, low) + failed * np.array([0.7, -0.7, 0.0])
    moments = np.array([0.015, 0.015, 0.025])
    rate = (torque - np.cross(omega, moments * omega)) / moments
    w, x = q[0], q[1:]
    return np.concatenate([rate, [-0.5 * x @ omega], 0.5 * (w * omega + np.cross(x, omega))])


@needs_compiler
def test_the_quadcopter_follows_the_law_written_by_hand():
    """The reference restarts at each switching time; a time off by 1e-9 s would leave a jump inside a step."""
    motion = symrot.propagate("quadcopter_motor_failure")
    ends = [0.0, *motion.stats.switching_times, 2.0]
    assert 0.5 in ends and len(ends) > 20
    y = np.array([0, 0, 0, math.cos(math.radians(10)), math.sin(math.radians(10)), 0, 0])
    for start, stop in pairwise(ends):
        y = solve_ivp(law, (start, stop), y, "DOP853", rtol=1e-13, atol=1e-14, args=(start >= 0.5,)).y[:, -1]
    assert motion.omega[-1] == pytest.approx(y[:3], rel=1e-8)
    assert motion.quaternion[-1] == pytest.approx(y[3:], abs=1e-8)
    assert np.abs(motion.euler("ZYX")[motion.t <= 0.5]).max() < math.radians(20.001)  # until then it is righted
    before, after = (symrot.propagate("quadcopter_motor_failure", method=method).omega[-1] for method in METHODS)
    assert before == pytest.approx(after, rel=1e-8)
