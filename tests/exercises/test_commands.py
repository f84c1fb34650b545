"""The commands ``symrot exercise`` and ``symrot grade``."""

import json

import pytest

import symrot
from symrot.cli.main import main

USAGE = 2


def run(capsys, *arguments):
    code = main(list(arguments))
    output = capsys.readouterr()
    return code, output.out, output.err


def test_a_sheet_is_written_and_graded(capsys, tmp_path):
    sheet, answers = tmp_path / "sheet.json", tmp_path / "answers.txt"
    assert run(capsys, "exercise", "rod_about_end", "--seed", "0", "--format", "json", "-o", str(sheet))[0] == 0
    answers.write_text("# Ada\n1a: m L^2/6\n1b) 4 kg m^2\n", encoding="utf-8")
    code, text, _ = run(capsys, "grade", str(sheet), str(answers))
    assert (
        code == 1 and "(1a) wrong, 50%: a factor" in text and "(1b) right, 100%" in text and "1.5 of 2 points" in text
    )
    answers.write_text(json.dumps({"1a": "m L^2/3", "1b": "4 kg m^2"}), encoding="utf-8")
    assert run(capsys, "grade", str(sheet), str(answers))[0] == 0


def test_one_exercise_is_graded_by_its_name_and_seed(capsys):
    code, text, _ = run(capsys, "grade", "--name", "rod_about_end", "--seed", "0", "m L^2/3", "4 kg m^2", "--json")
    assert code == 0 and json.loads(text)["credit"] == 2


def test_topics_share_a_sheet_in_the_order_of_the_command_line(capsys):
    code, text, _ = run(capsys, "exercise", "gears", "rolling", "--count", "3", "--format", "json")
    sheet = json.loads(text)["exercises"]
    assert code == 0 and [each["topic"] for each in sheet] == ["gears"] * 2 + ["rolling"]
    assert len({each["template"] for each in sheet}) == 3


@pytest.mark.parametrize("form", ["markdown", "latex", "html"])
def test_a_sheet_without_solutions_has_the_exercises_alone(capsys, form):
    words = ("exercise", "rod_about_end", "--format", form)
    _, whole, _ = run(capsys, *words)
    _, text, _ = run(capsys, *words, "--no-solutions", "--title", "Week 3, rods")
    assert (
        "Hint" in whole and "Solution" in whole and not ("Hint" in text or "Solution<" in text or "Solutions" in text)
    )
    assert "A rod about its end" in text and (form != "latex" or text.endswith("\\end{document}\n"))
    assert "Week 3, rods" in text and "Exercises" not in text
    code, text, _ = run(capsys, *words, "--only-solutions")
    assert code == 0 and "Exercises: solutions" in text and "Find" not in text and "<form" not in text
    assert "Answers:" in text and "A rod about its end" in text


def test_the_list_names_every_topic(capsys):
    code, text, _ = run(capsys, "exercise", "--list")
    assert code == 0 and "gears\n  ring_fixed\n" in text


@pytest.mark.parametrize("arguments, words", [
    (("exercise", "gears", "--format", "moodle", "--no-solutions"), "expected one of markdown, latex, html for a sheet"),
    (("exercise", "gears", "--format", "json", "--title", "Week 3"), "for a sheet with a title"),
    (("exercise", "gears", "--only-solutions", "--no-solutions"), "not allowed with"),
    (("exercise", "cooking"), "expected a topic"), (("exercise", "gears", "rollin"), "did you mean 'rolling'"), (("exercise", "--count", "many"), "invalid whole number"),
    (("exercise", "--format", "pdf"), "invalid choice"), (("exercise", "gears", "--list"), "--list alone"),
    (("exercise", "--count", "0"), "count: expected"), (("grade", "x.json"), "expected EXERCISES.json"),
    (("grade", "--name", "rod_about_end", "1"), "expected --seed"), (("grade", "no.json", "no.txt"), "no.json: No such file"),
    (("grade", "--name", "rod_about_end", "--seed", "0", "1", "2", "3"), "expected at most 2"),
])  # fmt: skip
def test_bad_usage_is_one_sentence_and_exit_code_2(capsys, arguments, words):
    code, text, message = run(capsys, *arguments)
    assert code == USAGE and text == "" and words in message and message.count("\n") == 1


@pytest.mark.parametrize("content, words", [
    ("[1]", "expected the JSON"), ("{", "expected JSON"), ('{"schema": 9}', "schema 1"), ('{"schema": 1}', "expected the JSON"),
    ('{"schema": 1, "exercises": ["x"]}', "expected the JSON"),
    (symrot.exercise("rod_about_end").json().replace('"number"', '"essay"'), "has the kind"),
    (symrot.exercise("rod_about_end").json().replace('"decimal": "4"', '"decimal": "four"'), "could not convert"),
])  # fmt: skip
def test_a_file_that_is_no_sheet_is_refused(capsys, tmp_path, content, words):
    (tmp_path / "sheet.json").write_text(content, encoding="utf-8")
    (tmp_path / "answers.txt").write_text("1a: 1\n", encoding="utf-8")
    code, _, message = run(capsys, "grade", str(tmp_path / "sheet.json"), str(tmp_path / "answers.txt"))
    assert code == USAGE and words in message


def test_a_line_that_is_no_answer_is_named(capsys, tmp_path):
    sheet, answers = tmp_path / "sheet.json", tmp_path / "answers.txt"
    run(capsys, "exercise", "rod_about_end", "--format", "json", "-o", str(sheet))
    answers.write_text("1a: 1\nhello\n", encoding="utf-8")
    code, _, message = run(capsys, "grade", str(sheet), str(answers))
    assert code == USAGE and "line 2" in message


def test_bytes_that_are_no_text_are_refused_and_null_is_no_answer(capsys, tmp_path):
    sheet, answers = tmp_path / "sheet.json", tmp_path / "answers.txt"
    run(capsys, "exercise", "rod_about_end", "--format", "json", "-o", str(sheet))
    answers.write_bytes(b"1a: \xff\n")
    code, _, message = run(capsys, "grade", str(sheet), str(answers))
    assert code == USAGE and "expected UTF-8 text, got byte 0xff at position 4" in message
    answers.write_text('{"1a": null, "1b": "1 kg m^2"}', encoding="utf-8")
    assert "(1a) missing" in run(capsys, "grade", str(sheet), str(answers))[1]


@pytest.mark.parametrize(("name", "start"), [
    ("a.tex", "\\documentclass"), ("a.html", "<!"), ("a.xml", "<?xml"), ("a.json", "{"), ("a.md", "# Exercises"),
])  # fmt: skip
def test_the_end_of_a_file_name_decides_the_format(capsys, tmp_path, name, start):
    """Markdown in a file sheet.tex would be found by LaTeX only."""
    assert run(capsys, "exercise", "rod_about_end", "-o", str(tmp_path / name))[0] == 0
    assert (tmp_path / name).read_text(encoding="utf-8").startswith(start)


def test_a_terminal_shows_the_title_of_a_drawing_and_not_its_bytes(capsys, monkeypatch):
    assert "data:image/svg" in run(capsys, "exercise", "rod_about_end")[1]
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    text = run(capsys, "exercise", "rod_about_end")[1]
    assert "*Figure:* A rod that rotates" in text and "data:" not in text


@pytest.mark.parametrize(
    ("content", "words"), [("1a: 1\n1a: 2\n", "line 2: expected one answer to question 1a, got a second one"),
                           ('{"1a": "1", "1a": "2"}', "expected each name once, got '1a' more than once")],
)  # fmt: skip
def test_two_answers_to_one_question_are_refused(capsys, tmp_path, content, words):
    sheet, answers = tmp_path / "sheet.json", tmp_path / "answers.txt"
    run(capsys, "exercise", "rod_about_end", "--format", "json", "-o", str(sheet))
    answers.write_text(content, encoding="utf-8")
    code, _, message = run(capsys, "grade", str(sheet), str(answers))
    assert code == USAGE and words in message
