"""Rounding error bounds of the library's kernels: the ranges of inputs on which they hold, and their computation.

A box is a range for each input; a region restricts the inputs further, for example to unit quaternions. Bounds of many
kernels are computed in several processes and put into the store (store.py).
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from math import inf

from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import BUDGET, STORE, BoundTask, Box, bound_task, bound_tasks
from symrot.certificates.rounding.branch_and_bound import SearchResult, search
from symrot.certificates.rounding.output_graph import output_graph
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.errors import InputError
from symrot.kernels.definition import Definition
from symrot.kernels.library import definition

__all__ = ["RoundingProblem", "largest_box", "library_problem", "operations_of", "prepare", "resized"]

CLEARANCE = 0.1  # least length of the vector of arguments of atan2 in the default region: the distance from gimbal lock
STEPS = 12  # bisection steps for the size of the largest box
LARGEST = 2.0**10  # largest size that is tried, relative to the box of the kernel


@dataclass(frozen=True)
class RoundingProblem:
    """The data for bounding a kernel's rounding errors: the box of its inputs, restrictions, and symbols."""

    # a range for each input
    box: Mapping[str, tuple[Fraction, Fraction]]
    # for example, that a quaternion has unit norm
    region: Region
    symbols: Mapping[str, str]  # C name of an input component -> symbol, such as "angles[1]" -> "theta"

    def place(self, name: str) -> str:
        """Return the C name of an input component: ``"q[1]"`` for the ``name`` ``"q[1]"`` or the symbol ``"q1"``.

        InputError is raised for another name.
        """
        for place, symbol in self.symbols.items():
            if name in (place, symbol):
                return place
        raise InputError(f"expected an input, one of {', '.join(self.symbols.values())}, got {name!r}")


def library_problem(kernel: Definition, operations: Operations) -> RoundingProblem:
    """Return the ranges of a library kernel's inputs, and restrictions such as the unit norm of a quaternion.

    There are restrictions only if the kernel calls atan2.
    """
    symbols = {place: component[0] for each in kernel.inputs for place, component in each.places.items()}
    box = {place: kernel.box[symbol] for place, symbol in symbols.items()}
    # a matrix is any nine numbers in [-1, 1], a quaternion any four
    if not any(node[0] == "call" and node[1] == "atan2" for node in operations.nodes):
        return RoundingProblem(box, EVERYWHERE, symbols)
    quaternions = tuple(
        tuple(f"{each.name}[{i}]" for i in range(4))
        for each in kernel.inputs
        if [component[0][1:] for component in each.components] == list("0123")
    )
    graphs = (output_graph(operations, index) for _, index in operations.outputs)
    angles = any(node[0] == "atan2" for graph in graphs for node in graph.nodes)
    # angles from a quaternion: unit norm, at least 1/10 away from the points where an angle is undefined
    return RoundingProblem(box, Region(quaternions, CLEARANCE if angles else 0.0), symbols)


def operations_of(name: str, text: str) -> tuple[Operations, Operations]:
    """Read the C text of the kernel ``name``; return the operations of its function for doubles, and for floats."""
    function, file = f"symrot_{name}", f"{name}.c"
    return read_kernel(text, function, file), read_kernel(text, f"{function}f", file)


def _search_task(task: BoundTask) -> SearchResult:
    return search(task.graph, task.box, task.region, task.budget, task.libm_ulp)


def prepare(
    kernels: Iterable[tuple[str, str]], workers: int = 2, budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
    progress: Callable[[str], object] = lambda text: None, with_table: bool = True,
) -> int:  # fmt: skip
    """Compute those error bounds of library kernels that are not stored, in several processes, and store them.

    Equal tasks of different kernels are computed once.

    Parameters
    ----------
    kernels : iterable of (name, C text)
        The kernels whose outputs are bounded.
    workers : int
        Number of processes; with 1 the bounds are computed in this process.
    budget, libm_ulp
        As for :func:`symrot.certificates.rounding.bounds.bound_outputs`.
    progress : callable
        Called with a line of text after each bound, if several processes work.
    with_table : bool
        Whether to use the bounds in the table that comes with symrot.

    Returns
    -------
    int
        The number of bounds that were computed.
    """
    waiting: dict[str, BoundTask] = {}
    for name, text in kernels:
        for operations in operations_of(name, text):
            problem = library_problem(definition(name), operations)
            for task in bound_tasks(operations, problem.box, problem.region, budget, libm_ulp).values():
                if STORE.get(task.key, with_table) is None:
                    waiting[task.key] = task
    largest_first = sorted(waiting.values(), key=lambda task: (-len(task.graph.nodes) * len(task.low), task.key))
    if workers == 1 or len(waiting) < 2:
        for task in largest_first:
            bound_task(task, fresh=True)  # the table may have a bound by an earlier method
        return len(waiting)
    with ProcessPoolExecutor(workers) as pool:
        for number, (task, result) in enumerate(zip(largest_first, pool.map(_search_task, largest_first), strict=True)):
            STORE.put(task.key, result)
            progress(f"bounding {number + 1} of {len(waiting)} ..")
    return len(waiting)


def resized(box: Box, size: float, places: Sequence[str]) -> dict[str, tuple[Fraction, Fraction]]:
    """Return a box in which the ranges of the inputs ``places`` are ``size`` times as wide, with the same middles."""
    wider = dict(box)
    for place in places:
        low, high = box[place]
        middle, half = (low + high) / 2, (high - low) / 2 * Fraction(size)
        wider[place] = (middle - half, middle + half)
    return wider


def largest_box(
    operations: Operations, box: Box, target: float, places: Sequence[str] | None = None, region: Region = EVERYWHERE,
    budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
) -> tuple[float, dict[str, tuple[Fraction, Fraction]]]:  # fmt: skip
    """Return (size, box): the largest size found at which no rounding error on the box exceeds ``target``.

    The ranges of the inputs ``places`` (default: all) are ``size`` times as wide, with the same middles: for size 2,
    1 to 3 becomes 0 to 4. The size is found by doubling and bisection and is at most 1024.

    Raises
    ------
    InputError
        If no size meets the target, a name in ``places`` is not an input, or the target is not a positive number.
    """
    if not 0 < target < inf:
        raise InputError(f"expected a target error above 0, such as 1e-13, got {target!r}")
    chosen = list(box) if places is None else list(places)
    for place in chosen:
        if place not in box:
            raise InputError(
                f"{operations.name}: expected an input that can vary, one of {', '.join(box)}, got {place!r}"
            )

    def holds(size: float) -> bool:
        tasks_by_output = bound_tasks(operations, resized(box, size, chosen), region, budget, libm_ulp)
        return all(
            search(task.graph, task.box, task.region, budget, libm_ulp, target).bound <= target
            for task in tasks_by_output.values()
        )

    low, high = 0.0, 1.0
    if not holds(low):
        raise InputError(
            f"{operations.name}: expected a target error of at least the error at the midpoints of the ranges, got "
            f"{target:g}"
        )
    while holds(high):
        low, high = high, 2 * high
        if high > LARGEST:
            return low, resized(box, low, chosen)
    # bisection, after doubling
    for _ in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    if not low:
        raise InputError(
            f"{operations.name}: expected a target error of at least the error bound on narrow ranges around the "
            f"midpoints of the ranges, got {target:g}, which is less; choose a larger target"
        )
    return low, resized(box, low, chosen)
