"""The letter i is the imaginary unit where nothing else makes sense, and a quantity everywhere else."""

import pytest

import symrot


@pytest.mark.parametrize("claim", [
    "i^2 = -1", "1/i = -i", "(a+ib)(a-ib) = a²+b²", "1/(a+ib) = (a-ib)/(a²+b²)", "|e^(ix)| = 1", "sin(ix) = i sinh x",
    "cos(ix) = cosh x", "tanh(ix) = i tan x", "(a + i b)(a - i b) = a^2 - i^2 b^2", r"\ln e = 1",
])  # fmt: skip
def test_an_identity_of_complex_numbers_is_true(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    assert any("is the imaginary unit" in note or "base of the exponential" in note for note in verdict.notes)


@pytest.mark.parametrize("claim", ["i^2 = 1", "i^3 = i", "(a+ib)(a-ib) = a²-b²", "sin(ix) = -i sinh x"])
def test_a_wrong_identity_of_complex_numbers_is_false(claim):
    assert symrot.check(claim, repair=False).verdict == "false"


def test_a_letter_i_may_be_a_quantity():
    assert symrot.check("φ̇ = I_3 ω_3/(I cos θ)").verdict == "recognised"
    assert symrot.check("i = 3").verdict == "definition"
    assert symrot.check("i*(a + b) == i*a + i*b").notes == ()


@pytest.mark.parametrize("claim", [
    "|z|² = x² + y² where z = x + iy", "z̄ z = |z|² where z = x + iy", "z^* z = x^2 + y^2, z = x + i y",
    "Re(e^(iθ)) = cos θ", "Im(e^(iθ)) = sin θ", r"\Re(e^{i\theta}) = \cos\theta", r"\mathrm{Im}(e^{i\theta}) = \sin\theta",
    r"\overline{e^{i\theta}} = e^{-i\theta}", "conj(e^(iθ)) = e^(-iθ)", "z + z̄ = 2 x where z = x + i y",
    "1/z = (x - iy)/(x^2+y^2) where z = x + iy", "z^2 = x^2 - y^2 + 2ixy where z = x+iy", "Re(1+2i) = 1",
    "Re(z) = x where z = x + iy", "z = x + iy, |z|^2 = x^2+y^2",
])  # fmt: skip
def test_parts_conjugates_and_sizes_of_complex_numbers_are_known(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.parametrize("claim", [
    "Im(e^(iθ)) = cos θ", "Re(z) = y where z = x + iy", "z - z̄ = 2 y where z = x + i y", "|z|² = x² - y² where z = x + iy",
    r"\overline{e^{i\theta}} = e^{i\theta}", "|a + i b| = a + b", "z^2 = x^2 + y^2 + 2ixy where z = x+iy",
])  # fmt: skip
def test_wrong_parts_of_complex_numbers_are_false(claim):
    assert symrot.check(claim).verdict == "false"


def test_the_size_of_a_number_in_polar_form_needs_a_radius():
    assert symrot.check("z = r e^(iθ), |z| = r").requires == ("r >= 0",)


def test_a_line_beside_complex_numbers_stays_an_equation_of_real_numbers():
    assert symrot.check("z = x + i y, |z|^2 = x^2 + y^2, sin(2 a) = 2 sin a cos a").verdict == "true"
    assert symrot.check("x_i = a + i b").verdict == "definition"


@pytest.mark.parametrize(("claim", "repaired"), [
    ("e^(iθ) = cos θ - i sin θ", "e^(i*θ) = cos(θ) + i*sin(θ)"),
    (r"e^{i\theta} = \cos\theta + \sin\theta", r"e^{i \theta} = \cos(\theta) + i \sin(\theta)"),
    ("|z|^2 = x^2 - y^2 where z = x + i y", "abs(x + i*y)^2 = x^2 + y^2"), ("e^(iπ) = 1", "e^(i*π) = -1"),
    ("sin x = (e^(ix) - e^(-ix))/2", "sin(x) = (e^(i*x) - e^(-i*x))/(2*i)"),
    (r"\mathrm{Re}(e^{i\theta}) = \sin\theta", r"\Re(e^{i \theta}) = \cos(\theta)"),
])  # fmt: skip
def test_a_repair_has_complex_numbers_as_typed(claim, repaired):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false" and verdict.repairs[0].text == repaired
    assert symrot.check(repaired, repair=False).verdict == "true"
