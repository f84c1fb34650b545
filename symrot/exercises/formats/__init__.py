"""Sheets of exercises as Markdown, LaTeX, HTML, Moodle XML and JSON."""

import json
from collections.abc import Callable, Sequence

from symrot.exercises.exercise import Exercise, sheet_data
from symrot.exercises.formats.html import html_sheet
from symrot.exercises.formats.latex import latex_sheet
from symrot.exercises.formats.markdown import markdown_sheet
from symrot.exercises.formats.moodle import moodle_quiz

__all__ = ["FORMATS", "WITHOUT_SOLUTIONS"]


def _json(exercises: Sequence[Exercise]) -> str:
    return json.dumps(sheet_data(exercises), indent=1, ensure_ascii=False) + "\n"


FORMATS: dict[str, Callable[[Sequence[Exercise]], str]] = {
    "markdown": markdown_sheet,
    "latex": latex_sheet,
    "html": html_sheet,
    "moodle": moodle_quiz,
    "json": _json,
}
"""Format -> the function that prints exercises in it."""

WITHOUT_SOLUTIONS: dict[str, Callable[[Sequence[Exercise], bool], str]] = {
    "markdown": markdown_sheet,
    "latex": latex_sheet,
}
"""Format -> the function that prints exercises in it, with solutions or without."""
