"""Printer of all pages as a book in HTML: contents in reading order, links between pages, and a search.

The book needs no network and no server. The same pages always give the same bytes.
"""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from html import unescape

from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages.html import document, html_document, prose
from symrot.proof.pages.math_font import FILE, face

__all__ = ["CONTENTS", "SEARCH", "book", "search_script"]

CONTENTS, SEARCH = "index.html", "search.js"

STYLE = """
nav.book { display: flex; flex-wrap: wrap; gap: 0.2rem 1.5rem; justify-content: space-between; margin: 1rem 0; }
form { margin: 1rem 0; }
input { font: inherit; max-width: 100%; }
#results li { margin: 0.5rem 0; }
#results small { display: block; }
@media print { nav.book, form { display: none; } }
"""

SCRIPT = """\
"use strict";
const field = document.querySelector("input[name=q]");
const list = document.getElementById("results");
const count = document.getElementById("count");
const MOST = 60;

// words that say nothing about a subject; "s" remains of "Euler's"
const IDLE = new Set(["a", "an", "and", "by", "for", "from", "in", "is", "of", "on", "s", "the", "to", "with"]);
const plain = (text) => text.normalize("NFD").replace(/[\\u0300-\\u036f]/g, "").toLowerCase();
// axis and axes, body and bodies, matrix and matrices, gyroscope and gyroscopic have the same stem
const stem = (word) => word.length > 5 ? word.replace(/(?:ices|ies|ix|es|is|s|e|y)$/, "") :
  word.length > 3 ? word.replace(/(?:es|is|s|y)$/, "") : word;
// in texts, all words are joined by single spaces: " the gimbal lock of"
const flat = (text) => " " + plain(text).replace(/[^\\p{L}\\p{N}]+/gu, " ").trim();
const PAGES = new Map();
for (const [target, title, text] of ENTRIES) {
  const name = target.split("#")[0];
  if (!PAGES.has(name)) PAGES.set(name, { title: flat(title), names: "", entries: [] });
  const page = PAGES.get(name);
  if (title.endsWith(", also called")) page.names += plain(text).split(",").map((each) => flat(each) + " ,").join("");
  page.entries.push({ target, title, text, words: flat(title + " " + text) });
}

// the pages that have most of the stems, the best page first, each with its entries that have all of them
function ranked(stems) {
  const phrase = " " + stems.join("\\\\p{L}* ") + "\\\\p{L}*";
  const together = new RegExp(phrase, "u"), alone = new RegExp(`${phrase} ,`, "u");
  const has = (words) => stems.filter((each) => words.includes(" " + each)).length;
  const pages = [...PAGES].map(([name, page]) => {
    const shares = page.entries.map((entry) => has(entry.words));
    const most = Math.max(...shares);
    const subject = page.title + " " + page.names;
    const share = page.entries.filter((entry) => together.test(entry.words)).length / page.entries.length;
    const rank = 4 * has(page.title) + 3 * has(page.names) + (together.test(page.title) ? 10 : 0) +
      (together.test(page.names) ? 8 : 0) + (alone.test(page.names) ? 9 : 0) + 6 * share +
      (name.includes("_appendix") ? -12 : 0);
    return { most: has(page.entries.map((entry) => entry.words).join(" ") + subject), rank, name,
      entries: page.entries.filter((_, place) => most > 0 && shares[place] === most) };
  });
  const best = Math.max(...pages.map((page) => page.most));
  return best === 0 ? [] :
    pages.filter((page) => page.most === best).sort((one, other) => other.rank - one.rank);
}

function search() {
  const all = flat(field.value).trim().split(" ").filter(Boolean);
  const words = all.filter((word) => !IDLE.has(word));
  const stems = (words.length > 0 ? words : all).map(stem);
  const hits = stems.length === 0 ? [] : ranked(stems).flatMap((page) => page.entries);
  list.replaceChildren(...hits.slice(0, MOST).map(({ target, title, text }) => {
    const item = document.createElement("li");
    const link = document.createElement("a");
    const small = document.createElement("small");
    link.href = target;
    link.textContent = title;
    small.textContent = text;
    item.append(link, small);
    return item;
  }));
  count.textContent = stems.length === 0 ? "" :
    `${hits.length} ${hits.length === 1 ? "place" : "places"}` + (hits.length > MOST ? `, the first ${MOST}:` : "");
}

field.value = new URLSearchParams(location.search).get("q") || "";
field.addEventListener("input", search);
search();
"""

FORM = (
    f'<form action="{CONTENTS}" role="search"><label>Search the book: '
    '<input type="search" name="q" autocomplete="off"></label></form>'
)


def book(
    title: str, about: str, chapters: Mapping[str, Sequence[Page]], other_names: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Return the files of a book in HTML that has all the pages, as a map from file name to text.

    Parameters
    ----------
    title, about : str
        The title of the book, and a paragraph for the page of contents.
    chapters : mapping of str to sequence of Page
        A map from the title of a chapter to its pages, in reading order. An empty title is not printed.
    other_names : mapping of str to str, optional
        A map from the name of a page to other names of its subject, separated by commas, under which the search finds
        the page.

    Returns
    -------
    dict
        The contents (:data:`CONTENTS`), the script that searches (:data:`SEARCH`), and ``NAME.html`` for each page.
        They expect the font file of :mod:`symrot.proof.pages.math_font` beside them.

    Examples
    --------
    >>> sorted(book("Mechanics", "All of it.", {"First": [Page("spin", "Spin")]}))
    ['index.html', 'search.js', 'spin.html']
    """
    pages = [page for members in chapters.values() for page in members]
    texts = {CONTENTS: _contents(title, about, chapters), SEARCH: search_script(pages, other_names or {})}
    for place, page in enumerate(pages):
        before, after = pages[place - 1] if place else None, pages[place + 1] if place + 1 < len(pages) else None
        turning = _turning(before, after)
        bottom = "\n".join([*_mentions(page, pages), turning, FORM])
        texts[f"{page.name}.html"] = html_document(page, turning, bottom, STYLE, FILE)
    return texts


def _contents(title: str, about: str, chapters: Mapping[str, Sequence[Page]]) -> str:
    form = FORM.replace("</form>", '</form>\n<p id="count" aria-live="polite"></p>\n<ol id="results"></ol>')
    parts = [f"<h1>{prose(title)}</h1>", f"<p>{prose(about)}</p>", form]
    number = 1
    for chapter, pages in chapters.items():
        links = (f'<li><a href="{page.name}.html">{prose(page.title)}</a>, {page.extent}</li>' for page in pages)
        parts += [f"<h2>{prose(chapter)}</h2>"] if chapter else []
        parts += [f'<ol start="{number}">', *links, "</ol>"]
        number += len(pages)
    return document(title, [*parts, f'<script src="{SEARCH}"></script>'], face(FILE) + STYLE)


def _turning(before: Page | None, after: Page | None) -> str:
    """Return a line of HTML with links to the page ``before``, the table of contents and the page ``after``."""
    # no page before the first, none after the last
    back = f'<a rel="prev" href="{before.name}.html">← {prose(before.title)}</a>' if before else "<span></span>"
    on = f'<a rel="next" href="{after.name}.html">{prose(after.title)} →</a>' if after else "<span></span>"
    return f'<nav class="book">{back}<a href="{CONTENTS}">Contents</a>{on}</nav>'


def _mentions(page: Page, pages: Sequence[Page]) -> Iterator[str]:
    """Yield one paragraph in HTML, "Pages that refer to this one: ..", if other pages link to ``page``."""
    link = f"]({page.name}.md)"
    others = [other for other in pages if other is not page and any(link in text for _, _, text in _words(other))]
    if others:
        links = ", ".join(f'<a href="{other.name}.html">{prose(other.title)}</a>' for other in others)
        yield f"<p>Pages that refer to this one: {links}.</p>"


def _words(page: Page) -> Iterator[tuple[str, str, str]]:
    """Yield (anchor, title, text) for each text on a page that the book's search finds.

    An anchor is such as ``"#step-3"``; if it is empty, the link leads to the top of the page. Titles and texts are
    Markdown.
    """
    yield "", page.title, page.about
    for opening in page.opening:
        if isinstance(opening, Figure):
            yield "", f"{page.title}, figure", f"{opening.title}. {opening.caption}"
        else:
            yield "", page.title, opening.text
    number, sections = page.first - 1, 0
    heading = page.title
    for item in page.items:
        if isinstance(item, Section):
            sections += 1
            heading = f"{page.title}: {item.title}"
            yield f"#section-{sections}", heading, ""
        elif isinstance(item, Step):
            number += 1
            yield f"#step-{number}", f"{heading}, step {number}", f"{item.claim} Why: {item.reason}."
        elif isinstance(item, Table):
            yield f"#step-{number + 1}" if item.steps else "", f"{heading}, table", item.text
            number += len(item.steps)
        elif isinstance(item, Figure):
            yield "", f"{heading}, figure", f"{item.title}. {item.caption}"
        elif isinstance(item, Passage):
            yield f"#section-{sections}" if sections else "", heading, item.text
    for closing in page.closing:
        if isinstance(closing, Section):
            heading = f"{page.title}: {closing.title}"
        else:
            yield "", heading, closing.text


def _plain(text: str) -> str:
    r"""Return the text of Markdown without markup, for the search: ``**Spin** $\omega_3$`` -> "Spin ω3"."""
    return unescape(re.sub(r"<[^>]*>", "", prose(text)))


def search_script(pages: Sequence[Page], other_names: Mapping[str, str]) -> str:
    """Return the script that searches pages in a browser; ``other_names`` are explained at :func:`book`."""
    entries = [
        [f"{page.name}.html{place}", _plain(title), _plain(text)]
        for page in pages
        for place, title, text in (*_words(page), *_also_called(page, other_names))
    ]
    lines = ",\n".join(json.dumps(entry, ensure_ascii=False) for entry in entries)
    return f"const ENTRIES = [\n{lines}\n];\n\n{SCRIPT}"


def _also_called(page: Page, other_names: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    if page.name in other_names:
        yield "", f"{page.title}, also called", other_names[page.name]
