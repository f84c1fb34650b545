"""Whether two formulas have the same unit, judged by how their values change with the base units."""

import math

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node
from symrot.checker.recognition.known_formulas import Known
from symrot.checker.recognition.single_faults.known_values import RANDOM, needed_values, tree_of
from symrot.checker.recognition.single_faults.letters import POINTS
from symrot.checker.recognition.single_faults.parts import Letters, PointOfLetters, values_of
from symrot.checker.recognition.usual_letters import UNIT_OF_NAME
from symrot.checker.repair.rows import is_matrix
from symrot.checker.units.units import read_unit

__all__ = ["has_other_unit"]

UNITS = {"[kg]": 1.37, "[m]": 1.61, "[s]": 0.83}
"""Base unit -> arbitrary factor for a test of units: the SI value of a mass is multiplied by 1.37, of a length by 1.61.

If each letter is multiplied by the factor of its unit, two formulas with different units change by different factors.
"""


def has_other_unit(named: NamedFormula, known: Known, nodes: dict[str, Node], letters: Letters) -> bool:
    """Return whether a claim's formula has another unit than ``known`` when its letters have their usual units.

    ``nodes`` maps the symbols of ``known`` to letters of the claim. False if a unit is unknown, or if a formula is a
    matrix, zero or undefined at a test point.
    """
    scales = {node: _scale(UNIT_OF_NAME.get(mine)) for mine, node in nodes.items()}
    if None in scales.values() or any(atom not in scales for atom in letters.atoms):
        return False
    scaled = Letters(
        {atom: tuple(value * (scales[atom] or 1) for value in values) for atom, values in letters.atoms.items()},
        letters.angles,
        [
            PointOfLetters(
                {**point.symbols, **{str(atom.value): v[n] * (scales[atom] or 1) for atom, v in letters.atoms.items()
                                     if atom.kind == "name"}},
                {}, point.definitions,
                rates={atom: v[n] * (scales[atom] or 1) for atom, v in letters.atoms.items() if atom.kind == "call"},
            )
            for n, point in enumerate(letters.points)
        ],
    )  # fmt: skip
    # if the ratio of the values changes from SI units to those of UNITS, the units differ
    ratios = []
    for n in range(POINTS):
        plain = {mine: letters.atoms.get(node, RANDOM)[n] for mine, node in nodes.items()}
        changed = {mine: value * (scales[nodes[mine]] or 1) for mine, value in plain.items()}
        pairs = []
        for own, values in ((letters, plain), (scaled, changed)):
            value = values_of(tree_of(known), [PointOfLetters(values, {}, {})])
            needed = value and needed_values(named, known, value, Letters({}, {}, [own.points[n]]))
            actual = values_of(named.formula, [own.points[n]])
            if not needed or not actual or is_matrix(actual[0]) or not needed[0] or not actual[0]:
                return False
            pairs.append(actual[0] / needed[0])
        ratios.append(pairs[0] / pairs[1])
    return not all(abs(ratio - 1) <= 1e-6 for ratio in ratios)


def _scale(unit: str | None) -> float | None:
    """Return the factor that converts a number in the SI unit ``unit`` to the invented units of ``UNITS``.

    For "m/s" the factor is 1.61/0.83, since ``UNITS`` has 1.61 for m and 0.83 for s. Return None if ``unit`` is None.
    """
    if unit is None:
        return None
    # with factors f for m and g for s, the factor for m/s^2 is f/g^2
    powers = read_unit(unit.partition(",")[0])
    return math.prod((UNITS.get(base, 1.0) ** float(power) for base, power in powers.items()), start=1.0)
