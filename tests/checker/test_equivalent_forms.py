"""Claims in a form that no book derives, decided in the form that symrot derives, with repairs as the claim is written."""

import pytest

import symrot


@pytest.mark.parametrize(("text", "verdict"), [
    ("ω' = J^-1 [M - ω × J ω]", "recognised"), ("ω' = J^-1 [M + ω × J ω]", "doubtful"),
])  # fmt: skip
def test_an_equation_solved_by_an_inverse_matrix_is_multiplied_by_the_matrix(text, verdict):
    result = symrot.check(text)
    assert result.verdict == verdict
    assert "both sides of the equation are multiplied by J before they are compared" in result.notes
    assert all(symrot.check(repair.text, repair=False).verdict == "recognised" for repair in result.repairs)


@pytest.mark.parametrize(("text", "verdict"), [
    ("Q = θ̇ cos φ + ψ̇ cos θ sin φ", "recognised"), ("ψ̇ = (Q sin φ + R cos φ)/cos θ", "recognised"),
    ("θ̇ = Q cos φ + R sin φ", "doubtful"),
])  # fmt: skip
def test_capital_letters_are_the_rates_of_roll_pitch_and_yaw_beside_euler_angles(text, verdict):
    result = symrot.check(text)
    assert result.verdict == verdict
    assert "P, Q and R are read as the rates of roll, pitch and yaw, p, q and r" in result.notes
    assert all(set("PQR") & set(repair.text) for repair in result.repairs)


@pytest.mark.parametrize("text", ["yaw = atan2(R21, R11)", "pitch = -asin(R31)"])
def test_the_words_roll_pitch_and_yaw_are_the_usual_angles(text):
    verdict = symrot.check(text)
    assert verdict.verdict == "recognised"
    assert "roll, pitch and yaw are read as the angles phi, theta and psi" in verdict.notes


def test_a_prime_that_would_name_the_rate_of_another_angle_does_not_hide_a_wrong_sign():
    assert symrot.check("p = φ' + ψ' sin θ").verdict == "doubtful"
    assert symrot.check("p = φ' - ψ' sin θ", repair=False).verdict == "recognised"


@pytest.mark.parametrize(("text", "verdict"), [
    ("Ṙ = R [ω]×", "recognised"), ("Ṙ = -[ω]× R", "recognised"), ("Ṙ = [ω]× R^T", "doubtful"),
    pytest.param("R' = R^T [ω]×", "doubtful", marks=pytest.mark.campaign),
    pytest.param(r"\dot R = R^T [\omega]_\times", "doubtful", marks=pytest.mark.campaign),
    pytest.param("Ṙ = [ω]× R", "recognised", marks=pytest.mark.campaign),
])  # fmt: skip
def test_the_matrix_on_the_left_of_its_rate_is_the_one_on_the_right(text, verdict):
    """``R^T [ω]×`` is the rate of the transposed matrix, and of no other."""
    assert symrot.check(text).verdict == verdict


@pytest.mark.parametrize(("text", "condition"), [
    ("I_B = R^T I_A R", "R takes components in the frame of I_B to those in the frame of I_A"),
    ("[I]_F = R [I]_B R^T", "R takes components in the frame of I_B to those in the frame of I_F"),
    (r"[I]_{\mathcal F} = R\,[I]_{\mathcal B}\,R^T", "R takes components in the frame of I_B to those in the frame of I_F"),
])  # fmt: skip
def test_a_tensor_of_inertia_in_two_frames_is_right_for_one_direction_of_the_matrix(text, condition):
    verdict = symrot.check(text)
    assert (verdict.verdict, verdict.requires) == ("conditional", (condition,))


def test_a_matrix_with_the_name_of_the_unit_matrix_may_be_a_tensor_of_inertia():
    assert symrot.check("I = [1, 0, 0; 0, 2, 0; 0, 0, 3]").verdict == "definition"
    assert symrot.check("I = [1, 0, 0; 0, 1, 0; 0, 0, 1]").verdict == "true"
