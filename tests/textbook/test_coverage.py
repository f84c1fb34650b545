"""The list of formulas that no claim covers: what is a formula, and what covers it."""

import pytest

from tests.textbook.coverage import is_covered, pieces, plain


def test_a_line_with_a_relation_is_a_piece_and_a_line_of_words_is_none():
    text = "A rigid body rotates.\nω = v / r\nPage 3: x = y\nfrom (12.1) to E = mc^2 (12.2)"
    assert [line for line, _ in pieces(text)] == [2, 4, 4]


def test_a_double_encoding_is_undone():
    line = "\N{THAI DIGIT ZERO}\N{THAI CHARACTER FO FAN} = \N{THAI DIGIT ZERO}\N{LEFT SINGLE QUOTATION MARK}š"
    assert plain(line) == "L=m"


@pytest.mark.parametrize(
    ("piece", "covered"),
    [("ω = v / r", True), ("ω = 2 v / r", False), ("as in (12.2)", True), ("as in (12.3)", False)],
)
def test_a_piece_is_covered_by_the_printed_text_or_by_the_number_of_its_equation(piece, covered):
    assert is_covered(piece, plain("the speed is ω = v / r"), {"12.2"}) == covered
