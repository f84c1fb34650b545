"""Print the table of bounds that comes with symrot: ``python -m symrot.workshop.bound_table``.

Bounds what changed since, on two processes; with another method (its sources differ) everything. Exit code 1 with
``--check`` if the table is not what would be printed, as far as that is told by looking at one point of each box.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from symrot.certificates.rounding.bounds import STORE, Task, reached, tasks
from symrot.certificates.rounding.branch_and_bound import Search
from symrot.certificates.rounding.library import operations_of, prepare, problem
from symrot.certificates.rounding.store import TABLE, method, printed_table, table
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.codegen.printing.c_source import DOUBLE, FLOAT, c_source
from symrot.files.writing import write
from symrot.kernels.library import definition, kernel_names

__all__ = ["library_tasks", "missing", "understated"]

SPARE = 1e-9  # relative, for another order of additions


def _texts() -> dict[str, str]:
    """Return the C text of each kernel, whose head says nothing of rounding."""
    return {
        name: c_source(kernel_program(name), kernel_description(definition(name), "c"), (DOUBLE, FLOAT), True)
        for name in kernel_names()
    }


def library_tasks() -> dict[str, Task]:
    """Return what has to be bounded for all kernels of the library, by key."""
    found: dict[str, Task] = {}
    for name, text in _texts().items():
        for operations in operations_of(name, text):
            given = problem(definition(name), operations)
            found |= {task.key: task for task in tasks(operations, given.box, given.region).values()}
    return found


def missing() -> list[str]:
    """Return what is wrong with the table, in sentences; nothing if it is complete and of this method."""
    wanted, known = library_tasks(), table()["bounds"]
    said = [] if table()["method"] == method() else ["the bounds of the table were found by another method"]
    if lacking := len(set(wanted) - set(known)):
        said.append(f"{lacking} bounds are not in the table")
    if others := len(set(known) - set(wanted)):
        said.append(f"{others} bounds of the table are of nothing in the library")
    if wrong := understated({key: task for key, task in wanted.items() if key in known}):
        said.append(f"{len(wrong)} bounds are below what a point of their box reaches, the first that of {wrong[0]}")
    return said


def understated(wanted: Mapping[str, Task]) -> list[str]:
    """Return the keys of bounds in the table that a point of their box, the one they name as worst, contradicts."""
    return [key for key, task in wanted.items() if not _may_be(task, STORE.get(key))]


def _may_be(task: Task, kept: Search | None) -> bool:
    """Return whether a bound is finite and not below what the method finds at the point that it names."""
    if kept is None or len(kept.worst) != len(task.low):
        return False
    at = np.array(kept.worst)
    inside = bool(((task.box[0] <= at) & (at <= task.box[1])).all())
    return inside and reached(task, at) <= kept.pointwise * (1 + SPARE) and kept.pointwise <= kept.bound < inf


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table, or check it."""
    parser = ArgumentParser(prog="python -m symrot.workshop.bound_table", description="Bounds of the library.")
    parser.add_argument("--check", action="store_true", help="compare only")
    parser.add_argument("--workers", type=int, default=2, help="processes (2)")
    options = parser.parse_args(arguments)
    if options.check:
        print("\n".join(missing()) or "the table is complete")
        return 1 if missing() else 0
    trusted = table()["method"] == method()
    prepare(_texts().items(), options.workers, progress=lambda line: print(line, file=sys.stderr), with_table=trusted)
    found = [(key, STORE.get(key, trusted)) for key in library_tasks()]
    text = printed_table((key, each) for key, each in found if each is not None)
    write(TABLE, lambda stream: stream.write(text.encode()))
    print(f"{TABLE.name}: {len(found)} bounds")
    return 0


if __name__ == "__main__":
    sys.exit(main())
