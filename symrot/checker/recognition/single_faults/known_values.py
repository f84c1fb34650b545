"""Values of known formulas at test points, and the values that a claim's formula must have to agree with them.

A claim ``2*T = ..`` agrees with a known formula for T if its right side has twice the values of this formula.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import Node, walk
from symrot.checker.recognition.known_formulas import Known, by_fingerprint, ending_of
from symrot.checker.recognition.printed_text import read_printed
from symrot.checker.recognition.single_faults.letters import ids_of_nodes, is_atom
from symrot.checker.recognition.single_faults.parts import (
    Letters,
    Part,
    PointOfLetters,
    Valued,
    Values,
    is_superfluous,
    parts,
    values_of,
)
from symrot.checker.recognition.single_faults.tapes import Tape, tape_of_tree
from symrot.checker.repair.edits.names import PRODUCT_OF_INERTIA
from symrot.checker.repair.edits.trees import square_of
from symrot.checker.repair.points import UndefinedValue
from symrot.checker.repair.rows import entries_of, is_matrix, shape_of, times, transposed

__all__ = [
    "RANDOM", "KnownValues", "formulas_of_quantities", "has_angles", "ids_of_known", "is_column", "names_of",
    "needed_values", "quantity_node", "tree_of", "views",
]  # fmt: skip

SQUARED = ", squared"


def quantity_node(named: NamedFormula) -> Node:
    """Return the name or rate, such as L or ``diff(L(t), t)``, for which a claim is solved; else its left side."""
    atoms = (node for _, node in walk(named.side) if is_atom(node))
    own = (atom for atom in atoms if named.name in (atom.value, *(str(n.value) for _, n in walk(atom))))
    return next(own, named.side)


@cache
def formulas_of_quantities() -> tuple[Known, ...]:
    """Return the known formulas that each give one named quantity, such as a kinetic energy.

    Left out are the sides of derivation steps, and relations: equations, stored as left side minus right side.
    """
    formulas = [known for group in by_fingerprint().values() for known in group]
    return tuple(known for known in formulas if not known.is_step and not known.is_relation)


@cache
def names_of(known: Known) -> tuple[str, ...]:
    """Return the names of the symbols in a known formula, in the order of their first occurrence."""
    words = dict.fromkeys(re.findall(r"[A-Za-z]\w*", known.text))
    return tuple(word for word in words if word not in _BUILT_IN)


_BUILT_IN = {"sin", "cos", "tan", "cot", "sec", "csc", "sqrt", "pi", "Matrix", "abs", "Abs", "atan2", "acos", "asin"}


@cache
def ids_of_known(known: Known) -> frozenset[int]:
    """Return the ``id`` of every node in the tree of a known formula; a test point stores the values of these nodes."""
    return ids_of_nodes(tree_of(known))


def is_column(known: Known) -> bool:
    """Return whether a known formula is a vector or matrix; False for the two arguments of an atan2."""
    return known.text.startswith("Matrix") and not ending_of(known.name).endswith("atan2")


@cache
def has_angles(known: Known) -> bool:
    """Return whether a known formula contains a sine, cosine or tangent."""
    return re.search(r"\b(sin|cos|tan)\(", known.text) is not None


@cache
def tree_of(known: Known) -> Node:
    """Return the tree of a known formula, the same object at every call."""
    return read_printed(known.text)


@cache
def tape_of(known: Known) -> Tape | None:
    """Return a known formula as a tape, a list of operations that is evaluated quickly.

    Return None for a matrix, and for a formula with a function that tapes do not support.
    """
    return tape_of_tree(tree_of(known))


@dataclass
class KnownValues:
    """The values of a known formula at test points.

    ``symbols`` has a dictionary for each point: symbol of the formula -> its value, usually that of a claim's letter.
    """

    known: Known
    symbols: Sequence[Mapping[str, float]]

    @cached_property
    def points(self) -> list[PointOfLetters]:
        """The test points, one for each dictionary in ``symbols``, as objects that evaluate the tree of the formula."""
        return [PointOfLetters(dict(values), {}, {}, ids_of_known(self.known)) for values in self.symbols]

    @cached_property
    def on_tape(self) -> list[list[float]] | None:
        """For each point, the list of the values of all parts of the formula, computed from its list of operations.

        This list is the result of `tape_of`. None if `tape_of` returns None, or if the formula has no value at one of
        the points.
        """
        tape = tape_of(self.known)
        values = [] if tape is None else [tape.values(symbols) for symbols in self.symbols]
        return None if None in values or not values else [own for own in values if own is not None]

    @cached_property
    def whole(self) -> Values | None:
        """The values of the formula, or None if it has no value at one of the points."""
        if tape_of(self.known) is None:
            return values_of(tree_of(self.known), self.points)
        return None if self.on_tape is None else tuple(own[-1] for own in self.on_tape)

    def superfluous(self, needed: Values) -> Iterator[Part]:
        """Yield the terms and factors of the formula without which it would have the values ``needed``."""
        tape = tape_of(self.known)
        if tape is not None and self.on_tape is not None and (
            is_matrix(needed[0]) or not tape.may_have_too_much(self.on_tape, needed[0])
        ):  # fmt: skip
            return
        yield from filter(is_superfluous, parts(Valued(tree_of(self.known), self.points), needed))

    def with_other_signs(self) -> Iterator[Values]:
        """Yield the formula's values with the signs of its products of inertia reversed; nothing if it has none."""
        names = [name for name in names_of(self.known) if PRODUCT_OF_INERTIA.fullmatch(name)]
        if names:
            changed = [{**values, **{name: -values[name] for name in names}} for values in self.symbols]
            if (values := KnownValues(self.known, changed).whole) is not None:
                yield values


def views(known: Known, values: Values) -> Iterator[Values]:
    """Yield ``values``, and ``values`` transposed, doubled, or with a quaternion's scalar last, where this makes sense.

    Only the values of square matrices are transposed. The values are doubled only if multiples of the formula count as
    the same formula (``known.scaled``): a quaternion rate, for example, may be stated with or without its factor 1/2.
    """
    yield values
    if not is_matrix(values[0]):
        return
    rows, columns = shape_of(values[0]) or (0, 0)
    if rows == columns:
        yield tuple(map(transposed, values))
    # multiples of a ``scaled`` formula have the same name
    doubled = [tuple(times(2.0, value) for value in values)] if known.scaled else []
    yield from doubled
    # a quaternion with its scalar part last
    if rows == len(LAST):
        for view in (values, *doubled):
            yield tuple(tuple(value[row] for row in LAST) for value in view)


LAST = (1, 2, 3, 0)
"""The rows of a scalar-first quaternion in the order that puts its scalar last."""

RANDOM = (0.7310585786, 1.1752011936, 0.4812118251)
"""The values, one for each test point, of a symbol of a known formula if the claim has no letter for the symbol."""


def needed_values(named: NamedFormula, known: Known, target: Values, letters: Letters) -> Values | None:
    """Return the values that the claim's formula should have if ``target`` are the values of the known formula.

    For the claim ``2*T = ..`` and a known formula for T, these are twice the values of ``target``. Return None if the
    claim gives no single quantity (``named.solve`` is None), or if the quantity would have no real value, as k with a
    known formula for k^2 that is negative.
    """
    function = _FUNCTIONS_OF_ENDINGS.get(ending_of(known.name))
    if function is None:
        return None
    if named.solve is None:
        return None
    if function is _same and named.side == Node("name", named.name):
        return target
    if ending_of(known.name) == SQUARED and named.side == square_of(quantity_node(named)):
        return target
    if (named.side.value, ending_of(known.name)) in (("cos", ", acos"), ("sin", ", asin")) and is_atom(
        named.side.args[0]
    ):
        return target
    try:
        # the root for a known square, the angle for a known cosine
        target = tuple(map(function, target))
    except (ValueError, TypeError):
        return None
    values = []
    for point, value in zip(letters.points, target, strict=True):
        if is_matrix(value) or (named.side.value == "diff" and named.side.args[0].kind == "name"):
            if named.side.kind not in ("name", "call"):
                return None
            values.append(value)
            continue
        name = named.name
        rates = {node: value for _, node in walk(named.side) if is_atom(node) and node.kind == "call"}
        whole = PointOfLetters({**point.symbols, name: value}, {}, point.definitions, rates=rates)
        try:
            # for the side 2*omega, twice the value
            values.append(whole.value(named.side))
        except UndefinedValue:
            return None
    return tuple(values)


def _same(value: Any) -> Any:
    return value


def _root(value: Any) -> float:
    return math.sqrt(value)


def _multiple_of_arc(factor: int, function: Callable[..., float]) -> Callable[[Any], float]:
    return lambda value: factor * function(*(entries_of(value) if is_matrix(value) else [value]))


_FUNCTIONS_OF_ENDINGS: dict[str, Callable[[Any], Any]] = {
    "": _same, SQUARED: _root, ", acos": _multiple_of_arc(1, math.acos),
    ", 2 acos": _multiple_of_arc(2, math.acos), ", asin": _multiple_of_arc(1, math.asin),
    ", atan2": _multiple_of_arc(1, math.atan2), ", 2 atan2": _multiple_of_arc(2, math.atan2),
}  # fmt: skip
"""Ending of a known formula's name -> function from the formula's value to the value of the quantity.

For a formula for k^2, whose name ends with ``, squared``, the function is the square root.
"""
