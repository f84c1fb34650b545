"""Grading of all answers to an exercise or a sheet: the function ``grade`` and the command ``symrot grade``."""

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from symrot.errors import InputError
from symrot.exercises.exercise import Exercise, Question
from symrot.exercises.grading.formulas import mark_formula
from symrot.exercises.grading.mark import Grades, Mark
from symrot.exercises.grading.numbers import mark_number
from symrot.exercises.sheet import ExerciseSheet, read_sheet
from symrot.files.reading import repeated_name, utf8_text

__all__ = ["grade", "grade_files"]

LONGEST = 2000

KINDS: dict[str, Callable[[str, str, Question], Mark]] = {"number": mark_number, "formula": mark_formula}


def grade(exercises: Exercise | ExerciseSheet, answers: Mapping[str, str] | Sequence[str]) -> Grades:
    """Return the marks for answers to one exercise or to a sheet of exercises.

    Parameters
    ----------
    exercises : Exercise or ExerciseSheet
        The exercise, or the sheet of exercises, that was answered.
    answers : mapping of str to str, or sequence of str
        Answers by question, ``"a"`` of an exercise or ``"1a"`` of a sheet; or answers in the order of the questions.
        Numbers have a unit and at least two significant digits; formulas are typed text or LaTeX.

    Returns
    -------
    Grades
        One mark for each question, with its credit, the kind of error, and a sentence for the student.

    Raises
    ------
    InputError
        If there is an answer to a question that does not exist, if a sequence has more answers than there are
        questions, or if ``answers`` is one string.

    Examples
    --------
    >>> import symrot
    >>> exercise = symrot.exercise("rod_about_end")[0]
    >>> [mark.outcome for mark in symrot.grade(exercise, {"a": "m*(L/2)^2 + m*L^2/12"})]
    ['right', 'missing']
    """
    questions = dict(_keyed(exercises))
    if isinstance(answers, str):
        raise InputError(
            f"answers: expected a list of strings, or a dict from question to string, got the string {answers[:60]!r}"
        )
    if not isinstance(answers, Mapping):
        if len(answers) > len(questions):
            raise InputError(
                f"answers: expected at most {len(questions)} answers, one for each question, got {len(answers)}"
            )
        answers = dict(zip(questions, answers, strict=False))
    unknown = [key for key in answers if key not in questions]
    if unknown:
        raise InputError(f"answers: expected names among the questions {', '.join(questions)}, got {unknown[0]!r}")
    return Grades(tuple(_mark(key, answers.get(key), question) for key, question in questions.items()))


def _keyed(exercises: Exercise | ExerciseSheet) -> Iterator[tuple[str, Question]]:
    if isinstance(exercises, Exercise):
        yield from ((question.key, question) for question in exercises.questions)
        return
    for number, exercise in enumerate(exercises, 1):
        yield from ((f"{number}{question.key}", question) for question in exercise.questions)


def _mark(key: str, answer: Any, question: Question) -> Mark:
    if answer is None or not str(answer).strip():
        return Mark(key, "", "missing", text="no answer was written")
    text = str(answer)
    if len(text) > LONGEST:
        return Mark(key, text[:60], "unread", text=f"expected at most {LONGEST} characters, got {len(text)}")
    return KINDS[question.kind](key, text, question)


def grade_files(exercises: str | Path, answers: str | Path) -> Grades:
    """Grade a file of answers to the exercises in a JSON file, and return the marks.

    Parameters
    ----------
    exercises : str or Path
        A file that ``symrot exercise --format json`` wrote.
    answers : str or Path
        A JSON object ``{"1a": "m*L^2/3"}``, or a text with a line ``1a: m*L^2/3`` for each answer.

    Raises
    ------
    InputError
        If a file has another form or is no text in UTF-8, or if it answers a question that the sheet does not have.
    OSError
        If a file cannot be read.
    """
    sheet = read_sheet(_json(exercises, _text(exercises)), str(exercises))
    return grade(sheet, _answers(answers, _text(answers)))


def _text(path: str | Path) -> str:
    return utf8_text(Path(path).read_bytes(), path)


def _answers(path: str | Path, text: str) -> dict[str, str]:
    if text.lstrip().startswith("{"):
        data = _json(path, text)
        return {str(key): "" if value is None else str(value) for key, value in data.items()}
    answers = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        match = re.match(r"\s*\(?(\d+[a-z])\)?\s*[:)]\s*(.*)$", line)
        if match is None:
            raise InputError(
                f"{path}, line {number}: expected a question, a colon and an answer, such as '1a: m*L^2/3', "
                f"got {line.strip()[:60]!r}"
            )
        if match[1] in answers:
            raise InputError(f"{path}, line {number}: expected one answer to question {match[1]}, got a second one")
        answers[match[1]] = match[2]
    return answers


def _json(path: str | Path, text: str) -> Any:
    def without_repetition(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        twice = repeated_name(pairs)
        if twice is not None:
            raise InputError(f"{path}: expected each name once, got {twice[:60]!r} more than once")
        return dict(pairs)

    try:
        return json.loads(text, object_pairs_hook=without_repetition)
    except json.JSONDecodeError as fault:
        raise InputError(f"{path}: expected JSON, but {fault}") from None
