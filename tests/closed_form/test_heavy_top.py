"""The symmetric heavy top, compared with 50-digit references: stress tests S18 to S23 of the numerics notes, and laws.

``pytest FILE -o log_cli=true --log-cli-level=INFO`` prints the largest error of each test.
"""

import logging
import math
import random
from fractions import Fraction as F

import numpy as np
import pytest
from mpmath import mp

from symrot.closed_form.heavy_top import motion as heavy_top
from symrot.errors import InputError
from symrot.kinematics import conversions
from tests.reference import heavy_top as reference
from tests.reference import taylor
from tests.reference.free_body import exactly, worst_errors

BAR = 1e-15
LOG = logging.getLogger(__name__)
UPRIGHT, HANGING = (F(1), F(0), F(0), F(0)), (F(0), F(1), F(0), F(0))
TIMES = (F(1, 8), F(5, 2), F(6))


def tilted(angle):
    """Return a rational unit quaternion that tilts the axis about e1 by nearly this angle (rad)."""
    k = F(angle) / 4
    return (1 - k * k) / (1 + k * k), 2 * k / (1 + k * k), F(0), F(0)


def quaternion_to_dcm(q):
    a, b, c, d = q
    n = a * a + b * b + c * c + d * d
    return [
        [(a * a + b * b - c * c - d * d) / n, 2 * (b * c - a * d) / n, 2 * (b * d + a * c) / n],
        [2 * (b * c + a * d) / n, (a * a - b * b + c * c - d * d) / n, 2 * (c * d - a * b) / n],
        [2 * (b * d - a * c) / n, 2 * (c * d + a * b) / n, (a * a - b * b - c * c + d * d) / n],
    ]


def errors(omega, q0, times=TIMES, c=F(1, 2), pull=F(1)):
    """Return the largest errors of omega, relative to |omega0| or sqrt(M/A), and of the attitude matrix, against Taylor
    series.
    """
    omega = [F(x) for x in omega]
    motion = heavy_top.motion((1, 1, c), pull, (0, 0, 1), omega, q0)
    rates, attitudes = motion.evaluate([float(t) for t in times])
    expected = taylor.trajectory(
        [F(1), F(1), F(c)], omega, q0, times, torque=(F(pull), [F(0), F(0), F(1)], [F(0), F(0), F(-1)])
    )
    assert np.isfinite(rates).all() and np.isfinite(attitudes).all()
    with mp.workdps(50):
        size = max(mp.sqrt(sum(exactly(x) ** 2 for x in omega)), mp.sqrt(exactly(F(pull))))
        worst = [0.0, 0.0]
        for rate, attitude, (w, dcm) in zip(rates.tolist(), attitudes.tolist(), expected, strict=True):
            found = quaternion_to_dcm([mp.mpf(x) for x in attitude])
            apart = max(abs(found[i][j] - exactly(dcm[i][j])) for i in range(3) for j in range(3))
            worst[0] = max(worst[0], float(max(abs(x - exactly(y)) for x, y in zip(rate, w, strict=True)) / size))
            worst[1] = max(worst[1], float(apart) / 2)  # an error e of q turns up as 2 e in the matrix
    LOG.info("omega %.1e, q %.1e", *worst)
    return worst


def in_bar(*arguments, **options):
    return max(errors(*arguments, **options)) <= BAR


def long_errors(omega, q0, times, c=F(1, 2), pull=F(1), in_periods=True):
    """Return the same errors against elliptic integrals, at times that are too large for Taylor series."""
    expected = reference.motion(1, c, pull, omega, q0)
    times = [float(expected.period * exactly(t)) if in_periods else float(t) for t in times]
    rates, attitudes = heavy_top.motion((1, 1, c), pull, (0, 0, 1), omega, q0).evaluate(times)
    with mp.workdps(60):
        size = max(mp.sqrt(sum(exactly(F(x)) ** 2 for x in omega)), mp.sqrt(exactly(F(pull))))
        worst = worst_errors(expected, times, rates, attitudes, size)
    LOG.info("omega %.1e, q %.1e", *worst)
    return worst


S18 = {
    "cusps": (0, 0, 5),
    "loops": (F(3, 10), F(-9, 5), 4),
    "waves": (F(3, 10), F(4, 5), 5),
    "backwards": (F(3, 10), F(4, 5), -5),
}


@pytest.mark.thinned(2)
@pytest.mark.parametrize("omega", S18.values(), ids=S18)
def test_s18_cusps_loops_waves(omega):
    assert in_bar(omega, tilted(F(1, 2)))


@pytest.mark.thinned(2)
@pytest.mark.parametrize("omega", S18.values(), ids=S18)
def test_the_reference_agrees_with_taylor_series(omega):
    q0 = tilted(F(1, 2))
    expected = taylor.trajectory(
        [F(1), F(1), F(1, 2)],
        [F(x) for x in omega],
        q0,
        [F(5, 2)],
        torque=(F(1), [F(0), F(0), F(1)], [F(0), F(0), F(-1)]),
    )
    w, q = reference.motion(1, F(1, 2), 1, omega, q0)(F(5, 2))
    with mp.workdps(50):
        dcm = quaternion_to_dcm(q)
        assert max(abs(x - exactly(y)) for x, y in zip(w, expected[0][0], strict=True)) < 1e-38
        assert max(abs(dcm[i][j] - exactly(expected[0][1][i][j])) for i in range(3) for j in range(3)) < 1e-38


@pytest.mark.parametrize("omega", S18.values(), ids=S18)
def test_s18_to_a_thousand_nutations(omega):
    assert max(long_errors(omega, tilted(F(1, 2)), [F(503, 50), F(10003, 10), F(-9999, 10)])) <= BAR


@pytest.mark.campaign
@pytest.mark.parametrize("omega", S18.values(), ids=S18)
def test_s18_to_a_million_nutations(omega):
    assert max(long_errors(omega, tilted(F(1, 2)), [10**5 + F(1, 3), 10**6 + F(1, 3)])) <= BAR


def test_errors_are_seen():
    """A motion with a weight wrong by 1e-13 fails the comparison."""
    expected = reference.motion(1, F(1, 2), 1, S18["loops"], tilted(F(1, 2)))(9)
    with mp.workdps(60):
        close = heavy_top.motion((1, 1, F(1, 2)), 1 + 1e-13, (0, 0, 1), S18["loops"], tilted(F(1, 2))).evaluate(9.0)
        apart = max(abs(x - y) for x, y in zip(close[0][0].tolist(), expected[0], strict=True))
    assert 1e-14 < apart < 1e-11


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "omega, q0",
    [((F(3, 10), F(4, 5), 0), tilted(F(3, 2))), ((F(1, 2), 0, 0), tilted(2)), ((3, 0, 0), tilted(2)),
     ((F(1, 100), 0, 0), UPRIGHT), ((F(1, 10), F(1, 10), 0), HANGING)],
    ids=["spherical", "libration", "rotation", "from upright", "from hanging"],
)  # fmt: skip
def test_s19_pendulums(omega, q0):
    assert in_bar(omega, q0)
    assert in_bar(omega, q0, c=F(0) + F(1, 1000))


@pytest.mark.thinned(3)
@pytest.mark.parametrize("q0", [UPRIGHT, HANGING])
@pytest.mark.parametrize("omega", [(F(5, 2), 0, 1), (F(9, 2), 1, -1), (F(1, 1000), 0, 3), (F(-1, 10), F(1, 10), 10)])
def test_s20_through_the_vertical(omega, q0):
    """The top starts exactly upright or hanging, where alpha or beta is zero and its phase follows from its rate."""
    assert in_bar(omega, q0)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("w3", [F(9, 2), F(401, 100), F(4), F(39, 10), F(3)])
@pytest.mark.parametrize("tilt", [F(1, 10**3), F(1, 10**5), F(1, 10**7)])
def test_s21_sleeping_top(w3, tilt):
    """Tops are above, below and at the limit C omega_3 = sqrt(4 A M); the tilt loses no digits."""
    assert in_bar((0, 0, w3), tilted(tilt))


@pytest.mark.parametrize("omega", [(0, 0, 1), (0, 0, 0), (F(1, 10**6), 0, 2)])
def test_s21_hanging(omega):
    assert in_bar(omega, tilted(F(31415, 10000)))


@pytest.mark.parametrize(
    "w3, tilt", [(F(3), F(1, 10**3)), (F(3), F(1, 10**5)), (F(39, 10), F(1, 10**3)), (F(39, 10), F(1, 10**6))]
)
def test_s21_sleeping_tops_that_fall_for_long(w3, tilt):
    """The tops are near the separatrix, at the end of a thousand falls."""
    assert max(long_errors((0, 0, w3), tilted(tilt), [F(1, 3), F(51, 10), F(10003, 10)])) <= BAR


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("tilt", [1e-8, 1e-11, 1e-14, 1e-17, 1e-22])
@pytest.mark.parametrize("spin", [7.0, 300.0])
def test_small_nutations_keep_their_frequencies(side, tilt, spin):
    """The horizontal part z = x + i y of the axis obeys A z'' - side i C omega_3 z' - side M z = 0 to third order.

    side is 1 for a fast top near the upright position, -1 for one that hangs. The motion starts with z' = 0.
    """
    q0 = (1.0, tilt, 0.0, 0.0) if side > 0 else (tilt, 1.0, 0.0, 0.0)
    times = [0.0, 1.0, 1e3, 1e6, 1e9]
    q = heavy_top.motion((1.0, 1.0, 0.75), 1.0, (0.0, 0.0, 1.0), (0.0, 0.0, spin), q0).evaluate(times)[1]
    found = 2 * (q[:, 1] * q[:, 3] + q[:, 0] * q[:, 2]) + 2j * (q[:, 2] * q[:, 3] - q[:, 0] * q[:, 1])
    with mp.workdps(40):
        momentum = mp.mpf("0.75") * spin * side
        one, two = [(momentum + sign * mp.sqrt(momentum**2 - 4 * side)) / 2 for sign in (1, -1)]
        start = mp.mpc(0, -2 * mp.mpf(tilt) / (1 + mp.mpf(tilt) ** 2))
        expected = [complex(start * (one * mp.expj(two * t) - two * mp.expj(one * t)) / (one - two)) for t in times]
    after = np.abs(times) * tilt**2 * spin  # the frequencies depend on the square of the tilt
    assert (np.abs(found - expected) < (2e-15 + 10 * after) * 2 * tilt).all()


def test_s21_on_the_separatrix():
    """The motions are a pendulum that comes to rest upright, and sleeping tops with just enough energy to become
    upright.
    """
    assert heavy_top.motion((1, 1, F(1, 2)), 1, (0, 0, 1), (2, 0, 0), HANGING).regime == "separatrix"
    assert in_bar((2, 0, 0), HANGING)
    assert in_bar((0, 0, F(4)), UPRIGHT) and in_bar((F(1, 100), 0, F(4)), UPRIGHT)
    final = heavy_top.motion((1, 1, F(1, 2)), 1, (0, 0, 1), (2, 0, 0), HANGING).evaluate([-1e6, 1e6])
    assert np.abs(final[0]).max() < 1e-15


def test_s22_the_norm_of_the_quaternion_does_not_matter():
    motions = []
    for factor in (1, 1 + 1e-15, 1 - 1e-15):
        q0 = [F(factor) * x for x in tilted(F(1, 2))]
        motions.append(heavy_top.motion((1, 1, F(1, 2)), 1, (0, 0, 1), S18["loops"], q0).evaluate([1e3])[1])
    assert (motions[0] == motions[1]).all() and (motions[0] == motions[2]).all()


@pytest.mark.parametrize("w3", [50, 500])
def test_s23_fast_spin(w3):
    assert max(long_errors((0, 0, w3), tilted(F(1)), [F(1, 3), 200], in_periods=False)) <= BAR


@pytest.mark.parametrize("w3", [0, 2])
@pytest.mark.parametrize("digits", [12, 20, 26, 32, 60, 100])
def test_s23_weak_pull(digits, w3):
    assert in_bar((F(6, 5), F(-1, 3), w3), tilted(F(2, 3)), pull=F(1, 10**digits))


@pytest.mark.parametrize("omega, q0", [((0, 0, 3), UPRIGHT), ((0, 0, 0), UPRIGHT), ((0, 0, -2), HANGING)])
def test_what_rests_on_the_vertical_stays(omega, q0):
    motion = heavy_top.motion((1, 1, F(1, 2)), 1, (0, 0, 1), omega, q0)
    assert motion.regime == "steady" and (motion.evaluate([3.0, 1e9])[0] == [float(x) for x in omega]).all()
    assert in_bar(omega, q0)


def test_any_axis_any_direction_of_gravity():
    """The same top with its axis along any body axis, its centre on either side and gravity rotated, moves alike."""
    omega, q0 = S18["loops"], np.array([float(x) for x in tilted(F(1, 2))])
    rates, attitudes = heavy_top.motion((1, 1, 0.5), 1, (0, 0, 1), omega, q0.tolist()).evaluate([2.0, 7.0])
    for axis in range(3):
        named = [(axis + 1) % 3, (axis + 2) % 3, axis]
        matrix = np.eye(3)[:, named]  # components along e1, e2, e3 to those along the body's axes
        moments = [0.5 if k == axis else 1.0 for k in range(3)]
        turned = conversions.multiply(q0, conversions.dcm_to_quaternion(matrix.T))
        found = heavy_top.motion(
            moments, 1, np.eye(3)[axis].tolist(), (matrix @ [float(x) for x in omega]).tolist(), turned.tolist()
        ).evaluate([2.0, 7.0])
        assert np.abs(found[0] - rates @ matrix.T).max() < 1e-13
        expected = conversions.multiply(attitudes, conversions.dcm_to_quaternion(matrix.T))
        assert min(np.abs(found[1] - expected).max(), np.abs(found[1] + expected).max()) < 1e-13
    half = np.array([math.cos(0.6), 0.0, math.sin(0.6), 0.0])
    down = -conversions.quaternion_to_dcm(half)[:, 2]
    leaning = heavy_top.motion(
        (1, 1, 0.5), 1, (0, 0, 1), omega, conversions.multiply(half, q0).tolist(), down.tolist()
    ).evaluate([2.0, 7.0])
    assert np.abs(leaning[0] - rates).max() < 1e-13
    below = heavy_top.motion((1, 1, 0.5), 1, (0, 0, -1), omega, q0.tolist(), (0, 0, 1)).evaluate([2.0, 7.0])
    assert (
        np.abs(below[0] - rates).max() < 1e-15 and np.abs(np.abs((below[1] * attitudes).sum(axis=1)) - 1).max() < 1e-15
    )


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (((1, 2, 3), 1, (0, 0, 1), (0, 0, 1)), "equal moments"),
        (((1, 1, 3), 1, (0, 1, 1), (0, 0, 1)), "one axis"),
        (((-1, -1, 3), 1, (0, 0, 1), (0, 0, 1)), "positive"),
        (((1, 1, 3), 1, (0, 0, 1), (0, 0, 1), (0, 0, 0, 0)), "not zero"),
        (((1, 1, 3), 1, (0, 0, 1), (0, 0, 1), (1, 0, 0, 0), (0, 0, 0)), "direction"),
    ],
)
def test_bad_input_is_refused(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        heavy_top.motion(*arguments)


@pytest.mark.campaign
def test_random_tops():
    """Shape, weight, spin and tilt are random; the motions last up to a thousand nutations."""
    source = random.Random(23)
    for _ in range(300):
        c = F(source.uniform(0.01, 2))
        pull = F(10 ** source.uniform(-2, 2))
        omega = [F(source.choice((1, -1)) * 10 ** source.uniform(-2, 1)) for _ in range(3)]
        q0 = [F(source.gauss(0, 1)) for _ in range(4)]
        assert (
            max(long_errors(omega, q0, [F(source.uniform(-3, 3)), F(source.uniform(-1000, 1000))], c, pull)) <= BAR
        ), (c, pull, omega, q0)
