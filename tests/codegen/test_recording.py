"""Recorded computations: the programs give the same values, and numbers that multiply each other are one number."""

from fractions import Fraction

import pytest

from symrot.codegen.recording import Recorder
from symrot.formula.program import Argument, Program, Signature

SIGNATURE = Signature("f", (Argument("x", "in", (("x", "", ""),)), Argument("y", "out", (("y", "", ""),))))


def _program(factors: list[Fraction]) -> Program:
    recorder = Recorder()
    value = recorder.symbol("x")
    for factor in factors:
        value = factor * value
    return recorder.program(SIGNATURE, {"y": value})


@pytest.mark.parametrize(
    ("factors", "products"),
    [([2, 2], 1), ([Fraction(1, 3), Fraction(3, 7), 14], 1), ([2, Fraction(1, 2)], 0), ([Fraction(10) ** 200] * 2, 2)],
)
def test_numbers_that_multiply_each_other_are_one_number(factors, products):
    """2 (2 x) is 4 x, 2 (x/2) is x; a number beyond the range of doubles, such as 1e400, stays a product of two."""
    program = _program(factors)
    assert program.operations()["mul"] == products
    exact = Fraction(1)
    for factor in factors:
        exact *= factor
    assert program.evaluate({"x": Fraction(5)}, {}, Fraction)["y"] == 5 * exact
