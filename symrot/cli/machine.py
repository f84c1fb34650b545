"""The commands that examine this machine: bench, doctor."""

import sys
from argparse import ArgumentParser, Namespace

from symrot.cli.output import FAILED, OK, Command, json_option, progress, say, say_json
from symrot.report.layout import emphasis

__all__ = ["COMMANDS"]


def _bench(options: Namespace) -> int:
    from symrot.bench import command

    outcome = command.run(options, progress)
    progress("")
    if options.json:
        say_json(outcome.data)
    else:
        title, *rest = outcome.lines
        say([emphasis(title, sys.stdout), *rest])
    return OK if outcome.good else FAILED


def _doctor(options: Namespace) -> int:
    from symrot.workshop import doctor as health

    if options.clear_cache:
        removed = health.clear_cache()
        say_json({"removed": removed}) if options.json else say([f"removed {removed} files from the cache"])
        return OK
    report = health.facts()
    if options.json:
        say_json(report)
    else:
        say(health.lines(report))
    return FAILED if report["problems"] else OK


def _bench_arguments(parser: ArgumentParser) -> None:
    from symrot.bench import command

    command.arguments(parser)


def _doctor_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--clear-cache", action="store_true", help="remove all kernels from the cache")
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "bench": ("measure time against error on a scene of your choice", _bench, _bench_arguments),
    "doctor": ("check compiler, cache and installed versions", _doctor, _doctor_arguments),
}
"""Names of the commands -> (help text, function that runs the command, function that declares its arguments)."""
