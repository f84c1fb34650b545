"""Formulas as text: parsing returns what was written, and refuses everything else."""

from fractions import Fraction

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from symrot.errors import InputError
from symrot.formula.tree import evaluate, names, operations, parse, text, vanishes

LEAVES = st.one_of(
    st.integers(0, 99).map(lambda n: ("number", Fraction(n))), st.sampled_from("abc").map(lambda s: ("symbol", s))
)
TREES = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from("+-*/"), inner, inner),
        inner.map(lambda a: ("neg", a)),
        st.tuples(st.just("**"), inner, st.integers(-3, 3)),
        inner.map(lambda a: ("call", "sin", (a,))),
    ),
    max_leaves=12,
)


@example(("neg", ("**", ("**", ("number", Fraction(0)), 0), 0)))
@settings(deadline=None)
@given(TREES)
def test_printing_and_reading_are_inverse(tree):
    """No bracket is lost or unnecessary, so the order of evaluation stays the same."""
    assert parse(text(tree)) == tree


@pytest.mark.parametrize(
    ("source", "value"),
    [
        ("2 + 3*4", 14), ("2*3**2", 18), ("-3**2", -9), ("(1 - 2) - 3", -4), ("1 - (2 - 3)", 2), ("1/2/2", Fraction(1, 4)),
        ("2**-2", Fraction(1, 4)), ("1.5e1", 15), ("0.6375", Fraction(51, 80)), ("- -1", 1), ("x*-y", -6),
    ],
)  # fmt: skip
def test_arithmetic_is_exact_and_ordered_as_usual(source, value):
    assert evaluate(parse(source), {"x": Fraction(2), "y": Fraction(3)}) == value


@pytest.mark.parametrize(
    ("source", "position"),
    [
        ("", 1), ("__import__('os')", 12), ("9**9**9", 5), ("2**0.5", 4), ("2**65", 4), ("f(x)", 1), ("a b", 3), ("a.b", 2), ("x +", 4),
        ("sin(1, 2)", 1), ("1e999999", 1), ("(a", 3), ("a)", 2), ("lambda: 1", 7), ("a[0]", 2), ("é", 1), ("1__0", 2),
    ],
)  # fmt: skip
def test_what_is_not_understood_is_refused_with_its_position(source, position):
    with pytest.raises(InputError, match=rf"torque: .* at position {position} of"):
        parse(source, "torque")


@pytest.mark.parametrize("source", ["(" * 5000, "1" * 5000, "-" * 5000, "x" * 20_000, "sin(" * 3000])
def test_hostile_lengths_are_refused(source):
    with pytest.raises(InputError):
        parse(source)


def test_names_and_operations():
    node = parse("k*omega_1**3 - sin(t)/k")
    assert names(node) == {"k", "omega_1", "t"}
    assert operations(node) == {"mul": 3, "add": 1, "sin": 1, "div": 1}


@pytest.mark.parametrize(("formula", "zero"), [
    ("x*y", True), ("x + y", False), ("x - x*y", True), ("sin(x)*3", True), ("cos(x)", False), ("x/y", True),
    ("y/x", False), ("-x**2", True), ("0*y", True), ("sqrt(x + 0)", True), ("exp(x) - 1", False), ("x**3*log(y)", True),
])  # fmt: skip
def test_a_formula_vanishes_by_its_form(formula, zero):
    assert vanishes(parse(formula), {"x"}) is zero
