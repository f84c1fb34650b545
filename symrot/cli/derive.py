"""The command that prints derivations: derive."""

import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

from symrot.cli.output import FAILED, OK, Command, progress, say
from symrot.errors import InputError

__all__ = ["COMMANDS"]

PAGES: dict[str, Callable[[Any], str]] = {
    "markdown": lambda page: page.markdown(),
    "latex": lambda page: page.latex(),
    "html": lambda page: page.html(),
}
PAGE_FILES = {".html": "html", ".htm": "html", ".tex": "latex", ".md": "markdown", ".pdf": "latex"}
"""Suffix of a file -> the format of pages that an error message suggests.

The option -o takes a folder. For a file, as in ``-o page.tex``, the message says to write ``--format latex -o DIR``.
"""


def _derive(options: Namespace) -> int:
    from symrot import catalogue
    from symrot.workshop import derivation_pages

    if sum(map(bool, (options.name, options.all, options.check))) > 1:
        raise InputError("derive: expected at most one of NAMEs, --all and --check (see `symrot derive --help`)")
    if len(options.name) > 1 and (options.directory is None or options.step is not None):
        raise InputError("derive: several NAMEs need a folder for their pages, -o DIR, and cannot have --step N")
    if options.step is None and options.detail:
        raise InputError("derive: --detail needs --step N, the step to print (see `symrot derive --help`)")
    if options.step is not None and not options.name:
        raise InputError("derive: expected a NAME with --step N (see `symrot derive --help`)")
    if options.format != "markdown" and options.check:
        raise InputError("derive: --check compares Markdown pages only; leave out --format")
    directory = options.directory or Path("derivations")
    if options.step is None and (options.all or options.name) and directory.exists() and not directory.is_dir():
        raise InputError(f"derive: expected -o with a folder for the pages, got the file {str(directory)!r}")
    if options.step is not None and options.directory is not None:
        raise InputError("derive: --step N prints one step; leave out -o DIR")
    if form := PAGE_FILES.get(directory.suffix.lower()):
        raise InputError(
            f"derive: expected -o with a folder for the pages, got {str(directory)!r}; write --format {form} -o DIR"
        )
    if options.format != "markdown" and options.all:
        if options.directory is None:
            raise InputError(f"derive: expected a folder, -o DIR, to write all pages as {options.format} into it")
        written = derivation_pages.write_pages(options.directory, options.format, say=progress)
        progress("")
        say(str(path) for path in written)
        return OK
    if options.check:
        if not directory.is_dir():
            raise InputError(
                f"{str(directory)!r}: expected the folder that `symrot derive --all` writes, but it is missing"
            )
        different = derivation_pages.check(directory, progress)
        progress("")
        sys.stdout.write("".join(diff for _, diff in different))
        return FAILED if different else OK
    if options.all:
        written = derivation_pages.derive_all(directory, progress)
        progress("")
        say(str(path) for path in written)
    elif options.name and options.directory is not None and options.step is None:
        written = derivation_pages.write_handout(options.directory, options.format, options.name, progress)
        progress("")
        say(str(path) for path in written)
    elif options.name and options.step is not None:
        whole = catalogue.derivation(derivation_pages.derivation_of(options.name[0]))
        sys.stdout.write(PAGES[options.format](whole.part(options.step, options.detail)))
    elif options.name:
        sys.stdout.write(PAGES[options.format](derivation_pages.printed_page(options.name[0])))
    else:
        say(catalogue.names())
    return OK


def _derive_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", nargs="*", help="derivations (default: list all)")
    parser.add_argument("--all", action="store_true", help="write the pages of all derivations")
    parser.add_argument(
        "--check",
        action="store_true",
        help="compare the pages on disk with new ones; exit 1 with a diff if they differ",
    )
    parser.add_argument(
        "--format", choices=PAGES, default="markdown", help="format of a derivation (default: markdown)"
    )
    parser.add_argument("--step", type=int, metavar="N", help="print one step of a derivation")
    parser.add_argument(
        "--detail",
        action="store_true",
        help="with --step: add the proof with vectors, or else the expressions that lead from the left side of the "
        "step's equation to the right side, as many as fit on a screen",
    )
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory",
                        help="folder for the pages of --all or of the NAMEs, and the folder that --check reads "
                        "(default for --all and --check: ./derivations)")  # fmt: skip


COMMANDS: dict[str, Command] = {
    "derive": ("print derivations, proven step by step", _derive, _derive_arguments),
}
"""Name of the command -> (help text, function that runs it, function that declares its arguments)."""
