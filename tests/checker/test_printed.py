"""Verdicts on one chapter of the corpus of printed formulas, and the names of the outcomes."""

import pytest

from tests.campaigns.checker.printed import formulas, judged, main, outcome


@pytest.mark.parametrize("chapter", ["free_bodies", *(
    pytest.param(name, marks=pytest.mark.campaign)
    for name in ("axis_angle", "energy", "euler_equations", "inertia", "quaternions", "rates", "rotation", "tops",
                 "vectors", "work")
)])  # fmt: skip
def test_no_formula_of_a_chapter_gets_a_wrong_answer(chapter):
    outcomes = {entry["id"]: judged(entry)[0] for entry in formulas(chapter)}
    assert [name for name, found in outcomes.items() if found in ("accused", "believed")] == []
    assert sum(found == "right" for found in outcomes.values()) > len(outcomes) / 5


@pytest.mark.parametrize(("expected", "verdict", "name"), [
    ("true", "false", "accused"), ("recognised", "doubtful", "accused"), ("doubtful", "recognised", "believed"),
    ("false", "true", "believed"), ("false", "conditional", "believed"), ("recognised", "definition", "unknown"),
    ("recognised", "true", "right"), ("doubtful", "false", "right"), ("definition", "definition", "right"),
    ("definition", "true", "unknown"), ("doubtful", "definition", "unknown"), ("true", "refused", "refused"),
])  # fmt: skip
def test_outcomes(expected, verdict, name):
    assert outcome(expected, verdict) == name


def test_a_wrong_answer_fails_the_command(monkeypatch, capsys):
    entry = {"id": "wrong", "text": "sin(x)^2 + cos(x)^2 = 1", "expected": "false"}
    monkeypatch.setattr("tests.campaigns.checker.printed.formulas", lambda chapter: [entry])
    assert main([]) == 1
    assert "believed 1" in capsys.readouterr().out
