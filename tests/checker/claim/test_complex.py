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
    assert symrot.check("i = 3").verdict == "definition"
    assert symrot.check("i*(a + b) == i*a + i*b").notes == ()
