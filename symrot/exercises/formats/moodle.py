"""Exercises as Moodle XML: numerical questions with a tolerance and units, and short answers for formulas.

Source: https://docs.moodle.org/en/Moodle_XML_format. Each question of an exercise becomes one question of Moodle.
"""

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from symrot.exercises.exercise import Exercise, Question
from symrot.exercises.formats.figures import image, title_of
from symrot.exercises.formats.html import mathjax, solution_html
from symrot.exercises.formats.markdown import data_text
from symrot.exercises.grading.numbers import TOLERANCE

__all__ = ["moodle_quiz"]

UNIT_PENALTY = "0.1"
SPELLING = "Write products with *, powers with ^, at most one fraction, and the letters in alphabetical order."
UNMATCHED = (
    "Moodle compares formulas letter by letter, so an equal formula that is written in another way is not recognised. "
    "Compare yours with the solution; the command symrot grade decides whether both are equal."
)


def moodle_quiz(exercises: Sequence[Exercise]) -> str:
    """Return exercises as the text of an XML file that Moodle imports into its question bank."""
    quiz = Element("quiz")
    for topic in dict.fromkeys(exercise.topic for exercise in exercises):
        category = SubElement(quiz, "question", type="category")
        _text(SubElement(category, "category"), f"$course$/symrot/{topic.replace('_', ' ')}")
        for exercise in (each for each in exercises if each.topic == topic):
            quiz.extend(_questions(exercise))
    indent(quiz)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(quiz, encoding="unicode") + "\n"


def _questions(exercise: Exercise) -> Iterator[Element]:
    for question in exercise.questions:
        kind = "numerical" if question.kind == "number" else "shortanswer"
        element = Element("question", type=kind)
        _text(SubElement(element, "name"), f"{exercise.title} ({exercise.template} {exercise.seed}{question.key})")
        texts = map(_paragraph, (data_text(exercise.data), _prompt(question)))
        body = "".join((_paragraph(exercise.statement), _image(exercise), *texts))
        content = SubElement(element, "questiontext", format="html")
        _text(content, body)
        if exercise.figure:
            file = SubElement(content, "file", name=_file_name(exercise), path="/", encoding="base64")
            file.text = b64encode(image(exercise.figure)).decode()
        _text(SubElement(element, "generalfeedback", format="html"), solution_html(exercise, mathjax))
        SubElement(element, "defaultgrade").text = "1"
        SubElement(element, "penalty").text = "0.1"
        SubElement(element, "hidden").text = "0"
        (_number if question.kind == "number" else _formula)(element, question)
        for hint in exercise.hints:
            _text(SubElement(element, "hint", format="html"), mathjax(hint))
        yield element


def _image(exercise: Exercise) -> str:
    """Return the HTML of an exercise's figure, empty if there is none; Moodle stores the figure as a file."""
    if not exercise.figure:
        return ""
    title = escape(title_of(exercise.figure))
    return f'<p><img src="@@PLUGINFILE@@/{_file_name(exercise)}" alt="{title}"></p>'


def _file_name(exercise: Exercise) -> str:
    return f"{exercise.template}.svg"


def _prompt(question: Question) -> str:
    if question.kind == "number":
        return question.prompt
    return f"{question.prompt} {SPELLING}"


def _number(element: Element, question: Question) -> None:
    _answer(element, question.decimal, f"{abs(float(question.decimal)) * TOLERANCE:.3g}")
    if question.unit:
        units = SubElement(element, "units")
        unit = SubElement(units, "unit")
        SubElement(unit, "multiplier").text = "1"
        SubElement(unit, "unit_name").text = question.unit
    SubElement(element, "unitgradingtype").text = "0"
    SubElement(element, "unitpenalty").text = UNIT_PENALTY
    SubElement(element, "showunits").text = "0" if question.unit else "3"
    SubElement(element, "unitsleft").text = "0"


def _formula(element: Element, question: Question) -> None:
    SubElement(element, "usecase").text = "1"
    for text in _spellings(question.answer):
        _answer(element, text, "")
    _answer(element, "*", "", "0", UNMATCHED)


def _spellings(formula: str) -> tuple[str, ...]:
    """Return the spellings of a formula that Moodle accepts as answers: with ``^`` for powers, with and without spaces.

    ``*`` is escaped, because Moodle reads it as any text.
    """
    powers = formula.replace("**", "^")
    return tuple(text.replace("*", r"\*") for text in dict.fromkeys((powers, powers.replace(" ", ""))))


def _answer(element: Element, value: str, tolerance: str, fraction: str = "100", feedback: str = "") -> None:
    answer = SubElement(element, "answer", fraction=fraction, format="moodle_auto_format")
    SubElement(answer, "text").text = value
    _text(SubElement(answer, "feedback", format="html"), feedback)
    if tolerance:
        SubElement(answer, "tolerance").text = tolerance


def _paragraph(text: str) -> str:
    return f"<p>{mathjax(text)}</p>" if text else ""


def _text(parent: Element, text: str) -> None:
    SubElement(parent, "text").text = text
