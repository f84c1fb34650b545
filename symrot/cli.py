"""The command line: parse, call, print. Texts come from :mod:`symrot.report`; stdout is data, stderr is progress.

Exit codes: 0 good, 1 a check failed, 2 bad usage or input, 130 interrupted, 141 nobody reads the output any more.
"""

import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NoReturn, TextIO

import symrot
from symrot.errors import CertificateError, InputError, SymrotError
from symrot.report.layout import emphasis, one_line

__all__ = ["main"]

GOOD, FAILED, BAD, INTERRUPTED, UNREAD = 0, 1, 2, 130, 141
TARGETS = ("c", "numpy")
PAGES: dict[str, Callable[[Any], str]] = {
    "markdown": lambda found: found.markdown(),
    "latex": lambda found: found.latex(),
    "html": lambda found: found.html(),
}


class _Parser(ArgumentParser):
    """A parser whose complaints are errors of ours, one sentence each."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see `{self.prog} --help`)")


def _say(lines: Iterable[str]) -> None:
    sys.stdout.write("".join(f"{line}\n" for line in lines))


def _say_json(found: Any) -> None:
    import json

    sys.stdout.write(json.dumps(found, indent=2, ensure_ascii=False) + "\n")


def _progress(text: str) -> None:
    """Show what takes its time, on one line of a terminal; an empty text clears it."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\x1b[K{text}")
        sys.stderr.flush()


# --- the commands -----------------------------------------------------------------------------------------------------


def _run(options: Namespace) -> int:
    from symrot.report.files import check_target
    from symrot.report.summary import facts, summary

    if options.out:
        from symrot.report import output

        check_target(options.out, tuple(output.FORMATS), "--out")
    if options.plot:
        from symrot.report import plot

        check_target(options.plot, plot.SUFFIXES, "--plot")
        plot.require_matplotlib()
    scene = symrot.load_scene(options.scene)
    _progress("preparing the kernel ..")
    start = perf_counter()
    propagator = symrot.propagator(scene, options.method, options.tolerance, state=options.state)
    propagator.prepare()
    preparation = perf_counter() - start
    _progress("propagating ..")
    trajectory = propagator()
    found = facts(propagator, trajectory, preparation)
    if options.out:
        _progress("writing ..")
        names = output.save(trajectory, options.out, propagator.tolerance)
        found["written"]["out"] = {"file": str(options.out), "samples": len(trajectory), "arrays": names}
    if options.plot:
        _progress("drawing ..")
        plot.save(propagator, trajectory, options.plot)
        found["written"]["plot"] = {"file": str(options.plot)}
    _progress("")
    if options.json:
        _say_json(found)
        return GOOD
    title, *rest = summary(found)
    _say([emphasis(title, sys.stdout), *rest])
    return GOOD


def _explain(options: Namespace) -> int:
    from symrot.report import explain

    scene = symrot.load_scene(options.scene)
    _progress("counting operations ..")
    found = explain.facts(symrot.plan(scene))
    _progress("")
    if options.json:
        _say_json(found)
        return GOOD
    title, *rest = explain.lines(found)
    _say([emphasis(title, sys.stdout), *rest])
    return GOOD


def _emit(options: Namespace) -> int:
    from symrot.report import kernels

    if sum(map(bool, (options.kernel, options.all, options.check, options.list))) != 1:
        raise InputError("emit: expected exactly one of a KERNEL or SCENE, --all, --check and --list "
                         "(see `symrot emit --help`)")  # fmt: skip
    if options.list:
        _say(kernels.kernel_lines())
        return GOOD
    targets = (options.target,) if options.target else TARGETS
    if options.check:
        different = kernels.stale(options.directory or Path("generated"), targets, _progress)
        _progress("")
        _say(different)
        return FAILED if different else GOOD
    if options.all:
        written = kernels.write_all(options.directory or Path("generated"), targets, _progress)
    else:
        bounds = kernels.kept_bounds(options.kernel, options.directory) if options.target != "numpy" else None
        found = kernels.kernel_files(options.kernel, options.target or "c", bounds)
        if options.directory is None:
            sys.stdout.write("\n".join(found.values()))
            return GOOD
        if options.target != "numpy":
            found |= kernels.certificate_files(options.kernel, options.directory, bounds)
        written = kernels.write_files(options.directory, found)
    _progress("")
    _say(str(path) for path in written)
    return GOOD


def _derive(options: Namespace) -> int:
    from symrot import catalogue

    if sum(map(bool, (options.name, options.all, options.check))) > 1:
        raise InputError("derive: expected at most one of a NAME, --all and --check (see `symrot derive --help`)")
    if options.step is None and options.detail:
        raise InputError("derive: expected --step N with --detail (see `symrot derive --help`)")
    if options.step is not None and not options.name:
        raise InputError("derive: expected a NAME with --step N (see `symrot derive --help`)")
    if options.format != "markdown" and options.check:
        raise InputError("derive: expected --format with a NAME or --all; --check compares the Markdown pages")
    if options.format != "markdown" and options.all:
        if options.directory is None:
            raise InputError(f"derive: expected a folder, -o DIR, for all pages as {options.format}")
        _say(str(path) for path in catalogue.write_pages(options.directory, options.format))
        return GOOD
    directory = options.directory or Path("derivations")
    if options.check:
        if not directory.is_dir():
            raise InputError(f"{str(directory)!r}: expected the folder that `symrot derive --all` writes, got none")
        different = catalogue.check(directory)
        sys.stdout.write("".join(diff for _, diff in different))
        return FAILED if different else GOOD
    if options.all:
        _say(str(path) for path in catalogue.derive_all(directory))
    elif options.name:
        found = catalogue.derivation(options.name)
        if options.step is not None:
            found = found.part(options.step, options.detail)
        sys.stdout.write(PAGES[options.format](found))
    else:
        _say(catalogue.names())
    return GOOD


def _prove(options: Namespace) -> int:
    from symrot.report import proofs

    written, result = proofs.prove(options.coq, options.check, _progress)
    _progress("")
    if options.json:
        _say_json(proofs.facts(options.coq, written, result))
    else:
        _say(proofs.lines(options.coq, result))
    return FAILED if result is not None and not result else GOOD


def _check(options: Namespace) -> int:
    from symrot.report import verdicts

    if (options.claim is None) == (options.textbook is None):
        raise InputError("check: expected a CLAIM, a FILE or --textbook NAME (see `symrot check --help`)")
    if options.all and options.textbook != "all":
        raise InputError("--all: expected --textbook all beside it, since the page holds every document")
    if options.textbook:
        return _check_textbook(options)
    found = verdicts.check(options.claim, options.given, options.unit, not options.no_repair, _progress)
    _progress("")
    if options.json:
        _say_json([verdict.to_json() for verdict in found])
    else:
        _say(verdicts.lines(found, options.claim))
    refused = [verdict for verdict in found if verdict.verdict == "refused"]
    sys.stderr.write("".join(f"symrot: {one_line(verdict.reason)}\n" for verdict in refused))
    return BAD if refused else GOOD if all(found) else FAILED


def _check_textbook(options: Namespace) -> int:
    from symrot.report import errata, files
    from symrot.textbook import DOCUMENTS

    names = DOCUMENTS if options.textbook == "all" else (options.textbook,)
    target = Path(options.output) / "errata.md"
    if options.all:
        files.check_target(target, (".md",), "--output")
    found = errata.survey(names, not options.no_repair, _progress)
    _progress("")
    if options.all:
        files.write(target, lambda stream: stream.write(errata.page(found).encode("utf-8")))
        _say([f"{target}: written"])
    elif options.json:
        _say_json(errata.facts(found))
    else:
        _say(errata.lines(found))
    return GOOD if options.all or all(item.outcome == "holds" for _, items in found for item in items) else FAILED


def _identify(options: Namespace) -> int:
    found = symrot.identify(options.formula)
    if options.json:
        _say_json([identification.to_json() for identification in found])
    else:
        _say(f"{identification}\n  {identification.source}" for identification in found)
        if not found:
            _say(["nothing that symrot derives is equal to it"])
    return GOOD if found else FAILED


def _bench(options: Namespace) -> int:
    from symrot.bench import command

    outcome = command.run(options, _progress)
    _progress("")
    if options.json:
        _say_json(outcome.found)
    else:
        title, *rest = outcome.lines
        _say([emphasis(title, sys.stdout), *rest])
    return GOOD if outcome.good else FAILED


def _scenes(options: Namespace) -> int:
    from symrot.report.layout import columns

    found = symrot.shipped_scenes()
    if options.json:
        _say_json([{"name": name, "title": title, "source": source} for name, title, source in found])
    else:
        _say(columns([(name, one_line(title)) for name, title, _ in found]))
    return GOOD


def _doctor(options: Namespace) -> int:
    from symrot.report import health

    if options.clear_cache:
        removed = health.clear_cache()
        _say_json({"removed": removed}) if options.json else _say([f"removed {removed} files from the cache"])
        return GOOD
    found = health.facts()
    if options.json:
        _say_json(found)
    else:
        _say(health.lines(found))
    return FAILED if found["problems"] else GOOD


def _selftest(options: Namespace) -> int:
    from symrot.certify.selftest import run_selftest

    found = run_selftest(bits=not options.bounds)
    if options.json:
        _say_json(found.facts())
    else:
        _say(found.lines())
    return GOOD if found.passed else FAILED


def _bound(options: Namespace) -> int:
    from symrot.report import bounds

    _progress("bounding ..")
    if options.target is None:
        if options.variable:
            raise InputError("--variable: expected --target X beside it, whose box is looked for")
        found = bounds.facts(options.kernel, options.box, options.precision)
    else:
        found = bounds.target_facts(options.kernel, options.box, options.precision, options.target, options.variable)
    _progress("")
    if options.json:
        _say_json(found)
    else:
        _say((bounds.lines if options.target is None else bounds.target_lines)(found))
    return GOOD


def _certify(options: Namespace) -> int:
    from symrot.report import certificates

    if options.all:
        if options.kernel or options.box or options.no_bounds:
            raise InputError("certify: expected --all without a KERNEL, --box or --no-bounds "
                             "(see `symrot certify --help`)")  # fmt: skip
        every, written = certificates.certify_all(options.directory, options.objects, _progress)
        _progress("")
        _say_json(every) if options.json else _say([*certificates.all_lines(every), *map(str, written)])
        return FAILED if options.objects and certificates.refuted(every.values()) else GOOD
    if not options.kernel:
        raise InputError("certify: expected a KERNEL or --all (see `symrot certify --help`)")
    found, written = certificates.certify(
        options.kernel, options.box, options.directory, options.objects, not options.no_bounds, _progress
    )
    _progress("")
    _say_json(found) if options.json else _say([*certificates.lines(found, options.objects), *map(str, written)])
    return FAILED if options.objects and certificates.refuted([found]) else GOOD


def _audit(options: Namespace) -> int:
    from symrot.report import certificates

    try:
        under = [] if options.flags is None else certificates.flag_lines(options.flags)
        found = certificates.audit_files(
            options.certificates, options.object, options.rerun_bounds, options.coq, _progress
        )
    except CertificateError as reason:
        _progress("")
        if options.json:
            _say_json({"holds": False, "reason": one_line(str(reason))})
        sys.stderr.write(f"symrot: {one_line(str(reason))}\n")
        return FAILED
    _progress("")
    if options.json:
        _say_json({"holds": True, "certificates": found} | ({"flags": under} if under else {}))
    else:
        _say([*(line for each in found.values() for line in each), *under])
    return GOOD


# --- what each takes --------------------------------------------------------------------------------------------------


def _scene_argument(parser: ArgumentParser, **more: Any) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a shipped scene (see `symrot scenes`), or a file", **more)


def _json_option(parser: ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print JSON")


def _run_arguments(parser: ArgumentParser) -> None:
    _scene_argument(parser)
    parser.add_argument("--method", default="auto", metavar="NAME", help="auto, exact, taylor, dop853 or scipy:NAME")
    parser.add_argument("--tolerance", metavar="X", help="error to aim for, 1e-15 to 1e-2 (default: the scene's own)")
    parser.add_argument("--state", default="quaternion", metavar="SEQUENCE", help="step Euler angles, such as ZXZ")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the quantities asked for: FILE.npz or FILE.csv")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw the motion on one page: FILE.png, .pdf or .svg")
    _json_option(parser)


def _explain_arguments(parser: ArgumentParser) -> None:
    _scene_argument(parser)
    _json_option(parser)


def _emit_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", nargs="?", help="a kernel of the library, a scene, or its file")
    parser.add_argument("--list", action="store_true", help="list the kernels of the library")
    parser.add_argument("--all", action="store_true", help="write the library and the kernels of all shipped scenes")
    parser.add_argument("--check", action="store_true", help="compare the written kernels; exit 1 with a diff if stale")
    parser.add_argument("--target", choices=TARGETS, help="language (default: c for a kernel, both for --all, --check)")
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory",
                        help="folder (default: standard output for a kernel, ./generated otherwise)")  # fmt: skip


def _derive_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("name", metavar="NAME", nargs="?", help="a derivation; without one they are listed")
    parser.add_argument("--all", action="store_true", help="write the pages of all derivations")
    parser.add_argument("--check", action="store_true", help="compare the written pages; exit 1 with a diff if stale")
    parser.add_argument("--format", choices=PAGES, default="markdown", help="of a derivation (default: markdown)")
    parser.add_argument("--step", type=int, metavar="N", help="print one step of a derivation")
    parser.add_argument(
        "--detail", action="store_true", help="with --step: show every expression between its two sides"
    )
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory",
                        help="folder of --all and --check (default: ./derivations)")  # fmt: skip


def _prove_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--coq", type=Path, metavar="DIR", required=True, help="write the theorems as files of Coq")
    parser.add_argument("--check", action="store_true", help="demand that Coq checks them; it does where it is there")
    _json_option(parser)


def _check_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("claim", metavar="CLAIM", nargs="?", help="'left == right', LaTeX, or a FILE.toml of claims")
    parser.epilog = ("Budget: 20 000 characters and 1 000 000 products of terms a claim; beyond it a claim is refused, "
                     "or undecided with this reason. Counted, never timed: all machines give one verdict.")  # fmt: skip
    parser.add_argument("--textbook", metavar="NAME", help="check what a document says: chen, sahakian, brown, "
                        "beer-johnston, or all")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="with --textbook all: write the page of errata")
    parser.add_argument("-o", "--output", metavar="DIR", default="generated", help="folder of --all (./generated)")
    parser.add_argument("--given", metavar="HYPOTHESIS", action="append", default=[],
                        help="'a == b', 'x > 0' or 'x != 0', with a claim as text; may be repeated")  # fmt: skip
    parser.add_argument("--unit", metavar="NAME=UNIT", action="append", default=[],
                        help="unit of a symbol, with a claim as text: 'F=kg m/s^2'; may be repeated")  # fmt: skip
    parser.add_argument("--no-repair", action="store_true", help="do not look for true formulas near a false one")
    _json_option(parser)


def _identify_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("formula", metavar="FORMULA", help="a formula or matrix, as text or LaTeX")
    _json_option(parser)


def _bench_arguments(parser: ArgumentParser) -> None:
    from symrot.bench import command

    command.arguments(parser)


def _doctor_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--clear-cache", action="store_true", help="remove the kernels kept in the cache")
    _json_option(parser)


def _selftest_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("--bounds", action="store_true", help="for the error bounds only: contraction is no failure")
    _json_option(parser)


def _bound_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", help="a kernel of the library (see `symrot emit --list`), a scene")
    parser.add_argument("--box", metavar="NAME=LOW:HIGH", action="append", default=[],
                        help="range of an input, theta=-1.4:1.4 (default: the kernel's), or of a physical constant of "
                        "a scene, A=1:2; may be repeated")  # fmt: skip
    parser.add_argument("--target", type=float, metavar="X", help="find the largest box on which no error is above X")
    parser.add_argument("--variable", metavar="NAME", action="append", default=[],
                        help="with --target: resize the range of this input alone; may be repeated")  # fmt: skip
    parser.add_argument("--precision", choices=("double", "float"), default="double", help="(default: double)")
    _json_option(parser)


def _certify_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("kernel", metavar="KERNEL", nargs="?",
                        help="a kernel of the library, its C file or certificate, or a scene")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="certify the library and the kernels of all shipped scenes")
    parser.add_argument("--box", metavar="NAME=LOW:HIGH", action="append", default=[],
                        help="range of an input for the bounds of rounding errors, or of a physical constant of a "
                        "scene; may be repeated")  # fmt: skip
    parser.add_argument("--objects", action="store_true", help="compile it, and compare the object code with it")
    parser.add_argument("--no-bounds", action="store_true", help="leave the bounds of rounding errors out")
    parser.add_argument("-o", type=Path, metavar="DIR", dest="directory", help="write kernel and certificate there")
    _json_option(parser)


def _audit_arguments(parser: ArgumentParser) -> None:
    parser.add_argument("certificates", type=Path, nargs="+", metavar="FILE.cert.json", help="the files beside it")
    parser.add_argument("--object", type=Path, metavar="FILE.o", help="what your compiler made of the C file")
    parser.add_argument("--flags", metavar="'CC FLAGS'", help="what holds under your compiler's flags: 'gcc -O3 -mfma'")
    parser.add_argument("--rerun-bounds", action="store_true", help="find the bounds of rounding errors again")
    parser.add_argument("--coq", action="store_true", help="have Coq check the theorem about the kernel")
    _json_option(parser)


COMMANDS: dict[str, tuple[str, Callable[[Namespace], int], Callable[[ArgumentParser], None]]] = {
    "run": ("propagate a scene and summarise its motion", _run, _run_arguments),
    "explain": ("show what is computed for a scene, what is skipped and why", _explain, _explain_arguments),
    "derive": ("print derivations, proven step by step", _derive, _derive_arguments),
    "prove": ("print the kinematics as theorems, and have Coq check them", _prove, _prove_arguments),
    "check": ("decide whether formulas hold, and what would", _check, _check_arguments),
    "identify": ("say what a formula is, whatever its symbols are called", _identify, _identify_arguments),
    "emit": ("print a kernel of the library, or that of a scene, as C or NumPy", _emit, _emit_arguments),
    "certify": ("certify a kernel: laws, C text, rounding errors, object code", _certify, _certify_arguments),
    "audit": ("check that a certificate holds for the files beside it", _audit, _audit_arguments),
    "bound": ("bound the rounding errors of a kernel on a box of inputs", _bound, _bound_arguments),
    "selftest": ("check that this machine computes as the certificates assume", _selftest, _selftest_arguments),
    "bench": ("measure time against error, on a scene of yours", _bench, _bench_arguments),
    "scenes": ("list the scenes that come with symrot", _scenes, _json_option),
    "doctor": ("check compiler, cache and installed versions", _doctor, _doctor_arguments),
}
"""Command -> what it does, the function that does it, the function that declares its arguments."""


def _nowhere() -> TextIO:
    """Return a stream for a process that was started with that one closed."""
    return Path(os.devnull).open("w", encoding="utf-8")


def _parser() -> _Parser:
    parser = _Parser(
        prog="symrot",
        description="Rigid-body rotation: derived, specialised, compiled, propagated.",
        epilog="Try: symrot run tumbling_prism --plot prism.png",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"symrot {symrot.__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", dest="command", required=True)
    for name, (about, function, declare) in COMMANDS.items():
        spoken = f"{about[0].upper()}{about[1:]}."
        command = commands.add_parser(name, help=about, description=spoken, allow_abbrev=False)
        declare(command)
        command.set_defaults(function=function)
    return parser


def _known(arguments: Sequence[str]) -> None:
    """Refuse a command that is none, with the nearest that is one."""
    if arguments and not arguments[0].startswith("-") and arguments[0] not in COMMANDS:
        from symrot.scene_reader import nearest

        hint = nearest(arguments[0], COMMANDS)
        said = f"expected a command, one of {', '.join(COMMANDS)}, got {arguments[0][:60]!r}"
        raise InputError(f"{said} ({hint})" if hint else said)


def _silence(stream: Any) -> None:
    """Point a stream whose reader is gone to nowhere, so that Python can close it without a word."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code.

    Parameters
    ----------
    argv : sequence of str, optional
        The words after ``symrot``; default: those of this process.
    """
    arguments = sys.argv[1:] if argv is None else list(argv)
    sys.stdout, sys.stderr = sys.stdout or _nowhere(), sys.stderr or _nowhere()
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a title in letters that the terminal has not is no reason to fail
    try:
        if not arguments:
            _parser().print_help(sys.stderr)
            return BAD
        _known(arguments)
        options = _parser().parse_args(arguments)
        code: int = options.function(options)
        sys.stdout.flush()
        return code
    except SymrotError as error:
        _progress("")
        sys.stderr.write(f"symrot: {one_line(str(error))}\n")
        return BAD
    except BrokenPipeError:
        _silence(sys.stdout)
        return UNREAD
    except OSError as error:
        _progress("")
        place = f"{error.filename}: " if error.filename else ""
        sys.stderr.write(f"symrot: {one_line(place)}{error.strerror or error}\n")
        return BAD
    except KeyboardInterrupt:
        _progress("")
        return INTERRUPTED
