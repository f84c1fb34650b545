"""The section ``rounding`` of a certificate: bounds of the rounding errors of a kernel's outputs on a box of inputs.

A section can be checked quickly, by evaluating the error at single points, or completely, by computing all bounds
again.
"""

import json
from collections.abc import Mapping
from fractions import Fraction
from math import inf, isfinite
from typing import Any

import numpy as np

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.adjoint import LIBM_ULP
from symrot.certificates.rounding.bounds import (
    BUDGET,
    Box,
    OutputBound,
    bound_outputs,
    bound_task,
    bound_tasks,
    choice_phrases,
    error_at_point,
    output_bound,
    outward,
)
from symrot.certificates.rounding.intervals import DIGITS
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.errors import CertificateError, InputError

__all__ = ["box_of", "check_bounds", "check_section", "region_of", "rounding_section"]

MEANING = (
    "absolute error of the computed output against the exact formula at the same floating-point inputs; "
    "a conditional takes the branch that its computed condition selects"
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
        - "unit_groups": groups of inputs whose squares add up to 1, such as a quaternion (``region.unit``).
        - "clearance": the least length of the arguments (y, x) of every atan2 (``region.clearance``).
        - "precisions": a list with an item for each function: its "precision", the hash of its operations
          ("operations_sha256"), its "unit" (2^-53 or 2^-24) and its "outputs". Each output has the fields of
          :class:`OutputBound`, with "absolute" for ``bound`` and "modulo_turns" for ``turns`` (whether the error of an
          angle is measured modulo 2 pi), and "units": the bound in multiples of "unit", rounded up, as decimal text.

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
        "box": {place: [outward(low, -inf).hex(), outward(high, inf).hex()] for place, (low, high) in box.items()},
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
    """Return a number as decimal text, rounded upward: four significant digits, or four decimals if it is below 1.

    2/3 gives ``0.6667``.
    """
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


def box_of(section: Mapping[str, Any]) -> dict[str, tuple[Fraction, Fraction]]:
    """Return the box on which the bounds in a certificate's section ``rounding`` hold.

    It is a map from each input, such as ``"q[1]"``, to its range.
    """
    return {
        place: (Fraction(float.fromhex(low)), Fraction(float.fromhex(high)))
        for place, (low, high) in section["box"].items()
    }


def region_of(section: Mapping[str, Any]) -> Region:
    """Return the restrictions of inputs under which the bounds in a certificate's section ``rounding`` hold.

    An example is the unit norm of a quaternion.
    """
    return Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))


def check_section(
    section: Mapping[str, Any], operations_double: Operations, operations_float: Operations | None, rerun: bool = False
) -> None:
    """Check a certificate's section ``rounding`` at single points; with ``rerun``, compute all its bounds again.

    At each point that the section stores for an output, the error is evaluated; the stored bound must not be below it.

    Raises
    ------
    CertificateError
        If the section is wrong; the message names the wrong part.
    """
    kernels = {kernel.precision: kernel for kernel in (operations_double, operations_float) if kernel is not None}
    try:
        box, region = box_of(section), region_of(section)
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
    box, region = box_of(section), region_of(section)
    if not 0 <= section["budget"] <= BUDGET:
        raise CertificateError(
            f"expected a 'budget' of 0 to {BUDGET}, the number of boxes of inputs that the search for the error bound "
            f"of one output may evaluate, got {section['budget']}"
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
                recomputed = _plain_output(output_bound(operations, place, task, bound_task(task, fresh)), unit)
            except InputError as reason:
                raise CertificateError(str(reason)) from None
            if not _alike(item, recomputed):
                raise CertificateError(
                    f"{operations.name}: expected the error bound that symrot computes for {place} on the same ranges, "
                    f"{recomputed['units']} units of {unit:g}, got {item['units']} units; the entry "
                    f"{_differing(item, recomputed)!r} differs; certify the kernel again"
                )


def _check_precision(
    part: Mapping[str, Any], operations: Operations, box: Box, region: Region, libm_ulp: float
) -> None:
    """Check one item of "precisions" in a section ``rounding``, by evaluating the error at single points.

    The item has the bounds of the function for doubles, or of that for floats.
    """
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
                f"{name}: {item['output']}: expected 'absolute' and 'units' (multiples of {unit:g}) to state the same "
                f"finite error bound of at least 0, got {bound!r} and {item['units']}"
            )
        choices, safe = choice_phrases(task), task.graph.contraction_safe
        if item["choices"] != choices:
            raise CertificateError(
                f"{name}: {item['output']}: expected 'choices', the conditions of the C text that compare rounded "
                f"numbers, to be {choices}, got {item['choices']}; certify the kernel again"
            )
        if item["contraction_safe"] is not safe:
            raise CertificateError(
                f"{name}: {item['output']}: expected 'contraction_safe' (whether the bound also holds with fused "
                f"multiply-adds) to be {safe}, got {item['contraction_safe']}; certify the kernel again"
            )
        if at.size and not ((task.box[0] <= at) & (at <= task.box[1])).all():
            raise CertificateError(
                f"{name}: {item['output']}: expected 'at', the point with the largest error that the search found, to "
                "be in the ranges of the inputs, got a point outside; certify the kernel again"
            )
        least = error_at_point(task, at)
        # a bound below the error at its stored point is refuted
        if not least <= float.fromhex(item["pointwise"]) * (1 + 1e-9) or float.fromhex(item["pointwise"]) > bound:
            raise CertificateError(
                f"{name}: expected an error bound of {item['output']} of at least {least / unit:.6g} units of "
                f"{unit:g}, since the error can be that large at the point 'at' of the certificate, got "
                f"{item['units']} units; certify the kernel again"
            )
