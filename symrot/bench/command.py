"""What ``symrot bench`` does: a table of modes, each an option of the command line.

A mode takes the parsed options and a function that hears of progress; it returns an :class:`Outcome`. Modules of a mode
are imported when it is asked for. To add one: a function here or in a module of its own, and a row of :data:`MODES`.
"""

from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import InputError

__all__ = ["MODES", "STUDIES", "Mode", "Outcome", "arguments", "run"]

Say = Callable[[str], object]


class Outcome(NamedTuple):
    """What a mode found: data for JSON, lines for people of which the first is the title, whether all is well."""

    found: Any
    lines: Sequence[str]
    good: bool = True


class Mode(NamedTuple):
    """One mode: its option, or "" for the study of a scene; what it takes besides, what it does."""

    option: str
    about: str
    takes: frozenset[str]  # of the names of options
    run: Callable[[Namespace, Say], Outcome]
    more: Mapping[str, Any] | None = None  # what argparse needs to know of the option beyond its name


def _study(options: Namespace, say: Say) -> Outcome:
    from symrot.bench.comparison.work_precision import study
    from symrot.report import work_precision
    from symrot.scene.scene import load_scene

    _targets(options)
    found = study(load_scene(options.scene), options.methods, options.quick, say, options.tolerances, options.rounds)
    if options.plot:
        from symrot.report.work_precision_plot import save

        save(found, options.plot)
    return Outcome(found, work_precision.lines(found))


def _targets(options: Namespace) -> None:
    """Refuse files that cannot be written before anything is measured."""
    from symrot.files.writing import check_target

    if options.out:
        check_target(options.out, (".json",), "--out")
    if options.plot:
        from symrot.report import plot

        check_target(options.plot, plot.SUFFIXES, "--plot")
        plot.require_matplotlib()


def _compare(options: Namespace, say: Say) -> Outcome:
    from symrot.report.work_precision import compared, lines_of_comparison, read_study

    _targets(options)
    first, second = (read_study(Path(name)) for name in options.compare)
    found = compared(first, second)
    return Outcome(found, lines_of_comparison(found))


def _suite(options: Namespace, say: Say) -> Outcome:
    from symrot.bench.comparison import suite

    _targets(options)
    where = options.directory or Path("generated/bench")
    return Outcome(*suite.run(where, options.methods, options.quick, say, options.tolerances, options.rounds))


def _skip(options: Namespace, say: Say) -> Outcome:
    from symrot.bench import skip

    _targets(options)
    found = skip.measure(options.scene, options.quick, say)
    if options.plot:
        from symrot.report.skip_plot import save

        save(found, options.plot)
    return Outcome(found, skip.lines(found))


def _stability(options: Namespace, say: Say) -> Outcome:
    from symrot.bench.error_growth import stability

    _targets(options)
    found = stability.report(options.scene, options.long, options.plot, say)
    return Outcome(found, stability.lines(found))


STUDIES: dict[str, str] = {
    "taylor": "Taylor series against heyoka in all settings and against loops by hand in C, at equal error",
    "ensemble": "many motions in SIMD lanes against heyoka's batch and ensemble modes",
    "dense": "20 000 samples of one motion against heyoka's dense output",
    "kernels": "emitted kernels against those of other tools, in operations and nanoseconds",
    "overhead": "a call from Python against the bare call in C",
    "starts": "another start by component, and ensembles of 10 to 100 000 motions, exact and stepped",
    "stepper": "DOP853 in C against one by hand and SciPy's, at equal tolerance",
    "closed_form": "nanoseconds per sample of the closed forms, and their set-up",
    "long": "1e6 revolutions by stepping: energy, attitude and time",
    "start": "`symrot run` from a cold and from a warm start",
    "derive": "how long deriving takes",
}
"""The studies of one question each: module of :mod:`symrot.bench` -> what it answers."""


def _list(options: Namespace, say: Say) -> Outcome:
    from symrot.report.layout import columns

    found = [{"study": name, "about": about, "command": f"python -m symrot.bench.{name}"}
             for name, about in STUDIES.items()]  # fmt: skip
    modes = [(f"symrot bench {mode.option or 'SCENE'}", mode.about) for mode in MODES]
    rows = [(item["command"], item["about"]) for item in found]
    return Outcome(found, ["What is measured, and by which command", "", *columns([*modes, *rows])])


SWEEP = frozenset({"methods", "tolerances", "rounds", "quick"})
SCENE_STUDY = SWEEP | {"scene", "plot", "out", "json"}
MODES: tuple[Mode, ...] = (
    Mode("", "time against error for every method, on a scene of yours", SCENE_STUDY, _study),
    Mode(
        "--compare", "one study against an earlier one of the same scene", frozenset({"out", "json"}), _compare,
        {"nargs": 2, "metavar": ("BEFORE.json", "NOW.json")},
    ),
    Mode("--suite", "the fixed suite, with its figures; goes on where it was interrupted",
         SWEEP | {"json", "directory", "out"}, _suite, {"action": "store_true"}),
    Mode("--skip", "what specialisation saves: a ladder of scenes, or the scene given",
         frozenset({"scene", "quick", "plot", "out", "json"}), _skip, {"action": "store_true"}),
    Mode("--stability", "how errors grow over 1e5 revolutions, or over the span of the scene given",
         frozenset({"scene", "long", "plot", "json", "out"}), _stability, {"action": "store_true"}),
    Mode("--list", "list the modes, and the studies of one question each", frozenset({"json"}), _list,
         {"action": "store_true"}),
)  # fmt: skip
"""What ``symrot bench`` can do."""

SPOKEN = {"scene": "SCENE", "directory": "-o"}


def arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of ``symrot bench``."""
    add = parser.add_argument
    add("scene", metavar="SCENE", nargs="?", help="a shipped scene (see `symrot scenes`), or a file")
    for mode in MODES:
        if mode.option:
            add(mode.option, help=mode.about, **(mode.more or {}))
    add("--methods", metavar="NAMES", help="of exact, taylor, dop853, scipy, heyoka, DOP853, RK45, LSODA, Radau; "
        "commas between (default: all)")  # fmt: skip
    add("--tolerances", metavar="LIST", help="such as 1e-3,1e-6,1e-9 (default: one or two to a decade)")
    add("--rounds", type=int, metavar="N", help="turns of each run, whose median counts (default: 9, with --quick 5)")
    add("--quick", action="store_true", help="fewer tolerances and turns, heyoka in its default settings alone")
    add("--long", action="store_true", help="with --stability: 1e6 revolutions")
    add("--plot", type=Path, metavar="FILE", help="draw time against error: FILE.png, .pdf or .svg")
    add("--out", type=Path, metavar="FILE", help="write the study as FILE.json, for --compare")
    add("-o", type=Path, metavar="DIR", dest="directory", help="folder of --suite (default: ./generated/bench)")
    add("--json", action="store_true", help="print JSON")


def run(options: Namespace, say: Say) -> Outcome:
    """Do what the options ask for.

    Raises
    ------
    InputError
        For no mode or two of them, and for an option that the mode does not take.
    """
    asked = [mode for mode in MODES if mode.option and getattr(options, mode.option[2:])]
    names = ", ".join(mode.option for mode in MODES if mode.option)
    if len(asked) > 1 or (not asked and options.scene is None):
        raise InputError(f"bench: expected a SCENE or exactly one of {names} (see `symrot bench --help`)")
    mode = asked[0] if asked else MODES[0]
    for name in ("scene", "methods", "tolerances", "rounds", "quick", "long", "plot", "out", "directory"):
        if getattr(options, name) not in (None, False) and name not in mode.takes:
            spoken = SPOKEN.get(name, f"--{name}")
            raise InputError(f"bench: {mode.option or 'a SCENE'} takes no {spoken} (see `symrot bench --help`)")
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

        text = json.dumps(outcome.found, indent=1, ensure_ascii=False) + "\n"
        write(options.out, lambda stream: stream.write(text.encode("utf-8")))
    return outcome
