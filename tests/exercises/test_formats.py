"""Sheets as Markdown, LaTeX, HTML, Moodle XML and JSON, and the page in a browser."""

import html
import json
import re
import shutil
import subprocess
from xml.etree.ElementTree import fromstring

import pytest

import symrot

SHEET = symrot.exercise("", seed=1, count=6)
BROWSER = next((path for name in ("chromium", "google-chrome") if (path := shutil.which(name))), None)
NODE = shutil.which("node")


def test_markdown_has_exercises_hints_and_solutions_in_this_order():
    text = SHEET.markdown()
    assert text.index("## 6. ") < text.index("# Hints") < text.index("# Solutions") < text.index("## Solution of 6")
    assert all(exercise.solution[-1].latex in text for exercise in SHEET)


def test_every_environment_and_brace_of_the_latex_is_closed():
    text = SHEET.latex()
    assert text.count(r"\begin{") == text.count(r"\end{")
    plain = text.replace(r"\{", "").replace(r"\}", "")
    assert plain.count("{") == plain.count("}") and text.count("$") % 2 == 0


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_the_latex_compiles(tmp_path):
    (tmp_path / "sheet.tex").write_text(SHEET.latex(), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "sheet.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:]


NEEDED = {
    "numerical": (
        "name/text",
        "questiontext/text",
        "generalfeedback/text",
        "answer/text",
        "answer/tolerance",
        "showunits",
    ),
    "shortanswer": ("name/text", "questiontext/text", "generalfeedback/text", "answer/text", "usecase"),
    "category": ("category/text",),
}
"""Type of a question of Moodle -> the elements that its import reads."""


def faults_of_quiz(text):
    """Return what Moodle's importer would miss in a quiz."""
    quiz = fromstring(text.partition("\n")[2])
    assert quiz.tag == "quiz"
    for question in quiz:
        kind = question.get("type")
        if question.tag != "question" or kind not in NEEDED:
            yield f"{question.tag} {kind}"
            continue
        yield from (f"{kind}: {path}" for path in NEEDED[kind] if question.find(path) is None)
        fractions = [float(answer.get("fraction")) for answer in question.findall("answer")]
        if kind != "category" and max(fractions, default=0) != 100:
            yield f"{kind}: no right answer"


def test_the_quiz_has_all_that_moodle_reads():
    assert list(faults_of_quiz(SHEET.moodle())) == []
    assert list(faults_of_quiz(SHEET.moodle().replace("tolerance>", "slack>")))


def test_the_numbers_of_the_quiz_are_the_answers_with_their_units():
    numbers = [question for exercise in SHEET for question in exercise.questions if question.kind == "number"]
    quiz = fromstring(SHEET.moodle().partition("\n")[2])
    elements = [element for element in quiz if element.get("type") == "numerical"]
    assert sorted(element.findtext("answer/text") for element in elements) == sorted(each.decimal for each in numbers)
    assert all(
        float(e.findtext("answer/tolerance")) <= 0.00501 * abs(float(e.findtext("answer/text"))) for e in elements
    )


def test_the_page_fetches_nothing():
    text = SHEET.html()
    assert not re.search(r"""(src|href)=["']?(https?:)?//""", text) and "@import" not in text and "fetch(" not in text


CASES = (
    ("{value} {unit}", "right"), ("-{value} {unit}", "wrong"), ("{double} {unit}", "wrong"), ("{value}", "partial"),
    ("{value} parsec", "wrong"), ("about", "wrong"), ("x = {value} {unit}", "right"),
)  # fmt: skip


@pytest.mark.skipif(NODE is None, reason="needs Node")
def test_the_page_grades_numbers_as_python_does(tmp_path):
    """The script of the page, run in Node without a browser, on answers of known worth."""
    sheet = symrot.exercise("rod_about_end", seed=1)
    (question,) = (each for each in sheet[0].questions if each.kind == "number")
    value = float(question.decimal)
    answers = [form.format(value=value, double=2 * value, unit=question.unit) for form, _ in CASES]
    text = sheet.html()
    data = re.search(r'id="questions">(.*?)</script>', text, re.S)[1]
    script = re.search(r"<script>\n(.*)</script>", text, re.S)[1]
    page = (
        "const document = {getElementById: () => ({textContent: "
        + json.dumps(data)
        + "}), querySelectorAll: () => []};\n"
    )
    call = f'\nconsole.log(JSON.stringify({json.dumps(answers)}.map((text) => grade(text, questions["1b"])[0])));'
    path = tmp_path / "page.js"
    path.write_text(page + script.replace('"use strict";', "") + call, encoding="utf-8")
    done = subprocess.run([NODE, str(path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == [outcome for _, outcome in CASES]


@pytest.mark.skipif(BROWSER is None, reason="needs Chromium")
def test_the_page_answers_in_a_browser(tmp_path):
    sheet = symrot.exercise("rod_about_end", seed=1)
    value = next(each for each in sheet[0].questions if each.kind == "number").decimal
    drive = f"<script>const form = document.querySelector('form'); form.querySelector('input').value = '{value} kg m^2'; form.requestSubmit();</script>"  # fmt: skip
    path = tmp_path / "sheet.html"
    path.write_text(sheet.html().replace("</body>", f"{drive}</body>"), encoding="utf-8")
    command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}",
               "--dump-dom", path.as_uri()]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert ">Right.</output>" in html.unescape(done.stdout)


@pytest.mark.parametrize("name", ["period_of_rod", "piston_speed"])
def test_a_sketch_has_a_title_and_the_colour_of_the_text(name):
    figure = symrot.exercise(name)[0].figure
    assert fromstring(figure).find("{http://www.w3.org/2000/svg}title").text and 'stroke="currentColor"' in figure
    assert figure in symrot.exercise(name).html()
