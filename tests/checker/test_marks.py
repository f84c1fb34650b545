"""What a repair changes is marked: in text, in LaTeX that stays LaTeX, in HTML, and as spans and entries in JSON."""

import pytest

import symrot
from symrot.checker.marks import carets, changed_spans, html_with_marks, latex_with_marks
from symrot.report.verdicts import lines


@pytest.mark.parametrize(("claim", "repair", "marked"), [
    ("sin(2*x) == sin(x)*cos(x)", "sin(2*x) == 2*sin(x)*cos(x)", ["2*"]), ("a == b - c", "a == b + c", ["+"]),
    ("a == b + c + d", "a == b + d", ["d"]), ("a == b*c", "a == b", ["b"]), ("I_1 == m", "I_2 == m", ["I_2"]),
    ("x == y", "x == y", []), ("a + b == c - d", "a - b == c + d", ["-", "+"]),
])  # fmt: skip
def test_the_pieces_that_differ_are_marked(claim, repair, marked):
    pieces = [repair[start:end] for start, end in changed_spans(claim, repair)]
    assert all(piece in repair for piece in pieces)
    assert pieces == marked or (len(repair) < len(claim) and len(pieces) == 1)


def test_carets_stand_under_the_marked_pieces():
    assert carets(((2, 4), (7, 8)), 0, 10) == "  ^^   ^"
    assert carets(((2, 4),), 4, 10) == ""


def test_html_is_escaped_outside_and_inside_of_marks():
    assert html_with_marks("a < b & c", ((2, 3),)) == "a <mark>&lt;</mark> b &amp; c"


@pytest.mark.parametrize(("text", "piece", "marked"), [
    ("a = 2 b", "2", r"a = \underline{2} b"), (r"\frac{1}{2} m", "2", r"\frac{1}{\underline{2}} m"),
    (r"\frac{a}{b}", r"\frac{", r"\frac{a}{b}"), ("x^2", "2", "x^2"), ("x_2", "x", "x_2"), ("a & b", "&", "a & b"),
    (r"\sin^2 x", r"\sin", r"\sin^2 x"),
])  # fmt: skip
def test_latex_stays_latex(text, piece, marked):
    start = text.index(piece)
    assert latex_with_marks(text, ((start, start + len(piece)),)) == marked


def test_a_verdict_shows_the_change_and_its_entry():
    verdict = symrot.check("Rz(a) == Matrix([[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, -1]])")
    nearest = verdict.repairs[0]
    assert nearest.entry == (3, 3)
    assert [nearest.text[start:end] for start, end in nearest.changed] == ["1"]
    (data, *_) = verdict.to_json()["repairs"]
    assert data["entry"] == [3, 3] and data["changed"] == [list(span) for span in nearest.changed]


@pytest.mark.parametrize("claim", ["x/x == 2", "2*x/x == 1"])
def test_no_repair_cancels_to_a_bare_number(claim):
    assert symrot.check(claim).repairs == ()


def test_the_printed_repair_has_carets_under_the_change():
    shown = lines([symrot.check("sin(2*x) == sin(x)*cos(x)")], "sin(2*x) == sin(x)*cos(x)")
    place = next(n for n, line in enumerate(shown) if "true instead" in line)
    assert shown[place + 1].strip() == "^^"
    assert shown[place + 1].index("^") == shown[place].index("2*sin(x)")
