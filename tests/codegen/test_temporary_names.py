"""Names of temporaries describe what they hold, are unique, and are valid in C, C++ and Python."""

import keyword
import re
from fractions import Fraction

import pytest

from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.lowering.temporary_names import LONGEST, with_names
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import parse
from symrot.kernels.library import definition, kernel_names

STATES = ("q1", "q2", "theta", "A", "B", "C", "omega_1")


def named(*formulas, outputs=("y1",), numbers=None):
    """Return the names of the temporaries of some formulas; later formulas may contain #0, #1 and so on for earlier
    ones.
    """
    inputs = Argument("x", "in", tuple((name, "", "") for name in STATES))
    results = Argument("y", "out", tuple((name, "", "") for name in outputs))
    old = [f"t{i}_" for i in range(len(formulas))]
    nodes = [parse(formula.replace("#", "t").replace("@", "_")) for formula in formulas]
    shares = tuple((output, parse(old[-1])) for output in outputs)
    program = Program(Signature("f", (inputs, results)), tuple(zip(old, nodes, strict=True)), shares)
    return [name for name, _ in with_names(program, old, numbers or {}).temporaries]


@pytest.mark.parametrize(
    ("formula", "name"),
    [
        ("q1*q2", "q1_q2"), ("omega_1*omega_1", "omega_1_sq"), ("2*q1*q2", "two_q1_q2"), ("q1/2", "half_q1"),
        ("-q1", "minus_q1"), ("A/C", "A_over_C"), ("1/A", "inv_A"), ("A*A*A/(B*B)", "A_cubed_over_B_sq"),
        ("A/80", "A_over_80"), ("A*7/13", "y1_term_1"), ("A - B", "A_minus_B"), ("1 - q1*q1", "one_minus_q1_sq"),
        ("sin(theta)", "sin_theta"), ("sin(theta/2)", "sin_half_theta"), ("sqrt(A*A + B*B)", "sqrt_A_sq_plus_B_sq"),
        ("atan2(q1, q2)", "y1_angle_1"), ("A + B + C + q1", "y1_term_1"),
        ("omega_1*(omega_1 + theta)", "y1_term_1"),
    ],
)  # fmt: skip
def test_a_name_says_what_the_formula_is(formula, name):
    assert named(formula) == [name]


def test_products_of_products_are_multiplied_out():
    assert named("2*q1", "t0_*q2", "t1_*t0_") == ["two_q1", "two_q1_q2", "four_q1_sq_q2"]


def test_equal_names_of_different_formulas_are_told_apart():
    """(A*B)*C and A*(B*C) round differently, so they get two temporaries."""
    assert named("A*B*C", "A*(B*C)", "t0_ + t1_")[:2] == ["A_B_C", "y1_term_1"]


def test_a_name_is_none_of_an_input_an_output_or_an_argument():
    assert named("A*B", outputs=("A_B",)) == ["A_B_term_1"]


def test_a_long_name_is_numbered_by_the_output_that_needs_it_first():
    names = named("A + B + C + q1", "A + B + C + q2", "t0_*t1_", outputs=("domega_1", "domega_2"))
    assert names == ["domega_1_term_1", "domega_1_term_2", "domega_1_term_1_domega_1_term_2"]


def test_numbers_are_named_by_their_formula():
    assert named("-A", numbers={"A": parse("2*pi")}) == ["minus_two_pi"]
    assert named("3*A", numbers={"A": ("number", Fraction(1, 2))}) == ["y1_term_1"]  # a number has no name


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", kernel_names())
def test_every_temporary_of_the_library_has_a_name_of_its_own(name):
    program = kernel_program(name)
    given = {str(symbol) for symbol, _ in definition(name).named}
    arguments = program.signature.arguments
    used = [a.name for a in arguments] + [component[0] for a in arguments for component in a.components]
    temporaries = [temporary for temporary, _ in program.temporaries]
    assert len({*temporaries}) == len(temporaries) and not {*temporaries} & {*used}
    for temporary in temporaries:
        assert re.fullmatch(r"[A-Za-z]\w*", temporary, re.ASCII) and not keyword.iskeyword(temporary)
        assert not re.fullmatch(r"[a-z]\d+", temporary)
        assert len(temporary) <= LONGEST or temporary in given
