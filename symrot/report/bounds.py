"""The bounds of the rounding errors of a kernel, as `symrot bound` prints them."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from symrot import number
from symrot.certify.operations import Operations
from symrot.certify.readback import read_kernel
from symrot.certify.rounding import bound_outputs, rounding_section
from symrot.certify.rounding_adjoint import UNIT_NORM, Region
from symrot.certify.rounding_intervals import DIGITS
from symrot.certify.rounding_library import Problem, largest_box, problem
from symrot.errors import InputError
from symrot.interface import emit
from symrot.kernels.library import definition, kernel_names
from symrot.report.layout import columns
from symrot.scene_reader import nearest

__all__ = ["facts", "given", "lines", "target_facts", "target_lines"]

PRECISIONS = {"double": "", "float": "f"}


def given(kernel: str, ranges: Sequence[str], precision: str) -> tuple[Operations, Problem, dict[str, Any]]:
    """Return the operations of a kernel of the library, its problem, and its box with some ranges replaced."""
    if kernel not in kernel_names():
        hint = nearest(kernel, kernel_names())
        said = f"expected the name of a kernel (see `symrot emit --list`), got {kernel[:60]!r}"
        raise InputError(f"{said} ({hint})" if hint else said)
    operations = read_kernel(emit(kernel).source, f"{kernel}{PRECISIONS[precision]}", f"{kernel}.c")
    found = problem(definition(kernel), operations)
    box = dict(found.box)
    for text in ranges:
        name, sign, ends = text.partition("=")
        low, colon, high = ends.partition(":")
        if not sign or not colon:
            raise InputError(f"--box: expected NAME=LOW:HIGH, such as theta=-1.4:1.4, got {text[:60]!r}")
        box[found.place(name.strip())] = _end(low, text), _end(high, text)
    return operations, found, box


def _end(text: str, whole: str) -> Fraction:
    return number.read(text.strip(), f"--box {whole[:60]}")


def facts(kernel: str, ranges: Sequence[str], precision: str) -> dict[str, Any]:
    """Return the bounds of a kernel on its box, with some ranges replaced: link 4 as plain data.

    Parameters
    ----------
    kernel : str
        A kernel of the library.
    ranges : sequence of str
        ``NAME=LOW:HIGH``, by component ("theta") or place ("angles[1]"); the others are the kernel's own.
    precision : str
        ``"double"`` or ``"float"``.

    Raises
    ------
    InputError
        For a kernel or a range that is none, or a box on which an output has no bound.
    """
    operations, found, box = given(kernel, ranges, precision)
    return {"kernel": operations.name} | rounding_section(operations, None, box, found.region)


def _said_box(box: Mapping[str, Any]) -> str:
    return ", ".join(f"{place} {_short(low)} .. {_short(high)}" for place, (low, high) in box.items())


def _short(value: Any) -> str:
    return f"{float.fromhex(value) if isinstance(value, str) else float(value):.6g}"


def _region_lines(region: Region) -> list[str]:
    found = [f"      {', '.join(group)}: squares add up to 1, but for {UNIT_NORM:.1g}" for group in region.unit]
    if region.clearance:
        found.append(f"      every atan2 with arguments of length at least {region.clearance:g}")
    return found


def lines(section: Mapping[str, Any]) -> list[str]:
    """Return the bounds as lines for people."""
    part = section["precisions"][0]
    region = Region(tuple(map(tuple, section["unit_groups"])), float.fromhex(section["clearance"]))
    unit = f"2^-{DIGITS[part['precision']]}"
    rows = [
        (each["output"], f"{float.fromhex(each['absolute']):.3e}", f"{each['units']} * {unit}",
         ("" if each["converged"] else f"not below {float.fromhex(each['pointwise']):.3e} by this method")
         + (" (modulo whole turns)" if each["modulo_turns"] else ""))
        for each in part["outputs"]
    ]  # fmt: skip
    choices = sorted({choice for each in part["outputs"] for choice in each["choices"]})
    return [
        f"{section['kernel']}: no error is larger than", *columns(rows),
        f"for {_said_box(section['box'])}", *_region_lines(region),
        f"assuming {'; '.join(section['assumptions'])}",
        *(f"choice as computed: {choice}" for choice in choices),
    ]  # fmt: skip


def target_facts(
    kernel: str, ranges: Sequence[str], precision: str, target: float, variables: Sequence[str]
) -> dict[str, Any]:
    """Return the largest box on which no error of a kernel is larger than a target.

    Parameters
    ----------
    kernel, ranges, precision
        As for :func:`facts`; the box that is resized about its middle.
    target : float
        The largest error that is allowed.
    variables : sequence of str
        Inputs whose ranges are resized; all if there are none.
    """
    operations, found, box = given(kernel, ranges, precision)
    places = [found.place(name) for name in variables] or None
    size, largest = largest_box(operations, box, target, places, found.region)
    bounds = bound_outputs(operations, largest, found.region)
    return {
        "kernel": operations.name, "target": target, "size": size,
        "box": {place: [float(low).hex(), float(high).hex()] for place, (low, high) in largest.items()},
        "largest_error": max(each.bound for each in bounds).hex(),
        "unit_groups": [list(group) for group in found.region.unit], "clearance": float(found.region.clearance).hex(),
    }  # fmt: skip


def target_lines(found: Mapping[str, Any]) -> list[str]:
    """Return the largest box as lines for people."""
    region = Region(tuple(map(tuple, found["unit_groups"])), float.fromhex(found["clearance"]))
    return [
        f"{found['kernel']}: no error is larger than {found['target']:g}",
        f"for {_said_box(found['box'])}", *_region_lines(region),
        f"the box given, {found['size']:.6g} times as wide about its middle",
    ]  # fmt: skip
