"""A kernel as data: its signature, and its formulas as a straight-line program. Standard library only.

A straight-line program is a list of assignments without loops and branches: first temporaries (intermediate results),
then outputs. Code generation writes it, propagation evaluates it.
"""

from collections import Counter
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypedDict

from symrot.formula.tree import Node, evaluate, names, operations, vanishes

__all__ = ["Argument", "Program", "ProgramRecord", "Signature", "node_from_json", "node_to_json"]


@dataclass(frozen=True)
class Argument:
    """One input or output argument of a kernel.

    ``components`` holds (name, unit, meaning) for each number in the argument; a scalar has one component.
    """

    name: str
    role: str  # "in" or "out"
    components: tuple[tuple[str, str, str], ...]
    is_scalar: bool = False

    @property
    def size(self) -> int:
        return len(self.components)

    @property
    def places(self) -> dict[str, tuple[str, str, str]]:
        """A map from the text of each component in emitted functions, such as ``"q[1]"``, to (name, unit, meaning)."""
        if self.is_scalar:
            return {self.name: self.components[0]}
        return {f"{self.name}[{i}]": component for i, component in enumerate(self.components)}


@dataclass(frozen=True)
class Signature:
    """The name of a kernel and its arguments, in the order of the emitted functions."""

    name: str
    arguments: tuple[Argument, ...]

    def argument(self, name: str) -> Argument:
        """Return the argument with a given name; raise ``KeyError`` if there is no such argument."""
        for argument in self.arguments:
            if argument.name == name:
                return argument
        raise KeyError(name)


class ProgramRecord(TypedDict):
    """A :class:`Program` as data for JSON; formulas are nested lists, see :func:`node_to_json`."""

    name: str
    arguments: list[tuple[str, str, list[list[str]], bool]]  # name, role, components, is_scalar
    temporaries: list[tuple[str, list[Any]]]
    outputs: list[tuple[str, list[Any]]]


@dataclass(frozen=True)
class Program:
    """A straight-line program: pairs (name, formula) for ``temporaries``, in order, then for ``outputs``.

    A temporary is an intermediate result.
    """

    signature: Signature
    temporaries: tuple[tuple[str, Node], ...]  # each name is assigned once, from inputs and earlier temporaries
    outputs: tuple[tuple[str, Node], ...]  # (component of an output argument, formula)

    def __post_init__(self) -> None:
        known = {name for a in self.signature.arguments if a.role == "in" for name, *_ in a.components}
        for name, node in self.temporaries + self.outputs:
            missing = names(node) - known
            if missing:
                raise ValueError(f"{self.signature.name}: {name} uses {sorted(missing)} before computing them")
            known.add(name)

    def operations(self) -> Counter[str]:
        """Return the number of operations of each kind, such as ``add`` or ``sin``, in one evaluation of all outputs.

        See :func:`symrot.formula.tree.operations`.
        """
        return sum((operations(node) for _, node in self.temporaries + self.outputs), Counter())

    def vanishing(self, zeros: Collection[str]) -> frozenset[str]:
        """Return the outputs that are zero if the inputs ``zeros`` are zero: an output ``a*b`` if a is zero."""
        known = set(zeros)
        for name, node in (*self.temporaries, *self.outputs):
            # an output that is zero only because its terms cancel does not count
            if vanishes(node, known):
                known.add(name)
        return frozenset(name for name, _ in self.outputs if name in known)

    def uses(self, symbol: str, only: Collection[str] | None = None) -> bool:
        """Return whether the input or temporary ``symbol`` is needed for the outputs, or for those in ``only``."""
        needed = {name for name, _ in self.outputs} if only is None else set(only)
        for name, node in reversed((*self.temporaries, *self.outputs)):
            needed |= names(node) if name in needed else set()
        return symbol in needed

    def evaluate(
        self,
        values: Mapping[str, Any],
        functions: Mapping[str, Callable[..., Any]] | None = None,
        number: Callable[[Fraction], Any] = float,
        only: Collection[str] | None = None,
    ) -> dict[str, Any]:
        """Return the values of the outputs by name, for ``values`` of the inputs: floats, arrays or Fractions.

        ``functions`` and ``number`` compute functions and constants for such values. ``only`` restricts the outputs.
        """
        # all outputs if only is None; of the temporaries, those that the outputs need
        outputs = [(name, node) for name, node in self.outputs if only is None or name in only]
        needed = set().union(*(names(node) for _, node in outputs))
        temporaries = []
        for name, node in reversed(self.temporaries):
            if name in needed:
                needed |= names(node)
                temporaries.append((name, node))
        known = dict(values)
        for name, node in reversed(temporaries):
            known[name] = evaluate(node, known, functions, number)
        return {name: evaluate(node, known, functions, number) for name, node in outputs}

    def to_json(self) -> ProgramRecord:
        """Return the program as plain data for JSON, from which :meth:`from_json` restores an equal program."""
        return {
            "name": self.signature.name,
            "arguments": [
                (a.name, a.role, [list(c) for c in a.components], a.is_scalar) for a in self.signature.arguments
            ],
            "temporaries": [(name, node_to_json(node)) for name, node in self.temporaries],
            "outputs": [(name, node_to_json(node)) for name, node in self.outputs],
        }

    @classmethod
    def from_json(cls, data: ProgramRecord) -> "Program":
        """Return the program that :meth:`to_json` turned into the record ``data``."""
        arguments = tuple(
            Argument(name, role, tuple((component, unit, meaning) for component, unit, meaning in components), scalar)
            for name, role, components, scalar in data["arguments"]
        )
        return cls(
            Signature(data["name"], arguments),
            tuple((name, node_from_json(node)) for name, node in data["temporaries"]),
            tuple((name, node_from_json(node)) for name, node in data["outputs"]),
        )


def node_to_json(node: Node) -> list[Any]:
    """Return a formula as nested lists for JSON, with numbers as exact text.

    The formula ``q0/2`` is ``["/", ["symbol", "q0"], ["number", "2"]]``.
    """
    kind = node[0]
    if kind == "number":
        return [kind, str(node[1])]
    if kind == "symbol":
        return [kind, node[1]]
    if kind == "call":
        return [kind, node[1], [node_to_json(argument) for argument in node[2]]]
    if kind == "**":
        return [kind, node_to_json(node[1]), node[2]]
    return [kind, *(node_to_json(child) for child in node[1:])]


def node_from_json(data: list[Any]) -> Node:
    """Return the formula that :func:`node_to_json` turned into the nested lists ``data``."""
    kind = data[0]
    if kind == "number":
        return ("number", Fraction(data[1]))
    if kind == "symbol":
        return ("symbol", data[1])
    if kind == "call":
        return ("call", data[1], tuple(node_from_json(argument) for argument in data[2]))
    if kind == "**":
        return ("**", node_from_json(data[1]), data[2])
    return (kind, *(node_from_json(child) for child in data[1:]))
