"""Bounds of the rounding error of a kernel's outputs on a box of inputs: the ``rounding`` section of a certificate.

A bound limits the absolute error of an output against the exact formula at the same floating-point inputs. No number
overflows on the box. A section can be checked quickly at single points, or computed again.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import frexp, inf, isfinite, ldexp, nextafter
from sys import float_info
from typing import Any

import numpy as np

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.adjoint import LIBM_ULP, evaluate
from symrot.certificates.rounding.branch_and_bound import SearchResult, search
from symrot.certificates.rounding.intervals import DIGITS, Array
from symrot.certificates.rounding.output_graph import OutputGraph, output_graph
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.certificates.rounding.store import Store
from symrot.errors import CertificateError, InputError
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
    "check_bounds",
    "check_section",
    "error_at_point",
    "rounding_section",
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
        return hashlib.sha256(repr(contents).encode()).hexdigest()

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
            f"{operations.name}: expected groups of inputs with unit norm to contain only the inputs {known}, "
            f"got {strangers[0]}"
        )
    tasks_by_output = {}
    for place, index in operations.outputs:
        graph = output_graph(operations, index)
        low = tuple(_outward(box[name][0], -inf) for name in graph.places)
        high = tuple(_outward(box[name][1], inf) for name in graph.places)
        used = tuple(group for group in region.unit if set(group) & set(graph.places))
        atan2 = any(node[0] == "atan2" for node in graph.nodes)
        own = Region(used, region.clearance if atan2 else 0.0)
        tasks_by_output[place] = BoundTask(graph, low, high, own, budget, libm_ulp)
    return tasks_by_output


def _outward(value: Fraction, direction: float) -> float:
    """Return a fraction rounded to a float toward ``direction``, -inf or inf, so that a range never becomes smaller."""
    near = float(value)
    exact = Fraction(near)
    return near if exact == value or (exact < value) == (direction < 0) else nextafter(near, direction)


def _check_box(operations: Operations, box: Box) -> None:
    """Raise InputError if a box lacks a finite range for an input, or has a range for an unknown input."""
    unknown = sorted(set(box) - set(operations.inputs))
    if unknown:
        raise InputError(
            f"{operations.name}: expected a box of {', '.join(operations.inputs)}, got a range of {unknown[0]}"
        )
    for place in operations.inputs:
        if place not in box:
            raise InputError(f"{operations.name}: expected a range of {place} in the box, but it is missing")
        low, high = box[place]
        if not all((isinstance(x, Fraction) or isfinite(x)) and abs(Fraction(x)) <= LARGEST for x in (low, high)):
            raise InputError(f"{operations.name}: expected a finite range of {place}, got {show(low)} to {show(high)}")
        if low > high:
            raise InputError(
                f"{operations.name}: expected a range of {place} from its least to its largest value, "
                f"got {show(low)} to {show(high)}"
            )


def bound_task(task: BoundTask, fresh: bool = False) -> SearchResult:
    """Return the stored error bound for a task, or the result of a search if none is stored or ``fresh`` is true."""
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
        _output_bound(operations, place, task, bound_task(task, fresh))
        for place, task in bound_tasks(operations, box, region, budget, libm_ulp).items()
    )


def _output_bound(operations: Operations, place: str, task: BoundTask, result: SearchResult) -> OutputBound:
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
    choices = tuple(_choice_phrases(task))
    return OutputBound(
        place, result.bound, result.pointwise, at, float(scale), result.evaluations, result.converged, result.turns,
        choices, task.graph.contraction_safe,
    )  # fmt: skip


def _choice_phrases(task: BoundTask) -> list[str]:
    return [f"{text}, by whole turns" if turns else text for text, turns in task.graph.choices]


# --- the section of the certificate -----------------------------------------------------------------------------------

MEANING = (
    "absolute error of the computed output against the exact formula at the same floating-point inputs; "
    "choices are followed as computed"
)


def _assumptions(libm_ulp: float) -> list[str]:
    return [
        "IEEE 754, rounding to nearest, subnormal numbers kept; operations as written, fused only where it is said",
        f"sin, cos and atan2 within {libm_ulp:g} unit in the last place; sin and cos within [-1, 1], sincos alike",
        "each constant is the floating-point number nearest to its exact value in the formula; "
        "series leave out at most a quarter of a unit in the last place",
    ]


def rounding_section(
    operations_double: Operations, operations_float: Operations | None, box: Box, region: Region = EVERYWHERE,
    budget: int = BUDGET, libm_ulp: float = LIBM_ULP, fresh: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Return the ``rounding`` section of a certificate as data for JSON, the same bytes on every machine.

    Parameters
    ----------
    operations_double, operations_float : Operations
        The operations of the one-sample functions for doubles (NAME) and for floats (NAMEf, or None without one).
    box, region, budget, libm_ulp, fresh
        As for :func:`bound_outputs`; :func:`symrot.certificates.rounding.library.library_problem` returns box and
        region of a library kernel.

    Returns
    -------
    dict
        Numbers are hexadecimal text. The keys are:

        - "meaning", "assumptions": what a bound states, and what it presupposes; text.
        - "libm_ulp", "budget": the arguments. "box": ``{place: [low, high]}``.
        - "unit_groups", "clearance": the fields ``unit`` and ``clearance`` of ``region``.
        - "precisions": a list with an item for each function: its "precision", the hash of its operations
          ("operations_sha256"), its "unit" (2^-53 or 2^-24) and its "outputs". Each output has the fields of
          :class:`OutputBound`, with "absolute" for ``bound`` and "modulo_turns" for ``turns``, and "units": the bound
          in multiples of "unit", rounded up, as decimal text.

    Raises
    ------
    InputError
        In the cases of :func:`bound_outputs`.
    """
    kernels = [operations_double] if operations_float is None else [operations_double, operations_float]
    return _section_head(box, region, budget, libm_ulp) | {
        "precisions": [_bounded_precision(kernel, box, region, budget, libm_ulp, fresh) for kernel in kernels]
    }


def _section_head(box: Box, region: Region, budget: int, libm_ulp: float) -> dict[str, Any]:
    """Return the first part of the section ``rounding`` of a certificate: meaning, assumptions, box, region and budget.

    The arguments are those of :func:`bound_outputs`.
    """
    return {
        "meaning": MEANING, "assumptions": _assumptions(libm_ulp), "libm_ulp": float(libm_ulp).hex(), "budget": budget,
        "box": {place: [_outward(low, -inf).hex(), _outward(high, inf).hex()] for place, (low, high) in box.items()},
        "unit_groups": [list(group) for group in region.unit], "clearance": float(region.clearance).hex(),
    }  # fmt: skip


def _bounded_precision(
    operations: Operations, box: Box, region: Region, budget: int, libm_ulp: float, fresh: bool
) -> dict[str, Any]:
    unit = 2.0 ** -DIGITS[operations.precision]
    bounds = bound_outputs(operations, box, region, budget, libm_ulp, fresh)
    return _precision_part(operations, [_plain_output(bound, unit) for bound in bounds])


def _precision_part(operations: Operations, outputs: list[dict[str, Any]]) -> dict[str, Any]:
    unit = 2.0 ** -DIGITS[operations.precision]
    return {
        "precision": operations.precision, "operations_sha256": operations.digest(), "unit": unit.hex(),
        "outputs": outputs,
    }  # fmt: skip


def _alike(a: object, b: object) -> bool:
    """Return whether two values have the same JSON text; unlike ``==``, this distinguishes true from 1."""
    return json.dumps(a, sort_keys=True) == json.dumps(b, sort_keys=True)


def _differing(section: Mapping[str, Any], own: Mapping[str, Any]) -> str | None:
    """Return the first name, in order of the alphabet, whose entries differ; None if the mappings are equal."""
    names = sorted({*section, *own})
    return next(
        (name for name in names if not (name in section and name in own and _alike(section[name], own[name]))), None
    )


def _plain_output(bound: OutputBound, unit: float) -> dict[str, Any]:
    return {
        "output": bound.output, "absolute": bound.bound.hex(), "units": _units(Fraction(bound.bound) / Fraction(unit)),
        "pointwise": bound.pointwise.hex(), "at": {name: x.hex() for name, x in bound.at},
        "scale": bound.scale.hex(), "evaluations": bound.evaluations, "converged": bound.converged,
        "modulo_turns": bound.turns, "choices": list(bound.choices),
        "contraction_safe": bound.contraction_safe,
    }  # fmt: skip


def _units(value: Fraction) -> str:
    """Return a number as decimal text, rounded up to four digits, or to four decimals below 1: 2/3 -> ``0.6667``."""
    if value == 0:
        return "0"
    exponent = len(str(int(value))) - 1 if value >= 1 else -1
    step = Fraction(10) ** (exponent - 3)
    digits = -(-value // step)
    if exponent < 9:
        return f"{float(digits * step):.{max(3 - exponent, 0)}f}"
    if digits == 10**4:
        digits, exponent = 10**3, exponent + 1
    return f"{digits // 1000}.{digits % 1000:03}0e+{exponent:02}"


def check_section(
    section: Mapping[str, Any], operations_double: Operations, operations_float: Operations | None, rerun: bool = False
) -> None:
    """Check a ``rounding`` section by evaluating the error at single points; with ``rerun``, compute all bounds again.

    Raises
    ------
    CertificateError
        If the section is wrong; the message names the wrong part.
    """
    kernels = {kernel.precision: kernel for kernel in (operations_double, operations_float) if kernel is not None}
    try:
        box = {
            place: (Fraction(float.fromhex(low)), Fraction(float.fromhex(high)))
            for place, (low, high) in section["box"].items()
        }
        region = Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))
        libm_ulp, budget = float.fromhex(section["libm_ulp"]), int(section["budget"])
        for part in section["precisions"]:
            _check_precision(part, kernels[part["precision"]], box, region, libm_ulp)
        # ``check_bounds`` proves that the bounds hold on the whole box; here no bound may be below the error at a point
        precisions = [part["precision"] for part in section["precisions"]]
    except (CertificateError, KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        if isinstance(error, CertificateError | InputError):
            raise CertificateError(str(error)) from None
        raise CertificateError(
            f"expected a section of rounding bounds with all its parts, got a section with a fault ({error})"
        ) from None
    if precisions != list(kernels):
        raise CertificateError(
            f"expected bounds of rounding errors for the kernel in {' and '.join(kernels)} precision, "
            f"got bounds for {' and '.join(precisions) or 'no precision'}"
        )
    head = _section_head(box, region, budget, libm_ulp)
    name = _differing({name: value for name, value in section.items() if name != "precisions"}, head)
    if name is not None:
        raise CertificateError(
            f"expected the entry {name!r} of the section 'rounding' as symrot prints it, got another text; certify the "
            "kernel again"
        )
    if rerun:
        check_bounds(section, operations_double, operations_float, fresh=True)


def check_bounds(
    section: Mapping[str, Any], operations_double: Operations, operations_float: Operations | None, fresh: bool = False
) -> None:
    """Check every bound of a section that :func:`check_section` accepted, against symrot's own bound.

    A bound that symrot has stored for the same task is used unless ``fresh`` is true; otherwise it is computed.

    Raises
    ------
    CertificateError
        If a bound differs; the message names the first such output.
    """
    region = Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))
    box = {
        place: (Fraction(float.fromhex(low)), Fraction(float.fromhex(high)))
        for place, (low, high) in section["box"].items()
    }
    if not 0 <= section["budget"] <= BUDGET:
        raise CertificateError(
            f"expected a search for bounds with at most {BUDGET} evaluations of boxes, got {section['budget']}"
        )
    for operations, part in zip((operations_double, operations_float), section["precisions"], strict=False):
        if operations is None:
            continue
        unit, libm_ulp = 2.0 ** -DIGITS[operations.precision], float.fromhex(section["libm_ulp"])
        name = _differing({**part, "outputs": []}, _precision_part(operations, []))
        if name is not None:
            raise CertificateError(
                f"{operations.name}: expected the entry {name!r} in 'precisions' as symrot prints it, got another "
                "text; certify the kernel again"
            )
        tasks_by_output = bound_tasks(operations, box, region, section["budget"], libm_ulp)
        for item, (place, task) in zip(part["outputs"], tasks_by_output.items(), strict=True):
            try:
                recomputed = _plain_output(_output_bound(operations, place, task, bound_task(task, fresh)), unit)
            except InputError as reason:
                raise CertificateError(str(reason)) from None
            if not _alike(item, recomputed):
                raise CertificateError(
                    f"{operations.name}: expected the certificate's error bound of {place} to be {recomputed['units']} "
                    f"units of {unit:g}, as symrot computes it now on the same ranges, got {item['units']} units or "
                    "other details; certify the kernel again"
                )


def _check_precision(
    part: Mapping[str, Any], operations: Operations, box: Box, region: Region, libm_ulp: float
) -> None:
    """Check the part of a ``rounding`` section about doubles or floats, by evaluating the error at single points."""
    name = operations.name
    # ``operations`` are those of the C function of this type
    if part["operations_sha256"] != operations.digest():
        raise CertificateError(
            f"{name}: expected bounds for the operations in the C text, got bounds for other operations"
        )
    tasks_by_output = bound_tasks(operations, box, region, 0, libm_ulp)
    unit = 2.0 ** -DIGITS[operations.precision]
    if [item["output"] for item in part["outputs"]] != list(tasks_by_output) or float.fromhex(part["unit"]) != unit:
        raise CertificateError(
            f"{name}: expected bounds of {', '.join(tasks_by_output)} in units of {unit:g}, got other outputs or units"
        )
    for item in part["outputs"]:
        task, bound = tasks_by_output[item["output"]], float.fromhex(item["absolute"])
        at = np.array([float.fromhex(item["at"][place]) for place in task.graph.places])
        if not isfinite(bound) or bound < 0 or item["units"] != _units(Fraction(bound) / Fraction(unit)):
            raise CertificateError(
                f"{name}: expected a finite error bound of {item['output']}, the same in 'absolute' and in 'units' of "
                f"{unit:g}, got {bound!r} and {item['units']}"
            )
        choices, safe = _choice_phrases(task), task.graph.contraction_safe
        if item["choices"] != choices or item["contraction_safe"] is not safe:
            raise CertificateError(
                f"{name}: expected 'choices' and 'contraction_safe' of {item['output']} as they follow from the C text "
                f"({choices} and {safe}), got others"
            )
        if at.size and not ((task.box[0] <= at) & (at <= task.box[1])).all():
            raise CertificateError(
                f"{name}: expected a point inside the box as the worst point of {item['output']}, got a point outside"
            )
        least = error_at_point(task, at)
        # a bound below the error at its stored point is refuted
        if not least <= float.fromhex(item["pointwise"]) * (1 + 1e-9) or float.fromhex(item["pointwise"]) > bound:
            raise CertificateError(
                f"{name}: expected an error bound of {item['output']} of at least {least / unit:.6g} units of "
                f"{unit:g}, because the error at the stored worst point can be that large, got {item['units']} units"
            )


def error_at_point(task: BoundTask, at: Array) -> float:
    """Return the error bound at the single point ``at``, which is at most that of a box with this point.

    The result is 0 if there is no bound, and -1 if the task's region does not contain the point.
    """
    point = np.stack([at, at])[:, :, None]
    evaluation = evaluate(
        task.graph, point, np.full((len(task.graph.conditions), 1), -1, np.int8), task.region, task.libm_ulp
    )
    # -1 if the point is outside the task's region of allowed inputs
    value = float(evaluation.bound[0])
    # 0 refutes no bound
    return value if isfinite(value) else 0.0
