"""Numbers of a scene: exact if rational, otherwise correct to 2^-250 (compared with mpmath at 2500 bits)."""

from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy

from symrot.errors import InputError
from symrot.formula.exact_numbers import PI, cos, equal, read, read_angle, sin, sqrt

EXACT = {
    "1/3": Fraction(1, 3),
    "0.6375": Fraction(51, 80),
    "1e-3": Fraction(1, 1000),
    "-2**2": Fraction(-4),
    "(1 + 1/2)**-2": Fraction(4, 9),
    "sqrt(9/4)": Fraction(3, 2),
    "sin(pi/6)": Fraction(1, 2),
    "cos(7*pi/3)": Fraction(1, 2),
    "sin(-pi/2)": Fraction(-1),
    "cos(1000000001*pi/2)": Fraction(0),
    "tan(pi)": Fraction(0),
    "2*pi/pi": Fraction(2),
    "abs(1 - 3)": Fraction(2),
}

REFUSED = [
    "", " ", "1 kg", "four", "1_000", "0x10", "nan", "inf", "1e400", "1e999999999", "-1e-400", "1/0", "tan(pi/2)",
    "sqrt(-1)", "9**9**9", "((9**64)**64)**64", "(" * 10_000, "1+" * 5_000 + "1", "__import__('os')", "x",
    "atan2(1, 2)", float("nan"), float("inf"), Decimal("NaN"), Decimal("-Infinity"), Decimal("1e999999999999"), 10**400,
    True, False, None, [1], {}, b"1", 1j, object(),
]  # fmt: skip


def real(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator


@pytest.mark.parametrize(("text", "value"), EXACT.items())
def test_a_rational_value_is_exact(text, value):
    assert read(text) == value


def test_rationals_of_other_libraries_are_exact():
    assert read(sympy.Rational(1, 3)) == Fraction(1, 3)
    assert read(np.int64(2**53 + 1)) == 2**53 + 1


def test_a_float_is_its_binary_value_and_a_decimal_is_what_it_says():
    assert read(0.1) == Fraction(0.1) != Fraction(1, 10)
    assert read(Decimal("0.1")) == read("0.1") == Fraction(1, 10)
    assert read(7) == read(Fraction(7)) == 7


@pytest.mark.parametrize("value", [Fraction(1, 3), Fraction(-355, 113), Fraction(10) ** 300, Fraction(1, 10**100)])
def test_the_circular_functions_are_right(value):
    with mpmath.workprec(2500):
        assert abs(real(sin(value)) / mpmath.sin(real(value)) - 1) < mpmath.mpf(2) ** -250
        assert abs(real(cos(value)) / mpmath.cos(real(value)) - 1) < mpmath.mpf(2) ** -250


def test_pi_and_roots_are_right():
    with mpmath.workprec(2500):
        assert abs(real(PI) - mpmath.pi) < mpmath.mpf(2) ** -318
        for value in (Fraction(2), Fraction(1, 7 * 10**200), Fraction(10**301, 3)):
            assert abs(real(sqrt(value)) ** 2 / real(value) - 1) < mpmath.mpf(2) ** -318


def test_an_angle_keeps_its_part_of_pi():
    right = read_angle(90, degrees=True)
    assert (right.cos, right.sin) == (0, 1)
    assert read_angle("pi/2") == right
    assert read_angle("-3*pi").cos == -1
    assert read_angle("pi/4").cos == read_angle(45, degrees=True).sin
    mixed = read_angle("1 + pi/2")
    assert equal(mixed.sin, cos(Fraction(1))) and equal(mixed.radians, 1 + PI / 2)
    assert equal(read_angle("pi", degrees=True).radians, PI * PI / 180)


def test_equal_sees_the_difference_of_two_decimals_and_not_that_of_two_roundings():
    assert equal(sqrt(Fraction(2)) * sqrt(Fraction(3)), sqrt(Fraction(6)))
    assert not equal(Fraction(1), Fraction(1) + Fraction(1, 10**50))
    assert equal(Fraction(0), Fraction(0)) and not equal(Fraction(0), Fraction(1, 2**300))


@pytest.mark.parametrize("value", REFUSED, ids=lambda value: repr(value)[:20])
def test_what_is_no_number_is_refused_in_one_sentence(value):
    with pytest.raises(InputError, match=r"^body\.mass: expected a number, such as .*, got ") as error:
        read(value, "body.mass")
    assert "\n" not in str(error.value) and len(str(error.value)) < 260
