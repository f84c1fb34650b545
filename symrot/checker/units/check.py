"""The dimensional check: do terms that are added, and sides that are compared, have one unit?

Units come from a claim's own table, then from custom (:data:`symrot.checker.units.units.CUSTOM`); what is left is
inferred: only a contradiction is an error. A matrix may mix units: it is followed entry by entry. The outcome stands
beside the verdict and never changes it.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import Node, walk
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
    given: Sequence[tuple[Node, Node]] = (),
    units: Mapping[str, str] | None = None,
) -> Dimensions:
    """Return whether the units of an equation fit together.

    Parameters
    ----------
    sides : (Node, Node)
        The claim, left and right.
    define : sequence of (str, Node)
        Its definitions, in order.
    given : sequence of (Node, Node)
        Its hypotheses, left and right.
    units : mapping of str to str, optional
        Units by symbol: ``{"x": "m"}``; they go before custom.

    Returns
    -------
    Dimensions
        ``status`` is ``"consistent"``, ``"inconsistent"`` (``text`` says where and what meets), or ``"unknown"`` when
        no name in it has a known unit, or numbers were given without theirs.

    Raises
    ------
    InputError
        For a unit that is not known.
    """
    trees = [*sides, *(tree for _, tree in define), *(side for pair in given for side in pair)]
    names = {str(node.value) for tree in trees for _, node in walk(tree) if node.kind in ("name", "call")}
    own = {name: read_unit(unit, f"units: {name}") for name, unit in (units or {}).items()}
    walker = UnitInference(own, CALLS, names, {name for tree in trees for name in angles_of(tree)})
    try:
        for name, tree in define:
            walker.define(name, tree)
        for left, right in given:
            walker.relation(left, right, "a hypothesis")
        walker.relation(*sides, "")
    except Unreadable:
        return Dimensions("unknown")
    if walker.faults and walker.unitless:
        return Dimensions("unknown")
    if walker.faults:
        assumed = ", ".join(f"{name} in {unit}" for name, unit in walker.assumed.items())
        return Dimensions("inconsistent", walker.faults[0] + (f" (by custom {assumed})" if assumed else ""))
    return Dimensions("consistent" if walker.known else "unknown", "", walker.inferred())


def dimensions_of_formulas(left: Any, right: Any, units: Mapping[str, str] | None = None) -> Dimensions:
    """Return whether the units of an equation between SymPy values fit; symbols of symrot bring their own units."""
    symbols = {symbol for side in (left, right) for symbol in getattr(side, "free_symbols", ())}
    own = {symbol.name: UNIT[symbol] for symbol in symbols if UNIT.get(symbol)} | dict(units or {})
    try:
        sides = read_expression(as_text(left)), read_expression(as_text(right))
    except InputError:
        return Dimensions("unknown")
    return check_dimensions(sides, units=own)
