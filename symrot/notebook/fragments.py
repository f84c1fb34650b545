"""Pieces of HTML and Markdown for notebooks: tables, formulas, drawings."""

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from symrot.proof.notation.printer import formula

__all__ = ["Markup", "disclosure", "drawing", "equation", "heading", "table"]

CELL = "padding:0.15em 0.8em 0.15em 0;text-align:left;vertical-align:top"


def heading(title: str, remark: str = "") -> str:
    """Return a title in bold, with a remark after it, as HTML."""
    after = f" <span style='opacity:0.7'>{escape(remark)}</span>" if remark else ""
    return f"<p style='margin:0.4em 0'><strong>{escape(title)}</strong>{after}</p>"


def table(rows: Iterable[Sequence[str]], head: Sequence[str] = ()) -> str:
    """Return an HTML table with the given rows below the titles ``head``.

    Text in cells is escaped, except text of the class :class:`Markup`.
    """
    lines = [_row(head, "th")] if head else []
    lines += [_row(row, "td") for row in rows]
    return f"<table style='border-collapse:collapse;margin:0.2em 0'>{''.join(lines)}</table>"


class Markup(str):
    """Text that is HTML already, so that :func:`table` must not escape it."""


def _row(cells: Sequence[str], kind: str) -> str:
    texts = (cell if isinstance(cell, Markup) else escape(cell) for cell in cells)
    return "<tr>" + "".join(f"<{kind} style='{CELL}'>{text}</{kind}>" for text in texts) + "</tr>"


def disclosure(title: str, text: str) -> str:
    """Return HTML that shows a title; a click on the title opens a text of several lines."""
    return f"<details><summary>{escape(title)}</summary><pre>{escape(text)}</pre></details>"


def equation(left: str, right: Any) -> str:
    """Return the formula ``left = right`` for Markdown; ``left`` is LaTeX, ``right`` a SymPy expression."""
    return f"$$\n{left} = {formula(right)}\n$$"


def drawing(title: str, svg: str) -> str:
    """Return Markdown for a picture that contains the whole SVG drawing, so that no file is needed."""
    encoded = b64encode(svg.encode("utf-8")).decode("ascii")
    return f"![{title}](data:image/svg+xml;base64,{encoded})"
