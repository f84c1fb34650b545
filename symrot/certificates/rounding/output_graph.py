"""The computation of one output as a graph, in the form in which its rounding error is bounded.

A graph contains the operations on which an output depends. Inputs are numbered by first use, so that equal
computations of different kernels are equal graphs. A computation such as sin(x)/x, whose steps have infinite
derivatives at 0, is a single node.
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

__all__ = ["OutputGraph", "output_graph"]

POLYNOMIAL = ("in", "const", "neg", "add", "sub", "mul", "square")
CALLS = ("sin", "cos", "atan2")


@dataclass(frozen=True)
class OutputGraph:
    """The computation of one output: nodes, each after its operands; the last node is the output."""

    precision: str
    places: tuple[str, ...]  # place of each input, by number
    # a node is a tuple of a kind and its operands, indices of earlier nodes; besides those of ``Operations``:
    #     ("in", number)                     an input
    #     ("square", i) ("sin", i) ("cos", i) ("atan2", i, j)
    #     ("norm", roundings, i, ...)        sqrt of a sum of squares, computed with ``roundings`` roundings; its
    #                                        derivative x/|x| is at most 1 even at zero
    #     ("sinc", i)                        x == 0 ? 1 : sin(x)/x
    #     ("arc_ratio", i, j)                s == 0 ? 1/c : atan2(s, c)/s, with s a root and c not negative
    #     ("gap", name, OutputGraph, i)      x*x < split ? series : formula, for (x - sin x)/x^3 or
    #                                        (sin x - x cos x)/x^3, with its own computation from x
    #     ("select", condition, x, y)        x if the condition holds, else y
    nodes: tuple[Node, ...]
    # (relation, i, j) compares the nodes i and j
    conditions: tuple[tuple[str, int, int], ...]

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of the computation, independent of the names of the inputs."""
        nodes = [[item.digest if isinstance(item, OutputGraph) else str(item) for item in node] for node in self.nodes]
        text = json.dumps([self.precision, nodes, self.conditions], separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    @cached_property
    def inputs_of(self) -> tuple[frozenset[int], ...]:
        """For each node, the set of the numbers of the inputs on which it depends."""
        inputs: list[frozenset[int]] = []
        for node in self.nodes:
            if node[0] == "in":
                inputs.append(frozenset([node[1]]))
                continue
            operands = operand_places(node)
            if node[0] == "select":
                operands = (*operands, *self.conditions[node[1]][1:])
            inputs.append(frozenset().union(*(inputs[i] for i in operands)))
        return tuple(inputs)

    @cached_property
    def is_polynomial(self) -> bool:
        """Whether the output is a polynomial in the inputs.

        A polynomial can be enclosed on a box by its mean value form: the value at the middle of the box plus slopes on
        the box times deviations from the middle.
        """
        return all(node[0] in POLYNOMIAL for node in self.nodes)

    @cached_property
    def contraction_safe(self) -> bool:
        """Whether the rounding error bound of this output also holds if a compiler uses fused multiply-adds."""
        users: list[list[int]] = [[] for _ in self.nodes]
        for index in range(len(self.nodes) - 1, -1, -1):
            for place in operand_places(self.nodes[index]):
                users[place] += users[index] if self.nodes[index][0] == "neg" else [index]
        # It holds if each product in a sum is used nowhere else: one rounding error replaces two, and is at most their
        # sum. A product that is fused in one sum and rounded in another has two values; the bound would let the effects
        # of one error cancel.
        fused = all(
            len(users[k]) == 1 or not any(self.nodes[user][0] in ("add", "sub") for user in users[k])
            for k, node in enumerate(self.nodes)
            if node[0] in ("mul", "square")
        )
        return fused and all(node[2].contraction_safe for node in self.nodes if node[0] == "gap")

    @cached_property
    def exact(self) -> tuple[bool, ...]:
        """For each node, whether its computed value certainly has no rounding error."""
        flags: list[bool] = []
        for node in self.nodes:
            kind = node[0]
            # inputs, constants with few significant bits such as 1/2, and their negatives and absolute values
            own = kind in ("in", "neg", "abs", "copysign") or (kind == "const" and is_short(node[1]))
            flags.append(own and all(flags[i] for i in operand_places(node)))
        return tuple(flags)

    @cached_property
    def choices(self) -> tuple[tuple[str, bool], ...]:
        """The conditionals that compare rounded numbers, but not those that select a series near zero.

        Each is a pair (condition, whether its branches are equal modulo 2 pi).
        """
        choices = []
        for number, (relation, i, j) in enumerate(self.conditions):
            if (self.exact[i] and self.exact[j]) or relation == "<":
                continue
            turns = all(
                _modulo_two_pi(self, node[2]) == _modulo_two_pi(self, node[3])
                for node in self.nodes
                if node[0] == "select" and node[1] == number
            )
            choices.append((f"{self._text(i)} {relation} {self._text(j)}", turns))
        return tuple(choices)

    def _text(self, index: int, depth: int = 4) -> str:
        node = self.nodes[index]
        if node[0] == "in":
            return self.places[node[1]]
        if node[0] == "const":
            return repr(float(node[1]))
        if not depth:
            return ".."
        operands = [self._text(i, depth - 1) for i in operand_places(node)]
        if node[0] in _SIGNS:
            return f"({f' {_SIGNS[node[0]]} '.join(operands)})"
        return f"{node[0]}({', '.join(operands)})"

    def singular_operand(self, index: int) -> int:
        """Return the divisor of a quotient or the radicand of a root; for any other node, ``index`` itself."""
        # where it is 0, the value of the quotient or the derivative of the root is infinite
        node = self.nodes[index]
        return int({"div": node[-1], "sqrt": node[-1]}.get(node[0], index))

    def text(self, index: int) -> str:
        """Return a node as a short formula for messages."""
        return self._text(index)


_SIGNS = {"add": "+", "sub": "-", "mul": "*", "div": "/"}


def operand_places(node: Node) -> tuple[int, ...]:
    """Return the indices of the nodes that are operands of a node of a graph."""
    if node[0] in ("in", "const"):
        return ()
    if node[0] == "gap":
        return (node[3],)
    return tuple(node[2:]) if node[0] in ("norm", "select") else tuple(node[1:])


def is_short(value: Fraction) -> bool:
    """Return whether a constant has so few significant bits that it stands for itself, not for a rounded number."""
    above = abs(value.numerator)
    odd = above // (above & -above) if above else 0
    return odd.bit_length() <= SHORT and value.denominator & (value.denominator - 1) == 0


def _modulo_two_pi(graph: OutputGraph, index: int, sign: int = 1) -> tuple[int, int]:
    """Return (i, s) such that ``s`` times node i equals ``sign`` times node ``index`` modulo 2 pi."""
    # constants near 2 pi are dropped from sums; a sine or cosine of the simpler node replaces that of the sum
    node = graph.nodes[index]
    if node[0] == "neg":
        return _modulo_two_pi(graph, node[1], -sign)
    if node[0] == "select":
        first, second = _modulo_two_pi(graph, node[2], sign), _modulo_two_pi(graph, node[3], sign)
        return first if first == second else (index, sign)
    if node[0] in ("add", "sub"):
        left, right = node[1:]
        if _is_two_pi(graph.nodes[right]):
            return _modulo_two_pi(graph, left, sign)
        # 2*pi - x gives (index of x, -1)
        if _is_two_pi(graph.nodes[left]):
            return _modulo_two_pi(graph, right, sign if node[0] == "add" else -sign)
    return index, sign


def _is_two_pi(node: Node) -> bool:
    return node[0] == "const" and abs(abs(float(node[1])) - 6.283185307179586) < 1e-6


class _GraphReader:
    """A reader that copies the operations on which one output depends into an :class:`OutputGraph`."""

    def __init__(self, operations: Operations, leaf: int = -1) -> None:
        self.operations, self.leaf = operations, leaf  # the leaf becomes an input of the graph
        self.source = operations.nodes
        self.nodes: list[Node] = []
        self.known: dict[Any, int] = {}
        self.numbers: dict[str, int] = {}
        self.conditions: list[tuple[str, int, int]] = []
        self.done: dict[int, int] = {}
        self.root = -1  # the output of the graph inside a gap, which must not become a gap again

    def put(self, *node: Any) -> int:
        """Return the index of a node in the graph; a new node is added to the graph first."""
        if node not in self.known:
            self.known[node] = len(self.nodes)
            self.nodes.append(node)
        return self.known[node]

    def read(self, index: int) -> int:
        """Return the index of the graph's node for the kernel's operation ``index``; the operation is copied once."""
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
            place = pattern(self, node)
            if place is not None:
                return place
        if kind == "select":
            left, right = self.read(node[2]), self.read(node[3])
            condition = (node[1], left, right)
            if condition not in self.conditions:
                self.conditions.append(condition)
            return self.put("select", self.conditions.index(condition), self.read(node[4]), self.read(node[5]))
        if kind == "call":
            if node[1] not in CALLS:
                raise CertificateError(
                    f"expected a function whose error is known, one of {', '.join(CALLS)}, got {node[1]}"
                )
            return self.put(node[1], *(self.read(i) for i in node[2]))
        return self.put(kind, *(self.read(i) for i in operands(node)))

    def squares(self, index: int, depth: int = 0) -> list[tuple[int, int]] | None:
        """Return (x, roundings) for each term x^2 of a sum: (a, 2), (b, 3), (c, 3) for a^2 + (b^2 + c^2).

        The result is None if the operation ``index`` is no sum of squares. ``depth`` is the number of additions that
        were passed on the way from the whole sum down to this operation.
        """
        node = self.source[index]
        # one rounding in the square, and one in each addition
        if node[0] == "mul" and node[1] == node[2]:
            return [(node[1], depth + 1)]
        if node[0] == "add":
            left, right = (self.squares(i, depth + 1) for i in node[1:])
            return left + right if left and right else None
        return None


def _norm(reader: _GraphReader, node: Node) -> int | None:
    """Return the node ``norm`` if the operation is the root of a sum of squares, otherwise None."""
    squares = reader.squares(node[1]) if node[0] == "sqrt" else None
    if not squares:
        return None
    return reader.put("norm", max(depth for _, depth in squares), *(reader.read(i) for i, _ in squares))


def _at_zero(reader: _GraphReader, node: Node) -> tuple[Node, Node] | None:
    """Return the branches ``limit`` and ``y/x`` if the operation is ``x == 0 ? limit : y/x``, otherwise None."""
    if node[0] != "select" or node[1] != "==" or reader.source[node[3]] != ("const", Fraction(0)):
        return None
    then, other = reader.source[node[4]], reader.source[node[5]]
    return (then, other) if other[0] == "div" and other[2] == node[2] else None


def _sinc(reader: _GraphReader, node: Node) -> int | None:
    """Return the node ``sinc`` if the operation is ``x == 0 ? 1 : sin(x)/x``, otherwise None."""
    branches = _at_zero(reader, node)
    if not branches or branches[0] != ("const", Fraction(1)):
        return None
    if reader.source[branches[1][1]] != ("call", "sin", (node[2],)):
        return None
    return reader.put("sinc", reader.read(node[2]))


def _arc_ratio(reader: _GraphReader, node: Node) -> int | None:
    """Return the node ``arc_ratio`` if the operation is ``s == 0 ? 1/c : atan2(s, c)/s``, otherwise None."""
    branches = _at_zero(reader, node)
    if not branches or branches[0][0] != "div" or reader.source[branches[0][1]] != ("const", Fraction(1)):
        return None
    s, c = node[2], branches[0][2]
    if reader.source[branches[1][1]] != ("call", "atan2", (s, c)):
        return None
    if reader.source[s][0] != "sqrt" or reader.source[c][0] != "abs":
        return None
    return reader.put("arc_ratio", reader.read(s), reader.read(c))


_GAPS = {"sine_gap": Fraction(1, 6), "tangent_gap": Fraction(1, 3)}  # function -> value at zero


def _at_origin(reader: _GraphReader, index: int, square: int) -> Fraction | None:
    """Return the constant term of a polynomial in the operation ``square``: 1/6 for ``1/6 - square*(1/120)``.

    The result is None if the operation ``index`` is no such polynomial.
    """
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


def _gap(reader: _GraphReader, node: Node) -> int | None:
    """Return a new node for (x - sin x)/x^3 or (sin x - x cos x)/x^3 if ``node`` has its form, else None.

    The form is ``x*x < c ? series : formula``, with 1/6 or 1/3 as the value of the series at 0. Nothing else is checked
    here; that the C text computes the function is proven in laws/equality.py.
    """
    if node[0] != "select" or node[1] != "<" or reader.source[node[2]][0] != "mul":
        return None
    leaf, other = reader.source[node[2]][1:]
    # these formulas lose all digits near 0
    origin = _at_origin(reader, node[4], node[2])
    names = [name for name, value in _GAPS.items() if origin is not None and abs(origin - value) < Fraction(1, 2**20)]
    if leaf != other or not names:
        return None
    inner = _GraphReader(reader.operations, leaf)
    inner.root = reader.source.index(node)
    inner.read(inner.root)
    if list(inner.numbers) != ["x"]:
        return None
    own = OutputGraph(reader.operations.precision, ("x",), tuple(inner.nodes), tuple(inner.conditions))
    return reader.put("gap", names[0], own, reader.read(leaf))


_PATTERNS: tuple[Callable[[_GraphReader, Node], int | None], ...] = (_norm, _sinc, _arc_ratio, _gap)


def output_graph(operations: Operations, index: int) -> OutputGraph:
    """Return the graph of the operations on which one node of a kernel depends.

    Raises
    ------
    CertificateError
        If the node depends on a function for which no error is known.
    """
    reader = _GraphReader(operations)
    reader.read(index)
    places = tuple(sorted(reader.numbers, key=reader.numbers.__getitem__))
    return OutputGraph(operations.precision, places, tuple(reader.nodes), tuple(reader.conditions))
