"""The corpus of printed formulas: its files are complete and balanced, and an independent numeric test agrees with
every label.
"""

import ast
from collections import Counter

import pytest

from tests.campaigns.checker.corpus import verify

FORMS = ("plain", "latex", "unicode", "sympy")
FAULTS = (
    "sign", "factor", "swapped_index", "swapped_function", "missing_term", "exponent", "wrong_axis", "missing_square", "wrong_denominator",
    "transposed", "half_angle", "other",
)  # fmt: skip
CHAPTERS = {
    "axis_angle", "books", "energy", "euler_equations", "free_bodies", "further", "identities", "inertia", "quaternions", "rates", "references", "rotation",
    "tops", "vectors", "work",
}  # fmt: skip
FIELDS = {"id", "text", "form", "kind", "source", "expected", "check", "chapter"}
OPTIONAL = {"recognised_as", "note", "given", "where", "frame", "sequence", "body", "units"}
OF_FAULTS = {"fault", "original", "explanation"}
ENTRIES = verify.read()
BY_ID = {entry["id"]: entry for entry in ENTRIES}
CORRECT = [entry for entry in ENTRIES if entry["expected"] in verify.CORRECT]
FAULTY = [entry for entry in ENTRIES if entry["expected"] in verify.FAULTY]


def test_there_are_enough_formulas_of_every_chapter_and_half_of_them_are_faulty():
    assert {entry["chapter"] for entry in ENTRIES} == CHAPTERS
    assert len(ENTRIES) >= 400
    assert len(CORRECT) + len(FAULTY) == len(ENTRIES)
    assert len(CORRECT) >= 200
    assert 0.45 <= len(FAULTY) / len(ENTRIES) <= 0.55
    assert min(Counter(entry["chapter"] for entry in ENTRIES).values()) >= 30


def test_no_formula_occurs_twice():
    assert len(BY_ID) == len(ENTRIES)
    contexts = Counter(
        (entry["text"], str([entry.get(key) for key in sorted(OPTIONAL - {"recognised_as", "note"})]))
        for entry in ENTRIES
    )
    assert [text for text, count in contexts.items() if count > 1] == []


def test_the_ways_of_writing_are_balanced_in_both_halves():
    for half in (CORRECT, FAULTY):
        forms = Counter(entry["form"] for entry in half)
        assert set(forms) == set(FORMS)
        assert all(0.25 <= forms[form] / len(half) <= 0.4 for form in ("plain", "latex", "unicode"))


@pytest.mark.parametrize("chapter", sorted(CHAPTERS))
def test_every_entry_has_its_fields(chapter):
    for entry in (entry for entry in ENTRIES if entry["chapter"] == chapter):
        name = entry["id"]
        correct = entry["expected"] in verify.CORRECT
        assert name.startswith(chapter + "."), name
        assert FIELDS - set(entry) <= ({"check"} if entry["expected"] == "definition" else set()), name
        assert set(entry) <= FIELDS | OPTIONAL | (set() if correct else OF_FAULTS), name
        assert entry["form"] in FORMS and entry["text"].strip() and len(entry["source"]) > 10, name
        assert entry["kind"] in ("naming", "claim"), name
        assert entry["expected"] in (
            ("recognised", "definition", "doubtful") if entry["kind"] == "naming" else ("true", "conditional", "false")
        ), name
        assert entry["kind"] == "claim" or entry["expected"] == "definition" or entry["recognised_as"], name
        assert entry["expected"] != "conditional" or entry["note"].startswith("true "), name
        assert all(isinstance(entry.get(key, []), list) for key in ("given", "where")), name


def test_every_faulty_formula_names_its_fault_and_its_correct_original():
    for entry in FAULTY:
        original = BY_ID[entry["original"]]
        assert entry["fault"] in FAULTS and len(entry["explanation"].split()) >= 3, entry["id"]
        assert original["expected"] in verify.CORRECT, entry["id"]
        assert original["text"] != entry["text"], entry["id"]


def test_texts_are_written_as_their_form_says():
    for entry in ENTRIES:
        text, name = entry["text"], entry["id"]
        if entry["form"] == "unicode":
            assert not text.isascii() and "\\" not in text, name
            continue
        assert text.isascii(), name
        if entry["form"] == "latex":
            assert any(mark in text for mark in "\\_^"), name
            assert text.count("{") == text.count("}") and text.count("\\left") == text.count("\\right"), name
            assert text.count("\\begin") == text.count("\\end"), name
        else:
            assert "\\" not in text and all(text.count(left) == text.count(right) for left, right in ("()", "[]")), name
        if entry["form"] == "sympy":
            ast.parse(text, mode="eval")


@pytest.mark.parametrize("step", [3, pytest.param(1, marks=pytest.mark.campaign)])
def test_the_oracle_agrees_with_every_label(step):
    assert [sentence for sentence in map(verify.disagreement, ENTRIES[::step]) if sentence] == []


def test_the_oracle_contradicts_a_wrong_label():
    correct = {"id": "right", "expected": "recognised", "check": "close(inertia(1, rod(l), m)[2,2], m*l**2/12)"}
    faulty = {"id": "wrong", "expected": "doubtful", "check": "close(inertia(1, rod(l), m)[2,2], m*l**2/13)"}
    assert verify.disagreement(correct) == verify.disagreement(faulty) == ""
    assert "its check holds" in verify.disagreement({**correct, "expected": "doubtful"})
    assert "its check fails" in verify.disagreement({**faulty, "expected": "recognised"})
    assert "does not run" in verify.disagreement({**correct, "check": "close(inertia("})
    assert "has no check" in verify.disagreement({"id": "bare", "expected": "true"})


def test_the_families_of_rates_contain_other_readings_and_no_faulty_formula():
    sin, cos, tan = verify.sin, verify.cos, verify.tan
    assert verify.rate_like(lambda f, t, p, df, dt, dp: df - dp * sin(t))
    assert verify.rate_like(lambda f, t, p, df, dt, dp: dp + df * sin(t))
    assert not verify.rate_like(lambda f, t, p, df, dt, dp: df - dp * sin(p) * 2)
    assert verify.solved_like(lambda f, t, y, p, q, r: p + tan(t) * (q * sin(f) + r * cos(f)))
    assert not verify.solved_like(lambda f, t, y, p, q, r: p + tan(t) * (q * sin(f) + r * sin(f)))
