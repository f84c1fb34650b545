"""The findings about the claims of documents as lines of text, and as data for JSON."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from symrot.checker.textbook import Finding
from symrot.report.errata.entries import Survey
from symrot.report.layout import one_line

__all__ = ["facts", "lines", "total"]


COUNTED = {
    "holds": ("holds", "hold"),
    "other reading": (
        "holds in another reading of the extracted text",
        "hold in another reading of the extracted text",
    ),
    "conditional": ("holds under a condition that is not stated", "hold under a condition that is not stated"),
    "fails": ("does not hold", "do not hold"),
    "fails or lost": ("does not hold as extracted", "do not hold as extracted"),
    "undecided": ("is undecided", "are undecided"),
}
"""Outcome -> the words for one claim, and for several."""


def total(items: Sequence[Finding]) -> str:
    """Return a sentence that counts the findings about a document: ``12 claims: 10 hold, 2 do not hold.``"""
    counts = Counter(finding.outcome for finding in items)
    listed = ", ".join(f"{counts[name]} {words[counts[name] > 1]}" for name, words in COUNTED.items() if counts[name])
    return f"{len(items)} claims: {listed}."


def lines(survey: Survey) -> list[str]:
    """Return the findings about the claims of documents as lines of text.

    For each document there are its title, the claims, and a sentence that counts them. A claim that holds has one line;
    any other claim has more lines, with what is printed, what is right and why. ``survey`` is the result of
    :func:`symrot.report.errata.entries.survey`.
    """
    text: list[str] = []
    for source, items in survey:
        text += [f"{source.title} [{source.name}]", ""]
        for item in items:
            where = one_line(item.claim["where"])
            text.append(f"  {item.outcome:<13} {item.claim['id']} ({where})")
            if item.outcome != "holds":
                text += [f"      {label:<8} {one_line(words)}" for label, words in _details(item) if words]
        text += ["", f"  {total(items)}", ""]
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
    """Return the findings as data for JSON, one entry per claim: verdict, place, printed formula, right formula, .."""
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
            "conditions_left_out": list(item.conditions),
        }
        for source, items in survey
        for item in items
    ]
