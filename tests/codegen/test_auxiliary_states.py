"""Auxiliary states that follow the attitude have the exact Taylor coefficients of what they stand for; nothing else
becomes one.
"""

from fractions import Fraction

import pytest

from symrot.bench import taylor as bench
from symrot.codegen.taylor import auxiliary_states
from symrot.codegen.taylor.auxiliary_states import with_companions
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.lanes import cost, lay_out
from symrot.codegen.taylor.recurrences import recurrences
from tests.codegen.test_recurrences import program

UNIT = {"q0": Fraction(1, 10), "q1": Fraction(7, 10), "q2": Fraction(-1, 2), "q3": Fraction(1, 2)}
CIRCLE = {"sin": lambda x: Fraction(3, 5), "cos": lambda x: Fraction(4, 5)}  # of whatever angle: all clocks are one
KINEMATICS = {
    "q0": "-(q1*w1 + q2*w2 + q3*w3)/2", "q1": "(q0*w1 + q2*w3 - q3*w2)/2", "q2": "(q0*w2 + q3*w1 - q1*w3)/2",
    "q3": "(q0*w3 + q1*w2 - q2*w1)/2",
}  # fmt: skip


def same(system, lifted, quaternion=UNIT, order=6):
    values = {name: Fraction(k + 2, 7) for k, name in enumerate(system.parameters)}
    values |= {name: Fraction(k + 1, 3) for k, name in enumerate(system.states)} | quaternion | {"t": Fraction(1, 3)}
    return coefficients(system, order, values, CIRCLE) == coefficients(lifted, order, values, CIRCLE)


def turning(*torques):
    return recurrences(program({**dict(zip(("w1", "w2", "w3"), torques, strict=True)), **KINEMATICS}))


@pytest.mark.parametrize(
    ("name", "count"),
    [("heavy symmetric", 3), ("heavy asymmetric", 3), ("gravity gradient", 6), ("free asymmetric", 0)],
)
def test_companions_follow_the_attitude(name, count):
    """Orders 0 to 6 are exact: gamma' = gamma x omega, also for two directions of which one rotates with time."""
    system = recurrences(bench.SteppedProblem(name, 1.0).kernel.rates)
    lifted = with_companions(system)
    assert len(lifted.seeds) == count and (count or lifted is system)
    assert same(system, lifted)
    if name == "heavy asymmetric":  # of any quaternion it would be another motion: the comparison can fail
        assert not same(system, lifted, UNIT | {"q0": Fraction(1, 5)})


def test_sums_of_directions_products_of_directions_and_constants():
    system = turning(
        "(q0*q1 + q2*q3)*(1 - 2*(q1*q1 + q2*q2)) - k*w2*w3",
        "k*(q1*q3 - q0*q2)*w1 + 3*(q0*q2 - q3*q1) + 1/7",
        "(q1*q1 + q2*q2)*(w1 + k)",
    )
    lifted = with_companions(system)
    assert lifted.seeds and same(system, lifted)


@pytest.mark.parametrize(
    "torques",
    [
        ("q1*q2*w1*w1", "w1*w2*w3", "k*w1"),  # two rates beside a product of attitudes are a matter of their own
        ("q1*q2*q3*q0*q1*q2*q3 + q1*q2*q2*q2", "sin(q1*q2)", "exp(q1)*q2"),
    ],
)
def test_what_does_not_close_stays_or_stays_right(torques):
    system = turning(*torques)
    lifted = with_companions(system)
    functions = CIRCLE | {"exp": lambda x: Fraction(2, 3)}
    values = (
        {name: Fraction(k + 1, 3) for k, name in enumerate(system.states)} | UNIT | {"k": Fraction(2), "t": Fraction(1)}
    )
    assert coefficients(system, 5, values, functions) == coefficients(lifted, 5, values, functions)


def test_no_companions_without_a_constant_norm():
    """A quaternion whose norm changes, and states that only have the names of one, get no auxiliary states."""
    stretched = program(
        {"w1": "q0*q1", **{name: f"{rate} + q0/9" for name, rate in KINEMATICS.items()}, "w2": "0*w2", "w3": "0*w3"}
    )
    for system in (recurrences(stretched), recurrences(program({"x": "x*y", "y": "x - y"}))):
        assert with_companions(system) is system


def test_a_system_whose_products_grow_too_long_is_left_alone(monkeypatch):
    system = turning("q0*q1 + q2*q3", "q0*q2 - q1*q3", "0*w3")
    assert with_companions(system) is not system
    monkeypatch.setattr(auxiliary_states, "MOST_TERMS", 1)
    assert with_companions(system) is system


def test_a_layout_takes_companions_where_they_save_sums():
    problem = bench.SteppedProblem("gravity gradient", 1.0)
    system = recurrences(problem.kernel.rates)
    plain, lifted = (lay_out(one, problem.blocks) for one in (system, with_companions(system)))
    assert len(lifted.columns) < len(plain.columns) and cost(lifted) < cost(plain)
    assert len(lifted.seeds) == 2 and len(lifted.states) == len(plain.states) == 2
