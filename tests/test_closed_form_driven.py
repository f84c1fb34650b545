"""Gyrostats and driven rotations against higher precision and their own limits."""

import numpy as np
import pytest
from mpmath import mp, mpf, odefun

from symrot.closed_form import axial, free_body, gyrostat, library
from symrot.codegen.library import build
from symrot.errors import CompilerError, InputError

Q0 = (0.1, 0.7, -0.5, 0.5)
BAR = 1e-15


def flow(moments, omega, t, torque=(0, 0, 0), rotor=(0, 0, 0), damping=(0, 0, 0)):
    """Return omega and q at t to 18 digits, by mpmath's Taylor integrator on Euler's equations."""
    with mp.workdps(19):
        norm = mp.sqrt(sum(mpf(x) ** 2 for x in Q0))

        def rates(_, y):
            w, (a, b, c, d) = y[:3], y[3:]
            m = [mpf(moments[i]) * w[i] + mpf(rotor[i]) for i in range(3)]
            gyro = [w[(i + 1) % 3] * m[(i + 2) % 3] - w[(i + 2) % 3] * m[(i + 1) % 3] for i in range(3)]
            turn = [-b * w[0] - c * w[1] - d * w[2], a * w[0] + c * w[2] - d * w[1],
                    a * w[1] + d * w[0] - b * w[2], a * w[2] + b * w[1] - c * w[0]]  # fmt: skip
            return [(mpf(torque[i]) - mpf(damping[i]) * w[i] - gyro[i]) / mpf(moments[i]) for i in range(3)] + [
                x / 2 for x in turn
            ]

        y = odefun(rates, 0, [*(mpf(x) for x in omega), *(mpf(x) / norm for x in Q0)])(mpf(t))
        return np.array([float(x) for x in y[:3]]), np.array([float(x) for x in y[3:]])


@pytest.mark.parametrize(
    "moments, rotor, omega",
    [((1, 1, 2), (0, 0, 3), (0.3, 1, 0.5)), ((2, 1, 1), (-1, 0, 0), (0.3, 1, 0.5)), ((1, 3, 1), (0, 0.7, 0), (0.3, 0, 1)),
     ((2, 2, 2), (0, 0, 1), (0.3, 1, 0.5)), ((1, 1, 2), (0, 0, 1), (0, 0, 0))],
)  # fmt: skip
def test_gyrostats(moments, rotor, omega):
    w, q = flow(moments, omega, 2.75, rotor=rotor)
    rates, attitudes = gyrostat.motion(moments, rotor, omega, Q0).evaluate([2.75, 0.0])
    assert np.abs(rates[0] - w).max() <= BAR and np.abs(attitudes[0] - q).max() <= BAR
    assert (rates[1] == omega).all()


def test_a_gyrostat_without_rotor_is_a_free_body():
    times = [-7.0, 1e3, 1e9, 1e15]
    rates, attitudes = gyrostat.motion((1, 1, 2), (0, 0, 0), (0.3, 1.0, 0.5), Q0).evaluate(times)
    free = free_body.motion((1, 1, 2), (0.3, 1.0, 0.5), Q0).evaluate(times)
    assert np.abs(rates - free[0]).max() < 2 * BAR and np.abs(np.abs((attitudes * free[1]).sum(axis=1)) - 1).max() < BAR


@pytest.mark.parametrize("damping", [0, 0.125, 3])
@pytest.mark.parametrize("torque", [0, 0.25, -2])
def test_driven_and_damped_about_an_axis(torque, damping):
    t = 2.25
    w, q = flow((1, 3, 2), (0, 0.75, 0), t, torque=(0, torque, 0), damping=(0, damping, 0))
    rates, attitudes = axial.motion((1, 3, 2), 1, torque, (0, 0.75, 0), Q0, damping).evaluate([t])
    assert np.abs(rates[0] - w).max() <= BAR and np.abs(attitudes[0] - q).max() <= BAR


def test_a_symmetric_body_driven_about_its_axis():
    w, _ = flow((1, 1, 3), (0.3, 1, 0.5), 2.5, torque=(0, 0, 0.25))
    driven = axial.motion((1, 1, 3), 2, 0.25, (0.3, 1, 0.5), Q0)
    assert np.abs(driven.evaluate([2.5], quaternion=False)[0][0] - w).max() <= 2 * BAR
    assert not driven.has_attitude
    with pytest.raises(InputError, match="closed form"):
        driven.evaluate([2.5])


def test_a_symmetric_body_driven_about_its_axis_and_damped_about_all():
    w, _ = flow((1, 1, 3), (0.3, 1, 0.5), 2.5, torque=(0, 0, 0.25), damping=(0.125, 0.125, 0.5))
    driven = axial.motion((1, 1, 3), 2, 0.25, (0.3, 1, 0.5), Q0, 0.5, 0.125)
    assert np.abs(driven.evaluate([2.5], quaternion=False)[0][0] - w).max() <= 2 * BAR


@pytest.mark.parametrize("omega, damping", [((0, 0.75, 0), 0), ((0, 0.75, 0), 0.125), ((0, 0, 0), 3)])
def test_driven_rotations_at_any_times(omega, damping):
    """One, many, unsorted, repeated, before the start: each sample is its own, and the first is the start."""
    motion = axial.motion((1, 3, 2), 1, 0.25, omega, Q0, damping)
    times = np.array([3.0, -2.0, 0.0, 1e15 if damping else 1e7, 3.0, 1e-9])
    rates, attitudes = motion.evaluate(times)
    for k, t in enumerate(times):
        one = motion.evaluate(t)
        assert np.array_equal(one[0][0], rates[k]) and np.array_equal(one[1][0], attitudes[k])
    assert rates[2].tolist() == list(omega)
    assert np.abs(attitudes[2] - np.array(Q0) / np.linalg.norm(Q0)).max() < 2e-16
    if damping:
        assert rates[3, 1] == 0.25 / damping
    assert np.abs(np.linalg.norm(attitudes, axis=1) - 1).max() < 5e-16


@pytest.mark.parametrize("damping, times", [(0, (1e6, 1e9)), (0.125, (-4.0, 1e3, 1e12))])
def test_phases_over_many_turns(damping, times):
    """Up to 1e17 turns, against the angle to 60 digits."""
    rate, push, own = 0.75, 0.25, 3.0
    attitudes = axial.motion((1, 2, own), 2, push, (0, 0, rate), damping=damping).evaluate(times)[1]
    with mp.workdps(60):
        for t, q in zip(times, attitudes, strict=True):
            t, k = mpf(t), mpf(damping) / mpf(own)
            if damping:
                final = mpf(push) / mpf(damping)
                angle = final * t + (rate - final) * (1 - mp.exp(-k * t)) / k
            else:
                angle = rate * t + mpf(push) / own * t * t / 2
            assert abs(q[0] - mp.cos(angle / 2)) < BAR and abs(q[3] - mp.sin(angle / 2)) < BAR


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="rotor lies along"):
        gyrostat.motion((1, 1, 2), (1, 0, 0), (0, 0, 1))
    with pytest.raises(InputError, match="symmetric about it"):
        axial.motion((1, 2, 3), 2, 1, (1, 0, 1))
    with pytest.raises(InputError, match="axis 0, 1 or 2"):
        axial.motion((1, 2, 3), 3, 1, (0, 0, 1))


def test_fast_math_is_refused():
    """Error-free arithmetic would silently be lost."""
    with pytest.raises(CompilerError, match="ffast-math"):
        build(library.source("free_body"), "closed_form_fast", (*library.FLAGS, "-ffast-math"))
