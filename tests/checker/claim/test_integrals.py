"""Typed integrals with limits, densities, and derivatives with respect to rates, with ∂."""

import pytest

import symrot
from symrot.errors import InputError


@pytest.mark.parametrize(("text", "verdict"), [
    ("∫_0^1 x dx = 1/2", "true"), ("∫_0^1 x dx = 1/3", "false"), ("∫₀¹ x² dx = 1/3", "true"), ("∫_0^2π sin²θ dθ = π", "true"),
    ("∫₀ᵀ t dt = T²/2", "true"),
    ("∫_{-L/2}^{L/2} (m/L) x² dx = m L²/12", "true"), ("∫_0^1 ∫_0^1 x y dx dy = 1/4", "true"),
    ("I_zz = ∫ρ(x² + y²) dV", "recognised"), (r"I_{xy} = -\iiint_V \rho\, x y\, dV", "recognised"),
])  # fmt: skip
def test_an_integral_is_read_as_printed(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


def test_a_raised_limit_is_a_whole_number_or_a_time():
    with pytest.raises(InputError, match="a whole number or the name T as the superscript upper limit"):
        symrot.check("∫₀⁺ x dx = 1")


def test_an_integral_over_a_volume_needs_a_density():
    with pytest.raises(InputError, match="for an integral over a body, either dm or a density before dV"):
        symrot.check("I_zz = ∫(x² + y²) dV")


@pytest.mark.parametrize(("text", "verdict"), [
    ("∂T/∂θ' = m L² θ' where T = ½ m L² θ'^2", "true"), ("T = ½ m L² θ̇²; ∂T/∂θ̇ = 2 m L² θ̇", "false"),
    ("dT/dθ' = m L² θ' where T = ½ m L² θ'^2", "true"), ("∂²/∂x² (x³) = 6x", "true"), ("∂f/∂x = 2 x y where f = x² y", "true"),
])  # fmt: skip
def test_a_partial_derivative_by_a_letter_or_a_rate(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize(("text", "verdict"), [
    ("arg(e^(iθ)) = θ", "conditional"), (r"\arg(e^{i\theta}) = \theta", "conditional"), ("arg(1 + i) = π/4", "true"),
    ("arg(1 + i) = π/3", "false"), ("arg z = atan2(y, x) where z = x + i y", "true"),
])  # fmt: skip
def test_the_argument_of_a_complex_number(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


@pytest.mark.parametrize("text", [
    "∫ M dt = ΔL", "∫ τ dt = L_f - L_i", "∫ M dt = I ω_2 - I ω_1", "I ω_1 + ∫ M dt = I ω_2",
    r"\int_{t_1}^{t_2} \mathbf M\,dt = \Delta\mathbf L", r"\int \mathbf M\,dt = \mathbf L_2 - \mathbf L_1",
])  # fmt: skip
def test_an_impulse_is_the_change_of_a_quantity_whose_rate_is_the_integrand(text):
    verdict = symrot.check(text, repair=False)
    assert verdict.verdict == "recognised"
    assert "an integral over time is the change of a quantity whose rate is the integrand" in verdict.notes


@pytest.mark.parametrize("text", ["∫ M dt = I ω_2 + I ω_1", "∫ P dt = W"])
def test_an_integral_over_time_without_limits_needs_a_change_beside_it(text):
    with pytest.raises(symrot.InputError, match="the change of a quantity beside an integral over time"):
        symrot.check(text)


def test_the_upper_limit_may_have_the_name_of_the_inner_variable():
    assert symrot.check("∫_0^t (ω_0 + α t) dt = ω_0 t + α t^2/2", repair=False).verdict == "true"
    assert symrot.check("∫_0^t α t dt = α t^2", repair=False).verdict == "false"
