"""The campaign over real functions: a slice of it, and tests that its judges reject wrong verdicts."""

import json
from dataclasses import asdict, replace
from fractions import Fraction
from random import Random

import pytest
from sympy import Rational, Symbol, sin

from symrot.checker.claim.reader import read_expression
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.exact.evidence import Counterexample
from tests.campaigns.checker import real_identities as module
from tests.campaigns.checker import run as campaign_run
from tests.campaigns.checker.identities import campaign, main
from tests.campaigns.checker.oracle_real import (
    Edge,
    Large,
    NoValue,
    Unclear,
    compare,
    drawn_point,
    generic_point,
    real_value,
)
from tests.campaigns.checker.real_identities import REAL_RULES, TRAPS, fault, judged_real, real_claims
from tests.campaigns.checker.run import Judged, judged_claims, read_log

HALF = {"x": Fraction(1, 2), "y": Fraction(3), "z": Fraction(-2)}


def value(text, point=HALF):
    return real_value(read_expression(text), point)


@pytest.fixture
def few_points(monkeypatch):
    """Look for points of a domain at few places, in tests of more than how the judge finds them."""
    monkeypatch.setattr(module, "MOST_POINTS", 200)
    monkeypatch.setattr(module, "FAR_POINTS", 200)


def test_a_slice_of_the_campaign_has_no_wrong_verdict(few_points):
    found = campaign(12, seed=5, real=True)
    assert found.wrong == found.late == []
    assert found.count == 12
    assert set(found.counts) >= {"true", "false", "refused"}
    assert found.slowest_claim


def test_claims_are_repeatable():
    assert list(real_claims(12, 4)) == list(real_claims(12, 4)) != list(real_claims(12, 5))


@pytest.mark.thinned(6)
@pytest.mark.parametrize(("left", "right"), REAL_RULES)
def test_every_rule_holds_wherever_both_sides_have_a_value(left, right):
    source, sides = (
        Random(1),
        [read_expression(side.replace("X", "(x + z)").replace("Y", "y")) for side in (left, right)],
    )
    defined = 0
    for _ in range(400):
        try:
            assert compare(*sides, drawn_point(source))
        except (NoValue, Unclear):
            continue
        defined += 1
    assert defined >= 10


@pytest.mark.thinned(4)
@pytest.mark.parametrize(("left", "right"), TRAPS)
def test_every_trap_fails_somewhere_or_has_no_values(left, right):
    source, sides = (
        Random(1),
        [read_expression(side.replace("X", "(x + z)").replace("Y", "y")) for side in (left, right)],
    )
    equal = different = 0
    for _ in range(300):
        try:
            same = compare(*sides, drawn_point(source))
        except (NoValue, Unclear):
            continue
        equal, different = equal + same, different + (not same)
    assert different > 0 or equal < 60


@pytest.mark.parametrize("formula", [
    "(-8)**(1/3)", "x**(1/3)*0 + log(-x)*0", "sqrt(x - y)", "log(x - x)", "asin(y)", "acos(z)", "1/(x - 1/2)", "z**(2/3)",
    "0*log(z)", "(x - 1/2)**(-1/3)", "atan2(x - x, 0)", "exp(log(z))", "sqrt(z)**2", "(x - x)**(-1)", "log(z)/log(z)",
])  # fmt: skip
def test_the_judge_finds_no_value_where_there_is_none(formula):
    with pytest.raises(NoValue):
        value(formula)


@pytest.mark.parametrize("formula", ["1/(sin(x)**2 + cos(x)**2 - 1)", "log(exp(x)*exp(-x) - 1)"])
def test_the_judge_says_that_it_is_on_an_edge(formula):
    with pytest.raises((Edge, NoValue)):
        value(formula)


@pytest.mark.parametrize("formula", ["exp(exp(exp(y)))", "gamma(x)", "x**y", "Matrix([x])"])
def test_the_judge_says_what_it_does_not_know(formula):
    with pytest.raises(Unclear):
        value(formula)


@pytest.mark.parametrize(("formula", "number"), [
    ("8**(1/3)", 2), ("asin(x)*6/pi", 1), ("acos(x)*3/pi", 1), ("log(exp(y))", 3), ("atan2(0, z)/pi", 1), ("abs(z)", 2),
    ("cosh(y)**2 - sinh(y)**2", 1), ("tan(pi/4)", 1), ("y**0", 1), ("(x - x)**(1/3)", 0), ("27**(-2/3)*9", 1), ("tanh(x - x)", 0),
])  # fmt: skip
def test_the_judge_knows_values(formula, number):
    assert abs(value(formula) - number) < 1e-50


def test_generic_points_are_no_whole_numbers_for_the_most_part():
    points = [generic_point(Random(n))["x"] for n in range(200)]
    assert sum(point.denominator > 1 for point in points) > 100


# -- wrong verdicts ---------------------------------------------------------------------------------------------------

AT_HALF = Counterexample(((Symbol("x", real=True), Rational(1, 2)),), None, "", "")

WRONG = (
    ("sqrt(x**2) == x", Verdict("true"), "true, but not at"),
    ("(-8)**(1/3) == 7", Verdict("true"), "true of nothing"),
    ("sqrt(x)*sqrt(-x-1) == 5", Verdict("true"), "true of nothing"),
    ("sqrt(tan(exp(exp(9)))) == sqrt(-1 - x**2)", Verdict("true"), "true of nothing"),
    ("x**(1/3) == x**(1/3)", Verdict("false"), "without a counterexample"),
    ("sqrt(x)**2 == x", Verdict("false", counterexample=AT_HALF), "the sides are equal"),
    ("sqrt(x - 1) == 7", Verdict("false", counterexample=AT_HALF), "has no value"),
    ("0*log(-x) == 3", Verdict("false", counterexample=AT_HALF), "has no value"),
    ("sqrt(x**2) == x", Verdict("conditional", requires=("x <= 1",)), ""),
    ("sqrt(x**2) == x", Verdict("conditional", requires=("-x >= 0",)), "under its condition"),
    ("sqrt(x**2) == x", Verdict("conditional", requires=("x >= 0", "y >= 0")), "under its condition"),
    ("sqrt(x**2)*log(-x) == x*log(-x)", Verdict("conditional", requires=("x >= 0",)), "under its condition"),
    ("log(x) == 3", "there are no real values of the letters for which both sides are real numbers: x > 0 never holds", "refused as if"),
    ("x**(1/3) == 3", "expected a number that is not negative under a root", "refused as if"),
)  # fmt: skip


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("claim", "verdict", "words"), [row for row in WRONG if row[2]], ids=str)
def test_the_judge_refuses_a_wrong_verdict(claim, verdict, words, few_points):
    assert words in fault(claim, verdict, Random(1))


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("claim", "verdict"), [
    ("sqrt(x**2) == abs(x)", Verdict("true")), ("log(log(x)**(1/5) - 2) == log(log(x)**(1/5) - 2)", Verdict("true")), ("sqrt(x**2) == x", Verdict("conditional", requires=("x >= 0",))),
    ("sqrt(x) == x", Verdict("false", counterexample=AT_HALF)), ("sqrt(x) == x", Verdict("undecided")),
    ("(-8)**(1/3) == 7", "expected a number that is not negative under a root"), ("x == 1/0", "expected fewer pieces"),
    ("asin(sin(-pi)) == atan2(log(exp(sin(pi))), sqrt(1 - sin(-pi)**2))", Verdict("true")),
    pytest.param("sqrt(tan(cosh(exp(x**4 - x + 5)))) == sqrt(tan(cosh(exp(x**4 - x + 5)))) + 0*log(x + y)", Verdict("true"),
                 marks=pytest.mark.campaign),
    ("sin(x) == 1", Verdict("false", counterexample=Counterexample(((sin(Symbol("x", real=True)), Rational(1, 2)),), None, "", ""))),
    ("sqrt((x*y)**(1/5) - 26)*sqrt(28 - (x*y)**(1/5)) == sqrt((x*y)**(1/5) - 26)*sqrt(28 - (x*y)**(1/5))", Verdict("true")),
])  # fmt: skip
def test_the_judge_accepts_a_right_verdict(claim, verdict):
    assert fault(claim, verdict, Random(1)) == ""


def test_the_judge_accepts_a_right_verdict_on_large_numbers(few_points):
    claim = "sinh(-8)*cosh(x + 0*log(asin(x))) == log(exp(sinh(-8)) + 0*log(1/2))*cosh(x)"
    assert fault(claim, Verdict("true"), Random(1)) == ""


@pytest.mark.thinned(3)
@pytest.mark.parametrize("answer", ["true", "traceback", "nowhere"])
def test_a_wrong_engine_is_caught(monkeypatch, answer, few_points):
    def wrong(claim, repair):
        if answer == "traceback":
            raise RecursionError
        if answer == "nowhere":
            raise InputError("there are no real values of the letters for which both sides are real numbers")
        return Verdict("true")

    monkeypatch.setattr(module, "check", wrong)
    found = campaign(4, seed=2, real=True)
    assert len(found.wrong) >= 2
    assert main(["--real", "--count", "3", "--seed", "2"]) == 1


def test_a_late_answer_fails_the_command(monkeypatch, few_points):
    command = ["--real", "--count", "2", "--seed", "2"]
    assert main(command) == 0
    monkeypatch.setattr("tests.campaigns.checker.run.LONGEST_SECONDS", 0.0)
    assert main(command) == 1


def test_an_answer_that_never_comes_is_given_up(monkeypatch):
    def endless(claim, repair):
        while True:
            try:
                for number in range(10**6):
                    number**2
            except Exception:  # what a formula's code may do to any error
                continue

    monkeypatch.setattr(module, "check", endless)
    monkeypatch.setattr(campaign_run, "GIVEN_UP_SECONDS", 0.2)
    found = campaign(2, seed=1, real=True)
    assert found.counts == {"no answer": 2}
    assert all("no answer in" in sentence for sentence in found.wrong)


def test_values_beyond_the_largest_are_values(few_points):
    """The judge cannot compare exp(exp(100)), but knows that it has a value."""
    with pytest.raises(Large):
        value("sin(exp(exp(100)))")
    claim = "sin(exp(sinh(exp(x**4 - x + 5)))) == sin(2*exp(sinh(exp(x**4 - x + 5))) - exp(sinh(exp(x**4 - x + 5))))"
    assert fault(claim, Verdict("true"), Random(1)) == ""
    assert fault(f"0*log(-cosh(x)) + {claim}", Verdict("true"), Random(1)).startswith("true of nothing")


@pytest.mark.parametrize("formula", [
    "log(exp(exp(100)))", "sqrt(exp(exp(100)))*log(3 + exp(exp(100)))", "tan(cosh(exp(100)))", "1/exp(-exp(99))", "(-2)**333*exp(99)",
    "sinh(-exp(99))**2 + 1", "exp(exp(100))**(1/3)", "tanh(-exp(99))",
])  # fmt: skip
def test_a_formula_of_large_numbers_has_a_value(formula):
    with pytest.raises(Large):
        value(formula)


@pytest.mark.parametrize(
    "formula", ["log(-exp(exp(100)))", "sqrt(-cosh(exp(100)))", "log(sinh(-exp(99)))", "(-exp(exp(9)))**(1/3)"]
)
def test_a_formula_of_large_numbers_has_none(formula):
    with pytest.raises(NoValue):
        value(formula)


def test_a_number_that_only_seems_zero_has_no_root():
    """cosh(exp(-exp(x))) exceeds 1 by less than 60 digits show."""
    claim = "acos(cosh(asin(exp(-exp(x))))) == 3"
    assert fault(claim, "the sides are not real numbers: -1 >= 0 does not hold", Random(1)) == ""


# -- runs -------------------------------------------------------------------------------------------------------------


def test_an_interrupted_run_goes_on_and_asks_again_for_what_was_wrong(monkeypatch, tmp_path, few_points):
    log = tmp_path / "claims.jsonl"
    asked = []
    ask = module.check
    monkeypatch.setattr(module, "check", lambda claim, repair: asked.append(claim) or ask(claim, repair=repair))
    whole = campaign(8, seed=2, real=True)
    claims = list(real_claims(8, 2))
    asked.clear()
    first = campaign(5, seed=2, real=True, log=log)
    assert (first.count, asked) == (5, claims[:5])
    rows = read_log(log)
    log.write_text(log.read_text() + '{"number": 6, "cla')  # cut off in the middle of a line
    second = campaign(8, seed=2, real=True, log=log)
    assert (second.counts, asked) == (whole.counts, claims)
    monkeypatch.setattr(module, "check", lambda claim, repair: Verdict("false"))
    wrong = judged_real(2, 3, claims[2])
    assert wrong.wrong
    with log.open("a") as file:
        file.write(f"{json.dumps(asdict(wrong))}\n{json.dumps(asdict(replace(rows[4], seconds=61.0)))}\n")
    monkeypatch.setattr(module, "check", lambda claim, repair: asked.append(claim) or ask(claim, repair=repair))
    assert campaign(8, seed=2, real=True, log=log).counts == whole.counts
    assert asked == [*claims, claims[2], claims[3]]
    with pytest.raises(InputError, match="expected the log of the claims of seed 3"):
        campaign(8, seed=3, real=True, log=log)
    log.write_text("[1]\n")
    assert main(["--real", "--log", str(log)]) == 2


def test_two_processes_find_what_one_finds(capsys):
    one, two = (campaign(4, seed=6, real=True, workers=workers) for workers in (1, 2))
    assert (one.counts, one.wrong) == (two.counts, two.wrong)


def test_wrong_answers_are_shown_as_they_come(capsys, tmp_path):
    rows = judged_claims(_wrong_at_three, enumerate("abcd", 1), 1, tmp_path / "log")
    tally = campaign_run.Tally()
    for row in rows:
        tally.add(row)
        tally.show(4, row)
        assert len(read_log(tmp_path / "log")) == row.number
    assert capsys.readouterr().err == "\r3: not so: c\n"
    assert (tally.wrong, tally.counts) == (["not so: c"], {"true": 4})


def _wrong_at_three(number, claim):
    return Judged(number, claim, "true", 0.0, "not so" if number == 3 else "")
