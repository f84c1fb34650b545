"""Every formula of the four documents is a claim, or has a reason why it is none."""

import pytest

from symrot.textbook import DOCUMENTS, LINE_KINDS, document, lines
from tests.textbook.coverage import is_covered, pieces, plain, reference_pieces, signs_left_out, uncovered

WITH_CLAIM = ("operators", "letters", "repeats", "input")
"""The kinds of lines that name the claim which states their formula."""


def test_a_line_with_a_relation_is_a_piece_and_a_line_of_words_is_none():
    text = "A rigid body rotates.\nω = v / r\nPage 3: x = y\nfrom (12.1) to E = mc^2 (12.2)"
    assert [line for line, _ in pieces(text)] == [2, 4, 4]


def test_a_line_has_a_piece_for_each_group_of_relations():
    text = "a = b + 1" + 150 * " and so on" + " c = d + 2, e = f + 3"
    assert [piece.strip()[:9] for _, piece in pieces(text)] == ["a = b + 1", "d so on a"]
    assert "e = f + 3" in list(pieces(text))[1][1]


def test_a_double_encoding_is_undone():
    line = "\N{THAI DIGIT ZERO}\N{THAI CHARACTER FO FAN} = \N{THAI DIGIT ZERO}\N{LEFT SINGLE QUOTATION MARK}š"
    assert plain(line) == "L=m"


@pytest.mark.parametrize(
    ("piece", "covered"),
    [("ω = v / r", True), ("ω = 2 v / r", False), ("as in (12.2)", True), ("as in (12.3)", False)],
)
def test_a_piece_is_covered_by_the_printed_text_or_by_the_number_of_its_equation(piece, covered):
    assert is_covered(piece, plain("the speed is ω = v / r"), {"12.2"}) == covered


@pytest.mark.parametrize("name", DOCUMENTS)
def test_every_formula_of_a_document_is_a_claim_or_has_a_reason_why_it_is_none(name):
    every = reference_pieces()[name]
    assert every and uncovered(name, every) == []
    assert uncovered(name, [(1, "E = m c^2 h nu / 7")]) == [(1, "E = m c^2 h nu / 7")]


@pytest.mark.parametrize("name", DOCUMENTS)
def test_every_relation_sign_of_a_document_is_in_a_claim_or_in_a_line_with_a_reason(name):
    """A piece may have several formulas, as ``T = 300 days, .. T = 400 days`` has: each counts."""
    assert signs_left_out(name) == []


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_line_without_a_claim_of_its_own_is_printed_by_the_document_and_names_a_claim_that_exists(name):
    every = [plain(piece) for _, piece in reference_pieces()[name]]
    claims = document(name).claims
    for line in lines(name):
        assert line.kind in LINE_KINDS, line
        assert line.claim in claims if line.kind in WITH_CLAIM else line.claim == "", line
        assert any(plain(line.printed) in piece for piece in every), line
