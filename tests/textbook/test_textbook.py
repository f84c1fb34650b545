"""The verdicts on the four documents: each as reviewed by hand, and the page of errata as printed."""

import tomllib
from pathlib import Path

import pytest

from symrot.checker.textbook import OUTCOMES
from symrot.errors import InputError
from symrot.report import errata
from symrot.textbook import DOCUMENTS, document

TESTS = Path(__file__).parents[1]
pytestmark = pytest.mark.first  # the survey takes seconds
REVIEWED = tomllib.loads((TESTS / "reference" / "textbook.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def survey():
    return errata.survey()


def test_a_verdict_that_flips_is_noticed(survey):
    """Claims that do not simply hold have their reviewed verdicts, one by one."""
    for source, found in survey:
        assert {item.claim["id"]: item.outcome for item in found if item.outcome != "holds"} == REVIEWED[source.name]


def test_there_are_hundreds_of_claims_and_every_one_is_decided(survey):
    assert [source.name for source, _ in survey] == list(DOCUMENTS)
    assert sum(len(found) for _, found in survey) >= 300
    assert all(item.outcome in OUTCOMES and item.outcome != "undecided" for _, found in survey for item in found)


def test_what_does_not_hold_has_a_right_form_and_a_reason(survey):
    for _, found in survey:
        for item in found:
            if item.outcome in ("fails", "fails or lost"):
                assert item.right and item.reason and item.verdict.counterexample
                assert all(repair.proven for repair in item.verdict.repairs)


def test_the_errata_are_as_printed(survey):
    assert errata.page(survey) == (TESTS.parent / "generated" / "errata.md").read_text(encoding="utf-8")


def test_the_table_names_every_claim(survey):
    shown = "\n".join(errata.lines(survey[:1]))
    assert all(name in shown for name in survey[0][0].claims)
    assert len(errata.facts(survey)) == sum(len(found) for _, found in survey)


def test_an_unknown_document_is_refused():
    with pytest.raises(InputError, match="expected the name of a document, one of chen, "):
        document("goldstein")
