"""Signs of copied text: ≈, percent, thousands, braces without commands, "where" in LaTeX, rounded numbers in LaTeX."""

import pytest

import symrot
from symrot.errors import InputError


@pytest.mark.parametrize("text", [
    "arcsin(0.6) ≈ 36.87 degrees", "sqrt(2) ≈ 1.414", r"\pi \approx 3.1416", r"\sqrt{2} = 1.414", " pi = 3.14",
    r"\arcsin 0.6 = 36.87^\circ", r"\cos^{-1}(0.3) = 72.54^{\circ}", "1,500 rpm = 157.08 rad/s", "1,500 = 1500",
    "50% = 0.5", "2/3 = 66.7%", "1/3 = 33%", r"\frac{1}{3} = 33.3\%", "360°/86164 s = 7.2921e-5 rad/s",
    "e^{i x} = cos x + i sin x", r"\bar z z = x^2 + y^2 where z = x + i y",
    "α δ − β γ = 1 where α = e^{i(ψ+φ)/2} cos(θ/2), β = i e^{i(ψ−φ)/2} sin(θ/2), "
    "γ = i e^{−i(ψ−φ)/2} sin(θ/2), δ = e^{−i(ψ+φ)/2} cos(θ/2)",
])  # fmt: skip
def test_a_right_formula_is_true(text):
    assert symrot.check(text).verdict == "true"


@pytest.mark.parametrize(("text", "right"), [
    ("sqrt(2) ≈ 1.5", "1.4"), (r"\pi \approx 3.15", "3.14"), ("1/3 = 34%", "33%"),
    ("1,500 rpm = 157.09 rad/s", "157.08"),
])  # fmt: skip
def test_a_wrong_digit_is_repaired(text, right):
    verdict = symrot.check(text)
    assert verdict.verdict == "false"
    assert right in verdict.repairs[0].text


@pytest.mark.parametrize("text", ["x ≈ sin y", "pi ≈ 22/7"])
def test_an_approximation_without_digits_is_refused(text):
    with pytest.raises(InputError, match="write = and the value to as many digits as you know"):
        symrot.check(text)


def test_a_comma_between_arguments_is_no_separator_of_thousands():
    assert symrot.check("atan2(1,500) = atan(1/500)").verdict == "true"


def test_words_after_where_that_define_nothing_are_not_read():
    assert symrot.check(r"T = \frac{1}{2} I \omega^2 where I is the moment of inertia").verdict == "recognised"


def test_the_factorial_of_a_number_is_read_and_of_a_letter_is_refused():
    assert symrot.check("10! = 3628800").verdict == "true"
    assert symrot.check("5!/3! = 21").verdict == "false"
    with pytest.raises(symrot.InputError, match="a factorial is read for numbers up to 30"):
        symrot.check("n! = n (n - 1)!")
