"""Measured rounding errors against their bounds, for all kernels: ``python -m
tests.campaigns.certificates.rounding_campaign``.

It prints for each kernel and precision the output with the largest ratio of bound to measured error. Then it prints for
each class of kernels the bar (the largest ratio allowed), the largest ratio, and the kernels that miss the bar. The
exit code is 1 if an error exceeds its bound, a bound is looser than its class allows, or a kernel has no bound. A
computation that several kernels share on equal boxes is measured once.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from pathlib import Path

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.bounds import BUDGET, OutputBound, bound_outputs, bound_tasks
from symrot.certificates.rounding.intervals import DIGITS
from symrot.certificates.rounding.library import library_problem, operations_of, prepare
from symrot.errors import InputError
from symrot.kernels.library import definition, kernel_names
from tests.campaigns.certificates.rounding_measured import Measured, measure

__all__ = ["CLASSES", "Class", "Row", "class_of", "compare", "loosest", "rows", "table"]


@dataclass(frozen=True)
class Class:
    """Kernels that share a bar: the largest allowed ratio of bound to measured error, infinite for no limit.

    A kernel belongs to the first class with a beginning and an ending of its name.
    """

    title: str
    loosest: float
    starts: tuple[str, ...]
    ends: tuple[str, ...] = ("",)


CLASSES = (
    Class("angles of a quaternion", 4.0, ("euler_",), ("_of_quaternion",)),
    Class("other parameters of a quaternion", 4.0, ("rotation_vector_", "rodrigues_", "mrp_"), ("_of_quaternion",)),
    Class("angular acceleration, full tensor", 12.0, ("euler_equations_tensor", "rigid_body_tensor")),
    Class("angular acceleration, other bodies", 4.0, ("euler_equations_",)),
    Class("quaternion kernels", 1.5, ("quaternion_",)),
    Class("Euler rates", 4.0, ("euler_",), ("_rates",)),
    Class("Euler sequences: matrix, Jacobian, quaternion", 4.0, ("euler_",)),
    Class("all others", inf, ("",)),
)  # fmt: skip
LONGER = 10  # times as many points where a bound looks loose
POINTS = 100_000


@dataclass(frozen=True)
class Row:
    """One output with its measured error and its bound, both in units of 2^-53 or 2^-24."""

    kernel: str
    precision: str
    output: str
    measured: float
    bound: float
    at: tuple[tuple[str, float], ...]

    @property
    def ratio(self) -> float:
        """Return the bound divided by the measured error; 1 if both are zero."""
        return self.bound / self.measured if self.measured else 1.0

    @property
    def holds(self) -> bool:
        """Return whether the error is within the bound."""
        return self.measured <= self.bound

    @property
    def tight(self) -> bool:
        """Return whether the bound is as near to the error as its class demands."""
        return self.ratio <= loosest(self.kernel)


def class_of(kernel: str) -> Class:
    """Return the class of a kernel."""
    return next(each for each in CLASSES if kernel.startswith(each.starts) and kernel.endswith(each.ends))


def loosest(kernel: str) -> float:
    """Return the largest ratio of bound to measured error of a kernel."""
    return class_of(kernel).loosest


def compare(
    operations: Operations, bounds: Sequence[OutputBound], measured: Sequence[Measured], kernel: str
) -> list[Row]:
    """Return a row for each output."""
    unit = 2.0 ** -DIGITS[operations.precision]
    return [
        Row(kernel, operations.precision, each.output, errors.error / unit, each.bound / unit, errors.at)
        for each, errors in zip(bounds, measured, strict=True)
    ]


def rows(name: str, text: str, points: int, seed: int = 1, budget: int = BUDGET, suffixes: str = "df") -> list[Row]:
    """Return the rows of a kernel's double ("d") and float ("f") functions."""
    return [
        row
        for suffix, operations in zip("df", operations_of(name, text), strict=True)
        if suffix in suffixes
        for row in _rows(name, operations, points, seed, budget)
    ]


def _rows(name: str, operations: Operations, points: int, seed: int, budget: int) -> list[Row]:
    problem = library_problem(definition(name), operations)
    bounds = bound_outputs(operations, problem.box, problem.region, budget)
    rows = compare(operations, bounds, measure(operations, problem.box, bounds, problem.region, points, seed), name)
    if not all(row.tight for row in rows):  # a larger error may only be rare: look for it longer
        loose = [each for each, row in zip(bounds, rows, strict=True) if not row.tight]
        more = measure(operations, problem.box, loose, problem.region, LONGER * points, seed + 1)
        again = {row.output: row for row in compare(operations, loose, more, name)}
        rows = [max(row, again.get(row.output, row), key=lambda each: each.measured) for row in rows]
    return rows


def _keys(name: str, text: str) -> dict[tuple[str, str], str]:
    """Return a mapping (precision, output) -> key; equal computations of kernels have equal keys."""
    keys = {}
    for operations in operations_of(name, text):
        problem = library_problem(definition(name), operations)
        for output, task in bound_tasks(operations, problem.box, problem.region).items():
            keys[operations.precision, output] = task.key
    return keys


@dataclass(frozen=True)
class _Work:
    name: str
    text: str
    suffixes: str


def _measured(work: _Work, points: int) -> list[Row] | str:
    try:
        return rows(work.name, work.text, points, suffixes=work.suffixes)
    except InputError as error:
        return str(error)


def table(texts: Mapping[str, str], points: int = POINTS, workers: int = 2) -> Iterator[tuple[str, list[Row] | str]]:
    """Yield the rows of each kernel, or the reason why it has no bound; a computation that several kernels share is measured once.

    Parameters
    ----------
    texts : mapping
        Kernel -> C text.
    points : int
        Per kernel and precision; ``LONGER`` times as many for outputs whose bound looks loose.
    workers : int
        Processes.
    """
    keys = {name: _keys(name, text) for name, text in texts.items()}
    seen: set[str] = set()
    work = []
    for name, text in texts.items():
        suffixes = ""
        for suffix, precision in zip("df", DIGITS, strict=True):
            own = {key for (kind, _), key in keys[name].items() if kind == precision}
            suffixes += suffix if own - seen else ""
            seen |= own
        work.append(_Work(name, text, suffixes))
    known: dict[str, Row] = {}
    with ProcessPoolExecutor(workers) as pool:
        for each, rows in zip(work, pool.map(partial(_measured, points=points), work), strict=True):
            if isinstance(rows, str):
                yield each.name, rows
                continue
            for row in rows:
                key = keys[each.name][row.precision, row.output]
                known[key] = max(row, known.get(key, row), key=lambda row: row.measured)
            yield (
                each.name,
                [replace(known[key], kernel=each.name, output=output) for (_, output), key in keys[each.name].items()],
            )


def _line(rows: Sequence[Row]) -> str:
    loose = max(rows, key=lambda row: (not row.holds, row.ratio))
    verdict = "BROKEN" if not loose.holds else "" if all(row.tight for row in rows) else "LOOSE"
    text = f"{loose.output:16s} measured {loose.measured:10.4g}  bound {loose.bound:10.4g}"
    return f"{loose.kernel:34s} {loose.precision} {text}  ratio {loose.ratio:6.3g} {verdict}".rstrip()


def class_lines(all_rows: Iterable[Row]) -> list[str]:
    """Return lines for each class (bar, kernels, largest ratio and its place, kernels that miss the bar)."""
    rows = list(all_rows)
    lines = []
    for each in CLASSES:
        own = [row for row in rows if class_of(row.kernel) is each]
        if not own:
            continue
        worst = max(own, key=lambda row: row.ratio)
        missing = sorted({row.kernel for row in own if not row.tight})
        count = len({row.kernel for row in own})
        bar = f"{each.loosest:4.3g}" if each.loosest < inf else "none"
        lines.append(
            f"{each.title:48s} bar {bar}  {count:3d} kernels  largest ratio {worst.ratio:7.4g} "
            f"({worst.kernel}, {worst.output}, {worst.precision})"
        )
        lines += [f"  misses: {', '.join(missing)}"] if missing else []
    return lines


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each kernel and precision, then a line for each class."""
    parser = ArgumentParser(description="Measured rounding errors against their bounds.")
    parser.add_argument("kernels", nargs="*", help="names (default: all)")
    parser.add_argument("--points", type=int, default=POINTS, help=f"points per kernel ({POINTS})")
    parser.add_argument("--workers", type=int, default=2, help="processes (2)")
    parser.add_argument("--generated", type=Path, default=Path("generated"), help="folder of kernels (./generated)")
    options = parser.parse_args(arguments)
    texts = {
        name: (options.generated / "c" / f"{name}.c").read_text(encoding="utf-8")
        for name in options.kernels or kernel_names()
    }
    prepare(texts.items(), options.workers)
    every: list[Row] = []
    failed = 0
    for name, rows in table(texts, options.points, options.workers):
        if isinstance(rows, str):
            failed += 1
            print(f"{name:34s} no bound: {rows}", flush=True)
            continue
        for precision in DIGITS:
            print(_line([row for row in rows if row.precision == precision]), flush=True)
        every += rows
    print("\n".join(class_lines(every)))
    broken = sum(not row.holds for row in every)
    print(f"{len(every)} outputs, {broken} errors above their bounds, {failed} kernels without bounds")
    return 1 if failed or not all(row.holds and row.tight for row in every) else 0


if __name__ == "__main__":
    sys.exit(main())
