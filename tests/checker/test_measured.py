"""Numbers with units, and angles whose unit was left out."""

from fractions import Fraction

import pytest

import symrot
from symrot.checker.units.conversion import FACTORS, measured_text
from symrot.checker.units.units import read_unit
from symrot.errors import InputError


@pytest.mark.parametrize("claim", [
    "1500 rpm = 157.08 rad/s", "45° = 0.7854 rad", "30 deg = 0.5236 rad", "3 ft = 0.9144 m", "36 km/h = 10 m/s",
    r"\SI{1500}{rpm} = \SI{157.08}{rad/s}", r"1500\,\mathrm{rpm} = 157.08\,\mathrm{rad/s}", "6 N * 2 m = 12 J",
    "2 kg * 3 m/s^2 = 6 N", "1/2 * 2 kg * (3 m/s)^2 = 9 J", "100 rpm + 20 rad/s = 30.47 rad/s", "1 rev = 2 pi rad",
    "1e30 km = 1e33 m", "1 um = 1e-6 m", "1 h = 3600 s", r"90^\circ = \frac{\pi}{2}",
    "1 lbf = 4.448 N",
])  # fmt: skip
def test_numbers_with_units_are_compared_in_si_units(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.parametrize(
    ("claim", "right"),
    [
        ("1500 rpm = 157.09 rad/s", "1500 rpm = 157.08 rad/s"),
        ("3 ft = 0.9145 m", "3 ft = 0.9144 m"),
        ("0.524 rad = 30 deg", None),
        ("157.08 rad/s = 1501 rpm", "157.18 rad/s = 1501 rpm"),
    ],
)
def test_a_wrong_digit_is_false_with_the_right_one(claim, right):
    verdict = symrot.check(claim)
    if right is None:
        assert verdict.verdict == "true"
    else:
        assert (verdict.verdict, verdict.repairs[0].text, verdict.diagnosis.code) == ("false", right, "digits")


@pytest.mark.parametrize("claim", ["5 kg = 5 m", "3 rad/s = 3 m/s", "1 h = 3600 m", "2 N * 3 m = 6 W"])
def test_different_units_are_never_equal(claim):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.diagnosis.code) == ("false", "dimension")
    assert "unit_" not in str(verdict)


def test_a_sum_of_different_units_is_refused():
    with pytest.raises(InputError, match=r"expected terms with one unit, got .* the sum 3 m [+] 2 s is m, term 2 is s"):
        symrot.check("3 m + 2 s = 5 m")


@pytest.mark.parametrize("claim", ["T = 2 m g", "F = 3 m a", "2*m == 2*m", "x = 2 y", "T = 1/2 m v^2", "rpm = n"])
def test_letters_of_a_formula_are_no_units(claim):
    assert measured_text(claim) is None


def test_a_name_may_have_a_value_with_units():
    assert symrot.check("I = 2 kg m^2").verdict == "definition"
    assert symrot.check("I = 2 kg m").diagnosis.code == "dimension"


def test_every_factor_has_a_dimension_and_is_exact():
    for name, (factor, _) in FACTORS.items():
        assert isinstance(factor, Fraction) and factor > 0
        read_unit(name)


@pytest.mark.parametrize(("claim", "right"), [
    ("sin(45) = 0.7071", "sin(45°) = 0.7071"), ("cos(60) == 1/2", "cos(60°) == 1/2"), ("tan 45 = 1", "tan 45° = 1"),
    (r"\sin(30) = \frac12", r"\sin(30^\circ) = \frac12"),
])  # fmt: skip
def test_an_angle_that_is_right_in_degrees_is_diagnosed(claim, right):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.diagnosis.code, verdict.repairs[0].text) == ("false", "degrees", right)
    assert symrot.check(right).verdict == "true"


def test_an_angle_in_radians_is_noted():
    verdict = symrot.check("sin(45) = sin(45)")
    assert verdict.verdict == "true"
    assert any("the angle 45 is in radians" in note for note in verdict.notes)
    assert not any("in radians" in note for note in symrot.check("sin(1) = sin(1)").notes)
