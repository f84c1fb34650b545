"""The units of the parts of a formula (names, sums, products, powers, matrices), and contradictions between them.

A unit is stored as a dimension: exponents of kg, m, s and other bases, without scales such as the one of mm.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import Any

from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.tree import Node, nodes_of, text
from symrot.checker.units.units import (
    NOTHING,
    Dimension,
    UnitSystem,
    conventional_unit,
    raised,
    read_unit,
    times,
    unit_text,
)

__all__ = ["ZERO", "Rows", "UnitInference", "Unreadable", "Value", "angles_of", "number_of", "piece_text", "shape_of"]

LONGEST_EXCERPT = 60
LARGEST_DETERMINANT = 4

ANGLE_FUNCTIONS = ("sin", "cos", "tan", "cot", "sec", "csc", *ROTATIONS)

Value = Any
"""A dimension, None for zero (which may have any unit), or the rows of a matrix of these."""

ZERO = None
Rows = tuple[tuple[Any, ...], ...]


class Unreadable(Exception):
    """Exception for a formula whose dimension cannot be told, such as a product of matrices that do not fit."""


@dataclass
class UnitInference:
    """The inference of the units in one claim: it derives the unit of each part of a tree and collects contradictions.

    Attributes
    ----------
    units : dict
        Stated units by name.
    calls : mapping
        Name of a function -> its rule for units.
    names : set of str
        All names of the claim.
    angles : set of str
        Letters that must be angles.
    system : UnitSystem
        The equations between units so far.
    values : dict
        Name of a definition -> the dimension of its value.
    assumed : dict
        Name -> the conventional unit that was assumed for it.
    known : bool
        Whether any unit is known.
    unitless : bool
        Whether a definition is a number without its unit; other numbers may then lack their units, too.
    fresh : int
        The number of unknown units introduced so far.
    faults : list of str
        Contradictions, as sentences.
    place : str
        Words for the part of the claim that is being examined, for messages.
    """

    units: dict[str, Dimension]
    calls: Mapping[str, Callable[["UnitInference", Node], Value]]
    names: set[str]
    angles: set[str]
    system: UnitSystem = field(default_factory=UnitSystem)
    values: dict[str, Value] = field(default_factory=dict)
    assumed: dict[str, str] = field(default_factory=dict)
    known: bool = False
    unitless: bool = False
    fresh: int = 0
    faults: list[str] = field(default_factory=list)
    place: str = ""

    # -- definitions and equations ----------------------------------------------------------------------------------

    def define(self, name: str, tree: Node) -> None:
        """Record the dimension that the definition ``tree`` gives to ``name``."""
        self.place = f"in the definition of {name}"
        value = self.value(tree)
        if _bare(tree):
            self.unitless |= name not in self.units and not _is_unit(tree)
            # the number in m = 3 may lack its unit: the usual unit of the name, or an unknown one
            value = self.unit_of(name) if not isinstance(value, tuple) else self.values_of(value, tree)
        elif name in self.units and not isinstance(value, tuple):
            self.same(self.units[name], value, f"{name} was given the unit {{0}}, its definition has {{1}}")
        self.values[name] = value

    def relation(self, left: Node, right: Node, what: str) -> None:
        """Require that both sides of an equation have the same dimension; ``what`` names the equation in messages."""
        values: list[Value] = []
        for node, side in ((left, "left"), (right, "right")):
            self.place = f"in {what}" if what else f"on the {side} side"
            values.append(self.value(node))
        names = {left.kind, right.kind} & {"name", "call", "index"}
        for node, n in ((left, 0), (right, 1)):
            if _bare(node) and (names or not _is_unit(node)):
                value = values[n]
                values[n] = self.values_of(value, node) if isinstance(value, tuple) else self.unknown()
        prefix = f"in {what} " if what else ""
        self.place = ""
        self.same(values[0], values[1], f"{prefix}the left side is {{0}}, the right side is {{1}}")

    def inferred(self) -> dict[str, str]:
        """Return the units that the equations imply for names whose unit is neither stated nor conventional."""
        units = {}
        for name in sorted(self.names & self.system.solved.keys()):
            unit = self.system.reduced({name: Fraction(1)})
            if all(base.startswith("[") for base in unit):
                units[name] = unit_text(unit)
        return units

    # -- units of names ---------------------------------------------------------------------------------------------

    def unknown(self) -> Dimension:
        """Return a new unknown unit, which equations may determine later."""
        self.fresh += 1
        return {f"?{self.fresh}": Fraction(1)}

    def unit_of(self, name: str) -> Dimension:
        """Return the unit of a symbol or function of time: the stated or conventional one, or else an unknown unit."""
        if name in self.units:
            self.known = True
            return self.units[name]
        quaternion = {f"{name[:-1]}{n}" for n in range(4)}
        plain = name in self.angles or (name[:-1] in ("q", "q_") and quaternion <= self.names)
        unit = "1" if plain else conventional_unit(name) if len(name) > 1 or self.physical() else None
        if unit is None:
            return {name: Fraction(1)}
        self.known = True
        dimension = read_unit(unit)
        if dimension:
            self.assumed[name] = unit
        return dimension

    def physical(self) -> bool:
        """Return whether a claim is about physical quantities, so that its letters m and t mean mass and time."""
        # units are stated, or a name of several letters has a conventional unit other than rad
        units = (conventional_unit(name) for name in self.names if len(name) > 1)
        return bool(self.units) or any(unit not in (None, "rad") for unit in units)

    def values_of(self, rows: Rows, node: Node) -> Rows:
        """Return the dimensions of the entries of ``node``, a matrix of numbers whose units may have been left out.

        ``rows`` has the dimension of a pure number for each entry, and ZERO for each entry 0. If all numbers are 0 or
        1, return ``rows``. Otherwise each entry may have lacked its unit, as 2 for 2 kg: return a new unknown dimension
        for each entry, and ZERO for each entry 0.
        """
        if _is_unit(node):
            return rows  # zeros and ones are pure numbers, but 2 may be 2 kg
        return tuple(tuple(ZERO if entry is ZERO else self.unknown() for entry in row) for row in rows)

    # -- equations --------------------------------------------------------------------------------------------------

    def same(self, first: Value, second: Value, words: str) -> Value:
        """Require that two formulas have the same dimension, and return it.

        If they contradict each other, add the sentence ``words`` to ``faults`` and return ``first``. In ``words``, {0}
        and {1} stand for the two units. Zero fits every dimension.
        """
        if isinstance(first, tuple) or isinstance(second, tuple):
            return self.same_matrices(first, second, words)
        if first is ZERO or second is ZERO:
            return second if first is ZERO else first  # zero may have any unit
        if not self.system.equate(first, second):
            place = f"{self.place} " if self.place else ""
            self.faults.append(place + words.format(*map(self.in_words, (first, second))))
        return first

    def in_words(self, dimension: Dimension) -> str:
        """Return a dimension as text, with the units that the equations so far determine."""
        unit = unit_text(self.system.reduced(dimension))
        return "dimensionless" if unit == "1" else unit

    def same_matrices(self, first: Value, second: Value, words: str) -> Value:
        """Require that two matrices have the same dimension in each entry, and return these dimensions.

        A contradiction adds the sentence ``words`` to ``faults``, as in :meth:`same`. A number 0 fits every matrix.
        Raise Unreadable for two different shapes, and for a matrix and a scalar other than 0.
        """
        shapes = [shape_of(value) for value in (first, second)]
        if None in shapes:
            zero = first if shapes[0] is None else second
            if zero is not ZERO:
                raise Unreadable
            return second if shapes[0] is None else first
        if shapes[0] != shapes[1]:
            raise Unreadable
        assert isinstance(first, tuple) and isinstance(second, tuple)
        return tuple(
            tuple(
                self.same(a, b, f"in entry ({i}, {j}) {words}")
                for j, (a, b) in enumerate(zip(row, other, strict=True), start=1)
            )
            for i, (row, other) in enumerate(zip(first, second, strict=True), start=1)
        )

    def plain(self, value: Value, words: str) -> Dimension:
        """Require a scalar to be a pure number, and return the dimension of pure numbers.

        ``value`` is the dimension of the scalar. If the scalar has a unit, add the sentence ``words`` to the faults.
        Raise Unreadable for a matrix.
        """
        if isinstance(value, tuple):
            raise Unreadable
        self.same(value, NOTHING, words)
        return NOTHING

    # -- trees ------------------------------------------------------------------------------------------------------

    def value(self, node: Node) -> Value:
        """Return the dimension of a formula; for a matrix, the dimensions of its entries."""
        return _VALUE[node.kind](self, node)

    def scalar(self, node: Node) -> Dimension | None:
        """Return the dimension of a scalar formula, None for zero; raise Unreadable for a matrix."""
        value: Value = self.value(node)
        if isinstance(value, tuple):
            raise Unreadable
        return value  # type: ignore[no-any-return]

    def matrix(self, node: Node) -> Rows:
        """Return the dimensions of the entries of a matrix; raise Unreadable for any other formula."""
        value = self.value(node)
        if node.kind == "list" and isinstance(value, list):
            value = tuple((entry,) for entry in value)
        if not isinstance(value, tuple):
            raise Unreadable
        return value

    def total(self, values: Sequence[Value], what: str) -> Value:
        """Return the dimension of a sum, and require it of every term; ``what`` names the sum in messages."""
        dimension = values[0]
        for number, value in enumerate(values[1:], start=2):
            dimension = self.same(dimension, value, f"term 1 of {what} is {{0}}, term {number} is {{1}}")
        return dimension

    def times(self, first: Value, second: Value) -> Value:
        """Return the dimension of a product of scalars or matrices; a scalar may be on either side of a matrix."""
        if not isinstance(first, tuple) and not isinstance(second, tuple):
            return ZERO if first is ZERO or second is ZERO else times(first, second)
        if not isinstance(second, tuple):
            first, second = second, first
        if not isinstance(first, tuple):
            return _map(lambda entry: self.times(first, entry), second)
        assert isinstance(second, tuple)
        if len(first[0]) != len(second):
            raise Unreadable
        return tuple(tuple(self.dot(row, column) for column in zip(*second, strict=True)) for row in first)

    def dot(self, first: Sequence[Any], second: Sequence[Any]) -> Value:
        if len(first) != len(second):
            raise Unreadable
        return self.total([self.times(a, b) for a, b in zip(first, second, strict=True)], "a product of vectors")

    def power(self, base: Value, exponent: Fraction) -> Value:
        if isinstance(base, tuple):
            if exponent.denominator != 1 or abs(exponent) > LARGEST_DETERMINANT or not exponent:
                raise Unreadable
            factor = base if exponent > 0 else self.inverse(base)
            return reduce(self.times, [factor] * abs(int(exponent)))
        return base if base is ZERO else raised(base, exponent)

    def inverse(self, rows: Rows) -> Rows:
        size = range(len(rows))
        below = self.determinant(rows)
        if below is ZERO or isinstance(below, tuple):
            raise Unreadable
        if len(rows) == 1:
            return ((raised(below, Fraction(-1)),),)
        return tuple(
            tuple(self.times(self.determinant(_minor(rows, j, i)), raised(below, Fraction(-1))) for j in size)
            for i in size
        )

    def determinant(self, rows: Rows) -> Value:
        if len(rows) != len(rows[0]) or len(rows) > LARGEST_DETERMINANT:
            raise Unreadable
        if len(rows) == 1:
            entry: Value = rows[0][0]
            return entry
        terms = [self.times(entry, self.determinant(_minor(rows, 0, j))) for j, entry in enumerate(rows[0])]
        return self.total(terms, "a determinant")


def angles_of(tree: Node) -> Iterator[str]:
    """Yield the single letters that must be angles: ``g`` in ``sin(2*g)``, but not ``t`` in ``sin(w*t)``."""
    for node in nodes_of(tree):
        if node.kind == "call" and node.value in ANGLE_FUNCTIONS:
            for argument in node.args:
                for term in argument.args if argument.kind == "sum" else (argument,):
                    named = [piece for piece in nodes_of(term) if piece.kind in ("name", "call")]
                    if named and (len(named) == 1 or named[0].args == tuple(named[1:])):
                        yield from (named[0].value,) if len(named[0].value) == 1 else ()


def shape_of(value: Value) -> tuple[int, int] | None:
    return (len(value), len(value[0])) if isinstance(value, tuple) else None


def _map(function: Callable[[Any], Any], rows: Rows) -> Rows:
    return tuple(tuple(function(entry) for entry in row) for row in rows)


def _minor(rows: Rows, row: int, column: int) -> Rows:
    return tuple((*r[:column], *r[column + 1 :]) for n, r in enumerate(rows) if n != row)


def _bare(tree: Node) -> bool:
    """Return whether a tree has only numbers, as ``Matrix([1, 2*pi])`` has, and no symbols."""
    loose = (node for node in nodes_of(tree) if node.kind in ("name", "call"))
    return all(node.value in ("pi", "Matrix", "sqrt", "diag", "transpose") for node in loose)


def _is_unit(tree: Node) -> bool:
    """Return whether a tree has only the numbers 0 and 1, and no names, as ``Matrix([0, 0, 1])`` has."""
    return all(node.value in (0, 1) for node in nodes_of(tree) if node.kind == "number") and not any(
        node.kind == "name" for node in nodes_of(tree)
    )


def piece_text(node: Node) -> str:
    """Return the text of a formula for a message, cut after LONGEST_EXCERPT characters."""
    whole = text(node)
    return whole if len(whole) <= LONGEST_EXCERPT else whole[: LONGEST_EXCERPT - 2] + ".."


def number_of(node: Node) -> Fraction | None:
    """Return the value of a tree of numbers, their sums, products and quotients, such as an exponent; None for any
    other tree.
    """
    if node.kind == "number":
        return Fraction(node.value)
    inner = [number_of(child) for child in node.args]
    if node.kind not in ("neg", "inv", "product", "sum") or None in inner:
        return None
    values = [value for value in inner if value is not None]
    if node.kind == "neg":
        return -values[0]
    if node.kind == "inv":
        return 1 / values[0] if values[0] else None
    return sum(values, Fraction(0)) if node.kind == "sum" else reduce(lambda a, b: a * b, values)


# -- the kinds of node ------------------------------------------------------------------------------------------------


def _number(inference: UnitInference, node: Node) -> Value:
    return NOTHING if node.value else ZERO


def _name(inference: UnitInference, node: Node) -> Value:
    if node.value in inference.values:
        return inference.values[node.value]
    return NOTHING if node.value == "pi" else inference.unit_of(node.value)


def _sum(inference: UnitInference, node: Node) -> Value:
    return inference.total([inference.value(term) for term in node.args], f"the sum {piece_text(node)}")


def _product(inference: UnitInference, node: Node) -> Value:
    return reduce(inference.times, [inference.value(factor) for factor in node.args])


def _inverse(inference: UnitInference, node: Node) -> Value:
    below = inference.value(node.args[0])
    if below is ZERO:
        raise Unreadable
    return inference.power(below, Fraction(-1))


def _power(inference: UnitInference, node: Node) -> Value:
    base, exponent = inference.value(node.args[0]), number_of(node.args[1])
    if exponent is not None:
        return inference.power(base, exponent) if exponent else NOTHING
    inference.plain(
        inference.value(node.args[1]), f"the exponent {piece_text(node.args[1])} is {{0}} instead of a number"
    )
    return inference.plain(
        base,
        f"{piece_text(node.args[0])}, the base of a power with letters in its exponent, is {{0}} instead of a number",
    )


def _index(inference: UnitInference, node: Node) -> Value:
    rows = inference.matrix(node.args[0])
    places = [number_of(index) for index in node.args[1:]]
    if len(places) == 1:
        places = [places[0], Fraction(0)] if len(rows[0]) == 1 else [Fraction(0), places[0]]
    if None in places or any(place != int(place or 0) for place in places):
        raise Unreadable
    try:
        entry: Value = rows[int(places[0] or 0)][int(places[1] or 0)]
    except IndexError:
        raise Unreadable from None
    return entry


def _list(inference: UnitInference, node: Node) -> Any:
    return [inference.value(member) for member in node.args]


def _call(inference: UnitInference, node: Node) -> Value:
    if node.value in inference.calls:
        return inference.calls[node.value](inference, node)
    if node.args and all(argument.kind == "name" for argument in node.args):
        return inference.unit_of(node.value)
    raise Unreadable


_VALUE: dict[str, Callable[[UnitInference, Node], Any]] = {
    "number": _number, "name": _name, "sum": _sum, "product": _product, "inv": _inverse, "power": _power,
    "neg": lambda inference, node: inference.value(node.args[0]), "index": _index, "list": _list, "call": _call,
    "transpose": lambda inference, node: tuple(zip(*inference.matrix(node.args[0]), strict=True)),
}  # fmt: skip
