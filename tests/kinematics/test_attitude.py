"""Euler sequences and quaternions: every formula agrees exactly with the definition ``omega = vee(dcm^T d(dcm)/dt)``."""

import pickle
import random
import subprocess
import sys

import pytest
from mpmath import matrix as mp_matrix
from mpmath import mp, svd_r
from sympy import (
    ImmutableMatrix,
    Matrix,
    Rational,
    Symbol,
    cos,
    diff,
    eye,
    pi,
    preorder_traversal,
    sin,
    symbols,
    zeros,
)

from symrot import symbols as sym
from symrot.conventions import EXTRINSIC_SEQUENCES, INTRINSIC_SEQUENCES, SEQUENCES
from symrot.errors import InputError
from symrot.exact import normal_form
from symrot.kinematics import euler, quaternion, rotation_vector, rotations
from symrot.kinematics.euler import dcm, rate_jacobian

phi, theta, psi = sym.angles
FRAMES = ("body", "space")


def omega_by_definition(dcm_sb, parameters, frame):
    return Matrix.hstack(*(rotations.angular_velocity(dcm_sb, parameter, frame) for parameter in parameters))


def numbers(expression, values):
    """Return the matrix to 50 digits, as a matrix of mpmath."""
    return mp_matrix(expression.subs(values).evalf(50).tolist())


# Bricks


def test_elementary_rotations_turn_right_handed():
    """A quarter turn about x takes y to z, about y takes z to x, and about z takes x to y."""
    for axis in range(3):
        following, after = (axis + 1) % 3, (axis + 2) % 3
        turned = rotations.elementary_rotation(axis, pi / 2) * rotations.unit_vector(following)
        assert turned == rotations.unit_vector(after)


@pytest.mark.parametrize("letter", "xyzXYZ")
def test_axes_by_letter(letter):
    assert rotations.elementary_rotation(letter, phi) == rotations.elementary_rotation("xyz".index(letter.lower()), phi)


def test_skew_is_the_cross_product_and_vee_its_inverse():
    a, b = Matrix(symbols("a1:4")), Matrix(symbols("b1:4"))
    assert rotations.skew(a) * b == a.cross(b)
    assert rotations.vee(rotations.skew(a)) == ImmutableMatrix(a)


def test_elementary_rotation_is_the_exponential():
    for axis in range(3):
        generator = rotations.skew(rotations.unit_vector(axis)) * phi
        assert normal_form(generator.exp().rewrite(cos) - rotations.elementary_rotation(axis, phi)) == zeros(3)


# Euler sequences


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_dcm_is_a_rotation_in_the_named_order(sequence):
    dcm_sb = dcm(sequence)
    assert normal_form(dcm_sb.T * dcm_sb - eye(3)) == zeros(3)
    assert normal_form(dcm_sb.det() - 1) == 0
    turns = [rotations.elementary_rotation(axis, angle) for axis, angle in zip(sequence, sym.angles, strict=True)]
    first, second, third = turns
    assert dcm_sb == (first * second * third if sequence.isupper() else third * second * first)


def test_extrinsic_is_intrinsic_read_backwards():
    for extrinsic, intrinsic in zip(EXTRINSIC_SEQUENCES, INTRINSIC_SEQUENCES, strict=True):
        assert dcm(extrinsic, (phi, theta, psi)) == dcm(intrinsic[::-1], (psi, theta, phi))


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_rate_jacobian_follows_from_the_dcm(sequence, frame):
    jacobian = rate_jacobian(sequence, frame)
    assert normal_form(jacobian - omega_by_definition(dcm(sequence), sym.angles, frame)) == zeros(3)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_inverse_and_determinant(sequence, frame):
    jacobian = rate_jacobian(sequence, frame)
    assert normal_form(jacobian * jacobian.inverse - eye(3)) == zeros(3)
    assert normal_form(jacobian.inverse * jacobian - eye(3)) == zeros(3)
    assert normal_form(jacobian.det() - jacobian.determinant) == 0
    assert jacobian.determinant in {f(theta) * sign for f in (sin, cos) for sign in (1, -1)}


def test_space_jacobian_is_the_turned_body_jacobian():
    for sequence in SEQUENCES:
        turned = dcm(sequence) * rate_jacobian(sequence, "body")
        assert normal_form(turned - rate_jacobian(sequence, "space")) == zeros(3)


def test_a_wrong_jacobian_is_not_proven():
    """The proof fails for the other frame, the transpose and a flipped sign."""
    for sequence in ("ZXZ", "ZYX", "xyz"):
        truth = omega_by_definition(dcm(sequence), sym.angles, "body")
        body = rate_jacobian(sequence, "body")
        flipped = body.as_mutable()
        flipped[:, 1] *= -1
        for wrong in (rate_jacobian(sequence, "space"), body.T, flipped):
            assert normal_form(wrong - truth) != zeros(3)


def test_landau_lifshitz_35_1():
    """Mechanics, 3rd ed., eq. (35.1), gives omega in body axes for ZXZ."""
    dphi, dtheta, dpsi = sym.angle_rates
    omega_b = rate_jacobian("ZXZ") * Matrix(sym.angle_rates)
    printed = Matrix(
        [
            dphi * sin(theta) * sin(psi) + dtheta * cos(psi),
            dphi * sin(theta) * cos(psi) - dtheta * sin(psi),
            dphi * cos(theta) + dpsi,
        ]
    )
    assert normal_form(omega_b - printed) == zeros(3, 1)


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_inverse_is_compact(sequence):
    """Each entry has at most three factors, one division by one trigonometric function, and no sum of squares."""
    for frame in FRAMES:
        inverse = rate_jacobian(sequence, frame).inverse
        assert not any(node.is_Add for entry in inverse for node in preorder_traversal(entry))
        assert max(len(entry.as_ordered_factors()) for entry in inverse) <= 4
        assert {entry.as_numer_denom()[1] for entry in inverse} <= {1, sin(theta), cos(theta)}


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_condition_number_is_that_of_the_singular_values(sequence):
    generator = random.Random(sequence)
    with mp.workdps(50):
        for _ in range(3):
            values = {angle: Rational(generator.randint(-300, 300), 100) for angle in sym.angles}
            for frame in FRAMES:
                jacobian = rate_jacobian(sequence, frame)
                singular = svd_r(numbers(jacobian.as_immutable(), values), compute_uv=False)
                expected = jacobian.condition_number.subs(values).evalf(50)
                assert abs(singular[0] / singular[2] / expected - 1) < mp.mpf(10) ** -40


def test_angles_may_be_functions_of_time():
    """omega = B dq/dt holds with q(t), by the chain rule."""
    t = Symbol("t", real=True)
    moving = [sin(t), t**2, 3 * t]
    dcm_sb = dcm("ZYX", moving)
    omega_b = rotations.vee(dcm_sb.T * diff(dcm_sb, t))
    assert normal_form(omega_b - rate_jacobian("ZYX", angles=moving) * Matrix(moving).diff(t)) == zeros(3, 1)


def test_all_sequences_are_derived_within_two_seconds():
    """A fresh process has no caches; its processor time counts, since other programs share the machine."""
    code = (
        "import time; from symrot.conventions import SEQUENCES; from symrot.kinematics.euler import rate_jacobian\n"
        "start = time.process_time()\n"
        "for s in SEQUENCES:\n"
        "    for f in ('body', 'space'):\n"
        "        B = rate_jacobian(s, f); B.inverse, B.determinant\n"
        "print(time.process_time() - start)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert float(done.stdout) < 2


def test_the_jacobian_is_an_immutable_matrix_that_survives_copies():
    jacobian = rate_jacobian("ZXZ")
    again = pickle.loads(pickle.dumps(jacobian))
    assert again == jacobian and hash(again) == hash(jacobian) and again.inverse == jacobian.inverse
    assert type(jacobian * jacobian) is ImmutableMatrix and type(jacobian.T) is ImmutableMatrix
    assert jacobian.subs(theta, 0) == rate_jacobian("ZXZ", angles=(phi, 0, psi))
    assert jacobian.func(*jacobian.args) == jacobian
    with pytest.raises(TypeError):
        jacobian[0, 0] = 1


# Quaternions


def test_hamilton():
    """i j = k, j k = i, k i = j, i i = j j = k k = i j k = -1."""
    one, i, j, k = (ImmutableMatrix(eye(4).col(n)) for n in range(4))
    assert (
        quaternion.quaternion_product(i, j) == k
        and quaternion.quaternion_product(j, k) == i
        and quaternion.quaternion_product(k, i) == j
    )
    assert all(quaternion.quaternion_product(unit, unit) == -one for unit in (i, j, k))
    assert quaternion.quaternion_product(i, j, k) == -one
    assert quaternion.quaternion_product() == one


def test_norm_is_multiplicative_and_product_associative():
    a, b, c = (symbols(f"{name}0:4", real=True) for name in "abc")
    product = quaternion.quaternion_product(a, b)
    assert normal_form(quaternion.norm_squared(product) - quaternion.norm_squared(a) * quaternion.norm_squared(b)) == 0
    assert normal_form(
        quaternion.quaternion_product(product, c)
        - quaternion.quaternion_product(a, quaternion.quaternion_product(b, c))
    ) == zeros(4, 1)
    assert quaternion.right_matrix(b) * Matrix(a) == product
    reversed_product = quaternion.quaternion_product(quaternion.conjugate(b), quaternion.conjugate(a))
    assert normal_form(quaternion.conjugate(product) - reversed_product) == zeros(4, 1)


def test_dcm_of_a_quaternion():
    q, unit = sym.quaternion, [quaternion.unit_relation()]
    homogeneous = quaternion.quaternion_to_dcm(form="homogeneous")
    square = quaternion.norm_squared(q)
    assert normal_form(homogeneous.T * homogeneous - square**2 * eye(3)) == zeros(3)
    assert normal_form(quaternion.quaternion_to_dcm() - homogeneous, unit) == zeros(3)
    assert normal_form(quaternion.quaternion_to_dcm() - homogeneous) != zeros(3)  # needs the unit norm
    normalised = quaternion.quaternion_to_dcm(form="normalised")
    assert normal_form(normalised.T * normalised - eye(3)) == zeros(3)
    p = symbols("p0:4", real=True)
    composed = quaternion.quaternion_to_dcm(quaternion.quaternion_product(p, q), "homogeneous")
    assert normal_form(composed - quaternion.quaternion_to_dcm(p, "homogeneous") * homogeneous) == zeros(3)


def test_dcm_of_a_quaternion_against_goldstein():
    """The transpose of Goldstein, Classical Mechanics, 3rd ed., eq. (4.47): A = dcm_bs in e0..e3; entry (1, 2)."""
    q0, q1, q2, q3 = sym.quaternion
    assert normal_form(quaternion.quaternion_to_dcm(form="homogeneous").T[0, 1] - 2 * (q1 * q2 + q0 * q3)) == 0


def test_quaternion_rates_follow_from_the_dcm():
    """Unit dq/dt by omega turns the dcm by omega, in both frames; the norm of any q stays."""
    unit = [quaternion.unit_relation()]
    for frame, omega in (("body", sym.omega_b), ("space", sym.omega_s)):
        rate = quaternion.quaternion_rates(frame) * Matrix(omega)
        dcm_sb = quaternion.quaternion_to_dcm(form="homogeneous")
        change = sum((dcm_sb.diff(q) * dq for q, dq in zip(sym.quaternion, rate, strict=True)), zeros(3))
        spin = rotations.skew(omega)
        expected = dcm_sb * spin if frame == "body" else spin * dcm_sb
        assert normal_form(change - expected, unit) == zeros(3)
        assert normal_form(Matrix(sym.quaternion).dot(rate)) == 0
    wrong = quaternion.quaternion_rates("space") * Matrix(sym.omega_b)
    assert normal_form(wrong - quaternion.quaternion_rates("body") * Matrix(sym.omega_b)) != zeros(4, 1)


@pytest.mark.parametrize("frame", FRAMES)
def test_quaternion_rate_jacobian(frame):
    jacobian, unit = quaternion.quaternion_rate_jacobian(frame), [quaternion.unit_relation()]
    assert normal_form(jacobian * jacobian.inverse - eye(3), unit) == zeros(3)
    assert jacobian.determinant == 16 and jacobian.condition_number == 1 and jacobian.singular_set.is_empty
    bordered = Matrix.vstack(2 * Matrix([sym.quaternion]), jacobian)
    assert normal_form(bordered.det(method="berkowitz") - 16, unit) == 0


def test_quaternion_of_dcm_on_every_branch():
    """For unit q, the branch of pivot i gives q up to the sign of q_i, for each i."""
    q, unit = Matrix(sym.quaternion), [quaternion.unit_relation()]
    for pivot in range(4):
        branch = quaternion.quaternion_of_dcm(quaternion.quaternion_to_dcm(), pivot)
        scaled = branch * branch[pivot]  # the square root drops out
        assert normal_form(scaled - q[pivot] * q, unit) == zeros(4, 1)


# Between Euler angles, quaternions and dcms


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_quaternion_of_euler_has_the_dcm_of_the_sequence(sequence):
    q = euler.quaternion_of_euler(sequence)
    assert normal_form(quaternion.norm_squared(q) - 1) == 0
    assert normal_form(quaternion.quaternion_to_dcm(q) - dcm(sequence)) == zeros(3)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_angles_come_back_from_quaternion_and_dcm(sequence):
    proper = sequence[0] == sequence[2]
    generator = random.Random(sequence)
    with mp.workdps(50):
        for _ in range(2):
            middle = generator.randint(5, 150) if proper else generator.randint(-150, 150)
            hundredths = (generator.randint(-300, 300), middle, generator.randint(-300, 300))
            given = [Rational(value, 100) for value in hundredths]
            q = euler.quaternion_of_euler(sequence, given).evalf(50)
            of_dcm = euler.euler_of_dcm(sequence, dcm(sequence, given))
            for found in (euler.euler_of_quaternion(sequence, 3 * q), of_dcm):
                for back, angle in zip(found, given, strict=True):
                    assert abs(mp.sin((back.evalf(50) - angle) / 2)) < mp.mpf(10) ** -40
                assert abs(found[1].evalf(50) - given[1]) < mp.mpf(10) ** -40  # in its range


@pytest.mark.parametrize("frame", ["body", "space"])
def test_the_zero_rotation_vector_is_the_identity(frame):
    """The formulas divide by the length of the vector; at zero their limit counts."""
    assert rotation_vector.dcm((0, 0, 0)) == eye(3)
    assert list(rotation_vector.quaternion_of_rotation_vector((0, 0, 0))) == [1, 0, 0, 0]
    jacobian = rotation_vector.jacobian(frame, (0, 0, 0))
    assert jacobian == jacobian.inverse == eye(3) and jacobian.determinant == 1


# Bad input


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: dcm("ZZX"), "ZZX"),
        (lambda: dcm("ZxZ"), "ZxZ"),
        (lambda: dcm("ZXZ", (phi, theta)), "expected 3 values for the Euler sequence ZXZ, got 2"),
        (lambda: rate_jacobian("ZXZ", "world"), "world"),
        (lambda: quaternion.quaternion_rates("inertial"), "inertial"),
        (lambda: quaternion.quaternion_to_dcm(form="euclidean"), "euclidean"),
        (lambda: quaternion.quaternion_product((1, 0, 0)), "got 3"),
        (lambda: quaternion.quaternion_of_dcm(eye(4)), "(4, 4)"),
        (lambda: quaternion.quaternion_of_dcm(eye(3), 4), "got 4"),
        (lambda: rotations.elementary_rotation(3, phi), "got 3"),
        (lambda: rotations.elementary_rotation("w", phi), "'w'"),
        (lambda: rotations.vee(eye(2)), "(2, 2)"),
        (lambda: rate_jacobian("ZXZ", angles=(phi, 0, psi)).inverse, "determinant is 0"),
    ],
)
def test_bad_input_is_one_sentence(call, words):
    with pytest.raises(InputError) as failure:
        call()
    assert words in str(failure.value) and "\n" not in str(failure.value)
