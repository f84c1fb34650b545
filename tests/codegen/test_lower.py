"""Lowering costs no operation that a special case does not need."""

from fractions import Fraction

import sympy

from symrot.bench.skip import general_plan, rungs
from symrot.codegen.lowering.lower import lower
from symrot.codegen.scene_kernels import rates_program
from symrot.dynamics.equations import equations_of_motion
from symrot.formula.program import Argument, Signature
from symrot.planning.plan import make_plan


def test_constants_of_nested_sums_meet_in_one():
    """``k + m (1 - 2 a^2) + n (1 - 2 a^2 - 2 b^2)`` has one constant term, and one term for each square."""
    a, b, k, m, n = (sympy.Symbol(s, real=True) for s in "abkmn")
    given = Argument("v", "in", (("a", "1", ""), ("b", "1", "")))
    out = Argument("out", "out", (("x", "1", ""),))
    nested = k + m * (1 - 2 * a**2) + n * (1 - 2 * a**2 - 2 * b**2)
    lowered = lower(Signature("f", (given, out)), [("x", nested)])
    assert lowered.program.operations() == {"mul": 4, "add": 2}
    assert len(lowered.parameters) == 3


def test_a_sum_that_contains_a_shared_sum_twice_keeps_both():
    """``k (a + b) + k a + k b + k c`` is twice ``k (a + b)`` plus ``k c``, also if ``a + b + c`` is shared."""
    a, b, c, k = (sympy.Symbol(s, real=True) for s in "abck")
    given = Argument("v", "in", (("a", "1", ""), ("b", "1", ""), ("c", "1", "")))
    out = Argument("out", "out", (("x", "1", ""), ("y", "1", "")))
    outputs = [("x", k * (a + b) + k * a + k * b + k * c), ("y", a + b + c)]
    lowered = lower(Signature("f", (given, out)), outputs)
    values = {"a": Fraction(2), "b": Fraction(3), "c": Fraction(5), "p0": Fraction(7)}
    assert lowered.program.evaluate(values) == {"x": 7 * 15, "y": 10}


def test_a_special_case_takes_no_more_operations():
    """For each motion of `symrot bench --skip`, the scene's own rates are compared with the general rates."""
    scenes = [scene for _, scene in rungs().values()][:3]
    plans = [general_plan(scenes[0]), *map(make_plan, scenes)]
    costs = [
        sum(rates_program(equations_of_motion(plan.structure), "rates").program.operations().values()) for plan in plans
    ]
    assert costs == sorted(costs, reverse=True)
    assert costs[2] <= 0.9 * costs[1]  # principal axes: no products of inertia
