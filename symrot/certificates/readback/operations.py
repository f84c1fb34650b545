"""The operations of a kernel as a graph in which each node is one rounded floating-point operation.

Certificates compare such graphs and bound their rounding errors. Equal operations on equal operands share one node.
The name of a component is a text such as ``"q[1]"`` or ``"t"``. No code is shared with the emitter, whose mistakes
would be repeated.
"""

import hashlib
import json
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

__all__ = ["RELATIONS", "GraphBuilder", "Node", "Operations", "operands"]

# a tuple; i, j, x, y are indices of earlier nodes:
#     ("in", component)   ("const", Fraction)   ("neg", i)  ("abs", i)  ("sqrt", i)
#     ("add", i, j)  ("sub", i, j)  ("mul", i, j)  ("div", i, j)  ("copysign", i, j)
#     ("call", name, (i, ...))          ("select", relation, i, j, x, y): x if node i relation node j, else y
Node = tuple[Any, ...]

RELATIONS: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
}  # fmt: skip


def operands(node: Node) -> tuple[int, ...]:
    """Return the indices of the earlier nodes from which a node is computed; empty for an input or a constant."""
    kind = node[0]
    if kind in ("in", "const"):
        return ()
    if kind == "call":
        return tuple(node[2])
    return tuple(node[2:]) if kind == "select" else tuple(node[1:])


@dataclass(frozen=True)
class Operations:
    """The operations of a C function, as a graph with one node for each rounded operation."""

    name: str
    # "binary64" or "binary32"
    precision: str
    # components such as "q[1]" or "t", in the order of the arguments
    inputs: tuple[str, ...]
    # only operations that some output needs, each after its operands
    nodes: tuple[Node, ...]
    # (component, index of its node), in the order of the arguments
    outputs: tuple[tuple[str, int], ...]

    def evaluate(
        self,
        values: Mapping[str, Any],
        functions: Mapping[str, Callable[..., Any]],
        number: Callable[[Fraction], Any],
    ) -> dict[str, Any]:
        """Evaluate the operations in any arithmetic, such as intervals; return a map from each output to its value.

        Parameters
        ----------
        values : mapping of str
            A map from the place of each input, such as ``"q[1]"``, to its value.
        functions : mapping of str to callable
            The functions that the nodes call (``sin``, ...), and ``sqrt``, ``abs``, ``copysign`` and ``select`` (with
            the arguments relation, i, j, x, y) if the kind of number has no operator for them.
        number : callable
            Converts a constant, a Fraction, to the kind of number.
        """
        known: list[Any] = []
        for node in self.nodes:
            known.append(_node_value(node, known, values, functions, number))
        return {place: known[index] for place, index in self.outputs}

    def counts(self) -> dict[str, int]:
        """Return the number of operations of each kind, such as ``{"add": 2, "sin": 1}``."""
        names = [node[1] if node[0] == "call" else node[0] for node in self.nodes if node[0] not in ("in", "const")]
        return {name: names.count(name) for name in sorted(set(names))}

    def digest(self) -> str:
        """Return the SHA-256 of the computation alone: neither the kernel's name nor its unused inputs change it."""
        # the empty entries keep the digests equal to those in certificates that were written before
        data = {
            "name": "", "precision": self.precision, "inputs": [], "nodes": self.nodes, "outputs": self.outputs,
        }  # fmt: skip
        text = json.dumps(data, sort_keys=True, separators=(",", ":"), default=str)  # constants as text
        return hashlib.sha256(text.encode()).hexdigest()


def _node_value(
    node: Node, known: Sequence[Any], values: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]], number: Callable[[Fraction], Any],
) -> Any:  # fmt: skip
    """Return the value of one operation from ``known``, the values of the operations before it.

    The other arguments are those of :meth:`Operations.evaluate`.
    """
    kind = node[0]
    if kind == "in":
        return values[node[1]]
    if kind == "const":
        return number(node[1])
    arguments = [known[i] for i in operands(node)]
    if kind == "call":
        return functions[node[1]](*arguments)
    if kind in functions:
        return functions[kind](node[1], *arguments) if kind == "select" else functions[kind](*arguments)
    if kind == "select":
        return arguments[2] if RELATIONS[node[1]](arguments[0], arguments[1]) else arguments[3]
    return _ARITHMETIC[kind](*arguments)


_ARITHMETIC: dict[str, Callable[..., Any]] = {
    "add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv, "neg": operator.neg,
    "abs": abs,
}  # fmt: skip


class GraphBuilder:
    """A builder of :class:`Operations`: it stores equal nodes once, and drops nodes that no output needs."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.places: dict[Node, int] = {}

    def add(self, *node: Any) -> int:
        """Return the index of a node in the graph; a new node is added to the graph first."""
        if node not in self.places:
            self.places[node] = len(self.nodes)
            self.nodes.append(node)
        return self.places[node]

    def finish(
        self, name: str, precision: str, inputs: Sequence[str], outputs: Sequence[tuple[str, int]]
    ) -> Operations:
        """Return the operations on which ``outputs`` depend, numbered in the order of their first use."""
        # outputs are pairs (component such as "q[1]", index of its node)
        order: dict[int, int] = {}
        needed: list[Node] = []
        for _, root in outputs:
            stack = [(root, False)]
            while stack:
                index, ready = stack.pop()
                if index in order:
                    continue
                node = self.nodes[index]
                if ready:
                    order[index] = len(needed)
                    needed.append(_renumbered(node, order))
                else:
                    stack.append((index, True))
                    stack += [(operand, False) for operand in reversed(operands(node))]
        return Operations(
            name, precision, tuple(inputs), tuple(needed), tuple((place, order[index]) for place, index in outputs)
        )


def _renumbered(node: Node, order: Mapping[int, int]) -> Node:
    moved = tuple(order[i] for i in operands(node))
    if node[0] in ("in", "const"):
        return node
    if node[0] == "call":
        return ("call", node[1], moved)
    return ("select", node[1], *moved) if node[0] == "select" else (node[0], *moved)
