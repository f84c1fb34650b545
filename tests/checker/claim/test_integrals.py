"""Typed integrals with limits, densities, and derivatives by rates with ∂."""

import pytest

import symrot
from symrot.errors import InputError


@pytest.mark.parametrize(("text", "verdict"), [
    ("∫_0^1 x dx = 1/2", "true"), ("∫_0^1 x dx = 1/3", "false"), ("∫₀¹ x² dx = 1/3", "true"), ("∫_0^2π sin²θ dθ = π", "true"),
    ("∫_{-L/2}^{L/2} (m/L) x² dx = m L²/12", "true"), ("∫_0^1 ∫_0^1 x y dx dy = 1/4", "true"),
    ("I_zz = ∫ρ(x² + y²) dV", "recognised"), (r"I_{xy} = -\iiint_V \rho\, x y\, dV", "recognised"),
])  # fmt: skip
def test_an_integral_is_read_as_printed(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


def test_an_integral_over_a_volume_needs_a_density():
    with pytest.raises(InputError, match="a density before dV for an integral over a body"):
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
