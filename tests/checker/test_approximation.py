"""Approximations for small values of a letter: true if both sides begin with the same terms of a Taylor series."""

import pytest
from mpmath import mp, mpf, taylor, workdps

import symrot

TRUE = (
    "sin θ ≈ θ", "cos θ ≈ 1 − θ²/2", r"\sin\theta \approx \theta - \frac{\theta^3}{6}", r"\cos\theta\simeq 1", "sqrt(1+x) ≈ 1 + x/2",
    "1/(1+x) ≈ 1 - x", "sin(θ+δ) ≈ sin θ + δ cos θ", "tan x ≈ x + x³/3",
)  # fmt: skip


@pytest.mark.parametrize("claim", TRUE)
def test_a_taylor_polynomial_is_a_true_approximation(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true" and "for small" in verdict.notes[0] and "left out" in verdict.notes[1]


@pytest.mark.parametrize(("claim", "repaired"), [
    ("cos θ ≈ 1 + θ²/2", "cos θ ≈ 1 - θ^2/2"), (r"\cos\theta\approx 1-\theta^2", r"\cos\theta \approx 1 - \frac{\theta^2}{2}"),
    ("sin(θ+δ) ≈ sin θ - δ cos θ", "sin(θ+δ) ≈ δ*cos(θ) + sin(θ)"),
])  # fmt: skip
def test_one_wrong_coefficient_is_false_and_repaired(claim, repaired):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false" and verdict.repairs[0].text == repaired
    assert symrot.check(repaired).verdict == "true"


@pytest.mark.parametrize("claim", ["sin x ≈ 4x(π-x)/π²", "sin x ≈ 0.9 x", "sin x ≈ 1"])
def test_another_approximation_is_not_accused(claim):
    assert symrot.check(claim).verdict == "undecided"


def test_a_rounded_value_stays_a_rounded_value():
    assert [symrot.check(claim).verdict for claim in ("√2 ≈ 1.41", "cos(1) ≈ 0.54")] == ["true", "true"]


@pytest.mark.parametrize(("claim", "power"), [
    ("tan θ ≈ sin θ", 2), (r"\tan\theta \approx \sin\theta", 2), ("exp(x) ≈ 1/(1 - x)", 1), ("cos(x) ≈ exp(-x²/2)", 3),
])  # fmt: skip
def test_two_formulas_with_the_same_first_terms_are_a_true_approximation(claim, power):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true" and f"agree up to the power {power} of" in verdict.notes[0]


@pytest.mark.parametrize("claim", ["tan θ ≈ 2 sin θ", "cos θ ≈ exp(θ)", "cos x ≈ 1/(1 + x²)"])
def test_formulas_that_agree_in_a_constant_at_most_are_not_called_an_approximation(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "undecided" and "differ in the power" in verdict.reason


POLYNOMIALS = (
    ("sin x", mp.sin, "x - x^3/6", (0, 1, 0, -mpf(1) / 6)), ("cos x", mp.cos, "1 - x^2/2", (1, 0, -mpf(1) / 2)),
    ("√(1 + x)", lambda x: mp.sqrt(1 + x), "1 + x/2 + x^2/8", (1, mpf(1) / 2, mpf(1) / 8)),
    ("e^x", mp.exp, "1 + x + x^2/2", (1, 1, mpf(1) / 2)), ("tan x", mp.tan, "x + x^3/3", (0, 1, 0, mpf(1) / 3)),
)  # fmt: skip


@pytest.mark.parametrize(("formula", "function", "polynomial", "coefficients"), POLYNOMIALS)
@pytest.mark.parametrize("power", range(1, 7))
def test_an_order_is_that_of_the_first_term_left_out(formula, function, polynomial, coefficients, power):
    """f = p + O(x^n) holds if f - p has no power of x below n, and f = p + o(x^n) if it has none up to n."""
    with workdps(30):
        series = taylor(function, 0, 7)
        rest = [abs(c - (coefficients[n] if n < len(coefficients) else 0)) > 1e-9 for n, c in enumerate(series)]
    for sign, least in (("O", power), (r"\mathcal{O}", power), ("o", power + 1)):
        verdict = symrot.check(f"{formula} = {polynomial} + {sign}(x^{power})")
        assert verdict.verdict == ("false" if any(rest[:least]) else "true")
        assert bool(verdict.diagnosis.text) == any(rest[:least])


@pytest.mark.parametrize(("claim", "verdict"), [
    ("R_z(θ) = [1, -θ, 0; θ, 1, 0; 0, 0, 1] + O(θ²)", "true"), ("R_z(θ) = [1, θ, 0; -θ, 1, 0; 0, 0, 1] + O(θ²)", "false"),
    (r"\sin(a + h) = \sin a + h\cos a + \mathcal O\left(h^2\right)", "true"), ("(1 + x)^n = 1 + n x + O(x^2)", "true"),
    ("|x| = x + O(x^2)", "undecided"), ("√x = x + O(x^2)", "undecided"), ("T = T_1 (1 + θ²/16) + O(θ^4)", "definition"),
])  # fmt: skip
def test_orders_of_matrices_and_of_formulas_without_a_series(claim, verdict):
    assert symrot.check(claim).verdict == verdict
