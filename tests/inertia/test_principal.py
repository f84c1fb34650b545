"""Principal axes: accurate for any gap between moments, right-handed, of exact class; tensors that no body has are
refused.
"""

from fractions import Fraction as F
from random import Random

import mpmath
import numpy as np
import pytest

from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.inertia import tensor
from symrot.inertia.principal import principal_axes, require_admissible, why_not_propagable

SPECTRA = [
    (1, 2, F(5, 2)),
    (1, 1 + F(1, 10**9), F(3, 2)),
    (1, 1 + F(1, 10**18), F(3, 2)),
    (1, 1 + F(1, 10**40), 1 + F(1, 10**20)),
    (F(1, 10**12), 1, 1 + F(1, 10**15)),
    (2, 2, 3),
    (2, 3, 3),
    (5, 5, 5),
    (0, 1, 1),
    (1, 2, 3),
]


def diagonal(moments):
    return tuple(tuple(F(moments[i]) if i == j else F(0) for j in range(3)) for i in range(3))


def random_rotation(seed):
    """Return an exact rational rotation, made from a quaternion of small integers."""
    random = Random(seed)
    a, b, c, d = (random.randint(-9, 9) for _ in range(4))
    a = a or 1
    n = a * a + b * b + c * c + d * d
    rows = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )
    return tuple(tuple(F(entry, n) for entry in row) for row in rows)


def check_axes(inertia, body):
    """Check that the axes are orthonormal, right-handed and diagonalise the tensor to 1e-100, far below the rounding of
    doubles.
    """
    tiny = F(1, 10**100)
    axes = body.axes
    square = tensor.subtract(tensor.multiply(tensor.transpose(axes), axes), tensor.IDENTITY)
    assert max(abs(entry) for row in square for entry in row) < tiny
    assert abs(tensor.determinant(axes) - 1) < tiny
    turned = tensor.rotate(diagonal(body.moments), axes)
    off = tensor.subtract(turned, inertia)
    # equal moments are made exactly equal, which moves them by less than 2^-200
    assert max(abs(entry) for row in off for entry in row) < max(body.moments) * F(1, 2**199)


@pytest.mark.parametrize("moments", SPECTRA, ids=str)
@pytest.mark.parametrize("seed", range(4))
def test_the_moments_return_from_any_rational_rotation(moments, seed):
    """Whatever their gap, the moments return exactly, with the class of the body and its axis of symmetry."""
    rotation = random_rotation(seed)
    inertia = tensor.rotate(diagonal(moments), rotation)
    body = principal_axes(inertia)
    assert sorted(body.moments) == sorted(map(F, moments))
    check_axes(inertia, body)
    distinct = len(set(moments))
    assert body.kind == {1: "spherical", 2: "symmetric", 3: "asymmetric"}[distinct]
    if body.kind == "symmetric":
        single = next(moment for moment in moments if moments.count(moment) == 1)
        assert body.moments[body.symmetry_axis] == single
    else:
        assert body.symmetry_axis is None
    require_admissible(body)


@pytest.mark.parametrize("seed", range(10))
def test_axes_agree_with_mpmath(seed):
    """For random tensors of three points: 50-digit eigenvalues by mpmath, and axes by NumPy up to sign."""
    random = np.random.default_rng(seed)
    points = [[F(int(v), 7) for v in row] for row in random.integers(-20, 20, (4, 3))]
    total = diagonal((0, 0, 0))
    for point in points:
        total = tensor.add(total, tensor.inertia_of_point(1, point))
    body = principal_axes(total)
    check_axes(total, body)
    with mpmath.workdps(50):
        matrix = mpmath.matrix([[mpmath.mpf(e.numerator) / e.denominator for e in row] for row in total])
        expected = sorted(mpmath.eigsy(matrix, eigvals_only=True))
        for ours, theirs in zip(sorted(body.moments), expected, strict=True):
            assert float(ours) == float(theirs)
    values, vectors = np.linalg.eigh(np.array(total, float))
    ours = np.array(body.axes, float)[:, np.argsort([float(m) for m in body.moments])]
    gap = min(np.diff(values)) / values.max()
    assert np.allclose(abs(ours.T @ vectors), np.eye(3), atol=1e-13 / gap)


def test_float_axes_are_orthonormal_to_an_ulp_for_a_near_degenerate_tensor():
    """The exact axes are rounded to doubles, so a gap of 1e-18 between moments does no harm."""
    inertia = tensor.rotate(diagonal((1, 1 + F(1, 10**18), F(3, 2))), random_rotation(3))
    axes = np.array(principal_axes(inertia).axes, float)
    assert abs(axes.T @ axes - np.eye(3)).max() < 4e-16
    assert np.linalg.det(axes) == pytest.approx(1, abs=1e-15)


def test_diagonal_tensors_keep_their_axes_and_order():
    """The axes are the identity, and the moments stay as given, unsorted."""
    body = principal_axes([[3, 0, 0], [0, "1/3", 0], [0, 0, 3]])
    assert (body.moments, body.axes) == ((3, F(1, 3), 3), tensor.IDENTITY)
    assert (body.given_axes, body.kind, body.symmetry_axis) == (True, "symmetric", 1)


def test_axes_stay_close_to_the_given_ones():
    """A small rotation is found as a small rotation, not as a permutation of the axes."""
    c, s = number.cos(F(1, 100)), number.sin(F(1, 100))
    inertia = tensor.rotate(diagonal((3, 1, F(5, 2))), ((c, -s, 0), (s, c, 0), (0, 0, 1)))
    body = principal_axes(inertia)
    assert not body.given_axes
    assert np.allclose(np.array(body.axes, float), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]], float), atol=1e-15)
    assert body.axes[2] == (0, 0, 1)


def test_a_moment_that_differs_in_the_last_digit_makes_the_body_asymmetric():
    """Moments that differ by 1e-50 are unequal; a difference of 2^-210 counts as rounding."""
    assert principal_axes(diagonal((1, 1 + F(1, 10**50), F(3, 2)))).kind == "asymmetric"
    assert principal_axes(diagonal((1, 1 + F(1, 2**210), F(3, 2)))).kind == "symmetric"


@pytest.mark.parametrize(
    ("moments", "flat", "needle"),
    [((1, 2, 3), True, False), ((0, 1, 1), True, True), ((1, 1, 1), False, False), ((0, 0, 0), True, True)],
)
def test_thin_bodies_are_recognised(moments, flat, needle):
    """A flat body's largest moment is the sum of the others; a needle has a zero moment and cannot be propagated."""
    body = principal_axes(tensor.rotate(diagonal(moments), random_rotation(1)))
    assert (body.flat, body.needle) == (flat, needle)
    require_admissible(body)
    assert bool(why_not_propagable(body)) == needle


def test_why_a_needle_cannot_be_propagated():
    """The reason names the moments; a single point has a reason of its own."""
    assert "0, 1, 1 kg m^2" in why_not_propagable(principal_axes(diagonal((0, 1, 1))))
    assert "point" in why_not_propagable(principal_axes(diagonal((0, 0, 0))))


@pytest.mark.parametrize(
    ("moments", "sentence"),
    [
        ((-1, 2, 2), "not negative, got -1, 2, 2 kg m"),
        ((1, 1, 5), r"got 1, 1, 5 kg m\^2, where 5 exceeds 1 \+ 1 by 3"),
        (("0.3333", "0.3333", "0.6667"), "by 0.0001"),
        ((0, 1, 2), "2 exceeds 0 \\+ 1"),
        ((1, 1, 2 + F(1, 2**190)), "exceeds"),
    ],
)
def test_moments_that_no_body_has_are_refused(moments, sentence):
    """They are refused both in the given axes and rotated."""
    values = tuple(number.read(moment) for moment in moments)
    with pytest.raises(InputError, match="s.toml: body.principal: expected principal moments.*" + sentence):
        require_admissible(principal_axes(diagonal(values)), "s.toml: body.principal")
    with pytest.raises(InputError, match="expected principal moments"):
        require_admissible(principal_axes(tensor.rotate(diagonal(values), random_rotation(2))))


@pytest.mark.parametrize(
    ("inertia", "sentence"),
    [
        ([[1, 0], [0, 1]], "3 rows of 3"),
        (5, "3 rows of 3"),
        ([[1, 2, 0], [0, 1, 0], [0, 0, 1]], "symmetric"),
        ([[1, "a", 0], [0, 1, 0], [0, 0, 1]], "number"),
        ([[1, float("inf"), 0], [0, 1, 0], [0, 0, 1]], "finite"),
    ],
)
def test_what_is_no_tensor_is_refused(inertia, sentence):
    """The message begins with the place in the scene."""
    with pytest.raises(InputError, match=f"body.inertia: .*{sentence}"):
        principal_axes(inertia, "body.inertia")
