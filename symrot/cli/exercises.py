"""The commands of exercises: exercise, grade."""

import re
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

import symrot
from symrot.cli.output import FAILED, OK, Command, json_option, say, say_json
from symrot.errors import InputError

__all__ = ["COMMANDS"]

FORMS = ("markdown", "latex", "html", "moodle", "json")
FORM_OF = {".tex": "latex", ".html": "html", ".htm": "html", ".xml": "moodle", ".json": "json"}
"""End of a file's name -> the format that it has without ``--format``; all other files are Markdown."""
EMBEDDED = re.compile(r"!\[([^\]]*)\]\(data:[^)]*\)")
"""Regular expression of a drawing that Markdown contains as text; in a terminal its title replaces it."""


def _exercise(options: Namespace) -> int:
    if options.list:
        if options.topic or options.output:
            raise InputError("exercise: expected --list alone, without a TOPIC or -o (see `symrot exercise --help`)")
        from symrot.exercises.templates import TOPICS

        for topic, names in TOPICS.items():
            say([topic, *(f"  {name}" for name in names)])
        return OK
    form = options.format or FORM_OF.get(options.output.suffix.lower() if options.output else "", "markdown")
    text = symrot.exercise(options.topic or "", seed=options.seed, count=options.count).print(
        form, not options.no_solutions, statements=not options.only_solutions, title=options.title
    )
    if options.output is None:
        seen = EMBEDDED.sub(r"*Figure:* \1 (drawn in a file: `-o sheet.html`)", text) if sys.stdout.isatty() else text
        sys.stdout.write(seen)
        return OK
    from symrot.files import writing

    writing.write(options.output, lambda stream: stream.write(text.encode("utf-8")))
    say([f"{options.output}: written"])
    return OK


def _grade(options: Namespace) -> int:
    from symrot.exercises.grading.grade import grade_files

    if options.name:
        if options.seed is None:
            raise InputError("grade: expected --seed N with --name TEMPLATE, since the seed decides the numbers")
        grades = symrot.grade(symrot.exercise(options.name, seed=options.seed)[0], options.answers)
    elif len(options.answers) == 2:
        grades = grade_files(*options.answers)
    else:
        raise InputError(
            "grade: expected EXERCISES.json and a file of ANSWERS, or --name TEMPLATE --seed N with answers "
            "(see `symrot grade --help`)"
        )
    if options.json:
        say_json(grades.to_json())
    else:
        say(str(grades).splitlines())
    return OK if grades.credit == len(grades.marks) else FAILED


def _whole(text: str) -> int:
    return int(text)


_whole.__name__ = "whole number"


def _exercise_arguments(parser: ArgumentParser) -> None:
    parser.add_argument(
        "topic",
        metavar="TOPIC",
        nargs="*",
        help="topics, or templates of exercises, in the order of the sheet; each supplies as many exercises as any "
        "other, or one less (default: all topics)",
    )
    parser.add_argument(
        "--seed", type=_whole, default=0, metavar="N", help="seed of the numbers in the exercises (default: 0)"
    )
    parser.add_argument("--count", type=_whole, default=1, metavar="K", help="how many exercises (default: 1)")
    parser.add_argument(
        "--format", choices=FORMS, help="format of the sheet (default: by the suffix of FILE, otherwise markdown)"
    )
    parser.add_argument(
        "-o", type=Path, metavar="FILE", dest="output", help="write to a file (default: standard output)"
    )
    parser.add_argument("--title", default="", help="title of the sheet (Markdown, LaTeX and HTML; default: Exercises)")
    part = parser.add_mutually_exclusive_group()
    part.add_argument(
        "--no-solutions", action="store_true", help="leave out hints and solutions (Markdown, LaTeX and HTML)"
    )
    part.add_argument(
        "--only-solutions", action="store_true", help="print the solutions alone, with their numbers on the sheet"
    )
    parser.add_argument("--list", action="store_true", help="list the topics and their templates")


def _grade_arguments(parser: ArgumentParser) -> None:
    files = "EXERCISES.json and a file with lines '1a: answer'; or, with --name, the answers"
    parser.add_argument("answers", metavar="ANSWERS", nargs="+", help=files)
    parser.add_argument(
        "--name",
        metavar="TEMPLATE",
        default="",
        help="grade answers to one exercise, given by the name of its template",
    )
    parser.add_argument("--seed", type=_whole, metavar="N", help="the seed of that exercise")
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "exercise": ("print exercises with numbers, hints and proven solutions", _exercise, _exercise_arguments),
    "grade": ("grade answers to exercises: numbers with units, and formulas", _grade, _grade_arguments),
}
"""Names of the commands -> (help text, function that runs the command, function that declares its arguments)."""
