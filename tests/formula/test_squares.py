"""Squares under roots: sqrt(u^2 v) = abs(u) sqrt(v), however the square is written."""

from math import isclose, sqrt
from random import Random

import pytest

from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.squares import square_under_root
from symrot.formula.switches import has_switches
from symrot.formula.tree import evaluate, parse

SQUARES = (
    "t**2", "(t - c)**2", "4*(t - c)**2", "(t - c)**2*omega_1**4", "(t - c)**3", "(t - c)**2/omega_1**2", "sin(t)**2*q1",
    "t**2 - 2*c*t + c**2", "t*t + 2*t + 1", "1/4 - sin(t) + sin(t)**2", "t**4 + 2*t**2 + 1",
)  # fmt: skip
OTHERS = (
    "((t + omega_1 + omega_2 + omega_3 + q0 + q1 + q2 + q3)**2)**8 + 1",  # 245157 terms
    "t",
    "t**2 + 1",
    "1 - cos(t)",
    "omega_1**2 + omega_2**2",
    "t**2 - 2*c*t + c",
    "2",
    "c**3 + 1",
    "1/t",
)


@pytest.mark.parametrize("radicand", SQUARES)
def test_a_square_and_the_rest_make_up_the_radicand(radicand):
    node = parse(radicand, switching=True)
    root, rest = square_under_root(node)
    source = Random(radicand)
    for _ in range(20):
        values = {name: source.uniform(0.1, 3) for name in ("t", "c", "omega_1", "q1")}
        u, v, whole = (evaluate(part, values, FLOAT_FUNCTIONS, float) for part in (root, rest, node))
        assert isclose(u * u * v, whole, rel_tol=1e-9, abs_tol=1e-12)
        assert v < 0 or isclose(abs(u) * sqrt(v), sqrt(abs(whole)), rel_tol=1e-6, abs_tol=1e-9)


@pytest.mark.parametrize("radicand", OTHERS)
def test_what_is_no_square_is_left_alone(radicand):
    assert square_under_root(parse(radicand, switching=True)) is None


@pytest.mark.parametrize(("formula", "bends"), [
    ("sqrt((t - 5)**2)", True), ("exp(-sqrt(omega_3**2))", True), ("sqrt(c**2)", False), ("sqrt(c**2*t)", False),
    ("sqrt(1 + t)", False), ("sqrt(t**2*abs(t))", True),
])  # fmt: skip
def test_a_root_of_a_square_bends_where_time_or_a_state_is_in_it(formula, bends):
    assert has_switches(parse(formula, switching=True)) is bends
