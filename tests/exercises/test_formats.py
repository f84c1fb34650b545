"""Sheets as Markdown, LaTeX, HTML, Moodle XML and JSON, and the page in a browser."""

import html
import json
import re
import shutil
import subprocess
from base64 import b64decode
from xml.etree.ElementTree import fromstring

import pytest

import symrot
from symrot.errors import InputError
from symrot.exercises.formats.figures import image, tikz, title_of
from symrot.exercises.sheet import read_sheet
from symrot.exercises.sketches import SKETCHES
from symrot.exercises.templates import TOPICS
from tests.exercises.moodle_import import faults

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


def test_moodle_imports_every_question():
    assert list(faults(SHEET.moodle())) == []


WRONG = {
    "not XML": ("</quiz>", ""),
    "expected the root quiz": ("quiz>", "quizz>"),
    "a question of a known type": ('type="numerical"', 'type="number"'),
    "a category without a name": ("<text>$course$/", "<text/><text>$course$/"),
    "slack of an answer is not read": ("tolerance>", "slack>"),
    "expected a number as tolerance": ("<tolerance>", "<tolerance>about "),
    "feedbacks is not read": ("generalfeedback", "feedbacks"),
    "a name with 0 characters": ("<name>", "<name><text/></name><name>"),
    "a name with 256 characters": ("<name>", f"<name><text>{256 * 'x'}</text></name><name>"),
    "unknown format 'tex'": ('format="html"', 'format="tex"'),
    "text with elements in it": ("&lt;p&gt;", "<p/>"),
    "questiontext without text": ('<questiontext format="html">', '<questiontext format="html"><text/>'),
    "is not encoded in base64": ('encoding="base64">', 'encoding="base64">*'),
    "addresses of files": ("@@PLUGINFILE@@/", "@@PLUGINFILE@@/no_"),
    "an answer with 99.0 %": ('fraction="100"', 'fraction="99"'),
    "no answer with all marks": ('fraction="100"', 'fraction="90"'),
    "an empty answer": ('format="moodle_auto_format">', 'format="moodle_auto_format"><text/>'),
    "penalty: expected a number from 0 to 1": ("<penalty>", "<penalty>-"),
    "units without a name": ("<unit_name>", "<unit_name/><unit_name>"),
    "one of them 1": ("<multiplier>1", "<multiplier>10"),
    "showunits does not suit": ("<showunits>0", "<showunits>3"),
}  # words of a fault -> a change of the file that makes it


@pytest.mark.parametrize("fault", WRONG)
def test_a_file_that_moodle_refuses_is_noticed(fault):
    text = symrot.exercise("rod_about_end").moodle()
    before, after = WRONG[fault]
    assert before in text and not list(faults(text))
    assert any(fault in words for words in faults(text.replace(before, after)))


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


def page_outcomes(sheet, question, answers, tmp_path):
    """Return how the script of the page, run in Node without a browser, marks answers to a question such as ``1b``."""
    text = sheet.html()
    data = re.search(r'id="questions">(.*?)</script>', text, re.S)[1]
    script = re.search(r"<script>\n(.*)</script>", text, re.S)[1]
    page = (
        "const document = {getElementById: () => ({textContent: "
        + json.dumps(data)
        + "}), querySelectorAll: () => []};\n"
    )
    call = (
        f"\nconsole.log(JSON.stringify({json.dumps(answers)}.map((text) => grade(text, questions['{question}'])[0])));"
    )
    path = tmp_path / "page.js"
    path.write_text(page + script.replace('"use strict";', "") + call, encoding="utf-8")
    done = subprocess.run([NODE, str(path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.skipif(NODE is None, reason="needs Node")
def test_the_page_grades_numbers_as_python_does(tmp_path):
    sheet = symrot.exercise("rod_about_end", seed=1)
    (question,) = (each for each in sheet[0].questions if each.kind == "number")
    value = float(question.decimal)
    answers = [form.format(value=value, double=2 * value, unit=question.unit) for form, _ in CASES]
    assert page_outcomes(sheet, "1b", answers, tmp_path) == [outcome for _, outcome in CASES]


@pytest.mark.skipif(NODE is None, reason="needs Node")
def test_on_the_page_a_hertz_next_to_an_angle_is_one_rotation_per_second(tmp_path):
    sheet = symrot.exercise("body_rates")
    question = next(each for each in sheet[0].questions if each.kind == "number")
    answers = [f"{float(question.decimal) / 6.283185307} Hz", f"{question.decimal} Hz"]
    assert page_outcomes(sheet, f"1{question.key}", answers, tmp_path) == ["right", "wrong"]


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


def test_a_third_of_the_templates_have_figures():
    templates = {name for names in TOPICS.values() for name in names}
    assert set(SKETCHES) <= templates and len(SKETCHES) > len(templates) / 2


@pytest.mark.parametrize("draw", dict.fromkeys(SKETCHES.values()), ids=lambda draw: draw.__name__)
def test_a_sketch_has_a_title_and_stays_inside_its_frame(draw):
    svg = draw()
    width, height = map(int, re.search(r'viewBox="0 0 (\d+) (\d+)"', svg).groups())
    assert title_of(svg) and 'stroke="currentColor"' in svg
    places = [pair for d in re.findall(r' d="([^"]*)"', svg) for pair in re.findall(r"[ML](\S+) (\S+)", d)]
    places += re.findall(r' x="(\S+)" y="(\S+)"', svg)
    assert all(0 <= float(x) <= width and 0 <= float(y) <= height for x, y in places)


def test_a_figure_is_in_every_format():
    sheet = symrot.exercise("spin_for_precession")
    figure = sheet[0].figure
    assert figure in sheet.html() and figure == read_sheet(json.loads(sheet.json()), "sheet")[0].figure
    address = re.search(r"!\[A top [^]]*\]\(data:image/svg\+xml;base64,([^)]*)\)", sheet.markdown())[1]
    assert b64decode(address) == image(figure) and b"currentColor" not in image(figure)
    quiz = fromstring(sheet.moodle().partition("\n")[2])
    assert {b64decode(file.text) for file in quiz.iter("file")} == {image(figure)}
    assert r"\begin{tikzpicture}" in sheet.latex() and r"{$\omega_3$}" in sheet.latex()


def test_a_drawing_that_latex_cannot_have_is_refused():
    with pytest.raises(InputError, match="got an element 'polygon'"):
        tikz('<svg xmlns="http://www.w3.org/2000/svg"><polygon/></svg>')
