"""Dual numbers: powers and their derivatives."""

import pytest

from symrot.codegen.duals import Dual
from symrot.codegen.recording import Recorder


@pytest.mark.parametrize("exponent", [-2, -1, 0, 1, 2, 5])
def test_the_derivative_of_a_power(exponent):
    """d(x^n)/dx = n x^(n - 1), also for n = 0."""
    power = Dual(2.0, {"x": 1.0}) ** exponent
    assert power.value == 2.0**exponent
    assert power.slopes.get("x", 0.0) == exponent * 2.0 ** (exponent - 1)


def test_a_recorded_zeroth_power_is_one():
    """``y x^0`` is y in a recorded program."""
    recorder = Recorder()
    x, y = recorder.symbol("x"), recorder.symbol("y")
    assert (y * x**0).index == y.index
