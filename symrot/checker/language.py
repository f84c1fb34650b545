"""The notation for claims, as tables: the source of ``symrot check --help`` and of docs/checkers.md."""

import textwrap
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

__all__ = ["functions", "help_text", "markdown_table", "tables"]

INTRODUCTION = """\
Three notations are read: SymPy syntax, LaTeX (text with a backslash, a brace or a dollar sign), and plain text as
people type it. SymPy syntax, with ** and ==, has one meaning and keeps it. A text with two readings gets the
verdict on the usual one, and a note on the other one if its verdict differs."""

BUDGET = """\
Budget per claim: 20 000 characters, 1 000 000 products of terms and 2 000 000 operations; a claim beyond it is refused,
or undecided for this reason. The budget is counted, so that all machines give the same verdict. As a last resort, a
claim for which SymPy needs more than 60 s of processor time is undecided. docs/checkers.md has examples."""

WIDTH = 100


@cache
def _source() -> Mapping[str, Any]:
    return tomllib.loads(Path(__file__).with_name("language.toml").read_text("utf-8"))


def functions() -> tuple[str, ...]:
    """Return the names of the built-in functions of claims."""
    return tuple(_source()["functions"])


def tables() -> dict[str, list[list[str]]]:
    """Return the tables that describe the notation, by title. The first row of each is its head; cells are Markdown."""
    return {table["title"]: table["rows"] for table in _source().values() if isinstance(table, dict)}


def markdown_table(rows: Sequence[Sequence[str]]) -> str:
    """Return a table in Markdown, with the first row as its head.

    Examples
    --------
    >>> print(markdown_table([("a", "b"), ("1", "2")]))
    | a | b |
    | --- | --- |
    | 1 | 2 |
    """
    head, *rest = rows
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rest))


def help_text() -> str:
    """Return the description of the notation as plain text, for the command line."""
    parts = [textwrap.fill(INTRODUCTION, WIDTH)]
    for title, rows in tables().items():
        parts.append("\n".join([f"{title}:", *_plain_rows(rows[1:])]))
    parts.append(textwrap.fill(f"Built-in functions: {', '.join(functions())}.", WIDTH))
    return "\n\n".join([*parts, textwrap.fill(BUDGET, WIDTH)])


def _plain_rows(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    for first, *rest in rows:
        row = f"{first}: {' | '.join(rest)}".replace("\\|", "|").replace("`", "")
        yield textwrap.fill(row, WIDTH, initial_indent="  ", subsequent_indent="      ")
