"""The stepper keeps its promise: order, accuracy, sampling, direction, limits; in C and through SciPy alike.

Kernels are written by hand here, references are closed forms and a Taylor series in 50 digits that shares nothing with
the code under test.
"""

import math
import re
import shutil
import signal
import subprocess
from functools import cache
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from symrot.codegen import library
from symrot.errors import CompilerError, InputError, PropagationError
from symrot.propagation import dop853, fallback

RIGID_BODY = """
/* p = A, B, C, weight times centre of mass (3, body axes); gravity along -z of space */
static inline void rigid_body(double t, const double y[7], const double p[6], double dy[7])
{
    const double w1 = y[0], w2 = y[1], w3 = y[2], q0 = y[3], q1 = y[4], q2 = y[5], q3 = y[6];
    const double n = q0*q0 + q1*q1 + q2*q2 + q3*q3;
    const double g1 = -2*(q1*q3 - q0*q2)/n, g2 = -2*(q2*q3 + q0*q1)/n, g3 = -(q0*q0 - q1*q1 - q2*q2 + q3*q3)/n;
    (void)t;
    dy[0] = ((p[1] - p[2])*w2*w3 + p[4]*g3 - p[5]*g2)/p[0];
    dy[1] = ((p[2] - p[0])*w3*w1 + p[5]*g1 - p[3]*g3)/p[1];
    dy[2] = ((p[0] - p[1])*w1*w2 + p[3]*g2 - p[4]*g1)/p[2];
    dy[3] = 0.5*(-q1*w1 - q2*w2 - q3*w3);
    dy[4] = 0.5*(q0*w1 + q2*w3 - q3*w2);
    dy[5] = 0.5*(q0*w2 + q3*w1 - q1*w3);
    dy[6] = 0.5*(q0*w3 + q1*w2 - q2*w1);
}
"""


def rigid_body(t, y, p):
    a, b, c, m1, m2, m3 = p
    w1, w2, w3, q0, q1, q2, q3 = y
    n = q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3
    g1, g2 = -2 * (q1 * q3 - q0 * q2) / n, -2 * (q2 * q3 + q0 * q1) / n
    g3 = -(q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3) / n
    return [
        ((b - c) * w2 * w3 + m2 * g3 - m3 * g2) / a,
        ((c - a) * w3 * w1 + m3 * g1 - m1 * g3) / b,
        ((a - b) * w1 * w2 + m1 * g2 - m2 * g1) / c,
        0.5 * (-q1 * w1 - q2 * w2 - q3 * w3),
        0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
        0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
        0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
    ]


@pytest.fixture(scope="module", autouse=True)
def own_cache(tmp_path_factory):
    """Build into a directory of this test run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SYMROT_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@cache
def built(kernel, name, states, parameters, blocks, scales):
    return library.build(dop853.translation_unit(kernel, name, states, parameters, blocks, scales), name)


def body():
    return built(RIGID_BODY, "rigid_body", 7, 6, (0, 3, 7), (0.0, 1.0))


def small(text, states, parameters=1, scale=1.0):
    """Return a library for a kernel of a few states in one block, given as its C statements."""
    signature = "static inline void rate(double t, const double *y, const double *p, double *dy)"
    kernel = f"#include <math.h>\n{signature} {{ (void)t; (void)y; (void)p; {text} }}\n"
    return built(kernel, "rate", states, parameters, (0, states), (scale,))


def state(omega, angle=0.0):
    """Return omega and the attitude turned by an angle about x."""
    return np.array([*omega, math.cos(angle / 2), math.sin(angle / 2), 0.0, 0.0])


MOTIONS = {  # moments, weight times centre of mass, initial state
    "flips about the middle axis": ((5 / 12, 20 / 12, 17 / 12), (0, 0, 0), state((0, 0.01, 1))),
    "asymmetric": ((1.0, 2.0, 3.0), (0, 0, 0), state((0.3, 1, 0.5))),
    "top with cusps": ((1.0, 1.0, 0.5), (0, 0, 1.0), state((0, 0, 5), 0.5)),
    "top with loops": ((1.0, 1.0, 0.5), (0, 0, 1.0), state((0.3, -1.8, 4), 0.5)),
    "asymmetric top": ((1.0, 1.5, 0.7), (0.1, 0.2, 0.9), state((0.5, 0.3, 4))),
}
STOP = 20.0
TIMES = np.linspace(0.0, STOP, 9)


def times(u, v):
    """Return the newest coefficient of the product of two series."""
    return mpmath.fdot(u, v[::-1])


def cross(u, v):
    return [times(u[(i + 1) % 3], v[(i + 2) % 3]) - times(u[(i + 2) % 3], v[(i + 1) % 3]) for i in range(3)]


@cache
def taylor(name):
    """Return the states at TIMES, from Taylor series in 50 digits; gravity is carried as a vector of the body."""
    moments, arm, start = MOTIONS[name]
    with mpmath.workdps(50):
        a, b, c = map(mpmath.mpf, moments)
        m = [mpmath.mpf(x) for x in arm]
        y = [mpmath.mpf(float(x)) for x in start]
        now, order, rows = mpmath.mpf(0), 40, []
        for time in TIMES:
            while True:
                w, q = [[x] for x in y[:3]], [[x] for x in y[3:]]
                q0, q1, q2, q3 = y[3:]
                norm = mpmath.fsum(x * x for x in y[3:])
                g = [[-2 * (q1 * q3 - q0 * q2) / norm], [-2 * (q2 * q3 + q0 * q1) / norm]]
                g.append([-(q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3) / norm])
                for n in range(order):
                    h = [x[n] for x in g]
                    dw = [
                        ((b - c) * times(w[1], w[2]) + m[1] * h[2] - m[2] * h[1]) / a,
                        ((c - a) * times(w[2], w[0]) + m[2] * h[0] - m[0] * h[2]) / b,
                        ((a - b) * times(w[0], w[1]) + m[0] * h[1] - m[1] * h[0]) / c,
                    ]
                    turn = cross(q[1:], w)
                    dq = [-mpmath.fsum(times(q[i + 1], w[i]) for i in range(3)) / 2]
                    dq += [(times(q[0], w[i]) + turn[i]) / 2 for i in range(3)]
                    for series, rates in ((w, dw), (g, cross(g, w)), (q, dq)):
                        for one, rate in zip(series, rates, strict=True):
                            one.append(rate / (n + 1))
                series = [one[::-1] for one in (*w, *q)]
                last = max(abs(one[0]) + abs(one[1]) for one in series)
                step = (mpmath.mpf(10) ** -35 / last) ** (mpmath.mpf(1) / order)
                left = mpmath.mpf(float(time)) - now
                if left <= step:
                    break
                now += step
                y = [mpmath.polyval(one, step) for one in series]
            rows.append([float(mpmath.polyval(one, left)) for one in series])
    return np.array(rows)


def error(states, reference):
    """Return the error that the tolerance speaks of: omega against its largest size, the quaternion as it is."""
    omega, size = abs(states[:, :3] - reference[:, :3]).max(), np.linalg.norm(reference[:, :3], axis=1).max()
    return max(omega / size, abs(states[:, 3:] - reference[:, 3:]).max())


def parameters(name):
    return (*MOTIONS[name][0], *MOTIONS[name][1])


# ------------------------------------------------------------------------------------------------ accuracy


@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_error_of_the_trajectory_stays_near_the_tolerance(name, tolerance):
    """Calibrated to 5 times the tolerance; 8 leaves room for another processor's rounding of its steps."""
    states, _ = dop853.integrate(body(), parameters(name), MOTIONS[name][2], 0.0, TIMES, tolerance)
    assert error(states, taylor(name)) < 8 * tolerance


@pytest.mark.parametrize("tolerance", [1e-3, 1e-7, 1e-11])
def test_a_symmetric_body_follows_its_closed_form(tolerance):
    """omega turns about the axis at (C - A)/A w3; the attitude is a turn about L, then one about the axis."""
    a, c, w1, w3 = 0.6375, 0.075, 1.0, 1.0
    t = np.linspace(0.0, 20.0, 101)
    states, _ = dop853.integrate(body(), (a, a, c, 0, 0, 0), state((w1, 0, w3)), 0.0, t, tolerance)
    rate = (c - a) / a * w3
    size = math.hypot(a * w1, c * w3)
    about_l = np.array([np.cos(size / a * t / 2), *(np.sin(size / a * t / 2) * x / size for x in (a * w1, 0, c * w3))])
    about_axis = np.array([np.cos(rate * t / 2), 0 * t, 0 * t, -np.sin(rate * t / 2)])
    (p0, p1, p2, p3), (r0, _, _, r3) = about_l, about_axis
    q = np.array([p0 * r0 - p3 * r3, p1 * r0 + p2 * r3, p2 * r0 - p1 * r3, p3 * r0 + p0 * r3])
    exact = np.array([w1 * np.cos(rate * t), w1 * np.sin(rate * t), w3 + 0 * t, *q]).T
    assert error(states, exact) < 5 * tolerance


@pytest.mark.parametrize("speed", [1.0, 1e3, 1e6])
def test_a_fast_spin_does_not_hide_the_error_of_the_attitude(speed):
    """S17: judged in one norm with omega, the attitude would be off by speed times the tolerance."""
    moments, start = (1.0, 1.5, 2.0, 0, 0, 0), state((1e-3, 1e-3, speed))
    times = np.linspace(0.0, 1000.0 / speed, 21)
    states, _ = dop853.integrate(body(), moments, start, 0.0, times, 1e-9)
    exact, _ = dop853.integrate(body(), moments, start, 0.0, times, 1e-13)
    assert error(states, exact) < 5e-9
    assert abs(np.linalg.norm(states[:, 3:], axis=1) - 1).max() < 1e-8


def test_the_unit_of_time_does_not_matter():
    """The same motion a thousand times slower takes the same steps: no number of seconds is built in."""
    costs, attitudes = set(), []
    for speed in (1e-5, 1.0, 1e5):
        start = state((0.3 * speed, 1.0 * speed, 0.5 * speed))
        states, stats = dop853.integrate(body(), (1, 2, 3, 0, 0, 0), start, 0.0, [20.0 / speed], 1e-9)
        costs.add(stats.accepted)
        attitudes.append(states[0, 3:])
    assert max(costs) - min(costs) <= 1
    assert np.ptp(attitudes, axis=0).max() < 1e-12


def test_a_pendulum_swings_through_rest():
    """omega vanishes at every turn; judged against its own size alone, the steps would shrink to nothing there."""
    moments, arm = (1.0, 1.0, 0.1), (0, 0, -5.0)
    states, stats = dop853.integrate(body(), (*moments, *arm), state((0, 0, 0), 1.0), 0.0, [40.0], 1e-9)
    w, q = states[0, :3], states[0, 3:]
    energy = 0.5 * w[0] ** 2 - 5.0 * (1 - 2 * (q[1] ** 2 + q[2] ** 2) / (q @ q))
    assert abs(energy + 5.0 * math.cos(1.0)) < 1e-7
    assert stats.accepted < 1000


def test_a_body_at_rest_stays_at_rest_in_a_few_steps():
    states, stats = dop853.integrate(body(), (1, 2, 3, 0, 0, 0), state((0, 0, 0)), 0.0, [1.0, 1e6], 1e-12)
    assert np.array_equal(states, [state((0, 0, 0))] * 2)
    assert stats.accepted < 20


@pytest.mark.parametrize("stop", [3.0, -3.0])
def test_the_order_of_the_step_is_8(stop):
    """S25: halving a fixed step divides the error by 2^8."""
    name = "asymmetric top"
    start, errors = MOTIONS[name][2], []
    exact, _ = dop853.integrate(body(), parameters(name), start, 0.0, [stop], 1e-13)
    for count in (10, 20, 40):
        found, stats = dop853.integrate(body(), parameters(name), start, 0.0, [stop], 0.99, max_step=abs(stop) / count)
        assert stats.rejected == 0
        assert count <= stats.accepted <= count + 2
        errors.append(abs(found - exact).max())
    for coarse, fine in pairwise(errors):
        assert 7.5 < math.log2(coarse / fine) < 8.7


def test_the_dense_output_is_as_good_as_the_steps():
    """S39: between the steps the error is at most twice that at their ends; its own order is 7, as the theory has it."""
    name = "asymmetric top"
    start = MOTIONS[name][2]
    for tolerance in (1e-5, 1e-9):
        solution = dop853.record(body(), parameters(name), start, 0.0, (0.0, 20.0), tolerance)
        times = np.linspace(0.0, 20.0, 5001)
        exact, _ = dop853.integrate(body(), parameters(name), start, 0.0, times, 1e-13)
        assert error(solution(times), exact) < 5 * tolerance
    middles = []
    for count in (5, 10, 20):
        h = 2.0 / count
        times = np.linspace(0.0, 2.0, 16 * count + 1)
        exact, _ = dop853.integrate(body(), parameters(name), start, 0.0, times, 1e-13)
        found, _ = dop853.integrate(body(), parameters(name), start, 0.0, times, 0.99, max_step=h)
        middles.append(abs(found - exact).max())
    for coarse, fine in pairwise(middles):
        assert math.log2(coarse / fine) > 7.0


def test_rounding_does_not_pile_up():
    """S28: a million additions of an increment that is no binary fraction end where one would; -ffast-math would not."""
    path = small("dy[0] = p[0];", 1)
    states, stats = dop853.integrate(path, [0.1], [0.0], 0.0, [1000.0], 1e-6, max_step=1e-3)
    assert stats.accepted >= 1_000_000
    assert abs(states[0, 0] - 100.0) < 3e-14
    assert not any("fast-math" in flag or "unsafe" in flag for flag in library.FLAGS)


# ------------------------------------------------------------------------------------------------ sampling and direction


OSCILLATOR = "dy[0] = y[1]; dy[1] = -y[0];"


def wave(times):
    return np.array([np.cos(times), -np.sin(times)]).T


@pytest.mark.parametrize("t0", [0.0, 2.5, -7.0])
def test_samples_lie_anywhere_in_any_order(t0):
    path = small(OSCILLATOR, 2)
    times = np.array([3.0, -2.0, t0, 3.0, 0.1, 11.0, t0, -9.5, 1e-9])
    states, _ = dop853.integrate(path, [0.0], wave(np.array([t0]))[0], t0, times, 1e-11)
    assert states.shape == (9, 2)
    assert states.flags["C_CONTIGUOUS"]
    assert abs(states - wave(times)).max() < 1e-10
    assert np.array_equal(states[2], wave(np.array([t0]))[0])
    assert np.array_equal(states[2], states[6])
    assert np.array_equal(states[0], states[3])


def test_the_steps_do_not_depend_on_the_samples():
    path = small(OSCILLATOR, 2)
    few, one = dop853.integrate(path, [0.0], [1.0, 0.0], 0.0, [50.0], 1e-9)
    many, other = dop853.integrate(path, [0.0], [1.0, 0.0], 0.0, np.linspace(0.0, 50.0, 3001), 1e-9)
    assert (one.accepted, one.rejected) == (other.accepted, other.rejected)
    assert np.array_equal(few[-1], many[-1])
    assert other.evaluations == one.evaluations + 3 * one.accepted


def test_no_samples_and_a_span_of_no_length():
    path = small(OSCILLATOR, 2)
    states, stats = dop853.integrate(path, [0.0], [1.0, 0.0], 0.0, [], 1e-9)
    assert states.shape == (0, 2)
    assert stats.evaluations == 0
    states, stats = dop853.integrate(path, [0.0], [1.0, 0.0], 4.0, [4.0, 4.0], 1e-9)
    assert np.array_equal(states, [[1.0, 0.0]] * 2)
    assert stats.accepted == 0
    states, _ = dop853.integrate(path, [0.0], [1.0, 0.0], 1.0, [math.nextafter(1.0, 2.0)], 1e-9)
    assert np.allclose(states, [[1.0, 0.0]], atol=1e-15)


def test_backward_returns_to_the_start():
    name = "asymmetric"
    there, _ = dop853.integrate(body(), parameters(name), MOTIONS[name][2], 0.0, [20.0], 1e-11)
    back, _ = dop853.integrate(body(), parameters(name), there[0], 20.0, [0.0], 1e-11)
    assert abs(back[0] - MOTIONS[name][2]).max() < 1e-10


def test_pauses_change_nothing(monkeypatch):
    """A call to C returns after so many steps; the motion goes on from there bit for bit."""
    arguments = (body(), parameters("asymmetric"), MOTIONS["asymmetric"][2], 0.0, np.linspace(0.0, 30.0, 77), 1e-9)
    whole, stats = dop853.integrate(*arguments)
    monkeypatch.setattr(dop853._Stepper, "steps_per_call", 3)
    parts, others = dop853.integrate(*arguments)
    assert np.array_equal(whole, parts)
    assert stats[:3] == others[:3]


def test_a_recording_is_the_motion_itself(monkeypatch):
    name, times = "asymmetric top", np.linspace(-5.0, 12.0, 301)
    arguments = (body(), parameters(name), MOTIONS[name][2], 0.0)
    solution = dop853.record(*arguments, (-5.0, 12.0), 1e-9)
    sampled, _ = dop853.integrate(*arguments, times, 1e-9)
    assert abs(solution(times) - sampled).max() < 1e-14
    assert np.array_equal(solution(0.0), MOTIONS[name][2])
    assert solution(3.0).shape == (7,)
    assert solution(times[::-1].reshape(7, 43)).shape == (7, 43, 7)
    assert np.array_equal(solution(times[::-1])[::-1], solution(times))
    monkeypatch.setattr(dop853._Stepper, "rows_per_call", 2)
    assert np.array_equal(dop853.record(*arguments, (-5.0, 12.0), 1e-9)(times), solution(times))
    with pytest.raises(InputError, match=r"known from -5.0 to 12.0 s, asked for 12.5 s"):
        solution([1.0, 12.5])


@pytest.mark.parametrize("stop", [3.0, -3.0])
def test_a_switching_time_costs_no_order(stop):
    """S42: the rate jumps inside a step; restarted there, the exact solution of both sides is met."""
    side = math.copysign(1.0, stop)
    path = small("dy[0] = t*p[0] >= 1.0 ? 2.0*y[0] : -y[0];", 1)
    exact = math.exp(-1.0 + 2.0 * 2.0) if side > 0 else math.exp(1.0 - 2.0 * 2.0)
    before = math.exp(-side * 0.5)
    times = [0.0, 0.5 * side, 1.0 * side, stop]
    rate = [side]
    y = 1.0
    states, _ = dop853.integrate(path, rate, [y], 0.0, times, 1e-12, breaks=[1.0 * side, 77.0])
    assert states[:, 0] == pytest.approx([1.0, before, math.exp(-side), exact], rel=2e-12)
    solution = dop853.record(path, rate, [y], 0.0, (0.0, stop), 1e-12, breaks=[1.0 * side])
    assert solution(stop)[0] == pytest.approx(exact, rel=2e-12)
    _, blind = dop853.integrate(path, rate, [y], 0.0, times, 1e-10)
    _, restarted = dop853.integrate(path, rate, [y], 0.0, times, 1e-10, breaks=[1.0 * side])
    assert 2 * restarted.evaluations < blind.evaluations


# ------------------------------------------------------------------------------------------------ limits


@pytest.mark.parametrize(
    "text, start, stop, reason",
    [
        ("dy[0] = sqrt(1.0 - t);", 0.0, 2.0, r"not finite"),
        ("dy[0] = 0.0/(y[0] - y[0]);", 1.0, 2.0, r"beyond t = 0.0 s on the way to 2.0 s: .* not finite"),
        ("dy[0] = y[0]*y[0];", 1.0, 2.0, r"beyond t = (0.99|1.0)"),
        ("dy[0] = y[0] > 0.5 ? -1.0 : 1.0;", 1.0, 2.0, r"beyond t = 0.[45].*(step shrank|not enough)"),
    ],
    ids=["leaves the domain", "nothing from the start", "pole", "sliding on a jump"],
)
def test_a_motion_that_ends_says_where_and_why(text, start, stop, reason):
    with pytest.raises(PropagationError, match=reason) as caught:
        dop853.integrate(small(text, 1), [0.0], [start], 0.0, [stop], 1e-9, max_steps=100_000)
    assert str(caught.value).count("\n") == 0


def test_too_many_steps_are_refused():
    with pytest.raises(PropagationError, match=r"beyond t = .* on the way to 1000.0 s: 50 steps were not enough"):
        dop853.integrate(small(OSCILLATOR, 2), [0.0], [1.0, 0.0], 0.0, [1000.0], 1e-9, max_steps=50)


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no interval timer")
def test_an_interrupt_is_heard():
    """Ctrl-C: control comes back to Python every few milliseconds."""

    def interrupt(number, frame):
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(KeyboardInterrupt):
            dop853.integrate(small(OSCILLATOR, 2), [0.0], [1.0, 0.0], 0.0, [1e12], 1e-9)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)


GOOD = {"p": [0.0], "y0": [1.0, 0.0], "t0": 0.0, "times": [1.0], "tolerance": 1e-6}


@pytest.mark.parametrize(
    "change, sentence",
    [
        ({"p": []}, r"takes 1 parameters, got .* shape \(0,\)"),
        ({"y0": [1.0]}, r"takes 2 states"),
        ({"y0": [1.0, math.nan]}, r"states must be finite"),
        ({"p": [math.inf]}, r"parameters must be finite"),
        ({"t0": math.inf}, r"initial time"),
        ({"times": [math.nan]}, r"sample times must be finite"),
        ({"times": [1.0, math.inf]}, r"sample times must be finite"),
        ({"times": [0.0, math.nan, 1.0]}, r"sample times must be finite"),
        ({"times": [[1.0]]}, r"shape \(1, 1\)"),
        ({"times": 1.0}, r"shape"),
        ({"tolerance": 0.0}, r"between 0 and 1, got 0.0"),
        ({"tolerance": math.nan}, r"between 0 and 1"),
        ({"max_step": 0.0}, r"longest step"),
        ({"max_step": math.nan}, r"longest step"),
    ],
)
def test_input_that_cannot_be_used_is_named(change, sentence):
    arguments = {"library": small(OSCILLATOR, 2), **GOOD}
    dop853.integrate(**arguments)
    with pytest.raises(InputError, match=sentence):
        dop853.integrate(**{**arguments, **change})


@pytest.mark.parametrize(
    "blocks, scales", [((0, 3), (0.0,)), ((0, 3, 3, 7), (0, 0, 0)), ((0, 7), (0.0, 1.0)), ((), ())]
)
def test_blocks_cover_the_states_once(blocks, scales):
    with pytest.raises(InputError, match="blocks of 7 states"):
        dop853.translation_unit(RIGID_BODY, "rigid_body", 7, 6, blocks, scales)


def test_a_file_that_is_no_stepper_is_refused(tmp_path):
    (tmp_path / "text.so").write_text("hello")
    for path in (tmp_path / "text.so", tmp_path / "none.so", library.build("int nothing;", "nothing")):
        with pytest.raises(CompilerError, match="cannot be loaded"):
            dop853.integrate(path, **GOOD)


@pytest.mark.parametrize("states", [1, 2, 3, 4, 5, 8, 11, 13])
def test_any_number_of_states_can_be_stepped(states):
    """Decays at rates 1..N, each state in a block of its own; widths below, at and above the unrolled ones."""
    kernel = f"""static inline void decay(double t, const double *y, const double *p, double *dy)
    {{ (void)t; for (int i = 0; i < {states}; ++i) dy[i] = -p[0]*(i + 1)*y[i]; }}\n"""
    path = built(kernel, "decay", states, 1, tuple(range(states + 1)), (0.0,) * states)
    found, _ = dop853.integrate(path, [0.1], [1.0] * states, 0.0, [1.0, 4.0], 1e-10)
    exact = np.exp(-0.1 * np.outer([1.0, 4.0], np.arange(1, states + 1)))
    assert abs(found / exact - 1).max() < 1e-9


@pytest.mark.skipif(shutil.which("gcc") is None or shutil.which("g++") is None, reason="no GNU compilers")
@pytest.mark.parametrize(
    "command", [["gcc", "-std=c99", "-x", "c"], ["g++", "-std=c++11", "-x", "c++"]], ids=["c", "c++"]
)
def test_the_source_is_clean_c99_and_valid_cpp(command):
    source = dop853.translation_unit(RIGID_BODY, "rigid_body", 7, 6)
    options = ["-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-fsyntax-only", "-"]
    done = subprocess.run([*command, *options], input=source, text=True, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    code = re.sub(r"/\*.*?\*/", "", source, flags=re.DOTALL)
    assert not re.search(r"malloc|printf|alloca|^static (?!inline|const|void|SYMROT_APART)", code, flags=re.MULTILINE)


# ------------------------------------------------------------------------------------------------ the SciPy fallback


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


# ------------------------------------------------------------------------------------------------ the benchmark


def test_the_benchmark_compares_like_with_like(capsys):
    """All contestants solve the same problem; only the times are left to the machine."""
    from symrot.bench import stepper

    stepper.main(["--tolerance", "1e-8", "--stop", "20", "--rounds", "1"])
    rows = {row[:14].strip(): row[14:].split() for row in capsys.readouterr().out.splitlines()[2:6]}
    assert list(rows) == ["symrot", "by hand, -O2", "by hand, -O3", "solve_ivp"]
    for evaluations, *_, error, _ in rows.values():
        assert int(evaluations) > 100
        assert float(error) < 1e-6
    assert float(rows["symrot"][-2]) < 5e-8
