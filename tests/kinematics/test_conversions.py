"""Numeric conversions agree with 50-digit arithmetic (stress tests S35 to S38) and SciPy; bad rows are refused.

A unit quaternion in doubles is itself known only to 1.1e-16 per component; the bounds are two to four times that.
"""

import subprocess
import sys
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from scipy.spatial.transform import Rotation

from symrot.conventions import EXTRINSIC_SEQUENCES, INTRINSIC_SEQUENCES, SEQUENCES
from symrot.errors import InputError
from symrot.kinematics import conversions as cv
from symrot.kinematics.arrays import BLOCK
from symrot.kinematics.continuity import continuous_quaternion, unwrap_euler
from symrot.kinematics.rotation_vector import rotation_vector_of_quaternion
from tests.reference.quaternions import (
    DIGITS,
    LOCKED,
    apart,
    difference,
    doubles,
    exact_euler,
    exact_exponential,
    exact_unit,
    is_proper,
)


@pytest.fixture(autouse=True)
def strict():
    """Compute with 50 digits, and let any warning fail the test."""
    with mp.workdps(DIGITS), warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.fixture
def attitudes():
    q = np.random.default_rng(7).normal(size=(400, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


# Euler angles


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_rebuilt_rotation_is_exact_at_any_distance_from_lock(sequence):
    """S35: quaternion -> angles -> quaternion at 1e-3 to 1e-17 rad from lock, and at it."""
    rng = np.random.default_rng(35)
    worst = 0
    for lock in LOCKED[is_proper(sequence)]:
        inward = -1 if lock > 0 else 1
        for distance in [0.0, *10.0 ** -np.arange(3, 18)]:
            first, third = rng.uniform(-np.pi, np.pi, 2)
            q = doubles(exact_euler((first, mpf(lock) + inward * mpf(distance), third), sequence))
            angles, _ = cv.quaternion_to_euler(q, sequence)
            worst = max(worst, difference(exact_euler(angles, sequence), exact_unit(q)))
    # 1.1e-16 of the input, and two angles of up to pi, each rounded to 2.2e-16, half of which counts
    assert worst < 4e-16


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_angles_agree_with_50_digits_and_with_scipy(sequence, attitudes):
    angles, locked = cv.quaternion_to_euler(attitudes, sequence)
    assert not locked.any()
    pairs = zip(angles, attitudes, strict=True)
    assert max(difference(exact_euler(a, sequence), exact_unit(q)) for a, q in pairs) < 4e-16  # SciPy: 6e-16
    theirs = Rotation.from_quat(cv.to_scipy_order(attitudes)).as_euler(sequence)
    turns = (angles - theirs) / (2 * np.pi)
    assert np.abs(turns - np.rint(turns)).max() < 1e-13  # some attitudes are within 0.01 of lock
    assert np.abs(angles[:, [0, 2]]).max() <= np.pi
    low, high = LOCKED[is_proper(sequence)]
    assert low <= angles[:, 1].min() and angles[:, 1].max() <= high


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_quaternion_of_angles_agrees_with_50_digits(sequence):
    angles = np.random.default_rng(3).uniform(-7, 7, size=(100, 3))
    q = cv.euler_to_quaternion(angles, sequence)
    assert max(difference(exact_euler(a, sequence), b) for a, b in zip(angles, q, strict=True)) < 4e-16
    scipy = Rotation.from_euler(sequence, angles)
    assert np.abs(cv.euler_to_dcm(angles, sequence) - scipy.as_matrix()).max() < 2e-15


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_at_lock_the_third_angle_is_zero_and_the_mask_is_set(sequence):
    """The choice SciPy makes, found in its own output."""
    rng = np.random.default_rng(5)
    for lock in LOCKED[is_proper(sequence)]:
        given_angles = rng.uniform(-3, 3, size=(40, 3))
        given_angles[:, 1] = lock
        q = cv.euler_to_quaternion(given_angles, sequence)
        angles, locked = cv.quaternion_to_euler(q, sequence)
        assert locked.all() and (angles[:, 2] == 0).all() and (angles[:, 1] == lock).all()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # SciPy warns; we flag
            theirs = Rotation.from_quat(cv.to_scipy_order(q)).as_euler(sequence)
        turns = (angles - theirs) / (2 * np.pi)
        assert np.abs(turns - np.rint(turns)).max() < 1e-15
        assert apart(cv.euler_to_quaternion(angles, sequence), q).max() < 6e-16


def test_one_locked_sample_leaves_the_rest_of_the_batch_alone():
    angles = np.array([[0.3, 0.2, 0.1], [0.3, np.pi / 2, 0.1], [-1.0, -0.4, 2.0]])
    back, locked = cv.quaternion_to_euler(cv.euler_to_quaternion(angles, "ZYX"), "ZYX")
    assert locked.tolist() == [False, True, False]
    np.testing.assert_allclose(back[[0, 2]], angles[[0, 2]], rtol=0, atol=1e-15)


def test_lock_distance_is_the_callers_choice():
    q = cv.euler_to_quaternion([0.3, np.pi / 2 - 1e-8, 0.1], "ZYX")
    assert not cv.quaternion_to_euler(q, "ZYX")[1]
    angles, locked = cv.quaternion_to_euler(q, "ZYX", lock=1e-7)
    assert locked and angles[2] == 0


def test_small_middle_angles_keep_their_digits():
    """Near the identity a pitch of 1e-300 rad is not rounded to zero."""
    for tiny in (1e-8, 1e-100, 1e-300):
        angles, _ = cv.quaternion_to_euler(cv.euler_to_quaternion([0.0, tiny, 0.0], "ZYX"), "ZYX")
        assert angles[1] == pytest.approx(tiny, rel=4e-16)
        angles, _ = cv.quaternion_to_euler(cv.euler_to_quaternion([tiny, 0.0, 0.0], "XYZ"), "XYZ")
        assert angles[0] == pytest.approx(tiny, rel=4e-16)


def test_extrinsic_is_intrinsic_read_backwards(attitudes):
    for extrinsic, intrinsic in zip(EXTRINSIC_SEQUENCES, INTRINSIC_SEQUENCES, strict=True):
        mirrored = intrinsic[::-1]
        ours, _ = cv.quaternion_to_euler(attitudes, extrinsic)
        theirs, _ = cv.quaternion_to_euler(attitudes, mirrored)
        np.testing.assert_array_equal(ours, theirs[:, ::-1])


def test_degrees():
    q = cv.euler_to_quaternion([90, 30, -45], "ZYX", degrees=True)
    assert apart(q, cv.euler_to_quaternion(np.radians([90, 30, -45]), "ZYX")) == 0
    np.testing.assert_allclose(cv.quaternion_to_euler(q, "ZYX", degrees=True)[0], [90, 30, -45], rtol=1e-15)
    np.testing.assert_allclose(cv.quaternion_to_axis_angle([0, 0, 1, 0], degrees=True)[1], 180)


# Logarithm and exponential


@pytest.mark.parametrize("exponent", [1, 2, 4, 7, 8, 15, 16, 17, 50, 100, 150, 154, 160, 200, 250, 299, 300])
def test_log_of_exp_near_zero(exponent):
    """S36: relative error of the vector at angles 1e-1 to 1e-300."""
    axes = np.random.default_rng(exponent).normal(size=(50, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    v = axes * 10.0**-exponent
    back = cv.quaternion_to_rotation_vector(cv.rotation_vector_to_quaternion(v))
    scale = 10.0**exponent
    assert (np.linalg.norm((back - v) * scale, axis=1)).max() < 4e-16


def test_exp_agrees_with_50_digits():
    """Each part relative to itself: the vector part of a tiny turn is not lost."""
    rng = np.random.default_rng(36)
    for size in (1e-300, 1e-160, 1e-20, 1e-8, 1e-3, 0.1, 1.0, 3.0, np.pi, 6.0, 20.0):
        v = rng.normal(size=3)
        v *= size / np.linalg.norm(v)
        q, exact = cv.rotation_vector_to_quaternion(v), exact_exponential(v)
        length = mp.sqrt(sum(x**2 for x in exact[1:]))
        worst = max(abs(mpf(float(a)) - b) for a, b in zip(q[1:], exact[1:], strict=True))
        assert worst < 4e-16 * length * max(1, size)
        assert abs(mpf(float(q[0])) - exact[0]) < 4e-16 * max(1, size)


@pytest.mark.parametrize("distance", [*10.0 ** -np.arange(1, 16), 0.0])
def test_log_of_exp_near_a_half_turn(distance):
    """S37: the rotation to 4e-16, the axis up to its sign."""
    axes = np.random.default_rng(37).normal(size=(30, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    v = axes * (np.pi - distance)
    q = cv.rotation_vector_to_quaternion(v)
    back = cv.quaternion_to_rotation_vector(q)
    assert max(difference(exact_exponential(w), exact_unit(p)) for w, p in zip(back, q, strict=True)) < 4e-16
    assert apart(back, v).max() < 1.2e-15  # length pi, with one ulp of 4.4e-16
    axis, angle = cv.quaternion_to_axis_angle(q)
    assert apart(axis, axes).max() < 4e-16
    np.testing.assert_allclose(angle, np.pi - distance, rtol=3e-16)


def test_exact_half_turn_has_the_axis_with_positive_first_entry():
    for q in ([0, 0, -1, 0], [0, 0, 1, 0], [-0.0, 0, 1, 0]):
        np.testing.assert_array_equal(cv.quaternion_to_rotation_vector(q), [0, np.pi, 0])
        np.testing.assert_array_equal(cv.quaternion_to_dcm(q), np.diag([-1, 1, -1]))


def test_identity_has_the_documented_axis():
    axis, angle = cv.quaternion_to_axis_angle([[1, 0, 0, 0], [-2, 0, 0, 0]])
    np.testing.assert_array_equal(axis, [[1, 0, 0]] * 2)
    np.testing.assert_array_equal(angle, [0, 0])
    np.testing.assert_array_equal(cv.quaternion_to_rotation_vector([-1, 0, 0, 0]), [0, 0, 0])


def test_tiny_angles_survive_axis_angle():
    axis, angle = cv.quaternion_to_axis_angle(cv.axis_angle_to_quaternion([0, 3e200, 4e200], 1e-300))
    np.testing.assert_allclose(axis, [0, 0.6, 0.8], rtol=3e-16)
    assert angle == pytest.approx(1e-300, rel=3e-16)


# Direction cosine matrices


def test_dcm_agrees_with_50_digits(attitudes):
    for q in attitudes[:50]:
        q0, q1, q2, q3 = map(mpf, map(float, q))
        n = q0**2 + q1**2 + q2**2 + q3**2
        exact = [
            [q0**2 + q1**2 - q2**2 - q3**2, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)],
            [2 * (q1 * q2 + q0 * q3), q0**2 - q1**2 + q2**2 - q3**2, 2 * (q2 * q3 - q0 * q1)],
            [2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), q0**2 - q1**2 - q2**2 + q3**2],
        ]
        dcm = cv.quaternion_to_dcm(q)
        assert max(abs(mpf(float(dcm[i, j])) - exact[i][j] / n) for i in range(3) for j in range(3)) < 5e-16


def test_every_pivot_of_the_dcm(attitudes):
    """Half turns about each axis and near them, and generic attitudes: four branches, one answer."""
    near = np.array([np.eye(4)[k] + 1e-9 * np.random.default_rng(k).normal(size=4) for k in range(4)])
    for q in (attitudes, cv.normalize(near), np.eye(4)):
        back = cv.dcm_to_quaternion(cv.quaternion_to_dcm(q))
        assert apart(back, q).max() < 5e-16
        assert (back[:, 0] >= 0).all()


def test_a_tiny_turn_survives_the_dcm():
    v = [1e-200, 0, 2e-200]
    dcm = cv.quaternion_to_dcm(cv.rotation_vector_to_quaternion(v))
    np.testing.assert_allclose(cv.quaternion_to_rotation_vector(cv.dcm_to_quaternion(dcm)), v, rtol=4e-16)


def test_a_reflection_is_no_rotation():
    dcms = np.array([np.diag([1.0, 1, -1]), np.eye(3), np.full((3, 3), np.nan), np.zeros((3, 3))])
    q = cv.dcm_to_quaternion(dcms)
    assert np.isnan(q).all(axis=1).tolist() == [True, False, True, True]
    np.testing.assert_array_equal(q[1], [1, 0, 0, 0])


# Rodrigues parameters


def test_classical_parameters(attitudes):
    g, half_turn = cv.quaternion_to_rodrigues(attitudes)
    assert not half_turn.any()
    assert apart(cv.rodrigues_to_quaternion(g), attitudes).max() < 4e-16
    g, half_turn = cv.quaternion_to_rodrigues([[0, 1, 0, 0], [1, 0, 0, 0], [np.nan, 0, 0, 0]])
    assert half_turn.tolist() == [True, False, False]
    assert np.isnan(g).all(axis=1).tolist() == [True, False, True]


@pytest.mark.parametrize("size", [1e-300, 1e-9, 1.0, 1e9, 1e200, 1e307])
def test_parameters_of_any_size_give_unit_quaternions(size):
    n = np.array([0.6, 0.0, -0.8])
    for convert, share in ((cv.rodrigues_to_quaternion, 2), (cv.mrp_to_quaternion, 4)):
        angle = share * mp.atan(mpf(size))
        exact = [mp.cos(angle / 2), *(mp.sin(angle / 2) * mpf(float(x)) for x in n)]
        assert difference(convert(size * n), exact) < 4e-16


def test_modified_parameters_and_their_shadow(attitudes):
    s = cv.quaternion_to_mrp(attitudes)
    np.testing.assert_allclose(s, Rotation.from_quat(cv.to_scipy_order(attitudes)).as_mrp(), rtol=0, atol=1e-15)
    assert np.linalg.norm(s, axis=1).max() <= 1 + 2e-16
    shadow = cv.mrp_shadow(s)
    for values in (s, shadow):
        assert apart(cv.mrp_to_quaternion(values), cv.normalize(attitudes)).max() < 7e-16  # two roundings of each entry
    signed = cv.quaternion_to_mrp(np.vstack([attitudes, -attitudes]), shadow=False)
    assert np.abs(cv.mrp_to_quaternion(signed) - np.vstack([attitudes, -attitudes])).max() < 4e-16  # sign kept


def test_shadow_switch(attitudes):
    """Sets of length at most 1 stay, longer ones go over; the attitude stays."""
    both = np.concatenate([cv.quaternion_to_mrp(attitudes), cv.mrp_shadow(cv.quaternion_to_mrp(attitudes))])
    short, switched = cv.mrp_switch(both)
    assert not switched[:400].any() and switched[400:].all()
    np.testing.assert_allclose(short[400:], both[:400], rtol=1e-15)
    single, flag = cv.mrp_switch([0.0, 0.0, 4.0])
    assert flag and single.tolist() == [0, 0, -0.25]
    np.testing.assert_array_equal(cv.mrp_switch([0.0, 0.0, 0.0])[0], [0, 0, 0])


def test_modified_parameters_near_a_full_turn_do_not_cancel():
    for angle in (1e-3, 1e-8, 1e-12):
        half = mpf(angle) / 2
        q = doubles([-mp.cos(half), mp.sin(half), 0, 0])  # 2 pi - angle, axis -x
        exact = mp.sin(half) / (1 - mp.cos(half))
        assert cv.quaternion_to_mrp(q, shadow=False)[0] == pytest.approx(float(exact), rel=1e-15)


# All of them


ROUND_TRIPS = {
    "dcm": lambda q: cv.dcm_to_quaternion(cv.quaternion_to_dcm(q)),
    "rotation_vector": lambda q: cv.rotation_vector_to_quaternion(cv.quaternion_to_rotation_vector(q)),
    "axis_angle": lambda q: cv.axis_angle_to_quaternion(*cv.quaternion_to_axis_angle(q)),
    "rodrigues": lambda q: cv.rodrigues_to_quaternion(cv.quaternion_to_rodrigues(q)[0]),
    "mrp": lambda q: cv.mrp_to_quaternion(cv.quaternion_to_mrp(q)),
    "normalize": cv.normalize,
    "canonical": lambda q: cv.normalize(cv.canonical(q)),
    **{s: lambda q, s=s: cv.euler_to_quaternion(cv.quaternion_to_euler(q, s)[0], s) for s in SEQUENCES},
}


@pytest.mark.parametrize("name", ROUND_TRIPS)
def test_bad_rows_stay_in_their_row(name):
    nan, inf = np.nan, np.inf
    q = np.array([[0, 0, 0, 0], [1, 2, 3, 4], [nan, 1, 0, 0], [inf, 0, 0, 0], [-0.5, 0.5, 0.5, 0.5], [1, 0, 0, nan]])
    back = ROUND_TRIPS[name](q)
    bad = [True, False, True, True, False, True]
    if name == "canonical":
        back, bad = back[1:5:3], [False, False]
        q = q[1:5:3]
    assert np.isnan(back).all(axis=1).tolist() == bad
    good = ~np.array(bad)
    assert apart(back[good], q[good] / np.linalg.norm(q[good], axis=1, keepdims=True)).max() < 8e-16


@pytest.mark.parametrize("name", ROUND_TRIPS)
def test_magnitude_does_not_matter(name):
    unit = np.array([0.5, -0.5, 0.1, 0.7])  # norm 1
    for scale in (1e-320, 1e-200, 1e-160, 3.0, 1e150, 1e200, 1e307):
        back = ROUND_TRIPS[name](unit * scale)
        limit = 1e-3 if scale < 1e-308 else 8e-16  # a denormal has few digits itself
        assert apart(back, unit).max() < limit, scale


@pytest.mark.parametrize("name", ROUND_TRIPS)
def test_any_leading_shape(name, attitudes):
    flat = ROUND_TRIPS[name](attitudes[:24])
    np.testing.assert_array_equal(ROUND_TRIPS[name](attitudes[:24].reshape(2, 3, 4, 4)), flat.reshape(2, 3, 4, 4))
    np.testing.assert_array_equal(ROUND_TRIPS[name](attitudes[0]), flat[0])
    assert ROUND_TRIPS[name](np.empty((0, 4))).shape == (0, 4)


def test_blocks_do_not_show(attitudes):
    many = np.tile(attitudes, (2 * BLOCK // len(attitudes) + 3, 1))
    angles, _ = cv.quaternion_to_euler(many, "ZXZ")
    once, _ = cv.quaternion_to_euler(attitudes, "ZXZ")
    np.testing.assert_array_equal(angles, np.tile(once, (len(many) // len(attitudes), 1)))


def test_inputs_are_left_alone(attitudes):
    before = attitudes.copy()
    for convert in ROUND_TRIPS.values():
        convert(attitudes)
    np.testing.assert_array_equal(attitudes, before)


component = st.floats(allow_nan=False, allow_infinity=False, width=64)


@settings(max_examples=150, deadline=None)
@given(q=st.tuples(component, component, component, component), name=st.sampled_from(sorted(ROUND_TRIPS)))
def test_any_finite_quaternion_comes_back(q, name):
    largest = max(map(abs, q))
    back = ROUND_TRIPS[name](np.array(q))
    if largest == 0:
        assert name == "canonical" or np.isnan(back).all()
        return
    with mp.workdps(DIGITS):
        exact = exact_unit(q)
        if name == "rodrigues" and np.isnan(back).all():
            assert abs(exact[0]) < 1e-300  # a half turn has none
            return
        assert difference(back, exact) < 1e-15


# Conventions


def test_chirality():
    """S38: a quarter turn about z takes body x to space y; scalar first; Hamilton."""
    h = np.sqrt(0.5)
    quarter = [h, 0, 0, h]
    np.testing.assert_allclose(cv.quaternion_to_dcm(quarter) @ [1, 0, 0], [0, 1, 0], atol=3e-16)
    np.testing.assert_array_equal(cv.multiply([0, 1, 0, 0], [0, 0, 1, 0]), [0, 0, 0, 1])
    np.testing.assert_allclose(cv.to_scipy_order(quarter), Rotation.from_euler("z", 90, degrees=True).as_quat())
    np.testing.assert_array_equal(cv.from_scipy_order(cv.to_scipy_order([1, 2, 3, 4])), [1, 2, 3, 4])


def test_product_composes_as_matrices_do(attitudes):
    p, q = attitudes[::2], attitudes[1::2]
    ours = cv.quaternion_to_dcm(cv.multiply(p, q))
    np.testing.assert_allclose(ours, cv.quaternion_to_dcm(p) @ cv.quaternion_to_dcm(q), atol=2e-15)


# Continuity along a trajectory


def test_signs_of_quaternions_become_continuous():
    t = np.linspace(0, 40, 400)
    smooth = cv.rotation_vector_to_quaternion(np.outer(t, [0.6, 0.0, 0.8]))
    flipped = smooth * np.where(np.random.default_rng(1).random(400) < 0.5, -1, 1)[:, None]
    flipped[0] = smooth[0]
    np.testing.assert_array_equal(continuous_quaternion(flipped), smooth)
    with pytest.raises(AssertionError):
        np.testing.assert_array_equal(flipped, smooth)


@pytest.mark.parametrize("sequence", ["ZXZ", "zxz", "ZYX", "xyz", "YXY", "XZY"])
def test_angles_become_continuous_through_their_branch_and_lock(sequence):
    """Smooth angles that leave the principal ranges, and pass lock between samples, come back up to one constant."""
    t = np.linspace(0, 20, 2000)
    smooth = np.stack([0.3 + 1.7 * t, 0.4 + 0.9 * t, 0.1 - 2.3 * t], axis=1)
    angles, _ = cv.quaternion_to_euler(cv.euler_to_quaternion(smooth, sequence), sequence)
    assert np.abs(np.diff(angles, axis=0)).max() > 1  # jumps
    found = unwrap_euler(angles, sequence)
    assert np.abs(np.diff(found, axis=0)).max() < 0.03
    assert apart(cv.euler_to_quaternion(found, sequence), cv.euler_to_quaternion(smooth, sequence)).max() < 1e-13
    np.testing.assert_allclose(np.diff(found, axis=0), np.diff(smooth, axis=0), atol=1e-11)


@pytest.mark.parametrize("sequence", ["ZXZ", "zxz", "ZYX", "xyz", "zyx", "YXY", "xzx"])
def test_locked_samples_take_their_third_angle_from_before(sequence):
    low, high = LOCKED[is_proper(sequence)]
    for lock, inside in ((low, 0.3), (high, -0.3)):
        middle = lock + np.linspace(inside, -inside, 31)
        smooth = np.stack([np.linspace(0.2, 0.5, 31), middle, np.full(31, 0.7)], axis=1)
        smooth[15, 1] = lock
        angles, locked = cv.quaternion_to_euler(cv.euler_to_quaternion(smooth, sequence), sequence)
        assert locked.sum() == 1 and locked[15] and angles[15, 2] == 0
        found = unwrap_euler(angles, sequence, locked)
        np.testing.assert_allclose(np.diff(found, axis=0), np.diff(smooth, axis=0), atol=1e-13)


# Bad input


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: cv.normalize([1, 2, 3]), "(3,)"),
        (lambda: cv.normalize(1.0), "()"),
        (lambda: cv.normalize([[1, 2, 3, 4], [1, 2]]), "list"),
        (lambda: cv.normalize("1234"), "str"),
        (lambda: cv.normalize([1j, 0, 0, 0]), "list"),
        (lambda: cv.quaternion_to_euler([1, 0, 0, 0], "ZYY"), "ZYY"),
        (lambda: cv.euler_to_quaternion([1, 0, 0], "zYx"), "zYx"),
        (lambda: cv.dcm_to_quaternion(np.eye(4)), "(4, 4)"),
        (lambda: cv.dcm_to_quaternion([1.0] * 9), "(9,)"),
        (lambda: cv.rotation_vector_to_quaternion(np.zeros((5, 4))), "(5, 4)"),
    ],
)
def test_wrong_shapes_are_one_sentence(call, words):
    with pytest.raises(InputError) as failure:
        call()
    assert words in str(failure.value) and "\n" not in str(failure.value)


def test_neither_sympy_nor_scipy_is_imported():
    names = "symrot.kinematics.conversions, symrot.kinematics.continuity, symrot.kinematics.rates"
    code = f"import sys, {names}; print([m for m in ('sympy', 'scipy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_rotation_vector_of_the_identity_is_zero():
    """The axis is undefined there, but the rotation vector has a limit."""
    assert list(rotation_vector_of_quaternion([2, 0, 0, 0])) == [0, 0, 0]
