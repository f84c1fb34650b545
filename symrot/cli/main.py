"""The command line: parses arguments, calls the command, prints its result to stdout and its progress to stderr.

Texts come from :mod:`symrot.report`. The exit codes are 0 for success, 1 if a check failed, 2 for bad usage or input,
130 after an interrupt, and 141 if the program that read the output has ended.
"""

import os
import sys
from argparse import ArgumentParser, HelpFormatter, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NoReturn, TextIO

import symrot
from symrot.cli import certify as cli_certify
from symrot.cli import exchange as cli_exchange
from symrot.cli import exercises as cli_exercises
from symrot.cli import scenes as cli_scenes
from symrot.cli import sweeps as cli_sweeps
from symrot.cli.output import (
    FAILED,
    INTERRUPTED,
    OK,
    SIGPIPE,
    USAGE_ERROR,
    Command,
    json_option,
    progress,
    say,
    say_json,
)
from symrot.errors import InputError, PropagationError, SymrotError, with_hint
from symrot.report.layout import emphasis, one_line

__all__ = ["main"]

TARGETS = ("c", "numpy", "js", "jax")
PAGE_SUFFIXES = (".html", ".htm")
PAGES: dict[str, Callable[[Any], str]] = {
    "markdown": lambda page: page.markdown(),
    "latex": lambda page: page.latex(),
    "html": lambda page: page.html(),
}


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


class _Parser(ArgumentParser):
    """An argument parser that raises InputError with one sentence, instead of printing its usage and exiting."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, formatter_class=_Formatter)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see `{self.prog} --help`)")


# --- the commands -----------------------------------------------------------------------------------------------------


def _run(options: Namespace) -> int:
    from symrot.files.writing import check_target
    from symrot.report.summary import facts, summary

    if options.out:
        from symrot.report import output

        check_target(options.out, tuple(output.FORMATS), "--out")
    if options.plot:
        from symrot.report import plot

        check_target(options.plot, (*plot.SUFFIXES, *PAGE_SUFFIXES), "--plot")
        if options.plot.suffix.lower() not in PAGE_SUFFIXES:
            plot.require_matplotlib()
    scene = cli_scenes.load(options)
    progress("preparing the kernel (a compiler has at most 300 s) ..")
    start = perf_counter()
    names = options.sensitivities.split(",") if options.sensitivities is not None else None
    propagator = symrot.propagator(scene, options.method, options.tolerance, state=options.state, sensitivities=names)
    propagator.prepare()
    preparation = perf_counter() - start
    trajectory = _trajectory(propagator, options)
    if trajectory is None:
        return INTERRUPTED
    report = facts(propagator, trajectory, preparation)
    if options.out:
        progress("writing ..")
        names = output.save(trajectory, options.out)
        report["written"]["out"] = {"file": str(options.out), "samples": len(trajectory), "arrays": names}
    if options.plot:
        progress("drawing ..")
        if options.plot.suffix.lower() in PAGE_SUFFIXES:
            trajectory.show(options.plot)
        else:
            plot.save(propagator, trajectory, options.plot)
        report["written"]["plot"] = {"file": str(options.plot)}
    progress("")
    if options.json:
        say_json(report)
        return OK
    title, *rest = summary(report)
    say([emphasis(title, sys.stdout), *rest])
    return OK


def _show(options: Namespace) -> int:
    scene = cli_scenes.load(options)
    progress("computing the motion ..")
    path = symrot.show(scene, options.output, lambda done, total: progress(f"drawing frame {done} of {total} .."))
    progress("")
    if options.json:
        say_json({"scene": scene.name, "written": str(path), "bytes": path.stat().st_size})
    else:
        is_page = path.suffix.lower() in PAGE_SUFFIXES
        hint = ", one file without links; open it in a browser" if is_page else ""
        say([f"{path}: {path.stat().st_size / 1e6:.1f} MB{hint}"])
    return OK


def _trajectory(propagator: Any, options: Namespace) -> Any:
    """Compute the motion that a command asks for and return its trajectory, or None after Ctrl-C.

    ``options`` are the parsed arguments of the command. If the propagation ends early, the samples so far are written
    to the file of ``--out``.
    """
    from symrot.propagation.progress import reporting

    start_time = last_update = perf_counter()

    def show(t: float, start: float, stop: float) -> None:
        nonlocal last_update
        now = perf_counter()
        if now - last_update > 0.2:
            last_update = now
            progress(f"propagating: {abs(t - start) / abs(stop - start):.1%} of the span, {now - start_time:.0f} s ..")

    progress("propagating ..")
    try:
        with reporting(show):
            return propagator()
    except PropagationError as error:
        raise PropagationError(f"{error}{_write_partial(error, propagator, options)}") from None
    except KeyboardInterrupt as error:
        progress("")
        part = getattr(error, "trajectory", None)
        until = f" at t = {float(part.t[-1])!r} s" if part is not None and len(part) else ""
        sys.stderr.write(f"symrot: interrupted{until}{_write_partial(error, propagator, options)}\n")
        return None


def _write_partial(error: BaseException, propagator: Any, options: Namespace) -> str:
    """Write the samples before an error to the file of ``--out``; return text for the error message that says so.

    The text is empty, and no file is written, if there are no samples or the command has no ``--out``.
    """
    part = getattr(error, "trajectory", None)
    if not options.out or part is None or not len(part):
        return ""
    from symrot.report import output

    output.save(part, options.out)
    return f"; {options.out} contains the {len(part)} samples before that time"


def _explain(options: Namespace) -> int:
    from symrot.report import explain

    scene = cli_scenes.load(options)
    progress("counting operations ..")
    report = explain.facts(symrot.plan(scene))
    progress("")
    if options.json:
        say_json(report)
        return OK
    title, *rest = explain.lines(report)
    say([emphasis(title, sys.stdout), *rest])
    return OK


def _emit(options: Namespace) -> int:
    from symrot.workshop import kernel_files as kernels

    if sum(map(bool, (options.kernel, options.all, options.check, options.list))) != 1:
        raise InputError("emit: expected exactly one of a KERNEL or SCENE, --all, --check and --list "
                         "(see `symrot emit --help`)")  # fmt: skip
    if options.cmake and (options.directory is None or options.target not in (None, "c") or not options.kernel):
        raise InputError("--cmake: expected a KERNEL or SCENE, -o DIR and no --target other than c "
                         "(see `symrot emit --help`)")  # fmt: skip
    for option in ("jacobian", "step", "order"):
        if getattr(options, option) is not None and not options.kernel:
            raise InputError(f"--{option}: expected a KERNEL or SCENE as well (see `symrot emit --help`)")
    if options.list:
        say(kernels.kernel_lines())
        return OK
    targets = (options.target,) if options.target else TARGETS
    if options.check:
        different = kernels.stale(options.directory or Path("generated"), targets, progress)
        progress("")
        say(different)
        return FAILED if different else OK
    if options.all:
        written = kernels.write_all(options.directory or Path("generated"), targets, progress)
    else:
        kernel = kernels.chosen_text(options.kernel, options.jacobian, options.step, options.order)
        bounds = kernels.stored_bounds(kernel, options.directory) if options.target in (None, "c") else None
        texts = kernels.kernel_files(kernel, options.target or "c", bounds)
        if options.directory is None:
            sys.stdout.write("\n".join(texts.values()))
            return OK
        if options.target in (None, "c"):
            texts |= kernels.certificate_files(kernel, options.directory, bounds)
        if options.cmake:
            texts |= kernels.build_files()
        written = kernels.write_files(options.directory, texts)
    progress("")
    say(str(path) for path in written)
    return OK


PAGE_FILES = {".html": "html", ".htm": "html", ".tex": "latex", ".md": "markdown", ".pdf": "latex"}
"""End of a file's name -> the format that somebody wants who gives this file instead of a folder."""


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


def _check(options: Namespace) -> int:
    from symrot.report import verdicts

    if (options.claim is None) == (options.textbook is None):
        raise InputError("check: expected a CLAIM, a FILE or --textbook NAME (see `symrot check --help`)")
    if options.all and options.textbook != "all":
        raise InputError(
            "--all: expected --textbook all as well, since --all writes pages of errata that contain every document"
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


def _scenes(options: Namespace) -> int:
    from symrot.report.layout import columns

    scenes = symrot.shipped_scenes()
    if options.json:
        say_json([{"name": name, "title": title, "source": source} for name, title, source in scenes])
    else:
        say(columns([(name, one_line(title)) for name, title, _ in scenes]))
    return OK


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


# --- the arguments of each command ------------------------------------------------------------------------------------


def _run_arguments(parser: ArgumentParser) -> None:
    cli_scenes.scene_options(parser)
    parser.add_argument("--method", default="auto", metavar="NAME",
                        help="method that computes the motion: auto, exact, taylor, dop853 or scipy:NAME")  # fmt: skip
    parser.add_argument("--tolerance", metavar="X", help="error to aim for, 1e-15 to 1e-2 (default: the scene's own)")
    parser.add_argument(
        "--state",
        default="quaternion",
        metavar="SEQUENCE",
        help="integrate Euler angles of this sequence, such as ZXZ (default: quaternion)",
    )
    parser.add_argument("--sensitivities", metavar="NAME,..", help="also compute the derivatives of the motion by "
                        "these initial values and constants, such as omega,weight; --out writes them")  # fmt: skip
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the output quantities: FILE.npz or FILE.csv")
    parser.add_argument("--plot", type=Path, metavar="FILE",
                        help="draw the motion: FILE.png, .pdf or .svg, or FILE.html for an animated page")  # fmt: skip
    json_option(parser)


def _show_arguments(parser: ArgumentParser) -> None:
    cli_scenes.scene_options(parser)
    parser.add_argument("-o", "--output", type=Path, metavar="FILE",
                        help="file to write: FILE.html, or a film, FILE.gif or .mp4 (default: SCENE.html)")  # fmt: skip
    json_option(parser)


def _explain_arguments(parser: ArgumentParser) -> None:
    cli_scenes.scene_options(parser)
    json_option(parser)


def _emit_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", nargs="?", help="a kernel of the library, a scene, or a scene file")
    parser.add_argument("--list", action="store_true", help="list the kernels of the library")
    parser.add_argument("--all", action="store_true", help="write the library and the kernels of all shipped scenes")
    parser.add_argument(
        "--check",
        action="store_true",
        help="compare the files on disk with new ones; exit 1 with a diff if they differ",
    )
    parser.add_argument(
        "--target", choices=TARGETS, help="language to emit (default: c for a kernel, all for --all and --check)"
    )
    parser.add_argument("--jacobian", metavar="NAME,..", help="add the derivatives of the outputs by these inputs, "
                        "such as omega,q, or by constants of a scene")  # fmt: skip
    parser.add_argument("--step", metavar="METHOD", help="emit one time step of a scene: rk4, taylor, dop853 or exact")
    parser.add_argument(
        "--order", type=int, metavar="N", help="order of the Taylor series with --step taylor, 1 to 16 (default: 8)"
    )
    parser.add_argument("--cmake", action="store_true", help="with -o: also write the files with which CMake "
                        "and pkg-config find the kernels in this folder")  # fmt: skip
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory",
                        help="folder to write to, or to compare with --check (default: standard output for a kernel, "
                        "otherwise ./generated)")  # fmt: skip


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


def _bench_arguments(parser: ArgumentParser) -> None:
    from symrot.bench import command

    command.arguments(parser)


def _doctor_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--clear-cache", action="store_true", help="remove all kernels from the cache")
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "run": ("propagate a scene and summarise its motion", _run, _run_arguments),
    "show": ("write a page that plays a scene and lets the reader change it", _show, _show_arguments),
    **cli_sweeps.COMMANDS,
    "explain": ("show what is computed for a scene, what is skipped and why", _explain, _explain_arguments),
    **cli_exchange.COMMANDS,
    "derive": ("print derivations, proven step by step", _derive, _derive_arguments),
    "check": ("decide whether formulas hold, and suggest corrections", _check, _check_arguments),
    "identify": ("recognise a formula, whatever the names of its symbols", _identify, _identify_arguments),
    **cli_exercises.COMMANDS,
    "emit": ("print a kernel of the library or of a scene as C, NumPy, JavaScript or JAX", _emit, _emit_arguments),
    **cli_certify.COMMANDS,
    "bench": ("measure time against error on a scene of your choice", _bench, _bench_arguments),
    "scenes": ("list the scenes that come with symrot", _scenes, json_option),
    "doctor": ("check compiler, cache and installed versions", _doctor, _doctor_arguments),
}
"""For each command: its help text, the function that runs it, and the function that declares its arguments."""


def _nowhere() -> TextIO:
    """Return a stream that discards its text, for a process that was started with stdout or stderr closed."""
    return Path(os.devnull).open("w", encoding="utf-8")


def _parser(only: str = "") -> _Parser:
    """Return the parser of all commands, or, to save time, of the command named ``only``."""
    parser = _Parser(
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
    own = _Parser()
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
        if not arguments:
            _parser().print_help(sys.stderr)
            return USAGE_ERROR
        _check_command(arguments)
        command = arguments[0] if arguments[0] in COMMANDS else ""
        parser = _parser(command)
        if "_ARGCOMPLETE" in os.environ:  # the shell asks for words that may follow
            from symrot.cli.completion import complete

            complete(parser)
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
    except KeyboardInterrupt:
        _stop_compilers()
        progress("")
        return INTERRUPTED
