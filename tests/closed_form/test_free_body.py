"""The free body in every regime, compared with 60-digit references: stress tests S1 to S16 of the numerics notes, and
laws.

``pytest FILE -o log_cli=true --log-cli-level=INFO`` prints the largest error of each test.
"""

import logging
import math
import random
from fractions import Fraction
from itertools import permutations, product

import numpy as np
import pytest
from mpmath import mp

from symrot.closed_form.free_body import motion as free_body
from symrot.errors import InputError
from symrot.inertia.principal import principal_axes
from symrot.kinematics import conversions
from tests.reference import free_body as reference
from tests.reference import taylor

Q0 = (0.1, 0.7, -0.5, 0.5)
BAR = 1e-15
LOG = logging.getLogger(__name__)
SPREAD = (0.0, 0.13, 0.5, 3.7, -11.3, 1e3, -1e6 / 3)
SQRT3 = math.sqrt(3.0)


def errors(moments, omega, times, q0=Q0, in_periods=False, motion=None, digits=reference.DIGITS):
    """Return the largest errors of omega, relative to |omega0|, and of q, up to its sign, against the reference."""
    expected = reference.motion(moments, omega, q0, digits)
    motion = motion or free_body.motion(moments, omega, q0)
    scale = expected.period if in_periods and expected.period else 1
    times = [float(scale * t) for t in times]
    rates, attitudes = motion.evaluate(times)
    assert np.isfinite(rates).all() and np.isfinite(attitudes).all()
    with mp.workdps(60):
        size = mp.sqrt(sum(reference.exactly(x) ** 2 for x in omega)) or 1
        worst = reference.worst_errors(expected, times, rates, attitudes, size)
    LOG.info("omega %.1e, q %.1e", *worst)
    return worst


def in_bar(*arguments, **options):
    return max(errors(*arguments, **options)) <= BAR


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "moments, omega", [((1, 2, 3), ("3/10", 1, "1/2")), ((3, 1, 2), ("-3/10", 1, "3/2")), ((1, 1, 2), (1, "1/2", 2)),
                       ((3, 4, 6), (2, "-3/2", 1)), ((1, 2, 3), ("1/1000", 1, "1/1000"))]
)  # fmt: skip
def test_the_reference_agrees_with_taylor_series(moments, omega):
    """Elliptic integrals and fixed-point Taylor steps have no code in common and agree to 45 digits."""
    moments, omega = [Fraction(x) for x in moments], [Fraction(x) for x in omega]
    q0 = [Fraction(x).limit_denominator(10) for x in Q0]
    w, dcm = taylor.trajectory(moments, omega, q0, [Fraction(7)])[0]
    found, q = reference.motion(moments, omega, q0)(Fraction(7))
    with mp.workdps(60):
        a, b, c, d = q
        first = [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)]
        assert max(abs(x - reference.exactly(y)) for x, y in zip(found, w, strict=True)) < 1e-45
        assert max(abs(x - reference.exactly(y)) for x, y in zip(first, dcm[0], strict=True)) < 1e-45


def test_errors_are_seen():
    """A motion with reversed handedness, or with an initial rate wrong by 1e-14, fails the comparison."""
    wrong = free_body.motion((1, 2, 3), (0.3, 1.0, -0.5), Q0)
    assert max(errors((1, 2, 3), (0.3, 1.0, 0.5), [7.0], motion=wrong, digits=40)) > 0.1
    close = free_body.motion((1, 2, 3), (0.3, 1.0, 0.5 + 1e-14), Q0)
    assert BAR < max(errors((1, 2, 3), (0.3, 1.0, 0.5), [7.0], motion=close)) < 1e-12


def test_s1_chirality():
    assert max(errors((1, 2, 3), (0.3, 1.0, 0.5), [7.0])) < 5e-16


@pytest.mark.thinned(2)
@pytest.mark.parametrize("moments", list(permutations((1.0, 2.0, 3.0))))
def test_s2_axis_permutations(moments):
    """All permutations of the axes, all signs and both outer axes are tested."""
    for signs, rates in product(product((1, -1), repeat=3), ((0.3, 1.0, 0.5), (1.0, 0.4, 0.2), (0.2, 0.3, 1.1))):
        assert in_bar(moments, [s * w for s, w in zip(signs, rates, strict=True)], [7.3], digits=50)


@pytest.mark.parametrize("omega", [(0.3, 1.0, 0.5), (0.3, 1.0, 1.5), (1.0, 0.4, 0.2)])
def test_s3_s4_long_and_huge_times(omega):
    assert in_bar((1, 2, 3), omega, [10.3, 1000.3, 1e6 + 0.3, -1e6 + 0.1], in_periods=True)
    assert in_bar((1, 2, 3), omega, [1e9, 1e12, 1e15, -1e15])


def random_body(source):
    """Return moments of inertia over three decades that satisfy the triangle inequality, rates, and an attitude."""
    x, y, z = (10 ** source.uniform(-3, 0) for _ in range(3))
    omega = [source.choice((1, -1)) * 10 ** source.uniform(-2, 1) for _ in range(3)]
    return (y + z, z + x, x + y), omega, [source.gauss(0, 1) for _ in range(4)]


def check_random_bodies(count, seed):
    source = random.Random(seed)
    for _ in range(count):
        moments, omega, q0 = random_body(source)
        times = [source.uniform(-10, 10), source.uniform(-1e6, 1e6)]
        assert in_bar(moments, omega, times, q0, in_periods=True, digits=70), (moments, omega, q0)


def test_s5_random_bodies():
    check_random_bodies(25, 5)


@pytest.mark.campaign
def test_s5_a_thousand_random_bodies():
    check_random_bodies(1000, 55)


@pytest.mark.parametrize("e", [1e-3, 1e-5, 1e-8, 1e-12])
def test_s6_near_the_separatrix(e):
    assert in_bar((1, 2, 3), (e, 1.0, e), [0.13, 0.5, 3.7, 1e3])
    assert in_bar((1, 2, 3), (e, 1.0, e), [1e6 + 0.26], in_periods=True)


@pytest.mark.parametrize("d", [1e-8, -1e-8, 1e-14, -1e-14, 1e-15, -1e-15])
def test_s7_fat_separatrix(d):
    assert in_bar((1, 2, 3), (1.0, 1.0, (1 + d) / SQRT3), [0.13, 3.7, 1e3, 1e6])


@pytest.mark.parametrize("omega", [(2, 1.5, 1), (2, -1.5, 1), (2, 1.5, -1), (-2, 1.5, 1)])
@pytest.mark.parametrize("scale", [Fraction(1), Fraction(1, 7)])
def test_s8_exactly_on_the_separatrix(omega, scale):
    """Some moments of inertia are not doubles; the motion tends to rotation about the middle axis."""
    moments, omega = [scale * x for x in (3, 4, 6)], [Fraction(x) for x in omega]
    motion = free_body.motion(moments, omega, Q0)
    assert motion.regime == "separatrix"
    assert in_bar(moments, omega, [0.3, -3.0, 30.0, 1e3, -1e6])
    final = motion.evaluate([1e6], quaternion=False)[0][0]
    momentum = math.sqrt(sum((m * w) ** 2 for m, w in zip(moments, omega, strict=True)))
    assert abs(abs(final[1]) - momentum / moments[1]) < 1e-15 and final[0] == pytest.approx(0, abs=1e-30)


def test_s9_dzhanibekov_timing():
    """After whole flips omega_2 is -1, 1, -1, to the last bit."""
    omega = (1e-8, 1.0, 1e-8)
    half = reference.motion((1, 2, 3), omega, Q0).period / 2
    rates, _ = free_body.motion((1, 2, 3), omega, Q0).evaluate([float(half * k) for k in (1, 2, 3)], quaternion=False)
    assert np.abs(rates[:, 1] - [-1, 1, -1]).max() <= 2.0**-52
    assert in_bar((1, 2, 3), omega, [float(half * k) for k in (1, 2, 3)])


@pytest.mark.parametrize(
    "moments", [(1, 1, 2), (3, 1, 1), (2, 3, 2), (2, 2, 2), (1, 1 + 1e-9, 2), (1, 1 + 4e-16, 2), (2, 1, 1 + 4e-16)]
)
def test_s10_symmetric(moments):
    assert in_bar(moments, (0.3, 1.0, 0.5), SPREAD)


def test_s10_continuous_across_equality():
    """Bodies whose moments of inertia differ by 4e-16 move alike."""
    ahead, same, behind = (
        free_body.motion((1.0, 1.0 + d, 2.0), (0.3, 1.0, 0.5), Q0).evaluate([2.7])[1] for d in (4e-16, 0, -4e-16)
    )
    assert np.abs(ahead - same).max() < 3e-15 and np.abs(behind - same).max() < 3e-15


@pytest.mark.parametrize(
    "moments, omega",
    [((3, 1, 1), (0, 0.2, 0.5)), ((1, 2, 3), (0, 0, 0)), *(((1, 2, 3), w) for w in ((2, 0, 0), (0, -2, 0), (0, 0, 2)))],
)
def test_s11_steady_rotation_is_found_exactly(moments, omega):
    motion = free_body.motion(moments, omega, Q0)
    assert motion.regime == "steady"
    assert (motion.evaluate(SPREAD, quaternion=False)[0] == omega).all()
    assert in_bar(moments, omega, SPREAD)


@pytest.mark.parametrize("omega", [(1e-9, 1e-9, 1.0), (1.0, 1e-9, 1e-9), (1e-150, 1e-150, 1.0), (0.0, 1e-12, 1.0)])
def test_s12_near_steady(omega):
    assert in_bar((1, 2, 3), omega, SPREAD)


def test_s13_near_spherical():
    moments = (1, 1 + 1e-10, 1 + 3e-10)
    assert in_bar(moments, (0.3, 1.0, 0.5), SPREAD)
    assert in_bar(moments, (0.3, 1.0, 0.5), [1e6 + 0.3], in_periods=True)


@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    "moments", [(1e-6, 1, 1 + 1e-7), (1, 2, 3), (0.3, 0.4, 0.7), (1e-12, 1, 1), (1e-9, 1, 1 + 1e-9)]
)
@pytest.mark.parametrize("omega", [(0.3, 1.0, 0.5), (0.5, 0.3, -1.0)])
def test_s14_extreme_inertia(moments, omega):
    assert in_bar(moments, omega, SPREAD)


@pytest.mark.parametrize("power", [-530, -61, 300])
def test_s15_s16_scaling_is_exact(power):
    """Powers of two in omega, time and inertia change no bit of the attitude."""
    scale, times = 2.0**power, np.array(SPREAD[:-2])
    omega = (0.3, 1.0, 0.5)
    rates, attitudes = free_body.motion((1.0, 2.0, 3.0), omega, Q0).evaluate(times)
    heavy = [math.ldexp(x, 400) for x in (1.0, 2.0, 3.0)]
    slow = free_body.motion(heavy, [w * scale for w in omega], Q0).evaluate(times / scale)
    assert (slow[1] == attitudes).all() and (slow[0] == rates * scale).all()


@pytest.mark.parametrize(
    "moments, omega",
    [((1, 2, 3), (3e8, 1e8, 2e8)), ((1e200, 2e200, 3e200), (0.3, 1.0, 0.5)), ((1, 2, 3), (3e-160, 1e-160, 2e-160))],
)
def test_s16_magnitudes(moments, omega):
    assert in_bar(moments, omega, [7.3 / max(omega), 1e5 / max(omega)])


def test_inertia_tensors_in_any_axes():
    """A body given in rotated axes moves as in its principal axes; the attitude refers to the given axes."""
    body = free_body.FreeRigidBody(principal_axes([[2, "1/3", 0], ["1/3", 2, 0], [0, 0, 3]]))
    turned = body.motion((Fraction(1), Fraction(1, 2), Fraction(2)), Q0)
    half = Fraction(1) / 2
    root = 1 / math.sqrt(2)
    to_given = np.array([[root, -root, 0], [root, root, 0], [0, 0, 1]])
    quaternion = conversions.dcm_to_quaternion(to_given)
    principal = free_body.motion(
        (Fraction(7, 3), Fraction(5, 3), 3),
        (to_given.T @ [1, 0.5, 2]).tolist(),
        conversions.multiply(np.array(Q0), quaternion).tolist(),
    )
    rates, attitudes = turned.evaluate(SPREAD[:-2])
    expected_rates, expected = principal.evaluate(SPREAD[:-2])
    back = conversions.multiply(expected, quaternion * [1, -1, -1, -1])
    assert half and np.abs(rates - expected_rates @ to_given.T).max() < 1e-12
    assert min(np.abs(attitudes - back).max(), np.abs(attitudes + back).max()) < 1e-12


TENSORS = {
    "general": ([[2, "1/10", "1/5"], ["1/10", 3, "3/10"], ["1/5", "3/10", 4]], ("3/10", 1, "1/2")),
    "nearly symmetric": ([[2, "1e-9", 0], ["1e-9", 2, "1e-9"], [0, "1e-9", 3]], ("3/10", 1, "1/2")),
    "symmetric": ([[2, "1/2", "1/2"], ["1/2", 2, "1/2"], ["1/2", "1/2", 2]], ("3/10", 1, "1/2")),
    "long and thin": ([[1, "999/1000", 0], ["999/1000", 1, 0], [0, 0, 2]], ("3/10", 1, "1/2")),
}


@pytest.mark.parametrize("name", TENSORS)
def test_full_tensors_to_fifty_digits(name):
    """The reference has principal axes by Jacobi's rotations to 60 digits and runs up to a million s."""
    inertia, omega = TENSORS[name]
    inertia, omega = [[Fraction(x) for x in row] for row in inertia], [Fraction(x) for x in omega]
    motion = free_body.FreeRigidBody(principal_axes(inertia)).motion(omega, Q0)
    times = [0.0, 0.13, 3.7, -11.3, 1e3, -1e6 / 3, 1e6]
    rates, attitudes = motion.evaluate(times)
    with mp.workdps(60):
        moments, axes = mp.eigsy(mp.matrix([[reference.exactly(x) for x in row] for row in inertia]))
        axes *= mp.det(axes)  # proper
        along = list(axes.T * mp.matrix([reference.exactly(x) for x in omega]))
        square = [1 + axes[0, 0] * a + axes[1, 1] * b + axes[2, 2] * c
                  for a, b, c in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))]  # fmt: skip
        first = max(range(4), key=lambda k: square[k])
        cross = [[square[0], axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]],
                 [axes[2, 1] - axes[1, 2], square[1], axes[0, 1] + axes[1, 0], axes[0, 2] + axes[2, 0]],
                 [axes[0, 2] - axes[2, 0], axes[0, 1] + axes[1, 0], square[2], axes[1, 2] + axes[2, 1]],
                 [axes[1, 0] - axes[0, 1], axes[0, 2] + axes[2, 0], axes[1, 2] + axes[2, 1], square[3]]]  # fmt: skip
        turn = reference.normalised(cross[first])
        start = reference.multiply([reference.exactly(x) for x in Q0], turn)
        expected = reference.motion(list(moments), along, start, 60)
        for t, rate, attitude in zip(times, rates.tolist(), attitudes.tolist(), strict=True):
            w, q = expected(t)
            w, q = list(axes * mp.matrix(w)), reference.multiply(q, [turn[0], *(-x for x in turn[1:])])
            assert max(abs(x - y) for x, y in zip(rate, w, strict=True)) <= BAR * mp.norm(mp.matrix(along))
            assert min(max(abs(x - s * y) for x, y in zip(attitude, q, strict=True)) for s in (1, -1)) <= BAR


def test_only_what_is_asked_in_any_order():
    motion = free_body.motion((1, 2, 3), (0.3, 1.0, 0.5), Q0)
    rates, attitudes = motion.evaluate(SPREAD)
    assert motion.evaluate(SPREAD, omega=False)[0] is None and motion.evaluate(SPREAD, quaternion=False)[1] is None
    order = [3, 3, 0, 6, 1]
    again = motion.evaluate([SPREAD[k] for k in order])
    assert np.abs(again[0] - rates[order]).max() < 4e-16 and np.abs(again[1] - attitudes[order]).max() < 4e-16
    assert motion.evaluate(3.7)[0].shape == (1, 3) and motion.evaluate([])[1].shape == (0, 4)
    assert (np.abs(np.linalg.norm(attitudes, axis=1) - 1) < 5e-16).all()


def test_the_quaternion_is_continuous():
    t = np.linspace(-40, 40, 4001)
    for omega in ((0.3, 1.0, 0.5), (0.01, 1.0, 0.01)):
        attitudes = free_body.motion((1, 2, 3), omega, Q0).evaluate(t)[1]
        assert np.abs(np.diff(attitudes, axis=0)).max() < 0.03


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (((1, 2), (0, 0, 1)), "3 numbers"),
        (((1, 2, math.nan), (0, 0, 1)), "finite"),
        (((1, 2, "x"), (0, 0, 1)), "real numbers"),
        (((1, 2, -3.0), (0, 0, 1)), "positive"),
        (((1, 2, 3), (0, 0, 1), (0, 0, 0, 0)), "not zero"),
    ],
)
def test_bad_input_is_refused(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        free_body.motion(*arguments)
    with pytest.raises(InputError, match="finite"):
        free_body.motion((1, 2, 3), (0, 0, 1)).evaluate([0.0, math.inf])
