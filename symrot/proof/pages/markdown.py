"""Printer of derivations as Markdown for a code-hosting site; a derivation always gives the same bytes."""

import re
from collections.abc import Iterator

from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages.parts import equation, footer, passage_equations, remarks, repetitions, table_rows, units

__all__ = ["display", "host_safe", "inline", "markdown"]

MANY_SECTIONS = 8


def markdown(page: Page) -> str:
    """Return a page as Markdown; display formulas are between ``$$`` on separate lines."""
    parts = [f"# {page.title}"]
    for opening in page.opening:
        parts += _figure(opening) if isinstance(opening, Figure) else _passage(opening)
    if page.about:
        parts.append(page.about)
    if page.source:
        parts.append(f"*Source:* {page.source}.")
    parts += _contents(page)
    number, repeats = page.first - 1, repetitions(page)
    for item in page.items:
        if isinstance(item, Section):
            parts.append(f"## {item.title}")
        elif isinstance(item, Step):
            number += 1
            parts += [f"**{number}.** {item.claim}", display(equation(item))]
            parts += filter(None, [" ".join(remarks(item, number in repeats))])
        elif isinstance(item, Figure):
            parts += _figure(item)
        elif isinstance(item, Table):
            parts += [item.text, _table(item, number)]
            number += len(item.steps)
        else:
            parts += _passage(item)
    symbols_used = units(page)
    if symbols_used:
        parts.append(f"**Units** of the symbols in the proofs: {symbols_used}.")
    for closing in page.closing:
        parts += [f"## {closing.title}"] if isinstance(closing, Section) else _passage(closing)
    parts += ["---", footer(page)]
    return "\n\n".join(map(host_safe, parts)) + "\n"


def _figure(figure: Figure) -> list[str]:
    return [f"![{figure.title}]({figure.file})", f"*Figure:* {figure.caption}"]


def _table(table: Table, number: int) -> str:
    head, *rows = (f"| {' | '.join(cells)} |" for cells in table_rows(table, number))
    rule = "|" + " --- |" * head.count(" | ") + " --- |"
    return "\n".join([head, rule, *rows])


def _passage(passage: Passage) -> list[str]:
    return [passage.text, *(display(text) for text in passage_equations(passage))]


MARKED = re.compile(r"\\[^A-Za-z]|[\])}]_|\*")
"""Pattern of what Markdown would take for its own markup inside an inline formula."""


def host_safe(part: str) -> str:
    """Return Markdown in which formulas that contain marks of Markdown are quoted: ``$a*b$`` gives ``$`a*b`$``."""
    # displayed formulas are unchanged
    if part.startswith("$$"):
        return part
    # Markdown would read _ or * in a formula $...$ as emphasis, so that such formulas are quoted as $`...`$
    return re.sub(r"\$([^$]+)\$", lambda m: f"$`{m[1]}`$" if MARKED.search(m[1]) else m[0], part)


def inline(text: str) -> str:
    """Return the Markdown that :func:`markdown` printed, with ``$`x`$`` replaced by ``$x$``, as notebooks expect it."""
    return re.sub(r"\$`([^`]+)`\$", r"$\1$", text)


def _contents(page: Page) -> Iterator[str]:
    """Yield one line with links to all sections of a page that has more than MANY_SECTIONS; nothing for other pages."""
    titles = [item.title for item in page.items if isinstance(item, Section)]
    if len(titles) > MANY_SECTIONS:
        anchors = (re.sub("[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in titles)
        links = (f"[{title.split(',')[0]}](#{anchor})" for title, anchor in zip(titles, anchors, strict=True))
        yield f"Sections: {' · '.join(links)}"


def display(text: str) -> str:
    """Return a LaTeX formula as Markdown on lines of its own, between lines ``$$``."""
    return f"$$\n{text}\n$$"
