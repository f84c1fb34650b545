"""The bounds of the rounding errors of a kernel of the library or of a scene, as `symrot bound` prints them."""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.bounds import bound_outputs, rounding_section
from symrot.certificates.rounding.bounds_text import region_in_words
from symrot.certificates.rounding.intervals import DIGITS
from symrot.certificates.rounding.library import Problem, largest_box, problem
from symrot.certificates.rounding.region import UNIT_NORM, Region
from symrot.certificates.rounding.scenes import ANY, SceneInputs, scene_problem
from symrot.errors import InputError
from symrot.kernels.library import definition, kernel_names
from symrot.report.layout import apart, columns
from symrot.scene.file import shipped_names
from symrot.scene.reader import nearest
from symrot.workshop.emit import emit, scene_inputs
from symrot.workshop.input_ranges import boxed

__all__ = ["facts", "given", "lines", "require_known", "section", "target_facts", "target_lines"]

EMITTED = (".c", ".h", ".o", ".json")  # files that are no scenes
PRECISIONS = {"double": "", "float": "f"}


def given(kernel: str, ranges: Sequence[str], precision: str) -> tuple[Operations, Problem, dict[str, Any]]:
    """Return the operations of a kernel of the library or of a scene, its problem, and its box with ranges replaced.

    Parameters
    ----------
    kernel : str
        A kernel of the library, the name of a shipped scene or the path of a scene file.
    ranges : sequence of str
        ``NAME=LOW:HIGH``, by component ("theta"), place ("angles[1]") or physical constant of a scene ("A"), by which
        its parameters are enclosed; the others are the kernel's own.
    precision : str
        ``"double"`` or ``"float"``; a scene has the first alone.

    Raises
    ------
    InputError
        For a kernel or a range that is none, or a range that is lacking.
    """
    operations, found, inputs = (_of_library if kernel in kernel_names() else _of_scene)(kernel, precision)
    box = boxed(found, inputs, ranges)
    lacking = [f"--box {symbol}=LOW:HIGH" for place, symbol in found.symbols.items() if place not in box]
    if lacking:
        said = f"{operations.name}: expected {' '.join(lacking)} beside the ranges that the scene knows"
        raise InputError(f"{said}, got {' '.join(ranges)[:60] or 'none'}")
    for group in found.region.unit:
        _check_unit(group, found, box)
    return operations, found, {place: box[place] for place in operations.inputs}


def _check_unit(group: Sequence[str], found: Problem, box: Mapping[str, tuple[Fraction, Fraction]]) -> None:
    """Refuse a box without a point whose components at some places are a unit quaternion: nothing is true there."""
    ends = [sorted(box[place], key=abs) for place in group]
    least = sum(near * near for (near, far) in ends if near * far > 0)
    spare = Fraction(UNIT_NORM)
    if not least - spare <= 1 <= sum(far * far for _, far in ends) + spare:
        said = ", ".join(f"{found.symbols[place]} {_said_range(*map(float, box[place]))}" for place in group)
        raise InputError(f"--box: expected a box that holds a unit quaternion, got {said}")


def _of_library(kernel: str, precision: str) -> tuple[Operations, Problem, None]:
    operations = read_kernel(emit(kernel).source, f"{kernel}{PRECISIONS[precision]}", f"{kernel}.c")
    return operations, problem(definition(kernel), operations), None


def require_known(kernel: str) -> None:
    """Refuse what is neither a kernel of the library, nor a scene, nor a file; with the nearest name that is one."""
    path = Path(kernel)
    if kernel in kernel_names() or kernel in shipped_names() or (path.exists() and path.suffix not in EMITTED):
        return
    hint = nearest(path.name, [*kernel_names(), *shipped_names()])
    said = f"expected the name of a kernel (see `symrot emit --list`) or a scene, got {kernel[:60]!r}"
    raise InputError(f"{said} ({hint})" if hint else said)


def _of_scene(scene: str, precision: str) -> tuple[Operations, Problem, SceneInputs]:
    require_known(scene)
    if precision != "double":
        raise InputError(f"--precision: expected double for a scene, whose kernel has no other, got {precision}")
    found = emit(scene)
    operations = read_kernel(found.source, found.name, f"{found.name}.c")
    inputs = scene_inputs(scene)
    return operations, scene_problem(inputs, operations), inputs


def section(kernel: str, ranges: Sequence[str]) -> dict[str, Any]:
    """Return link 4 of a kernel for its certificate, in all its precisions; parameters as for :func:`facts`."""
    operations, found, box = given(kernel, ranges, "double")
    single = given(kernel, ranges, "float")[0] if kernel in kernel_names() else None
    with _spoken(kernel):
        return rounding_section(operations, single, box, found.region)


@contextmanager
def _spoken(kernel: str) -> Iterator[None]:
    """Let what is refused be said in the names of a scene."""
    try:
        yield
    except InputError as reason:
        names = _names(kernel)
        raise InputError(re.sub(r"\w+\[\d+\]", lambda found: names.get(found[0], found[0]), str(reason))) from None


def facts(kernel: str, ranges: Sequence[str], precision: str) -> dict[str, Any]:
    """Return the bounds of a kernel on its box, with some ranges replaced: link 4 as plain data.

    Parameters
    ----------
    kernel, ranges, precision
        As for :func:`given`.

    Raises
    ------
    InputError
        As :func:`given`, and for a box on which an output has no bound.
    """
    operations, found, box = given(kernel, ranges, precision)
    own = {"kernel": operations.name, "names": _names(kernel)}
    with _spoken(kernel):
        return own | rounding_section(operations, None, box, found.region)


def _names(kernel: str) -> dict[str, str]:
    """Return what a scene calls what its kernel takes and gives: the place of a state tells nobody which it is."""
    if kernel in kernel_names():
        return {}
    return {place: symbol for place, (symbol, _) in scene_inputs(kernel).components.items()}


def _said_box(box: Mapping[str, Any], names: Mapping[str, str]) -> str:
    return ", ".join(f"{names.get(place, place)} {_said_range(*map(_value, ends))}" for place, ends in box.items())


def _said_range(low: float, high: float) -> str:
    if (Fraction(low), Fraction(high)) == ANY:
        return "any"
    return " .. ".join(dict.fromkeys(apart(low, high)))


def _value(end: Any) -> float:
    return float.fromhex(end) if isinstance(end, str) else float(end)


def _region_lines(section: Mapping[str, Any]) -> list[str]:
    groups = (tuple(section["names"].get(place, place) for place in group) for group in section["unit_groups"])
    region = Region(tuple(groups), float.fromhex(section["clearance"]))
    return [f"      {each}" for each in region_in_words(region)]


def lines(section: Mapping[str, Any]) -> list[str]:
    """Return the bounds as lines for people."""
    part = section["precisions"][0]
    names = section["names"]
    unit = f"2^-{DIGITS[part['precision']]}"
    rows = [
        (names.get(each["output"], each["output"]),
         f"{float.fromhex(each['absolute']):.3e}", f"{each['units']} * {unit}",
         ("" if each["converged"] else f"not below {float.fromhex(each['pointwise']):.3e} by this method")
         + (" (modulo whole turns)" if each["modulo_turns"] else ""))
        for each in part["outputs"]
    ]  # fmt: skip
    choices = sorted({choice for each in part["outputs"] for choice in each["choices"]})
    return [
        f"{section['kernel']}: no error is larger than", *columns(rows),
        f"for {_said_box(section['box'], names)}", *_region_lines(section),
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
        Inputs whose ranges are resized; if there are none, all of a kernel of the library, of a scene those with a
        range that are not components of its quaternion.
    """
    operations, found, box = given(kernel, ranges, precision)
    places = [found.place(name) for name in variables] or (None if kernel in kernel_names() else _free(found, box))
    for place in places or ():
        if box[place] == ANY:
            name = found.symbols[place]
            raise InputError(f"--variable {name}: expected an input that {operations.name} uses, which {name} is not")
    with _spoken(kernel):
        size, largest = largest_box(operations, box, target, places, found.region)
        bounds = bound_outputs(operations, largest, found.region)
    return {
        "kernel": operations.name, "names": _names(kernel), "target": target, "size": size,
        "box": {place: [float(low).hex(), float(high).hex()] for place, (low, high) in largest.items()},
        "largest_error": max(each.bound for each in bounds).hex(),
        "unit_groups": [list(group) for group in found.region.unit], "clearance": float(found.region.clearance).hex(),
    }  # fmt: skip


def _free(found: Problem, box: Mapping[str, tuple[Fraction, Fraction]]) -> list[str]:
    units = {place for group in found.region.unit for place in group}
    return [place for place, (low, high) in box.items() if low < high and (low, high) != ANY and place not in units]


def target_lines(found: Mapping[str, Any]) -> list[str]:
    """Return the largest box as lines for people."""
    return [
        f"{found['kernel']}: no error is larger than {found['target']:g}",
        f"for {_said_box(found['box'], found['names'])}", *_region_lines(found),
        f"the box given, {found['size']:.6g} times as wide about its middle",
    ]  # fmt: skip
