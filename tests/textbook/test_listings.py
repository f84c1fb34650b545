"""The code listings of a document, run statement by statement: they obey the laws that symrot derives."""

import tomllib
from pathlib import Path

import pytest
from sympy import Matrix, Rational, diag, eye, pi, symbols, zeros

import symrot
from symrot.textbook import document
from tests.textbook.listing import assignments, run

LISTINGS = tomllib.loads((Path(__file__).parents[1] / "reference" / "textbook_listings.toml").read_text("utf-8"))
SETTINGS = {"time"}
"""Assignments that state nothing: how long the motion is integrated."""


@pytest.mark.parametrize("name", LISTINGS)
def test_every_assignment_of_a_listing_is_printed_by_a_claim(name):
    printed = "".join("".join(claim["printed"].split()) for claim in document("brown").claims.values())
    for target, formula in assignments(LISTINGS[name]["text"]):
        assert target in SETTINGS or "".join(f"{target}={formula}".split()) in printed, target


def test_the_integrals_of_the_script_are_the_tensor_of_the_table():
    L, M, a = symbols("L M a")
    inertia = run(LISTINGS["cylinder"]["text"], {})["SimplifiedInertia"]
    assert inertia == M / 12 * diag(L**2 + 3 * a**2, L**2 + 3 * a**2, 6 * a**2)


def test_the_rotated_tensor_of_the_script_is_that_of_the_derived_rotation():
    values = run(LISTINGS["prism"]["text"], {})
    rotation = Matrix(symrot.dcm("ZXZ", (pi / 4, 0, 0)))
    assert (rotation * values["IG0"] * rotation.T - values["IG"]).expand() == zeros(3, 3)


def test_the_function_of_the_script_obeys_the_rotation_rate_and_eulers_equations():
    """dR/dt = [omega]x R, and I alpha + omega x (I omega) = 0 with I = R I0 R^T, at a rotation with exact entries."""
    rotation = Matrix([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3
    omega = Matrix([Rational(1, 2), -3, Rational(5, 7)])
    moments = diag(5, 20, 17)
    values = run(LISTINGS["motion"]["text"], {"w": Matrix([*rotation, *omega]), "I0": moments})
    rates = values["dwdt"]
    inertia = rotation * moments * rotation.T
    assert Matrix(3, 3, list(rates[:9])) == Matrix.hstack(*(omega.cross(rotation.col(n)) for n in range(3)))
    assert inertia * Matrix(rates[9:]) + omega.cross(inertia * omega) == zeros(3, 1)


def test_the_start_of_the_script_is_a_slightly_disturbed_rotation_about_the_middle_axis():
    values = run(LISTINGS["start"]["text"], {})
    assert values["initial_w"] == Matrix([*eye(3), 0, Rational(1, 100), 1])
    largest, middle, smallest = (values["I0"][n, n] for n in (1, 2, 0))
    assert smallest < middle < largest


def test_a_formula_with_an_open_bracket_is_refused():
    with pytest.raises(AssertionError, match="expected"):
        run("a = (b + 1;\n", {})
