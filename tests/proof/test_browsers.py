"""Formulas as Chromium and Firefox lay them out, with the font that comes with the pages."""

import pytest

from symrot.proof.pages.html import display, document, prose
from symrot.proof.pages.math_font import face
from tests.viewer.browser import BROWSER, Browser
from tests.viewer.firefox import FIREFOX, Firefox

READY = "document.readyState == 'complete' && document.fonts.status == 'loaded'"
BOX = "(e => e.height / 16.8 / 1.05)(document.querySelector('{}').getBoundingClientRect())"  # in heights of a letter
CHILDREN = """Object.entries({msub: 2, msup: 2, msubsup: 3, munder: 2, mover: 2, munderover: 3, mfrac: 2, mroot: 2})
.flatMap(([name, count]) => [...document.querySelectorAll(name)].filter(e => e.children.length != count))
.map(element => element.outerHTML)"""  # elements with a wrong number of children
FORMULAS = {
    "matrix": r"\left[\begin{matrix}a\\b\\c\end{matrix}\right]",
    "bar": r"\left. \frac{\partial U}{\partial \theta} \right|_0",
    "flat": r"\left(p_\phi - p_\psi\right)^2",
    "tall": r"\left(\frac{a}{b}\right)",
    "root": r"\sqrt{\frac{a}{b}}",
    "sum": r"\sum_{k=1}^n k",
    "integral": r"\int_0^1 x\,dx",
    "accent": r"\dot{\theta}",
    "prime": "T'",
}


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    path = tmp_path_factory.mktemp("formulas") / "page.html"
    parts = [f'<div id="{name}">{display(latex)}</div>' for name, latex in FORMULAS.items()]
    # the second line of the paragraph must not be pushed down by its formulas
    text = prose("For $p_\\phi = p_\\psi$ and $\\theta = 0$ the axis is vertical. " * 8)
    path.write_text(document("formulas", [*parts, f'<p id="text">{text}</p>'], face()))
    return path


@pytest.mark.parametrize(
    "browser",
    [
        pytest.param(Browser, marks=pytest.mark.skipif(BROWSER is None, reason="needs Chromium")),
        pytest.param(Firefox, marks=pytest.mark.skipif(FIREFOX is None, reason="needs Firefox")),
    ],
)
def test_formulas_have_the_heights_of_a_printed_book(browser, page):
    """Brackets and bars are as tall as their contents, rows are as close as lines of text, and lines stay even."""
    with browser() as running:
        running.open(page, ready=READY)
        assert running.evaluate("document.fonts.check('16px \"symrot math\"')")

        def height(selector):
            return running.evaluate(BOX.format(selector))

        assert 3 < height("#matrix mtable") < 5.5  # three rows
        assert height("#matrix mo") > 0.8 * height("#matrix mtable")
        assert height("#bar mo") > 0.8 * height("#bar mfrac") > 1.5
        assert height("#tall mo") > 0.7 * height("#tall mfrac") > 1.2
        assert height("#root msqrt") > height("#root mfrac") > 1.5
        assert height("#flat mo") < 1.3  # not taller for an index
        assert 2 < height("#sum math") < 4.5
        assert 1.5 < height("#integral math") < 3.5
        assert height("#accent math") < 1.6
        assert height("#prime math") < 1.3
        lines = running.evaluate("document.getElementById('text').getClientRects()[0].height / 16.8 / 1.55")
        assert lines == pytest.approx(round(lines), abs=0.3) and lines < 7
        assert running.evaluate(CHILDREN) == []
        assert running.errors == []
