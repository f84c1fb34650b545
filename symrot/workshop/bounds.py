"""Bounds of the rounding errors of a library kernel or of a scene's kernel, for the command `symrot bound`."""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.bounds import bound_outputs
from symrot.certificates.rounding.bounds_text import region_phrases
from symrot.certificates.rounding.intervals import DIGITS
from symrot.certificates.rounding.library import RoundingProblem, largest_box, library_problem
from symrot.certificates.rounding.region import UNIT_NORM, Region
from symrot.certificates.rounding.scenes import ANY, scene_problem
from symrot.certificates.rounding.section import rounding_section
from symrot.errors import InputError, nearest
from symrot.kernels.library import definition, is_kernel, kernel_names
from symrot.report.layout import apart, columns, hanging
from symrot.scene.file import shipped_names
from symrot.workshop.input_ranges import input_box
from symrot.workshop.kernel_text import KernelText, LibraryText, SceneText, kernel_text

__all__ = ["facts", "lines", "require_known", "rounding_problem", "section", "target_facts", "target_lines"]

EMITTED = (".c", ".h", ".o", ".json")  # suffixes of emitted and compiled files, which are not scene files
PRECISIONS = {"double": "", "float": "f"}


def rounding_problem(
    kernel: KernelText, ranges: Sequence[str], precision: str
) -> tuple[Operations, RoundingProblem, dict[str, Any]]:
    """Return the operations of a kernel, the problem of bounding their rounding errors, and the box of inputs.

    The box has a range for each input: the user's range or, if the user gives none, the kernel's own range.

    Parameters
    ----------
    kernel : KernelText
        A kernel of the library or the kernel of a scene.
    ranges : sequence of str
        ``NAME=LOW:HIGH``, a range that replaces the kernel's own range of an input. NAME is a component ("theta"), an
        index ("angles[1]") or a physical constant of a scene ("A"); the range of a constant determines the ranges of
        the parameters that depend on it.
    precision : str
        ``"double"`` or ``"float"``; the kernel of a scene has only ``"double"``.

    Raises
    ------
    InputError
        For a malformed range, an input without a range, a box without a unit quaternion, or ``"float"`` for the kernel
        of a scene.
    """
    operations, inputs = _operations(kernel, precision), None
    if isinstance(kernel, SceneText):
        inputs = kernel.inputs
        kernel_problem = scene_problem(inputs, operations)
    else:
        kernel_problem = library_problem(definition(kernel.name), operations)
    box = input_box(kernel_problem, inputs, ranges)
    lacking = [f"--box {symbol}=LOW:HIGH" for place, symbol in kernel_problem.symbols.items() if place not in box]
    if lacking:
        message = f"{operations.name}: expected {' '.join(lacking)} in addition to the ranges that the scene gives"
        raise InputError(f"{message}, got {' '.join(ranges)[:60] or 'no range'}")
    for group in kernel_problem.region.unit:
        _check_unit(group, kernel_problem, box)
    return operations, kernel_problem, {place: box[place] for place in operations.inputs}


def _check_unit(
    group: Sequence[str], kernel_problem: RoundingProblem, box: Mapping[str, tuple[Fraction, Fraction]]
) -> None:
    """Raise InputError if the box contains no unit quaternion: a bound on the box would hold for no input."""
    # ``group`` lists the four components of the quaternion, such as "q[1]"
    ends = [sorted(box[place], key=abs) for place in group]
    least = sum(near * near for (near, far) in ends if near * far > 0)
    spare = Fraction(UNIT_NORM)
    if not least - spare <= 1 <= sum(far * far for _, far in ends) + spare:
        ranges = ", ".join(f"{kernel_problem.symbols[place]} {_range_text(*map(float, box[place]))}" for place in group)
        raise InputError(f"--box: expected a box that contains a unit quaternion, got {ranges}")


def _operations(kernel: KernelText, precision: str) -> Operations:
    """Return the operations of a kernel's C function in ``precision``, ``"double"`` or ``"float"``.

    InputError is raised for a scene's kernel in ``"float"``.
    """
    if precision != "double" and isinstance(kernel, SceneText):
        raise InputError(f"--precision: expected double for a scene, whose kernel is in double only, got {precision}")
    # the prefix symrot_ is left out of the operations' name
    name = f"{kernel.name}{PRECISIONS[precision]}"
    return replace(read_kernel(kernel.c()[0], f"symrot_{name}", f"{kernel.name}.c"), name=name)


def require_known(kernel: str) -> None:
    """Raise InputError unless ``kernel`` names a library kernel, a shipped scene, or an existing file.

    Files with the suffixes EMITTED, such as .c, are refused, because they are not scene files.
    """
    path = Path(kernel)
    if is_kernel(kernel) or kernel in shipped_names() or (path.exists() and path.suffix not in EMITTED):
        return
    # a similar name, if there is one
    hint = nearest(path.name, [*kernel_names(), *shipped_names()])
    message = f"expected the name of a kernel (see `symrot emit --list`) or a scene, got {kernel[:60]!r}"
    raise InputError(f"{message} ({hint})" if hint else message)


def _known_text(kernel: str) -> KernelText:
    """Return the :class:`KernelText` of a library or scene kernel: its C source, certificate and other texts.

    InputError is raised for an unknown name.
    """
    require_known(kernel)
    return kernel_text(kernel)


def section(kernel: KernelText, ranges: Sequence[str]) -> dict[str, Any]:
    """Return the section ``rounding`` of a kernel's certificate; for a library kernel it has bounds for floats too."""
    operations, kernel_problem, box = rounding_problem(kernel, ranges, "double")
    single = rounding_problem(kernel, ranges, "float")[0] if isinstance(kernel, LibraryText) else None
    with _in_scene_names(kernel):
        return rounding_section(operations, single, box, kernel_problem.region)


@contextmanager
def _in_scene_names(kernel: KernelText) -> Iterator[None]:
    """Run a ``with`` block, whose InputErrors then name inputs as the scene does: ``omega_3`` instead of ``y[2]``."""
    try:
        yield
    except InputError as reason:
        names = _names(kernel)
        raise InputError(re.sub(r"\w+\[\d+\]", lambda match: names.get(match[0], match[0]), str(reason))) from None


def facts(kernel: str, ranges: Sequence[str], precision: str) -> dict[str, Any]:
    """Return bounds of a kernel's rounding errors on a box of inputs, as plain data for JSON.

    The box has a range for each input: the user's range or, if the user gives none, the kernel's own range.

    Parameters
    ----------
    kernel : str
        A kernel of the library, the name of a shipped scene or the path of a scene file.
    ranges, precision
        As for :func:`rounding_problem`.

    Raises
    ------
    InputError
        In the cases of :func:`rounding_problem`, and for an unknown kernel or a box on which an output has no bound.
    """
    text = _known_text(kernel)
    operations, kernel_problem, box = rounding_problem(text, ranges, precision)
    own = {"kernel": operations.name, "names": _names(text)}
    with _in_scene_names(text):
        return own | rounding_section(operations, None, box, kernel_problem.region)


def _names(kernel: KernelText) -> dict[str, str]:
    """Return a map from input to a scene's name: ``"y[2]"`` -> ``"omega_3"``; empty for a library kernel."""
    if not isinstance(kernel, SceneText):
        return {}
    return {place: symbol for place, (symbol, _) in kernel.inputs.components.items()}


def _box_text(box: Mapping[str, Any], names: Mapping[str, str]) -> str:
    return ", ".join(f"{names.get(place, place)} {_range_text(*map(_value, ends))}" for place, ends in box.items())


def _range_text(low: float, high: float) -> str:
    if (Fraction(low), Fraction(high)) == ANY:
        return "any"
    return " .. ".join(dict.fromkeys(apart(low, high)))


def _value(end: Any) -> float:
    return float.fromhex(end) if isinstance(end, str) else float(end)


def _region_lines(section: Mapping[str, Any]) -> list[str]:
    groups = (tuple(section["names"].get(place, place) for place in group) for group in section["unit_groups"])
    region = Region(tuple(groups), float.fromhex(section["clearance"]))
    return [line for each in region_phrases(region) for line in hanging(f"      {each}", 8)]


def lines(section: Mapping[str, Any]) -> list[str]:
    """Return the lines that `symrot bound` prints; ``section`` is the data of :func:`facts`."""
    part = section["precisions"][0]
    names = section["names"]
    unit = f"2^-{DIGITS[part['precision']]}"
    rows = [
        (names.get(each["output"], each["output"]),
         f"{float.fromhex(each['absolute']):.3e}", f"{each['units']} * {unit}",
         ("" if each["converged"] else f"this method cannot prove a bound below {float.fromhex(each['pointwise']):.3e}")
         + (" (modulo whole turns)" if each["modulo_turns"] else ""))
        for each in part["outputs"]
    ]  # fmt: skip
    choices = sorted({choice for each in part["outputs"] for choice in each["choices"]})
    return [
        f"{section['kernel']}: no error is larger than", *columns(rows),
        *hanging(f"for {_box_text(section['box'], names)}"), *_region_lines(section),
        *hanging(f"assuming {'; '.join(section['assumptions'])}"),
        *(line for choice in choices for line in hanging(f"choice as computed: {choice}")),
    ]  # fmt: skip


def target_facts(
    kernel: str, ranges: Sequence[str], precision: str, target: float, variables: Sequence[str]
) -> dict[str, Any]:
    """Return, as plain data for JSON, the largest box on which no error of a kernel is larger than a target.

    Parameters
    ----------
    kernel, ranges, precision
        As for :func:`facts`; the box is resized about its middle.
    target : float
        The largest error that is allowed, in the unit of the output.
    variables : sequence of str
        The inputs whose ranges are resized. If the sequence is empty, all inputs of a library kernel are resized; for a
        scene, all inputs with a range of nonzero finite width, except the components of the quaternion.
    """
    text = _known_text(kernel)
    operations, kernel_problem, box = rounding_problem(text, ranges, precision)
    places = [kernel_problem.place(name) for name in variables] or (
        None if isinstance(text, LibraryText) else _free(kernel_problem, box)
    )
    for place in places or ():
        if box[place] == ANY:
            name = kernel_problem.symbols[place]
            raise InputError(
                f"--variable {name}: expected an input that {operations.name} uses; it does not use {name}"
            )
    with _in_scene_names(text):
        size, largest = largest_box(operations, box, target, places, kernel_problem.region)
        bounds = bound_outputs(operations, largest, kernel_problem.region)
    return {
        "kernel": operations.name, "names": _names(text), "target": target, "size": size,
        "box": {place: [float(low).hex(), float(high).hex()] for place, (low, high) in largest.items()},
        "largest_error": max(each.bound for each in bounds).hex(),
        "unit_groups": [list(group) for group in kernel_problem.region.unit],
        "clearance": float(kernel_problem.region.clearance).hex(),
    }  # fmt: skip


def _free(kernel_problem: RoundingProblem, box: Mapping[str, tuple[Fraction, Fraction]]) -> list[str]:
    units = {place for group in kernel_problem.region.unit for place in group}
    return [place for place, (low, high) in box.items() if low < high and (low, high) != ANY and place not in units]


def target_lines(resized: Mapping[str, Any]) -> list[str]:
    """Return the lines that `symrot bound --target` prints: ranges of inputs on which no error exceeds the target."""
    # ``size``: one factor makes all of the user's ranges wider or narrower, as far as the target allows
    return [
        f"{resized['kernel']}: no error is larger than {resized['target']:g}",
        *hanging(f"for {_box_text(resized['box'], resized['names'])}"), *_region_lines(resized),
        f"these are the given ranges, {resized['size']:.6g} times as wide about their midpoints",
    ]  # fmt: skip
