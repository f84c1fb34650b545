"""Measured rounding errors against their bounds, for all kernels: ``python -m symrot.certify.rounding_campaign``.

Prints for each kernel and precision the output with the largest ratio of bound and measured error; exit code 1 if an
error is larger than its bound, or a bound looser than its family allows.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from symrot.certify.operations import Operations
from symrot.certify.rounding import BUDGET, OutputBound, bound_outputs
from symrot.certify.rounding_intervals import DIGITS
from symrot.certify.rounding_library import operations_of, prepare, problem
from symrot.certify.rounding_measured import Measured, measure
from symrot.errors import InputError
from symrot.kernels.library import definition, kernel_names

__all__ = ["LOOSEST", "Row", "compare", "loosest", "rows"]

LOOSEST = {"quaternion_": 1.5, "euler_": 4.0, "euler_equations_tensor": 12.0, "rigid_body_tensor": 12.0}
"""Beginning of a name -> largest ratio of bound and measured error; the longest beginning counts, others have none."""
LONGER = 10  # times as many points where a bound looks loose
OPEN = ("_of_quaternion", "quaternion_of_dcm")  # angles and choices: no bar


@dataclass(frozen=True)
class Row:
    """One output: measured error, bound, both in units of 2^-53 or 2^-24."""

    kernel: str
    precision: str
    output: str
    measured: float
    bound: float
    at: tuple[tuple[str, float], ...]

    @property
    def ratio(self) -> float:
        """The bound over the measured error; 1 where both are zero."""
        return self.bound / self.measured if self.measured else 1.0

    @property
    def holds(self) -> bool:
        """Whether the error is within the bound."""
        return self.measured <= self.bound

    @property
    def tight(self) -> bool:
        """Whether the bound is as near to the error as its family has to be."""
        return self.ratio <= loosest(self.kernel)


def loosest(kernel: str) -> float:
    """Return the largest ratio of bound and measured error of a kernel."""
    starts = [start for start in LOOSEST if kernel.startswith(start)]
    if not starts or any(kernel.endswith(end) for end in OPEN):
        return float("inf")
    return LOOSEST[max(starts, key=len)]


def compare(
    operations: Operations, bounds: Sequence[OutputBound], measured: Sequence[Measured], kernel: str
) -> list[Row]:
    """Return a row for each output."""
    unit = 2.0 ** -DIGITS[operations.precision]
    return [
        Row(kernel, operations.precision, each.output, found.error / unit, each.bound / unit, found.at)
        for each, found in zip(bounds, measured, strict=True)
    ]


def rows(name: str, text: str, points: int, seed: int = 1, budget: int = BUDGET) -> Iterator[list[Row]]:
    """Yield the rows of a kernel's double and float functions."""
    for operations in operations_of(name, text):
        given = problem(definition(name), operations)
        bounds = bound_outputs(operations, given.box, given.region, budget)
        found = compare(operations, bounds, measure(operations, given.box, bounds, given.region, points, seed), name)
        if not all(row.tight for row in found):  # a larger error may only be rare: look for it longer
            more = measure(operations, given.box, bounds, given.region, LONGER * points, seed + 1)
            again = compare(operations, bounds, more, name)
            found = [max(pair, key=lambda row: row.measured) for pair in zip(found, again, strict=True)]
        yield found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line for each kernel and precision."""
    parser = ArgumentParser(description="Measured rounding errors against their bounds.")
    parser.add_argument("kernels", nargs="*", help="names (default: all)")
    parser.add_argument("--points", type=int, default=100_000, help="points per kernel (100000)")
    parser.add_argument("--workers", type=int, default=2, help="processes that bound (2)")
    parser.add_argument("--generated", type=Path, default=Path("generated"), help="folder of kernels (./generated)")
    options = parser.parse_args(arguments)
    texts = {
        name: (options.generated / "c" / f"{name}.c").read_text(encoding="utf-8")
        for name in options.kernels or kernel_names()
    }
    prepare(texts.items(), options.workers)
    failed = 0
    for name, text in texts.items():
        try:
            for found in rows(name, text, options.points):
                loose = max(found, key=lambda row: (not row.holds, row.ratio))
                verdict = "BROKEN" if not loose.holds else "" if all(row.tight for row in found) else "LOOSE"
                failed += bool(verdict)
                said = f"{loose.output:16s} measured {loose.measured:10.4g}  bound {loose.bound:10.4g}"
                print(f"{name:34s} {loose.precision} {said}  ratio {loose.ratio:6.3g} {verdict}".rstrip(), flush=True)
        except InputError as error:
            failed += 1
            print(f"{name:34s} no bound: {error}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
