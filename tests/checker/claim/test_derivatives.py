"""Derivatives by any letter are read as such, and what nothing defines has no derivative that could be zero."""

import pytest

import symrot


@pytest.mark.parametrize("claim", [
    "d/dx x^3 = 3x^2", "d/dx sin x = cos x", "d/dθ cos θ = -sin θ", "d²/dx² x^3 = 6x", "d/dx (a sin x) = a cos x",
    "d/dx √x = 1/(2√x)", "d(x^2)/dx = 2x", "d(sin θ)/dt = θ' cos θ", "dy/dx = 2x where y = x²", "d/dt (x²) = 2 x x'",
])  # fmt: skip
def test_a_derivative_by_a_letter_is_decided(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.parametrize("claim", ["d/dx x^3 = x^2", "d/dx sin x = sin x / x", "d/dt (x²) = x x'"])
def test_a_wrong_derivative_is_false(claim):
    assert symrot.check(claim, repair=False).verdict == "false"


@pytest.mark.parametrize("claim", [
    "diff(L, q) == 0", r"\frac{d}{dt}(I\omega) = 0", "d/dt(I ω) = 0", "dy/dx = y/x", "d/dt(½ I ω²) = I ω α",
    r"\frac{d}{dt}\frac{\partial L}{\partial\dot q} = -\frac{\partial L}{\partial q}", "d/dt(ψ̇ + φ̇ cos θ) = 0",
])  # fmt: skip
def test_a_rate_that_nothing_defines_is_no_identity(claim):
    verdict = symrot.check(claim, repair=False)
    assert verdict.verdict == "definition"
    assert "nothing here says" in verdict.reason
