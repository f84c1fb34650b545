"""Output of commands: results on stdout, progress on stderr, and the exit codes."""

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterable
from typing import Any

__all__ = [
    "FAILED",
    "INTERRUPTED",
    "OK",
    "SIGPIPE",
    "USAGE_ERROR",
    "Command",
    "json_option",
    "progress",
    "say",
    "say_json",
]

OK, FAILED, USAGE_ERROR, INTERRUPTED, SIGPIPE = 0, 1, 2, 130, 141
Command = tuple[str, Callable[[Namespace], int], Callable[[ArgumentParser], None]]
"""A command: its help text, the function that runs it, and the function that declares its arguments."""


def say(lines: Iterable[str]) -> None:
    """Print lines of text to standard output."""
    sys.stdout.write("".join(f"{line}\n" for line in lines))


def say_json(data: Any) -> None:
    """Print data as JSON to standard output."""
    import json

    sys.stdout.write(json.dumps(data, indent=2, ensure_ascii=False) + "\n")


def progress(text: str) -> None:
    """Show a progress message on one line of the terminal, over the previous message; an empty text clears the line.

    If stderr is not a terminal, nothing is written.
    """
    if sys.stderr.isatty():
        try:
            columns = os.get_terminal_size(sys.stderr.fileno()).columns
            width = columns - 1 if columns > 1 else len(text)  # a terminal may not know its width: 0 columns
        except (OSError, ValueError, AttributeError):
            width = len(text)
        sys.stderr.write(f"\r\x1b[K{text[:width]}")  # cut to one line: a wrapped line could not be cleared
        sys.stderr.flush()


def json_option(parser: ArgumentParser) -> None:
    """Declare the option ``--json`` of a command."""
    parser.add_argument("--json", action="store_true", help="print JSON")
