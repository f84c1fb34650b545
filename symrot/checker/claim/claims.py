"""Claims: equations to be checked, as syntax trees and as SymPy formulas.

The search for the fault of a false claim edits the trees.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from sympy import Expr, Symbol

from symrot.checker.claim.interpreter import Interpreter, time
from symrot.checker.claim.scope import Divisor
from symrot.checker.claim.shapes import shape_of
from symrot.checker.claim.tree import Node, nodes_of, number, substituted, text
from symrot.checker.context.context import NO_CONTEXT, Context
from symrot.checker.decide.equation import Equation
from symrot.checker.typed.readings import Relation
from symrot.errors import InputError
from symrot.exact.decision import ShapeMismatch, matched_sides

__all__ = ["SIDES", "Claim", "Definitions", "assumed_names", "relation_text"]


SIDES = ("left", "right")
SINGLE_EQUALS = re.compile(r"(?<![=<>!])=(?!=)")


@dataclass(frozen=True)
class Definitions:
    """The symbols and definitions of a claim as SymPy values.

    Attributes
    ----------
    values : mapping
        Name of a symbol or a definition -> its value.
    functions : frozenset of str
        Names of functions of time.
    divisors, radicands : tuple
        The divisors in the texts of the definitions, and the formulas there that must not be negative, as under a root.
    bases : tuple of Expr
        Bases of powers whose exponents are not numbers.
    """

    values: Mapping[str, Any]
    functions: frozenset[str]
    divisors: tuple[Divisor, ...]
    radicands: tuple[Expr, ...]
    bases: tuple[Expr, ...]


@dataclass(frozen=True)
class Claim:
    """One claim: its trees, and its formulas in SymPy, each computed once.

    Attributes
    ----------
    id, where : str
        The name of the claim, and its place in a document.
    symbols, functions : tuple of str
        Declared names of real symbols and of functions of time.
    define : tuple of (str, Node)
        Definitions in order, each of which may use those before it.
    hypotheses : tuple of Relation
        Equations and inequalities that the claim assumes, such as ``x > 0``.
    relation : Relation or None
        The equation; None for a formula that is compared with a printed number, ``value`` and ``printed``.
    value : Node or None
        A formula that is compared with a printed number; None for an equation.
    printed : str
        The decimal number that a document prints for ``value``.
    alternatives : tuple of Relation
        Other equations that the text may mean, for example if a document lost characters.
    implied : bool
        Whether undeclared names become real symbols and functions of time.
    sources : mapping
        Key such as ``"define.0"`` -> the text that was read, for error messages.
    units : mapping
        Name -> unit, ``{"x": "m"}``.
    notes : tuple of str
        Sentences about how the text is read.
    editable : tuple of str
        The parts that repairs may change: ``"left"``, ``"right"``, and names of definitions. They leave the other
        parts as they are.
    has_parts : bool
        Whether the equation was split: a complex one into real and imaginary parts, or one in index notation into
        components.
    context : Context
        Statements in words about the names of the claim and about the body, such as ``"rod"``.
    written : tuple of (Node, Node)
        Pairs (formula in ``relation``, its short form in the text): a rotation matrix and ``e^(theta K)``.
    unsplit : (str, Relation) or None
        The imaginary unit of a complex equation, and the equation before its split into real and imaginary parts.
    """

    id: str = ""
    where: str = ""
    symbols: tuple[str, ...] = ()
    functions: tuple[str, ...] = ()
    define: tuple[tuple[str, Node], ...] = ()
    hypotheses: tuple[Relation, ...] = ()
    relation: Relation | None = None
    value: Node | None = None
    printed: str = ""
    alternatives: tuple[Relation, ...] = ()
    implied: bool = False
    sources: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    editable: tuple[str, ...] = SIDES
    has_parts: bool = False
    context: Context = NO_CONTEXT
    written: tuple[tuple[Node, Node], ...] = ()
    unsplit: tuple[str, Relation] | None = None

    @property
    def has_double_equals(self) -> bool:
        """Whether the claim is a text with ``==``, as in code; a file of claims has no other sign for equality."""
        return self.implied and SINGLE_EQUALS.search(self.sources.get("claim", "=")) is None

    @property
    def without_context(self) -> "Claim":
        """The claim without its context: without what the user states in words about names and the body."""
        return replace(self, context=NO_CONTEXT)

    @property
    def defining(self) -> dict[str, Node]:
        """The scalar formulas by which hypotheses define names: {"c1": cos(alpha)} for ``c1 == cos(alpha)``."""
        definitions: dict[str, Node] = {}
        for sign, left, right in self.hypotheses:
            inside = {str(node.value) for node in nodes_of(right) if node.kind in ("name", "call")}
            if sign == "==" and left.kind == "name" and left.value not in inside and shape_of(right, {}) is None:
                definitions.setdefault(str(left.value), right)
        return definitions

    def with_definitions(self, value: Any) -> Any:
        """Return a SymPy value with ``cos(alpha)`` for c1, if a hypothesis defines ``c1 == cos(alpha)``; likewise other
        names.
        """
        interpreter = self.interpreter()
        for name, tree in self.defining.items():
            value = value.xreplace({interpreter.read(Node("name", name)): interpreter.read(tree)})
        return value

    @property
    def expanded(self) -> "Claim":
        """The claim without hypotheses that are definitions: ``c1 == x`` with ``c1 == cos(alpha)`` becomes ``cos(alpha)
        == x``.
        """
        definitions = self.defining
        if self.relation is None or not definitions:
            return self
        rest = tuple(
            hypothesis for hypothesis in self.hypotheses if definitions.get(str(hypothesis[1].value)) != hypothesis[2]
        )
        sign, left, right = self.relation
        relation = sign, substituted(left, definitions), substituted(right, definitions)
        return replace(self, relation=relation, hypotheses=rest, alternatives=())

    @property
    def text(self) -> str:
        """The claim as text."""
        if self.relation is None:
            return f"{self.sources['value']} == {self.printed}"
        return self.sources.get("claim") or relation_text(self.relation)

    def label(self, key: str) -> str:
        """Return the place of a text of the claim for error messages, such as ``"C3: define R"``.

        It is empty if the claim has no id.
        """
        # a claim that a user typed has no id; keys are claim, given, define NAME, value and printed_value
        return f"{self.id}: {key}" if self.id else ""

    def with_relation(self, relation: Relation, **changes: Any) -> "Claim":
        """Return the claim with the equation ``relation`` instead of its own, and with ``changes`` of other fields.

        The field ``define`` must not be changed: the computed values of the definitions are reused.
        """
        other = replace(self, relation=relation, **changes)
        if "definitions" in self.__dict__:
            other.__dict__["definitions"] = self.definitions
        return other

    def with_parts(self, parts: Mapping[str, Node]) -> "Claim":
        """Return the claim with the trees ``parts`` in place of its own: {"left": tree, "R": tree} for the left side
        and for the definition of R.
        """
        assert self.relation is not None
        sign, left, right = self.relation
        relation = (sign, parts.get("left", left), parts.get("right", right))
        if not parts.keys() - {*SIDES}:
            return self.with_relation(relation)
        define = tuple((name, parts.get(name, tree)) for name, tree in self.define)
        return replace(self, relation=relation, define=define)

    @cached_property
    def definitions(self) -> Definitions:
        """The symbols and definitions as SymPy values; a symbol is positive or nonnegative if a hypothesis says so.

        Raises
        ------
        InputError
            If a definition has no value in SymPy; the message gives its position.
        """
        interpreter = Interpreter(implied=self.implied, functions=set(self.functions))
        values = interpreter.values
        positive = assumed_names(self.hypotheses, ">")
        nonnegative = assumed_names(self.hypotheses, ">=")
        names = [*self.symbols, *(positive | nonnegative if self.implied else ())]
        for name in names:
            if name in positive:
                values[name] = Symbol(name, positive=True)
            elif name in nonnegative:
                values[name] = Symbol(name, nonnegative=True)
            else:
                values[name] = time if name == "t" else Symbol(name, real=True)
        for index, (name, node) in enumerate(self.define):
            source = self.sources.get(f"define.{index}", "")
            values[name] = interpreter.read(node, source, self.label(f"define {name}"))
        return Definitions(
            values, frozenset(interpreter.functions), tuple(interpreter.divisors), tuple(interpreter.radicands),
            tuple(interpreter.bases),
        )  # fmt: skip

    def interpreter(self) -> Interpreter:
        """Return a new interpreter that turns further syntax trees with the claim's names into SymPy."""
        known = self.definitions
        return Interpreter(
            values=dict(known.values), functions=set(known.functions), implied=self.implied,
            divisors=list(known.divisors), radicands=list(known.radicands), bases=list(known.bases),
        )  # fmt: skip

    @cached_property
    def equation(self) -> Equation:
        """The equation that the decision engine decides, with the hypotheses, divisors and roots of the claim.

        Raises
        ------
        InputError
            If a part of the claim has no value in SymPy; the message gives its position.
        """
        assert self.relation is not None
        interpreter = self.interpreter()
        hypotheses, nonzero = [], []
        for index, (sign, left, right) in enumerate(self.hypotheses):
            source = self.sources.get(f"given.{index}", "")
            lhs, rhs = (interpreter.read(side, source, self.label("given")) for side in (left, right))
            if sign == "==":
                hypotheses.extend(_differences(lhs, rhs, self.label("given")))
            elif sign == "!=":
                nonzero.extend(_differences(lhs, rhs, self.label("given")))
        source = self.sources.get("claim", "")
        left, right = self.relation[1:]
        lhs = interpreter.read(left, source, self.label("claim"))
        rhs = lhs if right is left else interpreter.read(right, source, self.label("claim"))
        divisors = tuple(dict.fromkeys(divisor.value for divisor in interpreter.divisors))
        radicands = tuple(dict.fromkeys(interpreter.radicands))
        same = text(left) == text(right)  # equal sides are equal for all bases
        bases = () if same else interpreter.assumed_bases
        return Equation(lhs, rhs, tuple(hypotheses), divisors, tuple(nonzero), radicands, bases)


def relation_text(relation: Relation) -> str:
    """Return a relation, such as ``left == right`` or ``x > 0``, as text."""
    sign, left, right = relation
    return f"{text(left)} {sign} {text(right)}"


def _differences(left: Any, right: Any, where: str) -> list[Expr]:
    """Return left - right of a hypothesis ``a == b`` or ``a != b``: one formula, or one for each entry of a matrix.

    Raise InputError if the shapes differ.
    """
    try:
        lefts, rights, _ = matched_sides(left, right)
    except ShapeMismatch:
        raise InputError(f"{where}: expected a hypothesis whose two sides have the same shape") from None
    return [a - b for a, b in zip(lefts, rights, strict=True)]


def assumed_names(hypotheses: Sequence[Relation], sign: str) -> set[str]:
    """Return the names x of hypotheses ``x > 0``, or of ``x >= 0`` for the ``sign`` ">="."""
    mirrored = {">": "<", ">=": "<="}[sign]
    names = set()
    for mark, left, right in hypotheses:
        if mark == mirrored:
            left, right = right, left
        if mark in (sign, mirrored) and left.kind == "name" and right == number(0):
            names.add(left.value)
    return names
