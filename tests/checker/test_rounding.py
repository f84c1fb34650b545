"""Decimal numbers in claims: right if the value rounds to them, otherwise wrong, with the right digits."""

import pytest

import symrot


@pytest.mark.parametrize("claim", [
    "1500*2*pi/60 == 157.08", "1500*2π/60 = 157.08", "157.08 == 50*pi", "√2 = 1.414", "1/3 = 0.33", "-pi == -3.14",
    "2 sin 45° = 1.41421", "2/3 == 0.667", "exp(1) == 2.718", "2π/86400 = 7.27×10⁻⁵", "-2*pi/86400 == -7.27*10**-5",
    r"\frac{2\pi}{86400} = 7.27\times10^{-5}",
])  # fmt: skip
def test_a_rounded_number_is_true_to_its_digits(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    assert verdict.notes[-1].startswith("to the digits given: the value rounds to ")
    assert verdict.counterexample is None and not verdict.repairs


@pytest.mark.parametrize(("claim", "right"), [
    ("1500*2*pi/60 == 157.09", "1500*2*pi/60 == 157.08"), ("√2 = 1.415", "sqrt(2) = 1.414"), ("2/3 == 0.66", "2/3 == 0.67"),
    ("3.15 == pi", "3.14 == pi"), ("-pi == -3.141", "-pi == -3.142"), ("-pi == 3.14", "-pi == -3.14"),
    ("pi == -3.15", "pi == 3.14"), ("pi == −3.14", "pi = 3.14"), ("-pi == -(3.15)", "-pi == -3.14"),
    ("pi == -(3.15)", "pi == 3.14"), ("-7.28*10^-5 == 2*pi/86400", "7.27*10^(-5) = 2*pi/86400"),
    ("2π/86400 = 7.28×10⁻⁵", "2*π/86400 = 7.27*10^(-5)"),
])  # fmt: skip
def test_a_wrong_digit_is_false_with_the_right_one(claim, right):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false"
    assert verdict.diagnosis.code == "digits"
    assert [repair.text for repair in verdict.repairs] == [right]
    assert symrot.check(right).verdict == "true"


@pytest.mark.parametrize("claim", ["2*pi == 6.28*10^400", "pi*10^400 == 3.15*10^400", "pi*10^-400 == 3.15*10^-400"])
def test_a_wrong_digit_beyond_double_precision_is_false(claim):
    assert symrot.check(claim).verdict == "false"
    assert symrot.check("pi*10^400 == 3.14*10^400").verdict == "true"


@pytest.mark.parametrize(
    ("claim", "repairs"),
    [("2*pi == 6.29e5", []), ("pi/1000 == 0.50", ["pi/1000 == 0.0031"]), ("pi/999 == -0.5", ["pi/999 == 0.003"])],
)
def test_a_value_that_rounds_to_zero_at_the_printed_places_gets_other_places(claim, repairs):
    """``2*pi == 0.00e5`` was offered, which is true to its digits and says nothing."""
    verdict = symrot.check(claim)
    assert verdict.verdict == "false" and [repair.text for repair in verdict.repairs] == repairs


def test_a_number_without_a_point_and_a_formula_with_symbols_are_compared_exactly():
    assert symrot.check("pi == 3").verdict == "false"
    assert symrot.check("x/3 == 0.333*x").verdict == "false"
    assert symrot.check("0.5*x == x/2").notes == ()
    assert symrot.check("0.1 + 0.2 == 0.3").notes == ()
    assert symrot.check("1.5 == 1.49").diagnosis.code != "digits"


def test_digits_with_two_dots_go_on():
    """``0.66..`` are the first digits of 2/3 and no rounded number, as in the texts of counterexamples."""
    assert symrot.check("2/3 = 0.66..").notes == ("to the digits given: the value begins with 0.66",)
    assert symrot.check("-2/3 = -0.666...").verdict == "true"
    assert symrot.check("2/3 = 0.65..").verdict == symrot.check("2/3 = 0.68..").verdict == "false"


def test_a_wrong_number_is_set_against_the_decimal_digits_of_the_value():
    witness = symrot.check("√2 = 1.415").counterexample
    assert (witness.lhs, witness.rhs) == ("sqrt(2) = 1.41421356237..", "1.415")
    witness = symrot.check("1.415 = √2").counterexample
    assert (witness.lhs, witness.rhs) == ("1.415", "sqrt(2) = 1.41421356237..")


def test_a_number_with_many_digits_is_compared_with_all_of_them():
    pi = "3.141592653589793238462643383279502884197169399375105820974944592307816406286208998628"
    assert symrot.check(f"pi == {pi}").verdict == "true"
    assert symrot.check(f"pi == {pi[:-1]}7").verdict == "false"
    assert symrot.check(f"1/3 == 0.{'3' * 62}").verdict == "true"
