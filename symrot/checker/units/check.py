"""The check of units: all terms of a sum, and both sides of an equation, must have the same unit.

Units are stated in the claim, or conventional (:data:`symrot.checker.units.units.CONVENTIONAL_UNITS`), or inferred;
only a contradiction is an error. It may make an equation "false" that would otherwise have the verdict "definition".
"""

from collections.abc import Mapping, Sequence
from typing import Any

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, nodes_of
from symrot.checker.units.functions import CALLS
from symrot.checker.units.inference import UnitInference, Unreadable, angles_of
from symrot.checker.units.units import read_unit
from symrot.checker.verdict import Dimensions
from symrot.errors import InputError
from symrot.exact.printing import as_text
from symrot.symbols import UNIT

__all__ = ["check_dimensions", "dimensions_of_formulas"]


def check_dimensions(
    sides: tuple[Node, Node],
    define: Sequence[tuple[str, Node]] = (),
    hypotheses: Sequence[tuple[Node, Node]] = (),
    units: Mapping[str, str] | None = None,
) -> Dimensions:
    """Check whether the units in an equation fit together, and return the result.

    Parameters
    ----------
    sides : (Node, Node)
        The claim, left and right.
    define : sequence of (str, Node)
        Its definitions, in order.
    hypotheses : sequence of (Node, Node)
        Its hypotheses, left and right.
    units : mapping of str to str, optional
        Units by symbol, ``{"x": "m"}``; they overrule conventional units.

    Returns
    -------
    Dimensions
        ``status`` is ``"consistent"``, ``"inconsistent"`` (``text`` says where, and which units differ), or
        ``"unknown"`` if no name has a known unit, if the units of a formula cannot be told, or if numbers stand for
        quantities whose units were left out.

    Raises
    ------
    InputError
        For an unknown unit.
    """
    trees = [*sides, *(tree for _, tree in define), *(side for pair in hypotheses for side in pair)]
    names = {str(node.value) for node in nodes_of(*trees) if node.kind in ("name", "call")}
    own = {name: read_unit(unit, f"units: {name}") for name, unit in (units or {}).items()}
    inference = UnitInference(own, CALLS, names, {name for tree in trees for name in angles_of(tree)})
    try:
        for name, tree in define:
            inference.define(name, tree)
        for left, right in hypotheses:
            inference.relation(left, right, "a hypothesis")
        inference.relation(*sides, "")
    except Unreadable:
        return Dimensions("unknown")
    if inference.faults and inference.unitless:
        return Dimensions("unknown")
    if inference.faults:
        assumed = ", ".join(f"{name} in {unit}" for name, unit in inference.assumed.items())
        return Dimensions("inconsistent", inference.faults[0] + (f" (assuming {assumed})" if assumed else ""))
    return Dimensions("consistent" if inference.known else "unknown", "", inference.inferred())


def dimensions_of_formulas(left: Any, right: Any, units: Mapping[str, str] | None = None) -> Dimensions:
    """Check whether the units of an equation between SymPy values fit together, and return the result.

    ``units`` maps names to units; they overrule the units of the symbols in :mod:`symrot.symbols`.
    """
    symbols = {symbol for side in (left, right) for symbol in getattr(side, "free_symbols", ())}
    own = {symbol.name: UNIT[symbol] for symbol in symbols if UNIT.get(symbol)} | dict(units or {})
    for name, unit in own.items():
        if not isinstance(unit, str):
            raise InputError(f"units: expected the unit of {name} as text, got {unit!r}")
    try:
        sides = read_expression(as_text(left)), read_expression(as_text(right))
    except InputError:
        return Dimensions("unknown")
    return check_dimensions(sides, units=own)
