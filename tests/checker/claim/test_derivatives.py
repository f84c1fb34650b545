"""Derivatives with respect to any letter are read; what nothing defines has no derivative that could be zero."""

import pytest

import symrot
from symrot.errors import InputError


@pytest.mark.parametrize("claim", [
    "d/dx x^3 = 3x^2", "d/dx sin x = cos x", "d/dθ cos θ = -sin θ", "d²/dx² x^3 = 6x", "d/dx (a sin x) = a cos x",
    "d/dx √x = 1/(2√x)", "d(x^2)/dx = 2x", "d(sin θ)/dt = θ' cos θ", "dy/dx = 2x where y = x²", "d/dt (x²) = 2 x x'",
    "d²/dt² cos θ = -θ'' sin θ - θ'² cos θ", "d^2/dt^2 (3) = 0", "d/dt (d/dt θ) = θ''", "d^2 y/dx^2 = 2 where y = x²",
])  # fmt: skip
def test_a_derivative_by_a_letter_is_decided(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.parametrize("claim", ["d/dx x^3 = x^2", "d/dx sin x = sin x / x", "d/dt (x²) = x x'", "d²/dt² x² = 2 x'²"])
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


def test_a_derivative_that_may_be_a_square_is_refused():
    with pytest.raises(InputError, match="brackets for a square"):
        symrot.check("dy²/dx² = 4")


@pytest.mark.parametrize(("claim", "verdict"), [
    ("diff(x*y, q) == diff(x, q)*y + x*diff(y, q)", "true"), ("diff(x*y, q) == diff(x, q)*diff(y, q)", "false"),
    ("diff(x/y, t) == (diff(x, t)*y - x*diff(y, t))/y**2", "true"), ("diff(m*v, t) == m*diff(v, t)", "true"),
    ("diff(m*v**2/2, t) == m*v*diff(v, t)/2", "false"), ("diff(I*w, t) == I*diff(w, t) + w*diff(I, t)", "true"),
    ("diff(x*cos(phi(t))**2, t) == diff(x, t)*cos(phi(t))**2 + x*diff(cos(phi(t))**2, t)", "true"),
    ("diff(x*cos(phi(t))**2, t) == diff(x, t)*(sin(a)**2 + cos(a)**2)", "false"),
    ("d/dx (u v) = u dv/dx + v du/dx", "true"), ("diff(I*w, t) == diff(H, t) + m", "definition"),
    ("diff(x*diff(y, x), x) == x*diff(y, x)", "definition"), ("diff(r*w, t) == diff(p, t)", "definition"),
    ("diff(x*cos(phi(t))**2, t) == diff(x/4, t)", "false"), ("diff(x*y, t) == diff(y*x, t)", "true"),
    ("diff(Rz(phi(t)), t) == diff(Rz(b)*Rz(-b), t)", "false"), ("diff(I*w, t) == 0", "definition"),
    ("diff(y, x) == y", "definition"), ("diff(x*y, p) == diff(x, q)*y", "definition"),
])  # fmt: skip
def test_rules_of_differentiation_are_decided_for_all_functions(claim, verdict):
    """Letters that the text differentiates are functions; an equation for them is no rule."""
    assert symrot.check(claim, repair=False).verdict == verdict


def test_letters_of_a_rule_are_called_functions_or_constants():
    notes = symrot.check("diff(m*x*y, q) == m*diff(x, q)*y + m*x*diff(y, q)").notes
    assert notes == ("x and y are functions of q here", "m is a constant here")
