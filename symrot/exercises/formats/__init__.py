"""Sheets of exercises as Markdown, LaTeX, HTML, Moodle XML and JSON."""

import json
from collections.abc import Callable, Sequence

from symrot.exercises.exercise import Exercise, sheet_data
from symrot.exercises.formats.html import html_sheet
from symrot.exercises.formats.latex import latex_sheet
from symrot.exercises.formats.markdown import markdown_sheet
from symrot.exercises.formats.moodle import moodle_quiz

__all__ = ["FORMATS", "HANDOUTS", "TITLE"]

TITLE = "Exercises"
"""The title of a sheet that is given no other title."""


def _json(exercises: Sequence[Exercise]) -> str:
    return json.dumps(sheet_data(exercises), indent=1, ensure_ascii=False) + "\n"


FORMATS: dict[str, Callable[[Sequence[Exercise]], str]] = {
    "moodle": moodle_quiz,
    "json": _json,
}
"""Format that another program reads -> the function that prints exercises in this format."""

HANDOUTS: dict[str, Callable[[Sequence[Exercise], str, bool, bool], str]] = {
    "markdown": markdown_sheet,
    "latex": latex_sheet,
    "html": html_sheet,
}
"""Format for readers -> the function that prints exercises in this format.

Its arguments are the exercises, the title, whether the statements and whether the solutions are printed.
"""
