"""The verdicts on the four documents: each as reviewed by hand, and the page of errata as printed.

By default one document is checked; `pytest -m campaign` checks all four, and so does `.ci/run`.
"""

import tomllib
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.source.file import read_claims
from symrot.checker.textbook import OUTCOMES, Finding, differs_by_lost_characters, finding_of
from symrot.checker.verdict import Verdict
from symrot.errors import InputError
from symrot.report import errata
from symrot.report.errata.entries import condition_words, entries
from symrot.report.errata.page import html, page
from symrot.textbook import DOCUMENTS, Condition, PrintedFormula, conditions, document
from symrot.textbook import errata as errata_of_documents

TESTS = Path(__file__).parents[1]
pytestmark = pytest.mark.first  # the survey takes seconds
REVIEWED = tomllib.loads((TESTS / "reference" / "textbook.toml").read_text(encoding="utf-8"))


@cache
def survey_of(names):
    return errata.survey(names)


@pytest.fixture(scope="module", params=["chen", pytest.param("all", marks=pytest.mark.campaign)])
def survey(request):
    return survey_of(tuple(DOCUMENTS) if request.param == "all" else (request.param,))


@pytest.fixture(scope="module")
def whole():
    return survey_of(tuple(DOCUMENTS))


def test_a_verdict_that_flips_is_noticed(survey):
    """Claims that do not simply hold have their reviewed verdicts, one by one."""
    for source, found in survey:
        assert {item.claim["id"]: item.outcome for item in found if item.outcome != "holds"} == REVIEWED[source.name]


@pytest.mark.campaign
def test_there_are_hundreds_of_claims_and_every_one_is_decided(whole):
    assert [source.name for source, _ in whole] == list(DOCUMENTS)
    assert sum(len(found) for _, found in whole) >= 300
    assert all(item.outcome in OUTCOMES and item.outcome != "undecided" for _, found in whole for item in found)


def test_what_does_not_hold_has_a_right_form_and_a_reason(survey):
    typeset = {f.claim for erratum in errata_of_documents() for f in erratum.formulas if f.template}
    for _, items in survey:
        for item in items:
            if item.outcome in ("fails", "fails or lost"):
                assert item.right or item.claim["id"] not in typeset
                assert item.reason and item.verdict.counterexample
                assert all(repair.proven for repair in item.verdict.repairs)


@pytest.mark.campaign
def test_every_error_has_one_entry_and_every_entry_shows_an_error(whole):
    """The claims of the errata are the claims that do not hold, each once."""
    described = [formula.claim for erratum in errata_of_documents() for formula in erratum.formulas]
    assert len(described) == len(set(described))
    failing = {item.claim["id"] for _, items in whole for item in items if item.outcome == "fails"}
    assert set(described) == failing
    assert len(errata_of_documents()) == sum(len(entries(items)) for _, items in whole)


def test_every_entry_has_a_corrected_formula_that_differs_from_the_printed_one(survey):
    """A correction edits what is printed: never the reference, which stays as it is."""
    for _, items in survey:
        for entry in entries(items):
            assert entry.corrections and entry.why and entry.proof
            assert all(c.corrected and c.corrected != c.printed for c in entry.corrections), entry.title
            assert all("boxed" in c.corrected + c.printed for c in entry.corrections), entry.title
        for item in items:
            assert "right" not in item.corrected
            assert set(item.corrected) <= set(item.claim.get("editable", ["left"]))


def test_a_proposal_that_is_not_proven_is_refused():
    source = document("chen")
    claim = next(claim for claim in read_claims(source.path) if claim.id == "chen-parameters-start-list")
    data = source.claims[claim.id]
    with pytest.raises(InputError, match="expected a formula that is true"):
        finding_of(data, claim, True, _entry(left="Matrix([[phi], [theta], [theta]])"))
    with pytest.raises(InputError, match=r"expected a correction of left, .*, got a correction of 'right'"):
        finding_of(data, claim, True, _entry(right="Matrix([[phi], [theta], [phi]])"))


def _entry(derived="", **proposal):
    return PrintedFormula("", "", "", {}, proposal, derived)


def test_a_correction_is_derived_where_the_search_finds_none():
    source = document("chen")
    claim = next(claim for claim in read_claims(source.path) if claim.id == "chen-rates-inverse-body")
    item = finding_of(source.claims[claim.id], claim, False, _entry("J"))
    assert item.origin == "derivation"
    assert item.right.startswith("J = Matrix([[sin(psi(t))*csc(theta(t)), cos(psi(t))*csc(theta(t)), 0],")


@pytest.mark.campaign
def test_few_corrections_are_proposals(whole):
    origins = Counter(item.origin for _, items in whole for item in items if item.corrected)
    assert origins["proposal"] <= 4 < origins["derivation"] < origins["search"]


@pytest.mark.parametrize(
    ("printed", "right", "lost", "explained"),
    [
        ("a + b", "a - b", ["minus signs"], True),
        ("a + b", "a - b", ["fraction bars"], False),
        ("a + b", "a - b", ["token order"], False),
        ("R1*w/R2", "R2*w/R1", ["fraction bars", "token order"], True),
        ("R1*w/R2", "R2*w/R1", ["fraction bars"], False),
        ("m*s", "m*s**2", ["absolute-value bars"], True),
        ("W*A", "transpose(W)*A", ["transposes"], True),
        ("m*a", "m*a/2", ["fraction bars", "token order"], False),
        ("omega*r", "diff(omega, t)*r", ["dots"], True),
        ("Ia*r", "Ip*r", ["primes"], False),
    ],
)
def test_the_extraction_is_the_cause_only_of_differences_in_what_it_lost(printed, right, lost, explained):
    assert differs_by_lost_characters(read_expression(printed), read_expression(right), lost) == explained


def test_a_matrix_of_the_other_frame_is_an_error_and_no_other_reading(survey):
    """The matrix of one frame, used with components of the other: no lost character turns one into the other."""
    outcomes = {item.claim["id"]: item.outcome for _, items in survey for item in items}
    for name in ("chen-rates-of-euler-equations", "chen-rates-inverse-body", "chen-quaternion-rates-body"):
        assert outcomes[name] == "fails"


def test_a_condition_is_told_in_the_words_of_a_book():
    assert condition_words("cos(alpha) != 0") == r"$\cos \alpha \neq 0$: $\alpha$ is not an odd multiple of 90 degrees"
    assert condition_words("sin(alpha) >= 0") == r"$\sin \alpha \ge 0$: $\alpha$ lies between 0 and 180 degrees"
    assert condition_words("-a*b + c >= 0") == r"$c \ge a b$"
    assert condition_words("x >= 0") == r"$x \ge 0$"


@pytest.mark.campaign
def test_formulas_that_hold_under_a_condition_on_an_angle_are_listed(whole):
    conditional = [item for _, items in whole for item in items if item.outcome == "conditional"]
    assert conditional and all(item.conditions for item in conditional)
    assert page(whole).count("### Conditions left out") == 3
    assert {item.verdict.verdict for item in conditional} == {"true", "conditional", "false"}
    proposed = {condition.claim for condition in conditions()}
    assert {item.claim["id"] for item in conditional if item.words} == proposed


@pytest.mark.parametrize(("verdict", "joint"), [("true", "and"), ("false", "and"), ("conditional", "or")])
def test_the_reason_joins_conditions_by_and_unless_one_of_them_suffices(verdict, joint):
    item = Finding({}, Verdict(verdict), "conditional", conditions=("sin(x) != 0", "a > b"))
    assert item.reason == f"true if sin(x) != 0 {joint} a > b"


def test_a_condition_under_which_a_claim_is_not_proven_is_refused():
    source = document("brown")
    claim = next(claim for claim in read_claims(source.path) if claim.id == "brown-prism-equation-axes")
    with pytest.raises(InputError, match="expected a condition under which the claim is true, got 'cos"):
        finding_of(source.claims[claim.id], claim, True, None, Condition(claim.id, ("cos(f) == 0",), ""))


@pytest.mark.campaign
@pytest.mark.parametrize("suffix", ["md", "html"])
def test_the_errata_are_as_printed(whole, suffix):
    text = {"md": page, "html": html}[suffix](whole)
    assert text == (TESTS.parent / "generated" / f"errata.{suffix}").read_text(encoding="utf-8")


@pytest.mark.campaign
def test_the_page_for_a_browser_is_self_contained_and_typeset(whole):
    text = html(whole)
    assert "<script" not in text and "http" not in text.replace("http://www.w3.org/1998/Math/MathML", "")
    assert text.count("<math") > 100 and '<mrow class="mark">' in text
    assert "color-scheme: light dark" in text and "prefers-color-scheme: dark" in text


def test_the_table_names_every_claim(survey):
    shown = "\n".join(errata.lines(survey[:1]))
    assert all(name in shown for name in survey[0][0].claims)
    assert len(errata.facts(survey)) == sum(len(found) for _, found in survey)


def test_an_unknown_document_is_refused():
    with pytest.raises(InputError, match="expected the name of a document, one of chen, "):
        document("goldstein")
