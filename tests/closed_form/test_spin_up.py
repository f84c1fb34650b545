"""A symmetric body driven about its axis: the closed form, compared with mpmath's Kummer function and Taylor series."""

import random

import numpy as np
import pytest
from mpmath import exp, hyp1f1, mp, mpc, mpf
from sympy import Rational, Symbol, solve

from symrot.catalogue import derivation
from symrot.closed_form import build as library
from symrot.closed_form.spin_up import motion as spin_up
from symrot.closed_form.spin_up import series as spin_up_series
from symrot.errors import InputError
from symrot.propagation.propagate import propagate
from symrot.scene.scene import load_scene
from tests.closed_form.test_driven import flow

Q0 = (0.1, 0.7, -0.5, 0.5)
BAR = 1e-15


def product(a, b):
    (a0, a1, a2, a3), (b0, b1, b2, b3) = a, b
    return [a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3, a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
            a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1, a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0]  # fmt: skip


def inverse(q):
    return [q[0], -q[1], -q[2], -q[3]]


def about_axis(angle):
    return [mp.cos(angle / 2), mpf(0), mpf(0), mp.sin(angle / 2)]


def swept(kappa, x):
    """Return the attitude at x of a body with angular velocity (kappa, 0, x) and attitude 1 at x = 0: step 13 of
    driven_rotation.md.
    """
    a, z = mpc(0, -1) * kappa**2 / 8, mpc(0, -1) * x**2 / 2
    alpha = exp(-z / 2) * hyp1f1(a, mpf(1) / 2, z)
    beta = kappa / 2 * x * exp(z / 2) * hyp1f1(mpf(1) / 2 - a, mpf(3) / 2, -z)
    return [alpha.real, beta.real, beta.imag, alpha.imag]


def kummer(a, c, torque, omega, t):
    """Return q at t for the moments of inertia a, a, c, to 50 digits."""
    with mp.workdps(50):
        a, c, torque, t, *omega = map(mpf, (a, c, torque, t, *omega))
        norm = mp.sqrt(sum(mpf(x) ** 2 for x in Q0))
        sign, root, lag = mp.sign(torque), mp.sqrt(abs(torque) / a), (c - a) / a
        width, start = mp.hypot(omega[0], omega[1]), mp.atan2(omega[1], omega[0])
        x0, kappa = sign * c / a * omega[2] / root, width / root
        flip = [mpf(1), 0, 0, 0] if sign > 0 else [0, mpf(1), 0, 0]
        q = product(product([mpf(x) / norm for x in Q0], about_axis(start)), flip)
        q = product(product(q, inverse(swept(kappa, x0))), swept(kappa, x0 + root * t))
        phase = start + lag * (omega[2] * t + torque / (2 * c) * t**2)
        return np.array([float(x) for x in product(product(q, inverse(flip)), about_axis(-phase))])


def at(kappa, x0, torque=0.37, a=1.25, c=2.0):
    """Return the arguments of a motion that begins at x0, and the unit of time."""
    root = (abs(torque) / a) ** 0.5
    across = kappa * root
    return (a, a, c), 2, torque, (0.6 * across, -0.8 * across, np.sign(torque) * x0 * root * a / c), Q0, 1 / root


@pytest.mark.parametrize(
    "kappa, torque",
    [(1e-6, 0.37), (0.03, -2), (1, 0.37), (1, -2), (4, 0.37), (6.5, -2), (8.999, 0.37), (9.001, 0.37), (20, -2)],
)
def test_every_regime_against_kummers_function(kappa, torque):
    """Motions start before, in or after resonance, and end before, in or after it."""
    draw = random.Random(repr((kappa, torque)))
    for x0 in (-17.0, 1.5, 11.0):
        *given, unit = at(kappa, x0, torque, c=draw.uniform(0.2, 2.4))
        times = [(x - x0) * unit for x in (draw.uniform(-9, 9), draw.uniform(-25, -10), draw.uniform(10, 25))]
        found = spin_up.motion(*given).evaluate(times)[1]
        for t, q in zip(times, found, strict=True):
            exact = kummer(given[0][0], given[0][2], torque, given[3], t)
            assert np.abs(q - exact).max() <= BAR


@pytest.mark.thinned(2)
@pytest.mark.parametrize("moments, axis, torque, omega", [
    ((1, 1, 2), 2, 0.5, (0.3, 1, -0.4)), ((2, 1, 1), 0, -1.5, (3, 0, 1)), ((1, 3, 1), 1, 1e-3, (0.3, 1, 0.2)),
    ((2, 2, 2), 2, 3, (0.3, 1, 0.5)), ((1, 1, 2), 2, 0, (0.3, 1, -0.4)),
])  # fmt: skip
def test_against_eulers_equations(moments, axis, torque, omega):
    push = [torque if k == axis else 0 for k in range(3)]
    w, q = flow(moments, omega, 2.75, torque=push)
    rates, attitudes = spin_up.motion(moments, axis, torque, omega, Q0).evaluate([2.75, 0.0])
    assert np.abs(rates[0] - w).max() <= BAR and np.abs(attitudes[0] - q).max() <= BAR
    assert (rates[1] == omega).all() and np.abs(attitudes[1] - np.array(Q0) / np.linalg.norm(Q0)).max() < 3e-16


def extremes(count, seed=7):
    """Return motions with kappa from 1e-6 to 1e6 and x up to 1e5 (1e9 rotations), in both directions of time."""
    draw = random.Random(seed)
    for _ in range(count):
        torque = draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 3)
        *given, unit = at(10 ** draw.uniform(-6, 6), draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 4), torque)
        yield given, np.array([0.0, *(draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 5) * unit for _ in range(6))])


def by_integers(motion, times):
    rates, attitudes = np.empty((len(times), 3)), np.empty((len(times), 4))
    for i, t in enumerate(times.tolist()):
        motion.integers.put(i, t, rates, attitudes)
    return rates, attitudes


def without_compiler(given, monkeypatch):
    monkeypatch.setenv("CC", "no such compiler")
    monkeypatch.setattr(library, "_loaded", {})
    return spin_up.motion(*given)


def test_pairs_of_doubles_hold_what_integers_find():
    for given, times in extremes(12):
        motion = spin_up.motion(*given)
        (w, q), (rates, attitudes) = motion.evaluate(times), by_integers(motion, times)
        assert np.abs(q - attitudes).max() <= BAR and np.abs(w - rates).max() <= BAR * np.abs(w).max()


def test_numpy_returns_what_c_returns(monkeypatch):
    cases = [*extremes(6, 8), (at(1.0, -12.0)[:-1], np.linspace(-5, 50, 40))]
    found = [spin_up.motion(*given).evaluate(times) for given, times in cases]
    for (given, times), (w, q) in zip(cases, found, strict=True):
        rates, attitudes = without_compiler(given, monkeypatch).evaluate(times)
        assert np.abs(q - attitudes).max() <= BAR and np.abs(w - rates).max() <= BAR * np.abs(w).max()


def test_a_spin_up_of_any_length():
    """Beyond 1e13 rad integers are used; the change of method is not visible in the results."""
    *given, unit = at(0.8, -3.0)
    motion = spin_up.motion(*given)
    times = np.array([4e6, 1e9, 1e15]) * unit
    w, q = motion.evaluate(times)
    assert np.array_equal(q[1:], by_integers(motion, times)[1][1:])
    assert np.abs(q[0] - by_integers(motion, times[:1])[1][0]).max() <= BAR
    assert np.abs(np.linalg.norm(q, axis=1) - 1).max() < BAR and np.isfinite(w).all()


def test_a_weak_torque_leaves_a_free_body():
    free = spin_up.motion((1, 1, 2), 2, 0, (0.3, 1, -0.4), Q0)
    for torque in (1e-300, -1e-60, 1e-25):
        weak = spin_up.motion((1, 1, 2), 2, torque, (0.3, 1, -0.4), Q0)
        for a, b in zip(free.evaluate([-7.0, 1e3]), weak.evaluate([-7.0, 1e3]), strict=True):
            assert np.abs(a - b).max() < BAR


def test_the_series_of_a_weak_torque_is_the_one_derived():
    """The coefficients in C agree to 1e-31 with the recurrence proven in driven_rotation.md and with the root."""
    step = next(s for s in derivation("driven_rotation").steps if "The coefficient of $h^k$ in" in s.claim)
    following, now, before, k, c = (Symbol(name) for name in ("a_{k+1}", "a_{k}", "a_{k-1}", "k", "c"))
    (recurrence,) = solve(step.right, following)
    a = [Rational(0), Rational(1)]  # W = 4, S_0 = 5
    for n in range(15):
        a.append(recurrence.subs({k: n, now: a[-1], before: a[-2], c: Rational(3, 5)}))
    assert [x * 5**n for n, x in enumerate(a[1:4])] == [1, 3, 8]
    with mp.workdps(40):
        root = mp.taylor(lambda h: mp.sqrt(1 + mpf(6) / 5 * h + h * h), 0, 15)
        assert max(abs(mpf(x.p) / x.q - y) for x, y in zip(a[1:], root, strict=True)) < 1e-35
        found = spin_up.motion((1, 1, 2), 2, 1e-25, (4, 0, 1.5))._source._known[0]
        wanted = [mpf(x.p) / x.q / n for n, x in enumerate(a[1:], start=1)]
        off = [
            max(abs(mpf(found[i + 2 * n]) + found[i + 2 * n + 1] - x) for n, x in enumerate(wanted))
            for i in range(len(found) - 31)
        ]
        assert min(off) < 1e-31


@pytest.mark.parametrize(
    "kappa, x0", [(1e-3, 3.1e7), (1e-3, 3.2e7), (3.1e7, -9.0), (3.2e7, 9.0), (5.0, -1e9), (1e12, 1e12)]
)
def test_phases_by_their_formula_and_by_their_series(kappa, x0):
    """A torque is weak from S^2 = 1e15 s on; up to 1e13 rad, pairs of doubles give both phases."""
    *given, unit = at(kappa, x0, -2)
    times = np.array([-0.97, -1e-4, -1e-9, 1e-11, 1e-6, 0.3, 0.97]) * 1e13 / np.hypot(kappa, x0) * unit * 0.6
    motion = spin_up.motion(*given)
    (w, q), (rates, attitudes) = motion.evaluate(times), by_integers(motion, times)
    assert np.abs(q - attitudes).max() <= BAR and np.abs(w - rates).max() <= BAR * np.abs(w).max()
    assert max(abs(times)) < motion._source.longest  # else integers are held against themselves


def test_what_is_asked_for_first_does_not_matter():
    """Constants beyond resonance are computed when a sample needs them."""
    *given, unit = at(2.0, -12.0)
    early, late = np.array([-3.0, 0.0, 1.5]) * unit, np.array([30.0, 2.5, 12.0]) * unit
    motion, once = spin_up.motion(*given), spin_up.motion(*given).evaluate(np.concatenate([early, late]))[1]
    twice = [motion.evaluate(early)[1], motion.evaluate(late)[1], motion.evaluate(early)[1]]
    assert np.array_equal(np.concatenate(twice), np.concatenate([once, once[:3]]))


def test_a_sample_does_not_depend_on_its_neighbours():
    *given, unit = at(1.0, -12.0)
    motion, times = spin_up.motion(*given), np.array([3.0, 12.0, 12.0, 30.0, -1.0]) * unit
    w, q = motion.evaluate(times)
    for k, t in enumerate(times):
        one = motion.evaluate(t)
        assert np.array_equal(one[0][0], w[k]) and np.abs(one[1][0] - q[k]).max() < BAR
    assert motion.evaluate([])[1].shape == (0, 4) and motion.evaluate(1.0, quaternion=False)[1] is None


def test_the_edge_of_resonance_belongs_to_one_side(monkeypatch):
    """Doubles cannot decide whether a sample or start is beyond |x| = 10; 9.9999.. rounds to the last piece."""
    draw, cases = random.Random(3), []
    for x0 in (10.0, -10.0, 0.0, 10.5):
        for to in (10.0, -10.0, *(10.0 * (1 + k * 2.0**-53) for k in range(-4, 5)), -11.0):
            *given, unit = at(draw.uniform(0.1, 3), x0, draw.choice((-1, 1)) * 10 ** draw.uniform(-3, 3))
            cases.append((given, np.array([(to - x0) * unit])))
    found = [spin_up.motion(*given).evaluate(times)[1] for given, times in cases]
    for (given, times), q in zip(cases, found, strict=True):
        assert np.abs(q - by_integers(spin_up.motion(*given), times)[1]).max() <= BAR
    for (given, times), q in list(zip(cases, found, strict=True))[::7]:
        assert np.abs(q - without_compiler(given, monkeypatch).evaluate(times)[1]).max() <= BAR


@pytest.mark.parametrize("across", [1e-170, 5e-324, 1e-100])
def test_what_hardly_wobbles_spins(across):
    """The square of kappa is too small for a double."""
    w, q = spin_up.motion((1, 1, 2), 2, 0.5, (across, 0, 1.0)).evaluate([0.0, 3.0])
    half = 0.5 * (3.0 + 0.125 * 9)
    assert np.abs(q - [[1, 0, 0, 0], [np.cos(half), 0, 0, np.sin(half)]]).max() < BAR and w[1, 2] == 1.75


def test_what_leaves_the_doubles():
    """Times whose squares overflow are treated with integers; angular velocities that overflow are refused."""
    given = (1.0, 1.0, 2.0), 2, 1.0, (1.0, 0.0, 1.0)
    times = np.array([1e200, 1e300, -1e300])
    (w, q), motion = spin_up.motion(*given).evaluate(times), spin_up.motion(*given)
    assert all(np.array_equal(a, b) for a, b in zip((w, q), by_integers(motion, times), strict=True))
    with pytest.raises(InputError, match="angular velocity is a finite number"):
        spin_up.motion((1.0, 1.0, 2.0), 2, 1e100, (1.0, 0.0, 1.0)).evaluate([1.0, 1e300])


def test_the_series_alone_would_not_do_near_resonance(monkeypatch):
    """If the series were used for a smaller kappa, its terms would grow before they become small."""
    *given, unit = at(5.0, -12.0)
    exact = kummer(given[0][0], given[0][2], given[2], given[3], 20 * unit)
    assert np.abs(spin_up.motion(*given).evaluate([20 * unit])[1][0] - exact).max() <= BAR
    monkeypatch.setattr(spin_up_series, "WIDE", 5.0)
    assert np.abs(spin_up.motion(*given).evaluate([20 * unit])[1][0] - exact).max() > 1000 * BAR


def test_the_shipped_scene():
    scene = load_scene("spin_up")
    exact, stepped = propagate(scene), propagate(scene, method="taylor", tolerance=1e-14)
    assert exact.method == "exact" and np.abs(exact.quaternion - stepped.quaternion).max() < 1e-12


def test_what_is_no_such_motion():
    with pytest.raises(InputError, match="symmetric about the driven axis"):
        spin_up.motion((1, 2, 3), 2, 1, (1, 0, 0))
    with pytest.raises(InputError, match="also rotates about an axis perpendicular"):
        spin_up.motion((1, 1, 3), 2, 1, (0, 0, 1))
    with pytest.raises(InputError, match="axis 0, 1 or 2"):
        spin_up.motion((1, 1, 3), 3, 1, (1, 0, 1))
