"""The commands that compute motions of scenes, or list and explain scenes: run, show, explain, scenes."""

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from time import perf_counter
from typing import Any

import symrot
from symrot.cli.output import INTERRUPTED, OK, Command, json_option, progress, say, say_json
from symrot.cli.scenes import load, scene_options
from symrot.errors import PropagationError
from symrot.report.layout import emphasis, one_line

__all__ = ["COMMANDS"]

PAGE_SUFFIXES = (".html", ".htm")


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
    scene = load(options)
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
            plot.save(trajectory, options.plot)
        report["written"]["plot"] = {"file": str(options.plot)}
    progress("")
    if options.json:
        say_json(report)
        return OK
    title, *rest = summary(report)
    say([emphasis(title, sys.stdout), *rest])
    return OK


def _show(options: Namespace) -> int:
    scene = load(options)
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
    to the file of ``--out``; unless Ctrl-C ended it, PropagationError is raised.
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

    scene = load(options)
    progress("counting operations ..")
    report = explain.facts(symrot.plan(scene))
    progress("")
    if options.json:
        say_json(report)
        return OK
    title, *rest = explain.lines(report)
    say([emphasis(title, sys.stdout), *rest])
    return OK


def _scenes(options: Namespace) -> int:
    from symrot.report.layout import columns

    scenes = symrot.shipped_scenes()
    if options.json:
        say_json([{"name": name, "title": title, "source": source} for name, title, source in scenes])
    else:
        say(columns([(name, one_line(title)) for name, title, _ in scenes]))
    return OK


def _run_arguments(parser: ArgumentParser) -> None:
    scene_options(parser)
    parser.add_argument("--method", default="auto", metavar="NAME",
                        help="method that computes the motion: auto, exact, taylor, dop853 or scipy:NAME")  # fmt: skip
    parser.add_argument("--tolerance", metavar="X", help="error to aim for, 1e-15 to 1e-2 (default: the scene's own)")
    parser.add_argument(
        "--state",
        default="quaternion",
        metavar="SEQUENCE",
        help="integrate Euler angles of this sequence, such as ZXZ (default: quaternion)",
    )
    parser.add_argument("--sensitivities", metavar="NAME,..", help="also compute the derivatives of the motion "
                        "with respect to these initial values and constants, such as omega,weight; "
                        "--out writes them")  # fmt: skip
    parser.add_argument("-o", "--out", type=Path, metavar="FILE",
                        help="write the output quantities: FILE.npz or FILE.csv")  # fmt: skip
    parser.add_argument("--plot", type=Path, metavar="FILE",
                        help="draw the motion: FILE.png, .pdf or .svg, or FILE.html for an animated page")  # fmt: skip
    json_option(parser)


def _show_arguments(parser: ArgumentParser) -> None:
    scene_options(parser)
    parser.add_argument("-o", "--out", "--output", dest="output", type=Path, metavar="FILE",
                        help="file to write: FILE.html, or a film, FILE.gif or .mp4 (default: SCENE.html)")  # fmt: skip
    json_option(parser)


def _explain_arguments(parser: ArgumentParser) -> None:
    scene_options(parser)
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "run": ("propagate a scene and summarise its motion", _run, _run_arguments),
    "show": ("write a page that plays a scene and lets the reader change it", _show, _show_arguments),
    "explain": ("show what is computed for a scene, what is skipped and why", _explain, _explain_arguments),
    "scenes": ("list the scenes that come with symrot", _scenes, json_option),
}
"""Names of the commands -> (help text, function that runs the command, function that declares its arguments)."""
