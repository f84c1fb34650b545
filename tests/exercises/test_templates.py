"""Templates: every exercise is proven, reproducible, complete, and its own answers are right."""

import hashlib
import json
import os
import subprocess
import sys
from random import Random

import pytest
from sympy import Integer, Rational, Symbol

import symrot
from symrot.checker.units.units import read_unit
from symrot.exercises.exercise import make
from symrot.exercises.problem import Asked, Line, Problem, quantity
from symrot.exercises.sheet import read_sheet
from symrot.exercises.templates import TOPICS, chosen, template
from symrot.exercises.units import unit_of

NAMES = [name for names in TOPICS.values() for name in names]


def test_there_are_many_templates_of_every_topic_and_no_name_comes_twice():
    assert len(NAMES) >= 60 and len(set(NAMES)) == len(NAMES) and min(map(len, TOPICS.values())) >= 4
    assert chosen("gears") == TOPICS["gears"]
    assert not set(NAMES) & set(TOPICS)


@pytest.mark.thinned(6)
@pytest.mark.parametrize("name", NAMES)
def test_an_exercise_is_complete_and_its_own_answers_are_right(name):
    exercise = symrot.exercise(name, seed=1)[0]
    assert exercise.questions and exercise.solution and len(exercise.hints) == 3 and exercise.statement.endswith(".")
    for question in exercise.questions:
        assert not question.unit or unit_of(question.unit) is not None
        if question.kind == "number":
            answer = f"{float(question.decimal):.5g} {question.unit}"
            assert symrot.grade(exercise, {question.key: answer}).credit == 1, (answer, question)


def test_the_torque_on_a_crank_does_not_mention_a_speed_that_is_not_given():
    exercise = symrot.exercise("crank_torque")[0]
    assert "Omega" not in exercise.statement and exercise.statement.startswith("A crank has the length $r$.")


@pytest.mark.parametrize("name", NAMES[::20])
def test_a_formula_has_the_unit_of_its_number(name):
    exercise = symrot.exercise(name, seed=2)[0]
    for question in exercise.questions:
        if question.kind == "formula":
            claim = f"quantity == {question.answer}"
            units = {**question.symbols, "quantity": question.unit or "1"}
            assert symrot.check(claim, units=units, repair=False).dimension.status == "consistent", question
            assert read_unit(question.unit or "1") is not None


def test_the_same_seed_gives_the_same_bytes_in_another_process():
    code = "import symrot; print(symrot.exercise('', seed=5, count=2).json(), end='')"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, env=os.environ | {"PYTHONHASHSEED": "77"}, check=True
    )
    here = symrot.exercise("", seed=5, count=2).json().encode()
    assert hashlib.sha256(done.stdout).digest() == hashlib.sha256(here).digest()
    assert symrot.exercise("rod_about_end", seed=1).json() != symrot.exercise("rod_about_end", seed=2).json()


def test_json_makes_the_same_sheet_again():
    sheet = symrot.exercise("gears", seed=1, count=2)
    assert read_sheet(json.loads(sheet.json()), "x") == sheet


X, Y = Symbol("x", positive=True), Symbol("y", positive=True)


def problem(line, asked):
    return Problem("Title", "Text.", "Law.", (quantity(X, "1 2", "m", "length"),), (line,), (asked,))


def test_a_line_that_does_not_hold_is_refused():
    wrong = problem(Line("Wrong.", X + X, 3 * X, "d"), Asked("d", "the sum", 3 * X, "m"))
    with pytest.raises(symrot.ProofError, match="does not hold"):
        make("wrong", "inertia", 0, wrong, Random("0"))


def test_an_answer_that_no_line_proves_is_refused():
    unproven = problem(Line("Right.", X + X, 2 * X, "d"), Asked("d", "the sum", 3 * X, "m"))
    with pytest.raises(symrot.ProofError, match="no line of the solution proves d"):
        make("unproven", "inertia", 0, unproven, Random("0"))


def test_a_seed_whose_first_draws_do_not_fit_draws_on():
    """Of 24 draws none had moments in the right order; the command ended with an error."""
    assert len(symrot.exercise("swing_about_largest", seed=17)) == 1


@pytest.mark.parametrize("seed", range(4))
def test_the_angle_between_two_attitudes_is_below_180_degrees(seed):
    """For q = -p the answer was -1, the cosine of half of 360 degrees."""
    assert 0 < float(symrot.exercise("angle_between", seed=seed)[0].questions[1].decimal) < 1


@pytest.mark.parametrize("name, seed", [("ring_fixed", 1), ("both_driven", 1), ("torque_of_carrier", 8)])
def test_the_planets_of_a_gear_have_a_whole_number_of_teeth(name, seed):
    """A sun of 15 and a ring of 60 teeth left 22.5 teeth for a planet."""
    teeth = {
        datum.symbol: int(datum.value) for datum in symrot.exercise(name, seed=seed)[0].data if datum.symbol[0] == "Z"
    }
    assert (teeth["Z_R"] - teeth["Z_S"]) % 2 == 0


def test_a_number_is_exact():
    right = problem(Line("Right.", X + X, 2 * X, "d"), Asked("d", "the sum", 2 * X, "m"))
    question = make("right", "inertia", 0, right, Random("0")).questions[1]
    assert Rational(question.answer) in (Integer(2), Integer(4))


@pytest.mark.parametrize("arguments, words", [
    ({"topic": "cooking"}, "expected a topic"), ({"seed": -1}, "seed: expected"), ({"count": 0}, "count: expected"),
    ({"seed": "1"}, "seed: expected"),
])  # fmt: skip
def test_other_arguments_are_refused(arguments, words):
    with pytest.raises(symrot.InputError, match=words):
        symrot.exercise(**arguments)


def test_every_template_says_what_it_is():
    assert all(template(name).__doc__.endswith(".") for name in NAMES)
