"""Link 4 for the kernel of a scene: the box that it is bounded on, and what the head of its C says of the bounds.

A scene says what its parameters are and how long it lasts, not where its states go: their ranges have to be given.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.bounds_text import region_in_words, region_of, rounded_up
from symrot.certificates.rounding.library import Problem
from symrot.certificates.rounding.output_graph import cone_of
from symrot.certificates.rounding.region import EVERYWHERE, Region
from symrot.formula.program import Argument
from symrot.formula.tree import Node

__all__ = ["ANY", "SceneInputs", "contract", "scene_problem"]

QUATERNION = ("q0", "q1", "q2", "q3")
LARGEST = Fraction(2) ** 1023 * (2 - Fraction(1, 2**52))
ANY, UNIT = (-LARGEST, LARGEST), (Fraction(-1), Fraction(1))


@dataclass(frozen=True)
class SceneInputs:
    """What the kernel of a scene takes and gives, the values of its parameters, its first and last time (s).

    ``formulas``: what the parameters are, by place (``"p[0]"``), name and formula; ``constants``: what is in them.
    """

    arguments: tuple[Argument, ...]
    parameters: tuple[float, ...]
    times: tuple[Fraction, Fraction]
    formulas: Mapping[str, tuple[str, Node]]
    constants: Mapping[str, Fraction]

    @property
    def components(self) -> dict[str, tuple[str, str]]:
        """Place, such as ``"y[0]"`` -> symbol and unit."""
        return {
            (each.name if each.is_scalar else f"{each.name}[{i}]"): component[:2]
            for each in self.arguments
            for i, component in enumerate(each.components)
        }


def scene_problem(inputs: SceneInputs, operations: Operations) -> Problem:
    """Return the ranges that a scene knows: its parameters are points, its quaternion of unit norm, time its span.

    States other than the quaternion are left out; what is not used may be any number.
    """
    symbols = {place: inputs.components[place][0] for place in operations.inputs}
    used = {place for _, index in operations.outputs for place in cone_of(operations, index).places}
    points = {f"p[{i}]": (Fraction(value), Fraction(value)) for i, value in enumerate(inputs.parameters)}
    known = points | {"t": inputs.times} | {p: UNIT for p, symbol in symbols.items() if symbol in QUATERNION}
    known |= dict.fromkeys(set(symbols) - used, ANY)
    quaternion = tuple(place for place, symbol in symbols.items() if symbol in QUATERNION)
    region = Region((quaternion,)) if quaternion else EVERYWHERE
    return Problem({place: known[place] for place in symbols if place in known}, region, symbols)


def contract(inputs: SceneInputs, section: Mapping[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return what the head of a scene's C says of its bounds: the box and the largest errors, in words."""
    names: dict[tuple[float, float], list[str]] = {}
    given = {f"p[{i}]": value for i, value in enumerate(inputs.parameters)}
    for place, ends in section["box"].items():
        low, high = map(float.fromhex, ends)
        if (Fraction(low), Fraction(high)) != ANY and not (low == high == given.get(place)):
            names.setdefault((low, high), []).append(inputs.components[place][0])
    ranges = [f"{', '.join(each)} {_range(low, high)}" for (low, high), each in names.items()]
    (part,) = section["precisions"]
    errors: dict[str, list[tuple[str, Fraction]]] = {}
    for each in part["outputs"]:
        symbol, unit = inputs.components[each["output"]]
        errors.setdefault(unit, []).append((symbol, Fraction(float.fromhex(each["absolute"]))))
    said = [
        f"{rounded_up(max(error for _, error in of))} {unit} in {', '.join(symbol for symbol, _ in of)}"
        for unit, of in errors.items()
    ]
    region = region_of(section)
    named = Region(tuple(tuple(inputs.components[p][0] for p in group) for group in region.unit), region.clearance)
    others = ["other parameters as above"] if given else []
    return (("Box", "; ".join([*ranges, *others])),
            ("Errors", f"on the box at most {'; '.join([*said, *region_in_words(named)])}"))  # fmt: skip


def _range(low: float, high: float) -> str:
    low_said, high_said = (repr(value).removesuffix(".0") for value in (low, high))
    return f"= {low_said}" if low == high else f"in [{low_said}, {high_said}]"
