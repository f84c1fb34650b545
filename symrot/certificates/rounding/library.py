"""Rounding bounds of the kernels of the library: their boxes, all of them on several processes, the largest box.

For the certificate: :func:`problem` gives the box and region of a kernel, :func:`prepare` bounds all of them on some
processes at once, so that :func:`symrot.certificates.rounding.bounds.rounding_section` finds each in the store.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from math import inf

from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import BUDGET, STORE, Box, Task, bound_task, tasks
from symrot.certificates.rounding.branch_and_bound import Search, search
from symrot.certificates.rounding.output_graph import cone_of
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.errors import InputError
from symrot.kernels.definition import Definition
from symrot.kernels.library import definition

__all__ = ["Problem", "largest_box", "operations_of", "prepare", "problem", "resized"]

CLEARANCE = 0.1  # least length of the arguments of an atan2 in the default region: the distance from gimbal lock
STEPS = 12  # halvings of the interval that holds the size of the largest box
LARGEST = 2.0**10  # times the size of the kernel's own box


@dataclass(frozen=True)
class Problem:
    """The box and the region on which a kernel of the library is bounded, and the symbols of its places."""

    box: Mapping[str, tuple[Fraction, Fraction]]
    region: Region
    symbols: Mapping[str, str]  # place -> component, such as "angles[1]" -> "theta"

    def place(self, name: str) -> str:
        """Return the place of an input, by place or component; ``InputError`` for none."""
        for place, symbol in self.symbols.items():
            if name in (place, symbol):
                return place
        raise InputError(f"expected an input, one of {', '.join(self.symbols.values())}, got {name!r}")


def problem(found: Definition, operations: Operations) -> Problem:
    """Return the box and region of a kernel.

    The region is the whole box, rotation or not: a matrix is any nine numbers in [-1, 1], a quaternion any four. But
    for kernels that take angles of a quaternion: those are bounded for unit quaternions, at a distance of 1/10 from the
    points where an angle is not defined.
    """
    symbols = {
        (each.name if each.is_scalar else f"{each.name}[{i}]"): component[0]
        for each in found.inputs
        for i, component in enumerate(each.components)
    }
    box = {place: found.box[symbol] for place, symbol in symbols.items()}
    if not any(node[0] == "call" and node[1] == "atan2" for node in operations.nodes):
        return Problem(box, EVERYWHERE, symbols)
    quaternions = tuple(
        tuple(f"{each.name}[{i}]" for i in range(4))
        for each in found.inputs
        if [component[0][1:] for component in each.components] == list("0123")
    )
    cones = (cone_of(operations, index) for _, index in operations.outputs)
    angles = any(node[0] == "atan2" for cone in cones for node in cone.nodes)
    return Problem(box, Region(quaternions, CLEARANCE if angles else 0.0), symbols)


def operations_of(name: str, text: str) -> tuple[Operations, Operations]:
    """Return the double and the float function of a kernel's C text."""
    double, single = (read_kernel(text, f"symrot_{name}{suffix}", f"{name}.c") for suffix in ("", "f"))
    return double, single


def _work(task: Task) -> Search:
    return search(task.cone, task.box, task.region, task.budget, task.libm_ulp)


def prepare(
    kernels: Iterable[tuple[str, str]], workers: int = 2, budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
    progress: Callable[[str], object] = lambda text: None, with_table: bool = True,
) -> int:  # fmt: skip
    """Bound the outputs of kernels of the library, each computation once, and keep what was found in the store.

    Parameters
    ----------
    kernels : iterable of (name, C text)
    workers : int
        Processes; 1 works in this one.
    budget, libm_ulp
        As for :func:`symrot.certificates.rounding.bounds.bound_outputs`.
    progress : callable
        Takes a line of text, now and then.
    with_table : bool
        Whether the bounds that come with symrot are not to be found again.

    Returns
    -------
    int
        How many computations had to be bounded.
    """
    waiting: dict[str, Task] = {}
    for name, text in kernels:
        for operations in operations_of(name, text):
            given = problem(definition(name), operations)
            for task in tasks(operations, given.box, given.region, budget, libm_ulp).values():
                if STORE.get(task.key, with_table) is None:
                    waiting[task.key] = task
    largest_first = sorted(waiting.values(), key=lambda task: (-len(task.cone.nodes) * len(task.low), task.key))
    if workers == 1 or len(waiting) < 2:
        for task in largest_first:
            bound_task(task)
        return len(waiting)
    with ProcessPoolExecutor(workers) as pool:
        for number, (task, found) in enumerate(zip(largest_first, pool.map(_work, largest_first), strict=True)):
            STORE.put(task.key, found)
            progress(f"bounding {number + 1} of {len(waiting)} ..")
    return len(waiting)


def resized(box: Box, size: float, places: Sequence[str]) -> dict[str, tuple[Fraction, Fraction]]:
    """Return a box whose ranges at some places are ``size`` times as wide, about the same middles."""
    found = dict(box)
    for place in places:
        low, high = box[place]
        middle, half = (low + high) / 2, (high - low) / 2 * Fraction(size)
        found[place] = (middle - half, middle + half)
    return found


def largest_box(
    operations: Operations, box: Box, target: float, places: Sequence[str] | None = None, region: Region = EVERYWHERE,
    budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
) -> tuple[float, dict[str, tuple[Fraction, Fraction]]]:  # fmt: skip
    """Return the largest size, and the box of that size, on which every error is proven to be at most ``target``.

    Sizes are multiples of the widths of ``box``, about its middle, at ``places`` only if they are given. They are
    found by doubling and halving, to 1 part in 2^12.

    Raises
    ------
    InputError
        For a target that no size reaches, a place that is none, or a target that is not a positive number.
    """
    if not 0 < target < inf:
        raise InputError(f"expected a target error above 0, such as 1e-13, got {target!r}")
    chosen = list(box) if places is None else list(places)
    for place in chosen:
        if place not in box:
            raise InputError(f"{operations.name}: expected one of {', '.join(box)}, got {place!r}")

    def holds(size: float) -> bool:
        wanted = tasks(operations, resized(box, size, chosen), region, budget, libm_ulp)
        return all(
            search(task.cone, task.box, task.region, budget, libm_ulp, target).bound <= target
            for task in wanted.values()
        )

    low, high = 0.0, 1.0
    if not holds(low):
        raise InputError(
            f"{operations.name}: expected a target that is reached in the middle of the box, got {target:g}"
        )
    while holds(high):
        low, high = high, 2 * high
        if high > LARGEST:
            return low, resized(box, low, chosen)
    for _ in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    if not low:
        raise InputError(f"{operations.name}: expected a target that a box of some size has, got {target:g}")
    return low, resized(box, low, chosen)
