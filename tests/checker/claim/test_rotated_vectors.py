"""A quaternion product and a matrix that rotate the same vector: the letter of the matrix is no number."""

import pytest

import symrot

ROTATIONS = (
    "q v q* = R v", "q v q^{-1} = R v", "q v q^-1 = R v", "R v = q v q*", "q v q* = A v", "q^* v q = R^T v",
    r"\mathbf{q}\mathbf{v}\mathbf{q}^* = R\mathbf{v}", r"\mathbf{q}\mathbf{v}\mathbf{q}^* = \mathbf{R}\mathbf{v}",
    r"q v \bar q = R v",
)  # fmt: skip


@pytest.mark.parametrize("text", ROTATIONS)
def test_the_matrix_of_a_quaternion_is_recognised(text):
    verdict = symrot.check(text)
    assert verdict.verdict == "recognised"
    assert "rotation matrix of a quaternion" in str(verdict.recognised_as[0])


def test_the_transpose_of_the_matrix_is_named():
    formula = str(symrot.check("q v q* = R^T v").recognised_as[0])
    assert "transposed" in formula


def test_a_number_in_place_of_the_matrix_is_false():
    assert symrot.check("q v q* = m v").verdict == "false"


@pytest.mark.parametrize("text", ["p*a*p**(-1) == a", "q p q^{-1} = p"])
def test_letters_that_are_numbers_commute(text):
    assert symrot.check(text).verdict == "true"
