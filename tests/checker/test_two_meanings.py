"""A letter with two meanings in one text, and signs whose meaning the rest of the text shows."""

import pytest

import symrot


def test_a_length_and_a_lagrangian_may_have_one_letter():
    verdict = symrot.check("T = ½ m L² θ'²; V = -m g L cos θ; L = T - V")
    assert verdict.verdict == "recognised"
    assert any("L here is read as another quantity than L in T and V" in note for note in verdict.notes)


def test_a_line_that_follows_from_the_others_stays_true():
    assert symrot.check("a = b + 1; b = a - 1").verdict == "true"


@pytest.mark.parametrize(("text", "verdict"), [
    ("I = n^T I n", "recognised"), ("F·d = F d cos θ", "definition"), ("m·g = m g cos θ", "false"),
    ("H_O = r_G x m v_G + H_G", "recognised"), ("H_O = r_G x m v_G - H_G", "doubtful"), ("r = x m + y", "definition"),
])  # fmt: skip
def test_the_other_side_shows_what_is_meant(text, verdict):
    assert symrot.check(text).verdict == verdict


def test_the_power_zero_of_zero_is_a_convention():
    assert any("0^0 is read as 1" in note for note in symrot.check("0^0 = 1").notes)
    assert not symrot.check("2^0 = 1").notes


def test_i_beside_powers_of_e_is_no_real_letter():
    """i**i is exp(-pi/2); with a positive i it was false."""
    with pytest.raises(symrot.InputError, match="power of a complex number"):
        symrot.check("i^i = e^(-pi/2)")


@pytest.mark.parametrize(("text", "verdict"), [
    ("K = ½ · 2 kg · (3 m/s)² = 8 J", "false"), ("a = (20 m/s)²/50 m = 8 m/s²", "definition"),
    ("T = 2π sqrt(1 m/(9.81 m/s²)) = 2.06 s", "false"),
])  # fmt: skip
def test_raised_digits_after_a_bracket_are_no_name_beside_units(text, verdict):
    assert symrot.check(text).verdict == verdict


@pytest.mark.parametrize(("text", "verdict"), [
    ("(p q)* = q* p*", "true"), ("(p q)* = p* q*", "false"), ("q* v q = R^T v", "recognised"),
    ("R(q) v = q v q⁻¹", "recognised"), ("a* b = b* a", "true"), ("v' = q v q⁻¹", "recognised"), ("z̄ = x - iy where z = x + iy", "true"),
])  # fmt: skip
def test_a_star_before_a_blank_may_be_a_conjugate(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize(("text", "verdict"), [
    ("q = θ̇ cos φ + ψ̇ sin φ cos θ", "recognised"), ("q = θ̇ cos φ - ψ̇ sin φ cos θ", "doubtful"),
    ("p = φ̇ + ψ̇ sin θ", "doubtful"),
])  # fmt: skip
def test_the_rates_of_an_aircraft_belong_to_roll_pitch_and_yaw(text, verdict):
    assert symrot.check(text).verdict == verdict


@pytest.mark.parametrize(("text", "verdict"), [
    ("v = sqrt(2 g h) = sqrt(2 · 9.81 m/s² · 5 m) = 9.9 m/s", "definition"), ("I = ½ m r² = 0.5 · 2 · 0.1² = 0.01", "definition"),
    ("I = ½ m r² = 0.5 · 2 · 0.1² = 0.02", "false"), ("T = sin²x + cos²x = 2", "false"), ("I = 0.02", "definition"),
])  # fmt: skip
def test_numbers_put_into_a_formula_are_no_identity(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize(("text", "sequence", "verdict"), [
    ("R_11 = cos ψ cos φ - cos θ sin φ sin ψ", "ZXZ", "recognised"), ("R_31 = -sin θ", "ZYX", "recognised"),
    ("R_31 = sin θ", "ZYX", "definition"),
])  # fmt: skip
def test_an_entry_of_the_matrix_of_a_stated_sequence(text, sequence, verdict):
    assert symrot.check(text, sequence=sequence, repair=False).verdict == verdict


@pytest.mark.parametrize(("text", "verdict"), [
    ("I = -m [r]×^2", "recognised"), ("I = m (|r|² I - r r^T)", "recognised"), (r"\mathbf I = -m[\mathbf r]_\times^2", "recognised"),
    ("I = R I_B R^T", "conditional"), ("I = diag(A, B, C)", "definition"), ("I = m r r^T", "definition"), ("[n]× [n]× = I", "false"),
])  # fmt: skip
def test_the_unit_matrix_is_no_tensor_of_inertia(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize(("text", "formula"), [
    ("R v = v cos θ + (n × v) sin θ + n (n·v)(1 - cos θ)", "rotation matrix of a unit axis and an angle"),
    (r"\mathbf{R}\mathbf{v} = \mathbf v\cos\theta + (\mathbf n\times\mathbf v)\sin\theta + \mathbf n(\mathbf n\cdot\mathbf v)(1-\cos\theta)", "rotation matrix of a unit axis and an angle"),
    ("R x = x + 2 q_0 (q × x) + 2 q × (q × x)", "rotation matrix of a unit quaternion"), ("A x = a × x", "skew matrix of a vector"),
])  # fmt: skip
def test_a_matrix_is_stated_by_what_it_does_to_every_vector(text, formula):
    """With R as a number, these formulas were false."""
    verdict = symrot.check(text, repair=False)
    assert verdict.verdict == "recognised" and verdict.recognised_as[0].name.startswith(formula)


def test_quaternions_do_not_commute_in_silence():
    assert any("read as numbers" in note for note in symrot.check("q p = p q").notes)


def test_a_reading_that_ignores_the_stated_frame_does_not_replace_a_doubtful_rate():
    """R' as the name of a vector was recognised as a cross product."""
    verdict = symrot.check("R' = [ω]× R", frame="body")
    assert (verdict.verdict, verdict.diagnosis.code) == ("doubtful", "frame_body_space")


@pytest.mark.parametrize(("claim", "verdict"), [
    ("sin θ = 2t/(1+t²) where t = tan(θ/2)", "true"), ("sin θ = 2t/(1-t²) where t = tan(θ/2)", "false"),
    (r"\cos\theta = \frac{1-t^2}{1+t^2}, \quad t = \tan\frac{\theta}{2}", "true"),
    (r"\sin\theta = \frac{2u}{1+u^2}, \quad u = \tan\frac{\theta}{2}", "true"), ("x = v t, v = a t", "definition"),
])  # fmt: skip
def test_t_is_no_time_if_the_text_defines_it(claim, verdict):
    assert symrot.check(claim, repair=False).verdict == verdict
