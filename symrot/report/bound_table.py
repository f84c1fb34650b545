"""Print the table of bounds that comes with symrot: ``python -m symrot.report.bound_table``.

Bounds what changed since, on two processes; with another method (its sources differ) everything. Exit code 1 with
``--check`` if the table is not what would be printed, as far as that is told without bounding anything.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Sequence

from symrot.certify.rounding import STORE, Task, tasks
from symrot.certify.rounding_library import operations_of, prepare, problem
from symrot.certify.rounding_store import TABLE, method, printed_table, table
from symrot.codegen.c_source import DOUBLE, FLOAT, c_source
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.kernels.library import definition, kernel_names
from symrot.report.files import write

__all__ = ["library_tasks", "missing"]


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
    return said


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table, or check it."""
    parser = ArgumentParser(prog="python -m symrot.report.bound_table", description="Bounds of the library.")
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
