"""Claims about the determinants of rate Jacobians: recognised with the sequences they fit, doubtful if none fits."""

import pytest
from sympy import Matrix

import symrot
from symrot import symbols
from symrot.checker.context.determinants import determinants
from symrot.conventions import SEQUENCES
from symrot.kinematics.euler import rate_jacobian

POINT = dict(zip(symbols.angles, (0.3, 0.8, -1.1), strict=True))


@pytest.mark.parametrize("name", SEQUENCES)
def test_the_determinant_depends_on_the_second_angle_alone_and_on_no_frame(name):
    for frame in ("body", "space"):
        matrix = Matrix(rate_jacobian(name, frame).as_immutable().subs(POINT))
        assert abs(matrix.det() - determinants()[name].subs(POINT)) < 1e-12


@pytest.mark.parametrize(("claim", "sequence"), [
    ("det T = −sin ϑ", "ZXZ"), ("det(E) = cos(theta)", "ZYX"), (r"\det B = \sin\beta", "ZXZ"),
    (r"\det(\mathbf{T}) = -\sin\vartheta", "ZXZ"), ("det J = -cos theta_2", "ZYX"),
])  # fmt: skip
def test_a_determinant_is_recognised_with_either_sign(claim, sequence):
    verdict = symrot.check(claim)
    assert verdict.verdict == "recognised"
    assert verdict.recognised_as[0].name.startswith(f"determinant of the {sequence} rate Jacobian")


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", [
    "det T = -2 sin theta", "det T = sin^2 theta", r"\det E = \cos 2\theta", "det B = sin(theta/2)", r"\det T = 3\cos\beta",
])  # fmt: skip
def test_a_formula_that_is_no_determinant_is_doubtful(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "doubtful"
    assert symrot.check(verdict.repairs[0].text).verdict == "recognised"


@pytest.mark.parametrize(("claim", "sequence", "verdict"), [
    (r"\det T = -\cos\vartheta", "ZYZ", "doubtful"), ("det(E) = sin θ", "ZYX", "doubtful"),
    ("det(E) = sin θ", "ZXZ", "recognised"), ("det(E) = sin θ", "", "recognised"), ("det E = cos theta", "xyz", "recognised"),
])  # fmt: skip
def test_the_sequence_decides_between_sine_and_cosine(claim, sequence, verdict):
    assert symrot.check(claim, sequence=sequence).verdict == verdict


@pytest.mark.parametrize(
    "claim", ["det R = sin theta", "det T = sin x", "det T = a sin theta", "det(R) = 1", "det T = 2"]
)
def test_other_determinants_are_left_alone(claim):
    names = [known.name for known in symrot.check(claim).recognised_as]
    assert not any("rate Jacobian" in name for name in names)
