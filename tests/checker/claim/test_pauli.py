"""Pauli's matrices, compared with products of complex matrices that NumPy computes."""

import numpy as np
import pytest

import symrot
from symrot.errors import InputError

X, Y, Z = np.array([[0, 1], [1, 0]]), np.array([[0, -1j], [1j, 0]]), np.array([[1, 0], [0, -1]])
CASES = (
    ("σ_x σ_y = i σ_z", X @ Y - 1j * Z),
    ("σ_x σ_y = -i σ_z", X @ Y + 1j * Z),
    ("σ_y σ_x = -i σ_z", Y @ X + 1j * Z),
    (r"\sigma_1 \sigma_2 - \sigma_2 \sigma_1 = 2 i \sigma_3", X @ Y - Y @ X - 2j * Z),
    (r"\sigma_x \sigma_y \sigma_z = i", X @ Y @ Z - 1j * np.eye(2)),
    ("[σ_x, σ_y] = 2i σ_z", X @ Y - Y @ X - 2j * Z),
    (r"[\sigma_x, \sigma_y] = i \sigma_z", X @ Y - Y @ X - 1j * Z),
    ("{σ_x, σ_y} = 0", X @ Y + Y @ X),
    (r"\{\sigma_x, \sigma_y\} = 2i\sigma_z", X @ Y + Y @ X - 2j * Z),
    ("σ_x^2 = 1", X @ X - np.eye(2)),
    ("σ_x σ_y = σ_y σ_x", X @ Y - Y @ X),
    (r"\sigma_y^2 = I", Y @ Y - np.eye(2)),
    ("tr(σ_x σ_y σ_z) = 2i", np.trace(X @ Y @ Z) - 2j),
    ("tr(σ_x^2) = 1", np.trace(X @ X) - 1),
    ("(σ_x cos φ + σ_y sin φ)² = 1", np.zeros((2, 2))),
    (r"(a\sigma_x + b\sigma_y)^2 = a^2 - b^2", np.eye(2)),
    ("(b σ_x)² = (b σ_y)²", X @ X - Y @ Y),
    ("(b σ_x)² = b²", X @ X - np.eye(2)),
    ("(b σ_x)² = 2 (b σ_y)²", X @ X - 2 * Y @ Y),
    ("det(a σ_x + b σ_y + c σ_z) = -a² - b² - c²", 0),
    (r"\det\sigma_x = 1", np.linalg.det(X) - 1),
    ("tr σ_x = 0", np.trace(X)),
    ("[σ_x σ_y, σ_y σ_z, σ_z σ_x] = [i σ_z, i σ_x, i σ_y]", X @ Y - 1j * Z),
    ("[σ_x², σ_y², σ_z²] = [1, 1, -1]", Z @ Z + np.eye(2)),
    ("(1 + i σ_z) σ_x (1 - i σ_z) = -2 σ_y", (np.eye(2) + 1j * Z) @ X @ (np.eye(2) - 1j * Z) + 2 * Y),
)


@pytest.mark.parametrize(("text", "difference"), CASES, ids=[text for text, _ in CASES])
def test_products_are_those_of_the_matrices(text, difference):
    assert symrot.check(text).verdict == ("false" if np.any(difference) else "true")


@pytest.mark.parametrize("text", [
    "σ_j σ_k = δ_jk + i ε_jkl σ_l", r"[\sigma_i, \sigma_j] = 2i\epsilon_{ijk}\sigma_k", r"\{\sigma_i, \sigma_j\} = 2\delta_{ij} I",
])  # fmt: skip
def test_products_in_index_notation(text):
    assert symrot.check(text).verdict == "true"
    assert symrot.check(text.replace("2", "3").replace("= δ", "= 2δ")).verdict == "false"


def test_half_angles_rotate_a_matrix():
    half = r"(\cos\frac{\theta}{2} %s i\sigma_z \sin\frac{\theta}{2})"
    text = half % "-" + r"\sigma_x" + half % "+" + r" = \sigma_x \cos\theta + \sigma_y \sin\theta"
    assert symrot.check(text).verdict == "true"


@pytest.mark.parametrize(
    "text",
    [
        "σ_x = E ε_x",
        "(σ_x - σ_y)²/4 + τ_xy² = R²",
        "v_i = i σ_x + σ_y",
        "σ_x + σ_y = 3",
        "σ_v^2 = σ_x^2 - σ_x σ_y + σ_y^2",
    ],
)
def test_other_quantities_with_these_letters_are_not_false(text):
    assert symrot.check(text).verdict == "definition"


def test_a_matrix_in_an_exponent_is_refused():
    with pytest.raises(InputError, match="expected sigma_z outside of exponents"):
        symrot.check(r"e^{-i\theta\sigma_z/2} = \cos(\theta/2) - i\sigma_z\sin(\theta/2)")


def test_repairs_have_the_trace_and_the_determinant_of_the_claim():
    repairs = symrot.check("det(a σ_x + b σ_y) = a² - b²").repairs + symrot.check("tr(σ_x σ_y) = 2").repairs
    assert repairs
    assert all("trace" not in repair.text for repair in repairs)


def test_stresses_with_a_yield_stress_are_numbers():
    verdict = symrot.check("σ_1^2 - σ_1 σ_2 + σ_2^2 = σ_y^2", repair=False)
    assert verdict.verdict == "definition" and not any("Pauli" in note for note in verdict.notes)
