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
    "1 lbf = 4.448 N", "9.81 m/s² = 32.2 ft/s²", "9.82 m/s^2 = 32.2 ft/s^2", "1 rad = 57.3°", "1 rpm = 6°/s",
    "√(9.81 m/s² / 1 m) = 3.132 rad/s", "2π√(1 m/9.81 m/s²) = 2.006 s", "10 m / 2 s = 5 m/s", "1/2 kg = 500 g",
    "(3 + 4)/2 s = 3.5 s", "(2 + 3) m = 5 m", "3×10^8 m/s = 300000 km/s", "1 kg·m²/s² = 1 J", "1 Hz = 1/s",
    "3000 rpm = 50 Hz", "1 Hz = 2π rad/s", "1 g = 9.81 m/s^2", "5 g = 0.005 kg", "60 mph = 88 ft/s", "1 hp = 745.7 W",
    "1 kWh = 3.6 MJ", "1 mile = 5280 ft", "1 atm = 101325 Pa", "2 * 3 rad/s = 6 rad/s", "asin(1) = 90 deg",
    "20 N m / 4 kg m^2 = 5 rad/s^2", "20 N m / (4 kg m^2) = 5 rad/s^2",
    "1 lb ft = 1.356 N m", "100 lb = 444.8 N", "1 lb = 0.4536 kg", "asin(0.6) = 36.87°",
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
        ("1 rad = 57.4°", "1 rad = 57.3°"),
        ("I = 1/12 * 3 kg * (2 m)^2 = 2 kg m^2", "I = 1/12 * 3 kg * (2 m)^2 = 1 kg m^2"),
        ("6 N * 2 m = 13 J", "6 N * 2 m = 12 J"),
        ("2π√(1 m/9.81 m/s²) = 2.016 s", "2π√(1 m/9.81 m/s²) = 2.006 s"),
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


@pytest.mark.parametrize(
    "claim", ["T = 2 m g", "F = 3 m a", "2*m == 2*m", "x = 2 y", "T = 1/2 m v^2", "rpm = n", "T = 3 mg"]
)
def test_letters_of_a_formula_are_no_units(claim):
    assert measured_text(claim) is None


@pytest.mark.parametrize(("claim", "note"), [
    ("5 percent = 0.05", "1 percent = 1/100"), ("30 deg = 0.5236 rad", "1 deg = pi/180 rad"),
    ("1 rpm^2 = 0.01097 /s^2", "1 rpm^2 = pi^2/900 1/s^2"), ("2 deg/s^2 = 0.0349 rad/s^2", "1 deg/s^2 = pi/180 rad/s^2"),
    ("1 kHz = 1000/s", "1 kHz = 1000 1/s"),
])  # fmt: skip
def test_only_angles_are_converted_to_radians(claim, note):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true" and note in verdict.notes


def test_a_hertz_is_a_rotation_per_second_next_to_an_angle():
    verdict = symrot.check("1 Hz = 1 rad/s")
    assert verdict.verdict == "false"
    assert "with the hertz as one per second, and the radian as 1, it is true" in verdict.notes


def test_g_next_to_an_acceleration_is_no_gram_and_has_no_exact_value():
    verdict = symrot.check("2 g = 19.62 m/s^2")
    assert verdict.verdict == "definition"
    assert "g is an acceleration here, and its value is not stated" in verdict.reason
    assert symrot.check("5 g = 0.05 kg").verdict == "false"


@pytest.mark.parametrize("claim", [
    "1/12 m L^2 = 1 kg m^2", "F = m a = 2 kg * 3 m/s^2 = 6 N", "v^2/r = 9.81 m/s^2", "2 v^2/r + a = 9.81 m/s^2",
    r"\frac{1}{12} m L^2 = 1\,\mathrm{kg}\,\mathrm{m}^2",
])  # fmt: skip
def test_an_equation_of_letters_and_a_number_with_a_unit_is_never_false(claim):
    assert symrot.check(claim).verdict == "definition"


def test_the_numbers_at_the_end_of_a_chain_are_decided():
    verdict = symrot.check("F = m a = 2 kg * 3 m/s^2 = 7 N")
    assert (verdict.verdict, verdict.repairs[0].text) == ("false", "2 kg * 3 m/s^2 = 6 N")


def test_a_temperature_in_degrees_is_refused():
    with pytest.raises(InputError, match="expected a temperature in K, got one in '°C'"):
        symrot.check("20°C = 293.15 K")


@pytest.mark.parametrize("claim", ["2π/60 s = 0.105 rad/s", "10 J/2 N = 5 J N"])
def test_a_note_tells_how_a_unit_after_a_quotient_is_read(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    words = "read with a quotient such as 1/2 s as 1/(2 s), and one such as 6 m/2 s as (6 m/2) s"
    assert verdict.notes[-1] == words


def test_a_name_may_have_a_value_with_units():
    assert symrot.check("I = 2 kg m^2").verdict == "definition"
    assert symrot.check("I = 2 kg m").diagnosis.code == "dimension"


def test_every_factor_has_a_dimension_and_is_exact():
    for name, (factor, _) in FACTORS.items():
        assert isinstance(factor, Fraction) and factor > 0
        read_unit(name)


@pytest.mark.parametrize(("claim", "right"), [
    ("sin(45) = 0.7071", "sin(45°) = 0.7071"), ("cos(60) == 1/2", "cos(60°) == 1/2"), ("tan 45 = 1", "tan 45° = 1"),
    (r"\sin(30) = \frac12", r"\sin(30^\circ) = \frac12"), ("30 sin(30) = 15", "30 sin(30°) = 15"),
    ("cos(22.5)^2 = (2 + sqrt(2))/4", "cos(22.5°)^2 = (2 + sqrt(2))/4"), ("sin(1e2) = cos(10)", "sin(1e2°) = cos(10°)"),
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


@pytest.mark.parametrize(
    "claim", ["asin(0.6) = 37°", "37° = asin(0.6)", "1500 rpm = 157 rad/s", "1 rad = 57°", "sqrt(200) m = 14 m"]
)
def test_a_whole_number_with_a_unit_may_be_the_rounding_of_an_irrational_value(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true"
    assert any(note.startswith("to the digits given") for note in verdict.notes)


@pytest.mark.parametrize(("claim", "right"), [
    ("arcsin 0.6 = 36°", "arcsin 0.6 = 37°"), ("1500 rpm = 158 rad/s", "1500 rpm = 157 rad/s"), ("1 rad = 58°", "1 rad = 57°"),
])  # fmt: skip
def test_a_wrong_whole_number_gets_the_right_one(claim, right):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.repairs[0].text) == ("false", right)


@pytest.mark.parametrize(
    "claim", ["60 rpm = 6 rad/s", "180° = 3 rad", "asin(0.5) = 31°", "sqrt(144) m = 13 m", "1 rad = 60°"]
)
def test_one_digit_a_last_zero_and_a_rational_value_leave_no_room_for_rounding(claim):
    assert symrot.check(claim).verdict == "false"


def test_a_prime_after_a_number_is_no_rate():
    """90' was the rate of 90, so that 90' = 1.5° was false."""
    with pytest.raises(symrot.InputError, match="deg for an angle, such as"):
        symrot.check("90′ = 1.5°")


def test_a_repair_has_units_and_no_names_for_them():
    assert symrot.check("5% = 0.5").repairs[0].text == "5 % = 0.05"
