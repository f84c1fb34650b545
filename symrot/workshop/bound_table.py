"""The table of rounding-error bounds that comes with symrot; ``python -m symrot.workshop.bound_table`` writes it.

A bound is computed again only if its kernel changed, or the source files that compute bounds (the method). With
``--check`` nothing is written, and the exit code is 1 if the table is out of date.
"""

import sys
from argparse import ArgumentParser
from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from symrot.certificates.rounding.bounds import STORE, BoundTask, bound_tasks, error_at_point
from symrot.certificates.rounding.branch_and_bound import SearchResult
from symrot.certificates.rounding.library import library_problem, operations_of, prepare
from symrot.certificates.rounding.store import TABLE, method, printed_table, table
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.printing.c_function import DOUBLE, FLOAT
from symrot.codegen.printing.c_source import c_functions
from symrot.files.writing import write
from symrot.kernels.library import definition, kernel_names

__all__ = ["library_tasks", "table_faults", "understated"]

SPARE = 1e-9  # relative tolerance: versions of NumPy may add numbers in different orders


def _texts() -> dict[str, str]:
    """Return the C functions of each library kernel as text, by the name of the kernel."""
    # without the comment at the head of a C file: it states the bounds that are to be computed from the text
    return {name: c_functions(kernel_program(name), (DOUBLE, FLOAT), branch_free=True) for name in kernel_names()}


def library_tasks() -> dict[str, BoundTask]:
    """Return a map from each key of the table to its task: to bound the rounding error of one output of a kernel.

    The kernels are all kernels of the library, each with a function for doubles and one for floats.
    """
    by_key: dict[str, BoundTask] = {}
    for name, text in _texts().items():
        for operations in operations_of(name, text):
            kernel_problem = library_problem(definition(name), operations)
            by_key |= {
                task.key: task for task in bound_tasks(operations, kernel_problem.box, kernel_problem.region).values()
            }
    return by_key


def table_faults() -> list[str]:
    """Return the faults of symrot's table of rounding-error bounds, one sentence each.

    The list is empty if the table is complete and up to date.
    """
    tasks, known = library_tasks(), table()["bounds"]
    faults = [] if table()["method"] == method() else ["the table was computed by earlier source files"]
    if lacking := len(set(tasks) - set(known)):
        faults.append(f"{lacking} bounds are not in the table")
    if others := len(set(known) - set(tasks)):
        faults.append(f"{others} bounds of the table belong to no kernel of the library")
    if wrong := understated({key: task for key, task in tasks.items() if key in known}):
        faults.append(
            f"{len(wrong)} bounds are below the error at a point in their input ranges, the first with key {wrong[0]}"
        )
    return faults


def understated(tasks: Mapping[str, BoundTask]) -> list[str]:
    """Return the keys of those tasks that have no finite bound in the store, or one that is certainly too small.

    A task is to bound the rounding error of one output of a kernel on one box of inputs. The store (symrot's table and
    the user's cache) holds with each bound the point of the box at which the search found the largest error. The bound
    is too small if the error at this point, which is computed again, is larger.
    """
    return [key for key, task in tasks.items() if not _is_consistent(task, STORE.get(key))]


def _is_consistent(task: BoundTask, search: SearchResult | None) -> bool:
    """Return whether there is a stored bound that is finite and not smaller than the error at its stored point.

    ``search`` is the stored bound with this point, the one at which the search found the largest error; None if the
    store has no bound for the task.
    """
    if search is None or len(search.worst) != len(task.low):
        return False
    point = np.array(search.worst)
    inside = bool(((task.box[0] <= point) & (point <= task.box[1])).all())
    return (
        inside
        and error_at_point(task, point) <= search.pointwise * (1 + SPARE)
        and search.pointwise <= search.bound < inf
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the table of the library kernels' rounding-error bounds to symrot's folder; return the exit code.

    With ``--check`` the table is only checked; the exit code is 1 if it has faults.
    """
    parser = ArgumentParser(
        prog="python -m symrot.workshop.bound_table",
        description="Write the table of rounding-error bounds of the library.",
    )
    parser.add_argument("--check", action="store_true", help="only check the table")
    parser.add_argument("--workers", type=int, default=2, help="number of processes (default: 2)")
    options = parser.parse_args(arguments)
    if options.check:
        faults = table_faults()
        print("\n".join(faults) or "the table is complete")
        return 1 if faults else 0
    trusted = table()["method"] == method()
    prepare(_texts().items(), options.workers, progress=lambda line: print(line, file=sys.stderr), with_table=trusted)
    searches = [(key, STORE.get(key, trusted)) for key in library_tasks()]
    text = printed_table((key, search) for key, search in searches if search is not None)
    write(TABLE, lambda stream: stream.write(text.encode()))
    print(f"{TABLE.name}: {len(searches)} bounds")
    return 0


if __name__ == "__main__":
    sys.exit(main())
