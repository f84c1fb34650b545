"""Equations for a letter are neither true nor false; wrong identities stay false."""

import pytest

import symrot


@pytest.mark.parametrize(("text", "values"), [
    ("x² = 4", "x = -2 and x = 2"), ("x^2 + 5x + 6 = 0", "x = -3 and x = -2"), ("x^3 = 2x - 5", "one real value only"),
    ("sin θ = 3/5", "θ = asin(3/5), for example"), ("1/x = 2", "x = 1/2"), ("|x| = 2", "x = 2, for example"),
    (r"\cos\theta = \frac{1}{2}", r"\theta = \frac{\pi}{3}, for example"), ("1/x^2 = 4", "x = 1/2, for example"),
])  # fmt: skip
def test_an_equation_for_a_letter_says_for_which_values_it_holds(text, values):
    verdict = symrot.check(text)
    assert (verdict.verdict, verdict.counterexample, verdict.repairs) == ("definition", None, ())
    assert verdict.reason.endswith(f"and no identity: it holds for {values}")


def test_two_letters_are_a_condition():
    assert symrot.check("a = b").verdict == "definition"


@pytest.mark.parametrize("text", [
    "2x = 3x", "(x + 1)^2 = x^2 + 1", "3x + 2 = 5x", "x² = -1", "cos θ = 2", "√x = -3", "sin^2 x - cos^2 x = 1", "x**2 == 4",
])  # fmt: skip
def test_a_wrong_identity_and_an_equation_without_a_solution_are_false(text):
    assert symrot.check(text, repair=False).verdict == "false"


def test_a_derivative_that_is_a_hidden_zero_is_no_condition():
    """``diff(x, t) == 0`` states that x is constant, but nobody writes this zero as ``2*y - y - y``."""
    assert symrot.check("diff(sin(x(t)), t) == 0", repair=False).verdict == "definition"
    assert symrot.check("diff(sin(x(t)), t) == 2*y - y - y", repair=False).verdict == "false"
