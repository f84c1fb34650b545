"""What one output depends on, in the form in which its rounding error is bounded.

The operations behind an output, renumbered so that equal computations look equal whatever their kernel: inputs are
numbered by first use. Computations that have a finite derivative only as a whole are one node each:

``norm``: the root of a sum of squares, whose derivative x/|x| is at most 1 at zero too;
``sinc``: ``x == 0 ? 1 : sin(x)/x``;  ``arc_ratio``: ``s == 0 ? 1/c : atan2(s, c)/s`` with s a root and c not negative;
``gap``: ``x*x < split ? series : formula`` of (x - sin x)/x^3 or (sin x - x cos x)/x^3, with its own computation.
"""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from symrot.certificates.readback.intended_constants import SHORT
from symrot.certificates.readback.operations import Node, Operations, operands
from symrot.errors import CertificateError

__all__ = ["Cone", "cone_of"]

POLYNOMIAL = ("in", "const", "neg", "add", "sub", "mul", "square")
CALLS = ("sin", "cos", "atan2")


@dataclass(frozen=True)
class Cone:
    """The computation of one output: nodes with operands before them, the last node is the output.

    Beside the kinds of :class:`Operations` there are ``("square", i)``, ``("sin", i)``, ``("cos", i)``,
    ``("atan2", i, j)``, ``("norm", roundings, i, ...)``, ``("sinc", i)``, ``("arc_ratio", i, j)``,
    ``("gap", name, Cone, i)`` and ``("select", condition, x, y)``; an input is ``("in", number)``. ``conditions`` are
    (relation, i, j).
    """

    precision: str
    places: tuple[str, ...]  # of the inputs, by number
    nodes: tuple[Node, ...]
    conditions: tuple[tuple[str, int, int], ...]

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of what is computed, whatever the inputs are called."""
        nodes = [[str(item) for item in node] for node in self.nodes]
        text = json.dumps([self.precision, nodes, self.conditions], separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    @cached_property
    def inputs_of(self) -> tuple[frozenset[int], ...]:
        """The inputs, by number, that each node depends on."""
        found: list[frozenset[int]] = []
        for node in self.nodes:
            if node[0] == "in":
                found.append(frozenset([node[1]]))
                continue
            taken = places_of(node)
            if node[0] == "select":
                taken = (*taken, *self.conditions[node[1]][1:])
            found.append(frozenset().union(*(found[i] for i in taken)))
        return tuple(found)

    @cached_property
    def is_polynomial(self) -> bool:
        """Whether the output is a polynomial in its inputs."""
        return all(node[0] in POLYNOMIAL for node in self.nodes)

    @cached_property
    def contraction_safe(self) -> bool:
        """Whether the bound holds for fused multiply-adds too: each product that a sum takes is used by nothing else.

        A fused product has no rounding error of its own, and the sum errs by no more than both did. A product that is
        fused in one place and rounded in another has two errors, which derivatives of opposite sign do not cancel.
        """
        users: list[list[int]] = [[] for _ in self.nodes]
        for index in range(len(self.nodes) - 1, -1, -1):
            for place in places_of(self.nodes[index]):
                users[place] += users[index] if self.nodes[index][0] == "neg" else [index]
        fused = all(
            len(users[k]) == 1 or not any(self.nodes[user][0] in ("add", "sub") for user in users[k])
            for k, node in enumerate(self.nodes)
            if node[0] in ("mul", "square")
        )
        return fused and all(node[2].contraction_safe for node in self.nodes if node[0] == "gap")

    @cached_property
    def exact(self) -> tuple[bool, ...]:
        """Which nodes are computed without any error before them: inputs, their signs, short constants."""
        found: list[bool] = []
        for node in self.nodes:
            kind = node[0]
            own = kind in ("in", "neg", "abs", "copysign") or (kind == "const" and is_short(node[1]))
            found.append(own and all(found[i] for i in places_of(node)))
        return tuple(found)

    @cached_property
    def choices(self) -> tuple[tuple[str, bool], ...]:
        """Each condition on what is rounded: its text, and whether its branches differ by whole turns only."""
        found = []
        for number, (relation, i, j) in enumerate(self.conditions):
            if (self.exact[i] and self.exact[j]) or relation == "<":
                continue
            turns = all(
                _turned(self, node[2]) == _turned(self, node[3])
                for node in self.nodes
                if node[0] == "select" and node[1] == number
            )
            found.append((f"{self._text(i)} {relation} {self._text(j)}", turns))
        return tuple(found)

    def _text(self, index: int, depth: int = 4) -> str:
        node = self.nodes[index]
        if node[0] == "in":
            return self.places[node[1]]
        if node[0] == "const":
            return repr(float(node[1]))
        if not depth:
            return ".."
        taken = [self._text(i, depth - 1) for i in places_of(node)]
        if node[0] in _SIGNS:
            return f"({f' {_SIGNS[node[0]]} '.join(taken)})"
        return f"{node[0]}({', '.join(taken)})"

    def culprit(self, index: int) -> int:
        """Return the operand that makes a node infinite: a divisor, what a root is taken of, or the node itself."""
        node = self.nodes[index]
        return int({"div": node[-1], "sqrt": node[-1]}.get(node[0], index))

    def text(self, index: int) -> str:
        """Return a node as a short formula, for people."""
        return self._text(index)


_SIGNS = {"add": "+", "sub": "-", "mul": "*", "div": "/"}


def places_of(node: Node) -> tuple[int, ...]:
    """Return the operands of a node of a cone."""
    if node[0] in ("in", "const"):
        return ()
    if node[0] == "gap":
        return (node[3],)
    return tuple(node[2:]) if node[0] in ("norm", "select") else tuple(node[1:])


def is_short(value: Fraction) -> bool:
    """Tell whether a constant stands for itself: one of few significant bits, as link 3 reads it."""
    above = abs(value.numerator)
    odd = above // (above & -above) if above else 0
    return odd.bit_length() <= SHORT and value.denominator & (value.denominator - 1) == 0


def _turned(cone: Cone, index: int, sign: int = 1) -> tuple[int, int]:
    """Return what a node is but for whole turns and sign: a sum with a constant near 2 pi is what is added to it."""
    node = cone.nodes[index]
    if node[0] == "neg":
        return _turned(cone, node[1], -sign)
    if node[0] == "select":
        first, second = _turned(cone, node[2], sign), _turned(cone, node[3], sign)
        return first if first == second else (index, sign)
    if node[0] in ("add", "sub"):
        left, right = node[1:]
        if _is_turn(cone.nodes[right]):
            return _turned(cone, left, sign)
        if _is_turn(cone.nodes[left]):
            return _turned(cone, right, sign if node[0] == "add" else -sign)
    return index, sign


def _is_turn(node: Node) -> bool:
    return node[0] == "const" and abs(abs(float(node[1])) - 6.283185307179586) < 1e-6


class _Reader:
    """Copies the operations behind one output into a cone."""

    def __init__(self, operations: Operations, leaf: int = -1) -> None:
        self.operations, self.leaf = operations, leaf  # the leaf is an input, whatever it is computed from
        self.source = operations.nodes
        self.nodes: list[Node] = []
        self.known: dict[Any, int] = {}
        self.numbers: dict[str, int] = {}
        self.conditions: list[tuple[str, int, int]] = []
        self.done: dict[int, int] = {}
        self.root = -1  # that of a gap is read as it stands

    def put(self, *node: Any) -> int:
        if node not in self.known:
            self.known[node] = len(self.nodes)
            self.nodes.append(node)
        return self.known[node]

    def read(self, index: int) -> int:
        if index not in self.done:
            self.done[index] = self._read(self.source[index], index)
        return self.done[index]

    def _read(self, node: Node, index: int) -> int:
        kind = node[0]
        if index == self.leaf:
            return self.put("in", self.numbers.setdefault("x", len(self.numbers)))
        if kind == "in":
            return self.put("in", self.numbers.setdefault(node[1], len(self.numbers)))
        if kind == "const":
            return self.put(*node)
        if kind == "mul" and node[1] == node[2]:
            return self.put("square", self.read(node[1]))
        for pattern in _PATTERNS if index != self.root else ():
            found = pattern(self, node)
            if found is not None:
                return found
        if kind == "select":
            left, right = self.read(node[2]), self.read(node[3])
            condition = (node[1], left, right)
            if condition not in self.conditions:
                self.conditions.append(condition)
            return self.put("select", self.conditions.index(condition), self.read(node[4]), self.read(node[5]))
        if kind == "call":
            if node[1] not in CALLS:
                raise CertificateError(f"expected one of {', '.join(CALLS)} where an error is bounded, got {node[1]}")
            return self.put(node[1], *(self.read(i) for i in node[2]))
        return self.put(kind, *(self.read(i) for i in operands(node)))

    def squares(self, index: int, depth: int = 0) -> list[tuple[int, int]] | None:
        """Return (what is squared, roundings above it) of a sum of squares."""
        node = self.source[index]
        if node[0] == "mul" and node[1] == node[2]:
            return [(node[1], depth + 1)]
        if node[0] == "add":
            left, right = (self.squares(i, depth + 1) for i in node[1:])
            return left + right if left and right else None
        return None


def _norm(reader: _Reader, node: Node) -> int | None:
    squares = reader.squares(node[1]) if node[0] == "sqrt" else None
    if not squares:
        return None
    return reader.put("norm", max(depth for _, depth in squares), *(reader.read(i) for i, _ in squares))


def _at_zero(reader: _Reader, node: Node) -> tuple[Node, Node] | None:
    """Return both branches of a choice between a limit at zero and a quotient by what is compared."""
    if node[0] != "select" or node[1] != "==" or reader.source[node[3]] != ("const", Fraction(0)):
        return None
    then, other = reader.source[node[4]], reader.source[node[5]]
    return (then, other) if other[0] == "div" and other[2] == node[2] else None


def _sinc(reader: _Reader, node: Node) -> int | None:
    branches = _at_zero(reader, node)
    if not branches or branches[0] != ("const", Fraction(1)):
        return None
    if reader.source[branches[1][1]] != ("call", "sin", (node[2],)):
        return None
    return reader.put("sinc", reader.read(node[2]))


def _arc_ratio(reader: _Reader, node: Node) -> int | None:
    branches = _at_zero(reader, node)
    if not branches or branches[0][0] != "div" or reader.source[branches[0][1]] != ("const", Fraction(1)):
        return None
    s, c = node[2], branches[0][2]
    if reader.source[branches[1][1]] != ("call", "atan2", (s, c)):
        return None
    if reader.source[s][0] != "sqrt" or reader.source[c][0] != "abs":
        return None
    return reader.put("arc_ratio", reader.read(s), reader.read(c))


_GAPS = {"sine_gap": Fraction(1, 6), "tangent_gap": Fraction(1, 3)}  # their values at zero


def _at_origin(reader: _Reader, index: int, square: int) -> Fraction | None:
    """Return the value at zero of a polynomial in ``square``; None for anything else."""
    node = reader.source[index]
    if index == square:
        return Fraction(0)
    if node[0] == "const":
        return Fraction(node[1])
    if node[0] not in ("add", "mul"):
        return None
    left, right = (_at_origin(reader, i, square) for i in node[1:])
    if left is None or right is None:
        return None
    return left + right if node[0] == "add" else left * right


def _gap(reader: _Reader, node: Node) -> int | None:
    if node[0] != "select" or node[1] != "<" or reader.source[node[2]][0] != "mul":
        return None
    leaf, other = reader.source[node[2]][1:]
    origin = _at_origin(reader, node[4], node[2])
    names = [name for name, value in _GAPS.items() if origin is not None and abs(origin - value) < Fraction(1, 2**20)]
    if leaf != other or not names:
        return None
    inner = _Reader(reader.operations, leaf)
    inner.root = reader.source.index(node)
    inner.read(inner.root)
    if list(inner.numbers) != ["x"]:
        return None
    own = Cone(reader.operations.precision, ("x",), tuple(inner.nodes), tuple(inner.conditions))
    return reader.put("gap", names[0], own, reader.read(leaf))


_PATTERNS: tuple[Callable[[_Reader, Node], int | None], ...] = (_norm, _sinc, _arc_ratio, _gap)


def cone_of(operations: Operations, index: int) -> Cone:
    """Return the computation of one node of a kernel.

    Raises
    ------
    CertificateError
        For a function whose rounding is not modelled.
    """
    reader = _Reader(operations)
    reader.read(index)
    places = tuple(sorted(reader.numbers, key=reader.numbers.__getitem__))
    return Cone(operations.precision, places, tuple(reader.nodes), tuple(reader.conditions))
