"""The commands that judge formulas: check, identify."""

import sys
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from pathlib import Path

import symrot
from symrot.cli.output import FAILED, OK, USAGE_ERROR, Command, json_option, progress, say, say_json
from symrot.errors import InputError
from symrot.report.layout import one_line

__all__ = ["COMMANDS"]


def _check(options: Namespace) -> int:
    from symrot.report import verdicts

    if (options.claim is None) == (options.textbook is None):
        raise InputError("check: expected a CLAIM, a FILE or --textbook NAME (see `symrot check --help`)")
    if options.all and options.textbook != "all":
        raise InputError(
            "--all: expected --textbook all as well, since --all writes pages that list the errors of all textbooks"
        )
    if options.textbook:
        return _check_textbook(options)
    stated = {key: getattr(options, key) for key in ("where", "body", "frame", "sequence")}
    results = verdicts.check(options.claim, options.hypotheses, options.unit, not options.no_repair, progress, stated)
    progress("")
    if options.json:
        say_json([verdict.to_json() for verdict in results])
    else:
        say(verdicts.lines(results, options.claim))
    refused = [verdict for verdict in results if verdict.verdict == "refused"]
    sys.stderr.write("".join(f"symrot: {one_line(verdict.reason)}\n" for verdict in refused))
    accepted = [bool(verdict) or (verdict.verdict == "definition" and not options.strict) for verdict in results]
    return USAGE_ERROR if refused else OK if all(accepted) else FAILED


def _check_textbook(options: Namespace) -> int:
    from symrot.files import writing as files
    from symrot.report import errata
    from symrot.textbook import DOCUMENTS

    names = DOCUMENTS if options.textbook == "all" else (options.textbook,)
    pages = {Path(options.output) / "errata.md": errata.page, Path(options.output) / "errata.html": errata.html}
    for target in pages if options.all else ():
        files.check_target(target, (".md", ".html"), "--output")
    documents = errata.survey(names, not options.no_repair, progress)
    progress("")
    if options.all:
        for target, page in pages.items():
            content = page(documents).encode("utf-8")
            files.write(target, lambda stream, content=content: stream.write(content))  # type: ignore[misc]
            say([f"{target}: written"])
    elif options.json:
        say_json(errata.facts(documents))
    else:
        say(errata.lines(documents))
    return OK if options.all or all(item.outcome == "holds" for _, items in documents for item in items) else FAILED


def _identify(options: Namespace) -> int:
    identifications = symrot.identify(
        options.formula, body=options.body, frame=options.frame, sequence=options.sequence
    )
    if options.json:
        say_json([identification.to_json() for identification in identifications])
    else:
        say(f"{identification}\n  {identification.source}" for identification in identifications)
        if not identifications:
            say(["no formula that symrot derives is equal to it"])
    return OK if identifications else FAILED


def _check_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "claim",
        metavar="CLAIM",
        nargs="?",
        help="'left = right' as typed text, SymPy syntax or LaTeX, or a FILE.toml with a table [[claim]] per claim",
    )
    from symrot.checker.language import help_text

    parser.formatter_class = RawDescriptionHelpFormatter
    parser.epilog = help_text()
    parser.add_argument("--textbook", metavar="NAME", help="check the formulas of a published text, listed in symrot: "
                        "chen, sahakian, brown or beer-johnston (named by their authors), or all")  # fmt: skip
    parser.add_argument(
        "--all", action="store_true", help="with --textbook all: write pages that list the errors in the texts"
    )
    parser.add_argument(
        "-o", "--output", metavar="DIR", default="generated", help="folder that --all writes to (default: ./generated)"
    )
    parser.add_argument("--given", dest="hypotheses", metavar="HYPOTHESIS", action="append", default=[],
                        help="check the claim (given as text) only where 'x > 0', 'x != 0' or 'a == b' holds; may be "
                        "repeated")  # fmt: skip
    parser.add_argument("--unit", metavar="NAME=UNIT", action="append", default=[],
                        help="unit of a symbol in a claim given as text: 'F=kg m/s^2'; may be repeated")  # fmt: skip
    parser.add_argument("--where", metavar="'NAME = WORDS'", action="append", default=[],
                        help="meaning of a name in a claim given as text: 'I = moment of inertia about the centre', "
                        "'p = spin'; may be repeated")  # fmt: skip
    _context_options(parser)
    parser.add_argument("--strict", action="store_true",
                        help="exit with code 1 for a claim that only defines a name by a formula")  # fmt: skip
    parser.add_argument("--no-repair", action="store_true", help="do not suggest corrections of a false claim")
    json_option(parser)


def _context_options(parser: ArgumentParser) -> None:
    parser.add_argument(
        "--body",
        metavar="WORDS",
        default="",
        help="the body that the claim is about, such as 'solid cylinder of radius r and height h'",
    )
    parser.add_argument(
        "--frame",
        metavar="FRAME",
        default="",
        help="frame in which the claim's angular velocities and rates have their components: body or space",
    )
    parser.add_argument("--sequence", metavar="SEQUENCE", default="",
                        help="Euler angles: ZXZ or 3-1-3 about moving axes, zyx about fixed axes")  # fmt: skip


def _identify_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("formula", metavar="FORMULA", help="a formula or matrix, as text or LaTeX")
    _context_options(parser)
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "check": ("decide whether formulas hold, and suggest corrections", _check, _check_arguments),
    "identify": ("recognise a formula, whatever the names of its symbols", _identify, _identify_arguments),
}
"""Names of the commands -> (help text, function that runs the command, function that declares its arguments)."""
