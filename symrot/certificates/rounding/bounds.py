"""Link 4 of a certificate: bounds of the rounding error of a kernel's outputs on a box of inputs.

For the certificate: :func:`rounding_section` returns plain data that is the same, byte for byte, on every machine;
:func:`check_section` verifies it, at once what a point evaluation can tell and, with ``rerun``, everything.

What is bounded is the absolute error of each output against the exact formula (link 3) at the same floating-point
inputs. Where a choice compares rounded numbers, the exact formula is followed along the branch that the kernel took;
such choices are listed. An angle whose choices wrap it is compared modulo whole turns. Every number on the way is
finite on the box, so that nothing overflows.
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
from symrot.certificates.rounding.branch_and_bound import Search, search
from symrot.certificates.rounding.intervals import DIGITS, Array
from symrot.certificates.rounding.output_graph import Cone, cone_of
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.certificates.rounding.store import Store
from symrot.errors import CertificateError, InputError
from symrot.formula.exact_numbers import show

__all__ = ["BUDGET", "STORE", "Box", "OutputBound", "Task", "bound_outputs", "bound_task", "check_bounds",
           "check_section", "reached", "rounding_section", "tasks"]  # fmt: skip

Box = Mapping[str, tuple[Fraction, Fraction]]  # place of an input, such as "q[1]" -> least and largest value

BUDGET = 100_000  # evaluations of boxes per output
LARGEST, LARGEST_EXPONENT = Fraction(float_info.max), 1023  # of a double, and of a power of two that is one
STORE = Store()


@dataclass(frozen=True)
class OutputBound:
    """The bound of one output: no error is larger than ``bound``; by the same method a point reaches ``pointwise``.

    ``at`` is that point; ``scale`` a power of two not below the values met (or 2^1023); ``turns``: the error is that
    modulo whole turns; ``choices`` are the comparisons of rounded numbers, whose branch is taken as computed;
    ``contraction_safe``: the bound holds for fused multiply-adds too.
    """

    output: str
    bound: float
    pointwise: float
    at: tuple[tuple[str, float], ...]
    scale: float
    evaluations: int
    converged: bool
    turns: bool
    choices: tuple[str, ...]
    contraction_safe: bool


@dataclass(frozen=True)
class Task:
    """The bound of one computation on one box: equal ones of different kernels are found once."""

    cone: Cone
    low: tuple[float, ...]
    high: tuple[float, ...]
    region: Region
    budget: int
    libm_ulp: float

    @property
    def key(self) -> str:
        """A name that equal tasks have in common."""
        numbers = {place: k for k, place in enumerate(self.cone.places)}
        groups = sorted(tuple(numbers.get(place, -1) for place in group) for group in self.region.unit)
        ends = [x.hex() for x in (*self.low, *self.high)]
        said = [self.cone.digest, ends, groups, self.region.clearance, self.budget, self.libm_ulp]
        return hashlib.sha256(repr(said).encode()).hexdigest()

    @property
    def box(self) -> Array:
        """Least and largest value of each input, shape (2, inputs)."""
        return np.array([self.low, self.high])


def tasks(
    operations: Operations, box: Box, region: Region = EVERYWHERE, budget: int = BUDGET, libm_ulp: float = LIBM_ULP
) -> dict[str, Task]:
    """Return what has to be bounded for each output.

    Raises
    ------
    InputError
        For a box with a range that is missing, unknown, reversed or not finite; for a region of other inputs.
    """
    _check_box(operations, box)
    strangers = sorted({place for group in region.unit for place in group} - set(operations.inputs))
    if strangers:
        known = ", ".join(operations.inputs)
        raise InputError(f"{operations.name}: expected unit groups of {known}, got {strangers[0]}")
    found = {}
    for place, index in operations.outputs:
        cone = cone_of(operations, index)
        low = tuple(_outward(box[name][0], -inf) for name in cone.places)
        high = tuple(_outward(box[name][1], inf) for name in cone.places)
        used = tuple(group for group in region.unit if set(group) & set(cone.places))
        atan2 = any(node[0] == "atan2" for node in cone.nodes)
        own = Region(used, region.clearance if atan2 else 0.0)
        found[place] = Task(cone, low, high, own, budget, libm_ulp)
    return found


def _outward(value: Fraction, direction: float) -> float:
    near = float(value)
    exact = Fraction(near)
    return near if exact == value or (exact < value) == (direction < 0) else nextafter(near, direction)


def _check_box(operations: Operations, box: Box) -> None:
    unknown = sorted(set(box) - set(operations.inputs))
    if unknown:
        raise InputError(
            f"{operations.name}: expected a box of {', '.join(operations.inputs)}, got one of {unknown[0]}"
        )
    for place in operations.inputs:
        if place not in box:
            raise InputError(f"{operations.name}: expected a range of {place} in the box, got none")
        low, high = box[place]
        if not all((isinstance(x, Fraction) or isfinite(x)) and abs(Fraction(x)) <= LARGEST for x in (low, high)):
            raise InputError(f"{operations.name}: expected a finite range of {place}, got {show(low)} to {show(high)}")
        if low > high:
            raise InputError(
                f"{operations.name}: expected a range of {place} from its least to its largest value, "
                f"got {show(low)} to {show(high)}"
            )


def bound_task(task: Task, fresh: bool = False) -> Search:
    """Return the bound of one computation, from the store if it is known and ``fresh`` does not forbid it."""
    known = None if fresh else STORE.get(task.key)
    if known is None:
        with np.errstate(all="ignore"):  # ranges may be points
            known = search(task.cone, task.box, task.region, task.budget, task.libm_ulp)
        STORE.put(task.key, known)
    return known


def bound_outputs(
    operations: Operations, box: Box, region: Region = EVERYWHERE, budget: int = BUDGET, libm_ulp: float = LIBM_ULP,
    fresh: bool = False,
) -> tuple[OutputBound, ...]:  # fmt: skip
    """Return the bound of each output on a box.

    Parameters
    ----------
    operations : Operations
        As read back from C (:func:`symrot.certificates.readback.readback.read_kernel`).
    box : mapping
        Place of an input, such as ``"q[1]"`` -> least and largest value, both exact.
    region : Region
        What holds in the box beyond its sides.
    budget : int
        Evaluations of boxes per output.
    libm_ulp : float
        Largest error of sin, cos and atan2, in units in the last place.
    fresh : bool
        Bound again what the cache knows.

    Raises
    ------
    InputError
        For a box that cannot be one, or on which an output has no bound: it says which and near where.
    """
    return tuple(
        _found(operations, place, task, bound_task(task, fresh))
        for place, task in tasks(operations, box, region, budget, libm_ulp).items()
    )


def _found(operations: Operations, place: str, task: Task, found: Search) -> OutputBound:
    at = tuple(zip(task.cone.places, found.worst, strict=True))
    if found.bound == inf:
        inputs = task.cone.inputs_of[found.obstacle]
        where = ", ".join(f"{name} = {x:.6g}" for k, (name, x) in enumerate(at) if k in inputs)
        what = task.cone.text(found.obstacle)
        raise InputError(
            f"{operations.name}: expected a box without singular points, got one where {place} has no bound: "
            f"{what} is not known to stay away from its singular values near {where}"
        )
    mantissa, exponent = frexp(found.largest_value)
    power = min(exponent - (mantissa == 0.5), LARGEST_EXPONENT)
    scale = ldexp(1.0, power) if found.largest_value > 0 else 1.0
    choices = tuple(_said_choices(task))
    return OutputBound(
        place, found.bound, found.pointwise, at, float(scale), found.evaluations, found.converged, found.turns, choices,
        task.cone.contraction_safe,
    )  # fmt: skip


def _said_choices(task: Task) -> list[str]:
    return [f"{text}, by whole turns" if turns else text for text, turns in task.cone.choices]


# --- the section of the certificate -----------------------------------------------------------------------------------

MEANING = (
    "absolute error of the computed output against the exact formula at the same floating-point inputs; "
    "choices are followed as computed"
)


def _assumptions(libm_ulp: float) -> list[str]:
    return [
        "IEEE 754, rounding to nearest, subnormal numbers kept; operations as written, fused only where it is said",
        f"sin, cos and atan2 within {libm_ulp:g} unit in the last place; sin and cos within [-1, 1], sincos alike",
        "link 3: constants are rounded to nearest from what it reads; "
        "series leave out at most a quarter of a unit in the last place",
    ]


def rounding_section(
    operations_double: Operations, operations_float: Operations | None, box: Box, region: Region = EVERYWHERE,
    budget: int = BUDGET, libm_ulp: float = LIBM_ULP, fresh: bool = False,
) -> dict[str, Any]:  # fmt: skip
    """Return link 4 of a certificate as plain data, numbers as hexadecimal text: the same bytes on every machine.

    Parameters
    ----------
    operations_double, operations_float : Operations
        The one-sample functions NAME and NAMEf as read back; the second may be left out (None).
    box, region, budget, libm_ulp, fresh
        As for :func:`bound_outputs`; :func:`symrot.certificates.rounding.library.problem` gives those of a library
        kernel.

    Returns
    -------
    dict
        ``{"meaning", "assumptions", "libm_ulp", "budget", "box": {place: [hex, hex]}, "unit_groups", "clearance",
        "precisions": [{"precision", "operations_sha256", "unit", "outputs": [..]}]}``, each output with ``"output",
        "absolute", "units", "pointwise", "at", "scale", "evaluations", "converged", "modulo_turns", "choices",
        "contraction_safe"``; ``absolute`` is the bound, ``units`` the same in units of ``unit`` (2^-53 or 2^-24),
        rounded up.

    Raises
    ------
    InputError
        As :func:`bound_outputs`.
    """
    kernels = [operations_double] if operations_float is None else [operations_double, operations_float]
    return _question(box, region, budget, libm_ulp) | {
        "precisions": [_precision(kernel, box, region, budget, libm_ulp, fresh) for kernel in kernels]
    }


def _question(box: Box, region: Region, budget: int, libm_ulp: float) -> dict[str, Any]:
    """Return what bounds are asked for, in the one way in which it is written."""
    return {
        "meaning": MEANING, "assumptions": _assumptions(libm_ulp), "libm_ulp": float(libm_ulp).hex(), "budget": budget,
        "box": {place: [_outward(low, -inf).hex(), _outward(high, inf).hex()] for place, (low, high) in box.items()},
        "unit_groups": [list(group) for group in region.unit], "clearance": float(region.clearance).hex(),
    }  # fmt: skip


def _precision(
    operations: Operations, box: Box, region: Region, budget: int, libm_ulp: float, fresh: bool
) -> dict[str, Any]:
    unit = 2.0 ** -DIGITS[operations.precision]
    bounds = bound_outputs(operations, box, region, budget, libm_ulp, fresh)
    return _part(operations, [_output(found, unit) for found in bounds])


def _part(operations: Operations, outputs: list[dict[str, Any]]) -> dict[str, Any]:
    unit = 2.0 ** -DIGITS[operations.precision]
    return {
        "precision": operations.precision, "operations_sha256": operations.digest(), "unit": unit.hex(),
        "outputs": outputs,
    }  # fmt: skip


def _alike(a: object, b: object) -> bool:
    """Tell whether two values are the same text: true is not 1."""
    return json.dumps(a, sort_keys=True) == json.dumps(b, sort_keys=True)


def _output(found: OutputBound, unit: float) -> dict[str, Any]:
    return {
        "output": found.output, "absolute": found.bound.hex(), "units": _units(Fraction(found.bound) / Fraction(unit)),
        "pointwise": found.pointwise.hex(), "at": {name: x.hex() for name, x in found.at},
        "scale": found.scale.hex(), "evaluations": found.evaluations, "converged": found.converged,
        "modulo_turns": found.turns, "choices": list(found.choices),
        "contraction_safe": found.contraction_safe,
    }  # fmt: skip


def _units(value: Fraction) -> str:
    """Return a number in decimal, four digits, rounded up."""
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
    """Verify what a point evaluation can tell of link 4 of a certificate; with ``rerun``: everything, from nothing.

    At once: that it is about these operations and all their outputs, that its numbers are finite, in order and written
    as they are printed, and that no bound is below what the method finds at the stored point. That bounds hold on the
    whole box, :func:`check_bounds` proves.

    Raises
    ------
    CertificateError
        Saying what does not hold.
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
        said = [part["precision"] for part in section["precisions"]]
    except (CertificateError, KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        if isinstance(error, CertificateError | InputError):
            raise CertificateError(str(error)) from None
        raise CertificateError(
            f"expected a section of rounding bounds, got one without or with a bad {error}"
        ) from None
    if said != list(kernels):
        raise CertificateError(f"expected bounds for {' and '.join(kernels)}, got {' and '.join(said) or 'none'}")
    question = _question(box, region, budget, libm_ulp)
    if not _alike({name: value for name, value in section.items() if name != "precisions"}, question):
        raise CertificateError("expected a box and assumptions as this method prints them, got others")
    if rerun:
        check_bounds(section, operations_double, operations_float, fresh=True)


def check_bounds(
    section: Mapping[str, Any], operations_double: Operations, operations_float: Operations | None, fresh: bool = False
) -> None:
    """Verify every bound of a section that :func:`check_section` verified, by bounding again, up to the first other.

    ``fresh``: from nothing; otherwise what the store knows is not found again. No more evaluations than BUDGET.

    Raises
    ------
    CertificateError
        Saying which bound does not hold.
    """
    region = Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))
    box = {
        place: (Fraction(float.fromhex(low)), Fraction(float.fromhex(high)))
        for place, (low, high) in section["box"].items()
    }
    if not 0 <= section["budget"] <= BUDGET:
        raise CertificateError(f"expected a budget of at most {BUDGET} evaluations of boxes, got {section['budget']}")
    for operations, part in zip((operations_double, operations_float), section["precisions"], strict=False):
        if operations is None:
            continue
        unit, libm_ulp = 2.0 ** -DIGITS[operations.precision], float.fromhex(section["libm_ulp"])
        if not _alike({**part, "outputs": []}, _part(operations, [])):
            raise CertificateError(f"{operations.name}: expected a part of bounds as it is printed, got another")
        wanted = tasks(operations, box, region, section["budget"], libm_ulp)
        for item, (place, task) in zip(part["outputs"], wanted.items(), strict=True):
            try:
                found = _output(_found(operations, place, task, bound_task(task, fresh)), unit)
            except InputError as reason:
                raise CertificateError(str(reason)) from None
            if not _alike(item, found):
                raise CertificateError(
                    f"{operations.name}: expected what bounding again finds of {place} on the box of the certificate, "
                    f"{found['units']} units, got something else ({item['units']} units)"
                )


def _check_precision(
    part: Mapping[str, Any], operations: Operations, box: Box, region: Region, libm_ulp: float
) -> None:
    name = operations.name
    if part["operations_sha256"] != operations.digest():
        raise CertificateError(f"{name}: expected bounds of these operations, got those of others")
    wanted = tasks(operations, box, region, 0, libm_ulp)
    unit = 2.0 ** -DIGITS[operations.precision]
    if [item["output"] for item in part["outputs"]] != list(wanted) or float.fromhex(part["unit"]) != unit:
        raise CertificateError(f"{name}: expected bounds of {', '.join(wanted)}")
    for item in part["outputs"]:
        task, said = wanted[item["output"]], float.fromhex(item["absolute"])
        at = np.array([float.fromhex(item["at"][place]) for place in task.cone.places])
        if not isfinite(said) or said < 0 or item["units"] != _units(Fraction(said) / Fraction(unit)):
            raise CertificateError(f"{name}: expected a finite bound of {item['output']}, got {item['units']}")
        choices, safe = _said_choices(task), task.cone.contraction_safe
        if item["choices"] != choices or item["contraction_safe"] is not safe:
            raise CertificateError(f"{name}: expected the choices of {item['output']} as they are in its operations")
        if at.size and not ((task.box[0] <= at) & (at <= task.box[1])).all():
            raise CertificateError(f"{name}: expected a point of the box for {item['output']}, got another")
        least = reached(task, at)
        if not least <= float.fromhex(item["pointwise"]) * (1 + 1e-9) or float.fromhex(item["pointwise"]) > said:
            raise CertificateError(
                f"{name}: expected a bound of {item['output']} of at least {least / unit:.6g} units, "
                f"which a point of the box reaches, got {item['units']}"
            )


def reached(task: Task, at: Array) -> float:
    """Return what the method finds at one point, the least over the branches that are open there: no bound is below."""
    point = np.stack([at, at])[:, :, None]
    found = evaluate(task.cone, point, np.full((len(task.cone.conditions), 1), -1, np.int8), task.region, task.libm_ulp)
    value = float(found.bound[0])
    return value if isfinite(value) else 0.0
