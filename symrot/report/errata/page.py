"""The page of errata, in Markdown for a code-hosting site and in HTML for a browser."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from symrot.checker.textbook import Finding
from symrot.proof.pages.html import display as html_display
from symrot.proof.pages.html import document, prose
from symrot.proof.pages.markdown import display as markdown_display
from symrot.proof.pages.markdown import host_safe
from symrot.report.errata.entries import Entry, Survey, condition_words, entries
from symrot.report.errata.table import total

__all__ = ["html", "page"]

TITLE = "Errata"
ABOUT = (
    "These are remarks for the authors and readers of four documents on rigid-body rotation. Every formula, table "
    "entry and worked number was read into a claim, compared with a result that is derived from first principles, and "
    "decided exactly. A correction is found by a search near the printed formula, derived from the reference, or "
    "proposed by a person; it is printed only if it is proven. The difference between the printed and the corrected "
    "formula is marked."
)
EXTRACTION = (
    "The documents are known here as text extracted from PDF files, which loses characters. A line counts as an error "
    "only if the lost characters cannot be the reason: if the printed and the true formula differ in more than "
    "characters of the kinds that were lost at this place. The other lines are listed under *What the extraction may "
    "have lost*."
)
NO_CORRECTION = "No correction near the printed formula is known here."


class Block(NamedTuple):
    """A block of the page of errata: its kind, such as ``"title"`` or ``"item"``, and its text as Markdown or LaTeX."""

    kind: str
    text: str


def page(survey: Survey) -> str:
    """Return the text of ``errata.md``, the page of errata.

    ``survey`` is the result of :func:`symrot.report.errata.entries.survey`.
    """
    return "\n\n".join(MARKDOWN[block.kind](block.text) for block in _blocks(survey)) + "\n"


def html(survey: Survey) -> str:
    """Return the text of ``errata.html``, the page of errata as a document that needs no script and no network."""
    return document(TITLE, [HTML[block.kind](block.text) for block in _blocks(survey)], STYLE)


def _blocks(survey: Survey) -> Iterator[Block]:
    every = [(source, items, entries(items)) for source, items in survey]
    yield Block("title", TITLE)
    yield Block("text", ABOUT)
    yield Block("text", EXTRACTION)
    claims = sum(len(items) for _, items, _ in every)
    errors = sum(len(errors) for _, _, errors in every)
    conditions = sum(item.outcome == "conditional" for _, items, _ in every for item in items)
    numbers = sum(item.claim["kind"] == "number" for _, items, _ in every for item in items)
    counted = f"{claims} claims, {numbers} of them worked numbers, show {errors} errors"
    printed = "Printed by `symrot check --textbook all --all`; do not edit."
    yield Block("text", f"{counted}. {conditions} formulas leave out a condition. {printed}")
    number = 0
    for source, items, errors_of_document in every:
        yield Block("section", source.title)
        yield Block("text", total(items))
        for entry in errors_of_document:
            number += 1
            yield from _of_entry(number, entry)
        yield from _of_conditions(source.name, [item for item in items if item.outcome == "conditional"])
        yield from _of_extraction([item for item in items if item.outcome in ("other reading", "fails or lost")])


def _of_entry(number: int, entry: Entry) -> Iterator[Block]:
    yield Block("entry", f"{number}. {entry.title}, {entry.where}")
    several = len({correction.where for correction in entry.corrections}) > 1
    for correction in entry.corrections:
        at = f", {correction.where}" if several else ""
        yield Block("label", f"Printed{at}:")
        yield Block("formula", correction.printed)
        yield Block("label", "Correct:" if correction.corrected else NO_CORRECTION)
        if correction.corrected:
            yield Block("correction", correction.corrected)
    yield Block("text", f"*Why:* {entry.why}")
    yield Block("text", f"*Proof:* {entry.proof}")
    for line in entry.extracted:
        yield Block("extracted", line)


def _of_conditions(document_name: str, items: Sequence[Finding]) -> Iterator[Block]:
    """Yield the blocks of the page about formulas that need a condition which the document does not state."""
    if not items:
        return
    yield Block("entry", "Conditions left out")
    yield Block("text", "These formulas hold under a condition that the document does not state.")
    grouped: dict[str, dict[str, list[str]]] = {}
    for item in items:
        joint = " or " if item.verdict.verdict == "conditional" else " and "
        words = item.words or joint.join(map(condition_words, item.conditions))
        grouped.setdefault(words, {}).setdefault(item.claim["where"], []).append(
            # chen-velocity-2d -> "velocity 2d"
            str(item.claim["id"]).removeprefix(f"{document_name}-").replace("-", " ")
        )
    for words, places in grouped.items():
        listed = "; ".join(f"{where}: {', '.join(names)}" for where, names in places.items())
        yield Block("item", f"{words}. Where: {listed}.")


def _of_extraction(items: Sequence[Finding]) -> Iterator[Block]:
    """Yield the blocks of the page about formulas that do not hold as extracted, but may be right in the document."""
    if not items:
        return
    yield Block("entry", "What the extraction may have lost")
    for item in items:
        # characters that were lost when the text was extracted from its PDF file
        lost = ", ".join(item.claim["lost"])
        printed, right = (text.partition(" == ")[0] for text in (item.verdict.text, item.right))
        place = f"{item.claim['where']}, `{item.claim['id']}`"
        loss = f"which does not hold; `{right}` does, and differs in lost characters only ({lost})"
        yield Block("item", f"{place}: extracted as `{printed}`, {loss}.")


# -- the two formats ---------------------------------------------------------------------------------------------------

STYLE = """
.mark { background: #ffe27a; color: #1a1a1a; border-radius: 0.2em; padding: 0.05em 0.15em; }
@media (prefers-color-scheme: dark) { .mark { background: #7a5c00; color: #fff6d6; } }
h3 { margin-top: 2.2rem; font-size: 1.12rem; }
.label { margin: 0.6rem 0 0; font-variant: small-caps; }
.correction { border-left: 0.25rem solid #3a8f4e; padding-left: 0.6rem; }
.extracted { font: 0.8rem/1.4 ui-monospace, monospace; opacity: 0.75; overflow-wrap: anywhere; margin: 0.2rem 0; }
li { margin: 0.35rem 0; }
li code, p code { overflow-wrap: anywhere; }
"""


def _quoted(text: str) -> str:
    """Return a text as inline code of Markdown, on one line."""
    flat = " ".join(text.split())
    fence = "``" if "`" in flat else "`"
    return f"{fence}{flat}{fence}"


MARKDOWN: dict[str, Callable[[str], str]] = {
    "title": lambda text: f"# {text}",
    "section": lambda text: f"## {text}",
    "entry": lambda text: f"### {text}",
    "text": host_safe,
    "label": lambda text: text,
    "formula": markdown_display,
    "correction": markdown_display,
    "extracted": lambda text: f"<sub>Extracted text: {_quoted(text)}</sub>",
    "item": lambda text: f"- {host_safe(text)}",
}

HTML: dict[str, Callable[[str], str]] = {
    "title": lambda text: f"<h1>{prose(text)}</h1>",
    "section": lambda text: f"<h2>{prose(text)}</h2>",
    "entry": lambda text: f"<h3>{prose(text)}</h3>",
    "text": lambda text: f"<p>{prose(text)}</p>",
    "label": lambda text: f'<p class="label">{prose(text)}</p>',
    "formula": html_display,
    "correction": lambda text: f'<div class="correction">{html_display(text)}</div>',
    "extracted": lambda text: f'<p class="extracted">Extracted text: {prose(_quoted(text))}</p>',
    "item": lambda text: f"<ul><li>{prose(text)}</li></ul>",
}
