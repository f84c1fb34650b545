"""Where Euler sequences lock: the derived sets, limits and alternatives agree with numbers and SciPy's conventions."""

import random
from functools import cache

import numpy as np
import pytest
from sympy import FiniteSet, ImageSet, Integers, Interval, Lambda, Matrix, Rational, S, Symbol, cos, oo, pi, sin, zoo

from symrot import symbols as sym
from symrot.conventions import SEQUENCES
from symrot.exact import normal_form
from symrot.kinematics import conversions
from symrot.kinematics.chart import zeros_of
from symrot.kinematics.dossier import singularity_dossier
from symrot.kinematics.euler import dcm as euler_dcm
from symrot.kinematics.euler import lock_indicator, rate_jacobian, sequences_at_lock

phi, theta, psi = sym.angles
TINY = Rational(1, 10**20)


def is_proper(sequence):
    return sequence[0] == sequence[2]


@cache
def on_circle(where, k):
    return where.contains(pi * k / 12) == S.true


@pytest.mark.thinned(8)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_singular_set(sequence):
    """The derivation finds the textbook answer: sin theta = 0 for proper sequences, cos theta = 0 for Tait-Bryan
    sequences.
    """
    found = rate_jacobian(sequence).singular_set
    assert found.points() == ((0, pi) if is_proper(sequence) else (pi / 2, 3 * pi / 2))
    assert isinstance(found.values, ImageSet) and found.values.base_set is S.Integers
    for k in range(-3, 4):
        assert (k * pi in found) == is_proper(sequence)
        assert (k * pi + pi / 2 in found) != is_proper(sequence)
        assert k * pi + pi / 3 not in found
    assert "n any integer" in str(found)


def test_zeros_of_known_equations():
    x = Symbol("x", real=True)
    assert zeros_of(x**2 - 2, x) == FiniteSet(-(2 ** Rational(1, 2)), 2 ** Rational(1, 2))
    assert zeros_of(S(3), x) == S.EmptySet and zeros_of(S.Zero, x) == S.Reals
    assert zeros_of(2 + cos(x), x) == S.EmptySet
    half = zeros_of(sin(x / 2), x)
    n = Symbol("n", integer=True)
    assert half == ImageSet(Lambda(n, 2 * pi * n), Integers)
    assert zeros_of(sin(x / 2), x, Interval.open(0, oo)).base_set is S.Naturals
    slow = zeros_of(sin(x / 3), x)
    assert 3 * pi in slow and 2 * pi not in slow and 6 * pi in slow
    uneven = zeros_of((sin(x) - 1) * sin(x), x)
    assert pi / 2 in uneven and pi in uneven and -pi / 2 not in uneven


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_limits_are_what_the_inverse_does_close_by(sequence):
    """Signs of infinities, finite limits and residues agree with the inverse at 1e-20 rad, to 50 digits."""
    generator = random.Random(sequence)
    for frame in ("body", "space"):
        jacobian = rate_jacobian(sequence, frame)
        assert {(limit.point, limit.side) for limit in jacobian.limits} == {
            (point, side) for point in jacobian.singular_set.points() for side in "-+"
        }
        outer = {angle: Rational(generator.randint(-300, 300), 100) for angle in (phi, psi)}
        for limit in jacobian.limits:
            step = TINY if limit.side == "+" else -TINY
            close = jacobian.inverse.subs({theta: limit.point + step, **outer}).evalf(60)
            for entry, value, residue in zip(limit.limit.subs(outer), close, limit.residue.subs(outer), strict=True):
                if entry.is_infinite:
                    assert (value > 0) == (entry is oo) and abs(value) > 1e15
                else:
                    assert abs(value - entry.evalf(60)) < 1e-18
                assert abs(step * value - residue.evalf(60)) < 1e-18


def test_condition_number_grows_like_two_over_the_distance():
    for sequence in SEQUENCES:
        jacobian = rate_jacobian(sequence)
        for point in jacobian.singular_set.points():
            number = jacobian.condition_number.subs(theta, point + TINY).evalf(60)
            assert abs(number * TINY - 2) < 1e-18
        best = 0 if not is_proper(sequence) else pi / 2
        assert jacobian.condition_number.subs(theta, best) == 1
        at_lock = rate_jacobian(sequence, angles=(phi, jacobian.singular_set.points()[0], psi))
        assert at_lock.determinant == 0 and at_lock.condition_number is oo


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_lock_indicator_tells_the_distance(sequence):
    """det^2 = 1 - indicator^2 holds for every attitude."""
    indicator = lock_indicator(sequence, euler_dcm(sequence))
    assert normal_form(rate_jacobian(sequence).determinant ** 2 - (1 - indicator**2)) == 0


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_alternatives_against_numbers(sequence):
    """For attitudes all around the locked circle, as matrices: numbers show which other sequences lock there too."""
    meetings = sequences_at_lock(sequence)
    assert set(meetings) == set(SEQUENCES) - {sequence}
    circle = np.arange(24) * (np.pi / 12)
    locked = {name: np.zeros(24, dtype=bool) for name in meetings}
    for point in rate_jacobian(sequence).singular_set.points():
        angles = np.zeros((24, 3))
        angles[:, 0 if sequence.isupper() else 2] = circle
        angles[:, 1] = float(point)
        q = conversions.euler_to_quaternion(angles, sequence)
        for name in meetings:
            locked[name] |= conversions.quaternion_to_euler(q, name, lock=1e-7)[1]
    derived = {where: [on_circle(where, k) for k in range(24)] for where in set(meetings.values())}
    for name, where in meetings.items():
        assert derived[where] == locked[name].tolist(), name
    regular = rate_jacobian(sequence).regular_sequences
    assert regular == tuple(name for name in SEQUENCES if name != sequence and not locked[name].any())
    assert len(regular) in (8, 12)  # every sequence has a way out


def test_alternatives_at_given_angles():
    jacobian = rate_jacobian("ZXZ")
    at_identity = jacobian.regular_at((0, 0, 0))
    assert set(at_identity) == {name for name in SEQUENCES if not is_proper(name)}
    tilted = jacobian.regular_at((0, pi / 2, 0))  # a quarter turn about x
    assert "ZXZ" in tilted and "XYX" not in tilted and "ZYZ" in tilted
    assert set(jacobian.regular_at((phi, 0, psi))) >= set(jacobian.regular_sequences)
    assert "ZYZ" not in jacobian.regular_at((phi, 0, psi))
    assert len(jacobian.regular_at((0.3, 1e-300, 0.1))) == 24  # close to lock is not lock


def test_regular_at_agrees_with_numbers():
    generator = random.Random(4)
    jacobian = rate_jacobian("ZYX")
    for _ in range(4):
        angles = [Rational(generator.randint(-6, 6), 12) * pi for _ in range(3)]
        q = conversions.euler_to_quaternion(np.array(angles, dtype=float), "ZYX")
        numeric = {name for name in SEQUENCES if not conversions.quaternion_to_euler(q, name, lock=1e-7)[1]}
        assert set(jacobian.regular_at(angles)) == numeric


# The dossier


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_what_is_lost_at_lock(sequence):
    """Silent rates turn nothing, no rates turn the body about the lost axis, and one combination of angles sets the
    attitude.
    """
    dossier = singularity_dossier(sequence)
    assert [point.middle for point in dossier.locked] == list(dossier.singular_set.points())
    for point in dossier.locked:
        jacobian = rate_jacobian(sequence, angles=(phi, point.middle, psi))
        assert normal_form(jacobian * point.silent_rates) == Matrix([0, 0, 0])
        assert normal_form(point.lost_axis_b.T * jacobian) == Matrix([[0, 0, 0]])
        assert normal_form(point.lost_axis_b.dot(point.lost_axis_b) - 1) == 0
        chi = Symbol("chi", real=True)
        moved = euler_dcm(sequence, (phi + chi, point.middle, psi + chi * point.silent_rates[2]))
        assert normal_form(moved - euler_dcm(sequence, (phi, point.middle, psi))) == Matrix.zeros(3)
        other = euler_dcm(sequence, (phi + chi, point.middle, psi - chi * point.silent_rates[2]))
        assert normal_form(other - euler_dcm(sequence, (phi, point.middle, psi))) != Matrix.zeros(3)
        assert point.combination == phi - psi / point.silent_rates[2]


def test_dossier_text():
    text = singularity_dossier("ZXZ").text()
    for part in (
        "intrinsic Euler sequence ZXZ",
        "det B             -sin(theta)",
        "theta = pi*n, n any integer",
        "the attitude depends on phi + psi alone",
        "the attitude depends on phi - psi alone",
        "Regular wherever ZXZ locks: XYZ YXZ ZXY ZYX xyz yxz zxy zyx",
        "Locked wherever ZXZ locks:  ZYZ zxz zyz",
        "oo*sign(sin(psi))",
    ):
        assert part in text
    assert str(singularity_dossier("ZXZ")) == text
    assert "psi = pi*n, n any integer, phi = 0" in singularity_dossier("zyx").text()
    assert all(zoo not in Matrix(limit.limit).atoms() for limit in singularity_dossier("ZYX").limits)


def test_every_other_sequence_is_in_one_list():
    for sequence in SEQUENCES:
        dossier = singularity_dossier(sequence)
        lists = [*dossier.regular_sequences, *dossier.partly_regular, *dossier.singular_sequences]
        assert sorted(lists) == sorted(set(SEQUENCES) - {sequence})


def test_rates_stay_finite_for_motion_that_the_locked_chart_can_follow():
    """Rates are infinite only for omega with a component along the lost axis, outside the range of B."""
    for sequence in ("ZXZ", "ZYX", "xyz"):
        for point in singularity_dossier(sequence).locked:
            limit = next(x for x in rate_jacobian(sequence).limits if x.point == point.middle)
            jacobian = rate_jacobian(sequence, angles=(phi, point.middle, psi))
            assert normal_form(limit.residue * jacobian) == Matrix.zeros(3)
            assert normal_form(limit.residue * point.lost_axis_b) != Matrix.zeros(3, 1)
