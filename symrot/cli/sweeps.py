"""The command ``symrot sweep``: its arguments, its progress bar and its summary."""

import re
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import symrot
from symrot.cli.output import INTERRUPTED, OK, Command, json_option, progress, say, say_json
from symrot.cli.scenes import load, scene_options
from symrot.errors import InputError

__all__ = ["COMMANDS"]

_VARY = re.compile(r"\s*([^~=\s]+)\s*([~=])\s*(.+)", re.DOTALL)
_TIMES = "'linspace(0, 10, 11)' or 'values(0, 1, 5)'"


def _vary(texts: list[str]) -> dict[str, Any]:
    """Return a map from the name of each varied quantity to its distribution or grid; ``texts`` come from ``--vary``.

    The text ``omega_1 ~ normal(0, 0.1)`` gives the key ``omega_1``.
    """
    from symrot.sweeps.laws import Distribution, read_law

    laws: dict[str, Any] = {}
    for text in texts:
        match = _VARY.fullmatch(text)
        if match is None:
            raise InputError(
                f"--vary: expected 'NAME ~ DISTRIBUTION' or 'NAME = GRID', such as 'omega_1 ~ normal(0, 0.1)' or "
                f"'weight = linspace(1, 2, 50)', got {text[:100]!r}"
            )
        name, sign, law_text = match.groups()
        if name in laws:
            raise InputError(f"--vary: expected each name once, got {name} a second time")
        law = laws[name] = read_law(law_text, f"--vary {name}")
        if isinstance(law, Distribution) != (sign == "~"):
            better = "~" if sign == "=" else "="
            raise InputError(
                f"--vary: expected '~' before a distribution and '=' before a grid, got {text[:100]!r}; write '{name} "
                f"{better} {law_text.strip()[:80]}'"
            )
    return laws


def _times(text: str | None) -> Any:
    from symrot.sweeps.laws import Grid, read_law

    if text is None:
        return None
    law = read_law(text, "--times")
    if not isinstance(law, Grid):
        raise InputError(f"--times: expected a grid of times in s, {_TIMES}, got {text[:100]!r}")
    return law.values


@contextmanager
def _bar() -> Iterator[Callable[[int, int], None]]:
    """Provide a function that shows the progress of a sweep: complete trajectories, their rate, the time left.

    Use: ``with _bar() as show: ..``. The function takes the number of complete trajectories and the number of all. tqdm
    draws the bar if it is installed; otherwise one line shows the number.
    """
    try:
        from tqdm import tqdm
    except ImportError:
        yield lambda done, total: progress(f"{done} of {total} trajectories ..")
        progress("")
        return
    tqdm.monitor_interval = 0  # no thread beside the processes of the sweep
    bar: Any = None

    def show(done: int, total: int) -> None:
        nonlocal bar
        if bar is None:
            bar = tqdm(total=total, initial=done, unit=" trajectories", unit_scale=True, disable=None, leave=False)
        else:
            bar.update(done - bar.n)

    try:
        yield show
    finally:
        if bar is not None:
            bar.close()


def _sweep(options: Namespace) -> int:
    if options.out is None:
        raise InputError("sweep: expected the file to write, -o FILE.zarr or -o FILE.parquet")
    vary, times, scene = _vary(options.vary), _times(options.times), load(options)
    try:
        with _bar() as show:
            result = symrot.sweep(
                scene, vary, attitudes=options.attitudes, sampling=options.sampling, count=options.count,
                seed=options.seed, outputs=options.output or ["omega@end"], t=times, statistics=options.statistics,
                keep=options.keep, path=options.out, method=options.method, tolerance=options.tolerance,
                workers=options.workers, scheduler=options.scheduler, chunk=options.chunk,
                table_folders=options.table_folder, progress=show, note=progress,
            )  # fmt: skip
    except KeyboardInterrupt:
        progress("")
        sys.stderr.write(
            f"symrot: interrupted; complete chunks are in {options.out}; run the same command again to go on\n"
        )
        return INTERRUPTED
    except (OSError, InputError) as reason:
        cause = reason if isinstance(reason, OSError) else reason.__cause__
        if not isinstance(cause, OSError):
            raise
        # such as a full disk
        advice = "; the complete chunks are saved, run the same command again to go on" if options.out.exists() else ""
        raise InputError(f"{options.out}: {cause.strerror or cause}{advice}") from None
    progress("")
    facts = {
        "written": str(result.path),
        "trajectories": result.count,
        "complete": result.count - result.stopped - result.impossible,
        "stopped": result.stopped,
        "impossible": result.impossible,
        "reasons": [{"trajectory": row, "reason": reason} for row, reason in result.reasons],
        "warnings": list(result.warnings),
    }
    if options.json:
        say_json(facts)
        return OK
    say([f"{result.path}: {facts['complete']} of {result.count} trajectories complete"])
    if result.stopped or result.impossible:
        say([f"  {result.stopped} stopped early, {result.impossible} have values that no motion can have, for example"])
        say(f"  trajectory {row}: {reason}" for row, reason in result.reasons)
    say(f"  warning: {warning}" for warning in result.warnings)
    opened = "xarray.open_zarr" if options.out.suffix.lower() == ".zarr" else "pandas.read_parquet"
    say([f"  open it with {opened}({str(result.path)!r})"])
    return OK


def _arguments(parser: ArgumentParser) -> None:
    scene_options(parser)
    parser.add_argument("--vary", metavar="'NAME ~ LAW'", action="append", default=[],
                        help="draw a value at random, 'omega_1 ~ normal(0, 0.1)' (or uniform, loguniform), or take it "
                        "from a grid, 'weight = linspace(1, 2, 50)' (or geomspace, values); NAME may be a number in "
                        "the scene file, such as body.mass; may be repeated")  # fmt: skip
    parser.add_argument(
        "--attitudes",
        metavar="WORD",
        default="scene",
        help="'uniform' draws the initial attitude at random from all rotations (default: the scene's own)",
    )
    parser.add_argument(
        "--sampling",
        metavar="WORD",
        default="random",
        help="how values are drawn: random, latin or sobol (default: random)",
    )
    parser.add_argument(
        "--count",
        metavar="N",
        help="number of trajectories, needed for random values (default: one for each combination of grid values)",
    )
    parser.add_argument("--seed", metavar="N", default=0, help="seed of the draws (default: 0)")
    parser.add_argument("--output", metavar="NAME", action="append", default=[],
                        help="quantity to write: at all times (energy), at one time in s (omega_1@end, axis_z@2.5), or "
                        "its extreme (omega_3@max); omega_1_by_weight@end is a derivative; may be "
                        "repeated (default: omega@end)")  # fmt: skip
    parser.add_argument("--times", metavar="GRID", help=f"sample times in s, {_TIMES.replace('%', '%%')} "
                        "(default: the scene's own)")  # fmt: skip
    parser.add_argument("--statistics", metavar="NAME", action="append", default=[],
                        help="statistics of each output over all trajectories: mean, envelope, "
                        "'percentiles(5, 50, 95)' or 'histogram(BINS)'; may be repeated")  # fmt: skip
    parser.add_argument(
        "--keep",
        metavar="WORD",
        default="all",
        help="'statistics' writes only the statistics, not each trajectory (default: all)",
    )
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="write FILE.zarr or FILE.parquet")
    parser.add_argument("--method", default="auto", metavar="NAME",
                        help="method that computes the motions: auto, exact, taylor, dop853 or scipy:NAME")  # fmt: skip
    parser.add_argument("--tolerance", metavar="X", help="error to aim for (default: the scene's own)")
    parser.add_argument("--workers", type=int, metavar="N", help="processes on this machine (default: one per core)")
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="address of a Dask scheduler, such as tcp://host:8786: its workers compute the motions, not this machine",
    )
    parser.add_argument(
        "--chunk",
        type=int,
        metavar="N",
        help="trajectories that are computed and written at once; does not change the results",
    )
    json_option(parser)


COMMANDS: dict[str, Command] = {
    "sweep": ("propagate many motions of a scene with varied values", _sweep, _arguments),
}
"""Name of the command -> (help text, function that runs it, function that declares its arguments)."""
