"""Rates of rotation vector, axis-angle and Rodrigues parameters agree exactly with the dcm; numeric rates agree too."""

import random

import numpy as np
import pytest
from mpmath import matrix as mp_matrix
from mpmath import mp, svd_r
from scipy.spatial.transform import Rotation
from sympy import Matrix, Rational, Symbol, cos, exp, eye, limit, oo, pi, sin, sqrt, zeros

from symrot import symbols as sym
from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.exact import normal_form
from symrot.kinematics import attitude, conversions, quaternion, rates, rodrigues, rotation_vector, rotations
from symrot.kinematics.euler import rate_jacobian

FRAMES = ("body", "space")
MINIMAL = ("rotation_vector", "rodrigues", "mrp")
CHARTS = (*attitude.CHARTS, "ZXZ", "zyx")


def seeded_values(chart, seed):
    """Return rational parameters of a generic attitude that obey the relations of the chart."""
    generator = random.Random(seed)
    values = [Rational(generator.randint(-90, 90), 100) for _ in chart.parameters]
    if chart.name == "quaternion":
        values = [Rational(n, 5) for n in generator.sample((1, 2, 2, 4), 4)]
    if chart.name == "axis_angle":
        values = [Rational(2, 3), -Rational(1, 3), Rational(2, 3), Rational(generator.randint(20, 300), 100)]
    return dict(zip(chart.parameters, values, strict=True))


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.campaign] * (name == "mrp")) for name in CHARTS]
)
def test_dcm_is_a_rotation_and_that_of_the_quaternion(name):
    chart = attitude.chart(name)
    assert normal_form(chart.dcm.T * chart.dcm - eye(3), chart.relations) == zeros(3)
    assert normal_form(chart.dcm.det() - 1, chart.relations) == 0
    assert normal_form(quaternion.norm_squared(chart.quaternion) - 1, chart.relations) == 0
    assert normal_form(quaternion.quaternion_to_dcm(chart.quaternion) - chart.dcm, chart.relations) == zeros(3)


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", MINIMAL)
def test_rates_follow_from_the_dcm(name, frame):
    chart = attitude.chart(name)
    columns = (rotations.angular_velocity(chart.dcm, parameter, frame) for parameter in chart.parameters)
    jacobian = chart.rate_matrix(frame)
    assert normal_form(jacobian - Matrix.hstack(*columns)) == zeros(3)
    other = chart.rate_matrix("space" if frame == "body" else "body")
    assert normal_form(jacobian - other) != zeros(3)
    assert normal_form(jacobian - other.T) == zeros(3)  # the mirror of these charts: p -> -p transposes


@pytest.mark.thinned(2)
@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", MINIMAL)
def test_inverse_and_determinant(name, frame):
    jacobian = attitude.chart(name).rate_matrix(frame)
    assert normal_form(jacobian * jacobian.inverse - eye(3)) == zeros(3)
    assert normal_form(jacobian.det(method="berkowitz") - jacobian.determinant) == 0


@pytest.mark.parametrize("frame", FRAMES)
def test_axis_angle_rates(frame):
    """dn is tangent to the sphere; n and alpha are functions of time with the given rates."""
    chart = attitude.chart("axis_angle")
    n, rates_of = Matrix(sym.axis), Matrix(Matrix([Symbol(f"d{s}", real=True) for s in chart.parameters]))
    relations = [*chart.relations, n.dot(rates_of[:3, 0])]
    change = sum((chart.dcm.diff(p) * dp for p, dp in zip(chart.parameters, rates_of, strict=True)), zeros(3))
    omega = rotations.vee(chart.dcm.T * change if frame == "body" else change * chart.dcm.T)
    jacobian = chart.rate_matrix(frame)
    assert normal_form(jacobian * rates_of - omega, relations) == zeros(3, 1)
    assert normal_form(jacobian * jacobian.inverse - eye(3), chart.relations) == zeros(3)
    assert normal_form(n.T * jacobian.inverse[:3, :], chart.relations) == zeros(1, 3)  # the axis stays unit
    bordered = Matrix.vstack(Matrix([[*n, 0]]), jacobian)
    difference = bordered.det(method="berkowitz") ** 2 - jacobian.determinant**2
    assert normal_form(difference, chart.relations) == 0


@pytest.mark.parametrize("name", attitude.CHARTS)
def test_condition_number_is_that_of_the_singular_values(name):
    chart = attitude.chart(name)
    with mp.workdps(50):
        for seed in range(3):
            values = seeded_values(chart, seed)
            jacobian = chart.rate_matrix("body")
            rows = jacobian.as_immutable().subs(values).evalf(50)
            if name == "axis_angle":  # of the rates that keep the axis unit
                n = Matrix([values[component] for component in sym.axis])
                rows = rows * Matrix.diag(eye(3) - n * n.T, 1).evalf(50)
            singular = svd_r(mp_matrix(rows.tolist()), compute_uv=False)
            expected = jacobian.condition_number.subs(values).evalf(50)
            assert abs(max(singular) / min(singular) / expected - 1) < mp.mpf(10) ** -40


def test_singular_sets():
    found = {name: attitude.chart(name).singular_set for name in attitude.CHARTS}
    assert all(found[name].is_empty for name in ("quaternion", "rodrigues", "mrp"))
    assert str(found["mrp"]) == "empty"
    assert found["rotation_vector"].points() == (2 * pi,)  # zero is regular
    assert 0 not in found["rotation_vector"] and 4 * pi in found["rotation_vector"]
    assert found["axis_angle"].points() == (0,) and pi not in found["axis_angle"]
    assert "n = 1, 2, ..." in str(found["rotation_vector"])


def test_unreached_attitudes():
    """Classical Rodrigues parameters miss half turns, modified ones full turns: their divisors vanish there."""
    q0 = sym.quaternion[0]
    assert attitude.chart("rodrigues").unreached == q0
    assert attitude.chart("mrp").unreached == 1 + q0
    assert attitude.chart("quaternion").unreached is None


def test_limits_of_the_rotation_vector():
    """As |v| -> 2 pi, the inverse is 1 along the axis and grows across it as 2 pi over the distance."""
    jacobian = rotation_vector.jacobian()
    on_x = dict(zip(sym.axis, (1, 0, 0), strict=True))
    below, above = jacobian.limits
    assert (below.side, above.side) == ("-", "+")
    assert below.residue.subs(on_x) == Matrix.diag(0, 2 * pi, 2 * pi) == above.residue.subs(on_x)
    assert below.limit.subs(on_x)[1, 1] == -oo and above.limit.subs(on_x)[1, 1] == oo
    assert normal_form(below.residue * Matrix(sym.axis)) == zeros(3, 1)


def test_exponential_map_is_the_series():
    """dcm and right Jacobian agree to 50 digits with sum K^k / k! and sum (-K)^k / (k+1)!."""
    v = [Rational(3, 10), -Rational(7, 10), Rational(11, 10)]
    matrix = rotations.skew(v)
    series, mean, power = zeros(3), zeros(3), eye(3)
    factorial = Rational(1)
    for k in range(60):
        series += power / factorial
        mean += (-1) ** k * power / (factorial * (k + 1))
        power, factorial = power * matrix, factorial * (k + 1)
    assert (rotation_vector.dcm(v).evalf(50) - series.evalf(50)).norm() < Rational(1, 10**45)
    assert (rotation_vector.jacobian("body", v).evalf(50) - mean.evalf(50)).norm() < Rational(1, 10**45)


def test_function_of_skew_on_the_square():
    """The function K^2 itself has the coefficients c0 = c1 = 0 and c2 = 1."""
    a = Symbol("a", positive=True)
    assert rotations.function_of_skew(lambda z: z**2, 0, a) == (0, 0, 1)
    assert rotations.function_of_skew(exp, 1, a) == (1, sin(a) / a, (1 - cos(a)) / a**2)


def test_rotation_vector_is_regular_at_zero():
    size = Symbol("x", positive=True)
    straight = rotation_vector.jacobian("body", (size, 0, 0))
    assert straight.applyfunc(lambda entry: limit(entry, size, 0)) == eye(3)


# Rodrigues parameters


def test_rodrigues_formulas_of_the_literature():
    """Shuster, J. Astronaut. Sci. 41 (1993): kinematic equations of Rodrigues parameters, classical and modified."""
    g, s, one = Matrix(sym.rodrigues), Matrix(sym.mrp), eye(3)
    classical = (one + rotations.skew(g) + g * g.T) / 2
    assert normal_form(attitude.chart("rodrigues").rates("body") - classical) == zeros(3)
    modified = ((1 - s.dot(s)) * one + 2 * rotations.skew(s) + 2 * s * s.T) / 4
    assert normal_form(attitude.chart("mrp").rates("body") - modified) == zeros(3)


def test_definition_by_the_angle():
    """The parameters are axis tan(angle/2) and axis tan(angle/4) for a unit axis."""
    relations = attitude.chart("axis_angle").relations
    for which, share in ((rodrigues.CLASSICAL, 2), (rodrigues.MODIFIED, 4)):
        turn = rotation_vector.quaternion_of_axis_angle(angle=4 * sym.alpha)
        angle = 4 * sym.alpha / share
        expected = Matrix(sym.axis) * sin(angle) / cos(angle)
        assert normal_form(which.of_quaternion(turn) - expected, relations) == zeros(3, 1)


def test_shadow_set():
    """The shadow has the opposite quaternion, so the same attitude, the two lengths multiply to 1, and its own shadow is
    the original set.
    """
    shadow, s = rodrigues.shadow(), Matrix(sym.mrp)
    assert normal_form(rodrigues.MODIFIED.quaternion(shadow) + rodrigues.MODIFIED.quaternion()) == zeros(4, 1)
    assert normal_form(shadow.dot(shadow) * s.dot(s) - 1) == 0
    assert normal_form(rodrigues.shadow(shadow) - s) == zeros(3, 1)
    assert normal_form(rodrigues.MODIFIED.dcm(-s) - rodrigues.MODIFIED.dcm()) != zeros(3)


# Conversions between charts


@pytest.mark.thinned(4)
@pytest.mark.parametrize("target", CHARTS)
@pytest.mark.parametrize("source", CHARTS)
def test_conversions_keep_the_attitude(source, target):
    """Symbolic conversions at rational values: dcm before and after agree to 50 digits."""
    start, end = attitude.chart(source), attitude.chart(target)
    values = seeded_values(start, source + target)
    found = attitude.convert(source, target, tuple(values.values()))
    after = end.dcm.subs(dict(zip(end.parameters, found.evalf(50), strict=True))).evalf(50)
    assert (after - start.dcm.subs(values).evalf(50)).norm() < Rational(1, 10**40)
    assert all(abs(r.subs(dict(zip(end.parameters, found, strict=True))).evalf(50)) < 1e-40 for r in end.relations)


def test_symbolic_and_numeric_conversions_agree():
    """Each numeric conversion agrees with its derived expression."""
    numeric = {
        "rotation_vector": conversions.quaternion_to_rotation_vector,
        "axis_angle": lambda q: np.concatenate([part.ravel() for part in conversions.quaternion_to_axis_angle(q)]),
        "rodrigues": lambda q: conversions.quaternion_to_rodrigues(q)[0],
        "mrp": conversions.quaternion_to_mrp,
        **{s: lambda q, s=s: conversions.quaternion_to_euler(q, s)[0] for s in SEQUENCES},
    }
    q = [Rational(4, 5), Rational(2, 5), Rational(2, 5), Rational(1, 5)]
    for name, convert in numeric.items():
        exact = attitude.chart(name).of_quaternion(q).evalf(30)
        ours = convert(np.array(q, dtype=float))
        assert max(abs(sin((a - Rational(float(b))) / 2)) for a, b in zip(exact, ours, strict=True)) < 1e-15, name


# Numeric rates


@pytest.fixture
def motion():
    generator = np.random.default_rng(11)
    q = generator.normal(size=(50, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True), generator.normal(size=(50, 3))


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_numeric_euler_rates_are_the_derived_ones(sequence, frame, motion):
    _, omega = motion
    angles = np.random.default_rng(2).uniform(0.1, 1.4, size=(50, 3))
    found, infinite = rates.euler_rates(angles, omega, sequence, frame)
    assert not infinite.any()
    inverse = rate_jacobian(sequence, frame).inverse
    for k in range(2):
        expected = inverse.subs(dict(zip(sym.angles, map(float, angles[k]), strict=True))) * Matrix(omega[k])
        np.testing.assert_allclose(found[k], np.array(expected, dtype=float).ravel(), rtol=1e-12, atol=1e-13)
    back = rates.euler_angular_velocity(angles, found, sequence, frame)
    np.testing.assert_allclose(back, omega, rtol=0, atol=1e-13)


def test_locked_rates_are_flagged():
    found, infinite = rates.euler_rates([[0.3, 0.0, 0.2], [0.3, 0.5, 0.2]], [1.0, 2.0, 3.0], "ZXZ")
    assert infinite.tolist() == [True, False]
    assert not np.isfinite(found[0]).all() and np.isfinite(found[1]).all()


@pytest.mark.parametrize("frame", FRAMES)
def test_numeric_quaternion_rates(frame, motion):
    """The rate agrees with a small turn about omega by SciPy, and gives omega back."""
    q, omega = motion
    dq = rates.quaternion_rate(q, omega, frame)
    h = 1e-6
    here = Rotation.from_quat(conversions.to_scipy_order(q))
    step = Rotation.from_rotvec(h * omega)
    after, before = (here * step, here * step.inv()) if frame == "body" else (step * here, step.inv() * here)
    ahead, behind = (conversions.from_scipy_order(r.as_quat()) for r in (after, before))
    ahead *= np.sign(np.sum(ahead * q, axis=1, keepdims=True))
    behind *= np.sign(np.sum(behind * q, axis=1, keepdims=True))
    np.testing.assert_allclose((ahead - behind) / (2 * h), dq, atol=1e-9)
    np.testing.assert_allclose(rates.angular_velocity(q, dq, frame), omega, atol=1e-14)


def test_space_and_body_rates_of_a_tilted_spin():
    """S38: a body tilted about x spins about z of space: omega_s is (0, 0, 1), and omega_b has a y component."""
    q = conversions.euler_to_quaternion([0.0, 0.5, 0.0], "ZXZ")
    dq = rates.quaternion_rate(q, [0.0, 0.0, 1.0], "space")
    np.testing.assert_allclose(rates.angular_velocity(q, dq, "body"), [0, np.sin(0.5), np.cos(0.5)], atol=1e-15)
    np.testing.assert_allclose(rates.euler_rates([0, 0.5, 0], [0, 0, 1.0], "ZXZ", "space")[0], [1, 0, 0], atol=1e-15)


# Bad input


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: attitude.chart("gibbs"), "gibbs"),
        (lambda: attitude.convert("ZXZ", "mrp", (1, 2)), "got 2"),
        (lambda: rodrigues.projection("MRP"), "MRP"),
        (lambda: rotation_vector.jacobian("inertial"), "inertial"),
        (lambda: rotation_vector.axis_angle_jacobian("inertial"), "inertial"),
        (lambda: attitude.chart("mrp").rates("inertial"), "inertial"),
        (lambda: rotation_vector.dcm((1, 2)), "got 2"),
        (lambda: rates.quaternion_rate([1, 0, 0, 0], [0, 0, 1], "inertial"), "inertial"),
        (lambda: rates.euler_rates([0, 0, 0], [0, 0], "ZXZ"), "(2,)"),
    ],
)
def test_bad_input_is_one_sentence(call, words):
    with pytest.raises(InputError) as failure:
        call()
    assert words in str(failure.value) and "\n" not in str(failure.value)


def test_lengths_are_roots():
    assert rotation_vector.length((3, 4, 0)) == 5
    assert rotation_vector.length((1, 1, 0)) == sqrt(2)


def test_conversions_of_values_are_limits_or_refused():
    """The formulas are 0/0 at these values, and convert returned nan in silence."""
    assert list(attitude.convert("rotation_vector", "quaternion", [0, 0, 0])) == [1, 0, 0, 0]
    for target, q in [
        ("axis_angle", (1, 0, 0, 0)),
        ("rodrigues", (0, 1, 0, 0)),
        ("mrp", (-1, 0, 0, 0)),
        ("ZXZ", (1, 0, 0, 0)),
    ]:
        with pytest.raises(
            InputError, match=f"expected an attitude with unique parameters in the description {target}"
        ):
            attitude.convert("quaternion", target, q)
