"""The command ``symrot bench``: a table of its modes, each of which is chosen by an option of the command line.

A mode takes the parsed options and a callback for progress messages; it returns a :class:`ModeReport`. To add a mode,
write its function and add a row to :data:`MODES`.
"""

from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError
from symrot.scene.settings import SET_HELP, settings

__all__ = ["MODES", "STUDIES", "Mode", "ModeReport", "arguments", "run"]

Progress = Callable[[str], object]


class ModeReport(NamedTuple):
    """What a mode of ``symrot bench`` returns: data for JSON, lines of text (first the title), and success or not."""

    data: Any
    lines: Sequence[str]
    good: bool = True


class Mode(NamedTuple):
    """A mode of ``symrot bench``: the option that chooses it, its help text, accepted options, and its function."""

    # "" for the mode that studies one scene
    option: str
    about: str
    takes: frozenset[str]  # names of the other options that the mode accepts
    run: Callable[[Namespace, Progress], ModeReport]
    more: Mapping[str, Any] | None = None  # further arguments of argparse's add_argument


def _study(options: Namespace, say: Progress) -> ModeReport:
    from symrot.bench.comparison.work_precision import study
    from symrot.report import work_precision
    from symrot.scene.scene import load_scene

    _targets(options)
    scene = load_scene(options.scene)
    if options.settings:
        scene = scene.with_(settings(options.settings))
    results = study(scene, options.methods, options.quick, say, options.tolerances, options.rounds)
    if options.plot:
        from symrot.report.work_precision_plot import save

        save(results, options.plot)
    return ModeReport(results, work_precision.lines(results))


def _targets(options: Namespace) -> None:
    """Raise InputError if the file of ``--out`` or ``--plot`` cannot be written, before anything is measured."""
    from symrot.files.writing import check_target

    if options.out:
        check_target(options.out, (".json",), "--out")
    if options.plot:
        from symrot.report import plot

        check_target(options.plot, plot.SUFFIXES, "--plot")
        plot.require_matplotlib()


def _compare(options: Namespace, say: Progress) -> ModeReport:
    from symrot.report.work_precision import compared, lines_of_comparison, read_study

    _targets(options)
    first, second = (read_study(Path(name)) for name in options.compare)
    comparison = compared(first, second)
    return ModeReport(comparison, lines_of_comparison(comparison))


def _suite(options: Namespace, say: Progress) -> ModeReport:
    from symrot.bench.comparison import suite

    _targets(options)
    where = options.directory or Path("generated/bench")
    return ModeReport(*suite.run(where, options.methods, options.quick, say, options.tolerances, options.rounds))


def _skip(options: Namespace, say: Progress) -> ModeReport:
    from symrot.bench import skip

    _targets(options)
    results = skip.measure(options.scene, options.quick, say)
    if options.plot:
        from symrot.report.skip_plot import save

        save(results, options.plot)
    return ModeReport(results, skip.lines(results), all(row["agrees"] for row in results["rows"]))


def _stability(options: Namespace, say: Progress) -> ModeReport:
    from symrot.bench.error_growth import stability
    from symrot.scene.scene import load_scene

    _targets(options)
    results = stability.stability(load_scene(options.scene) if options.scene else None, options.long, say)
    if options.plot:
        from symrot.bench.error_growth.stability_plot import save

        save(results, options.plot)
    return ModeReport(results, stability.lines(results))


STUDIES: dict[str, str] = {
    "taylor": "Taylor series against heyoka with all settings and against handwritten loops in C, at equal error",
    "ensemble": "many motions in SIMD lanes against heyoka's batch and ensemble modes",
    "dense": "20 000 samples of one motion against heyoka's dense output",
    "kernels": "emitted kernels against kernels of other tools, in operations and nanoseconds",
    "overhead": "a call from Python against the bare call in C",
    "starts": "times of a call with another initial state, and of ensembles of 10 to 100 000 motions in closed form "
    "and in steps",
    "stepper": "DOP853 in C against a handwritten DOP853 and SciPy's, at equal tolerance",
    "closed_form": "nanoseconds per sample of closed forms, and the time of their set-up",
    "long": "errors of energy and attitude after 1e6 revolutions computed in steps, and the run time",
    "start": "`symrot run` with an empty and with a filled cache",
    "derive": "the time of derivations",
    "check": "`symrot check` on typical claims, on claims that name a formula and on conditional ones",
    "switches": "motions with switched torques, computed in steps and compared with closed forms",
    "ulps": "the errors of the functions that kernels call, in units in the last place",
    "comparison.steps": "one emitted time step against the step of other tools, in operations and nanoseconds",
    "comparison.sensitivities": "derivatives of motions against heyoka's variational equations",
    "comparison.sweeps": "a sweep against an ensemble of the same motions, and two Dask workers against one",
    "comparison.meshes": "mass and inertia of a mesh of a million triangles",
}
"""Studies of a single question: a module ``symrot.bench.NAME`` that runs as a command -> the question."""


def _list(options: Namespace, say: Progress) -> ModeReport:
    from symrot.report.layout import columns

    studies = [{"study": name, "about": about, "command": f"python -m symrot.bench.{name}"}
             for name, about in STUDIES.items()]  # fmt: skip
    modes = [(f"symrot bench {mode.option or 'SCENE'}", mode.about) for mode in MODES]
    rows = [(item["command"], item["about"]) for item in studies]
    return ModeReport(studies, ["What is measured, and by which command", "", *columns([*modes, *rows])])


SWEEP = frozenset({"methods", "tolerances", "rounds", "quick"})
SCENE_STUDY = SWEEP | {"scene", "settings", "plot", "out", "json"}
MODES: tuple[Mode, ...] = (
    Mode("", "study time against error for every method, on one scene", SCENE_STUDY, _study),
    Mode(
        "--compare", "compare a study with an earlier study of the same scene", frozenset({"out", "json"}), _compare,
        {"nargs": 2, "metavar": ("BEFORE.json", "NOW.json")},
    ),
    Mode("--suite", "study every motion of the suite, with figures; continue after an interruption",
         SWEEP | {"json", "directory", "out"}, _suite, {"action": "store_true"}),
    Mode("--skip", "measure the time that specialised kernels save, for fixed scenes or for SCENE",
         frozenset({"scene", "quick", "plot", "out", "json"}), _skip, {"action": "store_true"}),
    Mode("--stability", "study how errors grow over 1e5 revolutions, or over the span of SCENE",
         frozenset({"scene", "long", "plot", "json", "out"}), _stability, {"action": "store_true"}),
    Mode("--list", "list the modes, and further studies with the commands that run them", frozenset({"json"}), _list,
         {"action": "store_true"}),
)  # fmt: skip
"""All modes of ``symrot bench``."""

OPTION_TEXTS = {"scene": "SCENE", "settings": "--set", "directory": "-o"}  # names of options in messages, if not --NAME


def arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of ``symrot bench``."""
    add = parser.add_argument
    add("scene", metavar="SCENE", nargs="?", help="a shipped scene (see `symrot scenes`), or a file")
    add("--set", metavar="KEY=VALUE", action="append", dest="settings", help=SET_HELP)
    for mode in MODES:
        if mode.option:
            add(mode.option, help=mode.about, **(mode.more or {}))
    add("--methods", metavar="NAMES", help="methods to compare, separated by commas: exact, taylor, "
        "dop853, scipy, heyoka, DOP853, RK45, LSODA, Radau; the lower-case ones except heyoka are symrot's methods, "
        "the last four are SciPy's, called without symrot (default: all)")  # fmt: skip
    add(
        "--tolerances",
        metavar="LIST",
        help="tolerances of the methods, such as 1e-3,1e-6,1e-9 (default: one or two per power of ten)",
    )
    add(
        "--rounds",
        type=int,
        metavar="N",
        help="repetitions of each run (default: 9; with --quick: 5); their median is the result",
    )
    add(
        "--quick",
        action="store_true",
        help="fewer tolerances and repetitions, and heyoka with its default settings only",
    )
    add("--long", action="store_true", help="with --stability: follow 1e6 revolutions instead of 1e5")
    add("--plot", type=Path, metavar="FILE", help="draw time against error: FILE.png, .pdf or .svg")
    add("--out", type=Path, metavar="FILE", help="write the study as FILE.json, for --compare")
    add(
        "-o",
        type=Path,
        metavar="DIR",
        dest="directory",
        help="folder that --suite writes to (default: ./generated/bench)",
    )
    add("--json", action="store_true", help="print JSON")


def run(options: Namespace, say: Progress) -> ModeReport:
    """Run the mode of ``symrot bench`` that the options choose, and return its report.

    If the option ``--out`` names a file, the data of the report are written to it as JSON. ``say`` is called with
    messages about the progress.

    Raises
    ------
    InputError
        If the options choose no mode or more than one; if the mode does not accept an option; if an option has a wrong
        value; or if the mode cannot use the scene or a file.
    SymrotError
        If a mode fails, for instance because reference solutions differ.
    """
    asked = [mode for mode in MODES if mode.option and getattr(options, mode.option[2:])]
    names = ", ".join(mode.option for mode in MODES if mode.option)
    if len(asked) > 1 or (not asked and options.scene is None):
        raise InputError(f"bench: expected a SCENE or exactly one of {names} (see `symrot bench --help`)")
    mode = asked[0] if asked else MODES[0]
    for name in ("scene", "settings", "methods", "tolerances", "rounds", "quick", "long", "plot", "out", "directory"):
        if getattr(options, name) not in (None, False) and name not in mode.takes:
            option = OPTION_TEXTS.get(name, f"--{name}")
            raise InputError(f"bench: {mode.option or 'a SCENE'} does not accept {option} (see `symrot bench --help`)")
    if options.methods is not None or options.tolerances is not None:
        from symrot.bench.comparison.contestants import chosen, tolerances_from

        chosen(options.methods, options.quick)
        options.tolerances = tolerances_from(options.tolerances) if options.tolerances is not None else None
    if options.rounds is not None and options.rounds < 1:
        raise InputError(f"--rounds: expected at least 1, got {options.rounds}")
    options.tolerances = options.tolerances or ()
    outcome = mode.run(options, say)
    if options.out:
        import json

        from symrot.files.writing import write

        text = json.dumps(outcome.data, indent=1, ensure_ascii=False) + "\n"
        write(options.out, lambda stream: stream.write(text.encode("utf-8")))
    return outcome
