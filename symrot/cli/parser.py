"""The parser of arguments: the width of its help, and errors as one sentence."""

import os
import sys
from argparse import ArgumentParser, HelpFormatter
from typing import Any, NoReturn

from symrot.errors import InputError

__all__ = ["Parser"]


class _Formatter(HelpFormatter):
    """A help formatter that measures the terminal without the module shutil, because that module is slow to import."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=_columns() - 2)


def _columns() -> int:
    """Return the width of the terminal in characters, as :func:`shutil.get_terminal_size` does."""
    try:
        columns = int(os.environ.get("COLUMNS", "0"))
    except ValueError:
        columns = 0
    try:
        return columns if columns > 0 else os.get_terminal_size(sys.__stdout__.fileno()).columns or 80  # type: ignore[union-attr]
    except (AttributeError, ValueError, OSError):
        return 80


class Parser(ArgumentParser):
    """An argument parser that raises InputError with one sentence, instead of printing its usage and exiting."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, formatter_class=_Formatter)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see `{self.prog} --help`)")
