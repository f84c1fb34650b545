"""Pages in Firefox: a motion and a sheet of exercises work there as in Chromium, without an error in the console."""

import re

import pytest

import symrot
from tests.viewer.firefox import FIREFOX, Firefox

pytestmark = pytest.mark.skipif(FIREFOX is None, reason="needs Firefox")


@pytest.fixture(scope="module")
def browser():
    with Firefox() as running:
        yield running


def test_a_page_computes_its_motion_in_firefox(browser, tmp_path):
    """Headless Firefox has no WebGL; then the page says so, and computes and plots the motion."""
    browser.open(symrot.show("heavy_top_loops", tmp_path / "page.html"), dark=True)
    trust = browser.evaluate("document.getElementById('trust').textContent")
    assert float(re.search(r"Agrees with the motion that symrot computed to ([\d.e-]+)\.", trust)[1]) < 1e-12
    browser.size(390, 844)
    browser.wait("document.documentElement.scrollWidth <= innerWidth")
    assert browser.errors == []


def test_a_sheet_grades_a_number_in_firefox(browser, tmp_path):
    sheet = symrot.exercise("rod_about_end")
    path = tmp_path / "sheet.html"
    path.write_text(sheet.html(), encoding="utf-8")
    browser.open(path, ready="document.querySelector('form input')")
    question = next(each for each in sheet[0].questions if each.kind == "number")

    def answer(text):
        return browser.evaluate(
            f"(form => (form.querySelector('input').value = {text!r}, form.requestSubmit(), "
            "form.querySelector('output').className))(document.querySelector('form'))"
        )

    assert answer(f"{question.decimal} {question.unit}") == "right"
    assert answer(f"7{question.decimal} {question.unit}") != "right"
    assert browser.errors == []
