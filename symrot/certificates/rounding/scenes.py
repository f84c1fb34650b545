"""Rounding bounds for the kernel of a scene: the box of its inputs, and the lines about bounds in its header comment.

A scene fixes the parameters and the time span, but not the ranges of the states; the user states these.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.bounds_text import region_phrases, rounded_up
from symrot.certificates.rounding.library import RoundingProblem
from symrot.certificates.rounding.output_graph import output_graph
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.certificates.rounding.section import region_of
from symrot.formula.program import Argument
from symrot.formula.tree import Node

__all__ = ["ANY", "SceneInputs", "header_lines", "scene_problem"]

QUATERNION = ("q0", "q1", "q2", "q3")
LARGEST = Fraction(2) ** 1023 * (2 - Fraction(1, 2**52))
ANY, UNIT = (-LARGEST, LARGEST), (Fraction(-1), Fraction(1))


@dataclass(frozen=True)
class SceneInputs:
    """The arguments of a scene's kernel, the values of its parameters, and its first and last time (s)."""

    arguments: tuple[Argument, ...]
    parameters: tuple[float, ...]
    times: tuple[Fraction, Fraction]
    # parameter such as "p[0]" -> its name and formula
    formulas: Mapping[str, tuple[str, Node]]
    # physical constant in these formulas -> its value
    constants: Mapping[str, Fraction]

    @property
    def components(self) -> dict[str, tuple[str, str]]:
        """A map from each input component, such as ``"y[0]"``, to its symbol and unit."""
        return {place: component[:2] for each in self.arguments for place, component in each.places.items()}


def scene_problem(inputs: SceneInputs, operations: Operations) -> RoundingProblem:
    """Return the box and the restrictions that follow from a scene: fixed parameters, time span, unit quaternion.

    The user adds the ranges of the states that the scene does not limit, such as the angular velocity.
    """
    symbols = {place: inputs.components[place][0] for place in operations.inputs}
    used = {place for _, index in operations.outputs for place in output_graph(operations, index).places}
    points = {f"p[{i}]": (Fraction(value), Fraction(value)) for i, value in enumerate(inputs.parameters)}
    known = points | {"t": inputs.times} | {p: UNIT for p, symbol in symbols.items() if symbol in QUATERNION}
    # an input that the kernel does not use may be any number
    known |= dict.fromkeys(set(symbols) - used, ANY)
    quaternion = tuple(place for place, symbol in symbols.items() if symbol in QUATERNION)
    region = Region((quaternion,)) if quaternion else EVERYWHERE
    return RoundingProblem({place: known[place] for place in symbols if place in known}, region, symbols)


def header_lines(inputs: SceneInputs, section: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return lines (title, text) about rounding bounds, for the header comment of a scene's C file.

    ``section`` is the section ``rounding`` of the kernel's certificate.
    """
    names: dict[tuple[float, float], list[str]] = {}
    parameters = {f"p[{i}]": value for i, value in enumerate(inputs.parameters)}
    for place, ends in section["box"].items():
        low, high = map(float.fromhex, ends)
        if (Fraction(low), Fraction(high)) != ANY and not (low == high == parameters.get(place)):
            names.setdefault((low, high), []).append(inputs.components[place][0])
    ranges = [f"{', '.join(each)} {_range(low, high)}" for (low, high), each in names.items()]
    (part,) = section["precisions"]
    errors: dict[str, list[tuple[str, Fraction]]] = {}
    for each in part["outputs"]:
        symbol, unit = inputs.components[each["output"]]
        errors.setdefault(unit, []).append((symbol, Fraction(float.fromhex(each["absolute"]))))
    error_phrases = [
        f"{rounded_up(max(error for _, error in of))} {unit} in {', '.join(symbol for symbol, _ in of)}"
        for unit, of in errors.items()
    ]
    region = region_of(section)
    named = Region(tuple(tuple(inputs.components[p][0] for p in group) for group in region.unit), region.clearance)
    others = ["other parameters as above"] if parameters else []
    return (("Box", "; ".join([*ranges, *others])),
            ("Errors", f"on the box at most {'; '.join([*error_phrases, *region_phrases(named)])}"))  # fmt: skip


def _range(low: float, high: float) -> str:
    """Return a range as text for a comment: ``in [-1, 2]``, or ``= 3`` if both ends are equal."""
    low_text, high_text = (repr(value).removesuffix(".0") for value in (low, high))
    return f"= {low_text}" if low == high else f"in [{low_text}, {high_text}]"
