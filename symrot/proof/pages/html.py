"""Printer of derivations as HTML: one file with native MathML, without script or network.

The same derivation always gives the same bytes.
"""

import re
from collections.abc import Iterable, Iterator
from html import escape

from symrot.proof.notation.mathml import mathml
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages.math_font import face
from symrot.proof.pages.parts import equation, footer, passage_equations, remarks, repetitions, table_rows, units

__all__ = ["display", "document", "html_document", "prose"]

MANY_SECTIONS = 3
LONGEST_INLINE = 120  # letters of LaTeX; a longer formula in a sentence is scrolled by itself

STYLE = """
:root { color-scheme: light dark; }
body { max-width: 46rem; margin: 2rem auto; padding: 0 1rem; font: 1.05rem/1.55 Georgia, "Times New Roman", serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin-bottom: 0.4rem; }
h2 { font-size: 1.35rem; margin-top: 2.4rem; border-bottom: 1px solid #8886; padding-bottom: 0.2rem; }
nav { font-size: 0.95rem; }
math { font-size: 1.05em; font-family: "STIX Two Math", "Latin Modern Math", "STIX Math", "Cambria Math",
  "TeX Gyre Termes Math", "DejaVu Math TeX Gyre", math; }
mover > mo { padding-bottom: 0.12em; }
msubsup > mo:first-child ~ :last-child { padding-left: 0.6em; } /* an upper limit beside the slanted integral sign */
mfrac { padding: 0 0.08em; } /* not against a bracket */
mtable > mtr > mtd { padding: 0.33em 0.4em; }
math:not([display]) { padding-right: 0.07em; } /* beside a slanted last letter */
@supports (-moz-appearance: none) { /* Firefox sets these spaces by itself, and a row as high as a line */
  msubsup > mo:first-child ~ :last-child, math:not([display]) { padding: 0; }
  mfrac { padding: 0; }
  mtable > mtr > mtd { padding-top: 0.12em; padding-bottom: 0.12em; }
}
.display { overflow-x: auto; overflow-y: hidden; margin: 0.8rem 0; padding: 0.3rem 0; }
.display math { margin: 0 auto; }
.lines > mtr > mtd { text-align: left; padding-left: 0; padding-top: 0.25em; padding-bottom: 0.25em; }
.step { margin: 1.6rem 0; }
.number { font-weight: bold; margin-right: 0.4em; }
.remarks { color: #555; color: color-mix(in srgb, currentColor 75%, transparent); font-size: 0.97rem; }
.source { font-size: 0.97rem; }
figure { margin: 1.6rem 0; text-align: center; break-inside: avoid; }
figure svg { max-width: 100%; height: auto; }
figcaption { font-size: 0.95rem; text-align: left; margin-top: 0.4rem; }
.table { overflow-x: auto; font-size: 0.9rem; width: min(100vw - 2rem, 60rem); position: relative; left: 50%;
  transform: translateX(-50%); }
table { border-collapse: collapse; margin: 0 auto; }
td:first-child { white-space: nowrap; }
th, td { text-align: left; padding: 0.3rem 0.6rem; border-bottom: 1px solid #8886; }
.whole { white-space: nowrap; }
.wide { display: inline-block; max-width: 100%; white-space: nowrap; overflow-x: auto; overflow-y: hidden;
  vertical-align: middle; }
td .wide { max-width: none; overflow: visible; }
code { font-size: 0.9em; overflow-wrap: anywhere; }
footer { margin-top: 3rem; border-top: 1px solid #8886; padding-top: 0.6rem; font-size: 0.9rem; }
a { color: inherit; }
@media print {
  h2 { break-after: avoid; }
  tr { break-inside: avoid; }
  tr:first-child { break-after: avoid; }
  .display { overflow: visible; }
  .step { break-inside: avoid; }
  .wide { overflow: visible; font-size: 0.75em; }
  td .wide { font-size: inherit; }
  .table { overflow: visible; width: auto; left: 0; transform: none; font-size: 0.7rem; }
}
"""


def html_document(page: Page, top: str = "", bottom: str = "", style: str = "", font: str = "") -> str:
    """Return an HTML document with a page, the HTML text ``top`` above the page, and ``bottom`` below it.

    ``style`` is CSS after the usual rules; ``font`` is the address of the font's file, empty to embed the font.
    """
    parts = [*filter(None, [top]), f"<h1>{prose(page.title)}</h1>"]
    for opening in page.opening:
        parts += [_figure(opening)] if isinstance(opening, Figure) else _passage(opening)
    if page.about:
        parts.append(f"<p>{prose(page.about)}</p>")
    if page.source:
        parts.append(f'<p class="source"><em>Source:</em> {prose(page.source)}.</p>')
    parts += _contents(page)
    number, section, repeats = page.first - 1, 0, repetitions(page)
    for item in page.items:
        if isinstance(item, Section):
            section += 1
            parts.append(f'<h2 id="section-{section}">{prose(item.title)}</h2>')
        elif isinstance(item, Step):
            number += 1
            parts.append(
                f'<section class="step" id="step-{number}">\n'
                f'<p><span class="number">{number}.</span>{prose(item.claim)}</p>\n'
                f"{display(equation(item))}\n{_remarks(item, number in repeats)}</section>"
            )
        elif isinstance(item, Figure):
            parts.append(_figure(item))
        elif isinstance(item, Table):
            parts += [f"<p>{prose(item.text)}</p>", _table(item, number)]
            number += len(item.steps)
        else:
            parts += _passage(item)
    used = units(page)
    if used:
        parts.append(f"<p><strong>Units</strong> of the symbols in the proofs: {_raised(prose(used))}.</p>")
    for closing in page.closing:
        parts += [f"<h2>{prose(closing.title)}</h2>"] if isinstance(closing, Section) else _passage(closing)
    parts.append(f"<footer>{prose(footer(page))}</footer>")
    return document(page.title, [*parts, *filter(None, [bottom])], face(font) + style)


def _remarks(step: Step, is_repetition: bool) -> str:
    text = prose(" ".join(remarks(step, is_repetition)))
    return f'<p class="remarks">{text}</p>\n' if text else ""


def _figure(figure: Figure) -> str:
    return f"<figure>{figure.svg()}<figcaption>{prose(figure.caption)}</figcaption></figure>"


def _table(table: Table, number: int) -> str:
    """Return a table of a page in HTML; ``number`` is the number of the last step before the table."""
    head, *rows = table_rows(table, number)
    lines = [f"<tr>{''.join(f'<th>{prose(cell)}</th>' for cell in head)}</tr>"]
    for cells, (_, steps) in zip(rows, table.rows, strict=True):
        # a link can lead to the first step of a row
        anchor = f' id="step-{number + 1}"' if steps else ""
        number += len(steps)
        lines.append(f"<tr{anchor}>{''.join(f'<td>{prose(cell)}</td>' for cell in cells)}</tr>")
    return '<div class="table"><table>\n' + "\n".join(lines) + "\n</table></div>"


def _passage(passage: Passage) -> list[str]:
    return [f"<p>{prose(passage.text)}</p>", *map(display, passage_equations(passage))]


def document(title: str, parts: Iterable[str], style: str = "") -> str:
    """Return a self-contained HTML document, whose body has the elements ``parts``.

    ``style`` is CSS that is added after the usual rules.
    """
    title = escape(re.sub(r"[$*`]", "", title))
    head = (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{STYLE}{style}</style>\n</head>\n<body>"
    )
    return "\n".join([head, *parts, "</body>", "</html>"]) + "\n"


def display(latex: str) -> str:
    """Return a LaTeX formula as HTML on lines of its own, in MathML."""
    return f'<div class="display">{mathml(latex, display=True)}</div>'


def _raised(prose: str) -> str:
    """Return text with raised exponents in HTML: ``kg m^2`` -> ``kg m<sup>2</sup>``."""
    return re.sub(r"\^(\d)", r"<sup>\1</sup>", prose)


def _contents(page: Page) -> Iterator[str]:
    titles = [item.title for item in page.items if isinstance(item, Section)]
    if len(titles) > MANY_SECTIONS:
        links = (f'<a href="#section-{n}">{prose(title)}</a>' for n, title in enumerate(titles, 1))
        yield f"<nav>{' · '.join(links)}</nav>"


PIECES = re.compile(r"\$`([^`]+)`\$|\$([^$]+)\$|`([^`]+)`|\[([^\]]+)\]\(([^)]+)\)|\*\*([^*]+)\*\*|\*([^*]+)\*")


def prose(text: str) -> str:
    """Return Markdown prose as HTML: formulas between ``$``, code, links to other derivations, and emphasis."""
    markup, place = "", 0
    for match in PIECES.finditer(text):
        markup += escape(text[place : match.start()], quote=False)
        quoted, plain, code, label, target, strong, emphasis = match.groups()
        if quoted or plain:
            after = re.match(r"[.,;:)']*", text[match.end() :])
            stop = after[0] if after else ""
            formula = mathml(quoted or plain)
            if len(quoted or plain) > LONGEST_INLINE:
                markup += f'<span class="wide">{formula}{escape(stop)}</span>'
            else:
                markup += f'<span class="whole">{formula}{escape(stop)}</span>' if stop else formula
            place = match.end() + len(stop)
            continue
        elif code:
            markup += f"<code>{escape(code, quote=False)}</code>"
        elif label:
            markup += f'<a href="{escape(target.removesuffix(".md"))}.html">{prose(label)}</a>'
        elif strong:
            markup += f"<strong>{prose(strong)}</strong>"
        else:
            markup += f"<em>{prose(emphasis)}</em>"
        place = match.end()
    return markup + escape(text[place:], quote=False)
