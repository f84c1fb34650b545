"""Vectors, matrices and quaternions that a text uses without a definition."""

import pytest

import symrot
from symrot.errors import InputError

TRUE = (
    # quaternions
    "q q* = ‖q‖²", r"q \bar q = |q|^2", "(q ⊗ p)* = p* ⊗ q*", "‖q ⊗ p‖ = ‖q‖ ‖p‖", r"q^{-1} = \frac{\bar q}{\|q\|^2}", r"q\otimes q^{-1}\otimes p = p",
    "q p = (q0 p0 - qv . pv, q0 pv + p0 qv + qv x pv)", r"(q\otimes p)\otimes r = q\otimes(p\otimes r)",
    r"q\cdot p = \begin{bmatrix} q_0p_0 - \mathbf q^T\mathbf p \\ q_0\mathbf p + p_0\mathbf q + \mathbf q\times\mathbf p \end{bmatrix}",
    # matrices and columns
    "(A B)^T = B^T A^T", "det(A B) = det(A) det(B)", "tr(A B) = tr(B A)", "a^T b = b^T a", "tr(a b^T) = a^T b", "det(A^T) = det A",
    "[[0, 1], [1, 0]]^T = [[0, 1], [1, 0]]", "[0, -a^T; a, 0]^T = -[0, -a^T; a, 0]",
    # exponentials, and rotations by angles
    r"e^{[\theta]_\times} = I + \frac{\sin\|\theta\|}{\|\theta\|}[\theta]_\times + \frac{1-\cos\|\theta\|}{\|\theta\|^2}[\theta]_\times^2",
    r"\exp([\phi]_\times) = I + \frac{\sin\phi}{\phi}[\phi]_\times + \frac{1-\cos\phi}{\phi^2}[\phi]_\times^2",
    "exp(-[w]×) = I - sin|w|/|w| [w]× + (1 - cos|w|)/|w|² [w]×²",
    r"R(\alpha) R(\beta) = R(\alpha+\beta)", "R(α) R(β) = R(α+β)", r"\mathbf{R}(\theta)^T = \mathbf{R}(-\theta)", "R(2π) = I",
    # lengths
    "|a × b|² = a² b² − (a·b)²", "|a × b|^2 + (a·b)^2 = a b a b",
    # integrals
    "∫ (x² + y²) dm = ∫ x² dm + ∫ y² dm", r"\int_V (x + y)\,dm = \int y\,dm + \int x\,dm",
)  # fmt: skip

FALSE = (
    "q q* = ‖q‖", "(q ⊗ p)* = q* ⊗ p*", "q ⊗ p = p ⊗ q", r"q^{-1} = \frac{\bar q}{\|q\|}", "(A B)^T = A^T B^T", "tr(A B) = tr(A) tr(B)",
    "q p = (q0 p0 + qv . pv, q0 pv + p0 qv + qv x pv)", "|ω × r|² = ω² r − (ω·r)²", r"\int (x^2 + y^2)\,dm = \int x^2\,dm",
    "R a x R b = -R (a x b)", "R(α) R(β) = R(α−β)",
)  # fmt: skip

OPEN = (
    "A^T A = I", "det A = 1", "|a × b| = a b sin θ", "a·b = |a| |b| cos θ", "det T = −sin ϑ", "q v q* = (0, w)", "Ixy = ∫ xy dm",
    r"\dot R = S(\omega) R", r"{}^A R_B = {}^A R_C \, {}^C R_B", r"{}^A\mathbf p = {}^A R_B \, {}^B\mathbf p", "L = r × m v",
    r"\mathbf v' = q\,\mathbf v\,q^*", r"T^* = \frac12 m v^2", r"[I]_F = [FB]\,[I]_B\,[FB]^T",
    r"\mathbf H_2 = \mathbf H_1 + \int_{t_1}^{t_2}\mathbf M\,dt", "x = (-b ± √(b² − 4 a c))/(2 a)",
)  # fmt: skip


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", TRUE)
def test_an_identity_of_arrays_is_true(claim):
    assert symrot.check(claim).verdict == "true"


def test_columns_side_by_side_are_a_matrix_from_which_the_unit_matrix_can_be_subtracted():
    assert symrot.check("hstack(Matrix([1, 0]), Matrix([0, 1])) - I == 0*eye(2)").verdict == "true"


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", FALSE)
def test_a_wrong_identity_of_arrays_is_false(claim):
    assert symrot.check(claim, repair=False).verdict == "false"


@pytest.mark.thinned(3)
@pytest.mark.parametrize("claim", OPEN)
def test_what_depends_on_the_meaning_of_a_name_is_not_accused(claim):
    assert symrot.check(claim, repair=False).verdict in ("definition", "recognised")


@pytest.mark.parametrize("claim", [
    r"\dot q = \tfrac12\, q\otimes\begin{bmatrix}0\\ \boldsymbol\omega\end{bmatrix}", "q̇ = ½ q ⊗ (0, ω)", "cos Φ = ½ (tr A - 1)",
    "J_O = J_c + m (r^T r I_3 - r r^T)", r"\dot q = \frac12 q\otimes\begin{bmatrix}0\\ \omega\end{bmatrix}",
    r"\dot{\mathbf q} = \frac12 (0, \boldsymbol\omega) \otimes \mathbf q",
    r"\mathbf R(q) = \begin{bmatrix} 1-2(q_2^2+q_3^2) & 2(q_1q_2-q_0q_3) & 2(q_1q_3+q_0q_2) \\"
    r"2(q_1q_2+q_0q_3) & 1-2(q_1^2+q_3^2) & 2(q_2q_3-q_0q_1) \\ 2(q_1q_3-q_0q_2) & 2(q_2q_3+q_0q_1) & 1-2(q_1^2+q_2^2)"
    r"\end{bmatrix}",
])  # fmt: skip
def test_a_formula_with_arrays_is_recognised(claim):
    assert symrot.check(claim, repair=False).verdict == "recognised"


def test_a_repair_has_the_exponential_of_the_claim():
    claim = (
        r"R = \exp([\mathbf u]_\times\theta) = I + \sin\theta[\mathbf u]_\times + (1+\cos\theta)[\mathbf u]_\times^2"
    )
    verdict = symrot.check(claim)
    assert verdict.verdict == "false" and verdict.repairs[0].text.startswith(r"\exp([\mathbf{u}]_\times \theta) = ")
    assert not any("Matrix" in text for text in (*(repair.text for repair in verdict.repairs), *verdict.notes))


def test_rotations_by_letters_about_unknown_axes_are_not_of_one_axis():
    with pytest.raises(InputError):
        symrot.check("A = R(ψ) R(θ) R(φ)")


def test_a_given_matrix_replaces_the_entries():
    claim = "R a x R b = R (a x b)"
    assert symrot.check(claim, assume=["R = Rz(phi) Rx(theta)"]).verdict == "true"
    verdict = symrot.check(claim, repair=False)
    assert any("R is any 3 x 3 matrix" in note and "--given" in note for note in verdict.notes)


@pytest.mark.parametrize("claim", [
    "R a x R b = R (a x b)", r"\mathbf R\mathbf a\cdot\mathbf R\mathbf b = \mathbf a\cdot\mathbf b",
])  # fmt: skip
def test_what_holds_for_rotations_only_is_conditional(claim):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.requires) == ("conditional", ("R is a rotation",))


def test_names_with_rates_in_hypotheses_are_functions_of_time_in_the_claim():
    rates = ["I_1 ω_1' = (I_2 - I_3) ω_2 ω_3", "I_2 ω_2' = (I_3 - I_1) ω_3 ω_1", "I_3 ω_3' = (I_1 - I_2) ω_1 ω_2"]
    assert symrot.check("d/dt (I_1 ω_1² + I_2 ω_2² + I_3 ω_3²) = 0", assume=rates).verdict == "true"
    assert symrot.check("d/dt (I_1 ω_1² + I_2 ω_2² + I_3 ω_3) = 0", assume=rates, repair=False).verdict != "true"


def test_frames_are_parts_of_names_if_there_are_several():
    both = symrot.check(r"{}^A R_B = {}^A R_C \, {}^C R_B")
    assert any("part of the name, R_B_A" in note for note in both.notes)
    one = symrot.check(r"{}^B\omega_x = {}^B\dot\phi")
    assert any("the letter B before a name is read as its frame and ignored" in note for note in one.notes)


@pytest.mark.parametrize(("claim", "words"), [
    ("[[1, 2], [a × b, 3]] = c", "blocks that fit together"), (r"I = \int x^2\, dV", "for an integral over a body, dm or a density and dV"),
    ("∫ sin(x) dm = 1", "a polynomial in the coordinates"),
])  # fmt: skip
def test_a_refusal_says_what_is_expected(claim, words):
    with pytest.raises(InputError, match=words):
        symrot.check(claim)


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("claim", "condition"), [
    ("tr(R I R^T) = tr(I)", "R is a rotation"), ("(R a)·(R b) = a·b", "R is a rotation"),
    ("det(A B) = det(A)", "B is a rotation"),
])  # fmt: skip
def test_only_the_matrix_that_has_to_be_a_rotation_is_named(claim, condition):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.requires) == ("conditional", (condition,))


def test_a_condition_on_a_matrix_says_that_nothing_defines_it():
    verdict = symrot.check("A A^T = A^T A")
    assert verdict.verdict == "definition"
    assert verdict.reason == "the claim is about A, but nothing here says what this is"


@pytest.mark.parametrize(("claim", "verdict"), [
    (r"\dot R R^T = [\omega]_\times", "definition"), (r"\dot R R^T + R\dot R^T = 0", "conditional"),
    (r"\dot q = \frac12 q\otimes\omega", "recognised"),
])  # fmt: skip
def test_rates_beside_transposes_and_quaternion_signs(claim, verdict):
    assert symrot.check(claim, repair=False).verdict == verdict
