"""Writing formulas in the notation that the user typed: SymPy syntax, or plain text with ``^``, ``=`` and primes."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from decimal import Decimal
from fractions import Fraction
from typing import Protocol

from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.tree import Node, is_derivative, is_rate, text
from symrot.checker.typed.readings import Reading, Relation
from symrot.errors import InputError

__all__ = ["Notation", "TypedNotation", "notation_of", "with_formulas"]


SIGN = re.compile(r"( and | or |[<>!=]=|[<>])")
"""Pattern of what separates the formulas of a condition such as ``0 <= x**2``: a comparison sign, "and" or "or"."""


class Notation(Protocol):
    """The notation of the user's text, such as LaTeX or SymPy syntax: answers are written in it too."""

    def formula(self, node: Node) -> str:
        """Return the text of a formula's tree in this notation."""

    def relation(self, relation: Relation) -> str:
        """Return the text of an equation or inequality in this notation."""

    def rewritten(self, source: str) -> str:
        """Return an equation in SymPy syntax as text in this notation. Words after the equation stay unchanged."""

    def condition(self, source: str) -> str:
        """Return a condition in SymPy syntax, such as ``0 <= x <= pi``, as text in this notation."""


@dataclass(frozen=True)
class TypedNotation:
    """The notation of a text that was typed without LaTeX: SymPy syntax, or plain text.

    Attributes
    ----------
    plain : bool
        True for plain text, with ``^`` for powers and ``=`` in equations; False for SymPy syntax.
    spelling : mapping
        Name in the tree -> name as it was typed.
    timed : frozenset of str
        Functions of time that are typed without ``(t)``.
    """

    plain: bool = False
    spelling: Mapping[str, str] = field(default_factory=dict)
    timed: frozenset[str] = frozenset()

    def formula(self, node: Node) -> str:
        """Return the text of a tree in this notation."""
        if not self.plain:
            return text(node)
        plain = text(self._spelled(node)).replace("**", "^")
        return plain.replace("real_part(", "Re(").replace("imaginary_part(", "Im(")

    def _spelled(self, node: Node, parent: str = "") -> Node:
        """Return a tree in the user's spelling, such as ``q'`` for ``diff(q(t), t)``, and ``[..]`` for
        ``Matrix([..])``.
        """
        if is_derivative(node):
            name = str(node.args[0].value)
            has_prime = is_rate(node) and (node.args[0].kind == "call" or name in self.timed)
            if not self.timed or not has_prime:
                return replace(node, args=tuple(self._in_full(child) for child in node.args))
            return Node("name", self.spelling.get(name, name) + "'" * (len(node.args) - 1))
        if node.kind == "call" and node.value in self.timed:
            return Node("name", self.spelling.get(str(node.value), node.value))
        if node.kind == "call" and node.value == "qmul":
            factors = [self._spelled(factor, "call") for factor in node.args]
            return Node("name", " ⊗ ".join(f"({text(f)})" if f.kind in BOUND_LOOSELY else text(f) for f in factors))
        # inside a call, a power or an index, brackets alone would be ambiguous
        if node.kind == "call" and node.value == "Matrix" and parent not in ("call", "power", "index"):
            return self._spelled(node.args[0], "list")
        if node.kind == "number":
            return Node("name", decimal(node.value))
        if node.kind == "name" and node.value in self.spelling:
            return Node("name", self.spelling[str(node.value)])
        args = [self._spelled(child, node.kind) for child in node.args]
        if node.kind == "product":
            args = [
                Node("name", f"({text(factor)})") if _is_odd_power(factor) and _is_over_digits(after) else factor
                for factor, after in zip(args, [*args[1:], END], strict=True)
            ]
        return replace(node, args=tuple(args))

    def _in_full(self, node: Node) -> Node:
        """Return a formula with ``f(t)`` for each function f of time, as it must be written inside ``diff(..)``."""
        name = self.spelling.get(str(node.value), node.value) if node.kind in ("name", "call") else node.value
        return replace(node, value=name, args=tuple(map(self._in_full, node.args)))

    def relation(self, relation: Relation) -> str:
        """Return the text of a relation in this notation."""
        sign, left, right = relation
        return f"{self.formula(left)} {'=' if self.plain and sign == '==' else sign} {self.formula(right)}"

    def rewritten(self, source: str) -> str:
        """Return an equation or inequality in SymPy syntax as text in this notation, or unchanged if it is unreadable.

        Words after the relation (``with w == ..``) stay unchanged.
        """
        if not self.plain:
            return source
        claim, joint, rest = source.partition(" with ")
        try:
            return self.relation(read_relation(claim)) + joint + rest
        except InputError:
            return source

    def condition(self, source: str) -> str:
        """Return a condition in SymPy syntax as text in this notation."""
        return with_formulas(source, self.formula, {"==": "="}) if self.plain else source


def with_formulas(source: str, formula: Callable[[Node], str], signs: Mapping[str, str]) -> str:
    """Return a condition such as ``0 <= x**2`` in another notation, or unchanged if it is unreadable.

    ``formula`` returns the text of a formula in the other notation. ``signs`` maps ``==`` and other signs of SymPy
    syntax to the signs of the other notation.
    """
    pieces = SIGN.split(source)
    try:
        formulas = [formula(read_expression(piece)) for piece in pieces[::2]]
    except InputError:
        return source
    between = [signs.get(sign.strip(), sign.strip()) for sign in pieces[1::2]] + [""]
    return " ".join(f"{each} {sign}".strip() for each, sign in zip(formulas, between, strict=True))


def decimal(value: Fraction) -> str:
    """Return a number as text: an integer, an exact decimal of at most 28 significant digits, or else ``(1/3)``."""
    if value.denominator == 1:
        return str(value)
    written = format(Decimal(value.numerator) / Decimal(value.denominator), "f")
    return written if Fraction(written) == value else f"({value})"


def notation_of(reading: Reading) -> TypedNotation:
    """Return the notation in which a user typed the text of a reading (interpretation): SymPy syntax or plain text."""
    return TypedNotation(reading.plain, dict(reading.spelling), reading.timed)


BOUND_LOOSELY = ("sum", "neg", "product")
"""Kinds of trees that need brackets in a product of quaternions."""

END = Node("name", "")
"""A placeholder after the last factor of a product: each factor is examined together with the one after it."""


def _is_odd_power(node: Node) -> bool:
    """Return whether a tree in the user's spelling is a power whose exponent is the digit 1, 3, 5, 7 or 9: x^3.

    Such a power gets brackets before a slash and a number, since x^3/2 might be read as x^(3/2). An even power gets
    none, since everybody reads L^2/3 as (L^2)/3.
    """
    return node.kind == "power" and node.args[1].kind == "name" and str(node.args[1].value) in ("1", "3", "5", "7", "9")


def _is_over_digits(node: Node) -> bool:
    """Return whether a factor is a slash and an integer, such as ``/2``."""
    return node.kind == "inv" and str(node.args[0].value).isdigit()
