"""Bounds of the rounding errors of a kernel's outputs on a box of inputs.

A bound limits the absolute error of an output against the exact formula at the same floating-point inputs. A finite
bound also shows that no number overflows on the box.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import frexp, inf, isfinite, ldexp, nextafter
from sys import float_info

import numpy as np

from symrot.build.code_digest import text_digest
from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.adjoint import LIBM_ULP, evaluate
from symrot.certificates.rounding.branch_and_bound import SearchResult, search
from symrot.certificates.rounding.intervals import Array
from symrot.certificates.rounding.output_graph import OutputGraph, output_graph
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.certificates.rounding.store import Store
from symrot.errors import InputError
from symrot.formula.exact_numbers import show

__all__ = [
    "BUDGET",
    "STORE",
    "BoundTask",
    "Box",
    "OutputBound",
    "bound_outputs",
    "bound_task",
    "bound_tasks",
    "choice_phrases",
    "error_at_point",
    "output_bound",
    "outward",
]  # fmt: skip

Box = Mapping[str, tuple[Fraction, Fraction]]  # place of an input, such as "q[1]" -> least and largest value

BUDGET = 100_000  # evaluations of boxes per output
LARGEST, LARGEST_EXPONENT = Fraction(float_info.max), 1023  # the largest double; exponent of the largest power of two
STORE = Store()


# Where a conditional compares rounded numbers, the exact formula follows the branch that the kernel took; these choices
# are listed. An angle that is wrapped is compared modulo 2 pi.
@dataclass(frozen=True)
class OutputBound:
    """Bounds of the rounding error of one output."""

    output: str
    # on the whole box
    bound: float
    # at the worst point, ``at``
    pointwise: float
    at: tuple[tuple[str, float], ...]
    # a power of two, at least the largest value of the output at the evaluated points (or 2^1023)
    scale: float
    # number of boxes evaluated
    evaluations: int
    # ``bound`` is at most 2 % above ``pointwise``
    converged: bool
    # the error is measured modulo 2 pi
    turns: bool
    # comparisons of rounded numbers in the C text; the exact formula takes the same branches
    choices: tuple[str, ...]
    # the bound also holds with fused multiply-adds
    contraction_safe: bool


@dataclass(frozen=True)
class BoundTask:
    """The data of one search: bound the rounding error of one output on one box of inputs."""

    # equal tasks of different kernels run once
    graph: OutputGraph
    # ends of the box
    low: tuple[float, ...]
    high: tuple[float, ...]
    region: Region
    # largest number of evaluations
    budget: int
    # largest error of sin, cos and atan2, in units in the last place
    libm_ulp: float

    @property
    def key(self) -> str:
        """The hash under which the bound is stored; equal tasks have equal hashes."""
        numbers = {place: k for k, place in enumerate(self.graph.places)}
        groups = sorted(tuple(numbers.get(place, -1) for place in group) for group in self.region.unit)
        ends = [x.hex() for x in (*self.low, *self.high)]
        contents = [self.graph.digest, ends, groups, self.region.clearance, self.budget, self.libm_ulp]
        return text_digest(repr(contents))

    @property
    def box(self) -> Array:
        """The least and the largest value of each input, as an array of shape (2, inputs)."""
        return np.array([self.low, self.high])


def bound_tasks(
    operations: Operations, box: Box, region: Region = EVERYWHERE, budget: int = BUDGET, libm_ulp: float = LIBM_ULP
) -> dict[str, BoundTask]:
    """Return a map from each output, such as ``"q[1]"``, to the task of bounding its rounding error.

    The arguments are those of :func:`bound_outputs`.

    Raises
    ------
    InputError
        If a range of the box is missing, unknown, reversed or not finite, or if the region is about other inputs.
    """
    _check_box(operations, box)
    strangers = sorted({place for group in region.unit for place in group} - set(operations.inputs))
    if strangers:
        known = ", ".join(operations.inputs)
        raise InputError(
            f"{operations.name}: expected unit vectors whose components are among the inputs {known}, got one with the "
            f"component {strangers[0]}"
        )
    tasks_by_output = {}
    for place, index in operations.outputs:
        graph = output_graph(operations, index)
        low = tuple(outward(box[name][0], -inf) for name in graph.places)
        high = tuple(outward(box[name][1], inf) for name in graph.places)
        used = tuple(group for group in region.unit if set(group) & set(graph.places))
        atan2 = any(node[0] == "atan2" for node in graph.nodes)
        own = Region(used, region.clearance if atan2 else 0.0)
        tasks_by_output[place] = BoundTask(graph, low, high, own, budget, libm_ulp)
    return tasks_by_output


def outward(value: Fraction, direction: float) -> float:
    """Return a fraction rounded to a float toward ``direction``, -inf or inf, so that a range never becomes smaller."""
    near = float(value)
    exact = Fraction(near)
    return near if exact == value or (exact < value) == (direction < 0) else nextafter(near, direction)


def _check_box(operations: Operations, box: Box) -> None:
    """Raise InputError if a box lacks an input, or has an unknown input or a range that is reversed or not finite."""
    unknown = sorted(set(box) - set(operations.inputs))
    if unknown:
        raise InputError(
            f"{operations.name}: expected ranges of {', '.join(operations.inputs)} only, got a range of {unknown[0]}"
        )
    for place in operations.inputs:
        if place not in box:
            raise InputError(f"{operations.name}: expected a range of every input, but that of {place} is missing")
        low, high = box[place]
        if not all((isinstance(x, Fraction) or isfinite(x)) and abs(Fraction(x)) <= LARGEST for x in (low, high)):
            raise InputError(f"{operations.name}: expected a finite range of {place}, got {show(low)} to {show(high)}")
        if low > high:
            raise InputError(
                f"{operations.name}: expected a range of {place} from its least to its largest value, "
                f"got {show(low)} to {show(high)}"
            )


def bound_task(task: BoundTask, fresh: bool = False) -> SearchResult:
    """Return the stored error bound for a task, or the result of a search if none is stored or ``fresh`` is true.

    The result of a search is stored.
    """
    result = None if fresh else STORE.get(task.key)
    if result is None:
        with np.errstate(all="ignore"):  # a range may be a single point
            result = search(task.graph, task.box, task.region, task.budget, task.libm_ulp)
        STORE.put(task.key, result)
    return result


def bound_outputs(
    operations: Operations, box: Box, region: Region = EVERYWHERE, budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
    fresh: bool = False,
) -> tuple[OutputBound, ...]:  # fmt: skip
    """Return the bound of the rounding error of each output on a box.

    Parameters
    ----------
    operations : Operations
        The operations read from the C text (:func:`symrot.certificates.readback.readback.read_kernel`).
    box : mapping
        A map from the place of an input, such as ``"q[1]"``, to its least and its largest value, both exact.
    region : Region
        Restrictions of the inputs in the box.
    budget : int
        The number of evaluated boxes per output at which the search stops.
    libm_ulp : float
        Largest error of sin, cos and atan2, in units in the last place.
    fresh : bool
        Whether to search again for bounds that are in the store.

    Raises
    ------
    InputError
        If the box is not valid, or an output has no bound on the box; the message names the output and a point near the
        singularity.
    """
    return tuple(
        output_bound(operations, place, task, bound_task(task, fresh))
        for place, task in bound_tasks(operations, box, region, budget, libm_ulp).items()
    )


def output_bound(operations: Operations, place: str, task: BoundTask, result: SearchResult) -> OutputBound:
    """Return the bound of the output ``place`` from a search; raise InputError if the bound is infinite."""
    at = tuple(zip(task.graph.places, result.worst, strict=True))
    if result.bound == inf:
        # name a point near the singularity
        inputs = task.graph.inputs_of[result.obstacle]
        where = ", ".join(f"{name} = {x:.6g}" for k, (name, x) in enumerate(at) if k in inputs)
        what = task.graph.text(result.obstacle)
        raise InputError(
            f"{operations.name}: expected ranges on which the error of {place} is bounded, got no bound: near "
            f"{where}, {what} may be singular or overflow; narrow the ranges there"
        )
    mantissa, exponent = frexp(result.largest_value)
    power = min(exponent - (mantissa == 0.5), LARGEST_EXPONENT)
    scale = ldexp(1.0, power) if result.largest_value > 0 else 1.0
    choices = tuple(choice_phrases(task))
    return OutputBound(
        place, result.bound, result.pointwise, at, float(scale), result.evaluations, result.converged, result.turns,
        choices, task.graph.contraction_safe,
    )  # fmt: skip


def choice_phrases(task: BoundTask) -> list[str]:
    """Return the conditions of an output that compare rounded numbers, as text, such as ``"(x[0] + x[1]) >= 0.0"``.

    If the two branches are equal modulo 2 pi, the text ends with ``, by whole turns``.
    """
    return [f"{text}, by whole turns" if turns else text for text, turns in task.graph.choices]


def error_at_point(task: BoundTask, at: Array) -> float:
    """Return the error bound at the single point ``at``: a stored bound for a box with this point must not be lower.

    The result is 0, which contradicts no stored bound, if the bound at the point is infinite; it is -1 if the task's
    region of allowed inputs does not contain the point.
    """
    point = np.stack([at, at])[:, :, None]
    evaluation = evaluate(
        task.graph, point, np.full((len(task.graph.conditions), 1), -1, np.int8), task.region, task.libm_ulp
    )
    value = float(evaluation.bound[0])
    return value if isfinite(value) else 0.0
