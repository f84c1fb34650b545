"""What commands print with, and their exit codes; stdout is data, stderr is progress."""

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterable
from typing import Any

__all__ = ["BAD", "FAILED", "GOOD", "INTERRUPTED", "UNREAD", "Command", "json_option", "progress", "say", "say_json"]

GOOD, FAILED, BAD, INTERRUPTED, UNREAD = 0, 1, 2, 130, 141
Command = tuple[str, Callable[[Namespace], int], Callable[[ArgumentParser], None]]
"""What a command does, the function that does it, the function that declares its arguments."""


def say(lines: Iterable[str]) -> None:
    """Print lines of text."""
    sys.stdout.write("".join(f"{line}\n" for line in lines))


def say_json(found: Any) -> None:
    """Print JSON."""
    import json

    sys.stdout.write(json.dumps(found, indent=2, ensure_ascii=False) + "\n")


def progress(text: str) -> None:
    """Show what takes its time, on one line of a terminal; an empty text clears it."""
    if sys.stderr.isatty():
        try:
            room = os.get_terminal_size(sys.stderr.fileno()).columns - 1 or len(text)
        except (OSError, ValueError, AttributeError):
            room = len(text)
        sys.stderr.write(f"\r\x1b[K{text[:room]}")  # a longer line would go on below, where nothing clears it
        sys.stderr.flush()


def json_option(parser: ArgumentParser) -> None:
    """Declare ``--json``."""
    parser.add_argument("--json", action="store_true", help="print JSON")
