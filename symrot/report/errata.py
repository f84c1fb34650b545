"""The findings about the claims of four textbooks and courses, as a table and as the page ``generated/errata.md``."""

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from symrot.checker.textbook import OUTCOMES, Finding, findings
from symrot.report.layout import one_line
from symrot.textbook import DOCUMENTS, Document, document

__all__ = ["facts", "lines", "page", "survey"]

Survey = list[tuple[Document, list[Finding]]]


def survey(
    names: Sequence[str] = DOCUMENTS, repair: bool = True, progress: Callable[[str], None] = lambda text: None
) -> Survey:
    """Decide the claims of the named textbooks; return (textbook, findings about its claims) for each textbook.

    With ``repair``, a finding about a claim that does not hold contains a correction.
    """
    documents = []
    for name in names:
        source = document(name)
        documents.append((source, list(findings(source, repair, progress))))
    return documents


def _total(items: Sequence[Finding]) -> str:
    counts = Counter(finding.outcome for finding in items)
    listed = ", ".join(f"{counts[name]} {OUTCOMES[name].split(';')[0]}" for name in OUTCOMES if counts[name])
    return f"{len(items)} claims: {listed}."


def lines(survey: Survey) -> list[str]:
    """Return the findings as lines of text: one line for a claim that holds, more for another claim, and a summary."""
    text: list[str] = []
    for source, items in survey:
        text += [f"{source.title} [{source.name}]", ""]
        for item in items:
            where = one_line(item.claim["where"])
            text.append(f"  {item.outcome:<13} {item.claim['id']} ({where})")
            if item.outcome != "holds":
                text += [f"      {label:<8} {one_line(words)}" for label, words in _details(item) if words]
        text += ["", f"  {_total(items)}", ""]
    return text[:-1]


def _details(item: Finding) -> list[tuple[str, str]]:
    return [
        ("printed", item.claim["printed"]),
        ("read as", item.verdict.text),
        ("because", item.reason if not item.reading else ""),
        ("right", item.right),
        ("against", item.claim.get("against", "")),
        ("lost", ", ".join(item.claim.get("lost", []))),
    ]


def facts(survey: Survey) -> list[dict[str, Any]]:
    """Return the findings about claims as data for JSON."""
    return [
        {
            "document": source.name,
            **item.verdict.to_json(),
            "id": item.claim["id"],
            "where": item.claim["where"],
            "printed": item.claim["printed"],
            "outcome": item.outcome,
            "right": item.right,
            "against": item.claim.get("against", ""),
        }
        for source, items in survey
        for item in items
    ]


def page(survey: Survey) -> str:
    """Return the text of ``errata.md``: for each textbook, the claims that do not hold, with correction and reason."""
    text = [
        "# Errata",
        "",
        "What four documents on rigid-body rotation print that does not hold: every claim was read into a",
        "formula, compared with something derived from first principles, and decided exactly. Printed by",
        "`symrot check --textbook all --all`; do not edit.",
        "",
        "The documents are known here as text extracted from PDF files, which loses characters. Where what was lost",
        "may be the reason, or another reading holds, the entry says so.",
    ]
    for source, items in survey:
        text += ["", f"## {source.title}", "", _total(items), ""]
        for item in items:
            if item.outcome != "holds":
                text += _entry(item)
    return "\n".join(text).rstrip() + "\n"


def _entry(item: Finding) -> list[str]:
    rows = [f"### {item.claim['where']}: {item.claim['id']}", "", f"- **{OUTCOMES[item.outcome]}**"]
    rows += [f"- {label}: {_code(words)}" for label, words in _details(item) if words]
    return [*rows, ""]


def _code(words: str) -> str:
    """Return a text as inline code on one line of Markdown."""
    flat = " ".join(words.split())
    fence = "``" if "`" in flat else "`"
    return f"{fence}{flat}{fence}"
