"""Verdicts on claims, and names of formulas, as tables of HTML."""

from html import escape

from symrot.checker.verdict import Identification, Verdict
from symrot.notebook.fragments import Markup, table

__all__ = ["identification", "verdict"]

COLOURS = {"true": "#1a7f37", "recognised": "#1a7f37", "false": "#cf222e", "doubtful": "#cf222e"}
OTHER_COLOUR = "#9a6700"


def verdict(one: Verdict) -> str:
    """Return a verdict and all its details as an HTML table; in each suggested repair the changed text is marked."""
    repairs = iter(one.repairs)
    rows: list[tuple[str, str]] = []
    for name, text in one.facts():
        if name in ("instead", "true instead"):
            repair = next(repairs)
            rows.append((name, Markup(f"<code>{repair.html}</code> {escape(repair.note)}")))
        elif name in ("claim", "read as"):
            rows.append((name, Markup(f"<code>{escape(text)}</code>")))
        else:
            rows.append((name, text))
    colour = COLOURS.get(one.verdict, OTHER_COLOUR)
    return f"<p style='margin:0.4em 0;color:{colour}'><strong>{one.verdict}</strong></p>" + table(rows)


def identification(one: Identification) -> str:
    """Return an HTML table with the name of a formula that symrot recognised, and the derivation that contains it."""
    rows = [("formula", str(one)), ("derived in", one.source)]
    return table(rows)
