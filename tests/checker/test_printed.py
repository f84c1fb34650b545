"""Verdicts on one chapter of the corpus of printed formulas, and the names of the outcomes."""

from itertools import chain

import pytest

from tests.campaigns.checker.printed import CORPUS, formulas, judged, main, outcome

CHAPTERS = sorted(path.stem for path in CORPUS.glob("*.toml"))


def outcomes(entries):
    return {entry["id"]: judged(entry)[0] for entry in entries}


def has_no_wrong_answer(outcomes):
    wrong = [name for name, outcome in outcomes.items() if outcome in ("accused", "believed")]
    return wrong == [] and sum(outcome == "right" for outcome in outcomes.values()) > len(outcomes) / 2


def test_no_formula_of_a_sample_gets_a_wrong_answer():
    """The sample holds formulas of every chapter."""
    sample = {chapter: formulas(chapter)[::80] for chapter in CHAPTERS}
    assert all(sample.values())
    assert has_no_wrong_answer(outcomes(chain(*sample.values())))


@pytest.mark.campaign
@pytest.mark.parametrize("chapter", CHAPTERS)
def test_no_formula_of_a_chapter_gets_a_wrong_answer(chapter):
    assert has_no_wrong_answer(outcomes(formulas(chapter)))


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
