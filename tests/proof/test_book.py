"""The book of pages: contents in reading order, links that lead somewhere, and a search that names its places."""

import json
import re
from base64 import b64decode

import pytest

from symrot.lessons.other_names import OTHER_NAMES
from symrot.lessons.table import LESSONS
from symrot.proof.page import Figure, Page, Passage, Section, Step
from symrot.proof.pages import book, html_document
from symrot.proof.pages.math_font import content
from tests.proof.book_search import NODE, pages_of


class Drawing:
    def svg(self, title, description):
        return f"<svg><title>{title}</title><desc>{description}</desc></svg>"


def step(claim):
    return Step(claim, 1, 1, "$1 = 1$")


@pytest.fixture(scope="module")
def texts():
    first = Page("spin", "Spin of a <body>", "A book", "About $\\omega$.", [Section("Rates"), step("The rate is one.")])
    figure = Figure("disk", "A disk", "A disk of radius $R$.", Drawing)
    second = Page("disk", "Disk", "A book", "A disk.", [figure, Passage("See [spin](spin.md)."), step("It stays.")])
    third = Page("end", "End", "A book", "The last page.", [step("It ends.")])
    return book("All", "Of it.", {"One": [first], "Two": [second, third]})


def entries(texts):
    return json.loads("[" + texts["search.js"].split("[\n", 1)[1].split("\n];", 1)[0] + "]")


def test_the_contents_are_in_reading_order(texts):
    links = re.findall(r'<li><a href="(\w+)\.html">', texts["index.html"])
    assert links == ["spin", "disk", "end"]
    assert (
        re.findall(r"<h2>(\w+)</h2>", texts["index.html"]) == ["One", "Two"] and '<ol start="2">' in texts["index.html"]
    )


def test_next_and_previous_lead_through_all_pages(texts):
    forward, page = ["spin"], "spin"
    while following := re.search(r'rel="next" href="(\w+)\.html"', texts[f"{page}.html"]):
        page = following[1]
        assert re.search(r'rel="prev" href="(\w+)\.html"', texts[f"{page}.html"])[1] == forward[-1]
        forward.append(page)
    assert forward == ["spin", "disk", "end"] and 'rel="prev"' not in texts["spin.html"]


def test_a_page_names_the_pages_that_refer_to_it(texts):
    assert 'refer to this one: <a href="disk.html">Disk</a>' in texts["spin.html"]
    assert "refer to this one" not in texts["disk.html"]


def test_every_place_of_the_search_exists_and_its_text_is_plain(texts):
    places = entries(texts)
    assert ["spin.html#step-1", "Spin of a <body>: Rates, step 1", "The rate is one. Why: 1=1."] in places
    assert ["disk.html", "Disk, figure", "A disk. A disk of radius R."] in places
    for target, title, text in places:
        name, _, anchor = target.partition("#")
        assert name in texts and (not anchor or f'id="{anchor}"' in texts[name])
        assert "$" not in title + text and "\\" not in title + text


def test_the_book_needs_no_network(texts):
    for name, text in texts.items():
        assert "http" not in text.replace("http://www.w3.org/1998/Math/MathML", ""), name
        for target in re.findall(r'(?:href|src|action)="([^"#]+)', text):
            assert target in texts, (name, target)


def test_a_figure_is_inside_its_page(texts):
    assert "<figure><svg><title>A disk</title>" in texts["disk.html"] and "<figcaption>A disk of" in texts["disk.html"]


def test_the_font_is_beside_the_book_and_inside_a_single_page(texts):
    assert all('url("math.woff2")' in text for name, text in texts.items() if name.endswith(".html"))
    alone = html_document(Page("spin", "Spin"))
    data = re.search(r'url\("data:font/woff2;base64,([^"]+)"\)', alone)[1]
    assert b64decode(data) == content() and content()[:4] == b"wOF2"


def pages_first_to_last(*queries):
    rates = Page("rates", "Rates of Euler angles", "", "At gimbal lock they diverge. Gimbal lock has a page.")
    lock = Page("singularities", "Where Euler angles lock", "", "Two of the axes coincide.")
    motion = Page("motion", "The motion of a body", "", "About the intermediate axis of the body it flips.")
    names = {"singularities": "gimbal lock, loss of a degree of freedom", "motion": "Poinsot's motion"}
    return pages_of(book("All", "Of it.", {"": [rates, lock, motion]}, names)["search.js"], *queries)


@pytest.mark.skipif(NODE is None, reason="needs Node.js")
def test_the_search_lists_the_page_about_the_subject_first():
    lock, rates, axes, other, *none = pages_first_to_last(
        "gimbal lock", "the rates of an Euler angle", "intermediate axes, bodies", "Poinsot", "penguin", ""
    )
    assert lock == ["singularities", "rates"] and rates[0] == "rates"
    assert axes == other == ["motion"] and none == [[], []]


def test_other_names_belong_to_pages():
    assert set(OTHER_NAMES) <= set(LESSONS)
