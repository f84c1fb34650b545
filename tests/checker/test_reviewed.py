"""Verdicts on formulas of books that were wrong once: each comes with a formula of the same kind that is false."""

import pytest

import symrot

WITHOUT_CONTEXT = {
    # systems of equations are conditions on their letters, and no identities
    "m a = m g - T": "definition",
    "½ m v² + ½ I ω² = m g h": "definition",
    "m_1 v_1 + m_2 v_2 = (m_1 + m_2) v": "definition",
    "F = m a; F = k x": "definition",
    "T = ½ m v²; v = ω r; T = ½ m ω² r²": "true",
    "T = ½ m v²; v = ω r; T = ½ m ω² r": "false",
    "ω - ω_0 = α t": "recognised",
    "K_rot/K = 2/7": "definition",
    "2 x = x": "false",
    "I_cm = I + m d²": "definition",
    "I = I_cm + m d²": "recognised",
    # vectors of a basis
    "i × j = k": "true",
    "k × j = i": "false",
    r"\hat i\times\hat k = \hat j": "false",
    r"(a_x\hat i + a_y\hat j + a_z \hat k)\cdot\hat j = a_y": "true",
    r"\mathbf e_2\times\mathbf e_1 = \mathbf e_3": "false",
    "v = ω × r": "recognised",
    "v = r × ω": "definition",
    # complex numbers
    "|z|^2 = z z̄": "true",
    "|z|^2 = z̄ z̄": "false",
    "z - z̄ = 2 i Im(z)": "true",
    "Re(z^2) = (Re z)^2": "false",
    "conj(z w) = conj(z) conj(w)": "true",
    "(x + i y)² = x² - y² + 2 i x y": "true",
    "(x + i y)² = x² + y² + 2 i x y": "false",
    "z̄ = (m_1 z_1 + m_2 z_2)/(m_1 + m_2)": "definition",
    # numbers and units
    "2π/86164 s = 7.292e-5 rad/s": "true",
    "2π/86164 s = 7.392e-5 rad/s": "false",
    "3 m g = 29.43 N": "definition",
    "1 hp = 746 W": "true",
    "1 hp = 747 W": "false",
    "9.81 sin 30° = 4.91": "true",
    "9.81 sin 30° = 4.92": "false",
    "1500·2π/60 = 157": "true",
    "1500·2π/60 = 158": "false",
    # letters for the matrix of a vector
    "R = I + sin θ K + (1 - cos θ) K^2": "recognised",
    "R = E + sin θ [k]_× + (1 - cos θ) [k]_×²": "recognised",
    "R = I + sin θ K + (1 + cos θ) K^2": "definition",
    r"R = \mathbf{I} + (\sin\theta)\mathbf{K} + (1-\cos\theta)\mathbf{K}^2": "recognised",
    r"e^{\hat\omega\theta} = I + \hat\omega\sin\theta + \hat\omega^2(1-\cos\theta)": "true",
    r"e^{\hat\omega\theta} = I + \hat\omega\sin\theta + \hat\omega(1-\cos\theta)": "false",
    r"R = e^{\hat\omega\theta}": "recognised",
    "q̇ = ½Ω(ω)q": "recognised",
    r"\dot{\mathbf q} = \frac12 \boldsymbol\Omega(\boldsymbol\omega)\mathbf q": "recognised",
    "q̇ = 2Ω(ω)q": "definition",
    r"T = ½ I \omega²": "recognised",
    r"\omega = L \over I": "recognised",
    "q^2 = -1 where q = i": "true",
    "q = i; q^2 = 1": "false",
    "(σ_x+σ_y)² = σ_x² + 2σ_xσ_y + σ_y²": "conditional",
    "(σ_x+σ_y)² = σ_x² + σ_xσ_y + σ_y²": "false",
    # R is a rotation in most books, A is not
    "R R^T = I": "conditional",
    r"\det R = 1": "conditional",
    "det R = -1": "definition",
    "A A^T = I": "definition",
    # rates of an aircraft are components in the body frame
    "φ' = p + (q sin φ + r cos φ) tan θ": "recognised",
    "φ' = p + (q cos φ + r sin φ) tan θ": "definition",
}


@pytest.mark.parametrize("text", WITHOUT_CONTEXT)
def test_verdict(text):
    assert symrot.check(text, repair=False).verdict == WITHOUT_CONTEXT[text]


@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    ("text", "body", "verdict"),
    [
        ("v = √(10/7 g h)", "solid sphere that rolls down a slope", "recognised"),
        ("v = √(4/3 g h)", "solid cylinder that rolls down a slope", "recognised"),
        ("a = 5/7 g sin θ", "solid cylinder that rolls down a slope", "false"),
        ("I_xy = -m a b/4", "box of sides a, b, c about a corner", "recognised"),
        ("I_xx = m(b²+c²)/12", "box of sides a, b, c about a corner", "false"),
        ("Ω = (I_3 - I_1)/I_1 ω_3", "symmetric top with moments I_1, I_1, I_3", "recognised"),
    ],
)
def test_verdict_for_a_body(text, body, verdict):
    assert symrot.check(text, body=body).verdict == verdict


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        ("T = m ω² L", "definition"),  # the tension of a string
        ("E = ½ m v² (1 + β)", "definition"),  # with the shape factor I/(m r²)
        ("a = (m_2 - m_1) g/(m_1 + m_2 + I/r²)", "definition"),  # the second mass is the heavier one
        ("I_1 ω̇_1 = (I_3 - I_2) ω_2 ω_3", "doubtful"),
    ],
)
def test_no_fault_in_a_formula_for_another_quantity(text, verdict):
    assert symrot.check(text).verdict == verdict


def test_a_reading_that_is_a_known_formula_beats_one_that_is_only_near_to_it():
    """The components of a vector in rotated axes, Goldstein ch. 4.7: r' is a name here, and no rate."""
    assert symrot.check("r' = r cos Phi + n (n . r) (1 - cos Phi) + (r x n) sin Phi").verdict == "recognised"
