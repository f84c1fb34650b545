"""Approximations for small values of a letter: true if both sides begin with the same terms of a Taylor series."""

import pytest

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
