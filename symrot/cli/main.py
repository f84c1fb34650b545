"""The command line: parses arguments, calls the command, prints its result to stdout and its progress to stderr.

Texts come from :mod:`symrot.report`. The exit codes are 0 for success, 1 if a check failed, 2 for bad usage or input,
130 after an interrupt, and 141 if the program that read the output has ended.
"""

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TextIO

import symrot
from symrot.cli import certify, claims, derive, emit, exchange, exercises, machine, motions, sweeps
from symrot.cli.interrupt import is_interrupt
from symrot.cli.output import INTERRUPTED, SIGPIPE, USAGE_ERROR, Command, progress
from symrot.cli.parser import Parser
from symrot.errors import InputError, SymrotError, with_hint
from symrot.report.layout import one_line

__all__ = ["main"]

COMMANDS: dict[str, Command] = (
    motions.COMMANDS
    | sweeps.COMMANDS
    | exchange.COMMANDS
    | derive.COMMANDS
    | claims.COMMANDS
    | exercises.COMMANDS
    | emit.COMMANDS
    | certify.COMMANDS
    | machine.COMMANDS
)
"""Name of each command -> (help text, function that runs it, function that declares its arguments)."""


def _nowhere() -> TextIO:
    """Return a stream that discards its text, for a process that was started with stdout or stderr closed."""
    return Path(os.devnull).open("w", encoding="utf-8")


def _parser(only: str = "") -> Parser:
    """Return the parser of all commands, or, to save time, of the command named ``only``."""
    parser = Parser(
        prog="symrot",
        description="Rigid-body rotation: derived, specialised, compiled, propagated.",
        epilog="Try: symrot run tumbling_prism --plot prism.png",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"symrot {symrot.__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", dest="command", required=True, prog=parser.prog)
    for name, (about, function, declare) in COMMANDS.items():
        if only not in ("", name):
            continue
        description = f"{about[0].upper()}{about[1:]}."
        command = commands.add_parser(name, help=about, description=description, allow_abbrev=False)
        declare(command)
        command.set_defaults(function=function)
    return parser


def _check_command(arguments: Sequence[str]) -> None:
    """Raise InputError for an unknown command; the message lists all commands and may suggest a similar one."""
    if arguments and not arguments[0].startswith("-") and arguments[0] not in COMMANDS:
        message = f"expected a command, one of {', '.join(COMMANDS)}, got {arguments[0][:60]!r}"
        raise InputError(with_hint(message, arguments[0], COMMANDS))


def _check_unknown(command: str, unknown: Sequence[str]) -> None:
    """Raise InputError for the first of the words ``unknown``, which the command's parser did not recognise.

    The message may suggest a similar option. If ``unknown`` is empty, nothing happens.
    """
    if not unknown:
        return
    own = Parser()
    COMMANDS[command][2](own)
    options = [option for action in own._actions for option in action.option_strings]
    word = unknown[0].partition("=")[0]
    kind = "an option" if word.startswith("-") else "no further word"
    message = f"{command}: expected {kind} of `symrot {command} --help`, got {word[:60]!r}"
    raise InputError(with_hint(message, word, options) if word.startswith("-") else message)


def _silence(stream: Any) -> None:
    """Redirect a stream to the null device after the program that reads it has ended, as ``head`` does after ten lines.

    Python can then close the stream at exit without an error.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _stop_compilers() -> None:
    """Kill running compilers, because at exit Python waits for the threads that started them."""
    cache = sys.modules.get("symrot.build.cache")
    if cache is not None:
        cache.stop_compilers()


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command of symrot and return its exit code.

    Parameters
    ----------
    argv : sequence of str, optional
        The words after ``symrot``; default: the arguments of this process.
    """
    arguments = sys.argv[1:] if argv is None else list(argv)
    sys.stdout, sys.stderr = sys.stdout or _nowhere(), sys.stderr or _nowhere()
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # characters that the terminal cannot show must not cause a failure
    try:
        if "_ARGCOMPLETE" in os.environ:  # the shell asks for the words that may follow, and passes no arguments
            from symrot.cli.completion import complete

            complete(_parser())
        if not arguments:
            _parser().print_help(sys.stderr)
            return USAGE_ERROR
        _check_command(arguments)
        command = arguments[0] if arguments[0] in COMMANDS else ""
        parser = _parser(command)
        options, unknown = parser.parse_known_args(arguments)
        _check_unknown(command, unknown)
        code: int = options.function(options)
        sys.stdout.flush()
        return code
    except SymrotError as error:
        progress("")
        sys.stderr.write(f"symrot: {one_line(str(error))}\n")
        return USAGE_ERROR
    except BrokenPipeError:
        _silence(sys.stdout)
        return SIGPIPE
    except OSError as error:
        progress("")
        place = f"{one_line(str(error.filename))}: " if error.filename else ""
        sys.stderr.write(f"symrot: {place}{error.strerror or error}\n")
        return USAGE_ERROR
    except BaseException as error:
        if not is_interrupt(error):
            raise
        _stop_compilers()
        progress("")
        return INTERRUPTED
