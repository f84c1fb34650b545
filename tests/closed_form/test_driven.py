"""Gyrostats and driven rotations, compared with higher precision and with their limits."""

import random
from fractions import Fraction

import numpy as np
import pytest
from mpmath import matrix, mp, mpf, odefun

from symrot.build.cache import build
from symrot.closed_form import build as library
from symrot.closed_form.arithmetic import double_double
from symrot.closed_form.axial import angle as axial_angle
from symrot.closed_form.axial import compiled as axial_compiled
from symrot.closed_form.axial import motion as axial
from symrot.closed_form.free_body import motion as free_body
from symrot.closed_form.gyrostat import motion as gyrostat
from symrot.errors import CompilerError, InputError
from symrot.propagation.propagate import propagator
from tests.propagation.test_changed_start import scene

Q0 = (0.1, 0.7, -0.5, 0.5)
BAR = 1e-15


@pytest.fixture
def no_compiler(monkeypatch):
    """Imitate a machine without a C compiler and without compiled loops, so that NumPy computes everything."""
    monkeypatch.setenv("CC", "no such compiler")
    monkeypatch.setattr("symrot.closed_form.build._loaded", {})


@pytest.fixture(params=["C", "NumPy"])
def way(request):
    """Return each implementation that computes a driven rotation."""
    if request.param == "NumPy":
        request.getfixturevalue("no_compiler")


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


@pytest.mark.thinned(4)
@pytest.mark.parametrize("damping", [0, 0.125, 3])
@pytest.mark.parametrize("torque", [0, 0.25, -2])
def test_driven_and_damped_about_an_axis(torque, damping, way):
    t = 2.25
    w, q = flow((1, 3, 2), (0, 0.75, 0), t, torque=(0, torque, 0), damping=(0, damping, 0))
    rates, attitudes = axial.motion((1, 3, 2), 1, torque, (0, 0.75, 0), Q0, damping).evaluate([t])
    assert np.abs(rates[0] - w).max() <= BAR and np.abs(attitudes[0] - q).max() <= BAR


def test_a_symmetric_body_driven_about_its_axis(way):
    w, _ = flow((1, 1, 3), (0.3, 1, 0.5), 2.5, torque=(0, 0, 0.25))
    driven = axial.motion((1, 1, 3), 2, 0.25, (0.3, 1, 0.5), Q0)
    assert np.abs(driven.evaluate([2.5], quaternion=False)[0][0] - w).max() <= 2 * BAR
    assert not driven.has_attitude
    with pytest.raises(
        InputError, match="quaternion: expected False, got True: this closed form has no attitude, because the angular"
    ):
        driven.evaluate([2.5])


def test_a_symmetric_body_driven_about_its_axis_and_damped_about_all(way):
    w, _ = flow((1, 1, 3), (0.3, 1, 0.5), 2.5, torque=(0, 0, 0.25), damping=(0.125, 0.125, 0.5))
    driven = axial.motion((1, 1, 3), 2, 0.25, (0.3, 1, 0.5), Q0, 0.5, 0.125)
    assert np.abs(driven.evaluate([2.5], quaternion=False)[0][0] - w).max() <= 2 * BAR


@pytest.mark.parametrize("omega, damping", [((0, 0.75, 0), 0), ((0, 0.75, 0), 0.125), ((0, 0, 0), 3)])
def test_driven_rotations_at_any_times(omega, damping, way):
    """Times are single, many, unsorted, repeated or before the start; each sample is independent, the first is the
    start.
    """
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
def test_phases_over_many_turns(damping, times, way):
    """Up to 1e17 rotations are compared with the angle to 60 digits."""
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


def half_angle(rate, push, damping, t):
    """Return cosine and sine of half the angle of C dw/dt = N - c w, C = 2, to 60 digits, from exp(A t) (0, w, 1)."""
    with mp.workdps(120):
        system = matrix([[0, 1, 0], [0, -mpf(damping) / 2, mpf(push) / 2], [0, 0, 0]])
        angle = (mp.expm(system * mpf(t), method="taylor") * matrix([0, mpf(rate), 1]))[0]
        return np.array([float(mp.cos(angle / 2)), float(mp.sin(angle / 2))])


def random_motions(count, seed=4):
    """Return rates 1e-3 to 1e3, damping 1e-9 to 10, torque of either sign or zero; times to 1e6 periods, both
    directions.
    """
    draw = random.Random(seed)
    for _ in range(count):
        rate, push = (draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 3) for _ in range(2))
        damping = 10 ** draw.uniform(-9, 1)
        period = 2 * np.pi / abs(rate)
        ahead = [period * 10 ** draw.uniform(-3, 6) for _ in range(4)]
        back = [-min(time, 40 / damping) for time in ahead]
        yield rate, draw.choice((0.0, push)), damping, [*ahead, *back, draw.uniform(0, 6) / damping]


def errors_of(motions):
    """Return the errors of the attitude, for a few times in one call and for many times."""
    found = []
    for rate, push, damping, times in motions:
        motion = axial.motion((2, 2, 2), 2, push, (0, 0, rate), damping=damping)
        few = motion.evaluate(times)[1]
        many = motion.evaluate(np.tile(times, 1 + axial_angle.FEW))[1][: len(times)]
        exact = np.array([half_angle(rate, push, damping, t) for t in times])
        found.append([np.abs(q[:, [0, 3]] - exact).max() for q in (few, many)])
    return np.array(found).max(axis=0)


def test_damped_angles_of_random_motions(way):
    """Errors are below 1e-15 for every implementation: C, integers for a few times, pairs of doubles for many."""
    assert (errors_of(random_motions(20)) <= BAR).all()


def test_doubles_alone_would_not_do(monkeypatch, no_compiler):
    motion = 75.0, 0.25, 1e-3, [400.0]
    assert (errors_of([motion]) <= BAR).all()
    monkeypatch.setattr(axial_angle, "SMALL", np.inf)
    assert (errors_of([motion]) > 100 * BAR).all()


def driven(rate, push, damping, t):
    """Return w and the cosine and sine of half the angle of 2 dw/dt = N - c w, computed to 50 digits, as doubles."""
    growth = max(0.0, -damping / 2 * t)
    with mp.workdps(140 + int(growth)):  # what cancels in exp(x) - 1 - x, and the whole turns
        w0, a, k, t = mpf(rate), mpf(push) / 2, mpf(damping) / 2, mpf(t)
        x = -k * t
        w = w0 * mp.exp(x) - a / k * mp.expm1(x) if k else w0 + a * t
        angle = -w0 / k * mp.expm1(x) + a / k**2 * (mp.exp(x) - 1 - x) if k else w0 * t + a * t * t / 2
        return [float(item) for item in (w, mp.cos(angle / 2), mp.sin(angle / 2))]


def all_regimes(count, seed=9):
    """Return motions at rest, with torque or damping alone, or both; damping*t from 1e-20 to 1e15, backward to
    exp(300).
    """
    draw = random.Random(seed)
    for _ in range(count):
        rate, push = (draw.choice((0, 1, -1)) * 10 ** draw.uniform(-6, 4) for _ in range(2))
        damping = draw.choice((0, 1, 1)) * 10 ** draw.uniform(-14, 3)
        latest = min(1e15, 300 / damping) if damping else 1e15
        times = [10 ** draw.uniform(-9, 15) for _ in range(4)] + [-(latest ** draw.uniform(0, 1)) for _ in range(3)]
        yield rate, push, damping, [*times, *(draw.uniform(0, 3) / damping for _ in range(3 * bool(damping)))]


def worst(motions):
    """Return the largest errors of w, relative to the larger of w and its initial value, and of the attitude."""
    found = [(0.0, 0.0)]
    for rate, push, damping, times in motions:
        rates, attitudes = axial.motion((2, 2, 2), 2, push, (0, 0, rate), damping=damping).evaluate(times)
        for t, w, q in zip(times, rates[:, 2], attitudes, strict=True):
            exact, cosine, sine = driven(rate, push, damping, t)
            found.append(
                (abs(w - exact) / max(abs(exact), abs(rate), 1e-300), max(abs(q[0] - cosine), abs(q[3] - sine)))
            )
    return np.max(found, axis=0)


def test_driven_rotations_in_all_regimes(way):
    assert (worst(all_regimes(60)) <= BAR).all()


def test_the_wide_constants_are_needed(monkeypatch):
    """With pairs of doubles in place of wide constants, phases are wrong long before 1e15 s, which the comparison
    detects.
    """
    motion = 0.75, 0.25, 0, [3e12, -1e15]
    assert worst([motion])[1] <= BAR
    plain = axial_compiled.parts
    monkeypatch.setattr(
        axial_compiled, "parts", lambda top, bottom, count: [*plain(top, bottom, min(count, 2)), 0.0, 0.0][:count]
    )
    assert worst([motion])[1] > 1e9 * BAR


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "motion", [(1e3, 0.25, 1e-12, [1e3, 1e11]), (1e4, 1e4, 0, [1e15, -1e16]), (1.0, 0.0, 2.0, [-30.0, 1.0, -200.0])]
)
def test_what_the_loops_do_not_know_is_done_in_integers(motion):
    """Some samples have more than 1e10 rotations in the transient, or 1e30 in total."""
    rate, push, damping, times = motion
    found = axial.motion((2, 2, 2), 2, push, (0, 0, rate), damping=damping)
    raw = np.empty((len(times), 4))
    assert found._loops(np.array(times), None, raw) == axial_compiled.TOO_MANY_TURNS and np.isnan(raw).any()
    assert worst([motion])[1] <= BAR


def test_c_and_numpy_agree_on_bodies_that_turn_across_the_axis(request):
    times = np.concatenate([np.geomspace(1e-3, 1e9, 60), -np.geomspace(1e-3, 1e3, 20)])
    arguments = (3, 3, 1), 2, 0.25, (0.3, -1, 0.5), Q0, 0.125, 0.375
    first = axial.motion(*arguments).evaluate(times, quaternion=False)[0]
    request.getfixturevalue("no_compiler")
    second = axial.motion(*arguments).evaluate(times, quaternion=False)[0]
    assert (np.abs(first - second) <= BAR * np.abs(second).max(axis=1)[:, None]).all()


@pytest.mark.parametrize("inertia", [(2, 2, 1), (2, 3, 4)])
@pytest.mark.parametrize("torque", [{"kind": "constant_body", "torque": [0, 0, 0]}, {"kind": "damping", "linear": 1}])
def test_a_body_at_rest_that_nothing_drives_stays(inertia, torque):
    """No rotation axis is marked, because any axis would do."""
    found = propagator(scene([torque], inertia=inertia, omega=(0, 0, 0), attitude=(1, 2, 3, 4)))([0.0, 1e6])
    assert found.method == "exact" and not found.omega.any()
    assert np.abs(found.quaternion - np.array([1.0, 2.0, 3.0, 4.0]) / np.sqrt(30.0)).max() <= BAR


@pytest.mark.parametrize("damping", [0, 1e-3])
def test_rates_beyond_the_turns_that_loops_know_are_right(damping):
    """Larger rates are replaced by 2^200 only where full rotations are removed, never in the angular velocity."""
    found = axial.motion((2, 2, 2), 2, 0.25, (0, 0, 1e100), damping=damping).evaluate([0.5, 1.0], quaternion=False)[0]
    assert np.abs(found[:, 2] / (1e100 * np.exp(-damping / 2 * np.array([0.5, 1.0]))) - 1).max() <= BAR


def test_constants_of_equal_ratios_are_equal():
    """Equal ratios of different integers give constants with the same bits."""
    chance = random.Random(3)
    for _ in range(3000):
        bits = chance.randrange(1, 400)
        top, bottom = chance.getrandbits(bits) - (1 << bits - 1), 1 + chance.getrandbits(chance.randrange(1, 400))
        factor = 1 + chance.getrandbits(chance.randrange(1, 200))
        assert axial_compiled.parts(top, bottom, 4) == axial_compiled.parts(top * factor, bottom * factor, 4)


def test_constants_in_parts():
    value = Fraction(10**80, 3**70)
    found = axial_compiled.parts(value.numerator, value.denominator, 4)
    assert abs(sum(map(Fraction, found)) / value - 1) < Fraction(1, 2**205)
    assert axial_compiled.parts(-(10**400), 3, 2) == [-(2.0**200), 0.0] and axial_compiled.parts(0, 7, 3) == [0.0] * 3


@pytest.mark.parametrize("rate, push", [(75.0, 0.25), (1.0, 1e10)])
def test_a_sample_does_not_depend_on_its_neighbours(rate, push, way):
    motion = axial.motion((2, 2, 2), 2, push, (0, 0, rate), damping=0.125)
    times = np.concatenate([np.geomspace(1e-12, 1e3, 100), -np.geomspace(1e-12, 100, 100)])
    together = motion.evaluate(times)[1]
    assert all(np.array_equal(motion.evaluate(t)[1][0], q) for t, q in zip(times, together, strict=True))
    assert np.array_equal(motion.evaluate(np.tile(times, 40))[1], np.tile(together, (40, 1)))


def test_small_angles_take_no_pairs(monkeypatch, no_compiler):
    taken = []
    for way in ("_near", "_far", "_by_integers"):
        plain = getattr(axial_angle.Turning, way)
        monkeypatch.setattr(
            axial_angle.Turning, way, lambda self, t, plain=plain: (taken.append(len(t)), plain(self, t))[1]
        )
    motion = axial.motion((2, 2, 2), 2, 0.001, (0, 0, 0.5), damping=0.01)
    motion.evaluate(np.linspace(-1, 1, 1000))
    assert not taken
    motion.evaluate(np.linspace(0, 3, 1000))
    assert 0 < sum(taken) < 1000


def test_exponentials_in_pairs():
    x = np.array([-700.0, -80.0, -1.0, -0.07, 0.0, 1e-20, 0.07, 1.0, 40.0, 700.0])
    high, low = double_double.exponential((x, x * 2.0**-60))
    with mp.workdps(60):
        for a, b, c in zip(x.tolist(), high.tolist(), low.tolist(), strict=True):
            exact = mp.exp(mpf(a) * (1 + mpf(2) ** -60))
            assert abs((mpf(b) + mpf(c)) / exact - 1) < mpf(2) ** -96 or a < -600  # where the low part is subnormal


def test_rates_before_the_start_that_all_but_cancel(way):
    rate, push, damping, t = 474.0, 482.0, 1.0, -21.5
    w = axial.motion((2, 2, 2), 2, push, (0, 0, rate), damping=damping).evaluate([t])[0][0, 2]
    with mp.workdps(40):
        assert abs(w / (push + (mpf(rate) - push) * mp.exp(-mpf(t) / 2)) - 1) <= BAR


def test_times_before_the_doubles_are_refused(way):
    motion = axial.motion((2, 2, 2), 2, 1, (0, 0, 1), damping=2)
    assert np.isfinite(motion.evaluate(-600.0)[0]).all()
    with pytest.raises(InputError, match=r"after -700.0 s, before which .* got -800.0 s"):
        motion.evaluate([0.0, -800.0])


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="rotor along the axis of a symmetric body"):
        gyrostat.motion((1, 1, 2), (1, 0, 0), (0, 0, 1))
    with pytest.raises(InputError, match="rotates only about the driven axis or is symmetric"):
        axial.motion((1, 2, 3), 2, 1, (1, 0, 1))
    with pytest.raises(InputError, match="axis 0, 1 or 2"):
        axial.motion((1, 2, 3), 3, 1, (0, 0, 1))


def test_fast_math_is_refused():
    """With -ffast-math, error-free arithmetic would be lost in silence."""
    with pytest.raises(CompilerError, match="ffast-math"):
        build(library.source("free_body"), "closed_form_fast", (*library.FLAGS, "-ffast-math"))
