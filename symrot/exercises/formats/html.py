"""Sheets of exercises as one HTML file that grades numerical answers without a network connection."""

import json
import re
from collections.abc import Callable, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from symrot.checker.units.conversion import ALIASES, FACTORS
from symrot.exercises.exercise import Exercise, Question, related
from symrot.exercises.formats.markdown import data_text
from symrot.exercises.grading.words import SLIPS
from symrot.exercises.units import unit_of
from symrot.proof.pages.html import display, document, prose
from symrot.proof.pages.math_font import face

__all__ = ["drawing", "html_sheet", "mathjax", "solution_html"]

HINTS = ("Hint 1: the law", "Hint 2: the equation", "Hint 3: with numbers")


def html_sheet(exercises: Sequence[Exercise], title: str, statements: bool, solutions: bool) -> str:
    """Return one self-contained HTML page with exercises, which grades numerical answers.

    Without ``statements`` the page contains only the solutions; without ``solutions`` it contains no solutions, no
    hints and no answers to questions for formulas.
    """
    folder = files(__package__)
    heading = f"<h1>{prose(title)}</h1>"
    style = face() + (folder / "sheet.css").read_text(encoding="utf-8")
    if not statements:
        return document(title, [heading, *map(_solution, range(1, len(exercises) + 1), exercises)], style)
    compare = ", or compare them with the answer" if solutions else ""
    parts = [
        heading,
        '<p class="note">Numbers are checked on this page: write them with a unit and at least three digits, such as '
        f"<code>0.125 kg m^2</code>. Check formulas with <code>symrot grade</code>{compare}.</p>",
        *(_exercise(number, exercise, solutions) for number, exercise in enumerate(exercises, 1)),
        f'<script type="application/json" id="questions">{_json(_data(exercises))}</script>',
        f"<script>\n{(folder / 'sheet.js').read_text(encoding='utf-8')}</script>",
    ]
    return document(title, parts, style)


def _solution(number: int, exercise: Exercise) -> str:
    answers = (f"({each.key}) ${each.name} {related(each.latex)}$" for each in exercise.questions)
    return (
        f'<section id="solution-{number}">\n<h2>{number}. {prose(exercise.title)}</h2>\n'
        f"{solution_html(exercise, _displayed)}\n<p><b>Answers:</b> {prose('; '.join(answers))}.</p>\n</section>"
    )


def _exercise(number: int, exercise: Exercise, solutions: bool) -> str:
    hints = "\n".join(
        f'<details class="hint"><summary>{label}</summary><p>{_displayed(hint)}</p></details>'
        for label, hint in zip(HINTS, exercise.hints, strict=True)
    )
    questions = "\n".join(_question(number, question, solutions) for question in exercise.questions)
    help_after = (
        f'<div class="hints">\n{hints}\n</div>\n'
        f'<details class="solution"><summary>Solution</summary>\n{solution_html(exercise, _displayed)}\n</details>\n'
    )
    return (
        f'<section class="exercise" id="exercise-{number}">\n<h2>{number}. {prose(exercise.title)}</h2>\n'
        f"<p>{prose(exercise.statement)}</p>\n{drawing(exercise)}\n<p>{prose(data_text(exercise.data))}</p>\n"
        f"{questions}\n{help_after if solutions else ''}</section>"
    )


def _question(number: int, question: Question, solutions: bool) -> str:
    name = f"{number}{question.key}"
    prompt = f'<p class="prompt"><b>({question.key})</b> {prose(question.prompt)}</p>'
    if question.kind == "formula":
        formula = display(f"{question.name} = {question.latex}")
        answer = f'<details class="answer"><summary>Answer</summary>{formula}</details>' if solutions else ""
        return f'<div class="question formula">{prompt}{answer}</div>'
    return (
        f'<form class="question numeric" data-question="{name}">{prompt}<p class="entry">'
        f'<label for="answer-{name}">Answer</label> <input id="answer-{name}" autocomplete="off" spellcheck="false" '
        f'placeholder="number{" and unit" if question.unit else ""}"> <button>Check</button></p>'
        '<output aria-live="polite"></output></form>'
    )


def drawing(exercise: Exercise) -> str:
    """Return the HTML of an exercise's figure, or an empty text if the exercise has no figure."""
    return f'<figure class="sketch">{exercise.figure}</figure>' if exercise.figure else ""


def solution_html(exercise: Exercise, text: Callable[[str], str]) -> str:
    """Return the solution of an exercise as HTML; ``text`` converts Markdown with formulas to HTML."""
    return "\n".join(f"<p>{text(f'{line.reason} $${line.latex}$$')}</p>" for line in exercise.solution)


def mathjax(text: str) -> str:
    r"""Return Markdown as HTML for Moodle, whose MathJax displays the formulas between ``\(..\)`` or ``\[..\]``."""
    parts = re.split(r"(\$\$.+?\$\$|\$[^$]+\$)", text)
    return "".join(_delimited(escape(part, quote=False)) for part in parts)


def _delimited(part: str) -> str:
    if part.startswith("$$"):
        return rf"\[{part.strip('$')}\]"
    return rf"\({part.strip('$')}\)" if part.startswith("$") else part


def _displayed(text: str) -> str:
    """Return Markdown as HTML: formulas become MathML, and formulas in ``$$`` get lines of their own."""
    parts = re.split(r"\$\$(.+?)\$\$", text)
    return "".join(_inline_display(part) if place % 2 else prose(part) for place, part in enumerate(parts))


def _inline_display(latex: str) -> str:
    """Return MathML that displays a formula on a line of its own, with ``span`` instead of ``div``.

    A paragraph of HTML cannot contain a ``div``.
    """
    return display(latex).replace("<div ", "<span ").replace("</div>", "</span>")


def _data(exercises: Sequence[Exercise]) -> dict[str, Any]:
    """Return the data with which the page grades numbers: answer, unit, name, given quantities and typical wrong
    numbers of each question, and the factors and dimensions of all units.
    """
    questions = {
        f"{number}{question.key}": {
            "value": question.decimal,
            "unit": question.unit,
            "name": question.name,
            "given": [*question.symbols],
            **_unit_facts(question.unit),
            # each with a hint at the mistake
            "slips": [
                [value, SLIPS[code.split()[0]].format(code.split()[1])] for code, value in question.slips.items()
            ],
        }
        for number, exercise in enumerate(exercises, 1)
        for question in exercise.questions
        if question.kind == "number"
    }
    units = {name: _unit_facts(name) for name in (*FACTORS, *ALIASES)}
    return {"questions": questions, "units": units}


def _unit_facts(unit: str) -> dict[str, Any]:
    product = unit_of(unit) if unit else None
    if product is None:
        return {"factor": 1, "dimension": {}}
    factor = float(product.fraction) * 3.141592653589793**product.power_of_pi
    return {"factor": factor, "dimension": {name: int(power) for name, power in product.dimension.items()}}


def _json(data: Any) -> str:
    return json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
