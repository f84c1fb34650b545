"""Sheets as Markdown, LaTeX, HTML, Moodle XML and JSON, and the page in a browser."""

import html
import json
import re
import shutil
import subprocess
from base64 import b64decode
from inspect import signature
from xml.etree.ElementTree import fromstring

import pytest

import symrot
from symrot.errors import InputError
from symrot.exercises.formats.figures import image, tikz, title_of
from symrot.exercises.sheet import read_sheet
from symrot.exercises.sketches.parts import drawing, letter, rod
from symrot.exercises.sketches.table import SKETCHES
from symrot.exercises.templates import TOPICS
from tests.exercises.moodle_import import faults

BROWSER = next((path for name in ("chromium", "google-chrome") if (path := shutil.which(name))), None)
NODE = shutil.which("node")


@pytest.fixture(scope="module")
def sheet():
    return symrot.exercise("", seed=1, count=4)


def test_markdown_has_exercises_hints_and_solutions_in_this_order(sheet):
    text = sheet.markdown()
    assert text.index("## 4. ") < text.index("# Hints") < text.index("# Solutions") < text.index("## Solution of 4")
    assert all(exercise.solution[-1].latex in text for exercise in sheet)


def test_every_environment_and_brace_of_the_latex_is_closed(sheet):
    text = sheet.latex()
    assert text.count(r"\begin{") == text.count(r"\end{")
    plain = text.replace(r"\{", "").replace(r"\}", "")
    assert plain.count("{") == plain.count("}") and text.count("$") % 2 == 0


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_the_latex_compiles(sheet, tmp_path):
    (tmp_path / "sheet.tex").write_text(sheet.latex(), encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "sheet.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:]


def test_moodle_imports_every_question(sheet):
    assert list(faults(sheet.moodle())) == []


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


def test_the_numbers_of_the_quiz_are_the_answers_with_their_units(sheet):
    numbers = [question for exercise in sheet for question in exercise.questions if question.kind == "number"]
    quiz = fromstring(sheet.moodle().partition("\n")[2])
    elements = [element for element in quiz if element.get("type") == "numerical"]
    assert sorted(element.findtext("answer/text") for element in elements) == sorted(each.decimal for each in numbers)
    assert all(
        float(e.findtext("answer/tolerance")) <= 0.00501 * abs(float(e.findtext("answer/text"))) for e in elements
    )


def test_the_page_fetches_nothing(sheet):
    text = sheet.html()
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


SAME = (
    "{v:.2g} {u}", "{v:.1g} {u}", "{v:.1e} {u}", "1 = 2 = {v} {u}", "{v} {u}.", "{v} [{u}]", "{v} ({u})", "14 pi {u}",
    "14π {u}", "{v:.4g} x 10^0 {u}", "44.4 {u}", "45.9 {u}", "{v}", "{v:.4g}·10⁰ {u}", "2 X = {v} {u}", "1/X = {v} {u}", "X/2 = {v} {u}",
    "5 > {v} {u}", "5 != {v} {u}", "60 rpm = {v} {u}", "X ≈ {v} {u}",
)  # fmt: skip


@pytest.mark.skipif(NODE is None, reason="needs Node")
@pytest.mark.parametrize("name", ["top_of_wheel", "angle_of_two_rotations"])  # 14 pi m/s, 82.8 deg
def test_the_page_and_python_agree_on_roundings_and_ways_to_write(name, tmp_path):
    """The page called a number of two right digits rounded too much; Python read neither 14 pi nor [m/s]."""
    sheet = symrot.exercise(name, seed=1)
    question = sheet[0].questions[1]
    answers = [form.format(v=float(question.decimal), u=question.unit) for form in SAME]
    marks = [symrot.grade(sheet[0], {"b": answer}).marks[1] for answer in answers]
    partial = {"coarse": "partial", "unit_forgotten": "partial"}
    outcomes = [partial.get(mark.code, "right" if mark.credit == 1 else "wrong") for mark in marks]
    assert page_outcomes(sheet, "1b", answers, tmp_path) == outcomes
    assert name != "top_of_wheel" or outcomes.count("right") == 12


@pytest.mark.skipif(NODE is None, reason="needs Node")
def test_the_page_reads_raised_minus_signs_and_thousands(tmp_path):
    sheet = symrot.exercise("free_acceleration")
    question = next(each for each in sheet[0].questions if each.kind == "number")
    assert question.unit == "rad/s^2"
    value = float(question.decimal)
    thousands = f"{1000 * value:,.0f}"
    assert "," in thousands
    answers = [
        f"{value} rad s⁻²",
        f"{value} rad·s⁻²",
        f"{value} rad/s²",
        f"{thousands} s⁻² mm/m",
        f"{2 * value} rad s⁻²",
    ]
    marks = [next(m for m in symrot.grade(sheet[0], {question.key: each}) if m.key == question.key) for each in answers]
    assert [mark.outcome for mark in marks] == ["right", "right", "right", "right", "wrong"]
    assert page_outcomes(sheet, f"1{question.key}", answers, tmp_path) == [mark.outcome for mark in marks]


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


def test_all_templates_but_two_have_figures():
    """Only the algebra of two general quaternions has no picture."""
    templates = {name for names in TOPICS.values() for name in names}
    assert templates - set(SKETCHES) == {"product", "norm_of_product"} and set(SKETCHES) <= templates


@pytest.mark.parametrize("draw", [draw for draw in dict.fromkeys(SKETCHES.values()) if not signature(draw).parameters],
                         ids=lambda draw: draw.__name__)  # fmt: skip
def test_a_sketch_has_a_title_and_can_be_printed(draw):
    svg = draw()
    assert title_of(svg) and tikz(svg).count(r"\path") == svg.count("<path")


def test_a_drawing_shows_the_choices_of_its_exercise():
    sketches = [symrot.exercise("body_rates", seed=seed)[0] for seed in range(6)]
    assert all(exercise.title.split()[8].strip(",") in title_of(exercise.figure) for exercise in sketches)
    assert len({exercise.figure for exercise in sketches}) == len({exercise.title for exercise in sketches}) > 2


def test_words_and_letters_of_a_drawing_are_typeset():
    svg = drawing("A title", letter(0, 0, "ω_3"), letter(0, 20, "m g"), letter(0, 40, "ϕ about x"), rod(0, 0, 9, 9))
    assert all(words in tikz(svg) for words in (r"{$\omega_{3}$}", r"{$m\,g$}", r"{$\phi$ about x}", "3.75pt"))
    assert "path.bar{stroke-width:5}" in svg


def test_a_figure_is_in_every_format():
    sheet = symrot.exercise("spin_for_precession")
    figure = sheet[0].figure
    assert figure in sheet.html() and figure == read_sheet(json.loads(sheet.json()), "sheet")[0].figure
    address = re.search(r"!\[A top [^]]*\]\(data:image/svg\+xml;base64,([^)]*)\)", sheet.markdown())[1]
    assert b64decode(address) == image(figure) and b"prefers-color-scheme" not in image(figure)
    quiz = fromstring(sheet.moodle().partition("\n")[2])
    assert {b64decode(file.text) for file in quiz.iter("file")} == {image(figure)}
    assert r"\begin{tikzpicture}" in sheet.latex() and r"{$\omega_{3}$}" in sheet.latex()


def test_a_drawing_that_latex_cannot_have_is_refused():
    with pytest.raises(InputError, match="got an element 'polygon'"):
        tikz('<svg xmlns="http://www.w3.org/2000/svg"><polygon/></svg>')
