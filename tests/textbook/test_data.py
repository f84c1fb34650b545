"""The claims of the four documents: well-formed data that states the claims of a document and no verdicts."""

import re
import tomllib
from pathlib import Path

import pytest

import symrot
from symrot.textbook import errata

FOLDER = Path(symrot.__file__).parent / "textbook"
DOCUMENTS = {"chen": 60, "sahakian": 95, "brown": 150, "beer-johnston": 70}  # name -> the least number of claims
ALL = 400

HEAD = {"schema", "document", "title", "kind", "lost", "note", "claim"}
TEXTS = {"id", "where", "printed", "kind", "claim", "value", "printed_value", "against", "note"}
LISTS = {"lost", "symbols", "functions", "given", "alternatives", "editable"}
REQUIRED = {"id", "where", "printed", "kind", "against"}
KINDS = {"formula", "table", "number"}
BUILT_IN = set(
    re.findall(
        r"\w+",
        "Rx Ry Rz skew vee cross dot det transpose inverse trace eye diag Matrix hstack qmul dcm_of "
        "sqrt sin cos tan cot sec csc exp atan2 diff integrate pi",
    )
)
TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?(?![\w.]))|(?P<name>[A-Za-z]\w*)|(?P<mark>\*\*|==|!=|>|[-+*/(),\[\]]|\.T\b))",
    re.ASCII,
)
OPENING = {")": "(", "]": "["}


def load(document):
    return tomllib.loads((FOLDER / f"{document}.toml").read_text(encoding="utf-8"))


def read_names(text):
    """Return the names in a formula of the claim language; raise ValueError for any other text."""
    names, brackets, position = set(), [], 0
    while position < len(text.rstrip()):
        match = TOKEN.match(text, position)
        if match is None:
            raise ValueError(f"not the claim language at position {position + 1}: {text!r}")
        mark = match["mark"]
        if match["name"]:
            names.add(match["name"])
        elif mark in ("(", "["):
            brackets.append(mark)
        elif mark in OPENING and (not brackets or brackets.pop() != OPENING[mark]):
            raise ValueError(f"bracket at position {position + 1}: {text!r}")
        position = match.end()
    if brackets:
        raise ValueError(f"open bracket: {text!r}")
    return names


def formulas(claim):
    """Yield each formula of a claim in reading order: its role, its text, the names it may use."""
    known = BUILT_IN | set(claim.get("symbols", [])) | set(claim.get("functions", []))
    for name, text in claim.get("define", []):
        yield name, text, set(known)
        known = known | {name}
    for key in ("given", "alternatives"):
        for text in claim.get(key, []):
            yield key, text, known
    for key in ("claim", "value"):
        if key in claim:
            yield key, claim[key], known


CLAIMS = [(document, claim) for document in DOCUMENTS for claim in load(document)["claim"]]

PROPOSALS = {formula.claim: formula.proposal for erratum in errata() for formula in erratum.formulas}
LETTERS = {formula.claim: formula.letters for erratum in errata() for formula in erratum.formulas}


def each_claim(law):
    """Return a test that applies a law to all claims of a document: 2700 separate tests would cost more than the laws."""

    @pytest.mark.parametrize("document", DOCUMENTS)
    def test(document):
        for source, claim in CLAIMS:
            if source == document:
                try:
                    law(claim)
                except (AssertionError, ValueError) as reason:
                    raise AssertionError(f"{claim['id']}: {reason}") from reason

    test.__doc__ = law.__doc__
    return test


@pytest.mark.parametrize("document", DOCUMENTS)
def test_a_document_says_what_it_is_and_what_its_extraction_lost(document):
    head = load(document)
    assert head["schema"] == 1 and head["document"] == document
    assert set(head) == HEAD
    assert all(isinstance(head[key], str) and head[key] for key in ("title", "kind", "note"))
    assert len(head["lost"]) == len(set(head["lost"])) > 0
    assert len(head["claim"]) >= DOCUMENTS[document]


def test_there_are_enough_claims_and_no_two_share_a_name():
    names = [claim["id"] for _, claim in CLAIMS]
    assert len(names) >= ALL
    assert len(names) == len(set(names))


def test_a_name_begins_with_the_document_and_a_loss_is_one_the_document_suffers():
    losses = {document: set(load(document)["lost"]) for document in DOCUMENTS}
    for document, claim in CLAIMS:
        assert claim["id"].startswith(f"{document}-"), claim["id"]
        assert set(claim.get("lost", [])) <= losses[document], claim["id"]


@each_claim
def test_keys_are_the_known_ones_and_none_speaks_of_a_verdict(claim):
    assert set(claim) <= TEXTS | LISTS | {"define"}
    assert set(claim) >= REQUIRED
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)+", claim["id"])
    assert claim["kind"] in KINDS
    assert all(isinstance(claim[key], str) and claim[key].strip() == claim[key] != "" for key in TEXTS & set(claim))
    assert all(isinstance(text, str) and text for key in LISTS & set(claim) for text in claim[key])
    spoken = f"{claim['against']} {claim.get('note', '')}".lower()
    assert not re.search(r"\b(wrong|error|erratum|incorrect|mistake|false|should be|misprint)\b", spoken)


@each_claim
def test_a_claim_is_an_equation_or_a_value_with_its_printed_digits(claim):
    if "claim" in claim:
        assert not {"value", "printed_value"} & set(claim)
    else:
        assert re.fullmatch(r"-?\d+(\.\d+)?", claim["printed_value"])
        assert claim["printed_value"].lstrip("-") in claim["printed"]
        assert not {"alternatives", "given"} & set(claim)
        assert "==" not in claim["value"]
    for text in [claim.get("claim"), *claim.get("alternatives", [])]:
        assert text is None or len(text.split("==")) == 2, text
    assert all(len(re.split("==|!=|>", text)) == 2 for text in claim.get("given", []))
    assert all(len(pair) == 2 and "==" not in pair[1] for pair in claim.get("define", []))


@each_claim
def test_every_formula_is_in_the_claim_language_and_every_name_is_declared_before_it_is_used(claim):
    for what, text, known in formulas(claim):
        assert read_names(text) - {"T"} <= known, what


@each_claim
def test_names_are_declared_once_and_none_hides_a_built_in(claim):
    declared = [*claim.get("symbols", []), *claim.get("functions", []), *(name for name, _ in claim.get("define", []))]
    assert len(declared) == len(set(declared))
    assert not set(declared) & BUILT_IN
    used = set().union(*(read_names(text) for _, text, _ in formulas(claim)))
    used |= set().union(*(read_names(text) for text in PROPOSALS.get(claim["id"], {}).values()))
    used |= set(LETTERS.get(claim["id"], {}))  # letters of the document, which a correction may use
    assert set(declared) <= used


@pytest.mark.parametrize("text", ["a ^ b", "f(x", "x)", "[1, 2)", "a = b", "__import__", "x.y", "1e5", "a; b", "'a'"])
def test_the_reader_of_these_tests_refuses_what_is_not_the_claim_language(text):
    with pytest.raises(ValueError, match=r"position|bracket"):
        read_names(text)


def test_a_template_has_holes_for_parts_of_its_claim_and_words_are_courteous():
    claims = {claim["id"]: claim for _, claim in CLAIMS}
    for erratum in errata():
        assert not re.search(r"\b(wrong|mistake|blunder|careless|nonsense|of course)\b", erratum.why.lower()), (
            erratum.title
        )
        assert erratum.formulas[0].template, erratum.title
        for formula in erratum.formulas:
            claim = claims[formula.claim]
            parts = {"left", "right", "printed", *(name for name, _ in claim.get("define", []))}
            assert set(re.findall(r"@(\w+)@", formula.template + formula.corrected)) <= parts
            assert set(formula.letters) <= {*parts, *claim.get("symbols", []), *claim.get("functions", [])}
